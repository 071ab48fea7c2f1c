//! A result has up to four forms: text, JSON, table and figure. A format says how a form is written
//! into a file.

use crate::provenance::{entries, with_warnings};
use asperity_data::{Kind, Table, path_name, printable, write_json};
use asperity_plot::{Chart, ChartAxis, Figure, Layer};
use serde::Serialize;
use std::io;
use std::io::Write;
use std::path::Path;
use strum::IntoStaticStr;

/// Result that can be written in one or more of four forms: text, JSON, table, figure. The method
/// of a missing form returns `None`.
pub trait Report {
    /// Returns the result as plain text of at most 80 columns; `None` if the result has no text.
    fn text(&self) -> Option<String> {
        None
    }

    /// Returns the result as JSON; `None` if the result cannot be written as JSON.
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        None
    }

    /// Returns the result as a table; `None` if the result has no table.
    fn table(&self) -> Option<Table<'_>> {
        None
    }

    /// Returns the result as a figure; `None` if the result has no figure.
    fn figure(&self) -> Option<Figure> {
        None
    }

    /// Returns a sentence for each premise of the model that the result does not meet; empty if all
    /// premises are met.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }
}

/// Value that can be written as JSON.
pub trait Json {
    /// Writes the value as JSON. If the value is an object, its first entries are the keys and
    /// texts of `head`.
    fn write_json(&self, out: &mut dyn Write, head: &[(&str, &str)]) -> io::Result<()>;
}

impl<T: Serialize> Json for T {
    fn write_json(&self, out: &mut dyn Write, head: &[(&str, &str)]) -> io::Result<()> {
        write_json(out, self, head)
    }
}

/// Report that consists of a figure. If the figure has a single chart, the points of its curves can
/// also be written as a table.
impl Report for Figure {
    /// Returns a table with a row for each point of each curve of the chart; `None` for a figure of
    /// several charts.
    fn table(&self) -> Option<Table<'_>> {
        let [Chart { x, y, layers, .. }] = &self.charts[..] else {
            return None;
        };
        let longest_name = layers
            .iter()
            .map(|layer| layer.name.to_string().chars().count())
            .max()?;
        let rows = || layers.iter().flat_map(curve_points);
        let table = Table::of(rows)
            .with("curve", Kind::Text(longest_name), |row| row.curve.clone())
            .with(column_name(x), Kind::Real, |row| row.x)
            .with(column_name(y), Kind::Real, |row| row.y);
        Some(table.done())
    }

    fn figure(&self) -> Option<Figure> {
        Some(self.clone())
    }
}

/// Point on a curve of a chart, with the name of the curve.
struct PointOfCurve {
    /// Name of the curve.
    curve: String,
    x: f64,
    y: f64,
}

fn curve_points(layer: &Layer) -> Vec<PointOfCurve> {
    let mut points = Vec::new();
    for (x, y) in layer.shape.points() {
        let curve = layer.name.to_string();
        points.push(PointOfCurve { curve, x, y });
    }
    points
}

/// Returns the name of the column of an axis, such as `F (N)`.
fn column_name(axis: &ChartAxis) -> String {
    format!("{} ({})", axis.symbol_or_name(), axis.unit)
}

/// Writes a report in a format. `provenance` has the lines of
/// [`scene_provenance`](crate::scene_provenance). These lines are written only into CSV, SVG and
/// JSON. In CSV and SVG the warnings of the report follow them, so that a table or a figure that is
/// passed on still states which premises of the model it does not meet.
///
/// # Errors
/// Returns an error if the report lacks the form that the format needs, or if the output cannot be
/// written.
pub fn write(
    out: &mut dyn Write,
    report: &(impl Report + ?Sized),
    format: Format,
    provenance: &str,
) -> io::Result<()> {
    let missing = || missing_form(format);
    match format {
        Format::Text => out.write_all(report.text().ok_or_else(missing)?.as_bytes()),
        Format::Json => report
            .json()
            .ok_or_else(missing)?
            .write_json(out, &entries(provenance)),
        Format::Csv => report
            .table()
            .ok_or_else(missing)?
            .write_csv(out, &with_warnings(provenance, &report.warnings())),
        Format::Npy => report.table().ok_or_else(missing)?.write_npy(out),
        Format::Svg => {
            let figure = Figure {
                origin: with_warnings(provenance, &report.warnings()),
                ..report.figure().ok_or_else(missing)?
            };
            out.write_all(figure.svg().as_bytes())
        }
        Format::Png => out.write_all(&report.figure().ok_or_else(missing)?.png()?),
        Format::Pdf => out.write_all(&report.figure().ok_or_else(missing)?.pdf()?),
    }
}

