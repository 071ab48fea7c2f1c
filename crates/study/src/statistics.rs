//! Statistics over random profiles: mean, spread and quartiles of a quantity, and numbers of
//! profiles in each regime.

use asperity_data::{
    format_range, format_rounded, mean, quantile, quartiles, standard_deviation, student_quantile,
};
use asperity_scene::Regime;
use serde::Serialize;

/// Probability with which a confidence interval of a mean over profiles contains the mean over
/// infinitely many profiles.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// Smallest share of the profiles in one regime with which this regime counts as that of all
/// profiles.
const AGREEING_SHARE: f64 = 0.75;

/// Smallest number of values whose median has a confidence interval.
const FEWEST: usize = 4;
/// Half-width of the confidence interval of a median, counted in sorted values and divided by √n,
/// where n is the number of values. The number of values below the true median has a binomial
/// distribution with the standard deviation √n/2. In 95 of 100 cases it is within 1.96 standard
/// deviations: 1.96 · √n/2 = 0.98 √n.
const HALF: f64 = 0.98;

/// Share of the largest value in the sum of the values of all profiles, above which a warning is
/// given.
const MOST_OF_ONE: f64 = 0.5;

/// Statistics over random profiles of one quantity, in the SI unit of the quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(into = "StatisticsJson")]
pub struct Statistics {
    /// Number of profiles on which the quantity has a value. Only these profiles enter the
    /// statistics.
    pub count: usize,
    /// Mean over the profiles with a value, in the SI unit of the quantity.
    pub mean: f64,
    /// Lower quartile, median and upper quartile, interpolated between neighbouring values, in the
    /// SI unit of the quantity.
    pub quartiles: [f64; 3],
    /// Smallest and largest value among the profiles, in the SI unit of the quantity.
    pub range: (f64, f64),
    /// Lower and upper end of the 95 % confidence interval of the median, for any distribution.
    /// `None` for fewer than 4 values. The interval contains the median of infinitely many profiles
    /// in about 93 of 100 cases if it is computed from 8 profiles, and in about 95 from 16 or more.
    pub median_interval: Option<(f64, f64)>,
    /// Spread of the values and confidence interval of [`Statistics::mean`]; `None` for a single
    /// value.
    pub spread: Option<Spread>,
}

/// JSON object of [`Statistics`]. The spread is `null` for a single value.
#[derive(Serialize)]
struct StatisticsJson {
    count: usize,
    median: f64,
    quartiles: [f64; 2],
    range: (f64, f64),
    median_interval: Option<(f64, f64)>,
    mean: f64,
    standard_deviation: Option<f64>,
    standard_error: Option<f64>,
    confidence_interval: Option<(f64, f64)>,
}

impl From<Statistics> for StatisticsJson {
    fn from(statistics: Statistics) -> Self {
        let [lower, median, upper] = statistics.quartiles;
        StatisticsJson {
            count: statistics.count,
            median,
            quartiles: [lower, upper],
            range: statistics.range,
            median_interval: statistics.median_interval,
            mean: statistics.mean,
            standard_deviation: statistics.spread.map(|spread| spread.standard_deviation),
            standard_error: statistics.spread.map(|spread| spread.standard_error),
            confidence_interval: statistics.confidence_interval(),
        }
    }
}

/// Spread of the values of a quantity over several random profiles, and confidence interval of
/// their mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Sample standard deviation of the values, with the divisor `count − 1`, in the SI unit of the
    /// quantity.
    pub standard_deviation: f64,
    /// Standard error of the mean over the profiles, in the SI unit of the quantity: the standard
    /// deviation divided by the square root of the number of values.
    pub standard_error: f64,
    /// Lower and upper end of the 95 % confidence interval of the mean over the profiles, by
    /// Student's t. If the quantity has a bound, such as 0 for a force, the interval does not reach
    /// this bound.
    ///
    /// The interval assumes that the mean of the values is normally distributed. If few of many
    /// profiles make most of the mean, the interval is too narrow: for the pull-off force after
    /// first touch, F_a(d=0), it contains the mean of infinitely many profiles in about 82 of 100
    /// cases with 8 profiles, in 86 with 32 and in 92 with 64. [`Statistics::median_interval`] has
    /// no such assumption.
    pub confidence_interval: (f64, f64),
}

/// Function that returns one statistic, which a table shows in a column; `None` if the statistic is
/// unknown.
type Column = fn(&Statistics) -> Option<f64>;

