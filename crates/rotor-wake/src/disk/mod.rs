//! The rotor as wake and inflow see it: panels, lifting lines, circulation and inflow over the disk.

pub(crate) mod blades;
pub(crate) mod circulation;
pub(crate) mod inflow_map;
pub(crate) mod rotor;

use crate::WakeError;
use crate::error::{ensure, ensure_finite};

/// Refuses a table over the disk whose values are not finite or whose count does not fit its panels.
fn check_table(
    [count, value]: [&'static str; 2],
    panels: usize,
    values: &[f64],
) -> Result<(), WakeError> {
    let fits = panels > 0 && !values.is_empty() && values.len().is_multiple_of(panels);
    ensure(fits, count, values.len() as f64, "azimuths times panels")?;
    ensure_finite(value, values)
}
