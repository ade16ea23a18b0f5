//! The dynamic Preisach actuator, paper equation (5).

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use crate::check::{check_not_negative, check_that};
use crate::laws::play_map::NodeTable;
use crate::{
    HysteresisLaw, PlayMap, PlayMemory, PreisachError, PreisachGrid, StartState, StaticPreisach,
    StepCounts,
};
use pulp::{Arch, Simd, WithSimd};
use rotor_base::{LANES, Lanes, Number};
use serde::{Deserialize, Serialize};

/// How equation (5) is kept solvable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum RateForm {
    /// The paper as printed: `mu1` and `mu2` of any sign, nothing guaranteed. Steps with `G1 >= 0`
    /// or a negative discriminant are counted; the output may diverge.
    Literal,
    /// `G1 < 0` in every reachable state, checked when the model is built, and no fold up to a
    /// stated output rate.
    #[default]
    WellPosed,
}

/// Order of the time integration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum TimeOrder {
    /// Implicit Euler.
    First,
    /// Two-step backward differences (BDF2, variable step), the first step by implicit Euler.
    #[default]
    Second,
}

/// The root of equation (5) within one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutputRate {
    /// The output rate `d`, deg/s.
    pub rate_deg_s: f64,
    /// Whether the discriminant was negative and the fold was taken.
    pub folded: bool,
}

/// The output rate that satisfies equation (5) at the end of a time step.
///
/// ```text
/// delta = base + weight d   and   delta = G0 + d G1 + d^2 G2
/// =>  G2 d^2 - b d + q = 0,   b = weight - G1,   q = G0 - base
///     d = 2 q / (b + sign(b) sqrt(b^2 - 4 G2 q)),   or d = b / (2 G2) past the fold
/// ```
/// | argument | symbol | unit |
/// |---|---|---|
/// | `g` | `G0, G1, G2` | deg, s, s^2/deg |
/// | `base` | | deg; the previous output for implicit Euler |
/// | `weight` | | s; the time step for implicit Euler |
///
/// The root is the one that stays finite as `G2 -> 0`.
/// Source: Viswamurthy and Ganguli, equation (5); how to solve it for `d` is not said there.
#[inline(always)]
pub fn output_rate(g: [f64; 3], base: f64, weight: f64) -> OutputRate {
    let [g0, g1, g2] = g;
    let b = weight - g1;
    let q = g0 - base;
    let discriminant = b * b - 4.0 * g2 * q;
    let folded = discriminant < 0.0;
    let denominator = b + discriminant.sqrt().copysign(b);
    // one quotient, and no branch: side by side, every lane goes the same way
    let (over, under) = if folded { (b, 2.0 * g2) } else { (2.0 * q, denominator) };
    let quotient = over / under;
    let rate_deg_s = if !folded && q == 0.0 { 0.0 } else { quotient };
    OutputRate { rate_deg_s, folded }
}

/// The backward difference `delta_{n+1} = base + weight d`, `base = (now delta_n - before delta_{n-1}) scale`.
///
/// ```text
/// Euler:  base = delta_n,  weight = h
/// BDF2:   delta_{n+1} = [ (1+w)^2 delta_n - w^2 delta_{n-1} + (1+w) h d ] / (1 + 2 w),  w = h / h_n
/// ```
/// Source: Hairer, Norsett, Wanner, *Solving Ordinary Differential Equations I*, section III.5.
#[derive(Debug, Clone, Copy)]
struct BackwardDifference<T> {
    now: T,
    before: T,
    scale: T,
    /// s.
    weight: T,
}

impl BackwardDifference<f64> {
    /// Of a step after an earlier one, if there was one; lengths in s.
    fn new(order: TimeOrder, step_s: f64, earlier_step_s: Option<f64>) -> Self {
        match (order, earlier_step_s) {
            (TimeOrder::Second, Some(earlier_step_s)) => {
                let w = step_s / earlier_step_s;
                let scale = 1.0 / (1.0 + 2.0 * w);
                let plus = 1.0 + w;
                Self { now: plus * plus, before: w * w, scale, weight: plus * step_s * scale }
            }
            _ => Self { now: 1.0, before: 0.0, scale: 1.0, weight: step_s },
        }
    }
}

