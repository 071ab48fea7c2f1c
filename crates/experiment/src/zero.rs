//! The points of a curve without contact, and the zero, drift and tilt of the force at these
//! points.

use crate::baseline::{Baseline, ends};
use crate::error::{ExperimentError, refused};
use crate::free::{FEWEST, NoBaseline, Slopes, free_count};
use crate::points::Points;
use crate::read::options::{CurveOptions, Drift, Tilt};
use asperity_data::{format_quantity, mean};
use std::ops::Range;

/// Drift or tilt, in standard errors, above which it is reported to remain in a curve.
const REMAINS: f64 = 5.0;
/// Residual of the lines of drift, tilt and step, divided by the noise between neighbouring points,
/// above which the parts without contact are not straight. Lines that exceed this residual by the
/// second number still count as drift or tilt.
const CURVED: f64 = 1.5;
const DOMINATES: f64 = 20.0;

/// Points without contact: at the beginning of an approach and at the end of a retraction.
pub(crate) struct FreeParts {
    pub before: Option<usize>,
    /// Number of points after contact at the end; 0 if there are few.
    pub after: usize,
    /// Time and displacement of each point, as shares of the whole curve.
    pub shares: [Vec<f64>; 2],
}

impl FreeParts {
    pub fn of(
        points: &Points,
        options: &CurveOptions,
        averaged: usize,
        least: f64,
    ) -> Result<Self, ExperimentError> {
        let count = points.force.len();
        let approach = &points.force[points.moving(0)];
        let is_retraction = approach.is_empty();
        let asked = options.free_points.map(|free| free / averaged);
        let before = match asked.filter(|_| !is_retraction) {
            Some(free) => Ok(free),
            None => free_count(approach, least),
        };
        let ends_apart = points.segment[count - 1] % 2 == 1;
        let after = ends_apart.then(|| points.free_at_the_end(least)).flatten();
        let after = asked.filter(|_| is_retraction).or(after).unwrap_or(0);
        let needs_approach =
            !is_retraction && (options.segments.is_empty() || options.segments.contains(&1));
        let (number, of) = if needs_approach {
            (before, approach.len())
        } else {
            (before.or(Ok(after)), count)
        };
        let free = number.map_or_else(|why| refuse_baseline(why, points, approach, least), Ok)?;
        if !(FEWEST..of).contains(&free) {
            let place = if needs_approach { "before" } else { "without" };
            let fault = format!("no part {place} contact: {free} of {of} points");
            return refused(
                fault,
                format!("at least {FEWEST}, found or by --free-points"),
            );
        }
        let (low, high) = ends(points.displacement.iter().copied());
        let time = (0..count)
            .map(|index| index as f64 / (count - 1) as f64)
            .collect();
        let displacement = points
            .displacement
            .iter()
            .map(|at| (at - low) / (high - low))
            .collect();
        Ok(FreeParts {
            before: before.ok(),
            after,
            shares: [time, displacement],
        })
    }

    /// Returns the index range of the points without contact that give the zero and the noise.
    fn base(&self) -> Range<usize> {
        let count = self.shares[0].len();
        self.before
            .map_or(count - self.after..count, |before| 0..before)
    }

    pub fn line(&self, points: &Points) -> Baseline {
        Baseline::through(&points.force[self.base()])
    }

    /// Returns the displacement in m at which the contact seems to begin, behind the part before
    /// contact. For a retraction without an approach it lies where compression ends, or half way to
    /// its end.
    pub fn touch(&self, points: &Points) -> f64 {
        if let Some(before) = self.before {
            return points.displacement[before];
        }
        let in_contact = &points.force[points.of(1)];
        let end = in_contact.len().saturating_sub(self.after).max(1);
        let place = match in_contact[..end].iter().position(|force| *force <= 0.0) {
            Some(0) => end / 2,
            crossing => crossing.unwrap_or(end),
        };
        points.displacement[points.of(1).start + place.min(in_contact.len() - 1)]
    }

