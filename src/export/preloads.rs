//! Adhesion against preload as text, JSON, tables and a figure.

use super::report::{Json, Report};
use super::sheet::{Sheet, thinned};
use crate::accuracy::Choice;
use crate::draw::{Axis, AxisScale, Chart, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke};
use crate::io::{Table, object};
use crate::scene::format_quantity;
use crate::study::{Results, Spread, Statistics};
use crate::text::grouped;
use std::ops::Range;

/// Most rows of the table.
const MOST_ROWS: usize = 32;
/// Most preloads that are drawn as single signs.
const MOST_SIGNS: usize = 128;

/// Adhesion against preload on one or more profiles.
#[derive(Clone, Copy, Debug)]
pub struct PreloadReport<'a> {
    /// Title of the figure.
    pub title: &'a str,
    /// Choice of springs for a tolerance, if one was given.
    pub choice: Option<&'a Choice>,
    /// The records of [`Results::OF_PRELOADS`].
    pub results: &'a Results,
}

impl PreloadReport<'_> {
    fn is_mean(&self) -> bool {
        self.results.plan().lines > 1
    }

    /// Seeds of the profiles, if they have any.
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
        sheet.heading(&format!("Adhesion against preload, {profiles} of {springs} springs"));
        if self.is_mean() {
            let header = ["preload F_n", "mean F_a", "standard error", "95 % confidence of the mean"];
            let force = |value: f64| format_quantity(value, "N");
            let means = self.results.mean_adhesion_forces();
            let rows = thinned(means.iter(), MOST_ROWS).filter_map(|(preload, all)| {
                let Spread { standard_error, confidence_interval: (low, high), .. } = all.spread?;
                let band = format!("{} to {}", force(low), force(high));
                Some([force(*preload), force(all.mean), force(standard_error), band])
            });
            sheet.table(&std::iter::once(header.map(String::from)).chain(rows).collect::<Vec<_>>());
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
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let plan = self.results.plan();
        let mean = |(preload, statistics)| object! { "preload": preload, "adhesion_force": statistics };
        let means = || self.results.mean_adhesion_forces().into_iter().map(mean).collect::<Vec<_>>();
        let line = |line| {
            object! { "seed": self.seed(line), "preloads": preload_table(self.results, line..line + 1, false) }
        };
        Some(Box::new(object! {
            "scene": &plan.scene,
            "mean": self.is_mean().then(means),
            "lines": (0..plan.lines).map(line).collect::<Vec<_>>(),
        }))
    }

    /// One row for each preload of each profile, beginning with the seed if profiles have one.
    fn table(&self) -> Option<Table<'_>> {
        Some(preload_table(self.results, 0..self.results.plan().lines, self.seed(0).is_some()))
    }

    /// The adhesion force over the preload: of the first profile, and the mean with its 95 % confidence.
    fn figure(&self) -> Option<Figure> {
        let layers = preload_layers(&self.results.adhesion_forces(0), &self.results.mean_adhesion_forces());
        Some(Figure::of_chart(self.title, preload_axes(layers)))
    }
}

/// The unloadings from all preloads on these profiles, with the seeds if they are `seeded`.
pub(super) fn preload_table(results: &Results, lines: Range<u64>, seeded: bool) -> Table<'_> {
    let plan = results.plan();
    let rows = move || lines.clone().flat_map(move |line| (0..plan.cells()).map(move |cell| (cell, line)));
    let mut table = Table::of(rows);
    if seeded {
        table = table.whole("seed", |(_, line)| plan.seed_of(*line));
    }
    table = table.real("preload", |(cell, _)| plan.values(*cell)[0]);
    for quantity in Results::OF_PRELOADS {
        table = table.real(quantity.name(), move |(cell, line)| results.value(*cell, *line, quantity));
    }
    table.done()
}

/// Writes a table of unloadings: force and indentation of the turning point under these headings, adhesion force,
/// indentation at pull-off, dissipated energy.
pub(super) fn unloadings(
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
    sheet.table(&std::iter::once(header).chain(rows.map(row)).collect::<Vec<_>>());
}

/// Layers of the adhesion force, N, over the preload, N: one profile, and the mean of several with its 95 % confidence.
pub fn preload_layers(one: &[(f64, f64)], means: &[(f64, Statistics)]) -> Vec<Layer> {
    let mut layers = Vec::new();
    if let Some((_, Statistics { count, .. })) = means.first() {
        let band = |(preload, of): &(f64, Statistics)| {
            of.confidence_interval().map(|(low, high)| (*preload, low, high))
        };
        let name = Label::plain(&format!("mean of {count} profiles, 95 % confidence"));
        layers.push(Layer::new(
            name.clone(),
            Ink::Kept,
            Shape::Band(means.iter().filter_map(band).collect()),
        ));
        let points = means.iter().map(|&(preload, of)| (preload, of.mean)).collect();
        layers.push(Layer::new(name, Ink::Kept, Shape::line(points, Stroke::Dashed)));
    }
    // The force of one profile is a staircase, whose steps lie anywhere between two preloads.
    let shape = match one.len() {
        0..=MOST_SIGNS => Shape::signs(one.to_vec(), Sign::Dot),
        _ => Shape::line(one.to_vec(), Stroke::Solid),
    };
    layers.push(Layer::new("this profile".into(), Ink::Unloading, shape));
    layers
}

/// A chart of the adhesion force over the preload with these layers.
pub fn preload_axes(layers: Vec<Layer>) -> Chart {
    let mut all = vec![(0.0, 0.0)];
    for layer in &layers {
        match &layer.shape {
            Shape::Curve { points, .. } => all.extend(points),
            Shape::Band(points) => {
                all.extend(points.iter().flat_map(|&(x, low, high)| [(x, low), (x, high)]))
            }
            _ => {}
        }
    }
    let x = Span::around(all.iter().map(|point| point.0), 0.03);
    let y = Span::around(all.iter().map(|point| point.1), 0.05);
    let x = Axis::new(AxisScale::Linear, x, "preload", "F_n", "N");
    Chart::new(x, Axis::new(AxisScale::Linear, y, "adhesion force", "F_a", "N"), layers)
}
