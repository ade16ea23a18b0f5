//! The power of the actuators in the plant: its limit and its weight.

use crate::flaps::{FlapMotion, FullScale, PlantError};
use crate::plant::PowerOutputs;
use crate::plant::pair_power::watt_per_deg2;
use crate::plant::rotor_plant::{PlantPower, RotorPlant};
use hhc_control::PowerLimit;
use nalgebra::{DMatrix, DVector};
use rotor_base::HarmonicSeries;

/// Part of full scale from which on the motion of a pair is taken for what its power is worked out from: far
/// below any control, so that the form of the power does not jump on the way.
const LEAST_MOTION_PART: f64 = 1e-4;

/// Part of the limit that a cone program aims at: the form moves with the control, and no end of a loop is to lie
/// above the limit.
const LIMIT_AIMED_AT: f64 = 0.999;

impl RotorPlant {
    /// The same with the power of the actuators of one blade limited (W), weighted in the cost (per W), or
    /// both.
    ///
    /// The weight is on the quadratic form of the power at full-scale gain: its outputs stand beside the hub
    /// loads in the measurement, two for each pair, and their squares add up to it. The limit is on the mean power that the
    /// actuators give, none taken back, of the flap motion in the linearised rotor; the form is scaled to it
    /// at every step.
    ///
    /// # Errors
    /// The errors of the linearised rotor.
    pub fn with_power(
        mut self,
        limit_watt: Option<f64>,
        weight_per_watt: f64,
    ) -> Result<Self, PlantError> {
        if limit_watt.is_none() && weight_per_watt == 0.0 {
            return Ok(self);
        }
        let authority = self.rotor.authority()?;
        let watt_per_deg2 = watt_per_deg2(&self.layout, authority, self.rotor.scales());
        self.power = Some(PlantPower { watt_per_deg2, limit_watt, weight_per_watt });
        Ok(self)
    }

    /// The weighted power as outputs beside the hub loads.
    pub fn power_outputs(&self) -> PowerOutputs {
        let Some(power) = &self.power else { return PowerOutputs::default() };
        if power.weight_per_watt == 0.0 {
            return PowerOutputs::default();
        }
        let pairs = power.watt_per_deg2.iter().zip(&self.full_scale);
        let gain = |(watt, full): (&f64, &FullScale)| {
            (power.weight_per_watt * watt).sqrt() * full.stroke_deg / full.amplitude_volt
        };
        PowerOutputs::new(pairs.map(gain).collect())
    }

    /// The limit of the power as it stands at a control vector and the flap motion it makes.
    pub(crate) fn power_limit(
        &self,
        control_volt: &[f64],
        flaps: &[FlapMotion],
    ) -> Result<Option<PowerLimit>, PlantError> {
        let Some(PlantPower { watt_per_deg2, limit_watt: Some(limit), .. }) = &self.power else {
            return Ok(None);
        };
        let amplitudes = self.layout.amplitudes_volt(control_volt).map_err(PlantError::Bias)?;
        let motion = self.pair_motion(flaps);
        let mut form = Vec::with_capacity(amplitudes.len());
        let (mut model, mut moves) = (0.0, false);
        for (pair, watt) in watt_per_deg2.iter().enumerate() {
            let full = &self.full_scale[pair];
            let (amplitude, stroke) = (amplitudes[pair], motion[pair].amplitude());
            let known = amplitude > LEAST_MOTION_PART * full.amplitude_volt;
            let at_full_scale = full.stroke_deg / full.amplitude_volt;
            let gain = if known { stroke / amplitude } else { at_full_scale };
            form.push(watt * gain * gain);
            model += watt * stroke * stroke;
            moves |= known;
        }
        // what cross terms, harmonics of the actuator and the moment at rest add, as it is here
        let motions: Vec<&HarmonicSeries> = flaps.iter().map(|motion| &motion.flap_deg).collect();
        let scale = if moves && model > 0.0 {
            self.rotor.linear_power_watt(&motions)? / model
        } else {
            1.0
        };
        let diagonal = DVector::from_iterator(
            control_volt.len(),
            form.iter().flat_map(|watt| [scale * watt, scale * watt]),
        );
        Ok(Some(PowerLimit {
            quadratic: DMatrix::from_diagonal(&diagonal),
            linear: vec![0.0; control_volt.len()],
            constant: 0.0,
            limit: LIMIT_AIMED_AT * limit,
        }))
    }
}
