//! The commands of the explorer: the table of keys, and one file for each group of functions.

pub mod accuracy;
mod compare;
pub mod crosshair;
pub mod dialogue;
pub mod edit;
pub mod files;
pub mod manual;
pub mod map;
pub mod map_over;
pub mod measured;
pub mod movement;
pub mod opening;
pub mod profiles;
pub mod stages;
pub mod table;
pub mod target;
pub mod timeline;
pub mod view;
