//! Plain text in aligned columns that fits a terminal of 80 columns.

use crate::scene::format_quantity;
use crate::text::{printable, wrap};

/// Characters on a line: those of the smallest usual terminal.
pub(crate) const WIDTH: usize = 80;

/// Fewest characters of a last column, and the indentation of that column on a line of its own.
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
    /// A table alone as text.
    #[cfg(feature = "tui")]
    pub(crate) fn of_table<R: AsRef<[String]>>(rows: &[R]) -> String {
        let mut sheet = Sheet::default();
        sheet.table(rows);
        sheet.into_text()
    }

    /// The text so far.
    pub(crate) fn into_text(self) -> String {
        self.text
    }

    /// A heading, with an empty line between it and the text so far.
    pub(crate) fn heading(&mut self, heading: &str) {
        self.text.push_str(if self.text.is_empty() { "" } else { "\n" });
        self.paragraph(heading);
    }

    /// Text wrapped into lines; none for an empty text.
    pub(crate) fn paragraph(&mut self, text: &str) {
        for line in text.lines().flat_map(|line| wrap(line, WIDTH)) {
            self.line(&line);
        }
    }

    /// A row; a value too long for one line continues below itself.
    pub(crate) fn row(&mut self, label: &str, value: impl AsRef<str>) {
        let mut label = label;
        for line in wrap(value.as_ref(), WIDTH - LABEL) {
            self.line(&format!("  {}{line}", padded(label, LABEL - 2)));
            label = "";
        }
    }

    /// A row with a number in this unit, if there is one.
    pub(crate) fn quantity(&mut self, label: &str, value: impl Into<Option<f64>>, unit: &str) {
        self.row_of(label, value.into().map(|value| format_quantity(value, unit)));
    }

    /// A row, if there is a value.
    pub(crate) fn row_of(&mut self, label: &str, value: Option<String>) {
        if let Some(value) = value {
            self.row(label, value);
        }
    }

    /// Lines of cells below each other, all but the last column as wide as its widest cell. A last cell too long
    /// for its line continues below itself, or begins on the next line if the other columns leave too little room.
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
        // Titles and names of files, machines and processes are foreign text.
        self.text.push_str(&printable(line.trim_end()));
        self.text.push('\n');
    }
}

/// Rows as comma-separated values.
#[cfg(feature = "tui")]
pub(crate) fn csv<R: AsRef<[String]>>(rows: &[R]) -> String {
    rows.iter().map(|row| row.as_ref().join(",") + "\n").collect()
}

/// Rows as a table of Markdown, the first one as its heading.
pub(crate) fn markdown<R: AsRef<[String]>>(rows: &[R]) -> String {
    let mut lines: Vec<_> = rows.iter().map(|row| format!("| {} |\n", row.as_ref().join(" | "))).collect();
    let columns = rows.first().map_or(0, |row| row.as_ref().len());
    lines.insert(lines.len().min(1), format!("|{}\n", " --- |".repeat(columns)));
    lines.concat()
}

/// At most `most` evenly spaced rows of a table, including the last one.
pub(super) fn thinned<I: ExactSizeIterator>(rows: I, most: usize) -> impl Iterator<Item = I::Item> {
    let (last, stride) = (rows.len().saturating_sub(1), rows.len().div_ceil(most).max(1));
    rows.skip(last % stride).step_by(stride)
}

fn padded(text: &str, width: usize) -> String {
    let blanks = width.saturating_sub(text.chars().count());
    format!("{text}{}", " ".repeat(blanks))
}

#[cfg(test)]
mod tests {
    use super::*;

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
