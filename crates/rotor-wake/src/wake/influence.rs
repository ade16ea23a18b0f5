//! The wake held still: inflow as a linear function of the circulation.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]
#![expect(
    clippy::cast_possible_truncation,
    reason = "single precision is what is asked for a step"
)]

use super::row_blocks::{RowBlock, RowBlocks};
use super::sources::Sources;
use super::{ControlPoint, CoreSettings, FreeWake, FreeWakeSettings};
use crate::error::ensure;
use crate::kernel::{BLOCK, TakeVelocity, for_each_velocity};
use crate::vector::{Vec3, add, norm, scale, sub};
use crate::{CirculationMap, InflowMap, WakeRotor};
use crate::{FlightState, InducedInflow, InflowModel, RotorLoading, WakeError};
use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, MatRef};
use nalgebra::{DMatrix, DMatrixViewMut, DVector};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::sync::Arc;

/// Rows, or columns, of Newton's matrix that one thread takes together.
const ROWS_TOGETHER: usize = 128;

/// Induced velocity at the control points of all panels and azimuths per unit of circulation at all panels
/// and azimuths, for one geometry of the wake.
///
/// ```text
/// lambda_i = A Gamma + lambda_b           down through the disk
/// u_t      = B Gamma + u_b                from leading to trailing edge, in the plane of the disk
/// ```
/// with `lambda_b`, `u_b` of the body, if there is one.
/// Vectors are ordered azimuth by azimuth; velocities in tip speed, circulation in `Omega R^2`.
#[derive(Debug, Clone, PartialEq)]
pub struct LineInduction {
    rotor: WakeRotor,
    azimuths: usize,
    down: RowBlocks,
    along: RowBlocks,
    /// What the body adds, down and along; empty without one.
    by_the_body: [Vec<f64>; 2],
}

/// Where the control points of Weissinger's method lie between the quarter chord and the trailing edge.
const HALF_A_CHORD: f64 = 2.0 / 3.0;

/// Points of panels at one instant: at most a block of the kernel.
#[derive(Default)]
pub(super) struct TargetBlock {
    phase: usize,
    /// Row of the matrices.
    pub(super) rows: Vec<usize>,
    pub(super) points: Vec<Vec3>,
    /// What of the downwash of the panel's own circulation belongs to the section.
    pub(super) own: [f64; BLOCK],
    /// Sine and cosine of the azimuth of each.
    pub(super) sines: [f64; BLOCK],
    pub(super) cosines: [f64; BLOCK],
}

impl TargetBlock {
    /// Adds the control point of a panel, from the ends of its line and of its edge, at an azimuth.
    pub(super) fn push(
        &mut self,
        row: usize,
        [line, edge]: [&[Vec3]; 2],
        azimuth_rad: f64,
        settings: &FreeWakeSettings,
    ) {
        let lane = self.points.len();
        let middle = |ends: &[Vec3]| scale(add(ends[0], ends[1]), 0.5);
        let line = middle(line);
        let behind = match settings.control_point {
            ControlPoint::LiftingLine => [0.0; 3],
            ControlPoint::ThreeQuarterChord => scale(sub(middle(edge), line), HALF_A_CHORD),
        };
        self.rows.push(row);
        self.points.push(add(line, behind));
        if norm(behind) > 0.0 {
            let CoreSettings { model, near_radius, .. } = settings.core;
            self.own[lane] = model.of_a_straight_line(norm(behind), near_radius);
        }
        (self.sines[lane], self.cosines[lane]) = azimuth_rad.sin_cos();
    }

    /// Velocity across each blade in the plane of the disk, from the leading to the trailing edge.
    #[inline(always)]
    pub(super) fn along(&self, x: &[f64; BLOCK], y: &[f64; BLOCK]) -> [f64; BLOCK] {
        let mut along = [0.0; BLOCK];
        for k in 0..BLOCK {
            along[k] = x[k] * self.sines[k] - y[k] * self.cosines[k];
        }
        along
    }
}

/// The rows of the map at the points of a block, column by column.
struct Rows<'a> {
    sources: &'a Sources,
    block: &'a TargetBlock,
    down: Vec<[f64; BLOCK]>,
    along: Vec<[f64; BLOCK]>,
}

