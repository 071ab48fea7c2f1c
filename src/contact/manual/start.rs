//! The spans that fragments can fill within any set of springs.

use crate::contact::adhesive::Span;
use crate::contact::{ContactError, push, reserve};

/// The largest spans, all of whose neighbours have larger gaps, within these runs of springs, given by first and last
/// spring in any order; springs beyond the line are left out. They ascend along the line.
///
/// # Errors
/// [`ContactError::OutOfMemory`].
pub fn whole_spans(gaps: &[f64], runs: &[(usize, usize)]) -> Result<Vec<Span>, ContactError> {
    let mut sorted = reserve(runs.len())?;
    sorted.extend(runs.iter().filter(|&&(first, last)| first <= last && first < gaps.len()));
    sorted.sort_unstable();
    let mut spans = Vec::new();
    let mut open: Option<(usize, usize)> = None;
    for (first, last) in sorted {
        let last = last.min(gaps.len() - 1);
        match &mut open {
            Some((_, end)) if first <= *end + 1 => *end = last.max(*end),
            _ => {
                if let Some(run) = open.replace((first, last)) {
                    part(gaps, run, &mut spans)?;
                }
            }
        }
    }
    if let Some(run) = open {
        part(gaps, run, &mut spans)?;
    }
    Ok(spans)
}

/// Parts a run at the springs whose own spans reach beyond it: those with gaps above all others up to an end of the run
/// and the spring beyond. Among equal gaps the leftmost counts as the largest.
fn part(gaps: &[f64], (first, last): (usize, usize), spans: &mut Vec<Span>) -> Result<(), ContactError> {
    let mut highest = first.checked_sub(1).map_or(f64::INFINITY, |before| gaps[before]);
    let mut reaching: Vec<usize> = Vec::new();
    for (spring, &gap) in gaps.iter().enumerate().take(last + 1).skip(first) {
        if gap > highest {
            highest = gap;
            push(&mut reaching, spring, gaps.len())?;
        }
    }
    highest = gaps.get(last + 1).copied().unwrap_or(f64::INFINITY);
    for spring in (first..=last).rev() {
        if gaps[spring] >= highest {
            highest = gaps[spring];
            push(&mut reaching, spring, gaps.len())?;
        }
    }
    reaching.sort_unstable();
    reaching.dedup();
    let mut start = first;
    for end in reaching.into_iter().chain([last + 1]) {
        if start < end {
            let gap = gaps[start..end].iter().copied().fold(0.0, f64::max);
            push(spans, Span { gap, first: start, last: end - 1 }, gaps.len())?;
        }
        start = end + 1;
    }
    Ok(())
}
