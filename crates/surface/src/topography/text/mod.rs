//! Surfaces in text files. A text has one or several channels. The columns of a channel are heights
//! alone, positions and heights, or rows of a map.
//!
//! Lines before the first line of numbers are a header ([`header::TextHeader`]). The first line of
//! numbers determines the separator ([`Separator::of`](asperity_data::text_table::Separator::of))
//! and the number of columns ([`table::Table`]). [`columns::list_of`] decides whether the columns
//! are heights, positions and heights, or rows of a map. Another channel begins at a header between
//! lines of numbers and, in rows of a map, also at an empty line.

pub(crate) mod columns;
pub(crate) mod header;
pub(crate) mod matrix;
pub(crate) mod table;
pub(crate) mod table_reading;
pub(crate) mod warnings;

use super::channel::{self, Label, Wanted};
use super::reading::Reading;
use super::unit::Unit;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::text_table::{COMMENT, each_line};
use asperity_data::{PROVENANCE, shown};
use header::{TextHeader, Z};
use std::borrow::Cow;
use std::ops::Range;
use table::{NumberedLine, Table, is_header};

/// Largest allowed number of parts of a text. A part is a header with the numbers after it.
const MOST_PARTS: usize = 256;

/// First words of a file in the format Zygo XYZ. The header of such a file ends with the line
/// [`ZYGO_END`].
const ZYGO_XYZ: &str = "Zygo XYZ Data File";

/// Last line of the header in the format Zygo XYZ.
const ZYGO_END: &str = "#";

/// Mark of a missing point in the format Zygo XYZ. It consists of two words.
const NO_DATA: &str = "no data";

/// A part of a text: a header and the lines of numbers after it.
#[derive(Default)]
struct Part {
    header: TextHeader,
    table: Option<Table>,
}

/// Rows of numbers that form one channel. A part may have several channels.
#[derive(Clone)]
struct Channel {
    /// Index of the part in the text.
    part: usize,
    rows: Range<usize>,
}

/// The parts of a text, each of which has a header and numbers.
struct Text {
    parts: Vec<Part>,
    /// Number and text of the last line in the last header; `None` if this line is a comment.
    last_of_header: Option<(usize, String)>,
    last_line: usize,
    /// True while the lines belong to a header in the format Zygo XYZ. Such a header has lines of
    /// numbers that are not heights.
    is_in_zygo_header: bool,
}

/// Reads one channel of a text. Channels are numbered from 0. If `wanted` is neither a number nor a
/// name, reads the only channel whose unit is a length.
pub(super) fn read(bytes: &[u8], wanted: Wanted<'_>) -> Result<Reading, SurfaceError> {
    let text = Text::parse(bytes)?;
    let last_line = text.last_line;
    let mut parts = text.parts;
    let Choice { channel, column } = chosen(&parts, wanted)?;
    let Part { header, table } = parts.swap_remove(channel.part);
    let Some(table) = table else {
        return Err(no_numbers());
    };
    // The last line of numbers has no line end if no empty line follows after it.
    let is_open = channel.rows.end == table.rows() && table.last_line() == last_line;
    table.reading(&header, channel.rows, column, is_open)
}

impl Text {
    fn parse(bytes: &[u8]) -> Result<Text, SurfaceError> {
        // Tables of results that this program has written are in SI units.
        let is_result = bytes.starts_with(PROVENANCE.as_bytes());
        let first = Part {
            header: TextHeader::in_unit(is_result.then_some(Unit::METRE)),
            table: None,
        };
        let mut text = Text {
            parts: vec![first],
            last_of_header: None,
            last_line: 0,
            is_in_zygo_header: false,
        };
        each_line(bytes, |number, line| {
            text.take_special(number, &without_no_data(line))
        })?;
        Ok(text)
    }

    /// Reads a line, which may belong to a header in the format Zygo XYZ.
    fn take_special(&mut self, number: usize, line: &str) -> Result<(), SurfaceError> {
        self.is_in_zygo_header |= number == 1 && line.starts_with(ZYGO_XYZ);
        if !self.is_in_zygo_header {
            return self.take(number, line);
        }
        self.is_in_zygo_header = line != ZYGO_END;
        self.last_line = number;
        if let Some(part) = self.parts.last_mut() {
            part.header.take_zygo(number, line);
        }
        Ok(())
    }

