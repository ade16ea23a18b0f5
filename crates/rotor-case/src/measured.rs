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
    /// An input of the case that is not known well: what a diagnosis may move without a discovery. One of the two
    /// standard deviations.
    #[serde(deny_unknown_fields)]
    pub struct UncertainField {
        /// Path of the field, such as `rotor.gj`; of a table in its place the values are moved.
        pub field: String = String::new(), Rule("required"), "", "the path of a number of the case";
        /// Standard deviation, percent of the value.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub sd_percent: Option<f64> = None, Within(1e-6, 100.0), "%", "a stiffness is known to a few percent";
        /// Standard deviation in the unit of the field.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub sd: Option<f64> = None, UpTo(1e12), "", "more than 0, in the unit of the field";
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
