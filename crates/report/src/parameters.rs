//! Text for the box of a figure that states the parameters of its scenes.

use asperity_plot::{Label, statement};
use asperity_scene::Scene;
use asperity_scene::fields::{Statement, statements};

/// Returns the parameters that define scenes, such as the rms height, as lines for the box of
/// parameters in a figure. The first line has the parameters that are equal in all scenes. Each
/// further line has the name of a scene and its other parameters.
pub fn parameter_lines(scenes: &[(String, Scene)]) -> Vec<Label> {
    let statements_of_scenes: Vec<Vec<Statement>> =
        scenes.iter().map(|(_, scene)| statements(scene)).collect();
    let is_common = |statement: &Statement| {
        let mut all = statements_of_scenes.iter();
        all.all(|statements| statements.contains(statement))
    };
    let mut lines = Vec::new();
    if let Some(first) = statements_of_scenes.first() {
        lines.extend(line(first.iter().filter(|statement| is_common(statement))));
    }
    for ((name, _), statements) in scenes.iter().zip(&statements_of_scenes) {
        if name.is_empty() {
            continue;
        }
        let own = statements.iter().filter(|statement| !is_common(statement));
        if let Some(line) = line(own) {
            lines.push(Label::plain(name).then(": ").join(&line));
        }
    }
    lines
}

/// Returns statements as one line; `None` if there are no statements.
fn line<'a>(statements: impl Iterator<Item = &'a Statement>) -> Option<Label> {
    let labels = statements.map(|stated| {
        let field = stated.field;
        statement(field.name, field.symbol, &stated.value)
    });
    labels.reduce(|line, label| line.then(", ").join(&label))
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::open;

    #[test]
    fn common_numbers_are_stated_once() {
        let scene = |name: &str| Scene::clone(open(name).unwrap().scene());
        let [one, other] = ["ideal-adhesion", "non-adhesive"].map(scene);
        let lines = |names: [&str; 2]| -> Vec<String> {
            let scenes = [
                (names[0].to_owned(), one.clone()),
                (names[1].to_owned(), other.clone()),
            ];
            parameter_lines(&scenes)
                .iter()
                .map(ToString::to_string)
                .collect()
        };
        let common = "E = 2 MPa, ν = 0.5, L = 100 µm, H = 0.7, h = 200 nm, k = 4 to 512, seed 5, \
                      loading 20 µN, separation";
        assert_eq!(
            lines(["a", "b"]),
            [common, "a: κ = 0.8, N = 16 384", "b: κ = 10, N = 32 768"]
        );
        assert_eq!(lines(["", ""]), [common]);
    }
}
