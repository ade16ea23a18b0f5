//! The way of a model over the records, kept part by part.

use crate::identify::records::prepared::Prepared;
use crate::{ActuatorLaw, ActuatorModel, Drive};
use actuator_stages::Step;
use rayon::prelude::*;
use std::borrow::Cow;

/// The signals of a model over the commands of all records, behind the law and behind every stage of
/// the linkage.
///
/// A model beside it is run from the part it differs in; its outputs are those of its own
/// simulation, to the last bit.
#[derive(Debug, Clone)]
pub(crate) struct Passage {
    model: ActuatorModel,
    /// Per record: behind the law, behind the first stage, ..., the flap angle, deg.
    signals: Vec<Vec<Vec<f64>>>,
}

/// The command of a record up to the end of what trains.
#[derive(Debug, Clone)]
pub(crate) struct Command<'a> {
    voltage_volt: Cow<'a, [f64]>,
    time_step_s: f64,
    /// Samples of the record from one to the next.
    pub(crate) stride: usize,
}

impl<'a> Command<'a> {
    /// Every sample of it.
    pub(crate) fn whole(prepared: &Prepared<'a>) -> Self {
        let record = prepared.record;
        let voltage_volt = Cow::Borrowed(&record.voltage_volt[..record.trained_samples().end]);
        Self { voltage_volt, time_step_s: record.time_step_s, stride: 1 }
    }

    /// The first sample and every `stride`-th after it.
    pub(crate) fn thinned(prepared: &Prepared<'a>, stride: usize) -> Self {
        let whole = Self::whole(prepared);
        let voltage_volt = whole.voltage_volt.iter().step_by(stride).copied().collect();
        Self { voltage_volt, time_step_s: whole.time_step_s * stride as f64, stride }
    }
}

impl Passage {
    /// The passage of a model; none if it diverges or a stage is refused.
    pub(crate) fn of(model: ActuatorModel, commands: &[Command]) -> Option<Self> {
        let bare = ActuatorModel { linkage: Vec::new(), ..model.clone() };
        let free = |c: &Command| {
            let law = behind_the_law(&bare, c)?;
            let mut signals = Vec::with_capacity(model.linkage.len() + 1);
            let last = through(&model, 0, law, c, |signal| signals.push(signal.to_vec()))?;
            signals.push(last);
            Some(signals)
        };
        let signals = commands.iter().map(free).collect::<Option<Vec<_>>>()?;
        Some(Self { model, signals })
    }

    /// The flap angle over a record, deg.
    pub(crate) fn output_deg(&self, record: usize) -> &[f64] {
        self.signals[record].last().map_or(&[], Vec::as_slice)
    }

    /// Signals behind the laws of models beside this one, by model and record; none where the law is
    /// the same or has to be simulated.
    pub(crate) fn laws_beside(
        &self,
        models: &[Option<ActuatorModel>],
        commands: &[Command],
    ) -> Vec<Option<Vec<Vec<f64>>>> {
        let own: Vec<Option<&ActuatorLaw>> =
            models.iter().map(|model| self.other_law(model.as_ref()?)).collect();
        let laws: Vec<&ActuatorLaw> = own.iter().copied().flatten().collect();
        let by_record: Option<Vec<Vec<Vec<f64>>>> = commands
            .par_iter()
            .map(|c| ActuatorLaw::side_by_side(&laws, &c.voltage_volt, c.time_step_s))
            .collect();
        let Some(by_record) = by_record else {
            return vec![None; models.len()];
        };
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
    pub(crate) fn beside(
        &self,
        model: &ActuatorModel,
        law: Option<Vec<Vec<f64>>>,
        commands: &[Command],
    ) -> Option<Vec<Vec<f64>>> {
        let (signals, first): (Vec<Vec<f64>>, usize) = match law {
            Some(law) => (law, 0),
            None if self.same_front(model) => {
                let pairs = model.linkage.iter().zip(&self.model.linkage);
                let same = pairs.take_while(|(a, b)| a == b).count();
                (self.signals.iter().map(|s| s[same].clone()).collect(), same)
            }
            None => {
                let passage = Self::of(model.clone(), commands)?;
                return passage.signals.into_iter().map(|mut s| s.pop()).collect();
            }
        };
        let pairs = signals.into_iter().zip(commands);
        pairs.map(|(signal, c)| through(model, first, signal, c, |_| ())).collect()
    }

    /// The law of a model that differs from this one and acts on the command itself.
    fn other_law<'a>(&self, model: &'a ActuatorModel) -> Option<&'a ActuatorLaw> {
        let own = model.amplifier.is_empty() && !self.same_front(model);
        own.then_some(&model.law)
    }

    /// Whether a model has the amplifier and the law of this one; range and calibration are the same.
    fn same_front(&self, model: &ActuatorModel) -> bool {
        model.amplifier == self.model.amplifier && model.law == self.model.law
    }
}

