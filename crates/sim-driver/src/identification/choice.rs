//! Which of the fitted models is used.

use super::{BenchIdentification, judge};
use crate::SimError;
use crate::problem::{Fault, Place, Problem};
use preisach_dyn::identify::{Estimate, Family, ModelRow, Order, Settings};
use serde::Serialize;

/// The model that `hhc identify` writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum ModelChoice {
    /// The one that cross-validation over the training runs chooses.
    #[default]
    Best,
    /// A gain.
    Linear,
    /// A gain behind a first-order lag of the voltage.
    LinearLag,
    /// Bouc-Wen, rate-independent.
    BoucWen,
    /// Prandtl-Ishlinskii whose half-widths grow with the voltage rate.
    PrandtlIshlinskii,
    /// Prandtl-Ishlinskii stops: the output leads.
    PrandtlStop,
    /// Static Preisach.
    StaticPreisach,
    /// Dynamic Preisach, first order in time.
    DynamicPreisachFirst,
    /// Dynamic Preisach, second order in time: the paper's model.
    DynamicPreisach,
    /// Dynamic Preisach before creep.
    DynamicPreisachCreep,
    /// Static Preisach before accommodation, relaxation and creep.
    StaticPreisachRelaxation,
}

impl ModelChoice {
    /// The family asked for; none leaves it to cross-validation.
    pub fn family(self) -> Option<Family> {
        Some(match self {
            Self::Best => return None,
            Self::Linear => Family::Linear,
            Self::LinearLag => Family::LinearLag,
            Self::BoucWen => Family::BoucWen,
            Self::PrandtlIshlinskii => Family::PrandtlIshlinskii,
            Self::PrandtlStop => Family::PrandtlStop,
            Self::StaticPreisach => Family::StaticPreisach,
            Self::DynamicPreisachFirst => Family::DynamicPreisachFirst,
            Self::DynamicPreisach => Family::DynamicPreisach,
            Self::DynamicPreisachCreep => Family::DynamicPreisachCreep,
            Self::StaticPreisachRelaxation => Family::StaticPreisachRelaxation,
        })
    }
}

/// Why a model is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PickReason {
    /// No other one was fitted.
    OnlyFit,
    /// Cross-validation over the training runs chose it.
    CrossValidation,
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
}

impl Pick {
    /// The dynamic Preisach model of an identification that compared no others.
    pub(super) fn first_fit(settings: &Settings) -> Self {
        let family = Family::DynamicPreisach;
        let (order, parameters) = (Order::of(settings), vec![]);
        Self { family, order, reason: PickReason::OnlyFit, parameters }
    }
}

impl BenchIdentification {
    /// Takes a model of the comparison in the place of the dynamic Preisach model and judges it.
    /// Nothing happens before [`Self::compare`].
    ///
    /// # Errors
    /// [`SimError::Rejected`] if the model asked for could not be fitted, with the reason and the
    /// models that could; those of [`super::identify_bench`].
    pub fn pick(&mut self, choice: ModelChoice) -> Result<(), SimError> {
        let Some(table) = &self.comparison else { return Ok(()) };
        let chosen = match choice.family() {
            Some(family) => table.rows.iter().find(|row| row.family == family),
            None => table.best(),
        };
        let Some(ModelRow { family, order, cross_validation, fitted }) = chosen else {
            return Ok(());
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
                let place = Place::file(format!("{}/dataset.ron", self.heading.folder));
                return Err(Problem::new(place, Fault::Refused { message }).into());
            }
        };
        let reason = match (choice, cross_validation) {
            (ModelChoice::Best, Some(_)) => PickReason::CrossValidation,
            (ModelChoice::Best, None) => PickReason::NothingToChooseBy,
            _ => PickReason::AskedFor,
        };
        let parameters = fitted.parameters.clone();
        self.pick = Pick { family: *family, order: *order, reason, parameters };
        self.model = fitted.model.clone();
        self.fits = judge::judged(&self.heading, &self.records, &self.identification, &self.model)?;
        Ok(())
    }
}
