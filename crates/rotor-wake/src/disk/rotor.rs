//! The lifting line of a blade, cut in panels.

use crate::WakeError;
use crate::error::ensure;
use std::f64::consts::PI;

/// Width of a panel below which two stations are one, unit `R`.
const NARROWEST: f64 = 1e-6;

/// Number of blades and the spanwise panels of one of them.
#[derive(Debug, Clone, PartialEq)]
pub struct WakeRotor {
    blades: usize,
    nodes: Vec<f64>,
}

impl WakeRotor {
    /// A rotor of `blades` blades with panels between `nodes` (unit `R`), from the root cut-out to the
    /// tip at 1.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] unless there are 1 to 12 blades and at least two panels, nodes ascend and
    /// the last one is 1.
    pub fn new(blades: usize, nodes: Vec<f64>) -> Result<Self, WakeError> {
        ensure((1..=12).contains(&blades), "blades", blades as f64, "1 to 12")?;
        ensure(nodes.len() >= 3, "spanwise nodes", nodes.len() as f64, "3 or more")?;
        for pair in nodes.windows(2) {
            let ascends = !(pair[1] - pair[0] < NARROWEST || pair[0] < 0.0);
            ensure(ascends, "spanwise node", pair[1], "ascending stations from 0 to 1")?;
        }
        let tip = nodes[nodes.len() - 1];
        ensure((tip - 1.0).abs() <= 1e-12, "last spanwise node", tip, "1, the tip")?;
        Ok(Self { blades, nodes })
    }

    /// Panels of equal width.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn uniform(blades: usize, cutout: f64, panels: usize) -> Result<Self, WakeError> {
        Self::spread(blades, cutout, panels, |t| t)
    }

    /// Panels that become narrow toward both ends, `r = r_0 + (1 - r_0) (1 - cos t) / 2`.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn cosine(blades: usize, cutout: f64, panels: usize) -> Result<Self, WakeError> {
        Self::spread(blades, cutout, panels, |t| 0.5 * (1.0 - (PI * t).cos()))
    }

    /// Panels of nearly equal width with ends on given `stations` (unit `R`), as the ends of a flap are: the
    /// circulation may jump there. As many panels as asked for, more if the stations alone make more; stations
    /// outside the blade and repeated ones count for nothing.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn through(
        blades: usize,
        cutout: f64,
        panels: usize,
        stations: &[f64],
    ) -> Result<Self, WakeError> {
        let inside = |x: &f64| *x > cutout + NARROWEST && *x < 1.0 - NARROWEST;
        let mut ends: Vec<f64> = stations.iter().copied().filter(inside).collect();
        ends.extend([cutout, 1.0]);
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|b, a| *b - *a < NARROWEST);
        let widths: Vec<f64> = ends.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let mut counts = vec![1_usize; widths.len()];
        // the next panel goes where they are widest
        while counts.iter().sum::<usize>() < panels {
            let width = |k: &usize| widths[*k] / counts[*k] as f64;
            let widest = (0..counts.len()).max_by(|a, b| width(a).total_cmp(&width(b)));
            counts[widest.unwrap_or(0)] += 1;
        }
        let inner = ends.windows(2).zip(&counts).flat_map(|(pair, &count)| {
            let part = move |k: usize| k as f64 / count as f64;
            (0..count).map(move |k| pair[0] + part(k) * (pair[1] - pair[0]))
        });
        Self::new(blades, inner.chain([1.0]).collect())
    }

    fn spread(
        blades: usize,
        cutout: f64,
        panels: usize,
        place: impl Fn(f64) -> f64,
    ) -> Result<Self, WakeError> {
        let at = |k: usize| {
            if k == panels {
                1.0
            } else {
                cutout + (1.0 - cutout) * place(k as f64 / panels as f64)
            }
        };
        Self::new(blades, (0..=panels).map(at).collect())
    }

    /// Number of blades.
    pub fn blades(&self) -> usize {
        self.blades
    }

    /// Ends of the panels, unit `R`, from root to tip: where vorticity is trailed.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Number of panels.
    pub fn panels(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Middles of the panels, unit `R`: where circulation and inflow are given.
    pub fn stations(&self) -> Vec<f64> {
        self.nodes.windows(2).map(|p| 0.5 * (p[0] + p[1])).collect()
    }

    /// Widths of the panels, unit `R`.
    pub fn widths(&self) -> Vec<f64> {
        self.nodes.windows(2).map(|p| p[1] - p[0]).collect()
    }

    /// The node nearest to a station, neither root nor tip.
    pub(crate) fn inner_node_near(&self, station: f64) -> usize {
        let distance = |n: &usize| (self.nodes[*n] - station).abs();
        let inner = 1..self.panels();
        inner.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_end_on_given_stations() {
        let nodes = |panels: usize, stations: &[f64]| -> Vec<f64> {
            WakeRotor::through(4, 0.2, panels, stations).unwrap().nodes().to_vec()
        };
        let uniform = WakeRotor::uniform(4, 0.2, 20).unwrap();
        for (a, b) in nodes(20, &[]).iter().zip(uniform.nodes()) {
            assert!((a - b).abs() < 1e-15);
        }
        let flaps = [0.80, 0.85, 0.70, 0.75, 0.70, 1.2, 0.1];
        for panels in [20, 32, 64] {
            let found = nodes(panels, &flaps);
            assert_eq!(found.len(), panels + 1);
            assert!(flaps[..5].iter().all(|x| found.contains(x)), "{found:?}");
            let widths: Vec<f64> = found.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let widest = widths.iter().copied().fold(0.0, f64::max);
            assert!(widths.iter().all(|width| *width > 0.45 * widest), "{widths:?}");
        }
        // as many as the stations make
        assert_eq!(nodes(2, &flaps).len(), 6);
    }
}
