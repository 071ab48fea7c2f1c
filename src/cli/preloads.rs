//! Preloads on the command line: `1uN..20uN`, and their number.

use crate::scene::parse_quantity;
use crate::study::{Axis, PRELOADS};

/// Number of preloads by default.
const USUAL: usize = 64;

/// Parses a range of forces and, after a colon, the number of forces.
pub(super) fn parse_preloads(text: &str) -> Result<Axis, String> {
    let (from, to, count) = parse_range(text)?;
    Axis::of_preloads(from, to, count).ok_or_else(allowed)
}

/// Parses two forces, N, and the number of preloads between them.
pub(super) fn parse_range(text: &str) -> Result<(f64, f64, usize), String> {
    let (range, count) = text.split_once(':').map_or((text, None), |(range, count)| (range, Some(count)));
    let count = count.map_or(Ok(USUAL), |count| count.trim().parse().map_err(|_| allowed()))?;
    let (from, to) = range.split_once("..").ok_or_else(allowed)?;
    let force = |text: &str| parse_quantity(text, "N").map_err(|error| format!("{error}; {}", allowed()));
    let (from, to) = (force(from)?, force(to)?);
    Axis::of_preloads(from, to, count).map(|_| (from, to, count)).ok_or_else(allowed)
}

fn allowed() -> String {
    format!(
        "allowed: two forces of at least 0 N, the second one larger, and {} to {} as their number, such as \
         0..20uN or 1e-6..2e-5:64",
        PRELOADS.start(),
        PRELOADS.end()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn preloads_are_two_forces_and_a_number() {
        assert_eq!(parse_range("0..20uN"), Ok((0.0, 2e-5, 64)));
        assert_eq!(parse_range("1e-6 .. 2e-5:8"), Ok((1e-6, 2e-5, 8)));
        for wrong in
            ["", "1", "1..", "2..1", "1..1", "-1..1", "0..1:1", "0..1:513", "0..1:x", "0..1m/s", "0..inf"]
        {
            let error = parse_preloads(wrong).unwrap_err();
            assert!(error.contains("allowed: two forces"), "{wrong}: {error}");
        }
    }
}
