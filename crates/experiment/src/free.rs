//! The parts of a curve without contact: where they end, and the drift and the tilt of their force.

use crate::baseline::{Baseline, dot, ends, growing, right_angled, take_off};
use crate::statistics::correlated;

/// Smallest number of points without contact, and of points in contact.
pub(crate) const FEWEST: usize = 10;
const FEWEST_IN_CONTACT: usize = 4;
/// Least gain by a contact over a straight line. The gain is the number of points times the
/// decrease of the logarithm of the sum of squared residuals. A smaller gain is attributed to
/// noise.
const GAIN: f64 = 40.0;
/// Deviation of the last points from the line before them, in standard errors, above which these
/// points are in contact.
const DEVIATES: f64 = 4.0;
/// Values of n: the last n-th of the points without contact is compared with the points before.
const PARTS: [usize; 3] = [5, 10, 20];
/// A segment is in contact from its first point if two shares are exceeded: the slope of its
/// beginning by the first share of the slope in contact, and the change of the force before contact
/// by the second share of the range of the force.
const STEEP: f64 = 0.5;
const NOTABLE: f64 = 0.05;

/// Reason why a segment has no part without contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum NoBaseline {
    /// The segment has too few points: this number.
    Few,
    /// The segment is a straight line, with this range and this noise of the force in N.
    Straight(f64, f64),
    /// The force changes from the first point on.
    InContact,
}

/// Returns the number of values before contact at the beginning of a segment. The noise is assumed
/// to be at least `least`.
///
/// The contact begins where a straight line before it and a parabola behind it describe the segment
/// best. This place lies in the steep part of the contact. Its weak beginning is found by going
/// back until the last points no longer deviate from the line through the points before.
pub(crate) fn free_count(values: &[f64], least: f64) -> Result<usize, NoBaseline> {
    let count = values.len();
    if count < 2 * FEWEST {
        return Err(NoBaseline::Few);
    }
    let before = growing(values.iter().copied(), 2);
    let mut behind = growing(values.iter().rev().copied(), 3);
    behind.reverse();
    // Sums of squares below those of the least noise say nothing.
    let floor = count as f64 * least * least;
    let sum = |end: &usize| before[*end - 1] + behind[*end] + floor;
    let places = FEWEST..=count - FEWEST_IN_CONTACT;
    let best = places
        .min_by(|one, other| sum(one).total_cmp(&sum(other)))
        .unwrap_or(FEWEST);
    let whole = before[count - 1] + floor;
    if count as f64 * (whole / sum(&best)).ln() < GAIN {
        let (low, high) = ends(values.iter().copied());
        return Err(NoBaseline::Straight(
            high - low,
            Baseline::through(values).noise,
        ));
    }
    let free = without_weak_contact(values, best, least);
    let slope = Baseline::through(&values[..free]).slope.abs();
    let range = |values: &[f64]| -> f64 {
        let (low, high) = ends(values.iter().copied());
        high - low
    };
    let is_steep = slope > STEEP * range(&values[free..]) / (count - free) as f64;
    // A short part that is curved is the beginning of a contact.
    let is_curved = || {
        let curved = growing(values[..free].iter().copied(), 3)[free - 1] + floor;
        10 * free < count && free as f64 * ((before[free - 1] + floor) / curved).ln() > GAIN
    };
    if free <= FEWEST || is_steep && slope * free as f64 > NOTABLE * range(values) || is_curved() {
        return Err(NoBaseline::InContact);
    }
    Ok(free)
}

/// Reduces the number `free` of values without contact until the last of these values do not
/// deviate from the line through the values before.
fn without_weak_contact(values: &[f64], mut free: usize, least: f64) -> usize {
    let deviates = |free: usize, last: usize| {
        let line = Baseline::through(&values[..free - last]);
        let rests: Vec<f64> = line.rests(&values[..free]).collect();
        let (before, behind) = rests.split_at(free - last);
        let count = before.len() as f64;
        let mean = behind.iter().sum::<f64>() / last as f64;
        // The error of the line grows beyond its end.
        let ahead = 0.5 * free as f64;
        let variance = 1.0 / last as f64 + 1.0 / count + ahead * ahead * 12.0 / count.powi(3);
        mean.abs() > DEVIATES * line.noise.max(least) * (correlated(before) * variance).sqrt()
    };
    while free > 2 * FEWEST {
        let parts = PARTS.map(|part| (free / part).max(3));
        let Some(last) = parts
            .into_iter()
            .chain([1])
            .find(|last| deviates(free, *last))
        else {
            break;
        };
        free -= last.div_ceil(3);
    }
    free
}

