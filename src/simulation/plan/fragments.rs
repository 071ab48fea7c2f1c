//! The list of contact fragments at the end of each leg.

use super::Stage;
use super::call::{Called, NOT_OBSERVED, Row};
use crate::scene::Effect;

pub const ROW: Row = Row {
    stage: Stage::Fragments,
    name: "contact fragments",
    called: |call| Called::when(Effect::Fragments.is_on(call.scene), "observe: Fragments", NOT_OBSERVED),
    cost: |call| call.passes(Some(call.legs.all()), 0),
};
