//! Reader of a curve from a text. The reader finds where the points begin, takes information from
//! the lines before the points, and reads the points row by row.

use crate::read::columns::Stated;
use crate::read::metadata::Metadata;
use crate::read::names::{is_unit, names_segment};
use crate::read::options::CurveOptions;
use crate::read::points::{Columns, Rows};
use asperity_data::text_table::{
    COMMENT, Decimal, HeadLines, ONE_MARK, Separator, TextCell, TextColumn, TextFault, each_line,
};
use asperity_data::{PROVENANCE, shown};
use asperity_surface::files::refused;
use asperity_surface::{Place, SurfaceError};

/// Number of consecutive rows of numbers with the same form, from which on such rows count as
/// points. A header may also have rows of numbers, but fewer in succession.
pub(crate) const RUN: usize = 5;
/// Header line that the programs PyJibe and afmformats write above a table. The columns of such a
/// table are in SI units.
const OF_AFMFORMATS: &str = "END METADATA";

/// Form of a row of numbers: the separator, the number of cells, and which of the cells are words.
#[derive(Clone, Debug, PartialEq)]
struct Shape {
    pub separator: Separator,
    pub count: usize,
    words: Vec<usize>,
}

impl Shape {
    /// Returns the form of a line; `None` if it has fewer than `least` values or if all its values
    /// are missing.
    fn of(line: &str, least: usize) -> Option<Shape> {
        let separator = Separator::of(line);
        let mut words = Vec::new();
        let mut count = 0;
        let mut numbers = 0;
        for cell in separator.split(line) {
            match Decimal::default().read(cell, separator) {
                TextCell::Number(_) => numbers += 1,
                TextCell::Missing => {}
                _ => words.push(count),
            }
            count += 1;
        }
        let values = count - words.len();
        if numbers == 0 || values < least {
            return None;
        }
        Some(Shape {
            separator,
            count,
            words,
        })
    }

    fn is_number(&self, cell: &str) -> bool {
        let cell = Decimal::default().read(cell, self.separator);
        matches!(cell, TextCell::Number(_))
    }

    /// Returns true for a cell with a text that is neither a number nor the mark of a missing
    /// value.
    pub fn is_word(&self, cell: &str) -> bool {
        let cell = Decimal::default().read(cell, self.separator);
        matches!(cell, TextCell::NoNumber)
    }
}

/// Place in a text where the points begin, and the form of the first row of points.
struct Beginning {
    /// Number of the line, from 1.
    pub line: usize,
    pub shape: Shape,
}

/// Returns the place where the points of a text begin. It is the first of [`RUN`] consecutive rows
/// with the same form or, if there are no such rows, the first row of numbers. Returns `None` if
/// there is no row of numbers.
fn beginning(bytes: &[u8]) -> Result<Option<Beginning>, TextFault> {
    for least in [2, 1] {
        let mut runs = Runs::default();
        each_line(bytes, |number, line| {
            runs.take(number, line, least);
            Ok::<(), TextFault>(())
        })?;
        let beginning = runs.beginning();
        if beginning.is_some() {
            return Ok(beginning);
        }
    }
    Ok(None)
}

/// Search for runs, which are consecutive rows of numbers with the same form.
#[derive(Default)]
struct Runs {
    /// First row of numbers in the text.
    first: Option<Beginning>,
    /// First row of the run that is being read.
    run: Option<Beginning>,
    /// Number of rows of the run that is being read.
    length: usize,
}

impl Runs {
    /// Adds a line to the search, unless a run already has [`RUN`] rows. A line counts as a row of
    /// numbers if it has at least `least` values.
    fn take(&mut self, number: usize, line: &str, least: usize) {
        if self.is_long() || line.is_empty() || is_comment(line) {
            return;
        }
        let Some(shape) = Shape::of(line, least) else {
            self.run = None;
            return;
        };
        if let Some(run) = &self.run
            && run.shape == shape
        {
            self.length += 1;
            return;
        }
        if self.first.is_none() {
            self.first = Some(Beginning {
                line: number,
                shape: shape.clone(),
            });
        }
        self.run = Some(Beginning {
            line: number,
            shape,
        });
        self.length = 1;
    }

    fn is_long(&self) -> bool {
        self.length == RUN
    }

    fn beginning(self) -> Option<Beginning> {
        if self.is_long() { self.run } else { self.first }
    }
}

