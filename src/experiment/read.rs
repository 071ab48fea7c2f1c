//! Columns of a measured curve in SI units: text, CSV or an array of NumPy.

use super::ExperimentError;
use crate::io::{PROVENANCE, npy};
use crate::scene::{LONGEST_TEXT, parse_quantity, quoted};
use crate::topography::text::{COMMENT, Cell, Decimal, Separator, each_line};
use crate::topography::{Place, TopographyError, content, npy_columns, refused, shown, unpacked};
use std::cell::RefCell;
use std::fmt;
use std::path::Path;
use std::str::FromStr;

/// Term, SI unit and an example of a unit of each quantity, and names of its column, the preferred ones first.
const QUANTITIES: [(&str, &str, &str, &[&str]); 2] = [
    (
        "displacement",
        "m",
        "nm",
        &["displacement", "indentation", "position", "height", "distance", "d", "z", "x"],
    ),
    ("force", "N", "nN", &["force", "load", "f"]),
];
/// Remedy for unknown columns.
const COLUMNS: &str = "--columns DISPLACEMENT,FORCE by names or numbers, such as --columns 1,3";

/// Quantities that are reversed, so that pressing is positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "lowercase")]
#[cfg_attr(feature = "tui", derive(clap::ValueEnum))]
pub enum Negate {
    None,
    Displacement,
    Force,
    Both,
}

/// Treatment of the linear drift of the force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Drift {
    /// Keeps the drift in the curve.
    #[default]
    Keep,
    /// Removes the straight line before contact.
    Remove,
    /// Removes this drift from the first to the last point, N.
    Known(f64),
}

impl FromStr for Drift {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let allowed = "allowed: keep, remove, or a force from the first to the last point";
        match text {
            "keep" => Ok(Drift::Keep),
            "remove" => Ok(Drift::Remove),
            _ => force(text).map(Drift::Known).map_err(|error| format!("{error}; {allowed}")),
        }
    }
}

fn force(text: &str) -> Result<f64, String> {
    parse_quantity(text, "N").map_err(|error| error.to_string())
}

/// Options of reading and preparing a curve; what is not given is found in the curve.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "tui", derive(clap::Args))]
pub struct CurveOptions {
    /// Columns of displacement, force and segment: names or numbers
    ///
    /// Default: by the names in the header; of two columns the first is the displacement. Without
    /// a column of segments these end where the displacement turns.
    #[cfg_attr(
        feature = "tui",
        arg(long, value_name = "D,F[,SEGMENT]", value_delimiter = ',', verbatim_doc_comment)
    )]
    pub columns: Vec<String>,
    /// Units of displacement and force where none are stated: nm,nN
    ///
    /// A number is the value of 1 in the column: nm,3.01nN for a deflection in nm with 3.01 N/m.
    #[cfg_attr(feature = "tui", arg(long, value_name = "UNIT,UNIT", value_delimiter = ','))]
    pub units: Vec<String>,
    /// Reverse none, displacement, force or both; default: by the approach
    #[cfg_attr(feature = "tui", arg(long, value_name = "QUANTITY", hide_possible_values = true))]
    pub negate: Option<Negate>,
    /// Measured force that is zero: 2nN; default: the mean before contact
    #[cfg_attr(feature = "tui", arg(long, value_name = "FORCE", allow_hyphen_values = true, value_parser = force))]
    pub zero: Option<f64>,
    /// Linear drift: keep (default), remove, or a force over the curve
    #[cfg_attr(
        feature = "tui",
        arg(long, default_value = "keep", hide_default_value = true, allow_hyphen_values = true)
    )]
    pub drift: Drift,
    /// Standard deviation of the force; default: that before contact
    #[cfg_attr(feature = "tui", arg(long, value_name = "FORCE", value_parser = force))]
    pub noise: Option<f64>,
    /// Number of points before contact; default: up to the first change
    #[cfg_attr(feature = "tui", arg(long, value_name = "COUNT"))]
    pub free_points: Option<usize>,
}

impl fmt::Display for CurveOptions {
    /// Writes the options as arguments of the command line, a blank before each.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, values) in [("columns", &self.columns), ("units", &self.units)] {
            if !values.is_empty() {
                write!(out, " --{name}={}", quoted(values.join(",")))?;
            }
        }
        let drift = match self.drift {
            Drift::Keep => None,
            Drift::Remove => Some("remove".to_owned()),
            Drift::Known(force) => Some(format!("{force:?}N")),
        };
        let newtons = |force: Option<f64>| force.map(|force| format!("{force:?}N"));
        let values = [
            ("negate", self.negate.map(|one| one.to_string())),
            ("zero", newtons(self.zero)),
            ("drift", drift),
            ("noise", newtons(self.noise)),
            ("free-points", self.free_points.map(|count| count.to_string())),
        ];
        let given = values.into_iter().filter_map(|(name, value)| Some((name, value?)));
        given.into_iter().try_for_each(|(name, value)| write!(out, " --{name}={value}"))
    }
}

