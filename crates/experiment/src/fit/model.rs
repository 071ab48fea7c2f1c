//! The force of a scene at the measured displacements, for any values of the parameters.

use crate::curve::MeasuredCurve;
use crate::curve::numerics::Extent;
use crate::error::ExperimentError;
use crate::fit::parameter::{Parameter, Values};
use asperity_contact::motion::Leg;
use asperity_contact::{Contact, ContactError, CurvePoint, Direction, Modulus};
use asperity_scene::instrument::{DisplacementCurve, DisplacementPoint};
use asperity_scene::{CheckedScene, RunError, Simulation};
use asperity_surface::Form;
use std::ops::Range;

/// Number of points of the force curve of each segment without the points at jumps, and number of
/// points of a coarse force curve.
const SAMPLES: usize = 128;
const FEW: usize = 64;
/// Largest number of extensions of a loading that does not reach its last displacement, and number
/// of halvings of the last extension.
const EXTENSIONS: usize = 8;
const HALVINGS: usize = 5;
/// Smallest jump of the force, in units of the noise, that the points resolve.
const NOTABLE: f64 = 2.0;
/// Number of points on each side of a fold, each half as far from the fold as the point before. A
/// jump needs none, because its ends are points.
const FAN: i32 = 8;

/// Computation of a scene at the displacements of a measured curve.
pub(crate) struct Model<'a> {
    curve: &'a MeasuredCurve,
    scene: CheckedScene,
    simulation: &'a mut Simulation,
    /// Contact of a scene and the radius of its form in m. Springs and tree are reused for all
    /// other values.
    contact: Option<(Contact, f64)>,
    /// Noise to which the forces are accurate, in units of the noise of the curve and at least 1.
    pub noise: f64,
    pub evaluations: usize,
}

/// Instrument, and points at which a curve is computed.
#[derive(Clone, Copy)]
pub(crate) struct Sampling {
    pub stiffness: f64,
    pub points: usize,
    /// Smallest jump of the force that gets points at both of its ends, N.
    pub least_jump: f64,
}

impl<'a> Model<'a> {
    pub fn new(
        curve: &'a MeasuredCurve,
        scene: &CheckedScene,
        simulation: &'a mut Simulation,
    ) -> Self {
        Model {
            curve,
            scene: scene.clone(),
            simulation,
            contact: None,
            noise: 1.0,
            evaluations: 0,
        }
    }

    /// Returns the contact for these values of the parameters.
    fn contact(&mut self, values: &Values) -> Result<Contact, ExperimentError> {
        let radius = values[Parameter::Radius as usize];
        if self
            .contact
            .as_ref()
            .is_none_or(|(_, made)| *made != radius)
        {
            self.contact = None;
            let scene = self.scene.with(|scene| {
                if let Some(of) = scene.form.as_mut().and_then(Form::radius_mut) {
                    *of = radius;
                }
            });
            self.scene = scene.map_err(RunError::from)?;
            self.contact = Some((self.simulation.contact(&self.scene)?.0, radius));
        }
        let Some((contact, _)) = &self.contact else {
            return Err(
                ContactError::Internal("the contact of the scene has not been made").into(),
            );
        };
        let [modulus, closing, work] =
            [Parameter::Modulus, Parameter::ClosingWork, Parameter::Work]
                .map(|parameter| values[parameter as usize]);
        Ok(contact
            .with(Modulus::effective(modulus)?)
            .works_of_adhesion([closing, work])
            .build()?)
    }

    /// Computes the forces in N at the points of the curve.
    pub fn forces(&mut self, values: &Values) -> Result<Vec<f64>, ExperimentError> {
        self.evaluations += 1;
        let (curve, zero) = (self.curve, values[Parameter::Zero as usize]);
        let mut forces = Vec::with_capacity(curve.force.len());
        self.each_segment(values, |segment, points, offset| {
            let at = |displacement: &f64| force_at(segment, displacement - offset);
            forces.extend(
                curve.displacement[points]
                    .iter()
                    .map(|displacement| zero + at(displacement)),
            );
        })?;
        Ok(forces)
    }

