//! The aeroelastic blade: what it is made of, and its values at the spanwise stations.

use crate::model::air_scales::AirScales;
use crate::model::flap::FlapInertia;
use crate::{
    Couplings, Discretisation, FlapMass, ResponseError, RotorModel, SectionOffsets, SpanGrid,
};
use nalgebra::DMatrix;
use rotor_fem::{
    BladeProperties, ModalBlade, ModalShape, ModeCount, ModeKind, ModeSet, ModerateBlade,
    ModerateSpec, SectionShape, UncoupledMode, uncoupled_modes,
};

/// Station inboard of which the flow may turn round, radius R: the largest advance ratio the attached
/// sections are meant for. There the loads vary fast along the span, and the pieces of the grid are halved.
const REVERSE_FLOW_END: f64 = 0.5;

/// Mode shapes of one family at the stations: `[mode][station]` for value and two derivatives.
#[derive(Debug, Clone)]
pub(crate) struct Shapes {
    pub(crate) value: Vec<Vec<f64>>,
    pub(crate) slope: Vec<Vec<f64>>,
    pub(crate) curvature: Vec<Vec<f64>>,
    /// Whether curvature and acceleration of the slope mean anything: not in torsion.
    pub(crate) bend: bool,
}

impl Shapes {
    fn sample(samples: &[Vec<[f64; 3]>], bend: bool) -> Self {
        let pick =
            |k: usize| samples.iter().map(|mode| mode.iter().map(|s| s[k]).collect()).collect();
        Self { value: pick(0), slope: pick(1), curvature: pick(2), bend }
    }

    pub(crate) fn count(&self) -> usize {
        self.value.len()
    }
}

/// The blade as the periodic response sees it: mode shapes and properties at spanwise stations.
#[derive(Debug, Clone)]
pub struct ResponseBlade {
    pub(crate) grid: SpanGrid,
    pub(crate) flap: Shapes,
    pub(crate) lag: Shapes,
    pub(crate) torsion: Shapes,
    /// Undamped frequencies per rev and modal masses, in the order flap, lag, torsion.
    pub(crate) frequencies: Vec<f64>,
    pub(crate) modal_masses: Vec<f64>,
    /// Stiffness of the springs at the root on the modal coordinates.
    pub(crate) root_spring: DMatrix<f64>,
    /// Slope of every flap and lag mode at the root, twist of every torsion mode.
    root_rotation: Vec<f64>,
    pub(crate) modes: ModeSet,
    pub(crate) properties: BladeProperties,
    pub(crate) mass: Vec<f64>,
    /// Mass without that on the elastic axis.
    pub(crate) section_mass: Vec<f64>,
    pub(crate) ei_flap: Vec<f64>,
    pub(crate) ei_lag: Vec<f64>,
    pub(crate) gj: Vec<f64>,
    pub(crate) km1_squared: Vec<f64>,
    pub(crate) km2_squared: Vec<f64>,
    pub(crate) ka_squared: Vec<f64>,
    pub(crate) twist: Vec<f64>,
    /// Rate of the built-in twist along the blade, rad per R.
    pub(crate) twist_slope: Vec<f64>,
    pub(crate) tension: Vec<f64>,
    pub(crate) precone: f64,
    /// Its sine and cosine.
    pub(crate) cone: [f64; 2],
    /// Mass moment of every lag mode outboard of each station, `int_x^1 m L_j`.
    pub(crate) lag_outboard: Vec<Vec<f64>>,
    /// Index of the flap at each station, if any.
    pub(crate) flap_index: Vec<Option<usize>>,
    /// Inertia of the flap at each station, if any.
    pub(crate) flap_inertia: Vec<Option<FlapInertia>>,
    /// Chord and what goes with it at each station.
    pub(crate) air: Vec<AirScales>,
    pub(crate) cutout: f64,
    /// Outboard of this station sections do not lift, radius R.
    pub(crate) tip_loss: f64,
    /// Centres ahead of the elastic axis, and the axis ahead of the rotor centre, radius R.
    pub(crate) offsets: SectionOffsets,
    /// Mass centre ahead of the elastic axis at each station, radius R.
    pub(crate) mass_centre: Vec<f64>,
    pub(crate) root_offset: f64,
    /// The blade of [`Couplings::Moderate`], and its own modal equations.
    pub(crate) moderate: Option<ModerateBlade>,
    pub(crate) modal: Option<ModalBlade>,
}

