//! Frequencies of a blade with a hidden effect.
//!
//! The blade is straight, untwisted and at no pitch: bending in and out of the plane and torsion do not couple.
//!
//! | idea | module |
//! |---|---|
//! | modes of a rotating beam, SI units | [`beam`] |
//! | the blade that is drawn, and its case | [`specimen`] |
//! | what is hidden | [`effect`] |
//! | a set | [`made`] |

pub mod beam;
pub mod effect;
pub mod made;
pub mod specimen;
