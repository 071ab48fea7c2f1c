//! The force along a stage straight from its thresholds: all of them sorted, nothing bounded or
//! skipped.

use crate::body::Body;

/// All segments of a stage: between two thresholds the same springs are in contact.
pub struct Segments {
    stiffness: f64,
    /// Thresholds in ascending order, with the springs in contact from there on.
    steps: Vec<Step>,
    /// (threshold, gap) of each spring.
    springs: Vec<(f64, f64)>,
}

#[derive(Clone, Copy)]
struct Step {
    from: f64,
    springs: f64,
    /// Σ c as an unrounded sum of two numbers, m.
    gaps: (f64, f64),
}

impl Step {
    /// Σ (d − c), m.
    fn compression(&self, d: f64) -> f64 {
        let product = self.springs * d;
        let product_error = self.springs.mul_add(d, -product);
        let (sum, error) = two_sum(product, -self.gaps.0);
        sum + (error + (product_error - self.gaps.1))
    }
}

/// a + b and its rounding error.
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let added = sum - a;
    (sum, (a - (sum - added)) + (b - added))
}

impl Segments {
    pub fn new(thresholds: &[f64], body: &Body) -> Self {
        let mut springs: Vec<(f64, f64)> = thresholds
            .iter()
            .copied()
            .zip(body.gaps.iter().copied())
            .collect();
        springs.retain(|(threshold, _)| *threshold < f64::INFINITY);
        springs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let nothing = Step {
            from: f64::NEG_INFINITY,
            springs: 0.0,
            gaps: (0.0, 0.0),
        };
        let mut steps = vec![nothing];
        for &(threshold, gap) in &springs {
            let last = steps[steps.len() - 1];
            let (high, low) = two_sum(last.gaps.0, gap);
            let next = Step {
                from: threshold,
                springs: last.springs + 1.0,
                gaps: (high, last.gaps.1 + low),
            };
            if last.from == threshold {
                steps.pop();
            }
            steps.push(next);
        }
        Segments {
            stiffness: body.foundation.spring_stiffness(),
            steps,
            springs,
        }
    }

    /// Pieces (from, to, step) of a range, in ascending order.
    fn pieces(&self, low: f64, high: f64) -> impl DoubleEndedIterator<Item = (f64, f64, Step)> {
        (0..self.steps.len()).filter_map(move |index| {
            let step = self.steps[index];
            let next = self
                .steps
                .get(index + 1)
                .map_or(f64::INFINITY, |next| next.from);
            let (from, to) = (step.from.max(low), next.min(high));
            (from < to || (from == to && high < next)).then_some((from, to, step))
        })
    }

    fn at(&self, d: f64) -> Step {
        self.steps[self.steps.partition_point(|step| step.from <= d) - 1]
    }

    /// F(d), N.
    pub fn force(&self, d: f64) -> f64 {
        self.stiffness * self.at(d).compression(d)
    }

    /// Smallest force in contact on a range, N: it is at a threshold or at the low end.
    pub fn smallest(&self, low: f64, high: f64) -> f64 {
        let held = self
            .pieces(low, high)
            .filter(|(_, _, step)| step.springs > 0.0);
        let ends = held.map(|(from, _, step)| self.stiffness * step.compression(from));
        ends.fold(f64::INFINITY, f64::min)
    }

    /// Largest force on a range, N: just before a threshold or at the high end.
    pub fn largest(&self, low: f64, high: f64) -> f64 {
        let ends = self
            .pieces(low, high)
            .map(|(_, to, step)| self.stiffness * step.compression(to));
        ends.fold(self.force(high), f64::max)
    }

    /// Smallest indentation from `low` on at which the force is at least `force`.
    pub fn first_at_least(&self, force: f64, low: f64) -> Option<f64> {
        let wanted = force / self.stiffness;
        self.pieces(low, f64::INFINITY)
            .find_map(|(from, to, step)| {
                if step.compression(from) >= wanted {
                    return Some(from);
                }
                let crossing = (wanted + step.gaps.0 + step.gaps.1) / step.springs;
                (step.springs > 0.0 && crossing < to).then_some(crossing)
            })
    }

    /// Largest indentation up to `high` at which springs are in contact and the force is at most
    /// `force`.
    pub fn last_at_most(&self, force: f64, high: f64) -> Option<f64> {
        let wanted = force / self.stiffness;
        self.pieces(f64::NEG_INFINITY, high)
            .rev()
            .find_map(|(from, to, step)| {
                if step.springs == 0.0 || step.compression(from) > wanted {
                    return None;
                }
                Some(((wanted + step.gaps.0 + step.gaps.1) / step.springs).min(to))
            })
    }

    /// ∫F dd over a range, J.
    pub fn work(&self, low: f64, high: f64) -> f64 {
        let area = |(from, to, step): (f64, f64, Step)| {
            0.5 * (to - from) * (step.compression(from) + step.compression(to))
        };
        self.stiffness
            * self
                .pieces(low, high)
                .filter(|piece| piece.2.springs > 0.0)
                .map(area)
                .sum::<f64>()
    }

    /// Energy in the springs in contact at d, J.
    pub fn stored_energy(&self, d: f64) -> f64 {
        let held = self.springs.iter().filter(|(threshold, _)| *threshold <= d);
        0.5 * self.stiffness * held.map(|(_, gap)| (d - gap) * (d - gap)).sum::<f64>()
    }
}
