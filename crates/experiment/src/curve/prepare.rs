//! Reading of a measured curve, and the steps from the columns of a file to a curve that can be
//! fitted.

use crate::curve::drag::{Drag, DragForce};
use crate::curve::features::{CurveFeatures, jumps_of};
use crate::curve::free_parts::{FEWEST, FreeParts};
use crate::curve::numerics::{Extent, dot};
use crate::curve::ordered::Ordered;
use crate::curve::points::Points;
use crate::curve::segments::are_shuffled;
use crate::curve::statements::{counted, drag_in_words, means_in_words, noise_in_words};
use crate::curve::timing::{InContact, Timing};
use crate::curve::zero::Subtracted;
use crate::curve::{LEAST_TENSION, MeasuredCurve, SubtractedLines};
use crate::error::{CountedPart, ExperimentError, refused, refused_with};
use crate::read;
use crate::read::options::CurveOptions;
use crate::read::points::Columns;
use crate::read::several::SeveralCurves;
use asperity_data::{Remedy, mean};
use asperity_surface::files::content;
use std::path::Path;

/// Smallest number of points of a curve, so that both segments can have enough points with and
/// without contact.
const FEWEST_POINTS: usize = 4 * FEWEST;
/// Standard deviation of the noise that is assumed for a curve without noise, as a share of the
/// range of the force.
const NO_NOISE: f64 = 1e-5;
/// Largest deviation from a whole number with which a quotient of a force and the last digit still
/// counts as whole. Smaller deviations come from rounding.
const ROUNDED: f64 = 0.05;
/// Largest force at the end of a retraction, as a share of the largest tension, with which the body
/// still counts as detached.
const STILL_HELD: f64 = 0.3;

impl MeasuredCurve {
    /// Reads a curve from `bytes`, which are the content of a file with this name. No file is
    /// opened.
    ///
    /// # Errors
    /// Returns an error in the same cases as [`MeasuredCurve::read`].
    ///
    /// ```
    /// use asperity_experiment::{CurveOptions, MeasuredCurve};
    /// use std::path::Path;
    ///
    /// let way = |i: i32| if i < 150 { i - 100 } else { 200 - i }; // nm
    /// let rows: String = (0..300)
    ///     .map(way)
    ///     .map(|d| format!("{d},{}\n", 2 * d.max(0)))
    ///     .collect();
    /// let text = format!("displacement [nm],force [nN]\n{rows}");
    /// let curve = MeasuredCurve::parse(
    ///     Path::new("curve.csv"),
    ///     text.as_bytes(),
    ///     &CurveOptions::default(),
    /// )?;
    /// assert_eq!(curve.points().last(), Some((-99e-9, 0.0)));
    /// assert!(curve.statements[0].to_string().contains("2 segments"));
    /// # Ok::<(), asperity_experiment::ExperimentError>(())
    /// ```
    pub fn parse(
        name: &Path,
        bytes: &[u8],
        options: &CurveOptions,
    ) -> Result<Self, ExperimentError> {
        MeasuredCurve::prepare(read::parse(name, bytes, options)?, options)
    }

    /// Creates a curve from displacements in m and forces in N, in the order of time. A point with
    /// a value that is not finite is left out. The options `columns`, `units` and `ramp` have no
    /// effect, because they describe a file.
    ///
    /// # Errors
    /// Returns an error if the slices differ in length, or if [`MeasuredCurve::read`] would refuse
    /// a file with this curve.
    ///
    /// ```
    /// use asperity_experiment::{CurveOptions, MeasuredCurve};
    ///
    /// // A spring of 10 N/m that is pressed from 0 to 50 nm and released.
    /// let way = |i: i32| 1e-9 * f64::from(if i < 150 { i - 100 } else { 200 - i });
    /// let displacement: Vec<f64> = (0..300).map(way).collect();
    /// let force: Vec<f64> = displacement.iter().map(|d| 10.0 * d.max(0.0)).collect();
    /// let curve = MeasuredCurve::from_columns(&displacement, &force, &CurveOptions::default())?;
    /// assert_eq!((curve.points, curve.segment[299]), (300, 1));
    /// assert!(curve.touch.abs() < 2e-9 && curve.pull_off_force().is_none());
    /// assert!(
    ///     MeasuredCurve::from_columns(&displacement, &force[1..], &CurveOptions::default())
    ///         .is_err()
    /// );
    /// # Ok::<(), asperity_experiment::ExperimentError>(())
    /// ```
    pub fn from_columns(
        displacement: &[f64],
        force: &[f64],
        options: &CurveOptions,
    ) -> Result<Self, ExperimentError> {
        MeasuredCurve::prepare(Columns::of_arrays(displacement, force, &[])?, options)
    }