    /// Reads a line of the header or of the numbers of the present part, or begins a new part with
    /// it. `number` is the number of the line, counted from 1.
    fn take(&mut self, number: usize, line: &str) -> Result<(), SurfaceError> {
        self.last_line = number;
        let is_comment = line.starts_with(COMMENT);
        if is_new_part(&self.parts, line, is_comment) {
            if self.parts.len() == MOST_PARTS {
                let found = format!("more than {MOST_PARTS} headers");
                return Err(refused(Place::Line(number), found, "fewer"));
            }
            self.parts.push(Part::default());
        }
        let Some(part) = self.parts.last_mut() else {
            return Ok(());
        };
        if let Some(table) = &mut part.table {
            if line.is_empty() {
                table.pause();
            } else if !is_comment {
                table.take(number, line)?;
            }
            return Ok(());
        }
        if line.is_empty() {
            return Ok(());
        }
        if is_comment || is_header(line) {
            self.last_of_header = (!is_comment).then(|| (number, line.to_owned()));
            part.header.take(line);
            return Ok(());
        }
        let before = self.last_of_header.take();
        let before = before.as_ref().map(|(number, line)| NumberedLine {
            number: *number,
            text: line,
        });
        let first = NumberedLine { number, text: line };
        part.table = Some(Table::new(before, first)?);
        Ok(())
    }
}

/// Returns a line in which the two words of each [`NO_DATA`] are replaced by a single word.
fn without_no_data(line: &str) -> Cow<'_, str> {
    if !line.contains(['d', 'D']) || !line.is_ascii() {
        return line.into();
    }
    let mut rest = line;
    let mut text = String::new();
    while let Some(place) = rest.to_ascii_lowercase().find(NO_DATA) {
        text += &rest[..place];
        text += "NaN";
        rest = &rest[place + NO_DATA.len()..];
    }
    if text.is_empty() {
        return line.into();
    }
    (text + rest).into()
}

/// Returns true if a line after numbers begins a new part. The line has words, or is a comment with
/// the name of a channel.
fn is_new_part(parts: &[Part], line: &str, is_comment: bool) -> bool {
    let Some(table) = parts.last().and_then(|part| part.table.as_ref()) else {
        return false;
    };
    if is_comment {
        let mut header = TextHeader::default();
        header.take(line);
        return header.channel.is_some();
    }
    !line.is_empty() && table.is_heading(line)
}

fn no_numbers() -> SurfaceError {
    let allowed = "a line of numbers for each point or row";
    refused(Place::File, "no line of numbers", allowed)
}

/// The chosen channel, and the column that the options choose in this channel.
struct Choice<'a> {
    channel: Channel,
    column: Wanted<'a>,
}

/// Returns the wanted channel. If the text has only one channel, a wanted number means a column of
/// this channel; so does a wanted name, unless it is the name of the channel.
fn chosen<'a>(parts: &[Part], wanted: Wanted<'a>) -> Result<Choice<'a>, SurfaceError> {
    let channels = channels(parts);
    if channels.is_empty() {
        return Err(no_numbers());
    }
    let labels = labels(parts, &channels);
    if let [only] = &channels[..] {
        let is_named = matches!(wanted, Wanted::Name(_))
            && channel::chosen(&labels, "channel", wanted).is_ok();
        return Ok(Choice {
            channel: only.clone(),
            column: if is_named { Wanted::Heights } else { wanted },
        });
    }
    let channel = channels[channel::chosen(&labels, "channel", wanted)?].clone();
    let header = &parts[channel.part].header;
    if let Some(unit) = &header.other_unit
        && header.unit(Z, None).is_none()
    {
        let found = format!(
            "the channel is in {}; channels: {}",
            shown(unit),
            channel::listed(&labels).join(", ")
        );
        return Err(refused(Place::File, found, "a channel in a unit of length"));
    }
    Ok(Choice {
        channel,
        column: Wanted::Heights,
    })
}

