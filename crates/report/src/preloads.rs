//! The adhesion force against the preload as text, JSON, tables and a figure.

use crate::report::{Json, Report};
use crate::sheet::{Sheet, thinned};
use crate::warnings::{counted_section, counted_texts};
use asperity_data::{
    AxisScale, Kind, Table, format_quantity, format_range, format_rounded, grouped, object,
};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke};
use asperity_scene::discretisation::Choice;
use asperity_study::{Results, Staircase, Statistics};
use std::ops::Range;

const MOST_ROWS: usize = 32;
/// Heading of a column with confidence intervals of the median.
const MEDIAN_INTERVAL: &str = "95 % interval of the median";

/// Report on the adhesion force as a function of the preload, for one or more random profiles.
#[derive(Clone, Copy, Debug)]
pub struct PreloadReport<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// How the number of springs was chosen so that the error is within a tolerance; `None` if no
    /// tolerance was given.
    pub choice: Option<&'a Choice>,
    /// Values computed so far for each preload on each profile: the quantities
    /// [`Results::OF_PRELOADS`].
    pub results: &'a Results,
    /// Adhesion force of the first profile as a function of the preload. If it is `None`, there is
    /// no figure.
    pub staircase: Option<&'a Staircase>,
    /// True for a table with a row for each preload of the [`Self::staircase`]; false for a row for
    /// each preload on each profile.
    pub curves: bool,
}

impl PreloadReport<'_> {
    /// Returns the figure with the [`preload_chart`] and the [`distribution`] at the largest
    /// preload; `None` without a [`Self::staircase`]. If `has_values` is true, the legend has the
    /// values of F_a(d=0) and F_a(F=0).
    pub fn drawn(&self, has_values: bool) -> Option<Figure> {
        let (staircase, spread) = (self.staircase?, self.results.spread_of_adhesion());
        let chart = preload_chart(staircase, &spread, has_values);
        let largest = spread.last().map(|(preload, _)| *preload);
        let beside = largest.and_then(|preload| distribution(self.results, preload, None));
        Some(preload_figure(self.title, chart, beside))
    }

    fn is_mean(&self) -> bool {
        self.results.plan().lines > 1
    }

    fn seed(&self, line: u64) -> Option<u64> {
        let plan = self.results.plan();
        plan.scene.seed().map(|_| plan.seed_of(line))
    }
}

