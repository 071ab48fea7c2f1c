//! Several computed scenes, with differences and results in one table and force curves in one
//! figure.

use crate::ensemble::{NAMES, rounded};
use crate::loop_chart::{LoopUnits, force_figure, force_panels};
use crate::report::Report;
use crate::sheet::{Sheet, WIDTH};
use crate::warnings::{counted_texts, sentences_section, warning_texts};
use asperity_data::{format_quantity, format_range};
use asperity_plot::{Colours, Figure, figure_text};
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
    /// Computed scenes, in the order of the command.
    pub scenes: &'a [ComparedScene<'a>],
    /// True if the figure has a chart for each scene; false for one chart with the force curves of
    /// all scenes.
    pub panels: bool,
}

/// Row of the table: name and unit of a result, and the function that returns it.
type Row = (&'static str, &'static str, fn(&Outcome) -> Option<f64>);

const ROWS: [Row; 8] = [
    ("work of adhesion γ", "J/m²", |outcome| {
        outcome.governing.work_of_adhesion
    }),
    ("κ = √(h⟨∇z⟩E*/γ)", "1", |outcome| {
        outcome.governing.kappa
    }),
    ("e_el/γ", "1", |outcome| {
        outcome.governing.elastic_energy_ratio
    }),
    ("preload F_n", "N", |outcome| outcome.figures.preload),
    ("adhesion force F_a", "N", |outcome| {
        outcome.figures.adhesion_force
    }),
    ("at first touch F_a(d=0)", "N", |outcome| {
        outcome.first_touch_adhesion_force
    }),
    ("pull-off at", "m", |outcome| {
        outcome.figures.pull_off_indentation
    }),
    ("dissipated energy", "J", |outcome| {
        outcome.figures.dissipated_energy
    }),
];

/// Returns the letter that names a scene in the table and the legend.
fn letter(number: usize) -> String {
    char::from_u32('A' as u32 + number as u32)
        .filter(|_| number < 26)
        .map_or(format!("S{number}"), String::from)
}

/// Returns a row of a table: a name, and values with their ratios to the first one; `None` without
/// values.
fn row(name: &str, shown: impl Fn(f64) -> String, values: &[Option<f64>]) -> Option<Vec<String>> {
    // A position may lie on either side of first touch, where a ratio means nothing.
    let first = values.first()?.filter(|first| *first > 0.0);
    let cell = |(number, value): (usize, &Option<f64>)| {
        let Some(value) = value else {
            return "-".to_owned();
        };
        let ratio = first
            .filter(|_| number > 0 && *value > 0.0)
            .map(|first| format_quantity(value / first, "1"));
        shown(*value) + &ratio.map_or_else(String::new, |ratio| format!(" (×{ratio})"))
    };
    let cells = || values.iter().enumerate().map(cell);
    values
        .iter()
        .any(Option::is_some)
        .then(|| std::iter::once(name.to_owned()).chain(cells()).collect())
}

