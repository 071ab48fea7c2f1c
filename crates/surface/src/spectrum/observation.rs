//! Observed powers of waves, and their expected means as integrals of the isotropic spectrum.

use super::map_power::MapPower;
use super::nodes::{Nodes, Term};
use super::periodogram::{ProfilePower, Wave};
use super::quadrature::gauss;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Number of the longest waves of a profile, each of which is an observation of its own. Shorter
/// waves are averaged in bands.
const SINGLE: usize = 32;

/// Number of bands per decade of wave numbers. In a band of this width, the mean of a power law
/// with the exponent −3 differs by 0.1 % from the value at the mean wave number.
const BANDS_PER_DECADE: f64 = 60.0;

/// Number of neighbouring waves that have as much information as one independent wave if a Hann
/// window is used. The powers of two waves have the correlation coefficient (2/3)² if their numbers
/// of periods differ by 1, and (1/6)² if their numbers of periods differ by 2.
pub(super) const HANN_CORRELATED: f64 = 1.0 + 2.0 * (4.0 / 9.0 + 1.0 / 36.0);

/// A wave whose power contributes to the observed power of another wave.
struct Contribution {
    /// Number of the contributing wave minus the number of the observed wave.
    distance: f64,
    /// Factor of the power of the contributing wave in the mean of the observed power.
    share: f64,
}

/// Contributions to the observed power of a wave if a Hann window is used.
const HANN_CONTRIBUTIONS: [Contribution; 3] = [
    Contribution {
        distance: -1.0,
        share: 1.0 / 6.0,
    },
    Contribution {
        distance: 0.0,
        share: 2.0 / 3.0,
    },
    Contribution {
        distance: 1.0,
        share: 1.0 / 6.0,
    },
];

/// The only contribution to the observed power of a wave without a window: that of the wave itself.
const OWN_CONTRIBUTION: [Contribution; 1] = [Contribution {
    distance: 0.0,
    share: 1.0,
}];

/// Number of aliases on each side of a wave, along each axis, whose powers are added one by one.
/// Aliases are waves that look the same at the sampled points.
const MOST_ALIASES: u32 = 4;

/// A band must have more waves than this number to be used for the estimate of the dispersion of
/// powers.
const LEAST_DISPERSED: f64 = 8.0;

/// Observed mean power of the waves in a band of wave numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Observation {
    pub wave_number: f64,
    /// Mean power spectral density of the band: C1D in m³ or C2D in m⁴.
    pub power: f64,
    pub waves: f64,
    /// Weight of the band in the moments of the equivalent line. The contribution of the band to a
    /// moment is its mean power times this weight times a power of its wave number
    /// ([`Observation::moments`]).
    pub range: f64,
    /// Means of P, q P and q² P over the waves of the band, where P is the power of a wave and q
    /// its wave number in rad/m.
    pub weighted_powers: [f64; 3],
    pub windowed: bool,
    pub kind: Kind,
}

/// Kind of the observed power. `step` and `steps` are the wave numbers of waves with one period
/// over the surface. `sampling` is 2π over the distance between points. All are in rad/m. Two waves
/// whose wave numbers differ by `sampling` look the same at the points: they are aliases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// One-dimensional power spectral density C1D of a cut through the surface, which is a profile.
    Cut { step: f64, sampling: f64 },
    /// Two-dimensional power spectral density C2D of a map. The first of the two wave numbers is
    /// that along the rows, the second that perpendicular to the rows.
    Plane { steps: [f64; 2], sampling: [f64; 2] },
}

/// Returns the observed mean powers of profiles in bands of wave numbers up to `last` in rad/m. The
/// first band is the wave with one period over the profile. If a window is used, the first band is
/// the wave with two periods, because removal of a polynomial reduces the power of the longest
/// wave.
pub(super) fn of_profiles(power: &ProfilePower, last: f64) -> Vec<Observation> {
    let kind = Kind::Cut {
        step: power.step,
        sampling: TAU / power.spacing,
    };
    let correlated = if power.windowed { HANN_CORRELATED } else { 1.0 };
    let profiles = power.profiles as f64;
    let count = power.waves.len().min((last / power.step) as usize);
    let mut observations = Vec::new();
    let mut first = if power.windowed { 2 } else { 1 };
    while first <= count {
        let next = first_of_next_band(first).min(count + 1);
        let waves = (next - first) as f64;
        let band = &power.waves[first - 1..next - 1];
        let weighted_powers = [0, 1, 2].map(|exponent| {
            let terms = band.iter().map(|wave| wave.weighted_power(exponent));
            terms.sum::<f64>() / (waves * profiles)
        });
        observations.push(Observation {
            wave_number: 0.5 * (first + next - 1) as f64 * power.step,
            power: weighted_powers[0],
            weighted_powers,
            waves: waves * profiles / correlated,
            range: waves * power.step / PI,
            windowed: power.windowed,
            kind,
        });
        first = next;
    }
    observations
}

