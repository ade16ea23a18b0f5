//! A diagnosis: what the simulation of a rotor lacks, from points of test.

use crate::error::RotorGapError;
use crate::rotor::causes::{Occasion, RotorCause, library};
use crate::rotor::feedback::{WonBack, won_back};
use crate::rotor::flight::{Actuators, Flown, amplitude};
use crate::rotor::model::RotorModel;
use crate::rotor::spread::{alternatives, moved_inputs, stated, with_inputs};
use crate::rotor::sweep::{ASIDE, Aside, Sweep, SweepChannel, SweepPoint, instrumented};
use measured_data::Scatter;
use model_gap::discovery::Verdict;
use model_gap::points::{
    Channel, Grid, Instrument, KindFinding, KindQuestion, Point, PointFinding, PointKind,
    PointTable,
};
use preisach_dyn::ActuatorModel;
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_case::{Case, UncertainField};
use rotor_study::{FlapDrive, StudyError};
use std::sync::Arc;

/// Parts of the difference between the actuators that the lag is listed at.
const LAG_PARTS: usize = 9;
/// Part of the difference between the actuators by which hysteresis that was found may differ from that at hand.
const AT_HAND: f64 = 0.25;
/// Calibration of an instrument from one session to the next, standard deviation of its gain.
const GAIN: f64 = 0.005;

/// What is asked of a sweep.
pub struct RotorQuestion<'a> {
    /// The simulation.
    pub case: &'a Case,
    /// The actuator of the case; none of an ideal one.
    pub actuator: Option<Arc<ActuatorModel>>,
    /// An actuator with hysteresis that an ideal one may lack.
    pub hysteretic: Option<Arc<ActuatorModel>>,
    /// Inputs of the case that are not known well.
    pub uncertain: &'a [UncertainField],
    /// What was measured.
    pub sweep: &'a Sweep,
    /// Causes to fit, nothing refused; all are looked for where there is none.
    pub only: &'a [String],
    /// Hears what is begun, and the percent of the work done by then.
    pub begun: &'a (dyn Fn(usize, &str) + Sync),
}

/// What was found of a rotor.
#[derive(Debug, Clone)]
pub struct RotorDiagnosis {
    /// The points with what the simulation says of them.
    pub table: PointTable,
    /// What was found there.
    pub found: PointFinding,
    /// The causes, in the order of the suspects.
    pub causes: Vec<RotorCause>,
    /// Points that no trim reaches.
    pub aside: Vec<Aside>,
    /// Names of the other levels of fidelity.
    pub alternatives: Vec<&'static str>,
    /// What uncertain inputs were moved by to explain the points, in words; none where they were not.
    pub moved: Option<String>,
    /// The case with what was found, if any of it is in a case.
    pub extended: Option<Case>,
    /// What control reaches with hysteresis like that of the actuator at hand, where it was named.
    pub won_back: Vec<WonBack>,
}

impl RotorDiagnosis {
    /// What a reader should know: inputs taken for uncertain, and where that is said; other levels of fidelity; points set
    /// aside.
    pub fn notes(&self, uncertain: &[UncertainField], from: &str) -> Vec<String> {
        let mut notes = vec![stated(uncertain, from)];
        notes.extend(self.moved.clone());
        if !self.alternatives.is_empty() {
            notes.push(format!("as good: {}", self.alternatives.join(", ")));
        }
        let aside = self.aside.iter();
        notes.extend(aside.map(|own| format!("point {} is {ASIDE}: {}", own.point, own.reason)));
        notes
    }
}

/// Points of test of a rotor, flown.
struct Flights<'a> {
    question: &'a RotorQuestion<'a>,
    model: RotorModel,
    actuators: Actuators,
    /// Numbers of the points that are flown.
    points: Vec<usize>,
    flown: Vec<Flown>,
    named: Vec<Channel>,
    instruments: Vec<String>,
}

