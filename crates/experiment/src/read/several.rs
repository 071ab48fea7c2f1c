//! Several curves in one text, such as a map (force volume), and the places on the specimen at
//! which they were measured.
//!
//! A new curve begins where the lines above its points state another place or another number of a
//! curve. In a text without such lines it begins after an empty line, if each part between empty
//! lines goes there and back.

use crate::error::ExperimentError;
use crate::read;
use crate::read::names::{letters, names_segment, unit};
use crate::read::options::CurveOptions;
use crate::read::text::{RUN, is_comment, is_row};
use asperity_data::text_table::{TextFault, each_line};
use asperity_surface::files::{content, unpacked};
use std::path::Path;

/// Names of the coordinates of a place in files, reduced by [`letters`].
const COORDINATES: [[&str; 5]; 2] = [
    ["x", "xposition", "positionx", "xpos", "xcoordinate"],
    ["y", "yposition", "positiony", "ypos", "ycoordinate"],
];
/// Names before the number of a curve in files, reduced by [`letters`].
const NUMBERS: [&str; 5] = ["curve", "index", "point", "pixel", "curveindex"];
/// Distance between the first and the last displacement of a curve, as a share of its range of
/// displacements, below which the curve goes there and back.
const BACK: f64 = 0.8;

/// What the lines above the points of a curve state about it.
#[derive(Clone, Debug, Default, PartialEq)]
struct Stated {
    /// Coordinates in m.
    x: Option<f64>,
    y: Option<f64>,
    /// Number of the curve in the file.
    number: Option<f64>,
}

impl Stated {
    /// Adds what a line states, unless an earlier line has stated it: `# xPosition: 1e-6`,
    /// `X 2 Y 3`, `x = 1 um, y = 2 um` or `curve 7`.
    fn take(&mut self, line: &str) {
        let is_between = |c: char| c.is_whitespace() || ",;:=\"#[](){}".contains(c);
        let words: Vec<&str> = line
            .split(is_between)
            .filter(|word| !word.is_empty())
            .collect();
        for (index, word) in words.iter().enumerate() {
            let word = letters(word);
            let after = &words[index + 1..];
            if COORDINATES[0].contains(&&*word) {
                self.x = self.x.or_else(|| length(after));
            } else if COORDINATES[1].contains(&&*word) {
                self.y = self.y.or_else(|| length(after));
            }
        }
        if let [name, number] = words[..]
            && NUMBERS.contains(&&*letters(name))
            && let Ok(number) = number.parse()
        {
            self.number.get_or_insert(number);
        }
    }

    fn is_empty(&self) -> bool {
        *self == Stated::default()
    }

    /// Returns true if each value that is stated here is the same in `other`.
    fn agrees_with(&self, other: &Stated) -> bool {
        let agrees = |own: Option<f64>, other: Option<f64>| own.is_none() || own == other;
        agrees(self.x, other.x) && agrees(self.y, other.y) && agrees(self.number, other.number)
    }

    fn position(&self) -> Option<[f64; 2]> {
        Some([self.x?, self.y?])
    }
}

/// Returns the length in m that words begin with: a number before or after its unit. A number
/// without a unit is in m.
fn length(words: &[&str]) -> Option<f64> {
    let number = |word: &&str| word.parse::<f64>().ok().filter(|value| value.is_finite());
    let metres = |word: &&str| unit(word, "m");
    let first = words.first()?;
    let second = words.get(1);
    if let Some(value) = number(first) {
        return Some(value * second.and_then(metres).unwrap_or(1.0));
    }
    Some(second.and_then(number)? * metres(first)?)
}

/// Consecutive rows of numbers in a text, with the lines above them.
#[derive(Clone, Debug, Default)]
struct Rows {
    /// Index, from 0, of the first line above the rows.
    begin: usize,
    /// Index of the first row.
    first: usize,
    /// Index after the last row.
    end: usize,
    stated: Stated,
    /// True if only empty lines are above the rows.
    is_after_empty_line: bool,
}

