//! Loads of the blade at any station, by force summation, by the statics of the deflected blade, by curvature.
//!
//! ```text
//! F(s) = int_s^1 (f - m a) dx
//! M_w(s) = int_s^1 (x - s) f_z + m_w dx,   M_v(s) = int_s^1 (x - s) f_y + m_v dx,   M_phi(s) = int_s^1 m_phi dx
//! statics   M(s) = int_s^1 (r - r_s) x (f - m a) + m dx,   r_s = (s + u, y_t + v, w) deflected
//!           torsion = (1, v_x, w_x) . M,   flap = -M_y,   lag = M_z
//! ```
//! `f` holds the loads of the air, the inertia of the flaps and the weight. Forces and moments are what the blade
//! outboard puts on the section, in coned blade axes: x outboard, y to the leading edge, z up; the torsion is that
//! about the deflected axis.
//!
//! Source: force summation and mode displacement of R. L. Bisplinghoff, H. Ashley, R. L. Halfman, Aeroelasticity
//! (1955), on a rotating blade.

use crate::loads::section_moments::{curvature_moments, moments_outboard};
use crate::loads::wrenches::summed;
use crate::response::evaluated::Revolution;
use crate::response::revolution::series;
use crate::response::root_reaction::Loading;
use crate::response::system::ResponseSystem;
use crate::sections::air::SectionLoads;
use crate::sections::flight_air::POINTS_TOGETHER;
use crate::structure::equations::SpanLoads;
use crate::structure::load_station::LoadStation;
use crate::{Condition, ResponseError, RotorSolution, RotorSolver};
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_fem::{OrbitSamples, TimeElements};

/// Loads over one revolution: at the points of the time elements, and as harmonics.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadHistory<const N: usize> {
    /// Every component at every azimuth.
    pub values: Vec<[f64; N]>,
    /// Harmonics of every component, as many as the discretisation keeps of the loads.
    pub harmonics: [HarmonicSeries; N],
}

impl<const N: usize> LoadHistory<N> {
    fn new(time: &TimeElements, values: Vec<[f64; N]>, count: usize) -> Self {
        let harmonics = std::array::from_fn(|k| series(time, values.iter().map(|v| v[k]), count));
        Self { values, harmonics }
    }

    /// Largest less smallest value of every component over the revolution.
    pub fn peak_to_peak(&self) -> [f64; N] {
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; N];
        for value in &self.values {
            for ([low, high], v) in range.iter_mut().zip(value) {
                (*low, *high) = (low.min(*v), high.max(*v));
            }
        }
        range.map(|[low, high]| high - low)
    }
}

/// What the blade outboard of a station puts on the rest of it; forces in `m0 Omega^2 R^2`, moments in
/// `m0 Omega^2 R^3`.
///
/// Moments are in the order flap (tip up positive), lag (tip forward), torsion (nose up). `moments` and `statics`
/// are sums of the same loads. `moments` holds the terms that the equations of motion keep: it is the reaction of
/// the equations at the section, zero at a free hinge, stiffness times angle at a spring, and its gap to
/// `curvature` is the modal truncation and nothing else. Hub loads, trim and control know it alone (with `Linear`
/// they know `statics`). `statics` is that of the deflected blade, whole: its gap to `moments` is the terms of
/// third order (with `Linear` of second order) that the equations leave out, the lever that deflection gives the
/// loads: a few percent of the flap moment at the root, and moments at a free hinge.
///
/// Modal damping has no distribution along the span: what it holds stays in the gap to `curvature`, and a joint
/// carries it as a damper would.
#[derive(Debug, Clone, PartialEq)]
pub struct StationLoads {
    /// Station, R.
    pub station: f64,
    /// Azimuths of the histories, rad: the points of the time elements.
    pub azimuths_rad: Vec<f64>,
    /// Axial force (tension positive), in-plane shear (toward the leading edge), out-of-plane shear (up).
    pub forces: LoadHistory<3>,
    /// Force summation with the terms of the equations of motion: what the hub gets.
    pub moments: LoadHistory<3>,
    /// Statics of the deflected blade, about the deflected axis.
    pub statics: LoadHistory<3>,
    /// From curvature and rate of twist: mode displacement, which converges slowly with the modes.
    pub curvature: LoadHistory<3>,
}

/// Loads at one station and azimuth.
struct PointLoads {
    forces: [f64; 3],
    moments: [f64; 3],
    statics: [f64; 3],
    curvature: [f64; 3],
}

