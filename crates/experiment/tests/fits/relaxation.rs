//! Tests: the relaxation of a half-space is found from the curve of a sphere.
//!
//! The curves are those of the engine with much smaller steps, and of a profile with other springs,
//! than the fit has.

use crate::common::sphere::{Sphere, add_noise, path};
use crate::common::{cases, fit_from};
use asperity_contact::motion::{MovingBody, RelaxingBody};
use asperity_contact::{CurvePoint, Direction, Move};
use asperity_data::{Control, on_threads};
use asperity_experiment::{
    CurveOptions, ExperimentError, Fit, FitResult, FittedParameter, Free, MeasuredCurve, Parameter,
};
use asperity_scene::instrument::DisplacementCurve;
use asperity_scene::{Document, Simulation, open, run};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::PI;

/// Stiffness of the instrument in N/m.
const STIFFNESS: f64 = 3.0;
/// Displacement in m at which the instrument turns.
const TOP: f64 = 2e-6;

/// A sphere on rubber that relaxes, whose instrument turns after a rest of `rest` seconds.
fn document(work: f64, modulus: f64, share: f64, time: f64, rest: f64) -> Document {
    let changes = [
        ("form.radius", "7.5e-6".to_owned()),
        ("length", "2.4e-5".to_owned()),
        (
            "material",
            format!("(modulus: {modulus:e}, relaxation: (share: {share}, time: {time}))"),
        ),
        ("adhesion.work", work.to_string()),
        ("loading_stiffness", STIFFNESS.to_string()),
        ("loading_speed", "1e-6".to_owned()),
        (
            "loading",
            format!("[ToDisplacement({TOP:e}), Hold({rest}), ToSeparation]"),
        ),
        ("numerics.points", "1024".to_owned()),
        ("numerics.samples", "1024".to_owned()),
    ];
    let changes = changes.map(|(path, value)| (path.to_owned(), value));
    open("jkr-sphere").unwrap().set_all(&changes).unwrap()
}

/// Share of the largest force by which the forces of the curves may deviate because of the steps.
const TOLERANCE: f64 = 1e-6;

/// A measured curve, and how it came about.
struct Measured {
    displacements: Vec<f64>,
    forces: Vec<f64>,
    seconds: Vec<f64>,
}

/// How a curve is measured.
#[derive(Clone, Copy)]
struct Protocol {
    /// Displacement in m at which the instrument turns.
    top: f64,
    /// Distance in m between points.
    step: f64,
    /// Time in s for which the instrument rests.
    rest: f64,
    /// Number of points of the rest.
    resting: usize,
    /// Speeds above the half of the top and on the retraction, divided by the first speed.
    upper: f64,
    faster: f64,
}

impl Measured {
    /// Presses the body of a scene, lets it rest and retracts it.
    fn new(document: &Document, protocol: Protocol) -> Self {
        let Protocol {
            top,
            step,
            rest,
            resting,
            upper,
            faster,
        } = protocol;
        let scene = document.scene();
        let stiffness = scene.loading_stiffness.unwrap_or(f64::INFINITY);
        let speed = scene.loading_speed.unwrap();
        let (contact, _) = Simulation::default().contact(scene).unwrap();
        let mut body = RelaxingBody::new(&contact)
            .unwrap()
            .with_tolerance(TOLERANCE);
        let to = |end: f64| {
            if stiffness.is_finite() {
                Move::ToDisplacement(end)
            } else {
                Move::ToIndentation(end)
            }
        };
        let mut pressed = Vec::new();
        if upper != 1.0 {
            pressed.extend(body.advance(to(0.5 * top)).unwrap().curve);
            pressed.pop();
            body.set_speed(upper * speed).unwrap();
        }
        pressed.extend(body.advance(to(top)).unwrap().curve);
        let held = (rest > 0.0).then(|| body.advance(Move::Hold(rest)).unwrap());
        body.set_speed(faster * speed).unwrap();
        let retraction = body.advance(Move::ToSeparation).unwrap();
        let over_displacement =
            |direction, points: &[CurvePoint]| DisplacementCurve::new(direction, points, stiffness);
        let approach = over_displacement(Direction::Loading, &pressed);
        let retraction = over_displacement(Direction::Unloading, &retraction.curve);
        let separation = retraction.points().last().unwrap().displacement;
        let way = top - separation;

        let mut measured = Measured {
            displacements: Vec::new(),
            forces: Vec::new(),
            seconds: Vec::new(),
        };
        // The ends of the curves at the top are there to rounding.
        let highest = [&approach, &retraction]
            .map(|curve| curve.points().iter().map(|point| point.displacement))
            .map(|displacements| displacements.fold(f64::MIN, f64::max));
        let highest = highest[0].min(highest[1]);
        let force = |curve: &DisplacementCurve, at: f64| {
            let point = curve.at(at.min(highest));
            point.map_or(0.0, |point| point.force)
        };
        let free = (-0.5 * way).min(separation - 0.2 * way);
        for at in path(&[free, top], step) {
            let above = at.max(0.5 * top) - top;
            let below = at.min(0.5 * top) - 0.5 * top;
            let seconds = (below + above / upper) / speed;
            measured.add(at, force(&approach, at), seconds);
        }
        if let Some(held) = held {
            let begin = held.seconds[0];
            for number in 0..resting {
                let seconds = (number as f64 + 0.5) / resting as f64 * rest;
                let next = held.seconds.partition_point(|time| time - begin < seconds);
                let [before, after] = [next - 1, next].map(|index| held.curve[index].force);
                let step = held.seconds[next] - held.seconds[next - 1];
                let share = (seconds + begin - held.seconds[next - 1]) / step;
                measured.add(top, before + share * (after - before), seconds);
            }
        }
        for at in path(&[top, separation - way], step).into_iter().skip(1) {
            measured.add(
                at,
                force(&retraction, at),
                rest + (top - at) / (faster * speed),
            );
        }
        measured
    }

