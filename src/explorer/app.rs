//! State of the explorer. Only `update` changes the state, and the views draw it.

use super::action::Task;
use super::config::Config;
use super::editor::Editor;
use super::events::{LeastShare, ListedEvents};
use super::ghost::Ghost;
use super::keys::bindings::{Context, KeyCommand};
use super::manual_path::ManualPath;
use super::map_state::MapState;
use super::pane::Pane;
use super::parameters::{Parameter, Setting};
use super::player::{Player, Rest, indentations};
use super::prompt::{Prompt, Purpose};
use super::request::{CloseUpTarget, LineView, SnapshotRequest};
use super::scene_title::SceneTitle;
use super::snapshot::{ContactSnapshot, Preview, SolvedScene};
use super::studies::Findings;
use super::text_line::TextLine;
use super::theme::{Appearance, Meaning};
use asperity_contact::{Mark, StageRecord};
use asperity_data::{AxisScale, format_rounded};
use asperity_report::{Format, LoopQuantities, Section, counted_texts, percent, warning_texts};
use asperity_scene::text::ron_float;
use asperity_scene::{Document, Governing, Outcome};
use asperity_study::{Ensemble, Quantity};
use ratatui::style::Style;
use std::sync::Arc;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CurveLook {
    pub quantities: LoopQuantities,
    /// True to show forces in units of the ideal pull-off force F_a,max, and lengths in units of
    /// the rms height h or of the length L. False to show all values in SI units.
    pub normalised: bool,
}

/// Kind of an exported file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExportKind {
    pub format: Format,
    /// Width of a figure in µm; `None` for the usual width.
    pub width: Option<u32>,
}

impl Default for ExportKind {
    fn default() -> Self {
        ExportKind {
            format: Format::Pdf,
            width: None,
        }
    }
}

/// Message to the user, shown below the panes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Message {
    Done(String),
    Error(String),
    /// The explorer has refused the value that the user gave the selected parameter. The text is
    /// the reason.
    Refused(String),
    /// The median answer of an inverse question has become a value of the scene. The message also
    /// states the median that this quantity then has, as soon as it is computed.
    Taken {
        name: String,
        quantity: Quantity,
    },
}

#[derive(Clone, Debug)]
pub struct View {
    pub pane: Pane,
    /// Pane that has the main place on the screen in place of the force curve. The force curve is
    /// then drawn below this pane, where the profile and the close-up would be. `None` if the force
    /// curve has the main place.
    pub large: Option<Pane>,
    pub zoomed: bool,
    /// True if the list of events takes the place of the results.
    pub lists_events: bool,
    /// Smallest energy of a jump in the list of events, as a share of the largest one.
    pub least_share: LeastShare,
    /// Index of the shown page of a pane that has several pages in a small window. An index beyond
    /// the last page means the last page.
    pub page: usize,
    pub size: (u16, u16),
    pub appearance: Appearance,
    pub close_up: CloseUpTarget,
    pub profile: LineView,
    pub curve: CurveLook,
    /// Scale of the preload axis in the pane of pull-off force against preload.
    pub preloads: AxisScale,
    /// True if the loops of random square surfaces on an elastic half-space are computed and shown.
    pub squares: bool,
    /// Position of the crosshair from 0 to 1; `None` if there is no crosshair. In the panes that
    /// show springs, it is a position along the profile. In other charts, it is a position along
    /// the horizontal axis.
    pub crosshair: Option<f64>,
    /// True if computing times are shown. A demo hides them, because they differ from one
    /// computation to the next.
    pub shows_times: bool,
    /// What the user exported last, which the next export proposes.
    pub export: ExportKind,
    /// Text that a demo shows instead of the keys, which have no effect while its script plays.
    pub demo: Option<&'static str>,
}

/// State of the contact for which the screen waits.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Awaited {
    pub generation: u64,
    pub snapshot: SnapshotRequest,
    pub path: Option<Arc<ManualPath>>,
    pub least_share: LeastShare,
}

