//! The members of a search: values of the parameters, with their residuals and costs.

use asperity_data::{mean, standard_deviation};

/// Share of different members below which the extent of a population is meaningless.
const DISTINCT: f64 = 0.5;
/// Share of different members from which on the copies made in a step have moved apart.
const MOVED: f64 = 0.8;
/// Residual in units of the noise above which a point has a smaller weight, because it may lie on
/// the wrong side of a jump.
pub(crate) const WRONG_SIDE: f64 = 5.0;

/// Member of a search: a value of each coordinate, and the residuals of the curve at these values.
/// The residuals are in units of the noise of the curve.
#[derive(Clone)]
pub(crate) struct Member {
    pub place: Vec<f64>,
    pub residuals: Vec<f64>,
    /// For each point of the curve, true if the point is in contact in the measurement or in the
    /// model.
    pub in_contact: Vec<bool>,
}

impl Member {
    /// Returns the residuals of the points in contact.
    pub fn contact_residuals(&self, residuals: &[f64]) -> Vec<f64> {
        let points = residuals.iter().zip(&self.in_contact);
        points
            .filter(|(_, in_contact)| **in_contact)
            .map(|(residual, _)| *residual)
            .collect()
    }
}

/// Members of a search, with their costs for one assumed noise of the curve.
pub(crate) struct Population {
    pub members: Vec<Member>,
    pub costs: Vec<f64>,
    /// Standard deviation of the noise that the costs assume, in units of the noise of the curve.
    pub noise: f64,
    /// Best member so far. A member is a set of values of the parameters.
    pub best: Member,
    /// Cost of the best member.
    pub cost: f64,
}

impl Population {
    /// Makes a member the best one if its cost is smaller than the cost of the best member so far.
    pub fn keep(&mut self, member: &Member, cost: f64) {
        if cost < self.cost {
            self.best = member.clone();
            self.cost = cost;
        }
    }

    /// Returns the number of members that differ from each other. A member is a set of values of
    /// the parameters.
    pub fn distinct(&self) -> usize {
        let mut count = 0;
        for (index, member) in self.members.iter().enumerate() {
            let mut earlier = self.members[..index].iter();
            if !earlier.any(|other| other.place == member.place) {
                count += 1;
            }
        }
        count
    }

    /// Returns the extent of the population in each coordinate: the natural logarithm of the
    /// standard deviation of the members.
    pub fn log_extents(&self) -> Vec<f64> {
        let count = self.members.first().map_or(0, |member| member.place.len());
        let mut extents = Vec::with_capacity(count);
        for index in 0..count {
            let positions: Vec<f64> = self
                .members
                .iter()
                .map(|member| member.place[index])
                .collect();
            let deviation = standard_deviation(&positions, mean(&positions));
            extents.push(deviation.max(f64::MIN_POSITIVE).ln());
        }
        extents
    }

    /// Returns true if the members have moved enough for the next step of the search: most of them
    /// differ from each other.
    pub fn has_moved(&self) -> bool {
        self.distinct() as f64 >= MOVED * self.members.len() as f64
    }

    /// Returns true if the extent of the population is meaningful. It is not if most members are
    /// copies of others.
    pub fn has_spread(&self) -> bool {
        self.distinct() as f64 >= DISTINCT * self.members.len() as f64
    }
}

/// Returns the cost of a residual, which is in units of the noise. The cost is half the square of
/// the residual, as for normal noise. Above [`WRONG_SIDE`] the cost grows only with the logarithm
/// of the residual, because measured displacements are not exact and a point may lie on the wrong
/// side of a jump.
pub(crate) fn loss(residual: f64) -> f64 {
    let size = residual.abs();
    if size > WRONG_SIDE {
        WRONG_SIDE * WRONG_SIDE * (0.5 + (size / WRONG_SIDE).ln())
    } else {
        0.5 * size * size
    }
}

/// Draws `count` members in proportion to their weights. The weights are added up, and members are
/// drawn at equal distances along their sum. `share`, from 0 to 1, is the position of the first
/// draw within the first of these distances.
pub(crate) fn drawn(members: &[Member], weights: &[f64], count: usize, share: f64) -> Vec<Member> {
    let step = weights.iter().sum::<f64>() / count as f64;
    let mut drawn = Vec::with_capacity(count);
    let mut sum = 0.0;
    for (member, weight) in members.iter().zip(weights) {
        sum += weight;
        while drawn.len() < count && (drawn.len() as f64 + share) * step < sum {
            drawn.push(member.clone());
        }
    }
    drawn
}

/// Returns element number `number` of the van der Corput sequence in the base `base`. The elements
/// of this sequence are evenly scattered between 0 and 1.
pub(crate) fn share_of(number: usize, base: usize) -> f64 {
    if number == 0 {
        return 0.0;
    }
    ((number % base) as f64 + share_of(number / base, base)) / base as f64
}
