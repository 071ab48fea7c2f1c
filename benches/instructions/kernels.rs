//! For each case the least that computes it: only the building blocks it needs, one after the other, without a
//! plan, switches or memory of an earlier run.

use super::cases::{
    Case, Class, EFFECTIVE_MODULUS, FORCE, HURST, LAST_MODE, LENGTH, POINTS, RADIUS, RMS_HEIGHT, SAMPLES,
    SEED, WORK_OF_ADHESION,
};
use asperity::analysis::Figures;
use asperity::contact::exact::{self, OverTree};
use asperity::contact::subcell::{self, LevelSets};
use asperity::contact::{
    BodyMemory, ContactTree, Exact, Foundation, GridEdges, HessRule, History, LegRecord, Solver, Work, run,
};
use asperity::scene::{Edges, Form, Leg};
use asperity::surface::{Histogram, Line, SelfAffine, Synthesizer};
use std::sync::Arc;

/// Bins of the histogram of heights.
const BINS: usize = 64;

const LOOP: [Leg; 2] = [Leg::ToForce(FORCE), Leg::ToSeparation];
const TOUCH: [Leg; 2] = [Leg::ToTouch, Leg::ToSeparation];
const PRESS: [Leg; 1] = [Leg::ToForce(FORCE)];

/// What a kernel gives.
#[derive(Default)]
pub struct Given {
    pub history: History,
    pub zero_load_adhesion_force: Option<f64>,
    pub histogram: Option<Histogram>,
    pub fragments: Vec<Vec<(usize, usize)>>,
}

/// Runs the kernel of a case.
pub fn kernel(case: &Case) -> Given {
    match (case.edges, case.class) {
        (Edges::Grid, Class::SmoothPressed) => bare(&smooth(), &PRESS),
        (Edges::Grid, Class::RoughLoop) => bare(&rough(), &LOOP),
        (Edges::Grid, Class::AdhesivePressed) => adhesive(&rough(), &PRESS),
        (Edges::Grid, Class::AdhesiveTouch) => touch(&rough()),
        (Edges::Grid, Class::AdhesiveLoop) => adhesive_and_touch(&rough()),
        (Edges::Grid, Class::AdhesiveObserved) => observed(&rough()),
        (Edges::SubCell, Class::SmoothPressed) => bare_between(&smooth(), &PRESS),
        (Edges::SubCell, Class::RoughLoop) => bare_between(&rough(), &LOOP),
        (Edges::SubCell, Class::AdhesivePressed) => between(&rough(), &PRESS),
        (Edges::SubCell, Class::AdhesiveTouch) => touch_between(&rough()),
        (Edges::SubCell, Class::AdhesiveLoop) => between_and_touch(&rough()),
        (Edges::SubCell, Class::AdhesiveObserved) => observed_between(&rough()),
    }
}

const FOUNDATION: Foundation =
    Foundation { spacing: LENGTH / POINTS as f64, effective_modulus: EFFECTIVE_MODULUS };

fn hess() -> HessRule {
    HessRule::new(FOUNDATION, WORK_OF_ADHESION)
}

fn smooth() -> Line {
    let sphere = Form::Paraboloid { radius: RADIUS };
    Line::new(LENGTH, POINTS, Some(&sphere), None, 0.0).expect("a line")
}

fn rough() -> Line {
    let spectrum = SelfAffine { hurst: HURST, first: 1, last: LAST_MODE };
    let unit = Synthesizer::default().synthesize(spectrum, SEED, POINTS, Vec::new()).expect("a line");
    Line::new(LENGTH, POINTS, None, Some(&unit.heights), RMS_HEIGHT).expect("a line")
}

fn loaded(body: &mut impl Solver, legs: &[Leg]) -> History {
    run(body, legs, |_, _| Ok(())).expect("a loading within reach")
}

fn given(history: History) -> Given {
    Given { history, ..Given::default() }
}

fn bare(line: &Line, legs: &[Leg]) -> Given {
    given(loaded(&mut exact::nonadhesive(&line.gaps, Edges::Grid, FOUNDATION, SAMPLES), legs))
}

