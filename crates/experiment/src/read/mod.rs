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
use crate::read::names::{DISPLACEMENT, FORCE, QUANTITIES, is_pause, names_segment};
use crate::read::options::CurveOptions;
use crate::read::text::{Above, Beginning, Shape, beginning, is_comment, segment_of};
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
    /// Number of points left out because they repeat the point before.
    repeated: usize,
    /// Place of the first repeated point.
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
        if bytes.starts_with(npy::SIGNATURE) {
            let columns = Columns::joined(of_array(&bytes, options)?);
            columns.check_displacements(Place::Point)?;
            return Ok(columns);
        }
        check_is_text(name, &bytes)?;
        let columns = Columns::joined(of_text(&bytes, options)?);
        columns.check_displacements(Place::Line)?;
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
        let mut sentences = Vec::new();
        if self.missing > 0 {
            let count = grouped(self.missing as u64);
            sentences.push(format!("{count} left out since a value is missing"));
        }
        if let Some(place) = &self.first_repeated {
            let count = grouped(self.repeated as u64);
            let place = place.to_string();
            let place = place.trim_end_matches([':', ' ']);
            sentences.push(format!(
                "{count} left out since they repeat the point before, first {place}"
            ));
        }
        sentences
    }

    /// Joins an approach with the retraction beside it.
    fn joined(parts: Vec<Columns>) -> Columns {
        let mut parts = parts.into_iter();
        let mut joined = parts.next().unwrap_or_default();
        for part in parts {
            joined.append_retraction(part);
        }
        joined
    }

    /// Adds the retraction to an approach. It begins at its end that is nearer to the end of the
    /// approach.
    fn append_retraction(&mut self, mut retraction: Columns) {
        if let Some(turn) = self.displacement.last()
            && let Some(first) = retraction.displacement.first()
            && let Some(last) = retraction.displacement.last()
            && (last - turn).abs() < (first - turn).abs()
        {
            retraction.displacement.reverse();
            retraction.force.reverse();
            retraction.places.reverse();
        }
        self.labels = vec![Label::of_part(0); self.displacement.len()];
        let labels = vec![Label::of_part(1); retraction.displacement.len()];
        self.labels.extend(labels);
        self.displacement.extend(retraction.displacement);
        self.force.extend(retraction.force);
        self.places.extend(retraction.places);
        self.missing += retraction.missing;
        self.repeated += retraction.repeated;
        self.first_repeated = self.first_repeated.take().or(retraction.first_repeated);
        self.is_beside = true;
    }

    /// Adds a point with these values of displacement and force in the units of the file. A point
    /// with a missing value, or equal to the point before, is not added. Returns true if the point
    /// was added.
    fn push(&mut self, values: [f64; 2], pair: &Pair, place: Place) -> Result<bool, SurfaceError> {
        if !values.iter().all(|value| value.is_finite()) {
            self.missing += 1;
            return Ok(false);
        }
        let displacement = in_si(values[DISPLACEMENT], pair.units[DISPLACEMENT]);
        let force = in_si(values[FORCE], pair.units[FORCE]);
        if self.displacement.last() == Some(&displacement) && self.force.last() == Some(&force) {
            self.repeated += 1;
            self.first_repeated.get_or_insert(place);
            return Ok(false);
        }
        check_magnitude(displacement, DISPLACEMENT, &place)?;
        check_magnitude(force, FORCE, &place)?;
        self.displacement.push(displacement);
        self.force.push(force);
        self.places.push(match place {
            Place::Line(number) | Place::Point(number) => number,
            _ => 0,
        });
        Ok(true)
    }

    /// Returns an error if a few displacements are far from all others. Such errors of a file would
    /// determine the range. `place` makes the place in the file of a line or point with a number.
    fn check_displacements(&self, place: fn(usize) -> Place) -> Result<(), SurfaceError> {
        let mut sorted = self.displacement.clone();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        let twentieth = count / 20;
        let (Some(&low), Some(&high)) = (
            sorted.get(twentieth),
            sorted.get((count - twentieth).max(1) - 1),
        ) else {
            return Ok(());
        };
        let room = WILD * (high - low);
        let is_wild =
            |displacement: &f64| *displacement < low - room || *displacement > high + room;
        let Some(first_wild) = self.displacement.iter().position(is_wild) else {
            return Ok(());
        };
        sorted.retain(|displacement| !is_wild(displacement));
        let wild_count = count - sorted.len();
        if room <= 0.0 || wild_count > (count / 50).max(1) {
            return Ok(());
        }
        let found = format!(
            "a displacement of {:e} m far from all others",
            self.displacement[first_wild]
        );
        let allowed = format!(
            "near those from {:e} m to {:e} m; NaN leaves a point out",
            sorted[0],
            sorted[sorted.len() - 1]
        );
        Err(refused(place(self.places[first_wild]), found, allowed))
    }
}

