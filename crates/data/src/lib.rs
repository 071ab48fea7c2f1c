#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]

mod axis_scale;
mod cholesky;
mod control;
mod counted_warning;
#[cfg(feature = "files")]
mod hash;
#[cfg(feature = "files")]
mod json;
pub mod memory;
pub mod npy;
mod numerics;
pub mod parallel;
mod powers;
mod quantity;
#[cfg(feature = "files")]
mod read;
mod remedy;
#[cfg(feature = "files")]
mod table;
mod text;
#[cfg(feature = "files")]
mod text_cells;
#[cfg(feature = "files")]
mod text_lines;
#[cfg(feature = "files")]
mod text_names;
mod warning;
#[cfg(feature = "files")]
mod write;

pub use axis_scale::AxisScale;
pub use cholesky::Cholesky;
pub use control::Control;
pub use counted_warning::CountedWarning;
#[cfg(feature = "files")]
pub use hash::{hexadecimal, sha256_of};
#[cfg(feature = "files")]
pub use json::write_json;
pub use memory::{OutOfMemory, check_room, emptied, gathered, push, reserve, resized};
pub use npy::SIGNATURE;
pub use numerics::{
    CompensatedSum, between, gauss_nodes_on_quarter_circle, mean, median, quantile, quartiles,
    root_mean_square, slope, standard_deviation, student_quantile,
};
pub use parallel::{in_parallel, on_this_thread, on_threads};
pub use powers::{integral_of_power, sum_of_powers};
pub use quantity::{
    QuantityError, exact_quantity, format_quantity, format_range, format_rounded, format_within,
    in_unit, one_unit, parse_quantity, unit_of,
};
#[cfg(feature = "files")]
pub use read::{ReadError, into_text, open_regular, read_limited, read_regular, read_regular_text};
pub use remedy::{Note, Remedied, Remedy, Wording};
#[cfg(feature = "files")]
pub use table::{Kind, Table, TableOf};
pub use text::{
    belong_together, counted, grouped, is_control, memory_size, path_name, per_cent, plural,
    printable, printable_lines, round_to, rounded_up, shown, si_prefix, wrap,
};
pub use warning::{NamedHeight, Trend, TrendOfScan, Warning};
#[cfg(feature = "files")]
pub use write::{
    WriteError, check_writable, remove_abandoned, sync_folder, write_new, write_new_file,
};

/// Reads tables of numbers in text files that instruments and programs write: lines, separators,
/// numbers, and names of columns.
#[cfg(feature = "files")]
pub mod text_table {
    pub use crate::text_cells::{Decimal, ONE_MARK, Separator, TextCell};
    pub use crate::text_lines::{COMMENT, TextFault, each_line};
    pub use crate::text_names::{HeadLines, Role, TextColumn, is_one_of};
}

/// First characters of each CSV file with results of Asperity.
pub const PROVENANCE: &str = "# asperity ";
