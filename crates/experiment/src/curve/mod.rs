//! A measured force curve: its segments, the zero of its force, its drift and its noise. Pressing
//! is positive.

pub(crate) mod free_parts;
pub(crate) mod numerics;
pub(crate) mod points;
pub(crate) mod segments;
pub(crate) mod zero;

use crate::curve::free_parts::{FEWEST, FreeParts, ends_free};
use crate::curve::numerics::{ends, right_angled};
use crate::curve::points::Points;
use crate::curve::segments::{Segments, are_shuffled};
use crate::error::{ExperimentError, refused};
use crate::read::Columns;
use crate::read::options::{CurveOptions, Drift, Negate, Tilt};
use asperity_data::{format_quantity, grouped, mean};
use asperity_surface::files::content;
use std::path::Path;

/// Largest number of points that a fit uses; of more points, neighbours are averaged.
const MOST_POINTS: usize = 4096;
const FEWEST_POINTS: usize = 4 * FEWEST;
/// Noise that is assumed for a curve without noise, as a share of the range of the force.
const NO_NOISE: f64 = 1e-6;
/// Force at the end of the approach, in standard deviations of the noise. A force below this value
/// is a tension, so the sign of the file is in doubt.
const PULLS: f64 = -5.0;

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
    /// Number of points at the beginning of the curve that lie before contact.
    pub(crate) free: usize,
    /// Displacement in m at which the contact begins, estimated from the force.
    pub touch: f64,
    /// Standard deviation of the noise of the force, N: from the points before contact, or
    /// [`CurveOptions::noise`].
    pub noise: f64,
    /// Number of points of the file that are used. It is larger than the number of values of
    /// [`Self::force`] if the curve is long, because neighbouring points are then averaged.
    pub points: usize,
    /// Number of points of the file that are left out because displacement or force is missing.
    pub missing: usize,
    /// Displacement at the end of each segment, in m.
    pub(crate) turns: Vec<f64>,
    /// Changes of the force that remain in the curve without contact, in N: over time, over the
    /// displacement, and from before to after contact. A change that was not found is 0.
    pub(crate) remaining: [f64; 3],
    /// Time and displacement of each point, as shares of the whole curve.
    pub(crate) shares: [Vec<f64>; 2],
    /// Whether the zero of the force, a drift and a tilt were estimated from the points without
    /// contact and subtracted.
    pub(crate) is_estimated: [bool; 3],
    /// Stiffness of the instrument in N/m as the file states it, with its name in the file.
    pub(crate) stiffness: Option<(String, f64)>,
    /// Name of the column of the displacement, if the column excludes the deflection of the
    /// instrument.
    pub(crate) of_body: Option<String>,
    /// Sentences on the assumptions and changes made when the curve was read, such as the columns
    /// and units.
    pub statements: Vec<String>,
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

    /// Reads a curve from `bytes`, the content of a file with this name. No file is opened.
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
    /// assert!(curve.statements[0].contains("2 segments"));
    /// # Ok::<(), asperity_experiment::ExperimentError>(())
    /// ```
    pub fn parse(
        name: &Path,
        bytes: &[u8],
        options: &CurveOptions,
    ) -> Result<Self, ExperimentError> {
        MeasuredCurve::prepare(Columns::parse(name, bytes, options)?, options)
    }

    /// Makes a curve from displacements in m and forces in N, in the order of time. A point with a
    /// value that is not finite is left out. The options `columns`, `units` and `ramp` have no
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
        let parse = |bytes: Vec<u8>| Columns::parse(path, &bytes, &CurveOptions::default());
        content(path).is_ok_and(|bytes| parse(bytes).is_ok_and(|columns| !columns.force.is_empty()))
    }

    fn prepare(columns: Columns, options: &CurveOptions) -> Result<Self, ExperimentError> {
        let left_out = columns.left_out();
        let Columns {
            mut displacement,
            mut force,
            labels,
            is_beside,
            missing,
            mut statements,
            ..
        } = columns;
        let count = displacement.len();
        if count < FEWEST_POINTS {
            let fault = format!("{count} points with displacement and force");
            return refused(fault, format!("at least {FEWEST_POINTS}"));
        }
        if let Some(noise) = options
            .noise
            .filter(|noise| !(*noise > 0.0 && noise.is_finite()))
        {
            return refused(
                format!("a noise of {noise} N"),
                "a standard deviation above 0",
            );
        }
        if are_shuffled(&displacement) {
            let fault = "the displacement goes to and fro from point to point";
            return refused(
                fault,
                "points in the order of time, and the column of the displacement by --columns",
            );
        }
        let (low, high) = ends(force.iter().copied());
        let least = NO_NOISE * (high - low);
        let mut segments = Segments::of(&displacement, &labels);
        let turned = in_order(
            &mut displacement,
            &mut force,
            &mut segments,
            is_beside,
            least,
        );
        let moving = segments
            .is_still
            .iter()
            .filter(|is_still| !**is_still)
            .count();
        let averaged = moving.div_ceil(MOST_POINTS).max(1);
        let mut points = Points::averaged(&displacement, &force, &segments, averaged);
        let is_single = points.segment.last() == Some(&0);
        if is_single && ends_free(&points.force, least) {
            points.segment.fill(1);
            statements
                .push("A retraction alone: the model is loaded up to its first point.".to_owned());
        } else if is_single && options.segments != [1] {
            let allowed = "an approach and a retraction, of several files joined in one; a retraction alone that ends without \
                           contact; --segments 1 for an approach alone";
            return refused("the displacement does not turn: one segment", allowed);
        }
        let negate = points.reverse(options.negate)?;
        let instrument = options
            .instrument
            .or(columns.stiffness.as_ref().map(|stated| stated.1));
        let of_body = columns.of_body.filter(|name| {
            instrument
                .inspect(|stiffness| statements.push(points.put_on_spring(name, *stiffness)))
                .is_none()
        });
        let free = FreeParts::of(&points, options, averaged, least)?;
        let noise = options.noise.unwrap_or(free.line(&points).noise).max(least);
        let (remaining, text) = free.take_off_lines(&mut points, options, noise)?;
        check_sign(&points, options, noise)?;
        let kept = kept(&points, options)?;
        let last = points.segment[points.segment.len() - 1];
        let turned = turned.map(str::to_owned);
        let negated = (negate != Negate::None)
            .then(|| format!("{negate} reversed, so that pressing is positive"));
        let mut assumed = vec![columns.assumed];
        assumed.extend(turned.into_iter().chain(negated));
        assumed.extend(counted(&points, &kept, &free, options));
        assumed.extend(left_out);
        if averaged > 1 {
            let means = grouped(points.force.len() as u64);
            assumed.push(format!("means of {averaged} points each, {means} of them"));
        }
        statements.insert(0, format!("{}.", assumed.join("; ")));
        let found = match (options.noise, free.before) {
            (Some(_), _) => "given",
            (None, Some(_)) => "that before contact",
            (None, None) => "that after contact",
        };
        statements.push(format!(
            "{text} Noise {}, {found}.",
            format_quantity(noise, "N")
        ));
        let chosen = options
            .segments
            .iter()
            .max()
            .map_or(last, |most| (most - 1).min(last));
        // After the last approach that is used the body is pulled off.
        let turns = points
            .turns(chosen + usize::from(chosen.is_multiple_of(2) && (chosen < last || last == 0)));
        let of_kept = |values: &[f64]| {
            kept.iter()
                .map(|index| values[*index])
                .collect::<Vec<f64>>()
        };
        Ok(MeasuredCurve {
            displacement: of_kept(&points.displacement),
            force: of_kept(&points.force),
            segment: kept.iter().map(|index| points.segment[*index]).collect(),
            free: kept.partition_point(|index| free.before.is_some_and(|before| *index < before)),
            touch: free.touch(&points),
            noise,
            points: kept.iter().map(|index| points.counts[*index]).sum(),
            missing,
            turns,
            remaining,
            shares: free.shares.each_ref().map(|shares| of_kept(shares)),
            is_estimated: [
                options.zero.is_none(),
                options.drift == Drift::Remove,
                options.tilt == Tilt::Remove,
            ],
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

    /// Returns the largest tensile force during the retractions in N, as a positive number; `None`
    /// if this force is at most 5 times the [`Self::noise`].
    pub fn pull_off_force(&self) -> Option<f64> {
        let pulled = self
            .force
            .iter()
            .zip(&self.segment)
            .filter(|(_, segment)| *segment % 2 == 1);
        let force = -ends(pulled.map(|(force, _)| *force)).0;
        (force > PULLS.abs() * self.noise && force.is_finite()).then_some(force)
    }

    /// Returns the curve with about `count` of its points, evenly chosen; `None` if it has fewer
    /// than twice as many.
    pub(crate) fn thinned(&self, count: usize) -> Option<MeasuredCurve> {
        let step = self.force.len() / count;
        if step < 2 {
            return None;
        }
        let of = |values: &[f64]| values.iter().step_by(step).copied().collect::<Vec<f64>>();
        Some(MeasuredCurve {
            displacement: of(&self.displacement),
            force: of(&self.force),
            segment: self.segment.iter().step_by(step).copied().collect(),
            free: self.free.div_ceil(step),
            shares: self.shares.each_ref().map(|shares| of(shares)),
            turns: self.turns.clone(),
            statements: self.statements.clone(),
            stiffness: self.stiffness.clone(),
            of_body: self.of_body.clone(),
            ..*self
        })
    }

    /// Returns orthonormal columns for the zero of the force, the removed drift and the removed
    /// tilt, if these were estimated from the curve. Each model refines the estimates. `has_zero`
    /// is true if the zero is a free parameter.
    pub(crate) fn lines(&self, has_zero: bool) -> Vec<Vec<f64>> {
        let [time, displacement] = self.shares.clone();
        let columns = [vec![1.0; time.len()], time, displacement];
        let [zero, drift, tilt] = self.is_estimated;
        let used = columns.into_iter().zip([zero && !has_zero, drift, tilt]);
        right_angled(
            &used
                .filter_map(|(column, is_used)| is_used.then_some(column))
                .collect::<Vec<_>>(),
        )
    }
}

/// Brings approach and retraction into the order of time, and says in words what was done. Columns
/// side by side may begin at the turning point, and a file may begin with the retraction.
fn in_order(
    displacement: &mut [f64],
    force: &mut [f64],
    segments: &mut Segments,
    is_beside: bool,
    least: f64,
) -> Option<&'static str> {
    let first = segments.numbers.partition_point(|number| *number == 0);
    let reversed: Vec<f64> = force[first..].iter().rev().copied().collect();
    let has_two = segments.numbers.last() == Some(&1);
    if !(has_two && ends_free(&force[..first], least) && ends_free(&reversed, least)) {
        return None;
    }
    if is_beside {
        for values in [displacement, force] {
            values[..first].reverse();
            values[first..].reverse();
        }
        segments.is_still.fill(false);
        return Some("both parts begin at their turn and were reversed");
    }
    displacement.rotate_left(first);
    force.rotate_left(first);
    segments.exchange(first);
    Some("the retraction comes first and was put behind the approach")
}

/// Returns the indices of the points of the chosen segments without pauses; of all segments if none
/// is chosen.
fn kept(points: &Points, options: &CurveOptions) -> Result<Vec<usize>, ExperimentError> {
    let all = 0..points.force.len();
    let numbers = points.segment[0] + 1..=points.segment[all.end - 1] + 1;
    if let Some(wrong) = options
        .segments
        .iter()
        .find(|number| !numbers.contains(*number))
    {
        let allowed = numbers
            .map(|number| number.to_string())
            .collect::<Vec<_>>()
            .join(", ");
        return refused(
            format!("--segments {wrong}: the curve has no such segment"),
            allowed,
        );
    }
    let is_chosen = |index: usize| {
        options.segments.is_empty() || options.segments.contains(&(points.segment[index] + 1))
    };
    let is_kept = |index: &usize| is_chosen(*index) && !points.is_still[*index];
    let kept: Vec<usize> = all.filter(is_kept).collect();
    if kept.len() < 2 * FEWEST {
        let fault = format!(
            "{} points in the segments that are used, without pauses",
            kept.len()
        );
        return refused(fault, format!("at least {}", 2 * FEWEST));
    }
    Ok(kept)
}

/// Returns the numbers of points that are used, that lie before or after contact, and that belong
/// to pauses, in words.
fn counted(
    points: &Points,
    kept: &[usize],
    free: &FreeParts,
    options: &CurveOptions,
) -> Vec<String> {
    let sum = |of: &dyn Fn(usize) -> bool| {
        let counted = (0..points.counts.len())
            .filter(|index| of(*index))
            .map(|index| points.counts[index]);
        counted.sum::<usize>() as u64
    };
    let (first, last) = (points.segment[0], points.segment[points.segment.len() - 1]);
    let place = match (first, free.before) {
        (0, Some(free)) => format!("{} before contact", grouped(sum(&|index| index < free))),
        _ => format!(
            "{} after contact",
            grouped(sum(&|index| index >= points.counts.len() - free.after))
        ),
    };
    let segments = match &options.segments[..] {
        [] if first == last => "1 segment".to_owned(),
        [] => format!("{} segments", last + 1),
        [one] => format!("segment {one}"),
        several => {
            let numbers: Vec<String> = several.iter().map(ToString::to_string).collect();
            format!("segments {}", numbers.join(", "))
        }
    };
    let used = grouped(sum(&|index| kept.binary_search(&index).is_ok()));
    let mut words = vec![format!("{used} points used in {segments}, {place}")];
    let still = sum(&|index| points.is_still[index]);
    if still > 0 {
        words.push(format!("{} of pauses left out", grouped(still)));
    }
    words
}

/// Returns an error if the force is negative where the body is pressed most.
fn check_sign(points: &Points, options: &CurveOptions, noise: f64) -> Result<(), ExperimentError> {
    let first = points.of(points.segment[0]);
    let count = (first.len() / 20).max(1);
    let pressed = if points.segment[0] == 0 {
        first.end - count..first.end
    } else {
        0..count
    };
    let pressed = mean(&points.force[pressed]);
    if options.negate.is_some() || pressed >= PULLS * noise {
        return Ok(());
    }
    let place = if points.segment[0] == 0 {
        "end of the approach"
    } else {
        "beginning of the retraction"
    };
    let found = format_quantity(pressed, "N");
    refused(
        format!("the force is negative where the body presses: {found} at the {place}"),
        "--negate force where tension counts as positive, --negate none for a body that is pulled there",
    )
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
            curve.force.len() <= MOST_POINTS && curve.statements.len() == 2,
            "{:?}",
            curve.statements
        );
        let said = "2 left out since a value is missing; means of 25 points each, 4 000 of them.";
        assert!(
            curve.statements[0].ends_with(said),
            "{:?}",
            curve.statements
        );
        assert!(
            (curve.force[2000] / 1e-7 - 1.0).abs() < 0.01,
            "{:e}",
            curve.force[2000]
        );
        // Points of the file are counted, not means.
        let options = CurveOptions {
            free_points: Some(2700),
            ..CurveOptions::default()
        };
        let curve = from_text(&lines(of_spring(9000)), &options).unwrap();
        assert_eq!((curve.force.len(), curve.free), (3000, 900));
    }

    /// The approach gives zero and contact of a retraction; a retraction alone has both at its end.
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
        // 17 points of an approach.
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
            // A curve that begins in contact: it has no line before a change.
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
                "--segments 3: the curve has no such segment",
            ),
        ] {
            let error = from_text(&plain, &options).expect_err(said);
            assert!(
                error.starts_with(said) && error.contains("allowed: "),
                "{said}: {error}"
            );
        }
    }
}
