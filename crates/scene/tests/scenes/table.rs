//! Forms from a table of rows against the forms that they were computed from.

use asperity_scene::theory::closed_form;
use asperity_scene::{Document, Outcome, RunError, Simulation};
use asperity_surface::lines::Line;
use asperity_surface::{Form, FormTable};
use dashu_float::{FBig, round::mode::HalfEven};
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
        "(version: 1, material: (modulus: 1.0e6), length: {length:e}, form: {form}, adhesion: (work: 0.05), \
         loading: [ToForce(5.0e-5), ToSeparation], numerics: (points: 2001, samples: 65))"
    );
    Document::parse(&text, "test").unwrap()
}

fn text((radii, depths): &(Vec<f64>, Vec<f64>)) -> String {
    let mut text = "r [µm], f [nm]\n".to_owned();
    radii
        .iter()
        .zip(depths)
        .for_each(|(r, f)| writeln!(text, "{:e}, {:e}", r * 1e6, f * 1e9).unwrap());
    text
}

/// Force curve, pull-off force and F_smooth of a table within 1e-6 of those of its closed form.
#[test]
fn a_thousand_rows_are_their_closed_form() {
    let folder = tempfile::tempdir().unwrap();
    let reach = 5e-5;
    type Depth = Box<dyn Fn(f64) -> f64>;
    let forms: [(&str, Depth); 6] = [
        (
            "RoundedCone(radius: 2e-5, angle: 0.2)",
            Box::new(|r| {
                let edge = 2e-5 * 0.2_f64.tan();
                if r <= edge {
                    r * r / 4e-5
                } else {
                    (r - 0.5 * edge) * 0.2_f64.tan()
                }
            }),
        ),
        ("Paraboloid(radius: 1e-4)", Box::new(|r| r * r / 2e-4)),
        ("Cone(angle: 0.2)", Box::new(|r| r * 0.2_f64.tan())),
        (
            "Power(coefficient: 1e8, exponent: 3.0)",
            Box::new(|r| 1e8 * r.powi(3)),
        ),
        (
            "Power(coefficient: 50.0, exponent: 1.5)",
            Box::new(|r| 50.0 * r.powf(1.5)),
        ),
        (
            "WavySphere(radius: 1e-4, amplitude: 2e-8, wavelength: 1e-5)",
            Box::new(|r| r * r / 2e-4 + 2e-8 * (1.0 - (std::f64::consts::TAU * r / 1e-5).cos())),
        ),
    ];
    for (form, depth) in forms {
        std::fs::write(folder.path().join("tip.csv"), text(&rows(reach, depth))).unwrap();
        let run = |form: &str| {
            let mut simulation = Simulation::new(folder.path().to_owned());
            simulation
                .compute(scene(form, 2.0 * reach).scene())
                .unwrap()
        };
        let [exact, table] = [form, "Table(file: \"tip.csv\")"].map(run);
        let pull_off = |outcome: &Outcome| outcome.figures.pull_off_force.unwrap();
        let share = pull_off(&table) / pull_off(&exact);
        assert!((share - 1.0).abs() < 1e-6, "{form}: pull-off {share}");
        for (one, other) in exact.history.stages.iter().zip(&table.history.stages) {
            for (one, other) in one.curve.iter().zip(&other.curve) {
                // Ends and extremes have indentations of their own.
                let same = (one.indentation - other.indentation).abs() < 1e-9 * 1e-6;
                let error = (one.force - other.force).abs() / pull_off(&exact);
                assert!(!same || error < 1e-6, "{form}: {one:?} {other:?}");
            }
        }
        if !form.starts_with("Wavy") {
            let smooth =
                table.smooth_pull_off_force.unwrap() / exact.smooth_pull_off_force.unwrap();
            assert!((smooth - 1.0).abs() < 1e-4, "{form}: F_smooth {smooth}");
        }
        let number = [&exact, &table].map(|outcome| outcome.tabor_number);
        match (number, form.starts_with("Power")) {
            ([Some(one), Some(other)], _) => {
                assert!((other / one - 1.0).abs() < 1e-2, "{form}: {number:?}")
            }
            ([one, other], is_power) => assert!(one == other || is_power, "{form}: {number:?}"),
        }
    }
}

