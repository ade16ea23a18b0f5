//! Section coefficients laid out for marching: four lags side by side, or poles that all inputs share.

use crate::error::check;
use crate::motion::decay::{Decay, LANES, Lanes, decay};
use crate::{AeroError, LagChannel, SectionCoefficients};

/// A step shorter than this, semichords, is none: its inverse would leave the range of numbers.
const NO_STEP: f64 = 1e-200;

/// Inputs of a section at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SectionInputs {
    /// `m = [alpha, q, delta, q_delta]`, in the order of [`Mode`](crate::Mode).
    pub modes: [f64; 4],
    /// `dm/dS`, per semichord travelled. Used by models with apparent mass only.
    pub rates: [f64; 4],
}

/// Four lags side by side; a block that is not full ends with lags of no weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Block {
    pole: Lanes,
    /// `1 / pole`
    time: Lanes,
    /// `[input][lag]`
    input: [Lanes; 4],
    /// `[output][lag]`
    pub(crate) output: [Lanes; 3],
}

/// Poles that all four inputs share: one decay serves four lags, which lie side by side, one per
/// input, and follow the inputs themselves.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Shared {
    /// The poles, four side by side; of each block only pole and time are used.
    poles: Vec<Block>,
    /// Weight of each lag per pole, `[output][input]`.
    pub(crate) output: Vec<[Lanes; 3]>,
    /// Outputs of settled lags, `[output][input]`: direct and all weights.
    settled: [Lanes; 3],
}

/// Most poles that are marched as shared ones.
pub(crate) const MOST_SHARED: usize = 2 * LANES;

/// How the lags lie side by side.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Layout {
    /// Any lags.
    General(Vec<Block>),
    /// Shared poles.
    Shared(Shared),
}

/// Section coefficients laid out for marching.
#[derive(Debug, Clone, PartialEq)]
pub struct MarchingSection {
    direct: [[f64; 4]; 3],
    rate: [[f64; 4]; 3],
    pub(crate) layout: Layout,
    pub(crate) lags: usize,
}

/// The block of up to four lags.
fn block(lags: &[LagChannel]) -> Block {
    let mut block = Block {
        pole: [1.0; LANES],
        time: [1.0; LANES],
        input: [[0.0; LANES]; 4],
        output: [[0.0; LANES]; 3],
    };
    for (lane, lag) in lags.iter().enumerate() {
        block.pole[lane] = lag.pole;
        block.time[lane] = 1.0 / lag.pole;
        for (row, weight) in block.input.iter_mut().zip(lag.input) {
            row[lane] = weight;
        }
        for (row, weight) in block.output.iter_mut().zip(lag.output) {
            row[lane] = weight;
        }
    }
    block
}

