//! Where tip vortices cut vertical planes along the flight, as vortices are measured.

use super::FreeWake;
use crate::vector::{Vec3, add, scale};

/// Where the tip vortex of a blade cuts a plane of constant `Y`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VortexCrossing {
    /// Blade that trails the vortex, from 0: blade `b` of `N_b` is `2 pi b / N_b` ahead of the first.
    pub blade: usize,
    /// Age of the vortex there, rad of azimuth since it left the blade.
    pub age_rad: f64,
    /// Point in hub axes, unit `R`: X aft, Y starboard, Z up along the shaft, from the centre of the hub.
    pub point: Vec3,
}

impl FreeWake {
    /// Where the tip vortices of all blades cut the plane `Y = plane_y` (unit `R`) with the first blade at one azimuth of the
    /// grid, counted in steps: blade by blade, the youngest first. A vortex is straight between its nodes; that of the
    /// near wake counts from the blade on.
    pub fn tip_vortex_crossings(&self, azimuth: usize, plane_y: f64) -> Vec<VortexCrossing> {
        let phase = azimuth % self.phases();
        let turned = azimuth / self.phases();
        let blades = self.rotor.blades();
        let step = self.settings.step_rad();
        let of = |blade: usize| {
            let at = self.blade_azimuths(phase).nth((turned + blade) % blades).unwrap_or(phase);
            let nodes = self.far.last().map_or(&[][..], |tip| tip.at(at));
            crossings(nodes, plane_y).map(move |(steps, point)| VortexCrossing {
                blade,
                age_rad: steps * step,
                point,
            })
        };
        (0..blades).flat_map(of).collect()
    }
}

/// Age in steps and point of every crossing of straight segments between nodes; a node on the plane counts once.
fn crossings(nodes: &[Vec3], plane_y: f64) -> impl Iterator<Item = (f64, Vec3)> {
    nodes.windows(2).enumerate().filter_map(move |(k, pair)| {
        let [from, to] = [pair[0], pair[1]];
        let cuts = (from[1] < plane_y) != (to[1] < plane_y);
        let t = (plane_y - from[1]) / (to[1] - from[1]);
        cuts.then(|| (k as f64 + t, add(scale(from, 1.0 - t), scale(to, t))))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BladeLines, FlightState, FreeWakeSettings, WakeRotor};
    use std::f64::consts::{PI, TAU};

    /// Flat blades that leave helices `(cos(psi - zeta) + mu zeta, sin(psi - zeta), -lambda zeta)` behind their tips.
    fn helices() -> FreeWake {
        let rotor = WakeRotor::uniform(4, 0.2, 8).unwrap();
        let settings = FreeWakeSettings { azimuths: 72, ..FreeWakeSettings::default() };
        let flight = FlightState { advance_ratio: 0.2, shaft_tilt_rad: 0.0 };
        let lines = BladeLines::flat(&rotor, 72);
        FreeWake::undistorted(rotor, settings, flight, 0.05, lines).unwrap()
    }

    /// In a plane through nodes of the helix the crossings are those of the helix itself: `sin(psi - zeta) = 1/2`.
    #[test]
    fn a_helix_is_cut_where_it_is() {
        let wake = helices();
        let step = wake.settings().step_rad();
        let last = wake.vortices().pop().unwrap().points[0].len() - 1;
        for azimuth in [0, 4, 30, 71] {
            let mut expected = Vec::new();
            for blade in 0..4 {
                let psi = azimuth as f64 * step + TAU * blade as f64 / 4.0;
                let mut ages: Vec<f64> = (-1..12)
                    .flat_map(|turn| [PI / 6.0, 5.0 * PI / 6.0].map(|at| (at, turn)))
                    .map(|(at, turn)| psi - at + TAU * f64::from(turn))
                    .filter(|age| (-1e-9..last as f64 * step + 1e-9).contains(age))
                    .collect();
                ages.sort_by(f64::total_cmp);
                expected.extend(ages.into_iter().map(|age| {
                    let along = (psi - age).cos() + 0.2 * age;
                    (blade, age, [along, 0.5, -0.05 * age])
                }));
            }
            // rounding decides on which side a node of the plane is, at the ends of a filament whether it is cut
            let plane = 0.5 + 1e-13;
            let inside = |age: f64| age > 1e-6 && age < last as f64 * step - 1e-6;
            expected.retain(|(_, age, _)| inside(*age));
            let mut found = wake.tip_vortex_crossings(azimuth, plane);
            found.retain(|crossing| inside(crossing.age_rad));
            assert_eq!(found.len(), expected.len(), "at {azimuth}");
            assert!(found.len() >= 28, "{}", found.len());
            for (found, (blade, age, point)) in found.iter().zip(&expected) {
                assert_eq!(found.blade, *blade);
                assert!((found.age_rad - age).abs() < 1e-10, "{} {age}", found.age_rad);
                for (a, b) in found.point.iter().zip(point) {
                    assert!((a - b).abs() < 1e-10, "{a} {b}");
                }
            }
        }
    }

    /// Between nodes the crossing is on the chord, half way for a plane through its middle.
    #[test]
    fn between_nodes_a_vortex_is_straight() {
        let wake = helices();
        let nodes = wake.vortices().pop().unwrap().points[0].clone();
        let middle = scale(add(nodes[40], nodes[41]), 0.5);
        let found = wake.tip_vortex_crossings(0, middle[1]);
        let at = |age: f64| (age / wake.settings().step_rad() - 40.5).abs() < 1e-9;
        let found = found.iter().find(|c| c.blade == 0 && at(c.age_rad)).unwrap();
        assert!(found.point.iter().zip(middle).all(|(a, b)| (a - b).abs() < 1e-12));
        assert!(wake.tip_vortex_crossings(0, 1.1).is_empty());
    }
}
