//! Surfaces in text: columns z, x z or x y z, or a matrix of heights.
//!
//! Lines before the first line of numbers are a header; empty lines and lines that begin with `#`, `%` or `!` are
//! skipped. The first line of numbers fixes the separator ([`layout::Separator::of`]) and the number of columns: one
//! is z, two are x z, three are x y z of a full grid row by row, four and more are a row of a matrix.

mod layout;
pub(crate) use layout::{Cell, Decimal, Separator};

use super::Unit;
use super::reading::Reading;
use super::surface::{LARGEST, UNEVEN};
use super::{Place, TopographyError, refused, shown};
use crate::io::PROVENANCE;
use crate::memory::{check_room, push, reserve};
use encoding_rs::{Encoding, UTF_8, WINDOWS_1252};
use layout::Header;
use std::borrow::Cow;

pub(crate) const COMMENT: [char; 3] = ['#', '%', '!'];

pub(super) fn read(bytes: &[u8]) -> Result<Reading, TopographyError> {
    // Tables of results are in SI units.
    let metre = bytes.starts_with(PROVENANCE.as_bytes()).then_some(Unit::METRE);
    let mut header = Header { lateral: metre, height: metre, ..Header::default() };
    let mut rows = None::<Rows>;
    let take = |place: Place, line: &str| rows.get_or_insert_with(|| Rows::new(line)).take(place, line);
    each_line(bytes, is_header, |line| header.take(line), take)?;
    let none = || refused(Place::File, "no line of numbers", "a line of numbers for each point or row");
    rows.ok_or_else(none)?.finish(&header)
}

/// Passes the lines of a text on: those of its header to `header`, up to the first line for which `is_header` is false,
/// and all lines of numbers with their places to `row`. Empty lines, comments between numbers and the scene in a table of
/// results are skipped.
pub(crate) fn each_line(
    bytes: &[u8],
    is_header: impl Fn(&str) -> bool,
    mut header: impl FnMut(&str),
    mut row: impl FnMut(Place, &str) -> Result<(), TopographyError>,
) -> Result<(), TopographyError> {
    let (mut has_begun, mut in_provenance) = (false, false);
    for (index, line) in decoded(bytes)?.split(|byte| *byte == b'\n').enumerate() {
        let place = Place::Line(index + 1);
        let line = line_text(line, &place)?;
        if line.is_empty() {
            continue;
        }
        let is_comment = line.starts_with(COMMENT);
        // The words of a scene may look like units.
        in_provenance = is_comment && (in_provenance || line.starts_with(PROVENANCE));
        has_begun |= !is_comment && !is_header(&line);
        match (has_begun, is_comment) {
            (true, false) => row(place, &line)?,
            (false, _) if !in_provenance => header(&line),
            _ => {}
        }
    }
    Ok(())
}

/// Returns true for a line whose first column is neither a number nor a mark of a missing point.
fn is_header(line: &str) -> bool {
    let separator = Separator::of(line);
    let first = separator.split(line).next().unwrap_or_default();
    Decimal::default().read(first, separator) == Cell::NoNumber
}

/// Lines of numbers, in the units of the file.
struct Rows {
    separator: Separator,
    decimal: Decimal,
    columns: usize,
    /// Positions x, or x and y.
    positions: [Vec<f64>; 2],
    heights: Vec<f64>,
    first_missing: Option<Place>,
}

impl Rows {
    /// Rows in the form of this first one.
    fn new(line: &str) -> Self {
        let separator = Separator::of(line);
        Rows {
            separator,
            decimal: Decimal::default(),
            columns: separator.split(line).count(),
            positions: [Vec::new(), Vec::new()],
            heights: Vec::new(),
            first_missing: None,
        }
    }

