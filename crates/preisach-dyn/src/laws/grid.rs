//! The Preisach triangle cut into levels.

use crate::PreisachError;
use crate::check::{check_count, check_that};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::num::NonZeroUsize;

/// The voltages an actuator may see.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "(f64, f64)", into = "(f64, f64)")]
pub struct VoltageRange {
    lowest_volt: f64,
    highest_volt: f64,
}

impl VoltageRange {
    /// The range from `lowest_volt` to `highest_volt`.
    ///
    /// # Errors
    /// [`PreisachError::OutOfRange`] unless both are finite and the second is the larger.
    pub fn new(lowest_volt: f64, highest_volt: f64) -> Result<Self, PreisachError> {
        let span = highest_volt - lowest_volt;
        let expected =
            format!("above its lower end {lowest_volt}: the range is empty or not finite");
        check_that(span.is_finite() && span > 0.0, "end of a range", highest_volt, expected)?;
        Ok(Self { lowest_volt, highest_volt })
    }

    /// The range of the amplified piezo stack of the bench tests, -20 V to 150 V.
    pub const fn amplified_stack() -> Self {
        Self { lowest_volt: -20.0, highest_volt: 150.0 }
    }

    /// Lower limit, V.
    pub fn lowest_volt(&self) -> f64 {
        self.lowest_volt
    }

    /// Upper limit, V.
    pub fn highest_volt(&self) -> f64 {
        self.highest_volt
    }

    /// Upper minus lower limit, V.
    pub fn span_volt(&self) -> f64 {
        self.highest_volt - self.lowest_volt
    }

    /// The voltage half-way between the limits, V.
    pub fn middle_volt(&self) -> f64 {
        0.5 * (self.lowest_volt + self.highest_volt)
    }

    /// By how much a voltage lies outside, V; zero inside, NaN for NaN.
    pub fn excess_volt(&self, voltage_volt: f64) -> f64 {
        if voltage_volt > self.highest_volt {
            voltage_volt - self.highest_volt
        } else if voltage_volt < self.lowest_volt {
            self.lowest_volt - voltage_volt
        } else {
            0.0 * voltage_volt
        }
    }
}

impl fmt::Display for VoltageRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} V to {} V", self.lowest_volt, self.highest_volt)
    }
}

impl TryFrom<(f64, f64)> for VoltageRange {
    type Error = PreisachError;

    fn try_from((lowest_volt, highest_volt): (f64, f64)) -> Result<Self, PreisachError> {
        Self::new(lowest_volt, highest_volt)
    }
}

impl From<VoltageRange> for (f64, f64) {
    fn from(range: VoltageRange) -> Self {
        (range.lowest_volt, range.highest_volt)
    }
}

/// The Preisach triangle `u_min <= beta <= alpha <= u_max` cut into `n (n + 1) / 2` cells.
///
/// ```text
/// cell side  c = (u_max - u_min) / n
/// play j     half-width r_j = j c / 2,  j = 0 .. n-1     (j = 0 is the reversible part)
/// its knots  s_jk = u_min + r_j + k c,  k = 0 .. n-j     (centres of the switching pairs)
/// ```
/// A relay with thresholds `alpha = s + r`, `beta = s - r` belongs to the play of half-width `r`;
/// a density constant between two knots of a play makes its output map linear there.
///
/// Inside the crate a play state `w` is kept as `x = (w - r_j - u_min) / c`, in 0 ..= n - j, so
/// that all knots are whole numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PreisachGrid {
    #[serde(rename = "range_volt")]
    range: VoltageRange,
    levels: NonZeroUsize,
}

impl PreisachGrid {
    /// The triangle over `range` with `levels >= 1` plays.
    ///
    /// # Errors
    /// [`PreisachError::OutOfRange`] without a level.
    pub fn new(range: VoltageRange, levels: usize) -> Result<Self, PreisachError> {
        check_count("levels", levels, 1)?;
        Ok(Self { range, levels: NonZeroUsize::new(levels).unwrap_or(NonZeroUsize::MIN) })
    }

    /// Number of plays, `n`.
    pub fn levels(&self) -> usize {
        self.levels.get()
    }

    /// The voltages covered.
    pub fn range(&self) -> VoltageRange {
        self.range
    }

    /// Side `c` of a cell, V.
    pub fn cell_volt(&self) -> f64 {
        self.range.span_volt() / self.levels() as f64
    }

    /// Half-width `r_j` of play `play`, V.
    pub fn half_width_volt(&self, play: usize) -> f64 {
        0.5 * play as f64 * self.cell_volt()
    }

    /// Number of knots of play `play`, `n - j + 1`; none beyond the last play.
    pub fn knots(&self, play: usize) -> usize {
        if play < self.levels() { self.levels() - play + 1 } else { 0 }
    }

    /// Centre `s_jk` of knot `knot` of play `play`, V.
    pub fn knot_volt(&self, play: usize, knot: usize) -> f64 {
        self.range.lowest_volt + self.half_width_volt(play) + knot as f64 * self.cell_volt()
    }

    /// A voltage in cells above the lower limit, held inside 0 ..= n.
    pub(crate) fn coordinate(&self, voltage_volt: f64) -> f64 {
        let x = (voltage_volt - self.range.lowest_volt) / self.cell_volt();
        x.clamp(0.0, self.levels() as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn the_triangle_has_its_corners_where_they_belong() {
        let grid = PreisachGrid::new(VoltageRange::amplified_stack(), 10).unwrap();
        assert_abs_diff_eq!(grid.cell_volt(), 17.0);
        for play in 0..10 {
            let last = grid.knots(play) - 1;
            let r = grid.half_width_volt(play);
            assert_abs_diff_eq!(grid.knot_volt(play, 0) - r, -20.0, epsilon = 1e-12);
            assert_abs_diff_eq!(grid.knot_volt(play, last) + r, 150.0, epsilon = 1e-12);
        }
        assert_eq!(grid.knots(10), 0);
    }

    #[test]
    fn empty_ranges_and_grids_are_refused() {
        assert!(VoltageRange::new(1.0, 1.0).is_err());
        assert!(VoltageRange::new(0.0, f64::NAN).is_err());
        assert!(PreisachGrid::new(VoltageRange::amplified_stack(), 0).is_err());
        assert!(VoltageRange::amplified_stack().excess_volt(f64::NAN).is_nan());
    }
}