/// Columns of a file in SI units, without the points of which a value is missing.
#[derive(Debug, Default)]
pub(super) struct Columns {
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
    /// Numbers of the segments; empty without such a column.
    pub segment: Vec<f64>,
    /// Points left out since a value is missing.
    pub missing: usize,
}

impl Columns {
    pub fn read(path: &Path, options: &CurveOptions) -> Result<Self, ExperimentError> {
        let bytes = content(path)?;
        let bytes = unpacked(&bytes)?;
        let mut columns = Columns::default();
        if bytes.starts_with(npy::SIGNATURE) {
            let (names, values) = npy_columns(&bytes)?;
            let tail = &bytes[bytes.len().saturating_sub(npy::most_appended(LONGEST_TEXT))..];
            let is_own = npy::appended_text(tail).is_some_and(|text| text.starts_with(&PROVENANCE[2..]));
            let names: Vec<_> = names.into_iter().map(|name| (name, None)).collect();
            let choice = Choice::new(&names, values.len(), is_own, options)?;
            let count = values.first().map_or(0, Vec::len);
            (0..count).for_each(|point| {
                columns.push(choice.places.iter().map(|&place| values[place][point]), &choice);
            });
        } else {
            columns.read_text(&bytes, options)?;
        }
        Ok(columns)
    }

    fn read_text(&mut self, bytes: &[u8], options: &CurveOptions) -> Result<(), TopographyError> {
        let (header, mut form, mut decimal) = (RefCell::new(Vec::new()), None, Decimal::default());
        let mut row = Vec::new();
        let take = |place: Place, line: &str| {
            if form.is_none() {
                let separator = Separator::of(line);
                let count = separator.split(line).count();
                let names = names(&header.borrow(), separator, count);
                let is_own = bytes.starts_with(PROVENANCE.as_bytes());
                form = Some((separator, count, Choice::new(&names, count, is_own, options)?));
            }
            let Some((separator, count, choice)) = &form else { return Ok(()) };
            let cells: Vec<&str> = separator.split(line).collect();
            if cells.len() != *count {
                let allowed = format!("{count}, as in the first line of numbers");
                return Err(refused(place, format!("{} columns", cells.len()), allowed));
            }
            row.clear();
            for &column in &choice.places {
                row.push(match decimal.read(cells[column], *separator) {
                    Cell::Number(value) => value,
                    Cell::Missing => f64::NAN,
                    Cell::OtherMark | Cell::NoNumber => {
                        let fault =
                            format!("column {}: {:?} is not a number", column + 1, shown(cells[column]));
                        return Err(refused(
                            place,
                            fault,
                            "numbers of one decimal mark, NaN for a missing value",
                        ));
                    }
                });
            }
            self.push(row.iter().copied(), choice);
            Ok(())
        };
        // A line without two values, of which one may be missing, is part of the header.
        let is_header = |line: &str| {
            let separator = Separator::of(line);
            let cells = || separator.split(line).map(|cell| Decimal::default().read(cell, separator));
            let values = cells().filter(|cell| matches!(cell, Cell::Number(_) | Cell::Missing)).count();
            values < 2 || !cells().any(|cell| matches!(cell, Cell::Number(_)))
        };
        each_line(bytes, is_header, |line| header.borrow_mut().push(line.to_owned()), take)
    }

    /// Adds a point of these values in the units of the file, unless one of them is missing.
    fn push(&mut self, mut values: impl Iterator<Item = f64> + Clone, choice: &Choice) {
        if values.clone().any(|value| !value.is_finite()) {
            self.missing += 1;
            return;
        }
        let columns = [&mut self.displacement, &mut self.force];
        for ((column, unit), value) in columns.into_iter().zip(choice.units).zip(&mut values) {
            // A division by a whole number rounds once.
            let divisor = (1.0 / unit).round();
            column.push(if (divisor * unit - 1.0).abs() < 1e-12 { value / divisor } else { value * unit });
        }
        self.segment.extend(values);
    }
}

/// Places of the chosen columns, and the units of displacement and force in SI units.
#[derive(Debug)]
struct Choice {
    places: Vec<usize>,
    units: [f64; 2],
}

