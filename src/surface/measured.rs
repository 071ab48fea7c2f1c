//! Measured profiles: a text file with the columns x and z in m.

use super::SurfaceError;
use crate::io::{ReadError, open_regular};
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

/// Largest number of bytes read of a file.
const MOST_BYTES: u64 = 1 << 30;

/// Longest line, bytes: two numbers take a few dozen.
const LONGEST_LINE: usize = 1 << 16;

/// Largest position and height read, m, and largest slope between two points: from there on lengths, mean
/// squares and differences would go beyond all numbers.
const LARGEST: f64 = 1.0e9;

/// Longer columns are shortened in messages.
const MOST_SHOWN: usize = 40;

/// Share of the distance between points by which those of an even grid may be out, for want of digits.
const UNEVEN: f64 = 1.0e-3;

/// A profile measured along a line.
///
/// Points at x = Δx/2, 3Δx/2, …, as `asperity line` writes them, are middles of cells: N points cover N Δx from x = 0 on,
/// the first and the last half cell at the height of the point next to it. Any other profile covers the distance from
/// its first to its last point.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredProfile {
    positions: Vec<f64>,
    heights: Vec<f64>,
}

impl MeasuredProfile {
    /// Reads a profile from a regular file of at most 1 GiB, line by line; see [`Self::parse`]. Beside the
    /// points, 16 bytes each, no more than one line is held.
    ///
    /// # Errors
    /// [`SurfaceError::Measured`] when the file cannot be read or is no profile.
    pub fn read(path: &Path) -> Result<Self, SurfaceError> {
        Self::read_seen(path, &mut |_| ())
    }

    /// [`Self::read`], with all bytes of the file shown to `seen`, one line after the other.
    pub(crate) fn read_seen(path: &Path, seen: &mut dyn FnMut(&[u8])) -> Result<Self, SurfaceError> {
        Self::read_up_to(path, MOST_BYTES, seen)
            .map_err(|reason| SurfaceError::Measured { file: path.display().to_string(), reason })
    }

    fn read_up_to(path: &Path, most: u64, seen: &mut dyn FnMut(&[u8])) -> Result<Self, String> {
        let file = open_regular(path).map_err(|error| error.to_string())?;
        // One byte more tells a file of that length from a longer one.
        let mut source = BufReader::new(file.take(most + 1));
        let (mut reader, mut line) = (Reader::default(), Vec::new());
        let mut bytes = 0;
        loop {
            line.clear();
            let taken = (&mut source)
                .take(LONGEST_LINE as u64 + 1)
                .read_until(b'\n', &mut line)
                .map_err(|error| ReadError::from(error).to_string())?;
            bytes += taken as u64;
            if bytes > most {
                return Err(format!("longer than {most} bytes; allowed: at most {most} bytes"));
            }
            if taken == 0 {
                return reader.finish();
            }
            seen(&line);
            reader.take(&line)?;
        }
    }

