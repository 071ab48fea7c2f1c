//! Spheres on one probe against each of them alone, and against lines of heights.

use asperity_contact::{Contact, Modulus, Move, Profile};
use asperity_scene::{Document, Outcome, Simulation, open};

/// Loading whose stages end at the same indentations for all bodies.
const INDENTATIONS: [f64; 4] = [6e-7, 1e-7, 4e-7, -8e-7];
/// Radius in m, and distance behind in m.
type Listed = [f64; 2];

/// Returns a form of these spheres in RON.
fn form_of(spheres: &[Listed]) -> String {
    let mut written = Vec::new();
    for [radius, behind] in spheres {
        written.push(format!("(radius: {radius:e}, behind: {behind:e})"));
    }
    format!("Spheres([{}])", written.join(", "))
}

fn outcome(form: &str, length: f64, points: usize, behind: f64) -> Outcome {
    let stages =
        INDENTATIONS.map(|indentation| format!("ToIndentation({:e})", indentation - behind));
    let text = format!(
        "(version: 1, material: (modulus: 8.0e5), length: {length:e}, form: {form}, \
         adhesion: (work: 0.017, closing_work: 0.01), loading: [{}], \
         numerics: (points: {points}, samples: 257))",
        stages.join(", ")
    );
    let document = Document::parse(&text, "test").unwrap();
    Simulation::default().compute(document.scene()).unwrap()
}

/// Force in N at an indentation in m on a stage, between two of its samples.
fn force_at(outcome: &Outcome, stage: usize, indentation: f64) -> f64 {
    let curve = &outcome.history.stages[stage].curve;
    let mut nearest = &curve[0];
    for point in curve {
        let distance = (point.indentation - indentation).abs();
        if distance < (nearest.indentation - indentation).abs() {
            nearest = point;
        }
    }
    assert!(
        (nearest.indentation - indentation).abs() < 1e-15,
        "{indentation}"
    );
    nearest.force
}

/// At each indentation the forces of all spheres add, in every stage of a loading with minor loops.
#[test]
fn the_forces_of_all_spheres_add() {
    let listed = [
        [5.4e-6, 0.0],
        [3.2e-6, 2e-7],
        [8e-6, 5e-8],
        [3.2e-6, 0.0],
        [1e-6, 5e-7],
    ];
    let width = 1.2e-5;
    for count in 1..=listed.len() {
        let spheres = &listed[..count];
        let length = width * count as f64;
        for points in [1024 * count, 1024 * count + 1, 1024 * count + 2] {
            let all = outcome(&form_of(spheres), length, points, 0.0);
            let spacing = length / points as f64;
            let mut alone = Vec::new();
            for (index, [radius, behind]) in spheres.iter().enumerate() {
                let springs = (index + 1) * points / count - index * points / count;
                let form = format!("Paraboloid(radius: {radius:e})");
                alone.push(outcome(&form, spacing * springs as f64, springs, *behind));
            }
            let largest = all.figures.pull_off_force.unwrap();
            for (stage, &end) in INDENTATIONS.iter().enumerate() {
                let mut sum = 0.0;
                for (sphere, [_, behind]) in alone.iter().zip(spheres) {
                    sum += force_at(sphere, stage, end - behind);
                }
                let found = force_at(&all, stage, end);
                assert!(
                    (found - sum).abs() < 1e-9 * largest,
                    "{count} {points}: {found} against {sum}"
                );
            }
        }
    }
}

/// One sphere of a list is a sphere, to the last bit.
#[test]
fn one_sphere_of_a_list_is_a_sphere() {
    for points in [1023, 1024] {
        let list = outcome("Spheres([(radius: 5.4e-6)])", 1.2e-5, points, 0.0);
        let sphere = outcome("Paraboloid(radius: 5.4e-6)", 1.2e-5, points, 0.0);
        assert_eq!(list.history, sphere.history);
        assert_eq!(list.figures, sphere.figures);
        assert_eq!(list.warnings, sphere.warnings);
    }
}

