//! Comparison of several computed scenes: differences and results in tables, and force curves in
//! one figure.

use crate::ensemble::{NAMES, rounded};
use crate::loop_chart::{LoopUnits, force_figure, force_panels};
use crate::report::Report;
use crate::sheet::{Sheet, WIDTH};
use crate::warnings::{outcome_warnings, sentences_section};
use crate::words::letter;
use asperity_data::{format_quantity, format_range};
use asperity_plot::{Figure, Palette, figure_text};
use asperity_scene::{Document, Outcome, Regime};
use asperity_study::{Ensemble, Quantity};

/// One of several computed scenes in a [`ScenesReport`].
#[derive(Clone, Debug)]
pub struct ComparedScene<'a> {
    /// The scene as it is written in its file, with title and comments.
    pub document: &'a Document,
    /// Results on the profile of the scene.
    pub outcome: Outcome,
    /// Results on several random profiles of the same roughness; `None` if they were not computed.
    pub ensemble: Option<Ensemble>,
}

/// Report that compares two or more computed scenes.
#[derive(Clone, Copy, Debug)]
pub struct ScenesReport<'a> {
    /// Computed scenes, in the order in which the command names them.
    pub scenes: &'a [ComparedScene<'a>],
    /// True if the figure has a chart for each scene; false if one chart has the force curves of
    /// all scenes.
    pub panels: bool,
}

/// Quantity that has a row in the table of results.
struct ComparedQuantity {
    name: &'static str,
    unit: &'static str,
    value: fn(&Outcome) -> Option<f64>,
}

const QUANTITIES: [ComparedQuantity; 8] = [
    ComparedQuantity {
        name: "work of adhesion γ",
        unit: "J/m²",
        value: |outcome| outcome.governing.work_of_adhesion,
    },
    ComparedQuantity {
        name: "κ = √(h⟨∇z⟩E*/γ)",
        unit: "1",
        value: |outcome| outcome.governing.kappa,
    },
    ComparedQuantity {
        name: "e_el/γ",
        unit: "1",
        value: |outcome| outcome.governing.elastic_energy_ratio,
    },
    ComparedQuantity {
        name: "preload F_n",
        unit: "N",
        value: |outcome| outcome.figures.preload,
    },
    ComparedQuantity {
        name: "pull-off force F_a",
        unit: "N",
        value: |outcome| outcome.figures.pull_off_force,
    },
    ComparedQuantity {
        name: "at first touch F_a(d=0)",
        unit: "N",
        value: |outcome| outcome.first_touch_pull_off_force,
    },
    ComparedQuantity {
        name: "pull-off at",
        unit: "m",
        value: |outcome| outcome.figures.pull_off_indentation,
    },
    ComparedQuantity {
        name: "dissipated energy",
        unit: "J",
        value: |outcome| outcome.figures.dissipated_energy,
    },
];

/// Returns a row of a table: a name, and for each scene the value with its ratio to the value of
/// the first scene. `None` if no scene has a value.
fn row(name: &str, words: impl Fn(f64) -> String, values: &[Option<f64>]) -> Option<Vec<String>> {
    let first = *values.first()?;
    if values.iter().all(Option::is_none) {
        return None;
    }
    let mut row = vec![name.to_owned()];
    for (number, value) in values.iter().enumerate() {
        let Some(value) = *value else {
            row.push("-".to_owned());
            continue;
        };
        let mut cell = words(value);
        // The ratio is stated only for positive values. An indentation may also be negative, and
        // the ratio of two values with different signs has no meaning.
        if let Some(first) = first
            && number > 0
            && first > 0.0
            && value > 0.0
        {
            let ratio = format_quantity(value / first, "1");
            cell += &format!(" (×{ratio})");
        }
        row.push(cell);
    }
    Some(row)
}

