//! The way of a model over the records, kept part by part.

use super::prepared::Prepared;
use crate::{ActuatorLaw, ActuatorModel, StaticPreisach};
use rayon::prelude::*;

/// Samples of a set of records up to which signals are kept: 8 MB per part of the chain.
const MOST_KEPT: usize = 1 << 20;

/// The signals of a model over all records, behind the law and behind every stage of the linkage.
///
/// A model beside it is run from the part it differs in; its outputs are those of its own
/// simulation, to the last bit.
#[derive(Debug, Clone)]
pub(super) struct Passage {
    model: ActuatorModel,
    /// Per record: behind the law, behind the first stage, ..., the flap angle, deg.
    signals: Vec<Vec<Vec<f64>>>,
}

/// Voltages of a record up to the end of what trains.
fn voltages<'a>(prepared: &Prepared<'a>) -> &'a [f64] {
    &prepared.record.voltage_volt[..prepared.record.trained_samples().end]
}

impl Passage {
    /// Whether records are short enough for their signals to be kept.
    pub(super) fn fits(records: &[&Prepared]) -> bool {
        records.iter().map(|r| voltages(r).len()).sum::<usize>() <= MOST_KEPT
    }

    /// The passage of a model; none if it diverges or a stage is refused.
    pub(super) fn of(model: ActuatorModel, records: &[&Prepared]) -> Option<Self> {
        let bare = ActuatorModel { linkage: Vec::new(), ..model.clone() };
        let free = |r: &&Prepared| {
            let law = match (&bare.law, bare.amplifier.is_empty()) {
                (ActuatorLaw::StaticPreisach(law), true) => {
                    bare.check_samples(voltages(r)).ok()?;
                    StaticPreisach::side_by_side(&[law], voltages(r)).pop()?
                }
                _ => bare.simulate(voltages(r), r.record.time_step_s).ok()?.output_deg,
            };
            through(&model, 0, law, r)
        };
        let signals = records.iter().map(free).collect::<Option<Vec<_>>>()?;
        Some(Self { model, signals })
    }

    /// The flap angle over a record, deg.
    pub(super) fn output_deg(&self, record: usize) -> &[f64] {
        self.signals[record].last().map_or(&[], Vec::as_slice)
    }

    /// Signals behind the laws of models beside this one, by model and record; none where the law is
    /// the same or has to be simulated.
    pub(super) fn laws_beside(
        &self,
        models: &[Option<ActuatorModel>],
        records: &[&Prepared],
    ) -> Vec<Option<Vec<Vec<f64>>>> {
        let own: Vec<Option<&StaticPreisach>> =
            models.iter().map(|model| self.other_law(model.as_ref()?)).collect();
        let laws: Vec<&StaticPreisach> = own.iter().copied().flatten().collect();
        let same_grid = laws.windows(2).all(|pair| pair[0].grid() == pair[1].grid());
        if laws.is_empty() || !same_grid {
            return vec![None; models.len()];
        }
        let by_record: Vec<Vec<Vec<f64>>> = records
            .par_iter()
            .map(|r| StaticPreisach::side_by_side(&laws, voltages(r)))
            .collect();
        let mut by_record: Vec<_> = by_record.into_iter().map(Vec::into_iter).collect();
        own.iter()
            .map(|law| {
                (*law)?;
                by_record.iter_mut().map(Iterator::next).collect()
            })
            .collect()
    }

    /// The flap angles of a model beside this one, by record, deg: of its law if it is given, and
    /// from the first stage that differs; none if it diverges.
    pub(super) fn beside(
        &self,
        model: &ActuatorModel,
        law: Option<Vec<Vec<f64>>>,
        records: &[&Prepared],
    ) -> Option<Vec<Vec<f64>>> {
        let (signals, first): (Vec<Vec<f64>>, usize) = match law {
            Some(law) => (law, 0),
            None if self.same_front(model) => {
                let pairs = model.linkage.iter().zip(&self.model.linkage);
                let same = pairs.take_while(|(a, b)| a == b).count();
                (self.signals.iter().map(|s| s[same].clone()).collect(), same)
            }
            None => {
                let passage = Self::of(model.clone(), records)?;
                return passage.signals.into_iter().map(|mut s| s.pop()).collect();
            }
        };
        let pairs = signals.into_iter().zip(records);
        pairs.map(|(signal, r)| through(model, first, signal, r)?.pop()).collect()
    }

    /// The static law of a model that differs from this one by it and acts on the command itself.
    fn other_law<'a>(&self, model: &'a ActuatorModel) -> Option<&'a StaticPreisach> {
        match &model.law {
            ActuatorLaw::StaticPreisach(law)
                if model.amplifier.is_empty() && !self.same_front(model) =>
            {
                Some(law)
            }
            _ => None,
        }
    }

    /// Whether a model has the amplifier and the law of this one.
    fn same_front(&self, model: &ActuatorModel) -> bool {
        let own = &self.model;
        model.amplifier == own.amplifier
            && model.law == own.law
            && model.calibration == own.calibration
            && model.range_volt == own.range_volt
    }
}

/// A signal through the linkage from stage `first` on: before it and behind every stage; none if it
/// diverges.
fn through(
    model: &ActuatorModel,
    first: usize,
    signal: Vec<f64>,
    prepared: &Prepared,
) -> Option<Vec<Vec<f64>>> {
    model.check_stages().ok()?;
    let mut signals = vec![signal];
    for stage in &model.linkage[first..] {
        let mut signal = signals.last()?.clone();
        stage.prepared(prepared.record.time_step_s, &model.calibration).pass(&mut signal);
        signals.push(signal);
    }
    signals.last()?.iter().all(|y| y.is_finite()).then_some(signals)
}
