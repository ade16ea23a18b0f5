//! The dynamic Preisach actuator, paper equation (5).

use crate::check::{check_not_negative, check_that};
use crate::laws::play_map::NodeTable;
use crate::{
    HysteresisLaw, PlayMap, PlayMemory, PreisachError, PreisachGrid, StartState, StaticPreisach,
    StepCounts,
};
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
pub fn output_rate(g: [f64; 3], base: f64, weight: f64) -> OutputRate {
    let [g0, g1, g2] = g;
    let b = weight - g1;
    let q = g0 - base;
    let discriminant = b * b - 4.0 * g2 * q;
    if discriminant < 0.0 {
        return OutputRate { rate_deg_s: b / (2.0 * g2), folded: true };
    }
    let denominator = b + discriminant.sqrt().copysign(b);
    let rate_deg_s = if q == 0.0 { 0.0 } else { 2.0 * q / denominator };
    OutputRate { rate_deg_s, folded: false }
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

    /// `base` and `weight` of the backward difference `delta = base + weight d` over a new step.
    ///
    /// ```text
    /// Euler:  base = delta_n,  weight = h
    /// BDF2:   delta_{n+1} = [ (1+w)^2 delta_n - w^2 delta_{n-1} + (1+w) h d ] / (1 + 2 w),  w = h / h_n
    /// ```
    /// Source: Hairer, Norsett, Wanner, *Solving Ordinary Differential Equations I*, section III.5.
    fn difference(&self, order: TimeOrder, step_s: f64) -> (f64, f64) {
        match (order, self.earlier) {
            (TimeOrder::Second, Some((earlier_deg, earlier_step_s))) => {
                let w = step_s / earlier_step_s;
                let scale = 1.0 / (1.0 + 2.0 * w);
                let plus = 1.0 + w;
                let base = (plus * plus * self.output_deg - w * w * earlier_deg) * scale;
                (base, plus * step_s * scale)
            }
            _ => (self.output_deg, step_s),
        }
    }

    /// One time step on with the maps `G0, G1, G2` there; whether it was a fold.
    #[inline]
    fn advance(&mut self, g: [f64; 3], order: TimeOrder, step_s: f64) -> bool {
        let (base, weight) = self.difference(order, step_s);
        let OutputRate { rate_deg_s, folded } = output_rate(g, base, weight);
        let output_deg = base + weight * rate_deg_s;
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
    table: NodeTable<6>,
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
        let groups = maps.chunks(TOGETHER);
        let values: Vec<Vec<f64>> =
            groups.flat_map(|group| map_values(group, first.grid(), voltages_volt)).collect();
        let begun = |(model, places): (&&Self, [usize; 3])| {
            let maps = places.map(|place| values[place].as_slice());
            let start_deg = maps[0].first().copied();
            let mut output_deg = Vec::with_capacity(voltages_volt.len());
            output_deg.extend(start_deg);
            let history = OutputHistory::at_rest(start_deg.unwrap_or_default());
            March { order: model.parameters.time_order, maps, history, output_deg }
        };
        let mut marches: Vec<March<'_>> = models.iter().zip(places).map(begun).collect();
        // sample by sample: the steps of one model wait for each other, those of several do not
        for i in 1..voltages_volt.len() {
            for March { order, maps: [g0, g1, g2], history, output_deg } in &mut marches {
                history.advance([g0[i], g1[i], g2[i]], *order, time_step_s);
                output_deg.push(history.output_deg);
            }
        }
        marches.into_iter().map(|march| march.output_deg).collect()
    }
}

/// One model on its way over the samples.
struct March<'a> {
    order: TimeOrder,
    /// `G0`, `G1` and `G2` at every sample.
    maps: [&'a [f64]; 3],
    history: OutputHistory,
    output_deg: Vec<f64>,
}

/// The values of at most [`TOGETHER`] maps over voltages, from rest at the first: the plays move once
/// for all of them.
fn map_values(maps: &[&PlayMap], grid: &PreisachGrid, voltages_volt: &[f64]) -> Vec<Vec<f64>> {
    let (Some(first), Some(&start)) = (maps.first(), voltages_volt.first()) else {
        return vec![Vec::new(); maps.len()];
    };
    let of = |lane: usize| maps.get(lane).unwrap_or(first);
    // values of all maps, then their rises
    let table = NodeTable::<{ 2 * TOGETHER }>::new(grid, |play, knot| {
        std::array::from_fn(|i| of(i % TOGETHER).value_and_rise(play, knot)[i / TOGETHER])
    });
    let constants: [f64; TOGETHER] = std::array::from_fn(|lane| of(lane).constant);
    let mut memory = PlayMemory::new(grid, start, StartState::Rest);
    let mut values = vec![Vec::with_capacity(voltages_volt.len()); maps.len()];
    for &volt in voltages_volt {
        memory.apply(grid, volt);
        let mut sums = constants;
        for (play, &x) in memory.cells().iter().enumerate() {
            let (entry, t) = table.at(play, x);
            let (at, rises) = entry.split_at(TOGETHER);
            for lane in 0..TOGETHER {
                sums[lane] += at[lane] + t * rises[lane];
            }
        }
        values.iter_mut().zip(sums).for_each(|(values, sum)| values.push(sum));
    }
    values
}

/// Maps that are evaluated at once.
const TOGETHER: usize = 8;

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
