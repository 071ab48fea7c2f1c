//! Parts of the computation of a scene, the fields that require them, and their costs. A run
//! follows this plan.

use crate::scene::checked::CheckedScene;
use crate::scene::effects::Effect;
use crate::scene::model::{Observer, Roughness, Scene, Solver};
use asperity_contact::{CurvePoint, Edges};
use serde::Serialize;

/// Bytes per spring of the heights of the roughness or the gaps of the profile.
const HEIGHT: u64 = 8;
/// Bytes per spring of the contact tree for modes up to the Nyquist wave number. A quarter of the
/// springs are then local maxima of the gap, each with a node and two turning points. Every fourth
/// spring has two sums.
const NODE: u64 = 20;
/// Bytes per spring for finding events: thresholds of a quarter of the springs, and runs of the
/// present and the previous stage. Runs are few except with almost no adhesion.
const PASSED: u64 = 12;
/// Bytes per spring of the stepwise solver: its threshold and its state of contact.
const RELAXED: u64 = 9;
/// Bytes per curve point of the present loading stage besides the curve, as measured. The second
/// number is for edges between springs, whose contributions are also summed for each point.
const SAMPLED: u64 = 64;
const SAMPLED_WITH_EDGES: u64 = 120;
/// Largest prime factor of a number of springs that the Fourier transform handles directly.
const LARGEST_FACTOR: u64 = 31;

/// Reasons why several parts of the computation are skipped.
const NO_ADHESION: &str = "no adhesion: each spring touches and leaves at its own gap";
const STEPWISE: &str = "solver: Stepwise";
const NEVER_BACK: &str = "loading never goes back";

/// Part of the computation from a scene to its force curve. The variants are in the order of
/// execution. These parts are not the stages of the loading, which
/// [`Scene::loading`](crate::Scene::loading) has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stage {
    /// Addition of the macroscopic form to the profile.
    Form,
    /// Random phases and their Fourier transform, which give a random profile.
    Synthesis,
    /// Reading of the files of a measured surface.
    MeasuredProfile,
    /// Contact tree: the tree of the gaps from which the exact solver finds where patches form,
    /// merge, split and detach.
    Tree,
    /// Rule of Hess, which limits how far the springs of a contact patch may be stretched.
    RuleOfHess,
    /// Search for the indentations at which patches form and merge during loading.
    LoadingPass,
    /// Search for the indentations at which patches split and detach during unloading.
    UnloadingPass,
    /// Steps of the stepwise solver. In each step the body moves, then springs attach and detach
    /// until no further one does.
    Relaxation,
    /// Two loops, of which one turns at first touch and one at zero force. They give F_a(d=0),
    /// F_a(F=0) and the regimes.
    WithoutPreload,
    /// List of the contact patches at the end of each loading stage.
    Fragments,
    /// Histogram of the heights of the profile.
    HeightHistogram,
}

#[rustfmt::skip]
impl Stage {
    const NAMES: [&str; 11] = [
        "form", "random profile", "measured profile", "contact tree", "rule of Hess", "loading passes",
        "unloading passes", "stepwise relaxation", "adhesion without preload", "contact patches",
        "height histogram",
    ];

    /// Returns the name of this part in words, such as `contact tree`.
    pub fn name(self) -> &'static str {
        Stage::NAMES[self as usize]
    }
}

/// Part of the computation of a scene in a [`Workload`], with its passes and its memory.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PlannedStage {
    /// Part of the computation.
    pub stage: Stage,
    /// True if the scene needs this part.
    pub runs: bool,
    /// Name of the field that requires this part, or the reason why it is skipped.
    pub because: &'static str,
    /// Number of passes: how often this part goes through the profile or its contact tree. `None`
    /// if the number depends on the loading stages.
    pub passes: Option<u64>,
    /// Upper bound of the number of springs that all passes together visit; `None` if the number of
    /// passes is unknown.
    pub springs_touched: Option<u64>,
    /// Memory in bytes of the arrays that this part adds.
    pub bytes: u64,
}

