//! The state of the explorer: changed by `update` alone, drawn by the views.

use super::action::Traffic;
use super::adhesion_spread::AdhesionSpread;
pub use super::appraisal::{Appraisal, Estimated};
pub use super::chart::{Chart, OpenStudy};
use super::config::Config;
pub use super::panes::Pane;
use super::panes::PreloadCurve;
use super::parameters::{Parameter, Setting, parameters};
pub use super::player::Player;
use super::player::{indentations, start_of};
use super::prompt::{Prompt, Purpose};
use super::request::{Focus, LineView, ManualMove, Tried};
use super::snapshot::{ContactSnapshot, Drive, Preview, SolvedScene};
use super::text_line::TextLine;
use super::theme::Appearance;
use crate::analysis::Governing;
use crate::contact::{CurvePoint, LegRecord};
use crate::export::LoopQuantities;
use crate::scene::{Document, Observer, Scene, ron_float};
use crate::simulation::Outcome;
use crate::study::{Axis, Place};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Target of the close-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloseUpTarget {
    /// Place.
    pub focus: Focus,
    /// Springs shown.
    pub springs: usize,
}

impl CloseUpTarget {
    /// Springs shown when a scene opens: a small part of the line, but several asperities; a larger part of a scene
    /// that observes its contact patches, with both ends of the patch at first touch.
    #[must_use]
    pub fn springs_shown(document: &Document) -> usize {
        let scene = document.scene();
        let part = if scene.observe.contains(&Observer::Fragments) { 4 } else { 32 };
        (scene.numerics.points / part).max(64) as usize
    }
}

/// State of manual loading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ManualState {
    /// Path so far, the newest point last.
    pub path: Vec<CurvePoint>,
    /// Springs attached or detached on the last move.
    pub changed: u64,
    /// Elastic energy released since manual loading began, J.
    pub released_energy: f64,
    /// Moves not yet requested.
    pub moves: Vec<ManualMove>,
    /// Target force as last typed.
    pub typed_force: String,
}

/// Content of the pane of the curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CurveLook {
    /// Quantities.
    pub quantities: LoopQuantities,
    /// True for units of F_a,max, h and the whole line, false for SI units.
    pub normalised: bool,
    /// True if the dissipated energy is shaded.
    pub loss: bool,
}

/// Lines through the state shown on the force curve, and through one position on profile and close-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crosshair {
    /// Position as a share of the profile, 0 to 1.
    pub position: f64,
}

/// Loop kept for comparison.
#[derive(Clone, Debug)]
pub struct Ghost {
    /// Its scene.
    pub document: Document,
    /// Outcome.
    pub computed: Arc<SolvedScene>,
    /// The contact when it was kept.
    pub snapshot: Option<Arc<ContactSnapshot>>,
    /// Differences of its scene from the present one.
    pub differs: String,
    /// The same differences with the values of the ghost and of the present scene: `κ 4 → 8`.
    pub changes: String,
}

/// A line for the user, below the panes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Message {
    /// Success.
    Done(String),
    /// Failure.
    Error(String),
    /// A refused change of the selected parameter.
    Refused(String),
}

/// The scene as edited, its history, and its list of parameters.
#[derive(Clone, Debug)]
pub struct Editor {
    /// The scene as edited.
    pub document: Document,
    /// Documents before each edit.
    pub past: Vec<Document>,
    /// Documents after each undone edit.
    pub future: Vec<Document>,
    /// Document on disk or as opened, for each scene by its name.
    pub saved: BTreeMap<String, Document>,
    /// Number of times that a scene was saved or opened.
    pub saves: u64,
    /// Scenes left with unsaved changes, by their names.
    pub left: BTreeMap<String, Document>,
    /// Number of the newest requested scene.
    pub generation: u64,
    /// The parameters of the scene.
    pub parameters: Vec<Parameter>,
    /// Index of the selected parameter, which is never in a folded group.
    pub selected: usize,
    /// Groups of parameters of which only the first row is listed.
    pub folded: BTreeSet<&'static str>,
}

