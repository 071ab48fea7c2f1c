//! The coordinates in which a scene is fitted, with their ranges and initial values. Ranges and
//! initial values follow from the measured curve.

use crate::curve::MeasuredCurve;
use crate::curve::numerics::Extent;
use crate::error::{ExperimentError, refused};
use crate::fit::lines::Lines;
use crate::fit::parameter::{Coordinate, Free, Parameter, Values};
use crate::fit::relaxation::{other_relaxations, seconds_in_contact, with_relaxation};
use crate::fit::result::RangeEnd;
use crate::fit::scene::{
    SECOND_BEHIND, SECOND_RADIUS, most_on_closing, radius_of, values_of, written_out, wrong,
};
use crate::fit::start::{Known, Starts};
use crate::fit::statistics::PARTS;
use crate::fit::two_spheres::TwoContacts;
use asperity_contact::Contact;
use asperity_data::{format_quantity, median};
use asperity_scene::text::ron_float;
use asperity_scene::{Document, Governing, Scene, Simulation, Solver};
use asperity_surface::Form;

/// Ratio between the initial value and each end of a range that the user does not give.
const FACTOR: f64 = 30.0;
/// Ratio between the initial radius of the second of two spheres and each end of its range, if the
/// user gives no range.
const FACTOR_OF_RADII: f64 = 5.0;
/// Smallest ratio of the ends of a range that the limits of a scene leave.
const NARROWEST: f64 = 2.0;
/// Largest share of the modulus that relaxes in a search. A larger share leaves hardly any modulus.
const MOST_RELAXATION: f64 = 0.95;
/// Share of the modulus that relaxes, up to which the coordinate of this share is linear.
const LINEAR_SHARE: f64 = 0.01;
/// Ratio between the initial relaxation time and each end of its range, if the user gives no range.
const FACTOR_OF_TIMES: f64 = 300.0;
/// Depth of an end of a line below its highest point, as a share of the largest depth, up to which
/// the end counts as the highest point.
const HIGHEST: f64 = 1e-3;
/// A body is hollow if its higher end counts as the highest point, its other end is at most `HIGH`
/// deep, and its median depth is above `DEEP`. Both are shares of the largest depth.
const HIGH: f64 = 0.25;
const DEEP: f64 = 0.5;
/// Share of a range within which a value counts as lying at the end of the range.
const AT_END: f64 = 0.01;

/// The coordinates in which a scene is fitted, with the values of all other parameters.
#[derive(Clone)]
pub(crate) struct Space<'a> {
    pub base: Values,
    pub coordinates: Vec<Coordinate>,
    /// Number of coordinates of the first curve. The coordinates after these belong to further
    /// curves.
    pub own: usize,
    /// Largest allowed work of adhesion on closing in J/m².
    pub most_on_closing: f64,
    /// Further sets of parameter values at which descents of the fit begin.
    pub other_starts: Vec<Values>,
    /// Further sets of parameter values, which differ in the relaxation, at which descents begin.
    pub relaxations: Vec<Values>,
    /// Time in s that the body spends in contact, including the rest of the instrument; `None` if
    /// the half-space does not relax. In a time that is short compared with the relaxation time, a
    /// curve determines only which part of the modulus relaxes within this time. The coordinate of
    /// the parameter `RelaxationShare` is therefore that of this part.
    pub seconds_in_contact: Option<f64>,
    pub curve: &'a MeasuredCurve,
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

/// Returns an error if there is no free parameter, or if a parameter is given twice.
fn check_free(free: &[Free]) -> Result<(), ExperimentError> {
    if free.is_empty() {
        let names = Parameter::ALL.map(Parameter::name).join(", ");
        return refused("no free parameter", format!("one or more of {names}"));
    }
    for (index, Free { parameter, .. }) in free.iter().enumerate() {
        if is_free(&free[..index], *parameter) {
            let found = format!("{} is free twice", parameter.name());
            return refused(found, "each parameter once");
        }
    }
    Ok(())
}

