//! Steps of the body and sweeps until nothing changes, as in the paper.

use super::Stage;
use super::call::{Called, RELAXED, Row, STEPWISE};

pub const ROW: Row = Row {
    stage: Stage::Relaxation,
    name: "stepwise relaxation",
    called: |call| Called::when(!call.exact, STEPWISE, "solver: Exact"),
    cost: |call| call.passes(None, RELAXED),
};