/// Diagnoses a sweep.
///
/// # Errors
/// [`RotorGapError`]: no point can be flown, an uncertain field that is none, the engine.
pub fn diagnose(question: &RotorQuestion<'_>) -> Result<RotorDiagnosis, RotorGapError> {
    let RotorQuestion { case, sweep, uncertain, .. } = question;
    (question.begun)(0, "the simulation at every point");
    let (flights, aside) = Flights::of(question)?;
    let causes = flights.causes();
    let with_case = |case| RotorModel { case, ..flights.model.clone() };
    let with_inputs = |by: &[f64]| with_inputs(case, uncertain, by).map(with_case);
    let instrument = |name: &String| Instrument { name: name.clone(), gain: GAIN, zero: 0.0 };
    let asked = KindQuestion {
        kind: &flights,
        model: &flights.model,
        causes: &causes,
        alternatives: alternatives(case)
            .into_iter()
            .map(|(name, own)| (name, with_case(own)))
            .collect(),
        uncertain: uncertain.len(),
        with_inputs: &with_inputs,
        channels: flights.named.clone(),
        instruments: flights.instruments.iter().map(instrument).collect(),
        conditions: sweep.conditions.iter().map(|(name, _)| name.clone()).collect(),
        points: &|predicted| flights.measured(predicted),
        knows_deviations: sweep.channels.iter().all(|own| own.scatter != Scatter::Unknown),
        only: question.only,
        begun: question.begun,
    };
    let KindFinding { table, found, alternatives, inputs, extended } = asked.answer()?;
    let is_at_hand = (extended.drive.hysteresis - 1.0).abs() < AT_HAND;
    let won_back = match &question.hysteretic {
        Some(hysteretic) if is_at_hand && found.finding.verdict == Verdict::Named => {
            // a rotor that cannot be controlled here tells nothing
            won_back(&extended, sweep, hysteretic).unwrap_or_default()
        }
        _ => Vec::new(),
    };
    let extended = case_of(extended, &flights.model);
    let moved = moved_inputs(uncertain.iter().map(|own| own.field.as_str()), &inputs);
    Ok(RotorDiagnosis { table, found, causes, aside, alternatives, moved, extended, won_back })
}

/// The case of an extended model; none where it is that of the model as it was.
fn case_of(mut own: RotorModel, model: &RotorModel) -> Option<Case> {
    // the Lock number of a case is its density and its lift slope
    own.case.rotor.lock_number *= own.density * own.lift_slope;
    own.case.aerodynamics.drag_coefficient /= own.lift_slope;
    own.case.actuator.ideal_amplitude_deg *= own.drive.gain;
    (own.case != model.case).then_some(own.case)
}

/// The drive of middle amplitude: harmonic and voltage; none where no flap is driven.
fn middle_drive(sweep: &Sweep) -> Option<(usize, Harmonic)> {
    let driven = sweep.points.iter().flat_map(|point| &point.flaps_volt);
    let mut all: Vec<(usize, Harmonic)> = driven.flatten().copied().collect();
    all.retain(|own| amplitude(own.1) > 0.0);
    all.sort_by(|a, b| amplitude(a.1).total_cmp(&amplitude(b.1)));
    all.get(all.len() / 2).copied()
}

impl<'a> Flights<'a> {
    /// Every point flown as simulated, and those that cannot be.
    fn of(question: &'a RotorQuestion<'a>) -> Result<(Self, Vec<Aside>), RotorGapError> {
        let RotorQuestion { case, sweep, .. } = question;
        let mut model = RotorModel::of((*case).clone());
        let middle = middle_drive(sweep);
        model.drive.middle = middle.map_or((1, 0.0), |(harmonic, own)| (harmonic, amplitude(own)));
        let own = question.actuator.clone();
        let actuators = Actuators::of(case, own, question.hysteretic.clone());
        let actuators = actuators.map_err(|source| RotorGapError::Study {
            point: "-".to_owned(),
            source: Box::new(source),
        })?;
        let every: Vec<&SweepPoint> = sweep.points.iter().collect();
        let tried = model.fly(&every, &actuators, None);
        let (mut points, mut flown, mut aside) = (Vec::new(), Vec::new(), Vec::new());
        for (p, result) in tried.into_iter().enumerate() {
            match result {
                Ok(own) => {
                    points.push(p);
                    flown.push(own);
                }
                Err(error) => {
                    let point = sweep.points[p].id.clone();
                    aside.push(Aside { point, reason: error.to_string() });
                }
            }
        }
        if flown.is_empty() {
            let first = aside.first().map(|own| own.reason.clone()).unwrap_or_default();
            return Err(RotorGapError::NoPoint { first });
        }
        let (named, instruments) = instrumented(&sweep.channels);
        Ok((Self { question, model, actuators, points, flown, named, instruments }, aside))
    }

