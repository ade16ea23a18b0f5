//! `findings.json`: the findings in the form other programs read.

use crate::discovery::{BandLeft, Confidence, Finding, FittedParameter, Screened, Verdict};
use crate::{Candidate, Class};
use serde::Serialize;
use std::collections::BTreeMap;

/// The file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Findings {
    /// Kind of the data, such as `ActuatorBench`.
    pub data_kind: &'static str,
    /// The verdict.
    pub verdict: Verdict,
    /// The causes, best first; of an ambiguous verdict all that may be it.
    pub causes: Vec<String>,
    /// How sure the verdict is.
    pub confidence: Confidence,
    /// What kind of effect is missing, of the leading cause; none where nothing is named.
    pub class: Option<Class>,
    /// The causes of that class that the data leave open, the leading one first.
    pub class_members: Vec<String>,
    /// How sure the class is: it may be sure where the cause is not.
    pub class_confidence: Option<Confidence>,
    /// Parameters of every cause of [`Self::causes`], were it the one; the extended model has those of the first.
    pub parameters: BTreeMap<String, BTreeMap<String, ParameterValue>>,
    /// Whether the causes leave structure that they do not explain.
    pub structure_remains: bool,
    /// Measured runs that the base model misses by more than any surrogate there.
    pub standing_out: Vec<String>,
    /// Bands of frequency in which the causes leave more than noise, surrogates and errors of form can.
    pub bands_left: Vec<BandValue>,
    /// The simulation given beside the data; none where none was.
    pub given_model: Option<GivenModelValue>,
    /// Error on held-out experiments; none where nothing is named, or where no run could be held out.
    pub gain: Option<GainValue>,
    /// The same channel by channel, each in its unit; empty where the output is one channel.
    pub gain_by_channel: Vec<ChannelGainValue>,
    /// What to measure next.
    pub next_experiment: String,
    /// What was fitted in the place of each cause found, with its chi-square above that of the cause found.
    pub compared: Vec<ComparedValue>,
    /// Causes these data could not show.
    pub not_observable: Vec<String>,
    /// Size of every cause that these data would have shown with 90 % probability: of an output of one unit its rms over
    /// that of the output, of points of test the value of its first parameter; none of a cause that they cannot show.
    pub would_have_shown: BTreeMap<String, Option<f64>>,
    /// The screening.
    pub screen: Vec<ScreenValue>,
}

/// What the causes leave of a channel of a run in a band of frequency.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BandValue {
    /// The run.
    pub run: String,
    /// Where the band begins, Hz.
    pub low_hz: f64,
    /// Where it ends, Hz.
    pub high_hz: f64,
    /// What is left, in amplitude, over what may be.
    pub times: f64,
    /// Share of its energy that follows the motion simulated, 0 to 1.
    pub coherence: f64,
}

/// How the simulation given describes the data.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct GivenModelValue {
    /// Error on runs with nothing missing, on the measured ones where there are none: rms over spread, percent.
    pub error_percent: f64,
    /// Error on the measured runs.
    pub measured_error_percent: f64,
    /// Whether it is of this bench: of another one nothing is said.
    pub is_of_this_bench: bool,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterValue {
    /// Value.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

/// Error on experiments that the model has not seen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GainValue {
    /// RMS of the base model.
    pub heldout_rms_before: f64,
    /// RMS of the extended model.
    pub heldout_rms_after: f64,
    /// 95 % interval of the difference of both on these experiments, were they measured again.
    pub ci95: [f64; 2],
    /// 95 % interval of the difference on other experiments of these kinds.
    pub ci95_other_experiments: [f64; 2],
    /// Unit.
    pub unit: String,
}

/// Error of one channel on points that the model has not seen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChannelGainValue {
    /// The channel.
    pub channel: String,
    /// Its unit.
    pub unit: String,
    /// RMS of the base model, in that unit.
    pub heldout_rms_before: f64,
    /// RMS of the extended model.
    pub heldout_rms_after: f64,
    /// Both over the standard deviations of the readings.
    pub in_deviations: [f64; 2],
}

/// Another cause in the place of one that was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedValue {
    /// The cause found.
    pub instead_of: String,
    /// The other cause.
    pub cause: String,
    /// Chi-square above that of the cause found.
    pub delta_chi2: f64,
    /// `delta_chi2` from which on the two are distinguished.
    pub discrimination_threshold: f64,
}

/// One row of the screening.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScreenValue {
    /// The cause.
    pub cause: String,
    /// Drop of chi-square that its effect could bring.
    pub score: f64,
    /// Share of the effect that the base model absorbs.
    pub absorbed: f64,
    /// The cause that looks most alike.
    pub most_confused_with: String,
    /// Cosine between both.
    pub cosine: f64,
}

/// Names of the causes found, best first, then of those that may be one of them instead.
pub fn names(finding: &Finding, candidates: &[Candidate]) -> Vec<String> {
    let alternatives = finding.causes.iter().flat_map(|found| &found.alternatives);
    let all = finding.causes.iter().map(|found| found.candidate);
    let mut names: Vec<String> = Vec::new();
    for candidate in all.chain(alternatives.map(|other| other.candidate)) {
        let id = candidates[candidate].id;
        if !names.iter().any(|name| name == id) {
            names.push(id.to_owned());
        }
    }
    names
}

