//! NumPy arrays: a header in Python's notation, then the numbers.
//!
//! An array of n heights is a profile. An array of n × 2 numbers, or of n pairs of fields, holds
//! the columns x and z of a profile. Any other array with two axes is a map, row by row. The header
//! is parsed here, because the parser of the crate npyz takes seconds for 20 nested brackets, and
//! twice as long for each further one.

use super::bytes::{Bytes, Number, Order};
use super::reading::Reading;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{SIGNATURE, emptied, gathered, shown};

pub(super) fn read(bytes: &[u8]) -> Result<Reading, SurfaceError> {
    const FORMAT: &str = "NumPy array";
    let (header, mut data) = Header::read(bytes)?;
    let even = |heights, columns| Ok(Reading::even(FORMAT, heights, columns, None, [None; 3]));
    match (&header.fields[..], &header.shape[..]) {
        ([_, _], _) | (_, [2..=usize::MAX, 2]) => {
            let [positions, heights] = header
                .columns(data)?
                .try_into()
                .map_err(|_| header.wrong_axes("1 or 2 axes"))?;
            Ok(Reading::profile(FORMAT, positions, heights, [None; 2]))
        }
        (&[(_, number)], &[points]) => even(data.numbers(points, number)?, points),
        (&[(_, number)], &[rows, columns]) => {
            let values = data.numbers(header.points(), number)?;
            if !header.is_column_major {
                return even(values, columns);
            }
            let of_row = |row: usize| values.iter().skip(row).step_by(rows).copied();
            even(gathered(values.len(), (0..rows).flat_map(of_row))?, columns)
        }
        ([_], _) => Err(header.wrong_axes("1 or 2 axes")),
        _ => {
            let fault = format!("points of {} fields", header.fields.len());
            Err(refused(
                Place::Byte(10),
                fault,
                "heights, or positions and heights",
            ))
        }
    }
}

/// Parses a NumPy array with at least two columns. Returns the names of the columns, and the
/// numbers of each column. In a structured array the fields are the columns. In an array with two
/// axes the number of columns is the length of the shorter axis.
pub fn columns(bytes: &[u8]) -> Result<(Vec<String>, Vec<Vec<f64>>), SurfaceError> {
    let (header, data) = Header::read(bytes)?;
    let columns = header.columns(data)?;
    let names = header
        .fields
        .into_iter()
        .map(|(name, _)| name)
        .filter(|name| !name.is_empty());
    Ok((names.collect(), columns))
}

struct Header {
    /// Names and types of the fields of a point; one field without a name in an array of plain
    /// numbers.
    fields: Vec<(String, Number)>,
    order: Order,
    is_column_major: bool,
    shape: Vec<usize>,
}

impl Header {
    /// Reads the header of a file, and returns it with the bytes after it.
    fn read(bytes: &[u8]) -> Result<(Self, Bytes<'_>), SurfaceError> {
        let mut data = Bytes::new(bytes, Order::Little);
        data.take(SIGNATURE.len())?;
        let length = match data.take(2)?[0] {
            1 => data.size(Number::U16)?,
            2 | 3 => data.size(Number::U32)?,
            other => {
                return Err(refused(
                    Place::Byte(6),
                    format!("version {other}"),
                    "1, 2 or 3",
                ));
            }
        };
        let header = Header::parse(&String::from_utf8_lossy(data.take(length)?))?;
        data.order = header.order;
        Ok((header, data))
    }

    fn points(&self) -> usize {
        self.shape
            .iter()
            .fold(1, |points: usize, axis| points.saturating_mul(*axis))
    }