    fn add(&mut self, displacement: f64, force: f64, seconds: f64) {
        self.displacements.push(displacement);
        self.forces.push(force);
        self.seconds.push(seconds);
    }

    /// The curve with noise, with or without the times of its points.
    fn curve(mut self, noise: f64, seed: u64, is_timed: bool) -> MeasuredCurve {
        add_noise(&mut self.forces, noise, seed);
        let seconds = if is_timed { &self.seconds[..] } else { &[] };
        let options = CurveOptions::default();
        MeasuredCurve::from_timed_columns(&self.displacements, &self.forces, seconds, &options)
            .unwrap()
    }
}

/// The curve of a scene of rubber with noise of 1 nN.
fn curve_of(document: &Document, seed: u64) -> MeasuredCurve {
    Measured::new(document, PROTOCOL).curve(1e-9, seed, false)
}

const PROTOCOL: Protocol = Protocol {
    top: TOP,
    step: 1e-8,
    rest: 1.0,
    resting: 0,
    upper: 1.0,
    faster: 1.0,
};

/// Returns the number of intervals that hold the truth.
fn held(fit: &FitResult, truth: &[(Parameter, f64)]) -> usize {
    let mut held = 0;
    for (parameter, value) in truth {
        let found = fit
            .parameters
            .iter()
            .find(|found| found.parameter == *parameter)
            .unwrap();
        let (low, high) = found.interval;
        held += usize::from((low..=high).contains(value));
        println!("{parameter:?}: {value:e}, found {found:?}");
    }
    held
}

#[test]
#[ignore = "a fit of relaxation takes several seconds"]
fn the_relaxation_of_rubber_is_found() {
    let document = document(0.05, 1.5e6, 0.3, 2.0, 1.0);
    let curve = curve_of(&document, 1);
    let start = document.set("material", "(modulus: 1.0e6)").unwrap();
    let free = "work,modulus,offset,relaxation_share,relaxation_time";
    let fit = fit_from(&curve, &start, free);
    let truth = [
        (Parameter::Work, 0.05),
        (Parameter::Modulus, 1.5e6),
        (Parameter::RelaxationShare, 0.3),
        (Parameter::RelaxationTime, 2.0),
    ];
    assert!(held(&fit, &truth) >= 3, "{:?}", fit.misfit);
    for (parameter, value) in truth {
        let found = fit.parameters.iter().find(|one| one.parameter == parameter);
        let found = found.unwrap().value;
        assert!(
            (found / value - 1.0).abs() < 0.2,
            "{parameter:?}: {found:e}"
        );
    }
    assert!(fit.describes(), "{}", fit.misfit);
    // The document of the fit has the relaxation and the rest, and can be computed.
    let relaxation = fit.document.scene().material.relaxation.unwrap();
    assert!((relaxation.share / 0.3 - 1.0).abs() < 0.2);
    assert!(run(&fit.document).unwrap().figures.pull_off_force.is_some());
}

