//! What the vector unit of one core can do at most: independent divisions, square roots and multiply-adds in double
//! precision.
//!
//! No budget: these are the limits that the other benches are held against. Throughput counts single numbers, not vectors.
#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pulp::{Arch, Simd, WithSimd};
use std::hint::black_box;

/// Vectors that do not wait for each other: as many as hide the latency and still fit into sixteen registers.
const CHAINS: usize = 12;
/// Operations of each chain.
const STEPS: usize = 1000;
/// Numbers that keep their digits in every operation, for none of them is rational.
const START: f64 = std::f64::consts::SQRT_2;

/// An operation of the vector unit.
#[derive(Clone, Copy)]
enum Operation {
    Division,
    Root,
    MultiplyAdd,
}

/// Some steps of all chains.
struct Chains(Operation);

impl Chains {
    #[inline(always)]
    fn run<S: Simd>(simd: S, step: impl Fn(S::f64s) -> S::f64s) -> f64 {
        let mut chains: [S::f64s; CHAINS] =
            std::array::from_fn(|k| simd.splat_f64s(black_box(START + k as f64)));
        for _ in 0..STEPS {
            for x in &mut chains {
                *x = step(*x);
            }
        }
        chains.into_iter().map(|x| simd.reduce_sum_f64s(x)).sum()
    }
}

impl WithSimd for Chains {
    type Output = (usize, f64);

    /// Numbers worked on, and something made of them.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> (usize, f64) {
        let [a, b] = [START, 1.0 - 1.0 / START].map(|x| simd.splat_f64s(black_box(x)));
        let sum = match self.0 {
            Operation::Division => Self::run(simd, |x| simd.div_f64s(a, x)),
            Operation::Root => Self::run(simd, |x| simd.sqrt_f64s(simd.mul_f64s(a, x))),
            Operation::MultiplyAdd => Self::run(simd, |x| simd.mul_add_e_f64s(x, b, a)),
        };
        (CHAINS * STEPS * S::F64_LANES, sum)
    }
}

fn limits(criterion: &mut Criterion) {
    let arch = Arch::new();
    let mut group = criterion.benchmark_group("machine");
    for (name, operation) in [
        ("division", Operation::Division),
        ("root", Operation::Root),
        ("multiply-add", Operation::MultiplyAdd),
    ] {
        let (numbers, _) = arch.dispatch(Chains(operation));
        group.throughput(Throughput::Elements(numbers as u64));
        group.bench_function(name, |b| b.iter(|| black_box(arch.dispatch(Chains(operation)))));
    }
    group.finish();
}

criterion_group!(benches, limits);
criterion_main!(benches);
