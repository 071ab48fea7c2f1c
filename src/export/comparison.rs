//! Two scenes in words: titles, differences, both adhesion forces.

use super::loop_chart::force_figure;
use super::report::Report;
use super::sheet::WIDTH;
use crate::draw::{Colours, Figure, figure_text};
use crate::scene::{Document, format_quantity};
use crate::simulation::Outcome;

/// Two computed scenes, in the order of the comparison.
#[derive(Clone, Copy, Debug)]
pub struct Comparison<'a>(pub [(&'a Document, &'a Outcome); 2]);

impl Comparison<'_> {
    /// Titles, the changes from the first scene to the second, both adhesion forces with their ratio.
    fn words(&self) -> String {
        let [first, second] = self.0;
        let changes = first.0.changes_to(second.0);
        let changes: Vec<String> = changes.iter().map(ToString::to_string).collect();
        let changes = if changes.is_empty() { "nothing".to_owned() } else { changes.join(", ") };
        let forces = [first, second].map(|(_, outcome)| outcome.figures.adhesion_force);
        format!(
            "A  {}\nB  {}\ndifferent from A to B: {changes}\nadhesion force F_a: {}\n",
            first.0.title(),
            second.0.title(),
            adhesion_forces(forces)
        )
    }

    fn drawn(&self) -> Figure {
        let named =
            |(letter, (scene, _)): (&str, (&Document, &Outcome))| format!("{letter}: {}", scene.title());
        let [first, second] = self.0;
        let titles = [("A", first), ("B", second)].map(named);
        force_figure(&[(&titles[0], first.1), (&titles[1], second.1)])
    }
}

impl Report for Comparison<'_> {
    fn text(&self) -> Option<String> {
        Some(format!("{}\n{}", self.words(), figure_text(&self.drawn(), WIDTH, Colours::None)))
    }

    fn figure(&self) -> Option<Figure> {
        Some(self.drawn())
    }
}

/// Two adhesion forces, N, and the ratio of the second to the first.
pub fn adhesion_forces(forces: [Option<f64>; 2]) -> String {
    let [before, now] =
        forces.map(|force| force.map_or_else(|| "none".to_owned(), |force| format_quantity(force, "N")));
    let ratio = forces[0].zip(forces[1]).map(|(before, now)| now / before).filter(|ratio| ratio.is_finite());
    let ratio = ratio.map_or_else(String::new, |ratio| format!(", ratio {}", format_quantity(ratio, "1")));
    format!("{before} → {now}{ratio}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open;

    #[test]
    fn forces_have_a_ratio_where_both_are_there() {
        assert_eq!(adhesion_forces([Some(2e-6), Some(5e-6)]), "2 µN → 5 µN, ratio 2.5");
        assert_eq!(adhesion_forces([Some(2e-6), None]), "2 µN → none");
        assert_eq!(adhesion_forces([Some(0.0), Some(1e-6)]), "0 N → 1 µN");
    }

    #[test]
    fn a_comparison_names_both_scenes_and_what_differs() {
        let first = open("jkr-sphere").unwrap();
        let second = first.set("adhesion.work", "0.1").unwrap();
        let outcomes = [&first, &second].map(|document| crate::run(document).unwrap());
        let pair = [(&first, &outcomes[0]), (&second, &outcomes[1])];
        let text = Comparison(pair).words();
        assert!(text.contains("different from A to B: γ 50 mJ/m² → 100 mJ/m²\n"), "{text}");
        assert!(text.starts_with(&format!("A  {}\n", first.scene().title)), "{text}");
        // The pull-off force of a sphere is proportional to the work of adhesion.
        assert!(text.ends_with("ratio 2\n"), "{text}");
        let names: Vec<String> =
            Comparison(pair).drawn().legend().iter().map(|entry| entry.name.to_string()).collect();
        let title = first.title();
        assert_eq!(names, [format!("A: {title}"), format!("B: {title}")]);
        assert!(Comparison([pair[0], pair[0]]).words().contains("different from A to B: nothing\n"));
    }
}
