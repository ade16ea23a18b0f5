//! Measured tables: CSV with units in the header, channels, and the checks of a record.

mod column_csv;
mod loop_csv;
mod measured_csv;
mod point_csv;
mod record_checks;
mod rests;
mod sampling;
mod text;
mod units;

pub use column_csv::{ColumnTable, parse_columns};
pub use loop_csv::{ChannelFile, Channels};
pub(crate) use loop_csv::{Declared, Rows, input_and_output, parse_loop_csv, parse_rows};
pub(crate) use measured_csv::QUANTITIES;
pub use measured_csv::{MeasuredTable, parse_measured_csv};
pub use point_csv::PointCsv;
pub use record_checks::limits;
pub(crate) use record_checks::{Record, check_lag, check_record, check_unit};
pub(crate) use rests::{Spans, check_rests, parted, several_runs};
pub use rotor_base::significant;
pub(crate) use sampling::{Listing, RESAMPLED_JITTER, ROUNDING_JITTER, Sampling};
pub(crate) use sampling::{note_swapped, resample, resampled};
pub(crate) use text::{HeaderCell, LEAST_ROWS, TextTable, too_few_rows};
pub(crate) use units::unknown_unit;
pub use units::{Channel, Dimension, UNITS, Unit};
