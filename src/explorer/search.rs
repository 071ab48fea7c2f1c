//! Search for words in lists of parameters, commands and scenes.

use super::text::on_one_line;
use asperity_scene::text::nearest;

/// Largest length of a query in bytes. Every word of a query is searched in all texts, so that a
/// longer query would take a long time. No name has this length.
const LONGEST_QUERY: usize = 256;
/// Number of ranks: each describes how well a word matches a text, from 0 (best) to 3.
const RANKS: usize = 4;

/// Returns the indices of the candidates that contain every word of a query, the best first. Each
/// candidate consists of several texts, of which the first is the most important. Equally good
/// candidates keep their order. An empty query finds all candidates, and a query longer than 256
/// bytes finds none.
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

/// Returns a number that describes how well texts match a word; the smallest number is the best.
/// Any match in an earlier text is better than any match in a later text. `None` if no text
/// contains the word.
fn cost(texts: &[String], word: &str) -> Option<usize> {
    for (number, text) in texts.iter().enumerate() {
        if let Some(word_rank) = rank(text, word) {
            return Some(RANKS * number + word_rank);
        }
    }
    None
}

/// Returns the query with corrected words: each word that no candidate contains is replaced by the
/// most similar word of the candidates. `None` if nothing has to be corrected, or if there is no
/// similar word.
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

/// Returns how well a text matches a word, from the best to the worst: the word is the whole text,
/// the beginning of the text, the beginning of a word in the text, or the inside of a word. Upper
/// and lower case matter only if the word is the whole text, as in `h` and `H`.
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