    /// Returns for each point of the curve the forces in N before and after the nearest jump of the
    /// model, minus the force of the model at the point. A jump counts if it is at least `least` N
    /// and no further away than the neighbouring points; otherwise `None`.
    pub fn jumps(
        &mut self,
        values: &Values,
        least: f64,
    ) -> Result<Vec<Option<[f64; 2]>>, ExperimentError> {
        self.evaluations += 1;
        let curve = self.curve;
        let mut all = vec![None; curve.force.len()];
        self.each_segment(values, |segment, points, offset| {
            let jump =
                |[one, other]: [DisplacementPoint; 2]| (one.displacement, [one.force, other.force]);
            // Where the body is separated beyond an end of the segment, it jumps there.
            let (first, last) = (segment.points().first(), segment.points().last());
            let beyond = [first, last].into_iter().flatten().map(|end| {
                let free =
                    [f64::next_up, f64::next_down].map(|to| segment.at(to(end.displacement)));
                let free = free.into_iter().flatten().find(|point| point.force == 0.0);
                (
                    end.displacement,
                    [end.force, free.map_or(end.force, |point| point.force)],
                )
            });
            let jumps = segment
                .jumps()
                .map(|ends| jump([ends[0], ends[1]]))
                .chain(beyond);
            let jumps: Vec<_> = jumps
                .filter(|(_, ends)| (ends[1] - ends[0]).abs() >= least)
                .collect();
            let place = |index: usize| curve.displacement[index] - offset;
            for index in points.clone() {
                let (before, after) = (
                    index.max(points.start + 1) - 1,
                    (index + 2).min(points.end) - 1,
                );
                let (low, high) = (
                    place(before).min(place(after)),
                    place(before).max(place(after)),
                );
                let force = force_at(segment, place(index));
                let near = jumps.iter().filter(|(at, _)| (low..=high).contains(at));
                let Extent { low, high } = Extent::of(
                    near.flat_map(|(_, forces)| *forces)
                        .map(|at| at - force)
                        .chain([0.0]),
                );
                all[index] = (low < high).then_some([low, high]);
            }
        })?;
        Ok(all)
    }

    /// Computes the curve of each segment. Calls `take` with the curve, the index range of its
    /// points in the measured curve, and the displacement at first touch.
    fn each_segment(
        &mut self,
        values: &Values,
        mut take: impl FnMut(&DisplacementCurve, Range<usize>, f64),
    ) -> Result<(), ExperimentError> {
        let contact = self.contact(values)?;
        let [offset, stiffness] =
            [Parameter::Offset, Parameter::Stiffness].map(|one| values[one as usize]);
        let sampling = Sampling {
            stiffness,
            points: if self.noise > 1.0 { FEW } else { SAMPLES },
            least_jump: NOTABLE * self.noise * self.curve.noise,
        };
        let mut begin = 0;
        // Leg and indentation of the body, m, while it touches.
        let mut here: Option<(Leg, f64)> = None;
        for (number, turn) in self.curve.turns.iter().enumerate() {
            let (presses, from) = (number % 2 == 0, here.as_ref().map(|(_, at)| *at));
            let leg = match &here {
                Some((leg, at)) => Some(leg.turn(*at)?),
                None if presses && *turn > offset => Some(Leg::approach(&contact)?),
                None => None,
            };
            let curve = match &leg {
                Some(leg) if presses => sampling.press(leg, from, turn - offset)?,
                Some(leg) => sampling.pull(leg, from.unwrap_or_default())?,
                None => {
                    DisplacementCurve::new(Direction::Loading, &[CurvePoint::default()], stiffness)
                }
            };
            let end = self
                .curve
                .segment
                .partition_point(|segment| *segment <= number);
            take(&curve, begin..end, offset);
            begin = end;
            let at = nearest(&curve, turn - offset).map_or(0.0, |point| point.indentation);
            let is_apart = |leg: &Leg| leg.direction() == Direction::Unloading && at < leg.end();
            here = leg.filter(|leg| !is_apart(leg)).map(|leg| (leg, at));
        }
        Ok(())
    }
}

