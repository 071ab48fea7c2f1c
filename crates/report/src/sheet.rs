//! Plain text with aligned columns, for a terminal of 80 columns.

use asperity_data::{format_quantity, printable, wrap};

/// Width of a line in characters, which is the width of the smallest usual terminal.
pub(crate) const WIDTH: usize = 80;

/// Smallest width of a last column in characters, and its indentation on its own line.
const FEWEST_IN_LAST: usize = 20;
const INDENT: usize = 4;

/// Width in characters of the labels before the values of rows.
const LABEL: usize = 26;

/// Plain text of at most 80 columns, to which headings, rows, tables and paragraphs are added one
/// by one.
#[derive(Default)]
pub struct Sheet {
    text: String,
}

impl Sheet {
    /// Returns a text that consists of one table.
    pub fn of_table<R: AsRef<[String]>>(rows: &[R]) -> String {
        let mut sheet = Sheet::default();
        sheet.table(rows);
        sheet.into_text()
    }

    /// Returns the finished text.
    pub fn into_text(self) -> String {
        self.text
    }

    /// Adds a heading, after an empty line unless the heading is the first.
    pub fn heading(&mut self, heading: &str) {
        self.text
            .push_str(if self.text.is_empty() { "" } else { "\n" });
        self.paragraph(heading);
    }

    /// Adds a paragraph, which is broken into lines of at most 80 columns.
    pub fn paragraph(&mut self, text: &str) {
        for line in text.lines().flat_map(|line| wrap(line, WIDTH)) {
            self.line(&line);
        }
    }

    /// Adds a row of a label and a value.
    pub fn row(&mut self, label: &str, value: impl AsRef<str>) {
        let mut label = label;
        for line in wrap(value.as_ref(), WIDTH - LABEL) {
            debug_assert!(label.chars().count() < LABEL - 2, "{label}");
            self.line(&format!("  {}{line}", padded(label, LABEL - 2)));
            label = "";
        }
    }

    /// Adds a row of a label and a number, given in the SI unit `unit` and written with a prefix.
    /// `None` adds nothing.
    pub fn quantity(&mut self, label: &str, value: impl Into<Option<f64>>, unit: &str) {
        self.row_of(
            label,
            value.into().map(|value| format_quantity(value, unit)),
        );
    }

    /// Adds a row of a label and a value. `None` adds nothing.
    pub fn row_of(&mut self, label: &str, value: Option<String>) {
        if let Some(value) = value {
            self.row(label, value);
        }
    }

    /// Adds a table with aligned columns.
    pub fn table<R: AsRef<[String]>>(&mut self, rows: &[R]) {
        let columns = rows.iter().map(|row| row.as_ref().len()).max().unwrap_or(0);
        let length = |row: &R, column: usize| {
            row.as_ref()
                .get(column)
                .map_or(0, |cell| cell.chars().count())
        };
        let width = |column: usize| {
            rows.iter()
                .map(|row| length(row, column))
                .max()
                .unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        let mut next = columns.min(1);
        loop {
            let (begin, mut room) = (
                next,
                WIDTH.saturating_sub(widths.first().map_or(0, |width| width + 2)),
            );
            while next < columns {
                // Only the last column holds sentences, which continue on further lines.
                let needed = if next + 1 == columns {
                    widths[next].min(FEWEST_IN_LAST)
                } else {
                    widths[next]
                };
                if needed > room && next > begin {
                    break;
                }
                room = room.saturating_sub(widths[next] + 2);
                next += 1;
            }
            for row in rows {
                let cells: Vec<_> = row.as_ref().iter().enumerate().collect();
                let shown = cells
                    .iter()
                    .filter(|(column, _)| *column == 0 || (begin..next).contains(column));
                self.cells(
                    &shown
                        .map(|(column, cell)| (widths[*column], cell.as_str()))
                        .collect::<Vec<_>>(),
                );
            }
            if next >= columns {
                return;
            }
            self.text.push('\n');
        }
    }

    /// Adds a line of cells, each with the width of its column. The last cell begins on the next
    /// line if it has too little room.
    fn cells(&mut self, cells: &[(usize, &str)]) {
        let Some(((_, last), others)) = cells.split_last() else {
            return;
        };
        let mut before: String = others
            .iter()
            .map(|(width, cell)| padded(cell, width + 2))
            .collect();
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

    fn line(&mut self, line: &str) {
        // Titles and names of files, machines and processes are foreign text.
        self.text.push_str(&printable(line.trim_end()));
        self.text.push('\n');
    }
}

/// Returns at most `most` evenly spaced rows of a table, always with the last one.
pub(crate) fn thinned<I: ExactSizeIterator>(rows: I, most: usize) -> impl Iterator<Item = I::Item> {
    let (last, stride) = (
        rows.len().saturating_sub(1),
        rows.len().div_ceil(most).max(1),
    );
    rows.skip(last % stride).step_by(stride)
}

fn padded(text: &str, width: usize) -> String {
    let blanks = width.saturating_sub(text.chars().count());
    format!("{text}{}", " ".repeat(blanks))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(rows: &[Vec<String>]) -> Vec<String> {
        let mut sheet = Sheet::default();
        sheet.table(rows);
        sheet.into_text().lines().map(str::to_owned).collect()
    }

    #[test]
    fn columns_are_as_wide_as_their_cells() {
        let lines = lines(
            &[["a", "b", &"c ".repeat(60)], ["aaa", "", "d"]]
                .map(|row| row.map(String::from).to_vec()),
        );
        assert_eq!(lines.len(), 3, "{lines:?}");
        assert!(lines[0].starts_with("a    b  c c"), "{lines:?}");
        assert!(lines[1].starts_with("        c c"), "{lines:?}");
        assert_eq!(lines[2], "aaa     d");
        assert!(lines.iter().all(|line| line.len() <= WIDTH));
    }

    #[test]
    fn columns_that_do_not_fit_are_a_further_table() {
        let row = |first: &str| {
            let others = (1..8).map(|column| format!("{column}{}", "x".repeat(13)));
            std::iter::once(first.to_owned())
                .chain(others)
                .collect::<Vec<_>>()
        };
        let lines = lines(&[row("setting"), row("16")]);
        let starts: Vec<String> = lines
            .iter()
            .map(|line| line.chars().take(10).collect())
            .collect();
        assert_eq!(
            starts,
            ["setting  1", "16       1", "", "setting  5", "16       5"]
        );
        assert!(lines.iter().all(|line| line.len() <= WIDTH));
    }
}