/// The model moves as the times of the curve state. The relaxation is known here, so that a wrong
/// speed has no way out.
#[test]
fn a_curve_of_several_speeds_is_computed_at_these_speeds() {
    let document = document(0.05, 1.5e6, 0.3, 2.0, 1.0);
    let protocol = Protocol {
        upper: 0.3,
        faster: 10.0,
        ..PROTOCOL
    };
    let curve = Measured::new(&document, protocol).curve(1e-9, 1, true);
    let fit = fit_from(&curve, &document, "work,modulus,offset");
    let truth = [(Parameter::Work, 0.05), (Parameter::Modulus, 1.5e6)];
    assert_eq!(held(&fit, &truth), 2);
    assert!(fit.misfit < 1.2, "{}", fit.misfit);
    let notes: Vec<String> = fit.assumptions.iter().map(ToString::to_string).collect();
    for said in ["times as fast as the approach", "changes within a motion"] {
        assert!(notes.iter().any(|note| note.contains(said)), "{notes:?}");
    }
}

/// Curves of one specimen at three speeds, with noise of 1 % of the pull-off force, and the scene
/// at which their fit begins.
fn curves_of_three_speeds(is_timed: bool) -> (Vec<(String, MeasuredCurve)>, Document) {
    let mut curves = Vec::new();
    for (number, speed) in [1e-7, 1e-6, 1e-5].into_iter().enumerate() {
        let document = document(0.05, 1.5e6, 0.3, 5.0, 0.0)
            .set("loading_speed", &format!("{speed:e}"))
            .unwrap();
        let protocol = Protocol {
            step: 2e-8,
            rest: 0.0,
            ..PROTOCOL
        };
        let mut measured = Measured::new(&document, protocol);
        // Each curve has a displacement of its own at first touch.
        for displacement in &mut measured.displacements {
            *displacement += OWN_OFFSET * number as f64;
        }
        let curve = measured.curve(1.5e-8, number as u64, is_timed);
        curves.push((format!("{speed:e} m/s"), curve));
    }
    let start = document(0.02, 1e6, 0.3, 5.0, 0.0);
    let changes = [("material", "(modulus: 1.0e6)"), ("loading_speed", "None")];
    let changes = changes.map(|(path, value)| (path.to_owned(), value.to_owned()));
    (curves, start.set_all(&changes).unwrap())
}

/// Difference in m between the displacements at first touch of one curve and the next.
const OWN_OFFSET: f64 = 1e-7;

fn run_together(
    curves: &[(String, MeasuredCurve)],
    start: &Document,
    free: &str,
) -> Result<Vec<FitResult>, ExperimentError> {
    let mut fit = Fit::of(start);
    for name in free.split(',') {
        fit = fit.free(name.parse::<Free>().unwrap());
    }
    fit.run_together(curves, Control::default())
}

/// Ratio of the ends of the interval of the relaxation time.
fn width_of_time(fit: &FitResult) -> f64 {
    let is_time = |found: &&FittedParameter| found.parameter == Parameter::RelaxationTime;
    let (low, high) = fit.parameters.iter().find(is_time).unwrap().interval;
    high / low
}

#[test]
#[ignore = "fits of relaxation take seconds each"]
fn curves_of_several_speeds_give_one_relaxation() {
    let (curves, start) = curves_of_three_speeds(true);
    let free = "work,modulus,offset,relaxation_share,relaxation_time";
    let truth = [
        (Parameter::Work, 0.05),
        (Parameter::Modulus, 1.5e6),
        (Parameter::RelaxationShare, 0.3),
        (Parameter::RelaxationTime, 5.0),
    ];
    let clock = std::time::Instant::now();
    let together = run_together(&curves, &start, free).unwrap();
    println!("{:.1} s", clock.elapsed().as_secs_f64());
    assert_eq!(together.len(), 3);
    for (number, fit) in together.iter().enumerate() {
        assert_eq!(held(fit, &truth), 4);
        assert!(fit.misfit < 1.3, "{}", fit.misfit);
        for (index, found) in fit.parameters.iter().enumerate() {
            if found.parameter == Parameter::Offset {
                let expected = OWN_OFFSET * number as f64;
                assert!((found.value - expected).abs() < 1e-8, "{found:?}");
            } else {
                assert_eq!(found, &together[0].parameters[index]);
            }
        }
        let speed = curves[number].0.clone();
        println!("{speed} {}", fit.assumptions[0]);
    }
    let alone = fit_from(&curves[2].1, &start, free);
    held(&alone, &truth);
    println!("{} {}", width_of_time(&together[0]), width_of_time(&alone));
    assert!(width_of_time(&together[0]) < 1.2);
    assert!(width_of_time(&alone) > 5.0);
    // One curve in the list gives the same as alone.
    let one = run_together(&curves[2..], &start, free).unwrap();
    assert_eq!(one, [alone]);
}

