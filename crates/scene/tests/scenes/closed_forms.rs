//! Smooth bodies against their closed forms, and the order at which they are reached: the first for
//! patches of whole springs, the second for edges between springs.

mod one_piece;
mod waves;

use super::body::{Body, Foundation, end};
use super::numerics::observed_order;
use asperity_contact::{Edges, Move, StageRecord};
use asperity_surface::lines::{Line, Synthesizer};
use asperity_surface::{Form, SelfAffine};
use one_piece::{Loop, OnePiece};

/// A smooth body pressed to an indentation and pulled off.
#[derive(Clone, Debug)]
struct Problem {
    /// `None`: a flat face.
    form: Option<Form>,
    /// Apparent diameter L, m.
    length: f64,
    /// E*, Pa.
    modulus: f64,
    /// γ₁ on closing and γ on opening, J/m².
    works: [f64; 2],
    /// Indentation of the turning point, m.
    deepest: f64,
}

const BOTH: [Edges; 2] = [Edges::Grid, Edges::SubCell];

/// Least order of the errors of smooth bodies with edges between springs.
const LEAST_ORDER: f64 = 1.8;

/// Figures of a loop, each with true where its error falls evenly with the number of springs. The
/// force falls so steeply before separation, and changes so little about its minimum, that two of
/// them do not.
const FIGURES: [(&str, bool); 7] = [
    ("smallest force", true),
    ("indentation there", false),
    ("last force", false),
    ("place of separation", true),
    ("energy", true),
    ("curve of loading", true),
    ("curve of unloading", true),
];

impl Problem {
    fn body(&self, edges: Edges, points: usize) -> Body {
        let line = Line::new(self.length, points, self.form.as_ref(), None, 0.0).unwrap();
        let foundation = Foundation::new(line.spacing, self.modulus);
        let [closing_work, work] = self.works;
        Body {
            closing_work,
            ..Body::new(line.gaps.to_vec(), edges, foundation, work)
        }
    }

    /// Its loading and its unloading.
    fn stages(&self, edges: Edges, points: usize) -> [StageRecord; 2] {
        let targets = [Move::ToIndentation(self.deepest), Move::ToSeparation];
        let stages = self.body(edges, points).history(&targets, 257).stages;
        let separated = end(&stages[1]);
        assert_eq!(
            (separated.springs, separated.force),
            (0, 0.0),
            "{self:?} is not separated"
        );
        assert!(
            stages[0].largest.springs < points as u64 || self.form.is_none(),
            "the line is too short"
        );
        stages.try_into().unwrap()
    }

    fn closed_form(&self) -> Loop {
        let [closing, opening] = self.works;
        let body = OnePiece::new(
            self.form.clone().unwrap(),
            self.modulus,
            opening,
            0.5 * self.length,
        );
        Loop::new(body, closing, self.deepest)
    }

    /// Relative errors of all figures; those of the curves over the largest force.
    fn errors(&self, exact: &Loop, edges: Edges, points: usize) -> [f64; 7] {
        let [loading, unloading] = self.stages(edges, points);
        let [pull_off, separation] = [exact.pull_off(), exact.separation()];
        let scale = exact.loading_force(self.deepest).abs().max(-pull_off.1);
        let curve = |stage: &StageRecord, from: f64, force: &dyn Fn(f64) -> f64| {
            let points = stage
                .curve
                .iter()
                .filter(|point| point.springs > 0 && point.indentation >= from);
            let errors: Vec<f64> = points
                .map(|point| (point.force - force(point.indentation)).abs() / scale)
                .collect();
            assert!(
                errors.len() > 20,
                "too few points of the curve are compared"
            );
            errors.into_iter().fold(0.0, f64::max)
        };
        let last = unloading.curve[unloading.curve.len() - 2];
        let energy = loading.released_energy + unloading.released_energy;
        [
            (unloading.smallest.force / pull_off.1 - 1.0).abs(),
            ((unloading.smallest.indentation - pull_off.0) / separation.0).abs(),
            (last.force / separation.1 - 1.0).abs(),
            (unloading.end() / separation.0 - 1.0).abs(),
            (energy / exact.dissipated_energy() - 1.0).abs(),
            curve(&loading, 0.0, &|d| exact.loading_force(d)),
            curve(&unloading, pull_off.0, &|d| exact.unloading_force(d)),
        ]
    }
}

/// Numbers of springs without a pattern that a form shares.
fn grids(edges: Edges, odd: bool) -> Vec<usize> {
    let (first, per_decade, count) = if edges == Edges::Grid {
        (300.0, 5.0, 11)
    } else {
        (100.0, 3.0, 7)
    };
    let points = |k: u32| (first * 10_f64.powf(f64::from(k) / per_decade)) as usize;
    (0..count)
        .map(|k| points(k) & !1 | usize::from(odd))
        .collect()
}

