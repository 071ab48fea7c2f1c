//! Text for users: SI prefixes, grouped digits, line breaks, and the replacement of control
//! characters.
//!
//! Control characters in files and arguments can clear a screen, write to the clipboard or make the
//! XML of a picture invalid. Bidirectional control characters change the apparent order of text.
//! Both kinds of characters are replaced by their codes. All other characters are kept.

use std::borrow::Cow;
use std::path::Path;

/// SI prefixes that can be read, each with its power of ten. If several prefixes have the same
/// power, the first of these prefixes is used for writing.
pub(crate) const SI_PREFIXES: &[(&str, i32)] = &[
    ("y", -24),
    ("z", -21),
    ("a", -18),
    ("f", -15),
    ("p", -12),
    ("n", -9),
    ("µ", -6),
    ("μ", -6),
    ("u", -6),
    ("m", -3),
    ("c", -2),
    ("", 0),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
    ("P", 15),
    ("E", 18),
];

/// Returns the SI prefix for a power of ten, such as `k` for 3; `None` if the power has no prefix.
pub fn si_prefix(power: i32) -> Option<&'static str> {
    SI_PREFIXES
        .iter()
        .find(|(_, power_of_ten)| *power_of_ten == power)
        .map(|(prefix, _)| *prefix)
}

/// Returns `value` rounded to `digits` significant digits.
///
/// ```
/// assert_eq!(asperity_data::round_to(0.1 + 0.2, 12), 0.3);
/// ```
pub fn round_to(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1))
        .parse()
        .unwrap_or(value)
}

/// Rounds `value` upwards, to four significant digits.
pub fn rounded_up(value: f64) -> f64 {
    let nearest = round_to(value, 4);
    let last_digit = 10.0_f64.powi((value.abs().log10().floor() as i32).saturating_sub(3));
    if nearest >= value {
        nearest
    } else {
        round_to(value + last_digit, 4)
    }
}

/// Returns true for a character that could change how the text around it is displayed. Examples are
/// control characters, characters that change the direction of writing, and invisible characters.
pub fn is_control(c: char) -> bool {
    let bidirectional = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let invisible = matches!(
        c,
        '\u{ad}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180e}' | '\u{200b}' | '\u{2028}' | '\u{2029}'
            | '\u{2060}'..='\u{206f}' | '\u{3164}' | '\u{feff}' | '\u{ffa0}' | '\u{fff9}'..='\u{fffb}'
            | '\u{e0000}'..='\u{e0fff}'
    );
    c.is_control() || bidirectional || invisible
}

/// Replaces each character for which [`is_control`] is true by its code in Rust, such as `\n` or
/// `\u{1b}`. The result is one line.
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, is_control)
}

/// Replaces control characters by their codes, as [`printable`] does, but keeps line breaks.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |c| is_control(c) && c != '\n')
}

/// Returns a path as text on one line. Control characters are replaced as by [`printable`].
pub fn path_name(path: &Path) -> String {
    printable(&path.to_string_lossy()).into_owned()
}

fn escaped(text: &str, is_escaped: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&is_escaped) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if is_escaped(c) {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

/// Formats an integer with blanks between groups of three digits.
///
/// ```
/// assert_eq!(asperity_data::grouped(131_072), "131 072");
/// ```
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut grouped = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            grouped.push(' ');
        }
        grouped.push(digit);
    }
    grouped
}

/// Returns a number of things as text.
///
/// ```
/// assert_eq!(asperity_data::counted(1, "spring"), "1 spring");
/// assert_eq!(asperity_data::counted(1024, "spring"), "1 024 springs");
/// assert_eq!(asperity_data::counted(0, "patch"), "0 patches");
/// ```
pub fn counted(count: u64, noun: &str) -> String {
    format!("{} {}", grouped(count), plural(noun, count))
}

