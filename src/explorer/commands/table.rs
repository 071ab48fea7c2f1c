//! The table of all keys with their functions. The handling of pressed keys, the footer, the help,
//! the list of commands, the configuration, the demo and docs/keys.md all follow from this table.

use super::{
    accuracy, compare, crosshair, dialogue, edit, files, manual, map, map_over, measured, movement,
    stages, target, timeline, view,
};
use crate::explorer::action::Task;
use crate::explorer::app::App;
use crate::explorer::keys::bindings::{ANY, Bindings, Context, EXPLORE, KeyCommand, MANUAL, Row};
use crate::explorer::keys::key;
use crate::explorer::pane::Pane;
use crate::explorer::parameters::Parameter;
use crate::explorer::request::Focus;
use Run::{Do, Key};
use crossterm::event::KeyEvent;

/// Row of the table of keys, with the function that the keys run, and the condition under which the
/// footer shows the row.
pub struct Entry {
    row: Row,
    run: Run,
    is_shown: fn(&App) -> bool,
}

#[derive(Clone, Copy)]
enum Run {
    Do(fn(&mut App)),
    /// Function that also receives the pressed key. It serves rows in which each key has another
    /// effect.
    Key(fn(&mut App, &KeyEvent)),
}

/// Runs a command on the state of the explorer.
pub fn run(command: KeyCommand, app: &mut App) {
    let Some(entry) = entry_of(command.row) else {
        return;
    };
    match entry.run {
        Do(change) => change(app),
        Key(change) => {
            if let Some(key) = command.key.or_else(|| first_key(command.row)) {
                change(app, &key);
            }
        }
    }
}

/// Returns the key that a command is given if the user has chosen it without pressing its key.
fn first_key(row: &Row) -> Option<KeyEvent> {
    let name = row.keys.split(' ').next()?;
    Some(key::Key::named(name)?.event())
}

/// Returns the entry of the table that contains a row.
fn entry_of(row: &Row) -> Option<&'static Entry> {
    TABLE.iter().find(|entry| std::ptr::eq(&entry.row, row))
}

pub fn bindings() -> Bindings {
    Bindings::of(TABLE.iter().map(|entry| &entry.row))
}

/// Returns the keys and rows that the footer shows, the most important first. Neighbouring rows
/// with the same label are joined.
pub fn footer(app: &App) -> Vec<(String, &'static Row)> {
    let is_manual = app.edit.path.is_some();
    app.config.bindings.footer(app.keys(), is_manual, |row| {
        entry_of(row).is_some_and(|entry| !(entry.is_shown)(app))
    })
}

/// Contexts in which all arrow keys act on the list of parameters. In the other panes, the arrow
/// keys move the mark on the map, the crosshair, or the body.
const LIST: &[Context] = &[Context::Explore, Context::Parameters];
/// Contexts in which Enter begins a value for the selected parameter.
const EDITED: &[Context] = &[
    Context::Explore,
    Context::Timeline,
    Context::Events,
    Context::Parameters,
];
/// Contexts in which keys other than those for values act on the list of parameters.
const LISTED: &[Context] = &[Context::Explore, Context::Manual, Context::Parameters];
const BY_HAND: &[Context] = &[Context::Manual];
/// Contexts in which Esc drops the path by hand.
const BESIDE_PATH: &[Context] = &[Context::Manual, Context::Timeline, Context::Events];
const TIMELINE: &[Context] = &[Context::Timeline];
const EVENTS: &[Context] = &[Context::Events];
/// Contexts in which ↑ and ↓ select a parameter. In the pane of the map, they move the mark
/// instead.
const ROWS: &[Context] = &[
    Context::Explore,
    Context::Crosshair,
    Context::Manual,
    Context::Timeline,
    Context::Parameters,
];
/// Contexts in which `-` zooms out, or lists fewer events. In the other panes, it begins a value or
/// makes the animation slower.
const ZOOMED_OUT: &[Context] = &[
    Context::Explore,
    Context::Map,
    Context::Crosshair,
    Context::Events,
];
/// Contexts in which `+` zooms in, or lists more events. With the timeline selected, it changes the
/// speed.
const OUTSIDE_TIMELINE: &[Context] = &[
    Context::Explore,
    Context::Map,
    Context::Crosshair,
    Context::Manual,
    Context::Events,
    Context::Parameters,
];
const VALUES: &[Context] = &[Context::Parameters];
const MAP_PANE: &[Context] = &[Context::Map];
const CROSSHAIR: &[Context] = &[Context::Crosshair];
const HELP: &[Context] = &[Context::Help];
const TYPED: &[Context] = &[Context::Line, Context::List];
const SEARCHED: &[Context] = &[Context::List];
const LINE: &[Context] = &[Context::Line];
/// Contexts with lists or panes of several pages: prompts with a list, the help, and all panes
/// except the map, whose pages are the preloads of a study.
const PAGED: &[Context] = &[
    Context::Explore,
    Context::Crosshair,
    Context::Parameters,
    Context::List,
    Context::Help,
];
const OVERWRITE: &[Context] = &[Context::Overwrite];
const LEAVE: &[Context] = &[Context::Leave];

