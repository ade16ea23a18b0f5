//! Files: reading with places, atomic writing, and RON with the place of every field.

mod field;
mod folder;
mod ron_index;
mod ron_read;
mod write;

pub use field::{Change, with_field_moved};
pub(crate) use folder::STANDARD_INPUT;
pub use folder::{Embedded, Folder, Source, distinct_names, open_reader};
pub use ron_index::RonIndex;
pub use ron_read::{RonFile, read_ron, ron_text};
pub use write::{
    default_model_file, refuse_foreign, refuse_input, refuse_inside, refuse_other_kind,
    refuse_other_text, refuse_unwritable, remove_own, write_atomic, write_folder, write_new,
};