impl Statistics {
    /// Computes the statistics of values of a quantity; `None` without a finite value. `bounds` are
    /// the smallest and the largest value that the quantity can have, −∞ and ∞ if the quantity has
    /// no bounds. Values that are not finite are left out.
    ///
    /// ```
    /// use asperity_study::{Quantity, Statistics};
    ///
    /// let forces = vec![1e-6, 4e-6, 2e-6, 3e-6, f64::NAN]; // N; a missing value is left out
    /// let all = Statistics::of(forces, Quantity::PullOffForce.bounds()).expect("four values");
    /// assert_eq!((all.count, all.range, all.quartiles[0]), (4, (1e-6, 4e-6), 1.75e-6));
    /// assert_eq!(Statistics::of(Vec::new(), (0.0, 1.0)), None);
    /// ```
    pub fn of(mut values: Vec<f64>, bounds: (f64, f64)) -> Option<Self> {
        values.retain(|value| value.is_finite());
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        let range = (*sorted.first()?, *sorted.last()?);
        let count = values.len() as f64;
        // The values are divided by the value with the largest magnitude, so that no square
        // overflows or underflows.
        let largest = values
            .iter()
            .fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let unit = if largest > 0.0 { largest } else { 1.0 };
        values.iter_mut().for_each(|value| *value /= unit);
        let mean = mean(&values);
        let standard_deviation = standard_deviation(&values, mean) * unit;
        let mean = mean * unit;
        let mut spread = None;
        if values.len() > 1 {
            let standard_error = standard_deviation / count.sqrt();
            let half = student_quantile(values.len() as u32 - 1) * standard_error;
            spread = Some(Spread {
                standard_deviation,
                standard_error,
                confidence_interval: interval(mean, half, bounds),
            });
        }
        Some(Statistics {
            count: values.len(),
            mean,
            quartiles: quartiles(&sorted)?,
            range,
            median_interval: median_interval(&sorted),
            spread,
        })
    }

    /// Columns of a table of statistics. Each element has the last part of the name of a column,
    /// such as `median`, and the function that returns the value of this column.
    pub const COLUMNS: [(&str, Column); 9] = [
        ("mean", |all| Some(all.mean)),
        ("sd", |all| Some(all.spread?.standard_deviation)),
        ("low", |all| Some(all.spread?.confidence_interval.0)),
        ("high", |all| Some(all.spread?.confidence_interval.1)),
        ("min", |all| Some(all.range.0)),
        ("q1", |all| Some(all.quartiles[0])),
        ("median", |all| Some(all.quartiles[1])),
        ("q3", |all| Some(all.quartiles[2])),
        ("max", |all| Some(all.range.1)),
    ];

    /// Returns text with the median, the quartiles and the range, or with the value if there is
    /// only one. `unit` is the SI unit of the quantity.
    ///
    /// ```
    /// let all = asperity_study::Statistics::of(vec![1e-6, 2e-6, 3e-6], (0.0, f64::INFINITY))
    ///     .expect("three values");
    /// assert_eq!(
    ///     all.words("N"),
    ///     "median 2 µN (quartiles 1.5 to 2.5 µN, range 1 to 3 µN)"
    /// );
    /// ```
    pub fn words(&self, unit: &str) -> String {
        let [lower, median, upper] = self.quartiles;
        let median = format_rounded(median, 2, unit);
        if self.count < 2 {
            return median;
        }
        let quartiles = format_range((lower, upper), 2, unit);
        let range = format_range(self.range, 2, unit);
        format!("median {median} (quartiles {quartiles}, range {range})")
    }

    /// Returns a warning if there are at least three values and the largest value is more than half
    /// of the sum of all values; otherwise `None`. `what` is the name of the quantity in the
    /// sentence.
    pub fn warning(&self, what: &str) -> Option<String> {
        let share = self.share_of_largest()?;
        if self.count <= 2 || share <= MOST_OF_ONE {
            return None;
        }
        let percent = format_rounded(100.0 * share, 2, "1");
        Some(format!(
            "One profile makes {percent} % of the mean of {what}: the median is the better guide."
        ))
    }

    /// Returns the largest value of the quantity, divided by the sum of its values on all profiles;
    /// `None` if a value is negative or the sum is zero.
    pub fn share_of_largest(&self) -> Option<f64> {
        let (least, most) = self.range;
        let share = most / (self.mean * self.count as f64);
        (least >= 0.0 && share.is_finite()).then_some(share)
    }

    /// Returns the lower and the upper end of the 95 % confidence interval of the mean over the
    /// profiles. If there is only one value, both ends are this value.
    pub fn ends(&self) -> (f64, f64) {
        self.confidence_interval().unwrap_or((self.mean, self.mean))
    }

