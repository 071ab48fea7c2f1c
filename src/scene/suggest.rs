//! The name of a list that is nearest to an unknown one.

/// Longest name that is compared; longer ones are not mistyped.
const LONGEST: usize = 64;

/// The nearest name, if it is near enough to be the intended one.
///
/// The last component of a name suffices: `hurst` means `roughness.hurst`.
pub(crate) fn nearest<'n>(name: &str, names: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    if name.is_empty() || name.len() > LONGEST {
        return None;
    }
    let short = last(name);
    let near = |candidate: &'n str| {
        let whole = near_enough(name, candidate).map(|far| 2 * far);
        // A match of the last component alone counts slightly less than one of the whole.
        let end = near_enough(short, last(candidate)).map(|far| 2 * far + 1);
        Some((whole.into_iter().chain(end).min()?, candidate))
    };
    names.into_iter().filter_map(near).min_by_key(|(far, _)| *far).map(|(_, candidate)| candidate)
}

fn last(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// The distance, if at most a third of the name is wrong.
fn near_enough(name: &str, candidate: &str) -> Option<usize> {
    let far = distance(name, candidate);
    (far <= (name.chars().count() / 3).max(1)).then_some(far)
}

/// Fewest insertions, deletions, exchanges and swaps of neighbours from one text to the other.
fn distance(one: &str, other: &str) -> usize {
    let one: Vec<char> = one.to_lowercase().chars().collect();
    let other: Vec<char> = other.to_lowercase().chars().collect();
    let mut before: Vec<usize> = vec![0; other.len() + 1];
    let mut above: Vec<usize> = (0..=other.len()).collect();
    for (i, a) in one.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, b) in other.iter().enumerate() {
            let mut least = (above[j + 1] + 1).min(row[j] + 1).min(above[j] + usize::from(a != b));
            if i > 0 && j > 0 && *a == other[j - 1] && one[i - 1] == *b {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut above, row);
    }
    above[other.len()]
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

    #[test]
    fn distances_are_counted() {
        for (one, other, expected) in
            [("", "abc", 3), ("abc", "abc", 0), ("abc", "acb", 1), ("kitten", "sitting", 3)]
        {
            assert_eq!(distance(one, other), expected);
        }
    }
}
