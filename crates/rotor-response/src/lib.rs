//! Aeroelastic coupling: periodic blade response, force-summation blade loads, hub loads.
