//! Columns of a measured curve in SI units, read from text, CSV or a NumPy array.

pub(crate) mod columns;
pub(crate) mod foreign;
pub(crate) mod metadata;
pub(crate) mod names;
pub(crate) mod options;
pub(crate) mod text;

use crate::error::ExperimentError;
use crate::read::columns::{Choice, Pair, Stated};
use crate::read::foreign::check_is_text;
use crate::read::metadata::Metadata;
use crate::read::names::{is_pause, names_segment};
use crate::read::options::CurveOptions;
use crate::read::text::{Above, Shape, beginning, is_comment, segment_of};
use asperity_data::text_table::{Decimal, ONE_MARK, TextCell, TextColumn, each_line};
use asperity_data::{PROVENANCE, grouped, npy, shown};
use asperity_surface::files::{columns as npy_columns, refused, unpacked};
use asperity_surface::{Place, SurfaceError};
use std::borrow::Cow;
use std::path::Path;

/// Largest magnitude of a displacement in m, and of a force in N, that a file may contain.
const LARGEST: [f64; 2] = [1e3, 1e6];
/// Distance from the central nine tenths of the displacements, in units of their range, beyond
/// which a few displacements are errors of the file.
const WILD: f64 = 10.0;

/// Label of the points in a part of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Label {
    /// Number of the part. Another name begins another part.
    pub part: usize,
    /// True if the name of the part means a pause.
    pub is_pause: bool,
}

impl Label {
    /// Makes the label of an approach or a retraction.
    pub fn of_part(part: usize) -> Label {
        Label {
            part,
            is_pause: false,
        }
    }
}

/// Columns of a file in SI units, without the points at which a value is missing.
#[derive(Debug, Default)]
pub(crate) struct Columns {
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
    /// Label of the segment of each point; empty if the file names none.
    pub labels: Vec<Label>,
    /// True if the approach and the retraction have their own columns.
    pub is_beside: bool,
    /// Number of points left out because a value is missing.
    pub missing: usize,
    /// Stiffness of the instrument in N/m as the file states it, with its name in the file.
    pub stiffness: Option<(String, f64)>,
    /// Name of the column of the displacement, if the column excludes the deflection of the
    /// instrument.
    pub of_body: Option<String>,
    /// Columns and their units in words.
    pub assumed: String,
    /// Sentences on names and units of the file that the options replace.
    pub statements: Vec<String>,
    /// Number of points left out because they repeat the point before, and the place of the first
    /// of them.
    repeated: usize,
    first_repeated: Option<Place>,
    /// Number of the line or of the point in the file, for each point.
    places: Vec<usize>,
}

impl Columns {
    /// Reads the content of a file, which may be compressed by gzip. The name identifies binary
    /// formats, which are refused.
    pub fn parse(
        name: &Path,
        bytes: &[u8],
        options: &CurveOptions,
    ) -> Result<Self, ExperimentError> {
        let bytes = unpacked(bytes)?;
        let is_array = bytes.starts_with(npy::SIGNATURE);
        if !is_array {
            check_is_text(name, &bytes)?;
        }
        let parts = if is_array {
            of_array(&bytes, options)?
        } else {
            of_text(&bytes, options)?
        };
        let columns = Columns::joined(parts);
        let place = if is_array { Place::Point } else { Place::Line };
        columns.check_displacements(place)?;
        Ok(columns)
    }

    /// Takes displacements in m and forces in N. A point with a value that is not finite is left
    /// out.
    pub fn of_arrays(displacement: &[f64], force: &[f64]) -> Result<Self, ExperimentError> {
        if displacement.len() != force.len() {
            let found = format!(
                "{} displacements and {} forces",
                displacement.len(),
                force.len()
            );
            return crate::error::refused(found, "one force for each displacement");
        }
        let mut columns = Columns {
            assumed: "displacements in m, forces in N".to_owned(),
            ..Columns::default()
        };
        let pair = Pair {
            places: [0, 1],
            units: [1.0; 2],
        };
        for (index, (displacement, force)) in displacement.iter().zip(force).enumerate() {
            columns.push([*displacement, *force], &pair, Place::Point(index + 1))?;
        }
        columns.check_displacements(Place::Point)?;
        Ok(columns)
    }

