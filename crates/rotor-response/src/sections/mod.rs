//! The air at the blade: velocities at the sections and their loads.

pub(crate) mod air;
pub(crate) mod fine_azimuth;
pub(crate) mod flight_air;
pub(crate) mod lag;
pub(crate) mod nonlinear;
pub(crate) mod stall_history;
pub(crate) mod station_lag;
pub(crate) mod station_lags;