/// Returns the labels of the channels. Channels in a unit of length contain heights. If there are
/// none, the channels without a unit contain heights.
fn labels(parts: &[Part], channels: &[Channel]) -> Vec<Label> {
    let numbered = channels.iter().zip(0..);
    let mut labels: Vec<Label> = numbered
        .map(|(channel, number)| label(number, &parts[channel.part], channel))
        .collect();
    if !labels.iter().any(|label| label.has_heights) {
        for label in &mut labels {
            label.has_heights = label.unit.is_none();
        }
    }
    labels
}

/// Returns the label of a channel: its number, its name, its unit and its first line.
fn label(number: u32, part: &Part, channel: &Channel) -> Label {
    let header = &part.header;
    let unit = header.unit(Z, None).map(Unit::name);
    let line = part
        .table
        .as_ref()
        .map(|table| table.line(channel.rows.start));
    Label {
        number,
        name: header.channel.clone().unwrap_or_default(),
        unit: unit.or(header.other_unit.as_deref()).map(str::to_owned),
        line,
        has_heights: unit.is_some(),
        ..Label::default()
    }
}

/// Returns all channels in the order of the file.
fn channels(parts: &[Part]) -> Vec<Channel> {
    let mut channels = Vec::new();
    for (part, Part { table, .. }) in parts.iter().enumerate() {
        if let Some(table) = table {
            let rows = table.parts().into_iter();
            channels.extend(rows.map(|rows| Channel { part, rows }));
        }
    }
    channels
}

#[cfg(test)]
mod tests {
    use super::super::options::ReadOptions;
    use super::super::stated_units::StatedUnits;
    use super::*;

    fn text(text: &str) -> Result<Reading, String> {
        read(text.as_bytes(), Wanted::Heights).map_err(|error| error.to_string())
    }

    #[test]
    fn a_profile_is_the_same_in_every_notation() {
        let expected = text("0.5 1e-1\n1.5 2.5\n2.5 -3\n").unwrap();
        assert_eq!(expected.positions, Some(vec![0.5, 1.5, 2.5]));
        assert_eq!(expected.heights, [0.1, 2.5, -3.0]);
        for other in [
            "0.5\t1e-1\r\n1.5\t2.5\r\n2.5\t-3\r\n",
            "# stylus\nx,z\n0.5, 1e-1\n\n1.5,2.5\n2.5 ,-3",
            "\u{feff}0,5;1e-1\n1,5;2,5\n2,5;-3\n",
            "0,5 0,1\n1,5 2,5\n2,5 -3,0",
            "x z\n2.5 -3\n1.5 2.5\n0.5 1e-1\n",
            "Instrument: A7\nPoints = 3\n0.5 0.1\n# pause\n1.5 2.5\n2.5 -3",
        ] {
            assert_eq!(text(other).unwrap(), expected, "{other}");
        }
        let named = text("x [µm];z [nm]\n0,5;1e-1\n1,5;2,5\n2,5;-3\n").unwrap();
        assert_eq!(units(&named), [Some("µm"), Some("nm")]);
    }

    #[test]
    fn wrong_lines_are_named() {
        for (lines, expected) in [
            (
                "1 2\n1 3",
                "line 2: x = 1e0 after 1e0; allowed: another position than before",
            ),
            (
                "1 2\n2 3\n1.5 3",
                "line 3: x = 1.5e0 after 2e0; allowed: ascending positions, as before",
            ),
            (
                "3 2\n2 3\n2.5 3",
                "line 3: x = 2.5e0 after 2e0; allowed: descending positions, as before",
            ),
            (
                "1 2\n2 3 4",
                "line 1: 1 2 is no count of the 1 lines of 3 columns that follow",
            ),
            (
                "1 2\n2 3\n3 4 5",
                "line 3: 3 columns; allowed: 2, position and height",
            ),
            (
                "1 2 3 4\n1 2 3",
                "line 2: 3 columns; allowed: 4, as in the first row",
            ),
            (
                "7\n1 2\n2 3\n3 4",
                "line 1: 7 is no count of the 3 lines of 2 columns that follow; allowed: numbers of lines, of",
            ),
            (
                "x,z,error\n0,1,2\n",
                "3 columns \"x\", \"z\", \"error\"; allowed: a height, x and a height, or",
            ),
            ("0 1 what 3\n1 2 3 4", "line 1: \"what\"; allowed: a number"),
            (
                "1 2\n2 what",
                "line 2: \"what\"; allowed: a number from -1e9 to 1e9",
            ),
            ("1 2\ninf 2", "line 2: \"inf\"; allowed: a number from"),
            (
                "0,5;1\n1.5;2",
                "line 2: \"1.5\" has another decimal mark than the numbers before",
            ),
            ("1;2\n;3", "line 2: a position is missing"),
            (
                "x;z\n",
                "no line of numbers; allowed: a line of numbers for each point or row",
            ),
        ] {
            let error = text(lines).unwrap_err();
            assert!(error.starts_with(expected), "{lines:?}: {error}");
        }
    }

