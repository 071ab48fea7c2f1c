//! Arrays of NumPy: a header in Python's notation, then the numbers.
//!
//! An array of n heights is a profile, one of n × 2 or of n pairs of fields the columns x z of a profile, any other
//! with two axes a map of rows.

use super::bytes::{Bytes, Number, Order};
use super::error::{Place, TopographyError, refused, shown};
use super::reading::{Format, RawGrid, Reading};
pub(super) use crate::io::npy::SIGNATURE;

const NUMBERS: [(&str, Number); 10] = [
    ("f8", Number::F64),
    ("f4", Number::F32),
    ("i1", Number::I8),
    ("i2", Number::I16),
    ("i4", Number::I32),
    ("i8", Number::I64),
    ("u1", Number::U8),
    ("u2", Number::U16),
    ("u4", Number::U32),
    ("u8", Number::U64),
];

/// Reads an array of format version 1, 2 or 3.
pub(super) fn read(bytes: &[u8]) -> Result<Reading, TopographyError> {
    let mut data = Bytes::new(bytes);
    data.take(SIGNATURE.len())?;
    let version = data.take(2)?;
    let length = match version[0] {
        1 => usize::from(data.u16()?),
        2 | 3 => data.u32()? as usize,
        other => return Err(refused(Place::Byte(6), format!("version {other}"), "1, 2 or 3")),
    };
    let header = Header::parse(&String::from_utf8_lossy(data.take(length)?))?;
    let points = header.shape.iter().try_fold(1_usize, |points, axis| points.checked_mul(*axis));
    let points = points.unwrap_or(usize::MAX);
    let values = data.numbers(points, header.number, header.order)?;
    header.into_reading(values)
}

/// Content of the header.
#[derive(Debug, PartialEq)]
struct Header {
    number: Number,
    order: Order,
    column_major: bool,
    shape: Vec<usize>,
}

impl Header {
    /// Reads `{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }`, in any order.
    fn parse(text: &str) -> Result<Self, TopographyError> {
        let wrong = |what: &str| {
            let allowed = "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), } and the like";
            refused(Place::Byte(10), format!("{what} in the header {:?}", shown(text)), allowed)
        };
        let entry = |key: &str| {
            let (_, rest) =
                text.split_once(&format!("'{key}'")).ok_or_else(|| wrong(&format!("no {key}")))?;
            let value =
                rest.trim_start().strip_prefix(':').ok_or_else(|| wrong(&format!("no value of {key}")))?;
            Ok::<&str, TopographyError>(value.trim_start())
        };
        let between = |value: &'_ str, open: char, close: char| {
            value.strip_prefix(open)?.split_once(close).map(|(inside, _)| inside.to_owned())
        };
        let (descr, fields) = match entry("descr")? {
            list if list.starts_with('[') => {
                let types = field_types(list).ok_or_else(|| wrong("fields that are not understood"))?;
                let [first, ..] = types[..] else { return Err(wrong("no field")) };
                if types.len() > 2 || types.iter().any(|one| *one != first) {
                    return Err(wrong("other fields than one or two of the same type"));
                }
                (first.to_owned(), Some(types.len()))
            }
            name => (between(name, '\'', '\'').ok_or_else(|| wrong("no type"))?, None),
        };
        let (order, name) = match descr.split_at_checked(1) {
            Some(("<" | "|", name)) => (Order::Little, name),
            Some((">", name)) => (Order::Big, name),
            _ => return Err(wrong("no order of bytes")),
        };
        let number =
            NUMBERS.iter().find(|(one, _)| *one == name).map(|(_, number)| *number).ok_or_else(|| {
                refused(
                    Place::Byte(10),
                    format!("numbers of type {:?}", shown(&descr)),
                    "real and whole numbers: f4, f8, i1 to u8",
                )
            })?;
        let column_major = match entry("fortran_order")? {
            value if value.starts_with("True") => true,
            value if value.starts_with("False") => false,
            _ => return Err(wrong("neither True nor False")),
        };
        let shape = between(entry("shape")?, '(', ')').ok_or_else(|| wrong("no shape"))?;
        let axes = shape.split(',').map(str::trim).filter(|axis| !axis.is_empty());
        let mut shape: Vec<usize> =
            axes.map(|axis| axis.parse().map_err(|_| wrong("no shape"))).collect::<Result<_, _>>()?;
        match fields {
            Some(_) if shape.len() != 1 => return Err(wrong("fields along several axes")),
            // Fields of a point are consecutive, like the columns of a row.
            Some(2) => shape.push(2),
            _ => {}
        }
        // A list of points with fields has one axis and no order of axes.
        Ok(Header { number, order, column_major: column_major && fields.is_none(), shape })
    }

    fn into_reading(self, values: Vec<f64>) -> Result<Reading, TopographyError> {
        let reading = |heights, grid| Reading {
            format: Format::Npy,
            heights,
            grid,
            lateral_unit: None,
            height_unit: None,
            first_missing: None,
        };
        match self.shape[..] {
            [_] => Ok(reading(values, RawGrid::Profile(None))),
            [points, 2] => {
                let at = |index: usize, axis: usize| {
                    if self.column_major { axis * points + index } else { 2 * index + axis }
                };
                let mut positions: Vec<f64> = (0..points).map(|index| values[at(index, 0)]).collect();
                let mut heights: Vec<f64> = (0..points).map(|index| values[at(index, 1)]).collect();
                if points > 1 && positions[0] > positions[1] {
                    // A profile scanned backwards is the same profile.
                    positions.reverse();
                    heights.reverse();
                }
                // NaN compares as false.
                let ascends = |pair: &[f64]| pair[0] < pair[1];
                match positions.windows(2).position(|pair| !ascends(pair)) {
                    Some(index) => Err(refused(
                        Place::Point(index + 2),
                        format!("x = {:e} after {:e}", positions[index + 1], positions[index]),
                        "positions that ascend, or descend",
                    )),
                    None => Ok(reading(heights, RawGrid::Positions(positions))),
                }
            }
            // A transposed array has exchanged axes, and with them rows and columns.
            [rows, columns] if self.column_major => Ok(reading(values, RawGrid::of(rows, columns, None))),
            [rows, columns] => Ok(reading(values, RawGrid::of(columns, rows, None))),
            _ => {
                let fault = format!("an array with {} axes", self.shape.len());
                Err(refused(Place::Byte(10), fault, "1 or 2 axes"))
            }
        }
    }
}

