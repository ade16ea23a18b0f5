//! How the reductions move with the assumptions the paper leaves open.

use crate::case::{
    AttachedFlowModel, Case, ControllerChoice, EffortChoice, FreeWakeValues, InflowChoice,
    LoadScaleChoice, NearWakeMotion, RotorValues, TrimValues,
};
use crate::control::{Drives, ideal_control};
use crate::error::StudyError;
use crate::flaps::FlapDrive;
use crate::loads::{HubLoads, Setting, loads_cost};
use crate::rotor::TrimmedRotor;
use preisach_dyn::ActuatorModel;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Tolerances of the table: a tenth of a percent is printed.
const TABLE_TRIM_TOLERANCE: f64 = 1e-7;
const TABLE_PERIODICITY_TOLERANCE: f64 = 1e-9;
const TABLE_INFLOW_TOLERANCE: f64 = 1e-8;

/// The row of the case as it is.
const AS_THE_CASE: &str = "case";
/// The case in Drees's inflow.
const DREES: &str = "inflow-drees";
/// The change that weights each load by its own baseline.
const BY_BASELINE: &str = "weights-baseline";
/// The case in a free wake.
const FREE_WAKE: &str = "wake-free";
/// How the id of a row about the near part of that wake begins.
const NEAR_WAKE: &str = "wake-near";

/// One assumption changed, and what becomes of the reductions.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Sensitivity {
    /// Name that other rows are compared by, such as `twist-4`.
    #[serde(default)]
    pub id: String,
    /// What was changed.
    pub assumption: String,
    /// The id of the row it is compared with.
    #[serde(default)]
    pub compared_with: String,
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
    #[serde(alias = "hub_4_per_rev")]
    pub hub_nb_per_rev: Vec<HubLoads>,
}

impl Sensitivity {
    fn new((id, assumption): (&str, &str), record: SensitivityRecord) -> Self {
        let (id, assumption) = (id.to_owned(), assumption.to_owned());
        Self { id, assumption, record: Some(record), ..Self::default() }
    }

    /// A row without an answer.
    fn failed((id, assumption): (&str, &str), error: &StudyError) -> Self {
        let (id, assumption, failure) =
            (id.to_owned(), assumption.to_owned(), Some(error.to_string()));
        Self { id, assumption, failure, ..Self::default() }
    }

    /// The reductions from the loads, with the weights as the row has them.
    fn reductions(&self, case: &Setting) -> Vec<f64> {
        let Some(record) = &self.record else { return Vec::new() };
        let mut setting = Setting { baseline: record.baseline.parts(), ..case.clone() };
        if self.id == BY_BASELINE {
            setting.control.load_scale = LoadScaleChoice::Baseline;
        }
        let weights = setting.load_weights();
        let before = loads_cost(&weights, &setting.baseline);
        let after = record.hub_nb_per_rev.iter().map(|loads| loads_cost(&weights, &loads.parts()));
        after.map(|after| setting.reduction_percent(before, after)).collect()
    }
}

/// What one assumption does to the reductions.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct SensitivityLine {
    /// Name that other rows are compared by, such as `twist-4`.
    pub id: String,
    /// What was changed.
    pub assumption: String,
    /// Reduction of `J_Z` (percent) for each of the harmonics that the case controls alone, ideal actuator
    /// within the stroke of the real one; empty without an answer.
    pub reduction_percent: Vec<f64>,
    /// Largest change of a reduction from the row it is compared with, percentage points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_change: Option<f64>,
    /// The id of the row it is compared with.
    pub compared_with: String,
    /// Why there is no answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

