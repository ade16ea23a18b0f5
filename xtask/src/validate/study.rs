//! The control study of the paper's case: what must hold whatever the numbers are.

use std::sync::OnceLock;

use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_response::InflowState;
use sim_driver::SimError;
use sim_driver::case::{CONTROLLERS_CASE, LoadedCase, shipped_case};
use sim_driver::progress::Progress;
use sim_driver::results::ControlLine;
use sim_driver::run::run_case;
use sim_driver::study::TrimmedRotor;

use super::CheckError;
use super::check::{Area, Check, Criterion, Repeatability};
use super::reference::worst;

const SELF: &str = "the study itself, Drees inflow, advance ratio 0.30";

pub(super) const AREA: Area = Area {
    heading: "Control study (`sim-driver`)",
    checks: &[
        Check {
            id: "V-STUDY-01",
            quantity: "T of the linearised rotor, 2 flaps at 2 to 5/rev, inflow settled: distance from central \
                       differences of 0.5 deg over their norm",
            unit: "-",
            source: "converged solutions with moved flaps",
            criterion: Criterion::AtMost(1e-4),
            repeatability: Repeatability::Everywhere,
            measure: linearised_error,
        },
        Check {
            id: "V-STUDY-02",
            quantity: "feedback on the hysteretic actuator, 2, 3, 4/rev: J over that of hysteresis ignored, worst",
            unit: "-",
            source: SELF,
            criterion: Criterion::AtMost(1.0),
            repeatability: Repeatability::Everywhere,
            measure: over_ignored,
        },
        Check {
            id: "V-STUDY-03",
            quantity: "the same: halved steps at 3/rev",
            unit: "-",
            source: SELF,
            criterion: Criterion::AtMost(0.0),
            repeatability: Repeatability::Everywhere,
            measure: || Ok(f64::from(line(&[3], "hysteretic")?.halvings)),
        },
        Check {
            id: "V-STUDY-04",
            quantity: "inverse of the actuator, every set of harmonics: error of the wanted flap motion, worst",
            unit: "%",
            source: SELF,
            criterion: Criterion::AtMost(1.0),
            repeatability: Repeatability::Everywhere,
            measure: inverse_error,
        },
        Check {
            id: "V-STUDY-05",
            quantity: "mean flap angle, every actuator and control step: largest",
            unit: "deg",
            source: "the bias is solved for, paper equation (6)",
            criterion: Criterion::AtMost(0.01),
            repeatability: Repeatability::Everywhere,
            measure: || {
                let lines = study()?;
                worst("lines", lines.len(), lines.iter().map(|l| Ok(l.largest_mean_flap_deg)))
            },
        },
    ],
};

fn controllers_case() -> Result<LoadedCase, SimError> {
    Ok(shipped_case(CONTROLLERS_CASE)?)
}

/// Every control of the case with all controllers, computed once.
fn study() -> Result<&'static [ControlLine], CheckError> {
    static LINES: OnceLock<Vec<ControlLine>> = OnceLock::new();
    if LINES.get().is_none() {
        let outcome = run_case(&controllers_case()?, &Progress::hidden())?;
        let _ = LINES.set(outcome.result.control);
    }
    Ok(LINES.get().map_or(&[], Vec::as_slice))
}

fn line(harmonics: &[usize], actuator: &str) -> Result<&'static ControlLine, CheckError> {
    let found = study()?.iter().find(|l| l.harmonics == harmonics && l.actuator == actuator);
    found.ok_or(CheckError::TooFew { what: "lines of the study", found: 0, needed: 1 })
}

fn over_ignored() -> Result<f64, CheckError> {
    let ratio = |n: usize| {
        let (fed_back, ignored) = (line(&[n], "hysteretic")?, line(&[n], "ignored")?);
        Ok(fed_back.j_after / ignored.j_after)
    };
    worst("harmonics", 3, [2, 3, 4].map(ratio))
}

fn inverse_error() -> Result<f64, CheckError> {
    let inverse: Vec<&ControlLine> = study()?.iter().filter(|l| l.actuator == "inverse").collect();
    let errors = inverse.iter().map(|l| Ok(l.motion_error_percent.unwrap_or(f64::NAN)));
    worst("sets", 5, errors)
}

fn linearised_error() -> Result<f64, CheckError> {
    let loaded = controllers_case()?;
    let rotor = TrimmedRotor::new(&loaded, None)?;
    let linear = rotor.linearised(InflowState::Settled)?;
    let controls: Vec<(usize, usize, bool)> = (0..2)
        .flat_map(|flap| (2..=5).flat_map(move |n| [(flap, n, false), (flap, n, true)]))
        .collect();
    let columns = controls
        .into_par_iter()
        .map(|(flap, n, sine)| {
            let moved = |deg: f64| {
                let mut angles = vec![HarmonicSeries::zero(n); 2];
                let (cosine, sine) = if sine { (0.0, deg) } else { (deg, 0.0) };
                angles[flap].set_harmonic(n, Harmonic { cosine, sine });
                angles
            };
            let loads = |deg: f64| -> Result<[f64; 12], CheckError> {
                Ok(rotor.with_flaps(moved(deg.to_radians()))?.hub.harmonic(4))
            };
            let (plus, minus) = (loads(0.5)?, loads(-0.5)?);
            let along = linear.loads(flap, &moved(1.0)[flap]);
            let exact: [f64; 12] = std::array::from_fn(|k| plus[k] - minus[k]);
            Ok((0..12).fold([0.0, 0.0], |[off, whole], k| {
                [off + (along[k] - exact[k]).powi(2), whole + exact[k].powi(2)]
            }))
        })
        .collect::<Result<Vec<[f64; 2]>, CheckError>>()?;
    let sum = |which: usize| columns.iter().map(|c| c[which]).sum::<f64>();
    Ok((sum(0) / sum(1)).sqrt())
}
