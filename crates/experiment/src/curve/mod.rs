//! A measured force curve: its segments, the zero offset and drift of its force, and its noise.
//! Forces in compression and displacements towards the specimen are positive.

pub(crate) mod drag;
pub(crate) mod features;
pub(crate) mod free_parts;
pub(crate) mod numerics;
pub(crate) mod points;
pub(crate) mod segments;
pub(crate) mod zero;

use crate::curve::drag::{Drag, DragForce};
use crate::curve::features::{CurveFeatures, ForceJump, jumps_of};
use crate::curve::free_parts::{FEWEST, FreeParts, ends_free};
use crate::curve::numerics::{Extent, dot};
use crate::curve::points::Points;
use crate::curve::segments::{Segments, are_shuffled};
use crate::curve::zero::Subtracted;
use crate::error::{CountedPart, ExperimentError, refused, refused_with};
use crate::read;
use crate::read::options::{CurveOptions, Negate};
use crate::read::points::Columns;
use asperity_data::{Note, Remedy, format_quantity, grouped, mean};
use asperity_surface::files::content;
use std::path::Path;

/// Largest number of points that a fit uses. If a curve has more points, neighbouring points are
/// averaged.
const MOST_POINTS: usize = 4096;
/// Smallest number of points of a curve, so that both segments can have enough points with and
/// without contact.
const FEWEST_POINTS: usize = 4 * FEWEST;
/// Noise that is assumed for a curve without noise, as a share of the range of the force.
const NO_NOISE: f64 = 1e-5;
/// Deviation of a multiple of the last digit from a whole number that is rounding.
const ROUNDED: f64 = 0.05;
/// Force at the end of the approach, in standard deviations of the noise. A force below this value
/// is a tension, so the sign of the file is in doubt.
const PULLS: f64 = -5.0;
/// Largest force at the end of a retraction, as a share of the largest tension, with which the body
/// still counts as detached.
const STILL_HELD: f64 = 0.3;

/// Measured force curve in SI units. The displacement grows when the body is pressed on. The force
/// is positive in compression; before contact it is zero except for noise and drift.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCurve {
    /// Displacement of the instrument at each point, in m. If the file has only the displacement of
    /// the body, and no stiffness of the instrument is known, these values are displacements of the
    /// body.
    pub displacement: Vec<f64>,
    /// Force at each point, in N.
    pub force: Vec<f64>,
    /// Index, from 0, of the segment of each point. The body is pressed in segments with even
    /// indices, and pulled in segments with odd indices.
    pub segment: Vec<usize>,
    /// Number of points at the beginning of the curve that lie before the contact.
    pub(crate) free: usize,
    /// Number of points at the end of the curve that lie after the contact.
    pub(crate) free_at_end: usize,
    /// Displacement in m at which the contact begins, estimated from the force.
    pub touch: f64,
    /// Standard deviation of the noise of the force in N. It is that of the points before contact,
    /// or the value [`CurveOptions::noise`] if it is given.
    pub noise: f64,
    /// Features that are computed from the curve without a model, such as its jumps.
    pub features: CurveFeatures,
    /// Drag of a fluid in contact, which was found from the points without contact and subtracted
    /// from the force; `None` if no drag was found.
    pub drag: Option<DragForce>,
    /// True if the body is out of contact at the end of the last retraction.
    pub detaches: bool,
    /// Number of points of the file that are used. It is larger than the number of values of
    /// [`Self::force`] if the curve is long, because neighbouring points are then averaged.
    pub points: usize,
    /// Number of points of the file that are left out because displacement or force is missing.
    pub missing: usize,
    /// Jumps of the force of the whole curve, in the order of time.
    pub(crate) jumps: Vec<ForceJump>,
    /// Displacement at the end of each segment, in m.
    pub(crate) turns: Vec<f64>,
    /// Changes of the force, in N, that remain in the points without contact: the drift over time,
    /// the tilt over the displacement, and the step from before to after the contact. A change that
    /// was not found is 0.
    pub(crate) remaining: [f64; 3],
    /// Contributions to the force that were estimated from the points without contact and
    /// subtracted: the zero offset (unless the options state it), drift, tilt and drag.
    pub(crate) subtracted: SubtractedLines,
    /// Stiffness of the instrument in N/m as the file states it, with its name in the file.
    pub(crate) stiffness: Option<(String, f64)>,
    /// Name of the column of the displacement if this displacement excludes the deflection of the
    /// instrument, otherwise `None`.
    pub(crate) of_body: Option<String>,
    /// Sentences on the assumptions and changes that were made when the curve was read, such as the
    /// choice of columns and units.
    pub statements: Vec<Note>,
}

