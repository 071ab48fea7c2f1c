//! Forms from a table of rows against the forms that they were computed from.

use asperity::reference::PowerLaw;
use asperity::scene::{Document, Form};
use asperity::simulation::{RunError, Simulation};
use asperity::surface::{FormTable, Line, SurfaceError};
use std::fmt::Write as _;
use std::path::Path;

const ROWS: usize = 1000;

/// Rows of a form up to a radius, the closer the nearer to the axis.
fn rows(reach: f64, depth: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    let radius = |row: usize| reach * (row as f64 / (ROWS - 1) as f64).powi(2);
    let radii: Vec<f64> = (0..ROWS).map(radius).collect();
    let depths = radii.iter().map(|&r| depth(r)).collect();
    (radii, depths)
}

fn scene(form: &str, length: f64) -> Document {
    let text = format!(
        "(version: 2, material: (effective_modulus: 1.0e6), length: {length:e}, form: {form}, adhesion: (work: 0.05), \
         loading: [ToForce(5.0e-5), ToSeparation], numerics: (points: 2001, samples: 65))"
    );
    Document::parse(&text, "test").unwrap()
}

fn text((radii, depths): &(Vec<f64>, Vec<f64>)) -> String {
    let mut text = "r [µm], f [nm]\n".to_owned();
    radii.iter().zip(depths).for_each(|(r, f)| writeln!(text, "{:e}, {:e}", r * 1e6, f * 1e9).unwrap());
    text
}

/// Force curve, pull-off force and F_smooth of a table within 1e-6 of those of its closed form.
#[test]
fn a_thousand_rows_are_their_closed_form() {
    let folder = tempfile::tempdir().unwrap();
    let reach = 5e-5;
    type Depth = Box<dyn Fn(f64) -> f64>;
    let forms: [(&str, Depth); 5] = [
        ("Paraboloid(radius: 1e-4)", Box::new(|r| r * r / 2e-4)),
        ("Cone(angle: 0.2)", Box::new(|r| r * 0.2_f64.tan())),
        ("Power(coefficient: 1e8, exponent: 3.0)", Box::new(|r| 1e8 * r.powi(3))),
        ("Power(coefficient: 50.0, exponent: 1.5)", Box::new(|r| 50.0 * r.powf(1.5))),
        (
            "WavySphere(radius: 1e-4, amplitude: 2e-8, wavelength: 1e-5)",
            Box::new(|r| r * r / 2e-4 + 2e-8 * (1.0 - (std::f64::consts::TAU * r / 1e-5).cos())),
        ),
    ];
    for (form, depth) in forms {
        std::fs::write(folder.path().join("tip.csv"), text(&rows(reach, depth))).unwrap();
        let run = |form: &str| {
            let mut simulation = Simulation::new(folder.path().to_owned());
            simulation.run(scene(form, 2.0 * reach).scene(), &|| false, &mut |_, _, _| Ok(())).unwrap()
        };
        let [exact, table] = [form, "Table(file: \"tip.csv\")"].map(run);
        let pull_off = |outcome: &asperity::simulation::Outcome| outcome.figures.adhesion_force.unwrap();
        let share = pull_off(&table) / pull_off(&exact);
        assert!((share - 1.0).abs() < 1e-6, "{form}: pull-off {share}");
        for (one, other) in exact.history.legs.iter().zip(&table.history.legs) {
            for (one, other) in one.curve.iter().zip(&other.curve) {
                // Ends and extremes have indentations of their own.
                let same = (one.indentation - other.indentation).abs() < 1e-9 * 1e-6;
                let error = (one.force - other.force).abs() / pull_off(&exact);
                assert!(!same || error < 1e-6, "{form}: {one:?} {other:?}");
            }
        }
        if !form.starts_with("Wavy") {
            let smooth = table.smooth_adhesion_force.unwrap() / exact.smooth_adhesion_force.unwrap();
            assert!((smooth - 1.0).abs() < 1e-4, "{form}: F_smooth {smooth}");
        }
        let number = [&exact, &table].map(|outcome| outcome.tabor_number);
        match (number, form.starts_with("Power")) {
            ([Some(one), Some(other)], _) => assert!((other / one - 1.0).abs() < 1e-2, "{form}: {number:?}"),
            ([one, other], is_power) => assert!(one == other || is_power, "{form}: {number:?}"),
        }
    }
}

