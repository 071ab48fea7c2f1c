//! Bodies whose loop has a closed form.

use super::{ensure, press_and_pull, two_legs};
use crate::check::case::{CASE, Case, Evidence, Scope};
use crate::check::{Body, Fault, end};
use crate::contact::Foundation;
use crate::reference::{PowerLaw, WavyLoop, WavySphere};
use crate::scene::{Edges, Form, Leg};
use crate::surface::Line;

/// Shared fields of the cases that compare a pull-off with a closed form.
const PULL_OFF: Case = Case {
    evidence: &[Evidence::ClosedForm],
    error_of: "force and place of pull-off",
    scope: Scope::BothEdges(1e-2, 1e-5),
    ..CASE
};

pub const CASES: &[Case] = &[
    Case {
        name: "hertz-sphere",
        holds: "Without adhesion 4001 springs press a sphere by Hertz.",
        evidence: &[Evidence::ClosedForm],
        error_of: "force, over the largest",
        scope: Scope::BothEdges(2e-6, 2e-6),
        measure: hertz,
        ..CASE
    },
    Case {
        name: "jkr-sphere",
        holds: "4001 springs pull a sphere off at (3/2)πγR and detach at the indentation of Johnson, Kendall and Roberts.",
        measure: |edges| power_law(edges, Form::Paraboloid { radius: 1.0 }, 12.0, 1.5),
        ..PULL_OFF
    },
    Case {
        name: "cone",
        holds: "4001 springs pull a cone off at the force and the indentation of the closed form.",
        measure: |edges| power_law(edges, Form::Cone { angle: 1.0 }, 16.0, 4.0),
        ..PULL_OFF
    },
    Case {
        name: "seventh-power",
        holds: "4001 springs pull a body r⁷, nearly flat with steep flanks, off at the force \
                and the indentation of the closed form.",
        measure: |edges| power_law(edges, Form::Power { coefficient: 0.3, exponent: 7.0 }, 8.0, 1.0),
        ..PULL_OFF
    },
    Case {
        name: "wavy-sphere",
        holds: "4001 springs load and unload a sphere with concentric waves by the jumps of the closed form.",
        evidence: &[Evidence::ClosedForm],
        error_of: "force and place of pull-off, dissipated energy",
        scope: Scope::BothEdges(1e-2, 1e-5),
        measure: |edges| wavy_sphere(edges, GENTLE_WAVES, WavySphere::cycle),
        ..CASE
    },
    Case {
        name: "wavy-sphere-steep",
        holds: "4001 springs load and unload a sphere with waves so steep that inner springs detach first, by the closed \
                form of the rule of Hess.",
        evidence: &[Evidence::ClosedForm],
        error_of: "force and place of pull-off, dissipated energy",
        scope: Scope::BothEdges(1e-2, 1e-4),
        measure: |edges| wavy_sphere(edges, STEEP_WAVES, WavySphere::cycle_by_rule),
        ..CASE
    },
    Case {
        name: "wavy-sphere-steep-jkr",
        holds: "4001 springs load and unload the same sphere as the theory of Johnson, Kendall and Roberts does.",
        evidence: &[Evidence::ClosedForm],
        known_failure: Some(
            "the rule of Hess detaches the most stretched spring, here an inner one, and a contact in one piece is \
             assumed by the theory",
        ),
        error_of: "force and place of pull-off, dissipated energy",
        scope: Scope::BothEdges(1e-2, 1e-4),
        measure: |edges| wavy_sphere(edges, STEEP_WAVES, WavySphere::cycle),
        ..CASE
    },
];

/// λ²/(AR) = 20: the equivalent profile rises everywhere.
const GENTLE_WAVES: f64 = 5e-4;
/// λ²/(AR) = 5: the equivalent profile has maxima inside.
const STEEP_WAVES: f64 = 2e-3;

const POINTS: usize = 4001;

fn smooth(form: Form, length: f64, work: f64) -> Result<Body, Fault> {
    let line = Line::new(length, POINTS, Some(&form), None, 0.0)?;
    let foundation = Foundation::endless(line.spacing, 1.0);
    Ok(Body { gaps: line.gaps, foundation, work })
}

fn hertz(edges: Edges) -> Result<f64, Fault> {
    let body = smooth(Form::Paraboloid { radius: 1.0 }, 4.0, 0.0)?;
    let history = body.history(edges, &[Leg::ToIndentation(1.0)], 257)?;
    // F = (4/3) E* √R d^(3/2).
    let force = |d: f64| 4.0 / 3.0 * d.powf(1.5);
    let errors = history.legs[0].curve.iter().map(|point| (point.force - force(point.indentation)).abs());
    Ok(errors.fold(0.0, f64::max) / force(1.0))
}

/// Loop of a closed form to an indentation and back, within a radius.
type Cycle = fn(&WavySphere, f64, f64) -> Option<WavyLoop>;

/// A sphere with waves of this amplitude.
fn wavy_sphere(edges: Edges, amplitude: f64, cycle: Cycle) -> Result<f64, Fault> {
    let (radius, wavelength, work, deepest) = (1.0, 0.1, 1e-3, 0.06);
    let exact = WavySphere { radius, amplitude, wavelength, effective_modulus: 1.0, work_of_adhesion: work };
    let Some(cycle) = cycle(&exact, deepest, 0.5) else {
        return Err(Fault::Wrong("the closed form is wider than the line".into()));
    };
    let body = smooth(Form::WavySphere { radius, amplitude, wavelength }, 1.0, work)?;
    let history = body.history(edges, &press_and_pull(deepest), 2)?;
    let [loading, unloading] = two_legs(&history)?;
    let energy = loading.released_energy + unloading.released_energy;
    let errors = [
        unloading.smallest.force / cycle.smallest_force - 1.0,
        unloading.end() / cycle.separation - 1.0,
        energy / cycle.dissipated_energy - 1.0,
    ];
    Ok(errors.into_iter().map(f64::abs).fold(0.0, f64::max))
}

fn power_law(edges: Edges, form: Form, length: f64, deepest: f64) -> Result<f64, Fault> {
    let Some(closed) = PowerLaw::of(&form, 1.0, 1.0) else {
        return Err(Fault::Wrong("no closed form".into()));
    };
    let body = smooth(form, length, 1.0)?;
    let history = body.history(edges, &press_and_pull(deepest), 257)?;
    let [loading, unloading] = two_legs(&history)?;
    ensure(loading.largest.springs < POINTS as u64, || "the line is too short".into())?;
    let (pull_off, detachment) =
        (closed.force_controlled_pull_off().1, closed.displacement_controlled_pull_off());
    let detachment = closed.indentation(detachment.0);
    let error = |found: f64, expected: f64| (found / expected - 1.0).abs();
    Ok(error(unloading.smallest.force, pull_off).max(error(end(unloading).indentation, detachment)))
}