impl<T: Number> BackwardDifference<T> {
    #[inline(always)]
    fn base(&self, now: T, before: T) -> T {
        (self.now * now - self.before * before) * self.scale
    }
}

impl From<[BackwardDifference<f64>; LANES]> for BackwardDifference<Lanes> {
    fn from(lanes: [BackwardDifference<f64>; LANES]) -> Self {
        Self {
            now: Lanes(lanes.map(|of| of.now)),
            before: Lanes(lanes.map(|of| of.before)),
            scale: Lanes(lanes.map(|of| of.scale)),
            weight: Lanes(lanes.map(|of| of.weight)),
        }
    }
}

/// The output history the time integration looks back on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OutputHistory {
    /// Present output, deg.
    pub output_deg: f64,
    /// Output one step earlier and the length of that step in seconds, if there was one.
    pub earlier: Option<(f64, f64)>,
}

impl OutputHistory {
    /// An actuator at rest.
    pub fn at_rest(output_deg: f64) -> Self {
        Self { output_deg, earlier: None }
    }

    /// One time step on with the maps `G0, G1, G2` there; whether it was a fold.
    #[inline]
    fn advance(&mut self, g: [f64; 3], order: TimeOrder, step_s: f64) -> bool {
        let (earlier_deg, earlier_step_s) = self.earlier.unzip();
        let difference = BackwardDifference::new(order, step_s, earlier_step_s);
        let base = difference.base(self.output_deg, earlier_deg.unwrap_or_default());
        let OutputRate { rate_deg_s, folded } = output_rate(g, base, difference.weight);
        let output_deg = base + difference.weight * rate_deg_s;
        *self = Self { output_deg, earlier: Some((self.output_deg, step_s)) };
        folded
    }
}

/// A dynamic Preisach actuator: `delta = G0 + d G1 + d^2 G2`, `d = d(delta)/dt`.
///
/// The three maps share one memory of plays. With the voltage held, `-G1` is the relaxation time of
/// the state the actuator is in.
///
/// Not modelled: creep over minutes, resonance, load, heating.
/// Source: Viswamurthy and Ganguli, equations (3) to (5), after Mayergoyz (1988).
/// Differs from source: `G1` may carry a constant, a relaxation time common to all states; without
/// it `G1` vanishes at both saturations of a symmetric actuator and a plain lag is outside the
/// model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "DynamicParameters", into = "DynamicParameters")]
pub struct DynamicPreisach {
    parameters: DynamicParameters,
    /// Values of `G0, G1, G2` at every node, then their rises to the next.
    table: NodeTable<[f64; 6]>,
}

/// The numbers that make a [`DynamicPreisach`], as they are written to files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DynamicParameters {
    /// Levels and voltage range of the shared memory.
    pub grid: PreisachGrid,
    /// Static map `G0`, deg.
    pub g0_deg: PlayMap,
    /// Map `G1`, s.
    pub g1_s: PlayMap,
    /// Map `G2`, s^2/deg.
    pub g2_s2_per_deg: PlayMap,
    /// What is guaranteed.
    pub form: RateForm,
    /// Output rate up to which no reachable state folds, deg/s. Checked for
    /// [`RateForm::WellPosed`], a remark otherwise.
    pub unfolded_rate_deg_s: f64,
    /// Order of the time integration.
    pub time_order: TimeOrder,
}

stored_as_parameters!(DynamicPreisach, DynamicParameters);

