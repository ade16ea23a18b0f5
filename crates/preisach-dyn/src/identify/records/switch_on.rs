//! Records that begin when the amplifier is switched on.

use crate::VoltageRange;
use crate::check::extremes;
use crate::identify::BenchRecord;

/// Share of the command's swing within which the command has hardly moved yet.
const HARDLY: f64 = 0.05;
/// The output then moves by this share of its range at least, and by this many times what it does anywhere else
/// while the command moves as little.
const JUMP: f64 = 0.1;
const TIMES: f64 = 2.5;
/// Such stretches after which what follows the jump has settled.
const SETTLED: usize = 8;

impl BenchRecord {
    /// The record with one sample more before its first, at 0 V, where its beginning shows that the actuator came
    /// from there: the output jumps while the command has hardly moved. What the output was at 0 V is
    /// the first sample's, before it moves. None where nothing shows it, or 0 V is out of the range.
    ///
    /// The memory of a hysteretic actuator depends on it: with the command coming up from 0 V it is on
    /// the rising side of its loop, at rest it is in the middle.
    pub fn from_switch_on(&self, range: VoltageRange) -> Option<Self> {
        let (u, y) = (&self.voltage_volt, &self.output_deg);
        let [low, high] = extremes(u.iter().copied());
        let [lowest, highest] = extremes(y.iter().copied());
        let (first, near) = (*u.first()?, HARDLY * (high - low));
        let begins = u.iter().take_while(|volt| (*volt - first).abs() <= near).count() - 1;
        if begins == 0
            || begins > u.len() / 8
            || range.excess_volt(0.0) > 0.0
            || first.abs() <= near
        {
            return None;
        }
        let move_at = |i: usize| (u[i + begins] - u[i], y[i + begins] - y[i]);
        let (_, jump) = move_at(0);
        let others = (SETTLED * begins..u.len() - begins).map(move_at);
        let usual =
            others.filter(|(du, _)| du.abs() <= near).fold(0.0, |m: f64, (_, dy)| m.max(dy.abs()));
        let jumps = jump.abs() >= JUMP * (highest - lowest) && jump.abs() >= TIMES * usual;
        jumps.then(|| {
            let mut record = self.clone();
            record.voltage_volt.insert(0, 0.0);
            record.output_deg.insert(0, y[0]);
            for window in
                [&mut record.windows.train, &mut record.windows.judge].into_iter().flatten()
            {
                *window = window.start + 1..window.end + 1;
            }
            record
        })
    }
}