impl ScenesReport<'_> {
    /// Returns the figure of the force curves. If `has_letters` is true, the legend begins the name
    /// of each scene with its letter in the table.
    fn drawn(&self, has_letters: bool) -> Figure {
        let mut titles = Vec::with_capacity(self.scenes.len());
        for (number, scene) in self.scenes.iter().enumerate() {
            let title = scene.document.title();
            titles.push(if has_letters {
                format!("{}: {title}", letter(number))
            } else {
                title.to_owned()
            });
        }
        let mut scenes = Vec::with_capacity(self.scenes.len());
        for (title, scene) in titles.iter().zip(self.scenes) {
            scenes.push((title.as_str(), &scene.outcome));
        }
        if self.panels {
            force_panels(&scenes)
        } else {
            force_figure(&scenes, LoopUnits::default())
        }
    }

    /// Returns the headings of a table with a column for each scene.
    fn header(&self) -> Vec<String> {
        let mut header = vec![String::new()];
        header.extend((0..self.scenes.len()).map(letter));
        header
    }

    /// Returns the rows with medians over random profiles, and a row with the quartiles of the
    /// pull-off force; empty if no scene has several profiles.
    fn medians(&self) -> Vec<Vec<String>> {
        if self.scenes.iter().all(|scene| scene.ensemble.is_none()) {
            return Vec::new();
        }
        let mut rows = Vec::new();
        for (name, quantity) in NAMES.iter().zip(Ensemble::NUMBERS) {
            let mut medians = Vec::with_capacity(self.scenes.len());
            for scene in self.scenes {
                medians.push(scene.quartiles(quantity).map(|[_, median, _]| median));
            }
            rows.extend(row(name, |value| rounded(quantity, value, 4), &medians));
        }
        let mut quartiles = vec!["quartiles of F_a".to_owned()];
        for scene in self.scenes {
            quartiles.push(match scene.quartiles(Quantity::PullOffForce) {
                Some([lower, _, upper]) => format_range((lower, upper), 2, "N"),
                None => "-".to_owned(),
            });
        }
        // The first row is the median of the pull-off force. The row of its quartiles is inserted
        // after it.
        rows.insert(1.min(rows.len()), quartiles);
        rows
    }

    /// Adds the title of each scene, and the fields in which it differs from the first scene.
    fn add_differences(&self, sheet: &mut Sheet, first: &Document) {
        for (number, scene) in self.scenes.iter().enumerate() {
            let letter = letter(number);
            sheet.paragraph(&format!("{letter} {}", scene.document.title()));
        }
        for (number, scene) in self.scenes.iter().enumerate().skip(1) {
            let letter = letter(number);
            let changes: Vec<String> = first
                .changes_to(scene.document)
                .iter()
                .map(ToString::to_string)
                .collect();
            let changes = if changes.is_empty() {
                "nothing".to_owned()
            } else {
                changes.join(", ")
            };
            sheet.heading(&format!("Different from A to {letter}: {changes}"));
        }
    }

    /// Adds a table of the results of each scene on the profile with the seed of the scene.
    fn add_results(&self, sheet: &mut Sheet) {
        let mut rows = vec![self.header()];
        for quantity in &QUANTITIES {
            let mut values = Vec::with_capacity(self.scenes.len());
            for scene in self.scenes {
                values.push((quantity.value)(&scene.outcome));
            }
            let words = |value| format_quantity(value, quantity.unit);
            rows.extend(row(quantity.name, words, &values));
        }
        let mut regimes = vec!["regime".to_owned()];
        for scene in self.scenes {
            let regime = scene.outcome.regime;
            regimes.push(regime.map_or("-", Regime::name).to_owned());
        }
        rows.push(regimes);
        sheet.table(&rows);
    }
}

impl ComparedScene<'_> {
    /// Returns the lower quartile, the median and the upper quartile of a quantity over the random
    /// profiles; `None` if these are not known.
    fn quartiles(&self, quantity: Quantity) -> Option<[f64; 3]> {
        let statistics = self.ensemble.as_ref()?.statistics(quantity)?;
        Some(statistics.quartiles)
    }
}

impl Report for ScenesReport<'_> {
    /// Returns the warnings of all scenes. Each begins with the letter of its scene.
    fn warnings(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        for (number, scene) in self.scenes.iter().enumerate() {
            let letter = letter(number);
            for warning in outcome_warnings(&scene.outcome, scene.ensemble.as_ref()) {
                sentences.push(format!("{letter}: {warning}"));
            }
        }
        sentences
    }

    /// Returns the titles, the fields in which each scene differs from the first one, and tables of
    /// the results with their ratios to the results of the first scene.
    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        let first = self.scenes.first()?.document;
        self.add_differences(&mut sheet, first);
        let medians = self.medians();
        if medians.is_empty() {
            sheet.heading("Results");
        } else {
            let ensembles = self.scenes.iter().flat_map(|scene| &scene.ensemble);
            let profiles = ensembles.map(Ensemble::profiles).max().unwrap_or(1);
            sheet.heading(&format!(
                "Medians over {profiles} random profiles; a fixed profile has none"
            ));
            let mut rows = vec![self.header()];
            rows.extend(medians);
            sheet.table(&rows);
            sheet.heading("Results on the own profile of each scene");
        }
        self.add_results(&mut sheet);
        sentences_section(&mut sheet, &self.warnings());
        let text = sheet.into_text();
        let curves = figure_text(&self.drawn(true), WIDTH, Palette::PLAIN);
        Some(format!("{text}\n{curves}"))
    }

    fn figure(&self) -> Option<Figure> {
        Some(self.drawn(false))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::open;

    #[test]
    fn scenes_are_compared_with_the_first() {
        let first = open("jkr-sphere").unwrap();
        let second = first.set("adhesion.work", "0.1").unwrap();
        let compared = |document| {
            let outcome = asperity_scene::run(document).unwrap();
            ComparedScene {
                document,
                outcome,
                ensemble: None,
            }
        };
        let scenes = [&first, &second, &first].map(compared);
        let report = ScenesReport {
            scenes: &scenes,
            panels: false,
        };
        let text = report.text().unwrap();
        assert!(
            text.starts_with(&format!("A {}\nB ", first.title())),
            "{text}"
        );
        assert!(
            text.contains("Different from A to B: γ 50 mJ/m² → 100 mJ/m²\n"),
            "{text}"
        );
        assert!(text.contains("Different from A to C: nothing\n"), "{text}");
        // The second scene has twice the work of adhesion, and the pull-off force of a sphere is
        // proportional to the work of adhesion.
        assert!(
            text.contains("pull-off force F_a       23.56 µN              47.12 µN (×2)\n"),
            "{text}"
        );
        let named: Vec<String> = report
            .drawn(true)
            .legend()
            .iter()
            .map(|entry| entry.name.to_string())
            .collect();
        let titles = [first.title(), "jkr-sphere, changed", first.title()];
        assert_eq!(
            named[..3],
            [0, 1, 2].map(|number| format!("{}: {}", ["A", "B", "C"][number], titles[number]))
        );
        assert_eq!(
            named[3..],
            ["loading", "jump-in", "preload", "pull-off", "jump-out"]
        );
    }
}
