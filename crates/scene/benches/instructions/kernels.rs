//! Kernels: the least computation that each scene needs. A kernel calls only the necessary building
//! blocks one after the other. It has no plan and no switches, and stores nothing for a later run.

use super::cases::{
    Case, Class, EFFECTIVE_MODULUS, FORCE, HURST, LAST_MODE, LENGTH, POINTS, RADIUS, RMS_HEIGHT,
    SAMPLES, SEED, WORK_OF_ADHESION,
};
use asperity_contact::Move;
use asperity_contact::motion::{Body, Stage, load_body};
use asperity_contact::{Contact, History, Modulus, Patch, Profile, StageRecord};
use asperity_surface::Form;
use asperity_surface::SelfAffine;
use asperity_surface::lines::{Histogram, Line, Synthesizer};
use std::sync::Arc;

/// Number of bins of the histogram of heights.
const BINS: usize = 64;

const LOOP: [Move; 2] = [Move::ToForce(FORCE), Move::ToSeparation];
const TOUCH: [Move; 2] = [Move::ToTouch, Move::ToSeparation];
const PRESS: [Move; 1] = [Move::ToForce(FORCE)];

/// Results of a kernel.
#[derive(Default)]
pub struct Given {
    pub history: History,
    pub without_preload: [Option<f64>; 2],
    pub histogram: Option<Histogram>,
    pub patches: Vec<Vec<Patch>>,
}

/// Runs the kernel of a scene and returns its results.
pub fn kernel(case: &Case) -> Given {
    let (smooth_or_rough, stages): (Line, &[Move]) = match case.class {
        Class::SmoothPressed => (smooth(), &PRESS),
        Class::AdhesivePressed => (rough(), &PRESS),
        Class::AdhesiveTouch => (rough(), &TOUCH),
        Class::RoughLoop | Class::AdhesiveLoop | Class::AdhesiveObserved => (rough(), &LOOP),
    };
    let (line, edges) = (&smooth_or_rough, case.edges);
    let work = if case.is_adhesive() {
        WORK_OF_ADHESION
    } else {
        0.0
    };
    let profile = Profile::from_gaps(Arc::clone(&line.gaps), line.spacing).expect("a finite line");
    let modulus = Modulus::effective(EFFECTIVE_MODULUS).expect("a modulus");
    let contact = Contact::builder(&profile, modulus)
        .work_of_adhesion(work)
        .edges(edges)
        .build();
    let mut body = Body::new(&contact.expect("a contact"), SAMPLES);
    if !case.is_adhesive() {
        let history = load_body(&mut body, stages, |_, _| Ok(())).expect("a loading within reach");
        return Given {
            history,
            ..Given::default()
        };
    }
    let histogram = case
        .is_observed()
        .then(|| Histogram::new(line.heights(), line.lowest(), line.summit, BINS));
    Given {
        histogram,
        ..adhesive(case, body, stages)
    }
}

fn smooth() -> Line {
    let sphere = Form::Paraboloid { radius: RADIUS };
    Line::new(LENGTH, POINTS, Some(&sphere), None, 0.0).expect("a line")
}

fn rough() -> Line {
    let spectrum = SelfAffine {
        hurst: HURST,
        first: 1,
        last: LAST_MODE,
        roll_off_mode: 0.0,
    };
    let unit = Synthesizer::default()
        .synthesize(spectrum, SEED, POINTS, 0.0, Vec::new())
        .expect("a line");
    Line::new(LENGTH, POINTS, None, Some(&unit), RMS_HEIGHT).expect("a line")
}

/// Loads the body with adhesion through the stages `stages`. Also computes the other results that
/// the scene needs besides the force curve.
fn adhesive(case: &Case, mut body: Body, stages: &[Move]) -> Given {
    let mut patches = Vec::new();
    let history = load_body(&mut body, stages, |record: &StageRecord, stage: &Stage| {
        if case.is_observed() {
            let end = record.curve.last().filter(|end| end.springs > 0);
            patches.push(end.map_or_else(Vec::new, |end| stage.patches(end.indentation)));
        }
        Ok(())
    });
    let history = history.expect("a loading within reach");
    let without_preload = match case.class {
        Class::AdhesivePressed => [None; 2],
        _ => body
            .adhesion_without_preload()
            .expect("a contact at first touch"),
    };
    Given {
        history,
        without_preload,
        histogram: None,
        patches,
    }
}