const ANIMATION: &str = "Animation";
const PARAMETERS: &str = "Parameters";
const STAGES: &str = "Loading stages";
const COMPARE: &str = "Comparison";
const LOOK: &str = "View";
const CROSS: &str = "Crosshair";
const MAP: &str = "Map";
const SCENE: &str = "Scene";
const TEXT: &str = "Typing and lists";

const fn row(
    keys: &'static str,
    contexts: &'static [Context],
    name: &'static str,
    run: Run,
    label: &'static str,
    help: &'static str,
    section: &'static str,
) -> Entry {
    Entry {
        row: Row {
            keys,
            contexts,
            name,
            label,
            help,
            words: "",
            section,
            rank: 3,
            is_listed: true,
            merges: false,
            takes_key: matches!(run, Key(_)),
        },
        run,
        is_shown: always,
    }
}

impl Entry {
    const fn rank(mut self, rank: u8) -> Entry {
        self.row.rank = rank;
        self
    }

    const fn shown_if(mut self, is_shown: fn(&App) -> bool) -> Entry {
        self.is_shown = is_shown;
        self
    }

    const fn words(mut self, words: &'static str) -> Entry {
        self.row.words = words;
        self
    }

    const fn unlisted(mut self) -> Entry {
        self.row.is_listed = false;
        self
    }

    const fn merges(mut self) -> Entry {
        self.row.merges = true;
        self
    }
}

fn always(_: &App) -> bool {
    true
}

fn is_manual(app: &App) -> bool {
    app.edit.path.is_some()
}

fn lists_events(app: &App) -> bool {
    app.view.pane == Pane::Events
}

fn is_stage(app: &App) -> bool {
    app.edit
        .parameter()
        .is_some_and(|parameter| parameter.stage.is_some())
}

fn takes_number(app: &App) -> bool {
    app.edit.parameter().is_some_and(Parameter::takes_number)
}

