//! A measured profile, read and laid over the springs.

use super::Stage;
use super::call::{Called, HEIGHT, Row};

pub const ROW: Row = Row {
    stage: Stage::MeasuredProfile,
    name: "measured profile",
    called: |call| match (call.is_measured(), call.is_synthesised()) {
        (true, _) => Called::For("roughness: Measured"),
        (_, true) => Called::Not("roughness: SelfAffine"),
        _ => Called::Not("no roughness: smooth"),
    },
    cost: |call| call.passes_over(call.points, Some(1), HEIGHT),
};
