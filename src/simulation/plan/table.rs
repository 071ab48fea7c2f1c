//! Stages of a computation: the fields that require each, and its cost. The only list of all stages.

use super::call::{Call, Called, HEIGHT, StageCost};
use crate::analysis::Figures;
use crate::scene::Effect;
use serde::Serialize;

/// Bytes per spring: its indentation of attachment or detachment.
const THRESHOLD: u64 = 8;
/// Bytes per spring of the passes: thresholds of a quarter of the springs, and runs of the present stage and of the
/// one before. Runs are few except with almost no adhesion.
const PASSED: u64 = 12;
/// Bytes per spring of the stepwise solver: its threshold and its contact.
const RELAXED: u64 = THRESHOLD + 1;
/// Bytes per spring of a profile with modes up to Nyquist's: a quarter of the springs are local maxima of the gap,
/// with a node and two turning points each, and each fourth spring has two sums.
const NODE: u64 = 20;

/// Reasons to skip several stages.
const NO_ADHESION: &str = "no adhesion: each spring touches and leaves at its own gap";
const STEPWISE: &str = "solver: Stepwise";
const NEVER_BACK: &str = "loading never goes back";

/// A stage of the computation of a curve from a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stage {
    /// Adding the macroscopic form.
    Form,
    /// Drawing random phases and transforming them into a profile.
    Synthesis,
    /// Reading a measured profile.
    MeasuredProfile,
    /// Building the tree of the gaps.
    Tree,
    /// Evaluating the rule of Hess.
    RuleOfHess,
    /// Runs of stages that load.
    LoadingPass,
    /// Runs of stages that unload.
    UnloadingPass,
    /// Steps and relaxation sweeps.
    Relaxation,
    /// The loop with its turning point at first touch, for F_a(0) and the regime.
    ZeroLoadAdhesion,
    /// The list of contact patches.
    Fragments,
    /// The histogram of heights.
    HeightHistogram,
}

impl Stage {
    /// Name of the stage in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        TABLE.iter().find(|row| row.stage == self).map_or("", |row| row.name)
    }
}

