//! The families of models, the records they are fitted to, and the search for their parameters.

use crate::identify::fit::linear_mode::LinearMode;
use crate::identify::fit::output_error::{
    Build, Estimate, Minimum, OutputError, Pull, Slopes, Uncertainty, estimates,
};
use crate::identify::records::prepared::Prepared;
use crate::{ActuatorModel, LinkageStage, LogCreep, PreisachError};
use nalgebra::DVector;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// A family of actuator models, from the simplest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Family {
    /// A gain.
    Linear,
    /// A gain behind a first-order lag of the voltage.
    LinearLag,
    /// Bouc-Wen hysteresis, rate-independent.
    BoucWen,
    /// Bouc-Wen hysteresis before a mode.
    BoucWenMode,
    /// An oscillator with Bouc-Wen hysteresis in its spring.
    HystereticOscillator,
    /// Prandtl-Ishlinskii hysteresis, rate-independent: plays of weights that are not negative.
    PrandtlPlays,
    /// Prandtl-Ishlinskii hysteresis whose half-widths grow with the voltage rate.
    PrandtlIshlinskii,
    /// Prandtl-Ishlinskii stops: an output that leads the input.
    PrandtlStop,
    /// Static Preisach.
    StaticPreisach,
    /// Static Preisach before creep along the logarithm of time.
    StaticPreisachCreep,
    /// Static Preisach before a mode.
    StaticPreisachMode,
    /// Dynamic Preisach, implicit Euler in time.
    DynamicPreisachFirst,
    /// Dynamic Preisach, second order in time.
    DynamicPreisach,
    /// Dynamic Preisach before creep along the logarithm of time.
    DynamicPreisachCreep,
    /// Static Preisach before accommodation, one relaxation time, a share that follows at once, and
    /// creep.
    StaticPreisachRelaxation,
}

impl Family {
    /// All of them, from the simplest.
    pub const ALL: [Self; 15] = [
        Self::Linear,
        Self::LinearLag,
        Self::BoucWen,
        Self::BoucWenMode,
        Self::HystereticOscillator,
        Self::PrandtlPlays,
        Self::PrandtlIshlinskii,
        Self::PrandtlStop,
        Self::StaticPreisach,
        Self::StaticPreisachCreep,
        Self::StaticPreisachMode,
        Self::DynamicPreisachFirst,
        Self::DynamicPreisach,
        Self::DynamicPreisachCreep,
        Self::StaticPreisachRelaxation,
    ];

    /// Name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear gain",
            Self::LinearLag => "linear gain + lag",
            Self::BoucWen => "Bouc-Wen",
            Self::BoucWenMode => "Bouc-Wen + mode",
            Self::HystereticOscillator => "Bouc-Wen oscillator",
            Self::PrandtlPlays => "Prandtl-Ishlinskii plays",
            Self::PrandtlIshlinskii => "rate-dependent Prandtl-Ishlinskii",
            Self::PrandtlStop => "Prandtl-Ishlinskii stops",
            Self::StaticPreisach => "static Preisach",
            Self::StaticPreisachCreep => "static Preisach + creep",
            Self::StaticPreisachMode => "static Preisach + mode",
            Self::DynamicPreisachFirst => "dynamic Preisach, first order",
            Self::DynamicPreisach => "dynamic Preisach, second order",
            Self::DynamicPreisachCreep => "dynamic Preisach + creep",
            Self::StaticPreisachRelaxation => {
                "static Preisach + accommodation + relaxation + creep"
            }
        }
    }

    /// Whether a fit needs records at several frequencies, or of other fast motion.
    pub fn needs_rate(self) -> bool {
        use Family::{DynamicPreisach, DynamicPreisachCreep, DynamicPreisachFirst};
        use Family::{LinearLag, PrandtlIshlinskii, StaticPreisachMode, StaticPreisachRelaxation};
        matches!(
            self,
            LinearLag
                | PrandtlIshlinskii
                | DynamicPreisachFirst
                | DynamicPreisach
                | DynamicPreisachCreep
                | StaticPreisachMode
                | StaticPreisachRelaxation
        )
    }

    /// Whether a fit needs steady cycles at several frequencies; others that depend on rate are found from any motion.
    pub(crate) fn needs_cycles(self) -> bool {
        use Family::{DynamicPreisach, DynamicPreisachCreep, DynamicPreisachFirst};
        matches!(self, DynamicPreisachFirst | DynamicPreisach | DynamicPreisachCreep)
    }

    /// The times that creep is tried to begin, s, the usual one first; of families without it one that means nothing.
    ///
    /// Records tell the time to a decade at best. Creep that begins early is much like a lag: what is left out of the fit has
    /// to ask for it, and beside the rates of a dynamic law nothing tells the two apart.
    pub(crate) fn creep_begins_s(self) -> &'static [f64] {
        match self {
            Self::StaticPreisachCreep => &[0.1, 0.01],
            _ => &[0.1],
        }
    }

    /// Whether a mode is part of it.
    pub fn has_mode(self) -> bool {
        matches!(self, Self::BoucWenMode | Self::HystereticOscillator | Self::StaticPreisachMode)
    }
}

