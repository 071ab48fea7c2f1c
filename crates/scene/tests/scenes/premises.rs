//! Each premise that a scene breaks is named, and no other.

use asperity_contact::Move;
use asperity_data::{NamedHeight, Trend, TrendOfScan, Warning};
use asperity_scene::{
    Adhesion, CheckedScene, Material, Measured, Roughness, Scene, Simulation, Solver,
};
use asperity_surface::Form;
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::Path;

/// Premises of which scenes of this test break one each.
const PREMISES: [&str; 17] = [
    "contact_at_ends",
    "ends_in_contact",
    "few_springs_in_contact",
    "coarse_steps",
    "rest_without_relaxation",
    "few_springs_per_wave",
    "rounded_waves",
    "few_long_waves",
    "steep_roughness",
    "steep_form",
    "long_ranged_attraction",
    "finite_ranged_attraction",
    "heights_as_profile",
    "cut_like_heights",
    "scan_longer_than_length",
    "scan_shorter_than_length",
    "steep_waves",
];

/// Random numbers of a seed.
struct Random(u64);

impl Random {
    fn share(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.share())
    }

    fn whole(&mut self, low: u64, high: u64) -> u64 {
        low + (self.share() * (high + 1 - low) as f64) as u64
    }
}

/// A sphere in contact, with numbers from its closed form.
struct Sphere {
    scene: Scene,
    /// Contact radius at the preload, m.
    contact_radius: f64,
    /// Pull-off force, N.
    pull_off: f64,
}

/// A sphere that meets all premises (Johnson, Kendall and Roberts).
fn sphere(random: &mut Random) -> Sphere {
    let radius = random.between(5e-5, 1e-3);
    let modulus = random.between(5e5, 5e6);
    let work = random.between(0.01, 0.1);
    let pull = 3.0 * PI * work * radius;
    let force = random.between(0.1, 10.0) * pull;
    let loaded = force + pull + (2.0 * pull * force + pull * pull).sqrt();
    let contact_radius = (0.75 * radius * loaded / modulus).cbrt();
    let mut scene = Scene::new(Material::effective(modulus), 5.0 * contact_radius);
    scene.form = Some(Form::Paraboloid { radius });
    scene.adhesion = Some(Adhesion::by_work(work));
    scene.loading = vec![Move::ToForce(force), Move::ToSeparation];
    scene.numerics.points = random.whole(300, 900);
    Sphere {
        scene,
        contact_radius,
        pull_off: 0.5 * pull,
    }
}

/// A nominally flat random roughness that meets all premises, with the modes of its waves.
fn rough(random: &mut Random) -> (Scene, u64, u64) {
    let height = random.between(5e-8, 2e-7);
    let first = random.whole(5, 9);
    let last = random.whole(40, 90);
    let mut scene = Scene::new(
        Material::effective(random.between(5e5, 5e6)),
        random.between(1e-4, 3e-4),
    );
    scene.roughness = Some(Roughness::SelfAffine {
        hurst: 0.3 + 0.6 * random.share(),
        rms_height: Some(height),
        rms_gradient: None,
        modes: Some((first, last)),
        wavelengths: None,
        roll_off: None,
        seed: random.whole(1, 1_000_000),
    });
    scene.adhesion = Some(Adhesion::by_work(random.between(0.01, 0.1)));
    scene.loading = vec![Move::ToIndentation(3.0 * height), Move::ToSeparation];
    scene.numerics.points = last * random.whole(5, 9);
    (scene, first, last)
}

/// A scene with the roughness of a measured file, on a sphere so large that the contact ends inside
/// the profile.
fn measured(random: &mut Random, folder: &Path, heights: impl Fn(f64) -> f64) -> (Scene, f64) {
    let points = random.whole(200, 400);
    let spacing = random.between(1e-7, 2e-7);
    let mut text = "x [m],z [m]\n".to_owned();
    for index in 0..points {
        let x = spacing * (index as f64 - 0.5 * (points - 1) as f64);
        writeln!(text, "{x:e},{:e}", heights(x)).unwrap();
    }
    std::fs::write(folder.join("measured.csv"), text).unwrap();
    let scan = spacing * points as f64;
    let mut scene = Scene::new(Material::effective(1e6), 0.99 * scan);
    scene.roughness = Some(Roughness::Measured(Measured::of_file("measured.csv")));
    scene.adhesion = Some(Adhesion::by_work(0.01));
    scene.loading = vec![Move::ToIndentation(1e-9), Move::ToSeparation];
    scene.numerics.points = 2048;
    (scene, scan)
}

