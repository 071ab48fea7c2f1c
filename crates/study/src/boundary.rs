//! The boundary where adhesion without a preload vanishes, eq. (15), with its statistical error.
//!
//! F_a(d=0), the pull-off force after the first touch, falls about exponentially with κ. It hardly
//! ever becomes zero, because a single spring still adheres. The boundary κ* is therefore defined
//! as the value of κ at which the mean of F_a(d=0) over the profiles falls below a given share of
//! the ideal pull-off force F_a,max. On profiles of one spectrum κ determines e_el/γ, so each
//! boundary in κ is also a boundary in e_el/γ.

use super::axis::Axis;
use super::error::StudyError;
use super::place::governing;
use super::plan::Plan;
use super::quantity::Quantity;
use super::results::Results;
use asperity_data::quantile;
use asperity_scene::RoughnessParameter;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::cmp::Ordering;
use std::path::Path;

/// Number of random selections of profiles from which the confidence interval follows (bootstrap).
const RESAMPLES: usize = 1000;
/// Seed of the random selections. It is constant, so that every run gives the same table.
const RESAMPLING_SEED: u64 = 2012;

/// Value of the roughness parameter κ, or of the ratio e_el/γ of elastic energy to work of
/// adhesion, at which adhesion without a preload vanishes in a study. Adhesion counts as vanished
/// if the pull-off force, as a mean over the random profiles, is below a given share of the ideal
/// pull-off force F_a,max. The value depends on this share, on the values on the other axes of the
/// study, and on the point at which the loading turns ([`AdhesionBoundary::protocol`]).
#[derive(Clone, Debug, PartialEq)]
pub struct AdhesionBoundary {
    /// Values on the axes of the study, one for each axis in [`Boundaries::others`]. The axis of
    /// the roughness parameter, along which the boundary is sought, is left out.
    pub others: Vec<f64>,
    /// Quantity whose mean over the profiles decides whether adhesion has vanished: the pull-off
    /// force divided by the ideal pull-off force F_a,max. It is F_a(d=0)/F_a,max if the loading
    /// turns at first touch, and F_a(F=0)/F_a,max if it turns at zero force.
    pub protocol: Quantity,
    /// Share of the ideal pull-off force F_a,max below which adhesion counts as vanished.
    pub level: f64,
    /// Value of the roughness parameter, κ or e_el/γ, at which adhesion vanishes, with its
    /// confidence interval.
    pub crossing: Crossing,
}

/// Value of the roughness parameter κ, or of the ratio e_el/γ of elastic energy to work of
/// adhesion, at which adhesion vanishes. For all larger values, the pull-off force, as a mean over
/// the random profiles, is below the share [`AdhesionBoundary::level`] of the ideal pull-off force
/// F_a,max.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Value of the roughness parameter, κ or e_el/γ, at the boundary. If the boundary lies beyond
    /// the studied range, it is the nearer end of this range.
    pub value: f64,
    /// Position of the boundary: `Equal` within the studied range, `Less` below this range,
    /// `Greater` above this range.
    pub side: Ordering,
    /// Ends of the 95 % confidence interval of [`Crossing::value`]. `None` if there are fewer than
    /// two profiles, or if the scatter of the profiles is so large that the boundary may lie beyond
    /// the studied range.
    pub interval: Option<(f64, f64)>,
}

impl Crossing {
    /// Returns the crossing with all its values converted to another parameter.
    fn converted(self, convert: &dyn Fn(f64) -> f64) -> Crossing {
        Crossing {
            value: convert(self.value),
            side: self.side,
            interval: self
                .interval
                .map(|(low, high)| (convert(low), convert(high))),
        }
    }

    /// Returns the value of the roughness parameter, κ or e_el/γ, at the boundary, with its 95 %
    /// confidence interval. The interval is `None` if it is unknown. Returns `None` if the boundary
    /// lies beyond the studied range.
    pub fn known(self) -> Option<(f64, Option<(f64, f64)>)> {
        self.side.is_eq().then_some((self.value, self.interval))
    }
}