/// All rows of the table of keys. A test checks that each key has at most one function in each
/// context.
#[rustfmt::skip]
static TABLE: &[Entry] = &[
    row("space", EXPLORE, "toggle-play", Do(movement::toggle_play), "play", "play or pause", ANIMATION),
    row(",", EXPLORE, "previous-event", Do(|app| timeline::go_to_event(app, false)), "jump", "go to the previous jump or mark of the loading", ANIMATION).words("event step back").rank(2),
    row(";", EXPLORE, "next-event", Do(|app| timeline::go_to_event(app, true)), "jump", "go to the next jump or mark of the loading", ANIMATION).words("event step forwards").rank(2),
    row("e", EXPLORE, "toggle-events", Do(timeline::toggle_events), "events", "show the list of events, or the results", ANIMATION).words("jumps list energies merge split").rank(2),
    row("r", EXPLORE, "toggle-repeat", Do(timeline::toggle_repeat), "", "repeat the animation, or stop it at its end", ANIMATION).words("loop again"),
    row(">", EXPLORE, "next-stage", Do(|app| movement::go_to_stage(app, 1)), "", "jump to the next stage", ANIMATION),
    row("<", EXPLORE, "previous-stage", Do(|app| movement::go_to_stage(app, -1)), "", "jump to the start of this stage, or to the previous stage", ANIMATION),
    row("!", EXPLORE, "pull-off", Do(movement::go_to_pull_off), "", "jump to the pull-off", ANIMATION),

    row("← → h l Shift+← Shift+→ H L Home End g G", TIMELINE, "move-playhead", Key(timeline::step), "move", "move along the loading by a small or a large step, or to an end", ANIMATION).rank(1).unlisted(),
    row("+ - =", TIMELINE, "change-speed", Key(timeline::change_speed), "speed", "double or halve the speed of the animation", ANIMATION).rank(1).unlisted(),
    row("↑ ↓ k j PageUp PageDown Home End g G", EVENTS, "select-event", Key(timeline::select_event), "select", "go to another event of the list", ANIMATION).rank(1).unlisted(),

    row("d", EXPLORE, "toggle-manual", Do(manual::toggle), "by hand", "press and pull by hand with ← → or a typed target; again: the path becomes the loading", MANUAL).words("minor loop manual history keep path"),
    row("← → h l Shift+← Shift+→ H L", BY_HAND, "push", Key(manual::push), "pull/press", "pull or press by a small or a large step", MANUAL).rank(1).unlisted(),
    row("Enter 0–9 - .", BY_HAND, "type-target", Key(manual::type_target), "go to", "type a target: 12 µN, -2 µN to pull, 430 nm, touch, separation", MANUAL).rank(1).words("minor loop target force load").unlisted(),
    row("S", EXPLORE, "separate", Do(manual::separate), "separate", "pull by hand to separation", MANUAL).words("detach unload").shown_if(is_manual),
    row("Esc", BESIDE_PATH, "drop-path", Do(manual::drop_path), "drop", "drop the path by hand; u brings it back", MANUAL).rank(1).shown_if(is_manual),

    row("↑ k", ROWS, "previous-parameter", Do(|app| edit::move_selection(app, -1)), "", "select the parameter above", PARAMETERS),
    row("↓ j", ROWS, "next-parameter", Do(|app| edit::move_selection(app, 1)), "select", "select the parameter below", PARAMETERS),
    row("Home End g G", LISTED, "parameter-at-end", Key(edit::go_to_end), "", "select the first or the last parameter", PARAMETERS).unlisted(),
    row("← h", LIST, "decrease", Do(|app| stages::step_value(app, -1, false)), "", "decrease the value by a small step", PARAMETERS),
    row("→ l", LIST, "increase", Do(|app| stages::step_value(app, 1, false)), "change", "increase the value by a small step", PARAMETERS),
    row("Shift+← H", LIST, "decrease-coarse", Do(|app| stages::step_value(app, -1, true)), "", "decrease the value by a large step", PARAMETERS),
    row("Shift+→ L", LIST, "increase-coarse", Do(|app| stages::step_value(app, 1, true)), "", "increase the value by a large step", PARAMETERS),
    row("Enter", EDITED, "edit-value", Do(|app| edit::edit_value(app, None)), "type", "type a value, such as 2.5 MPa, 10 µm, 50m", PARAMETERS),
    row("0–9", LIST, "start-value", Key(edit::start_value), "type", "type a number for the selected parameter", PARAMETERS).unlisted().shown_if(takes_number),
    row("- .", VALUES, "start-sign", Key(edit::start_value), "", "the same, if the pane of parameters is selected", PARAMETERS).unlisted(),
    row("/", EXPLORE, "find-parameter", Do(dialogue::find_parameter), "find", "find a parameter by name, symbol or meaning", PARAMETERS),
    row("f", LISTED, "find-value", Do(target::ask), "for target", "find the value of the row, or the preload, for a target such as F_a/F_a,max = 20 %", PARAMETERS).words("inverse question goal reach required which solve"),
    row("t", LISTED, "toggle-effect", Do(edit::toggle_effect), "on/off", "switch form, roughness, adhesion or unloading on or off", PARAMETERS).words("effect"),
    row("R", EXPLORE, "reseed", Do(edit::draw_seed), "reseed", "draw another random profile", PARAMETERS).words("seed realisation realization random"),
    row("%", EXPLORE, "type-tolerance", Do(accuracy::type_tolerance), "", "type a tolerance of F_a, such as 0.1 %, from which the number of springs follows", PARAMETERS).words("accuracy precision error convergence springs faster slow performance resolution"),
    row("u", EXPLORE, "undo", Do(|app| edit::undo(app, true)), "undo", "undo the last edit", PARAMETERS).words("cancel revert back mistake"),
    row("U Ctrl+r", EXPLORE, "redo", Do(|app| edit::undo(app, false)), "", "redo the edit", PARAMETERS).words("again"),

    row("Insert P", LISTED, "add-stage", Do(stages::add), "add", "add a stage after the selected one", STAGES).words("loading cycle step protocol").rank(1).shown_if(is_stage),
    row("Delete Backspace", LISTED, "delete-stage", Do(stages::delete), "delete", "delete the selected stage", STAGES).rank(1).shown_if(is_stage),
    row("Shift+↑ K", LISTED, "move-stage-up", Do(|app| stages::shift(app, -1)), "move", "move the selected stage up", STAGES).rank(1).shown_if(is_stage),
    row("Shift+↓ J", LISTED, "move-stage-down", Do(|app| stages::shift(app, 1)), "move", "move the selected stage down", STAGES).rank(1).shown_if(is_stage),
    row("V", LISTED, "next-stage-kind", Do(|app| stages::change_kind(app, true)), "kind", "change the kind of the stage", STAGES).words("force indentation displacement control").rank(1).shown_if(is_stage),

    row("c", EXPLORE, "pin", Do(compare::pin), "compare", "keep this loop as a ghost for comparison", COMPARE).words("ghost overlay keep").rank(2),
    row("x", EXPLORE, "swap", Do(compare::swap), "", "swap the scene with the scene of the newest ghost", COMPARE),
    row("C", EXPLORE, "clear-ghosts", Do(compare::clear), "", "remove all ghosts", COMPARE),
    row("D", EXPLORE, "toggle-squares", Do(compare::toggle_squares), "", "compare with the same contact in three dimensions", COMPARE).words("3D half-space model error boundary elements reference cancel"),
    row("Ctrl+f", EXPLORE, "fit", Do(measured::ask_fit), "fit", "fit parameters of the scene to the measured curve", COMPARE).words("noise experiment evaluate least squares regression measured").rank(2).shown_if(|app| app.edit.measured.is_some()),

    row("v", EXPLORE, "next-curve", Do(view::next_curve), "", "plot force (over d, D or time), contact length or number of patches", LOOK).words("contact area displacement quantity axis hysteresis loop"),
    row("N", EXPLORE, "toggle-normalised", Do(|app| app.view.curve.normalised ^= true), "", "show forces in units of F_a,max, or in SI units", LOOK).words("normalise normalised normalize normalized dimensionless units SI share"),
    row("n", EXPLORE, "next-patch", Do(|app| view::go_to_patch(app, Focus::After)), "patch", "show the next patch", LOOK),
    row("p", EXPLORE, "previous-patch", Do(|app| view::go_to_patch(app, Focus::Before)), "", "show the previous patch", LOOK),
    row("+ =", OUTSIDE_TIMELINE, "zoom-in", Do(|app| view::zoom(app, 1)), "more/fewer", "zoom into the selected profile, list more of the selected events, else zoom into the patch", LOOK).words("jumps smaller energy share").rank(2).shown_if(lists_events),
    row("-", ZOOMED_OUT, "zoom-out", Do(|app| view::zoom(app, -1)), "more/fewer", "zoom out; list fewer of the selected events", LOOK).words("jumps larger energy share").rank(2).shown_if(lists_events),
    row("( )", EXPLORE, "pan", Key(view::pan), "", "pan left or right along the profile", LOOK).unlisted(),
    row("A", EXPLORE, "toggle-trust", Do(|app| app.toggle(Pane::Trust)), "trust", "show how far F_a can be trusted", LOOK).words("accuracy error uncertainty budget theories criteria Persson Tabor JKR convergence cost time"),
    row("Q", EXPLORE, "toggle-spectrum", Do(|app| app.toggle(Pane::Spectrum)), "", "show spectra over the wave number", LOOK).words("spectrum power spectral density PSD roughness"),
    row("i", EXPLORE, "toggle-preloads", Do(|app| app.toggle(Pane::Preloads)), "", "show adhesion against preload", LOOK).words("spread scatter ensemble profiles statistics median quartiles load distribution histogram"),
    row("X", EXPLORE, "toggle-scale", Do(view::toggle_scale), "log/linear", "make axes of preloads, or colours of a map, logarithmic or linear", LOOK).words("logarithmic axis axes scale").rank(1).shown_if(|app| matches!(app.view.pane, Pane::Preloads | Pane::Map)),
    row("Y", EXPLORE, "toggle-sensitivity", Do(|app| app.toggle(Pane::Sensitivity)), "", "show the change of F_a by ±10 % of each number", LOOK).words("influence derivative variation sensitivity important tornado"),
    row("Tab", EXPLORE, "next-pane", Do(view::next_pane), "pane", "select the next pane", LOOK).rank(2),
    row("Ctrl+l", ANY, "redraw", Do(|app| app.effects.push(Task::Redraw)), "", "draw the whole screen again", LOOK),
    row("z", EXPLORE, "zoom-pane", Do(|app| app.view.zoomed ^= true), "zoom", "show only the selected pane, or all panes", LOOK).words("full screen fullscreen maximise zoom enlarge larger bigger maximize"),
    row("T", EXPLORE, "next-theme", Do(view::next_theme), "", "change the colours", LOOK).words("theme colors appearance dark light colour color palette black white"),

    row("*", EXPLORE, "toggle-crosshair", Do(crosshair::toggle), "read", "show or hide the crosshair", CROSS).words("cursor values coordinates probe measure read off"),
    row("← → h l Shift+← Shift+→ H L", CROSSHAIR, "move-crosshair", Key(crosshair::step), "move", "move the crosshair by a small or a large step", CROSS).unlisted(),
    row("Home End g G", CROSSHAIR, "crosshair-to-end", Key(crosshair::go_to_end), "", "move the crosshair to an end", CROSS).unlisted(),
    row("Esc", CROSSHAIR, "hide-crosshair", Do(crosshair::toggle), "hide", "hide the crosshair", CROSS),

    row("m", EXPLORE, "toggle-map", Do(|app| app.toggle(Pane::Map)), "map", "show the regimes over H and κ", MAP).words("phase diagram regime").rank(2),
    row("M", EXPLORE, "map-over", Do(map_over::ask), "", "map a quantity over two rows, such as F_a/F_a,max over E × h", MAP).words("study sweep parametric two axes diagram plan"),
    row("← → ↓ ↑ h l j k", MAP_PANE, "move-scene", Key(map::step), "move", "move the scene to the next value on an axis", MAP).merges().unlisted(),
    row("Shift+← Shift+→ Shift+↓ Shift+↑ H L J K", MAP_PANE, "move-scene-coarse", Key(map::step), "", "move the scene by four values", MAP).merges().unlisted(),
    row("V", MAP_PANE, "next-map-quantity", Do(map::next_quantity), "quantity", "map another quantity", MAP),
    row("W", MAP_PANE, "toggle-study", Do(map::toggle_study), "", "back to the map over H and κ; show the map of the study, or the map of the scene", MAP),
    row("P PageDown PageUp", MAP_PANE, "next-slice", Key(map::step_slice), "", "next or previous preload of the study, or value of a further axis", MAP),

    row("o", EXPLORE, "open-library", Do(dialogue::open_library), "open", "open a scene, a study, a plan, a force curve or a surface", SCENE).words("load files preset example measured recent surface curve import read").rank(2),
    row("s", EXPLORE, "save", Do(|app| files::ask_save(app, false)), "save", "save the scene to a file, or the plan of the selected map", SCENE).words("write file store store keep").rank(2),
    row("E", EXPLORE, "export", Do(files::ask_export), "export", "export the selected pane as a table, a figure or text", SCENE).words("figure picture print image table data csv pdf save as png svg json report paper publication plot chart screenshot width"),
    row("y", EXPLORE, "copy-command", Do(files::copy_command), "copy", "copy the command that opens this scene", SCENE).words("share link reproduce shell clipboard"),
    row(": Ctrl+p", EXPLORE, "open-palette", Do(dialogue::open_commands), "commands", "find a command, a parameter or a scene by words", SCENE).rank(2).unlisted(),
    row("? F1", EXPLORE, "help", Do(dialogue::open_help), "help", "show this help", SCENE).words("manual documentation keys").rank(0),
    row("q Ctrl+c", EXPLORE, "quit", Do(files::ask_quit), "quit", "quit", SCENE).words("exit leave close").rank(0),
    row("Ctrl+z", ANY, "suspend", Do(|app| app.effects.push(Task::Suspend)), "", "suspend to the shell; fg resumes", SCENE),

    row("↓ ↑ j k space Home End g G", HELP, "select-row", Key(dialogue::select_by), "select", "select the next, previous, first or last row", TEXT),
    row("/", HELP, "search-help", Do(dialogue::search_help), "find", "search the help by words", TEXT),
    row("Esc ? q F1 Ctrl+c", HELP, "close-help", Do(dialogue::cancel), "back", "close the help", TEXT).rank(0),
    row("↓ ↑ Ctrl+n Ctrl+p Home End", SEARCHED, "select-row", Key(dialogue::select_by), "select", "select the next, previous, first or last row", TEXT),
    row("PageDown PageUp", PAGED, "page", Key(dialogue::page), "page", "go down or up a page of a list, of the parameters, of Trust or of Sensitivity", TEXT).unlisted().shown_if(dialogue::has_pages),
    row("Enter", TYPED, "accept", Do(dialogue::accept), "accept", "accept the text or the selected row", TEXT),
    row("Tab", TYPED, "complete", Do(dialogue::complete), "complete", "complete the typed path", TEXT).shown_if(dialogue::can_complete),
    row("Esc Ctrl+c", TYPED, "cancel", Do(dialogue::cancel), "cancel", "cancel: keep the previous value", TEXT),
    row("← → Ctrl+b Ctrl+f Ctrl+← Ctrl+→ Ctrl+a Ctrl+e", TYPED, "move-cursor", Key(edit::edit_by), "", "move the cursor by a character, by a word, or to an end", TEXT),
    row("Home End", LINE, "cursor-to-end", Key(edit::edit_by), "", "move the cursor to an end of the text", TEXT),
    row("Backspace Delete Ctrl+h Ctrl+d Ctrl+w", TYPED, "delete", Key(edit::edit_by), "", "delete a character or a word", TEXT),
    row("Ctrl+u", TYPED, "clear", Do(edit::clear_line), "clear", "clear the typed text", TEXT),
    row("y", OVERWRITE, "accept", Do(dialogue::accept), "overwrite", "overwrite the file", TEXT),
    row("n Esc Ctrl+c", OVERWRITE, "cancel", Do(dialogue::cancel), "keep it", "keep the existing file", TEXT),
    row("s", LEAVE, "save-then-quit", Do(files::save_before_leaving), "save", "save, then quit", TEXT),
    row("q y Ctrl+c", LEAVE, "quit-anyway", Do(|app| app.finished = true), "quit", "quit without saving", TEXT),
    row("n Esc", LEAVE, "cancel", Do(dialogue::cancel), "stay", "stay", TEXT),
];
