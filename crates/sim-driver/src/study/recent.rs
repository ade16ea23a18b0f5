//! Flap motions asked for lately: the controller asks several times about the same voltages.

use super::{FlapDrive, FlapMotion, PlantError};
use rotor_base::Harmonic;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex};

/// Motions kept.
const KEPT: usize = 64;

type Key = Vec<(usize, u64, u64)>;
type Answer = Result<FlapMotion, PlantError>;

/// The latest answers of one drive, shared by the clones of a plant. A motion depends on its voltages alone,
/// so what is remembered is what would be found again, to the bit.
#[derive(Debug, Clone, Default)]
pub(super) struct RecentMotions {
    kept: Arc<Mutex<VecDeque<(Key, Answer)>>>,
}

impl RecentMotions {
    /// [`FlapDrive::motion`], asked for once while it is remembered.
    pub(super) fn motion(&self, drive: &FlapDrive, voltages: &[(usize, Harmonic)]) -> Answer {
        let key: Key =
            voltages.iter().map(|(n, h)| (*n, h.cosine.to_bits(), h.sine.to_bits())).collect();
        if let Ok(kept) = self.kept.lock()
            && let Some((_, answer)) = kept.iter().find(|(known, _)| *known == key)
        {
            return answer.clone();
        }
        let answer = drive.motion(voltages);
        if let Ok(mut kept) = self.kept.lock() {
            if kept.len() >= KEPT {
                kept.pop_front();
            }
            kept.push_back((key, answer.clone()));
        }
        answer
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use preisach_dyn::VoltageRange;

    #[test]
    fn what_is_remembered_is_what_would_be_found() {
        let drive = |gain_deg_per_volt| FlapDrive::Ideal {
            gain_deg_per_volt,
            bias_volt: 65.0,
            range_volt: VoltageRange::new(-20.0, 150.0).unwrap(),
        };
        let recent = RecentMotions::default();
        let at = |volt: f64| vec![(3, Harmonic { cosine: volt, sine: 1.0 })];
        for volt in [10.0, 20.0, 1000.0, 10.0] {
            assert_eq!(recent.motion(&drive(0.1), &at(volt)), drive(0.1).motion(&at(volt)));
        }
        // it was remembered: another drive is not asked
        assert_eq!(recent.motion(&drive(0.2), &at(20.0)), drive(0.1).motion(&at(20.0)));
        for k in 0..KEPT {
            let _ = recent.motion(&drive(0.1), &at(30.0 + k as f64));
        }
        assert_eq!(recent.motion(&drive(0.2), &at(20.0)), drive(0.2).motion(&at(20.0)));
    }
}