    /// Returns the numbers of points left out, in words; empty if there are none.
    pub fn left_out(&self) -> Vec<String> {
        let count = |count: usize| grouped(count as u64);
        let mut words = Vec::new();
        if self.missing > 0 {
            words.push(format!(
                "{} left out since a value is missing",
                count(self.missing)
            ));
        }
        if let Some(place) = &self.first_repeated {
            let place = place.to_string();
            let place = place.trim_end_matches([':', ' ']);
            words.push(format!(
                "{} left out since they repeat the point before, first {place}",
                count(self.repeated)
            ));
        }
        words
    }

    /// Joins an approach with the retraction beside it. The retraction begins at its end that is
    /// nearer to the end of the approach.
    fn joined(parts: Vec<Columns>) -> Columns {
        let mut parts = parts.into_iter();
        let mut joined = parts.next().unwrap_or_default();
        for mut part in parts {
            let turn = joined.displacement.last().copied();
            let ends = part
                .displacement
                .first()
                .copied()
                .zip(part.displacement.last().copied());
            if let Some((turn, (first, last))) = turn.zip(ends)
                && (last - turn).abs() < (first - turn).abs()
            {
                part.displacement.reverse();
                part.force.reverse();
                part.places.reverse();
            }
            joined.labels = vec![Label::of_part(0); joined.displacement.len()];
            joined
                .labels
                .extend(vec![Label::of_part(1); part.displacement.len()]);
            joined.displacement.extend(part.displacement);
            joined.force.extend(part.force);
            joined.places.extend(part.places);
            joined.missing += part.missing;
            joined.repeated += part.repeated;
            joined.first_repeated = joined.first_repeated.or(part.first_repeated);
            joined.is_beside = true;
        }
        joined
    }

    /// Adds a point with these values of displacement and force in the units of the file. A point
    /// with a missing value, or equal to the point before, is not added. Returns true if the point
    /// was added.
    fn push(&mut self, values: [f64; 2], pair: &Pair, place: Place) -> Result<bool, SurfaceError> {
        if !values.iter().all(|value| value.is_finite()) {
            self.missing += 1;
            return Ok(false);
        }
        let [displacement, force] = [0, 1].map(|of| {
            // A division by a whole number rounds once.
            let (value, unit) = (values[of], pair.units[of]);
            let divisor = (1.0 / unit).round();
            if (divisor * unit - 1.0).abs() < 1e-12 {
                value / divisor
            } else {
                value * unit
            }
        });
        if (self.displacement.last(), self.force.last()) == (Some(&displacement), Some(&force)) {
            self.repeated += 1;
            self.first_repeated.get_or_insert(place);
            return Ok(false);
        }
        let number = if let Place::Line(number) | Place::Point(number) = place {
            number
        } else {
            0
        };
        for (value, largest, (term, unit)) in [
            (displacement, LARGEST[0], ("displacement", "m")),
            (force, LARGEST[1], ("force", "N")),
        ] {
            if !(-largest..=largest).contains(&value) {
                let fault = format!("a {term} of {value:e} {unit}");
                return Err(refused(
                    place,
                    fault,
                    format!("at most {largest:e} {unit} either way"),
                ));
            }
        }
        self.displacement.push(displacement);
        self.force.push(force);
        self.places.push(number);
        Ok(true)
    }

    /// Returns an error if a few displacements are far from all others. Such errors of a file would
    /// determine the range.
    fn check_displacements(&self, place: fn(usize) -> Place) -> Result<(), SurfaceError> {
        let mut sorted = self.displacement.clone();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        let [Some(&low), Some(&high)] = [
            sorted.get(count / 20),
            sorted.get((count - count / 20).max(1) - 1),
        ] else {
            return Ok(());
        };
        let room = WILD * (high - low);
        let is_wild = |at: &f64| *at < low - room || *at > high + room;
        let wild = sorted.iter().filter(|at| is_wild(at)).count();
        if room > 0.0
            && (1..=(count / 50).max(1)).contains(&wild)
            && let Some(first) = self.displacement.iter().position(&is_wild)
        {
            sorted.retain(|at| !is_wild(at));
            let (low, high) = (sorted[0], sorted[sorted.len() - 1]);
            return Err(refused(
                place(self.places[first]),
                format!(
                    "a displacement of {:e} m far from all others",
                    self.displacement[first]
                ),
                format!("near those from {low:e} m to {high:e} m; NaN leaves a point out"),
            ));
        }
        Ok(())
    }
}

