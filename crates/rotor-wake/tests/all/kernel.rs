//! The induced-velocity kernel against closed forms.
#![expect(clippy::float_cmp, reason = "the same sum in the same order gives the same bits")]

use approx::{assert_abs_diff_eq, assert_relative_eq};
use proptest::prelude::*;
use rotor_wake::{
    CoreModel, SegmentSet, Vec3, arc_velocity, induced_velocities, induced_velocities_serial,
};
use std::f64::consts::{PI, TAU};

/// A ring of unit circulation and radius about the Z axis, counter-clockwise seen from above.
fn ring(segments: usize, core: CoreModel, radius: f64) -> (SegmentSet, Vec<Vec3>) {
    let nodes: Vec<Vec3> = (0..=segments)
        .map(|k| {
            let angle = TAU * (k % segments) as f64 / segments as f64;
            [angle.cos(), angle.sin(), 0.0]
        })
        .collect();
    let mut set = SegmentSet::new(core);
    for pair in nodes.windows(2) {
        set.push(pair[0], pair[1], 1.0, radius);
    }
    (set, nodes)
}

#[test]
fn a_finite_straight_segment_is_exact() {
    let mut set = SegmentSet::new(CoreModel::Vatistas);
    set.push([0.0, 0.0, -0.4], [0.0, 0.0, 0.7], 2.5, 0.0);
    for (h, z) in [(0.1, 0.0), (0.5, 0.2), (2.0, -1.0), (0.01, 0.69), (7.0, 3.0)] {
        let [vx, vy, vz] = induced_velocities(&[[h, 0.0, z]], &set)[0];
        let cosines = (z + 0.4) / f64::hypot(h, z + 0.4) - (z - 0.7) / f64::hypot(h, z - 0.7);
        assert_relative_eq!(vy, 2.5 / (4.0 * PI * h) * cosines, max_relative = 1e-13);
        assert_abs_diff_eq!(vx, 0.0, epsilon = 1e-15);
        assert_abs_diff_eq!(vz, 0.0, epsilon = 1e-15);
    }
}

/// Vatistas's swirl on the line through the middle of a very long segment, `Gamma/2pi h / sqrt(h^4 +
/// r_c^4)`, largest at the core radius.
#[test]
fn the_core_has_the_profile_of_vatistas() {
    let mut set = SegmentSet::new(CoreModel::Vatistas);
    set.push([0.0, 0.0, -1e4], [0.0, 0.0, 1e4], 1.0, 0.05);
    let swirl = |h: f64| induced_velocities(&[[h, 0.0, 0.0]], &set)[0][1];
    for h in [0.001, 0.02, 0.05, 0.2] {
        let exact = h / (TAU * (f64::powi(h, 4) + 0.05_f64.powi(4)).sqrt());
        assert_relative_eq!(swirl(h), exact, max_relative = 1e-8);
    }
    assert!(swirl(0.05) > swirl(0.049) && swirl(0.05) > swirl(0.051));
}

#[test]
fn a_ring_on_its_axis_converges_with_second_order() {
    let axis = |n: usize, z: f64| {
        let (set, _) = ring(n, CoreModel::Vatistas, 1e-6);
        induced_velocities(&[[0.0, 0.0, z]], &set)[0][2]
    };
    for z in [0.0, 0.5, 1.5] {
        let exact = 0.5 / f64::powf(1.0 + z * z, 1.5);
        let errors = [36, 72, 144, 288].map(|n| (axis(n, z) / exact - 1.0).abs());
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((order - 2.0).abs() < 0.02, "z = {z}: order {order}, errors {errors:?}");
        }
    }
    // the table of the polygon at the centre
    for (n, error) in [(36, 2.55e-3), (288, 3.97e-5)] {
        assert_relative_eq!(axis(n, 0.0) / 0.5 - 1.0, error, max_relative = 0.01);
    }
}

/// The self-velocity of the polygon at a node of the ring.
fn ring_speed(n: usize, core: CoreModel, radius: f64) -> f64 {
    let (set, nodes) = ring(n, core, radius);
    let mut speed = induced_velocities(&nodes[..1], &set)[0][2];
    if core == CoreModel::RosenheadMoore {
        speed += arc_velocity([nodes[n - 1], nodes[0], nodes[1]], 1.0, radius)[2];
    }
    speed
}

/// The kernel's own converged value: regularised on the distance to the line of each segment, a ring is
/// slower than Kelvin's.
#[test]
fn a_ring_travels_at_the_kernels_own_converged_speed() {
    for (radius, speed) in [(0.05, 0.215_298), (0.02, 0.252_013)] {
        let got = ring_speed(2000, CoreModel::Vatistas, radius);
        assert_relative_eq!(got, speed, max_relative = 0.005);
    }
}