    /// Returns the names of the units of positions and heights.
    fn units(reading: &Reading) -> [Option<&'static str>; 2] {
        units_of(&reading.units)
    }

    fn units_of(units: &StatedUnits) -> [Option<&'static str>; 2] {
        [units.along, units.heights].map(|unit| unit.map(Unit::name))
    }

    #[test]
    fn what_is_no_number_of_a_point_is_left_out() {
        let expected = text("0.5 1e-1\n1.5 2.5\n2.5 -3\n").unwrap();
        for other in [
            // In the next texts, lines end with separators.
            "0.5,0.1,,\n1.5,2.5,,\n2.5,-3,,\n",
            "x,z,\n0.5,0.1,\n1.5,2.5\n2.5,-3,,\n",
            // The next text has quotation marks, and its lines end with CR.
            "\"0,5\";\"0,1\"\r\"1,5\";\"2,5\"\r\"2,5\";\"-3\"",
            // The next texts begin with the number of points, or of distances between points.
            "3\n0.5 0.1\n1.5 2.5\n2.5 -3\n",
            "2\n0.5 0.1\n1.5 2.5\n2.5 -3\n",
            // The next texts have a header that begins with a number, and a footer.
            "5.6 mm scan\n3 points\n0.5 0.1\n1.5 2.5\n2.5 -3\n\nEnd of data\n",
            "3 points\n0.5,0.1\n1.5,2.5\n2.5,-3\n3 points,\"read\",at 12:00\n",
            // The next texts have a column with the number of the point, or with its validity.
            "index;x;z\n1;0.5;0.1\n2;1.5;2.5\n3;2.5;-3\n",
            "Z,X,valid\n0.1,0.5,1\n2.5,1.5,1\n-3,2.5,1\n",
        ] {
            let found = text(other).unwrap();
            assert_eq!(
                (found.positions, found.heights),
                (expected.positions.clone(), expected.heights.clone()),
                "{other}"
            );
        }
        let invalid = text("X;Y;valid\n[mm];[um];[1/0]\n0;1;1\n1;7;0\n2;3;1\n").unwrap();
        assert!(invalid.heights[1].is_nan() && invalid.first_missing == Some(Place::Line(4)));
        assert_eq!(units(&invalid), [Some("mm"), Some("µm")]);
    }