/// Returns the number of the wave of a profile at which the band after the wave `first` begins.
fn first_of_next_band(first: usize) -> usize {
    if first <= SINGLE {
        return first + 1;
    }
    let ratio = 10.0_f64.powf(1.0 / BANDS_PER_DECADE);
    ((first as f64 * ratio) as usize).max(first + 1)
}

/// Returns the smallest wave number in rad/m of the waves of a map that are used. If a window is
/// used, the waves with about one period over the map are left out, because removal of a polynomial
/// reduces their power.
pub(super) fn least_of_map(power: &MapPower) -> f64 {
    if power.windowed {
        2.0 * power.steps[0].max(power.steps[1])
    } else {
        0.0
    }
}

/// Sums over those waves of a map whose wave numbers lie in the same band.
#[derive(Default)]
struct BandSums {
    waves: f64,
    wave_number: f64,
    /// Sums of the power times q⁰, q¹ and q².
    weighted_powers: [f64; 3],
    squared_power: f64,
}

impl BandSums {
    fn new(band: &[Wave]) -> Self {
        let mut sums = BandSums::default();
        for wave in band {
            sums.waves += 1.0;
            sums.wave_number += wave.wave_number;
            for (exponent, sum) in sums.weighted_powers.iter_mut().enumerate() {
                *sum += wave.weighted_power(exponent as i32);
            }
            sums.squared_power += wave.power * wave.power;
        }
        sums
    }
}

fn band_number(wave: &Wave) -> f64 {
    (BANDS_PER_DECADE * wave.wave_number.log10()).floor()
}

/// Returns the observed mean powers of a map in bands of wave numbers up to `last` in rad/m.
pub(super) fn of_map(map: &MapPower, last: f64) -> Vec<Observation> {
    let least = least_of_map(map) * (1.0 - 1e-9);
    let first = map.waves.partition_point(|wave| wave.wave_number < least);
    let end = map.waves.partition_point(|wave| wave.wave_number <= last);
    let bands: Vec<BandSums> = map.waves[first..end.max(first)]
        .chunk_by(|wave, next| band_number(wave) == band_number(next))
        .map(BandSums::new)
        .collect();

    let correlated = if map.windowed {
        HANN_CORRELATED * HANN_CORRELATED
    } else {
        1.0
    };
    let dispersion = dispersion(&bands);
    let [along, between] = map.steps;
    let observations = bands.into_iter().map(|band| Observation {
        wave_number: band.wave_number / band.waves,
        power: band.weighted_powers[0] / band.waves,
        weighted_powers: band.weighted_powers.map(|sum| sum / band.waves),
        // The factor 2 counts the mirror image of each wave, which is not in the sum.
        range: 2.0 * band.waves * along * between / (4.0 * PI * PI),
        waves: band.waves / (correlated * dispersion),
        windowed: map.windowed,
        kind: Kind::Plane {
            steps: map.steps,
            sampling: map.sampling,
        },
    });
    observations.collect()
}

/// Computes the variance of the powers in a band divided by the square of their mean. The result is
/// an average over all bands, weighted by their numbers of waves. It is 1 for an isotropic surface.
/// It is larger for an anisotropic surface, whose mean powers are less certain. A result below 1 is
/// raised to 1.
fn dispersion(bands: &[BandSums]) -> f64 {
    let mut sum = 0.0;
    let mut waves = 0.0;
    for band in bands {
        let power = band.weighted_powers[0];
        let is_counted = band.waves > LEAST_DISPERSED && power > 0.0;
        if !is_counted {
            continue;
        }
        let n = band.waves;
        let square = n * band.squared_power / (power * power);
        // If n powers are exponentially distributed, the mean of `square − 1` is (n − 1)/(n + 1),
        // so the mean of the product is 1.
        let variance = (square - 1.0) * (n + 1.0) / (n - 1.0);
        sum += n * variance;
        waves += n;
    }
    if waves > 0.0 {
        (sum / waves).max(1.0)
    } else {
        1.0
    }
}

