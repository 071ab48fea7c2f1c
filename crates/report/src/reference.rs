//! Comparison of two computations of a scene, with profiles and in three dimensions, as text, JSON,
//! a table and a figure. In three dimensions, rough square surfaces (called squares) touch an
//! elastic half-space.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::status::duration;
use crate::warnings::{counted_section, counted_texts};
use crate::words::{counted, percent, whole_percent};
use asperity_contact::Move;
use asperity_data::{
    AxisScale, Note, Remedy, Table, Wording, format_quantity, format_rounded, grouped, memory_size,
};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Layer, Shape, Sign, Span, Stroke};
use asperity_scene::Scene;
use asperity_study::Statistics;
use asperity_study::half_space::{
    Compared, ComparedRoughness, LeftOut, Loaded, Reference, ReferenceBudget, ReferenceEvent,
    SquareLoops,
};
use serde::Serialize;
use std::time::{Duration, Instant};

/// Report on the comparison of two computations of a rough contact: with profiles, as this program
/// usually does, and in three dimensions.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceReport<'a> {
    pub title: &'a str,
    /// Scene that is computed in both ways.
    pub scene: &'a Scene,
    /// Results of both computations and their ratios.
    pub reference: &'a Reference,
    /// Function that states in words how the user takes a [`Remedy`], a step that removes the cause
    /// of an error or a warning. The words name an option of the command line, a row of the
    /// explorer or an argument of Python.
    pub wording: Wording,
}

/// Returns the ratio of the results of the two models, with the half-width of its interval, as
/// text: `0.84 ± 0.05`.
fn ratio(compared: &Compared) -> String {
    let ratio = decimals(compared.ratio);
    match compared.error {
        Some(error) => format!("{ratio} ± {}", decimals(error)),
        None => ratio,
    }
}

fn decimals(value: f64) -> String {
    if value < 10.0 {
        format!("{value:.2}")
    } else {
        format_rounded(value, 2, "1")
    }
}

/// A comparison that is estimated to take at least this time in s is announced as long.
const LONG: f64 = 10.0;

/// The remaining time is estimated from the progress after this share of the squares has been
/// computed.
const LEAST_SHARE: f64 = 0.02;

/// Progress, in words, of the comparison of a scene on profiles with the same scene in three
/// dimensions. Such a comparison computes the contact of several random rough squares.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceProgress {
    begun: Instant,
    maps: u64,
    done: u64,
    lines_done: u64,
    /// Estimated share of the computation of the squares that is finished.
    share: f64,
    /// Estimated time in s that the computation of all squares takes.
    seconds: f64,
}

impl Default for ReferenceProgress {
    fn default() -> Self {
        ReferenceProgress {
            begun: Instant::now(),
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
    /// value is true if the line announces a comparison that takes at least 10 s.
    pub fn words(&mut self, event: &ReferenceEvent) -> (String, bool) {
        let line = match *event {
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
                let squares = counted(maps, "square");
                let threads = counted(threads as u64, "thread");
                let time = in_words(seconds);
                let memory = memory_size(bytes);
                let line = format!("{squares} on {threads}: about {time} and {memory} of memory");
                return (line, seconds >= LONG);
            }
            ReferenceEvent::Profiles { count, lines } => {
                self.lines_done += count;
                format!("lines: {} %", 100 * self.lines_done / lines.max(1))
            }
            ReferenceEvent::ProfilesEnd { .. } => {
                self.begun = Instant::now();
                self.squares_in_words()
            }
            ReferenceEvent::Loaded { share } => {
                // The number of loads is estimated in advance. Therefore the sum of the shares may
                // exceed 1 before the end.
                self.share = (self.share + share).min(0.99);
                self.squares_in_words()
            }
            ReferenceEvent::Square { .. } => {
                self.done += 1;
                self.squares_in_words()
            }
        };
        (line, false)
    }

    /// Returns in words how many squares are finished, which share of the computation is finished,
    /// and the remaining time.
    fn squares_in_words(&self) -> String {
        let share_of_squares = self.done as f64 / self.maps.max(1) as f64;
        let share = self.share.max(share_of_squares);
        let left = if share < LEAST_SHARE {
            self.seconds
        } else {
            self.begun.elapsed().as_secs_f64() * (1.0 - share) / share
        };
        let done = self.done;
        let squares = counted(self.maps, "square");
        let share = whole_percent(share);
        let left = in_words(left);
        format!("{done} of {squares}, {share}, {left} left")
    }

    /// Returns in words how many finished squares are lost if the user stops the comparison now.
    pub fn lost(&self) -> String {
        if self.maps == 0 {
            return "stopped before the first square".to_owned();
        }
        let squares = counted(self.maps, "square");
        format!("stopped after {} of {squares}, which are lost", self.done)
    }
}

fn in_words(seconds: f64) -> String {
    duration(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX))
}

