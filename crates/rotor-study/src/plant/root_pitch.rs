//! Root pitch as the plant of a controller: individual blade control, or a swashplate.

use crate::flaps::PlantError;
use crate::rotor::{RootPitchEffect, TrimmedRotor};
use hhc_control::{ControlError, ControlLayout, Measurement, Plant, RunError, TMatrix};
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_base::series::scaled;
use rotor_response::{RotorSolution, StateChange};

/// The plant: degrees of pitch at the root of every blade in, hub loads out.
///
/// The control vector is that of one flap in deg, where a plant of piezo actuators has volts: cosine and sine of every
/// harmonic, nose up positive, each blade at its own azimuth. No limit of the stroke is set: the control weight
/// bounds it.
#[derive(Debug, Clone)]
pub struct RootPitchPlant {
    layout: ControlLayout,
    rotor: TrimmedRotor,
    /// About the trim, one for each control.
    effects: Vec<RootPitchEffect>,
}

impl RootPitchPlant {
    /// A plant of some harmonics per rev, linearised about the trim of its rotor.
    ///
    /// # Errors
    /// [`RunError::Control`] for no harmonic, 0 or one given twice; the errors of the linearised rotor.
    pub fn new(rotor: TrimmedRotor, harmonics: &[usize]) -> Result<Self, RunError<PlantError>> {
        let numbers = harmonics.iter().map(|&n| u32::try_from(n).unwrap_or(u32::MAX)).collect();
        let layout = ControlLayout::new(1, numbers)?;
        let about = (&HarmonicSeries::default(), &rotor.trim().rotor);
        let effects = rotor
            .root_pitch_effects(about, harmonics)
            .map_err(|source| RunError::plant("linearised", &layout.zero())(source.into()))?;
        Ok(Self { layout, rotor, effects })
    }

    /// T about zero control, load per deg.
    ///
    /// # Errors
    /// [`RunError::Control`] for loads that are not finite.
    pub fn t_at_rest(&self) -> Result<TMatrix, RunError<PlantError>> {
        Ok(t_of(&self.effects)?)
    }

    /// Root pitch of a control vector (deg), rad.
    ///
    /// # Errors
    /// [`PlantError::Control`] for a vector of another length.
    pub fn pitch_rad(&self, control_deg: &[f64]) -> Result<HarmonicSeries, PlantError> {
        let each = self.layout.voltages_volt(control_deg).map_err(PlantError::Control)?;
        let mut pitch_deg = HarmonicSeries::default();
        for (n, harmonic) in self.layout.harmonics().iter().zip(each) {
            pitch_deg.set_harmonic(*n as usize, harmonic);
        }
        Ok(scaled(&pitch_deg, 1.0_f64.to_radians()))
    }

    /// Response of the rotor to a control vector, deg. Depends on the control vector alone.
    ///
    /// # Errors
    /// The errors of the rotor.
    pub fn response(&self, control_deg: &[f64]) -> Result<RotorSolution, PlantError> {
        let pitch_rad = self.pitch_rad(control_deg)?;
        let trimmed = &self.rotor.trim().rotor;
        let mut change: Option<StateChange> = None;
        for (effect, deg) in self.effects.iter().zip(control_deg) {
            let whole = change.get_or_insert_with(|| effect.state_per_deg.zero());
            whole.add(&effect.state_per_deg, *deg);
        }
        let start = match (change, self.rotor.rotor().model().nonlinear.is_linear()) {
            (Some(change), true) => trimmed.clone().moved_start(&change)?,
            // sections that stall may have more than one orbit: their way is left alone
            _ => trimmed.clone(),
        };
        Ok(self.rotor.with_root_pitch(&pitch_rad, &start)?)
    }

    /// What is measured of a response.
    fn seen(
        &self,
        control_deg: &[f64],
        response: &RotorSolution,
    ) -> Result<Measurement, PlantError> {
        Ok(Measurement {
            outputs: response.hub.harmonic(self.rotor.rotor().model().blades).to_vec(),
            flap_motion_deg: self.layout.voltages_volt(control_deg).map_err(PlantError::Control)?,
            mean_flap_deg: vec![0.0],
        })
    }
}

/// T from what a degree of every control does.
fn t_of(effects: &[RootPitchEffect]) -> Result<TMatrix, ControlError> {
    let columns: Vec<Vec<f64>> = effects.iter().map(|e| e.loads_per_deg.to_vec()).collect();
    TMatrix::from_columns(&columns)
}

impl Plant for RootPitchPlant {
    type Error = PlantError;

    fn layout(&self) -> &ControlLayout {
        &self.layout
    }

    fn measure(&mut self, control_deg: &[f64]) -> Result<Measurement, PlantError> {
        self.seen(control_deg, &self.response(control_deg)?)
    }

    fn measure_many(&mut self, controls_deg: &[Vec<f64>]) -> Result<Vec<Measurement>, PlantError> {
        let plant = &*self;
        controls_deg.par_iter().map(|u| plant.seen(u, &plant.response(u)?)).collect()
    }

    fn strokes_deg(&mut self, control_deg: &[f64]) -> Result<Vec<f64>, PlantError> {
        self.layout.amplitudes_volt(control_deg).map_err(PlantError::Control)
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        vec![f64::INFINITY; self.layout.pairs()]
    }

    fn linearised_t(&mut self, control_deg: &[f64]) -> Result<Option<TMatrix>, PlantError> {
        let at_rest = control_deg.iter().all(|deg| *deg == 0.0);
        let t = if at_rest {
            t_of(&self.effects)
        } else {
            let harmonics: Vec<usize> =
                self.layout.harmonics().iter().map(|n| *n as usize).collect();
            let about = (&self.pitch_rad(control_deg)?, &self.response(control_deg)?);
            t_of(&self.rotor.root_pitch_effects(about, &harmonics)?)
        };
        t.map(Some).map_err(PlantError::Control)
    }
}
