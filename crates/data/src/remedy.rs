//! Remedies: steps by which the user removes the cause of an error or a warning. The steps are
//! data, so that each interface states them in its own words.

use std::convert::Infallible;
use std::fmt;

/// Step by which the user removes the cause of an error or a warning. The libraries return this
/// step without words. The command line, the explorer and Python express the step each in their own
/// words: as an option, as a row or as a keyword argument.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Remedy {
    /// State the name of one of the surfaces in an archive with several surfaces.
    SurfaceName,
    /// Omit the name of a surface, because the file has only one surface.
    NoSurfaceName,
    /// State the number of the channel to read from a file with several channels.
    Channel,
    /// State the unit of the positions and heights in the file. The value is a likely unit, such as
    /// `um`.
    Unit(String),
    /// State the unit of only the heights in the file. The value is a likely unit, such as `nm`.
    HeightUnit(String),
    /// State the distance between the points of a surface.
    Spacing,
    /// Fill missing points of a measured surface from neighbouring points.
    Interpolate,
    /// Resample a profile with uneven distances between points, so that its points are evenly
    /// spaced.
    Resample,
    /// Replace outliers of a measured surface, which are heights far from the heights around them.
    Robust,
    /// Take account of the tip that measured a surface. The value is the radius of the tip, such as
    /// `10nm`.
    TipRadius(String),
    /// State which columns of a file contain the measured force curve.
    Columns,
    /// State the units of the displacement and of the force in a measured force curve.
    Units,
    /// State the factor that converts the measured forces to N. This factor is the force in N that
    /// the value 1 in the column of forces means.
    ForceOfOne,
    /// State the length of the ramp for a measured force curve without displacements. The ramp is
    /// the distance over which the forces are evenly spaced.
    Ramp,
    /// Reverse the sign of the displacement in a measured force curve.
    NegateDisplacement,
    /// Reverse the sign of the force in a measured force curve.
    NegateForce,
    /// Reverse neither the sign of the displacement nor the sign of the force in a measured force
    /// curve.
    NegateNone,
    /// State how many points of a measured force curve are without contact.
    FreePoints,
    /// Use only one segment of a measured force curve. The value is the number of the segment: 1
    /// for the approach, 2 for the retraction.
    Segment(usize),
    /// Subtract a drift from the measured force. The drift is a straight line over time.
    RemoveDrift,
    /// Subtract a tilt from the measured force. The tilt is a straight line over the displacement.
    RemoveTilt,
    /// State the noise of the measured force.
    Noise,
    /// Fit a further parameter to the measured force curve. The value is the name of the parameter.
    Free(String),
    /// Search a fitted parameter in another range of its values.
    FreeRange,
    /// Search a fitted parameter in another range. The value states the parameter and the range,
    /// such as `work=1mJ/m^2..2mJ/m^2`.
    FreeIn(String),
    /// Compare a measured force curve with the computed curves of many random profiles.
    ManyProfiles,
    /// Compute random profiles. The value is the number of profiles.
    Profiles(u64),
    /// Compute more random profiles.
    MoreProfiles,
    /// Use only the profile of the scene, without random profiles.
    NoProfiles,
    /// State the standard errors of the parameters of a random roughness in the scene.
    RoughnessErrors,
    /// Do not state standard errors of the parameters of a roughness.
    NoRoughnessErrors,
    /// Compute square surfaces on an elastic half-space. The value is the number of cells along a
    /// side of the square.
    Grid(usize),
    /// Compute square surfaces on an elastic half-space with more cells along a side of the square.
    FinerGrid,
    /// Compute more random square surfaces on an elastic half-space.
    Surfaces,
    /// State a smaller tolerance for the error due to the finite number of springs.
    Tolerance,
    /// Press the body against the elastic foundation before it is pulled off.
    Preload,
    /// State the range of values in which a parameter is searched.
    Range,
    /// State a form, such as a paraboloid, in a scene whose roughness is a measured surface.
    FormOfScene,
    /// Choose the two axes of a figure that shows a study of several parameters.
    FigureAxes,
    /// Fix one axis of a study of several parameters at one of the values of this axis, such as
    /// `form.radius=1um`.
    FixAxis(String),
    /// Fix one axis of a study of several parameters at another of the values of this axis. The
    /// value is the path of the axis, such as `form.radius`.
    OtherValue(String),
    /// Compute on fewer threads.
    FewerThreads,
    /// State a field of a measured roughness. The first text is the name of the field, such as
    /// `detrend`, and the second one its value in the notation of a scene, such as `Tilt`; `None`
    /// if the remedy states no value.
    RoughnessField(String, Option<String>),
}

