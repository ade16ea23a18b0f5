//! Sets of points of test with a hidden effect.

pub mod case;
pub mod catalogue;
pub mod drive;
pub mod effect;
pub mod fly;
pub mod layout;
pub mod machine;
pub mod made;
pub mod path;
pub mod table;