    /// Reads `{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }`, in any order.
    fn parse(text: &str) -> Result<Self, SurfaceError> {
        let wrong = |what: &str| {
            let allowed =
                "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), } and the like";
            refused(
                Place::Byte(10),
                format!("{what} in the header {:?}", shown(text)),
                allowed,
            )
        };
        let entry = |key: &str| {
            let (_, rest) = text
                .split_once(&format!("'{key}'"))
                .ok_or_else(|| wrong(&format!("no {key}")))?;
            let value = rest.trim_start().strip_prefix(':').map(str::trim_start);
            value.ok_or_else(|| wrong(&format!("no value of {key}")))
        };
        let descr = entry("descr")?;
        let is_list = descr.starts_with('[');
        let types = if is_list {
            field_types(descr)
        } else {
            quoted(descr).map(|name| vec![("", name)])
        };
        let types = types.ok_or_else(|| {
            wrong(if is_list {
                "fields that are not understood"
            } else {
                "no type"
            })
        })?;
        let mut order = None;
        let mut fields = Vec::new();
        for (field, descr) in types {
            let (of_field, name) = match descr.split_at_checked(1) {
                Some(("<", name)) => (Some(Order::Little), name),
                Some((">", name)) => (Some(Order::Big), name),
                Some(("|", name)) => (None, name),
                _ => return Err(wrong("no order of bytes")),
            };
            if order.is_some() && of_field.is_some() && of_field != order {
                return Err(wrong("two orders of bytes"));
            }
            order = order.or(of_field);
            let number = Number::named(name).ok_or_else(|| {
                let fault = format!("numbers of type {:?}", shown(descr));
                refused(
                    Place::Byte(10),
                    fault,
                    "real and whole numbers: f2 to f8, i1 to u8",
                )
            })?;
            fields.push((field.to_owned(), number));
        }
        let is_column_major = match entry("fortran_order")? {
            value if value.starts_with("True") => true,
            value if value.starts_with("False") => false,
            _ => return Err(wrong("neither True nor False")),
        };
        let shape = entry("shape")?
            .strip_prefix('(')
            .and_then(|rest| rest.split_once(')'));
        let axes = shape
            .ok_or_else(|| wrong("no shape"))?
            .0
            .split(',')
            .map(str::trim);
        let axes = axes
            .filter(|axis| !axis.is_empty())
            .map(|axis| axis.parse().map_err(|_| wrong("no shape")));
        let shape = axes.collect::<Result<Vec<usize>, _>>()?;
        if is_list && shape.len() != 1 {
            return Err(wrong("fields along several axes"));
        }
        let order = order.unwrap_or(Order::Little);
        // A list of points with fields has one axis and no order of axes.
        Ok(Header {
            fields,
            order,
            is_column_major: is_column_major && !is_list,
            shape,
        })
    }

    /// Returns the columns of the array: the fields of the points, or the shorter of two axes.
    fn columns(&self, mut data: Bytes<'_>) -> Result<Vec<Vec<f64>>, SurfaceError> {
        match (&self.fields[..], &self.shape[..]) {
            (&[(_, number)], &[rows, of_row]) => {
                let values = data.numbers(self.points(), number)?;
                let (row_step, step) = if self.is_column_major {
                    (1, rows)
                } else {
                    (of_row, 1)
                };
                let (count, points) = (rows.min(of_row), rows.max(of_row));
                let (along, between) = if rows >= of_row {
                    (row_step, step)
                } else {
                    (step, row_step)
                };
                let column = |column: usize| {
                    (0..points)
                        .map(|point| values[point * along + column * between])
                        .collect()
                };
                Ok((0..count).map(column).collect())
            }
            (fields @ [_, _, ..], &[points]) => {
                let size = fields
                    .iter()
                    .map(|(_, number)| number.size())
                    .sum::<usize>();
                let mut rows = data.part(points.saturating_mul(size))?;
                let column = |_: &(String, Number)| emptied(Vec::new(), points);
                let mut columns = fields
                    .iter()
                    .map(column)
                    .collect::<Result<Vec<Vec<f64>>, _>>()?;
                for _ in 0..points {
                    for ((_, number), column) in fields.iter().zip(&mut columns) {
                        column.push(rows.number(*number)?);
                    }
                }
                Ok(columns)
            }
            _ => Err(self.wrong_axes("points with fields, or 2 axes")),
        }
    }

    fn wrong_axes(&self, allowed: &str) -> SurfaceError {
        refused(
            Place::Byte(10),
            format!("an array with {} axes", self.shape.len()),
            allowed,
        )
    }
}

/// Returns the text between the quotation marks at the beginning of a text.
fn quoted(text: &str) -> Option<&str> {
    text.strip_prefix('\'')?
        .split_once('\'')
        .map(|(inside, _)| inside)
}

/// Returns names and types of the fields in a list such as `[('x', '<f8'), ('z', '<f8')]`.
fn field_types(list: &str) -> Option<Vec<(&str, &str)>> {
    let (list, _) = list.strip_prefix('[')?.split_once(']')?;
    list.split('(')
        .skip(1)
        .map(|field| {
            let (name, of) = field.split_once(',')?;
            Some((quoted(name)?, quoted(of.trim_start())?))
        })
        .collect()
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
        // 1.0 and -2.0 of 16 bits.
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
