//! Boundary of vanishing zero-load adhesion: the boundary between pressure-insensitive and pressure-sensitive
//! adhesion, eq. (15), with its statistical error.
//!
//! F_a(0) falls with κ about exponentially and never quite to zero, since a single spring still adheres. So the
//! boundary κ* is where the mean of F_a(0) over the profiles falls below a share of the ideal adhesion force
//! F_a,max; κ* depends on that share, and several shares are evaluated at a time. A boundary in κ is also one in
//! e_el/γ: on profiles of one spectrum either determines the other.

use super::axis::Axis;
use super::finished::Finished;
use super::plan::{Plan, targets};
use super::quantity::Quantity;
use super::target::{Target, governing};
use super::{StudyError, symbol_and_unit};
use crate::analysis::Governing;
use crate::scene::RoughnessParameter;
use rand::RngExt;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;
use std::path::Path;

/// Usual shares of F_a,max.
pub const USUAL_LEVELS: [f64; 4] = [0.5, 0.1, 0.05, 0.01];
/// Random choices of profiles for the confidence interval.
const RESAMPLES: usize = 1000;
/// Seed of these choices: the same table in each run.
const RESAMPLING_SEED: u64 = 2012;

/// The boundary at one place on the other axes, by one protocol, for one share.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// Values on the axes other than κ or e_el/γ, in their order.
    pub others: Vec<f64>,
    /// The recorded share, which identifies the protocol.
    pub protocol: Quantity,
    /// The share of F_a,max below which adhesion counts as vanished.
    pub level: f64,
    /// The boundary and its 95 % confidence interval by resampling of profiles.
    pub crossing: Crossing,
}

/// κ or e_el/γ at which a mean falls below a share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crossing {
    /// At this value, with the confidence interval where profiles could be resampled and all samples cross.
    At(f64, Option<(f64, f64)>),
    /// Below the smallest value of the study.
    Below(f64),
    /// Above the largest value of the study.
    Above(f64),
}

impl Crossing {
    /// The same boundary in terms of a parameter that grows with this one.
    fn map(self, to: impl Fn(f64) -> f64) -> Self {
        match self {
            Crossing::At(value, interval) => {
                Crossing::At(to(value), interval.map(|(low, high)| (to(low), to(high))))
            }
            Crossing::Below(value) => Crossing::Below(to(value)),
            Crossing::Above(value) => Crossing::Above(to(value)),
        }
    }
}

/// The boundaries of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundaries {
    /// Parameter of the boundaries.
    pub over: RoughnessParameter,
    /// Names of the axes other than κ or e_el/γ, with symbols.
    pub others: Vec<String>,
    /// Random profiles of each cell.
    pub lines: u64,
    /// Boundaries in the order of the cells, then of protocols, then of levels.
    pub found: Vec<Boundary>,
}

/// Factors of κ under other definitions of its constituents: name and factor.
pub const DEFINITIONS: [(&str, f64); 3] = [
    ("kappa", 1.0),
    // Wave numbers in 1/m: ⟨∇z⟩ is 2π times smaller, κ by its root, 1/√(2π).
    ("kappa_cycles", 0.398_942_280_401_432_7),
    // Amplitudes in place of root mean squares: h and ⟨∇z⟩ are √2 times larger.
    ("kappa_amplitude", std::f64::consts::SQRT_2),
];