/// Plan of the computation of a scene: the parts of the computation in the order of execution, and
/// the memory that they need.
///
/// ```
/// use asperity_scene::stages::{Stage, Workload};
/// use asperity_scene::open;
///
/// // Without adhesion there is no contact tree.
/// let bare = open("jkr-sphere")?.set("adhesion", "None")?;
/// assert!(!Workload::of(bare.scene()).runs(Stage::Tree));
/// # Ok::<(), asperity_scene::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Workload {
    /// Number of springs under the body.
    pub springs: u64,
    /// Approximate peak memory of a run in bytes, without the program itself, measured files and
    /// lists of contact patches.
    pub peak_bytes: u64,
    /// Approximate largest resident memory of `asperity run` in bytes, with the program itself.
    pub resident_bytes: u64,
    /// All parts of the computation, including those that are skipped.
    pub stages: Vec<PlannedStage>,
}

impl Workload {
    /// Resident memory of the program in bytes after a small scene: code, tables and stacks.
    pub const PROGRAM: u64 = 14 << 20;

    /// Returns the plan of the computation of a scene.
    pub fn of(scene: &CheckedScene) -> Self {
        Workload::of_any(scene)
    }

    /// Plans the computation of a checked scene whose loading may have been replaced.
    pub(super) fn of_any(scene: &Scene) -> Self {
        let (points, springs) = (
            scene.numerics.points,
            scene.springs_under_body().count() as u64,
        );
        let stages = stages(scene, points, springs);
        let mut plan = Workload {
            springs,
            peak_bytes: 0,
            resident_bytes: 0,
            stages,
        };
        // At most, if the whole contact under load also exists at first touch.
        let solved = [
            Stage::Tree,
            Stage::LoadingPass,
            Stage::Relaxation,
            Stage::WithoutPreload,
        ];
        let between =
            scene.numerics.edges == Edges::SubCell && scene.numerics.solver == Solver::Exact;
        let sampled = if between { SAMPLED_WITH_EDGES } else { SAMPLED };
        let curves =
            scene.numerics.samples * scene.loading.len() as u64 * size_of::<CurvePoint>() as u64
                + scene.numerics.samples.saturating_mul(sampled);
        let contact =
            HEIGHT * springs + solved.map(|stage| plan.bytes(stage)).iter().sum::<u64>() + curves;
        // The profile is made before the contact is solved: the larger of both amounts of memory.
        let heights = if Effect::Roughness.is_on(scene) {
            HEIGHT * points
        } else {
            0
        };
        plan.peak_bytes = (heights + contact).max(plan.bytes(Stage::Synthesis));
        plan.resident_bytes = Workload::PROGRAM + contact.max(plan.bytes(Stage::Synthesis));
        plan
    }

    /// Returns true if the scene needs this part.
    pub fn runs(&self, stage: Stage) -> bool {
        self.stages
            .iter()
            .any(|planned| planned.stage == stage && planned.runs)
    }

    fn bytes(&self, stage: Stage) -> u64 {
        self.stages
            .iter()
            .find(|planned| planned.stage == stage)
            .map_or(0, |planned| planned.bytes)
    }

    /// Returns the memory in bytes of the parts that make the profile.
    pub(super) fn line_bytes(&self) -> u64 {
        HEIGHT * self.springs
            + self
                .bytes(Stage::Synthesis)
                .max(self.bytes(Stage::MeasuredProfile))
    }
}

