//! The one table of keys with their functions, for dispatch, footer, help, list of commands, configuration, demo and
//! docs/keys.md.

mod bindings;
mod key;

pub use bindings::{Bindings, RebindError, markdown};
pub use key::{Key, names};

use super::command::Command;
use super::command::Handler::{self, Act, Character, Silent, View};
use super::effect::Effect;
use super::mode::{Mode, ModeKind};
use super::panes::Pane;
use super::request::Focus;
use super::text_line::{Motion, TextLine};
use super::update::{
    accuracy, chart, compare, crosshair, dialogue, edit, files, library, look, movement, show,
};
use crossterm::event::KeyCode;
use key::{char, control, key, shift};
use std::borrow::Cow;

/// A row of the table: keys, the modes in which they are valid, and their function.
#[derive(Clone, Debug, PartialEq)]
pub struct Binding {
    /// The keys.
    pub keys: Cow<'static, [Key]>,
    /// The modes in which they are valid.
    pub modes: &'static [ModeKind],
    /// Function of the keys, with its name.
    pub command: Command,
    /// One word for the footer; empty for none.
    pub label: &'static str,
    /// A line for the help.
    pub help: &'static str,
    /// The section of the help.
    pub section: &'static str,
}

/// Exploring, in any pane.
const EXPLORE: &[ModeKind] = &[ModeKind::Explore, ModeKind::Chart, ModeKind::Crosshair, ModeKind::Parameters];
/// Without map and crosshair, where the arrows act on these.
const LIST: &[ModeKind] = &[ModeKind::Explore, ModeKind::Parameters];
/// In the list of parameters these characters begin a value.
const OTHER_PANES: &[ModeKind] = &[ModeKind::Explore, ModeKind::Chart, ModeKind::Crosshair];
const VALUES: &[ModeKind] = &[ModeKind::Parameters];
const CHART: &[ModeKind] = &[ModeKind::Chart];
const CROSSHAIR: &[ModeKind] = &[ModeKind::Crosshair];
const HELP: &[ModeKind] = &[ModeKind::Help];
const TYPED: &[ModeKind] = &[ModeKind::Prompt, ModeKind::List];
const SEARCHED: &[ModeKind] = &[ModeKind::List];
const ASK: &[ModeKind] = &[ModeKind::Overwrite];
const LEAVE: &[ModeKind] = &[ModeKind::Quit];
const ANY: &[ModeKind] = &ModeKind::ALL;

const DIGITS: [Key; 10] = [
    char('0'),
    char('1'),
    char('2'),
    char('3'),
    char('4'),
    char('5'),
    char('6'),
    char('7'),
    char('8'),
    char('9'),
];
/// Characters that begin a number.
const VALUE_STARTS: [Key; 12] = {
    let mut keys = [char('-'); 12];
    keys[11] = char('.');
    let mut digit = 0;
    while digit < DIGITS.len() {
        keys[digit] = DIGITS[digit];
        digit += 1;
    }
    keys
};

const ANIMATION: &str = "Animation";
const MANUAL: &str = "Manual loading";
const PARAMETERS: &str = "Parameters";
const COMPARE: &str = "Comparison";
const LOOK: &str = "View";
const CROSS: &str = "Crosshair";
const MAP: &str = "Map";
const SCENE: &str = "Scene";
const TEXT: &str = "Typing and lists";

const fn row(
    keys: &'static [Key],
    modes: &'static [ModeKind],
    name: &'static str,
    handler: Handler,
    label: &'static str,
    help: &'static str,
    section: &'static str,
) -> Binding {
    Binding { keys: Cow::Borrowed(keys), modes, command: Command::new(name, handler), label, help, section }
}

