//! Coupled rotating modes and their classification.

use nalgebra::{Complex, DMatrix, DVector};

use crate::beam::assembly::{dof_kind, restrict};
use crate::beam::shape::JOINT_DOF;
use crate::modes::eigen::{EigenPair, gyroscopic, symmetric};
use crate::modes::mode_set::{kind_offset, shift};
use crate::{BladeModel, FemError, ModeCount, ModeKind, PerFamily};

/// Squared frequencies below this fraction of the eigenvalue shift are raised by it, so that a neutral
/// motion (a lag hinge on the axis of rotation) does not make the stiffness singular.
const NEUTRAL: f64 = 1e-10;

/// Whether the Coriolis coupling of lag and axial (with precone, flap) motion is part of the modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GyroscopicTerms {
    /// Coriolis terms act: shapes have a part in quadrature.
    #[default]
    Included,
    /// Coriolis terms are left out: real modes.
    Neglected,
}

/// How the kinetic energy of a mode is divided among the families; the shares sum to 1.
pub type EnergyShares = PerFamily<f64>;

impl EnergyShares {
    /// The family with the largest share.
    pub fn leader(&self) -> ModeKind {
        let larger = |a, b| if self.of(b) > self.of(a) { b } else { a };
        ModeKind::ALL.into_iter().fold(ModeKind::Flap, larger)
    }
}

/// One mode of the rotating blade.
///
/// ```text
/// q(t) = in_phase cos(w t) - quadrature sin(w t)
/// ```
/// Both parts are over all 9 n + 6 degrees of freedom of the [`BladeModel`] and have unit mass together;
/// the tip moves in the positive direction of the mode's family. Without gyroscopic terms `quadrature`
/// is zero.
#[derive(Debug, Clone, PartialEq)]
pub struct CoupledMode {
    /// Family with most of the kinetic energy.
    pub kind: ModeKind,
    /// Place within its family, from 1.
    pub number: usize,
    /// Frequency in units of the nominal rotor speed.
    pub frequency: f64,
    /// Frequency per revolution of the blade's own rotor speed; infinite at rest.
    pub per_rev: f64,
    /// Division of the kinetic energy.
    pub energy: EnergyShares,
    /// Part of the shape that is extreme at time zero.
    pub in_phase: DVector<f64>,
    /// Part of the shape a quarter of a cycle ahead.
    pub quadrature: DVector<f64>,
}

/// Modes of the rotating blade: those wanted of each family, in the order flap, lag, torsion, axial,
/// each lowest frequency first.
///
/// # Errors
/// [`FemError::NotStable`] when the rotating stiffness has a negative direction,
/// [`FemError::TooFewModes`], [`FemError::Eigen`].
pub fn modes(
    model: &BladeModel,
    terms: GyroscopicTerms,
    count: ModeCount,
) -> Result<Vec<CoupledMode>, FemError> {
    let free = model.free();
    let problem = ModeProblem {
        size: model.mass().nrows(),
        mass: restrict(model.mass(), free),
        stiffness: restrict(model.stiffness(), free),
        gyroscopic: restrict(model.gyroscopic(), free),
        free: free.to_vec(),
        shift: shift(model.properties()),
        rotor_speed: model.properties().spec().rotor_speed,
    };
    problem.solve(terms, count)
}

/// Matrices over the free degrees of freedom whose modes are wanted.
pub(crate) struct ModeProblem {
    /// Number of all degrees of freedom.
    pub(crate) size: usize,
    /// The free ones, ascending.
    pub(crate) free: Vec<usize>,
    pub(crate) mass: DMatrix<f64>,
    pub(crate) stiffness: DMatrix<f64>,
    pub(crate) gyroscopic: DMatrix<f64>,
    /// See [`shift`].
    pub(crate) shift: f64,
    pub(crate) rotor_speed: f64,
}

impl ModeProblem {
    pub(crate) fn solve(
        &self,
        terms: GyroscopicTerms,
        count: ModeCount,
    ) -> Result<Vec<CoupledMode>, FemError> {
        let Self { free, mass, stiffness, .. } = self;
        let real = symmetric(mass, stiffness, self.shift)?;
        let at_rest = self.gyroscopic.iter().all(|g| *g == 0.0);
        let pairs: Vec<EigenPair<Complex<f64>>> = match terms {
            _ if at_rest => real.iter().map(to_complex).collect(),
            GyroscopicTerms::Neglected => real.iter().map(to_complex).collect(),
            GyroscopicTerms::Included => {
                let lowest = real.first().map_or(0.0, |pair| pair.squared_frequency);
                let floor = NEUTRAL * self.shift;
                let firm =
                    if lowest < floor { stiffness + mass * floor } else { stiffness.clone() };
                gyroscopic(mass, &self.gyroscopic, &firm, lowest)?
            }
        };
        let classified: Vec<(EnergyShares, EigenPair<Complex<f64>>)> =
            pairs.into_iter().map(|pair| (shares(free, mass, &pair.vector), pair)).collect();

        let mut chosen = Vec::new();
        for kind in ModeKind::ALL {
            let family: Vec<_> =
                classified.iter().filter(|(energy, _)| energy.leader() == kind).collect();
            if family.len() < count.of(kind) {
                let (wanted, available) = (count.of(kind), family.len());
                return Err(FemError::TooFewModes { kind, wanted, available });
            }
            for (index, (energy, pair)) in family.into_iter().take(count.of(kind)).enumerate() {
                chosen.push(self.mode(kind, index + 1, *energy, pair));
            }
        }
        Ok(chosen)
    }

    /// A mode over all degrees of freedom, the tip of its family moving in the positive direction.
    fn mode(
        &self,
        kind: ModeKind,
        number: usize,
        energy: EnergyShares,
        pair: &EigenPair<Complex<f64>>,
    ) -> CoupledMode {
        let mut all: DVector<Complex<f64>> = DVector::zeros(self.size);
        for (value, place) in pair.vector.iter().zip(&self.free) {
            all[*place] = *value;
        }
        let tip = all[self.size - JOINT_DOF + kind_offset(kind)].re;
        let sign = if tip < 0.0 { -1.0 } else { 1.0 };
        let frequency = pair.squared_frequency.sqrt();
        CoupledMode {
            kind,
            number,
            frequency,
            per_rev: frequency / self.rotor_speed,
            energy,
            in_phase: all.map(|z| sign * z.re),
            quadrature: all.map(|z| sign * z.im),
        }
    }
}

fn to_complex(pair: &EigenPair<f64>) -> EigenPair<Complex<f64>> {
    EigenPair { squared_frequency: pair.squared_frequency, vector: pair.vector.map(Complex::from) }
}

/// Kinetic energy of each family over their sum; what couples families belongs to none.
fn shares(free: &[usize], mass: &DMatrix<f64>, vector: &DVector<Complex<f64>>) -> EnergyShares {
    let energy = |kind: ModeKind| -> f64 {
        let only = |part: fn(&Complex<f64>) -> f64| {
            DVector::from_fn(free.len(), |i, _| {
                if dof_kind(free[i]) == kind { part(&vector[i]) } else { 0.0 }
            })
        };
        let (re, im) = (only(|z| z.re), only(|z| z.im));
        re.dot(&(mass * &re)) + im.dot(&(mass * &im))
    };
    let parts = ModeKind::ALL.map(energy);
    let whole: f64 = parts.iter().sum();
    let [flap, lag, torsion, axial] = parts.map(|part| part / whole);
    EnergyShares { flap, lag, torsion, axial }
}
