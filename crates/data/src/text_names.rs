//! Names of columns in text files, from which the meaning and the unit of each column are found.

use crate::text_cells::{Decimal, Separator, TextCell};
use crate::text_lines::COMMENT;
use std::collections::VecDeque;

/// A text in round brackets with fewer characters than this counts as a unit, even if it is not a
/// known unit.
const LONGEST_UNIT: usize = 5;

/// Meaning of a column in a text file. The meaning is found from the name of the column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    /// Column whose name has no known meaning.
    #[default]
    Unknown,
    /// Column of positions along the first axis.
    X,
    /// Column of positions along the second axis.
    Y,
    /// Column of heights.
    Height,
    /// Column of numbers that only count the points, in the order of the file.
    Number,
    /// Column of flags that state whether a point was measured; 0 means that it was not measured.
    Valid,
}

/// Words that show the meaning of a column if they occur in its name. Earlier words in the list are
/// preferred.
const ROLES: [(Role, &str); 6] = [
    (Role::X, "x"),
    (Role::Y, "y"),
    (
        Role::Height,
        "z height heights höhe hauteur altura altezza výška elevation topography",
    ),
    (
        Role::X,
        "position positions pos lateral distance length weg",
    ),
    (Role::Valid, "valid validity isvalid"),
    (
        Role::Number,
        "index idx no nr number point points pt sample id",
    ),
];

/// Name and meaning of a column, and its unit if the name states one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextColumn {
    /// Name of the column; empty if it has none.
    pub name: String,
    /// Meaning of the column.
    pub role: Role,
    /// Unit of the column as it is written in the file; `None` if the file does not state a unit.
    pub unit: Option<String>,
}

/// Number of lines before the table of numbers that are searched for names of columns.
const LAST_LINES: usize = 64;

/// The last lines of a text file before its table of numbers, at most 64 lines. One of these lines
/// may state the names of the columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeadLines(VecDeque<String>);

impl HeadLines {
    /// Adds a line of the file. [`COMMENT`] characters at the beginning of the line are removed.
    pub fn take(&mut self, line: &str) {
        if self.0.len() == LAST_LINES {
            self.0.pop_front();
        }
        self.0
            .push_back(line.trim_start_matches(COMMENT).trim().to_owned());
    }

    /// Returns the name, the meaning and the unit of each of `count` columns.
    ///
    /// * The names come from the last line that has a name for each column. If there is no such
    ///   line, all names are empty.
    /// * The units come from these names, or from a line of units below the names. `is_unit`
    ///   returns true for known units.
    /// * A line may have up to `cells` cells. The cells beyond `count` are ignored.
    pub fn columns(
        &self,
        count: usize,
        cells: usize,
        separator: Separator,
        is_unit: fn(&str) -> bool,
    ) -> Vec<TextColumn> {
        let mut units: Option<Vec<String>> = None;
        for line in self.0.iter().rev() {
            let Some(found) = cells_of(line, count, cells, separator) else {
                continue;
            };
            let has_letters = found
                .iter()
                .any(|cell| cell.contains(char::is_alphanumeric));
            if !has_letters || found.iter().any(|cell| is_number(cell)) {
                continue;
            }
            let mut columns: Vec<TextColumn> =
                found.iter().map(|cell| column(cell, is_unit)).collect();
            let has_known_names = columns.iter().any(|column| column.role != Role::Unknown);
            if units.is_none() && !has_known_names {
                let bare: Vec<String> = found.iter().map(|cell| bare(cell).to_owned()).collect();
                if bare.iter().any(|cell| is_unit(cell)) {
                    units = Some(bare);
                    continue;
                }
            }
            // The column of the indices often has no name, or its name is a character that begins a
            // comment and was removed. The first column is therefore the column of the indices if
            // it has no name and other columns have known names.
            if let [first, _, ..] = &mut columns[..]
                && first.name.is_empty()
                && has_known_names
            {
                first.role = Role::Number;
            }
            add_units(&mut columns, units.unwrap_or_default(), is_unit);
            return columns;
        }
        let mut columns = vec![TextColumn::default(); count];
        add_units(&mut columns, units.unwrap_or_default(), is_unit);
        columns
    }

    /// Returns true if one of the lines is equal to `text`.
    pub fn has_line(&self, text: &str) -> bool {
        self.0.iter().any(|line| line == text)
    }
}

fn is_number(cell: &str) -> bool {
    let content = Decimal::default().read(cell, Separator::SPACE);
    matches!(content, TextCell::Number(_))
}

/// Adds units from a line of units. If a unit in this line is known, it replaces the unit in the
/// name of the column.
fn add_units(columns: &mut [TextColumn], units: Vec<String>, is_unit: fn(&str) -> bool) {
    for (column, unit) in columns.iter_mut().zip(units) {
        if is_unit(&unit) || column.unit.is_none() && !unit.is_empty() {
            column.unit = Some(unit);
        }
    }
}

/// Returns true if `word` is one of the words in `words`, which are separated by blanks.
pub fn is_one_of(word: &str, words: &str) -> bool {
    words.split(' ').any(|listed| listed == word)
}

