//! A scene as a profile and in three dimensions, as text, JSON, a table and a figure.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::status::duration;
use crate::warnings::{warning_texts, warnings_section};
use asperity_data::{
    AxisScale, Table, Warning, format_quantity, format_rounded, grouped, memory_size, object,
};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Layer, Shape, Sign, Span, Stroke};
use asperity_scene::Scene;
use asperity_study::Statistics;
use asperity_study::half_space::{Compared, Loaded, Reference, ReferenceEvent, SquareLoops};
use serde::Serialize;
use std::time::{Duration, Instant};

/// Report on the comparison of two computations of a rough contact: with profiles, as this program does, and in three
/// dimensions.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceReport<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// Scene that is computed in both ways.
    pub scene: &'a Scene,
    /// Results of both computations and their ratios.
    pub reference: &'a Reference,
    /// Premises of the model that the scene does not meet.
    pub warnings: &'a [Warning],
}

/// Writes the ratio of both models with its interval: `0.84 ± 0.05`.
fn ratio(of: &Compared) -> String {
    let decimals =
        |value: f64| if value < 10.0 { format!("{value:.2}") } else { format_rounded(value, 2, "1") };
    match of.error {
        Some(error) => format!("{} ± {}", decimals(of.ratio), decimals(error)),
        None => decimals(of.ratio),
    }
}

/// Time in s above which a comparison takes long.
const LONG: f64 = 10.0;

/// Progress, in words, of a comparison of a scene with three dimensions. Such a comparison computes the contact of a number of
/// random rough squares.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceProgress {
    begun: Instant,
    maps: u64,
    done: u64,
}

impl Default for ReferenceProgress {
    fn default() -> Self {
        ReferenceProgress { begun: Instant::now(), maps: 0, done: 0 }
    }
}

impl ReferenceProgress {
    /// Returns a line of text on an event of the comparison, such as a finished square. The second value is true if the line
    /// announces a comparison of at least 10 s.
    pub fn words(&mut self, event: &ReferenceEvent) -> (String, bool) {
        match *event {
            ReferenceEvent::Begins { maps, threads, bytes, seconds, .. } => {
                *self = ReferenceProgress { maps, ..ReferenceProgress::default() };
                let time = duration(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
                let (squares, threads) = (counted(maps, "square"), counted(threads as u64, "thread"));
                let memory = memory_size(bytes);
                (format!("{squares} on {threads}: about {time} and {memory} of memory"), seconds >= LONG)
            }
            ReferenceEvent::Square { .. } => {
                self.done += 1;
                let ReferenceProgress { done, maps, begun } = *self;
                let left = begun.elapsed().mul_f64((maps - done.min(maps)) as f64 / done as f64);
                (format!("{done} of {}, {} left", counted(maps, "square"), duration(left)), false)
            }
        }
    }

    /// Returns in words how many finished squares are lost if the comparison is stopped now.
    pub fn lost(&self) -> String {
        match self.maps {
            0 => "stopped before the first square".to_owned(),
            maps => format!("stopped after {} of {}, which are lost", self.done, counted(maps, "square")),
        }
    }
}

fn counted(count: u64, noun: &str) -> String {
    format!("{} {noun}{}", grouped(count), if count == 1 { "" } else { "s" })
}

/// Returns in a few words the progress of the computation of force loops of random rough squares in three dimensions. After
/// the first results the words have the ratio of the result with profiles to the result in three dimensions. The result is the
/// adhesion force, or the indentation if `is_adhesive` is false.
pub fn square_loops_words(loops: &SquareLoops, is_adhesive: bool) -> String {
    let SquareLoops { maps, curves, reference, .. } = loops;
    let Some(compared) = loops.headline() else {
        let done = if *maps == 0 { "begins".into() } else { format!("0 of {maps} squares") };
        return format!("three dimensions: {done}");
    };
    let symbol = if is_adhesive { "F_a" } else { "d" };
    let rest = match reference.as_ref().map(|of| (of.waves, of.omitted)) {
        Some((Some((first, last)), Some(_))) => format!(", waves {first} to {last} alone"),
        Some(_) => String::new(),
        None => format!(", {} of {maps} squares", curves.len()),
    };
    format!("{symbol} line/three dimensions {}{rest}", ratio(&compared))
}

/// Returns a sentence with the ratio of the mean over random profiles to the mean in three dimensions, and with the error of the
/// model that follows from this ratio. The means are of the adhesion force, or of the indentation without adhesion. Returns
/// `None` if the ratio is unknown.
pub fn model_sentence(reference: &Reference) -> Option<String> {
    let compared = reference.headline()?;
    let quantity = if reference.adhesion_force.is_some() { "the adhesion force" } else { "the indentation" };
    Some(format!(
        "The mean of {quantity} over random lines is {} times the mean over random squares in three dimensions: this error \
         of the model, {}, remains with any number of springs.",
        ratio(compared),
        percent(reference.budget.model)
    ))
}

fn percent(share: f64) -> String {
    format!("{} %", format_rounded(100.0 * share, 2, "1"))
}

impl ReferenceReport<'_> {
    /// Returns sentences on what is compared.
    fn compared(&self) -> String {
        let Reference { options, waves, omitted, .. } = self.reference;
        let cells = options.cells;
        let Some((first, last)) = waves else {
            return format!("A square of {cells} × {cells} cells and a line, both smooth.");
        };
        let (first, last) = (grouped(*first), grouped(*last));
        let left_out = omitted.map_or_else(String::new, |whole| {
            format!(
                " The squares do not resolve the waves up to {} of the scene, which both models leave out: --grid refines the \
                 squares.",
                grouped(whole)
            )
        });
        format!(
            "Means over {} random squares of {cells} × {cells} cells and over {} random lines, of {first} to {last} waves over the \
             length.{left_out}",
            grouped(options.maps),
            grouped(options.lines)
        )
    }