    /// Creates a curve as [`MeasuredCurve::from_columns`] does, with the time of each point in s. A
    /// fit with relaxation derives the speed of the instrument, and the time for which it rests,
    /// from these times.
    ///
    /// # Errors
    /// Returns an error if the slices differ in length, or if [`MeasuredCurve::read`] would refuse
    /// a file with this curve.
    pub fn from_timed_columns(
        displacement: &[f64],
        force: &[f64],
        seconds: &[f64],
        options: &CurveOptions,
    ) -> Result<Self, ExperimentError> {
        let columns = Columns::of_arrays(displacement, force, seconds)?;
        MeasuredCurve::prepare(columns, options)
    }

    /// Returns true if the file at `path` can be read and has columns of displacement and force, of
    /// one curve or of several.
    pub fn is_in(path: &Path) -> bool {
        let Ok(bytes) = content(path) else {
            return false;
        };
        let options = CurveOptions::default();
        match read::parse(path, &bytes, &options) {
            Ok(columns) => !columns.force.is_empty(),
            // The lines between several curves are no rows of one table.
            Err(_) => SeveralCurves::parse(path, &bytes, &options).is_some(),
        }
    }

    /// Prepares a curve for fits: finds its segments, averages its points, reverses signs, finds
    /// the parts without contact, and subtracts drag, zero offset, drift and tilt of the force. A
    /// sentence on each step is stored in the curve, for the report.
    fn prepare(mut columns: Columns, options: &CurveOptions) -> Result<Self, ExperimentError> {
        check(&columns, options)?;
        let least_noise = least_noise(&columns.force);
        let left_out = columns.left_out();
        let Ordered {
            mut points,
            averaged,
            of_body,
            mut assumed,
            mut statements,
        } = Ordered::of(&mut columns, options, least_noise)?;

        let mut free = FreeParts::of(&points, options, averaged, least_noise)?;
        let drag = take_drag_off(&mut points, &mut free, options);
        let noise = options.noise.unwrap_or(free.line(&points).noise);
        let noise = noise.max(least_noise);
        let subtracted = free.subtract_lines(&mut points, options, noise)?;
        check_sign(&points, options, noise)?;
        let kept = kept(&points, options)?;
        let jumps = jumps_of(&points, noise);
        let features = CurveFeatures::of(&points, &jumps, noise);
        let drag_in_contact = drag_in_contact(drag.as_ref(), &subtracted);
        let touch = free.contact_point(&points);

        assumed.extend(counted(&points, &kept, &free, options));
        assumed.extend(left_out);
        assumed.extend(means_in_words(&points, averaged));
        statements.insert(0, format!("{}.", assumed.join("; ")).into());
        let noise_statement = noise_in_words(noise, options, &free).into();
        statements.push(subtracted.statement.clone().then(&noise_statement));
        statements.extend(drag_in_contact.map(|drag| drag_in_words(&drag).into()));
        statements.push(features.sentence().into());

        let remaining = subtracted.remaining;
        let has_zero = options.zero.is_none();
        let lines = lines_of(subtracted, drag.as_ref(), &points);
        let contact = InContact {
            touch,
            end: points.force.len() - free.after,
        };
        let timing = Timing::of(&points, &kept, &lines, contact);
        let lines = SubtractedLines::of(&lines, &kept, &free, has_zero);
        let values_of = |values: &[f64]| kept.iter().map(|index| values[*index]).collect();
        Ok(MeasuredCurve {
            displacement: values_of(&points.displacement),
            force: values_of(&points.force),
            segment: kept.iter().map(|index| points.segment[*index]).collect(),
            free: count_before_contact(&kept, &free),
            free_at_end: count_at_end(&kept, &points, &free),
            touch,
            timing,
            seconds_at_rest: Vec::new(),
            noise,
            features,
            jumps,
            drag: drag_in_contact,
            drag_over_distance: drag,
            detaches: detaches(&points, noise),
            points: kept.iter().map(|index| points.counts[*index]).sum(),
            missing: columns.missing,
            turns: points.turns(last_turn(&points, options)),
            remaining,
            subtracted: lines,
            stiffness: columns.stiffness,
            of_body,
            statements,
        })
    }
}

