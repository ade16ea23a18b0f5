//! Project chores behind `cargo xtask`: layer rule, tidiness, validation page, regression sweep.
//!
//! | chore | does | module |
//! |---|---|---|
//! | `layers` | checks that crates depend on strictly lower floors only, and rooms inside them | [`layers`], [`rooms`] |
//! | `tidy` | checks the rules of the house that a text can break | [`tidy`] |
//! | `validate` | runs every check against theory and published data, writes the page of the book | [`validate`] |
//! | `dependencies` | checks that every dependency is used, and under a licence that is allowed | [`dependencies`] |
//! | `calibrate` | fits the calibrated section model to exact theory and writes its table | [`calibrate`] |
//! | `refinement` | shows what refining the paper's case does to its 4/rev hub loads | [`refinement`] |
//! | `regress` | compares a sweep of the whole program with its golden values | [`regress`] |
//! | `hidden-effects` | has the program diagnose synthetic sets with known answers, prints the scores | [`hidden_effects`] |
//! | `everyday-errors` | the same on benches with the everyday errors of a laboratory | [`everyday_errors`] |
//! | `hidden-effects --kind rotor`, `blade`, `section` | the same on points of an independent rotor, blade or section | [`point_sets`] |
//! | `case-studies` | diagnoses measured points, writes figures and numbers of the pages on them | [`case_studies`] |
//! | `bench` | measures hot paths, commands and growth, writes the speed page of the book | [`mod@bench`] |
//! | `fuzz` | gives every reader changed inputs: an error or a value, never a panic | [`fuzz`] |
//! | `kills`, `memory` | kills the program, fills its disks; measures its memory over many cases | [`hardness`] |
//! | `packages`, `data-licences` | packages that stand alone; source and licence of every folder of data | [`release`] |
//! | `ci` | runs `.ci/run`, the gate of every change | [`ci`] |
//!
//! Exit codes: 0 done, 1 physics or numerics failed, 2 bad input or broken rule, 3 a comparison
//! failed.

#![expect(
    clippy::disallowed_methods,
    reason = "xtask and sim-driver are where files and the environment are known"
)]

pub mod bench;
pub mod calibrate;
pub mod case_studies;
pub mod ci;
pub mod dependencies;
pub mod diagnosis;
pub mod dynamic_stall;
mod error;
pub mod everyday_errors;
pub mod files;
pub mod fuzz;
pub mod hardness;
pub mod hidden_effects;
pub mod hover_refinement;
pub mod layers;
pub mod point_sets;
pub mod refinement;
pub mod regress;
pub mod release;
pub mod rooms;
pub mod tidy;
pub mod validate;
pub mod wake_control;
pub mod wake_inflow;
pub mod wake_refinement;
pub mod workspace;

pub use error::XtaskError;
