//! Rotor and vehicle equilibrium over the aeroelastic response.
