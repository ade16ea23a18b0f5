//! How the reductions move with the assumptions the paper leaves open.

use super::run::ideal_control;
use super::{Drives, FlapDrive, TrimmedRotor};
use crate::SimError;
use crate::case::{
    BladeValues, EffortChoice, FreeWakeFile, InflowChoice, LoadScaleChoice, LoadedCase,
    NearWakeChoice, SectionModelChoice, TrimValues,
};
use crate::raw::{Setting, loads_cost};
use crate::results::HubLoads;
use hhc_control::reduction_percent;
use preisach_dyn::ActuatorModel;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;
use std::sync::Arc;

/// Tolerances of the table: a tenth of a percent is printed.
const TABLE_TRIM_TOLERANCE: f64 = 1e-7;
const TABLE_PERIODICITY_TOLERANCE: f64 = 1e-9;
const TABLE_INFLOW_TOLERANCE: f64 = 1e-8;

/// The change that weights each load by its own baseline.
const BY_BASELINE: &str = "each load weighted by its own baseline";

const FREE_WAKE: &str = "free wake";
const NEAR_WAKES: [&str; 2] = [
    "near wake convected, off the free wake",
    "near wake of 30 deg in the blade plane, off the free wake",
];

/// One assumption changed, and what becomes of the reductions.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Sensitivity {
    /// What was changed, with the value it has in the case.
    pub assumption: String,
    /// Reduction of `J_Z` (percent) for each of the harmonics that the case controls alone, ideal actuator
    /// within the stroke of the real one; empty without an answer.
    pub reduction_percent: Vec<f64>,
    /// Largest change of a reduction from the row it is compared with, percentage points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_change: Option<f64>,
    /// The row it is compared with, counted from 0.
    pub compared_with: usize,
    /// Why there is no answer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
    /// What the reductions are computed from; none without an answer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub record: Option<SensitivityRecord>,
}

/// What the reductions of a row are computed from.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SensitivityRecord {
    /// Hub loads without control.
    pub baseline: HubLoads,
    /// Hub loads with control, one entry per reduction.
    pub hub_4_per_rev: Vec<HubLoads>,
}

impl Sensitivity {
    fn new(assumption: &str, record: SensitivityRecord) -> Self {
        Self { assumption: assumption.to_owned(), record: Some(record), ..Self::default() }
    }

    /// A row without an answer.
    fn failed(assumption: &str, error: &SimError) -> Self {
        let (assumption, failure) = (assumption.to_owned(), Some(error.to_string()));
        Self { assumption, failure, ..Self::default() }
    }

    /// The reductions from the loads, with the weights as the row has them.
    fn reductions(&self, case: &Setting) -> Vec<f64> {
        let Some(record) = &self.record else { return Vec::new() };
        let mut setting = Setting { baseline: record.baseline.parts(), ..case.clone() };
        if self.assumption == BY_BASELINE {
            setting.scale = LoadScaleChoice::Baseline;
        }
        let weights = setting.load_weights();
        let before = loads_cost(&weights, &setting.baseline);
        let after = record.hub_4_per_rev.iter().map(|loads| loads_cost(&weights, &loads.parts()));
        after.map(|after| reduction_percent(before, after)).collect()
    }
}

/// The reductions of all rows and their changes, computed from their loads.
pub(crate) fn refigure_sensitivity(rows: &mut [Sensitivity], setting: &Setting) {
    for row in &mut *rows {
        row.reduction_percent = row.reductions(setting);
    }
    let all: Vec<Vec<f64>> = rows.iter().map(|row| row.reduction_percent.clone()).collect();
    for row in rows {
        let nominal = all.get(row.compared_with).map_or(&[][..], Vec::as_slice);
        let changes = row.reduction_percent.iter().zip(nominal).map(|(a, b)| (a - b).abs());
        row.largest_change = row.record.is_some().then(|| changes.fold(0.0, f64::max));
    }
}

/// Whether an assumption changes the rotor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RotorOf {
    /// The rotor and its trim are those of the case.
    TheCase,
    /// They are built and trimmed anew.
    TheChange,
}

/// The stroke an assumption leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
enum StrokeOf {
    /// That of the case, times a factor.
    TheCase(f64),
    /// Found anew: the actuator is used in another way.
    TheChange,
}

/// A change of the case and of the stroke.
struct Assumption {
    text: &'static str,
    stroke: StrokeOf,
    rotor: RotorOf,
    change: Box<dyn Fn(&mut LoadedCase) + Sync + Send>,
}

