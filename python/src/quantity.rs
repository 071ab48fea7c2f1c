//! Quantities: numbers in SI units or texts with a unit, and arrays of numbers.

use crate::failure::Failure;
use asperity::data::{format_quantity, parse_quantity};
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;

/// The number of a text such as `"2.7 MPa"`, for a field of the unit `"Pa"`.
#[pyfunction]
pub fn parsed(text: &str, unit: &str, field: &str) -> Result<f64, Failure> {
    parse_quantity(text, unit).map_err(|error| Failure::explained(field, text, &error))
}

/// A number with its unit as people read it: `2.5 MPa`.
#[pyfunction]
pub fn in_words(value: f64, unit: &str) -> String {
    format_quantity(value, unit)
}

/// An array of Python that cannot be changed.
pub type Array<'py, T> = Bound<'py, PyArray1<T>>;

/// The array of these values.
pub fn array<T: Element>(py: Python<'_>, values: Vec<T>) -> Array<'_, T> {
    let array = PyArray1::from_vec(py, values);
    array.readwrite().make_nonwriteable();
    array
}
