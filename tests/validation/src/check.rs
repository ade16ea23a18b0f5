//! A check, its bound, and the row it leaves.

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::Failure;

/// How far a quantity may be from its reference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Criterion {
    /// Near a reference value.
    Near {
        /// The reference value.
        expected: f64,
        /// Largest distance, in the unit of the quantity.
        within: f64,
    },
    /// Not above a limit: errors and residuals.
    AtMost(f64),
    /// Not below a limit: what must be visibly wrong without the effect.
    AtLeast(f64),
    /// In an interval: orders of convergence.
    Between(f64, f64),
}

impl Criterion {
    /// Whether a value passes; a NaN does not.
    pub fn admits(&self, got: f64) -> bool {
        match *self {
            Self::Near { expected, within } => (got - expected).abs() <= within,
            Self::AtMost(limit) => got <= limit,
            Self::AtLeast(limit) => got >= limit,
            Self::Between(low, high) => (low..=high).contains(&got),
        }
    }

    /// The width against which changes from machine to machine are judged.
    pub fn width(&self) -> f64 {
        match *self {
            Self::Near { within, .. } => within,
            Self::AtMost(limit) | Self::AtLeast(limit) => limit.abs(),
            Self::Between(low, high) => 0.5 * (high - low),
        }
    }
}

/// Whether a figure is the same on every machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Repeatability {
    /// Up to rounding.
    Everywhere,
    /// Depends on rounding or time: shown, judged, and never a reason to call the page stale.
    MachineDependent,
}

/// Computes a quantity.
pub type Measure = fn() -> Result<f64, Failure>;

/// A quantity with its reference, its bound and the way to compute it; begun by [`row`].
#[derive(Debug, Clone, Copy)]
pub struct Check {
    pub(crate) id: &'static str,
    quantity: &'static str,
    unit: &'static str,
    source: &'static str,
    criterion: Criterion,
    repeatability: Repeatability,
    pub(crate) is_long: bool,
    measure: Measure,
}

/// A check without its bound.
#[derive(Debug, Clone, Copy)]
pub struct Draft {
    id: &'static str,
    quantity: &'static str,
    unit: &'static str,
    source: &'static str,
}

/// Begins a check: id `V-AREA-NN`, what is measured, unit of value and bound.
pub const fn row(id: &'static str, quantity: &'static str, unit: &'static str) -> Draft {
    Draft { id, quantity, unit, source: "" }
}

impl Draft {
    /// Where the reference is from.
    #[must_use]
    pub const fn against(self, source: &'static str) -> Self {
        Self { source, ..self }
    }

    /// An error or residual not above a limit.
    pub const fn at_most(self, limit: f64, measure: Measure) -> Check {
        self.kept(Criterion::AtMost(limit), measure)
    }

    /// What must be visible: not below a limit.
    pub const fn at_least(self, limit: f64, measure: Measure) -> Check {
        self.kept(Criterion::AtLeast(limit), measure)
    }

    /// In an interval.
    pub const fn between(self, low: f64, high: f64, measure: Measure) -> Check {
        self.kept(Criterion::Between(low, high), measure)
    }

    /// Near a reference value.
    pub const fn near(self, expected: f64, within: f64, measure: Measure) -> Check {
        self.kept(Criterion::Near { expected, within }, measure)
    }

    /// A figure that is shown, not demanded: it stays within what was computed when it was written down.
    pub const fn shown(self, written: f64, within: f64, measure: Measure) -> Check {
        Check {
            repeatability: Repeatability::MachineDependent,
            ..self.near(written, within, measure)
        }
    }

    /// With a bound.
    pub const fn kept(self, criterion: Criterion, measure: Measure) -> Check {
        let Self { id, quantity, unit, source } = self;
        let repeatability = Repeatability::Everywhere;
        Check { id, quantity, unit, source, criterion, repeatability, is_long: false, measure }
    }
}

impl Check {
    /// A figure that is not the same on every machine.
    #[must_use]
    pub const fn machine_dependent(self) -> Self {
        Self { repeatability: Repeatability::MachineDependent, ..self }
    }

    /// A check too long for every change: computed where [`LONG`](crate::LONG) asks for it, as
    /// `cargo xtask validate` does. Elsewhere its row says that it was left out.
    #[must_use]
    pub const fn long(self) -> Self {
        Self { is_long: true, ..self }
    }
}

/// A check that has been done.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Id, `V-AREA-NN`.
    pub id: String,
    /// What was measured.
    pub quantity: String,
    /// Unit of value and bound.
    pub unit: String,
    /// Where the reference is from.
    pub source: String,
    /// The bound.
    pub criterion: Criterion,
    /// Whether the figure is the same everywhere.
    pub repeatability: Repeatability,
    /// The quantity as computed, or why it could not be.
    pub got: Result<f64, String>,
    /// Whether it is long and was left out; `got` then holds no value.
    pub is_left_out: bool,
    /// Time the computation took, s; what rows share counts for the first of them.
    pub seconds: f64,
}

impl Row {
    /// Does a check.
    pub fn of(check: &Check) -> Self {
        let start = Instant::now();
        let got = (check.measure)().map_err(|error| error.to_string());
        let seconds = start.elapsed().as_secs_f64();
        Self { got, is_left_out: false, seconds, ..Self::left_out(check) }
    }

