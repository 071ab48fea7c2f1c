//! Attachment of each spring on loading legs.

use super::Stage;
use super::call::{Called, NO_ADHESION, PASSED, Row, STEPWISE};

pub const ROW: Row = Row {
    stage: Stage::LoadingPass,
    name: "loading passes",
    called: |call| {
        let reason = if call.adhesive { STEPWISE } else { NO_ADHESION };
        Called::when(call.exact && call.adhesive, "adhesion with the exact solver", reason)
    },
    cost: |call| call.passes(call.legs.loading_passes(), PASSED),
};
