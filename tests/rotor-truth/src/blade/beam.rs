//! Uncoupled modes of a rotating beam by Rayleigh and Ritz, SI units.
//!
//! ```text
//! flap     int EI_y w'' dw'' + N w' dw' + K w'(0) dw'(0) + sum k w dw                  = om^2 (int m w dw + sum M w dw)
//! lag      int EI_z v'' dv'' + N v' dv' - m O^2 v dv + K v'(0) dv'(0) - sum M O^2 v dv = om^2 (int m v dv + sum M v dv)
//! torsion  int (GJ + k_A^2 N) p' dp' + m O^2 (k_2^2 - k_1^2) p dp + K p(0) dp(0)       = om^2 int m (k_1^2 + k_2^2) p dp
//! N(x) = O^2 (int_x^L m r dx + sum beyond x of M r),   r = x + root station
//! ```
//! Trial functions are `s^p P_k(2s - 1)`, `s = x/L`: `p` = 2 of a clamped root, 1 of one that only turns or is held in torsion,
//! 0 of one that turns in torsion. Eighteen Legendre polynomials leave an error below 1e-6 of the frequencies of a uniform beam.

use crate::error::RotorTruthError;
use crate::physics::span::{Span, legendre};
use nalgebra::DMatrix;

/// Polynomials of the trial space.
const TRIALS: usize = 18;
/// Gauss points of a segment.
const POINTS: usize = 12;
/// Longest segment of integration, L.
const SEGMENT: f64 = 0.34;

/// A family of modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// Bending out of the plane of rotation.
    Flap,
    /// Bending in the plane of rotation.
    Lag,
    /// Torsion.
    Torsion,
}

impl Family {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flap => "flap",
            Self::Lag => "lag",
            Self::Torsion => "torsion",
        }
    }
}

/// A property along the beam: stations over the length, ascending from 0 to 1, with values; straight lines between.
pub type Along = Vec<(f64, f64)>;

/// The value of a property at a station over the length, 0 to 1.
pub fn at(along: &[(f64, f64)], s: f64) -> f64 {
    let after = along.iter().position(|own| own.0 >= s).unwrap_or(along.len().saturating_sub(1));
    match (along.get(after.saturating_sub(1)), along.get(after)) {
        (Some(a), Some(b)) if b.0 > a.0 => a.1 + (s - a.0) / (b.0 - a.0) * (b.1 - a.1),
        (_, Some(own)) => own.1,
        _ => 0.0,
    }
}

/// A mass at one station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lump {
    /// Station over the length, 0 to 1.
    pub station: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Its radii of gyration over those of the beam, 0 of a point.
    pub gyration: f64,
}

/// A rotating beam.
#[derive(Debug, Clone, PartialEq)]
pub struct Beam {
    /// Length, m.
    pub length_m: f64,
    /// Distance of the root from the axis of rotation, m.
    pub root_m: f64,
    /// Mass per length, kg/m.
    pub mass_kg_m: Along,
    /// Flap bending stiffness, N m^2.
    pub ei_flap: Along,
    /// Lag bending stiffness, N m^2.
    pub ei_lag: Along,
    /// Torsion stiffness, N m^2.
    pub gj: Along,
    /// Radii of gyration of the mass about and normal to the chord line, and of the area, m.
    pub gyration_m: [f64; 3],
    /// Springs of the root in flap, lag and torsion, N m/rad; none of a root that is held.
    pub root_spring: [Option<f64>; 3],
    /// Masses at stations.
    pub lumps: Vec<Lump>,
    /// Springs against flapping: station over the length and N/m.
    pub guys: Vec<(f64, f64)>,
}

/// Value, slope and second derivative of `s^power P_k(2s - 1)` for every `k`.
fn trials(s: f64, power: i32) -> Vec<[f64; 3]> {
    let p = legendre(2.0 * s - 1.0, TRIALS);
    let (mut first, mut second) = (vec![0.0; TRIALS], vec![0.0; TRIALS]);
    for k in 1..TRIALS {
        let below = |of: &[f64]| if k >= 2 { of[k - 2] } else { 0.0 };
        let rate = 2.0 * k as f64 - 1.0;
        (first[k], second[k]) =
            (below(&first) + rate * p[k - 1], below(&second) + rate * first[k - 1]);
    }
    let e = f64::from(power);
    let monomial = |n: i32| if n < 0 { 0.0 } else { s.powi(n) };
    let (m0, m1) = (monomial(power), e * monomial(power - 1));
    let m2 = e * (e - 1.0) * monomial(power - 2);
    let one = |k: usize| {
        let [value, slope, bend] = [p[k], 2.0 * first[k], 4.0 * second[k]];
        [m0 * value, m1 * value + m0 * slope, m2 * value + 2.0 * m1 * slope + m0 * bend]
    };
    (0..TRIALS).map(one).collect()
}

