//! Plan of the computation of a scene: its parts, the fields that require them, and their costs.
//! The computation follows this plan.

use crate::scene::checked::CheckedScene;
use crate::scene::effects::Effect;
use crate::scene::model::{Observer, Roughness, Scene, Solver};
use asperity_contact::{CurvePoint, Edges, Move, StageRecord};
use serde::Serialize;

/// Number of bytes for each spring, for the heights of the roughness or the gaps of the profile.
const HEIGHT: u64 = 8;
/// Number of bytes for each spring, for the contact tree with modes up to the Nyquist wave number.
/// With such modes a quarter of the springs are local maxima of the gap, each with a node and two
/// turning points. In addition, every fourth spring has two sums.
const NODE: u64 = 20;
/// Number of bytes for each spring, for finding events: thresholds of a quarter of the springs, and
/// the runs of the present and the previous part. A run is a patch over a range of indentations.
/// There are few runs unless the adhesion is very small.
const PASSED: u64 = 12;
/// Number of bytes for each spring, for the stepwise solver: the threshold and the state of contact
/// of the spring.
const STEPPED: u64 = 9;
/// Number of bytes for each spring, for a half-space that relaxes, as measured: the gap and the
/// memory of the spring, sums up to the spring, and the indentations at which it attaches and
/// detaches.
const REMEMBERED: u64 = 96;
/// Number of points of the force curve of a stage of a half-space that relaxes, as measured on
/// rough profiles. The number follows from the error of the steps and not from the samples.
const POINTS_OF_STEPS: u64 = 1024;
/// Number of bytes for each point of such a curve, for its time, the displacement of the drive and
/// the part of the energy that has not relaxed.
const TIMED: u64 = 24;
/// Number of bytes for each point of the force curve of the present loading stage, in addition to
/// the curve itself, as measured. The second constant is for edges between springs, whose
/// contributions are also summed at each point.
const SAMPLED: u64 = 64;
const SAMPLED_WITH_EDGES: u64 = 120;
/// Largest number of points besides the samples at which a stage is searched for its extreme force.
const SEARCHED: u64 = 256;
/// Number of bytes for each spring, as measured, for a search between two points of the curve. The
/// search finds where a compliant instrument loses the contact. In the worst case all springs
/// detach between the two points.
const DISPLACED: u64 = 320;
/// Number of bytes for each spring, as measured, for the events between two neighbouring points of
/// the curve. In the worst case all events lie between two points. With more points, fewer events
/// are sorted together, and less memory is needed.
const EVENTS_TOGETHER: u64 = 256;
/// Number of bytes for each spring of a rough profile without adhesion, for the gaps at which the
/// springs touch, as measured.
const TOUCHED: u64 = 20;
/// Number of bytes for each point of the curve that arrays reserve but do not use, as measured.
/// Arrays reserve such memory because they grow by doubling, but the system provides no memory for
/// bytes that are not used. The second constant is for a compliant instrument.
const RESERVED: u64 = 80;
const RESERVED_DISPLACED: u64 = 400;
/// Bytes of all small arrays together.
const SMALL_ARRAYS: u64 = 64 << 10;
/// Memory that freed arrays leave unused between the curves of many stages, divided by the memory
/// of the curves, as measured with the allocator of glibc. The process holds this memory, but no
/// array uses it.
const GAPS: f64 = 0.75;
/// If the curve of a stage has at least this size in bytes, the allocator requests memory for the
/// curve directly from the system. There is then no unused memory between the curves.
const LARGE_CURVE: u64 = 1 << 20;
/// Number of records of a loading stage for which memory is needed at the same time for each stage:
/// while the list of records grows, its former memory and new memory of twice the size both exist.
const RECORDS: u64 = 3;
/// If the number of springs has a prime factor above this limit, the Fourier transform needs a
/// convolution and more memory.
const LARGEST_FACTOR: u64 = 31;

/// Reasons why parts of the computation are skipped.
const NO_ADHESION: &str = "no adhesion: each spring touches and leaves at its own gap";
const STEPWISE: &str = "solver: Stepwise";
const ELASTIC: &str = "no relaxation: the half-space is elastic";
const RELAXES: &str = "material.relaxation: no loop without a preload";
const NEVER_BACK: &str = "loading never goes back";

