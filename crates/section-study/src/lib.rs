//! Responses of a section with a trailing-edge flap: values in, values out.
//!
//! | response | what | module |
//! |---|---|---|
//! | harmonic | complex amplitudes at one frequency | here |
//! | step, ramp | history after a unit step, or a unit ramp over a distance | `history` |
//! | loop | one cycle of a motion that repeats, with dynamic stall on request | `history` |
//! | driven | what histories of incidence and flap angle make | `history` |

mod history;
mod polar;

pub use history::{DrivenQuestion, LoopQuestion, driven_history, loop_history, transient_history};
pub use polar::{PolarQuestion, polar};

use flap_aero::{
    AeroError, AttachedFlowModel, FlapChord, FlapEffectiveness, KNOWN_ERROR_BANDS, Mach, Mode,
    ModelRemarks, Motion, SectionCoefficients, StallAirfoil, harmonic_response,
    known_error_percent,
};
use serde::Serialize;

/// Largest reduced frequency of a question: far beyond what a section can do, and far from overflow.
const FASTEST: f64 = 1e3;
/// Largest reduced frequency whose error the calibration bounds.
const FASTEST_MEASURED: f64 = 1.0;
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
    /// [`AeroError`] for a Mach number or flap chord outside the model.
    pub fn coefficients(&self) -> Result<(SectionCoefficients, Mach, FlapChord), AeroError> {
        let mach = Mach::new(self.mach)?;
        let flap = FlapChord::new(self.flap_chord)?;
        let section = self.model.coefficients(mach, flap)?;
        Ok((section.with_flap_effectiveness(&self.effectiveness), mach, flap))
    }

    /// What a reader of the loads of a history has to know; `motion` is what moves.
    pub fn remarks_in_motion(&self, of_model: &ModelRemarks, motion: Motion) -> Vec<String> {
        self.remarks(of_model, Some(Moved { motion, reduced_frequency: None }))
    }

    /// What a reader of a static curve has to know.
    pub fn remarks_at_rest(&self, of_model: &ModelRemarks) -> Vec<String> {
        self.remarks(of_model, None)
    }

    /// What a reader of a response has to know: where the model left its own form, and how far it is
    /// from exact theory where that is far.
    fn remarks(&self, of_model: &ModelRemarks, moved: Option<Moved>) -> Vec<String> {
        let fast = moved.is_some_and(|m| m.reduced_frequency.is_some_and(|k| k > FASTEST_MEASURED));
        let mut remarks: Vec<String> = [
            (moved.is_some_and(|m| self.lacks_flap(m)), "the section has no flap"),
            (
                self.model == AttachedFlowModel::Calibrated && fast,
                "the bounds of the calibration hold for reduced frequencies to 1",
            ),
            (
                self.mach > FASTEST_LINEAR,
                "linear theory is good to about Mach 0.7: it knows no shocks",
            ),
            (
                of_model.mach_floored,
                "the noncirculatory loads are those of a small Mach number above 0",
            ),
            (
                of_model.mach_capped,
                "the coefficients are those of the highest Mach number calibrated",
            ),
        ]
        .into_iter()
        .filter(|(applies, _)| *applies)
        .map(|(_, text)| text.to_owned())
        .collect();
        // what is held at a frequency of 0 is no motion
        let moved = moved.filter(|m| m.reduced_frequency.is_none_or(|k| k > 0.0));
        remarks.extend(moved.and_then(|moved| self.known_error(moved)));
        remarks.extend(moved.and_then(|moved| unmatched_slopes(of_model, moved.motion)));
        remarks
    }

    fn lacks_flap(&self, moved: Moved) -> bool {
        moved.motion == Motion::Flap && self.flap_chord <= 0.0
    }

    /// How far a model that is not fitted to exact theory is from it.
    fn known_error(&self, moved: Moved) -> Option<String> {
        let Moved { motion, reduced_frequency: k } = moved;
        if self.lacks_flap(moved) {
            return None;
        }
        let errors = known_error_percent(self.model, motion, self.mach)?;
        let [slow, fast] = KNOWN_ERROR_BANDS;
        let (band, to) = if k.is_some_and(|k| k <= slow) { (0, slow) } else { (1, fast) };
        let [cn, cm, ch] = errors.map(|bands| bands[band]);
        let beyond = if k.is_some_and(|k| k > fast) { ", not measured beyond" } else { "" };
        let hinge =
            if self.flap_chord > 0.0 { format!(" and {ch:.0} % in Ch") } else { String::new() };
        let motion = format!("{motion:?}").to_lowercase();
        Some(format!(
            "this model is off exact theory by up to {cn:.0} % in Cn, {cm:.0} % in Cm{hinge} \
             ({motion}, k to {to}{beyond}, near this Mach number, flaps of 0.1 to 0.4 chord); the \
             calibrated model is within 4 % to k = 1 and Mach 0.7"
        ))
    }
}

/// A motion of a section.
#[derive(Debug, Clone, Copy)]
struct Moved {
    motion: Motion,
    /// None of a step or a ramp: all frequencies.
    reduced_frequency: Option<f64>,
}

