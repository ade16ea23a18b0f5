//! Airloads of sections against azimuth, in the coefficients in which measured rotors are published.
//!
//! ```text
//! n = -sin th e_chord + cos th e_normal      c = cos th e_chord + sin th e_normal      th pitch of the section
//! C_n M^2 = 2 N M_tip^2 / (rho c)            C_c M^2 the same of the chord force       C_m M^2 = 2 M M_tip^2 / (rho c^2)
//! ```
//! per length, rotor units; on the speed of sound, so that they do not grow where the flow is slow. The moment is about the
//! aerodynamic centre, the quarter chord unless the case sets it elsewhere.
//!
//! Source: the definitions of the HART II workshop, B. G. van der Wall, DLR IB 111-2003/31.

use crate::{Condition, ResponseError, RotorSolution, RotorSolver};
use nalgebra::DMatrix;
use rayon::prelude::*;
use rotor_base::{LagrangeBasis, gauss_legendre, uniform_azimuths_rad};
use rotor_fem::{OrbitSamples, TimeElements};
use std::f64::consts::TAU;

/// Airloads of a section at one azimuth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionAirload {
    /// Azimuth of the blade, rad; 0 aft.
    pub azimuth_rad: f64,
    /// `C_n M^2`, normal to the chord, up positive.
    pub normal_m2: f64,
    /// `C_m M^2` about the aerodynamic centre, nose up positive.
    pub moment_m2: f64,
    /// `C_c M^2`, along the chord toward the leading edge positive.
    pub chord_m2: f64,
    /// `C_n`, over the dynamic pressure of the flow at the section.
    pub normal: f64,
    /// Mach number of that flow.
    pub mach: f64,
}

/// Airloads of a station over the revolution.
#[derive(Debug, Clone, PartialEq)]
pub struct StationAirloads {
    /// Station, R.
    pub station: f64,
    /// Azimuth by azimuth.
    pub loads: Vec<SectionAirload>,
}

/// Motion of the blade tip at one azimuth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipMotion {
    /// Azimuth of the blade, rad; 0 aft.
    pub azimuth_rad: f64,
    /// Deflection normal to the coned blade, up positive, R.
    pub flap: f64,
    /// Deflection in its plane, toward the leading edge positive, R.
    pub lag: f64,
    /// Elastic twist, nose up positive, rad.
    pub twist_rad: f64,
}

/// Normal, moment and chord coefficient times `M^2`, and `M^2`.
const COLUMNS: usize = 4;

impl RotorSolver {
    /// Airloads at lifting stations of a solution of this solver obtained in `condition`, at so many equal azimuths.
    ///
    /// Along the span and in azimuth the values are those of the polynomials through the points of a piece of the span and
    /// of a time element.
    ///
    /// | argument | meaning |
    /// |---|---|
    /// | `stations` | R, from the cut-out to the tip |
    /// | `tip_mach` | `Omega R / a` |
    /// | `azimuths` | number of equal steps of a revolution |
    ///
    /// # Errors
    /// [`ResponseError::LoadStation`] for a station that carries no air, [`ResponseError::FlapMotions`], and the errors of
    /// stalling sections.
    pub fn airloads(
        &self,
        condition: &Condition,
        solution: &RotorSolution,
        stations: &[f64],
        (tip_mach, azimuths): (f64, usize),
    ) -> Result<Vec<StationAirloads>, ResponseError> {
        self.check_flaps(&condition.flap_angles_rad)?;
        let (blade, first) = (self.rotor.blade(), self.air.first_station);
        let root = blade.cutout;
        if let Some(&station) = stations.iter().find(|s| !(**s >= root && **s <= 1.0)) {
            return Err(ResponseError::LoadStation { station, root });
        }
        let system = self.rotor.system(&self.air, self.point_inputs(condition, &solution.inflow));
        let orbit = solution.orbit.sample(&self.time);
        let samples = OrbitSamples { qdd: solution.accelerations.clone(), ..orbit };
        let revolution = system.revolution(&samples)?;
        let at_points: Vec<Vec<[f64; COLUMNS]>> = (0..revolution.points())
            .into_par_iter()
            .map(|p| {
                let flows = system.flows(p, &system.motion(&samples, p));
                let sections = flows.iter().zip(revolution.at(p)).enumerate();
                let of = sections.map(|(s, (flow, loads))| {
                    let scales = blade.air[first + s];
                    let (sin, cos) = flow.pitch.sin_cos();
                    let normal = loads.fz * cos - loads.fy * sin;
                    let chord = loads.fy * cos + loads.fz * sin;
                    let moment = (loads.moment - scales.centre * normal) / scales.chord;
                    let coefficient = 2.0 * tip_mach * tip_mach / scales.density_chord;
                    let speed = flow.u_t.hypot(flow.u_p) * tip_mach;
                    [coefficient * normal, coefficient * moment, coefficient * chord, speed * speed]
                });
                of.collect()
            })
            .collect();
        let psi = uniform_azimuths_rad(azimuths);
        let weights = azimuth_weights(&self.time, &psi);
        let of = |&station: &f64| {
            let (from, shares) = blade.grid.shares_at(station);
            let history = DMatrix::from_fn(at_points.len(), COLUMNS, |p, k| {
                let values = &at_points[p][from - first..];
                shares.iter().zip(values).map(|(share, value)| share * value[k]).sum()
            });
            let values = &weights * history;
            let load = |(row, &azimuth_rad): (usize, &f64)| {
                let squared = values[(row, 3)].max(f64::MIN_POSITIVE);
                SectionAirload {
                    azimuth_rad,
                    normal_m2: values[(row, 0)],
                    moment_m2: values[(row, 1)],
                    chord_m2: values[(row, 2)],
                    normal: values[(row, 0)] / squared,
                    mach: squared.sqrt(),
                }
            };
            StationAirloads { station, loads: psi.iter().enumerate().map(load).collect() }
        };
        Ok(stations.iter().map(of).collect())
    }

