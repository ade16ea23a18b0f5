//! Actuators of every law, small.
#![allow(dead_code, reason = "every test file uses its own part")]
#![allow(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use preisach_dyn::{
    ActuatorLaw, ActuatorModel, BoucWen, BoucWenParameters, Calibration, DynamicParameters,
    DynamicPreisach, Envelope, EverettStaircase, LinearGain, PlayMap, PrandtlIshlinskii,
    PrandtlParameters, PreisachGrid, RateForm, RelayGrid, StaticPreisach, TimeOrder, VoltageRange,
    WeightedPlay,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

pub(crate) const LOW: f64 = -20.0;
pub(crate) const HIGH: f64 = 150.0;

/// Written to a file and read back.
pub(crate) fn stored<T: Serialize + DeserializeOwned>(value: &T) -> T {
    serde_json::from_str(&serde_json::to_string(value).unwrap()).unwrap()
}

pub(crate) fn map(levels: usize) -> (PreisachGrid, PlayMap) {
    let grid = PreisachGrid::new(VoltageRange::amplified_stack(), levels).unwrap();
    let n = levels as f64;
    let rises: Vec<Vec<f64>> = (0..levels)
        .map(|j| {
            (0..levels - j)
                .map(|k| {
                    let (s, r) = ((2 * k + j) as f64 / n - 1.0, j as f64 / n);
                    let reversible = if j == 0 { 12.0 / n } else { 0.0 };
                    reversible + 20.0 / (n * n) * (-3.0 * r).exp() * (1.2 + (4.0 * s).sin())
                })
                .collect()
        })
        .collect();
    (grid, PlayMap::from_rises(&grid, 0.5, &rises).unwrap())
}

pub(crate) fn plays() -> Vec<WeightedPlay> {
    (1..8_u32)
        .map(|i| WeightedPlay {
            threshold_volt: 4.0 * f64::from(i),
            weight_deg_per_volt: 0.012 * (-0.2 * f64::from(i)).exp(),
        })
        .collect()
}

pub(crate) fn prandtl(
    plays: Vec<WeightedPlay>,
    threshold_growth_s: f64,
    envelope: Envelope,
) -> PrandtlParameters {
    PrandtlParameters {
        range_volt: VoltageRange::amplified_stack(),
        gain_deg_per_volt: 0.06,
        plays,
        threshold_growth_s,
        envelope,
    }
}

pub(crate) fn bouc_wen(exponent: f64, sigma: f64) -> BoucWen {
    BoucWen::new(BoucWenParameters {
        range_volt: VoltageRange::amplified_stack(),
        gain_deg_per_volt: 0.12,
        half_height_deg: 0.9,
        rise_volt: 30.0,
        sigma,
        exponent,
        envelope: Envelope::default(),
    })
    .unwrap()
}

pub(crate) fn linear_law() -> ActuatorLaw {
    ActuatorLaw::Linear(LinearGain { gain_deg_per_volt: 0.12, bias_volt: 65.0 })
}

pub(crate) fn static_law() -> ActuatorLaw {
    let (grid, map) = map(12);
    ActuatorLaw::StaticPreisach(StaticPreisach::new(grid, map).unwrap())
}

pub(crate) fn dynamic_law(form: RateForm) -> ActuatorLaw {
    let (grid, g0_deg) = map(12);
    ActuatorLaw::DynamicPreisach(
        DynamicPreisach::new(DynamicParameters {
            grid,
            g0_deg,
            g1_s: PlayMap::constant(&grid, -0.015),
            g2_s2_per_deg: PlayMap::constant(&grid, 2e-6),
            form,
            unfolded_rate_deg_s: 600.0,
            time_order: TimeOrder::Second,
        })
        .unwrap(),
    )
}

/// One of every law.
pub(crate) fn every_law() -> Vec<ActuatorLaw> {
    let (grid, map) = map(12);
    let envelope = Envelope { offset_deg: 0.2, quadratic: 0.1, cubic: -0.05 };
    vec![
        linear_law(),
        static_law(),
        ActuatorLaw::Everett(EverettStaircase::new(grid, map.clone()).unwrap()),
        ActuatorLaw::RelayGrid(RelayGrid::new(grid, map, 3).unwrap()),
        dynamic_law(RateForm::WellPosed),
        ActuatorLaw::PrandtlIshlinskii(
            PrandtlIshlinskii::new(prandtl(plays(), 5e-4, envelope)).unwrap(),
        ),
        ActuatorLaw::BoucWen(bouc_wen(1.6, 0.8)),
    ]
}

pub(crate) fn plain(law: ActuatorLaw) -> ActuatorModel {
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 3.0 };
    ActuatorModel::new(law, VoltageRange::amplified_stack(), calibration)
}