    /// Reads a profile from text: a line for each point with x and z in m, between them a comma,
    /// semicolon, tab or spaces; x ascending. Empty lines, lines that begin with `#` and a first line
    /// of column names are skipped, and so is a byte order mark. Positions and heights are at most 1e9 m,
    /// slopes from point to point at most 1e9. A column between two commas, semicolons or tabs, or before or
    /// behind one, must not be empty; a line is at most 64 KiB long.
    ///
    /// # Errors
    /// What is wrong, with its line number.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut reader = Reader::default();
        for line in text.lines() {
            reader.take(line.as_bytes())?;
        }
        reader.finish()
    }

    /// Positions x, m, ascending; at least two.
    #[must_use]
    pub fn positions(&self) -> &[f64] {
        &self.positions
    }

    /// Heights z, m, as measured: one for each position.
    #[must_use]
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// Length covered, m.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.cell().map_or_else(|| self.span(), |cell| cell * self.positions.len() as f64)
    }

    /// Distance from the first to the last point, m.
    fn span(&self) -> f64 {
        self.positions[self.positions.len() - 1] - self.positions[0]
    }

    /// Distance between points, m, where these are the middles of cells that begin at x = 0.
    fn cell(&self) -> Option<f64> {
        let cell = self.span() / (self.positions.len() - 1) as f64;
        let middles = (0..self.positions.len()).map(|index| (index as f64 + 0.5) * cell);
        let near = |(x, middle): (&f64, f64)| (x - middle).abs() <= UNEVEN * cell;
        self.positions.iter().zip(middles).all(near).then_some(cell)
    }

    /// Root mean square height about the mean and root mean square gradient of the straight pieces
    /// between the measured points.
    #[must_use]
    pub fn rms_height_and_gradient(&self) -> (f64, f64) {
        let length = self.span();
        // Against an offset far larger than the roughness: differences of heights, not heights.
        let level = self.heights[0];
        let pieces = || {
            let heights = self.heights.windows(2).map(|z| (z[0] - level, z[1] - level));
            self.positions.windows(2).zip(heights).map(|(x, (a, b))| (x[1] - x[0], a, b))
        };
        let mean = pieces().map(|(dx, a, b)| dx * (a + b) / 2.0).sum::<f64>() / length;
        let square = pieces()
            .map(|(dx, a, b)| (a - mean, b - mean, dx))
            .map(|(a, b, dx)| dx * (a * a + a * b + b * b) / 3.0)
            .sum::<f64>();
        let gradient = pieces().map(|(dx, a, b)| (b - a) * (b - a) / dx).sum::<f64>();
        ((square / length).sqrt(), (gradient / length).sqrt())
    }

    /// Heights, m, at x = (i + ½ − `shift`)L/N from the beginning of the profile, by linear interpolation; at a measured
    /// point its own height, bit for bit. If all heights of the profile are from half to twice the first, the first is
    /// subtracted: the differences are then exact, and roughness on a large offset keeps its digits.
    ///
    /// # Errors
    /// When the profile is shorter than `length` m.
    pub fn sample(&self, length: f64, points: usize, shift: f64) -> Result<Vec<f64>, String> {
        let cell = self.cell();
        // The last half cell may be as far out as points are.
        let margin = cell.map_or(0.0, |cell| UNEVEN * cell);
        if self.length() + margin < length {
            return Err(format!(
                "the profile covers {:e} m; allowed: at least length = {length:e} m",
                self.length()
            ));
        }
        let mut heights = Vec::new();
        heights.try_reserve_exact(points).map_err(|_| format!("not enough memory for {points} points"))?;
        let begins = if cell.is_some() { 0.0 } else { self.positions[0] };
        let level = self.level();
        let mut piece = 0;
        for index in 0..points {
            let x = begins + (index as f64 + 0.5 - shift) * (length / points as f64);
            while piece + 2 < self.positions.len() && self.positions[piece + 1] < x {
                piece += 1;
            }
            let (x0, x1) = (self.positions[piece], self.positions[piece + 1]);
            let (z0, z1) = (self.heights[piece] - level, self.heights[piece + 1] - level);
            heights.push(if x <= x0 {
                z0
            } else if x >= x1 {
                z1
            } else {
                z0 + (z1 - z0) * ((x - x0) / (x1 - x0))
            });
        }
        Ok(heights)
    }

    /// Height, m, subtracted from all others: the first one, if all differences are exact, else 0.
    fn level(&self) -> f64 {
        let first = self.heights[0];
        let (low, high) = (0.5 * first.abs(), 2.0 * first.abs());
        // By Sterbenz' lemma.
        let is_exact = |height: &f64| (low..=high).contains(&(height * first.signum()));
        if self.heights.iter().all(is_exact) { first } else { 0.0 }
    }
}

/// Reads the lines of a profile one after the other.
struct Reader {
    profile: MeasuredProfile,
    /// Number of the line read last, from 1 on.
    number: usize,
    header_allowed: bool,
}

impl Default for Reader {
    fn default() -> Self {
        let profile = MeasuredProfile { positions: Vec::new(), heights: Vec::new() };
        Reader { profile, number: 0, header_allowed: true }
    }
}

