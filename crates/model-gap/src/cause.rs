//! What could be missing: causes as values.

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
    /// Whether it is an amount of the effect: at zero there is none.
    pub is_amount: bool,
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
    pub(crate) fn coordinate(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Log => value.ln(),
        }
    }

    /// The value at a coordinate, held inside the range.
    pub(crate) fn value(&self, coordinate: f64) -> f64 {
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
        is_whole || (self.is_amount && interval[0] <= 0.0 && interval[1] >= 0.0)
    }

    /// Whether a value lies at an end of the range, to one part in a thousand of it.
    pub fn at_bound(&self, value: f64) -> bool {
        let (low, high) = (self.coordinate(self.low), self.coordinate(self.high));
        let slack = 1e-3 * (high - low);
        let x = self.coordinate(value);
        x <= low + slack || x >= high - slack
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

/// A cause switched on, with values of its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// Position among the candidates.
    pub candidate: usize,
    /// Values of its parameters.
    pub values: Vec<f64>,
}
