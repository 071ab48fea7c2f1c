//! Stiffness of the instrument with which all curves were measured.

use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused};
use crate::fit::scene::wrong;
use asperity_data::format_quantity;
use asperity_scene::Document;

/// Relative difference up to which two stiffnesses count as equal.
const SAME_STIFFNESS: f64 = 0.01;

/// Returns the scene with the stiffness of the instrument that the files state, and a sentence on
/// this change.
pub(super) fn with_instrument(
    curves: &[(String, MeasuredCurve)],
    document: &Document,
) -> Result<(Document, Option<String>), ExperimentError> {
    let (first_name, first_curve) = &curves[0];
    let first = first_curve.with_instrument(document).map_err(wrong)?;
    let stiffness = stiffness_of(&first.0);
    for (name, curve) in curves {
        let (with_other, _) = curve.with_instrument(document).map_err(wrong)?;
        let other = stiffness_of(&with_other);
        if stiffness != other && (stiffness / other).ln().abs() > SAME_STIFFNESS {
            let stiffness = format_quantity(stiffness, "N/m");
            let other = format_quantity(other, "N/m");
            let found = format!(
                "{name}: a loading stiffness of {other}, and of {stiffness} in {first_name}"
            );
            return refused(found, "curves of one instrument");
        }
    }
    Ok(first)
}

fn stiffness_of(document: &Document) -> f64 {
    document.scene().loading_stiffness.unwrap_or(f64::INFINITY)
}