/// All values of the roughness parameter κ, or of the ratio e_el/γ of elastic energy to work of
/// adhesion, at which adhesion without a preload vanishes in a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundaries {
    /// Parameter in which the boundaries are given: the roughness parameter κ, or the ratio e_el/γ
    /// of elastic energy to work of adhesion.
    pub over: RoughnessParameter,
    /// Axes of the study without the axis of the roughness parameter, along which the boundaries
    /// are sought.
    pub others: Vec<Axis>,
    /// Number of random profiles that were computed for each combination of values on the axes.
    pub lines: u64,
    /// Boundaries that were found. There is at most one for each combination of three choices:
    /// values on the axes [`Boundaries::others`], turning point of the loading, and share of the
    /// ideal pull-off force F_a,max.
    pub found: Vec<AdhesionBoundary>,
}

/// Shares of F_a,max as a function of κ or e_el/γ: for each ascending value, F_a(d=0)/F_a,max or
/// F_a(F=0)/F_a,max on each profile. The profiles are the same for all values.
type Curve = Vec<(f64, Vec<f64>)>;

/// Returns the shares of F_a,max in the cells along the axis with index `along`. `first` is the
/// cell at the first value of this axis. Cells without a share on any profile are left out, and so
/// are profiles without a share in one of the other cells.
fn curve(study: &Results, first: u64, along: usize, protocol: Quantity) -> Curve {
    let plan = study.plan();
    let step: u64 = plan.axes[along + 1..].iter().map(Axis::count).product();
    let mut rows: Vec<(f64, Vec<Option<f64>>)> = Vec::new();
    for (place, &value) in (0..).zip(&plan.axes[along].values) {
        let cell = first + place * step;
        let lines = 0..plan.lines;
        let shares: Vec<_> = lines
            .map(|line| study.value(cell, line, protocol))
            .collect();
        if shares.iter().any(Option::is_some) {
            rows.push((value, shares));
        }
    }
    let mut curve: Curve = rows.iter().map(|(value, _)| (*value, Vec::new())).collect();
    for line in 0..plan.lines as usize {
        if rows.iter().any(|(_, shares)| shares[line].is_none()) {
            continue;
        }
        for ((_, common), (_, shares)) in curve.iter_mut().zip(&rows) {
            common.extend(shares[line]);
        }
    }
    curve.sort_by(|first, second| first.0.total_cmp(&second.0));
    curve
}

/// Returns the index of the first axis whose quantity is κ or e_el/γ, and this quantity.
fn parameter_axis(plan: &Plan) -> Option<(usize, RoughnessParameter)> {
    for (index, axis) in plan.axes.iter().enumerate() {
        if let Some(parameter) = axis.target.parameter() {
            return Some((index, parameter));
        }
    }
    None
}

/// Returns a function that converts κ to e_el/γ in a cell, or e_el/γ to κ; `None` if the scene does
/// not determine the other parameter.
fn conversion(
    plan: &Plan,
    cell: u64,
    from: RoughnessParameter,
    to: RoughnessParameter,
) -> Option<Box<dyn Fn(f64) -> f64>> {
    if from == to {
        return Some(Box::new(|value| value));
    }
    // The scene of the cell is valid, because the plan has been checked with these values.
    let known = governing(&*plan.scene_of(cell).ok()?)?;
    let energies = known.energy(to)? / known.energy(from)?;
    Some(Box::new(move |value| {
        to.of_energy_over_work(energies * from.energy_over_work(value))
    }))
}

impl AdhesionBoundary {
    /// Returns the name of the point at which the loading turns, `first touch` or `zero force`. The
    /// boundary refers to the adhesion in the unloading from this point.
    pub fn protocol_name(&self) -> &'static str {
        if self.protocol == Quantity::FirstTouchAdhesionShare {
            "first touch"
        } else {
            "zero force"
        }
    }
}

impl Boundaries {
    /// Shares of the ideal pull-off force F_a,max below which adhesion usually counts as vanished,
    /// for the argument `levels` of [`Boundaries::of`].
    pub const USUAL_LEVELS: [f64; 4] = [0.5, 0.1, 0.05, 0.01];