/// A text with more than one curve.
#[derive(Clone, Debug)]
pub struct SeveralCurves {
    lines: Vec<String>,
    /// Number of lines that are above all curves.
    head: usize,
    curves: Vec<Rows>,
}

impl SeveralCurves {
    /// Reads the file at `path`, if it is a text with several curves; `None` for a file with one
    /// curve and for any other file.
    pub fn read(path: &Path, options: &CurveOptions) -> Option<SeveralCurves> {
        SeveralCurves::parse(path, &content(path).ok()?, options)
    }

    /// Finds the curves in `bytes`, the content of a text file with this name; `None` if there are
    /// not several.
    ///
    /// ```
    /// use asperity_experiment::{CurveOptions, SeveralCurves};
    /// use std::path::Path;
    ///
    /// let rows: String = (0..60).map(|i: i32| format!("{},0\n", 30 - (i - 30).abs())).collect();
    /// let map = format!("d [nm],f [nN]\n# x: 1 um, y: 2 um\n{rows}# x: 3 um, y: 2 um\n{rows}");
    /// let options = CurveOptions::default();
    /// let found = SeveralCurves::parse(Path::new("map.csv"), map.as_bytes(), &options);
    /// let found = found.ok_or("one curve")?;
    /// assert_eq!((found.count(), found.position(1)), (2, Some([3e-6, 2e-6])));
    /// # Ok::<(), &'static str>(())
    /// ```
    pub fn parse(name: &Path, bytes: &[u8], options: &CurveOptions) -> Option<SeveralCurves> {
        let bytes = unpacked(bytes).ok()?;
        let mut lines = Vec::new();
        let read = each_line(&bytes, |number, line| {
            // Lines that are left out, such as those above a table of this program, become empty.
            lines.resize(number, String::new());
            line.clone_into(&mut lines[number - 1]);
            Ok::<(), TextFault>(())
        });
        read.ok()?;
        let rows = rows_in(&lines);
        let head = rows.first()?.first;
        let are_stated = rows.iter().any(|rows| !rows.stated.is_empty());
        let curves = if are_stated {
            by_statements(rows)
        } else {
            rows
        };
        let several = SeveralCurves {
            lines,
            head,
            curves,
        };
        let is_several =
            several.curves.len() > 1 && (are_stated || several.each_goes_back(name, options));
        is_several.then_some(several)
    }

    /// Returns true if the parts of the text lie between empty lines and each of them goes there
    /// and back.
    fn each_goes_back(&self, name: &Path, options: &CurveOptions) -> bool {
        if self.lines.iter().any(|line| names_segment(line)) {
            return false;
        }
        let others = &self.curves[1..];
        others.iter().all(|rows| rows.is_after_empty_line)
            && (0..self.count()).all(|index| self.goes_back(index, name, options))
    }

    fn goes_back(&self, index: usize, name: &Path, options: &CurveOptions) -> bool {
        let Ok(columns) = read::parse(name, self.text(index).as_bytes(), options) else {
            return false;
        };
        let displacements = &columns.displacement;
        let (Some(first), Some(last)) = (displacements.first(), displacements.last()) else {
            return false;
        };
        let low = displacements.iter().copied().fold(f64::INFINITY, f64::min);
        let high = displacements
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        (last - first).abs() < BACK * (high - low)
    }

    /// Returns the number of curves.
    pub fn count(&self) -> usize {
        self.curves.len()
    }

    /// Returns the coordinates, in m, of the place at which a curve was measured; `None` if the
    /// text does not state them.
    pub fn position(&self, index: usize) -> Option<[f64; 2]> {
        self.curves.get(index)?.stated.position()
    }

    /// Returns the text of one curve: its own lines, after the lines above all curves.
    pub fn text(&self, index: usize) -> String {
        let Some(rows) = self.curves.get(index) else {
            return String::new();
        };
        let head = self.head.min(rows.begin);
        let mut text = String::new();
        for line in self.lines[..head]
            .iter()
            .chain(&self.lines[rows.begin..rows.end])
        {
            text += line;
            text.push('\n');
        }
        text
    }

