//! The files shipped inside the program: the paper's cases, the synthetic bench and aerofoil.
//!
//! The paper's study runs from any folder because its input is part of the binary. Measured data are not: no licence to pass
//! them on was seen. A shipped case that names some says so and runs without them.

use super::{Embedded, Folder};

/// Folder of the shipped cases.
pub const SHIPPED_CASES: &str = "fixtures/cases";
/// Folder of the shipped aerofoil tables.
pub(super) const SHIPPED_AIRFOILS: &str = "fixtures/airfoils";
/// Folder of the shipped bench data.
pub const SHIPPED_BENCH: &str = "fixtures/bench/apa500l_synthetic";

macro_rules! shipped {
    ($($path:literal),+ $(,)?) => {
        /// Name and content of every shipped file, ordered by name.
        const FILES: &[(&str, &[u8])] =
            &[$(($path, include_bytes!(concat!("../../../../", $path)))),+];
    };
}

shipped![
    "fixtures/airfoils/SOURCE.md",
    "fixtures/airfoils/naca0012_synthetic.c81",
    "fixtures/bench/apa500l_synthetic/README.md",
    "fixtures/bench/apa500l_synthetic/dataset.ron",
    "fixtures/bench/apa500l_synthetic/forc_from_150v.csv",
    "fixtures/bench/apa500l_synthetic/forc_from_minus20v.csv",
    "fixtures/bench/apa500l_synthetic/major_0p2hz.csv",
    "fixtures/bench/apa500l_synthetic/mix_2_3_4_per_rev.csv",
    "fixtures/bench/apa500l_synthetic/sine_10hz_25v.csv",
    "fixtures/bench/apa500l_synthetic/sine_10hz_55v.csv",
    "fixtures/bench/apa500l_synthetic/sine_10hz_85v.csv",
    "fixtures/bench/apa500l_synthetic/sine_15hz_25v.csv",
    "fixtures/bench/apa500l_synthetic/sine_15hz_55v.csv",
    "fixtures/bench/apa500l_synthetic/sine_15hz_85v.csv",
    "fixtures/bench/apa500l_synthetic/sine_1hz_25v.csv",
    "fixtures/bench/apa500l_synthetic/sine_1hz_55v.csv",
    "fixtures/bench/apa500l_synthetic/sine_1hz_85v.csv",
    "fixtures/bench/apa500l_synthetic/sine_20hz_25v.csv",
    "fixtures/bench/apa500l_synthetic/sine_20hz_55v.csv",
    "fixtures/bench/apa500l_synthetic/sine_20hz_85v.csv",
    "fixtures/bench/apa500l_synthetic/sine_5hz_25v.csv",
    "fixtures/bench/apa500l_synthetic/sine_5hz_55v.csv",
    "fixtures/bench/apa500l_synthetic/sine_5hz_85v.csv",
    "fixtures/cases/controllers_mu030.ron",
    "fixtures/cases/crosscheck_s1.ron",
    "fixtures/cases/crosscheck_s2.ron",
    "fixtures/cases/flight_ramp.ron",
    "fixtures/cases/hart_ii_bl.ron",
    "fixtures/cases/hart_ii_mn.ron",
    "fixtures/cases/helinovi_climb.ron",
    "fixtures/cases/helinovi_level.ron",
    "fixtures/cases/paper_mu030.ron",
    "fixtures/cases/paper_mu030_6p383hz.ron",
    "fixtures/cases/stalled_mu030.ron",
];

/// A folder of the shipped files, such as [`SHIPPED_CASES`].
pub fn shipped(folder: &str) -> Folder {
    Folder::Embedded(Embedded::new(folder, FILES))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// What is shipped is what the folders hold, no file more and none less.
    #[test]
    fn the_list_is_complete() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut on_disk: Vec<String> = [SHIPPED_AIRFOILS, SHIPPED_BENCH, SHIPPED_CASES]
            .iter()
            .flat_map(|folder| {
                std::fs::read_dir(root.join(folder))
                    .unwrap()
                    .map(move |e| format!("{folder}/{}", e.unwrap().file_name().display()))
            })
            .collect();
        on_disk.sort();
        let shipped: Vec<String> = FILES.iter().map(|(n, _)| (*n).to_owned()).collect();
        assert_eq!(shipped, on_disk);
        let total: usize = FILES.iter().map(|(_, b)| b.len()).sum();
        assert!(total < 8_000_000, "{total} bytes are too many to ship in the binary");
    }
}