    /// Returns the 95 % confidence interval of the mean over the profiles; `None` for a single
    /// value.
    pub fn confidence_interval(&self) -> Option<(f64, f64)> {
        self.spread.map(|spread| spread.confidence_interval)
    }
}

/// Returns an interval around the mean with the half-width `half`. Without bounds, `half` is added
/// to the mean and subtracted from it. With one bound, this is done with the logarithm of the
/// distance of the mean from the bound. With two bounds, it is done with the logarithm of the ratio
/// of the two distances. The interval therefore never reaches a bound.
fn interval(mean: f64, half: f64, bounds: (f64, f64)) -> (f64, f64) {
    let (least, most) = bounds;
    // Rounding errors may have moved the mean itself to a bound or beyond.
    if mean - least <= 0.0 || most - mean <= 0.0 {
        return (mean, mean);
    }
    (moved(mean, -half, bounds), moved(mean, half, bounds))
}

/// Returns the mean moved by about `step`, but never to a bound or beyond; see [`interval`].
fn moved(mean: f64, step: f64, bounds: (f64, f64)) -> f64 {
    let (least, most) = bounds;
    let above = mean - least;
    let below = most - mean;
    if !above.is_finite() {
        return mean + step;
    }
    if !below.is_finite() {
        return least + above * (step / above).exp();
    }
    let odds = above / below * (step / above + step / below).exp();
    most - (most - least) / (1.0 + odds)
}

/// Returns an interval that contains the median of the distribution in about 95 of 100 cases, for
/// any distribution. `ascending` are the values in ascending order. `None` for fewer than 4 values.
pub(crate) fn median_interval(ascending: &[f64]) -> Option<(f64, f64)> {
    let count = ascending.len();
    if count < FEWEST {
        return None;
    }
    let half = HALF / (count as f64).sqrt();
    quantile(ascending, 0.5 - half).zip(quantile(ascending, 0.5 + half))
}

/// Number of random profiles in each [regime](Regime) of adhesion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RegimeCounts {
    /// Number of profiles with pressure-insensitive adhesion.
    pub pressure_insensitive: usize,
    /// Number of profiles with pressure-sensitive adhesion.
    pub pressure_sensitive: usize,
    /// Number of profiles in the regime [`Regime::NonAdhesive`].
    pub non_adhesive: usize,
    /// Number of profiles whose regime is unknown because the force on the body is never negative.
    pub none: usize,
}

impl RegimeCounts {
    /// Counts the profiles in each regime. `regimes` has the regime of each profile; `None` is
    /// counted in [`RegimeCounts::none`].
    pub fn of(regimes: impl Iterator<Item = Option<Regime>>) -> Self {
        let mut counts = [0; 4];
        for regime in regimes {
            counts[regime.map_or(3, |regime| regime as usize)] += 1;
        }
        let [pressure_insensitive, pressure_sensitive, non_adhesive, none] = counts;
        RegimeCounts {
            pressure_insensitive,
            pressure_sensitive,
            non_adhesive,
            none,
        }
    }

    /// Returns the number of profiles in each known regime, in the order of [`Regime::ALL`].
    fn known(self) -> [usize; 3] {
        [
            self.pressure_insensitive,
            self.pressure_sensitive,
            self.non_adhesive,
        ]
    }

    /// Returns the number of all counted profiles, including those of unknown regime.
    pub fn profiles(self) -> usize {
        self.known().iter().sum::<usize>() + self.none
    }

    /// Returns the most frequent regime and the number of profiles in this regime. `None` if no
    /// regime is known.
    ///
    /// ```
    /// use asperity_scene::Regime;
    /// use asperity_study::RegimeCounts;
    ///
    /// let regimes = [
    ///     Some(Regime::NonAdhesive),
    ///     Some(Regime::PressureSensitive),
    ///     Some(Regime::NonAdhesive),
    ///     None,
    /// ];
    /// let counts = RegimeCounts::of(regimes.into_iter());
    /// assert_eq!(
    ///     (counts.profiles(), counts.most()),
    ///     (4, Some((Regime::NonAdhesive, 2)))
    /// );
    /// ```
    pub fn most(self) -> Option<(Regime, usize)> {
        self.ordered()[0]
    }

    /// Returns the second most frequent regime if the profiles disagree; otherwise `None`. The
    /// profiles disagree if less than three quarters of the profiles of known regime are in the
    /// most frequent regime.
    pub fn split(self) -> Option<Regime> {
        let [most, second, _] = self.ordered();
        let agree = self.shares()?[most?.0 as usize] >= AGREEING_SHARE;
        second.filter(|_| !agree).map(|(regime, _)| regime)
    }

