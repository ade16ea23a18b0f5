//! The errors of this crate.

use preisach_dyn::PreisachError;

/// Why an actuator was not exported.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The name would not compile.
    #[error(
        "the name `{name}` {fault}; take a lower-case letter followed by at most 30 lower-case letters, \
         digits or underscores, such as `flap_actuator`"
    )]
    Name {
        /// The name refused.
        name: String,
        /// What is wrong with it.
        fault: &'static str,
    },
    /// No step functions can be written for this time step.
    #[error("the time step is {time_step_s} s, expected a positive finite number")]
    TimeStep {
        /// The time step refused, s.
        time_step_s: f64,
    },
    /// A stage of the chain is not written in other languages.
    #[error(
        "{list}[{index}] ({stage}) is not exported; identify the actuator again with `--model` of a law \
         without it, or take it out of the actuator file where it does not matter"
    )]
    Stage {
        /// List of the stage: `amplifier` or `linkage`.
        list: &'static str,
        /// Place in the list, from 0.
        index: usize,
        /// Name of the stage, as in an actuator file.
        stage: &'static str,
    },
    /// A law of a kind that this crate does not know.
    #[error("the law `{law}` is not exported; identify the actuator again with another `--model`")]
    Law {
        /// Name of the law.
        law: &'static str,
    },
    /// A delay would need too many stored samples.
    #[error(
        "amplifier[{index}] (Delay) spans {samples} samples of the time step, at most {largest} are kept; \
         export for a time step {factor} times as long or take the delay out"
    )]
    Delay {
        /// Place in the list of amplifier stages, from 0.
        index: usize,
        /// Samples it spans.
        samples: f64,
        /// Samples it may span.
        largest: usize,
        /// Least factor on the time step.
        factor: f64,
    },
    /// A number of the model is NaN or infinite.
    #[error(
        "{number} of the actuator is {value}, expected a finite number; correct the actuator file"
    )]
    NotFinite {
        /// Name of the number.
        number: String,
        /// Its value.
        value: f64,
    },
    /// The actuator itself is refused.
    #[error(transparent)]
    Actuator(#[from] PreisachError),
}
