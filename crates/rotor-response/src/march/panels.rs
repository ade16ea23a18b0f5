//! Blades in time as a wake sees them: where its panels are, and what they carry and feel.

use crate::march::blades::{BladesInTime, RotorInTime};
use crate::response::wake_coupling::NodeShapes;
use crate::response::wake_loading::{panel_means, shares};
use crate::{Condition, Rotor};
use nalgebra::{DMatrix, DVector};
use rotor_wake::{BladePlace, WakeRotor};

/// The panels of a wake on the blades of a rotor, as the periodic response has them ([`crate::RotorSolver::circulation`]):
/// circulation is the mean over each panel, inflow is read on straight lines between their middles.
#[derive(Debug, Clone)]
pub struct BladePanels {
    panels: WakeRotor,
    nodes: NodeShapes,
    /// Mean over each panel, shape `panels x lifting stations`.
    means: DMatrix<f64>,
    /// Where each lifting station reads.
    shares: Vec<[(usize, f64); 2]>,
}

impl BladePanels {
    /// The panels of a wake on a rotor whose lifting stations are those of a march.
    pub fn new(rotor: &Rotor, stations: &[f64], panels: &WakeRotor) -> Self {
        let middles = panels.stations();
        Self {
            nodes: NodeShapes::new(rotor, panels),
            means: panel_means(rotor.blade().grid(), stations.len(), panels),
            shares: stations.iter().map(|r| shares(&middles, *r)).collect(),
            panels: panels.clone(),
        }
    }

    /// Panels of one blade.
    pub fn count(&self) -> usize {
        self.panels.panels()
    }

    /// Circulation of the panels of all blades, blade by blade, `Omega R^2`.
    pub fn circulation(&self, blades: &BladesInTime) -> DVector<f64> {
        let of = &self.means * &blades.instant().circulation;
        DVector::from_column_slice(of.as_slice())
    }

    /// How the circulation of the panels of a blade answers to the downwash at them, where that of each lifting station answers
    /// by its own slope to what it feels.
    pub fn slope(&self, of_stations: &[f64]) -> DMatrix<f64> {
        let count = self.count();
        let mut slope = DMatrix::zeros(count, count);
        for ((s, at), of_station) in self.shares.iter().enumerate().zip(of_stations) {
            for (from, t) in at {
                slope.column_mut(*from).axpy(of_station * t, &self.means.column(s), 1.0);
            }
        }
        slope
    }

    /// Velocities at the lifting stations from those at the panels of one blade, down and along the disk.
    pub fn at_stations(&self, [down, along]: [&[f64]; 2]) -> Vec<[f64; 2]> {
        let between = |of: &[f64], at: &[(usize, f64); 2]| at.iter().map(|(k, t)| t * of[*k]).sum();
        self.shares.iter().map(|at| [between(down, at), between(along, at)]).collect()
    }

    /// Where every blade is.
    pub fn places(
        &self,
        rotor: &RotorInTime,
        blades: &BladesInTime,
        condition: &Condition,
    ) -> Vec<BladePlace> {
        let nodes = &self.nodes;
        let of = |(blade, azimuth): (usize, &f64)| {
            let (q, root) = (blades.coordinates(blade), rotor.root_rad(condition, *azimuth));
            BladePlace::deflected(
                &self.panels,
                *azimuth,
                |n| nodes.displacement(q, n),
                |n| nodes.edges[n],
                |n| nodes.pitch_rad(root, q, n),
            )
        };
        blades.instant().azimuths_rad.iter().enumerate().map(of).collect()
    }
}