/// Returns the error of a result that lacks the form of a format.
pub fn missing_form(format: Format) -> io::Error {
    io::Error::other(format!("this result has no {} form", format.name()))
}

/// Format in which a result is written into a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, IntoStaticStr)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[strum(serialize_all = "lowercase")]
pub enum Format {
    /// Plain text for readers.
    Text,
    /// JSON object in SI units.
    Json,
    /// Table with a comma between its columns (CSV).
    Csv,
    /// Table as an array of NumPy (NPY).
    Npy,
    /// Vector graphic for the web (SVG).
    Svg,
    /// Picture of pixels (PNG).
    Png,
    /// Vector graphic on a page as large as the picture (PDF).
    Pdf,
}

impl Format {
    /// All formats in which results can be written. A result without a table, for example, cannot
    /// be written in the formats of tables.
    pub const ALL: [Format; 7] = [
        Format::Text,
        Format::Json,
        Format::Csv,
        Format::Npy,
        Format::Svg,
        Format::Png,
        Format::Pdf,
    ];

    /// Returns the name of the format on the command line, such as `csv`.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Returns the extension of a file of this format, without the dot.
    pub fn extension(self) -> &'static str {
        if self == Format::Text {
            "txt"
        } else {
            self.name()
        }
    }

    /// Returns true for CSV and NPY, the formats of tables.
    pub fn is_table(self) -> bool {
        matches!(self, Format::Csv | Format::Npy)
    }

    /// Returns true for SVG, PNG and PDF, the formats of pictures.
    pub fn is_picture(self) -> bool {
        matches!(self, Format::Svg | Format::Png | Format::Pdf)
    }

    /// Returns the format in which a result is written: the format of the extension of `file`;
    /// without an extension, the format `chosen` by the user; otherwise `usual`. `formats` are the
    /// formats that the result has.
    ///
    /// # Errors
    /// Returns an error if the chosen format or the format of the extension is not among `formats`,
    /// or if they differ.
    pub fn of_file(
        file: Option<&Path>,
        chosen: Option<Format>,
        formats: &[Format],
        usual: Format,
    ) -> Result<Format, String> {
        if let Some(chosen) = chosen
            && !formats.contains(&chosen)
        {
            let name = chosen.name();
            let allowed = alternatives("", formats.iter().map(|format| format.name()));
            return Err(format!(
                "format {name}: this result has no such format; use {allowed}"
            ));
        }
        let extensions: Vec<_> = formats.iter().map(|format| format.extension()).collect();
        let file = file.unwrap_or(Path::new(""));
        let place = check_extension(file, &extensions)
            .map_err(|error| format!("{}: {error}", path_name(file)))?;
        let Some(place) = place else {
            return Ok(chosen.unwrap_or(usual));
        };
        let format_of_extension = formats[place];
        match chosen {
            Some(chosen) if chosen != format_of_extension => {
                let file = path_name(file);
                let name = chosen.name();
                let extension = chosen.extension();
                Err(format!(
                    "{file}: the extension contradicts the format {name}; use .{extension}, or state no format"
                ))
            }
            _ => Ok(format_of_extension),
        }
    }
}

/// Returns the index in `allowed` of the extension of a file; `None` if the name of the file has no
/// extension.
///
/// # Errors
/// Returns an error if the extension is not in `allowed`.
pub fn check_extension(file: &Path, allowed: &[&str]) -> Result<Option<usize>, String> {
    let Some(extension) = file
        .extension()
        .map(|extension| extension.to_string_lossy())
    else {
        return Ok(None);
    };
    let place = allowed
        .iter()
        .position(|allowed| extension.eq_ignore_ascii_case(allowed));
    if place.is_some() {
        return Ok(place);
    }
    let extension = printable(&extension);
    let allowed = alternatives(".", allowed.iter().copied());
    Err(format!(
        "unsupported file extension .{extension}; use {allowed}"
    ))
}

