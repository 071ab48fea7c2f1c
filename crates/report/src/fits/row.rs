//! Row of one of many fitted curves, and the cells of a CSV table in which it is written and read.

use crate::fit::FitReport;
use asperity_data::{Warning, printable};
use asperity_experiment::RangeEnd;

/// Row of a table with one row for each measured curve: the result of the fit to the curve, or the
/// reason why the curve was not fitted.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CurveRow {
    /// Path of the file of the curve, as the user gave it.
    pub file: String,
    /// For each free parameter three numbers in SI units: its value, and the lower and the upper
    /// end of its 95 % interval. Empty if the curve was not fitted. If a fit finds only a bound of
    /// the parameter, the bound is the lower or the upper end, and the other two numbers are
    /// `None`.
    pub parameters: Vec<[Option<f64>; 3]>,
    /// Numbers of the curve and of its fit in SI units, such as the pull-off force; `None` for an
    /// unknown number. Their order is that of the columns in the CSV table, after the parameters.
    pub facts: [Option<f64>; FACTS.len()],
    /// Number of points of the curve that are used; `None` if the curve was not fitted.
    pub points: Option<u64>,
    /// True if the model describes the curve within its noise; `None` if the curve was not fitted.
    pub described: Option<bool>,
    /// [Grade](asperity_experiment::Grade) of the fit in words; empty if the curve was not fitted.
    pub description: String,
    /// Reason why the model does not describe the curve within its noise; empty if the model
    /// describes the curve.
    pub reason: String,
    /// Premises of the model that the scene with the fitted values does not meet.
    pub warnings: Vec<RowWarning>,
    /// Reason why the curve was not read or not fitted; empty if the curve was fitted.
    pub error: String,
}

/// A premise of the model that the scene fitted to one curve does not meet.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RowWarning {
    /// [Name](asperity_data::Warning::name) of the premise.
    pub name: String,
    /// Text of the [`asperity_data::Warning`]: its values, its meaning, and a step that helps.
    pub text: String,
}

impl RowWarning {
    /// Text between two warnings in one cell of a table.
    const SEPARATOR: &'static str = " | ";

    pub(super) fn of(warning: &Warning) -> Self {
        RowWarning {
            name: warning.name().to_owned(),
            text: warning.to_string(),
        }
    }

    /// Returns these warnings as the text of one cell of a table: `name: text | name: text`.
    pub(super) fn cell(warnings: &[RowWarning]) -> String {
        let texts: Vec<String> = warnings
            .iter()
            .map(|warning| format!("{}: {}", warning.name, warning.text))
            .collect();
        texts.join(Self::SEPARATOR)
    }

    /// Reads the warnings that [`Self::cell`] wrote into a cell; `None` if the cell has another
    /// form.
    fn in_cell(cell: &str) -> Option<Vec<RowWarning>> {
        let mut warnings = Vec::new();
        if cell.is_empty() {
            return Some(warnings);
        }
        for warning in cell.split(Self::SEPARATOR) {
            let (name, text) = warning.split_once(": ")?;
            warnings.push(RowWarning {
                name: name.to_owned(),
                text: text.to_owned(),
            });
        }
        Some(warnings)
    }
}

/// Names of the columns after the parameters. `pull_off_work` is the work of adhesion with which a
/// smooth sphere would have the pull-off force of the curve. The residuals are those of the points
/// in contact. `jumps`, `hysteresis` and `fall_in_pause` follow from the curve alone, without the
/// scene. The last two columns are the coordinates of the place on the specimen.
pub const FACTS: [&str; 11] = [
    "pull_off_force",
    "pull_off_work",
    "residual_over_noise",
    "residual_over_largest_force",
    "misfit",
    "noise",
    "jumps",
    "hysteresis",
    "fall_in_pause",
    "position_x",
    "position_y",
];

/// Endings of the names of the columns of a parameter: the first for its value, the others for the
/// ends of its interval.
pub(super) const ENDINGS: [&str; 3] = ["", "_low", "_high"];

impl CurveRow {
    /// Returns the row of a curve that was not read or not fitted.
    pub fn failed(title: &str, error: &str) -> Self {
        CurveRow {
            file: title.to_owned(),
            error: printable(error).into_owned(),
            ..CurveRow::default()
        }
    }

