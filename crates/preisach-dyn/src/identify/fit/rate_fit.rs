//! The rate maps `G1` and `G2` from steady cycles, by constrained least squares.

use crate::identify::fit::program::{LeastSquaresProgram, Row};
use crate::identify::fit::static_fit::{merged, numbered};
use crate::identify::fit::training::Training;
use crate::laws::play_map::split;
use crate::{DynamicParameters, DynamicPreisach, PlayMap, PreisachError, PreisachGrid, RateForm};

/// Part of the room up to the fold that the fit may use; the rest covers the solver's tolerance.
const FOLD_ROOM: f64 = 0.98;
/// Rounds of cutting planes before `G2` is scaled into the cone instead.
const MOST_CUTS: usize = 60;

/// The two rate maps on the coarse grid of the rate levels.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RateMaps {
    g1_s: PlayMap,
    g2_s2_per_deg: PlayMap,
    /// Output rate up to which no reachable state folds, deg/s.
    unfolded_rate_deg_s: f64,
}

impl RateMaps {
    /// The dynamic model of these maps with a static map.
    pub(crate) fn model(
        &self,
        training: &Training,
        g0_deg: &PlayMap,
    ) -> Result<DynamicPreisach, PreisachError> {
        let settings = training.settings;
        let factor = settings.levels / settings.rate_levels;
        DynamicPreisach::new(DynamicParameters {
            grid: training.grid,
            g0_deg: g0_deg.clone(),
            g1_s: self.g1_s.refined(factor),
            g2_s2_per_deg: self.g2_s2_per_deg.refined(factor),
            form: settings.form,
            unfolded_rate_deg_s: self.unfolded_rate_deg_s,
            time_order: settings.time_order,
        })
    }
}

/// Equation error of one steady sample: everything that is known in
/// `delta - G0 = d G1 + d^2 G2`.
struct Sample {
    /// Coarse hat functions: node index and weight.
    hats: Row,
    rate_deg_s: f64,
    beyond_static_deg: f64,
    weight: f64,
    record: usize,
}