    /// Returns the regimes that occur, each with its number of profiles, the largest number first.
    fn ordered(self) -> [Option<(Regime, usize)>; 3] {
        let mut counts = [0, 1, 2].map(|place| (Regime::ALL[place], self.known()[place]));
        // The sorting keeps the order of regimes with equal numbers of profiles, so the regime with
        // more adhesion remains first.
        counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        counts.map(|counted| Some(counted).filter(|(_, count)| *count > 0))
    }

    /// Returns the regimes that occur, each as its name and its number of profiles. Profiles of
    /// unknown regime have the name `not known`.
    pub fn present(self) -> impl Iterator<Item = (&'static str, usize)> {
        let counts = self.known().into_iter().chain([self.none]);
        let names = Regime::ALL
            .map(Regime::name)
            .into_iter()
            .chain(["not known"]);
        names.zip(counts).filter(|(_, count)| *count > 0)
    }

    /// Returns for each regime, in the order of [`Regime::ALL`], its share of the profiles of known
    /// regime; `None` if no regime is known.
    pub fn shares(self) -> Option<[f64; 3]> {
        let all: usize = self.known().iter().sum();
        (all > 0).then(|| self.known().map(|count| count as f64 / all as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    /// Returns a random number with nearly the standard normal distribution: the sum of twelve
    /// uniform numbers minus its mean. The variance of the sum is 12 · 1/12 = 1.
    fn normal(random: &mut ChaCha8Rng) -> f64 {
        (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0
    }

    /// Draws random samples and returns two shares: the share of samples whose confidence interval
    /// contains the true median, and the same for the true mean. Each sample has `count` log-normal
    /// forces; `deviation` is the standard deviation of their logarithm.
    fn shares_held(count: usize, deviation: f64, samples: u32) -> [f64; 2] {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let truths = [1.0, (0.5 * deviation * deviation).exp()];
        let mut held = [0_u32; 2];
        for _ in 0..samples {
            let forces = (0..count)
                .map(|_| (deviation * normal(&mut random)).exp())
                .collect();
            let all = Statistics::of(forces, (0.0, f64::INFINITY)).unwrap();
            let intervals = [all.median_interval.unwrap(), all.ends()];
            for ((held, (low, high)), truth) in held.iter_mut().zip(intervals).zip(truths) {
                *held += u32::from(low <= truth && truth <= high);
            }
        }
        held.map(|held| f64::from(held) / f64::from(samples))
    }

    /// The confidence interval of the median contains the true median in about 95 of 100 samples,
    /// however skewed the forces are. The interval of the mean is as good only for forces that
    /// scatter little, as its documentation states.
    #[test]
    fn intervals_hold_the_median_always_and_the_mean_of_forces_that_scatter_little() {
        for count in [8, 16, 32, 128] {
            for deviation in [0.3, 1.5] {
                let [median, mean] = shares_held(count, deviation, 2000);
                assert!(
                    (0.915..0.975).contains(&median),
                    "{count} {deviation}: median {median}"
                );
                let is_near = (0.92..0.97).contains(&mean);
                assert!(
                    is_near || deviation > 1.0,
                    "{count} {deviation}: mean {mean}"
                );
                assert!(
                    mean < 0.9 || deviation < 1.0 || count > 32,
                    "{count} {deviation}: mean {mean}"
                );
            }
        }
        assert_eq!(
            Statistics::of(vec![1.0; 3], (0.0, 2.0))
                .unwrap()
                .median_interval,
            None
        );
    }

    #[test]
    fn what_is_no_number_is_missing() {
        let all = Statistics::of(vec![f64::NAN, 2.0, f64::INFINITY, 4.0], (0.0, 100.0)).unwrap();
        assert_eq!((all.count, all.mean, all.range), (2, 3.0, (2.0, 4.0)));
        assert_eq!(Statistics::of(vec![f64::NAN], (0.0, 100.0)), None);
    }

    #[test]
    fn quartiles_lie_between_neighbours() {
        for (values, quartiles) in [
            (vec![4.0, 1.0, 2.0, 3.0, 100.0], [2.0, 3.0, 4.0]),
            (vec![2.0, 1.0], [1.25, 1.5, 1.75]),
            (vec![7.0], [7.0; 3]),
        ] {
            assert_eq!(
                Statistics::of(values, (0.0, 100.0)).unwrap().quartiles,
                quartiles
            );
        }
    }

    #[test]
    fn a_cell_has_the_regime_of_most_of_its_profiles() {
        let [insensitive, sensitive, non_adhesive] = Regime::ALL;
        for (counts, most, split) in [
            ([0, 0, 0, 2], None, None),
            ([0, 5, 0, 1], Some((sensitive, 5)), None),
            ([0, 3, 1, 0], Some((sensitive, 3)), None),
            ([3, 0, 7, 0], Some((non_adhesive, 7)), Some(insensitive)),
            ([0, 1, 1, 0], Some((sensitive, 1)), Some(non_adhesive)),
            ([2, 0, 2, 1], Some((insensitive, 2)), Some(non_adhesive)),
        ] {
            let all = Regime::ALL.map(Some).into_iter().chain([None]).zip(counts);
            let counts = RegimeCounts::of(
                all.flat_map(|(regime, count)| std::iter::repeat_n(regime, count)),
            );
            assert_eq!((counts.most(), counts.split()), (most, split), "{counts:?}");
        }
    }

    #[test]
    fn a_small_sample() {
        let of = |values: &[f64], bounds| Statistics::of(values.to_vec(), bounds);
        let all = of(
            &[5e-200, 1e-200, 3e-200],
            (f64::NEG_INFINITY, f64::INFINITY),
        )
        .unwrap();
        let near = |value: f64, expected: f64| (value / expected - 1.0).abs() < 1e-9;
        let Spread {
            standard_deviation,
            standard_error,
            confidence_interval,
        } = all.spread.unwrap();
        assert!(
            near(all.mean, 3e-200) && near(standard_deviation, 2e-200),
            "{all:?}"
        );
        assert_eq!((all.count, all.range), (3, (1e-200, 5e-200)));
        assert!(near(standard_error, 2e-200 / 3.0_f64.sqrt()));
        assert!(near(
            confidence_interval.1,
            3e-200 + 4.302_652_730 * 2e-200 / 3.0_f64.sqrt()
        ));
        assert_eq!(
            all.words("1"),
            "median 3e-200 (quartiles 2e-200 to 4e-200, range 1e-200 to 5e-200)"
        );
        let one = of(&[0.3], (0.0, 1.0)).unwrap();
        assert_eq!(
            (one.count, one.mean, one.range, one.spread),
            (1, 0.3, (0.3, 0.3), None)
        );
        assert_eq!(of(&[], (0.0, 1.0)), None);
        let zeros = of(&[0.0; 4], (0.0, 1.0)).unwrap();
        assert_eq!(
            (zeros.mean, zeros.confidence_interval()),
            (0.0, Some((0.0, 0.0)))
        );
    }

    #[test]
    fn intervals_keep_off_the_bounds_and_are_plain_where_they_are_narrow() {
        let (share, force, any) = (
            (0.0, 1.0),
            (0.0, f64::INFINITY),
            (f64::NEG_INFINITY, f64::INFINITY),
        );
        let wide = [0.0, 1e-9, 0.0, 0.9];
        for (values, bounds) in [(wide, share), (wide, force), ([1.0, 1.0, 1.0, 0.2], share)] {
            let all = Statistics::of(values.to_vec(), bounds).unwrap();
            let (low, high) = all.confidence_interval().unwrap();
            assert!(
                bounds.0 < low && low < all.mean && all.mean < high && high < bounds.1,
                "{all:?}"
            );
        }
        // The interval is symmetric in the logarithm of the force, so mean/low and high/mean are
        // equal.
        let all = Statistics::of(wide.to_vec(), force).unwrap();
        let (low, high) = all.confidence_interval().unwrap();
        assert!(
            (all.mean / low / (high / all.mean) - 1.0).abs() < 1e-9,
            "{all:?}"
        );
        let narrow = vec![0.5001, 0.4999, 0.5002, 0.4998];
        let ends = [share, force, any]
            .map(|bounds| Statistics::of(narrow.clone(), bounds).unwrap().ends());
        assert!(
            ends.iter()
                .all(|end| (end.0 - ends[2].0).abs() < 1e-7 && (end.1 - ends[2].1).abs() < 1e-7)
        );
        assert_eq!(
            Statistics::of(vec![0.0; 3], share).unwrap().ends(),
            (0.0, 0.0)
        );
    }

    #[test]
    fn one_profile_may_make_the_mean() {
        let of = |values: &[f64]| {
            Statistics::of(values.to_vec(), (0.0, 100.0))
                .unwrap()
                .warning("F_a")
        };
        let warning = "One profile makes 90 % of the mean of F_a: the median is the better guide.";
        assert_eq!(of(&[1.0, 0.0, 9.0]).as_deref(), Some(warning));
        for values in [
            &[1.0, 8.0, 7.0][..],
            &[0.0, 9.0],
            &[0.0; 4],
            &[-1.0, 0.0, 9.0],
        ] {
            assert_eq!(of(values), None);
        }
    }
}
