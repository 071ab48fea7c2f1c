//! Surfaces in text: columns z, x z or x y z, or a matrix of heights.
//!
//! Lines before the first line of numbers are a header; empty lines and lines that begin with `#`, `%` or `!` are
//! skipped. The first line of numbers fixes the separator ([`layout::Separator::of`]) and the number of columns: one
//! is z, two are x z, three are x y z of a full grid row by row, four and more are a row of a matrix.

mod grid;
mod header;
mod layout;
mod lines;
mod plain;

use super::Unit;
use super::error::{Place, TopographyError, refused, shown};
use super::reading::{Format, LARGEST, RawGrid, Reading};
use crate::io::PROVENANCE;
use header::Header;
use layout::{Cell, Decimal, Separator};
use lines::{Lines, decoded};
use plain::{Direction, PlainForm, Points};

/// Most bytes whose plain lines are read at once: their points are reserved before.
const BLOCK: usize = 1 << 16;

/// Reads a text line by line.
pub(super) fn read(bytes: &[u8]) -> Result<Reading, TopographyError> {
    read_in_blocks(&decoded(bytes)?, BLOCK)
}

fn read_in_blocks(text: &[u8], block: usize) -> Result<Reading, TopographyError> {
    let mut lines = Lines::new(text);
    let mut header = Header::default();
    let mut rows: Option<Rows> = None;
    let mut in_provenance = false;
    while let Some((number, line)) = lines.next()? {
        let line = line.trim_ascii();
        if line.is_empty() {
            continue;
        }
        let comment = line.starts_with(['#', '%', '!']);
        // The words of a scene may look like units.
        in_provenance = comment && (in_provenance || line.starts_with(PROVENANCE));
        match &mut rows {
            Some(_) if comment => {}
            None if in_provenance => {}
            Some(rows) => {
                rows.take(number, line)?;
                lines.take_block(block, |plain| rows.take_plain(plain));
            }
            None if comment || is_header(line) => header.take(line),
            None => {
                let mut first = Rows::new(line);
                first.take(number, line)?;
                rows = Some(first);
            }
        }
    }
    match rows {
        Some(rows) => rows.finish(&header),
        None => Err(refused(Place::File, "no line of numbers", "a line of numbers for each point or row")),
    }
}

/// Returns true for a line whose first column is neither a number nor a mark of a missing point.
fn is_header(line: &str) -> bool {
    let separator = Separator::of(line);
    let first = separator.split(line).next().unwrap_or_default();
    matches!(Decimal::default().read(first, separator), Cell::NoNumber)
}

/// Lines of numbers.
struct Rows {
    separator: Separator,
    decimal: Decimal,
    columns: usize,
    points: Points,
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
            points: Points::default(),
            first_missing: None,
        }
    }

    fn form(&self) -> PlainForm {
        let has_commas = self.decimal.is_comma();
        PlainForm { separator: self.separator, has_commas, columns: self.columns }
    }

    /// Reads the plain lines at the beginning of a block. Returns their bytes and their number.
    fn take_plain(&mut self, block: &[u8]) -> (usize, usize) {
        let read = self.points.read(block, self.form());
        if self.separator != Separator::Comma {
            self.decimal.look_for_point(&block[..read.0]);
        }
        read
    }

    /// Reads a line without spaces around it.
    fn take(&mut self, number: usize, line: &str) -> Result<(), TopographyError> {
        let positions = self.form().position_columns();
        let mut found = 0;
        for cell in self.separator.split(line) {
            let value = self.value(number, cell, found < positions)?;
            let values = match found {
                0 | 1 if found < positions => &mut self.points.positions[found],
                _ => &mut self.points.heights,
            };
            let points = values.len();
            values.try_reserve(1).map_err(|_| TopographyError::OutOfMemory { points })?;
            values.push(value);
            found += 1;
            if found > self.columns {
                break;
            }
        }
        if found != self.columns {
            let count = self.separator.split(line).count();
            let expected = match self.columns {
                1 => "1, the height".to_owned(),
                2 => "2, position and height".to_owned(),
                3 => "3, two positions and height".to_owned(),
                columns => format!("{columns}, as in the first row"),
            };
            return Err(refused(Place::Line(number), format!("{count} columns"), expected));
        }
        if self.columns == 2 { self.check_order(number) } else { Ok(()) }
    }

    fn value(&mut self, number: usize, cell: &str, is_position: bool) -> Result<f64, TopographyError> {
        let place = Place::Line(number);
        let range = format!("a number from -{LARGEST:e} to {LARGEST:e}");
        match self.decimal.read(cell, self.separator) {
            Cell::Number(value) if value.abs() <= LARGEST * 1e12 && value.is_finite() => Ok(value),
            Cell::Missing if !is_position => {
                self.first_missing.get_or_insert(place);
                Ok(f64::NAN)
            }
            Cell::Missing if cell.is_empty() => Err(refused(place, "a column is empty", range)),
            Cell::OtherMark => Err(refused(
                place,
                format!("{} has another decimal mark than the numbers before", quoted(cell)),
                "one decimal mark throughout",
            )),
            Cell::Number(_) | Cell::Missing | Cell::NoNumber => Err(refused(place, quoted(cell), range)),
        }
    }

    /// Checks that the positions of a profile either ascend or descend.
    fn check_order(&mut self, number: usize) -> Result<(), TopographyError> {
        let [.., before, x] = self.points.positions[0][..] else { return Ok(()) };
        let now = if x > before { Direction::Ascending } else { Direction::Descending };
        if self.points.direction == Direction::Unknown && x != before {
            self.points.direction = now;
        }
        if x == before || now != self.points.direction {
            let order = match self.points.direction {
                Direction::Unknown => "another position than before",
                Direction::Ascending => "ascending positions, as before",
                Direction::Descending => "descending positions, as before",
            };
            return Err(refused(Place::Line(number), format!("x = {x:e} after {before:e}"), order));
        }
        Ok(())
    }

    fn finish(mut self, header: &Header) -> Result<Reading, TopographyError> {
        let (mut lateral_unit, height_unit) = header.units(self.columns);
        let (format, grid) = match self.columns {
            1 => (Format::Columns, RawGrid::Profile(None)),
            2 => {
                let [mut positions, _] = std::mem::take(&mut self.points.positions);
                if self.points.direction == Direction::Descending {
                    // A profile scanned backwards is the same profile.
                    positions.reverse();
                    self.points.heights.reverse();
                }
                (Format::Columns, RawGrid::Positions(positions))
            }
            3 => (Format::Columns, grid::from_points(&self.points.positions)?),
            columns => {
                let rows = self.points.heights.len() / columns;
                let spacing = match header.sizes {
                    [Some(width), Some(height)] => {
                        lateral_unit = Some(Unit::METRE);
                        Some([width / columns as f64, height / rows as f64])
                    }
                    _ => None,
                };
                (Format::Matrix, RawGrid::Map { columns, spacing })
            }
        };
        let Rows { points: Points { heights, .. }, first_missing, .. } = self;
        Ok(Reading { format, heights, grid, lateral_unit, height_unit, first_missing })
    }
}

