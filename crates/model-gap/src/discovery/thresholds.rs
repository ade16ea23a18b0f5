//! Shares and margins of the decisions.
//!
//! The first is a probability. No theory fixes the others: they are choices, each with its meaning beside it, and
//! `cargo xtask hidden-effects` and `everyday-errors` score what they do together. `docs/src/theory/discovery.md` lists them.

// What noise and surrogates reach.

/// Probability that noise alone exceeds one of a family of tests: all starts of all candidates, all runs, all bands
/// of all channels, the generic directions.
pub(super) const FALSE_ALARM: f64 = 1e-3;
/// Factor on what surrogates reach.
pub(super) const STRUCTURE_MARGIN: f64 = 2.0;
/// RMS of a weak effect over the standard deviation of the output.
pub(super) const WEAK_EFFECT: f64 = 0.01;

// Which candidates are fitted.

/// Part of its threshold that a candidate must promise before it is fitted.
pub(super) const PROMISE: f64 = 0.3;
/// Part of the drop of a cause that another must promise before it is fitted in its place.
pub(super) const RIVAL_PROMISE: f64 = 0.1;
/// Weight of what surrogates leave against the sign of an effect.
pub(super) const OTHER_SIGN: f64 = 0.5;

// What a cause must explain.

/// Most folds of the split by experiment.
pub(super) const MOST_FOLDS: usize = 8;
/// Part of its threshold that a cause must reach on some experiments for these to know it.
pub(super) const KNOWN_SHARE: f64 = 0.5;
/// Share of what a cause explains that other experiments must know of, for held-out experiments to judge it.
pub(super) const FORETOLD_SHARE: f64 = 0.5;
/// Penalty on a free parameter, in units of the noise variance.
pub(super) const PARAMETER_PENALTY: f64 = 3.0;
/// Share of the excess that the named causes must explain.
pub(super) const EXPLAINED: f64 = 0.9;

/// Share of the drop by the causes before that the next one must add: below it, it mends their form.
pub(super) const NEXT_SHARE: f64 = 0.04;
/// The same for a candidate that is easily taken for one of the causes before: an error of their form is most of
/// all like it.
pub(super) const CONFUSED_SHARE: f64 = 0.2;
/// Part of the mean square of the outputs' error by which a cause must lower it: what it takes below that is the base
/// model's own.
pub(super) const LEAST_GAIN: f64 = 0.05;
/// Times its threshold that a cause must explain to be named with confidence.
pub(super) const STRONG: f64 = 2.0;
/// Share of a drop that must show where experiments are held out.
pub(super) const HELD_OUT_SHARE: f64 = 0.3;

// What discriminates two causes.

/// Drop of the misfit that separates two causes, in units of the noise variance.
pub(super) const SEPARATION: f64 = 12.0;
/// Share of a drop within which two causes are not discriminated: no model of a cause is better.
const FORM_ERROR: f64 = 0.02;

/// Difference of chi-square from which on two causes are distinguished that take `drop` off it.
pub fn needed_to_separate(drop: f64) -> f64 {
    SEPARATION + FORM_ERROR * drop
}

/// Largest share of the drop of a cause that a rival may lack.
pub(super) const RIVAL_LACK: f64 = 0.4;
/// Share of the drop beyond which structure of the base model does not make two causes change places.
pub(super) const SWAY_SHARE: f64 = 0.1;
/// Part of the discrimination threshold within which the other cause is as likely.
pub(crate) const AS_LIKELY: f64 = 0.5;
/// Multiple of the discrimination threshold that is required for a sure name: what surrogates can do is known
/// from five of them.
pub(crate) const SURELY: f64 = 1.25;
/// Part of its own effect on the intermediate channels below which they do not show a cause.
pub(super) const SHOWN: f64 = 0.5;
/// Standard errors of that part that must lie between.
pub(super) const SURE_ERRORS: f64 = 3.0;

/// Times its error of form, in amplitude, by which the drop of a cause may be off where effects count in their own starts.
const FORMS: f64 = 2.0;

/// The same where the effects of both causes are known as well as their tables: `forms` are their errors of form.
pub(crate) fn needed_between(drop: f64, forms: [f64; 2]) -> f64 {
    SEPARATION + (FORMS * forms[0].max(forms[1])).powi(2) * drop
}

/// Share of the drop of a cause that another of its set must bring to stay open where no channel parts them.
pub(super) const SAME_GAIN: f64 = 0.8;

