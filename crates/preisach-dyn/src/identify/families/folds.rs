//! What is left out of a fit in turn, and the error that noise alone leaves there.

use crate::check::extremes;
use crate::identify::fit::compare;
use crate::identify::fit::training::Training;
use crate::identify::records::noise::Fine;
use crate::identify::records::prepared::Prepared;
use crate::{ActuatorModel, PreisachError};
use rotor_base::mean_square;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Frequencies and amplitudes that differ by less than this share are one.
const SAME: f64 = 0.05;
/// Blocks in time of a record.
const BLOCKS: usize = 8;
/// Share of the swing by which the commands of what is left out may leave those of the rest.
const BEYOND: f64 = 0.02;
/// Fewest samples of such a block.
const FEWEST_SAMPLES: usize = 16;

/// What a comparison of models leaves out of the fits in turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LeftOut {
    /// Nothing: there are too few training records, and more than one.
    Nothing,
    /// Training records: those of one frequency, of one amplitude, or single ones.
    Records,
    /// Single slow training records, and blocks in time of the only fast one.
    RecordsAndBlocks,
    /// Blocks in time of the only training record, or of the largest where the commands of each go beyond those of the rest.
    Blocks,
}

impl LeftOut {
    /// What some folds are of.
    pub(crate) fn of(folds: &[Fold]) -> Self {
        let is_block = |fold: &Fold| matches!(fold, Fold::Block(..));
        match folds {
            [] => Self::Nothing,
            _ if folds.iter().all(is_block) => Self::Blocks,
            _ if folds.iter().any(is_block) => Self::RecordsAndBlocks,
            _ => Self::Records,
        }
    }
}

/// Which folds there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Folds {
    /// Frequencies and amplitudes of the fast records; of a single one, blocks in time and the slow records.
    Conditions,
    /// Slow records too.
    All,
}

/// What is left out of one fit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Fold {
    /// Records, as places in the slow and the fast ones, one after another.
    Records(Vec<usize>),
    /// Samples of the record at a place.
    Block(usize, Range<usize>),
}

