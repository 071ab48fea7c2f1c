//! The histogram of heights.

use super::Stage;
use super::call::{Called, NOT_OBSERVED, Row};
use crate::scene::Effect;

pub const ROW: Row = Row {
    stage: Stage::HeightHistogram,
    name: "height histogram",
    called: |call| {
        Called::when(Effect::HeightHistogram.is_on(call.scene), "observe: HeightHistogram", NOT_OBSERVED)
    },
    cost: |call| call.passes(Some(1), 0),
};
