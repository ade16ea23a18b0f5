//! A diagnosis: what the simulation of a rotor lacks, from points of test.

use crate::causes::{Occasion, RotorCause, library};
use crate::error::RotorGapError;
use crate::flight::{Actuators, Flown, amplitude, grid_of};
use crate::model::RotorModel;
use crate::spread::{alternatives, moved};
use crate::sweep::{ASIDE, Aside, Sweep, SweepChannel, SweepPoint};
use measured_data::Scatter;
use model_gap::Effect;
use model_gap::discovery::Found;
use model_gap::points::{
    Channel, Grid, Instrument, Point, PointFinding, PointTable, Suspect, SuspectParameter,
    channels_of,
};
use preisach_dyn::ActuatorModel;
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_study::case::{Case, UncertainField};
use rotor_study::{FlapDrive, StudyError};
use std::sync::Arc;

/// Rounds in which the effects of what is left are computed anew where they were found.
const ROUNDS: usize = 3;
/// Part of a value by which it must be off those that its effect was computed at.
const MOVED: f64 = 0.1;
/// Part of the most that any cause explains alone from which on its effect is computed anew, and the most of these.
const GOOD_PART: f64 = 0.15;
const SURVIVORS: usize = 8;
/// Parts of the difference between the actuators that the lag is listed at.
const LAG_PARTS: usize = 9;
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
    /// The case with what was found, if any of it is in a case.
    pub extended: Option<Case>,
}

impl RotorDiagnosis {
    /// What a reader should know: inputs taken for uncertain, and where that is said; other levels of fidelity; points set
    /// aside.
    pub fn notes(&self, uncertain: &[UncertainField], from: &str) -> Vec<String> {
        let one = |own: &UncertainField| match (own.sd_percent, own.sd) {
            (Some(percent), _) => format!("{} {percent} %", own.field),
            (None, sd) => format!("{} {}", own.field, sd.unwrap_or_default()),
        };
        let stated: Vec<String> = uncertain.iter().map(one).collect();
        let mut notes = vec![format!("uncertain (1 sd, {from}): {}", stated.join(", "))];
        if !self.alternatives.is_empty() {
            notes.push(format!("as good: {}", self.alternatives.join(", ")));
        }
        let aside = self.aside.iter();
        notes.extend(aside.map(|own| format!("point {} is {ASIDE}: {}", own.point, own.reason)));
        notes
    }
}

/// Everything that a round needs.
struct Round<'a> {
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
    let RotorQuestion { case, sweep, begun, .. } = question;
    let model = RotorModel::of((*case).clone());
    let own = question.actuator.clone();
    let actuators = Actuators::of(case, own, question.hysteretic.clone());
    let actuators = actuators.map_err(|source| RotorGapError::Study {
        point: "-".to_owned(),
        source: Box::new(source),
    })?;
    begun(0, "the simulation at every point");
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
                aside.push(Aside { point: sweep.points[p].id.clone(), reason: error.to_string() });
            }
        }
    }
    if flown.is_empty() {
        let first = aside.first().map(|own| own.reason.clone()).unwrap_or_default();
        return Err(RotorGapError::NoPoint { first });
    }
    let names: Vec<&str> = sweep.channels.iter().map(|own| own.name.as_str()).collect();
    let (named, instruments) = channels_of(&names);
    let round = Round { question, model, actuators, points, flown, named, instruments };
    let middle = round.middle_drive();
    let lag_deg = middle.map_or_else(Vec::new, |own| round.lags_deg(own));
    let causes = library(&Occasion {
        model: &round.model,
        instruments: &round.instruments,
        has_hysteretic: round.actuators.hysteretic.is_some(),
        is_ideal: matches!(round.actuators.own, FlapDrive::Ideal { .. }),
        is_driven: sweep.points.iter().any(SweepPoint::is_driven),
        middle_volt: middle.map_or(1.0, |own| amplitude(own.1)),
        lag_deg: &lag_deg,
    });
    let (mut table, alternatives) = round.table(&causes)?;
    begun(90, "search for what is missing");
    let only = round.only(&causes)?;
    let find = |table: &PointTable| match &only[..] {
        [] => table.find(),
        given => table.refit(given),
    };
    let mut found = find(&table)?;
    for _ in 0..ROUNDS {
        if !round.refine(&causes, &mut table, &found) {
            break;
        }
        found = find(&table)?;
    }
    let extended = extended(&round.model, &causes, &found);
    Ok(RotorDiagnosis { table, found, causes, aside, alternatives, extended })
}

