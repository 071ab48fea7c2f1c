//! Scenes from outside: any text gets an answer, and a change to one field changes that field
//! alone.

use asperity_contact::Move;
use asperity_scene::fields::{Effect, FIELDS, Range};
use asperity_scene::library::DEFAULT;
use asperity_scene::text::{LONGEST_TEXT, Text, TextSpan, to_ron};
use asperity_scene::workload::{WorkPart, Workload};
use asperity_scene::{Document, Roughness, Scene, Simulation, open, presets};

fn locate(text: &str, path: &str) -> Option<TextSpan> {
    Text::new(text).ok()?.span(path).cloned()
}

fn message(text: &str) -> String {
    Document::parse(text, "scene.ron").unwrap_err().to_string()
}

/// A scene with this third line.
fn with_line(line: &str) -> String {
    format!(
        "(\n    version: 1,\n    {line}\n    material: (modulus: 1.0e6),\n    length: 1.0e-4,\n)\n"
    )
}

#[test]
fn a_scene_that_asks_for_too_much_is_refused_at_once() {
    for (line, expected) in [
        (
            "numerics: (points: 268435457),",
            "numerics.points = 268435457: allowed: a whole number from 1 to",
        ),
        (
            "numerics: (points: 18446744073709551615),",
            "numerics.points = 18446744073709551615: allowed",
        ),
        (
            "numerics: (points: 18446744073709551616),",
            "numerics.points = 18446744073709551616: allowed",
        ),
        (
            "numerics: (samples: 1000001),",
            "numerics.samples = 1000001: allowed: a whole number from 2 to",
        ),
    ] {
        let all = message(&with_line(line));
        assert!(all.contains(expected), "{all}");
    }
    let line = format!("loading: [{}],", "ToTouch,".repeat(100_001));
    assert!(
        message(&with_line(&line))
            .contains("loading = a list of 100001: allowed: a list of 1 to 100000")
    );
    assert!(message(&" ".repeat(LONGEST_TEXT + 1)).contains("bytes long"));
}

#[test]
fn nesting_does_not_overflow_the_stack() {
    for (open, close) in [
        ("(", ")"),
        ("[", "]"),
        ("Some(", ")"),
        ("{", "}"),
        ("/*", "*/"),
    ] {
        let deep = format!("{}{}", open.repeat(100_000), close.repeat(100_000));
        let _ = Document::parse(&deep, "scene.ron");
        let _ = Document::parse(&with_line(&format!("form: {deep},")), "scene.ron");
        let _ = locate(&with_line(&format!("form: {deep},")), "form.0.0.0.0");
        assert!(open_default().set("form", &deep).is_err(), "{open}");
    }
}

#[test]
fn effects_are_on_where_their_stages_run() {
    let document = open_default();
    let stages = [
        Move::ToForce(1e-6),
        Move::ToForce(1e-5),
        Move::ToIndentation(-1e-9),
        Move::ToIndentation(1e-8),
        Move::ToTouch,
        Move::ToZeroForce,
        Move::ToSeparation,
    ];
    let mut loadings: Vec<Vec<Move>> = stages.iter().map(|stage| vec![*stage]).collect();
    for length in 1..3 {
        let longer = loadings.iter().filter(|loading| loading.len() == length);
        let longer: Vec<_> = longer
            .flat_map(|loading| {
                stages
                    .iter()
                    .map(|stage| [&loading[..], &[*stage]].concat())
            })
            .collect();
        loadings.extend(longer);
    }
    assert_eq!(loadings.len(), 7 + 49 + 343);
    for loading in loadings {
        // A loading that begins with a pull is refused.
        let Ok(scene) = document.scene().with(|scene| scene.loading = loading) else {
            continue;
        };
        let runs = Workload::of(&scene).runs(WorkPart::UnloadingPass);
        assert_eq!(Effect::Unloading.is_on(&scene), runs, "{:?}", scene.loading);
    }
    for (path, value) in [
        ("form", "Cone(angle: 0.1)"),
        ("adhesion", "None"),
        ("adhesion", "(work: 0.0)"),
        ("adhesion", "(work: 0.1)"),
        ("roughness", "Measured(file: \"line.csv\")"),
    ] {
        let document = document.set(path, value).unwrap();
        let plan = Workload::of(document.scene());
        let runs = |stages: &[WorkPart]| stages.iter().any(|stage| plan.runs(*stage));
        for (effect, stages) in [
            (Effect::Form, &[WorkPart::Form][..]),
            (
                Effect::Roughness,
                &[WorkPart::Synthesis, WorkPart::MeasuredProfile],
            ),
            (Effect::Adhesion, &[WorkPart::RuleOfHess]),
        ] {
            assert_eq!(
                effect.is_on(document.scene()),
                runs(stages),
                "{path}={value}: {effect:?}"
            );
        }
    }
}