/// Without times in the files all curves have the stated speed, and without a stated speed the
/// error names the curve.
#[test]
fn curves_together_without_times_have_the_stated_speed() {
    let (mut curves, start) = curves_of_three_speeds(true);
    let (untimed, _) = curves_of_three_speeds(false);
    curves[1] = untimed[1].clone();
    curves.pop();
    let free = "work,offset,relaxation_share";
    let refused = run_together(&curves, &start, free).unwrap_err().to_string();
    assert!(refused.starts_with("1e-6 m/s: "), "{refused}");
    assert!(refused.contains("loading_speed"), "{refused}");
    let none = run_together(&[], &start, free).unwrap_err().to_string();
    assert!(none.starts_with("0 curves"), "{none}");

    let start = document(0.02, 1.5e6, 0.2, 5.0, 0.0);
    let fits = run_together(&curves, &start, free).unwrap();
    let truth = [(Parameter::Work, 0.05), (Parameter::RelaxationShare, 0.3)];
    assert_eq!(held(&fits[0], &truth), 2);
    let says = |fit: &FitResult, words: &str| {
        let mut notes = fit.assumptions.iter();
        notes.any(|note| note.to_string().contains(words))
    };
    assert!(says(&fits[0], "100 nm/s by the times of the file"));
    assert!(says(&fits[1], "1 µm/s by the scene"));
}

/// A sphere with its truth and its curve.
struct Case {
    truth: [(Parameter, f64); 4],
    curve: MeasuredCurve,
    /// Scene at which the fit begins: with another work and modulus, and without a speed.
    start: Document,
    /// Relaxation time divided by the time of the motion and of the rest.
    durations: f64,
    has_rest: bool,
    is_rigid: bool,
}

impl Case {
    fn new(seed: u64) -> Self {
        Case::faster(seed, 1.0)
    }

    /// The same body at a speed that is larger by a factor.
    fn faster(seed: u64, factor: f64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(1000 + seed);
        let mut between = |low: f64, high: f64| low * (high / low).powf(generator.random::<f64>());
        let radius = between(1e-6, 2e-5);
        let modulus = between(1e4, 5e6);
        let scale = between(0.05, 0.25);
        let work = modulus * radius * scale.powi(3) / (4.5 * PI);
        let is_rigid = seed % 4 >= 2;
        let stiffness = if is_rigid {
            f64::INFINITY
        } else {
            2.0 * modulus * scale * radius * between(0.5, 10.0)
        };
        let sphere = Sphere {
            radius,
            work,
            modulus,
            stiffness,
        };
        let pull_off = sphere.pull_off();
        let [contact, top] = sphere.at_force(pull_off * between(1.0, 10.0));
        let speed = between(1e-8, 1e-4);
        let way = top - sphere.separation();
        let has_rest = seed % 2 == 1;
        let rest = if has_rest {
            way / speed * between(0.2, 2.0)
        } else {
            0.0
        };
        let share = 0.05 + 0.55 * (between(1.0, std::f64::consts::E)).ln();
        let durations = between(0.05, 20.0);
        let time = durations * (2.0 * way / speed + rest);
        let shown = |stiffness: f64| {
            if stiffness.is_finite() {
                format!("{stiffness:e}")
            } else {
                "None".to_owned()
            }
        };
        let changes = [
            ("form.radius", format!("{radius:e}")),
            ("length", format!("{:e}", 5.0 * contact)),
            (
                "material",
                format!("(modulus: {modulus:e}, relaxation: (share: {share}, time: {time:e}))"),
            ),
            ("adhesion.work", format!("{work:e}")),
            ("loading_stiffness", shown(stiffness)),
            ("loading_speed", format!("{:e}", factor * speed)),
            ("numerics.points", "2048".to_owned()),
        ];
        let changes = changes.map(|(path, value)| (path.to_owned(), value));
        let document = open("jkr-sphere").unwrap().set_all(&changes).unwrap();
        let step = way / between(100.0, 250.0);
        let noise = pull_off * between(0.001, 0.01);
        let resting = between(20.0, 200.0) as usize;
        let protocol = Protocol {
            top,
            step,
            rest: rest / factor,
            resting,
            ..PROTOCOL
        };
        let measured = Measured::new(&document, protocol);
        let changes = [
            ("material", format!("(modulus: {:e})", 0.3 * modulus)),
            ("adhesion.work", format!("{:e}", 5.0 * work)),
            ("loading_speed", "None".to_owned()),
            ("numerics.points", "1024".to_owned()),
        ];
        let changes = changes.map(|(path, value)| (path.to_owned(), value));
        Case {
            truth: [
                (Parameter::Work, work),
                (Parameter::Modulus, modulus),
                (Parameter::RelaxationShare, share),
                (Parameter::RelaxationTime, time),
            ],
            curve: measured.curve(noise, (seed as f64 * factor) as u64, true),
            start: document.set_all(&changes).unwrap(),
            durations,
            has_rest,
            is_rigid,
        }
    }
}

