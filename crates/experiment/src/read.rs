//! Columns of a measured curve in SI units, read from text, CSV or a NumPy array.

use crate::baseline::ends;
use crate::columns::{Choice, Pair, is_unit};
use crate::error::ExperimentError;
use crate::options::CurveOptions;
use asperity_data::{PROVENANCE, npy};
use asperity_surface::{Cell, Column, Decimal, Header, Separator, each_line};
use asperity_surface::{Place, TopographyError, columns as npy_columns, content, refused, shown, unpacked};
use std::borrow::Cow;
use std::path::Path;

/// Largest allowed displacement, m, and force, N, in magnitude.
const LARGEST: [f64; 2] = [1e3, 1e6];
/// Distance from the central nine tenths of the displacements, in units of their range, beyond which a few displacements
/// are mistakes.
const WILD: f64 = 10.0;

/// Header line of tables that PyJibe and afmformats write, whose columns are in SI units.
const OF_AFMFORMATS: &str = "END METADATA";

/// Columns of a file in SI units, without points that lack a value.
#[derive(Debug, Default)]
pub(crate) struct Columns {
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
    /// Index of the segment of each point, as labelled in the file; empty without such a column.
    pub segment: Vec<usize>,
    /// Number of points left out since a value is missing.
    pub missing: usize,
    /// Sentences on the choice of columns and units.
    pub statements: Vec<String>,
    /// Line number, or number of the point, of each point.
    places: Vec<usize>,
}

impl Columns {
    pub fn read(path: &Path, options: &CurveOptions) -> Result<Self, ExperimentError> {
        let bytes = content(path)?;
        let bytes = unpacked(&bytes)?;
        let is_array = bytes.starts_with(npy::SIGNATURE);
        let parts = if is_array { of_array(&bytes, options)? } else { of_text(&bytes, options)? };
        let columns = Columns::joined(parts);
        let place = if is_array { Place::Point } else { Place::Line };
        columns.check_displacements(place)?;
        Ok(columns)
    }

    /// Joins an approach with the retraction beside it, which begins at its end nearer to the end of the approach.
    fn joined(parts: Vec<Columns>) -> Columns {
        let has_two = parts.len() > 1;
        let mut joined = Columns::default();
        for (number, mut part) in parts.into_iter().enumerate() {
            let turn = joined.displacement.last().copied();
            let ends = part.displacement.first().copied().zip(part.displacement.last().copied());
            if let Some((turn, (first, last))) = turn.zip(ends)
                && (last - turn).abs() < (first - turn).abs()
            {
                part.displacement.reverse();
                part.force.reverse();
                part.places.reverse();
            }
            joined.segment.extend(if has_two { vec![number; part.displacement.len()] } else { part.segment });
            joined.displacement.extend(part.displacement);
            joined.force.extend(part.force);
            joined.places.extend(part.places);
            joined.statements.extend(part.statements);
            joined.missing += part.missing;
        }
        joined
    }

    /// Adds a point with these values of displacement and force in the units of the file, unless a value is missing.
    fn push(&mut self, values: [f64; 2], pair: &Pair, place: Place) -> Result<(), TopographyError> {
        if !values.iter().all(|value| value.is_finite()) {
            self.missing += 1;
            return Ok(());
        }
        let [displacement, force] = [0, 1].map(|of| {
            // A division by a whole number rounds once.
            let (value, unit) = (values[of], pair.units[of]);
            let divisor = (1.0 / unit).round();
            if (divisor * unit - 1.0).abs() < 1e-12 { value / divisor } else { value * unit }
        });
        let number = if let Place::Line(number) | Place::Point(number) = place { number } else { 0 };
        for (value, largest, (term, unit)) in
            [(displacement, LARGEST[0], ("displacement", "m")), (force, LARGEST[1], ("force", "N"))]
        {
            if !(-largest..=largest).contains(&value) {
                let fault = format!("a {term} of {value:e} {unit}");
                return Err(refused(place, fault, format!("at most {largest:e} {unit} either way")));
            }
        }
        self.displacement.push(displacement);
        self.force.push(force);
        self.places.push(number);
        Ok(())
    }

    /// Returns an error for a few displacements far from all others: mistakes in a file that would determine the range.
    fn check_displacements(&self, place: fn(usize) -> Place) -> Result<(), TopographyError> {
        let mut sorted = self.displacement.clone();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        let [Some(&low), Some(&high)] = [sorted.get(count / 20), sorted.get((count - count / 20).max(1) - 1)]
        else {
            return Ok(());
        };
        let room = WILD * (high - low);
        let is_wild = |at: &f64| *at < low - room || *at > high + room;
        let wild = sorted.iter().filter(|at| is_wild(at)).count();
        if room > 0.0
            && (1..=(count / 50).max(1)).contains(&wild)
            && let Some(first) = self.displacement.iter().position(&is_wild)
        {
            let (low, high) = ends(sorted.into_iter().filter(|at| !is_wild(at)));
            return Err(refused(
                place(self.places[first]),
                format!("a displacement of {:e} m far from all others", self.displacement[first]),
                format!("near those from {low:e} m to {high:e} m; NaN leaves a point out"),
            ));
        }
        Ok(())
    }
}

