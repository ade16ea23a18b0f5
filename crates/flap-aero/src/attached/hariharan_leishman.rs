//! Compressible section: indicial functions of the form of Hariharan and Leishman, reconstructed.

use crate::TheodorsenFunctions;
use crate::attached::values::MIN_NONCIRCULATORY_MACH;
use crate::{FlapChord, LagChannel, Load, Mach, Mode, ModelRemarks, SectionCoefficients};
use std::f64::consts::{PI, TAU};

/// Beddoes's circulatory lags, `phi(S) = 1 - sum A exp(-b beta^2 S)`: pairs `(A, b)`.
///
/// Source: Leishman and Beddoes, J. Am. Helicopter Soc. 34(3), 1989.
const BEDDOES: [(f64, f64); 2] = [(0.3, 0.14), (0.7, 0.53)];

/// The two exponentials of the moment due to incidence, pairs `(A, b)`: `A3, b3` and `A4, b4`.
const MOMENT_ALPHA: [(f64, f64); 2] = [(1.5, 0.25), (-0.5, 0.1)];

/// Pole `b5` of the moment due to pitch rate.
const MOMENT_PITCH_RATE: f64 = 0.5;

/// Loads at the start of a step of each input, `[output][input]`: piston theory.
///
/// ```text
/// pressure difference over (rho U^2/2) = 4 w / (M U),     w(x) the downwash of the input
///          alpha         q                              delta            q_delta
/// Cn       4/M           1/M                            4E/M             2E^2/M
/// Cm      -1/M          -7/(12M)                       -(4/M)E(3/4-E/2)  -E^2(9-4E)/(6M)
/// Ch      -2E^2/M       -(4/M)(E^3/3+(3/4-E)E^2/2)      -2E^2/M          -4E^3/(3M)
/// ```
/// Exact at `S = 0` for any Mach number; infinite at Mach 0. Ch of a rigid motion is that of the
/// flap held at zero angle.
///
/// Source: Lomax, Heaslet, Fuller and Sluder, NACA Report 1077 (1952) for `alpha` and `q`; the flap
/// columns by integration over the flap.
pub fn piston_start(mach: Mach, flap: FlapChord) -> [[f64; 4]; 3] {
    let e = flap.ratio();
    let p = 4.0 / mach.value();
    let e2 = e * e;
    let flap_by_rate = e2 * (e / 3.0 + 0.5 * (0.75 - e));
    [
        [p, 0.25 * p, p * e, 0.5 * p * e2],
        [-0.25 * p, -7.0 / 48.0 * p, -p * e * (0.75 - 0.5 * e), -p * e2 * (9.0 - 4.0 * e) / 24.0],
        // without a flap there is no hinge to have a moment about; all four vanish with E
        [-0.5 * p * e2, -p * flap_by_rate, -0.5 * p * e2, -p * e2 * e / 3.0],
    ]
}

/// Slopes in `S` of the loads at the start of a step of each input, `[output][input]`.
///
/// The edges lose the pressure difference of the downwash `w` they carry, at the rate
/// `(1 - M) w / (M^2 U)` of lift per semichord travelled; the hinge loses none to first order.
///
/// ```text
/// l = (1 - M)/M^2     alpha      q         delta     q_delta
/// Cn                  -2 l       -l/2      -l        -E l
/// Cm                   l/2        5l/8      3l/4      3E l/4
/// Ch                   E l        3E l/4    E l       E^2 l
/// ```
/// Exact at `S = 0` for `0 < M < 1` and a hinge off the leading edge.
///
/// Source: the short-time solutions of Lomax et al. (NACA Report 1077) by Evvard's rule; flap
/// columns derived for this project by the same rule.
pub fn initial_slopes(mach: Mach, flap: FlapChord) -> [[f64; 4]; 3] {
    let m = mach.value();
    let e = flap.ratio();
    let l = (1.0 - m) / (m * m);
    let flapped = if flap.is_none() { 0.0 } else { l };
    [
        [-2.0 * l, -0.5 * l, -flapped, -e * l],
        [0.5 * l, 0.625 * l, 0.75 * flapped, 0.75 * e * l],
        [e * l, 0.75 * e * l, e * l, e * e * l],
    ]
}