/// Quadratic forms of stiffness and mass over the trial functions.
struct Forms {
    power: i32,
    stiffness: DMatrix<f64>,
    mass: DMatrix<f64>,
}

impl Forms {
    fn new(power: i32) -> Self {
        let zeros = || DMatrix::zeros(TRIALS, TRIALS);
        Self { power, stiffness: zeros(), mass: zeros() }
    }

    /// Adds stiffness of value, slope and curvature, and mass, at a station.
    fn add(&mut self, s: f64, stiffness: [f64; 3], mass: f64) {
        let t = trials(s, self.power);
        for i in 0..TRIALS {
            for j in 0..TRIALS {
                let part = |d: usize| stiffness[d] * t[i][d] * t[j][d];
                self.stiffness[(i, j)] += part(0) + part(1) + part(2);
                self.mass[(i, j)] += mass * t[i][0] * t[j][0];
            }
        }
    }

    /// The lowest `count` frequencies, rad/s.
    fn frequencies(&self, family: Family, count: usize) -> Result<Vec<f64>, RotorTruthError> {
        let refused = || RotorTruthError::Modes { family: family.name() };
        let lower = self.mass.clone().cholesky().ok_or_else(refused)?.l();
        let half = lower.solve_lower_triangular(&self.stiffness).ok_or_else(refused)?;
        let whole = lower.solve_lower_triangular(&half.transpose()).ok_or_else(refused)?;
        let eigen = (0.5 * (&whole + whole.transpose())).symmetric_eigenvalues();
        let mut squares: Vec<f64> = eigen.iter().copied().collect();
        squares.sort_by(f64::total_cmp);
        let root = |own: &f64| if *own > 0.0 { Ok(own.sqrt()) } else { Err(refused()) };
        squares.iter().take(count).map(root).collect()
    }
}

impl Beam {
    /// Mass of the beam without its lumps, kg.
    pub fn mass_of_beam_kg(&self) -> f64 {
        let pieces = self.mass_kg_m.windows(2);
        self.length_m
            * pieces.map(|own| 0.5 * (own[0].1 + own[1].1) * (own[1].0 - own[0].0)).sum::<f64>()
    }

    fn span(&self) -> Span {
        let along = [&self.mass_kg_m, &self.ei_flap, &self.ei_lag, &self.gj];
        let mut edges: Vec<f64> =
            along.iter().flat_map(|own| own.iter().map(|own| own.0)).collect();
        edges.extend(self.lumps.iter().map(|own| own.station));
        Span::new(&edges, POINTS, SEGMENT)
    }

    /// Tension at the stations of a span, N.
    fn tension_newton(&self, span: &Span, omega_rad_s: f64) -> Vec<f64> {
        let radius = |s: f64| self.root_m + s * self.length_m;
        let pull: Vec<f64> =
            span.x.iter().map(|s| self.length_m * at(&self.mass_kg_m, *s) * radius(*s)).collect();
        let mut out = vec![0.0; span.len()];
        span.to_tip(&pull, &mut out);
        for (own, s) in out.iter_mut().zip(&span.x) {
            let beyond = self.lumps.iter().filter(|lump| lump.station > *s);
            *own += beyond.map(|lump| lump.mass_kg * radius(lump.station)).sum::<f64>();
            *own *= omega_rad_s * omega_rad_s;
        }
        out
    }

    /// The lowest frequencies of a family at a rotor speed, Hz.
    ///
    /// # Errors
    /// [`RotorTruthError::Modes`] of a beam without mass or stiffness.
    pub fn frequencies_hz(
        &self,
        family: Family,
        omega_rad_s: f64,
        count: usize,
    ) -> Result<Vec<f64>, RotorTruthError> {
        let span = self.span();
        let tension = self.tension_newton(&span, omega_rad_s);
        let forms = match family {
            Family::Flap | Family::Lag => self.bending(family, (&span, &tension), omega_rad_s),
            Family::Torsion => self.torsion((&span, &tension), omega_rad_s),
        };
        let found = forms.frequencies(family, count)?;
        Ok(found.iter().map(|own| own / std::f64::consts::TAU).collect())
    }

