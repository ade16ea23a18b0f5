//! All lags of a station as one operator from the inputs of its section to their share in its outputs.
//!
//! The channels of [`PeriodicLag`] are linear in the inputs `w`. Inside one time element the output `o` at
//! its points is
//!
//! ```text
//! y_o = sum_i K_oi w_i + sum_c (gain_oc alpha_c) x0_c        K_oi = sum_c gain_oc B_c input_ci
//! x0_c of the next element = e_c x0_c + sum_i (input_ci f_c) . w_i
//! ```
//! with `x0_c` the state of channel `c` at the start of the element: a table that is read once from front to back
//! and holds the channels only where they start.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use crate::sections::station_lag::{CIRCULATORY_LIFT, StationLag};
use pulp::{Arch, Simd, WithSimd};

/// Points, or channels, that are summed side by side.
const LANES: usize = 8;
/// Outputs: lift, moment, hinge moment, and the parts of the rigid section and of the circulation in the lift.
const OUTPUTS: usize = CIRCULATORY_LIFT + 1;
type Lanes = [f64; LANES];

/// One output and the channels it has.
#[derive(Debug, Clone)]
struct Output {
    place: usize,
    channels: Vec<usize>,
}

/// The lags of one station over a revolution.
#[derive(Debug, Clone, Default)]
pub(crate) struct StationLags {
    points_per_element: usize,
    elements: usize,
    /// Inputs that drive a channel, in the order of the section's.
    inputs: Vec<usize>,
    outputs: Vec<Output>,
    /// Number of channels over [`LANES`], rounded up.
    channel_blocks: usize,
    /// Element by element, block by block of channels: `e`, then a column of `input f` for every input and point.
    ends: Vec<Lanes>,
    /// One less the product of all `e`, by channel.
    closing: Vec<Lanes>,
    /// Element by element, output by output, block by block of points: a column of `K` for every input and
    /// point, then one of `gain alpha` for every channel of the output.
    columns: Vec<Lanes>,
}

/// Reusable arrays.
#[derive(Debug, Default)]
pub(crate) struct LagScratch {
    /// Element by element, input by input: the inputs at its points.
    factors: Vec<f64>,
    /// What the inputs leave at the end of every element, by block of channels.
    left: Vec<Lanes>,
    /// States of the channels at the start of an element.
    start: Vec<Lanes>,
    /// Element by element, output by output, block by block of points.
    sums: Vec<Lanes>,
}

/// `sum_k factor_k column_k`.
#[inline(always)]
fn combined(columns: &[Lanes], factors: &[f64]) -> Lanes {
    let mut sums = [0.0; LANES];
    for (column, factor) in columns.iter().zip(factors) {
        for (sum, value) in sums.iter_mut().zip(column) {
            *sum += factor * value;
        }
    }
    sums
}

impl StationLags {
    /// The operator of some channels at elements of so many points.
    pub(crate) fn new(lags: &[StationLag], points_per_element: usize) -> Self {
        let g = points_per_element;
        let inputs: Vec<usize> =
            (0..4).filter(|i| lags.iter().any(|lag| lag.channel.input[*i] != 0.0)).collect();
        let has = |lag: &StationLag, place: usize| lag.channel.gain(place).is_some();
        let outputs: Vec<Output> = (0..OUTPUTS)
            .map(|place| {
                let channels = (0..lags.len()).filter(|c| has(&lags[*c], place)).collect();
                Output { place, channels }
            })
            .filter(|output| !output.channels.is_empty())
            .collect();
        let elements = lags.first().map_or(0, |lag| lag.channel.rates.len() / g);
        let channel_blocks = lags.len().div_ceil(LANES);
        let mut of = Self {
            points_per_element,
            elements,
            inputs,
            outputs,
            channel_blocks,
            closing: vec![[1.0; LANES]; channel_blocks],
            ..Self::default()
        };
        for (c, lag) in lags.iter().enumerate() {
            of.closing[c / LANES][c % LANES] = lag.lag.closing();
        }
        for element in 0..elements {
            of.add_ends(lags, element);
            of.add_columns(lags, element);
        }
        of
    }

