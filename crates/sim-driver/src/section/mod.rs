//! `hhc section`: responses of a section with a trailing-edge flap.
//!
//! | response | what | module |
//! |---|---|---|
//! | harmonic | complex amplitudes at one frequency | here |
//! | step, ramp | history after a unit step, or a unit ramp over a distance | `history` |
//! | loop | one cycle of a motion that repeats, with dynamic stall on request | `history` |
//! | polar | static curve: linear, stalled after Kirchhoff, or of a C81 file | `polar` |

mod history;
mod polar;

pub use history::{LoopQuestion, TransientQuestion, loop_history, transient_history};
pub use polar::{PolarQuestion, polar};

use crate::SimError;
use crate::output::{Printable, table};
use flap_aero::{
    AttachedFlowModel, FlapChord, FlapEffectiveness, Mach, ModelRemarks, Motion,
    SectionCoefficients, harmonic_response,
};
use serde::Serialize;

/// Largest reduced frequency of a question: far beyond what a section can do, and far from overflow.
const FASTEST: f64 = 1e3;
/// Largest reduced frequency whose error the calibration bounds.
const FASTEST_CALIBRATED: f64 = 1.0;
/// Mach number to which linear theory is good.
const FASTEST_LINEAR: f64 = 0.7;

/// A section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionChoice {
    /// Section model.
    pub model: AttachedFlowModel,
    /// Mach number.
    pub mach: f64,
    /// Flap chord over chord.
    pub flap_chord: f64,
    /// How much of theory's flap the flap is.
    pub effectiveness: FlapEffectiveness,
}

impl SectionChoice {
    /// The section's coefficients, Mach number and flap.
    ///
    /// # Errors
    /// [`SimError::Section`] for a Mach number or flap chord outside the model.
    pub fn coefficients(&self) -> Result<(SectionCoefficients, Mach, FlapChord), SimError> {
        let mach = Mach::new(self.mach)?;
        let flap = FlapChord::new(self.flap_chord)?;
        let section = self.model.coefficients(mach, flap)?;
        Ok((section.with_flap_effectiveness(&self.effectiveness), mach, flap))
    }

    /// What a reader of a response has to know: where the model left its own form, and how far it is
    /// from exact theory where that is far.
    ///
    /// `reduced_frequency` is that of a harmonic motion; a step or a ramp has none.
    fn remarks(
        &self,
        remarks: &ModelRemarks,
        motion: Motion,
        reduced_frequency: Option<f64>,
    ) -> Vec<&'static str> {
        let unmatched = remarks.slope_unmatched.iter().flatten().any(|unmatched| *unmatched);
        let flap = motion == Motion::Flap;
        let of = |model| self.model == model;
        let reconstructed = of(AttachedFlowModel::HariharanLeishman);
        let steady = reduced_frequency.is_some_and(|k| k <= 0.0);
        let fast = reduced_frequency.is_some_and(|k| k > FASTEST_CALIBRATED);
        [
            (flap && self.flap_chord <= 0.0, "the section has no flap"),
            (
                reconstructed && flap && !steady,
                "this form is about 30 % off exact theory in the lift of a flap; the calibrated \
                 model is within 3 %",
            ),
            (
                of(AttachedFlowModel::Calibrated) && fast,
                "the bounds of the calibration hold for reduced frequencies to 1",
            ),
            (
                self.mach > FASTEST_LINEAR && !of(AttachedFlowModel::QuasiSteady),
                "linear theory is good to about Mach 0.7",
            ),
            (
                remarks.mach_floored,
                "the noncirculatory loads are those of a small Mach number above 0",
            ),
            (
                remarks.mach_capped,
                "the coefficients are those of the highest Mach number calibrated",
            ),
            (
                unmatched,
                "an initial slope could not be matched: its time constant is the smallest used",
            ),
        ]
        .into_iter()
        .filter_map(|(applies, text)| applies.then_some(text))
        .collect()
    }
}

/// What is asked of a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionQuestion {
    /// The section.
    pub section: SectionChoice,
    /// Reduced frequency `k = omega c / (2 U)`, 0 and up.
    pub reduced_frequency: f64,
    /// Motion of unit amplitude.
    pub motion: Motion,
}