impl SubtractedLines {
    /// Returns the subtracted contributions at the points of the curve. `lines` are their values at
    /// all points of the file, and `kept` has the indices of the points of the curve among them.
    fn of(lines: &[Vec<f64>], kept: &[usize], free: &FreeParts, has_zero: bool) -> Self {
        let mut columns = Vec::with_capacity(lines.len());
        for line in lines {
            columns.push(kept.iter().map(|index| line[*index]).collect());
        }
        SubtractedLines {
            has_zero,
            elsewhere: products_elsewhere(lines, kept, free),
            columns,
        }
    }
}

/// Returns the values of all subtracted lines, except the constant zero offset, at all points.
fn lines_of(subtracted: Subtracted, drag: Option<&Drag>, points: &Points) -> Vec<Vec<f64>> {
    let mut lines = subtracted.columns;
    if let Some(drag) = drag {
        lines.extend(drag.columns(&points.displacement, &points.segment));
    }
    lines
}

/// Finds the drag of a fluid, subtracts the drag from the force, and returns it; `None` if there is
/// no drag. The parts without contact in `free` are replaced by the parts that the drag describes.
fn take_drag_off(
    points: &mut Points,
    free: &mut FreeParts,
    options: &CurveOptions,
) -> Option<Drag> {
    let drag = Drag::find(points, free, options)?;
    drag.subtract(points);
    free.before = Some(drag.before);
    free.after = drag.after;
    Some(drag)
}

/// Returns the smallest standard deviation in N that the noise of the forces can have: the rounding
/// error of their last digit, or a small share of their range.
fn least_noise(forces: &[f64]) -> f64 {
    let range = Extent::of(forces.iter().copied()).width();
    let of_digits = digit(forces).map_or(0.0, |digit| digit / 12.0_f64.sqrt());
    of_digits.max(NO_NOISE * range)
}

/// Returns the step in N between the values that the forces can have, if all forces are whole
/// multiples of such a step, as the output of an analogue-digital converter is. Returns `None` if
/// there is no such step, or if the step is below the range of the forces times [`NO_NOISE`].
fn digit(forces: &[f64]) -> Option<f64> {
    let mut sorted = forces.to_vec();
    sorted.sort_by(f64::total_cmp);
    let lowest = *sorted.first()?;
    let range = sorted.last()? - lowest;
    let differences = sorted.windows(2).map(|pair| pair[1] - pair[0]);
    let digit = differences
        .filter(|difference| *difference > NO_NOISE * range)
        .fold(f64::INFINITY, f64::min);
    let is_whole = |force: &f64| {
        let multiple = (force - lowest) / digit;
        (multiple - multiple.round()).abs() < ROUNDED
    };
    (digit.is_finite() && sorted.iter().all(is_whole)).then_some(digit)
}

/// Returns the sum of the products of each pair of columns over the points without contact that are
/// not in `kept`, as a symmetric matrix. Its first row and column belong to a constant column of
/// ones.
fn products_elsewhere(columns: &[Vec<f64>], kept: &[usize], free: &FreeParts) -> Vec<Vec<f64>> {
    let count = free.shares[0].len();
    let before = 0..free.before.unwrap_or(0);
    let after = count - free.after..count;
    let indices: Vec<usize> = before
        .chain(after)
        .filter(|index| kept.binary_search(index).is_err())
        .collect();
    let mut values = vec![vec![1.0; indices.len()]];
    for column in columns {
        values.push(indices.iter().map(|index| column[*index]).collect());
    }
    values
        .iter()
        .map(|row| values.iter().map(|column| dot(row, column)).collect())
        .collect()
}

/// Returns the number of points in `kept` (the points used) that lie after the contact.
fn count_at_end(kept: &[usize], points: &Points, free: &FreeParts) -> usize {
    let first = points.force.len() - free.after;
    kept.len() - kept.partition_point(|index| *index < first)
}

/// Returns true if the body is out of contact at the end of the last retraction. The mean of the
/// last forces must then be small compared with the largest tension, or at most a few standard
/// deviations of the noise.
fn detaches(points: &Points, noise: f64) -> bool {
    let last = points.last_segment();
    if last.is_multiple_of(2) {
        return false;
    }
    let forces = &points.force[points.moving(last)];
    let count = (forces.len() / 50).clamp(3, 20).min(forces.len());
    let end = mean(&forces[forces.len() - count..]);
    let tension = -Extent::of(forces.iter().copied()).low;
    end.abs() < (STILL_HELD * tension).max(LEAST_TENSION * noise)
}

