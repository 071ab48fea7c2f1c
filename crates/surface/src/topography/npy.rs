//! NumPy arrays: a header in Python's notation, then the numbers.
//!
//! An array of n heights is a profile. An array of n × 2 numbers, or of n elements with two fields,
//! contains the columns x and z of a profile. Any other array with two axes is a map, stored row by
//! row. The header is parsed in this module, because the parser of the crate npyz takes seconds for
//! 20 nested brackets, and twice as long for each further bracket.

use super::bytes::{Bytes, Number, Order};
use super::reading::Reading;
use super::stated_units::StatedUnits;
use super::transpose::transposed;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{SIGNATURE, emptied, shown};

const FORMAT: &str = "NumPy array";

/// Place of the header in error messages: its offset in bytes in a file of version 1.
const HEADER: Place = Place::Byte(10);

/// Reads a profile or a map from a NumPy array. The documentation of this module states which
/// arrays are profiles and which are maps.
pub(super) fn read(bytes: &[u8]) -> Result<Reading, SurfaceError> {
    let (header, mut data) = Header::read(bytes)?;
    if header.is_profile() {
        let columns: Result<[Vec<f64>; 2], _> = header.columns(data)?.try_into();
        let Ok([positions, heights]) = columns else {
            return Err(header.wrong_axes("1 or 2 axes"));
        };
        let units = StatedUnits::default();
        return Ok(Reading::profile(FORMAT, positions, heights, units));
    }
    let [field] = &header.fields[..] else {
        let found = format!("points of {} fields", header.fields.len());
        return Err(refused(HEADER, found, "heights, or positions and heights"));
    };
    match header.shape[..] {
        [points] => Ok(even(data.numbers(points, field.number)?, points)),
        [rows, columns] => {
            let values = data.numbers(header.points(), field.number)?;
            if !header.is_column_major {
                return Ok(even(values, columns));
            }
            let by_rows = transposed(&values, rows)?;
            Ok(even(by_rows, columns))
        }
        _ => Err(header.wrong_axes("1 or 2 axes")),
    }
}

/// Creates a surface whose units and distances are not known.
fn even(heights: Vec<f64>, columns: usize) -> Reading {
    Reading::even(FORMAT, heights, columns, None, StatedUnits::default())
}

/// Parses a NumPy array with at least two columns, and returns the names and the numbers of the
/// columns. The columns of a structured array are its fields. In an array with two axes, the
/// columns lie along the shorter axis.
///
/// # Errors
/// Returns an error if the bytes are no such array.
pub fn columns(bytes: &[u8]) -> Result<(Vec<String>, Vec<Vec<f64>>), SurfaceError> {
    let (header, data) = Header::read(bytes)?;
    let columns = header.columns(data)?;
    let mut names: Vec<String> = header.fields.into_iter().map(|field| field.name).collect();
    names.retain(|name| !name.is_empty());
    Ok((names, columns))
}

/// A field of the elements of an array.
struct Field {
    /// Name of the field; empty in an array of plain numbers.
    name: String,
    number: Number,
}

struct Header {
    /// Fields of each element. An element that is a plain number has a single field.
    fields: Vec<Field>,
    order: Order,
    is_column_major: bool,
    shape: Vec<usize>,
}

impl Header {
    /// Reads the header of a file. Returns the header and the bytes after it.
    fn read(bytes: &[u8]) -> Result<(Self, Bytes<'_>), SurfaceError> {
        let mut data = Bytes::new(bytes, Order::Little);
        data.take(SIGNATURE.len())?;
        let length = match data.take(2)?[0] {
            1 => data.size(Number::U16)?,
            2 | 3 => data.size(Number::U32)?,
            other => {
                let found = format!("version {other}");
                return Err(refused(Place::Byte(6), found, "1, 2 or 3"));
            }
        };
        let text = String::from_utf8_lossy(data.take(length)?);
        let header = HeaderText { text: &text }.parse()?;
        data.order = header.order;
        Ok((header, data))
    }

    /// Returns true for an array whose elements have two fields, and for an array of n × 2 numbers.
    fn is_profile(&self) -> bool {
        self.fields.len() == 2 || matches!(self.shape[..], [2..=usize::MAX, 2])
    }

    fn points(&self) -> usize {
        let mut points = 1_usize;
        for axis in &self.shape {
            points = points.saturating_mul(*axis);
        }
        points
    }

