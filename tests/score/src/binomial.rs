//! Bounds on a probability from a count.

/// A share `hits/cases` with its 95 % bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// How often it happened.
    pub hits: u64,
    /// How often it could have happened.
    pub cases: u64,
}

/// Probability outside the bounds, both sides together.
const OUTSIDE: f64 = 0.05;

impl Share {
    /// Counts the true ones.
    pub fn of(outcomes: impl IntoIterator<Item = bool>) -> Self {
        let (mut hits, mut cases) = (0, 0);
        for outcome in outcomes {
            cases += 1;
            hits += u64::from(outcome);
        }
        Self { hits, cases }
    }

    /// `hits/cases`; NaN without cases.
    pub fn value(self) -> f64 {
        self.hits as f64 / self.cases as f64
    }

    /// The exact 95 % bounds of the probability behind it (Clopper and Pearson): the probabilities at which so
    /// many hits or more, or so few or fewer, would happen once in 40 times. 0..1 without cases.
    ///
    /// Source: C. J. Clopper, E. S. Pearson, Biometrika 26 (1934) 404-413.
    pub fn bounds(self) -> (f64, f64) {
        let at_most = |k: u64, p: f64| cumulative(k, self.cases, p);
        let low = match self.hits {
            0 => 0.0,
            hits => root(|p| 1.0 - at_most(hits - 1, p) - 0.5 * OUTSIDE),
        };
        let high = if self.hits == self.cases {
            1.0
        } else {
            root(|p| 0.5 * OUTSIDE - at_most(self.hits, p))
        };
        (low, high)
    }
}

/// Probability of at most `k` hits in `n` cases of probability `p` in 0..1 each.
fn cumulative(k: u64, n: u64, p: f64) -> f64 {
    // Terms by their ratio, in logarithms: n is some hundreds.
    let mut log_term = n as f64 * (-p).ln_1p();
    let mut sum = log_term.exp();
    for i in 0..k {
        log_term += ((n - i) as f64 / (i + 1) as f64).ln() + p.ln() - (-p).ln_1p();
        sum += log_term.exp();
    }
    sum.min(1.0)
}

/// Root in 0..1 of a function that grows there.
fn root(f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn none_of_n_and_all_of_n_have_their_closed_form() {
        for n in [1, 10, 230, 1000] {
            let exact = 1.0 - 0.025_f64.powf(1.0 / n as f64);
            let (low, high) = Share { hits: 0, cases: n }.bounds();
            assert_abs_diff_eq!(low, 0.0);
            assert_abs_diff_eq!(high, exact, epsilon = 1e-12);
            let (low, high) = Share { hits: n, cases: n }.bounds();
            assert_abs_diff_eq!(low, 1.0 - exact, epsilon = 1e-12);
            assert_abs_diff_eq!(high, 1.0);
        }
    }

    #[test]
    fn bounds_are_those_of_printed_tables() {
        // Five of ten, one of twenty: standard tables of the exact interval.
        let (low, high) = Share { hits: 5, cases: 10 }.bounds();
        assert_abs_diff_eq!(low, 0.1871, epsilon = 5e-5);
        assert_abs_diff_eq!(high, 0.8129, epsilon = 5e-5);
        let (low, high) = Share { hits: 1, cases: 20 }.bounds();
        assert_abs_diff_eq!(low, 0.0013, epsilon = 5e-5);
        assert_abs_diff_eq!(high, 0.2487, epsilon = 5e-5);
    }

    #[test]
    fn nothing_known_bounds_nothing() {
        let share = Share::of([]);
        assert!(share.value().is_nan());
        let (low, high) = share.bounds();
        assert_abs_diff_eq!(low, 0.0);
        assert_abs_diff_eq!(high, 1.0);
    }
}
