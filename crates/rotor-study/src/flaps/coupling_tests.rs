//! The coupled loop against closed forms.

use super::*;
use crate::flaps::FlapDrive;
use approx::assert_abs_diff_eq;
use preisach_dyn::{ActuatorModel, LinkageStage, LoadStiffness, VoltageRange};
use rotor_base::series::scaled;
use rotor_case::Bias;
use std::sync::Arc;

/// A linear actuator of 0.1 deg/V whose linkage gives way by `compliance_um_per_newton`.
fn soft(compliance_um_per_newton: f64) -> FlapDrive {
    let range = VoltageRange::new(-20.0, 150.0).unwrap();
    let mut model = ActuatorModel::linear(range, 8.5, 0.04);
    let load = LoadStiffness { stiffness_ratio: 0.0, compliance_um_per_newton };
    model.linkage.push(LinkageStage::LoadStiffness(load));
    let bias = Bias::Centred { guess_volt: 65.0 };
    FlapDrive::Model { model: Arc::new(model), range_volt: range, rev_hz: 5.0, bias }
}

fn sine(n: usize, amplitude: f64) -> Vec<(usize, Harmonic)> {
    vec![(n, Harmonic { cosine: 0.0, sine: amplitude })]
}

/// Hinge moments of a spring, a damper and a mass on each of two flaps, N m per rad.
const SPRINGS: [[f64; 3]; 2] = [[-9.0, -0.8, -0.02], [-12.0, -1.1, -0.03]];

fn hinge_moments(flaps: &[FlapMotion]) -> Vec<HarmonicSeries> {
    let steady = [0.05, -0.02];
    flaps
        .iter()
        .zip(SPRINGS)
        .zip(steady)
        .map(|((flap, [k, c, m]), steady)| {
            let delta = scaled(&flap.flap_deg, 1.0_f64.to_radians());
            let (rate, acceleration) = (delta.derivative(), delta.derivative().derivative());
            let mut all =
                HarmonicSeries { mean: steady + k * delta.mean, ..HarmonicSeries::zero(12) };
            for n in 1..=12 {
                let part = |pick: fn(&Harmonic) -> f64| {
                    k * pick(&delta.harmonic(n))
                        + c * pick(&rate.harmonic(n))
                        + m * pick(&acceleration.harmonic(n))
                };
                all.set_harmonic(
                    n,
                    Harmonic { cosine: part(|h| h.cosine), sine: part(|h| h.sine) },
                );
            }
            all
        })
        .collect()
}

/// A response matrix that knows a share of the truth: what it leaves is the iteration's.
fn response(flaps: usize, share: f64) -> DMatrix<f64> {
    let at = |unit: &[f64]| -> DVector<f64> {
        let motions: Vec<FlapMotion> = unit
            .chunks_exact(25)
            .map(|part| FlapMotion {
                voltage_volt: HarmonicSeries::zero(0),
                flap_deg: scaled(&series(part), 1.0_f64.to_degrees()),
            })
            .collect();
        let all = hinge_moments(&motions);
        DVector::from_vec(all.iter().flat_map(|h| coefficients(h, 12)).collect())
    };
    let rest = at(&vec![0.0; 25 * flaps]);
    let columns: Vec<DVector<f64>> = (0..25 * flaps)
        .map(|j| {
            let unit: Vec<f64> = (0..25 * flaps).map(|i| f64::from(u8::from(i == j))).collect();
            share * (at(&unit) - &rest)
        })
        .collect();
    DMatrix::from_columns(&columns)
}

fn settled(
    drive: &FlapDrive,
    share: f64,
) -> Result<(Vec<FlapMotion>, (), CouplingResidual), PlantError> {
    let free: Vec<FlapMotion> =
        [drive.motion(&sine(4, 40.0)).unwrap(), drive.motion(&sine(3, 20.0)).unwrap()].to_vec();
    let rest: Vec<FlapMotion> = (0..2).map(|_| drive.motion(&[]).unwrap()).collect();
    let give = drive.compliance_deg_per_newton_metre();
    let coupling = HingeCoupling::new(give, hinge_moments(&rest), response(2, share)).unwrap();
    let actuate = |moments: &[HarmonicSeries]| {
        free.iter().zip(moments).map(|(f, m)| drive.loaded_motion(f, m)).collect()
    };
    coupling.settle(actuate, |flaps, _| Ok(((), hinge_moments(flaps))))
}

