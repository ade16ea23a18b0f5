//! Case files, data files, studies and the hhc command of rotor-hhc.