    /// The library for these points.
    fn causes(&self) -> Vec<RotorCause> {
        let middle = middle_drive(self.question.sweep);
        let lag_deg = middle.map_or_else(Vec::new, |own| self.lags_deg(own));
        library(&Occasion {
            model: &self.model,
            instruments: &self.instruments,
            has_hysteretic: self.actuators.hysteretic.is_some(),
            is_ideal: matches!(self.actuators.own, FlapDrive::Ideal { .. }),
            is_driven: self.question.sweep.points.iter().any(SweepPoint::is_driven),
            lag_deg: &lag_deg,
        })
    }

    /// What was measured at the points flown.
    fn measured(&self, predicted: &Grid) -> Vec<Point> {
        let sweep = self.question.sweep;
        let of_channel = |(c, own): (usize, &SweepChannel)| self.deviations(own, predicted, c);
        let deviations: Vec<Vec<f64>> = sweep.channels.iter().enumerate().map(of_channel).collect();
        let point = |(place, &p): (usize, &usize)| Point {
            id: sweep.points[p].id.clone(),
            group: sweep.points[p].group,
            is_reference: sweep.points[p].is_reference,
            conditions: sweep.conditions.iter().map(|(_, values)| values[p]).collect(),
            measured: sweep.channels.iter().map(|own| own.values[p]).collect(),
            deviation: deviations.iter().map(|own| own[place]).collect(),
        };
        self.points.iter().enumerate().map(point).collect()
    }

    fn study_error(&self, place: usize, source: StudyError) -> RotorGapError {
        let point = self.question.sweep.points[self.points[place]].id.clone();
        RotorGapError::Study { point, source: Box::new(source) }
    }

    /// Lag of an actuator with a part of the hysteresis, at a drive.
    fn lags_deg(&self, (harmonic, own): (usize, Harmonic)) -> Vec<(f64, f64)> {
        let lag = |part: f64| {
            let mut model = self.model.clone();
            let still = self.actuators.motion_deg(&model, &[(harmonic, own)]).ok()?;
            model.drive.hysteresis = part;
            let moved = self.actuators.motion_deg(&model, &[(harmonic, own)]).ok()?;
            let phase = |series: &HarmonicSeries| {
                let own = series.harmonic(harmonic);
                own.sine.atan2(own.cosine)
            };
            let late = (phase(&moved) - phase(&still)).to_degrees();
            Some((part, (late + 180.0).rem_euclid(360.0) - 180.0))
        };
        (0..LAG_PARTS).filter_map(|k| lag(0.25 * k as f64)).collect()
    }

    /// Standard deviations of a channel at the points flown.
    fn deviations(&self, own: &SweepChannel, predicted: &Grid, channel: usize) -> Vec<f64> {
        let values: Vec<Option<f64>> = self.points.iter().map(|&p| own.values[p]).collect();
        let predicted: Vec<f64> = predicted.iter().map(|row| row[channel]).collect();
        match &own.scatter {
            Scatter::Stated(stated) => self.points.iter().map(|&p| stated[p]).collect(),
            other => other.deviations(&values, &predicted),
        }
    }
}

impl PointKind for Flights<'_> {
    type Model = RotorModel;
    type Error = RotorGapError;

    /// One that differs in its readings alone is not flown again.
    fn read(&self, model: &RotorModel) -> Result<Grid, RotorGapError> {
        let read = |(place, flown): (usize, &Flown)| {
            let read =
                flown.read(model, &self.question.sweep.channels, &self.named, &self.instruments);
            read.map_err(|source| self.study_error(place, source))
        };
        if model.flies_as(&self.model) {
            return self.flown.par_iter().enumerate().map(read).collect();
        }
        let points: Vec<&SweepPoint> =
            self.points.iter().map(|&p| &self.question.sweep.points[p]).collect();
        // an orbit of as many modes leads to another
        let has_modes = model.case.structure.modes == self.model.case.structure.modes;
        let near: Vec<&Flown> = self.flown.iter().collect();
        let near = has_modes.then(|| (&near[..], model.is_trimmed_as(&self.model)));
        let flown = model.fly(&points, &self.actuators, near);
        let of_point = |(place, own): (usize, Result<Flown, StudyError>)| {
            own.map_err(|source| self.study_error(place, source))
                .and_then(|own| read((place, &own)))
        };
        flown.into_par_iter().enumerate().map(of_point).collect()
    }
}
