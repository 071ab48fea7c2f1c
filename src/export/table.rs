//! Tables of results as CSV or as an array of NumPy, each with its provenance.
//!
//! CSV begins with the provenance in comments. An array has a field for each column, and the provenance is a second
//! array in the same file, since the header of an array holds only its type and shape.

use super::Provenance;
use crate::io::npy;
use serde::ser::{Serialize, SerializeMap, Serializer};
use std::borrow::Borrow;
use std::io::{self, Write};

/// Format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    /// Comma-separated values.
    Csv,
    /// Structured array of NumPy.
    Npy,
}

/// A column of a table and an entry of the JSON objects with the same rows: name and value.
pub(super) struct Column<T>(pub &'static str, pub Value<T>);

/// Value of a row in a column.
pub(super) enum Value<T> {
    /// Double precision.
    Real(fn(&T) -> f64),
    /// Double precision; empty in CSV and NaN in an array if there is no value.
    Optional(fn(&T) -> Option<f64>),
    /// Integers from 0.
    Whole(fn(&T) -> u64),
    /// Integers missing in some rows: double precision in an array.
    Count(fn(&T) -> Option<u64>),
    /// Words with a largest number of characters.
    Word(usize, fn(&T) -> &'static str),
}

/// Writes a table with this number of rows.
///
/// # Errors
/// Errors of `out`.
pub(super) fn write_table<T>(
    out: &mut (impl Write + ?Sized),
    format: TableFormat,
    provenance: &Provenance,
    columns: &[Column<T>],
    count: usize,
    rows: impl Iterator<Item = impl Borrow<T>>,
) -> io::Result<()> {
    if format == TableFormat::Csv {
        out.write_all(provenance.comments().as_bytes())?;
        return write_csv(out, columns, rows);
    }
    let fields: Vec<_> =
        columns.iter().map(|Column(name, value)| format!("('{name}', '{}')", value.descr())).collect();
    npy::write_header(out, &format!("[{}]", fields.join(", ")), &format!("{count},"))?;
    for row in rows {
        columns.iter().try_for_each(|Column(_, value)| value.write_bytes(out, row.borrow()))?;
    }
    npy::write_text(out, provenance.text())
}

/// Writes comma-separated values without provenance.
fn write_csv<T>(
    out: &mut (impl Write + ?Sized),
    columns: &[Column<T>],
    rows: impl Iterator<Item = impl Borrow<T>>,
) -> io::Result<()> {
    let names: Vec<_> = columns.iter().map(|column| column.0).collect();
    writeln!(out, "{}", names.join(","))?;
    for row in rows {
        for (index, Column(_, value)) in columns.iter().enumerate() {
            out.write_all(if index > 0 { b"," } else { b"" })?;
            value.write_text(out, row.borrow())?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

impl<T> Value<T> {
    /// Type in NumPy's notation.
    fn descr(&self) -> String {
        match self {
            Value::Real(_) | Value::Optional(_) | Value::Count(_) => "<f8".to_owned(),
            Value::Whole(_) => "<u8".to_owned(),
            Value::Word(characters, _) => format!("<U{characters}"),
        }
    }

    fn write_text(&self, out: &mut (impl Write + ?Sized), row: &T) -> io::Result<()> {
        match self {
            Value::Real(of) => write!(out, "{:?}", of(row)),
            Value::Optional(of) => of(row).map_or(Ok(()), |value| write!(out, "{value:?}")),
            Value::Whole(of) => write!(out, "{}", of(row)),
            Value::Count(of) => of(row).map_or(Ok(()), |count| write!(out, "{count}")),
            Value::Word(_, of) => out.write_all(of(row).as_bytes()),
        }
    }

    fn write_bytes(&self, out: &mut (impl Write + ?Sized), row: &T) -> io::Result<()> {
        let real = match *self {
            Value::Real(of) => of(row),
            Value::Optional(of) => of(row).unwrap_or(f64::NAN),
            Value::Count(of) => of(row).map_or(f64::NAN, |count| count as f64),
            Value::Whole(of) => return out.write_all(&of(row).to_le_bytes()),
            Value::Word(characters, of) => {
                let word = of(row);
                if word.chars().count() > characters {
                    return Err(io::Error::other(format!("{word} in a column of {}", self.descr())));
                }
                let codes = word.chars().map(u32::from).chain(std::iter::repeat(0));
                return codes.take(characters).try_for_each(|code| out.write_all(&code.to_le_bytes()));
            }
        };
        out.write_all(&real.to_le_bytes())
    }
}

/// A row as a JSON object with an entry for each column.
pub(super) struct Record<'a, T, R>(pub &'a [Column<T>], pub R);

impl<T, R: Borrow<T>> Serialize for Record<'_, T, R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (columns, row) = (self.0, self.1.borrow());
        let mut map = serializer.serialize_map(Some(columns.len()))?;
        for Column(name, value) in columns {
            match value {
                Value::Real(of) => map.serialize_entry(name, &of(row))?,
                Value::Optional(of) => map.serialize_entry(name, &of(row))?,
                Value::Whole(of) => map.serialize_entry(name, &of(row))?,
                Value::Count(of) => map.serialize_entry(name, &of(row))?,
                Value::Word(_, of) => map.serialize_entry(name, of(row))?,
            }
        }
        map.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    type Row = (Option<f64>, u64, &'static str);

    #[test]
    fn columns_have_their_types_in_either_format() {
        let document = crate::scene::open("jkr-sphere").unwrap();
        let here = Path::new("");
        let provenance = Provenance::new("asperity run", document.scene(), here, here).unwrap();
        let columns = [
            Column("a", Value::Optional(|row: &Row| row.0)),
            Column("b", Value::Whole(|row| row.1)),
            Column("c", Value::Word(2, |row| row.2)),
        ];
        let rows = [(Some(0.1), 7, "é"), (None, 8, "yz")];
        let table = |format| {
            let mut out = Vec::new();
            write_table(&mut out, format, &provenance, &columns, 2, rows.iter()).unwrap();
            out
        };
        let too_long = [(None, 9, "xyz")].into_iter();
        let refused = write_table(&mut Vec::new(), TableFormat::Npy, &provenance, &columns, 1, too_long);
        assert_eq!(refused.unwrap_err().to_string(), "xyz in a column of <U2");
        let objects = serde_json::to_string(&rows.map(|row| Record(&columns, row))).unwrap();
        assert_eq!(objects, r#"[{"a":0.1,"b":7,"c":"é"},{"a":null,"b":8,"c":"yz"}]"#);
        let csv = String::from_utf8(table(TableFormat::Csv)).unwrap();
        assert_eq!(csv.strip_prefix(&provenance.comments()), Some("a,b,c\n0.1,7,é\n,8,yz\n"));
        let array = table(TableFormat::Npy);
        let header = 128;
        let descr =
            "{'descr': [('a', '<f8'), ('b', '<u8'), ('c', '<U2')], 'fortran_order': False, 'shape': (2,), }";
        assert_eq!(&array[10..10 + descr.len()], descr.as_bytes());
        let mut rows = Vec::new();
        for (real, whole, word) in [(0.1, 7_u64, ['é', '\0']), (f64::NAN, 8, ['y', 'z'])] {
            rows.extend(f64::to_le_bytes(real));
            rows.extend(whole.to_le_bytes());
            word.into_iter().for_each(|code| rows.extend(u32::from(code).to_le_bytes()));
        }
        assert_eq!(array[header..header + rows.len()], rows);
        assert_eq!(npy::appended_text(&array), Some(provenance.text()));
    }
}