/// A fitted member of a family.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fitted {
    pub(crate) model: ActuatorModel,
    pub(crate) parameters: Vec<Estimate>,
}

impl Fitted {
    /// The creep along the logarithm of time that is part of the model.
    pub(crate) fn log_creep(&self) -> Option<LogCreep> {
        self.model.linkage.iter().find_map(|stage| match stage {
            LinkageStage::LogCreep(creep) => Some(*creep),
            _ => None,
        })
    }
}

/// What a fit takes as given: found once on all training records, it is not sought again in every
/// fold of a cross-validation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Given<'a> {
    /// Smoothness of the rate maps.
    pub(crate) smoothness: f64,
    /// The linear mode nearest to all training records, where a family with a mode is fitted.
    pub(crate) mode: Option<&'a LinearMode>,
    /// A model of the family fitted to all training records, if there is one already.
    pub(crate) whole: Option<&'a Fitted>,
    /// The time creep begins, s, where that is part of the family and not known from elsewhere.
    pub(crate) creep_from_s: f64,
    /// The creep of a fit to records of the same commands: its rate is sought near by, the time it begins is kept.
    pub(crate) creep: Option<LogCreep>,
}

impl Given<'_> {
    /// The parameters of a fold are not looked at, only its model.
    pub(crate) fn uncertainty(&self) -> Uncertainty {
        if self.whole.is_some() { Uncertainty::LeftOut } else { Uncertainty::Wanted }
    }

    /// Where to start a minimisation: at the parameters of the whole fit, or else everywhere.
    pub(crate) fn starts(&self, everywhere: &[DVector<f64>]) -> Vec<DVector<f64>> {
        let at = |f: &Fitted| {
            DVector::from_iterator(f.parameters.len(), f.parameters.iter().map(|p| p.value))
        };
        self.whole.map_or_else(|| everywhere.to_vec(), |fitted| vec![at(fitted)])
    }
}

/// A number in 0..1 from any number.
pub(crate) fn share(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

/// Steps the minimisation may try for each parameter.
const PATIENCE: usize = 4;

/// The minimisation of the output error of a family over some records.
pub(crate) struct Search<'a> {
    pub(crate) family: Family,
    pub(crate) build: Build<'a>,
    pub(crate) records: &'a [&'a Prepared<'a>],
    /// Names of the parameters.
    pub(crate) names: &'a [&'a str],
    /// What is known of the first of them.
    pub(crate) pulls: &'a [Pull],
    pub(crate) slopes: Slopes,
}

impl Search<'_> {
    fn problem(&self, x: DVector<f64>) -> OutputError<'_> {
        OutputError::new(self.build, self.records, self.pulls, x)
    }

    /// The minimum with the smallest error found from some starts, the first of equals.
    pub(crate) fn minimum(&self, starts: &[DVector<f64>]) -> Result<Minimum, PreisachError> {
        let from = |x: &DVector<f64>| self.problem(x.clone()).with(self.slopes).minimise(PATIENCE);
        let found: Vec<Option<Minimum>> = starts.par_iter().map(from).collect();
        let best = found.into_iter().flatten().reduce(|a, b| if b.nrmse < a.nrmse { b } else { a });
        best.ok_or(PreisachError::NotFitted { family: self.family.name() })
    }

    /// The model of a minimum with its parameters, and their standard deviations if they are wanted.
    pub(crate) fn fitted(&self, minimum: Minimum, uncertainty: Uncertainty) -> Fitted {
        let Minimum { x, model, .. } = minimum;
        let covariance = uncertainty.of(|| self.problem(x.clone()));
        Fitted { model, parameters: estimates(self.names, &x, covariance.as_ref()) }
    }
}
