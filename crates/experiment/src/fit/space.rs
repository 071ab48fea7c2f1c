//! The coordinates in which a scene is fitted, and their ranges and starts from the curve.

use crate::curve::MeasuredCurve;
use crate::curve::numerics::Extent;
use crate::error::{ExperimentError, refused};
use crate::fit::parameter::{Coordinate, Free, Parameter, Values};
use crate::fit::population::WRONG_SIDE;
use crate::fit::scene::{most_on_closing, radius_of, values_of, written_out, wrong};
use crate::fit::start::{Known, Starts};
use crate::fit::statistics::{PARTS, scale};
use asperity_data::format_quantity;
use asperity_scene::{Document, Simulation, Solver};
use std::ops::Range;

/// Ratio between the start and the ends of a range that is not given.
const FACTOR: f64 = 30.0;
/// Share of a range within which a value counts as lying at the end of the range.
const AT_END: f64 = 0.01;

/// The coordinates in which a scene is fitted, with the values of all other parameters.
#[derive(Clone)]
pub(crate) struct Space<'a> {
    pub base: Values,
    pub coordinates: Vec<Coordinate>,
    /// Largest allowed work of adhesion on closing, J/m².
    pub most_on_closing: f64,
    pub curve: &'a MeasuredCurve,
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

/// Returns an error unless there is a free parameter, and none is given twice.
fn check_free(free: &[Free]) -> Result<(), ExperimentError> {
    if free.is_empty() {
        let names = Parameter::ALL.map(Parameter::name).join(", ");
        return refused("no free parameter", format!("one or more of {names}"));
    }
    for (index, Free { parameter, .. }) in free.iter().enumerate() {
        if free[..index]
            .iter()
            .any(|other| other.parameter == *parameter)
        {
            return refused(
                format!("{} is free twice", parameter.name()),
                "each parameter once",
            );
        }
    }
    Ok(())
}

impl<'a> Space<'a> {
    /// Checks parameters and scene. Returns the document with works of adhesion in place of κ, and
    /// the coordinates of the fit.
    pub fn of(
        curve: &'a MeasuredCurve,
        document: &Document,
        simulation: &mut Simulation,
        free: &[Free],
        stop: &'a (dyn Fn() -> bool + Sync),
    ) -> Result<(Document, Self), ExperimentError> {
        check_free(free)?;
        let document = curve.with_instrument(document).map_err(wrong)?.0;
        let scene = document.scene();
        if scene.numerics.solver != Solver::Exact {
            return refused(
                "numerics.solver = Stepwise: a fit needs the exact solver",
                "numerics.solver = Exact",
            );
        }
        let is_free = |parameter| free.iter().any(|free| free.parameter == parameter);
        let radius = radius_of(scene);
        if is_free(Parameter::Radius) && radius.is_none() {
            return refused(
                "radius: the form of the scene has none",
                "form = Paraboloid, WavySphere or Punch",
            );
        }
        let (touch, turn) = (curve.touch, curve.turns[0]);
        if turn <= touch {
            let [touch, turn] = [touch, turn].map(|at| format_quantity(at, "m"));
            return refused(
                format!("the contact begins at {touch}, and the displacement turns at {turn}"),
                "a contact before the first turning point",
            );
        }
        let (contact, governing) = simulation.contact(scene)?;
        let unless_free = |parameter, value| (!is_free(parameter)).then_some(value);
        let known = Known {
            radius,
            length: scene.length,
            modulus: unless_free(Parameter::Modulus, governing.effective_modulus),
            stiffness: unless_free(
                Parameter::Stiffness,
                scene.loading_stiffness.unwrap_or(f64::INFINITY),
            ),
        };
        let starts = Starts::of(curve, &contact, known)?;
        let work = is_free(Parameter::Work).then_some(starts.work);
        let document = written_out(&document, &governing, work).map_err(wrong)?;
        let (_, governing) = simulation.contact(document.scene())?;
        if is_free(Parameter::ClosingWork) && governing.adhesive_work().is_none() {
            return refused(
                format!(
                    "{}: the scene has no adhesion",
                    Parameter::ClosingWork.name()
                ),
                "adhesion.work above 0, or a free work of adhesion too",
            );
        }
        let mut base = values_of(document.scene(), &governing);
        let Extent { low, high } = Extent::of(curve.force.iter().copied());
        // Of the force.
        let extent = (high - low).max(curve.noise);
        for (parameter, start) in [
            (Parameter::Work, starts.work),
            (Parameter::Modulus, starts.modulus),
            (Parameter::Stiffness, starts.stiffness),
        ] {
            if is_free(parameter) {
                base[parameter as usize] = start;
            }
        }
        base[Parameter::Offset as usize] = touch;
        if is_free(Parameter::ClosingWork) {
            base[Parameter::ClosingWork as usize] = base[Parameter::Work as usize];
        }
        let mut coordinates = Vec::new();
        for parameter in Parameter::ALL
            .into_iter()
            .filter(|&parameter| is_free(parameter))
        {
            let start = base[parameter as usize];
            let given = free
                .iter()
                .filter(|free| free.parameter == parameter)
                .find_map(|free| free.range);
            let range = given.unwrap_or_else(|| match parameter {
                Parameter::Offset => (Extent::of(curve.displacement.iter().copied()).low, turn),
                Parameter::Zero => (-extent, extent),
                Parameter::Work => (0.0, start * FACTOR),
                Parameter::ClosingWork if is_free(Parameter::Work) => {
                    (0.0, base[Parameter::Work as usize] * FACTOR)
                }
                Parameter::ClosingWork => (0.0, base[Parameter::Work as usize]),
                _ => (start / FACTOR, start * FACTOR),
            });
            // The work on opening comes first among the coordinates.
            let opening = coordinates
                .first()
                .filter(|one: &&Coordinate| one.parameter == Parameter::Work);
            let most = opening.map_or(base[Parameter::Work as usize], |one| one.range.1);
            if parameter == Parameter::ClosingWork && range.0 > most {
                let [least, most] = [range.0, most].map(|work| format_quantity(work, "J/m²"));
                return refused(
                    format!("{} of at least {least}", parameter.name()),
                    format!("from 0 to {most}, the work of adhesion"),
                );
            }
            let start = start.clamp(range.0, range.1);
            base[parameter as usize] = start;
            let unit = match parameter {
                Parameter::Work => starts.least_work,
                // A tenth of the change that the parameter makes at most.
                Parameter::Zero => 0.1 * extent,
                _ => 0.1 * (turn - touch),
            };
            coordinates.push(Coordinate {
                parameter,
                start,
                range,
                unit,
            });
        }
        let most_on_closing = most_on_closing(document.scene());
        Ok((
            document,
            Space {
                base,
                coordinates,
                most_on_closing,
                curve,
                stop,
            },
        ))
    }

