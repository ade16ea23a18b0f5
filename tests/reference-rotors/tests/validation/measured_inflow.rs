//! The measured inflow of Elliott and Althoff as a map over the disk.

use std::f64::consts::TAU;

use rotor_wake::{FlightState, momentum_inflow};
use validation::{Failure, Table};

/// A flight with its measured inflow.
#[derive(Debug)]
pub(crate) struct MeasuredCase {
    file: &'static str,
    /// The column of the means in time.
    column: &'static str,
    pub(crate) advance_ratio: f64,
    /// Of the shaft, forward positive.
    tilt_deg: f64,
    /// Mean at 0.75 R, cos and sin part, as the third-party table has it.
    pub(crate) pitch_deg: [f64; 3],
}

pub(crate) const CASES: [MeasuredCase; 2] = [
    MeasuredCase {
        file: "nasa_report_rotor_inflow_data_mu_015.csv",
        column: "Mean",
        advance_ratio: 0.15,
        tilt_deg: 3.00,
        pitch_deg: [9.37, 1.11, -3.23],
    },
    MeasuredCase {
        file: "nasa_report_rotor_inflow_data_mu_023.csv",
        column: "mean",
        advance_ratio: 0.23,
        tilt_deg: 3.04,
        pitch_deg: [8.16, 1.52, -4.13],
    },
];
const RADIUS_M: f64 = 0.860_552;
/// Unit `R`.
pub(crate) const CHORD: f64 = 0.066_04 / RADIUS_M;
/// Linear, zero at 0.75 R.
pub(crate) const TWIST_RAD: f64 = -8.0 * TAU / 360.0;
pub(crate) const TIP_MACH: f64 = 2113.0 * TAU / 60.0 * RADIUS_M / 340.0;
/// Measured thrust coefficient.
pub(crate) const THRUST: f64 = 0.0064;

/// Stations of mu 0.23, psi 60 deg that stand between 0.82 and 0.94 in the file, and how they are read.
const SLIPS: [[f64; 2]; 2] = [[0.286, 0.86], [0.29, 0.90]];

impl MeasuredCase {
    pub(crate) fn flight(&self) -> FlightState {
        let shaft_tilt_rad = self.tilt_deg.to_radians();
        FlightState { advance_ratio: self.advance_ratio, shaft_tilt_rad }
    }

    /// Induced inflow of momentum theory at the measured thrust.
    pub(crate) fn glauert(&self) -> Result<f64, Failure> {
        Ok(momentum_inflow(&self.flight(), THRUST)?)
    }
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

/// One measured azimuth.
#[derive(Debug)]
struct Ray {
    azimuth_rad: f64,
    /// Station and induced inflow, down positive, from 0.2 R outboard.
    points: Vec<[f64; 2]>,
}

/// The measured map.
#[derive(Debug)]
pub(crate) struct MeasuredInflow(Vec<Ray>);

impl MeasuredInflow {
    pub(crate) fn read(case: &MeasuredCase) -> Result<Self, Failure> {
        let table = Table::read(&format!("../measured/elliott_althoff/{}", case.file))?;
        let mut rays: Vec<Ray> = Vec::new();
        for row in table.rows() {
            let (psi, r) = (row.number("psi")?, row.number("r/R")?);
            // psi 0 appears again as 360
            if psi >= 359.0 || !(0.2..=1.0).contains(&r) {
                continue;
            }
            let station = SLIPS.iter().find(|slip| same(slip[0], r)).map_or(r, |slip| slip[1]);
            let point = [station, -row.number(case.column)?];
            let azimuth_rad = psi.to_radians();
            match rays.last_mut() {
                Some(ray) if same(ray.azimuth_rad, azimuth_rad) => ray.points.push(point),
                _ => rays.push(Ray { azimuth_rad, points: vec![point] }),
            }
        }
        let is_sound = |ray: &Ray| ray.points.is_sorted_by(|a, b| a[0] < b[0]);
        if !rays.is_sorted_by(|a, b| a.azimuth_rad < b.azimuth_rad) || !rays.iter().all(is_sound) {
            return Err(format!("{}: azimuths and stations do not ascend", case.file).into());
        }
        Ok(Self(rays))
    }

    /// Azimuth and station of every point.
    pub(crate) fn places(&self) -> impl Iterator<Item = (f64, f64)> {
        self.0.iter().flat_map(|ray| ray.points.iter().map(|[r, _]| (ray.azimuth_rad, *r)))
    }

    /// Inflow at every point.
    pub(crate) fn values(&self) -> impl Iterator<Item = f64> {
        self.0.iter().flat_map(|ray| ray.points.iter().map(|[_, inflow]| *inflow))
    }

    /// Share of every point in a mean over the disk: `r dr` along an azimuth, the same for every azimuth.
    pub(crate) fn weights(&self) -> Vec<f64> {
        let of_ray = |ray: &Ray| {
            let r = |k: usize| ray.points[k.min(ray.points.len() - 1)][0];
            let shares: Vec<f64> =
                (0..ray.points.len()).map(|k| r(k) * (r(k + 1) - r(k.saturating_sub(1)))).collect();
            let whole = shares.iter().sum::<f64>() * self.0.len() as f64;
            shares.into_iter().map(move |share| share / whole)
        };
        self.0.iter().flat_map(of_ray).collect()
    }

    /// Mean over the disk.
    pub(crate) fn mean(&self) -> f64 {
        self.weights().iter().zip(self.values()).map(|(w, inflow)| w * inflow).sum()
    }

    /// Between the points by straight lines, beyond them the outermost.
    pub(crate) fn at(&self, azimuth_rad: f64, station: f64) -> f64 {
        let after = self.0.partition_point(|ray| ray.azimuth_rad <= azimuth_rad);
        let last = self.0.len() - 1;
        let [a, b] = [&self.0[after.checked_sub(1).unwrap_or(last)], &self.0[after % (last + 1)]];
        let from = |ray: &Ray, to: f64| (to - ray.azimuth_rad).rem_euclid(TAU);
        let part = from(a, azimuth_rad) / from(a, b.azimuth_rad);
        let [inner, outer] = [a, b].map(|ray| {
            let k = ray.points.partition_point(|[r, _]| *r <= station);
            let [[r0, v0], [r1, v1]] =
                [k.saturating_sub(1), k.min(ray.points.len() - 1)].map(|k| ray.points[k]);
            if r1 > r0 { v0 + (v1 - v0) * ((station - r0) / (r1 - r0)).max(0.0) } else { v0 }
        });
        inner + part * (outer - inner)
    }
}
