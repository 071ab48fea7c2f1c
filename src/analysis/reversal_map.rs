//! Maps of first-order reversal curves: Everett function, density, and congruency of minor loops.

use crate::contact::Reversal;
use serde::Serialize;

/// Largest difference of the dissipated energies of congruent minor loops, over the larger energy.
pub const CONGRUENT_SHARE: f64 = 1e-9;
/// Share of the energy of the whole loop below which a minor loop counts as free of dissipation.
const LEAST_LOSS: f64 = 1e-12;

/// First-order reversal curves on a uniform grid of indentations.
#[derive(Clone, Debug, PartialEq)]
pub struct ReversalMap {
    /// Equally spaced indentations, m; the last ones are the turning points.
    pub points: Vec<f64>,
    /// Number of points below the first turning point.
    pub below: usize,
    /// The reversal from each turning point, with its forces at the points up to the turning point.
    pub reversals: Vec<Reversal>,
}

impl ReversalMap {
    /// Indentations of the turning points, m.
    pub fn turns(&self) -> &[f64] {
        &self.points[self.below..]
    }

    /// Distance between points, m.
    pub fn step(&self) -> f64 {
        let intervals = self.points.len().saturating_sub(1).max(1);
        (self.points[self.points.len() - 1] - self.points[0]) / intervals as f64
    }

    /// Force on the reversal from a turning point at a point, both by number, N; `None` above the turning point.
    pub fn force(&self, turn: usize, point: usize) -> Option<f64> {
        self.reversals.get(turn)?.forces.get(point).copied()
    }

    /// Everett function E(d_r, d) = ½ (F(d_r) − F(d_r, d)), N: half of the fall of the force from the turning point.
    pub fn everett(&self, turn: usize, point: usize) -> Option<f64> {
        let reversal = self.reversals.get(turn)?;
        Some(0.5 * (reversal.turn.force - self.force(turn, point)?))
    }

    /// Density ρ(d_r, d) = −½ ∂²F/∂d_r∂d, N/m²: that of the quadratic of least squares through the forces at the
    /// (2n + 1)² points at most n = `smoothing` steps away in either direction; `None` if one of these is missing.
    ///
    /// On a uniform grid the products of the two distances are orthogonal to all other terms of the quadratic, so
    /// that the mixed derivative is Σ u v F / Σ u² v².
    pub fn density(&self, turn: usize, point: usize, smoothing: usize) -> Option<f64> {
        let reach = smoothing as i64;
        let mut products = 0.0;
        for u in -reach..=reach {
            for v in -reach..=reach {
                let index = |at: usize, by: i64| usize::try_from(at as i64 + by).ok();
                products += (u * v) as f64 * self.force(index(turn, u)?, index(point, v)?)?;
            }
        }
        let squares = (-reach..=reach).map(|u| (u * u) as f64).sum::<f64>();
        let step = self.step();
        Some(-0.5 * products / (squares * squares * step * step))
    }
}

/// Minor loops between the same indentations, started in two ways.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct MinorLoops {
    /// Number of loops that dissipate energy in at least one of the ways.
    pub with_loss: usize,
    /// Number of loops with different dissipated energies.
    pub incongruent: usize,
}

impl MinorLoops {
    /// Counts pairs of dissipated energies, J, of minor loops inside one with the dissipated energy `whole`, J.
    pub fn new(losses: &[[f64; 2]], whole: f64) -> MinorLoops {
        let larger = |[one, other]: &[f64; 2]| one.max(*other);
        let with_loss = losses.iter().filter(|pair| larger(pair) > LEAST_LOSS * whole);
        let differs = |pair: &&[f64; 2]| (pair[0] - pair[1]).abs() > CONGRUENT_SHARE * larger(pair);
        MinorLoops { with_loss: with_loss.clone().count(), incongruent: with_loss.filter(differs).count() }
    }

    /// Share of incongruent loops among those that dissipate energy.
    pub fn incongruent_share(&self) -> Option<f64> {
        (self.with_loss > 0).then(|| self.incongruent as f64 / self.with_loss as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::CurvePoint;

    /// A map from a force as a function of the turning point and the indentation.
    fn map(force: impl Fn(f64, f64) -> f64) -> ReversalMap {
        let points: Vec<f64> = (0..20).map(|index| 0.25 * f64::from(index) - 2.0).collect();
        let below = 8;
        let reversal = |turn: usize| {
            let at = points[below + turn];
            let forces = points[..=below + turn].iter().map(|&point| force(at, point)).collect();
            let turn = CurvePoint { indentation: at, force: force(at, at), ..CurvePoint::default() };
            Reversal { turn, smallest: turn, separation: -0.5, dissipated_energy: 1.0, forces }
        };
        ReversalMap { reversals: (0..12).map(reversal).collect(), points, below }
    }

    #[test]
    fn quadratics_have_their_own_density() {
        let map = map(|r, d| 3.0 - 2.0 * r + d + 5.0 * r * r - 0.5 * d * d + 7.0 * r * d);
        for smoothing in 1..=3 {
            let density = map.density(6, 5, smoothing).unwrap();
            assert!((density + 3.5).abs() < 1e-12, "{density}");
        }
        assert_eq!(map.density(0, 5, 1), None);
        // The point beyond would lie above the shallowest of the turning points.
        assert_eq!((map.density(4, 11, 1), map.density(4, 10, 1).is_some()), (None, true));
        assert_eq!(map.step(), 0.25);
    }

    #[test]
    fn the_everett_function_is_half_of_the_fall() {
        let map = map(|r, d| 10.0 * r + d);
        assert_eq!(map.everett(0, 8), Some(0.0));
        assert_eq!(map.everett(1, 8), Some(0.125));
        assert_eq!(map.everett(0, 9), None);
    }

    #[test]
    fn loops_that_differ_are_incongruent() {
        let loops =
            MinorLoops::new(&[[1.0, 1.0], [1.0, 1.0 + 1e-12], [1.0, 2.0], [0.0, 1.0], [0.0, 0.0]], 10.0);
        assert_eq!(loops, MinorLoops { with_loss: 4, incongruent: 2 });
        assert_eq!(loops.incongruent_share(), Some(0.5));
        assert_eq!(MinorLoops::default().incongruent_share(), None);
    }
}
