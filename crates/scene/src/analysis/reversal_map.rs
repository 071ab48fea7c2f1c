//! Unloading curves from many turning points of one loading, and their Everett function.

use asperity_contact::Reversal;
use std::ops::RangeInclusive;

/// Unloading curves from many turning points of one loading (first-order reversal curves). A
/// turning point is an indentation at which the loading ends and the unloading to separation
/// begins. The forces are known at equally spaced indentations, the grid points.
#[derive(Clone, Debug, PartialEq)]
pub struct ReversalMap {
    /// Equally spaced indentations in m, in ascending order, at which forces are known (grid
    /// points). The first `below` of them are below all turning points. Each of the others is also
    /// a turning point, at which a loading ends.
    pub points: Vec<f64>,
    /// Number of grid points, the indentations in `points`, that are below the first turning point.
    pub below: usize,
    /// An unloading for each turning point. The forces of an unloading are known at all
    /// indentations in `points` up to its turning point.
    pub reversals: Vec<Reversal>,
}

impl ReversalMap {
    /// Allowed numbers of turning points, the indentations at which a loading ends.
    pub const TURNING_POINTS: RangeInclusive<usize> = 8..=512;

    /// Returns the turning points: the indentations in m at which a loading ends.
    pub fn turns(&self) -> &[f64] {
        &self.points[self.below..]
    }

    /// Returns the distance in m between neighbouring grid points, the indentations in `points`.
    pub fn step(&self) -> f64 {
        let intervals = self.points.len().saturating_sub(1).max(1);
        (self.points[self.points.len() - 1] - self.points[0]) / intervals as f64
    }

    /// Returns the force in N on the unloading from the turning point with the index `turn`, at the
    /// indentation with the index `point` in `points`. Returns `None` if this indentation is above
    /// the turning point.
    pub fn force(&self, turn: usize, point: usize) -> Option<f64> {
        self.reversals.get(turn)?.forces.get(point).copied()
    }

    /// Returns the Everett function E(d_r, d) = ½ (F(d_r) − F(d_r, d)) in N. F(d_r) is the force at
    /// the turning point d_r, which has the index `turn`. F(d_r, d) is the force on the unloading
    /// from d_r at the indentation d, which has the index `point` in `points`. Returns `None` if d
    /// is above d_r.
    pub fn everett(&self, turn: usize, point: usize) -> Option<f64> {
        let reversal = self.reversals.get(turn)?;
        Some(0.5 * (reversal.turn.force - self.force(turn, point)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_contact::CurvePoint;

    /// Creates a map whose forces are given by a function of the turning point and the indentation.
    fn map(force: impl Fn(f64, f64) -> f64) -> ReversalMap {
        let points: Vec<f64> = (0..20).map(|index| 0.25 * f64::from(index) - 2.0).collect();
        let below = 8;
        let reversal = |turn: usize| {
            let at = points[below + turn];
            let forces = points[..=below + turn]
                .iter()
                .map(|&point| force(at, point))
                .collect();
            let turn = CurvePoint {
                indentation: at,
                force: force(at, at),
                ..CurvePoint::default()
            };
            Reversal {
                turn,
                smallest: turn,
                separation: -0.5,
                dissipated_energy: 1.0,
                reaches_ends: false,
                forces,
            }
        };
        ReversalMap {
            reversals: (0..12).map(reversal).collect(),
            points,
            below,
        }
    }

    #[test]
    fn the_everett_function_is_half_of_the_fall() {
        let map = map(|r, d| 10.0 * r + d);
        assert_eq!(map.everett(0, 8), Some(0.0));
        assert_eq!(map.everett(1, 8), Some(0.125));
        assert_eq!((map.everett(0, 9), map.step()), (None, 0.25));
    }
}
