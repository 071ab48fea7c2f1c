//! Finding scenes by words.

use super::library::Entry;

/// The entries in which every word of a query occurs, in name, title or notice, upper and lower case
/// being the same; as indices, the best first.
///
/// A word counts most at the start of the name, then in the name, in the title, in the notice. All
/// words count alike, and entries that are as good as each other keep their order. An empty query
/// finds everything.
pub fn search(entries: &[Entry], query: &str) -> Vec<usize> {
    let query = query.to_lowercase();
    let words: Vec<&str> = query.split_whitespace().collect();
    let mut found: Vec<(usize, usize)> = entries
        .iter()
        .enumerate()
        .filter_map(|(index, entry)| Some((distance(entry, &words)?, index)))
        .collect();
    found.sort_unstable();
    found.into_iter().map(|(_, index)| index).collect()
}

/// How far from the start of the name the words are found, all together.
fn distance(entry: &Entry, words: &[&str]) -> Option<usize> {
    let [name, title, notice] = [&entry.name, &entry.title, &entry.notice].map(|text| text.to_lowercase());
    let place = |word: &&str| {
        let places =
            [name.starts_with(*word), name.contains(*word), title.contains(*word), notice.contains(*word)];
        places.iter().position(|found| *found)
    };
    words.iter().map(place).sum()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::library::Source;
    use super::*;

    fn entry(name: &str, title: &str, notice: &str) -> Entry {
        let (title, notice) = (title.to_string(), notice.to_string());
        let text = String::new();
        Entry { name: name.into(), origin: Source::Own, path: None, title, notice, text, error: None }
    }

    #[test]
    fn what_is_searched_is_found_by_its_name_first() {
        let entries = [
            entry("a", "b", "A smooth SPHERE"),
            entry("b", "The sphere", ""),
            entry("rough-sphere", "", ""),
            entry("sphere-rough", "", ""),
            entry("c", "Sphère", "rough"),
            entry("SPHERE", "", ""),
        ];
        assert_eq!(search(&entries, "sphere"), [3, 5, 2, 1, 0]);
        assert_eq!(search(&entries, " Rough  sphere "), [2, 3]);
        assert_eq!(search(&entries, "rough sph"), [2, 3, 4]);
        assert_eq!(search(&entries, "SPHÈRE"), [4]);
        assert!(search(&entries, "sphere nothing").is_empty());
        assert_eq!(search(&entries, " "), [0, 1, 2, 3, 4, 5]);
        assert!(search(&[], "a").is_empty());
    }

    proptest! {
        #[test]
        fn a_search_finds_what_has_the_words_and_keeps_the_order(
            texts in prop::collection::vec(("[abAB ]{0,4}", "[abAB ]{0,4}", "[abAB ]{0,4}"), 0..12),
            query in "[abAB ]{0,4}",
        ) {
            let entries: Vec<_> = texts.iter().map(|(name, title, notice)| entry(name, title, notice)).collect();
            let found = search(&entries, &query);
            let has = |text: &str, word: &str| text.to_lowercase().contains(&word.to_lowercase());
            for (index, (name, title, notice)) in texts.iter().enumerate() {
                let all = query.split(' ').all(|word| [name, title, notice].iter().any(|text| has(text, word)));
                prop_assert_eq!(found.contains(&index), all);
            }
            if query.trim().split(' ').count() == 1 && !query.trim().is_empty() {
                let word = query.trim().to_lowercase();
                let rank = |index: &usize| {
                    let (name, title, _) = &texts[*index];
                    match () {
                        () if name.to_lowercase().starts_with(&word) => 0,
                        () if has(name, &word) => 1,
                        () if has(title, &word) => 2,
                        () => 3,
                    }
                };
                prop_assert!(found.is_sorted_by_key(|index| (rank(index), *index)));
            }
        }
    }
}
