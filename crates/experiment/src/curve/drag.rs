//! Drag of a fluid on the body and the instrument, estimated from the points without contact. The
//! drag resists the motion: it acts like a compression on the approach, and like a tension on the
//! retraction. Close to the surface the fluid is squeezed out of a narrow gap, and the drag grows
//! as c/(h + h₀), where h is the distance in m to first touch, c a coefficient in N m and h₀ a
//! length in m.

use crate::curve::free_parts::{FEWEST, FreeParts, count_before_steep_part};
use crate::curve::numerics::{
    Baseline, Coefficient, dot, least_squares, right_angled, subtract_all,
};
use crate::curve::points::Points;
use crate::read::options::{CurveOptions, Drift, Tilt};
use serde::Serialize;

/// Number of lengths h₀ that [`Side::best_pole`] tries.
const REACHES: i32 = 24;
/// Ratio of each tried length h₀ to the next smaller one.
const RATIO: f64 = 1.3;
/// Largest length h₀ that is tried, as a share of the way before contact. With a larger h₀, the
/// drag could not be distinguished from a straight line over the displacement.
const FARTHEST: f64 = 0.5;
/// Number of steps into which the range of possible ends of the part without contact is divided.
/// The ends at these steps are tried first.
const ENDS: usize = 60;
/// Largest root mean square residual, in units of the noise, up to which a drag describes a part of
/// the curve. This value is for very many points; for fewer points, an allowance by [`BY_CHANCE`]
/// is added.
const DESCRIBED: f64 = 1.05;
/// Allowance that is added to the largest root mean square residual, in units of the standard error
/// of this residual. The standard error is large if there are few points.
const BY_CHANCE: f64 = 3.0;
/// Largest mean of the last residuals, in standard errors of this mean, up to which a drag
/// describes a part without contact to its end.
const DEVIATES: f64 = 3.5;
/// Smallest coefficients of a significant drag, in standard errors: first on the approach, second
/// on the retraction.
const FOUND: [f64; 2] = [5.0, 3.0];
/// Distance from first touch, in units of h₀, beyond which points are far from contact. There the
/// drag is less than a sixth of that in contact, and the weak contact of a rough body has ended.
const FAR: f64 = 5.0;
/// Largest ratio of two coefficients of the drag, or of its inverse: from the points far from
/// contact, and from all points. Up to this ratio, both show the same drag. The first element is
/// for the approach, the second for the retraction.
const ALIKE: [f64; 2] = [2.0, 3.0];
/// Smallest coefficient of the drag on the approach, in standard errors, that is significant if it
/// is computed only from points far from contact.
const FOUND_FAR: f64 = 2.5;
/// Number of parameters of the drag that a fit of a model refines.
pub(crate) const COLUMNS: usize = 4;
/// First step of the search for the length h₀ with a model, as an exponent of [`RATIO`]. The search
/// ends at the step `FINE_STEP`.
const COARSE_STEP: f64 = 0.5;
const FINE_STEP: f64 = 0.002;
/// Smallest distance of first touch from the pole of the drag, as a share of the length h₀.
const NEAREST: f64 = 0.25;
/// Largest ratio of the drag on the approach to the drag on the retraction, or the reverse. The
/// drag is proportional to the speed, so this is also the largest ratio of the speeds.
const SPEEDS: f64 = 10.0;

/// Forces of the drag of a fluid on a body in contact. Reading a curve subtracts the drag from its
/// forces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct DragForce {
    /// Force of the drag on the approach in N, relative to the force far before contact.
    pub pressed: f64,
    /// Force of the drag on the retraction in N, relative to the force far before contact.
    pub pulled: f64,
    /// Distance h₀ in m from first touch at which the drag is half as large as in contact. `None`
    /// for a drag that does not depend on the distance.
    pub reach: Option<f64>,
}