    #[test]
    fn channels_are_chosen_and_never_joined() {
        let channel = |name: &str, unit: &str, first: f64| {
            let rows = format!("{first} 2 3 4\n5 6 7 9\n");
            format!(
                "# Channel: {name}\n# Width: 4 nm\n# Height: 2 nm\n# Value units: {unit}\n{rows}"
            )
        };
        let both = format!(
            "{}\n{}",
            channel("Phase", "deg", 10.0),
            channel("Height", "nm", 20.0)
        );
        let found = text(&both).unwrap();
        assert_eq!(
            (found.heights[0], found.heights.len(), found.spacing),
            (20.0, 8, Some([1e-9; 2]))
        );
        let two = format!(
            "{}{}",
            channel("Height", "nm", 10.0),
            channel("Retrace", "nm", 20.0)
        );
        assert_eq!(
            text(&two).unwrap_err(),
            "2 channels of heights; channels: 0 \"Height\" in nm from line 5, 1 \"Retrace\" in nm from line 11; allowed: \
             the number or the name of one"
        );
        let chosen = |text: &str, channel| {
            read(text.as_bytes(), Wanted::Number(channel)).map_err(|error| error.to_string())
        };
        assert_eq!(chosen(&two, 1).unwrap().heights[0], 20.0);
        let named = |text: &str, name| {
            read(text.as_bytes(), Wanted::Name(name)).map_err(|error| error.to_string())
        };
        assert_eq!(named(&two, "retrace"), chosen(&two, 1));
        assert!(
            named(&two, "Trace")
                .unwrap_err()
                .starts_with("no channel \"Trace\"; channels: 0 \"Height\"")
        );
        // If a text has one channel, a name may be that of the channel or of a column.
        let one = channel("Height", "nm", 10.0);
        assert_eq!(named(&one, "Height"), text(&one));
        assert!(
            named(&one, "Phase")
                .unwrap_err()
                .starts_with("no column \"Phase\"; columns: ")
        );
        assert!(
            chosen(&two, 2)
                .unwrap_err()
                .starts_with("no channel 2; channels: 0 \"Height\"")
        );
        assert!(
            chosen(&both, 0)
                .unwrap_err()
                .starts_with("the channel is in deg; channels: 0 \"Phase\" in deg")
        );
        // Channels may have no header. They may also be profiles.
        let rows = "1 2 3 4\n5 6 7 9\n\n11 2 3 4\n5 6 7 9\n";
        assert!(text(rows).unwrap_err().starts_with(
            "2 channels of heights; channels: 0 from line 1, 1 from line 4; allowed: the number or the name"
        ));
        assert_eq!(chosen(rows, 1).unwrap().heights[0], 11.0);
        assert_eq!(
            text("1 2 3 4\n\n5 6 7 9\n\n1 2 3 4\n")
                .unwrap()
                .heights
                .len(),
            12
        );
        let profiles = "x z\n0 1\n1 2\nx z\n0 5\n1 6\n";
        assert!(
            text(profiles)
                .unwrap_err()
                .starts_with("2 channels of heights; channels: 0 from line 2, 1 from line 5")
        );
        assert_eq!(chosen(profiles, 1).unwrap().heights, [5.0, 6.0]);
        assert!(
            text("0 1\n1 2\n\n0 5\n1 6\n")
                .unwrap_err()
                .starts_with("line 4: x = 0e0 after 1e0")
        );
        let many = "0 1\nx z\n".repeat(MOST_PARTS);
        assert!(
            text(&many)
                .unwrap_err()
                .starts_with("line 512: more than 256 headers")
        );
    }

    #[test]
    fn a_column_of_several_is_chosen_by_its_name_or_number() {
        let read = |text: &str, wanted: Wanted<'_>| {
            let found = read(text.as_bytes(), wanted).map_err(|error| error.to_string())?;
            Ok::<_, String>((found.positions, found.heights, units_of(&found.units)))
        };
        let profile = "x (um),raw (um),levelled (nm)\n0,7,1\n2,8,3\n4,9,2\n";
        let error = read(profile, Wanted::Heights).unwrap_err();
        assert_eq!(
            error,
            "3 columns \"x\", \"raw\", \"levelled\"; allowed: a height, x and a height, or x, y and a height, beside a \
             number of the point and a column valid, or the name of the column of heights or its number from 0, such as \
             \"raw\""
        );
        let expected = (
            Some(vec![0.0, 2.0, 4.0]),
            vec![1.0, 3.0, 2.0],
            [Some("µm"), Some("nm")],
        );
        assert_eq!(
            read(profile, Wanted::Name("levelled")),
            Ok(expected.clone())
        );
        assert_eq!(read(profile, Wanted::Number(2)), Ok(expected));
        let error = read(profile, Wanted::Name("filtered")).unwrap_err();
        assert!(
            error.starts_with("no column \"filtered\"; columns: 0 \"x\", 1 \"raw\", 2"),
            "{error}"
        );
        let error = read(profile, Wanted::Name("x")).unwrap_err();
        assert!(error.starts_with("column 0 \"x\" has positions"), "{error}");

