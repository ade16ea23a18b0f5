//! Whether the controls of Elliott and Althoff's rotor fit its thrust: blade elements in the measured inflow itself.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use nalgebra::{Matrix3, Vector3};
use rotor_wake::{InflowModel, LinearInflow, RotorLoading};
use validation::{Check, Failure, row};

use crate::measured_inflow::{
    CASES, CHORD, MeasuredCase, MeasuredInflow, THRUST, TIP_MACH, TWIST_RAD,
};

pub(crate) const ROWS: &[Check] = &[
    row("V-WAKE-68", "mu 0.15: thrust at the stated controls, thin aerofoil, over the measured", "-")
        .against(ELEMENTS)
        .near(2.05, 0.06, || Ok(found(0, &PLAIN)?.thrust_ratio)),
    row("V-WAKE-69", "the same with lift slope 5.73, tip loss 0.97, cut-out 0.24 R", "-")
        .against(ELEMENTS)
        .near(1.69, 0.05, || Ok(found(0, &CAUTIOUS)?.thrust_ratio)),
    row("V-WAKE-70", "mu 0.23: thrust at the stated controls, thin aerofoil, over the measured", "-")
        .against(ELEMENTS)
        .near(1.77, 0.06, || Ok(found(1, &PLAIN)?.thrust_ratio)),
    row("V-WAKE-71", "the same with lift slope 5.73, tip loss 0.97, cut-out 0.24 R", "-")
        .against(ELEMENTS)
        .near(1.48, 0.05, || Ok(found(1, &CAUTIOUS)?.thrust_ratio)),
    row(
        "V-WAKE-72",
        "mu 0.15: collective needed less the stated, the smallest gap of 48 choices of lift slope, tip loss, cut-out and inflow",
        "deg",
    )
    .against(CHOICES)
    .at_most(-2.0, || smallest_gap_deg(0)),
    row("V-WAKE-73", "mu 0.23: the same", "deg")
        .against(CHOICES)
        .at_most(-0.9, || smallest_gap_deg(1)),
    row("V-WAKE-74", "mu 0.15: factor on the inflow that closes the collective, the least", "-")
        .against(CHOICES)
        .at_least(2.3, || least_factor(0)),
    row("V-WAKE-75", "mu 0.23: the same", "-").against(CHOICES).at_least(2.0, || least_factor(1)),
    row("V-WAKE-76", "mu 0.15: stated collective over the needed", "-")
        .against(CAUTIOUSLY)
        .near(1.44, 0.04, || Ok(found(0, &CAUTIOUS)?.pitch_ratio(0))),
    row("V-WAKE-77", "the same: sin part; one factor on the pitch explains both", "-")
        .against(CAUTIOUSLY)
        .near(1.39, 0.04, || Ok(found(0, &CAUTIOUS)?.pitch_ratio(2))),
    row("V-WAKE-78", "mu 0.23: stated collective over the needed", "-")
        .against(CAUTIOUSLY)
        .near(1.32, 0.04, || Ok(found(1, &CAUTIOUS)?.pitch_ratio(0))),
    row("V-WAKE-79", "the same: sin part", "-")
        .against(CAUTIOUSLY)
        .near(1.24, 0.04, || Ok(found(1, &CAUTIOUS)?.pitch_ratio(2))),
];

const ELEMENTS: &str =
    "a second program of blade elements in the measured inflow; 1 would be agreement";
const CHOICES: &str = "0 would be agreement (1 for the factor): 2 pi or 5.73, tip loss 1 or .97, cut-out .20 or .24 R, inflow \
                       measured, uniform or Drees's, the gap also with 1.3 times each";
const CAUTIOUSLY: &str = "a second program; lift slope 5.73, tip loss 0.97, cut-out 0.24 R, measured inflow; 1 would be agreement";

/// Where the induced inflow comes from.
#[derive(Debug, Clone, Copy)]
enum Inflow {
    Measured,
    Linear(LinearInflow),
}

