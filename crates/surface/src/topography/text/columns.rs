//! Meaning of the columns of a table in a text: heights alone, a profile, points of a map, or rows
//! of a map.

use super::super::channel::{self, Label, Wanted};
use crate::error::{Place, SurfaceError, refused};
use asperity_data::text_table::{Role, TextColumn};
use asperity_data::{Remedy, shown};

/// Largest number of columns of a list of points (two positions and a height). More columns are the
/// rows of a map, unless their names say otherwise.
const MOST_NAMED: usize = 3;

/// Largest number of columns that an error message lists.
const MOST_LISTED: usize = 8;

/// Indices of the columns in a table that lists points. Each index belongs to a meaning, such as x
/// or height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct List {
    /// Column of the positions of a profile, or of the coordinates x of a map; `None` if the table
    /// has no such column.
    pub x: Option<usize>,
    pub y: Option<usize>,
    pub height: usize,
    pub valid: Option<usize>,
}

/// Finds the columns of a table that lists points. Returns `None` if the lines of the table are
/// rows of a map. If several columns may be the heights, `wanted` chooses one of these columns.
pub(super) fn list_of(
    columns: &[TextColumn],
    wanted: Wanted<'_>,
) -> Result<Option<List>, SurfaceError> {
    let named = NamedColumns::new(columns);
    if let Wanted::Name(_) = wanted {
        return named.list_with(wanted).map(Some);
    }
    if let Some(list) = named.list() {
        return Ok(Some(list));
    }
    if named.are_rows_of_a_map() {
        return Ok(None);
    }
    if let Wanted::Number(_) = wanted {
        return named.list_with(wanted).map(Some);
    }
    let names: Vec<String> = columns
        .iter()
        .take(MOST_LISTED)
        .map(|column| format!("{:?}", shown(&column.name)))
        .collect();
    let found = format!("{} columns {}", columns.len(), names.join(", "));
    let mut allowed = "a height, x and a height, or x, y and a height, beside a number of the \
                       point and a column valid"
        .to_owned();
    if let Some(example) = named.candidate() {
        allowed += &format!(
            ", or the name of the column of heights or its number from 0, such as {:?}",
            shown(&example.name)
        );
        return Err(refused(Place::File, found, allowed).with(Remedy::Channel));
    }
    Err(refused(Place::File, found, allowed))
}

/// Columns by the meaning of their names. If several columns have names with the same meaning, such
/// as `point 1`, `point 2`, …, none of them gets this meaning.
struct NamedColumns<'a> {
    columns: &'a [TextColumn],
    /// Column that numbers the points.
    number: Option<usize>,
    valid: Option<usize>,
    x: Option<usize>,
    y: Option<usize>,
    height: Option<usize>,
    /// All columns except `number` and `valid`.
    others: Vec<usize>,
}

impl<'a> NamedColumns<'a> {
    fn new(columns: &'a [TextColumn]) -> Self {
        let number = single(columns, Role::Number);
        let valid = single(columns, Role::Valid);
        let is_other = |column: &usize| Some(*column) != number && Some(*column) != valid;
        NamedColumns {
            columns,
            number,
            valid,
            x: single(columns, Role::X),
            y: single(columns, Role::Y),
            height: single(columns, Role::Height),
            others: (0..columns.len()).filter(is_other).collect(),
        }
    }

    /// Returns the columns if each point of the list has one to three numbers; `None` for other
    /// lists.
    fn list(&self) -> Option<List> {
        match self.others[..] {
            [height] => Some(self.with(None, None, height)),
            [first, second] => Some(self.profile(first, second)),
            [first, second, third] if !self.has_several_heights() => {
                self.points(first, second, third)
            }
            _ => None,
        }
    }

    /// Returns true if the first column is x, and at least two named columns follow, none of which
    /// is y. Such a file contains, for example, the heights of a profile before and after a filter.
    fn has_several_heights(&self) -> bool {
        let [first, heights @ ..] = &self.others[..] else {
            return false;
        };
        self.x == Some(*first)
            && heights.len() > 1
            && heights.iter().all(|column| {
                let column = &self.columns[*column];
                !column.name.is_empty() && column.role != Role::Y
            })
    }

    /// Returns the first column that is not a position, if it has a name. It may be the heights.
    fn candidate(&self) -> Option<&TextColumn> {
        let is_position = |column: usize| Some(column) == self.x || Some(column) == self.y;
        let mut heights = self.others.iter().filter(|column| !is_position(**column));
        let first = &self.columns[*heights.next()?];
        (!first.name.is_empty()).then_some(first)
    }

    /// Returns the list in which the wanted column is the heights. The positions are the columns
    /// named x and y. If there are no such names, the first column is the positions of a profile.
    fn list_with(&self, wanted: Wanted<'_>) -> Result<List, SurfaceError> {
        let height = self.wanted(wanted)?;
        // If X and Y are the only columns, then Y is the heights of a profile.
        let y = self.y.filter(|_| self.others.len() > 2);
        let is_position = Some(height) == self.x || Some(height) == y;
        let x = match self.others.first() {
            Some(first) if self.x.is_none() && *first != height => Some(*first),
            _ => self.x,
        };
        if is_position || !self.others.contains(&height) {
            let name = shown(&self.columns[height].name);
            let found = format!("column {height} {name:?} has positions or numbers of points");
            return Err(refused(
                Place::File,
                found,
                "the name of a column of heights",
            ));
        }
        Ok(self.with(x, y, height))
    }

