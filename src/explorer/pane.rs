//! The panes: their places and keys.

use super::keys::bindings::Context;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, strum::VariantArray)]
pub enum Pane {
    Force,
    Profile,
    CloseUp,
    /// Cost of accuracy and stages of the run.
    Accuracy,
    Spectrum,
    /// Adhesion force over preload.
    Preloads,
    /// Changes of the results where one number of the scene changes.
    Sensitivity,
    /// Regimes over κ and H, or the map of a study.
    Map,
    Parameters,
}

impl Pane {
    /// All panes, in the order of the help.
    pub const ALL: &[Pane] = <Pane as strum::VariantArray>::VARIANTS;

    /// Returns true for a pane in place of profile and close-up.
    pub fn is_large(self) -> bool {
        !matches!(self, Self::Force | Self::Profile | Self::CloseUp | Self::Parameters)
    }

    /// Keys of the selected pane; those of the crosshair act while it is shown.
    pub fn keys(self) -> Context {
        match self {
            Self::Sensitivity => Context::Explore,
            Self::Map => Context::Map,
            Self::Parameters => Context::Parameters,
            _ => Context::Crosshair,
        }
    }
}