/// Shown panes, their parts, and their appearance.
#[derive(Clone, Debug)]
pub struct View {
    /// The chosen pane.
    pub pane: Pane,
    /// Pane in the place of profile and close-up; `None`: these.
    pub large: Option<Pane>,
    /// Pane in the place of the close-up, or the close-up.
    pub lower: Pane,
    /// True if the chosen pane has the whole screen.
    pub zoomed: bool,
    /// Columns and rows of the terminal.
    pub size: (u16, u16),
    /// Colours and markers.
    pub appearance: Appearance,
    /// True where octants have no known width: `M` skips them.
    pub lacks_octants: bool,
    /// Target of the close-up.
    pub look: CloseUpTarget,
    /// Part of the line in the profile pane.
    pub profile: LineView,
    /// Content of the pane of the curve.
    pub curve: CurveLook,
    /// The crosshair, while shown.
    pub crosshair: Option<Crosshair>,
    /// True if the status line has springs and times in place of mechanical quantities.
    pub shows_work: bool,
    /// True if times are shown: they differ from run to run.
    pub shows_times: bool,
    /// Traffic of the connection, over SSH.
    pub traffic: Option<Traffic>,
    /// Line in place of the keys, which have no effect while a script plays.
    pub demo: Option<&'static str>,
}

/// Results that follow the solution of a scene.
#[derive(Clone, Debug, Default)]
pub struct StudyResults {
    /// Accuracy of the scene and the cost of accuracy.
    pub appraisal: Appraisal,
    /// Adhesion against preload, so far.
    pub preloads: Option<Arc<PreloadCurve>>,
    /// Adhesion of random profiles of a measured surface, so far.
    pub adhesion_spread: Option<Arc<AdhesionSpread>>,
    /// Reasons why data of panes are not computed further.
    pub failures: BTreeMap<Pane, String>,
    /// True if the scene was edited after the last pane was shown: its data wait while a key is held down.
    pub edited: bool,
}

/// The state of the explorer.
#[derive(Clone, Debug)]
pub struct App {
    /// The scene and its history.
    pub edit: Editor,
    /// State of the animation.
    pub play: Player,
    /// Manual loading, while active.
    pub manual: Option<ManualState>,
    /// Shown panes and their appearance.
    pub view: View,
    /// The newest computed scene.
    pub solved: Option<Arc<SolvedScene>>,
    /// The newest snapshot of its animation.
    pub snapshot: Option<Arc<ContactSnapshot>>,
    /// Legs done of the scene being computed.
    pub progress: Option<usize>,
    /// Results that follow.
    pub studies: StudyResults,
    /// The map over κ and H.
    pub chart: Chart,
    /// Loops kept for comparison, the newest last.
    pub ghosts: Vec<Ghost>,
    /// Scene that becomes a ghost once computed.
    pub next_ghost: Option<Document>,
    /// Scene to open beside the present one once that is computed.
    pub opens_beside: Option<Document>,
    /// Scene whose outcome is awaited: with the value being typed, or to be kept as a ghost.
    pub tried: Option<Tried>,
    /// The newest outcome of a tried scene.
    pub preview: Option<Arc<Preview>>,
    /// The line being typed, or the question.
    pub prompt: Option<Prompt>,
    /// A line for the user.
    pub message: Option<Message>,
    /// Keys, speed of the animation, and file of the configuration.
    pub config: Config,
    /// True if the explorer is to end.
    pub finished: bool,
}

