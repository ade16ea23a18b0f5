//! From values to places.

/// Values between two limits, put to places between two others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Places of the limits, px.
    pub(super) at: [f64; 2],
}

impl Scale {
    /// Of values with a margin; between -1 and 1 where there are none, and about the value where there is one.
    pub(super) fn of(values: impl IntoIterator<Item = f64>, at: [f64; 2]) -> Self {
        let finite = values.into_iter().filter(|value| value.is_finite());
        let (low, high) = finite
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        if low > high {
            return Self { low: -1.0, high: 1.0, at };
        }
        let size = high - low;
        let margin = if size > 1e-12 * high.abs() { 0.05 * size } else { low.abs().max(1.0) };
        Self { low: low - margin, high: high + margin, at }
    }

    /// The same with limits further apart by a factor, about the same middle.
    pub(super) fn wider(self, factor: f64) -> Self {
        let (middle, half) = (f64::midpoint(self.low, self.high), 0.5 * (self.high - self.low));
        Self { low: middle - factor * half, high: middle + factor * half, ..self }
    }

    /// Length of a unit, px.
    pub(super) fn unit(&self) -> f64 {
        ((self.at[1] - self.at[0]) / (self.high - self.low)).abs()
    }

    /// Where a value lies, px.
    pub(super) fn place(&self, value: f64) -> f64 {
        let part = (value - self.low) / (self.high - self.low);
        (self.at[1] - self.at[0]).mul_add(part, self.at[0])
    }

    /// Round values within the limits, three to seven.
    pub(super) fn ticks(&self) -> Vec<f64> {
        let rough = (self.high - self.low) / 4.0;
        let decade = 10.0_f64.powf(rough.log10().floor());
        let steps = [1.0, 2.0, 5.0, 10.0].map(|own| own * decade);
        let step = steps.into_iter().find(|own| *own >= rough).unwrap_or(rough);
        let first = (self.low / step).ceil();
        let all = (0..8).map(|k| (first + f64::from(k)) * step);
        all.take_while(|tick| *tick <= self.high).collect()
    }
}

/// Ticks of a logarithmic scale at most.
const MOST_TICKS: usize = 7;

impl Scale {
    /// Places of the ticks, px, with their values; of a logarithmic scale its values are logarithms.
    pub(super) fn named_ticks(&self, is_log: bool) -> Vec<(f64, f64)> {
        let named = |tick: f64| (self.place(tick), if is_log { 10.0_f64.powf(tick) } else { tick });
        if !is_log {
            return self.ticks().into_iter().map(named).collect();
        }
        // whole decades where they are many, else 1, 2 and 5 of each
        let decades = |step: f64| {
            let first = (self.low / step).ceil();
            (0..=MOST_TICKS).map(move |k| (first + k as f64) * step)
        };
        let within = |tick: &f64| *tick <= self.high;
        let fine = |tick: f64| [1.0_f64, 2.0, 5.0].map(|own| tick + own.log10());
        let span = self.high - self.low;
        let ticks: Vec<f64> = if span < 2.0 {
            let from = self.low.floor() - 1.0;
            let all = (0..5).map(|k| from + f64::from(k)).flat_map(fine);
            all.filter(|tick| *tick >= self.low).filter(within).collect()
        } else {
            decades((span / MOST_TICKS as f64).ceil()).take_while(within).collect()
        };
        ticks.into_iter().map(named).collect()
    }
}

/// A value in as many digits as an interval of a width asks for: two of the width.
pub(super) fn resolved(value: f64, width: f64) -> String {
    // the exponent as the language prints it
    let decade = |value: f64| -> i32 {
        format!("{value:e}").rsplit('e').next().and_then(|own| own.parse().ok()).unwrap_or(0)
    };
    if !(value.is_finite() && width.is_finite() && width > 0.0) {
        return short(value);
    }
    let digits = 1 - decade(width);
    if !(0..7).contains(&digits) || decade(value) > 5 {
        return short(value);
    }
    format!("{value:.*}", usize::try_from(digits).unwrap_or_default())
}

/// A number in three digits; what is larger without a fraction.
pub fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value.is_finite() { "0".to_owned() } else { "-".to_owned() };
    }
    // the exponent as the language prints it, after rounding to three digits
    let text = format!("{value:.2e}");
    let decade: i32 = text.rsplit('e').next().and_then(|own| own.parse().ok()).unwrap_or(0);
    if !(-3..6).contains(&decade) {
        return text;
    }
    let digits = usize::try_from(2 - decade).unwrap_or_default();
    let text = format!("{value:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_straight_and_ticks_are_round() {
        let scale = Scale { low: -2.0, high: 8.0, at: [100.0, 0.0] };
        let places = [-2.0, 8.0, 3.0].map(|value| short(scale.place(value)));
        assert_eq!(places, ["100", "0", "50"]);
        assert_eq!(scale.ticks().len(), 2);
        let ticks = Scale { low: 0.13, high: 0.31, ..scale }.ticks();
        assert_eq!(
            ticks.into_iter().map(short).collect::<Vec<_>>(),
            ["0.15", "0.2", "0.25", "0.3"]
        );
        let one = Scale::of([3.0, f64::NAN], [0.0, 1.0]);
        assert_eq!([one.low, one.high].map(short), ["0", "6"]);
        assert_eq!(short(Scale::of([], [0.0, 1.0]).high), "1");
    }

    #[test]
    fn an_interval_is_resolved() {
        assert_eq!(resolved(1.020_14, 0.001), "1.0201");
        assert_eq!(resolved(0.8, 0.2), "0.80");
        assert_eq!([resolved(1234.0, 300.0), resolved(2.0, 0.0)], ["1234", "2"]);
    }

    #[test]
    fn numbers_have_three_digits() {
        let cases = [
            (0.0, "0"),
            (-1234.5, "-1234"),
            (12.345, "12.3"),
            (0.999_9, "1"),
            (0.001_234, "0.00123"),
            (1e-5, "1.00e-5"),
            (2.5e7, "2.50e7"),
            (f64::NAN, "-"),
        ];
        for (value, text) in cases {
            assert_eq!(short(value), text);
        }
    }
}
