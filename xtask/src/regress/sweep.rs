//! The sweep: its cases, what each is reduced to, and how it is computed.

use std::fmt;

use super::snapshot::{Group, Snapshot, Tolerance};

/// Advance ratios of the sweep.
pub const ADVANCE_RATIOS: [f64; 6] = [0.10, 0.15, 0.20, 0.25, 0.30, 0.35];

/// Harmonics of the control, per rev, one at a time.
pub const HARMONICS_PER_REV: [u32; 4] = [2, 3, 4, 5];

/// Names of the twelve 4/rev hub loads, in the order of their array.
pub const HUB_LOADS: [&str; 12] = [
    "fx_cos", "fx_sin", "fy_cos", "fy_sin", "fz_cos", "fz_sin", "mx_cos", "mx_sin", "my_cos",
    "my_sin", "mz_cos", "mz_sin",
];

/// Inflow of a case of the sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SweepInflow {
    /// Drees's.
    Drees,
    /// The free wake at its defaults.
    FreeWake,
}

/// Harmonic of the control, per rev, that is flown in a free wake as well.
pub const FREE_WAKE_HARMONIC_PER_REV: u32 = 4;

/// Advance ratios at which it is: at 0.10 the wake of the defaults does not settle, and no number of it is kept.
pub const FREE_WAKE_ADVANCE_RATIOS: [f64; 5] = [0.15, 0.20, 0.25, 0.30, 0.35];

/// One case of the sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepPoint {
    /// Advance ratio `mu`.
    pub advance_ratio: f64,
    /// Harmonic of the control, per rev.
    pub harmonic_per_rev: u32,
    /// Inflow.
    pub inflow: SweepInflow,
}

impl SweepPoint {
    /// Name of the golden file, for example `mu030_n3.ron`.
    pub fn file_name(&self) -> String {
        let of_the_wake = match self.inflow {
            SweepInflow::Drees => "",
            SweepInflow::FreeWake => "_free_wake",
        };
        let mu = 100.0 * self.advance_ratio;
        format!("mu{mu:03.0}_n{}{of_the_wake}.ron", self.harmonic_per_rev)
    }
}

impl fmt::Display for SweepPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "mu={:.2},n={}", self.advance_ratio, self.harmonic_per_rev)?;
        match self.inflow {
            SweepInflow::Drees => Ok(()),
            SweepInflow::FreeWake => f.write_str(", free wake"),
        }
    }
}

/// All cases, advance ratio by advance ratio: those with Drees's inflow, then those in a free wake.
pub fn all_points() -> Vec<SweepPoint> {
    let of = |inflow, advance_ratios: &'static [f64], harmonics: &'static [u32]| {
        let at = move |&advance_ratio| {
            let point =
                move |&harmonic_per_rev| SweepPoint { advance_ratio, harmonic_per_rev, inflow };
            harmonics.iter().map(point)
        };
        advance_ratios.iter().flat_map(at)
    };
    let in_wake = &[FREE_WAKE_HARMONIC_PER_REV];
    of(SweepInflow::Drees, &ADVANCE_RATIOS, &HARMONICS_PER_REV)
        .chain(of(SweepInflow::FreeWake, &FREE_WAKE_ADVANCE_RATIOS, in_wake))
        .collect()
}

/// Trim of a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrimChannels {
    /// Collective at three quarters of the radius, deg.
    pub theta0_deg: f64,
    /// Cosine cyclic, deg.
    pub theta1c_deg: f64,
    /// Sine cyclic, deg.
    pub theta1s_deg: f64,
    /// Shaft tilt, forward positive, deg.
    pub alpha_s_deg: f64,
    /// Roll to the right, deg.
    pub phi_s_deg: f64,
    /// Inflow ratio through the disk, mean, over the tip speed.
    pub inflow: f64,
}

/// What a case is reduced to. Hub loads are the 4/rev ones of [`HUB_LOADS`], forces over
/// m0 Omega^2 R^2, moments over m0 Omega^2 R^3.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepResult {
    /// Trim without control.
    pub trim: TrimChannels,
    /// Hub loads without control.
    pub baseline_loads: [f64; 12],
    /// Hub loads with control.
    pub controlled_loads: [f64; 12],
    /// `J_Z` without control.
    pub j_before: f64,
    /// `J_Z` with control.
    pub j_after: f64,
    /// Frobenius norm of the T matrix, loads per volt.
    pub t_matrix_norm_per_volt: f64,
    /// Solver statistics: names and counts, in the order in which they are kept.
    pub counts: Vec<(&'static str, usize)>,
}

/// A channel may move by this share of its value between machines and compilers: well below the 1 %
/// that must be seen, well above the 1e-8 to which trim and periodicity are converged.
const RELATIVE: f64 = 1e-3;

/// Floors far below anything the physics gives, for values that are zero by symmetry.
const LOAD_FLOOR: f64 = 1e-13;
const COST_FLOOR: f64 = 1e-22;
const TRIM_FLOOR: f64 = 1e-10;

impl SweepResult {
    /// The result as named channels.
    pub fn snapshot(&self, point: SweepPoint) -> Snapshot {
        let scaled = |absolute| Tolerance::Scaled { relative: RELATIVE, absolute };
        let group = |name: &str, unit: &str, tolerance, channels: &[(&str, f64)]| Group {
            name: name.to_owned(),
            unit: unit.to_owned(),
            tolerance,
            channels: channels.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
        };
        let loads = |name: &str, loads: &[f64; 12]| {
            let channels: Vec<_> = HUB_LOADS.into_iter().zip(*loads).collect();
            let half = |kind: &str, unit: &str, part: &[(&str, f64)]| {
                group(&format!("{name} hub {kind}, 4/rev"), unit, scaled(LOAD_FLOOR), part)
            };
            let (forces, moments) = channels.split_at(6);
            [half("forces", "m0 Omega^2 R^2", forces), half("moments", "m0 Omega^2 R^3", moments)]
        };
        let angles = [
            ("theta0_deg", self.trim.theta0_deg),
            ("theta1c_deg", self.trim.theta1c_deg),
            ("theta1s_deg", self.trim.theta1s_deg),
            ("alpha_s_deg", self.trim.alpha_s_deg),
            ("phi_s_deg", self.trim.phi_s_deg),
        ];
        let inflow = [("inflow", self.trim.inflow)];
        let cost = [("j_before", self.j_before), ("j_after", self.j_after)];
        let norm = [("t_matrix_norm", self.t_matrix_norm_per_volt)];
        let counts: Vec<(&str, f64)> =
            self.counts.iter().map(|(name, count)| (*name, *count as f64)).collect();
        let mut groups = vec![
            group("trim angles", "deg", scaled(TRIM_FLOOR), &angles),
            group("trim inflow", "Omega R", scaled(TRIM_FLOOR), &inflow),
        ];
        groups.extend(loads("baseline", &self.baseline_loads));
        groups.extend(loads("controlled", &self.controlled_loads));
        groups.push(group("cost", "squared hub loads", scaled(COST_FLOOR), &cost));
        groups.push(group("T matrix", "hub loads per volt", scaled(LOAD_FLOOR), &norm));
        groups.push(group("solver statistics", "count", Tolerance::Exact, &counts));
        Snapshot {
            advance_ratio: point.advance_ratio,
            harmonic_per_rev: point.harmonic_per_rev,
            groups,
        }
    }
}
