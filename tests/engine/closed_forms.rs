//! Smooth bodies of revolution against their closed forms, and the order at which they are reached.

use super::numerics::{integral, invert, observed_order};
use super::solvers::adhesive;
use asperity::contact::{Foundation, HessRule, LegRecord, Solver};
use asperity::reference::PowerLaw;
use asperity::scene::{Edges, Form, Move};
use asperity::surface::{Line, power_law_factor};
use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// A smooth body pressed to an indentation and pulled off.
#[derive(Clone, Copy, Debug)]
struct Problem {
    /// `None`: a flat face.
    form: Option<Form>,
    /// Apparent diameter L, m.
    length: f64,
    /// E*, Pa.
    modulus: f64,
    /// γ, J/m².
    work: f64,
    /// Indentation of the turning point, m.
    deepest: f64,
}

/// Known values of a problem in closed form.
struct ClosedForm {
    figures: Vec<Figure>,
    /// F(d) in contact, from the deepest indentation back to `curve_from`.
    force: Box<dyn Fn(f64) -> f64>,
    /// Indentation, m, below which the curve falls so steeply to the last force before separation that only its end,
    /// one of the figures, has a meaningful error.
    curve_from: f64,
}

/// One number of a loop: its function of the loading and the unloading leg, its expected value, and the unit of its
/// error.
struct Figure {
    name: &'static str,
    read: fn(&[LegRecord; 2]) -> f64,
    expected: f64,
    unit: f64,
}

impl Figure {
    fn new(name: &'static str, read: fn(&[LegRecord; 2]) -> f64, expected: f64, unit: f64) -> Self {
        Figure { name, read, expected, unit: unit.abs() }
    }
}

fn pull_off_force([_, unloading]: &[LegRecord; 2]) -> f64 {
    unloading.smallest.force
}

fn pull_off_indentation([_, unloading]: &[LegRecord; 2]) -> f64 {
    unloading.smallest.indentation
}

fn separation_force([_, unloading]: &[LegRecord; 2]) -> f64 {
    unloading.curve[unloading.curve.len() - 2].force
}

fn separation_indentation([_, unloading]: &[LegRecord; 2]) -> f64 {
    unloading.end()
}

fn dissipated_energy([loading, unloading]: &[LegRecord; 2]) -> f64 {
    loading.released_energy + unloading.released_energy
}

/// The loop of a problem on `points` springs: its loading and its unloading leg.
fn closed_loop(problem: &Problem, points: usize) -> [LegRecord; 2] {
    let line = Line::new(problem.length, points, problem.form.as_ref(), None, 0.0).unwrap();
    let foundation = Foundation::endless(line.spacing, problem.modulus);
    let hess = HessRule::new(foundation, problem.work);
    let mut solver = adhesive(&line.gaps, Edges::Grid, hess, foundation, 257);
    let [loading, unloading] =
        [Move::ToIndentation(problem.deepest), Move::ToSeparation].map(|leg| solver.advance(leg).unwrap());
    let separated = unloading.curve.last().unwrap();
    assert_eq!((separated.springs, separated.force), (0, 0.0), "{problem:?} is not separated");
    assert!(loading.largest.springs < points as u64 || problem.form.is_none(), "the line is too short");
    [loading, unloading]
}

/// Largest error of the force over both legs, in units of the largest |F|.
fn curve_error(legs: &[LegRecord; 2], closed: &ClosedForm) -> f64 {
    let points = || {
        let in_contact = legs.iter().flat_map(|leg| &leg.curve).filter(|point| point.springs > 0);
        in_contact.filter(|point| point.indentation >= closed.curve_from)
    };
    assert!(points().count() > 300, "too few points of the curve are compared");
    let expected = |indentation| (closed.force)(indentation);
    let largest = points().map(|point| expected(point.indentation).abs()).fold(0.0, f64::max);
    let error = |force: f64, indentation| (force - expected(indentation)).abs() / largest;
    points().map(|point| error(point.force, point.indentation)).fold(0.0, f64::max)
}

/// Errors of all figures, and of the curve, on `points` springs.
fn errors(problem: &Problem, closed: &ClosedForm, points: usize) -> Vec<(&'static str, f64)> {
    let legs = closed_loop(problem, points);
    let error = |figure: &Figure| ((figure.read)(&legs) - figure.expected).abs() / figure.unit;
    let figures = closed.figures.iter().map(|figure| (figure.name, error(figure)));
    figures.chain([("curve", curve_error(&legs, closed))]).collect()
}

