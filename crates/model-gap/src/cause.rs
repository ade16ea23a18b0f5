//! What could be missing: causes as values.

use crate::GapError;
use serde::{Deserialize, Serialize};

/// How a parameter is searched.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Scale {
    /// On a straight scale.
    #[default]
    Linear,
    /// On a logarithmic scale; the range lies above zero.
    Log,
}

/// A parameter of a cause: name, unit and physical range, which is its prior.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Parameter {
    /// Name in every report.
    pub name: &'static str,
    /// Unit; `1` for a pure number.
    pub unit: &'static str,
    /// Least value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// How it is searched.
    pub scale: Scale,
    /// Whether it only shapes the effect: fitted, but neither reported nor judged, because candidates of
    /// one cause may shape it differently.
    pub is_shape: bool,
    /// Whether it is an amount of the effect: at [`Self::none`] there is none.
    pub is_amount: bool,
    /// Value of an amount at which there is no effect, such as 1 of a ratio.
    pub none: f64,
    /// Whether a weak effect grows in proportion to it, as with a lag or a width; an amount always does.
    pub grows: bool,
    /// What must be measured besides before the value means anything; none if these data suffice. Without
    /// it only a product with something unknown is found, and the interval is the whole range.
    pub needs: Option<&'static str>,
    /// Standard deviation of a value that is taken and not fitted, in the coordinate: it stays where the
    /// search starts, and the intervals of the fitted parameters grow by what a shift of so much would move
    /// them. None: it is fitted.
    pub held: Option<f64>,
    /// Step of numerical slopes and width of a start, in the coordinate; none: 2 % of the value.
    pub step: Option<f64>,
}

impl Parameter {
    /// The coordinate the search moves on.
    pub fn coordinate(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Log => value.ln(),
        }
    }

    /// The value at a coordinate, held inside the range.
    pub fn value(&self, coordinate: f64) -> f64 {
        let value = match self.scale {
            Scale::Linear => coordinate,
            Scale::Log => coordinate.exp(),
        };
        value.clamp(self.low, self.high)
    }

    /// Step of a numerical derivative, in the coordinate.
    pub(crate) fn step(&self, value: f64) -> f64 {
        if let Some(step) = self.step {
            return step;
        }
        match self.scale {
            Scale::Linear => 0.02 * value.abs().max(0.01 * (self.high - self.low)),
            Scale::Log => 0.02,
        }
    }

    /// Whether an interval of a value on a logarithmic scale leaves one end of the range open, to one part
    /// in a hundred of it: its size is then not known.
    pub(crate) fn is_open_ended(&self, interval: [f64; 2]) -> bool {
        if self.scale == Scale::Linear || self.needs.is_some() {
            return false;
        }
        let slack = 1e-2 * (self.high / self.low).ln();
        (interval[0] / self.low).ln() <= slack || (self.high / interval[1]).ln() <= slack
    }

    /// Whether an interval holds the whole range, to one part in a hundred of it, or of an amount none at all:
    /// nothing is known of the value then.
    pub(crate) fn says_nothing(&self, interval: [f64; 2]) -> bool {
        let (low, high) = (self.coordinate(self.low), self.coordinate(self.high));
        let slack = 1e-2 * (high - low);
        let [a, b] = interval.map(|v| self.coordinate(v));
        let is_whole = a <= low + slack && b >= high - slack;
        is_whole || (self.is_amount && interval[0] <= self.none && interval[1] >= self.none)
    }

    /// Whether a value lies at an end of the range, to one part in a thousand of it.
    pub fn at_bound(&self, value: f64) -> bool {
        let (low, high) = (self.coordinate(self.low), self.coordinate(self.high));
        let slack = 1e-3 * (high - low);
        let x = self.coordinate(value);
        x <= low + slack || x >= high - slack
    }
}

/// What kind of effect a cause has and where in the chain it acts: what data show more surely than which cause it is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// A gain or a characteristic that acts at every rate alike.
    StaticGain,
    /// An offset in all runs.
    Zero,
    /// A lag or a delay between the command and the terminals.
    LagBeforeTerminals,
    /// A lag or a delay behind the terminals.
    LagBehindTerminals,
    /// A lag or a delay, where the terminal voltage was not measured.
    Lag,
    /// Motion lost at every reversal.
    LostMotion,
    /// Loops of another shape.
    LoopShape,
    /// A limited rate.
    Slew,
    /// A limited range.
    Clip,
    /// A slow change after a move or with warmth.
    SlowDrift,
    /// Gain lost under reverse voltage.
    LossOfPolarisation,
    /// A mode.
    Resonance,
    /// A line of its own frequency.
    Line,
    /// A channel beside the output that is off.
    Monitor,
    /// None of these.
    #[default]
    Other,
}

