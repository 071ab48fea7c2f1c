//! Which stages a scene calls for, and by which of its fields. The run follows this plan.

use crate::analysis::Figures;
use crate::scene::{Adhesion, Edges, Form, Leg, Observer, Roughness, Scene, Solver};
use serde::Serialize;

/// A stage on the way from a scene to its curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stage {
    /// Adding the macroscopic form.
    Form,
    /// Drawing random phases and transforming them into a line.
    Synthesis,
    /// Reading a measured profile.
    MeasuredProfile,
    /// Building the tree of the gaps.
    Tree,
    /// Measuring the level sets of the line that runs straight from spring to spring.
    LevelSets,
    /// Evaluating the rule of Hess.
    RuleOfHess,
    /// Thresholds of loading legs.
    LoadingPass,
    /// Thresholds of unloading legs.
    UnloadingPass,
    /// Steps and relaxation sweeps.
    Relaxation,
    /// The loop turned at first touch, for F_a(0) and the regime.
    ZeroLoadAdhesion,
    /// The list of contact fragments.
    Fragments,
    /// The histogram of heights.
    HeightHistogram,
}

impl Stage {
    /// The stage in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Stage::Form => "form",
            Stage::Synthesis => "random line (phases, Fourier transform)",
            Stage::MeasuredProfile => "measured profile",
            Stage::Tree => "contact tree",
            Stage::LevelSets => "level sets of the line",
            Stage::RuleOfHess => "rule of Hess",
            Stage::LoadingPass => "loading passes",
            Stage::UnloadingPass => "unloading passes",
            Stage::Relaxation => "stepwise relaxation",
            Stage::ZeroLoadAdhesion => "zero-load adhesion and regime",
            Stage::Fragments => "contact fragments",
            Stage::HeightHistogram => "height histogram",
        }
    }
}

/// A stage and whether a scene calls for it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PlannedStage {
    /// The stage.
    pub stage: Stage,
    /// Whether it runs.
    pub runs: bool,
    /// The field that calls for it, or why it is skipped.
    pub because: &'static str,
}

/// The stages of a scene, in the order in which they run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Plan {
    /// All stages, those that are skipped as well.
    pub stages: Vec<PlannedStage>,
}

impl Plan {
    /// The plan of a checked scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let adhesive = is_adhesive(scene);
        let exact = scene.numerics.solver == Solver::Exact;
        let pulls = may_unload(&scene.loading);
        let observes = |observer| scene.observe.contains(&observer);
        let mut stages = Vec::new();
        let mut plan = |stage, runs: bool, yes: &'static str, no: &'static str| {
            stages.push(PlannedStage { stage, runs, because: if runs { yes } else { no } });
        };
        let (shaped, form) = match scene.form {
            None => (false, "no form: nominally flat"),
            Some(Form::Punch { .. }) => (true, "form: the springs under the punch"),
            Some(_) => (true, "form"),
        };
        plan(Stage::Form, shaped, form, form);
        let no_roughness = "no roughness: smooth";
        let synthesis = matches!(scene.roughness, Some(Roughness::SelfAffine { .. }));
        let measured = matches!(scene.roughness, Some(Roughness::Measured { .. }));
        plan(
            Stage::Synthesis,
            synthesis,
            "roughness: SelfAffine",
            if measured { "roughness: Measured" } else { no_roughness },
        );
        plan(
            Stage::MeasuredProfile,
            measured,
            "roughness: Measured",
            if synthesis { "roughness: SelfAffine" } else { no_roughness },
        );
        let no_adhesion = "no adhesion: each spring touches and leaves at its own gap";
        let stepwise = "solver: Stepwise";
        let tree = if adhesive { stepwise } else { no_adhesion };
        let calls = "adhesion with the exact solver";
        plan(Stage::Tree, exact && adhesive, calls, tree);
        let at_springs = if exact && adhesive { "edges: Grid" } else { tree };
        let between = scene.numerics.edges == Edges::SubCell;
        plan(Stage::LevelSets, exact && adhesive && between, "edges: SubCell", at_springs);
        plan(Stage::RuleOfHess, adhesive, "adhesion", no_adhesion);
        plan(Stage::LoadingPass, exact && adhesive, calls, tree);
        let never = "loading never goes back";
        plan(
            Stage::UnloadingPass,
            exact && adhesive && pulls,
            "loading goes back",
            if pulls { tree } else { never },
        );
        plan(Stage::Relaxation, !exact, stepwise, "solver: Exact");
        let touch = Figures::is_touch_protocol(scene);
        plan(
            Stage::ZeroLoadAdhesion,
            adhesive && pulls && !touch,
            "adhesion with a loading that goes back",
            match (adhesive, pulls) {
                (false, _) => "no adhesion: non-adhesive",
                (true, false) => never,
                (true, true) => "the loading itself turns at first touch",
            },
        );
        let unobserved = "not in observe";
        plan(Stage::Fragments, observes(Observer::Fragments), "observe: Fragments", unobserved);
        plan(
            Stage::HeightHistogram,
            observes(Observer::HeightHistogram),
            "observe: HeightHistogram",
            unobserved,
        );
        Plan { stages }
    }

    /// Whether a stage runs.
    #[must_use]
    pub fn runs(&self, stage: Stage) -> bool {
        self.stages.iter().any(|planned| planned.stage == stage && planned.runs)
    }
}

/// Whether a scene has adhesion: none named, or a work of zero, is none.
fn is_adhesive(scene: &Scene) -> bool {
    match scene.adhesion {
        None => false,
        Some(Adhesion { work, kappa }) => {
            work.is_some_and(|work| work > 0.0) || (work.is_none() && kappa.is_some())
        }
    }
}

/// Whether a loading may turn back: any second leg may, and a first one only away from the foundation.
fn may_unload(loading: &[Leg]) -> bool {
    let mut reached = f64::NEG_INFINITY;
    loading.iter().enumerate().any(|(index, leg)| match *leg {
        Leg::ToIndentation(to) => {
            let back = index > 0 && to < reached;
            reached = reached.max(to);
            back
        }
        Leg::ToTouch => {
            let back = index > 0 && 0.0 < reached;
            reached = reached.max(0.0);
            back
        }
        Leg::ToSeparation => index > 0,
        Leg::ToForce(_) | Leg::ToZeroForce => {
            let back = index > 0;
            reached = f64::INFINITY;
            back
        }
    })
}
