//! Conversion of values between Python and Rust: numbers in SI units, texts with a unit, and arrays
//! of numbers.

use crate::failure::Failure;
use asperity::data::{format_quantity, parse_quantity};
use asperity::scene::fields::field;
use asperity::study::Quantity;
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;

/// Converts a text such as `"2.7 MPa"` to a number in the SI unit `unit`, here `"Pa"`. If the text
/// is not allowed, the message of the error names the Python argument `field`.
#[pyfunction]
pub fn parsed(text: &str, unit: &str, field: &str) -> Result<f64, Failure> {
    parse_quantity(text, unit).map_err(|error| Failure::explained(field, text, &error))
}

/// Returns the SI unit of the number at a path in a scene. The same path may occur in several
/// variants of the form or of the roughness. `variant` is the name of the variant.
#[pyfunction]
pub fn unit_of(path: &str, variant: &str) -> &'static str {
    field(path, Some(variant)).map_or("1", |field| field.unit)
}

/// Returns `number` if a scene allows this value in the field at `path`. Otherwise returns an error
/// that names the Python argument `argument`. `variant` is the name of the form or of the roughness
/// to which the field belongs.
#[pyfunction]
pub fn in_field(number: f64, path: &str, variant: &str, argument: &str) -> Result<f64, Failure> {
    match field(path, Some(variant)) {
        Some(field) if field.range.ends().is_some() && !field.range.contains(number) => Err(
            Failure::field(argument, &number.to_string(), &field.allowed()),
        ),
        _ => Ok(number),
    }
}

/// Returns a text in one line that is safe to show on a terminal: it is shortened, and control
/// characters are escaped.
#[pyfunction]
pub fn shown(text: &str) -> String {
    asperity::data::shown(text)
}

/// Returns a number with its unit as text for readers, such as `2.5 MPa`.
#[pyfunction]
pub fn in_words(value: f64, unit: &str) -> String {
    format_quantity(value, unit)
}

/// Returns the quantities that a study records: name, symbol, unit and description of each.
#[pyfunction]
pub fn quantities() -> Vec<[&'static str; 4]> {
    let mut rows = Vec::new();
    for quantity in Quantity::ALL {
        rows.push([
            quantity.name(),
            quantity.symbol(),
            quantity.unit(),
            quantity.meaning(),
        ]);
    }
    rows
}

/// NumPy array that Python code cannot change.
pub type Array<'py, T> = Bound<'py, PyArray1<T>>;

/// Returns the values as a NumPy array.
pub fn array<T: Element>(py: Python<'_>, values: Vec<T>) -> Array<'_, T> {
    let array = PyArray1::from_vec(py, values);
    array.readwrite().make_nonwriteable();
    array
}