impl Class {
    /// The class in words, as what was lost or added.
    pub fn words(self) -> &'static str {
        match self {
            Self::StaticGain => "a change of static gain between the amplifier and the reading",
            Self::Zero => "an offset of the reading",
            Self::LagBeforeTerminals => "a lag between the command and the terminals",
            Self::LagBehindTerminals => "a lag behind the terminals",
            Self::Lag => "a lag, before or behind the terminals",
            Self::LostMotion => "lost motion at every reversal",
            Self::LoopShape => "loops of another shape",
            Self::Slew => "a limited rate",
            Self::Clip => "a limited range",
            Self::SlowDrift => "a slow drift",
            Self::LossOfPolarisation => "a loss of gain under reverse voltage",
            Self::Resonance => "a resonance",
            Self::Line => "a line of its own frequency in the reading",
            Self::Monitor => "a voltage monitor that is off; the output is not",
            Self::Other => "an effect of no class",
        }
    }
}

/// A cause, an effect the simulation may lack, made ready for one data set.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Candidate {
    /// Name in every report, such as `electrical-lag`.
    pub id: &'static str,
    /// The physics, one or two sentences with the equation.
    pub physics: &'static str,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// Part of its effect by which this model of the cause is wrong along the effect itself, `>= 0`, such
    /// as 0.05: intervals of the parameters grow by what it does to them.
    pub form_error: f64,
    /// What kind of effect it has, and where.
    pub class: Class,
    /// Whether these data hold the channel that tells it from the others of its class: without one of a pair being
    /// told, no fit parts two of them.
    pub is_told: bool,
    /// Whether a bench of its kind shows it so often that "nothing is missing" must have looked for it.
    pub is_common: bool,
    /// Whether it acts on channels beside the output alone, so that no gain can be stated.
    pub is_beside_output: bool,
    /// What the residual looks like.
    pub fingerprint: &'static str,
    /// Causes that look alike on ordinary data.
    pub confused_with: &'static [&'static str],
    /// Experiments that distinguish it from those.
    pub separating: &'static [&'static str],
    /// Where the search starts: values of the parameters, weak effects first. Several, because a lazy
    /// search makes false names.
    pub starts: Vec<Vec<f64>>,
    /// Why these data cannot show it, found before any fit; none if they may.
    pub blocked: Option<String>,
    /// Why it cannot be there, found before any fit: a measurement of its agent reads none. It is fitted all
    /// the same: the finding that resembles it most has no name.
    pub refuted: Option<String>,
    /// What it would be, where it is a decoy: an unnamed alternative that is fitted like a cause, so that data
    /// which show it are not given the name of a similar cause. None for a cause that may be named.
    pub decoy: Option<&'static str>,
}

impl Candidate {
    /// Whether it and another belong to one set that only a channel parts, and the data hold none that tells either:
    /// gains that act at every rate alike, and lags where no voltage says on which side of the terminals they are.
    pub fn is_one_set_with(&self, other: &Self) -> bool {
        let is_untold = |own: &Self| match own.class {
            Class::StaticGain => !own.is_told,
            Class::Lag => true,
            _ => false,
        };
        self.class == other.class && is_untold(self) && is_untold(other)
    }

    /// Whether it changes the scale of the output and hardly its form: a static gain without a shape of its own. A fit
    /// does not part two of these, a channel does.
    pub fn is_scale(&self) -> bool {
        self.class == Class::StaticGain && self.parameters.iter().all(|own| !own.is_shape)
    }
}

/// A cause switched on, with values of its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// Position among the candidates.
    pub candidate: usize,
    /// Values of its parameters.
    pub values: Vec<f64>,
}

/// Places of causes asked for by name.
///
/// # Errors
/// [`GapError::Simulation`] of a name that is not among them.
pub fn places(ids: &[&str], only: &[String]) -> Result<Vec<usize>, GapError> {
    let place = |asked: &String| {
        ids.iter().position(|own| own == asked).ok_or_else(|| GapError::Simulation {
            what: asked.clone(),
            message: format!("not in the library: {}", ids.join(", ")),
        })
    };
    only.iter().map(place).collect()
}
