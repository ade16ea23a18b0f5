//! The page on dynamic stall.

use super::cycle::extreme;
use super::{Judged, OfAirfoil};
use std::fmt::Write as _;

const INTRODUCTION: &str = "\
# Dynamic stall against measured loops

<!-- Written by `cargo xtask dynamic-stall --data DIR`; do not edit. -->

Lift, pressure drag and moment of pitching aerofoils, measured and computed. The loops are not part of the project: NACA 0012 and
AMES-01 are of McAlister, Pucci, McCroskey and Carr, NASA TM-84245 (1982), read from the digitised tables of the repository
luizpancini/DSmodel; NACA 23012A is of Green and Giuni, University of Glasgow (2017), phase averages of ten cycles at Mach 0.12.

The model is that of Leishman and Beddoes ([section aerodynamics](theory/section-aero.md)), with three additions that the loops
ask for: a lag of its own for flow that attaches again, and strength and lever of the vortex. The constants of the program are
fitted to all loops of an aerofoil; `cargo xtask dynamic-stall --data DIR --fit` repeats that. What they are worth elsewhere is
told by cross-validation: the loops are dealt out to four parts in turn, and each part is judged by constants fitted to the
other three.

An error of an extreme is that of the highest lift, the highest drag and the lowest moment, over its size.
The root mean square of a loop is taken over its measured points. Tables give medians over loops.
";

const LIMITS: &str = "
## What the model does not follow

- *Light stall at high frequency.* At `k` of 0.15 and more, where the moment breaks for a moment only, the model often sheds no
  vortex: drag and moment are then missed by half.
- *Two vortices.* At high incidence a second vortex leaves before the flow attaches. The model knows one at a time.
- *Very slow loops.* At `k` below 0.003 the flow has a static hysteresis. The model has none.
- *Mach number.* In that tunnel the Reynolds number went with the Mach number: what the constants do below 0.3 is the effect of
  both. Beyond 0.3 there are no loops. The constants then follow the published trend of the NACA 0012.
- *Flaps.* No loop has a flap.
";

/// The whole page.
pub(super) fn page(found: &[OfAirfoil]) -> String {
    let mut text = INTRODUCTION.to_owned();
    for of in found {
        let _ = writeln!(text, "\n## {}: `{:?}`", of.name, of.airfoil);
        text += HEADER;
        let rows = [
            ("constants of the program, fitted to all loops", &of.stored),
            ("cross-validated: no loop seen by its fit", &of.unseen),
            ("published constants of the NACA 0012", &of.published),
        ];
        for (title, judged) in rows {
            text += &row(title, &judged.iter().collect::<Vec<_>>());
        }
        text += "\nCross-validated, by what a loop is:\n";
        text += &binned(&of.unseen);
    }
    text + LIMITS
}

const HEADER: &str = "\
| loops | number | highest lift, % | highest drag, % | lowest moment, % | lift, rms | drag, rms | moment, rms |
|---|---|---|---|---|---|---|---|
";

fn row(title: &str, loops: &[&Judged]) -> String {
    let over = |pick: &dyn Fn(&Judged) -> f64| median(loops.iter().map(|j| pick(j)).collect());
    let mut text = format!("| {title} | {} |", loops.len());
    for which in 0..3 {
        let _ = write!(text, " {:.1} |", over(&|j| j.errors.extreme_percent[which].abs()));
    }
    for which in 0..3 {
        let _ = write!(text, " {:.3} |", over(&|j| j.errors.rms[which]));
    }
    text + "\n"
}

/// The same by frequency, by highest incidence, by amplitude and by Mach number.
fn binned(judged: &[Judged]) -> String {
    type Pick = fn(&Judged) -> f64;
    let bins: [(&str, Pick, &[f64]); 4] = [
        ("k", |j| j.measured.reduced_frequency, &[0.0, 0.03, 0.08, 0.13, 1.0]),
        ("mean, deg", |j| j.measured.mean_deg, &[0.0, 9.5, 12.5, 30.0]),
        ("amplitude, deg", |j| j.measured.amplitude_deg, &[0.0, 6.0, 9.0, 20.0]),
        ("Mach", |j| j.measured.mach, &[0.0, 0.1, 0.25, 0.4]),
    ];
    let mut text = String::from(HEADER);
    for (name, pick, edges) in bins {
        for pair in edges.windows(2) {
            let inside = |j: &&Judged| (pair[0]..pair[1]).contains(&pick(j));
            let loops: Vec<&Judged> = judged.iter().filter(inside).collect();
            if !loops.is_empty() {
                text += &row(&format!("{name} {} to {}", pair[0], pair[1]), &loops);
            }
        }
    }
    let stalls = |j: &&Judged| {
        let moments = j.measured.values[2].iter().map(|[_, value]| *value);
        extreme(moments, 2) < DEEP
    };
    let (deep, light): (Vec<&Judged>, Vec<&Judged>) = judged.iter().partition(stalls);
    text += &row(&format!("moment below {DEEP}"), &deep);
    text += &row("others", &light);
    text
}

/// Lowest moment that tells of a vortex.
const DEEP: f64 = -0.08;

fn median(mut values: Vec<f64>) -> f64 {
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
