//! Warnings of heights that are far from all others: marks of missing points, and numbers that are cut off.

use super::super::Place;

/// Least distance of a height from the median, in medians of these distances, that is an error of the file.
const FAR: f64 = 1e6;

/// Least distance of the last height from the median, in the largest one of all others, if its line has no end.
const FAR_AT_OPEN_END: f64 = 10.0;

/// Most heights from which the median follows.
const SAMPLE: usize = 4096;

/// Warnings of finite heights in the order of the file. `is_open` is true if the last line has no line end.
pub(super) fn of_heights(heights: &[f64], is_open: bool, place: impl Fn(usize) -> Place) -> Vec<String> {
    let step = heights.len().div_ceil(SAMPLE).max(1);
    let finite = heights.iter().step_by(step).copied().filter(|height| height.is_finite());
    let mut sample: Vec<f64> = finite.collect();
    let Some(level) = median(&mut sample) else { return Vec::new() };
    sample.iter_mut().for_each(|height| *height = (*height - level).abs());
    let usual = median(&mut sample).unwrap_or_default();
    let distance = |height: f64| (height - level).abs();
    let last = heights.len() - 1;
    let others = heights[..last].iter().filter(|height| height.is_finite());
    let most = others.fold(0.0_f64, |most, height| most.max(distance(*height)));
    let mut warnings = Vec::new();
    if is_open && most > 0.0 && distance(heights[last]) > FAR_AT_OPEN_END * most {
        warnings.push(format!(
            "{}the last number, {:e}, is far from all others, and its line has no end: the file may be cut off",
            place(last),
            heights[last]
        ));
        return warnings;
    }
    let is_far = |(_, height): &(usize, &f64)| usual > 0.0 && distance(**height) > FAR * usual;
    let mut far = heights.iter().enumerate().filter(is_far);
    if let Some((index, height)) = far.next() {
        let all = match far.count() {
            0 => String::new(),
            others => format!(" (like {others} others)"),
        };
        warnings.push(format!(
            "{}the height {height:e}{all} is more than {FAR:e} times as far from the median as heights usually are: a mark of a \
             missing point, or another unit",
            place(index)
        ));
    }
    warnings
}

fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_far_from_all_others_are_named() {
        let mut heights: Vec<f64> = (0..100).map(|i| 1e-8 * (0.7 * f64::from(i * i)).sin()).collect();
        let warnings =
            |heights: &[f64], is_open| of_heights(heights, is_open, |index| Place::Line(index + 3));
        assert_eq!(warnings(&heights, true), [""; 0]);
        heights[99] = -2e-7;
        assert_eq!(warnings(&heights, false), [""; 0]);
        let cut = warnings(&heights, true);
        assert!(
            cut[0].starts_with("line 102: the last number, -2e-7, is far from all others, and its line"),
            "{cut:?}"
        );
        heights[50] = 4e-5;
        let alone = warnings(&heights, false);
        assert!(alone[0].starts_with("line 53: the height 4e-5 is 2e2 times as far from"), "{alone:?}");
        (heights[20], heights[30], heights[40]) = (-9999.0, f64::NAN, -9999.0);
        let far = warnings(&heights, true);
        assert!(
            far[0].starts_with("line 23: the height -9.999e3 and 1 others are more than 1e6 times"),
            "{far:?}"
        );
        assert_eq!((warnings(&[0.0, 0.0, 5.0], false), warnings(&[f64::NAN], true)), (vec![], vec![]));
    }
}
