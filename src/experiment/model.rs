//! The force that a scene has at the measured displacements, for any values of its parameters.

use super::parameter::{Parameter, Values};
use super::{ExperimentError, MeasuredCurve};
use crate::analysis::{DisplacementCurve, DisplacementPoint};
use crate::contact::{Contact, ContactError, CurvePoint, Direction, Foundation, HessRule, Leg};
use crate::scene::{Form, Scene};
use crate::simulation::Simulation;

/// Points of the force curve of each segment beside those at its jumps.
const SAMPLES: usize = 256;
/// Extensions of a loading that does not reach the displacement of its end, and halvings of the way to that end.
const EXTENSIONS: usize = 8;
const HALVINGS: usize = 5;
/// Smallest jump of the force over the noise that is looked for.
const NOTABLE: f64 = 2.0;
/// Points on each side of a fold, each half as far as the one before.
const FAN: i32 = 8;

/// A scene on the displacements of a measured curve.
pub(super) struct Model<'a> {
    curve: &'a MeasuredCurve,
    turns: Vec<f64>,
    scene: Scene,
    simulation: &'a mut Simulation,
    /// Contact with the radius of its form, m; its springs and their tree serve all other values.
    contact: Option<(Contact, f64)>,
    pub evaluations: usize,
}

impl<'a> Model<'a> {
    pub fn new(curve: &'a MeasuredCurve, scene: &Scene, simulation: &'a mut Simulation) -> Self {
        Model { turns: curve.turns(), curve, scene: scene.clone(), simulation, contact: None, evaluations: 0 }
    }

    /// Springs under the form of this radius with these works of adhesion and modulus.
    fn contact(&mut self, values: &Values) -> Result<Contact, ExperimentError> {
        let radius = values[Parameter::Radius as usize];
        if self.contact.as_ref().is_none_or(|(_, made)| *made != radius) {
            self.contact = None;
            if let Some(of) = self.scene.form.as_mut().and_then(Form::radius_mut) {
                *of = radius;
            }
            self.contact = Some((self.simulation.contact(&self.scene)?.0, radius));
        }
        let Some((contact, _)) = &self.contact else {
            return Err(ContactError::Internal("the contact of the scene has not been made").into());
        };
        let foundation =
            Foundation { effective_modulus: values[Parameter::Modulus as usize], ..contact.foundation() };
        let rule = HessRule::from_works(
            foundation,
            values[Parameter::ClosingWork as usize],
            values[Parameter::Work as usize],
        );
        Ok(contact.with_rule(foundation, (values[Parameter::Work as usize] > 0.0).then_some(rule)))
    }

    /// Forces at the points of the curve, N.
    pub fn forces(&mut self, values: &Values) -> Result<Vec<f64>, ExperimentError> {
        self.evaluations += 1;
        let contact = self.contact(values)?;
        let [offset, zero, stiffness] =
            [Parameter::Offset, Parameter::Zero, Parameter::Stiffness].map(|one| values[one as usize]);
        let instrument = [stiffness, self.curve.noise];
        let mut forces = Vec::with_capacity(self.curve.force.len());
        let mut here = None;
        for (number, turn) in self.turns.iter().enumerate() {
            let (leg, curve) = match number % 2 {
                0 => press(&contact, here.as_ref(), turn - offset, instrument)?,
                _ => pull(here.as_ref(), instrument)?,
            };
            let ends = [curve.points().first(), curve.points().last()].into_iter().flatten().copied();
            // Beyond the ends of a segment, by the noise of the displacement, the force is that of the end.
            let at = |displacement: f64| {
                let place = displacement - offset;
                let away = |point: &DisplacementPoint| (point.displacement - place).abs();
                let nearest = || ends.clone().min_by(|one, other| away(one).total_cmp(&away(other)));
                curve.at(place).or_else(nearest)
            };
            let end = self.curve.segment.partition_point(|segment| *segment <= number);
            let places = &self.curve.displacement[forces.len()..end];
            forces.extend(places.iter().map(|&place| zero + at(place).map_or(0.0, |point| point.force)));
            let at = at(*turn).map_or(0.0, |point| point.indentation);
            let is_apart = |leg: &Leg| leg.direction() == Direction::Unloading && at < leg.end();
            here = leg.filter(|leg| !is_apart(leg)).map(|leg| (leg, at));
        }
        Ok(forces)
    }
}