impl TakeVelocity for Rows<'_> {
    #[inline(always)]
    fn take(&mut self, segment: usize, [x, y, z]: [&[f64; BLOCK]; 3]) {
        let along = self.block.along(x, y);
        for (at, factor) in self.sources.terms(segment).iter() {
            for (sum, z) in self.down[at].iter_mut().zip(z) {
                *sum -= factor * z;
            }
            for (sum, along) in self.along[at].iter_mut().zip(along) {
                *sum += factor * along;
            }
        }
    }
}

impl FreeWake {
    fn line_targets(&self) -> Vec<TargetBlock> {
        let panels = self.rotor.panels();
        let mut blocks = Vec::new();
        for phase in 0..self.phases_that_differ() {
            let blades = self.blade_azimuths(phase).take(self.blades_that_differ());
            let places: Vec<_> = blades.flat_map(|i| (0..panels).map(move |s| (i, s))).collect();
            for places in places.chunks(BLOCK) {
                let mut block = TargetBlock { phase, ..TargetBlock::default() };
                for &(i, s) in places {
                    let ends = [self.lines.at(i), self.lines.edge_at(i)].map(|of| &of[s..s + 2]);
                    let azimuth = i as f64 * self.settings.step_rad();
                    block.push(i * panels + s, ends, azimuth, &self.settings);
                }
                blocks.push(block);
            }
        }
        blocks
    }

    /// The linear map from circulation to induced velocity of this geometry. The circulation says where
    /// the outboard peak lies and how thick the cores are.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a circulation of another grid.
    pub fn line_induction(&self, circulation: &CirculationMap) -> Result<LineInduction, WakeError> {
        self.check(circulation)?;
        let (azimuths, panels) = (self.settings.azimuths, self.rotor.panels());
        let size = azimuths * panels;
        let context = self.context(circulation, self.turn());
        let sources: Vec<_> = (0..self.phases_that_differ())
            .into_par_iter()
            .map(|phase| {
                let sources = self.load_sources(phase, &context);
                let segments = sources.unit_segments(&context);
                (sources, segments)
            })
            .collect();
        let blocks = self.line_targets();
        let by_the_body = self.body_at(&blocks, size);
        let maps: Vec<[RowBlock; 2]> = blocks
            .into_par_iter()
            .map(|block| {
                let (sources, segments) = &sources[block.phase];
                let down = vec![[0.0; BLOCK]; size];
                let mut rows = Rows { sources, block: &block, along: down.clone(), down };
                for_each_velocity(&block.points, segments, &mut rows);
                let Rows { mut down, along, .. } = rows;
                for (lane, (row, own)) in block.rows.iter().zip(block.own).enumerate() {
                    down[*row][lane] -= own;
                }
                [(block.rows.clone(), down), (block.rows, along)]
                    .map(|(rows, columns)| RowBlock { rows, columns })
            })
            .collect();
        let (down, along) = maps.into_iter().map(|[down, along]| (down, along)).unzip();
        let turns = self.is_axial();
        let [down, along] = [RowBlocks(down), RowBlocks(along)]
            .map(|map| if turns { map.turned(panels) } else { map });
        Ok(LineInduction { rotor: self.rotor.clone(), azimuths, down, along, by_the_body })
    }

    /// What the body adds at the targets, down and along. In axial flight there is no stream to flow round it.
    fn body_at(&self, blocks: &[TargetBlock], size: usize) -> [Vec<f64>; 2] {
        if self.settings.body.is_none() || self.is_axial() {
            return Default::default();
        }
        let [mut down, mut along] = [vec![0.0; size], vec![0.0; size]];
        for block in blocks {
            for (lane, (&row, &point)) in block.rows.iter().zip(&block.points).enumerate() {
                let [x, y, z] = self.by_the_body(point);
                down[row] = -z;
                along[row] = x * block.sines[lane] - y * block.cosines[lane];
            }
        }
        [down, along]
    }
}

impl LineInduction {
    /// The rotor whose panels are meant.
    pub fn rotor(&self) -> &WakeRotor {
        &self.rotor
    }

    /// Number of azimuths.
    pub fn azimuths(&self) -> usize {
        self.azimuths
    }