/// The reductions of all rows and their changes, computed from their loads.
pub fn sensitivity_lines(rows: &[Sensitivity], setting: &Setting) -> Vec<SensitivityLine> {
    let reductions: Vec<Vec<f64>> = rows.iter().map(|row| row.reductions(setting)).collect();
    let line = |(row, own): (&Sensitivity, &Vec<f64>)| {
        let nominal = rows.iter().position(|other| other.id == row.compared_with);
        // no answer, or nothing to compare it with
        let largest_change = row.record.as_ref().and(nominal).map(|k| {
            let changes = own.iter().zip(&reductions[k]).map(|(a, b)| (a - b).abs());
            changes.fold(0.0, f64::max)
        });
        SensitivityLine {
            id: row.id.clone(),
            assumption: row.assumption.clone(),
            reduction_percent: own.clone(),
            largest_change,
            compared_with: row.compared_with.clone(),
            failure: row.failure.clone(),
        }
    };
    rows.iter().zip(&reductions).map(line).collect()
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
    id: &'static str,
    text: &'static str,
    stroke: StrokeOf,
    rotor: RotorOf,
    change: Box<dyn Fn(&mut Case) + Sync + Send>,
}

fn assume(
    (id, text): (&'static str, &'static str),
    change: impl Fn(&mut Case) + Sync + Send + 'static,
) -> Assumption {
    let change = Box::new(change);
    let stroke = StrokeOf::TheCase(1.0);
    Assumption { id, text, stroke, rotor: RotorOf::TheChange, change }
}

/// No change: rotor and stroke of the case.
fn as_it_is(name: (&'static str, &'static str)) -> Assumption {
    Assumption { rotor: RotorOf::TheCase, ..assume(name, |_| {}) }
}

/// A linear twist in place of whatever the blade has.
fn twist(rotor: &mut RotorValues, deg: f64) {
    rotor.twist_deg = deg;
    rotor.tables.twist_deg.clear();
}

/// A property times a factor, given uniform or as a table.
fn times(uniform: &mut f64, table: &mut [(f64, f64)], factor: f64) {
    *uniform *= factor;
    for (_, value) in table {
        *value *= factor;
    }
}

fn shift_flaps(case: &mut Case, by_r: f64) {
    for flap in &mut case.flaps {
        flap.start_r += by_r;
        flap.end_r += by_r;
    }
}

/// The free wake of a case, the default one for a case without.
fn free_wake(case: &Case) -> FreeWakeValues {
    case.inflow.model.free_wake().unwrap_or_default()
}

/// The free wake instead of the case's inflow, and its near part in other ways.
fn of_the_wake() -> Vec<Assumption> {
    let of_rotor = |id, text, change: fn(&mut Case)| assume((id, text), change);
    vec![
        of_rotor(FREE_WAKE, "free wake", |c| {
            c.inflow.model = InflowChoice::FreeWake(free_wake(c));
        }),
        of_rotor("wake-near-convected", "near wake convected", |c| {
            let near_wake = NearWakeMotion::Convected;
            c.inflow.model = InflowChoice::FreeWake(FreeWakeValues { near_wake, ..free_wake(c) });
        }),
        of_rotor("wake-near-plane-30", "near wake of 30 deg in the blade plane", |c| {
            let near_wake = NearWakeMotion::BladePlane;
            let file = FreeWakeValues { near_wake, near_wake_deg: 30.0, ..free_wake(c) };
            c.inflow.model = InflowChoice::FreeWake(file);
        }),
    ]
}

impl Assumption {
    /// Whether it changes anything of a case: not where the case has it so already, or makes no use of the field.
    fn concerns(&self, case: &Case, has_model: bool) -> bool {
        let mut varied = case.clone();
        (self.change)(&mut varied);
        let stroke = match self.stroke {
            // that of an ideal actuator is the same at any speed
            StrokeOf::TheChange => has_model,
            StrokeOf::TheCase(factor) => factor.to_bits() != 1.0_f64.to_bits(),
        };
        // the polar of a section with tables is theirs
        if case.aerodynamics.tables.is_some() {
            varied.aerodynamics.drag_coefficient = case.aerodynamics.drag_coefficient;
        }
        if self.stroke == StrokeOf::TheChange { stroke } else { stroke || &varied != case }
    }
}

