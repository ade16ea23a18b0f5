//! A blade with the mass of flaps that its own mass does not contain.

use crate::{FlapMass, ResponseError, TrailingEdgeFlap};
use rotor_fem::{BladeProperties, BladeSpec, Distribution};

/// The blade with the mass of its [`FlapMass::AddedToBlade`] flaps on its elastic axis; the blade as it
/// is if there are none.
///
/// ```text
/// m -> m + m_f,   k_m -> k_m sqrt( m / (m + m_f) )      over the span of each flap
/// ```
/// The polar inertia of the blade stays what it was: that of the flap, and its distance from the axis,
/// are loads of their own in the response.
///
/// # Errors
/// [`ResponseError::MassTable`] if mass or radii of gyration vary linearly, and what the finite elements
/// refuse.
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
    let tables = [
        ("mass", &spec.mass),
        ("thickness_gyration_radius", &spec.thickness_gyration_radius),
        ("chord_gyration_radius", &spec.chord_gyration_radius),
    ];
    for (field, table) in tables {
        if matches!(table, Distribution::PiecewiseLinear { .. }) {
            return Err(ResponseError::MassTable { field });
        }
    }
    let root = spec.root_offset;
    let mut edges: Vec<f64> = tables
        .iter()
        .flat_map(|(_, table)| table.breaks().iter().copied())
        .chain(heavy.iter().flat_map(|f| [f.start, f.end]))
        .filter(|x| *x > root && *x < 1.0)
        .chain([root, 1.0])
        .collect();
    edges.sort_by(f64::total_cmp);
    edges.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let middles: Vec<f64> = edges.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let flap_mass = |x: f64| -> f64 {
        heavy.iter().filter(|f| (f.start..f.end).contains(&x)).map(|f| f.mass_fraction).sum()
    };
    let stepped = |value: &dyn Fn(f64) -> f64| Distribution::PiecewiseConstant {
        edges: edges.clone(),
        values: middles.iter().map(|x| value(*x)).collect(),
    };
    let share = |x: f64| (blade.mass(x) / (blade.mass(x) + flap_mass(x))).sqrt();
    Ok(BladeProperties::new(BladeSpec {
        mass: stepped(&|x| blade.mass(x) + flap_mass(x)),
        thickness_gyration_radius: stepped(&|x| spec.thickness_gyration_radius.value(x) * share(x)),
        chord_gyration_radius: stepped(&|x| spec.chord_gyration_radius.value(x) * share(x)),
        ..spec.clone()
    })?)
}
