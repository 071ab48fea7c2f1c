//! The name of a list that is nearest to an unknown one.

use strsim::osa_distance;

/// Longest name that is compared; longer ones are not mistyped.
const LONGEST: usize = 64;

/// The nearest name, if it is near enough to be the intended one.
///
/// The last component of a name suffices: `hurst` means `roughness.hurst`.
pub(crate) fn nearest<'n>(name: &str, names: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_lowercase();
    // At most a third of the name is wrong.
    let near_enough = |name: &str, candidate: &str| {
        Some(osa_distance(name, candidate)).filter(|far| *far <= (name.chars().count() / 3).max(1))
    };
    let near = |candidate: &'n str| {
        let whole = near_enough(&name.to_lowercase(), &candidate.to_lowercase()).map(|far| 2 * far);
        // A match of the last component alone counts slightly less than one of the whole.
        let end = near_enough(&last(name), &last(candidate)).map(|far| 2 * far + 1);
        Some((whole.into_iter().chain(end).min()?, candidate))
    };
    let names = names.into_iter().filter(|_| !name.is_empty() && name.len() <= LONGEST);
    names.filter_map(near).min_by_key(|(far, _)| *far).map(|(_, candidate)| candidate)
}

/// The question for the nearest name, behind a message: `; did you mean length?`. Empty if no name is near.
pub(crate) fn did_you_mean<'n>(name: &str, names: impl IntoIterator<Item = &'n str>) -> String {
    nearest(name, names).map_or_else(String::new, |near| format!("; did you mean {near}?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_suggested_and_far_ones_are_not() {
        let names = ["roughness.hurst", "adhesion.work", "numerics.points", "length"];
        for (name, expected) in [
            ("roughness.hurts", Some("roughness.hurst")),
            ("hurst", Some("roughness.hurst")),
            ("adhesion.Work", Some("adhesion.work")),
            ("lenght", Some("length")),
            ("points", Some("numerics.points")),
            ("nothing.like.it", None),
            ("", None),
        ] {
            assert_eq!(nearest(name, names), expected, "{name}");
        }
        assert_eq!(nearest(&"x".repeat(1_000_000), names), None);
    }
}
