//! Incompressible section: Theodorsen's coefficients with lag states for his function.

use crate::{FlapChord, LagChannel, SectionCoefficients, TheodorsenFunctions};
use std::f64::consts::TAU;

/// Weights and poles (per semichord) of the lags that stand for Theodorsen's function,
/// `C(k) = 1 - sum A ik / (ik + b)`.
///
/// Source: R. T. Jones, NACA Report 681 (1940).
const JONES: [(f64, f64); 2] = [(0.165, 0.0455), (0.335, 0.300)];

/// Coefficients of the incompressible model.
///
/// ```text
/// Cn = 2 pi C[w] + apparent mass                    w = alpha + q/2 + (T10/pi) delta + (T11/4 pi) q_delta
/// Cm = held moment + apparent mass                  (circulation acts at the quarter chord)
/// Ch = held hinge moment - (T12/2) C[w] + apparent mass
/// C[w] = (1 - A1 - A2) w + A1 x1 + A2 x2,           dx_i/dS = b_i (w - x_i)
/// ```
/// Exact thin-aerofoil theory but for the two lags. The four inputs are held apart, each a downwash
/// of fixed shape; a flap motion is `delta` together with `q_delta = 2 d(delta)/dS`, a pitch motion
/// `alpha` together with `q`, and both halves of Theodorsen's rate terms then come together.
///
/// Source: Theodorsen, NACA Report 496; the split into held downwash and apparent mass follows from
/// his velocity potentials.
pub(crate) fn coefficients(flap: FlapChord) -> SectionCoefficients {
    let t = TheodorsenFunctions::new(flap.hinge());
    let circulation = t.circulatory_input();
    let at_once = 1.0 - JONES.iter().map(|(a, _)| a).sum::<f64>();
    let lift = circulation.map(|w| TAU * at_once * w);
    let mut hinge = t.held_hinge();
    for (h, w) in hinge.iter_mut().zip(circulation) {
        *h += t.circulatory_hinge() * at_once * w;
    }
    let lags = JONES
        .iter()
        .map(|&(a, pole)| LagChannel {
            pole,
            input: circulation,
            output: [TAU * a, 0.0, t.circulatory_hinge() * a],
            is_circulatory: true,
        })
        .collect();
    SectionCoefficients {
        direct: [lift, t.held_moment(), hinge],
        rate: t.apparent_mass(),
        lags,
        ..SectionCoefficients::default()
    }
}