/// Finds the boundaries of a merged study along its axis `kappa` or `elastic_energy_ratio`, in terms of either.
///
/// # Errors
/// A study without such an axis or without a recorded share of F_a(0), or as [`Finished::open`]; for a study of a measured
/// surface along the other axis.
pub fn boundaries(path: &Path, over: RoughnessParameter, levels: &[f64]) -> Result<Boundaries, StudyError> {
    let finished = Finished::open(path)?;
    let plan = finished.plan();
    let refuse = |reason: &str| StudyError::folder(path, reason);
    let axes = || plan.all_axes().into_iter();
    let is_along = |(place, axis): (usize, &Axis)| match Target::of(axis.path()) {
        Ok(Target::RoughnessParameter(parameter)) => Some((place, parameter)),
        _ => None,
    };
    let (along, given) = axes().enumerate().find_map(is_along).ok_or_else(|| {
        refuse("this study has no axis `kappa` or `elastic_energy_ratio`, along which a boundary lies")
    })?;
    let protocols: Vec<(usize, Quantity)> = Quantity::ADHESION_SHARES
        .into_iter()
        .filter_map(|protocol| Some((plan.record.iter().position(|one| *one == protocol)?, protocol)))
        .collect();
    if protocols.is_empty() {
        return Err(refuse(
            "this study records neither zero_load_adhesion_share nor zero_force_adhesion_share",
        ));
    }
    let mut sections = Sections::default();
    Finished::rows(path, |row| {
        for (place, &(column, _)) in protocols.iter().enumerate() {
            if let Some(value) = row.values[column] {
                sections.add(plan, along, place, (row.cell, row.seed), value);
            }
        }
    })?;
    let mut found = Vec::new();
    for ((cell, place), section) in sections.0 {
        let to = conversion(plan, cell, given, over).ok_or_else(|| {
            let name = over.name();
            refuse(&format!(
                "this study has no axis `{name}`, which does not follow from its measured surface"
            ))
        })?;
        for &level in levels {
            let (others, protocol) = (section.others.clone(), protocols[place].1);
            found.push(Boundary { others, protocol, level, crossing: section.crossing(level).map(&to) });
        }
    }
    let name = |axis: &Axis| {
        let (symbol, _) = symbol_and_unit(axis.path());
        if symbol.is_empty() { axis.path().to_string() } else { symbol.to_string() }
    };
    let others = axes().enumerate().filter(|(index, _)| *index != along).map(|(_, axis)| name(axis));
    Ok(Boundaries { over, others: others.collect(), lines: plan.lines, found })
}

/// Conversion of a parameter into another on the profiles of a cell.
fn conversion(
    plan: &Plan,
    cell: u64,
    from: RoughnessParameter,
    to: RoughnessParameter,
) -> Option<impl Fn(f64) -> f64 + use<>> {
    let mut scene = plan.prototype();
    // The plan has been checked with these values.
    Target::set_all(targets(plan).into_iter().zip(plan.values(cell)), &mut scene).ok()?;
    let ratio = |known: Governing| Some(known.energy(to)? / known.energy(from)?);
    let energies = if from == to { Some(1.0) } else { ratio(governing(&scene)?) }?;
    let convert = move |value| to.of_energy_over_work(energies * from.energy_over_work(value));
    Some(move |value| if from == to { value } else { convert(value) })
}

/// Spread of the boundaries of one protocol and share.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundarySpread {
    /// The recorded share, which identifies the protocol.
    pub protocol: Quantity,
    /// The share of F_a,max below which adhesion counts as vanished.
    pub level: f64,
    /// Smallest and largest boundary; `None` where the study holds none.
    pub range: Option<(f64, f64)>,
    /// For each other axis, the largest ratio of two boundaries that differ along this axis alone.
    pub along: Vec<f64>,
    /// Boundaries that lie outside the study.
    pub outside: usize,
}

/// Name of the protocol of a recorded share of F_a(0).
#[must_use]
pub fn protocol_name(share: Quantity) -> &'static str {
    if share == Quantity::ZeroLoadAdhesionShare { "touch" } else { "zero force" }
}