    /// Subtracts zero, drift and tilt as the options request. Returns the drift, tilt and step that
    /// remain in N, and a statement on all of them.
    pub fn take_off_lines(
        &self,
        points: &mut Points,
        options: &CurveOptions,
        noise: f64,
    ) -> Result<([f64; 3], String), ExperimentError> {
        let [time, displacement] = &self.shares;
        let (count, base) = (points.force.len(), self.base());
        let middle = [time, displacement].map(|shares| mean(&shares[base.clone()]));
        let known = if let Drift::Known(drift) = options.drift {
            Some(drift)
        } else {
            None
        };
        points
            .force
            .iter_mut()
            .zip(time)
            .for_each(|(force, at)| *force -= known.unwrap_or(0.0) * (at - middle[0]));
        let has_both = self.before.is_some() && self.after >= FEWEST;
        let ends = if has_both {
            count - self.after..count
        } else {
            0..0
        };
        let point = |index: usize| {
            let is_after = f64::from(u8::from(!base.contains(&index)));
            [
                time[index],
                displacement[index],
                is_after,
                points.force[index],
            ]
        };
        let free: Vec<[f64; 4]> = base.clone().chain(ends).map(point).collect();
        let is_removed = [options.drift == Drift::Remove, options.tilt == Tilt::Remove];
        let (rest, noise_between) = Slopes::rest(&free);
        let is_straight = rest <= CURVED * noise_between;
        let remains = |(value, error): (f64, f64)| {
            let least = if is_straight {
                noise
            } else {
                noise.max(DOMINATES * rest)
            };
            value.abs() > least.max(REMAINS * error)
        };
        let with_step =
            Slopes::through(&free, [true; 3]).filter(|slopes| has_both && remains(slopes.step));
        let Some(slopes) =
            Slopes::through(&free, [is_removed[0], is_removed[1], with_step.is_some()])
        else {
            let fault = "drift and tilt are one line in the part before contact, and there is none after it";
            return refused(fault, "one of --drift remove and --tilt remove");
        };
        let both =
            with_step.or_else(|| Slopes::through(&free, [true, true, false]).filter(|_| has_both));
        let stated = both
            .or_else(|| Slopes::through(&free, [true, false, false]))
            .unwrap_or_default();
        let taken = [slopes.drift.0, slopes.tilt.0];
        let found = slopes.zero + taken[0] * middle[0] + taken[1] * middle[1];
        // A retraction alone has the zero of its own end.
        let of_end = !options.segments.is_empty() && !options.segments.contains(&1) && has_both;
        let step = with_step
            .filter(|_| of_end)
            .map_or(0.0, |slopes| slopes.step.0);
        let found = step
            + if is_removed == [false; 2] {
                mean(&points.force[base.clone()])
            } else {
                found
            };
        let zero = options.zero.unwrap_or(found);
        for (index, force) in points.force.iter_mut().enumerate() {
            let lines =
                taken[0] * (time[index] - middle[0]) + taken[1] * (displacement[index] - middle[1]);
            *force -= zero + lines;
        }
        let newton = |force: f64| format_quantity(force, "N");
        let does = |is_removed: bool| if is_removed { "was removed" } else { "stays" };
        let drift = match known {
            Some(drift) => format!("{} of it was removed as given", newton(drift)),
            None => format!("it {}", does(is_removed[0])),
        };
        let (value, error) = (stated.drift.0 + known.unwrap_or(0.0), stated.drift.1);
        let mut text = format!("Zero of the force at {}. ", newton(zero));
        if has_both {
            let (tilt, tilt_error) = stated.tilt;
            text += &format!(
                "Drift over the whole curve, by the parts before and after contact: {} ± {}; {drift}. Tilt over the range of \
                 the displacement: {} ± {}; it {}.",
                newton(value),
                newton(error),
                newton(tilt),
                newton(tilt_error),
                does(is_removed[1])
            );
        } else {
            let place = if self.before.is_some() {
                "before"
            } else {
                "after"
            };
            text += &format!(
                "Drift over the whole curve, or tilt, by the part {place} contact alone: {} ± {}; {}.",
                newton(value),
                newton(error),
                if is_removed[1] {
                    "it was removed".to_owned()
                } else {
                    drift
                }
            );
        }
        let mut remaining = [0.0, 0.0, stated.step.0];
        if with_step.is_some() {
            let step = newton(stated.step.0);
            text += &format!(
                " Beside these lines the force after contact differs by {step} from that before."
            );
        }
        if has_both {
            for (of, (slope, name)) in [(stated.drift, "drift"), (stated.tilt, "tilt")]
                .into_iter()
                .enumerate()
            {
                if remains(slope) && !is_removed[of] {
                    remaining[of] = slope.0;
                    text += &format!(" A {name} remains: --{name} remove takes it off.");
                }
            }
        } else if remains(stated.drift) && is_removed == [false; 2] && known.is_none() {
            text += " A line remains: --drift remove takes it off if it is over time, --tilt remove if it is over the displacement.";
        }
        if !is_straight && remaining == [0.0; 3] {
            text +=
                " The parts without contact are no straight lines, as by interference of light.";
        }
        Ok((remaining, text))
    }
}

