//! Dynamic stall of one station, made periodic by marching.
//!
//! Under a given motion the states of the stall are a cascade without feedback: the attached normal
//! force drives the delayed one, that the separation, that the vortex. Every state forgets its past over
//! a few semichords, and a revolution is a hundred or more long: marched from the static stall of its last
//! point a section comes back to itself to rounding in two to four revolutions. Inside the search for the
//! blade's motion the periodic stall is therefore a function of the motion, as the lags are.
//!
//! The march steps from azimuth point to azimuth point, in each of which the drives run straight: second
//! order in the step.

use crate::ResponseError;
use crate::sections::air::{PromptCoefficients, SectionFlow, SectionPast, dot};
use flap_aero::{AeroError, StallSection, StallState, StalledLoads};

/// Revolutions a section is given to come back to itself.
const MOST_REVOLUTIONS: usize = 40;
/// Change of a coefficient from revolution to revolution that counts as none.
const REPEATED: f64 = 1e-13;
/// Slowest flow, tip speed, that angles are formed with.
const SLOWEST_FLOW: f64 = 0.02;

/// The stall of one station over the revolution.
#[derive(Debug, Clone)]
pub(crate) struct StallHistory {
    station: f64,
    semichord: f64,
    /// The section at every point.
    sections: Vec<StallSection>,
    /// Semichords travelled from the point before to each point.
    steps: Vec<f64>,
    /// Whether tables hold the static stall.
    over_tables: bool,
}

/// The attached loads `[Cn, Cm, Ch]` and angles of a section, on the whole speed of its flow.
struct Drive {
    attached: [f64; 3],
    modes: [f64; 4],
}

impl StallHistory {
    /// `speeds` are the tangential speeds of the rigid blade at the azimuth `points`.
    pub(crate) fn new(
        station: f64,
        semichord: f64,
        sections: Vec<StallSection>,
        points: &[f64],
        speeds: &[f64],
        over_tables: bool,
    ) -> Self {
        let n = points.len();
        let steps = (0..n)
            .map(|p| {
                let before = (p + n - 1) % n;
                let angle = (points[p] - points[before]).rem_euclid(std::f64::consts::TAU);
                0.5 * (speeds[p] + speeds[before]) * angle / semichord
            })
            .collect();
        Self { station, semichord, sections, steps, over_tables }
    }

    fn drive(&self, flow: &SectionFlow, c: &PromptCoefficients, past: &SectionPast) -> Drive {
        let inverse = flow.u_t.hypot(flow.u_p).max(SLOWEST_FLOW).recip();
        let attached = [0, 1, 2].map(|o| {
            let circulating = dot(&c.direct[o], &flow.input) + past.lag[o];
            let apparent = c.apparent(o, flow);
            (flow.u_t.abs() * circulating + self.semichord * apparent) * inverse * inverse
        });
        Drive { attached, modes: flow.input.map(|w| w * inverse) }
    }

    /// What stall adds to the loads of a state.
    fn added(&self, point: usize, loads: &StalledLoads, state: &StallState, d: &Drive) -> [f64; 3] {
        let section = &self.sections[point];
        let held = if self.over_tables {
            state.without_delay(section, d.attached)
        } else {
            state.without_stall(section, d.attached)
        };
        [loads.normal - held.normal, loads.chord - held.chord, loads.moment - held.moment]
    }

    /// The same with everything held for ever at one point.
    pub(crate) fn settled(
        &self,
        point: usize,
        flow: &SectionFlow,
        coefficients: &PromptCoefficients,
        past: &SectionPast,
    ) -> [f64; 3] {
        if self.over_tables {
            return [0.0; 3];
        }
        let drive = self.drive(flow, coefficients, past);
        let section = &self.sections[point];
        let state = StallState::settled(section, drive.attached[0], &drive.modes);
        self.added(point, &state.without_delay(section, drive.attached), &state, &drive)
    }

    /// Writes the periodic stall of a motion into the past of every point.
    ///
    /// # Errors
    /// [`ResponseError::StallNotPeriodic`]. A motion that is not finite gives a stall that is not.
    pub(crate) fn fill(
        &self,
        flow: impl Fn(usize) -> (SectionFlow, PromptCoefficients),
        pasts: &mut [SectionPast],
    ) -> Result<(), ResponseError> {
        let drives: Vec<Drive> = pasts
            .iter()
            .enumerate()
            .map(|(p, past)| {
                let (flow, coefficients) = flow(p);
                self.drive(&flow, &coefficients, past)
            })
            .collect();
        let (Some(last), Some(section)) = (drives.last(), self.sections.last()) else {
            return Ok(());
        };
        let mut state = StallState::settled(section, last.attached[0], &last.modes);
        let mut change = f64::INFINITY;
        for _ in 0..MOST_REVOLUTIONS {
            let Ok(marched) = self.march(&mut state, &drives, pasts) else {
                // the search for the motion sees it and turns back
                for past in pasts {
                    past.stall = [f64::NAN; 3];
                }
                return Ok(());
            };
            change = marched;
            if change <= REPEATED {
                return Ok(());
            }
        }
        Err(ResponseError::StallNotPeriodic {
            station: self.station,
            revolutions: MOST_REVOLUTIONS,
            change,
            tolerance: REPEATED,
        })
    }

    /// One revolution; the largest change of a coefficient.
    fn march(
        &self,
        state: &mut StallState,
        drives: &[Drive],
        pasts: &mut [SectionPast],
    ) -> Result<f64, AeroError> {
        let mut change = 0.0_f64;
        for (p, (drive, past)) in drives.iter().zip(pasts).enumerate() {
            let loads =
                state.step(&self.sections[p], drive.attached, &drive.modes, self.steps[p])?;
            let stall = self.added(p, &loads, state, drive);
            for (new, old) in stall.iter().zip(past.stall) {
                change = change.max((new - old).abs());
            }
            past.stall = stall;
        }
        Ok(change)
    }
}