    /// Returns the row of a curve that was fitted. `position` are the coordinates, in m, of the
    /// place on the specimen at which the curve was measured; `None` if they are not known.
    pub fn fitted(report: &FitReport<'_>, position: Option<[f64; 2]>) -> Self {
        let FitReport {
            title,
            curve,
            fit,
            wording,
        } = *report;
        let force = curve.pull_off_force();
        let work = force.and_then(|force| report.pull_off_work(force));
        let mut parameters = Vec::with_capacity(fit.parameters.len());
        for fitted in &fit.parameters {
            let (low, high) = fitted.interval;
            parameters.push(match fitted.at_end {
                Some(RangeEnd::Low) => [None, None, Some(fitted.value)],
                Some(RangeEnd::High) => [None, Some(fitted.value), None],
                None => [Some(fitted.value), Some(low), Some(high)],
            });
        }
        let reason = match &fit.reason {
            Some(reason) => reason.note().in_words(wording),
            None => String::new(),
        };
        CurveRow {
            file: title.to_owned(),
            parameters,
            facts: [
                force,
                work,
                Some(fit.residual_over_noise),
                Some(fit.agreement.residual_over_largest_force),
                Some(fit.misfit),
                Some(curve.noise),
                Some(curve.features.jumps as f64),
                curve.features.hysteresis,
                curve.features.fall_in_pause,
                position.map(|[x, _]| x),
                position.map(|[_, y]| y),
            ],
            points: Some(curve.points as u64),
            described: Some(fit.describes()),
            description: fit.grade.to_string(),
            reason,
            warnings: fit.warnings.iter().map(RowWarning::of).collect(),
            error: String::new(),
        }
    }

    /// Reads a row from a line of a CSV table that [`FitsReport`](crate::FitsReport) wrote. Returns
    /// `None` for any other line.
    /// `parameters` is the number of free parameters.
    pub fn from_line(line: &str, parameters: usize) -> Option<Self> {
        let cells = cells_of(line)?;
        let (file, cells) = cells.split_first()?;
        if cells.len() != ENDINGS.len() * parameters + FACTS.len() + 6 {
            return None;
        }
        let (values, cells) = cells.split_at(ENDINGS.len() * parameters);
        let (facts, cells) = cells.split_at(FACTS.len());
        let [points, described, description, reason, warnings, error] = cells else {
            return None;
        };
        let mut parameters = Vec::new();
        // The cells of a curve that was not fitted are empty, so the list of its parameters stays
        // empty.
        if error.is_empty() {
            for parameter in numbers_of(values)?.chunks_exact(ENDINGS.len()) {
                parameters.push([parameter[0], parameter[1], parameter[2]]);
            }
        }
        Some(CurveRow {
            file: file.clone(),
            parameters,
            facts: numbers_of(facts)?.try_into().ok()?,
            points: points.parse().ok(),
            described: described.parse().ok(),
            description: description.clone(),
            reason: reason.clone(),
            warnings: RowWarning::in_cell(warnings)?,
            error: error.clone(),
        })
    }
}

/// Returns the numbers in the cells of a CSV line, with `None` for each empty cell. If a cell is
/// neither a number nor empty, the whole result is `None`.
fn numbers_of(cells: &[String]) -> Option<Vec<Option<f64>>> {
    let mut numbers = Vec::with_capacity(cells.len());
    for cell in cells {
        if cell.is_empty() {
            numbers.push(None);
        } else {
            numbers.push(Some(cell.parse().ok()?));
        }
    }
    Some(numbers)
}

/// Returns the cells of a CSV line, as RFC 4180 defines them; `None` if a quotation mark is not
/// closed.
fn cells_of(line: &str) -> Option<Vec<String>> {
    let mut cells = Vec::new();
    let mut cell = String::new();
    let mut is_quoted = false;
    let mut characters = line.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '"' if is_quoted && characters.peek() == Some(&'"') => {
                characters.next();
                cell.push('"');
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(std::mem::take(&mut cell)),
            other => cell.push(other),
        }
    }
    cells.push(cell);
    (!is_quoted).then_some(cells)
}