    fn bending(&self, family: Family, (span, tension): (&Span, &[f64]), omega: f64) -> Forms {
        let is_flap = family == Family::Flap;
        let (ei, spring) = if is_flap {
            (&self.ei_flap, self.root_spring[0])
        } else {
            (&self.ei_lag, self.root_spring[1])
        };
        // the pull of rotation turns away from the axis as the blade moves in the plane
        let turning = if is_flap { 0.0 } else { -omega * omega };
        let l = self.length_m;
        let mut forms = Forms::new(if spring.is_some() { 1 } else { 2 });
        for ((s, weight), tension) in span.x.iter().zip(&span.weight).zip(tension) {
            let (m, w) = (at(&self.mass_kg_m, *s), l * weight);
            let stiffness = [w * turning * m, w * tension / l.powi(2), w * at(ei, *s) / l.powi(4)];
            forms.add(*s, stiffness, w * m);
        }
        for own in &self.lumps {
            forms.add(own.station, [turning * own.mass_kg, 0.0, 0.0], own.mass_kg);
        }
        for (station, stiffness) in self.guys.iter().filter(|_| is_flap) {
            forms.add(*station, [*stiffness, 0.0, 0.0], 0.0);
        }
        if let Some(stiffness) = spring {
            forms.add(0.0, [0.0, stiffness / l.powi(2), 0.0], 0.0);
        }
        forms
    }