/// Returns alternatives in words, such as `.txt, .json or .csv`. The text `before` is put in front
/// of each word.
pub fn alternatives<'a>(before: &str, words: impl Iterator<Item = &'a str>) -> String {
    let words: Vec<String> = words.map(|word| format!("{before}{word}")).collect();
    match words.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => words.concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_format_follows_the_extension() {
        let formats = [Format::Text, Format::Json, Format::Svg];
        let of = |path: &str, chosen| {
            Format::of_file(Some(Path::new(path)), chosen, &formats, Format::Text)
        };
        for (path, chosen, expected) in [
            ("a.json", None, Format::Json),
            ("a.SVG", None, Format::Svg),
            ("a.json", Some(Format::Json), Format::Json),
            ("a", None, Format::Text),
            ("json", Some(Format::Svg), Format::Svg),
        ] {
            assert_eq!(of(path, chosen), Ok(expected), "{path}");
        }
        for path in ["a.csv", "a.json.gz", "a.dat", "b/a.PNG"] {
            let extension = path.rsplit_once('.').unwrap().1;
            let expected =
                format!("{path}: unsupported file extension .{extension}; use .txt, .json or .svg");
            assert_eq!(of(path, None), Err(expected.clone()));
            assert_eq!(of(path, Some(Format::Json)), Err(expected));
        }
        let expected =
            "a.svg: the extension contradicts the format text; use .txt, or state no format";
        assert_eq!(of("a.svg", Some(Format::Text)), Err(expected.to_owned()));
        let expected = "format csv: this result has no such format; use text, json or svg";
        assert_eq!(of("a", Some(Format::Csv)), Err(expected.to_owned()));
    }

    /// The test has figures of every kind, of usual scenes and of scenes without adhesion,
    /// roughness or contact.
    #[test]
    fn every_figure_lies_within_its_picture() {
        use crate::preloads::PreloadReport;
        use crate::reversals::ReversalReport;
        use crate::run::RunReport;
        use crate::scene_figure::ContactSets;
        use crate::scene_spectra::SceneSpectra;
        use crate::scenes::{ComparedScene, ScenesReport};
        use asperity_plot::judge::check_picture;
        use asperity_scene::{Simulation, open};
        use asperity_study::{Axis, Results, Staircase};
        let few = ("numerics.points", "512");
        let rough = [few, ("roughness.modes", "(1, 64)")];
        for (name, overrides) in [
            ("jkr-sphere", &[few][..]),
            (
                "jkr-sphere",
                &[few, ("adhesion", "None"), ("loading", "[ToTouch]")],
            ),
            ("pressure-sensitive", &rough),
            (
                "pressure-sensitive",
                &[
                    few,
                    ("roughness", "None"),
                    ("adhesion", "(work: 0.05)"),
                    ("title", "\"a <&> b\""),
                ],
            ),
        ] {
            let overrides = overrides
                .iter()
                .map(|(path, value)| (path.to_string(), value.to_string()));
            let document = open(name)
                .unwrap()
                .set_all(&overrides.collect::<Vec<_>>())
                .unwrap();
            let (scene, title) = (document.scene(), document.title());
            let mut simulation = Simulation::default();
            let mut sets = ContactSets::new(true);
            let mut observe = |_, record: &_, stage: &_| {
                sets.observe(record, stage);
                Ok(())
            };
            let outcome = simulation.run(scene, &|| false, &mut observe).unwrap();
            let spectra = SceneSpectra::new(scene, &outcome, &mut simulation).unwrap();
            let line = simulation.make_line(scene).unwrap().0.clone();
            let compared = |outcome| ComparedScene {
                document: &document,
                outcome,
                ensemble: None,
            };
            let scenes = [outcome.clone(), outcome.clone()].map(compared);
            let mut figures = vec![
                RunReport {
                    wording: |remedy| format!("{remedy:?}"),
                    title,
                    scene,
                    outcome: &outcome,
                    choice: None,
                    estimate: None,
                    ensemble: None,
                    deviation: None,
                }
                .figure()
                .unwrap(),
                ScenesReport {
                    scenes: &scenes,
                    panels: false,
                }
                .figure()
                .unwrap(),
                ScenesReport {
                    scenes: &scenes,
                    panels: true,
                }
                .figure()
                .unwrap(),
                sets.profile_figure(title, &outcome, &line),
                sets.patches_figure(title, &outcome),
                Figure::of_chart(title, spectra.spectra.chart()),
            ];
            if let Ok(map) = simulation.reversal_map(scene, None, 16, &|| false) {
                let preloads =
                    Axis::of_preloads((0.0, 1e-5), 8, asperity_data::AxisScale::Linear).unwrap();
                let record = &Results::OF_PRELOADS;
                let results = Results::of_scene(
                    scene,
                    record,
                    1,
                    Some(&preloads),
                    &mut Simulation::default(),
                    asperity_data::Control::default().on_threads(1),
                )
                .unwrap();
                let staircase = Staircase::of(
                    scene,
                    &preloads,
                    &mut simulation,
                    asperity_data::Control::default(),
                );
                let staircase = staircase.ok();
                let (preloads, staircase) = (Some(&results), staircase.as_ref());
                let report = ReversalReport {
                    title,
                    scene,
                    map: &map,
                    preloads,
                    staircase,
                    warnings: &[],
                };
                figures.extend(report.figure());
                let report = PreloadReport {
                    title,
                    choice: None,
                    results: &results,
                    staircase,
                    curves: false,
                };
                figures.extend(report.figure());
            }
            figures
                .iter()
                .for_each(|figure| check_picture(&figure.svg()));
        }
    }
}
