//! Fourier collocation: modal series in, residual series and root loads out.

use super::airload::{Air, Deflected, FlapSection, Section};
use super::blade::{Airloads, Blade, Couplings};
use super::fourier::Fourier;
use super::hub::Root;
use super::inflow::{Shape, drees};
use super::kinematics::Snapshot;
use super::lag::LagState;
use super::modes::Modes;
use super::residual::{Acting, equations};
use super::span::Span;
use crate::error::RotorTruthError;

/// How finely a rotor is resolved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolution {
    /// Highest harmonic of the motion.
    pub harmonics: usize,
    /// Azimuths, a multiple of the number of blades and even.
    pub azimuths: usize,
    /// Gauss points of a segment of the span.
    pub points: usize,
    /// Longest segment, R.
    pub segment: f64,
}

impl Default for Resolution {
    fn default() -> Self {
        Self { harmonics: 10, azimuths: 48, points: 5, segment: 0.2 }
    }
}

/// A blade made ready: stations, modes, sections.
#[derive(Debug, Clone)]
pub struct Elastic {
    /// The blade.
    pub blade: Blade,
    /// Stations.
    pub span: Span,
    /// Modes.
    pub modes: Modes,
    /// Azimuths and harmonics.
    pub fourier: Fourier,
    section: Section,
    flaps: Vec<FlapSection>,
    /// Flap by station.
    flap_at: Vec<Option<usize>>,
    /// First station with airloads.
    first: usize,
}

/// Air and flaps at a condition.
#[derive(Debug, Clone)]
pub struct Flow {
    /// Advance ratio in the plane of the disk.
    pub mu: f64,
    /// Shaft tilt, forward positive, rad.
    pub tilt_rad: f64,
    /// Shape of the induced inflow.
    pub shape: Shape,
    /// Further downwash by station and azimuth; empty if none.
    pub further: Vec<Vec<f64>>,
    /// Lags of circulation with their shares, and that of separation.
    lags: Vec<(f64, LagState)>,
    separation: Option<LagState>,
}

/// Angle of every flap with two derivatives, by azimuth.
pub type FlapAngles = Vec<Vec<[f64; 3]>>;

/// What the collocation gives.
#[derive(Debug, Clone)]
pub struct Evaluation {
    /// Series of the modal residuals, mode by mode.
    pub residual: Vec<f64>,
    /// Loads at the root by azimuth.
    pub root: Vec<Root>,
}

/// Motion and air of one azimuth.
struct At {
    q: Vec<[f64; 3]>,
    snapshot: Snapshot,
    theta: Vec<[f64; 3]>,
    air: Vec<Air>,
}

impl Elastic {
    /// A blade at a resolution.
    ///
    /// # Errors
    /// [`RotorTruthError::Modes`].
    pub fn new(blade: Blade, resolution: Resolution) -> Result<Self, RotorTruthError> {
        let mut edges = vec![blade.cutout];
        edges.extend(blade.flaps.iter().flat_map(|own| [own.start, own.end]));
        let span = Span::new(&edges, resolution.points, resolution.segment);
        let modes = Modes::of(&blade, &span)?;
        let flap_at = span
            .x
            .iter()
            .map(|x| blade.flaps.iter().position(|own| own.start < *x && *x < own.end))
            .collect();
        let flaps = blade.flaps.iter().map(|own| FlapSection::new(&blade, own)).collect();
        let first = span.x.iter().position(|x| *x > blade.cutout).unwrap_or(0);
        let fourier = Fourier::new(resolution.harmonics, resolution.azimuths);
        let section = Section::new(&blade);
        Ok(Self { blade, span, modes, fourier, section, flaps, flap_at, first })
    }

    /// Number of unknowns of the motion.
    pub fn size(&self) -> usize {
        self.modes.len() * self.fourier.size()
    }

    /// Angles of flaps at rest.
    pub fn flaps_at_rest(&self) -> FlapAngles {
        vec![vec![[0.0; 3]; self.fourier.azimuths]; self.blade.flaps.len()]
    }

    /// Air at a condition.
    ///
    /// # Errors
    /// [`RotorTruthError::Singular`] of the lags.
    pub fn flow(
        &self,
        mu: f64,
        tilt_rad: f64,
        shape: Shape,
        further: Vec<Vec<f64>>,
    ) -> Result<Flow, RotorTruthError> {
        let b = 0.5 * self.blade.chord;
        let still: Vec<Vec<f64>> = self.span.x[self.first..]
            .iter()
            .map(|x| {
                (0..self.fourier.azimuths)
                    .map(|k| {
                        let u = x + mu * self.fourier.azimuth(k).sin();
                        self.section.beta_squared(u) * u.abs() / b
                    })
                    .collect()
            })
            .collect();
        let mut lags = Vec::new();
        if let Airloads::Unsteady(own) = self.blade.airloads {
            for (share, rate) in own.constants() {
                lags.push((share, LagState::new(&self.fourier, rate, &still)?));
            }
        }
        let separation = match self.blade.stall {
            Some(own) => Some(LagState::new(&self.fourier, own.rate, &still)?),
            None => None,
        };
        Ok(Flow { mu, tilt_rad, shape, further, lags, separation })
    }