/// A table loaded for a line becomes its gaps; a sphere is one to rounding.
#[test]
fn a_table_without_a_file_or_too_short_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let write = |text: &str| std::fs::write(folder.path().join("tip.csv"), text).unwrap();
    let run = |form: &str| {
        let mut simulation = Simulation::new(folder.path().to_owned());
        let outcome = simulation.compute(scene(form, 1e-4).scene());
        match outcome {
            Err(RunError::Surface(error)) if error.field() == Some("form.file") => {
                error.to_string()
            }
            other => panic!("{other:?}"),
        }
    };
    let form = "Table(file: \"tip.csv\")";
    assert!(run(form).contains("tip.csv") || !run(form).is_empty());
    for (text, said) in [
        (
            "1e-6 0\n2e-6 1e-9",
            "point 1: r = 1e-6 m; allowed: r = 0, the axis of the body, in the first row",
        ),
        (
            "0 0\n2e-6 1e-9\n1e-6 2e-9",
            "line 3: x = 1e-6 after 2e-6; allowed: ascending positions, as before",
        ),
        ("0 0", "1 points; allowed: from 2 to "),
        (
            "0 0\n1e-6 1e-9\n1.0000000000001e-6 1.0000001e-9\n6e-5 2e-9",
            "point 3: r = 1.0000000000001e-6 m after 1e-6 m; allowed: ",
        ),
        (
            "0 0\n1e-6 NaN\n2e-6 1e-9",
            "point 2: the depth is missing; allowed: a number in each row",
        ),
        (
            "0 NaN\n1e-6 0\n2e-6 1e-9",
            "point 1: the depth is missing; allowed: a number in each row",
        ),
        (
            "0 0\n1e-6 1e-9\n2e-6 NaN",
            "point 3: the depth is missing; allowed: a number in each row",
        ),
        (
            "0 0\n1e-6 what\n2e-6 1e-9",
            "line 2: \"what\"; allowed: a number",
        ),
        (
            "0 0\n1e-6 1e-9\n2e-6 4e-9",
            "the table ends at r = 2e-6 m; allowed: length at most 4e-6 m",
        ),
    ] {
        write(text);
        assert!(run(form).contains(said), "{text}: {}", run(form));
    }
    let sphere = Form::Paraboloid { radius: 1.0 };
    assert!(sphere.load(Path::new(""), 1.0).is_ok() && closed_form(&sphere, 1.0, 1.0).is_some());
    assert!(Line::new(1.0, 9, Some(&sphere), None, 0.0).is_ok());
}

/// A binary number of 50 digits.
type Precise = FBig<HalfEven, 2>;

fn precise(value: f64) -> Precise {
    Precise::try_from(value)
        .unwrap()
        .with_precision(170)
        .value()
}

/// Nodes and weights of Gauss-Legendre quadrature in (−1, 1).
fn quadrature(count: usize) -> Vec<(Precise, Precise)> {
    let one = precise(1.0);
    let node = |index: usize| {
        let mut x =
            precise((std::f64::consts::PI * (index as f64 + 0.75) / (count as f64 + 0.5)).cos());
        let mut slope = one.clone();
        for _ in 0..6 {
            let (mut before, mut value) = (one.clone(), x.clone());
            for k in 2..=count {
                let next = (precise(2.0 * k as f64 - 1.0) * &x * &value
                    - precise(k as f64 - 1.0) * &before)
                    / precise(k as f64);
                (before, value) = (value, next);
            }
            slope = precise(count as f64) * (&x * &value - &before) / (&x * &x - &one);
            x = &x - &value / &slope;
        }
        (
            x.clone(),
            precise(2.0) / ((&one - &x * &x) * &slope * &slope),
        )
    };
    (0..count).map(node).collect()
}

