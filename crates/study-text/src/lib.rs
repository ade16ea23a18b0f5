//! Results of a study of a rotor as text: tables for people, CSV and VTK for programs.
//!
//! Floor 6: it is handed values and gives texts back. Who writes or prints them knows the names of files and the terminal.
//!
//! | idea | module |
//! |---|---|
//! | airloads and the motion of the blade tip | `airloads` |
//! | loads along a blade, hub loads of dissimilar blades | `blade_loads` |
//! | what control costs, and the fronts of `J` | `costs` |
//! | rotating modes and the data of a fan plot | `modes` |
//! | flaps against root pitch | `root_pitch` |
//! | flights under noise, a wrong T and drift, and how wrong T may be | `robustness` |
//! | names of sets and flaps | `names` |
//! | files of `hhc`, and by what each is known | [`known`] |
//! | a free wake: tables, geometry, the revolution for `ParaView` | `wake`, `revolution` |

mod airloads;
mod blade_loads;
mod costs;
pub mod known;
mod modes;
mod names;
mod revolution;
mod robustness;
mod root_pitch;
mod wake;

pub use airloads::{airloads_csv, tip_csv};
pub use blade_loads::{blade_loads_csv, curvature_gap, moments_table, unlike_table};
pub use costs::{cost_sections, costs_csv, front_axis, front_sections, fronts_csv};
pub use modes::{fan_csv, modes_text};
pub use names::{flap_name, set_name};
pub use robustness::{robustness_csv, robustness_pictures, robustness_sections};
pub use root_pitch::root_pitch_text;
pub use wake::{WakeFiles, vortices_csv, wake_files, wake_text};

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