/// Collects the points of a file from its chosen columns.
struct Points {
    choice: Choice,
    /// One set of columns, or one for an approach and one for the retraction beside it.
    parts: Vec<Columns>,
    /// Index of the present segment, and the word or number that labels it in the file.
    label: (usize, String),
}

impl Points {
    fn new(columns: &[Column], is_si: bool, options: &CurveOptions) -> Result<Self, TopographyError> {
        let mut choice = Choice::new(columns, is_si, options)?;
        let mut parts: Vec<_> = choice.pairs.iter().map(|_| Columns::default()).collect();
        parts[0].statements = std::mem::take(&mut choice.statements);
        Ok(Points { choice, parts, label: (0, String::new()) })
    }

    /// Adds the point at a place of the file; `value` returns the number in a column (NaN if it is missing) and `text` its
    /// text.
    fn take<'a>(
        &mut self,
        place: &Place,
        mut value: impl FnMut(usize) -> Result<f64, TopographyError>,
        text: impl Fn(usize) -> Cow<'a, str>,
    ) -> Result<(), TopographyError> {
        let is_beside = self.parts.len() > 1;
        for (part, pair) in self.parts.iter_mut().zip(&self.choice.pairs) {
            let values = [value(pair.places[0])?, value(pair.places[1])?];
            // One of two segments side by side may be longer.
            if is_beside && pair.places.iter().all(|place| text(*place).is_empty()) {
                continue;
            }
            let found = part.displacement.len();
            part.push(values, pair, place.clone())?;
            if let Some(column) = self.choice.segment.filter(|_| part.displacement.len() > found) {
                let text = text(column);
                if self.label.1 != text {
                    self.label = (self.label.0 + 1, text.into_owned());
                }
                part.segment.push(self.label.0);
            }
        }
        Ok(())
    }
}

fn of_array(bytes: &[u8], options: &CurveOptions) -> Result<Vec<Columns>, TopographyError> {
    let (names, values) = npy_columns(bytes)?;
    // A force curve or a fit of this program, in SI units.
    let is_own = names.iter().any(|name| ["contact_length", "residual"].contains(&name.as_str()));
    let mut columns = vec![Column::default(); values.len()];
    columns.iter_mut().zip(names).for_each(|(column, name)| column.name = name);
    let mut points = Points::new(&columns, is_own, options)?;
    (0..values.first().map_or(0, Vec::len)).try_for_each(|point| {
        let value = |column: usize| values[column][point];
        let text = |column: usize| value(column).to_string().into();
        points.take(&Place::Point(point + 1), |column| Ok(value(column)), text)
    })?;
    Ok(points.parts)
}

