//! Measured profiles: a text file with the columns x and z in m.

use super::SurfaceError;
use std::path::Path;

/// Largest file read, bytes.
const LARGEST_FILE: u64 = 1 << 30;

/// Largest position and height read, m, and largest slope between two points: from there on lengths, mean
/// squares and differences would go beyond all numbers.
const LARGEST: f64 = 1.0e9;

/// Longer columns are shortened in messages.
const MOST_SHOWN: usize = 40;

/// A profile measured along a line.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredProfile {
    positions: Vec<f64>,
    heights: Vec<f64>,
}

impl MeasuredProfile {
    /// Reads a profile from a file; see [`Self::parse`].
    ///
    /// # Errors
    /// [`SurfaceError::Measured`] when the file cannot be read or is no profile.
    pub fn read(path: &Path) -> Result<Self, SurfaceError> {
        let file = path.display().to_string();
        let fail = |reason: String| SurfaceError::Measured { file: file.clone(), reason };
        let size = std::fs::metadata(path).map_err(|error| fail(error.to_string()))?.len();
        if size > LARGEST_FILE {
            return Err(fail(format!("{size} bytes; allowed: at most {LARGEST_FILE}")));
        }
        let text = std::fs::read_to_string(path).map_err(|error| fail(error.to_string()))?;
        Self::parse(&text).map_err(fail)
    }

    /// Reads a profile from text: a line for each point with x and z in m, between them a comma,
    /// semicolon, tab or spaces; x ascending. Empty lines, lines that begin with `#` and a first line
    /// of column names are skipped, and so is a byte order mark. Positions and heights are at most 1e9 m,
    /// slopes from point to point at most 1e9.
    ///
    /// # Errors
    /// What is wrong, with its line number.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut profile = MeasuredProfile { positions: Vec::new(), heights: Vec::new() };
        let mut header_allowed = true;
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        for (number, line) in text.lines().enumerate().map(|(index, line)| (index + 1, line.trim())) {
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let columns: Vec<&str> = line
                .split([',', ';', '\t', ' '])
                .map(str::trim)
                .filter(|column| !column.is_empty())
                .collect();
            let is_header = std::mem::replace(&mut header_allowed, false)
                && columns.iter().all(|column| column.parse::<f64>().is_err());
            if is_header {
                continue;
            }
            let [x, z] = columns[..] else {
                return Err(format!("line {number}: {} columns; allowed: x and z", columns.len()));
            };
            let number_in = |column: &str| match column.parse::<f64>() {
                Ok(value) if value.abs() <= LARGEST => Ok(value),
                _ => Err(format!(
                    "line {number}: {:?}; allowed: a number from -{LARGEST:e} to {LARGEST:e} in m",
                    shown(column)
                )),
            };
            let (x, z) = (number_in(x)?, number_in(z)?);
            if let (Some(&before), Some(&height)) = (profile.positions.last(), profile.heights.last()) {
                if before >= x {
                    return Err(format!("line {number}: x = {x:e} after {before:e}; allowed: x ascending"));
                }
                let slope = (z - height).abs() / (x - before);
                if slope > LARGEST {
                    return Err(format!(
                        "line {number}: a slope of {slope:e} from the point before; allowed: at most {LARGEST:e}"
                    ));
                }
            }
            profile.positions.push(x);
            profile.heights.push(z);
        }
        if profile.positions.len() < 2 {
            return Err(format!("{} points; allowed: at least 2", profile.positions.len()));
        }
        Ok(profile)
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
        self.positions[self.positions.len() - 1] - self.positions[0]
    }

    /// Root mean square height about the mean and root mean square gradient of the straight pieces
    /// between the measured points.
    #[must_use]
    pub fn rms_height_and_gradient(&self) -> (f64, f64) {
        let length = self.length();
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

    /// Heights above the first point, m, at x = (i + ½)L/N from the first point on,
    /// straight between measured points.
    ///
    /// # Errors
    /// When the profile is shorter than `length` m.
    pub fn sample(&self, length: f64, points: usize) -> Result<Vec<f64>, String> {
        if self.length() < length {
            return Err(format!(
                "the profile covers {:e} m; allowed: at least length = {length:e} m",
                self.length()
            ));
        }
        let mut heights = Vec::new();
        heights.try_reserve_exact(points).map_err(|_| format!("not enough memory for {points} points"))?;
        // Against an offset far larger than the roughness: differences of heights, not heights.
        let level = self.heights[0];
        let mut piece = 0;
        for index in 0..points {
            let x = self.positions[0] + (index as f64 + 0.5) * (length / points as f64);
            while piece + 2 < self.positions.len() && self.positions[piece + 1] < x {
                piece += 1;
            }
            let (x0, x1) = (self.positions[piece], self.positions[piece + 1]);
            let (z0, z1) = (self.heights[piece] - level, self.heights[piece + 1] - level);
            heights.push(z0 + (z1 - z0) * ((x - x0) / (x1 - x0)));
        }
        Ok(heights)
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
        let heights = profile.sample(2e-6, 2).unwrap();
        // Halfway between 1 and 3, and between 3 and −1, above the first.
        assert!((heights[0] - 1e-7).abs() < 1e-20 && heights[1].abs() < 1e-20, "{heights:?}");
        assert!(profile.sample(3e-6, 2).unwrap_err().contains("covers 2e-6 m"));
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
    fn a_file_of_gigabytes_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("profile");
        // A hole takes no room on the disk.
        std::fs::File::create(&path).unwrap().set_len(LARGEST_FILE + 1).unwrap();
        let error = MeasuredProfile::read(&path).unwrap_err().to_string();
        assert!(error.contains("1073741825 bytes; allowed: at most 1073741824"), "{error}");
    }

    #[test]
    fn samples_lie_on_the_straight_pieces() {
        let profile = MeasuredProfile::parse("-2 7\n0 3\n1 6\n4 0").unwrap();
        // Above the first height, at −1.5, −0.5 … 3.5.
        assert_eq!(profile.sample(6.0, 6).unwrap(), [-1.0, -3.0, -2.5, -2.0, -4.0, -6.0]);
        // From the first point on.
        assert_eq!(profile.sample(2.0, 4).unwrap(), [-0.5, -1.5, -2.5, -3.5]);
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