fn assume(
    text: &'static str,
    change: impl Fn(&mut LoadedCase) + Sync + Send + 'static,
) -> Assumption {
    let change = Box::new(change);
    let stroke = StrokeOf::TheCase(1.0);
    Assumption { text, stroke, rotor: RotorOf::TheChange, change }
}

/// No change: rotor and stroke of the case.
fn as_it_is(text: &'static str) -> Assumption {
    Assumption { rotor: RotorOf::TheCase, ..assume(text, |_| {}) }
}

/// A linear twist in place of whatever the blade has.
fn twist(blade: &mut BladeValues, deg: f64) {
    blade.twist_rad = deg.to_radians();
    blade.tables.twist_deg.clear();
}

/// A property times a factor, given uniform or as a table.
fn times(uniform: &mut f64, table: &mut [(f64, f64)], factor: f64) {
    *uniform *= factor;
    for (_, value) in table {
        *value *= factor;
    }
}

fn shift_flaps(loaded: &mut LoadedCase, by_r: f64) {
    for flap in &mut loaded.case.flaps {
        flap.start += by_r;
        flap.end += by_r;
    }
}

/// The free wake of a case, the default one for a case without.
fn free_wake(loaded: &LoadedCase) -> FreeWakeFile {
    match loaded.case.inflow {
        InflowChoice::FreeWake(file) => file,
        _ => FreeWakeFile::default(),
    }
}

/// The free wake instead of the case's inflow, and its near part in other ways.
fn of_the_wake() -> Vec<Assumption> {
    let of_rotor = |text, change: fn(&mut LoadedCase)| assume(text, change);
    vec![
        of_rotor(FREE_WAKE, |c| c.case.inflow = InflowChoice::FreeWake(free_wake(c))),
        of_rotor(NEAR_WAKES[0], |c| {
            let near_wake = NearWakeChoice::Convected;
            c.case.inflow = InflowChoice::FreeWake(FreeWakeFile { near_wake, ..free_wake(c) });
        }),
        of_rotor(NEAR_WAKES[1], |c| {
            let near_wake = NearWakeChoice::BladePlane;
            let file = FreeWakeFile { near_wake, near_wake_deg: 30.0, ..free_wake(c) };
            c.case.inflow = InflowChoice::FreeWake(file);
        }),
    ]
}

/// Compares another near wake with the free wake as it is, so that one thing is changed at a time.
fn compare_near_wakes(table: &mut [Sensitivity]) {
    let Some(place) = table.iter().position(|row| row.assumption == FREE_WAKE) else { return };
    for row in table.iter_mut().filter(|row| NEAR_WAKES.contains(&row.assumption.as_str())) {
        row.compared_with = place;
    }
}

