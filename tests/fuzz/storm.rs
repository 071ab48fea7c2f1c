//! Storms of random input, drawn from the table of fields: texts of scenes, overrides, profiles,
//! plans, and the runs of the allowed ones.
//!
//! `TEST_EFFORT=800 cargo test --test fuzz storm` draws 800 times as many; `PROPTEST_RNG_SEED=7`
//! draws others.

mod plans;
mod runs;
mod strategies;

use super::effort::cases;
use super::properties::{overrides, profile, scene};
use asperity::scene::fields::{FIELDS, Field, Range};
use asperity::scene::text::{ron_float, ron_string};
use asperity::scene::{Document, Scene};
use proptest::prelude::*;
use proptest::strategy::{Union, ValueTree};
use strategies::Drawn;

/// Draws of a quick run, times the effort.
fn draws(quick: u32) -> ProptestConfig {
    ProptestConfig {
        cases: cases(quick),
        failure_persistence: None,
        max_local_rejects: u32::MAX,
        max_global_rejects: u32::MAX,
        ..ProptestConfig::default()
    }
}

/// Measured profile of drawn scenes.
const FILE: &str = "profile.csv";

/// Most springs of a computed line.
const MOST_POINTS: u64 = 2000;

/// Scenes of all kinds that are computed in milliseconds.
fn quick() -> Drawn {
    // All orders of magnitude alike.
    let whole = |min: u64, max: u64| {
        ((min as f64).ln()..=(max as f64).ln())
            .prop_map(|log| (log.exp().round() as u64).to_string())
            .boxed()
    };
    let modes =
        (1_u64..300, 0_u64..300).prop_map(|(first, more)| format!("({first}, {})", first + more));
    Drawn::default()
        .narrowed("numerics.points", whole(1, MOST_POINTS))
        .narrowed("numerics.samples", whole(2, 40))
        .narrowed("numerics.solver", Just("Exact".to_string()).boxed())
        .narrowed("roughness.modes", modes.boxed())
        .narrowed("roughness.file", Just(format!("{FILE:?}")).boxed())
}

/// A profile on a length of 1, with heights of the size of 1: positions and heights.
type Shape = (Vec<f64>, Vec<f64>);

/// Shapes with heights of a few levels, which nearly tie, and with heights of all sizes; steps
/// equal and of many sizes.
fn shapes() -> impl Strategy<Value = Shape> {
    let near_tie = (0_u8..4, 0_u32..5).prop_map(|(level, steps)| {
        (0..steps).fold(0.25 * f64::from(level), |height, _| height.next_up())
    });
    let any_size = (-40.0..0.0_f64).prop_map(f64::exp);
    let step = || prop_oneof![3 => Just(1.0), 1 => (-12.0..2.0_f64).prop_map(f64::exp)];
    let rows = |height: BoxedStrategy<f64>| prop::collection::vec((step(), height), 2..40);
    prop_oneof![
        rows(near_tie.boxed()),
        rows(any_size.boxed()),
        rows((-1.0..1.0_f64).boxed())
    ]
    .prop_map(|rows| {
        let end: f64 = rows[1..].iter().map(|(step, _)| step).sum();
        let add = |x: &mut f64, step: &f64| Some(std::mem::replace(x, *x + step / end));
        let steps = rows
            .iter()
            .skip(1)
            .map(|(step, _)| *step)
            .chain([0.0])
            .collect::<Vec<_>>();
        (
            steps.iter().scan(0.0, add).collect(),
            rows.iter().map(|(_, height)| *height).collect(),
        )
    })
}

/// Text of a shape on this length and height, m.
fn text_of((positions, heights): &Shape, length: f64, height: f64) -> String {
    let row = |(x, z): (&f64, &f64)| format!("{:?}\t{:?}\n", x * length, z * height);
    positions.iter().zip(heights).map(row).collect()
}

#[test]
fn texts_of_scenes_with_and_without_mistakes() {
    proptest!(draws(500), |(text in Drawn::default().scene_texts())| scene(text.as_bytes()));
    proptest!(draws(500), |(text in Drawn::default().with_mistakes().scene_texts())| scene(text.as_bytes()));
}

/// A change of one field keeps all comments and all other fields of the scene.
fn assert_one_field(path: &str, before: &Document, after: &Document) {
    let comments = |document: &Document| -> Vec<String> {
        let lines = document.text().lines();
        lines
            .filter_map(|line| Some(line.split_once("// ")?.1.to_owned()))
            .collect()
    };
    // A drawn text may look like a comment.
    let kept = comments(after);
    assert!(
        comments(before)
            .iter()
            .all(|comment| kept.contains(comment)),
        "{path}"
    );
    let [before, after] =
        [before, after].map(|document| serde_json::to_value(document.scene()).unwrap());
    for (name, part) in before.as_object().unwrap() {
        assert!(
            path.split('.').next() == Some(name) || after[name] == *part,
            "{path} changed {name}"
        );
    }
}

#[test]
fn overrides_of_presets() {
    let names: Vec<&str> = asperity::scene::presets()
        .iter()
        .map(|preset| preset.name)
        .collect();
    let drawn =
        [Drawn::default(), Drawn::default().with_mistakes()].map(|drawn| drawn.overrides(3));
    proptest!(draws(1250), |(name in prop::sample::select(names), set in Union::new(drawn))| {
        // The words of a built-in scene belong to its values alone, those of another file stay.
        let text = asperity::scene::open(name).unwrap().text().replace("title: \"", "title: \"Own ");
        let document = Document::parse(&text, name).unwrap();
        for (path, value) in &set {
            if let Ok(changed) = document.set(path, value) {
                assert_one_field(path, &document, &changed);
            }
        }
        let lines: String = set.iter().map(|(path, value)| format!("\n{path}={value}")).collect();
        overrides(format!("{name}{lines}").as_bytes());
    });
}

#[test]
fn shapes_of_profiles() {
    let sizes =
        (-20.0..2.0_f64, -40.0..2.0_f64).prop_map(|(length, height)| (length.exp(), height.exp()));
    proptest!(draws(600), |(shape in shapes(), (length, height) in sizes)| {
        profile(text_of(&shape, length, height).as_bytes());
    });
}

/// A storm of only refused texts, or of only a few kinds of scenes, would prove little.
#[test]
fn all_fields_are_drawn_and_many_texts_are_allowed() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut drawn = |drawn: Drawn| -> Vec<String> {
        let texts = drawn.scene_texts();
        (0..1500)
            .map(|_| texts.new_tree(&mut runner).unwrap().current())
            .collect()
    };
    let [sound, wrong] = [Drawn::default(), Drawn::default().with_mistakes()].map(&mut drawn);
    for field in FIELDS {
        let entry = format!("{}: ", field.last());
        assert!(
            sound.iter().any(|text| text.contains(&entry)),
            "{} is not drawn",
            field.path
        );
        let (Range::Choice(of) | Range::List { of, .. }) = field.range else {
            continue;
        };
        for choice in of {
            let start = choice
                .find([':', '('])
                .map_or(*choice, |end| &choice[..end.max(1)]);
            assert!(
                sound.iter().any(|text| text.contains(start)),
                "{choice} is not drawn"
            );
        }
    }
    let allowed = |texts: &[String]| {
        texts
            .iter()
            .filter(|text| Document::parse(text, "drawn").is_ok())
            .count()
    };
    assert!(allowed(&sound) >= 30 && allowed(&wrong) < allowed(&sound));
}