/// Demand on the error of a figure.
#[derive(Clone)]
enum Demand {
    /// Within this on every grid.
    Within(f64),
    /// Decreasing with the number of springs: slope of ln(error) over −ln(N) by least squares, and the error on the
    /// finest grid.
    Order(RangeInclusive<f64>, f64),
}

/// The cost of counting whole springs. The largest errors are those of small losses: throughout, growth takes the
/// length before, detachment the length after.
const FIRST_ORDER: Demand = Demand::Order(0.8..=1.3, 2e-3);

const ROUNDING: Demand = Demand::Within(2e-15);

/// Computes a problem on all grids and checks the errors of each figure and of the curve.
fn judge(name: &str, problem: &Problem, closed: &ClosedForm, grids: &[usize], demand: &Demand) {
    let errors: Vec<_> = grids.iter().map(|&points| errors(problem, closed, points)).collect();
    for (index, &(what, coarse)) in errors[0].iter().enumerate() {
        let series: Vec<f64> = errors.iter().map(|errors| errors[index].1).collect();
        let fine = series[series.len() - 1];
        match demand {
            Demand::Within(most) => {
                let worst = series.iter().copied().fold(0.0, f64::max);
                println!("{name}: {what}: error at most {worst:.1e}");
                assert!(worst <= *most, "{name}: error {worst:e} of the {what}, allowed {most:e}");
            }
            Demand::Order(orders, most) => {
                let order = observed_order(grids, &series);
                println!("{name}: {what}: error {coarse:.1e} falls to {fine:.1e}, order {order:.2}");
                assert!(orders.contains(&order), "{name}: order {order} of the {what}, errors {series:?}");
                assert!(fine <= *most, "{name}: error {fine:e} of the {what}, allowed {most:e}");
            }
        }
    }
}

/// Five grids for each factor of ten, odd and without a pattern that a form shares: 301 to 300 001.
fn grids() -> Vec<usize> {
    (0..16).map(|k| (300.0 * 10_f64.powf(f64::from(k) / 5.0)) as usize | 1).collect()
}

/// The figures of a body in contact on one stable branch, of which F(a), d(a) and dd/da are known.
///
/// Above d = 0 the way in and the way back are the same; below, only the way back is in contact, down to a zero of
/// dd/da. The dissipated energy is −∫F dd over that part.
struct Branch {
    force: fn(&PowerLaw, f64) -> f64,
    indentation: fn(&PowerLaw, f64) -> f64,
    slope: fn(&PowerLaw, f64) -> f64,
    body: PowerLaw,
    /// Contact radius, m, and force, N, where dF/da = 0.
    pull_off: (f64, f64),
    /// Contact radius, m, and force, N, where dd/da = 0.
    separation: (f64, f64),
}

impl Branch {
    fn closed_form(self) -> ClosedForm {
        let Branch { force, indentation, slope, body, pull_off, separation } = self;
        let radius =
            move |d| invert(|a| indentation(&body, a), d, separation.0, 1e3 * separation.0.max(pull_off.0));
        let lost = -integral(|a| force(&body, a) * slope(&body, a), separation.0, radius(0.0));
        let (turns_at, separates_at) = (indentation(&body, pull_off.0), indentation(&body, separation.0));
        ClosedForm {
            figures: vec![
                Figure::new("smallest force", pull_off_force, pull_off.1, pull_off.1),
                Figure::new("indentation there", pull_off_indentation, turns_at, separates_at),
                Figure::new("last force", separation_force, separation.1, separation.1),
                Figure::new("indentation there", separation_indentation, separates_at, separates_at),
                Figure::new("energy lost", dissipated_energy, lost, lost),
            ],
            force: Box::new(move |d| force(&body, radius(d))),
            curve_from: turns_at,
        }
    }
}

/// The closed form of a power law by the library's own formulas.
fn power_law(body: PowerLaw) -> ClosedForm {
    let branch = Branch {
        force: PowerLaw::force,
        indentation: PowerLaw::indentation,
        slope: |body, a| {
            let n = body.exponent;
            let stretch = (2.0 * PI * a * body.work_of_adhesion / body.effective_modulus).sqrt();
            n * body.line_coefficient * a.powf(n - 1.0) - stretch / (2.0 * a)
        },
        body,
        pull_off: body.force_controlled_pull_off(),
        separation: body.displacement_controlled_pull_off(),
    };
    branch.closed_form()
}

