//! Tables of results, written as CSV, as a NumPy array or as JSON objects.
//!
//! A CSV file begins with comments that say how the table was made. A NumPy array has one field for
//! each column.

use super::npy;
use serde::ser::{Serialize, Serializer};
use serde_json::Value;
use std::borrow::Cow;
use std::fmt::Write as _;
use std::io;
use std::io::Write;
use std::rc::Rc;

/// Type of the values in a column of a [`Table`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Real numbers.
    Real,
    /// Integers of at least 0.
    Whole,
    /// Texts of at most this many characters.
    Text(usize),
}

/// Function that returns the entry of a column in a given row.
type ValueOf<'a, T> = Box<dyn Fn(&T) -> Value + 'a>;

/// Function that returns an iterator over all rows.
type Rows<'a, T> = Rc<dyn Fn() -> Box<dyn Iterator<Item = T> + 'a> + 'a>;

/// A table of results with named columns, to be written as CSV, as a NumPy array or as JSON.
pub struct Table<'a> {
    /// Sentence about the columns; `None` if they need none.
    note: Option<&'static str>,
    columns: Vec<(Cow<'static, str>, Kind)>,
    /// Counts the rows without computing their values, because computing them may take time.
    count: Box<dyn Fn() -> usize + 'a>,
    rows: Rows<'a, Vec<Value>>,
}

/// Table under construction, to which columns can still be added. [`Table::of`] begins the table,
/// and [`TableOf::done`] returns the finished [`Table`].
pub struct TableOf<'a, T> {
    rows: Rows<'a, T>,
    columns: Vec<(Cow<'static, str>, Kind)>,
    values: Vec<ValueOf<'a, T>>,
}

impl<'a> Table<'a> {
    /// Begins a table that has no columns yet. Each call of `rows` must return an iterator over all
    /// rows of the table.
    pub fn of<T, I: Iterator<Item = T> + 'a>(rows: impl Fn() -> I + 'a) -> TableOf<'a, T> {
        TableOf {
            rows: Rc::new(move || Box::new(rows())),
            columns: Vec::new(),
            values: Vec::new(),
        }
    }
}

impl<'a, T: 'a> TableOf<'a, T> {
    /// Adds a column. For each row, `value` returns the value in the column. A missing value is
    /// written as an empty cell in CSV, as `null` in JSON and as NaN in a NumPy array.
    pub fn with<V: Into<Value>>(
        mut self,
        name: impl Into<Cow<'static, str>>,
        kind: Kind,
        value: impl Fn(&T) -> V + 'a,
    ) -> Self {
        self.columns.push((name.into(), kind));
        self.values.push(Box::new(move |row| value(row).into()));
        self
    }

    /// Adds a column of real numbers. For each row, `value` returns the number in the column.
    pub fn real<V: Into<Value>>(self, name: &'static str, value: impl Fn(&T) -> V + 'a) -> Self {
        self.with(name, Kind::Real, value)
    }

    /// Adds a column of integers of at least 0. For each row, `value` returns the integer in the
    /// column.
    pub fn whole(self, name: &'static str, value: impl Fn(&T) -> u64 + 'a) -> Self {
        self.with(name, Kind::Whole, value)
    }

    /// Returns the finished table.
    pub fn done(self) -> Table<'a> {
        let rows = self.rows;
        let values = Rc::new(self.values);
        let counted_rows = Rc::clone(&rows);
        Table {
            note: None,
            columns: self.columns,
            count: Box::new(move || counted_rows().count()),
            rows: Rc::new(move || {
                let values = Rc::clone(&values);
                Box::new(rows().map(move |row| values.iter().map(|value| value(&row)).collect()))
            }),
        }
    }
}

impl Table<'_> {
    /// Returns the names of the columns, each with the type of its values.
    pub fn columns(&self) -> &[(Cow<'static, str>, Kind)] {
        &self.columns
    }

    /// Returns an iterator that computes one row at a time. A row has one value for each column.
    pub fn rows(&self) -> impl Iterator<Item = Vec<Value>> {
        (self.rows)()
    }

    /// Adds a sentence about the columns, which CSV has as a comment above their names.
    pub fn with_note(mut self, note: &'static str) -> Self {
        self.note = Some(note);
        self
    }

    /// Writes the table as CSV. First the lines of `provenance`, which say how the table was made,
    /// and the note on the columns are written as comments.
    ///
    /// # Errors
    /// Returns an error if `out` cannot be written.
    pub fn write_csv(&self, out: &mut dyn Write, provenance: &str) -> io::Result<()> {
        for line in provenance.lines() {
            writeln!(out, "# {line}")?;
        }
        if let Some(note) = self.note {
            writeln!(out, "# {note}")?;
        }
        let names: Vec<_> = self.columns.iter().map(|(name, _)| quoted(name)).collect();
        writeln!(out, "{}", names.join(","))?;
        let mut line = String::new();
        for row in self.rows() {
            line.clear();
            for value in &row {
                push_cell(&mut line, value);
                line.push(',');
            }
            line.pop();
            writeln!(out, "{line}")?;
        }
        Ok(())
    }

    /// Writes the table as a NumPy array with one field for each column.
    ///
    /// # Errors
    /// Returns an error if `out` cannot be written.
    pub fn write_npy(&self, out: &mut dyn Write) -> io::Result<()> {
        let fields: Vec<_> = self
            .columns
            .iter()
            .map(|(name, kind)| format!("('{name}', '{}')", kind.numpy_type()))
            .collect();
        let shape = format!("{},", (self.count)());
        npy::write_header(out, &format!("[{}]", fields.join(", ")), &shape)?;
        for row in self.rows() {
            for (value, (_, kind)) in row.iter().zip(&self.columns) {
                write_binary(out, value, *kind)?;
            }
        }
        Ok(())
    }
}

