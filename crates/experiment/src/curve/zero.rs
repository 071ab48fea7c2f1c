//! Estimates the zero offset, the drift and the tilt of the force from the points without contact.

use crate::curve::free_parts::{FEWEST, FreeParts};
use crate::curve::numerics::{
    Baseline, Coefficient, dot, least_squares, right_angled, subtract_all,
};
use crate::curve::points::Points;
use crate::error::{ExperimentError, refused};
use crate::read::options::{CurveOptions, Drift, Tilt};
use asperity_data::{Note, Remedy, format_quantity, mean};

/// Smallest drift or tilt, in standard errors, that is reported as a change left in the curve.
const REMAINS: f64 = 5.0;
/// Largest root mean square deviation of the parts without contact from the fit of drift, tilt and
/// step, with which these parts count as straight. The unit is the noise computed from the
/// differences of neighbouring points.
const CURVED: f64 = 1.5;
/// Smallest change of the force by a drift or tilt, in units of the deviation from the fit, that is
/// significant if the parts without contact are not straight.
const DOMINATES: f64 = 20.0;

/// Point of the curve without contact.
struct FreePoint {
    /// Time since the first point, as a share of the whole duration. `displacement` is a share of
    /// the range of displacements. Both go from 0 to 1.
    time: f64,
    displacement: f64,
    is_after_contact: bool,
    /// Force in N.
    force: f64,
}

impl FreePoint {
    fn new(points: &Points, free: &FreeParts, index: usize) -> Self {
        let [time, displacement] = &free.shares;
        FreePoint {
            time: time[index],
            displacement: displacement[index],
            is_after_contact: !free.base().contains(&index),
            force: points.force[index],
        }
    }

    /// Returns the step function of the fit: 1 for a point after contact, and 0 for a point before
    /// contact.
    fn step(&self) -> f64 {
        f64::from(u8::from(self.is_after_contact))
    }
}

/// Terms of the force without contact that are fitted together with the zero offset.
#[derive(Clone, Copy)]
struct Terms {
    drift: bool,
    tilt: bool,
    step: bool,
}

/// Zero offset, drift, tilt and step of the force without contact, in N. The drift is the change
/// from the first to the last point of the curve. The tilt is the change over the range of the
/// displacement. The step is the force after contact minus the force before contact, without the
/// part that drift and tilt explain. Terms that were not fitted are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Slopes {
    zero: f64,
    drift: Coefficient,
    tilt: Coefficient,
    step: Coefficient,
}

impl Slopes {
    /// Fits the zero offset and the given terms to points without contact. Returns `None` if the
    /// points cannot separate the terms.
    fn through(points: &[FreePoint], terms: Terms) -> Option<Slopes> {
        let mut columns = vec![vec![1.0; points.len()]];
        if terms.drift {
            columns.push(points.iter().map(|point| point.time).collect());
        }
        if terms.tilt {
            columns.push(points.iter().map(|point| point.displacement).collect());
        }
        if terms.step {
            columns.push(points.iter().map(FreePoint::step).collect());
        }
        let forces: Vec<f64> = points.iter().map(|point| point.force).collect();
        let mut coefficients = least_squares(&columns, &forces)?.into_iter();

        let mut slopes = Slopes {
            zero: coefficients.next()?.value,
            ..Slopes::default()
        };
        if terms.drift {
            slopes.drift = coefficients.next()?;
        }
        if terms.tilt {
            slopes.tilt = coefficients.next()?;
        }
        if terms.step {
            slopes.step = coefficients.next()?;
        }
        Some(slopes)
    }
}

/// Deviation in N of the points without contact from the fit of zero offset, drift, tilt and step.
struct Residual {
    root_mean_square: f64,
    /// Expected deviation, computed from the differences of neighbouring points.
    noise: f64,
}

impl Residual {
    fn of(points: &[FreePoint]) -> Self {
        let columns = [
            vec![1.0; points.len()],
            points.iter().map(|point| point.time).collect(),
            points.iter().map(|point| point.displacement).collect(),
            points.iter().map(FreePoint::step).collect(),
        ];
        let mut residuals: Vec<f64> = points.iter().map(|point| point.force).collect();
        subtract_all(&mut residuals, &right_angled(&columns));
        let changes: f64 = residuals
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).powi(2))
            .sum();
        let count = residuals.len() as f64;
        Residual {
            root_mean_square: (dot(&residuals, &residuals) / count).sqrt(),
            noise: (0.5 * changes / count).sqrt(),
        }
    }

    fn is_straight(&self) -> bool {
        self.root_mean_square <= CURVED * self.noise
    }
}