    fn torsion(&self, (span, tension): (&Span, &[f64]), omega: f64) -> Forms {
        let [k1, k2, ka] = self.gyration_m.map(|own| own * own);
        let l = self.length_m;
        let spring = self.root_spring[2];
        let mut forms = Forms::new(i32::from(spring.is_none()));
        let turning = omega * omega * (k2 - k1);
        for ((s, weight), tension) in span.x.iter().zip(&span.weight).zip(tension) {
            let (m, w) = (at(&self.mass_kg_m, *s), l * weight);
            let slope = w * (at(&self.gj, *s) + ka * tension) / l.powi(2);
            forms.add(*s, [w * m * turning, slope, 0.0], w * m * (k1 + k2));
        }
        for own in &self.lumps {
            let mass = own.mass_kg * own.gyration * own.gyration;
            forms.add(own.station, [mass * turning, 0.0, 0.0], mass * (k1 + k2));
        }
        if let Some(stiffness) = spring {
            forms.add(0.0, [stiffness, 0.0, 0.0], 0.0);
        }
        forms
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn uniform() -> Beam {
        let one = |value: f64| vec![(0.0, value), (1.0, value)];
        Beam {
            length_m: 2.0,
            root_m: 0.0,
            mass_kg_m: one(3.0),
            ei_flap: one(48.0),
            ei_lag: one(48.0),
            gj: one(5.0),
            gyration_m: [0.01, 0.03, 0.0],
            root_spring: [None; 3],
            lumps: vec![],
            guys: vec![],
        }
    }

    /// `sqrt(EI / (m L^4))` of the uniform beam is 1.
    fn compare(beam: &Beam, family: Family, omega: f64, exact: &[f64], most: f64) {
        let found = beam.frequencies_hz(family, omega, exact.len()).unwrap_or_default();
        assert_eq!(found.len(), exact.len());
        for (own, exact) in found.iter().zip(exact) {
            assert!((own * TAU / exact - 1.0).abs() < most, "{family:?}: {} {exact}", own * TAU);
        }
    }

    /// Wright, Smith, Thresher and Wang (1982), uniform cantilever, root on the axis.
    #[test]
    fn a_uniform_cantilever_has_the_published_frequencies() {
        let beam = uniform();
        compare(&beam, Family::Flap, 0.0, &[3.516_015, 22.034_49, 61.697_21, 120.901_9], 1e-6);
        compare(&beam, Family::Flap, 3.0, &[4.7973, 23.3203, 62.9850], 2e-5);
        compare(&beam, Family::Flap, 6.0, &[7.3604, 26.8091, 66.6840], 2e-5);
        compare(&beam, Family::Flap, 12.0, &[13.1702, 37.6031, 79.6145], 2e-5);
        // in the plane the square is less by that of the speed
        let lag: Vec<f64> =
            [7.3604_f64, 26.8091].iter().map(|own| (own * own - 36.0).sqrt()).collect();
        compare(&beam, Family::Lag, 6.0, &lag, 1e-4);
    }

    /// A stiff blade on a hinge: `flap^2 = O^2 (1 + 1.5 e)` with the hinge at `e` lengths, in the plane without the 1.
    #[test]
    fn a_stiff_blade_on_a_hinge_follows_from_its_offset() {
        let mut beam = uniform();
        beam.root_m = 0.2;
        beam.ei_flap = vec![(0.0, 1e5), (1.0, 1e5)];
        beam.ei_lag = beam.ei_flap.clone();
        beam.root_spring = [Some(1e-3), Some(1e-3), None];
        let omega = 7.0_f64;
        compare(&beam, Family::Flap, omega, &[omega * 1.15_f64.sqrt()], 3e-4);
        compare(&beam, Family::Lag, omega, &[omega * 0.15_f64.sqrt()], 3e-4);
    }

    /// `K L/EI (1 + cos z cosh z) = z (sin z cosh z - cos z sinh z)`, `z^2` the frequency.
    #[test]
    fn a_root_spring_is_exact() {
        for z in [1.2_f64, 1.7] {
            let turning = z * (z.sin() * z.cosh() - z.cos() * z.sinh());
            let spring = 48.0 / 2.0 * turning / (1.0 + z.cos() * z.cosh());
            let beam = Beam { root_spring: [Some(spring), Some(spring), None], ..uniform() };
            compare(&beam, Family::Flap, 0.0, &[z * z], 1e-6);
            compare(&beam, Family::Lag, 0.0, &[z * z], 1e-6);
        }
        // a stiff spring is a clamp
        let stiff = Beam { root_spring: [Some(1e7), None, None], ..uniform() };
        compare(&stiff, Family::Flap, 0.0, &[3.516_015, 22.034_49], 1e-5);
    }

    /// A tip mass as heavy as the beam: the first root of `1 + cos cosh + x (cos sinh - sin cosh)` is 1.247917.
    #[test]
    fn a_tip_mass_lowers_the_first_mode_as_exact_theory_says() {
        let mut beam = uniform();
        beam.lumps.push(Lump { station: 1.0, mass_kg: beam.mass_of_beam_kg(), gyration: 1.0 });
        compare(&beam, Family::Flap, 0.0, &[1.247_917_f64.powi(2)], 1e-5);
        // its pull stiffens the turning beam, and in the plane takes as much away as it adds in mass
        let (flap, lag) = (
            beam.frequencies_hz(Family::Flap, 5.0, 1).unwrap_or_default(),
            beam.frequencies_hz(Family::Lag, 5.0, 1).unwrap_or_default(),
        );
        let gap = (flap[0] * TAU).powi(2) - (lag[0] * TAU).powi(2);
        assert!((gap - 25.0).abs() < 1e-6, "{gap}");
    }

    /// `om^2 = ((n - 1/2) pi)^2 GJ / (m k^2 L^2) + O^2 (k2^2 - k1^2) / k^2`.
    #[test]
    fn torsion_is_exact() {
        let beam = uniform();
        let k = 0.01_f64.powi(2) + 0.03_f64.powi(2);
        let omega = 40.0_f64;
        let exact = |n: f64| {
            let still = ((n - 0.5) * PI).powi(2) * 5.0 / (3.0 * k * 4.0);
            (still + omega * omega * (0.03_f64.powi(2) - 0.01_f64.powi(2)) / k).sqrt()
        };
        compare(&beam, Family::Torsion, omega, &[exact(1.0), exact(2.0)], 1e-8);
        // a spring in series: tan(z) = K L / (GJ z)
        let z = 1.1_f64;
        let spring = 5.0 / 2.0 * z * z.tan();
        let sprung = Beam { root_spring: [None, None, Some(spring)], ..beam };
        let own = z * (5.0 / (3.0 * k * 4.0)).sqrt();
        compare(&sprung, Family::Torsion, 0.0, &[own], 1e-8);
    }

    /// A stiff guy holds its station: a beam clamped at one end and held at the other has 15.418.
    #[test]
    fn a_stiff_guy_holds_its_station() {
        let beam = Beam { guys: vec![(1.0, 1e8)], ..uniform() };
        compare(&beam, Family::Flap, 0.0, &[15.418_2], 1e-4);
    }
}
