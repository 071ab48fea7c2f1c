//! Several computed scenes: differences and results in one table, force curves in one figure.

use crate::loop_chart::{force_figure, force_panels};
use crate::report::Report;
use crate::sheet::{Sheet, WIDTH};
use asperity_data::format_quantity;
use asperity_plot::{Colours, Figure, figure_text};
use asperity_scene::Document;
use asperity_scene::Outcome;
use asperity_scene::Regime;

/// At least two computed scenes, with their documents.
#[derive(Clone, Copy, Debug)]
pub struct ScenesReport<'a> {
    pub scenes: &'a [(&'a Document, Outcome)],
    /// True for a separate chart of each scene.
    pub panels: bool,
}

/// A row of the table: name and unit of a result, and its value.
type Row = (&'static str, &'static str, fn(&Outcome) -> Option<f64>);

const ROWS: [Row; 8] = [
    ("work of adhesion γ", "J/m²", |outcome| outcome.governing.work_of_adhesion),
    ("κ = √(h⟨∇z⟩E*/γ)", "1", |outcome| outcome.governing.kappa),
    ("e_el/γ", "1", |outcome| outcome.governing.elastic_energy_ratio),
    ("preload F_n", "N", |outcome| outcome.figures.preload),
    ("adhesion force F_a", "N", |outcome| outcome.figures.adhesion_force),
    ("at first touch F_a(0)", "N", |outcome| outcome.zero_load_adhesion_force),
    ("pull-off at", "m", |outcome| outcome.figures.pull_off_indentation),
    ("dissipated energy", "J", |outcome| outcome.figures.dissipated_energy),
];

/// Letter by which a scene is named in the table and the legend.
fn letter(number: usize) -> String {
    char::from_u32('A' as u32 + number as u32)
        .filter(|_| number < 26)
        .map_or(format!("S{number}"), String::from)
}

impl ScenesReport<'_> {
    /// The figure of the force curves; with `has_letters` the legend names scenes as the table does.
    fn drawn(&self, has_letters: bool) -> Figure {
        let title = |(number, (document, _)): (usize, &(&Document, Outcome))| match has_letters {
            true => format!("{}: {}", letter(number), document.title()),
            false => document.title().to_owned(),
        };
        let titles: Vec<String> = self.scenes.iter().enumerate().map(title).collect();
        let scenes: Vec<_> =
            titles.iter().zip(self.scenes).map(|(title, (_, outcome))| (title.as_str(), outcome)).collect();
        if self.panels { force_panels(&scenes) } else { force_figure(&scenes) }
    }
}

impl Report for ScenesReport<'_> {
    /// Titles, the changes of each scene from the first one, and the results with their ratios to the results of the first scene.
    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        let (first, _) = self.scenes.first()?;
        for (number, (document, _)) in self.scenes.iter().enumerate() {
            sheet.paragraph(&format!("{} {}", letter(number), document.title()));
        }
        for (number, (document, _)) in self.scenes.iter().enumerate().skip(1) {
            let changes: Vec<String> = first.changes_to(document).iter().map(ToString::to_string).collect();
            let changes = if changes.is_empty() { "nothing".to_owned() } else { changes.join(", ") };
            sheet.heading(&format!("Different from A to {}: {changes}", letter(number)));
        }
        let letters = (0..self.scenes.len()).map(letter);
        let mut table: Vec<Vec<String>> = vec![std::iter::once(String::new()).chain(letters).collect()];
        for (name, unit, of) in ROWS {
            let values: Vec<Option<f64>> = self.scenes.iter().map(|(_, outcome)| of(outcome)).collect();
            // A position may lie on either side of first touch, where a ratio means nothing.
            let first = values[0].filter(|first| *first > 0.0);
            let cell = |(number, value): (usize, &Option<f64>)| {
                let Some(value) = value else { return "-".to_owned() };
                let ratio = first
                    .filter(|_| number > 0 && *value > 0.0)
                    .map(|first| format_quantity(value / first, "1"));
                format_quantity(*value, unit)
                    + &ratio.map_or_else(String::new, |ratio| format!(" (×{ratio})"))
            };
            if values.iter().any(Option::is_some) {
                let cells = values.iter().enumerate().map(cell);
                table.push(std::iter::once(name.to_owned()).chain(cells).collect());
            }
        }
        let regime =
            |(_, outcome): &(&Document, Outcome)| outcome.regime.map_or("-", Regime::name).to_owned();
        table.push(std::iter::once("regime".to_owned()).chain(self.scenes.iter().map(regime)).collect());
        sheet.heading("Results");
        sheet.table(&table);
        Some(format!("{}\n{}", sheet.into_text(), figure_text(&self.drawn(true), WIDTH, Colours::None)))
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
        let outcome = |document| asperity_scene::run(document).unwrap();
        let scenes = [(&first, outcome(&first)), (&second, outcome(&second)), (&first, outcome(&first))];
        let report = ScenesReport { scenes: &scenes, panels: false };
        let text = report.text().unwrap();
        assert!(text.starts_with(&format!("A {}\nB ", first.title())), "{text}");
        assert!(text.contains("Different from A to B: γ 50 mJ/m² → 100 mJ/m²\n"), "{text}");
        assert!(text.contains("Different from A to C: nothing\n"), "{text}");
        // The pull-off force of a sphere is proportional to the work of adhesion.
        assert!(text.contains("adhesion force F_a     23.56 µN              47.12 µN (×2)\n"), "{text}");
        let named: Vec<String> =
            report.drawn(true).legend().iter().map(|entry| entry.name.to_string()).collect();
        assert_eq!(named[..3], ["A: ", "B: ", "C: "].map(|letter| format!("{letter}{}", first.title())));
        assert_eq!(named[3..], ["loading", "jump-in", "preload", "pull-off", "jump-out"]);
    }
}
