//! Time marching of a section: recurrence exact for inputs that change linearly over a step.

use crate::decay::{Decay, LANES, Lanes, decay};
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
struct Block {
    pole: Lanes,
    /// `1 / pole`
    time: Lanes,
    /// `[input][lag]`
    input: [Lanes; 4],
    /// `[output][lag]`
    output: [Lanes; 3],
}

/// Four lags of one pole, the first for the first input, the second for the second, and so on.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Shared {
    /// `[output][input]`
    output: [Lanes; 3],
}

/// How the lags lie side by side.
#[derive(Debug, Clone, PartialEq)]
enum Layout {
    /// Any lags.
    General(Vec<Block>),
    /// Poles that all four inputs share: one decay serves four lags, and what they follow are the
    /// inputs themselves.
    Shared {
        /// The poles, four side by side; `input` and `output` are not used.
        poles: Vec<Block>,
        lags: Vec<Shared>,
    },
}

/// Section coefficients laid out for marching.
#[derive(Debug, Clone, PartialEq)]
pub struct MarchingSection {
    direct: [[f64; 4]; 3],
    rate: [[f64; 4]; 3],
    layout: Layout,
    lags: usize,
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
    lags.len() == LANES && lags.iter().zip(UNIT).all(|(lag, unit)| same(lag) && lag.input == unit)
}

impl MarchingSection {
    /// Lays out the coefficients of a section.
    pub fn new(section: &SectionCoefficients) -> Self {
        let chunks = || section.lags.chunks(LANES);
        let layout = if !section.lags.is_empty() && chunks().all(is_shared) {
            let firsts: Vec<LagChannel> = chunks().map(|lags| lags[0]).collect();
            Layout::Shared {
                poles: firsts.chunks(LANES).map(block).collect(),
                lags: chunks().map(|lags| Shared { output: block(lags).output }).collect(),
            }
        } else {
            Layout::General(chunks().map(block).collect())
        };
        Self { direct: section.direct, rate: section.rate, layout, lags: section.lags.len() }
    }

    /// The blocks whose decay factors a step needs.
    #[inline]
    fn decaying(&self) -> &[Block] {
        match &self.layout {
            Layout::General(blocks) => blocks,
            Layout::Shared { poles, .. } => poles,
        }
    }

    /// What the lags follow, four side by side.
    fn drives(&self, modes: &[f64; 4]) -> Vec<Lanes> {
        match &self.layout {
            Layout::General(blocks) => blocks.iter().map(|block| block.drive(modes)).collect(),
            Layout::Shared { .. } => vec![*modes],
        }
    }

    /// The loads without the lags' share.
    #[inline]
    fn loads_at_once(&self, inputs: &SectionInputs) -> [f64; 3] {
        let dot = |row: &[f64; 4], m: &[f64; 4]| {
            row[0] * m[0] + row[1] * m[1] + row[2] * m[2] + row[3] * m[3]
        };
        std::array::from_fn(|o| {
            dot(&self.direct[o], &inputs.modes) + dot(&self.rate[o], &inputs.rates)
        })
    }
}

impl Block {
    /// What each lag follows.
    #[inline]
    fn drive(&self, modes: &[f64; 4]) -> Lanes {
        std::array::from_fn(|lane| {
            self.input[0][lane] * modes[0]
                + self.input[1][lane] * modes[1]
                + self.input[2][lane] * modes[2]
                + self.input[3][lane] * modes[3]
        })
    }

    /// Decay over a step of `[semichords, 1 / semichords]`.
    #[inline]
    fn decay(&self, [semichords, inverse]: [f64; 2]) -> Decay {
        if semichords < NO_STEP {
            return Decay::NONE;
        }
        decay(&self.pole.map(|pole| pole * semichords), &self.time.map(|time| time * inverse))
    }
}

/// Decay factors of a step, for steps that are taken many times over.
#[derive(Debug, Clone, PartialEq)]
pub struct StepFactors {
    blocks: Vec<Decay>,
    lags: usize,
}

impl StepFactors {
    /// Factors of a step of `semichords` with these coefficients.
    ///
    /// # Errors
    /// [`AeroError::BadInput`] if the step is negative or not finite.
    pub fn new(section: &MarchingSection, semichords: f64) -> Result<Self, AeroError> {
        check_step(semichords)?;
        let step = [semichords, 1.0 / semichords];
        let blocks = section.decaying().iter().map(|block| block.decay(step)).collect();
        Ok(Self { blocks, lags: section.lags })
    }
}