/// g(x) of a sphere that goes over into a cone, and that of many points between two rows.
#[test]
fn a_sphere_on_a_cone_has_its_closed_profile() {
    let border = 0.25;
    let depth = |r: f64| if r < border { 0.5 * r * r } else { border * (r - 0.5 * border) };
    let profile = |x: f64| match x < border {
        true => x * x,
        false => x * (x - (x * x - border * border).sqrt() + border * (border / x).acos()),
    };
    let (radii, depths) = rows(1.0, depth);
    let table = FormTable::new(radii, &depths);
    for points in [50, 1 << 16] {
        let spacing = 1.0 / f64::from(points);
        let depths = table.depths(spacing, points as usize + 1).unwrap();
        assert_eq!(depths.len(), points as usize + 1);
        for (place, depth) in depths.iter().enumerate().skip(1) {
            let x = place as f64 * spacing;
            // Beside the border the curvature of f jumps between two rows.
            let allowed = if (x - border).abs() < 0.01 { 2e-5 } else { 1e-6 };
            assert!((depth / profile(x) - 1.0).abs() < allowed, "{x}: {depth} {}", profile(x));
        }
    }
    // Interpolated far rows are the rows themselves.
    let [few, many] =
        [64, 1 << 16].map(|points| table.depths(1.0 / f64::from(points), points as usize + 1).unwrap());
    for (place, one) in few.iter().enumerate() {
        let other = many[place << 10];
        assert!((one - other).abs() <= 1e-12 * other, "{place}: {one} {other}");
    }
    assert_eq!(table.falls_from(1.0), None);
    let waves = rows(1.0, |r| r * r + 0.05 * (1.0 - (40.0 * r).cos()));
    assert!(FormTable::new(waves.0, &waves.1).falls_from(1.0).is_some());
}

/// A table loaded for a line becomes its gaps; a sphere is one to rounding.
#[test]
fn a_table_without_a_file_or_too_short_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let write = |text: &str| std::fs::write(folder.path().join("tip.csv"), text).unwrap();
    let run = |form: &str| {
        let mut simulation = Simulation::new(folder.path().to_owned());
        let outcome = simulation.run(scene(form, 1e-4).scene(), &|| false, &mut |_, _, _| Ok(()));
        match outcome {
            Err(RunError::Surface(SurfaceError::File { reason, .. })) => reason,
            other => panic!("{other:?}"),
        }
    };
    let form = "Table(file: \"tip.csv\")";
    assert!(run(form).contains("tip.csv") || !run(form).is_empty());
    for (text, said) in [
        ("1e-6 0\n2e-6 1e-9", "point 1: r = 1e-6 m; allowed: r = 0, the axis of the body, in the first row"),
        ("0 0\n2e-6 1e-9\n1e-6 2e-9", "line 3: x = 1e-6 after 2e-6; allowed: ascending positions, as before"),
        ("0 0", "1 points; allowed: from 2 to "),
        ("0 0\n1e-6 NaN\n2e-6 1e-9", "point 2: the depth is missing; allowed: a number in each row"),
        ("0 0\n1e-6 what\n2e-6 1e-9", "line 2: \"what\"; allowed: a number"),
        ("0 0\n1e-6 1e-9\n2e-6 4e-9", "the table ends at r = 2e-6 m; allowed: length at most 4e-6 m"),
    ] {
        write(text);
        assert!(run(form).contains(said), "{text}: {}", run(form));
    }
    let sphere = Form::Paraboloid { radius: 1.0 };
    assert!(sphere.load(Path::new(""), 1.0).is_ok() && PowerLaw::of(&sphere, 1.0, 1.0).is_some());
    assert!(Line::new(1.0, 9, Some(&sphere), None, 0.0).is_ok());
}