    /// Returns the errors of the profile by their sources, and the largest in words.
    fn errors(&self) -> (Vec<(&'static str, String)>, String) {
        let budget = &self.reference.budget;
        let or_unknown = |share: Option<f64>| share.map_or_else(|| "not known".to_owned(), percent);
        let rows = vec![
            ("solver", format!("{:.0e} of the rms height", budget.solver)),
            ("grid of the squares", or_unknown(budget.grid)),
            ("sample", or_unknown(budget.sample)),
            ("model", percent(budget.model)),
        ];
        let largest = match budget.largest {
            "model" => {
                format!("The largest is the model, {}: more springs do not help.", percent(budget.model))
            }
            "sample" => {
                "The largest is the sample of squares and lines: --maps takes more of them.".to_owned()
            }
            "grid" => "The largest is the grid of the squares: --grid refines it.".to_owned(),
            _ => "The largest is the residual of the solver.".to_owned(),
        };
        (rows, largest)
    }
}

/// Returns the numbers of one model, or the ratios of both models. The area of contact is included where it has a meaning.
fn model<V: Serialize>(
    reference: &Reference,
    of: impl Fn(&Compared) -> V + Copy,
    area: impl Fn(&Loaded) -> Option<f64>,
) -> impl Serialize {
    let point = |loaded: &Loaded| {
        object! {
            "force": loaded.force,
            "indentation": of(&loaded.indentation),
            "stiffness": of(&loaded.stiffness),
            "contact_area"?: area(loaded),
        }
    };
    object! {
        "adhesion_force": reference.adhesion_force.as_ref().map(of),
        "first_touch_adhesion_force": reference.first_touch_adhesion_force.as_ref().map(of),
        "dissipated_energy": reference.dissipated_energy.as_ref().map(of),
        "loading": reference.loading.iter().map(point).collect::<Vec<_>>(),
    }
}

impl Report for ReferenceReport<'_> {
    fn text(&self) -> Option<String> {
        let reference = self.reference;
        let mut sheet = Sheet::default();
        sheet.paragraph(self.title);
        sheet.heading(&self.compared());
        warnings_section(&mut sheet, self.warnings);
        let header = ["", "line", "three dimensions", "line over three dimensions"].map(String::from);
        let row = |name: String, of: &Compared, unit: &str| {
            let mean = |all: &Statistics| format_rounded(all.mean, 3, unit);
            [name, mean(&of.line), mean(&of.half_space), ratio(of)]
        };
        let mut rows = vec![header.clone()];
        for loaded in &reference.loading {
            let force = format_rounded(loaded.force, 3, "N");
            rows.push(row(format!("indentation at {force}"), &loaded.indentation, "m"));
            rows.push(row(format!("stiffness at {force}"), &loaded.stiffness, "N/m"));
        }
        sheet.heading("Without adhesion, indentations from first touch");
        sheet.table(&rows);
        let adhesive = [
            ("adhesion force F_a", &reference.adhesion_force, "N"),
            ("at first touch F_a(d=0)", &reference.first_touch_adhesion_force, "N"),
            ("dissipated energy", &reference.dissipated_energy, "J"),
        ];
        let adhesive = adhesive.into_iter().filter_map(|(name, of, unit)| {
            let of = of.as_ref()?;
            Some(row(name.to_owned(), of, unit))
        });
        let adhesive: Vec<_> = std::iter::once(header).chain(adhesive).collect();
        if adhesive.len() > 1 {
            sheet.heading(&format!(
                "With adhesion, after a preload of {}",
                format_quantity(reference.preload, "N")
            ));
            sheet.table(&adhesive);
        }
        let (rows, largest) = self.errors();
        sheet.heading("Errors of the line by their sources");
        rows.into_iter().for_each(|(name, words)| sheet.row(name, words));
        sheet.paragraph(&largest);
        let [lines, squares] = reference.seconds.map(|seconds| format_quantity(seconds, "s"));
        sheet.heading(&format!(
            "Time: {lines} for the lines; {squares} and {} convolutions for the squares.",
            grouped(reference.convolutions)
        ));
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let reference = self.reference;
        let ratio = |of: &Compared| object! { "value": of.ratio, "error": of.error };
        Some(Box::new(object! {
            "scene": self.scene,
            "warnings": warning_texts(self.warnings),
            "cells": reference.options.cells,
            "maps": reference.options.maps,
            "lines": reference.options.lines,
            "waves": reference.waves,
            "omitted": reference.omitted,
            "preload": reference.preload,
            "line": model(reference, |of| of.line, |_| None),
            "half_space": model(reference, |of| of.half_space, |loaded| Some(loaded.area)),
            "ratio": model(reference, ratio, |_| None),
            "budget": reference.budget,
            "convolutions": reference.convolutions,
            "seconds": reference.seconds,
            "seconds_of_square": reference.seconds_of_square,
        }))
    }