fn use_heights_as_profile(scene: &mut Scene) {
    if let Some(Roughness::Measured(measured)) = &mut scene.roughness {
        measured.as_line = true;
    }
}

fn use_steps(scene: &mut Scene, step: f64) {
    scene.numerics.solver = Solver::Stepwise { step };
    scene.numerics.edges = scene.numerics.solver.usual_edges();
}

/// A scene that meets all premises, and the same scene with one premise broken.
fn pair(premise: &str, random: &mut Random, folder: &Path) -> [Scene; 2] {
    let Sphere {
        scene: mut whole,
        contact_radius,
        pull_off,
    } = sphere(random);
    let mut broken = whole.clone();
    match premise {
        "contact_at_ends" => broken.length = contact_radius * random.between(1.2, 1.8),
        "ends_in_contact" => {
            broken.loading[1] = Move::ToForce(-pull_off * (0.95 * random.share()));
        }
        "few_springs_in_contact" => broken.numerics.points = random.whole(16, 44),
        "rest_without_relaxation" => {
            broken
                .loading
                .insert(1, Move::Hold(random.between(0.1, 9.0)));
        }
        "coarse_steps" => {
            let radius = whole.form.as_ref().and_then(Form::sphere_radius).unwrap();
            let depth = contact_radius.powi(2) / radius;
            use_steps(&mut whole, 1e-4 * depth);
            use_steps(&mut broken, depth * random.between(0.1, 0.3));
        }
        "long_ranged_attraction" | "finite_ranged_attraction" => {
            let wanted = if premise.starts_with("long") {
                0.1..0.99
            } else {
                1.01..4.99
            };
            let wanted = random.between(wanted.start, wanted.end);
            let number = computed(&whole, folder).1.unwrap();
            let adhesion = broken.adhesion.as_mut().unwrap();
            adhesion.range = Some(0.3e-9 * number / wanted);
        }
        "steep_form" => {
            let radius = whole.form.as_ref().and_then(Form::sphere_radius).unwrap();
            let widest = radius * random.between(1.1, 3.0);
            whole.adhesion = None;
            whole.length = 5.0 * widest;
            broken = whole.clone();
            // Without adhesion the contact radius a of a paraboloid has the indentation a²/R.
            for (scene, contact_radius) in [(&mut whole, 0.95 * radius), (&mut broken, widest)] {
                let pressed = Move::ToIndentation(contact_radius.powi(2) / radius);
                scene.loading = vec![pressed, Move::ToSeparation];
            }
        }
        "steep_waves" => {
            let radius = whole
                .form
                .as_mut()
                .and_then(|form| form.radius_mut().copied())
                .unwrap();
            let wavelength = whole.length / random.between(5.0, 12.0);
            let wavy = |ratio: f64| {
                let amplitude = wavelength * wavelength / (ratio * radius);
                Some(Form::WavySphere {
                    radius,
                    amplitude,
                    wavelength,
                })
            };
            whole.form = wavy(random.between(12.5, 100.0));
            broken.form = wavy(random.between(2.0, 12.3));
            for scene in [&mut whole, &mut broken] {
                // The waves change the indentation at a force.
                scene.length *= 1.5;
                scene.numerics.points *= 2;
            }
        }
        "heights_as_profile" => {
            let (scene, scan) = measured(random, folder, |x| {
                1e-8 * ((1e6 * x).sin() + (2.3e6 * x).cos())
            });
            whole = Scene {
                form: Some(Form::Paraboloid { radius: scan }),
                ..scene
            };
            whole.length = 1.01 * scan;
            broken = whole.clone();
            broken.length = 0.999_999_999_9 * scan;
            use_heights_as_profile(&mut broken);
        }
        "cut_like_heights" => {
            let radius = random.between(1e-4, 1e-2);
            let (scene, scan) = measured(random, folder, |x| -x * x / (2.0 * radius));
            // The contact of the cut is a quarter of the scan wide.
            let pressed = Move::ToIndentation((scan / 8.0).powi(2) / (2.0 * radius));
            broken = Scene {
                length: 0.999_999_999_9 * scan,
                adhesion: None,
                ..scene
            };
            broken.loading = vec![pressed, Move::ToSeparation];
            use_heights_as_profile(&mut broken);
            whole = Scene {
                form: Some(Form::Paraboloid { radius }),
                roughness: None,
                ..broken.clone()
            };
        }
        "scan_longer_than_length" | "scan_shorter_than_length" => {
            let long_wave = |x: f64| 3e-8 * (2.5e5 * x).cos();
            let (scene, scan) =
                measured(random, folder, |x| long_wave(x) + 1e-8 * (2.3e6 * x).cos());
            whole = Scene {
                form: Some(Form::Paraboloid { radius: scan }),
                ..scene
            };
            whole.length = 1.01 * scan;
            let [least, most] = match premise {
                "scan_longer_than_length" => [0.5, 0.9],
                _ => [1.15, 4.0],
            };
            broken = Scene {
                length: scan * random.between(least, most),
                ..whole.clone()
            };
            broken.numerics.points = if broken.length > scan { 8192 } else { 2048 };
        }
        _ => return rough_pair(premise, random),
    }
    [whole, broken]
}