/// A stage: its name, the fields that require it, and its cost if one does.
pub(super) struct Row {
    pub stage: Stage,
    pub name: &'static str,
    pub called: fn(&Call<'_>) -> Called,
    pub cost: fn(&Call<'_>) -> StageCost,
}

/// All stages, in the order of execution.
pub(super) const TABLE: [Row; 11] = [
    Row {
        stage: Stage::Form,
        name: "form",
        called: |call| match call.scene.form {
            None => Called::Not("no form: nominally flat"),
            Some(form) if form.flat_end().is_some() => Called::For("form: the springs under the punch"),
            Some(_) => Called::For("form"),
        },
        cost: |call| call.passes(Some(1), 0),
    },
    Row {
        stage: Stage::Synthesis,
        name: "random profile",
        called: |call| match (call.is_synthesised(), call.is_measured()) {
            (true, true) => Called::For("roughness: Measured, its equivalent line"),
            (true, false) => Called::For("roughness: SelfAffine"),
            (_, true) => Called::Not("roughness: Measured, as the line"),
            _ => Called::Not("no roughness: smooth"),
        },
        cost: |call| {
            let mut cost = call.passes_over(call.points, Some(1), HEIGHT + transform(call.points));
            cost.bytes = cost.bytes.saturating_add(convolution(call.points));
            cost
        },
    },
    Row {
        stage: Stage::MeasuredProfile,
        name: "measured profile",
        called: |call| match (call.is_measured(), call.is_synthesised()) {
            (true, _) => Called::For("roughness: Measured"),
            (_, true) => Called::Not("roughness: SelfAffine"),
            _ => Called::Not("no roughness: smooth"),
        },
        cost: |call| call.passes_over(call.points, Some(1), HEIGHT),
    },
    Row {
        stage: Stage::Tree,
        name: "contact tree",
        called: adhesion_solved_exactly,
        cost: |call| call.passes(Some(1), NODE),
    },
    Row {
        stage: Stage::RuleOfHess,
        name: "rule of Hess",
        called: |call| Called::when(call.adhesive, "adhesion", "no adhesion: nothing is stretched"),
        cost: |_| StageCost::NOTHING,
    },
    Row {
        stage: Stage::LoadingPass,
        name: "loading passes",
        called: adhesion_solved_exactly,
        cost: |call| call.passes(None, PASSED),
    },
    Row {
        stage: Stage::UnloadingPass,
        name: "unloading passes",
        called: |call| match (call.pulls, call.adhesive, call.exact) {
            (false, ..) => Called::Not(NEVER_BACK),
            (true, false, _) => Called::Not(NO_ADHESION),
            (true, true, false) => Called::Not(STEPWISE),
            (true, true, true) => Called::For("loading goes back"),
        },
        cost: |call| call.passes(None, 0),
    },
    Row {
        stage: Stage::Relaxation,
        name: "stepwise relaxation",
        called: |call| Called::when(!call.exact, STEPWISE, "solver: Exact"),
        cost: |call| call.passes(None, RELAXED),
    },
    Row {
        stage: Stage::ZeroLoadAdhesion,
        name: "zero-load adhesion and regime",
        called: |call| match (call.adhesive, call.pulls, Figures::is_touch_protocol(call.scene)) {
            (false, ..) => Called::Not("no adhesion: non-adhesive"),
            (true, false, _) => Called::Not(NEVER_BACK),
            (true, true, true) => Called::Not("the loading itself turns at first touch"),
            (true, true, false) => Called::For("adhesion with a loading that goes back"),
        },
        cost: |call| if call.exact { call.passes(Some(1), 0) } else { call.passes(None, RELAXED) },
    },
    Row {
        stage: Stage::Fragments,
        name: "contact fragments",
        called: |call| observed(call, Effect::Fragments, "observe: Fragments"),
        cost: |call| call.passes(Some(call.scene.loading.len() as u64), 0),
    },
    Row {
        stage: Stage::HeightHistogram,
        name: "height histogram",
        called: |call| observed(call, Effect::HeightHistogram, "observe: HeightHistogram"),
        cost: |call| call.passes(Some(1), 0),
    },
];

fn adhesion_solved_exactly(call: &Call<'_>) -> Called {
    let reason = if call.adhesive { STEPWISE } else { NO_ADHESION };
    Called::when(call.exact && call.adhesive, "adhesion with the exact solver", reason)
}

fn observed(call: &Call<'_>, effect: Effect, field: &'static str) -> Called {
    Called::when(effect.is_on(call.scene), field, "not in observe")
}

/// Largest prime factor of a number of springs that the Fourier transform handles directly.
const LARGEST_FACTOR: u64 = 31;

/// Bytes per spring of the transform's coefficients, scratch space and twiddle factors, as measured. Odd numbers of
/// springs transform at twice the length.
fn transform(points: u64) -> u64 {
    if points.is_multiple_of(2) { 20 } else { 56 }
}

/// Bytes of the convolution that transforms a large prime factor, as measured.
fn convolution(points: u64) -> u64 {
    let factor = largest_prime_factor(points);
    if factor > LARGEST_FACTOR { 152 * factor } else { 0 }
}

fn largest_prime_factor(mut number: u64) -> u64 {
    let (mut factor, mut largest) = (2, 1);
    while factor * factor <= number {
        if number.is_multiple_of(factor) {
            number /= factor;
            largest = factor;
        } else {
            factor += 1;
        }
    }
    largest.max(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_stage_is_once_in_the_table() {
        for (index, row) in TABLE.iter().enumerate() {
            assert_eq!(row.stage as usize, index, "{}", row.name);
            assert_eq!(row.stage.name(), row.name);
        }
    }

    #[test]
    fn the_largest_prime_factor_is_found() {
        for (number, factor) in [
            (1, 1),
            (2, 2),
            (3, 3),
            (1 << 28, 2),
            (1_048_583, 1_048_583),
            (2 * 524_287, 524_287),
            (121, 11),
            (90, 5),
        ] {
            assert_eq!(largest_prime_factor(number), factor, "{number}");
        }
    }
}