impl Report for PreloadReport<'_> {
    fn text(&self) -> Option<String> {
        let plan = self.results.plan();
        let mut sheet = Sheet::default();
        sheet.paragraph(&plan.scene.title);
        let profiles = match plan.lines {
            1 => "one profile".to_owned(),
            count => format!("{} random profiles", grouped(count)),
        };
        let springs = grouped(plan.scene.numerics.points);
        sheet.heading(&format!(
            "Adhesion against preload, {profiles} of {springs} springs"
        ));
        if self.is_mean() {
            let header = [
                "preload F_n",
                "median F_a",
                "quartiles",
                "range",
                "mean",
                MEDIAN_INTERVAL,
            ];
            let range = |ends| format_range(ends, 2, "N");
            let spread = self.results.spread_of_adhesion();
            let rows = thinned(spread.iter(), MOST_ROWS).map(|(preload, all)| {
                let [lower, median, upper] = all.quartiles;
                let [median, mean] = [median, all.mean].map(|force| format_rounded(force, 2, "N"));
                let [quartiles, ends] = [(lower, upper), all.range].map(range);
                let of_median = all.median_interval.map_or_else(|| "-".to_owned(), range);
                [
                    format_quantity(*preload, "N"),
                    median,
                    quartiles,
                    ends,
                    mean,
                    of_median,
                ]
            });
            sheet.table(
                &std::iter::once(header.map(String::from))
                    .chain(rows)
                    .collect::<Vec<_>>(),
            );
            if let Some(warning) = warning(&spread) {
                sheet.heading(&warning);
            }
        } else {
            let cells: Vec<u64> = (0..plan.cells()).collect();
            let rows = thinned(cells.iter(), MOST_ROWS).map(|&cell| {
                let [at, force, pull_off, energy] =
                    Results::OF_PRELOADS.map(|quantity| self.results.value(cell, 0, quantity));
                [Some(plan.values(cell)[0]), at, force, pull_off, energy]
            });
            unloadings(&mut sheet, ["preload F_n", "indentation"], rows);
        }
        if let Some(choice) = self.choice {
            sheet.heading(&choice.sentence());
        }
        counted_section(&mut sheet, &self.results.all_warnings(), plan.lines);
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let plan = self.results.plan();
        let spread =
            |(preload, statistics)| object! { "preload": preload, "adhesion_force": statistics };
        let spread = || {
            self.results
                .spread_of_adhesion()
                .into_iter()
                .map(spread)
                .collect::<Vec<_>>()
        };
        let line = |line| {
            object! { "seed": self.seed(line), "preloads": preload_table(self.results, line..line + 1, false) }
        };
        let curves = self.staircase.filter(|_| self.curves).map(|staircase| {
            let (force, adhesion) = staircase.touch;
            object! {
                "first_touch": object! { "force": force, "adhesion_force": adhesion },
                "zero_force": object! { "force": 0.0, "adhesion_force": staircase.zero_force },
                "preloads": curve_table(self.results, staircase),
            }
        });
        Some(Box::new(object! {
            "warnings": counted_texts(&self.results.all_warnings(), plan.lines),
            "scene": &plan.scene,
            "mean": self.is_mean().then(spread),
            "lines": (0..plan.lines).map(line).collect::<Vec<_>>(),
            "curves"?: curves,
        }))
    }

    /// Returns a table with a row for each preload on each profile, or for each preload of the
    /// [`Self::staircase`] if [`Self::curves`] is true.
    fn table(&self) -> Option<Table<'_>> {
        Some(match self.staircase.filter(|_| self.curves) {
            Some(staircase) => curve_table(self.results, staircase),
            None => preload_table(
                self.results,
                0..self.results.plan().lines,
                self.seed(0).is_some(),
            ),
        })
    }

    fn figure(&self) -> Option<Figure> {
        self.drawn(true)
    }
}

/// Returns the figure of `chart`, a [`preload_chart`], with `beside`, a [`distribution`], on its
/// right.
pub fn preload_figure(title: &str, chart: Chart, beside: Option<Chart>) -> Figure {
    let Some(beside) = beside else {
        return Figure::of_chart(title, chart);
    };
    let chart = Chart {
        heading: Label::quantity("adhesion force", "F_a"),
        ..chart
    };
    let (title, charts) = (title.to_owned(), vec![chart, beside]);
    Figure {
        title,
        charts,
        size: Figure::SMALL,
        ..Figure::default()
    }
}

/// Returns the curves of [`preload_chart`] as a table, with one row for each preload of the
/// staircase and the known statistics.
fn curve_table<'a>(results: &Results, staircase: &'a Staircase) -> Table<'a> {
    let spread = results.spread_of_adhesion();
    let row = move |&(preload, force): &(f64, f64)| {
        let known = spread
            .iter()
            .find(|(at, _)| *at == preload)
            .map(|(_, all)| *all);
        (preload, force, known)
    };
    let rows: Vec<(f64, f64, Option<Statistics>)> = staircase.forces.iter().map(row).collect();
    let mut table = Table::of(move || rows.clone().into_iter())
        .real("preload", |row| row.0)
        .real("adhesion_force", |row| row.1)
        .with("profiles", Kind::Whole, |row| {
            row.2.map_or(0, |all| all.count as u64)
        });
    for (ending, of) in Statistics::COLUMNS {
        table = table.real(ending, move |row| row.2.as_ref().and_then(of));
    }
    table.done()
}

/// Returns a warning if, at some preload, a single profile contributes more than half of the mean
/// adhesion force; otherwise `None`. `spread` has pairs of a preload in N and the statistics of the
/// adhesion force over the profiles.
pub fn warning(spread: &[(f64, Statistics)]) -> Option<String> {
    let share = |(_, all): &&(f64, Statistics)| all.share_of_largest().unwrap_or(0.0);
    let (preload, most) = spread
        .iter()
        .max_by(|one, other| share(one).total_cmp(&share(other)))?;
    most.warning(&format!("F_a at F_n {}", format_quantity(*preload, "N")))
}