impl DynamicPreisach {
    /// The model of the given maps, checked over *all* reachable states.
    ///
    /// ```text
    /// WellPosed:  max G1 < 0,   max (2 d |G2| + G1) <= 0  at d = unfolded_rate_deg_s
    /// ```
    /// The second makes every fold lie at an output rate of at least `unfolded_rate_deg_s`: a fold
    /// needs `d >= b / (2 |G2|)` and `b >= -G1`.
    ///
    /// # Errors
    /// [`PreisachError::NodeCount`], [`PreisachError::NotFinite`],
    /// [`PreisachError::OutOfRange`], or [`PreisachError::OutOfRange`] for a model that is not well
    /// posed or folds too early.
    pub fn new(parameters: DynamicParameters) -> Result<Self, PreisachError> {
        let p = &parameters;
        p.g0_deg.check(&p.grid, "g0_deg")?;
        p.g1_s.check(&p.grid, "g1_s")?;
        p.g2_s2_per_deg.check(&p.grid, "g2_s2_per_deg")?;
        p.g0_deg.check_rising()?;
        let rate = p.unfolded_rate_deg_s;
        check_not_negative("unfolded_rate_deg_s", rate)?;
        if p.form == RateForm::WellPosed {
            let (largest_g1_s, _) = p.g1_s.largest();
            let expected = "a negative number in every reachable state of a well-posed model; raise \
                            tau0 or use the Literal form";
            check_that(largest_g1_s < 0.0, "largest G1 (s)", largest_g1_s, expected)?;
            for sign in [1.0, -1.0] {
                let slack = p.g1_s.combined(1.0, &p.g2_s2_per_deg, 2.0 * sign * rate);
                let (excess_s, _) = slack.largest();
                let expected = format!(
                    "0 or less in every reachable state up to the output rate d = {rate} deg/s; \
                     scale G2 down or lower unfolded_rate_deg_s"
                );
                check_that(excess_s <= 0.0, "largest 2 |G2| d - |G1| (s)", excess_s, expected)?;
            }
        }
        let maps = [&p.g0_deg, &p.g1_s, &p.g2_s2_per_deg];
        let table = NodeTable::new(&p.grid, |play, knot| {
            let [a, b, c] = maps.map(|map| map.value_and_rise(play, knot));
            [a[0], b[0], c[0], a[1], b[1], c[1]]
        });
        Ok(Self { parameters, table })
    }

    /// Its numbers.
    pub fn parameters(&self) -> &DynamicParameters {
        &self.parameters
    }

    /// Its grid.
    pub fn grid(&self) -> &PreisachGrid {
        &self.parameters.grid
    }

    /// The static actuator that `G0` alone describes.
    ///
    /// # Errors
    /// None for a model that was itself built; the checks are those of [`StaticPreisach::new`].
    pub fn static_part(&self) -> Result<StaticPreisach, PreisachError> {
        StaticPreisach::new(self.parameters.grid, self.parameters.g0_deg.clone())
    }

    /// `G0` (deg), `G1` (s) and `G2` (s^2/deg) in a given memory state.
    pub fn maps(&self, memory: &PlayMemory) -> [f64; 3] {
        let p = &self.parameters;
        [p.g0_deg.value(memory), p.g1_s.value(memory), p.g2_s2_per_deg.value(memory)]
    }

    /// Moves the memory to a voltage and returns `G0, G1, G2` there.
    pub fn apply(&self, memory: &mut PlayMemory, voltage_volt: f64) -> [f64; 3] {
        let p = &self.parameters;
        memory.apply(&p.grid, voltage_volt);
        let [mut g0, mut g1, mut g2] =
            [p.g0_deg.constant, p.g1_s.constant, p.g2_s2_per_deg.constant];
        for (play, &x) in memory.cells().iter().enumerate() {
            let (&[a, b, c, a_rise, b_rise, c_rise], t) = self.table.at(play, x);
            g0 += a + t * a_rise;
            g1 += b + t * b_rise;
            g2 += c + t * c_rise;
        }
        [g0, g1, g2]
    }

