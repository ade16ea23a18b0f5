//! The paper's control study without a file: a made-up hysteretic actuator on the rotor of the default case.
//!
//! The inflow is Drees's, so reductions are smaller than in the free wake; the paper's stand beside.
//!
//! ```text
//! cargo run --release -p rotor-study --example voltage_to_vibration
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use preisach_dyn::{
    ActuatorLaw, ActuatorModel, Calibration, DynamicParameters, DynamicPreisach, PlayMap,
    PreisachError, PreisachGrid, RateForm, TimeOrder, VoltageRange,
};
use rotor_case::{Case, ControlActuator};
use rotor_study::{Drives, TrimmedRotor, control_all};
use std::sync::Arc;

/// Reduction of J in the paper, percent, with 2, 3 and 4/rev.
const PAPER: [(usize, &str); 3] = [(2, "about 29"), (3, "about 78"), (4, "about 66")];

/// A dynamic Preisach operator with the amplitudes of the paper's actuator: 10 deg slowly, 4.5 deg at 15 Hz.
fn actuator() -> Result<ActuatorModel, PreisachError> {
    let grid = PreisachGrid::new(VoltageRange::amplified_stack(), 16)?;
    let slope = |play: usize| if play == 0 { 0.85 } else { 0.052 };
    let rises: Vec<Vec<f64>> = (0..16).map(|play| vec![slope(play); 16 - play]).collect();
    let law = DynamicPreisach::new(DynamicParameters {
        grid,
        g0_deg: PlayMap::from_rises(&grid, 0.0, &rises)?,
        g1_s: PlayMap::constant(&grid, -0.021),
        g2_s2_per_deg: PlayMap::constant(&grid, 0.0),
        form: RateForm::WellPosed,
        unfolded_rate_deg_s: 1500.0,
        time_order: TimeOrder::Second,
    })?;
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
    Ok(ActuatorModel::new(ActuatorLaw::DynamicPreisach(law), grid.range(), calibration))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut case = Case::default();
    case.control.harmonics = vec![vec![2], vec![3], vec![4]];
    case.control.actuators =
        vec![ControlActuator::Ideal, ControlActuator::Ignored, ControlActuator::Hysteretic];
    let rotor = TrimmedRotor::new(&case, None)?;
    let controls = rotor.trim().controls;
    println!(
        "trim at mu {}: theta0 {:.2} deg",
        case.advance_ratio,
        controls.theta0_rad.to_degrees()
    );

    let drives = Drives::new(&case, Some(Arc::new(actuator()?)))?;
    println!("n/rev  actuator     J reduced by, %  paper (fed back)  steps  mean flap angle, deg");
    for study in control_all(&case, &rotor, &drives, &|| ())? {
        let set = study.harmonics[0];
        let is_fed_back = study.actuator == ControlActuator::Hysteretic;
        let paper =
            PAPER.iter().find(|(n, _)| *n == set && is_fed_back).map_or("", |(_, text)| text);
        let mean =
            study.state.flaps.iter().map(|flap| flap.flap_deg.mean.abs()).fold(0.0, f64::max);
        println!(
            "{set:5}  {:12} {:15.1}  {paper:16} {:6} {mean:21.1e}",
            study.actuator.name(),
            study.reduction_percent(),
            study.steps(),
        );
    }
    Ok(())
}
