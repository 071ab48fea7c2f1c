//! Pull-off force as a function of the preload, as text, JSON, tables and a figure.

use crate::report::{Json, Report};
use crate::sheet::{Sheet, thinned};
use crate::warnings::{counted_texts, sentences_section};
use asperity_data::{
    AxisScale, Table, counted, format_quantity, format_range, format_rounded, grouped,
};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke};
use asperity_scene::Scene;
use asperity_scene::discretisation::Choice;
use asperity_study::{Results, Staircase, Statistics};
use serde::Serialize;
use std::ops::Range;

/// Largest number of rows of a table in the text report. Tables in files have all rows.
const MOST_ROWS: usize = 32;

/// The axis of pull-off forces is logarithmic if the ratio of the largest to the smallest force is
/// at least this number.
const LOGARITHMIC_RATIO: f64 = 30.0;

/// Largest number of decades of a logarithmic axis of pull-off forces.
const MOST_DECADES: f64 = 6.0;

/// Report on the pull-off force as a function of the preload, for one or more random profiles.
#[derive(Clone, Copy, Debug)]
pub struct PreloadReport<'a> {
    pub title: &'a str,
    /// Choice of the number of springs with which the error is within a tolerance; `None` if no
    /// tolerance was given.
    pub choice: Option<&'a Choice>,
    /// Results computed so far, such as the pull-off force, for each preload and each profile.
    /// [`Results::OF_PRELOADS`] lists the quantities.
    pub results: &'a Results,
    /// Pull-off force of the first profile as a function of the preload; `None` for a report
    /// without a figure.
    pub staircase: Option<&'a Staircase>,
    /// True if the table has a row for each preload of the curve in [`Self::staircase`]. False if
    /// the table has a row for each combination of a preload and a profile.
    pub curves: bool,
}

impl<'a> PreloadReport<'a> {
    /// Returns the figure of two charts: the pull-off force over the preload, and its distribution
    /// over the profiles at the largest preload. Returns `None` if there is no [`Self::staircase`].
    /// If `has_values` is true, the legend also states two pull-off forces without a preload:
    /// F_a(d=0) after a loading that turns at first touch, and F_a(F=0) after a loading that turns
    /// at zero force.
    pub fn drawn(&self, has_values: bool) -> Option<Figure> {
        let staircase = self.staircase?;
        let spread = self.results.spread_of_adhesion();
        let chart = preload_chart(staircase, &spread, has_values);
        let beside = match spread.last() {
            Some((largest, _)) => distribution(self.results, *largest, None),
            None => None,
        };
        Some(preload_figure(self.title, chart, beside))
    }

    /// Returns true if there are several random profiles, so that the report states their
    /// statistics.
    fn is_mean(&self) -> bool {
        self.results.plan().lines > 1
    }

    /// Returns the seed of a profile; `None` if the profile of the scene is fixed.
    fn seed(&self, line: u64) -> Option<u64> {
        let plan = self.results.plan();
        plan.scene.seed().map(|_| plan.seed_of(line))
    }

    /// Returns the staircase if the user has asked for a table of the staircase.
    fn listed_staircase(&self) -> Option<&'a Staircase> {
        self.staircase.filter(|_| self.curves)
    }

    /// Adds a table of the statistics over the profiles, with a row for each preload.
    fn add_statistics(&self, sheet: &mut Sheet) {
        let header = [
            "preload F_n",
            "median F_a",
            "quartiles",
            "range",
            "mean",
            "95 % interval of the median",
        ];
        let mut rows = vec![header.map(String::from)];
        let spread = self.results.spread_of_adhesion();
        for (preload, statistics) in thinned(spread.iter(), MOST_ROWS) {
            let [lower, median, upper] = statistics.quartiles;
            let interval = match statistics.median_interval {
                Some(interval) => format_range(interval, 2, "N"),
                None => "-".to_owned(),
            };
            rows.push([
                format_quantity(*preload, "N"),
                format_rounded(median, 2, "N"),
                format_range((lower, upper), 2, "N"),
                format_range(statistics.range, 2, "N"),
                format_rounded(statistics.mean, 2, "N"),
                interval,
            ]);
        }
        sheet.table(&rows);
        if let Some(warning) = warning(&spread) {
            sheet.heading(&warning);
        }
    }

    /// Adds a table of the unloadings of the first profile, with a row for each preload.
    fn add_unloadings(&self, sheet: &mut Sheet) {
        let plan = self.results.plan();
        let cells: Vec<u64> = (0..plan.cells()).collect();
        let mut unloadings = Vec::new();
        for &cell in thinned(cells.iter(), MOST_ROWS) {
            let values = Results::OF_PRELOADS.map(|quantity| self.results.value(cell, 0, quantity));
            let [
                turning_indentation,
                pull_off_force,
                pull_off_indentation,
                energy,
            ] = values;
            unloadings.push(Unloading {
                turning_force: Some(plan.values(cell)[0]),
                turning_indentation,
                pull_off_force,
                pull_off_indentation,
                dissipated_energy: energy,
            });
        }
        unloadings_table(sheet, "preload F_n", "indentation", &unloadings);
    }
}