fn quoted(cell: &str) -> String {
    format!("{:?}", shown(cell))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A line of a text, mostly of two ascending numbers.
    fn line(index: usize) -> impl Strategy<Value = String> {
        let x = index as f64 * 0.5;
        prop_oneof![
            20 => (-1e3..1e3_f64).prop_map(move |z| format!("{x} {z:.3}")),
            4 => any::<f64>().prop_map(move |z| format!("{x} {z:e}")),
            1 => Just("# 1 2".to_owned()),
            1 => Just(String::new()),
            1 => Just(format!("  {x}   7 \r")),
            2 => any::<f64>().prop_map(move |z| format!("  {x:.18e} {:.18e}", z % 1e20)),
            1 => Just(format!("{x} bad")),
            1 => prop::sample::select(vec!["1 2 3", "0 1", "1", "1,5 2,5", "1e400 1", "1e30 1", "-3 1", "x 1"])
                .prop_map(str::to_owned),
        ]
    }

    proptest! {
        #[test]
        fn lines_read_in_blocks_are_those_read_one_by_one(
            lines in (1..60_usize).prop_flat_map(|count| (0..count).map(line).collect::<Vec<_>>()),
            capacity in 8..200_usize,
        ) {
            let text = lines.join("\n");
            // A block of one byte holds no whole line.
            let expected = format!("{:?}", read_in_blocks(text.as_bytes(), 1));
            prop_assert_eq!(&format!("{:?}", read(text.as_bytes())), &expected, "{}", text);
            let found = read_in_blocks(text.as_bytes(), capacity);
            prop_assert_eq!(&format!("{found:?}"), &expected, "{}", text);
        }
    }

    fn text(text: &str) -> Result<Reading, String> {
        read(text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn a_profile_is_the_same_in_every_notation() {
        let expected = text("0.5 1e-1\n1.5 2.5\n2.5 -3\n").unwrap();
        assert_eq!(expected.grid, RawGrid::Positions(vec![0.5, 1.5, 2.5]));
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
        assert_eq!(
            [units.lateral_unit, units.height_unit].map(|unit| unit.map(Unit::name)),
            [Some("µm"), Some("nm")]
        );
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

    #[test]
    fn missing_heights_are_marked_with_their_line() {
        let reading = text("x z\n1;2\n2;NaN\n3;\n4;5").unwrap();
        assert_eq!(reading.first_missing, Some(Place::Line(3)));
        assert_eq!(
            reading.heights.iter().map(|z| z.is_nan()).collect::<Vec<_>>(),
            [false, true, true, false]
        );
    }

    #[test]
    fn matrices_and_lists_of_points_are_maps() {
        let matrix = text("# Width: 4 µm\n# Height: 1 µm\n# Value units: m\n1 2 3 4\n5 6 7 8").unwrap();
        assert_eq!(matrix.grid, RawGrid::Map { columns: 4, spacing: Some([1e-6, 5e-7]) });
        assert_eq!((matrix.lateral_unit, matrix.height_unit), (Some(Unit::METRE), Some(Unit::METRE)));
        let points = text("0 0 1\n2 0 2\n4 0 3\n0 1 4\n2 1 5\n4 1 6").unwrap();
        assert_eq!(points.grid, RawGrid::Map { columns: 3, spacing: Some([2.0, 1.0]) });
        assert_eq!(points.heights, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(text("1\n2\n3").unwrap().grid, RawGrid::Profile(None));
    }

    proptest! {
        #[test]
        fn numbers_come_back_whatever_separates_them(
            heights in prop::collection::vec(-1e9..1e9_f64, 2..50),
            separator in prop::sample::select(vec![" ", "\t", ";", ",", ", ", "  "]),
            end in prop::sample::select(vec!["\n", "\r\n"]),
        ) {
            let lines: String =
                heights.iter().enumerate().map(|(x, z)| format!("{x}{separator}{z:?}{end}")).collect();
            let reading = text(&lines).unwrap();
            prop_assert_eq!(&reading.heights, &heights);
            let comma = lines.replace(',', ";").replace('.', ",");
            if separator == ";" || separator == "\t" {
                prop_assert_eq!(text(&comma).unwrap(), reading);
            }
        }
    }
}
