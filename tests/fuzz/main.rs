//! Random input on a plain toolchain: the properties of the fuzz targets, and storms drawn from the
//! table of fields.

#[path = "../common/allocations.rs"]
mod allocations;
mod corpus;
#[path = "../common/effort.rs"]
mod effort;
mod mutator;
#[path = "../../fuzz/src/lib.rs"]
mod properties;
mod storm;