    /// Returns the text of one curve after empty lines. Their number is such that each line of the
    /// curve has the number that it has in the whole text, so that an error names the right line.
    /// This text takes longer to read than [`SeveralCurves::text`].
    pub fn text_with_line_numbers(&self, index: usize) -> String {
        let begin = self.curves.get(index).map_or(0, |rows| rows.begin);
        "\n".repeat(begin.saturating_sub(self.head)) + &self.text(index)
    }
}

/// Returns the coordinates, in m, of the place at which a curve was measured, from the lines above
/// the points in `bytes`, the content of its file; `None` if it does not state them.
///
/// # Errors
/// Returns an error if the file is compressed and damaged.
pub fn position_in(bytes: &[u8]) -> Result<Option<[f64; 2]>, ExperimentError> {
    let bytes = unpacked(bytes)?;
    let mut stated = Stated::default();
    let mut rows = 0;
    let read = each_line(&bytes, |_, line| {
        if rows == RUN {
            return Ok::<(), TextFault>(());
        }
        if is_row(line) {
            rows += 1;
        } else {
            rows = 0;
            stated.take(line);
        }
        Ok(())
    });
    Ok(stated.position().filter(|_| read.is_ok()))
}

/// Returns the parts of a text that have at least [`RUN`] consecutive rows of numbers. Shorter
/// parts count as lines above the next one.
fn rows_in(lines: &[String]) -> Vec<Rows> {
    let mut all: Vec<Rows> = Vec::new();
    let mut rows = Rows {
        is_after_empty_line: true,
        ..Rows::default()
    };
    let mut index = 0;
    while index < lines.len() {
        let mut end = index;
        while end < lines.len() && is_row(&lines[end]) && !is_comment(&lines[end]) {
            end += 1;
        }
        if end - index >= RUN {
            rows.first = index;
            rows.end = end;
            all.push(rows);
            rows = Rows {
                begin: end,
                is_after_empty_line: true,
                ..Rows::default()
            };
        } else {
            end = end.max(index + 1);
            for line in &lines[index..end] {
                rows.stated.take(line);
                rows.is_after_empty_line &= line.is_empty();
            }
        }
        index = end;
    }
    all
}

