//! The results of a study as Parquet: the rows of `results.csv` with types, in about a quarter of the space.
//!
//! Missing numbers are null. Cells, seeds and integer axes are unsigned integers, all other columns have the bits
//! of the CSV. The metadata of the file hold the plan.

use super::StudyError;
use super::plan::Plan;
use super::quantity::{Quantity, regime_of};
use super::results::Results;
use super::store::Folder;
use super::tables::{PARQUET, columns};
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

/// A record: its cell, its seed and its values.
type Row<'r> = (u64, u64, &'r [f64]);

/// Value of a column in a record.
type Of<'p, T> = Box<dyn Fn(&Row<'_>) -> T + 'p>;

/// Content of a column.
enum Column<'p> {
    /// Whole numbers, by their bits, as unsigned numbers are stored.
    Whole(Of<'p, u64>),
    /// Numbers, some of them missing.
    Number(Of<'p, Option<f64>>),
    /// Regimes, by the place of their column.
    Regime(usize),
}

/// Writes `results.parquet` from the results of a merged study, whole or not at all.
///
/// # Errors
/// A study that is not merged, or a file that cannot be written.
pub fn write_parquet(folder: &Folder) -> Result<(), StudyError> {
    let results = Results::open(folder.path())?;
    write_new(&folder.path().join(PARQUET), true, |out| write(&results, out).map_err(io::Error::other))?;
    Ok(())
}

/// The columns of a plan, in the order of their names.
fn contents(plan: &Plan) -> Vec<Column<'_>> {
    let value = |axis: usize| move |(cell, ..): &Row<'_>| plan.axes[axis].values[plan.places(*cell)[axis]];
    let mut all = vec![Column::Whole(Box::new(|(cell, ..)| *cell))];
    for (place, axis) in plan.scene_axes().iter().enumerate() {
        let value = value(place);
        all.push(match axis.is_whole() {
            true => Column::Whole(Box::new(move |row| value(row) as u64)),
            false => Column::Number(Box::new(move |row| Some(value(row)))),
        });
    }
    let preload = plan.preloads().map(|_| value(plan.axes.len() - 1));
    all.push(Column::Number(Box::new(move |row| preload.as_ref().map(|value| value(row)))));
    all.push(Column::Whole(Box::new(|(_, seed, _)| *seed)));
    all.extend(plan.record.iter().enumerate().map(|(place, quantity)| match quantity {
        Quantity::Regime => Column::Regime(place),
        _ => {
            Column::Number(Box::new(move |(.., values)| Some(values[place]).filter(|value| !value.is_nan())))
        }
    }));
    all
}

fn write(results: &Results, out: impl Write + Send) -> Result<(), ParquetError> {
    let plan = results.plan();
    let contents = contents(plan);
    let field = |(name, column): (&String, &Column<'_>)| {
        let (kind, logical, repetition) = match column {
            Column::Whole(_) => {
                (Physical::INT64, Some(LogicalType::integer(64, false)), Repetition::REQUIRED)
            }
            Column::Number(_) => (Physical::DOUBLE, None, Repetition::OPTIONAL),
            Column::Regime(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String), Repetition::OPTIONAL),
        };
        let builder = Type::primitive_type_builder(name, kind);
        builder.with_logical_type(logical).with_repetition(repetition).build().map(Arc::new)
    };
    let fields = columns(plan).iter().zip(&contents).map(field).collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("results").with_fields(fields).build()?;
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION")).into())
        .set_key_value_metadata(Some(vec![KeyValue::new(PLAN.into(), plan.to_ron())]));
    let mut writer = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties.build()))?;
    let rows: Vec<Row<'_>> = (0..plan.cells())
        .flat_map(|cell| {
            results.records_of(cell).map(move |(line, values)| (cell, plan.seed_of(line), values))
        })
        .collect();
    for rows in rows.chunks(ROWS) {
        let mut group = writer.next_row_group()?;
        for column in &contents {
            match column {
                Column::Whole(of) => {
                    let values: Vec<i64> = rows.iter().map(|row| of(row).cast_signed()).collect();
                    write_column::<Int64Type>(&mut group, &values, None)?;
                }
                Column::Number(of) => write_optional::<DoubleType>(&mut group, rows.iter().map(of))?,
                Column::Regime(place) => {
                    let name =
                        |row: &Row<'_>| Some(regime_of(Quantity::Regime, row.2[*place])?.name().into());
                    write_optional::<ByteArrayType>(&mut group, rows.iter().map(name))?;
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
