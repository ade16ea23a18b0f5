//! Compressible section with poles and gains fitted to exact linear theory.

/// Poles and gains, written by `cargo xtask calibrate`.
#[expect(clippy::unreadable_literal, reason = "written by a program, read by one")]
mod table {
    include!("table.in");
}

use crate::attached::hariharan_leishman::piston_start;
use crate::{
    AeroError, FlapChord, LagChannel, Load, Mach, Mode, ModelRemarks, SectionCoefficients,
    TheodorsenFunctions,
};
use std::f64::consts::TAU;
use table::{
    FAST, FLAP_RANGE, FLAP_TERMS, FLAPPED, MACH_RANGE, MACH_TERMS, POLE_LAW, POLES, RIGID,
    SMALLEST_RATIO,
};

/// Mach numbers beyond which the values are held.
pub(crate) const MACH_ENDS: [f64; 2] = MACH_RANGE;

/// Gains of the table per pair: of all poles but the fastest, whose gain is what the others leave.
const FITTED: usize = POLES - 1;
/// Pairs of load and input.
const PAIRS: usize = 12;

/// Pairs in the order of the table: first those that do not depend on the flap.
const ORDER: [(Load, Mode); PAIRS] = [
    (Load::Lift, Mode::Alpha),
    (Load::Lift, Mode::PitchRate),
    (Load::Moment, Mode::Alpha),
    (Load::Moment, Mode::PitchRate),
    (Load::Lift, Mode::Flap),
    (Load::Lift, Mode::FlapRate),
    (Load::Moment, Mode::Flap),
    (Load::Moment, Mode::FlapRate),
    (Load::Hinge, Mode::Alpha),
    (Load::Hinge, Mode::PitchRate),
    (Load::Hinge, Mode::Flap),
    (Load::Hinge, Mode::FlapRate),
];

/// The calibrated model of one flap chord, for any Mach number.
///
/// ```text
/// y_o = sum over inputs j [ start_oj m_j + sum over poles gain_oji x_ji ],   dx_ji/dS = p_i (m_j - x_ji)
/// sum_i gain_oji = steady_oj - start_oj
/// ```
/// All inputs and loads share six real poles `p_i(M)`. The values at `S = 0` are those of piston
/// theory and the steady values those of linear theory, both exact; the gains in between are fitted
/// to solutions of Possio's integral equation (`cargo xtask calibrate`), relative to the load of the
/// motion they belong to, for `k` up to 1.
///
/// Where the poles are near one another the gains nearly cancel: this is how a sum of real
/// exponentials follows the delayed arrival of a pressure wave.
///
/// Limits. Mach 0.05 to 0.9: below, the start values and gains are those of 0.05
/// ([`ModelRemarks::mach_floored`]), above, everything is that of 0.9
/// ([`ModelRemarks::mach_capped`]). Flap chords 0.1 to 0.4, or no flap. The initial slope is not
/// matched, on purpose: matching it is what makes the slope-matched form decay too fast.
///
/// Assumes: subsonic linear theory. Not modelled: thickness, viscosity, shocks, stall.
///
/// Source: exact values from C. Possio, L'Aerotecnica 18 (1938); the fit is this project's.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedSection {
    flap: FlapChord,
    /// Steady loads at Mach 0, `[load][input]`.
    still: [[f64; 4]; 3],
    /// Chebyshev coefficients in the Mach number, `[pair][term]`, of all poles but the fastest.
    gains: Vec<[[f64; FITTED]; MACH_TERMS]>,
}

impl CalibratedSection {
    /// The model for a flap chord.
    ///
    /// # Errors
    /// [`AeroError::FlapChordNotCalibrated`] unless the flap chord is 0 (no flap) or 0.1 to 0.4.
    pub fn new(flap: FlapChord) -> Result<Self, AeroError> {
        let [from, to] = FLAP_RANGE;
        let ratio = flap.ratio();
        if !(flap.is_none() || (from..=to).contains(&ratio)) {
            return Err(AeroError::FlapChordNotCalibrated { ratio, from, to });
        }
        let mut gains: Vec<[[f64; FITTED]; MACH_TERMS]> = RIGID.to_vec();
        if !flap.is_none() {
            let t = chebyshev::<FLAP_TERMS>(ratio, FLAP_RANGE);
            for pair in &FLAPPED {
                let mut sum = [[0.0; FITTED]; MACH_TERMS];
                for (weight, rows) in t.iter().zip(pair) {
                    for (sum, row) in sum.iter_mut().flatten().zip(rows.iter().flatten()) {
                        *sum += weight * row;
                    }
                }
                gains.push(sum);
            }
        }
        let t = TheodorsenFunctions::new(flap.hinge());
        let circulation = t.circulatory_input();
        let mut still = [circulation.map(|w| TAU * w), t.held_moment(), t.held_hinge()];
        for (load, w) in still[Load::Hinge.index()].iter_mut().zip(circulation) {
            *load += t.circulatory_hinge() * w;
        }
        Ok(Self { flap, still, gains })
    }