/// Depth g at x of the interpolant as docs/scene-file.md states it, by quadrature.
///
/// With r = 2tx/(1 + t²) the integral is that of 2 x f′(r)/(1 + t²) over t, without a root.
fn stated_depth(radii: &[f64], depths: &[f64], x: f64, rule: &[(Precise, Precise)]) -> f64 {
    let (one, two, at) = (precise(1.0), precise(2.0), precise(x));
    let width = |gap: usize| precise(radii[gap + 1]) - precise(radii[gap]);
    let secants: Vec<Precise> = (0..radii.len() - 1)
        .map(|gap| (precise(depths[gap + 1]) - precise(depths[gap])) / width(gap))
        .collect();
    let magnitude = |value: Precise| if value < Precise::ZERO { -value } else { value };
    let slope = |row: usize| {
        let last = secants.len() - 1;
        let (one, other) = match row {
            0 => (0, 1.min(last)),
            row if row > last => (last.saturating_sub(1), last),
            row => (row - 1, row),
        };
        let middle = |gap: usize| (precise(radii[gap]) + precise(radii[gap + 1])) / precise(2.0);
        let parabola = if one == other {
            secants[one].clone()
        } else {
            &secants[one]
                + (&secants[other] - &secants[one]) / (middle(other) - middle(one))
                    * (precise(radii[row]) - middle(one))
        };
        let beside = [&secants[row.saturating_sub(1)], &secants[row.min(last)]];
        if beside
            .iter()
            .any(|secant| *secant * &parabola <= Precise::ZERO)
        {
            return Precise::ZERO;
        }
        let most = precise(3.0)
            * beside
                .map(|secant| magnitude(secant.clone()))
                .into_iter()
                .reduce(|a, b| if b < a { b } else { a })
                .unwrap();
        if magnitude(parabola.clone()) <= most {
            parabola
        } else if parabola > Precise::ZERO {
            most
        } else {
            -most
        }
    };
    let tangent = |r: &Precise| r / (&at + (&at * &at - r * r).sqrt());
    let mut sum = Precise::ZERO;
    for gap in 0..secants.len() {
        let (from, is_last) = (
            precise(radii[gap]),
            gap + 1 == secants.len() || radii[gap + 1] >= x,
        );
        if radii[gap] >= x {
            break;
        }
        let to = if is_last {
            at.clone()
        } else {
            precise(radii[gap + 1])
        };
        let (width, [low, high]) = (width(gap), [slope(gap), slope(gap + 1)]);
        let bend =
            (precise(6.0) * &secants[gap] - precise(4.0) * &low - precise(2.0) * &high) / &width;
        let twist = precise(3.0) * (&low + &high - precise(2.0) * &secants[gap]) / &width / &width;
        let [start, end] = [&from, &to].map(tangent);
        let half = (&end - &start) / &two;
        for (node, weight) in rule {
            let t = (&start + &end) / &two + node * &half;
            let share = &one + &t * &t;
            let beyond = &two * &t * &at / &share - &from;
            sum += weight * &half * &two / share * (&low + (&bend + &twist * &beyond) * &beyond);
        }
    }
    (sum * at).to_f64().value()
}

