//! Contents found by a merge, and the sidecar with the meanings of the columns.

use super::axis::Axis;
use super::plan::Plan;
use super::quantity::Quantity;
use super::statistics::CONFIDENCE;
use super::tables::RESULTS_VERSION;
use super::target::symbol_and_unit;
use crate::io::object;
use serde::Serialize;

/// Contents found by a merge.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Merged {
    /// Records there are, each counted once.
    pub records: u64,
    /// Records there are to be.
    pub total: u64,
    /// Records that were there more than once, bit for bit the same.
    pub duplicates: u64,
    /// Lines of shard files that were torn or damaged, and left out.
    pub damaged: u64,
    /// Cells of which lines are missing.
    pub missing_cells: u64,
    /// The first of them.
    pub first_missing: Vec<u64>,
    /// Files that hold records.
    pub files: usize,
    /// Versions of the program that wrote them.
    pub programs: Vec<String>,
}

/// The sidecar of a plan with the contents found by a merge.
pub(super) fn sidecar<'a>(plan: &'a Plan, merged: &'a Merged) -> impl Serialize + 'a {
    let axis = |axis: &'a Axis| {
        let (symbol, unit) = symbol_and_unit(axis.path());
        let scale = match axis {
            Axis::Linear { .. } => "linear",
            Axis::Logarithmic { .. } => "logarithmic",
            Axis::List { .. } => "list",
        };
        object! {
            "path": axis.path(), "symbol": symbol, "unit": unit, "scale": scale, "values": axis.values(),
        }
    };
    let quantity = |quantity: &Quantity| {
        object! {
            "name": quantity.name(),
            "symbol": quantity.symbol(),
            "unit": quantity.unit(),
            "meaning": quantity.meaning(),
        }
    };
    object! {
        "format": RESULTS_VERSION,
        "program": format!("{} {}", env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION")),
        "plan": object! {
            "title": &plan.title, "notice": &plan.notice, "scene": &plan.scene, "text": plan.to_ron(),
        },
        "axes": plan.axes.iter().map(axis).collect::<Vec<_>>(),
        "preloads": plan.preloads.as_ref().map(Axis::values),
        "quantities": plan.record.iter().map(quantity).collect::<Vec<_>>(),
        "cells": plan.cells(),
        "lines": plan.lines,
        "first_seed": plan.seed,
        "confidence": CONFIDENCE,
        "records": merged.records,
        "total": merged.total,
        "duplicates": merged.duplicates,
        "damaged": merged.damaged,
        "missing_cells": merged.missing_cells,
        "first_missing": &merged.first_missing,
        "files": merged.files,
        "programs": &merged.programs,
    }
}