/// Returns a table of the unloadings from all preloads on these profiles, with seeds if they are
/// `seeded`.
pub(crate) fn preload_table(results: &Results, lines: Range<u64>, seeded: bool) -> Table<'_> {
    let plan = results.plan();
    let rows = move || {
        lines
            .clone()
            .flat_map(move |line| (0..plan.cells()).map(move |cell| (cell, line)))
    };
    let mut table = Table::of(rows);
    if seeded {
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

/// Writes a table of unloadings. Its first columns have these headings for force and indentation at
/// the turning point. Adhesion force, indentation at pull-off and dissipated energy follow.
pub(crate) fn unloadings(
    sheet: &mut Sheet,
    [force, at]: [&str; 2],
    rows: impl Iterator<Item = [Option<f64>; 5]>,
) {
    let header = [force, at, "adhesion force F_a", "pull-off at", "dissipated"].map(String::from);
    let units = ["N", "m", "N", "m", "J"];
    let row = |row: [Option<f64>; 5]| {
        let mut units = units.into_iter();
        row.map(|value| {
            let unit = units.next().unwrap_or_default();
            value.map_or("-".to_owned(), |value| format_quantity(value, unit))
        })
    };
    sheet.table(
        &std::iter::once(header)
            .chain(rows.map(row))
            .collect::<Vec<_>>(),
    );
}

/// Smallest ratio of adhesion forces that are drawn on a logarithmic scale.
const LOGARITHMIC_RATIO: f64 = 30.0;
const MOST_DECADES: f64 = 6.0;

/// Returns the chart of the adhesion force over the preload, for one profile (`staircase`) and for
/// the statistics over several profiles. `spread` has pairs of a preload in N and these statistics.
/// If `has_values` is true, the legend has the values of F_a(d=0) and F_a(F=0).
pub fn preload_chart(
    staircase: &Staircase,
    spread: &[(f64, Statistics)],
    has_values: bool,
) -> Chart {
    let mut layers = Vec::new();
    let (touch, at_touch) = staircase.touch;
    // The first row is the turn at first touch, without a preload. Values are constant from each
    // preload to the next, as in a staircase.
    let pressed = &spread[spread.partition_point(|(preload, _)| *preload <= touch)..];
    let corner = |pair: &[(f64, Statistics)]| {
        let level = (pair[0].1 != pair[1].1).then_some((pair[1].0, pair[0].1));
        level.into_iter().chain([pair[1]])
    };
    let steps = || {
        pressed
            .first()
            .copied()
            .into_iter()
            .chain(pressed.windows(2).flat_map(corner))
    };
    if let Some((_, Statistics { count, .. })) = spread.first() {
        let band = |ends: fn(&Statistics) -> (f64, f64)| {
            Shape::Band(
                steps()
                    .map(|(preload, all)| (preload, ends(&all).0, ends(&all).1))
                    .collect(),
            )
        };
        let curve = |of: fn(&Statistics) -> f64, stroke| {
            Shape::line(
                steps().map(|(preload, all)| (preload, of(&all))).collect(),
                stroke,
            )
        };
        let range = format!("range of {count} profiles");
        for (name, ink, shape) in [
            (range.as_str(), Ink::Quiet, band(|all| all.range)),
            (
                "quartiles",
                Ink::Surface,
                band(|all| (all.quartiles[0], all.quartiles[2])),
            ),
            ("mean", Ink::Text, curve(|all| all.mean, Stroke::Dotted)),
            (
                "median",
                Ink::Surface,
                curve(|all| all.quartiles[1], Stroke::Solid),
            ),
        ] {
            layers.push(Layer::new(Label::plain(name), ink, shape));
        }
    }
    let stroke = if spread.is_empty() {
        Stroke::Solid
    } else {
        Stroke::Dashed
    };
    let line = Shape::line(staircase.line(), stroke);
    layers.push(Layer::new("this profile".into(), Ink::Unloading, line));

    let scale = staircase.scale;
    let ends = [staircase.forces.first(), staircase.forces.last()]
        .map(|end| end.map_or(f64::NAN, |end| end.0));
    let x = Span::around(ends.into_iter().map(|end| scale.coordinate(end)), 0.03);
    // A force below the axis, as below zero on a logarithmic one, is marked at its left end.
    let inside = |force: f64| {
        if scale.coordinate(force) >= x.low {
            force
        } else {
            scale.number(x.low)
        }
    };
    for (symbol, protocol, force, adhesion, sign, ink) in [
        (
            "F_a(d=0)",
            "turned at first touch",
            touch,
            at_touch,
            Sign::HollowDiamond,
            Ink::Loading,
        ),
        (
            "F_a(F=0)",
            "turned at zero force",
            0.0,
            staircase.zero_force,
            Sign::Ring,
            Ink::Manual,
        ),
    ] {
        let value = if has_values {
            format!(" {},", format_rounded(adhesion, 3, "N"))
        } else {
            String::new()
        };
        let name = Label::symbol(symbol).then(&format!("{value} {protocol}"));
        layers.push(Layer::new(
            name,
            ink,
            Shape::signs(vec![(inside(force), adhesion)], sign),
        ));
    }

    let each = |layer: &Layer| match &layer.shape {
        Shape::Curve { points, .. } => points.iter().map(|point| point.1).collect(),
        Shape::Band(points) => points
            .iter()
            .flat_map(|&(_, low, high)| [low, high])
            .collect::<Vec<_>>(),
        _ => Vec::new(),
    };
    let forces: Vec<f64> = layers.iter().flat_map(each).collect();
    let above_zero = || forces.iter().copied().filter(|force| *force > 0.0);
    let (least, most) = (
        above_zero().fold(f64::INFINITY, f64::min),
        above_zero().fold(0.0, f64::max),
    );
    let (y_scale, y) = if scale == AxisScale::Logarithmic && most >= LOGARITHMIC_RATIO * least {
        let y = Span::of_values(AxisScale::Logarithmic, above_zero(), MOST_DECADES);
        (AxisScale::Logarithmic, y.widened(0.05))
    } else {
        (
            AxisScale::Linear,
            Span::around(forces.iter().copied().chain([0.0]), 0.05),
        )
    };
    Chart::new(
        ChartAxis::new(scale, x, "preload", "F_n", "N"),
        ChartAxis::new(y_scale, y, "adhesion force", "F_a", "N"),
        layers,
    )
}

/// Returns the chart of the cumulative distribution of the adhesion force over the profiles, at the
/// computed preload nearest to `preload` in N; `None` for fewer than two profiles. If `forces`, an
/// axis of adhesion forces, is given, it is the vertical axis of the chart.
pub fn distribution(results: &Results, preload: f64, forces: Option<&ChartAxis>) -> Option<Chart> {
    let (preload, mut each) = results.forces_near(preload)?;
    let own = each.first().copied().filter(|_| each.len() > 1)?;
    each.sort_by(f64::total_cmp);
    let share = |index: usize| 100.0 * index as f64 / each.len() as f64;
    let steps = each.iter().enumerate();
    let steps =
        steps.flat_map(|(index, &force)| [(share(index), force), (share(index + 1), force)]);
    let place = share(each.partition_point(|force| *force < own)) + 0.5 * share(1);
    let layers = vec![
        Layer::unnamed(Ink::Surface, Shape::line(steps.collect(), Stroke::Solid)),
        Layer::unnamed(Ink::Unloading, Shape::signs(vec![(place, own)], Sign::Dot)),
    ];
    let heading = format!("profiles at {}", format_rounded(preload, 3, "N"));
    let x = ChartAxis::new(
        AxisScale::Linear,
        Span {
            low: 0.0,
            high: 100.0,
        },
        "share of profiles in",
        "%",
        "1",
    );
    let own = || {
        let y = Span::around(each.iter().copied(), 0.05);
        ChartAxis::new(AxisScale::Linear, y, "adhesion force", "F_a", "N")
    };
    let y = forces.cloned().unwrap_or_else(own);
    Some(Chart {
        heading: Label::plain(&heading),
        ..Chart::new(x, y, layers)
    })
}
