//! Time in a measured curve: the speed of the instrument, and its rest between approach and
//! retraction. Only a fit with relaxation needs them.

use crate::curve::MeasuredCurve;
use crate::curve::numerics::{Extent, least_squares};
use crate::curve::points::Points;
use asperity_data::median;
use std::ops::Range;

/// Largest distance of the displacement during a rest from its median, as a share of the range of
/// displacements.
const STILL: f64 = 0.002;
/// Distance from the turn, as a share of the range of displacements, up to which points do not
/// enter a speed.
const NEAR: f64 = 0.01;
/// Smallest share of the points of a pause that have to stay so close to the median.
const MOST_STAY: f64 = 0.5;
/// Largest number of points of a rest that a fit uses.
const MOST_POINTS: usize = 200;
/// Smallest number of points in contact from which a speed is determined.
const FEWEST: usize = 5;

/// Times of a curve of one approach and one retraction.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Timing {
    /// Speeds of the instrument in m/s, by the times of the points; `None` without times.
    pub speeds: Option<Speeds>,
    /// Time in s for which the instrument rests between approach and retraction, by the times of
    /// the points; `None` without times.
    pub rest: Option<f64>,
    /// Points of this rest, in the order of time.
    pub points: Vec<RestingPoint>,
    /// True if the instrument rests in contact elsewhere too.
    pub has_other_rests: bool,
}

/// Speeds of the instrument in m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Speeds {
    pub approach: f64,
    pub retraction: f64,
}

/// Point of a rest.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RestingPoint {
    pub displacement: f64,
    pub force: f64,
    /// Time in s since the beginning of the rest; `None` without times.
    pub seconds: Option<f64>,
    /// Values of the subtracted lines at the point.
    pub lines: Vec<f64>,
}

impl Timing {
    /// Determines the times. `kept` has the indices of the points of the curve among all `points`,
    /// `lines` are the subtracted lines at all points, and `touch` is the displacement in m at first
    /// touch.
    pub fn of(points: &Points, kept: &[usize], lines: &[Vec<f64>], touch: f64) -> Self {
        let is_loop = points.begins_with_approach() && points.last_segment() == 1;
        let turn = kept.partition_point(|index| points.segment[*index] == 0);
        let (approach, retraction) = kept.split_at(turn);
        let (Some(&before), Some(&after)) = (approach.last(), retraction.first()) else {
            return Timing::default();
        };
        if !is_loop {
            return Timing::default();
        }
        let at_rest = resting(points, before + 1..after);
        let of_motions = [approach, retraction];
        let has_other_rests = of_motions
            .iter()
            .any(|motion| rests_within(points, motion, touch));
        let speeds = Speeds::of(points, of_motions, touch);
        // Near the turn, points of a short rest may count as points of the motions.
        let highest = Extent::of(kept.iter().map(|index| points.displacement[*index])).high;
        let far = highest - NEAR * Extent::of(points.displacement.iter().copied()).width();
        let is_far = |index: &&usize| points.displacement[**index] < far;
        let last_far = approach.iter().rev().find(is_far).copied();
        let first_far = retraction.iter().find(is_far).copied();

        let mut displacements: Vec<f64> = at_rest
            .iter()
            .map(|index| points.displacement[*index])
            .collect();
        let place = median(&mut displacements).unwrap_or(highest);
        let mut begin = None;
        let mut rest = None;
        if let Some(speeds) = speeds {
            let way = |index: usize| (place - points.displacement[index]).max(0.0);
            let last = last_far.unwrap_or(before);
            let first = first_far.unwrap_or(after);
            let arrival = points.seconds[last] + way(last) / speeds.approach;
            let departure = points.seconds[first] - way(first) / speeds.retraction;
            begin = Some(arrival);
            rest = Some((departure - arrival).max(0.0));
        }
        let step = at_rest.len().div_ceil(MOST_POINTS).max(1);
        let mut of_rest = Vec::new();
        for index in at_rest.into_iter().step_by(step) {
            of_rest.push(RestingPoint {
                displacement: points.displacement[index],
                force: points.force[index],
                seconds: begin.map(|begin| (points.seconds[index] - begin).max(0.0)),
                lines: lines.iter().map(|line| line[index]).collect(),
            });
        }
        Timing {
            speeds,
            rest,
            points: of_rest,
            has_other_rests,
        }
    }
}

