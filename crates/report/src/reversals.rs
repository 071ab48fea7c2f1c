//! Unloadings from many turning points of a scene (first-order reversal curves), as text, JSON,
//! tables and a figure.

use crate::preloads::{preload_chart, preload_table, unloadings};
use crate::report::{Json, Report};
use crate::sheet::{Sheet, thinned};
use crate::warnings::{warning_texts, warnings_section};
use asperity_data::{AxisScale, Table, Warning, grouped, object};
use asperity_plot::{Chart, ChartAxis, Figure, HeatMap, Ink, Label, Layer, Shades, Shape, Span};
use asperity_scene::Scene;
use asperity_scene::theory::ReversalMap;
use asperity_study::{Results, Staircase};

const MOST_ROWS: usize = 16;
/// Largest number of cells along either axis of a map in a figure.
const MOST_CELLS: usize = 128;

/// Report on the unloadings of one profile from many turning points, and on the Everett function. A
/// turning point is an indentation d_r at which the loading ends. For d_r and a smaller indentation
/// d the Everett function is E(d_r, d) = ½ (F(d_r) − F(d_r, d)). Here F(d_r) is the force at the
/// turning point, and F(d_r, d) is the force at d on the unloading from d_r.
#[derive(Clone, Copy, Debug)]
pub struct ReversalReport<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// Scene whose body is loaded and unloaded.
    pub scene: &'a Scene,
    /// Force F(d_r, d) along the unloading from each turning point d_r.
    pub map: &'a ReversalMap,
    /// Adhesion force as a function of the preload, in the quantities [`Results::OF_PRELOADS`];
    /// `None` if no preload presses the bodies together.
    pub preloads: Option<&'a Results>,
    /// Adhesion force of one profile as a function of the preload, for the figure; `None` leaves it
    /// out.
    pub staircase: Option<&'a Staircase>,
    /// Premises of the model that the deepest loading does not meet.
    pub warnings: &'a [Warning],
}

impl Report for ReversalReport<'_> {
    fn text(&self) -> Option<String> {
        let ReversalReport { scene, map, .. } = *self;
        let mut sheet = Sheet::default();
        sheet.paragraph(&scene.title);
        let reversals = &map.reversals;
        let (count, springs) = (
            grouped(reversals.len() as u64),
            grouped(scene.numerics.points),
        );
        sheet.heading(&format!(
            "{count} reversals of one loading, {springs} springs"
        ));
        let shown = thinned(reversals.iter(), MOST_ROWS);
        let shown = shown.map(|one| {
            let [at, pull_off] = [one.turn, one.smallest].map(|point| Some(point.indentation));
            [
                Some(one.turn.force),
                at,
                one.adhesion_force(),
                pull_off,
                Some(one.dissipated_energy),
            ]
        });
        unloadings(&mut sheet, ["force at turn", "turning at"], shown);
        sheet.heading("Map");
        sheet.quantity("step of indentations", map.step(), "m");
        let points = 0..map.points.len();
        let all =
            (0..reversals.len()).flat_map(|turn| points.clone().map(move |point| (turn, point)));
        let everett = all
            .filter_map(|(turn, point)| map.everett(turn, point))
            .reduce(f64::max);
        sheet.quantity("largest Everett value", everett, "N");
        warnings_section(&mut sheet, self.warnings);
        Some(sheet.into_text())
    }

    /// Returns, for each turning point, the force and the Everett function at the indentations up
    /// to this turning point.
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let ReversalReport {
            scene,
            map,
            preloads,
            ..
        } = *self;
        let rows = |value: &dyn Fn(usize, usize) -> Option<f64>| -> Vec<Vec<Option<f64>>> {
            let row = |turn: usize| {
                (0..=map.below + turn)
                    .map(|point| value(turn, point))
                    .collect()
            };
            (0..map.reversals.len()).map(row).collect()
        };
        Some(Box::new(object! {
            "scene": scene,
            "warnings": warning_texts(self.warnings),
            "preloads": preloads.map_or_else(
                || Table::of(std::iter::empty::<()>).done(),
                |results| preload_table(results, 0..1, false),
            ),
            "reversals": turning_points(map),
            "indentations": &map.points,
            "step": map.step(),
            "forces": map.reversals.iter().map(|reversal| reversal.forces.as_slice()).collect::<Vec<_>>(),
            "everett": rows(&|turn, point| map.everett(turn, point)),
        }))
    }

    fn table(&self) -> Option<Table<'_>> {
        Some(turning_points(self.map))
    }

    /// Returns a figure with a heat map of the Everett function, and before it a chart of the
    /// adhesion force over the preload if [`Self::staircase`] is given.
    fn figure(&self) -> Option<Figure> {
        let adhesion = self.staircase.map(|staircase| Chart {
            heading: Label::quantity("adhesion force", "F_a"),
            ..preload_chart(staircase, &[], true)
        });
        let charts = adhesion
            .into_iter()
            .chain([everett_chart(self.map)])
            .collect();
        Some(Figure {
            title: self.title.to_owned(),
            charts,
            size: Figure::SMALL,
            ..Figure::default()
        })
    }
}

fn turning_points(map: &ReversalMap) -> Table<'_> {
    Table::of(|| map.reversals.iter())
        .real("turning_indentation", |one| one.turn.indentation)
        .real("turning_force", |one| one.turn.force)
        .real("adhesion_force", |one| one.adhesion_force())
        .real("pull_off_indentation", |one| one.smallest.indentation)
        .real("separation", |one| one.separation)
        .real("dissipated_energy", |one| one.dissipated_energy)
        .done()
}

/// Returns a heat map of the Everett function E(d_r, d) in N, over the indentation d and the
/// turning point d_r. [`ReversalReport`] defines the function.
pub fn everett_chart(map: &ReversalMap) -> Chart {
    // A subset of the points of a fine map: the eye cannot distinguish more cells.
    let every = |count: usize| {
        (0..count)
            .step_by(count.div_ceil(MOST_CELLS).max(1))
            .collect::<Vec<_>>()
    };
    let (columns, rows) = (every(map.points.len()), every(map.reversals.len()));
    let values: Vec<Option<f64>> = rows
        .iter()
        .flat_map(|&turn| columns.iter().map(move |&point| map.everett(turn, point)))
        .collect();
    let key = Span::around(values.iter().flatten().copied(), 0.0);
    let of = |indices: &[usize], offset: usize| {
        indices
            .iter()
            .map(|&index| map.points[offset + index])
            .collect::<Vec<f64>>()
    };
    let (columns, rows) = (of(&columns, 0), of(&rows, map.below));
    let scale = AxisScale::Linear;
    let axis = |values: &[f64], name, symbol| {
        ChartAxis::new(scale, HeatMap::span(scale, values), name, symbol, "m")
    };
    let (x, y) = (
        axis(&columns, "indentation", "d"),
        axis(&rows, "turning point", "d_r"),
    );
    let map = HeatMap {
        columns,
        rows,
        values,
        key: ChartAxis::new(scale, key, "", "E", "N"),
        shades: Shades::Sequential,
        classes: Vec::new(),
        class_names: Vec::new(),
        contour: None,
    };
    let layers = vec![Layer::unnamed(Ink::Text, Shape::Map(Box::new(map)))];
    Chart {
        heading: Label::quantity("Everett function", "E"),
        ..Chart::new(x, y, layers)
    }
}
