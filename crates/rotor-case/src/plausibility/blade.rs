//! Warnings of the structure of the blade: stiffness, mass, size, and what its air does to it in torsion.

use super::{PlausibilityWarning, warning};
use crate::{Case, Joint};

/// Bending and torsion stiffness below which a blade is a rope, over `m0 Omega^2 R^4`: a hundredth of the
/// softest articulated blades.
const LEAST_STIFFNESS: f64 = 2e-5;

/// Stiffness above which a blade does not bend, over `m0 Omega^2 R^4`: twenty times that of blades stiff in
/// their plane.
const MOST_STIFFNESS: f64 = 2.0;

/// Mean of a table of mass per length over `m0` beyond which, or under one over which, `m0` is not the blade's.
const MOST_MEAN_MASS: f64 = 3.0;

/// Chord over the radius above which a rotor is a fan.
const MOST_CHORD: f64 = 0.2;

/// Radius of gyration over the chord above which the section lies outside its own chord.
const MOST_GYRATION: f64 = 1.0;

/// Part of the torsional stiffness that the air may take before the blade is nearly divergent.
const NEARLY_DIVERGENT: f64 = 0.5;

/// Frequency of the rigid blade on its pitch link below which it hardly holds its pitch, per rev.
const SOFT_PITCH_PER_REV: f64 = 2.0;

impl Case {
    /// Stiffness of a pitch spring that hardly holds the blade, and the frequency of the rigid blade on it.
    ///
    /// ```text
    /// p^2 = k / int m (k_m1^2 + k_m2^2) + (k_m2^2 - k_m1^2) / (k_m1^2 + k_m2^2)      uniform blade
    /// ```
    pub fn soft_pitch(&self) -> Option<(f64, f64)> {
        let r = &self.rotor;
        let Joint::Spring { stiffness } = r.root.feather else { return None };
        let [thin, wide] = [r.km1_r, r.km2_r].map(|k| k * k);
        let inertia = (thin + wide) * (1.0 - r.root_offset_r);
        let frequency_per_rev = (stiffness / inertia + (wide - thin) / (thin + wide)).sqrt();
        (frequency_per_rev < SOFT_PITCH_PER_REV).then_some((stiffness, frequency_per_rev))
    }

    /// Stiffness, mass and size that no blade has: of the structure alone, what modes and flight share.
    pub fn blade_warnings(&self) -> Vec<PlausibilityWarning> {
        let r = &self.rotor;
        let mut warnings = Vec::new();
        let soft = |value: f64| {
            format!(
                "the stiffness {value:e} m0 Omega^2 R^4 is less than {LEAST_STIFFNESS:e}, a hundredth of the softest blade's: the blade is a rope that rotation alone holds, and its curvature at the root is not resolved. Is the value over m0 Omega^2 R^4? The paper's blade has 0.0108 in flap, 0.0268 in lag, 0.00615 in torsion"
            )
        };
        let unit_n_m2 = self.scales().stiffness_newton_metre2();
        let stiff = |value: f64| {
            format!(
                "the stiffness {value:e} m0 Omega^2 R^4 is more than {MOST_STIFFNESS}, twenty times that of blades stiff in their plane: this one does not bend. Was it given in N m^2? Divide by m0 Omega^2 R^4, here {unit_n_m2:.4e} N m^2: {:.4e}",
                value / unit_n_m2
            )
        };
        for (key, value, table) in [
            ("ei_flap", r.ei_flap, &r.tables.ei_flap),
            ("ei_lag", r.ei_lag, &r.tables.ei_lag),
            ("gj", r.gj, &r.tables.gj),
        ] {
            // a table takes the place of the uniform value
            let uniform = table.is_empty().then(|| (format!("rotor.{key}"), value));
            let listed = table.iter().enumerate();
            let listed = listed.map(|(i, own)| (format!("rotor.tables.{key}[{i}]"), own.1));
            let all: Vec<(String, f64)> = uniform.into_iter().chain(listed).collect();
            if let Some((field, value)) = all.iter().find(|own| own.1 < LEAST_STIFFNESS) {
                warnings.push(warning(field, soft(*value)));
            }
            if let Some((field, value)) = all.iter().find(|own| own.1 > MOST_STIFFNESS) {
                warnings.push(warning(field, stiff(*value)));
            }
        }
        if let Some((stiffness, frequency)) = self.soft_pitch() {
            let message = format!(
                "a pitch spring of {stiffness} m0 Omega^2 R^3 leaves the blade a pitch frequency of about {frequency:.1} per rev: the loads turn it by many degrees. A pitch link gives 3 per rev and more"
            );
            warnings.push(warning("rotor.root.pitch.stiffness", message));
        }
        let tables = !r.tables.km1_r.is_empty() || !r.tables.km2_r.is_empty();
        if !tables && r.km1_r > r.km2_r {
            let message = format!(
                "the mass radius about the chord line, {} R, is larger than that about its normal, km2_r {} R: the section would be thicker than it is deep, and its propeller moment would turn it out of flat pitch. Are the two exchanged?",
                r.km1_r, r.km2_r
            );
            warnings.push(warning("rotor.km1_r", message));
        }
        warnings.extend(self.size_warnings());
        warnings.extend(self.divergence_warning());
        warnings
    }