    /// The outputs of models on one grid over the same voltages, from rest at the first: a map that
    /// several models share is evaluated once. Each is that of its own simulation, to the last bit; one
    /// that diverges is not stopped.
    pub(crate) fn side_by_side(
        models: &[&Self],
        voltages_volt: &[f64],
        time_step_s: f64,
    ) -> Vec<Vec<f64>> {
        let Some(first) = models.first() else {
            return Vec::new();
        };
        let mut maps: Vec<&PlayMap> = Vec::new();
        let mut places = Vec::with_capacity(models.len());
        for model in models {
            let p = &model.parameters;
            places.push([&p.g0_deg, &p.g1_s, &p.g2_s2_per_deg].map(|map| {
                let known = maps.iter().position(|known| *known == map);
                known.unwrap_or_else(|| {
                    maps.push(map);
                    maps.len() - 1
                })
            }));
        }
        let groups: Vec<Vec<Lanes>> = maps
            .chunks(LANES)
            .map(|group| map_values(group, first.grid(), voltages_volt))
            .collect();
        let models: Vec<Marching<'_>> = models
            .iter()
            .zip(places)
            .map(|(model, places)| Marching {
                order: model.parameters.time_order,
                maps: places.map(|place| (groups[place / LANES].as_slice(), place % LANES)),
            })
            .collect();
        let marched = models.chunks(LANES).flat_map(|models| {
            Arch::new().dispatch(March { models, samples: voltages_volt.len(), time_step_s })
        });
        marched.collect()
    }
}

/// One model on its way over the samples: `G0`, `G1` and `G2` at every sample, each with its lane.
struct Marching<'a> {
    order: TimeOrder,
    maps: [(&'a [Lanes], usize); 3],
}

/// At most [`LANES`] models side by side: the steps of one wait for each other, those of several do not. A type of its
/// own, for a closure would be called, not inlined, by the function that is compiled for the vector unit.
struct March<'a> {
    models: &'a [Marching<'a>],
    samples: usize,
    time_step_s: f64,
}

impl WithSimd for March<'_> {
    type Output = Vec<Vec<f64>>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<Vec<f64>> {
        let Self { models, samples, time_step_s } = self;
        let mut outputs = vec![Vec::with_capacity(samples); models.len()];
        let Some(last) = models.len().checked_sub(1) else { return outputs };
        let of = |lane: usize| &models[lane.min(last)];
        let maps: [_; LANES] = std::array::from_fn(|lane| of(lane).maps);
        let [first, after] = [None, Some(time_step_s)].map(|earlier| {
            let of = |lane| BackwardDifference::new(of(lane).order, time_step_s, earlier);
            let each: [_; LANES] = std::array::from_fn(of);
            each.into()
        });
        let mut now = Lanes::default();
        let mut before = Lanes::default();
        for sample in 0..samples {
            let mut g = [Lanes::default(); 3];
            for (lane, [g0, g1, g2]) in maps.iter().enumerate() {
                g[0].0[lane] = g0.0[sample].0[g0.1];
                g[1].0[lane] = g1.0[sample].0[g1.1];
                g[2].0[lane] = g2.0[sample].0[g2.1];
            }
            let difference: &BackwardDifference<Lanes> = if sample > 1 { &after } else { &first };
            let base = difference.base(now, before);
            let moved = base + difference.weight * output_rates(g, base, difference.weight);
            (before, now) = (now, if sample == 0 { g[0] } else { moved });
            for (output, value) in outputs.iter_mut().zip(now.0) {
                output.push(value);
            }
        }
        outputs
    }
}

/// [`output_rate`] of models side by side.
#[inline(always)]
fn output_rates(g: [Lanes; 3], base: Lanes, weight: Lanes) -> Lanes {
    let mut rates = Lanes::default();
    for lane in 0..LANES {
        let g = [g[0].0[lane], g[1].0[lane], g[2].0[lane]];
        rates.0[lane] = output_rate(g, base.0[lane], weight.0[lane]).rate_deg_s;
    }
    rates
}

