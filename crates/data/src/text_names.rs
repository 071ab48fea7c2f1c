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
            let is_number = |cell: &String| {
                matches!(
                    Decimal::default().read(cell, Separator::SPACE),
                    TextCell::Number(_)
                )
            };
            if found.iter().any(is_number)
                || !found
                    .iter()
                    .any(|cell| cell.contains(char::is_alphanumeric))
            {
                continue;
            }
            let mut columns: Vec<TextColumn> =
                found.iter().map(|cell| column(cell, is_unit)).collect();
            let bare: Vec<String> = found.iter().map(|cell| bare(cell).to_owned()).collect();
            let names = columns.iter().any(|column| column.role != Role::Unknown);
            if units.is_none() && !names && bare.iter().any(|cell| is_unit(cell)) {
                units = Some(bare);
                continue;
            }
            // Numbers of points often have no name, or a sign that begins a comment.
            if let [first, _, ..] = &mut columns[..]
                && first.name.is_empty()
                && names
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
    words.split(' ').any(|one| one == word)
}

/// Returns the cells of a line of names, if there are `count` of them. With the separator of the
/// numbers there may be up to `most`. Otherwise the line is split at its own separator, or after
/// closing brackets.
fn cells_of(line: &str, count: usize, most: usize, separator: Separator) -> Option<Vec<String>> {
    let line = match line.split_once([':', '=']) {
        Some((key, cells))
            if is_one_of(&key.trim().to_lowercase(), "columns names fields units") =>
        {
            cells
        }
        Some(_) => return None,
        None => line,
    };
    // Between a name and its unit there may be a blank.
    let joined = line
        .trim()
        .replace(" [", "[")
        .replace(" (", "(")
        .replace(" / ", "/");
    let split = |separator: Separator| {
        let line = if separator == Separator::SPACE {
            &joined
        } else {
            line.trim()
        };
        let mut cells: Vec<String> = separator.split(line).map(str::to_owned).collect();
        let end = cells
            .iter()
            .rposition(|cell| !cell.is_empty())
            .map_or(0, |last| last + 1);
        cells.truncate(end);
        cells
    };
    let mut cells = split(separator);
    if (count..=most).contains(&cells.len()) {
        cells.truncate(count);
        return Some(cells);
    }
    let cells = split(Separator::of(&joined));
    if cells.len() == count {
        return Some(cells);
    }
    let pieces = joined
        .split_inclusive([']', ')'])
        .map(|piece| piece.trim().to_owned());
    let pieces: Vec<String> = pieces.filter(|piece| !piece.is_empty()).collect();
    (pieces.len() == count && pieces.iter().all(|piece| piece.ends_with([']', ')'])))
        .then_some(pieces)
}

fn bare(cell: &str) -> &str {
    cell.trim_matches(['[', ']', '(', ')', '"', ' '])
}

/// Returns name, meaning and unit from the name of a column. The unit is in brackets, behind a
/// slash, or the last word, as in `Lateral um`. An unknown unit is recognised in square brackets,
/// behind a slash, or as a short word in round brackets. Thus `height (measured)` is a name.
fn column(cell: &str, is_unit: fn(&str) -> bool) -> TextColumn {
    let bracket = |(at, mark): (usize, &str)| {
        let unit = bare(cell[at + 1..].split([']', ')']).next()?);
        Some((
            &cell[..at],
            unit,
            mark == "[" || unit.chars().count() < LONGEST_UNIT,
        ))
    };
    let slash = cell
        .rsplit_once('/')
        .map(|(name, unit)| (name, bare(unit), true));
    // `Length 5 um` is a size.
    let last_word = cell.rsplit_once([' ', '_']).filter(|(name, _)| {
        !name
            .rsplit(' ')
            .next()
            .is_some_and(|before| before.contains(|c: char| c.is_ascii_digit()))
    });
    let parts = cell
        .match_indices(['[', '('])
        .filter_map(bracket)
        .chain(slash);
    let parts: Vec<_> = parts
        .chain(last_word.map(|(name, unit)| (name, unit, false)))
        .collect();
    let known = parts.iter().find(|(_, unit, _)| is_unit(unit));
    let found = known.or_else(|| parts.iter().find(|(.., is_stated)| *is_stated));
    let (name, unit) = found.map_or((cell, None), |(name, unit, _)| {
        (*name, Some((*unit).to_owned()))
    });
    let lower = cell
        .split(['[', '(', '/'])
        .next()
        .unwrap_or_default()
        .to_lowercase();
    let words = || {
        lower
            .split(|c: char| !c.is_alphanumeric())
            .filter(|word| !word.is_empty())
    };
    let role = ROLES
        .iter()
        .find(|(_, known)| words().any(|word| is_one_of(word, known)));
    TextColumn {
        name: name.trim_matches(['"', ' ']).to_owned(),
        role: role.map_or(Role::Unknown, |(role, _)| *role),
        unit,
    }
}
