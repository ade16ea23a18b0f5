//! How the reductions move with the assumptions the paper leaves open.

use crate::control::{Drives, ideal_control};
use crate::error::StudyError;
use crate::flaps::FlapDrive;
use crate::loads::{HubLoads, Setting, loads_cost};
use crate::rotor::TrimmedRotor;
use preisach_dyn::ActuatorModel;
use rayon::prelude::*;
use rotor_case::{
    AttachedFlowModel, Case, ControllerChoice, EffortChoice, FreeWakeValues, InflowChoice,
    LoadScaleChoice, NearWakeMotion, RolledUpChoice, RotorValues, TrimValues, times,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Tolerances of the table: a tenth of a percent is printed.
const TABLE_TRIM_TOLERANCE: f64 = 1e-6;
const TABLE_PERIODICITY_TOLERANCE: f64 = 1e-8;
const TABLE_INFLOW_TOLERANCE: f64 = 1e-7;
/// Step of a loop at which it ends, relative: a step leaves a few percent of the way.
const TABLE_STEP_TOLERANCE: f64 = 1e-3;

/// The row of the case as it is.
const AS_THE_CASE: &str = "case";
/// The change that weights each load by its own baseline.
const BY_BASELINE: &str = "weights-baseline";
/// The case in a free wake.
const FREE_WAKE: &str = "wake-free";

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

/// A change of the case and of the stroke.
struct Assumption {
    id: &'static str,
    text: &'static str,
    /// Factor on every stroke limit.
    stroke: f64,
    change: fn(&mut Case),
}

fn assume(id: &'static str, text: &'static str, change: fn(&mut Case)) -> Assumption {
    Assumption { id, text, stroke: 1.0, change }
}

/// A linear twist in place of whatever the blade has.
fn twist(rotor: &mut RotorValues, deg: f64) {
    rotor.twist_deg = deg;
    rotor.tables.twist_deg.clear();
}

fn shift_flaps(case: &mut Case, by_r: f64) {
    for flap in &mut case.flaps {
        flap.start_r += by_r;
        flap.end_r += by_r;
    }
}

/// The free wake of a case with other choices, in place of its inflow; the default wake for a case without.
fn fly_in_wake(case: &mut Case, change: fn(&mut FreeWakeValues)) {
    let mut wake = case.inflow.model.free_wake().unwrap_or_default();
    change(&mut wake);
    case.inflow.model = InflowChoice::FreeWake(wake);
}

/// The free wake in other ways.
fn of_the_wake() -> Vec<Assumption> {
    vec![
        assume("wake-near-convected", "near wake convected", |c| {
            fly_in_wake(c, |wake| wake.near_wake = Some(NearWakeMotion::Convected));
        }),
        assume("wake-near-90", "near wake of 90 deg", |c| {
            fly_in_wake(c, |wake| wake.near_wake_deg = Some(90.0));
        }),
        assume("wake-near-plane-30", "near wake of 30 deg in the blade plane", |c| {
            fly_in_wake(c, |wake| {
                wake.near_wake = Some(NearWakeMotion::BladePlane);
                wake.near_wake_deg = Some(30.0);
            });
        }),
        assume("wake-root-vortex", "root vortex beside the tip vortex", |c| {
            fly_in_wake(c, |wake| wake.rolled_up = Some(RolledUpChoice::TipAndRoot));
        }),
    ]
}

impl Assumption {
    /// Its row of the table.
    fn row(
        &self,
        compared_with: &str,
        found: Result<SensitivityRecord, StudyError>,
    ) -> Sensitivity {
        let failure = found.as_ref().err().map(StudyError::to_string);
        Sensitivity {
            id: self.id.to_owned(),
            assumption: self.text.to_owned(),
            compared_with: compared_with.to_owned(),
            failure,
            record: found.ok(),
        }
    }

    /// The case with the change.
    fn of(&self, case: &Case) -> Case {
        let mut varied = case.clone();
        (self.change)(&mut varied);
        varied
    }

    /// Whether it changes anything of a case: not where the case has it so already, or makes no use of the field.
    fn concerns(&self, case: &Case, has_model: bool) -> bool {
        let mut varied = self.of(case);
        // the polar of a section with tables is theirs
        if case.aerodynamics.tables.is_some() {
            varied.aerodynamics.drag_coefficient = case.aerodynamics.drag_coefficient;
        }
        // the stroke of an ideal actuator is the same at any speed
        if varied.actuator != case.actuator {
            return has_model;
        }
        self.stroke.to_bits() != 1.0_f64.to_bits() || varied != *case
    }
}

/// The changes, one at a time.
fn assumptions() -> Vec<Assumption> {
    let stroke = |id, text, stroke| Assumption { stroke, ..assume(id, text, |_| {}) };
    vec![
        assume("flaps-in-05", "flaps .05 R further in", |c| shift_flaps(c, -0.05)),
        assume("flaps-out-05", "flaps .05 R further out", |c| shift_flaps(c, 0.05)),
        assume("flaps-out-02", "flaps .02 R further out", |c| shift_flaps(c, 0.02)),
        assume("twist-4", "twist -4 deg", |c| twist(&mut c.rotor, -4.0)),
        assume("twist-12", "twist -12 deg", |c| twist(&mut c.rotor, -12.0)),
        assume("gj-80", "GJ -20 % (first torsion -10 %)", |c| {
            times(&mut c.rotor.gj, &mut c.rotor.tables.gj, 0.8);
        }),
        assume("gj-120", "GJ +20 % (first torsion +9 %)", |c| {
            times(&mut c.rotor.gj, &mut c.rotor.tables.gj, 1.2);
        }),
        assume("gyration-110", "radii of gyration +10 % (first torsion -9 %)", |c| {
            times(&mut c.rotor.km1_r, &mut c.rotor.tables.km1_r, 1.1);
            times(&mut c.rotor.km2_r, &mut c.rotor.tables.km2_r, 1.1);
        }),
        assume("damping-002", "modal damping .2 % of critical", |c| c.rotor.modal_damping = 0.002),
        assume("damping-010", "modal damping 1 % of critical", |c| c.rotor.modal_damping = 0.01),
        assume("precone-2.5", "precone 2.5 deg", |c| c.rotor.precone_deg = 2.5),
        assume("cutout-15", "root cut-out .15 R", |c| c.rotor.root_cutout_r = 0.15),
        assume("drag-008", "profile drag .008", |c| c.aerodynamics.drag_coefficient = 0.008),
        assume("fuselage-70", "fuselage drag area -30 %", |c| {
            if let TrimValues::Propulsive(level) = &mut c.trim {
                level.drag_area *= 0.7;
            }
        }),
        assume("inflow-drees", "inflow of Drees", |c| c.inflow.model = InflowChoice::Drees),
        assume("inflow-uniform", "uniform inflow", |c| c.inflow.model = InflowChoice::Uniform),
        assume("inflow-pitt-peters", "inflow of Pitt and Peters", |c| {
            c.inflow.model = InflowChoice::PittPeters;
        }),
        assume("sections-quasi-steady", "quasi-steady sections, what they shed in the wake", |c| {
            c.aerodynamics.model = AttachedFlowModel::QuasiSteady;
        }),
        assume("flap-lift-80", "flap lift 80 % of thin-aerofoil theory", |c| {
            c.flaps.iter_mut().for_each(|flap| flap.effectiveness.lift *= 0.8);
        }),
        assume(BY_BASELINE, "each load weighted by its own baseline", |c| {
            c.control.load_scale = LoadScaleChoice::Baseline;
        }),
        assume(
            "effort",
            "stroke met by a tuned weight for the cone program (or the reverse)",
            |c| {
                if c.control.effort == EffortChoice::Limits {
                    c.control.effort = EffortChoice::MeetStroke;
                    c.control.controller = ControllerChoice::Global;
                } else {
                    c.control.effort = EffortChoice::Limits;
                }
            },
        ),
        stroke("stroke-50", "half the stroke", 0.5),
        stroke("stroke-125", "stroke +25 %", 1.25),
        assume("bench-speed", "one bench second = 6.383 revolutions for 5 (or 5 for 6.383)", |c| {
            let rev_hz = &mut c.actuator.bench_rev_hz;
            *rev_hz = if *rev_hz < 5.7 { 6.383 } else { 5.0 };
        }),
    ]
}

/// Trims and controls the case once for every assumption changed, in parallel. The case itself comes
/// first, then the changes, the one that moves a reduction most leading; those without an answer end the table, and
/// those that change nothing of the case are not in it.
///
/// With the ideal actuator, held to the stroke of the real one, and with T of the linearised rotor: feedback on the
/// hysteretic actuator reaches nearly the same reductions, at several times the cost. Every rotor is trimmed from that of
/// the case, its free wake from that of the case. Of a case that flies in none, the rows of the wake are compared with the
/// default free wake.
///
/// # Errors
/// The first failure of a control study of the case itself.
pub fn sensitivities(
    case: &Case,
    base: &TrimmedRotor,
    drives: &Drives,
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
    let as_it_is = assume(AS_THE_CASE, "as the case", |_| {});
    let mut table = vec![as_it_is.row(AS_THE_CASE, Ok(bench.record(case, base, &as_it_is)?))];
    let flies_in_wake = case.inflow.model.free_wake().is_some();
    let mut changes = assumptions();
    if flies_in_wake {
        changes.extend(of_the_wake());
    }
    table.extend(bench.changed(case, base, changes, AS_THE_CASE));
    if which == Assumptions::WithWake && !flies_in_wake {
        let as_it_is = assume(FREE_WAKE, "free wake", |c| fly_in_wake(c, |_| {}));
        let in_wake = as_it_is.of(case);
        match TrimmedRotor::new(&in_wake, None) {
            Ok(rotor) => {
                let found = bench.record(&in_wake, &rotor, &as_it_is);
                table.push(as_it_is.row(AS_THE_CASE, found));
                table.extend(bench.changed(&in_wake, &rotor, of_the_wake(), FREE_WAKE));
            }
            Err(error) => table.push(as_it_is.row(AS_THE_CASE, Err(error))),
        }
    }
    let baseline = base.trim().rotor.hub.harmonic(case.rotor.blades);
    let setting = Setting::of_case(case, &HubLoads::from_parts(baseline));
    let changes = sensitivity_lines(&table, &setting);
    let size = |k: usize| changes[k].largest_change.unwrap_or(-1.0);
    let mut order: Vec<usize> = (0..table.len()).collect();
    if let Some(rows) = order.get_mut(1..) {
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
            .map(|change| change.row(compared_with, self.record(case, base, &change)))
            .collect()
    }

    fn record(
        &self,
        case: &Case,
        base: &TrimmedRotor,
        assumption: &Assumption,
    ) -> Result<SensitivityRecord, StudyError> {
        let mut varied = assumption.of(case);
        // an actuator used in another way has another stroke
        let limited = if varied.actuator == case.actuator {
            self.drives.with_strokes_scaled(assumption.stroke)
        } else {
            Drives::new(&varied, self.model.clone())?
        };
        let (actuator, control) = (&case.actuator, &case.control);
        let rotor_case =
            Case { actuator: actuator.clone(), control: control.clone(), ..varied.clone() };
        varied.tolerances.trim = TABLE_TRIM_TOLERANCE;
        varied.tolerances.periodicity = TABLE_PERIODICITY_TOLERANCE;
        varied.tolerances.inflow = TABLE_INFLOW_TOLERANCE;
        varied.control.step_tolerance = TABLE_STEP_TOLERANCE.max(varied.control.step_tolerance);
        let rotor =
            if rotor_case == *case { base.clone() } else { TrimmedRotor::near(&varied, base)? };
        let blades = varied.rotor.blades;
        let loads = self.sets.iter().map(|set| {
            let study = ideal_control(&varied, &rotor, &limited, set)?;
            Ok(HubLoads::from_parts(study.state.rotor.hub.harmonic(blades)))
        });
        let loads = loads.collect::<Result<Vec<HubLoads>, StudyError>>();
        (self.done)();
        let baseline = HubLoads::from_parts(rotor.trim().rotor.hub.harmonic(blades));
        Ok(SensitivityRecord { baseline, hub_nb_per_rev: loads? })
    }
}

/// Which assumptions are changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Assumptions {
    /// All but those of a free wake of which a case that flies in none makes no use.
    WithoutWake,
    /// Those too.
    WithWake,
}