fn is_free(free: &[Free], parameter: Parameter) -> bool {
    free.iter().any(|free| free.parameter == parameter)
}

/// Returns an error for a scene that cannot be fitted with these free parameters.
fn check_scene(scene: &Scene, free: &[Free]) -> Result<(), ExperimentError> {
    if scene.numerics.solver != Solver::Exact {
        let found = "numerics.solver = Stepwise: a fit needs the exact solver";
        return refused(found, "numerics.solver = Exact");
    }
    if is_free(free, Parameter::Radius) && radius_of(scene).is_none() {
        let found = "radius: the form of the scene has none";
        let allowed = "form = Paraboloid, WavySphere, RoundedCone, Spheres or Punch";
        return refused(found, allowed);
    }
    let spheres = scene.form.as_ref().map_or(&[][..], Form::spheres);
    for Free { parameter, .. } in free {
        if parameter.is_of_two_spheres() && spheres.len() < 2 {
            let name = parameter.name();
            let found = format!("{name}: the form of the scene has no second sphere");
            return refused(found, "form = Spheres with two spheres or more");
        }
    }
    if is_free(free, Parameter::Behind) && spheres[0].behind > 0.0 {
        let found = "behind: the first sphere of the form is behind another one";
        return refused(
            found,
            "form.0.behind = 0: the first sphere ahead of the others",
        );
    }
    Ok(())
}

/// Returns an error for a body that is a measured line whose highest point lies at one of its ends.
/// The contact would begin there, as it does if depths are taken for heights.
fn check_apex(scene: &Scene, contact: &Contact) -> Result<(), ExperimentError> {
    if scene.form.is_some() || !scene.measured_as_line() {
        return Ok(());
    }
    let mut gaps = contact.gaps().to_vec();
    let [Some(first), Some(last)] = [gaps.first().copied(), gaps.last().copied()] else {
        return Ok(());
    };
    let deepest = Extent::of(gaps.iter().copied()).high;
    let is_highest = first.min(last) <= HIGHEST * deepest;
    let are_both_high = first.max(last) < HIGH * deepest;
    let is_deep = median(&mut gaps).is_some_and(|gap| gap > DEEP * deepest);
    if is_highest && are_both_high && is_deep {
        let found =
            "the highest point of the measured line lies at its end, so that the body is hollow";
        let allowed = "heights, which grow outwards, and a line whose highest point is inside";
        return refused(found, allowed);
    }
    Ok(())
}

/// Returns an error for a curve that turns before contact.
fn check_turn(curve: &MeasuredCurve) -> Result<(), ExperimentError> {
    if curve.turns[0] <= curve.touch {
        let contact_point = format_quantity(curve.touch, "m");
        let turn = format_quantity(curve.turns[0], "m");
        let found =
            format!("the contact begins at {contact_point}, and the displacement turns at {turn}");
        return refused(found, "a contact before the first turning point");
    }
    Ok(())
}

/// Returns the values of a scene that are not free parameters.
fn known(scene: &Scene, governing: &Governing, free: &[Free]) -> Known {
    let unless_free = |parameter, value| (!is_free(free, parameter)).then_some(value);
    let stiffness = scene.loading_stiffness.unwrap_or(f64::INFINITY);
    Known {
        radius: radius_of(scene),
        length: scene.length,
        modulus: unless_free(Parameter::Modulus, governing.modulus),
        stiffness: unless_free(Parameter::Stiffness, stiffness),
    }
}

