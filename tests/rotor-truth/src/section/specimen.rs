//! The section that is measured, with what moves it and what reads it.

use super::layout::{CHORD_M, Run, SOUND_M_S};
use super::stall::Stall;
use super::theory::{Flow, Geometry, Loads, Motion, QUARTER_CHORD};
use super::wake::ReturningWake;
use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

/// Samples of a cycle in the march of a stalled section.
const SAMPLES: u32 = 1440;

/// A section with its support and instruments.
#[derive(Debug, Clone, PartialEq)]
pub struct Specimen {
    /// Shape.
    pub geometry: Geometry,
    /// Factors on normal force, moment and hinge moment of the flap.
    pub flap: [f64; 3],
    /// Mach number that the section feels over that of the tunnel.
    pub mach_share: f64,
    /// Share of unsteady flow.
    pub unsteady: f64,
    /// Share of the lag by the wake alone.
    pub wake_lag: f64,
    /// Wakes that return.
    pub returning: Option<ReturningWake>,
    /// How it stalls, if it does.
    pub stall: Option<Stall>,
    /// Chord over the height of the tunnel; 0 in free air.
    pub chord_over_height: f64,
    /// Plunge by which its pivot gives way under the normal force, semichords per `cn`.
    pub give: f64,
    /// What is left in the loads of the inertia of the section in pitch: `cn` over the reduced frequency squared, and the arm
    /// behind the quarter chord, chords.
    pub inertia: [f64; 2],
    /// Gain of all loads.
    pub gain: f64,
    /// Delay of all loads, s.
    pub late_s: f64,
    /// Pitch amplitude read over the true one.
    pub pitch_read: f64,
    /// Part of `cn` that leaks into `cm`.
    pub leak: f64,
}

impl Specimen {
    /// A section of thin-aerofoil theory with a flap chord over chord.
    pub fn believed(flap_chord: f64) -> Self {
        Self {
            geometry: Geometry { flap_chord, pitch_axis: QUARTER_CHORD },
            flap: [1.0; 3],
            mach_share: 0.0,
            unsteady: 1.0,
            wake_lag: 1.0,
            returning: None,
            stall: None,
            chord_over_height: 0.0,
            give: 0.0,
            inertia: [0.0; 2],
            gain: 1.0,
            late_s: 0.0,
            pitch_read: 1.0,
            leak: 0.0,
        }
    }

    /// Loads of the section itself per radian of the true motion at a reduced frequency.
    fn aerodynamic(&self, motion: Motion, mach: f64, k: f64) -> Loads {
        let flow = Flow {
            mach: mach * self.mach_share,
            returning: self.returning,
            unsteady: self.unsteady,
            wake_lag: self.wake_lag,
        };
        let own =
            |motion: Motion| self.geometry.loads(&self.geometry.downwash(motion, k), k, &flow);
        let mut loads = own(motion);
        if motion == Motion::Flap {
            for (own, factor) in loads.iter_mut().zip(self.flap) {
                *own *= factor;
            }
        }
        if self.chord_over_height > 0.0 {
            // images of the lift curve the stream (Allen and Vincenti, NACA Report 782)
            let images = PI * PI / 48.0 * self.chord_over_height.powi(2);
            let angle = self.geometry.downwash(Motion::Plunge, 1.0);
            let of_angle = self.geometry.loads(&angle, k, &flow).map(|own| own / Complex::i());
            let cn = loads[0];
            let turned = images / TAU * (cn + 4.0 * loads[1]);
            for ((own, more), part) in loads.iter_mut().zip(of_angle).zip([1.0, -0.25, 0.0]) {
                *own += turned * more + images * part * cn;
            }
        }
        if self.give != 0.0 {
            // lift pushes the section up, and its plunge makes lift in turn
            let plunge = own(Motion::Plunge);
            let down = -self.give * loads[0] / (1.0 + self.give * plunge[0]);
            for (own, more) in loads.iter_mut().zip(plunge) {
                *own += down * more;
            }
        }
        if motion == Motion::Pitch {
            let [mass, arm] = self.inertia;
            loads[0] += mass * k * k;
            loads[1] -= arm * mass * k * k;
        }
        loads
    }

    /// What the instruments make of loads.
    fn read(&self, [cn, cm, ch]: [f64; 3]) -> [f64; 3] {
        [cn, cm + self.leak * cn, ch].map(|own| self.gain * own)
    }

    /// Delay of the loads, rad of the motion.
    fn late_rad(&self, run: &Run) -> f64 {
        let speed_m_s = run.mach * SOUND_M_S;
        2.0 * run.reduced_frequency * speed_m_s / CHORD_M * self.late_s
    }