/// Returns the form of a noun for the number `count`.
///
/// ```
/// assert_eq!(asperity_data::plural("profile", 1), "profile");
/// assert_eq!(asperity_data::plural("profile", 16), "profiles");
/// ```
pub fn plural(noun: &str, count: u64) -> String {
    let ending = match noun {
        _ if count == 1 => "",
        _ if noun.ends_with("ch") => "es",
        _ => "s",
    };
    format!("{noun}{ending}")
}

/// Formats a number of bytes with a binary unit, such as `1.5 MiB`.
pub fn memory_size(bytes: u64) -> String {
    let units = ["B", "KiB", "MiB", "GiB", "TiB"];
    let mut size = bytes as f64;
    let mut unit = 0;
    while size >= 1024.0 && unit + 1 < units.len() {
        size /= 1024.0;
        unit += 1;
    }
    let decimals = usize::from(unit > 0 && size < 10.0);
    format!("{size:.decimals$} {}", units[unit])
}

/// Formats a relative error or a relative deviation in per cent: 0.02 becomes `2 %`. A value below
/// 0.00001 becomes `< 0.001 %`, and a value above 1 becomes `> 100 %`.
pub fn per_cent(error: f64) -> String {
    let per_cent = 100.0 * error;
    if per_cent > 100.0 {
        return "> 100 %".to_owned();
    }
    if per_cent < 1e-3 {
        return "< 0.001 %".to_owned();
    }
    let two_digits = round_to(per_cent, 2);
    let leads_with_one = format!("{two_digits:e}").starts_with('1');
    if leads_with_one {
        format!("{two_digits} %")
    } else {
        format!("{} %", round_to(per_cent, 1))
    }
}

/// Units, without prefixes. A line is not broken between a number and one of these units.
const UNITS: [&str; 9] = ["m", "N", "J", "J/m²", "Pa", "s", "B", "N/m", "%"];

/// Returns true for one of the [`UNITS`], with or without a prefix. Punctuation after the unit is
/// ignored.
fn is_unit(word: &str) -> bool {
    let word = word.trim_end_matches([',', ';', ':', '.', ')']);
    let without_prefix = word.strip_prefix([
        'q', 'r', 'y', 'z', 'a', 'f', 'p', 'n', 'µ', 'm', 'k', 'M', 'G', 'T', 'P', 'E',
    ]);
    // The letter i belongs to a binary prefix, such as Ki.
    let without_prefix = without_prefix.map(|unit| unit.trim_start_matches('i'));
    UNITS.contains(&word) || without_prefix.is_some_and(|unit| UNITS.contains(&unit))
}

/// Returns true if a text must not be broken into two lines between the words `word` and `next`.
/// This is so inside a number such as `16 384`, and between a number and a unit.
pub fn belong_together(word: &str, next: &str) -> bool {
    let digits = next.trim_end_matches([',', ';', ':', '.', ')']);
    let is_group = digits.len() == 3 && digits.bytes().all(|byte| byte.is_ascii_digit());
    word.ends_with(|c: char| c.is_ascii_digit()) && (is_group || is_unit(next))
}

/// Splits a text into words. A number and its unit are one word.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for next in text.split_whitespace() {
        match words.last_mut() {
            Some(word) if belong_together(word, next) => *word = format!("{word} {next}"),
            _ => words.push(next.to_owned()),
        }
    }
    words
}

/// Breaks a text into lines of at most `width` characters, between words if possible. Even for a
/// width of 0, each line has at least one character.
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    let width = width.max(1);
    let mut lines = Vec::new();
    let mut line = String::new();
    let mut room = width;
    for word in words(text) {
        let length = word.chars().count();
        let blank = usize::from(room < width);
        if length + blank > room && room < width {
            lines.push(std::mem::take(&mut line));
            room = width;
        }
        if room < width {
            line.push(' ');
            room -= 1;
        }
        for (index, character) in word.chars().enumerate() {
            if index > 0 && room == 0 {
                lines.push(std::mem::take(&mut line));
                room = width;
            }
            line.push(character);
            room -= 1;
        }
    }
    lines.push(line);
    lines
}