    /// Motion of the blade tip of a solution at so many equal azimuths.
    pub fn tip_motion(&self, solution: &RotorSolution, azimuths: usize) -> Vec<TipMotion> {
        let blade = self.rotor.blade();
        let samples = solution.orbit.sample(&self.time);
        let psi = uniform_azimuths_rad(azimuths);
        let values = azimuth_weights(&self.time, &psi) * samples.q.transpose();
        let (lag, torsion) = (blade.flap.count(), blade.flap.count() + blade.lag.count());
        let sum = |row: usize, from: usize, to: usize| -> f64 {
            // every shape is 1 at the tip
            (from..to).map(|mode| values[(row, mode)]).sum()
        };
        let at = |(row, &azimuth_rad): (usize, &f64)| TipMotion {
            azimuth_rad,
            flap: sum(row, 0, lag),
            lag: sum(row, lag, torsion),
            twist_rad: sum(row, torsion, values.ncols()),
        };
        psi.iter().enumerate().map(at).collect()
    }
}

/// Weights of the values at the points of the time elements at azimuths: the polynomial of the element there.
fn azimuth_weights(time: &TimeElements, azimuths_rad: &[f64]) -> DMatrix<f64> {
    let (elements, gauss) = (time.elements(), time.gauss_per_element());
    let basis = LagrangeBasis::new(gauss_legendre(gauss).nodes);
    let mut weights = DMatrix::zeros(azimuths_rad.len(), elements * gauss);
    for (row, azimuth) in azimuths_rad.iter().enumerate() {
        let place = azimuth.rem_euclid(TAU) / TAU * elements as f64;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 to elements"
        )]
        let element = (place as usize).min(elements - 1);
        let shares = basis.evaluate(2.0 * (place - element as f64) - 1.0);
        for (g, [share, ..]) in shares.into_iter().enumerate() {
            weights[(row, element * gauss + g)] = share;
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Compressibility, Controls, Couplings, Discretisation, ResponseTolerances, Rotor, RotorModel,
    };
    use flap_aero::AttachedFlowModel;
    use rotor_base::HarmonicSeries;
    use rotor_fem::{BladeProperties, BladeSpec};
    use rotor_wake::{FlightState, LinearInflow};
    use std::sync::Arc;

    const TIP_MACH: f64 = 0.6;

    fn solved(advance_ratio: f64, inflow: f64) -> (RotorSolver, Condition, RotorSolution) {
        let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
        let model = RotorModel {
            section_model: AttachedFlowModel::QuasiSteady,
            compressibility: Compressibility::None,
            ..RotorModel::table_1(Couplings::Full)
        };
        let flaps = model.flaps.len();
        let rotor = Arc::new(Rotor::new(model, &blade, Discretisation::default()).unwrap());
        let tolerances = ResponseTolerances::default();
        let mut solver = RotorSolver::new(rotor, advance_ratio, tolerances).unwrap();
        let condition = Condition {
            flight: FlightState { advance_ratio, shaft_tilt_rad: 0.0 },
            controls: Controls { theta0_rad: 0.12, theta1c_rad: 0.02, theta1s_rad: -0.05 },
            flap_angles_rad: vec![HarmonicSeries::zero(0); flaps],
            bank_rad: 0.0,
        };
        let model = LinearInflow::Prescribed { induced_inflow: inflow };
        let found = solver.solve(&condition, &model, None).unwrap();
        (solver, condition, found)
    }

    /// A section in hover without inflow, cyclic pitch or flapping speed has the lift of its incidence and its profile drag,
    /// turned by its pitch.
    #[test]
    fn a_section_in_hover_has_the_coefficients_of_its_incidence() {
        let (mut solver, mut condition, _) = solved(0.0, 0.0);
        condition.controls = Controls { theta0_rad: 0.12, ..Controls::default() };
        let still = LinearInflow::Prescribed { induced_inflow: 0.0 };
        let found = solver.solve(&condition, &still, None).unwrap();
        let tip = solver.tip_motion(&found, 8);
        assert!(tip.iter().all(|t| (t.twist_rad - tip[0].twist_rad).abs() < 1e-8));
        for station in [0.4, 0.75, 0.9] {
            let loads = solver.airloads(&condition, &found, &[station], (TIP_MACH, 8)).unwrap();
            let twist = solver.rotor().blade().properties.twist_rad(station);
            let phi: f64 = found.modal
                [found.modal.len() - solver.rotor().blade().torsion.count()..]
                .iter()
                .zip(&solver.rotor().blade().torsion.value)
                .map(|(q, shape)| {
                    let (from, shares) = solver.rotor().blade().grid.shares_at(station);
                    q.mean * shares.iter().zip(&shape[from..]).map(|(a, b)| a * b).sum::<f64>()
                })
                .sum();
            let pitch: f64 = 0.12 + twist + phi;
            let cd = solver.rotor().model().drag_coefficient;
            // flap damping of a coned blade: none; its pitch rate Omega w_x turns the section as a flat plate feels it
            for load in &loads[0].loads {
                let mach = TIP_MACH * station;
                assert!((load.mach - mach).abs() < 2e-3 * mach, "{} {mach}", load.mach);
                let lift = TAU * pitch;
                let expected = lift * pitch.cos() + cd * pitch.sin();
                assert!(
                    (load.normal - expected).abs() < 0.03 * expected,
                    "{} {expected}",
                    load.normal
                );
                let chord = lift * pitch.sin() - cd * pitch.cos();
                let found = load.chord_m2 / (load.mach * load.mach);
                assert!((found - chord).abs() < 0.05 * chord.abs(), "{found} {chord}");
            }
        }
    }

    /// In forward flight the normal and chord forces of all stations, turned back by their pitch, make the thrust; at the
    /// points themselves nothing is interpolated.
    #[test]
    fn the_airloads_of_all_sections_make_the_thrust() {
        let (solver, condition, found) = solved(0.25, 0.015);
        let blade = solver.rotor().blade();
        let first = solver.air.first_station;
        let (x, weight) = (&blade.grid.x()[first..], &blade.grid.weight()[first..]);
        let loads = solver.airloads(&condition, &found, x, (TIP_MACH, 720)).unwrap();
        let mut thrust = 0.0;
        for ((of, weight), i) in loads.iter().zip(weight).zip(first..) {
            let scale = 0.5 * blade.air[i].density_chord / (TIP_MACH * TIP_MACH);
            for load in &of.loads {
                let psi = load.azimuth_rad;
                let elastic: f64 = found.modal[found.modal.len() - blade.torsion.count()..]
                    .iter()
                    .zip(&blade.torsion.value)
                    .map(|(q, shape)| q.value(psi) * shape[i])
                    .sum();
                let root = condition.controls.root_pitch(solver.root_pitch_rad(), psi);
                let pitch = root.angle_rad + blade.twist[i] + elastic;
                let up = load.normal_m2 * pitch.cos() + load.chord_m2 * pitch.sin();
                thrust += weight * scale * up / 720.0;
            }
        }
        let whole = solver.rotor().model().thrust_coefficient(4.0 * thrust);
        println!("{whole:.6e} {:.6e}", found.thrust_coefficient);
        assert!((whole / found.thrust_coefficient - 1.0).abs() < 1e-6);
        let inside = solver.airloads(&condition, &found, &[0.1], (TIP_MACH, 8));
        assert!(matches!(inside, Err(ResponseError::LoadStation { .. })));
    }

    #[test]
    fn weights_in_azimuth_hold_what_an_element_holds() {
        let time = TimeElements::new(5, 4, 8).unwrap();
        let psi = [0.1, 2.0, 4.5, 6.2, TAU - 1e-12];
        let weights = azimuth_weights(&time, &psi);
        let smooth = |p: &f64| (3.0 * p).sin();
        let values = DMatrix::from_iterator(40, 1, time.points().iter().map(smooth));
        for (found, psi) in (weights * values).iter().zip(&psi) {
            assert!((found - smooth(psi)).abs() < 1e-4, "{found} {psi}");
        }
    }
}
