//! The page of a diagnosis: pictures of what discovery found on points of test and on a bench.
//!
//! Floor 3: it is handed findings and the words that are said of them, and gives one HTML text back that loads nothing.
//!
//! | idea | module |
//! |---|---|
//! | what is said of a diagnosis | `words` |
//! | what all pages have: parameters, costs, yardstick | `common` |
//! | points of test | `points` |
//! | runs of a bench | `bench` |

mod bench;
mod common;
mod points;
mod words;

pub use bench::bench_page;
pub use points::points_page;
pub use words::Words;

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