#[derive(Clone, Debug)]
pub struct App {
    pub edit: Editor,
    /// Position of the animation of the scene's loading.
    pub play: Player,
    /// Position of the animation of the path of manual loading; `None` at the end of the path,
    /// where the body is.
    pub play_of_path: Option<Player>,
    /// Rest of the animation at a large jump; `None` while it moves.
    pub rest: Option<Rest>,
    pub view: View,
    pub solved: Option<Arc<SolvedScene>>,
    pub snapshot: Option<Arc<ContactSnapshot>>,
    /// Events that the solver has listed last; they may belong to an earlier scene.
    pub events: Option<Arc<ListedEvents>>,
    /// Number of computed stages of the scene that is being computed; `None` if no scene is being
    /// computed.
    pub progress: Option<usize>,
    pub studies: Findings,
    pub map: MapState,
    pub ghosts: Vec<Ghost>,
    /// The scene with the value that the user is typing; `None` if the user is typing no value. The
    /// outcome of this scene is computed as a preview.
    pub tried: Option<Document>,
    pub prompt: Option<Prompt>,
    pub message: Option<Message>,
    /// Offer at the start, such as to restore unsaved changes, which disappears with the next key.
    pub offer: Option<String>,
    pub config: Config,
    /// Command that runs next, because the user has chosen it in the list of commands; otherwise
    /// `None`.
    pub chosen: Option<KeyCommand>,
    pub finished: bool,
    pub(super) effects: Vec<Task>,
    /// State of the contact that was last requested from the solver; `None` before the first
    /// request.
    pub(super) asked: Option<Awaited>,
}

impl App {
    /// Creates the state of an explorer that has just opened a scene.
    pub fn new(
        document: Document,
        size: (u16, u16),
        appearance: Appearance,
        config: Config,
    ) -> Self {
        App {
            edit: Editor::new(document),
            play: Player::START,
            play_of_path: None,
            rest: None,
            view: View {
                pane: Pane::Force,
                large: None,
                zoomed: false,
                lists_events: false,
                least_share: LeastShare::default(),
                page: 0,
                size,
                appearance,
                close_up: CloseUpTarget::WHOLE,
                profile: LineView::WHOLE,
                curve: CurveLook::default(),
                preloads: AxisScale::default(),
                squares: false,
                crosshair: None,
                shows_times: true,
                export: ExportKind::default(),
                demo: None,
            },
            solved: None,
            snapshot: None,
            events: None,
            progress: Some(0),
            studies: Findings::default(),
            map: MapState::default(),
            ghosts: Vec::new(),
            tried: None,
            prompt: None,
            message: None,
            offer: None,
            config,
            chosen: None,
            finished: false,
            effects: Vec::new(),
            asked: None,
        }
    }

    pub(super) fn set_done(&mut self, text: impl Into<String>) {
        self.message = Some(Message::Done(text.into()));
    }

    pub(super) fn set_error(&mut self, why: impl Into<String>) {
        self.message = Some(Message::Error(why.into()));
    }

    /// Adds a warning and an offer to the message that is shown for the opened scene, so that all
    /// three are one message. The offer may be to restore unsaved changes. Warnings and errors come
    /// first. An offer alone is shown in the place of the footer, so that the results stay visible.
    pub fn state_beside(&mut self, warning: Option<String>, offer: Option<String>) {
        let mut error = None;
        let mut done = None;
        match self.message.take() {
            Some(Message::Done(text)) => done = Some(text),
            Some(Message::Taken { .. }) => {}
            Some(Message::Error(text) | Message::Refused(text)) => error = Some(text),
            None => {}
        }
        if warning.is_none() && error.is_none() && done.is_none() {
            self.offer = offer;
            return;
        }
        let is_error = warning.is_some() || error.is_some();
        let notices: Vec<String> = [warning, error, done, offer]
            .into_iter()
            .flatten()
            .collect();
        let text = notices.join(" · ");
        if is_error {
            self.set_error(text);
        } else {
            self.set_done(text);
        }
    }

    /// Returns what the title line shows.
    pub fn title(&self) -> SceneTitle {
        SceneTitle::new(&self.edit)
    }

    pub fn is_refused(&self) -> bool {
        matches!(self.message, Some(Message::Refused(_)))
    }

