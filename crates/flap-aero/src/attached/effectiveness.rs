//! How much of thin-aerofoil theory's flap a real flap is.

use crate::error::check;
use crate::{AeroError, LagChannel, Load, Mode, SectionCoefficients};

/// Factors on the loads a flap makes: 1 is theory's. The boundary layer takes part of the lift of a
/// real flap (0.78 was measured where the moment was 1.00); it does not delay it.
///
/// | field | acts on | range |
/// |---|---|---|
/// | `lift` | `Cn` of flap angle and rate | 0 to 2 |
/// | `moment` | `Cm` of the same | 0 to 2 |
/// | `hinge` | `Ch` of the same | 0 to 2 |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlapEffectiveness {
    lift: f64,
    moment: f64,
    hinge: f64,
}

impl Default for FlapEffectiveness {
    fn default() -> Self {
        Self::IDEAL
    }
}

impl FlapEffectiveness {
    /// Theory's flap.
    pub const IDEAL: Self = Self { lift: 1.0, moment: 1.0, hinge: 1.0 };

    /// Factors on lift, moment and hinge moment.
    ///
    /// # Errors
    /// [`AeroError::BadInput`] unless each is 0 to 2.
    pub fn new(lift: f64, moment: f64, hinge: f64) -> Result<Self, AeroError> {
        let factors = [
            ("flap effectiveness in lift", lift),
            ("flap effectiveness in moment", moment),
            ("flap effectiveness in hinge moment", hinge),
        ];
        check(&factors, "0 to 2, 1 is theory", |factor| (0.0..=2.0).contains(&factor))?;
        Ok(Self { lift, moment, hinge })
    }

    /// The factor on a load.
    pub fn of(&self, load: Load) -> f64 {
        match load {
            Load::Lift => self.lift,
            Load::Moment => self.moment,
            Load::Hinge => self.hinge,
        }
    }
}

/// Whether an input is the flap's.
const fn is_flap(mode: usize) -> bool {
    mode >= Mode::Flap.index()
}

impl SectionCoefficients {
    /// The section with a flap of this effectiveness; unchanged for [`FlapEffectiveness::IDEAL`].
    ///
    /// A lag that rigid and flap inputs share is parted in two of the same pole if the factors on its
    /// loads differ: the number of lags may grow, and does not depend on the Mach number.
    #[must_use]
    pub fn with_flap_effectiveness(mut self, effectiveness: &FlapEffectiveness) -> Self {
        if *effectiveness == FlapEffectiveness::IDEAL {
            return self;
        }
        let factors = Load::ALL.map(|load| effectiveness.of(load));
        for (o, factor) in factors.iter().enumerate() {
            for j in (0..4).filter(|j| is_flap(*j)) {
                self.direct[o][j] *= factor;
                self.rate[o][j] *= factor;
            }
        }
        self.lags = self.lags.iter().flat_map(|lag| parted(lag, &factors)).collect();
        self
    }

    /// The same section with every lag that rigid and flap inputs share parted in two of the same pole:
    /// the loads of the rigid section and those of its flap can then be told apart.
    ///
    /// The number of lags may grow, and does not depend on the Mach number.
    #[must_use]
    pub fn with_flap_apart(mut self) -> Self {
        self.lags = self.lags.iter().flat_map(|lag| parted(lag, &[1.0; 3])).collect();
        self
    }
}

/// A lag with the flap's share of its loads weighed: one lag, or two.
fn parted(lag: &LagChannel, factors: &[f64; 3]) -> Vec<LagChannel> {
    let share = |flap: bool| {
        let mut part = *lag;
        for (j, weight) in part.input.iter_mut().enumerate() {
            if is_flap(j) != flap {
                *weight = 0.0;
            }
        }
        part
    };
    let [rigid, mut flapped] = [share(false), share(true)];
    let none = |part: &LagChannel| part.input.iter().all(|weight| *weight == 0.0);
    if none(&flapped) {
        return vec![*lag];
    }
    for (weight, factor) in flapped.output.iter_mut().zip(factors) {
        *weight *= factor;
    }
    if none(&rigid) { vec![flapped] } else { vec![rigid, flapped] }
}