/// Returns the point of a segment at a displacement in m, or the end of the segment for a
/// displacement that lies beyond it by noise.
fn nearest(segment: &DisplacementCurve, at: f64) -> Option<DisplacementPoint> {
    let away = |point: &DisplacementPoint| (point.displacement - at).abs();
    let ends = || {
        [segment.points().first(), segment.points().last()]
            .into_iter()
            .flatten()
            .copied()
    };
    segment
        .at(at)
        .or_else(|| ends().min_by(|one, other| away(one).total_cmp(&away(other))))
}

fn force_at(segment: &DisplacementCurve, at: f64) -> f64 {
    nearest(segment, at).map_or(0.0, |point| point.force)
}

impl Sampling {
    /// Returns the curve of a loading up to the displacement `to` in m. The loading begins at an
    /// indentation in m, or for `None` at first touch.
    fn press(
        self,
        leg: &Leg,
        from: Option<f64>,
        to: f64,
    ) -> Result<DisplacementCurve, ContactError> {
        let (free, from) = (
            from.is_none().then(CurvePoint::default),
            from.unwrap_or_default(),
        );
        // An indentation close behind the one at which the instrument is at its end: it takes a
        // part of the way, or is pulled on.
        let displacement = |at: f64| {
            leg.point(at)
                .map(|point| point.displacement(self.stiffness))
        };
        let (mut low, mut high) = (from, to.max(from));
        for _ in 0..EXTENSIONS {
            let reached = displacement(high)?;
            if reached >= to {
                break;
            }
            (low, high) = (high, high + 2.0 * (to - reached));
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            *if displacement(middle)? < to {
                &mut low
            } else {
                &mut high
            } = middle;
        }
        self.over(leg, [from, high], 1, free)
    }

    /// Returns the curve of an unloading from an indentation in m to separation.
    pub fn pull(self, leg: &Leg, from: f64) -> Result<DisplacementCurve, ContactError> {
        let end = leg.end().min(from);
        // Close to separation the force may fall as the root of the indentation.
        self.over(
            leg,
            [end, from],
            2,
            Some(CurvePoint {
                indentation: end,
                ..CurvePoint::default()
            }),
        )
    }