impl Kind {
    /// Returns the type of the values in NumPy's notation.
    fn numpy_type(self) -> String {
        match self {
            Kind::Real => "<f8".to_owned(),
            Kind::Whole => "<u8".to_owned(),
            Kind::Text(characters) => format!("<U{characters}"),
        }
    }
}

/// Writes a value as it is stored in a NumPy array. Returns an error if the value does not have the
/// type `kind` of its column.
fn write_binary(out: &mut dyn Write, value: &Value, kind: Kind) -> io::Result<()> {
    match (kind, value) {
        (Kind::Real, Value::Null) => out.write_all(&f64::NAN.to_le_bytes()),
        (Kind::Real, Value::Number(number)) => {
            out.write_all(&number.as_f64().unwrap_or(f64::NAN).to_le_bytes())
        }
        (Kind::Whole, Value::Number(number)) => {
            out.write_all(&number.as_u64().unwrap_or_default().to_le_bytes())
        }
        (Kind::Text(characters), Value::String(text)) if text.chars().count() <= characters => {
            let codes = text.chars().map(u32::from).chain(std::iter::repeat(0));
            for code in codes.take(characters) {
                out.write_all(&code.to_le_bytes())?;
            }
            Ok(())
        }
        _ => {
            let message = format!("{value} in a column of {}", kind.numpy_type());
            Err(io::Error::other(message))
        }
    }
}

/// Appends a value as a cell of CSV.
fn push_cell(line: &mut String, value: &Value) {
    // Writing to a string cannot fail.
    let _ = match value {
        Value::Null => Ok(()),
        Value::String(text) => line.write_str(&quoted(text)),
        number => match number.as_f64() {
            Some(real) if number.is_f64() => write!(line, "{real:?}"),
            _ => write!(line, "{number}"),
        },
    };
}

/// Returns a text as a CSV cell. If it contains a separator, a quotation mark or a line break, it
/// is put in quotation marks as in RFC 4180.
fn quoted(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\"")).into()
    } else {
        text.into()
    }
}

/// Serialises the table as a JSON array with one object for each row.
impl Serialize for Table<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.rows().map(|values| RowObject {
            columns: &self.columns,
            values,
        }))
    }
}

/// Row of a table, to be written as a JSON object.
struct RowObject<'a> {
    columns: &'a [(Cow<'static, str>, Kind)],
    values: Vec<Value>,
}

impl Serialize for RowObject<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let names = self.columns.iter().map(|(name, _)| name);
        serializer.collect_map(names.zip(&self.values))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_have_their_types_in_every_format() {
        let rows = || [(Some(0.1), 7, "é"), (None, 8, "y,")].into_iter();
        let table = Table::of(rows)
            .real("a", |row| row.0)
            .whole("b", |row| row.1);
        let table = table.with("c", Kind::Text(2), |row| row.2).done();
        let objects = serde_json::to_string(&table).unwrap();
        assert_eq!(
            objects,
            r#"[{"a":0.1,"b":7,"c":"é"},{"a":null,"b":8,"c":"y,"}]"#
        );
        let mut csv = Vec::new();
        table.write_csv(&mut csv, "one\ntwo\n").unwrap();
        assert_eq!(
            String::from_utf8(csv).unwrap(),
            "# one\n# two\na,b,c\n0.1,7,é\n,8,\"y,\"\n"
        );
        let mut array = Vec::new();
        table.write_npy(&mut array).unwrap();
        let header = 128;
        let descr = "{'descr': [('a', '<f8'), ('b', '<u8'), ('c', '<U2')], 'fortran_order': False, 'shape': (2,), }";
        assert_eq!(&array[10..10 + descr.len()], descr.as_bytes());
        let mut expected = Vec::new();
        for (real, whole, word) in [(0.1, 7_u64, ['é', '\0']), (f64::NAN, 8, ['y', ','])] {
            expected.extend(f64::to_le_bytes(real));
            expected.extend(whole.to_le_bytes());
            word.into_iter()
                .for_each(|code| expected.extend(u32::from(code).to_le_bytes()));
        }
        assert_eq!(array[header..], expected);
        let long = Table::of(|| ["xyz"].into_iter()).with("c", Kind::Text(2), |word| *word);
        assert!(long.done().write_npy(&mut Vec::new()).is_err());
        assert_eq!(quoted("a\"b"), "\"a\"\"b\"");
    }
}