/// Points of a file that are collected from its chosen columns.
struct Points {
    choice: Choice,
    /// One set of columns, or two: one for an approach, one for the retraction beside it.
    parts: Vec<Columns>,
    label: Label,
    /// Name of the present segment; empty before the first one.
    name: String,
    /// Number of rows so far.
    rows: usize,
}

impl Points {
    fn new(
        columns: &[TextColumn],
        stated: Stated<'_>,
        options: &CurveOptions,
    ) -> Result<Self, SurfaceError> {
        let mut choice = Choice::new(columns, stated, options)?;
        let mut parts: Vec<_> = choice.pairs.iter().map(|_| Columns::default()).collect();
        parts[0].statements = std::mem::take(&mut choice.statements);
        parts[0].assumed = std::mem::take(&mut choice.assumed);
        parts[0].of_body = choice.of_body.take();
        parts[0].stiffness.clone_from(&stated.metadata.stiffness);
        Ok(Points {
            choice,
            parts,
            label: Label::default(),
            name: String::new(),
            rows: 0,
        })
    }

    /// Begins another segment if the name differs from the present one.
    fn begin_segment(&mut self, name: &str) {
        if self.name != name {
            self.label = Label {
                part: self.label.part + 1,
                is_pause: is_pause(name),
            };
            name.clone_into(&mut self.name);
        }
    }

    /// Adds the point at a place of the file. `value` returns the number in a column, NaN if it is
    /// missing, and `text` returns its text.
    fn take<'a>(
        &mut self,
        place: &Place,
        mut value: impl FnMut(usize) -> Result<f64, SurfaceError>,
        text: impl Fn(usize) -> Cow<'a, str>,
    ) -> Result<(), SurfaceError> {
        if let Some(column) = self.choice.segment {
            self.begin_segment(&text(column));
        }
        let (is_beside, is_labelled) = (self.parts.len() > 1, !self.name.is_empty());
        for (part, pair) in self.parts.iter_mut().zip(&self.choice.pairs) {
            let force = value(pair.places[1])?;
            // Without a column of displacements the rows count.
            let displacement = match self.choice.ramp {
                Some(_) => self.rows as f64,
                None => value(pair.places[0])?,
            };
            let values = [displacement, force];
            // One of two segments side by side may be longer.
            if is_beside && pair.places.iter().all(|place| text(*place).is_empty()) {
                continue;
            }
            if part.push(values, pair, place.clone())? && is_labelled {
                part.labels.push(self.label);
            }
        }
        self.rows += 1;
        Ok(())
    }

    /// Returns the points. Forces without a displacement get displacements that are evenly spaced
    /// over the travel of the piezo, there and back.
    fn finished(mut self) -> Vec<Columns> {
        if let (Some(ramp), Some(all)) = (self.choice.ramp, self.parts.first_mut()) {
            let half = 0.5 * self.rows as f64;
            let unit = self.choice.pairs[0].units[0];
            let row = |at: &f64| (at / unit).round();
            all.labels = all
                .displacement
                .iter()
                .map(|at| Label::of_part(usize::from(row(at) >= half)))
                .collect();
            all.displacement.iter_mut().for_each(|at| {
                let row = row(at);
                *at =
                    ramp * if row < half {
                        row
                    } else {
                        2.0 * half - 1.0 - row
                    } / (half - 1.0);
            });
            all.is_beside = true;
        }
        self.parts
    }
}

