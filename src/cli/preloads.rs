//! Preloads on the command line: `1uN..20uN`, optionally with their number, and `log` for equal ratios.

use super::error::CliError;
use asperity_contact::Move;
use asperity_data::AxisScale;
use asperity_data::parse_quantity;
use asperity_scene::Simulation;
use asperity_scene::{CheckedScene, Document};
use asperity_study::Axis;

const USUAL: usize = 64;
const ALLOWED: &str = "allowed: two forces, and after colons the number of preloads and `log`, such as 0..20uN or 1e-8..1e-4:64:log";

/// Parses a range of forces and, after colons, the number of preloads and `log`.
pub(super) fn parse_preloads(text: &str) -> Result<Axis, String> {
    let mut parts = text.split(':').map(str::trim);
    let ends = parse_range(parts.next().unwrap_or_default())?;
    let (mut count, mut scale) = (USUAL, AxisScale::Linear);
    for part in parts {
        match part.parse() {
            Ok(number) => count = number,
            Err(_) if part == "log" => scale = AxisScale::Logarithmic,
            Err(_) => return Err(ALLOWED.into()),
        }
    }
    Axis::of_preloads(ends, count, scale)
}

/// Parses a range of two forces, N.
pub(super) fn parse_range(text: &str) -> Result<(f64, f64), String> {
    let (from, to) = text.split_once("..").ok_or(ALLOWED)?;
    let force = |text: &str| parse_quantity(text, "N").map_err(|error| format!("{error}; {ALLOWED}"));
    Ok((force(from)?, force(to)?))
}

/// Returns an error for preloads far beyond full contact of the scene.
pub(super) fn check_reach(
    document: &Document,
    scene: &CheckedScene,
    largest: f64,
    simulation: &mut Simulation,
) -> Result<(), CliError> {
    let reach = simulation.reach(scene).map_err(|error| CliError::named(document.name(), error))?;
    match reach.refusal(Move::ToForce(largest)) {
        Some(why) => Err(CliError::named(document.name(), format!("--preloads: {why}"))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn preloads_are_two_forces_a_number_and_a_scale() {
        let values = |text| parse_preloads(text).unwrap().values;
        assert_eq!(values("0..20uN").len(), 64);
        assert_eq!(values("-1e-6 .. 2e-6:4"), [-1e-6, 0.0, 1e-6, 2e-6]);
        for text in ["1nN..1uN:4:log", "1nN..1uN:log:4"] {
            let values = values(text);
            assert!(values.len() == 4 && (values[1] / 1e-8 - 1.0).abs() < 1e-12, "{values:?}");
        }
        for (wrong, allowed) in [
            ("", "two forces"),
            ("1", "two forces"),
            ("1..", "two forces"),
            ("0..1:x", "two forces"),
            ("0..1:-5", "two forces"),
            ("0..1m/s", "two forces"),
            ("0..inf", "two forces"),
            ("2..1", "`from` must be less than `to`"),
            ("1..1", "`from` must be less than `to`"),
            ("0..1:1", "allowed: from 2 to 512"),
            ("0..1:513", "allowed: from 2 to 512"),
            ("0..1:log", "begins above 0"),
            ("-1..1:log", "begins above 0"),
            ("0..1e31", "allowed: from -1e30 to 1e30 N"),
        ] {
            let error = parse_preloads(wrong).unwrap_err();
            assert!(error.contains(allowed), "{wrong}: {error}");
        }
    }
}
