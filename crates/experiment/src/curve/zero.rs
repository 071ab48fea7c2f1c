//! The zero, the drift and the tilt of the force, from the points without contact.

use crate::curve::free_parts::{FEWEST, FreeParts};
use crate::curve::numerics::{Baseline, dot, least_squares, right_angled, take_off};
use crate::curve::points::Points;
use crate::error::{ExperimentError, refused};
use crate::read::options::{CurveOptions, Drift, Tilt};
use asperity_data::{format_quantity, mean};

/// Drift or tilt, in standard errors, above which it is reported to remain in a curve.
const REMAINS: f64 = 5.0;
/// Residual of the lines of drift, tilt and step, divided by the noise between neighbouring points,
/// above which the parts without contact are not straight. Lines that exceed this residual by the
/// second number still count as drift or tilt.
const CURVED: f64 = 1.5;
const DOMINATES: f64 = 20.0;

/// Drift, tilt and step of the force without contact in N, each with a standard error. The drift is
/// the change from the first to the last point of the curve. The tilt is the change over the range
/// of the displacement. The step is the difference of the force after and before contact that
/// neither drift nor tilt explains.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Slopes {
    pub zero: f64,
    pub drift: (f64, f64),
    pub tilt: (f64, f64),
    pub step: (f64, f64),
}

impl Slopes {
    /// Fits the slopes that `is_asked` selects to points of (time, displacement, 1 after contact or
    /// 0 before, force). Time and displacement are shares of the whole curve. Slopes that are not
    /// selected are 0. Returns `None` if the points cannot separate the slopes.
    pub fn through(points: &[[f64; 4]], is_asked: [bool; 3]) -> Option<Slopes> {
        let column = |of: usize| points.iter().map(|point| point[of]).collect::<Vec<f64>>();
        let mut columns = vec![vec![1.0; points.len()]];
        columns.extend((0..3).filter(|of| is_asked[*of]).map(column));
        let mut found = least_squares(&columns, &column(3))?.into_iter();
        let zero = found.next()?.0;
        let mut slope = |of: usize| {
            if is_asked[of] {
                found.next()
            } else {
                Some((0.0, 0.0))
            }
        };
        Some(Slopes {
            zero,
            drift: slope(0)?,
            tilt: slope(1)?,
            step: slope(2)?,
        })
    }

    /// Returns the root mean square deviation of points from drift, tilt and step in N, and the
    /// deviation expected from the noise between neighbouring points.
    pub fn rest(points: &[[f64; 4]]) -> (f64, f64) {
        let column = |of: usize| points.iter().map(|point| point[of]).collect::<Vec<f64>>();
        let columns = [vec![1.0; points.len()], column(0), column(1), column(2)];
        let mut rests = column(3);
        right_angled(&columns).iter().for_each(|one| {
            take_off(&mut rests, one);
        });
        let changes: f64 = rests
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).powi(2))
            .sum();
        let count = rests.len() as f64;
        (
            (dot(&rests, &rests) / count).sqrt(),
            (0.5 * changes / count).sqrt(),
        )
    }
}

impl FreeParts {
    pub fn line(&self, points: &Points) -> Baseline {
        Baseline::through(&points.force[self.base()])
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{from_text, lines, of_spring};
    use crate::curve::MeasuredCurve;

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