    /// Returns the curve of a leg, which is one motion of the body, between two indentations over
    /// the displacement. Its points are dense near the lower end for a high `power`. They include
    /// both ends of all resolved jumps, and the point `free` without contact.
    pub fn over(
        self,
        leg: &Leg,
        [low, high]: [f64; 2],
        power: i32,
        free: Option<CurvePoint>,
    ) -> Result<DisplacementCurve, ContactError> {
        let share = |index: usize| (index as f64 / (self.points - 1) as f64).powi(power);
        let even = (0..self.points).map(|index| (low + (high - low) * share(index)).min(high));
        // Both ends of the jumps of the contact.
        let jumps = leg.jumps(low, high, self.least_jump);
        let mut at: Vec<f64> = even
            .chain(jumps.into_iter().flat_map(|at| [at.next_down(), at]))
            .collect();
        at.sort_by(f64::total_cmp);
        let mut points = leg.curve(&at)?;
        // Places where the instrument cannot hold the body any more, which may be close before a
        // jump of the contact.
        let sign = if leg.direction() == Direction::Loading {
            1.0
        } else {
            -1.0
        };
        let mut reached = f64::NEG_INFINITY;
        let mut folds = Vec::new();
        let ordered = |index: usize| {
            if sign > 0.0 {
                points[index]
            } else {
                points[points.len() - 1 - index]
            }
        };
        for [one, fold, next] in
            (2..points.len()).map(|index| [index - 2, index - 1, index].map(ordered))
        {
            let [before, at, after] =
                [one, fold, next].map(|point| sign * point.displacement(self.stiffness));
            reached = reached.max(before);
            if at > reached && after < at {
                let beside = |end: CurvePoint| {
                    let [from, to] = [fold, end].map(|point| point.indentation);
                    let halves =
                        (1..=FAN).map(move |power| from + (to - from) * 0.5_f64.powi(power));
                    halves.filter(move |at| ![from, to].contains(at))
                };
                folds.extend(beside(one).chain(beside(next)));
            }
        }
        if !folds.is_empty() {
            folds.sort_by(f64::total_cmp);
            points.extend(leg.curve(&folds)?);
            points.sort_by(|one, other| one.indentation.total_cmp(&other.indentation));
        }
        let points: Vec<CurvePoint> = match leg.direction() {
            Direction::Loading => free.into_iter().chain(points).collect(),
            Direction::Unloading => points.into_iter().rev().chain(free).collect(),
        };
        Ok(DisplacementCurve::new(
            leg.direction(),
            &points,
            self.stiffness,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{Made, force_curve, on_rubber, random, read, rubber, stiffness, truth};
    use crate::fit::scene::radius_of;
    use crate::fit::statistics::scale;
    use crate::read::options::Drift;

    /// Residuals without noise, in units of 1 % of the pull-off force, of exact forces and of
    /// coarse forces.
    fn rests(made: &Made) -> [Vec<f64>; 2] {
        let mut curve = read(force_curve(&made.scene).into_iter(), Drift::Keep);
        curve.noise = made.noise;
        let [work, modulus] = [Parameter::Work, Parameter::Modulus].map(|one| truth(made, one));
        let radius = radius_of(&made.scene).unwrap();
        let values = [
            work,
            work,
            modulus,
            0.0,
            0.0,
            stiffness(&made.scene),
            radius,
        ];
        let mut simulation = Simulation::default();
        let mut model = Model::new(
            &curve,
            &made.scene.clone().checked().unwrap(),
            &mut simulation,
        );
        let rests = [1.0, 10.0].map(|noise| {
            model.noise = noise;
            let forces = model.forces(&values).unwrap();
            curve
                .force
                .iter()
                .zip(&forces)
                .map(|(force, model)| (force - model) / curve.noise)
                .collect()
        });
        assert_eq!(model.evaluations, 2);
        rests
    }

    #[test]
    fn forces_are_those_of_the_radius_that_is_asked_for() {
        let curve = read(rubber(4e-8, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        let document = on_rubber(1e-3, 2e6);
        let mut simulations = [(); 2].map(|()| Simulation::default());
        let [mut one, mut fresh] = simulations
            .each_mut()
            .map(|simulation| Model::new(&curve, document.scene(), simulation));
        let mut forces = |radius| {
            one.forces(&[1e-3, 1e-3, 2e6, 2e-6, 0.0, 3.0, radius])
                .unwrap()
        };
        let [wide, narrow, again] = [7.5e-6, 3e-6, 7.5e-6].map(&mut forces);
        assert!(wide == again && wide != narrow);
        assert_eq!(
            fresh
                .forces(&[1e-3, 1e-3, 2e6, 2e-6, 0.0, 3.0, 3e-6])
                .unwrap(),
            narrow
        );
    }

    #[test]
    fn forces_are_those_of_a_fine_curve_with_all_its_jumps() {
        for (seed, points, most) in [
            (4, 512, [0.1, 0.5]),
            (11, 1024, [0.1, 1.0]),
            (14, 512, [0.1, 0.5]),
        ] {
            let found = rests(&random(seed, points)).map(|rests| {
                let beyond = rests.iter().filter(|rest| rest.abs() > 5.0).count();
                (scale(&rests, 5.0), beyond)
            });
            let [exact, coarse] = found;
            assert!(exact.0 < most[0] && exact.1 <= 2, "{seed}: {exact:?}");
            assert!(
                coarse.0 < most[1] && coarse.0 > exact.0 && coarse.1 <= 20,
                "{seed}: {exact:?} {coarse:?}"
            );
        }
    }
}