    /// Returns the style, such as a colour, of a text or a line with this meaning. The style
    /// follows from the theme that the user has chosen.
    pub fn style(&self, meaning: Meaning) -> Style {
        self.view.appearance.style(meaning)
    }

    pub fn is_typing_value(&self) -> bool {
        self.prompt
            .as_ref()
            .is_some_and(|prompt| matches!(prompt.purpose, Purpose::Value))
    }

    /// Opens a prompt again with the text that the user has typed, because the explorer could not
    /// use this text. `why` is the reason. If `why` begins with the typed text, this beginning is
    /// left out.
    pub(super) fn ask_again(&mut self, purpose: Purpose, text: &str, why: &str) {
        let rest = why.strip_prefix(text);
        let reason = rest.and_then(|rest| rest.strip_prefix(": ")).unwrap_or(why);
        self.ask(purpose, text);
        if let Some(prompt) = &mut self.prompt {
            // The text is not selected, so that the user can correct it and the first key does not
            // replace it.
            prompt.line = TextLine::new(text);
        }
        self.refuse(Some(reason.to_owned()));
    }

    /// Shows in the prompt why the typed text is refused. `None` removes the reason.
    pub(super) fn refuse(&mut self, why: Option<String>) {
        if let Some(prompt) = &mut self.prompt {
            prompt.refused = why;
        }
    }

    /// Prepares the state for a command that changes the scene or the panes. The message is
    /// removed. If the last edit was a series of moves of the mark on the map, a later move is a
    /// new edit.
    pub(super) fn begin(&mut self) {
        self.map.moving = false;
        self.offer = None;
        // If the computation of the scene has failed, the message with the reason stays visible.
        // All other messages disappear with the next key.
        if self.is_current() || self.is_computing() {
            self.message = None;
        }
    }

    pub(super) fn ask(&mut self, purpose: Purpose, text: &str) {
        self.prompt = Some(Prompt::new(purpose, text, &self.edit));
    }

    /// Returns the governing parameters of the present scene, such as the effective modulus and the
    /// work of adhesion; `None` if they are not known yet. They are known if the present scene has
    /// the profile and the material of the scene that was computed last. The adhesion may differ.
    pub fn governing(&self) -> Option<Governing> {
        let computed = self.solved.as_ref()?;
        let before = &computed.scene;
        let present = &self.edit.scene;
        let is_same_profile = before.roughness == present.roughness
            && before.length == present.length
            && before.form == present.form
            && before.material == present.material;
        if !is_same_profile {
            return None;
        }
        Some(computed.outcome.governing.with_adhesion(present.adhesion))
    }

    /// Returns true if the outcome of the present scene is computed.
    pub fn is_current(&self) -> bool {
        self.current().is_some()
    }

    /// Returns the computed scene if it is the present scene; `None` while the present scene is not
    /// computed.
    pub fn current(&self) -> Option<&Arc<SolvedScene>> {
        self.solved
            .as_ref()
            .filter(|computed| computed.generation == self.edit.generation)
    }

    /// Returns warnings about the premises of the model that the present result does not meet, in
    /// the words that all reports use. If random profiles have been computed, the warnings are for
    /// these profiles. Otherwise they are for the profile of the scene.
    pub fn warnings(&self) -> Vec<String> {
        let Some(computed) = self.current() else {
            return Vec::new();
        };
        match self.studies.value::<Ensemble>() {
            Some(ensemble) if ensemble.computed() > 0 => {
                counted_texts(&ensemble.warnings(), ensemble.computed())
            }
            _ => warning_texts(&computed.outcome.warnings),
        }
    }

    /// Returns true while the present scene is being computed.
    pub fn is_computing(&self) -> bool {
        self.progress.is_some()
    }

    /// Returns the outcome that is shown as a preview of a typed value; `None` if there is none:
    /// * While the user types a value, this is the outcome for the typed value. Until this outcome
    ///   is computed, it is the outcome for the value that was typed before.
    /// * After the user has accepted the value, the preview remains until the scene itself is
    ///   computed.
    pub fn tried_outcome(&self) -> Option<&Outcome> {
        let preview = self.studies.value::<Preview>()?;
        let is_shown = match self.prompt {
            Some(_) => self.is_typing_value() && self.tried.is_some(),
            None => self.is_computing() && preview.text == self.edit.document.text(),
        };
        let has_failed = self.studies.failure::<Preview>().is_some();
        if is_shown && !has_failed {
            Some(&preview.outcome)
        } else {
            None
        }
    }

