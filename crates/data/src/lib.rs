#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]

mod axis_scale;
mod hash;
mod json;
pub mod memory;
pub mod npy;
mod numerics;
mod object;
pub mod parallel;
mod quantity;
mod read;
mod table;
mod text;
mod write;

pub use axis_scale::AxisScale;
pub use hash::{hexadecimal, sha256_of};
pub use json::write_json;
pub use memory::{OutOfMemory, check_room, emptied, gathered, push, reserve, resized};
pub use npy::SIGNATURE;
pub use numerics::{
    CompensatedSum, between, gauss_nodes_on_quarter_circle, mean, median, quantile, root_mean_square, slope,
    standard_deviation, student_quantile,
};
pub use object::{Entry, Object, Optional};
pub use parallel::{in_parallel, on_this_thread, on_threads};
pub use quantity::{
    QuantityError, exact_quantity, format_quantity, format_range, format_rounded, format_within, in_unit,
    one_unit, parse_quantity, unit_of,
};
pub use read::{ReadError, into_text, open_regular, read_limited, read_regular, read_regular_text};
pub use table::{Kind, Table, TableOf};
pub use text::{
    belong_together, grouped, is_control, memory_size, path_name, per_cent, printable, printable_lines,
    round_to, shown, si_prefix, wrap,
};
pub use write::{WriteError, check_writable, sync_folder, write_new, write_new_file};

/// First characters of a CSV file that begins with its scene.
pub const PROVENANCE: &str = "# asperity ";
