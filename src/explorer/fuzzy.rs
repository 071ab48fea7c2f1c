//! Search by letters: one matcher for parameters, commands, scenes and files.

/// The texts of one candidate of a search, in both lists the most important first.
#[derive(Clone, Debug, Default)]
pub struct Candidate {
    /// Names and symbols: letters of a word may be scattered over them.
    pub names: Vec<String>,
    /// Sentences, which have the letters of any word: a word counts only as a whole.
    pub prose: Vec<String>,
}

/// Indices of the candidates in which every word of a query occurs, the best first; equal candidates keep their
/// order. An empty query finds everything.
///
/// A query word counts most as a whole name, then at the start of a name, at the start of a word, inside; then in the
/// next text. Last are names with its letters in this order, most of them together or at starts of words. A query
/// longer than [`LONGEST_QUERY`] finds nothing.
pub fn find(candidates: impl IntoIterator<Item = Candidate>, query: &str) -> Vec<usize> {
    if query.len() > LONGEST_QUERY {
        return Vec::new();
    }
    let words: Vec<&str> = query.split_whitespace().collect();
    let cost = |(index, candidate): (usize, Candidate)| {
        let cost = words.iter().map(|word| cost(&candidate, word)).sum::<Option<usize>>()?;
        Some((cost, index))
    };
    let mut found: Vec<(usize, usize)> = candidates.into_iter().enumerate().filter_map(cost).collect();
    found.sort_unstable();
    found.into_iter().map(|(_, index)| index).collect()
}

/// Ascending indices of the characters of a candidate's text found by the words of a query: of a word that is whole in
/// any text of the candidate only whole matches, of another word its letters scattered over a name.
pub fn letters_found(candidate: &Candidate, text: &str, query: &str) -> Vec<usize> {
    let mut found: Vec<usize> =
        query.split_whitespace().flat_map(|word| found_by(candidate, text, word)).collect();
    found.sort_unstable();
    found.dedup();
    found
}

fn found_by(candidate: &Candidate, text: &str, word: &str) -> Vec<usize> {
    let (letters, mut texts) = (lower(word), candidate.names.iter().chain(&candidate.prose));
    let found: Vec<usize> = if texts.any(|other| place(other, word).is_some()) {
        place(text, word).map_or_else(Vec::new, |(_, start)| (start..start + letters.len()).collect())
    } else if !candidate.names.iter().any(|name| name == text) {
        Vec::new()
    } else {
        runs(text, &letters).filter(|(cost, _)| is_near(*cost, &letters)).map_or_else(Vec::new, |(_, at)| at)
    };
    // A letter may be two in lower case.
    let lowered =
        text.chars().enumerate().flat_map(|(index, letter)| letter.to_lowercase().map(move |_| index));
    let characters: Vec<usize> = lowered.collect();
    found.into_iter().filter_map(|letter| characters.get(letter).copied()).collect()
}

/// Longest query, bytes: longer than all names. Each letter is sought in all of them.
const LONGEST_QUERY: usize = 256;
/// Costs of a word in one text, from a whole text to a part of a word.
const PLACES: usize = 5;
/// Cost of scattered letters: more than that of any whole word, since no candidate has so many texts.
const SCATTERED: usize = 1000;
/// Largest cost of scattered letters above one per letter: a long text has nearly any letters somewhere.
const MOST_OVER_LETTERS: usize = 2;
/// Cost of a run of scattered letters at the start of a word, and inside one.
const RUN: (usize, usize) = (1, 3);

/// Least cost of a word in the texts of a candidate.
fn cost(candidate: &Candidate, word: &str) -> Option<usize> {
    let texts = candidate.names.iter().chain(&candidate.prose);
    let whole = |(number, text): (usize, &String)| Some(PLACES * number + place(text, word)?.0);
    let whole = texts.enumerate().find_map(whole);
    let letters = lower(word);
    let scattered = || {
        let costs = candidate.names.iter().filter_map(|name| Some(runs(name, &letters)?.0));
        costs.filter(|cost| is_near(*cost, &letters)).min()
    };
    whole.or_else(|| scattered().map(|cost| SCATTERED + cost))
}

fn is_near(cost: usize, letters: &[char]) -> bool {
    cost <= letters.len() + MOST_OVER_LETTERS
}

fn lower(text: &str) -> Vec<char> {
    text.chars().flat_map(char::to_lowercase).collect()
}

