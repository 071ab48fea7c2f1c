//! Measured surfaces: readers of the files of instruments and programs, which return heights in m.
//!
//! [`read`](crate::read) recognises the format of a file by its content, and not by its name. Units
//! are never guessed: if a file states no unit, [`ReadOptions`](crate::ReadOptions) has to state
//! it. Every error names the place in the file and what is allowed there. A file of n bytes after
//! decompression takes at most 1 MiB + 64 n bytes of memory. Decompression stops at 1 MiB + 32
//! bytes for each byte of the file or, if a header states the number of heights, at this number,
//! but at most at 1 GiB.

mod archive;
mod arrays;
mod bytes;
mod channel;
mod container;
pub(crate) mod cut;
mod foreign;
mod grid;
mod gsf;
mod gwy;
mod ibw;
pub(crate) mod igor;
mod jpk;
mod key_values;
mod levels;
mod missing;
mod nanoscope;
mod netcdf;
pub(crate) mod npy;
pub(crate) mod open;
pub(crate) mod options;
mod outliers;
mod park;
pub(crate) mod positions;
mod printed;
mod reading;
mod resolve;
mod sdf;
mod stated_units;
mod sur;
pub(crate) mod surface;
mod text;
mod tiff;
mod tiff_maker;
mod transpose;
pub(crate) mod unit;
mod vk;
mod x3p;
mod zygo;
