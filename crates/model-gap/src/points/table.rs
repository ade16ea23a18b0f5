//! What was measured at points of test, and the tables of the simulation.

use crate::{Class, GapError};

/// Part of a deviation by which a suspect moves a reading at least, if it moves it at all.
const LEAST_MOVE: f64 = 1e-3;

/// Values by point and channel.
pub type Grid = Vec<Vec<f64>>;

/// A table of measured points with what a simulation says of them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PointTable {
    /// The points, in the order of the tables.
    pub points: Vec<Point>,
    /// The channels, in the order of the tables.
    pub channels: Vec<Channel>,
    /// What keeps a calibration of its own; the channels of one share it.
    pub instruments: Vec<Instrument>,
    /// Names of the conditions of the points.
    pub conditions: Vec<String>,
    /// What the simulation predicts, in the units of the channels.
    pub predicted: Grid,
    /// What it may lack.
    pub suspects: Vec<Suspect>,
    /// Predictions of other models that are thought equally good: what they explain is no discovery.
    pub alternatives: Vec<Grid>,
    /// Predictions with one input of the simulation moved by its standard deviation, one grid for each such input.
    pub uncertain: Vec<Grid>,
    /// Whether the standard deviations were measured or stated: without, nothing is said with confidence.
    pub knows_deviations: bool,
}

/// One point of test.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Point {
    /// Name in every report.
    pub id: String,
    /// Number of the sweep it belongs to: the points of one are held out together.
    pub group: usize,
    /// Whether no suspect acts there: what is off at such points is off without them.
    pub is_reference: bool,
    /// Its conditions, in their order.
    pub conditions: Vec<f64>,
    /// What each channel read, in its unit; none where it was not measured.
    pub measured: Vec<Option<f64>>,
    /// Standard deviation of each reading, in the unit of the channel, above zero.
    pub deviation: Vec<f64>,
}

impl Point {
    /// Whether any channel was read: else it could be measured next.
    pub fn is_measured(&self) -> bool {
        self.measured.iter().any(Option::is_some)
    }
}

/// What a channel is of a harmonic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Part {
    /// A value by itself.
    #[default]
    Scalar,
    /// The cosine of a harmonic, whose sine is the channel given.
    CosineOf(usize),
    /// The sine of a harmonic, whose cosine is the channel given.
    SineOf(usize),
}

/// One channel.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Channel {
    /// Name in every report.
    pub name: String,
    /// Unit; `1` for a pure number.
    pub unit: String,
    /// Position among the instruments.
    pub instrument: usize,
    /// What it is of a harmonic.
    pub part: Part,
}

/// What keeps a calibration: how well.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Instrument {
    /// Name in every report.
    pub name: String,
    /// Standard deviation of its gain, 1 for 100 %, at least 0.
    pub gain: f64,
    /// Standard deviation of its zero, in the unit of its channels, at least 0.
    pub zero: f64,
}

/// Something that the simulation may lack.
#[derive(Debug, Clone, PartialEq)]
pub struct Suspect {
    /// Name in every report.
    pub name: &'static str,
    /// The physics in a sentence.
    pub physics: &'static str,
    /// What kind of effect it is.
    pub class: Class,
    /// Part of its effect by which the tables of it are wrong along itself, at least 0.
    pub form_error: f64,
    /// Suspects that are easily taken for it.
    pub confused_with: &'static [&'static str],
    /// What tells it from those.
    pub separating: &'static [&'static str],
    /// Why the data cannot show it, found before any fit; none if they may.
    pub blocked: Option<String>,
    /// Whether the model with it could not be read, so that it was not tried.
    pub is_unread: bool,
    /// Its parameters, whose effects add up.
    pub parameters: Vec<SuspectParameter>,
}

impl Default for Suspect {
    fn default() -> Self {
        Self {
            name: "",
            physics: "",
            class: Class::Other,
            form_error: 0.05,
            confused_with: &[],
            separating: &[],
            blocked: None,
            is_unread: false,
            parameters: Vec::new(),
        }
    }
}

/// One parameter of a suspect.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SuspectParameter {
    /// Name in every report.
    pub name: &'static str,
    /// Unit; `1` for a pure number.
    pub unit: &'static str,
    /// Its value in the simulation as it is.
    pub none: f64,
    /// Values it may have, lower limit first.
    pub range: (f64, f64),
    /// Some of its values with what the simulation predicts there; the first is an amount that matters. None of a value that
    /// only says which suspect it is: it is [`Self::none`] and not fitted.
    pub tables: Vec<(f64, Grid)>,
    /// What is reported of a value.
    pub shown: Shown,
}