/// Computes errors on all grids, and checks the order and the last error of each figure whose error
/// falls evenly. For edges between springs the order is at least `least_order`.
fn judge<const N: usize>(
    name: &str,
    edges: Edges,
    least_order: f64,
    figures: [(&str, bool); N],
    errors: impl Fn(usize) -> [f64; N],
) {
    for odd in [true, false] {
        let grids = grids(edges, odd);
        // An error between springs depends on the position of an edge in its cell: the worst of
        // some grids of about as many springs.
        let near = |points: usize| {
            (0..if edges == Edges::Grid { 1 } else { 4 })
                .map(move |k| points + 2 * (k * points / 100))
        };
        let worse = |one: [f64; N], other: [f64; N]| {
            std::array::from_fn(|index| one[index].max(other[index]))
        };
        let worst = |&points: &usize| near(points).map(&errors).fold([0.0; N], worse);
        let errors: Vec<_> = grids.iter().map(worst).collect();
        let steps: Vec<f64> = grids.iter().map(|&points| 1.0 / points as f64).collect();
        for (index, (what, even)) in figures.into_iter().enumerate() {
            let errors: Vec<f64> = errors.iter().map(|errors| errors[index]).collect();
            let (coarse, fine, order) = (
                errors[0],
                errors[errors.len() - 1],
                observed_order(&steps, &errors),
            );
            let parity = if odd { "odd" } else { "even" };
            println!(
                "{name}, {edges:?}, {parity} N: {what}: {coarse:.1e} falls to {fine:.1e}, order {order:.2}"
            );
            let (orders, most) = match edges {
                // The edge of whole springs is off by up to one spacing.
                Edges::Grid if even => (0.8..=2.2, 2e-2),
                Edges::Grid => (f64::NEG_INFINITY..=f64::INFINITY, 2e-2),
                Edges::SubCell if even => (least_order..=f64::INFINITY, 1e-5),
                Edges::SubCell => continue,
            };
            assert!(
                orders.contains(&order) && fine <= most,
                "{name}, {edges:?}: {what}: order {order}, {errors:?}"
            );
        }
        if edges == Edges::Grid {
            return;
        }
    }
}

/// The edge of one patch grows and recedes along the same curve: a minor loop in contact loses
/// nothing. Whole springs attach and detach at indentations that differ by as much as the rule of
/// Hess for one spring more: a loss of the first order.
#[test]
fn a_minor_loop_in_contact_loses_energy_only_with_whole_springs() {
    let sphere = Problem {
        form: Some(Form::Paraboloid { radius: 1.0 }),
        length: 12.0,
        modulus: 1.0,
        works: [1.0; 2],
        deepest: 1.5,
    };
    let share = |edges: Edges, points: usize| {
        let loading = [1.5, 0.15, 1.5]
            .map(Move::ToIndentation)
            .into_iter()
            .chain([Move::ToSeparation]);
        let stages = sphere
            .body(edges, points)
            .history(&loading.collect::<Vec<_>>(), 2)
            .stages;
        let lost: Vec<f64> = stages.iter().map(|stage| stage.released_energy).collect();
        (lost[1] + lost[2]) / lost.iter().sum::<f64>()
    };
    assert_eq!(
        [128, 1024].map(|points| share(Edges::SubCell, points)),
        [0.0; 2]
    );
    let whole = [512, 2048, 8192].map(|points| share(Edges::Grid, points));
    let is_first_order = |pair: &[f64]| (3.0..5.0).contains(&(pair[0] / pair[1]));
    assert!(
        whole[0] > 1e-3 && whole.windows(2).all(is_first_order),
        "{whole:?}"
    );
}

#[test]
fn smooth_bodies_converge_to_their_closed_forms() {
    let sphere = || Form::Paraboloid { radius: 1.0 };
    let power = |coefficient, exponent| Form::Power {
        coefficient,
        exponent,
    };
    let apex = |radius| Form::RoundedCone { radius, angle: 1.2 };
    for (name, form, length, modulus, works, deepest) in [
        ("sphere", sphere(), 12.0, 1.0, [1.0; 2], 1.5),
        (
            "rubber sphere",
            Form::Paraboloid { radius: 2.0e-4 },
            1.0e-4,
            2.0e6,
            [0.05; 2],
            4.0e-6,
        ),
        ("sphere, γ₁ = 0", sphere(), 12.0, 1.0, [0.0, 1.0], 4.0),
        ("sphere, γ₁ = γ/4", sphere(), 12.0, 1.0, [0.25, 1.0], 4.0),
        ("sphere, γ₁ = 0.9 γ", sphere(), 12.0, 1.0, [0.9, 1.0], 4.0),
        // Pull-off on the flank, near the edge of the apex, and inside the apex.
        ("apex 0.6", apex(0.6), 14.0, 1.0, [1.0; 2], 4.0),
        ("apex 1.5", apex(1.5), 14.0, 1.0, [1.0; 2], 2.0),
        ("apex 6", apex(6.0), 30.0, 1.0, [1.0; 2], 1.5),
        ("n = 1.2", power(0.8, 1.2), 14.0, 1.0, [1.0; 2], 1.5),
        ("n = 1.5", power(0.5, 1.5), 12.0, 2.0, [1.5; 2], 1.0),
        ("n = 3", power(0.3, 3.0), 8.0, 2.0, [1.5; 2], 1.0),
        ("n = 7", power(0.3, 7.0), 8.0, 2.0, [1.5; 2], 1.0),
    ] {
        let problem = Problem {
            form: Some(form),
            length,
            modulus,
            works,
            deepest,
        };
        let exact = problem.closed_form();
        // The curvature of a rounded cone is infinite at the edge of its apex.
        let least_order = match problem.form {
            Some(Form::RoundedCone { .. }) => 1.5,
            _ => LEAST_ORDER,
        };
        for edges in BOTH {
            judge(name, edges, least_order, FIGURES, |points| {
                problem.errors(&exact, edges, points)
            });
        }
    }
}