impl Fold {
    /// Mean square of the NRMSE of what is left out, by the model fitted to the rest.
    pub(crate) fn square_error(
        &self,
        training: &Training<'_>,
        fit: impl Fn(&Training<'_>) -> Result<ActuatorModel, PreisachError>,
    ) -> Result<f64, PreisachError> {
        let all = training.all();
        match self {
            Self::Records(places) => {
                let model = fit(&training.without(places))?;
                let errors =
                    places.iter().map(|&place| compare::training_nrmse(&model, all[place]));
                Ok(mean_square(&errors.collect::<Result<Vec<_>, _>>()?))
            }
            Self::Block(place, block) => {
                let mut rest: Vec<Prepared> = all.iter().map(|&record| record.clone()).collect();
                rest[*place] = all[*place].clone().without(block.clone());
                let rest = Training::of(&rest, training.grid, training.settings)?;
                Ok(compare::nrmse_over(&fit(&rest)?, all[*place], block.clone())?.powi(2))
            }
        }
    }

    /// Mean square of the noise of what is left out over its spread.
    fn square_noise(&self, all: &[&Prepared], usual_deg: f64) -> f64 {
        let square = |record: &Prepared| {
            (record.noise.map_or(usual_deg, |noise| noise.std_deg) / record.spread_deg).powi(2)
        };
        match self {
            Self::Records(places) => {
                places.iter().map(|&place| square(all[place])).sum::<f64>() / places.len() as f64
            }
            Self::Block(place, _) => square(all[*place]),
        }
    }
}

/// The folds of some training records; none where there are too few.
///
/// Records whose commands go beyond those of all others say how a model is beyond what trained it, which is not asked: they
/// are no fold. Where slow records alone train and none is left, blocks in time of the largest are. A single fast record
/// cannot be left out, or nothing would be known of rate: blocks in time of it are, beside the slow records. Steps, fades
/// and other records that neither repeat nor are slow are left out one by one.
pub(crate) fn of(training: &Training, which: Folds) -> Vec<Fold> {
    let Training { slow, fast, .. } = training;
    let all = training.all();
    let swings: Vec<[f64; 2]> = all.iter().map(|record| swing(record)).collect();
    let within = |groups: Vec<Vec<usize>>| -> Vec<Vec<usize>> {
        groups.into_iter().filter(|places| is_within(&swings, places)).collect()
    };
    let single = |places: Range<usize>| within(places.map(|place| vec![place]).collect());
    let records = |folds: Vec<Vec<usize>>| folds.into_iter().map(Fold::Records).collect::<Vec<_>>();
    let slow_ones = || if slow.len() < 2 { Vec::new() } else { single(0..slow.len()) };
    let mut others = records(single(slow.len() + fast.len()..all.len()));
    let mut folds = match &fast[..] {
        [] => records(slow_ones()),
        [only] => {
            let mut folds = records(slow_ones());
            folds.extend(blocks(slow.len(), only));
            folds
        }
        _ => {
            let conditions = conditions(fast, slow.len());
            let kept = within(conditions.clone());
            records(if kept.is_empty() { conditions } else { kept })
        }
    };
    folds.append(&mut others);
    if folds.is_empty() {
        let span = |place: &usize| swings[*place][1] - swings[*place][0];
        let largest = (0..slow.len()).max_by(|a, b| span(a).total_cmp(&span(b)).then(b.cmp(a)));
        folds = largest.map_or_else(Vec::new, |place| blocks(place, slow[place]));
    }
    if fast.len() > 1 && slow.len() > 2 && which == Folds::All {
        folds.extend(records(single(0..slow.len())));
    }
    folds
}

/// The extremes of the commands of a record up to the last sample that trains.
fn swing(record: &Prepared) -> [f64; 2] {
    let end = record.record.trained_samples().end;
    extremes(record.record.voltage_volt[..end].iter().copied())
}

/// Whether the commands of some parts are within those of the rest.
fn is_within(swings: &[[f64; 2]], left_out: &[usize]) -> bool {
    let rest = || (0..swings.len()).filter(|other| !left_out.contains(other));
    let [low, _] = extremes(rest().map(|other| swings[other][0]));
    let [_, high] = extremes(rest().map(|other| swings[other][1]));
    let beyond = BEYOND * (high - low);
    left_out.iter().all(|&own| swings[own][0] >= low - beyond && swings[own][1] <= high + beyond)
}

/// The error of folds that a model without misfit has: the noise over the spread. Of a record whose cycles do not repeat it
/// is what records at rest show, else that of the others; of a single record what is rough from sample to sample. 0 where
/// nothing shows it.
pub(crate) fn noise(training: &Training, folds: &[Fold], rest_noise_deg: Option<f64>) -> f64 {
    let all = training.all();
    let known: Vec<f64> = all.iter().filter_map(|r| r.noise.map(|noise| noise.std_deg)).collect();
    let of_others = (!known.is_empty()).then(|| mean_square(&known).sqrt());
    let of_one = || {
        let [only] = &all[..] else { return 0.0 };
        Fine::of(&only.record.output_deg[only.record.trained_samples()]).rms_deg()
    };
    let usual_deg = rest_noise_deg.or(of_others).unwrap_or_else(of_one);
    let squares = folds.iter().map(|fold| fold.square_noise(&all, usual_deg));
    (squares.sum::<f64>() / folds.len().max(1) as f64).sqrt()
}

/// Blocks in time of the record at a place, of equal length, that are within the commands of its rest.
fn blocks(place: usize, record: &Prepared) -> Vec<Fold> {
    let trained = record.record.trained_samples();
    if trained.len() < BLOCKS * FEWEST_SAMPLES {
        return Vec::new();
    }
    let end = |k: usize| trained.start + k * trained.len() / BLOCKS;
    let all: Vec<Range<usize>> = (0..BLOCKS).map(|k| end(k)..end(k + 1)).collect();
    let volts = &record.record.voltage_volt;
    let swings: Vec<[f64; 2]> =
        all.iter().map(|block| extremes(volts[block.clone()].iter().copied())).collect();
    let within = all.into_iter().enumerate().filter(|(k, _)| is_within(&swings, &[*k]));
    within.map(|(_, block)| Fold::Block(place, block)).collect()
}

/// What is left out of the fast records in turn, as places from `first` on: all records of one
/// frequency, and all of one amplitude, because a model is used at frequencies and amplitudes the bench
/// did not run. Single records where there is only one frequency and one amplitude.
fn conditions(fast: &[&Prepared], first: usize) -> Vec<Vec<usize>> {
    let groups = |value: &dyn Fn(&Prepared) -> f64| {
        let mut groups: Vec<(f64, Vec<usize>)> = Vec::new();
        for (place, record) in fast.iter().enumerate() {
            let own = value(record);
            match groups.iter_mut().find(|(v, _)| (own / *v - 1.0).abs() <= SAME) {
                Some((_, members)) => members.push(first + place),
                None => groups.push((own, vec![first + place])),
            }
        }
        let members: Vec<Vec<usize>> = groups.into_iter().map(|(_, members)| members).collect();
        if members.len() < 2 { Vec::new() } else { members }
    };
    let mut folds = groups(&|r| r.drive.strongest_hz());
    for group in groups(&|r| r.drive.amplitude_volt) {
        if !folds.contains(&group) {
            folds.push(group);
        }
    }
    if folds.is_empty() && fast.len() >= 2 {
        folds = (0..fast.len()).map(|place| vec![first + place]).collect();
    }
    folds
}
