//! The error of this crate: the place, what was found there, and what is allowed.

use asperity_data::text_table::TextFault;
use asperity_data::{OutOfMemory, ReadError, Remedied, Remedy, shown};
use std::fmt;
use std::path::Path;
use thiserror::Error;

/// List of the formats that can be read, for messages.
const FORMATS: &str = "text, SDF, GSF, NumPy array, X3P, GWY, SUR, Nanoscope, NetCDF, IBW, JPK, \
                       Park TIFF, Zygo DAT, VK4, or these in gzip; others saved as GWY or X3P in \
                       Gwyddion";

/// Place of a fault in a file, a surface or a scene. Lines and points are counted from 1. Bytes are
/// counted from 0, in the decompressed file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// The whole file, or the whole argument of the function.
    #[default]
    File,
    /// Line of a text, by its number.
    Line(usize),
    /// Point of a surface or of a force curve, by its number.
    Point(usize),
    /// Byte of a file, by its offset.
    Byte(usize),
    /// Named part of a file: a file in an archive, an element of XML, or a channel.
    Part(String),
    /// Field of a scene file, by its path in the scene, such as `roughness.file`.
    Field(&'static str),
    /// Place in one of several measurements in a file: the name of the measurement, and the place
    /// inside the measurement.
    Measurement(String, Box<Place>),
    /// Place in one of several surfaces that are analysed together, with the index of the surface
    /// from 0.
    Surface(usize, Box<Place>),
    /// Place in a file that a field of a scene names.
    FileOf(Box<PlaceInFile>),
}

/// Place in a file, and the field of a scene that names this file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlaceInFile {
    /// Path of the field in the scene, such as `roughness.file`.
    pub field: &'static str,
    /// Path of the file.
    pub file: String,
    /// Place in the file.
    pub place: Place,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::File => Ok(()),
            Place::Line(number) => write!(f, "line {number}: "),
            Place::Point(number) => write!(f, "point {number}: "),
            Place::Byte(offset) => write!(f, "byte {offset}: "),
            Place::Part(name) => write!(f, "{}: ", shown(name)),
            Place::Field(name) => write!(f, "{name}: "),
            Place::Measurement(name, place) => write!(f, "{}: {place}", shown(name)),
            Place::Surface(_, place) => place.fmt(f),
            Place::FileOf(inside) => {
                write!(f, "{} = {:?}: {}", inside.field, inside.file, inside.place)
            }
        }
    }
}

impl Place {
    /// Returns this place and the places nested in it, from the outermost to the innermost.
    fn all(&self) -> impl Iterator<Item = &Place> {
        std::iter::successors(Some(self), |place| match place {
            Place::Measurement(_, inner) | Place::Surface(_, inner) => Some(&**inner),
            Place::FileOf(inside) => Some(&inside.place),
            _ => None,
        })
    }
}

/// Way in which the user chooses one of several surfaces in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChosenBy {
    /// The user chooses by the number or the name of a channel.
    ChannelNumber,
    /// The user chooses one of several surfaces in an archive by its name.
    SurfaceName,
}

