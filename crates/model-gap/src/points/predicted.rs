//! What the tables predict with some amount of the suspects.

use super::table::{Grid, PointTable, Suspect, SuspectParameter};
use crate::discovery::{Signal, Simulator};
use crate::{Candidate, Effect, GapError, Parameter};

impl SuspectParameter {
    /// Factors on what each of its tables adds to the prediction, at a value.
    ///
    /// ```text
    /// one table at a:    e = x / a d_a
    /// more:              e = sum over three neighbours of their Lagrange polynomials times d, 0 without effect among them
    /// ```
    /// `x` is the value less that of no effect, `d` what a table adds. Beyond the outermost tables the parabola goes on
    /// straight: nothing is known of its bend there.
    pub(super) fn factors(&self, value: f64) -> Vec<f64> {
        let x = value - self.none;
        let mut factors = vec![0.0; self.tables.len()];
        // places of the tables, that of no effect among them
        let mut nodes: Vec<(f64, Option<usize>)> = vec![(0.0, None)];
        nodes.extend(self.tables.iter().enumerate().map(|(k, own)| (own.0 - self.none, Some(k))));
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let [first, last] = nodes[..] {
            if let Some(k) = first.1.or(last.1) {
                factors[k] = x / (first.0 + last.0);
            }
            return factors;
        }
        let [low, .., high] = nodes[..] else { return factors };
        let (low, high) = (low.0, high.0);
        let inside = x.clamp(low, high);
        let after = nodes.iter().position(|own| own.0 >= inside).unwrap_or(nodes.len() - 1);
        // the node nearer to the value is the middle of the three
        let nearer = match nodes.get(after.wrapping_sub(1)) {
            Some(before) if inside - before.0 < nodes[after].0 - inside => after - 1,
            _ => after,
        };
        let middle = nearer.clamp(1, nodes.len() - 2);
        let three = &nodes[middle - 1..=middle + 1];
        for (own, others) in [(0, [1, 2]), (1, [0, 2]), (2, [0, 1])] {
            let Some(table) = three[own].1 else { continue };
            let [a, b] = others.map(|other| three[other].0);
            let scale = (three[own].0 - a) * (three[own].0 - b);
            let slope = 2.0 * inside - a - b;
            factors[table] = ((inside - a) * (inside - b) + (x - inside) * slope) / scale;
        }
        factors
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

    /// What was measured.
    pub(super) fn measured(&self) -> Signal {
        self.signal(|p, c| self.table.points[p].measured[c].unwrap_or_default())
    }

    /// The candidates of the suspects.
    pub(super) fn candidates(&self) -> Vec<Candidate> {
        let one = |own: &Suspect| {
            // what has no table only says which suspect it is
            let held = |p: &SuspectParameter| p.tables.is_empty().then_some(0.0);
            let parameter = |p: &SuspectParameter| Parameter {
                held: held(p),
                name: p.name,
                unit: p.unit,
                low: p.range.0,
                high: p.range.1,
                is_amount: true,
                none: p.none,
                ..Parameter::default()
            };
            let at = |table: usize, sign: f64| -> Vec<f64> {
                let own = own.parameters.iter().map(|p| {
                    let own = p.tables.get(table).or(p.tables.first());
                    let amount = own.map_or(0.0, |table| table.0 - p.none);
                    sign.mul_add(amount, p.none).clamp(p.range.0, p.range.1)
                });
                own.collect()
            };
            let none: Vec<f64> = own.parameters.iter().map(|p| p.none).collect();
            let most = own.parameters.iter().map(|p| p.tables.len()).max().unwrap_or(0);
            let mut starts: Vec<Vec<f64>> = Vec::new();
            for table in 0..most {
                for start in [at(table, 1.0), at(table, -1.0)] {
                    if start != none && !starts.contains(&start) {
                        starts.push(start);
                    }
                }
            }
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
            if self.table.points[p].is_reference {
                return base[p][c];
            }
            let added = terms.iter().map(|(factor, grid)| factor * (grid[p][c] - base[p][c]));
            base[p][c] + added.sum::<f64>()
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_make_parabolas_that_go_on_straight() {
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
        let one = SuspectParameter { tables: vec![(0.5, vec![])], ..own.clone() };
        assert!((one.factors(2.0)[0] + 2.0).abs() < 1e-12);
        // five tables of a sine: of third order between them
        let most = |step: f64| {
            let at = [1.0, -1.0, 2.0, -2.0, 3.0].map(|k| (k * step, vec![]));
            let own = SuspectParameter { none: 0.0, tables: at.into(), ..own.clone() };
            let miss = |k: u32| {
                let x = step * (f64::from(k) / 10.0 - 2.0);
                let found: f64 =
                    own.factors(x).iter().zip(&own.tables).map(|(f, t)| f * t.0.sin()).sum();
                (found - x.sin()).abs()
            };
            (0..=50).map(miss).fold(0.0, f64::max)
        };
        let (coarse, fine) = (most(0.4), most(0.2));
        assert!(coarse < 5e-3 && (6.0..10.0).contains(&(coarse / fine)), "{coarse} {fine}");
    }
}
