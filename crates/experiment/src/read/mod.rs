//! Columns of a measured curve in SI units, read from text, CSV, a NumPy array or a binary wave of
//! Igor.

pub(crate) mod columns;
pub(crate) mod foreign;
pub(crate) mod metadata;
pub(crate) mod names;
pub(crate) mod options;
pub(crate) mod points;
pub(crate) mod several;
pub(crate) mod text;
pub(crate) mod wave;

use crate::error::ExperimentError;
use crate::read::columns::Stated;
use crate::read::foreign::check_is_text;
use crate::read::metadata::Metadata;
use crate::read::options::CurveOptions;
use crate::read::points::{Columns, Rows};
use crate::read::text::of_text;
use crate::read::wave::of_wave;
use asperity_data::npy;
use asperity_data::text_table::TextColumn;
use asperity_surface::files::{columns as npy_columns, is_igor_wave, unpacked};
use asperity_surface::{Place, SurfaceError};
use std::path::Path;

/// Reads the columns of a curve from `bytes`, the content of a file, which may be compressed by
/// gzip. The name of the file serves to recognise and refuse binary formats of instruments.
pub(crate) fn parse(
    name: &Path,
    bytes: &[u8],
    options: &CurveOptions,
) -> Result<Columns, ExperimentError> {
    let bytes = unpacked(bytes)?;
    if bytes.starts_with(npy::SIGNATURE) {
        let columns = Columns::joined(of_array(&bytes, options)?);
        columns.check_displacements(Place::Point)?;
        return Ok(columns);
    }
    if is_igor_wave(&bytes) {
        let columns = Columns::joined(of_wave(&bytes, options)?);
        columns.check_displacements(Place::Point)?;
        return Ok(columns);
    }
    check_is_text(name, &bytes)?;
    let columns = Columns::joined(of_text(&bytes, options)?);
    columns.check_displacements(Place::Line)?;
    Ok(columns)
}

/// Reads the columns of a curve from the content of a NumPy file.
fn of_array(bytes: &[u8], options: &CurveOptions) -> Result<Vec<Columns>, SurfaceError> {
    let (names, values) = npy_columns(bytes)?;
    // A column with one of these names shows that this program has written the file, in SI units,
    // with a force curve or a fit.
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
                .all(|(first, second)| (first - second).abs() < 1e-20),
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

    /// Returns a text with the curve of the spring. It begins with `header`, and `form` writes the
    /// line of each point.
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
        // Points 299 and 300, at the turning point, have the same displacement, so that either
        // segment may contain them.
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
        // Writes a force in pN with this mark between thousands.
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
        // The column of the segment may have any numbers that change with the segment.
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
        // Conversion to N: a value in 4 nN is divided by a whole number, and a value in 3 nN is
        // multiplied.
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
            let of_force = format!(
                "Unit of the force as stated beside the file: {unit}nN; the file states nm."
            );
            assert_eq!(
                curve.statements[1].to_string(),
                "Unit of the displacement as stated beside the file: um; the file states nm."
            );
            assert_eq!(curve.statements[2].to_string(), of_force);
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
            // Only in a file without names and units both the columns and the units have to be
            // stated. Only then the message speaks of units.
            assert!(
                error.contains(", with their units") == error.contains("without names"),
                "{error}"
            );
        }
    }
}
