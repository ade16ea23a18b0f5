//! Means of values and squares.

/// Mean of values, in their unit; 0 of none.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Mean of the squares of values, in their unit squared; 0 of none.
pub fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64
}

/// Variance of values about their mean, in their unit squared; 0 of none.
pub fn variance(values: &[f64]) -> f64 {
    let mean = mean(values);
    values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len().max(1) as f64
}

/// A number rounded to so many significant digits.
pub fn significant(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shift_changes_the_mean_square_and_not_the_variance() {
        let values = [1.0, 2.0, 3.0, 4.0];
        let shifted = values.map(|v| v + 10.0);
        assert!((mean_square(&values) - 7.5).abs() < 1e-15);
        assert!((mean_square(&shifted) - 157.5).abs() < 1e-12);
        assert!((variance(&values) - 1.25).abs() < 1e-15);
        assert!((variance(&shifted) - 1.25).abs() < 1e-12);
        assert!(variance(&[]).abs() + mean_square(&[]).abs() < 1e-300);
    }
}
