//! The panes: one row each.

mod accuracy;
mod beside;
mod chart;
mod chart_words;
mod close_up;
mod costs;
mod curves;
mod force;
mod histogram;
mod lengths;
mod parameters;
mod position;
mod preload_curve;
mod preloads;
mod profile;
mod row;
mod scene_spectra;
mod section;
mod spectrum;

pub use costs::Costs;
pub use force::{indentation_at, stage_at};
pub use parameters::first_listed;
pub use position::{position_at, share_at};
pub use preload_curve::{PROFILES, PreloadCurve};
pub use row::{PaneRow, Place};
pub use scene_spectra::SceneSpectra;

/// The panes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Pane {
    /// The force curve.
    Force,
    /// The profile with the histogram of its heights.
    Profile,
    /// The close-up of contact patches.
    CloseUp,
    /// Distribution of the lengths of contact patches, in place of the close-up.
    Lengths,
    /// The profile of the newest loop kept for comparison, in place of the close-up.
    Beside,
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
    pub const ALL: [Pane; 10] = [
        Pane::Force,
        Pane::Profile,
        Pane::CloseUp,
        Pane::Lengths,
        Pane::Beside,
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
            Pane::Lengths => &lengths::ROW,
            Pane::Beside => &beside::ROW,
            Pane::Accuracy => &accuracy::ROW,
            Pane::Spectrum => &spectrum::ROW,
            Pane::Preloads => &preloads::ROW,
            Pane::Chart => &chart::ROW,
            Pane::Parameters => &parameters::ROW,
        }
    }
}
