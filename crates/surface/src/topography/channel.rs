//! Choice of one channel of a file by its number or its name.

use super::options::ReadOptions;
use crate::error::{ChosenBy, Place, SurfaceError, refused};
use asperity_data::{Remedy, shown};

/// Largest number of channels that an error message lists.
const MOST_LISTED: usize = 8;

/// Words in the names of channels with heights, in files of scanning probe microscopes. These words
/// are needed because other channels with a unit of length contain deflections or amplitudes.
const HEIGHTS: [&str; 3] = ["height", "zsens", "topography"];

/// Returns true if `name` is the name of a channel of heights, as scanning probe microscopes write
/// it.
pub(super) fn names_heights(name: &str) -> bool {
    let name = name.to_lowercase();
    HEIGHTS.iter().any(|word| name.contains(word))
}

/// The channel of a file that the options request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted<'a> {
    /// The only channel of heights.
    Heights,
    Number(u32),
    Name(&'a str),
}

impl<'a> Wanted<'a> {
    /// Returns which channel the options request: the channel with a number, the channel with a
    /// name or, if the options state neither, the only channel of heights.
    ///
    /// # Errors
    /// Returns an error if the options state both a number and a name.
    pub fn new(options: &'a ReadOptions) -> Result<Self, SurfaceError> {
        match (options.channel, options.surface_name.as_deref()) {
            (None, None) => Ok(Wanted::Heights),
            (Some(number), None) => Ok(Wanted::Number(number)),
            (None, Some(name)) => Ok(Wanted::Name(name)),
            (Some(number), Some(name)) => {
                let found = format!("channel {number} and channel {:?}", shown(name));
                Err(refused(Place::File, found, "one of both").with(Remedy::Channel))
            }
        }
    }
}

/// Properties of a channel. A channel is chosen by these properties, and error messages list them.
#[derive(Clone, Debug, Default)]
pub(super) struct Label {
    /// Number of the channel in the file.
    pub number: u32,
    /// Name of the channel in the file; empty if the channel has no name.
    pub name: String,
    /// Direction of the scan, such as `retrace`. `None` if the direction is unknown or part of the
    /// name.
    pub direction: Option<String>,
    /// Unit of the values. `None` means that the unit is unknown; an empty text means that the file
    /// states that the values have no unit.
    pub unit: Option<String>,
    /// Number of the line with the first numbers of the channel; `None` if the file is not a text.
    pub line: Option<usize>,
    /// True for a channel of heights. Such a channel is read if the options name no channel.
    pub has_heights: bool,
}

impl Label {
    /// Returns true if `name` is the name of this channel, its direction, or both.
    fn has_name(&self, name: &str) -> bool {
        let is_same = |own: &str| own.to_lowercase() == name.trim().to_lowercase();
        let with_direction = match &self.direction {
            Some(direction) => is_same(direction) || is_same(&self.full_name(direction)),
            None => false,
        };
        !name.trim().is_empty() && (is_same(self.name.trim()) || with_direction)
    }

    fn full_name(&self, direction: &str) -> String {
        format!("{} {direction}", self.name.trim())
    }

    fn description(&self) -> String {
        let mut text = self.number.to_string();
        if !self.name.is_empty() {
            text += &format!(" {:?}", shown(&self.name));
        }
        if let Some(direction) = &self.direction {
            text += &format!(" {}", shown(direction));
        }
        match self.unit.as_deref() {
            Some("") => text += " without unit",
            Some(unit) => text += &format!(" in {}", shown(unit)),
            None => {}
        }
        if let Some(line) = self.line {
            text += &format!(" from line {line}");
        }
        text
    }
}

