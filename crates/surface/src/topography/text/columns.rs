//! Meaning of the columns of a table: heights alone, a profile, points of a map, or rows of a map.

use crate::error::{Place, SurfaceError, refused};
use asperity_data::shown;
use asperity_data::text_table::{Role, TextColumn};

/// Limit of the number of columns of positions and heights; more columns are rows of a map, unless
/// their names say otherwise.
const MOST_NAMED: usize = 3;

/// Indices of the columns of a list of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct List {
    /// Column of the positions of a profile, or of x of the points of a map.
    pub x: Option<usize>,
    pub y: Option<usize>,
    pub height: usize,
    pub valid: Option<usize>,
}

/// Finds the columns of a list of points; `None` if the columns are rows of a map.
pub(super) fn list_of(columns: &[TextColumn]) -> Result<Option<List>, SurfaceError> {
    let places = |role: Role| {
        columns
            .iter()
            .enumerate()
            .filter(move |(_, column)| column.role == role)
    };
    // `point 1`, `point 2` … are names of other things.
    let single = |role: Role| {
        let mut found = places(role).map(|(place, _)| place);
        found.next().filter(|_| found.next().is_none())
    };
    let beside = [single(Role::Number), single(Role::Valid)];
    let rest: Vec<usize> = (0..columns.len())
        .filter(|place| !beside.contains(&Some(*place)))
        .collect();
    let (x, y, height) = (single(Role::X), single(Role::Y), single(Role::Height));
    let list = |x: Option<usize>, y: Option<usize>, height: usize| {
        Ok(Some(List {
            x,
            y,
            height,
            valid: beside[1],
        }))
    };
    let other = |one: usize, two: usize| {
        rest.iter()
            .copied()
            .find(|place| *place != one && *place != two)
    };
    let has_unknown_name = || {
        rest.iter()
            .any(|&place| columns[place].role == Role::Unknown && !columns[place].name.is_empty())
    };
    let is_usual = || {
        [x, y, height]
            .into_iter()
            .zip(&rest)
            .all(|(found, usual)| found.is_none_or(|found| found == *usual))
    };
    match rest[..] {
        [height] => return list(None, None, height),
        [first, second] => {
            let (x, height) = match (x, height) {
                (Some(x), _) => (x, if x == first { second } else { first }),
                (None, Some(height)) => (if height == first { second } else { first }, height),
                (None, None) => (first, second),
            };
            return list(Some(x), None, height);
        }
        [first, second, third] => {
            if let (Some(x), Some(y)) = (x, y) {
                return list(Some(x), Some(y), other(x, y).unwrap_or(third));
            }
            if is_usual() && !(x.is_some() && height.is_some() && has_unknown_name()) {
                return list(Some(first), Some(second), third);
            }
        }
        _ if rest.len() > MOST_NAMED
            && beside == [None; 2]
            && (x.is_none() || y.or(height).is_none()) =>
        {
            return Ok(None);
        }
        _ => {}
    }
    let names: Vec<String> = columns
        .iter()
        .take(8)
        .map(|column| format!("{:?}", shown(&column.name)))
        .collect();
    let fault = format!("{} columns {}", columns.len(), names.join(", "));
    let allowed = "a height, x and a height, or x, y and a height, beside a number of the point and a column valid";
    Err(refused(Place::File, fault, allowed))
}

#[cfg(test)]
mod tests {
    use super::super::super::Unit;
    use super::*;
    use asperity_data::text_table::{HeadLines, Separator};

    fn list(names: &str) -> Result<Option<[Option<usize>; 4]>, String> {
        let mut header = HeadLines::default();
        header.take(names);
        let (separator, count) = (Separator::of(names), names.split(',').count());
        let found = list_of(&header.columns(count, count, separator, Unit::is_name))
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
