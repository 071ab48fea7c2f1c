//! Relaxation of the half-space in a scene: what it asks for, what it refuses, and what it gives.

use asperity_scene::{Document, Simulation, open};

const RELAXATION: &str = "(share: 0.2, time: 10.0)";

fn relaxing() -> Document {
    let sphere = open("jkr-sphere").unwrap();
    let sphere = sphere.set("numerics.points", "1024").unwrap();
    let moving = sphere.set("loading_speed", "2.0e-8").unwrap();
    moving.set("material.relaxation", RELAXATION).unwrap()
}

#[test]
fn the_force_falls_in_a_rest_and_the_pull_off_is_larger_after_it() {
    let pull_off = |loading: &str| {
        let scene = relaxing().set("loading", loading).unwrap();
        let outcome = Simulation::default().compute(scene.scene()).unwrap();
        assert_eq!(
            (outcome.regime, outcome.smooth_pull_off_force),
            (None, None)
        );
        let stages = &outcome.history.stages;
        assert!(
            stages
                .iter()
                .all(|stage| stage.seconds.len() == stage.curve.len())
        );
        outcome
    };
    let without = pull_off("[ToForce(1.0e-5), ToSeparation]");
    let with = pull_off("[ToForce(1.0e-5), Hold(100.0), ToSeparation]");
    let rest = &with.history.stages[1];
    let [first, last] = [rest.curve[0], rest.curve[rest.curve.len() - 1]];
    assert!(last.force < first.force && last.indentation == first.indentation);
    assert!(with.figures.pull_off_force > without.figures.pull_off_force);
}

#[test]
fn a_rest_without_relaxation_does_nothing() {
    let sphere = open("jkr-sphere").unwrap();
    let sphere = sphere.set("numerics.points", "1024").unwrap();
    let force = |loading: &str| {
        let scene = sphere.set("loading", loading).unwrap();
        let outcome = Simulation::default().compute(scene.scene()).unwrap();
        outcome.figures.pull_off_force
    };
    assert_eq!(
        force("[ToForce(1.0e-5), Hold(10.0), ToSeparation]"),
        force("[ToForce(1.0e-5), ToSeparation]")
    );
}

#[test]
fn what_relaxation_does_not_allow_is_refused_with_a_remedy() {
    let document = relaxing();
    for (path, value, words) in [
        (
            "loading_speed",
            "None",
            "relaxation needs the speed of the loading: loading_speed",
        ),
        (
            "numerics.edges",
            "Grid",
            "relaxation needs edges between springs: edges: SubCell",
        ),
        (
            "loading",
            "[ToForce(1.0e-5), ToSeparation, ToForce(1.0e-5)]",
            "the surface has not recovered after the separation",
        ),
        ("loading", "[ToForce(1.0e-5), Hold(-1.0)]", "time of hold"),
        (
            "material.relaxation",
            "(share: 1.0, time: 1.0)",
            "share that relaxes",
        ),
    ] {
        let refused = document.set(path, value).unwrap_err().to_string();
        assert!(refused.contains(words), "{path}: {refused}");
    }
    let stepwise = document.set_all(&[
        ("numerics.edges".to_owned(), "Grid".to_owned()),
        (
            "numerics.solver".to_owned(),
            "Stepwise(step: 1.0e-9)".to_owned(),
        ),
    ]);
    let refused = stepwise.unwrap_err().to_string();
    assert!(
        refused.contains("the stepwise solver has no time"),
        "{refused}"
    );
    // A loading after springs have detached is refused when it is computed.
    let scene = document.set(
        "loading",
        "[ToForce(1.0e-5), ToForce(-2.0e-5), ToForce(1.0e-5)]",
    );
    let refused = Simulation::default().compute(scene.unwrap().scene());
    let words = refused.map(|_| ()).unwrap_err().to_string();
    assert!(words.contains("has not recovered"), "{words}");
    let map = Simulation::default().reversal_map(document.scene(), None, 8, &|| false);
    let words = map.map(|_| ()).unwrap_err().to_string();
    assert!(words.contains("need an elastic foundation"), "{words}");
}
