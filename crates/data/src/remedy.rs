//! Steps that remove the cause of an error or a warning. The steps are data, so that each interface
//! states them in its own words.

use std::convert::Infallible;
use std::fmt;

/// Step that removes the cause of an error or a warning. Libraries return the step as a value of
/// this type. The command line, the explorer and Python each have their own words for the step: an
/// option, a row or a keyword argument.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// Name one of the surfaces of a container.
    SurfaceName,
    /// Name no surface, since the file has a single one.
    NoSurfaceName,
    /// State the number of a channel of the file.
    Channel,
    /// State the unit of positions and heights. The value is a likely unit, such as `um`.
    Unit(String),
    /// State the unit of the heights alone. The value is a likely unit, such as `nm`.
    HeightUnit(String),
    /// State the distance between points.
    Spacing,
    /// Fill missing points of a measured surface from neighbouring points.
    Interpolate,
    /// Interpolate an uneven profile at even distances.
    Resample,
    /// Replace heights that differ much from all others.
    Robust,
    /// Take account of a tip with this radius, such as `10nm`.
    TipRadius(String),
    /// State the columns of a measured curve.
    Columns,
    /// State the units of displacement and force.
    Units,
    /// State the factor of the forces: the force in N for the value 1 in the column of forces.
    ForceOfOne,
    /// State the length of the ramp: the distance over which the forces of a curve without
    /// displacements are evenly spaced.
    Ramp,
    /// Reverse the sign of the displacement.
    NegateDisplacement,
    /// Reverse the sign of the force.
    NegateForce,
    /// Reverse no sign.
    NegateNone,
    /// State how many points of a measured curve are without contact.
    FreePoints,
    /// Use one segment of the measured curve alone: 1 is the approach, 2 the retraction.
    Segment(usize),
    /// Subtract a drift, a straight line over time, from the force.
    RemoveDrift,
    /// Subtract a tilt, a straight line over the displacement, from the force.
    RemoveTilt,
    /// State the noise of the force.
    Noise,
    /// Fit also the parameter with this name.
    Free(String),
    /// Search a parameter in another range.
    FreeRange,
    /// Search a parameter in this range, such as `work=1mJ/m^2..2mJ/m^2`.
    FreeIn(String),
    /// Compare a measured curve with many random profiles.
    ManyProfiles,
    /// Compute this number of random profiles.
    Profiles(u64),
    /// Compute more random profiles.
    MoreProfiles,
    /// Use only the profile of the scene, without random profiles.
    NoProfiles,
    /// State the standard errors of the parameters of a random roughness.
    RoughnessErrors,
    /// State no standard errors of the parameters of a roughness.
    NoRoughnessErrors,
    /// Compute square surfaces on an elastic half-space with this number of cells along a side.
    Grid(usize),
    /// Compute square surfaces on an elastic half-space with more cells.
    FinerGrid,
    /// Compute more random square surfaces on an elastic half-space.
    Maps,
    /// State a smaller tolerance for the error due to the finite number of springs.
    Tolerance,
    /// Press the body before it is pulled.
    Preload,
    /// State the range in which a value is searched.
    Range,
    /// State a form, such as a paraboloid, in a scene whose roughness is a measured surface.
    FormOfScene,
    /// Choose the axes of a figure.
    FigureAxes,
    /// Fix an axis at one of its values, such as `form.radius=1um`.
    FixAxis(String),
    /// Fix the axis with this path at another value.
    OtherValue(String),
    /// Compute on fewer threads.
    FewerThreads,
}

/// Words for a remedy in one interface, such as the option of the command line with its value.
pub type Wording = fn(&Remedy) -> String;

/// Error that may have remedies. Its text states the place, what was found and what is allowed. The
/// remedies are not part of this text.
pub trait Remedied: fmt::Display {
    /// Returns the steps that remove the cause of the error; an empty list if no single step does.
    fn remedies(&self) -> Vec<Remedy>;

    /// Returns the text of the error with its remedies in the words of an interface.
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

/// One or more sentences on a result, each with the remedies for what it states. `Display` writes
/// the sentences without the remedies.
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
pub struct Note {
    sentences: Vec<Sentence>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Sentence {
    text: String,
    remedies: Vec<Remedy>,
}

impl Note {
    /// Creates a note of one text without remedies.
    pub fn new(text: impl Into<String>) -> Note {
        Note {
            sentences: vec![Sentence {
                text: text.into(),
                remedies: Vec::new(),
            }],
        }
    }

    /// Returns the note with a further remedy of its last sentence.
    pub fn with(mut self, remedy: Remedy) -> Note {
        if let Some(last) = self.sentences.last_mut() {
            last.remedies.push(remedy);
        }
        self
    }

    /// Returns the note, followed by the sentences of another note.
    pub fn then(mut self, next: &Note) -> Note {
        self.sentences.extend(next.sentences.iter().cloned());
        self
    }

    /// Returns the remedies of all sentences.
    pub fn remedies(&self) -> impl Iterator<Item = &Remedy> {
        let sentences = self.sentences.iter();
        sentences.flat_map(|sentence| &sentence.remedies)
    }

    /// Returns the sentences, each with its remedies in the words of an interface.
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

#[cfg(feature = "files")]
impl serde::Serialize for Note {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