/// Drag of a fluid, found from the points before and after contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Drag {
    /// Displacement in m at which the drag would be infinite. It lies beyond first touch by h₀.
    pole: f64,
    /// Displacement in m at first touch, midway between the last point before contact and the next
    /// point.
    touch: f64,
    /// Force on the retraction minus force on the approach, far from contact, in N.
    step: f64,
    /// Coefficient c of the drag on the approach in N m; `pulled` is the coefficient on the
    /// retraction.
    pressed: f64,
    pulled: f64,
    /// Number of points before contact from which the drag was found. The field `after` is the
    /// number of such points after contact.
    pub before: usize,
    pub after: usize,
}

/// Forces that are the sum of a drag and of other contributions.
pub(crate) struct ForcesWithDrag {
    /// Displacement in m of each point.
    pub displacements: Vec<f64>,
    /// Number of the segment of each point.
    pub segments: Vec<usize>,
    /// Force in N at each point.
    pub forces: Vec<f64>,
    /// The other contributions, such as a zero offset, by their values at all points.
    pub others: Vec<Vec<f64>>,
}

impl ForcesWithDrag {
    /// Returns the columns of the fit: the other contributions, and the step and the two
    /// coefficients of a drag.
    fn columns(&self, drag: &Drag) -> Vec<Vec<f64>> {
        let mut columns = self.others.clone();
        let of_drag = drag.columns(&self.displacements, &self.segments);
        columns.extend(of_drag.into_iter().take(COLUMNS - 1));
        columns
    }

    /// Returns the sum of the squared residuals of a fit in which the drag has the pole and the
    /// first touch of `drag`.
    fn squares(&self, drag: &Drag) -> f64 {
        let mut residuals = self.forces.clone();
        subtract_all(&mut residuals, &right_angled(&self.columns(drag)));
        dot(&residuals, &residuals)
    }
}

/// Points of an approach or a retraction, in the order from far away to the contact.
struct Side {
    displacements: Vec<f64>,
    forces: Vec<f64>,
    /// Standard deviation in N of the noise of the force far from contact.
    noise: f64,
    /// True if the fit of the drag also has a tilt (a force proportional to the displacement).
    has_tilt: bool,
}

impl Side {
    fn new(points: &Points, indices: &[usize], far: usize, options: &CurveOptions) -> Self {
        let displacements = indices.iter().map(|index| points.displacement[*index]);
        let forces: Vec<f64> = indices.iter().map(|index| points.force[*index]).collect();
        Side {
            displacements: displacements.collect(),
            noise: Baseline::through(&forces[..far.min(forces.len())]).noise,
            forces,
            has_tilt: options.tilt == Tilt::Remove,
        }
    }

    /// Returns the residuals in N of the first `count` points from a fit of a drag with this pole.
    fn residuals(&self, count: usize, pole: f64) -> Vec<f64> {
        let displacements = &self.displacements[..count];
        let mut columns = vec![vec![1.0; count], inverse_distances(displacements, pole)];
        if self.has_tilt {
            columns.push(displacements.to_vec());
        }
        let mut residuals = self.forces[..count].to_vec();
        subtract_all(&mut residuals, &right_angled(&columns));
        residuals
    }

    /// Returns the pole in m with which a drag describes the first `count` points best.
    fn best_pole(&self, count: usize) -> f64 {
        let first = self.displacements[0];
        let last = self.displacements[count - 1];
        let squares = |pole: f64| {
            let residuals = self.residuals(count, pole);
            dot(&residuals, &residuals)
        };
        let farthest = FARTHEST * (last - first).abs();
        let mut best = last + farthest;
        let mut least = squares(best);
        for power in 1..REACHES {
            let pole = last + farthest * RATIO.powi(-power);
            let sum = squares(pole);
            if sum < least {
                least = sum;
                best = pole;
            }
        }
        best
    }