    /// Returns the columns of the array: its fields, or the lines along the longer of its two axes.
    fn columns(&self, data: Bytes<'_>) -> Result<Vec<Vec<f64>>, SurfaceError> {
        match (&self.fields[..], &self.shape[..]) {
            ([field], &[rows, columns]) => self.columns_of_axes(data, field, rows, columns),
            ([_, _, ..], &[points]) => self.columns_of_fields(data, points),
            _ => Err(self.wrong_axes("points with fields, or 2 axes")),
        }
    }

    /// Returns the columns of an array with two axes. The shorter axis counts the columns. An array
    /// of two long rows, for example, has two columns.
    fn columns_of_axes(
        &self,
        mut data: Bytes<'_>,
        field: &Field,
        rows: usize,
        columns: usize,
    ) -> Result<Vec<Vec<f64>>, SurfaceError> {
        let values = data.numbers(self.points(), field.number)?;
        // Steps of the index in `values` to the next row and to the next column.
        let mut row_step = columns;
        let mut column_step = 1;
        if self.is_column_major {
            row_step = 1;
            column_step = rows;
        }
        let is_wide = columns > rows;
        if is_wide {
            std::mem::swap(&mut row_step, &mut column_step);
        }
        let points = rows.max(columns);
        let mut numbers = Vec::new();
        for column in 0..rows.min(columns) {
            let first = column * column_step;
            let of_column = (0..points).map(|point| values[first + point * row_step]);
            numbers.push(of_column.collect());
        }
        Ok(numbers)
    }

    fn columns_of_fields(
        &self,
        mut data: Bytes<'_>,
        points: usize,
    ) -> Result<Vec<Vec<f64>>, SurfaceError> {
        let size: usize = self.fields.iter().map(|field| field.number.size()).sum();
        let mut rows = data.part(points.saturating_mul(size))?;
        let mut columns = Vec::new();
        for _ in &self.fields {
            columns.push(emptied(Vec::new(), points)?);
        }
        for _ in 0..points {
            for (field, column) in self.fields.iter().zip(&mut columns) {
                column.push(rows.number(field.number)?);
            }
        }
        Ok(columns)
    }

    fn wrong_axes(&self, allowed: &str) -> SurfaceError {
        let found = format!("an array with {} axes", self.shape.len());
        refused(HEADER, found, allowed)
    }
}

/// Text of a header, such as `{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }`. The
/// entries may have any order.
struct HeaderText<'a> {
    text: &'a str,
}

impl<'a> HeaderText<'a> {
    fn parse(&self) -> Result<Header, SurfaceError> {
        let descr = self.entry("descr")?;
        let has_fields = descr.starts_with('[');
        let (fields, order) = self.fields(descr, has_fields)?;
        let is_column_major = match self.entry("fortran_order")? {
            value if value.starts_with("True") => true,
            value if value.starts_with("False") => false,
            _ => return Err(self.wrong("neither True nor False")),
        };
        let shape = self.shape()?;
        if has_fields && shape.len() != 1 {
            return Err(self.wrong("fields along several axes"));
        }
        Ok(Header {
            fields,
            order,
            // An array with fields has a single axis, so the order of its axes has no meaning.
            is_column_major: is_column_major && !has_fields,
            shape,
        })
    }

