//! Exact theory of the section, and the calibration fitted to it.

mod calibration;
mod panels;
mod tables;
