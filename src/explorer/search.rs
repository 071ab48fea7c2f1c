//! Search for words in lists of parameters, commands and scenes.

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

/// Words without a meaning of their own. A search leaves them out, unless the query has no others.
const FILLERS: [&str; 18] = [
    "a", "an", "and", "as", "by", "for", "how", "i", "in", "into", "my", "of", "on", "show", "the",
    "to", "what", "with",
];

/// Result of a search for the words of the user.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Search {
    /// Indices of the candidates that contain all known words, the best first.
    pub found: Vec<usize>,
    /// Words that no candidate contains and that resemble no word of the candidates.
    pub unknown: Vec<String>,
    /// The words for which candidates were searched, if they differ from the typed words by the
    /// correction of a misspelt word.
    pub corrected: Option<String>,
}

impl Search {
    /// Searches the candidates for the words of a query. A word that no candidate contains is
    /// corrected if it is clearly a misspelling, otherwise it is left out and reported as unknown.
    /// A wrong guess would be worse than none, because it hides that nothing was found.
    pub fn new(candidates: &[Vec<String>], query: &str) -> Search {
        if query.len() > LONGEST_QUERY {
            return Search::default();
        }
        let texts = || candidates.iter().flatten();
        let mut words = Vec::new();
        let mut unknown = Vec::new();
        let mut is_corrected = false;
        for word in without_fillers(query) {
            let is_known = texts().any(|text| rank(text, word).is_some());
            if is_known {
                words.push(word);
                continue;
            }
            match misspelt(word, candidates) {
                Some(near) => {
                    words.push(near);
                    is_corrected = true;
                }
                None => unknown.push(word.to_owned()),
            }
        }
        let words = words.join(" ");
        let has_no_known_word = words.is_empty() && !unknown.is_empty();
        let found = if has_no_known_word {
            Vec::new()
        } else {
            find(candidates.iter().cloned(), &words)
        };
        Search {
            found,
            unknown,
            corrected: is_corrected.then_some(words),
        }
    }
}

/// Returns the words of a query without the words in [`FILLERS`], or all its words if it has no
/// others. A filler of one letter may be a symbol or a key, so it is kept if it is alone.
fn without_fillers(query: &str) -> Vec<&str> {
    let all: Vec<&str> = query.split_whitespace().collect();
    let mut words = all.clone();
    words.retain(|word| !FILLERS.contains(&word.to_lowercase().as_str()));
    if words.is_empty() { all } else { words }
}

/// Fewest letters of a word that is corrected. Shorter words resemble too many others.
const FEWEST_LETTERS: usize = 6;

/// Returns the word of the candidates that the user has clearly misspelt; `None` if there is none.
/// Such a word begins with the same letter and is at most one letter longer or shorter.
fn misspelt<'a>(word: &str, candidates: &'a [Vec<String>]) -> Option<&'a str> {
    let letters = word.chars().count();
    if letters < FEWEST_LETTERS {
        return None;
    }
    let mut near = Vec::new();
    for texts in candidates {
        near.extend(words_of(texts).filter(|near| {
            let has_same_start =
                near.to_lowercase().chars().next() == word.to_lowercase().chars().next();
            has_same_start && near.chars().count().abs_diff(letters) <= 1
        }));
    }
    nearest(word, near)
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
            vec![
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
        let search = |query: &str| Search::new(&candidates(), query);
        assert_eq!(search("shpere rough").corrected.unwrap(), "SPHERE rough");
        assert_eq!(search("shpere rough").found, [2, 3]);
        assert_eq!(search("the rough of a sphere").found, [2, 3]);
        assert_eq!(search("a").found, [0, 4], "a filler alone is a word");
        let unknown = search("qqqqqq sphere");
        assert_eq!(
            (unknown.unknown, unknown.found.len()),
            (vec!["qqqqqq".to_owned()], 6)
        );
        for (query, found) in [
            ("sphere", 6),
            ("qqqqqq", 0),
            ("spher", 6),
            ("sfere", 0),
            ("", 6),
        ] {
            let search = search(query);
            assert_eq!(
                (search.corrected, search.found.len()),
                (None, found),
                "{query}"
            );
        }
        let symbols = || ["h", "H"].map(|symbol| texts(&[symbol]));
        assert_eq!(
            (find(symbols(), "h"), find(symbols(), "H")),
            (vec![0, 1], vec![1, 0])
        );
    }
}