impl Reader {
    /// Takes the next line, with or without its end.
    fn take(&mut self, line: &[u8]) -> Result<(), String> {
        self.number += 1;
        let wrong = |number: usize, what: String| format!("line {number}: {what}");
        if line.len() > LONGEST_LINE {
            return Err(wrong(
                self.number,
                format!("longer than {LONGEST_LINE} bytes; allowed: at most that"),
            ));
        }
        let line = str::from_utf8(line).map_err(|error| {
            let byte = error.valid_up_to();
            wrong(self.number, format!("this is not UTF-8 text: byte {byte} of the line is not"))
        })?;
        let line = if self.number == 1 { line.strip_prefix('\u{feff}').unwrap_or(line) } else { line };
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            return Ok(());
        }
        let header_allowed = std::mem::replace(&mut self.header_allowed, false);
        if header_allowed && is_header(line) {
            return Ok(());
        }
        let (x, z) = point(line).map_err(|what| wrong(self.number, what))?;
        self.push(x, z).map_err(|what| wrong(self.number, what))
    }

    fn push(&mut self, x: f64, z: f64) -> Result<(), String> {
        let MeasuredProfile { positions, heights } = &mut self.profile;
        if let (Some(&before), Some(&height)) = (positions.last(), heights.last()) {
            if before >= x {
                return Err(format!("x = {x:e} after {before:e}; allowed: x ascending"));
            }
            let slope = (z - height).abs() / (x - before);
            if slope > LARGEST {
                return Err(format!(
                    "a slope of {slope:e} from the point before; allowed: at most {LARGEST:e}"
                ));
            }
        }
        for (values, value) in [(positions, x), (heights, z)] {
            values.try_reserve(1).map_err(|_| "not enough memory for the points up to here".to_owned())?;
            values.push(value);
        }
        Ok(())
    }

    fn finish(self) -> Result<MeasuredProfile, String> {
        match self.profile.positions.len() {
            points @ (0 | 1) => Err(format!("{points} points; allowed: at least 2")),
            _ => Ok(self.profile),
        }
    }
}

/// The columns of a line. Spaces part columns, and more of them part them no further; between two other
/// separators there is a column, though it may be empty.
fn columns(line: &str) -> impl Iterator<Item = &str> {
    line.split([',', ';', '\t']).flat_map(|part| {
        let empty = part.trim().is_empty().then_some("");
        empty.into_iter().chain(part.split_whitespace())
    })
}

/// Whether a line holds names and no number.
fn is_header(line: &str) -> bool {
    columns(line).all(|column| column.parse::<f64>().is_err())
        && columns(line).any(|column| !column.is_empty())
}

/// x and z of a line.
fn point(line: &str) -> Result<(f64, f64), String> {
    if let Some(empty) = columns(line).position(str::is_empty) {
        return Err(format!("column {} is empty; allowed: x and z", empty + 1));
    }
    let mut all = columns(line);
    let (Some(x), Some(z), None) = (all.next(), all.next(), all.next()) else {
        return Err(format!("{} columns; allowed: x and z", columns(line).count()));
    };
    Ok((number(x)?, number(z)?))
}

fn number(column: &str) -> Result<f64, String> {
    match column.parse::<f64>() {
        Ok(value) if value.abs() <= LARGEST => Ok(value),
        _ => Err(format!("{:?}; allowed: a number from -{LARGEST:e} to {LARGEST:e} in m", shown(column))),
    }
}

