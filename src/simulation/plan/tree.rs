//! The merge tree of the local maxima of the gap.

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

/// Bytes for each spring of a line with modes up to Nyquist's: a quarter of the springs are local maxima of the gap, with
/// a node and two turning points each, and each fourth spring has a sum.
const NODE: u64 = 16;