/// Returns the document with the lengths of the first two spheres at which a search begins, and the
/// properties of these spheres that follow from the jumps of the curve. A length that does not
/// follow from the jumps keeps its value in the scene, and so do the lengths of further spheres.
fn with_two_spheres(
    document: &Document,
    curve: &MeasuredCurve,
    free: &[Free],
) -> Result<(Document, TwoContacts), ExperimentError> {
    let scene = document.scene();
    let spheres = scene.form.as_ref().map_or(&[][..], Form::spheres);
    let [first, _, ..] = spheres else {
        return Ok((document.clone(), TwoContacts::default()));
    };
    let radius = first.radius;
    let stiffness = scene.loading_stiffness.unwrap_or(f64::INFINITY);
    let contacts = TwoContacts::of(curve, stiffness);
    let mut changes = Vec::new();
    for (parameter, path, start) in [
        (
            Parameter::SecondRadius,
            SECOND_RADIUS,
            contacts.ratio.map(|ratio| ratio * radius),
        ),
        (Parameter::Behind, SECOND_BEHIND, contacts.behind),
    ] {
        let given = free.iter().find(|free| free.parameter == parameter);
        if let (Some(start), Some(given)) = (start, given) {
            let (low, high) = given.range.unwrap_or((0.0, f64::INFINITY));
            changes.push((path.to_owned(), ron_float(start.clamp(low, high))));
        }
    }
    let document = document.set_all(&changes).map_err(wrong)?;
    Ok((document, contacts))
}

/// Data from which the coordinates of the free parameters follow.
struct Ranges<'a> {
    curve: &'a MeasuredCurve,
    free: &'a [Free],
    starts: Starts,
    /// Range of the force in N, at least the noise of the force.
    extent_of_force: f64,
}

impl Ranges<'_> {
    /// Returns the initial values of all parameters. Estimates from the curve replace the values of
    /// the scene for free parameters.
    fn start_values(&self, mut values: Values) -> Values {
        for (parameter, start) in [
            (Parameter::Work, self.starts.work),
            (Parameter::Modulus, self.starts.modulus),
            (Parameter::Stiffness, self.starts.stiffness),
        ] {
            if is_free(self.free, parameter) {
                values[parameter as usize] = start;
            }
        }
        values[Parameter::Offset as usize] = self.starts.touch;
        if is_free(self.free, Parameter::ClosingWork) {
            values[Parameter::ClosingWork as usize] = values[Parameter::Work as usize];
        }
        values
    }

    /// Returns the coordinates of the free parameters. An initial value outside its range is moved
    /// to the nearer end.
    fn coordinates(&self, values: &mut Values) -> Result<Vec<Coordinate>, ExperimentError> {
        let mut coordinates = Vec::new();
        let mut most_work = values[Parameter::Work as usize];
        for parameter in Parameter::ALL {
            let Some(free) = self.free.iter().find(|free| free.parameter == parameter) else {
                continue;
            };
            let range = match free.range {
                Some(range) => range,
                None => within_scene(parameter, self.range_of(parameter, values)),
            };
            if parameter == Parameter::ClosingWork && range.0 > most_work {
                let least = format_quantity(range.0, "J/m²");
                let most = format_quantity(most_work, "J/m²");
                let found = format!("{} of at least {least}", parameter.name());
                let allowed = format!("from 0 to {most}, the work of adhesion");
                return refused(found, allowed);
            }
            let start = values[parameter as usize].clamp(range.0, range.1);
            values[parameter as usize] = start;
            // The work of adhesion precedes the work on closing in the loop, so its largest value
            // limits the work on closing.
            if parameter == Parameter::Work {
                most_work = range.1;
            }
            coordinates.push(Coordinate {
                parameter,
                start,
                range,
                unit: self.unit_of(parameter),
            });
        }
        Ok(coordinates)
    }

    /// Returns the range in which a parameter is searched if the user gives none. `values` contains
    /// the initial value.
    fn range_of(&self, parameter: Parameter, values: &Values) -> (f64, f64) {
        let start = values[parameter as usize];
        let work = values[Parameter::Work as usize];
        match parameter {
            Parameter::Offset => {
                let displacements = self.curve.displacement.iter().copied();
                (Extent::of(displacements).low, self.curve.turns[0])
            }
            Parameter::Zero => (-self.extent_of_force, self.extent_of_force),
            Parameter::Work => (0.0, start * FACTOR),
            Parameter::ClosingWork if is_free(self.free, Parameter::Work) => (0.0, work * FACTOR),
            Parameter::ClosingWork => (0.0, work),
            Parameter::SecondRadius => (start / FACTOR_OF_RADII, start * FACTOR_OF_RADII),
            Parameter::Behind => (0.0, self.starts.way.max(2.0 * start)),
            Parameter::RelaxationShare => (0.0, MOST_RELAXATION),
            Parameter::RelaxationTime => (start / FACTOR_OF_TIMES, start * FACTOR_OF_TIMES),
            _ => (start / FACTOR, start * FACTOR),
        }
    }

    /// Returns the unit of a coordinate in SI units: for the work of adhesion the value that the
    /// noise hides, for the zero a tenth of the range of the force, for the share that relaxes
    /// [`LINEAR_SHARE`], and for a displacement a tenth of the way in contact. Other parameters do
    /// not use it.
    fn unit_of(&self, parameter: Parameter) -> f64 {
        match parameter {
            Parameter::Work => self.starts.least_work,
            Parameter::Zero => 0.1 * self.extent_of_force,
            Parameter::RelaxationShare => LINEAR_SHARE,
            _ => 0.1 * self.starts.way,
        }
    }
}