/// Complex amplitudes per radian (plunge: per unit of `h_dot / U`, down positive) as `[re, im]`;
/// moments on the full chord squared, about the quarter chord and the hinge.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SectionResult {
    /// The model and where it comes from; not in the JSON, whose form is fixed.
    #[serde(skip)]
    pub model: &'static str,
    /// Where the model had to leave its own form to give an answer; not in the JSON.
    #[serde(skip)]
    pub remarks: Vec<&'static str>,
    /// Normal force coefficient.
    pub cn: [f64; 2],
    /// Moment coefficient about the quarter chord, nose-up positive.
    pub cm: [f64; 2],
    /// Hinge-moment coefficient, positive in the sense of the flap angle.
    pub ch: [f64; 2],
}

/// Answers a question about a section.
///
/// # Errors
/// [`SimError::Section`] for a Mach number, flap chord or frequency outside the model.
pub fn section_response(question: &SectionQuestion) -> Result<SectionResult, SimError> {
    let k = question.reduced_frequency;
    within("reduced frequency", k, (0.0..=FASTEST).contains(&k), "0 to 1000")?;
    let (section, ..) = question.section.coefficients()?;
    let [cn, cm, ch] =
        harmonic_response(&section, k, question.motion).map(|value| [value.re, value.im]);
    let model = question.section.model.title();
    let remarks = question.section.remarks(&section.remarks, question.motion, Some(k));
    Ok(SectionResult { model, remarks, cn, cm, ch })
}

impl Printable for SectionResult {
    fn text(&self) -> String {
        let rows = [
            ("Cn, normal force", self.cn),
            ("Cm, about c/4", self.cm),
            ("Ch, about the hinge", self.ch),
        ];
        let loads = table(
            &["per radian (plunge: per h_dot/U)", "real", "imaginary", "amplitude", "lag, deg"],
            rows.map(|(name, [re, im])| {
                // 0 less the part: no lag of -0 or -180 deg where there is none
                let lag = (0.0 - im).atan2(re).to_degrees();
                let amplitude = re.hypot(im);
                vec![
                    name.to_owned(),
                    format!("{re:.6}"),
                    format!("{im:.6}"),
                    format!("{amplitude:.6}"),
                    format!("{lag:.2}"),
                ]
            }),
        );
        format!("Model: {}\n{}{loads}", self.model, notes(&self.remarks))
    }
}

/// A table of numbers with named columns: a history or a curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SectionTable {
    /// What the table shows.
    pub title: String,
    /// Where the model had to leave its own form, and how far off it is; not in the JSON.
    #[serde(skip)]
    pub remarks: Vec<&'static str>,
    /// Names of the columns, with units.
    pub columns: Vec<&'static str>,
    /// The rows.
    pub rows: Vec<Vec<f64>>,
}

fn notes(remarks: &[&'static str]) -> String {
    remarks.iter().flat_map(|remark| ["Note: ", remark, "\n"]).collect()
}

/// Rows a person is shown; a file or JSON has all of them.
const SHOWN: usize = 40;

impl SectionTable {
    /// The table as CSV, one line of names and one per row, in full precision.
    pub fn csv(&self) -> String {
        let line = |cells: Vec<String>| cells.join(",") + "\n";
        let head = line(self.columns.iter().map(|name| (*name).to_owned()).collect());
        let rows = self.rows.iter().map(|row| line(row.iter().map(f64::to_string).collect()));
        std::iter::once(head).chain(rows).collect()
    }
}

impl SectionResult {
    /// The amplitudes as CSV.
    pub fn csv(&self) -> String {
        let rows = [("cn", self.cn), ("cm", self.cm), ("ch", self.ch)];
        let lines = rows.map(|(name, [re, im])| format!("{name},{re},{im}\n"));
        format!("load,re,im\n{}", lines.concat())
    }
}

impl Printable for SectionTable {
    fn text(&self) -> String {
        let every = self.rows.len().div_ceil(SHOWN).max(1);
        let rows = self.rows.iter().step_by(every);
        let cells = rows.map(|row| row.iter().map(|value| format!("{value:.6}")).collect());
        let notes = notes(&self.remarks);
        format!("{}\n{notes}{}", self.title, table(&self.columns, cells))
    }
}

/// Refuses a number that does not fit.
fn within(
    quantity: &'static str,
    value: f64,
    fits: bool,
    expected: &'static str,
) -> Result<(), SimError> {
    if fits && value.is_finite() {
        return Ok(());
    }
    Err(flap_aero::AeroError::BadInput { quantity, value, expected }.into())
}