impl Report for PreloadReport<'_> {
    fn warnings(&self) -> Vec<String> {
        counted_texts(&self.results.all_warnings(), self.results.plan().lines)
    }

    fn text(&self) -> Option<String> {
        let plan = self.results.plan();
        let mut sheet = Sheet::default();
        sheet.paragraph(&plan.scene.title);
        let profiles = match plan.lines {
            1 => "one profile".to_owned(),
            count => format!("{} random profiles", grouped(count)),
        };
        let springs = counted(plan.scene.numerics.points, "spring");
        sheet.heading(&format!(
            "Adhesion against preload, {profiles} of {springs}"
        ));
        if self.is_mean() {
            self.add_statistics(&mut sheet);
        } else {
            self.add_unloadings(&mut sheet);
        }
        if let Some(choice) = self.choice {
            sheet.heading(&choice.sentence());
        }
        sentences_section(&mut sheet, &self.warnings());
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(PreloadJson::new(self)))
    }

    /// Returns a table with a row for each preload of the [`Self::staircase`] if [`Self::curves`]
    /// is true. Otherwise the table has a row for each combination of a preload and a profile.
    fn table(&self) -> Option<Table<'_>> {
        if let Some(staircase) = self.listed_staircase() {
            return Some(curve_table(self.results, staircase));
        }
        let lines = 0..self.results.plan().lines;
        let has_seeds = self.seed(0).is_some();
        Some(preload_table(self.results, lines, has_seeds))
    }

    fn figure(&self) -> Option<Figure> {
        self.drawn(true)
    }
}

/// JSON object of the pull-off force as a function of the preload, in SI units.
#[derive(Serialize)]
struct PreloadJson<'a> {
    warnings: Vec<String>,
    scene: &'a Scene,
    /// Statistics over the profiles at each preload; `None` for a single profile.
    mean: Option<Vec<SpreadJson>>,
    per_profile: Vec<ProfileJson<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    curves: Option<StaircaseJson<'a>>,
}

#[derive(Serialize)]
struct SpreadJson {
    preload: f64,
    pull_off_force: Statistics,
}

#[derive(Serialize)]
struct ProfileJson<'a> {
    seed: Option<u64>,
    preloads: Table<'a>,
}

#[derive(Serialize)]
struct StaircaseJson<'a> {
    first_touch: TurnJson,
    zero_force: TurnJson,
    preloads: Table<'a>,
}

/// Turning point of a loading without a preload: the force in N at which the loading turns, and the
/// pull-off force in N of the following unloading.
#[derive(Serialize)]
struct TurnJson {
    force: f64,
    pull_off_force: f64,
}

impl<'a> PreloadJson<'a> {
    fn new(report: &PreloadReport<'a>) -> Self {
        let results = report.results;
        let plan = results.plan();
        let mean = report.is_mean().then(|| {
            let spread = results.spread_of_adhesion().into_iter();
            spread
                .map(|(preload, pull_off_force)| SpreadJson {
                    preload,
                    pull_off_force,
                })
                .collect()
        });
        let mut per_profile = Vec::new();
        for line in 0..plan.lines {
            per_profile.push(ProfileJson {
                seed: report.seed(line),
                preloads: preload_table(results, line..line + 1, false),
            });
        }
        PreloadJson {
            warnings: counted_texts(&results.all_warnings(), plan.lines),
            scene: &plan.scene,
            mean,
            per_profile,
            curves: report
                .listed_staircase()
                .map(|staircase| StaircaseJson::new(results, staircase)),
        }
    }
}

impl<'a> StaircaseJson<'a> {
    fn new(results: &Results, staircase: &'a Staircase) -> Self {
        let (force, pull_off_force) = staircase.touch;
        StaircaseJson {
            first_touch: TurnJson {
                force,
                pull_off_force,
            },
            zero_force: TurnJson {
                force: 0.0,
                pull_off_force: staircase.zero_force,
            },
            preloads: curve_table(results, staircase),
        }
    }
}

