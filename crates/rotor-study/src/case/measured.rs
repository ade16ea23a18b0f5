//! The section of a case that names measured data.

use super::field::{is_default, section};

section! {
    /// Measured data of the flight, shown beside what is computed. They change no computed number.
    #[serde(deny_unknown_fields, default)]
    pub struct MeasuredFiles {
        /// Airloads of sections.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub airloads: Vec<MeasuredSection> = vec![], Any, "", "";
        /// Motion of the blade tip: flap, lag, elastic twist.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub tip: Vec<MeasuredFile> = vec![], Any, "", "";
        /// Centres of tip vortices, for a case in a free wake.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub vortex_centres: Vec<MeasuredFile> = vec![], Any, "", "";
    }
}

section! {
    /// Measured airloads of a section.
    #[serde(deny_unknown_fields)]
    pub struct MeasuredSection {
        /// Station of the section.
        pub station_r: f64 = 0.87, Rule("`root_cutout_r` to 1, required"), "R", "";
        /// CSV file, relative to the case file.
        pub file: String = String::new(), Rule("required"), "", "a CSV file, relative to the case file";
        /// Rows of the file to take: the text in its column `case`. Needed where that column holds several.
        #[serde(default, skip_serializing_if = "is_default")]
        pub case: Option<String> = None, Any, "", "the text in the column `case` of the rows to take";
    }
}

section! {
    /// A file of measured data.
    #[serde(deny_unknown_fields)]
    pub struct MeasuredFile {
        /// CSV file, relative to the case file.
        pub file: String = String::new(), Rule("required"), "", "a CSV file, relative to the case file";
        /// Rows of the file to take: the text in its column `case`. Needed where that column holds several.
        #[serde(default, skip_serializing_if = "is_default")]
        pub case: Option<String> = None, Any, "", "the text in the column `case` of the rows to take";
    }
}
