//! Numbers side by side, for equations that are written once and evaluated at one place or at several.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Numbers in [`Lanes`].
pub const LANES: usize = 8;

/// Angle up to which [`Lanes`] take sine and cosine side by side, rad.
const LARGEST_ANGLE: f64 = 1e4;
/// `pi/2` less its value in double precision.
///
/// Source: J.-M. Muller, Elementary Functions (2016), chapter 11, on the reduction of the argument in parts.
const PI_HALVES_REST: f64 = 6.123_233_995_736_766e-17;

/// What an equation is written for: one number, or several side by side.
///
/// Arithmetic on [`Lanes`] gives in every lane what the same operations give on `f64`, but for [`sin_cos`](Self::sin_cos), which
/// agrees to within rounding.
pub trait Number:
    Copy
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// The same value everywhere.
    fn of(value: f64) -> Self;
    /// What stands in a row: the `k`th number, or the `k`th block of [`LANES`].
    ///
    /// # Panics
    /// If the row ends before.
    fn read(row: &[f64], k: usize) -> Self;
    /// A function of every number.
    #[must_use]
    fn map(self, f: impl FnMut(f64) -> f64) -> Self;
    /// Sine and cosine of an angle in rad.
    fn sin_cos(self) -> (Self, Self);
    /// Magnitude.
    #[inline(always)]
    #[must_use]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }
    /// Square root.
    #[inline(always)]
    #[must_use]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    /// The larger of itself and a value.
    #[inline(always)]
    #[must_use]
    fn at_least(self, value: f64) -> Self {
        self.map(|x| x.max(value))
    }
}

impl Number for f64 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn read(row: &[f64], k: usize) -> Self {
        row[k]
    }

    #[inline(always)]
    fn map(self, mut f: impl FnMut(f64) -> f64) -> Self {
        f(self)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        self.sin_cos()
    }
}

/// [`LANES`] numbers side by side.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// What `value` says of every lane.
    #[inline(always)]
    pub fn from_fn(value: impl FnMut(usize) -> f64) -> Self {
        Self(std::array::from_fn(value))
    }

    /// Writes them into a row as its `k`th block.
    ///
    /// # Panics
    /// If the row ends before.
    #[inline(always)]
    pub fn write(self, row: &mut [f64], k: usize) {
        row[k * LANES..(k + 1) * LANES].copy_from_slice(&self.0);
    }
}

impl Number for Lanes {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn read(row: &[f64], k: usize) -> Self {
        let mut out = Self::default();
        out.0.copy_from_slice(&row[k * LANES..(k + 1) * LANES]);
        out
    }

    #[inline(always)]
    fn map(mut self, mut f: impl FnMut(f64) -> f64) -> Self {
        for value in &mut self.0 {
            *value = f(*value);
        }
        self
    }

    /// The Taylor series about the nearest multiple of `pi/2`, within 2e-16 of sine and cosine.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        if !self.0.iter().all(|angle| angle.abs() <= LARGEST_ANGLE) {
            return (self.map(f64::sin), self.map(f64::cos));
        }
        let turns = (self * FRAC_2_PI).map(f64::round_ties_even);
        let y = self - turns * FRAC_PI_2 - turns * PI_HALVES_REST;
        let square = y * y;
        // 1 - y^2/((n+1)(n+2)) (1 - y^2/((n+3)(n+4)) (...)), up to y^16
        let (mut of_sin, mut of_cos) = (Self::of(1.0), Self::of(1.0));
        for k in (0..8_u32).rev() {
            let over = |n: u32| 1.0 / f64::from((n + 1) * (n + 2));
            of_sin = -(square * over(2 * k + 1)) * of_sin + 1.0;
            of_cos = -(square * over(2 * k)) * of_cos + 1.0;
        }
        let (sin, cos) = (y * of_sin, of_cos);
        // by quarter turns: (s, c), (c, -s), (-s, -c), (-c, s)
        let quarter = turns - (turns * 0.25).map(f64::floor) * 4.0;
        let (mut out_sin, mut out_cos) = (Self::default(), Self::default());
        for k in 0..LANES {
            let (s, c, q) = (sin.0[k], cos.0[k], quarter.0[k]);
            let turned = (0.5..1.5).contains(&q) || q > 2.5;
            let (even, odd) = if turned { (c, s) } else { (s, c) };
            out_sin.0[k] = if q > 1.5 { -even } else { even };
            out_cos.0[k] = if (0.5..2.5).contains(&q) { -odd } else { odd };
        }
        (out_sin, out_cos)
    }
}

/// An operation on the numbers of two blocks, and its form that assigns.
macro_rules! lane_by_lane {
    ($($op:ident $method:ident)*) => {$(
        impl $op for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for (a, b) in self.0.iter_mut().zip(other.0) {
                    *a = $op::$method(*a, b);
                }
                self
            }
        }

        impl $op<f64> for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(mut self, other: f64) -> Self {
                for a in &mut self.0 {
                    *a = $op::$method(*a, other);
                }
                self
            }
        }
    )*};
}

lane_by_lane!(Add add Sub sub Mul mul Div div);

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial<T: Number>(x: T) -> T {
        let mut sum = -(x * x) * 0.5 + 1.0;
        sum += x / (x.abs() + 2.0).sqrt();
        sum -= T::of(0.1) * x.at_least(-1.0);
        sum
    }

    #[test]
    fn an_equation_gives_in_every_lane_what_it_gives_alone() {
        let row: Vec<f64> = (0..3 * LANES).map(|k| 0.37 * k as f64 - 4.0).collect();
        for block in 0..3 {
            let found = polynomial(Lanes::read(&row, block));
            let mut written = row.clone();
            found.write(&mut written, block);
            for lane in 0..LANES {
                let alone = polynomial(f64::read(&row, block * LANES + lane));
                assert_eq!(found.0[lane].to_bits(), alone.to_bits());
                assert_eq!(written[block * LANES + lane].to_bits(), alone.to_bits());
            }
        }
    }

    /// On all quarters, at their borders, for large angles and for what is no number.
    #[test]
    fn sine_and_cosine_are_those_of_the_library() {
        let small = (-4000..4000).map(|k| f64::from(k) * 2.3e-3);
        let borders = (-12..12).flat_map(|k| {
            let at = f64::from(k) * FRAC_PI_2 / 2.0;
            [at, at + 1e-9, at - 1e-9]
        });
        let large = [9_999.0, -9_998.3, 1e5, -3e18, 1e300, f64::MIN_POSITIVE, 0.0, -0.0];
        let angles: Vec<f64> = small.chain(borders).chain(large).collect();
        for block in angles.chunks(LANES) {
            let (sin, cos) = Lanes::from_fn(|k| block[k % block.len()]).sin_cos();
            for (k, angle) in block.iter().enumerate() {
                let (s, c) = angle.sin_cos();
                assert!((sin.0[k] - s).abs() < 2.5e-16, "sin {angle}: {} {s}", sin.0[k]);
                assert!((cos.0[k] - c).abs() < 2.5e-16, "cos {angle}: {} {c}", cos.0[k]);
            }
        }
        let (sin, cos) = Lanes::of(f64::NAN).sin_cos();
        assert!(sin.0.iter().chain(&cos.0).all(|x| x.is_nan()));
    }
}