/// Tables with corners, walls, plateaus, noise, edges and rows close together, and those of smooth
/// bodies.
fn nasty_tables() -> Vec<(Vec<f64>, Vec<f64>)> {
    let even = |count: usize| (0..count).map(move |row| row as f64 / (count - 1) as f64);
    let of = |radii: Vec<f64>, depth: &dyn Fn(f64) -> f64| {
        let depths = radii.iter().map(|&r| depth(r)).collect();
        (radii, depths)
    };
    let flat_end = |r: f64| if r <= 0.2 { 0.0 } else { 0.3 * (r - 0.2) };
    let beside = |close: f64| {
        let mut radii: Vec<f64> = even(21).collect();
        radii.extend([0.2 - close, 0.2 + close]);
        radii.sort_by(f64::total_cmp);
        radii
    };
    let wall = |close: f64| {
        (
            vec![0.0, 0.2, 0.2 + close, 0.5, 1.0],
            vec![0.0, 0.0, 0.05, 0.06, 0.07],
        )
    };
    let mut noise = 1_u64;
    let mut random = move || {
        noise = noise
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (noise >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut tables: Vec<_> = [1e-2, 1e-4, 1e-6, 1e-8, 2e-9]
        .map(|close| of(beside(close), &flat_end))
        .into();
    tables.extend([1e-3, 1e-5, 1e-7, 1.1e-9].map(wall));
    tables.extend([0.0, 1e-3, 0.1].map(|size| {
        let radii: Vec<f64> = even(30).collect();
        let depths = radii
            .iter()
            .map(|r| 0.5 * r * r + size * random())
            .collect();
        (radii, depths)
    }));
    tables.extend((0..4).map(|_| {
        let mut radii: Vec<f64> = (0..20)
            .map(|_| random().powi(6))
            .chain([0.0, 1.0])
            .collect();
        radii.sort_by(f64::total_cmp);
        radii.dedup_by(|next, row| *next - *row < 1e-9);
        of(radii, &|r| (1e3 * r).floor() * 1e-3)
    }));
    let saw = |r: f64| r + 0.2 * (10.0 * r).fract();
    tables.extend([
        of(even(64).collect(), &saw),
        of(even(11).collect(), &|r| -0.1 * r * r),
    ]);
    tables.extend([
        (vec![0.0, 1.0], vec![0.0, 0.3]),
        (vec![0.0, 1e-8, 1.0], vec![0.0, 1e-3, 1e-3]),
    ]);
    let squares = || even(40).map(|share| share * share).collect::<Vec<_>>();
    let bodies: [&dyn Fn(f64) -> f64; 10] = [
        &|r| 0.5 * r * r,
        &|r| 0.3 * r,
        &|r| r.powi(3),
        &|r| r.powf(1.5),
        &|r| r.powi(8),
        &|r| 0.5 * r * r + 0.01 * (1.0 - (20.0 * r).cos()),
        &|r| (0.04 + r * r).sqrt() - 0.2,
        &|r| 1.0 - (1.0 - 0.9 * r * r).sqrt(),
        &|r| r * r * (1.0 - 0.5 * r),
        &|_| 0.0,
    ];
    tables.extend(bodies.map(|body| of(squares(), body)));
    tables
}

/// Rows in place of the name of a file give the same body, and are no file of the scene.
#[test]
fn rows_in_place_of_a_name_are_those_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let table = rows(3e-5, |r| r * r / 2e-5);
    let mut in_place = Vec::new();
    let mut file = String::new();
    for (radius, depth) in table.0.iter().zip(&table.1) {
        in_place.push(format!("{radius:e} {depth:e}"));
        writeln!(file, "{radius:e} {depth:e}").unwrap();
    }
    std::fs::write(folder.path().join("tip.txt"), file).unwrap();
    let line = |form: &str| {
        let scene = scene(form, 5e-5);
        let mut simulation = Simulation::new(folder.path().to_owned());
        let (line, _, _) = simulation.make_line(scene.scene()).unwrap();
        line.gaps.clone()
    };
    let form = format!(
        "Table(file: \"{}{}\")",
        Form::ROWS_IN_PLACE,
        in_place.join(";")
    );
    assert_eq!(line(&form), line("Table(file: \"tip.txt\", unit: \"m\")"));
    assert!(scene(&form, 5e-5).scene().measured_files().is_empty());
    let short = scene("Table(file: \"data:,0 0;1e-6 1e-8\")", 5e-5);
    let error = Simulation::default().make_line(short.scene()).unwrap_err();
    assert!(
        error.to_string().contains("the table ends at r = 1e-6 m"),
        "{error}"
    );
}

/// Depths are those of the stated interpolant, to rounding; between two rows it stays between their
/// depths, so that no depth leaves what the rows allow.
#[test]
fn tables_of_any_kind_have_the_profile_of_their_interpolant() {
    let rule = quadrature(16);
    let tables = nasty_tables();
    assert_eq!(tables.len(), 30);
    for (number, (radii, depths)) in tables.iter().enumerate() {
        let table = FormTable::new(radii.clone(), depths).unwrap();
        let count = 1 << 12;
        let found = table
            .depths(1.0 / f64::from(count), count as usize + 1)
            .unwrap();
        let largest = found
            .iter()
            .fold(0.0_f64, |most, depth| most.max(depth.abs()));
        for place in [37, 819, 820, 821, 2000, count] {
            let expected = stated_depth(radii, depths, f64::from(place) / f64::from(count), &rule);
            let error = (found[place as usize] - expected).abs() / largest.max(1e-300);
            assert!(
                error < 1e-12,
                "table {number} at {place}: {error:e} of {largest}"
            );
        }
    }
    let falls = |depth: &dyn Fn(f64) -> f64| {
        let (radii, depths) = rows(1.0, depth);
        FormTable::new(radii, &depths).unwrap().falls_from(1.0)
    };
    assert_eq!(falls(&|r| r * r), None);
    assert!(falls(&|r| r * r + 0.05 * (1.0 - (40.0 * r).cos())).is_some());
}

/// A punch with an edge in few rows, and rows far closer than its springs beside the corner of a
/// flat end.
#[test]
fn tips_with_edges_have_their_own_forces() {
    let folder = tempfile::tempdir().unwrap();
    let run = |rows: &str, force: f64| {
        std::fs::write(folder.path().join("tip.csv"), rows).unwrap();
        let document = scene("Table(file: \"tip.csv\")", 1e-4);
        let document = document
            .set("loading", &format!("[ToForce({force:e}), ToSeparation]"))
            .unwrap();
        let mut simulation = Simulation::new(folder.path().to_owned());
        simulation.compute(document.scene()).unwrap()
    };
    let punch = run("0,0\n2e-5,0\n2.0001e-5,5e-6\n5.1e-5,6e-6\n", 1e-3);
    // Kendall: √(8πa³E*γ); the edge of 2001 springs is known to a spring.
    let kendall = (8.0 * std::f64::consts::PI * 2e-5_f64.powi(3) * 1e6 * 0.05).sqrt();
    let share = punch.figures.pull_off_force.unwrap() / kendall;
    assert!((share - 1.0).abs() < 5e-3, "{share}");
    // Beyond the edge the profile is b h/√(x² − b²) deep, nowhere above the end.
    assert!(
        punch.line.summit == 0.0 && punch.line.deepest < 1e-4,
        "{:?}",
        punch.line
    );
    // A flat end of 10 µm goes over into a cone; rows 1 pm beside the corner.
    let corner = |close: f64| {
        let mut rows: Vec<f64> = (0..=200)
            .map(|row| 5e-5 * f64::from(row) / 200.0)
            .chain([1e-5 - close, 1e-5 + close])
            .collect();
        rows.sort_by(f64::total_cmp);
        let line = |r: &f64| format!("{r:e},{:e}\n", 0.3 * (r - 1e-5).max(0.0));
        run(&rows.iter().map(line).collect::<String>(), 1e-4)
    };
    let [close, wide] = [corner(1e-12), corner(1e-8)];
    for outcome in [&close, &wide] {
        // g = 0.3 x arccos(b/x): F_n and pull-off of the closed form, on a fine grid of contact
        // radii.
        let (b, modulus, work) = (1e-5, 1e6, 0.05);
        let profile = |x: f64| {
            if x <= b {
                0.0
            } else {
                0.3 * x * (b / x).acos()
            }
        };
        let (mut area, step) = (0.0, 5e-10);
        let (mut least, mut pressed) = (0.0_f64, 0.0);
        for k in 1..=100_000 {
            let a = f64::from(k) * step;
            area += 0.5 * (profile(a - step) + profile(a)) * step;
            let stretch = (2.0 * std::f64::consts::PI * a * work / modulus).sqrt();
            let force = 2.0 * modulus * (a * (profile(a) - stretch) - area);
            least = least.min(force);
            if force <= 1e-4 {
                pressed = profile(a) - stretch;
            }
        }
        let figures = outcome.figures;
        assert!(
            (figures.pull_off_force.unwrap() / -least - 1.0).abs() < 2e-3,
            "{figures:?} {least}"
        );
        assert!(
            (figures.preload_indentation.unwrap() / pressed - 1.0).abs() < 1e-3,
            "{figures:?} {pressed}"
        );
        assert!((outcome.smooth_pull_off_force.unwrap() / -least - 1.0).abs() < 2e-3);
    }
}
