//! Compressible, stalled and tabulated sections, and the exact theory they are measured against.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use exact_section::{Possio, incompressible_loads, short_time, start_loads};
use flap_aero::{
    AttachedFlowModel, C81Airfoil, C81Table, FlapChord, Load, Mach, MarchingSection, Mode, Motion,
    SectionInputs, SectionState, StallParameters, StallSection, StallState, harmonic_response,
    indicial_response, steady_response,
};
use num_complex::Complex64;

use crate::errors::{ErrorBands, errors_against_possio, errors_of_flaps};
use validation::{Check, Failure, Table, TableRow, row, shared, worst};

const OWN: &str = "Possio's equation, the project's own solver; Theodorsen at Mach 0";
const SLOW: usize = 0;
const FAST: usize = 1;

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-AERO-07",
        "own solution of Possio's equation, flap, M 0.1 to 0.8, k to 1.5: largest \
         difference of its magnitude",
        "-",
    )
    .against("possio_flap.csv")
    .at_most(1e-4, || possio_table("possio_flap.csv", 1.6)),
    row("V-AERO-08", "the same, pitch and plunge, k to 2", "-")
        .against("possio_pitch_plunge.csv")
        .at_most(1e-4, || possio_table("possio_pitch_plunge.csv", 2.1)),
    row("V-AERO-09", "the same at M 0.001, E 0.1 to 0.4, k to 2, against Theodorsen", "-")
        .against("Theodorsen, pressure series of Küssner and Schwarz")
        .at_most(1e-4, possio_without_compressibility),
    row(
        "V-AERO-10",
        "closed forms of the first moments after a step: largest difference of the \
         start value",
        "-",
    )
    .against("evvard_flap_step_E020.csv, lomax_alpha_q.csv")
    .at_most(1e-3, short_time_tables),
    row("V-AERO-11", "loads at S = 0, both compressible models, M 0.05 to 0.9: largest error", "-")
        .against("piston theory")
        .at_most(1e-10, start_values),
    row(
        "V-AERO-12",
        "calibrated flap lift, E 0.1 to 0.4, M 0 to 0.55, k to 0.3: worst of a \
         grid, in and off the fit",
        "%",
    )
    .against(OWN)
    .at_most(3.0, || flap_error(false, Load::Lift, SLOW)),
    row("V-AERO-13", "the same, k to 1", "%")
        .against(OWN)
        .at_most(5.0, || flap_error(false, Load::Lift, FAST)),
    row(
        "V-AERO-14",
        "calibrated flap moment, E 0.1 to 0.4, M 0 to 0.55, k to 0.3: worst of the \
         grid",
        "%",
    )
    .against(OWN)
    .at_most(2.0, || flap_error(false, Load::Moment, SLOW)),
    row("V-AERO-15", "the same, k to 1", "%")
        .against(OWN)
        .at_most(3.0, || flap_error(false, Load::Moment, FAST)),
    row(
        "V-AERO-16",
        "calibrated hinge moment, E 0.1 to 0.4, M 0 to 0.55, k to 0.3: worst of the \
         grid",
        "%",
    )
    .against(OWN)
    .at_most(1.5, || flap_error(false, Load::Hinge, SLOW)),
    row("V-AERO-17", "the same, k to 1", "%")
        .against(OWN)
        .at_most(2.0, || flap_error(false, Load::Hinge, FAST)),
    row(
        "V-AERO-18",
        "calibrated flap lift, E 0.1 to 0.4, M 0.6 to 0.7, k to 0.3: worst of the \
         grid",
        "%",
    )
    .against(OWN)
    .at_most(4.0, || flap_error(true, Load::Lift, SLOW)),
    row("V-AERO-19", "the same, k to 1", "%")
        .against(OWN)
        .at_most(6.0, || flap_error(true, Load::Lift, FAST)),
    row(
        "V-AERO-20",
        "calibrated flap moment, E 0.1 to 0.4, M 0.6 to 0.7, k to 0.3: worst of the \
         grid",
        "%",
    )
    .against(OWN)
    .at_most(4.0, || flap_error(true, Load::Moment, SLOW)),
    row("V-AERO-21", "the same, k to 1", "%")
        .against(OWN)
        .at_most(8.0, || flap_error(true, Load::Moment, FAST)),
    row(
        "V-AERO-22",
        "calibrated hinge moment, E 0.1 to 0.4, M 0.6 to 0.7, k to 0.3: worst of \
         the grid",
        "%",
    )
    .against(OWN)
    .at_most(2.0, || flap_error(true, Load::Hinge, SLOW)),
    row("V-AERO-23", "the same, k to 1", "%")
        .against(OWN)
        .at_most(3.0, || flap_error(true, Load::Hinge, FAST)),
    row(
        "V-AERO-24",
        "calibrated pitch and plunge, all loads, E 0.1 to 0.4, M 0 to 0.7, k to 1: \
         worst of the grid",
        "%",
    )
    .against(OWN)
    .at_most(3.0, rigid_error),
    row("V-AERO-25", "Hariharan-Leishman form, flap lift, M 0.5, k to 0.3: its known error", "%")
        .against(OWN)
        .between(25.0, 35.0, slope_matched_error),
    row(
        "V-AERO-43",
        "Hariharan-Leishman form, pitch lift, M 0.1 to 0.8, E 0.2, k to 1: its \
         known error, at M 0.1",
        "%",
    )
    .against(OWN)
    .between(40.0, 50.0, || slope_matched_rigid(Motion::Pitch)),
    row("V-AERO-44", "the same, plunge", "%")
        .against(OWN)
        .between(85.0, 95.0, || slope_matched_rigid(Motion::Plunge)),
    row(
        "V-AERO-45",
        "drag of steady attached flow, any incidence and flap angle: largest of the \
         normal force times the angles",
        "-",
    )
    .against("d'Alembert")
    .at_most(1e-12, drag_of_attached_flow),
    row(
        "V-AERO-29",
        "marched calibrated lift, 72 steps per cycle, k 0.2: largest error of the \
         amplitude",
        "-",
    )
    .against("its own harmonic response")
    .at_most(6e-4, recurrence_error),
    row(
        "V-AERO-30",
        "C81 file with touching fields and 11 Mach numbers, read, written, read: \
         largest difference",
        "-",
    )
    .against("the numbers put in")
    .at_most(0.0, c81_round_trip),
    row("V-AERO-31", "stalling section held for ever: largest error of the normal force", "-")
        .against("Kirchhoff's static curve")
        .at_most(1e-10, static_stall),
    row("V-AERO-32", "deep-stall loop, order from 360 to 720 steps per cycle", "-")
        .against("theory: second order")
        .between(1.8, 2.2, stall_order),
    row(
        "V-AERO-42",
        "initial slopes of the slope-matched form, M 0.05 to 0.9, all it can match: \
         largest error, of the slope",
        "-",
    )
    .against("closed forms of the first moments after a step")
    .at_most(1e-10, initial_slopes),
];

