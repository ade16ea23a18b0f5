//! The linear matrices of one 15-dof element about the undeformed rotating blade.

use nalgebra::SMatrix;
use rotor_base::gauss_legendre;

use crate::BladeProperties;
use crate::beam::shape::{ELEMENT_DOF, Row, Rows};

/// Gauss points in every stretch of an element without a jump of properties.
///
/// Six integrate degree 11: the highest here is tension (2) times two Hermite slopes (4), or mass (1)
/// times two Hermite cubics (6).
const GAUSS_POINTS: usize = 6;

/// A square matrix over the degrees of freedom of one element.
pub(crate) type ElementMatrix = SMatrix<f64, ELEMENT_DOF, ELEMENT_DOF>;

/// Matrices of one element in rotor units: `M q'' + G q' + K q = 0` (rates per 1/Omega).
#[derive(Debug, Clone)]
pub(crate) struct ElementMatrices {
    pub(crate) mass: ElementMatrix,
    pub(crate) stiffness: ElementMatrix,
    pub(crate) gyroscopic: ElementMatrix,
}

/// Matrices of the element between stations `from` and `to`.
///
/// Properties may jump inside the element: each stretch between jumps is integrated apart.
pub(crate) fn element_matrices(blade: &BladeProperties, from: f64, to: f64) -> ElementMatrices {
    let mut sum = ElementMatrices {
        mass: ElementMatrix::zeros(),
        stiffness: ElementMatrix::zeros(),
        gyroscopic: ElementMatrix::zeros(),
    };
    let inner = blade.breaks().iter().copied().filter(|b| *b > from && *b < to);
    let ends: Vec<f64> = [from].into_iter().chain(inner).chain([to]).collect();
    let rule = gauss_legendre(GAUSS_POINTS);
    for stretch in ends.windows(2) {
        let (half, mid) = (0.5 * (stretch[1] - stretch[0]), 0.5 * (stretch[1] + stretch[0]));
        for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
            let station = mid + half * node;
            let rows = Rows::at((station - from) / (to - from), to - from);
            let dx = half * weight;
            sum.mass += mass_density(blade, station, &rows) * dx;
            sum.stiffness += stiffness_density(blade, station, &rows) * dx;
            sum.gyroscopic += gyroscopic_density(blade, station, &rows) * dx;
        }
    }
    sum
}

/// `a b'`, the matrix of a product of two quantities.
fn product(a: &Row, b: &Row) -> ElementMatrix {
    a * b.transpose()
}

/// `a a'`, the matrix of a square.
fn square(a: &Row) -> ElementMatrix {
    product(a, a)
}

/// Mass per length.
///
/// ```text
/// m (u^2 + v^2 + w^2 + k_m^2 phi^2)
/// ```
/// Not modelled: rotary inertia of bending, offset of the centre of gravity.
fn mass_density(blade: &BladeProperties, x: f64, n: &Rows) -> ElementMatrix {
    let translation = square(&n.axial[0]) + square(&n.lag[0]) + square(&n.flap[0]);
    (translation + square(&n.twist[0]) * blade.squared_polar_radius(x)) * blade.mass(x)
}

/// Stiffness per length: strain energy, centrifugal tension and centrifugal potential.
///
/// ```text
/// EI_z kappa_z^2 + EI_y kappa_y^2,   kappa_z = v'' cos th + w'' sin th,  kappa_y = w'' cos th - v'' sin th
/// + EA (u' + k_A^2 th' phi')^2 + GJ phi'^2
/// + T (v'^2 + w'^2 + k_A^2 phi'^2)
/// - m Omega^2 [v^2 + (u cos b - w sin b)^2] + m Omega^2 cos^2 b (k_m2^2 - k_m1^2) cos 2th phi^2
/// ```
/// with th pitch plus twist, b precone and T the steady tension. Symmetric.
///
/// Assumes: expansion about the undeformed blade; the tension is that of steady rotation, so axial
/// motion need not be resolved to have centrifugal stiffening.
/// Not modelled: bending-torsion coupling through steady curvature, offsets of tension axis and centre
/// of gravity, the warping part of the trapeze effect, `E (B_1 - A k_A^4) th'^2`.
/// Source: second variation of the Hodges-Dowell energy (NASA TN D-7818, 1974) at zero deflection.
fn stiffness_density(blade: &BladeProperties, x: f64, n: &Rows) -> ElementMatrix {
    let spec = blade.spec();
    let (sin, cos) = blade.section_pitch_rad(x).sin_cos();
    let (sin_b, cos_b) = spec.precone_rad.sin_cos();
    let [km1_2, km2_2] = blade.squared_mass_radii(x);
    let (ka_2, tension) = (blade.squared_area_radius(x), blade.tension(x));
    let spin = blade.mass(x) * spec.rotor_speed.powi(2);

    let kappa_z = n.lag[2] * cos + n.flap[2] * sin;
    let kappa_y = n.flap[2] * cos - n.lag[2] * sin;
    let stretch = n.axial[1] + n.twist[1] * (ka_2 * blade.twist_rate_rad(x));
    let radial = n.axial[0] * cos_b - n.flap[0] * sin_b;
    let propeller = cos_b * cos_b * (km2_2 - km1_2) * (cos * cos - sin * sin);

    square(&kappa_z) * blade.lag_stiffness(x)
        + square(&kappa_y) * blade.flap_stiffness(x)
        + square(&stretch) * blade.axial_stiffness(x)
        + square(&n.twist[1]) * (blade.torsion_stiffness(x) + tension * ka_2)
        + (square(&n.lag[1]) + square(&n.flap[1])) * tension
        + (square(&n.twist[0]) * propeller - square(&n.lag[0]) - square(&radial)) * spin
}

/// Gyroscopic (Coriolis) terms per length, skew-symmetric.
///
/// ```text
/// axial equation: -2 m Omega cos b v',   flap equation: +2 m Omega sin b v'
/// lag equation:   +2 m Omega cos b u'  - 2 m Omega sin b w'
/// ```
/// with the prime a rate and b the precone: the Coriolis force of rotation about an axis tilted by b
/// against the section's z axis.
fn gyroscopic_density(blade: &BladeProperties, x: f64, n: &Rows) -> ElementMatrix {
    let spec = blade.spec();
    let (sin_b, cos_b) = spec.precone_rad.sin_cos();
    let radial = n.axial[0] * cos_b - n.flap[0] * sin_b;
    let half = product(&n.lag[0], &radial);
    (half - half.transpose()) * (2.0 * blade.mass(x) * spec.rotor_speed)
}
