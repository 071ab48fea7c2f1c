//! Report on the sensitivity of a scene as text, JSON and a table, and a chart for the explorer.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::warnings::{counted_texts, sentences_section};
use crate::words::percent;
use asperity_data::{AxisScale, Kind, Table, counted, format_quantity, format_rounded, one_unit};
use asperity_plot::{Chart, ChartAxis, Ink, Label, Layer, Shape, Sign, Span};
use asperity_scene::{Adhesion, Scene};
use asperity_study::{Changed, Ensemble, Influence, Sensitivity};
use serde::Serialize;
use std::ops::Range;

/// Smallest relative change that is written as a factor. A relative change of 2 is a change to
/// three times the value.
const LARGE: f64 = 2.0;

/// Smallest change in per cent that the axis of a chart of changes shows in each direction.
const LEAST: f64 = 1.0;

/// Half the height of a bar, divided by the distance between two bars.
const HALF: f64 = 0.35;

/// Text that replaces a change if the scene does not allow the changed number.
pub const NOT_ALLOWED: &str = "not allowed";

const PROFILES: &str = "profiles";

/// Report on the sensitivity of a scene: how much its results change if one of its numbers, such as
/// a length, is changed by +10 % or −10 %. Each number is changed by itself. A whole number changes
/// by at least 1, and a wavelength by at least one wave on the length.
#[derive(Clone, Copy, Debug)]
pub struct SensitivityReport<'a> {
    pub title: &'a str,
    /// Scene whose numbers, such as lengths, are changed one by one.
    pub scene: &'a Scene,
    /// Changes of the results, such as the pull-off force, due to the change of each number of the
    /// scene.
    pub sensitivity: &'a Sensitivity,
}

/// Returns a relative change as text: `+12 %`, or `×4.2` for a large change.
fn change_text(change: f64) -> String {
    let percent = 100.0 * change;
    if percent.abs() < 0.05 {
        "0 %".to_owned()
    } else if change >= LARGE {
        format!("×{}", format_rounded(1.0 + change, 3, "1"))
    } else {
        let digits = if percent.abs() < 9.95 { 1 } else { 0 };
        format!("{percent:+.digits$} %")
    }
}

/// Returns the relative change of a number as text with two digits: `+10 %`, `-11 %`.
fn step_text(step: f64) -> String {
    let sign = if step < 0.0 { "-" } else { "+" };
    format!("{sign}{}", percent(step.abs(), 2))
}

/// Changes of the results in one row of the table. The row belongs to a smaller or larger number,
/// or to the profiles with the smallest or largest results.
struct Side<'a> {
    /// Number that is changed; `None` in a row that belongs to the profiles.
    influence: Option<&'a Influence>,
    /// 0 for the smaller number or for the smallest results, 1 for the larger number or for the
    /// largest results.
    side: usize,
    /// Relative changes of the medians; `None` if the scene does not allow the changed number.
    changes: Option<[Option<f64>; 3]>,
    /// Smallest and largest relative change of F_a among the profiles.
    range: Option<(f64, f64)>,
}

impl<'a> Side<'a> {
    /// Returns the changes for the smaller number (`side` 0) or the larger number (`side` 1).
    fn of_number(sensitivity: &Sensitivity, influence: &'a Influence, side: usize) -> Self {
        let changed = influence.sides[side].1;
        Side {
            influence: Some(influence),
            side,
            changes: changed.map(|changed| sensitivity.changes(&changed.medians)),
            range: changed.and_then(|changed| changed.range[0]),
        }
    }

    fn name(&self) -> Label {
        let Some(influence) = self.influence else {
            return PROFILES.into();
        };
        let axis = &influence.axis;
        let short = axis
            .name
            .replace("force of ", "")
            .replace("indentation of ", "");
        Label::symbol_or_name(axis.symbol, &short)
    }

    /// Returns the value of the number in the unchanged scene; empty in a row that belongs to the
    /// profiles.
    fn value(&self) -> String {
        match self.influence {
            Some(influence) => format_quantity(influence.value, influence.axis.unit),
            None => String::new(),
        }
    }

    /// Returns the change of the number in words: in per cent or, for a whole number, as a
    /// difference.
    fn step(&self) -> String {
        let Some(influence) = self.influence else {
            return ["least", "most"][self.side].to_owned();
        };
        if influence.axis.is_whole() {
            let (changed, _) = influence.sides[self.side];
            format!("{:+}", changed - influence.value)
        } else {
            step_text(influence.step(self.side))
        }
    }

