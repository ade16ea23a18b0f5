//! The Python package `rotor_hhc`.
//!
//! Every function asks the same code as the command `hhc` and gives the same numbers. Arrays are NumPy's; tables are
//! dictionaries with the keys of `hhc --format json`. What stops the command is the exception `rotor_hhc.Error` with the same
//! text, what the command warns of is the warning `rotor_hhc.Caution`. Other threads of Python run during a computation.
//!
//! | idea | module |
//! |---|---|
//! | exceptions, warnings, work outside of the interpreter | `answers` |
//! | NumPy arrays in and out | `arrays` |
//! | identification, simulation, inverse | `actuator` |
//! | records in memory as a data folder | `records` |
//! | responses of a section | `section` |
//! | modes, trim, T, control of a case | `rotor` |
//! | what a simulation lacks | `diagnosis` |

mod actuator;
mod answers;
mod arrays;
mod diagnosis;
mod records;
mod rotor;
mod section;

/// Vibration control of a helicopter rotor with trailing-edge flaps on hysteretic piezo actuators.
#[pyo3::pymodule]
mod rotor_hhc {
    #[pymodule_export]
    use crate::actuator::{Actuator, Inverse, identify};
    #[pymodule_export]
    use crate::answers::{Caution, Error};
    #[pymodule_export]
    use crate::diagnosis::{Diagnosis, diagnose};
    #[pymodule_export]
    use crate::rotor::{Study, modes, run, t_matrix, trim};
    #[pymodule_export]
    use crate::section::{section_history, section_response};
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::answers::notice_forks(module.py())?;
        module.add("__version__", sim_driver::VERSION)?;
        module.add("MODEL_VERSION", rotor_study::MODEL_VERSION)
    }
}
