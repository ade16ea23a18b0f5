//! The free wake: what it is made of, and where its blades are.

use super::filament::Filament;
use super::settings::{FreeWakeSettings, NearWakeMotion, WakeSymmetry};
use super::sources::RollUp;
use crate::error::{ensure, ensure_finite};
use crate::vector::Vec3;
use crate::{BladeLines, CirculationMap, WakeRotor};
use crate::{FlightState, WakeError};

/// The wake of one of a rotor's alike blades, periodic in azimuth.
///
/// ```text
/// dr/dpsi + dr/dzeta = V_inf + v(r)         hub axes, lengths in R, velocities in Omega R
/// ```
/// Blade `b` of `N_b` at azimuth `psi` has the wake that blade 0 has at that azimuth, so that one grid of
/// azimuth and age holds all of them.
///
/// Source: Bagai and Leishman, J. Am. Helicopter Soc. 40 (1995) 29.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeWake {
    pub(crate) rotor: WakeRotor,
    pub(crate) settings: FreeWakeSettings,
    pub(crate) flight: FlightState,
    /// Mean induced inflow that carries a convected near wake, down positive.
    pub(crate) carrying_inflow: f64,
    pub(crate) lines: BladeLines,
    /// One per spanwise node.
    pub(crate) near: Vec<Filament>,
    /// One per rolled-up vortex.
    pub(crate) far: Vec<Filament>,
}

/// Largest difference between azimuths of an axial wake: blades in their own axes, unit `R`; circulation,
/// `Omega R^2`.
const ALIKE: f64 = 1e-9;

/// A filament of the wake as others see it.
#[derive(Debug, Clone, PartialEq)]
pub struct WakeFilament {
    /// Station that releases it, unit `R`.
    pub release_r: f64,
    /// First age at which it carries vorticity, steps: younger, the near wake does.
    pub first_age: usize,
    /// Nodes in hub axes, unit `R`, `[azimuth][age]`.
    pub points: Vec<Vec<Vec3>>,
}

impl FreeWake {
    /// A wake of undistorted helices, carried by the free stream and a uniform inflow.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for settings or a flight state out of range, and for blades on another
    /// azimuth grid.
    pub fn undistorted(
        rotor: WakeRotor,
        settings: FreeWakeSettings,
        flight: FlightState,
        carrying_inflow: f64,
        lines: BladeLines,
    ) -> Result<Self, WakeError> {
        settings.validate(rotor.blades())?;
        let flight = flight.validated()?;
        ensure_finite("carrying_inflow", &[carrying_inflow])?;
        check_blades(&settings, &flight, &lines)?;
        let azimuths = settings.azimuths;
        let filament = |node, steps| Filament::new(node, steps, azimuths);
        let near = (0..=rotor.panels()).map(|n| filament(n, settings.near_steps())).collect();
        let released = RollUp::release_nodes(&settings.far, &rotor);
        let far = released.into_iter().map(|n| filament(n, settings.far_steps())).collect();
        let mut wake = Self { rotor, settings, flight, carrying_inflow, lines, near, far };
        let start = wake.clone();
        for filament in wake.near.iter_mut().chain(&mut wake.far) {
            let node = filament.node;
            filament.fill(azimuths, |i, k| start.carried(node, i, k));
        }
        wake.place_near_wake();
        Ok(wake)
    }

    /// Rotor and panels.
    pub fn rotor(&self) -> &WakeRotor {
        &self.rotor
    }

    /// The choices.
    pub fn settings(&self) -> &FreeWakeSettings {
        &self.settings
    }

    /// Flight state.
    pub fn flight(&self) -> &FlightState {
        &self.flight
    }

    /// Mean induced inflow that carries a convected near wake, tip speed, down positive.
    pub fn carrying_inflow(&self) -> f64 {
        self.carrying_inflow
    }

    /// Where the blades are.
    pub fn lines(&self) -> &BladeLines {
        &self.lines
    }

    /// The rolled-up vortices from root to tip.
    pub fn vortices(&self) -> Vec<WakeFilament> {
        self.shown(&self.far, self.settings.near_steps())
    }

    /// The trailers of the near wake from root to tip.
    pub fn near_wake(&self) -> Vec<WakeFilament> {
        self.shown(&self.near, 0)
    }

    fn shown(&self, filaments: &[Filament], first_age: usize) -> Vec<WakeFilament> {
        filaments
            .iter()
            .map(|f| WakeFilament {
                release_r: self.rotor.nodes()[f.node],
                first_age,
                points: (0..self.settings.azimuths).map(|i| f.at(i).to_vec()).collect(),
            })
            .collect()
    }

