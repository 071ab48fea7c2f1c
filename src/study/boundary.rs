//! Boundary of vanishing zero-load adhesion: the boundary between pressure-insensitive and pressure-sensitive
//! adhesion, eq. (15), with its statistical error.
//!
//! F_a(0) falls with κ about exponentially and never quite to zero, since a single spring still sticks. So the
//! boundary κ* is where its mean over the lines falls below a share of the ideal adhesion force F_a,max; what
//! that share is moves it, and several are asked for at a time.

use super::axis::Axis;
use super::finished::Finished;
use super::plan::Plan;
use super::quantity::Quantity;
use super::{StudyError, symbol_and_unit};
use rand::RngExt;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;
use std::path::Path;

/// Shares of F_a,max that are usual.
pub const USUAL_LEVELS: [f64; 4] = [0.5, 0.1, 0.05, 0.01];
/// Random choices of lines from which an interval of confidence is taken.
const RESAMPLES: usize = 1000;
/// Seed of these choices: the same table each time.
const RESAMPLING_SEED: u64 = 2012;
/// Protocols whose shares of F_a,max a study may record.
const PROTOCOLS: [Quantity; 2] = [Quantity::ZeroLoadAdhesionShare, Quantity::ZeroForceAdhesionShare];

/// The boundary at one place on the other axes, by one protocol, at one share.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// Values on the axes other than κ, in their order.
    pub others: Vec<f64>,
    /// The share that is recorded: which protocol.
    pub protocol: Quantity,
    /// The share of F_a,max below which adhesion counts as vanished.
    pub level: f64,
    /// κ*, and its 95 % confidence interval by resampling of lines.
    pub kappa: Crossing,
}

/// κ at which a mean falls below a share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crossing {
    /// Here, with the interval of confidence where lines could be resampled and all of them cross.
    At(f64, Option<(f64, f64)>),
    /// Below the smallest κ of the study.
    Below(f64),
    /// Above the largest κ of the study.
    Above(f64),
}

/// The boundaries of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundaries {
    /// Names of the axes other than κ, with symbols.
    pub others: Vec<String>,
    /// Random lines of each cell.
    pub lines: u64,
    /// In the order of the cells, then of protocols, then of levels.
    pub found: Vec<Boundary>,
}

/// By how much κ is another number under other definitions of what it is made of: a name and a factor.
pub const DEFINITIONS: [(&str, f64); 3] = [
    ("kappa", 1.0),
    // Wave numbers in 1/m: ⟨∇z⟩ is 2π times smaller, κ by its root, 1/√(2π).
    ("kappa_cycles", 0.398_942_280_401_432_7),
    // Amplitudes in place of root mean squares: h and ⟨∇z⟩ are √2 times larger.
    ("kappa_amplitude", std::f64::consts::SQRT_2),
];

/// Finds the boundaries of a merged study along its axis `kappa`.
///
/// # Errors
/// Where the study has no such axis, records no share of F_a(0), or as [`Finished::open`].
pub fn boundaries(path: &Path, levels: &[f64]) -> Result<Boundaries, StudyError> {
    let finished = Finished::open(path)?;
    let plan = finished.plan();
    let refuse = |reason: &str| StudyError::Folder { path: path.to_path_buf(), reason: reason.to_string() };
    let axes = || plan.all_axes().into_iter();
    let along = axes().position(|axis| axis.path() == "kappa");
    let along = along.ok_or_else(|| refuse("this study has no axis `kappa`, along which a boundary lies"))?;
    let protocols: Vec<(usize, Quantity)> = PROTOCOLS
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
    for ((_, place), section) in sections.0 {
        for &level in levels {
            let (others, protocol) = (section.others.clone(), protocols[place].1);
            found.push(Boundary { others, protocol, level, kappa: section.crossing(level) });
        }
    }
    let name = |axis: &Axis| {
        let (symbol, _) = symbol_and_unit(axis.path());
        if symbol.is_empty() { axis.path().to_string() } else { symbol.to_string() }
    };
    let others = axes().enumerate().filter(|(index, _)| *index != along).map(|(_, axis)| name(axis));
    Ok(Boundaries { others: others.collect(), lines: plan.lines, found })
}

/// F_a(0) over κ, line by line, for each place on the other axes and each protocol.
#[derive(Default)]
struct Sections(BTreeMap<(u64, usize), Section>);

#[derive(Default)]
struct Section {
    others: Vec<f64>,
    /// For each κ the shares of the lines, by their seeds.
    shares: BTreeMap<u64, (f64, BTreeMap<u64, f64>)>,
}

impl Sections {
    fn add(&mut self, plan: &Plan, along: usize, protocol: usize, (cell, seed): (u64, u64), share: f64) {
        let counts: Vec<u64> = plan.all_axes().into_iter().map(Axis::count).collect();
        let faster: u64 = counts[along + 1..].iter().product();
        let place = cell / faster % counts[along];
        // The cell of the same place with the smallest κ stands for the section.
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
        // Lines that all cells have; those of one seed are the same line in each.
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
                // An interval that reaches beyond the study is not known.
                _ => return Crossing::At(kappa, None),
            }
        }
        resampled.sort_by(f64::total_cmp);
        let at = |share: f64| resampled[(share * (RESAMPLES - 1) as f64).round() as usize];
        Crossing::At(kappa, Some((at(0.025), at(0.975))))
    }
}

/// κ beyond which the mean over the chosen lines stays below a share, straight between neighbours in its
/// logarithm.
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

    /// Lines that fall as exp(−κ/c).
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