    /// First harmonic as read, per radian of the motion as read: in phase and ahead.
    pub fn harmonic(&self, run: &Run) -> [[f64; 2]; 3] {
        let loads = self.aerodynamic(run.motion, run.mach, run.reduced_frequency);
        let turn = Complex::from_polar(1.0, -self.late_rad(run));
        let over = if run.motion == Motion::Pitch { self.pitch_read } else { 1.0 };
        let turned = loads.map(|own| own * turn / over);
        let (real, ahead) =
            (self.read(turned.map(|own| own.re)), self.read(turned.map(|own| own.im)));
        std::array::from_fn(|n| [real[n], ahead[n]])
    }

    /// Loads as read over `count` uniform phases of `sin`, from phase 0.
    pub fn history(&self, run: &Run, count: u32) -> Vec<[f64; 3]> {
        let loads = self.aerodynamic(run.motion, run.mach, run.reduced_frequency);
        let steady = self.aerodynamic(Motion::Pitch, run.mach, 0.0).map(|own| own.re);
        let (mean, amplitude) = (run.mean_deg.to_radians(), run.amplitude_deg.to_radians());
        let attached = |phase: f64| -> [f64; 3] {
            let (sin, cos) = phase.sin_cos();
            std::array::from_fn(|n| {
                mean * steady[n] + amplitude * (loads[n].re * sin + loads[n].im * cos)
            })
        };
        let late = self.late_rad(run);
        let phases = (0..count).map(|n| TAU * f64::from(n) / f64::from(count) - late);
        let Some(stall) = self.stall else {
            return phases.map(|phase| self.read(attached(phase))).collect();
        };
        let all: Vec<f64> = (0..SAMPLES).map(|n| TAU * f64::from(n) / f64::from(SAMPLES)).collect();
        let swing = if run.motion == Motion::Pitch { amplitude } else { 0.0 };
        let incidence: Vec<f64> = all.iter().map(|own| mean + swing * own.sin()).collect();
        let own: Vec<[f64; 3]> = all.iter().map(|own| attached(*own)).collect();
        let own = stall.cycle(run.reduced_frequency, &incidence, &own);
        // between two samples a straight line
        let samples = f64::from(SAMPLES);
        let at = |phase: f64| -> [f64; 3] {
            let place = (phase / TAU).rem_euclid(1.0) * samples;
            let part = place.fract();
            let first = own.iter().zip(0_u32..).find(|(_, n)| f64::from(*n) > place - 1.0);
            let first = first.map_or(0, |(_, n)| n as usize);
            let (a, b) = (own[first], own[(first + 1) % own.len()]);
            std::array::from_fn(|n| a[n] + part * (b[n] - a[n]))
        };
        phases.map(|phase| self.read(at(phase))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(motion: Motion) -> Run {
        Run {
            motion,
            mach: 0.3,
            reduced_frequency: 0.12,
            mean_deg: 4.0,
            amplitude_deg: 3.0,
            group: 1,
        }
    }

    /// A history holds the harmonic per radian, also of a section that would stall far beyond.
    #[test]
    fn history_and_harmonic_are_the_same_loads() {
        for (motion, stall) in
            [(Motion::Pitch, None), (Motion::Flap, None), (Motion::Pitch, Some(Stall::at(1.2)))]
        {
            let late = Specimen { late_s: 0.001, stall, ..Specimen::believed(0.2) };
            let (own, run) = (late.history(&run(motion), 60), run(motion));
            let harmonic = late.harmonic(&run);
            for (n, [real, ahead]) in harmonic.into_iter().enumerate() {
                let sum = |wave: fn(f64) -> f64| -> f64 {
                    let each = own.iter().zip(0_u32..);
                    each.map(|(own, k)| own[n] * wave(TAU * f64::from(k) / 60.0)).sum::<f64>()
                        / (30.0 * run.amplitude_deg.to_radians())
                };
                assert!((sum(f64::sin) - real).abs() < 1e-3, "{motion:?} {n}");
                assert!((sum(f64::cos) - ahead).abs() < 1e-3, "{motion:?} {n}");
            }
        }
    }

    /// Lift of a section between walls at rest, Allen and Vincenti.
    #[test]
    fn walls_add_to_the_lift() {
        let free = Specimen::believed(0.2);
        let walled = Specimen { chord_over_height: 0.4, ..free.clone() };
        let of = |own: &Specimen| own.aerodynamic(Motion::Pitch, 0.0, 0.0).map(|own| own.re);
        let images = PI * PI / 48.0 * 0.16;
        let lift = of(&free)[0] * (1.0 + 2.0 * images);
        assert!((of(&walled)[0] - lift).abs() < 1e-9 * lift);
        assert!((of(&walled)[1] + 0.25 * images * of(&free)[0]).abs() < 1e-9);
    }

    #[test]
    fn a_pivot_that_gives_way_takes_from_the_loads() {
        let held = Specimen::believed(0.2);
        let soft = Specimen { give: 0.05, ..held.clone() };
        let (a, b) = (held.harmonic(&run(Motion::Pitch)), soft.harmonic(&run(Motion::Pitch)));
        assert!((a[0][1] - b[0][1]).abs() > 0.1 && (a[0][0] - b[0][0]).abs() < 0.5);
    }
}
