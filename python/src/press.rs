//! The contact of a square map without adhesion in three dimensions.

use crate::computing::computed;
use crate::failure::Failure;
use crate::quantity::{array, with_numbers};
use asperity_half_space::{Boundary, HalfSpace, Load, Square};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Presses a rigid square map of heights (m) with a side (m) on a half-space of this effective modulus (Pa) with a force (N), to a
/// residual in rms heights. Pressures and gaps are in rows one after the other.
#[pyfunction]
pub fn press<'py>(
    py: Python<'py>,
    heights: &Bound<'py, PyAny>,
    load: (f64, f64, f64),
    is_periodic: bool,
    residual: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let (side, effective_modulus, force) = load;
    let heights = with_numbers(heights, ("heights", 2), |heights, shape| match *shape {
        [rows, columns] if rows == columns => Ok((heights.to_vec(), rows)),
        _ => Err(Failure::field("heights", format!("an array of the shape {shape:?}"), "a square map")),
    });
    let (heights, cells) = heights?;
    let pressed = computed(py, None, |watch| {
        let square = Square { heights: &heights, side, effective_modulus };
        let boundary = if is_periodic { Boundary::Periodic } else { Boundary::Free };
        let mut half_space = HalfSpace::new(cells, boundary).map_err(|error| error.to_string())?;
        let pressed = half_space.press(&square, Load::Force(force), residual, &|| watch.stop());
        Ok(pressed.map_err(|error| error.to_string())?)
    })?;
    let values = PyDict::new(py);
    values.set_item("pressure", array(py, pressed.pressure))?;
    values.set_item("gap", array(py, pressed.gap))?;
    values.set_item("force", pressed.force)?;
    values.set_item("indentation", pressed.indentation)?;
    values.set_item("area", pressed.area)?;
    values.set_item("residual", pressed.residual)?;
    values.set_item("convolutions", pressed.convolutions)?;
    Ok(values)
}
