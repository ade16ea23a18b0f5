//! A rigid rotor of blade elements in its own wake: the wake alone, without a response solver.

use nalgebra::{DMatrix, DVector, Dyn, LU};
use rotor_wake::{
    BladeLines, CirculationMap, FlightState, FreeWake, FreeWakeSettings, InflowMap, LineInduction,
    Vec3, WakeError, WakeMarch, WakeRotor, WakeSymmetry, momentum_inflow,
};
use std::f64::consts::TAU;

/// Steady section coefficients.
pub trait SectionPolar: Send + Sync {
    /// Lift and drag coefficient at an angle of attack (rad, any) and a Mach number.
    fn lift_drag(&self, alpha_rad: f64, mach: f64) -> [f64; 2];
}

/// Attached flow of a thin section with a parabolic drag polar.
///
/// ```text
/// c_l = 2 pi alpha / sqrt(1 - M^2),      c_d = c_d0 + k alpha^2
/// ```
/// In reverse flow the trailing edge leads: `alpha` is taken from the flow along the chord either way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AttachedPolar {
    /// Drag coefficient at zero lift.
    pub zero_lift_drag: f64,
    /// Growth of the drag coefficient with the square of the angle of attack, per rad^2.
    pub drag_growth: f64,
}

impl SectionPolar for AttachedPolar {
    fn lift_drag(&self, alpha_rad: f64, mach: f64) -> [f64; 2] {
        let folded = (2.0 * alpha_rad).sin().atan2((2.0 * alpha_rad).cos()) * 0.5;
        let beta = (1.0 - mach.min(0.9).powi(2)).sqrt();
        // sin of the angle itself carries the sense of the lift through reverse flow
        let sense = if alpha_rad.cos() < 0.0 { -1.0 } else { 1.0 };
        [sense * TAU * folded / beta, self.zero_lift_drag + self.drag_growth * folded * folded]
    }
}

/// Pitch and flapping of rigid blades, rad.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RigidMotion {
    /// Pitch at `0.75 R`: mean, `cos psi` and `sin psi` part.
    pub pitch_rad: [f64; 3],
    /// Flapping about the rotor centre, up positive: mean, `cos psi` and `sin psi` part.
    pub flap_rad: [f64; 3],
}

impl RigidMotion {
    fn series([mean, cosine, sine]: [f64; 3], azimuth_rad: f64) -> [f64; 2] {
        let (s, c) = azimuth_rad.sin_cos();
        [mean + cosine * c + sine * s, sine * c - cosine * s]
    }
}

/// A rigid rotor.
pub struct BladeElementRotor<'a> {
    /// Blades and panels.
    pub rotor: WakeRotor,
    /// Chord, unit `R`.
    pub chord: f64,
    /// Linear twist from centre to tip, rad, zero at `0.75 R`.
    pub twist_rad: f64,
    /// Hover tip Mach number.
    pub tip_mach: f64,
    /// Pitch and flapping.
    pub motion: RigidMotion,
    /// The section.
    pub polar: &'a dyn SectionPolar,
}

/// Thrust and in-plane force per length of one panel and the circulation there.
#[derive(Debug, Clone, Copy)]
struct Element {
    thrust: f64,
    drag: f64,
    circulation: f64,
}

/// Circulation and induced velocities that agree in a wake of one geometry.
#[derive(Debug, Clone, PartialEq)]
pub struct StillWake {
    /// Circulation of a blade.
    pub circulation: CirculationMap,
    /// Induced inflow.
    pub inflow: InflowMap,
    /// Induced velocity in the plane of the disk, from leading to trailing edge.
    pub in_plane: InflowMap,
}

