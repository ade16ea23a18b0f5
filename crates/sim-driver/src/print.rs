//! What the commands of one physics print: the rotor of a case asked, its answer as `study_text` tells it.

use crate::SimError;
use crate::case::LoadedCase;
use crate::choices::check_range;
use crate::output::Printable;
use crate::problem::Problems;
use rotor_flight::{WakeInTimeResult, wake_in_time_text};
use rotor_study::{
    Drives, ModesQuestion, ModesResult, RootPitchComparison, StudyError, TrimmedRotor, WakeResult,
    compare_root_pitch, rotating_modes, wake_of_case,
};
use serde::Serialize;
use study_text::{WakeFiles, modes_text, root_pitch_text, wake_text};

/// Rotating modes of a case's blade, with plausibility warnings about the blade.
///
/// # Errors
/// A pitch beyond a quarter of a turn, a rotor speed outside 0 to 10 times the nominal one; [`SimError::Study`].
pub fn modes_of_case(
    loaded: &LoadedCase,
    question: &ModesQuestion,
) -> Result<ModesResult, SimError> {
    let mut problems = Problems::default();
    let remedy = "the collective at 0.75 R, a finite number";
    let pitch_deg = question.pitch_rad.to_degrees();
    check_range(&mut problems, "--pitch-deg", pitch_deg, [-90.0, 90.0], "deg", remedy);
    let remedy = "rotor speeds over the nominal one; 0 is a blade at rest";
    for &ratio in &question.speed_ratios {
        check_range(&mut problems, "--speeds", ratio, [0.0, 10.0], "", remedy);
    }
    problems.into_result(Some(()))?;
    let doubts = || loaded.in_words(loaded.case.blade_warnings());
    let found = rotating_modes(&loaded.case, question)
        .map_err(|error| loaded.located(error).in_doubt(doubts()))?;
    let warnings = doubts().into_iter().chain(found.warnings).collect();
    Ok(ModesResult { warnings, ..found })
}

impl Printable for ModesResult {
    fn text(&self) -> String {
        modes_text(self)
    }
}

/// Flaps against root pitch for every set of harmonics of a case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RootPitchResult {
    /// Plausibility warnings about the case.
    pub warnings: Vec<String>,
    /// One comparison for each set of harmonics.
    pub sets: Vec<RootPitchComparison>,
}

/// Compares flaps and root pitch on the rotor of a case.
///
/// # Errors
/// [`SimError::Study`]; a case without flaps or without harmonics to control.
pub fn root_pitch_of_case(loaded: &LoadedCase) -> Result<RootPitchResult, SimError> {
    let doubts = || loaded.in_words(loaded.case.value_warnings());
    let found = TrimmedRotor::new(&loaded.case, None).and_then(|rotor| {
        compare_root_pitch(&loaded.case, &rotor, &Drives::new(&loaded.case, None)?)
    });
    let sets = found.map_err(|error| loaded.located(error).in_doubt(doubts()))?;
    Ok(RootPitchResult { warnings: doubts(), sets })
}

impl Printable for RootPitchResult {
    fn text(&self) -> String {
        root_pitch_text(&self.sets, &self.warnings)
    }
}

/// The wake of a case with plausibility warnings about the case, and its files, where they are wanted.
///
/// # Errors
/// The errors of the rotor, of the trim and of the wake.
pub fn wake_and_files(
    loaded: &LoadedCase,
    wanted: bool,
) -> Result<(WakeResult, WakeFiles), SimError> {
    let doubts = || loaded.in_words(loaded.case.value_warnings());
    let found = wake_of_case(&loaded.case).and_then(|found| {
        if !wanted {
            return Ok((found.result, WakeFiles::new()));
        }
        let files = study_text::wake_files(&found, &loaded.case).map_err(|source| {
            let (field, source) = ("inflow.model".to_owned(), source.into());
            StudyError::Response { field, source }
        })?;
        Ok((found.result, files))
    });
    let (mut result, files) = found.map_err(|error| loaded.located(error).in_doubt(doubts()))?;
    result.warnings.splice(0..0, doubts());
    Ok((result, files))
}

impl Printable for WakeResult {
    fn text(&self) -> String {
        wake_text(self)
    }
}

impl Printable for WakeInTimeResult {
    fn text(&self) -> String {
        wake_in_time_text(self)
    }
}

#[cfg(test)]
mod tests {
    use crate::case::{ModalBasis, shipped_case};
    use crate::progress::Progress;
    use crate::run::run_case;
    use study_text::curvature_gap;

    /// Four natural modes bend the root of the lagging blade 14 % less than the load asks; ten completed ones of
    /// each family do not.
    #[test]
    fn a_curvature_far_from_the_load_is_pointed_at() {
        let mut loaded = shipped_case("crosscheck_s2.ron").unwrap();
        let natural = run_case(&loaded, &Progress::hidden()).unwrap().result;
        let text = curvature_gap(&natural.blade_loads).unwrap();
        assert!(text.contains("lag at 0.000 R is 14 %"), "{text}");
        loaded.case.structure.modes = [10, 10, 10].into();
        loaded.case.structure.basis = ModalBasis::Completed;
        let completed = run_case(&loaded, &Progress::hidden()).unwrap().result;
        assert_eq!(curvature_gap(&completed.blade_loads), None);
    }
}