/// A rough scene that meets all premises, and the same scene with one premise broken.
fn rough_pair(premise: &str, random: &mut Random) -> [Scene; 2] {
    let (mut whole, first, last) = rough(random);
    let mut broken = whole.clone();
    let length = whole.length;
    let Some(Roughness::SelfAffine {
        rms_height,
        rms_gradient,
        modes,
        wavelengths,
        ..
    }) = &mut broken.roughness
    else {
        unreachable!()
    };
    match premise {
        "few_springs_per_wave" => broken.numerics.points = random.whole(2 * last, 4 * last - 1),
        "few_long_waves" => *modes = Some((random.whole(1, 3), last)),
        "rounded_waves" => {
            let shift = 0.2 + 0.29 * random.share();
            *modes = None;
            *wavelengths = Some((length / (first as f64 + shift), length / last as f64));
        }
        _ => {
            // Without adhesion the steep roughness has no Tabor number.
            (*rms_height, *rms_gradient) = (None, Some(random.between(1.01, 4.0)));
            broken.adhesion = None;
            whole = broken.clone();
            if let Some(Roughness::SelfAffine { rms_gradient, .. }) = &mut whole.roughness {
                *rms_gradient = Some(0.1);
            }
            for scene in [&mut whole, &mut broken] {
                let checked = scene.clone().checked().unwrap();
                let (_, _, governing) = Simulation::default().make_line(&checked).unwrap();
                let height = governing.amplitude.unwrap().rms_height;
                scene.loading = vec![Move::ToIndentation(3.0 * height), Move::ToSeparation];
            }
        }
    }
    [whole, broken]
}

/// Names of the warnings of a scene, and its Tabor number.
fn computed(scene: &Scene, folder: &Path) -> (Vec<&'static str>, Option<f64>) {
    let checked: CheckedScene = scene
        .clone()
        .checked()
        .unwrap_or_else(|errors| panic!("{errors}\n{scene:?}"));
    let outcome = Simulation::new(folder.to_owned())
        .compute(&checked)
        .unwrap();
    (
        outcome.warnings.iter().map(Warning::name).collect(),
        outcome.tabor_number,
    )
}

/// Of 300 random scenes each breaks one premise. The warning is named in all of them, alone, and
/// the same scene with the premise restored has no warning.
#[test]
fn the_premise_that_a_scene_breaks_is_named_alone() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(20_261_128);
    let mut counts = [0; PREMISES.len()];
    for number in 0..300 {
        let index = random.whole(0, PREMISES.len() as u64 - 1) as usize;
        counts[index] += 1;
        let premise = PREMISES[index];
        let [whole, broken] = pair(premise, &mut random, folder.path());
        assert_eq!(
            computed(&broken, folder.path()).0,
            [premise],
            "{number}: {broken:?}"
        );
        assert_eq!(
            computed(&whole, folder.path()).0,
            [""; 0],
            "{number} {premise}: {whole:?}"
        );
    }
    assert!(counts.iter().all(|count| *count >= 8), "{counts:?}");
}