/// Returns the indices of the points of a pause at which the displacement stays near its median;
/// none if most points do not, because the instrument then does not rest.
fn resting(points: &Points, pause: Range<usize>) -> Vec<usize> {
    let near = STILL * Extent::of(points.displacement.iter().copied()).width();
    let Some(middle) = median(&mut points.displacement[pause.clone()].to_vec()) else {
        return Vec::new();
    };
    let count = pause.len() as f64;
    let resting: Vec<usize> = pause
        .filter(|index| (points.displacement[*index] - middle).abs() <= near)
        .collect();
    if (resting.len() as f64) < MOST_STAY * count {
        return Vec::new();
    }
    resting
}

/// Returns true if points in contact between the points of a motion belong to a pause.
fn rests_within(points: &Points, motion: &[usize], touch: f64) -> bool {
    let (Some(&first), Some(&last)) = (motion.first(), motion.last()) else {
        return false;
    };
    let is_resting = |index: usize| points.is_still[index] && points.displacement[index] > touch;
    (first..=last).any(is_resting)
}

impl Speeds {
    /// Determines the speeds of the approach and of the retraction from the points of both motions.
    fn of(points: &Points, motions: [&[usize]; 2], touch: f64) -> Option<Self> {
        if points.seconds.is_empty() {
            return None;
        }
        let [approach, retraction] = motions.map(|motion| speed(points, motion, touch));
        Some(Speeds {
            approach: approach?,
            retraction: -retraction?,
        })
        .filter(|speeds| speeds.approach > 0.0 && speeds.retraction > 0.0)
    }
}

/// Returns the growth of the displacement over time in m/s, from the points of a motion in contact;
/// `None` for fewer than two points.
fn speed(points: &Points, motion: &[usize], touch: f64) -> Option<f64> {
    let extent = Extent::of(points.displacement.iter().copied());
    let far = extent.high - NEAR * extent.width();
    let counts = |index: &usize| (touch..far).contains(&points.displacement[*index]);
    let mut chosen: Vec<usize> = motion.iter().copied().filter(counts).collect();
    if chosen.len() < FEWEST {
        chosen = motion.to_vec();
    }
    let first = points.seconds[*chosen.first()?];
    let seconds = chosen.iter().map(|index| points.seconds[*index] - first);
    let columns = [vec![1.0; chosen.len()], seconds.collect()];
    let displacements: Vec<f64> = chosen
        .iter()
        .map(|index| points.displacement[*index])
        .collect();
    let coefficients = least_squares(&columns, &displacements)?;
    Some(coefficients[1].value).filter(|speed| speed.is_finite())
}

impl MeasuredCurve {
    /// Returns the curve with the points of the rest between approach and retraction, which lasts
    /// `seconds`. If the points have no times, they are evenly spaced over the rest. Returns `None`
    /// if there are no such points, or if the rest takes no time.
    pub(crate) fn with_rest(&self, seconds: f64) -> Option<MeasuredCurve> {
        let points = &self.timing.points;
        if points.is_empty() || seconds <= 0.0 {
            return None;
        }
        let place = self.segment.partition_point(|segment| *segment == 0);
        let mut curve = self.clone();
        curve.seconds_at_rest = vec![None; self.force.len()];
        for (number, point) in points.iter().enumerate() {
            let index = place + number;
            let evenly = (number as f64 + 0.5) / points.len() as f64 * seconds;
            let time = point.seconds.unwrap_or(evenly).min(seconds);
            curve.displacement.insert(index, point.displacement);
            curve.force.insert(index, point.force);
            curve.segment.insert(index, 0);
            curve.seconds_at_rest.insert(index, Some(time));
            let columns = curve.subtracted.columns.iter_mut();
            for (column, value) in columns.zip(&point.lines) {
                column.insert(index, *value);
            }
        }
        Some(curve)
    }

    /// Returns the values of the points of motions, of values of all points of a curve with a rest.
    pub(crate) fn without_rest<T: Copy>(&self, values: &[T]) -> Vec<T> {
        let mut moving = Vec::with_capacity(values.len());
        for (index, value) in values.iter().enumerate() {
            if self.seconds_at_rest.get(index).copied().flatten().is_none() {
                moving.push(*value);
            }
        }
        moving
    }
}

#[cfg(test)]
mod tests {
    use crate::common::{from_text, of_spring};
    use crate::read::options::CurveOptions;