/// Lag states of a section on its way through time.
///
/// ```text
/// x1 = u1 - (u1 - u0) g + (x0 - u0) e^(-z),     z = pole dS,   g = (1 - e^(-z)) / z,   u = input . m
/// ```
/// The solution of `dx/dS = pole (u - x)` for a `u` that runs straight from `u0` to `u1`: exact on a
/// ramp, second order otherwise, and stable for any step however stiff the lag.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionState {
    states: Vec<Lanes>,
    /// What the states follow: block by block, or once for all if they share the inputs.
    drives: Vec<Lanes>,
    lags: usize,
}

impl SectionState {
    /// A section at rest, all inputs zero since ever.
    pub fn at_rest(section: &MarchingSection) -> Self {
        Self::settled(section, &[0.0; 4])
    }

    /// A section whose inputs have been held for ever.
    pub fn settled(section: &MarchingSection, modes: &[f64; 4]) -> Self {
        let drives = section.drives(modes);
        let states = match &section.layout {
            Layout::General(_) => drives.clone(),
            Layout::Shared { lags, .. } => vec![*modes; lags.len()],
        };
        Self { states, drives, lags: section.lags }
    }

    /// The lag states, in the order of [`SectionCoefficients::lags`].
    pub fn states(&self) -> &[f64] {
        &self.states.as_flattened()[..self.lags]
    }

    /// Jumps to other inputs in no time: the lag states stay, the next ramp starts from here.
    ///
    /// # Errors
    /// [`AeroError::StateMismatch`] if the state belongs to coefficients of another structure.
    pub fn jump(&mut self, section: &MarchingSection, modes: &[f64; 4]) -> Result<(), AeroError> {
        self.check(section)?;
        self.check_drives(section)?;
        self.drives = section.drives(modes);
        Ok(())
    }

    /// Advances by `semichords`, over which the inputs run straight to `inputs`, and returns
    /// `[Cn, Cm, Ch]` at the end.
    ///
    /// The section may change from step to step with the Mach number (same model and flap).
    ///
    /// # Errors
    /// [`AeroError::StateMismatch`] if the state belongs to coefficients of another structure;
    /// [`AeroError::BadInput`] if the step is negative, or a number is not finite; the state is
    /// then unchanged.
    #[inline]
    pub fn step(
        &mut self,
        section: &MarchingSection,
        inputs: &SectionInputs,
        semichords: f64,
    ) -> Result<[f64; 3], AeroError> {
        self.check(section)?;
        check_step(semichords)?;
        check_inputs(inputs)?;
        let step = [semichords, 1.0 / semichords];
        self.check_drives(section)?;
        let mut decays = section.decaying().iter().map(|block| block.decay(step));
        Ok(self.advance(section, inputs, &mut decays))
    }

    /// [`step`](Self::step) with factors computed beforehand, for steps of constant length.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    #[inline]
    pub fn step_with(
        &mut self,
        section: &MarchingSection,
        inputs: &SectionInputs,
        factors: &StepFactors,
    ) -> Result<[f64; 3], AeroError> {
        self.check(section)?;
        check_lags(factors.lags, section.lags)?;
        check_inputs(inputs)?;
        self.check_drives(section)?;
        Ok(self.advance(section, inputs, &mut factors.blocks.iter().copied()))
    }

    /// `[Cn, Cm, Ch]` of these inputs with the lag states as they are.
    ///
    /// # Errors
    /// [`AeroError::StateMismatch`] if the state belongs to coefficients of another structure.
    pub fn loads(
        &self,
        section: &MarchingSection,
        inputs: &SectionInputs,
    ) -> Result<[f64; 3], AeroError> {
        self.check(section)?;
        let mut sums = [[0.0; LANES]; 3];
        let mut add_all = |output: &[Lanes; 3], state: &Lanes| {
            for (sum, weights) in sums.iter_mut().zip(output) {
                *sum = add(*sum, weights, state);
            }
        };
        match &section.layout {
            Layout::General(blocks) => blocks
                .iter()
                .zip(&self.states)
                .for_each(|(block, state)| add_all(&block.output, state)),
            Layout::Shared { lags, .. } => {
                lags.iter().zip(&self.states).for_each(|(lags, state)| add_all(&lags.output, state))
            }
        }
        Ok(total(section.loads_at_once(inputs), &sums))
    }

    #[inline]
    fn advance(
        &mut self,
        section: &MarchingSection,
        inputs: &SectionInputs,
        decays: &mut impl Iterator<Item = Decay>,
    ) -> [f64; 3] {
        let sums = match &section.layout {
            Layout::General(blocks) => self.advance_blocks(blocks, &inputs.modes, decays),
            Layout::Shared { lags, .. } => self.advance_shared(lags, &inputs.modes, decays),
        };
        total(section.loads_at_once(inputs), &sums)
    }

