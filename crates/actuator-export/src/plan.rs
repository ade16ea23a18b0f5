//! What is exported, told apart from the language: the law, the stages, their numbers.

use crate::constant::Constant;
use crate::laws::Law;
use crate::stages::{self, List, Stage};
use crate::{ExportError, name, remarks};
use preisach_dyn::{ActuatorModel, HysteresisLaw, StartState};

/// Everything that a generated file says.
pub(crate) struct Plan<'a> {
    pub(crate) model: &'a ActuatorModel,
    pub(crate) name: &'a str,
    pub(crate) time_step_s: f64,
    pub(crate) law: Law,
    /// In the order of the chain.
    pub(crate) amplifier: Vec<Stage>,
    /// In the order of the chain.
    pub(crate) linkage: Vec<Stage>,
    /// Time step, range, tolerances.
    pub(crate) common: Vec<Constant>,
}

/// How far beyond the range a voltage still passes, as a fraction of the span: what
/// [`ActuatorModel::simulate`] lets pass.
const BEYOND: f64 = 0.005;

/// Tolerance of the inverse, as a fraction of the law's stroke.
const TOLERANCE: f64 = 1e-12;

/// As far from a wanted angle the start of a wanted history may lie, as a fraction of the stroke.
const REST_TOLERANCE: f64 = 1e-9;

impl<'a> Plan<'a> {
    pub(crate) fn new(
        model: &'a ActuatorModel,
        name: &'a str,
        time_step_s: f64,
    ) -> Result<Self, ExportError> {
        name::check(name)?;
        if !(time_step_s.is_finite() && time_step_s > 0.0) {
            return Err(ExportError::TimeStep { time_step_s });
        }
        model.check_stages()?;
        let law = Law::new(&model.law, time_step_s)?;
        let amplifier = stages::amplifier(model, time_step_s)?;
        let linkage = stages::linkage(model, time_step_s)?;
        let common = common(model, time_step_s);
        let plan = Self { model, name, time_step_s, law, amplifier, linkage, common };
        plan.constants().try_for_each(Constant::check)?;
        Ok(plan)
    }

    /// All stages, amplifier first.
    pub(crate) fn stages(&self) -> impl DoubleEndedIterator<Item = &Stage> {
        self.amplifier.iter().chain(&self.linkage)
    }

    /// The stages of one list.
    pub(crate) fn list(&self, list: List) -> &[Stage] {
        match list {
            List::Amplifier => &self.amplifier,
            List::Linkage => &self.linkage,
        }
    }

    fn constants(&self) -> impl Iterator<Item = &Constant> {
        let stages = self.stages().flat_map(|stage| &stage.constants);
        self.law.constants.iter().chain(stages).chain(&self.common)
    }

    /// What it is, for the head of a file.
    pub(crate) fn about(&self) -> Vec<String> {
        let mut lines = vec![format!("Law: {}.", self.law.title)];
        lines.extend(self.law.equation.iter().map(|line| format!("    {line}")));
        for stage in self.stages() {
            lines.push(format!("{}: {}.", stage.place, stage.kind.title()));
            lines.extend(stage.kind.equation().iter().map(|line| format!("    {line}")));
        }
        for remark in remarks(self.model) {
            lines.push(String::new());
            lines.extend(broken(&remark, 88));
        }
        lines
    }

    /// What the templates of every language name, with its value.
    pub(crate) fn words(&self) -> [(&'static str, String); 7] {
        let range = self.model.range_volt;
        [
            ("name", self.name.to_owned()),
            ("NAME", self.name.to_uppercase()),
            ("time_step_s", crate::constant::number(self.time_step_s)),
            ("lowest_volt", range.lowest_volt().to_string()),
            ("highest_volt", range.highest_volt().to_string()),
            ("middle_volt", crate::constant::number(range.middle_volt())),
            ("title", self.law.title.to_owned()),
        ]
    }
}

fn common(model: &ActuatorModel, time_step_s: f64) -> Vec<Constant> {
    let range = model.range_volt;
    let rest = |volt| model.law.start(volt, StartState::Rest).1;
    let [low, high] = [range.lowest_volt(), range.highest_volt()].map(rest);
    let size = (high - low).abs().max(low.abs()).max(high.abs());
    let scalar = Constant::scalar;
    vec![
        scalar("TIME_STEP_S", time_step_s, "s", "time from one sample to the next"),
        scalar("LOWEST_VOLT", range.lowest_volt(), "V", "lower end of the command range"),
        scalar("HIGHEST_VOLT", range.highest_volt(), "V", "upper end of the command range"),
        scalar(
            "BEYOND_VOLT",
            BEYOND * range.span_volt(),
            "V",
            "how far beyond it a command passes",
        ),
        scalar("TOLERANCE_DEG", TOLERANCE * size, "deg", "to which the law is inverted"),
        scalar(
            "REST_TOLERANCE_DEG",
            REST_TOLERANCE * size,
            "deg",
            "of the start of a wanted history",
        ),
    ]
}

/// A sentence in lines of at most `width` characters.
pub(crate) fn broken(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.len() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
