//! Loads of the air and induced velocity over the disk, of the trimmed rotor.

use super::TrimmedRotor;
use rotor_response::ResponseError;
use rotor_wake::WakeRotor;
use serde::{Deserialize, Serialize};

/// Panels and azimuths of the disk where no free wake has its own.
const PANELS: usize = 20;
const AZIMUTHS: usize = 36;

/// What the disk carries, one blade at every azimuth, flaps at rest: at panels of the span and equal azimuths from 0 (over the
/// tail, growing counter-clockwise seen from above). Values stand azimuth by azimuth, panel by panel from the root.
///
/// ```text
/// T = N_b / N_psi  sum over azimuths and panels of  thrust_newton_per_m dr
/// ```
/// but for what the deflection of the blades turns of the other forces of the air, under 1e-3 of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DiskLoads {
    /// Ends of the panels from cut-out to tip, R.
    pub edges_r: Vec<f64>,
    /// `C_n M^2` of the sections in the middle of the panels, normal to the chord, up positive.
    pub cn_m2: Vec<f64>,
    /// Lift per length along the shaft, up positive, N/m: the mean over a panel.
    #[serde(rename = "thrust_N_per_m")]
    pub thrust_newton_per_m: Vec<f64>,
    /// Induced velocity through the disk in the middle of the panels, down positive, m/s.
    pub induced_m_s: Vec<f64>,
}

impl DiskLoads {
    /// Middles of the panels, R.
    pub fn stations_r(&self) -> Vec<f64> {
        self.edges_r.windows(2).map(|ends| 0.5 * (ends[0] + ends[1])).collect()
    }

    /// Number of panels, at least 1.
    pub fn panels(&self) -> usize {
        self.edges_r.len().saturating_sub(1).max(1)
    }

    /// Number of azimuths.
    pub fn azimuths(&self) -> usize {
        self.cn_m2.len() / self.panels()
    }
}

impl TrimmedRotor {
    /// What the disk carries, on the panels and azimuths of the free wake; without one on 20 panels of equal width and 36
    /// azimuths. `tip_mach` is `Omega R / a`.
    ///
    /// # Errors
    /// As [`airloads`](Self::airloads).
    pub fn disk_loads(&self, tip_mach: f64) -> Result<DiskLoads, ResponseError> {
        let (panels, azimuths) = match self.wake() {
            Some(trim) => (trim.wake.rotor().clone(), trim.wake.settings().azimuths),
            None => (WakeRotor::uniform(1, self.rotor().model().root_cutout, PANELS)?, AZIMUTHS),
        };
        let (stations, found) = (panels.stations(), &self.trim().rotor);
        let (airloads, tip) = self.airloads(&stations, tip_mach, azimuths)?;
        let unit = self.scales().force_newton() / self.scales().radius_m();
        let thrust = self.solver.thrust_per_length(found, &panels, azimuths);
        let inflow = tip.iter().flat_map(|at| found.inflow.velocities(at.azimuth_rad, &stations));
        let of_azimuth = |i: usize| airloads.iter().map(move |station| station.loads[i].normal_m2);
        Ok(DiskLoads {
            cn_m2: (0..azimuths).flat_map(of_azimuth).collect(),
            thrust_newton_per_m: thrust.into_iter().map(|value| unit * value).collect(),
            induced_m_s: inflow.map(|[down, _]| self.scales().tip_speed_m_s() * down).collect(),
            edges_r: panels.nodes().to_vec(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flap_aero::AttachedFlowModel;
    use rotor_case::{Case, CompressibilityChoice, FreeWakeValues, InflowChoice, ModeNumbers};

    fn quick() -> Case {
        let mut case = Case { advance_ratio: 0.2, ..Case::default() };
        case.structure.elements = 4;
        case.structure.modes = ModeNumbers::from([2, 1, 1]);
        case.aerodynamics.model = AttachedFlowModel::QuasiSteady;
        case.aerodynamics.compressibility = CompressibilityChoice::None;
        case
    }

    /// In linear inflow and in a free wake the loads over the disk make the thrust, and the inflow is that of the trim.
    #[test]
    fn the_loads_of_the_disk_make_the_thrust() {
        let wake = FreeWakeValues {
            azimuths: Some(12),
            turns: Some(2),
            panels: 8,
            ..FreeWakeValues::default()
        };
        // the precone turns the lift from the shaft, the flap slope turns it on
        for (model, [panels, azimuths], precone_deg, bound) in [
            (InflowChoice::Drees, [20, 36], 0.0, 1e-6),
            (InflowChoice::FreeWake(wake), [8, 12], 0.0, 1e-6),
            (InflowChoice::Drees, [20, 36], 3.0, 6e-4),
        ] {
            let mut case = quick();
            case.rotor.precone_deg = precone_deg;
            case.inflow.model = model;
            let rotor = TrimmedRotor::new(&case, None).unwrap();
            let disk = rotor.disk_loads(case.tip_mach()).unwrap();
            assert!(disk.panels() >= panels && disk.azimuths() == azimuths, "{}", disk.panels());
            let widths: Vec<f64> = disk.edges_r.windows(2).map(|ends| ends[1] - ends[0]).collect();
            let radius_m = case.rotor.radius_m;
            let of = |(k, value): (usize, &f64)| value * widths[k % widths.len()] * radius_m;
            let sum: f64 = disk.thrust_newton_per_m.iter().enumerate().map(of).sum();
            let thrust = sum * case.rotor.blades as f64 / azimuths as f64;
            let model = rotor.rotor().model();
            let up = thrust / case.scales().force_newton();
            let ratio = model.thrust_coefficient(up) / rotor.trim().rotor.thrust_coefficient;
            println!("{ratio:.9}");
            assert!((ratio - 1.0).abs() < bound, "{ratio}");
            let (at, r) = (7 * disk.panels() + 5, disk.stations_r()[5]);
            let azimuth = 7.0 / azimuths as f64 * std::f64::consts::TAU;
            let induced = rotor.trim().rotor.inflow.at(azimuth, r) * case.scales().tip_speed_m_s();
            assert!((disk.induced_m_s[at] - induced).abs() < 1e-12, "{induced}");
            let loads = rotor.airloads(&[r], case.tip_mach(), azimuths).unwrap().0;
            assert!((loads[0].loads[7].normal_m2 - disk.cn_m2[at]).abs() < 1e-12);
        }
    }
}