/// Returns in a few words the progress of the computation of force loops of random rough squares in
/// three dimensions. After the first results, the words state a ratio: the result with profiles
/// divided by the result in three dimensions. The result is the adhesion force, or the indentation
/// if `is_adhesive` is false.
pub fn square_loops_words(loops: &SquareLoops, is_adhesive: bool) -> String {
    let maps = loops.maps;
    let Some(compared) = loops.headline() else {
        if maps == 0 {
            return "three dimensions: begins".to_owned();
        }
        let share = whole_percent(loops.share);
        return format!("three dimensions: 0 of {maps} squares, {share}");
    };
    let symbol = if is_adhesive { "F_a" } else { "d" };
    let ratio = ratio(&compared);
    let squares = match &loops.reference {
        Some(reference) => omitted_waves(reference),
        None => format!(", {} of {maps} squares", loops.curves.len()),
    };
    format!("{symbol} line/three dimensions {ratio}{squares}")
}

/// Returns a sentence with a ratio and the error of the model that follows from the ratio. The
/// ratio is the mean over random profiles divided by the mean in three dimensions. The means are of
/// the adhesion force, or of the indentation without adhesion. Returns `None` if the ratio is
/// unknown.
pub fn model_sentence(reference: &Reference) -> Option<String> {
    let ratio = ratio(reference.headline()?);
    let quantity = if reference.adhesion_force.is_some() {
        "the adhesion force"
    } else {
        "the indentation"
    };
    let waves = omitted_waves(reference);
    let error = error_sentence(reference);
    Some(format!(
        "The mean of {quantity} over random lines is {ratio} times the mean over random squares in three dimensions{waves}. {error}"
    ))
}

/// Returns a sentence on the error of the model.
fn error_sentence(reference: &Reference) -> String {
    if reference.line_is_exact {
        return "The model is exact for this body, so that the difference is an error of the grid of the squares."
            .to_owned();
    }
    match reference.budget.model {
        Some(model) if model > 0.0 => {
            let error = percent(model, 2);
            let waves = omitted_waves(reference);
            format!(
                "The error of the model, at least {error}{waves}, remains with any number of springs."
            )
        }
        Some(_) => "Sample and grid of the squares can explain the difference.".to_owned(),
        None => "The error of the model is not known.".to_owned(),
    }
}

/// Returns in words the relative difference between the results with profiles and in three
/// dimensions, with its 95 % interval: `line against three dimensions, +4 ± 45 %`. If the squares
/// lack waves of the scene, the words also state which waves are compared. Returns `None` if the
/// difference is unknown.
pub fn difference_words(reference: &Reference) -> Option<String> {
    let compared = reference.headline()?;
    let sign = if compared.difference() > 0.0 { "+" } else { "" };
    let difference = format_rounded(100.0 * compared.difference(), 2, "1");
    let error = match compared.error {
        Some(error) => format!(" ± {}", percent(error, 2)),
        None => " %".to_owned(),
    };
    let waves = omitted_waves(reference);
    Some(format!(
        "line against three dimensions, {sign}{difference}{error}{waves}"
    ))
}

/// Returns the error of the model in words: the part of the difference that exceeds the errors of
/// sample and grid.
pub fn model_words(reference: &Reference) -> String {
    if reference.line_is_exact {
        return "none: the line is exact for this body of revolution".to_owned();
    }
    match reference.budget.model {
        Some(model) if model > 0.0 => {
            let error = percent(model, 2);
            let waves = omitted_waves(reference);
            format!("at least {error}, beyond sample and grid{waves}")
        }
        Some(_) => "not distinguished from sample and grid".to_owned(),
        None if reference.budget.grid.is_none() => {
            "not known, because the error of the grid is not known".to_owned()
        }
        None => "not known, because the error of the sample is not known".to_owned(),
    }
}