/// Returns the drag of the body in contact that was subtracted from the force; `None` if no drag
/// was subtracted.
fn drag_in_contact(drag: Option<&Drag>, subtracted: &Subtracted) -> Option<DragForce> {
    let mut force = match drag {
        Some(drag) => drag.in_contact(),
        None => DragForce {
            pressed: 0.0,
            pulled: 0.0,
            reach: None,
        },
    };
    force.pulled += subtracted.step_of_retraction;
    let has_drag = force.pressed != 0.0 || force.pulled != 0.0;
    has_drag.then_some(force)
}

/// Returns an error if the columns have too few points or are not in the order of time, or if the
/// noise in the options is out of range.
fn check(columns: &Columns, options: &CurveOptions) -> Result<(), ExperimentError> {
    let count = columns.displacement.len();
    if count < FEWEST_POINTS {
        return Err(ExperimentError::TooFewPoints {
            part: CountedPart::Curve,
            found: count,
            least: FEWEST_POINTS,
        });
    }
    if let Some(noise) = options.noise
        && !(noise > 0.0 && noise.is_finite())
    {
        let found = format!("a noise of {noise} N");
        return refused(found, "a standard deviation above 0");
    }
    if are_shuffled(&columns.displacement) {
        let found = "the displacement goes to and fro from point to point";
        let allowed = "points in the order of time, and the column of the displacement";
        return refused_with(found, allowed, [Remedy::Columns]);
    }
    Ok(())
}

/// Returns the number of points in `kept` (the points used) that lie before the contact.
fn count_before_contact(kept: &[usize], free: &FreeParts) -> usize {
    match free.before {
        Some(before) => kept.partition_point(|index| *index < before),
        None => 0,
    }
}

/// Returns the index of the last segment that a model of the curve has to compute. If the last
/// chosen segment is an approach, this is the retraction after the approach. If a curve of several
/// segments ends with this approach, it is the approach itself.
fn last_turn(points: &Points, options: &CurveOptions) -> usize {
    let last = points.last_segment();
    let chosen = match options.segments.iter().max() {
        Some(most) => (most - 1).min(last),
        None => last,
    };
    let is_approach = chosen.is_multiple_of(2);
    if is_approach && (chosen < last || last == 0) {
        return chosen + 1;
    }
    chosen
}

/// Returns the indices of the points of the chosen segments, without the points of pauses. If the
/// options choose no segment, all segments are used.
fn kept(points: &Points, options: &CurveOptions) -> Result<Vec<usize>, ExperimentError> {
    let numbers = points.segment[0] + 1..=points.last_segment() + 1;
    for number in &options.segments {
        if !numbers.contains(number) {
            return Err(ExperimentError::NoSuchSegment {
                wanted: *number,
                segments: numbers,
            });
        }
    }
    let mut kept = Vec::with_capacity(points.force.len());
    for (index, segment) in points.segment.iter().enumerate() {
        let is_chosen = options.segments.is_empty() || options.segments.contains(&(segment + 1));
        if is_chosen && !points.is_still[index] {
            kept.push(index);
        }
    }
    if kept.len() < 2 * FEWEST {
        return Err(ExperimentError::TooFewPoints {
            part: CountedPart::ChosenSegments,
            found: kept.len(),
            least: 2 * FEWEST,
        });
    }
    Ok(kept)
}

/// Returns the force in N at the end of the approach that ends with the largest force. All
/// approaches are compared, because the first approach may be a partial loading.
fn force_at_largest_turn(points: &Points) -> f64 {
    let mut largest = f64::NEG_INFINITY;
    for number in (0..=points.last_segment()).step_by(2) {
        let range = points.range_of(number);
        let count = (range.len() / 20).max(1);
        if range.len() >= count {
            largest = largest.max(mean(&points.force[range.end - count..range.end]));
        }
    }
    largest
}

/// Returns an error if the force is negative (tensile) where the body is pressed most, because the
/// sign of the force in the file is then probably wrong. The options can state that it is right.
fn check_sign(points: &Points, options: &CurveOptions, noise: f64) -> Result<(), ExperimentError> {
    let is_approach = points.begins_with_approach();
    let pressed = if is_approach {
        force_at_largest_turn(points)
    } else {
        let first = points.range_of(points.segment[0]);
        mean(&points.force[..(first.len() / 20).max(1)])
    };
    if options.negate.is_some() || pressed >= -LEAST_TENSION * noise {
        return Ok(());
    }
    let place = if is_approach {
        "end of the approach"
    } else {
        "beginning of the retraction"
    };
    Err(ExperimentError::NegativeWherePressed {
        force: pressed,
        place,
    })
}
