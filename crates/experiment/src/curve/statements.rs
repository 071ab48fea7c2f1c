//! Sentences on the points of a curve that are used, and on the noise and the drag of its force.

use crate::curve::drag::DragForce;
use crate::curve::free_parts::FreeParts;
use crate::curve::points::Points;
use crate::read::options::CurveOptions;
use asperity_data::{format_quantity, grouped};

/// Returns a sentence, for the report, on a drag that was subtracted from the force.
pub(crate) fn drag_in_words(drag: &DragForce) -> String {
    let pressed = format_quantity(drag.pressed, "N");
    let pulled = format_quantity(drag.pulled, "N");
    match drag.reach {
        Some(reach) => {
            let reach = format_quantity(reach, "m");
            format!(
                "Drag of a fluid, −c/(h + h₀) with h₀ = {reach} by the parts without contact, was taken off: {pressed} on the \
                 approach and {pulled} on the retraction in contact."
            )
        }
        None => format!(
            "The force on the retraction is lower by {} than on the approach where nothing touches, as by drag: this was taken off \
             the retraction.",
            format_quantity(-drag.pulled, "N")
        ),
    }
}

/// Returns a phrase on how many means replace the points of the file; `None` if no points were
/// averaged.
pub(crate) fn means_in_words(points: &Points, averaged: usize) -> Option<String> {
    if averaged == 1 {
        return None;
    }
    let means = grouped(points.force.len() as u64);
    Some(format!("means of {averaged} points each, {means} of them"))
}

/// Returns a sentence on the noise of the force and on how it was determined.
pub(crate) fn noise_in_words(noise: f64, options: &CurveOptions, free: &FreeParts) -> String {
    let source = if options.noise.is_some() {
        "given"
    } else if free.before.is_some() {
        "that before contact"
    } else {
        "that after contact"
    };
    format!("Noise {}, {source}.", format_quantity(noise, "N"))
}

/// Returns phrases on the number of points that are used, on the number of points before or after
/// contact, and on the number of points of pauses. `kept` has the indices of the points that are
/// used.
pub(crate) fn counted(
    points: &Points,
    kept: &[usize],
    free: &FreeParts,
    options: &CurveOptions,
) -> Vec<String> {
    let count = points.counts.len();
    let place = match free.before {
        Some(before) if points.begins_with_approach() => {
            format!("{} before contact", points_of_file(points, 0..before))
        }
        _ => {
            let after = count - free.after..count;
            format!("{} after contact", points_of_file(points, after))
        }
    };
    let used = points_of_file(points, kept.iter().copied());
    let segments = segments_in_words(points, options);
    let mut words = vec![format!("{used} points used in {segments}, {place}")];
    if points.is_still.contains(&true) {
        let still = points_of_file(points, (0..count).filter(|index| points.is_still[*index]));
        words.push(format!("{still} of pauses left out"));
    }
    words
}

/// Returns, as a text, the number of points of the file that were averaged into the points at
/// `indices`.
fn points_of_file(points: &Points, indices: impl Iterator<Item = usize>) -> String {
    let count: usize = indices.map(|index| points.counts[index]).sum();
    grouped(count as u64)
}

/// Returns a phrase with the number of segments, or with the numbers of the segments that the
/// options choose.
fn segments_in_words(points: &Points, options: &CurveOptions) -> String {
    let last = points.last_segment();
    match &options.segments[..] {
        [] if points.segment[0] == last => "1 segment".to_owned(),
        [] => format!("{} segments", last + 1),
        [number] => format!("segment {number}"),
        several => {
            let numbers: Vec<String> = several.iter().map(ToString::to_string).collect();
            format!("segments {}", numbers.join(", "))
        }
    }
}
