//! Unloadings from many turning points of a scene (first-order reversal curves), as text, JSON,
//! tables and a figure.

use crate::preloads::{Unloading, preload_chart, preload_table, unloadings_table};
use crate::report::{Json, Report};
use crate::sheet::{Sheet, thinned};
use crate::warnings::{sentences_section, warning_texts};
use asperity_data::{AxisScale, Table, Warning, counted};
use asperity_plot::{Chart, ChartAxis, Figure, HeatMap, Ink, Label, Layer, Shades, Shape, Span};
use asperity_scene::Scene;
use asperity_scene::theory::ReversalMap;
use asperity_study::{Results, Staircase};
use serde::Serialize;

/// Largest number of rows of a table in the text report.
const MOST_ROWS: usize = 16;

/// Largest number of cells of a heat map along each of its axes.
const MOST_CELLS: usize = 128;

/// Report on the unloadings of one profile from many turning points, and on the Everett function. A
/// turning point is an indentation d_r at which the loading ends. For d_r and a smaller indentation
/// d the Everett function is E(d_r, d) = ½ (F(d_r) − F(d_r, d)). Here F(d_r) is the force at the
/// turning point, and F(d_r, d) is the force at d on the unloading from d_r.
#[derive(Clone, Copy, Debug)]
pub struct ReversalReport<'a> {
    pub title: &'a str,
    /// Scene whose body is loaded and unloaded.
    pub scene: &'a Scene,
    /// Forces of the unloadings. The map has the force F(d_r, d) at the indentation d on the
    /// unloading from each turning point d_r, the indentation at which a loading ends.
    pub map: &'a ReversalMap,
    /// Pull-off force and other quantities of the unloading ([`Results::OF_PRELOADS`]) as functions
    /// of the preload; `None` if no preload presses the bodies together.
    pub preloads: Option<&'a Results>,
    /// Pull-off force of one profile as a function of the preload, for the figure; `None` for a
    /// figure without this curve.
    pub staircase: Option<&'a Staircase>,
    /// Premises of the model that the deepest loading does not meet.
    pub warnings: &'a [Warning],
}

impl Report for ReversalReport<'_> {
    fn warnings(&self) -> Vec<String> {
        warning_texts(self.warnings)
    }

    fn text(&self) -> Option<String> {
        let reversals = &self.map.reversals;
        let mut sheet = Sheet::default();
        sheet.paragraph(&self.scene.title);
        let count = counted(reversals.len() as u64, "reversal");
        let springs = counted(self.scene.numerics.points, "spring");
        sheet.heading(&format!("{count} of one loading, {springs}"));
        let mut unloadings = Vec::new();
        for reversal in thinned(reversals.iter(), MOST_ROWS) {
            unloadings.push(Unloading {
                turning_force: Some(reversal.turn.force),
                turning_indentation: Some(reversal.turn.indentation),
                pull_off_force: reversal.pull_off_force(),
                pull_off_indentation: Some(reversal.smallest.indentation),
                dissipated_energy: Some(reversal.dissipated_energy),
            });
        }
        unloadings_table(&mut sheet, "force at turn", "turning at", &unloadings);
        sheet.heading("Map");
        sheet.quantity("step of indentations", self.map.step(), "m");
        sheet.quantity("largest Everett value", largest_everett(self.map), "N");
        sentences_section(&mut sheet, &self.warnings());
        Some(sheet.into_text())
    }

    /// Returns for each turning point the force and the Everett function at all indentations that
    /// are not above this turning point.
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(ReversalJson::new(self)))
    }

    fn table(&self) -> Option<Table<'_>> {
        Some(turning_points(self.map))
    }

    /// Returns a figure with a heat map of the Everett function. If there is a [`Self::staircase`],
    /// the figure begins with a chart of the pull-off force over the preload.
    fn figure(&self) -> Option<Figure> {
        let mut charts = Vec::new();
        if let Some(staircase) = self.staircase {
            charts.push(Chart {
                heading: Label::quantity("pull-off force", "F_a"),
                ..preload_chart(staircase, &[], true)
            });
        }
        charts.push(everett_chart(self.map));
        Some(Figure {
            title: self.title.to_owned(),
            charts,
            size: Figure::SMALL,
            ..Figure::default()
        })
    }
}

