//! The macroscopic form, added to the line.

use super::Stage;
use super::call::{Called, Row};

pub const ROW: Row = Row {
    stage: Stage::Form,
    name: "form",
    called: |call| match call.scene.form {
        None => Called::Not("no form: nominally flat"),
        Some(form) if form.flat_end().is_some() => Called::For("form: the springs under the punch"),
        Some(_) => Called::For("form"),
    },
    cost: |call| call.passes(Some(1), 0),
};
