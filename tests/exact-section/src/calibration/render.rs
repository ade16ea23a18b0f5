//! A calibration as the table the section models are built with.

use std::fmt::Write;

use super::{Calibration, FLAP_RANGE, FLAP_TERMS, MACH_RANGE, MACH_TERMS, POLES, pole_law};

/// Pairs `[load, downwash]` whose gains do not depend on the flap.
pub(super) const RIGID: [[usize; 2]; 4] = [[0, 0], [0, 1], [1, 0], [1, 1]];
/// Pairs whose gains do.
pub(super) const FLAPPED: [[usize; 2]; 8] =
    [[0, 2], [0, 3], [1, 2], [1, 3], [2, 0], [2, 1], [2, 2], [2, 3]];

impl Calibration {
    /// The table as Rust items, to be included: the same text for the same calibration.
    pub fn source(&self) -> String {
        let mut text = String::from(HEADER);
        let mut put = |line: std::fmt::Arguments<'_>| {
            // writing to a string does not fail
            let _ = writeln!(text, "{line}");
        };
        let [low, high] = MACH_RANGE;
        put(format_args!("/// Mach numbers the calibration spans."));
        put(format_args!("pub(super) const MACH_RANGE: [f64; 2] = [{low:?}, {high:?}];"));
        let [low, high] = FLAP_RANGE;
        put(format_args!("/// Flap chord ratios the calibration spans."));
        put(format_args!("pub(super) const FLAP_RANGE: [f64; 2] = [{low:?}, {high:?}];"));
        put(format_args!("/// Number of poles."));
        put(format_args!("pub(super) const POLES: usize = {POLES};"));
        put(format_args!("/// Chebyshev terms in the Mach number."));
        put(format_args!("pub(super) const MACH_TERMS: usize = {MACH_TERMS};"));
        put(format_args!("/// Chebyshev terms in the flap chord."));
        put(format_args!("pub(super) const FLAP_TERMS: usize = {FLAP_TERMS};"));
        put(format_args!("/// Smallest ratio of neighbouring poles."));
        put(format_args!("pub(super) const SMALLEST_RATIO: f64 = {:?};", pole_law::SMALLEST_RATIO));
        put(format_args!("/// Poles that belong to the pressure waves."));
        put(format_args!("pub(super) const FAST: usize = {};", pole_law::FAST));
        put(format_args!("/// `[a, b, c]` of the law of each pole, fastest first."));
        put(format_args!("pub(super) const POLE_LAW: [[f64; 3]; {POLES}] = ["));
        for [a, b, c] in self.law.parameters {
            put(format_args!("    [{a:?}, {b:?}, {c:?}],"));
        }
        put(format_args!("];"));
        let gain = |[o, j]: [usize; 2], m: usize, f: usize| -> String {
            let row: Vec<String> = (0..POLES - 1)
                .map(|q| format!("{:?}", self.table.coefficients[o][j][q][m][f]))
                .collect();
            row.join(", ")
        };
        let (g, m) = (POLES - 1, MACH_TERMS);
        put(format_args!(
            "/// Gains of incidence and pitch rate in lift and moment, `[pair][Mach term]`."
        ));
        put(format_args!("pub(super) static RIGID: [[[f64; {g}]; {m}]; {}] = [", RIGID.len()));
        for pair in RIGID {
            put(format_args!("    ["));
            for m in (0..MACH_TERMS).step_by(2) {
                put(format_args!("        [{}], [{}],", gain(pair, m, 0), gain(pair, m + 1, 0)));
            }
            put(format_args!("    ],"));
        }
        put(format_args!("];"));
        put(format_args!(
            "/// Gains that depend on the flap chord, `[pair][flap term][Mach term]`."
        ));
        put(format_args!(
            "pub(super) static FLAPPED: [[[[f64; {g}]; {m}]; {FLAP_TERMS}]; {}] = [",
            FLAPPED.len()
        ));
        for pair in FLAPPED {
            put(format_args!("    ["));
            for f in 0..FLAP_TERMS {
                put(format_args!("        ["));
                for m in (0..MACH_TERMS).step_by(2) {
                    put(format_args!(
                        "            [{}], [{}],",
                        gain(pair, m, f),
                        gain(pair, m + 1, f)
                    ));
                }
                put(format_args!("        ],"));
            }
            put(format_args!("    ],"));
        }
        put(format_args!("];"));
        text
    }
}

const HEADER: &str = "\
// Poles and gains of the calibrated model. Written by `cargo xtask calibrate`: do not edit.
//
// Fitted to solutions of Possio's integral equation. Gains are Chebyshev coefficients of `M gain`
// in `ln(M/(1 - M))` and in the flap chord, per pole but the fastest.

";