/// All keys. A test ensures one meaning of a key in each mode.
#[rustfmt::skip]
pub const BINDINGS: &[Binding] = &[
    row(&[char(' ')], EXPLORE, "toggle-play", Act(movement::toggle_play), "play", "play or pause", ANIMATION),
    row(&[char('.')], OTHER_PANES, "step 1", Act(|app| movement::step(app, 1)), "step", "one step forwards", ANIMATION),
    row(&[char(',')], EXPLORE, "step -1", Act(|app| movement::step(app, -1)), "", "one step backwards", ANIMATION),
    row(&[char('r')], EXPLORE, "restart", Act(movement::restart), "restart", "play from the beginning", ANIMATION),
    row(&[char('>')], EXPLORE, "leg 1", Act(|app| movement::go_to_leg(app, 1)), "", "jump to the start of the next loading stage", ANIMATION),
    row(&[char('<')], EXPLORE, "leg -1", Act(|app| movement::go_to_leg(app, -1)), "", "jump to the start of this loading stage or of the previous one", ANIMATION),
    row(&[char('!')], EXPLORE, "pull-off", Act(movement::go_to_pull_off), "", "jump to the pull-off, the smallest force of the unloading stages", ANIMATION),

    row(&[char('d')], EXPLORE, "toggle-manual", Act(movement::toggle_manual), "manual", "begin manual loading at the present indentation, or end it", MANUAL),
    row(&[char(']')], EXPLORE, "push 1", Act(|app| movement::push(app, 1, false)), "press/pull", "press by a small step", MANUAL),
    row(&[char('[')], EXPLORE, "push -1", Act(|app| movement::push(app, -1, false)), "press/pull", "pull by a small step", MANUAL),
    row(&[char('}')], EXPLORE, "push 1 coarse", Act(|app| movement::push(app, 1, true)), "large step", "press by a large step", MANUAL),
    row(&[char('{')], EXPLORE, "push -1 coarse", Act(|app| movement::push(app, -1, true)), "large step", "pull by a large step", MANUAL),
    row(&[char('F')], EXPLORE, "type-force", Silent(movement::type_force), "force", "type a target force", MANUAL),
    row(&[char('S')], EXPLORE, "separate", Act(movement::separate), "separate", "pull to separation", MANUAL),

    row(&[key(KeyCode::Up), char('k')], LIST, "select -1", Act(|app| edit::move_selection(app, -1)), "", "select the parameter above", PARAMETERS),
    row(&[key(KeyCode::Down), char('j')], LIST, "select 1", Act(|app| edit::move_selection(app, 1)), "select", "select the parameter below", PARAMETERS),
    row(&[key(KeyCode::Home), char('g')], LIST, "select-end false", Act(|app| edit::select_end(app, false)), "", "select the first parameter", PARAMETERS),
    row(&[key(KeyCode::End), char('G')], LIST, "select-end true", Act(|app| edit::select_end(app, true)), "", "select the last parameter", PARAMETERS),
    row(&[key(KeyCode::Left), char('h')], LIST, "step-value -1", Act(|app| edit::step_value(app, -1, false)), "", "decrease the value by a small step", PARAMETERS),
    row(&[key(KeyCode::Right), char('l')], LIST, "step-value 1", Act(|app| edit::step_value(app, 1, false)), "change", "increase the value by a small step", PARAMETERS),
    row(&[shift(KeyCode::Left), char('H')], LIST, "step-value -1 coarse", Act(|app| edit::step_value(app, -1, true)), "", "decrease the value by a large step", PARAMETERS),
    row(&[shift(KeyCode::Right), char('L')], LIST, "step-value 1 coarse", Act(|app| edit::step_value(app, 1, true)), "", "increase the value by a large step", PARAMETERS),
    row(&[key(KeyCode::Enter), char('e')], LIST, "edit-value", Act(|app| edit::edit_value(app, None)), "type", "type a value, with an optional prefix and unit: 2.5 MPa, 10 µm, 50m", PARAMETERS),
    row(&VALUE_STARTS, VALUES, "start-value", Character(|app, first| edit::edit_value(app, Some(first))), "type", "type a number, while the pane of parameters is selected; not for a choice, a switch or a group", PARAMETERS),
    row(&[char('/')], EXPLORE, "find-parameter", Act(dialogue::find_parameter), "find", "find a parameter by words of its name, symbol or meaning", PARAMETERS),
    row(&[char('Z')], LIST, "toggle-fold", Act(edit::toggle_fold), "", "fold the group of the selected parameter, or unfold it", PARAMETERS),
    row(&[char('t')], LIST, "toggle-effect", Act(edit::toggle_effect), "on/off", "switch the effect of the selected row on or off", PARAMETERS),
    row(&[char('R')], EXPLORE, "reseed", Act(|_| vec![Effect::DrawSeed]), "reseed", "draw another random profile", PARAMETERS),
    row(&[char('%')], EXPLORE, "type-tolerance", Silent(accuracy::type_tolerance), "", "type a tolerance (0.1 %, 1e-3): selects number of springs and edges", PARAMETERS),
    row(&[char('u')], EXPLORE, "undo", Act(|app| edit::undo(app, true)), "undo", "undo the last edit", PARAMETERS),
    row(&[char('U'), control('r')], EXPLORE, "redo", Act(|app| edit::undo(app, false)), "", "redo the edit", PARAMETERS),

    row(&[char('c')], EXPLORE, "pin", Act(compare::pin), "compare", "keep this loop as a ghost for comparison", COMPARE),
    row(&[char('x')], EXPLORE, "swap", Act(compare::swap), "", "swap the scene with the newest ghost", COMPARE),
    row(&[char('&')], EXPLORE, "toggle-side-by-side", Act(compare::toggle_side_by_side), "", "show the newest ghost beside the scene: profiles above each other, differences, F_a of both", COMPARE),
    row(&[char('|')], EXPLORE, "pin-other-use", Act(compare::pin_other_use), "", "keep the loop of the measured profile itself, or of its equivalent line, as a ghost", COMPARE),
    row(&[char('C')], EXPLORE, "clear-ghosts", Act(compare::clear), "", "remove all ghosts", COMPARE),

    row(&[char('v')], EXPLORE, "next-curve", View(|app| app.view.curve.quantities = app.view.curve.quantities.next()), "", "plot force, contact length or number of contact patches", LOOK),
    row(&[char('N')], EXPLORE, "toggle-normalised", View(|app| app.view.curve.normalised ^= true), "", "plot in units of F_a,max and h, or in SI units", LOOK),
    row(&[char('a')], EXPLORE, "toggle-loss", View(|app| app.view.curve.loss ^= true), "", "shade the area of the loop: the dissipated energy", LOOK),
    row(&[char('n')], EXPLORE, "fragment next", View(|app| look::go_to_fragment(app, Focus::After)), "fragment", "show the next contact patch", LOOK),
    row(&[char('p')], EXPLORE, "fragment previous", View(|app| look::go_to_fragment(app, Focus::Before)), "", "show the previous contact patch", LOOK),
    row(&[char('b')], EXPLORE, "fragment largest", View(|app| app.view.look.focus = Focus::Largest), "", "show the longest contact patch", LOOK),
    row(&[char('B')], EXPLORE, "fragment most-loaded", View(|app| app.view.look.focus = Focus::MostLoaded), "", "show the contact patch under the largest force", LOOK),
    row(&[char('f')], EXPLORE, "fragment summit", View(|app| app.view.look.focus = Focus::Summit), "", "show the point of first touch", LOOK),
    row(&[char('D')], EXPLORE, "toggle-lengths", Act(|app| show::toggle(app, Pane::Lengths)), "", "show the distribution of patch lengths in place of the close-up", LOOK),
    row(&[char('+'), char('=')], EXPLORE, "zoom 1", View(|app| look::zoom(app, 1)), "", "zoom in: profile if selected, else close-up", LOOK),
    row(&[char('-')], OTHER_PANES, "zoom -1", View(|app| look::zoom(app, -1)), "", "zoom out", LOOK),
    row(&[char('(')], EXPLORE, "pan -1", View(|app| look::pan(app, -1)), "", "pan left along the profile", LOOK),
    row(&[char(')')], EXPLORE, "pan 1", View(|app| look::pan(app, 1)), "", "pan right along the profile", LOOK),
    row(&[char('w')], EXPLORE, "toggle-follow", View(look::toggle_follow), "", "keep the profile centred on the patch of the close-up", LOOK),
    row(&[char('0')], OTHER_PANES, "reset-zoom", View(look::reset_zoom), "", "show the whole profile", LOOK),
    row(&[char('A')], EXPLORE, "toggle-accuracy", Act(|app| show::toggle(app, Pane::Accuracy)), "accuracy", "show errors against time and the computing stages, in place of profile and close-up", LOOK),
    row(&[char('Q')], EXPLORE, "toggle-spectrum", Act(|app| show::toggle(app, Pane::Spectrum)), "", "show spectra over the wave number q in place of profile and close-up", LOOK),
    row(&[char('i')], EXPLORE, "toggle-preloads", Act(|app| show::toggle(app, Pane::Preloads)), "", "show adhesion against preload, in place of profile and close-up", LOOK),
    row(&[key(KeyCode::Tab)], EXPLORE, "next-pane", View(look::next_pane), "pane", "select the next pane", LOOK),
    row(&[char('z')], EXPLORE, "zoom-pane", View(|app| app.view.zoomed ^= true), "zoom", "show the selected pane on the whole screen, or all panes", LOOK),
    row(&[control('s')], EXPLORE, "remember-appearance", Act(look::remember_appearance), "", "keep the present colours and markers in the configuration file", LOOK),
    row(&[char('I')], EXPLORE, "toggle-work", View(|app| app.view.shows_work ^= true), "", "show springs and stage times in the status line, or contact, stiffness, pressure and energy", LOOK),
    row(&[char('T')], EXPLORE, "next-theme", View(look::next_theme), "", "change the colours", LOOK),
    row(&[char('M')], EXPLORE, "next-marker", View(look::next_marker), "", "change the markers: braille, octants, half blocks, ASCII", LOOK),

    row(&[char('*')], EXPLORE, "toggle-crosshair", View(crosshair::toggle), "read", "show or hide the crosshair: d, F, l, n on the force curve, x, z on profile and close-up", CROSS),
    row(&[key(KeyCode::Left), char('h')], CROSSHAIR, "move-crosshair -1", Act(|app| crosshair::move_by(app, -1, false)), "", "move the crosshair left: along the loading stage, or along the profile", CROSS),
    row(&[key(KeyCode::Right), char('l')], CROSSHAIR, "move-crosshair 1", Act(|app| crosshair::move_by(app, 1, false)), "move", "move the crosshair right", CROSS),
    row(&[shift(KeyCode::Left), char('H')], CROSSHAIR, "move-crosshair -1 coarse", Act(|app| crosshair::move_by(app, -1, true)), "", "move the crosshair left by a large step", CROSS),
    row(&[shift(KeyCode::Right), char('L')], CROSSHAIR, "move-crosshair 1 coarse", Act(|app| crosshair::move_by(app, 1, true)), "", "move the crosshair right by a large step", CROSS),
    row(&[key(KeyCode::Home), char('g')], CROSSHAIR, "crosshair-end false", View(|app| crosshair::go_to_end(app, false)), "", "move the crosshair to the left end", CROSS),
    row(&[key(KeyCode::End), char('G')], CROSSHAIR, "crosshair-end true", View(|app| crosshair::go_to_end(app, true)), "", "move the crosshair to the right end", CROSS),
    row(&[key(KeyCode::Up), char('k')], CROSSHAIR, "crosshair-stage -1", View(|app| crosshair::go_to_stage(app, -1)), "", "move to the previous loading stage at the same indentation", CROSS),
    row(&[key(KeyCode::Down), char('j')], CROSSHAIR, "crosshair-stage 1", View(|app| crosshair::go_to_stage(app, 1)), "stage", "move to the next loading stage at the same indentation", CROSS),
    row(&[key(KeyCode::Esc)], CROSSHAIR, "toggle-crosshair", View(crosshair::toggle), "hide", "hide the crosshair", CROSS),

    row(&[char('m')], EXPLORE, "toggle-chart", Act(|app| show::toggle(app, Pane::Chart)), "map", "show the regimes over H and κ or e_el/γ, in place of profile and close-up", MAP),
    row(&[key(KeyCode::Left), char('h')], CHART, "move-across -1", Act(|app| chart::step(app, -1, 0)), "", "move the scene to the value on the left: decrease H; successive moves are one edit", MAP),
    row(&[key(KeyCode::Right), char('l')], CHART, "move-across 1", Act(|app| chart::step(app, 1, 0)), "move", "move the scene to the value on the right: increase H", MAP),
    row(&[key(KeyCode::Down), char('j')], CHART, "move-up -1", Act(|app| chart::step(app, 0, -1)), "", "move the scene to the value below: decrease κ or e_el/γ", MAP),
    row(&[key(KeyCode::Up), char('k')], CHART, "move-up 1", Act(|app| chart::step(app, 0, 1)), "", "move the scene to the value above: increase κ or e_el/γ", MAP),
    row(&[shift(KeyCode::Left), char('H')], CHART, "move-across -4", Act(|app| chart::step(app, -4, 0)), "", "move by four values to the left", MAP),
    row(&[shift(KeyCode::Right), char('L')], CHART, "move-across 4", Act(|app| chart::step(app, 4, 0)), "", "move by four values to the right", MAP),
    row(&[shift(KeyCode::Down), char('J')], CHART, "move-up -4", Act(|app| chart::step(app, 0, -4)), "", "move by four values down: half the κ, a quarter of e_el/γ", MAP),
    row(&[shift(KeyCode::Up), char('K')], CHART, "move-up 4", Act(|app| chart::step(app, 0, 4)), "", "move by four values up: twice the κ, four times e_el/γ", MAP),
    row(&[char('e')], CHART, "next-map-parameter", Act(chart::next_parameter), "e_el/γ", "map over e_el/γ in place of κ, or over κ again", MAP),
    row(&[char('V')], CHART, "next-charted", Silent(|app| app.chart.quantity = app.next_charted()), "quantity", "map another quantity: regime, F_a(0)/F_a,max, F_a/F_n; all recorded ones of a study", MAP),
    row(&[char('W')], CHART, "toggle-study", Act(chart::toggle_study), "", "show the map of the opened study, or the live map", MAP),
    row(&[char('P'), key(KeyCode::PageDown)], CHART, "next-slice 1", Act(|app| chart::step_slice(app, 1)), "", "show the next preload of the study, or value of a further axis; the scene follows", MAP),
    row(&[key(KeyCode::PageUp)], CHART, "next-slice -1", Act(|app| chart::step_slice(app, -1)), "", "show the previous one", MAP),

    row(&[char('o')], EXPLORE, "open-library", Act(library::open), "open", "open a scene: built-in, your own, or by path; or the folder of a study", SCENE),
    row(DIGITS.split_at(1).1, OTHER_PANES, "preset", Character(edit::open_built_in), "", "open a built-in scene by its number, unless the pane of parameters is selected", SCENE),
    row(&[char('s')], EXPLORE, "save", Silent(|app| files::ask_save(app, false)), "save", "save the scene to a file", SCENE),
    row(&[char('E')], EXPLORE, "export", Silent(files::ask_export), "export", "export curve (.csv, .npy), figures (.json), selected pane (.svg, .png) or screen (.txt)", SCENE),
    row(&[char('y')], EXPLORE, "copy-command", Act(files::copy_command), "copy", "copy the command that opens the present scene", SCENE),
    row(&[char(':'), control('p')], EXPLORE, "open-palette", Silent(dialogue::open_palette), "commands", "find a command by words of its description, and run it", SCENE),
    row(&[char('?'), key(KeyCode::F(1))], EXPLORE, "help", Silent(|app| app.mode = Mode::Help { scroll: 0 }), "help", "show this help", SCENE),
    row(&[char('q'), control('c')], EXPLORE, "quit", Silent(files::ask_quit), "quit", "quit", SCENE),
    row(&[control('z')], ANY, "suspend", Act(|_| vec![Effect::Suspend]), "", "suspend to the shell; fg resumes", SCENE),

    row(&[key(KeyCode::Down), char('j'), char(' ')], HELP, "select-row 1", Silent(|app| dialogue::select(app, 1)), "scroll", "scroll down", TEXT),
    row(&[key(KeyCode::Up), char('k')], HELP, "select-row -1", Silent(|app| dialogue::select(app, -1)), "", "scroll up", TEXT),
    row(&[key(KeyCode::Esc), char('?'), char('q'), key(KeyCode::F(1)), control('c')], HELP, "close-help", Act(dialogue::cancel), "back", "close the help", TEXT),
    row(&[key(KeyCode::Down), control('n')], SEARCHED, "select-row 1", Silent(|app| dialogue::select(app, 1)), "select", "select the row below", TEXT),
    row(&[key(KeyCode::Up), control('p')], SEARCHED, "select-row -1", Silent(|app| dialogue::select(app, -1)), "", "select the row above", TEXT),
    row(&[key(KeyCode::Enter)], TYPED, "accept", Act(dialogue::accept), "accept", "accept the typed text, or the selected row", TEXT),
    row(&[key(KeyCode::Tab)], TYPED, "complete", Act(dialogue::complete), "complete", "complete the typed path, in a value the one between quotes", TEXT),
    row(&[key(KeyCode::Esc), control('c')], TYPED, "cancel", Act(dialogue::cancel), "cancel", "cancel: keep the previous value", TEXT),
    row(&[key(KeyCode::Left), control('b')], TYPED, "move left", Silent(|app| dialogue::move_cursor(app, Motion::Left)), "", "move the cursor left", TEXT),
    row(&[key(KeyCode::Right), control('f')], TYPED, "move right", Silent(|app| dialogue::move_cursor(app, Motion::Right)), "", "move the cursor right", TEXT),
    row(&[key(KeyCode::Home), control('a')], TYPED, "move start", Silent(|app| dialogue::move_cursor(app, Motion::Start)), "", "move the cursor to the start", TEXT),
    row(&[key(KeyCode::End), control('e')], TYPED, "move end", Silent(|app| dialogue::move_cursor(app, Motion::End)), "", "move the cursor to the end", TEXT),
    row(&[key(KeyCode::Backspace), control('h')], TYPED, "delete-backwards", Act(|app| dialogue::edit_line(app, |line| line.delete(true))), "", "delete the character before the cursor", TEXT),
    row(&[key(KeyCode::Delete), control('d')], TYPED, "delete-forwards", Act(|app| dialogue::edit_line(app, |line| line.delete(false))), "", "delete the character under the cursor", TEXT),
    row(&[control('u')], TYPED, "clear", Act(|app| dialogue::edit_line(app, TextLine::clear)), "clear", "clear the typed text", TEXT),
    row(&[char('y')], ASK, "accept", Act(dialogue::accept), "overwrite", "overwrite the file", TEXT),
    row(&[char('n'), key(KeyCode::Esc), control('c')], ASK, "cancel", Act(dialogue::cancel), "keep it", "keep the existing file", TEXT),
    row(&[char('s')], LEAVE, "save-then-quit", Act(files::save_before_leaving), "save", "save, then quit", TEXT),
    row(&[char('q'), char('y'), control('c')], LEAVE, "quit-anyway", Silent(|app| app.finished = true), "quit", "quit without saving", TEXT),
    row(&[char('n'), key(KeyCode::Esc)], LEAVE, "cancel", Act(dialogue::cancel), "stay", "stay", TEXT),
];

/// Returns true for a key of manual loading.
#[must_use]
pub fn is_manual(row: &Binding) -> bool {
    row.section == MANUAL
}
