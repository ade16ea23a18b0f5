//! How hard the sections of a solution work: the largest lift coefficient over the disk.

use crate::{RotorSolution, RotorSolver};

/// Speed normal to the leading edge below which a section is not looked at, tip speed: next to the reversed
/// flow any incidence is large, and a twentieth of the tip's dynamic pressure loads nothing.
const LEAST_SPEED: f64 = 0.22;

/// The section that lifts hardest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionLift {
    /// Its lift coefficient, from the bound circulation.
    pub lift_coefficient: f64,
    /// Station, R.
    pub station: f64,
    /// Azimuth, rad; 3 pi / 2 is the retreating blade.
    pub azimuth_rad: f64,
}

impl RotorSolver {
    /// Largest lift coefficient of a section over the revolution, where it has a speed of
    /// at least 0.22 of the tip's.
    ///
    /// ```text
    /// c_l = 2 Gamma / (c U),   U = x + mu sin psi
    /// ```
    /// None if no section lifts.
    pub fn largest_section_lift(&self, solution: &RotorSolution) -> Option<SectionLift> {
        let x = self.rotor().blade().grid().x();
        let model = self.rotor().model();
        let mut largest: Option<SectionLift> = None;
        for (azimuth_rad, row) in self.time.points().iter().zip(&solution.lifting) {
            let stations = &x[x.len() - row.len()..];
            for (station, section) in stations.iter().zip(row) {
                let speed = station + self.advance_ratio * azimuth_rad.sin();
                if speed < LEAST_SPEED {
                    continue;
                }
                let lift_coefficient =
                    2.0 * section.circulation / (model.chord_at(*station) * speed);
                if largest.is_none_or(|most| lift_coefficient > most.lift_coefficient) {
                    let (station, azimuth_rad) = (*station, *azimuth_rad);
                    largest = Some(SectionLift { lift_coefficient, station, azimuth_rad });
                }
            }
        }
        largest
    }
}
