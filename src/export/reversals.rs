//! First-order reversal curves of a scene as text, JSON, tables and a figure.

use super::preloads::{preload_chart, preload_table, unloadings};
use super::report::{Json, Report};
use super::sheet::{Sheet, thinned};
use crate::analysis::{MinorLoops, ReversalMap};
use crate::draw::{Axis, AxisScale, Chart, Figure, HeatMap, Ink, Label, Layer, Shades, Shape, Span};
use crate::io::{Table, object};
use crate::scene::{Scene, format_quantity};
use crate::study::{Results, Staircase};
use crate::text::grouped;

const MOST_ROWS: usize = 16;
/// Most cells of a map on either axis of a figure.
const MOST_CELLS: usize = 128;

/// Default number of steps on either side over which the density is fitted.
pub const SMOOTHING: usize = 3;

/// Reversals of a scene, their minor loops, and the smoothing of the density.
#[derive(Clone, Copy, Debug)]
pub struct ReversalReport<'a> {
    pub title: &'a str,
    pub scene: &'a Scene,
    pub map: &'a ReversalMap,
    /// Adhesion against preload, with the records of [`Results::OF_PRELOADS`], if a preload presses the bodies together.
    pub preloads: Option<&'a Results>,
    /// The same with the exact place of each step, for the figure.
    pub staircase: Option<&'a Staircase>,
    /// Minor loops, if they were compared.
    pub loops: Option<MinorLoops>,
    /// Steps on either side over which the density is fitted.
    pub smoothing: usize,
    /// True for a table with a row for each point of the map instead of each turning point.
    pub map_table: bool,
}

fn congruency(loops: MinorLoops) -> String {
    let MinorLoops { with_loss, incongruent } = loops;
    match loops.incongruent_share() {
        Some(share) => format!(
            "{} of {} minor loops with loss ({})",
            grouped(incongruent as u64),
            grouped(with_loss as u64),
            format_quantity(share, "1")
        ),
        None => "no minor loop dissipates".to_owned(),
    }
}

impl Report for ReversalReport<'_> {
    fn text(&self) -> Option<String> {
        let ReversalReport { scene, map, loops, smoothing, .. } = *self;
        let mut sheet = Sheet::default();
        sheet.paragraph(&scene.title);
        let reversals = &map.reversals;
        let (count, springs) = (grouped(reversals.len() as u64), grouped(scene.numerics.points));
        sheet.heading(&format!("{count} reversals of one loading, {springs} springs"));
        let shown = thinned(reversals.iter(), MOST_ROWS);
        let shown = shown.map(|one| {
            let [at, pull_off] = [one.turn, one.smallest].map(|point| Some(point.indentation));
            [Some(one.turn.force), at, one.adhesion_force(), pull_off, Some(one.dissipated_energy)]
        });
        unloadings(&mut sheet, ["force at turn", "turning at"], shown);
        sheet.heading("Map");
        sheet.quantity("step of indentations", map.step(), "m");
        let points = 0..map.points.len();
        let all = (0..reversals.len()).flat_map(|turn| points.clone().map(move |point| (turn, point)));
        let everett = all.filter_map(|(turn, point)| map.everett(turn, point)).reduce(f64::max);
        sheet.quantity("largest Everett value", everett, "N");
        sheet.row("density", format!("quadratic fit, {smoothing} steps on either side"));
        sheet.row_of("incongruent", loops.map(congruency));
        Some(sheet.into_text())
    }

    /// For each turning point the forces at the indentations of the columns up to that point, the Everett function and
    /// the density.
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let ReversalReport { scene, map, preloads, loops, smoothing, .. } = *self;
        let rows = |value: &dyn Fn(usize, usize) -> Option<f64>| -> Vec<Vec<Option<f64>>> {
            let row = |turn: usize| (0..=map.below + turn).map(|point| value(turn, point)).collect();
            (0..map.reversals.len()).map(row).collect()
        };
        Some(Box::new(object! {
            "scene": scene,
            "preloads": preloads.map_or_else(
                || Table::of(std::iter::empty::<()>).done(),
                |results| preload_table(results, 0..1, false),
            ),
            "reversals": turning_points(map),
            "indentations": &map.points,
            "step": map.step(),
            "smoothing": smoothing,
            "forces": map.reversals.iter().map(|reversal| reversal.forces.as_slice()).collect::<Vec<_>>(),
            "everett": rows(&|turn, point| map.everett(turn, point)),
            "density": rows(&|turn, point| map.density(turn, point, smoothing)),
            "minor_loops": loops.map(|loops| object! {
                "with_loss": loops.with_loss,
                "incongruent": loops.incongruent,
                "incongruent_share": loops.incongruent_share(),
            }),
        }))
    }

    fn table(&self) -> Option<Table<'_>> {
        Some(if self.map_table { points(self.map, self.smoothing) } else { turning_points(self.map) })
    }

    /// The adhesion force over the preload, the Everett function and the density.
    fn figure(&self) -> Option<Figure> {
        let ReversalReport { map, loops, smoothing, .. } = *self;
        let mut notes =
            vec![Label::plain(&format!("density: quadratic fit, {smoothing} steps on either side"))];
        notes.extend(loops.map(|loops| Label::plain(&format!("incongruent: {}", congruency(loops)))));
        let adhesion = self.staircase.map(|staircase| Chart {
            heading: Label::quantity("adhesion force", "F_a"),
            ..preload_chart(staircase, &[], true)
        });
        let maps = [everett_chart(map), density_chart(map, smoothing)];
        let (title, charts) = (self.title.to_owned(), adhesion.into_iter().chain(maps).collect());
        Some(Figure { title, notes, charts, size: Figure::SMALL, ..Figure::default() })
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

/// One row for each turning point and each indentation up to that point.
fn points(map: &ReversalMap, smoothing: usize) -> Table<'_> {
    let points = || {
        let turns = 0..map.turns().len();
        turns.flat_map(|turn| (0..=map.below + turn).map(move |point| (turn, point)))
    };
    Table::of(points)
        .real("turning_indentation", |&(turn, _)| map.turns()[turn])
        .real("indentation", |&(_, point)| map.points[point])
        .real("force", |&(turn, point)| map.force(turn, point))
        .real("everett", |&(turn, point)| map.everett(turn, point))
        .real("density", move |&(turn, point)| map.density(turn, point, smoothing))
        .done()
}

