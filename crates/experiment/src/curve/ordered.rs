//! Conversion of the columns of a file to points in the order of time, with displacements and
//! forces that are positive where the body is pressed.

use crate::curve::free_parts::ends_free;
use crate::curve::points::Points;
use crate::curve::segments::Segments;
use crate::error::ExperimentError;
use crate::read::options::{CurveOptions, Negate};
use crate::read::points::Columns;
use asperity_data::Note;

/// Largest number of points that a fit uses. If a curve has more points, neighbouring points are
/// averaged.
pub(crate) const MOST_POINTS: usize = 4096;

/// Points of a curve in the order of time, with displacement and force positive where the body is
/// pressed, and sentences on how the columns of the file were changed to this form.
pub(crate) struct Ordered {
    pub points: Points,
    /// Number of neighbouring points of the file whose mean is one of the points.
    pub averaged: usize,
    /// Name of the column of displacements if these are displacements of the body, without the
    /// deflection of the instrument; otherwise `None`.
    pub of_body: Option<String>,
    /// Phrases of the first sentence of the report on the curve, which states for example the
    /// choice of columns.
    pub assumed: Vec<String>,
    /// Further sentences of the report on the curve.
    pub statements: Vec<Note>,
}

impl Ordered {
    /// Puts the points of the file in the order of time, with displacement and force positive where
    /// the body is pressed. The statements and the name of the column of the body are moved out of
    /// `columns`. `least_noise` is the smallest standard deviation in N that the noise of the force
    /// can have.
    ///
    /// # Errors
    /// Returns an error if the curve has only one segment where it needs two, or if the body does
    /// not approach first.
    pub fn of(
        columns: &mut Columns,
        options: &CurveOptions,
        least_noise: f64,
    ) -> Result<Self, ExperimentError> {
        let mut segments = Segments::of(&columns.displacement, &columns.labels);
        let reordered = put_in_order(columns, &mut segments, least_noise);
        let averaged = points_in_mean(&segments);
        let times = take_times_out_of_order(columns);
        let mut points = Points::averaged(columns, &segments, averaged);

        let sentences = std::mem::take(&mut columns.statements);
        let mut statements: Vec<Note> = sentences.into_iter().map(Note::new).collect();
        statements.extend(times.map(Note::new));
        let retraction = recognise_retraction(&mut points, options, least_noise)?;
        statements.extend(retraction.map(Note::new));
        let negate = points.reverse(options.negate)?;
        let stated_stiffness = columns.stiffness.as_ref().map(|(_, stiffness)| *stiffness);
        let mut of_body = columns.of_body.take();
        if let Some(name) = &of_body
            && let Some(stiffness) = options.instrument.or(stated_stiffness)
        {
            statements.push(points.add_deflection(name, stiffness).into());
            of_body = None;
        }

        let mut assumed = vec![std::mem::take(&mut columns.assumed)];
        assumed.extend(reordered.map(str::to_owned));
        if negate != Negate::None {
            assumed.push(format!("{negate} reversed, so that pressing is positive"));
        }
        Ok(Ordered {
            points,
            averaged,
            of_body,
            assumed,
            statements,
        })
    }
}

/// Removes the times of the points if they do not grow from point to point, and returns a sentence
/// on this.
fn take_times_out_of_order(columns: &mut Columns) -> Option<&'static str> {
    let are_finite = columns.seconds.iter().all(|seconds| seconds.is_finite());
    let grow = columns.seconds.windows(2).all(|pair| pair[0] < pair[1]);
    if are_finite && grow {
        return None;
    }
    columns.seconds.clear();
    Some("The times do not grow from point to point and are not used.")
}

/// Returns how many neighbouring points are averaged, so that at most [`MOST_POINTS`] means result.
fn points_in_mean(segments: &Segments) -> usize {
    let moving = segments
        .is_still
        .iter()
        .filter(|is_still| !**is_still)
        .count();
    moving.div_ceil(MOST_POINTS).max(1)
}

/// Marks the points of a curve of one segment as a retraction if the segment ends without contact,
/// and returns a sentence on this. Returns an error for any other curve of one segment, unless the
/// options choose this segment.
fn recognise_retraction(
    points: &mut Points,
    options: &CurveOptions,
    least_noise: f64,
) -> Result<Option<String>, ExperimentError> {
    if points.last_segment() != 0 {
        return Ok(None);
    }
    if ends_free(&points.force, least_noise) {
        points.segment.fill(1);
        let statement = "A retraction alone: the model is loaded up to its first point.";
        return Ok(Some(statement.to_owned()));
    }
    if options.segments == [1] {
        return Ok(None);
    }
    Err(ExperimentError::OneSegment)
}

/// Brings approach and retraction into the order of time, and returns a phrase on the change;
/// `None` if the order was right. If a file has the columns of approach and retraction side by
/// side, the rows of both may begin at the turning point. A file may also contain the retraction
/// before the approach.
fn put_in_order(
    columns: &mut Columns,
    segments: &mut Segments,
    least_noise: f64,
) -> Option<&'static str> {
    let first = segments.numbers.partition_point(|number| *number == 0);
    let (first_forces, second_forces) = columns.force.split_at(first);
    let reversed: Vec<f64> = second_forces.iter().rev().copied().collect();
    let has_two = segments.numbers.last() == Some(&1);
    if !(has_two && ends_free(first_forces, least_noise) && ends_free(&reversed, least_noise)) {
        return None;
    }
    if columns.is_beside {
        for values in [&mut columns.displacement, &mut columns.force] {
            values[..first].reverse();
            values[first..].reverse();
        }
        columns.seconds.clear();
        segments.is_still.fill(false);
        return Some("both parts begin at their turn and were reversed");
    }
    columns.displacement.rotate_left(first);
    columns.force.rotate_left(first);
    if !columns.seconds.is_empty() {
        columns.seconds.rotate_left(first);
    }
    segments.exchange(first);
    Some("the retraction comes first and was put behind the approach")
}