/// `G1` and `G2` that fit the steady cycles of the records, given `G0`.
///
/// ```text
/// delta_i - G0_i = -tau(x_i) d_i + G2(x_i) d_i^2 + offset_record,     G1 = -tau
/// WellPosed:  tau = tau0 + sum_jk f_jk N_jk,  tau0 >= tau_min,  f_jk >= 0,
///             2 D |G2| <= tau  in every reachable state,  D = 1.5 max |d|
/// Literal:    no constants, opposite values at both ends of every play, no bounds
/// ```
/// `delta` and `d` are the Fourier series of the averaged cycles. Records weigh alike, each row by
/// what a residual means for the output behind a lag of the mean relaxation time. The cone of the
/// bound `f >= 0` contains all `sum p (1 + gamma) / 2 + sum q (1 - gamma) / 2` with `p, q >= 0`.
/// The bound on `G2` is met by cutting planes: the worst reachable state, found exactly by
/// [`PlayMap::largest`], joins the constraints until none is left.
pub(crate) fn fit(
    training: &Training,
    g0_deg: &PlayMap,
    smoothness: f64,
) -> Result<RateMaps, PreisachError> {
    let Training { grid, settings, fast: records, .. } = training;
    let coarse = PreisachGrid::new(grid.range(), settings.rate_levels)?;
    let unknowns = Unknowns::new(&coarse);
    let (samples, scale) = equation_samples(&unknowns, g0_deg, training);

    let literal = settings.form == RateForm::Literal;
    // unknowns in units of the mean relaxation time and of what it leaves to G2
    let g2_unit = scale.lag_s / scale.rate_deg_s;
    let first_offset = 2 * unknowns.count;
    let mut program = LeastSquaresProgram::new(first_offset + records.len());
    for sample in &samples {
        let d = sample.rate_deg_s;
        let mut row = Row::with_capacity(2 * sample.hats.len() + 1);
        row.extend(sample.hats.iter().map(|&(i, a)| (i, -a * d * scale.lag_s)));
        let quadratic = d * d * g2_unit;
        row.extend(sample.hats.iter().map(|&(i, a)| (unknowns.count + i, a * quadratic)));
        row.push((first_offset + sample.record, 1.0));
        program.add(&row, sample.beyond_static_deg, sample.weight);
    }
    for base in [0, unknowns.count] {
        unknowns.smooth(base, smoothness, &mut program);
        if literal {
            for j in 0..coarse.levels() {
                let ends = [unknowns.node(j, 0), unknowns.node(j, coarse.knots(j) - 1)];
                program.equal_zero(ends.map(|end| (base + end, 1.0)).to_vec());
            }
            program.equal_zero(vec![(base, 1.0)]);
        }
    }
    if !literal {
        program.at_least(vec![(0, 1.0)], settings.least_relaxation_s / scale.lag_s);
        (1..unknowns.count).for_each(|i| program.at_least(vec![(i, 1.0)], 0.0));
    }

    let unfolded_rate_deg_s = scale.rate_deg_s;
    let mut cuts = 0;
    loop {
        let x = program.solve("rate maps")?;
        let floor = |v: f64| if literal { v } else { v.max(0.0) };
        let mut lag: Vec<f64> = x[..unknowns.count].iter().map(|&v| floor(v)).collect();
        if !literal {
            lag[0] = lag[0].max(settings.least_relaxation_s / scale.lag_s);
        }
        let g1_s = unknowns.map(&coarse, &lag, -scale.lag_s);
        let mut g2 = unknowns.map(&coarse, &x[unknowns.count..first_offset], g2_unit);
        if literal {
            return Ok(RateMaps { g1_s, g2_s2_per_deg: g2, unfolded_rate_deg_s });
        }
        let mut worst = 0.0_f64;
        for sign in [1.0, -1.0] {
            let slack = g1_s.combined(1.0, &g2, 2.0 * sign * unfolded_rate_deg_s);
            let (excess_s, state) = slack.largest();
            worst = worst.max(excess_s);
            if excess_s > 0.0 {
                // FOLD_ROOM tau - 2 D sign G2 >= 0 in that state
                let mut row: Row = vec![(0, FOLD_ROOM), (unknowns.count, -2.0 * sign)];
                for (j, &k) in state.iter().enumerate() {
                    let i = unknowns.node(j, k);
                    row.push((i, FOLD_ROOM));
                    row.push((unknowns.count + i, -2.0 * sign));
                }
                program.at_least(merged(row), 0.0);
            }
        }
        if worst > 0.0 && cuts >= MOST_CUTS {
            let room = room_for_g2(&g1_s, &g2, unfolded_rate_deg_s);
            g2 = g2.combined(room.min(1.0), &g2, 0.0);
            worst = 0.0;
        }
        if worst <= 0.0 {
            return Ok(RateMaps { g1_s, g2_s2_per_deg: g2, unfolded_rate_deg_s });
        }
        cuts += 1;
    }
}