    /// Reads a line without white space around it.
    fn take(&mut self, place: Place, line: &str) -> Result<(), TopographyError> {
        let columns = self.columns;
        let positions = if columns <= 3 { columns - 1 } else { 0 };
        reserve(&mut self.heights, columns)?;
        let mut found = 0;
        for cell in self.separator.split(line) {
            found += 1;
            if found > columns {
                continue;
            }
            let value = self.value(&place, cell, found <= positions)?;
            if found <= positions {
                push(&mut self.positions[found - 1], value)?;
            } else {
                self.heights.push(value);
            }
        }
        if found != columns {
            let expected = match columns {
                1 => "1, the height".to_owned(),
                2 => "2, position and height".to_owned(),
                3 => "3, two positions and height".to_owned(),
                columns => format!("{columns}, as in the first row"),
            };
            return Err(refused(place, format!("{found} columns"), expected));
        }
        if columns == 2 { self.check_order(place) } else { Ok(()) }
    }

    fn value(&mut self, place: &Place, cell: &str, is_position: bool) -> Result<f64, TopographyError> {
        let quoted = || format!("{:?}", shown(cell));
        let fault = match self.decimal.read(cell, self.separator) {
            Cell::Number(value) if value.abs() <= LARGEST * 1e12 => return Ok(value),
            Cell::Missing if !is_position => {
                self.first_missing.get_or_insert_with(|| place.clone());
                return Ok(f64::NAN);
            }
            Cell::OtherMark => {
                let fault = format!("{} has another decimal mark than the numbers before", quoted());
                return Err(refused(place.clone(), fault, "one decimal mark throughout"));
            }
            Cell::Missing if cell.is_empty() => "a column is empty".to_owned(),
            Cell::Number(_) | Cell::Missing | Cell::NoNumber => quoted(),
        };
        Err(refused(place.clone(), fault, format!("a number from -{LARGEST:e} to {LARGEST:e}")))
    }

    /// Checks that the positions of a profile either ascend or descend.
    fn check_order(&self, place: Place) -> Result<(), TopographyError> {
        let ([first, second, ..], [.., before, x]) = (&self.positions[0][..], &self.positions[0][..]) else {
            return Ok(());
        };
        let (is_in_order, allowed) = if first < second {
            (before < x, "ascending positions, as before")
        } else if first > second {
            (before > x, "descending positions, as before")
        } else {
            (false, "another position than before")
        };
        let fault = || format!("x = {x:e} after {before:e}");
        if is_in_order { Ok(()) } else { Err(refused(place, fault(), allowed)) }
    }

    fn finish(self, header: &Header) -> Result<Reading, TopographyError> {
        let Rows { columns, positions, heights, first_missing, .. } = self;
        let units = header.units(columns);
        let points = heights.len();
        let reading = match columns {
            1 => Reading::even("text columns", heights, points, None, units),
            2 => {
                let [positions, _] = positions;
                Reading::profile("text columns", positions, heights, units)
            }
            3 => {
                let (columns, spacing) = grid_of(&positions)?;
                Reading::even("text columns", heights, columns, Some(spacing), units)
            }
            columns => {
                let rows = points / columns;
                let [width, height] = header.sizes;
                let spacing =
                    width.zip(height).map(|(width, height)| [width / columns as f64, height / rows as f64]);
                // Sizes are in m.
                let lateral = if spacing.is_some() { Some(Unit::METRE) } else { units[0] };
                Reading::even("text matrix", heights, columns, spacing, [lateral, units[1]])
            }
        };
        Ok(Reading { first_missing, ..reading })
    }
}

/// Longest line, bytes: a row of a large matrix.
const LONGEST_LINE: usize = 1 << 24;

/// Returns the bytes of a text without a byte order mark; UTF-16 as UTF-8, with U+FFFD for invalid characters.
fn decoded(bytes: &[u8]) -> Result<Cow<'_, [u8]>, TopographyError> {
    let (encoding, mark) = Encoding::for_bom(bytes).unwrap_or((UTF_8, 0));
    let text = &bytes[mark..];
    if encoding == UTF_8 {
        return Ok(Cow::Borrowed(text));
    }
    check_room(2 * text.len() as u64)?;
    Ok(Cow::Owned(encoding.decode_without_bom_handling(text).0.into_owned().into_bytes()))
}

