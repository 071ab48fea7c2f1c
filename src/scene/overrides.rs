//! Overrides that turn one scene into another, and the command that applies them.

use super::document::{Document, pair};
use super::edit;
use super::field::Field;
use super::fields::fields_inside;
use super::model::{Move, Scene};
use super::read::read;
use super::text::ron_float;
use super::value::Value;
use super::write::leg;

/// Paths and values to set together.
type Overrides = Vec<(String, String)>;

impl Document {
    /// The overrides that turn `base` into this scene: `base.set_all` of them results in a scene equal to this
    /// document's, independent of the layout of either text.
    ///
    /// Fields are set one by one where both scenes make the same choices, else with their group or
    /// choice; loading stages one by one where that is shorter than the whole list. Values are on one
    /// line each and read back to the last digit. Empty for equal scenes.
    pub fn overrides_from(&self, base: &Document) -> Vec<(String, String)> {
        if self.scene() == base.scene() {
            return Vec::new();
        }
        let (mine, theirs) = (self.scene(), base.scene());
        let mut overrides = Vec::new();
        for field in top_level() {
            let whole = vec![pair(field.path, value(field, mine))];
            let fine = match field.path {
                "loading" => different_legs(&mine.loading, &theirs.loading)
                    .filter(|fine| length(fine) < length(&whole)),
                _ => Some(differences(field, mine, theirs)),
            };
            // A field missing from the base's text cannot always be set by itself.
            let leads =
                |fine: &Overrides| fine.is_empty() || leads_to(base, fine, field, &value(field, mine));
            overrides.extend(fine.filter(leads).unwrap_or(whole));
        }
        let equal = |overrides: &Overrides| {
            base.set_all(overrides).is_ok_and(|document| document.scene() == self.scene())
        };
        if !equal(&overrides) {
            overrides = top_level().map(|field| pair(field.path, value(field, mine))).collect();
        }
        overrides
    }
}

fn top_level() -> impl Iterator<Item = &'static Field> {
    fields_inside("", None)
}

/// Value of a field in RON, or its default.
fn value(field: &Field, scene: &Scene) -> String {
    field.written(scene).unwrap_or_else(|| field.default_in(scene).to_string())
}

/// The fields inside a field, for the choice of a scene.
fn inside(field: &Field, scene: &Scene) -> Vec<&'static Field> {
    match field.get(scene) {
        Some(Value::Choice(variant)) => fields_inside(field.path, Some(variant)).collect(),
        _ => Vec::new(),
    }
}

/// The differing fields, each by itself where both scenes have the same fields there, else their group.
fn differences(field: &Field, mine: &Scene, theirs: &Scene) -> Overrides {
    // A field at its default in both is equal, though the default may depend on another field.
    let stated = |scene| field.written(scene).filter(|value| value != field.default_in(scene));
    if stated(mine) == stated(theirs) {
        return Vec::new();
    }
    let fields = inside(field, mine);
    let absent = |scene: &Scene, field: &Field| field.get(scene) == Some(Value::None);
    let same =
        fields == inside(field, theirs) && fields.iter().all(|one| absent(mine, one) == absent(theirs, one));
    if fields.is_empty() || !same {
        return vec![pair(field.path, value(field, mine))];
    }
    fields.into_iter().flat_map(|one| differences(one, mine, theirs)).collect()
}

/// The differing loading stages, or their numbers, if both have as many stages.
fn different_legs(mine: &[Move], theirs: &[Move]) -> Option<Overrides> {
    let different = |(index, (mine, theirs)): (usize, (&Move, &Move))| match (mine, theirs) {
        (mine, theirs) if mine == theirs => None,
        (Move::ToForce(value), Move::ToForce(_)) | (Move::ToIndentation(value), Move::ToIndentation(_)) => {
            Some((format!("loading.{index}.0"), ron_float(*value)))
        }
        (mine, _) => Some((format!("loading.{index}"), leg(mine))),
    };
    let pairs = || mine.iter().zip(theirs).enumerate();
    (mine.len() == theirs.len()).then(|| pairs().filter_map(different).collect())
}

/// Characters of overrides on a command line.
fn length(overrides: &[(String, String)]) -> usize {
    overrides.iter().map(|(path, value)| " --set =".len() + path.len() + value.len()).sum()
}