fn open_default() -> Document {
    open(DEFAULT).unwrap()
}

#[test]
fn the_table_names_every_field_of_the_model_and_no_other() {
    // A scene as JSON has every field of the model, including omitted ones.
    let mut found = Vec::new();
    for (form, rough, solver) in [
        (
            "Paraboloid(radius: 1.0)",
            "Measured(file: \"x\", further_files: [\"z\"], opposite: \"y\", row: 1, detrend: Tilt, \
             periodic: true, unit: \"mm\", height_unit: \"nm\", spacing: 1.0e-6, interpolate: true, resample: true, \
             align_rows: true, robust: true, surface_name: \"y\", channel: 1, continue_to: 1.0e-9, seed: 2)",
            "Stepwise(step: 1.0)",
        ),
        (
            "Cone(angle: 0.1)",
            "SelfAffine(hurst: 0.5, modes: (1, 2), seed: 1, rms_height: 1.0e-9)",
            "Exact",
        ),
        (
            "Power(coefficient: 1.0, exponent: 1.0)",
            "SelfAffine(hurst: 0.5, wavelengths: (1.0e-4, 1.0e-6), roll_off: 1.0e-5, seed: 1, rms_gradient: 1.0)",
            "Exact",
        ),
        (
            "Punch(radius: 1.0e-5)",
            "Measured(file: \"x\", column: 2, as_line: true)",
            "Exact",
        ),
        (
            "WavySphere(radius: 1.0e-3, amplitude: 1.0e-9, wavelength: 1.0e-6)",
            "None",
            "Exact",
        ),
        ("RoundedCone(radius: 1.0e-8, angle: 0.3)", "None", "Exact"),
        (
            "Spheres([(radius: 1.0e-6), (radius: 1.0e-6, behind: 1.0e-7)])",
            "None",
            "Exact",
        ),
        ("Table(file: \"x\", unit: \"nm\")", "None", "Exact"),
    ] {
        let stiffness = if solver == "Exact" { "1.0" } else { "None" };
        for (material, adhesion) in [
            (
                "(modulus: 1.0e6)",
                "(work: 0.1, closing_work: 0.05, range: 1.0e-9)",
            ),
            ("(youngs_modulus: 1.0e6, poisson_ratio: 0.5)", "None"),
        ] {
            let text = format!(
                "(version: 1, material: {material}, length: 1.0e-4, form: {form}, roughness: {rough}, \
                 adhesion: {adhesion}, loading_stiffness: {stiffness}, numerics: (solver: {solver}))"
            );
            let document = Document::parse(&text, "x").unwrap_or_else(|errors| panic!("{errors}"));
            paths_of(
                &serde_json::to_value(document.scene()).unwrap(),
                String::new(),
                &mut found,
            );
        }
    }
    let relaxing = "(version: 1, material: (modulus: 1.0e6, relaxation: (share: 0.2, time: 10.0)), \
                    length: 1.0e-4, loading_speed: 1.0e-6)";
    let document = Document::parse(relaxing, "x").unwrap_or_else(|errors| panic!("{errors}"));
    let relaxing = serde_json::to_value(document.scene()).unwrap();
    paths_of(&relaxing, String::new(), &mut found);
    found.extend(["adhesion.kappa", "adhesion.elastic_energy_ratio"].map(String::from));
    let table: Vec<_> = FIELDS.iter().map(|field| field.path).collect();
    for path in &found {
        assert!(table.contains(&path.as_str()), "{path} is not in the table");
    }
    for path in table {
        assert!(
            found.iter().any(|found| found == path),
            "{path} is not in the model"
        );
    }
}

fn paths_of(value: &serde_json::Value, path: String, found: &mut Vec<String>) {
    let Some(fields) = value.as_object() else {
        return;
    };
    for (name, value) in fields {
        // The name of a variant is not part of a path.
        let inside = match (path.as_str(), name.starts_with(char::is_uppercase)) {
            (_, true) => path.clone(),
            ("", false) => name.clone(),
            (_, false) => format!("{path}.{name}"),
        };
        if !name.starts_with(char::is_uppercase) {
            found.push(inside.clone());
        }
        paths_of(value, inside, found);
    }
}