/// Returns which waves are compared if the squares lack waves of the scene; otherwise an empty
/// text. The waves are given by their numbers of periods over the length, for example
/// `, of waves 4 to 8 of 4 to 3 200`.
pub fn omitted_waves(reference: &Reference) -> String {
    let (Some((first, last)), Some(last_of_scene)) = (reference.waves, reference.omitted) else {
        return String::new();
    };
    let first = grouped(first);
    let last = grouped(last);
    let last_of_scene = grouped(last_of_scene);
    format!(", of waves {first} to {last} of {first} to {last_of_scene}")
}

fn percent_or_unknown(share: Option<f64>) -> String {
    share.map_or_else(|| "not known".to_owned(), |share| percent(share, 2))
}

/// Returns the headings of a table that compares both models.
fn header() -> [String; 4] {
    ["", "line", "three dimensions", "ratio"].map(String::from)
}

/// Returns the headings of a table that compares both models and states the error of the grid of
/// the squares.
fn header_with_grid() -> [String; 5] {
    ["", "line", "three dimensions", "ratio", "grid"].map(String::from)
}

/// Returns the row of a quantity in a table that compares both models and states the error of the
/// grid.
fn compared_row(name: String, compared: &Compared, unit: &str) -> [String; 5] {
    [
        name,
        format_rounded(compared.line.mean, 3, unit),
        format_rounded(compared.half_space.mean, 3, unit),
        ratio(compared),
        percent_or_unknown(compared.grid),
    ]
}

/// Returns the row of a quantity in the table of the roughness of profiles and squares.
fn roughness_row(name: &str, line: f64, half_space: f64, unit: &str) -> [String; 4] {
    [
        name.to_owned(),
        format_rounded(line, 3, unit),
        format_rounded(half_space, 3, unit),
        format!("{:.2}", line / half_space),
    ]
}

