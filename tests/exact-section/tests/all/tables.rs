//! The exact theory against the reference tables, which were made by other programs.
#![expect(clippy::unwrap_used, reason = "a helper whose table is missing cannot go on")]

use exact_section::{Motion, Possio, incompressible_loads, short_time};
use num_complex::Complex64;
use std::collections::BTreeMap;

type Row = BTreeMap<String, String>;

fn table(file: &str) -> Vec<Row> {
    let path = format!("{}/../../fixtures/reference/aero/{file}", env!("CARGO_MANIFEST_DIR"));
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).flexible(true).from_path(path).unwrap();
    let names = reader.headers().unwrap().clone();
    reader
        .records()
        .map(|record| {
            let record = record.unwrap();
            names.iter().map(str::to_owned).zip(record.iter().map(str::to_owned)).collect()
        })
        .collect()
}

fn number(row: &Row, name: &str) -> f64 {
    row[name].trim().parse().unwrap()
}

fn complex(row: &Row, name: &str) -> Complex64 {
    Complex64::new(number(row, &format!("{name}_re")), number(row, &format!("{name}_im")))
}

#[test]
fn possio_against_the_flap_table() {
    let mut worst = [0.0_f64; 3];
    let mut worst_at_two = 0.0_f64;
    let rows = table("possio_flap.csv");
    assert!(rows.len() > 100);
    for row in &rows {
        let (m, e, k) = (number(row, "M"), number(row, "E"), number(row, "k"));
        let got = Motion::Flap.of(&Possio::new(m, k).unwrap().loads(e).unwrap(), k);
        for ((w, g), name) in worst.iter_mut().zip(got).zip(["cn", "cm25", "ch"]) {
            let exact = complex(row, name);
            let error = (g - exact).norm() / exact.norm();
            // at k = 2 the table itself is good to some 3e-4 only: another method agrees with the solver
            // to 1e-8 there (`reverse_flow_gives_the_same_loads_at_high_frequency`)
            if k < 1.9 {
                *w = w.max(error);
            } else {
                worst_at_two = worst_at_two.max(error);
            }
        }
    }
    println!("possio_flap.csv: {worst:?}, k = 2: {worst_at_two:e}");
    assert!(worst.iter().all(|w| *w <= 1e-4), "{worst:?}");
    assert!(worst_at_two <= 3e-4, "{worst_at_two}");
}

#[test]
fn possio_against_the_pitch_and_plunge_table() {
    let mut worst = [0.0_f64; 3];
    for row in &table("possio_pitch_plunge.csv") {
        let (m, e, k) = (number(row, "M"), number(row, "E_hinge"), number(row, "k"));
        let loads = Possio::new(m, k).unwrap().loads(e).unwrap();
        let got = match row["mode"].as_str() {
            "alpha" => Motion::Pitch.of(&loads, k),
            _ => Motion::Plunge.of(&loads, k).map(|load| load * Complex64::new(0.0, k)),
        };
        for ((w, g), name) in worst.iter_mut().zip(got).zip(["cn", "cm25", "ch"]) {
            let exact = complex(row, name);
            *w = w.max((g - exact).norm() / exact.norm().max(1e-4));
        }
    }
    println!("possio_pitch_plunge.csv: {worst:?}");
    assert!(worst.iter().all(|w| *w <= 1e-4), "{worst:?}");
}

#[test]
fn incompressible_against_theodorsens_table() {
    let mut worst = [0.0_f64; 3];
    for row in &table("theodorsen_flap_E020.csv") {
        let k = number(row, "k");
        let got = Motion::Flap.of(&incompressible_loads(k, 0.2).unwrap(), k);
        for ((w, g), name) in worst.iter_mut().zip(got).zip(["cn", "cm25", "ch"]) {
            let exact = complex(row, name);
            *w = w.max((g - exact).norm() / exact.norm());
        }
    }
    println!("theodorsen_flap_E020.csv: {worst:?}");
    assert!(worst.iter().all(|w| *w <= 1e-8), "{worst:?}");
}

/// The limit of no compressibility, and how it is approached: with the square of the Mach number.
#[test]
fn possio_tends_to_theodorsen() {
    let error = |m: f64| {
        let mut worst = 0.0_f64;
        for e in [0.1, 0.2, 0.4] {
            for k in [0.02, 0.1, 0.3, 1.0, 2.0] {
                let still = incompressible_loads(k, e).unwrap();
                let moving = Possio::new(m, k).unwrap().loads(e).unwrap();
                for motion in Motion::ALL {
                    for (a, b) in motion.of(&still, k).into_iter().zip(motion.of(&moving, k)) {
                        worst = worst.max((a - b).norm() / a.norm());
                    }
                }
            }
        }
        worst
    };
    let [far, near, nearest] = [4e-3, 2e-3, 1e-3].map(error);
    println!("M 4e-3, 2e-3, 1e-3: {far:e} {near:e} {nearest:e}");
    assert!(nearest <= 1e-4);
    assert!(nearest < near && near < far);
}

#[test]
fn the_loading_converges() {
    for (mach, k, flap) in [(0.7, 0.8, 0.15), (0.6, 2.0, 0.2), (0.8, 2.0, 0.25)] {
        let at = |terms: usize| {
            let loads = Possio::with_terms(mach, k, terms).unwrap().loads(flap).unwrap();
            Motion::Flap.of(&loads, k)
        };
        let finest = at(256);
        let error = |terms: usize| {
            let got = at(terms);
            [0, 1, 2].map(|o| (got[o] - finest[o]).norm() / finest[o].norm())
        };
        let (coarse, fine) = (error(48), error(96));
        println!("M {mach} k {k}: 48 terms {coarse:?}, 96 terms {fine:?}");
        assert!(fine[0] < 1e-10 && fine[1] < 1e-10, "{fine:?}");
        assert!(fine[2] < 5e-6 && fine[2] < 0.25 * coarse[2], "{fine:?} {coarse:?}");
    }
}

/// The closed forms of the first moments against the quadrature of Evvard's rule and Lomax's table.
#[test]
fn closed_short_time_forms_against_the_tables() {
    let loads = ["cn", "cm25", "ch"];
    let mut worst = 0.0_f64;
    let mut compared = 0;
    for (file, modes, names) in [
        ("evvard_flap_step_E020.csv", [2, 3], ["delta", "ddot"]),
        ("lomax_alpha_q.csv", [0, 1], ["alpha", "q"]),
    ] {
        let rows = table(file);
        for row in &rows {
            let m = number(row, "M");
            let exact = short_time(m, 0.2, number(row, "S")).unwrap();
            for (o, load) in loads.iter().enumerate() {
                for (mode, name) in modes.into_iter().zip(names) {
                    let (Some(value), Some(cell)) =
                        (exact[o][mode], row.get(&format!("{load}_{name}")))
                    else {
                        continue;
                    };
                    let start = short_time(m, 0.2, 0.0).unwrap()[o][mode].unwrap();
                    worst = worst.max((value - cell.parse::<f64>().unwrap()).abs() / start.abs());
                    compared += 1;
                }
            }
        }
    }
    println!("short time: {worst:e} of the start value, {compared} values");
    assert!(compared > 300, "{compared}");
    assert!(worst <= 1e-3, "{worst}");
}
