//! Unsteady thin-aerofoil aerodynamics of a section with a trailing-edge flap.