impl ReferenceReport<'_> {
    /// Returns sentences that state which bodies and which waves are compared.
    fn compared(&self) -> String {
        let options = &self.reference.options;
        let cells = options.cells;
        let Some((first, last)) = self.reference.waves else {
            return format!("A square of {cells} × {cells} cells and a line, both smooth.");
        };
        let maps = grouped(options.maps);
        let lines = grouped(options.lines);
        let first = grouped(first);
        let last = grouped(last);
        let mut sentences = format!(
            "Means over {maps} random squares of {cells} × {cells} cells and over {lines} random lines, of {first} to {last} \
             waves over the length."
        );
        if let Some(last_of_scene) = self.reference.omitted {
            let last_of_scene = grouped(last_of_scene);
            sentences += &format!(
                " The squares do not resolve the waves up to {last_of_scene} of the scene, which both models leave out: {}.",
                (self.wording)(&Remedy::FinerGrid)
            );
        }
        sentences
    }

    /// Returns a sentence on the part of the loading that is compared; `None` if this is the whole
    /// loading of the scene.
    fn compared_loading(&self) -> Option<String> {
        let reference = self.reference;
        if reference.compared_loading[..] == self.scene.loading[..] {
            return None;
        }
        let turn = match reference.compared_loading[0] {
            Move::ToIndentation(indentation) => {
                format!("an indentation of {}", format_rounded(indentation, 3, "m"))
            }
            Move::ToDisplacement(displacement) => {
                format!("a displacement of {}", format_rounded(displacement, 3, "m"))
            }
            _ => format_rounded(reference.preload, 3, "N"),
        };
        Some(format!(
            "The last loop of the loading is compared: from separation to {turn}, and back."
        ))
    }

    /// Adds a table of the roughness of the equivalent lines (profiles) and of the square surfaces
    /// on the half-space.
    fn add_roughness(&self, sheet: &mut Sheet) {
        let Some(roughness) = self.reference.roughness else {
            return;
        };
        let line = roughness.line;
        let square = roughness.half_space;
        let mut rows = vec![
            header(),
            roughness_row("rms height h", line.rms_height, square.rms_height, "m"),
            roughness_row(
                "rms gradient ⟨∇z⟩",
                line.rms_gradient,
                square.rms_gradient,
                "1",
            ),
            roughness_row(
                "elastic energy e_el",
                line.elastic_energy,
                square.elastic_energy,
                "J/m²",
            ),
        ];
        let mut scaled = None;
        let work = self.reference.work_of_adhesion;
        if let (Some(adhesive), Some(work)) = (roughness.adhesive_half_space, work) {
            let of_line = line.elastic_energy / work;
            let of_square = adhesive.elastic_energy / work;
            rows.push(roughness_row(
                "e_el/γ with adhesion",
                of_line,
                of_square,
                "1",
            ));
            let factor = adhesive.rms_height / square.rms_height;
            scaled = Some(format!(
                "With adhesion the heights of the squares are multiplied by {factor:.3}, so that e_el/γ is the same."
            ));
        }
        sheet.heading("Roughness of what is compared");
        sheet.table(&rows);
        if let Some(sentence) = scaled {
            sheet.paragraph(&sentence);
        }
    }

    /// Adds a table of the loading without adhesion, and a sentence on the forces that are not
    /// compared.
    fn add_loading(&self, sheet: &mut Sheet) {
        sheet.heading(
            "Without adhesion, indentations from first touch, ratio of the line to three dimensions",
        );
        let mut rows = vec![header_with_grid()];
        for loaded in &self.reference.loading {
            let force = format_rounded(loaded.force, 3, "N");
            let indentation = format!("indentation at {force}");
            rows.push(compared_row(indentation, &loaded.indentation, "m"));
            let stiffness = format!("stiffness at {force}");
            rows.push(compared_row(stiffness, &loaded.stiffness, "N/m"));
        }
        if rows.len() > 1 {
            sheet.table(&rows);
        }
        if let Some(sentence) = self.left_out() {
            sheet.paragraph(&sentence);
        }
    }

    /// Adds a table of the adhesion in both models. Adds nothing for a scene without adhesion.
    fn add_adhesion(&self, sheet: &mut Sheet) {
        let reference = self.reference;
        let quantities = [
            ("adhesion force F_a", &reference.adhesion_force, "N"),
            (
                "at first touch F_a(d=0)",
                &reference.first_touch_adhesion_force,
                "N",
            ),
            ("dissipated energy", &reference.dissipated_energy, "J"),
        ];
        let mut rows = vec![header_with_grid()];
        for (name, compared, unit) in quantities {
            if let Some(compared) = compared {
                rows.push(compared_row(name.to_owned(), compared, unit));
            }
        }
        if rows.len() > 1 {
            let preload = format_quantity(reference.preload, "N");
            sheet.heading(&format!(
                "With adhesion, after a preload of {preload}, ratio of the line to three dimensions"
            ));
            sheet.table(&rows);
        }
    }

    /// Returns a sentence on the forces that are not compared, because too few grid cells are in
    /// contact; `None` if there are no such forces.
    fn left_out(&self) -> Option<String> {
        let left_out = &self.reference.left_out;
        let finer_grid = left_out.first()?.grid;
        let least = Loaded::LEAST_CELLS;
        let mut forces = Vec::new();
        for left_out in left_out {
            let force = format_rounded(left_out.force, 3, "N");
            let cells = format_rounded(left_out.cells, 2, "1");
            forces.push(format!("{force} ({cells})"));
        }
        let forces = forces.join(", ");
        let help = match finer_grid {
            Some(grid) => format!("; {} may add them", (self.wording)(&Remedy::Grid(grid))),
            None => String::new(),
        };
        Some(format!(
            "Left out are forces at which fewer than {least} cells of a square are in contact on the average: {forces}{help}."
        ))
    }

    /// Returns the error of each source as text, and a sentence on the largest error.
    fn errors(&self) -> (Vec<(&'static str, String)>, String) {
        let reference = self.reference;
        let budget = &reference.budget;
        let sample = if reference.waves.is_some() {
            self.with_waves(budget.sample)
        } else {
            "none: nothing is random".to_owned()
        };
        let difference = difference_words(reference).unwrap_or_else(|| percent_or_unknown(None));
        let rows = vec![
            ("solver", format!("{:.0e} of the rms height", budget.solver)),
            ("grid of the squares", self.with_waves(budget.grid)),
            ("sample", sample),
            ("three dimensions", difference),
            ("model", model_words(reference)),
        ];
        (rows, self.largest_error())
    }

    /// Returns an error as text. If some waves of the scene are not compared, the text also states
    /// the compared waves.
    fn with_waves(&self, error: Option<f64>) -> String {
        let words = percent_or_unknown(error);
        if error.is_none() {
            return words;
        }
        words + &omitted_waves(self.reference)
    }

    /// Returns a sentence that names the largest error.
    fn largest_error(&self) -> String {
        let budget = &self.reference.budget;
        match (budget.largest, budget.model) {
            ("model", Some(model)) => {
                let error = percent(model, 2);
                let waves = omitted_waves(self.reference);
                format!(
                    "The largest is the model, at least {error}{waves}: more springs do not help."
                )
            }
            ("sample", _) => Note::new("The largest is the sample of squares and lines.")
                .with(Remedy::Maps)
                .in_words(self.wording),
            ("grid", _) => Note::new("The largest is the grid of the squares.")
                .with(Remedy::FinerGrid)
                .in_words(self.wording),
            _ => "The largest known error is the residual of the solver.".to_owned(),
        }
    }
}

