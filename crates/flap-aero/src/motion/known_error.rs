//! How far the models without a calibration are from exact linear theory: measured, and kept here so that
//! whoever uses them can be told.

use crate::{AttachedFlowModel, Motion};

/// Mach numbers at which the errors were measured.
pub const KNOWN_ERROR_MACHS: [f64; 6] = [0.0, 0.1, 0.3, 0.5, 0.7, 0.8];

/// Flap chords over chord whose worst is the error.
pub const KNOWN_ERROR_FLAP_CHORDS: [f64; 4] = [0.1, 0.2, 0.3, 0.4];

/// Largest reduced frequencies of the two bands of the errors.
pub const KNOWN_ERROR_BANDS: [f64; 2] = [0.3, 1.0];

/// Errors of `Cn`, `Cm` and `Ch`, each for `k` to 0.3 and to 1.
type Errors = [[f64; 2]; 3];

/// Errors in per cent of one model: motion by motion, one row per Mach number.
type Table = [[Errors; 6]; 3];

/// Measured by `cargo xtask calibrate`, flap, pitch, plunge.
const HARIHARAN_LEISHMAN: Table = [
    // flap
    [
        [[36.4, 81.0], [26.8, 57.3], [12.6, 39.3]],
        [[36.0, 79.8], [25.6, 53.8], [13.7, 39.7]],
        [[34.6, 73.8], [19.0, 36.7], [18.3, 40.6]],
        [[33.4, 64.8], [7.6, 15.2], [20.9, 36.3]],
        [[32.0, 45.6], [13.5, 52.0], [16.9, 28.3]],
        [[30.8, 58.4], [22.2, 98.8], [9.8, 19.9]],
    ],
    // pitch
    [
        [[6.1, 49.6], [22.5, 42.3], [40.3, 40.8]],
        [[6.3, 44.4], [20.4, 38.1], [38.8, 39.2]],
        [[7.2, 27.2], [12.4, 19.0], [32.4, 32.4]],
        [[8.4, 21.1], [9.4, 9.4], [25.5, 27.6]],
        [[10.0, 14.2], [13.9, 17.9], [36.2, 36.2]],
        [[14.3, 14.3], [15.8, 16.2], [36.5, 36.5]],
    ],
    // plunge
    [
        [[10.5, 95.0], [12.9, 13.2], [58.3, 65.3]],
        [[9.5, 90.3], [9.4, 10.6], [56.1, 62.3]],
        [[8.5, 59.8], [7.9, 15.1], [46.5, 50.0]],
        [[7.3, 25.4], [24.2, 26.3], [37.8, 60.3]],
        [[8.6, 10.3], [40.4, 40.4], [57.5, 66.6]],
        [[15.8, 17.4], [46.7, 46.7], [58.8, 60.3]],
    ],
];

/// The same of the quasi-steady model.
const QUASI_STEADY: Table = [
    // flap
    [
        [[54.2, 84.3], [2.3, 16.4], [26.2, 35.5]],
        [[55.0, 84.1], [2.1, 15.5], [26.3, 34.6]],
        [[61.2, 88.8], [1.1, 8.8], [26.8, 29.3]],
        [[76.6, 120.5], [3.9, 21.2], [27.4, 27.6]],
        [[116.6, 315.1], [12.9, 67.3], [27.3, 27.3]],
        [[172.1, 424.3], [26.2, 118.9], [27.5, 49.4]],
    ],
    // pitch
    [
        [[46.1, 60.3], [11.2, 35.1], [47.1, 57.3]],
        [[46.6, 58.8], [10.9, 34.4], [47.0, 56.4]],
        [[50.6, 57.1], [11.6, 31.3], [46.1, 52.0]],
        [[61.0, 64.5], [25.6, 32.1], [45.0, 45.0]],
        [[86.5, 92.0], [51.4, 51.4], [46.4, 46.4]],
        [[117.3, 180.8], [67.7, 67.7], [50.1, 50.1]],
    ],
    // plunge
    [
        [[50.5, 90.8], [100.0, 100.0], [67.0, 98.9]],
        [[51.0, 89.4], [100.0, 100.0], [67.0, 98.5]],
        [[55.4, 81.5], [100.0, 100.0], [68.1, 96.5]],
        [[66.6, 80.5], [100.0, 100.0], [71.2, 92.9]],
        [[94.2, 105.2], [100.0, 100.0], [75.7, 86.3]],
        [[127.2, 167.8], [100.0, 100.0], [76.2, 81.4]],
    ],
];

/// Largest error of a model against exact linear theory (Possio's equation; Theodorsen's theory at Mach 0)
/// in per cent of the magnitude of each load, `[Cn, Cm, Ch]`, each for `k <= 0.3` and for `k <= 1`.
///
/// The worst of flaps of 0.1 to 0.4 chord and of the two measured Mach numbers about `mach`; beyond Mach
/// 0.8 what was measured there. `None` for a model that is fitted to exact theory or is it but for two lags.
///
/// | argument | symbol | unit | range |
/// |---|---|---|---|
/// | `mach` | `M` | - | 0 to 0.95 |
///
/// Source: own solutions of Possio's equation. Test: `xtask`, `the_known_errors_are_those_measured`.
pub fn known_error_percent(
    model: AttachedFlowModel,
    motion: Motion,
    mach: f64,
) -> Option<[[f64; 2]; 3]> {
    let table = match model {
        AttachedFlowModel::HariharanLeishman => &HARIHARAN_LEISHMAN,
        AttachedFlowModel::QuasiSteady => &QUASI_STEADY,
        AttachedFlowModel::Incompressible | AttachedFlowModel::Calibrated => return None,
    };
    let rows = match motion {
        Motion::Flap => &table[0],
        Motion::Pitch => &table[1],
        Motion::Plunge => &table[2],
    };
    let last = KNOWN_ERROR_MACHS.len() - 1;
    let above = KNOWN_ERROR_MACHS.partition_point(|m| *m < mach).min(last);
    let below = KNOWN_ERROR_MACHS.partition_point(|m| *m <= mach).clamp(1, last + 1) - 1;
    let worse = |load: usize, band: usize| rows[below][load][band].max(rows[above][load][band]);
    Some([0, 1, 2].map(|load| [0, 1].map(|band| worse(load, band))))
}