/// Returns true if overrides of parts of a field set the field to this value.
fn leads_to(base: &Document, overrides: &[(String, String)], field: &Field, value: &str) -> bool {
    let set = |text: String, (path, value): &(String, String)| edit::set(&text, path, value).ok();
    let text = overrides.iter().try_fold(base.text().to_string(), set);
    let scene = text.and_then(|text| read(&text).ok());
    scene.is_some_and(|scene| field.written(&scene).as_deref() == Some(value))
}

/// The command that opens a scene with overrides, for a POSIX shell; only words that need quotes are quoted.
///
/// ```
/// let overrides = [("form".to_string(), "Cone(angle: 0.1)".to_string())];
/// let command = asperity::scene::command_line("jkr-sphere", &overrides);
/// assert_eq!(command, "asperity jkr-sphere --set 'form=Cone(angle: 0.1)'");
/// ```
pub fn command_line(name: &str, overrides: &[(String, String)]) -> String {
    let set = |(path, value): &(String, String)| format!(" --set {}", quoted(&format!("{path}={value}")));
    let sets: String = overrides.iter().map(set).collect();
    // A name that looks like an option comes after all options.
    if name.starts_with('-') {
        format!("asperity{sets} -- {}", quoted(name))
    } else {
        format!("asperity {}{sets}", quoted(name))
    }
}