    /// Returns true if the outcome for the value that the user is typing is computed.
    pub fn is_tried(&self) -> bool {
        let tried = self.tried.as_ref().map(Document::text);
        self.studies
            .value::<Preview>()
            .is_some_and(|preview| tried == Some(&preview.text))
    }

    /// Returns the panes that the user can select, in their order on the screen: from top to bottom
    /// on the left, and then on the right.
    pub fn panes(&self) -> Vec<Pane> {
        match self.view.large {
            Some(Pane::Trust) => vec![Pane::Trust, Pane::Parameters],
            Some(large) => vec![large, Pane::Force, Pane::Parameters],
            None => {
                let mut panes = vec![
                    Pane::Force,
                    Pane::Timeline,
                    Pane::Profile,
                    Pane::CloseUp,
                    Pane::Parameters,
                ];
                if self.view.lists_events {
                    panes.push(Pane::Events);
                }
                panes
            }
        }
    }

    /// Returns true if the user can select this pane.
    pub fn is_shown(&self, pane: Pane) -> bool {
        self.panes().contains(&pane)
    }

    /// Shows and selects a pane that is hidden, and hides a pane that is shown. A map that is shown
    /// but not selected is not hidden but selected, because the user then wants to use the keys of
    /// the map.
    pub fn toggle(&mut self, pane: Pane) {
        let is_in_use = self.view.pane == pane || pane.keys() != Context::Map;
        if self.is_shown(pane) && is_in_use {
            self.show_force_curve()
        } else {
            self.show(pane)
        }
    }

    /// Gives the main place on the screen to the force curve, and selects the force curve.
    pub fn show_force_curve(&mut self) {
        self.show_large(None, Pane::Force);
    }

    /// Shows a pane and selects it. A large pane takes the main place on the screen.
    pub fn show(&mut self, pane: Pane) {
        match pane {
            // The list of events and the results may have the same place.
            Pane::Events => self.view.lists_events = true,
            Pane::Result => self.view.lists_events = false,
            _ => {}
        }
        let large = match pane {
            _ if pane.is_large() => Some(pane),
            // A pane in the main place hides these.
            Pane::Timeline | Pane::Profile | Pane::CloseUp => None,
            _ => self.view.large,
        };
        self.show_large(large, pane);
    }

    /// Gives the main place to the pane `large`, or to the force curve if `large` is `None`, and
    /// selects the pane `selected`. If the main place changes, the background computations for the
    /// new pane are requested.
    fn show_large(&mut self, large: Option<Pane>, selected: Pane) {
        if std::mem::replace(&mut self.view.large, large) != large {
            self.effects.push(Task::Study);
            self.view.page = 0;
        }
        self.view.pane = selected;
    }

    /// Returns the context, which determines what the keys do. In the context of a map, for
    /// example, the arrow keys move the mark; in the context of a crosshair, they move the
    /// crosshair. In the context of the list of parameters, a digit begins a new value.
    pub fn keys(&self) -> Context {
        if let Some(prompt) = &self.prompt {
            return prompt.context();
        }
        match self.view.pane.keys() {
            Context::Crosshair if self.view.crosshair.is_some() => Context::Crosshair,
            Context::Crosshair if self.moves_by_arrows() => Context::Manual,
            Context::Crosshair => Context::Explore,
            context => context,
        }
    }

    /// Returns true if the arrow keys move the body: under manual loading, if the force curve is
    /// selected.
    fn moves_by_arrows(&self) -> bool {
        self.view.pane == Pane::Force && self.edit.path.is_some()
    }

    /// The part of the profile that the selected pane shows.
    pub fn section(&self) -> Option<&Section> {
        let snapshot = self.snapshot.as_ref()?;
        match self.view.pane {
            Pane::CloseUp => Some(&snapshot.close_up.section),
            Pane::Profile => Some(&snapshot.profile),
            _ => None,
        }
    }

