//! Flies a machine at the points of a layout.

use super::drive::Voltage;
use super::machine::{Machine, OddBlade, Scales, Upwash};
use crate::error::RotorTruthError;
use crate::physics::balance::{Elastic, FlapAngles, Flow, Resolution};
use crate::physics::fourier::{Fourier, Pair};
use crate::physics::hub::{Root, harmonics, hub_loads};
use crate::physics::inflow::{InflowKind, Shape, glauert, helices};
use crate::physics::trim::{Held, Response, Solver};
use rayon::prelude::*;

/// Highest harmonic of a reading.
pub const HIGHEST: usize = 4;

/// A condition as stated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Condition {
    /// Advance ratio.
    pub advance_ratio: f64,
    /// Thrust over solidity.
    pub ct_sigma: f64,
    /// Shaft tilt, forward positive, deg.
    pub tilt_deg: f64,
    /// Rotor speed, rpm.
    pub omega_rpm: f64,
}

/// A condition with the drives flown there; one without voltage is the rotor with its flaps at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// The condition.
    pub condition: Condition,
    /// Voltages of the flaps, drive by drive.
    pub drives: Vec<Vec<Voltage>>,
}

/// What is read at a point, without noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Readings {
    /// Controls, deg.
    pub controls_deg: [f64; 3],
    /// Shaft power, W.
    pub power_watt: f64,
    /// Harmonics from 0 of the hub loads, N and N m.
    pub hub: Vec<Vec<Pair>>,
}

/// The rotor at one stated speed, with Jacobians from its first condition.
struct Spun<'a> {
    machine: &'a Machine,
    scales: Scales,
    elastic: &'a Elastic,
    solver: Solver<'a>,
    odd: Option<(OddBlade, &'a Elastic, Solver<'a>)>,
    reference: Option<Response>,
}

/// What is read at every point, group by group.
///
/// # Errors
/// [`RotorTruthError::Response`] of a point that has no periodic response.
pub fn fly(
    machine: &Machine,
    groups: &[Group],
    resolution: Resolution,
) -> Result<Vec<Vec<Readings>>, RotorTruthError> {
    let mut speeds: Vec<f64> = groups.iter().map(|own| own.condition.omega_rpm).collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    let mut out = vec![Vec::new(); groups.len()];
    for rpm in speeds {
        let elastic = Elastic::new(machine.blade_at(rpm, 1.0), resolution)?;
        let odd = match machine.odd {
            Some(own) => {
                let blade = machine.blade_at(rpm, own.mass_ratio);
                Some((own, Elastic::new(blade, resolution)?))
            }
            None => None,
        };
        let mut spun = Spun {
            machine,
            scales: machine.scales(rpm),
            elastic: &elastic,
            solver: Solver::new(&elastic),
            odd: odd.as_ref().map(|(own, blade)| (*own, blade, Solver::new(blade))),
            reference: None,
        };
        let here: Vec<usize> = (0..groups.len())
            .filter(|k| groups[*k].condition.omega_rpm.total_cmp(&rpm).is_eq())
            .collect();
        if let Some(first) = here.first() {
            spun.prepare(&groups[*first])?;
        }
        let found: Vec<Vec<Readings>> = here
            .par_iter()
            .map(|k| spun.group(&groups[*k]))
            .collect::<Result<_, RotorTruthError>>()?;
        for (k, own) in here.into_iter().zip(found) {
            out[k] = own;
        }
    }
    Ok(out)
}

/// Angles of a motion given in deg.
fn angles(motions: &[Voltage], fourier: &Fourier, late_rad: f64) -> FlapAngles {
    motions
        .iter()
        .map(|own| {
            let mut series = vec![0.0; fourier.size()];
            for (n, pair) in own.iter().filter(|own| own.0 <= fourier.harmonics) {
                let late = pair.later(*n as f64 * late_rad);
                series[2 * n - 1] += late.cosine.to_radians();
                series[2 * n] += late.sine.to_radians();
            }
            (0..fourier.azimuths).map(|k| fourier.at(&series, k)).collect()
        })
        .collect()
}