/// What the rotor does in its wake.
#[derive(Debug, Clone, PartialEq)]
pub struct BladeElementSolution {
    /// Circulation of a blade.
    pub circulation: CirculationMap,
    /// Induced inflow at its panels.
    pub inflow: InflowMap,
    /// Induced velocity there in the plane of the disk, from leading to trailing edge.
    pub in_plane: InflowMap,
    /// Thrust of one blade by azimuth, as a thrust coefficient of the rotor divided by the blades.
    pub blade_thrust: Vec<f64>,
    /// Force of one blade against rotation, same unit.
    pub blade_drag: Vec<f64>,
    /// Thrust coefficient of the rotor.
    pub thrust_coefficient: f64,
    /// Torque (and power) coefficient of the rotor.
    pub torque_coefficient: f64,
    /// Updates of the geometry.
    pub updates: usize,
    /// Largest change of the inflow in the last update, tip speed.
    pub inflow_change: f64,
    /// RMS displacement of the wake in every sweep, unit `R`.
    pub history: Vec<f64>,
}

/// When geometry and circulation count as agreed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CouplingSettings {
    /// Largest change of the inflow between updates of the geometry, tip speed.
    pub inflow_tolerance: f64,
    /// Updates allowed.
    pub updates: usize,
    /// Sweeps of the wake per update.
    pub sweeps: usize,
}

impl Default for CouplingSettings {
    fn default() -> Self {
        Self { inflow_tolerance: 1e-4, updates: 40, sweeps: 2 }
    }
}

/// Newton steps for the circulation in a still wake.
const NEWTON_STEPS: usize = 100;
/// Change of the inflow at which they end, tip speed.
const NEWTON_TOLERANCE: f64 = 1e-10;
/// A change of the inflow above this share of the least so far is no gain.
const PAYING: f64 = 0.9;
/// Updates in turn without gain that halve the way of a sweep.
const PATIENCE: usize = 3;
/// Least part of the way.
const LEAST_PART: f64 = 0.125;
/// Step of the angle of attack for slopes, tip speed of inflow.
const SLOPE_STEP: f64 = 1e-6;