pub(crate) fn is_comment(line: &str) -> bool {
    line.starts_with(COMMENT)
}

/// Returns true for a line of at least two numbers, of which some may be missing, without words.
pub(crate) fn is_row(line: &str) -> bool {
    Shape::of(line, 2).is_some_and(|shape| shape.words.is_empty())
}

/// Returns the name of the segment that a comment line of the file states; `None` for another
/// comment.
fn segment_of(comment: &str) -> Option<&str> {
    let (key, name) = comment.trim_start_matches(COMMENT).split_once(':')?;
    let is_segment = key.trim().eq_ignore_ascii_case("segment");
    is_segment.then_some(name.trim())
}

/// Information from the lines above the points.
#[derive(Default)]
struct Above {
    header: HeadLines,
    pub metadata: Metadata,
    /// Names of the columns, from a line that also contains the first numbers because the file
    /// lacks a line end after the names.
    merged: Option<String>,
}

impl Above {
    pub fn take(&mut self, line: &str, shape: &Shape) {
        self.header.take(line);
        self.metadata.take(line);
        self.merged = names_before_numbers(line, shape);
    }

    /// Returns the columns of the table with their names and units.
    pub fn columns(&self, shape: &Shape) -> Vec<TextColumn> {
        let Some(names) = &self.merged else {
            return columns_of(&self.header, shape);
        };
        let mut header = HeadLines::default();
        header.take(names);
        columns_of(&header, shape)
    }

    /// Returns true if the first row of numbers is in the same line as the names of the columns.
    /// Such a table cannot be read.
    pub fn has_merged(&self) -> bool {
        self.merged.is_some()
    }

    /// Returns true for a table of PyJibe or afmformats, whose columns are in SI units.
    pub fn is_of_afmformats(&self) -> bool {
        self.header.has_line(OF_AFMFORMATS)
    }
}

fn columns_of(header: &HeadLines, shape: &Shape) -> Vec<TextColumn> {
    header.columns(shape.count, shape.count, shape.separator, is_unit)
}

/// Returns the names of columns from a comment line that continues with the first row of numbers,
/// so that the last name and the first number share a cell. Returns `None` for another line.
fn names_before_numbers(line: &str, shape: &Shape) -> Option<String> {
    let text = line.trim_start_matches(COMMENT);
    let cells: Vec<&str> = shape.separator.split(text).collect();
    if !is_comment(line) || cells.len() != (2 * shape.count).saturating_sub(1) {
        return None;
    }
    let (names, numbers) = cells.split_at(shape.count);
    if names.iter().any(|cell| shape.is_number(cell)) {
        return None;
    }
    if !numbers.iter().any(|cell| shape.is_number(cell)) {
        return None;
    }
    let (shared, names) = names.split_last()?;
    let end = shared
        .find(|c: char| c.is_ascii_digit() || c == '-')
        .unwrap_or(shared.len());
    let mut names = names.to_vec();
    names.push(&shared[..end]);
    Some(names.join("\t"))
}

/// Reads the columns of a curve from the content of a text file.
pub(crate) fn of_text(bytes: &[u8], options: &CurveOptions) -> Result<Vec<Columns>, SurfaceError> {
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
    /// True for a table that this program has written. Such a table is in SI units.
    is_of_program: bool,
    beginning: Beginning,
    above: Above,
    /// Collector with the rows read so far; `None` before the first row.
    rows: Option<Rows>,
    decimal: Decimal,
    /// Name of the segment, taken from a line above its points.
    name: String,
}

impl TextReader<'_> {
    /// Reads a line. `number` is the number of the line from 1.
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

    /// Reads a row of numbers, or a line between such rows that names a segment.
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

    /// Chooses the columns from the lines above the first row, and returns an empty collector of
    /// rows.
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
        // A number with so many digits that it becomes infinite is refused. The word for infinity,
        // which has no digits, marks a missing value.
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
mod tests {
    use crate::common::{from_text, lines, of_spring};
    use crate::curve::MeasuredCurve;
    use crate::read::options::CurveOptions;
    use crate::read::tests::assert_same;

    /// Returns a text of `head` and `count` lines.
    fn joined(head: &str, count: usize, line: &dyn Fn(usize) -> String) -> String {
        (0..count).fold(head.to_owned(), |all, index| all + &line(index) + "\n")
    }

