//! When each spring joins, on legs that press.

use super::Stage;
use super::call::{Called, NO_ADHESION, Row, STEPWISE};

pub const ROW: Row = Row {
    stage: Stage::LoadingPass,
    name: "loading passes",
    called: |call| {
        let reason = if call.adhesive { STEPWISE } else { NO_ADHESION };
        Called::when(call.exact && call.adhesive, "adhesion with the exact solver", reason)
    },
    cost: |call| {
        // What forms the contact is kept for when the body comes down again.
        let arrays = if call.legs.comes_down_again() { 2 } else { 1 };
        call.passes(call.legs.loading_passes(), arrays * call.bytes_of_pass())
    },
};
