//! Static divergence in torsion: the lift of a twisted blade twists it further.

use crate::Rotor;
use crate::model::air_scales::AirScales;
use crate::model::rotor_model::MACH_LIMIT;
use nalgebra::DMatrix;

impl Rotor {
    /// Moment of the air on an elastic twist over the moment with which the blade resists it, in the shape where
    /// the ratio is largest: 1 is divergence, and next to it any load twists the blade without measure. Zero or
    /// negative where the quarter chord is on the elastic axis or behind it, and without a torsion mode.
    ///
    /// ```text
    /// A q = ratio K q,   A_jk = (rho c / 2) e int (x^2 + mu^2 / 2) a(M x) phi_j phi_k dx,   K = diag(omega_j^2 M_j)
    /// ```
    /// with the lift slope `a = 2 pi / sqrt(1 - M^2)` and the quarter chord `e` ahead of the axis, both over the
    /// lifting span; `x^2 + mu^2 / 2` is the square of the speed, its mean over the revolution. Assumes settled
    /// sections, no bending.
    pub fn torsional_divergence_ratio(&self, advance_ratio: f64) -> f64 {
        let (blade, model) = (self.blade(), self.model());
        let shapes = &blade.torsion.value;
        let first = blade.frequencies.len() - shapes.len();
        let stiffness = (first..blade.frequencies.len())
            .map(|i| blade.frequencies[i].powi(2) * blade.modal_masses[i]);
        let root: Vec<f64> = stiffness.map(|k| k.sqrt().recip()).collect();
        let per_angle: Vec<f64> = blade
            .grid()
            .x()
            .iter()
            .map(|&x| {
                if x < model.root_cutout || x > model.tip_loss {
                    return 0.0;
                }
                let speed_squared = x * x + 0.5 * advance_ratio * advance_ratio;
                let mach = (model.compressible_tip_mach() * x).min(MACH_LIMIT);
                let slope = std::f64::consts::TAU / (1.0 - mach * mach).sqrt();
                let scales = AirScales::at(model, x);
                0.5 * scales.density_chord * speed_squared * slope * scales.centre
            })
            .collect();
        let scaled = DMatrix::from_fn(shapes.len(), shapes.len(), |j, k| {
            let product = (0..per_angle.len()).map(|i| per_angle[i] * shapes[j][i] * shapes[k][i]);
            blade.grid.integral(&product.collect::<Vec<f64>>()) * root[j] * root[k]
        });
        scaled.symmetric_eigenvalues().iter().fold(0.0, |largest, value| value.max(largest))
    }
}
