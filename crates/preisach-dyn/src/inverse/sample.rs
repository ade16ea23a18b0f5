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
        let end = if wanted_deg > now_deg { highest } else { 0.0 };
        let reached = |top: f64| {
            let value = output(top);
            if end == 0.0 { value <= wanted_deg } else { value >= wanted_deg }
        };
        let top = if wanted_deg.to_bits() == now_deg.to_bits() {
            now
        } else {
            let [from, to] = stretch([now, end], cells, reached);
            let (a, b) = (output(from), output(to));
            let share = if a.to_bits() == b.to_bits() { 1.0 } else { (wanted_deg - a) / (b - a) };
            from + share.clamp(0.0, 1.0) * (to - from)
        };
        memory.apply_coordinate(top);
        Ok(self.grid().range().lowest_volt() + top * self.grid().cell_volt())
    }
}

/// The stretch without a corner, from a coordinate where the wanted output is not reached to one where it is, within one of
/// that kind. Corners are the whole cells and the voltages at which a play begins to move. Takes no memory of its own.
fn stretch([from, to]: [f64; 2], cells: &[f64], reached: impl Fn(f64) -> bool) -> [f64; 2] {
    let mut ends = [from, to];
    let mut narrow = |corner: f64| {
        let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        if low < corner && corner < high {
            ends[usize::from(reached(corner))] = corner;
        }
        ends
    };
    // whole cells by halves
    let [mut from, mut to] = [from, to];
    loop {
        let (first, last) = (from.min(to).floor() + 1.0, from.max(to).ceil() - 1.0);
        if first > last {
            break;
        }
        [from, to] = narrow((0.5 * (first + last)).floor());
    }
    for (&x, width) in cells.iter().zip(0_i32..) {
        narrow(x);
        narrow(x + f64::from(width));
    }
    ends
}
