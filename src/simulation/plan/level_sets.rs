//! The level sets of the line that runs straight from spring to spring.

use super::Stage;
use super::call::{Called, NO_ADHESION, Row, STEPWISE};

pub const ROW: Row = Row {
    stage: Stage::LevelSets,
    name: "level sets of the line",
    called: |call| match (call.adhesive, call.exact) {
        (false, _) => Called::Not(NO_ADHESION),
        (true, false) => Called::Not(STEPWISE),
        (true, true) => Called::when(call.between, "edges: SubCell", "edges: Grid"),
    },
    cost: |call| call.passes(Some(1), LEVELS),
};

/// Bytes for each spring: the levels of its node, what its edges carry and the cells before it.
const LEVELS: u64 = 48;
