//! Observed powers of waves, and their expected means as integrals of the isotropic spectrum.

use super::isotropic::{Nodes, Term, gauss};
use super::periodogram::{MapPower, ProfilePower};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Number of waves of a profile that are single observations; shorter waves are averaged in bands.
const SINGLE: usize = 32;

/// Number of bands per decade. Within a band a power law with the exponent −3 departs from its mean
/// by 0.1 %.
const BANDS_PER_DECADE: f64 = 60.0;

/// Number of waves under a Hann window that count as one independent wave. Powers at distances of 1
/// and 2 waves are correlated with the squares of 2/3 and 1/6.
const HANN_CORRELATED: f64 = 1.0 + 2.0 * (4.0 / 9.0 + 1.0 / 36.0);

/// Distance of waves, and the share that the power of each has in the mean power of a wave under a
/// Hann window.
const HANN_SHARES: [(f64, f64); 3] = [(-1.0, 1.0 / 6.0), (0.0, 2.0 / 3.0), (1.0, 1.0 / 6.0)];

/// Largest number of aliases of a wave whose powers are added one by one.
const MOST_ALIASES: u32 = 4;

/// Mean power of the waves in a band of wave numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Observation {
    pub wave_number: f64,
    /// Mean power: C1D in m³ or C2D in m⁴.
    pub power: f64,
    pub waves: f64,
    /// Width of the band in rad/m. Power times width times q^p is the contribution to a moment of
    /// the equivalent line.
    pub range: f64,
    pub windowed: bool,
    pub kind: Kind,
}

/// Kind of the observed power, with the wave number of wave 1 (step) and of the sampling in rad/m.
/// Waves that differ by the latter are aliases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// Power of a cut through the surface: C1D.
    Cut { step: f64, sampling: f64 },
    /// Power of a map, C2D, with wave numbers along and between rows.
    Plane { steps: [f64; 2], sampling: [f64; 2] },
}

/// Returns the observations of the spectrum of profiles, from wave 1 on, or under a window from
/// wave 2 on. Removing a polynomial reduces wave 1.
pub(super) fn of_profiles(power: &ProfilePower, last: f64) -> Vec<Observation> {
    let kind = Kind::Cut {
        step: power.step,
        sampling: TAU / power.spacing,
    };
    let correlated = if power.windowed { HANN_CORRELATED } else { 1.0 };
    let first = if power.windowed { 2 } else { 1 };
    let profiles = power.profiles as f64;
    let mut observed = Vec::new();
    let mut low = first;
    let count = power.waves.len().min((last / power.step) as usize);
    while low <= count {
        let ratio = 10.0_f64.powf(1.0 / BANDS_PER_DECADE);
        let next = if low <= SINGLE {
            low + 1
        } else {
            ((low as f64 * ratio) as usize).max(low + 1)
        };
        let next = next.min(count + 1);
        let waves = (next - low) as f64;
        let sum: f64 = power.waves[low - 1..next - 1]
            .iter()
            .map(|(_, power)| power)
            .sum();
        observed.push(Observation {
            wave_number: 0.5 * (low + next - 1) as f64 * power.step,
            power: sum / (waves * profiles),
            waves: waves * profiles / correlated,
            range: waves * power.step / PI,
            windowed: power.windowed,
            kind,
        });
        low = next;
    }
    observed
}

/// Returns the smallest wave number of a map that is used, in rad/m. Under a window, removing a
/// polynomial reduces the waves around wave 1.
pub(super) fn least_of_map(power: &MapPower) -> f64 {
    if power.windowed {
        2.0 * power.steps[0].max(power.steps[1])
    } else {
        0.0
    }
}

pub(super) fn of_map(power: &MapPower, last: f64) -> Vec<Observation> {
    let MapPower {
        windowed,
        steps,
        sampling,
        ref waves,
        ..
    } = *power;
    let correlated = if windowed {
        HANN_CORRELATED * HANN_CORRELATED
    } else {
        1.0
    };
    let least = least_of_map(power) * (1.0 - 1e-9);
    let (first, end) = (
        waves.partition_point(|(q, _)| *q < least),
        waves.partition_point(|(q, _)| *q <= last),
    );
    let number = |wave: &(f64, f64)| (BANDS_PER_DECADE * wave.0.log10()).floor();
    let bands = waves[first..end.max(first)].chunk_by(|one, next| number(one) == number(next));
    let sums = bands.map(|band| {
        let sum = |of: fn(&(f64, f64)) -> f64| band.iter().map(of).sum::<f64>();
        [
            band.len() as f64,
            sum(|(q, _)| *q),
            sum(|(_, power)| *power),
            sum(|(_, power)| power * power),
        ]
    });
    let sums: Vec<[f64; 4]> = sums.collect();
    let dispersion = dispersion(&sums);
    let observed = sums
        .into_iter()
        .map(|[count, wave_number, power, _]| Observation {
            wave_number: wave_number / count,
            power: power / count,
            // Of a wave and its mirror image one is counted.
            range: 2.0 * count * steps[0] * steps[1] / (4.0 * PI * PI),
            waves: count / (correlated * dispersion),
            windowed,
            kind: Kind::Plane { steps, sampling },
        });
    observed.collect()
}

