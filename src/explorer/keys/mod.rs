//! The one table of keys: it feeds dispatch, footer, help and docs/keys.md.

mod bindings;
mod key;

pub use bindings::{Bindings, RebindError, action_name, markdown};
pub use key::{Key, names};

use super::action::{Command, Jump, Motion};
use super::mode::ModeKind;
use super::panes::Pane;
use crossterm::event::KeyCode;
use key::{char, control, key, shift};
use std::borrow::Cow;

/// A row of the table: keys, where they are valid, and what they do.
#[derive(Clone, Debug, PartialEq)]
pub struct Binding {
    /// The keys.
    pub keys: Cow<'static, [Key]>,
    /// The modes in which they are valid.
    pub modes: &'static [ModeKind],
    /// Command.
    pub command: Command,
    /// One word for the footer; empty where the footer leaves it out.
    pub label: &'static str,
    /// A line for the help.
    pub help: &'static str,
    /// The section of the help.
    pub section: &'static str,
}

/// Exploring, whichever pane is chosen.
const EXPLORE: &[ModeKind] = &[ModeKind::Explore, ModeKind::Chart, ModeKind::Crosshair, ModeKind::Parameters];
/// In the map other keys do what the arrows do beside these.
const LIST: &[ModeKind] = &[ModeKind::Explore, ModeKind::Parameters];
/// In the list of parameters these characters begin a value.
const OTHER_PANES: &[ModeKind] = &[ModeKind::Explore, ModeKind::Chart, ModeKind::Crosshair];
const VALUES: &[ModeKind] = &[ModeKind::Parameters];
const CHART: &[ModeKind] = &[ModeKind::Chart];
const CROSSHAIR: &[ModeKind] = &[ModeKind::Crosshair];
const HELP: &[ModeKind] = &[ModeKind::Help];
const LINE: &[ModeKind] =
    &[ModeKind::Edit, ModeKind::Force, ModeKind::Tolerance, ModeKind::SaveAs, ModeKind::Export];
const TYPED: &[ModeKind] = &[
    ModeKind::Edit,
    ModeKind::Force,
    ModeKind::Tolerance,
    ModeKind::SaveAs,
    ModeKind::Export,
    ModeKind::Library,
    ModeKind::Find,
    ModeKind::Palette,
];
const LIBRARY: &[ModeKind] = &[ModeKind::Library];
const FIND: &[ModeKind] = &[ModeKind::Find];
const PALETTE: &[ModeKind] = &[ModeKind::Palette];
const SEARCHED: &[ModeKind] = &[ModeKind::Library, ModeKind::Find, ModeKind::Palette];
/// Lines with a path in them.
const PATH: &[ModeKind] = &[ModeKind::Edit, ModeKind::SaveAs, ModeKind::Export, ModeKind::Library];
const ASK: &[ModeKind] = &[ModeKind::Overwrite];
const SAVE: &[ModeKind] = &[ModeKind::SaveAs];
const COMMENTS: &[ModeKind] = &[ModeKind::StaleComments];
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
    command: Command,
    label: &'static str,
    help: &'static str,
    section: &'static str,
) -> Binding {
    Binding { keys: Cow::Borrowed(keys), modes, command, label, help, section }
}

const fn step(steps: i32, coarse: bool) -> Command {
    Command::StepValue { steps, coarse }
}

const fn cross(steps: i32, coarse: bool) -> Command {
    Command::MoveCrosshair { steps, coarse }
}

const fn push(steps: i32, coarse: bool) -> Command {
    Command::Push { steps, coarse }
}