fn complex(row: &TableRow<'_>, name: &str) -> Result<Complex64, Failure> {
    Ok(Complex64::new(row.number(&format!("{name}_re"))?, row.number(&format!("{name}_im"))?))
}

/// Largest difference between the own solution and a table, over the magnitude of each load.
fn possio_table(file: &str, k_max: f64) -> Result<f64, Failure> {
    let table = Table::read(&format!("aero/{file}"))?;
    let mut errors = Vec::new();
    for row in table.rows() {
        let (mach, k) = (row.number("M")?, row.number("k")?);
        if k > k_max {
            continue;
        }
        let flap = row.number("E").or_else(|_| row.number("E_hinge"))?;
        let loads = Possio::new(mach, k)?.loads(flap)?;
        let got = match row.text("mode") {
            Err(_) => exact_section::Motion::Flap.of(&loads, k),
            Ok("alpha") => exact_section::Motion::Pitch.of(&loads, k),
            // per unit of h/b, not of the velocity
            Ok(_) => {
                exact_section::Motion::Plunge.of(&loads, k).map(|l| l * Complex64::new(0.0, k))
            }
        };
        for (got, name) in got.into_iter().zip(["cn", "cm25", "ch"]) {
            let exact = complex(&row, name)?;
            // below it the table has no more digits
            errors.push(Ok((got - exact).norm() / exact.norm().max(1e-4)));
        }
    }
    worst("loads", 300, errors)
}

fn possio_without_compressibility() -> Result<f64, Failure> {
    let mut errors = Vec::new();
    for flap in [0.1, 0.2, 0.4] {
        for k in [0.02, 0.1, 0.3, 1.0, 2.0] {
            let still = incompressible_loads(k, flap)?;
            let moving = Possio::new(1e-3, k)?.loads(flap)?;
            for motion in exact_section::Motion::ALL {
                for (a, b) in motion.of(&still, k).into_iter().zip(motion.of(&moving, k)) {
                    errors.push(Ok((a - b).norm() / a.norm()));
                }
            }
        }
    }
    worst("loads", 100, errors)
}