impl ResponseBlade {
    /// Samples mode shapes and properties of a blade at the stations.
    ///
    /// # Errors
    /// [`ResponseError::Parameter`] for the points of a piece, and the errors of the finite elements.
    pub(crate) fn new(
        model: &RotorModel,
        properties: &BladeProperties,
        discretisation: Discretisation,
    ) -> Result<Self, ResponseError> {
        let [flap, lag, torsion] = discretisation.modes;
        let count = ModeCount { flap, lag, torsion, axial: 0 };
        let elements = discretisation.blade_elements;
        let modes = uncoupled_modes(properties, elements, count, discretisation.basis)?;
        let root = properties.spec().root_offset;
        let length = (1.0 - root) / elements as f64;
        let breaks: Vec<f64> = (1..elements)
            .map(|e| root + length * e as f64)
            .chain(properties.breaks().iter().copied())
            .chain([model.root_cutout, model.tip_loss])
            .chain(model.flaps.iter().flat_map(|f| [f.start, f.end]))
            .chain(model.planform.breaks())
            .collect();
        let turning = [model.root_cutout, REVERSE_FLOW_END];
        let grid = SpanGrid::halved(root, &breaks, turning, discretisation.span_points_per_piece)?;
        let samples = modes.sample(grid.x())?;
        let (of_flap, rest) = samples.split_at(flap);
        let (of_lag, of_torsion) = rest.split_at(lag);
        let root_rotation = root_rotations(&modes, root)?;
        let moderate = match model.couplings {
            Couplings::Moderate(torsion) => {
                let spec = ModerateSpec {
                    torsion,
                    mass_centre: model.mass_centre(),
                    tension_centre: model.offsets.tension_centre.into(),
                    ..properties.spec().clone().into()
                };
                Some(ModerateBlade::new(spec)?)
            }
            Couplings::Linear | Couplings::Full => None,
        };
        let along =
            |f: &dyn Fn(f64) -> f64| -> Vec<f64> { grid.x().iter().map(|x| f(*x)).collect() };
        let flap_index: Vec<Option<usize>> = grid
            .x()
            .iter()
            .map(|x| model.flaps.iter().position(|f| (f.start..f.end).contains(x)))
            .collect();
        let air: Vec<AirScales> = grid.x().iter().map(|x| AirScales::at(model, *x)).collect();
        let outboard = |mode: &Vec<[f64; 3]>| {
            let moment = |(x, shape): (&f64, &[f64; 3])| properties.mass(*x) * shape[0];
            let density: Vec<f64> = grid.x().iter().zip(mode).map(moment).collect();
            let mut moment = vec![0.0; density.len()];
            grid.integral_to_tip(&density, &mut moment);
            moment
        };
        let inertia = |(flap, air): (&Option<usize>, &AirScales)| {
            flap.map(|k| model.flaps[k].inertia(air.chord, air.centre))
        };
        Ok(Self {
            flap: Shapes::sample(of_flap, true),
            lag: Shapes::sample(of_lag, true),
            torsion: Shapes::sample(of_torsion, false),
            frequencies: modes.modes().iter().map(|mode| mode.frequency).collect(),
            modal_masses: modes.modes().iter().map(|mode| mode.modal_mass).collect(),
            root_spring: root_springs(properties, &modes, &root_rotation),
            root_rotation,
            mass: along(&|x| properties.mass(x)),
            section_mass: along(&|x| properties.section_mass(x)),
            ei_flap: along(&|x| properties.flap_stiffness(x)),
            ei_lag: along(&|x| properties.lag_stiffness(x)),
            gj: along(&|x| properties.torsion_stiffness(x)),
            km1_squared: along(&|x| properties.squared_mass_radii(x)[0]),
            km2_squared: along(&|x| properties.squared_mass_radii(x)[1]),
            ka_squared: along(&|x| properties.squared_area_radius(x)),
            twist: along(&|x| properties.twist_rad(x)),
            twist_slope: along(&|x| properties.twist_rate_rad(x)),
            tension: along(&|x| properties.tension(x)),
            precone: properties.spec().precone_rad,
            cone: properties.spec().precone_rad.sin_cos().into(),
            lag_outboard: of_lag.iter().map(outboard).collect(),
            flap_inertia: flap_index.iter().zip(&air).map(inertia).collect(),
            flap_index,
            air,
            cutout: model.root_cutout,
            tip_loss: model.tip_loss,
            mass_centre: along(&|x| model.mass_centre().value(x)),
            offsets: model.offsets,
            root_offset: root,
            modal: moderate.as_ref().map(|b| modal_blade(b, &modes, &grid)).transpose()?,
            moderate,
            modes,
            properties: properties.clone(),
            grid,
        })
    }

