//! Finer azimuth points of a station whose flow turns round inside a time element.
//!
//! Where the tangential speed `x + mu sin psi` of a section passes through zero, or through the Mach
//! number below which a section model stops following it, poles and gains of the lags have kinks, and a
//! lag as fast as a pressure wave goes to rest and wakes again within a tenth of a radian. No polynomial
//! of a whole time element follows that. Such an element is cut at its kinks into pieces with Gauss
//! points of their own: the flow, which is smooth, is interpolated to them, lags and loads are formed
//! there, and the loads come back as their best polynomial over the element,
//!
//! ```text
//! flow(s_j) = sum_i L_i(s_j) flow_i           F_i = (1 / w_i) sum_j w_j L_i(s_j) F(s_j)
//! ```
//! `L_i` the Lagrange polynomials of the element's Gauss points, `w` the quadrature weights. That is the
//! projection in the mean square (the `L_i` are orthogonal), so the loads do on every motion that the
//! element can hold the work they do on it at the finer points, and smooth loads are not changed.

use std::f64::consts::{PI, TAU};

use rotor_base::{LagrangeBasis, gauss_legendre};
use rotor_fem::TimeElements;

use crate::sections::air::{SectionFlow, SectionLoads};

/// Kinks nearer to each other or to the end of an element than this part of the element are one place.
const SAME_PLACE: f64 = 1e-6;

/// Tangential speed of the rigid blade at one station, and the speeds at which its sections have kinks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RigidSpeed<'a> {
    /// Station, radius R.
    pub(crate) station: f64,
    pub(crate) advance_ratio: f64,
    /// Tangent of the sweep angle `L`, aft positive.
    pub(crate) sweep: f64,
    /// Magnitudes of speed with a kink besides zero, tip speed.
    pub(crate) kinks: &'a [f64],
}

impl RigidSpeed<'_> {
    /// `x + mu (sin psi - tan L cos psi)`.
    pub(crate) fn at(&self, azimuth_rad: f64) -> f64 {
        let (sin, cos) = azimuth_rad.sin_cos();
        self.station + self.advance_ratio * (sin - self.sweep * cos)
    }

    /// Azimuths in `[0, 2 pi)` where the speed has the magnitude of a kink.
    fn azimuths(&self) -> Vec<f64> {
        // sin psi - tan L cos psi = sin(psi - L) / cos L
        let (amplitude, phase) = (self.advance_ratio * self.sweep.hypot(1.0), self.sweep.atan());
        let magnitudes = self.kinks.iter().flat_map(|k| [*k, -*k]).chain([0.0]);
        magnitudes
            .map(|speed| ((speed - self.station) / amplitude).asin())
            .filter(|angle| angle.is_finite())
            .flat_map(|angle| [angle, PI - angle])
            .map(|psi| (psi + phase).rem_euclid(TAU))
            .collect()
    }
}

/// One Gauss rule's stretch of azimuth.
#[derive(Debug, Clone)]
struct Piece {
    element: usize,
    /// Values of the element's Lagrange polynomials at the points of the piece, point by point; none if
    /// the piece is the element.
    shapes: Option<Vec<f64>>,
    /// Half its length over that of the element.
    share: f64,
}

/// The finer azimuth points of one station.
#[derive(Debug, Clone)]
pub(crate) struct FineAzimuth {
    /// Azimuths of the points, rad, ascending.
    pub(crate) points: Vec<f64>,
    /// Half the length of every piece, rad.
    pub(crate) half_widths: Vec<f64>,
    pieces: Vec<Piece>,
    weights: Vec<f64>,
}