fn stages(scene: &Scene, points: u64, springs: u64) -> Vec<PlannedStage> {
    let (adhesive, pulls) = (
        Effect::Adhesion.is_on(scene),
        Effect::Unloading.is_on(scene),
    );
    let exact = scene.numerics.solver == Solver::Exact;
    let (measured, random) = (
        matches!(scene.roughness, Some(Roughness::Measured { .. })),
        scene.seed().is_some(),
    );
    // Field that requires the stage or reason for skipping it, number of passes, springs of each
    // pass, bytes.
    let row = |stage, because: Result<_, _>, (passes, springs): (Option<u64>, u64), bytes| {
        let runs = because.is_ok();
        let (passes, bytes) = if runs { (passes, bytes) } else { (Some(0), 0) };
        let springs_touched = passes.map(|passes| passes.saturating_mul(springs));
        let because = because.unwrap_or_else(|reason| reason);
        PlannedStage {
            stage,
            runs,
            because,
            passes,
            springs_touched,
            bytes,
        }
    };
    let when = |does: bool, field, reason| if does { Ok(field) } else { Err(reason) };
    let (once, each_stage, line) = ((Some(1), springs), (None, springs), (Some(1), points));
    let solver = if adhesive { STEPWISE } else { NO_ADHESION };
    let solved = when(exact && adhesive, "adhesion with the exact solver", solver);
    let form = match &scene.form {
        None => Err("no form: nominally flat"),
        Some(form) if form.flat_end().is_some() => Ok("form: the springs under the punch"),
        Some(_) => Ok("form"),
    };
    let synthesis = match (random, measured) {
        (true, true) => Ok("roughness: Measured, its equivalent line"),
        (true, false) => Ok("roughness: SelfAffine"),
        (false, true) => Err("roughness: Measured, as the line"),
        (false, false) => Err("no roughness: smooth"),
    };
    // Coefficients, scratch space and twiddle factors, as measured. Odd numbers of springs
    // transform at twice the length.
    let transform = points * (HEIGHT + if points.is_multiple_of(2) { 20 } else { 56 });
    // The convolution that transforms a large prime factor, as measured.
    let factor = largest_prime_factor(points);
    let convolution = if factor > LARGEST_FACTOR {
        152 * factor
    } else {
        0
    };
    let file = if random {
        "roughness: SelfAffine"
    } else {
        "no roughness: smooth"
    };
    let unloading = match (pulls, adhesive, exact) {
        (false, ..) => Err(NEVER_BACK),
        (true, false, _) => Err(NO_ADHESION),
        (true, true, false) => Err(STEPWISE),
        (true, true, true) => Ok("loading goes back"),
    };
    let without_preload = match (adhesive, pulls) {
        (false, _) => Err("no adhesion: non-adhesive"),
        (true, false) => Err(NEVER_BACK),
        (true, true) => Ok("adhesion with a loading that goes back"),
    };
    let hess = when(adhesive, "adhesion", "no adhesion: nothing is stretched");
    let observed =
        |observer, field| when(scene.observe.contains(&observer), field, "not in observe");
    let fragments = observed(Observer::Fragments, "observe: Fragments");
    let histogram = observed(Observer::HeightHistogram, "observe: HeightHistogram");
    let (touch, touch_bytes) = if exact {
        ((Some(2), springs), 0)
    } else {
        (each_stage, RELAXED * springs)
    };
    // F_smooth of a form without a closed form takes springs of its own.
    let has_smooth = scene.roughness.is_some()
        && scene
            .form
            .as_ref()
            .is_some_and(|form| form.flat_end().is_none() && form.power_law().is_none());
    let smooth_bytes = if has_smooth {
        (HEIGHT + NODE) * springs
    } else {
        0
    };
    vec![
        row(Stage::Form, form, once, 0),
        row(Stage::Synthesis, synthesis, line, transform + convolution),
        row(
            Stage::MeasuredProfile,
            when(measured, "roughness: Measured", file),
            line,
            HEIGHT * points,
        ),
        row(Stage::Tree, solved, once, NODE * springs),
        row(Stage::RuleOfHess, hess, (Some(0), springs), 0),
        row(Stage::LoadingPass, solved, each_stage, PASSED * springs),
        row(Stage::UnloadingPass, unloading, each_stage, 0),
        row(
            Stage::Relaxation,
            when(!exact, STEPWISE, "solver: Exact"),
            each_stage,
            RELAXED * springs,
        ),
        row(
            Stage::WithoutPreload,
            without_preload,
            touch,
            touch_bytes + smooth_bytes,
        ),
        row(
            Stage::Fragments,
            fragments,
            (Some(scene.loading.len() as u64), springs),
            0,
        ),
        row(Stage::HeightHistogram, histogram, once, 0),
    ]
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
    fn each_stage_is_planned_and_has_its_name() {
        let planned = Workload::of(crate::scene::open::open("jkr-sphere").unwrap().scene()).stages;
        let names: Vec<_> = planned.iter().map(|planned| planned.stage.name()).collect();
        assert_eq!(names, Stage::NAMES);
    }

    #[test]
    fn the_largest_prime_factor_is_found() {
        let large = [(1 << 28, 2), (1_048_583, 1_048_583), (2 * 524_287, 524_287)];
        for (number, factor) in
            large
                .into_iter()
                .chain([(1, 1), (2, 2), (3, 3), (121, 11), (90, 5)])
        {
            assert_eq!(largest_prime_factor(number), factor, "{number}");
        }
    }
}
