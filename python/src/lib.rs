#![forbid(unsafe_code)]
#![warn(missing_docs)]
//! Native part of the Python package `asperity`. It connects Python with the libraries of Asperity
//! and computes nothing itself.

mod advice;
mod computing;
mod failure;
mod fit;
mod force_loop;
mod parts;
mod press;
mod quantity;
mod results;
mod scene;
mod surface;
mod words;

/// Native part of the Python package `asperity`.
#[pyo3::pymodule]
mod _native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::{
        fit::{curve_names, fit, fits_of_parts, fits_part},
        force_loop::{Loop, Profile},
        parts::{ensemble_of_parts, ensemble_part, profiles_of, study_of_parts, study_part},
        press::press,
        quantity::{in_field, in_words, parsed, quantities, shown, unit_of},
        results::{Report, ensemble, find, preloads, reference, reversals, run, study},
        scene::{Scene, presets},
        surface::surface,
    };

    /// Runs the program with the given arguments and returns the exit code. The first argument is
    /// the name of the program.
    #[pyfunction]
    fn program(py: Python<'_>, arguments: Vec<std::ffi::OsString>) -> u8 {
        py.detach(|| asperity::cli::main(arguments))
    }

    /// Sets the version of the package.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