impl<'a> Space<'a> {
    /// Checks the free parameters and the scene. Returns the document, in which works of adhesion
    /// replace κ, and the coordinates of the fit.
    ///
    /// # Errors
    /// Returns an error if no parameter is free, if a parameter is given twice, if the scene lacks
    /// a free parameter or does not suit a fit, if the curve turns before contact, or if the
    /// contact cannot be computed.
    pub fn of(
        curve: &'a MeasuredCurve,
        document: &Document,
        simulation: &mut Simulation,
        free: &[Free],
        stop: &'a (dyn Fn() -> bool + Sync),
    ) -> Result<(Document, Self), ExperimentError> {
        check_free(free)?;
        let (document, _) = curve.with_instrument(document).map_err(wrong)?;
        let scene = document.scene();
        check_scene(scene, free)?;
        check_turn(curve)?;
        let (document, contacts) = with_two_spheres(&document, curve, free)?;
        let document = with_relaxation(&document, curve, free)?;
        let scene = document.scene();
        let (contact, governing) = simulation.contact(scene)?;
        check_apex(scene, &contact)?;
        let mut starts = Starts::of(curve, &contact, known(scene, &governing, free))?;
        if let Some(radius) = radius_of(scene)
            && let Some(work) = contacts.work(radius)
        {
            starts.work = work;
        }
        let work = is_free(free, Parameter::Work).then_some(starts.work);
        let document = written_out(&document, &governing, work).map_err(wrong)?;
        let (_, governing) = simulation.contact(document.scene())?;
        if is_free(free, Parameter::ClosingWork) && governing.adhesive_work().is_none() {
            let name = Parameter::ClosingWork.name();
            let found = format!("{name}: the scene has no adhesion");
            return refused(
                found,
                "adhesion.work above 0, or a free work of adhesion too",
            );
        }

        let force = Extent::of(curve.force.iter().copied());
        let ranges = Ranges {
            curve,
            free,
            starts,
            extent_of_force: force.width().max(curve.noise),
        };
        let mut base = ranges.start_values(values_of(document.scene(), &governing));
        let coordinates = ranges.coordinates(&mut base)?;
        let is_of_two = free.iter().any(|free| free.parameter.is_of_two_spheres());
        let other_starts = if is_of_two {
            let way = ranges.starts.way;
            contacts.other_starts(&base, way, |parameter| is_free(free, parameter))
        } else {
            Vec::new()
        };
        let relaxations = other_relaxations(&base, |parameter| is_free(free, parameter));
        let space = Space {
            base,
            own: coordinates.len(),
            coordinates,
            most_on_closing: most_on_closing(document.scene()),
            other_starts,
            relaxations,
            seconds_in_contact: seconds_in_contact(curve, document.scene()),
            curve,
            stop,
        };
        Ok((document, space))
    }