/// Returns the error of a curve without a part before contact, according to the reason.
fn refuse_baseline<T>(
    why: NoBaseline,
    points: &Points,
    approach: &[f64],
    least: f64,
) -> Result<T, ExperimentError> {
    let newton = |force: f64| format_quantity(force, "N");
    let first: Vec<f64> = approach.iter().rev().copied().collect();
    match why {
        NoBaseline::Few if approach.is_empty() => refused(
            "no part without contact after the retraction",
            "a retraction that ends without contact",
        ),
        NoBaseline::Few => refused(
            format!(
                "{} points in the approach are too few to find the contact",
                approach.len()
            ),
            format!("at least {}, or --free-points COUNT", 2 * FEWEST),
        ),
        NoBaseline::InContact
            if points.segment.contains(&1) && free_count(&first, least).is_ok() =>
        {
            refused(
                "the first segment begins in contact and ends without it: a retraction",
                "an approach first, in the order of time",
            )
        }
        NoBaseline::InContact => refused(
            "no part before contact: the force changes from the first point on",
            "an approach that begins farther away; --free-points COUNT; --segments 2 for the retraction alone",
        ),
        NoBaseline::Straight(range, noise) if range > 20.0 * noise => refused(
            format!(
                "no contact, or contact from the first point on: the force changes by {} along one straight line",
                newton(range)
            ),
            "a part before contact, then another slope; --free-points COUNT for a weak contact",
        ),
        NoBaseline::Straight(_, noise) => refused(
            format!(
                "no contact: in the approach the force stays within its noise of {}",
                newton(noise)
            ),
            "a change by more than the noise; --free-points COUNT for a weak contact",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::MeasuredCurve;
    use crate::made::{from_text, lines, of_spring};

    /// The curve of the spring with a drift, a tilt and a step after contact, all in nN.
    fn made(drift: f64, tilt: f64, step: f64) -> String {
        lines(
            of_spring(600)
                .into_iter()
                .enumerate()
                .map(|(index, (d, f))| {
                    let step = if index < 300 { 0.0 } else { step };
                    (
                        d,
                        f + drift * index as f64 / 599.0 + tilt * (d + 100.0) / 150.0 + step,
                    )
                }),
        )
    }

    fn read(text: &str, drift: Drift, tilt: Tilt) -> MeasuredCurve {
        from_text(
            text,
            &CurveOptions {
                drift,
                tilt,
                ..CurveOptions::default()
            },
        )
        .unwrap()
    }

    #[test]
    fn a_drift_is_found_in_the_part_before_contact_or_given() {
        let end = |drift| read(&made(5.99, 0.0, 0.0), drift, Tilt::Keep).force[599];
        let without = end(Drift::Remove);
        assert!(without.abs() < 3e-10, "{without:e}");
        assert!((end(Drift::Keep) / 5e-9 - 1.0).abs() < 0.05);
        assert!((end(Drift::Known(5.99e-9)) - without).abs() < 2e-10);
    }

    /// A retraction alone touches where compression ends and the force is zero, here at the
    /// displacement zero.
    #[test]
    fn a_retraction_alone_touches_where_it_leaves_compression() {
        let pulled = |at: f64| (at, if at < -50.0 { 0.0 } else { at });
        let text = lines((0..300).map(|index| pulled(f64::from(100 - index))));
        let options = CurveOptions {
            zero: Some(0.0),
            ..CurveOptions::default()
        };
        assert_eq!(from_text(&text, &options).unwrap().touch, 0.0);
    }

    /// Drift over time and tilt over the displacement are separated by the parts before and after
    /// contact; a difference of the force before and after contact is neither.
    #[test]
    fn what_remains_without_contact_is_named_with_its_remedy() {
        let keep = |text: &str| {
            read(text, Drift::Keep, Tilt::Keep)
                .remaining
                .map(|one| (one * 1e9).round())
        };
        assert_eq!(keep(&made(0.0, 0.0, 0.0)), [0.0; 3]);
        assert_eq!(keep(&made(0.0, 3.0, 0.0)), [0.0, 3.0, 0.0]);
        assert_eq!(keep(&made(-3.0, 0.0, 0.0)), [-3.0, 0.0, 0.0]);
        assert_eq!(keep(&made(2.0, -4.0, 0.0)), [2.0, -4.0, 0.0]);
        assert_eq!(keep(&made(0.0, 0.0, 2.0)), [0.0, 0.0, 2.0]);
        // Waves of the force are neither; a retraction alone has its own zero.
        let waves = lines(
            of_spring(600)
                .into_iter()
                .map(|(d, f)| (d, f + 2.0 * (0.1 * d).sin())),
        );
        assert_eq!(keep(&waves), [0.0; 3]);
        let stated = |text: &str, drift, tilt| read(text, drift, tilt).statements.concat();
        let is_curved =
            |text: &str| stated(text, Drift::Keep, Tilt::Keep).contains("no straight lines");
        assert!(is_curved(&waves) && !is_curved(&made(0.0, 0.0, 0.0)));
        let end = CurveOptions {
            segments: vec![2],
            ..CurveOptions::default()
        };
        let end = from_text(&made(0.0, 0.0, 2.0), &end).unwrap();
        assert!(end.force[299].abs() < 3e-10, "{:e}", end.force[299]);
        let tilted = made(0.0, 3.0, 0.0);
        let kept = stated(&tilted, Drift::Keep, Tilt::Keep);
        assert!(
            kept.contains("A tilt remains: --tilt remove takes it off.")
                && !kept.contains("--drift"),
            "{kept}"
        );
        assert!(!stated(&tilted, Drift::Keep, Tilt::Remove).contains("remains"));
        let without = read(&made(2.0, 3.0, 0.0), Drift::Remove, Tilt::Remove);
        let plain = read(&made(0.0, 0.0, 0.0), Drift::Keep, Tilt::Keep);
        assert!(
            without
                .force
                .iter()
                .zip(&plain.force)
                .all(|(one, other)| (one - other).abs() < 1e-10)
        );
    }
}
