//! From loads of the hub to readings.
//!
//! ```text
//! F_read = g F / (1 - (n O/w)^2 + 2 i z n O/w) e^(-i n (dpsi + O tau)),   F = F_c - i F_s,   n > 0
//! ```

use crate::physics::fourier::Pair;

/// A mode of the support.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SupportMode {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Damping over critical.
    pub damping: f64,
}

/// What lies between a load and its reading.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Path {
    /// Turn of the hub channels, deg of azimuth, late positive.
    pub azimuth_deg: f64,
    /// Delay of the hub channels, s.
    pub delay_s: f64,
    /// Mode of the support, if any.
    pub support: Option<SupportMode>,
    /// Collective read less the true one, deg.
    pub collective_deg: f64,
    /// Hub load, harmonic and gain of an instrument that is off.
    pub gain: Option<(usize, usize, f64)>,
}

impl Path {
    /// A hub load as read.
    pub fn read(&self, load: usize, harmonic: usize, omega_rad_s: f64, own: Pair) -> Pair {
        let gain = match self.gain {
            Some((k, n, gain)) if k == load && n == harmonic => gain,
            _ => 1.0,
        };
        let n = harmonic as f64;
        let late = n * (self.azimuth_deg.to_radians() + omega_rad_s * self.delay_s);
        let read = own.later(late).times(gain);
        match self.support {
            Some(mode) if harmonic > 0 => {
                let r = n * omega_rad_s / (std::f64::consts::TAU * mode.frequency_hz);
                let (real, imaginary) = (1.0 - r * r, 2.0 * mode.damping * r);
                read.later(imaginary.atan2(real)).times(1.0 / real.hypot(imaginary))
            }
            _ => read,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reading_is_late_and_amplified() {
        let own = Pair { cosine: 3.0, sine: -1.0 };
        let late = Path { delay_s: 1e-3, azimuth_deg: 2.0, ..Path::default() };
        let read = late.read(2, 4, 40.0, own);
        let by = 2.0_f64.to_radians() + 0.04;
        let at =
            |own: Pair, psi: f64| own.cosine * (4.0 * psi).cos() + own.sine * (4.0 * psi).sin();
        assert!((at(read, 1.1) - at(own, 1.1 - by)).abs() < 1e-12);
        let support = Some(SupportMode { frequency_hz: 50.0, damping: 0.0 });
        let read = Path { support, ..Path::default() }.read(0, 4, 40.0, own);
        let r: f64 = 160.0 / (std::f64::consts::TAU * 50.0);
        assert!((read.cosine - own.cosine / (1.0 - r * r)).abs() < 1e-12);
    }
}
