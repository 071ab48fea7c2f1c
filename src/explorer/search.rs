//! Search of lists by words, for parameters, commands and scenes.

use asperity_scene::text::nearest;

/// Limit of the length of a query, bytes: longer than all names. Each word is searched in all of
/// them.
const LONGEST_QUERY: usize = 256;
/// Number of ranks that a word can have in one text.
const RANKS: usize = 4;

/// Returns the indices of the candidates that contain every word of a query, the best first;
/// equally good candidates keep their order. The texts of a candidate are in the order of their
/// importance. An empty query finds everything, one longer than 256 bytes nothing.
pub fn find(candidates: impl IntoIterator<Item = Vec<String>>, query: &str) -> Vec<usize> {
    if query.len() > LONGEST_QUERY {
        return Vec::new();
    }
    let words: Vec<&str> = query.split_whitespace().collect();
    let cost = |(index, texts): (usize, Vec<String>)| {
        let of_word = |word: &&str| {
            let mut ranks = texts.iter().enumerate();
            ranks.find_map(|(number, text)| Some(RANKS * number + rank(text, word)?))
        };
        Some((words.iter().map(of_word).sum::<Option<usize>>()?, index))
    };
    let mut found: Vec<(usize, usize)> = candidates
        .into_iter()
        .enumerate()
        .filter_map(cost)
        .collect();
    found.sort_unstable();
    found.into_iter().map(|(_, index)| index).collect()
}

/// A query with the nearest word of the candidates in place of each word that none of them has;
/// `None` for a query without such a word, or if no word is near.
pub fn corrected(candidates: impl IntoIterator<Item = Vec<String>>, query: &str) -> Option<String> {
    if query.len() > LONGEST_QUERY {
        return None;
    }
    let texts: Vec<String> = candidates.into_iter().flatten().collect();
    let is_known = |word: &str| texts.iter().any(|text| rank(text, word).is_some());
    let known = || {
        texts
            .iter()
            .flat_map(|text| text.split(|c: char| !c.is_alphanumeric()))
    };
    let words = query.split_whitespace();
    let words = words.map(|word| {
        if is_known(word) {
            Some(word)
        } else {
            nearest(word, known())
        }
    });
    let corrected = words.collect::<Option<Vec<&str>>>()?.join(" ");
    (!corrected.is_empty() && corrected != query.split_whitespace().collect::<Vec<_>>().join(" "))
        .then_some(corrected)
}

/// Rank of a word in a text: it is the whole text, its start, the start of a word, or inside. Upper
/// and lower case differ only for whole texts: `h` and `H`.
fn rank(text: &str, word: &str) -> Option<usize> {
    if text == word {
        return Some(0);
    }
    let (text, word) = (text.to_lowercase(), word.to_lowercase());
    let begins_word = |(at, _): &(usize, &str)| !text[..*at].ends_with(char::is_alphanumeric);
    match text.match_indices(&word).find(begins_word) {
        Some((0, _)) => Some(1),
        Some(_) => Some(2),
        None => text.contains(&word).then_some(3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(texts: &[&str]) -> Vec<String> {
        texts.iter().map(|text| (*text).to_owned()).collect()
    }

    #[test]
    fn starts_of_words_come_first_and_names_before_prose() {
        let candidates = || {
            [
                texts(&["a", "b", "A smooth SPHERE"]),
                texts(&["b", "The sphere"]),
                texts(&["rough-sphere"]),
                texts(&["sphere-rough"]),
                texts(&["atmosphere"]),
                texts(&["SPHERE"]),
            ]
        };
        assert_eq!(find(candidates(), "sphere"), [3, 5, 2, 4, 1, 0]);
        assert_eq!(find(candidates(), " Rough  sphere "), [2, 3]);
        assert!(find(candidates(), "sphere nothing").is_empty());
        assert!(
            find(candidates(), "rghsph").is_empty(),
            "letters are not scattered"
        );
        assert_eq!(find(candidates(), " "), [0, 1, 2, 3, 4, 5]);
        assert!(find(candidates(), &"a".repeat(300)).is_empty());
        let near = |query: &str| corrected(candidates(), query);
        assert_eq!(near("shpere rough"), Some("SPHERE rough".to_owned()));
        assert_eq!(
            (near("sphere"), near("qqqqqq"), near("")),
            (None, None, None)
        );
        let symbols = || ["h", "H"].map(|symbol| texts(&[symbol]));
        assert_eq!(
            (find(symbols(), "h"), find(symbols(), "H")),
            (vec![0, 1], vec![1, 0])
        );
    }
}
