//! Memory of many draws of the noise: of each flight no more than its spread needs. Alone in its file: an allocator counts
//! for the whole process.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

mod common;

use common::actuator;
use rotor_case::{Case, FlightController, FlightValues};
use rotor_flight::{FlyingCase, Guidance, fly};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;
use std::sync::atomic::{AtomicUsize, Ordering};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

const DRAWS: usize = 48;

/// Bytes held since a region began.
fn held(region: &Region<'_, System>) -> usize {
    let change = region.change();
    change.bytes_allocated.saturating_sub(change.bytes_deallocated)
}

#[test]
fn a_draw_keeps_its_spread_alone() {
    let mut case = Case { advance_ratio: 0.2, ..Case::default() };
    case.structure.elements = 4;
    let values = FlightValues {
        start_advance_ratio: 0.2,
        end_advance_ratio: 0.2,
        harmonics: vec![3],
        duration_s: 20.0,
        controllers: vec![FlightController::Fixed],
        ..FlightValues::default()
    };
    let flying = FlyingCase::new(&case, &values, &actuator()).unwrap();
    let flight = flying.flight_at(&[3]).unwrap();
    let region = Region::new(ALLOCATOR);
    let points = fly(&flight, &Guidance::Fixed).unwrap();
    let of_a_flight = held(&region);
    assert!(points.len() > 40 && of_a_flight > 10_000, "{of_a_flight}");
    drop(points);
    // what is held when the first flight has ended, and the last
    let (done, first, last) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicUsize::new(0));
    let region = Region::new(ALLOCATOR);
    let drawn = flying.draws(DRAWS, &|| {
        let is_first = done.fetch_add(1, Ordering::SeqCst) == 0;
        if is_first { &first } else { &last }.fetch_max(held(&region), Ordering::SeqCst);
    });
    assert_eq!(drawn.unwrap().draws, DRAWS);
    let [first, last] = [first, last].map(AtomicUsize::into_inner);
    let growth = last.saturating_sub(first);
    println!("a flight holds {of_a_flight} bytes; {first} after one draw, {last} at most");
    assert!(growth < DRAWS * of_a_flight / 4, "{growth} of {}", DRAWS * of_a_flight);
}
