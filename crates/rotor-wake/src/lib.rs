//! Rotor inflow models behind one trait: uniform (Glauert) and Drees.