    /// Gives the wake another flight state, blades and mean inflow; the geometry stays as a start.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] as for a new wake.
    pub fn set_condition(
        &mut self,
        flight: FlightState,
        carrying_inflow: f64,
        lines: BladeLines,
    ) -> Result<(), WakeError> {
        check_blades(&self.settings, &flight, &lines)?;
        self.flight = flight.validated()?;
        self.carrying_inflow = carrying_inflow;
        self.lines = lines;
        for filament in &mut self.far {
            for i in 0..self.settings.azimuths {
                let at = filament.index(i, 0);
                filament.points[at] = self.lines.edge_at(i)[filament.node];
            }
        }
        self.place_near_wake();
        Ok(())
    }

    /// Free stream in hub axes, tip speed.
    pub(crate) fn free_stream(&self) -> Vec3 {
        [self.flight.advance_ratio, 0.0, -self.flight.normal_inflow()]
    }

    /// What a body adds to the velocity of the air at a point.
    pub(crate) fn by_the_body(&self, point: Vec3) -> Vec3 {
        self.settings.body.map_or([0.0; 3], |body| body.velocity(point, self.free_stream()))
    }

    /// Instants that differ: after one blade spacing the wakes of all blades are what they were.
    pub(crate) fn phases(&self) -> usize {
        self.settings.azimuths / self.rotor.blades()
    }

    /// Azimuths of the blades at an instant.
    pub(crate) fn blade_azimuths(&self, phase: usize) -> impl Iterator<Item = usize> + use<> {
        let (spacing, blades) = (self.phases(), self.rotor.blades());
        (0..blades).map(move |b| phase + b * spacing)
    }

    /// Whether the wake turns with the blades as it is.
    pub(crate) fn is_axial(&self) -> bool {
        self.settings.symmetry == WakeSymmetry::Axial
    }

    /// Instants whose induced velocities have to be computed.
    pub(crate) fn phases_that_differ(&self) -> usize {
        if self.is_axial() { 1 } else { self.phases() }
    }

    /// Blades at whose wakes they have to be computed.
    pub(crate) fn blades_that_differ(&self) -> usize {
        if self.is_axial() { 1 } else { self.rotor.blades() }
    }

    /// Checks a circulation against the grid.
    pub(crate) fn check(&self, circulation: &CirculationMap) -> Result<(), WakeError> {
        same_azimuths(&self.settings, circulation.azimuths())?;
        let panels = circulation.panels();
        let fits = panels == self.rotor.panels();
        ensure(fits, "panels of the circulation", panels as f64, "the panels of the wake")?;
        if self.is_axial() {
            let first = circulation.row(0);
            let differs = |(k, value): (usize, &f64)| (value - first[k % first.len()]).abs();
            let change = circulation.values().iter().enumerate().map(differs).fold(0.0, f64::max);
            let quantity = "change of the circulation over the azimuth";
            ensure(change <= ALIKE, quantity, change, "none: the wake is axial")?;
        }
        Ok(())
    }

    /// Whether the near wake moves freely, as the rolled-up vortices do.
    pub(crate) fn near_is_free(&self) -> bool {
        self.settings.near_wake_motion == NearWakeMotion::Free
    }

    /// How many of the filaments that move freely are of the near wake: the first ones.
    pub(crate) fn free_of_near(&self) -> usize {
        if self.near_is_free() { self.near.len() } else { 0 }
    }

    /// The filaments that move freely.
    pub(crate) fn free(&self) -> impl Iterator<Item = &Filament> {
        let near = if self.near_is_free() { &self.near[..] } else { &[] };
        near.iter().chain(&self.far)
    }

    /// The same, to be moved.
    pub(crate) fn free_mut(&mut self) -> impl Iterator<Item = &mut Filament> {
        let near = if self.near_is_free() { &mut self.near[..] } else { &mut [] };
        near.iter_mut().chain(&mut self.far)
    }
}

fn same_azimuths(settings: &FreeWakeSettings, given: usize) -> Result<(), WakeError> {
    let quantity = "azimuths of the blades or the circulation";
    let expected = "the azimuth steps of the wake";
    ensure(given == settings.azimuths, quantity, given as f64, expected)
}

/// Refuses blades of another grid, and axial symmetry where the rotor flies or its blades move.
fn check_blades(
    settings: &FreeWakeSettings,
    flight: &FlightState,
    lines: &BladeLines,
) -> Result<(), WakeError> {
    same_azimuths(settings, lines.azimuths())?;
    if settings.symmetry != WakeSymmetry::Axial {
        return Ok(());
    }
    let expected = "0: a wake turns with its blades in axial flight only";
    let mu = flight.advance_ratio;
    ensure(mu == 0.0, "advance_ratio of an axial wake", mu, expected)?;
    let motion = lines.departure_from_turning();
    let quantity = "motion of the blades of an axial wake, R";
    ensure(motion <= ALIKE, quantity, motion, "none over a revolution")
}