    /// The row of a check that is not done.
    pub fn left_out(check: &Check) -> Self {
        Self {
            id: check.id.to_owned(),
            quantity: check.quantity.to_owned(),
            unit: check.unit.to_owned(),
            source: check.source.to_owned(),
            criterion: check.criterion,
            repeatability: check.repeatability,
            got: Err("left out: `cargo xtask validate` computes it".to_owned()),
            is_left_out: true,
            seconds: 0.0,
        }
    }

    /// Whether the quantity was computed and keeps its bound.
    pub fn passes(&self) -> bool {
        self.got.as_ref().is_ok_and(|got| self.criterion.admits(*got))
    }

    /// Writes the row to `folder`, whole or not at all.
    ///
    /// # Errors
    /// If the folder cannot be made or the file cannot be put in place.
    pub fn write(&self, folder: &Path) -> Result<(), Failure> {
        std::fs::create_dir_all(folder)?;
        let text = ron::ser::to_string_pretty(self, ron::ser::PrettyConfig::default())?;
        let mut file = tempfile::Builder::new().prefix(".new-").tempfile_in(folder)?;
        file.write_all(text.as_bytes())?;
        file.persist(folder.join(format!("{}.ron", self.id)))?;
        Ok(())
    }

    /// The row of an id in `folder`, if it was written there.
    ///
    /// # Errors
    /// If the file is no row.
    pub fn read(folder: &Path, id: &str) -> Result<Option<Self>, Failure> {
        match std::fs::read_to_string(folder.join(format!("{id}.ron"))) {
            Ok(text) => Ok(Some(ron::from_str(&text)?)),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Wanted;

    const EVERY: Wanted = Wanted { folder: None, filter: "", with_long: true };

    #[test]
    fn bounds_hold_on_their_side_and_refuse_what_is_no_number() {
        let criteria = [
            (Criterion::Near { expected: 2.0, within: 0.5 }, 2.5, 1.4),
            (Criterion::AtMost(1.0), -3.0, 1.1),
            (Criterion::AtLeast(1.0), 3.0, 0.9),
            (Criterion::Between(15.0, 17.0), 16.0, 17.1),
        ];
        for (criterion, good, bad) in criteria {
            assert!(criterion.admits(good) && !criterion.admits(bad), "{criterion:?}");
            assert!(!criterion.admits(f64::NAN), "{criterion:?}");
            assert!(criterion.width() > 0.0);
        }
    }

    #[test]
    fn a_row_is_read_as_it_was_written_to_the_last_bit() {
        let folder = tempfile::tempdir().unwrap();
        for got in [0.1 + 0.2, 1.0 / 3.0, f64::MIN_POSITIVE, -4e300] {
            let written =
                Row { got: Ok(got), ..Row::of(&row("id", "q", "m").at_most(0.0, || Ok(0.0))) };
            written.write(folder.path()).unwrap();
            assert_eq!(Row::read(folder.path(), "id").unwrap(), Some(written));
        }
        let broken = Row::of(&row("bad", "q", "m").at_least(1.0, || Err("no \"mode\"".into())));
        broken.write(folder.path()).unwrap();
        assert_eq!(Row::read(folder.path(), "bad").unwrap(), Some(broken));
        assert_eq!(Row::read(folder.path(), "none").unwrap(), None);
    }

    #[test]
    fn a_bound_that_is_not_kept_fails_the_test_and_leaves_its_row() {
        let folder = tempfile::tempdir().unwrap();
        let failure = std::panic::catch_unwind(|| {
            let check = row("V-ACT-01", "quantity", "m").at_most(1.0, || Ok(2.0));
            crate::hold_in(&Wanted { folder: Some(folder.path()), ..EVERY }, &[check]);
        });
        let said = failure.unwrap_err().downcast::<String>().unwrap();
        assert!(said.contains("V-ACT-01, quantity: Ok(2.0)"), "{said}");
        assert_eq!(Row::read(folder.path(), "V-ACT-01").unwrap().unwrap().got, Ok(2.0));
    }

    #[test]
    fn what_the_filter_leaves_out_is_not_computed() {
        let check = row("V-ACT-01", "quantity", "m").at_most(1.0, || Err("computed".into()));
        crate::hold_in(&Wanted { filter: "V-FEM", ..EVERY }, &[check]);
        let held = || crate::hold_in(&Wanted { filter: "V-ACT", ..EVERY }, &[check]);
        assert!(std::panic::catch_unwind(held).is_err());
    }

    #[test]
    fn a_long_check_is_computed_where_it_is_asked_for_and_leaves_a_row_everywhere() {
        let folder = tempfile::tempdir().unwrap();
        let check = row("V-ACT-01", "quantity", "m").at_most(1.0, || Ok(2.0)).long();
        let wanted = Wanted { folder: Some(folder.path()), ..EVERY };
        crate::hold_in(&Wanted { with_long: false, ..wanted }, &[check]);
        let left = Row::read(folder.path(), "V-ACT-01").unwrap().unwrap();
        assert!(left.is_left_out && left.got.is_err() && !left.passes(), "{left:?}");
        let held = || crate::hold_in(&wanted, &[check]);
        assert!(std::panic::catch_unwind(held).is_err());
        let done = Row::read(folder.path(), "V-ACT-01").unwrap().unwrap();
        assert_eq!((done.got, done.is_left_out), (Ok(2.0), false));
    }
}