/// Contributions to the force, called lines, that were estimated from the points without contact
/// and subtracted from a curve: the zero offset of the force, drift, tilt and drag.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SubtractedLines {
    /// True if the zero offset of the force was estimated, and not stated by the options.
    pub has_zero: bool,
    /// Values of each line, except the constant zero offset, at the points of the curve. A line is
    /// a contribution that was subtracted from the force, such as a drift.
    pub columns: Vec<Vec<f64>>,
    /// Sums of the products of each pair of lines over the points without contact in segments that
    /// the options leave out. The curve has no points of these segments. The first row and column
    /// belong to the zero offset, a constant column of ones.
    pub elsewhere: Vec<Vec<f64>>,
}

impl SubtractedLines {
    /// Returns the lines at the points that are used, `kept`.
    fn of(
        subtracted: Subtracted,
        drag: Option<&Drag>,
        points: &Points,
        kept: &[usize],
        free: &FreeParts,
        has_zero: bool,
    ) -> Self {
        let mut lines = subtracted.columns;
        lines.extend(drag.into_iter().flat_map(|drag| drag.columns(points)));
        let mut columns = Vec::with_capacity(lines.len());
        for line in &lines {
            columns.push(kept.iter().map(|index| line[*index]).collect());
        }
        SubtractedLines {
            has_zero,
            elsewhere: products_elsewhere(&lines, kept, free),
            columns,
        }
    }
}

/// Points in the order of time in which pressing is positive, with what was done to the columns.
struct Ordered {
    points: Points,
    /// Number of points of the file that a point averages.
    averaged: usize,
    /// Name of the column of the displacement, if it excludes the deflection of the instrument.
    of_body: Option<String>,
    /// Parts of the first sentence on the curve.
    assumed: Vec<String>,
    /// Further sentences.
    statements: Vec<Note>,
}