    /// The map of circulations that are the same at every azimuth, at one azimuth.
    #[must_use]
    pub fn of_one_azimuth(&self) -> Self {
        let panels = self.rotor.panels();
        let summed = |map: &RowBlocks| {
            let map = map.matrix();
            let sum =
                |row, column| (0..self.azimuths).map(|i| map[(row, i * panels + column)]).sum();
            RowBlocks::from_fn(panels, sum)
        };
        Self {
            rotor: self.rotor.clone(),
            azimuths: 1,
            down: summed(&self.down),
            along: summed(&self.along),
            by_the_body: Default::default(),
        }
    }

    /// The matrices `A` and `B`: down through the disk, and along it.
    pub fn matrices(&self) -> [DMatrix<f64>; 2] {
        [self.down.matrix(), self.along.matrix()]
    }

    /// Induced velocity of a circulation, down through the disk and in its plane.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a circulation of another grid.
    pub fn inflow(&self, circulation: &CirculationMap) -> Result<InflowMap, WakeError> {
        let count = circulation.values().len();
        let expected = "azimuths times panels of the wake";
        ensure(count == self.down.order(), "values of the circulation", count as f64, expected)?;
        let [mut down, mut along] =
            [&self.down, &self.along].map(|map| map.times(circulation.values()));
        for (sums, of_body) in [&mut down, &mut along].into_iter().zip(&self.by_the_body) {
            for (sum, value) in sums.iter_mut().zip(of_body) {
                *sum += value;
            }
        }
        InflowMap::new(&self.rotor, down)?.with_in_plane(along)
    }
}

/// How the circulation answers to the inflow: where the blades stay as they are, a change at all azimuths of one panel
/// per change of the inflow at all azimuths of another one, for panels near each other; and the inflow that the motion of
/// the blades adds.
///
/// ```text
/// dGamma_t = sum_s C_ts (e + H Q e)_s,      e = dlambda - theta du_t
/// ```
/// Every block is of shape `azimuths x azimuths`, `Omega R^2` per tip speed.
#[derive(Debug, Clone, PartialEq)]
pub struct CirculationSlope {
    /// Panel of the circulation, panel of the inflow, and their block; other pairs do not answer.
    pub blocks: Vec<(usize, usize, DMatrix<f64>)>,
    /// Pitch of the sections at every azimuth and panel, rad: what of a velocity in the plane of the disk acts as inflow, with
    /// the opposite sign.
    pub pitch_rad: Vec<f64>,
    /// What the blades do; none if they stay as they are.
    pub motion: Option<MotionSlope>,
}

/// How blades move with the inflow, and what of this their sections feel as inflow, values ordered azimuth by azimuth.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionSlope {
    /// Coordinates of the motion per inflow, `Q`: shape `coordinates x (azimuths panels)`, R per tip speed.
    pub coordinates: DMatrix<f64>,
    /// Inflow per coordinate, `H`: shape `(azimuths panels) x coordinates`, tip speed per R, down through the disk.
    pub inflow: DMatrix<f64>,
}

impl CirculationSlope {
    /// Change of the circulation by a change `e` of what the sections feel as inflow, tip speed, azimuth by azimuth: values
    /// at all panels of one azimuth, then of the next.
    pub fn times(&self, felt: &[f64], panels: usize) -> Vec<f64> {
        let mut inflow = DVector::from_column_slice(felt);
        if let Some(MotionSlope { coordinates, inflow: felt }) = &self.motion {
            inflow += felt * (coordinates * &inflow);
        }
        // panel by panel, for the blocks are of panels
        let azimuths = felt.len() / panels.max(1);
        let turned = |values: &[f64], (rows, columns): (usize, usize)| -> Vec<f64> {
            let row = |row| (0..columns).map(move |column| values[column * rows + row]);
            (0..rows).flat_map(row).collect()
        };
        let inflow = turned(inflow.as_slice(), (panels, azimuths));
        let mut of_panels = vec![0.0; felt.len()];
        let (blocks, out) = (&self.blocks, &mut of_panels);
        Arch::new().dispatch(PanelSums { blocks, azimuths, inflow: &inflow, out });
        turned(&of_panels, (azimuths, panels))
    }
}

