//! Sections beyond attached linear theory: their linear limits, in air and in the rotor, and measured loops.

use std::f64::consts::TAU;

use flap_aero::{
    AttachedFlowModel, CycleStep, FlapChord, FreeStream, Mach, MarchingSection, SectionInputs,
    StallAirfoil, StallParameters, StallSection, StallState, StalledLoads, load_slopes,
    periodic_state, section_loads,
};

use validation::{Check, Failure, row, too_few, worst};

const MEASURED: &str = "McAlister et al., NASA TM-84245, frame 10022, digitised";
const CL: &str = include_str!("../../../../fixtures/reference/deep_stall/exp_cl.txt");
const CD: &str = include_str!("../../../../fixtures/reference/deep_stall/exp_cd.txt");

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-AERO-35",
        "stalling section, stall out of reach, 10 + 8 sin deg, k 0.1: normal force \
         off the attached model",
        "-",
    )
    .against("the attached model")
    .at_most(1e-12, || {
        let p = naca_0012()?;
        let never = StallParameters { alpha1_rad: 100.0, k0: 0.0, cn1: 1e9, ..p };
        off_attached(never, [10.0, 8.0])
    }),
    row(
        "V-AERO-36",
        "the same with the constants of the NACA 0012, 2 sin deg, of the amplitude",
        "%",
    )
    .against("the attached model")
    .at_most(0.5, || {
        let amplitude = TAU * 2.0_f64.to_radians();
        Ok(100.0 * off_attached(naca_0012()?, [0.0, 2.0])? / amplitude)
    }),
    row(
        "V-AERO-37",
        "measured deep stall, NACA 0012, M 0.3, k 0.098, 12 + 9.9 sin deg: highest \
         lift, model over measured",
        "-",
    )
    .against(MEASURED)
    .near(1.0, 0.05, || Ok(deep_stall(StallAirfoil::Naca0012)?.peak_ratio(LIFT))),
    row("V-AERO-38", "the same: incidence of the highest lift, model less measured", "deg")
        .against(MEASURED)
        .near(0.0, 1.0, || Ok(deep_stall(StallAirfoil::Naca0012)?.peak_incidence(LIFT))),
    row(
        "V-AERO-39",
        "the same: lift of the falling incidence, rms error (known: the model \
         attaches again too early)",
        "-",
    )
    .against(MEASURED)
    .between(0.3, 0.45, || deep_stall(StallAirfoil::Naca0012)?.rms(LIFT, false)),
    row(
        "V-AERO-40",
        "the same: pressure drag of the whole cycle, rms error (measured to 0.62)",
        "-",
    )
    .against(MEASURED)
    .at_most(0.12, || {
        let found = deep_stall(StallAirfoil::Naca0012)?;
        found.whole_rms(DRAG)
    }),
    row(
        "V-AERO-47",
        "the same loop, constants fitted to other loops of that report: highest lift, model over measured",
        "-",
    )
    .against(MEASURED)
    .near(1.0, 0.08, || Ok(deep_stall(StallAirfoil::Naca0012Measured)?.peak_ratio(LIFT))),
    row("V-AERO-48", "the same, fitted constants: highest pressure drag, model over measured", "-")
        .against(MEASURED)
        .near(1.0, 0.2, || Ok(deep_stall(StallAirfoil::Naca0012Measured)?.peak_ratio(DRAG))),
    row("V-AERO-49", "the same, fitted constants: lift of the whole cycle, rms error", "-")
        .against(MEASURED)
        .at_most(0.23, || deep_stall(StallAirfoil::Naca0012Measured)?.whole_rms(LIFT)),
    row("V-AERO-50", "the same, published constants: what the bound must see", "-")
        .against(MEASURED)
        .at_least(0.25, || deep_stall(StallAirfoil::Naca0012)?.whole_rms(LIFT)),
    row(
        "V-AERO-41",
        "slopes of the section loads in velocities, rates and lags against \
         differences: largest error, of the slope",
        "-",
    )
    .against("the loads themselves, linear in all of them")
    .at_most(1e-8, slopes_of_the_loads),
];

fn naca_0012() -> Result<StallParameters, Failure> {
    Ok(StallParameters::naca_0012(Mach::new(0.3)?))
}