    /// Returns the relative change of a result; `None` if it is unknown.
    fn change(&self, result: usize) -> Option<f64> {
        self.changes?[result]
    }

    fn change_in_words(&self, result: usize) -> String {
        match self.change(result) {
            Some(change) => change_text(change),
            None => "-".to_owned(),
        }
    }

    /// Returns the range of the changes of F_a over the profiles, in words; empty if the scene has
    /// a fixed profile.
    fn range_in_words(&self) -> String {
        match self.range {
            Some((least, most)) => one_unit([change_text(least), change_text(most)]),
            None if self.changes.is_none() => NOT_ALLOWED.to_owned(),
            None => String::new(),
        }
    }
}

/// Returns two rows for each number, beginning with the number that has the largest influence on a
/// result, and finally the rows that belong to the profiles.
fn sides(sensitivity: &Sensitivity, result: usize) -> Vec<Side<'_>> {
    let mut sides = Vec::new();
    for influence in sensitivity.ordered(result) {
        sides.push(Side::of_number(sensitivity, influence, 0));
        sides.push(Side::of_number(sensitivity, influence, 1));
    }
    if let Some(ends) = sensitivity.range {
        for (side, results) in ends.iter().enumerate() {
            sides.push(Side {
                influence: None,
                side,
                changes: Some(sensitivity.changes(results)),
                range: None,
            });
        }
    }
    sides
}

/// Returns a table of the changes of the median results of a scene. The table has a row of
/// headings, a row with the medians of the unchanged scene, two rows for each number of the scene
/// and, for a random profile, two rows for the range over the profiles. The columns are: name,
/// value and change of the number, change of the pull-off force F_a with its range over the
/// profiles, change of the pull-off force F_a(d=0) without a preload, and change of the dissipated
/// energy.
pub fn sensitivity_table(sensitivity: &Sensitivity) -> Vec<[String; 7]> {
    let has_profiles = sensitivity.range.is_some();
    let mut rows = vec![
        headings(has_profiles),
        present_row(sensitivity, has_profiles),
    ];
    for side in sides(sensitivity, 0) {
        // Only the first of the two rows of a number has its name and its value.
        let mut name = String::new();
        let mut value = String::new();
        if side.side == 0 {
            name = side.name().to_string();
            value = side.value();
        }
        rows.push([
            name,
            value,
            side.step(),
            side.change_in_words(0),
            side.range_in_words(),
            side.change_in_words(1),
            side.change_in_words(2),
        ]);
    }
    rows
}

fn headings(has_profiles: bool) -> [String; 7] {
    let single_profiles = if has_profiles { "single profiles" } else { "" };
    let [force, touch, energy] = Sensitivity::RESULTS.map(|result| result.symbol());
    let headings = [
        "number",
        "value",
        "change",
        force,
        single_profiles,
        touch,
        energy,
    ];
    headings.map(String::from)
}

/// Returns the row with the results of the unchanged scene.
fn present_row(sensitivity: &Sensitivity, has_profiles: bool) -> [String; 7] {
    let name = if has_profiles { "median" } else { "this scene" };
    let present = |result: usize| match sensitivity.present[result] {
        Some(value) => format_quantity(value, Sensitivity::RESULTS[result].unit()),
        None => "-".to_owned(),
    };
    [
        name.to_owned(),
        String::new(),
        String::new(),
        present(0),
        String::new(),
        present(1),
        present(2),
    ]
}

/// Returns a bar chart of the changes in per cent of one result of a scene. `result` is an index of
/// [`Sensitivity::RESULTS`]. The chart has the bars number `rows`, counted from the first change of
/// the number with the largest influence, and the same horizontal axis for all parts.
pub fn sensitivity_chart(sensitivity: &Sensitivity, result: usize, rows: Range<usize>) -> Chart {
    let sides = sides(sensitivity, result);
    let span = span_of_changes(&sides, result);
    let sides = sides.get(rows).unwrap_or_default();
    let mut bars = Bars::default();
    let mut names = Vec::new();
    // The rows are drawn from below, beginning with the last row at 0 on the vertical axis.
    for (place, side) in (0..).map(f64::from).zip(sides.iter().rev()) {
        let step = side.step();
        let words = side.change_in_words(result);
        names.push(side.name().then(&format!(", {step}: {words}")));
        if let Some(change) = side.change(result) {
            bars.add(side, place, 100.0 * change, span);
        }
    }
    let symbol = Sensitivity::RESULTS[result].symbol();
    let x = ChartAxis::new(AxisScale::Linear, span, "change of", symbol, "%");
    Chart::new(x, ChartAxis::of_names(names), bars.layers())
}