/// Returns the cells of a line that may contain the names of `count` columns; `None` if the line
/// cannot be split into `count` cells. The function tries three ways to split the line and takes
/// the first that fits: 1. at the separator of the numbers, where `count` to `most` cells are
/// allowed and cells beyond `count` are dropped, 2. at the separator of the line itself, 3. after
/// closing brackets.
fn cells_of(line: &str, count: usize, most: usize, separator: Separator) -> Option<Vec<String>> {
    let line = without_key(line)?.trim();
    // There may be a blank between a name and its unit.
    let joined = line
        .replace(" [", "[")
        .replace(" (", "(")
        .replace(" / ", "/");
    let mut cells = split_at(separator, line, &joined);
    if (count..=most).contains(&cells.len()) {
        cells.truncate(count);
        return Some(cells);
    }
    let cells = split_at(Separator::of(&joined), line, &joined);
    if cells.len() == count {
        return Some(cells);
    }
    split_after_brackets(&joined).filter(|cells| cells.len() == count)
}

/// Returns the part of a line after its key, for example after `Columns:` in `Columns: x, z`. A
/// line without a key is returned whole. Returns `None` if the key announces something other than
/// names or units.
fn without_key(line: &str) -> Option<&str> {
    let Some((key, cells)) = line.split_once([':', '=']) else {
        return Some(line);
    };
    is_one_of(&key.trim().to_lowercase(), "columns names fields units").then_some(cells)
}

/// Splits a line at a separator, without empty cells at its end. If the separator is white space,
/// `joined` is split instead: the same line without blanks between names and units.
fn split_at(separator: Separator, line: &str, joined: &str) -> Vec<String> {
    let line = if separator == Separator::SPACE {
        joined
    } else {
        line
    };
    let mut cells: Vec<String> = separator.split(line).map(str::to_owned).collect();
    while cells.last().is_some_and(String::is_empty) {
        cells.pop();
    }
    cells
}

/// Splits a line after each closing bracket. Returns `None` if a cell does not end with a bracket.
fn split_after_brackets(line: &str) -> Option<Vec<String>> {
    let mut cells = Vec::new();
    for piece in line.split_inclusive([']', ')']) {
        let piece = piece.trim();
        if piece.is_empty() {
            continue;
        }
        if !piece.ends_with([']', ')']) {
            return None;
        }
        cells.push(piece.to_owned());
    }
    Some(cells)
}

fn bare(cell: &str) -> &str {
    cell.trim_matches(['[', ']', '(', ')', '"', ' '])
}

/// A possible division of the heading of a column into a name and a unit.
struct Division<'a> {
    name: &'a str,
    unit: &'a str,
    /// True if the notation alone shows that `unit` is a unit, even if the unit is not known.
    is_stated: bool,
}

/// Lists the possible divisions of the heading of a column into a name and a unit. The unit may be
/// in brackets, after a slash, or the last word, as in `Lateral um`.
fn divisions(heading: &str) -> Vec<Division<'_>> {
    let mut divisions = Vec::new();
    for (place, bracket) in heading.match_indices(['[', '(']) {
        let after = &heading[place + 1..];
        let unit = bare(after.split([']', ')']).next().unwrap_or_default());
        divisions.push(Division {
            name: &heading[..place],
            unit,
            is_stated: bracket == "[" || unit.chars().count() < LONGEST_UNIT,
        });
    }
    if let Some((name, unit)) = heading.rsplit_once('/') {
        divisions.push(Division {
            name,
            unit: bare(unit),
            is_stated: true,
        });
    }
    if let Some((name, unit)) = heading.rsplit_once([' ', '_']) {
        let word_before = name.rsplit(' ').next().unwrap_or_default();
        // After a number, as in `Length 5 um`, the unit belongs to a size and not to the column.
        if !word_before.contains(|c: char| c.is_ascii_digit()) {
            divisions.push(Division {
                name,
                unit,
                is_stated: false,
            });
        }
    }
    divisions
}

/// Returns the name, the meaning and the unit in the heading of a column. A text that is not a
/// known unit counts as a unit if it is in square brackets, after a slash, or a short word in round
/// brackets. Therefore `height (measured)` as a whole is a name.
fn column(heading: &str, is_unit: fn(&str) -> bool) -> TextColumn {
    let divisions = divisions(heading);
    let division = divisions
        .iter()
        .find(|division| is_unit(division.unit))
        .or_else(|| divisions.iter().find(|division| division.is_stated));
    let name = division.map_or(heading, |division| division.name);
    TextColumn {
        name: name.trim_matches(['"', ' ']).to_owned(),
        role: role(heading),
        unit: division.map(|division| division.unit.to_owned()),
    }
}

/// Returns the meaning of a column. It depends on the words of the heading before the first bracket
/// or slash.
fn role(heading: &str) -> Role {
    let name = heading.split(['[', '(', '/']).next().unwrap_or_default();
    let name = name.to_lowercase();
    let words: Vec<&str> = name
        .split(|c: char| !c.is_alphanumeric())
        .filter(|word| !word.is_empty())
        .collect();
    for (role, known_words) in ROLES {
        if words.iter().any(|word| is_one_of(word, known_words)) {
            return role;
        }
    }
    Role::Unknown
}
