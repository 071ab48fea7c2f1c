//! The box of parameters in a figure: the numbers that define its scenes.

use asperity_plot::{Label, statement};
use asperity_scene::Scene;
use asperity_scene::fields::{Statement, statements};

/// Returns the numbers that define scenes, such as the rms height, as lines for the box of
/// parameters in a figure. The first line has the numbers that all scenes share. Further lines have
/// the other numbers of each scene with a name.
pub fn parameter_lines(scenes: &[(String, Scene)]) -> Vec<Label> {
    let all: Vec<Vec<Statement>> = scenes.iter().map(|(_, scene)| statements(scene)).collect();
    let is_common = |one: &Statement| all.iter().all(|scene| scene.contains(one));
    let line = |name: &str, chosen: &mut dyn Iterator<Item = &Statement>| {
        let labels = chosen.map(|one| statement(one.field.name, one.field.symbol, &one.value));
        let line = labels.reduce(|line, label| line.then(", ").join(&label))?;
        Some(if name.is_empty() {
            line
        } else {
            Label::plain(name).then(": ").join(&line)
        })
    };
    let common = all
        .first()
        .and_then(|first| line("", &mut first.iter().filter(|one| is_common(one))));
    let named = scenes
        .iter()
        .zip(&all)
        .filter(|((name, _), _)| !name.is_empty());
    let own = named.filter_map(|((name, _), scene)| {
        line(name, &mut scene.iter().filter(|one| !is_common(one)))
    });
    common.into_iter().chain(own).collect()
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
