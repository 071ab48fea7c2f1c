//! Text in figures: italic symbols, indices and exponents, SI prefixes, numbers.

use asperity_data::{format_rounded, grouped, printable, si_prefix};
use std::fmt;

/// Power of ten of the smallest SI prefix on an axis: femto.
const LEAST_POWER: i32 = -15;
/// Power of ten of the largest SI prefix on an axis: giga.
const LARGEST_POWER: i32 = 9;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Face {
    Upright,
    Italic,
    Index,
    Exponent,
}

/// Blank at which a line must not be broken. It is drawn as an ordinary blank.
const FIXED: char = '\u{a0}';

/// Text in a figure, which can contain italic symbols, indices and exponents. `to_string` returns
/// the text without typesetting, such as `F_a`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Label {
    runs: Vec<(Face, String)>,
}

impl Label {
    /// Creates a label of upright text. Control characters, such as line feeds, are escaped.
    pub fn plain(text: &str) -> Label {
        let mut label = Label::default();
        label.push(Face::Upright, &printable(text));
        label
    }

    /// Creates a label from a symbol, such as `F_a,max`. Letters become italic, and the text after
    /// `_` becomes an index.
    pub fn symbol(text: &str) -> Label {
        let mut label = Label::default();
        let text = printable(text);
        let mut characters = text.chars().peekable();
        while let Some(character) = characters.next() {
            if character == '_' {
                while let Some(next) =
                    characters.next_if(|next| next.is_alphanumeric() || *next == ',')
                {
                    label.push(Face::Index, next.encode_utf8(&mut [0; 4]));
                }
            } else if character.is_alphabetic() {
                label.push(Face::Italic, character.encode_utf8(&mut [0; 4]));
            } else {
                label.push(Face::Upright, character.encode_utf8(&mut [0; 4]));
            }
        }
        label
    }

    /// Creates a label from the name and the symbol of a quantity. Each of them may be empty.
    ///
    /// ```
    /// assert_eq!(asperity_plot::Label::quantity("preload", "F_n").to_string(), "preload F_n");
    /// ```
    pub fn quantity(name: &str, symbol: &str) -> Label {
        let space = if name.is_empty() || symbol.is_empty() {
            ""
        } else {
            " "
        };
        Label::plain(name).then(space).join(&Label::symbol(symbol))
    }

    /// Creates a label from the symbol of a quantity, or from its name in upright text if `symbol`
    /// is empty.
    pub fn symbol_or_name(symbol: &str, name: &str) -> Label {
        if symbol.is_empty() {
            Label::plain(name)
        } else {
            Label::symbol(symbol)
        }
    }

    /// Creates a label from a statement about a symbol, such as `H = 0.3`. The symbol is italic and
    /// the value is upright.
    pub fn statement(text: &str) -> Label {
        match text.split_once(" = ") {
            Some((symbol, value)) => statement("", symbol, value),
            None => Label::plain(text),
        }
    }

    pub fn power_of_ten(exponent: i32) -> Label {
        let mut label = Label::plain("10");
        label.push(Face::Exponent, &exponent.to_string());
        label
    }

    /// Appends upright text to the label, and returns the label.
    pub fn then(mut self, text: &str) -> Label {
        self.push(Face::Upright, &printable(text));
        self
    }

    pub fn join(mut self, other: &Label) -> Label {
        for (face, text) in &other.runs {
            self.push(*face, text);
        }
        self
    }

    pub fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    pub(crate) fn runs(&self) -> &[(Face, String)] {
        &self.runs
    }

    /// Returns the approximate width of the label in a wide sans-serif font, divided by the font
    /// size.
    pub fn width(&self) -> f64 {
        self.runs
            .iter()
            .flat_map(|(face, text)| text.chars().map(|c| width_of(*face, c)))
            .sum()
    }

    /// Divides the label into lines whose [`Self::width`] is at most `most`. Lines are broken at
    /// blanks where possible.
    pub fn wrapped(&self, most: f64) -> Vec<Label> {
        let mut lines = Vec::new();
        let mut line = Line::default();
        for (face, text) in &self.runs {
            for character in text.chars() {
                line.push(*face, character);
                if line.width > most && line.letters.len() > 1 {
                    let rest = line.split_off_rest();
                    lines.push(std::mem::replace(&mut line, rest));
                }
            }
        }
        lines.push(line);
        lines
            .into_iter()
            .map(Line::into_label)
            .filter(|line| !line.is_empty())
            .collect()
    }

    fn push(&mut self, face: Face, text: &str) {
        match self.runs.last_mut() {
            Some((last, run)) if *last == face => run.push_str(text),
            _ if text.is_empty() => {}
            _ => self.runs.push((face, text.to_owned())),
        }
    }
}

