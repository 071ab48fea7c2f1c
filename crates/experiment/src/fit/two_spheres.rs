//! Values at which the fit of a body with two spheres begins. They follow from the jumps of the
//! curve.
//!
//! On the approach each sphere snaps in when its apex touches. Between the two jumps the body moves
//! by the distance of both apexes, and the deflection of the instrument changes with the force. On
//! the retraction the spheres detach one after another. The last one carries the force alone before
//! it detaches, which is the pull-off force 1.5 π γ R of a soft instrument (Johnson, Kendall and
//! Roberts).

use crate::curve::MeasuredCurve;
use crate::curve::features::ForceJump;
use crate::fit::parameter::{Parameter, Values};
use std::f64::consts::PI;

/// Smallest size of the smaller of two jumps of one motion, as a share of the sum of both sizes,
/// for which the jumps count as those of two spheres.
const LEAST_SHARE: f64 = 0.05;
/// Radii of the second sphere, divided by the radius of the first sphere, at which further descents
/// begin.
const RATIOS: [f64; 3] = [0.4, 1.0, 2.0];
/// Distances of the apex of the second sphere behind the apex of the first sphere at which further
/// descents begin, if the curve does not show this distance. They are shares of the way of the
/// instrument in contact.
const SHARES: [f64; 3] = [0.0, 0.02, 0.1];
/// Smallest and largest ratio of both radii at which a search begins, even if the jumps of the
/// curve give another ratio.
const RATIO: [f64; 2] = [0.1, 10.0];

/// Properties of a body with two spheres that follow from the jumps of a measured curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct TwoContacts {
    /// Pull-off force in N of the first sphere alone; `None` if the spheres do not detach one after
    /// the other.
    pub pull_off: Option<f64>,
    /// Radius of the second sphere divided by the radius of the first sphere; `None` if the curve
    /// does not show it.
    pub ratio: Option<f64>,
    /// Distance in m of the apex of the second sphere behind the apex of the first sphere; `None`
    /// if the curve does not show it.
    pub behind: Option<f64>,
}

impl TwoContacts {
    /// Estimates the properties of the two spheres from the jumps of a curve. `stiffness` is the
    /// stiffness of the instrument in N/m, infinite for a rigid instrument.
    pub fn of(curve: &MeasuredCurve, stiffness: f64) -> Self {
        let compliance = 1.0 / stiffness;
        let of_body = |jump: &ForceJump| jump.displacement - compliance * jump.forces[0];
        let way = |pair: [ForceJump; 2]| (of_body(&pair[1]) - of_body(&pair[0])).abs();
        let snaps = largest_two(curve, 0);
        let detachments = largest_two(curve, 1);
        TwoContacts {
            pull_off: detachments.map(|[_, first]| first.forces[0].abs()),
            ratio: detachments.map(|[second, first]| {
                let ratio = second.size() / first.forces[0].abs().max(first.size());
                ratio.clamp(RATIO[0], RATIO[1])
            }),
            behind: snaps.or(detachments).map(way),
        }
    }

    /// Returns further sets of parameter values at which descents of the fit begin. They are the
    /// values `start` with other radii and other distances of the apexes, as far as these
    /// parameters are free. Several sets are needed because a single detachment may be that of both
    /// spheres. `way` is the distance in m that the instrument moves in contact.
    pub fn other_starts(
        &self,
        start: &Values,
        way: f64,
        is_free: impl Fn(Parameter) -> bool,
    ) -> Vec<Values> {
        let mut behinds = vec![start[Parameter::Behind as usize]];
        if is_free(Parameter::Behind) && self.behind.is_none() {
            behinds = SHARES.map(|share| share * way).to_vec();
        }
        let mut ratios = vec![1.0];
        if is_free(Parameter::SecondRadius) {
            ratios = RATIOS.to_vec();
        }
        let mut starts = Vec::new();
        for behind in &behinds {
            for ratio in &ratios {
                let mut values = *start;
                values[Parameter::Behind as usize] = *behind;
                if is_free(Parameter::SecondRadius) {
                    let radius = start[Parameter::Radius as usize];
                    values[Parameter::SecondRadius as usize] = ratio * radius;
                }
                if is_free(Parameter::Work) && self.pull_off.is_none() {
                    values[Parameter::Work as usize] /= 1.0 + ratio;
                }
                starts.push(values);
            }
        }
        starts
    }

    /// Returns the work of adhesion in J/m² that follows from the pull-off force of the first
    /// sphere. `radius` is the radius of this sphere in m.
    pub fn work(&self, radius: f64) -> Option<f64> {
        let work = self.pull_off? / (1.5 * PI * radius);
        (work > 0.0 && work.is_finite()).then_some(work)
    }
}

/// Returns the values of the parameters with which the two spheres exchange their pull-off forces
/// and their ranges of adhesion. A fit tries them too, because a curve without separate jumps
/// hardly shows which sphere is ahead.
pub(crate) fn exchanged(values: &Values) -> Values {
    let ratio = values[Parameter::SecondRadius as usize] / values[Parameter::Radius as usize];
    let mut exchanged = *values;
    exchanged[Parameter::Work as usize] *= ratio;
    exchanged[Parameter::ClosingWork as usize] *= ratio;
    exchanged[Parameter::Modulus as usize] *= ratio.sqrt();
    exchanged[Parameter::SecondRadius as usize] /= ratio * ratio;
    exchanged
}

/// Returns the two largest jumps of the first motion that has two jumps, in the order of time.
/// `parity` is 0 for approaches and 1 for retractions.
fn largest_two(curve: &MeasuredCurve, parity: usize) -> Option<[ForceJump; 2]> {
    let motions = curve
        .jumps
        .chunk_by(|jump, next| jump.segment == next.segment);
    for motion in motions.filter(|motion| motion[0].segment % 2 == parity) {
        let mut jumps = motion.to_vec();
        jumps.sort_by(|jump, next| next.size().total_cmp(&jump.size()));
        let &[first, second, ..] = &jumps[..] else {
            continue;
        };
        if second.size() < LEAST_SHARE * (first.size() + second.size()) {
            continue;
        }
        let is_in_order = first.displacement < second.displacement;
        let ascends = parity == 0;
        return Some(if is_in_order == ascends {
            [first, second]
        } else {
            [second, first]
        });
    }
    None
}