    /// Returns the text that follows a key of the header.
    fn entry(&self, key: &str) -> Result<&'a str, SurfaceError> {
        let Some((_, rest)) = self.text.split_once(&format!("'{key}'")) else {
            return Err(self.wrong(&format!("no {key}")));
        };
        match rest.trim_start().strip_prefix(':') {
            Some(value) => Ok(value.trim_start()),
            None => Err(self.wrong(&format!("no value of {key}"))),
        }
    }

    /// Returns the fields of an element, and the order of the bytes, which must be the same for all
    /// fields.
    fn fields(&self, descr: &str, has_fields: bool) -> Result<(Vec<Field>, Order), SurfaceError> {
        let types = if has_fields {
            field_types(descr).ok_or_else(|| self.wrong("fields that are not understood"))?
        } else {
            let descr = quoted(descr).ok_or_else(|| self.wrong("no type"))?;
            vec![FieldType { name: "", descr }]
        };
        let mut order = None;
        let mut fields = Vec::new();
        for FieldType { name, descr } in types {
            let (order_of_field, number) = match descr.split_at_checked(1) {
                Some(("<", number)) => (Some(Order::Little), number),
                Some((">", number)) => (Some(Order::Big), number),
                Some(("|", number)) => (None, number),
                _ => return Err(self.wrong("no order of bytes")),
            };
            if order.is_some() && order_of_field.is_some() && order_of_field != order {
                return Err(self.wrong("two orders of bytes"));
            }
            order = order.or(order_of_field);
            let Some(number) = Number::named(number) else {
                let found = format!("numbers of type {:?}", shown(descr));
                let allowed = "real and whole numbers: f2 to f8, i1 to u8";
                return Err(refused(HEADER, found, allowed));
            };
            fields.push(Field {
                name: name.to_owned(),
                number,
            });
        }
        Ok((fields, order.unwrap_or(Order::Little)))
    }

    fn shape(&self) -> Result<Vec<usize>, SurfaceError> {
        let inside = self.entry("shape")?.strip_prefix('(');
        let Some((axes, _)) = inside.and_then(|rest| rest.split_once(')')) else {
            return Err(self.wrong("no shape"));
        };
        let mut shape = Vec::new();
        for axis in axes.split(',').map(str::trim) {
            if !axis.is_empty() {
                let length = axis.parse().map_err(|_| self.wrong("no shape"))?;
                shape.push(length);
            }
        }
        Ok(shape)
    }

    fn wrong(&self, what: &str) -> SurfaceError {
        let found = format!("{what} in the header {:?}", shown(self.text));
        let allowed = "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), } and the like";
        refused(HEADER, found, allowed)
    }
}

/// Returns the text in the quotation marks with which `text` begins.
fn quoted(text: &str) -> Option<&str> {
    text.strip_prefix('\'')?
        .split_once('\'')
        .map(|(inside, _)| inside)
}

/// Name and type of a field, as in `('x', '<f8')`.
struct FieldType<'a> {
    name: &'a str,
    descr: &'a str,
}

/// Returns the fields in a list such as `[('x', '<f8'), ('z', '<f8')]`.
fn field_types(list: &str) -> Option<Vec<FieldType<'_>>> {
    let (list, _) = list.strip_prefix('[')?.split_once(']')?;
    let mut types = Vec::new();
    for field in list.split('(').skip(1) {
        let (name, descr) = field.split_once(',')?;
        types.push(FieldType {
            name: quoted(name)?,
            descr: quoted(descr.trim_start())?,
        });
    }
    Some(types)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(descr: &str, is_column_major: bool, shape: &str, numbers: &[u8]) -> Vec<u8> {
        let order = if is_column_major { "True" } else { "False" };
        let header =
            format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}\n");
        [
            SIGNATURE,
            b"\x01\0",
            &(header.len() as u16).to_le_bytes(),
            header.as_bytes(),
            numbers,
        ]
        .concat()
    }

    #[test]
    fn both_orders_of_the_indices_hold_the_same_map_and_columns() {
        let by_rows = array("'|u1'", false, "(2, 3)", &[1, 2, 3, 4, 5, 6]);
        let by_columns = array("'|u1'", true, "(2, 3)", &[1, 4, 2, 5, 3, 6]);
        let found = read(&by_columns).unwrap();
        assert_eq!(
            (found.columns, &found.heights[..]),
            (3, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0][..])
        );
        assert_eq!(read(&by_rows).unwrap(), found);
        assert_eq!(columns(&by_columns).unwrap(), columns(&by_rows).unwrap());
        let profile = read(&array("'|u1'", true, "(3, 2)", &[1, 2, 3, 7, 8, 9])).unwrap();
        assert_eq!(
            (profile.positions, profile.heights),
            (Some(vec![1.0, 2.0, 3.0]), vec![7.0, 8.0, 9.0])
        );
    }

    #[test]
    fn numbers_have_any_order_of_bytes_and_fields_of_points_are_positions_and_heights() {
        // These bytes are 1.0 and −2.0 as half-precision numbers of 16 bits.
        for (descr, bytes) in [("'>f2'", [0x3c, 0, 0xc0, 0]), ("'<f2'", [0, 0x3c, 0, 0xc0])] {
            assert_eq!(
                read(&array(descr, false, "(2,)", &bytes)).unwrap().heights,
                [1.0, -2.0]
            );
        }
        let pairs = array(
            "[('x', '>i2'), ('z', '>i2')]",
            false,
            "(2,)",
            &[0, 1, 0, 7, 0, 2, 0, 8],
        );
        let found = read(&pairs).unwrap();
        assert_eq!(
            (found.positions, found.heights),
            (Some(vec![1.0, 2.0]), vec![7.0, 8.0])
        );
    }
}