/// Part of the computation from a scene to its force curve. The variants are in the order of
/// execution. A part of the computation is not a loading stage of the scene
/// ([`Scene::loading`](crate::Scene::loading)).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum WorkPart {
    /// Addition of the macroscopic form to the profile.
    Form,
    /// Random phases and their Fourier transform, which give a random profile.
    Synthesis,
    /// Reading of the files of a measured surface.
    MeasuredProfile,
    /// Construction of the contact tree, from which the exact solver finds where patches form,
    /// merge, split and detach.
    Tree,
    /// Application of the rule of Hess, which limits how far the springs of a contact patch may be
    /// stretched.
    RuleOfHess,
    /// Search for the indentations at which patches form and merge during loading.
    LoadingPass,
    /// Search for the indentations at which patches split and detach during unloading.
    UnloadingPass,
    /// Steps of the stepwise solver. In each step the body moves; then springs attach and detach
    /// until the contact does not change.
    Equilibrium,
    /// Steps in time of a half-space that relaxes, with a memory of each spring in contact.
    Relaxation,
    /// Two loadings without a preload: one ends at first touch and one at zero force. The loadings
    /// give two pull-off forces, F_a(d=0) and F_a(F=0), and the regimes.
    WithoutPreload,
    /// List of the contact patches at the end of each loading stage.
    Patches,
    /// Histogram of the heights of the profile.
    HeightHistogram,
}

#[rustfmt::skip]
impl WorkPart {
    const NAMES: [&str; 12] = [
        "form", "random profile", "measured profile", "contact tree", "rule of Hess", "loading passes",
        "unloading passes", "stepwise equilibrium", "relaxation", "adhesion without preload",
        "contact patches", "height histogram",
    ];

    /// Returns the name of this part for users, such as `contact tree`.
    pub fn name(self) -> &'static str {
        WorkPart::NAMES[self as usize]
    }
}

/// Part of the computation of a scene, as a [`Workload`] plans it, with its costs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PlannedPart {
    /// The part of the computation, such as the contact tree.
    pub part: WorkPart,
    /// True if the scene needs this part of the computation.
    pub runs: bool,
    /// Reason why this part of the computation is done or skipped: the name of the field that
    /// requires it, or words that state why it is skipped.
    pub because: &'static str,
    /// Number of times that this part of the computation passes over the profile or over the
    /// contact tree. `None` if this number depends on the loading stages.
    pub passes: Option<u64>,
    /// Upper bound of the number of springs that this part of the computation visits in all its
    /// passes. A spring counts again in each pass. `None` if the number of passes is unknown.
    pub springs_touched: Option<u64>,
    /// Memory in bytes of the arrays that this part of the computation adds.
    pub bytes: u64,
}

/// Plan of the computation of a scene: the parts of the computation in the order of execution, and
/// the memory that they need.
///
/// ```
/// use asperity_scene::workload::{WorkPart, Workload};
/// use asperity_scene::open;
///
/// // Without adhesion there is no contact tree.
/// let bare = open("jkr-sphere")?.set("adhesion", "None")?;
/// assert!(!Workload::of(bare.scene()).runs(WorkPart::Tree));
/// # Ok::<(), asperity_scene::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Workload {
    /// Number of springs under the body.
    pub springs: u64,
    /// Approximate largest memory of the computation in bytes. The memory of the program itself, of
    /// measured files and of lists of contact patches is not included.
    pub peak_bytes: u64,
    /// Approximate largest resident memory, in bytes, of the command `asperity run`, including the
    /// program itself.
    pub resident_bytes: u64,
    /// All parts of the computation, including those that are skipped.
    pub parts: Vec<PlannedPart>,
}

impl Workload {
    /// Resident memory of the program in bytes after the computation of a small scene: code, tables
    /// and stacks.
    pub const PROGRAM: u64 = 14 << 20;

    /// Returns the plan of the computation of a scene.
    pub fn of(scene: &CheckedScene) -> Self {
        Workload::of_any(scene)
    }