    /// Finds the values of a roughness parameter at which adhesion without a preload vanishes. A
    /// roughness parameter is κ, or the ratio e_el/γ of elastic energy to work of adhesion. `path`
    /// is the folder of a study with an axis of κ or e_el/γ, for which [`merge`](crate::merge) has
    /// written the tables. `over` is the parameter in which the boundaries are returned. `levels`
    /// are the shares of the ideal pull-off force F_a,max below which adhesion counts as vanished.
    ///
    /// # Errors
    /// Returns an error if the study has no axis of κ or e_el/γ, or if it recorded neither
    /// F_a(d=0)/F_a,max nor F_a(F=0)/F_a,max. For a measured surface it is also an error if `over`
    /// is not the parameter of the axis. The errors of [`Results::open`] are possible too.
    pub fn of(
        path: &Path,
        over: RoughnessParameter,
        levels: &[f64],
    ) -> Result<Boundaries, StudyError> {
        let study = Results::open(path)?;
        let plan = study.plan();
        let Some((along, given)) = parameter_axis(plan) else {
            let reason = "this study has no axis adhesion.kappa or adhesion.elastic_energy_ratio, along which a boundary lies";
            return Err(StudyError::folder(path, reason));
        };
        let mut protocols = Quantity::ADHESION_SHARES.to_vec();
        protocols.retain(|share| plan.record.contains(share));
        if protocols.is_empty() {
            let reason = "this study records neither first_touch_adhesion_share nor zero_force_adhesion_share";
            return Err(StudyError::folder(path, reason));
        }
        let others: Vec<usize> = (0..plan.axes.len()).filter(|axis| *axis != along).collect();
        let mut found = Vec::new();
        for number in 0..plan.cells() / plan.axes[along].count() {
            let cell = plan.cell_at(&plan.places_on(others.iter().copied(), number));
            for &protocol in &protocols {
                let curve = curve(&study, cell, along, protocol);
                if curve.is_empty() {
                    continue;
                }
                let Some(convert) = conversion(plan, cell, given, over) else {
                    let reason = format!(
                        "this study has no axis {}, which does not follow from its measured surface",
                        over.path()
                    );
                    return Err(StudyError::folder(path, reason));
                };
                for &level in levels {
                    found.push(AdhesionBoundary {
                        others: others.iter().map(|&axis| plan.value(cell, axis)).collect(),
                        protocol,
                        level,
                        crossing: crossing(&curve, level).converted(&*convert),
                    });
                }
            }
        }
        let others = others
            .into_iter()
            .map(|axis| plan.axes[axis].clone())
            .collect();
        Ok(Boundaries {
            over,
            others,
            lines: plan.lines,
            found,
        })
    }

    /// Returns the symbol of the value of the roughness parameter at a boundary: `κ*` or
    /// `(e_el/γ)*`.
    pub fn symbol(&self) -> &'static str {
        match self.over {
            RoughnessParameter::Kappa => "κ*",
            RoughnessParameter::ElasticEnergyRatio => "(e_el/γ)*",
        }
    }
}

fn crossing(curve: &Curve, level: f64) -> Crossing {
    let count = curve.first().map_or(0, |(_, shares)| shares.len());
    let every: Vec<usize> = (0..count).collect();
    let (value, side) = crossing_of(curve, &every, level);
    let mut interval = None;
    if side.is_eq() && count >= 2 {
        interval = resampled_interval(curve, count, level);
    }
    Crossing {
        value,
        side,
        interval,
    }
}

/// Returns the 95 % confidence interval of the crossing, found by random selections of the
/// profiles; `None` if the interval extends beyond the studied range.
fn resampled_interval(curve: &Curve, count: usize, level: f64) -> Option<(f64, f64)> {
    let mut random = ChaCha8Rng::seed_from_u64(RESAMPLING_SEED);
    let mut values = Vec::new();
    for _ in 0..RESAMPLES {
        let profiles = 0..count;
        let chosen: Vec<usize> = profiles.map(|_| random.random_range(0..count)).collect();
        let (value, side) = crossing_of(curve, &chosen, level);
        if side.is_ne() {
            return None;
        }
        values.push(value);
    }
    values.sort_by(f64::total_cmp);
    quantile(&values, 0.025).zip(quantile(&values, 0.975))
}

