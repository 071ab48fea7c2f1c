//! Coverage of the stated errors: surfaces that are drawn by seeds, and the share of them whose
//! results lie within their errors.

#[path = "../../../../tests/common/draws.rs"]
mod draws;
#[path = "../../../../tests/common/effort.rs"]
mod effort;
mod generate;
mod hurst;
mod parts;
mod periodic;
