//! Formats of boundaries, and the terms that all of them use.

use crate::scene::RoughnessParameter;
use crate::study::Quantity;
use clap::ValueEnum;

/// Format of boundaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BoundaryFormat {
    /// A table.
    Text,
    /// One object.
    Json,
    /// One row for each boundary.
    Csv,
    /// Tables for a document, one for each share.
    Markdown,
}

/// Name of the protocol of a recorded share.
pub(super) fn protocol(quantity: Quantity) -> &'static str {
    if quantity == Quantity::ZeroLoadAdhesionShare { "touch" } else { "zero force" }
}

/// Symbol of a boundary in a parameter.
pub(super) fn symbol(over: RoughnessParameter) -> &'static str {
    match over {
        RoughnessParameter::Kappa => "κ*",
        RoughnessParameter::ElasticEnergyRatio => "(e_el/γ)*",
    }
}