fn short_time_tables() -> Result<f64, Failure> {
    let mut errors = Vec::new();
    for (file, modes, names) in [
        ("evvard_flap_step_E020.csv", [2, 3], ["delta", "ddot"]),
        ("lomax_alpha_q.csv", [0, 1], ["alpha", "q"]),
    ] {
        for row in Table::read(&format!("aero/{file}"))?.rows() {
            let mach = row.number("M")?;
            let exact = short_time(mach, 0.2, row.number("S")?)?;
            let start = short_time(mach, 0.2, 0.0)?;
            for (o, load) in ["cn", "cm25", "ch"].into_iter().enumerate() {
                for (mode, name) in modes.into_iter().zip(names) {
                    // the table of alpha and q knows no hinge
                    if o == Load::Hinge.index() && mode < Mode::Flap.index() {
                        continue;
                    }
                    if let (Some(value), Some(start)) = (exact[o][mode], start[o][mode]) {
                        let cell = row.number(&format!("{load}_{name}"))?;
                        errors.push(Ok((value - cell).abs() / start.abs()));
                    }
                }
            }
        }
    }
    worst("short-time loads", 300, errors)
}

fn start_values() -> Result<f64, Failure> {
    let mut errors = Vec::new();
    for model in [AttachedFlowModel::HariharanLeishman, AttachedFlowModel::Calibrated] {
        for mach in [0.05, 0.2, 0.5, 0.7, 0.9] {
            for flap in [0.1, 0.2, 0.33, 0.4] {
                let section = model.coefficients(Mach::new(mach)?, FlapChord::new(flap)?)?;
                let exact = start_loads(mach, flap);
                for mode in Mode::ALL {
                    let got = indicial_response(&section, mode, 0.0);
                    for (got, row) in got.into_iter().zip(exact) {
                        errors.push(Ok((got - row[mode.index()]).abs()));
                    }
                }
            }
        }
    }
    worst("start values", 400, errors)
}

/// Largest error of the initial slopes that the slope-matched form says it matches: the lags' against
/// those of the closed forms, which are cubic in the distance.
fn initial_slopes() -> Result<f64, Failure> {
    let mut errors = Vec::new();
    for mach in [0.05, 0.1, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9] {
        for flap in [0.1, 0.2, 0.25, 0.4] {
            let section = AttachedFlowModel::HariharanLeishman
                .coefficients(Mach::new(mach)?, FlapChord::new(flap)?)?;
            let step = 0.6 * mach * flap / (1.0 + mach);
            let exact = (0..4)
                .map(|n| short_time(mach, flap, step * f64::from(n)))
                .collect::<Result<Vec<_>, _>>()?;
            for (o, j) in (0..3).flat_map(|o| (0..4).map(move |j| (o, j))) {
                let values: Vec<f64> = exact.iter().filter_map(|loads| loads[o][j]).collect();
                let [a, b, c, d] = values[..] else { continue };
                if section.remarks.slope_unmatched[o][j] {
                    continue;
                }
                let slope = (-11.0 * a + 18.0 * b - 9.0 * c + 2.0 * d) / (6.0 * step);
                let lags = section.lags.iter().map(|lag| lag.pole * lag.input[j] * lag.output[o]);
                errors.push(Ok((lags.sum::<f64>() / slope - 1.0).abs()));
            }
        }
    }
    worst("initial slopes", 200, errors)
}

/// Mach numbers of the grid up to 0.55 and beyond, and its flap chords: those of the reference tables,
/// the ends of the ranges, the worst of a scan in steps of 0.01 and 0.025, and many that took no part
/// in the fit.
const SUBCRITICAL: [f64; 11] = [0.0, 0.02, 0.05, 0.08, 0.12, 0.2, 0.3, 0.35, 0.42, 0.5, 0.55];
const FASTER: [f64; 6] = [0.6, 0.62, 0.63, 0.66, 0.69, 0.7];
const FLAP_CHORDS: [f64; 9] = [0.1, 0.125, 0.15, 0.17, 0.2, 0.25, 0.3, 0.33, 0.4];

/// The errors of flap, pitch and plunge at every flap chord and Mach number of a band.
type Errors = Vec<[ErrorBands; 3]>;