fn of_array(bytes: &[u8], options: &CurveOptions) -> Result<Vec<Columns>, SurfaceError> {
    let (names, values) = npy_columns(bytes)?;
    // A force curve or a fit of this program, in SI units.
    let is_si = names
        .iter()
        .any(|name| ["contact_length", "residual"].contains(&name.as_str()));
    let mut columns = vec![TextColumn::default(); values.len()];
    columns
        .iter_mut()
        .zip(names)
        .for_each(|(column, name)| column.name = name);
    let mut points = Points::new(
        &columns,
        Stated {
            metadata: &Metadata::default(),
            is_si,
        },
        options,
    )?;
    (0..values.first().map_or(0, Vec::len)).try_for_each(|point| {
        let value = |column: usize| values[column][point];
        let text = |column: usize| value(column).to_string().into();
        points.take(&Place::Point(point + 1), |column| Ok(value(column)), text)
    })?;
    Ok(points.parts)
}

fn of_text(bytes: &[u8], options: &CurveOptions) -> Result<Vec<Columns>, SurfaceError> {
    let Some((first, shape)) = beginning(bytes)? else {
        return Ok(Vec::new());
    };
    let (mut above, mut points, mut decimal) =
        (Above::default(), None::<Points>, Decimal::default());
    // Name of a segment above its points.
    let mut name = String::new();
    each_line(bytes, |number, line| {
        let place = Place::Line(number);
        if let Some(segment) = segment_of(line).filter(|_| is_comment(line)) {
            segment.clone_into(&mut name);
        }
        if number < first {
            above.take(line, &shape);
        }
        if number < first || line.is_empty() || is_comment(line) {
            return Ok(());
        }
        let points = match &mut points {
            Some(points) => points,
            none => {
                let is_si = bytes.starts_with(PROVENANCE.as_bytes()) || above.is_of_afmformats();
                let stated = Stated {
                    metadata: &above.metadata,
                    is_si,
                };
                none.insert(Points::new(&above.columns(&shape), stated, options)?)
            }
        };
        let cells: Vec<&str> = shape.separator.split(line).collect();
        let is_word = |cell: &&str| {
            matches!(
                Decimal::default().read(cell, shape.separator),
                TextCell::NoNumber
            )
        };
        if cells.len() != shape.count || cells.iter().all(is_word) {
            if cells.iter().all(is_word) && names_segment(line) {
                line.clone_into(&mut name);
                return Ok(());
            }
            if cells.len() != shape.count {
                let allowed = format!("{}, as in the first line of numbers", shape.count);
                return Err(refused(place, format!("{} columns", cells.len()), allowed));
            }
        }
        if !name.is_empty() && points.choice.segment.is_none() {
            points.begin_segment(&name);
        }
        let value = |column: usize| number_in(cells[column], column, &shape, &mut decimal, &place);
        points.take(&place, value, |column| cells[column].into())
    })?;
    decimal.check()?;
    let mut parts = points.map_or_else(Vec::new, Points::finished);
    if let Some(first) = parts.first_mut().filter(|_| above.has_merged()) {
        first.missing += 1;
    }
    Ok(parts)
}