/// Returns a figure of two charts. On the left is `chart`, the pull-off force over the preload (see
/// [`preload_chart`]). On the right is `beside`, the distribution of the pull-off force over the
/// profiles (see [`distribution`]).
pub fn preload_figure(title: &str, chart: Chart, beside: Option<Chart>) -> Figure {
    let Some(beside) = beside else {
        return Figure::of_chart(title, chart);
    };
    let chart = Chart {
        heading: Label::quantity("pull-off force", "F_a"),
        ..chart
    };
    Figure {
        title: title.to_owned(),
        charts: vec![chart, beside],
        size: Figure::SMALL,
        ..Figure::default()
    }
}

/// Row for one preload in the table of the curves of [`preload_chart`].
#[derive(Clone, Copy)]
struct StaircaseRow {
    preload: f64,
    pull_off_force: f64,
    /// Statistics over the profiles; `None` if they were not computed at this preload.
    statistics: Option<Statistics>,
}

/// Returns the curves of [`preload_chart`] as a table. It has a row for each preload of the
/// staircase. The row contains the statistics over the profiles if they were computed at this
/// preload.
fn curve_table<'a>(results: &Results, staircase: &'a Staircase) -> Table<'a> {
    let spread = results.spread_of_adhesion();
    let mut rows = Vec::with_capacity(staircase.forces.len());
    for &(preload, pull_off_force) in &staircase.forces {
        let known = spread.iter().find(|(known, _)| *known == preload);
        rows.push(StaircaseRow {
            preload,
            pull_off_force,
            statistics: known.map(|(_, statistics)| *statistics),
        });
    }
    let mut table = Table::of(move || rows.clone().into_iter())
        .real("preload", |row| row.preload)
        .real("pull_off_force", |row| row.pull_off_force)
        .whole("profiles", |row| {
            row.statistics
                .map_or(0, |statistics| statistics.count as u64)
        });
    for (ending, value) in Statistics::COLUMNS {
        table = table.real(ending, move |row| row.statistics.as_ref().and_then(value));
    }
    table.done()
}

/// Returns a warning if, at some preload, a single profile contributes more than half of the mean
/// pull-off force; otherwise `None`. `spread` has pairs of a preload in N and the statistics of the
/// pull-off force over the profiles.
pub fn warning(spread: &[(f64, Statistics)]) -> Option<String> {
    let (preload, statistics) = spread
        .iter()
        .max_by(|(_, first), (_, second)| largest_share(first).total_cmp(&largest_share(second)))?;
    let preload = format_quantity(*preload, "N");
    statistics.warning(&format!("F_a at F_n {preload}"))
}

fn largest_share(statistics: &Statistics) -> f64 {
    statistics.share_of_largest().unwrap_or(0.0)
}

/// Returns a table of the unloadings of the profiles `lines` from all preloads. If `has_seeds` is
/// true, the first column has the seeds of the profiles.
pub(crate) fn preload_table(results: &Results, lines: Range<u64>, has_seeds: bool) -> Table<'_> {
    let plan = results.plan();
    let rows = move || {
        lines
            .clone()
            .flat_map(move |line| (0..plan.cells()).map(move |cell| (cell, line)))
    };
    let mut table = Table::of(rows);
    if has_seeds {
        table = table.whole("seed", |(_, line)| plan.seed_of(*line));
    }
    table = table.real("preload", |(cell, _)| plan.values(*cell)[0]);
    for quantity in Results::OF_PRELOADS {
        table = table.real(quantity.name(), move |(cell, line)| {
            results.value(*cell, *line, quantity)
        });
    }
    table.done()
}

/// Unloading from a turning point, in SI units. A value that is not known is `None`.
pub(crate) struct Unloading {
    pub(crate) turning_force: Option<f64>,
    pub(crate) turning_indentation: Option<f64>,
    pub(crate) pull_off_force: Option<f64>,
    pub(crate) pull_off_indentation: Option<f64>,
    pub(crate) dissipated_energy: Option<f64>,
}

/// Adds a table of unloadings. `force` and `indentation` are the headings of the first columns,
/// which describe the turning point.
pub(crate) fn unloadings_table(
    sheet: &mut Sheet,
    force: &str,
    indentation: &str,
    unloadings: &[Unloading],
) {
    let header = [
        force,
        indentation,
        "pull-off force F_a",
        "pull-off at",
        "dissipated",
    ];
    let mut rows = vec![header.map(String::from)];
    for unloading in unloadings {
        rows.push([
            value_or_dash(unloading.turning_force, "N"),
            value_or_dash(unloading.turning_indentation, "m"),
            value_or_dash(unloading.pull_off_force, "N"),
            value_or_dash(unloading.pull_off_indentation, "m"),
            value_or_dash(unloading.dissipated_energy, "J"),
        ]);
    }
    sheet.table(&rows);
}

