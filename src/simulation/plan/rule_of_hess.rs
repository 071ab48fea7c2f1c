//! The rule of Hess, evaluated in the passes or steps of other stages.

use super::Stage;
use super::call::{Called, Row, StageCost};

pub const ROW: Row = Row {
    stage: Stage::RuleOfHess,
    name: "rule of Hess",
    called: |call| Called::when(call.adhesive, "adhesion", "no adhesion: nothing is stretched"),
    cost: |_| StageCost::NOTHING,
};
