//! Control of every set of harmonics with every actuator, and what is said of it beforehand.

mod drives;
mod forecast;
mod inverted;
mod robustness;
mod root_pitch;
mod run;
mod set;
mod study;

pub use drives::Drives;
pub use forecast::{Forecast, ForecastLine, ForecastRecord, forecasts};
pub use robustness::{
    Disturbance, MarginLine, RobustnessCell, robustness_flights, robustness_maps,
};
pub use root_pitch::{Actuation, MotionHarmonic, RootPitchComparison, compare_root_pitch};
pub(crate) use run::ideal_control;
pub use run::{control_all, control_set};
pub(crate) use set::ControlSet;
pub use set::{control_status, least_effort};
pub use study::ControlStudy;

/// An actuator with memory and lag: the dynamic Preisach operator of eight levels.
#[cfg(test)]
pub(crate) fn memory_actuator() -> preisach_dyn::ActuatorModel {
    use preisach_dyn::{
        ActuatorLaw, ActuatorModel, Calibration, DynamicParameters, DynamicPreisach, PlayMap,
        PreisachGrid, RateForm, TimeOrder, VoltageRange,
    };
    let grid = PreisachGrid::new(VoltageRange::amplified_stack(), 8).unwrap();
    let rises: Vec<Vec<f64>> =
        (0..8).map(|j| vec![if j == 0 { 2.0 } else { 0.15 }; 8 - j]).collect();
    let law = DynamicPreisach::new(DynamicParameters {
        grid,
        g0_deg: PlayMap::from_rises(&grid, 0.0, &rises).unwrap(),
        g1_s: PlayMap::constant(&grid, -0.024),
        g2_s2_per_deg: PlayMap::constant(&grid, 0.0),
        form: RateForm::WellPosed,
        unfolded_rate_deg_s: 500.0,
        time_order: TimeOrder::Second,
    })
    .unwrap();
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
    ActuatorModel::new(ActuatorLaw::DynamicPreisach(law), grid.range(), calibration)
}