/// Function that returns the words of one interface for a remedy. For the command line, for
/// example, the words are an option with its value.
pub type Wording = fn(&Remedy) -> String;

/// Error that may have remedies, which are steps that remove its cause. `Display` writes the error
/// without the remedies: the place, what was found there and what is allowed there.
pub trait Remedied: fmt::Display {
    /// Returns the steps that remove the cause of the error; an empty list if no single step does.
    fn remedies(&self) -> Vec<Remedy>;

    /// Returns the text of the error, followed by its remedies. `wording` returns the words for a
    /// remedy.
    fn in_words(&self, wording: Wording) -> String {
        let text = self.to_string();
        match joined(&self.remedies(), wording) {
            Some(words) => format!("{text}: {words}"),
            None => text,
        }
    }
}

/// An [`Infallible`] error never occurs, so it needs no remedy.
impl Remedied for Infallible {
    fn remedies(&self) -> Vec<Remedy> {
        Vec::new()
    }
}

/// An error that is only a text has no remedies.
impl Remedied for &str {
    fn remedies(&self) -> Vec<Remedy> {
        Vec::new()
    }
}

/// An error that is only a text has no remedies.
impl Remedied for String {
    fn remedies(&self) -> Vec<Remedy> {
        Vec::new()
    }
}

/// Returns the words for all remedies as one text; `None` if there are no remedies.
fn joined(remedies: &[Remedy], wording: Wording) -> Option<String> {
    let words: Vec<String> = remedies.iter().map(wording).collect();
    (!words.is_empty()).then(|| words.join("; "))
}

/// Message about a result: one or more sentences, each with the remedies for what the sentence
/// states. `Display` writes the sentences without the remedies.
///
/// ```
/// use asperity_data::{Note, Remedy};
///
/// let drift = Note::new("A drift remains.").with(Remedy::RemoveDrift);
/// let note = drift.then(&Note::new("Noise 1 nN."));
/// assert_eq!(note.to_string(), "A drift remains. Noise 1 nN.");
/// let words = note.in_words(|_| "take it off".to_owned());
/// assert_eq!(words, "A drift remains: take it off. Noise 1 nN.");
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct Note {
    sentences: Vec<Sentence>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
struct Sentence {
    text: String,
    remedies: Vec<Remedy>,
}

impl Note {
    /// Creates a note from one text, without remedies.
    pub fn new(text: impl Into<String>) -> Note {
        Note {
            sentences: vec![Sentence {
                text: text.into(),
                remedies: Vec::new(),
            }],
        }
    }

    /// Returns the note with one more remedy for its last sentence.
    pub fn with(mut self, remedy: Remedy) -> Note {
        if let Some(last) = self.sentences.last_mut() {
            last.remedies.push(remedy);
        }
        self
    }

    /// Returns the note, followed by the sentences of the note `next`.
    pub fn then(mut self, next: &Note) -> Note {
        self.sentences.extend(next.sentences.iter().cloned());
        self
    }

    /// Returns the remedies of all sentences of the note.
    pub fn remedies(&self) -> impl Iterator<Item = &Remedy> {
        let sentences = self.sentences.iter();
        sentences.flat_map(|sentence| &sentence.remedies)
    }

    /// Returns the sentences, each followed by its remedies. `wording` returns the words for a
    /// remedy.
    pub fn in_words(&self, wording: Wording) -> String {
        let mut sentences = Vec::with_capacity(self.sentences.len());
        for Sentence { text, remedies } in &self.sentences {
            sentences.push(match joined(remedies, wording) {
                Some(words) => match text.strip_suffix('.') {
                    Some(text) => format!("{text}: {words}."),
                    None => format!("{text}: {words}"),
                },
                None => text.clone(),
            });
        }
        sentences.join(" ")
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, sentence) in self.sentences.iter().enumerate() {
            let blank = if index == 0 { "" } else { " " };
            write!(f, "{blank}{}", sentence.text)?;
        }
        Ok(())
    }
}

impl From<String> for Note {
    fn from(text: String) -> Note {
        Note::new(text)
    }
}

impl From<&str> for Note {
    fn from(text: &str) -> Note {
        Note::new(text)
    }
}
