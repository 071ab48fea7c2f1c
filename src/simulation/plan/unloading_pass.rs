//! When each spring leaves, on legs that pull.

use super::Stage;
use super::call::{Called, NEVER_BACK, NO_ADHESION, Row, STEPWISE};

pub const ROW: Row = Row {
    stage: Stage::UnloadingPass,
    name: "unloading passes",
    called: |call| match (call.pulls, call.adhesive, call.exact) {
        (false, ..) => Called::Not(NEVER_BACK),
        (true, false, _) => Called::Not(NO_ADHESION),
        (true, true, false) => Called::Not(STEPWISE),
        (true, true, true) => Called::For("loading goes back"),
    },
    cost: |call| call.passes(call.legs.unloading(), 0),
};
