//! First-order reversal curves of a scene as text, JSON, tables and a figure.

use super::Provenance;
use super::preloads::{preload_axes, preload_layers, unloadings};
use super::sheet::{Sheet, thinned};
use super::table::{Column, Record, TableFormat, Value, write_table};
use crate::analysis::{MinorLoops, ReversalMap};
use crate::contact::Reversal;
use crate::draw::{Axis, AxisScale, Chart, Figure, HeatMap, Ink, Label, Layer, Shades, Shape, Span};
use crate::io::{object, write_json_value};
use crate::scene::{Scene, format_quantity};
use crate::study::Preloaded;
use crate::text::grouped;
use std::io::{self, Write};

/// Most rows of the table.
const MOST_ROWS: usize = 16;
/// Most cells of a map on either axis of a figure.
const MOST_CELLS: usize = 128;

/// Reversals of a scene, their minor loops, and the smoothing of the density.
#[derive(Clone, Copy, Debug)]
pub struct ReversalReport<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Reversals of the scene.
    pub map: &'a ReversalMap,
    /// The adhesion force for exactly these preloads.
    pub preloads: &'a [Preloaded],
    /// Minor loops, if they were compared.
    pub loops: Option<MinorLoops>,
    /// Steps on either side over which the density is fitted.
    pub smoothing: usize,
}

/// Share of incongruent minor loops in words.
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

/// Reversals in plain text of at most eighty columns.
#[must_use]
pub fn reversals_text(report: &ReversalReport<'_>) -> String {
    let ReversalReport { scene, map, loops, smoothing, .. } = *report;
    let mut sheet = Sheet::default();
    sheet.paragraph(&scene.title);
    let reversals = &map.reversals;
    let (count, springs) = (grouped(reversals.len() as u64), grouped(scene.numerics.points));
    sheet.heading(&format!("{count} reversals of one loading, {springs} springs"));
    let shown = thinned(reversals.iter(), MOST_ROWS);
    let shown = shown.map(|reversal| Preloaded::new(reversal.turn.force, reversal));
    unloadings(&mut sheet, ["force at turn", "turning at"], shown);
    sheet.heading("Map");
    sheet.quantity("step of indentations", map.step(), "m");
    let largest = |value: fn(&ReversalMap, usize, usize) -> Option<f64>| {
        let all = (0..reversals.len()).flat_map(|turn| (0..map.points.len()).map(move |point| (turn, point)));
        all.filter_map(|(turn, point)| value(map, turn, point)).reduce(f64::max)
    };
    let everett = largest(|map, turn, point| map.everett(turn, point));
    sheet.quantity("largest Everett value", everett, "N");
    sheet.row("density", format!("quadratic fit, {smoothing} steps on either side"));
    sheet.row_of("incongruent", loops.map(congruency));
    sheet.into_text()
}

/// Writes a map as one JSON object in SI units: for each turning point the forces at the indentations of the
/// columns up to that point, the Everett function and the density.
///
/// # Errors
/// Errors of `out`.
pub fn write_reversals_json(out: &mut (impl Write + ?Sized), report: &ReversalReport<'_>) -> io::Result<()> {
    let ReversalReport { scene, map, preloads, loops, smoothing } = *report;
    let rows = |value: &dyn Fn(usize, usize) -> Option<f64>| -> Vec<Vec<Option<f64>>> {
        let row = |turn: usize| (0..=map.below + turn).map(|point| value(turn, point)).collect();
        (0..map.reversals.len()).map(row).collect()
    };
    let json = object! {
        "scene": scene,
        "preloads": preloads,
        "reversals": map.reversals.iter().map(|reversal| Record(COLUMNS, reversal)).collect::<Vec<_>>(),
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
    };
    write_json_value(out, &json)
}

const COLUMNS: &[Column<Reversal>] = &[
    Column("turning_indentation", Value::Real(|reversal| reversal.turn.indentation)),
    Column("turning_force", Value::Real(|reversal| reversal.turn.force)),
    Column("adhesion_force", Value::Optional(Reversal::adhesion_force)),
    Column("pull_off_indentation", Value::Real(|reversal| reversal.smallest.indentation)),
    Column("separation", Value::Real(|reversal| reversal.separation)),
    Column("dissipated_energy", Value::Real(|reversal| reversal.dissipated_energy)),
];

/// Writes a table with one row for each turning point, in SI units.
///
/// # Errors
/// Errors of `out`.
pub fn write_reversals_table(
    out: &mut (impl Write + ?Sized),
    format: TableFormat,
    provenance: &Provenance,
    map: &ReversalMap,
) -> io::Result<()> {
    write_table(out, format, provenance, COLUMNS, map.reversals.len(), map.reversals.iter())
}

/// A turning point and an indentation, m, with the values of the map.
type MapPoint = ([f64; 2], [Option<f64>; 3]);

const MAP_COLUMNS: &[Column<MapPoint>] = &[
    Column("turning_indentation", Value::Real(|(at, _)| at[0])),
    Column("indentation", Value::Real(|(at, _)| at[1])),
    Column("force", Value::Optional(|(_, values)| values[0])),
    Column("everett", Value::Optional(|(_, values)| values[1])),
    Column("density", Value::Optional(|(_, values)| values[2])),
];

/// Writes a table with one row for each turning point and each indentation up to that point, in SI units.
///
/// # Errors
/// Errors of `out`.
pub fn write_reversal_map_table(
    out: &mut (impl Write + ?Sized),
    format: TableFormat,
    provenance: &Provenance,
    map: &ReversalMap,
    smoothing: usize,
) -> io::Result<()> {
    let points = |turn: usize| &map.points[..=map.below + turn];
    let rows = map.turns().iter().enumerate().flat_map(|(turn, &at)| {
        points(turn).iter().enumerate().map(move |(point, &indentation)| {
            let density = map.density(turn, point, smoothing);
            ([at, indentation], [map.force(turn, point), map.everett(turn, point), density])
        })
    });
    let count = (0..map.turns().len()).map(|turn| points(turn).len()).sum();
    write_table(out, format, provenance, MAP_COLUMNS, count, rows)
}

/// The adhesion force over the preload, the Everett function and the density.
#[must_use]
pub fn reversals_figure(report: &ReversalReport<'_>, title: &str) -> Figure {
    let ReversalReport { map, preloads, loops, smoothing, .. } = *report;
    let mut notes = vec![Label::plain(&format!("density: quadratic fit, {smoothing} steps on either side"))];
    notes.extend(loops.map(|loops| Label::plain(&format!("incongruent: {}", congruency(loops)))));
    let everett = |turn, point| map.everett(turn, point);
    let density = |turn, point| map.density(turn, point, smoothing);
    Figure {
        title: title.to_owned(),
        notes,
        charts: vec![
            Chart {
                heading: Label::quantity("adhesion force", "F_a"),
                ..preload_axes(preload_layers(preloads, &[]))
            },
            map_chart(map, "Everett function", ("E", "N"), Shades::Sequential, &everett),
            map_chart(map, "FORC density", ("ρ", "N/m²"), Shades::Diverging, &density),
        ],
        size: Figure::SMALL,
    }
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
