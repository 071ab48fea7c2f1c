//! The contact of first touch pulled off: F_a(0) and the regime.

use super::Stage;
use super::call::{Called, NEVER_BACK, RELAXED, Row};
use crate::analysis::Figures;

pub const ROW: Row = Row {
    stage: Stage::ZeroLoadAdhesion,
    name: "zero-load adhesion and regime",
    called: |call| match (call.adhesive, call.pulls, Figures::is_touch_protocol(call.scene)) {
        (false, ..) => Called::Not("no adhesion: non-adhesive"),
        (true, false, _) => Called::Not(NEVER_BACK),
        (true, true, true) => Called::Not("the loading itself turns at first touch"),
        (true, true, false) => Called::For("adhesion with a loading that goes back"),
    },
    cost: |call| {
        if !call.exact {
            return call.passes(None, RELAXED);
        }
        call.passes(Some(1), 0)
    },
};
