//! Words of shell commands.

use std::ffi::OsStr;

/// Returns `word` in a form that a POSIX shell reads as one word: in quotes if the shell needs
/// quotes.
pub fn quoted(word: impl AsRef<OsStr>) -> String {
    let word = word.as_ref().to_string_lossy();
    let is_plain = word
        .chars()
        .all(|sign| sign.is_alphanumeric() || "_-./:,+@%=".contains(sign));
    // zsh interprets a word that starts with = as the path of a command, so the word needs quotes.
    if !word.is_empty() && !word.starts_with('=') && is_plain {
        word.into_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn words_are_quoted_where_a_shell_would_read_something_else() {
        for (word, expected) in [
            ("./a/b_c.ron", "./a/b_c.ron"),
            ("C:/κ,1+2@3%4=5", "C:/κ,1+2@3%4=5"),
            ("", "''"),
            ("a b", "'a b'"),
            ("it's", r"'it'\''s'"),
            ("=ls", "'=ls'"),
            ("~/a", "'~/a'"),
            ("$HOME", "'$HOME'"),
            ("[Patches]", "'[Patches]'"),
        ] {
            assert_eq!(quoted(word), expected);
        }
    }

    #[cfg(unix)]
    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn a_shell_reads_the_words_that_were_meant(words in prop::collection::vec("[^\0]{0,20}|[ -~\n]{0,20}", 1..4)) {
            let all: Vec<String> = words.iter().map(quoted).collect();
            let script = format!("printf '%s\\0' {}", all.join(" "));
            let output = std::process::Command::new("sh").arg("-c").arg(script).output().unwrap();
            let text = String::from_utf8(output.stdout).unwrap();
            prop_assert_eq!(text.split_terminator('\0').collect::<Vec<_>>(), words);
        }
    }
}