    fn read(text: &str) -> MeasuredCurve {
        from_text(text, &CurveOptions::default())
            .unwrap_or_else(|error| panic!("{error}: {}", &text[..80]))
    }

    /// A curve in the form that each program writes is read without options. Each case ends with a
    /// text that the first statement must contain.
    #[test]
    fn exports_of_other_programs_are_read_without_options() {
        let (all, expected) = (of_spring(600), read(&lines(of_spring(600))));
        let (nano, retracted) = (
            |index: usize| [all[index].0 * 1e-9, all[index].1 * 1e-9],
            |index: usize| 599 - index,
        );
        let metadata = "# afmformats\n# BEGIN METADATA\n# {\n#   \"spring constant\": 2.0\n# }\n# END METADATA\n#\n";
        let tab = |index: usize| {
            let [d, f] = nano(index);
            format!(
                "{f:e}\t{:e}\t0\t{}",
                -d,
                if index < 300 { "False" } else { "True" }
            )
        };
        let names = "# force\theight (measured)\theight (piezo)\tsegment\n";
        let pyjibe = joined(&format!("{metadata}{names}"), 600, &tab);
        let merged = joined(
            &format!("{metadata}{}0\t0\t0\tFalse\n", names.trim_end()),
            600,
            &tab,
        );
        let jpk_names = "# columns: time height vDeflection\n# fancyNames: \"a b\" \"c d\"\n# springConstant: 2\n# units: s m N\n";
        let jpk_head = format!("# segment: extend\n{jpk_names}");
        let jpk = joined(&jpk_head, 600, &|index| {
            let again = if index == 300 {
                format!("\n# segment: retract\n{jpk_names}\n")
            } else {
                String::new()
            };
            let [d, f] = nano(index);
            format!("{again}{index} {d:e} {f:e}")
        });
        let optics = "Date\t1\nX\t2\tY\t3\nTip radius (um)\t27.5\nk (N/m)\t2\nD[Z] (nm)\t0\tt[s]\t1.0\tX\t1\n\n\
                      Time (s)\tLoad (uN)\tIndentation (nm)\tCantilever (nm)\tPiezo (nm)\tAuxiliary\n";
        let optics = joined(optics, 600, &|index| {
            let (d, f) = all[index];
            format!(
                "{index}\t{:e}\t{}\t{}\t{d}\t0",
                f / 1e3,
                d - f / 2.0,
                f / 2.0
            )
        });
        let workshop = "Force-Distance Curve\nFile Format: 3\nDate: Wednesday, August 1, 2018\nX, um: 27.25\nForce Constant, \
                        nN/nm: 2\nLight Lever Gain, mV/nm: 20\n\n";
        let volts = joined(
            &format!(
                "{workshop}Extend Z-Sense(nm),Extend T-B(V),Retract Z-Sense(nm),Retract T-B(V)\n"
            ),
            300,
            &|index| {
                let (one, other) = (all[index], all[300 + index]);
                format!(
                    "{},{:e},{},{:e}",
                    one.0,
                    one.1 / 100.0,
                    other.0,
                    other.1 / 100.0
                )
            },
        );
        // The approach is written backwards, from the turning point on. The deflection is in V and
        // in pN.
        let nanoscope =
            "Calc_Ramp_Ex_nm\tCalc_Ramp_Rt_nm\tDefl_V_Ex\tDefl_V_Rt\tDefl_pN_Ex\tDefl_pN_Rt\n";
        let nanoscope = joined(nanoscope, 300, &|index| {
            let (one, other) = (all[299 - index], all[599 - index]);
            let volts = [one, other].map(|point| point.1 / 9.0);
            let [one_force, other_force] = [one, other].map(|point| point.1 * 1e3);
            format!(
                "{}\t{}\t{:e}\t{:e}\t{one_force}\t{other_force}",
                one.0, other.0, volts[0], volts[1]
            )
        });
        // The retraction is listed in the same direction as the approach. Its minus signs are those
        // that spreadsheets write.
        let side = joined(
            "Z ext (nm);F ext (nN);Z ret (nm);F ret (nN)\n",
            300,
            &|index| {
                let (one, other) = (all[index], all[retracted(index)]);
                format!("{};{};{};{}", one.0, one.1, other.0, other.1).replace('-', "\u{2212}")
            },
        );
        let one_height = joined(
            "x [nm],approach force [nN],retract force [nN]\n",
            300,
            &|index| {
                format!(
                    "{},{},{}",
                    all[index].0,
                    all[index].1,
                    all[retracted(index)].1
                )
            },
        );
        let forward = joined(
            "Height, nm\tForward [nN]\tBackward [nN]\n"
                .replace(", nm", " [nm]")
                .as_str(),
            300,
            &|index| {
                format!(
                    "{}\t{}\t{}",
                    all[index].0,
                    all[index].1,
                    all[retracted(index)].1
                )
                .replace('.', ",")
            },
        );
        let mems = joined(
            "Operator\tm\u{fc}ller\nPiezo position[\u{b5}m]\tMEMS displ.[nm]\tForce [nN]\neoh\n",
            600,
            &|index| format!("{}\t0\t{}", all[index].0 / 1e3, all[index].1).replace('.', ","),
        );
        let words = joined("Phase;z [nm];F [nN]\n", 600, &|index| {
            format!(
                "{};{};{}",
                ["approach", "retract"][index / 300],
                all[index].0,
                all[index].1
            )
        });
        let headings = joined("d [nm]\tf [nN]\n", 600, &|index| {
            let heading = if index == 300 { "Retraction\n" } else { "" };
            format!("{heading}{}\t{}", all[index].0, all[index].1)
        });
        let swapped = joined("d [nm],f [nN]\n", 600, &|index| {
            let (d, f) = all[(index + 300) % 600];
            format!("{d},{f}")
        });
        for (text, said) in [
            (
                pyjibe,
                "Columns: height (measured) (m), force (N); displacement reversed, so that pressing is positive; 600 points",
            ),
            (merged, "first, 1 left out since a value is missing"),
            (
                jpk,
                "Columns: height (m), vDeflection (N); 600 points used in 2 segments, 200 before contact.",
            ),
            (optics, "Columns: Piezo (nm), Load (uN); 600"),
            (
                volts,
                "Extend Z-Sense (nm), Extend T-B (V by 50 nm/V and 2 N/m), the retraction in Retract Z-Sense (nm), Retract",
            ),
            (
                nanoscope,
                "Calc_Ramp_Ex (nm), Defl_pN_Ex (pN), the retraction in Calc_Ramp_Rt (nm), Defl_pN_Rt (pN); both parts begin",
            ),
            (
                side,
                "Columns: Z ext (nm), F ext (nN), the retraction in Z ret (nm), F ret (nN); 600",
            ),
            (
                one_height,
                "x (nm), approach force (nN), the retraction in x (nm), retract force (nN)",
            ),
            (
                forward,
                "Height (nm), Forward (nN), the retraction in Height (nm), Backward (nN)",
            ),
            (mems, "Columns: Piezo position (\u{b5}m), Force (nN); 600"),
            (words, "Columns: z (nm), F (nN); 600"),
            (headings, "Columns: d (nm), f (nN); 600"),
            (
                swapped,
                "the retraction comes first and was put behind the approach",
            ),
        ] {
            let found = read(&text);
            let is_merged = said.starts_with("first, ");
            let said = said.trim_start_matches("first, ");
            assert!(
                found.statements[0].to_string().contains(said),
                "{said}: {:?}",
                found.statements
            );
            if is_merged || found.force.len() == expected.force.len() {
                assert_same(&found, &expected, said);
            } else {
                panic!("{said}: {} points", found.force.len());
            }
        }
    }