/// Returns the range in per cent of the axis of changes. The differences between profiles do not
/// widen the range, so that their bars may reach beyond it.
fn span_of_changes(sides: &[Side<'_>], result: usize) -> Span {
    let mut largest = LEAST;
    for side in sides {
        if side.influence.is_some()
            && let Some(change) = side.change(result)
        {
            largest = f64::max(largest, (100.0 * change).abs());
        }
    }
    let end = 1.05 * largest;
    Span {
        // A positive result cannot fall by more than 100 %.
        low: -end.min(105.0),
        high: end,
    }
}

/// Range of a bar along the horizontal axis, and range along the vertical axis.
type Bar = ((f64, f64), (f64, f64));

/// Bars of a chart of changes. Where a bar would reach beyond the chart, a mark is drawn at its
/// edge.
#[derive(Default)]
struct Bars {
    of_smaller_numbers: Vec<Bar>,
    of_larger_numbers: Vec<Bar>,
    of_profiles: Vec<Bar>,
    beyond_left: Vec<(f64, f64)>,
    beyond_right: Vec<(f64, f64)>,
}

impl Bars {
    /// Adds a bar for a change in per cent. `place` is its position on the vertical axis.
    fn add(&mut self, side: &Side<'_>, place: f64, change: f64, span: Span) {
        let bars = match side.influence {
            None => &mut self.of_profiles,
            Some(_) if side.side == 0 => &mut self.of_smaller_numbers,
            Some(_) => &mut self.of_larger_numbers,
        };
        let width = (change.min(0.0), change.max(0.0));
        let height = (place - HALF, place + HALF);
        bars.push((width, height));
        if change < span.low || change > span.high {
            let end = (change.clamp(span.low, span.high), place);
            if change > 0.0 {
                self.beyond_right.push(end);
            } else {
                self.beyond_left.push(end);
            }
        }
    }

    fn layers(self) -> Vec<Layer> {
        vec![
            Layer::unnamed(Ink::Quiet, Shape::Upright(0.0)),
            Layer::unnamed(Ink::Series(0), Shape::Boxes(self.of_smaller_numbers)),
            Layer::unnamed(Ink::Series(1), Shape::Boxes(self.of_larger_numbers)),
            Layer::unnamed(Ink::Kept, Shape::Boxes(self.of_profiles)),
            Layer::unnamed(Ink::Text, Shape::signs(self.beyond_left, Sign::Left)),
            Layer::unnamed(Ink::Text, Shape::signs(self.beyond_right, Sign::Right)),
        ]
    }
}

impl SensitivityReport<'_> {
    /// Returns sentences on the profiles, and on the numbers that stay constant while another
    /// number changes.
    fn note(&self) -> String {
        if let Some(missing) = self.sensitivity.missing() {
            return missing.to_owned();
        }
        let profiles = if self.sensitivity.range.is_some() {
            format!(
                "All are medians over the same {} random profiles; beside them the range of F_a of single profiles.",
                self.sensitivity.profiles
            )
        } else {
            Ensemble::FIXED.to_owned()
        };
        let mut influences = self.sensitivity.influences.iter();
        let has_wavelengths =
            influences.any(|influence| influence.axis.path.starts_with("roughness.wavelengths"));
        let waves = if has_wavelengths {
            " A wavelength changes so that whole waves fit on the length. Where the length changes, the numbers of waves on it \
             stay."
        } else {
            ""
        };
        let others = others_stay(self.scene.adhesion);
        format!("{others}{waves} {profiles}")
    }
}

/// Returns a sentence on the numbers of a scene that stay constant while another number changes.
/// `adhesion` is the adhesion of the scene.
pub(crate) fn others_stay(adhesion: Option<Adhesion>) -> String {
    let by_parameter = adhesion.is_some_and(|adhesion| adhesion.parameter().is_some());
    let follows = if by_parameter {
        ", and the work of adhesion follows from them"
    } else {
        ""
    };
    format!("All other numbers of the scene stay{follows}.")
}