fn value_or_dash(value: Option<f64>, unit: &str) -> String {
    match value {
        Some(value) => format_quantity(value, unit),
        None => "-".to_owned(),
    }
}

/// Returns the chart of the pull-off force over the preload, for one profile (`staircase`) and for
/// the statistics over several profiles. `spread` has pairs of a preload in N and these statistics.
/// If `has_values` is true, the legend states the pull-off forces without a preload: F_a(d=0) after
/// a loading that turns at first touch, and F_a(F=0) after a loading that turns at zero force.
pub fn preload_chart(
    staircase: &Staircase,
    spread: &[(f64, Statistics)],
    has_values: bool,
) -> Chart {
    let mut layers = spread_layers(staircase, spread);
    let stroke = if spread.is_empty() {
        Stroke::Solid
    } else {
        Stroke::Dashed
    };
    let line = Shape::line(staircase.line(), stroke);
    layers.push(Layer::new("this profile".into(), Ink::Series(1), line));

    let x = preload_axis(staircase);
    layers.extend(turn_layers(staircase, x.span, has_values));
    let forces = forces_of(&layers);
    Chart::new(x, force_axis(staircase.scale, &forces), layers)
}

/// Returns layers with the statistics over the profiles at each preload: range, quartiles, mean and
/// median; empty without statistics.
fn spread_layers(staircase: &Staircase, spread: &[(f64, Statistics)]) -> Vec<Layer> {
    let Some((_, first)) = spread.first() else {
        return Vec::new();
    };
    let mut range = Vec::new();
    let mut quartiles = Vec::new();
    let mut mean = Vec::new();
    let mut median = Vec::new();
    for (preload, statistics) in steps(staircase, spread) {
        let (least, most) = statistics.range;
        let [lower, middle, upper] = statistics.quartiles;
        range.push((preload, least, most));
        quartiles.push((preload, lower, upper));
        mean.push((preload, statistics.mean));
        median.push((preload, middle));
    }
    let name_of_range = Label::plain(&format!("range of {} profiles", first.count));
    let mean = Shape::line(mean, Stroke::Dotted);
    let median = Shape::line(median, Stroke::Solid);
    vec![
        Layer::new(name_of_range, Ink::Quiet, Shape::Band(range)),
        Layer::new("quartiles".into(), Ink::Series(0), Shape::Band(quartiles)),
        Layer::new("mean".into(), Ink::Text, mean),
        Layer::new("median".into(), Ink::Series(0), median),
    ]
}

/// Returns the corners of the statistics as functions of the preload. They are drawn as a
/// staircase, in which each value is constant up to the next preload.
fn steps(staircase: &Staircase, spread: &[(f64, Statistics)]) -> Vec<(f64, Statistics)> {
    // The loading that turns at first touch has no preload and is left out.
    let (touch, _) = staircase.touch;
    let first_pressed = spread.partition_point(|(preload, _)| *preload <= touch);
    let pressed = &spread[first_pressed..];
    let mut steps: Vec<_> = pressed.first().copied().into_iter().collect();
    for pair in pressed.windows(2) {
        let (_, before) = pair[0];
        let (preload, after) = pair[1];
        if before != after {
            steps.push((preload, before));
        }
        steps.push((preload, after));
    }
    steps
}

fn preload_axis(staircase: &Staircase) -> ChartAxis {
    let scale = staircase.scale;
    let ends = [staircase.forces.first(), staircase.forces.last()];
    let coordinates = ends.map(|end| {
        let preload = end.map_or(f64::NAN, |(preload, _)| *preload);
        scale.coordinate(preload)
    });
    let span = Span::around(coordinates.into_iter(), 0.03);
    ChartAxis::new(scale, span, "preload", "F_n", "N")
}

/// Turning point of a loading without a preload. The chart marks it.
struct Turn {
    symbol: &'static str,
    protocol: &'static str,
    /// Force in N at which the loading turns.
    force: f64,
    /// Pull-off force in N of the unloading from this turning point.
    pull_off_force: f64,
    sign: Sign,
    ink: Ink,
}