impl Boundaries {
    /// Symbol of the boundary.
    #[must_use]
    pub fn symbol(&self) -> &'static str {
        match self.over {
            RoughnessParameter::Kappa => "κ*",
            RoughnessParameter::ElasticEnergyRatio => "(e_el/γ)*",
        }
    }

    /// Spread of the boundaries of each protocol and share, in their order.
    #[must_use]
    pub fn spreads(&self) -> Vec<BoundarySpread> {
        let mut kinds: Vec<(Quantity, f64)> = Vec::new();
        for Boundary { protocol, level, .. } in &self.found {
            if !kinds.contains(&(*protocol, *level)) {
                kinds.push((*protocol, *level));
            }
        }
        kinds.sort_by_key(|(protocol, _)| *protocol as usize);
        kinds.into_iter().map(|(protocol, level)| self.spread(protocol, level)).collect()
    }

    fn spread(&self, protocol: Quantity, level: f64) -> BoundarySpread {
        let all = self.found.iter().filter(|one| (one.protocol, one.level) == (protocol, level));
        let count = all.clone().count();
        let found: Vec<(&[f64], f64)> = all
            .filter_map(|one| match one.crossing {
                Crossing::At(value, _) => Some((one.others.as_slice(), value)),
                _ => None,
            })
            .collect();
        let values = || found.iter().map(|(_, value)| *value);
        let range = values().reduce(f64::min).zip(values().reduce(f64::max));
        let differ = |axis: usize, a: &[f64], b: &[f64]| {
            a.iter().zip(b).enumerate().all(|(index, (a, b))| index == axis || a == b)
        };
        let along = (0..self.others.len()).map(|axis| {
            let pairs = found.iter().flat_map(|one| found.iter().map(move |other| (one, other)));
            pairs.filter(|(a, b)| differ(axis, a.0, b.0)).map(|(a, b)| a.1 / b.1).fold(1.0, f64::max)
        });
        BoundarySpread { protocol, level, range, along: along.collect(), outside: count - found.len() }
    }
}

/// F_a(0) over κ or e_el/γ, profile by profile, for each place on the other axes and each protocol.
#[derive(Default)]
struct Sections(BTreeMap<(u64, usize), Section>);

#[derive(Default)]
struct Section {
    others: Vec<f64>,
    /// For each κ the shares of the profiles, by their seeds.
    shares: BTreeMap<u64, (f64, BTreeMap<u64, f64>)>,
}

impl Sections {
    fn add(&mut self, plan: &Plan, along: usize, protocol: usize, (cell, seed): (u64, u64), share: f64) {
        let counts: Vec<u64> = plan.all_axes().into_iter().map(Axis::count).collect();
        let faster: u64 = counts[along + 1..].iter().product();
        let place = cell / faster % counts[along];
        // The cell of the same place with the smallest κ represents the section.
        let section = self.0.entry((cell - place * faster, protocol)).or_default();
        let values = plan.values(cell);
        if section.others.is_empty() {
            let others = values.iter().enumerate().filter(|(index, _)| *index != along);
            section.others = others.map(|(_, &value)| value).collect();
        }
        let (_, shares) = section.shares.entry(place).or_insert_with(|| (values[along], BTreeMap::new()));
        shares.insert(seed, share);
    }
}

impl Section {
    fn crossing(&self, level: f64) -> Crossing {
        // Profiles common to all cells; a seed is the same profile in each.
        let mut seeds: Vec<u64> =
            self.shares.values().next().map_or_else(Vec::new, |(_, shares)| shares.keys().copied().collect());
        seeds.retain(|seed| self.shares.values().all(|(_, shares)| shares.contains_key(seed)));
        let mut curve: Vec<(f64, Vec<f64>)> = self
            .shares
            .values()
            .map(|(kappa, shares)| (*kappa, seeds.iter().map(|seed| shares[seed]).collect()))
            .collect();
        curve.sort_by(|a, b| a.0.total_cmp(&b.0));
        let every: Vec<usize> = (0..seeds.len()).collect();
        let found = crossing_of(&curve, &every, level);
        let Crossing::At(kappa, _) = found else { return found };
        if seeds.len() < 2 {
            return found;
        }
        let mut random = ChaCha8Rng::seed_from_u64(RESAMPLING_SEED);
        let mut resampled = Vec::with_capacity(RESAMPLES);
        for _ in 0..RESAMPLES {
            let chosen: Vec<usize> = every.iter().map(|_| random.random_range(0..seeds.len())).collect();
            match crossing_of(&curve, &chosen, level) {
                Crossing::At(kappa, _) => resampled.push(kappa),
                // An interval that reaches beyond the study is unknown.
                _ => return Crossing::At(kappa, None),
            }
        }
        resampled.sort_by(f64::total_cmp);
        let at = |share: f64| resampled[(share * (RESAMPLES - 1) as f64).round() as usize];
        Crossing::At(kappa, Some((at(0.025), at(0.975))))
    }
}

