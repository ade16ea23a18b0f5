//! The words of the reasons.

use super::Reason;
use std::fmt;

impl fmt::Display for Reason {
    #[expect(clippy::too_many_lines, reason = "a table: one arm per reason")]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |share: &f64| format!("{:.0} %", 100.0 * share);
        match self {
            Self::WorseHeldOut => f.write_str("the extended model is worse on held-out runs"),
            Self::GainMayBeZero => {
                f.write_str("the gain on held-out runs may be zero: the name is tentative")
            }
            Self::NameDropped => {
                f.write_str("the misfit of the base model is within the floor: the name is dropped")
            }
            Self::StructureLeft { share, chi2, floor } => write!(
                f,
                "{} of the excess is explained; structure is left along the generic directions: chi-square {chi2:.0}, floor {floor:.0}",
                percent(share)
            ),
            Self::MisfitLeft { share } => write!(
                f,
                "{} of the misfit of the base model above its floor is explained: most of it has another cause",
                percent(share)
            ),
            Self::MisfitOfRunsLeft { share } => write!(
                f,
                "{} of the misfit of the runs that stand out is explained: most of it has another cause",
                percent(share)
            ),
            Self::RunsStandOut { runs, times } => write!(
                f,
                "{runs} of the runs stand out with the named causes too, the worst by {times:.1} times the residual of the worst surrogate there"
            ),
            Self::NotMeasured { signal } => {
                write!(f, "the name is tentative: {signal} was not measured")
            }
            Self::NotExcluded { cause, other, is_open, delta_chi2, threshold } => {
                let how = if *is_open { "is not excluded" } else { "is barely excluded" };
                write!(
                    f,
                    "{other} in the place of {cause} {how}: its chi-square is higher by {delta_chi2:.0}, the discrimination threshold is {threshold:.0}"
                )
            }
            Self::Undetermined { cause } => {
                write!(f, "no parameter of {cause} is determined: the name is tentative")
            }
            Self::OpenEnded { cause, parameter } => write!(
                f,
                "{parameter} of {cause} is not determined: its interval reaches an end of its range, the name is tentative"
            ),
            Self::AtBound { cause, parameter, value, unit } => {
                write!(f, "{parameter} of {cause} lies at an end of its range, {value:.3e} {unit}")
            }
            Self::Drifts { cause, parameter, spread } => write!(
                f,
                "{parameter} of {cause} drifts by {} from run to run: the name may be wrong",
                percent(spread)
            ),
            Self::NoKnownCause { chi2, floor } => write!(
                f,
                "no known cause explains the structure that is left: chi-square {chi2:.0}, floor {floor:.0}"
            ),
            Self::ChangesSlowly { chi2, floor } => write!(
                f,
                "the output changes slowly in all runs alike, and no known cause explains it: chi-square {chi2:.0} along the slow trends, floor {floor:.0}"
            ),
            Self::RunsMissed { runs } => write!(
                f,
                "{runs} of the runs are missed by more than any surrogate is: the missing effect differs from run to run"
            ),
            Self::FewRuns => {
                f.write_str("it explains a few runs only, and no cause acts in a few runs only")
            }
            Self::NothingVisible => {
                f.write_str("no cause of usual strength would be visible in these data")
            }
            Self::NotAdded { cause, why } => {
                write!(f, "{cause} is not added to the causes found before: {why}")
            }
            Self::HardlyShown { drop, needed } => write!(
                f,
                "it lowers the chi-square of the outputs by {drop:.0}, and errors of form of those causes can leave {needed:.0}"
            ),
            Self::WithinSurrogates { cause, drop, threshold } => write!(
                f,
                "{cause} explains most: it lowers chi-square by {drop:.0} within the chain. Surrogates with nothing missing reach {threshold:.0}"
            ),
            Self::LostHeldOut { cause, drop, held_out, needed, .. } => write!(
                f,
                "{cause} lowers chi-square by {drop:.0} where it is fitted, but by {held_out:.0} on held-out runs; {needed:.0} are required"
            ),
            Self::Resembles { cause, why } => {
                write!(f, "the missing effect resembles {cause} most, but {why}")
            }
            Self::Refuted(why) => f.write_str(why),
            Self::Decoy { what } => {
                write!(f, "this is no cause of the library; it would be {what}")
            }
            Self::Contradicted { part, most } => write!(
                f,
                "the intermediate channels show {} of its effect, {} at most",
                percent(part),
                percent(most)
            ),
            Self::Noisier { run, times } => write!(
                f,
                "the reading of run {run} has {times:.1} times the noise of the reference runs: look at sensor and amplifier"
            ),
        }
    }
}
