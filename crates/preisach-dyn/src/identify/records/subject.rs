//! Messages in the words and units of the data.

use crate::PreisachError;
use crate::identify::records::findings::{ACTUATOR_UNITS, Channel, Finding};

/// What records are of: it decides the words and units of messages.
///
/// The models themselves know one pair of units only, V and deg; of other data these stand for the
/// units of input and output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Subject<'a> {
    /// An actuator: V and deg of equivalent flap angle.
    #[default]
    Actuator,
    /// An actuator whose gain is not known yet: V and um.
    Displacement,
    /// A loop of any input and output.
    Loop {
        /// Symbol of the unit of the input.
        input_unit: &'a str,
        /// Symbol of the unit of the output.
        output_unit: &'a str,
    },
}

impl<'a> Subject<'a> {
    /// Symbols of the units of input and output.
    pub fn units(self) -> [&'a str; 2] {
        match self {
            Self::Actuator => ACTUATOR_UNITS,
            Self::Displacement => ["V", "um"],
            Self::Loop { input_unit, output_unit } => [input_unit, output_unit],
        }
    }

    /// A finding as a sentence.
    pub fn finding(self, finding: &Finding) -> String {
        match (self, finding) {
            (Self::Loop { .. }, Finding::OutputLeads { id, lead_deg }) => format!(
                "record {id}: the output leads the input by {lead_deg:.1} deg of phase: friction does, sums of plays cannot"
            ),
            _ => finding.sentence(self.units()),
        }
    }

    /// What to record or correct.
    pub fn remedy(self, finding: &Finding) -> &'static str {
        match (self, finding) {
            (Self::Loop { .. }, Finding::OutputLeads { .. }) => {
                "use the model of stops; if nothing here dissipates, exchange the columns or correct the delay between them"
            }
            (Self::Loop { .. }, Finding::Clipped { channel: Channel::Command, .. }) => {
                "record the input where it acts, or keep its source off its limit"
            }
            (Self::Loop { .. }, Finding::NotDescribed { .. }) => {
                "take a better one of the table of models, or none; check that the output rises with the input"
            }
            _ => finding.remedy(),
        }
    }

    /// An error as a sentence.
    pub fn error(self, error: &PreisachError) -> String {
        let Self::Loop { input_unit: unit, .. } = self else {
            return error.to_string();
        };
        match error {
            PreisachError::UnitMismatch { found_volt, declared_volt, .. } => format!(
                "the inputs span {found_volt} {unit}, the declared range {declared_volt} {unit}: the unit of one of them is wrong; correct the header or input_range"
            ),
            PreisachError::SwappedColumns { id, command_volt, output_um } => format!(
                "record {id}: the input spans {command_volt} {unit} and leaves the declared range, the output spans {output_um} and looks like the input; exchange the columns"
            ),
            _ => error.to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_are_spoken_of_in_their_own_units() {
        let damper = Subject::Loop { input_unit: "in", output_unit: "kip" };
        let findings = [
            Finding::OneAmplitude { amplitude_volt: 0.5 },
            Finding::Clipped {
                id: "a".into(),
                channel: Channel::Output,
                level: 0.4,
                share_percent: 3.0,
            },
            Finding::Clipped {
                id: "a".into(),
                channel: Channel::Command,
                level: 0.4,
                share_percent: 3.0,
            },
        ];
        for finding in &findings {
            let (own, actuator) = (damper.finding(finding), Subject::Actuator.finding(finding));
            assert_eq!(actuator, finding.to_string());
            assert!(own.contains(" in") || own.contains("kip"), "{own}");
            assert!(!own.contains(" V ") && !own.ends_with(" V") && !own.contains("deg"), "{own}");
        }
        let leads = Finding::OutputLeads { id: "a".into(), lead_deg: 60.0 };
        assert!(damper.finding(&leads).contains("friction"));
        assert_ne!(damper.remedy(&leads), leads.remedy());
        let error = PreisachError::UnitMismatch {
            found_volt: 2.0,
            declared_volt: 900.0,
            likely: "kilovolt",
        };
        assert!(damper.error(&error).contains("2 in, the declared range 900 in"));
        assert_eq!(Subject::Actuator.error(&error), error.to_string());
    }
}