/// Returns a value in SI units. A division by a whole number rounds once, while the unit itself,
/// such as 1e-9, is rounded too.
fn in_si(value: f64, unit: f64) -> f64 {
    let divisor = (1.0 / unit).round();
    if (divisor * unit - 1.0).abs() < 1e-12 {
        value / divisor
    } else {
        value * unit
    }
}

/// Returns an error for a value that no instrument measures.
fn check_magnitude(value: f64, quantity: usize, place: &Place) -> Result<(), SurfaceError> {
    let largest = LARGEST[quantity];
    if (-largest..=largest).contains(&value) {
        return Ok(());
    }
    let term = QUANTITIES[quantity].term;
    let unit = QUANTITIES[quantity].si_unit;
    let found = format!("a {term} of {value:e} {unit}");
    let allowed = format!("at most {largest:e} {unit} either way");
    Err(refused(place.clone(), found, allowed))
}

/// Rows of a file, from whose chosen columns the points are collected.
struct Rows {
    choice: Choice,
    /// One set of columns, or two: one for an approach, one for the retraction beside it.
    parts: Vec<Columns>,
    label: Label,
    /// Name of the present segment; empty before the first one.
    name: String,
    /// Number of rows so far.
    count: usize,
}

impl Rows {
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
        Ok(Rows {
            choice,
            parts,
            label: Label::default(),
            name: String::new(),
            count: 0,
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

    /// Adds the points of a row. `value` returns the number in a column, NaN if it is missing, and
    /// `text` returns its text.
    fn take<'a>(
        &mut self,
        place: &Place,
        mut value: impl FnMut(usize) -> Result<f64, SurfaceError>,
        text: impl Fn(usize) -> Cow<'a, str>,
    ) -> Result<(), SurfaceError> {
        if let Some(column) = self.choice.segment {
            self.begin_segment(&text(column));
        }
        let is_beside = self.parts.len() > 1;
        let is_labelled = !self.name.is_empty();
        for (part, pair) in self.parts.iter_mut().zip(&self.choice.pairs) {
            let force = value(pair.places[FORCE])?;
            // Without a column of displacements the rows count.
            let displacement = match self.choice.ramp {
                Some(_) => self.count as f64,
                None => value(pair.places[DISPLACEMENT])?,
            };
            // One of two segments side by side may be longer.
            if is_beside && pair.places.iter().all(|place| text(*place).is_empty()) {
                continue;
            }
            let is_added = part.push([displacement, force], pair, place.clone())?;
            if is_added && is_labelled {
                part.labels.push(self.label);
            }
        }
        self.count += 1;
        Ok(())
    }

    /// Returns the columns of all rows.
    fn finished(mut self) -> Vec<Columns> {
        if let Some(ramp) = self.choice.ramp {
            self.spread_over_ramp(ramp);
        }
        self.parts
    }

    /// Gives forces without a displacement displacements that are evenly spaced over the travel of
    /// the piezo in m, there and back.
    fn spread_over_ramp(&mut self, ramp: f64) {
        let Some(columns) = self.parts.first_mut() else {
            return;
        };
        let half = 0.5 * self.count as f64;
        let unit = self.choice.pairs[0].units[DISPLACEMENT];
        columns.labels = Vec::with_capacity(columns.displacement.len());
        for displacement in &mut columns.displacement {
            let row = (*displacement / unit).round();
            let is_retraction = row >= half;
            let steps = if is_retraction {
                2.0 * half - 1.0 - row
            } else {
                row
            };
            *displacement = ramp * steps / (half - 1.0);
            columns
                .labels
                .push(Label::of_part(usize::from(is_retraction)));
        }
        columns.is_beside = true;
    }
}

/// Reads the content of a NumPy file.
fn of_array(bytes: &[u8], options: &CurveOptions) -> Result<Vec<Columns>, SurfaceError> {
    let (names, values) = npy_columns(bytes)?;
    // A force curve or a fit of this program, in SI units.
    let is_si = names
        .iter()
        .any(|name| name == "contact_length" || name == "residual");
    let mut columns = vec![TextColumn::default(); values.len()];
    for (column, name) in columns.iter_mut().zip(names) {
        column.name = name;
    }
    let stated = Stated {
        metadata: &Metadata::default(),
        is_si,
    };
    let mut rows = Rows::new(&columns, stated, options)?;
    let count = values.first().map_or(0, Vec::len);
    for number in 1..=count {
        let value = |column: usize| values[column][number - 1];
        rows.take(
            &Place::Point(number),
            |column| Ok(value(column)),
            |column| value(column).to_string().into(),
        )?;
    }
    Ok(rows.parts)
}

/// Reads the content of a text file.
fn of_text(bytes: &[u8], options: &CurveOptions) -> Result<Vec<Columns>, SurfaceError> {
    let Some(beginning) = beginning(bytes)? else {
        return Ok(Vec::new());
    };
    let mut reader = TextReader {
        options,
        is_of_program: bytes.starts_with(PROVENANCE.as_bytes()),
        beginning,
        above: Above::default(),
        rows: None,
        decimal: Decimal::default(),
        name: String::new(),
    };
    each_line(bytes, |number, line| reader.take(number, line))?;
    reader.decimal.check()?;
    let mut parts = reader.rows.map_or_else(Vec::new, Rows::finished);
    if reader.above.has_merged()
        && let Some(first) = parts.first_mut()
    {
        first.missing += 1;
    }
    Ok(parts)
}

/// Reader of the lines of a text.
struct TextReader<'a> {
    options: &'a CurveOptions,
    /// True for a table of this program, in SI units.
    is_of_program: bool,
    beginning: Beginning,
    above: Above,
    /// Rows so far; `None` before the first one.
    rows: Option<Rows>,
    decimal: Decimal,
    /// Name of a segment above its points.
    name: String,
}