fn collected(machs: &[f64]) -> Result<Errors, Failure> {
    let model = AttachedFlowModel::Calibrated;
    let at = |mach: &f64| errors_of_flaps(model, *mach, &FLAP_CHORDS);
    Ok(machs.iter().map(at).collect::<Result<Vec<_>, _>>()?.concat())
}

/// The whole grid, computed once for all checks.
fn grid() -> Result<&'static [Errors; 2], Failure> {
    static ERRORS: LazyLock<Result<[Errors; 2], Failure>> =
        LazyLock::new(|| Ok([collected(&SUBCRITICAL)?, collected(&FASTER)?]));
    shared(&ERRORS)
}

/// Largest error of a load of a flap motion, per cent, over a band of the grid.
fn flap_error(faster: bool, load: Load, band: usize) -> Result<f64, Failure> {
    let of_band = &grid()?[usize::from(faster)];
    worst("conditions", 50, of_band.iter().map(|[flap, ..]| Ok(flap[load.index()][band])))
}

/// Largest error of any load of pitch and plunge, per cent, over the grid.
fn rigid_error() -> Result<f64, Failure> {
    let rigid = grid()?.iter().flatten().flat_map(|[_, pitch, plunge]| [pitch, plunge]);
    worst("loads", 800, rigid.flatten().map(|bands| Ok(bands[FAST])))
}

fn slope_matched_error() -> Result<f64, Failure> {
    let model = AttachedFlowModel::HariharanLeishman;
    Ok(errors_against_possio(model, (0.5, 0.2), Motion::Flap)?[0][SLOW])
}

/// Largest error of the lift of a rigid motion over the Mach numbers, per cent.
fn slope_matched_rigid(motion: Motion) -> Result<f64, Failure> {
    let model = AttachedFlowModel::HariharanLeishman;
    let at = |m: f64| Ok(errors_against_possio(model, (m, 0.2), motion)?[0][FAST]);
    worst("Mach numbers", 5, [0.1, 0.3, 0.5, 0.7, 0.8].map(at))
}

/// Largest drag, to second order in the angles, of the attached loads of the stall.
fn drag_of_attached_flow() -> Result<f64, Failure> {
    let mut drags = Vec::new();
    for ratio in [0.1, 0.2, 0.3, 0.4] {
        for m in [0.0, 0.3, 0.5, 0.7] {
            let (mach, flap) = (Mach::new(m)?, FlapChord::new(ratio)?);
            let model = AttachedFlowModel::Calibrated.coefficients(mach, flap)?;
            let section = StallSection::new(mach, flap, StallParameters::naca_0012(mach))?;
            for (incidence, angle) in [(0.1, 0.0), (0.0, 0.14), (0.05, 0.1), (-0.08, 0.12)] {
                let modes = [incidence, 0.0, angle, 0.0];
                let attached = steady_response(&model, &modes);
                let state = StallState::settled(&section, attached[0], &modes);
                let loads = state.without_stall(&section, attached);
                let scale = loads.normal.abs() * f64::max(incidence.abs(), angle);
                drags.push(Ok((loads.normal * incidence - loads.chord).abs() / scale));
            }
        }
    }
    worst("angles", 64, drags)
}

fn recurrence_error() -> Result<f64, Failure> {
    let section =
        AttachedFlowModel::Calibrated.coefficients(Mach::new(0.5)?, FlapChord::new(0.2)?)?;
    let (k, steps) = (0.2, 72_u32);
    let exact = harmonic_response(&section, k, Motion::Flap)[0];
    let march = MarchingSection::new(&section);
    let at = |n: u32| {
        let turn = Complex64::cis(TAU * f64::from(n) / f64::from(steps));
        (Motion::Flap.inputs(k).map(|m| (m * turn).re), (exact * turn).re)
    };
    let mut state = SectionState::settled(&march, &at(0).0);
    let step = TAU / k / f64::from(steps);
    let mut errors = Vec::new();
    for n in 1..=40 * steps {
        let (modes, lift) = at(n);
        let inputs = SectionInputs { modes, rates: [0.0; 4] };
        let got = state.step(&march, &inputs, step)?[0];
        if n > 39 * steps {
            errors.push(Ok((got - lift).abs() / exact.norm()));
        }
    }
    worst("steps", 72, errors)
}

