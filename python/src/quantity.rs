//! Conversion of Python values: numbers in SI units, texts with a unit, and arrays of numbers.

use crate::failure::Failure;
use asperity::data::{format_quantity, parse_quantity};
use asperity::scene::fields::field;
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;

/// Returns the number of a text such as `"2.7 MPa"` in the SI unit `unit`, here `"Pa"`. An error
/// names the argument `field`.
#[pyfunction]
pub fn parsed(text: &str, unit: &str, field: &str) -> Result<f64, Failure> {
    parse_quantity(text, unit).map_err(|error| Failure::explained(field, text, &error))
}

/// Returns the SI unit of the number at a path of a scene. `variant` is the variant of the form or
/// of the roughness that has this number.
#[pyfunction]
pub fn unit_of(path: &str, variant: &str) -> &'static str {
    field(path, Some(variant)).map_or("1", |field| field.unit)
}

/// Returns the number if a scene allows it at the path. An error names the argument.
#[pyfunction]
pub fn in_field(number: f64, path: &str, variant: &str, argument: &str) -> Result<f64, Failure> {
    match field(path, Some(variant)) {
        Some(field) if field.range.ends().is_some() && !field.range.contains(number) => Err(
            Failure::field(argument, &number.to_string(), &field.allowed()),
        ),
        _ => Ok(number),
    }
}

/// Returns a text with control characters of terminals escaped, and shortened to one line.
#[pyfunction]
pub fn shown(text: &str) -> String {
    asperity::data::shown(text)
}

/// Returns a number with its unit for readers: `2.5 MPa`.
#[pyfunction]
pub fn in_words(value: f64, unit: &str) -> String {
    format_quantity(value, unit)
}

/// Array of NumPy that Python code cannot change.
pub type Array<'py, T> = Bound<'py, PyArray1<T>>;

/// Returns the values as an array of NumPy.
pub fn array<T: Element>(py: Python<'_>, values: Vec<T>) -> Array<'_, T> {
    let array = PyArray1::from_vec(py, values);
    array.readwrite().make_nonwriteable();
    array
}
