//! The panes and their places.

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, strum::VariantArray)]
pub enum Pane {
    Force,
    Profile,
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
    /// Everett function of first-order reversal curves, in place of profile and close-up.
    Everett,
    /// Density of first-order reversal curves, in place of profile and close-up.
    Density,
    /// Sensitivity to the numbers of the scene, in place of profile and close-up.
    Sensitivity,
    /// The map over κ and H, in place of profile and close-up.
    Map,
    Parameters,
}

/// Place of a pane in a window with room for all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Own,
    CloseUp,
    Large,
}

impl Pane {
    /// All panes, in the order of the help.
    pub const ALL: &[Pane] = <Pane as strum::VariantArray>::VARIANTS;
}
