//! Actuators of every law, small, and every stage alone.
#![allow(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use preisach_dyn::{
    Accommodation, ActuatorLaw, ActuatorModel, AmplifierStage, Backlash, BoucWen,
    BoucWenParameters, Calibration, CoulombFriction, CurrentLimit, Delay, Depolarisation,
    DielectricHeating, Drive, DynamicParameters, DynamicPreisach, Envelope, KelvinVoigt,
    KelvinVoigtElement, Lag, LinearGain, LinkageStage, LoadStiffness, LogCreep, MainsHum,
    Nonlinearity, NonlinearityShape, PlayMap, PrandtlIshlinskii, PrandtlParameters, PrandtlStop,
    PreisachGrid, Quantisation, RateForm, Relaxation, RelaxationElement, Resonance, Saturation,
    SensorStage, StaticPreisach, StopParameters, TimeOrder, VoltageRange, WeightedPlay,
    WeightedStop,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

pub(crate) const LOW: f64 = -20.0;
pub(crate) const HIGH: f64 = 150.0;

/// Written to a file and read back.
pub(crate) fn stored<T: Serialize + DeserializeOwned>(value: &T) -> T {
    serde_json::from_str(&serde_json::to_string(value).unwrap()).unwrap()
}

/// A density with structure: a wave across the centres, falling with the half-width, and a
/// reversible part.
#[derive(Clone, Copy)]
pub(crate) struct Wavy {
    /// Output of the lowest state, deg.
    pub(crate) constant_deg: f64,
    /// Rise of the reversible part over the range, deg.
    pub(crate) reversible_deg: f64,
    /// Scale of the rises of the plays, deg.
    pub(crate) scale_deg: f64,
    /// Mean of the wave, above its height so that no density is negative.
    pub(crate) mean: f64,
    /// Height of the wave.
    pub(crate) height: f64,
    /// Waves per half range, rad.
    pub(crate) waves: f64,
}

impl Wavy {
    /// With a reversible part.
    pub(crate) const SOFT: Self = Self {
        constant_deg: 0.5,
        reversible_deg: 12.0,
        scale_deg: 20.0,
        mean: 1.2,
        height: 1.0,
        waves: 4.0,
    };

    /// Less reversible, wider loops.
    pub(crate) const WIDE: Self = Self { reversible_deg: 6.0, scale_deg: 30.0, ..Self::SOFT };

    /// Plays alone, a gentle wave.
    pub(crate) const GENTLE: Self = Self {
        constant_deg: 0.0,
        reversible_deg: 0.0,
        scale_deg: 60.0,
        mean: 1.0,
        height: 0.5,
        waves: 2.0,
    };

    pub(crate) fn map(self, levels: usize) -> (PreisachGrid, PlayMap) {
        let grid = PreisachGrid::new(VoltageRange::amplified_stack(), levels).unwrap();
        let n = levels as f64;
        let rises: Vec<Vec<f64>> = (0..levels)
            .map(|j| {
                (0..levels - j)
                    .map(|k| {
                        let (s, r) = ((2 * k + j) as f64 / n - 1.0, j as f64 / n);
                        let reversible = if j == 0 { self.reversible_deg / n } else { 0.0 };
                        let wave = self.mean + self.height * (self.waves * s).sin();
                        reversible + wave * (-3.0 * r).exp() * self.scale_deg / (n * n)
                    })
                    .collect()
            })
            .collect();
        (grid, PlayMap::from_rises(&grid, self.constant_deg, &rises).unwrap())
    }

    pub(crate) fn law(self, levels: usize) -> StaticPreisach {
        let (grid, map) = self.map(levels);
        StaticPreisach::new(grid, map).unwrap()
    }
}

pub(crate) fn map(levels: usize) -> (PreisachGrid, PlayMap) {
    Wavy::SOFT.map(levels)
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
    let envelope = Envelope { offset_deg: 0.2, quadratic: 0.1, cubic: -0.05 };
    vec![
        linear_law(),
        static_law(),
        dynamic_law(RateForm::WellPosed),
        ActuatorLaw::PrandtlIshlinskii(
            PrandtlIshlinskii::new(prandtl(plays(), 5e-4, envelope)).unwrap(),
        ),
        ActuatorLaw::BoucWen(bouc_wen(1.6, 0.8)),
        ActuatorLaw::PrandtlStop(
            PrandtlStop::new(StopParameters {
                range_volt: VoltageRange::amplified_stack(),
                stiffness_deg_per_volt: 0.06,
                stops: vec![
                    WeightedStop { threshold_volt: 10.0, stiffness_deg_per_volt: 0.03 },
                    WeightedStop { threshold_volt: 30.0, stiffness_deg_per_volt: 0.02 },
                ],
                viscosity_deg_s_per_volt: 1e-4,
                offset_deg: 0.2,
            })
            .unwrap(),
        ),
    ]
}