impl BladeElementRotor<'_> {
    /// Lifting lines of the flapping blades on a number of azimuths; the wake leaves at the trailing edge.
    pub fn lines(&self, azimuths: usize) -> BladeLines {
        let nodes = self.rotor.nodes();
        BladeLines::deflected(&self.rotor, azimuths, |i, n| {
            let azimuth = TAU * i as f64 / azimuths as f64;
            [nodes[n] * RigidMotion::series(self.motion.flap_rad, azimuth)[0], 0.0]
        })
        .with_trailing_edge(
            |_| 0.75 * self.chord,
            |i, n| self.pitch_rad(TAU * i as f64 / azimuths as f64, nodes[n]),
        )
    }

    /// Pitch of the section at a station, rad.
    fn pitch_rad(&self, azimuth: f64, r: f64) -> f64 {
        let [pitch, _] = RigidMotion::series(self.motion.pitch_rad, azimuth);
        pitch + self.twist_rad * (r - 0.75)
    }

    /// Loads of one panel for an induced inflow.
    fn element(
        &self,
        flight: &FlightState,
        (azimuth, r): (f64, f64),
        [induced, in_plane]: [f64; 2],
    ) -> Element {
        let mu = flight.advance_ratio;
        let [flap, flap_rate] = RigidMotion::series(self.motion.flap_rad, azimuth);
        let theta = self.pitch_rad(azimuth, r);
        let u_t = r + mu * azimuth.sin() + in_plane;
        let u_p = flight.normal_inflow() + induced + r * flap_rate + flap * mu * azimuth.cos();
        let speed = u_t.hypot(u_p);
        let phi = u_p.atan2(u_t);
        let [lift, drag] = self.polar.lift_drag(theta - phi, self.tip_mach * speed);
        let pressure = 0.5 * self.chord * speed * speed;
        let (sin, cos) = phi.sin_cos();
        Element {
            thrust: pressure * (lift * cos - drag * sin),
            drag: pressure * (lift * sin + drag * cos),
            circulation: 0.5 * self.chord * speed * lift,
        }
    }

    /// Circulation that agrees with the inflow it makes in a still wake.
    ///
    /// # Errors
    /// [`WakeError::InflowRunsAway`] if they do not agree after the last step.
    pub fn circulation_in(
        &self,
        flight: &FlightState,
        induction: &LineInduction,
        start: &[f64],
    ) -> Result<StillWake, WakeError> {
        let (azimuths, panels) = (induction.azimuths(), self.rotor.panels());
        let stations = self.rotor.stations();
        let place = |k: usize| (TAU * (k / panels) as f64 / azimuths as f64, stations[k % panels]);
        let gamma =
            |k: usize, induced: [f64; 2]| self.element(flight, place(k), induced).circulation;
        let mut inflow = DVector::from_column_slice(start);
        let mut in_plane = DVector::zeros(start.len());
        let mut change = f64::INFINITY;
        let mut newton = None;
        for iteration in 0..NEWTON_STEPS {
            let induced = |k: usize| [inflow[k], in_plane[k]];
            let values = (0..start.len()).map(|k| gamma(k, induced(k))).collect();
            let circulation = CirculationMap::new(panels, values)?;
            let wanted = induction.inflow(&circulation)?;
            let along = wanted.in_plane_values().unwrap_or_default().to_vec();
            let wanted_in_plane = InflowMap::new(&self.rotor, along)?;
            let moved = wanted.values().iter().zip(&inflow);
            let moved_in_plane = wanted_in_plane.values().iter().zip(&in_plane);
            let size = moved.chain(moved_in_plane).fold(0.0_f64, |m, (w, l)| m.max((w - l).abs()));
            if size <= NEWTON_TOLERANCE {
                return Ok(StillWake { circulation, inflow: wanted, in_plane: wanted_in_plane });
            }
            if iteration == 0 || size > 0.3 * change {
                let slopes = (0..start.len())
                    .map(|k| {
                        let ([l, u], here) = (induced(k), circulation.values()[k]);
                        let down = gamma(k, [l + SLOPE_STEP, u]) - here;
                        let along = gamma(k, [l, u + SLOPE_STEP]) - here;
                        [down / SLOPE_STEP, along / SLOPE_STEP]
                    })
                    .collect();
                newton = Some(LinearisedBlades::new(induction, slopes));
            }
            change = size;
            let state = [&inflow, &in_plane];
            let Some(agreed) = newton.as_ref().and_then(|n| n.agreed(circulation.values(), state))
            else {
                break;
            };
            let [down, along] = induction.matrices().map(|matrix| &matrix * &agreed);
            let (down, along) = (down - &inflow, along - &in_plane);
            let part = (0.05 / down.amax().max(along.amax())).min(1.0);
            inflow += down * part;
            in_plane += along * part;
        }
        let (update, largest) = (NEWTON_STEPS, NEWTON_TOLERANCE);
        Err(WakeError::InflowRunsAway { update, change, largest })
    }

    /// The same at all azimuths of a wake; in an axial one, one azimuth is solved for all.
    fn circulation_of(
        &self,
        wake: &FreeWake,
        induction: &LineInduction,
        start: &[f64],
    ) -> Result<StillWake, WakeError> {
        if wake.settings().symmetry == WakeSymmetry::Periodic {
            return self.circulation_in(wake.flight(), induction, start);
        }
        let (azimuths, panels) = (induction.azimuths(), self.rotor.panels());
        let one = induction.of_one_azimuth();
        let still = self.circulation_in(wake.flight(), &one, &start[..panels])?;
        let repeated = |map: &InflowMap| InflowMap::new(&self.rotor, map.row(0).repeat(azimuths));
        Ok(StillWake {
            circulation: CirculationMap::from_fn(azimuths, panels, |_, s| {
                still.circulation.row(0)[s]
            })?,
            inflow: repeated(&still.inflow)?,
            in_plane: repeated(&still.in_plane)?,
        })
    }

    /// Undistorted wake of a thrust coefficient to start from.
    ///
    /// # Errors
    /// [`WakeError`] of momentum theory (vortex-ring state) and of the settings.
    pub fn starting_wake(
        &self,
        settings: &FreeWakeSettings,
        flight: FlightState,
        thrust_coefficient: f64,
    ) -> Result<FreeWake, WakeError> {
        let inflow = momentum_inflow(&flight, thrust_coefficient)?;
        let [_, cosine, sine] = self.motion.pitch_rad;
        let cyclic = cosine.hypot(sine);
        if settings.symmetry == WakeSymmetry::Axial && cyclic != 0.0 {
            let expected = "0: an axial wake has none";
            return Err(WakeError::BadInput {
                quantity: "cyclic pitch, rad",
                value: cyclic,
                expected,
            });
        }
        let lines = self.lines(settings.azimuths);
        FreeWake::undistorted(self.rotor.clone(), settings.clone(), flight, inflow, lines)
    }

    /// Loads, circulation and free wake that agree with each other.
    ///
    /// The circulation is solved in the still wake, the wake moved by some sweeps with that circulation, and
    /// so on until the inflow stays.
    ///
    /// # Errors
    /// [`WakeError::InflowRunsAway`] after the last update, and the errors of the sweeps; `wake` keeps its last good
    /// geometry.
    pub fn solve(
        &self,
        wake: &mut FreeWake,
        coupling: &CouplingSettings,
    ) -> Result<BladeElementSolution, WakeError> {
        let azimuths = wake.settings().azimuths;
        let size = azimuths * self.rotor.panels();
        let start = CirculationMap::constant(azimuths, self.rotor.panels(), 1e-3)?;
        let mut induction = wake.line_induction(&start)?;
        let mut moving: Option<CirculationMap> = None;
        let mut inflow = vec![wake.carrying_inflow(); size];
        let mut history = Vec::new();
        let mut change = f64::INFINITY;
        let (mut part, mut idle, mut least) = (1.0, 0, f64::INFINITY);
        for update in 1..=coupling.updates {
            let still = self.circulation_of(wake, &induction, &inflow)?;
            let pairs = still.inflow.values().iter().zip(&inflow);
            change = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / part;
            inflow = still.inflow.values().to_vec();
            if update > 1 && change <= coupling.inflow_tolerance {
                return Ok(self.finish(wake.flight(), still, (update, change, history)));
            }
            idle = if change > PAYING * least { idle + 1 } else { 0 };
            if idle == PATIENCE {
                (part, idle) = (f64::max(0.5 * part, LEAST_PART), 0);
            }
            least = least.min(change);
            // half of a change at once: near passages of vortices answer strongly
            let circulation = match &moving {
                Some(before) => still.circulation.mixed(before, 0.5)?,
                None => still.circulation,
            };
            for _ in 0..coupling.sweeps {
                history.push(wake.sweep_in_part(&circulation, part)?);
            }
            induction = wake.line_induction(&circulation)?;
            moving = Some(circulation);
        }
        let (update, largest) = (coupling.updates, coupling.inflow_tolerance);
        Err(WakeError::InflowRunsAway { update, change, largest })
    }

    /// The same with the wake marched in time, revolution by revolution: hover and low speed.
    ///
    /// # Errors
    /// As [`solve`](Self::solve); an update is a revolution.
    pub fn solve_marching(
        &self,
        march: &mut WakeMarch,
        coupling: &CouplingSettings,
    ) -> Result<BladeElementSolution, WakeError> {
        let azimuths = march.wake().settings().azimuths;
        let size = azimuths * self.rotor.panels();
        let start = CirculationMap::constant(azimuths, self.rotor.panels(), 1e-3)?;
        let mut circulation = start;
        let mut inflow = vec![march.wake().carrying_inflow(); size];
        let mut history = Vec::new();
        let mut change = f64::INFINITY;
        for update in 1..=coupling.updates {
            let induction = march.wake().line_induction(&circulation)?;
            let mut still = self.circulation_of(march.wake(), &induction, &inflow)?;
            let pairs = still.inflow.values().iter().zip(&inflow);
            change = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
            inflow = still.inflow.values().to_vec();
            if update > 2 && change <= coupling.inflow_tolerance {
                let flight = *march.wake().flight();
                return Ok(self.finish(&flight, still, (update, change, history)));
            }
            if update > 1 {
                // half of a change at once: the wake answers over several revolutions
                still.circulation = still.circulation.mixed(&circulation, 0.5)?;
            }
            circulation = still.circulation;
            history.extend(march.revolutions(coupling.sweeps, &circulation)?);
        }
        let (update, largest) = (coupling.updates, coupling.inflow_tolerance);
        Err(WakeError::InflowRunsAway { update, change, largest })
    }

    /// Integrates the loads.
    fn finish(
        &self,
        flight: &FlightState,
        still: StillWake,
        (updates, inflow_change, history): (usize, f64, Vec<f64>),
    ) -> BladeElementSolution {
        let StillWake { circulation, inflow, in_plane } = still;
        let azimuths = circulation.azimuths();
        let (stations, widths) = (self.rotor.stations(), self.rotor.widths());
        let (mut thrust, mut drag) = (vec![0.0; azimuths], vec![0.0; azimuths]);
        let mut torque = 0.0;
        for i in 0..azimuths {
            let azimuth = TAU * i as f64 / azimuths as f64;
            for (s, (&r, &dr)) in stations.iter().zip(&widths).enumerate() {
                let induced = [inflow.row(i)[s], in_plane.row(i)[s]];
                let e = self.element(flight, (azimuth, r), induced);
                thrust[i] += e.thrust * dr / std::f64::consts::PI;
                drag[i] += e.drag * dr / std::f64::consts::PI;
                torque += r * e.drag * dr / std::f64::consts::PI / azimuths as f64;
            }
        }
        let blades = self.rotor.blades() as f64;
        let mean = thrust.iter().sum::<f64>() / azimuths as f64;
        BladeElementSolution {
            circulation,
            inflow,
            in_plane,
            blade_thrust: thrust,
            blade_drag: drag,
            thrust_coefficient: blades * mean,
            torque_coefficient: blades * torque,
            updates,
            inflow_change,
            history,
        }
    }
}