/// Place of a word in a text, below [`PLACES`], and its first letter: the whole text with its capitals, the whole
/// text, at its start, at the start of a word, anywhere.
fn place(text: &str, word: &str) -> Option<(usize, usize)> {
    if text == word {
        return Some((0, 0));
    }
    let (text, word) = (lower(text), lower(word));
    let starts = || (0..=text.len()).filter(|start| text[*start..].starts_with(&word));
    let first = starts().next()?;
    Some(match starts().find(|start| begins_word(&text, *start)) {
        _ if text.len() == word.len() => (1, first),
        _ if first == 0 => (2, first),
        Some(start) => (3, start),
        None => (4, first),
    })
}

/// Returns true if a word begins at this letter.
fn begins_word(text: &[char], at: usize) -> bool {
    at == 0 || !text[at - 1].is_alphanumeric()
}

/// Cheapest runs of these letters, in their order, in a text: the cost, and the place of each letter; `None` for a
/// text without such runs.
fn runs(text: &str, letters: &[char]) -> Option<(usize, Vec<usize>)> {
    let text = lower(text);
    if letters.len() > text.len() {
        return None;
    }
    // For each letter and each place of it the least cost of the letters so far, and the place of the letter before.
    let mut ends: Vec<Vec<Option<(usize, usize)>>> = Vec::new();
    for (number, letter) in letters.iter().enumerate() {
        let mut next = vec![None; text.len()];
        // The letters before at their least cost, all of them left of the place: cost, and place of the last.
        let mut before = (number == 0).then_some((0, 0));
        for (at, here) in text.iter().enumerate() {
            let last = at.checked_sub(1).and_then(|at| Some((ends.last()?[at]?.0, at)));
            before = before.into_iter().chain(last).min();
            if here == letter {
                let run = if begins_word(&text, at) { RUN.0 } else { RUN.1 };
                next[at] = last.into_iter().chain(before.map(|(cost, at)| (cost + run, at))).min();
            }
        }
        ends.push(next);
    }
    let costs = ends.last()?.iter().enumerate();
    let (cost, mut at) = costs.filter_map(|(at, end)| Some((end.as_ref()?.0, at))).min()?;
    let mut places = Vec::with_capacity(letters.len());
    for ends in ends.iter().rev() {
        places.push(at);
        at = ends[at]?.1;
    }
    places.reverse();
    Some((cost, places))
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

    #[test]
    fn letters_of_a_text_are_found_where_its_rank_is_from() {
        let rough = candidate(&["rough-sphere", "Sphère"], &["A rough sphere"]);
        let marked = |text: &str, query: &str| {
            let found = letters_found(&rough, text, query);
            let mark = |(at, letter)| if found.contains(&at) { letter } else { '.' };
            text.chars().enumerate().map(mark).collect::<String>()
        };
        assert_eq!(marked("rough-sphere", "sph"), "......sph...");
        assert_eq!(marked("rough-sphere", "sphere RO"), "ro....sphere");
        assert_eq!(marked("rough-sphere", "rghsph"), "r..gh.sph...", "scattered");
        assert_eq!(marked("Sphère", "sphère"), "Sphère");
        assert_eq!(marked("Sphère", "rough"), "......", "found in another text");
        assert_eq!(marked("A rough sphere", "rghsph"), "..............", "not over prose");
        assert_eq!(marked("h-hurst h", "hu"), ".........", "found nowhere");
        assert_eq!(marked("burrough rough", "rough"), ".........rough", "at the start of a word");
        assert_eq!(marked("rough-sphere", "zz"), "............");
        assert_eq!(marked("rough", ""), ".....");
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
            let found = runs(&text, &letters);
            prop_assert_eq!(found.as_ref().map(|(cost, _)| *cost), brute_force(&characters, &letters, 0, None));
            // The places have the letters, and cost as much.
            if let Some((cost, places)) = found {
                prop_assert!(places.is_sorted_by(|one, next| one < next));
                prop_assert!(places.iter().map(|at| &characters[*at]).eq(&letters));
                let starts = (0..places.len()).filter(|at| *at == 0 || places[at - 1] + 1 != places[*at]);
                let run = |at: usize| if begins_word(&characters, places[at]) { RUN.0 } else { RUN.1 };
                prop_assert_eq!(starts.map(run).sum::<usize>(), cost);
            }
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
                let scattered = runs(name, &letters).is_some_and(|(cost, _)| cost <= most);
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
