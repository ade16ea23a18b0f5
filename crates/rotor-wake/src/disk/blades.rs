//! Where the lifting line of a blade is at every azimuth.

use crate::WakeError;
use crate::WakeRotor;
use crate::error::ensure;
use crate::vector::{Vec3, about_the_shaft, add, norm, scale, sub};
use std::f64::consts::TAU;

/// Motion over a revolution up to which blades count as turning only, unit `R`: less than a core.
const STEADY: f64 = 0.01;
/// Factor up to which two chords differ by rounding.
const SAME_CHORD: f64 = 1.0 + 1e-9;

/// A node of a blade turned by an azimuth (sine, cosine), at `r` and displaced by `[up, toward the leading edge]`.
fn displaced((sin, cos): (f64, f64), r: f64, [up, lead]: [f64; 2]) -> Vec3 {
    [r * cos - lead * sin, r * sin + lead * cos, up]
}

/// The place a distance behind a node of a blade along its chord, which is turned up by `pitch_rad`.
fn behind((sin, cos): (f64, f64), node: Vec3, distance: f64, pitch_rad: f64) -> Vec3 {
    let (below, behind) = pitch_rad.sin_cos();
    let (below, behind) = (distance * below, distance * behind);
    [node[0] + behind * sin, node[1] - behind * cos, node[2] - below]
}

/// One blade at one instant: ends of its panels in hub axes, unit `R`.
#[derive(Debug, Clone, PartialEq)]
pub struct BladePlace {
    /// On the lifting line.
    pub(crate) line: Vec<Vec3>,
    /// Where the trailers leave the blade.
    pub(crate) edge: Vec<Vec3>,
}

/// A point of the trailing edge at a station between the nodes (unit `R`) of the rotor.
pub(crate) fn edge_between(edge: &[Vec3], rotor: &WakeRotor, station: f64) -> Vec3 {
    let nodes = rotor.nodes();
    let above = nodes.partition_point(|r| *r < station).clamp(1, nodes.len() - 1);
    let t = (station - nodes[above - 1]) / (nodes[above] - nodes[above - 1]);
    add(scale(edge[above - 1], 1.0 - t), scale(edge[above], t))
}

impl BladePlace {
    /// A blade at an azimuth (rad), displaced by `[up, toward the leading edge]` (unit `R`) by node, the wake leaving at a
    /// distance (unit `R`) behind the line along the chord, which is turned up by a pitch (rad), both by node: as
    /// [`BladeLines::deflected`] and [`BladeLines::with_trailing_edge`].
    pub fn deflected(
        rotor: &WakeRotor,
        azimuth_rad: f64,
        displacement: impl Fn(usize) -> [f64; 2],
        distance: impl Fn(usize) -> f64,
        pitch_rad: impl Fn(usize) -> f64,
    ) -> Self {
        let turned = azimuth_rad.sin_cos();
        let nodes = rotor.nodes().iter().enumerate();
        let line: Vec<Vec3> = nodes.map(|(n, r)| displaced(turned, *r, displacement(n))).collect();
        let edges = line.iter().enumerate();
        let edge = edges.map(|(n, at)| behind(turned, *at, distance(n), pitch_rad(n))).collect();
        Self { line, edge }
    }
}

/// Ends of the panels in hub axes (unit `R`) at uniform azimuths, `[azimuth][node]`.
#[derive(Debug, Clone, PartialEq)]
pub struct BladeLines {
    nodes: usize,
    points: Vec<Vec3>,
    /// Where the trailers leave the blade.
    edges: Vec<Vec3>,
}

impl BladeLines {
    /// Straight blades in the plane of the hub.
    pub fn flat(rotor: &WakeRotor, azimuths: usize) -> Self {
        Self::deflected(rotor, azimuths, |_, _| [0.0, 0.0])
    }

    /// Blades displaced by `[up, toward the leading edge]` (unit `R`) at an azimuth, counted in steps, and
    /// node.
    pub fn deflected(
        rotor: &WakeRotor,
        azimuths: usize,
        displacement: impl Fn(usize, usize) -> [f64; 2],
    ) -> Self {
        let nodes = rotor.nodes().len();
        let mut points = Vec::with_capacity(azimuths * nodes);
        for i in 0..azimuths {
            let turned = (TAU * i as f64 / azimuths as f64).sin_cos();
            for (n, &r) in rotor.nodes().iter().enumerate() {
                points.push(displaced(turned, r, displacement(i, n)));
            }
        }
        let edges = points.clone();
        Self { nodes, points, edges }
    }