    /// Returns true if a drag with this pole describes the first `count` points within the noise.
    /// The last of these points are also checked alone, because a contact begins there.
    fn is_described(&self, count: usize, pole: f64) -> bool {
        let residuals = self.residuals(count, pole);
        let root_mean_square = (dot(&residuals, &residuals) / count as f64).sqrt();
        let most = DESCRIBED + BY_CHANCE / (2.0 * count as f64).sqrt();
        if root_mean_square > most * self.noise {
            return false;
        }
        [2, count / 20, count / 10].into_iter().all(|last| {
            let last = last.max(2);
            let sum: f64 = residuals[count - last..].iter().sum();
            sum.abs() <= DEVIATES * self.noise * (last as f64).sqrt()
        })
    }

    /// Returns the largest number of points without contact that `is_described` accepts; `None` if
    /// it accepts none. The number is at least `fewest`. Numbers in large steps are tried first,
    /// and then the numbers within one step above the first accepted one.
    fn longest(&self, fewest: usize, is_described: impl Fn(usize) -> bool) -> Option<usize> {
        let count = self.forces.len();
        let most = (count_before_steep_part(&self.forces) + 2).min(count);
        let fewest = fewest.clamp(FEWEST, most);
        let step = ((most - fewest) / ENDS).max(1);
        let mut ends = (fewest..=most).rev().step_by(step);
        let found = ends.find(|end| is_described(*end))?;
        let mut finer = (found + 1..=most.min(found + step - 1)).rev();
        Some(finer.find(|end| is_described(*end)).unwrap_or(found))
    }
}

/// Returns 1/(pole − D) in 1/m for each displacement D in m.
fn inverse_distances(displacements: &[f64], pole: f64) -> Vec<f64> {
    displacements
        .iter()
        .map(|displacement| 1.0 / (pole - displacement))
        .collect()
}

impl Drag {
    /// Finds the drag of a curve that has an approach and a retraction. Returns `None` if the
    /// points without contact show no drag. A drag has opposite signs on approach and retraction,
    /// unlike a tilt or a weak contact.
    pub fn find(points: &Points, free: &FreeParts, options: &CurveOptions) -> Option<Drag> {
        let before = free.before?;
        let last = points.last_segment();
        let is_given = options.free_points.is_some();
        if is_given || free.ends_in_contact || last.is_multiple_of(2) || before < 2 * FEWEST {
            return None;
        }
        let approach: Vec<usize> = points.moving(0).collect();
        let retraction: Vec<usize> = points.moving(last).rev().collect();
        if approach.len() < 2 * FEWEST || retraction.len() < 2 * FEWEST {
            return None;
        }
        let pressed = Side::new(points, &approach, before, options);
        let pulled = Side::new(points, &retraction, free.after.max(FEWEST), options);

        let is_described = |end: usize| pressed.is_described(end, pressed.best_pole(end));
        let before = pressed.longest(before, is_described)?;
        let pole = pressed.best_pole(before);
        let next = points.displacement[before.min(approach.len() - 1)];
        let touch = 0.5 * (points.displacement[before - 1] + next);
        let pole = pole.max(touch + RATIO.powi(-REACHES) * (touch - points.displacement[0]));
        let after = pulled.longest(free.after, |end| {
            // The pole has to lie beyond all points without contact, where the drag is finite.
            pulled.displacements[..end]
                .iter()
                .all(|displacement| *displacement < pole)
                && pulled.is_described(end, pole)
        })?;
        let both = BothSides {
            points,
            indices: (0..before)
                .chain(points.force.len() - after..points.force.len())
                .collect(),
            touch,
            options,
        };
        let drag = both.drag(both.best_pole(pole), before, after)?;
        let force = drag.pressed / (drag.pole - touch);
        (force > pressed.noise && both.reaches_far(&drag)).then_some(drag)
    }