/// The changes, one at a time.
fn assumptions() -> Vec<Assumption> {
    let of_rotor = |text, change: fn(&mut LoadedCase)| assume(text, change);
    let of_case = |text, change: fn(&mut LoadedCase)| Assumption {
        change: Box::new(change),
        ..as_it_is(text)
    };
    let stroke =
        |text, factor| Assumption { stroke: StrokeOf::TheCase(factor), ..of_case(text, |_| {}) };
    vec![
        of_rotor("flaps .05 R further in", |c| shift_flaps(c, -0.05)),
        of_rotor("flaps .05 R further out", |c| shift_flaps(c, 0.05)),
        of_rotor("flaps .02 R further out", |c| shift_flaps(c, 0.02)),
        of_rotor("twist -4 deg", |c| twist(&mut c.case.blade, -4.0)),
        of_rotor("twist -12 deg", |c| twist(&mut c.case.blade, -12.0)),
        of_rotor("GJ -20 % (first torsion -10 %)", |c| {
            let blade = &mut c.case.blade;
            times(&mut blade.gj, &mut blade.tables.gj, 0.8);
        }),
        of_rotor("GJ +20 % (first torsion +9 %)", |c| {
            let blade = &mut c.case.blade;
            times(&mut blade.gj, &mut blade.tables.gj, 1.2);
        }),
        of_rotor("radii of gyration +10 % (first torsion -9 %)", |c| {
            let blade = &mut c.case.blade;
            times(&mut blade.km1, &mut blade.tables.km1_r, 1.1);
            times(&mut blade.km2, &mut blade.tables.km2_r, 1.1);
        }),
        of_rotor("modal damping .2 % of critical", |c| c.case.blade.modal_damping = 0.002),
        of_rotor("modal damping 1 % of critical", |c| c.case.blade.modal_damping = 0.01),
        of_rotor("precone 2.5 deg", |c| c.case.blade.precone_rad = 2.5_f64.to_radians()),
        of_rotor("root cut-out .15 R", |c| c.case.blade.root_cutout = 0.15),
        of_rotor("profile drag .008", |c| c.case.section.drag_coefficient = 0.008),
        of_rotor("fuselage drag area -30 %", |c| {
            if let TrimValues::Propulsive { drag_area, .. } = &mut c.case.trim {
                *drag_area *= 0.7;
            }
        }),
        of_rotor("uniform inflow", |c| c.case.inflow = InflowChoice::Uniform),
        of_rotor("inflow of Pitt and Peters", |c| c.case.inflow = InflowChoice::PittPeters),
        of_rotor("quasi-steady sections", |c| {
            c.case.section.model = SectionModelChoice::QuasiSteady;
        }),
        of_rotor("flap lift 80 % of thin-aerofoil theory", |c| {
            for flap in &mut c.case.flaps {
                flap.effectiveness[0] *= 0.8;
            }
        }),
        Assumption {
            rotor: RotorOf::TheCase,
            ..assume(BY_BASELINE, |c| c.case.control.load_scale = LoadScaleChoice::Baseline)
        },
        of_case("stroke met by a tuned weight for the cone program (or the reverse)", |c| {
            let effort = &mut c.case.control.effort;
            *effort = match effort {
                EffortChoice::Limits => EffortChoice::MeetStroke,
                _ => EffortChoice::Limits,
            };
        }),
        stroke("half the stroke", 0.5),
        stroke("stroke +25 %", 1.25),
        Assumption {
            stroke: StrokeOf::TheChange,
            ..of_case("one bench second = 6.383 revolutions for 5 (or 5 for 6.383)", |c| {
                let rev_hz = &mut c.case.actuator.bench_rev_hz;
                *rev_hz = if *rev_hz < 5.7 { 6.383 } else { 5.0 };
            })
        },
    ]
}

/// Trims and controls the case once for every assumption changed, in parallel. The case itself comes
/// first, then the changes, the one that moves a reduction most leading; those without an answer end the table.
///
/// With the ideal actuator, held to the stroke of the real one: feedback on the hysteretic actuator
/// reaches nearly the same reductions, at several times the cost. Without the rows of the wake a case that flies
/// in a free wake is changed about Drees's inflow, which takes seconds: that row comes second, and the rows
/// after it are compared with it.
///
/// # Errors
/// The first failure of a trim or a control study of the case itself, or of the case in Drees's inflow.
pub fn sensitivities(
    loaded: &LoadedCase,
    (base, drives): (&TrimmedRotor, &Drives),
    which: Assumptions,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Sensitivity>, SimError> {
    let sets: Vec<Vec<usize>> =
        loaded.case.control.harmonics.iter().filter(|set| set.len() == 1).cloned().collect();
    let model = match &drives.hysteretic {
        Some(FlapDrive::Model { model, .. }) => Some(Arc::clone(model)),
        _ => None,
    };
    let bench = Bench { drives, model, sets: &sets, done };
    let mut table = vec![bench.row(loaded, base, &as_it_is("as the case"))?];
    if which.about_drees(loaded) {
        let mut drees = loaded.clone();
        drees.case.inflow = InflowChoice::Drees;
        let near = TrimmedRotor::new(&drees, Some(base.trim()))?;
        let text = "inflow of Drees, as in the rows below";
        table.push(bench.row(&drees, &near, &as_it_is(text))?);
        table.extend(bench.changed(&drees, &near, assumptions(), 1));
    } else {
        let mut changes = assumptions();
        if which == Assumptions::WithWake {
            changes.extend(of_the_wake());
        }
        table.extend(bench.changed(loaded, base, changes, 0));
    }
    let baseline = base.trim().rotor.hub.harmonic(loaded.case.blades);
    let setting = Setting::of_case(&loaded.case, &HubLoads::from_parts(baseline));
    let changed = table.iter().filter(|row| row.compared_with > 0).count();
    let first = if changed > 0 { 2 } else { 1 };
    compare_near_wakes(&mut table);
    refigure_sensitivity(&mut table, &setting);
    if let Some(rows) = table.get_mut(first..) {
        rows.sort_by(|a, b| {
            let size = |row: &Sensitivity| row.largest_change.unwrap_or(-1.0);
            size(b).total_cmp(&size(a))
        });
    }
    // the row they are compared with has moved
    compare_near_wakes(&mut table);
    Ok(table)
}

/// What every row of the table shares.
struct Bench<'a> {
    drives: &'a Drives,
    model: Option<Arc<ActuatorModel>>,
    sets: &'a [Vec<usize>],
    done: &'a (dyn Fn() + Sync),
}