/// Number of characters after which [`shown`] cuts a value or a name.
const MOST_SHOWN: usize = 80;

/// Returns a text as error messages quote it, where the text comes from a file or a user: on one
/// line, and cut after 80 characters. Control characters are replaced as by [`printable`].
pub fn shown(text: &str) -> String {
    let start: String = text.chars().take(MOST_SHOWN).collect();
    let end = if start.len() < text.len() { "…" } else { "" };
    let start = start.replace(['\n', '\r', '\t'], " ");
    format!("{}{end}", printable(&start))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn control_characters_are_shown_and_do_nothing() {
        for (text, expected) in [
            ("\u{1b}]52;c;eA==\u{7}", "\\u{1b}]52;c;eA==\\u{7}"),
            ("a\u{9b}2Jb\u{7f}", "a\\u{9b}2Jb\\u{7f}"),
            ("abc\u{202e}nor.exe", "abc\\u{202e}nor.exe"),
            (
                "\u{2066}\u{200e}\u{200f}\u{61c}\u{2028}",
                "\\u{2066}\\u{200e}\\u{200f}\\u{61c}\\u{2028}",
            ),
            ("two\nlines\r", "two\\nlines\\r"),
            (
                "\u{ad}\u{180e}\u{3164}\u{fff9}\u{e0020}",
                "\\u{ad}\\u{180e}\\u{3164}\\u{fff9}\\u{e0020}",
            ),
            (
                "a\u{200b}b\u{feff}\u{2060}",
                "a\\u{200b}b\\u{feff}\\u{2060}",
            ),
        ] {
            assert_eq!(printable(text), expected);
        }
        assert_eq!(
            printable_lines("two\nlines\r\u{1b}"),
            "two\nlines\\r\\u{1b}"
        );
    }

    #[test]
    fn ordinary_text_of_any_script_stays() {
        // The joiner characters are not replaced, because they belong to the spelling of Persian
        // and Hindi and to compound emoji.
        for text in [
            "κ* = 0.6 µm",
            "نمونه\u{200c}ها",
            "क्\u{200d}ष",
            "👩\u{200d}🔬",
            "粗糙度",
            "שלום",
        ] {
            assert!(
                matches!(printable(text), Cow::Borrowed(same) if same == text),
                "{text}"
            );
        }
    }

    proptest! {
        #[test]
        fn nothing_printable_is_a_control(text in any::<String>()) {
            prop_assert!(!printable(&text).contains(is_control));
            prop_assert!(!printable_lines(&text).contains(|c| is_control(c) && c != '\n'));
        }
    }

    #[test]
    fn thousands_are_apart() {
        let counts = [0, 999, 1000, 16_384, 1_048_576];
        assert_eq!(
            counts.map(grouped),
            ["0", "999", "1 000", "16 384", "1 048 576"]
        );
    }

    #[test]
    fn lines_break_between_words() {
        assert_eq!(wrap("one two three", 7), ["one two", "three"]);
        assert_eq!(wrap("one two three", 5), ["one", "two", "three"]);
        assert_eq!(wrap("a  longword b", 4), ["a", "long", "word", "b"]);
        assert_eq!(wrap("µµµµ µµµµ", 4), ["µµµµ", "µµµµ"]);
        assert_eq!(wrap("", 4), [""]);
        assert_eq!(wrap("ab c", 0), ["a", "b", "c"]);
        assert_eq!(
            wrap("line 800.6 µs, tree 80.75 µs", 16),
            ["line 800.6 µs,", "tree 80.75 µs"]
        );
        assert_eq!(
            wrap("with 16 384 springs", 7),
            ["with", "16 384", "springs"]
        );
        assert_eq!(
            wrap("about 3 MiB of memory", 9),
            ["about", "3 MiB of", "memory"]
        );
        assert_eq!(wrap("1 of 3 days m", 6), ["1 of 3", "days m"]);
    }
}
