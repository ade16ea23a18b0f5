//! The calibrated model against exact theory: at the tables, at Mach numbers and flaps that took no
//! part in the fit, and against a real oscillating flap.
#![expect(clippy::unwrap_used, reason = "a helper whose table or section is missing cannot go on")]

use crate::tables;

use approx::assert_abs_diff_eq;
use exact_section::calibration::{
    FLAP_RANGE, FLAP_TERMS, Samples, fit_gains, mach_nodes, nodes_of,
};
use exact_section::{Possio, incompressible_loads, start_loads, steady_loads};
use flap_aero::{
    AeroError, AttachedFlowModel, CalibratedSection, FlapChord, Mach, Mode, Motion,
    SectionCoefficients, harmonic_response, indicial_response, steady_response,
};
use num_complex::Complex64;
use tables::Table;

fn section(m: f64, e: f64) -> SectionCoefficients {
    let (mach, flap) = (Mach::new(m).unwrap(), FlapChord::new(e).unwrap());
    AttachedFlowModel::Calibrated.coefficients(mach, flap).unwrap()
}

fn exact(loads: &[[Complex64; 4]; 3], k: f64, motion: Motion) -> [Complex64; 3] {
    match motion {
        Motion::Flap => exact_section::Motion::Flap,
        Motion::Pitch => exact_section::Motion::Pitch,
        Motion::Plunge => exact_section::Motion::Plunge,
    }
    .of(loads, k)
}

/// The project's bounds, `[k <= 0.3, k <= 1]` for `Cn`, `Cm`, `Ch` of a flap, in per cent.
fn bounds(m: f64) -> [[f64; 2]; 3] {
    if m <= 0.55 {
        [[3.0, 5.0], [2.0, 3.0], [1.5, 2.0]]
    } else {
        [[4.0, 6.0], [4.0, 8.0], [2.0, 3.0]]
    }
}

/// Largest errors in per cent of the magnitude of each load.
fn errors(m: f64, e: f64, motion: Motion) -> [[f64; 2]; 3] {
    let section = section(m, e);
    let mut worst = [[0.0_f64; 2]; 3];
    for k in
        [0.01, 0.03, 0.06, 0.1, 0.14, 0.18, 0.22, 0.26, 0.3, 0.36, 0.43, 0.52, 0.64, 0.78, 0.9, 1.0]
    {
        let loads = Possio::new(m, k).unwrap().loads(e).unwrap();
        let got = harmonic_response(&section, k, motion);
        for ((w, g), x) in worst.iter_mut().zip(got).zip(exact(&loads, k, motion)) {
            let error = 100.0 * (g - x).norm() / x.norm();
            w[1] = w[1].max(error);
            if k <= 0.3 {
                w[0] = w[0].max(error);
            }
        }
    }
    worst
}

#[test]
fn flap_against_possio_in_and_off_the_fit() {
    println!("flap: error in % of magnitude, k <= 0.3 / k <= 1");
    // the tabulated Mach numbers, and (E, M) that took no part in the fit
    for (m, e) in [
        (0.3, 0.2),
        (0.5, 0.2),
        (0.7, 0.2),
        (0.3, 0.1),
        (0.5, 0.1),
        (0.7, 0.1),
        (0.3, 0.4),
        (0.5, 0.4),
        (0.7, 0.4),
        (0.35, 0.15),
        (0.45, 0.33),
        (0.55, 0.12),
        (0.62, 0.27),
        (0.66, 0.37),
        (0.69, 0.18),
        (0.12, 0.22),
        (0.22, 0.3),
        (0.07, 0.16),
    ] {
        let got = errors(m, e, Motion::Flap);
        println!("M {m} E {e}: Cn {:.2?} Cm {:.2?} Ch {:.2?}", got[0], got[1], got[2]);
        for (got, bound) in got.into_iter().zip(bounds(m)) {
            assert!(got[0] <= bound[0] && got[1] <= bound[1], "M {m} E {e}: {got:.2?} {bound:?}");
        }
    }
}

#[test]
fn pitch_and_plunge_against_possio() {
    println!("pitch and plunge: error in % of magnitude, k <= 0.3 / k <= 1");
    for motion in [Motion::Pitch, Motion::Plunge] {
        for (m, e) in
            [(0.07, 0.2), (0.2, 0.2), (0.3, 0.2), (0.5, 0.2), (0.7, 0.2), (0.4, 0.31), (0.62, 0.13)]
        {
            let got = errors(m, e, motion);
            println!(
                "{motion:?} M {m} E {e}: Cn {:.2?} Cm {:.2?} Ch {:.2?}",
                got[0], got[1], got[2]
            );
            for got in got {
                assert!(got[0] <= 3.0, "{motion:?} M {m} E {e}: {got:.2?}");
                assert!(got[1] <= 3.0, "{motion:?} M {m} E {e}: {got:.2?}");
            }
        }
    }
}