/// JSON object of the unloadings from many turning points, in SI units.
#[derive(Serialize)]
struct ReversalJson<'a> {
    scene: &'a Scene,
    warnings: Vec<String>,
    preloads: Table<'a>,
    reversals: Table<'a>,
    indentations: &'a [f64],
    step: f64,
    /// For each turning point, the forces in N at the indentations of the unloading.
    forces: Vec<&'a [f64]>,
    /// For each turning point, the values in N of the Everett function at the indentations of the
    /// unloading.
    everett: Vec<Vec<Option<f64>>>,
}

impl<'a> ReversalJson<'a> {
    fn new(report: &ReversalReport<'a>) -> Self {
        let map = report.map;
        let preloads = match report.preloads {
            Some(results) => preload_table(results, 0..1, false),
            None => Table::of(std::iter::empty::<()>).done(),
        };
        let mut forces = Vec::with_capacity(map.reversals.len());
        let mut everett = Vec::with_capacity(map.reversals.len());
        for (turn, reversal) in map.reversals.iter().enumerate() {
            forces.push(reversal.forces.as_slice());
            let points = 0..=map.below + turn;
            everett.push(points.map(|point| map.everett(turn, point)).collect());
        }
        ReversalJson {
            scene: report.scene,
            warnings: warning_texts(report.warnings),
            preloads,
            reversals: turning_points(map),
            indentations: &map.points,
            step: map.step(),
            forces,
            everett,
        }
    }
}

/// Returns the largest value of the Everett function in N; `None` if no value is known.
fn largest_everett(map: &ReversalMap) -> Option<f64> {
    let mut largest: Option<f64> = None;
    for turn in 0..map.reversals.len() {
        for point in 0..map.points.len() {
            if let Some(value) = map.everett(turn, point) {
                largest = Some(largest.map_or(value, |largest| largest.max(value)));
            }
        }
    }
    largest
}

fn turning_points(map: &ReversalMap) -> Table<'_> {
    Table::of(|| map.reversals.iter())
        .real("turning_indentation", |reversal| reversal.turn.indentation)
        .real("turning_force", |reversal| reversal.turn.force)
        .real("pull_off_force", |reversal| reversal.pull_off_force())
        .real("pull_off_indentation", |reversal| {
            reversal.smallest.indentation
        })
        .real("separation", |reversal| reversal.separation)
        .real("dissipated_energy", |reversal| reversal.dissipated_energy)
        .done()
}

/// Returns a heat map of the Everett function E(d_r, d) in N, over the indentation d and the
/// turning point d_r. With the force F(d_r) at the turning point and the force F(d_r, d) at d on
/// the unloading from the turning point, the function is ½ (F(d_r) − F(d_r, d)).
pub fn everett_chart(map: &ReversalMap) -> Chart {
    let points = drawn_indices(map.points.len());
    let turns = drawn_indices(map.reversals.len());
    let mut values = Vec::with_capacity(points.len() * turns.len());
    for &turn in &turns {
        for &point in &points {
            values.push(map.everett(turn, point));
        }
    }
    let columns: Vec<f64> = points.iter().map(|&point| map.points[point]).collect();
    let rows: Vec<f64> = turns.iter().map(|&turn| map.turns()[turn]).collect();

    let scale = AxisScale::Linear;
    let span = HeatMap::span(scale, &columns);
    let x = ChartAxis::new(scale, span, "indentation", "d", "m");
    let span = HeatMap::span(scale, &rows);
    let y = ChartAxis::new(scale, span, "turning point", "d_r", "m");
    let span = Span::around(values.iter().flatten().copied(), 0.0);
    let heat_map = HeatMap {
        columns,
        rows,
        values,
        key: ChartAxis::new(scale, span, "", "E", "N"),
        shades: Shades::Sequential,
        classes: Vec::new(),
        class_names: Vec::new(),
        contour: None,
    };
    let layer = Layer::unnamed(Ink::Text, Shape::Map(Box::new(heat_map)));
    Chart {
        heading: Label::quantity("Everett function", "E"),
        ..Chart::new(x, y, vec![layer])
    }
}

/// Returns the indices of the turning points, or of the indentations, that a heat map shows. If
/// there are more than [`MOST_CELLS`], some are left out, because the figure could not show them
/// separately.
fn drawn_indices(count: usize) -> Vec<usize> {
    let step = count.div_ceil(MOST_CELLS).max(1);
    (0..count).step_by(step).collect()
}
