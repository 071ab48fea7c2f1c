//! The results of a study as Parquet: the rows of `results.csv` with types, in about a quarter of the space.
//!
//! Missing numbers are null. Cells, seeds and integer axes are unsigned integers, all other columns have the bits
//! of the CSV. The metadata of the file hold the plan.

use super::StudyError;
use super::finished::{Finished, Row};
use super::plan::Plan;
use super::quantity::Quantity;
use super::store::Folder;
use super::tables::PARQUET;
use super::target::Target;
use crate::io::write_new;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use std::io::{self, Write};
use std::sync::Arc;

/// Rows gathered before they are written; each column holds them in memory.
const ROWS: usize = 1 << 17;
/// Key of the plan in the metadata.
const PLAN: &str = "asperity.plan";

/// Publishes `results.parquet` from the results of a merged study, whole or not at all.
///
/// # Errors
/// A study that is not merged, or a file that cannot be written.
pub fn write_parquet(folder: &Folder) -> Result<(), StudyError> {
    write_new(&folder.path().join(PARQUET), true, |out| {
        let mut table = Table::new(out, folder.plan()).map_err(io::Error::other)?;
        let mut failure = None;
        Finished::rows(folder.path(), |row| {
            if failure.is_none() {
                failure = table.add(row).err();
            }
        })?;
        failure.map_or(Ok(()), Err).and_then(|()| table.end()).map_err(io::Error::other)
    })?;
    Ok(())
}

/// Gathered values of a column.
enum Column {
    Whole(Vec<i64>),
    Number(Nullable<f64>),
    Text(Nullable<ByteArray>),
}

/// Existing values, and for each row true if it has one.
struct Nullable<T> {
    values: Vec<T>,
    levels: Vec<i16>,
}

impl<T> Nullable<T> {
    fn new() -> Self {
        Nullable { values: Vec::new(), levels: Vec::new() }
    }

    fn push(&mut self, value: Option<T>) {
        self.levels.push(i16::from(value.is_some()));
        self.values.extend(value);
    }

    fn clear(&mut self) {
        self.values.clear();
        self.levels.clear();
    }
}

/// A table being written.
struct Table<'a, W: Write + Send> {
    plan: &'a Plan,
    writer: SerializedFileWriter<W>,
    columns: Vec<Column>,
    rows: usize,
}

impl<'a, W: Write + Send> Table<'a, W> {
    fn new(out: W, plan: &'a Plan) -> Result<Self, ParquetError> {
        let mut fields: Vec<TypePtr> = Vec::new();
        let mut columns = Vec::new();
        let mut field = |name: &str, column: Column| {
            let builder = match column {
                Column::Whole(_) => Type::primitive_type_builder(name, Physical::INT64)
                    .with_logical_type(Some(LogicalType::integer(64, false)))
                    .with_repetition(Repetition::REQUIRED),
                Column::Number(_) => {
                    Type::primitive_type_builder(name, Physical::DOUBLE).with_repetition(Repetition::OPTIONAL)
                }
                Column::Text(_) => Type::primitive_type_builder(name, Physical::BYTE_ARRAY)
                    .with_logical_type(Some(LogicalType::String))
                    .with_repetition(Repetition::OPTIONAL),
            };
            fields.push(Arc::new(builder.build()?));
            columns.push(column);
            Ok::<(), ParquetError>(())
        };
        let (whole, number) = (|| Column::Whole(Vec::new()), || Column::Number(Nullable::new()));
        field("cell", whole())?;
        for axis in &plan.axes {
            field(axis.path(), if is_whole(axis.path()) { whole() } else { number() })?;
        }
        field("preload", number())?;
        field("seed", whole())?;
        for quantity in &plan.record {
            let text = *quantity == Quantity::Regime;
            field(quantity.name(), if text { Column::Text(Nullable::new()) } else { number() })?;
        }
        let schema = Type::group_type_builder("results").with_fields(fields).build()?;
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_created_by(concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION")).into())
            .set_key_value_metadata(Some(vec![KeyValue::new(PLAN.into(), plan.to_ron())]));
        let writer = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties.build()))?;
        Ok(Table { plan, writer, columns, rows: 0 })
    }

    fn add(&mut self, row: Row) -> Result<(), ParquetError> {
        let Row { cell, seed, values, regime } = row;
        let places = self.plan.values(cell);
        let axes = self.plan.axes.len();
        let before = 1 + axes + 2;
        for (index, column) in self.columns.iter_mut().enumerate() {
            match column {
                // Unsigned numbers are stored by their bits.
                Column::Whole(whole) => whole.push(match index {
                    0 => cell.cast_signed(),
                    _ if index <= axes => (places[index - 1] as u64).cast_signed(),
                    _ => seed.cast_signed(),
                }),
                Column::Number(number) => number.push(match index.checked_sub(before) {
                    Some(quantity) => values[quantity],
                    // The last place is that of the preload, if there are preloads.
                    None => places.get(index - 1).copied(),
                }),
                Column::Text(text) => text.push(regime.map(|regime| regime.name().into())),
            }
        }
        self.rows += 1;
        if self.rows < ROWS { Ok(()) } else { self.flush() }
    }

    /// Writes the gathered rows.
    fn flush(&mut self) -> Result<(), ParquetError> {
        if self.rows == 0 {
            return Ok(());
        }
        let mut group = self.writer.next_row_group()?;
        for column in &mut self.columns {
            match column {
                Column::Whole(whole) => {
                    write_column::<Int64Type, W>(&mut group, whole, None)?;
                    whole.clear();
                }
                Column::Number(number) => {
                    write_column::<DoubleType, W>(&mut group, &number.values, Some(&number.levels))?;
                    number.clear();
                }
                Column::Text(text) => {
                    write_column::<ByteArrayType, W>(&mut group, &text.values, Some(&text.levels))?;
                    text.clear();
                }
            }
        }
        group.close()?;
        self.rows = 0;
        Ok(())
    }

    fn end(mut self) -> Result<(), ParquetError> {
        self.flush()?;
        self.writer.close().map(drop)
    }
}

fn write_column<T: DataType, W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    values: &[T::T],
    levels: Option<&[i16]>,
) -> Result<(), ParquetError> {
    let column = group.next_column()?;
    let mut column = column.ok_or_else(|| ParquetError::General("a column too many".into()))?;
    column.typed::<T>().write_batch(values, levels, None)?;
    column.close()
}

fn is_whole(path: &str) -> bool {
    Target::of(path).is_ok_and(Target::is_whole)
}
