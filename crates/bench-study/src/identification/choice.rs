//! Which of the fitted models is used.

use super::intervals::{KnownQuantity, known_quantities};
use super::{BenchIdentification, dataset_place};
use crate::BenchError;
use actuator_gap::judged;
use measured_data::problem::{Fault, Problem};
use preisach_dyn::identify::{
    Estimate, Family, Finding, LeftOut, ModelRow, Order, RecordUse, Settings,
};
use serde::Serialize;

/// The family of models that `hhc identify` writes; none leaves it to cross-validation.
pub type ModelChoice = Option<Family>;

/// Share of the error of the model picked that another one leaves of held-out runs to be named, and the least difference, percent.
const FAR_BETTER: f64 = 0.5;
const LEAST_GAIN_PERCENT: f64 = 1.0;

/// Why a model is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PickReason {
    /// No other one was fitted.
    OnlyFit,
    /// Cross-validation over the training runs chose it.
    CrossValidation,
    /// Blocks in time of the only or the largest training run, left out of the fit in turn, chose it.
    BlocksInTime,
    /// Too few training runs to leave one out: there is nothing to choose by.
    NothingToChooseBy,
    /// It was asked for.
    AskedFor,
}

/// The model used: which, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Pick {
    /// Its family.
    pub family: Family,
    /// Order of its memory, where it has one.
    pub order: Order,
    /// Why this one.
    pub reason: PickReason,
    /// Its parameters found by output error, as the fit holds them, with their standard deviations.
    pub parameters: Vec<Estimate>,
    /// Its row in the comparison; none if there was none.
    pub(super) row: Option<ModelRow>,
}

impl Pick {
    /// The dynamic Preisach model of an identification that compared no others.
    pub(super) fn first_fit(settings: &Settings) -> Self {
        let family = Family::DynamicPreisach;
        let (order, parameters) = (Order::of(settings), vec![]);
        Self { family, order, reason: PickReason::OnlyFit, parameters, row: None }
    }
}

impl BenchIdentification {
    /// The physical quantities of the model picked from a comparison, with intervals; empty without one.
    pub(super) fn known_quantities(&self) -> Vec<KnownQuantity> {
        let both = self.comparison.as_ref().zip(self.pick.row.as_ref());
        both.map_or_else(Vec::new, |(table, row)| {
            known_quantities(table, row, &self.records, &self.settings)
        })
    }

    /// The model by which held-out runs are far better foretold than by the one picked.
    pub(super) fn better_held_out(&self) -> Option<Finding> {
        let (table, own) = (self.comparison.as_ref()?, self.pick.row.as_ref()?);
        let percent = |row: &ModelRow| Some(100.0 * table.error_over(row, RecordUse::HeldOut)?.0);
        let chosen_percent = percent(own)?;
        let others = table.rows.iter().filter(|row| row.family != own.family);
        let errors = others.filter_map(|row| Some((row.family, percent(row)?)));
        let (family, nrmse_percent) = errors.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let is_far = nrmse_percent <= FAR_BETTER * chosen_percent
            && chosen_percent - nrmse_percent >= LEAST_GAIN_PERCENT;
        let model = family.name().to_owned();
        is_far.then_some(Finding::BetterHeldOut { model, nrmse_percent, chosen_percent })
    }

