//! The panes of the explorer. The context of a pane determines what the keys do.

use super::keys::bindings::Context;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, strum::VariantArray)]
pub enum Pane {
    Force,
    Profile,
    CloseUp,
    /// Accuracy: errors and their cost in computing time, the sources of the errors, and other
    /// theories.
    Trust,
    Spectrum,
    Preloads,
    /// Sensitivity: how the results change with each number of the scene.
    Sensitivity,
    /// Regimes over κ and H, or a map of a study.
    Map,
    Parameters,
}

impl Pane {
    /// All panes, in the order in which the help describes them.
    pub const ALL: &[Pane] = <Pane as strum::VariantArray>::VARIANTS;

    /// Returns true for a pane that takes the main place on the screen. The profile and the
    /// close-up are then hidden.
    pub fn is_large(self) -> bool {
        !matches!(
            self,
            Self::Force | Self::Profile | Self::CloseUp | Self::Parameters
        )
    }

    /// Returns the name of an exported file for this pane. From the list of parameters, the force
    /// curve is exported.
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

    /// Returns the context, which determines what the keys do while this pane is selected. The keys
    /// of a crosshair apply only while the crosshair is shown.
    pub fn keys(self) -> Context {
        match self {
            Self::Sensitivity => Context::Explore,
            Self::Map => Context::Map,
            Self::Parameters => Context::Parameters,
            _ => Context::Crosshair,
        }
    }
}
