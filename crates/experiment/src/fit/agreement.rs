//! Agreement between a model and a measured curve at the points in contact.

use crate::curve::MeasuredCurve;
use crate::curve::numerics::dot;
use crate::fit::population::WRONG_SIDE;
use asperity_data::format_rounded;
use serde::{Serialize, Serializer};
use std::fmt;

/// Largest robust root mean square of the residuals in contact, in units of the noise, up to which
/// a model describes the curve within its noise.
pub(crate) const MISFIT: f64 = 1.5;
/// Share of the largest force above which a residual is counted in
/// [`Agreement::beyond_one_percent`].
const NOTABLE: f64 = 0.01;
/// Largest root mean square of the residuals, as a share of the largest force, up to which a model
/// describes a curve well.
const WELL: f64 = 0.01;
/// Largest root mean square of the residuals, as a share of the largest force, up to which a model
/// describes a curve roughly.
const ROUGHLY: f64 = 0.03;
/// Largest share of the points in contact that may lie at jumps; two points may lie there in any
/// case. If there are more, they are treated like all other points.
const MOST_AT_JUMPS: f64 = 0.1;

/// Agreement of a model with a measured curve. All points count that are in contact in the
/// measurement or in the model. Points at jumps are counted separately: at such a point the
/// measured force has already jumped and the force of the model has not, or the reverse.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Agreement {
    /// Number of points in contact.
    pub points: usize,
    /// Root mean square in N of the residuals of the points in contact, without points at jumps. A
    /// residual is the measured force minus the force of the model.
    pub residual: f64,
    /// [`Self::residual`] divided by the largest magnitude of the force of the curve.
    pub residual_over_largest_force: f64,
    /// Share of the points in contact, from 0 to 1, whose residual exceeds 1 % of the largest
    /// force. Points at jumps are left out.
    pub beyond_one_percent: f64,
    /// Share of the points in contact, from 0 to 1, that lie at jumps.
    pub at_jumps: f64,
    /// Largest distance in m by which a point at a jump is away from the jump of the model; `None`
    /// if there are no points at jumps.
    pub off_at_jumps: Option<f64>,
}

/// Grade that states how well a model describes a measured curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Grade {
    /// The model describes the curve within the noise of the force.
    WithinNoise,
    /// The root mean square of the residuals is at most 1 % of the largest force.
    Well,
    /// The root mean square of the residuals is at most 3 % of the largest force.
    Roughly,
    /// The root mean square of the residuals is above 3 % of the largest force.
    No,
}

impl fmt::Display for Grade {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Grade::WithinNoise => "within the noise",
            Grade::Well => "within 1 % of the largest force",
            Grade::Roughly => "within 3 % of the largest force",
            Grade::No => "no",
        })
    }
}

impl Serialize for Grade {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Residuals of a curve, with the information which points are in contact and which points are at
/// jumps.
pub(crate) struct Compared<'a> {
    pub curve: &'a MeasuredCurve,
    /// Residuals of all points in units of the noise.
    pub residuals: &'a [f64],
    pub in_contact: &'a [bool],
    /// Distance in m from the jump, for each point at a jump; `None` for other points.
    pub distances_from_jumps: &'a [Option<f64>],
}

/// Agreement of a model with a curve, and further results for the same points in units of the
/// noise.
pub(crate) struct Comparison {
    pub agreement: Agreement,
    pub residual_over_noise: f64,
    pub beyond_five_sigma: f64,
}