impl Observation {
    /// Computes the contribution of this band to three moments of the equivalent line, if all waves
    /// of the band had the power `power`. The moments are ∫ q^(p+1) C2D dq/2π for p = 0, 1, 2,
    /// where C2D is the spectral density at the wave number q. For a cut, the moments of the line
    /// are divided by 1, π/2 and 2.
    pub fn moments(&self, power: f64) -> [f64; 3] {
        let q = self.wave_number;
        self.of_weighted_powers([1.0, q, q * q].map(|factor| factor * power))
    }

    /// Computes the measured contribution of this band to the moments ∫ q^(p+1) C2D dq/2π for p =
    /// 0, 1, 2, where C2D is the spectral density at the wave number q. Each wave of the band
    /// contributes with its own power and wave number.
    pub fn measured_moments(&self) -> [f64; 3] {
        self.of_weighted_powers(self.weighted_powers)
    }

    fn of_weighted_powers(&self, moments: [f64; 3]) -> [f64; 3] {
        let [height, energy, gradient] = moments;
        let moments = match self.kind {
            Kind::Cut { .. } => [height, FRAC_PI_2 * energy, 2.0 * gradient],
            Kind::Plane { .. } => [height, energy, gradient],
        };
        moments.map(|moment| moment * self.range)
    }

    /// Returns the terms whose sum is the mean power of this band that a spectrum predicts. Each
    /// term is a weight times the spectrum at one wave number. The spectrum is interpolated between
    /// the wave numbers `nodes`. The terms include aliases: shorter waves that look like the waves
    /// of this band, because the points do not resolve them.
    pub fn terms(&self, nodes: &Nodes) -> Vec<Term> {
        match self.kind {
            Kind::Cut { step, sampling } => self.terms_of_cut(nodes, step, sampling),
            Kind::Plane { steps, sampling } => self.terms_of_plane(nodes, steps, sampling),
        }
    }

    /// Returns the waves that contribute to the observed power of this wave.
    fn contributions(&self) -> &'static [Contribution] {
        if self.windowed {
            &HANN_CONTRIBUTIONS
        } else {
            &OWN_CONTRIBUTION
        }
    }

    fn terms_of_cut(&self, nodes: &Nodes, step: f64, sampling: f64) -> Vec<Term> {
        let mut terms = Vec::new();
        for contribution in self.contributions() {
            let q = self.wave_number + contribution.distance * step;
            add_cut(&mut terms, nodes, q.abs(), contribution.share);
            if nodes.end > 0.5 * sampling {
                for alias in 1..=MOST_ALIASES {
                    let period = sampling * f64::from(alias);
                    add_cut(&mut terms, nodes, period - q, contribution.share);
                    add_cut(&mut terms, nodes, period + q, contribution.share);
                }
            }
        }
        terms
    }

    /// Returns the terms of a wave of a map: its own power, the powers of neighbouring waves that
    /// the window adds, and the powers of the aliases of all these waves.
    fn terms_of_plane(&self, nodes: &Nodes, steps: [f64; 2], sampling: [f64; 2]) -> Vec<Term> {
        let mut terms = Vec::new();
        if nodes.end > 0.5 * sampling[0].min(sampling[1]) {
            add_aliases(&mut terms, nodes, self.wave_number, sampling);
        }
        // An isotropic spectrum has no direction, so the wave is assumed to run along the rows and,
        // a second time, between the rows. On a map that is not square, these two directions give
        // different distances to the neighbouring waves.
        let turned = [steps[1], steps[0]];
        let directions = if steps == turned {
            vec![steps]
        } else {
            vec![steps, turned]
        };
        for [ahead, aside] in &directions {
            for along in self.contributions() {
                for between in self.contributions() {
                    let q = (self.wave_number + along.distance * ahead)
                        .hypot(between.distance * aside)
                        .max(f64::MIN_POSITIVE);
                    if q <= nodes.end {
                        let share = along.share * between.share / directions.len() as f64;
                        terms.push(nodes.term(q, share));
                    }
                }
            }
        }
        terms
    }
}

/// Adds the aliases of the waves of a map at a wave number (rad/m), averaged over all directions.
/// An alias differs from its wave by a vector of the reciprocal lattice of the sampled points, and
/// its power is C2D at the resulting wave number. The sum over distant aliases is replaced by an
/// integral.
fn add_aliases(terms: &mut Vec<Term>, nodes: &Nodes, wave_number: f64, sampling: [f64; 2]) {
    let [x, y] = sampling;
    let most = MOST_ALIASES as i32;
    for direction in gauss(0.0, FRAC_PI_2) {
        let along = wave_number * direction.place.cos();
        let between = wave_number * direction.place.sin();
        for i in -most..=most {
            for j in -most..=most {
                if i == 0 && j == 0 {
                    continue;
                }
                let q = (along + f64::from(i) * x).hypot(between + f64::from(j) * y);
                add_term(terms, nodes, q, direction.weight / FRAC_PI_2);
            }
        }
    }

    let beyond = (2.0 * f64::from(MOST_ALIASES) + 1.0) * (x * y / PI).sqrt();
    for piece in nodes.pieces_from(beyond) {
        for point in piece.logarithms() {
            let ln_q = point.place;
            let weight = TAU * (2.0 * ln_q).exp() * point.weight / (x * y);
            add_term(terms, nodes, ln_q.exp(), weight);
        }
    }
}