impl Ordered {
    fn of(
        columns: &mut Columns,
        options: &CurveOptions,
        least_noise: f64,
    ) -> Result<Self, ExperimentError> {
        let mut segments = Segments::of(&columns.displacement, &columns.labels);
        let reordered = put_in_order(columns, &mut segments, least_noise);
        let averaged = points_in_mean(&segments);
        let mut points =
            Points::averaged(&columns.displacement, &columns.force, &segments, averaged);

        let sentences = std::mem::take(&mut columns.statements);
        let mut statements: Vec<Note> = sentences.into_iter().map(Note::new).collect();
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

/// Finds the drag of a fluid and takes it off. The parts without contact are then those that the
/// drag describes.
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

impl MeasuredCurve {
    /// Reads a curve from a file with text, CSV or a NumPy array, of at most 1 GiB. The file may be
    /// compressed by gzip.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or has no columns of displacement and force. It
    /// also returns an error if the curve has no points before contact, no points in contact, or no
    /// retraction. A curve without a retraction is allowed if [`CurveOptions::segments`] selects
    /// only the first approach.
    pub fn read(path: &Path, options: &CurveOptions) -> Result<Self, ExperimentError> {
        MeasuredCurve::parse(path, &content(path)?, options)
    }

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
        MeasuredCurve::prepare(Columns::of_arrays(displacement, force)?, options)
    }

    /// Returns true if the file at `path` can be read and has columns of displacement and force.
    pub fn is_in(path: &Path) -> bool {
        let parse = |bytes: Vec<u8>| read::parse(path, &bytes, &CurveOptions::default());
        content(path).is_ok_and(|bytes| parse(bytes).is_ok_and(|columns| !columns.force.is_empty()))
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
        let lines = SubtractedLines::of(subtracted, drag.as_ref(), &points, &kept, &free, has_zero);
        let values_of = |values: &[f64]| kept.iter().map(|index| values[*index]).collect();
        Ok(MeasuredCurve {
            displacement: values_of(&points.displacement),
            force: values_of(&points.force),
            segment: kept.iter().map(|index| points.segment[*index]).collect(),
            free: count_before_contact(&kept, &free),
            free_at_end: count_at_end(&kept, &points, &free),
            touch: free.contact_point(&points),
            noise,
            features,
            jumps,
            drag: drag_in_contact,
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

    /// Returns the displacement in m and the force in N of each point.
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.displacement
            .iter()
            .copied()
            .zip(self.force.iter().copied())
    }

    /// Returns the largest tensile force during the retractions in N, as a positive number. Returns
    /// `None` if this force is at most 5 times [`Self::noise`], or if the body does not detach.
    pub fn pull_off_force(&self) -> Option<f64> {
        if !self.detaches {
            return None;
        }
        let points = self.force.iter().zip(&self.segment);
        let pulled = points.filter(|(_, segment)| *segment % 2 == 1);
        let force = -Extent::of(pulled.map(|(force, _)| *force)).low;
        (force > PULLS.abs() * self.noise && force.is_finite()).then_some(force)
    }

    /// Returns the curve with about `count` of its points at equal steps of the index; `None` if
    /// the curve has fewer than 2 × `count` points.
    pub(crate) fn thinned(&self, count: usize) -> Option<MeasuredCurve> {
        let step = self.force.len() / count;
        if step < 2 {
            return None;
        }
        let end_of_contact = (self.force.len() - self.free_at_end).div_ceil(step);
        let count = self.force.len().div_ceil(step);
        let thin = |values: &[f64]| values.iter().step_by(step).copied().collect::<Vec<f64>>();
        Some(MeasuredCurve {
            displacement: thin(&self.displacement),
            force: thin(&self.force),
            segment: self.segment.iter().step_by(step).copied().collect(),
            free: self.free.div_ceil(step),
            free_at_end: count - end_of_contact.min(count),
            subtracted: SubtractedLines {
                has_zero: self.subtracted.has_zero,
                elsewhere: self.subtracted.elsewhere.clone(),
                columns: self
                    .subtracted
                    .columns
                    .iter()
                    .map(|column| thin(column))
                    .collect(),
            },
            jumps: self.jumps.clone(),
            turns: self.turns.clone(),
            statements: self.statements.clone(),
            stiffness: self.stiffness.clone(),
            of_body: self.of_body.clone(),
            ..*self
        })
    }

    /// Returns one column for each line (zero offset, drift, tilt or drag) that was estimated and
    /// subtracted, with its value at each point. A fit of a model uses these columns to estimate
    /// the lines again. If `has_zero` is true, the zero offset is a free parameter of this fit and
    /// gets no column.
    pub(crate) fn lines(&self, has_zero: bool) -> Vec<Vec<f64>> {
        let mut columns = Vec::new();
        if self.subtracted.has_zero && !has_zero {
            columns.push(vec![1.0; self.force.len()]);
        }
        columns.extend(self.subtracted.columns.iter().cloned());
        columns
    }

    /// Returns for each point whether it lies between the part before contact and the part after
    /// contact. These parts were found without a model.
    pub(crate) fn in_contact(&self) -> Vec<bool> {
        let end = self.force.len() - self.free_at_end;
        (0..self.force.len())
            .map(|index| (self.free..end).contains(&index))
            .collect()
    }
}

/// Returns the noise in N that the forces of a curve have at least: that of their digits.
fn least_noise(forces: &[f64]) -> f64 {
    let range = Extent::of(forces.iter().copied()).width();
    let of_digits = digit(forces).map_or(0.0, |digit| digit / 12.0_f64.sqrt());
    of_digits.max(NO_NOISE * range)
}

/// Returns the last digit of forces in N if all of them are whole multiples of it, as the numbers
/// of a converter are; `None` if no digit is larger than the range times
/// [`NO_NOISE`].
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

/// Returns the sums of products of the columns, and first of a constant, over the points without
/// contact that are not used.
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
    end.abs() < (STILL_HELD * tension).max(PULLS.abs() * noise)
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

/// Returns a sentence, for the report, on a drag that was subtracted from the force.
fn drag_in_words(drag: &DragForce) -> String {
    let pressed = format_quantity(drag.pressed, "N");
    let pulled = format_quantity(drag.pulled, "N");
    match drag.reach {
        Some(reach) => {
            let reach = format_quantity(reach, "m");
            format!(
                "Drag of a fluid, −c/(h + h₀) with h₀ = {reach} by the parts without contact, was taken off: {pressed} on the \
                 approach and {pulled} on the retraction in contact."
            )
        }
        None => format!(
            "The force on the retraction is lower by {} than on the approach where nothing touches, as by drag: this was taken off \
             the retraction.",
            format_quantity(-drag.pulled, "N")
        ),
    }
}

/// Returns a phrase on how many means replace the points of the file; `None` if no points were
/// averaged.
fn means_in_words(points: &Points, averaged: usize) -> Option<String> {
    if averaged == 1 {
        return None;
    }
    let means = grouped(points.force.len() as u64);
    Some(format!("means of {averaged} points each, {means} of them"))
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

/// Returns how many neighbouring points are averaged, so that at most [`MOST_POINTS`] means result.
fn points_in_mean(segments: &Segments) -> usize {
    let moving = segments
        .is_still
        .iter()
        .filter(|is_still| !**is_still)
        .count();
    moving.div_ceil(MOST_POINTS).max(1)
}

/// Makes a single segment that ends without contact a retraction, and returns a sentence that says
/// so. Returns an error for any other single segment, unless the options choose it.
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

/// Brings approach and retraction into the order of time, and returns a phrase on what was changed.
/// In a file with columns of approach and retraction side by side, both may begin at the turning
/// point. A file may also contain the retraction first.
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
        segments.is_still.fill(false);
        return Some("both parts begin at their turn and were reversed");
    }
    columns.displacement.rotate_left(first);
    columns.force.rotate_left(first);
    segments.exchange(first);
    Some("the retraction comes first and was put behind the approach")
}

/// Returns the number of points in `kept` (the points used) that lie before the contact.
fn count_before_contact(kept: &[usize], free: &FreeParts) -> usize {
    match free.before {
        Some(before) => kept.partition_point(|index| *index < before),
        None => 0,
    }
}

/// Returns the index of the last segment that the model computes. If the last used segment is an
/// approach, the model also computes the retraction after it. The exception is a curve of several
/// segments that ends with this approach.
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

/// Returns a sentence on the noise of the force and on how it was determined.
fn noise_in_words(noise: f64, options: &CurveOptions, free: &FreeParts) -> String {
    let source = if options.noise.is_some() {
        "given"
    } else if free.before.is_some() {
        "that before contact"
    } else {
        "that after contact"
    };
    format!("Noise {}, {source}.", format_quantity(noise, "N"))
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

/// Returns phrases on how many points are used, how many lie before or after contact, and how many
/// belong to pauses.
fn counted(
    points: &Points,
    kept: &[usize],
    free: &FreeParts,
    options: &CurveOptions,
) -> Vec<String> {
    let count = points.counts.len();
    let place = match free.before {
        Some(before) if points.begins_with_approach() => {
            format!("{} before contact", points_of_file(points, 0..before))
        }
        _ => {
            let after = count - free.after..count;
            format!("{} after contact", points_of_file(points, after))
        }
    };
    let used = points_of_file(points, kept.iter().copied());
    let segments = segments_in_words(points, options);
    let mut words = vec![format!("{used} points used in {segments}, {place}")];
    if points.is_still.contains(&true) {
        let still = points_of_file(points, (0..count).filter(|index| points.is_still[*index]));
        words.push(format!("{still} of pauses left out"));
    }
    words
}

/// Returns, as a text, the number of points of the file that were averaged into the points at
/// `indices`.
fn points_of_file(points: &Points, indices: impl Iterator<Item = usize>) -> String {
    let count: usize = indices.map(|index| points.counts[index]).sum();
    grouped(count as u64)
}

/// Returns a phrase with the number of segments, or with the numbers of the segments that the
/// options choose.
fn segments_in_words(points: &Points, options: &CurveOptions) -> String {
    let last = points.last_segment();
    match &options.segments[..] {
        [] if points.segment[0] == last => "1 segment".to_owned(),
        [] => format!("{} segments", last + 1),
        [number] => format!("segment {number}"),
        several => {
            let numbers: Vec<String> = several.iter().map(ToString::to_string).collect();
            format!("segments {}", numbers.join(", "))
        }
    }
}

/// Returns the largest force in N at the end of an approach. All approaches are examined, because
/// the first one may be a partial loading.
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

/// Returns an error if the force is negative (tensile) where the body is pressed most.
fn check_sign(points: &Points, options: &CurveOptions, noise: f64) -> Result<(), ExperimentError> {
    let is_approach = points.begins_with_approach();
    let pressed = if is_approach {
        force_at_largest_turn(points)
    } else {
        let first = points.range_of(points.segment[0]);
        mean(&points.force[..(first.len() / 20).max(1)])
    };
    if options.negate.is_some() || pressed >= PULLS * noise {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{from_text, lines, of_spring, text_of_spring};

    #[test]
    fn many_points_are_averaged_and_missing_ones_counted() {
        let text = text_of_spring(
            "displacement [nm],force [nN]\nNaN,1\n0,\n",
            100_000,
            |d, f| format!("{d},{f}"),
        );
        let curve = from_text(&text, &CurveOptions::default()).unwrap();
        assert_eq!((curve.missing, curve.points), (2, 100_000));
        assert!(
            curve.force.len() <= MOST_POINTS && curve.statements.len() == 3,
            "{:?}",
            curve.statements
        );
        let said = "2 left out since a value is missing; means of 25 points each, 4 000 of them.";
        assert!(
            curve.statements[0].to_string().ends_with(said),
            "{:?}",
            curve.statements
        );
        assert!(
            (curve.force[2000] / 1e-7 - 1.0).abs() < 0.01,
            "{:e}",
            curve.force[2000]
        );
        // The option counts points of the file, and not the means that replace them.
        let options = CurveOptions {
            free_points: Some(2700),
            ..CurveOptions::default()
        };
        let curve = from_text(&lines(of_spring(9000)), &options).unwrap();
        assert_eq!((curve.force.len(), curve.free), (3000, 900));
    }

    /// The zero offset of the force and the contact point follow from the approach if the file has
    /// one, even if only a retraction is chosen. In a file with a retraction alone, they follow
    /// from the end of the retraction.
    #[test]
    fn chosen_segments_are_used_without_pauses() {
        let read = |points: &[(f64, f64)], segments: &[usize]| {
            let options = CurveOptions {
                segments: segments.to_vec(),
                ..CurveOptions::default()
            };
            from_text(&lines(points.iter().copied()), &options).unwrap()
        };
        let mut all = of_spring(600);
        let (whole, retraction) = (read(&all, &[]), read(&all, &[2]));
        assert_eq!(
            (retraction.points, retraction.free, retraction.segment[0]),
            (300, 0, 1)
        );
        assert_eq!(
            (&retraction.force[..], retraction.touch),
            (&whole.force[300..], whole.touch)
        );
        assert_eq!(retraction.turns, whole.turns);
        let alone = read(&all[300..], &[]);
        assert_eq!(
            (alone.points, alone.segment[0], alone.turns.len()),
            (300, 1, 2)
        );
        assert!(
            alone
                .force
                .iter()
                .zip(&retraction.force)
                .all(|(one, other)| (one - other).abs() < 5e-11)
        );
        assert!(
            (alone.touch - whole.touch).abs() < 2e-9,
            "{} {}",
            alone.touch,
            whole.touch
        );
        let approach = read(&all[..300], &[1]);
        assert_eq!(
            (&approach.force[..], approach.turns.len()),
            (&whole.force[..300], 2)
        );
        all.splice(
            300..300,
            (0..200).map(|index| (50.0, 101.0 - 0.02 * f64::from(index))),
        );
        let (moving, retraction) = (read(&all, &[]), read(&all, &[2]));
        assert!((590..=600).contains(&moving.points), "{}", moving.points);
        assert!(
            (290..=300).contains(&retraction.points),
            "{}",
            retraction.points
        );
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        let of = |force: &dyn Fn(f64, f64) -> f64| {
            lines(of_spring(600).into_iter().map(|(d, f)| (d, force(d, f))))
        };
        let (all, plain) = (of_spring(600), of(&|_, f| f));
        // An approach of only 17 points is too short.
        let few = (0..42_i32).map(|index| {
            if index < 17 {
                10 * index
            } else {
                170 - 7 * (index - 17)
            }
        });
        for (text, said) in [
            (
                of(&|d, _| if (d as i64) % 2 == 0 { 1.0 } else { 1.1 }),
                "no contact: ",
            ),
            // A curve that begins in contact has no straight part at its beginning, and is refused.
            (
                of(&|d, f| f + (d + 100.0).powi(2)),
                "no part before contact: the force",
            ),
            (of(&|d, f| f + 9.0 * d), "no part before contact: the force"),
            (
                of(&|d, _| 9.0 * d + (d * 7.0).sin()),
                "no contact, or contact from the first",
            ),
            (
                of(&|_, f| -f),
                "the force is negative where the body presses: -9",
            ),
            (
                lines(few.map(|d| (f64::from(d), f64::from((d - 90).max(0))))),
                "18 points in the approach are too few",
            ),
            (
                lines((0..600).map(|index| all[index * 251 % 600])),
                "the displacement goes to and fro",
            ),
            (
                lines(all[..301].iter().copied()),
                "the displacement does not turn",
            ),
            (
                lines([(1.0, 2.0)]),
                "1 points with displacement and force; allowed: at least 40",
            ),
            (String::new(), "0 points"),
        ] {
            let error = from_text(&text, &CurveOptions::default()).expect_err(said);
            assert!(
                error.starts_with(said) && error.contains("allowed: "),
                "{said}: {error}"
            );
        }
        let with = CurveOptions::default;
        for (options, said) in [
            (
                CurveOptions {
                    negate: Some(Negate::Displacement),
                    ..with()
                },
                "the body moves away",
            ),
            (
                CurveOptions {
                    free_points: Some(400),
                    ..with()
                },
                "no part before contact: 400 of",
            ),
            (
                CurveOptions {
                    noise: Some(-5e-9),
                    ..with()
                },
                "a noise of -0.000000005 N",
            ),
            (
                CurveOptions {
                    segments: vec![3],
                    ..with()
                },
                "segment 3: the curve has no such segment",
            ),
        ] {
            let error = from_text(&plain, &options).expect_err(said);
            assert!(
                error.starts_with(said) && error.contains("allowed: "),
                "{said}: {error}"
            );
        }
    }

    /// If a retraction ends in tension, it has no pull-off force. If the same retraction continues
    /// until the contact is lost, it has one.
    #[test]
    fn a_curve_that_does_not_detach_has_no_pull_off_force() {
        let adheres = |end: f64| {
            let points = of_spring(600).into_iter().enumerate();
            let pulled = points.filter_map(|(index, (d, f))| match (index < 300, d) {
                (true, _) => Some((d, f)),
                (false, d) if d < end => None,
                (false, d) if d < -30.0 => Some((d, 1.0 + 0.1 * f64::from(index as u32 % 2))),
                (false, d) => Some((d, 1.0 + 2.0 * d)),
            });
            from_text(&lines(pulled), &CurveOptions::default()).unwrap()
        };
        let whole = adheres(-100.0);
        let force = whole.pull_off_force().unwrap();
        assert!(
            whole.detaches && (force / 60e-9 - 1.0).abs() < 0.02,
            "{force:e}"
        );
        let held = adheres(-20.0);
        assert!(!held.detaches && held.pull_off_force().is_none());
    }

    /// Short steps of a loading count as motions. A slow creep in a part of the file that has no
    /// name counts as a pause.
    #[test]
    fn short_steps_are_used() {
        let spring = |d: f64, part: i32| (d, 2.0 * d.max(0.0) + 0.1 * f64::from(part % 2), part);
        let mut points = Vec::new();
        points.extend((-100..40).map(|d| spring(f64::from(d), 0)));
        points.extend((0..50).map(|index| spring(40.0 + 0.001 * f64::from(index), 1)));
        points.extend((40..44).map(|d| spring(f64::from(d), 2)));
        points.extend((0..50).map(|index| spring(44.0 + 0.001 * f64::from(index), 3)));
        points.extend((-100..44).rev().map(|d| spring(f64::from(d), 4)));
        let text = points.iter().fold(
            "displacement [nm],force [nN],segment\n".to_owned(),
            |text, (d, f, part)| text + &format!("{d},{f},{part}\n"),
        );
        let curve = from_text(&text, &CurveOptions::default()).unwrap();
        assert_eq!(curve.points, 140 + 4 + 144, "{:?}", curve.statements);
    }
}
