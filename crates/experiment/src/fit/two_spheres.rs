//! Values at which the fit of a body with two spheres begins. They follow from the jumps of the
//! curve.
//!
//! On the approach each sphere snaps in when its apex touches. The body has then moved by the
//! distance of both apices, and the instrument has bent by the force. On the retraction the spheres
//! detach one after another. The last one carries the force alone before it detaches, which is the
//! pull-off force 1.5 π γ R of a soft instrument (Johnson, Kendall and Roberts).

use crate::curve::MeasuredCurve;
use crate::curve::features::ForceJump;
use std::f64::consts::PI;

/// Share of the sum of both sizes that two jumps of one motion have at least.
const LEAST_SHARE: f64 = 0.05;
/// Limits of the ratio of both radii at the start.
const RATIO: [f64; 2] = [0.1, 10.0];

/// What the jumps of a curve say about a body with two spheres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct TwoContacts {
    /// Pull-off force of the first sphere alone, N.
    pub pull_off: Option<f64>,
    /// Radius of the second sphere divided by that of the first one.
    pub ratio: Option<f64>,
    /// Distance of the second apex behind the first one, m.
    pub behind: Option<f64>,
}

impl TwoContacts {
    /// `stiffness` is that of the instrument in N/m, infinite for a rigid one.
    pub fn of(curve: &MeasuredCurve, stiffness: f64) -> Self {
        let compliance = 1.0 / stiffness;
        let of_body = |jump: &ForceJump| jump.displacement - compliance * jump.forces[0];
        let way = |pair: [ForceJump; 2]| (of_body(&pair[1]) - of_body(&pair[0])).abs();
        let snaps = largest_two(curve, 0);
        let detachments = largest_two(curve, 1);
        let last = curve.jumps.iter().rev().find(|jump| jump.segment % 2 == 1);
        let has_two = snaps.is_some() || detachments.is_some();
        TwoContacts {
            pull_off: last.filter(|_| has_two).map(|jump| jump.forces[0].abs()),
            ratio: detachments.map(|[second, first]| {
                let ratio = second.size() / first.forces[0].abs().max(first.size());
                ratio.clamp(RATIO[0], RATIO[1])
            }),
            behind: snaps.or(detachments).map(way),
        }
    }

    /// Returns the work of adhesion in J/m² by the pull-off force of the first sphere, which has
    /// this radius in m.
    pub fn work(&self, radius: f64) -> Option<f64> {
        let work = self.pull_off? / (1.5 * PI * radius);
        (work > 0.0 && work.is_finite()).then_some(work)
    }
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
