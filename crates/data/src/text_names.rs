//! Names of columns: the meaning of each column, and its unit.

use crate::text_cells::{Decimal, Separator, TextCell};
use crate::text_lines::COMMENT;
use std::collections::VecDeque;

/// Largest number of characters of an unknown unit in round brackets.
const LONGEST_UNIT: usize = 5;

/// Meaning of a column in a text file, which the name of the column states.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    /// The name of the column states no meaning that is known.
    #[default]
    Unknown,
    /// The column has positions along the first axis.
    X,
    /// The column has positions along the second axis.
    Y,
    /// The column has heights.
    Height,
    /// The column has the index of each point, which counts the points in the order of the file.
    Number,
    /// The column has 0 for a point that was not measured.
    Valid,
}

/// Words in the names of columns, in the order of preference.
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
    /// Unit of the column as the file writes it; `None` if the file states none.
    pub unit: Option<String>,
}

/// Number of last lines in which names of columns are searched.
const LAST_LINES: usize = 64;

/// The last lines (at most 64) of a text file before its table of numbers. One of these lines may
/// name the columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeadLines(VecDeque<String>);

impl HeadLines {
    /// Adds a line. The characters [`COMMENT`] at the beginning of the line are left out.
    pub fn take(&mut self, line: &str) {
        if self.0.len() == LAST_LINES {
            self.0.pop_front();
        }
        self.0
            .push_back(line.trim_start_matches(COMMENT).trim().to_owned());
    }

    /// Returns the name, the meaning and the unit of each of `count` columns, from the last line
    /// that has a name for each column and from a line of units below it. A line may have up to
    /// `cells` cells, of which empty ones are ignored. If no line has names, all names are empty.
    /// `is_unit` returns true for known units.
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
            // Indices of points often have no name, or a sign that begins a comment.
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

    /// Returns true if one of the lines equals this text.
    pub fn has_line(&self, text: &str) -> bool {
        self.0.iter().any(|line| line == text)
    }
}

fn is_number(cell: &str) -> bool {
    let content = Decimal::default().read(cell, Separator::SPACE);
    matches!(content, TextCell::Number(_))
}

/// Adds a row of units. A known unit in the row replaces the unit beside a name.
fn add_units(columns: &mut [TextColumn], units: Vec<String>, is_unit: fn(&str) -> bool) {
    for (column, unit) in columns.iter_mut().zip(units) {
        if is_unit(&unit) || column.unit.is_none() && !unit.is_empty() {
            column.unit = Some(unit);
        }
    }
}

/// Returns true if `word` is one of `words`, which are separated by blanks.
pub fn is_one_of(word: &str, words: &str) -> bool {
    words.split(' ').any(|listed| listed == word)
}

/// Returns the cells of a line of names, if there are `count` of them. With the separator of the
/// numbers there may be up to `most`. Otherwise the line is split at its own separator, or after
/// closing brackets.
fn cells_of(line: &str, count: usize, most: usize, separator: Separator) -> Option<Vec<String>> {
    let line = without_key(line)?.trim();
    // Between a name and its unit there may be a blank.
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

/// Returns what follows the key of a line such as `Columns: x, z`, or the whole line if it has no
/// key. Returns `None` if the key announces something else than names.
fn without_key(line: &str) -> Option<&str> {
    let Some((key, cells)) = line.split_once([':', '=']) else {
        return Some(line);
    };
    is_one_of(&key.trim().to_lowercase(), "columns names fields units").then_some(cells)
}

/// Splits a line at a separator and leaves out the empty cells at its end. At white space the line
/// `joined` is split, in which names are joined to their units.
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

/// Splits a line after closing brackets. Returns `None` unless each cell ends with a bracket.
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

/// One way to divide the heading of a column into a name and a unit.
struct Division<'a> {
    name: &'a str,
    unit: &'a str,
    /// True if the notation alone shows that this is a unit, so that it need not be known.
    is_stated: bool,
}

/// Lists the ways to divide the heading of a column into a name and a unit. The unit is in
/// brackets, after a slash, or the last word, as in `Lateral um`.
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
        // `Length 5 um` is a size.
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

/// Returns name, meaning and unit from the heading of a column. An unknown unit is recognised in
/// square brackets, after a slash, or as a short word in round brackets. Thus `height (measured)`
/// is a name.
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

/// Returns the meaning of a column by the words of its heading before the first bracket or slash.
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
