//! An actuator with memory and lag.

use preisach_dyn::{
    ActuatorLaw, ActuatorModel, Calibration, DynamicParameters, DynamicPreisach, PlayMap,
    PreisachGrid, RateForm, TimeOrder, VoltageRange,
};

/// The dynamic Preisach operator of eight levels.
pub(crate) fn actuator() -> ActuatorModel {
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