/// A column for a message, not too long.
fn shown(column: &str) -> String {
    match column.char_indices().nth(MOST_SHOWN) {
        Some((end, _)) => format!("{}…", &column[..end]),
        None => column.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_what_instruments_write() {
        let profile = MeasuredProfile::parse("# stylus\nx,z\n0.0, 1e-7\n1e-6;3e-7\n\n2e-6\t-1e-7\n").unwrap();
        assert_eq!(profile.positions, [0.0, 1e-6, 2e-6]);
        let heights = profile.sample(2e-6, 2, 0.0).unwrap();
        // Halfway between 1 and 3, and between 3 and −1.
        assert!((heights[0] - 2e-7).abs() < 1e-20 && (heights[1] - 1e-7).abs() < 1e-20, "{heights:?}");
        assert_eq!(profile.sample(2e-6, 2, 0.5).unwrap(), [1e-7, 3e-7]);
        assert!(profile.sample(3e-6, 2, 0.0).unwrap_err().contains("covers 2e-6 m"));
    }

    #[test]
    fn a_row_has_at_most_so_many_bytes() {
        let row = |bytes: usize| format!("0 1\n1 2{}\n2 3", " ".repeat(bytes - 3));
        assert_eq!(MeasuredProfile::parse(&row(LONGEST_LINE)).unwrap().positions, [0.0, 1.0, 2.0]);
        let error = MeasuredProfile::parse(&row(LONGEST_LINE + 1)).unwrap_err();
        assert!(error.starts_with("line 2: longer than 65536 bytes"), "{error}");
    }

    #[test]
    fn points_that_begin_at_half_their_distance_are_middles_of_cells() {
        let profile = MeasuredProfile::parse("0.5 3\n1.5 4\n2.5 -1").unwrap();
        assert_eq!(profile.length(), 3.0);
        assert_eq!(profile.sample(3.0, 3, 0.0).unwrap(), [3.0, 4.0, -1.0]);
        // Before the first and behind the last point at its height, halfway between points at their mean.
        assert_eq!(profile.sample(3.0, 6, 0.5).unwrap(), [3.0, 3.0, 3.5, 4.0, 1.5, -1.0]);
        assert_eq!(profile.sample(3.0, 12, 0.0).unwrap()[11], -1.0);
        assert_eq!(profile.sample(1.0, 1, 0.0).unwrap(), [3.0]);
        assert!(profile.sample(3.01, 3, 0.0).unwrap_err().contains("covers 3e0 m"));
        // With so many digits as a file has.
        let rounded = MeasuredProfile::parse("0.1667 3\n0.5 4\n0.8333 -1").unwrap();
        assert!((rounded.length() - 1.0).abs() < 1e-3 && rounded.sample(1.0, 3, 0.0).is_ok());
        // Anything else covers what lies between its points.
        for (text, length) in
            [("0 3\n1 4\n2 -1", 2.0), ("0.5 3\n1.5 4\n2.4 -1", 1.9), ("1 3\n2 4\n3 -1", 2.0)]
        {
            let profile = MeasuredProfile::parse(text).unwrap();
            assert!((profile.length() - length).abs() < 1e-15);
            assert!(profile.sample(length, 3, 0.0).is_ok() && profile.sample(1.01 * length, 3, 0.0).is_err());
        }
    }

    #[test]
    fn an_offset_is_taken_out_where_that_is_exact() {
        let heights = |text: &str| MeasuredProfile::parse(text).unwrap().sample(2.0, 2, 0.0).unwrap();
        assert_eq!(heights("0.5 1e8\n1.5 100000001"), [0.0, 1.0]);
        assert_eq!(heights("0.5 -3\n1.5 -5"), [0.0, -2.0]);
        assert_eq!(heights("0.5 3\n1.5 7"), [3.0, 7.0]);
        assert_eq!(heights("0.5 -3\n1.5 3"), [-3.0, 3.0]);
        assert_eq!(heights("0.5 0\n1.5 0"), [0.0, 0.0]);
    }

    #[test]
    fn says_what_is_wrong_and_where() {
        let wrong = |text: &str| MeasuredProfile::parse(text).unwrap_err();
        assert!(wrong("0 1\n1 NaN\n").contains("line 2"));
        assert!(wrong("0 1\n0 2\n").contains("line 2: x = 0e0 after 0e0"));
        assert!(wrong("0 1 2\n").contains("line 1: 3 columns"));
        assert!(wrong("x z\n0 1\nx z\n").contains("line 3"));
        assert!(wrong("").contains("0 points"));
        let long = wrong(&format!("0 {}", "κ".repeat(1000)));
        assert!(long.chars().count() < 120, "{long}");
    }

    #[test]
    fn an_empty_column_is_an_error_that_names_its_row() {
        let wrong = |text: &str| MeasuredProfile::parse(text).unwrap_err();
        assert_eq!(wrong("x,z\n0,1\n1,,2\n2,3"), "line 3: column 2 is empty; allowed: x and z");
        assert_eq!(wrong("0,1\n1;;2"), "line 2: column 2 is empty; allowed: x and z");
        assert_eq!(wrong("0 1\n1\t\t2"), "line 2: column 2 is empty; allowed: x and z");
        assert_eq!(wrong("0,1\n1, ,2"), "line 2: column 2 is empty; allowed: x and z");
        assert_eq!(wrong("0,1\n,1,2"), "line 2: column 1 is empty; allowed: x and z");
        assert_eq!(wrong("0,1\n1,2,"), "line 2: column 3 is empty; allowed: x and z");
        assert_eq!(wrong(",,\n0,1\n1,2"), "line 1: column 1 is empty; allowed: x and z");
        // Spaces around a separator are no columns.
        let spaced = MeasuredProfile::parse("0 ,  1\n1\t 2\n2    3 ").unwrap();
        assert_eq!(spaced, MeasuredProfile::parse("0,1\n1,2\n2,3").unwrap());
    }

    #[test]
    fn a_file_is_read_line_by_line_up_to_a_number_of_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("line.csv");
        let text = "\u{feff}# stylus\r\nx,z\r\n0,1\r\n1,2";
        std::fs::write(&path, text).unwrap();
        assert_eq!(MeasuredProfile::read(&path).unwrap(), MeasuredProfile::parse(text).unwrap());
        let length = text.len() as u64;
        assert!(MeasuredProfile::read_up_to(&path, length, &mut |_| ()).is_ok());
        let wrong = MeasuredProfile::read_up_to(&path, length - 1, &mut |_| ()).unwrap_err();
        assert!(wrong.contains(&format!("longer than {} bytes", length - 1)), "{wrong}");
        let wrong = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            MeasuredProfile::read(&path).unwrap_err().to_string()
        };
        let told = wrong(&[b"0,1\n".as_slice(), &[b' '; 2 * LONGEST_LINE]].concat());
        assert!(told.contains("line 2: longer than 65536 bytes"), "{told}");
        assert!(wrong(b"0,1\n1,\xb5").contains("line 2: this is not UTF-8 text: byte 2"));
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_not_read() {
        for device in ["/dev/zero", "/dev/null", "/dev/tty"] {
            let told = MeasuredProfile::read(Path::new(device)).unwrap_err().to_string();
            assert!(told.contains("not a regular file"), "{device}: {told}");
        }
    }

    #[test]
    fn what_a_length_or_a_mean_square_cannot_hold_is_refused() {
        let wrong = |text: &str| MeasuredProfile::parse(text).unwrap_err();
        assert_eq!(wrong("-1e308 0\n1e308 0"), "line 1: \"-1e308\"; allowed: a number from -1e9 to 1e9 in m");
        assert!(wrong("0 0\n1 -1.1e9").contains("line 2: \"-1.1e9\""));
        assert_eq!(
            wrong("0 0\n0.5 1e9\n1 0"),
            "line 2: a slope of 2e9 from the point before; allowed: at most 1e9"
        );
        let steepest = MeasuredProfile::parse("-1e9 1e9\n-999999998 -1e9\n1e9 1e9").unwrap();
        let (height, gradient) = steepest.rms_height_and_gradient();
        assert!(height.is_finite() && gradient.is_finite() && steepest.length() == 2e9);
    }

    #[test]
    fn a_byte_order_mark_is_no_number() {
        assert_eq!(MeasuredProfile::parse("\u{feff}0 1\n1 2"), MeasuredProfile::parse("0 1\n1 2"));
        assert!(MeasuredProfile::parse("0 1\n\u{feff}1 2").unwrap_err().contains("line 2"));
    }

    #[test]
    fn a_level_is_read_however_high() {
        let level = MeasuredProfile::parse("0 1e9\n1 1e9").unwrap();
        assert_eq!((level.heights(), level.length()), (&[1e9, 1e9][..], 1.0));
    }

    #[test]
    fn samples_lie_on_the_straight_pieces() {
        let profile = MeasuredProfile::parse("-2 7\n0 3\n1 6\n4 0").unwrap();
        // At −1.5, −0.5 … 3.5.
        assert_eq!(profile.sample(6.0, 6, 0.0).unwrap(), [6.0, 4.0, 4.5, 5.0, 3.0, 1.0]);
        // From the first point on.
        assert_eq!(profile.sample(2.0, 4, 0.0).unwrap(), [6.5, 5.5, 4.5, 3.5]);
        assert_eq!(
            (profile.positions(), profile.heights()),
            (&[-2.0, 0.0, 1.0, 4.0][..], &[7.0, 3.0, 6.0, 0.0][..])
        );
    }

    #[test]
    fn uneven_pieces_count_by_their_lengths() {
        let profile = MeasuredProfile::parse("5 1\n6 3\n9 -3").unwrap();
        let (height, gradient) = profile.rms_height_and_gradient();
        // Mean 1/2; ∫ (z − 1/2)² dx is 31/12 and 39/4 on the two pieces, and the slopes are 2 and −2.
        let square: f64 = (31.0 / 12.0 + 39.0 / 4.0) / 4.0;
        assert!(
            (height - square.sqrt()).abs() < 1e-15 && (gradient - 2.0).abs() < 1e-15,
            "{height} {gradient}"
        );
    }

    #[test]
    fn statistics_are_those_of_the_straight_pieces() {
        // A triangle of height 1 over length 2: mean 1/2, variance 1/12, slope 1.
        let profile = MeasuredProfile::parse("5 0\n6 1\n7 0").unwrap();
        let (height, gradient) = profile.rms_height_and_gradient();
        assert!((height - (1.0_f64 / 12.0).sqrt()).abs() < 1e-15);
        assert!((gradient - 1.0).abs() < 1e-15);
        // A level is no roughness.
        let level = MeasuredProfile::parse("6e-5 5\n1 5\n3 5").unwrap();
        assert_eq!(level.rms_height_and_gradient(), (0.0, 0.0));
    }
}