impl RotorSolver {
    /// Loads of one blade at stations of its span, of a solution of this solver obtained in `condition`.
    ///
    /// Integrals from a station within a piece of the span are those of the polynomial through the piece's
    /// points: the stations asked for change nothing of the solution.
    ///
    /// # Errors
    /// [`ResponseError::LoadStation`] for a station that is not on the blade, [`ResponseError::FlapMotions`],
    /// and the errors of stalling sections.
    pub fn station_loads(
        &self,
        condition: &Condition,
        solution: &RotorSolution,
        stations: &[f64],
    ) -> Result<Vec<StationLoads>, ResponseError> {
        self.check_flaps(&condition.flap_angles_rad)?;
        let (blade, discretisation) = (self.rotor.blade(), self.rotor.discretisation);
        let (root, elements) = (blade.root_offset, discretisation.blade_elements);
        let stations = stations
            .iter()
            .map(|&station| {
                if !(station >= root && station <= 1.0) {
                    return Err(ResponseError::LoadStation { station, root });
                }
                LoadStation::new(station, elements, &blade.properties, &blade.modes, &blade.grid)
            })
            .collect::<Result<Vec<_>, _>>()?;
        let system = self.rotor.system(&self.air, self.point_inputs(condition, &solution.inflow));
        let orbit = solution.orbit.sample(&self.time);
        let samples = OrbitSamples { qdd: solution.accelerations.clone(), ..orbit };
        let revolution = system.revolution(&samples)?;
        let points: Vec<Vec<PointLoads>> = (0..revolution.points())
            .into_par_iter()
            .with_min_len(POINTS_TOGETHER)
            .map_init(SpanLoads::default, |loads, p| {
                at_point(&system, &samples, &revolution, p, loads, &stations)
            })
            .collect();
        let history = |s: usize, pick: fn(&PointLoads) -> [f64; 3]| {
            let values = points.iter().map(|at| pick(&at[s])).collect();
            LoadHistory::new(&self.time, values, discretisation.load_harmonics)
        };
        Ok(stations
            .iter()
            .enumerate()
            .map(|(s, station)| StationLoads {
                station: station.x,
                azimuths_rad: self.time.points().to_vec(),
                forces: history(s, |at| at.forces),
                moments: history(s, |at| at.moments),
                statics: history(s, |at| at.statics),
                curvature: history(s, |at| at.curvature),
            })
            .collect())
    }
}

fn at_point(
    system: &ResponseSystem<'_>,
    samples: &OrbitSamples,
    revolution: &Revolution,
    p: usize,
    loads: &mut SpanLoads,
    stations: &[LoadStation],
) -> Vec<PointLoads> {
    let (blade, couplings) = (system.blade, system.couplings);
    let coordinates = samples.at(p);
    let q = coordinates[0];
    let sections: Vec<SectionLoads> = revolution.at(p).collect();
    let motion = &system.motion(samples, p);
    let loading = Loading::new(system, (motion, &sections), p, loads, coordinates);
    let pitch = system.points[p].air.pitch.angle_rad;
    let at = |station: &LoadStation| {
        let shape = station.shape(blade, q);
        let shortening: f64 =
            station.inboard.iter().zip(&loading.shortening).map(|(w, u)| w * u).sum();
        let place = [station.x + shortening, blade.offsets.torque + shape.lag[0], shape.flap[0]];
        let wrench = summed(&station.outboard, &loading.wrenches);
        let (forces, [mx, my, mz]) = moved(wrench, place);
        PointLoads {
            forces,
            statics: [-my, mz, mx + shape.lag[1] * my + shape.flap[1] * mz],
            moments: moments_outboard(
                station.x,
                &station.outboard,
                blade.grid.x(),
                &loading.turning,
            ),
            curvature: curvature_moments(blade, couplings, station, q, pitch, forces[0]),
        }
    };
    stations.iter().map(at).collect()
}

