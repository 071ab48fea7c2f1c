//! The panes of the explorer. Each pane has a context, which determines what the keys do while the
//! pane is selected.

use super::keys::bindings::Context;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, strum::VariantArray)]
pub enum Pane {
    Force,
    /// The stages of the loading, its jumps and the position of the animation.
    Timeline,
    Profile,
    CloseUp,
    /// Accuracy of the pull-off force: errors and computing times, the sources of the errors, and
    /// the verdicts of other theories.
    Trust,
    Spectrum,
    Preloads,
    /// Sensitivity: how much the results change when each number of the scene changes.
    Sensitivity,
    /// Map of the regimes of adhesion over the roughness parameter κ and the Hurst exponent H, or a
    /// map of a study.
    Map,
    Parameters,
    /// The main results: pull-off forces of the random profiles, shares, energies, errors.
    Result,
    /// The list of jumps and marks of the loading.
    Events,
}

impl Pane {
    /// All panes, in the order in which the help describes them.
    pub const ALL: &[Pane] = <Pane as strum::VariantArray>::VARIANTS;

    /// Returns true for a pane that takes the main place on the screen. The profile and the
    /// close-up are then hidden.
    pub fn is_large(self) -> bool {
        !matches!(
            self,
            Self::Force
                | Self::Timeline
                | Self::Profile
                | Self::CloseUp
                | Self::Parameters
                | Self::Result
                | Self::Events
        )
    }

    /// Returns the name of the file to which this pane is exported. For the list of parameters,
    /// this is the file of the force curve, which is exported in its place.
    pub fn file_name(self) -> &'static str {
        match self {
            Self::Force | Self::Timeline | Self::Parameters | Self::Result => "force",
            Self::Profile => "profile",
            Self::CloseUp => "patch",
            Self::Trust => "trust",
            Self::Spectrum => "spectrum",
            Self::Preloads => "preloads",
            Self::Sensitivity => "sensitivity",
            Self::Map => "map",
            Self::Events => "events",
        }
    }

    /// Returns the context of this pane, which determines what the keys do while the pane is
    /// selected. A pane with a crosshair has the context of the crosshair only while the crosshair
    /// is shown.
    pub fn keys(self) -> Context {
        match self {
            Self::Sensitivity | Self::Result => Context::Explore,
            Self::Timeline => Context::Timeline,
            Self::Events => Context::Events,
            Self::Map => Context::Map,
            Self::Parameters => Context::Parameters,
            _ => Context::Crosshair,
        }
    }
}