/// Returns the number in a column; NaN if it is missing.
fn number_in(
    cell: &str,
    column: usize,
    shape: &Shape,
    decimal: &mut Decimal,
    place: &Place,
) -> Result<f64, SurfaceError> {
    let (fault, allowed) = match decimal.read(cell, shape.separator) {
        // A number of hundreds of digits is not the word for infinity, which marks a missing value.
        TextCell::Number(value)
            if value.is_infinite() && cell.contains(|c: char| c.is_ascii_digit()) =>
        {
            (
                "beyond all numbers",
                "displacements and forces, NaN for a missing value",
            )
        }
        TextCell::Number(value) => return Ok(value),
        TextCell::Missing => return Ok(f64::NAN),
        TextCell::OtherMark => (
            "a number with another decimal mark than the numbers before",
            ONE_MARK,
        ),
        TextCell::NoNumber => (
            "not a number",
            "numbers of one decimal mark, NaN for a missing value",
        ),
    };
    Err(refused(
        place.clone(),
        format!("column {}: {:?} is {fault}", column + 1, shown(cell)),
        allowed,
    ))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::common::{from_bytes, from_text, lines, of_spring, text_of_spring};
    use crate::curve::MeasuredCurve;

    /// Asserts that two curves have the same points, segments and part before contact.
    pub(crate) fn assert_same(found: &MeasuredCurve, expected: &MeasuredCurve, name: &str) {
        let both = found
            .force
            .iter()
            .zip(&expected.force)
            .chain(found.displacement.iter().zip(&expected.displacement));
        assert!(
            both.into_iter()
                .all(|(one, other)| (one - other).abs() < 1e-20),
            "{name}"
        );
        assert_eq!(
            (found.free, &found.segment),
            (expected.free, &expected.segment),
            "{name}"
        );
    }

    fn columns(names: &[&str]) -> CurveOptions {
        CurveOptions {
            columns: names.iter().map(ToString::to_string).collect(),
            ..CurveOptions::default()
        }
    }

    /// Lines of the spring with this header, each point in this form.
    fn text(header: &str, form: impl Fn(f64, f64) -> String) -> String {
        text_of_spring(header, 600, form)
    }

    fn spring() -> MeasuredCurve {
        from_text(&lines(of_spring(600)), &CurveOptions::default()).unwrap()
    }

    #[test]
    fn a_curve_is_the_same_in_every_form() {
        let units = |columns: CurveOptions| CurveOptions {
            units: vec!["nm".into(), "nN".into()],
            ..columns
        };
        let plain = CurveOptions::default;
        let expected = spring();
        // Both points at the turn have one displacement.
        assert_eq!(
            (
                expected.segment[298],
                expected.segment[301],
                expected.segment[599]
            ),
            (0, 1, 1)
        );
        assert!((190..=200).contains(&expected.free), "{}", expected.free);
        assert!(
            (expected.noise / 1e-10 - 1.0).abs() < 0.02,
            "{:e}",
            expected.noise
        );
        assert!(
            (expected.force[300] / 1e-7 - 1.0).abs() < 0.01,
            "{:e}",
            expected.force[300]
        );
        assert_eq!(expected.turns.len(), 2);
        // Thousands of pN, separated by this mark.
        let thousands = |force: f64, mark: &str| {
            let text = format!("{:.9}", 1e3 * force);
            let at = text.find('.').unwrap_or(text.len()).saturating_sub(3);
            if at == 0 {
                text
            } else {
                format!("{}{mark}{}", &text[..at], &text[at..])
            }
        };
        for (content, options) in [
            (
                text("d [nm];f [pN]\n", |d, f| {
                    format!("{d};{}", thousands(f, ","))
                }),
                plain(),
            ),
            (
                text("d [nm]\tf [pN]\n", |d, f| {
                    format!("{d}\t{}", thousands(f, " "))
                }),
                plain(),
            ),
            (
                text("x/nm;F/nN\n", |d, f| format!("{d};{f}")),
                columns(&["x", "f"]),
            ),
            (
                text(
                    "# columns: time height force\n# units: s nm nN\n",
                    |d, f| format!("0 {d} {f}"),
                ),
                plain(),
            ),
            (text("", |d, f| format!("{d}\t{f}")), units(plain())),
            (text("nm,nN\n", |d, f| format!("{d},{f}")), plain()),
            (
                text("a (nm)\tb (nN)\n", |d, f| {
                    format!("{d}\t{f}").replace('.', ",")
                }),
                columns(&["1", "2"]),
            ),
            (
                text("separation [um],force [N]\n", |d, f| {
                    format!("{},{}", -d / 1e3, f / 1e9)
                }),
                columns(&["1", "2"]),
            ),
            (
                text("z [nm],deflection [nm]\n", |d, f| {
                    format!("{d},{}", f / 4.0)
                }),
                CurveOptions {
                    units: vec!["nm".into(), "4nN".into()],
                    ..columns(&["1", "2"])
                },
            ),
        ] {
            assert_same(
                &from_text(&content, &options).unwrap(),
                &expected,
                &content[..20],
            );
        }
        let all = of_spring(600);
        let array = |descr: &str,
                     shape: &str,
                     values: &mut dyn Iterator<Item = f64>,
                     options: CurveOptions| {
            let mut bytes = Vec::new();
            npy::write_header(&mut bytes, descr, shape).unwrap();
            bytes.extend(values.flat_map(f64::to_le_bytes));
            assert_same(
                &from_bytes(&bytes, &units(options)).unwrap(),
                &expected,
                shape,
            );
        };
        array(
            "'<f8'",
            "600, 2",
            &mut all.iter().flat_map(|&(d, f)| [d, f]),
            columns(&["1", "2"]),
        );
        // Any number that changes with the segment.
        let labelled = all
            .iter()
            .zip(&expected.segment)
            .flat_map(|(&(d, f), segment)| [d, f, 7.0 - *segment as f64]);
        array(
            "'<f8'",
            "600, 3",
            &mut labelled.into_iter(),
            columns(&["1", "2", "3"]),
        );
        let axes = all
            .iter()
            .map(|point| point.0)
            .chain(all.iter().map(|point| point.1));
        array(
            "'<f8'",
            "2, 600",
            &mut axes.into_iter(),
            columns(&["1", "2"]),
        );
        let fields = "[('load', '<f8'), ('height', '<f8')]";
        array(
            fields,
            "600,",
            &mut all.iter().flat_map(|&(d, f)| [f, d]),
            plain(),
        );
    }

    #[test]
    fn units_of_the_command_line_overrule_those_of_the_file() {
        // A divisor that is a whole number, and a factor.
        for unit in [4.0, 3.0] {
            let text = text("Piezo [nm],Deflection [nm]\n", |d, f| {
                format!("{},{}", d / 1e3, f / unit)
            });
            let units = vec!["um".to_owned(), format!("{unit}nN")];
            let curve = from_text(
                &text,
                &CurveOptions {
                    units,
                    ..CurveOptions::default()
                },
            )
            .unwrap();
            let (turn, force) = (curve.turns[0], curve.force[300]);
            assert!(
                (turn / 5e-8 - 1.0).abs() < 0.01 && (force / 1e-7 - 1.0).abs() < 0.01,
                "{turn:e} {force:e}"
            );
            let of_force = format!("Unit of the force by --units: {unit}nN; the file states nm.");
            assert_eq!(
                curve.statements[1],
                "Unit of the displacement by --units: um; the file states nm."
            );
            assert_eq!(curve.statements[2], of_force);
        }
    }

    #[test]
    fn files_that_hold_no_curve_are_refused_with_their_place() {
        let comma = |d: f64, f: f64| format!("{d},{f}");
        let more = |line: &str| (lines(of_spring(600)) + line, columns(&[]));
        for ((text, options), said) in [
            (
                more("1e11,0\n"),
                "line 602: a displacement of 1e2 m far from all others",
            ),
            (more("0,1e299\n"), "line 602: a force of 1e290 N"),
            (
                more(&("9".repeat(400) + ",0\n")),
                "line 602: column 1: \"999",
            ),
            (more("1,2,3\n"), "line 602: 3 columns; allowed: 2"),
            (more("1,2x\n"), "line 602: column 2: \"2x\" is not a number"),
            (
                (text("d,f\n", comma), columns(&[])),
                "no unit of the displacement is stated",
            ),
            (
                (text("d [nm],f [V]\n", comma), columns(&[])),
                "the force is a deflection in V, and the file",
            ),
            (
                (text("a [nm],b [nN]\n", comma), columns(&[])),
                "2 columns a, b: none is known as the displacement",
            ),
            (
                (text("f [nN]\n", |_, f| f.to_string()), columns(&[])),
                "one column of numbers; allowed: a column of",
            ),
            (
                (text("d [nm],Deflection [nm]\n", comma), columns(&[])),
                "the force is a deflection in nm, and the file",
            ),
            (
                (lines(of_spring(600)), columns(&["1", "5"])),
                "2 columns displacement, force: none is \"5\"",
            ),
            (
                (
                    text("d [nm];f [pN]\n", |d, f| format!("{d:.0};{:.0}", 1e3 * f)) + "5;1,234\n",
                    columns(&[]),
                ),
                "each comma in a number may be a decimal mark or separate thousands",
            ),
            (
                (text("", |d, f| format!("{d}\t{f}\t{f}")), columns(&[])),
                "3 columns without names: none is",
            ),
        ] {
            let error = from_text(&text, &options).expect_err(said);
            assert!(
                error.starts_with(said) && error.contains("allowed: "),
                "{said}: {error}"
            );
            // A file without names and units needs both options.
            assert!(
                error.contains("; with it --units") == error.contains("without names"),
                "{error}"
            );
        }
    }
}
