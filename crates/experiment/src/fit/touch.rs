//! Displacement of first touch, if a fit does not search the offset.

use crate::curve::MeasuredCurve;
use crate::error::ExperimentError;
use crate::fit::model::Model;
use crate::fit::parameter::{Free, Parameter};
use crate::fit::search::Search;
use crate::fit::searched::ENOUGH_POINTS;
use crate::fit::space::Space;
use asperity_data::{Note, Remedy, format_rounded};
use asperity_scene::{Document, Simulation};

/// First touch of the body and the surface, for a fit that does not search the offset.
#[derive(Clone, Copy)]
pub(crate) struct Touch {
    /// Displacement in m at which the body first touches the surface.
    pub displacement: f64,
    /// Number of force curves that were computed to find this displacement.
    pub evaluations: usize,
}

/// Returns the displacement of first touch at which the model, with the best values of the free
/// parameters, agrees best with a curve. Returns `None` if the offset is a free parameter. The
/// touch that the curve shows without a model may be wrong by the distance of two points, or by
/// more if its contact is weak. A work of adhesion found with a wrong touch is far from the true
/// work.
pub(crate) fn touch_of_best(
    curve: &MeasuredCurve,
    document: &Document,
    free: &[Free],
    simulation: &mut Simulation,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Touch>, ExperimentError> {
    if free.is_empty() || free.iter().any(|free| free.parameter == Parameter::Offset) {
        return Ok(None);
    }
    let part = curve.thinned(ENOUGH_POINTS);
    let curve = part.as_ref().unwrap_or(curve);
    let mut with_offset = free.to_vec();
    with_offset.push(Parameter::Offset.into());
    let (document, space) = Space::of(curve, document, simulation, &with_offset, stop)?;
    let mut no_report = |_| {};
    let model = Model::new(curve, document.scene(), simulation);
    let mut search = Search::of_curve(&space, model, &mut no_report);
    let best = search.descended()?;
    Ok(Some(Touch {
        displacement: space.values(&best.place)[Parameter::Offset as usize],
        evaluations: search.evaluations(),
    }))
}

/// Returns a sentence on the first touch of a fit that does not search the offset. `touch` is the
/// displacement of first touch in m. If the noise is small, a touch that is wrong by half the
/// distance of two points shifts the modulus by more than its interval.
pub(crate) fn fixed_contact_point(curve: &MeasuredCurve, touch: f64) -> Note {
    let mut next = f64::INFINITY;
    for displacement in &curve.displacement {
        next = next.min((displacement - touch).abs());
    }
    let contact_point = format_rounded(touch, 3, "m");
    let next = format_rounded(next, 3, "m");
    let text = format!(
        "First touch was taken at {contact_point}, where it is best for the curve, and the nearest point is {next} away. The \
         offset was not fitted, so the intervals leave out this uncertainty."
    );
    Note::new(text).with(Remedy::Free(Parameter::Offset.name().to_owned()))
}
