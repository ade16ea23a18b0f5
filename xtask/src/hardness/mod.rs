//! What the program stands: kills at any moment, disks that are full, a thousand cases in one process.
//!
//! | idea | module |
//! |---|---|
//! | folders of files and the program in them | `place` |
//! | kills of a sweep and of a study | [`kills`] |
//! | disks without space, folders that take no file | [`disks`] |
//! | memory over many cases | [`memory`] |
//! | many cases of the paper's rotor: cost, memory, a kill | [`many`] |

pub mod disks;
pub mod kills;
pub mod many;
pub mod memory;
mod place;
