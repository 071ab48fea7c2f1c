//! A scene as a profile and in three dimensions, as text, JSON, a table and a figure.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::status::duration;
use crate::warnings::{counted_section, counted_texts};
use asperity_contact::Move;
use asperity_data::{
    AxisScale, Table, format_quantity, format_rounded, grouped, memory_size, object,
};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Layer, Shape, Sign, Span, Stroke};
use asperity_scene::Scene;
use asperity_study::Statistics;
use asperity_study::half_space::{
    Compared, ComparedRoughness, Loaded, Reference, ReferenceEvent, SquareLoops,
};
use serde::Serialize;
use std::time::{Duration, Instant};

/// Report on the comparison of two computations of a rough contact: with profiles, as this program
/// does, and in three dimensions.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceReport<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// Scene that is computed in both ways.
    pub scene: &'a Scene,
    /// Results of both computations and their ratios.
    pub reference: &'a Reference,
}

/// Writes the ratio of both models with its interval: `0.84 ± 0.05`.
fn ratio(of: &Compared) -> String {
    let decimals = |value: f64| {
        if value < 10.0 {
            format!("{value:.2}")
        } else {
            format_rounded(value, 2, "1")
        }
    };
    match of.error {
        Some(error) => format!("{} ± {}", decimals(of.ratio), decimals(error)),
        None => decimals(of.ratio),
    }
}

/// Time in s above which a comparison takes long.
const LONG: f64 = 10.0;

/// Smallest share of the squares from whose time the time left follows.
const LEAST_SHARE: f64 = 0.02;

/// Progress, in words, of a comparison of a scene with three dimensions. Such a comparison computes
/// the contact of a number of random rough squares.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceProgress {
    begun: Instant,
    maps: u64,
    done: u64,
    lines_done: u64,
    /// Estimated share of the computation of the squares that is done.
    share: f64,
    /// Estimated time of all squares, s.
    seconds: f64,
}

impl Default for ReferenceProgress {
    fn default() -> Self {
        let begun = Instant::now();
        ReferenceProgress {
            begun,
            maps: 0,
            done: 0,
            lines_done: 0,
            share: 0.0,
            seconds: 0.0,
        }
    }
}

impl ReferenceProgress {
    /// Returns a line of text on an event of the comparison, such as a finished square. The second
    /// value is true if the line announces a comparison of at least 10 s.
    pub fn words(&mut self, event: &ReferenceEvent) -> (String, bool) {
        match *event {
            ReferenceEvent::Begins {
                maps,
                threads,
                bytes,
                seconds,
            } => {
                *self = ReferenceProgress {
                    maps,
                    seconds,
                    ..ReferenceProgress::default()
                };
                let time = in_words(seconds);
                let (squares, threads) =
                    (counted(maps, "square"), counted(threads as u64, "thread"));
                let memory = memory_size(bytes);
                (
                    format!("{squares} on {threads}: about {time} and {memory} of memory"),
                    seconds >= LONG,
                )
            }
            ReferenceEvent::Profiles { count, lines } => {
                self.lines_done += count;
                (
                    format!("lines: {} %", 100 * self.lines_done / lines.max(1)),
                    false,
                )
            }
            ReferenceEvent::ProfilesEnd { .. } => {
                self.begun = Instant::now();
                (self.of_squares(), false)
            }
            ReferenceEvent::Loaded { share } => {
                // The number of loads is an estimate.
                self.share = (self.share + share).min(0.99);
                (self.of_squares(), false)
            }
            ReferenceEvent::Square { .. } => {
                self.done += 1;
                (self.of_squares(), false)
            }
        }
    }

    /// Returns how many squares are finished, the share of the computation that is done, and the
    /// time left.
    fn of_squares(&self) -> String {
        let done = self.done as f64 / self.maps.max(1) as f64;
        let share = self.share.max(done);
        let left = if share < LEAST_SHARE {
            self.seconds
        } else {
            self.begun.elapsed().as_secs_f64() * (1.0 - share) / share
        };
        let squares = counted(self.maps, "square");
        format!(
            "{} of {squares}, {:.0} %, {} left",
            self.done,
            100.0 * share,
            in_words(left)
        )
    }