#[test]
fn against_the_tables_of_another_program() {
    for (file, hinge, motion) in [
        ("possio_flap.csv", "E", Motion::Flap),
        ("possio_pitch_plunge.csv", "E_hinge", Motion::Pitch),
        ("possio_pitch_plunge.csv", "E_hinge", Motion::Plunge),
    ] {
        let mut compared = 0;
        let mut worst = [0.0_f64; 3];
        for row in Table::read(file).rows() {
            let (m, e, k) = (row.number("M"), row.number(hinge), row.number("k"));
            let wanted = match motion {
                Motion::Flap => true,
                Motion::Pitch => row.text("mode") == "alpha",
                Motion::Plunge => row.text("mode") == "h",
            };
            if !wanted || k > 0.31 || m > 0.71 {
                continue;
            }
            compared += 1;
            let scale = match motion {
                Motion::Plunge => Complex64::new(0.0, k).inv(),
                _ => Complex64::ONE,
            };
            let got = harmonic_response(&section(m, e), k, motion);
            for ((w, g), x) in worst.iter_mut().zip(got).zip(row.loads()) {
                *w = w.max((g - x * scale).norm() / (x * scale).norm());
            }
        }
        println!("{file} {motion:?}, M <= 0.7, k <= 0.3: {worst:.4?}");
        assert!(compared >= 30, "{compared}");
        assert!(worst.iter().all(|w| *w <= 0.03), "{motion:?} {worst:?}");
    }
}

#[test]
fn start_and_steady_values_are_exact() {
    for m in [0.05, 0.1, 0.3, 0.5, 0.7, 0.9] {
        for e in [0.1, 0.17, 0.25, 0.4] {
            let section = section(m, e);
            let (start, steady) = (start_loads(m, e), steady_loads(m, e));
            for mode in Mode::ALL {
                let j = mode.index();
                let mut inputs = [0.0; 4];
                inputs[j] = 1.0;
                let at_once = indicial_response(&section, mode, 0.0);
                let settled = steady_response(&section, &inputs);
                for o in 0..3 {
                    assert_abs_diff_eq!(at_once[o], start[o][j], epsilon = 1e-10);
                    // the reference sums a series to about 1e-9
                    assert_abs_diff_eq!(settled[o], steady[o][j], epsilon = 2e-9);
                }
            }
        }
    }
}

#[test]
fn near_mach_zero_it_is_theodorsens_section() {
    let section = section(0.0, 0.2);
    assert!(section.remarks.mach_floored && !section.remarks.mach_capped);
    for k in [0.02, 0.1, 0.3, 0.6] {
        let still = incompressible_loads(k, 0.2).unwrap();
        for motion in [Motion::Flap, Motion::Pitch, Motion::Plunge] {
            let got = harmonic_response(&section, k, motion);
            for (g, x) in got.into_iter().zip(exact(&still, k, motion)) {
                assert!((g - x).norm() <= 0.02 * x.norm(), "{motion:?} {k}: {g} {x}");
            }
        }
    }
}

#[test]
fn the_limits_of_the_calibration_are_said() {
    let mach = Mach::new(0.5).unwrap();
    for ratio in [0.05, 0.41, 0.8] {
        let flap = FlapChord::new(ratio).unwrap();
        let error = AttachedFlowModel::Calibrated.coefficients(mach, flap).unwrap_err();
        assert_eq!(error, AeroError::FlapChordNotCalibrated { ratio, from: 0.1, to: 0.4 });
    }
    let capped = section(0.95, 0.2);
    assert!(capped.remarks.mach_capped);
    let bare = AttachedFlowModel::Calibrated.coefficients(mach, FlapChord::NONE).unwrap();
    assert!(bare.remarks.is_empty());
    // the rigid motions do not know of the flap
    let flapped = section(0.5, 0.3);
    for motion in [Motion::Pitch, Motion::Plunge] {
        let [a, b] = [&bare, &flapped].map(|s| harmonic_response(s, 0.2, motion));
        assert!((a[0] - b[0]).norm() < 1e-12 && (a[1] - b[1]).norm() < 1e-12);
        assert!(a[2].norm() < 1e-15 && b[2].norm() > 1e-3);
    }
}

/// The stored gains are those the fit gives: done again at four of its nodes.
#[test]
fn a_sample_of_the_calibration_can_be_made_again() {
    let (machs, flaps) = (mach_nodes(), nodes_of(FLAP_RANGE, FLAP_TERMS));
    for (m, e) in [(machs[3], flaps[1]), (machs[9], flaps[3])] {
        let section = section(m, e);
        let poles: Vec<f64> = section.lags.iter().step_by(4).map(|lag| lag.pole).collect();
        let sample = &Samples::at(m, &[e]).unwrap()[0];
        let (gains, _) = fit_gains(sample, &poles.clone().try_into().unwrap());
        for (i, lags) in section.lags.chunks_exact(4).enumerate() {
            for (j, lag) in lags.iter().enumerate() {
                for (o, (got, row)) in lag.output.iter().zip(&gains).enumerate() {
                    let again = row[j][i];
                    assert!((got - again).abs() < 1e-6, "M {m} E {e} {o}{j}{i}: {got} {again}");
                }
            }
        }
    }
}

#[test]
fn coefficients_do_not_jump_with_the_mach_number() {
    for e in [0.0, 0.2] {
        let flap = CalibratedSection::new(FlapChord::new(e).unwrap()).unwrap();
        let mut last: Option<SectionCoefficients> = None;
        for i in 0..=950 {
            let now = flap.coefficients(Mach::new(f64::from(i) / 1000.0).unwrap());
            if let Some(last) = last {
                assert_eq!(now.lags.len(), last.lags.len());
                for motion in [Motion::Flap, Motion::Pitch] {
                    let [new, old] = [&now, &last].map(|s| harmonic_response(s, 0.3, motion));
                    for (n, o) in new.into_iter().zip(old) {
                        assert!((n - o).norm() <= 0.02 * o.norm().max(1e-2), "M {i}e-3 E {e}");
                    }
                }
            }
            last = Some(now);
        }
    }
}
