//! A station at which the loads of the blade are asked for, and what the mode shapes are there.

use crate::{ResponseBlade, ResponseError, SpanGrid};
use rotor_base::{LagrangeBasis, gauss_legendre};
use rotor_fem::{BladeProperties, ModeKind, ModeSet, SectionShape};

/// Elements through whose points the curvature of a mode is drawn.
const CURVATURE_ELEMENTS: usize = 3;

/// A station of the blade: mode shapes, stiffness, and the part of the blade outboard of it.
#[derive(Debug, Clone)]
pub(crate) struct LoadStation {
    /// Station, R.
    pub(crate) x: f64,
    /// Weights of integrals over the blade outboard and inboard of it, R.
    pub(crate) outboard: Vec<f64>,
    pub(crate) inboard: Vec<f64>,
    /// Value, slope and curvature of every flap and lag mode; value and rate of every torsion mode.
    flap: Vec<[f64; 3]>,
    lag: Vec<[f64; 3]>,
    torsion: Vec<[f64; 2]>,
    /// Bending stiffnesses `[EI_y, EI_z]`, torsion stiffness `GJ + k_A^2 T`, built-in twist in rad.
    pub(crate) stiffness: [f64; 2],
    pub(crate) torsion_stiffness: f64,
    pub(crate) twist: f64,
}

impl LoadStation {
    /// The station `x` of a blade of so many equal elements.
    ///
    /// The curvature of a cubic element is best at its two Gauss points, of fourth order there and of second
    /// at its ends: it is that of the polynomial through the points of the nearest elements. So is the
    /// rate of twist.
    ///
    /// Source: J. Barlow, Int. J. Numer. Methods Eng. 10 (1976) 243.
    pub(crate) fn new(
        x: f64,
        elements: usize,
        properties: &BladeProperties,
        modes: &ModeSet,
        grid: &SpanGrid,
    ) -> Result<Self, ResponseError> {
        let root = properties.spec().root_offset;
        let length = (1.0 - root) / elements as f64;
        let used = elements.min(CURVATURE_ELEMENTS);
        // the element with the station in the middle of those used, where there is one on either side
        let before = |e: &usize| root + length * (*e as f64 + 2.0) <= x;
        let first = (0..elements - used).take_while(before).count();
        let points: Vec<f64> = (first..first + used)
            .flat_map(|e| gauss_legendre(2).nodes.into_iter().map(move |s| (e, s)))
            .map(|(e, s)| root + length * (e as f64 + 0.5 * (1.0 + s)))
            .collect();
        let weights = LagrangeBasis::new(points.clone()).evaluate(x);
        let shapes = |kind: ModeKind, smooth: usize| -> Result<Vec<[f64; 3]>, ResponseError> {
            modes
                .of(kind)
                .iter()
                .map(|mode| {
                    let mut shape = mode.shape(x)?;
                    shape[smooth] =
                        points.iter().zip(&weights).try_fold(0.0, |sum, (x, [weight, ..])| {
                            Ok::<f64, ResponseError>(sum + weight * mode.shape(*x)?[smooth])
                        })?;
                    Ok(shape)
                })
                .collect()
        };
        let torsion = shapes(ModeKind::Torsion, 1)?;
        let outboard = grid.weights_outboard(x);
        Ok(Self {
            x,
            inboard: grid.weight().iter().zip(&outboard).map(|(all, out)| all - out).collect(),
            outboard,
            flap: shapes(ModeKind::Flap, 2)?,
            lag: shapes(ModeKind::Lag, 2)?,
            torsion: torsion.into_iter().map(|[value, rate, _]| [value, rate]).collect(),
            stiffness: [properties.flap_stiffness(x), properties.lag_stiffness(x)],
            torsion_stiffness: properties.torsion_stiffness(x)
                + properties.squared_area_radius(x) * properties.tension(x),
            twist: properties.twist_rad(x),
        })
    }

    /// Displacement, slope and curvature of the blade there.
    pub(crate) fn shape(&self, blade: &ResponseBlade, q: &[f64]) -> SectionShape {
        fn sum<const N: usize>(shapes: &[[f64; N]], q: &[f64]) -> [f64; N] {
            std::array::from_fn(|k| shapes.iter().zip(q).map(|(s, q)| s[k] * q).sum())
        }
        let (flap, rest) = q.split_at(blade.flap.count());
        let (lag, torsion) = rest.split_at(blade.lag.count());
        SectionShape {
            lag: sum(&self.lag, lag),
            flap: sum(&self.flap, flap),
            twist: sum(&self.torsion, torsion),
        }
    }
}
