//! A hard case.

use super::Fault;
use crate::scene::Edges;
use serde::Serialize;

/// Family of cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// From no adhesion to adhesion that keeps full contact.
    Adhesion,
    /// Units and sizes, up to the limits of floating-point numbers.
    Scales,
    /// Shapes and numbers of springs.
    Lines,
    /// Bodies with a known loop.
    ClosedForms,
    /// Laws valid for every body.
    Laws,
}

/// Kind of evidence of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Evidence {
    /// A closed form of the literature or of this model.
    ClosedForm,
    /// The same quantity computed otherwise: the rules without tree and thresholds, or sums with twice the digits.
    IndependentComputation,
    /// A law for the result: mirror, scaling, memory, order, refinement, repetition.
    SelfConsistency,
}

impl Evidence {
    /// Name of the kind.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Evidence::ClosedForm => "closed form",
            Evidence::IndependentComputation => "independent computation",
            Evidence::SelfConsistency => "self-consistency",
        }
    }
}

/// Edge models and bounds of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scope {
    /// Both kinds of edges, each with its own bound: whole springs, edges between springs.
    BothEdges(f64, f64),
    /// The one kind of edges of the case.
    OneKind(Edges, f64),
    /// The profile alone: no contact, no edges.
    Line(f64),
}

/// A hard case.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name: words with hyphens.
    pub name: &'static str,
    /// Family, according to the list with the case.
    pub family: Family,
    /// Claim, one sentence.
    pub holds: &'static str,
    /// Kinds of evidence, the strongest first.
    pub evidence: &'static [Evidence],
    /// Quantity of the error.
    pub error_of: &'static str,
    /// Edge models and bounds.
    pub scope: Scope,
    /// True for a case that takes seconds and hundreds of megabytes.
    pub large: bool,
    /// Measures the error.
    pub(super) measure: fn(Edges) -> Result<f64, Fault>,
}

/// An unspecified case: without a measure of its own it fails.
pub(super) const CASE: Case = Case {
    name: "",
    family: Family::Laws,
    holds: "",
    evidence: &[],
    error_of: "",
    scope: Scope::Line(0.0),
    large: false,
    measure: |_| Ok(f64::NAN),
};
