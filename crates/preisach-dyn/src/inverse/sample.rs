//! Sample-by-sample inverse of the static model.

use crate::check::{check_finite, check_that};
use crate::laws::memory::moved;
use crate::laws::play_map::interpolate;
use crate::{PlayMemory, PreisachError, StaticPreisach};

impl StaticPreisach {
    /// The next voltage for which the output is `wanted_deg`; moves the memory there.
    ///
    /// With the memory given, the output is a continuous function of the next voltage, never falling
    /// and straight between the whole cells and the voltages at which a play begins to move. The
    /// stretch that holds the wanted output is found by bisection over these corners, and the voltage
    /// in it is exact but for rounding. Where the output does not change with the voltage, the voltage
    /// nearest to the present one is taken.
    ///
    /// # Errors
    /// [`PreisachError::OutOfRange`] with what the next sample can reach,
    /// [`PreisachError::NotFinite`], [`PreisachError::MemoryMismatch`].
    pub fn inverse(&self, memory: &mut PlayMemory, wanted_deg: f64) -> Result<f64, PreisachError> {
        let levels = self.grid().levels();
        check_finite("wanted output (deg)", [wanted_deg])?;
        memory.check(self.grid())?;
        let cells = memory.cells();
        let map = self.map();
        let output = |top: f64| {
            let plays = cells.iter().zip(&map.nodes).zip(0_i32..);
            plays.fold(map.constant, |sum, ((&x, row), width)| {
                sum + interpolate(row, moved(x, top, f64::from(width)))
            })
        };
        let highest = levels as f64;
        // rounding of a sum of this many terms
        let size = map.nodes.iter().flatten().fold(map.constant.abs(), |m, v| m.max(v.abs()));
        let slack = 4.0 * f64::EPSILON * size * (highest + 1.0);
        let (lowest_deg, highest_deg) = (output(0.0), output(highest));
        if wanted_deg < lowest_deg - slack || wanted_deg > highest_deg + slack {
            let expected = format!(
                "{lowest_deg} to {highest_deg}: the next sample reaches no further; lower the target or \
                 widen the voltage range"
            );
            check_that(false, "wanted output (deg)", wanted_deg, expected)?;
        }
        // play 0 follows the voltage: it tells where the voltage is
        let now = cells.first().copied().unwrap_or(0.0);
        let now_deg = output(now);
        let mut corners: Vec<f64> = (0..=levels).map(|k| k as f64).collect();
        for (&x, width) in cells.iter().zip(0_i32..) {
            corners.extend([x, x + f64::from(width)]);
        }
        corners.retain(|&c| c > 0.0 && c < highest && ((c > now) == (wanted_deg > now_deg)));
        let end = if wanted_deg > now_deg { highest } else { 0.0 };
        corners.push(end);
        corners.sort_by(f64::total_cmp);
        if end == 0.0 {
            corners.reverse();
        }
        let reached = |top: f64| {
            let value = output(top);
            if end == 0.0 { value <= wanted_deg } else { value >= wanted_deg }
        };
        let top = if wanted_deg.to_bits() == now_deg.to_bits() {
            now
        } else {
            let index = corners.partition_point(|&c| !reached(c)).min(corners.len() - 1);
            let from = index.checked_sub(1).map_or(now, |before| corners[before]);
            let (a, b) = (output(from), output(corners[index]));
            let share = if a.to_bits() == b.to_bits() { 1.0 } else { (wanted_deg - a) / (b - a) };
            from + share.clamp(0.0, 1.0) * (corners[index] - from)
        };
        memory.apply_coordinate(top);
        Ok(self.grid().range().lowest_volt() + top * self.grid().cell_volt())
    }
}
