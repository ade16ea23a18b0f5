//! Higher harmonic control on an abstract plant: cost, T matrix, feedback controller.