/// Fits `count` specimens, each of them to curves at these speeds relative to its first one, and
/// returns for each parameter the number of intervals that hold the truth.
fn held_in(count: u64, speeds: &'static [f64]) -> [usize; 4] {
    let worker = || {
        move |number: u64| {
            let case = Case::new(number);
            let clock = std::time::Instant::now();
            let free = "work,modulus,offset,relaxation_share,relaxation_time";
            let curve = |speed: &f64| (speed.to_string(), Case::faster(number, *speed).curve);
            let curves: Vec<(String, MeasuredCurve)> = speeds.iter().map(curve).collect();
            let fit = run_together(&curves, &case.start, free).unwrap().remove(0);
            let mut held = [0; 4];
            let mut shown = String::new();
            for (place, (parameter, truth)) in case.truth.iter().enumerate() {
                let found = fit
                    .parameters
                    .iter()
                    .find(|one| one.parameter == *parameter);
                let found = found.unwrap();
                let (low, high) = found.interval;
                held[place] = usize::from((low..=high).contains(truth));
                shown += &format!(
                    " {:?} {:.4} ({:.4} to {:.4}){}",
                    parameter,
                    found.value / truth,
                    low / truth,
                    high / truth,
                    if held[place] == 1 { "" } else { " NOT HELD" }
                );
            }
            println!(
                "{} rest {} rigid {} time {:.2} share {:.2} misfit {:.3} {} curves {:.1} s:{shown}",
                number,
                case.has_rest,
                case.is_rigid,
                case.durations,
                case.truth[2].1,
                fit.misfit,
                fit.evaluations,
                clock.elapsed().as_secs_f64()
            );
            Ok::<_, ExperimentError>(held)
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let all = on_threads(count, threads, worker).unwrap();
    let mut sums = [0; 4];
    for held in all {
        for (sum, held) in sums.iter_mut().zip(held) {
            *sum += held;
        }
    }
    println!("of {count}: work, modulus, share, time {sums:?}");
    sums
}

/// Largest number of curves.
const MOST: u64 = 60;

/// Four curves, times `TEST_EFFORT`, and at most 60.
#[test]
#[ignore = "fits of relaxation take seconds each"]
fn most_relaxations_are_held() {
    let count = cases(4, MOST);
    let [work, modulus, share, _] = held_in(count, &[1.0]);
    let held = work + modulus + share;
    // Of the few intervals of a usual run, two may miss the truth by chance.
    let least = if count < MOST { 0.8 } else { 0.93 };
    assert!(held as f64 >= least * 3.0 * count as f64, "{held}");
}

/// Three curves at speeds of 1:10:100 determine all four parameters, for one specimen, times
/// `TEST_EFFORT`, and at most 60.
#[test]
#[ignore = "fits of relaxation take seconds each"]
fn most_relaxations_of_several_speeds_are_held() {
    let count = cases(1, MOST);
    let held: usize = held_in(count, &[1.0, 10.0, 100.0]).iter().sum();
    let least = if count < MOST { 0.75 } else { 0.93 };
    assert!(held as f64 >= least * 4.0 * count as f64, "{held}");
}

#[test]
fn a_relaxation_needs_a_speed() {
    let document = document(0.05, 1.5e6, 0.3, 2.0, 1.0);
    let curve = curve_of(&document, 1);
    let start = document.set_all(&[
        ("material".to_owned(), "(modulus: 1.0e6)".to_owned()),
        ("loading_speed".to_owned(), "None".to_owned()),
    ]);
    let free: [Free; 2] = ["work", "relaxation_share"].map(|one| one.parse().unwrap());
    let refused = asperity_experiment::Fit::of(&start.unwrap())
        .free(free[0])
        .free(free[1])
        .run(&curve, asperity_data::Control::default())
        .unwrap_err();
    assert!(refused.to_string().contains("loading_speed"), "{refused}");
}