    /// Angles of the joints of the root for modal coordinates in the order flap, lag, torsion, rad: slope toward
    /// the leading edge, slope up, twist nose up. Zero where a joint is locked, and from coordinates that lack.
    pub fn joint_angles_rad(&self, coordinates: &[f64]) -> [f64; 3] {
        let (flap, lag) = (self.flap.count(), self.lag.count());
        let mut angles = [0.0; 3];
        for (i, (rotation, q)) in self.root_rotation.iter().zip(coordinates).enumerate() {
            let place = if i < flap { 1 } else { 2 * usize::from(i >= flap + lag) };
            angles[place] += rotation * q;
        }
        angles
    }

    /// Whether a flap weighs beside the blade.
    pub(crate) fn flaps_beside_blade(&self) -> bool {
        self.flap_inertia.iter().flatten().any(|flap| flap.mass == FlapMass::AddedToBlade)
    }

    /// Number of modal coordinates.
    pub(crate) fn dof(&self) -> usize {
        self.modes.len()
    }

    /// Family of a modal coordinate and its number in it, from 1.
    pub(crate) fn mode(&self, coordinate: usize) -> (ModeKind, usize) {
        let mode = &self.modes.modes()[coordinate];
        (mode.kind, mode.number)
    }

    /// Modal mass matrix: families do not couple, modes of a family do only by rounding.
    pub(crate) fn mass_matrix(&self) -> DMatrix<f64> {
        let n = self.grid.len();
        let polar: Vec<f64> =
            (0..n).map(|i| self.mass[i] * (self.km1_squared[i] + self.km2_squared[i])).collect();
        let mut matrix = DMatrix::zeros(self.dof(), self.dof());
        let mut at = 0;
        for (shapes, density) in
            [(&self.flap, &self.mass), (&self.lag, &self.mass), (&self.torsion, &polar)]
        {
            for (i, a) in shapes.value.iter().enumerate() {
                for (j, b) in shapes.value.iter().enumerate() {
                    let product: Vec<f64> = (0..n).map(|k| density[k] * a[k] * b[k]).collect();
                    matrix[(at + i, at + j)] = self.grid.integral(&product);
                }
            }
            at += shapes.count();
        }
        matrix
    }

    /// Whether a mode is the rotation about a free hinge, which strains nothing.
    pub(crate) fn turns_freely(&self, mode: (ModeKind, usize)) -> bool {
        let root = self.properties.spec().root;
        match mode {
            (ModeKind::Flap, 1) => root.flap.is_free(),
            (ModeKind::Lag, 1) => root.lag.is_free(),
            _ => false,
        }
    }