const STEPS: u32 = 720;

/// One cycle of `mean + amplitude sin` in pitch at a reduced frequency that repeats: incidence in rad,
/// loads with stall, attached normal force.
fn pitching(
    parameters: StallParameters,
    [mean, amplitude]: [f64; 2],
    k: f64,
) -> Result<Vec<(f64, StalledLoads, f64)>, Failure> {
    let (mach, flap) = (Mach::new(0.3)?, FlapChord::NONE);
    let section = MarchingSection::new(&AttachedFlowModel::Calibrated.coefficients(mach, flap)?);
    let stalling = StallSection::new(mach, flap, parameters)?;
    let ds = TAU / k / f64::from(STEPS);
    let cycle: Vec<CycleStep<'_>> = (1..=STEPS)
        .map(|n| {
            let (sin, cos) = (TAU * f64::from(n) / f64::from(STEPS)).sin_cos();
            let modes = [mean + amplitude * sin, 2.0 * k * amplitude * cos, 0.0, 0.0];
            let inputs = SectionInputs { modes: modes.map(f64::to_radians), rates: [0.0; 4] };
            CycleStep { section: &section, inputs, semichords: ds }
        })
        .collect();
    let mut state = periodic_state(&cycle)?;
    let start = &cycle[cycle.len() - 1].inputs;
    let [attached, ..] = state.loads(&section, start)?;
    let mut stall = StallState::settled(&stalling, attached, &start.modes);
    let mut out = Vec::new();
    for n in 0..3 {
        for step in &cycle {
            let loads = state.step(&section, &step.inputs, ds)?;
            let stalled = stall.step(&stalling, loads, &step.inputs.modes, ds)?;
            if n == 2 {
                out.push((step.inputs.modes[0], stalled, loads[0]));
            }
        }
    }
    Ok(out)
}

/// Largest distance of the normal force from the attached model.
fn off_attached(parameters: StallParameters, motion: [f64; 2]) -> Result<f64, Failure> {
    let cycle = pitching(parameters, motion, 0.1)?;
    worst("steps", 700, cycle.iter().map(|(_, stalled, cn)| Ok((stalled.normal - cn).abs())))
}

const LIFT: usize = 0;
const DRAG: usize = 1;

/// Lift and pressure drag over a measured deep-stall cycle.
struct DeepStall {
    /// Incidence in degrees, lift, drag; from the first step after the mean, rising.
    model: Vec<(f64, [f64; 2])>,
    /// Incidence in degrees and coefficient of lift and drag, in time.
    measured: [Vec<(f64, f64)>; 2],
}

fn deep_stall(airfoil: StallAirfoil) -> Result<DeepStall, Failure> {
    let model = pitching(airfoil.parameters(Mach::new(0.3)?), [12.0, 9.9], 0.098)?
        .iter()
        .map(|(alpha, loads, _)| {
            let (sin, cos) = alpha.sin_cos();
            let lift = loads.normal * cos + loads.chord * sin;
            (alpha.to_degrees(), [lift, loads.pressure_drag(*alpha)])
        })
        .collect();
    let points = |text: &str| -> Vec<(f64, f64)> {
        let row = |n: usize| -> Vec<f64> {
            let line = text.lines().nth(n).unwrap_or_default();
            line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
        };
        row(0).into_iter().zip(row(1)).collect()
    };
    Ok(DeepStall { model, measured: [points(CL), points(CD)] })
}

impl DeepStall {
    /// Incidence and value of the highest of both: model, measurement.
    fn peaks(&self, which: usize) -> [(f64, f64); 2] {
        let highest = |values: Vec<(f64, f64)>| {
            values.into_iter().fold((f64::NAN, f64::NEG_INFINITY), |best, now| {
                if now.1 > best.1 { now } else { best }
            })
        };
        let model = self.model.iter().map(|(a, values)| (*a, values[which])).collect();
        [highest(model), highest(self.measured[which].clone())]
    }

    fn peak_ratio(&self, which: usize) -> f64 {
        let [model, measured] = self.peaks(which);
        model.1 / measured.1
    }

    fn peak_incidence(&self, which: usize) -> f64 {
        let [model, measured] = self.peaks(which);
        model.0 - measured.0
    }