/// JKR for γ = E* = R = 1, by the formulas of Johnson, Kendall and Roberts.
fn unit_sphere() -> (Problem, ClosedForm) {
    let form = Form::Paraboloid { radius: 1.0 };
    let branch = Branch {
        force: |_, a| 4.0 / 3.0 * a.powi(3) - (8.0 * PI * a.powi(3)).sqrt(),
        indentation: |_, a| a * a - (2.0 * PI * a).sqrt(),
        slope: |_, a| 2.0 * a - (PI / (2.0 * a)).sqrt(),
        // Not used: the formulas have no parameter.
        body: PowerLaw::of(&form, 1.0, 1.0).unwrap(),
        pull_off: ((9.0 * PI / 8.0).cbrt(), -1.5 * PI),
        separation: ((PI / 8.0).cbrt(), -5.0 / 6.0 * PI),
    };
    let problem = Problem { form: Some(form), length: 12.0, modulus: 1.0, work: 1.0, deepest: 1.5 };
    (problem, branch.closed_form())
}

#[test]
fn a_paraboloid_converges_to_johnson_kendall_and_roberts() {
    let (problem, closed) = unit_sphere();
    judge("sphere", &problem, &closed, &grids(), &FIRST_ORDER);
}

#[test]
fn the_error_of_the_spheres_smallest_force_is_as_documented() {
    let (problem, closed) = unit_sphere();
    for (points, expected) in [(100, 0.11), (300, 0.04), (1000, 0.011), (3000, 0.004)] {
        let (_, error) = errors(&problem, &closed, points)[0];
        println!("N = {points}: {error:.2e}");
        assert!((error / expected - 1.0).abs() < 0.15, "N = {points}: {error}, expected {expected}");
    }
}

#[test]
fn a_sphere_in_other_units_is_the_same() {
    // R = 0.2 mm, E* = 2 MPa, γ = 0.05 J/m²: the plain constants again, 3/2 and 5/6.
    let (radius, modulus, work) = (2.0e-4, 2.0e6, 0.05);
    let form = Form::Paraboloid { radius };
    let body = PowerLaw::of(&form, modulus, work).unwrap();
    let mut closed = power_law(body);
    let scale = PI * work * radius;
    closed.figures.push(Figure::new("smallest force", pull_off_force, -1.5 * scale, scale));
    closed.figures.push(Figure::new("last force", separation_force, -5.0 / 6.0 * scale, scale));
    let problem = Problem { form: Some(form), length: 1.0e-4, modulus, work, deepest: 4.0e-6 };
    judge("rubber sphere", &problem, &closed, &grids(), &FIRST_ORDER);
}

#[test]
fn power_laws_converge_to_their_closed_forms() {
    for (name, form, length, deepest) in [
        ("cone", Form::Cone { angle: 1.0 }, 16.0, 4.0),
        ("n = 1.5", Form::Power { coefficient: 0.5, exponent: 1.5 }, 12.0, 1.0),
        ("n = 3", Form::Power { coefficient: 0.3, exponent: 3.0 }, 8.0, 1.0),
        ("n = 7", Form::Power { coefficient: 0.3, exponent: 7.0 }, 8.0, 1.0),
    ] {
        let (modulus, work) = (2.0, 1.5);
        let problem = Problem { form: Some(form), length, modulus, work, deepest };
        let closed = power_law(PowerLaw::of(&form, modulus, work).unwrap());
        judge(name, &problem, &closed, &grids(), &FIRST_ORDER);
    }
}

/// Kendall's flat punch of diameter 2a: either all of it is in contact or none.
fn flat(diameter: f64, modulus: f64, work: f64) -> ClosedForm {
    let radius = 0.5 * diameter;
    let stretch = (2.0 * PI * radius * work / modulus).sqrt();
    let force = -(8.0 * PI * radius.powi(3) * modulus * work).sqrt();
    // The elastic energy ½ F Δl at detachment: twice the energy of the interface, πa²γ.
    let lost = 2.0 * PI * radius * radius * work;
    ClosedForm {
        figures: vec![
            Figure::new("smallest force", pull_off_force, force, force),
            Figure::new("indentation there", pull_off_indentation, -stretch, stretch),
            Figure::new("last force", separation_force, force, force),
            Figure::new("indentation there", separation_indentation, -stretch, stretch),
            Figure::new("energy lost", dissipated_energy, lost, lost),
        ],
        force: Box::new(move |d| 2.0 * radius * modulus * d),
        curve_from: f64::NEG_INFINITY,
    }
}

