//! Plain text in aligned columns that fits a terminal of 80 columns.

use crate::text::printable;

/// Characters on a line: those of the smallest usual terminal.
pub(crate) const WIDTH: usize = 80;

/// Fewest characters of a last column, and how far in the column begins on a line of its own.
const FEWEST_IN_LAST: usize = 20;
const INDENT: usize = 4;

/// Characters before the values of rows.
const LABEL: usize = 26;

/// Text under headings: rows of a label and a value, and paragraphs.
#[derive(Default)]
pub(crate) struct Sheet {
    text: String,
}

impl Sheet {
    /// The text so far.
    pub(crate) fn into_text(self) -> String {
        self.text
    }

    /// A heading, with an empty line before it.
    pub(crate) fn heading(&mut self, heading: &str) {
        self.text.push('\n');
        self.paragraph(heading);
    }

    /// Text as long as it may be.
    pub(crate) fn paragraph(&mut self, text: &str) {
        for line in text.lines().flat_map(|line| wrap(line, WIDTH)) {
            self.line(&line);
        }
    }

    /// A row; a value too long for one line goes on below itself.
    pub(crate) fn row(&mut self, label: &str, value: impl AsRef<str>) {
        let mut label = label;
        for line in wrap(value.as_ref(), WIDTH - LABEL) {
            self.line(&format!("  {}{line}", padded(label, LABEL - 2)));
            label = "";
        }
    }

    /// A row, where there is a value.
    pub(crate) fn row_of(&mut self, label: &str, value: Option<String>) {
        if let Some(value) = value {
            self.row(label, value);
        }
    }

    /// Lines of cells below each other, all but the last column as wide as its widest cell. A last cell too long for its
    /// line goes on below itself, or begins on the next line where the other columns leave too little room.
    pub(crate) fn table<R: AsRef<[String]>>(&mut self, rows: &[R]) {
        let cell = |row: &R, column: usize| row.as_ref().get(column).map_or(0, |cell| cell.chars().count());
        let width = |column: usize| rows.iter().map(|row| cell(row, column)).max().unwrap_or(0);
        for row in rows {
            let Some((last, others)) = row.as_ref().split_last() else { continue };
            let mut before: String =
                others.iter().enumerate().map(|(column, cell)| padded(cell, width(column) + 2)).collect();
            let mut room = WIDTH.saturating_sub(before.chars().count());
            if room < FEWEST_IN_LAST && last.chars().count() > room {
                self.line(&before);
                before = " ".repeat(INDENT);
                room = WIDTH - INDENT;
            }
            for line in wrap(last, room) {
                self.line(&format!("{before}{line}"));
                before = " ".repeat(before.chars().count());
            }
        }
    }

    fn line(&mut self, line: &str) {
        // Titles and names of files, machines and processes are foreign.
        self.text.push_str(&printable(line.trim_end()));
        self.text.push('\n');
    }
}

fn padded(text: &str, width: usize) -> String {
    let blanks = width.saturating_sub(text.chars().count());
    format!("{text}{}", " ".repeat(blanks))
}

/// Symbols of units after a number, without prefixes.
const UNITS: [&str; 9] = ["m", "N", "J", "J/m²", "Pa", "s", "B", "N/m", "%"];

/// Returns true for a unit, with or without a prefix.
fn is_unit(word: &str) -> bool {
    let word = word.trim_end_matches([',', ';', ':', '.', ')']);
    let without_prefix =
        word.strip_prefix(['q', 'r', 'y', 'z', 'a', 'f', 'p', 'n', 'µ', 'm', 'k', 'M', 'G', 'T', 'P', 'E']);
    UNITS.contains(&word) || without_prefix.is_some_and(|word| UNITS.contains(&word.trim_start_matches('i')))
}

/// Returns true where no line may end between two words: within a number with its thousands apart, and before its unit.
pub(crate) fn belong_together(word: &str, next: &str) -> bool {
    let digits = next.trim_end_matches([',', ';', ':', '.', ')']);
    let is_group = digits.len() == 3 && digits.bytes().all(|byte| byte.is_ascii_digit());
    word.ends_with(|c: char| c.is_ascii_digit()) && (is_group || is_unit(next))
}

/// Words of a text, with numbers and their units in one.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for next in text.split_whitespace() {
        match words.last_mut().filter(|word| belong_together(word, next)) {
            Some(word) => *word = format!("{word} {next}"),
            None => words.push(next.to_owned()),
        }
    }
    words
}

/// Lines of at most `width` characters, broken between words and within those that are longer.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut room = width;
    for word in words(text) {
        let length = word.chars().count();
        let blank = usize::from(room < width);
        if length + blank > room && room < width {
            lines.push(String::new());
            room = width;
        }
        let blank = usize::from(room < width);
        for (index, character) in " ".repeat(blank).chars().chain(word.chars()).enumerate() {
            if index > 0 && room == 0 {
                lines.push(String::new());
                room = width;
            }
            if let Some(line) = lines.last_mut() {
                line.push(character);
            }
            room -= 1;
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_words() {
        assert_eq!(wrap("one two three", 7), ["one two", "three"]);
        assert_eq!(wrap("one two three", 5), ["one", "two", "three"]);
        assert_eq!(wrap("a  longword b", 4), ["a", "long", "word", "b"]);
        assert_eq!(wrap("µµµµ µµµµ", 4), ["µµµµ", "µµµµ"]);
        assert_eq!(wrap("", 4), [""]);
        assert_eq!(wrap("line 800.6 µs, tree 80.75 µs", 16), ["line 800.6 µs,", "tree 80.75 µs"]);
        assert_eq!(wrap("with 16 384 springs", 7), ["with", "16 384", "springs"]);
        assert_eq!(wrap("about 3 MiB of memory", 9), ["about", "3 MiB of", "memory"]);
        assert_eq!(wrap("1 of 3 legs m", 6), ["1 of 3", "legs m"]);
    }

    #[test]
    fn columns_are_as_wide_as_their_cells() {
        let mut sheet = Sheet::default();
        sheet.table(&[["a", "b", &"c ".repeat(60)], ["aaa", "", "d"]].map(|row| row.map(String::from)));
        let text = sheet.into_text();
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines.len(), 3, "{text}");
        assert!(lines[0].starts_with("a    b  c c"), "{text}");
        assert!(lines[1].starts_with("        c c"), "{text}");
        assert_eq!(lines[2], "aaa     d");
        assert!(lines.iter().all(|line| line.len() <= WIDTH));
    }
}
