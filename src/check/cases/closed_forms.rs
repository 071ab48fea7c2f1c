//! Bodies whose loop has a closed form.

use super::{ensure, press_and_pull, two_legs};
use crate::check::case::{CASE, Case, Evidence, Scope};
use crate::check::{Body, Fault, end};
use crate::contact::Foundation;
use crate::reference::PowerLaw;
use crate::scene::{Edges, Form, Move};
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
];

const POINTS: usize = 4001;

fn smooth(form: Form, length: f64, work: f64) -> Result<Body, Fault> {
    let line = Line::new(length, POINTS, Some(&form), None, 0.0)?;
    let foundation = Foundation::endless(line.spacing, 1.0);
    Ok(Body { gaps: line.gaps.to_vec(), foundation, work })
}

fn hertz(edges: Edges) -> Result<f64, Fault> {
    let body = smooth(Form::Paraboloid { radius: 1.0 }, 4.0, 0.0)?;
    let history = body.history(edges, &[Move::ToIndentation(1.0)], 257)?;
    // F = (4/3) E* √R d^(3/2).
    let force = |d: f64| 4.0 / 3.0 * d.powf(1.5);
    let errors = history.legs[0].curve.iter().map(|point| (point.force - force(point.indentation)).abs());
    Ok(errors.fold(0.0, f64::max) / force(1.0))
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