/// Returns a line without white space around it: UTF-8, or, if that is invalid, Windows-1252, in which older programs
/// write µ and °.
fn line_text<'a>(line: &'a [u8], place: &Place) -> Result<Cow<'a, str>, TopographyError> {
    let (fault, allowed) = if line.len() > LONGEST_LINE {
        (format!("longer than {LONGEST_LINE} bytes"), format!("at most {LONGEST_LINE} bytes"))
    } else if let Some(at) = line.iter().position(|byte| *byte == 0) {
        let formats = "text, SDF, GSF, NumPy array, X3P, GWY, SUR, NetCDF, or these in gzip";
        (format!("byte {at} of the line is zero, so this is no text"), formats.to_owned())
    } else {
        let line = line.trim_ascii();
        let other = |_| WINDOWS_1252.decode_without_bom_handling(line).0;
        return Ok(str::from_utf8(line).map_or_else(other, Cow::Borrowed));
    };
    Err(refused(place.clone(), fault, allowed))
}

/// Returns the number of columns and the distances along and between rows of points listed row by row, along x or y.
/// Each point lies on an even grid within 0.1 % of the distance between points.
fn grid_of([x, y]: &[Vec<f64>; 2]) -> Result<(usize, [f64; 2]), TopographyError> {
    let points = x.len();
    if points < 2 {
        return Err(refused(Place::File, format!("{points} points"), "at least 2"));
    }
    // The position that changes from the first point to the second is along the rows.
    let (along, between) = match (x[1] != x[0], y[1] != y[0]) {
        (true, false) => (x, y),
        (false, true) => (y, x),
        (same, _) => {
            let fault = if same { "x and y both differ from" } else { "x and y both equal" };
            let fault = format!("{fault} those of the point before");
            return Err(refused(Place::Point(2), fault, "points of a full grid, row by row"));
        }
    };
    let columns = between.iter().position(|position| *position != between[0]).unwrap_or(points);
    if !points.is_multiple_of(columns) {
        let fault = format!("{points} points in rows of {columns}");
        return Err(refused(Place::Point(points), fault, "full rows"));
    }
    let rows = points / columns;
    if columns < 2 {
        return Err(refused(Place::Point(2), "a row of 1 point", "rows of at least 2 points"));
    }
    let step = (along[columns - 1] - along[0]) / (columns - 1) as f64;
    let row_step = if rows > 1 { (between[points - 1] - between[0]) / (rows - 1) as f64 } else { step };
    for (index, (u, v)) in along.iter().zip(between).enumerate() {
        let off_row = (u - along[0] - (index % columns) as f64 * step).abs() / step.abs();
        let off_column = (v - between[0] - (index / columns) as f64 * row_step).abs() / row_step.abs();
        if off_row.is_nan() || off_column.is_nan() || off_row.max(off_column) > UNEVEN {
            return Err(refused(
                Place::Point(index + 1),
                format!("({:e}, {:e}) is off the even grid", x[index], y[index]),
                format!("points of a full grid, row by row, within {UNEVEN} of their distance"),
            ));
        }
    }
    Ok((columns, [step.abs(), row_step.abs()]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn text(text: &str) -> Result<Reading, String> {
        read(text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn a_profile_is_the_same_in_every_notation() {
        let expected = text("0.5 1e-1\n1.5 2.5\n2.5 -3\n").unwrap();
        assert_eq!(expected.positions, Some(vec![0.5, 1.5, 2.5]));
        assert_eq!(expected.heights, [0.1, 2.5, -3.0]);
        for other in [
            "0.5\t1e-1\r\n1.5\t2.5\r\n2.5\t-3\r\n",
            "# stylus\nx,z\n0.5, 1e-1\n\n1.5,2.5\n2.5 ,-3",
            "\u{feff}0,5;1e-1\n1,5;2,5\n2,5;-3\n",
            "0,5 0,1\n1,5 2,5\n2,5 -3,0",
            "x z\n2.5 -3\n1.5 2.5\n0.5 1e-1\n",
            "Instrument: A7\nPoints = 3\n0.5 0.1\n# pause\n1.5 2.5\n2.5 -3",
        ] {
            assert_eq!(text(other).unwrap(), expected, "{other}");
        }
        let units = text("x [µm];z [nm]\n0,5;1e-1\n1,5;2,5\n2,5;-3\n").unwrap();
        assert_eq!(units.units.map(|unit| unit.map(Unit::name)), [Some("µm"), Some("nm")]);
    }

    #[test]
    fn wrong_lines_are_named() {
        for (lines, expected) in [
            ("1 2\n1 3", "line 2: x = 1e0 after 1e0; allowed: another position than before"),
            ("1 2\n2 3\n1.5 3", "line 3: x = 1.5e0 after 2e0; allowed: ascending positions, as before"),
            ("3 2\n2 3\n2.5 3", "line 3: x = 2.5e0 after 2e0; allowed: descending positions, as before"),
            ("1 2\n2 3 4", "line 2: 3 columns; allowed: 2, position and height"),
            ("1 2 3 4\n1 2 3", "line 2: 3 columns; allowed: 4, as in the first row"),
            ("1 2\n2 what", "line 2: \"what\"; allowed: a number from -1e9 to 1e9"),
            ("1 2\ninf 2", "line 2: \"inf\"; allowed: a number from"),
            ("0,5;1\n1.5;2", "line 2: \"1.5\" has another decimal mark than the numbers before"),
            ("1;2\n;3", "line 2: a column is empty"),
            ("x;z\n", "no line of numbers; allowed: a line of numbers for each point or row"),
        ] {
            let error = text(lines).unwrap_err();
            assert!(error.starts_with(expected), "{lines:?}: {error}");
        }
    }

    proptest! {}

    #[test]
    fn binary_content_and_endless_lines_are_refused() {
        let error = |line: &[u8]| line_text(line, &Place::Line(2)).unwrap_err().to_string();
        assert!(error(b"b\0").starts_with("line 2: byte 1 of the line is zero"));
        let mut long = vec![b'1'; LONGEST_LINE];
        assert_eq!(line_text(&long, &Place::File).unwrap().len(), LONGEST_LINE);
        long.push(b'1');
        assert!(error(&long).starts_with("line 2: longer than 16777216 bytes"));
    }

    fn grid(points: &[(f64, f64)]) -> Result<(usize, [f64; 2]), String> {
        let (x, y) = points.iter().copied().unzip();
        grid_of(&[x, y]).map_err(|error| error.to_string())
    }

    #[test]
    fn rows_may_run_along_either_axis_and_in_either_direction() {
        let along_x = [(3.0, 0.0), (2.0, 0.0), (1.0, 0.0), (3.0, 5.0), (2.0, 5.0), (1.0, 5.0)];
        let expected = (3, [1.0, 5.0]);
        assert_eq!(grid(&along_x), Ok(expected));
        assert_eq!(grid(&along_x.map(|(x, y)| (y, x))), Ok(expected));
        assert_eq!(grid(&[(0.0, 1.0), (0.0, 3.0), (0.0, 5.0)]), Ok((3, [2.0; 2])));
    }

    #[test]
    fn points_off_the_grid_are_named() {
        for (points, place) in [
            (&[(0.0, 0.0), (1.0, 1.0)][..], "point 2: x and y both differ"),
            (&[(0.0, 0.0), (0.0, 0.0)], "point 2: x and y both equal"),
            (&[(0.0, 0.0), (1.0, 0.0), (2.5, 0.0), (3.0, 0.0)], "point 3: (2.5e0, 0e0) is off"),
            (&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)], "point 3: 3 points in rows of 2"),
            (&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.1, 1.0)], "point 4: (1.1e0, 1e0) is off"),
        ] {
            let error = grid(points).unwrap_err();
            assert!(error.starts_with(place), "{points:?}: {error}");
        }
    }
}
