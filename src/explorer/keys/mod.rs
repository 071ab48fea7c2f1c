//! Keys, the rows of the table of keys, and the bindings of keys to functions.

pub mod bindings;
pub mod key;
