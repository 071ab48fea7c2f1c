//! Manual loading with edges between springs, and contacts looked at one moment at a time.

mod edges;
mod hand;
mod level_sets;
mod moment;

pub use edges::{Edges, Slider, SubCellRule};
pub use hand::SubCellHand;
pub use level_sets::{LevelMemory, LevelSets};
pub use moment::SubCellMoment;