    /// Returns the values of all parameters at these coordinates.
    pub fn values(&self, at: &[f64]) -> Values {
        let mut values = self.base;
        for (coordinate, &at) in self.coordinates.iter().zip(at) {
            values[coordinate.parameter as usize] = coordinate.value(at, &values);
            if coordinate.parameter == Parameter::Work {
                let work = values[Parameter::Work as usize];
                values[Parameter::ClosingWork as usize] = work.min(self.most_on_closing);
            }
        }
        values
    }

    /// Returns the free parameters with a larger range of the work of adhesion, if its range was
    /// not given and these coordinates lie at its end. Rough bodies may be pulled off by a small
    /// part of the force of smooth bodies.
    pub fn extended(&self, at: &[f64], free: &[Free]) -> Option<Vec<Free>> {
        let place = self
            .coordinates
            .iter()
            .position(|one| one.parameter == Parameter::Work)?;
        let (Coordinate { range, .. }, (low, high)) =
            (self.coordinates[place], self.coordinates[place].ends());
        let mut free = free.to_vec();
        let work = free
            .iter_mut()
            .find(|one| one.parameter == Parameter::Work && one.range.is_none())?;
        work.range = Some((range.0, FACTOR * range.1));
        (at[place] > high - AT_END * (high - low)).then_some(free)
    }

    /// Returns the coordinates at which the search begins.
    pub fn start(&self) -> Vec<f64> {
        self.coordinates
            .iter()
            .map(|one| one.of(one.start, &self.base))
            .collect()
    }

    /// Returns consecutive parts of each segment in contact. Parts depend on each other less than
    /// points do.
    pub fn blocks(&self) -> Vec<Range<usize>> {
        let (mut blocks, mut from) = (Vec::new(), self.curve.free);
        for segment in self.curve.segment[from..].chunk_by(|one, next| one == next) {
            let end = |part: usize| from + segment.len() * part / PARTS;
            blocks.extend((0..PARTS).map(|part| end(part)..end(part + 1)));
            from += segment.len();
        }
        blocks
    }

    /// Returns the straight lines of the curve that each model refines; see
    /// [`MeasuredCurve::lines`].
    pub fn lines(&self) -> Vec<Vec<f64>> {
        let has_zero = self
            .coordinates
            .iter()
            .any(|one| one.parameter == Parameter::Zero);
        self.curve.lines(has_zero)
    }

    /// Returns the root mean square residual in contact, in units of the noise of the curve; see
    /// [`scale`].
    pub fn misfit(&self, rests: &[f64]) -> f64 {
        scale(&rests[self.curve.free..], WRONG_SIDE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{on_rubber, read, rubber};
    use crate::read::options::Drift;
    use std::f64::consts::PI;

    /// The search begins with the work of adhesion of a smooth body: F/(1.5 π R) for a sphere (JKR)
    /// and F²/(π E* L³) for a punch as long as the profile (Kendall).
    #[test]
    fn a_fit_begins_with_the_work_of_a_smooth_body() {
        let curve = read(rubber(4e-8, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        let pull_off = curve
            .noise
            .max(-Extent::of(curve.force.iter().copied()).low);
        let (sphere, punch) = (
            pull_off / (1.5 * PI * 7.5e-6),
            pull_off.powi(2) / (PI * 2e6 * 2.4e-5_f64.powi(3)),
        );
        for (form, expected) in [("Paraboloid(radius: 7.5e-6)", sphere), ("None", punch)] {
            let changes = [("form", form), ("adhesion", "None")];
            let changes = changes.map(|(path, value)| (path.to_owned(), value.to_owned()));
            let document = on_rubber(1e-3, 2e6).set_all(&changes).unwrap();
            let free = ["work".parse().unwrap()];
            let mut simulation = Simulation::default();
            let (_, space) =
                Space::of(&curve, &document, &mut simulation, &free, &|| false).unwrap();
            let Coordinate { start, range, .. } = space.coordinates[0];
            assert!(
                (start / expected - 1.0).abs() < 1e-12,
                "{form}: {start:e} {expected:e}"
            );
            assert!(
                (range.1 / (FACTOR * expected) - 1.0).abs() < 1e-12 && range.0 == 0.0,
                "{form}: {range:?}"
            );
        }
    }
}