/// A synthetic aerofoil whose numbers fill their seven columns.
fn c81_round_trip() -> Result<f64, Failure> {
    let machs: Vec<f64> = (0..11).map(|i| f64::from(i) / 16.0).collect();
    let angles = vec![-180.0, -12.25, 0.0, 9.125, 180.0];
    let value = |i: usize, j: usize| -> f64 {
        (-1.0_f64).powi(i32::try_from(i + j).unwrap_or(0)) * (0.1235 + 0.0817 * (i + 3 * j) as f64)
    };
    let values =
        (0..angles.len()).flat_map(|i| (0..machs.len()).map(move |j| value(i, j))).collect();
    let lift = C81Table::new(machs, angles, values)?;
    let moment = C81Table::new(vec![0.3], vec![-180.0, 180.0], vec![-0.1, 0.1])?;
    let made =
        C81Airfoil { name: "SYNTHETIC".to_owned(), lift, drag: moment.clone(), moment }.rounded();
    let text = made.write()?;
    let again = C81Airfoil::read(&text)?;
    let same = again == made && again.write()? == text;
    let gaps = (0..5).flat_map(|i| {
        let rows = [made.lift.row(i).to_vec(), again.lift.row(i).to_vec()];
        (0..11).map(move |j| Ok((rows[0][j] - rows[1][j]).abs() + if same { 0.0 } else { 1.0 }))
    });
    worst("values", 55, gaps)
}

fn stalling() -> Result<(Mach, FlapChord, StallParameters), Failure> {
    let mach = Mach::new(0.3)?;
    Ok((mach, FlapChord::new(0.2)?, StallParameters::naca_0012(mach)))
}

fn static_stall() -> Result<f64, Failure> {
    let (mach, flap, p) = stalling()?;
    let section = AttachedFlowModel::Calibrated.coefficients(mach, flap)?;
    let stalling = StallSection::new(mach, flap, p)?;
    let errors = (-30..=30).map(|degrees| {
        let alpha = f64::from(degrees).to_radians();
        let modes = [alpha, 0.0, 0.0, 0.0];
        let got = stalling.settled(steady_response(&section, &modes), &modes).normal;
        let over = alpha.abs() - p.alpha1_rad;
        let f = if over <= 0.0 {
            1.0 - 0.3 * (over / p.s1_rad).exp()
        } else {
            0.04 + 0.66 * (-over / p.s2_rad).exp()
        };
        let exact = TAU / mach.beta() * alpha * (0.5 * (1.0 + f.sqrt())).powi(2);
        Ok((got - exact).abs())
    });
    worst("incidences", 61, errors)
}

/// The normal force over the second cycle of `10 + 10 sin` deg at `k = 0.1`.
fn deep_stall(steps: u32) -> Result<Vec<f64>, Failure> {
    let (mach, flap, p) = stalling()?;
    let section = MarchingSection::new(&AttachedFlowModel::Calibrated.coefficients(mach, flap)?);
    let stalling = StallSection::new(mach, flap, p)?;
    let k = 0.1;
    let at = |n: u32| {
        let (sin, cos) = (TAU * f64::from(n) / f64::from(steps)).sin_cos();
        [10.0 * (1.0 + sin), 20.0 * k * cos, 0.0, 0.0].map(f64::to_radians)
    };
    let held = SectionInputs { modes: at(0), rates: [0.0; 4] };
    let mut state = SectionState::settled(&section, &at(0));
    let [cn, ..] = state.loads(&section, &held)?;
    let mut stall = StallState::settled(&stalling, cn, &at(0));
    let step = TAU / k / f64::from(steps);
    let mut out = Vec::new();
    for n in 1..=2 * steps {
        let inputs = SectionInputs { modes: at(n), rates: [0.0; 4] };
        let loads = state.step(&section, &inputs, step)?;
        let normal = stall.step(&stalling, loads, &inputs.modes, step)?.normal;
        if n > steps {
            out.push(normal);
        }
    }
    Ok(out)
}

fn stall_order() -> Result<f64, Failure> {
    let finest = deep_stall(46_080)?;
    let error = |steps: u32| -> Result<f64, Failure> {
        let coarse = deep_stall(steps)?;
        let every = finest.len() / coarse.len();
        let gaps =
            coarse.iter().enumerate().map(|(i, cn)| Ok((cn - finest[(i + 1) * every - 1]).abs()));
        worst("steps", 300, gaps)
    };
    Ok((error(360)? / error(720)?).log2())
}
