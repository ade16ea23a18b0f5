//! A filament on the grid of azimuth and age.

use crate::vector::{Vec3, norm, sub};

/// Nodes of the filament that one node of a blade trails, `[azimuth of the blade][age]`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Filament {
    /// Spanwise node that trails it.
    pub(crate) node: usize,
    /// Age steps.
    pub(crate) steps: usize,
    pub(crate) points: Vec<Vec3>,
}

impl Filament {
    pub(crate) fn new(node: usize, steps: usize, azimuths: usize) -> Self {
        Self { node, steps, points: vec![[0.0; 3]; azimuths * (steps + 1)] }
    }

    pub(crate) fn at(&self, azimuth: usize) -> &[Vec3] {
        let width = self.steps + 1;
        &self.points[azimuth * width..(azimuth + 1) * width]
    }

    pub(crate) fn index(&self, azimuth: usize, age: usize) -> usize {
        azimuth * (self.steps + 1) + age
    }

    /// Values on the grid by a function of the azimuth and the age, in steps.
    pub(crate) fn fill(&mut self, azimuths: usize, f: impl Fn(usize, usize) -> Vec3) {
        for i in 0..azimuths {
            for k in 0..=self.steps {
                let at = self.index(i, k);
                self.points[at] = f(i, k);
            }
        }
    }
}

/// RMS distance of the nodes of pairs of filaments of the same grid, unit `R`.
pub(crate) fn rms_distance<'a>(pairs: impl Iterator<Item = (&'a Filament, &'a Filament)>) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for (p, q) in pairs.flat_map(|(a, b)| a.points.iter().zip(&b.points)) {
        let d = norm(sub(*p, *q));
        sum += d * d;
        count += 1;
    }
    (sum / f64::from(count.max(1))).sqrt()
}