/// Computes the variance of the powers in a band over the square of their mean, averaged over the
/// waves. It is 1 for a surface that is equal in all directions, and more for an anisotropic one,
/// whose mean powers are less certain. A band is its number of waves and the sums of their wave
/// numbers, powers and squared powers.
fn dispersion(bands: &[[f64; 4]]) -> f64 {
    let many = bands
        .iter()
        .filter(|[count, _, power, _]| *count > 8.0 && *power > 0.0);
    let (sum, waves) = many.fold((0.0, 0.0), |(sum, waves), [n, _, power, squares]| {
        // For exponentially distributed powers the mean of the first factor is (n − 1)/(n + 1).
        let variance = (n * squares / (power * power) - 1.0) * (n + 1.0) / (n - 1.0);
        (sum + n * variance, waves + n)
    });
    if waves > 0.0 {
        (sum / waves).max(1.0)
    } else {
        1.0
    }
}

impl Observation {
    /// Computes the contribution of this mean power to the moments ∫ q^(p+1) C2D dq/2π of the
    /// equivalent line, p = 0, 1, 2. The moments of a cut are 1, 2/π and 1/2 times these moments.
    pub fn moments(&self, power: f64) -> [f64; 3] {
        let (first, second) = if let Kind::Cut { .. } = self.kind {
            (FRAC_PI_2, 2.0)
        } else {
            (1.0, 1.0)
        };
        let q = self.wave_number;
        [1.0, first * q, second * q * q].map(|factor| factor * self.range * power)
    }

    /// Returns the terms whose sum is the expected mean power for a spectrum with these nodes,
    /// including aliases of waves that the points do not resolve.
    pub fn terms(&self, nodes: &Nodes) -> Vec<Term> {
        let mut terms = Vec::new();
        let shares: &[(f64, f64)] = if self.windowed {
            &HANN_SHARES
        } else {
            &[(0.0, 1.0)]
        };
        match self.kind {
            Kind::Cut { step, sampling } => {
                for (waves, share) in shares {
                    let q = self.wave_number + waves * step;
                    add_cut(&mut terms, nodes, q.abs(), *share);
                    if nodes.end > 0.5 * sampling {
                        for alias in 1..=MOST_ALIASES {
                            let period = sampling * f64::from(alias);
                            add_cut(&mut terms, nodes, period - q, *share);
                            add_cut(&mut terms, nodes, period + q, *share);
                        }
                    }
                }
            }
            Kind::Plane { steps, sampling } => {
                if nodes.end > 0.5 * sampling[0].min(sampling[1]) {
                    add_aliases(&mut terms, nodes, self.wave_number, sampling);
                }
                // Waves between rows have their neighbours at the distances along them.
                let turned = [steps[1], steps[0]];
                let ways = if steps == turned {
                    vec![steps]
                } else {
                    vec![steps, turned]
                };
                for [ahead, aside] in &ways {
                    for ((along, x), (between, y)) in shares
                        .iter()
                        .flat_map(|x| shares.iter().map(move |y| (x, y)))
                    {
                        let q = (self.wave_number + along * ahead)
                            .hypot(between * aside)
                            .max(f64::MIN_POSITIVE);
                        if q <= nodes.end {
                            terms.push(nodes.term(q, x * y / ways.len() as f64));
                        }
                    }
                }
            }
        }
        terms
    }
}

/// Adds the aliases of the waves of a map at a wave number (rad/m), averaged over all directions.
/// They are C2D at the distances of the reciprocal lattice of the sampling. Distant aliases are
/// replaced by an integral.
fn add_aliases(terms: &mut Vec<Term>, nodes: &Nodes, wave_number: f64, [x, y]: [f64; 2]) {
    let most = f64::from(MOST_ALIASES);
    let mut add = |q: f64, weight: f64| {
        if q <= nodes.end {
            terms.push(nodes.term(q, weight));
        }
    };
    let orders = || (0..=2 * MOST_ALIASES).map(|order| f64::from(order) - most);
    for (angle, weight) in gauss(0.0, FRAC_PI_2) {
        let (along, between) = (wave_number * angle.cos(), wave_number * angle.sin());
        for (i, j) in orders()
            .flat_map(|i| orders().map(move |j| (i, j)))
            .filter(|order| *order != (0.0, 0.0))
        {
            add((along + i * x).hypot(between + j * y), weight / FRAC_PI_2);
        }
    }
    let beyond = (2.0 * most + 1.0) * (x * y / PI).sqrt();
    for (low, high) in nodes.pieces_from(beyond) {
        for (ln_q, weight) in gauss(low.ln(), high.ln()) {
            add(ln_q.exp(), TAU * (2.0 * ln_q).exp() * weight / (x * y));
        }
    }
}