/// The case with the causes found; none where they leave it as it is.
fn extended(model: &RotorModel, causes: &[RotorCause], found: &PointFinding) -> Option<Case> {
    let mut own = model.clone();
    for effect in &found.finding.effects {
        own = causes[effect.candidate].applied(&own, &effect.values);
    }
    // the Lock number of a case is its density and its lift slope
    own.case.rotor.lock_number *= own.density * own.lift_slope;
    own.case.aerodynamics.drag_coefficient /= own.lift_slope;
    own.case.actuator.ideal_amplitude_deg *= own.drive.gain;
    (own.case != model.case).then_some(own.case)
}

impl Round<'_> {
    fn study_error(&self, place: usize, source: StudyError) -> RotorGapError {
        let point = self.question.sweep.points[self.points[place]].id.clone();
        RotorGapError::Study { point, source: Box::new(source) }
    }

    fn channels(&self) -> &[SweepChannel] {
        &self.question.sweep.channels
    }

    /// The drive of middle amplitude: harmonic and voltage; none where no flap is driven.
    fn middle_drive(&self) -> Option<(usize, Harmonic)> {
        let driven = self.question.sweep.points.iter().flat_map(|point| &point.flaps_volt);
        let mut all: Vec<(usize, Harmonic)> = driven.flatten().copied().collect();
        all.retain(|own| amplitude(own.1) > 0.0);
        all.sort_by(|a, b| amplitude(a.1).total_cmp(&amplitude(b.1)));
        all.get(all.len() / 2).copied()
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

    /// What a model reads at every point; one that differs in its readings alone is not flown again.
    fn grid(&self, model: &RotorModel) -> Result<Grid, RotorGapError> {
        let read = |(place, flown): (usize, &Flown)| {
            let read = flown.read(model, self.channels(), &self.named, &self.instruments);
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
        let flown = model.fly(&points, &self.actuators, has_modes.then_some(&near[..]));
        let of_point = |(place, own): (usize, Result<Flown, StudyError>)| {
            own.map_err(|source| self.study_error(place, source))
                .and_then(|own| read((place, &own)))
        };
        flown.into_par_iter().enumerate().map(of_point).collect()
    }

    /// The points with what the simulation says of them, with some of each cause, and with what it is not sure of.
    fn table(
        &self,
        causes: &[RotorCause],
    ) -> Result<(PointTable, Vec<&'static str>), RotorGapError> {
        let Self { question, model, .. } = self;
        let base = grid_of(&self.flown, model, self.channels(), &self.named, &self.instruments)
            .map_err(|source| self.study_error(0, source))?;
        let begun = question.begun;
        begun(5, "other levels of fidelity");
        let (mut fidelity, mut alternative_grids) = (Vec::new(), Vec::new());
        for (name, case) in alternatives(question.case) {
            // a level that does not fly here tells nothing
            if let Ok(grid) = self.grid(&RotorModel { case, ..model.clone() }) {
                fidelity.push(name);
                alternative_grids.push(grid);
            }
        }
        begun(15, "inputs that are not known well");
        let uncertain = question.uncertain.iter().enumerate().map(|(number, own)| {
            let case = moved(own, number, question.case)?;
            self.grid(&RotorModel { case, ..model.clone() })
        });
        let uncertain = uncertain.collect::<Result<_, _>>()?;
        let mut suspects = Vec::with_capacity(causes.len());
        for (k, cause) in causes.iter().enumerate() {
            begun(25 + 65 * k / causes.len(), cause.id);
            suspects.push(self.suspect(cause));
        }
        let sweep = question.sweep;
        let deviations: Vec<Vec<f64>> = sweep
            .channels
            .iter()
            .enumerate()
            .map(|(c, own)| self.deviations(own, &base, c))
            .collect();
        let point = |(place, &p): (usize, &usize)| Point {
            id: sweep.points[p].id.clone(),
            group: sweep.points[p].group,
            conditions: sweep.conditions.iter().map(|(_, values)| values[p]).collect(),
            measured: sweep.channels.iter().map(|own| own.values[p]).collect(),
            deviation: deviations.iter().map(|own| own[place]).collect(),
        };
        let instrument = |name: &String| Instrument { name: name.clone(), gain: GAIN, zero: 0.0 };
        let knows = sweep.channels.iter().all(|own| own.scatter != Scatter::Unknown);
        let table = PointTable {
            points: self.points.iter().enumerate().map(point).collect(),
            channels: self.named.clone(),
            instruments: self.instruments.iter().map(instrument).collect(),
            conditions: sweep.conditions.iter().map(|(name, _)| name.clone()).collect(),
            predicted: base,
            suspects,
            alternatives: alternative_grids,
            uncertain,
            knows_deviations: knows,
        };
        Ok((table, fidelity))
    }

    /// A cause as a suspect: what the rotor reads with some of it. One that cannot be flown is blocked.
    fn suspect(&self, cause: &RotorCause) -> Suspect {
        let mut blocked = cause.blocked.clone();
        let none = cause.none();
        let mut parameter = |k: usize| {
            let own = &cause.parameters[k];
            let mut tables = Vec::new();
            for &amount in &own.amounts {
                if blocked.is_some() {
                    break;
                }
                let mut values = none.clone();
                values[k] = amount;
                match self.grid(&cause.applied(&self.model, &values)) {
                    Ok(grid) => tables.push((amount, grid)),
                    Err(error) => {
                        blocked = Some(format!("the rotor with it cannot be flown: {error}"));
                    }
                }
            }
            SuspectParameter {
                name: own.name,
                unit: own.unit,
                none: own.none,
                range: own.range,
                tables,
                shown: own.shown.clone(),
            }
        };
        let parameters = (0..cause.parameters.len()).map(&mut parameter).collect();
        Suspect {
            name: cause.id,
            physics: cause.physics,
            form_error: cause.form_error,
            confused_with: cause.confused_with,
            separating: cause.separating,
            parameters,
            blocked,
            ..Suspect::default()
        }
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

    /// Numbers of the causes asked for.
    fn only(&self, causes: &[RotorCause]) -> Result<Vec<usize>, RotorGapError> {
        let ids: Vec<&str> = causes.iter().map(|own| own.id).collect();
        Ok(model_gap::places(&ids, self.question.only)?)
    }

    /// Computes effects anew where they were found: of the causes found, of what may be it instead, and of those that fitted
    /// alone explain a good part. False where none of them has moved.
    fn refine(&self, causes: &[RotorCause], table: &mut PointTable, found: &PointFinding) -> bool {
        let finding = &found.finding;
        let rivals = finding.causes.iter().flat_map(|own: &Found| &own.rivals);
        let mut effects: Vec<&Effect> = rivals.flat_map(|rival| &rival.effects).collect();
        let mut singles: Vec<&(Effect, f64)> = finding.singles.iter().flatten().collect();
        singles.sort_by(|a, b| b.1.total_cmp(&a.1));
        let most = singles.first().map_or(0.0, |own| own.1);
        let is_good = |own: &&&(Effect, f64)| own.1 > GOOD_PART * most;
        effects.extend(singles.iter().filter(is_good).take(SURVIVORS).map(|own| &own.0));
        let mut moved = false;
        for effect in effects {
            let cause = &causes[effect.candidate];
            for (k, &value) in effect.values.iter().enumerate() {
                let own = &mut table.suspects[effect.candidate].parameters[k];
                let Some(size) = own.tables.first().map(|table| (table.0 - own.none).abs()) else {
                    continue;
                };
                let known = own.tables.iter().map(|table| table.0).chain([own.none]);
                let nearest = known.map(|at| (value - at).abs()).fold(f64::INFINITY, f64::min);
                if nearest <= MOVED * size.max((value - own.none).abs()) {
                    continue;
                }
                let mut values = cause.none();
                values[k] = value;
                // where it cannot be flown its effect stays as it was
                if let Ok(grid) = self.grid(&cause.applied(&self.model, &values)) {
                    own.tables.push((value, grid));
                    moved = true;
                }
            }
        }
        moved
    }
}
