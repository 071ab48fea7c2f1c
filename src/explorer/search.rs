//! Search of lists by words, for parameters, commands and scenes.

use super::text::on_one_line;
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
    let mut found: Vec<(usize, usize)> = Vec::new();
    for (index, texts) in candidates.into_iter().enumerate() {
        let costs = words.iter().map(|word| cost(&texts, word));
        if let Some(total) = costs.sum::<Option<usize>>() {
            found.push((total, index));
        }
    }
    found.sort_unstable();
    found.into_iter().map(|(_, index)| index).collect()
}

/// How late and how badly texts have a word; `None` if no text has it. A worse rank in an earlier
/// text is better than any rank in a later one.
fn cost(texts: &[String], word: &str) -> Option<usize> {
    for (number, text) in texts.iter().enumerate() {
        if let Some(word_rank) = rank(text, word) {
            return Some(RANKS * number + word_rank);
        }
    }
    None
}

/// A query with the nearest word of the candidates in place of each word that none of them has;
/// `None` for a query without such a word, or if no word is near.
pub fn corrected(candidates: impl IntoIterator<Item = Vec<String>>, query: &str) -> Option<String> {
    if query.len() > LONGEST_QUERY {
        return None;
    }
    let texts: Vec<String> = candidates.into_iter().flatten().collect();
    let mut corrected = Vec::new();
    for word in query.split_whitespace() {
        let is_known = texts.iter().any(|text| rank(text, word).is_some());
        corrected.push(if is_known {
            word
        } else {
            nearest(word, words_of(&texts))?
        });
    }
    let corrected = corrected.join(" ");
    if corrected.is_empty() || corrected == on_one_line(query) {
        return None;
    }
    Some(corrected)
}

fn words_of(texts: &[String]) -> impl Iterator<Item = &str> {
    texts
        .iter()
        .flat_map(|text| text.split(|c: char| !c.is_alphanumeric()))
}

/// Rank of a word in a text: it is the whole text, its start, the start of a word, or inside. Upper
/// and lower case differ only for whole texts: `h` and `H`.
fn rank(text: &str, word: &str) -> Option<usize> {
    if text == word {
        return Some(0);
    }
    let text = text.to_lowercase();
    let word = word.to_lowercase();
    for (place, _) in text.match_indices(&word) {
        if place == 0 {
            return Some(1);
        }
        if !text[..place].ends_with(char::is_alphanumeric) {
            return Some(2);
        }
    }
    if text.contains(&word) { Some(3) } else { None }
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
