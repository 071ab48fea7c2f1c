//! The max-Cartesian tree of the gaps.

use super::Stage;
use super::call::{Called, NO_ADHESION, Row, STEPWISE};

pub const ROW: Row = Row {
    stage: Stage::Tree,
    name: "contact tree",
    called: |call| {
        let reason = if call.adhesive { STEPWISE } else { NO_ADHESION };
        Called::when(call.exact && call.adhesive, "adhesion with the exact solver", reason)
    },
    cost: |call| call.passes(Some(1), NODE),
};

/// Bytes for each spring: a node of the tree.
const NODE: u64 = 20;
