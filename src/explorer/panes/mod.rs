//! The panes: one row each.

mod accuracy;
mod beside;
mod chart;
mod chart_words;
mod close_up;
mod force;
mod histogram;
mod lengths;
mod parameters;
mod position;
mod preloads;
mod profile;
mod row;
mod section;
mod sections;
mod spectrum;

pub use chart::{map_figure, place_at};
pub use force::{indentation_at, stage_at};
pub use parameters::{first_listed, parameter_at};
pub use position::{position_at, share_at};
pub use row::PaneRow;
pub use sections::section_cell;

/// The panes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pane {
    /// The force curve.
    Force,
    /// The profile with the histogram of its heights.
    Profile,
    /// The close-up of contact patches.
    CloseUp,
    /// Cost of accuracy and stages of the run, in place of profile and close-up.
    Accuracy,
    /// Spectra, in place of profile and close-up.
    Spectrum,
    /// Adhesion against preload, in place of profile and close-up.
    Preloads,
    /// The map over κ and H, in place of profile and close-up.
    Chart,
    /// The list of parameters.
    Parameters,
}

impl Pane {
    /// All panes, in the order of the help.
    pub const ALL: [Pane; 8] = [
        Pane::Force,
        Pane::Profile,
        Pane::CloseUp,
        Pane::Accuracy,
        Pane::Spectrum,
        Pane::Preloads,
        Pane::Chart,
        Pane::Parameters,
    ];

    /// Row of the pane.
    #[must_use]
    pub fn row(self) -> &'static PaneRow {
        match self {
            Pane::Force => &force::ROW,
            Pane::Profile => &profile::ROW,
            Pane::CloseUp => &close_up::ROW,
            Pane::Accuracy => &accuracy::ROW,
            Pane::Spectrum => &spectrum::ROW,
            Pane::Preloads => &preloads::ROW,
            Pane::Chart => &chart::ROW,
            Pane::Parameters => &parameters::ROW,
        }
    }
}
