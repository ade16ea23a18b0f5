//! Settings of an identification.

use crate::check::{check_count, check_positive, check_that};
use crate::identify::SplitRule;
use crate::{
    ActuatorLaw, ActuatorModel, Calibration, PreisachError, RateForm, TimeOrder, VoltageRange,
};
use serde::{Deserialize, Serialize};

/// Which output is called zero flap angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum FlapZero {
    /// The mean output over the steady cycles of the largest quasi-static record: the flap is
    /// rigged with the actuator cycling slowly about its bias.
    #[default]
    MajorLoopMean,
    /// The zero of the records.
    AsRecorded,
}

/// How the weight of the smoothness of `mu1` and `mu2` is found.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub enum RateSmoothness {
    /// By leaving out each fast training record in turn; 1e-3 if there are fewer than three.
    #[default]
    CrossValidated,
    /// As given.
    Fixed(f64),
}

/// Settings of an identification.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Voltages the actuator may see, V.
    pub range_volt: VoltageRange,
    /// Equivalent flap angle per displacement, deg/um: the gain the records were made with.
    pub deg_per_um: f64,
    /// Levels of the memory and of `mu0`.
    pub levels: usize,
    /// Levels of `mu1` and `mu2`; a divisor of `levels`.
    pub rate_levels: usize,
    /// Weight of the smoothness of `mu0`, relative to the squared error of a fit.
    pub static_smoothness: f64,
    /// Weight of the smoothness of `mu1` and `mu2`, likewise.
    pub rate_smoothness: RateSmoothness,
    /// Smallest relaxation time, s.
    pub least_relaxation_s: f64,
    /// No reachable state may fold below this times the fastest trained output rate.
    pub rate_margin: f64,
    /// Form of the dynamic model.
    pub form: RateForm,
    /// Order of the time integration.
    pub time_order: TimeOrder,
    /// Rounds of `mu0` and `mu1, mu2` after one another.
    pub rounds: usize,
    /// Harmonics of the steady cycles.
    pub harmonics: usize,
    /// Steps the refinement may try for each of its parameters; 0 leaves it out.
    pub refinement_patience: usize,
    /// Which records train, where they do not say it themselves.
    pub split: SplitRule,
    /// Which output is zero flap angle.
    pub zero: FlapZero,
}

impl Default for Settings {
    /// 24 levels, 4 for the rate maps.
    ///
    /// The rate levels were chosen on the fast training runs of the shipped bench set, each left
    /// out in turn: 2, 4, 6, 8 and 12 levels give 4.5, 4.4, 4.3, 4.4 and 4.3 %, so few are enough.
    fn default() -> Self {
        Self {
            range_volt: VoltageRange::amplified_stack(),
            deg_per_um: 1.0,
            levels: 24,
            rate_levels: 4,
            static_smoothness: 1e-4,
            rate_smoothness: RateSmoothness::CrossValidated,
            least_relaxation_s: 1e-4,
            rate_margin: 1.5,
            form: RateForm::WellPosed,
            time_order: TimeOrder::Second,
            rounds: 3,
            harmonics: 20,
            refinement_patience: 1,
            split: SplitRule::default(),
            zero: FlapZero::MajorLoopMean,
        }
    }
}

impl Settings {
    /// An untrained actuator of a law, in the units of the records.
    pub(crate) fn actuator_of(&self, law: ActuatorLaw) -> ActuatorModel {
        let calibration = Calibration { deg_per_um: self.deg_per_um, zero_um: 0.0 };
        ActuatorModel::new(law, self.range_volt, calibration)
    }

    pub(crate) fn check(&self) -> Result<(), PreisachError> {
        for (quantity, value) in [
            ("deg_per_um", self.deg_per_um),
            ("static_smoothness", self.static_smoothness),
            ("least_relaxation_s", self.least_relaxation_s),
            ("rate_margin", self.rate_margin),
        ] {
            check_positive(quantity, value)?;
        }
        if let RateSmoothness::Fixed(value) = self.rate_smoothness {
            check_positive("rate_smoothness", value)?;
        }
        for (quantity, value, least) in [
            ("levels", self.levels, 2),
            ("rate_levels", self.rate_levels, 1),
            ("rounds", self.rounds, 1),
            ("harmonics", self.harmonics, 3),
        ] {
            check_count(quantity, value, least)?;
        }
        let divides = self.levels.is_multiple_of(self.rate_levels);
        let expected = format!("a divisor of levels ({})", self.levels);
        check_that(divides, "rate_levels", self.rate_levels as f64, expected)
    }
}
