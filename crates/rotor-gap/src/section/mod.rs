//! Loads of an oscillating section: harmonics or loops.
//!
//! | idea | module |
//! |---|---|
//! | what was measured | `loops` |
//! | the cause library: what the simulation of a section may lack | `causes` |
//! | a diagnosis | here |

mod causes;
mod loops;

pub use causes::{SECTION_LIBRARY, SectionCause};
pub use loops::{LOADS, LoadPart, SectionLoads, SectionMotion};

use crate::diagnosis::{CaseDiagnosis, CaseQuestion};
use crate::error::RotorGapError;
use crate::rotor::moved_inputs;
use flap_aero::{
    AeroError, AttachedFlowModel, FlapEffectiveness, Motion, ResponseParts, StallAirfoil,
};
use model_gap::points::{Grid, Instrument, KindFinding, KindQuestion, PointKind, channels_of};
use nalgebra::Complex;
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_case::{Case, CompressibilityChoice, EffectivenessValues};
use section_study::{LoopQuestion, SectionChoice, loop_history, section_response};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Rows of a cycle of a loop.
const POINTS: usize = 72;
/// Harmonics that a cycle is resolved in.
const RESOLVED: usize = 12;
/// Calibration of pressures from one session to the next, standard deviation of the gain.
const GAIN: f64 = 0.01;
/// What reads the pitch, and the standard deviation of its gain. A flap that is read wrongly is a weak one.
const PITCH_MOTION: &str = "pitch motion";
const PITCH_GAIN: f64 = 0.01;
/// What reads the loads: they are integrals of the same pressures, so that one gain is that of all.
const PRESSURES: &str = "pressures";

/// A section as simulated.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionModel {
    /// Section model.
    pub attached: AttachedFlowModel,
    /// Flap chord over chord.
    pub flap_chord: f64,
    /// Whether the hinge moment is read.
    pub has_hinge: bool,
    /// Lift, moment and hinge moment of the flap over thin-aerofoil theory.
    pub effectiveness: [f64; 3],
    /// Mach number of the sections over that of the flow: 0 of incompressible ones.
    pub mach_share: f64,
    /// What the lags take off over what they do in theory: 0 of a quasi-steady section.
    pub lag_share: f64,
    /// Apparent mass over that of theory: 0 of a quasi-steady section.
    pub mass_share: f64,
    /// How the section stalls; none of attached flow.
    pub stall: Option<StallAirfoil>,
    /// Incidence by which an attached section stalls later than the constants of a stall say, rad; none of attached flow.
    pub stalls_later_rad: Option<f64>,
    /// Position of the pitch axis, chords behind the quarter chord.
    pub axis_aft: f64,
    /// How far the axis plunges, up, under the normal force, semichords per `cn`; 0 of a rigid one.
    pub give: f64,
    /// Delay of the loads against the motion, s.
    pub delay_s: f64,
    /// Gains of instruments that are off, by their names.
    pub gains: BTreeMap<String, f64>,
}

impl SectionModel {
    /// The section of a case: its model, its first flap, whether it is compressible and stalls.
    pub fn of(case: &Case, has_hinge: bool) -> Self {
        let flap = case.flaps.first();
        let factors = flap.map_or_else(EffectivenessValues::default, |own| own.effectiveness);
        let is_compressible = case.aerodynamics.compressibility == CompressibilityChoice::LocalMach
            && case.aerodynamics.model != AttachedFlowModel::Incompressible;
        let unsteady =
            f64::from(u8::from(case.aerodynamics.model != AttachedFlowModel::QuasiSteady));
        Self {
            attached: case.aerodynamics.model,
            flap_chord: flap.map_or(0.0, |own| own.chord_fraction),
            has_hinge,
            effectiveness: [factors.lift, factors.moment, factors.hinge],
            mach_share: f64::from(u8::from(is_compressible)),
            lag_share: unsteady,
            mass_share: unsteady,
            stall: case.aerodynamics.dynamic_stall.airfoil(),
            stalls_later_rad: None,
            axis_aft: 0.0,
            give: 0.0,
            delay_s: 0.0,
            gains: BTreeMap::new(),
        }
    }

    fn choice(&self, model: AttachedFlowModel, mach: f64) -> Result<SectionChoice, AeroError> {
        let [lift, moment, hinge] = self.effectiveness;
        let effectiveness = FlapEffectiveness::new(lift, moment, hinge)?;
        let mach = mach * self.mach_share;
        Ok(SectionChoice { model, mach, flap_chord: self.flap_chord, effectiveness })
    }