impl Report for SensitivityReport<'_> {
    fn warnings(&self) -> Vec<String> {
        counted_texts(&self.sensitivity.warnings, self.sensitivity.profiles)
    }

    fn text(&self) -> Option<String> {
        let sensitivity = self.sensitivity;
        let mut sheet = Sheet::default();
        sheet.paragraph(self.title);
        if sensitivity.missing().is_none() {
            let springs = counted(self.scene.numerics.points, "spring");
            let results = if sensitivity.range.is_some() {
                "medians"
            } else {
                "results"
            };
            sheet.heading(&format!(
                "Changes of the {results} where one number changes, {springs}"
            ));
            sheet.table(&sensitivity_table(sensitivity));
        }
        sheet.heading(&self.note());
        sentences_section(&mut sheet, &self.warnings());
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let sensitivity = self.sensitivity;
        Some(Box::new(SensitivityJson {
            scene: self.scene,
            warnings: counted_texts(&sensitivity.warnings, sensitivity.profiles),
            step: Sensitivity::STEP,
            profiles: sensitivity.profiles,
            results: ResultsJson::new(sensitivity.present),
            range: sensitivity.range.map(|[least, most]| RangeJson {
                least: ResultsJson::new(least),
                most: ResultsJson::new(most),
            }),
            numbers: sensitivity.influences.iter().map(NumberJson::new).collect(),
        }))
    }

    /// Returns a table of the medians of the results: a row for the unchanged scene, and for each
    /// number a row for its change by +10 % and a row for its change by −10 %.
    fn table(&self) -> Option<Table<'_>> {
        let paths = self.sensitivity.influences.iter();
        let longest = paths
            .map(|influence| influence.axis.path.len())
            .max()
            .unwrap_or(0);
        let rows = table_rows(self.sensitivity);
        let mut table = Table::of(move || rows.clone().into_iter())
            .with("path", Kind::Text(longest), |row| row.path)
            .real("value", |row| row.value);
        for (result, quantity) in Sensitivity::RESULTS.iter().enumerate() {
            let name = quantity.name();
            let least = format!("{name}_least_change");
            let most = format!("{name}_most_change");
            table = table
                .real(name, move |row| row.results.medians[result])
                .with(least, Kind::Real, move |row| {
                    row.results.range[result].map(|ends| ends.0)
                })
                .with(most, Kind::Real, move |row| {
                    row.results.range[result].map(|ends| ends.1)
                });
        }
        Some(table.done())
    }
}

/// Row of the table: a number of the scene, a value of this number, and the results with this
/// value.
#[derive(Clone)]
struct TableRow<'a> {
    /// Path of the changed number; empty for the unchanged scene.
    path: &'a str,
    value: Option<f64>,
    results: Changed,
}

fn table_rows(sensitivity: &Sensitivity) -> Vec<TableRow<'_>> {
    let mut rows = vec![TableRow {
        path: "",
        value: None,
        results: Changed {
            medians: sensitivity.present,
            ..Changed::default()
        },
    }];
    for influence in &sensitivity.influences {
        for (value, changed) in influence.sides {
            if let Some(results) = changed {
                rows.push(TableRow {
                    path: &influence.axis.path,
                    value: Some(value),
                    results,
                });
            }
        }
    }
    rows
}

/// JSON object of a sensitivity, in SI units.
#[derive(Serialize)]
struct SensitivityJson<'a> {
    scene: &'a Scene,
    warnings: Vec<String>,
    step: f64,
    profiles: u64,
    results: ResultsJson<f64>,
    range: Option<RangeJson>,
    numbers: Vec<NumberJson<'a>>,
}

/// One value for each of [`Sensitivity::RESULTS`]; `None` for a value that is not known.
#[derive(Serialize)]
struct ResultsJson<T> {
    pull_off_force: Option<T>,
    first_touch_pull_off_force: Option<T>,
    dissipated_energy: Option<T>,
}

/// Smallest and largest results of the unchanged scene over the profiles.
#[derive(Serialize)]
struct RangeJson {
    least: ResultsJson<f64>,
    most: ResultsJson<f64>,
}

#[derive(Serialize)]
struct NumberJson<'a> {
    path: &'a str,
    name: &'a str,
    value: f64,
    /// Results with the smaller number; `None` if the scene does not allow this number.
    smaller: Option<ChangedJson>,
    larger: Option<ChangedJson>,
}

#[derive(Serialize)]
struct ChangedJson {
    value: f64,
    change: f64,
    results: ResultsJson<f64>,
    /// Smallest and largest relative changes over the profiles.
    profile_changes: ResultsJson<(f64, f64)>,
}

impl<T> ResultsJson<T> {
    fn new(values: [Option<T>; 3]) -> Self {
        let [
            pull_off_force,
            first_touch_pull_off_force,
            dissipated_energy,
        ] = values;
        ResultsJson {
            pull_off_force,
            first_touch_pull_off_force,
            dissipated_energy,
        }
    }
}

