//! Lag states of a motion that repeats, without marching until they do.

use crate::{AeroError, MarchingSection, SectionInputs, SectionState, StepFactors};

/// One step of a cycle: the section at its end, the inputs at its end, and its length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleStep<'a> {
    /// The section over the step.
    pub section: &'a MarchingSection,
    /// The inputs at the end of the step.
    pub inputs: SectionInputs,
    /// Length of the step, semichords.
    pub semichords: f64,
}

/// The state at the start of a cycle that repeats for ever: marched once round it comes back to
/// itself.
///
/// ```text
/// x(end) = D x(start) + r,   D = product of all decays:      x(start) = r / (1 - D),  lag by lag
/// ```
/// One cycle is marched to find `r`; no cycle more. The last step's inputs are those of the start.
///
/// # Errors
/// [`AeroError::BadInput`] if there is no step, a step is negative or the cycle has no length, or an
/// input is not finite; [`AeroError::StateMismatch`] if the sections have different lags.
pub fn periodic_state(cycle: &[CycleStep<'_>]) -> Result<SectionState, AeroError> {
    let Some(last) = cycle.last() else {
        return Err(no_length(0.0));
    };
    let start = SectionState::settled(last.section, &last.inputs.modes);
    let mut state = start.clone();
    let mut kept = vec![1.0; start.lags()];
    let mut length = 0.0;
    for step in cycle {
        let factors = StepFactors::new(step.section, step.semichords)?;
        state.step_with(step.section, &step.inputs, &factors)?;
        for (kept, decay) in kept.iter_mut().zip(factors.kept(step.section)) {
            *kept *= decay;
        }
        length += step.semichords;
    }
    if kept.iter().any(|kept| *kept >= 1.0) {
        return Err(no_length(length));
    }
    // the state marched from `start` is short by `D` times what `start` is short of the answer
    start.moved_toward(&state, &kept.iter().map(|kept| 1.0 / (1.0 - kept)).collect::<Vec<_>>())
}

fn no_length(value: f64) -> AeroError {
    AeroError::BadInput {
        quantity: "length of the cycle, semichords",
        value,
        expected: "more than 0, in one step or more",
    }
}