    /// Returns the plan of the computation of a scene. The scene must have been checked, but its
    /// loading may have been replaced since then.
    pub(super) fn of_any(scene: &Scene) -> Self {
        let points = scene.numerics.points;
        let springs = scene.springs_under_body().count() as u64;
        let planner = Planner {
            scene,
            points,
            springs,
            is_adhesive: Effect::Adhesion.is_on(scene),
            goes_back: Effect::Unloading.is_on(scene),
            is_exact: scene.numerics.solver == Solver::Exact,
            relaxes: scene.relaxes(),
            is_measured: matches!(scene.roughness, Some(Roughness::Measured { .. })),
            is_random: scene.seed().is_some(),
        };
        let mut plan = Workload {
            springs,
            peak_bytes: 0,
            resident_bytes: 0,
            parts: planner.parts(),
        };
        let history = bytes_of_history(scene);
        let contact = planner.bytes_of_contact(&plan, history);
        let searched = points_of_stage(scene).saturating_add(SEARCHED);
        let mut reserved = SMALL_ARRAYS.saturating_add(searched.saturating_mul(RESERVED));
        if planner.searches_for_the_instrument() {
            reserved = reserved.saturating_add(searched.saturating_mul(RESERVED_DISPLACED));
        }
        // The profile is made before the contact is solved, so the larger of the two amounts of
        // memory counts.
        let heights = if Effect::Roughness.is_on(scene) {
            HEIGHT * points
        } else {
            0
        };
        let synthesis = plan.bytes(WorkPart::Synthesis);
        let held = heights.saturating_add(contact).max(synthesis);
        plan.peak_bytes = held.saturating_add(reserved);
        let gaps = if history / LARGE_CURVE < scene.loading.len() as u64 {
            (GAPS * history as f64) as u64
        } else {
            0
        };
        let resident = contact.saturating_add(gaps).max(synthesis);
        plan.resident_bytes = Workload::PROGRAM.saturating_add(resident);
        plan
    }

    /// Returns true if the scene needs the part `part`.
    pub fn runs(&self, part: WorkPart) -> bool {
        self.parts
            .iter()
            .any(|planned| planned.part == part && planned.runs)
    }

    fn bytes(&self, part: WorkPart) -> u64 {
        self.parts
            .iter()
            .find(|planned| planned.part == part)
            .map_or(0, |planned| planned.bytes)
    }

    /// Returns the memory in bytes of those parts that make the profile.
    pub(super) fn line_bytes(&self) -> u64 {
        HEIGHT * self.springs
            + self
                .bytes(WorkPart::Synthesis)
                .max(self.bytes(WorkPart::MeasuredProfile))
    }
}

/// Returns the number of points of the force curve of a loading stage.
fn points_of_stage(scene: &Scene) -> u64 {
    if scene.relaxes() {
        POINTS_OF_STEPS
    } else {
        scene.numerics.samples
    }
}

/// Returns true if a motion under an instrument is searched for a displacement or for the loss of
/// the contact. A half-space that relaxes moves by steps, and is searched only for displacements.
fn searches_displacements(scene: &Scene) -> bool {
    let is_displacement = |stage: &Move| matches!(stage, Move::ToDisplacement(_));
    !scene.relaxes() || scene.loading.iter().any(is_displacement)
}

/// Returns the memory in bytes of the force curves of all loading stages.
fn bytes_of_history(scene: &Scene) -> u64 {
    let points = points_of_stage(scene) + StageRecord::FURTHER_POINTS as u64;
    let mut point = size_of::<CurvePoint>() as u64;
    if scene.relaxes() {
        point += TIMED;
    }
    let curve = points.saturating_mul(point);
    let stage = curve.saturating_add(RECORDS * size_of::<StageRecord>() as u64);
    stage.saturating_mul(scene.loading.len() as u64)
}

/// Field that requires a part of the computation (`Ok`), or the reason why the part is skipped
/// (`Err`).
type Because = Result<&'static str, &'static str>;

/// Costs of a part of the computation that is not skipped.
struct Work {
    /// Number of passes; `None` if it depends on the loading stages.
    passes: Option<u64>,
    /// Largest number of springs that one pass visits.
    springs: u64,
    /// Memory in bytes.
    bytes: u64,
}

impl PlannedPart {
    fn new(part: WorkPart, because: Because, work: Work) -> Self {
        match because {
            Ok(field) => PlannedPart {
                part,
                runs: true,
                because: field,
                passes: work.passes,
                springs_touched: work
                    .passes
                    .map(|passes| passes.saturating_mul(work.springs)),
                bytes: work.bytes,
            },
            Err(reason) => PlannedPart {
                part,
                runs: false,
                because: reason,
                passes: Some(0),
                springs_touched: Some(0),
                bytes: 0,
            },
        }
    }
}