    fn add_ends(&mut self, lags: &[StationLag], element: usize) {
        let g = self.points_per_element;
        for block in lags.chunks(LANES) {
            let mut columns = vec![[0.0; LANES]; 1 + self.inputs.len() * g];
            for (lane, lag) in block.iter().enumerate() {
                let table = lag.lag.element(element);
                columns[0][lane] = table.end_start;
                for (i, input) in self.inputs.iter().enumerate() {
                    for (j, f) in table.end_drive.iter().enumerate() {
                        columns[1 + i * g + j][lane] = lag.channel.input[*input] * f;
                    }
                }
            }
            self.ends.extend(columns);
        }
    }

    fn add_columns(&mut self, lags: &[StationLag], element: usize) {
        let g = self.points_per_element;
        for output in &self.outputs {
            let count = self.inputs.len() * g;
            let mut columns = vec![vec![0.0; g]; count + output.channels.len()];
            for (k, c) in output.channels.iter().enumerate() {
                let lag = &lags[*c];
                let Some(gains) = lag.channel.gain(output.place) else { continue };
                let gains = &gains[element * g..(element + 1) * g];
                let table = lag.lag.element(element);
                for (start, (gain, alpha)) in
                    columns[count + k].iter_mut().zip(gains.iter().zip(table.start))
                {
                    *start = gain * alpha;
                }
                for (i, input) in self.inputs.iter().enumerate() {
                    let weight = lag.channel.input[*input];
                    for (j, drive) in table.drive.chunks_exact(g).enumerate() {
                        let sums = columns[i * g + j].iter_mut();
                        for (sum, (gain, b)) in sums.zip(gains.iter().zip(drive)) {
                            *sum += gain * b * weight;
                        }
                    }
                }
            }
            for from in (0..g).step_by(LANES) {
                let lanes = |column: &Vec<f64>| -> Lanes {
                    std::array::from_fn(|lane| column.get(from + lane).copied().unwrap_or(0.0))
                };
                self.columns.extend(columns.iter().map(lanes));
            }
        }
    }

    /// The share of the lags in the outputs of the section at all points, for its inputs by point and number; `write` is
    /// told point, output and share.
    pub(crate) fn outputs(
        &self,
        inputs: impl Fn(usize, usize) -> f64,
        scratch: &mut LagScratch,
        mut write: impl FnMut(usize, usize, f64),
    ) {
        let g = self.points_per_element;
        scratch.factors.clear();
        for element in 0..self.elements {
            for input in &self.inputs {
                scratch.factors.extend((0..g).map(|p| inputs(element * g + p, *input)));
            }
        }
        Arch::new().dispatch(Shares { lags: self, scratch });
        let mut sums = scratch.sums.iter();
        for element in 0..self.elements {
            for output in &self.outputs {
                for (point, sum) in (0..g.div_ceil(LANES) * LANES).zip(sums.by_ref().flatten()) {
                    if point < g {
                        write(element * g + point, output.place, *sum);
                    }
                }
            }
        }
    }

    /// `e` and the columns of `input f` of one element and block of channels.
    #[inline(always)]
    fn ends(&self, element: usize, block: usize) -> &[Lanes] {
        let count = 1 + self.inputs.len() * self.points_per_element;
        let from = (element * self.channel_blocks + block) * count;
        &self.ends[from..from + count]
    }
}

/// The sums of all outputs: a type of its own, for a closure would be called, not inlined, by the function that is
/// compiled for the vector unit.
struct Shares<'a> {
    lags: &'a StationLags,
    scratch: &'a mut LagScratch,
}