/// All keys. No mode gives a key two meanings; a test sees to it.
#[rustfmt::skip]
pub const BINDINGS: &[Binding] = &[
    row(&[char(' ')], EXPLORE, Command::TogglePlay, "play", "play or pause", ANIMATION),
    row(&[char('.')], OTHER_PANES, Command::Step(1), "step", "one step forwards", ANIMATION),
    row(&[char(',')], EXPLORE, Command::Step(-1), "", "one step backwards", ANIMATION),
    row(&[char('r')], EXPLORE, Command::Restart, "restart", "play from the beginning", ANIMATION),
    row(&[char('>')], EXPLORE, Command::Leg(1), "", "jump to the start of the next loading stage", ANIMATION),
    row(&[char('<')], EXPLORE, Command::Leg(-1), "", "jump to the start of this loading stage or of the previous one", ANIMATION),

    row(&[char('d')], EXPLORE, Command::ToggleManual, "manual", "begin manual loading at the present indentation, or end it", MANUAL),
    row(&[char(']')], EXPLORE, push(1, false), "press/pull", "press by a small step", MANUAL),
    row(&[char('[')], EXPLORE, push(-1, false), "press/pull", "pull by a small step", MANUAL),
    row(&[char('}')], EXPLORE, push(1, true), "large step", "press by a large step", MANUAL),
    row(&[char('{')], EXPLORE, push(-1, true), "large step", "pull by a large step", MANUAL),
    row(&[char('F')], EXPLORE, Command::TypeForce, "force", "type a target force", MANUAL),
    row(&[char('S')], EXPLORE, Command::Separate, "separate", "pull to separation", MANUAL),

    row(&[key(KeyCode::Up), char('k')], LIST, Command::Select(-1), "", "select the parameter above", PARAMETERS),
    row(&[key(KeyCode::Down), char('j')], LIST, Command::Select(1), "select", "select the parameter below", PARAMETERS),
    row(&[key(KeyCode::Home), char('g')], LIST, Command::SelectEnd(false), "", "select the first parameter", PARAMETERS),
    row(&[key(KeyCode::End), char('G')], LIST, Command::SelectEnd(true), "", "select the last parameter", PARAMETERS),
    row(&[key(KeyCode::Left), char('h')], LIST, step(-1, false), "", "decrease the value by a small step", PARAMETERS),
    row(&[key(KeyCode::Right), char('l')], LIST, step(1, false), "change", "increase the value by a small step", PARAMETERS),
    row(&[shift(KeyCode::Left), char('H')], LIST, step(-1, true), "", "decrease the value by a large step", PARAMETERS),
    row(&[shift(KeyCode::Right), char('L')], LIST, step(1, true), "", "increase the value by a large step", PARAMETERS),
    row(&[key(KeyCode::Enter), char('e')], LIST, Command::EditValue, "type", "type a value, with an optional prefix and unit: 2.5 MPa, 10 µm, 50m", PARAMETERS),
    row(&VALUE_STARTS, VALUES, Command::StartValue('0'), "type", "type a number, while the pane of parameters is selected; not for a choice, a switch or a group", PARAMETERS),
    row(&[char('/')], EXPLORE, Command::FindParameter, "find", "find a parameter by letters of its name or symbol", PARAMETERS),
    row(&[char('Z')], LIST, Command::ToggleFold, "", "fold the group of the selected parameter, or unfold it", PARAMETERS),
    row(&[char('t')], LIST, Command::ToggleEffect, "on/off", "switch the effect of the selected row on or off", PARAMETERS),
    row(&[char('R')], EXPLORE, Command::Reseed, "reseed", "draw another random profile", PARAMETERS),
    row(&[char('%')], EXPLORE, Command::TypeTolerance, "", "type a tolerance (0.1 %, 1e-3): selects number of springs and edges", PARAMETERS),
    row(&[char('u')], EXPLORE, Command::Undo, "undo", "undo the last edit", PARAMETERS),
    row(&[char('U'), control('r')], EXPLORE, Command::Redo, "", "redo the edit", PARAMETERS),

    row(&[char('c')], EXPLORE, Command::Pin, "compare", "keep this loop as a ghost for comparison", COMPARE),
    row(&[char('x')], EXPLORE, Command::Swap, "", "swap the scene with the newest ghost", COMPARE),
    row(&[char('&')], EXPLORE, Command::ToggleSideBySide, "", "show the newest ghost beside the scene: profiles above each other, differences, F_a of both", COMPARE),
    row(&[char('|')], EXPLORE, Command::PinOtherUse, "", "keep the loop of the measured profile itself, or of its equivalent line, as a ghost", COMPARE),
    row(&[char('C')], EXPLORE, Command::ClearGhosts, "", "remove all ghosts", COMPARE),

    row(&[char('v')], EXPLORE, Command::NextCurve, "", "plot force, contact length or number of contact patches", LOOK),
    row(&[char('N')], EXPLORE, Command::ToggleNormalised, "", "plot in units of F_a,max and h, or in SI units", LOOK),
    row(&[char('O')], EXPLORE, Command::ToggleLogarithmic, "", "plot the curve with logarithmic axes, for numbers above zero, or with linear ones", LOOK),
    row(&[char('a')], EXPLORE, Command::ToggleLoss, "", "shade the area of the loop: the dissipated energy", LOOK),
    row(&[char('~')], EXPLORE, Command::ToggleApproximate, "", "draw the approximate JKR curve (Ciavarella 2018) under the loop: an estimate without hysteresis", LOOK),
    row(&[char('n')], EXPLORE, Command::Fragment(Jump::Next), "fragment", "show the next contact patch", LOOK),
    row(&[char('p')], EXPLORE, Command::Fragment(Jump::Previous), "", "show the previous contact patch", LOOK),
    row(&[char('b')], EXPLORE, Command::Fragment(Jump::Largest), "", "show the longest contact patch", LOOK),
    row(&[char('B')], EXPLORE, Command::Fragment(Jump::MostLoaded), "", "show the contact patch under the largest force", LOOK),
    row(&[char('f')], EXPLORE, Command::Fragment(Jump::Summit), "", "show the point of first touch", LOOK),
    row(&[char('D')], EXPLORE, Command::Toggle(Pane::Lengths), "", "show the distribution of patch lengths in place of the close-up", LOOK),
    row(&[char('+'), char('=')], EXPLORE, Command::Zoom(1), "", "zoom in: profile if selected, else close-up", LOOK),
    row(&[char('-')], OTHER_PANES, Command::Zoom(-1), "", "zoom out", LOOK),
    row(&[char('(')], EXPLORE, Command::Pan(-1), "", "pan left along the profile", LOOK),
    row(&[char(')')], EXPLORE, Command::Pan(1), "", "pan right along the profile", LOOK),
    row(&[char('w')], EXPLORE, Command::ToggleFollow, "", "keep the profile centred on the patch of the close-up", LOOK),
    row(&[char('0')], OTHER_PANES, Command::ResetZoom, "", "show the whole profile", LOOK),
    row(&[char('A')], EXPLORE, Command::Toggle(Pane::Accuracy), "accuracy", "show errors against time and the computing stages, in place of profile and close-up", LOOK),
    row(&[char('Q')], EXPLORE, Command::Toggle(Pane::Spectrum), "", "show spectra over the wave number q in place of profile and close-up", LOOK),
    row(&[char('i')], EXPLORE, Command::Toggle(Pane::Preloads), "", "show adhesion against preload, in place of profile and close-up", LOOK),
    row(&[key(KeyCode::Tab)], EXPLORE, Command::NextPane, "pane", "select the next pane", LOOK),
    row(&[char('z')], EXPLORE, Command::ZoomPane, "zoom", "show the selected pane on the whole screen, or all panes", LOOK),
    row(&[control('s')], EXPLORE, Command::RememberAppearance, "", "keep the present colours and markers in the configuration file", LOOK),
    row(&[char('I')], EXPLORE, Command::ToggleWork, "", "show springs and stage times in the status line, or contact, stiffness, pressure and energy", LOOK),
    row(&[char('T')], EXPLORE, Command::NextTheme, "", "change the colours", LOOK),
    row(&[char('M')], EXPLORE, Command::NextMarker, "", "change the markers: braille, octants, half blocks, ASCII", LOOK),

    row(&[char('*')], EXPLORE, Command::ToggleCrosshair, "read", "show or hide the crosshair: d, F, l, n on the force curve, x, z on profile and close-up", CROSS),
    row(&[key(KeyCode::Left), char('h')], CROSSHAIR, cross(-1, false), "", "move the crosshair left: along the loading stage, or along the profile", CROSS),
    row(&[key(KeyCode::Right), char('l')], CROSSHAIR, cross(1, false), "move", "move the crosshair right", CROSS),
    row(&[shift(KeyCode::Left), char('H')], CROSSHAIR, cross(-1, true), "", "move the crosshair left by a large step", CROSS),
    row(&[shift(KeyCode::Right), char('L')], CROSSHAIR, cross(1, true), "", "move the crosshair right by a large step", CROSS),
    row(&[key(KeyCode::Home), char('g')], CROSSHAIR, Command::CrosshairEnd(false), "", "move the crosshair to the left end", CROSS),
    row(&[key(KeyCode::End), char('G')], CROSSHAIR, Command::CrosshairEnd(true), "", "move the crosshair to the right end", CROSS),
    row(&[key(KeyCode::Up), char('k')], CROSSHAIR, Command::CrosshairStage(-1), "", "move to the previous loading stage at the same indentation", CROSS),
    row(&[key(KeyCode::Down), char('j')], CROSSHAIR, Command::CrosshairStage(1), "stage", "move to the next loading stage at the same indentation", CROSS),
    row(&[key(KeyCode::Esc)], CROSSHAIR, Command::ToggleCrosshair, "hide", "hide the crosshair", CROSS),

    row(&[char('m')], EXPLORE, Command::Toggle(Pane::Chart), "map", "show the regimes over H and κ or e_el/γ, in place of profile and close-up", MAP),
    row(&[key(KeyCode::Left), char('h')], CHART, Command::MoveAcross(-1), "", "move the scene to the value on the left: decrease H; successive moves are one edit", MAP),
    row(&[key(KeyCode::Right), char('l')], CHART, Command::MoveAcross(1), "move", "move the scene to the value on the right: increase H", MAP),
    row(&[key(KeyCode::Down), char('j')], CHART, Command::MoveUp(-1), "", "move the scene to the value below: decrease κ or e_el/γ", MAP),
    row(&[key(KeyCode::Up), char('k')], CHART, Command::MoveUp(1), "", "move the scene to the value above: increase κ or e_el/γ", MAP),
    row(&[shift(KeyCode::Left), char('H')], CHART, Command::MoveAcross(-4), "", "move by four values to the left", MAP),
    row(&[shift(KeyCode::Right), char('L')], CHART, Command::MoveAcross(4), "", "move by four values to the right", MAP),
    row(&[shift(KeyCode::Down), char('J')], CHART, Command::MoveUp(-4), "", "move by four values down: half the κ, a quarter of e_el/γ", MAP),
    row(&[shift(KeyCode::Up), char('K')], CHART, Command::MoveUp(4), "", "move by four values up: twice the κ, four times e_el/γ", MAP),
    row(&[char('t')], CHART, Command::TransposeMap, "axes", "exchange the axes of the map", MAP),
    row(&[char('e')], CHART, Command::NextMapParameter, "e_el/γ", "map over e_el/γ in place of κ, or over κ again", MAP),
    row(&[char('X')], CHART, Command::ToggleSections, "sections", "show sections through the scene along both axes, or the map", MAP),
    row(&[char('V')], CHART, Command::NextCharted, "quantity", "map another quantity: regime, F_a(0)/F_a,max, F_a/F_n; all recorded ones of a study", MAP),
    row(&[char('W')], CHART, Command::ToggleStudy, "", "show the map of the opened study, or the live map", MAP),
    row(&[char('P'), key(KeyCode::PageDown)], CHART, Command::NextSlice(1), "", "show the next preload of the study, or value of a further axis; the scene follows", MAP),
    row(&[key(KeyCode::PageUp)], CHART, Command::NextSlice(-1), "", "show the previous one", MAP),

    row(&[char('o')], EXPLORE, Command::OpenLibrary, "open", "open a scene: built-in, your own, or by path; or the folder of a study", SCENE),
    row(DIGITS.split_at(1).1, OTHER_PANES, Command::Preset(0), "", "open a built-in scene by its number, unless the pane of parameters is selected", SCENE),
    row(&[char('s')], EXPLORE, Command::Save, "save", "save the scene to a file", SCENE),
    row(&[char('E')], EXPLORE, Command::Export, "export", "export curve (.csv, .npy), figures (.json), panes (.svg, .png, .txt) or the selected map", SCENE),
    row(&[char('y')], EXPLORE, Command::CopyCommand, "copy", "copy the command that opens the present scene", SCENE),
    row(&[char(':'), control('p')], EXPLORE, Command::OpenPalette, "commands", "find a command by letters of its description, and run it", SCENE),
    row(&[char('?'), key(KeyCode::F(1))], EXPLORE, Command::Help, "help", "show this help", SCENE),
    row(&[char('q'), control('c')], EXPLORE, Command::Quit, "quit", "quit", SCENE),
    row(&[control('z')], ANY, Command::Suspend, "", "suspend to the shell; fg resumes", SCENE),

    row(&[key(KeyCode::Down), char('j'), char(' ')], HELP, Command::Select(1), "scroll", "scroll down", TEXT),
    row(&[key(KeyCode::Up), char('k')], HELP, Command::Select(-1), "", "scroll up", TEXT),
    row(&[key(KeyCode::Esc), char('?'), char('q'), key(KeyCode::F(1)), control('c')], HELP, Command::Help, "back", "close the help", TEXT),
    row(&[key(KeyCode::Down), control('n')], SEARCHED, Command::Select(1), "select", "select the row below", TEXT),
    row(&[key(KeyCode::Up), control('p')], SEARCHED, Command::Select(-1), "", "select the row above", TEXT),
    row(&[key(KeyCode::Enter)], FIND, Command::Accept, "go", "go to the selected parameter", TEXT),
    row(&[key(KeyCode::Enter)], LIBRARY, Command::Accept, "open", "open the selected scene, or the typed path", TEXT),
    row(&[key(KeyCode::Enter)], PALETTE, Command::Accept, "run", "run the selected command", TEXT),
    row(&[key(KeyCode::Tab)], PATH, Command::Complete, "complete", "complete the typed path, in a value the one between quotes; again for the next", TEXT),
    row(&[key(KeyCode::Enter)], LINE, Command::Accept, "accept", "accept the typed text", TEXT),
    row(&[key(KeyCode::Esc), control('c')], TYPED, Command::Cancel, "cancel", "cancel: keep the previous value", TEXT),
    row(&[key(KeyCode::Left), control('b')], TYPED, Command::Move(Motion::Left), "", "move the cursor left", TEXT),
    row(&[key(KeyCode::Right), control('f')], TYPED, Command::Move(Motion::Right), "", "move the cursor right", TEXT),
    row(&[key(KeyCode::Home), control('a')], TYPED, Command::Move(Motion::Start), "", "move the cursor to the start", TEXT),
    row(&[key(KeyCode::End), control('e')], TYPED, Command::Move(Motion::End), "", "move the cursor to the end", TEXT),
    row(&[key(KeyCode::Backspace), control('h')], TYPED, Command::Delete { backwards: true }, "", "delete the character before the cursor", TEXT),
    row(&[key(KeyCode::Delete), control('d')], TYPED, Command::Delete { backwards: false }, "", "delete the character under the cursor", TEXT),
    row(&[control('u')], TYPED, Command::Clear, "clear", "clear the typed text", TEXT),
    row(&[key(KeyCode::Down)], SAVE, Command::NextLine(1), "title, notice", "edit the title, the notice, or the name of the file", TEXT),
    row(&[key(KeyCode::Up)], SAVE, Command::NextLine(-1), "", "edit the line before", TEXT),
    row(&[char('y')], COMMENTS, Command::Accept, "remove", "save without the comments about changed values", TEXT),
    row(&[char('n')], COMMENTS, Command::Refuse, "keep", "save with all comments", TEXT),
    row(&[key(KeyCode::Esc), control('c')], COMMENTS, Command::Cancel, "back", "do not save", TEXT),
    row(&[char('y')], ASK, Command::Accept, "overwrite", "overwrite the file", TEXT),
    row(&[char('n'), key(KeyCode::Esc), control('c')], ASK, Command::Cancel, "keep it", "keep the existing file", TEXT),
    row(&[char('s')], LEAVE, Command::Save, "save", "save, then quit", TEXT),
    row(&[char('q'), char('y'), control('c')], LEAVE, Command::QuitAnyway, "quit", "quit without saving", TEXT),
    row(&[char('n'), key(KeyCode::Esc)], LEAVE, Command::Cancel, "stay", "stay", TEXT),
];

/// A row of the keys of manual loading.
#[must_use]
pub fn is_manual(row: &Binding) -> bool {
    row.section == MANUAL
}
