//! A blade with the mass of flaps that its own mass does not contain.

use crate::{FlapMass, ResponseError, TrailingEdgeFlap};
use rotor_fem::{BladeProperties, BladeSpec, Distribution};

/// The blade with the mass of its [`FlapMass::AddedToBlade`] flaps on its elastic axis; the blade as it
/// is if there are none.
///
/// ```text
/// m -> m + m_f   over the span of each flap
/// ```
/// The polar inertia of the blade and the first moment about its mass centre stay what they were: those of
/// the flap, by its distance from the axis, are loads of their own in the response. Mass that the blade has
/// on its axis already is kept; where that varies linearly, its mean between edges is.
///
/// # Errors
/// What the finite elements refuse.
pub fn with_flap_masses(
    blade: &BladeProperties,
    flaps: &[TrailingEdgeFlap],
) -> Result<BladeProperties, ResponseError> {
    let added = |f: &&TrailingEdgeFlap| f.mass == FlapMass::AddedToBlade && f.mass_fraction > 0.0;
    let heavy: Vec<&TrailingEdgeFlap> = flaps.iter().filter(added).collect();
    if heavy.is_empty() {
        return Ok(blade.clone());
    }
    let spec = blade.spec();
    let root = spec.root_offset;
    let mut edges: Vec<f64> = heavy
        .iter()
        .flat_map(|f| [f.start, f.end])
        .chain(spec.axis_mass.breaks().iter().copied())
        .filter(|x| *x > root && *x < 1.0)
        .chain([root, 1.0])
        .collect();
    edges.sort_by(f64::total_cmp);
    edges.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let flap_mass = |x: f64| -> f64 {
        heavy.iter().filter(|f| (f.start..f.end).contains(&x)).map(|f| f.mass_fraction).sum()
    };
    let on_axis = |x: f64| spec.axis_mass.value(x) + flap_mass(x);
    let values = edges.windows(2).map(|pair| on_axis(0.5 * (pair[0] + pair[1]))).collect();
    let axis_mass = Distribution::PiecewiseConstant { edges, values };
    Ok(BladeProperties::new(BladeSpec { axis_mass, ..spec.clone() })?)
}
