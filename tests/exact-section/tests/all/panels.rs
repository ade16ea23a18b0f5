//! Panels against a section that has a closed form, and NACA 23012 by them.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "the measured differences are worth seeing")]

use exact_section::{Outline, linear_section, thin_mean_line_230};
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

/// A section of Karman and Trefftz: a circle through 1 that a map with a finite trailing edge turns into it.
struct KarmanTrefftz {
    centre: Complex64,
    /// Two less the angle of the trailing edge over pi.
    power: f64,
}

impl KarmanTrefftz {
    fn radius(&self) -> f64 {
        (Complex64::ONE - self.centre).norm()
    }

    /// Place and slope of the map.
    fn mapped(&self, zeta: Complex64) -> [Complex64; 2] {
        let n = self.power;
        let (a, b) = ((1.0 + 1.0 / zeta).powf(n), (1.0 - 1.0 / zeta).powf(n));
        let place = n * (a + b) / (a - b);
        let slope = 4.0 * n * n / (zeta * zeta - 1.0) * a * b / ((a - b) * (a - b));
        [place, slope]
    }

    /// Nose, chord, and the outline of chord 1 with that many panels, closer where the edge is sharp.
    fn outline(&self, panels: usize) -> (f64, f64, Outline) {
        let start = (Complex64::ONE - self.centre).arg();
        let at = |k: usize| {
            let t = k as f64 / panels as f64;
            // clockwise, from the trailing edge below
            let angle = start - TAU * (t - (TAU * t).sin() / TAU);
            if k == 0 || k == panels {
                return self.mapped_edge();
            }
            self.mapped(self.centre + Complex64::from_polar(self.radius(), angle))[0]
        };
        let points: Vec<Complex64> = (0..=panels).map(at).collect();
        let fine = (1..20_000).map(|k| {
            let angle = start - TAU * f64::from(k) / 20_000.0;
            self.mapped(self.centre + Complex64::from_polar(self.radius(), angle))[0].re
        });
        let nose = fine.fold(f64::INFINITY, f64::min);
        let chord = self.power - nose;
        let scaled = points.iter().map(|z| (z - nose) / chord).collect();
        (nose, chord, Outline::new(scaled))
    }

    fn mapped_edge(&self) -> Complex64 {
        Complex64::new(self.power, 0.0)
    }

    /// Lift and moment about the quarter chord, by Kutta and Joukowski and by Blasius on a circle far off.
    fn exact(&self, incidence: f64, nose: f64, chord: f64) -> [f64; 2] {
        let radius = self.radius();
        let beta = (self.centre.im / radius).asin();
        let circulation = 4.0 * PI * radius * (incidence + beta).sin();
        let turn = Complex64::from_polar(1.0, incidence);
        let quarter = Complex64::new(nose + 0.25 * chord, 0.0);
        let count = 400;
        let moment: f64 = (0..count)
            .map(|k| {
                let out = Complex64::from_polar(3.0, TAU * f64::from(k) / f64::from(count));
                let from = out - self.centre;
                // circulation is clockwise with lift up
                let velocity = turn.conj() - turn * (radius * radius) / (from * from)
                    + Complex64::i() * circulation / (TAU * from);
                let [place, slope] = self.mapped(out);
                let step = Complex64::i() * out * (TAU / f64::from(count));
                (velocity * velocity / slope * (place - quarter) * step).re
            })
            .sum();
        [2.0 * circulation / chord, moment / (chord * chord)]
    }
}

/// The panels come to the closed form, the faster the more of them there are.
#[test]
fn panels_meet_a_section_with_a_closed_form() {
    let section = KarmanTrefftz { centre: Complex64::new(-0.08, 0.06), power: 2.0 - 14.0 / 180.0 };
    let incidence = 0.07;
    let found: Vec<[[f64; 2]; 2]> = [50, 100, 200, 400]
        .iter()
        .map(|&panels| {
            let (nose, chord, outline) = section.outline(panels);
            [outline.loads(incidence).unwrap(), section.exact(incidence, nose, chord)]
        })
        .collect();
    println!("{found:?}");
    for k in [0, 1] {
        let off: Vec<f64> = found.iter().map(|[found, exact]| found[k] - exact[k]).collect();
        let order = (off[1] / off[3]).log2() / 2.0;
        assert!((0.9..1.3).contains(&order), "{order} {off:?}");
        // so that two of them tell the rest
        let left = (2.0 * off[3] - off[2]).abs();
        assert!(left < [5e-4, 1e-4][k], "{left} {off:?}");
    }
}

/// The zero lift of the section of HART II, beside thin-aerofoil theory of its mean line.
#[test]
fn naca_23012_is_near_its_mean_line() {
    let of = |panels| linear_section(&Outline::naca_23012(panels)).unwrap();
    let [coarse, fine] = [of(100), of(200)];
    // errors fall with the number of panels
    let [slope, zero, moment] = std::array::from_fn(|k| 2.0 * fine[k] - coarse[k]);
    let [thin_zero, thin_moment] = thin_mean_line_230(20_000);
    println!(
        "slope {slope:.4}, zero lift {:.4} deg, moment {moment:.5}; mean line {:.4} deg, {thin_moment:.5}",
        zero.to_degrees(),
        thin_zero.to_degrees()
    );
    assert!((thin_zero.to_degrees() + 1.08).abs() < 0.02, "{}", thin_zero.to_degrees());
    assert!((thin_moment + 0.0127).abs() < 3e-4, "{thin_moment}");
    // thickness adds to the slope of the lift by some three quarters of itself
    assert!((slope / TAU - 1.0 - 0.77 * 0.12).abs() < 0.02, "{slope}");
    // as the page on measured rotors has them
    assert!((zero.to_degrees() + 1.171).abs() < 2e-3, "{}", zero.to_degrees());
    assert!((moment + 0.00857).abs() < 3e-5, "{moment}");
}
