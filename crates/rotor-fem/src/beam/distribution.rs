//! Blade properties along the radius.

use crate::FemError;

/// A property as a function of the radial station r/R.
#[derive(Debug, Clone, PartialEq)]
pub enum Distribution {
    /// The same everywhere.
    Uniform(f64),
    /// Straight lines between stations.
    PiecewiseLinear {
        /// Stations r/R, growing.
        stations: Vec<f64>,
        /// Values at the stations, as many.
        values: Vec<f64>,
    },
    /// Uniform sections with steps between them.
    PiecewiseConstant {
        /// Ends of the sections r/R, growing; one more than there are values.
        edges: Vec<f64>,
        /// Values in the sections.
        values: Vec<f64>,
    },
}

impl From<f64> for Distribution {
    fn from(value: f64) -> Self {
        Self::Uniform(value)
    }
}

/// What values a property may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Allowed {
    Positive,
    NotNegative,
    Finite,
}

impl Allowed {
    fn admits(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Positive => value > 0.0,
                Self::NotNegative => value >= 0.0,
                Self::Finite => true,
            }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Positive => "a finite number above zero",
            Self::NotNegative => "a finite number not below zero",
            Self::Finite => "a finite number",
        }
    }
}

impl Distribution {
    /// Value at station r/R; beyond the ends of a table, the value at its end.
    pub fn value(&self, station: f64) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::PiecewiseLinear { stations, values } => match segment(stations, station) {
                Some(i) => {
                    let slope = (values[i + 1] - values[i]) / (stations[i + 1] - stations[i]);
                    let inside = station.clamp(stations[i], stations[i + 1]);
                    values[i] + slope * (inside - stations[i])
                }
                None => values.first().copied().unwrap_or(0.0),
            },
            Self::PiecewiseConstant { edges, values } => {
                segment(edges, station).and_then(|i| values.get(i)).copied().unwrap_or(0.0)
            }
        }
    }

    /// Derivative with respect to r/R at a station; zero inside uniform sections.
    pub fn slope(&self, station: f64) -> f64 {
        match self {
            Self::PiecewiseLinear { stations, values } => segment(stations, station)
                .map_or(0.0, |i| (values[i + 1] - values[i]) / (stations[i + 1] - stations[i])),
            Self::Uniform(_) | Self::PiecewiseConstant { .. } => 0.0,
        }
    }

    /// Stations where the property or its derivative jumps, table ends included.
    pub fn breaks(&self) -> &[f64] {
        match self {
            Self::Uniform(_) => &[],
            Self::PiecewiseLinear { stations: breaks, .. }
            | Self::PiecewiseConstant { edges: breaks, .. } => breaks,
        }
    }

    /// Stations with their values, one for each number a user gave.
    fn entries(&self) -> Vec<(f64, f64)> {
        match self {
            Self::Uniform(value) => vec![(0.0, *value)],
            Self::PiecewiseLinear { stations: at, values }
            | Self::PiecewiseConstant { edges: at, values } => {
                at.iter().copied().zip(values.iter().copied()).collect()
            }
        }
    }

    /// Refuses a table that does not grow, does not cover `root` to 1, or holds a forbidden value.
    pub(crate) fn check(
        &self,
        field: &'static str,
        root: f64,
        allowed: Allowed,
    ) -> Result<(), FemError> {
        let lengths = match self {
            Self::Uniform(_) => None,
            Self::PiecewiseLinear { stations, values } => {
                Some((stations, values.len(), stations.len().max(2)))
            }
            Self::PiecewiseConstant { edges, values } => {
                Some((edges, values.len(), edges.len().max(2) - 1))
            }
        };
        if let Some((stations, values, expected)) = lengths {
            if values != expected || stations.len() < 2 {
                return Err(FemError::TableLength {
                    field,
                    stations: stations.len(),
                    values,
                    expected,
                });
            }
            for (i, pair) in stations.windows(2).enumerate() {
                let grows = pair[1] > pair[0];
                if !grows || !pair[1].is_finite() || !pair[0].is_finite() {
                    return Err(FemError::StationOrder {
                        field,
                        index: i + 1,
                        station: pair[1],
                        previous: pair[0],
                    });
                }
            }
            let (from, to) = (stations[0], stations[stations.len() - 1]);
            if from > root + 1e-9 || to < 1.0 - 1e-9 {
                return Err(FemError::TableGap { field, from, to, root });
            }
        }
        for (station, value) in self.entries() {
            if !allowed.admits(value) {
                return Err(FemError::Property { field, station, value, expected: allowed.text() });
            }
        }
        Ok(())
    }
}

/// Index of the interval of `stations` that holds `x`, the nearest one outside; none without any.
fn segment(stations: &[f64], x: f64) -> Option<usize> {
    let intervals = stations.len().checked_sub(1).filter(|n| *n > 0)?;
    Some(stations.partition_point(|s| *s <= x).saturating_sub(1).min(intervals - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Distribution {
        Distribution::PiecewiseLinear { stations: vec![0.0, 0.4, 1.0], values: vec![2.0, 1.0, 4.0] }
    }

    #[test]
    fn lines_and_steps() {
        let lines = table();
        for (x, value, slope) in
            [(0.0, 2.0, -2.5), (0.2, 1.5, -2.5), (0.7, 2.5, 5.0), (1.0, 4.0, 5.0)]
        {
            assert!((lines.value(x) - value).abs() < 1e-14, "{x}");
            assert!((lines.slope(x) - slope).abs() < 1e-13, "{x}");
        }
        let steps =
            Distribution::PiecewiseConstant { edges: vec![0.0, 0.4, 1.0], values: vec![3.0, 5.0] };
        for (x, value) in [(0.0, 3.0), (0.39, 3.0), (0.4, 5.0), (1.0, 5.0)] {
            assert!((steps.value(x) - value).abs() < 1e-14, "{x}");
        }
    }

    #[test]
    fn bad_tables_are_named_with_their_station() {
        let check = |d: &Distribution| d.check("mass", 0.0, Allowed::Positive).unwrap_err();
        let Distribution::PiecewiseLinear { stations, .. } = table() else { unreachable!() };
        let bad_value = Distribution::PiecewiseLinear { stations, values: vec![1.0, -1.0, 1.0] };
        let message = check(&bad_value).to_string();
        assert!(message.contains("mass") && message.contains("0.4"), "{message}");

        let order = Distribution::PiecewiseConstant {
            edges: vec![0.0, 0.5, 0.5, 1.0],
            values: vec![1.0; 3],
        };
        assert!(matches!(check(&order), FemError::StationOrder { index: 2, .. }));
        let gap = Distribution::PiecewiseConstant { edges: vec![0.0, 0.5], values: vec![1.0] };
        assert!(matches!(check(&gap), FemError::TableGap { .. }));
        let length =
            Distribution::PiecewiseConstant { edges: vec![0.0, 1.0], values: vec![1.0, 2.0] };
        assert!(matches!(check(&length), FemError::TableLength { expected: 1, .. }));
        assert!(matches!(check(&Distribution::Uniform(f64::NAN)), FemError::Property { .. }));
        assert!(matches!(check(&Distribution::Uniform(0.0)), FemError::Property { .. }));
    }
}
