//! Search of lists by words: one matcher for parameters, commands and scenes.

/// Longest query, bytes: longer than all names. Each word is sought in all of them.
const LONGEST_QUERY: usize = 256;
/// Ranks of a word in one text: the whole text, its start, the start of a word, inside.
const RANKS: usize = 4;

/// Returns the indices of the candidates in which every word of a query occurs, the best first; equal candidates keep
/// their order. The texts of a candidate come in the order of their importance. An empty query finds everything, one
/// longer than 256 bytes nothing.
pub fn find(candidates: impl IntoIterator<Item = Vec<String>>, query: &str) -> Vec<usize> {
    if query.len() > LONGEST_QUERY {
        return Vec::new();
    }
    let words: Vec<&str> = query.split_whitespace().collect();
    let cost = |(index, texts): (usize, Vec<String>)| {
        let of_word = |word: &&str| {
            let mut ranks = texts.iter().enumerate();
            ranks.find_map(|(number, text)| Some(RANKS * number + place(text, word)?.0))
        };
        Some((words.iter().map(of_word).sum::<Option<usize>>()?, index))
    };
    let mut found: Vec<(usize, usize)> = candidates.into_iter().enumerate().filter_map(cost).collect();
    found.sort_unstable();
    found.into_iter().map(|(_, index)| index).collect()
}

/// Returns the indices of the characters of a text found by the words of a query, ascending.
pub fn letters_found(text: &str, query: &str) -> Vec<usize> {
    let of_word = |word: &str| {
        let (_, start) = place(text, word)?;
        Some(start..start + word.chars().count())
    };
    let mut found: Vec<usize> = query.split_whitespace().filter_map(of_word).flatten().collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Rank of a word in a text, below [`RANKS`], and the index of its first character. Capitals decide only between whole
/// texts: `h` and `H`.
fn place(text: &str, word: &str) -> Option<(usize, usize)> {
    if text == word {
        return Some((0, 0));
    }
    // A letter whose small form is several letters stays as it is: indices are those of the text.
    let lower = |text: &str| -> Vec<char> {
        let small = |letter: char| Some(letter.to_lowercase()).filter(|small| small.len() == 1)?.next();
        text.chars().map(|letter| small(letter).unwrap_or(letter)).collect()
    };
    let (text, word) = (lower(text), lower(word));
    let starts = || (0..=text.len()).filter(|start| text[*start..].starts_with(&word));
    let begins_word = |start: &usize| *start == 0 || !text[start - 1].is_alphanumeric();
    let start = starts().find(begins_word);
    Some(match start {
        Some(0) => (1, 0),
        Some(start) => (2, start),
        None => (3, starts().next()?),
    })
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
        assert!(find(candidates(), "rghsph").is_empty(), "letters are not scattered");
        assert_eq!(find(candidates(), " "), [0, 1, 2, 3, 4, 5]);
        assert!(find(candidates(), &"a".repeat(300)).is_empty());
        let symbols = || ["h", "H"].map(|symbol| texts(&[symbol]));
        assert_eq!((find(symbols(), "h"), find(symbols(), "H")), (vec![0, 1], vec![1, 0]));
    }

    #[test]
    fn letters_of_all_words_are_marked() {
        let marked = |text: &str, query: &str| {
            let found = letters_found(text, query);
            let mark = |(at, letter)| if found.contains(&at) { letter } else { '.' };
            text.chars().enumerate().map(mark).collect::<String>()
        };
        assert_eq!(marked("rough-sphere", "sphere RO"), "ro....sphere");
        assert_eq!(marked("burrough rough", "rough"), ".........rough", "at the start of a word");
        assert_eq!(marked("Sphère", "sphère"), "Sphère");
        assert_eq!(marked("İstanbul", "stan"), ".stan...");
        assert_eq!(marked("rough", "zz"), ".....");
    }
}