/// A file without units is read in m. Where its numbers are in µm or mm, the profile or the form is
/// larger than any measured body, and the unit of the file is called wrong.
#[test]
fn lengths_of_files_in_a_wrong_unit_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let mut profile = String::new();
    let mut table = String::new();
    for index in 0..400 {
        let x = 0.25 * (f64::from(index) + 0.5);
        writeln!(profile, "{x} {}", 0.05 * (1.3 * x).sin()).unwrap();
        let radius = 0.25 * f64::from(index);
        writeln!(table, "{radius} {}", 1e-3 * radius * radius).unwrap();
    }
    std::fs::write(folder.path().join("profile.txt"), profile).unwrap();
    std::fs::write(folder.path().join("form.txt"), table).unwrap();
    let mut scene = Scene::new(Material::effective(1e6), 2e-5);
    scene.loading = vec![Move::ToForce(1e-6), Move::ToSeparation];
    scene.numerics.points = 1024;
    for (unit, is_wrong) in [("", true), ("um", false)] {
        let mut rough = scene.clone();
        rough.roughness = Some(Roughness::Measured(Measured {
            as_line: true,
            unit: unit.to_owned(),
            ..Measured::of_file("profile.txt")
        }));
        let mut formed = scene.clone();
        formed.form = Some(Form::Table {
            file: "form.txt".to_owned(),
            unit: unit.to_owned(),
            rows: Default::default(),
        });
        for (scene, name) in [(rough, "improbable_lengths"), (formed, "improbable_form")] {
            let names = computed(&scene, folder.path()).0;
            assert_eq!(names.contains(&name), is_wrong, "{unit}: {names:?}");
        }
    }
}

/// A stage that passes its force by more than one per cent is named with both forces; fine steps
/// and the exact solver are not named.
#[test]
fn steps_that_pass_the_force_of_a_stage_are_named() {
    let document = asperity_scene::open("jkr-sphere").unwrap();
    let coarse = |solver: &str| {
        let scene = document.set("numerics.solver", solver).unwrap();
        let outcome = Simulation::default().compute(scene.scene()).unwrap();
        let mut warnings = outcome.warnings.into_iter();
        warnings.find(|warning| warning.name() == "coarse_steps")
    };
    let warning = coarse("Stepwise(step: 1e-6)").unwrap();
    let Warning::CoarseSteps {
        forces: Some([target, end]),
        ..
    } = warning
    else {
        panic!("{warning}")
    };
    assert!(target == 1e-4 && end > 1.01 * target, "{warning}");
    assert!(warning.remedy().contains("numerics.solver.step"));
    assert_eq!(coarse("Stepwise(step: 2e-9)"), None);
    assert_eq!(coarse("Exact"), None);
}

/// The slope of a form is that at the edge of its contact, without and with adhesion.
#[test]
fn the_slope_of_a_form_is_that_at_the_edge_of_the_contact() {
    let slope = |form: Form, adhesion: Option<Adhesion>, pressed: Move| {
        let mut scene = Scene::new(Material::effective(1e6), 1e-3);
        scene.form = Some(form);
        scene.adhesion = adhesion;
        scene.loading = vec![pressed];
        let outcome = Simulation::default()
            .compute(&scene.checked().unwrap())
            .unwrap();
        outcome.warnings.iter().find_map(|warning| match warning {
            Warning::SteepForm { slope } => Some(*slope),
            _ => None,
        })
    };
    let cone = |angle: f64| slope(Form::Cone { angle }, None, Move::ToIndentation(1e-4));
    assert!((cone(1.0).unwrap() / 1.0_f64.tan() - 1.0).abs() < 1e-9);
    assert_eq!(cone(0.78), None);
    let sphere = Form::Paraboloid { radius: 1e-4 };
    let pressed = slope(sphere.clone(), None, Move::ToIndentation(4e-4)).unwrap();
    assert!((pressed / 2.0 - 1.0).abs() < 0.03, "{pressed}");
    // By the theory of JKR the contact of a sphere at no force has a³ = 9π γR²/(2E*).
    let work = Adhesion::by_work(100.0);
    let pulled = slope(sphere, Some(work), Move::ToZeroForce).unwrap();
    let contact_radius = (4.5 * PI * 100.0 * 1e-8 / 1e6_f64).cbrt();
    assert!(
        (pulled * 1e-4 / contact_radius - 1.0).abs() < 0.03,
        "{pulled}"
    );
    let punch = Form::Punch { radius: 1e-5 };
    assert_eq!(slope(punch, None, Move::ToIndentation(1e-4)), None);
}

/// Premises that the fields alone decide are stated before the computation.
#[test]
fn a_scene_names_premises_of_its_fields_before_it_is_computed() {
    let mut random = Random(7);
    for premise in [
        "few_springs_per_wave",
        "few_long_waves",
        "rounded_waves",
        "steep_roughness",
    ] {
        for _ in 0..20 {
            let [whole, broken] = rough_pair(premise, &mut random);
            assert!(
                broken.warnings().iter().map(Warning::name).eq([premise]),
                "{:?}",
                broken.warnings()
            );
            assert_eq!(whole.warnings(), []);
        }
    }
}

