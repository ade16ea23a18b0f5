//! Uncoupled flap, lag and torsion modes: the modal basis of the response.

use serde::{Deserialize, Serialize};
use std::sync::Arc;

use nalgebra::DVector;

use crate::beam::assembly::{BladeModel, locate, restrict};
use crate::beam::shape::{JOINT_DOF, STRIDE, hermite, quadratic};
use crate::modes::eigen::{EigenPair, symmetric};
use crate::{BladeProperties, FemError, ModeKind, PerFamily};

/// How many modes of each family are wanted.
pub type ModeCount = PerFamily<usize>;

impl Default for ModeCount {
    /// Four flap, four lag and two torsion modes, as in the paper.
    fn default() -> Self {
        Self { flap: 4, lag: 4, torsion: 2, axial: 0 }
    }
}

/// Which shapes stand for a family.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ModalBasis {
    /// The lowest natural modes.
    #[default]
    Natural,
    /// The same but the last, in whose place is the static completion: what all modes left out answer to the
    /// load of a rigid acceleration, held still.
    ///
    /// ```text
    /// s = K^-1 f - sum over kept modes phi (phi.f) / w^2 = sum over modes left out phi (phi.f) / w^2,   f = M 1
    /// ```
    /// A natural mode carries no load at the root but that of its own inertia, so that curvature and rate of
    /// twist of a blade that is loaded up to the root converge with 1/N. The completion carries the rest at
    /// once. It is orthogonal to the kept modes in mass and stiffness, and counts as the last mode of its
    /// family. A family of one mode keeps it.
    ///
    /// Source: the residual flexibility of R. H. `MacNeal`, Comput. Struct. 1 (1971) 581; the load is our
    /// choice.
    Completed,
}

/// One uncoupled mode, its shape scaled to 1 at the tip.
#[derive(Debug, Clone, PartialEq)]
pub struct UncoupledMode {
    /// Family of the mode.
    pub kind: ModeKind,
    /// Place within its family, from 1.
    pub number: usize,
    /// Frequency in units of the nominal rotor speed.
    pub frequency: f64,
    /// Frequency per revolution of the blade's own rotor speed; infinite at rest.
    pub per_rev: f64,
    /// Modal mass: the integral of `m shape^2` (flap, lag) or `m k_m^2 shape^2` (torsion).
    pub modal_mass: f64,
    edges: Arc<[f64]>,
    /// Values of the family's degrees of freedom, element by element.
    nodal: Vec<[f64; 4]>,
}

impl UncoupledMode {
    /// Value, first and second radial derivative of the shape at station r/R; zero inboard of the root.
    ///
    /// The second derivative is that of the element's polynomial, discontinuous between elements: its
    /// error is of second order in the element length for bending, of first order for torsion.
    ///
    /// # Errors
    /// [`FemError::Station`] outside 0 to 1.
    pub fn shape(&self, station: f64) -> Result<[f64; 3], FemError> {
        let Some((e, s)) = locate(&self.edges, station)? else {
            return Ok([0.0; 3]);
        };
        let length = self.edges[e + 1] - self.edges[e];
        let dof = &self.nodal[e];
        let combine = |shapes: &[[f64; 3]]| {
            let mut sum = [0.0; 3];
            for (shape, value) in shapes.iter().zip(dof) {
                for (total, part) in sum.iter_mut().zip(shape) {
                    *total += part * value;
                }
            }
            sum
        };
        Ok(match self.kind {
            ModeKind::Torsion => combine(&quadratic(s, length)),
            _ => combine(&hermite(s, length)),
        })
    }
}

/// Uncoupled rotating modes of a straight blade, in the order flap, lag, torsion, each lowest first.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeSet {
    modes: Vec<UncoupledMode>,
}

impl ModeSet {
    /// All modes: flap, then lag, then torsion, each lowest frequency first.
    pub fn modes(&self) -> &[UncoupledMode] {
        &self.modes
    }

    /// The modes of one family, lowest frequency first.
    pub fn of(&self, kind: ModeKind) -> &[UncoupledMode] {
        let from = self.modes.partition_point(|mode| mode.kind < kind);
        let to = self.modes.partition_point(|mode| mode.kind <= kind);
        &self.modes[from..to]
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.modes.len()
    }

    /// Whether there are no modes.
    pub fn is_empty(&self) -> bool {
        self.modes.is_empty()
    }

    /// All shapes at many stations r/R: `[mode][station]` of value, first and second derivative.
    ///
    /// # Errors
    /// [`FemError::Station`] for a station outside 0 to 1.
    pub fn sample(&self, stations: &[f64]) -> Result<Vec<Vec<[f64; 3]>>, FemError> {
        self.modes.iter().map(|mode| stations.iter().map(|x| mode.shape(*x)).collect()).collect()
    }
}

