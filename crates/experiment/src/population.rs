//! The members of a search: values of the parameters, with residuals and costs.

/// Share of different members from which on the extent of a population is meaningful.
const DISTINCT: f64 = 0.5;
/// Share of different members from which on the copies of a step have moved apart.
const MOVED: f64 = 0.8;
/// Residual, in units of the noise, beyond which a point counts less, since it is on the wrong side of a jump.
pub(crate) const WRONG_SIDE: f64 = 5.0;

/// Coordinates, and the residuals at these coordinates in units of the noise of the curve.
#[derive(Clone)]
pub(crate) struct Member {
    pub at: Vec<f64>,
    pub rests: Vec<f64>,
}

/// Members with their costs for a noise, in units of the noise of the curve, and the best member so far with its cost.
pub(crate) struct Population {
    pub members: Vec<Member>,
    pub costs: Vec<f64>,
    pub noise: f64,
    pub best: Member,
    pub cost: f64,
}

impl Population {
    /// Makes a member with this cost the best, if it is.
    pub fn keep(&mut self, member: &Member, cost: f64) {
        if cost < self.cost {
            (self.best, self.cost) = (member.clone(), cost);
        }
    }

    /// Number of different members.
    pub fn distinct(&self) -> usize {
        let is_copy = |index: usize| self.members[..index].iter().any(|one| one.at == self.members[index].at);
        (0..self.members.len()).filter(|&index| !is_copy(index)).count()
    }

    /// Returns true once few members are copies that have not moved, so that the next step can be taken.
    pub fn has_moved(&self) -> bool {
        self.distinct() as f64 >= MOVED * self.members.len() as f64
    }

    /// Returns false if most members are copies, so that the extent of the population means nothing.
    pub fn has_spread(&self) -> bool {
        self.distinct() as f64 >= DISTINCT * self.members.len() as f64
    }
}

/// Cost of a residual (in units of the noise): half its square, continued as a logarithm for points on the wrong side of a
/// jump, since measured displacements are not exact to the edge of a jump.
pub(crate) fn loss(rest: f64) -> f64 {
    let rest = rest.abs();
    if rest > WRONG_SIDE {
        WRONG_SIDE * WRONG_SIDE * (0.5 + (rest / WRONG_SIDE).ln())
    } else {
        0.5 * rest * rest
    }
}

/// Draws `count` members in proportion to their weights, at even distances; `share` is the position of the first one.
pub(crate) fn drawn(members: &[Member], weights: &[f64], count: usize, share: f64) -> Vec<Member> {
    let step = weights.iter().sum::<f64>() / count as f64;
    let (mut drawn, mut sum) = (Vec::with_capacity(count), 0.0);
    for (member, weight) in members.iter().zip(weights) {
        sum += weight;
        while drawn.len() < count && (drawn.len() as f64 + share) * step < sum {
            drawn.push(member.clone());
        }
    }
    drawn
}

/// Point number `number`, from 0 to 1, of an evenly scattered sequence (van der Corput).
pub(crate) fn share_of(number: usize, base: usize) -> f64 {
    if number == 0 { 0.0 } else { ((number % base) as f64 + share_of(number / base, base)) / base as f64 }
}