/// What every panel answers: a type of its own, for a closure would be called, not inlined, by the function that is
/// compiled for the vector unit.
struct PanelSums<'a> {
    blocks: &'a [(usize, usize, DMatrix<f64>)],
    azimuths: usize,
    /// At all azimuths of one panel, then of the next; so are the sums.
    inflow: &'a [f64],
    out: &'a mut [f64],
}

impl WithSimd for PanelSums<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { blocks, azimuths, inflow, out } = self;
        let of = |panel: usize| panel * azimuths..(panel + 1) * azimuths;
        for (from, to, block) in blocks {
            let sums = &mut out[of(*from)];
            let columns = block.as_slice().chunks_exact(azimuths);
            for (column, change) in columns.zip(&inflow[of(*to)]) {
                for (sum, slope) in sums.iter_mut().zip(column) {
                    *sum += slope * change;
                }
            }
        }
    }
}

/// `I - (A - theta B) C'` of [`FrozenWake::new`], from `A - theta B`.
///
/// Threads share columns and rows in parts of a fixed size, so that no sum depends on their number.
fn newton_matrix(
    map: &DMatrix<f32>,
    slope: &CirculationSlope,
    (azimuths, panels): (usize, usize),
) -> Result<DMatrix<f32>, WakeError> {
    let (size, single) = (azimuths * panels, |matrix: &DMatrix<f64>| matrix.map(|x| x as f32));
    for (from, to, block) in &slope.blocks {
        let fits = *from.max(to) < panels && block.shape() == (azimuths, azimuths);
        let expected = "azimuths and panels of the wake";
        ensure(fits, "order of a slope of the circulation", block.nrows() as f64, expected)?;
    }
    let of_panel = |to: usize| {
        let mut answer = DMatrix::zeros(size, azimuths);
        for (from, _, block) in slope.blocks.iter().filter(|(_, of, _)| *of == to) {
            let down = map.columns_with_step(*from, azimuths, panels - 1);
            answer.gemm(-1.0, &down, &single(block), 1.0);
        }
        answer
    };
    let answers: Vec<DMatrix<f32>> = (0..panels).into_par_iter().map(of_panel).collect();
    let mut newton = DMatrix::from_fn(size, size, |row, column| {
        answers[column % panels][(row, column / panels)] + f32::from(u8::from(row == column))
    });
    let Some(MotionSlope { coordinates, inflow }) = &slope.motion else { return Ok(newton) };
    let fits = coordinates.shape() == (inflow.ncols(), inflow.nrows());
    let (found, expected) = (inflow.nrows(), "azimuths times panels of the wake");
    ensure(fits && found == size, "order of a slope of the motion", found as f64, expected)?;
    let (coordinates, inflow) = (single(coordinates), single(inflow));
    let mut answered = inflow.clone();
    let rows_from = |first: usize| {
        let rows = ROWS_TOGETHER.min(size - first);
        let mut part = inflow.rows(first, rows).into_owned();
        part.gemm(-1.0, &newton.rows(first, rows), &inflow, 1.0);
        (first, part)
    };
    let firsts: Vec<usize> = (0..size).step_by(ROWS_TOGETHER).collect();
    let parts: Vec<(usize, DMatrix<f32>)> = firsts.into_par_iter().map(rows_from).collect();
    for (first, part) in parts {
        answered.rows_mut(first, part.nrows()).copy_from(&part);
    }
    let columns = newton.as_mut_slice().par_chunks_mut(size * ROWS_TOGETHER).enumerate();
    columns.for_each(|(part, columns)| {
        let mut columns = DMatrixViewMut::from_slice(columns, size, columns.len() / size);
        let of = coordinates.columns(part * ROWS_TOGETHER, columns.ncols());
        columns.gemm(-1.0, &answered, &of, 1.0);
    });
    Ok(newton)
}

/// An inflow model: the wake as it is, carrying whatever circulation the blades have.
///
/// The geometry stays; the inflow follows the circulation at once. This is what a response or a trim sees
/// between two updates of the geometry.
#[derive(Debug, Clone)]
pub struct FrozenWake {
    induction: Arc<LineInduction>,
    reference: InflowMap,
    /// Of a Newton step, factorised; single precision is enough for a step, and half the memory to read.
    newton: Arc<PartialPivLu<f32>>,
    slope: Arc<CirculationSlope>,
}