    /// Masses and lengths that look like those of another unit.
    fn size_warnings(&self) -> Vec<PlausibilityWarning> {
        let r = &self.rotor;
        let mut warnings = Vec::new();
        let mean = mean_of(&r.tables.mass);
        if let Some(mean) = mean.filter(|m| !(1.0 / MOST_MEAN_MASS..=MOST_MEAN_MASS).contains(m)) {
            let message = format!(
                "the mean of the table is {mean:.3} of mass_kg_m, {} kg/m, which is to be the blade's own mass per length: lock_number and every stiffness refer to it. Was the table given in kg/m? Divide it by mass_kg_m",
                r.mass_kg_m
            );
            warnings.push(warning("rotor.tables.mass", message));
        }
        if r.chord_r > MOST_CHORD {
            let message = format!(
                "the chord is {} R, a blade's is 0.03 to 0.12. Was it given in m? Divide by radius_m: {:.4}",
                r.chord_r,
                r.chord_r / r.radius_m
            );
            warnings.push(warning("rotor.chord_r", message));
        }
        let most = MOST_GYRATION * r.chord_r;
        let t = &r.tables;
        for (key, value, table) in
            [("km1_r", r.km1_r, &t.km1_r), ("km2_r", r.km2_r, &t.km2_r), ("ka_r", r.ka_r, &t.ka_r)]
        {
            let (field, largest) = match table.iter().map(|own| own.1).reduce(f64::max) {
                Some(listed) => (format!("rotor.tables.{key}"), listed),
                None => (format!("rotor.{key}"), value),
            };
            if largest > most {
                let message = format!(
                    "the radius of gyration {largest} R is more than the chord, {} R: the section would lie outside it. Was it given in m? Divide by radius_m: {:.4}",
                    r.chord_r,
                    largest / r.radius_m
                );
                warnings.push(warning(&field, message));
            }
        }
        warnings
    }

    /// A blade that its lift, ahead of the elastic axis, nearly or wholly turns over.
    fn divergence_warning(&self) -> Option<PlausibilityWarning> {
        let blade = self.blade_properties().ok()?;
        let rotor = self.rotor_of(&blade, "rotor").ok()?;
        let ratio = rotor.torsional_divergence_ratio(self.advance_ratio);
        (ratio > NEARLY_DIVERGENT).then(|| {
            let what = if ratio >= 1.0 {
                "more than all: it diverges in torsion"
            } else {
                "at 1 it would diverge in torsion, and its loads are those of a blade near that"
            };
            let message = format!(
                "the lift, {} R ahead of the elastic axis, takes {ratio:.2} of the stiffness with which the blade resists a twist, {what}. Give a stiffer blade (rotor.gj) or pitch link (rotor.root.pitch), or an elastic axis nearer the quarter chord (aerodynamic_centre_r toward 0)",
                self.rotor.aerodynamic_centre_r
            );
            warning("rotor.aerodynamic_centre_r", message)
        })
    }
}

/// Mean of a table of straight lines over its stations; none of an empty one.
fn mean_of(table: &[(f64, f64)]) -> Option<f64> {
    let (first, last) = (table.first()?, table.last()?);
    let area: f64 = table.windows(2).map(|p| 0.5 * (p[1].0 - p[0].0) * (p[0].1 + p[1].1)).sum();
    Some(area / (last.0 - first.0))
}
