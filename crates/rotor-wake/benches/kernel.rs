//! Rate of the induced-velocity kernel.
//!
//! Budget: 80 % of 2.6e8 evaluations/s on one thread of an AVX2 or AVX-512 machine, and 1.8 times
//! that rate on two. The plain loop over targets and segments that a C program would have is
//! measured beside it.
#![expect(clippy::print_stdout, reason = "the ratio to the budget is the bench's result")]
#![expect(clippy::unwrap_used, reason = "a bench whose thread pool is refused cannot go on")]
#![expect(clippy::disallowed_methods, reason = "a bench reads the clock")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rotor_wake::{CoreModel, SegmentSet, Vec3, induced_velocities, induced_velocities_serial};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Evaluations per second and core of a vectorised kernel.
const REFERENCE_RATE: f64 = 2.6e8;
const TARGETS: usize = 2048;
const SEGMENTS: usize = 1024;
const CORE: f64 = 0.02;

/// Points of a helix of a few turns.
fn helix(count: usize) -> Vec<Vec3> {
    (0..count)
        .map(|k| {
            let angle = 0.05 * k as f64;
            [angle.cos() + 0.3 * angle, angle.sin(), -0.01 * angle]
        })
        .collect()
}

fn segments(core: CoreModel) -> SegmentSet {
    let mut set = SegmentSet::new(core);
    for pair in helix(SEGMENTS + 1).windows(2) {
        set.push(pair[0], pair[1], 0.01, CORE);
    }
    set
}

/// The loop of a C program.
fn reference(targets: &[Vec3], nodes: &[Vec3], out: &mut [Vec3]) {
    for (at, v) in targets.iter().zip(out) {
        *v = [0.0; 3];
        for pair in nodes.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let l = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
            let r1 = [at[0] - a[0], at[1] - a[1], at[2] - a[2]];
            let r2 = [at[0] - b[0], at[1] - b[1], at[2] - b[2]];
            let c = [
                l[1] * r1[2] - l[2] * r1[1],
                l[2] * r1[0] - l[0] * r1[2],
                l[0] * r1[1] - l[1] * r1[0],
            ];
            let (mut h, mut l2, mut n1, mut n2, mut d1, mut d2) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
            for i in 0..3 {
                h += c[i] * c[i];
                l2 += l[i] * l[i];
                n1 += r1[i] * r1[i];
                n2 += r2[i] * r2[i];
                d1 += l[i] * r1[i];
                d2 += l[i] * r2[i];
            }
            let core = CORE * CORE * l2;
            let d = (h * h + core * core).sqrt();
            let (a, b) = (f64::sqrt(n1), f64::sqrt(n2));
            let f = 0.01 / (4.0 * std::f64::consts::PI) * (d1 * b - d2 * a) / (a * b * d + 1e-60);
            for i in 0..3 {
                v[i] += f * c[i];
            }
        }
    }
}

/// Best rate of many batches: other work on the machine interrupts some of them, not all.
fn rate(mut call: impl FnMut()) -> f64 {
    let best = (0..60)
        .map(|_| {
            let start = Instant::now();
            call();
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min);
    (TARGETS * SEGMENTS) as f64 / best
}

fn kernel(criterion: &mut Criterion) {
    let targets: Vec<Vec3> =
        helix(TARGETS).iter().map(|p| [p[0] + 0.013, p[1] - 0.02, p[2] + 0.03]).collect();
    let set = segments(CoreModel::Vatistas);
    let corrected = segments(CoreModel::RosenheadMoore);
    let nodes = helix(SEGMENTS + 1);
    let mut out = vec![[0.0; 3]; TARGETS];

    let plain = rate(|| reference(black_box(&targets), black_box(&nodes), &mut out));
    println!("plain loop, 1 thread: {plain:.3e} evaluations/s");
    let serial = rate(|| induced_velocities_serial(black_box(&targets), black_box(&set), &mut out));
    println!(
        "kernel, 1 thread: {serial:.3e} evaluations/s, ratio to 2.6e8: {:.2} (asked: 0.80), to the plain loop: {:.2}",
        serial / REFERENCE_RATE,
        serial / plain
    );
    let moore =
        rate(|| induced_velocities_serial(black_box(&targets), black_box(&corrected), &mut out));
    println!("kernel, corrected core, 1 thread: {moore:.3e} evaluations/s");
    let mut far = SegmentSet::new(CoreModel::Vatistas);
    for pair in nodes.windows(2) {
        far.push_single(pair[0], pair[1], 0.01, CORE);
    }
    let exact = induced_velocities(&targets, &set);
    let apart =
        exact.iter().flatten().zip(induced_velocities(&targets, &far).into_iter().flatten());
    let [error, largest] = apart.fold([0.0_f64; 2], |[error, largest], (a, b)| {
        [error.max((a - b).abs()), largest.max(a.abs())]
    });
    let single = rate(|| induced_velocities_serial(black_box(&targets), black_box(&far), &mut out));
    println!(
        "kernel, single precision, 1 thread: {single:.3e} evaluations/s, {:.2} times double; largest error {:.1e} of the \
         largest velocity",
        single / serial,
        error / largest
    );
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    let parallel = pool.install(|| {
        rate(|| {
            black_box(induced_velocities(black_box(&targets), black_box(&set)));
        })
    });
    println!(
        "kernel, 2 threads: {parallel:.3e} evaluations/s, {:.2} times one thread (asked: 1.8)",
        parallel / serial
    );
    let mut group = criterion.benchmark_group("kernel");
    group.throughput(Throughput::Elements((TARGETS * SEGMENTS) as u64));
    group.bench_function("plain loop", |b| {
        b.iter(|| reference(black_box(&targets), black_box(&nodes), &mut out));
    });
    group.bench_function("1 thread", |b| {
        b.iter(|| induced_velocities_serial(black_box(&targets), black_box(&set), &mut out));
    });
    group.bench_function("2 threads", |b| {
        pool.install(|| b.iter(|| induced_velocities(black_box(&targets), black_box(&set))));
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(2));
    targets = kernel
}
criterion_main!(benches);