/// Returns the index of the wanted channel in `labels`. If several channels have the wanted name,
/// the only channel of heights among these channels is chosen. `kind` is the word for a channel in
/// error messages.
pub(super) fn chosen(
    labels: &[Label],
    kind: &str,
    wanted: Wanted<'_>,
) -> Result<usize, SurfaceError> {
    let mut indices: Vec<usize> = (0..labels.len()).collect();
    indices.retain(|index| match wanted {
        Wanted::Heights => labels[*index].has_heights,
        Wanted::Number(number) => labels[*index].number == number,
        Wanted::Name(name) => labels[*index].has_name(name),
    });
    if indices.len() > 1 {
        let mut of_heights = indices.clone();
        of_heights.retain(|index| labels[*index].has_heights);
        if of_heights.len() == 1 {
            indices = of_heights;
        }
    }
    if let [only] = indices[..] {
        return Ok(only);
    }
    let several = indices.len();
    let fault = match wanted {
        Wanted::Heights if several == 0 => format!("no {kind} of heights"),
        Wanted::Heights => format!("{several} {kind}s of heights"),
        Wanted::Number(number) => format!("no {kind} {number}"),
        Wanted::Name(name) if several == 0 => format!("no {kind} {:?}", shown(name)),
        Wanted::Name(name) => format!("{several} {kind}s {:?}", shown(name)),
    };
    if labels.is_empty() {
        let found = format!("no {kind}");
        return Err(refused(Place::File, found, "a file with heights"));
    }
    let allowed = if wanted == Wanted::Heights && several == 0 {
        "heights, or the number or the name of one"
    } else {
        "the number or the name of one"
    };
    Err(SurfaceError::Channel {
        place: Place::File,
        fault: format!("{fault}; {kind}s"),
        channels: listed(labels),
        allowed,
        chosen_by: ChosenBy::ChannelNumber,
    })
}

/// Returns descriptions of the first channels for an error message.
pub(super) fn listed(labels: &[Label]) -> Vec<String> {
    let first = labels.iter().take(MOST_LISTED);
    let mut listed: Vec<String> = first.map(Label::description).collect();
    if labels.len() > MOST_LISTED {
        listed.push("…".to_owned());
    }
    listed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn label(number: u32, name: &str, direction: &str, has_heights: bool) -> Label {
        Label {
            number,
            name: name.to_owned(),
            direction: Some(direction.to_owned()),
            has_heights,
            ..Label::default()
        }
    }

    fn found(labels: &[Label], wanted: Wanted<'_>) -> Result<usize, String> {
        chosen(labels, "channel", wanted).map_err(|error| error.to_string())
    }

    #[test]
    fn a_channel_has_a_number_a_name_or_the_only_heights() {
        let labels = [
            label(0, "Height", "trace", true),
            label(1, "Height", "retrace", true),
            label(3, "Phase", "retrace", false),
        ];
        for (wanted, expected) in [
            (Wanted::Number(3), 2),
            (Wanted::Name("phase"), 2),
            (Wanted::Name(" Height Retrace"), 1),
            // Two channels have this direction, but only the second of them is a channel of
            // heights.
            (Wanted::Name("Retrace"), 1),
        ] {
            assert_eq!(found(&labels, wanted), Ok(expected), "{wanted:?}");
        }
        assert_eq!(found(&labels[1..], Wanted::Heights), Ok(0));
        let list = "; channels: 0 \"Height\" trace, 1 \"Height\" retrace, 3 \"Phase\" retrace; \
                    allowed: the number or the name of one";
        for (wanted, fault) in [
            (Wanted::Number(2), "no channel 2"),
            (Wanted::Name("Height"), "2 channels \"Height\""),
            (Wanted::Name(""), "no channel \"\""),
            (Wanted::Name("Amplitude"), "no channel \"Amplitude\""),
            (Wanted::Heights, "2 channels of heights"),
        ] {
            let error = found(&labels, wanted).unwrap_err();
            assert!(error.starts_with(&format!("{fault}{list}")), "{error}");
        }
        let error = found(&labels[2..], Wanted::Heights).unwrap_err();
        assert!(
            error.starts_with(
                "no channel of heights; channels: 3 \"Phase\" retrace; allowed: heights"
            ),
            "{error}"
        );
    }

    #[test]
    fn messages_list_the_first_channels() {
        let mut labels = vec![Label::default(); 9];
        labels[0].unit = Some(String::new());
        labels[1].unit = Some("nm".to_owned());
        labels[2].line = Some(7);
        let list = listed(&labels);
        assert_eq!(
            list.join(", "),
            "0 without unit, 0 in nm, 0 from line 7, 0, 0, 0, 0, 0, …"
        );
    }
}
