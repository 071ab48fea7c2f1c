//! Laws for both kinds of edges not covered by the tests of one kind: stronger adhesion holds more, and
//! units are arbitrary.

use super::body::{Body, end};
use asperity::contact::Foundation;
use asperity::scene::{Edges, Move};
use proptest::prelude::*;

fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

fn edges() -> impl Strategy<Value = Edges> {
    prop_oneof![Just(Edges::Grid), Just(Edges::SubCell)]
}

/// Turning points as shares of the range of a body.
fn shares() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(0.0..1.0_f64, 1..6)
}

/// From separation to full contact.
fn legs(body: &Body, shares: &[f64]) -> Vec<Move> {
    let (low, high) = (-body.largest_stretch(), 1.1 * body.deepest() + 1e-3 * body.largest_stretch());
    shares.iter().map(|share| Move::ToIndentation(low + share * (high - low))).collect()
}

fn springs(body: &Body, edges: Edges, legs: &[Move]) -> Vec<usize> {
    let contacts = body.history(edges, legs, 2).unwrap().contacts;
    contacts.iter().flat_map(|&(first, last)| first..=last).collect()
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn stronger_adhesion_holds_more(
        seed in 1000_u64..1_000_000, edges in edges(), shares in shares(), factor in 1.0..30.0_f64,
    ) {
        let body = Body::random(seed);
        let stronger = Body { work: factor * body.work, ..body.clone() };
        let legs = legs(&body, &shares);
        let (less, more) = (springs(&body, edges, &legs), springs(&stronger, edges, &legs));
        prop_assert!(less.iter().all(|spring| more.binary_search(spring).is_ok()), "{:?}", legs);
    }

    #[test]
    fn units_are_arbitrary(
        seed in 1000_u64..1_000_000, edges in edges(), shares in shares(),
        length in -9.0..9.0_f64, height in -9.0..9.0_f64, stress in -9.0..9.0_f64,
    ) {
        let [length, height, stress] = [length, height, stress].map(|power| 10.0_f64.powf(power));
        let body = Body::random(seed);
        let Foundation { spacing, effective_modulus, .. } = body.foundation;
        let scaled = Body {
            gaps: body.gaps.iter().map(|gap| height * gap).collect(),
            foundation: Foundation::endless(length * spacing, stress * effective_modulus),
            work: body.work * height * height / length * stress,
        };
        let legs = legs(&body, &shares);
        let higher: Vec<Move> = legs.iter().map(|leg| match *leg {
            Move::ToIndentation(to) => Move::ToIndentation(height * to),
            other => other,
        }).collect();
        let (one, other) =
            (body.history(edges, &legs, 2).unwrap(), scaled.history(edges, &higher, 2).unwrap());
        // For an event at a turning point to rounding, either contact is right.
        let slight = |factor: f64| {
            let body = Body { work: factor * body.work, ..body.clone() };
            springs(&body, edges, &legs)
        };
        prop_assume!(slight(1.0 + 1e-11) == slight(1.0 - 1e-11));
        prop_assert_eq!(&one.contacts, &other.contacts);
        let scale = body.force_scale() * (1.0 + shares.len() as f64);
        // An edge about to run away amplifies a rounding.
        let steep = {
            let of = |factor: f64| Body { work: factor * body.work, ..body.clone() }.history(edges, &legs, 2);
            let [more, less] = [1.0 + 1e-11, 1.0 - 1e-11].map(|f| end(of(f).unwrap().legs.last().unwrap()));
            (more.force - less.force).abs()
        };
        let (a, b) = (end(one.legs.last().unwrap()), end(other.legs.last().unwrap()));
        let error = (a.force - b.force / (length * height * stress)).abs();
        prop_assert!(error <= 1e-14 * scale + steep, "{:?} {:?}", a, b);
    }
}
