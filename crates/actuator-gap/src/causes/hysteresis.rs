//! Hysteresis itself: what a model without memory lacks.

use super::cause::{BenchCause, amount, logarithmic, shape, usual};
use super::chain::Loops;
use model_gap::{Candidate, Class};

/// Static hysteresis, a candidate where the base model has none.
pub(crate) const CAUSE: BenchCause = BenchCause {
    candidate: |design| {
        let of_stroke = |part: f64| part * design.half_stroke;
        Candidate {
            id: "hysteresis",
            physics: "The output depends on where the input turned, at any speed: y = h - share (h - mean of plays of h).",
            parameters: vec![
                amount("share", "1", 0.0, 1.5),
                shape(logarithmic("widest", "um", of_stroke(0.02), of_stroke(2.0))),
            ],
            class: Class::LoopShape,
            fingerprint: "loops as wide when slow as when fast, wider than in proportion at large amplitude",
            confused_with: &["backlash", "coulomb-friction", "creep"],
            separating: &["amplitude-sweep", "frequency-sweep"],
            starts: [0.15, 0.5, 1.2].map(|part| vec![0.1, of_stroke(part)]).to_vec(),
            ..usual()
        }
    },
    apply: |chain, values| {
        chain.front.loops = Some(Loops { share: values[0], widest: values[1] });
    },
};

/// Plays of the candidate.
const PLAYS: u32 = 12;

/// A law's output with loops: part of it follows through plays, evenly up to the widest.
///
/// ```text
/// y = h - share (h - (1/n) sum_i play_i[h]),   half-widths i/n of the widest
/// ```
/// Source: the Prandtl-Ishlinskii operator, M. Brokate, J. Sprekels, *Hysteresis and Phase
/// Transitions* (1996), section 2.4.
pub(crate) fn looped(law: &[f64], share: f64, widest: f64) -> Vec<f64> {
    let Some(&first) = law.first() else { return Vec::new() };
    let count = f64::from(PLAYS);
    let mut plays: Vec<(f64, f64)> =
        (1..=PLAYS).map(|i| (widest * f64::from(i) / count, first)).collect();
    law.iter()
        .map(|&h| {
            let mut sum = 0.0;
            for (half_width, state) in &mut plays {
                *state = state.min(h + *half_width).max(h - *half_width);
                sum += *state;
            }
            h - share * (h - sum / count)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_close_and_do_not_depend_on_speed() {
        let wave = |i: u32, n: u32| (std::f64::consts::TAU * f64::from(i) / f64::from(n)).sin();
        let slow: Vec<f64> = (0..=800).map(|i| wave(i, 400)).collect();
        let fast: Vec<f64> = slow.iter().step_by(20).copied().collect();
        let (a, b) = (looped(&slow, 0.3, 0.8), looped(&fast, 0.3, 0.8));
        for (i, y) in b.iter().enumerate() {
            assert!((y - a[20 * i]).abs() < 1e-12);
        }
        // the same input on the way up and down, another output; the second cycle is the first again
        assert!((a[420] - a[580]).abs() > 0.05, "{} {}", a[420], a[580]);
        assert!((a[500] - a[100]).abs() < 0.02, "{} {}", a[500], a[100]);
        assert_eq!(looped(&slow, 0.0, 0.8), slow);
    }
}
