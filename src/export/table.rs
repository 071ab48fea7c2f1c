//! Tables of results as CSV or as an array of NumPy, each with its provenance.
//!
//! CSV begins with the provenance in comments. An array has a field for each column, and the provenance is a second
//! array in the same file, since the header of an array holds its type and shape alone.

use crate::io::npy;
use crate::scene::Provenance;
use std::io::{self, Write};

/// Format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    /// Comma-separated values.
    Csv,
    /// Structured array of NumPy.
    Npy,
}

/// Numbers or words of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Column {
    /// Double precision; not a number where there is no value.
    Real,
    /// Whole numbers from 0 on.
    Whole,
    /// Words of at most so many characters.
    Word(usize),
}

/// Value of a row in a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cell<'a> {
    Real(f64),
    Whole(u64),
    Word(&'a str),
    /// No value, of a column of real numbers.
    Missing,
}

impl From<Option<f64>> for Cell<'_> {
    fn from(value: Option<f64>) -> Self {
        value.map_or(Cell::Missing, Cell::Real)
    }
}

/// Writes a table of so many rows.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_table<'a, const N: usize>(
    out: &mut (impl Write + ?Sized),
    format: TableFormat,
    provenance: &Provenance,
    columns: [(&str, Column); N],
    count: usize,
    rows: impl Iterator<Item = [Cell<'a>; N]>,
) -> io::Result<()> {
    match format {
        TableFormat::Csv => {
            out.write_all(provenance.comments().as_bytes())?;
            writeln!(out, "{}", columns.map(|(name, _)| name).join(","))?;
            for row in rows {
                for (index, cell) in row.into_iter().enumerate() {
                    out.write_all(if index > 0 { b"," } else { b"" })?;
                    write_value(out, cell)?;
                }
                out.write_all(b"\n")?;
            }
            Ok(())
        }
        TableFormat::Npy => {
            let fields = columns.map(|(name, column)| format!("('{name}', '{}')", column.descr()));
            npy::write_header(out, &format!("[{}]", fields.join(", ")), &format!("{count},"))?;
            for row in rows {
                for ((_, column), cell) in columns.into_iter().zip(row) {
                    write_bytes(out, column, cell)?;
                }
            }
            npy::write_text(out, provenance.text())
        }
    }
}

impl Column {
    /// Type in NumPy's notation.
    fn descr(self) -> String {
        match self {
            Column::Real => "<f8".to_owned(),
            Column::Whole => "<u8".to_owned(),
            Column::Word(characters) => format!("<U{characters}"),
        }
    }
}

fn write_value(out: &mut (impl Write + ?Sized), cell: Cell<'_>) -> io::Result<()> {
    match cell {
        Cell::Real(value) => write!(out, "{value:?}"),
        Cell::Whole(value) => write!(out, "{value}"),
        Cell::Word(word) => out.write_all(word.as_bytes()),
        Cell::Missing => Ok(()),
    }
}

fn write_bytes(out: &mut (impl Write + ?Sized), column: Column, cell: Cell<'_>) -> io::Result<()> {
    match (column, cell) {
        (Column::Real, Cell::Real(value)) => out.write_all(&value.to_le_bytes()),
        (Column::Real, Cell::Whole(value)) => out.write_all(&(value as f64).to_le_bytes()),
        (Column::Real, Cell::Missing) => out.write_all(&f64::NAN.to_le_bytes()),
        (Column::Whole, Cell::Whole(value)) => out.write_all(&value.to_le_bytes()),
        (Column::Word(characters), Cell::Word(word)) if word.chars().count() <= characters => {
            let codes = word.chars().map(u32::from).chain(std::iter::repeat(0));
            codes.take(characters).try_for_each(|code| out.write_all(&code.to_le_bytes()))
        }
        (column, cell) => Err(io::Error::other(format!("{cell:?} in a column of {}", column.descr()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::TableContent;
    use std::path::Path;

    #[test]
    fn columns_have_their_types_in_either_format() {
        let document = crate::scene::open("jkr-sphere").unwrap();
        let here = Path::new("");
        let provenance = Provenance::new(TableContent::ForceCurve, document.scene(), here, here);
        let table = |format| {
            let columns = [("a", Column::Real), ("b", Column::Whole), ("c", Column::Word(2))];
            let rows = [
                [Cell::Real(0.1), Cell::Whole(7), Cell::Word("é")],
                [Cell::Missing, Cell::Whole(8), Cell::Word("yz")],
            ];
            let mut out = Vec::new();
            write_table(&mut out, format, &provenance, columns, 2, rows.into_iter()).unwrap();
            out
        };
        for wrong in [Cell::Word("xyz"), Cell::Missing] {
            let rows = [[wrong]].into_iter();
            let columns = [("a", Column::Word(2))];
            assert!(write_table(&mut Vec::new(), TableFormat::Npy, &provenance, columns, 1, rows).is_err());
        }
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