/// Result of the subtraction of zero offset, drift and tilt from the force of a curve.
pub(crate) struct Subtracted {
    /// Drift, tilt and step of the force in N that were found but not subtracted, in this order.
    /// The value is 0 if none was found.
    pub remaining: [f64; 3],
    /// Step of the force in N, caused by drag, that was subtracted from the retractions; 0 if there
    /// is none.
    pub step_of_retraction: f64,
    /// Contributions that were subtracted from the force: for each drift, tilt or step, its values
    /// at all points. The zero offset is not included.
    pub columns: Vec<Vec<f64>>,
    /// Sentences on zero offset, drift, tilt and step, for the report.
    pub statement: Note,
}

impl FreeParts {
    pub fn line(&self, points: &Points) -> Baseline {
        Baseline::through(&points.force[self.base()])
    }

    /// Subtracts zero offset, drift and tilt from the force, as far as the options request. `noise`
    /// is the standard deviation of the noise of the force in N.
    ///
    /// # Errors
    /// Returns an error if drift and tilt cannot be distinguished from each other in the part
    /// without contact.
    pub fn subtract_lines(
        &self,
        points: &mut Points,
        options: &CurveOptions,
        noise: f64,
    ) -> Result<Subtracted, ExperimentError> {
        let [time, displacement] = &self.shares;
        let base = self.base();
        let middle_time = mean(&time[base.clone()]);
        let middle_displacement = mean(&displacement[base.clone()]);
        let known_drift = known_drift(options);
        for (force, time) in points.force.iter_mut().zip(time) {
            *force -= known_drift.unwrap_or(0.0) * (time - middle_time);
        }

        let lines = Lines::fit(self, points, options, noise)?;
        let drift = lines.slopes.drift.value;
        let tilt = lines.slopes.tilt.value;
        let zero_of_base = if lines.removed.drift || lines.removed.tilt {
            lines.slopes.zero + drift * middle_time + tilt * middle_displacement
        } else {
            mean(&points.force[base])
        };
        let zero = options.zero.unwrap_or(lines.step_of_zero() + zero_of_base);
        for (index, force) in points.force.iter_mut().enumerate() {
            let line = drift * (time[index] - middle_time)
                + tilt * (displacement[index] - middle_displacement);
            *force -= zero + line;
            if points.segment[index] % 2 == 1 {
                *force -= lines.step_of_retraction();
            }
        }
        let mut columns = Vec::new();
        if lines.removed.drift {
            columns.push(time.clone());
        }
        if lines.removed.tilt {
            columns.push(displacement.clone());
        }
        if lines.step_of_retraction() != 0.0 {
            let is_pulled = points.segment.iter().map(|segment| (segment % 2) as f64);
            columns.push(is_pulled.collect());
        }
        Ok(Subtracted {
            remaining: lines.remaining(),
            step_of_retraction: lines.step_of_retraction(),
            columns,
            statement: lines.statement(zero),
        })
    }

    /// Returns the points without contact that determine the zero offset ([`Self::base`]). If there
    /// are enough points before and after contact, the points after contact are added.
    fn points(&self, points: &Points) -> Vec<FreePoint> {
        let count = points.force.len();
        let after = if self.has_both() {
            count - self.after..count
        } else {
            0..0
        };
        self.base()
            .chain(after)
            .map(|index| FreePoint::new(points, self, index))
            .collect()
    }

    /// Returns true if there are enough points before and after contact to separate drift, tilt and
    /// step.
    fn has_both(&self) -> bool {
        self.before.is_some() && self.after >= FEWEST
    }
}

fn known_drift(options: &CurveOptions) -> Option<f64> {
    match options.drift {
        Drift::Known(drift) => Some(drift),
        Drift::Keep | Drift::Remove => None,
    }
}

/// Straight lines through the points without contact.
struct Lines<'a> {
    free: &'a FreeParts,
    options: &'a CurveOptions,
    /// Terms that are subtracted from the force.
    removed: Terms,
    /// Result of the fit of the terms that are subtracted.
    slopes: Slopes,
    /// Result of the fit that includes a step; `None` if the step is not significant.
    with_step: Option<Slopes>,
    /// Result of the fit of all terms that the points can separate. The sentences of the report
    /// give these values.
    stated: Slopes,
    is_straight: bool,
    /// Largest change of the force in N that does not yet count as a drift, tilt or step.
    least_change: f64,
}