impl TextReader<'_> {
    /// Reads the line with a number from 1.
    fn take(&mut self, number: usize, line: &str) -> Result<(), SurfaceError> {
        if is_comment(line)
            && let Some(segment) = segment_of(line)
        {
            segment.clone_into(&mut self.name);
        }
        if number < self.beginning.line {
            self.above.take(line, &self.beginning.shape);
            return Ok(());
        }
        if line.is_empty() || is_comment(line) {
            return Ok(());
        }
        self.take_row(Place::Line(number), line)
    }

    /// Reads a line of numbers, or of the name of a segment between numbers.
    fn take_row(&mut self, place: Place, line: &str) -> Result<(), SurfaceError> {
        let mut rows = match self.rows.take() {
            Some(rows) => rows,
            None => self.first_rows()?,
        };
        let shape = &self.beginning.shape;
        let cells: Vec<&str> = shape.separator.split(line).collect();
        if cells.iter().all(|cell| shape.is_word(cell)) && names_segment(line) {
            line.clone_into(&mut self.name);
            self.rows = Some(rows);
            return Ok(());
        }
        if cells.len() != shape.count {
            let found = format!("{} columns", cells.len());
            let allowed = format!("{}, as in the first line of numbers", shape.count);
            return Err(refused(place, found, allowed));
        }
        if !self.name.is_empty() && rows.choice.segment.is_none() {
            rows.begin_segment(&self.name);
        }
        let decimal = &mut self.decimal;
        rows.take(
            &place,
            |column| number_in(cells[column], column, shape, decimal, &place),
            |column| cells[column].into(),
        )?;
        self.rows = Some(rows);
        Ok(())
    }

    /// Chooses the columns by the lines above the first row.
    fn first_rows(&self) -> Result<Rows, SurfaceError> {
        let stated = Stated {
            metadata: &self.above.metadata,
            is_si: self.is_of_program || self.above.is_of_afmformats(),
        };
        let columns = self.above.columns(&self.beginning.shape);
        Rows::new(&columns, stated, self.options)
    }
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
    let found = format!("column {}: {:?} is {fault}", column + 1, shown(cell));
    Err(refused(place.clone(), found, allowed))
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