    /// Returns true if the half-space relaxes, or may do so in the search.
    pub fn relaxes(&self) -> bool {
        let of_relaxation = |coordinate: &Coordinate| coordinate.parameter.is_of_relaxation();
        let is_free = self.coordinates.iter().any(of_relaxation);
        is_free || self.base[Parameter::RelaxationShare as usize] > 0.0
    }

    /// Returns the free parameters in the order of the coordinates.
    pub fn parameters(&self) -> Vec<Parameter> {
        self.coordinates
            .iter()
            .map(|coordinate| coordinate.parameter)
            .collect()
    }

    /// Returns the values of all parameters. `place` has one coordinate for each free parameter:
    /// its value on the scale of the search. The coordinates of further curves are ignored.
    pub fn values(&self, place: &[f64]) -> Values {
        let mut values = self.base;
        let coordinates = self.coordinates.iter().zip(place);
        for (coordinate, &position) in coordinates.take(self.own) {
            values[coordinate.parameter as usize] = coordinate.value(position, &values);
            if coordinate.parameter == Parameter::Work {
                let work = values[Parameter::Work as usize];
                values[Parameter::ClosingWork as usize] = work.min(self.most_on_closing);
            }
        }
        if let Some(index) = self.share_of_coordinate() {
            let most = self.coordinates[index].range.1;
            let share = self.whole_share(&values);
            values[Parameter::RelaxationShare as usize] = share.min(most);
        }
        values
    }

    /// Returns the whole share of the modulus that relaxes. `values` has, as `RelaxationShare`,
    /// only the part of the modulus that relaxes within the time in contact.
    fn whole_share(&self, values: &Values) -> f64 {
        values[Parameter::RelaxationShare as usize] / self.relaxed_part(values)
    }

    /// Returns the index of the coordinate of the share of the modulus that relaxes; `None` if this
    /// share is not free.
    fn share_of_coordinate(&self) -> Option<usize> {
        self.coordinates
            .iter()
            .position(|coordinate| coordinate.parameter == Parameter::RelaxationShare)
    }

    /// Returns the part of the relaxation that happens within the time in contact, from 0 to 1.
    fn relaxed_part(&self, values: &Values) -> f64 {
        let time = values[Parameter::RelaxationTime as usize];
        match self.seconds_in_contact {
            Some(seconds) => -(-seconds / time).exp_m1(),
            None => 1.0,
        }
    }

    /// Returns the same samples with another coordinate of the parameter `RelaxationShare`: the
    /// coordinate of the whole share that relaxes, instead of the part that relaxes within
    /// [`Self::seconds_in_contact`].
    pub fn with_whole_shares(&self, places: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut whole = places.to_vec();
        if let Some(index) = self.share_of_coordinate() {
            for place in &mut whole {
                let values = self.values(place);
                let share = values[Parameter::RelaxationShare as usize];
                place[index] = self.coordinates[index].of(share, &values);
            }
        }
        whole
    }

    /// Returns the coordinates that are nearest to `place` and lie within their ranges.
    pub fn inside(&self, place: &[f64]) -> Vec<f64> {
        let coordinates = self.coordinates.iter().zip(place);
        let inside = coordinates.map(|(coordinate, position)| {
            let (low, high) = coordinate.ends();
            position.clamp(low, high)
        });
        let mut inside: Vec<f64> = inside.collect();
        if let Some(index) = self.share_of_coordinate() {
            let values = self.values(&inside);
            let share = self.coordinates[index];
            let most = share.range.1 * self.relaxed_part(&values);
            inside[index] = inside[index].min(share.of(most, &values));
        }
        inside
    }

    /// Returns true if each coordinate of `place` lies within its range.
    pub fn contains(&self, place: &[f64]) -> bool {
        let are_inside = self
            .coordinates
            .iter()
            .zip(place)
            .all(|(coordinate, position)| {
                let (low, high) = coordinate.ends();
                (low..=high).contains(position)
            });
        let has_share = |index: usize| {
            let mut values = self.base;
            for (coordinate, &position) in self.coordinates.iter().zip(place) {
                if coordinate.parameter.is_of_relaxation() {
                    let value = coordinate.value(position, &values);
                    values[coordinate.parameter as usize] = value;
                }
            }
            self.whole_share(&values) <= self.coordinates[index].range.1
        };
        are_inside && self.share_of_coordinate().is_none_or(has_share)
    }