    /// Damping of the modes and of the lag damper on the modal coordinates:
    ///
    /// ```text
    /// C_ii = 2 zeta omega M,   C_ij += c s_i s_j   of lag modes, s_i their slope at the root
    /// ```
    /// without the modal part of the first mode of a free hinge, a rotation about it that strains nothing.
    pub(crate) fn damping(&self, modal_ratio: f64, lag_damper: f64) -> DMatrix<f64> {
        DMatrix::from_fn(self.dof(), self.dof(), |i, j| {
            let modes @ [(kind, _), (other, _)] = [i, j].map(|k| self.mode(k));
            let own = if i == j && !self.turns_freely(modes[0]) {
                2.0 * modal_ratio * self.frequencies[i] * self.modal_masses[i]
            } else {
                0.0
            };
            if [kind, other] == [ModeKind::Lag; 2] {
                own + lag_damper * self.root_rotation[i] * self.root_rotation[j]
            } else {
                own
            }
        })
    }

    /// Stations and quadrature of the blade.
    pub fn grid(&self) -> &SpanGrid {
        &self.grid
    }

    /// Undamped uncoupled frequencies, per rev at nominal rotor speed, order flap, lag, torsion.
    pub fn frequencies_per_rev(&self) -> &[f64] {
        &self.frequencies
    }
}

/// Stiffness of the springs at the root on the modal coordinates: one line for each of the joints.
///
/// ```text
/// K_ij = k s_i s_j,   s_i the slope (twist) of mode i at the root
/// ```
fn root_springs(properties: &BladeProperties, modes: &ModeSet, rotations: &[f64]) -> DMatrix<f64> {
    let [lag, flap, feather] = properties.spec().root.springs();
    let kinds: Vec<ModeKind> = modes.modes().iter().map(|mode| mode.kind).collect();
    DMatrix::from_fn(kinds.len(), kinds.len(), |i, j| {
        let spring = match kinds[i] {
            ModeKind::Flap => flap,
            ModeKind::Lag => lag,
            _ => feather,
        };
        if kinds[i] == kinds[j] { spring * rotations[i] * rotations[j] } else { 0.0 }
    })
}

/// Slope of every flap and lag mode at the root, twist of every torsion mode.
fn root_rotations(modes: &ModeSet, root: f64) -> Result<Vec<f64>, ResponseError> {
    let rotation = |mode: &UncoupledMode| {
        let shape = mode.shape(root)?;
        Ok(if matches!(mode.kind, ModeKind::Flap | ModeKind::Lag) { shape[1] } else { shape[0] })
    };
    modes.modes().iter().map(rotation).collect()
}

/// The same in the coordinates of the uncoupled modes.
fn modal_blade(
    blade: &ModerateBlade,
    modes: &ModeSet,
    grid: &SpanGrid,
) -> Result<ModalBlade, ResponseError> {
    let properties = blade.properties();
    let shape = |mode: &UncoupledMode, x: f64| -> Result<SectionShape, ResponseError> {
        let value = mode.shape(x)?;
        let still = SectionShape::default();
        Ok(match mode.kind {
            ModeKind::Flap => SectionShape { flap: value, ..still },
            ModeKind::Lag => SectionShape { lag: value, ..still },
            _ => SectionShape { twist: [value[0], value[1]], ..still },
        })
    };
    let shapes = modes
        .modes()
        .iter()
        .map(|mode| {
            Ok(ModalShape {
                root: shape(mode, properties.spec().root_offset)?,
                sections: grid
                    .x()
                    .iter()
                    .map(|x| shape(mode, *x))
                    .collect::<Result<_, ResponseError>>()?,
            })
        })
        .collect::<Result<_, ResponseError>>()?;
    Ok(ModalBlade::new(blade, grid.edges(), grid.points_per_piece(), shapes)?)
}
