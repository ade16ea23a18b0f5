//! Higher harmonic control on an abstract plant: cost, T matrix, feedback controller.
//!
//! The plant takes the cosine and sine voltages of each flap and answers with the steady vibratory
//! hub loads ([`Plant`], [`Measurement`]); nothing else is known here of rotor or actuator. The
//! controller identifies the sensitivity of the loads to the voltages about zero control, and iterates
//! to the voltages that minimise a quadratic cost:
//!
//! ```text
//! (7)  J    = Z' W_Z Z + u' W_u u,   W_u = rho I
//! (8)  Z_i  = Z_(i-1) + T0 (u_i - u_(i-1)),   T0 = dZ/du about u = 0
//! (10) u_i* = (T0' W_Z T0 + W_u)^-1 T0' W_Z (T0 u_(i-1) - Z_(i-1))
//! ```
//!
//! Every step is *measured* on the plant, so the loop is a feedback one: it corrects what a constant
//! T0 gets wrong; other [`Controller`]s renew T on the way. A step that raises the
//! cost is halved (backtracking). A stroke limit is met by weighting the
//! control (`rho`) or as part of the optimum, never by clipping a step: see
//! [`FeedbackController::run_within_stroke`] and [`FeedbackController::run_constrained`].
//!
//! Source: S. R. Viswamurthy, R. Ganguli, *Experimental and computational investigation of
//! piezoceramic actuator hysteresis phenomenon in helicopter vibration control using dual
//! trailing-edge flaps*, eq. (7)-(10); equation numbers in this crate are that paper's.
//!
//! # Example
//! ```
//! use hhc_control::{
//!     ControlLayout, FeedbackController, FeedbackSettings, LinearPlant, LoadWeights, TMatrix,
//!     identify_t,
//! };
//!
//! // one flap at 3/rev: two controls (cosine, sine), two loads
//! let layout = ControlLayout::new(1, vec![3])?;
//! let t = TMatrix::from_columns(&[vec![2.0, 0.0], vec![0.0, 1.0]])?;
//! let mut plant = LinearPlant::new(layout, vec![4.0, 1.0], t)?
//!     .with_actuator(0.5, 0.6)? // half a degree per volt, lagging by 0.6 rad
//!     .with_stroke_limit_deg(0.75)?; // so at most 1.5 V
//! let t0 = identify_t(&mut plant, &[0.1, 0.1])?;
//! let controller = FeedbackController::new(&t0, &LoadWeights::Identity, FeedbackSettings::default())?;
//! let free = controller.run(&mut plant, 0.0)?;
//! assert!((free.reduction_percent() - 100.0).abs() < 1e-9); // two loads, two controls
//! let limited = controller.run_within_stroke(&mut plant)?;
//! assert!(limited.rho > 0.0 && (limited.largest_stroke_ratio - 1.0).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bias;
mod cone;
mod cost;
mod effort;
mod error;
mod feedback;
mod front;
mod identify;
mod iteration;
mod law;
mod layout;
mod limits;
mod plant;
mod record;
mod reduction;
mod root;
mod sensitivity;
mod settings;
mod stepwise;
mod stroke;

pub use bias::{BiasSolution, BiasSolver};
pub use cone::{ConeStatus, ConstrainedOptimum, KktResidual};
pub use cost::{Cost, LoadWeights, reduction_percent};
pub use effort::StrokeStatus;
pub use error::{ControlError, RunError};
pub use feedback::FeedbackController;
pub use front::{FrontPoint, SecondCost};
pub use identify::identify_t;
pub use law::{
    FeedbackLaw, LagLoss, LoadMargin, OperatingPoint, RelaxedStep, TMargins, TMatrix, lag_loss,
};
pub use layout::{ControlLayout, lag_deg};
pub use limits::{ControlLimits, FlapCircle, PowerLimit, VoltageRange};
pub use plant::{
    HUB_OUTPUTS, LinearPlant, Measurement, Plant, PowerOutputs, hub_outputs, output_weights,
};
pub use record::{AllowedIncrease, ControlRun, ControlStep, LoopEnd, StopReason};
pub use sensitivity::{AdaptiveSettings, Controller};
pub use settings::{Acceptance, FeedbackSettings};
pub use stepwise::{
    CycleController, EstimatorSettings, HarmonicAnalyser, LoadEstimator, Observed,
    RelaxedController, RelaxedSettings,
};
pub use stroke::{EffortTrial, StrokeLimitedRun};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