// What "nothing is missing" means.

/// Standard deviations by which an effect must lie above its threshold to be seen with 90 % probability.
const SEEN: f64 = 1.2816;

/// Size of an effect, over that whose expected drop is `drop`, that would have exceeded `asked` with 90 % probability:
/// drops grow with the square of an effect. Infinite where the base model takes all of it.
pub(super) fn limit(drop: f64, asked: f64) -> f64 {
    (asked.sqrt() + SEEN) / drop.max(0.0).sqrt()
}

/// RMS that an effect must have on `samples` of the outputs to take [`LEAST_GAIN`] off their error with 90 % probability;
/// `left` is its mean square.
///
/// ```text
/// s^2 - 2 s z root(left / n) = LEAST_GAIN left,   z the normal quantile of 90 %
/// ```
pub(super) fn least_effect(left: f64, samples: f64) -> f64 {
    let scatter = SEEN * (left / samples).sqrt();
    scatter + scatter.mul_add(scatter, LEAST_GAIN * left).sqrt()
}

/// Size of every common cause, over the output, that must have been seen for a sure "nothing is missing".
pub(super) const COMMON_SEEN: f64 = 0.03;

impl super::Yardstick {
    /// Size of a weak effect, in the yardstick.
    pub(super) fn weak(self) -> f64 {
        match self {
            Self::OutputSpread => WEAK_EFFECT,
            Self::FirstStart => 1.0,
        }
    }

    /// Size of an effect that must have been seen for a sure "nothing is missing".
    pub(super) fn matters(self) -> f64 {
        match self {
            Self::OutputSpread => COMMON_SEEN,
            Self::FirstStart => 1.0,
        }
    }
}

/// Standard deviations that a calibration may be off before nothing is denied with confidence.
pub(super) const STRAINED: f64 = 2.0;

/// The same for a cause to be all that is missing: its errors of form bend a calibration too.
pub(super) const STRAINED_BESIDE: f64 = 5.0;

// What speaks against a name.

/// Relative spread from which on the name is wrong.
pub(super) const WRONG_NAME: f64 = 0.5;
/// Standard deviations of chi-square by which a parameter must vary from experiment to experiment.
pub(super) const DRIFT_DEVIATIONS: f64 = 3.0;
/// Relative spread of a parameter over the experiments from which on it drifts.
pub(super) const DRIFTING: f64 = 0.25;
/// Share of the drop that values of its own for every experiment must add before a drift speaks
/// against a name, and the share before it makes the name wrong.
pub(super) const DRIFT_COSTS: [f64; 2] = [0.06, 0.15];
/// Share of the misfit above the floor below which something else than the names is missing too.
pub(super) const LEAST_SHARE: f64 = 0.6;
/// The same for the runs that stand out alone, where an error of form of a cause weighs most.
pub(super) const LEAST_SHARE_OF_RUNS: f64 = 0.3;

// What stands out.

/// Times its floor that structure along the generic directions must reach for "something is missing": between, what
/// is there may be the base model's own.
pub(super) const GENERIC_SURELY: f64 = 1.5;
/// Factor on the energy that surrogates leave along the generic directions.
pub(super) const GENERIC_MARGIN: f64 = 4.0;
/// Times the energy that the worst surrogate leaves on an experiment, beyond which that experiment stands
/// out alone.
pub(super) const RUN_MARGIN: f64 = 4.0;
/// The same in one band of frequency, where a few surrogates tell less of what is possible.
pub(super) const BAND_MARGIN: f64 = 9.0;
/// Noise of an octave over that of the fastest, from whose differences it is known: real noise is a little coloured.
pub(super) const NOISE_COLOUR: f64 = 1.3;
/// Misfit over the floor, in floors, from which the share of it that is explained means anything.
pub(super) const STANDS_OUT: f64 = 0.5;
/// Part of the misfit of an experiment, in energy, that causes with their errors of form may leave.
pub(super) const FORM_LEFT: f64 = 0.05;
/// The same of one band of frequency: a part of the misfit there, and a part of that of the whole experiment, because an
/// error of form has harmonics.
pub(super) const FORM_LEFT_OF_BAND: [f64; 2] = [0.12, 0.03];
/// Relative error of the noise of a channel, taken from its differences.
pub(super) const NOISE_DOUBT: f64 = 0.05;
