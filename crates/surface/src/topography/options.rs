//! Options for reading a surface.

use super::cut::Cut;
use super::unit::Unit;

/// Options for reading a surface: units and distances that a file may lack, the part of the file to
/// read, and corrections of the heights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Unit of the positions and heights, for a file that states no unit.
    pub unit: Option<Unit>,
    /// Unit of the heights, for a file that states no unit of heights. With `None`, [`Self::unit`]
    /// is used.
    pub height_unit: Option<Unit>,
    /// Unit of the positions and heights that is assumed if neither the file nor [`Self::unit`]
    /// states a unit. With `None`, no unit is assumed.
    pub convention: Option<Unit>,
    /// Distance between neighbouring points in m, for a file that states no distance.
    pub spacing: Option<f64>,
    /// True if missing heights are interpolated from their neighbours. Otherwise a missing height
    /// is an error.
    pub interpolate: bool,
    /// Number, from 0, of the channel to read from a file with several channels; `None` to choose
    /// no channel by its number.
    pub channel: Option<u32>,
    /// Row or column of a map that is read as a profile. With `None` the whole map is read.
    pub cut: Option<Cut>,
    /// True if a profile with uneven distances between points is interpolated, so that its points
    /// are evenly spaced.
    pub resample: bool,
    /// True if the median height of each row of a map is subtracted from the row, which removes
    /// offsets between rows.
    pub align_rows: bool,
    /// True if outliers, such as spikes of the instrument, are replaced by heights interpolated
    /// from their neighbours.
    pub robust: bool,
    /// Name of the surface or of the measurement to read from an archive with several measurements;
    /// `None` to choose none by its name.
    pub surface_name: Option<String>,
}