/// Every warning has a sentence, a step that helps, and no option of the command line.
#[test]
fn words_are_whole_sentences_without_options() {
    let warnings = [
        Warning::ContactAtEnds { length: 2e-5 },
        Warning::EndsInContact {
            further: Some(1e-6),
        },
        Warning::EndsInContact { further: None },
        Warning::FewSpringsInContact { springs: 3 },
        Warning::CoarseSteps {
            step: 1e-6,
            steps: 8.0,
            forces: Some([1e-4, 1.68e-4]),
        },
        Warning::CoarseSteps {
            step: 1e-6,
            steps: 8.0,
            forces: None,
        },
        Warning::FewSpringsPerWave { springs: 3.99 },
        Warning::RoundedWaves {
            stated: [7.2e-5, 1e-7],
            used: [8e-5, 1e-7],
        },
        Warning::FewLongWaves { waves: 1.0 },
        Warning::SteepRoughness {
            rms_gradient: 1.2,
            is_measured: false,
        },
        Warning::SteepRoughness {
            rms_gradient: 1.2,
            is_measured: true,
        },
        Warning::SteepForm { slope: 3.1 },
        Warning::LongRangedAttraction { tabor_number: 0.8 },
        Warning::FiniteRangedAttraction { tabor_number: 2.0 },
        Warning::HeightsAsProfile,
        Warning::CutLikeHeights { radius: 2e-4 },
        Warning::ScanLongerThanLength {
            scan: 2.5e-4,
            length: 1e-4,
            rms_heights: [2.53e-7, 1.76e-7],
        },
        Warning::ScanShorterThanLength {
            scan: 3e-5,
            length: 1e-4,
            share: 0.66,
        },
        Warning::SteepWaves {
            ratio: 5.0,
            jkr_factor: 1.3,
        },
        Warning::FallingProfile { from: 1e-5 },
        Warning::MeasuredFile {
            file: "a.csv".to_owned(),
            property: "line 3: far away".into(),
        },
        Warning::SurfacesFarApart {
            flattest: NamedHeight {
                name: "a".to_owned(),
                rms_height: 1e-9,
            },
            roughest: NamedHeight {
                name: "b".to_owned(),
                rms_height: 1e-6,
            },
        },
        Warning::DisplacedRows { distance: 1e-6 },
        Warning::LongWavesOfScan {
            share: 0.5,
            is_levelled: false,
            trend: None,
        },
        Warning::LongWavesOfScan {
            share: 0.95,
            is_levelled: false,
            trend: None,
        },
        Warning::LongWavesOfScan {
            share: 0.95,
            is_levelled: true,
            trend: None,
        },
        Warning::LongWavesOfScan {
            share: 0.68,
            is_levelled: false,
            trend: Some(TrendOfScan {
                trend: Trend::Curvature,
                share: 0.93,
            }),
        },
        Warning::LongWavesOfScan {
            share: 0.68,
            is_levelled: false,
            trend: Some(TrendOfScan {
                trend: Trend::Tilt,
                share: 0.93,
            }),
        },
        Warning::EndsDoNotMeet { ratio: 27.3 },
        Warning::PartsDiffer { ratio: 1.5 },
        Warning::SurfacesDiffer { ratio: 3.2 },
        Warning::HeightsNotNormal {
            skewness: 3.8,
            kurtosis: 19.0,
        },
        Warning::ImprobableLengths {
            file: "a.x3p".to_owned(),
            length: 8.0,
            rms_height: 0.051,
        },
        Warning::ImprobableForm {
            file: "form.txt".to_owned(),
            reach: 50.0,
            length: 2e-5,
        },
        Warning::FewMeasuredProfiles { profiles: 1 },
        Warning::UnresolvedSpectrum,
        Warning::OffsetRows,
        Warning::WavesApart { share: 0.3 },
        Warning::TipArtefacts { wavelength: 1e-6 },
    ];
    for warning in warnings {
        let (sentence, remedy) = (warning.sentence(), warning.remedy());
        assert!(
            sentence.ends_with('.') && remedy.ends_with('.'),
            "{warning}"
        );
        assert!(
            !warning.to_string().contains("--") && !warning.to_string().contains("  "),
            "{warning}"
        );
        let is_key = warning
            .name()
            .chars()
            .all(|letter| letter == '_' || letter.is_ascii_lowercase());
        assert!(is_key && !warning.name().is_empty());
        assert!(
            !sentence.contains("NaN") && sentence.len() > 20,
            "{warning}"
        );
    }
}
