//! Undamped modes at a harmonic of the rotor speed: looked for before a rotor is trimmed.

use crate::SimError;
use crate::case::{JointChoice, LoadedCase, TrimValues};
use crate::problem::Place;
use rotor_response::{ResponseError, Rotor};
use trim::TrimError;

/// Frequency of the rigid blade on its pitch link below which it hardly holds its pitch, per rev.
const SOFT_PITCH_PER_REV: f64 = 2.0;

impl LoadedCase {
    /// Refuses a rotor, or one of its unlike blades, with an undamped coupled mode at a harmonic: at the
    /// collective of a prescribed trim, else at none. The trim looks again at the collective it finds.
    ///
    /// # Errors
    /// [`SimError::Response`] with mode, frequency and pitch at the field that is at fault;
    /// [`SimError::Blade`] and [`SimError::Response`] if the rotor cannot be built.
    pub fn refuse_resonance(&self) -> Result<(), SimError> {
        let case = &self.case;
        let at_rotor = |source| SimError::Response { place: self.index.place("rotor"), source };
        let blade = case.blade_properties()?;
        let rotor = Rotor::new(case.rotor_model(), &blade, case.discretisation());
        self.refuse_resonance_of(&rotor.map_err(at_rotor)?)
    }

    /// The same for the rotor of this case, already built.
    pub(crate) fn refuse_resonance_of(&self, rotor: &Rotor) -> Result<(), SimError> {
        let case = &self.case;
        let pitch_rad = match case.trim {
            TrimValues::Prescribed { theta0_rad, .. } => theta0_rad,
            TrimValues::Propulsive { .. } | TrimValues::WindTunnel { .. } => 0.0,
        };
        let found = rotor.refuse_resonance(pitch_rad);
        found.map_err(|source| SimError::Response { place: self.at_fault(&source), source })?;
        for (i, unlike) in case.blade.unlike.iter().enumerate() {
            let field = format!("rotor.unlike_blades[{i}]");
            let at = |source| SimError::Response { place: self.index.place(&field), source };
            let blade = case.unlike_blade(unlike)?;
            let rotor = Rotor::new(case.rotor_model(), &blade, case.discretisation());
            rotor.and_then(|rotor| rotor.refuse_resonance(pitch_rad)).map_err(at)?;
        }
        Ok(())
    }

    /// Field that a resonance is due to: the damping, or the root that leaves a mode without frequency.
    fn at_fault(&self, error: &ResponseError) -> Place {
        let steady = matches!(error, ResponseError::Resonance { frequency_per_rev, .. } if frequency_per_rev.round() == 0.0);
        self.index.place(if steady { "rotor.root" } else { "rotor.modal_damping" })
    }

    /// An error of the trim at the field that is at fault.
    pub(crate) fn trim_error(&self, source: TrimError) -> SimError {
        match source {
            TrimError::Response(source @ ResponseError::Resonance { .. }) => {
                SimError::Response { place: self.at_fault(&source), source }
            }
            source => {
                if let (true, Some((stiffness, frequency_per_rev))) =
                    (matches!(source, TrimError::Response(_)), self.soft_pitch())
                {
                    let place = self.index.place("rotor.root.pitch.stiffness");
                    return SimError::SoftPitch { place, stiffness, frequency_per_rev, source };
                }
                let field = match self.case.trim {
                    TrimValues::Propulsive { .. } | TrimValues::WindTunnel { .. } => {
                        "trim.ct_sigma"
                    }
                    TrimValues::Prescribed { .. } => "trim.theta0_deg",
                };
                SimError::Trim { place: self.index.place(field), source }
            }
        }
    }

    /// Stiffness of a pitch spring that hardly holds the blade, and the frequency of the rigid blade on it.
    ///
    /// ```text
    /// p^2 = k / int m (k_m1^2 + k_m2^2) + (k_m2^2 - k_m1^2) / (k_m1^2 + k_m2^2)      uniform blade
    /// ```
    pub(crate) fn soft_pitch(&self) -> Option<(f64, f64)> {
        let file = &self.file.rotor;
        let JointChoice::Spring { stiffness } = file.root.pitch else { return None };
        let [thin, wide] = [file.km1_r, file.km2_r].map(|k| k * k);
        let inertia = (thin + wide) * (1.0 - file.root_offset_r);
        let frequency_per_rev = (stiffness / inertia + (wide - thin) / (thin + wide)).sqrt();
        (frequency_per_rev < SOFT_PITCH_PER_REV).then_some((stiffness, frequency_per_rev))
    }
}