    /// Returns the column with the wanted name or number.
    fn wanted(&self, wanted: Wanted<'_>) -> Result<usize, SurfaceError> {
        let labels: Vec<Label> = self
            .columns
            .iter()
            .zip(0..)
            .map(|(column, number)| Label {
                number,
                name: column.name.clone(),
                ..Label::default()
            })
            .collect();
        channel::chosen(&labels, "column", wanted)
    }

    fn with(&self, x: Option<usize>, y: Option<usize>, height: usize) -> List {
        List {
            x,
            y,
            height,
            valid: self.valid,
        }
    }

    fn profile(&self, first: usize, second: usize) -> List {
        let other = |column: usize| if column == first { second } else { first };
        match (self.x, self.height) {
            (Some(x), _) => self.with(Some(x), None, other(x)),
            (None, Some(height)) => self.with(Some(other(height)), None, height),
            (None, None) => self.with(Some(first), None, second),
        }
    }

    fn points(&self, first: usize, second: usize, third: usize) -> Option<List> {
        if let (Some(x), Some(y)) = (self.x, self.y) {
            let is_height = |column: &usize| *column != x && *column != y;
            let height = self.others.iter().copied().find(is_height);
            return Some(self.with(Some(x), Some(y), height.unwrap_or(third)));
        }
        // If two columns are named x and height, a third column with an unknown name is not the
        // coordinate y but another quantity.
        let has_other_quantity =
            self.x.is_some() && self.height.is_some() && self.has_unknown_name();
        if self.is_usual() && !has_other_quantity {
            return Some(self.with(Some(first), Some(second), third));
        }
        None
    }

    /// Returns true if those columns that have a name are in the order x, y, height.
    fn is_usual(&self) -> bool {
        [self.x, self.y, self.height]
            .into_iter()
            .zip(&self.others)
            .all(|(named, usual)| named.is_none_or(|named| named == *usual))
    }

    fn has_unknown_name(&self) -> bool {
        self.others.iter().any(|column| {
            let column = &self.columns[*column];
            column.role == Role::Unknown && !column.name.is_empty()
        })
    }

    fn are_rows_of_a_map(&self) -> bool {
        let has_no_list_name = self.number.is_none() && self.valid.is_none();
        let has_positions = self.x.is_some() && (self.y.is_some() || self.height.is_some());
        self.others.len() > MOST_NAMED
            && has_no_list_name
            && !has_positions
            && !self.has_several_heights()
    }
}

/// Returns the only column with a role; `None` if no column or several columns have this role.
fn single(columns: &[TextColumn], role: Role) -> Option<usize> {
    let mut found = (0..columns.len()).filter(|column| columns[*column].role == role);
    let first = found.next();
    if found.next().is_some() { None } else { first }
}

#[cfg(test)]
mod tests {
    use super::super::super::unit::Unit;
    use super::*;
    use asperity_data::text_table::{HeadLines, Separator};

    fn list(names: &str) -> Result<Option<[Option<usize>; 4]>, String> {
        let mut header = HeadLines::default();
        header.take(names);
        let (separator, count) = (Separator::of(names), names.split(',').count());
        let found = list_of(
            &header.columns(count, count, separator, Unit::is_name),
            Wanted::Heights,
        )
        .map_err(|error| error.to_string())?;
        Ok(found.map(|list| [list.x, list.y, Some(list.height), list.valid]))
    }

    #[test]
    fn columns_are_found_by_their_names_or_their_order() {
        for (names, expected) in [
            ("a,b", [Some(0), None, Some(1), None]),
            ("z,x", [Some(1), None, Some(0), None]),
            ("Height,signal", [Some(1), None, Some(0), None]),
            ("X,Y,valid", [Some(0), None, Some(1), Some(2)]),
            ("index,x,z", [Some(1), None, Some(2), None]),
            ("no,height", [None, None, Some(1), None]),
            ("x,y,signal", [Some(0), Some(1), Some(2), None]),
            ("z,y,x", [Some(2), Some(1), Some(0), None]),
            ("a,b,c", [Some(0), Some(1), Some(2), None]),
            ("#,x,y,z,valid", [Some(1), Some(2), Some(3), Some(4)]),
        ] {
            assert_eq!(list(names), Ok(Some(expected)), "{names}");
        }
        assert_eq!(list("point 1,point 2,point 3,point 4"), Ok(None));
        assert_eq!(list("a,b,c,d"), Ok(None));
        for names in [
            "x,z,intensity",
            "x,y,z,intensity",
            "index,a,b,c,d",
            "index,valid",
        ] {
            let error = list(names).unwrap_err();
            assert!(
                error.contains("columns \"")
                    && error.contains("; allowed: a height, x and a height"),
                "{error}"
            );
        }
    }
}