    /// Coefficients at a Mach number.
    ///
    /// The lags come pole by pole, fastest first, each for `alpha`, `q`, `delta`, `q_delta` (without
    /// flap: `alpha`, `q`).
    pub fn coefficients(&self, mach: Mach) -> SectionCoefficients {
        let [low, high] = MACH_RANGE;
        let held = Mach::within(mach, low, high);
        // the steady values follow the true Mach number below the range
        let beta = if mach < held { mach.beta() } else { held.beta() };
        let start = piston_start(held, self.flap);
        let poles = poles(held.value());
        let terms = chebyshev::<MACH_TERMS>(variable(held.value()), MACH_RANGE.map(variable));
        let inputs = if self.flap.is_none() { 2 } else { 4 };
        let mut lags = Vec::with_capacity(POLES * inputs);
        for pole in poles {
            for j in 0..inputs {
                // the fit does not part the circulation from pressure waves
                let is_circulatory = true;
                let mut lag =
                    LagChannel { pole, input: [0.0; 4], output: [0.0; 3], is_circulatory };
                lag.input[j] = 1.0;
                lags.push(lag);
            }
        }
        for ((load, mode), rows) in ORDER.iter().zip(&self.gains) {
            let (o, j) = (load.index(), mode.index());
            let mut gains = [0.0; FITTED];
            for (weight, row) in terms.iter().zip(rows) {
                for (gain, value) in gains.iter_mut().zip(row) {
                    *gain += weight * value;
                }
            }
            let mut left = self.still[o][j] / beta - start[o][j];
            for (i, gain) in gains.iter().enumerate() {
                let gain = gain / held.value();
                lags[(i + 1) * inputs + j].output[o] = gain;
                left -= gain;
            }
            lags[j].output[o] = left;
        }
        SectionCoefficients {
            direct: start,
            rate: [[0.0; 4]; 3],
            lags,
            remarks: ModelRemarks {
                mach_floored: mach < held,
                mach_capped: mach > held,
                ..ModelRemarks::default()
            },
        }
    }
}

/// The variable in which the gains are series.
fn variable(mach: f64) -> f64 {
    (mach / (1.0 - mach)).ln()
}

/// Chebyshev polynomials at `x` of a range.
fn chebyshev<const N: usize>(x: f64, [low, high]: [f64; 2]) -> [f64; N] {
    let t = (2.0 * x - low - high) / (high - low);
    let mut values = [1.0; N];
    if N > 1 {
        values[1] = t;
    }
    for n in 2..N {
        values[n] = 2.0 * t * values[n - 1] - values[n - 2];
    }
    values
}

/// The poles at a Mach number, per semichord, fastest first.
///
/// ```text
/// ln p_N = ln beta^2 + f_N,    ln p_i = ln p_(i+1) + ln 1.5 + softplus(f_i),    f_i = a_i + b_i M + c_i M^2
/// ```
/// with `-ln(M beta^2)` added to `f` where the pressure waves begin.
fn poles(mach: f64) -> [f64; POLES] {
    let softplus = |x: f64| x.max(0.0) + (-x.abs()).exp().ln_1p();
    let beta2 = 1.0 - mach * mach;
    let mut poles = [0.0; POLES];
    let mut log = beta2.ln();
    for i in (0..POLES).rev() {
        let [a, b, c] = POLE_LAW[i];
        let f = a + mach * (b + mach * c);
        log += match i + 1 {
            POLES => f,
            FAST => SMALLEST_RATIO.ln() + softplus(f - (mach * beta2).ln()),
            _ => SMALLEST_RATIO.ln() + softplus(f),
        };
        poles[i] = log.exp();
    }
    poles
}