impl Report for ReferenceReport<'_> {
    fn text(&self) -> Option<String> {
        let reference = self.reference;
        let mut sheet = Sheet::default();
        sheet.paragraph(self.title);
        sheet.heading(&self.compared());
        let profiles = reference.profiles_for_warnings();
        counted_section(&mut sheet, &reference.warnings, profiles);
        if let Some(sentence) = self.compared_loading() {
            sheet.paragraph(&sentence);
        }
        self.add_roughness(&mut sheet);
        self.add_loading(&mut sheet);
        self.add_adhesion(&mut sheet);

        let (rows, largest) = self.errors();
        sheet.heading("Errors of the comparison by their sources");
        for (source, words) in rows {
            sheet.row(source, words);
        }
        sheet.paragraph(&largest);

        let [lines, squares] = reference
            .seconds
            .map(|seconds| format_quantity(seconds, "s"));
        let convolutions = grouped(reference.convolutions);
        sheet.heading(&format!(
            "Time: {lines} for the lines; {squares} and {convolutions} convolutions for the squares."
        ));
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(ReferenceJson::new(self)))
    }

    /// Returns a table of the loading without adhesion, with a row for each force. For the
    /// indentation and the stiffness at this force, a row has the mean over profiles, the mean in
    /// three dimensions, and the ratio of these means.
    fn table(&self) -> Option<Table<'_>> {
        let table = Table::of(|| self.reference.loading.iter())
            .real("force", |loaded| loaded.force)
            .real("indentation_line", |loaded| loaded.indentation.line.mean)
            .real("indentation_half_space", |loaded| {
                loaded.indentation.half_space.mean
            })
            .real("indentation_ratio", |loaded| loaded.indentation.ratio)
            .real("indentation_ratio_error", |loaded| loaded.indentation.error)
            .real("indentation_grid", |loaded| loaded.indentation.grid)
            .real("stiffness_line", |loaded| loaded.stiffness.line.mean)
            .real("stiffness_half_space", |loaded| {
                loaded.stiffness.half_space.mean
            })
            .real("stiffness_ratio", |loaded| loaded.stiffness.ratio)
            .real("stiffness_ratio_error", |loaded| loaded.stiffness.error)
            .real("stiffness_grid", |loaded| loaded.stiffness.grid)
            .real("area_half_space", |loaded| loaded.area);
        Some(table.done())
    }

    /// Returns a chart of the loading without adhesion. For both models, it shows the mean and the
    /// quartiles of the indentation at each force.
    fn figure(&self) -> Option<Figure> {
        let loading = &self.reference.loading;
        let mut forces = Vec::new();
        let mut indentations = Vec::new();
        for loaded in loading {
            forces.push(loaded.force);
            for statistics in [loaded.indentation.line, loaded.indentation.half_space] {
                let [lower, _, upper] = statistics.quartiles;
                indentations.extend([lower, upper, statistics.mean]);
            }
        }
        let x = logarithmic_axis(&forces, "force", "F", "N");
        let y = logarithmic_axis(&indentations, "indentation", "d", "m");
        let line = LayersOfModel {
            name: "line",
            ink: Ink::Series(0),
            sign: Sign::Dot,
            indentation: |loaded| loaded.indentation.line,
        };
        let square = LayersOfModel {
            name: "three dimensions",
            ink: Ink::Series(1),
            sign: Sign::Diamond,
            indentation: |loaded| loaded.indentation.half_space,
        };
        let mut layers = line.layers(loading);
        layers.extend(square.layers(loading));
        Some(Figure::of_chart(self.title, Chart::new(x, y, layers)))
    }
}

