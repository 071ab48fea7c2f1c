//! A hard case.

use super::Fault;
use crate::scene::Edges;
use serde::Serialize;

/// What a case is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// From no adhesion to adhesion that holds everything.
    Adhesion,
    /// Units and sizes, to the ends of what numbers can tell.
    Scales,
    /// Shapes and numbers of springs.
    Lines,
    /// Bodies whose loop is known.
    ClosedForms,
    /// What holds for every body.
    Laws,
}

/// What a case is run with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scope {
    /// Both kinds of edges, each with its own bound: whole springs, edges between springs.
    BothEdges(f64, f64),
    /// One kind, which the case is about.
    OneKind(Edges, f64),
    /// The line alone: no contact, no edges.
    Line(f64),
}

/// A hard case.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Its name: words with hyphens.
    pub name: &'static str,
    /// What it is about.
    pub family: Family,
    /// What must hold, in one sentence.
    pub holds: &'static str,
    /// What the error is an error of.
    pub error_of: &'static str,
    /// What it is run with, and within which bound it must stay.
    pub scope: Scope,
    /// Whether it takes seconds and hundreds of megabytes.
    pub large: bool,
    /// Measures the error.
    pub(super) measure: fn(Edges) -> Result<f64, Fault>,
}