/// Adds `factor` times (1/π) ∫ C2D(√(k² + t²)) dt, piece by piece between the nodes. With t as the
/// variable the integrand has no pole.
fn add_cut(terms: &mut Vec<Term>, nodes: &Nodes, k: f64, factor: f64) {
    for (low, high) in nodes.pieces_from(k) {
        let along = |q: f64| ((q - k) * (q + k)).max(0.0).sqrt();
        let points = gauss(along(low), along(high));
        terms.extend(points.map(|(t, weight)| nodes.term(k.hypot(t), factor * weight / PI)));
    }
}

#[cfg(test)]
mod tests {
    use super::super::isotropic::{End, known, line_moments};
    use super::*;

    fn mean(terms: &[Term], values: &[f64]) -> f64 {
        let term = |term: &Term| {
            let value =
                (1.0 - term.share) * values[term.index] + term.share * values[term.index + 1];
            term.weight * value.exp()
        };
        terms.iter().map(term).sum()
    }

    #[test]
    fn powers_that_differ_between_directions_count_as_fewer_waves() {
        // Quantiles of the exponential distribution, for half of the waves times a factor.
        let powers = |factor: f64| -> Vec<f64> {
            let quantile = |i: u32| -((f64::from(i) + 0.5) / 2000.0).ln();
            (0..2000)
                .map(|i| quantile(i) * if i % 2 == 0 { factor } else { 1.0 })
                .collect()
        };
        let found = |factor: f64| {
            let waves = powers(factor)
                .into_iter()
                .map(|power| (1.0, power))
                .collect();
            let (steps, sampling) = ([0.1; 2], [10.0; 2]);
            let map = MapPower {
                windowed: false,
                steps,
                sampling,
                waves,
                offsets: false,
                apart: 0.0,
            };
            2000.0 / of_map(&map, 2.0)[0].waves
        };
        assert!((found(1.0) - 1.0).abs() < 0.01, "{}", found(1.0));
        // Mean 5, mean square 2 (1 + 81)/2 = 82: variance over squared mean (82 − 25)/25.
        assert!((found(9.0) - 57.0 / 25.0).abs() < 0.03, "{}", found(9.0));
    }

    #[test]
    fn line_and_cut_of_a_surface_differ_as_the_identities_say() {
        let nodes = Nodes::new(1.0, 300.0, 12.0, End::Ends);
        for hurst in [0.3, 0.8] {
            // Roll-off at 10.
            let spectrum = known(nodes, |q: f64| (q / 10.0).max(1.0).powf(-2.0 - 2.0 * hurst));
            // Moments of the cut from its own spectrum; below half the first wave number the line
            // has no waves, but the cut has the projections of waves across it.
            let mut sums = [0.0; 3];
            let wave_numbers: Vec<f64> = (0..=600)
                .map(|i| 0.5e-3 * 600_000_f64.powf(f64::from(i) / 600.0))
                .collect();
            for piece in wave_numbers.windows(2) {
                for (ln_k, weight) in gauss(piece[0].ln(), piece[1].ln()) {
                    let k = ln_k.exp();
                    let mut terms = Vec::new();
                    add_cut(&mut terms, &nodes, k, 1.0);
                    let power = weight * k * mean(&terms, &spectrum.values);
                    for (sum, factor) in sums.iter_mut().zip([1.0, k * k, k]) {
                        *sum += factor * power;
                    }
                }
            }
            let moments = line_moments(std::slice::from_ref(&spectrum));
            let ratios = [
                moments.rms_height.value / (sums[0] / PI).sqrt(),
                moments.rms_gradient.value / (sums[1] / PI).sqrt(),
                moments.energy_per_modulus.value / (sums[2] / (4.0 * PI)),
            ];
            let expected = [1.0, 2.0_f64.sqrt(), 0.5 * PI];
            for (ratio, expected) in ratios.into_iter().zip(expected) {
                // The line omits the waves below half the first wave number, 0.1 % of the height.
                assert!(
                    (ratio / expected - 1.0).abs() < 2e-3,
                    "H = {hurst}: {ratios:?}"
                );
            }
        }
    }
}