pub(crate) fn plain(law: ActuatorLaw) -> ActuatorModel {
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 3.0 };
    ActuatorModel::new(law, VoltageRange::amplified_stack(), calibration)
}

/// Gain 1 deg/V, zero at 0 V, 1 deg/um: a stage's output can be read off in its own unit.
pub(crate) fn unit() -> ActuatorModel {
    let range = VoltageRange::new(-1e4, 1e4).unwrap();
    ActuatorModel {
        calibration: Calibration { deg_per_um: 1.0, zero_um: 0.0 },
        ..ActuatorModel::linear(range, 1e4, 1.0)
    }
}

pub(crate) fn amplifier(stage: AmplifierStage) -> ActuatorModel {
    ActuatorModel { amplifier: vec![stage], ..unit() }
}

pub(crate) fn linkage(stage: LinkageStage) -> ActuatorModel {
    ActuatorModel { linkage: vec![stage], ..unit() }
}

pub(crate) fn sensor(stage: SensorStage) -> ActuatorModel {
    ActuatorModel { sensor: vec![stage], ..unit() }
}

/// What the bench reads.
pub(crate) fn measured(model: &ActuatorModel, input: &[f64], step_s: f64) -> Vec<f64> {
    model.simulate_bench(&Drive::new(input, step_s)).unwrap().measured_deg
}

pub(crate) fn sampled(samples: u32, step_s: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..samples).map(|i| f(f64::from(i) * step_s)).collect()
}

pub(crate) fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs()))
}

/// Every stage, alone, doing something.
pub(crate) fn effects() -> Vec<ActuatorModel> {
    let element = KelvinVoigtElement { compliance_ratio: 0.05, time_constant_s: 0.03 };
    vec![
        amplifier(AmplifierStage::Lag(Lag { tau_s: 2e-3 })),
        amplifier(AmplifierStage::CurrentLimit(CurrentLimit { slew_rate_volt_per_s: 2e3 })),
        amplifier(AmplifierStage::Saturation(Saturation::sharp(-5.0, 120.0))),
        amplifier(AmplifierStage::Delay(Delay { delay_s: 1.7e-3 })),
        amplifier(AmplifierStage::DielectricHeating(DielectricHeating::new(0.2, 2e-3))),
        amplifier(AmplifierStage::Depolarisation(Depolarisation {
            repoling_volt: Some(60.0),
            ..Depolarisation::new(20.0)
        })),
        amplifier(AmplifierStage::Depolarisation(Depolarisation {
            loss_per_volt: 0.0,
            loss_per_volt_second: 0.01,
            ..Depolarisation::new(20.0)
        })),
        linkage(LinkageStage::LogCreep(LogCreep::new(0.02))),
        linkage(LinkageStage::KelvinVoigt(KelvinVoigt { elements: vec![element] })),
        linkage(LinkageStage::Relaxation(Relaxation {
            elements: vec![RelaxationElement { share: 0.9, time_constant_s: 5e-3 }],
        })),
        linkage(LinkageStage::Resonance(Resonance { frequency_hz: 90.0, damping_ratio: 0.03 })),
        linkage(LinkageStage::Backlash(Backlash { width_um: 3.0 })),
        linkage(LinkageStage::CoulombFriction(CoulombFriction { width_um: 3.0 })),
        linkage(LinkageStage::Accommodation(Accommodation { share: 0.05, travel_um: 60.0 })),
        linkage(LinkageStage::LoadStiffness(LoadStiffness {
            stiffness_ratio: 0.1,
            compliance_um_per_newton: 0.0,
        })),
        sensor(SensorStage::Filter(Lag { tau_s: 1e-3 })),
        sensor(SensorStage::Nonlinearity(Nonlinearity {
            amplitude_um: 0.5,
            half_range_um: 150.0,
            shape: NonlinearityShape::Cubic,
        })),
        sensor(SensorStage::Quantisation(Quantisation { step_um: 0.5 })),
        sensor(SensorStage::Delay(Delay { delay_s: 2.2e-3 })),
        sensor(SensorStage::MainsHum(MainsHum {
            amplitude_um: 0.3,
            frequency_hz: 50.0,
            phase_rad: 0.4,
        })),
    ]
}
