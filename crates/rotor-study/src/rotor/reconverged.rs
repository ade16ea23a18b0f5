//! T with the geometry of the free wake converged anew, by central differences.

use crate::case::Case;
use crate::rotor::authority::FlapAuthority;
use crate::series::{only, place};
use rayon::prelude::*;
use rotor_response::{Condition, ResponseError, RotorSolver};
use std::collections::BTreeSet;
use trim::{WakeDifference, WakeTrim, WakeTrimSettings, wake_difference};

/// What the differences take.
#[derive(Debug, Clone)]
pub(crate) struct Reconverging {
    /// Harmonics per rev that the case controls.
    harmonics: Vec<usize>,
    /// Step of a flap harmonic, deg.
    step_deg: f64,
    /// The coupling with the free wake of the case; none in another inflow.
    pub(crate) coupling: Option<WakeTrimSettings>,
}

/// [`FlapAuthority`] with the geometry of the wake converged anew at the controlled harmonics.
#[derive(Debug, Clone, PartialEq)]
pub struct ReconvergedAuthority {
    /// The derivatives; of harmonics that the case does not control, and of hinge moments, those with the
    /// geometry held.
    pub authority: FlapAuthority,
    /// The same differences with the geometry held: a check on the linearised rotor.
    pub held: FlapAuthority,
    /// Updates of the wake that the slowest difference took.
    pub updates: usize,
    /// Largest change of a difference in its last update, over its size.
    pub change: f64,
}

/// A cosine or sine of one harmonic of one flap.
#[derive(Clone, Copy)]
struct Motion {
    flap: usize,
    harmonic: usize,
    sine: bool,
}

impl Reconverging {
    pub(crate) fn of(case: &Case) -> Self {
        let harmonics: BTreeSet<usize> = case.control.harmonics.iter().flatten().copied().collect();
        let wake = case.inflow.model.free_wake();
        let coupling = wake.map(|values| case.wake_trim_settings(&values));
        let step_deg = case.control.t_step_deg;
        Self { harmonics: harmonics.into_iter().collect(), step_deg, coupling }
    }

    /// The derivatives about a trim with flaps at rest; `settled` has what is not found anew.
    ///
    /// # Errors
    /// The errors of the response and of the wake.
    pub(crate) fn authority(
        &self,
        wake: &WakeTrim,
        solver: &RotorSolver,
        coupling: &WakeTrimSettings,
        rest: &Condition,
        settled: FlapAuthority,
    ) -> Result<ReconvergedAuthority, ResponseError> {
        let flaps = rest.flap_angles_rad.len();
        let of_flap = |flap| {
            let both = move |&harmonic| [false, true].map(|sine| Motion { flap, harmonic, sine });
            self.harmonics.iter().flat_map(both)
        };
        let motions: Vec<Motion> = (0..flaps).flat_map(of_flap).collect();
        let found = motions
            .par_iter()
            .map(|motion| {
                let [plus, minus] = [1.0, -1.0].map(|side| self.moved(rest, *motion, side));
                wake_difference(wake, solver, coupling, [&plus, &minus])
            })
            .collect::<Result<Vec<WakeDifference>, ResponseError>>()?;
        let per_deg = |difference: [f64; 12]| difference.map(|z| z / (2.0 * self.step_deg));
        let mut made = ReconvergedAuthority {
            authority: settled.clone(),
            held: settled,
            updates: found.iter().map(|d| d.hub.len() - 1).max().unwrap_or(0),
            change: found.iter().map(|d| d.change).fold(0.0, f64::max),
        };
        for (motions, both) in motions.chunks_exact(2).zip(found.chunks_exact(2)) {
            let Motion { flap, harmonic, .. } = motions[0];
            let last = [per_deg(both[0].last()), per_deg(both[1].last())];
            let first = [per_deg(both[0].hub[0]), per_deg(both[1].hub[0])];
            made.authority = made.authority.with_harmonic(flap, harmonic, last);
            made.held = made.held.with_harmonic(flap, harmonic, first);
        }
        Ok(made)
    }

    /// A condition with one harmonic of one flap moved by a step.
    fn moved(&self, rest: &Condition, motion: Motion, side: f64) -> Condition {
        let Motion { flap, harmonic, sine } = motion;
        let mut moved = rest.clone();
        let step_rad = side * self.step_deg.to_radians();
        moved.flap_angles_rad[flap] = only(place(harmonic, sine), step_rad);
        moved
    }
}