impl Bench<'_> {
    /// The rows of changes.
    fn changed(
        &self,
        loaded: &LoadedCase,
        base: &TrimmedRotor,
        changes: Vec<Assumption>,
        compared_with: usize,
    ) -> Vec<Sensitivity> {
        changes
            .into_par_iter()
            .map(|change| {
                let row = self
                    .row(loaded, base, &change)
                    .unwrap_or_else(|error| Sensitivity::failed(change.text, &error));
                Sensitivity { compared_with, ..row }
            })
            .collect()
    }

    fn row(
        &self,
        loaded: &LoadedCase,
        base: &TrimmedRotor,
        assumption: &Assumption,
    ) -> Result<Sensitivity, SimError> {
        let failed = |source| SimError::Study { place: loaded.index.place("control"), source };
        let mut varied = loaded.clone();
        (assumption.change)(&mut varied);
        let limited = match assumption.stroke {
            StrokeOf::TheCase(factor) => self.drives.with_strokes_scaled(factor),
            StrokeOf::TheChange => Drives::new(&varied.case, self.model.clone()).map_err(failed)?,
        };
        varied.case.tolerances.trim = TABLE_TRIM_TOLERANCE;
        varied.case.tolerances.periodicity = TABLE_PERIODICITY_TOLERANCE;
        varied.case.tolerances.inflow = TABLE_INFLOW_TOLERANCE;
        let rotor = match assumption.rotor {
            RotorOf::TheCase => base.clone(),
            RotorOf::TheChange => TrimmedRotor::new(&varied, Some(base.trim()))?,
        };
        let blades = varied.case.blades;
        let loads = self.sets.iter().map(|set| {
            let study = ideal_control(&varied.case, &rotor, &limited, set).map_err(failed)?;
            Ok(HubLoads::from_parts(study.state.rotor.hub.harmonic(blades)))
        });
        let loads = loads.collect::<Result<Vec<HubLoads>, SimError>>();
        (self.done)();
        let baseline = HubLoads::from_parts(rotor.trim().rotor.hub.harmonic(blades));
        Ok(Sensitivity::new(assumption.text, SensitivityRecord { baseline, hub_4_per_rev: loads? }))
    }
}

/// The rows as CSV text.
pub fn sensitivity_csv(harmonics: &[Vec<usize>], rows: &[Sensitivity]) -> String {
    let sets = harmonics.iter().filter(|set| set.len() == 1);
    let names: Vec<String> =
        sets.map(|set| format!("reduction_{}_per_rev_percent", set[0])).collect();
    let mut text = format!("assumption,{},largest_change\n", names.join(","));
    for row in rows {
        // an empty field has no answer
        let number = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.3}"));
        let numbers: Vec<String> =
            (0..names.len()).map(|k| number(row.reduction_percent.get(k).copied())).collect();
        let (numbers, change) = (numbers.join(","), number(row.largest_change));
        let _ = writeln!(text, "\"{}\",{numbers},{change}", row.assumption);
    }
    text
}

/// Which assumptions are changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Assumptions {
    /// All but those that take a free wake: seconds. Of a case in a free wake, about Drees's inflow.
    WithoutWake,
    /// Those of the free wake and its near part too: minutes.
    WithWake,
}

impl Assumptions {
    /// Whether the changes are made about Drees's inflow.
    fn about_drees(self, loaded: &LoadedCase) -> bool {
        self == Self::WithoutWake && matches!(loaded.case.inflow, InflowChoice::FreeWake(_))
    }

    /// Number of rows [`sensitivities`] makes of a case, for a progress bar.
    pub fn rows(self, loaded: &LoadedCase) -> usize {
        match self {
            Self::WithoutWake => 24 + usize::from(self.about_drees(loaded)),
            Self::WithWake => 27,
        }
    }
}
