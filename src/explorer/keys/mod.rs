//! Keys, the rows of the table of keys, and the keys in use.

pub mod bindings;
pub mod key;