    /// Returns the outcome of the computed scene, which may be older than the present scene; `None`
    /// before a scene is computed.
    pub fn outcome(&self) -> Option<&Outcome> {
        self.solved.as_ref().map(|computed| &computed.outcome)
    }

    pub fn stages(&self) -> &[StageRecord] {
        self.outcome()
            .map_or(&[], |outcome| &outcome.history.stages)
    }

    /// Returns true if the instrument of the computed scene is compliant, so that it deflects under
    /// the force.
    pub fn deflects(&self) -> bool {
        self.outcome()
            .is_some_and(|outcome| outcome.instrument.is_some())
    }

    pub fn without_rounding(&self, force: f64) -> f64 {
        let mut largest: f64 = 0.0;
        for marked in Mark::all(self.stages()) {
            largest = largest.max(marked.point.force.abs());
        }
        if force.abs() < 1e-12 * largest {
            0.0
        } else {
            force
        }
    }

    /// Returns true if forces are shown in units of the ideal pull-off force F_a,max. This is
    /// possible only if a scene with a positive F_a,max is computed.
    pub fn is_normalised(&self) -> bool {
        self.view.curve.normalised && self.ideal_pull_off_force().is_some()
    }

    /// Returns the ideal pull-off force F_a,max of the computed scene in N; `None` if no scene is
    /// computed, or if the force is not above zero.
    pub fn ideal_pull_off_force(&self) -> Option<f64> {
        let force = self.outcome()?.ideal_pull_off_force?;
        if force > 0.0 { Some(force) } else { None }
    }

    /// Returns a force (in N) of the computed scene as text, in N or in units of the ideal pull-off
    /// force F_a,max.
    pub fn force_in_words(&self, force: f64) -> String {
        match self.ideal_pull_off_force() {
            Some(ideal) if self.is_normalised() => {
                format!("{} F_a,max", format_rounded(force / ideal, 3, "1"))
            }
            _ => format_rounded(force, 3, "N"),
        }
    }

    /// Returns the ratio F_a/F_a,max of the pull-off force to the ideal pull-off force as text, for
    /// the computed profile. Returns `None` if there is no pull-off force.
    pub fn adhesion_share_in_words(&self) -> Option<String> {
        let force = self.outcome()?.figures.pull_off_force?;
        Some(share_in_words(force / self.ideal_pull_off_force()?))
    }

    /// Returns the median over the random profiles of the ratio F_a/F_a,max as text. The ratio is
    /// the pull-off force divided by the ideal pull-off force. Returns `None` until profiles are
    /// computed, and if no profile has a pull-off force.
    pub fn median_share_in_words(&self) -> Option<String> {
        let ensemble = self.studies.value::<Ensemble>()?;
        let shares = ensemble.statistics(Quantity::AdhesionShare)?;
        Some(format!("median {}", share_in_words(shares.quartiles[1])))
    }

    /// Returns the value of a parameter in the notation of the scene file. If the value follows
    /// from other parameters, it is the computed value, or `None` until it is computed.
    pub fn written(&self, parameter: &Parameter) -> Option<String> {
        if !parameter.written.is_empty() {
            return Some(parameter.written.clone());
        }
        let governing = self.governing()?;
        let value = match parameter.setting {
            Setting::RoughnessParameter(parameter) => governing.parameter(parameter)?,
            Setting::WorkOfAdhesion => governing.work_of_adhesion?,
            Setting::Field => match parameter.path.as_str() {
                "roughness.rms_height" => governing.amplitude?.rms_height,
                "roughness.rms_gradient" => governing.amplitude?.rms_gradient,
                _ => return None,
            },
            Setting::Heading | Setting::CurveOption(_) | Setting::Profiles => return None,
        };
        Some(ron_float(value))
    }

    /// Returns the lowest and the highest indentation of the shown curves in m; `None` if there are
    /// no curves.
    pub fn indentations(&self) -> Option<(f64, f64)> {
        indentations(self.stages())
    }

    /// Returns the indentation in m that the animation shows.
    pub fn indentation(&self) -> f64 {
        self.playhead().indentation(self.played_stages())
    }
}

fn share_in_words(share: f64) -> String {
    format!("F_a/F_a,max {}", percent(share, 3))
}