/// A word quoted for a shell.
pub(crate) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "_-./:,+@%=".contains(c);
    // zsh takes a word that starts with = for the path of a command.
    if !word.is_empty() && !word.starts_with('=') && word.chars().all(plain) {
        word.to_string()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::presets::presets;
    use super::super::strategies::sound_scenes;
    use super::*;

    const SCENE: &str = "(
    version: 1,
    title: \"A\",
    material: (youngs_modulus: 2.0e6, poisson_ratio: 0.5), // soft
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (1, 512), seed: 1),
    adhesion: (kappa: 6.0),
    loading: [ToForce(1.0e-5), ToTouch, ToSeparation],
)
";

    fn document() -> Document {
        Document::parse(SCENE, "scene").unwrap()
    }

    fn pairs(overrides: &[(&str, &str)]) -> Overrides {
        overrides.iter().map(|(path, value)| pair(path, *value)).collect()
    }

    #[test]
    fn what_was_set_is_found_again() {
        for overrides in [
            &[][..],
            &[("length", "2.0e-4")],
            &[("title", "\"it's \\\"b\\\"\""), ("notice", "\"one\\ntwo\"")],
            &[("material.youngs_modulus", "0.1e7"), ("material.poisson_ratio", "0.25")],
            &[("roughness.modes", "(2, 512)"), ("roughness.seed", "18446744073709551615")],
            &[("roughness", "None"), ("adhesion", "(work: 0.05)")],
            &[("roughness", "None"), ("adhesion", "None")],
            &[("form", "Cone(angle: 0.1)"), ("adhesion.kappa", "0.30000000000000004")],
            &[("material", "(effective_modulus: 2.7e6)"), ("observe", "[Fragments]")],
            &[("roughness", "Measured(file: \"a b.csv\")")],
            &[("loading.0.0", "2.0e-5"), ("numerics.points", "1024"), ("numerics.samples", "64")],
            &[("loading.1", "ToZeroForce"), ("numerics.solver", "Stepwise(step: 1.0e-9)")],
            &[("loading", "[ToForce(1.0e-5)]")],
            &[("loading", "[ToTouch, ToForce(1.0), ToZeroForce]")],
        ] {
            let changed = document().set_all(&pairs(overrides)).unwrap();
            let canonical = Document::from_scene(changed.scene(), "other").unwrap();
            let expected =
                pairs(overrides).into_iter().map(|(path, value)| (path, value.replace("0.1e7", "1.0e6")));
            let expected: Overrides = expected.collect();
            assert_eq!(changed.overrides_from(&document()), expected);
            assert_eq!(canonical.overrides_from(&document()), expected);
        }
    }

    #[test]
    fn inside_what_differs_only_what_differs_is_set() {
        let base = document().set_all(&pairs(&[
            ("form", "Power(coefficient: 1.0e7, exponent: 3.0)"),
            ("numerics.solver", "Stepwise(step: 1.0e-9)"),
        ]));
        let base = base.unwrap();
        let step = base.set("numerics.solver.step", "2.0e-9").unwrap().set("form.exponent", "2.5").unwrap();
        let expected = [("form.exponent", "2.5"), ("numerics.solver.step", "2.0e-9")];
        assert_eq!(step.overrides_from(&base), pairs(&expected));
        let gradient = pairs(&[("roughness.rms_height", "None"), ("roughness.rms_gradient", "0.1")]);
        let gradient = base.set_all(&gradient).unwrap();
        let whole = "SelfAffine(hurst: 0.7, rms_gradient: 0.1, modes: (1, 512), seed: 1)";
        assert_eq!(gradient.overrides_from(&base), pairs(&[("roughness", whole)]));
        let sphere = base.set("form", "Paraboloid(radius: 2.0e-5)").unwrap();
        let punch = base.set("form", "Punch(radius: 2.0e-5)").unwrap();
        assert_eq!(punch.overrides_from(&sphere), pairs(&[("form", "Punch(radius: 2.0e-5)")]));
    }

    #[test]
    fn what_the_base_leaves_out_is_set_whole() {
        let text = SCENE.replace("    loading: [ToForce(1.0e-5), ToTouch, ToSeparation],\n", "");
        let base = Document::parse(&text, "scene").unwrap();
        let changed = base.set("loading", "[ToTouch, ToSeparation]").unwrap();
        let expected = [("loading", "[ToTouch, ToSeparation]")];
        assert_eq!(changed.overrides_from(&base), pairs(&expected));
    }

    #[test]
    fn ways_of_writing_do_not_matter() {
        let text = SCENE
            .replace("(kappa: 6.0)", "Some((kappa: Some(6.0)))")
            .replace("(\n    version: 1", "#![enable(implicit_some)]\nScene(r#version: 1");
        let base = Document::parse(&text, "scene").unwrap();
        assert_eq!(base.overrides_from(&document()), []);
        assert_eq!(document().overrides_from(&base), []);
        let changed = document().set("adhesion.kappa", "2.0").unwrap();
        assert_eq!(assert_leads(&base, &changed), pairs(&[("adhesion.kappa", "2.0")]));
    }

    #[test]
    fn words_are_quoted_where_a_shell_would_read_something_else() {
        for (word, expected) in [
            ("jkr-sphere", "jkr-sphere"),
            ("./a/b_c.ron", "./a/b_c.ron"),
            ("C:/κ,1+2@3%4=5", "C:/κ,1+2@3%4=5"),
            ("", "''"),
            ("a b", "'a b'"),
            ("it's", r"'it'\''s'"),
            ("'", r"''\'''"),
            ("=ls", "'=ls'"),
            ("~/a", "'~/a'"),
            ("a*", "'a*'"),
            ("$HOME", "'$HOME'"),
            ("[Fragments]", "'[Fragments]'"),
            ("a\nb", "'a\nb'"),
            (r"a\b", r"'a\b'"),
        ] {
            assert_eq!(quoted(word), expected);
        }
        let sets = pairs(&[("form", "None"), ("title", "\"it's\"")]);
        assert_eq!(command_line("a.ron", &sets), r#"asperity a.ron --set form=None --set 'title="it'\''s"'"#);
        assert_eq!(command_line("-a.ron", &sets[..1]), "asperity --set form=None -- -a.ron");
    }

    /// The words that a shell makes of a command, by the rules of POSIX for quotes and backslashes.
    fn words(command: &str) -> Vec<String> {
        let (mut words, mut word, mut characters) = (Vec::new(), None::<String>, command.chars());
        while let Some(c) = characters.next() {
            match c {
                ' ' | '\t' | '\n' => words.extend(word.take()),
                '\\' => word.get_or_insert_default().extend(characters.next()),
                '\'' => {
                    let quoted = characters.by_ref().take_while(|c| *c != '\'');
                    word.get_or_insert_default().extend(quoted);
                }
                c => {
                    assert!(!"|&;<>()$`\"*?[#~!{}^".contains(c), "{c} is not quoted: {command}");
                    word.get_or_insert_default().push(c);
                }
            }
        }
        words.into_iter().chain(word).collect()
    }

    fn expected_words(name: &str, overrides: &[(String, String)]) -> Vec<String> {
        let sets = overrides.iter().flat_map(|(path, value)| ["--set".into(), format!("{path}={value}")]);
        if name.starts_with('-') {
            let end = ["--".to_string(), name.to_string()];
            return std::iter::once("asperity".to_string()).chain(sets).chain(end).collect();
        }
        ["asperity".to_string(), name.to_string()].into_iter().chain(sets).collect()
    }

    #[cfg(unix)]
    fn words_of_the_shell(command: &str) -> Vec<String> {
        let script = format!("printf '%s\\0' {command}");
        let output = std::process::Command::new("sh").arg("-c").arg(script).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        text.split_terminator('\0').map(str::to_string).collect()
    }

    fn assert_leads(base: &Document, target: &Document) -> Overrides {
        let overrides = target.overrides_from(base);
        let reached = base.set_all(&overrides).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(reached.scene(), target.scene());
        assert!(overrides.iter().all(|(_, value)| !value.contains(['\n', '\r'])));
        // No field is set twice, and an equal field not at all.
        let top = |path: &str| path.split('.').next().unwrap_or_default().to_string();
        for (path, _) in &overrides {
            let others = overrides.iter().filter(|(other, _)| other == path || top(path) == *other);
            assert_eq!(others.count(), 1, "{overrides:?}");
        }
        overrides
    }

    proptest! {
        #[test]
        fn overrides_lead_from_any_scene_to_any_other(
            base in sound_scenes(),
            target in sound_scenes(),
            mixed in prop::collection::vec(any::<bool>(), 9),
            preset in prop::sample::select(presets().to_vec()),
            name in "[^\0]{0,12}",
        ) {
            // Takes some parts of the base, so that the pair also shares some.
            let mut near = target.clone();
            if mixed[0] { near.title.clone_from(&base.title); }
            if mixed[1] { near.notice.clone_from(&base.notice); }
            if mixed[2] { near.material = base.material; }
            if mixed[3] { (near.length, near.form) = (base.length, base.form); }
            if mixed[4] { (near.roughness, near.adhesion) = (base.roughness.clone(), base.adhesion); }
            if mixed[5] { near.loading.clone_from(&base.loading); }
            if mixed[6] { near.numerics.solver = base.numerics.solver; }
            if mixed[7] { near.numerics.samples = base.numerics.samples; }
            if mixed[8] { near.observe.clone_from(&base.observe); }
            let preset = Document::parse(preset.text, preset.name).unwrap();
            let base = Document::from_scene(&base, "base").unwrap();
            let target = Document::from_scene(&target, "target").unwrap();
            let mut lists = vec![assert_leads(&preset, &target), assert_leads(&base, &target)];
            assert_leads(&target, &preset);
            if let Ok(near) = Document::from_scene(&near, "near") {
                lists.push(assert_leads(&base, &near));
                lists.push(assert_leads(&near, &target));
            }
            for overrides in lists {
                let command = command_line(&name, &overrides);
                prop_assert_eq!(words(&command), expected_words(&name, &overrides));
            }
        }
    }

    #[test]
    fn overrides_are_as_long_as_what_they_add_to_a_command() {
        let mut overrides = Overrides::new();
        let bare = command_line("jkr-sphere", &overrides).len();
        for (path, value) in
            [("length", "1e-4"), ("adhesion.work", "0.1"), ("title", ""), ("numerics.points", "64")]
        {
            overrides.push((path.to_string(), value.to_string()));
            assert_eq!(bare + length(&overrides), command_line("jkr-sphere", &overrides).len());
        }
    }

    #[cfg(unix)]
    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn a_shell_reads_the_words_that_were_meant(
            name in "[^\0]{0,20}|[ -~\n]{0,20}",
            values in prop::collection::vec("[^\0]{0,20}|[ -~\n]{0,20}", 0..4),
        ) {
            let overrides: Overrides = values.into_iter().map(|value| pair("title", value)).collect();
            let command = command_line(&name, &overrides);
            prop_assert_eq!(words_of_the_shell(&command), expected_words(&name, &overrides));
        }
    }
}
