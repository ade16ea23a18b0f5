//! The static Preisach model in its two other forms, to check the play form against.
#![allow(dead_code, reason = "the validation tests use a part of it")]

pub(crate) mod everett;
pub(crate) mod relays;

use preisach_dyn::PreisachGrid;

/// A voltage in cells above the lower limit of a grid, held inside 0 ..= levels.
fn coordinate(grid: &PreisachGrid, voltage_volt: f64) -> f64 {
    let x = (voltage_volt - grid.range().lowest_volt()) / grid.cell_volt();
    x.clamp(0.0, grid.levels() as f64)
}
