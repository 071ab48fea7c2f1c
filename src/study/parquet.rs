//! The results of a study as Parquet: the rows of `results.csv` with types, in about a quarter of the space.
//!
//! Missing numbers are null. Cells, seeds and integer axes are unsigned integers, all other columns have the bits
//! of the CSV. The metadata of the file hold the plan.

use super::StudyError;
use super::quantity::Quantity;
use super::results::Results;
use super::store::Folder;
use super::tables::{PARQUET, columns, regime_of};
use crate::io::write_new;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::io::{self, Write};
use std::sync::Arc;

/// Rows of a group; one column of a group is in memory.
const ROWS: usize = 1 << 17;
/// Key of the plan in the metadata.
const PLAN: &str = "asperity.plan";

/// Content of a column.
enum Column {
    /// Cell or seed, by its bits, as unsigned numbers are stored.
    Whole(fn(Row<'_>) -> u64),
    /// The axis at a place, of whole numbers or not; beyond the last axis null.
    Axis(usize, bool),
    /// The recorded quantity at a place.
    Quantity(usize, Quantity),
}

/// A record: the coordinates of its cell, its seed and its values.
#[derive(Clone, Copy)]
struct Row<'r> {
    cell: u64,
    seed: u64,
    values: &'r [f64],
}

/// Publishes `results.parquet` from the results of a merged study, whole or not at all.
///
/// # Errors
/// A study that is not merged, or a file that cannot be written.
pub fn write_parquet(folder: &Folder) -> Result<(), StudyError> {
    let results = Results::open(folder.path())?;
    write_new(&folder.path().join(PARQUET), true, |out| write(&results, out).map_err(io::Error::other))?;
    Ok(())
}

fn write(results: &Results, out: impl Write + Send) -> Result<(), ParquetError> {
    let plan = results.plan();
    let axes = plan.scene_axes().iter().enumerate().map(|(place, axis)| Column::Axis(place, axis.is_whole()));
    let quantities =
        plan.record.iter().enumerate().map(|(place, quantity)| Column::Quantity(place, *quantity));
    let content: Vec<Column> = std::iter::once(Column::Whole(|row| row.cell))
        .chain(axes)
        .chain([Column::Axis(plan.scene_axes().len(), false), Column::Whole(|row| row.seed)])
        .chain(quantities)
        .collect();
    let field = |(name, column): (&String, &Column)| {
        let builder = match column {
            Column::Whole(_) | Column::Axis(_, true) => Type::primitive_type_builder(name, Physical::INT64)
                .with_logical_type(Some(LogicalType::integer(64, false)))
                .with_repetition(Repetition::REQUIRED),
            Column::Quantity(_, Quantity::Regime) => Type::primitive_type_builder(name, Physical::BYTE_ARRAY)
                .with_logical_type(Some(LogicalType::String))
                .with_repetition(Repetition::OPTIONAL),
            Column::Axis(..) | Column::Quantity(..) => {
                Type::primitive_type_builder(name, Physical::DOUBLE).with_repetition(Repetition::OPTIONAL)
            }
        };
        builder.build().map(Arc::new)
    };
    let names = columns(plan);
    let fields = names.iter().zip(&content).map(field).collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("results").with_fields(fields).build()?;
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION")).into())
        .set_key_value_metadata(Some(vec![KeyValue::new(PLAN.into(), plan.to_ron())]));
    let mut writer = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties.build()))?;
    let rows: Vec<Row<'_>> = (0..plan.cells())
        .flat_map(|cell| {
            let row = move |(line, values)| Row { cell, seed: plan.seed_of(line), values };
            results.records_of(cell).map(row)
        })
        .collect();
    for rows in rows.chunks(ROWS) {
        let mut group = writer.next_row_group()?;
        for column in &content {
            let on_axis = |row: &Row<'_>, axis: usize| {
                plan.axes.get(axis).map(|one| one.values[plan.places(row.cell)[axis]])
            };
            match column {
                Column::Whole(of) => {
                    let values: Vec<i64> = rows.iter().map(|row| of(*row).cast_signed()).collect();
                    write_column::<Int64Type>(&mut group, &values, None)?;
                }
                Column::Axis(axis, true) => {
                    let value = |row| on_axis(row, *axis).map_or(0, |value| (value as u64).cast_signed());
                    let values: Vec<i64> = rows.iter().map(value).collect();
                    write_column::<Int64Type>(&mut group, &values, None)?;
                }
                Column::Axis(axis, false) => {
                    write_optional::<DoubleType>(&mut group, rows.iter().map(|row| on_axis(row, *axis)))?;
                }
                Column::Quantity(place, quantity @ Quantity::Regime) => {
                    let name = |row: &Row<'_>| Some(regime_of(*quantity, row.values[*place])?.name().into());
                    write_optional::<ByteArrayType>(&mut group, rows.iter().map(name))?;
                }
                Column::Quantity(place, _) => {
                    let value = |row: &Row<'_>| Some(row.values[*place]).filter(|value| !value.is_nan());
                    write_optional::<DoubleType>(&mut group, rows.iter().map(value))?;
                }
            }
        }
        group.close()?;
    }
    writer.close().map(drop)
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
