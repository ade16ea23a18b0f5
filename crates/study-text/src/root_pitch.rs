//! Flaps against root pitch as a table.

use hhc_control::reduction_percent;
use report_page::{Sheet, table};
use rotor_study::{Actuation, MotionHarmonic, RootPitchComparison};

/// The comparisons for people, one for each set of harmonics, then the warnings.
pub fn root_pitch_text(sets: &[RootPitchComparison], warnings: &[String]) -> String {
    let mut sheet = Sheet::default();
    for set in sets {
        let names: Vec<String> = set.harmonics.iter().map(usize::to_string).collect();
        let percent = |j: f64| reduction_percent(set.no_control.j_z, j);
        let root = percent(set.root_pitch_reaches);
        sheet.line(format_args!(
            "{}/rev: J falls by {:.2} %. Root pitch without a limit reaches {root:.2} %.{}",
            names.join(", "),
            percent(set.root_pitch.j_z),
            set.flaps_reach.map_or_else(
                || " The case has no flaps.".to_owned(),
                |j| format!(
                    " Flaps within their stroke, on ideal actuators, reach {:.2} %.",
                    percent(j)
                ),
            )
        ));
        let mut header = vec!["", "no control"];
        header.extend(set.flaps.is_some().then_some("flaps"));
        header.push("root pitch");
        sheet.block(&table(&header, rows(set)));
        sheet.line(format_args!(""));
    }
    for warning in warnings {
        sheet.line(format_args!("warning: {warning}"));
    }
    sheet.finish()
}

/// What a row says of one actuation.
type Cell<'a> = &'a dyn Fn(&Actuation) -> String;

/// The lines of one comparison.
fn rows(set: &RootPitchComparison) -> Vec<Vec<String>> {
    let states: Vec<&Actuation> = std::iter::once(&set.no_control)
        .chain(&set.flaps)
        .chain(std::iter::once(&set.root_pitch))
        .collect();
    let row = |name: String, of: Cell<'_>| {
        std::iter::once(name).chain(states.iter().map(|state| of(state))).collect::<Vec<String>>()
    };
    let mut rows: Vec<Vec<String>> = Vec::new();
    for &n in &set.harmonics {
        rows.push(row(format!("amplitude at {n}/rev, deg"), &|a| {
            motion(a, n, |m| m.amplitude_deg, 3)
        }));
        rows.push(row(format!("phase at {n}/rev, deg"), &|a| motion(a, n, |m| m.phase_deg, 1)));
    }
    let plain: [(&str, Cell<'_>); 7] = [
        ("power given by the actuators, W/blade", &|a| format!("{:.2}", a.given_watt)),
        ("their mean power, W/blade", &|a| format!("{:.2}", a.net_watt)),
        ("shaft power, kW", &|a| format!("{:.3}", 1e-3 * a.shaft_watt)),
        ("flap moment at the root, half p-p, N m", &|a| half(a, 0)),
        ("lag moment at the root, half p-p, N m", &|a| half(a, 1)),
        ("torsion at the root, half p-p, N m", &|a| half(a, 2)),
        ("largest flap moment outboard, half p-p, N m", &|a| {
            format!("{:.1}", a.span_flap_moment_newton_metre)
        }),
    ];
    rows.extend(plain.map(|(name, of)| row(name.to_owned(), of)));
    rows
}

fn half(actuation: &Actuation, moment: usize) -> String {
    format!("{:.1}", actuation.root_moments_newton_metre[moment])
}

/// A number of the motions at a harmonic, root to tip.
fn motion(
    actuation: &Actuation,
    harmonic: usize,
    of: impl Fn(&MotionHarmonic) -> f64,
    digits: usize,
) -> String {
    let each = actuation.motions.iter().filter(|motion| motion.harmonic == harmonic);
    let texts: Vec<String> = each.map(|motion| format!("{:.digits$}", of(motion))).collect();
    if texts.is_empty() { "-".to_owned() } else { texts.join(" / ") }
}