impl FrozenWake {
    /// The wake's map with the inflow to start from, for blades whose circulation answers to the inflow by `slope`,
    /// which sets the speed of convergence, not the result:
    ///
    /// ```text
    /// e = (I - (A - theta B) C')^-1 (r - theta r_t),      r = A Gamma - lambda,      r_t = B Gamma - u_t
    /// du_t = r_t + B C' e,      dlambda = e + theta du_t,      C' = C (I + H Q)
    /// ```
    /// is Newton's step where the circulation follows the inflow alone, and the blades with it as the slope says.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a circulation or a slope of another grid.
    pub fn new(
        induction: LineInduction,
        circulation: &CirculationMap,
        slope: &CirculationSlope,
    ) -> Result<Self, WakeError> {
        let reference = induction.inflow(circulation)?;
        let (azimuths, panels) = (induction.azimuths, induction.rotor.panels());
        let size = azimuths * panels;
        let (pitches, expected) = (slope.pitch_rad.len(), "azimuths times panels of the wake");
        ensure(
            pitches == size,
            "pitch angles of a slope of the circulation",
            pitches as f64,
            expected,
        )?;
        let map = induction.down.less(&induction.along, &slope.pitch_rad);
        let newton = newton_matrix(&map, slope, (azimuths, panels))?;
        let newton = MatRef::from_column_major_slice(newton.as_slice(), size, size);
        let newton = Arc::new(newton.partial_piv_lu());
        let slope = Arc::new(slope.clone());
        Ok(Self { newton, slope, induction: Arc::new(induction), reference })
    }

    /// The wake after its geometry has moved on, on the same grid: it keeps Newton's matrix.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a map or a circulation of another grid.
    pub fn moved_on(
        &self,
        induction: LineInduction,
        circulation: &CirculationMap,
    ) -> Result<Self, WakeError> {
        let (size, expected) = (self.induction.down.order(), "azimuths times panels of the wake");
        let found = induction.down.order();
        ensure(found == size, "order of a map of circulation", found as f64, expected)?;
        let reference = induction.inflow(circulation)?;
        let (newton, slope) = (Arc::clone(&self.newton), Arc::clone(&self.slope));
        Ok(Self { induction: Arc::new(induction), reference, newton, slope })
    }
}

impl InflowModel for FrozenWake {
    fn name(&self) -> &'static str {
        "free wake"
    }

    fn induced(
        &self,
        flight: &FlightState,
        loading: &RotorLoading,
    ) -> Result<InducedInflow, WakeError> {
        flight.validated()?;
        Ok(InducedInflow::Map(match &loading.circulation {
            Some(circulation) => self.induction.inflow(circulation)?,
            None => self.reference.clone(),
        }))
    }

    fn circulation_grid(&self) -> Option<(&WakeRotor, usize)> {
        Some((&self.induction.rotor, self.induction.azimuths))
    }

    fn improved_step(&self, change: &[f64]) -> Option<Vec<f64>> {
        let size = self.induction.down.order();
        let (down, in_plane) = change.split_at_checked(size)?;
        let pitch_rad = &self.slope.pitch_rad;
        let mut felt =
            Mat::from_fn(size, 1, |row, _| (down[row] - pitch_rad[row] * in_plane[row]) as f32);
        self.newton.solve_in_place(felt.as_mut());
        let felt: Vec<f64> = (0..size).map(|row| f64::from(felt[(row, 0)])).collect();
        let circulation = self.slope.times(&felt, self.induction.rotor.panels());
        let mut in_plane = in_plane.to_vec();
        for (sum, more) in in_plane.iter_mut().zip(self.induction.along.times(&circulation)) {
            *sum += more;
        }
        let with_pitch = felt.iter().zip(pitch_rad.iter().zip(&in_plane));
        let mut step: Vec<f64> = with_pitch.map(|(felt, (pitch, u))| felt + pitch * u).collect();
        step.append(&mut in_plane);
        step.iter().all(|value| value.is_finite()).then_some(step)
    }
}