/// Parameters that have a meaning of their own.
fn values(parameters: &[FittedParameter]) -> BTreeMap<String, ParameterValue> {
    let own = parameters.iter().filter(|p| !p.is_shape);
    own.map(|p| {
        (p.name.to_owned(), ParameterValue { value: p.value, unit: p.unit.into(), ci95: p.ci95 })
    })
    .collect()
}

/// A finding with what the findings say of it besides.
#[derive(Debug)]
pub struct Told<'a> {
    /// The finding.
    pub finding: &'a Finding,
    /// The candidates, in their order.
    pub candidates: &'a [Candidate],
    /// Names of the experiments, in their order.
    pub runs: &'a [String],
    /// Kind of the data.
    pub data_kind: &'static str,
    /// Unit of the errors of [`Findings::gain`].
    pub gain_unit: String,
    /// What to measure next.
    pub next_experiment: String,
}

/// Share of its threshold from which on a cause may be there and hidden.
const MAY_BE_HIDDEN: f64 = 0.5;

impl Told<'_> {
    fn id(&self, candidate: usize) -> String {
        self.candidates[candidate].id.to_owned()
    }

    /// Causes that these data could not have shown at usual strength; and, where nothing is named, those
    /// that would explain a good part of the misfit and stay within what surrogates reach.
    pub fn not_observable(&self) -> Vec<String> {
        let unnamed = self.finding.causes.is_empty();
        self.candidates
            .iter()
            .zip(&self.finding.screen)
            // what the data refute they have shown; what has no name is not asked for
            .filter(|(candidate, _)| candidate.refuted.is_none() && candidate.decoy.is_none())
            .filter(|(candidate, screened)| {
                let hidden = MAY_BE_HIDDEN * screened.threshold..screened.threshold;
                candidate.blocked.is_some()
                    || screened.weak_signal < screened.threshold
                    || (unnamed && hidden.contains(&screened.score))
            })
            .map(|(candidate, _)| candidate.id.to_owned())
            .collect()
    }

    /// Parameters of every cause that it may be, were it the one.
    fn parameters(&self) -> BTreeMap<String, BTreeMap<String, ParameterValue>> {
        let mut parameters = BTreeMap::new();
        for found in &self.finding.causes {
            parameters.insert(self.id(found.candidate), values(&found.parameters));
            for other in &found.alternatives {
                let own = || values(&other.parameters);
                parameters.entry(self.id(other.candidate)).or_insert_with(own);
            }
        }
        parameters
    }

    fn compared(&self) -> Vec<ComparedValue> {
        let of_one = self.finding.causes.iter().flat_map(|found| {
            found.compared.iter().map(|other| ComparedValue {
                instead_of: self.id(found.candidate),
                cause: self.id(other.candidate),
                delta_chi2: other.delta_chi2,
                discrimination_threshold: other.discrimination_threshold,
            })
        });
        of_one.collect()
    }

    fn screen(&self) -> Vec<ScreenValue> {
        let one = |(c, s): (usize, &Screened)| ScreenValue {
            cause: self.id(c),
            score: s.score,
            absorbed: s.absorbed,
            most_confused_with: s.most_confused.map(|m| self.id(m.0)).unwrap_or_default(),
            cosine: s.most_confused.map_or(0.0, |m| m.1),
        };
        self.finding.screen.iter().enumerate().map(one).collect()
    }

    /// The findings, without a simulation given beside the data and without gains by channel.
    pub fn findings(self) -> Findings {
        let finding = self.finding;
        let is_unknown = finding.verdict == Verdict::Unknown;
        let causes = if is_unknown { Vec::new() } else { names(finding, self.candidates) };
        let parameters = if is_unknown { BTreeMap::new() } else { self.parameters() };
        let named =
            self.candidates.iter().zip(&finding.limits).filter(|(own, _)| own.decoy.is_none());
        let would_have_shown = named.map(|(own, limit)| (own.id.to_owned(), *limit)).collect();
        let class = finding.class.as_ref();
        let members = class.map(|own| own.members.iter().map(|&c| self.id(c)).collect());
        let mut not_observable = self.not_observable();
        not_observable.retain(|id| !causes.contains(id));
        let run = |experiment: usize| self.runs[experiment].clone();
        let band = |band: &BandLeft| BandValue {
            run: run(band.experiment),
            low_hz: band.low_hz,
            high_hz: band.high_hz,
            times: band.times,
            coherence: band.coherence,
        };
        let gain = finding.gain.map(|gain| GainValue {
            heldout_rms_before: gain.rms_before,
            heldout_rms_after: gain.rms_after,
            ci95: gain.drop_ci95,
            ci95_other_experiments: gain.drop_elsewhere_ci95,
            unit: self.gain_unit.clone(),
        });
        Findings {
            data_kind: self.data_kind,
            verdict: finding.verdict,
            causes,
            confidence: finding.confidence,
            class: class.map(|own| own.class),
            class_members: members.unwrap_or_default(),
            class_confidence: class.map(|own| own.confidence),
            parameters,
            structure_remains: finding.structure_remains,
            standing_out: finding.standing_out.iter().map(|own| run(own.experiment)).collect(),
            bands_left: finding.bands_left.iter().map(band).collect(),
            given_model: None,
            gain,
            gain_by_channel: Vec::new(),
            compared: self.compared(),
            not_observable,
            would_have_shown,
            screen: self.screen(),
            next_experiment: self.next_experiment,
        }
    }
}