    /// Returns in words how many finished squares are lost if the comparison is stopped now.
    pub fn lost(&self) -> String {
        match self.maps {
            0 => "stopped before the first square".to_owned(),
            maps => format!(
                "stopped after {} of {}, which are lost",
                self.done,
                counted(maps, "square")
            ),
        }
    }
}

fn in_words(seconds: f64) -> String {
    duration(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX))
}

fn counted(count: u64, noun: &str) -> String {
    format!(
        "{} {noun}{}",
        grouped(count),
        if count == 1 { "" } else { "s" }
    )
}

/// Returns in a few words the progress of the computation of force loops of random rough squares in
/// three dimensions. After the first results the words have the ratio of the result with profiles
/// to the result in three dimensions. The result is the adhesion force, or the indentation if
/// `is_adhesive` is false.
pub fn square_loops_words(loops: &SquareLoops, is_adhesive: bool) -> String {
    let SquareLoops {
        maps,
        curves,
        reference,
        share,
        ..
    } = loops;
    let Some(compared) = loops.headline() else {
        if *maps == 0 {
            return "three dimensions: begins".to_owned();
        }
        return format!(
            "three dimensions: 0 of {maps} squares, {:.0} %",
            100.0 * share
        );
    };
    let symbol = if is_adhesive { "F_a" } else { "d" };
    let rest = match reference {
        Some(reference) => omitted_waves(reference),
        None => format!(", {} of {maps} squares", curves.len()),
    };
    format!("{symbol} line/three dimensions {}{rest}", ratio(&compared))
}

/// Returns a sentence with the ratio of the mean over random profiles to the mean in three
/// dimensions, and with the error of the model that follows from this ratio. The means are of the
/// adhesion force, or of the indentation without adhesion. Returns `None` if the ratio is unknown.
pub fn model_sentence(reference: &Reference) -> Option<String> {
    let compared = reference.headline()?;
    let quantity = if reference.adhesion_force.is_some() {
        "the adhesion force"
    } else {
        "the indentation"
    };
    let waves = omitted_waves(reference);
    let model = if reference.line_is_exact {
        "The model is exact for this body, so that the difference is an error of the grid of the squares."
            .to_owned()
    } else {
        match reference.budget.model {
            Some(model) if model > 0.0 => format!(
                "The error of the model, at least {}{waves}, remains with any number of springs.",
                percent(model)
            ),
            Some(_) => "Sample and grid of the squares can explain the difference.".to_owned(),
            None => "The error of the model is not known.".to_owned(),
        }
    };
    Some(format!(
        "The mean of {quantity} over random lines is {} times the mean over random squares in three dimensions{waves}. {model}",
        ratio(compared),
    ))
}

/// Returns the difference of the line from three dimensions with its interval and the compared
/// waves, such as `line against three dimensions, +4 ± 45 %`; `None` if it is unknown.
pub fn difference_words(reference: &Reference) -> Option<String> {
    let compared = reference.headline()?;
    let difference = format_rounded(100.0 * compared.difference(), 2, "1");
    let sign = if compared.difference() > 0.0 { "+" } else { "" };
    let waves = omitted_waves(reference);
    Some(match compared.error {
        Some(error) => {
            format!(
                "line against three dimensions, {sign}{difference} ± {}{waves}",
                percent(error)
            )
        }
        None => format!("line against three dimensions, {sign}{difference} %{waves}"),
    })
}

/// Returns the error of the model in words: what exceeds the errors of sample and grid.
pub fn model_words(reference: &Reference) -> String {
    if reference.line_is_exact {
        return "none: the line is exact for this body of revolution".to_owned();
    }
    match reference.budget.model {
        Some(model) if model > 0.0 => {
            format!(
                "at least {}, beyond sample and grid{}",
                percent(model),
                omitted_waves(reference)
            )
        }
        Some(_) => "not distinguished from sample and grid".to_owned(),
        None if reference.budget.grid.is_none() => {
            "not known, because the error of the grid is not known".to_owned()
        }
        None => "not known, because the error of the sample is not known".to_owned(),
    }
}

