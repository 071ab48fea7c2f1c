//! Contact of a square map of heights with an elastic half-space, without adhesion, for calls from
//! Python.

use crate::computing::computed;
use crate::failure::Failure;
use crate::quantity::{Array, array};
use asperity::data::format_quantity;
use asperity_half_space::{Boundary, HalfSpace, Load, Square};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

/// Presses a rigid square map, given by its heights in m, against an elastic half-space. `load` has
/// the side of the map (m), the effective modulus (Pa) and the force (N). `residual` is the allowed
/// residual in units of the rms height. Returns the pressures (Pa) and gaps (m) row by row, and
/// then force (N), indentation (m), area of contact (m²), residual, and number of convolutions.
#[pyfunction]
pub fn press<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'py, f64>,
    load: (f64, f64, f64),
    is_periodic: bool,
    residual: f64,
) -> PyResult<([Array<'py, f64>; 2], [f64; 5])> {
    let cells = heights.shape()[0];
    let heights = heights.as_slice()?.to_vec();
    let (side, modulus, force) = load;
    let found = computed(py, None, move |watch| {
        let square = Square {
            heights: &heights,
            side,
            modulus,
        };
        let boundary = if is_periodic {
            Boundary::Periodic
        } else {
            Boundary::Free
        };
        let mut space = HalfSpace::new(cells, boundary)?;
        Ok(space.press(&square, Load::Force(force), residual, &|| watch.stop())?)
    })?;
    let mut values = found.pressure.iter().chain(&found.gap);
    if !(values.all(|value| value.is_finite()) && found.indentation.is_finite()) {
        let allowed = "a force whose indentation is not far larger than the heights of the map";
        return Err(Failure::field("force", &format_quantity(force, "N"), allowed).into());
    }
    if found.residual > residual {
        let allowed = format!(
            "at least {:.1e}, which rounding leaves for this map and this force",
            found.residual
        );
        return Err(Failure::field("residual", &format!("{residual:e}"), &allowed).into());
    }
    let numbers = [
        found.force,
        found.indentation,
        found.area,
        found.residual,
        found.convolutions as f64,
    ];
    Ok((
        [found.pressure, found.gap].map(|map| array(py, map)),
        numbers,
    ))
}
