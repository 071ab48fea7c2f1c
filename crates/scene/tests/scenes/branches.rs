//! Figures of one path of the body, however the path is cut into stages.

use super::body::*;
use asperity_contact::Figures;
use asperity_contact::motion::MovingBody;
use asperity_contact::{Direction, Edges, History, Move, StageRecord};
use asperity_scene::{Outcome, Regime, Simulation, open};
use proptest::prelude::*;

/// A scene with this loading.
fn loaded(scene: &str, loading: &str) -> Outcome {
    let document = open(scene).unwrap().set("loading", loading).unwrap();
    Simulation::default().compute(document.scene()).unwrap()
}

/// One path in several cuts, several cycles, and paths that end in contact.
#[test]
fn figures_are_of_the_last_unloading_and_of_its_own_preload() {
    let [whole, smaller] = [1e-5, 5e-6].map(|force| {
        loaded(
            "pressure-sensitive",
            &format!("[ToForce({force:e}), ToSeparation]"),
        )
    });
    let after = |loading: &str| loaded("pressure-sensitive", loading);
    for cut in [
        "[ToForce(1e-5), ToTouch, ToSeparation]",
        "[ToForce(1e-5), ToIndentation(4.2e-7), ToSeparation]",
        "[ToForce(1e-5), ToZeroForce, ToForce(-1e-6), ToSeparation]",
        "[ToTouch, ToForce(1e-6), ToForce(1e-5), ToSeparation, ToIndentation(-1e-5)]",
        "[ToForce(1e-5), ToIndentation(4.2e-7), ToIndentation(4.2e-7), ToSeparation, ToIndentation(-1e-6)]",
        // What comes after the pull-off, and what came before a separation.
        "[ToForce(1e-5), ToSeparation, ToForce(2e-5)]",
        "[ToForce(2e-5), ToSeparation, ToForce(1e-5), ToSeparation]",
        // Minor loops.
        "[ToForce(1e-5), ToForce(2e-6), ToForce(8e-6), ToSeparation]",
    ] {
        let cut_up = after(cut);
        let of = |outcome: &Outcome| Figures {
            dissipated_energy: None,
            ..outcome.figures
        };
        assert_eq!(of(&cut_up), of(&whole), "{cut}");
        assert_eq!(cut_up.regime, whole.regime, "{cut}");
    }
    let twice = after("[ToForce(2e-5), ToSeparation, ToForce(5e-6), ToSeparation]");
    assert_eq!(
        twice.figures.adhesion_coefficient,
        smaller.figures.adhesion_coefficient
    );
    assert_eq!(whole.regime, Some(Regime::PressureSensitive));
    // An unloading that ends in contact has a pull-off only if it passes it, in any number of
    // stages.
    let least = whole.figures.pull_off_indentation.unwrap();
    let held = |share: f64| {
        let stages = [1.05, 1.01, share].map(|share| format!("ToIndentation({:e})", share * least));
        after(&format!("[ToForce(1e-5), {}]", stages.join(", "))).figures
    };
    assert_eq!(held(1.001).pull_off_force, None);
    assert_eq!(held(0.999).pull_off_force, whole.figures.pull_off_force);
    assert_eq!(held(0.999).preload, whole.figures.preload);
}

/// Forces and indentations of a history: F_n, F_a, and where they are.
fn figures(stages: &[StageRecord]) -> [Option<f64>; 4] {
    let found = Figures::of(&History {
        stages: stages.to_vec(),
        ..History::default()
    });
    [
        found.preload,
        found.pull_off_force,
        found.preload_indentation,
        found.pull_off_indentation,
    ]
}

/// True for figures of the same bits, or but for `slack`, of forces in N and of indentations in m.
fn agree(one: &[StageRecord], other: &[StageRecord], slack: [f64; 2]) -> bool {
    let slack = [slack[0], slack[0], slack[1], slack[1]];
    figures(one)
        .into_iter()
        .zip(figures(other))
        .zip(slack)
        .all(|pair| match pair {
            ((Some(one), Some(other)), slack) => {
                one.to_bits() == other.to_bits() || (one - other).abs() <= slack
            }
            ((one, other), _) => one == other,
        })
}

proptest! {
    #![proptest_config(cases(1500))]

    /// A path is cut where it passes indentations, and where it first reaches forces.
    #[test]
    fn figures_do_not_depend_on_how_a_path_is_cut(
        body in bodies(120),
        turns in indentations(7),
        ends_separated in any::<bool>(),
        shares in prop::collection::vec((0.0..=1.0_f64, 0.0..=1.0_f64, any::<prop::sample::Index>()), 7),
        samples in prop_oneof![Just(2_usize), 2_usize..600],
    ) {
        let mut targets = to_indentations(&turns);
        targets.extend(ends_separated.then_some(Move::ToSeparation));
        let (mut whole, mut by_indentation, mut by_force) = (body.on(33), body.on(samples), body.on(samples));
        let (mut stages, mut cuts, mut force_cuts) = (Vec::new(), Vec::new(), Vec::new());
        for (&target, (one, other, at)) in targets.iter().zip(shares.iter().cycle()) {
            let from = whole.point().indentation;
            let record = whole.advance(target).unwrap();
            let loads = record.direction == Direction::Loading;
            // The separation is at the last contact.
            let to = record.end();
            let mut on_way = [*one, *other].map(|share| from + share * (to - from));
            on_way.sort_by(|a, b| if loads { a.total_cmp(b) } else { b.total_cmp(a) });
            for at in on_way.into_iter().filter(|&at| loads || at > to) {
                cuts.push(by_indentation.advance(Move::ToIndentation(at)).unwrap());
            }
            cuts.push(by_indentation.advance(target).unwrap());
            let (force, here) = (at.get(&record.curve).force, by_force.point());
            // By more than rounding, which would turn the body back.
            let by = if loads { force - here.force } else { here.force - force };
            let is_on_way = by > 1e-9 * body.force_scale();
            if is_on_way && (here.springs > 0 || force >= 0.0) {
                // The smallest force may be out of reach by a rounding.
                force_cuts.extend(by_force.advance(Move::ToForce(force)));
            }
            force_cuts.push(by_force.advance(target).unwrap());
            stages.push(record);
        }
        // Between springs the force is stationary at its extremes: their place is known to the root
        // of a rounding.
        let rounding = [1e-13 * body.scales()[0], 1e-6 * (1.3 + body.largest_stretch())];
        let exact = if body.edges == Edges::Grid { [0.0; 2] } else { rounding };
        prop_assert!(agree(&stages, &cuts, exact), "{:?}: {:?} {:?}", turns, figures(&stages), figures(&cuts));
        prop_assert!(
            agree(&stages, &force_cuts, rounding),
            "{:?}: {:?} {:?}", turns, figures(&stages), figures(&force_cuts)
        );
    }
}