/// The signal behind the law of a model without linkage; none if it diverges.
fn behind_the_law(bare: &ActuatorModel, command: &Command) -> Option<Vec<f64>> {
    let Command { voltage_volt, time_step_s, .. } = command;
    let drive = Drive::new(voltage_volt, *time_step_s);
    if !bare.amplifier.is_empty() {
        return Some(bare.simulate_drive(&drive).ok()?.output_deg);
    }
    drive.check(bare).ok()?;
    let law = bare.law.outputs(voltage_volt, *time_step_s);
    law.iter().all(|y| y.is_finite()).then_some(law)
}

/// A signal through the linkage from stage `first` on, `keep` being shown what goes into every stage;
/// none if it diverges.
fn through(
    model: &ActuatorModel,
    first: usize,
    mut signal: Vec<f64>,
    command: &Command,
    mut keep: impl FnMut(&[f64]),
) -> Option<Vec<f64>> {
    model.check_stages().ok()?;
    for stage in &model.linkage[first..] {
        keep(&signal);
        stage.prepared(command.time_step_s, &model.calibration).pass(&mut signal);
    }
    signal.iter().all(|y| y.is_finite()).then_some(signal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::extremes;
    use crate::identify::{BenchRecord, RecordUse, Settings};
    use crate::{
        Accommodation, AmplifierStage, Backlash, DynamicParameters, DynamicPreisach, KelvinVoigt,
        KelvinVoigtElement, Lag, LinkageStage, LoadStiffness, LogCreep, PlayMap, PreisachGrid,
        RateForm, Relaxation, RelaxationElement, Resonance, StaticPreisach, TimeOrder,
    };
    use std::f64::consts::TAU;

    fn records(settings: &Settings) -> Vec<BenchRecord> {
        [1.0, 7.0]
            .map(|hz| BenchRecord {
                id: "sine".into(),
                time_step_s: settings.least_relaxation_s * 10.0,
                voltage_volt: (0..1500)
                    .map(|i| 65.0 + 80.0 * (TAU * hz * f64::from(i) * 1e-3).sin())
                    .collect(),
                output_deg: (0..1500).map(|i| f64::from(i % 7)).collect(),
                ..BenchRecord::default()
            })
            .to_vec()
    }

    fn law(grid: &PreisachGrid, bend: f64, dynamic: bool) -> ActuatorLaw {
        let n = grid.levels();
        let rises: Vec<Vec<f64>> = (0..n)
            .map(|j| (0..n - j).map(|k| 0.1 + bend * ((j + 2 * k) as f64).sin().abs()).collect())
            .collect();
        let g0_deg = PlayMap::from_rises(grid, 0.3, &rises).unwrap();
        if !dynamic {
            return ActuatorLaw::StaticPreisach(StaticPreisach::new(*grid, g0_deg).unwrap());
        }
        let law = DynamicPreisach::new(DynamicParameters {
            grid: *grid,
            g1_s: PlayMap::constant(grid, -0.003 - 0.01 * bend),
            g2_s2_per_deg: PlayMap::constant(grid, 1e-7),
            g0_deg,
            form: RateForm::WellPosed,
            unfolded_rate_deg_s: 10.0,
            time_order: TimeOrder::Second,
        });
        ActuatorLaw::DynamicPreisach(law.unwrap())
    }

    fn actuator(settings: &Settings, law: ActuatorLaw, creep: f64, lag: bool) -> ActuatorModel {
        let element = |share, time_constant_s| RelaxationElement { share, time_constant_s };
        let mut model = settings.actuator_of(law);
        model.linkage = vec![
            LinkageStage::Accommodation(Accommodation { share: 0.1, travel_um: 5.0 }),
            LinkageStage::Relaxation(Relaxation { elements: vec![element(0.9, 0.02)] }),
            LinkageStage::LogCreep(LogCreep { to_s: 3e4, ..LogCreep::new(creep) }),
            LinkageStage::KelvinVoigt(KelvinVoigt {
                elements: vec![KelvinVoigtElement {
                    compliance_ratio: creep,
                    time_constant_s: 0.3,
                }],
            }),
            LinkageStage::Resonance(Resonance { frequency_hz: 90.0, damping_ratio: 0.02 }),
            LinkageStage::Backlash(Backlash { width_um: 0.1 }),
            LinkageStage::LoadStiffness(LoadStiffness {
                stiffness_ratio: 0.2,
                compliance_um_per_newton: 0.0,
            }),
        ];
        if lag {
            model.amplifier.push(AmplifierStage::Lag(Lag { tau_s: 1e-3 }));
        }
        model
    }

    /// Whatever differs from the model that was run, and whatever is taken from it, the outputs are the
    /// bits of a simulation from the start. The grids have and have not a multiple of four levels.
    #[test]
    fn what_is_kept_changes_no_bit() {
        for (levels, dynamic, lag) in
            [(12, false, false), (7, false, false), (6, true, false), (8, false, true)]
        {
            let settings = Settings { levels, ..Settings::default() };
            let grid = PreisachGrid::new(settings.range_volt, levels).unwrap();
            let records = records(&settings);
            let prepared: Vec<Prepared> = records
                .iter()
                .map(|r| Prepared::new(r, r.drive(), RecordUse::Train, false, &grid, &settings))
                .collect::<Result<_, _>>()
                .unwrap();
            let all: Vec<Command> = prepared.iter().map(Command::whole).collect();
            let model = |bend, creep| actuator(&settings, law(&grid, bend, dynamic), creep, lag);
            let simulated = |model: &ActuatorModel| -> Vec<Vec<f64>> {
                let of = |c: &Command| model.simulate(&c.voltage_volt, c.time_step_s);
                all.iter().map(|c| of(c).unwrap().output_deg).collect()
            };
            let passage = Passage::of(model(0.1, 0.02), &all).unwrap();
            for (r, expected) in simulated(&model(0.1, 0.02)).iter().enumerate() {
                assert_eq!(passage.output_deg(r), expected);
            }
            // more laws than are evaluated at once, one model without a neighbour, one with its law
            let mut beside: Vec<Option<ActuatorModel>> =
                (0..10).map(|i| Some(model(0.1 + 1e-3 * f64::from(i + 1), 0.02))).collect();
            beside.extend([None, Some(model(0.1, 0.03)), Some(model(0.1, 0.02))]);
            let laws = passage.laws_beside(&beside, &all);
            assert_eq!(laws.iter().filter(|law| law.is_some()).count(), if lag { 0 } else { 10 });
            for (model, law) in beside.iter().zip(laws) {
                let Some(model) = model else { continue };
                assert_eq!(passage.beside(model, law, &all).unwrap(), simulated(model));
            }
        }
    }
    /// The stages take long steps exactly where signals are straight between the samples; what a sine
    /// of 36 samples loses is 0.4 % of its amplitude.
    #[test]
    fn a_thinned_command_leads_nearly_the_same_way() {
        const STRIDE: usize = 4;
        let settings = Settings { levels: 12, ..Settings::default() };
        let grid = PreisachGrid::new(settings.range_volt, settings.levels).unwrap();
        let mut model = actuator(&settings, law(&grid, 0.1, false), 0.02, false);
        model.linkage.truncate(3);
        for record in &records(&settings) {
            let drive = record.drive();
            let prepared =
                Prepared::new(record, drive, RecordUse::Train, false, &grid, &settings).unwrap();
            let commands =
                [Command::whole(&prepared), Command::thinned(&prepared, STRIDE)].map(|c| [c]);
            let [whole, thinned] = commands.map(|c| Passage::of(model.clone(), &c).unwrap());
            let (whole, thinned) = (whole.output_deg(0), thinned.output_deg(0));
            let [low, high] = extremes(whole.iter().copied());
            for (a, b) in whole.iter().step_by(STRIDE).zip(thinned) {
                assert!((a - b).abs() < 0.01 * (high - low), "{a} {b}");
            }
        }
    }
}