    /// Returns the free parameters with larger ranges, if a coordinate of `place` lies at an end of
    /// its range and the user did not give this range. Returns `None` otherwise, and if scenes
    /// allow no larger range. The ranges of the offset, the zero, the work of adhesion on closing,
    /// the distance behind and the relaxation stay as they are. `given` are the free parameters as
    /// the user gave them, and `free` are those of the search.
    ///
    /// Larger ranges may be needed for two reasons. The pull-off force of a rough body may be a
    /// small part of the pull-off force of a smooth body. A drag or a drift may falsify the initial
    /// modulus.
    pub fn extended(&self, place: &[f64], given: &[Free], free: &[Free]) -> Option<Vec<Free>> {
        let mut wider = free.to_vec();
        let mut is_wider = false;
        for (index, coordinate) in self.coordinates.iter().enumerate() {
            let parameter = coordinate.parameter;
            let has_own_range = parameter.is_signed()
                || parameter.is_of_relaxation()
                || matches!(parameter, Parameter::ClosingWork | Parameter::Behind);
            let is_given = given
                .iter()
                .any(|free| free.parameter == parameter && free.range.is_some());
            let Some(end) = self.end_at(index, place) else {
                continue;
            };
            if has_own_range || is_given {
                continue;
            }
            let (low, high) = coordinate.range;
            let range = match end {
                RangeEnd::Low => (low / FACTOR, high),
                RangeEnd::High => (low, high * FACTOR),
            };
            let free = wider.iter_mut().find(|free| free.parameter == parameter)?;
            let range = within_scene(parameter, range);
            is_wider |= range != coordinate.range;
            free.range = Some(range);
        }
        is_wider.then_some(wider)
    }

    /// Returns the end of its range at which the coordinate with the index `index` in `place` lies.
    /// Returns `None` if it lies inside its range. Also returns `None` if the end is a possible
    /// value: a work of adhesion of 0, either end for the work of adhesion on closing, a distance
    /// behind of 0, or the lower end of the share that relaxes.
    pub fn end_at(&self, index: usize, place: &[f64]) -> Option<RangeEnd> {
        let coordinate = self.coordinates[index];
        let (low, high) = coordinate.ends();
        let room = AT_END * (high - low);
        let value = if coordinate.parameter == Parameter::RelaxationShare {
            let values = self.values(place);
            coordinate.of(values[Parameter::RelaxationShare as usize], &values)
        } else {
            place[index]
        };
        let is_closing = coordinate.parameter == Parameter::ClosingWork;
        if value > high - room && !is_closing {
            return Some(RangeEnd::High);
        }
        let is_behind = coordinate.parameter == Parameter::Behind && coordinate.range.0 == 0.0;
        let is_elastic = coordinate.parameter == Parameter::RelaxationShare;
        let may_be_low = is_closing || is_behind || is_elastic || coordinate.is_work_from_zero();
        (value < low + room && !may_be_low).then_some(RangeEnd::Low)
    }

    /// Returns the coordinates at which the search begins.
    pub fn start(&self) -> Vec<f64> {
        self.coordinates
            .iter()
            .map(|coordinate| self.position(coordinate, coordinate.start, &self.base))
            .collect()
    }

    /// Returns the position of a value along a coordinate. `values` contains the other parameters.
    fn position(&self, coordinate: &Coordinate, value: f64, values: &Values) -> f64 {
        if coordinate.parameter == Parameter::RelaxationShare {
            return coordinate.of(value * self.relaxed_part(values), values);
        }
        coordinate.of(value, values)
    }

