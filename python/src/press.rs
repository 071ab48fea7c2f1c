//! The contact of a square map without adhesion in three dimensions.

use crate::computing::computed;
use crate::quantity::array;
use asperity_half_space::{Boundary, HalfSpace, Load, Square};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Presses a rigid square map of heights (m) on a half-space, to a residual in rms heights. The load is the side of the map (m), the
/// effective modulus (Pa) and the force (N). Pressures and gaps are in rows one after the other.
#[pyfunction]
pub fn press<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'py, f64>,
    load: (f64, f64, f64),
    is_periodic: bool,
    residual: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let ((side, effective_modulus, force), cells) = (load, heights.shape()[0]);
    let heights = heights.as_slice()?.to_vec();
    let pressed = computed(py, None, |watch| {
        let square = Square { heights: &heights, side, effective_modulus };
        let boundary = if is_periodic { Boundary::Periodic } else { Boundary::Free };
        let stop = || watch.stop();
        Ok(HalfSpace::new(cells, boundary)?.press(&square, Load::Force(force), residual, &stop)?)
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