/// Drift, tilt and step of the force without contact in N, each with a standard error. The drift is
/// the change from the first to the last point of the curve. The tilt is the change over the range
/// of the displacement. The step is the difference of the force after and before contact that
/// neither drift nor tilt explains.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Slopes {
    pub zero: f64,
    pub drift: (f64, f64),
    pub tilt: (f64, f64),
    pub step: (f64, f64),
}

impl Slopes {
    /// Fits the slopes that `is_asked` selects to points of (time, displacement, 1 after contact or
    /// 0 before, force). Time and displacement are shares of the whole curve. Slopes that are not
    /// selected are 0. Returns `None` if the points cannot separate the slopes.
    pub fn through(points: &[[f64; 4]], is_asked: [bool; 3]) -> Option<Slopes> {
        let column = |of: usize| points.iter().map(|point| point[of]).collect::<Vec<f64>>();
        let mut columns = vec![vec![1.0; points.len()]];
        columns.extend((0..3).filter(|of| is_asked[*of]).map(column));
        let mut found = least_squares(&columns, &column(3))?.into_iter();
        let zero = found.next()?.0;
        let mut slope = |of: usize| {
            if is_asked[of] {
                found.next()
            } else {
                Some((0.0, 0.0))
            }
        };
        Some(Slopes {
            zero,
            drift: slope(0)?,
            tilt: slope(1)?,
            step: slope(2)?,
        })
    }

    /// Returns the root mean square deviation of points from drift, tilt and step in N, and the
    /// deviation expected from the noise between neighbouring points.
    pub fn rest(points: &[[f64; 4]]) -> (f64, f64) {
        let column = |of: usize| points.iter().map(|point| point[of]).collect::<Vec<f64>>();
        let columns = [vec![1.0; points.len()], column(0), column(1), column(2)];
        let mut rests = column(3);
        right_angled(&columns).iter().for_each(|one| {
            take_off(&mut rests, one);
        });
        let changes: f64 = rests
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).powi(2))
            .sum();
        let count = rests.len() as f64;
        (
            (dot(&rests, &rests) / count).sqrt(),
            (0.5 * changes / count).sqrt(),
        )
    }
}