/// Adds a term, unless its wave number is beyond the end of the spectrum.
fn add_term(terms: &mut Vec<Term>, nodes: &Nodes, q: f64, weight: f64) {
    if q <= nodes.end {
        terms.push(nodes.term(q, weight));
    }
}

/// Adds the terms of `factor` times the power of a cut, (1/π) ∫ C2D(√(k² + t²)) dt. Each piece
/// between two nodes has a quadrature of its own. The variable is t and not q = √(k² + t²), because
/// the integrand over q has a pole at q = k.
fn add_cut(terms: &mut Vec<Term>, nodes: &Nodes, k: f64, factor: f64) {
    let along = |q: f64| ((q - k) * (q + k)).max(0.0).sqrt();
    for piece in nodes.pieces_from(k) {
        for point in gauss(along(piece.low), along(piece.high)) {
            terms.push(nodes.term(k.hypot(point.place), factor * point.weight / PI));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::isotropic::known;
    use super::super::moments::line_moments;
    use super::super::nodes::{End, WaveRange};
    use super::*;

    fn mean(terms: &[Term], values: &[f64]) -> f64 {
        terms.iter().map(|term| term.value(values)).sum()
    }

    #[test]
    fn powers_that_differ_between_directions_count_as_fewer_waves() {
        // These powers are quantiles of the exponential distribution. Every second one is
        // multiplied by a factor.
        let powers = |factor: f64| -> Vec<f64> {
            let quantile = |i: u32| -((f64::from(i) + 0.5) / 2000.0).ln();
            (0..2000)
                .map(|i| quantile(i) * if i % 2 == 0 { factor } else { 1.0 })
                .collect()
        };
        let found = |factor: f64| {
            let waves = powers(factor).into_iter().map(|power| Wave {
                wave_number: 1.0,
                power,
            });
            let map = MapPower {
                windowed: false,
                steps: [0.1; 2],
                sampling: [10.0; 2],
                waves: waves.collect(),
                offsets: false,
                apart: 0.0,
            };
            2000.0 / of_map(&map, 2.0)[0].waves
        };
        assert!((found(1.0) - 1.0).abs() < 0.01, "{}", found(1.0));
        // The mean is 5 and the mean square is 2 (1 + 81)/2 = 82. The variance divided by the
        // squared mean is therefore (82 − 25)/25.
        assert!((found(9.0) - 57.0 / 25.0).abs() < 0.03, "{}", found(9.0));
    }

    #[test]
    fn line_and_cut_of_a_surface_differ_as_the_identities_say() {
        let range = WaveRange {
            first: 1.0,
            last: 300.0,
        };
        let nodes = Nodes::new(range, 12.0, End::Ends);
        for hurst in [0.3, 0.8] {
            // In this spectrum the roll-off is at the wave number 10.
            let spectrum = known(nodes, |q: f64| (q / 10.0).max(1.0).powf(-2.0 - 2.0 * hurst));
            // Moments of the cut, integrated over the spectrum of the cut. The cut also has power
            // below half the first wave number, where the line has none: waves that run nearly
            // across the cut appear in it as long waves.
            let mut sums = [0.0; 3];
            let wave_numbers: Vec<f64> = (0..=600)
                .map(|i| 0.5e-3 * 600_000_f64.powf(f64::from(i) / 600.0))
                .collect();
            for piece in wave_numbers.windows(2) {
                for point in gauss(piece[0].ln(), piece[1].ln()) {
                    let k = point.place.exp();
                    let mut terms = Vec::new();
                    add_cut(&mut terms, &nodes, k, 1.0);
                    let power = point.weight * k * mean(&terms, &spectrum.values);
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
                // Without waves below half the first wave number, the height of the line is too
                // small by 0.1 %.
                assert!(
                    (ratio / expected - 1.0).abs() < 2e-3,
                    "H = {hurst}: {ratios:?}"
                );
            }
        }
    }
}