/// Names the loads and inputs of a motion whose initial slope the slope-matched form does not have.
fn unmatched_slopes(remarks: &ModelRemarks, motion: Motion) -> Option<String> {
    let moved: &[Mode] = match motion {
        Motion::Flap => &[Mode::Flap, Mode::FlapRate],
        Motion::Pitch => &[Mode::Alpha, Mode::PitchRate],
        Motion::Plunge => &[Mode::Alpha],
    };
    let loads = ["Cn", "Cm", "Ch"].iter().zip(&remarks.slope_unmatched);
    let pairs: Vec<String> = loads
        .flat_map(|(load, modes)| {
            let unmatched = moved.iter().filter(|mode| modes[mode.index()]);
            unmatched.map(move |mode| {
                let input = ["alpha", "q", "delta", "q_delta"][mode.index()];
                format!("{load} due to {input}")
            })
        })
        .collect();
    (!pairs.is_empty()).then(|| {
        format!(
            "no positive time constant has the initial slope of {}: the smallest used is taken",
            pairs.join(", ")
        )
    })
}

/// What the constants of a stall are where it is asked for beyond their Mach numbers; none within.
pub fn stall_remark(airfoil: StallAirfoil, mach: f64) -> Option<String> {
    let [from, to] = airfoil.known_machs();
    let end = mach.clamp(from, to);
    (mach < from || mach > to).then(|| match airfoil {
        StallAirfoil::Naca0012 => format!(
            "the constants of the stall are those of Mach {end}: published for {from} to {to}"
        ),
        _ => format!(
            "the constants of the stall were fitted for Mach {from} to {to}: its ends are held, and beyond 0.3 they follow the published trend of the NACA 0012"
        ),
    })
}

/// Complex amplitudes per radian (plunge: per unit of `h_dot / U`, down positive) as `[re, im]`;
/// moments on the full chord squared, about the quarter chord and the hinge.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SectionResult {
    /// The model and where it comes from; not in the JSON.
    #[serde(skip)]
    pub model: &'static str,
    /// What moves.
    #[serde(skip)]
    pub motion: Motion,
    /// Where the model had to leave its own form to give an answer, and how far off it is.
    pub remarks: Vec<String>,
    /// Normal force coefficient.
    pub cn: [f64; 2],
    /// Moment coefficient about the quarter chord, nose-up positive.
    pub cm: [f64; 2],
    /// Hinge-moment coefficient, positive in the sense of the flap angle.
    pub ch: [f64; 2],
}

/// The response of a section to a motion of unit amplitude at a reduced frequency
/// `k = omega c / (2 U)`, 0 and up.
///
/// # Errors
/// [`AeroError`] for a Mach number, flap chord or frequency outside the model.
pub fn section_response(
    section: &SectionChoice,
    motion: Motion,
    k: f64,
) -> Result<SectionResult, AeroError> {
    within("reduced frequency", k, (0.0..=FASTEST).contains(&k), "0 to 1000")?;
    let (coefficients, ..) = section.coefficients()?;
    let [cn, cm, ch] =
        harmonic_response(&coefficients, k, motion).map(|value| [value.re, value.im]);
    let moved = Moved { motion, reduced_frequency: Some(k) };
    let remarks = section.remarks(&coefficients.remarks, Some(moved));
    Ok(SectionResult { model: section.model.title(), motion, remarks, cn, cm, ch })
}

/// A table of numbers with named columns: a history or a curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SectionTable {
    /// What the table shows.
    pub title: String,
    /// Where the model or a table had to leave its own form, and how far off it is.
    pub remarks: Vec<String>,
    /// Names of the columns, with units.
    pub columns: Vec<&'static str>,
    /// The rows.
    pub rows: Vec<Vec<f64>>,
}

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
        let unit = per_unit(self.motion);
        format!("load,re_{unit},im_{unit}\n{}", lines.concat())
    }
}

/// What a load per unit of a motion is on.
fn per_unit(motion: Motion) -> &'static str {
    match motion {
        Motion::Flap | Motion::Pitch => "per_rad",
        Motion::Plunge => "per_hdot_over_u",
    }
}

/// Most rows of a table.
const MOST_POINTS: usize = 1_000_000;

/// Refuses a number of rows that does not fit.
///
/// # Errors
/// [`AeroError::BadInput`].
pub fn within_points(points: usize) -> Result<(), AeroError> {
    let fits = (1..=MOST_POINTS).contains(&points);
    within("number of points", points as f64, fits, "1 to 1000000")
}

/// Refuses a number that does not fit.
///
/// # Errors
/// [`AeroError::BadInput`] with what was expected.
pub fn within(
    quantity: &'static str,
    value: f64,
    fits: bool,
    expected: &'static str,
) -> Result<(), AeroError> {
    if fits && value.is_finite() {
        return Ok(());
    }
    Err(AeroError::BadInput { quantity, value, expected })
}

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
