//! Storms of random input, drawn from the table of fields: texts of scenes, overrides, profiles, plans, and the runs of
//! the allowed ones.
//!
//! `TEST_EFFORT=800 cargo test --test fuzz storm` draws 800 times as many; `PROPTEST_RNG_SEED=7` draws others.

mod plans;
mod profiles;
mod runs;
#[allow(dead_code, reason = "unit tests of the scene use the rest")]
#[path = "../common/strategies.rs"]
mod strategies;
mod texts;

use super::{effort::cases, properties};
// For the strategies, which use the names of the scene module.
use asperity::scene::{
    DEFAULT, Document, FIELDS, Field, LEG_FORCE, LEG_INDENTATION, Range, Scene, find, is_control, ron_float,
    ron_string,
};
use proptest::prelude::*;
use strategies::Drawn;

/// Most springs of a computed line.
const MOST_POINTS: u64 = 2000;

/// Draws of a quick run, times the effort.
fn draws(quick: u32) -> ProptestConfig {
    ProptestConfig {
        cases: cases(quick),
        failure_persistence: None,
        max_local_rejects: u32::MAX,
        max_global_rejects: u32::MAX,
        ..ProptestConfig::default()
    }
}

/// Whole numbers from `min` to `max`, all orders of magnitude alike, as text.
fn whole(min: u64, max: u64) -> BoxedStrategy<String> {
    ((min as f64).ln()..=(max as f64).ln()).prop_map(|log| log.exp().round().to_string()).boxed()
}

/// Scenes of all kinds that are computed in milliseconds.
fn quick() -> Drawn {
    let modes = (whole(1, 300), 0_u64..300);
    Drawn::default()
        .narrowed("numerics.points", whole(1, MOST_POINTS))
        .narrowed("numerics.samples", whole(2, 40))
        .narrowed("numerics.solver", Just("Exact".to_string()).boxed())
        .narrowed(
            "roughness.modes",
            modes
                .prop_map(|(first, more)| {
                    format!("({first}, {})", first.parse::<u64>().map_or(0, |k| k + more))
                })
                .boxed(),
        )
        .narrowed("roughness.file", Just(format!("{:?}", profiles::FILE)).boxed())
}