#[test]
fn a_punch_of_whole_cells_is_kendalls_to_rounding() {
    // Its edges lie between springs: for N = 16, 48 … on one foundation, 9, 27 … on the other.
    for (radius, grids) in
        [(1.0 / 8.0, [16, 48, 160, 1_600, 160_000]), (7.0 / 18.0, [9, 27, 99, 9_009, 90_009])]
    {
        let (modulus, work) = (3.0, 0.7);
        let problem =
            Problem { form: Some(Form::Punch { radius }), length: 1.0, modulus, work, deepest: 0.3 };
        judge("punch", &problem, &flat(2.0 * radius, modulus, work), &grids, &ROUNDING);
    }
}

#[test]
fn a_flat_face_is_eq_14_to_rounding() {
    let (length, modulus, work) = (1.0e-4, 2.0e6, 0.05);
    let problem = Problem { form: None, length, modulus, work, deepest: 1.0e-6 };
    let mut closed = flat(length, modulus, work);
    let ideal = -(PI * work * modulus * length.powi(3)).sqrt();
    closed.figures.push(Figure::new("eq. (14)", pull_off_force, ideal, ideal));
    judge("flat face", &problem, &closed, &[1, 2, 3, 10, 1_001, 100_000], &ROUNDING);
}

#[test]
fn any_other_punch_is_out_by_less_than_a_cell_at_each_edge() {
    let (radius, modulus, work) = (0.123_456_789, 3.0, 0.7);
    let problem = Problem { form: Some(Form::Punch { radius }), length: 1.0, modulus, work, deepest: 0.3 };
    let closed = flat(2.0 * radius, modulus, work);
    for points in grids() {
        let cells = 2.0 * radius * points as f64;
        // F ∝ n^(3/2), and no other figure grows faster than n².
        for (what, error) in errors(&problem, &closed, points) {
            assert!(error <= 2.2 / cells, "{what} at {points} points: {error:e}");
        }
    }
}

#[test]
fn hertz_without_adhesion() {
    for (name, form, length) in [
        ("sphere", Form::Paraboloid { radius: 2.0 }, 8.0),
        ("cone", Form::Cone { angle: 0.4 }, 8.0),
        ("n = 1.5", Form::Power { coefficient: 0.4, exponent: 1.5 }, 8.0),
        ("n = 3", Form::Power { coefficient: 0.3, exponent: 3.0 }, 8.0),
    ] {
        let (n, c) = match form {
            Form::Paraboloid { radius } => (2.0, 1.0 / radius),
            Form::Cone { angle } => (1.0, PI / 2.0 * angle.tan()),
            Form::Power { coefficient, exponent } => (exponent, power_law_factor(exponent) * coefficient),
            Form::WavySphere { .. } | Form::Punch { .. } => unreachable!(),
        };
        let modulus = 5.0;
        let closed = ClosedForm {
            figures: Vec::new(),
            // With a = (d/c)^(1/n): F = 2E* n/(n+1) d a.
            force: Box::new(move |d: f64| 2.0 * modulus * n / (n + 1.0) * d * (d / c).powf(n.recip())),
            curve_from: 0.0,
        };
        let problem = Problem { form: Some(form), length, modulus, work: 0.0, deepest: 1.0 };
        let grids = grids();
        let series: Vec<f64> = grids
            .iter()
            .map(|&points| {
                let legs = closed_loop(&problem, points);
                assert_eq!(dissipated_energy(&legs), 0.0);
                assert_eq!((pull_off_force(&legs), pull_off_indentation(&legs)), (0.0, 0.0));
                curve_error(&legs, &closed)
            })
            .collect();
        // Springs at the edge carry next to nothing: whole springs cost no order here.
        let order = observed_order(&grids, &series);
        println!("{name}: curve: error {:.1e} falls to {:.1e}, order {order:.2}", series[0], series[15]);
        assert!((1.7..=2.3).contains(&order), "{name}: order {order}, errors {series:?}");
    }
}
