//! Loads of an oscillating section with a hidden effect.
//!
//! | idea | module |
//! |---|---|
//! | Bessel functions, Theodorsen's and Loewy's functions | [`wake`] |
//! | exact thin-aerofoil loads of a harmonic motion | [`theory`] |
//! | separation with a lag and a vortex | [`stall`] |
//! | the section with what reads it | [`specimen`] |
//! | what is hidden | [`effect`] |
//! | which motions are made | [`layout`] |
//! | a set | [`made`] |

pub mod effect;
pub mod layout;
pub mod made;
pub mod specimen;
pub mod stall;
pub mod theory;
pub mod wake;