/// Coefficients of the compressible model.
///
/// Each input's indicial functions start at the exact piston value, leave it with the exact initial
/// slope and settle at the steady value of linear theory:
///
/// ```text
/// Phi(S) = start e^(-S/T) + at_once (1 - e^(-S/T)) + circulatory phi(S)
/// phi(S) = 1 - 0.3 e^(-0.14 beta^2 S) - 0.7 e^(-0.53 beta^2 S)
/// ```
/// | load | at once | with the circulation |
/// |---|---|---|
/// | Cn | 0 | `(2 pi/beta) [1, 1/2, T10/pi, T11/4 pi]` |
/// | Cm of the flap | `-[T15/2, T16/8]/beta` | 0 |
/// | Ch | held hinge moment `/ beta` | `-(T12/2 beta) [1, 1/2, T10/pi, T11/4 pi]` |
///
/// The moment of `alpha` and `q` has Beddoes's form (two exponentials; one exponential and a lag of
/// pole `0.5 beta^2`), with the scale of its time constants from the initial slope.
///
/// The rate entries are those of a held downwash: half of Theodorsen's `delta_dot` moment. The flap
/// moment settles at once: a circulatory lag on it, found in some programs, is wrong by most of its
/// size against exact theory.
///
/// Limits. The form buys its exact start with a decay that is too fast: about 30 % error in `Cn` of
/// a flap at `k <= 0.3` against exact linear theory, whatever the Mach number. Where start and
/// settled values are so near each other that no positive time constant gives the slope (flap
/// moments at high Mach number) the time constant is a quarter of what a wave from the trailing edge
/// needs to cross the flap, `T = E M / (2 (1 + M))`, and [`ModelRemarks::slope_unmatched`] says so.
///
/// Assumes: subsonic linear theory. Not modelled: shocks, stall.
///
/// A *reconstruction* of the form of Hariharan and Leishman, J. Aircraft 33(5), 1996, whose text
/// was not available; constants of Leishman and Beddoes (1989). Their empirical factor 0.75 on the
/// time constants is not applied: with it the initial slope is not matched.
pub(crate) fn coefficients(mach: Mach, flap: FlapChord) -> SectionCoefficients {
    let t = TheodorsenFunctions::new(flap.hinge());
    let beta = mach.beta();
    let beta2 = beta * beta;
    let compress = 1.0 / beta;
    let noncirculatory = Mach::within(mach, MIN_NONCIRCULATORY_MACH, Mach::MAX);
    let m = noncirculatory.value();

    let circulation = t.circulatory_input();
    let start = piston_start(noncirculatory, flap);
    let slopes = initial_slopes(noncirculatory, flap);
    let circulatory_slope: f64 = BEDDOES.iter().map(|(a, b)| a * b * beta2).sum();
    let held_moment = t.held_moment();
    let held_hinge = t.held_hinge();

    // shortest time constant, semichords, and the pairs whose slope asks for a shorter one
    let floor = 0.5 * flap.ratio() * m / (1.0 + m);
    let mut slope_unmatched = [[false; 4]; 3];
    let mut lags = Vec::with_capacity(16);
    for (a, b) in BEDDOES {
        lags.push(LagChannel {
            pole: b * beta2,
            input: circulation,
            output: [TAU * compress * a, 0.0, t.circulatory_hinge() * compress * a],
            is_circulatory: true,
        });
    }
    let modes = if flap.is_none() { &Mode::ALL[..2] } else { &Mode::ALL[..] };
    let loads = if flap.is_none() { &Load::ALL[..2] } else { &Load::ALL[..] };
    for &load in loads {
        for &mode in modes {
            let (o, j) = (load.index(), mode.index());
            let i0 = start[o][j];
            match (load, mode) {
                (Load::Moment, Mode::Alpha) => {
                    // K = (A3 b4 + A4 b3)/(b3 b4 (1 - M)), time constants b K c / a
                    let scale = MOMENT_ALPHA.iter().map(|(a, b)| a / b).sum::<f64>() / (1.0 - m);
                    for (a, b) in MOMENT_ALPHA {
                        lags.push(single(load, mode, 2.0 * m * b * scale, -a * i0));
                    }
                }
                (Load::Moment, Mode::PitchRate) => {
                    // K = 7/(15 (1 - M) + 3 pi beta M^2 b5), time constant K c / a
                    let pole = MOMENT_PITCH_RATE * beta2;
                    let damping = 3.0 * PI * m * m * pole / beta;
                    let time = 14.0 * m / (15.0 * (1.0 - m) + damping);
                    lags.push(single(load, mode, time, -i0));
                    lags.push(single(load, mode, 1.0 / pole, held_moment[j] * compress));
                }
                _ => {
                    // what the function settles to, at once and with the circulation
                    let [at_once, circulatory] = match load {
                        Load::Lift => [0.0, TAU * compress * circulation[j]],
                        Load::Moment => [held_moment[j] * compress, 0.0],
                        Load::Hinge => [
                            held_hinge[j] * compress,
                            t.circulatory_hinge() * compress * circulation[j],
                        ],
                    };
                    // Phi'(0) = slope:   T = (at_once - start) / (slope - circulatory phi'(0))
                    let time = (at_once - i0) / (slopes[o][j] - circulatory * circulatory_slope);
                    let is_matched = time >= floor;
                    slope_unmatched[o][j] = !is_matched;
                    let time = if is_matched { time } else { floor };
                    lags.push(single(load, mode, time, at_once - i0));
                }
            }
        }
    }
    SectionCoefficients {
        direct: start,
        rate: [[0.0; 4]; 3],
        lags,
        remarks: ModelRemarks {
            mach_floored: mach < noncirculatory,
            slope_unmatched,
            ..Default::default()
        },
    }
}

/// A lag of one input into one output.
fn single(load: Load, mode: Mode, time: f64, weight: f64) -> LagChannel {
    let (input, output) = ([0.0; 4], [0.0; 3]);
    let mut lag = LagChannel { pole: 1.0 / time, input, output, is_circulatory: false };
    lag.input[mode.index()] = 1.0;
    lag.output[load.index()] = weight;
    lag
}
