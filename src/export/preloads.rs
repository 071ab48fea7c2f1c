//! Adhesion against preload as text, JSON, tables and a figure.

use super::report::{Json, Report};
use super::sheet::{Sheet, thinned};
use crate::accuracy::Choice;
use crate::draw::{Axis, AxisScale, Chart, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke};
use crate::io::{Table, object};
use crate::scene::{Scene, format_quantity};
use crate::study::{Preloaded, Statistics, preload_statistics};
use crate::text::grouped;

/// Most rows of the table.
const MOST_ROWS: usize = 32;
/// Most preloads that are drawn as single signs.
const MOST_SIGNS: usize = 128;

/// Results for the same preloads on one or more profiles.
#[derive(Clone, Debug)]
pub struct PreloadReport<'a> {
    title: &'a str,
    choice: Option<&'a Choice>,
    scene: &'a Scene,
    seeds: Vec<Option<u64>>,
    lines: Vec<Vec<Preloaded>>,
    statistics: Vec<Option<Statistics>>,
}

impl<'a> PreloadReport<'a> {
    /// The results of profiles, each with its seed if it has one, with the title of their figure and the choice of
    /// springs for a tolerance if there is one.
    #[must_use]
    pub fn new(
        title: &'a str,
        scene: &'a Scene,
        choice: Option<&'a Choice>,
        results: Vec<(Option<u64>, Vec<Preloaded>)>,
    ) -> Self {
        let (seeds, lines): (Vec<_>, Vec<_>) = results.into_iter().unzip();
        PreloadReport { title, choice, scene, seeds, statistics: preload_statistics(&lines), lines }
    }

    fn is_mean(&self) -> bool {
        self.lines.len() > 1
    }

    fn first(&self) -> &[Preloaded] {
        self.lines.first().map_or(&[], Vec::as_slice)
    }
}

impl Report for PreloadReport<'_> {
    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        sheet.paragraph(&self.scene.title);
        let profiles = match self.lines.len() {
            1 => "one profile".to_owned(),
            count => format!("{} random profiles", grouped(count as u64)),
        };
        let springs = grouped(self.scene.numerics.points);
        sheet.heading(&format!("Adhesion against preload, {profiles} of {springs} springs"));
        let shown = thinned(self.first().iter().zip(&self.statistics), MOST_ROWS);
        if self.is_mean() {
            let header = ["preload F_n", "mean F_a", "standard error", "95 % confidence of the mean"];
            let force = |value: f64| format_quantity(value, "N");
            let rows = shown.filter_map(|(one, statistics)| {
                let Statistics { mean, standard_error, confidence_interval: (low, high), .. } =
                    (*statistics)?;
                let band = format!("{} to {}", force(low), force(high));
                Some([force(one.preload), force(mean), force(standard_error), band])
            });
            sheet.table(&std::iter::once(header.map(String::from)).chain(rows).collect::<Vec<_>>());
        } else {
            unloadings(&mut sheet, ["preload F_n", "indentation"], shown.map(|(one, _)| *one));
        }
        if let Some(choice) = self.choice {
            sheet.heading(&choice.sentence());
        }
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let means = self.first().iter().zip(&self.statistics).map(|(one, statistics)| {
            object! { "preload": one.preload, "adhesion_force": statistics }
        });
        let lines = self.seeds.iter().zip(&self.lines).map(|(seed, preloads)| {
            object! { "seed": seed, "preloads": preloads }
        });
        Some(Box::new(object! {
            "scene": self.scene,
            "mean": self.is_mean().then(|| means.collect::<Vec<_>>()),
            "lines": lines.collect::<Vec<_>>(),
        }))
    }

    /// One row for each preload of each profile, beginning with the seed if profiles have one.
    fn table(&self) -> Option<Table<'_>> {
        let rows = || {
            let lines = self.seeds.iter().zip(&self.lines);
            lines.flat_map(|(seed, line)| line.iter().map(|one| (seed.unwrap_or(0), one)))
        };
        let mut table = Table::of(rows);
        if !self.seeds.contains(&None) {
            table = table.whole("seed", |(seed, _)| *seed);
        }
        let table = table
            .real("preload", |(_, one)| one.preload)
            .real("preload_indentation", |(_, one)| one.preload_indentation)
            .real("adhesion_force", |(_, one)| one.adhesion_force)
            .real("pull_off_indentation", |(_, one)| one.pull_off_indentation)
            .real("dissipated_energy", |(_, one)| one.dissipated_energy);
        Some(table.done())
    }

    /// The adhesion force over the preload: of the first profile, and the mean with its 95 % confidence.
    fn figure(&self) -> Option<Figure> {
        let chart = preload_axes(preload_layers(self.first(), &self.statistics));
        Some(Figure::of_chart(self.title, chart))
    }
}

/// Writes a table of unloadings, the turning point under these headings.
pub(super) fn unloadings(sheet: &mut Sheet, [force, at]: [&str; 2], rows: impl Iterator<Item = Preloaded>) {
    let header = [force, at, "adhesion force F_a", "pull-off at", "dissipated"].map(String::from);
    let row = |one: Preloaded| {
        [
            format_quantity(one.preload, "N"),
            format_quantity(one.preload_indentation, "m"),
            one.adhesion_force.map_or("-".to_owned(), |force| format_quantity(force, "N")),
            format_quantity(one.pull_off_indentation, "m"),
            format_quantity(one.dissipated_energy, "J"),
        ]
    };
    sheet.table(&std::iter::once(header).chain(rows.map(row)).collect::<Vec<_>>());
}

/// Layers of the adhesion force over the preload: one profile, and the mean of several with the 95 % confidence of the mean.
#[must_use]
pub fn preload_layers(one: &[Preloaded], statistics: &[Option<Statistics>]) -> Vec<Layer> {
    let mut layers = Vec::new();
    let mean: Vec<(f64, Statistics)> = one
        .iter()
        .zip(statistics)
        .filter_map(|(one, statistics)| Some((one.preload, (*statistics)?)))
        .collect();
    if !mean.is_empty() {
        let band = |&(preload, of): &(f64, Statistics)| {
            (preload, of.confidence_interval.0, of.confidence_interval.1)
        };
        let count = mean[0].1.count;
        let name = Label::plain(&format!("mean of {count} profiles, 95 % confidence"));
        layers.push(Layer::new(name.clone(), Ink::Kept, Shape::Band(mean.iter().map(band).collect())));
        let points = mean.iter().map(|&(preload, of)| (preload, of.mean)).collect();
        layers.push(Layer::new(name, Ink::Kept, Shape::line(points, Stroke::Dashed)));
    }
    let points: Vec<_> = one.iter().map(|one| (one.preload, one.adhesion_force.unwrap_or(0.0))).collect();
    // The force of one profile is a staircase, whose steps lie anywhere between two preloads.
    let shape = match points.len() {
        0..=MOST_SIGNS => Shape::signs(points, Sign::Dot),
        _ => Shape::line(points, Stroke::Solid),
    };
    layers.push(Layer::new("this profile".into(), Ink::Unloading, shape));
    layers
}

/// A chart of the adhesion force over the preload with these layers.
#[must_use]
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