/// Returns a logarithmic axis that contains these values and a margin.
fn logarithmic_axis(values: &[f64], name: &str, symbol: &str, unit: &str) -> ChartAxis {
    let scale = AxisScale::Logarithmic;
    let coordinates = values.iter().map(|value| scale.coordinate(*value));
    ChartAxis::new(scale, Span::around(coordinates, 0.05), name, symbol, unit)
}

/// Style in which the chart shows the indentation of one model over the force.
struct LayersOfModel {
    name: &'static str,
    ink: Ink,
    sign: Sign,
    /// Function that returns the indentation of the model at a force.
    indentation: fn(&Loaded) -> Statistics,
}

impl LayersOfModel {
    /// Returns a band of the quartiles and a curve of the means.
    fn layers(&self, loading: &[Loaded]) -> Vec<Layer> {
        let mut band = Vec::with_capacity(loading.len());
        let mut means = Vec::with_capacity(loading.len());
        for loaded in loading {
            let indentation = (self.indentation)(loaded);
            let [lower, _, upper] = indentation.quartiles;
            band.push((loaded.force, lower, upper));
            means.push((loaded.force, indentation.mean));
        }
        let curve = Shape::Curve {
            points: means,
            stroke: Some(Stroke::Solid),
            sign: Some(self.sign),
        };
        let name = format!("{}, mean and quartiles", self.name);
        vec![
            Layer::unnamed(self.ink, Shape::Band(band)),
            Layer::new(name.as_str().into(), self.ink, curve),
        ]
    }
}

/// JSON object of a comparison of profiles with three dimensions, in SI units.
#[derive(Serialize)]
struct ReferenceJson<'a> {
    scene: &'a Scene,
    warnings: Vec<String>,
    cells: usize,
    maps: u64,
    lines: u64,
    waves: Option<(u64, u64)>,
    omitted: Option<u64>,
    compared_loading: [Move; 2],
    preload: f64,
    work_of_adhesion: Option<f64>,
    line: ModelJson<Statistics>,
    half_space: ModelJson<Statistics>,
    adhesive_half_space: Option<ComparedRoughness>,
    ratio: ModelJson<RatioJson>,
    left_out: &'a [LeftOut],
    line_is_exact: bool,
    budget: ReferenceBudget,
    convolutions: u64,
    seconds: [f64; 2],
    seconds_of_square: f64,
}

/// Numbers of one model, or ratios of the numbers of both models.
#[derive(Serialize)]
struct ModelJson<V> {
    #[serde(flatten)]
    roughness: Option<ComparedRoughness>,
    adhesion_force: Option<V>,
    first_touch_adhesion_force: Option<V>,
    dissipated_energy: Option<V>,
    loading: Vec<LoadedJson<V>>,
}

/// Numbers of one model, or ratios of both models, at one force of the loading without adhesion.
#[derive(Serialize)]
struct LoadedJson<V> {
    force: f64,
    indentation: V,
    stiffness: V,
    /// Mean area of contact of the squares in m².
    #[serde(skip_serializing_if = "Option::is_none")]
    contact_area: Option<f64>,
    /// Relative error due to the grid of the squares. The outer `None` leaves out the entry in the
    /// JSON object, and the inner `None` is an unknown error.
    #[serde(skip_serializing_if = "Option::is_none")]
    grid: Option<Option<f64>>,
}