fn of_text(bytes: &[u8], options: &CurveOptions) -> Result<Vec<Columns>, TopographyError> {
    let (mut decimal, mut form) = (Decimal::default(), None);
    let take = |header: &Header, place: Place, line: &str| {
        if form.is_none() {
            let separator = Separator::of(line);
            let count = separator.split(line).count();
            let columns = header.columns(count, count, separator, is_unit);
            let is_si = bytes.starts_with(PROVENANCE.as_bytes()) || header.has_line(OF_AFMFORMATS);
            form = Some((separator, count, Points::new(&columns, is_si, options)?));
        }
        let Some((separator, count, points)) = &mut form else { return Ok(()) };
        let cells: Vec<&str> = separator.split(line).collect();
        if cells.len() != *count {
            let allowed = format!("{count}, as in the first line of numbers");
            return Err(refused(place, format!("{} columns", cells.len()), allowed));
        }
        let value = |column: usize| {
            let cell = cells[column];
            let (fault, allowed) = match decimal.read(cell, *separator) {
                // A number of hundreds of digits is not the word for infinity, which marks a missing value.
                Cell::Number(value) if value.is_infinite() && cell.contains(|c: char| c.is_ascii_digit()) => {
                    ("beyond all numbers", "displacements and forces, NaN for a missing value")
                }
                Cell::Number(value) => return Ok(value),
                Cell::Missing => return Ok(f64::NAN),
                Cell::OtherMark | Cell::NoNumber => {
                    ("not a number", "numbers of one decimal mark, NaN for a missing value")
                }
            };
            Err(refused(
                place.clone(),
                format!("column {}: {:?} is {fault}", column + 1, shown(cell)),
                allowed,
            ))
        };
        points.take(&place, value, |column| cells[column].into())
    };
    // A line without two values, of which one may be missing, is part of the header.
    let is_header = |line: &str| {
        let separator = Separator::of(line);
        let cells = || separator.split(line).map(|cell| Decimal::default().read(cell, separator));
        let values = cells().filter(|cell| matches!(cell, Cell::Number(_) | Cell::Missing)).count();
        values < 2 || !cells().any(|cell| matches!(cell, Cell::Number(_)))
    };
    each_line(bytes, is_header, take)?;
    Ok(form.map_or_else(Vec::new, |(.., points)| points.parts))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::MeasuredCurve;
    use crate::made::{from_bytes, from_text, lines, of_spring, text_of_spring};

    fn columns(names: &[&str]) -> CurveOptions {
        CurveOptions { columns: names.iter().map(ToString::to_string).collect(), ..CurveOptions::default() }
    }

    /// Lines of the spring with this header, each point in this form.
    fn text(header: &str, form: impl Fn(f64, f64) -> String) -> String {
        text_of_spring(header, 600, form)
    }

    fn spring() -> MeasuredCurve {
        from_text(&lines(of_spring(600)), &CurveOptions::default()).unwrap()
    }

    fn assert_same(found: &MeasuredCurve, expected: &MeasuredCurve, name: &str) {
        let both = found
            .force
            .iter()
            .zip(&expected.force)
            .chain(found.displacement.iter().zip(&expected.displacement));
        assert!(both.into_iter().all(|(one, other)| (one - other).abs() < 1e-20), "{name}");
        assert_eq!((found.free, &found.segment), (expected.free, &expected.segment), "{name}");
    }

    #[test]
    fn a_curve_is_the_same_in_every_form() {
        let units = |columns: CurveOptions| CurveOptions { units: vec!["nm".into(), "nN".into()], ..columns };
        let plain = CurveOptions::default;
        let expected = spring();
        // Both points at the turn have one displacement.
        assert_eq!((expected.segment[298], expected.segment[301], expected.segment[599]), (0, 1, 1));
        assert!((190..=200).contains(&expected.free), "{}", expected.free);
        assert!((expected.noise / 1e-10 - 1.0).abs() < 0.02, "{:e}", expected.noise);
        assert!((expected.force[300] / 1e-7 - 1.0).abs() < 0.01, "{:e}", expected.force[300]);
        assert_eq!(expected.turns.len(), 2);
        for (content, options) in [
            (text("x/nm;F/nN\n", |d, f| format!("{d};{f}")), columns(&["x", "f"])),
            (text("# columns: time height force\n# units: s nm nN\n", |d, f| format!("0 {d} {f}")), plain()),
            (text("", |d, f| format!("{d}\t{f}")), units(plain())),
            (text("nm,nN\n", |d, f| format!("{d},{f}")), plain()),
            (text("a (nm)\tb (nN)\n", |d, f| format!("{d}\t{f}").replace('.', ",")), columns(&["1", "2"])),
            (
                text("separation [um],force [N]\n", |d, f| format!("{},{}", -d / 1e3, f / 1e9)),
                columns(&["1", "2"]),
            ),
            (
                text("z [nm],deflection [nm]\n", |d, f| format!("{d},{}", f / 4.0)),
                CurveOptions { units: vec!["nm".into(), "4nN".into()], ..columns(&["1", "2"]) },
            ),
        ] {
            assert_same(&from_text(&content, &options).unwrap(), &expected, &content[..20]);
        }
        let all = of_spring(600);
        let array =
            |descr: &str, shape: &str, values: &mut dyn Iterator<Item = f64>, options: CurveOptions| {
                let mut bytes = Vec::new();
                npy::write_header(&mut bytes, descr, shape).unwrap();
                bytes.extend(values.flat_map(f64::to_le_bytes));
                assert_same(&from_bytes(&bytes, &units(options)).unwrap(), &expected, shape);
            };
        array("'<f8'", "600, 2", &mut all.iter().flat_map(|&(d, f)| [d, f]), columns(&["1", "2"]));
        // Any number that changes with the segment.
        let labelled =
            all.iter().zip(&expected.segment).flat_map(|(&(d, f), segment)| [d, f, 7.0 - *segment as f64]);
        array("'<f8'", "600, 3", &mut labelled.into_iter(), columns(&["1", "2", "3"]));
        let axes = all.iter().map(|point| point.0).chain(all.iter().map(|point| point.1));
        array("'<f8'", "2, 600", &mut axes.into_iter(), columns(&["1", "2"]));
        let fields = "[('load', '<f8'), ('height', '<f8')]";
        array(fields, "600,", &mut all.iter().flat_map(|&(d, f)| [f, d]), plain());
    }

    /// Tables of analysis programs and instruments are read, also with approach and retraction side by side.
    #[test]
    fn exports_of_other_programs_are_read_without_options() {
        let (all, expected) = (of_spring(600), spring());
        let joined = |head: &str, count: usize, line: &dyn Fn(usize) -> String| {
            (0..count).fold(head.to_owned(), |all, index| all + &line(index) + "\n")
        };
        let tab = "# afmformats\n# BEGIN METADATA\n# {}\n# END METADATA\n# force\theight (measured)\theight (piezo)\ttime\n";
        let tab = joined(tab, 600, &|index| {
            format!("{:e}\t{:e}\t0\t{index}", all[index].1 * 1e-9, -all[index].0 * 1e-9)
        });
        let jpk = "# segment: extend\n# columns: time height vDeflection\n# fancyNames: \"a b\" \"c d\"\n# units: s m N\n";
        let jpk = joined(jpk, 600, &|index| {
            let again = if index == 300 { "# segment: retract\n" } else { "" };
            format!("{again}{index} {:e} {:e}", all[index].0 * 1e-9, all[index].1 * 1e-9)
        });
        // The retraction along the same direction as the approach, and with minus signs of a spreadsheet.
        let side = joined("Z ext (nm);F ext (nN);Z ret (nm);F ret (nN)\n", 300, &|index| {
            let (one, other) = (all[index], all[599 - index]);
            format!("{};{};{};{}", one.0, one.1, other.0, other.1).replace('-', "\u{2212}")
        });
        let one_height = joined("x [nm],approach force [nN],retract force [nN]\n", 300, &|index| {
            format!("{},{},{}", all[index].0, all[index].1, all[599 - index].1)
        });
        for (text, is_reversed) in [(tab, true), (jpk, false), (side, false), (one_height, false)] {
            let found = from_text(&text, &CurveOptions::default()).unwrap();
            assert_same(&found, &expected, &text[..60]);
            assert_eq!(found.statements.iter().any(|text| text.starts_with("Reversed")), is_reversed);
        }
        let words = joined("d [nm],f [nN],s\n", 600, &|index| {
            format!("{},{},{}", all[index].0, all[index].1, ["extend", "retract"][index / 300])
        });
        let found = from_text(&words, &columns(&["d", "f", "s"])).unwrap();
        assert_eq!((found.segment[299], found.segment[300]), (0, 1));
    }

    #[test]
    fn units_of_the_command_line_overrule_those_of_the_file() {
        // A divisor that is a whole number, and a factor.
        for unit in [4.0, 3.0] {
            let text = text("Piezo [nm],Deflection [nm]\n", |d, f| format!("{},{}", d / 1e3, f / unit));
            let units = vec!["um".to_owned(), format!("{unit}nN")];
            let curve = from_text(&text, &CurveOptions { units, ..CurveOptions::default() }).unwrap();
            let (turn, force) = (curve.turns[0], curve.force[300]);
            assert!(
                (turn / 5e-8 - 1.0).abs() < 0.01 && (force / 1e-7 - 1.0).abs() < 0.01,
                "{turn:e} {force:e}"
            );
            let of_force = format!("Unit of the force by --units: {unit}nN; the file states nm.");
            assert_eq!(curve.statements[0], "Unit of the displacement by --units: um; the file states nm.");
            assert_eq!(curve.statements[1], of_force);
        }
    }

    #[test]
    fn files_that_hold_no_curve_are_refused_with_their_place() {
        let comma = |d: f64, f: f64| format!("{d},{f}");
        let more = |line: &str| (lines(of_spring(600)) + line, columns(&[]));
        for ((text, options), said) in [
            (more("1e11,0\n"), "line 602: a displacement of 1e2 m far from all others"),
            (more("0,1e299\n"), "line 602: a force of 1e290 N"),
            (more(&("9".repeat(400) + ",0\n")), "line 602: column 1: \"999"),
            (more("1,2,3\n"), "line 602: 3 columns; allowed: 2"),
            (more("1,2x\n"), "line 602: column 2: \"2x\" is not a number"),
            ((text("d,f\n", comma), columns(&[])), "no unit of the displacement is stated"),
            ((text("d [nm],f [V]\n", comma), columns(&[])), "\"V\" is not a unit of the force"),
            (
                (text("a [nm],b [nN]\n", comma), columns(&[])),
                "2 columns a, b: none is known as the displacement",
            ),
            ((lines(of_spring(600)), columns(&["1", "5"])), "2 columns displacement, force: none is \"5\""),
        ] {
            let error = from_text(&text, &options).expect_err(said);
            assert!(error.starts_with(said) && error.contains("allowed: "), "{said}: {error}");
        }
    }
}