impl<'a> NumberJson<'a> {
    fn new(influence: &'a Influence) -> Self {
        NumberJson {
            path: &influence.axis.path,
            name: &influence.axis.name,
            value: influence.value,
            smaller: ChangedJson::new(influence, 0),
            larger: ChangedJson::new(influence, 1),
        }
    }
}

impl ChangedJson {
    /// Collects the results with the smaller number (`side` 0) or with the larger number (`side`
    /// 1).
    fn new(influence: &Influence, side: usize) -> Option<Self> {
        let (value, changed) = influence.sides[side];
        let changed = changed?;
        Some(ChangedJson {
            value,
            change: influence.step(side),
            results: ResultsJson::new(changed.medians),
            profile_changes: ResultsJson::new(changed.range),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_short() {
        for (change, text) in [
            (-0.081, "-8.1 %"),
            (0.123, "+12 %"),
            (1e-5, "0 %"),
            (3.2, "×4.2"),
            (-0.5, "-50 %"),
        ] {
            assert_eq!(change_text(change), text);
        }
    }

    /// Each change has a row and a bar. A whole number changes by at least 1. If a number is not
    /// allowed, its row states this. A bar that is longer than the chart has an arrow.
    #[test]
    fn each_change_has_a_row_and_a_bar_of_its_own() {
        let scene = asperity_scene::open("jkr-sphere").unwrap().scene().clone();
        let influence = |path: &str, value: f64, sides| {
            let axis =
                asperity_study::Axis::new(path, asperity_study::Spacing::List, Vec::new(), &scene)
                    .unwrap();
            Influence { axis, value, sides }
        };
        let force = |force: f64| {
            let range = [Some((-0.1, 3.0)), None, None];
            Some(Changed {
                medians: [Some(force), None, Some(1.0)],
                range,
            })
        };
        let sensitivity = Sensitivity {
            present: [Some(2e-6), None, Some(1.0)],
            influences: vec![
                influence(
                    "material.poisson_ratio",
                    0.5,
                    [(0.45, force(1.8e-6)), (0.55, None)],
                ),
                influence(
                    "roughness.modes.0",
                    4.0,
                    [(3.0, force(3e-6)), (5.0, force(2.5e-6))],
                ),
            ],
            profiles: 16,
            range: Some([[Some(1e-6), None, Some(1.0)], [Some(8e-6), None, Some(1.0)]]),
            warnings: Vec::new(),
        };
        let rows = sensitivity_table(&sensitivity)
            .into_iter()
            .map(|row| row.join("|"));
        let expected = [
            "number|value|change|F_a|single profiles|F_a(d=0)|ΔW",
            "median|||2 µN||-|1 J",
            "k_min|4|-1|+50 %|-10 % to ×4|-|0 %",
            "||+1|+25 %|-10 % to ×4|-|0 %",
            "ν|0.5|-10 %|-10 %|-10 % to ×4|-|0 %",
            "||+10 %|-|not allowed|-|-",
            "profiles||least|-50 %||-|0 %",
            "||most|×4||-|0 %",
        ];
        assert_eq!(rows.collect::<Vec<_>>(), expected);
        let names =
            |chart: &Chart| -> Vec<String> { chart.y.names.iter().map(Label::to_string).collect() };
        let first = sensitivity_chart(&sensitivity, 0, 0..2);
        assert_eq!(names(&first), ["k_min, +1: +25 %", "k_min, -1: +50 %"]);
        let chart = sensitivity_chart(&sensitivity, 0, 0..expected.len() - 2);
        assert_eq!(chart.x, first.x);
        assert_eq!(
            names(&chart),
            [
                "profiles, most: ×4",
                "profiles, least: -50 %",
                "ν, +10 %: -",
                "ν, -10 %: -10 %",
                "k_min, +1: +25 %",
                "k_min, -1: +50 %"
            ]
        );
        let arrows = |sign| {
            let is_arrow = |layer: &&Layer| matches!(&layer.shape, Shape::Curve { sign: Some(one), .. } if *one == sign);
            chart
                .layers
                .iter()
                .find(is_arrow)
                .map(|layer| layer.shape.points().len())
        };
        assert_eq!(
            (arrows(Sign::Right), arrows(Sign::Left)),
            (Some(1), Some(0))
        );
        let none = Sensitivity {
            present: [Some(0.0), None, None],
            ..sensitivity
        };
        let report = SensitivityReport {
            title: "None",
            scene: &scene,
            sensitivity: &none,
        };
        assert!(report.text().unwrap().contains("no pull-off"));
    }
}
