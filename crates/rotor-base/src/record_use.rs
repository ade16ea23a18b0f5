//! Which side of a split a record is on.

use serde::{Deserialize, Serialize};

/// Whether a record trains a model or tests it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecordUse {
    /// Models may be fitted to it.
    #[serde(alias = "trained", alias = "Trained")]
    Train,
    /// Kept aside: finished models are compared with it.
    #[serde(alias = "held_out")]
    HeldOut,
}
