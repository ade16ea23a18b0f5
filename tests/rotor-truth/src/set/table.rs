//! The table of readings, with noise.

use super::fly::{Group, Readings};
use crate::physics::fourier::Pair;
use chacha20::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Hub loads and their units.
const LOADS: [(&str, &str); 6] =
    [("fx", "N"), ("fy", "N"), ("fz", "N"), ("mx", "Nm"), ("my", "Nm"), ("mz", "Nm")];
/// Loads and harmonics below 4/rev that are read.
const LOWER: [(usize, usize); 7] = [(0, 1), (1, 1), (2, 1), (0, 2), (2, 2), (4, 2), (2, 3)];
/// Deviation of a control as read, deg.
const CONTROL_SD_DEG: f64 = 0.02;

/// What noise is common to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Control,
    Power,
    Force(usize),
    Moment(usize),
}

struct Channel {
    name: String,
    kind: Kind,
    values: Vec<f64>,
}

fn channels(readings: &[&Readings]) -> Vec<Channel> {
    let mut out = Vec::new();
    for (k, name) in ["theta0_deg", "theta1c_deg", "theta1s_deg"].into_iter().enumerate() {
        let values = readings.iter().map(|own| own.controls_deg[k]).collect();
        out.push(Channel { name: name.to_owned(), kind: Kind::Control, values });
    }
    let values = readings.iter().map(|own| own.power_watt).collect();
    out.push(Channel { name: "power_W".to_owned(), kind: Kind::Power, values });
    let main = (0..6).map(|load| (load, 4));
    for (load, harmonic) in main.chain(LOWER) {
        let (name, unit) = LOADS[load];
        let kind = if load < 3 { Kind::Force(harmonic) } else { Kind::Moment(harmonic) };
        for part in ["cos", "sin"] {
            let name = format!("{name}_n{harmonic}_{part}_{unit}");
            let of = |own: &Pair| if part == "cos" { own.cosine } else { own.sine };
            let values = readings.iter().map(|own| of(&own.hub[load][harmonic])).collect();
            out.push(Channel { name, kind, values });
        }
    }
    out
}

/// Standard deviations by kind; a harmonic that a rotor of like blades does not have gets that of 4/rev.
fn deviations(channels: &[Channel], share: f64) -> BTreeMap<Kind, f64> {
    let rms = |kind: Kind| {
        let all = channels.iter().filter(|own| own.kind == kind).flat_map(|own| &own.values);
        let (sum, count) = all.fold((0.0, 0.0), |(sum, count), x| (sum + x * x, count + 1.0));
        share * f64::sqrt(sum / f64::max(count, 1.0))
    };
    let one = |kind| match kind {
        Kind::Control => CONTROL_SD_DEG,
        Kind::Power => rms(kind),
        Kind::Force(_) => rms(kind).max(rms(Kind::Force(4))),
        Kind::Moment(_) => rms(kind).max(rms(Kind::Moment(4))),
    };
    channels.iter().map(|own| (own.kind, one(own.kind))).collect()
}

/// Drive columns: flap from 0 and harmonic.
fn drive_columns(groups: &[Group]) -> BTreeSet<(usize, usize)> {
    let mut out = BTreeSet::new();
    for drive in groups.iter().flat_map(|own| &own.drives) {
        for (flap, voltage) in drive.iter().enumerate() {
            out.extend(voltage.iter().map(|(n, _)| (flap, *n)));
        }
    }
    out
}

/// The table as text; noise of `snr_db` below the root mean square of each kind of channel.
pub fn text(
    groups: &[Group],
    readings: &[Vec<Readings>],
    snr_db: f64,
    rng: &mut ChaCha8Rng,
) -> String {
    let flat: Vec<&Readings> = readings.iter().flatten().collect();
    let mut channels = channels(&flat);
    let deviations = deviations(&channels, 10.0_f64.powf(-snr_db / 20.0));
    let sd = |kind: Kind| deviations.get(&kind).copied().unwrap_or(0.0);
    for own in &mut channels {
        for value in &mut own.values {
            let normal: f64 = StandardNormal.sample(rng);
            *value += sd(own.kind) * normal;
        }
    }
    let drives = drive_columns(groups);
    let mut out = String::from("point,group,advance_ratio,ct_sigma,shaft_tilt_deg,omega_rpm");
    for (flap, n) in &drives {
        for part in ["cos", "sin"] {
            // writing to a text cannot fail
            let _ = write!(out, ",flap{}_n{n}_{part}_V", flap + 1);
        }
    }
    for own in &channels {
        let _ = write!(out, ",{0},{0}_sd", own.name);
    }
    let mut row = 0;
    for (number, group) in groups.iter().enumerate() {
        for drive in &group.drives {
            let c = &group.condition;
            let _ = write!(
                out,
                "\np{},{},{:.4},{:.4},{:.3},{:.1}",
                row + 1,
                number + 1,
                c.advance_ratio,
                c.ct_sigma,
                c.tilt_deg,
                c.omega_rpm
            );
            for (flap, n) in &drives {
                let own = drive.get(*flap).and_then(|all| all.iter().find(|own| own.0 == *n));
                let own = own.map_or(Pair::default(), |own| own.1);
                let _ = write!(out, ",{:.2},{:.2}", own.cosine, own.sine);
            }
            for own in &channels {
                let _ = write!(out, ",{:.6e},{:.3e}", own.values[row], sd(own.kind));
            }
            row += 1;
        }
    }
    out.push('\n');
    out
}