/// Force, and moment about a place, of a force and its moment about the rotor centre.
fn moved(wrench: [f64; 6], place: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let [fx, fy, fz, mx, my, mz] = wrench;
    let [x, y, z] = place;
    ([fx, fy, fz], [mx - y * fz + z * fy, my - z * fx + x * fz, mz - x * fy + y * fx])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Controls, Couplings, Discretisation, FlapMass, ResponseTolerances, Rotor, RotorModel,
        TrailingEdgeFlap,
    };
    use rotor_base::{LagrangeBasis, gauss_legendre};
    use rotor_fem::{BladeProperties, BladeSpec, TorsionTerms};
    use rotor_wake::{FlightState, LinearInflow};
    use std::sync::Arc;

    /// Integral of a density given at the points of the span between two stations, piece by piece by another
    /// rule than the span's own.
    fn between(rotor: &Rotor, [from, to]: [f64; 2], density: &dyn Fn(usize) -> f64) -> f64 {
        let grid = &rotor.blade().grid;
        let (n, rule) = (grid.points_per_piece(), gauss_legendre(7));
        let piece = |(k, ends): (usize, &[f64])| -> f64 {
            let (low, high) = (ends[0].max(from), ends[1].min(to));
            if low >= high {
                return 0.0;
            }
            let points: Vec<usize> = (k * n..(k + 1) * n).collect();
            let basis = LagrangeBasis::new(points.iter().map(|i| grid.x()[*i]).collect());
            let (half, middle) = (0.5 * (high - low), 0.5 * (high + low));
            rule.nodes
                .iter()
                .zip(&rule.weights)
                .map(|(node, weight)| {
                    let at = basis.evaluate(middle + half * node);
                    let value: f64 = at.iter().zip(&points).map(|(b, i)| b[0] * density(*i)).sum();
                    half * weight * value
                })
                .sum()
        };
        grid.edges().windows(2).enumerate().map(piece).sum()
    }

    /// Between two stations the loads change by what is distributed there, moments by the shear besides.
    #[test]
    fn between_two_stations_is_the_load_distributed_there() {
        for couplings in [Couplings::Full, Couplings::Moderate(TorsionTerms::default())] {
            let flaps = TrailingEdgeFlap::paper_case()
                .map(|flap| TrailingEdgeFlap { mass: FlapMass::AddedToBlade, ..flap });
            let model = RotorModel {
                couplings,
                gravity: 0.01,
                flaps: flaps.to_vec(),
                ..RotorModel::paper_case()
            };
            let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
            let rotor = Arc::new(Rotor::new(model, &blade, Discretisation::default()).unwrap());
            let tolerances = ResponseTolerances::default();
            let mut solver = RotorSolver::new(rotor.clone(), 0.3, tolerances).unwrap();
            let mut angle = HarmonicSeries::zero(2);
            angle.set_harmonic(2, rotor_base::Harmonic { cosine: 0.03, sine: -0.05 });
            let condition = Condition {
                bank_rad: -0.03,
                flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.1 },
                controls: Controls { theta0_rad: 0.145, theta1c_rad: 0.02, theta1s_rad: -0.08 },
                flap_angles_rad: vec![angle.clone(), angle],
            };
            let found = solver.solve(&condition, &LinearInflow::Drees, None).unwrap();
            let ends = [0.233, 0.771];
            let loads = solver.station_loads(&condition, &found, &ends).unwrap();

            let system = rotor.system(&solver.air, solver.point_inputs(&condition, &found.inflow));
            let orbit = found.orbit.sample(&solver.time);
            let samples = OrbitSamples { qdd: found.accelerations.clone(), ..orbit };
            let revolution = system.revolution(&samples).unwrap();
            for p in [0, 17, 40] {
                let q = samples.at(p)[0];
                let mut span = SpanLoads::default();
                let sections: Vec<SectionLoads> = revolution.at(p).collect();
                let at = (&system.motion(&samples, p), sections.as_slice());
                let loading = Loading::new(&system, at, p, &mut span, samples.at(p));
                let crate::ResponseBlade { properties, modes, grid, .. } = rotor.blade();
                let places = ends.map(|x| {
                    let station = LoadStation::new(x, 10, properties, modes, grid).unwrap();
                    let shape = station.shape(rotor.blade(), q);
                    let shortening = between(&rotor, [0.0, x], &|i| loading.shortening[i]);
                    ([x + shortening, shape.lag[0], shape.flap[0]], [shape.lag[1], shape.flap[1]])
                });
                let [inner, outer] = [&loads[0], &loads[1]];
                let change: [f64; 6] =
                    std::array::from_fn(|k| between(&rotor, ends, &|i| loading.wrenches[i][k]));
                // moments about the shaft do not know where the station is
                let about_shaft = |at: &StationLoads, (r, slope): ([f64; 3], [f64; 2])| {
                    let (f, [flap, lag, torsion]) = (at.forces.values[p], at.statics.values[p]);
                    let own = [torsion + slope[0] * flap - slope[1] * lag, -flap, lag];
                    let moment: [f64; 3] = std::array::from_fn(|k| {
                        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
                        own[k] + r[a] * f[b] - r[b] * f[a]
                    });
                    [f, moment].concat()
                };
                let [a, b] = [about_shaft(inner, places[0]), about_shaft(outer, places[1])];
                for ((a, b), change) in a.iter().zip(b).zip(change) {
                    assert!((a - b - change).abs() < 1e-14, "{a} {b} {change}");
                }
                assert!(change.iter().all(|c| c.abs() < 1.0) && change[4].abs() > 1e-3);
                let twisting = between(&rotor, ends, &|i| loading.turning[i].moment[2]);
                let gap = inner.moments.values[p][2] - outer.moments.values[p][2] - twisting;
                assert!(gap.abs() < 1e-15, "{gap:e}");
            }
        }
    }
}