/// The values of at most [`LANES`] maps over voltages, from rest at the first: the plays move once
/// for all of them.
fn map_values(maps: &[&PlayMap], grid: &PreisachGrid, voltages_volt: &[f64]) -> Vec<Lanes> {
    let (Some(first), Some(&start)) = (maps.first(), voltages_volt.first()) else {
        return Vec::new();
    };
    let of = |lane: usize| maps.get(lane).unwrap_or(first);
    let table = NodeTable::new(grid, |play, knot| {
        let values = [0, 1].map(|i| Lanes::from_fn(|lane| of(lane).value_and_rise(play, knot)[i]));
        values.into()
    });
    let constants = Lanes::from_fn(|lane| of(lane).constant);
    let memory = PlayMemory::new(grid, start, StartState::Rest);
    Arch::new().dispatch(MapValues { grid, table, constants, memory, voltages_volt })
}

/// The sums over the plays at every voltage: a type of its own, as [`March`] is.
struct MapValues<'a> {
    grid: &'a PreisachGrid,
    /// Values of all maps, and their rises.
    table: NodeTable<(Lanes, Lanes)>,
    constants: Lanes,
    memory: PlayMemory,
    voltages_volt: &'a [f64],
}

impl WithSimd for MapValues<'_> {
    type Output = Vec<Lanes>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<Lanes> {
        let Self { grid, table, constants, mut memory, voltages_volt } = self;
        let mut values = Vec::with_capacity(voltages_volt.len());
        for &volt in voltages_volt {
            memory.apply(grid, volt);
            let mut sums = constants;
            let (quads, left) = memory.cells().as_chunks::<4>();
            // one after the other, as `apply` does, but the sums wait in memory only after four
            for (quad, &[a, b, c, d]) in quads.iter().enumerate() {
                let play = 4 * quad;
                let (a, b) = (table.values(play, a), table.values(play + 1, b));
                let (c, d) = (table.values(play + 2, c), table.values(play + 3, d));
                sums = sums + a + b + c + d;
            }
            for (play, &x) in (4 * quads.len()..).zip(left) {
                sums += table.values(play, x);
            }
            values.push(sums);
        }
        values
    }
}

/// What a [`DynamicPreisach`] remembers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DynamicMemory {
    /// The plays.
    pub plays: PlayMemory,
    /// The past outputs.
    pub history: OutputHistory,
    /// What happened to the steps.
    pub counts: StepCounts,
}

impl HysteresisLaw for DynamicPreisach {
    type Memory = DynamicMemory;

    fn start(&self, voltage_volt: f64, state: StartState) -> (DynamicMemory, f64) {
        let plays = PlayMemory::new(self.grid(), voltage_volt, state);
        let [output_deg, ..] = self.maps(&plays);
        let history = OutputHistory::at_rest(output_deg);
        (DynamicMemory { plays, history, counts: StepCounts::default() }, output_deg)
    }

    #[inline]
    fn step(&self, memory: &mut DynamicMemory, voltage_volt: f64, time_step_s: f64) -> f64 {
        let DynamicMemory { plays, history, counts } = memory;
        let g = self.apply(plays, voltage_volt);
        let folded = history.advance(g, self.parameters.time_order, time_step_s);
        counts.steps += 1;
        counts.g1_not_negative += usize::from(g[1] >= 0.0);
        counts.folds += usize::from(folded);
        history.output_deg
    }

    fn check_memory(&self, memory: &DynamicMemory) -> Result<(), PreisachError> {
        memory.plays.check(self.grid())
    }

    fn counts(&self, memory: &DynamicMemory) -> StepCounts {
        memory.counts
    }

    fn shifted(mut self, shift_deg: f64) -> Self {
        self.parameters.g0_deg.constant += shift_deg;
        self
    }
}
