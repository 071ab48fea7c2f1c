//! The results of a study as Parquet: the rows of `results.csv` with types, in about a quarter of the space.
//!
//! Missing numbers are null. Cells, seeds and integer axes are unsigned integers, all other columns have the bits
//! of the CSV. The metadata of the file hold the plan.

use super::StudyError;
use super::results::Results;
use super::store::Folder;
use super::tables::PARQUET;
use crate::io::{Kind, Table, write_new};
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use serde_json::Value;
use std::borrow::Cow;
use std::io::{self, Write};
use std::sync::Arc;

/// Rows of a group, which are in memory together.
const ROWS: usize = 1 << 16;
/// Key of the plan in the metadata.
const PLAN: &str = "asperity.plan";

/// Writes `results.parquet` from the results of a merged study, whole or not at all.
///
/// # Errors
/// A study that is not merged, or a file that cannot be written.
pub fn write_parquet(folder: &Folder) -> Result<(), StudyError> {
    let results = Results::open(folder.path())?;
    let plan = results.plan().to_ron();
    let path = folder.path().join(PARQUET);
    write_new(&path, true, |out| write(&results.table(), plan, out).map_err(io::Error::other))?;
    Ok(())
}

fn write(table: &Table<'_>, plan: String, out: impl Write + Send) -> Result<(), ParquetError> {
    let field = |(name, kind): &(Cow<'static, str>, Kind)| {
        let (physical, logical, repetition) = match kind {
            Kind::Whole => (Physical::INT64, Some(LogicalType::integer(64, false)), Repetition::REQUIRED),
            Kind::Real => (Physical::DOUBLE, None, Repetition::OPTIONAL),
            Kind::Text(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String), Repetition::OPTIONAL),
        };
        let builder = Type::primitive_type_builder(name, physical);
        builder.with_logical_type(logical).with_repetition(repetition).build().map(Arc::new)
    };
    let fields = table.columns().iter().map(field).collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("results").with_fields(fields).build()?;
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION")).into())
        .set_key_value_metadata(Some(vec![KeyValue::new(PLAN.into(), plan)]));
    let mut writer = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties.build()))?;
    let mut rows = table.rows();
    loop {
        let rows: Vec<Vec<Value>> = rows.by_ref().take(ROWS).collect();
        if rows.is_empty() {
            return writer.close().map(drop);
        }
        let mut group = writer.next_row_group()?;
        for (place, (_, kind)) in table.columns().iter().enumerate() {
            let values = rows.iter().map(|row| &row[place]);
            match kind {
                Kind::Whole => {
                    // Unsigned numbers are stored by their bits.
                    let values = values.filter_map(|value| Some(value.as_u64()?.cast_signed()));
                    write_column::<Int64Type>(&mut group, &values.collect::<Vec<_>>(), None)?;
                }
                Kind::Real => write_optional::<DoubleType>(&mut group, values.map(Value::as_f64))?,
                Kind::Text(_) => {
                    let texts = values.map(|value| value.as_str().map(Into::into));
                    write_optional::<ByteArrayType>(&mut group, texts)?;
                }
            }
        }
        group.close()?;
    }
}

/// Writes a column whose missing values are null.
fn write_optional<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, impl Write + Send>,
    values: impl Iterator<Item = Option<T::T>>,
) -> Result<(), ParquetError> {
    let (mut known, mut levels) = (Vec::new(), Vec::new());
    for value in values {
        levels.push(i16::from(value.is_some()));
        known.extend(value);
    }
    write_column::<T>(group, &known, Some(&levels))
}

fn write_column<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, impl Write + Send>,
    values: &[T::T],
    levels: Option<&[i16]>,
) -> Result<(), ParquetError> {
    let column = group.next_column()?;
    let mut column =
        column.ok_or_else(|| ParquetError::General("more columns than the schema has".into()))?;
    column.typed::<T>().write_batch(values, levels, None)?;
    column.close()
}