    /// A file may state the stiffness of its instrument, and may have a displacement without the
    /// deflection of the instrument.
    #[test]
    fn the_instrument_of_a_file_is_known() {
        let all = of_spring(600);
        let text = |head: &str| {
            joined(head, 600, &|index| {
                format!("{},{}", all[index].0, all[index].1)
            })
        };
        let stated = |head: &str| {
            let curve = read(&text(head));
            (curve.stiffness, curve.of_body)
        };
        let some = |text: &str| Some(text.to_owned());
        assert_eq!(stated("d [nm],f [nN]\n"), (None, None));
        assert_eq!(
            stated("# springConstant: 2.5\nd [nm],f [nN]\n").0,
            Some(("springConstant".to_owned(), 2.5))
        );
        assert_eq!(
            stated("indentation [nm],f [nN]\n"),
            (None, some("indentation"))
        );
        assert_eq!(
            stated("Tip Position (nm),Force (nN)\n"),
            (None, some("Tip Position"))
        );
        // The options choose the column by its number, so the meaning of its name is ignored.
        let options = CurveOptions {
            columns: vec!["1".into(), "2".into()],
            ..CurveOptions::default()
        };
        assert_eq!(
            from_text(&text("indentation [nm],f [nN]\n"), &options)
                .unwrap()
                .of_body,
            None
        );
        // The displacement of the body is converted to that of the instrument by the stiffness that
        // the file or the scene states.
        let body = |head: &str| {
            joined(head, 600, &|index| {
                format!("{},{}", all[index].1 / 4.0 - all[index].0, all[index].1)
            })
        };
        let plain = read(&text("d [nm],f [nN]\n"));
        let found = [
            read(&body("k (N/m)\t4\nTip Position [nm],f [nN]\n")),
            from_text(
                &body("Tip Position [nm],f [nN]\n"),
                &CurveOptions {
                    instrument: Some(4.0),
                    ..CurveOptions::default()
                },
            )
            .unwrap(),
        ];
        for curve in found {
            let pairs = curve.displacement.iter().zip(&plain.displacement);
            assert!(
                pairs
                    .into_iter()
                    .all(|(first, second)| (first - second).abs() < 1e-18)
                    && curve.of_body.is_none()
            );
            assert!(
                curve.statements[1]
                    .to_string()
                    .ends_with("the deflection of an instrument of 4 N/m was added.")
            );
        }
        // A deflection is converted to a force by the stiffness in the file.
        let half = joined("k (N/m)\t2\nPiezo [nm]\tDeflection [nm]\n", 600, &|index| {
            format!("{}\t{}", all[index].0, all[index].1 / 2.0)
        });
        assert_same(&read(&half), &read(&text("d [nm],f [nN]\n")), "deflection");
    }