    /// Motion and air at an azimuth.
    fn at(&self, series: &[f64], controls: [f64; 3], lambda_i: f64, flow: &Flow, k: usize) -> At {
        let size = self.fourier.size();
        let q: Vec<[f64; 3]> =
            series.chunks_exact(size).map(|own| self.fourier.at(own, k)).collect();
        let s = Snapshot::new(&self.modes, &self.span, &q);
        let (sin, cos) = self.fourier.azimuth(k).sin_cos();
        let [t0, t1c, t1s] = controls;
        let pitch = [t0 + t1c * cos + t1s * sin, t1s * cos - t1c * sin, -t1c * cos - t1s * sin];
        let (along, across) = (flow.mu * cos, flow.mu * sin);
        let free = flow.mu * flow.tilt_rad.tan();
        let (k_x, k_y) = drees(flow.mu, free + lambda_i);
        let cone = self.blade.precone_rad;
        let (mut theta, mut air) = (Vec::new(), Vec::new());
        for (p, x) in self.span.x.iter().enumerate() {
            let twist = self.blade.twist_rad * (x - 0.75);
            let own = [
                pitch[0] + twist + s.phi.value[p],
                pitch[1] + s.phi.rate[p],
                pitch[2] + s.phi.acceleration[p],
            ];
            theta.push(own);
            let share = match &flow.shape {
                Shape::Uniform => 1.0,
                Shape::Drees => 1.0 + x * (k_x * cos + k_y * sin),
                Shape::Map(map) => map[p][k],
            };
            let further = flow.further.get(p).map_or(0.0, |row| row[k]);
            let lambda = free + lambda_i * share + further;
            let slope = s.w.slope[p] + cone;
            let (shorter, nearer) = if self.blade.couplings == Couplings::Third {
                (s.u[0][p] + s.v.value[p] * s.v.slope[p], s.w.slope[p] * s.v.value[p])
            } else {
                (0.0, 0.0)
            };
            // it crosses the chord the more, the further aft
            let wrung = if self.blade.has_twisted_flow {
                along * (self.blade.twist_rad + s.phi.slope[p])
            } else {
                0.0
            };
            air.push(Air {
                u_t: x + across + s.v.rate[p] + s.v.slope[p] * along + shorter,
                u_p: lambda + s.w.rate[p] + slope * along + nearer,
                u_p_rate: s.w.acceleration[p] + s.w.slope_rate[p] * along - slope * across,
                along,
                theta: own,
                turn: own[1] + slope + wrung,
            });
        }
        At { q, snapshot: s, theta, air }
    }

    fn flap<'a>(&'a self, p: usize, k: usize, angles: &FlapAngles) -> Deflected<'a> {
        self.flap_at[p].map(|flap| (&self.flaps[flap], angles[flap][k]))
    }

    /// Residuals and root loads of a motion; `series` holds `1, cos, sin, cos 2, ...` of mode after mode.
    pub fn evaluate(
        &self,
        series: &[f64],
        controls: [f64; 3],
        lambda_i: f64,
        (flow, angles): (&Flow, &FlapAngles),
    ) -> Evaluation {
        let azimuths = self.fourier.azimuths;
        let moments: Vec<At> =
            (0..azimuths).map(|k| self.at(series, controls, lambda_i, flow, k)).collect();
        let mut acting: Vec<Vec<Acting>> = moments
            .iter()
            .map(|at| {
                at.theta.iter().map(|own| Acting { theta: *own, ..Acting::default() }).collect()
            })
            .collect();
        for p in 0..self.span.len() {
            if p >= self.first {
                self.load_station(p, &moments, (flow, angles), &mut acting);
            }
            for (k, row) in acting.iter_mut().enumerate() {
                if let Some((own, [d, _, acceleration])) = self.flap(p, k, angles) {
                    let moment = -own.inertia * acceleration - own.spring * d;
                    row[p].flap = [own.static_moment * acceleration, moment];
                }
            }
        }
        let size = self.fourier.size();
        let mut residual = vec![0.0; self.size()];
        let mut root = Vec::with_capacity(azimuths);
        for (k, at) in moments.iter().enumerate() {
            let (values, own) =
                equations(&self.blade, &self.span, &self.modes, &at.q, &at.snapshot, &acting[k]);
            root.push(own);
            for (value, row) in values.iter().zip(residual.chunks_exact_mut(size)) {
                self.fourier.project(*value, k, row);
            }
        }
        Evaluation { residual, root }
    }

    /// Airloads of a station over the revolution.
    fn load_station(
        &self,
        p: usize,
        moments: &[At],
        (flow, angles): (&Flow, &FlapAngles),
        acting: &mut [Vec<Acting>],
    ) {
        let flap = |k: usize| self.flap(p, k, angles);
        let q: Vec<f64> = moments
            .iter()
            .enumerate()
            .map(|(k, at)| self.section.downwash(&at.air[p], flap(k)))
            .collect();
        let b = 0.5 * self.blade.chord;
        let speed: Vec<f64> = moments
            .iter()
            .map(|at| self.section.beta_squared(at.air[p].u_t) * at.air[p].u_t.abs() / b)
            .collect();
        let mut followed = q.clone();
        for (share, lag) in &flow.lags {
            let state = lag.follow(p - self.first, &speed, &q);
            for ((own, x), q) in followed.iter_mut().zip(&state).zip(&q) {
                *own += share * (x - q);
            }
        }
        let attached = flow.separation.as_ref().map(|lag| {
            let forcing: Vec<f64> = moments
                .iter()
                .zip(&followed)
                .map(|(at, q)| self.section.attached(at.air[p].u_t, *q))
                .collect();
            lag.follow(p - self.first, &speed, &forcing)
        });
        for (k, at) in moments.iter().enumerate() {
            let share = attached.as_ref().map_or(1.0, |own| own[k].clamp(0.0, 1.0));
            acting[k][p].air = self.section.loads(&at.air[p], flap(k), followed[k], share);
        }
    }
}