impl Choice {
    /// Chooses from `count` columns with these names and units; a table of the program itself is in SI units.
    fn new(
        names: &[(String, Option<String>)],
        count: usize,
        is_own: bool,
        options: &CurveOptions,
    ) -> Result<Self, TopographyError> {
        let wrong = |fault: String, allowed: &str| refused(Place::File, fault, allowed);
        let named = |wanted: &str| names.iter().position(|(name, _)| name.eq_ignore_ascii_case(wanted));
        let all: Vec<_> = names.iter().map(|(name, _)| shown(name)).collect();
        let all = format!("{count} columns {}", all.join(", "));
        let places: Vec<usize> = match &options.columns[..] {
            [] if names.is_empty() && count == 2 => vec![0, 1],
            [] => {
                let known = |(term, _, _, known): (&str, _, _, &[&str])| {
                    let place = known.iter().find_map(|name| named(name));
                    place.ok_or_else(|| wrong(format!("{all}: none is known as the {term}"), COLUMNS))
                };
                QUANTITIES.into_iter().map(known).collect::<Result<_, _>>()?
            }
            [_, _] | [_, _, _] => {
                let place = |wanted: &String| {
                    let number = || wanted.parse().ok().filter(|number| (1..=count).contains(number));
                    let place = named(wanted).or_else(|| Some(number()? - 1));
                    place.ok_or_else(|| wrong(format!("{all}: none is {:?}", shown(wanted)), COLUMNS))
                };
                options.columns.iter().map(place).collect::<Result<_, _>>()?
            }
            other => return Err(wrong(format!("--columns with {}", other.len()), COLUMNS)),
        };
        let mut units = [1.0; 2];
        for (quantity, (term, si, example, _)) in QUANTITIES.into_iter().enumerate() {
            let stated =
                names.get(places[quantity]).and_then(|(_, unit)| unit.as_deref()).or(is_own.then_some(si));
            let option = options.units.get(quantity).map(String::as_str);
            let multiple = option.filter(|text| text.starts_with(|first: char| first.is_ascii_digit()));
            let text = multiple.or(stated).or(option).ok_or_else(|| {
                wrong(format!("no unit of the {term} is stated"), "--units nm,nN for displacement and force")
            })?;
            let of_one = match multiple {
                Some(text) => parse_quantity(text, si).ok().filter(|of_one| *of_one > 0.0),
                None => unit(text, si),
            };
            units[quantity] = of_one.ok_or_else(|| {
                wrong(
                    format!("{:?} is not a unit of the {term}", shown(text)),
                    &format!("{example} and the like, or the value of 1, such as --units nm,3.01nN"),
                )
            })?;
            if multiple.is_none() && option.is_some_and(|option| unit(option, si) != Some(units[quantity])) {
                let fault =
                    format!("the file states {} as the unit of the {term}, not that of --units", shown(text));
                return Err(wrong(fault, "the unit of the file, or no --units"));
            }
        }
        Ok(Choice { places, units })
    }
}

/// A unit of length or force, such as nm, in SI units.
fn unit(text: &str, si: &str) -> Option<f64> {
    parse_quantity(&format!("1 {text}"), si).ok().filter(|_| text.ends_with(si))
}

/// Names and units of `count` columns from the last lines of a header that have as many: names with units, such as
/// `force [nN]`, and a row of units.
fn names(header: &[String], separator: Separator, count: usize) -> Vec<(String, Option<String>)> {
    let bare = |cell: &str| cell.trim_matches(['[', ']', '(', ')', '"', ' ']).to_owned();
    let mut units: Option<Vec<String>> = None;
    for line in header.iter().rev() {
        let line = line.trim_start_matches(COMMENT).trim_start();
        let line = line.split_once("columns:").or(line.split_once("units:")).map_or(line, |(_, cells)| cells);
        // Between a name and its unit there may be a blank.
        let line = line.replace(" [", "[").replace(" (", "(");
        let cells: Vec<&str> = separator.split(line.trim()).collect();
        let of_units = |si: &str| cells.iter().any(|cell| unit(&bare(cell), si).is_some());
        if cells.len() != count {
            continue;
        } else if units.is_none() && of_units("m") && of_units("N") {
            units = Some(cells.iter().map(|cell| bare(cell)).collect());
            continue;
        }
        let of_row = |column: usize| units.as_ref().map(|units| units[column].clone());
        let split = |(column, cell): (usize, &&str)| match cell.split_once(['[', '(', '/']) {
            Some((name, unit)) => (bare(name), Some(bare(unit))),
            None => (bare(cell), of_row(column)),
        };
        return cells.iter().enumerate().map(split).collect();
    }
    units.unwrap_or_default().into_iter().map(|unit| (String::new(), Some(unit))).collect()
}