fn adhesive(line: &Line, legs: &[Leg]) -> Given {
    let tree = ContactTree::build(&line.gaps).expect("a tree");
    let mut body = exact::adhesive(&tree, GridEdges::new(hess()), FOUNDATION, SAMPLES).expect("a body");
    given(loaded(&mut body, legs))
}

fn touch(line: &Line) -> Given {
    let mut given = adhesive(line, &TOUCH);
    given.zero_load_adhesion_force = Figures::of(&given.history).adhesion_force;
    given
}

fn adhesive_and_touch(line: &Line) -> Given {
    let tree = ContactTree::build(&line.gaps).expect("a tree");
    let rule = GridEdges::new(hess());
    let mut body = exact::adhesive(&tree, rule, FOUNDATION, SAMPLES).expect("a body");
    loop_and_touch(&mut body)
}

fn observed(line: &Line) -> Given {
    let histogram = Histogram::new(line.heights(), line.lowest(), line.summit, BINS);
    let tree = ContactTree::build(&line.gaps).expect("a tree");
    let rule = GridEdges::new(hess());
    let mut body = exact::adhesive(&tree, rule, FOUNDATION, SAMPLES).expect("a body");
    Given { histogram: Some(histogram), ..observed_loop(&mut body) }
}

/// A loop, and F_a(0) from its first touch.
fn loop_and_touch<'a, C: OverTree<'a, Rule: Clone>>(body: &mut Exact<C>) -> Given {
    let mut touch = None;
    let history = run(body, &LOOP, |_, body: &Exact<C>| {
        touch = touch.or(body.pull_off_at_touch(&mut BodyMemory::default())?);
        Ok(())
    });
    Given {
        history: history.expect("a loading within reach"),
        zero_load_adhesion_force: force(touch),
        ..Given::default()
    }
}

/// The same with the fragments at the end of each leg.
fn observed_loop<'a, C: OverTree<'a, Rule: Clone>>(body: &mut Exact<C>) -> Given {
    let (mut touch, mut fragments) = (None, Vec::new());
    let history = run(body, &LOOP, |record: &LegRecord, body: &Exact<C>| {
        touch = touch.or(body.pull_off_at_touch(&mut BodyMemory::default())?);
        let end = record.curve.last().filter(|end| end.springs > 0);
        fragments.push(end.map_or_else(Vec::new, |end| body.fragments(end.indentation)));
        Ok(())
    });
    let history = history.expect("a loading within reach");
    Given { history, zero_load_adhesion_force: force(touch), fragments, ..Given::default() }
}

fn force(touch: Option<(f64, Work)>) -> Option<f64> {
    touch.map(|(smallest, _)| -smallest)
}

fn levels(line: &Line) -> Arc<LevelSets> {
    let tree = Arc::new(ContactTree::build(&line.gaps).expect("a tree"));
    Arc::new(LevelSets::new(tree, &line.gaps).expect("level sets"))
}

fn body_between(levels: &Arc<LevelSets>) -> subcell::Adhesive<'_> {
    subcell::adhesive_in(BodyMemory::default(), levels, Some(hess()), FOUNDATION, SAMPLES).expect("a body")
}

fn bare_between(line: &Line, legs: &[Leg]) -> Given {
    given(loaded(&mut exact::nonadhesive(&line.gaps, Edges::SubCell, FOUNDATION, SAMPLES), legs))
}

fn between(line: &Line, legs: &[Leg]) -> Given {
    given(loaded(&mut body_between(&levels(line)), legs))
}

fn touch_between(line: &Line) -> Given {
    let mut given = between(line, &TOUCH);
    given.zero_load_adhesion_force = Figures::of(&given.history).adhesion_force;
    given
}

fn between_and_touch(line: &Line) -> Given {
    loop_and_touch(&mut body_between(&levels(line)))
}

fn observed_between(line: &Line) -> Given {
    let histogram = Histogram::new(line.heights(), line.lowest(), line.summit, BINS);
    Given { histogram: Some(histogram), ..observed_loop(&mut body_between(&levels(line))) }
}