/// Whether four lags share their pole and follow one input each, in order.
fn is_shared(lags: &[LagChannel]) -> bool {
    const UNIT: [[f64; 4]; 4] =
        [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    let same = |lag: &LagChannel| lag.pole.to_bits() == lags[0].pole.to_bits();
    lags.len() == LANES
        && lags
            .iter()
            .zip(UNIT)
            .all(|(lag, unit)| same(lag) && lag.input.map(f64::to_bits) == unit.map(f64::to_bits))
}

impl MarchingSection {
    /// Lays out the coefficients of a section.
    pub fn new(section: &SectionCoefficients) -> Self {
        let chunks = || section.lags.chunks(LANES);
        let few = (LANES..=MOST_SHARED * LANES).contains(&section.lags.len());
        let layout = if few && chunks().all(is_shared) {
            let firsts: Vec<LagChannel> = chunks().map(|lags| lags[0]).collect();
            let output: Vec<[Lanes; 3]> = chunks().map(|lags| block(lags).output).collect();
            let mut settled = section.direct;
            for (sum, weight) in output.iter().flat_map(|weights| {
                (0..3).flat_map(move |o| (0..LANES).map(move |j| ((o, j), weights[o][j])))
            }) {
                settled[sum.0][sum.1] += weight;
            }
            Layout::Shared(Shared {
                poles: firsts.chunks(LANES).map(block).collect(),
                output,
                settled,
            })
        } else {
            Layout::General(chunks().map(block).collect())
        };
        Self { direct: section.direct, rate: section.rate, layout, lags: section.lags.len() }
    }

    /// The blocks whose decay factors a step needs.
    #[inline]
    pub(crate) fn decaying(&self) -> &[Block] {
        match &self.layout {
            Layout::General(blocks) => blocks,
            Layout::Shared(shared) => &shared.poles,
        }
    }

    /// What the lags follow, four side by side.
    pub(crate) fn drives(&self, modes: &[f64; 4]) -> Vec<Lanes> {
        match &self.layout {
            Layout::General(blocks) => blocks.iter().map(|block| block.drive(modes)).collect(),
            Layout::Shared(_) => vec![*modes],
        }
    }

    /// The loads without the lags' share.
    #[inline]
    pub(crate) fn loads_at_once(&self, inputs: &SectionInputs) -> [f64; 3] {
        let dot = |row: &[f64; 4], m: &[f64; 4]| {
            row[0] * m[0] + row[1] * m[1] + row[2] * m[2] + row[3] * m[3]
        };
        let direct = match &self.layout {
            Layout::General(_) => &self.direct,
            Layout::Shared(shared) => &shared.settled,
        };
        std::array::from_fn(|o| dot(&direct[o], &inputs.modes) + dot(&self.rate[o], &inputs.rates))
    }
}

impl Block {
    /// What each lag follows.
    #[inline]
    pub(crate) fn drive(&self, modes: &[f64; 4]) -> Lanes {
        std::array::from_fn(|lane| {
            self.input[0][lane] * modes[0]
                + self.input[1][lane] * modes[1]
                + self.input[2][lane] * modes[2]
                + self.input[3][lane] * modes[3]
        })
    }

    /// Decay over a step of `[semichords, 1 / semichords]`.
    #[inline]
    pub(crate) fn decay(&self, [semichords, inverse]: [f64; 2]) -> Decay {
        if semichords < NO_STEP {
            return Decay::NONE;
        }
        decay(&self.pole.map(|pole| pole * semichords), &self.time.map(|time| time * inverse))
    }
}

/// Decay factors of a step, for steps that are taken many times over.
#[derive(Debug, Clone, PartialEq)]
pub struct StepFactors {
    pub(crate) blocks: Vec<Decay>,
    /// The same one after the other, for shared poles.
    pub(crate) shared: [[f64; 2]; MOST_SHARED],
    pub(crate) lags: usize,
}

/// `[gone, mean]` of up to eight poles one after the other.
#[inline]
pub(crate) fn one_by_one(mut decays: impl Iterator<Item = Decay>) -> [[f64; 2]; MOST_SHARED] {
    let [first, second] = [decays.next(), decays.next()].map(|d| d.unwrap_or(Decay::NONE));
    std::array::from_fn(|i| match i.checked_sub(LANES) {
        None => [first.gone[i], first.mean[i]],
        Some(i) => [second.gone[i], second.mean[i]],
    })
}

impl StepFactors {
    /// Factors of a step of `semichords` with these coefficients.
    ///
    /// # Errors
    /// [`AeroError::BadInput`] if the step is negative or not finite.
    pub fn new(section: &MarchingSection, semichords: f64) -> Result<Self, AeroError> {
        check_step(semichords)?;
        let step = [semichords, 1.0 / semichords];
        let blocks: Vec<Decay> = section.decaying().iter().map(|block| block.decay(step)).collect();
        let shared = one_by_one(blocks.iter().copied());
        Ok(Self { blocks, shared, lags: section.lags })
    }

    /// What is left of each lag state over the step, in the order of the lags.
    pub(crate) fn kept(&self, section: &MarchingSection) -> Vec<f64> {
        let each = self.blocks.iter().flat_map(|decay| decay.gone).map(|gone| 1.0 - gone);
        match &section.layout {
            Layout::General(_) => each.take(self.lags).collect(),
            Layout::Shared(_) => each.flat_map(|kept| [kept; LANES]).take(self.lags).collect(),
        }
    }
}

pub(crate) fn check_step(semichords: f64) -> Result<(), AeroError> {
    let fits = |step: f64| step.is_finite() && step >= 0.0;
    check(&[("step, semichords", semichords)], "a finite number, 0 or more", fits)
}