impl<'a> Lines<'a> {
    /// Fits the lines through the points without contact. Returns an error if drift and tilt have
    /// to be removed but cannot be separated. If the parts without contact are not straight, only a
    /// large change of the force counts as drift, tilt or step.
    fn fit(
        free: &'a FreeParts,
        points: &Points,
        options: &'a CurveOptions,
        noise: f64,
    ) -> Result<Self, ExperimentError> {
        let points = free.points(points);
        let residual = Residual::of(&points);
        let is_straight = residual.is_straight();
        let mut lines = Lines {
            free,
            options,
            removed: Terms {
                drift: options.drift == Drift::Remove,
                tilt: options.tilt == Tilt::Remove,
                step: false,
            },
            slopes: Slopes::default(),
            with_step: None,
            stated: Slopes::default(),
            is_straight,
            least_change: if is_straight {
                noise
            } else {
                noise.max(DOMINATES * residual.root_mean_square)
            },
        };
        lines.with_step = lines.significant_step(&points);
        let terms = Terms {
            step: lines.with_step.is_some(),
            ..lines.removed
        };
        let Some(slopes) = Slopes::through(&points, terms) else {
            let found = "drift and tilt are one line in the part before contact, and there is none after it";
            return refused(found, "the removal of one of them");
        };
        lines.slopes = slopes;
        lines.stated = lines.separable(&points);
        Ok(lines)
    }

    /// Returns the result of a fit with a step, if the force after contact differs significantly
    /// from the force before contact.
    fn significant_step(&self, points: &[FreePoint]) -> Option<Slopes> {
        let all = Terms {
            drift: true,
            tilt: true,
            step: true,
        };
        let slopes = Slopes::through(points, all)?;
        (self.free.has_both() && self.remains(slopes.step)).then_some(slopes)
    }

    /// Returns the result of the fit of all terms that the points can separate.
    fn separable(&self, points: &[FreePoint]) -> Slopes {
        if let Some(slopes) = self.with_step {
            return slopes;
        }
        let drift = Terms {
            drift: true,
            tilt: false,
            step: false,
        };
        let drift_and_tilt = Terms {
            tilt: true,
            ..drift
        };
        if self.free.has_both()
            && let Some(slopes) = Slopes::through(points, drift_and_tilt)
        {
            return slopes;
        }
        Slopes::through(points, drift).unwrap_or_default()
    }

    /// Returns true if a fitted term is too large to be an effect of noise.
    fn remains(&self, slope: Coefficient) -> bool {
        slope.value.abs() > self.least_change.max(REMAINS * slope.error)
    }

    /// Returns the step in N between the zero offset before contact and the zero offset at the end
    /// of the retraction. The offset at the end is used if the options choose only a retraction;
    /// otherwise the step is 0.
    fn step_of_zero(&self) -> f64 {
        let segments = &self.options.segments;
        let is_retraction_alone = !segments.is_empty() && !segments.contains(&1);
        match self.with_step {
            Some(slopes) if is_retraction_alone && self.free.has_both() => slopes.step.value,
            _ => 0.0,
        }
    }

    /// Returns the step in N that is subtracted from the retractions. Such a step results from
    /// drag, which makes the force on a retraction lower. Returns 0 if there is no such step, or if
    /// only a retraction is used, because its zero offset is determined at its own end.
    fn step_of_retraction(&self) -> f64 {
        match self.with_step {
            Some(slopes) if self.step_of_zero() == 0.0 => slopes.step.value.min(0.0),
            _ => 0.0,
        }
    }

    /// Returns true if a significant drift remains in the curve.
    fn keeps_drift(&self) -> bool {
        self.remains(self.stated.drift) && !self.removed.drift
    }

    /// Returns true if a significant tilt remains in the curve.
    fn keeps_tilt(&self) -> bool {
        self.remains(self.stated.tilt) && !self.removed.tilt
    }

    /// Returns the drift, the tilt and the step that remain in the curve, in N.
    fn remaining(&self) -> [f64; 3] {
        let step = self.stated.step.value - self.step_of_retraction();
        let mut remaining = [0.0, 0.0, step];
        if self.free.has_both() {
            if self.keeps_drift() {
                remaining[0] = self.stated.drift.value;
            }
            if self.keeps_tilt() {
                remaining[1] = self.stated.tilt.value;
            }
        }
        remaining
    }

    /// Returns sentences on the zero offset, on drift and tilt, and on the terms that remain in the
    /// curve.
    fn statement(&self, zero: f64) -> Note {
        let mut text = format!("Zero of the force at {}. ", newton(zero));
        text += &self.slopes_in_words();
        if self.with_step.is_some() {
            let step = newton(self.stated.step.value);
            text += &format!(
                " Beside these lines the force after contact differs by {step} from that before."
            );
        }
        let mut note = Note::new(text);
        if self.free.has_both() {
            if self.keeps_drift() {
                note = note.then(&Note::new("A drift remains.").with(Remedy::RemoveDrift));
            }
            if self.keeps_tilt() {
                note = note.then(&Note::new("A tilt remains.").with(Remedy::RemoveTilt));
            }
        } else if self.keeps_drift() && !self.removed.tilt && known_drift(self.options).is_none() {
            let line =
                "A line remains, which is over time (drift) or over the displacement (tilt).";
            let remains = Note::new(line).with(Remedy::RemoveDrift);
            note = note.then(&remains.with(Remedy::RemoveTilt));
        }
        if !self.is_straight && self.remaining() == [0.0; 3] {
            let curved =
                "The parts without contact are no straight lines, as by interference of light.";
            note = note.then(&Note::new(curved));
        }
        note
    }

