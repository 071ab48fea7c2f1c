//! The force that a scene has at the measured displacements, for any values of its parameters.

use super::parameter::{Parameter, Values};
use super::{ExperimentError, MeasuredCurve};
use crate::analysis::{DisplacementCurve, DisplacementPoint};
use crate::contact::{Contact, ContactError, CurvePoint, Direction, Foundation, HessRule, Leg};
use crate::scene::{Form, Scene};
use crate::simulation::Simulation;

/// Points of the force curve of each segment beside those at the measured displacements.
const SAMPLES: usize = 256;
/// Points of the curve on which the end of a loading is looked for.
const COARSE: usize = 64;
/// Extensions of a loading that does not reach the displacement of its end.
const EXTENSIONS: usize = 8;

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
        let offset = values[Parameter::Offset as usize];
        let (stiffness, zero) = (values[Parameter::Stiffness as usize], values[Parameter::Zero as usize]);
        let mut forces = Vec::with_capacity(self.curve.force.len());
        let (mut here, mut start) = (None, 0);
        for (number, turn) in self.turns.iter().enumerate() {
            let end = start + self.curve.segment[start..].partition_point(|segment| *segment == number);
            let places: Vec<f64> = self.curve.displacement[start..end].iter().map(|at| at - offset).collect();
            let (curve, leg) = match number % 2 {
                0 => press(&contact, here.as_ref(), turn - offset, &places, stiffness)?,
                _ => pull(here.as_ref(), &places, stiffness)?,
            };
            // Beyond the ends of a segment, by the noise of the displacement, the force is that of the end.
            let at = |place: f64| {
                let ends = [curve.points().first(), curve.points().last()].into_iter().flatten().copied();
                let away = |point: &DisplacementPoint| (point.displacement - place).abs();
                curve.at(place).or_else(|| ends.min_by(|one, other| away(one).total_cmp(&away(other))))
            };
            forces.extend(places.iter().map(|&place| zero + at(place).map_or(0.0, |point| point.force)));
            let at = at(turn - offset).map_or(0.0, |point| point.indentation);
            let is_apart = |leg: &Leg| leg.direction() == Direction::Unloading && at <= leg.end();
            here = leg.filter(|leg| !is_apart(leg)).map(|leg| (leg, at));
            start = end;
        }
        Ok(forces)
    }
}

/// A leg and the indentation of the body on it, m.
type Here = (Leg, f64);

/// Curve of a loading up to a displacement, m, and its leg; none of a body that does not touch.
fn press(
    contact: &Contact,
    here: Option<&Here>,
    to: f64,
    places: &[f64],
    stiffness: f64,
) -> Result<(DisplacementCurve, Option<Leg>), ContactError> {
    let free = here.is_none().then(CurvePoint::default);
    let (leg, from) = match here {
        Some((leg, at)) => (leg.turn(*at)?, *at),
        None if to <= 0.0 => return Ok((over(Direction::Loading, free, &[], stiffness), None)),
        None => (Leg::approach(contact)?, 0.0),
    };
    let even = |end: f64, count: usize| -> Vec<f64> {
        (0..count).map(|index| from + (end - from) * (index as f64 / (count - 1) as f64)).collect()
    };
    // The end of an instrument that takes a part of the way, or is pulled on.
    let mut end = to.max(from);
    for _ in 0..EXTENSIONS {
        let curve = over(Direction::Loading, free, &leg.curve(&even(end, COARSE))?, stiffness);
        let reached = curve.points().last().map_or(to, |point| point.displacement);
        if reached >= to {
            let at = curve.at(to).map_or(end, |point| point.indentation);
            end = end.min(at + (end - from) / COARSE as f64);
            break;
        }
        end += 2.0 * (to - reached);
    }
    Ok((refined(&leg, even(end, SAMPLES), places, free, stiffness)?, Some(leg)))
}

/// Curve of an unloading to separation and its leg.
fn pull(
    here: Option<&Here>,
    places: &[f64],
    stiffness: f64,
) -> Result<(DisplacementCurve, Option<Leg>), ContactError> {
    let Some((leg, from)) = here else {
        return Ok((over(Direction::Unloading, Some(CurvePoint::default()), &[], stiffness), None));
    };
    let leg = leg.turn(*from)?;
    let end = leg.end().min(*from);
    // Close to separation the force may fall as the root of the indentation.
    let share = |index: usize| (index as f64 / (SAMPLES - 1) as f64).powi(2);
    let grid = (0..SAMPLES).map(|index| end + (from - end) * share(index)).collect();
    let free = CurvePoint { indentation: end, ..CurvePoint::default() };
    Ok((refined(&leg, grid, places, Some(free), stiffness)?, Some(leg)))
}

/// Curve of a leg at the indentations of a grid and, in a second pass, at those of these displacements, m.
fn refined(
    leg: &Leg,
    mut grid: Vec<f64>,
    places: &[f64],
    free: Option<CurvePoint>,
    stiffness: f64,
) -> Result<DisplacementCurve, ContactError> {
    let (low, high) = (grid[0], grid[grid.len() - 1]);
    let coarse = over(leg.direction(), free, &leg.curve(&grid)?, stiffness);
    let at = places.iter().filter_map(|&place| coarse.at(place)).map(|point| point.indentation);
    grid.extend(at.filter(|at| (low..=high).contains(at)));
    grid.sort_by(f64::total_cmp);
    Ok(over(leg.direction(), free, &leg.curve(&grid)?, stiffness))
}

/// Curve over the displacement through ascending points of a leg and a point without contact before or after them.
fn over(
    direction: Direction,
    free: Option<CurvePoint>,
    points: &[CurvePoint],
    stiffness: f64,
) -> DisplacementCurve {
    let points: Vec<CurvePoint> = match direction {
        Direction::Loading => free.into_iter().chain(points.iter().copied()).collect(),
        Direction::Unloading => points.iter().rev().copied().chain(free).collect(),
    };
    DisplacementCurve::new(direction, &points, stiffness)
}