        let four = "Position [mm]\tP [um]\tR [um]\tW [um]\n0\t7\t1\t5\n2\t8\t3\t6\n4\t9\t2\t5\n";
        let error = read(four, Wanted::Heights).unwrap_err();
        assert!(
            error.starts_with("4 columns \"Position\", \"P\", \"R\", \"W\"; allowed: "),
            "{error}"
        );
        assert_eq!(read(four, Wanted::Name("r")).unwrap().1, [1.0, 3.0, 2.0]);
        let colours = "x [um] y [um] z [nm] red\n0 0 1 7\n1 0 2 7\n0 1 3 8\n1 1 5 8\n";
        assert_eq!(
            read(colours, Wanted::Name("z")).unwrap().1,
            [1.0, 2.0, 3.0, 5.0]
        );
    }

    #[test]
    fn headers_of_programs_state_sizes_units_and_factors() {
        let nova = "File Format = ASCII\nNX = 4\nNY = 2\nScale X = 0.5\nScale Y = 0.25\nUnit X = um\nUnit Y = um\nUnit Data = nm\n\
                    Scale Data = 0.1\nDataScaleNeeded = ";
        let wyko = |first: &str| {
            format!(
                "Wyko ASCII Data File Format 0\t{first}\t1\nX Size\t2\nY Size\t4\nWavelength\t7\t4\t600\nAspect\t7\t4\t2\n\
                 Pixel_size\t7\t4\t0.00025\nMult\t7\t4\t60\nRAW_DATA\t3\t48\t"
            )
        };
        for (header, spacing, factor) in [
            (
                "# x-pixels = 4\n# y-pixels = 2\n# x-length = 2000\n# y-length = 500\n# z-unit = nm",
                [0.5, 0.25],
                1.0,
            ),
            (
                "# x-length = 2000\n# y-length = 500\n# Bit2nm = 0.1",
                [0.5, 0.25],
                0.1,
            ),
            (
                "# x-length: 2\n# y-length: 0.5\n# x-unit: um\n# y-unit: um\n# z-unit: nm",
                [0.5, 0.25],
                1.0,
            ),
            (&format!("{nova}no"), [0.5, 0.25], 1.0),
            (&format!("{nova}yes"), [0.5, 0.25], 0.1),
            (
                "h=2 w=4\nx-pixels = 4\npixel size=2.5e-007 m\ndata unit=rad\nheight conversion factor (-> nm)=0.1",
                [0.25; 2],
                0.1,
            ),
            (
                "Width=2µm\nHeight: 0.5 (µm)\nValue units: nm",
                [0.5, 0.25],
                1.0,
            ),
            (&wyko("1"), [0.25, 0.5], 1.0),
            (&wyko("0"), [0.25, 0.5], 10.0),
        ] {
            let found = text(&format!("{header}\n1\t2\t3\t4\n5\t7\t6\t8\n"))
                .map_err(|error| format!("{header}: {error}"))
                .unwrap();
            let lateral = found.units.along.unwrap();
            let distances = found
                .spacing
                .unwrap()
                .map(|distance| (lateral.to_metres(distance) * 1e9).round() / 1e3);
            assert_eq!(
                (distances, found.units.heights.map(Unit::name)),
                (spacing, Some("nm")),
                "{header}"
            );
            // The lines of numbers in a file of Wyko run along y.
            let (columns, order) = if header.starts_with("Wyko") {
                (2, [1.0, 5.0, 2.0, 7.0, 3.0, 6.0, 4.0, 8.0])
            } else {
                (4, [1.0, 2.0, 3.0, 4.0, 5.0, 7.0, 6.0, 8.0])
            };
            assert_eq!(
                (found.columns, found.heights),
                (columns, order.map(|height| height * factor).to_vec()),
                "{header}"
            );
        }
    }

    #[test]
    fn maps_have_the_distances_that_the_file_states() {
        let keyence = "\"XY calibration\",\"500\",\"nm/pixel\"\n\"Horizontal\",\"4\"\n\"Vertical\",\"2\"\n\"Unit\",\"um\"\n\"Height\"\n\
                       \"1\",\"2\",\"3\",\"4\"\n\"5\",\"6\",\"7\",\"9\"\n";
        let found = text(keyence).unwrap();
        assert_eq!(
            (found.columns, found.spacing, units(&found)),
            (4, Some([5e-7; 2]), [Some("m"), Some("µm")])
        );
        // The distance is written with a unit, so the unit in the options is that of the heights.
        let with = |unit: &str| {
            let options = ReadOptions {
                unit: unit.parse().ok(),
                ..ReadOptions::default()
            };
            let found = read(keyence.as_bytes(), Wanted::Heights)
                .unwrap()
                .resolve(&options);
            found
                .map(|map| (map.heights[0], map.spacing().unwrap()))
                .map_err(|error| error.to_string())
        };
        assert_eq!(with("um"), Ok((1e-6, [5e-7; 2])));
        assert!(
            with("nm")
                .unwrap_err()
                .starts_with("the file states µm as the unit of heights, the options state nm")
        );
        let cut = keyence.replace("\"5\"", "5").replacen("4\"", "5\"", 1);
        assert_eq!(
            text(&cut).unwrap_err(),
            "4 columns of numbers, 5 in the header; allowed: as many as the header states"
        );
        let points = text("x [mm] y [µm] z [nm]\n0 0 1\n1 0 2\n0 5 3\n1 5 4\n").unwrap();
        assert_eq!(
            (points.spacing, units(&points)),
            (Some([1.0, 5.0]), [Some("mm"), Some("nm")])
        );
        assert_eq!(points.units.between.map(Unit::name), Some("µm"));
        let one = text("x [mm] y z [nm]\n0 0 1\n1 0 2\n0 5 3\n1 5 4\n").unwrap_err();
        assert!(
            one.starts_with("mm is the unit of one position, and the other one has none"),
            "{one}"
        );
        let rough = |row: usize| {
            (0..9).map(move |column| {
                (3.7 * ((row * 9 + column) * (column + 2)) as f64)
                    .sin()
                    .to_string()
            })
        };
        let positions = (0..9)
            .map(|column| format!("{}", 0.25 * f64::from(column)))
            .collect::<Vec<_>>()
            .join(",");
        let rows = (0..9).map(|row| {
            format!(
                "{},{}\n",
                0.5 * row as f64,
                rough(row).collect::<Vec<_>>().join(",")
            )
        });
        let matrix = format!(
            "Unit X = um\nUnit Y = um\nUnit Z = nm\ny\\x,{positions}\n{}",
            rows.collect::<String>()
        );
        let found = text(&matrix).unwrap();
        assert_eq!(
            (found.columns, found.heights.len(), found.spacing),
            (9, 81, Some([0.25, 0.5]))
        );
        assert_eq!(
            (found.heights[80].to_string(), units(&found)),
            (rough(8).next_back().unwrap(), [Some("µm"), Some("nm")])
        );
    }

    #[test]
    fn texts_of_wsxm_state_their_sizes_and_units() {
        let points = "WSxM file copyright UAM\nWSxM ASCII XYZ file\nX[\u{b5}m]\t\tY[\u{b5}m]\t\tZ[nm]\n\n\
                      0\t0\t1\n0.5\t0\t2\n0\t0.25\t3\n0.5\t0.25\t5\n";
        let found = text(points).unwrap();
        assert_eq!(
            (found.columns, &found.heights[..]),
            (2, &[1.0, 2.0, 3.0, 5.0][..])
        );
        assert_eq!(
            (found.spacing, units(&found)),
            (Some([0.5, 0.25]), [Some("µm"), Some("nm")])
        );
        let matrix = "WSxM file copyright Nanotec Electronica\nWSxM ASCII Matrix file\nX Amplitude: 2 \u{b5}m\n\
                      Y Amplitude: 500 nm\nZ Amplitude: 1.2e+01 nm\n\n1\t2\t3\t4\n5\t6\t7\t9\n";
        let found = text(matrix).unwrap();
        assert_eq!((found.columns, found.spacing), (4, Some([5e-7, 2.5e-7])));
        assert_eq!(
            (found.heights[7], units(&found)),
            (9.0, [Some("m"), Some("nm")])
        );
        let volts = matrix.replace("1.2e+01 nm", "3 V");
        assert_eq!(units(&text(&volts).unwrap()), [Some("m"), None]);
        let profile = "WSxM file copyright UAM\nWSxM profile\n[General Info]\n\n    Number of points: 3\n    X axis text: Length\n\
                       \x20   X axis unit: nm\n    Y axis text: Height\n    Y axis unit: pm\n[Header end]\n0 5\n1 6\n2 8\n";
        let found = text(profile).unwrap();
        assert_eq!(
            (&found.heights[..], units(&found)),
            (&[5.0, 6.0, 8.0][..], [Some("nm"), Some("pm")])
        );
    }

    #[test]
    fn missing_points_and_positions_of_zygo_xyz_are_read() {
        let plain = text("0 0 1\n1 0 No Data\n0 1 3\n1 1 no data\n").unwrap();
        assert!(plain.heights[1].is_nan() && plain.heights[3].is_nan());
        assert_eq!(plain.first_missing, Some(Place::Line(2)));
        assert!(text("1,2,No Data,4\n5,6,7,8\n").unwrap().heights[2].is_nan());
        let zygo = |distance: &str| {
            let header = "Zygo XYZ Data File - Format 1\n1 9 1 2 \"Wed May 7\"\n0 0 640 480 1 255\n0 0 2 2\n\"a b\"\n\"\"\n\"\"\n";
            format!(
                "{header}0 0.5 6.3e-7 0.2 1 0 {distance} 1787677163\n3 2 0\n0 0 1\n0 1\n0 \"\"\n1 5 0\n#\n0 0 1\n1 0 No Data\n\
                 0 1 3\n1 1 5\n#\n"
            )
        };
        let found = text(&zygo("2e-006")).unwrap();
        assert_eq!(
            (found.spacing, units(&found)),
            (Some([2e-6; 2]), [Some("m"), None])
        );
        assert_eq!(
            (found.heights[3], found.first_missing.clone()),
            (5.0, Some(Place::Line(16)))
        );
        let options = ReadOptions {
            unit: "um".parse().ok(),
            interpolate: true,
            ..ReadOptions::default()
        };
        let map = found.resolve(&options).unwrap();
        assert_eq!((map.heights[3], map.spacing()), (5e-6, Ok([2e-6; 2])));
        // A distance of 0 between the points means that the distance is unknown. The column and row
        // indices of the points are then not read as positions.
        let found = text(&zygo("0")).unwrap();
        assert_eq!((found.spacing, units(&found)), (None, [None, None]));
        assert!(
            text("Zygo XYZ Data File - Format 1\n1 2\n")
                .unwrap_err()
                .starts_with("no line of numbers")
        );
    }

    #[test]
    fn a_column_of_heights_has_the_distance_that_the_file_states() {
        for header in [
            "Spacing: 0.4 um",
            "dx = 0.4 µm",
            "# Unit: um\n# dx = 0.4",
            "Sampling interval,400,nm",
        ] {
            let found = text(&format!("{header}\n1\n3\n2\n")).unwrap();
            let [distance, _] = found.spacing.unwrap();
            assert!(
                (distance - 4e-7).abs() < 1e-20 && found.heights.len() == 3,
                "{header}"
            );
        }
        assert_eq!(text("dx = 0.4\n1\n3\n2\n").unwrap().spacing, None);
    }

    #[test]
    fn a_number_that_is_cut_off_is_a_warning() {
        let rows: String = (0..50)
            .map(|i| format!("{:.2e} 3e-9 1e-9 2e-9\n", 1e-9 * f64::from(i * i % 11)))
            .collect();
        let cut = |end: usize| text(&rows[..rows.len() - end]).unwrap().warnings;
        assert_eq!((cut(0), cut(1)), (vec![], vec![]));
        let warnings = cut(4);
        assert!(
            warnings[0]
                .to_string()
                .starts_with("line 50: the last number, 2e0, is far from all others"),
            "{warnings:?}"
        );
        let fill = rows.replacen("1e-9", "-9999", 1);
        let warnings = text(&fill).unwrap().warnings;
        assert!(
            warnings[0]
                .to_string()
                .starts_with("line 1: the height -9.999e3 is "),
            "{warnings:?}"
        );
    }
}
