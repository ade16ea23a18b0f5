//! The motion of one flap.

use preisach_dyn::PeriodicResponse;
use rotor_base::HarmonicSeries;
use rotor_base::series::{scaled, weighted};

/// Voltage and angle of one flap over a revolution, against the azimuth of its blade.
#[derive(Debug, Clone, PartialEq)]
pub struct FlapMotion {
    /// Voltage with its bias, V.
    pub voltage_volt: HarmonicSeries,
    /// Flap angle, deg, trailing edge down positive.
    pub flap_deg: HarmonicSeries,
}

impl From<PeriodicResponse> for FlapMotion {
    fn from(PeriodicResponse { voltage_volt, flap_deg, .. }: PeriodicResponse) -> Self {
        Self { voltage_volt, flap_deg }
    }
}

impl FlapMotion {
    /// `factor (self - other)`.
    pub(crate) fn less(&self, other: &Self, factor: f64) -> Self {
        Self {
            voltage_volt: weighted(&self.voltage_volt, &other.voltage_volt, factor),
            flap_deg: weighted(&self.flap_deg, &other.flap_deg, factor),
        }
    }

    /// Flap angle, rad.
    pub fn angle_rad(&self) -> HarmonicSeries {
        scaled(&self.flap_deg, 1.0_f64.to_radians())
    }
}