/// Reason why a surface, a form or a profile cannot be read, made or analysed. The message names
/// the file only if a scene names it ([`Place::FileOf`]).
///
/// ```
/// use asperity_data::{Remedied, Remedy};
///
/// let options = asperity_surface::ReadOptions { unit: Some("m".parse()?), ..Default::default() };
/// let error = asperity_surface::parse(b"0 1\n1 bad\n2 3\n", &options).unwrap_err();
/// assert!(error.line() == Some(2) && error.remedies() == [Remedy::Interpolate]);
/// # Ok::<(), asperity_surface::SurfaceError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// A file has a fault, a value is out of its range, or an option does not fit the file.
    #[error("{place}{found}; allowed: {allowed}")]
    Refused {
        /// Place of the fault.
        place: Place,
        /// What was found there, in words.
        found: String,
        /// What is allowed there, in words.
        allowed: String,
        /// Options that the user can give so that the file is read; empty if no option helps.
        remedies: Vec<Remedy>,
    },
    /// The format of a file is known, but this crate has no reader for it.
    #[error("{place}{format} is not read; allowed: {allowed}")]
    UnreadFormat {
        /// Place of the error, which is the file as a whole.
        place: Place,
        /// Name of the format.
        format: &'static str,
        /// Formats that can be read instead, in words.
        allowed: &'static str,
    },
    /// Some points of a surface have no height.
    #[error(
        "{place}{missing} of {points} points are missing ({:.2} %), the first here; allowed: points that are filled from their \
         neighbours",
        100.0 * *missing as f64 / *points as f64
    )]
    MissingPoints {
        /// Place of the first missing point.
        place: Place,
        /// Number of missing points.
        missing: usize,
        /// Number of all points.
        points: usize,
    },
    /// Neither the file nor the options state the unit of a quantity.
    #[error("{place}no unit of {quantity} is stated; allowed: a unit in the file or beside it")]
    NoUnit {
        /// Place of the error, which is the file as a whole.
        place: Place,
        /// Name of the quantity: positions, distances or heights.
        quantity: &'static str,
        /// Unit of the positions, if the file states a unit for the positions but none for the
        /// heights; otherwise `None`.
        unit_of_positions: Option<String>,
    },
    /// The options do not determine which channel or surface of the file is read: none fits the
    /// options, or several fit them.
    #[error("{place}{fault}: {}; allowed: {allowed}", channels.join(", "))]
    Channel {
        /// Place of the error, which is the file as a whole.
        place: Place,
        /// What is wrong, in words.
        fault: String,
        /// Descriptions of the channels or surfaces of the file.
        channels: Vec<String>,
        /// What is allowed, in words.
        allowed: &'static str,
        /// How the user chooses a channel or a surface.
        chosen_by: ChosenBy,
    },
    /// The operating system cannot read a file.
    #[error("{place}{reason}")]
    Unreadable {
        /// Place of the error, which names the file that cannot be read.
        place: Place,
        /// Reason that the operating system gives.
        reason: String,
    },
    /// The Fourier transform of heights failed. The value is the message of the transform.
    #[error("the Fourier transform failed: {0}")]
    Transform(String),
    /// An array, such as the heights of a surface, does not fit into memory.
    #[error("{place}{error}")]
    OutOfMemory {
        /// Surface, or field of a scene, for which the array is needed.
        place: Place,
        /// Number of bytes that the system cannot provide.
        error: OutOfMemory,
    },
}

impl SurfaceError {
    /// Returns the place of the fault, such as a line of a file.
    pub fn place(&self) -> &Place {
        match self {
            SurfaceError::Refused { place, .. }
            | SurfaceError::UnreadFormat { place, .. }
            | SurfaceError::MissingPoints { place, .. }
            | SurfaceError::NoUnit { place, .. }
            | SurfaceError::Channel { place, .. }
            | SurfaceError::Unreadable { place, .. }
            | SurfaceError::OutOfMemory { place, .. } => place,
            SurfaceError::Transform(_) => &Place::File,
        }
    }

    /// Returns the first result that `said_by` gives for the place of the error and the places
    /// nested in it, from the outermost to the innermost.
    fn find<T>(&self, said_by: impl Fn(&Place) -> Option<T>) -> Option<T> {
        self.place().all().find_map(said_by)
    }

    /// Returns the number of the line with the fault, from 1; `None` if the place is not a line of
    /// a text.
    pub fn line(&self) -> Option<usize> {
        self.find(|place| match place {
            Place::Line(number) => Some(*number),
            _ => None,
        })
    }

    /// Returns the index of the surface with the fault, from 0. Returns `None` if the fault
    /// concerns all surfaces together.
    pub fn surface(&self) -> Option<usize> {
        self.find(|place| match place {
            Place::Surface(index, _) => Some(*index),
            _ => None,
        })
    }

