//! The runs that an actuator is usually measured by.

use crate::next::Span;
use crate::record::Record;

/// The runs that an actuator is usually measured by: triangles, multisines from 1 to 35 and from 5 to 181 Hz, steps,
/// bursts at 10 Hz, a minute of drive, rest.
pub fn usual_runs((low, high): (f64, f64)) -> Vec<Record> {
    let span = Span { middle: f64::midpoint(low, high), half: 0.5 * (high - low) };
    let bursts = [(0.35, 5.0), (0.6, 5.0), (0.9, 5.0)];
    let warm = [(0.35, 40.0), (0.9, 600.0), (0.35, 160.0)];
    let rest = [(0.0, 0.0), (8.0, 0.0), (8.005, 0.24), (8.1, 0.24), (8.105, 0.0), (8.2, 0.0)];
    [
        ("triangles", 2e-3, span.triangles(1.0, &[0.9, 0.6, 0.3], 2e-3)),
        ("multisine_large", 1e-3, span.multisine((1.0, 35.0), 0.5, 0.9, 3.0, 1e-3)),
        ("multisine_small", 1e-3, span.multisine((1.0, 35.0), 0.5, 0.35, 3.0, 1e-3)),
        ("wide_band", 5e-4, span.multisine((5.0, 181.0), 2.0, 0.25, 2.0, 5e-4)),
        ("steps", 1e-2, span.steps(&[0.6, -0.5, 0.0], 6.0, 1e-2)),
        ("bursts_10hz", 1e-3, span.bursts(10.0, 0.0, &bursts, 1e-3)),
        ("warm_up", 5e-3, span.bursts(20.0, 0.0, &warm, 5e-3)),
        ("rest", 2e-3, span.path(&rest, 2e-3)),
    ]
    .map(|(id, step_s, input)| Record::new(id, step_s, input, Vec::new()))
    .into()
}
