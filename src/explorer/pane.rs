//! The panes of the explorer, and the context of their keys.

use super::keys::bindings::Context;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, strum::VariantArray)]
pub enum Pane {
    Force,
    Profile,
    CloseUp,
    /// Cost of accuracy, errors by their sources, and other theories.
    Trust,
    Spectrum,
    Preloads,
    /// Changes of the results with each number of the scene.
    Sensitivity,
    /// Regimes over κ and H, or the map of a study.
    Map,
    Parameters,
}

impl Pane {
    /// All panes, in the order of the help.
    pub const ALL: &[Pane] = <Pane as strum::VariantArray>::VARIANTS;

    /// Returns true for a pane that takes the place of profile and close-up.
    pub fn is_large(self) -> bool {
        !matches!(
            self,
            Self::Force | Self::Profile | Self::CloseUp | Self::Parameters
        )
    }

    /// Name for a file with the content of the pane; the parameters export the force curve.
    pub fn file_name(self) -> &'static str {
        match self {
            Self::Force | Self::Parameters => "force",
            Self::Profile => "profile",
            Self::CloseUp => "patch",
            Self::Trust => "trust",
            Self::Spectrum => "spectrum",
            Self::Preloads => "preloads",
            Self::Sensitivity => "sensitivity",
            Self::Map => "map",
        }
    }

    /// Context of the keys while the pane is selected; a crosshair acts only while it is shown.
    pub fn keys(self) -> Context {
        match self {
            Self::Sensitivity => Context::Explore,
            Self::Map => Context::Map,
            Self::Parameters => Context::Parameters,
            _ => Context::Crosshair,
        }
    }
}