/// The changes, one at a time.
fn assumptions() -> Vec<Assumption> {
    let of_rotor = |id, text, change: fn(&mut Case)| assume((id, text), change);
    let of_case = |id, text, change: fn(&mut Case)| Assumption {
        change: Box::new(change),
        ..as_it_is((id, text))
    };
    let stroke = |id, text, factor| Assumption {
        stroke: StrokeOf::TheCase(factor),
        ..of_case(id, text, |_| {})
    };
    vec![
        of_rotor("flaps-in-05", "flaps .05 R further in", |c| shift_flaps(c, -0.05)),
        of_rotor("flaps-out-05", "flaps .05 R further out", |c| shift_flaps(c, 0.05)),
        of_rotor("flaps-out-02", "flaps .02 R further out", |c| shift_flaps(c, 0.02)),
        of_rotor("twist-4", "twist -4 deg", |c| twist(&mut c.rotor, -4.0)),
        of_rotor("twist-12", "twist -12 deg", |c| twist(&mut c.rotor, -12.0)),
        of_rotor("gj-80", "GJ -20 % (first torsion -10 %)", |c| {
            let blade = &mut c.rotor;
            times(&mut blade.gj, &mut blade.tables.gj, 0.8);
        }),
        of_rotor("gj-120", "GJ +20 % (first torsion +9 %)", |c| {
            let blade = &mut c.rotor;
            times(&mut blade.gj, &mut blade.tables.gj, 1.2);
        }),
        of_rotor("gyration-110", "radii of gyration +10 % (first torsion -9 %)", |c| {
            let blade = &mut c.rotor;
            times(&mut blade.km1_r, &mut blade.tables.km1_r, 1.1);
            times(&mut blade.km2_r, &mut blade.tables.km2_r, 1.1);
        }),
        of_rotor("damping-002", "modal damping .2 % of critical", |c| {
            c.rotor.modal_damping = 0.002;
        }),
        of_rotor("damping-010", "modal damping 1 % of critical", |c| {
            c.rotor.modal_damping = 0.01;
        }),
        of_rotor("precone-2.5", "precone 2.5 deg", |c| {
            c.rotor.precone_deg = 2.5;
        }),
        of_rotor("cutout-15", "root cut-out .15 R", |c| c.rotor.root_cutout_r = 0.15),
        of_rotor("drag-008", "profile drag .008", |c| c.aerodynamics.drag_coefficient = 0.008),
        of_rotor("fuselage-70", "fuselage drag area -30 %", |c| {
            if let TrimValues::Propulsive(level) = &mut c.trim {
                level.drag_area *= 0.7;
            }
        }),
        of_rotor("inflow-uniform", "uniform inflow", |c| {
            c.inflow.model = InflowChoice::Uniform;
        }),
        of_rotor("inflow-pitt-peters", "inflow of Pitt and Peters", |c| {
            c.inflow.model = InflowChoice::PittPeters;
        }),
        of_rotor("sections-quasi-steady", "quasi-steady sections", |c| {
            c.aerodynamics.model = AttachedFlowModel::QuasiSteady;
        }),
        of_rotor("flap-lift-80", "flap lift 80 % of thin-aerofoil theory", |c| {
            for flap in &mut c.flaps {
                flap.effectiveness.lift *= 0.8;
            }
        }),
        Assumption {
            rotor: RotorOf::TheCase,
            ..assume((BY_BASELINE, "each load weighted by its own baseline"), |c| {
                c.control.load_scale = LoadScaleChoice::Baseline;
            })
        },
        of_case(
            "effort",
            "stroke met by a tuned weight for the cone program (or the reverse)",
            |c| {
                let effort = &mut c.control.effort;
                *effort = match effort {
                    EffortChoice::Limits => EffortChoice::MeetStroke,
                    _ => EffortChoice::Limits,
                };
                if c.control.effort == EffortChoice::MeetStroke {
                    c.control.controller = ControllerChoice::Global;
                }
            },
        ),
        stroke("stroke-50", "half the stroke", 0.5),
        stroke("stroke-125", "stroke +25 %", 1.25),
        Assumption {
            stroke: StrokeOf::TheChange,
            ..of_case(
                "bench-speed",
                "one bench second = 6.383 revolutions for 5 (or 5 for 6.383)",
                |c| {
                    let rev_hz = &mut c.actuator.bench_rev_hz;
                    *rev_hz = if *rev_hz < 5.7 { 6.383 } else { 5.0 };
                },
            )
        },
    ]
}