impl ScenesReport<'_> {
    /// Returns the figure of the force curves. With `has_letters` the legend names the scenes by
    /// the letters of the table.
    fn drawn(&self, has_letters: bool) -> Figure {
        let title = |(number, scene): (usize, &ComparedScene<'_>)| match has_letters {
            true => format!("{}: {}", letter(number), scene.document.title()),
            false => scene.document.title().to_owned(),
        };
        let titles: Vec<String> = self.scenes.iter().enumerate().map(title).collect();
        let scenes: Vec<_> = titles
            .iter()
            .zip(self.scenes)
            .map(|(title, scene)| (title.as_str(), &scene.outcome))
            .collect();
        if self.panels {
            force_panels(&scenes)
        } else {
            force_figure(&scenes, LoopUnits::default())
        }
    }

    /// Returns the warnings of all scenes, each with the letter of its scene.
    fn warnings(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        for (number, scene) in self.scenes.iter().enumerate() {
            let letter = letter(number);
            let of_scene = match &scene.ensemble {
                Some(ensemble) => counted_texts(&ensemble.warnings(), ensemble.profiles()),
                None => warning_texts(&scene.outcome.warnings),
            };
            sentences.extend(
                of_scene
                    .iter()
                    .map(|sentence| format!("{letter}: {sentence}")),
            );
        }
        sentences
    }

    /// Returns rows of the medians over random profiles, with the quartiles of the adhesion force;
    /// none if no scene has several profiles.
    fn medians(&self) -> Vec<Vec<String>> {
        let ensembles = || self.scenes.iter().map(|scene| scene.ensemble.as_ref());
        if ensembles().flatten().next().is_none() {
            return Vec::new();
        }
        let median =
            |quantity| move |ensemble: &Ensemble| Some(ensemble.statistics(quantity)?.quartiles[1]);
        let medians = |quantity| {
            ensembles()
                .map(|one| one.and_then(median(quantity)))
                .collect::<Vec<_>>()
        };
        let numbers = NAMES.iter().zip(Ensemble::NUMBERS);
        let mut rows: Vec<_> = numbers
            .filter_map(|(name, of)| row(name, |value| rounded(of, value, 4), &medians(of)))
            .collect();
        let quartiles = |ensemble: Option<&Ensemble>| {
            let all = ensemble.and_then(|ensemble| ensemble.statistics(Quantity::AdhesionForce));
            all.map_or_else(
                || "-".to_owned(),
                |all| format_range((all.quartiles[0], all.quartiles[2]), 2, "N"),
            )
        };
        rows.insert(
            1.min(rows.len()),
            std::iter::once("quartiles of F_a".to_owned())
                .chain(ensembles().map(quartiles))
                .collect(),
        );
        rows
    }
}

impl Report for ScenesReport<'_> {
    /// Returns the titles, the fields in which each scene differs from the first one, and tables of
    /// the results with their ratios to the results of the first scene.
    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        let first = self.scenes.first()?.document;
        for (number, scene) in self.scenes.iter().enumerate() {
            sheet.paragraph(&format!("{} {}", letter(number), scene.document.title()));
        }
        for (number, scene) in self.scenes.iter().enumerate().skip(1) {
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
            sheet.heading(&format!(
                "Different from A to {}: {changes}",
                letter(number)
            ));
        }
        let letters = (0..self.scenes.len()).map(letter);
        let head: Vec<String> = std::iter::once(String::new()).chain(letters).collect();
        let medians = self.medians();
        let several = self
            .scenes
            .iter()
            .flat_map(|scene| &scene.ensemble)
            .map(Ensemble::profiles)
            .max();
        let mut heading = "Results".to_owned();
        if !medians.is_empty() {
            let profiles = several.unwrap_or(1);
            sheet.heading(&format!(
                "Medians over {profiles} random profiles; a fixed profile has none"
            ));
            sheet.table(
                &std::iter::once(head.clone())
                    .chain(medians)
                    .collect::<Vec<_>>(),
            );
            heading = "Results on the own profile of each scene".to_owned();
        }
        let of_scenes = |of: fn(&Outcome) -> Option<f64>| {
            self.scenes
                .iter()
                .map(|scene| of(&scene.outcome))
                .collect::<Vec<_>>()
        };
        let mut table = vec![head];
        table.extend(ROWS.iter().filter_map(|(name, unit, of)| {
            row(name, |value| format_quantity(value, unit), &of_scenes(*of))
        }));
        let regime =
            |scene: &ComparedScene<'_>| scene.outcome.regime.map_or("-", Regime::name).to_owned();
        table.push(
            std::iter::once("regime".to_owned())
                .chain(self.scenes.iter().map(regime))
                .collect(),
        );
        sheet.heading(&heading);
        sheet.table(&table);
        sentences_section(&mut sheet, &self.warnings());
        Some(format!(
            "{}\n{}",
            sheet.into_text(),
            figure_text(&self.drawn(true), WIDTH, Colours::None)
        ))
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
        // The pull-off force of a sphere is proportional to the work of adhesion.
        assert!(
            text.contains("adhesion force F_a       23.56 µN              47.12 µN (×2)\n"),
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
