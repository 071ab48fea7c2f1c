//! Surfaces in text: columns of heights, positions and heights, or rows of a map, of one channel or
//! several.
//!
//! Lines before the first line of numbers are a header ([`header::TextHeader`]). The first line of
//! numbers fixes the separator ([`Separator::of`](asperity_data::text_table::Separator::of)) and
//! the number of columns ([`table::Table`]), which are heights, positions and heights, or rows of a
//! map ([`columns::list_of`]). A header, or in rows of a map an empty line, amid the numbers begins
//! another channel.

pub(crate) mod columns;
pub(crate) mod header;
pub(crate) mod matrix;
pub(crate) mod table;
pub(crate) mod table_reading;
pub(crate) mod warnings;

use super::reading::Reading;
use super::unit::Unit;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::text_table::{COMMENT, each_line};
use asperity_data::{PROVENANCE, Remedy, shown};
use header::{TextHeader, Z};
use std::ops::Range;
use table::{NumberedLine, Table, is_header};

/// Largest number of headers after which numbers follow.
const MOST_PARTS: usize = 256;

/// Largest number of channels that a message lists.
const MOST_LISTED: usize = 8;

/// Numbers of a text, with the header before them.
#[derive(Default)]
struct Part {
    header: TextHeader,
    table: Option<Table>,
}

/// Rows of numbers of a part that are a channel.
#[derive(Clone)]
struct Channel {
    /// Index of the part.
    part: usize,
    rows: Range<usize>,
}

/// A text with its headers and numbers.
struct Text {
    parts: Vec<Part>,
    /// Last line of the last header, if it is no comment.
    last_of_header: Option<(usize, String)>,
    last_line: usize,
}

/// Reads the channel with this number, from 0, of a text with several. Without a number, reads the
/// only channel whose heights are lengths.
pub(super) fn read(bytes: &[u8], channel: Option<u32>) -> Result<Reading, SurfaceError> {
    let text = Text::parse(bytes)?;
    let last_line = text.last_line;
    let mut parts = text.parts;
    let Channel { part, rows } = chosen(&parts, channel)?;
    let Part { header, table } = parts.swap_remove(part);
    let Some(table) = table else {
        return Err(no_numbers());
    };
    // After the last line end is an empty line.
    let is_open = rows.end == table.rows() && table.last_line() == last_line;
    table.reading(&header, rows, is_open)
}

