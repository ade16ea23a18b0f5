//! The kinds of sets, for those that want any of them.

use crate::asked::Asked;
use crate::error::RotorTruthError;
use crate::physics::balance::Resolution;
use crate::{blade, section, set};

/// What a set is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum SetKind {
    /// Hub loads, controls and power of a rotor.
    Rotor,
    /// Frequencies of a blade over the rotor speed.
    Blade,
    /// Loads of an oscillating section.
    Section,
}

/// A set as files and values.
#[derive(Debug, Clone)]
pub struct SetText {
    /// The table of points.
    pub table_csv: String,
    /// The case of the engineer.
    pub case_ron: String,
    /// What is hidden.
    pub answer: serde_json::Value,
    /// Number of points: of test, rotor speeds or motions.
    pub points: usize,
}

impl SetKind {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rotor => "rotor",
            Self::Blade => "blade",
            Self::Section => "section",
        }
    }

    /// File name of the table of points.
    pub fn table_name(self) -> &'static str {
        match self {
            Self::Rotor => "sweep.csv",
            Self::Blade => "frequencies.csv",
            Self::Section => "loops.csv",
        }
    }

    /// Names of all effects, `null` among them.
    pub fn effects(self) -> Vec<&'static str> {
        match self {
            Self::Rotor => set::catalogue::CATALOGUE.iter().map(|own| own.name).collect(),
            Self::Blade => blade::effect::CATALOGUE.iter().map(|own| own.name).collect(),
            Self::Section => section::effect::CATALOGUE.iter().map(|own| own.name).collect(),
        }
    }

    /// Noise that is usual, dB below the readings.
    pub fn usual_snr_db(self) -> f64 {
        match self {
            Self::Rotor | Self::Section => 40.0,
            // the deviations of the modes lie between 0.1 and 0.5 %
            Self::Blade => 53.0,
        }
    }

    /// Makes a set.
    ///
    /// # Errors
    /// [`RotorTruthError`] of an unknown effect, a number of points out of range, physics that find no answer.
    pub fn make(self, asked: &Asked) -> Result<SetText, RotorTruthError> {
        match self {
            Self::Rotor => {
                let made = set::made::make(asked, Resolution::default())?;
                let (points, answer) = (made.answer.points, serde_json::to_value(&made.answer)?);
                Ok(SetText { table_csv: made.sweep_csv, case_ron: made.case_ron, answer, points })
            }
            Self::Blade => blade::made::make(asked).and_then(SetText::of),
            Self::Section => section::made::make(asked).and_then(SetText::of),
        }
    }
}

impl SetText {
    fn of(made: crate::asked::Made) -> Result<Self, RotorTruthError> {
        let (points, answer) = (made.answer.points, serde_json::to_value(&made.answer)?);
        Ok(Self { table_csv: made.table_csv, case_ron: made.case_ron, answer, points })
    }
}