/// Returns the chart of the Everett function, N, over indentation and turning point.
pub fn everett_chart(map: &ReversalMap) -> Chart {
    let everett = |turn, point| map.everett(turn, point);
    map_chart(map, "Everett function", ("E", "N"), Shades::Sequential, &everett)
}

/// Returns the chart of the density, N/m², fitted over `smoothing` steps on either side.
pub fn density_chart(map: &ReversalMap, smoothing: usize) -> Chart {
    let density = |turn, point| map.density(turn, point, smoothing);
    map_chart(map, "FORC density", ("ρ", "N/m²"), Shades::Diverging, &density)
}

fn map_chart(
    map: &ReversalMap,
    name: &str,
    (symbol, unit): (&str, &str),
    shades: Shades,
    value: &dyn Fn(usize, usize) -> Option<f64>,
) -> Chart {
    // A subset of the points of a fine map: the eye cannot distinguish more cells.
    let every = |count: usize| (0..count).step_by(count.div_ceil(MOST_CELLS).max(1)).collect::<Vec<_>>();
    let (columns, rows) = (every(map.points.len()), every(map.reversals.len()));
    let values: Vec<Option<f64>> =
        rows.iter().flat_map(|&turn| columns.iter().map(move |&point| value(turn, point))).collect();
    let known = values.iter().flatten().copied();
    let key = match shades {
        Shades::Sequential => Span::around(known, 0.0),
        // White is zero.
        Shades::Diverging => Span::around(known.flat_map(|value| [value, -value]), 0.0),
    };
    let of = |indices: &[usize], offset: usize| {
        indices.iter().map(|&index| map.points[offset + index]).collect::<Vec<f64>>()
    };
    let (columns, rows) = (of(&columns, 0), of(&rows, map.below));
    let scale = AxisScale::Linear;
    let axis =
        |values: &[f64], name, symbol| Axis::new(scale, HeatMap::span(scale, values), name, symbol, "m");
    let (x, y) = (axis(&columns, "indentation", "d"), axis(&rows, "turning point", "d_r"));
    let map = HeatMap {
        columns,
        rows,
        values,
        key: Axis::new(scale, key, "", symbol, unit),
        shades,
        classes: Vec::new(),
        class_names: Vec::new(),
        contour: None,
    };
    let layers = vec![Layer::unnamed(Ink::Text, Shape::Map(Box::new(map)))];
    Chart { heading: Label::quantity(name, symbol), ..Chart::new(x, y, layers) }
}