    /// Returns sentences on the drift and the tilt with their errors, and on whether each was
    /// removed.
    fn slopes_in_words(&self) -> String {
        let known_drift = known_drift(self.options);
        let drift = newton(self.stated.drift.value + known_drift.unwrap_or(0.0));
        let drift_error = newton(self.stated.drift.error);
        let treatment_of_drift = match known_drift {
            Some(known) => format!("{} of it was removed as given", newton(known)),
            None => treatment(self.removed.drift).to_owned(),
        };
        if !self.free.has_both() {
            let place = if self.free.before.is_some() {
                "before"
            } else {
                "after"
            };
            let treatment_of_line = if self.removed.tilt {
                treatment(true).to_owned()
            } else {
                treatment_of_drift
            };
            return format!(
                "Drift over the whole curve, or tilt, by the part {place} contact alone: {drift} ± {drift_error}; {treatment_of_line}."
            );
        }
        format!(
            "Drift over the whole curve, by the parts before and after contact: {drift} ± {drift_error}; {treatment_of_drift}. \
             Tilt over the range of the displacement: {} ± {}; {}.",
            newton(self.stated.tilt.value),
            newton(self.stated.tilt.error),
            treatment(self.removed.tilt)
        )
    }
}

fn newton(force: f64) -> String {
    format_quantity(force, "N")
}

/// Returns the words that say whether a drift or tilt was removed.
fn treatment(is_removed: bool) -> &'static str {
    if is_removed {
        "it was removed"
    } else {
        "it stays"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{from_text, lines, of_spring};
    use crate::curve::MeasuredCurve;

    /// Returns a text file with the curve of a spring, to which a drift, a tilt and a step after
    /// contact, all in nN, are added.
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

    /// For a retraction alone, the contact point is where the compression ends and the force passes
    /// through zero. In this curve it is at the displacement 0.
    #[test]
    fn a_retraction_alone_touches_where_it_leaves_compression() {
        let pulled = |displacement: f64| {
            (
                displacement,
                if displacement < -50.0 {
                    0.0
                } else {
                    displacement
                },
            )
        };
        let text = lines((0..300).map(|index| pulled(f64::from(100 - index))));
        let options = CurveOptions {
            zero: Some(0.0),
            ..CurveOptions::default()
        };
        assert_eq!(from_text(&text, &options).unwrap().touch, 0.0);
    }

    /// Drift over time and tilt over the displacement can be separated with the parts before and
    /// after contact. A step of the force between these parts is neither drift nor tilt.
    #[test]
    fn what_remains_without_contact_is_named_with_its_remedy() {
        let keep = |text: &str| {
            read(text, Drift::Keep, Tilt::Keep)
                .remaining
                .map(|force| (force * 1e9).round())
        };
        assert_eq!(keep(&made(0.0, 0.0, 0.0)), [0.0; 3]);
        assert_eq!(keep(&made(0.0, 3.0, 0.0)), [0.0, 3.0, 0.0]);
        assert_eq!(keep(&made(-3.0, 0.0, 0.0)), [-3.0, 0.0, 0.0]);
        assert_eq!(keep(&made(2.0, -4.0, 0.0)), [2.0, -4.0, 0.0]);
        assert_eq!(keep(&made(0.0, 0.0, 2.0)), [0.0, 0.0, 2.0]);
        // A force that oscillates with the displacement is neither drift nor tilt. For a retraction
        // alone, the zero offset is determined at its own end.
        let waves = lines(
            of_spring(600)
                .into_iter()
                .map(|(d, f)| (d, f + 2.0 * (0.1 * d).sin())),
        );
        assert_eq!(keep(&waves), [0.0; 3]);
        let words = |_: &Remedy| "taken off".to_owned();
        let stated = |text: &str, drift, tilt| -> String {
            let notes = read(text, drift, tilt).statements;
            notes.iter().map(|note| note.in_words(words)).collect()
        };
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
            kept.contains("A tilt remains: taken off.") && !kept.contains("drift remains"),
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
                .all(|(first, second)| (first - second).abs() < 1e-10)
        );
    }
}