    /// Takes a model of the comparison in the place of the dynamic Preisach model and judges it.
    /// Nothing happens without a [`comparison`](Self::comparison).
    ///
    /// # Errors
    /// [`BenchError::Data`] if the model asked for could not be fitted, with the reason and the
    /// models that could; those of [`super::identify_bench`].
    pub fn pick(&mut self, choice: ModelChoice) -> Result<(), BenchError> {
        let Some(table) = &self.comparison else { return Ok(()) };
        let best = table.best();
        let chosen = match choice {
            // the order of its memory that was chosen, where one was
            Some(family) => best
                .filter(|row| row.family == family)
                .or_else(|| table.rows.iter().find(|row| row.family == family)),
            None => best,
        };
        let place = || dataset_place(&self.heading.folder);
        let row = chosen.cloned();
        let Some(ModelRow { family, order, cross_validation, fitted, .. }) = chosen else {
            let Some(family) = choice else { return Ok(()) };
            let message = format!(
                "{} was left out: no training run shows a mode beyond a lag; train by a run through the resonance, \
                 or ask for the model with --only",
                family.name()
            );
            return Err(Problem::new(place(), Fault::Refused { message }).into());
        };
        let fitted = match fitted {
            Ok(fitted) => fitted,
            Err(error) => {
                let could = table.rows.iter().filter(|row| row.fitted.is_ok());
                let could: Vec<&str> = could.map(|row| row.family.name()).collect();
                let message = format!(
                    "{} cannot be fitted to these runs: {}; choose another --model, fitted were: {}",
                    family.name(),
                    self.heading.subject().error(error),
                    if could.is_empty() { "none".to_owned() } else { could.join("; ") }
                );
                return Err(Problem::new(place(), Fault::Refused { message }).into());
            }
        };
        let reason = match (choice, cross_validation) {
            // orders of one family may have been compared all the same
            (None, _) if table.left_out == LeftOut::Nothing => PickReason::NothingToChooseBy,
            (None, Some(_)) if table.left_out == LeftOut::Blocks => PickReason::BlocksInTime,
            (None, Some(_)) => PickReason::CrossValidation,
            (None, None) => PickReason::NothingToChooseBy,
            _ => PickReason::AskedFor,
        };
        let parameters = fitted.parameters.clone();
        self.pick = Pick { family: *family, order: *order, reason, parameters, row };
        self.model = fitted.model.clone();
        let fits = judged(&self.records, &self.identification, &self.model);
        self.fits = fits.map_err(|e| self.heading.misjudged(e))?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Comparing, identify_bench};
    use super::*;
    use crate::test_bench::PlaysBench;
    use measured_data::BenchData;

    /// A large and a small run that train and one between them that does not.
    fn bench() -> BenchData {
        let (train, held_out) = (RecordUse::Train, RecordUse::HeldOut);
        PlaysBench {
            runs: &[(50.0, train), (12.0, train), (25.0, held_out)],
            half_widths_volt: &[5.0, 15.0, 30.0],
            after_zero: false,
            noise_um: 0.0,
        }
        .data()
    }

    /// Said of a line beside plays, not of plays beside a line.
    #[test]
    fn a_model_that_foretells_held_out_runs_far_better_is_named() {
        let families = &[Family::Linear, Family::PrandtlPlays];
        let only = Some(Comparing { families, done: &|| () });
        let mut found = identify_bench(&bench(), &Settings::default(), only).unwrap();
        found.pick(Some(Family::Linear)).unwrap();
        let Some(Finding::BetterHeldOut { model, nrmse_percent, chosen_percent }) =
            found.better_held_out()
        else {
            panic!("nothing is said")
        };
        assert_eq!(model, Family::PrandtlPlays.name());
        assert!(nrmse_percent < 1.0 && chosen_percent > 5.0, "{nrmse_percent} {chosen_percent}");
        let said = |f: &super::super::FindingLine| f.message.contains("far better foretold");
        assert!(found.summary(None).findings.iter().any(said));
        found.pick(None).unwrap();
        assert_eq!(found.pick.family, Family::PrandtlPlays);
        assert_eq!(found.better_held_out(), None);
    }

    /// The line of the model picked and what is said of its runs are of one fit, whatever order of its memory was chosen; a
    /// family asked for by its name has the order that was chosen for it.
    #[test]
    fn the_table_and_the_headline_tell_one_error() {
        let families = &[Family::Linear, Family::StaticPreisach];
        let only = Some(Comparing { families, done: &|| () });
        let mut found = identify_bench(&bench(), &Settings::default(), only).unwrap();
        let usual = Order::of(&Settings::default());
        for choice in [None, Some(Family::StaticPreisach), Some(Family::Linear)] {
            found.pick(choice).unwrap();
            // of the usual order both would agree in any case
            assert_eq!(found.pick.order != usual, choice != Some(Family::Linear), "{choice:?}");
            let summary = found.summary(None);
            let line = summary.models.iter().find(|line| line.model == summary.model).unwrap();
            let held_out =
                summary.runs.iter().find(|run| run.use_as == RecordUse::HeldOut).unwrap();
            let (of_line, of_run) = (line.held_out_percent.unwrap(), held_out.nrmse_percent);
            assert!((of_line - of_run).abs() <= 1e-6 * of_run, "{choice:?}: {of_line} {of_run}");
            assert_eq!(line.levels, summary.levels);
        }
    }
}