/// What one may take for the sections and the inflow.
#[derive(Debug, Clone, Copy)]
struct Choice {
    /// Per rad, incompressible.
    lift_slope: f64,
    /// No lift outboard of this station, unit `R`.
    tip_loss: f64,
    cut_out: f64,
    inflow: Inflow,
    /// On the induced inflow.
    factor: f64,
}

const PLAIN: Choice =
    Choice { lift_slope: TAU, tip_loss: 1.0, cut_out: 0.2, inflow: Inflow::Measured, factor: 1.0 };
const CAUTIOUS: Choice = Choice { lift_slope: 5.73, tip_loss: 0.97, cut_out: 0.24, ..PLAIN };
const UNIFORM: Inflow = Inflow::Linear(LinearInflow::Uniform);
const DREES: Inflow = Inflow::Linear(LinearInflow::Drees);

/// What the rotor does under a choice.
#[derive(Debug)]
struct Found {
    /// Thrust at the stated controls over the measured one.
    thrust_ratio: f64,
    /// Mean at 0.75 R, cos and sin part of the pitch that gives the measured thrust and no moment at the hub.
    needed_deg: [f64; 3],
    stated_deg: [f64; 3],
    /// On the induced inflow, with which the stated controls give the measured thrust.
    closing_factor: f64,
}

impl Found {
    fn pitch_ratio(&self, part: usize) -> f64 {
        self.stated_deg[part] / self.needed_deg[part]
    }

    fn gap_deg(&self, part: usize) -> f64 {
        self.needed_deg[part] - self.stated_deg[part]
    }
}

/// Thrust, cos and sin part of the flapping moment: by pitch (mean, cos, sin), by twist and free stream, by the
/// induced inflow. Rigid blades in the plane of the hub, small angles:
///
/// ```text
/// dC_T = (sigma a / 2 beta) |U_T| (U_T theta - mu tan(alpha) - lambda_i) dr,    mean over psi
/// ```
fn loads(case: &MeasuredCase, choice: &Choice) -> Result<[[f64; 5]; 3], Failure> {
    const AZIMUTHS: usize = 72;
    const ELEMENTS: usize = 60;
    let flight = case.flight();
    let map = MeasuredInflow::read(case)?;
    let model = match choice.inflow {
        Inflow::Measured => None,
        Inflow::Linear(model) => {
            Some(model.induced(&flight, &RotorLoading::from_thrust_coefficient(THRUST))?)
        }
    };
    let width = (choice.tip_loss - choice.cut_out) / ELEMENTS as f64;
    let share = 2.0 * CHORD / PI * choice.lift_slope * width / AZIMUTHS as f64;
    let mut sums = [[0.0; 5]; 3];
    for i in 0..AZIMUTHS {
        let azimuth = TAU * (i as f64 + 0.5) / AZIMUTHS as f64;
        let (sin, cos) = azimuth.sin_cos();
        for k in 0..ELEMENTS {
            let r = choice.cut_out + (k as f64 + 0.5) * width;
            let along = r + case.advance_ratio * sin;
            let lift = share * along.abs() / (1.0 - (TIP_MACH * along).powi(2)).sqrt();
            let induced =
                model.as_ref().map_or_else(|| map.at(azimuth, r), |model| model.at(azimuth, r));
            let steady = along * TWIST_RAD * (r - 0.75) - flight.normal_inflow();
            let parts = [along, along * cos, along * sin, steady, -choice.factor * induced];
            for (sum, arm) in sums.iter_mut().zip([1.0, 2.0 * r * cos, 2.0 * r * sin]) {
                for (sum, part) in sum.iter_mut().zip(parts) {
                    *sum += arm * lift * part;
                }
            }
        }
    }
    Ok(sums)
}