/// What is reported of the value of a parameter.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Shown {
    /// The value.
    #[default]
    Itself,
    /// One over it, such as the stiffness of a compliance.
    Reciprocal,
    /// One over its root, such as the frequency of a compliance over a mass.
    ReciprocalRoot,
    /// What stands beside it in a list, by value, straight between.
    Beside(Vec<(f64, f64)>),
}

impl Shown {
    /// What is reported of a value.
    pub fn of(&self, value: f64) -> f64 {
        match self {
            Self::Itself => value,
            Self::Reciprocal => 1.0 / value,
            Self::ReciprocalRoot => 1.0 / value.max(0.0).sqrt(),
            Self::Beside(list) => {
                let after = list.iter().position(|own| own.0 >= value).unwrap_or(list.len());
                let after = after.clamp(1, list.len().max(2) - 1);
                match (list.get(after - 1), list.get(after)) {
                    (Some(a), Some(b)) => a.1 + (value - a.0) / (b.0 - a.0) * (b.1 - a.1),
                    _ => value,
                }
            }
        }
    }
}

impl PointTable {
    /// Values that were measured.
    pub fn values(&self) -> usize {
        self.points.iter().flat_map(|point| &point.measured).flatten().count()
    }

    /// Parameters of all suspects that move any reading at all.
    pub fn parameters(&self) -> usize {
        let moves = |grid: &Grid| {
            let rows = self.points.iter().zip(grid).zip(&self.predicted);
            rows.filter(|own| !own.0.0.is_reference).any(|((point, row), base)| {
                let each = point.measured.iter().zip(&point.deviation).zip(row.iter().zip(base));
                each.into_iter().any(|((read, deviation), (value, base))| {
                    read.is_some() && (value - base).abs() > LEAST_MOVE * deviation
                })
            })
        };
        let may_show = self.suspects.iter().filter(|own| own.blocked.is_none());
        let of_all = may_show.flat_map(|own| &own.parameters);
        of_all.filter(|own| own.tables.iter().any(|table| moves(&table.1))).count()
    }

    /// Checks shapes and numbers.
    ///
    /// # Errors
    /// [`GapError::Length`], [`GapError::NotFinite`], [`GapError::OutOfRange`], [`GapError::TooShort`] without any value.
    pub(super) fn check(&self) -> Result<(), GapError> {
        if self.values() == 0 {
            let what = "measured values".to_owned();
            return Err(GapError::TooShort { what, samples: 0, needed: 1 });
        }
        let width = self.channels.len();
        for point in &self.points {
            length(&point.id, point.measured.len(), width)?;
            length(&point.id, point.deviation.len(), width)?;
            length(&point.id, point.conditions.len(), self.conditions.len())?;
            if let Some(&value) = point.deviation.iter().find(|v| !(v.is_finite() && **v > 0.0)) {
                let (what, expected) = ("a standard deviation", "a finite number above 0");
                return Err(GapError::OutOfRange { what, value, expected });
            }
        }
        for channel in &self.channels {
            if channel.instrument >= self.instruments.len() {
                let (what, expected) = (channel.name.clone(), self.instruments.len());
                return Err(GapError::Length { what, found: channel.instrument, expected });
            }
        }
        let named = self.suspects.iter().flat_map(|own| {
            own.parameters.iter().flat_map(move |p| p.tables.iter().map(move |t| (own.name, &t.1)))
        });
        let others = self.alternatives.iter().map(|grid| ("an alternative", grid));
        let moved = self.uncertain.iter().map(|grid| ("an uncertain input", grid));
        let all = std::iter::once(("the prediction", &self.predicted)).chain(named);
        for (what, grid) in all.chain(others).chain(moved) {
            length(what, grid.len(), self.points.len())?;
            for row in grid {
                length(what, row.len(), width)?;
                finite(what, row)?;
            }
        }
        for point in &self.points {
            let read: Vec<f64> = point.measured.iter().flatten().copied().collect();
            finite(&point.id, &read)?;
        }
        Ok(())
    }
}

fn length(what: &str, found: usize, expected: usize) -> Result<(), GapError> {
    if found == expected {
        return Ok(());
    }
    Err(GapError::Length { what: what.to_owned(), found, expected })
}

fn finite(what: &str, row: &[f64]) -> Result<(), GapError> {
    match row.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(GapError::NotFinite { what: what.to_owned(), index, value: row[index] }),
        None => Ok(()),
    }
}
