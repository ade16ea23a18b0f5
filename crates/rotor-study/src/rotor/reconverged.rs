//! T with the geometry of the free wake converged anew: linearised, and by central differences as a check.

use crate::rotor::authority::FlapAuthority;
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_base::series::{only, place};
use rotor_case::Case;
use rotor_response::{Condition, FlapDirection, ResponseError, RotorSolver};
use std::collections::BTreeSet;
use trim::{WakeDifference, WakeTrim, WakeTrimSettings, linearised_in_wake, wake_difference};

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
    /// The same with the geometry held.
    pub held: FlapAuthority,
    /// Updates of the wake that the slowest column took.
    pub updates: usize,
    /// Largest size of the last term of the series over the first, or of the last change of a difference over the
    /// difference.
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

    /// Cosine and sine of every controlled harmonic of every flap, pair by pair.
    fn motions(&self, flaps: usize) -> Vec<Motion> {
        let of_flap = |flap| {
            let both = move |&harmonic| [false, true].map(|sine| Motion { flap, harmonic, sine });
            self.harmonics.iter().flat_map(both)
        };
        (0..flaps).flat_map(of_flap).collect()
    }

    /// The derivatives about a trim with flaps at rest, linearised; `settled` has what is not found anew.
    ///
    /// # Errors
    /// The errors of the linearised response and of the wake.
    pub(crate) fn linearised(
        &self,
        (wake, coupling): (&WakeTrim, &WakeTrimSettings),
        solver: &RotorSolver,
        rest: &Condition,
        settled: FlapAuthority,
    ) -> Result<ReconvergedAuthority, ResponseError> {
        let flaps = rest.flap_angles_rad.len();
        let motions = self.motions(flaps);
        let directions: Vec<FlapDirection> = motions
            .iter()
            .map(|Motion { flap, harmonic, sine }| {
                let mut direction = vec![HarmonicSeries::zero(0); flaps];
                direction[*flap] = only(place(*harmonic, *sine), 1.0_f64.to_radians());
                direction
            })
            .collect();
        let found = linearised_in_wake(wake, solver, coupling, rest, &directions, self.step_deg)?;
        Ok(ReconvergedAuthority {
            authority: with_columns(settled.clone(), &motions, &found.hub),
            held: with_columns(settled, &motions, &found.held),
            updates: found.updates,
            change: found.change,
        })
    }

    /// The same by central differences of converged responses, many times as dear.
    ///
    /// # Errors
    /// The errors of the response and of the wake.
    pub(crate) fn by_differences(
        &self,
        (wake, coupling): (&WakeTrim, &WakeTrimSettings),
        solver: &RotorSolver,
        rest: &Condition,
        settled: FlapAuthority,
    ) -> Result<ReconvergedAuthority, ResponseError> {
        let motions = self.motions(rest.flap_angles_rad.len());
        let found = motions
            .par_iter()
            .map(|motion| {
                let [plus, minus] = [1.0, -1.0].map(|side| self.moved(rest, *motion, side));
                wake_difference(wake, solver, coupling, [&plus, &minus])
            })
            .collect::<Result<Vec<WakeDifference>, ResponseError>>()?;
        let per_deg = |difference: [f64; 12]| difference.map(|z| z / (2.0 * self.step_deg));
        let last: Vec<[f64; 12]> = found.iter().map(|d| per_deg(d.last())).collect();
        let first: Vec<[f64; 12]> = found.iter().map(|d| per_deg(d.hub[0])).collect();
        Ok(ReconvergedAuthority {
            authority: with_columns(settled.clone(), &motions, &last),
            held: with_columns(settled, &motions, &first),
            updates: found.iter().map(|d| d.hub.len() - 1).max().unwrap_or(0),
            change: found.iter().map(|d| d.change).fold(0.0, f64::max),
        })
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

/// An authority with other hub loads of some motions, per deg; cosine and sine of a harmonic follow each other.
fn with_columns(
    authority: FlapAuthority,
    motions: &[Motion],
    loads_per_deg: &[[f64; 12]],
) -> FlapAuthority {
    let pairs = motions.chunks_exact(2).zip(loads_per_deg.chunks_exact(2));
    pairs.fold(authority, |made, (motions, loads)| {
        made.with_harmonic(motions[0].flap, motions[0].harmonic, [loads[0], loads[1]])
    })
}