/// κ beyond which the mean over the chosen profiles stays below a share, linearly interpolated in the logarithm of
/// the share.
fn crossing_of(curve: &[(f64, Vec<f64>)], chosen: &[usize], level: f64) -> Crossing {
    let mean = |shares: &[f64]| chosen.iter().map(|&line| shares[line]).sum::<f64>() / chosen.len() as f64;
    let means: Vec<(f64, f64)> = curve.iter().map(|(kappa, shares)| (*kappa, mean(shares))).collect();
    let Some(last) = means.iter().rposition(|&(_, mean)| mean >= level) else {
        return Crossing::Below(means.first().map_or(f64::NAN, |&(kappa, _)| kappa));
    };
    let Some(&(next, below)) = means.get(last + 1) else { return Crossing::Above(means[last].0) };
    let (kappa, above) = means[last];
    // A mean of zero has no logarithm.
    let share =
        if below > 0.0 { (above / level).ln() / (above / below).ln() } else { (above - level) / above };
    Crossing::At(kappa + share * (next - kappa), None)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shares of profiles that fall as exp(−κ/c).
    fn falling(rates: &[f64]) -> Vec<(f64, Vec<f64>)> {
        let kappas = (0..40).map(|k| 0.25 * f64::from(k));
        kappas.map(|kappa| (kappa, rates.iter().map(|rate| (-kappa * rate).exp()).collect())).collect()
    }

    #[test]
    fn an_exponential_is_crossed_where_it_falls_so_far() {
        for level in [0.5, 0.1, 0.01] {
            let Crossing::At(kappa, None) = crossing_of(&falling(&[1.0]), &[0], level) else { panic!() };
            assert!((kappa + level.ln()).abs() < 1e-12, "{level}: {kappa}");
        }
        assert_eq!(crossing_of(&falling(&[0.01]), &[0], 0.5), Crossing::Above(9.75));
        assert_eq!(crossing_of(&falling(&[1.0]), &[0], 2.0), Crossing::Below(0.0));
        let to_zero = vec![(1.0, vec![0.4]), (2.0, vec![0.0])];
        assert_eq!(crossing_of(&to_zero, &[0], 0.1), Crossing::At(1.75, None));
    }

    #[test]
    fn spreads_are_ratios_along_one_axis_at_a_time() {
        let boundary = |first: f64, second: f64, crossing: Crossing| Boundary {
            others: vec![first, second],
            protocol: Quantity::ZeroForceAdhesionShare,
            level: 0.1,
            crossing,
        };
        let at = |value: f64| Crossing::At(value, None);
        let boundaries = Boundaries {
            over: RoughnessParameter::Kappa,
            others: vec!["H".into(), "k_min".into()],
            lines: 1,
            found: vec![
                boundary(0.2, 1.0, at(2.0)),
                boundary(0.2, 4.0, at(5.0)),
                boundary(0.8, 1.0, at(3.0)),
                boundary(0.8, 4.0, Crossing::Above(16.0)),
            ],
        };
        let spread = BoundarySpread {
            protocol: Quantity::ZeroForceAdhesionShare,
            level: 0.1,
            range: Some((2.0, 5.0)),
            along: vec![1.5, 2.5],
            outside: 1,
        };
        assert_eq!(boundaries.spreads(), [spread]);
    }

    #[test]
    fn intervals_hold_the_mean_and_narrow_with_more_lines() {
        let width = |lines: usize| {
            let rates: Vec<f64> = (0..lines).map(|line| 0.8 + 0.4 * (line % 4) as f64 / 3.0).collect();
            let shares = falling(&rates).into_iter().enumerate().map(|(place, (kappa, shares))| {
                (place as u64, (kappa, shares.into_iter().enumerate().map(|(s, v)| (s as u64, v)).collect()))
            });
            let section = Section { others: Vec::new(), shares: shares.collect() };
            let Crossing::At(kappa, Some((low, high))) = section.crossing(0.1) else { panic!() };
            assert!(low < kappa && kappa < high, "{low} {kappa} {high}");
            assert_eq!(section.crossing(0.1), section.crossing(0.1));
            high - low
        };
        let (few, many) = (width(8), width(128));
        assert!(many < 0.4 * few && many > 0.15 * few, "{few} {many}");
    }
}
