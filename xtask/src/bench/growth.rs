//! How a time grows with a size: a power fitted by least squares on logarithms.

use super::samples::{Sample, Samples};

/// Times over a size.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// What is measured over what.
    pub name: String,
    /// Size and time, s.
    pub points: Vec<(f64, f64)>,
}

impl Series {
    /// The benches of a group, whose ids are `group/size`.
    pub fn of_group(samples: &Samples, group: &str, name: &str) -> Self {
        let point = |(id, sample): (&String, &Sample)| {
            let size = id.strip_prefix(group)?.strip_prefix('/')?.parse().ok()?;
            Some((size, sample.element_s()))
        };
        let mut points: Vec<(f64, f64)> = samples.iter().filter_map(point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { name: name.to_owned(), points }
    }
}

/// `time = factor size^exponent`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Power {
    /// The exponent.
    pub exponent: f64,
    /// Time at size 1, s.
    pub factor: f64,
    /// Largest deviation of a time from the fit, share of the fit.
    pub deviation: f64,
}

impl Power {
    /// The power nearest to points of size and time, in the logarithms of the times.
    ///
    /// `None` unless two sizes differ and every number is finite and above zero.
    pub fn fit(points: &[(f64, f64)]) -> Option<Self> {
        let known = |x: f64| x.is_finite() && x > 0.0;
        if !points.iter().all(|(size, time)| known(*size) && known(*time)) {
            return None;
        }
        let logs: Vec<(f64, f64)> = points.iter().map(|(n, t)| (n.ln(), t.ln())).collect();
        let count = logs.len() as f64;
        let mean = |part: fn(&(f64, f64)) -> f64| logs.iter().map(part).sum::<f64>() / count;
        let (x0, y0) = (mean(|p| p.0), mean(|p| p.1));
        let spread: f64 = logs.iter().map(|(x, _)| (x - x0).powi(2)).sum();
        if logs.is_empty() || spread < 1e-12 {
            return None;
        }
        let exponent = logs.iter().map(|(x, y)| (x - x0) * (y - y0)).sum::<f64>() / spread;
        let factor = (y0 - exponent * x0).exp();
        let off = |(n, t): &(f64, f64)| (t / (factor * n.powf(exponent)) - 1.0).abs();
        Some(Self { exponent, factor, deviation: points.iter().map(off).fold(0.0, f64::max) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_powers_are_found_and_scatter_is_told() {
        for (exponent, factor) in [(2.0, 3e-3), (0.0, 0.7), (-0.5, 12.0), (3.25, 1e-9)] {
            let at = |n: f64| (n, factor * n.powf(exponent));
            let fit = Power::fit(&[12.0, 24.0, 36.0, 72.0].map(at)).unwrap();
            assert!((fit.exponent - exponent).abs() < 1e-12, "{fit:?}");
            assert!((fit.factor / factor - 1.0).abs() < 1e-10 && fit.deviation < 1e-12, "{fit:?}");
        }
        // twice as much at one of three sizes: 2^(2/3) above the fit, which the middle leaves level
        let fit = Power::fit(&[(1.0, 1.0), (2.0, 2.0), (4.0, 1.0)]).unwrap();
        assert!(fit.exponent.abs() < 1e-12);
        assert!((fit.deviation - (2.0_f64.powf(2.0 / 3.0) - 1.0)).abs() < 1e-12, "{fit:?}");
    }

    #[test]
    fn a_group_of_benches_is_a_series_by_size() {
        let sample = |call_s: f64| Sample { call_s, elements: 2.0 };
        let benches = [("a/100", 8.0), ("a/20", 2.0), ("a", 1.0), ("ab/3", 1.0), ("a/b", 1.0)];
        let samples = benches.map(|(id, s)| (id.to_owned(), sample(s))).into_iter().collect();
        assert_eq!(Series::of_group(&samples, "a", "b").points, [(20.0, 1.0), (100.0, 4.0)]);
    }

    #[test]
    fn what_has_no_power_has_none() {
        for points in [
            &[][..],
            &[(2.0, 1.0)],
            &[(2.0, 1.0), (2.0, 3.0)],
            &[(0.0, 1.0), (2.0, 3.0)],
            &[(1.0, -1.0), (2.0, 3.0)],
            &[(1.0, 1.0), (2.0, f64::NAN)],
            &[(1.0, 1.0), (f64::INFINITY, 2.0)],
        ] {
            assert_eq!(Power::fit(points), None, "{points:?}");
        }
    }
}
