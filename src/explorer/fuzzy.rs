//! Search by letters: one matcher for parameters, commands, scenes and files.

/// The texts of one candidate of a search, in both lists the most important first.
#[derive(Clone, Debug, Default)]
pub struct Candidate {
    /// Names and symbols: letters of a word may be scattered over them.
    pub names: Vec<String>,
    /// Sentences, which have the letters of any word: a word counts only where it stands whole.
    pub prose: Vec<String>,
}

/// Indices of the candidates in which every word of a query occurs, the best first; candidates that are as good as
/// each other keep their order. An empty query finds everything.
///
/// A word counts most as a whole name, then at its start, at the start of a word, inside; then in the next text. Last
/// are names that have its letters in this order, most of them together or at the starts of words.
pub fn find(candidates: impl IntoIterator<Item = Candidate>, query: &str) -> Vec<usize> {
    let words: Vec<&str> = query.split_whitespace().collect();
    let cost = |(index, candidate): (usize, Candidate)| {
        let cost = words.iter().map(|word| cost(&candidate, word)).sum::<Option<usize>>()?;
        Some((cost, index))
    };
    let mut found: Vec<(usize, usize)> = candidates.into_iter().enumerate().filter_map(cost).collect();
    found.sort_unstable();
    found.into_iter().map(|(_, index)| index).collect()
}

/// Costs of a word in one text, from a whole text to a part of a word.
const PLACES: usize = 5;
/// Cost of scattered letters: more than that of any whole word, since no candidate has so many texts.
const SCATTERED: usize = 1000;
/// Most cost of scattered letters beside one for each letter: nearly any letters are somewhere in a long text.
const MOST_OVER_LETTERS: usize = 2;
/// Cost of a run of scattered letters at the start of a word, and inside one.
const RUN: (usize, usize) = (1, 3);

/// Least cost of a word in the texts of a candidate.
fn cost(candidate: &Candidate, word: &str) -> Option<usize> {
    let texts = candidate.names.iter().chain(&candidate.prose);
    let whole = |(number, text): (usize, &String)| Some(PLACES * number + place(text, word)?);
    let whole = texts.enumerate().find_map(whole);
    let letters = lower(word);
    let is_near = |cost: &usize| *cost <= letters.len() + MOST_OVER_LETTERS;
    let scattered = || candidate.names.iter().filter_map(|name| runs(name, &letters)).filter(is_near).min();
    whole.or_else(|| scattered().map(|cost| SCATTERED + cost))
}

fn lower(text: &str) -> Vec<char> {
    text.chars().flat_map(char::to_lowercase).collect()
}

/// Place of a word in a text, below [`PLACES`]: the whole text with its capitals, the whole text, at its start, at the
/// start of a word, anywhere.
fn place(text: &str, word: &str) -> Option<usize> {
    if text == word {
        return Some(0);
    }
    let (text, word) = (lower(text), lower(word));
    let starts = || (0..=text.len()).filter(|start| text[*start..].starts_with(&word));
    let first = starts().next()?;
    Some(match () {
        () if text.len() == word.len() => 1,
        () if first == 0 => 2,
        () if starts().any(|start| begins_word(&text, start)) => 3,
        () => 4,
    })
}

/// A word begins at this letter.
fn begins_word(text: &[char], at: usize) -> bool {
    at == 0 || !text[at - 1].is_alphanumeric()
}

