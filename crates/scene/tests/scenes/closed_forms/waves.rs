//! A sphere with concentric waves, R = 1 m and E* = 1 MPa: jumps over waves, steep waves, and many
//! short waves.

use super::one_piece::{Loop, OnePiece};
use super::{BOTH, LEAST_ORDER, Problem, judge};
use crate::body::end;
use asperity_contact::{Edges, Move};
use asperity_scene::theory::SteepWaves;
use asperity_scene::{Simulation, open};
use asperity_surface::Form;
use std::f64::consts::PI;

const MODULUS: f64 = 1.0e6;
/// Force of the smooth sphere for γ = 1 kJ/m², N.
const SMOOTH: f64 = 1.5e3 * PI;

/// Waves with λ²/(AR) = 13: the profile rises everywhere.
const GENTLE: f64 = 0.01 / 13.0;
/// Waves with λ²/(AR) = 5: behind a crest an inner spring is the most stretched one.
const STEEP: f64 = 2.0e-3;

fn form(amplitude: f64, wavelength: f64) -> Form {
    Form::WavySphere {
        radius: 1.0,
        amplitude,
        wavelength,
    }
}

/// A sphere with waves of 0.1 m, pressed to an indentation.
fn problem(amplitude: f64, work: f64, deepest: f64) -> Problem {
    Problem {
        form: Some(form(amplitude, 0.1)),
        length: 1.0,
        modulus: MODULUS,
        works: [work; 2],
        deepest,
    }
}

/// Errors of the smallest force, of the place of separation and of the energy.
fn errors(problem: &Problem, expected: [f64; 3], edges: Edges, points: usize) -> [f64; 3] {
    let [loading, unloading] = problem.stages(edges, points);
    let energy = loading.released_energy + unloading.released_energy;
    let found = [unloading.smallest.force, unloading.end(), energy];
    std::array::from_fn(|index| (found[index] / expected[index] - 1.0).abs())
}

fn expected(exact: &Loop) -> [f64; 3] {
    [
        exact.pull_off().1,
        exact.separation().0,
        exact.dissipated_energy(),
    ]
}

#[test]
fn wavy_spheres_converge_to_their_closed_form() {
    for (amplitude, work) in [(5.0e-4, 1e3), (GENTLE, 1e3), (GENTLE, 4e3)] {
        let problem = problem(amplitude, work, 0.06);
        let exact = problem.closed_form();
        let jumps = exact.unloading.len() - 1;
        assert_eq!(jumps > 0, work > 1e3, "{jumps} jumps");
        let expected = expected(&exact);
        let figures = ["pull-off", "place of separation", "energy"].map(|what| (what, true));
        for edges in BOTH {
            judge(
                &format!("A = {amplitude}"),
                edges,
                LEAST_ORDER,
                figures,
                |points| errors(&problem, expected, edges, points),
            );
        }
    }
}

/// Indentation just above separation, m.
const BACK: f64 = -0.0385;

/// Back to just above separation and in again, so that an edge jumps over a wave on the way out and
/// on the way in.
#[test]
fn wavy_spheres_follow_both_branches_and_jumps_of_their_closed_form() {
    let deepest = 0.06;
    let problem = problem(GENTLE, 4e3, deepest);
    let exact = problem.closed_form();
    let to = Move::ToIndentation;
    let targets = [to(deepest), to(BACK), to(deepest), Move::ToSeparation];
    let history = problem.body(Edges::SubCell, 1601).history(&targets, 401);
    let body = exact.opening;
    let again = body.loading(BACK, deepest);
    let paths = [
        (&exact.loading, 0),
        (&exact.unloading, 1),
        (&again, 1),
        (&exact.unloading, 1),
    ];
    let pull_off = -history.stages[3].smallest.force;
    for (record, (path, most)) in history.stages.iter().zip(paths) {
        let (mut jumps, mut followed, mut before) = (0, 0, None);
        for point in record.curve.iter().filter(|point| point.springs > 0) {
            let (d, found) = (point.indentation, 0.5 * point.contact_length);
            // Beside a jump, and just before separation, either side is right to the error of the
            // grid.
            if d < BACK - 1e-9 {
                continue;
            }
            let [a, b] = [-2e-5, 2e-5].map(|by| body.radius(path, (d + by).min(deepest)));
            if (a - b).abs() > 0.01 {
                continue;
            }
            let expected = body.radius(path, d);
            assert!(
                (found - expected).abs() < 0.01,
                "d = {d}: {found} {expected}"
            );
            assert!(
                (body.indentation(found) - d).abs() < 2e-5,
                "d = {d}: {found} {expected}"
            );
            assert!(
                (point.force - body.force(expected)).abs() < 2e-3 * pull_off,
                "{point:?}"
            );
            jumps += usize::from(before.is_some_and(|before: f64| (before - found).abs() > 0.02));
            (before, followed) = (Some(found), followed + 1);
        }
        assert_eq!(jumps, most, "{:?}", record.target);
        assert!(followed > 300, "{:?}: {followed} points", record.target);
    }
    assert!(end(&history.stages[3]).springs == 0);
}

