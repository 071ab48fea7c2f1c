//! Two spheres on one probe against each of them alone.

use asperity_scene::{Document, Outcome, Simulation};

/// Loading whose stages end at the same indentations for all bodies.
const INDENTATIONS: [f64; 4] = [6e-7, 1e-7, 4e-7, -8e-7];

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

/// At each indentation the forces of both spheres add, in every stage of a loading with minor
/// loops.
#[test]
fn the_forces_of_both_spheres_add() {
    let behind = 2e-7;
    let length = 2.4e-5;
    for points in [2048, 2050, 4095] {
        let form = format!("TwoSpheres(radius: 5.4e-6, second_radius: 3.2e-6, behind: {behind:e})");
        let both = outcome(&form, length, points, 0.0);
        let spacing = length / points as f64;
        let alone = |radius: f64, points: usize, behind: f64| {
            let form = format!("Paraboloid(radius: {radius:e})");
            outcome(&form, spacing * points as f64, points, behind)
        };
        let first = alone(5.4e-6, points / 2, 0.0);
        let second = alone(3.2e-6, points - points / 2, behind);
        let largest = both.figures.pull_off_force.unwrap();
        for (stage, &end) in INDENTATIONS.iter().enumerate() {
            let sum = force_at(&first, stage, end) + force_at(&second, stage, end - behind);
            let found = force_at(&both, stage, end);
            assert!(
                (found - sum).abs() < 1e-9 * largest,
                "{points}: {found} against {sum}"
            );
        }
    }
}

/// Without a distance behind, and with equal radii, the pull-off force doubles. A second sphere far
/// behind has no contact.
#[test]
fn equal_spheres_double_the_force_and_a_far_one_adds_none() {
    let force = |form: &str| {
        outcome(form, 2.4e-5, 4096, 0.0)
            .figures
            .pull_off_force
            .unwrap()
    };
    let single = force("Paraboloid(radius: 5.4e-6)");
    let equal = force("TwoSpheres(radius: 5.4e-6, second_radius: 5.4e-6, behind: 0.0)");
    assert!((equal / single - 2.0).abs() < 1e-3, "{equal} {single}");
    let far = force("TwoSpheres(radius: 5.4e-6, second_radius: 5.4e-6, behind: 1.0e-3)");
    assert!((far / single - 1.0).abs() < 1e-3, "{far} {single}");
}

/// A contact that is wider than its half of the length is named, of either sphere.
#[test]
fn a_contact_wider_than_its_half_is_named() {
    for (radius, second_radius) in [("2.0e-4", "3.2e-6"), ("3.2e-6", "2.0e-4")] {
        let form =
            format!("TwoSpheres(radius: {radius}, second_radius: {second_radius}, behind: 0.0)");
        let outcome = outcome(&form, 2.4e-5, 2048, 0.0);
        let names: Vec<_> = outcome
            .warnings
            .iter()
            .map(|warning| warning.name())
            .collect();
        assert!(names.contains(&"contact_at_ends"), "{names:?}");
    }
}