/// Joins parts that belong to the same curve, because no other place and no other number of a curve
/// is stated above them.
fn by_statements(all: Vec<Rows>) -> Vec<Rows> {
    let mut curves: Vec<Rows> = Vec::new();
    for rows in all {
        match curves.last_mut() {
            Some(last) if rows.stated.agrees_with(&last.stated) => {
                last.end = rows.end;
            }
            _ => curves.push(rows),
        }
    }
    curves
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{lines, of_spring};
    use crate::curve::MeasuredCurve;
    use crate::read::tests::assert_same;

    fn parsed(text: &str) -> Option<SeveralCurves> {
        SeveralCurves::parse(
            Path::new("map.txt"),
            text.as_bytes(),
            &CurveOptions::default(),
        )
    }

    fn rows() -> String {
        let text = lines(of_spring(600));
        text.split_once('\n').unwrap().1.to_owned()
    }

    fn head() -> String {
        let text = lines(of_spring(600));
        text.split_once('\n').unwrap().0.to_owned() + "\n"
    }

    /// Each curve of a map is the same as the curve of its own file, and its place is known.
    #[test]
    fn curves_of_a_map_are_those_of_single_files() {
        let (head, rows) = (head(), rows());
        let options = CurveOptions::default();
        let single = head.clone() + &rows;
        let expected = MeasuredCurve::parse(Path::new("one"), single.as_bytes(), &options).unwrap();
        for (between, places) in [
            (
                [
                    "# xPosition: 1e-6\n# yPosition: 2e-6\n",
                    "# xPosition: 3e-6\n# yPosition: 2e-6\n",
                ],
                true,
            ),
            (["x = 1 um, y = 2 um\n", "\nx = 3 um, y = 2 um\n"], true),
            (["X, um: 1\nY, um: 2\n", "X, um: 3\nY, um: 2\n"], true),
            (
                [
                    "X [nm]\t1000\tY [nm]\t2000\n",
                    "X [nm]\t3000\tY [nm]\t2000\n",
                ],
                true,
            ),
            (
                [
                    "\"position x\": 1e-06,\n\"position y\": 2e-06\n",
                    "\"position x\": 3e-06,\n\"position y\": 2e-06\n",
                ],
                true,
            ),
            (["# curve 1\n", "# curve 2\n"], false),
            (["# index: 0\n", "# index: 1\n"], false),
            (["", "\n\n"], false),
        ] {
            for is_repeated in [false, true] {
                let again = if is_repeated && !between[0].is_empty() {
                    head.as_str()
                } else {
                    ""
                };
                let [first, second] = between;
                let map = format!("{head}{first}{rows}{second}{again}{rows}");
                let found = parsed(&map).unwrap_or_else(|| panic!("{second}"));
                assert_eq!(found.count(), 2, "{second}");
                let expected_places = if places {
                    [Some([1e-6, 2e-6]), Some([3e-6, 2e-6])]
                } else {
                    [None, None]
                };
                for (index, expected_place) in expected_places.into_iter().enumerate() {
                    let place = found.position(index);
                    let is_near = |one: [f64; 2], other: [f64; 2]| {
                        (one[0] - other[0]).abs() + (one[1] - other[1]).abs() < 1e-15
                    };
                    assert!(
                        place == expected_place || is_near(place.unwrap(), expected_place.unwrap()),
                        "{second}: {place:?}"
                    );
                    let text = found.text(index);
                    let curve =
                        MeasuredCurve::parse(Path::new("map"), text.as_bytes(), &options).unwrap();
                    assert_same(&curve, &expected, second);
                }
            }
        }
        let jpk = format!("# xPosition: 1e-6\n# yPosition: 2e-6\n{single}");
        assert_eq!(position_in(jpk.as_bytes()), Ok(Some([1e-6, 2e-6])));
        assert_eq!(position_in(single.as_bytes()), Ok(None));
    }

    /// An error in the second curve names the line of the whole text.
    #[test]
    fn lines_keep_their_numbers() {
        let map = format!(
            "{}# curve 1\n{}# curve 2\n{}1,2,3\n",
            head(),
            rows(),
            rows()
        );
        let found = parsed(&map).unwrap();
        let error = read::parse(
            Path::new("map.txt"),
            (found.text_with_line_numbers(1) + "1,2,3\n").as_bytes(),
            &CurveOptions::default(),
        );
        let error = error.unwrap_err().to_string();
        assert!(error.starts_with("line 1204: 3 columns"), "{error}");
    }

    /// Segments of one curve are not several curves: an approach and a retraction between empty
    /// lines, segments with names, and a header that repeats the place.
    #[test]
    fn segments_of_one_curve_are_not_several() {
        let (head, rows) = (head(), rows());
        let all: Vec<&str> = rows.lines().collect();
        let [approach, retraction] = [&all[..300], &all[300..]].map(|part| part.join("\n") + "\n");
        let place = "# xPosition: 1e-6\n# yPosition: 2e-6\n";
        for text in [
            format!("{head}{rows}"),
            format!("{head}{approach}\n{retraction}"),
            format!("# segment: extend\n{head}{rows}\n# segment: extend\n{head}{rows}"),
            format!("{place}{head}{approach}\n{place}{retraction}"),
            format!("{head}# xPosition: ----\n{rows}"),
            "1 2\n3 4\n\n5 6\n".to_owned(),
            String::new(),
        ] {
            assert!(parsed(&text).is_none(), "{}", &text[..text.len().min(60)]);
        }
    }
}