    /// Loads of a motion, each over the phase of the motion and over its amplitude, but for the mean.
    fn loads(&self, motion: &SectionMotion) -> Result<[HarmonicSeries; 3], AeroError> {
        let (mach, k) = (motion.mach, motion.reduced_frequency);
        let stall = match self.stalls_later_rad {
            Some(later_rad) => Some((causes::STALL, later_rad)),
            None => self.stall.map(|own| (own, 0.0)),
        };
        let mut loads = cycle(&self.choice(self.attached, mach)?, motion, stall)?;
        let more = self.more_unsteady(motion.motion, mach, k)?;
        add(&mut loads, 1, more);
        if self.axis_aft != 0.0 && motion.motion == Motion::Pitch {
            // the quarter chord rises by the arm
            let velocity = Complex::new(0.0, -2.0 * k * self.axis_aft);
            add(&mut loads, 1, self.of_plunge(mach, k)?.map(|own| own * velocity));
        }
        if self.give != 0.0 {
            for n in 1..=RESOLVED {
                let given = self.given(mach, n as f64 * k, complex(&loads[0], n))?;
                add(&mut loads, n, given);
            }
        }
        Ok(loads)
    }

    /// What lag and apparent mass add to the response of the section model, where they are not its own.
    fn more_unsteady(&self, motion: Motion, mach: f64, k: f64) -> Result<Loads, AeroError> {
        let own = f64::from(u8::from(self.attached != AttachedFlowModel::QuasiSteady));
        let [lag, mass] = [self.lag_share - own, self.mass_share - own];
        if lag == 0.0 && mass == 0.0 {
            return Ok(Loads::default());
        }
        let parts = |model| -> Result<ResponseParts, AeroError> {
            let (coefficients, ..) = self.choice(model, mach)?.coefficients()?;
            Ok(ResponseParts::of(&coefficients, k, motion))
        };
        if self.attached != AttachedFlowModel::QuasiSteady {
            let of = parts(self.attached)?;
            return Ok(std::array::from_fn(|n| lag * of.lag[n] + mass * of.apparent_mass[n]));
        }
        // the quasi-steady model has a part of the apparent mass in its rate terms
        let (of, at_once) = (parts(AttachedFlowModel::Calibrated)?, parts(self.attached)?.loads());
        let all = of.loads();
        Ok(std::array::from_fn(|n| lag * of.lag[n] + mass * (all[n] - of.lag[n] - at_once[n])))
    }

    /// Loads of a plunge velocity over that of the flow of 1, in attached flow.
    fn of_plunge(&self, mach: f64, k: f64) -> Result<Loads, AeroError> {
        let found = section_response(&self.choice(self.attached, mach)?, Motion::Plunge, k)?;
        let more = self.more_unsteady(Motion::Plunge, mach, k)?;
        let own = [found.cn, found.cm, found.ch].map(|[re, im]| Complex::new(re, im));
        Ok(std::array::from_fn(|n| own[n] + more[n]))
    }

    /// Loads of an axis that plunges with the normal force `held`, by `h = -give cn` in semichords, down positive. The
    /// plunge velocity over that of the flow is `i k h`, so that `cn = held / (1 + i k give G)` with `G` the normal force of
    /// a unit plunge velocity.
    fn given(&self, mach: f64, k: f64, held: Complex<f64>) -> Result<Loads, AeroError> {
        let of_plunge = self.of_plunge(mach, k)?;
        let per_cn = Complex::new(0.0, -k * self.give);
        let velocity = per_cn * held / (1.0 - per_cn * of_plunge[0]);
        Ok(of_plunge.map(|own| own * velocity))
    }
}

/// Complex amplitudes of `cn`, `cm` and `ch` over a sine.
type Loads = [Complex<f64>; 3];

/// A harmonic over a sine.
fn complex(series: &HarmonicSeries, n: usize) -> Complex<f64> {
    let own = series.harmonic(n);
    Complex::new(own.sine, own.cosine)
}

/// Adds complex amplitudes to a harmonic.
fn add(loads: &mut [HarmonicSeries; 3], n: usize, more: Loads) {
    for (series, more) in loads.iter_mut().zip(more) {
        let own = complex(series, n) + more;
        series.set_harmonic(n, Harmonic { cosine: own.im, sine: own.re });
    }
}

/// Loads of one cycle, over the amplitude but for the mean.
fn cycle(
    section: &SectionChoice,
    motion: &SectionMotion,
    stall: Option<(StallAirfoil, f64)>,
) -> Result<[HarmonicSeries; 3], AeroError> {
    let k = motion.reduced_frequency;
    let Some(amplitude_rad) = motion.amplitude_rad else {
        let found = section_response(section, motion.motion, k)?;
        let series = |[re, im]: [f64; 2]| {
            let mut own = HarmonicSeries::zero(1);
            own.set_harmonic(1, Harmonic { cosine: im, sine: re });
            own
        };
        return Ok([found.cn, found.cm, found.ch].map(series));
    };
    let table = loop_history(&LoopQuestion {
        section: *section,
        motion: motion.motion,
        mean_rad: motion.mean_rad,
        amplitude_rad,
        reduced_frequency: k,
        points: POINTS,
        stall: stall.map(|own| own.0),
        stalls_later_rad: stall.map_or(0.0, |own| own.1),
    })?;
    // rows are at 5, 10, ... 360 deg: the last is the first of a cycle
    let last = table.rows.len() - 1;
    let rows: Vec<&Vec<f64>> =
        std::iter::once(last).chain(0..last).map(|k| &table.rows[k]).collect();
    Ok(std::array::from_fn(|load| {
        let values: Vec<f64> = rows.iter().map(|row| row[3 + load]).collect();
        let series = HarmonicSeries::from_uniform_samples(&values, RESOLVED).unwrap_or_default();
        HarmonicSeries { mean: series.mean, ..rotor_study::scaled(&series, 1.0 / amplitude_rad) }
    }))
}