/// Trims and controls the case once for every assumption changed, in parallel. The case itself comes
/// first, then the changes, the one that moves a reduction most leading; those without an answer end the table, and
/// those that change nothing of the case are not in it.
///
/// With the ideal actuator, held to the stroke of the real one: feedback on the hysteretic actuator
/// reaches nearly the same reductions, at several times the cost. Without the rows of the wake a case that flies
/// in a free wake is changed about Drees's inflow, which takes seconds: that row comes second, and the rows
/// after it are compared with it.
///
/// # Errors
/// The first failure of a trim or a control study of the case itself, or of the case in Drees's inflow.
pub fn sensitivities(
    case: &Case,
    (base, drives): (&TrimmedRotor, &Drives),
    which: Assumptions,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Sensitivity>, StudyError> {
    let sets: Vec<Vec<usize>> =
        case.control.harmonics.iter().filter(|set| set.len() == 1).cloned().collect();
    let model = match &drives.hysteretic {
        Some(FlapDrive::Model { model, .. }) => Some(Arc::clone(model)),
        _ => None,
    };
    let bench = Bench { drives, model, sets: &sets, done };
    let mut table = vec![bench.row(case, base, &as_it_is((AS_THE_CASE, "as the case")))?];
    if which.about_drees(case) {
        let mut drees = case.clone();
        drees.inflow.model = InflowChoice::Drees;
        let near = TrimmedRotor::new(&drees, Some(base.trim()))?;
        let name = (DREES, "inflow of Drees, as in the rows below");
        table.push(bench.row(&drees, &near, &as_it_is(name))?);
        table.extend(bench.changed(&drees, &near, assumptions(), DREES));
    } else {
        let rows = bench.changed(case, base, assumptions(), AS_THE_CASE);
        table.extend(rows);
        if which == Assumptions::WithWake {
            // another near wake with the free wake as it is, so that one thing is changed at a time
            let mut in_wake = case.clone();
            in_wake.inflow.model = InflowChoice::FreeWake(free_wake(case));
            let of_wake = if &in_wake == case { AS_THE_CASE } else { FREE_WAKE };
            let (near, whole): (Vec<_>, Vec<_>) =
                of_the_wake().into_iter().partition(|change| change.id.starts_with(NEAR_WAKE));
            table.extend(bench.changed(case, base, whole, AS_THE_CASE));
            table.extend(bench.changed(&in_wake, base, near, of_wake));
        }
    }
    let baseline = base.trim().rotor.hub.harmonic(case.rotor.blades);
    let setting = Setting::of_case(case, &HubLoads::from_parts(baseline));
    for row in &mut table {
        if row.compared_with.is_empty() {
            AS_THE_CASE.clone_into(&mut row.compared_with);
        }
    }
    let changes = sensitivity_lines(&table, &setting);
    let size = |k: usize| changes[k].largest_change.unwrap_or(-1.0);
    let first = if table.iter().any(|row| row.id == DREES) { 2 } else { 1 };
    let mut order: Vec<usize> = (0..table.len()).collect();
    if let Some(rows) = order.get_mut(first..) {
        rows.sort_by(|&a, &b| size(b).total_cmp(&size(a)));
    }
    Ok(order.into_iter().map(|k| table[k].clone()).collect())
}

/// For each of the reductions, the row that moves it most and by how much, percentage points; rows without an answer
/// move nothing.
pub fn most_moved(rows: &[SensitivityLine]) -> Vec<(&SensitivityLine, f64)> {
    let count = rows.first().map_or(0, |row| row.reduction_percent.len());
    let moved = |row: &SensitivityLine, k: usize| -> Option<f64> {
        let nominal = rows.iter().find(|other| other.id == row.compared_with)?;
        Some(row.reduction_percent.get(k)? - nominal.reduction_percent.get(k)?)
    };
    let most = (0..count).filter_map(|k| {
        let all = rows.iter().filter_map(|row| moved(row, k).map(|by| (row, by)));
        all.max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()))
    });
    most.collect()
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
        case: &Case,
        base: &TrimmedRotor,
        changes: Vec<Assumption>,
        compared_with: &str,
    ) -> Vec<Sensitivity> {
        changes
            .into_par_iter()
            .filter(|change| {
                let concerns = change.concerns(case, self.model.is_some());
                if !concerns {
                    (self.done)();
                }
                concerns
            })
            .map(|change| {
                let row = self
                    .row(case, base, &change)
                    .unwrap_or_else(|error| Sensitivity::failed((change.id, change.text), &error));
                Sensitivity { compared_with: compared_with.to_owned(), ..row }
            })
            .collect()
    }

    fn row(
        &self,
        case: &Case,
        base: &TrimmedRotor,
        assumption: &Assumption,
    ) -> Result<Sensitivity, StudyError> {
        let mut varied = case.clone();
        (assumption.change)(&mut varied);
        let limited = match assumption.stroke {
            StrokeOf::TheCase(factor) => self.drives.with_strokes_scaled(factor),
            StrokeOf::TheChange => Drives::new(&varied, self.model.clone())?,
        };
        varied.tolerances.trim = TABLE_TRIM_TOLERANCE;
        varied.tolerances.periodicity = TABLE_PERIODICITY_TOLERANCE;
        varied.tolerances.inflow = TABLE_INFLOW_TOLERANCE;
        let rotor = match assumption.rotor {
            RotorOf::TheCase => base.clone(),
            RotorOf::TheChange => TrimmedRotor::new(&varied, Some(base.trim()))?,
        };
        let blades = varied.rotor.blades;
        let loads = self.sets.iter().map(|set| {
            let study = ideal_control(&varied, &rotor, &limited, set)?;
            Ok(HubLoads::from_parts(study.state.rotor.hub.harmonic(blades)))
        });
        let loads = loads.collect::<Result<Vec<HubLoads>, StudyError>>();
        (self.done)();
        let baseline = HubLoads::from_parts(rotor.trim().rotor.hub.harmonic(blades));
        let name = (assumption.id, assumption.text);
        Ok(Sensitivity::new(name, SensitivityRecord { baseline, hub_nb_per_rev: loads? }))
    }
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
    fn about_drees(self, case: &Case) -> bool {
        self == Self::WithoutWake && matches!(case.inflow.model, InflowChoice::FreeWake(_))
    }

    /// Number of rows [`sensitivities`] makes of a case or leaves out, for a progress bar.
    pub fn rows(self, case: &Case) -> usize {
        match self {
            Self::WithoutWake => 24 + usize::from(self.about_drees(case)),
            Self::WithWake => 27,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::WindTunnelTrim;

    /// The case under limits of a cone program with T about the present control.
    fn controllers_case() -> Case {
        let mut case = Case::default();
        case.control.effort = EffortChoice::Limits;
        case.control.controller = ControllerChoice::Local;
        case
    }

    fn left_out(case: &Case, has_model: bool) -> Vec<&'static str> {
        let all = assumptions().into_iter().chain(of_the_wake());
        all.filter(|change| !change.concerns(case, has_model)).map(|change| change.id).collect()
    }

    #[test]
    fn what_the_case_has_already_or_does_not_use_is_no_row() {
        let mut case = controllers_case();
        assert!(left_out(&case, true).is_empty());
        assert_eq!(left_out(&case, false), ["bench-speed"]);
        case.inflow.model = InflowChoice::Uniform;
        case.trim = TrimValues::WindTunnel(WindTunnelTrim::default());
        case.rotor.modal_damping = 0.01;
        let none = ["damping-010", "fuselage-70", "inflow-uniform"];
        assert_eq!(left_out(&case, true), none);
        // in a free wake the row of the wake is the case
        let mut case = controllers_case();
        let near_wake = NearWakeMotion::Convected;
        case.inflow.model =
            InflowChoice::FreeWake(FreeWakeValues { near_wake, ..FreeWakeValues::default() });
        assert_eq!(left_out(&case, true), ["wake-free", "wake-near-convected"]);
    }
}