    /// Returns the drag in N at a displacement in m: on the retraction if `is_pulled` is true,
    /// otherwise on the approach.
    pub fn force(&self, displacement: f64, is_pulled: bool) -> f64 {
        let distance = self.distance(displacement);
        if is_pulled {
            self.step + self.pulled / distance
        } else {
            self.pressed / distance
        }
    }

    /// Returns h + h₀ in m, where h is the distance to first touch. In contact h is 0.
    fn distance(&self, displacement: f64) -> f64 {
        self.pole - displacement.min(self.touch)
    }

    /// Returns the force in N by which the drag grows at a displacement in m, if the first touch is
    /// at `touch` in m and not where the drag was found to end. A body in contact has the drag of
    /// first touch.
    pub fn growth(&self, displacement: f64, is_pulled: bool, touch: f64) -> f64 {
        let nearest = displacement
            .min(touch)
            .min(self.pole - self.least_distance());
        let coefficient = if is_pulled { self.pulled } else { self.pressed };
        coefficient * (1.0 / (self.pole - nearest) - 1.0 / self.distance(displacement))
    }

    /// Returns the smallest distance in m to the pole that a first touch may have. At the pole the
    /// drag would be infinite.
    fn least_distance(&self) -> f64 {
        NEAREST * (self.pole - self.touch)
    }

    pub fn subtract(&self, points: &mut Points) {
        for index in 0..points.force.len() {
            let is_pulled = points.segment[index] % 2 == 1;
            points.force[index] -= self.force(points.displacement[index], is_pulled);
        }
    }

    /// Returns the derivatives of the force at each point with respect to the parameters of the
    /// drag. A fit of a model to the curve needs them to refine these parameters. The points are
    /// given by their displacements in m and by the numbers of their segments.
    pub fn columns(&self, displacements: &[f64], segments: &[usize]) -> Vec<Vec<f64>> {
        let mut columns = vec![Vec::new(); COLUMNS];
        for (displacement, segment) in displacements.iter().zip(segments) {
            let inverse = 1.0 / self.distance(*displacement);
            let is_pulled = segment % 2 == 1;
            columns[0].push(f64::from(u8::from(is_pulled)));
            columns[1].push(if is_pulled { 0.0 } else { inverse });
            columns[2].push(if is_pulled { inverse } else { 0.0 });
            let coefficient = if is_pulled { self.pulled } else { self.pressed };
            columns[3].push(coefficient * inverse * inverse);
        }
        columns
    }

    /// Returns the drag that describes these forces best, if first touch is at `touch` in m and the
    /// length h₀ is near that of this drag. Returns `None` if the forces do not determine it.
    pub fn refitted(&self, forces: &ForcesWithDrag, touch: f64) -> Option<Drag> {
        let reach = self.pole - self.touch;
        let mut power = 0.0;
        let mut step = COARSE_STEP;
        let with_power = |power: f64| Drag {
            pole: touch + reach * RATIO.powf(power),
            touch,
            ..*self
        };
        let mut least = forces.squares(&with_power(power));
        // The length h₀ is changed by smaller and smaller factors.
        while step > FINE_STEP {
            let mut is_better = false;
            for tried in [power - step, power + step] {
                let squares = forces.squares(&with_power(tried));
                if squares < least && tried.abs() <= f64::from(REACHES) {
                    least = squares;
                    power = tried;
                    is_better = true;
                }
            }
            if !is_better {
                step *= 0.5;
            }
        }
        let drag = with_power(power);
        let coefficients = least_squares(&forces.columns(&drag), &forces.forces)?;
        let [.., step, pressed, pulled] = coefficients[..] else {
            return None;
        };
        Some(Drag {
            step: step.value,
            pressed: pressed.value,
            pulled: pulled.value,
            ..drag
        })
    }

    /// Returns the forces of the drag on a body in contact.
    pub fn in_contact(&self) -> DragForce {
        DragForce {
            pressed: self.force(self.touch, false),
            pulled: self.force(self.touch, true),
            reach: Some(self.pole - self.touch),
        }
    }
}