    /// Pauses are left out, and so are rows that repeat the previous row.
    #[test]
    fn pauses_and_repeated_rows_are_left_out_and_said() {
        let all = of_spring(600);
        let head = "# segment: extend\n# columns: height vDeflection\n# units: m N\n";
        let paused = joined(head, 600, &|index| {
            let pause: Vec<String> = (0..200)
                .map(|index| format!("5e-8 {:e}", 1e-9 * (101.0 - 0.02 * f64::from(index))))
                .collect();
            let pause = format!(
                "# segment: pause\n{}\n# segment: retract\n",
                pause.join("\n")
            );
            let before = if index == 300 { pause } else { String::new() };
            format!(
                "{before}{:e} {:e}",
                all[index].0 * 1e-9,
                all[index].1 * 1e-9
            )
        });
        let plain = read(&lines(all.iter().copied()));
        let found = read(&paused);
        assert_same(&found, &plain, "pause");
        assert!(
            found.statements[0]
                .to_string()
                .ends_with("200 before contact; 200 of pauses left out."),
            "{:?}",
            found.statements
        );
        let repeated = joined("d [nm],f [nN]\n", 600, &|index| {
            let row = format!("{},{}", all[index].0, all[index].1);
            if index == 100 {
                format!("{row}\n").repeat(500) + &row
            } else {
                row
            }
        });
        let found = read(&repeated);
        assert_same(&found, &plain, "repeated");
        let said = "; 500 left out since they repeat the point before, first line 103.";
        assert!(
            found.statements[0].to_string().ends_with(said),
            "{:?}",
            found.statements
        );
    }

    /// Forces without a displacement are spread over the ramp that the file or the option states.
    #[test]
    fn one_long_column_is_an_approach_and_a_retraction() {
        let all = of_spring(600);
        let text = |head: &str| joined(head, 600, &|index| format!("{}", all[index].1));
        let ramp = CurveOptions {
            ramp: Some(1.5e-7),
            ..CurveOptions::default()
        };
        let found = [
            from_text(&text("Force [nN]\n"), &ramp).unwrap(),
            read(&text("Ramp size: 150 nm\nForce [nN]\n")),
        ];
        let expected = read(&lines(all.iter().copied()));
        for curve in found {
            assert_eq!(
                (curve.free, &curve.segment),
                (expected.free, &expected.segment)
            );
            assert!(
                (curve.displacement[299] - 1.5e-7).abs() < 1e-12
                    && curve.displacement[599].abs() < 1e-12
            );
            assert!(
                curve.statements[0]
                    .to_string()
                    .contains("none of the displacement (150 nm there and back), Force (nN)")
            );
        }
    }
}
