//! Which of the fitted models is used.

use super::intervals::{KnownQuantity, known_quantities};
use super::{BenchIdentification, dataset_place};
use crate::BenchError;
use actuator_gap::judged;
use measured_data::problem::{Fault, Problem};
use preisach_dyn::identify::{Estimate, Family, LeftOut, ModelRow, Order, Settings};
use serde::Serialize;

/// The family of models that `hhc identify` writes; none leaves it to cross-validation.
pub type ModelChoice = Option<Family>;

/// Why a model is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PickReason {
    /// No other one was fitted.
    OnlyFit,
    /// Cross-validation over the training runs chose it.
    CrossValidation,
    /// Blocks in time of the only training run, left out of the fit in turn, chose it.
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
    row: Option<ModelRow>,
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

    /// Takes a model of the comparison in the place of the dynamic Preisach model and judges it.
    /// Nothing happens without a [`comparison`](Self::comparison).
    ///
    /// # Errors
    /// [`BenchError::Data`] if the model asked for could not be fitted, with the reason and the
    /// models that could; those of [`super::identify_bench`].
    pub fn pick(&mut self, choice: ModelChoice) -> Result<(), BenchError> {
        let Some(table) = &self.comparison else { return Ok(()) };
        let chosen = match choice {
            Some(family) => table.rows.iter().find(|row| row.family == family),
            None => table.best(),
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