#[test]
fn a_cone_is_exact_to_rounding_between_springs() {
    let cone = |angle, length, modulus, work, deepest| {
        let form = Some(Form::Cone { angle });
        Problem {
            form,
            length,
            modulus,
            works: [work; 2],
            deepest,
        }
    };
    let problem = cone(1.0, 16.0, 2.0, 1.5, 4.0);
    let exact = problem.closed_form();
    judge("cone", Edges::Grid, LEAST_ORDER, FIGURES, |points| {
        problem.errors(&exact, Edges::Grid, points)
    });
    // With its tip on a spring the line of a cone is the cone itself.
    let problem = cone(1.35, 1.2, 1.0, 1.0, 1.5);
    let exact = problem.closed_form();
    for points in [
        grids(Edges::SubCell, true),
        grids(Edges::SubCell, false),
        vec![4096, 4097],
    ]
    .concat()
    {
        let errors = problem.errors(&exact, Edges::SubCell, points);
        for ((what, exact), error) in FIGURES.into_iter().zip(errors) {
            assert!(
                !exact || error <= if what == "energy" { 5e-12 } else { 1e-13 },
                "{points}: {what}: {error:e}"
            );
        }
    }
}

/// Observed orders of the median errors of pull-off force and dissipated energy of lines with 24
/// modes, over Hurst exponents, κ and ten seeds each, on 2⁷ to 2¹³ springs against 2¹⁵.
#[test]
fn rough_bodies_of_few_modes_converge_with_the_square_of_the_distance_in_the_median() {
    // Form and roughness are aligned as on any other grid, and the tip is on a spring.
    let forms = [
        None,
        Some(Form::Paraboloid { radius: 0.5 }),
        Some(Form::Cone { angle: 0.3 }),
    ];
    let kinds = [0.2, 0.5, 0.8]
        .into_iter()
        .flat_map(|hurst| [1.0, 3.0, 8.0].map(|kappa: f64| (hurst, kappa)));
    let cases: Vec<_> = kinds
        .flat_map(|(hurst, kappa)| (1..=10).map(move |seed| (hurst, kappa, seed)))
        .collect();
    for form in forms {
        let figures = |points: usize, &(hurst, kappa, seed): &(f64, f64, u64)| {
            let spectrum = SelfAffine {
                hurst,
                first: 1,
                last: 24,
                roll_off_mode: 0.0,
            };
            let shift = form.as_ref().map_or(0.0, |form| form.shift(points as u64));
            let rough = Synthesizer::default()
                .synthesize(spectrum, seed, points, shift, Vec::new())
                .unwrap();
            let line = Line::new(1.0, points, form.as_ref(), Some(&rough), 0.01).unwrap();
            let work = 1e-4 * spectrum.gradient_per_height(1.0) / (kappa * kappa);
            let foundation = Foundation::new(line.spacing, 1.0);
            let body = Body::new(line.gaps.to_vec(), Edges::SubCell, foundation, work);
            let stages = body
                .history(&[Move::ToForce(4e-3), Move::ToSeparation], 64)
                .stages;
            [
                stages[1].smallest.force,
                stages.iter().map(|stage| stage.released_energy).sum(),
            ]
        };
        let all = |points: usize| {
            cases
                .iter()
                .map(|case| figures(points, case))
                .collect::<Vec<_>>()
        };
        let (finest, grids) = (
            all(1 << 15),
            [7, 8, 9, 10, 11, 12, 13].map(|exponent| 1_usize << exponent),
        );
        let found = grids.map(all);
        for (index, what) in ["pull-off", "energy"].into_iter().enumerate() {
            let medians = found.each_ref().map(|found| {
                let pairs = found.iter().zip(&finest);
                let mut errors: Vec<f64> = pairs
                    .map(|(one, fine)| (one[index] / fine[index] - 1.0).abs())
                    .collect();
                errors.sort_by(f64::total_cmp);
                errors[errors.len() / 2]
            });
            let order = observed_order(&grids.map(|points| 1.0 / points as f64), &medians);
            println!("{form:?}: {what}: medians {medians:?}, order {order:.2}");
            assert!(order >= 1.8, "{form:?}: {what}: order {order}");
        }
    }
}