impl FineAzimuth {
    /// The points of a station with a speed of the rigid blade; `None` if no element has a kink.
    pub(crate) fn new(time: &TimeElements, speed: &RigidSpeed<'_>) -> Option<Self> {
        let kinks = speed.azimuths();
        let rule = gauss_legendre(time.gauss_per_element());
        let basis = LagrangeBasis::new(rule.nodes.clone());
        let length = TAU / time.elements() as f64;
        let mut fine = Self {
            points: Vec::new(),
            half_widths: Vec::new(),
            pieces: Vec::new(),
            weights: rule.weights,
        };
        let mut cut = false;
        for element in 0..time.elements() {
            let from = length * element as f64;
            let edges = edges(kinks.iter().map(|psi| (psi - from) / length));
            let whole = edges.len() == 2;
            cut |= !whole;
            for pair in edges.windows(2) {
                let share = pair[1] - pair[0];
                let local: Vec<f64> =
                    rule.nodes.iter().map(|s| pair[0] + 0.5 * share * (s + 1.0)).collect();
                fine.points.extend(local.iter().map(|at| from + length * at));
                fine.half_widths.push(0.5 * length * share);
                let shapes = || {
                    let values =
                        |at: &f64| basis.evaluate(2.0 * at - 1.0).into_iter().map(|[n, ..]| n);
                    local.iter().flat_map(values).collect()
                };
                fine.pieces.push(Piece { element, shapes: (!whole).then(shapes), share });
            }
        }
        cut.then_some(fine)
    }

    /// The flow at the finer points, without its sense.
    pub(crate) fn flows(&self, at_elements: &[SectionFlow], out: &mut Vec<SectionFlow>) {
        let g = self.weights.len();
        out.clear();
        for piece in &self.pieces {
            let of_element = &at_elements[piece.element * g..(piece.element + 1) * g];
            match &piece.shapes {
                None => out.extend_from_slice(of_element),
                Some(shapes) => out.extend(shapes.chunks_exact(g).map(|row| {
                    let mut flow = SectionFlow::default();
                    for (shape, value) in row.iter().zip(of_element) {
                        flow.add(*shape, value);
                    }
                    flow
                })),
            }
        }
    }

    /// The loads of the finer points as their best polynomial over every element, at its points.
    pub(crate) fn loads(&self, at_points: &[SectionLoads], out: &mut [SectionLoads]) {
        let g = self.weights.len();
        out.fill(SectionLoads::default());
        for (piece, values) in self.pieces.iter().zip(at_points.chunks_exact(g)) {
            let of_element = &mut out[piece.element * g..(piece.element + 1) * g];
            match &piece.shapes {
                None => of_element.copy_from_slice(values),
                Some(shapes) => {
                    for ((row, value), weight) in
                        shapes.chunks_exact(g).zip(values).zip(&self.weights)
                    {
                        for ((target, shape), own) in
                            of_element.iter_mut().zip(row).zip(&self.weights)
                        {
                            target.add(piece.share * weight * shape / own, value);
                        }
                    }
                }
            }
        }
    }
}

