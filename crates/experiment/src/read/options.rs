//! Options for reading and preparing a measured curve, which are arguments of the command line too.

use asperity_data::parse_quantity;
use std::str::FromStr;

/// Quantities whose signs are reversed on reading, so that the displacement grows on pressing and
/// compression is positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "lowercase")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Negate {
    /// No sign is reversed.
    None,
    /// The sign of the displacement is reversed.
    Displacement,
    /// The sign of the force is reversed.
    Force,
    /// The signs of displacement and force are reversed.
    Both,
}

/// Treatment of a drift of the force. A drift is a change along a straight line over time, and time
/// is counted in points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Drift {
    /// Subtracts no drift from the force.
    #[default]
    Keep,
    /// Subtracts the straight line over time that fits the force at the points without contact
    /// best.
    Remove,
    /// Subtracts a straight line over time that rises by this force in N from the first to the last
    /// point.
    Known(f64),
}

/// Treatment of a tilt of the force. A tilt is a change along a straight line over the
/// displacement, such as the virtual deflection of a cantilever.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Tilt {
    /// Subtracts no tilt from the force.
    #[default]
    Keep,
    /// Subtracts the straight line over the displacement that fits the force at the points without
    /// contact best.
    Remove,
}

impl FromStr for Drift {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let allowed = "allowed: keep, remove, or a force from the first to the last point";
        match text {
            "keep" => Ok(Drift::Keep),
            "remove" => Ok(Drift::Remove),
            _ => force(text)
                .map(Drift::Known)
                .map_err(|error| format!("{error}; {allowed}")),
        }
    }
}

fn force(text: &str) -> Result<f64, String> {
    parse_quantity(text, "N").map_err(|error| error.to_string())
}

#[cfg(feature = "clap")]
fn positive_force(text: &str) -> Result<f64, String> {
    let found = force(text)?;
    if found > 0.0 {
        Ok(found)
    } else {
        Err("allowed: a standard deviation above 0, such as 2nN".to_owned())
    }
}

#[cfg(feature = "clap")]
fn positive_length(text: &str) -> Result<f64, String> {
    let found = parse_quantity(text, "m").map_err(|error| error.to_string())?;
    if found > 0.0 {
        Ok(found)
    } else {
        Err("allowed: a length above 0, such as 500nm".to_owned())
    }
}

/// Options for reading a [`MeasuredCurve`](crate::MeasuredCurve). By default columns, units, signs,
/// zero and noise are found from the file and its points.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CurveOptions {
    /// Columns of displacement, force and segment: names or numbers
    ///
    /// By default the names in the header decide; of two columns the first is the displacement.
    /// Four columns are displacement and force of the approach, then displacement and force of
    /// the retraction beside it. Without a column of segments a segment ends where the
    /// displacement turns. time=NAME is the column of the time, which a fit with relaxation
    /// uses; it is found by its name if its unit is stated.
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "D,F[,SEGMENT][,time=T]",
            value_delimiter = ',',
            verbatim_doc_comment
        )
    )]
    pub columns: Vec<String>,
    /// Units of displacement and force: nm,nN; default: units of the file
    ///
    /// A number is the value of 1 in the column: 3.01nN for a deflection in nm with 3.01 N/m.
    ///
    /// A third unit is that of the time.
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "UNIT,UNIT", value_delimiter = ',')
    )]
    pub units: Vec<String>,
    /// Travel of the piezo for a file with one column of forces: 500nm
    ///
    /// The forces are evenly spaced over this travel, there and back.
    ///
    /// By default the file states the travel.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LENGTH", value_parser = positive_length))]
    pub ramp: Option<f64>,
    /// Segments of the curve that are used: 2 is the retraction alone
    ///
    /// 1 is the first approach, 2 its retraction, and so on. By default all are used, except
    /// pauses. The model runs through the other segments too. The part before contact still
    /// gives the zero and the noise of the force.
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "NUMBER,...", value_delimiter = ',', verbatim_doc_comment,
            value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))
    )]
    pub segments: Vec<usize>,
    /// Reverse none, displacement, force or both; default: automatic
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "QUANTITY", hide_possible_values = true)
    )]
    pub negate: Option<Negate>,
    /// Measured force taken as zero: 2nN; default: mean before contact
    #[cfg_attr(feature = "clap", arg(long, value_name = "FORCE", allow_hyphen_values = true, value_parser = force))]
    pub zero: Option<f64>,
    /// Drift over time: keep (default), remove, or rise over the curve
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            default_value = "keep",
            hide_default_value = true,
            allow_hyphen_values = true
        )
    )]
    pub drift: Drift,
    /// Slope of the force over the displacement: keep (default) or remove
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            default_value = "keep",
            hide_default_value = true,
            hide_possible_values = true
        )
    )]
    pub tilt: Tilt,
    /// Standard deviation of the noise; default: the one before contact
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "FORCE", allow_hyphen_values = true, value_parser = positive_force)
    )]
    pub noise: Option<f64>,
    /// Stiffness of the instrument in N/m, which converts displacements of the body to
    /// displacements of the instrument. If it is `None`, the stiffness in the file is used.
    #[cfg_attr(feature = "clap", arg(skip))]
    pub instrument: Option<f64>,
    /// Number of points before contact; default: found from the force
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT"))]
    pub free_points: Option<usize>,
}
