//! Experiments as values.

use crate::{GapError, Stimulus, error};

/// What a record is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// Made under conditions where the base model holds: it fixes the base model.
    Reference,
    /// What the model has to stand up to.
    Measured,
}

/// Whether a model may be fitted to a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Use {
    /// Fitted to.
    Train,
    /// Kept away from every fit, to judge it.
    HeldOut,
}

/// One uniformly sampled signal with its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    name: String,
    unit: String,
    samples: Vec<f64>,
}

impl Channel {
    /// A signal of at least two finite samples.
    ///
    /// # Errors
    /// [`GapError::TooShort`], [`GapError::NotFinite`].
    pub fn new(
        name: impl Into<String>,
        unit: impl Into<String>,
        samples: Vec<f64>,
    ) -> Result<Self, GapError> {
        let name = name.into();
        error::check_record(&name, &samples, 2)?;
        Ok(Self { name, unit: unit.into(), samples })
    }

    /// Name, for example `command`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Unit of the samples, for example `V`.
    pub fn unit(&self) -> &str {
        &self.unit
    }

    /// The samples, equally spaced in time.
    pub fn samples(&self) -> &[f64] {
        &self.samples
    }
}

/// One record: what was put in, what came out.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    id: String,
    role: Role,
    stated_use: Option<Use>,
    time_step_s: f64,
    input: Channel,
    output: Channel,
}

impl Experiment {
    /// A record whose use is left to a [`crate::SplitRule`].
    ///
    /// | argument | unit | range |
    /// |---|---|---|
    /// | `time_step_s` | s | > 0 |
    /// | `input`, `output` | their own | of one length |
    ///
    /// # Errors
    /// [`GapError::OutOfRange`] for the time step, [`GapError::Length`].
    pub fn new(
        id: impl Into<String>,
        role: Role,
        time_step_s: f64,
        input: Channel,
        output: Channel,
    ) -> Result<Self, GapError> {
        error::check_positive("time step (s)", time_step_s)?;
        let (found, expected) = (output.samples.len(), input.samples.len());
        if found != expected {
            return Err(GapError::Length { what: output.name, found, expected });
        }
        Ok(Self { id: id.into(), role, stated_use: None, time_step_s, input, output })
    }

    /// The same record with a stated use.
    #[must_use]
    pub fn with_use(self, stated_use: Use) -> Self {
        Self { stated_use: Some(stated_use), ..self }
    }

    /// Name of the record, unique in its set.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// What it is for.
    pub fn role(&self) -> Role {
        self.role
    }

    /// Its stated use, if any.
    pub fn stated_use(&self) -> Option<Use> {
        self.stated_use
    }

    /// Time between samples, s.
    pub fn time_step_s(&self) -> f64 {
        self.time_step_s
    }

    /// What was put in.
    pub fn input(&self) -> &Channel {
        &self.input
    }

    /// What came out.
    pub fn output(&self) -> &Channel {
        &self.output
    }

    /// What kind of input it is, seen from its samples.
    pub fn stimulus(&self) -> Stimulus {
        Stimulus::of(&self.input.samples, self.time_step_s)
    }
}