    #[inline]
    fn advance_blocks(
        &mut self,
        blocks: &[Block],
        modes: &[f64; 4],
        decays: &mut impl Iterator<Item = Decay>,
    ) -> [Lanes; 3] {
        let [mut lift, mut moment, mut hinge] = [[0.0; LANES]; 3];
        for (((block, Decay { gone, mean }), state), drive) in
            blocks.iter().zip(decays).zip(&mut self.states).zip(&mut self.drives)
        {
            // through local arrays: four lags stay together, in registers
            let (old, before) = (*drive, *state);
            let target = block.drive(modes);
            let after: Lanes = std::array::from_fn(|lane| {
                let behind = before[lane] - old[lane];
                target[lane] - (target[lane] - old[lane]) * mean[lane]
                    + (behind - behind * gone[lane])
            });
            *drive = target;
            *state = after;
            lift = add(lift, &block.output[0], &after);
            moment = add(moment, &block.output[1], &after);
            hinge = add(hinge, &block.output[2], &after);
        }
        [lift, moment, hinge]
    }

    #[inline]
    fn advance_shared(
        &mut self,
        lags: &[Shared],
        modes: &[f64; 4],
        decays: &mut impl Iterator<Item = Decay>,
    ) -> [Lanes; 3] {
        let [mut lift, mut moment, mut hinge] = [[0.0; LANES]; 3];
        let target = *modes;
        let old = self.drives.first().copied().unwrap_or_default();
        let change: Lanes = std::array::from_fn(|lane| target[lane] - old[lane]);
        for ((lags, states), Decay { gone, mean }) in
            lags.chunks(LANES).zip(self.states.chunks_mut(LANES)).zip(decays)
        {
            for (((lag, state), gone), mean) in lags.iter().zip(states).zip(gone).zip(mean) {
                let before = *state;
                let after: Lanes = std::array::from_fn(|lane| {
                    let behind = before[lane] - old[lane];
                    target[lane] - change[lane] * mean + (behind - behind * gone)
                });
                *state = after;
                lift = add(lift, &lag.output[0], &after);
                moment = add(moment, &lag.output[1], &after);
                hinge = add(hinge, &lag.output[2], &after);
            }
        }
        if let Some(drive) = self.drives.first_mut() {
            *drive = target;
        }
        [lift, moment, hinge]
    }

    /// A state of the same number of lags may still belong to lags of another kind.
    #[inline]
    fn check_drives(&self, section: &MarchingSection) -> Result<(), AeroError> {
        let needed = match &section.layout {
            Layout::General(blocks) => blocks.len(),
            Layout::Shared { .. } => 1,
        };
        check_lags(self.drives.len() * LANES, needed * LANES)
    }

    fn check(&self, section: &MarchingSection) -> Result<(), AeroError> {
        check_lags(self.lags, section.lags)
    }
}

/// Adds a block's share of one load, lag by lag.
#[inline]
fn add(sum: Lanes, weights: &Lanes, state: &Lanes) -> Lanes {
    std::array::from_fn(|lane| sum[lane] + weights[lane] * state[lane])
}

/// The loads at once and those of the lags.
#[inline]
fn total(at_once: [f64; 3], sums: &[Lanes; 3]) -> [f64; 3] {
    std::array::from_fn(|o| at_once[o] + ((sums[o][0] + sums[o][1]) + (sums[o][2] + sums[o][3])))
}

fn check_lags(state: usize, coefficients: usize) -> Result<(), AeroError> {
    if state == coefficients {
        return Ok(());
    }
    Err(AeroError::StateMismatch { state, coefficients })
}

fn check_step(semichords: f64) -> Result<(), AeroError> {
    if semichords.is_finite() && semichords >= 0.0 {
        return Ok(());
    }
    Err(AeroError::BadInput {
        quantity: "step, semichords",
        value: semichords,
        expected: "a finite number, 0 or more",
    })
}

#[inline]
fn check_inputs(inputs: &SectionInputs) -> Result<(), AeroError> {
    // finite numbers times zero are zero; anything else is not
    let nothing: [f64; 4] = std::array::from_fn(|i| inputs.modes[i] * 0.0 + inputs.rates[i] * 0.0);
    if (nothing[0] + nothing[1]) + (nothing[2] + nothing[3]) == 0.0 {
        return Ok(());
    }
    let mut all = inputs.modes.iter().chain(&inputs.rates).copied();
    Err(AeroError::BadInput {
        quantity: "input of the section (alpha, q, delta, q_delta or a rate of them)",
        value: all.find(|value| !value.is_finite()).unwrap_or(f64::NAN),
        expected: "a finite number",
    })
}
