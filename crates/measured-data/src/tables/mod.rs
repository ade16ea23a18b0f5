//! Measured tables: CSV with units in the header, channels, and the checks of a record.

mod loop_csv;
mod measured_csv;
mod record_checks;
mod table_text;
mod units;

pub use loop_csv::{ChannelFile, Channels, LoopTable};
pub(crate) use loop_csv::{CurveRows, Declared, parse_curve_csv, parse_loop_csv};
pub use measured_csv::{MeasuredTable, parse_measured_csv};
pub(crate) use record_checks::{Record, check_lag, check_record, check_unit};
pub(crate) use table_text::{Listing, increases_evenly, resampled};
pub use table_text::{RESAMPLED_JITTER, ROUNDING_JITTER, Sampling, resample};
pub use units::{Channel, Dimension, UNITS, Unit, significant};