impl Spun<'_> {
    /// True advance ratio and loading.
    fn true_condition(&self, stated: &Condition) -> (f64, f64) {
        let m = self.machine;
        let loading = stated.ct_sigma / (m.density * m.speed * m.speed);
        (stated.advance_ratio / m.speed, loading)
    }

    fn flow(&self, elastic: &Elastic, stated: &Condition) -> Result<Flow, RotorTruthError> {
        let (mu, loading) = self.true_condition(stated);
        let tilt = stated.tilt_deg.to_radians();
        let thrust = loading * self.machine.solidity();
        let shape = match self.machine.inflow {
            InflowKind::Uniform => Shape::Uniform,
            InflowKind::Drees => Shape::Drees,
            InflowKind::Helices => {
                let lambda = mu * tilt.tan() + glauert(mu, tilt, thrust);
                let blades = elastic.blade.blades;
                Shape::Map(helices(&elastic.span, &elastic.fourier, blades, mu, lambda).0)
            }
        };
        let further = self.machine.upwash.map_or_else(Vec::new, |own| {
            let at = |x: f64, psi: f64| match own {
                Upwash::Walls(size) => -size * thrust / (2.0 * mu) * x * psi.cos(),
                Upwash::Fuselage(size) => {
                    let near = x / 0.35;
                    size * mu * near * psi.cos() * (-near * near).exp()
                }
            };
            let row = |x: &f64| {
                (0..elastic.fourier.azimuths).map(|k| at(*x, elastic.fourier.azimuth(k))).collect()
            };
            elastic.span.x.iter().map(row).collect()
        });
        elastic.flow(mu, tilt, shape, further)
    }

    /// Finds the Jacobians at a condition.
    fn prepare(&mut self, group: &Group) -> Result<(), RotorTruthError> {
        let flow = self.flow(self.elastic, &group.condition)?;
        let rest = self.elastic.flaps_at_rest();
        let held = Held::Thrust(self.true_condition(&group.condition).1);
        let trimmed = self.solver.solve(held, (&flow, &rest), None)?;
        let controls = Held::Controls(trimmed.controls());
        self.solver.solve(controls, (&flow, &rest), Some(&trimmed))?;
        if let Some((own, elastic, solver)) = &mut self.odd {
            let held = own.held(&trimmed);
            solver.solve(held, (&flow, &elastic.flaps_at_rest()), Some(&trimmed))?;
        }
        self.reference = Some(trimmed);
        Ok(())
    }

    fn group(&self, group: &Group) -> Result<Vec<Readings>, RotorTruthError> {
        let flow = self.flow(self.elastic, &group.condition)?;
        let rest = self.elastic.flaps_at_rest();
        let held = Held::Thrust(self.true_condition(&group.condition).1);
        let mut solver = self.solver.clone();
        let trimmed = solver.solve(held, (&flow, &rest), self.reference.as_ref())?;
        group
            .drives
            .par_iter()
            .map(|drive| {
                let motions: Vec<Voltage> =
                    drive.iter().map(|own| self.machine.actuator.motion_deg(own)).collect();
                let is_driven = motions.iter().any(|own| !own.is_empty());
                let flown = if is_driven {
                    let moving = angles(&motions, &self.elastic.fourier, 0.0);
                    let held = Held::Controls(trimmed.controls());
                    solver.clone().solve(held, (&flow, &moving), Some(&trimmed))?
                } else {
                    trimmed.clone()
                };
                let odd = self.odd_root(&flow, &motions, &flown)?;
                Ok(self.read(&flown, odd.as_ref()))
            })
            .collect()
    }

    /// Root loads of the blade that differs, in the units of the others.
    fn odd_root(
        &self,
        flow: &Flow,
        motions: &[Voltage],
        alike: &Response,
    ) -> Result<Option<(usize, Vec<Root>)>, RotorTruthError> {
        let Some((own, elastic, solver)) = &self.odd else { return Ok(None) };
        let moving = if motions.iter().any(|own| !own.is_empty()) {
            angles(motions, &elastic.fourier, own.flaps_late_rad)
        } else {
            elastic.flaps_at_rest()
        };
        let found = solver.clone().solve(own.held(alike), (flow, &moving), Some(alike))?;
        let scale = |root: &Root| root.map(|load| load * own.mass_ratio);
        Ok(Some((own.blade, found.root.iter().map(scale).collect())))
    }

    fn read(&self, flown: &Response, odd: Option<&(usize, Vec<Root>)>) -> Readings {
        let (blades, scales, path) = (self.elastic.blade.blades, self.scales, &self.machine.path);
        let roots: Vec<&[Root]> = (1..=blades)
            .map(|k| match odd {
                Some((blade, root)) if *blade == k => root.as_slice(),
                _ => flown.root.as_slice(),
            })
            .collect();
        let loads = hub_loads(&self.elastic.fourier, &roots);
        let mean_torque = loads.iter().map(|own| own[5]).sum::<f64>() / loads.len() as f64;
        let hub = (0..6)
            .map(|k| {
                let unit = if k < 3 { scales.force_newton } else { scales.moment_newton_metre() };
                let own = harmonics(&loads, k, HIGHEST);
                let one = |(n, pair): (usize, Pair)| {
                    let load = self.with_imbalance(k, n, pair.times(unit));
                    path.read(k, n, scales.omega_rad_s, load)
                };
                own.into_iter().enumerate().map(one).collect()
            })
            .collect();
        let mut controls_deg = flown.controls().map(f64::to_degrees);
        controls_deg[0] += path.collective_deg;
        let power_watt = -mean_torque * scales.moment_newton_metre() * scales.omega_rad_s;
        Readings { controls_deg, power_watt, hub }
    }

    /// A rotating force in the plane of the disk.
    fn with_imbalance(&self, load: usize, harmonic: usize, own: Pair) -> Pair {
        let (nominal, at) = self.machine.imbalance;
        let nominal_rad_s = super::machine::NOMINAL_RPM * std::f64::consts::TAU / 60.0;
        let force = nominal * (self.scales.omega_rad_s / nominal_rad_s).powi(2);
        let (sin, cos) = at.sin_cos();
        match (load, harmonic) {
            (0, 1) => Pair { cosine: own.cosine + force * cos, sine: own.sine - force * sin },
            (1, 1) => Pair { cosine: own.cosine + force * sin, sine: own.sine + force * cos },
            _ => own,
        }
    }
}

impl OddBlade {
    /// Its controls and the inflow of the rotor with all blades alike.
    fn held(&self, alike: &Response) -> Held {
        let [t0, t1c, t1s] = alike.controls();
        Held::All { controls: [t0 + self.pitch_rad, t1c, t1s], lambda_i: alike.lambda_i() }
    }
}