/// Returns least-squares coefficients of columns for these values, with standard errors; `None` if
/// a column depends on the columns before it.
pub(crate) fn least_squares(columns: &[Vec<f64>], values: &[f64]) -> Option<Vec<(f64, f64)>> {
    let basis = right_angled(columns);
    let mut rests = values.to_vec();
    let along: Vec<f64> = basis
        .iter()
        .map(|column| take_off(&mut rests, column))
        .collect();
    let count = (values.len().max(columns.len() + 1) - columns.len()) as f64;
    let noise = (correlated(&rests) * dot(&rests, &rests) / count).sqrt();
    // Back from the columns at right angles: each coefficient, and its share of each error.
    let mut found = vec![(0.0, 0.0); columns.len()];
    let triangle: Vec<Vec<f64>> = basis
        .iter()
        .map(|one| columns.iter().map(|column| dot(one, column)).collect())
        .collect();
    for index in (0..columns.len()).rev() {
        let own = triangle[index][index];
        if own.abs() <= 1e-6 * dot(&columns[index], &columns[index]).sqrt() {
            return None;
        }
        let others: f64 = (index + 1..columns.len())
            .map(|other| triangle[index][other] * found[other].0)
            .sum();
        let value = (along[index] - others) / own;
        // Squares of a row of the inverse of the triangle.
        let mut row = vec![0.0; columns.len()];
        row[index] = 1.0 / own;
        for other in index + 1..columns.len() {
            let sum: f64 = (index..other)
                .map(|between| row[between] * triangle[between][other])
                .sum();
            row[other] = -sum / triangle[other][other];
        }
        found[index] = (value, noise * dot(&row, &row).sqrt());
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    /// Values of a curve with normal noise of this standard deviation.
    fn noisy(values: impl Iterator<Item = f64>, noise: f64, seed: u64) -> Vec<f64> {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut gauss = || (0..12).map(|_| generator.random::<f64>()).sum::<f64>() - 6.0;
        values.map(|value| value + noise * gauss()).collect()
    }

    /// The force of a sphere without adhesion, 1 at the end, which touches after this share of the
    /// points.
    fn hertz(count: usize, touch: f64) -> impl Iterator<Item = f64> {
        let share =
            move |index: usize| (index as f64 / count as f64 - touch).max(0.0) / (1.0 - touch);
        (0..count).map(move |index| share(index).powf(1.5))
    }

    /// Noise of up to 5 % of the largest force hides no contact; the later the contact is found,
    /// the less of it exceeds the noise.
    #[test]
    fn contacts_are_found_under_noise() {
        for (count, seed) in [(200, 1), (200, 2), (200, 3), (500, 4), (500, 5), (500, 6)] {
            for noise in [0.001, 0.02, 0.05] {
                for touch in [0.3, 0.6] {
                    let values = noisy(hertz(count, touch), noise, seed);
                    let free = free_count(&values, 0.0).unwrap() as f64 / count as f64;
                    let late = touch + (1.0 - touch) * (1.5 * noise).powf(2.0 / 3.0) + 0.02;
                    assert!(
                        (touch - 0.15..late).contains(&free),
                        "{count} {noise} {touch}: {free}"
                    );
                }
                let snap = (0..count).map(|index| {
                    if 2 * index < count {
                        0.0
                    } else {
                        index as f64 / count as f64 - 0.95
                    }
                });
                let free = free_count(&noisy(snap, noise, seed), 0.0).unwrap();
                assert!(
                    free.abs_diff(count / 2) <= count / 20,
                    "{count} {noise}: {free}"
                );
            }
            let flat = noisy((0..count).map(|index| 0.01 * index as f64), 1.0, seed);
            assert!(
                matches!(free_count(&flat, 0.0), Err(NoBaseline::Straight(..))),
                "{count}"
            );
        }
    }

    /// In a force without noise, as of a computed curve, the contact begins exactly where the force
    /// does.
    #[test]
    fn a_contact_without_noise_begins_where_the_force_does() {
        let parabola: Vec<f64> = (0..100)
            .map(|index| (f64::from(index) - 59.0).max(0.0).powi(2))
            .collect();
        let free = free_count(&parabola, 0.0).unwrap();
        assert!((59..=62).contains(&free), "{free}");
    }

    /// A weak contact, a few times the noise, long before the strong one does not count as part
    /// without contact.
    #[test]
    fn weak_contact_is_not_part_of_the_noise() {
        for seed in 1..=6 {
            let force = |index: usize| {
                let weak = 0.02 * (index as f64 - 250.0).max(0.0) / 100.0;
                weak + (index as f64 - 400.0).max(0.0).powf(1.5) / 1000.0
            };
            let values = noisy((0..500).map(force), 0.002, seed);
            let free = free_count(&values, 0.0).unwrap();
            let noise = Baseline::through(&values[..free]).noise / 0.002;
            assert!((0.85..1.2).contains(&noise), "{seed}: {free} {noise}");
        }
    }

    #[test]
    fn coefficients_are_found_with_their_errors() {
        let columns: Vec<Vec<f64>> = (0..3)
            .map(|power| {
                (0..400)
                    .map(|index| (f64::from(index) / 400.0).powi(power))
                    .collect()
            })
            .collect();
        let value = |index: usize| 1.0 - 2.0 * columns[1][index] + 3.0 * columns[2][index];
        let found = least_squares(&columns, &noisy((0..400).map(value), 0.1, 7)).unwrap();
        for ((value, error), expected) in found.into_iter().zip([1.0, -2.0, 3.0]) {
            assert!(
                (value - expected).abs() < 3.0 * error && error < 0.1,
                "{value} ± {error}"
            );
        }
        assert_eq!(
            least_squares(&[columns[0].clone(), columns[0].clone()], &columns[1]),
            None
        );
    }
}