impl App {
    /// The explorer just opened on a scene.
    #[must_use]
    pub fn new(document: Document, size: (u16, u16), appearance: Appearance) -> Self {
        let springs = CloseUpTarget::springs_shown(&document);
        App {
            edit: Editor {
                saved: BTreeMap::from([(document.name().to_owned(), document.clone())]),
                parameters: parameters(&document),
                document,
                past: Vec::new(),
                future: Vec::new(),
                saves: 0,
                left: BTreeMap::new(),
                generation: 1,
                selected: 0,
                folded: BTreeSet::new(),
            },
            play: Player::START,
            manual: None,
            view: View {
                pane: Pane::Force,
                large: None,
                lower: Pane::CloseUp,
                zoomed: false,
                size,
                appearance,
                lacks_octants: false,
                look: CloseUpTarget { focus: Focus::Summit, springs },
                profile: LineView::WHOLE,
                curve: CurveLook::default(),
                crosshair: None,
                shows_work: false,
                shows_times: true,
                traffic: None,
                demo: None,
            },
            solved: None,
            snapshot: None,
            progress: Some(0),
            studies: StudyResults::default(),
            chart: Chart::default(),
            ghosts: Vec::new(),
            next_ghost: None,
            opens_beside: None,
            tried: None,
            preview: None,
            prompt: None,
            message: None,
            config: Config::default(),
            finished: false,
        }
    }

    /// Shows a success.
    pub(super) fn set_done(&mut self, text: impl Into<String>) {
        self.message = Some(Message::Done(text.into()));
    }

    /// Shows the reason of a failure.
    pub(super) fn set_error(&mut self, why: impl Into<String>) {
        self.message = Some(Message::Error(why.into()));
    }

    /// Returns true if the last change of a parameter was refused.
    #[must_use]
    pub fn is_refused(&self) -> bool {
        matches!(self.message, Some(Message::Refused(_)))
    }

    /// Returns true while the value of the selected parameter is typed.
    #[must_use]
    pub fn is_typing_value(&self) -> bool {
        self.prompt.as_ref().is_some_and(|prompt| matches!(prompt.purpose, Purpose::Value))
    }

    /// Opens a prompt.
    pub(super) fn ask(&mut self, purpose: Purpose, line: TextLine) {
        self.prompt = Some(Prompt::new(purpose, line, &self.edit.parameters));
    }

    /// Governing parameters of the present scene from the newest computation, which must have the same line; its
    /// adhesion may differ.
    #[must_use]
    pub fn governing(&self) -> Option<Governing> {
        let computed = self.solved.as_ref()?;
        let (before, now) = (computed.scene.as_ref(), self.edit.document.scene());
        // The computed scene names files from the working folder.
        let mut named = now.clone();
        named.rename_measured_files(|file| self.edit.document.resolve(file).to_string_lossy().into_owned());
        let same_line = before.roughness == named.roughness
            && before.length == now.length
            && before.form == now.form
            && before.material == now.material;
        // An rms height that follows from γ and κ or e_el/γ changes with them.
        let both = |scene: &Scene| scene.adhesion.is_some_and(|adhesion| adhesion.sets_amplitude());
        if !same_line || ((both(before) || both(now)) && before.adhesion != now.adhesion) {
            return None;
        }
        Some(computed.outcome.governing.with_adhesion(now.adhesion))
    }

    /// Returns true if the present scene has been computed.
    #[must_use]
    pub fn is_current(&self) -> bool {
        self.current().is_some()
    }

    /// The computed scene, if this is the present one.
    #[must_use]
    pub fn current(&self) -> Option<&Arc<SolvedScene>> {
        self.solved.as_ref().filter(|computed| computed.generation == self.edit.generation)
    }

    /// Returns true while a newer scene than the shown one is computed.
    #[must_use]
    pub fn is_computing(&self) -> bool {
        self.progress.is_some()
    }

    /// Outcome for the value being typed, until then for the one typed before; for an accepted value until the scene is
    /// computed.
    #[must_use]
    pub fn tried_outcome(&self) -> Option<&Outcome> {
        let preview = self.preview.as_ref()?;
        let is_shown = match self.prompt {
            Some(_) => self.is_typing_value() && self.tried.is_some(),
            None => self.is_computing() && preview.text == self.edit.document.text(),
        };
        preview.outcome.as_ref().ok().filter(|_| is_shown)
    }

