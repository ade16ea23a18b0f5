//! What the tables predict with some amount of the suspects.

use super::table::{Grid, PointTable, Suspect, SuspectParameter};
use crate::discovery::{Signal, Simulator};
use crate::{Candidate, Effect, GapError, Parameter};

impl SuspectParameter {
    /// Factors on what each of its tables adds to the prediction, at a value.
    ///
    /// ```text
    /// one table at a:        e = x / a d_a
    /// tables at a and b:     e = x (x - b) / (a (a - b)) d_a + x (x - a) / (b (b - a)) d_b
    /// ```
    /// `x` is the value less that of no effect, `d` what a table adds. Beyond the outermost of `a`, `b` and 0 the parabola
    /// goes on straight: nothing is known of its bend there.
    fn factors(&self, value: f64) -> Vec<f64> {
        let x = value - self.none;
        let at: Vec<f64> = self.tables.iter().map(|table| table.0 - self.none).collect();
        let [a, b] = at[..] else { return at.iter().map(|a| x / a).collect() };
        let (low, high) = (a.min(b).min(0.0), a.max(b).max(0.0));
        let inside = x.clamp(low, high);
        let one = |a: f64, b: f64| {
            let scale = a * (a - b);
            inside * (inside - b) / scale + (x - inside) * (2.0 * inside - b) / scale
        };
        vec![one(a, b), one(b, a)]
    }
}

/// The tables as a simulator of some of the points, every value over its standard deviation.
pub(super) struct Tables<'a> {
    pub(super) table: &'a PointTable,
    /// The points that are predicted, by number, with the channels of each.
    pub(super) rows: Vec<(usize, Vec<usize>)>,
    /// Standard deviation that every value weighs with, by point and channel.
    pub(super) sigma: Grid,
}

impl<'a> Tables<'a> {
    /// Of the points that were measured.
    pub(super) fn of_measured(table: &'a PointTable, sigma: Grid) -> Self {
        let read = |p: usize| {
            let own = table.points[p].measured.iter().enumerate();
            own.filter(|(_, value)| value.is_some()).map(|(c, _)| c).collect::<Vec<_>>()
        };
        let points = (0..table.points.len()).filter(|&p| table.points[p].is_measured());
        Self { table, rows: points.map(|p| (p, read(p))).collect(), sigma }
    }

    /// A grid as a signal: over the standard deviations, channels that were not read left out.
    pub(super) fn signal(&self, grid: impl Fn(usize, usize) -> f64) -> Signal {
        let row = |(p, channels): &(usize, Vec<usize>)| {
            channels.iter().map(|&c| grid(*p, c) / self.sigma[*p][c]).collect()
        };
        self.rows.iter().map(row).collect()
    }

    /// The candidates of the suspects.
    pub(super) fn candidates(&self) -> Vec<Candidate> {
        let one = |own: &Suspect| {
            let parameter = |p: &SuspectParameter| Parameter {
                name: p.name,
                unit: p.unit,
                low: p.range.0,
                high: p.range.1,
                is_amount: true,
                none: p.none,
                ..Parameter::default()
            };
            let at = |sign: f64| -> Vec<f64> {
                let own = own.parameters.iter().map(|p| {
                    let amount = p.tables.first().map_or(0.0, |table| table.0 - p.none);
                    sign.mul_add(amount, p.none).clamp(p.range.0, p.range.1)
                });
                own.collect()
            };
            let none: Vec<f64> = own.parameters.iter().map(|p| p.none).collect();
            let starts = [1.0, -1.0].map(at).into_iter().filter(|values| *values != none).collect();
            Candidate {
                id: own.name,
                physics: own.physics,
                parameters: own.parameters.iter().map(parameter).collect(),
                form_error: own.form_error,
                class: own.class,
                is_common: true,
                confused_with: own.confused_with,
                separating: own.separating,
                starts,
                blocked: own.blocked.clone(),
                ..Candidate::default()
            }
        };
        self.table.suspects.iter().map(one).collect()
    }
}

impl Simulator for Tables<'_> {
    fn predict(&self, effects: &[Effect]) -> Result<Signal, GapError> {
        let mut terms: Vec<(f64, &Grid)> = Vec::new();
        for effect in effects {
            let parameters = &self.table.suspects[effect.candidate].parameters;
            for (parameter, value) in parameters.iter().zip(&effect.values) {
                let factors = parameter.factors(*value);
                terms.extend(factors.into_iter().zip(parameter.tables.iter().map(|t| &t.1)));
            }
        }
        let base = &self.table.predicted;
        Ok(self.signal(|p, c| {
            let added = terms.iter().map(|(factor, grid)| factor * (grid[p][c] - base[p][c]));
            base[p][c] + added.sum::<f64>()
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_tables_make_a_parabola_that_goes_on_straight() {
        let tables = vec![(1.5, vec![]), (0.5, vec![])];
        let own = SuspectParameter { none: 1.0, tables, ..SuspectParameter::default() };
        // an effect of 2 x + 3 x^2, told at x = 0.5 and -0.5
        let effect = |x: f64| 3.0_f64.mul_add(x * x, 2.0 * x);
        let at = |value: f64| {
            let factors = own.factors(value);
            factors[0] * effect(0.5) + factors[1] * effect(-0.5)
        };
        for x in [-0.5, -0.2, 0.0, 0.3, 0.5] {
            assert!((at(1.0 + x) - effect(x)).abs() < 1e-12, "{x}");
        }
        // slope at the end: 2 + 6 x
        assert!((at(2.0) - (effect(0.5) + 0.5 * 5.0)).abs() < 1e-12);
        assert!((at(0.0) - (effect(-0.5) + 0.5 * 1.0)).abs() < 1e-12);
        let one = SuspectParameter { tables: vec![(0.5, vec![])], ..own };
        assert!((one.factors(2.0)[0] + 2.0).abs() < 1e-12);
    }
}
