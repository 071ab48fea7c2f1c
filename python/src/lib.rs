#![forbid(unsafe_code)]
#![warn(missing_docs)]
//! The native part of the package `asperity` of Python: arrays, texts and errors of Python on one side, the libraries of
//! Asperity on the other. It computes nothing itself.

mod computing;
mod failure;
mod force_loop;
mod profile;
mod quantity;
mod report;
mod results;
mod scene;

use pyo3::prelude::*;

/// Runs the program with these arguments, the first of which is its name, and returns the exit code.
#[pyfunction]
fn program(py: Python<'_>, arguments: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| asperity::cli::main(arguments))
}

/// The native part of the package.
#[pymodule]
mod _native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::failure::{FieldError, LoadingError};
    #[pymodule_export]
    use super::force_loop::Loop;
    #[pymodule_export]
    use super::profile::Profile;
    #[pymodule_export]
    use super::program;
    #[pymodule_export]
    use super::quantity::{in_words, quantity, whole};
    #[pymodule_export]
    use super::report::Report;
    #[pymodule_export]
    use super::results::{ensemble, find, preloads, reference, reversals, run};
    #[pymodule_export]
    use super::scene::{Scene, presets};

    /// States the version of the package.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