/// The motions that were measured, of any section.
struct Motions<'a> {
    measured: &'a SectionLoads,
}

impl PointKind for Motions<'_> {
    type Model = SectionModel;
    type Error = RotorGapError;

    fn read(&self, model: &SectionModel) -> Result<Grid, RotorGapError> {
        let gain_of = |name: &str| model.gains.get(name).copied().unwrap_or(1.0);
        let of = |motion: &SectionMotion| {
            // loads are over the motion as read, but for their mean
            let moves_flap = motion.motion == Motion::Flap;
            let moved = if moves_flap { 1.0 } else { gain_of(PITCH_MOTION) };
            let gain = gain_of(PRESSURES);
            let failed = |source| RotorGapError::Section { point: motion.id.clone(), source };
            let loads = model.loads(motion).map_err(failed)?;
            let late_rad = motion.frequency_hz.map_or(0.0, |hz| TAU * hz * model.delay_s);
            let loads = loads.map(|own| own.shifted(-late_rad));
            let part = |own: &LoadPart| {
                let series = &loads[own.load];
                let value = match (own.harmonic, own.is_imaginary) {
                    (0, _) => series.mean,
                    (n, false) => series.harmonic(n).sine,
                    (n, true) => series.harmonic(n).cosine,
                };
                if own.harmonic == 0 { gain * value } else { gain * value / moved }
            };
            Ok(self.measured.parts.iter().map(part).collect())
        };
        self.measured.motions.par_iter().map(of).collect()
    }
}

/// Diagnoses the loads of an oscillating section.
///
/// # Errors
/// [`RotorGapError`]: a motion outside the section model, the engine.
pub fn diagnose_section(
    question: &CaseQuestion<'_>,
    measured: &SectionLoads,
) -> Result<CaseDiagnosis, RotorGapError> {
    let has_hinge = measured.parts.iter().any(|own| own.load == 2);
    let model = SectionModel::of(question.case, has_hinge);
    let mut instruments = vec![PRESSURES.to_owned()];
    if measured.motions.iter().any(|own| own.motion != Motion::Flap) {
        instruments.push(PITCH_MOTION.to_owned());
    }
    let kind = Motions { measured };
    let names: Vec<&str> = measured.names.iter().map(String::as_str).collect();
    let (mut channels, _) = channels_of(&names);
    for own in &mut channels {
        own.instrument = 0;
    }
    let causes = causes::library(&causes::Occasion {
        model: &model,
        has_flap: measured.motions.iter().any(|own| own.motion == Motion::Flap),
        has_frequencies: measured.motions.windows(2).any(|pair| {
            let [a, b] = [&pair[0], &pair[1]].map(|own| own.reduced_frequency);
            (a - b).abs() > 0.05 * a.max(b)
        }),
        has_frequency: measured.motions.iter().all(|own| own.frequency_hz.is_some()),
        highest: measured
            .motions
            .iter()
            .map(|own| (own.highest_deg(), own.mach))
            .fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a }),
        instruments: &instruments,
    });
    // the calibrated model is fitted to exact linear theory, which no other one here comes nearer to
    let with = |attached| ("calibrated sections", SectionModel { attached, ..model.clone() });
    let is_calibrated = model.attached == AttachedFlowModel::Calibrated;
    let alternatives =
        if is_calibrated { Vec::new() } else { vec![with(AttachedFlowModel::Calibrated)] };
    let asked = KindQuestion {
        kind: &kind,
        model: &model,
        causes: &causes,
        alternatives,
        uncertain: instruments.len() - 1,
        with_inputs: &|by: &[f64]| {
            let mut own = model.clone();
            for (name, by) in instruments[1..].iter().zip(by) {
                own.gains.insert(name.clone(), 1.0 + PITCH_GAIN * by);
            }
            Ok(own)
        },
        channels,
        instruments: vec![Instrument { name: PRESSURES.to_owned(), gain: GAIN, zero: 0.0 }],
        conditions: vec!["mach".to_owned(), "reduced_frequency".to_owned()],
        points: &|predicted| measured.points(predicted),
        knows_deviations: measured.knows_deviations(),
        only: question.only,
        begun: question.begun,
    };
    let KindFinding { table, found, alternatives, inputs, extended } = asked.answer()?;
    let mut case = question.case.clone();
    if let Some(flap) = case.flaps.first_mut() {
        let [lift, moment, hinge] = extended.effectiveness;
        flap.effectiveness = EffectivenessValues { lift, moment, hinge };
    }
    let extended = (case != *question.case).then_some(case);
    let moved = moved_inputs(instruments[1..].iter().map(String::as_str), &inputs);
    Ok(CaseDiagnosis { table, found, alternatives, moved, extended })
}
