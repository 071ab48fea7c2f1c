//! The members of a search: values of the parameters, with residuals and costs.

/// Share of different members from which on the extent of a population is meaningful.
const DISTINCT: f64 = 0.5;
/// Residual, in units of the noise, beyond which a point counts less, since it is on the wrong side of a jump.
pub(super) const WRONG_SIDE: f64 = 5.0;

/// Coordinates, and the residuals at these coordinates in units of the noise of the curve.
#[derive(Clone)]
pub(super) struct Member {
    pub at: Vec<f64>,
    pub rests: Vec<f64>,
}

/// Members with their costs for a noise, in units of the noise of the curve, and the best member so far with its cost.
pub(super) struct Population {
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

    /// Returns false if most members are copies, so that the extent of the population means nothing.
    pub fn has_spread(&self) -> bool {
        self.distinct() as f64 >= DISTINCT * self.members.len() as f64
    }
}

/// Cost of a residual (in units of the noise): half its square, continued as a logarithm for points on the wrong side of a
/// jump, since measured displacements are not exact to the edge of a jump.
pub(super) fn loss(rest: f64) -> f64 {
    let rest = rest.abs();
    if rest > WRONG_SIDE {
        WRONG_SIDE * WRONG_SIDE * (0.5 + (rest / WRONG_SIDE).ln())
    } else {
        0.5 * rest * rest
    }
}

/// Draws `count` members in proportion to their weights, at even distances; `share` is the position of the first one.
pub(super) fn drawn(members: &[Member], weights: &[f64], count: usize, share: f64) -> Vec<Member> {
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
pub(super) fn share_of(number: usize, base: usize) -> f64 {
    if number == 0 { 0.0 } else { ((number % base) as f64 + share_of(number / base, base)) / base as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn members(of: &[f64]) -> Vec<Member> {
        of.iter().map(|at| Member { at: vec![*at], rests: Vec::new() }).collect()
    }

    #[test]
    fn members_are_drawn_as_often_as_they_weigh() {
        let drawn = drawn(&members(&[1.0, 2.0, 3.0, 4.0]), &[0.5, 0.0, 1.5, 2.0], 8, 0.5);
        assert_eq!(drawn.iter().map(|one| one.at[0]).collect::<Vec<_>>(), [1., 3., 3., 3., 4., 4., 4., 4.]);
    }

    #[test]
    fn copies_are_no_population() {
        let population = |of: &[f64]| {
            let best = Member { at: vec![0.0], rests: Vec::new() };
            Population { members: members(of), costs: vec![0.0; of.len()], noise: 1.0, best, cost: 1.0 }
        };
        let copies = population(&[1.0, 2.0, 1.0, 1.0, 1.0]);
        assert_eq!((copies.distinct(), copies.has_spread()), (2, false));
        let mut spread = population(&[1.0, 2.0, 1.0, 1.0]);
        assert!(spread.has_spread());
        spread.keep(&members(&[5.0])[0], 1.0);
        assert_eq!(spread.best.at, [0.0]);
        spread.keep(&members(&[6.0])[0], 0.9);
        assert_eq!((&spread.best.at[..], spread.cost), (&[6.0][..], 0.9));
    }

    #[test]
    fn the_loss_goes_on_as_a_logarithm() {
        assert_eq!((loss(-3.0), loss(5.0)), (4.5, 12.5));
        assert!((loss(5.0 * std::f64::consts::E) - 37.5).abs() < 1e-12);
        // Of the same slope at the limit.
        assert!((loss(5.001) - loss(5.0) - 5e-3).abs() < 1e-5);
    }

    #[test]
    fn points_are_scattered_evenly() {
        assert_eq!([1, 2, 3, 4].map(|number| share_of(number, 2)), [0.5, 0.25, 0.75, 0.125]);
        assert_eq!(share_of(0, 3), 0.0);
        assert!((share_of(5, 3) - (2.0 / 3.0 + 1.0 / 9.0)).abs() < 1e-15);
    }
}