/// The largest factor on `G2` that keeps `2 D |G2| <= FOLD_ROOM tau` in every reachable state.
pub(crate) fn room_for_g2(g1_s: &PlayMap, g2: &PlayMap, rate_deg_s: f64) -> f64 {
    let fits = |factor: f64| {
        [1.0, -1.0].iter().all(|sign| {
            let twice = 2.0 * sign * rate_deg_s * factor;
            g1_s.combined(FOLD_ROOM, g2, twice).largest().0 <= 0.0
        })
    };
    let (mut low, mut high) = (0.0, 1.0);
    while fits(high) && high < 1e6 {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if fits(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Sizes that make the unknowns of order one.
struct Scale {
    lag_s: f64,
    rate_deg_s: f64,
}

fn equation_samples(
    unknowns: &Unknowns,
    g0_deg: &PlayMap,
    training: &Training,
) -> (Vec<Sample>, Scale) {
    let Training { settings, fast: records, .. } = training;
    let factor = settings.levels / settings.rate_levels;
    let mut samples = Vec::new();
    for (index, record) in records.iter().enumerate() {
        let Some(cycles) = &record.cycles else {
            continue;
        };
        let count = record.samples.len() as f64;
        for (i, cells) in record.states() {
            let (output_deg, per_sample) = cycles.value_and_rate(i);
            samples.push(Sample {
                hats: unknowns.hats(cells, factor),
                rate_deg_s: per_sample / record.record.time_step_s,
                beyond_static_deg: output_deg - g0_deg.value_at(cells),
                weight: 1.0 / (count * records.len() as f64),
                record: index,
            });
        }
    }
    let fastest = samples.iter().fold(0.0_f64, |m, s| m.max(s.rate_deg_s.abs()));
    let (against, squares) = samples.iter().fold((0.0, 0.0), |(a, b), s| {
        let weighted = s.weight * s.rate_deg_s;
        (a - weighted * s.beyond_static_deg, b + weighted * s.rate_deg_s)
    });
    let lag_s = if against > 0.0 { against / squares } else { settings.least_relaxation_s };
    let lag_s = lag_s.max(settings.least_relaxation_s);
    for sample in &mut samples {
        let record = records[sample.record];
        let omega = std::f64::consts::TAU * record.drive.strongest_hz();
        let size = record.spread_deg;
        sample.weight /= size * size * (1.0 + (omega * lag_s).powi(2));
    }
    (samples, Scale { lag_s, rate_deg_s: settings.rate_margin * fastest })
}

/// Numbering of one rate map: its constant, then all nodes, play by play.
struct Unknowns {
    starts: Vec<usize>,
    knots: Vec<usize>,
    count: usize,
}

impl Unknowns {
    fn new(coarse: &PreisachGrid) -> Self {
        let knots: Vec<usize> = (0..coarse.levels()).map(|j| coarse.knots(j)).collect();
        let (starts, count) = numbered(knots.iter().copied());
        Self { starts, knots, count }
    }

    fn node(&self, j: usize, k: usize) -> usize {
        self.starts[j] + k
    }

    /// Constant and hat functions on the coarse grid, from a state on the fine one.
    fn hats(&self, cells: &[f64], factor: usize) -> Row {
        let mut row: Row = vec![(0, 1.0)];
        for (j, &x) in cells.iter().step_by(factor).enumerate() {
            let (k, t) = split(x / factor as f64);
            row.push((self.node(j, k), 1.0 - t));
            if t > 0.0 {
                row.push((self.node(j, k + 1), t));
            }
        }
        row
    }

    /// Penalises differences between neighbouring nodes, and (a hundredth of it) the nodes
    /// themselves: what the records do not show is left to the constant.
    fn smooth(&self, base: usize, smoothness: f64, program: &mut LeastSquaresProgram) {
        let nodes = self.count as f64;
        for (j, &knots) in self.knots.iter().enumerate() {
            for k in 0..knots {
                let here = base + self.node(j, k);
                program.add(&[(here, 1.0)], 0.0, 0.01 * smoothness * nodes);
                if k + 1 < knots {
                    program.add(&[(here, 1.0), (here + 1, -1.0)], 0.0, smoothness * nodes);
                }
            }
        }
        program.add(&[(base, 1.0)], 0.0, 1e-9);
    }

    fn map(&self, coarse: &PreisachGrid, values: &[f64], scale: f64) -> PlayMap {
        let nodes = (0..coarse.levels())
            .map(|j| {
                let start = self.starts[j];
                values[start..start + self.knots[j]].iter().map(|v| v * scale).collect()
            })
            .collect();
        PlayMap { constant: values[0] * scale, nodes }
    }
}