/// Returns the waves that are compared, if the squares leave out some of the scene:
/// `, of waves 4 to 8 of 4 to 3 200`.
pub fn omitted_waves(reference: &Reference) -> String {
    match (reference.waves, reference.omitted) {
        (Some((first, last)), Some(whole)) => {
            let first = grouped(first);
            format!(
                ", of waves {first} to {} of {first} to {}",
                grouped(last),
                grouped(whole)
            )
        }
        _ => String::new(),
    }
}

fn percent(share: f64) -> String {
    format!("{} %", format_rounded(100.0 * share, 2, "1"))
}

fn percent_or_unknown(share: Option<f64>) -> String {
    share.map_or_else(|| "not known".to_owned(), percent)
}

impl ReferenceReport<'_> {
    /// Returns sentences on what is compared.
    fn compared(&self) -> String {
        let Reference {
            options,
            waves,
            omitted,
            ..
        } = self.reference;
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

    /// Returns sentences on what is computed of the loading of the scene.
    fn loading_sentences(&self) -> String {
        let reference = self.reference;
        let mut sentences = String::new();
        if reference.compared_loading[..] != self.scene.loading[..] {
            let turn = match reference.compared_loading[0] {
                Move::ToIndentation(indentation) => {
                    format!("an indentation of {}", format_rounded(indentation, 3, "m"))
                }
                Move::ToDisplacement(displacement) => {
                    format!("a displacement of {}", format_rounded(displacement, 3, "m"))
                }
                _ => format_rounded(reference.preload, 3, "N"),
            };
            sentences = format!(
                "The last loop of the loading is compared: from separation to {turn}, and back."
            );
        }
        sentences
    }

    /// Adds a table of the roughness of lines and squares.
    fn roughness(&self, sheet: &mut Sheet) {
        let Some(roughness) = self.reference.roughness else {
            return;
        };
        let row = |name: &str, line: String, half_space: String, ratio: f64| {
            [name.to_owned(), line, half_space, format!("{ratio:.2}")]
        };
        let both = |name: &str, value: fn(&ComparedRoughness) -> f64, unit: &str| {
            let (line, half_space) = (value(&roughness.line), value(&roughness.half_space));
            row(
                name,
                format_rounded(line, 3, unit),
                format_rounded(half_space, 3, unit),
                line / half_space,
            )
        };
        let mut rows = vec![
            header(),
            both("rms height h", |of| of.rms_height, "m"),
            both("rms gradient ⟨∇z⟩", |of| of.rms_gradient, "1"),
            both("elastic energy e_el", |of| of.elastic_energy, "J/m²"),
        ];
        let mut scaled = String::new();
        if let (Some(adhesive), Some(work)) = (
            roughness.adhesive_half_space,
            self.reference.work_of_adhesion,
        ) {
            let line = roughness.line.elastic_energy / work;
            let half_space = adhesive.elastic_energy / work;
            let ratio = |value: f64| format_rounded(value, 3, "1");
            rows.push(row(
                "e_el/γ with adhesion",
                ratio(line),
                ratio(half_space),
                line / half_space,
            ));
            let factor = adhesive.rms_height / roughness.half_space.rms_height;
            scaled = format!(
                "With adhesion the heights of the squares are multiplied by {factor:.3}, so that e_el/γ is the same."
            );
        }
        sheet.heading("Roughness of what is compared");
        sheet.table(&rows);
        if !scaled.is_empty() {
            sheet.paragraph(&scaled);
        }
    }

    /// Returns a sentence on the forces at which too few cells are in contact; `None` if there are
    /// none.
    fn left_out(&self) -> Option<String> {
        let left_out = &self.reference.left_out;
        let finest = left_out.first()?.grid;
        let least = Loaded::LEAST_CELLS;
        let mut forces = Vec::new();
        for force in left_out {
            let cells = format_rounded(force.cells, 2, "1");
            forces.push(format!("{} ({cells})", format_rounded(force.force, 3, "N")));
        }
        let help = finest.map_or_else(String::new, |grid| format!("; --grid {grid} may add them"));
        Some(format!(
            "Left out are forces at which fewer than {least} cells of a square are in contact on the average: {}{help}.",
            forces.join(", ")
        ))
    }

    /// Returns the errors of the comparison by their sources, and the largest in words.
    fn errors(&self) -> (Vec<(&'static str, String)>, String) {
        let budget = &self.reference.budget;
        let waves = omitted_waves(self.reference);
        let with_waves = |share: Option<f64>| match share {
            Some(share) => format!("{}{waves}", percent(share)),
            None => percent_or_unknown(share),
        };
        let is_random = self.reference.waves.is_some();
        let sample = if is_random {
            with_waves(budget.sample)
        } else {
            "none: nothing is random".to_owned()
        };
        let difference =
            difference_words(self.reference).unwrap_or_else(|| percent_or_unknown(None));
        let rows = vec![
            ("solver", format!("{:.0e} of the rms height", budget.solver)),
            ("grid of the squares", with_waves(budget.grid)),
            ("sample", sample),
            ("three dimensions", difference),
            ("model", model_words(self.reference)),
        ];
        let largest = match (budget.largest, budget.model) {
            ("model", Some(model)) => {
                format!(
                    "The largest is the model, at least {}{waves}: more springs do not help.",
                    percent(model)
                )
            }
            ("sample", _) => {
                "The largest is the sample of squares and lines: --maps takes more of them."
                    .to_owned()
            }
            ("grid", _) => "The largest is the grid of the squares: --grid refines it.".to_owned(),
            _ => "The largest known error is the residual of the solver.".to_owned(),
        };
        (rows, largest)
    }
}

/// Returns the headings of a table of both models.
fn header() -> [String; 4] {
    ["", "line", "three dimensions", "ratio"].map(String::from)
}

/// Returns the numbers of one model, or the ratios of both models. The numbers of the squares have
/// the area of contact and the error of their grid.
fn model<V: Serialize>(
    reference: &Reference,
    roughness: Option<ComparedRoughness>,
    value: impl Fn(&Compared) -> V + Copy,
    area: impl Fn(&Loaded) -> Option<f64>,
    grid: impl Fn(&Loaded) -> Option<Option<f64>>,
) -> impl Serialize {
    let point = |loaded: &Loaded| {
        object! {
            "force": loaded.force,
            "indentation": value(&loaded.indentation),
            "stiffness": value(&loaded.stiffness),
            "contact_area"?: area(loaded),
            "grid"?: grid(loaded),
        }
    };
    object! {
        "rms_height"?: roughness.map(|roughness| roughness.rms_height),
        "rms_gradient"?: roughness.map(|roughness| roughness.rms_gradient),
        "elastic_energy"?: roughness.map(|roughness| roughness.elastic_energy),
        "adhesion_force": reference.adhesion_force.as_ref().map(value),
        "first_touch_adhesion_force": reference.first_touch_adhesion_force.as_ref().map(value),
        "dissipated_energy": reference.dissipated_energy.as_ref().map(value),
        "loading": reference.loading.iter().map(point).collect::<Vec<_>>(),
    }
}

impl Report for ReferenceReport<'_> {
    fn text(&self) -> Option<String> {
        let reference = self.reference;
        let mut sheet = Sheet::default();
        sheet.paragraph(self.title);
        sheet.heading(&self.compared());
        counted_section(
            &mut sheet,
            &self.reference.warnings,
            self.reference.profiles_for_warnings(),
        );
        let loading = self.loading_sentences();
        if !loading.is_empty() {
            sheet.paragraph(&loading);
        }
        self.roughness(&mut sheet);
        let mut header = header().to_vec();
        header.push("grid".to_owned());
        let row = |name: String, compared: &Compared, unit: &str| {
            let mean = |all: &Statistics| format_rounded(all.mean, 3, unit);
            let grid = percent_or_unknown(compared.grid);
            vec![
                name,
                mean(&compared.line),
                mean(&compared.half_space),
                ratio(compared),
                grid,
            ]
        };
        let mut rows = vec![header.clone()];
        for loaded in &reference.loading {
            let force = format_rounded(loaded.force, 3, "N");
            rows.push(row(
                format!("indentation at {force}"),
                &loaded.indentation,
                "m",
            ));
            rows.push(row(
                format!("stiffness at {force}"),
                &loaded.stiffness,
                "N/m",
            ));
        }
        sheet.heading(
            "Without adhesion, indentations from first touch, ratio of the line to three dimensions",
        );
        if rows.len() > 1 {
            sheet.table(&rows);
        }
        if let Some(left_out) = self.left_out() {
            sheet.paragraph(&left_out);
        }
        let adhesive = [
            ("adhesion force F_a", &reference.adhesion_force, "N"),
            (
                "at first touch F_a(d=0)",
                &reference.first_touch_adhesion_force,
                "N",
            ),
            ("dissipated energy", &reference.dissipated_energy, "J"),
        ];
        let mut rows = vec![header];
        for (name, compared, unit) in adhesive {
            rows.extend(
                compared
                    .as_ref()
                    .map(|compared| row(name.to_owned(), compared, unit)),
            );
        }
        if rows.len() > 1 {
            let preload = format_quantity(reference.preload, "N");
            sheet.heading(&format!(
                "With adhesion, after a preload of {preload}, ratio of the line to three dimensions"
            ));
            sheet.table(&rows);
        }
        let (rows, largest) = self.errors();
        sheet.heading("Errors of the comparison by their sources");
        rows.into_iter()
            .for_each(|(name, words)| sheet.row(name, words));
        sheet.paragraph(&largest);
        let [lines, squares] = reference
            .seconds
            .map(|seconds| format_quantity(seconds, "s"));
        sheet.heading(&format!(
            "Time: {lines} for the lines; {squares} and {} convolutions for the squares.",
            grouped(reference.convolutions)
        ));
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let reference = self.reference;
        let ratio =
            |of: &Compared| object! { "value": of.ratio, "error": of.error, "grid": of.grid };
        let roughness = reference.roughness;
        let line = roughness.map(|roughness| roughness.line);
        let half_space = roughness.map(|roughness| roughness.half_space);
        Some(Box::new(object! {
            "scene": self.scene,
            "warnings": counted_texts(&self.reference.warnings, self.reference.profiles_for_warnings()),
            "cells": reference.options.cells,
            "maps": reference.options.maps,
            "lines": reference.options.lines,
            "waves": reference.waves,
            "omitted": reference.omitted,
            "compared_loading": reference.compared_loading,
            "preload": reference.preload,
            "work_of_adhesion": reference.work_of_adhesion,
            "line": model(reference, line, |of| of.line, |_| None, |_| None),
            "half_space": model(
                reference,
                half_space,
                |of| of.half_space,
                |loaded| Some(loaded.area),
                |loaded| Some(loaded.grid()),
            ),
            "adhesive_half_space": roughness.and_then(|roughness| roughness.adhesive_half_space),
            "ratio": model(reference, None, ratio, |_| None, |loaded| Some(loaded.grid())),
            "left_out": &reference.left_out,
            "line_is_exact": reference.line_is_exact,
            "budget": reference.budget,
            "convolutions": reference.convolutions,
            "seconds": reference.seconds,
            "seconds_of_square": reference.seconds_of_square,
        }))
    }

    /// Returns a table of the loading without adhesion. A row has a force, then indentation and
    /// stiffness at this force: the mean over profiles, the mean in three dimensions, and the ratio
    /// of these means.
    fn table(&self) -> Option<Table<'_>> {
        let rows = move || self.reference.loading.iter();
        let mean = |of: &Compared| (of.line.mean, of.half_space.mean);
        let table = Table::of(rows)
            .real("force", |loaded| Some(loaded.force))
            .real("indentation_line", move |loaded| {
                Some(mean(&loaded.indentation).0)
            })
            .real("indentation_half_space", move |loaded| {
                Some(mean(&loaded.indentation).1)
            })
            .real("indentation_ratio", |loaded| Some(loaded.indentation.ratio))
            .real("indentation_ratio_error", |loaded| loaded.indentation.error)
            .real("indentation_grid", |loaded| loaded.indentation.grid)
            .real("stiffness_line", move |loaded| {
                Some(mean(&loaded.stiffness).0)
            })
            .real("stiffness_half_space", move |loaded| {
                Some(mean(&loaded.stiffness).1)
            })
            .real("stiffness_ratio", |loaded| Some(loaded.stiffness.ratio))
            .real("stiffness_ratio_error", |loaded| loaded.stiffness.error)
            .real("stiffness_grid", |loaded| loaded.stiffness.grid)
            .real("area_half_space", |loaded| Some(loaded.area));
        Some(table.done())
    }

    /// Returns a chart of the loading without adhesion: mean and quartiles of the indentation at
    /// each force, in both models.
    fn figure(&self) -> Option<Figure> {
        let loading = &self.reference.loading;
        let force = |loaded: &Loaded| loaded.force;
        let of = |name: &str, ink: Ink, sign: Sign, all: fn(&Loaded) -> Statistics| {
            let points: Vec<(f64, f64)> = loading
                .iter()
                .map(|loaded| (force(loaded), all(loaded).mean))
                .collect();
            let band = loading.iter().map(|loaded| {
                let [low, _, high] = all(loaded).quartiles;
                (force(loaded), low, high)
            });
            [
                Layer {
                    name: "".into(),
                    ink,
                    shape: Shape::Band(band.collect()),
                },
                Layer {
                    name: format!("{name}, mean and quartiles").as_str().into(),
                    ink,
                    shape: Shape::Curve {
                        points,
                        stroke: Some(Stroke::Solid),
                        sign: Some(sign),
                    },
                },
            ]
        };
        let layers = [
            of("line", Ink::Series(0), Sign::Dot, |loaded| {
                loaded.indentation.line
            }),
            of(
                "three dimensions",
                Ink::Series(1),
                Sign::Diamond,
                |loaded| loaded.indentation.half_space,
            ),
        ];
        let axis = |values: &mut dyn Iterator<Item = f64>, name: &str, symbol: &str, unit: &str| {
            let span = Span::around(
                values.map(|value| AxisScale::Logarithmic.coordinate(value)),
                0.05,
            );
            ChartAxis::new(AxisScale::Logarithmic, span, name, symbol, unit)
        };
        let x = axis(&mut loading.iter().map(force), "force", "F", "N");
        let ends = loading.iter().flat_map(|loaded| {
            let both = [loaded.indentation.line, loaded.indentation.half_space];
            both.into_iter()
                .flat_map(|all| [all.quartiles[0], all.quartiles[2], all.mean])
        });
        let y = axis(&mut { ends }, "indentation", "d", "m");
        let chart = Chart::new(x, y, layers.into_iter().flatten().collect());
        Some(Figure::of_chart(self.title, chart))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_data::Control;
    use asperity_scene::{Simulation, open};
    use asperity_study::half_space::ReferenceOptions;
    use asperity_study::trust::Budget;

    /// The figure has room for a curve and a band of each model.
    #[test]
    fn the_figure_has_both_models() {
        let document = open("jkr-sphere").unwrap();
        let options = ReferenceOptions {
            cells: 32,
            maps: 1,
            lines: 1,
        };
        let found = Reference::of(
            document.scene(),
            options,
            &mut Simulation::default(),
            Control::default().on_threads(1),
        )
        .unwrap();
        let report = ReferenceReport {
            title: "A sphere",
            scene: document.scene(),
            reference: &found,
        };
        let figure = report.figure().unwrap();
        assert_eq!(figure.size, Figure::WIDE);
        let legend: Vec<String> = figure
            .legend()
            .iter()
            .map(|entry| entry.name.to_string())
            .collect();
        assert_eq!(
            legend,
            [
                "line, mean and quartiles",
                "three dimensions, mean and quartiles"
            ]
        );
        assert_eq!(figure.charts[0].layers.len(), 4);
    }

    /// All numbers of the budget name the waves that are compared, and forces with few cells in
    /// contact are left out.
    #[test]
    fn what_is_left_out_is_said() {
        let document = open("pressure-sensitive").unwrap();
        let options = ReferenceOptions {
            cells: 64,
            maps: 2,
            lines: 32,
        };
        let found = Reference::of(
            document.scene(),
            options,
            &mut Simulation::default(),
            Control::default().on_threads(2),
        )
        .unwrap();
        let report = ReferenceReport {
            title: "Rough",
            scene: document.scene(),
            reference: &found,
        };
        let waves = ", of waves 4 to 8 of 4 to 512";
        let (rows, _) = report.errors();
        for (name, words) in &rows[1..4] {
            assert!(words.ends_with(waves), "{name}: {words}");
        }
        assert!(
            rows[3].1.starts_with("line against three dimensions, "),
            "{rows:?}"
        );
        let text = report.text().unwrap();
        assert!(
            text.contains("rms height h") && text.contains("e_el/γ with adhesion"),
            "{text}"
        );
        assert_eq!(
            text.contains("Left out are forces"),
            !found.left_out.is_empty(),
            "{text}"
        );
        let scene = document.scene();
        let outcome = asperity_scene::run(&document).unwrap();
        let budget = Budget::default();
        let rows = crate::trust::error_rows(scene, &outcome, None, &budget, None, Some(&found));
        let row = rows
            .iter()
            .find(|(name, _)| *name == "three dimensions")
            .unwrap();
        assert!(row.1.ends_with(waves), "{row:?}");
        let model = rows.iter().find(|(name, _)| *name == "model").unwrap();
        assert_eq!(model.1, model_words(&found));
        let sentence = model_sentence(&found).unwrap();
        assert!(sentence.contains(waves), "{sentence}");
    }

    /// The error of a smooth body of revolution is that of the grid, and not of the model.
    #[test]
    fn a_sphere_has_no_error_of_the_model() {
        let document = open("jkr-sphere").unwrap().set("length", "4.2e-5").unwrap();
        let options = ReferenceOptions {
            cells: 64,
            maps: 1,
            lines: 1,
        };
        let found = Reference::of(
            document.scene(),
            options,
            &mut Simulation::default(),
            Control::default().on_threads(1),
        )
        .unwrap();
        let report = ReferenceReport {
            title: "A sphere",
            scene: document.scene(),
            reference: &found,
        };
        let (rows, largest) = report.errors();
        assert!(largest.starts_with("The largest is the grid"), "{largest}");
        assert!(rows.contains(&(
            "model",
            "none: the line is exact for this body of revolution".to_owned()
        )));
        assert!(
            rows.contains(&("sample", "none: nothing is random".to_owned())),
            "{rows:?}"
        );
        assert!(!model_sentence(&found).unwrap().contains("at least"));
    }

    #[test]
    fn there_is_progress_before_the_first_square() {
        let mut progress = ReferenceProgress::default();
        let begins = ReferenceEvent::Begins {
            maps: 4,
            threads: 2,
            bytes: 1 << 20,
            seconds: 7200.0,
        };
        let (words, is_long) = progress.words(&begins);
        assert!(
            is_long && words.starts_with("4 squares on 2 threads: about 2 h"),
            "{words}"
        );
        let lines = progress
            .words(&ReferenceEvent::Profiles {
                count: 16,
                lines: 64,
            })
            .0;
        assert_eq!(lines, "lines: 25 %");
        let begun = progress
            .words(&ReferenceEvent::ProfilesEnd { lines: Vec::new() })
            .0;
        assert!(begun.starts_with("0 of 4 squares, 0 %, 2 h"), "{begun}");
        let loaded = progress.words(&ReferenceEvent::Loaded { share: 0.05 }).0;
        assert!(loaded.starts_with("0 of 4 squares, 5 %, "), "{loaded}");
        let square = ReferenceEvent::Square {
            curve: Vec::new(),
            headline: 1.0,
        };
        assert!(
            progress
                .words(&square)
                .0
                .starts_with("1 of 4 squares, 25 %, ")
        );
        for _ in 0..30 {
            progress.words(&ReferenceEvent::Loaded { share: 0.05 });
        }
        let most = progress.words(&ReferenceEvent::Loaded { share: 0.05 }).0;
        assert!(most.starts_with("1 of 4 squares, 99 %, "), "{most}");
    }
}