/// Ratio of the means that the two models give.
#[derive(Serialize)]
struct RatioJson {
    value: f64,
    error: Option<f64>,
    grid: Option<f64>,
}

impl RatioJson {
    fn new(compared: &Compared) -> Self {
        RatioJson {
            value: compared.ratio,
            error: compared.error,
            grid: compared.grid,
        }
    }
}

impl<V> ModelJson<V> {
    /// Collects one number from each comparison of a quantity. The roughness, the areas of contact
    /// and the errors of the grid are not set.
    fn new(reference: &Reference, number: fn(&Compared) -> V) -> Self {
        let mut loading = Vec::with_capacity(reference.loading.len());
        for loaded in &reference.loading {
            loading.push(LoadedJson {
                force: loaded.force,
                indentation: number(&loaded.indentation),
                stiffness: number(&loaded.stiffness),
                contact_area: None,
                grid: None,
            });
        }
        ModelJson {
            roughness: None,
            adhesion_force: reference.adhesion_force.as_ref().map(number),
            first_touch_adhesion_force: reference.first_touch_adhesion_force.as_ref().map(number),
            dissipated_energy: reference.dissipated_energy.as_ref().map(number),
            loading,
        }
    }

    /// Adds, at each force, the error due to the grid of the squares.
    fn with_grid(mut self, reference: &Reference) -> Self {
        for (point, loaded) in self.loading.iter_mut().zip(&reference.loading) {
            point.grid = Some(loaded.grid());
        }
        self
    }

    /// Adds, at each force, the area of contact of the squares.
    fn with_area(mut self, reference: &Reference) -> Self {
        for (point, loaded) in self.loading.iter_mut().zip(&reference.loading) {
            point.contact_area = Some(loaded.area);
        }
        self
    }
}

impl<'a> ReferenceJson<'a> {
    fn new(report: &ReferenceReport<'a>) -> Self {
        let reference = report.reference;
        let roughness = reference.roughness;
        let profiles = reference.profiles_for_warnings();
        let line = ModelJson::new(reference, |compared| compared.line);
        let half_space = ModelJson::new(reference, |compared| compared.half_space)
            .with_area(reference)
            .with_grid(reference);
        let ratio = ModelJson::new(reference, RatioJson::new).with_grid(reference);
        ReferenceJson {
            scene: report.scene,
            warnings: counted_texts(&reference.warnings, profiles),
            cells: reference.options.cells,
            maps: reference.options.maps,
            lines: reference.options.lines,
            waves: reference.waves,
            omitted: reference.omitted,
            compared_loading: reference.compared_loading,
            preload: reference.preload,
            work_of_adhesion: reference.work_of_adhesion,
            line: ModelJson {
                roughness: roughness.map(|roughness| roughness.line),
                ..line
            },
            half_space: ModelJson {
                roughness: roughness.map(|roughness| roughness.half_space),
                ..half_space
            },
            adhesive_half_space: roughness.and_then(|roughness| roughness.adhesive_half_space),
            ratio,
            left_out: &reference.left_out,
            line_is_exact: reference.line_is_exact,
            budget: reference.budget,
            convolutions: reference.convolutions,
            seconds: reference.seconds,
            seconds_of_square: reference.seconds_of_square,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_data::Control;
    use asperity_scene::{Simulation, open};
    use asperity_study::half_space::ReferenceOptions;
    use asperity_study::trust::Budget;

    /// The figure shows a curve and a band for each model within its axes.
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
            wording: |remedy| format!("{remedy:?}"),
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

    /// All errors of the budget state which waves are compared. Forces at which few cells are in
    /// contact are not compared.
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
            wording: |remedy| format!("{remedy:?}"),
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
        let rows = crate::trust::error_rows(
            scene,
            &outcome,
            None,
            &budget,
            None,
            Some(&found),
            |remedy| format!("{remedy:?}"),
        );
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

    /// For a smooth body of revolution the difference is an error of the grid and not of the model.
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
            wording: |remedy| format!("{remedy:?}"),
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