impl Text {
    fn parse(bytes: &[u8]) -> Result<Text, SurfaceError> {
        // Tables of results are in SI units.
        let is_result = bytes.starts_with(PROVENANCE.as_bytes());
        let first = Part {
            header: TextHeader::in_unit(is_result.then_some(Unit::METRE)),
            table: None,
        };
        let mut text = Text {
            parts: vec![first],
            last_of_header: None,
            last_line: 0,
        };
        each_line(bytes, |number, line| text.take(number, line))?;
        Ok(text)
    }

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

/// Returns true for a line after numbers that begins another header: words, or a comment with the
/// name of a channel.
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

/// Returns the channel with this number. Without a number, chooses the only channel, or the only
/// one whose heights are lengths.
fn chosen(parts: &[Part], number: Option<u32>) -> Result<Channel, SurfaceError> {
    let channels = channels(parts);
    if channels.is_empty() {
        return Err(no_numbers());
    }
    if let [only] = &channels[..] {
        return Ok(only.clone());
    }
    let chosen = match number {
        Some(number) => channels.get(number as usize).filter(|channel| {
            // The numbers of a channel without any unit may be lengths.
            parts[channel.part].header.other_unit.is_none()
        }),
        None => {
            let is_length = |channel: &&Channel| parts[channel.part].header.unit(Z, None).is_some();
            let mut lengths = channels.iter().filter(is_length);
            let first = lengths.next();
            if lengths.next().is_some() {
                None
            } else {
                first
            }
        }
    };
    match chosen {
        Some(channel) => Ok(channel.clone()),
        None => Err(undecided(parts, &channels, number)),
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

/// Returns the error of a text in which none or several of the channels may be meant.
fn undecided(parts: &[Part], channels: &[Channel], number: Option<u32>) -> SurfaceError {
    let mut listed: Vec<String> = channels
        .iter()
        .enumerate()
        .take(MOST_LISTED)
        .map(|(number, channel)| description(number, &parts[channel.part], &channel.rows))
        .collect();
    if channels.len() > MOST_LISTED {
        listed.push("…".to_owned());
    }
    let missing = match number {
        Some(number) => format!("no lengths in channel {number} of "),
        None => String::new(),
    };
    let count = channels.len();
    SurfaceError::Channel {
        place: Place::File,
        fault: format!("{missing}{count} channels"),
        channels: listed,
        allowed: "the number of one",
        remedy: Remedy::Channel,
    }
}

/// Describes a channel by its number, its name, its unit and its first line.
fn description(number: usize, part: &Part, rows: &Range<usize>) -> String {
    let header = &part.header;
    let mut description = number.to_string();
    if let Some(name) = &header.channel {
        description += &format!(" {:?}", shown(name));
    }
    let unit = header.unit(Z, None).map(Unit::name);
    if let Some(unit) = unit.or(header.other_unit.as_deref()) {
        description += &format!(" in {}", shown(unit));
    }
    let line = part
        .table
        .as_ref()
        .map_or(0, |table| table.line(rows.start));
    description + &format!(" from line {line}")
}

#[cfg(test)]
mod tests {
    use super::super::options::ReadOptions;
    use super::*;

    fn text(text: &str) -> Result<Reading, String> {
        read(text.as_bytes(), None).map_err(|error| error.to_string())
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

    /// Units of positions and of heights by their names.
    fn units(reading: &Reading) -> [Option<&'static str>; 2] {
        [reading.units.along, reading.units.heights].map(|unit| unit.map(Unit::name))
    }

    #[test]
    fn what_is_no_number_of_a_point_is_left_out() {
        let expected = text("0.5 1e-1\n1.5 2.5\n2.5 -3\n").unwrap();
        for other in [
            // Separators at the ends of lines.
            "0.5,0.1,,\n1.5,2.5,,\n2.5,-3,,\n",
            "x,z,\n0.5,0.1,\n1.5,2.5\n2.5,-3,,\n",
            // Quotation marks, and CR alone at the ends of lines.
            "\"0,5\";\"0,1\"\r\"1,5\";\"2,5\"\r\"2,5\";\"-3\"",
            // Counts, of points or of the distances between them.
            "3\n0.5 0.1\n1.5 2.5\n2.5 -3\n",
            "2\n0.5 0.1\n1.5 2.5\n2.5 -3\n",
            // Headers that begin with a number, and footers.
            "5.6 mm scan\n3 points\n0.5 0.1\n1.5 2.5\n2.5 -3\n\nEnd of data\n",
            "3 points\n0.5,0.1\n1.5,2.5\n2.5,-3\n3 points,\"read\",at 12:00\n",
            // Numbers of points and their validity.
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
            "2 channels: 0 \"Height\" in nm from line 5, 1 \"Retrace\" in nm from line 11; allowed: the number of one"
        );
        let chosen = |text: &str, channel| {
            read(text.as_bytes(), Some(channel)).map_err(|error| error.to_string())
        };
        assert_eq!(chosen(&two, 1).unwrap().heights[0], 20.0);
        assert!(
            chosen(&two, 2)
                .unwrap_err()
                .starts_with("no lengths in channel 2 of 2 channels: 0 \"Height\"")
        );
        assert!(
            chosen(&both, 0)
                .unwrap_err()
                .starts_with("no lengths in channel 0 of 2 channels: 0 \"Phase\" in deg")
        );
        // Without headers, and profiles.
        let rows = "1 2 3 4\n5 6 7 9\n\n11 2 3 4\n5 6 7 9\n";
        assert!(
            text(rows).unwrap_err().starts_with(
                "2 channels: 0 from line 1, 1 from line 4; allowed: the number of one"
            )
        );
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
                .starts_with("2 channels: 0 from line 2, 1 from line 5")
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
            // Lines of Wyko run along y.
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
        // The distance has a unit of its own, so that the option is that of the heights.
        let with = |unit: &str| {
            let options = ReadOptions {
                unit: unit.parse().ok(),
                ..ReadOptions::default()
            };
            let found = read(keyence.as_bytes(), None).unwrap().resolve(&options);
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