/// Types of the fields in a list such as `[('x', '<f8'), ('z', '<f8')]`.
fn field_types(list: &str) -> Option<Vec<&str>> {
    let (list, _) = list.strip_prefix('[')?.split_once(']')?;
    let fields = list.split('(').skip(1).map(|field| {
        let (_, rest) = field.split_once(',')?;
        rest.trim_start().strip_prefix('\'')?.split_once('\'').map(|(name, _)| name)
    });
    fields.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(header: &str, numbers: &[u8]) -> Vec<u8> {
        [SIGNATURE, &[1, 0], &(header.len() as u16).to_le_bytes(), header.as_bytes(), numbers].concat()
    }

    fn doubles(header: &str, numbers: &[f64]) -> Vec<u8> {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        array(header, &bytes)
    }

    #[test]
    fn arrays_are_profiles_and_maps() {
        let six = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let map =
            read(&doubles("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }", &six)).unwrap();
        assert_eq!((map.grid, &map.heights[..]), (RawGrid::Map { columns: 3, spacing: None }, &six[..]));
        let turned =
            read(&doubles("{'descr': '<f8', 'fortran_order': True, 'shape': (2, 3), }", &six)).unwrap();
        assert_eq!(turned.grid, RawGrid::Map { columns: 2, spacing: None });
        let profile =
            read(&doubles("{'shape': (6,), 'fortran_order': False, 'descr': '<f8'}", &six)).unwrap();
        assert_eq!(profile.grid, RawGrid::Profile(None));
        for (order, numbers) in
            [("False", [3.0, 1.0, 2.0, 5.0, 1.0, 7.0]), ("True", [3.0, 2.0, 1.0, 1.0, 5.0, 7.0])]
        {
            let columns = format!("{{'descr': '<f8', 'fortran_order': {order}, 'shape': (3, 2), }}");
            let profile = read(&doubles(&columns, &numbers)).unwrap();
            assert_eq!(profile.grid, RawGrid::Positions(vec![1.0, 2.0, 3.0]));
            assert_eq!(profile.heights, [7.0, 5.0, 1.0]);
        }
        let fields = "{'descr': [('x', '<f8'), ('z', '<f8')], 'fortran_order': False, 'shape': (3,), }";
        let profile = read(&doubles(fields, &six)).unwrap();
        assert_eq!(profile.grid, RawGrid::Positions(vec![1.0, 3.0, 5.0]));
        let field = "{'descr': [('z', '<f8')], 'fortran_order': False, 'shape': (6,), }";
        assert_eq!(read(&doubles(field, &six)).unwrap().grid, RawGrid::Profile(None));
        let big = array("{'descr': '>i2', 'fortran_order': False, 'shape': (2,), }", &[0, 1, 255, 254]);
        assert_eq!(read(&big).unwrap().heights, [1.0, -2.0]);
    }

    #[test]
    fn faults_have_a_place() {
        for (header, expected) in [
            ("{'descr': '<c16', 'fortran_order': False, 'shape': (3,)}", "byte 10: numbers of type \"<c16\""),
            (
                "{'descr': [('a', '<f8'), ('b', '<u8')], 'fortran_order': False, 'shape': (3,)}",
                "byte 10: other fields than one or two",
            ),
            ("{'descr': [], 'fortran_order': False, 'shape': (3,)}", "byte 10: no field in"),
            ("{'descr': [('a')], 'fortran_order': False, 'shape': (3,)}", "byte 10: fields that are not"),
            (
                "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (3, 1)}",
                "byte 10: fields along several axes in",
            ),
            ("{'descr': '<f8', 'shape': (3,)}", "byte 10: no fortran_order in"),
            ("{'descr': '<f8', 'fortran_order': False, 'shape': (3, 1, 1)}", "byte 10: an array with 3 axes"),
            ("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999, 99999999999)}", "byte "),
            ("{'descr': '<f8', 'fortran_order': False, 'shape': (4,)}", "byte "),
            ("", "byte 10: no descr in"),
        ] {
            let error = read(&doubles(header, &[0.0; 3])).unwrap_err().to_string();
            assert!(error.starts_with(expected) && error.contains("allowed: "), "{header}: {error}");
        }
        let level =
            doubles("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 2), }", &[1.0, 0.0, 1.0, 0.0]);
        assert!(read(&level).unwrap_err().to_string().starts_with("point 2: x = 1e0 after 1e0"));
    }
}