/// Returns the κ or e_el/γ above which the mean over the chosen profiles stays below a share. The
/// logarithm of the mean is interpolated linearly between two values of the parameter. If the
/// crossing lies beyond an end of the curve, this end is returned.
fn crossing_of(curve: &Curve, chosen: &[usize], level: f64) -> (f64, Ordering) {
    // Only the means from the last one to the crossing are needed.
    let mut after = None;
    for (kappa, shares) in curve.iter().rev() {
        let point = MeanShare {
            kappa: *kappa,
            mean: mean_of_chosen(shares, chosen),
        };
        if point.mean >= level {
            return match after {
                Some(next) => (point.crossing_before(&next, level), Ordering::Equal),
                None => (point.kappa, Ordering::Greater),
            };
        }
        after = Some(point);
    }
    (after.map_or(f64::NAN, |first| first.kappa), Ordering::Less)
}

/// Mean of F_a(d=0)/F_a,max or F_a(F=0)/F_a,max over profiles, at a value of κ or e_el/γ.
struct MeanShare {
    kappa: f64,
    mean: f64,
}

impl MeanShare {
    /// Returns the κ or e_el/γ at which the mean falls to `level`, between this value and the next
    /// one, whose mean is below `level`.
    fn crossing_before(&self, next: &MeanShare, level: f64) -> f64 {
        // A mean of zero has no logarithm, so the mean itself is interpolated.
        let share = if next.mean > 0.0 {
            (self.mean / level).ln() / (self.mean / next.mean).ln()
        } else {
            (self.mean - level) / self.mean
        };
        self.kappa + share * (next.kappa - self.kappa)
    }
}

/// Returns the mean of the shares of the chosen profiles.
fn mean_of_chosen(shares: &[f64], chosen: &[usize]) -> f64 {
    let mut sum = 0.0;
    for &line in chosen {
        sum += shares[line];
    }
    sum / chosen.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns, for each of 40 values of κ, the shares exp(−rate κ) of profiles with these rates.
    fn falling(rates: &[f64]) -> Vec<(f64, Vec<f64>)> {
        let kappas = (0..40).map(|k| 0.25 * f64::from(k));
        kappas
            .map(|kappa| {
                (
                    kappa,
                    rates.iter().map(|rate| (-kappa * rate).exp()).collect(),
                )
            })
            .collect()
    }

    #[test]
    fn an_exponential_is_crossed_where_it_falls_so_far() {
        for level in [0.5, 0.1, 0.01] {
            let (kappa, side) = crossing_of(&falling(&[1.0]), &[0], level);
            assert!(
                (kappa + level.ln()).abs() < 1e-12 && side.is_eq(),
                "{level}: {kappa}"
            );
        }
        assert_eq!(
            crossing_of(&falling(&[0.01]), &[0], 0.5),
            (9.75, Ordering::Greater)
        );
        assert_eq!(
            crossing_of(&falling(&[1.0]), &[0], 2.0),
            (0.0, Ordering::Less)
        );
        let to_zero = vec![(1.0, vec![0.4]), (2.0, vec![0.0])];
        assert_eq!(crossing_of(&to_zero, &[0], 0.1), (1.75, Ordering::Equal));
    }

    #[test]
    fn intervals_contain_the_mean_and_narrow_with_more_profiles() {
        let width = |lines: usize| {
            let rates: Vec<f64> = (0..lines)
                .map(|line| 0.8 + 0.4 * (line % 4) as f64 / 3.0)
                .collect();
            let curve = falling(&rates);
            let (kappa, interval) = crossing(&curve, 0.1).known().unwrap();
            let (low, high) = interval.unwrap();
            assert!(low < kappa && kappa < high, "{low} {kappa} {high}");
            high - low
        };
        let (few, many) = (width(8), width(128));
        assert!(many < 0.4 * few && many > 0.15 * few, "{few} {many}");
    }
}