/// Letters of one line, while a label is divided into lines. `width` is the total width of the
/// letters, divided by the font size.
#[derive(Default)]
struct Line {
    letters: Vec<(Face, char)>,
    width: f64,
}

impl Line {
    fn push(&mut self, face: Face, character: char) {
        self.letters.push((face, character));
        self.width += width_of(face, character);
    }

    /// Removes the letters after the last blank and returns them as a new line. If the line has no
    /// ordinary blank, the last [`FIXED`] blank is used. If it has no fixed blank either, only the
    /// last letter is removed.
    fn split_off_rest(&mut self) -> Line {
        let last = |blank: char| {
            let is_blank = |(_, character): &(Face, char)| *character == blank;
            self.letters.iter().rposition(is_blank)
        };
        let end = match last(' ').or_else(|| last(FIXED)) {
            Some(blank) => blank + 1,
            None => self.letters.len() - 1,
        };
        let letters = self.letters.split_off(end);
        let width = letters
            .iter()
            .map(|(face, character)| width_of(*face, *character))
            .sum();
        Line { letters, width }
    }

    /// Returns the line as a label, without the blanks at its end.
    fn into_label(mut self) -> Label {
        while let Some((_, ' ' | FIXED)) = self.letters.last() {
            self.letters.pop();
        }
        let mut label = Label::default();
        for (face, character) in self.letters {
            label.push(face, character.encode_utf8(&mut [0; 4]));
        }
        label
    }
}

impl From<&str> for Label {
    fn from(text: &str) -> Label {
        Label::plain(text)
    }
}

