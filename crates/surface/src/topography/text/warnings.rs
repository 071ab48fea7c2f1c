//! Warnings about heights that are far from all other heights. Such a height may mark a missing
//! point, or be a number that was cut off.

use crate::error::Place;
use asperity_data::{Note, Remedy, median};

/// Smallest distance of a height from the median of all heights with which the height counts as an
/// error of the file. It is in units of the median of all such distances.
const FAR: f64 = 1e6;

/// Smallest ratio of the largest distance of a height from the median to the next largest distance,
/// with which this height counts as an error of the file or a spike.
const ALONE: f64 = 30.0;

/// Limit that replaces [`ALONE`] for the last height if its line has no line end, because the
/// number may then be cut off.
const ALONE_AT_OPEN_END: f64 = 10.0;

/// Largest number of heights from which the medians are computed.
const SAMPLE: usize = 4096;

/// Returns a warning if some heights are far from all others; otherwise an empty list. The heights
/// are in the order of the file. `is_open` is true if the last line of the file has no line end, so
/// that its last number may be cut off.
pub(super) fn of_heights(
    heights: &[f64],
    is_open: bool,
    place: impl Fn(usize) -> Place,
) -> Vec<Note> {
    let Some(spread) = Spread::new(heights) else {
        return Vec::new();
    };
    let Farthest {
        index,
        largest,
        next,
    } = spread.farthest(heights);
    let last = heights.len() - 1;
    if is_open && index == last && next > 0.0 && largest > ALONE_AT_OPEN_END * next {
        let text = format!(
            "{}the last number, {:e}, is far from all others, and its line has no end: the file \
             may be cut off",
            place(last),
            heights[last]
        );
        return vec![Note::new(text)];
    }
    if next > 0.0 && largest > ALONE * next {
        let text = format!(
            "{}the height {:e} is {:.0e} times as far from the median as all others: a spike, a \
             mark of a missing point, or a number that is cut off",
            place(index),
            heights[index],
            largest / next
        );
        return vec![Note::new(text).with(Remedy::Robust)];
    }
    let mut far = (0..heights.len()).filter(|index| spread.is_far(heights[*index]));
    let Some(first) = far.next() else {
        return Vec::new();
    };
    let text = format!(
        "{}the height {:e} and {} others are more than {FAR:e} times as far from the median as \
         heights usually are: marks of missing points, or other units",
        place(first),
        heights[first],
        far.count()
    );
    vec![Note::new(text)]
}

/// Median of the heights, and median of the distances between the heights and this median.
struct Spread {
    level: f64,
    usual_distance: f64,
}

/// The height farthest from the median.
struct Farthest {
    index: usize,
    /// Distance of this height from the median.
    largest: f64,
    /// Second largest distance of a height from the median.
    next: f64,
}

impl Spread {
    /// Computes the medians from a sample of the heights; `None` if the sample has no finite
    /// height.
    fn new(heights: &[f64]) -> Option<Self> {
        let step = heights.len().div_ceil(SAMPLE).max(1);
        let mut sample: Vec<f64> = heights.iter().step_by(step).copied().collect();
        sample.retain(|height| height.is_finite());
        let level = median(&mut sample)?;
        for height in &mut sample {
            *height = (*height - level).abs();
        }
        Some(Spread {
            level,
            usual_distance: median(&mut sample).unwrap_or_default(),
        })
    }

    fn distance(&self, height: f64) -> f64 {
        (height - self.level).abs()
    }

    fn farthest(&self, heights: &[f64]) -> Farthest {
        let mut farthest = Farthest {
            index: 0,
            largest: 0.0,
            next: 0.0,
        };
        for (index, height) in heights.iter().enumerate() {
            if !height.is_finite() {
                continue;
            }
            let distance = self.distance(*height);
            if distance > farthest.largest {
                farthest = Farthest {
                    index,
                    largest: distance,
                    next: farthest.largest,
                };
            } else if distance > farthest.next {
                farthest.next = distance;
            }
        }
        farthest
    }

    fn is_far(&self, height: f64) -> bool {
        let usual = self.usual_distance;
        usual > 0.0 && self.distance(height) > FAR * usual
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_far_from_all_others_are_named() {
        let mut heights: Vec<f64> = (0..100)
            .map(|i| 1e-8 * (0.7 * f64::from(i * i)).sin())
            .collect();
        let warnings = |heights: &[f64], is_open| -> Vec<String> {
            let notes = of_heights(heights, is_open, |index| Place::Line(index + 3));
            notes.iter().map(Note::to_string).collect()
        };
        assert_eq!(warnings(&heights, true), [""; 0]);
        heights[99] = -2e-7;
        assert_eq!(warnings(&heights, false), [""; 0]);
        let cut = warnings(&heights, true);
        assert!(
            cut[0].starts_with(
                "line 102: the last number, -2e-7, is far from all others, and its line"
            ),
            "{cut:?}"
        );
        heights[50] = 4e-5;
        let alone = warnings(&heights, false);
        assert!(
            alone[0].starts_with("line 53: the height 4e-5 is 2e2 times as far from"),
            "{alone:?}"
        );
        (heights[20], heights[30], heights[40]) = (-9999.0, f64::NAN, -9999.0);
        let far = warnings(&heights, true);
        assert!(
            far[0].starts_with("line 23: the height -9.999e3 and 1 others are more than 1e6 times"),
            "{far:?}"
        );
        assert_eq!(
            (
                warnings(&[0.0, 0.0, 5.0], false),
                warnings(&[f64::NAN], true)
            ),
            (vec![], vec![])
        );
    }
}