/// Where the profile falls behind a crest the rule of Hess detaches earlier than JKR. Both figures
/// are of an independent computation.
#[test]
fn steep_waves_detach_by_the_rule_before_jkr() {
    for deepest in [0.02, 0.06, 0.1] {
        let problem = problem(STEEP, 1e3, deepest);
        let jkr = problem.closed_form();
        let rule = Loop::new(
            OnePiece {
                by_rule: true,
                ..jkr.opening.clone()
            },
            1e3,
            deepest,
        );
        let errors = errors(&problem, expected(&rule), Edges::SubCell, 4001);
        assert!(
            errors.iter().all(|error| *error < 1e-4),
            "to {deepest}: {errors:?}"
        );
        assert!(rule.dissipated_energy() < jkr.dissipated_energy());
        if deepest == 0.06 {
            let [jkr, rule] = [jkr, rule].map(|exact| -exact.pull_off().1 / SMOOTH);
            assert!(
                (jkr - 1.556_549).abs() < 1e-6 && (rule - 1.511_869).abs() < 1e-6,
                "{jkr} {rule}"
            );
        }
    }
    let gentle = problem(GENTLE, 1e3, 0.06).closed_form();
    let by_rule = Loop::new(
        OnePiece {
            by_rule: true,
            ..gentle.opening.clone()
        },
        1e3,
        0.06,
    );
    assert_eq!(gentle.pull_off(), by_rule.pull_off());
}

#[test]
fn steep_waves_of_a_scene_agree_with_the_closed_form() {
    let of = |amplitude: f64, wavelength: f64, work: f64| {
        let form = format!(
            "WavySphere(radius: 1.0, amplitude: {amplitude:?}, wavelength: {wavelength:?})"
        );
        let fields = [
            ("form", form),
            ("material", "(modulus: 1.0e6)".to_owned()),
            ("adhesion", format!("(work: {work:?})")),
            ("length", "1.0".to_owned()),
        ];
        let fields = fields.map(|(path, value)| (path.to_owned(), value));
        let document = open("wavy-sphere").unwrap().set_all(&fields).unwrap();
        let (_, _, governing) = Simulation::default().make_line(document.scene()).unwrap();
        SteepWaves::of(document.scene(), &governing)
    };
    // JKR by the closed form of one piece: 1.669 and 1.690 times the force of the sphere.
    for (amplitude, wavelength) in [(0.3_f64, 0.26_f64), (0.3, 0.033)] {
        let critical = (9.0 * PI * 1e3 / (8.0 * MODULUS)).cbrt();
        let wavelength = wavelength * critical;
        let amplitude = amplitude * (2.0 * wavelength * 1e3 / (PI * MODULUS)).sqrt();
        let body = OnePiece::new(form(amplitude, wavelength), MODULUS, 1e3, 5.0 * critical);
        let factor = -Loop::new(body.clone(), 1e3, body.indentation(3.0 * critical))
            .pull_off()
            .1
            / SMOOTH;
        let found = of(amplitude, wavelength, 1e3).unwrap();
        assert!(
            (found.jkr_factor / factor - 1.0).abs() < 0.02,
            "{found:?} {factor}"
        );
        assert!((found.ratio - wavelength.powi(2) / amplitude).abs() < 1e-9 * found.ratio);
    }
    assert_eq!(of(0.01, 0.4, 1e3), None);
    assert_eq!(of(2.0e-3, 0.1, 0.0), None);
    assert_eq!(of(2.0e-3, 0.1, 1e-303), None, "no finite factor");
}