    /// Returns a file of the spring that is pressed at 100 nm/s, rests for 2 s at 50 nm in 100
    /// points with a force that falls, and is pulled at 200 nm/s. `time` writes the time in s.
    fn text(header: &str, time: impl Fn(f64) -> String) -> String {
        let mut text = header.to_owned();
        let points = of_spring(600);
        for (index, (displacement, force)) in points.iter().enumerate() {
            let pressed = (displacement + 100.0) / 100.0;
            let pulled = 1.5 + 2.0 + (50.0 - displacement) / 200.0;
            let seconds = if index < 300 { pressed } else { pulled };
            if index == 300 {
                for number in 0..100 {
                    let since = 0.02 * (f64::from(number) + 0.5);
                    text += &format!("{},50,{}\n", time(1.5 + since), 101.0 - 10.0 * since);
                }
            }
            text += &format!("{},{displacement},{force}\n", time(seconds));
        }
        text
    }

    fn columns(words: &[&str], units: &[&str]) -> CurveOptions {
        CurveOptions {
            columns: words.iter().map(ToString::to_string).collect(),
            units: units.iter().map(ToString::to_string).collect(),
            ..CurveOptions::default()
        }
    }

    #[test]
    fn speeds_and_rest_follow_from_the_times() {
        let in_seconds = |seconds: f64| seconds.to_string();
        let in_milliseconds = |seconds: f64| (1e3 * seconds).to_string();
        let header = "time [ms],displacement [nm],force [nN]\n";
        for (text, options) in [
            (text(header, in_milliseconds), CurveOptions::default()),
            (
                text("a,b [nm],c [nN]\n", in_seconds),
                columns(&["b", "c", "time=a"], &[]),
            ),
            (
                text("Series Time,displacement,force\n", in_milliseconds),
                columns(&["time=1"], &["nm", "nN", "ms"]),
            ),
        ] {
            let curve = from_text(&text, &options).unwrap();
            let speeds = curve.timing.speeds.unwrap();
            assert!((speeds.approach / 1e-7 - 1.0).abs() < 0.01, "{speeds:?}");
            assert!((speeds.retraction / 2e-7 - 1.0).abs() < 0.01, "{speeds:?}");
            let rest = curve.timing.rest.unwrap();
            assert!((rest / 2.0 - 1.0).abs() < 0.01, "{rest}");
            // The points of the motions next to the turn count too.
            assert_eq!(curve.timing.points.len(), 102);
            let with_rest = curve.with_rest(rest).unwrap();
            let places: Vec<usize> = (0..with_rest.force.len())
                .filter(|index| with_rest.seconds_at_rest[*index].is_some())
                .collect();
            assert_eq!(places.len(), 102);
            for (number, place) in places[1..101].iter().enumerate() {
                let seconds = with_rest.seconds_at_rest[*place].unwrap();
                assert!(
                    (seconds - 0.02 * (number as f64 + 0.5)).abs() < 0.01,
                    "{seconds}"
                );
                let force = 1e-7 - 1e-8 * seconds;
                assert!((with_rest.force[*place] - force).abs() < 1e-9);
            }
            assert_eq!(with_rest.without_rest(&with_rest.force), curve.force);
            assert_eq!(with_rest.free, curve.free);
        }
    }

    /// Without times the points of the rest are evenly spaced over the time that the scene states,
    /// and times that fall are no times.
    #[test]
    fn a_curve_without_times_rests_as_long_as_is_stated() {
        let unknown = text("a,displacement [nm],force [nN]\n", |_| "0".to_owned());
        let falls = text("time [s],displacement [nm],force [nN]\n", |seconds| {
            (-seconds).to_string()
        });
        for text in [unknown, falls] {
            let curve = from_text(&text, &CurveOptions::default()).unwrap();
            let says = curve
                .statements
                .iter()
                .any(|statement| statement.to_string().contains("times do not grow"));
            assert_eq!(says, text.starts_with("time"), "{:?}", curve.statements);
            assert_eq!((curve.timing.speeds, curve.timing.rest), (None, None));
            let with_rest = curve.with_rest(4.0).unwrap();
            let times: Vec<f64> = with_rest
                .seconds_at_rest
                .iter()
                .flatten()
                .copied()
                .collect();
            assert_eq!((times.len(), times[0]), (102, 2.0 / 102.0));
            assert!(curve.with_rest(0.0).is_none());
        }
    }
}