fn found(case: usize, choice: &Choice) -> Result<Found, Failure> {
    let case = &CASES[case];
    let loads = loads(case, choice)?;
    let stated_rad = case.pitch_deg.map(f64::to_radians);
    let [thrust, ..] = loads;
    let free = stated_rad.iter().zip(thrust).map(|(pitch, slope)| pitch * slope).sum::<f64>();
    let slopes = Matrix3::from_fn(|row, column| loads[row][column]);
    let missing = Vector3::from_fn(|row, _| {
        (if row == 0 { THRUST } else { 0.0 }) - loads[row][3] - loads[row][4]
    });
    let needed = slopes.lu().solve(&missing).ok_or("the pitch does not move thrust and moments")?;
    Ok(Found {
        thrust_ratio: (free + thrust[3] + thrust[4]) / THRUST,
        needed_deg: [0, 1, 2].map(|part| needed[part].to_degrees()),
        stated_deg: case.pitch_deg,
        closing_factor: choice.factor * (free + thrust[3] - THRUST) / -thrust[4],
    })
}

/// All choices together.
fn choices() -> impl Iterator<Item = Choice> {
    let inflows = [Inflow::Measured, UNIFORM, DREES];
    inflows.into_iter().flat_map(|inflow| {
        (0..16).map(move |bits| {
            let pick = |bit: u32, values: [f64; 2]| values[(bits >> bit) & 1];
            Choice {
                lift_slope: pick(0, [TAU, 5.73]),
                tip_loss: pick(1, [1.0, 0.97]),
                cut_out: pick(2, [0.2, 0.24]),
                inflow,
                factor: pick(3, [1.0, 1.3]),
            }
        })
    })
}

/// Of all choices: collective needed less the stated one, nearest to nothing.
fn smallest_gap_deg(case: usize) -> Result<f64, Failure> {
    let gaps = choices().map(|choice| Ok(found(case, &choice)?.gap_deg(0)));
    gaps.collect::<Result<Vec<f64>, Failure>>()?
        .into_iter()
        .min_by(|a, b| a.abs().total_cmp(&b.abs()))
        .ok_or_else(|| "no choice".into())
}

fn least_factor(case: usize) -> Result<f64, Failure> {
    let factors = choices().map(|choice| Ok(found(case, &choice)?.closing_factor));
    Ok(factors.collect::<Result<Vec<f64>, Failure>>()?.into_iter().fold(f64::INFINITY, f64::min))
}

#[test]
fn the_table_of_the_book_is_computed() {
    let wider = Choice { lift_slope: 5.73, ..PLAIN };
    let lossy = Choice { tip_loss: 0.97, ..wider };
    let with = |inflow, factor| Choice { inflow, factor, ..CAUTIOUS };
    let lines = [
        ("measured; 2 pi, no tip loss, cut-out 0.20 R", PLAIN),
        ("lift slope 5.73", wider),
        ("tip loss 0.97 too", lossy),
        ("cut-out 0.24 R too", CAUTIOUS),
        ("all of it, measured inflow x 1.3", with(Inflow::Measured, 1.3)),
        ("all of it, uniform inflow (Glauert)", with(UNIFORM, 1.0)),
        ("all of it, Drees's inflow", with(DREES, 1.0)),
        ("all of it, Drees's inflow x 1.3", with(DREES, 1.3)),
    ];
    let mut table = String::new();
    for (name, choice) in lines {
        write!(table, "| {name} |").unwrap();
        for case in 0..CASES.len() {
            let found = found(case, &choice).unwrap();
            let [mean, cos, sin] = [0, 1, 2].map(|part| found.gap_deg(part));
            let (thrust, factor) = (found.thrust_ratio, found.closing_factor);
            write!(table, " {thrust:.2} | {mean:+.2}, {cos:+.2}, {sin:+.2} | {factor:.1} |")
                .unwrap();
        }
        table.push('\n');
    }
    let page = include_str!("../../../../docs/src/measured-inflow.md");
    assert!(page.contains(&table), "docs/src/measured-inflow.md lacks this table:\n{table}");
}