impl Assumptions {
    /// Number of rows [`sensitivities`] makes of a case or leaves out, for a progress bar.
    pub fn rows(self, case: &Case) -> usize {
        let of_case = 1 + assumptions().len();
        match (self, case.inflow.model.free_wake()) {
            (_, Some(_)) => of_case + of_the_wake().len(),
            (Self::WithWake, None) => of_case + 1 + of_the_wake().len(),
            (Self::WithoutWake, None) => of_case,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rotor_case::WindTunnelTrim;

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
        assert_eq!(left_out(&case, true), ["inflow-drees"]);
        assert_eq!(left_out(&case, false), ["inflow-drees", "bench-speed"]);
        case.inflow.model = InflowChoice::Uniform;
        case.trim = TrimValues::WindTunnel(WindTunnelTrim::default());
        case.rotor.modal_damping = 0.01;
        let none = ["damping-010", "fuselage-70", "inflow-uniform"];
        assert_eq!(left_out(&case, true), none);
        // nor what the wake of the case is
        let mut case = controllers_case();
        let near_wake = Some(NearWakeMotion::Convected);
        case.inflow.model =
            InflowChoice::FreeWake(FreeWakeValues { near_wake, ..FreeWakeValues::default() });
        assert_eq!(left_out(&case, true), ["wake-near-convected"]);
    }
}
