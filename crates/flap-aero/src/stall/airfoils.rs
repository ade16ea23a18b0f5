//! Whose constants of dynamic stall: published, or fitted to measured loops.

use super::StallParameters;
use crate::Mach;

/// The aerofoil whose constants a stall has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum StallAirfoil {
    /// NACA 0012 with the constants of Leishman and Beddoes, Mach 0.3 to 0.8.
    Naca0012,
    /// NACA 0012 with constants fitted to loops measured at Mach 0.035 to 0.3.
    Naca0012Measured,
    /// AMES-01, fitted at Mach 0.18 to 0.3.
    Ames01,
    /// NACA 23012A, the section of the Bo 105, fitted at Mach 0.12.
    Naca23012a,
}

/// Constants as they are fitted to measured loops: `alpha1` and `Cn1` by Mach number, the others the same at all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedStall<'a> {
    /// Mach numbers between which `alpha1` and `Cn1` run straight; ascending, one at least.
    pub machs: &'a [f64],
    /// `alpha1` at each, deg.
    pub alpha1_deg: &'a [f64],
    /// `Cn1` at each.
    pub cn1: &'a [f64],
    /// `S1` and `S2` in deg, `k0`, `k1`, `k2`, `eta`, `Df`, then in semichords `Tp`, `Tf`, `Tf` attaching, `Tv`, `Tvl`, then
    /// strength and arm of the vortex.
    pub same: [f64; 14],
    /// Incidence of zero lift, deg.
    pub zero_lift_deg: f64,
    /// Moment about the quarter chord there, nose up, over `q c^2`.
    pub zero_lift_moment: f64,
}

/// Mach number up to which there are measured loops, about.
const MEASURED_TO: f64 = 0.3;

/// Value at `x` of a table over ascending places, the end values beyond.
fn between(places: &[f64], values: &[f64], x: f64) -> f64 {
    let after = places.partition_point(|place| *place <= x);
    match (after.checked_sub(1), places.get(after)) {
        (None, _) => values[0],
        (Some(before), None) => values[before],
        (Some(before), Some(next)) => {
            let share = (x - places[before]) / (next - places[before]);
            values[before] + share * (values[after] - values[before])
        }
    }
}

impl FittedStall<'_> {
    /// The constants at a Mach number, those of the ends beyond.
    pub fn at(&self, mach: f64) -> StallParameters {
        let [s1, s2, k0, k1, k2, eta, df, tp, tf, back, tv, tvl, strength, arm] = self.same;
        StallParameters {
            alpha1_rad: between(self.machs, self.alpha1_deg, mach).to_radians(),
            s1_rad: s1.to_radians(),
            s2_rad: s2.to_radians(),
            k0,
            k1,
            k2,
            eta,
            df,
            cn1: between(self.machs, self.cn1, mach),
            tp,
            tf,
            tf_attaching: back,
            vortex_strength: strength,
            vortex_arm: arm,
            tv,
            tvl,
        }
    }
}

const NACA_0012: FittedStall<'static> = FittedStall {
    machs: &[0.036, 0.11, 0.185, 0.3],
    alpha1_deg: &[11.73, 17.92, 15.59, 13.15],
    cn1: &[1.434, 2.159, 1.814, 1.472],
    same: [
        1.8809, 1.9066, 0.0050, -0.1182, 0.0472, 0.9400, 3.2532, 2.1629, 2.1454, 6.3009, 7.3804,
        7.3434, 1.2676, 0.1251,
    ],
    zero_lift_deg: 0.0,
    zero_lift_moment: 0.0,
};

const AMES_01: FittedStall<'static> = FittedStall {
    machs: &[0.185, 0.3],
    alpha1_deg: &[16.24, 14.28],
    cn1: &[1.850, 1.700],
    same: [
        0.8190, 2.5913, -0.0059, -0.1079, 0.0269, 0.8692, 4.9657, 3.6686, 2.2492, 2.2165, 3.5764,
        4.1686, 1.8854, 0.1714,
    ],
    zero_lift_deg: 0.0,
    zero_lift_moment: 0.0,
};

const NACA_23012A: FittedStall<'static> = FittedStall {
    machs: &[0.117],
    alpha1_deg: &[12.69],
    cn1: &[1.366],
    same: [
        1.8555, 2.0576, -0.0344, -0.1175, 0.0444, 0.9838, 3.6051, 4.2675, 6.6247, 1.7940, 3.3010,
        8.1365, 2.6872, 0.2968,
    ],
    zero_lift_deg: 1.312,
    zero_lift_moment: 0.0629,
};

impl StallAirfoil {
    fn fitted(self) -> Option<&'static FittedStall<'static>> {
        match self {
            Self::Naca0012 => None,
            Self::Naca0012Measured => Some(&NACA_0012),
            Self::Ames01 => Some(&AMES_01),
            Self::Naca23012a => Some(&NACA_23012A),
        }
    }

    /// The constants at a Mach number.
    ///
    /// Beyond Mach 0.3, where no loops were fitted, angles, `Cn1` and lags change as those of
    /// [`StallParameters::naca_0012`] do, in proportion, and moment arms, `eta` and `Df` by the same differences.
    ///
    /// Source: loops of `McAlister`, Pucci, `McCroskey` and Carr, NASA TM-84245 (1982), and of Green and Giuni, University of
    /// Glasgow (2017). What the fit is worth stands in `docs/src/dynamic-stall.md`.
    pub fn parameters(self, mach: Mach) -> StallParameters {
        let published = StallParameters::naca_0012;
        let Some(fitted) = self.fitted() else { return published(mach) };
        let mut p = fitted.at(mach.value().min(MEASURED_TO));
        if let (true, Ok(last)) = (mach.value() > MEASURED_TO, Mach::new(MEASURED_TO)) {
            let (to, from) = (published(mach), published(last));
            let ratios: [fn(&mut StallParameters) -> &mut f64; 9] = [
                |p| &mut p.alpha1_rad,
                |p| &mut p.s1_rad,
                |p| &mut p.s2_rad,
                |p| &mut p.cn1,
                |p| &mut p.tp,
                |p| &mut p.tf,
                |p| &mut p.tf_attaching,
                |p| &mut p.tv,
                |p| &mut p.tvl,
            ];
            let differences: [fn(&mut StallParameters) -> &mut f64; 5] =
                [|p| &mut p.k0, |p| &mut p.k1, |p| &mut p.k2, |p| &mut p.eta, |p| &mut p.df];
            let (mut to, mut from) = (to, from);
            for of in ratios {
                *of(&mut p) *= *of(&mut to) / *of(&mut from);
            }
            for of in differences {
                *of(&mut p) += *of(&mut to) - *of(&mut from);
            }
        }
        p
    }

    /// Mach numbers that the constants were published or fitted for. Below, those of the first are held; beyond, the last of
    /// published ones are held, and fitted ones follow the published trend.
    pub fn known_machs(self) -> [f64; 2] {
        self.fitted().map_or([0.3, 0.8], |fitted| {
            let machs = fitted.machs;
            [machs[0], machs[machs.len() - 1]]
        })
    }

    /// Incidence of zero lift, rad; of the fitted aerofoils as fitted.
    pub fn zero_lift_rad(self) -> f64 {
        self.fitted().map_or(0.0, |fitted| fitted.zero_lift_deg.to_radians())
    }

    /// Moment about the quarter chord at zero lift, nose up, over `q c^2`.
    pub fn zero_lift_moment(self) -> f64 {
        self.fitted().map_or(0.0, |fitted| fitted.zero_lift_moment)
    }
}
