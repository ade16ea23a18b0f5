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
    /// Nothing to watch for.
    #[error(
        "with the cause and without it the flap moves alike: there is nothing to watch for; name stages that act on the flap"
    )]
    NoCause,
    /// The cause is no stage of the actuator.
    #[error(
        "there is no stage `{name}` among those of the actuator: {found}; name one of amplifier or linkage, as its file has it"
    )]
    NoStage {
        /// The name given.
        name: String,
        /// The stages there are.
        found: String,
    },
    /// A number of a monitor is zero, negative, NaN or infinite.
    #[error("the {what} is {value}, expected a positive finite number")]
    NotPositive {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A memory of a monitor beside which a sample has no weight.
    #[error(
        "the memory of the monitor is {memory_s} s, expected at most {largest_s} s at this time step: a sample would have no weight; \
         give it some periods of the command, such as 1 s"
    )]
    Memory {
        /// The memory refused, s.
        memory_s: f64,
        /// The longest one, s.
        largest_s: f64,
    },
    /// A monitor of an actuator with stages of a sensor, which step functions leave out.
    #[error(
        "the actuator has stages of a sensor ({stages}), through which its records were measured and which a monitor does not \
         simulate: what they add would be taken for a change of the actuator; watch with a sensor without them and take \
         `sensor` out of the actuator file"
    )]
    Sensor {
        /// Their names.
        stages: String,
    },
    /// The actuator itself is refused.
    #[error(transparent)]
    Actuator(#[from] PreisachError),
}
