//! Numbers of a record: range, slope.

/// Least and largest of values.
pub(crate) fn range<'v>(values: impl IntoIterator<Item = &'v f64>) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    values.into_iter().fold(none, |(low, high), &v| (low.min(v), high.max(v)))
}

/// Slope of `y` against `x` by least squares, both about their means; 0 where `x` is constant.
pub(crate) fn slope(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len().max(1) as f64;
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let (mut xy, mut xx) = (0.0, 0.0);
    for (a, b) in x.iter().zip(y) {
        xy += (a - mx) * (b - my);
        xx += (a - mx).powi(2);
    }
    if xx > 0.0 { xy / xx } else { 0.0 }
}

/// One signal less another.
pub(crate) fn less(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
