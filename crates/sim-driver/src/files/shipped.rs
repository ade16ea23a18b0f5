//! The files shipped inside the program: the paper's cases, the synthetic bench and aerofoil, of the crate `shipped-files`.

use super::{Embedded, Folder};

/// Folder of the shipped cases.
pub const SHIPPED_CASES: &str = "fixtures/cases";
/// Folder of the shipped aerofoil tables.
pub(super) const SHIPPED_AIRFOILS: &str = "fixtures/airfoils";
/// Folder of the shipped bench data.
pub const SHIPPED_BENCH: &str = "fixtures/bench/apa500l_synthetic";

/// A folder of the shipped files, such as [`SHIPPED_CASES`].
pub fn shipped(folder: &str) -> Folder {
    Folder::Embedded(Embedded::new(folder, shipped_files::FILES))
}