    /// Returns the coordinates of these values of the parameters. Further curves get the
    /// coordinates of their initial values. A coordinate outside its range is replaced by the
    /// nearer end of the range.
    pub fn place(&self, values: &Values) -> Vec<f64> {
        let mut place = Vec::with_capacity(self.coordinates.len());
        for (index, coordinate) in self.coordinates.iter().enumerate() {
            let value = if index < self.own {
                values[coordinate.parameter as usize]
            } else {
                coordinate.start
            };
            place.push(self.position(coordinate, value, values));
        }
        self.inside(&place)
    }

    /// Divides the points in contact of each segment into consecutive blocks, and returns the
    /// indices of the points in each block. The residuals of different blocks depend on each other
    /// less than those of single points do.
    pub fn blocks(&self, in_contact: &[bool]) -> Vec<Vec<usize>> {
        let mut blocks = Vec::new();
        let mut start = 0;
        for segment in self.curve.segment.chunk_by(|number, next| number == next) {
            let range = start..start + segment.len();
            start = range.end;
            let points: Vec<usize> = range.filter(|index| in_contact[*index]).collect();
            for part in 0..PARTS {
                let from = points.len() * part / PARTS;
                let to = points.len() * (part + 1) / PARTS;
                blocks.push(points[from..to].to_vec());
            }
        }
        blocks
    }

    /// Returns the contributions to the force of the curve, such as its zero, that are fitted again
    /// for each computed model.
    pub fn lines(&self) -> Lines {
        let is_zero = |coordinate: &Coordinate| coordinate.parameter == Parameter::Zero;
        Lines::new(self.curve, self.coordinates.iter().any(is_zero))
    }
}

/// Returns the part of a range that scenes allow.
fn within_scene(parameter: Parameter, range: (f64, f64)) -> (f64, f64) {
    let Some((least, most)) = parameter.allowed_by_scenes() else {
        return range;
    };
    let low = range.0.clamp(least, most / NARROWEST);
    (low, range.1.clamp(NARROWEST * low, most))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{on_rubber, read, rubber};
    use crate::read::options::Drift;
    use std::f64::consts::PI;

    /// The search begins with the work of adhesion with which a smooth body has the pull-off force
    /// F of the curve: F/(1.5 π R) for a sphere (JKR), and F²/(π E* L³) for a punch with the length
    /// L of the profile (Kendall).
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

    /// A range that the user does not give is widened at the end at which a place lies, up to the
    /// values that scenes allow.
    #[test]
    fn ranges_are_reopened_up_to_what_scenes_allow() {
        let curve = read(rubber(4e-8, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        let document = on_rubber(1e-3, 2e6);
        let given: Vec<Free> = ["work", "modulus", "offset"]
            .map(|text| text.parse().unwrap())
            .to_vec();
        let mut simulation = Simulation::default();
        let mut ranges = given.clone();
        let mut lowest = f64::INFINITY;
        for _ in 0..20 {
            let (_, space) =
                Space::of(&curve, &document, &mut simulation, &ranges, &|| false).unwrap();
            let mut place = space.start();
            assert_eq!(space.extended(&place, &given, &ranges), None);
            place[1] = space.coordinates[1].ends().0;
            assert_eq!(space.end_at(1, &place), Some(RangeEnd::Low));
            let Some(wider) = space.extended(&place, &given, &ranges) else {
                break;
            };
            let before = space.coordinates[1].range;
            let (low, high) = wider[1].range.unwrap();
            assert!(low < before.0 && high == before.1 && low <= lowest);
            lowest = low;
            ranges = wider;
        }
        assert!((1.0..2.0).contains(&lowest), "{lowest}");
        let bounded = ["work", "modulus=1MPa..2MPa", "offset"].map(|text| text.parse().unwrap());
        let (_, space) =
            Space::of(&curve, &document, &mut simulation, &bounded, &|| false).unwrap();
        let mut place = space.start();
        place[1] = space.coordinates[1].ends().1;
        assert_eq!(space.extended(&place, &bounded, &bounded), None);
        assert_eq!(space.end_at(1, &place), Some(RangeEnd::High));
    }
}