    /// Returns the path of the field of a scene that causes the fault, such as `roughness.file`.
    /// Returns `None` if the fault does not belong to a scene.
    pub fn field(&self) -> Option<&'static str> {
        self.find(|place| match place {
            Place::Field(name) => Some(*name),
            Place::FileOf(inside) => Some(inside.field),
            _ => None,
        })
    }

    /// Returns the path of the file with the fault. Returns `None` if this file is not one that a
    /// field of a scene names.
    pub fn file(&self) -> Option<String> {
        self.find(|place| match place {
            Place::FileOf(inside) => Some(inside.file.clone()),
            _ => None,
        })
    }

    /// Returns the same error with one more remedy, a step that the user can take so that the file
    /// is read.
    pub fn with(mut self, remedy: Remedy) -> Self {
        if let SurfaceError::Refused { remedies, .. } = &mut self {
            remedies.push(remedy);
        }
        self
    }

    /// Returns the same error with a more complete place, such as a line together with the file.
    /// The function `outer` makes the new place from the present place.
    pub fn within(mut self, outer: impl FnOnce(Box<Place>) -> Place) -> Self {
        match &mut self {
            SurfaceError::Refused { place, .. }
            | SurfaceError::UnreadFormat { place, .. }
            | SurfaceError::MissingPoints { place, .. }
            | SurfaceError::NoUnit { place, .. }
            | SurfaceError::Channel { place, .. }
            | SurfaceError::Unreadable { place, .. }
            | SurfaceError::OutOfMemory { place, .. } => {
                *place = outer(Box::new(std::mem::take(place)))
            }
            SurfaceError::Transform(_) => {}
        }
        self
    }

    /// Returns the same error with a more complete place. The new place states the field
    /// `roughness.file` of the scene, the path `file`, and the present place inside this file.
    pub fn in_measured(self, file: &Path) -> Self {
        self.in_file_of("roughness.file", file)
    }

    /// Returns the same error with a more complete place. The new place states `field`, the field
    /// of the scene that names a file, the path of this file, and the present place inside this
    /// file.
    pub(crate) fn in_file_of(self, field: &'static str, file: &Path) -> Self {
        let file = file.display().to_string();
        self.within(|place| {
            let place = *place;
            Place::FileOf(Box::new(PlaceInFile { field, file, place }))
        })
    }

    /// Creates the error of a profile whose springs do not fit into memory.
    pub fn of_springs(error: OutOfMemory) -> Self {
        SurfaceError::OutOfMemory {
            place: Place::Field("numerics.points"),
            error,
        }
    }
}

impl Remedied for SurfaceError {
    fn remedies(&self) -> Vec<Remedy> {
        match self {
            SurfaceError::Refused { remedies, .. } => remedies.clone(),
            SurfaceError::MissingPoints { .. } => vec![Remedy::Interpolate],
            SurfaceError::NoUnit {
                unit_of_positions: Some(unit),
                ..
            } => {
                let of_heights = Remedy::HeightUnit("nm".to_owned());
                vec![Remedy::Unit(unit.clone()), of_heights]
            }
            SurfaceError::NoUnit {
                unit_of_positions: None,
                ..
            } => vec![Remedy::Unit("um".to_owned())],
            SurfaceError::Channel { chosen_by, .. } => match chosen_by {
                ChosenBy::ChannelNumber => vec![Remedy::Channel],
                ChosenBy::SurfaceName => vec![Remedy::SurfaceName],
            },
            SurfaceError::UnreadFormat { .. }
            | SurfaceError::Unreadable { .. }
            | SurfaceError::Transform(_)
            | SurfaceError::OutOfMemory { .. } => Vec::new(),
        }
    }
}

impl From<OutOfMemory> for SurfaceError {
    fn from(error: OutOfMemory) -> Self {
        SurfaceError::OutOfMemory {
            place: Place::File,
            error,
        }
    }
}

impl From<ReadError> for SurfaceError {
    fn from(error: ReadError) -> Self {
        SurfaceError::Unreadable {
            place: Place::File,
            reason: error.to_string(),
        }
    }
}

impl From<TextFault> for SurfaceError {
    fn from(fault: TextFault) -> Self {
        match fault {
            TextFault::NotText { line, byte } => {
                let found = format!("byte {byte} of the line is zero, so this is no text");
                refused(Place::Line(line), found, FORMATS)
            }
            TextFault::LongLine { line } => {
                let most = TextFault::LONGEST_LINE;
                let found = format!("longer than {most} bytes");
                refused(Place::Line(line), found, format!("at most {most} bytes"))
            }
            TextFault::OutOfMemory(error) => error.into(),
            other => {
                let allowed = "numbers with decimal points, or without separators of thousands";
                refused(Place::File, other, allowed)
            }
        }
    }
}

/// Creates a [`SurfaceError::Refused`] from the place of a fault, what was found there, and what is
/// allowed there.
pub fn refused(place: Place, found: impl ToString, allowed: impl ToString) -> SurfaceError {
    SurfaceError::Refused {
        place,
        found: found.to_string(),
        allowed: allowed.to_string(),
        remedies: Vec::new(),
    }
}