/// A leg and the indentation of the body on it, m.
type Here = (Leg, f64);

/// Leg of a loading and its curve up to a displacement, m; no leg of a body that does not touch.
fn press(
    contact: &Contact,
    here: Option<&Here>,
    to: f64,
    instrument: [f64; 2],
) -> Result<(Option<Leg>, DisplacementCurve), ContactError> {
    let free = here.is_none().then(CurvePoint::default);
    let (leg, from) = match here {
        Some((leg, at)) => (leg.turn(*at)?, *at),
        None if to <= 0.0 => {
            return Ok((None, DisplacementCurve::new(Direction::Loading, free.as_slice(), instrument[0])));
        }
        None => (Leg::approach(contact)?, 0.0),
    };
    // An indentation close behind the one at which the instrument is at its end: it takes a part of the way, or is pulled on.
    let displacement = |at: f64| leg.point(at).map(|point| point.displacement(instrument[0]));
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
        *if displacement(middle)? < to { &mut low } else { &mut high } = middle;
    }
    let curve = over(&leg, [from, high], 1, free, instrument)?;
    Ok((Some(leg), curve))
}

/// Leg of an unloading and its curve to separation.
fn pull(here: Option<&Here>, instrument: [f64; 2]) -> Result<(Option<Leg>, DisplacementCurve), ContactError> {
    let free = CurvePoint::default();
    let Some((leg, from)) = here else {
        return Ok((None, DisplacementCurve::new(Direction::Unloading, &[free], instrument[0])));
    };
    let leg = leg.turn(*from)?;
    let end = leg.end().min(*from);
    // Close to separation the force may fall as the root of the indentation.
    let curve = over(&leg, [end, *from], 2, Some(CurvePoint { indentation: end, ..free }), instrument)?;
    Ok((Some(leg), curve))
}

/// Curve of a leg between two indentations over the displacement, through points that are close to the lower end by this
/// power, and a point without contact before or after them. All jumps that exceed a noise, N, are where they are.
fn over(
    leg: &Leg,
    [low, high]: [f64; 2],
    power: i32,
    free: Option<CurvePoint>,
    [stiffness, noise]: [f64; 2],
) -> Result<DisplacementCurve, ContactError> {
    let share = |index: usize| (index as f64 / (SAMPLES - 1) as f64).powi(power);
    let even = |index: usize| (low + (high - low) * share(index)).min(high);
    let mut points = leg.curve(&(0..SAMPLES).map(even).collect::<Vec<f64>>())?;
    let with = |mut points: Vec<CurvePoint>, mut at: Vec<f64>| {
        at.sort_by(f64::total_cmp);
        points.extend(leg.curve(&at)?);
        points.sort_by(|one, other| one.indentation.total_cmp(&other.indentation));
        Ok::<_, ContactError>(points)
    };
    // Both ends of the jumps of the contact.
    let jumps = leg.jumps(low, high, NOTABLE * noise);
    points = with(points, jumps.into_iter().flat_map(|at| [at.next_down(), at]).collect())?;
    // Places where the instrument cannot hold the body any more, which may be close before a jump of the contact.
    let sign = if leg.direction() == Direction::Loading { 1.0 } else { -1.0 };
    let mut reached = f64::NEG_INFINITY;
    let mut folds = Vec::new();
    let ordered = |index: usize| if sign > 0.0 { points[index] } else { points[points.len() - 1 - index] };
    for [one, fold, next] in (2..points.len()).map(|index| [index - 2, index - 1, index].map(ordered)) {
        let [before, at, after] = [one, fold, next].map(|point| sign * point.displacement(stiffness));
        reached = reached.max(before);
        if at > reached && after < at {
            let beside = |end: CurvePoint| {
                (1..=FAN).map(move |power| {
                    fold.indentation + (end.indentation - fold.indentation) * 0.5_f64.powi(power)
                })
            };
            folds.extend(beside(one).chain(beside(next)));
        }
    }
    points = with(points, folds)?;
    let points: Vec<CurvePoint> = match leg.direction() {
        Direction::Loading => free.into_iter().chain(points).collect(),
        Direction::Unloading => points.into_iter().rev().chain(free).collect(),
    };
    Ok(DisplacementCurve::new(leg.direction(), &points, stiffness))
}
