//! The lifting line of a blade, cut in panels.

use crate::WakeError;
use crate::error::ensure;
use std::f64::consts::PI;

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
            let ascends = !(pair[1] - pair[0] < 1e-6 || pair[0] < 0.0);
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
