//! T by differences of measurements.

use crate::{ControlError, OperatingPoint, Plant, RunError, TMatrix, error};

/// `T0 = dZ/du` about `u = 0` by central differences, one voltage step per control.
///
/// ```text
/// T0[:, j] = (Z(+h_j e_j) - Z(-h_j e_j)) / (2 h_j)
/// ```
/// The `2 n_u` measurements are handed to the plant in one call ([`Plant::measure_many`]), which may
/// answer them in parallel. Exact on a linear plant; the error of a smooth one falls as `h^2`. With
/// hysteresis the answer depends on the step however small it is: compare two steps by
/// [`TMatrix::relative_difference`].
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
    let zero = plant.layout().zero();
    let about = OperatingPoint { control_volt: &zero, outputs: &[] };
    Ok(differences(plant, about, step_volt, |_, _| true)?.0)
}

/// `T = dZ/du` about a control vector whose loads are known (those about zero are not needed), and the measurements it
/// took.
///
/// Central differences where both sides of a control are admitted, one-sided ones to the admitted side at the edge of
/// the plant's range.
///
/// # Errors
/// As [`identify_t`]; [`ControlError::NoRoomToIdentify`] if neither side of a control is admitted.
pub(crate) fn differences<P: Plant>(
    plant: &mut P,
    about: OperatingPoint<'_>,
    step_volt: &[f64],
    admits: impl Fn(&P, &[f64]) -> bool,
) -> Result<(TMatrix, usize), RunError<P::Error>> {
    let OperatingPoint { control_volt, outputs } = about;
    error::check_vector("voltage steps of the T matrix (volt)", step_volt, control_volt.len())?;
    let mut controls = Vec::with_capacity(2 * control_volt.len());
    let mut sides = Vec::with_capacity(control_volt.len());
    for (control, &step) in step_volt.iter().enumerate() {
        error::check_positive("voltage step of the T matrix (volt)", step)?;
        let admitted = [step, -step].map(|signed| {
            let mut moved = control_volt.to_vec();
            moved[control] += signed;
            admits(plant, &moved).then_some(moved)
        });
        if admitted == [None, None] {
            return Err(ControlError::NoRoomToIdentify { control, step_volt: step }.into());
        }
        sides.push(admitted.each_ref().map(Option::is_some));
        controls.extend(admitted.into_iter().flatten());
    }
    let call = "measured for T, step by step about the control";
    let measurements =
        plant.measure_many(&controls).map_err(RunError::plant(call, control_volt))?;
    let what = "measurements for the T matrix";
    error::check_length(what, measurements.len(), controls.len())?;
    let loads = measurements.first().map_or(0, |m| m.outputs.len());
    for measurement in &measurements {
        error::check_vector("measured outputs", &measurement.outputs, loads)?;
    }
    let mut found = measurements.iter().map(|m| m.outputs.as_slice());
    let column = |(sides, step): ([bool; 2], &f64)| -> Vec<f64> {
        let mut side = |is_measured: bool| if is_measured { found.next() } else { None };
        let [high, low] = sides.map(|is_measured| side(is_measured).unwrap_or(outputs));
        let width = if sides == [true, true] { 2.0 * step } else { *step };
        high.iter().zip(low).map(|(h, l)| (h - l) / width).collect()
    };
    let columns: Vec<Vec<f64>> = sides.into_iter().zip(step_volt).map(column).collect();
    Ok((TMatrix::from_columns(&columns)?, controls.len()))
}