    /// The model between two of its steps.
    fn at(&self, incidence: f64, rising: bool, which: usize) -> f64 {
        let half = self.model.windows(2).filter(|pair| (pair[1].0 > pair[0].0) == rising);
        let mut nearest = (f64::INFINITY, f64::NAN);
        for pair in half {
            let ((a, low), (b, high)) = (pair[0], pair[1]);
            let share = ((incidence - a) / (b - a)).clamp(0.0, 1.0);
            let off = (a + share * (b - a) - incidence).abs();
            if off < nearest.0 {
                nearest = (off, low[which] + share * (high[which] - low[which]));
            }
        }
        nearest.1
    }

    /// Root mean square of the error while the incidence rises or falls.
    fn rms(&self, which: usize, rising: bool) -> Result<f64, Failure> {
        let points = &self.measured[which];
        let top = points.iter().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
        let split = points.iter().take_while(|p| p.0 < top).count() + 1;
        let half = if rising { &points[..split] } else { &points[split..] };
        let (needed, found) = (20, half.len());
        if found < needed {
            return Err(too_few("measured points", found, needed));
        }
        let squares = half.iter().map(|(a, value)| (self.at(*a, rising, which) - value).powi(2));
        Ok((squares.sum::<f64>() / found as f64).sqrt())
    }

    /// The same of both halves.
    fn whole_rms(&self, which: usize) -> Result<f64, Failure> {
        let halves = [self.rms(which, true)?, self.rms(which, false)?];
        Ok((0.5 * halves.iter().map(|rms| rms * rms).sum::<f64>()).sqrt())
    }
}

/// Largest error of the closed slopes of the loads, over the largest slope of the load.
fn slopes_of_the_loads() -> Result<f64, Failure> {
    let mut errors = Vec::new();
    for model in [AttachedFlowModel::HariharanLeishman, AttachedFlowModel::Calibrated] {
        let section = model.coefficients(Mach::new(0.4)?, FlapChord::new(0.25)?)?;
        let stream = FreeStream { density: 1.1, semichord: 0.2, speed: 120.0 };
        let (w, dw) = ([3.0, -1.0, 2.0, 0.5], [10.0, 4.0, -20.0, 7.0]);
        let x: Vec<f64> = (0..section.lags.len()).map(|i| (0.7 * i as f64).sin()).collect();
        let slopes = load_slopes(&section, &stream, &w, &dw, &x)?;
        let loads = |w: &[f64; 4], dw: &[f64; 4], x: &[f64]| -> Result<[f64; 3], Failure> {
            let l = section_loads(&section, &stream, w, dw, x)?;
            Ok([l.lift, l.moment, l.hinge])
        };
        let mut pairs: Vec<([f64; 3], [f64; 3])> = Vec::new();
        for j in 0..4 {
            let moved = |sign: f64, v: &[f64; 4]| {
                let mut moved = *v;
                moved[j] += sign;
                moved
            };
            let half = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|o| 0.5 * (a[o] - b[o]));
            let by_velocity =
                half(loads(&moved(1.0, &w), &dw, &x)?, loads(&moved(-1.0, &w), &dw, &x)?);
            let by_rate = half(loads(&w, &moved(1.0, &dw), &x)?, loads(&w, &moved(-1.0, &dw), &x)?);
            pairs.push((by_velocity, slopes.per_velocity.map(|row| row[j])));
            pairs.push((by_rate, slopes.per_velocity_rate.map(|row| row[j])));
        }
        for i in 0..x.len() {
            let at = |sign: f64| {
                let mut moved = x.clone();
                moved[i] += sign;
                loads(&w, &dw, &moved)
            };
            let (up, down) = (at(1.0)?, at(-1.0)?);
            let exact = [0, 1, 2].map(|o| slopes.per_lag[o][i]);
            pairs.push(([0, 1, 2].map(|o| 0.5 * (up[o] - down[o])), exact));
        }
        for o in 0..3 {
            let size = pairs.iter().map(|(_, slope)| slope[o].abs()).fold(0.0, f64::max);
            errors.extend(pairs.iter().map(|(a, b)| Ok((a[o] - b[o]).abs() / size)));
        }
    }
    worst("slopes", 100, errors)
}
