//! How the reductions move with the assumptions the paper leaves open.

use super::{Drives, TrimmedRotor, control_set};
use crate::SimError;
use crate::case::{ControlActuator, InflowChoice, LoadedCase, SectionModelChoice};
use rayon::prelude::*;

/// Tolerances of the table: a tenth of a percent is printed.
const TABLE_TRIM_TOLERANCE: f64 = 1e-7;
const TABLE_PERIODICITY_TOLERANCE: f64 = 1e-9;
const TABLE_INFLOW_TOLERANCE: f64 = 1e-8;

/// One assumption changed, and what becomes of the reductions.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// What was changed, with the value it has in the case.
    pub assumption: String,
    /// Reduction of `J_Z` (percent) for each set of harmonics of the case, ideal actuator within the
    /// stroke of the real one.
    pub reduction_percent: Vec<f64>,
}

/// Whether an assumption changes the rotor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RotorOf {
    /// The rotor and its trim are those of the case.
    TheCase,
    /// They are built and trimmed anew.
    TheChange,
}

/// A change of the case and of the stroke.
struct Assumption {
    text: &'static str,
    stroke_factor: f64,
    rotor: RotorOf,
    change: Box<dyn Fn(&mut LoadedCase) + Sync + Send>,
}

fn assume(
    text: &'static str,
    change: impl Fn(&mut LoadedCase) + Sync + Send + 'static,
) -> Assumption {
    let change = Box::new(change);
    Assumption { text, stroke_factor: 1.0, rotor: RotorOf::TheChange, change }
}

fn shift_flaps(loaded: &mut LoadedCase, by_r: f64) {
    for flap in &mut loaded.case.flaps {
        flap.start += by_r;
        flap.end += by_r;
    }
}

/// The changes, one at a time.
fn assumptions(base: &TrimmedRotor, blades: usize) -> Vec<Assumption> {
    let amplitudes = base.trim().rotor.hub.harmonic(blades);
    let weight = move |k: usize| {
        let square = amplitudes[2 * k].powi(2) + amplitudes[2 * k + 1].powi(2);
        if square > 0.0 { 1.0 / square } else { 1.0 }
    };
    vec![
        Assumption { rotor: RotorOf::TheCase, ..assume("as the case", |_| {}) },
        assume("flaps .05 R further in", |c| shift_flaps(c, -0.05)),
        assume("flaps .05 R further out", |c| shift_flaps(c, 0.05)),
        assume("twist -4 deg", |c| c.case.blade.twist_rad = (-4.0_f64).to_radians()),
        assume("twist -12 deg", |c| c.case.blade.twist_rad = (-12.0_f64).to_radians()),
        assume("GJ -20 % (first torsion -10 %)", |c| c.case.blade.gj *= 0.8),
        assume("GJ +20 % (first torsion +9 %)", |c| c.case.blade.gj *= 1.2),
        assume("modal damping 1 % of critical", |c| c.case.blade.modal_damping = 0.01),
        assume("uniform inflow", |c| c.case.inflow = InflowChoice::Uniform),
        assume("quasi-steady sections", |c| c.case.section.model = SectionModelChoice::QuasiSteady),
        Assumption {
            rotor: RotorOf::TheCase,
            ..assume("each load weighted by its own baseline", move |c| {
                let w = &mut c.case.control.load_weights;
                (w.fx, w.fy, w.fz) = (weight(0), weight(1), weight(2));
                (w.mx, w.my, w.mz) = (weight(3), weight(4), weight(5));
            })
        },
        Assumption {
            stroke_factor: 0.5,
            rotor: RotorOf::TheCase,
            ..assume("half the stroke", |_| {})
        },
    ]
}

/// Trims and controls the case once for every assumption changed; in parallel, results in order.
///
/// With the ideal actuator, held to the stroke of the real one: feedback on the hysteretic actuator
/// reaches nearly the same reductions, at several times the cost.
///
/// # Errors
/// The first failure of a trim or a control study.
pub fn sensitivities(
    loaded: &LoadedCase,
    base: &TrimmedRotor,
    drives: &Drives,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Sensitivity>, SimError> {
    assumptions(base, loaded.case.blades)
        .into_par_iter()
        .map(|assumption| {
            let mut varied = loaded.clone();
            (assumption.change)(&mut varied);
            varied.case.control.actuators = vec![ControlActuator::Ideal];
            let limited = drives.with_strokes_scaled(assumption.stroke_factor);
            varied.case.tolerances.trim = TABLE_TRIM_TOLERANCE;
            varied.case.tolerances.periodicity = TABLE_PERIODICITY_TOLERANCE;
            varied.case.tolerances.inflow = TABLE_INFLOW_TOLERANCE;
            let rotor = match assumption.rotor {
                RotorOf::TheCase => base.clone(),
                RotorOf::TheChange => TrimmedRotor::new(&varied, Some(base.trim()))?,
            };
            let reduction_percent = varied
                .case
                .control
                .harmonics
                .iter()
                .map(|set| {
                    let studies = control_set(&varied.case, &rotor, &limited, set, &|| ())
                        .map_err(|source| SimError::Study {
                            place: loaded.index.place("control"),
                            source,
                        })?;
                    Ok(studies.first().map_or(f64::NAN, super::ControlStudy::reduction_percent))
                })
                .collect::<Result<Vec<f64>, SimError>>()?;
            done();
            Ok(Sensitivity { assumption: assumption.text.to_owned(), reduction_percent })
        })
        .collect()
}

/// Number of rows [`sensitivities`] makes, for a progress bar.
pub const SENSITIVITY_ROWS: usize = 12;