/// Ends of the pieces of one element, 0 to 1, from where its kinks are.
fn edges(kinks: impl Iterator<Item = f64>) -> Vec<f64> {
    let inside = kinks.filter(|at| *at > SAME_PLACE && *at < 1.0 - SAME_PLACE);
    let mut edges: Vec<f64> = inside.chain([0.0, 1.0]).collect();
    edges.sort_by(f64::total_cmp);
    edges.dedup_by(|a, b| (*a - *b).abs() < SAME_PLACE);
    edges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::lag::{Collocation, PeriodicLag};
    use approx::assert_abs_diff_eq;

    const SPEED: RigidSpeed<'_> =
        RigidSpeed { station: 0.22, advance_ratio: 0.3, sweep: 0.0, kinks: &[0.08] };

    /// `int_0^psi |x + mu sin| dpsi` for `x < mu`.
    fn travelled(psi: f64) -> f64 {
        let whole = |p: f64| SPEED.station * p - SPEED.advance_ratio * p.cos();
        let first = PI + (SPEED.station / SPEED.advance_ratio).asin();
        let last = 3.0 * PI - first;
        let passed = |p: f64| p.clamp(first, last);
        whole(psi) - whole(0.0) - 2.0 * (whole(passed(psi)) - whole(first))
    }

    /// Largest error of a lag with a rate `k |x + mu sin psi|`, which stands still twice a revolution.
    ///
    /// In distance travelled the rate is constant: `r = cos(w s)` gives `x = (k^2 cos + k w sin)/(k^2 + w^2)`.
    fn lag_error(elements: usize, cut: bool) -> f64 {
        let time = TimeElements::new(elements, 5, 8).unwrap();
        let whole = Collocation::new(&time);
        let fine = FineAzimuth::new(&time, &SPEED).unwrap();
        let (points, collocation) = if cut {
            (fine.points.as_slice(), whole.on(&fine.half_widths))
        } else {
            (time.points(), whole)
        };
        let (k, w) = (400.0, 2.0 * TAU / travelled(TAU));
        let rates: Vec<f64> = points.iter().map(|p| k * SPEED.at(*p).abs()).collect();
        let drive: Vec<f64> = points.iter().map(|p| (w * travelled(*p)).cos()).collect();
        let lag = PeriodicLag::new(&collocation, &rates).unwrap();
        let state = lag.operator() * nalgebra::DVector::from_vec(drive);
        let exact = |psi: f64| {
            let (sin, cos) = (w * travelled(psi)).sin_cos();
            k * (k * cos + w * sin) / (k * k + w * w)
        };
        points.iter().zip(&state).map(|(p, x)| (x - exact(*p)).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_lag_through_reverse_flow_keeps_its_order() {
        let [whole, cut] = [false, true].map(|cut| [8, 16, 32].map(|n| lag_error(n, cut)));
        println!("whole elements {whole:?}, cut {cut:?}");
        assert!(cut[0] <= 1e-5, "{cut:?}");
        for (cut, whole) in cut.windows(2).zip(whole.windows(2)) {
            // order 8 and more; below 3 without the cuts
            assert!(cut[0] / cut[1] >= 256.0 && whole[0] / whole[1] < 8.0, "{cut:?}, {whole:?}");
        }
    }

    /// Loads that an element can hold come back as they were, and any others do the same work.
    #[test]
    fn the_projection_keeps_the_work() {
        let time = TimeElements::new(8, 5, 8).unwrap();
        let fine = FineAzimuth::new(&time, &SPEED).unwrap();
        let load = |fz: f64| SectionLoads { fz, ..SectionLoads::default() };
        let smooth = |psi: &f64| load(1.0 + psi.sin() - 0.3 * psi.powi(3));
        let mut back = vec![SectionLoads::default(); time.points().len()];
        fine.loads(&fine.points.iter().map(smooth).collect::<Vec<_>>(), &mut back);
        for (got, psi) in back.iter().zip(time.points()) {
            assert_abs_diff_eq!(got.fz, smooth(psi).fz, epsilon = 1e-9);
        }
        let kinked: Vec<_> = fine.points.iter().map(|psi| load(SPEED.at(*psi).abs())).collect();
        fine.loads(&kinked, &mut back);
        let mean: f64 = back.iter().zip(time.weights()).map(|(f, w)| w * f.fz).sum();
        assert_abs_diff_eq!(mean, travelled(TAU), epsilon = 1e-12);
    }

    #[test]
    fn the_flow_is_carried_to_the_points() {
        let time = TimeElements::new(8, 5, 8).unwrap();
        let fine = FineAzimuth::new(&time, &SPEED).unwrap();
        let at = |psi: &f64| SectionFlow { u_t: SPEED.at(*psi), ..SectionFlow::default() };
        let mut flows = Vec::new();
        fine.flows(&time.points().iter().map(at).collect::<Vec<_>>(), &mut flows);
        assert_eq!(flows.len(), fine.points.len());
        for (flow, psi) in flows.iter().zip(&fine.points) {
            assert_abs_diff_eq!(flow.u_t, SPEED.at(*psi), epsilon = 1e-8);
        }
        assert!(fine.points.windows(2).all(|p| p[0] < p[1]));
    }

    #[test]
    fn only_a_station_with_a_kink_has_finer_points() {
        let time = TimeElements::default();
        let of = |station, advance_ratio, kinks| {
            FineAzimuth::new(&time, &RigidSpeed { station, advance_ratio, sweep: 0.0, kinks })
                .is_some()
        };
        assert!(of(0.25, 0.3, &[]) && !of(0.35, 0.3, &[]) && of(0.35, 0.3, &[0.08]));
        assert!(!of(0.5, 0.3, &[0.08]) && !of(0.25, 0.0, &[0.08]) && !of(0.0, 0.0, &[]));
    }
}