/// Least cost of the runs in which a text has these letters in their order; `None` where it has not.
fn runs(text: &str, letters: &[char]) -> Option<usize> {
    let text = lower(text);
    // Least cost of the letters so far, with the last of them at each place.
    let mut ends: Vec<Option<usize>> = vec![None; text.len()];
    for (number, letter) in letters.iter().enumerate() {
        let mut next = vec![None; text.len()];
        // Least cost of the letters before, all of them left of the place.
        let mut before = (number == 0).then_some(0);
        for (at, here) in text.iter().enumerate() {
            let last = if number > 0 && at > 0 { ends[at - 1] } else { None };
            before = before.into_iter().chain(last).min();
            if here == letter {
                let run = if begins_word(&text, at) { RUN.0 } else { RUN.1 };
                next[at] = last.into_iter().chain(before.map(|cost| cost + run)).min();
            }
        }
        ends = next;
    }
    ends.into_iter().flatten().min()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn candidate(names: &[&str], prose: &[&str]) -> Candidate {
        let texts = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect();
        Candidate { names: texts(names), prose: texts(prose) }
    }

    #[test]
    fn a_name_comes_before_a_title_and_a_title_before_prose() {
        let candidates = || {
            [
                candidate(&["a", "b"], &["A smooth SPHERE"]),
                candidate(&["b", "The sphere"], &[""]),
                candidate(&["rough-sphere", ""], &[]),
                candidate(&["sphere-rough", ""], &[]),
                candidate(&["c", "Sphère"], &["rough"]),
                candidate(&["SPHERE", ""], &[]),
            ]
        };
        assert_eq!(find(candidates(), "sphere"), [5, 3, 2, 1, 0]);
        assert_eq!(find(candidates(), " Rough  sphere "), [2, 3]);
        assert_eq!(find(candidates(), "SPHÈRE"), [4]);
        assert_eq!(find(candidates(), "rghsph"), [2], "scattered over a name");
        assert_eq!(find(candidates(), "smsph"), [] as [usize; 0], "but not over prose");
        assert_eq!(find(candidates(), "sphere nothing"), [] as [usize; 0]);
        assert_eq!(find(candidates(), " "), [0, 1, 2, 3, 4, 5]);
        assert_eq!(find([], "a"), [] as [usize; 0]);
    }

    #[test]
    fn capitals_decide_between_symbols() {
        let symbols = || ["h", "H"].map(|symbol| candidate(&[symbol], &[]));
        assert_eq!((find(symbols(), "h"), find(symbols(), "H")), (vec![0, 1], vec![1, 0]));
    }

    #[test]
    fn starts_of_words_come_before_other_letters() {
        let names = ["work of adhesion", "wide pond", "rms height", "hurst exponent"];
        let candidates = || names.map(|name| candidate(&[name], &[]));
        assert_eq!(find(candidates(), "woa"), [0]);
        assert_eq!(find(candidates(), "wo"), [0, 1]);
        assert_eq!(find(candidates(), "he"), [2, 0, 3], "height, adhesion, hurst exponent");
    }

    /// All ways to choose the letters from the text, each with its cost.
    fn brute_force(text: &[char], letters: &[char], from: usize, last: Option<usize>) -> Option<usize> {
        let Some((letter, rest)) = letters.split_first() else { return Some(0) };
        let places = (from..text.len()).filter(|at| text[*at] == *letter);
        places
            .filter_map(|at| {
                let continues = at > 0 && last == Some(at - 1);
                let run = if at == 0 || !text[at - 1].is_alphanumeric() { RUN.0 } else { RUN.1 };
                let cost = if continues { 0 } else { run };
                Some(cost + brute_force(text, rest, at + 1, Some(at))?)
            })
            .min()
    }

    proptest! {
        #[test]
        fn the_cost_of_scattered_letters_is_the_least(text in "[ab -]{0,9}", letters in "[ab]{1,5}") {
            let (characters, letters): (Vec<char>, Vec<char>) = (text.chars().collect(), letters.chars().collect());
            prop_assert_eq!(runs(&text, &letters), brute_force(&characters, &letters, 0, None));
        }

        #[test]
        fn what_is_found_has_all_words_and_the_best_is_first(
            texts in prop::collection::vec(("[abAB ]{0,4}", "[abAB ]{0,4}"), 0..12),
            query in "[abAB ]{0,4}",
        ) {
            let candidates = texts.iter().map(|(name, prose)| candidate(&[name], &[prose]));
            let found = find(candidates, &query);
            let words: Vec<String> = query.split_whitespace().map(str::to_lowercase).collect();
            let has = |(name, prose): &(String, String), word: &String| {
                let letters = lower(word);
                let most = letters.len() + MOST_OVER_LETTERS;
                let scattered = runs(name, &letters).is_some_and(|cost| cost <= most);
                scattered || name.to_lowercase().contains(word.as_str()) || prose.to_lowercase().contains(word.as_str())
            };
            for (index, text) in texts.iter().enumerate() {
                prop_assert_eq!(found.contains(&index), words.iter().all(|word| has(text, word)));
            }
            if let [word] = &words[..] {
                let rank = |index: &usize| {
                    let (name, prose) = (texts[*index].0.to_lowercase(), texts[*index].1.to_lowercase());
                    match () {
                        () if name == *word => 0,
                        () if name.starts_with(word) => 1,
                        () if name.contains(word) => 2,
                        () if prose.contains(word) => 3,
                        () => 4,
                    }
                };
                prop_assert!(found.is_sorted_by_key(rank));
            }
        }
    }
}