    /// The same blades with the wake leaving at a distance (unit `R`, by node) behind the lifting line along the chord, which
    /// is turned up from the plane of rotation by `pitch` (rad) at an azimuth, counted in steps, and node: `0.75 c` is the trailing
    /// edge, below the line by `0.75 c sin(pitch)`. Between line and edge the circulation is that of the blade. Without it
    /// the wake leaves at the line.
    #[must_use]
    pub fn with_trailing_edge(
        self,
        distance: impl Fn(usize) -> f64,
        pitch: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let azimuths = self.azimuths();
        let mut edges = self.points.clone();
        for (k, edge) in edges.iter_mut().enumerate() {
            let turned = (TAU * (k / self.nodes) as f64 / azimuths as f64).sin_cos();
            let node = k % self.nodes;
            *edge = behind(turned, *edge, distance(node), pitch(k / self.nodes, node));
        }
        Self { edges, ..self }
    }

    /// The mean blade of all azimuths turned to each of them, for an axial wake.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] if the blades move by more than a hundredth of the radius as they turn.
    pub fn axial(&self) -> Result<Self, WakeError> {
        let motion = self.departure_from_turning();
        let quantity = "motion of the blades of an axial wake, R";
        let expected = "at most 0.01: hover with little cyclic pitch";
        ensure(motion <= STEADY, quantity, motion, expected)?;
        let azimuths = self.azimuths();
        let angle = |i: usize| TAU * i as f64 / azimuths as f64;
        let turned = |nodes: &[Vec3]| -> Vec<Vec3> {
            let mut mean = vec![[0.0; 3]; self.nodes];
            for (i, blade) in nodes.chunks_exact(self.nodes).enumerate() {
                for (m, p) in mean.iter_mut().zip(blade) {
                    *m = add(*m, scale(about_the_shaft(*p, -angle(i)), 1.0 / azimuths as f64));
                }
            }
            let blades = 0..azimuths;
            blades.flat_map(|i| mean.iter().map(move |p| about_the_shaft(*p, angle(i)))).collect()
        };
        Ok(Self { nodes: self.nodes, points: turned(&self.points), edges: turned(&self.edges) })
    }

    /// The blades at every `n`-th of their azimuths, from the first.
    #[must_use]
    pub fn at_every(&self, n: usize) -> Self {
        let of = |nodes: &[Vec3]| -> Vec<Vec3> {
            nodes.chunks_exact(self.nodes).step_by(n.max(1)).flatten().copied().collect()
        };
        Self { nodes: self.nodes, points: of(&self.points), edges: of(&self.edges) }
    }

    /// Largest distance of a node from where the blade at azimuth 0 would be when turned there, unit `R`.
    pub(crate) fn departure_from_turning(&self) -> f64 {
        let azimuths = self.azimuths();
        let mut worst = 0.0_f64;
        for i in 0..azimuths {
            let angle = TAU * i as f64 / azimuths as f64;
            for (first, here) in [(self.at(0), self.at(i)), (self.edge_at(0), self.edge_at(i))] {
                for (start, p) in first.iter().zip(here) {
                    worst = worst.max(norm(sub(about_the_shaft(*start, angle), *p)));
                }
            }
        }
        worst
    }

    /// Largest chord if the wake leaves at the trailing edge, 0 if at the line, unit `R`.
    pub(crate) fn chord(&self) -> f64 {
        let at = |node: usize| norm(sub(self.edges[node], self.points[node])) / 0.75;
        let wider = |most: f64, chord: f64| if chord > most * SAME_CHORD { chord } else { most };
        (0..self.nodes).rev().map(at).fold(0.0, wider)
    }

    /// Number of azimuths.
    pub fn azimuths(&self) -> usize {
        self.points.len() / self.nodes
    }

    /// Where the trailers leave the blade at one azimuth.
    pub fn edge_at(&self, azimuth: usize) -> &[Vec3] {
        &self.edges[azimuth * self.nodes..(azimuth + 1) * self.nodes]
    }

    /// The trailing edge of one azimuth at a station between the nodes (unit `R`) of the rotor.
    pub(crate) fn edge_between(&self, azimuth: usize, rotor: &WakeRotor, station: f64) -> Vec3 {
        edge_between(self.edge_at(azimuth), rotor, station)
    }

    /// All nodes of the lifting line at one azimuth.
    pub fn at(&self, azimuth: usize) -> &[Vec3] {
        &self.points[azimuth * self.nodes..(azimuth + 1) * self.nodes]
    }
}