    /// Returns true once the typed value itself has an outcome.
    #[must_use]
    pub fn is_tried(&self) -> bool {
        let tried = self.tried.as_ref().map(|tried| &tried.text);
        self.preview.as_ref().is_some_and(|preview| tried == Some(&preview.text))
    }

    /// Values of the scene on the axes of the map: its mark. `None` where the scene has no such quantity, or its value
    /// is not known yet.
    #[must_use]
    pub fn place(&self) -> Option<Place> {
        let scene = self.edit.document.scene();
        let (across, up) = self.chart.axes(scene)?;
        let governing = self.governing();
        let value = |axis: &Axis| axis.value_in(scene, governing.as_ref());
        let place = value(&across)?;
        up.map_or(Some((place, None)), |up| Some((place, Some(value(&up)?))))
    }

    /// The ghost shown beside the scene.
    #[must_use]
    pub fn beside(&self) -> Option<&Ghost> {
        self.ghosts.last().filter(|_| self.view.lower == Pane::Beside)
    }

    /// Drive of the body.
    #[must_use]
    pub fn drive(&self) -> Drive {
        if self.manual.is_some() { Drive::Manual } else { Drive::Leg(self.play.leg) }
    }

    /// The newest snapshot, where it belongs to the present scene and kind of loading.
    #[must_use]
    pub fn present(&self) -> Option<&ContactSnapshot> {
        let snapshot = self.snapshot.as_deref()?;
        (snapshot.generation == self.edit.generation && snapshot.drive == self.drive()).then_some(snapshot)
    }

    /// The legs of the shown scene.
    #[must_use]
    pub fn legs(&self) -> &[LegRecord] {
        self.solved.as_ref().map_or(&[], |computed| &computed.outcome.history.legs)
    }

    /// A parameter's value in the notation of the scene; computed where the value follows from others.
    #[must_use]
    pub fn written(&self, parameter: &Parameter) -> Option<String> {
        if !parameter.written.is_empty() {
            return Some(parameter.written.clone());
        }
        let governing = self.governing()?;
        match parameter.setting {
            Setting::RoughnessParameter(parameter) => governing.parameter(parameter).map(ron_float),
            Setting::WorkOfAdhesion => governing.work_of_adhesion.map(ron_float),
            Setting::Field | Setting::Switch(_) | Setting::Heading => None,
        }
    }

    /// Indices of the listed parameters: of a folded group only the first.
    #[must_use]
    pub fn listed(&self) -> Vec<usize> {
        let is_listed =
            |parameter: &Parameter| parameter.is_head() || !self.edit.folded.contains(parameter.group);
        (0..self.edit.parameters.len()).filter(|index| is_listed(&self.edit.parameters[*index])).collect()
    }

    /// The selected parameter.
    #[must_use]
    pub fn parameter(&self) -> Option<&Parameter> {
        self.edit.parameters.get(self.edit.selected)
    }

    /// Lowest and highest indentation of the curves shown, m; `None` when there is no curve.
    #[must_use]
    pub fn indentations(&self) -> Option<(f64, f64)> {
        indentations(self.legs())
    }

    /// The indentation of the animation, m.
    #[must_use]
    pub fn indentation(&self) -> f64 {
        self.play.indentation(self.legs())
    }

    /// Part of a loading stage done at an indentation, 0 to 1: the inverse of [`App::indentation`].
    #[must_use]
    pub fn done_at(&self, leg: usize, indentation: f64) -> f64 {
        let Some(end) = self.legs().get(leg).map(LegRecord::end) else { return 0.0 };
        let start = start_of(self.legs(), leg);
        let done = (indentation - start) / (end - start);
        if done.is_finite() { done.clamp(0.0, 1.0) } else { 0.0 }
    }
}