impl WithSimd for Shares<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let lags = self.lags;
        let (g, blocks) = (lags.points_per_element, lags.channel_blocks);
        let count = lags.inputs.len() * g;
        let LagScratch { factors, left, start, sums } = self.scratch;
        // the way round: what the inputs leave at the end of every element, and the states at the first start
        left.clear();
        sums.clear();
        start.clear();
        start.resize(blocks, [0.0; LANES]);
        for element in 0..lags.elements {
            let drive = &factors[element * count..(element + 1) * count];
            for (block, around) in start.iter_mut().enumerate() {
                let [passed, columns @ ..] = lags.ends(element, block) else { continue };
                let added = combined(columns, drive);
                advance(around, passed, &added);
                left.push(added);
            }
        }
        for (around, closing) in start.iter_mut().zip(&lags.closing) {
            for (x, closing) in around.iter_mut().zip(closing) {
                *x /= closing;
            }
        }
        let mut columns = lags.columns.as_slice();
        for element in 0..lags.elements {
            let drive = &factors[element * count..(element + 1) * count];
            for output in &lags.outputs {
                for _ in 0..g.div_ceil(LANES) {
                    let (driven, rest) = columns.split_at(count);
                    let (started, rest) = rest.split_at(output.channels.len());
                    columns = rest;
                    let mut sum = combined(driven, drive);
                    for (column, c) in started.iter().zip(&output.channels) {
                        let x = start[c / LANES][c % LANES];
                        for (sum, value) in sum.iter_mut().zip(column) {
                            *sum += x * value;
                        }
                    }
                    sums.push(sum);
                }
            }
            for (block, x) in start.iter_mut().enumerate() {
                advance(x, &lags.ends(element, block)[0], &left[element * blocks + block]);
            }
        }
    }
}

/// `x = e x + a` of every channel.
#[inline(always)]
fn advance(x: &mut Lanes, passed: &Lanes, added: &Lanes) {
    for ((x, e), a) in x.iter_mut().zip(passed).zip(added) {
        *x = e * *x + a;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::lag::{Collocation, PeriodicLag};
    use crate::sections::station_lag::SectionChannel;
    use rotor_fem::TimeElements;

    /// Outputs of channels with gains that vary, against the operator of every channel.
    #[test]
    fn the_lags_of_a_station_are_those_of_its_channels() {
        for (elements, gauss, channels) in [(5, 6, 3_u8), (8, 8, 8), (3, 10, 11)] {
            let time = TimeElements::new(elements, 5, gauss).unwrap();
            let psi = time.points();
            let collocation = Collocation::new(&time);
            let lags: Vec<StationLag> = (0..channels)
                .map(|c| {
                    let k = f64::from(c);
                    let rates: Vec<f64> =
                        psi.iter().map(|p| 0.7 + 3.0 * k + 0.5 * p.cos()).collect();
                    let gain = |o: u8| psi.iter().map(|p| (p + k + f64::from(o)).sin()).collect();
                    let mut input = [0.0; 4];
                    (input[usize::from(c) % 3], input[1]) = (1.0, 0.4 * k);
                    let gains = [0, 1, 2].map(|o| (usize::from(o), gain(o)));
                    let gains = gains.into_iter().filter(|g| g.0 <= usize::from(c)).collect();
                    let lag = PeriodicLag::new(&collocation, &rates).unwrap();
                    let (rigid, circulatory) = (c % 2 == 0, c % 3 == 0);
                    let channel = SectionChannel { input, gains, rigid, circulatory, rates };
                    StationLag { channel, lag }
                })
                .collect();
            let inputs: Vec<[f64; 4]> = psi
                .iter()
                .map(|p| [(3.0 * p).cos(), 0.2 + p.sin(), (2.0 * p).sin(), 0.3])
                .collect();
            let mut expected = vec![[0.0; OUTPUTS]; psi.len()];
            for lag in &lags {
                let drive =
                    inputs.iter().map(|w| (0..4).map(|i| lag.channel.input[i] * w[i]).sum::<f64>());
                let drive = nalgebra::DVector::from_iterator(psi.len(), drive);
                let state = lag.lag.operator() * drive;
                for place in 0..OUTPUTS {
                    let Some(gains) = lag.channel.gain(place) else { continue };
                    for ((sum, gain), x) in expected.iter_mut().zip(gains).zip(&state) {
                        sum[place] += gain * x;
                    }
                }
            }
            let mut found = vec![[0.0; OUTPUTS]; psi.len()];
            let station = StationLags::new(&lags, gauss);
            // scratch that another station has used
            let mut scratch = LagScratch::default();
            for _ in 0..2 {
                station.outputs(|p, i| inputs[p][i], &mut scratch, |p, o, y| found[p][o] = y);
            }
            for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
                assert!((found - expected).abs() < 1e-13, "{found} {expected}");
            }
        }
    }
}
