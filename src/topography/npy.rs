//! Arrays of NumPy: a header in Python's notation, then the numbers.
//!
//! An array of n heights is a profile, one of n × 2 or of n pairs of fields the columns x z of a profile, any other
//! with two axes a map of rows. The header is parsed here: the parser of the crate npyz takes seconds for 20 nested
//! brackets, and twice as long for each further one.

use super::bytes::{Bytes, Number, Order};
use super::error::{Place, TopographyError, refused, shown};
use super::reading::{Format, RawGrid, Reading};
pub(super) use crate::io::npy::SIGNATURE;

/// Reads an array of format version 1, 2 or 3.
pub(super) fn read(bytes: &[u8]) -> Result<Reading, TopographyError> {
    let mut data = Bytes::new(bytes, Order::Little);
    data.take(SIGNATURE.len())?;
    let length = match data.take(2)?[0] {
        1 => data.size(Number::U16)?,
        2 | 3 => data.size(Number::U32)?,
        other => return Err(refused(Place::Byte(6), format!("version {other}"), "1, 2 or 3")),
    };
    let header = Header::parse(&String::from_utf8_lossy(data.take(length)?))?;
    data.order = header.order;
    let points = header.shape.iter().fold(1, |points: usize, axis| points.saturating_mul(*axis));
    let values = data.numbers(points, header.number)?;
    header.into_reading(values)
}

/// Content of the header.
struct Header {
    number: Number,
    order: Order,
    is_column_major: bool,
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
            let value = rest.trim_start().strip_prefix(':').map(str::trim_start);
            value.ok_or_else(|| wrong(&format!("no value of {key}")))
        };
        let descr = entry("descr")?;
        let is_list = descr.starts_with('[');
        let types = if is_list { field_types(descr) } else { quoted(descr).map(|name| vec![name]) };
        let types =
            types.ok_or_else(|| wrong(if is_list { "fields that are not understood" } else { "no type" }))?;
        let [descr, ref others @ ..] = types[..] else { return Err(wrong("no field")) };
        if others.len() > 1 || others.iter().any(|other| *other != descr) {
            return Err(wrong("other fields than one or two of the same type"));
        }
        let (order, name) = match descr.split_at_checked(1) {
            Some(("<" | "|", name)) => (Order::Little, name),
            Some((">", name)) => (Order::Big, name),
            _ => return Err(wrong("no order of bytes")),
        };
        let number = match name {
            "f8" => Number::F64,
            "f4" => Number::F32,
            "i1" => Number::I8,
            "i2" => Number::I16,
            "i4" => Number::I32,
            "i8" => Number::I64,
            "u1" => Number::U8,
            "u2" => Number::U16,
            "u4" => Number::U32,
            "u8" => Number::U64,
            _ => {
                let fault = format!("numbers of type {:?}", shown(descr));
                return Err(refused(Place::Byte(10), fault, "real and whole numbers: f4, f8, i1 to u8"));
            }
        };
        let is_column_major = match entry("fortran_order")? {
            value if value.starts_with("True") => true,
            value if value.starts_with("False") => false,
            _ => return Err(wrong("neither True nor False")),
        };
        let shape = entry("shape")?.strip_prefix('(').and_then(|rest| rest.split_once(')'));
        let axes = shape.ok_or_else(|| wrong("no shape"))?.0.split(',').map(str::trim);
        let axes =
            axes.filter(|axis| !axis.is_empty()).map(|axis| axis.parse().map_err(|_| wrong("no shape")));
        let mut shape = axes.collect::<Result<Vec<usize>, _>>()?;
        if is_list && shape.len() != 1 {
            return Err(wrong("fields along several axes"));
        }
        if types.len() == 2 {
            // Fields of a point are consecutive, like the columns of a row.
            shape.push(2);
        }
        // A list of points with fields has one axis and no order of axes.
        Ok(Header { number, order, is_column_major: is_column_major && !is_list, shape })
    }

    fn into_reading(self, mut values: Vec<f64>) -> Result<Reading, TopographyError> {
        // A transposed array has exchanged axes, and with them rows and columns.
        let grid = match (&self.shape[..], self.is_column_major) {
            ([_], _) => RawGrid::Profile(None),
            ([points, 2], is_column_major) => {
                let at = |index: usize, axis: usize| {
                    values[if is_column_major { axis * points + index } else { 2 * index + axis }]
                };
                let positions = (0..*points).map(|index| at(index, 0)).collect();
                let mut heights: Vec<f64> = (0..*points).map(|index| at(index, 1)).collect();
                let grid = RawGrid::scanned(positions, &mut heights);
                values = heights;
                grid
            }
            ([columns, rows], true) | ([rows, columns], false) => RawGrid::of(*columns, *rows, None),
            (shape, _) => {
                let fault = format!("an array with {} axes", shape.len());
                return Err(refused(Place::Byte(10), fault, "1 or 2 axes"));
            }
        };
        // NaN compares as false.
        let ascends = |pair: &[f64]| pair[0] < pair[1];
        if let RawGrid::Positions(positions) = &grid
            && let Some(index) = positions.windows(2).position(|pair| !ascends(pair))
        {
            let fault = format!("x = {:e} after {:e}", positions[index + 1], positions[index]);
            return Err(refused(Place::Point(index + 2), fault, "positions that ascend, or descend"));
        }
        Ok(Reading::new(Format::Npy, values, grid, [None, None]))
    }
}

/// Returns the text within the quotation marks that begin a text.
fn quoted(text: &str) -> Option<&str> {
    text.strip_prefix('\'')?.split_once('\'').map(|(inside, _)| inside)
}

/// Returns the types of the fields in a list such as `[('x', '<f8'), ('z', '<f8')]`.
fn field_types(list: &str) -> Option<Vec<&str>> {
    let (list, _) = list.strip_prefix('[')?.split_once(']')?;
    list.split('(').skip(1).map(|field| quoted(field.split_once(',')?.1.trim_start())).collect()
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
