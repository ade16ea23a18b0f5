//! Time marching of a section: recurrence exact for inputs that change linearly over a step.

use crate::AeroError;
use crate::motion::decay::{Decay, LANES, Lanes};
use crate::motion::layout::{
    Block, Layout, MOST_SHARED, MarchingSection, SectionInputs, StepFactors, check_step, one_by_one,
};

/// Added and subtracted it turns numbers below some 1e-266 into zero and leaves others alone.
const NOTHING: f64 = 1e-250;

/// Lag states of a section on its way through time.
///
/// ```text
/// x1 = u1 - (u1 - u0) g + (x0 - u0) e^(-z),     z = pole dS,   g = (1 - e^(-z)) / z,   u = input . m
/// ```
/// The solution of `dx/dS = pole (u - x)` for a `u` that runs straight from `u0` to `u1`: exact on a
/// ramp, second order otherwise, and stable for any step however stiff the lag.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionState {
    /// The states; for shared poles what they lack of their inputs, `x - m`.
    states: Vec<Lanes>,
    /// What the states follow: block by block, or once for all if they share the inputs.
    drives: Vec<Lanes>,
    shared: bool,
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
        let (states, shared) = match &section.layout {
            Layout::General(_) => (drives.clone(), false),
            Layout::Shared(shared) => (vec![[0.0; LANES]; shared.output.len()], true),
        };
        Self { states, drives, shared, lags: section.lags }
    }

    /// The lag states, in the order of [`crate::SectionCoefficients::lags`].
    pub fn states(&self) -> Vec<f64> {
        let behind = self.states.as_flattened().iter();
        let input = |i: usize| if self.shared { self.drives[0][i % LANES] } else { 0.0 };
        behind.take(self.lags).enumerate().map(|(i, x)| x + input(i)).collect()
    }

    /// Number of lag states.
    pub(crate) fn lags(&self) -> usize {
        self.lags
    }

    /// `self + share (other - self)`, lag by lag, for a state of the same inputs.
    pub(crate) fn moved_toward(&self, other: &Self, shares: &[f64]) -> Result<Self, AeroError> {
        check_lags(shares.len(), self.lags)?;
        let mut moved = other.clone();
        let before = self.states.as_flattened();
        let after = moved.states.as_flattened_mut();
        for ((x, from), share) in after.iter_mut().zip(before).zip(shares) {
            *x = from + share * (*x - from);
        }
        Ok(moved)
    }

    /// Jumps to other inputs in no time: the lag states stay, the next ramp starts from here.
    ///
    /// # Errors
    /// [`AeroError::StateMismatch`] if the state belongs to coefficients of another structure.
    pub fn jump(&mut self, section: &MarchingSection, modes: &[f64; 4]) -> Result<(), AeroError> {
        self.check(section)?;
        let drives = section.drives(modes);
        if self.shared {
            // the states stay, so what they lack changes
            let change: Lanes = std::array::from_fn(|lane| drives[0][lane] - self.drives[0][lane]);
            for behind in &mut self.states {
                *behind = std::array::from_fn(|lane| behind[lane] - change[lane]);
            }
        }
        self.drives = drives;
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
        let decays = section.decaying().iter().map(|block| block.decay(step));
        let sums = match &section.layout {
            Layout::General(blocks) => self.advance_blocks(blocks, &inputs.modes, decays),
            Layout::Shared(shared) => {
                self.advance_shared(&shared.output, &inputs.modes, &one_by_one(decays))
            }
        };
        Ok(total(section.loads_at_once(inputs), &sums))
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
        let sums = match &section.layout {
            Layout::General(blocks) => {
                self.advance_blocks(blocks, &inputs.modes, factors.blocks.iter().copied())
            }
            Layout::Shared(shared) => {
                self.advance_shared(&shared.output, &inputs.modes, &factors.shared)
            }
        };
        Ok(total(section.loads_at_once(inputs), &sums))
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
            Layout::Shared(shared) => {
                // these inputs may be others than those the states were left with
                let change: Lanes =
                    std::array::from_fn(|lane| self.drives[0][lane] - inputs.modes[lane]);
                for (output, behind) in shared.output.iter().zip(&self.states) {
                    add_all(output, &std::array::from_fn(|lane| behind[lane] + change[lane]));
                }
            }
        }
        Ok(total(section.loads_at_once(inputs), &sums))
    }

    #[inline]
    fn advance_blocks(
        &mut self,
        blocks: &[Block],
        modes: &[f64; 4],
        decays: impl Iterator<Item = Decay>,
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

    /// ```text
    /// y1 = y0 e^(-z) - (m1 - m0) g,     y = x - m
    /// ```
    #[inline]
    fn advance_shared(
        &mut self,
        output: &[[Lanes; 3]],
        modes: &[f64; 4],
        decays: &[[f64; 2]; MOST_SHARED],
    ) -> [Lanes; 3] {
        let [mut lift, mut moment, mut hinge] = [[0.0; LANES]; 3];
        let old = self.drives.first_mut();
        let Some(old) = old else {
            return [lift, moment, hinge];
        };
        let change: Lanes = std::array::from_fn(|lane| modes[lane] - old[lane]);
        *old = *modes;
        for ((weights, behind), [gone, mean]) in output.iter().zip(&mut self.states).zip(decays) {
            let before = *behind;
            let after: Lanes = std::array::from_fn(|lane| {
                let left = before[lane] - before[lane] * gone - change[lane] * mean;
                // what has died away is nothing: numbers below the normal ones are slow
                (left + NOTHING) - NOTHING
            });
            *behind = after;
            lift = add(lift, &weights[0], &after);
            moment = add(moment, &weights[1], &after);
            hinge = add(hinge, &weights[2], &after);
        }
        [lift, moment, hinge]
    }

    fn check(&self, section: &MarchingSection) -> Result<(), AeroError> {
        check_lags(self.lags, section.lags)?;
        // the same number of lags may still be lags of another kind
        if self.shared == matches!(section.layout, Layout::Shared(_)) {
            return Ok(());
        }
        Err(AeroError::StateMismatch { state: self.lags, coefficients: section.lags })
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