impl BladeElementSolution {
    /// Forces of all blades in axes that turn with blade 0, summed blade by blade: `[x outboard, y toward
    /// the leading edge, z]` by azimuth of blade 0, as thrust coefficients.
    pub fn rotating_sums(&self, blades: usize) -> Vec<Vec3> {
        let azimuths = self.blade_thrust.len();
        (0..azimuths)
            .map(|i| {
                let mut sum = [0.0; 3];
                for b in 0..blades {
                    let at = (i + b * azimuths / blades) % azimuths;
                    let (sin, cos) = (TAU * b as f64 / blades as f64).sin_cos();
                    let against = -self.blade_drag[at];
                    sum = [
                        sum[0] - against * sin,
                        sum[1] + against * cos,
                        sum[2] + self.blade_thrust[at],
                    ];
                }
                sum
            })
            .collect()
    }

    /// Figure of merit in hover.
    pub fn figure_of_merit(&self) -> f64 {
        self.thrust_coefficient.max(0.0).powf(1.5)
            / (std::f64::consts::SQRT_2 * self.torque_coefficient)
    }
}

/// Blades, linear about a state, in the wake of one geometry.
#[derive(Debug, Clone)]
struct LinearisedBlades {
    /// `I - diag(dGamma/dlambda) A - diag(dGamma/du_t) B`, factorised.
    matrix: LU<f64, Dyn, Dyn>,
    slopes: Vec<[f64; 2]>,
}

impl LinearisedBlades {
    /// Blades in a wake whose circulation changes by `slopes` per unit of inflow and of velocity along the disk.
    fn new(wake: &LineInduction, slopes: Vec<[f64; 2]>) -> Self {
        let [down, along] = wake.matrices();
        let size = down.nrows();
        let matrix = DMatrix::from_fn(size, size, |k, j| {
            let own = if k == j { 1.0 } else { 0.0 };
            own - slopes[k][0] * down[(k, j)] - slopes[k][1] * along[(k, j)]
        });
        Self { matrix: matrix.lu(), slopes }
    }

    /// The circulation that agrees with what it induces: where it is `circulation` at a state of inflow and velocity along
    /// the disk.
    fn agreed(
        &self,
        circulation: &[f64],
        [inflow, in_plane]: [&DVector<f64>; 2],
    ) -> Option<DVector<f64>> {
        let at_rest = DVector::from_fn(circulation.len(), |k, _| {
            let [down, along] = self.slopes[k];
            circulation[k] - down * inflow[k] - along * in_plane[k]
        });
        self.matrix.solve(&at_rest)
    }
}