#[test]
fn the_choices_of_the_table_can_be_set() {
    let smooth = "(version: 1, material: (modulus: 1.0e6), length: 1.0e-4)";
    let document = Document::parse(smooth, "x").unwrap();
    for field in FIELDS {
        match field.range {
            Range::Choice(choices) => {
                for choice in choices {
                    let roughness =
                        "SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 512), seed: 1)";
                    let document = match *choice {
                        "(kappa: 2.0)" | "(elastic_energy_ratio: 0.5)" => {
                            document.set("roughness", roughness).unwrap()
                        }
                        "false" | "true" | "Nothing" | "Mean" | "Tilt" | "Curvature" => {
                            document.set("roughness", "Measured(file: \"x\")").unwrap()
                        }
                        "(share: 0.2, time: 10.0)" => {
                            document.set("loading_speed", "1.0e-6").unwrap()
                        }
                        _ => document.clone(),
                    };
                    document
                        .set(field.path, choice)
                        .unwrap_or_else(|errors| panic!("{choice}: {errors}"));
                }
            }
            Range::List { of, .. } => {
                let all = format!("[{}]", of.join(", "));
                let measured = || {
                    document
                        .set("roughness", "Measured(file: \"x\", as_line: false)")
                        .unwrap()
                };
                let document = if field.parent() == "roughness" {
                    measured()
                } else {
                    document.clone()
                };
                document
                    .set(field.path, &all)
                    .unwrap_or_else(|errors| panic!("{all}: {errors}"));
            }
            _ => {}
        }
    }
}

#[test]
fn what_the_table_says_of_left_out_fields_is_so() {
    let smooth = "(version: 1, material: (modulus: 1.0e6), length: 1.0e-4)";
    let document = Document::parse(smooth, "x").unwrap();
    let left_out = |path: &str| locate(smooth, path).is_none();
    let fields = FIELDS
        .iter()
        .filter(|field| field.variant.is_none() && !field.default.is_empty());
    for field in fields.filter(|field| left_out(field.path)) {
        let written = document
            .set(field.path, field.default)
            .unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(written.scene(), document.scene(), "{}", field.path);
    }
    for field in FIELDS
        .iter()
        .filter(|field| field.parent().is_empty() && field.default.is_empty())
    {
        let place = locate(smooth, field.path).unwrap();
        let without = smooth
            .replace(&smooth[place.entry], "")
            .replace("(,", "(")
            .replace(", ,", ",");
        assert!(
            message(&without.replace(", )", ")")).contains("missing"),
            "{}",
            field.path
        );
    }
}

#[test]
fn presets_say_only_what_differs_from_the_defaults() {
    for preset in presets() {
        let document = open(preset.name).unwrap();
        let canonical = to_ron(document.scene());
        assert_eq!(
            Document::parse(&canonical, preset.name).unwrap().scene(),
            document.scene()
        );
        for field in FIELDS {
            let written = |text: &str| locate(text, field.path).is_some();
            assert_eq!(
                written(preset.text),
                written(&canonical),
                "{}: {}",
                preset.name,
                field.path
            );
        }
    }
}

/// What is refused where a scene is read is refused where it is computed: there is no other way to
/// a checked scene.
#[test]
fn a_refused_scene_has_no_numbers() {
    let document = open("pressure-sensitive").unwrap();
    type Change = fn(&mut Scene);
    let changes: [(&str, Change); 7] = [
        ("roughness.modes", |scene| scene.numerics.points = 1),
        ("roughness.modes", |scene| modes(scene, (10, 1))),
        ("roughness.modes", |scene| modes(scene, (1, 1 << 40))),
        ("roughness", |scene| {
            scene.adhesion = None;
            if let Some(Roughness::SelfAffine { rms_height, .. }) = &mut scene.roughness {
                *rms_height = None;
            }
        }),
        ("loading", |scene| scene.loading.clear()),
        ("numerics.samples", |scene| scene.numerics.samples = 0),
        ("length", |scene| scene.length = f64::NAN),
    ];
    for (field, change) in changes {
        let refused = document.scene().with(change).unwrap_err();
        assert!(
            refused.iter().any(|error| error.field == field),
            "{field}: {refused}"
        );
    }
    let simulation = &mut Simulation::default();
    let coarse = document
        .scene()
        .with(|scene| scene.numerics.points = 1024)
        .unwrap();
    assert!(simulation.compute(&coarse).is_ok());
}

fn modes(scene: &mut Scene, wanted: (u64, u64)) {
    if let Some(Roughness::SelfAffine { modes, .. }) = &mut scene.roughness {
        *modes = Some(wanted);
    }
}
