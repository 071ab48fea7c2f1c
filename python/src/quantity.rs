//! Quantities: numbers in SI units or texts with a unit, and arrays of numbers.

use crate::failure::Failure;
use asperity::data::{format_quantity, parse_quantity};
use numpy::{Element, PyArray1, PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyString};

/// The number of a quantity in SI units: a number, or a text such as `"2.7 MPa"` for a field of the unit `"Pa"`.
#[pyfunction]
#[pyo3(signature = (value, unit, field))]
pub fn quantity(value: &Bound<'_, PyAny>, unit: &str, field: &str) -> PyResult<f64> {
    if let Ok(text) = value.cast::<PyString>() {
        let text = text.to_str()?;
        let number = parse_quantity(text, unit);
        return number.map_err(|error| Failure::explained(field, text, &error).exception(value.py()));
    }
    let number = if value.is_instance_of::<PyBool>() { None } else { value.extract::<f64>().ok() };
    number.ok_or_else(|| {
        let kind = value.get_type().name().map_or_else(|_| "?".to_owned(), |name| name.to_string());
        PyTypeError::new_err(format!("{field}: {kind}; allowed: a number in {unit}, or a text with its unit"))
    })
}

/// A whole number from `least` to `most`.
#[pyfunction]
pub fn whole(value: &Bound<'_, PyAny>, field: &str, least: u64, most: u64) -> PyResult<u64> {
    let number = value.call_method0("__index__").and_then(|number| number.extract::<u64>());
    match number {
        Ok(number) if (least..=most).contains(&number) => Ok(number),
        _ => {
            let allowed = format!("a whole number from {least} to {most}");
            Err(Failure::field(field, value.repr()?, allowed).exception(value.py()))
        }
    }
}

/// Calls a function with the numbers of an array of up to this many dimensions and with its shape. The array is copied only if
/// its numbers do not lie in a row as float64.
///
/// # Errors
/// Another shape or type, no number, or one that is not finite: with the name of the argument and what is allowed.
pub fn with_numbers<R>(
    values: &Bound<'_, PyAny>,
    (field, dimensions): (&str, usize),
    work: impl FnOnce(&[f64], &[usize]) -> Result<R, Failure>,
) -> PyResult<R> {
    let py = values.py();
    let refused = |found: String| {
        let words = if dimensions == 1 { "a one-dimensional" } else { "a one- or two-dimensional" };
        let allowed = format!("{words} array of finite real numbers, at least one");
        Failure::field(field, found, allowed).exception(py)
    };
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("asarray", (values,));
    let array = array.map_err(|error| refused(error.value(py).to_string()))?;
    let array = array.cast_into::<PyUntypedArray>().map_err(|_| refused("no array".to_owned()))?;
    if !(1..=dimensions).contains(&array.ndim()) || array.shape().contains(&0) {
        return Err(refused(format!("an array of the shape {}", array.getattr("shape")?)));
    }
    let kind: String = array.dtype().getattr("kind")?.extract()?;
    if !["f", "i", "u"].contains(&kind.as_str()) {
        return Err(refused(format!("an array of the type {}", array.dtype())));
    }
    let array = numpy.call_method1("ascontiguousarray", (array, "f8"))?;
    let array =
        array.cast_into::<PyArrayDyn<f64>>().map_err(|_| refused("no array of float64".to_owned()))?;
    let array = array.try_readonly()?;
    let numbers = array.as_slice()?;
    match numbers.iter().position(|number| !number.is_finite()) {
        Some(index) => Err(refused(format!("{} with the index {index}", numbers[index]))),
        None => work(numbers, array.shape()).map_err(|failure| failure.exception(py)),
    }
}

/// An array of Python that cannot be changed.
pub fn array<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    let array = PyArray1::from_vec(py, values);
    array.readwrite().make_nonwriteable();
    array
}

/// A number with its unit as people read it: `2.5 MPa`.
#[pyfunction]
pub fn in_words(value: f64, unit: &str) -> String {
    format_quantity(value, unit)
}