fn because(is_needed: bool, field: &'static str, reason: &'static str) -> Because {
    if is_needed { Ok(field) } else { Err(reason) }
}

/// A scene whose computation is planned, with the properties that determine its parts.
struct Planner<'s> {
    scene: &'s Scene,
    points: u64,
    /// Number of springs under the body.
    springs: u64,
    is_adhesive: bool,
    goes_back: bool,
    is_exact: bool,
    relaxes: bool,
    is_measured: bool,
    is_random: bool,
}

impl Planner<'_> {
    /// Returns true if the loading is searched for the displacements of a compliant instrument.
    fn searches_for_the_instrument(&self) -> bool {
        self.scene.loading_stiffness.is_some() && searches_displacements(self.scene)
    }

    /// Returns the memory in bytes for solving the contact and for the force curves (`history`).
    /// The sum is an upper bound. It would be needed only if the whole contact under load already
    /// existed at first touch.
    fn bytes_of_contact(&self, plan: &Workload, history: u64) -> u64 {
        let solved = [
            WorkPart::Tree,
            WorkPart::LoadingPass,
            WorkPart::Equilibrium,
            WorkPart::Relaxation,
            WorkPart::WithoutPreload,
        ];
        let mut contact = HEIGHT * self.springs;
        for part in solved {
            contact += plan.bytes(part);
        }
        let has_edges_between = self.is_exact && self.scene.numerics.edges == Edges::SubCell;
        let sampled = if has_edges_between {
            SAMPLED_WITH_EDGES
        } else {
            SAMPLED
        };
        let samples = points_of_stage(self.scene);
        let searched = samples.saturating_add(SEARCHED);
        contact = contact.saturating_add(history);
        contact = contact.saturating_add(searched.saturating_mul(sampled));
        contact = contact.saturating_add(EVENTS_TOGETHER * self.springs / samples);
        if self.is_exact && !self.is_adhesive {
            contact = contact.saturating_add(TOUCHED * self.springs);
        }
        if self.searches_for_the_instrument() {
            contact = contact.saturating_add(DISPLACED * self.springs);
        }
        contact
    }

    fn parts(&self) -> Vec<PlannedPart> {
        let solved = self.because_solved();
        let patches = Work {
            passes: Some(self.scene.loading.len() as u64),
            springs: self.springs,
            bytes: 0,
        };
        let is_observed = |observer| self.scene.observe.contains(&observer);
        let not_observed = "not in observe";
        vec![
            PlannedPart::new(WorkPart::Form, self.because_form(), self.once(0)),
            self.synthesis(),
            self.measured_profile(),
            PlannedPart::new(WorkPart::Tree, solved, self.once(NODE * self.springs)),
            self.rule_of_hess(),
            PlannedPart::new(
                WorkPart::LoadingPass,
                solved,
                self.each_stage(PASSED * self.springs),
            ),
            PlannedPart::new(
                WorkPart::UnloadingPass,
                self.because_unloading(),
                self.each_stage(0),
            ),
            PlannedPart::new(
                WorkPart::Equilibrium,
                because(!self.is_exact, STEPWISE, "solver: Exact"),
                self.each_stage(STEPPED * self.springs),
            ),
            PlannedPart::new(
                WorkPart::Relaxation,
                because(self.relaxes, "material.relaxation", ELASTIC),
                self.each_stage(REMEMBERED * self.springs),
            ),
            self.without_preload(),
            PlannedPart::new(
                WorkPart::Patches,
                because(
                    is_observed(Observer::Patches),
                    "observe: Patches",
                    not_observed,
                ),
                patches,
            ),
            PlannedPart::new(
                WorkPart::HeightHistogram,
                because(
                    is_observed(Observer::HeightHistogram),
                    "observe: HeightHistogram",
                    not_observed,
                ),
                self.once(0),
            ),
        ]
    }

    /// Returns the costs of one pass over the springs under the body.
    fn once(&self, bytes: u64) -> Work {
        Work {
            passes: Some(1),
            springs: self.springs,
            bytes,
        }
    }

    /// Returns the costs of passes over the springs under the body in each loading stage.
    fn each_stage(&self, bytes: u64) -> Work {
        Work {
            passes: None,
            springs: self.springs,
            bytes,
        }
    }

    /// Returns the costs of one pass over the whole profile.
    fn over_profile(&self, bytes: u64) -> Work {
        Work {
            passes: Some(1),
            springs: self.points,
            bytes,
        }
    }

    fn because_form(&self) -> Because {
        match &self.scene.form {
            None => Err("no form: nominally flat"),
            Some(form) if form.flat_end().is_some() => Ok("form: the springs under the punch"),
            Some(_) => Ok("form"),
        }
    }

    fn because_solved(&self) -> Because {
        if !self.is_adhesive {
            Err(NO_ADHESION)
        } else if !self.is_exact {
            Err(STEPWISE)
        } else {
            Ok("adhesion with the exact solver")
        }
    }

    fn because_unloading(&self) -> Because {
        if !self.goes_back {
            Err(NEVER_BACK)
        } else if !self.is_adhesive {
            Err(NO_ADHESION)
        } else if !self.is_exact {
            Err(STEPWISE)
        } else if self.relaxes {
            Err("material.relaxation: springs detach step by step")
        } else {
            Ok("loading goes back")
        }
    }

    fn synthesis(&self) -> PlannedPart {
        let because = match (self.is_random, self.is_measured) {
            (true, true) => Ok("roughness: Measured, its equivalent line"),
            (true, false) => Ok("roughness: SelfAffine"),
            (false, true) => Err("roughness: Measured, as the line"),
            (false, false) => Err("no roughness: smooth"),
        };
        // The Fourier transform needs memory for coefficients, scratch space and twiddle factors,
        // as measured. With an odd number of springs the transform has twice the length.
        let points = self.points;
        let transform = points * (HEIGHT + if points.is_multiple_of(2) { 20 } else { 56 });
        // If the number of springs has a large prime factor, the transform needs further memory for
        // a convolution, as measured.
        let factor = largest_prime_factor(points);
        let convolution = if factor > LARGEST_FACTOR {
            152 * factor
        } else {
            0
        };
        let work = self.over_profile(transform + convolution);
        PlannedPart::new(WorkPart::Synthesis, because, work)
    }

    fn measured_profile(&self) -> PlannedPart {
        let reason = if self.is_random {
            "roughness: SelfAffine"
        } else {
            "no roughness: smooth"
        };
        PlannedPart::new(
            WorkPart::MeasuredProfile,
            because(self.is_measured, "roughness: Measured", reason),
            self.over_profile(HEIGHT * self.points),
        )
    }

    fn rule_of_hess(&self) -> PlannedPart {
        let no_pass = Work {
            passes: Some(0),
            springs: self.springs,
            bytes: 0,
        };
        PlannedPart::new(
            WorkPart::RuleOfHess,
            because(
                self.is_adhesive,
                "adhesion",
                "no adhesion: nothing is stretched",
            ),
            no_pass,
        )
    }

    fn without_preload(&self) -> PlannedPart {
        let because = if !self.is_adhesive {
            Err("no adhesion: non-adhesive")
        } else if !self.goes_back {
            Err(NEVER_BACK)
        } else if self.relaxes {
            Err(RELAXES)
        } else {
            Ok("adhesion with a loading that goes back")
        };
        // The pull-off force of the smooth body needs a further profile with its springs, unless
        // the form has a closed form.
        let has_smooth = self.scene.roughness.is_some()
            && self
                .scene
                .form
                .as_ref()
                .is_some_and(|form| form.flat_end().is_none() && form.power_law().is_none());
        let smooth_bytes = if has_smooth {
            (HEIGHT + NODE) * self.springs
        } else {
            0
        };
        let work = if self.is_exact {
            Work {
                passes: Some(2),
                springs: self.springs,
                bytes: smooth_bytes,
            }
        } else {
            self.each_stage(STEPPED * self.springs + smooth_bytes)
        };
        PlannedPart::new(WorkPart::WithoutPreload, because, work)
    }
}

fn largest_prime_factor(mut number: u64) -> u64 {
    let mut factor = 2;
    let mut largest = 1;
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
        let planned = Workload::of(crate::scene::open::open("jkr-sphere").unwrap().scene()).parts;
        let names: Vec<_> = planned.iter().map(|planned| planned.part.name()).collect();
        assert_eq!(names, WorkPart::NAMES);
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