impl fmt::Display for Label {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (face, text) in &self.runs {
            match face {
                Face::Upright | Face::Italic => out.write_str(&text.replace(FIXED, " "))?,
                Face::Index => write!(out, "_{text}")?,
                Face::Exponent => {
                    for character in text.chars() {
                        write!(out, "{}", raised(character))?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Size of the letters of indices and exponents, divided by the font size.
pub(crate) const SMALL: f64 = 0.72;

/// Returns the approximate width of a character, divided by the font size, in a wide sans-serif
/// font.
fn width_of(face: Face, character: char) -> f64 {
    let width = match character {
        'i' | 'j' | 'l' | '.' | ',' | ' ' | FIXED | '/' | '|' => 0.33,
        't' | 'f' | 'r' | '(' | ')' => 0.4,
        'm' | 'w' | 'M' | 'W' => 0.95,
        '=' | '+' | '±' | '×' => 0.84,
        letter if letter.is_uppercase() => 0.72,
        _ => 0.636,
    };
    match face {
        Face::Index | Face::Exponent => SMALL * width,
        Face::Upright | Face::Italic => width,
    }
}

/// Returns a digit or a minus sign as a superscript.
fn raised(character: char) -> char {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    match character {
        '-' => '⁻',
        c => c.to_digit(10).map_or(c, |digit| DIGITS[digit as usize]),
    }
}

/// Chooses the SI prefix with which numbers up to `largest` have few digits. `largest` is in the
/// unit `unit`. Returns the divisor of the numbers and the unit with the prefix. For example, 0.02
/// N gives 1e-3 and `mN`.
pub fn prefixed(unit: &str, largest: f64) -> (f64, String) {
    if matches!(unit, "" | "1") {
        return (1.0, String::new());
    }
    let has_prefixes = ["N", "m", "J", "Pa", "J/m²", "N/m", "N/m²", "s"].contains(&unit);
    let is_positive = largest > 0.0 && largest.is_finite();
    if !has_prefixes || !is_positive {
        return (1.0, unit.into());
    }
    // Due to the small factor, 999.9999999 nm gives the prefix of 1 µm.
    let power = (largest * (1.0 + 1e-9)).log10().floor() as i32;
    let power = (3 * power.div_euclid(3)).clamp(LEAST_POWER, LARGEST_POWER);
    let prefix = si_prefix(power).unwrap_or_default();
    (10_f64.powi(power), format!("{prefix}{unit}"))
}

/// Writes a number with as many decimals as multiples of `step` need.
pub fn number(value: f64, step: f64) -> String {
    let decimals = (-step.abs().log10() - 1e-9).ceil().clamp(0.0, 12.0) as usize;
    let text = format!("{:.decimals$}", value.abs());
    let is_zero = text.chars().all(|digit| matches!(digit, '0' | '.'));
    let sign = if value < 0.0 && !is_zero { "-" } else { "" };
    let (whole, fraction) = text.split_at(text.find('.').unwrap_or(text.len()));
    let whole = whole.parse().map_or_else(|_| whole.to_owned(), grouped);
    format!("{sign}{whole}{fraction}")
}

/// Creates a label from a quantity and its value in the SI unit `unit`, such as `F_n = 12.5 µN`. If
/// `symbol` is empty, the label has the name instead, such as `preload 12.5 µN`.
pub fn value_label(name: &str, symbol: &str, unit: &str, value: f64) -> Label {
    let is_count = matches!(unit, "" | "1") && value.fract() == 0.0 && (0.0..1e8).contains(&value);
    let text = if is_count {
        grouped(value as u64)
    } else {
        format_rounded(value, 3, unit)
    };
    statement(name, symbol, &text)
}

/// Creates a label from a quantity and its value, which is given as text, such as `H = 0.3`. If
/// `symbol` is empty, the label has the name instead, such as `Hurst exponent 0.3`.
pub fn statement(name: &str, symbol: &str, value: &str) -> Label {
    let value = value.replace(' ', "\u{a0}");
    if symbol.is_empty() {
        Label::plain(name).then(&format!("{FIXED}{value}"))
    } else {
        Label::symbol(symbol).then(&format!("{FIXED}={FIXED}{value}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_are_split_into_runs() {
        let runs = |label: &Label| -> Vec<(Face, String)> { label.runs().to_vec() };
        assert_eq!(
            runs(&Label::symbol("F_a(d=0)/F_a,max")),
            [
                (Face::Italic, "F"),
                (Face::Index, "a"),
                (Face::Upright, "("),
                (Face::Italic, "d"),
                (Face::Upright, "=0)/"),
                (Face::Italic, "F"),
                (Face::Index, "a,max")
            ]
            .map(|(face, text)| (face, text.to_owned()))
        );
        assert_eq!(
            Label::symbol("F_a(d=0)/F_a,max").to_string(),
            "F_a(d=0)/F_a,max"
        );
        assert_eq!(Label::power_of_ten(-12).to_string(), "10⁻¹²");
        assert_eq!(
            runs(&Label::statement("H = 0.3"))[1],
            (Face::Upright, "\u{a0}=\u{a0}0.3".to_owned())
        );
        assert!(Label::plain("").is_empty() && Label::symbol("").is_empty());
        assert_eq!(Label::plain("a\u{1b}[2J\n").to_string(), "a\\u{1b}[2J\\n");
    }

    #[test]
    fn lines_break_between_words() {
        let label = Label::plain("one two ")
            .join(&Label::symbol("F_n"))
            .then(" three");
        let lines: Vec<String> = label.wrapped(6.0).iter().map(Label::to_string).collect();
        assert_eq!(lines, ["one two F_n", "three"]);
        assert!(label.wrapped(6.0).iter().all(|line| line.width() <= 6.0));
        let word = Label::plain("folder/file").wrapped(2.0);
        assert!(
            word.len() > 2 && word.iter().all(|line| line.width() <= 2.0),
            "{word:?}"
        );
        assert_eq!(
            value_label("", "F_n", "N", 2e-5).wrapped(3.0).len(),
            2,
            "one word, too long for a line"
        );
        assert!(Label::default().wrapped(5.0).is_empty());
    }

    #[test]
    fn prefixes_suit_the_largest_number() {
        assert_eq!(prefixed("N", 2.5e-5), (1e-6, "µN".into()));
        assert_eq!(prefixed("N", 1e-3), (1e-3, "mN".into()));
        assert_eq!(prefixed("J/m²", 0.05), (1e-3, "mJ/m²".into()));
        assert_eq!(prefixed("Pa", 2e6), (1e6, "MPa".into()));
        assert_eq!(prefixed("N", 1e-18).1, "fN");
        assert_eq!(prefixed("1", 1e-18), (1.0, String::new()));
        assert_eq!(prefixed("rad", 1e-3), (1.0, "rad".into()));
        assert_eq!(prefixed("N", 0.0), (1.0, "N".into()));
    }

    #[test]
    fn numbers_have_the_digits_they_need() {
        assert_eq!(number(0.30000000000000004, 0.1), "0.3");
        assert_eq!(number(-0.5, 0.05), "-0.50");
        assert_eq!(number(20.0, 10.0), "20");
        assert_eq!(number(-1e-18, 0.2), "0.0");
        assert_eq!(number(-16384.0, 1.0), "-16 384");
        let text = |symbol: &str, unit: &str, value| {
            value_label("points", symbol, unit, value).to_string()
        };
        assert_eq!(text("N", "1", 65536.0), "N = 65 536");
        assert_eq!(text("N", "1", -2.0), "N = -2");
        assert_eq!(text("", "N", 1.25e-5), "points 12.5 µN");
        assert_eq!(text("H", "", 0.12345), "H = 0.123");
    }
}