/// Indices of the points without contact, of the approach and of the retraction together.
struct BothSides<'a> {
    points: &'a Points,
    indices: Vec<usize>,
    touch: f64,
    options: &'a CurveOptions,
}

impl BothSides<'_> {
    /// Returns the columns of the fit. Their coefficients are the zero offset of the force, the
    /// step, the coefficients of the drag on approach and retraction, and tilt and drift if the
    /// options remove them.
    fn columns(&self, pole: f64) -> Vec<Vec<f64>> {
        let points = self.points;
        let mut columns = vec![Vec::new(); 6];
        for &index in &self.indices {
            let displacement = points.displacement[index];
            let is_pulled = points.segment[index] % 2 == 1;
            let pulled = f64::from(u8::from(is_pulled));
            let inverse = 1.0 / (pole - displacement.min(self.touch));
            columns[0].push(1.0);
            columns[1].push(pulled);
            columns[2].push((1.0 - pulled) * inverse);
            columns[3].push(pulled * inverse);
            columns[4].push(displacement - self.touch);
            columns[5].push(index as f64);
        }
        if self.options.drift != Drift::Remove {
            columns.remove(5);
        }
        if self.options.tilt != Tilt::Remove {
            columns.remove(4);
        }
        columns
    }

    fn forces(&self) -> Vec<f64> {
        self.indices
            .iter()
            .map(|index| self.points.force[*index])
            .collect()
    }

    /// Returns the pole in m, near `pole`, with which a drag describes the points without contact
    /// best.
    fn best_pole(&self, pole: f64) -> f64 {
        let reach = pole - self.touch;
        let mut least = f64::INFINITY;
        let mut best = pole;
        for power in -REACHES..=REACHES {
            let tried = self.touch + reach * RATIO.powf(0.25 * f64::from(power));
            let mut residuals = self.forces();
            subtract_all(&mut residuals, &right_angled(&self.columns(tried)));
            let squares = dot(&residuals, &residuals);
            if squares < least {
                least = squares;
                best = tried;
            }
        }
        best
    }

    /// Returns true if the points far from contact, taken alone, show the same drag. They do not if
    /// the force comes from a weak contact of a rough body: this force may grow in the same way,
    /// and may be adhesive on the retraction, but it ends at some distance.
    fn reaches_far(&self, drag: &Drag) -> bool {
        let reach = drag.pole - drag.touch;
        let is_far = |index: &usize| self.touch - self.points.displacement[*index] > FAR * reach;
        let far = BothSides {
            indices: self.indices.iter().copied().filter(is_far).collect(),
            ..*self
        };
        if far.indices.len() < 2 * FEWEST {
            return false;
        }
        let Some(coefficients) = least_squares(&far.columns(drag.pole), &far.forces()) else {
            return false;
        };
        let [_, _, pressed, pulled, ..] = coefficients[..] else {
            return false;
        };
        let [on_approach, on_retraction] = ALIKE;
        let is_alike = |far: f64, all: f64, most: f64| (1.0 / most..=most).contains(&(far / all));
        pressed.value > FOUND_FAR * pressed.error
            && is_alike(pressed.value, drag.pressed, on_approach)
            && is_alike(pulled.value, drag.pulled, on_retraction)
    }

    /// Returns the drag with this pole. Returns `None` if a coefficient is not significant or has
    /// the wrong sign for a drag.
    fn drag(&self, pole: f64, before: usize, after: usize) -> Option<Drag> {
        let coefficients = least_squares(&self.columns(pole), &self.forces())?;
        let [_, step, pressed, pulled, ..] = coefficients[..] else {
            return None;
        };
        let [by_approach, by_retraction] = FOUND;
        let is_beyond = |coefficient: Coefficient, sign: f64, errors: f64| {
            sign * coefficient.value > errors * coefficient.error
        };
        let ratio = -pulled.value / pressed.value;
        let is_drag = is_beyond(pressed, 1.0, by_approach)
            && is_beyond(pulled, -1.0, by_retraction)
            && (1.0 / SPEEDS..=SPEEDS).contains(&ratio);
        is_drag.then_some(Drag {
            pole,
            touch: self.touch,
            step: step.value,
            pressed: pressed.value,
            pulled: pulled.value,
            before,
            after,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drag(touch: f64) -> Drag {
        Drag {
            pole: 7e-7,
            touch,
            step: -2e-11,
            pressed: 6e-17,
            pulled: -5e-17,
            before: 100,
            after: 100,
        }
    }

    /// The sum of the drag and its growth is the drag of a body that touches elsewhere.
    #[test]
    fn the_drag_grows_until_first_touch() {
        let found = drag(-5e-8);
        for touch in [-2e-7, -5e-8, 0.0, 3e-8] {
            let elsewhere = drag(touch);
            for displacement in [-1e-6, -1e-7, -1e-8, 2e-8, 1e-6] {
                for is_pulled in [false, true] {
                    let growth = found.growth(displacement, is_pulled, touch);
                    let force = found.force(displacement, is_pulled) + growth;
                    let expected = elsewhere.force(displacement, is_pulled);
                    assert!(
                        (force - expected).abs() < 1e-12 * expected.abs(),
                        "{touch} {displacement} {is_pulled}: {force:e} {expected:e}"
                    );
                }
            }
        }
        assert!(found.growth(1e-6, false, 1e-6).is_finite());
    }

    /// A drag that was found with a wrong touch and a wrong length h₀ is found again from forces in
    /// which it adds to a zero offset and a tilt.
    #[test]
    fn a_drag_is_found_again_from_forces_with_other_contributions() {
        let truth = drag(0.0);
        let displacements: Vec<f64> = (0..400)
            .map(|index: i32| 1e-8 * f64::from(100 - (index - 200).abs()))
            .collect();
        let segments: Vec<usize> = (0..400).map(|index| index / 200).collect();
        let tilt: Vec<f64> = displacements
            .iter()
            .map(|displacement| 1e6 * displacement)
            .collect();
        let mut forces = Vec::new();
        for (displacement, segment) in displacements.iter().zip(&segments) {
            let tilted = 3e-12 + 2e-5 * displacement;
            forces.push(truth.force(*displacement, *segment == 1) + tilted);
        }
        let with_drag = ForcesWithDrag {
            others: vec![vec![1.0; 400], tilt],
            displacements,
            segments,
            forces,
        };
        let wrong = Drag {
            pole: 9e-7,
            touch: -4e-8,
            step: 0.0,
            pressed: 1e-17,
            pulled: 1e-17,
            ..truth
        };
        let found = wrong.refitted(&with_drag, 0.0).unwrap();
        for (found, expected, tolerance) in [
            (found.pole, truth.pole, 1e-3),
            (found.step, truth.step, 1e-2),
            (found.pressed, truth.pressed, 1e-2),
            (found.pulled, truth.pulled, 1e-2),
        ] {
            assert!(
                (found / expected - 1.0).abs() < tolerance,
                "{found:e} {expected:e}"
            );
        }
        assert_eq!(found.touch, 0.0);
    }

    /// The part without contact is found to its last point, however many points there are.
    #[test]
    fn the_longest_part_without_contact_is_found() {
        // The steep part begins at the last points, so that all numbers are tried.
        let mut forces = vec![0.0; 2000];
        forces.extend([1.0, 3.0, 6.0, 10.0]);
        let side = Side {
            displacements: Vec::new(),
            forces,
            noise: 1.0,
            has_tilt: false,
        };
        for wanted in [200, 1000, 1234, 1777, 1999] {
            let found = side.longest(150, |count| count <= wanted);
            assert_eq!(found, Some(wanted));
        }
        assert_eq!(side.longest(150, |_| false), None);
    }
}
