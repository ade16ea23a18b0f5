//! Shares and margins of the decisions.
//!
//! No theory fixes them: they are choices, each with its meaning beside it, and `cargo xtask hidden-effects`
//! scores what they do together. They are no probabilities: the weights of the samples count structure of the
//! base model as if it were noise.

// What noise and surrogates reach.

/// Standard deviations of the noise that a score must exceed; noise and structure add as squares.
pub(super) const NOISE_DEVIATIONS: f64 = 4.2;
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
/// Penalty on a free parameter, in units of the noise variance.
pub(super) const PARAMETER_PENALTY: f64 = 3.0;
/// Share of the excess that the named causes must explain.
pub(super) const EXPLAINED: f64 = 0.9;

/// Share of the drop by the causes before that the next one must add: below it, it mends their form.
pub(super) const NEXT_SHARE: f64 = 0.04;
/// The same for a candidate that is easily taken for one of the causes before: an error of their form is most of
/// all like it.
pub(super) const CONFUSED_SHARE: f64 = 0.2;
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

/// Share of the drop beyond which structure of the base model does not make two causes change places.
pub(super) const SWAY_SHARE: f64 = 0.1;
/// Part of the discrimination threshold within which the other cause is as likely.
pub(super) const AS_LIKELY: f64 = 0.5;
/// Multiple of the discrimination threshold that is required for a sure name: what surrogates can do is known
/// from five of them.
pub(super) const SURELY: f64 = 1.25;
/// Part of its own effect on the intermediate channels below which they do not show a cause.
pub(super) const SHOWN: f64 = 0.5;
/// Standard errors of that part that must lie between.
pub(super) const SURE_ERRORS: f64 = 3.0;

// What speaks against a name.

/// Relative spread from which on the name is wrong.
pub(super) const WRONG_NAME: f64 = 0.5;
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

/// Factor on the energy that surrogates leave along the generic directions.
pub(super) const GENERIC_MARGIN: f64 = 4.0;
/// Times the energy that the worst surrogate leaves on an experiment, beyond which that experiment stands
/// out alone.
pub(super) const RUN_MARGIN: f64 = 4.0;
/// Misfit over the floor, in floors, from which the share of it that is explained means anything.
pub(super) const STANDS_OUT: f64 = 0.5;
/// Part of the misfit of an experiment, in energy, that causes with their errors of form may leave.
pub(super) const FORM_LEFT: f64 = 0.05;
/// Relative error of the noise of a channel, taken from its differences.
pub(super) const NOISE_DOUBT: f64 = 0.05;
