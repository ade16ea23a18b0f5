//! T0 by central differences about zero control.

use crate::{ControlError, Measurement, Plant, PlantCall, RunError, TMatrix, error};

/// `T0 = dZ/du` about `u = 0` by central differences, one voltage step per control.
///
/// ```text
/// T0[:, j] = (Z(+h_j e_j) - Z(-h_j e_j)) / (2 h_j)
/// ```
/// The `2 n_u` measurements are handed to the plant in one call ([`Plant::measure_many`]), which may
/// answer them in parallel. Exact on a linear plant; the error of a smooth one falls as `h^2`. With
/// hysteresis the answer depends on the step however small it is: see [`step_sensitivity`].
///
/// | argument | symbol | unit | range |
/// |---|---|---|---|
/// | `step_volt` | `h_j` | volt | > 0, one per control |
///
/// # Errors
/// A failing plant, a step that is not positive, a measurement that is not finite or whose length
/// changes.
///
/// Source: eq. (8) and the text below it.
pub fn identify_t<P: Plant>(
    plant: &mut P,
    step_volt: &[f64],
) -> Result<TMatrix, RunError<P::Error>> {
    let controls = central_controls(plant, step_volt)?;
    let measurements = measure_all(plant, &controls)?;
    Ok(central_differences(step_volt, &measurements)?)
}

/// `T = dZ/du` about a control vector whose loads are known, and the measurements it took.
///
/// Central differences where the plant admits both sides of a control, one-sided ones to the
/// admitted side at the edge of its range.
///
/// | argument | symbol | unit | range |
/// |---|---|---|---|
/// | `here` | `u`, `Z(u)` | V, nondimensional | measured |
/// | `step_volt` | `h_j` | V | > 0, one per control |
///
/// # Errors
/// As [`identify_t`]; [`ControlError::NoRoomToIdentify`] if neither side of a control is admitted.
pub fn identify_t_about<P: Plant>(
    plant: &mut P,
    (control_volt, hub_loads): (&[f64], &[f64]),
    step_volt: &[f64],
) -> Result<(TMatrix, usize), RunError<P::Error>> {
    plant.layout().check(control_volt)?;
    error::check_vector("voltage steps of the T matrix (volt)", step_volt, control_volt.len())?;
    let mut controls = Vec::with_capacity(2 * control_volt.len());
    let mut sides = Vec::with_capacity(control_volt.len());
    for (control, &step) in step_volt.iter().enumerate() {
        error::check_positive("voltage step of the T matrix (volt)", step)?;
        let moved = |signed: f64| {
            let mut moved = control_volt.to_vec();
            moved[control] += signed;
            moved
        };
        let admitted = [moved(step), moved(-step)].map(|u| plant.admits(&u).then_some(u));
        if admitted.iter().all(Option::is_none) {
            return Err(ControlError::NoRoomToIdentify { control, step_volt: step }.into());
        }
        sides.push(admitted.each_ref().map(Option::is_some));
        controls.extend(admitted.into_iter().flatten());
    }
    let measurements = measure_all(plant, &controls)?;
    let mut found = measurements.iter().map(|m| m.hub_loads.as_slice());
    let columns: Vec<Vec<f64>> = sides
        .iter()
        .zip(step_volt)
        .map(|(&[up, down], step)| {
            let mut side = |there: bool| if there { found.next() } else { None };
            let (high, low) = (side(up), side(down));
            let width = step * (f64::from(u8::from(up)) + f64::from(u8::from(down)));
            let (high, low) = (high.unwrap_or(hub_loads), low.unwrap_or(hub_loads));
            high.iter().zip(low).map(|(h, l)| (h - l) / width).collect()
        })
        .collect();
    Ok((TMatrix::from_columns(&columns)?, controls.len()))
}

/// T0 for two voltage steps, and how much it depends on the step.
#[derive(Debug, Clone, PartialEq)]
pub struct StepSensitivity {
    /// T0 with the stated step, 1/V.
    pub t0: TMatrix,
    /// T0 with `factor` times the step, 1/V.
    pub t0_other: TMatrix,
    /// The stated step of each control, volt.
    pub step_volt: Vec<f64>,
    /// The other step over the stated one.
    pub factor: f64,
    /// `|T0_other - T0|_F / |T0|_F`: 0 on a linear plant, of order 1 where hysteresis rules.
    pub relative_difference: f64,
}

/// T0 for a voltage step and for `factor` times that step, `4 n_u` measurements in one call.
///
/// # Errors
/// As [`identify_t`], and [`ControlError::OutOfRange`] unless `factor` is positive and not 1.
pub fn step_sensitivity<P: Plant>(
    plant: &mut P,
    step_volt: &[f64],
    factor: f64,
) -> Result<StepSensitivity, RunError<P::Error>> {
    error::check_positive("factor between the two voltage steps", factor)?;
    if (factor - 1.0).abs() < f64::EPSILON {
        let what = "factor between the two voltage steps";
        Err(ControlError::OutOfRange { what, value: factor, expected: "any factor other than 1" })?;
    }
    let other_volt: Vec<f64> = step_volt.iter().map(|step| factor * step).collect();
    let mut controls = central_controls(plant, step_volt)?;
    let half = controls.len();
    controls.extend(central_controls(plant, &other_volt)?);
    let measurements = measure_all(plant, &controls)?;
    let t0 = central_differences(step_volt, &measurements[..half])?;
    let t0_other = central_differences(&other_volt, &measurements[half..])?;
    let relative_difference = t0_other.relative_difference(&t0)?;
    Ok(StepSensitivity { t0, t0_other, step_volt: step_volt.to_vec(), factor, relative_difference })
}

/// The control vectors of the central differences: `+h_0, -h_0, +h_1, -h_1, ...`.
fn central_controls<P: Plant>(plant: &P, step_volt: &[f64]) -> Result<Vec<Vec<f64>>, ControlError> {
    let zero = plant.layout().zero();
    error::check_vector("voltage steps of the T matrix (volt)", step_volt, zero.len())?;
    let mut controls = Vec::with_capacity(2 * zero.len());
    for (index, &step) in step_volt.iter().enumerate() {
        error::check_positive("voltage step of the T matrix (volt)", step)?;
        for signed in [step, -step] {
            let mut control = zero.clone();
            control[index] = signed;
            controls.push(control);
        }
    }
    Ok(controls)
}

fn measure_all<P: Plant>(
    plant: &mut P,
    controls: &[Vec<f64>],
) -> Result<Vec<Measurement>, RunError<P::Error>> {
    let measurements = plant.measure_many(controls).map_err(|source| RunError::Plant {
        call: PlantCall::MeasureMany { count: controls.len() },
        history: Vec::new(),
        source,
    })?;
    if measurements.len() != controls.len() {
        Err(ControlError::Length {
            what: "measurements for the T matrix",
            found: measurements.len(),
            expected: controls.len(),
        })?;
    }
    let loads = measurements.first().map_or(0, |m| m.hub_loads.len());
    for measurement in &measurements {
        error::check_vector("measured hub loads", &measurement.hub_loads, loads)?;
    }
    Ok(measurements)
}

fn central_differences(
    step_volt: &[f64],
    measurements: &[Measurement],
) -> Result<TMatrix, ControlError> {
    let columns: Vec<Vec<f64>> = step_volt
        .iter()
        .zip(measurements.chunks_exact(2))
        .map(|(step, pair)| {
            let (plus, minus) = (&pair[0].hub_loads, &pair[1].hub_loads);
            plus.iter().zip(minus).map(|(p, m)| (p - m) / (2.0 * step)).collect()
        })
        .collect();
    TMatrix::from_columns(&columns)
}