/// Three spheres against a line of heights that the test computes by itself.
#[test]
fn three_spheres_are_a_line_of_heights() {
    let spheres = [[5.4e-6, 1e-7], [3.2e-6, 0.0], [7e-6, 2.5e-7]];
    let (width, springs) = (1.2e-5, 1024_u16);
    let spacing = width / f64::from(springs);
    let mut heights = Vec::new();
    for [radius, behind] in spheres {
        for spring in 0..springs {
            let distance = spacing * (f64::from(spring) - 512.0);
            heights.push(-behind - distance * distance / radius);
        }
    }
    let profile = Profile::from_heights(heights, spacing).unwrap();
    let contact = Contact::builder(&profile, Modulus::effective(8e5).unwrap())
        .works_of_adhesion([0.01, 0.017])
        .build()
        .unwrap();
    let line = contact
        .load(&INDENTATIONS.map(Move::ToIndentation))
        .unwrap();
    let form = outcome(&form_of(&spheres), 3.0 * width, 3 * 1024, 0.0);
    let largest = form.figures.pull_off_force.unwrap();
    for (stage, &end) in INDENTATIONS.iter().enumerate() {
        let of_line = line.stages()[stage].curve.last().unwrap();
        let found = force_at(&form, stage, end);
        assert!((of_line.force - found).abs() < 1e-9 * largest, "{stage}");
    }
    let pull_off = line.pull_off_force().unwrap();
    assert!(
        (largest / pull_off - 1.0).abs() < 1e-3,
        "{largest} {pull_off}"
    );
}

/// Without a distance behind, and with equal radii, the pull-off force is that of one sphere times
/// their number. A sphere far behind has no contact, wherever it is in the list.
#[test]
fn equal_spheres_multiply_the_force_and_a_far_one_adds_none() {
    let force = |spheres: &[Listed]| {
        let length = 1.2e-5 * spheres.len() as f64;
        let outcome = outcome(&form_of(spheres), length, 2048 * spheres.len(), 0.0);
        outcome.figures.pull_off_force.unwrap()
    };
    let near = [5.4e-6, 0.0];
    let far = [5.4e-6, 1e-3];
    let single = force(&[near]);
    for count in [2, 3, 7] {
        let equal = force(&vec![near; count]) / single;
        assert!(
            (equal / count as f64 - 1.0).abs() < 1e-3,
            "{count}: {equal}"
        );
    }
    for spheres in [[near, far], [far, near]] {
        let share = force(&spheres) / single;
        assert!((share - 1.0).abs() < 1e-3, "{share}");
    }
    let share = force(&[far, near, far]) / single;
    assert!((share - 1.0).abs() < 1e-3, "{share}");
}

/// A contact that is wider than its part of the length is named, of any sphere.
#[test]
fn a_contact_wider_than_its_part_is_named() {
    let wide = [2e-4, 0.0];
    let narrow = [3.2e-6, 0.0];
    for spheres in [
        vec![wide, narrow],
        vec![narrow, wide],
        vec![narrow, wide, narrow],
    ] {
        let length = 1.2e-5 * spheres.len() as f64;
        let outcome = outcome(&form_of(&spheres), length, 2048, 0.0);
        let mut names = outcome.warnings.iter().map(|warning| warning.name());
        assert!(names.any(|name| name == "contact_at_ends"), "{spheres:?}");
    }
}