/// `delta = delta_free / (1 - g (k + i n c - n^2 m))`: the spring of the air makes the flap move less, in
/// closed form, whatever the iteration knows of it; here the plain iteration would diverge, `g k` being
/// -4.
#[test]
fn a_linear_actuator_under_a_linear_hinge_moment() {
    let drive = soft(0.9);
    let give_rad = drive.compliance_deg_per_newton_metre().to_radians();
    assert!(give_rad * SPRINGS[0][0] < -3.0, "{}", give_rad * SPRINGS[0][0]);
    for (share, most) in [(1.0, 2), (0.7, 12), (0.0, 30)] {
        let (flaps, (), residual) = settled(&drive, share).unwrap();
        println!(
            "known {share}: {} responses, {:e} deg",
            residual.iterations, residual.residual_deg
        );
        assert!(residual.iterations <= most, "{residual:?}");
        for (flap, (n, volt, [k, c, m])) in
            flaps.iter().zip([(4, 40.0, SPRINGS[0]), (3, 20.0, SPRINGS[1])])
        {
            let nf = n as f64;
            let (real, imaginary) = (1.0 - give_rad * (k - nf * nf * m), -give_rad * nf * c);
            let size = real * real + imaginary * imaginary;
            // sin is the imaginary part of exp(i n psi): in phase real / size, ahead imaginary
            let got = flap.flap_deg.harmonic(n);
            assert_abs_diff_eq!(got.sine, 0.1 * volt * real / size, epsilon = 1e-6);
            assert_abs_diff_eq!(got.cosine, -0.1 * volt * imaginary / size, epsilon = 1e-6);
            assert!(flap.flap_deg.mean.abs() < 1e-6, "the bias holds the mean");
        }
    }
}

/// A load that has next to no effect leaves the free motion, and without give there is no coupling.
#[test]
fn a_stiff_actuator_is_the_free_one() {
    let free = soft(0.0).motion(&sine(4, 40.0)).unwrap();
    let (flaps, ..) = settled(&soft(1e-14), 1.0).unwrap();
    for n in 1..=12 {
        let (a, b) = (free.flap_deg.harmonic(n), flaps[0].flap_deg.harmonic(n));
        assert_abs_diff_eq!(a.cosine, b.cosine, epsilon = 1e-12);
        assert_abs_diff_eq!(a.sine, b.sine, epsilon = 1e-12);
    }
    let stiff = soft(0.0).compliance_deg_per_newton_metre();
    assert!(HingeCoupling::new(stiff, vec![], DMatrix::zeros(0, 0)).is_none());
}

/// The inverse asks for what the load will take: the wanted motion comes out, and the voltage is that of
/// the linear actuator for motion plus give. Without the load it would miss by the whole give.
#[test]
fn the_inverse_makes_up_for_the_hinge_moment() {
    let drive = soft(0.9);
    let mut wanted = HarmonicSeries::zero(4);
    wanted.set_harmonic(3, Harmonic { cosine: 1.0, sine: 0.5 });
    wanted.set_harmonic(4, Harmonic { cosine: -0.3, sine: 0.2 });
    let mut moment = HarmonicSeries::zero(4);
    moment.set_harmonic(3, Harmonic { cosine: -0.2, sine: 0.1 });
    let made = drive.loaded_inverse(&wanted, &moment).unwrap();
    let give = drive.compliance_deg_per_newton_metre();
    for n in [3, 4] {
        let (want, got, load) = (wanted.harmonic(n), made.flap_deg.harmonic(n), moment.harmonic(n));
        assert_abs_diff_eq!(got.cosine, want.cosine, epsilon = 1e-4);
        assert_abs_diff_eq!(got.sine, want.sine, epsilon = 1e-4);
        let volt = made.voltage_volt.harmonic(n);
        assert_abs_diff_eq!(0.1 * volt.cosine, want.cosine - give * load.cosine, epsilon = 1e-3);
        assert_abs_diff_eq!(0.1 * volt.sine, want.sine - give * load.sine, epsilon = 1e-3);
    }
    let free = drive.inverse(&wanted).unwrap();
    let missed = drive.loaded_motion(&free, &moment).unwrap().flap_deg.harmonic(3);
    assert!((missed.cosine - 1.0).abs() > 0.2 * give, "{missed:?}");
    // out of reach is an error, loaded or not
    let mut large = wanted.clone();
    large.set_harmonic(3, Harmonic { cosine: 50.0, sine: 0.0 });
    assert!(drive.loaded_inverse(&large, &moment).is_err());
}