/// Returns the marks of the loadings that turn at first touch and at zero force. `span` is the
/// range of the horizontal axis.
fn turn_layers(staircase: &Staircase, span: Span, has_values: bool) -> Vec<Layer> {
    let (touch, adhesion_at_touch) = staircase.touch;
    let turns = [
        Turn {
            symbol: "F_a(d=0)",
            protocol: "turned at first touch",
            force: touch,
            pull_off_force: adhesion_at_touch,
            sign: Sign::HollowDiamond,
            ink: Ink::Text,
        },
        Turn {
            symbol: "F_a(F=0)",
            protocol: "turned at zero force",
            force: 0.0,
            pull_off_force: staircase.zero_force,
            sign: Sign::Ring,
            ink: Ink::Text,
        },
    ];
    let mut layers = Vec::new();
    for turn in turns {
        let mut name = Label::symbol(turn.symbol);
        if has_values {
            let value = format_rounded(turn.pull_off_force, 3, "N");
            name = name.then(&format!(" {value},"));
        }
        let name = name.then(&format!(" {}", turn.protocol));
        // A force below the range of the axis, such as a negative force on a logarithmic axis, is
        // marked at the left end of the axis.
        let is_inside = staircase.scale.coordinate(turn.force) >= span.low;
        let force = if is_inside {
            turn.force
        } else {
            staircase.scale.number(span.low)
        };
        let mark = Shape::signs(vec![(force, turn.pull_off_force)], turn.sign);
        layers.push(Layer::new(name, turn.ink, mark));
    }
    layers
}

/// Returns all pull-off forces that layers show.
fn forces_of(layers: &[Layer]) -> Vec<f64> {
    let mut forces = Vec::new();
    for layer in layers {
        match &layer.shape {
            Shape::Curve { points, .. } => {
                forces.extend(points.iter().map(|(_, force)| *force));
            }
            Shape::Band(points) => {
                for &(_, low, high) in points {
                    forces.extend([low, high]);
                }
            }
            _ => {}
        }
    }
    forces
}

/// Returns the axis of pull-off forces. It is logarithmic if the preloads are on a logarithmic
/// scale and the largest force is much larger than the smallest. Otherwise it is linear and begins
/// at zero.
fn force_axis(scale_of_preloads: AxisScale, forces: &[f64]) -> ChartAxis {
    let above_zero = || forces.iter().copied().filter(|force| *force > 0.0);
    let least = above_zero().fold(f64::INFINITY, f64::min);
    let most = above_zero().fold(0.0, f64::max);
    let differ = most >= LOGARITHMIC_RATIO * least;
    let (scale, span) = if scale_of_preloads == AxisScale::Logarithmic && differ {
        let span = Span::of_values(AxisScale::Logarithmic, above_zero(), MOST_DECADES);
        (AxisScale::Logarithmic, span.widened(0.05))
    } else {
        let span = Span::around(forces.iter().copied().chain([0.0]), 0.05);
        (AxisScale::Linear, span)
    };
    ChartAxis::new(scale, span, "pull-off force", "F_a", "N")
}

/// Returns the chart of the cumulative distribution of the pull-off force over the profiles, at the
/// computed preload nearest to `preload` in N. `None` if there are fewer than two profiles.
/// `forces` is an axis of pull-off forces that becomes the vertical axis of the chart; with `None`,
/// the chart makes its own.
pub fn distribution(results: &Results, preload: f64, forces: Option<&ChartAxis>) -> Option<Chart> {
    let (preload, mut sorted) = results.forces_near(preload)?;
    if sorted.len() < 2 {
        return None;
    }
    let own = sorted[0];
    sorted.sort_by(f64::total_cmp);

    // Returns the share of a number of profiles among all profiles, in per cent.
    let share = |profiles: usize| 100.0 * profiles as f64 / sorted.len() as f64;
    let mut steps = Vec::with_capacity(2 * sorted.len());
    for (index, &force) in sorted.iter().enumerate() {
        steps.push((share(index), force));
        steps.push((share(index + 1), force));
    }
    let smaller = sorted.partition_point(|force| *force < own);
    let place = share(smaller) + 0.5 * share(1);
    let layers = vec![
        Layer::unnamed(Ink::Series(0), Shape::line(steps, Stroke::Solid)),
        Layer::unnamed(Ink::Series(1), Shape::signs(vec![(place, own)], Sign::Dot)),
    ];

    let span = Span {
        low: 0.0,
        high: 100.0,
    };
    let x = ChartAxis::new(AxisScale::Linear, span, "share of profiles in", "%", "1");
    let y = match forces {
        Some(axis) => axis.clone(),
        None => {
            let span = Span::around(sorted.iter().copied(), 0.05);
            ChartAxis::new(AxisScale::Linear, span, "pull-off force", "F_a", "N")
        }
    };
    let preload = format_rounded(preload, 3, "N");
    Some(Chart {
        heading: Label::plain(&format!("profiles at {preload}")),
        ..Chart::new(x, y, layers)
    })
}
