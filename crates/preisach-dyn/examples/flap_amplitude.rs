//! Equation (5) of the paper: the same voltage moves the flap less, and later, the faster it changes.
//!
//! The density is made up; its relaxation time is chosen for the amplitude that the paper reports at 15 Hz.
//!
//! ```text
//! cargo run -p preisach-dyn --example flap_amplitude
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use preisach_dyn::{
    ActuatorLaw, ActuatorModel, Calibration, DynamicParameters, DynamicPreisach, PeriodicSettings,
    PlayMap, PreisachError, PreisachGrid, RateForm, TimeOrder, VoltageRange,
};
use rotor_base::{Harmonic, HarmonicSeries};

/// Full-scale drive of the paper: 85 V about a bias of 65 V.
const BIAS_VOLT: f64 = 65.0;
const AMPLITUDE_VOLT: f64 = 84.9;

fn actuator(relaxation_time_s: f64) -> Result<ActuatorModel, PreisachError> {
    let levels = 16;
    let grid = PreisachGrid::new(VoltageRange::amplified_stack(), levels)?;
    // slopes of the output maps: a reversible part (play 0) and plays of all half-widths
    let rises: Vec<Vec<f64>> =
        (0..levels).map(|play| vec![if play == 0 { 0.85 } else { 0.052 }; levels - play]).collect();
    let law = DynamicPreisach::new(DynamicParameters {
        grid,
        g0_deg: PlayMap::from_rises(&grid, 0.0, &rises)?,
        g1_s: PlayMap::constant(&grid, -relaxation_time_s),
        g2_s2_per_deg: PlayMap::constant(&grid, 0.0),
        form: RateForm::WellPosed,
        unfolded_rate_deg_s: 1500.0,
        time_order: TimeOrder::Second,
    })?;
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
    Ok(ActuatorModel::new(ActuatorLaw::DynamicPreisach(law), grid.range(), calibration))
}

fn main() -> Result<(), PreisachError> {
    let actuator = actuator(0.021)?;
    let mut voltage = HarmonicSeries { mean: BIAS_VOLT, harmonics: vec![] };
    voltage.set_harmonic(1, Harmonic { cosine: AMPLITUDE_VOLT, sine: 0.0 });
    println!("   Hz  flap amplitude, deg  paper    lag, deg");
    for (hertz, paper) in [(0.2, "10"), (5.0, ""), (10.0, ""), (15.0, "about 4"), (20.0, "")] {
        let orbit = actuator.periodic_response(&voltage, hertz, &PeriodicSettings::default())?;
        let flap = orbit.flap_deg.harmonic(1);
        println!("{hertz:5} {:15.2}       {paper:>7} {:11.1}", flap.amplitude(), flap.phase_deg());
    }
    Ok(())
}
