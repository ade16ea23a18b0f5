//! What noise, range and simulation of the two sessions do not bear out.

use super::over_time::{DOUBTED, TOLD, change_over_session};
use super::{GivenModel, noisier, share_beyond};
use crate::base::BaseModel;
use crate::record::Record;
use model_gap::Class;
use model_gap::discovery::{Confidence, Finding, Reason, Verdict};

/// Share of the measured samples that may lie where no reference run has been.
const MOST_BEYOND: f64 = 0.05;

/// The runs of both sessions beside what is known of them.
pub(crate) struct Sessions<'a> {
    pub(crate) runs: &'a [&'a Record],
    pub(crate) references: &'a [&'a Record],
    pub(crate) base: &'a BaseModel,
    pub(crate) given: Option<GivenModel>,
    /// Whether the causes were asked for and not searched.
    pub(crate) takes_for_true: bool,
}

/// Takes from a finding what noise, range and simulation of the two sessions do not bear out.
pub(crate) fn doubt(finding: &mut Finding, sessions: &Sessions<'_>) {
    if finding.verdict == Verdict::NothingMissing
        && let Some(reason) = noisier(sessions.runs, sessions.base)
    {
        finding.confidence = Confidence::Tentative;
        finding.reasons.push(reason);
    }
    // another cause that is sure explains what would look like a change with time; a constant gain does not
    let is_gain = finding.class.as_ref().is_some_and(|own| own.class == Class::StaticGain);
    if (is_gain || finding.confidence == Confidence::Tentative)
        && let Some(change) =
            change_over_session(sessions.runs, sessions.base, if is_gain { DOUBTED } else { TOLD })
    {
        if is_gain {
            be_tentative(finding, change);
        } else {
            finding.reasons.push(change);
        }
    }
    if sessions.takes_for_true {
        be_tentative(finding, Reason::TakenForTrue);
    }
    let share = share_beyond(sessions.runs, sessions.references);
    if share > MOST_BEYOND {
        be_tentative(finding, Reason::BeyondReference { share });
    }
    if let Some(own) = sessions.given.filter(GivenModel::is_foreign) {
        finding.verdict = Verdict::Unknown;
        (finding.confidence, finding.class, finding.gain) = (Confidence::Tentative, None, None);
        let reason = Reason::OtherBench { percent: own.error_percent, scale: own.scale };
        finding.reasons.insert(0, reason);
    }
}

/// Makes name and class tentative, and says why.
fn be_tentative(finding: &mut Finding, why: Reason) {
    finding.confidence = Confidence::Tentative;
    if let Some(class) = &mut finding.class {
        class.confidence = Confidence::Tentative;
    }
    finding.reasons.push(why);
}
