//! Shell command that opens a scene.

use std::ffi::OsStr;

/// Returns the command for a POSIX shell that opens the scene `name` in `program`. The command
/// changes fields by `--set`; each override is the path of a field and its new value.
///
/// ```
/// let overrides = [("form".to_string(), "Cone(angle: 0.1)".to_string())];
/// let command = asperity_scene::text::command_line("asperity", "jkr-sphere", &overrides);
/// assert_eq!(command, "asperity jkr-sphere --set 'form=Cone(angle: 0.1)'");
/// ```
pub fn command_line(program: &str, name: &str, overrides: &[(String, String)]) -> String {
    let mut sets = String::new();
    for (path, value) in overrides {
        let set = format!("{path}={value}");
        sets += &format!(" --set {}", quoted(set));
    }
    // A name that begins like an option must come after all options.
    if name.starts_with('-') {
        format!("{program}{sets} -- {}", quoted(name))
    } else {
        format!("{program} {}{sets}", quoted(name))
    }
}

/// Returns `word` as it must be written so that a POSIX shell reads it as one word. It is in quotes
/// if it needs them.
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
            ("[Fragments]", "'[Fragments]'"),
        ] {
            assert_eq!(quoted(word), expected);
        }
        let sets = [("form", "None"), ("title", "\"it's\"")]
            .map(|(path, value)| (path.into(), value.into()));
        let command = command_line("asperity", "a.ron", &sets);
        assert_eq!(
            command,
            r#"asperity a.ron --set form=None --set 'title="it'\''s"'"#
        );
        assert_eq!(
            command_line("asperity", "-a.ron", &sets[..1]),
            "asperity --set form=None -- -a.ron"
        );
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