/// Changes of one sphere keep the text of all others. Values may have units.
#[test]
fn each_sphere_is_changed_alone() {
    let two = open("two-spheres").unwrap();
    let changed = |path: &str, value: &str| {
        let changed = two.set(path, value).unwrap();
        let form = changed.text().lines().find(|line| line.contains("form:"));
        form.unwrap().trim().to_owned()
    };
    for (path, value, expected) in [
        (
            "form.1.radius",
            "3 µm",
            "form: Spheres([(radius: 5.4e-6), (radius: 3.0e-6, behind: 2.0e-7)]),",
        ),
        (
            "form.1.behind",
            "0",
            "form: Spheres([(radius: 5.4e-6), (radius: 3.2e-6, behind: 0)]),",
        ),
        (
            "form.0.behind",
            "0 nm",
            "form: Spheres([(radius: 5.4e-6, behind: 0.0), (radius: 3.2e-6, behind: 2.0e-7)]),",
        ),
        (
            "form.0",
            "(radius: 1 µm)",
            "form: Spheres([(radius: 1.0e-6), (radius: 3.2e-6, behind: 2.0e-7)]),",
        ),
        (
            "form",
            "Spheres([(radius: 4 µm), (radius: 1e-6, behind: 20 nm), (radius: 3um)])",
            "form: Spheres([(radius: 4.0e-6), (radius: 1e-6, behind: 2.0e-8), (radius: 3.0e-6)]),",
        ),
    ] {
        assert_eq!(changed(path, value), expected, "{path}");
    }
    assert_eq!(two.value("form.1.radius"), Some("3.2e-6"));
    assert_eq!(two.value("form.0.behind"), Some("0.0"));
    assert_eq!(two.value("form.2.behind"), None);
    assert_eq!(two.scene().number("form.1.behind"), Some(2e-7));
    let paths = [
        "form.0.radius",
        "form.0.behind",
        "form.1.radius",
        "form.1.behind",
    ];
    assert_eq!(two.scene().paths_in_lists()[..4], paths);
    let other = two.set("form.1.radius", "3 µm").unwrap();
    let changes = two.changes_to(&other);
    assert_eq!(
        changes[0].to_string(),
        "form spheres (R 5.4 µm; R 3.2 µm, b 200 nm) → spheres (R 5.4 µm; R 3 µm, b 200 nm)"
    );
}

#[test]
fn wrong_spheres_are_refused_with_their_place() {
    let two = open("two-spheres").unwrap();
    for (path, value, said) in [
        (
            "form",
            "Spheres([])",
            "form = Spheres([]): allowed: a list of 1 to 10000",
        ),
        (
            "form.1.radius",
            "0",
            "form.1.radius = 0.0: allowed: above 0, at most 1e9 m (radius of sphere)",
        ),
        (
            "form.0.radius",
            "-1 µm",
            "form.0.radius = -1.0e-6: allowed: above 0",
        ),
        (
            "form.1.behind",
            "-1e-9",
            "form.1.behind = -1.0e-9: allowed: from 0 to 1e6 m (distance behind of sphere)",
        ),
        (
            "form.0.behind",
            "100 nm",
            "no sphere is ahead: behind is 0 for one of them, so take 1.0e-7 from each",
        ),
        ("form.2.radius", "1e-6", "there is no such sphere"),
        ("form.2", "(radius: 1e-6)", "there is no such element"),
        ("form.1.radius", "1 N", "N is not a unit of length"),
        (
            "form.radius",
            "1e-6",
            "form is Spheres, which has no such field (its first sphere has form.0.radius)",
        ),
        ("form", "Spheres([(behind: 0.0)])", "radius"),
        (
            "form",
            "Spheres([(radius: 1e-6, width: 1)])",
            "no such field",
        ),
        ("form", "Spheres(3)", "a list in [ ] is expected"),
        (
            "numerics.points",
            "1",
            "2 spheres have 1 springs: more points or fewer spheres",
        ),
        ("length", "1e-9", ""),
    ] {
        match two.set(path, value) {
            Ok(_) => assert_eq!(said, "", "{path}={value}"),
            Err(errors) => {
                let text = errors.to_string();
                assert!(
                    !said.is_empty() && text.contains(said),
                    "{path}={value}: {text}"
                );
            }
        }
    }
    let sphere = open("jkr-sphere").unwrap();
    let errors = sphere.set("form.0.radius", "1e-6").unwrap_err().to_string();
    assert!(
        errors.contains("form is Paraboloid, which has no such field"),
        "{errors}"
    );
}