/// Uncoupled flap, lag and torsion modes of the blade at zero pitch.
///
/// Twist, pitch and precone are taken as zero, axial motion and gyroscopic terms are left out; the
/// steady tension is kept. Shapes have the value 1 at the tip.
///
/// | argument | meaning |
/// |---|---|
/// | `blade` | the blade, in rotor units |
/// | `elements` | equal elements from root to tip; frequencies converge with their fourth power |
/// | `count` | modes wanted; `axial` must be 0 |
/// | `basis` | which shapes stand for a family |
///
/// # Errors
/// [`FemError::Parameter`]; [`FemError::TooFewModes`] when the mesh has fewer than wanted, and for
/// axial modes, which an inextensible blade does not have; [`FemError::NotStable`] for a blade that
/// diverges.
pub fn uncoupled_modes(
    blade: &BladeProperties,
    elements: usize,
    count: ModeCount,
    basis: ModalBasis,
) -> Result<ModeSet, FemError> {
    let model = BladeModel::new(blade.straightened(), elements)?;
    let edges: Arc<[f64]> = model.edges().into();
    let mut modes = Vec::new();
    for kind in ModeKind::ALL {
        let wanted = count.of(kind);
        if wanted == 0 {
            continue;
        }
        let free = if kind == ModeKind::Axial { Vec::new() } else { model.free_of(kind) };
        if free.len() < wanted {
            return Err(FemError::TooFewModes { kind, wanted, available: free.len() });
        }
        let mass = restrict(model.mass(), &free);
        let stiffness = restrict(model.stiffness(), &free);
        let mut pairs = symmetric(&mass, &stiffness, shift(blade))?;
        if basis == ModalBasis::Completed && wanted > 1 {
            let load = rigid_acceleration(&model, kind, &free);
            let completion = completion(&pairs[wanted - 1..], &load);
            pairs[wanted - 1] = completion;
        }
        for (index, pair) in pairs.into_iter().take(wanted).enumerate() {
            let mut all = DVector::zeros(model.mass().nrows());
            for (value, place) in pair.vector.iter().zip(&free) {
                all[*place] = *value;
            }
            let tip_place = all.len() - JOINT_DOF + kind_offset(kind);
            let tip = all[tip_place];
            let frequency = pair.squared_frequency.sqrt();
            modes.push(UncoupledMode {
                kind,
                number: index + 1,
                frequency,
                per_rev: frequency / blade.spec().rotor_speed,
                modal_mass: (tip * tip).recip(),
                edges: Arc::clone(&edges),
                nodal: (0..elements).map(|e| element_values(kind, e, &all, tip)).collect(),
            });
        }
    }
    Ok(ModeSet { modes })
}

/// The load `M 1` of a family on its free degrees of freedom.
fn rigid_acceleration(model: &BladeModel, kind: ModeKind, free: &[usize]) -> DVector<f64> {
    let mut rigid = DVector::zeros(model.mass().nrows());
    for e in 0..model.edges().len() - 1 {
        let places: &[usize] = match kind {
            ModeKind::Torsion => &crate::beam::shape::place::TWIST,
            _ => &[kind_offset(kind), STRIDE + kind_offset(kind)],
        };
        for place in places {
            rigid[STRIDE * e + place] = 1.0;
        }
    }
    let load = model.mass() * rigid;
    DVector::from_iterator(free.len(), free.iter().map(|place| load[*place]))
}

/// The static answer of some modes of unit mass to a load, as a mode of unit mass with the frequency that
/// its energies give it.
fn completion(modes: &[EigenPair<f64>], load: &DVector<f64>) -> EigenPair<f64> {
    let mut vector = DVector::zeros(load.len());
    let (mut mass, mut stiffness) = (0.0, 0.0);
    for mode in modes {
        let share = mode.vector.dot(load) / mode.squared_frequency;
        vector.axpy(share, &mode.vector, 1.0);
        mass += share * share;
        stiffness += share * share * mode.squared_frequency;
    }
    EigenPair { squared_frequency: stiffness / mass, vector: vector / mass.sqrt() }
}

/// Place of a family's displacement among a joint's degrees of freedom.
pub(crate) fn kind_offset(kind: ModeKind) -> usize {
    match kind {
        ModeKind::Axial => 0,
        ModeKind::Lag => 1,
        ModeKind::Flap => 3,
        ModeKind::Torsion => 5,
    }
}

/// The family's values in element `e`, divided by the tip value; the fourth is unused for torsion.
fn element_values(kind: ModeKind, e: usize, all: &DVector<f64>, tip: f64) -> [f64; 4] {
    let places = match kind {
        ModeKind::Torsion => {
            let [a, b, c] = crate::beam::shape::place::TWIST;
            [a, b, c, c]
        }
        ModeKind::Lag => crate::beam::shape::place::LAG,
        ModeKind::Flap => crate::beam::shape::place::FLAP,
        ModeKind::Axial => crate::beam::shape::place::AXIAL,
    };
    places.map(|place| all[STRIDE * e + place] / tip)
}

/// A shift that makes every rotating stiffness positive definite: centrifugal terms take away at most
/// `Omega^2 M`, and the last term stands in for a blade at rest on hinges.
pub(crate) fn shift(blade: &BladeProperties) -> f64 {
    let root = blade.spec().root_offset;
    let bending = blade.flap_stiffness(root) / (blade.mass(root) * (1.0 - root).powi(4));
    2.0 * blade.spec().rotor_speed.powi(2) + bending
}