/// Kelvin: `(ln(8 R / r_c) - 1/4) Gamma / 4 pi R`; the corrected model reaches it on a coarse polygon, and
/// not without the arcs.
#[test]
fn a_ring_travels_at_kelvins_speed_with_the_corrected_core() {
    for radius in [0.05, 0.02] {
        let kelvin = (f64::ln(8.0 / radius) - 0.25) / (4.0 * PI);
        for n in [72, 144, 288] {
            let got = ring_speed(n, CoreModel::RosenheadMoore, radius);
            assert_relative_eq!(got, kelvin, max_relative = 0.005);
        }
        let (set, nodes) = ring(36, CoreModel::RosenheadMoore, radius);
        let bare = induced_velocities(&nodes[..1], &set)[0][2];
        assert!(bare / kelvin < 0.85, "without arcs: {}", bare / kelvin);
    }
}

#[test]
fn points_on_the_line_and_at_the_ends_stay_numbers() {
    for core in [CoreModel::Vatistas, CoreModel::RosenheadMoore] {
        for radius in [0.0, 0.02] {
            let mut set = SegmentSet::new(core);
            set.push([0.0; 3], [0.0, 0.0, 1.0], 1.0, radius);
            set.push([0.3; 3], [0.3; 3], 1.0, radius);
            for at in [[0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 0.5], [0.0, 0.0, 7.0]] {
                let v = induced_velocities(&[at], &set)[0];
                assert!(v.iter().all(|x| x.abs() < 1e-12), "{core:?} {radius} {at:?}: {v:?}");
            }
        }
    }
}

proptest! {
    /// The velocity field of a closed ring has no divergence and, off the cores, no curl.
    #[test]
    fn the_field_of_a_ring_is_free_of_divergence_and_curl(
        x in -2.0..2.0_f64, y in -2.0..2.0_f64, z in 0.3..2.0_f64
    ) {
        let (set, _) = ring(24, CoreModel::Vatistas, 1e-4);
        let h = 1e-4;
        let v = |dx: [f64; 3]| {
            induced_velocities(&[[x + dx[0], y + dx[1], z + dx[2]]], &set)[0]
        };
        let unit = |k: usize, s: f64| { let mut d = [0.0; 3]; d[k] = s * h; d };
        let gradient: Vec<Vec3> = (0..3)
            .map(|k| {
                let (a, b) = (v(unit(k, 1.0)), v(unit(k, -1.0)));
                [0, 1, 2].map(|c| (a[c] - b[c]) / (2.0 * h))
            })
            .collect();
        let divergence = gradient[0][0] + gradient[1][1] + gradient[2][2];
        prop_assert!(divergence.abs() < 1e-5);
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            prop_assert!((gradient[i][j] - gradient[j][i]).abs() < 1e-5);
        }
    }

    /// Same bits with one thread and many, and for any place of a target in its block.
    #[test]
    fn the_bits_do_not_depend_on_threads_or_lanes(count in 1..200_usize) {
        let (set, _) = ring(37, CoreModel::Vatistas, 0.02);
        let targets: Vec<Vec3> = (0..count)
            .map(|k| [0.01 * k as f64 - 1.0, 0.3, 0.02 * k as f64])
            .collect();
        let many = induced_velocities(&targets, &set);
        let mut one = vec![[0.0; 3]; count];
        induced_velocities_serial(&targets, &set, &mut one);
        prop_assert_eq!(&many, &one);
        let last = induced_velocities(&targets[count - 1..], &set);
        prop_assert_eq!(last[0], one[count - 1]);
    }
}

/// Segments in single precision: within 1e-4 of the largest velocity (targets ten radii from the origin are known
/// to 1e-6 R, a part of the core), a target on a segment's end or line included, and the same bits with one thread and two.
#[test]
fn single_precision_is_near_and_repeatable() {
    let nodes: Vec<Vec3> = (0..400)
        .map(|k| {
            let angle = 0.1 * f64::from(k);
            [angle.cos() + 0.2 * angle, angle.sin(), -0.01 * angle]
        })
        .collect();
    let targets: Vec<Vec3> =
        nodes.iter().flat_map(|p| [*p, [p[0] + 0.03, p[1] - 0.01, p[2] + 0.02]]).collect();
    for model in [CoreModel::Vatistas, CoreModel::RosenheadMoore] {
        let mut double = SegmentSet::new(model);
        let mut mixed = SegmentSet::new(model);
        for (k, pair) in nodes.windows(2).enumerate() {
            double.push(pair[0], pair[1], 0.01, 0.02);
            if k < 100 {
                mixed.push(pair[0], pair[1], 0.01, 0.02);
            } else {
                mixed.push_single(pair[0], pair[1], 0.01, 0.02);
            }
        }
        assert_eq!(mixed.len(), double.len());
        let (exact, got) =
            (induced_velocities(&targets, &double), induced_velocities(&targets, &mixed));
        let largest = exact.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
        let worst = exact
            .iter()
            .flatten()
            .zip(got.iter().flatten())
            .fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
        println!("{model:?}: {:.1e} of the largest velocity", worst / largest);
        assert!(worst < 1e-4 * largest && worst > 0.0, "{model:?}: {:e}", worst / largest);
        let mut serial = vec![[0.0; 3]; targets.len()];
        induced_velocities_serial(&targets, &mixed, &mut serial);
        assert_eq!(serial, got);
    }
}