#[test]
fn what_does_not_settle_says_so_with_its_least_residual() {
    let drive = soft(0.9);
    let free = [drive.motion(&sine(4, 40.0)).unwrap()];
    let give = drive.compliance_deg_per_newton_metre();
    let rest = vec![HarmonicSeries::zero(12)];
    let coupling = HingeCoupling::new(give, rest, response(1, 1.0)).unwrap();
    let count = std::cell::Cell::new(0_u32);
    let result: Result<(_, (), _), _> = coupling.settle(
        |moments| Ok(vec![drive.loaded_motion(&free[0], &moments[0])?]),
        |_, _| {
            // a rotor that never answers the same
            count.set(count.get() + 1);
            let mean = 0.01 * ((f64::from(count.get()) * 12.9898).sin() * 43_758.545_3).fract();
            Ok(((), vec![HarmonicSeries { mean, ..HarmonicSeries::zero(12) }]))
        },
    );
    // the linear answer alone has a loop gain above 1, and that is said too
    let Err(PlantError::TooSoft { loop_gain, source, .. }) = result else {
        panic!("it settled");
    };
    assert!(loop_gain > 1.0, "{loop_gain}");
    let PlantError::Coupling { iterations, residual_deg, .. } = *source else {
        panic!("{source}");
    };
    assert_eq!(iterations, 40);
    assert!(residual_deg > COUPLING_TOLERANCE_DEG && residual_deg.is_finite());
}

/// An actuator so soft that a motion feeds itself is named as the reason, with the share of its compliance
/// at which the loop gain is 1; the gain is proportional to the compliance.
#[test]
fn an_actuator_too_soft_for_its_flap_is_named() {
    let settled = |compliance: f64| {
        let drive = soft(compliance);
        let free = [drive.motion(&sine(4, 40.0)).unwrap()];
        let give = drive.compliance_deg_per_newton_metre();
        let coupling =
            HingeCoupling::new(give, vec![HarmonicSeries::zero(12)], response(1, 1.0)).unwrap();
        let result: Result<(_, (), _), _> = coupling.settle(
            |moments| Ok(vec![drive.loaded_motion(&free[0], &moments[0])?]),
            |_, _| Err(PlantError::BiasSearch),
        );
        (coupling.loop_gain(), result.unwrap_err())
    };
    let critical = 0.9 / settled(0.9).0;
    let (half, error) = settled(0.5 * critical);
    assert_abs_diff_eq!(half, 0.5, epsilon = 1e-9);
    assert_eq!(error, PlantError::BiasSearch);
    let (twice, error) = settled(2.0 * critical);
    assert_abs_diff_eq!(twice, 2.0, epsilon = 1e-9);
    let PlantError::TooSoft { loop_gain, share_percent, .. } = &error else {
        panic!("{error}");
    };
    assert_abs_diff_eq!(*loop_gain, 2.0, epsilon = 1e-9);
    assert_abs_diff_eq!(*share_percent, 50.0, epsilon = 1e-6);
    assert!(error.to_string().contains("compliance_um_per_newton"), "{error}");
}