    /// Returns a table of the loading without adhesion. A row has a force, then indentation and stiffness at this force: the mean
    /// over profiles, the mean in three dimensions, and the ratio of these means.
    fn table(&self) -> Option<Table<'_>> {
        let rows = move || self.reference.loading.iter();
        let mean = |of: &Compared| (of.line.mean, of.half_space.mean);
        let table = Table::of(rows)
            .real("force", |loaded| Some(loaded.force))
            .real("indentation_line", move |loaded| Some(mean(&loaded.indentation).0))
            .real("indentation_half_space", move |loaded| Some(mean(&loaded.indentation).1))
            .real("indentation_ratio", |loaded| Some(loaded.indentation.ratio))
            .real("indentation_ratio_error", |loaded| loaded.indentation.error)
            .real("stiffness_line", move |loaded| Some(mean(&loaded.stiffness).0))
            .real("stiffness_half_space", move |loaded| Some(mean(&loaded.stiffness).1))
            .real("stiffness_ratio", |loaded| Some(loaded.stiffness.ratio))
            .real("stiffness_ratio_error", |loaded| loaded.stiffness.error)
            .real("area_half_space", |loaded| Some(loaded.area));
        Some(table.done())
    }

    /// Returns a chart of the loading without adhesion: mean and quartiles of the indentation at each force, in both models.
    fn figure(&self) -> Option<Figure> {
        let loading = &self.reference.loading;
        let force = |loaded: &Loaded| loaded.force;
        let of = |name: &str, ink: Ink, sign: Sign, all: fn(&Loaded) -> Statistics| {
            let points: Vec<(f64, f64)> =
                loading.iter().map(|loaded| (force(loaded), all(loaded).mean)).collect();
            let band = loading.iter().map(|loaded| {
                let [low, _, high] = all(loaded).quartiles;
                (force(loaded), low, high)
            });
            [
                Layer { name: "".into(), ink, shape: Shape::Band(band.collect()) },
                Layer {
                    name: format!("{name}, mean and quartiles").as_str().into(),
                    ink,
                    shape: Shape::Curve { points, stroke: Some(Stroke::Solid), sign: Some(sign) },
                },
            ]
        };
        let layers = [
            of("line", Ink::Series(0), Sign::Dot, |loaded| loaded.indentation.line),
            of("three dimensions", Ink::Series(1), Sign::Diamond, |loaded| loaded.indentation.half_space),
        ];
        let axis = |values: &mut dyn Iterator<Item = f64>, name: &str, symbol: &str, unit: &str| {
            let span = Span::around(values.map(|value| AxisScale::Logarithmic.coordinate(value)), 0.05);
            ChartAxis::new(AxisScale::Logarithmic, span, name, symbol, unit)
        };
        let x = axis(&mut loading.iter().map(force), "force", "F", "N");
        let ends = loading.iter().flat_map(|loaded| {
            let both = [loaded.indentation.line, loaded.indentation.half_space];
            both.into_iter().flat_map(|all| [all.quartiles[0], all.quartiles[2], all.mean])
        });
        let y = axis(&mut { ends }, "indentation", "d", "m");
        let chart = Chart::new(x, y, layers.into_iter().flatten().collect());
        Some(Figure::of_chart(self.title, chart))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::{Simulation, open};
    use asperity_study::half_space::ReferenceOptions;

    /// The figure has room for a curve and a band of each model.
    #[test]
    fn the_figure_has_both_models() {
        let document = open("jkr-sphere").unwrap();
        let options = ReferenceOptions { cells: 32, maps: 1, lines: 1 };
        let simulation = (Simulation::default(), 1);
        let found = Reference::of(document.scene(), options, simulation, &|| false, &mut |_| ()).unwrap();
        let report =
            ReferenceReport { title: "A sphere", scene: document.scene(), reference: &found, warnings: &[] };
        let figure = report.figure().unwrap();
        assert_eq!(figure.size, Figure::WIDE);
        let legend: Vec<String> = figure.legend().iter().map(|entry| entry.name.to_string()).collect();
        assert_eq!(legend, ["line, mean and quartiles", "three dimensions, mean and quartiles"]);
        assert_eq!(figure.charts[0].layers.len(), 4);
    }
}