impl Compared<'_> {
    /// Computes the agreement at the points in contact. Points at jumps count separately, unless
    /// there are too many of them.
    pub fn comparison(&self) -> Comparison {
        let points = self.in_contact.iter().filter(|touches| **touches).count();
        let mut at_jumps = 0;
        let mut off_at_jumps: Option<f64> = None;
        let mut others = Vec::with_capacity(points);
        let mut all = Vec::with_capacity(points);
        for (index, residual) in self.residuals.iter().enumerate() {
            if !self.in_contact[index] {
                continue;
            }
            all.push(*residual);
            match self.distances_from_jumps[index] {
                Some(distance) => {
                    at_jumps += 1;
                    off_at_jumps = Some(off_at_jumps.map_or(distance, |far| far.max(distance)));
                }
                None => others.push(*residual),
            }
        }
        if at_jumps as f64 > (MOST_AT_JUMPS * points as f64).max(2.0) {
            others = all;
            at_jumps = 0;
            off_at_jumps = None;
        }
        let count = others.len().max(1) as f64;
        let root_mean_square = (dot(&others, &others) / count).sqrt();
        let forces = self.curve.force.iter();
        let largest = forces
            .map(|force| force.abs())
            .fold(self.curve.noise, f64::max);
        let limit = NOTABLE * largest / self.curve.noise;
        let share_beyond = |limit: f64| {
            let beyond = others.iter().filter(|residual| residual.abs() > limit);
            beyond.count() as f64 / count
        };
        let residual = self.curve.noise * root_mean_square;
        Comparison {
            agreement: Agreement {
                points,
                residual,
                residual_over_largest_force: residual / largest,
                beyond_one_percent: share_beyond(limit),
                at_jumps: at_jumps as f64 / points.max(1) as f64,
                off_at_jumps,
            },
            residual_over_noise: root_mean_square,
            beyond_five_sigma: share_beyond(WRONG_SIDE),
        }
    }
}

impl Agreement {
    /// Returns the grade of a model that has the robust residual
    /// [`misfit`](crate::FitResult::misfit). `has_reason` is true if another reason was found why
    /// the model does not describe the curve.
    pub(crate) fn grade(&self, misfit: f64, has_reason: bool) -> Grade {
        if misfit <= MISFIT && !has_reason {
            Grade::WithinNoise
        } else if self.residual_over_largest_force <= WELL {
            Grade::Well
        } else if self.residual_over_largest_force <= ROUGHLY {
            Grade::Roughly
        } else {
            Grade::No
        }
    }
}

impl fmt::Display for Agreement {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |share: f64| format_rounded(100.0 * share, 2, "1");
        let residual = percent(self.residual_over_largest_force);
        write!(out, "within {residual} % of the largest force")?;
        if let Some(distance) = self.off_at_jumps {
            let share = percent(self.at_jumps);
            let distance = format_rounded(distance, 2, "m");
            write!(
                out,
                "; {share} % of the points in contact, at the jumps, are up to {distance} off"
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{read, rubber};
    use crate::read::options::Drift;

    /// Ten points are in contact. One of them lies at a jump, and another one deviates by 2 % of
    /// the largest force.
    #[test]
    fn points_at_jumps_count_apart() {
        let mut curve = read(rubber(1e-9, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        let largest = curve
            .force
            .iter()
            .fold(0.0, |most: f64, force| most.max(force.abs()));
        curve.noise = 1e-3 * largest;
        let count = curve.force.len();
        let mut residuals = vec![500.0; count];
        let mut in_contact = vec![false; count];
        let mut distances = vec![None; count];
        for index in 50..60 {
            residuals[index] = 1.0;
            in_contact[index] = true;
        }
        residuals[53] = 20.0;
        residuals[55] = 900.0;
        distances[55] = Some(3e-9);
        let compared = |distances: &[Option<f64>]| {
            Compared {
                curve: &curve,
                residuals: &residuals,
                in_contact: &in_contact,
                distances_from_jumps: distances,
            }
            .comparison()
        };
        let found = compared(&distances);
        let expected = (408.0_f64 / 9.0).sqrt();
        assert!((found.residual_over_noise - expected).abs() < 1e-9);
        let agreement = found.agreement;
        assert_eq!((agreement.points, agreement.at_jumps), (10, 0.1));
        assert!((agreement.beyond_one_percent - 1.0 / 9.0).abs() < 1e-12);
        assert_eq!(agreement.off_at_jumps, Some(3e-9));
        let text = agreement.to_string();
        assert!(
            text.starts_with("within 0.67 % of the largest force; 10 %"),
            "{text}"
        );
        assert_eq!(agreement.grade(20.0, true), Grade::Well);
        assert_eq!(agreement.grade(1.0, false), Grade::WithinNoise);
        // If many points lie at jumps, they are treated like all other points.
        for distance in &mut distances[50..54] {
            *distance = Some(1e-9);
        }
        let agreement = compared(&distances).agreement;
        assert_eq!((agreement.at_jumps, agreement.off_at_jumps), (0.0, None));
        assert!(agreement.residual_over_largest_force > 0.2);
        assert_eq!(agreement.grade(20.0, true), Grade::No);
    }
}
