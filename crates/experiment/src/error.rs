//! The reasons why a curve cannot be read or fitted.

use asperity_contact::ContactError;
use asperity_data::{Remedied, Remedy, format_quantity};
use asperity_scene::RunError;
use asperity_surface::SurfaceError;
use std::fmt;
use std::ops::RangeInclusive;
use thiserror::Error;

/// Part of a curve that is counted in an error: the part has too few points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountedPart {
    /// The whole curve.
    Curve,
    /// The chosen segments without the pauses between them.
    ChosenSegments,
}

impl fmt::Display for CountedPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            CountedPart::Curve => "with displacement and force",
            CountedPart::ChosenSegments => "in the segments that are used, without pauses",
        })
    }
}

/// Change of the force along a straight line, divided by the noise, above which the line is too
/// steep for a part without contact.
const STEEP_LINE: f64 = 20.0;

/// Reason why a measured force curve cannot be read, or why a scene cannot be fitted to it.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// The file of the curve cannot be read, or its content is no table with columns of
    /// displacement and force.
    #[error(transparent)]
    File(#[from] SurfaceError),
    /// A curve, or a part of it, has too few points.
    #[error("{found} points {part}; allowed: at least {least}")]
    TooFewPoints {
        /// The curve or its part.
        part: CountedPart,
        /// Number of points that were found.
        found: usize,
        /// Smallest number of points that is allowed.
        least: usize,
    },
    /// The approach has too few points to find where the contact begins.
    #[error(
        "{found} points in the approach are too few to find the contact; allowed: at least {least}, or a stated number of \
         points before contact"
    )]
    ShortApproach {
        /// Number of points that the approach has.
        found: usize,
        /// Smallest number of points that the approach must have.
        least: usize,
    },
    /// The part of the curve without contact has too few points, or this part contains all points.
    #[error(
        "no part {part} contact: {found} of {points} points; allowed: at least {least}, found or stated"
    )]
    NoFreePart {
        /// Name of the missing part: `before` for the part before contact, `without` for any part
        /// without contact.
        part: &'static str,
        /// Number of points without contact.
        found: usize,
        /// Number of points among which the points without contact are sought.
        points: usize,
        /// Smallest number of points without contact.
        least: usize,
    },
    /// The force changes from the first point of the curve on.
    #[error(
        "no part before contact: the force changes from the first point on; allowed: an approach that begins farther away, a \
         stated number of points before contact, or the retraction alone"
    )]
    BeginsInContact,
    /// The force of the approach stays on one straight line, so that no contact is found.
    #[error("{}", no_contact(*range, *noise))]
    NoContact {
        /// Change of the force in N along the line.
        range: f64,
        /// Deviation in N of the force from the line.
        noise: f64,
    },
    /// The displacement never turns, so there is no retraction.
    #[error(
        "the displacement does not turn: one segment; allowed: an approach and a retraction, of several files joined in one; a \
         retraction alone that ends without contact; an approach alone that is asked for"
    )]
    OneSegment,
    /// The force is tensile at a place where the body is pressed most.
    #[error(
        "the force is negative where the body presses: {} at the {place}; allowed: another sign of the force, or the sign of the \
         file as stated",
        format_quantity(*force, "N")
    )]
    NegativeWherePressed {
        /// Force in N at this place.
        force: f64,
        /// Place on the curve, in words.
        place: &'static str,
    },
    /// The curve has no segment with this number.
    #[error(
        "segment {wanted}: the curve has no such segment; allowed: {}",
        listed(segments)
    )]
    NoSuchSegment {
        /// Number of the segment that the options ask for.
        wanted: usize,
        /// Numbers of the segments of the curve.
        segments: RangeInclusive<usize>,
    },
    /// The curve cannot be read or fitted, because a property of the curve, the scene or an option
    /// is not allowed.
    #[error("{found}; allowed: {allowed}")]
    Refused {
        /// What was found in the curve, the scene or the options, in words.
        found: String,
        /// What is allowed instead, in words.
        allowed: String,
        /// Steps that help; empty if no single step helps.
        remedies: Vec<Remedy>,
    },
    /// One of several curves has a fault.
    #[error("{name}: {error}")]
    InCurve {
        /// Name of the curve.
        name: String,
        /// Fault of this curve.
        error: Box<ExperimentError>,
    },
    /// The computation of force curves for a fit failed, or the [`Control`](asperity_data::Control)
    /// of the fit stopped it.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// Returns the message for a force that stays on a straight line. `range` is the change of the
/// force along the line and `noise` the deviation from the line, both in N.
fn no_contact(range: f64, noise: f64) -> String {
    if range > STEEP_LINE * noise {
        let range = format_quantity(range, "N");
        return format!(
            "no contact, or contact from the first point on: the force changes by {range} along one straight line; allowed: a \
             part before contact, then another slope; for a weak contact a stated number of points before it"
        );
    }
    let noise = format_quantity(noise, "N");
    format!(
        "no contact: in the approach the force stays within its noise of {noise}; allowed: a change by more than the noise; for \
         a weak contact a stated number of points before it"
    )
}

fn listed(segments: &RangeInclusive<usize>) -> String {
    let numbers: Vec<String> = segments.clone().map(|number| number.to_string()).collect();
    numbers.join(", ")
}

impl Remedied for ExperimentError {
    fn remedies(&self) -> Vec<Remedy> {
        match self {
            ExperimentError::File(error) => error.remedies(),
            ExperimentError::Run(error) => error.remedies(),
            ExperimentError::InCurve { error, .. } => error.remedies(),
            ExperimentError::Refused { remedies, .. } => remedies.clone(),
            ExperimentError::ShortApproach { .. }
            | ExperimentError::NoFreePart { .. }
            | ExperimentError::NoContact { .. } => vec![Remedy::FreePoints],
            ExperimentError::BeginsInContact => vec![Remedy::FreePoints, Remedy::Segment(2)],
            ExperimentError::OneSegment => vec![Remedy::Segment(1)],
            ExperimentError::NegativeWherePressed { .. } => {
                vec![Remedy::NegateForce, Remedy::NegateNone]
            }
            ExperimentError::TooFewPoints { .. } | ExperimentError::NoSuchSegment { .. } => {
                Vec::new()
            }
        }
    }
}

impl From<ContactError> for ExperimentError {
    fn from(error: ContactError) -> Self {
        ExperimentError::Run(error.into())
    }
}

/// Returns the error of a curve or a scene that cannot be fitted.
pub(crate) fn refused<T>(
    found: impl Into<String>,
    allowed: impl Into<String>,
) -> Result<T, ExperimentError> {
    Err(ExperimentError::Refused {
        found: found.into(),
        allowed: allowed.into(),
        remedies: Vec::new(),
    })
}

/// Returns the error of a curve or a scene that cannot be fitted, with the steps that help.
pub(crate) fn refused_with<T>(
    found: impl Into<String>,
    allowed: impl Into<String>,
    remedies: impl Into<Vec<Remedy>>,
) -> Result<T, ExperimentError> {
    Err(ExperimentError::Refused {
        found: found.into(),
        allowed: allowed.into(),
        remedies: remedies.into(),
    })
}
