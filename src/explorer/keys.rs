//! The one table of keys: it feeds dispatch, footer, help and docs/keys.md.

use super::action::{Command, Jump, Motion};
use super::mode::ModeKind;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// A row of the table: keys, where they are valid, and what they do.
pub struct Binding {
    /// The keys.
    pub keys: &'static [Key],
    /// The modes in which they are valid.
    pub modes: &'static [ModeKind],
    /// What they do.
    pub command: Command,
    /// One word for the footer; empty where the footer leaves it out.
    pub label: &'static str,
    /// A line for the help.
    pub help: &'static str,
    /// The section of the help.
    pub section: &'static str,
}

/// A key with its modifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    code: KeyCode,
    modifiers: KeyModifiers,
}

impl Key {
    /// Whether a key event is this key. Shift is part of a character, not beside it.
    #[must_use]
    pub fn matches(&self, event: &KeyEvent) -> bool {
        let modifiers = match event.code {
            KeyCode::Char(_) | KeyCode::BackTab => event.modifiers - KeyModifiers::SHIFT,
            _ => event.modifiers,
        };
        self.code == event.code && self.modifiers == modifiers
    }

    /// The key as it is written on a keyboard.
    #[must_use]
    pub fn name(&self) -> String {
        let name = match self.code {
            KeyCode::Char(' ') => "space".to_owned(),
            KeyCode::Char(character) => character.to_string(),
            KeyCode::Up => "↑".to_owned(),
            KeyCode::Down => "↓".to_owned(),
            KeyCode::Left => "←".to_owned(),
            KeyCode::Right => "→".to_owned(),
            KeyCode::BackTab => "Shift+Tab".to_owned(),
            KeyCode::F(number) => format!("F{number}"),
            other => format!("{other:?}"),
        };
        let mut prefix = String::new();
        if self.modifiers.contains(KeyModifiers::CONTROL) {
            prefix.push_str("Ctrl+");
        }
        if self.modifiers.contains(KeyModifiers::SHIFT) {
            prefix.push_str("Shift+");
        }
        prefix + &name
    }
}

const fn key(code: KeyCode) -> Key {
    Key { code, modifiers: KeyModifiers::NONE }
}

const fn char(character: char) -> Key {
    key(KeyCode::Char(character))
}

const fn control(character: char) -> Key {
    Key { code: KeyCode::Char(character), modifiers: KeyModifiers::CONTROL }
}

const fn shift(code: KeyCode) -> Key {
    Key { code, modifiers: KeyModifiers::SHIFT }
}

/// Exploring, whichever pane is chosen.
const EXPLORE: &[ModeKind] = &[ModeKind::Explore, ModeKind::Chart];
/// What the arrows do beside them is done in the map by other keys.
const LIST: &[ModeKind] = &[ModeKind::Explore];
const CHART: &[ModeKind] = &[ModeKind::Chart];
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
];
const LIBRARY: &[ModeKind] = &[ModeKind::Library];
const ASK: &[ModeKind] = &[ModeKind::Overwrite];
const LEAVE: &[ModeKind] = &[ModeKind::Quit];
const ANY: &[ModeKind] = &ModeKind::ALL;

const ANIMATION: &str = "Animation";
const HAND: &str = "Body in hand";
const PARAMETERS: &str = "Parameters";
const COMPARE: &str = "Comparing";
const LOOK: &str = "Looking";
const MAP: &str = "Map over κ and H";
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
    Binding { keys, modes, command, label, help, section }
}

const fn step(steps: i32, coarse: bool) -> Command {
    Command::StepValue { steps, coarse }
}

const fn push(steps: i32, coarse: bool) -> Command {
    Command::Push { steps, coarse }
}

/// All keys. No mode gives a key two meanings; a test sees to it.
#[rustfmt::skip]
pub const BINDINGS: &[Binding] = &[
    row(&[char(' ')], EXPLORE, Command::TogglePlay, "play/pause", "play or pause", ANIMATION),
    row(&[char('.')], EXPLORE, Command::Step(1), "step", "one step forwards", ANIMATION),
    row(&[char(',')], EXPLORE, Command::Step(-1), "", "one step backwards", ANIMATION),
    row(&[char('r')], EXPLORE, Command::Restart, "restart", "play from the beginning", ANIMATION),
    row(&[char('>')], EXPLORE, Command::Leg(1), "", "to the start of the next leg", ANIMATION),
    row(&[char('<')], EXPLORE, Command::Leg(-1), "", "to the start of this leg or the one before", ANIMATION),

    row(&[char('d')], EXPLORE, Command::ToggleHand, "hand", "take the body in hand where it stands, or give it back", HAND),
    row(&[char(']')], EXPLORE, push(1, false), "", "press by a small step", HAND),
    row(&[char('[')], EXPLORE, push(-1, false), "", "pull by a small step", HAND),
    row(&[char('}')], EXPLORE, push(1, true), "", "press by a large step", HAND),
    row(&[char('{')], EXPLORE, push(-1, true), "", "pull by a large step", HAND),
    row(&[char('F')], EXPLORE, Command::TypeForce, "", "type the force to go to", HAND),
    row(&[char('S')], EXPLORE, Command::Separate, "", "pull until nothing touches", HAND),

    row(&[key(KeyCode::Up), char('k')], LIST, Command::Select(-1), "", "the parameter above", PARAMETERS),
    row(&[key(KeyCode::Down), char('j')], LIST, Command::Select(1), "select", "the parameter below", PARAMETERS),
    row(&[key(KeyCode::Home), char('g')], LIST, Command::SelectEnd(false), "", "the first parameter", PARAMETERS),
    row(&[key(KeyCode::End), char('G')], LIST, Command::SelectEnd(true), "", "the last parameter", PARAMETERS),
    row(&[key(KeyCode::Left), char('h')], LIST, step(-1, false), "", "a small step down", PARAMETERS),
    row(&[key(KeyCode::Right), char('l')], LIST, step(1, false), "change", "a small step up", PARAMETERS),
    row(&[shift(KeyCode::Left), char('H')], LIST, step(-1, true), "", "a large step down", PARAMETERS),
    row(&[shift(KeyCode::Right), char('L')], LIST, step(1, true), "", "a large step up", PARAMETERS),
    row(&[key(KeyCode::Enter), char('e')], LIST, Command::EditValue, "type", "type a value, with a prefix and unit if you like: 2.5 MPa, 10 µm, 50m", PARAMETERS),
    row(&[char('t')], LIST, Command::ToggleEffect, "on/off", "switch the effect of the selected row on or off", PARAMETERS),
    row(&[char('R')], EXPLORE, Command::Reseed, "reseed", "another random line", PARAMETERS),
    row(&[char('%')], EXPLORE, Command::TypeTolerance, "", "type a tolerance, 0.1 % or 1e-3: springs and edges that keep it are chosen", PARAMETERS),
    row(&[char('u')], EXPLORE, Command::Undo, "undo", "take back the last edit", PARAMETERS),
    row(&[char('U'), control('r')], EXPLORE, Command::Redo, "", "do it again", PARAMETERS),

    row(&[char('c')], EXPLORE, Command::Pin, "compare", "keep this loop as a ghost beside the next ones", COMPARE),
    row(&[char('x')], EXPLORE, Command::Swap, "", "exchange the scene with the newest ghost", COMPARE),
    row(&[char('C')], EXPLORE, Command::ClearGhosts, "", "let all ghosts go", COMPARE),

    row(&[char('v')], EXPLORE, Command::NextCurve, "", "the curve: force, contact length or fragments", LOOK),
    row(&[char('N')], EXPLORE, Command::ToggleNormalised, "", "the curve in units of F_a,max and h, or in SI units", LOOK),
    row(&[char('a')], EXPLORE, Command::ToggleLoss, "", "shade the area of the loop: the energy lost", LOOK),
    row(&[char('n')], EXPLORE, Command::Fragment(Jump::Next), "fragment", "close-up of the next fragment", LOOK),
    row(&[char('p')], EXPLORE, Command::Fragment(Jump::Previous), "", "close-up of the previous fragment", LOOK),
    row(&[char('b')], EXPLORE, Command::Fragment(Jump::Largest), "", "close-up of the longest fragment", LOOK),
    row(&[char('B')], EXPLORE, Command::Fragment(Jump::MostLoaded), "", "close-up of the fragment that carries the largest force", LOOK),
    row(&[char('f')], EXPLORE, Command::Fragment(Jump::Summit), "", "close-up of where the bodies touch first", LOOK),
    row(&[char('D')], EXPLORE, Command::ToggleLengths, "", "the distribution of fragment lengths in place of the close-up", LOOK),
    row(&[char('+'), char('=')], EXPLORE, Command::Zoom(1), "", "closer, in the profile where it is chosen, else in the close-up", LOOK),
    row(&[char('-')], EXPLORE, Command::Zoom(-1), "", "further away", LOOK),
    row(&[char('(')], EXPLORE, Command::Pan(-1), "", "to the left along the line", LOOK),
    row(&[char(')')], EXPLORE, Command::Pan(1), "", "to the right along the line", LOOK),
    row(&[char('w')], EXPLORE, Command::ToggleFollow, "", "let the profile follow the fragment of the close-up", LOOK),
    row(&[char('0')], EXPLORE, Command::ResetZoom, "", "the whole line again", LOOK),
    row(&[char('A')], EXPLORE, Command::ToggleAccuracy, "accuracy", "what accuracy costs and what ran, in place of profile and fragments", LOOK),
    row(&[key(KeyCode::Tab)], EXPLORE, Command::NextPane, "", "choose the next pane", LOOK),
    row(&[char('z')], EXPLORE, Command::ZoomPane, "zoom", "the chosen pane on the whole screen, or all panes", LOOK),
    row(&[char('T')], EXPLORE, Command::NextTheme, "", "other colours", LOOK),
    row(&[char('M')], EXPLORE, Command::NextMarker, "", "other markers: braille, octants, half blocks, ASCII", LOOK),

    row(&[char('m')], EXPLORE, Command::ToggleChart, "map", "which regime other κ and H would be in, in place of profile and fragments", MAP),
    row(&[key(KeyCode::Left), char('h')], CHART, Command::MoveKappa(-1), "", "less κ: the mark and the scene; moves in a row are one edit", MAP),
    row(&[key(KeyCode::Right), char('l')], CHART, Command::MoveKappa(1), "κ", "more κ", MAP),
    row(&[key(KeyCode::Down), char('j')], CHART, Command::MoveHurst(-1), "", "less H", MAP),
    row(&[key(KeyCode::Up), char('k')], CHART, Command::MoveHurst(1), "H", "more H", MAP),
    row(&[shift(KeyCode::Left), char('H')], CHART, Command::MoveKappa(-4), "", "four values less: half the κ", MAP),
    row(&[shift(KeyCode::Right), char('L')], CHART, Command::MoveKappa(4), "", "four values more: twice the κ", MAP),
    row(&[shift(KeyCode::Down), char('J')], CHART, Command::MoveHurst(-4), "", "much less H", MAP),
    row(&[shift(KeyCode::Up), char('K')], CHART, Command::MoveHurst(4), "", "much more H", MAP),
    row(&[char('X')], CHART, Command::ToggleSections, "sections", "sections through the mark: adhesion over κ and over H, or the map again", MAP),
    row(&[char('V')], CHART, Command::NextCharted, "quantity", "the glyphs: regime, F_a(0)/F_a,max or F_a/F_n; of a study all that it recorded", MAP),
    row(&[char('W')], CHART, Command::ToggleStudy, "", "the map of the study that was opened, or the one computed here", MAP),
    row(&[char('P'), key(KeyCode::PageDown)], CHART, Command::NextSlice(1), "", "the study's next preload, or value of a further axis; its scene follows", MAP),
    row(&[key(KeyCode::PageUp), control('p')], CHART, Command::NextSlice(-1), "", "the one before", MAP),

    row(&[char('o')], EXPLORE, Command::OpenLibrary, "open", "choose a scene: built-in ones and your own; or type the path of a scene or of a study's folder", SCENE),
    row(&[char('1')], EXPLORE, Command::Preset(0), "", "first built-in scene; 2 to 9: the others", SCENE),
    row(&[char('2')], EXPLORE, Command::Preset(1), "", "", SCENE),
    row(&[char('3')], EXPLORE, Command::Preset(2), "", "", SCENE),
    row(&[char('4')], EXPLORE, Command::Preset(3), "", "", SCENE),
    row(&[char('5')], EXPLORE, Command::Preset(4), "", "", SCENE),
    row(&[char('6')], EXPLORE, Command::Preset(5), "", "", SCENE),
    row(&[char('7')], EXPLORE, Command::Preset(6), "", "", SCENE),
    row(&[char('8')], EXPLORE, Command::Preset(7), "", "", SCENE),
    row(&[char('9')], EXPLORE, Command::Preset(8), "", "", SCENE),
    row(&[char('s')], EXPLORE, Command::Save, "save", "save the scene to a file", SCENE),
    row(&[char('E')], EXPLORE, Command::Export, "export", "export the curve (.csv), all figures (.json) or the panes (.svg, .txt)", SCENE),
    row(&[char('y')], EXPLORE, Command::CopyCommand, "copy", "copy the command that opens this scene as it stands", SCENE),
    row(&[char('?'), key(KeyCode::F(1))], EXPLORE, Command::Help, "help", "this help", SCENE),
    row(&[char('q'), control('c')], EXPLORE, Command::Quit, "quit", "leave", SCENE),
    row(&[control('z')], ANY, Command::Suspend, "", "back to the shell for a while; fg comes back", SCENE),

    row(&[key(KeyCode::Down), char('j'), char(' ')], HELP, Command::Select(1), "scroll", "further down", TEXT),
    row(&[key(KeyCode::Up), char('k')], HELP, Command::Select(-1), "", "further up", TEXT),
    row(&[key(KeyCode::Esc), char('?'), char('q'), key(KeyCode::F(1)), control('c')], HELP, Command::Help, "back", "back from the help", TEXT),
    row(&[key(KeyCode::Down), control('n')], LIBRARY, Command::Select(1), "select", "the scene below", TEXT),
    row(&[key(KeyCode::Up), control('p')], LIBRARY, Command::Select(-1), "", "the scene above", TEXT),
    row(&[key(KeyCode::Enter)], LIBRARY, Command::Accept, "open", "open the scene, or what is typed as a path", TEXT),
    row(&[key(KeyCode::Enter)], LINE, Command::Accept, "accept", "accept what is typed", TEXT),
    row(&[key(KeyCode::Esc), control('c')], TYPED, Command::Cancel, "cancel", "leave it as it was", TEXT),
    row(&[key(KeyCode::Left), control('b')], TYPED, Command::Move(Motion::Left), "", "left", TEXT),
    row(&[key(KeyCode::Right), control('f')], TYPED, Command::Move(Motion::Right), "", "right", TEXT),
    row(&[key(KeyCode::Home), control('a')], TYPED, Command::Move(Motion::Start), "", "to the start", TEXT),
    row(&[key(KeyCode::End), control('e')], TYPED, Command::Move(Motion::End), "", "to the end", TEXT),
    row(&[key(KeyCode::Backspace), control('h')], TYPED, Command::Delete { backwards: true }, "", "remove the character before the cursor", TEXT),
    row(&[key(KeyCode::Delete), control('d')], TYPED, Command::Delete { backwards: false }, "", "remove the character under the cursor", TEXT),
    row(&[control('u')], TYPED, Command::Clear, "clear", "empty the line", TEXT),
    row(&[char('y')], ASK, Command::Accept, "overwrite", "overwrite the file", TEXT),
    row(&[char('n'), key(KeyCode::Esc), control('c')], ASK, Command::Cancel, "keep it", "keep the file", TEXT),
    row(&[char('s')], LEAVE, Command::Save, "save", "save, then leave", TEXT),
    row(&[char('q'), char('y'), control('c')], LEAVE, Command::QuitAnyway, "quit", "leave without saving", TEXT),
    row(&[char('n'), key(KeyCode::Esc)], LEAVE, Command::Cancel, "stay", "stay", TEXT),
];

/// The command of a key in a mode.
#[must_use]
pub fn command(event: &KeyEvent, mode: ModeKind) -> Option<Command> {
    valid_in(mode).find(|row| row.keys.iter().any(|key| key.matches(event))).map(|row| row.command)
}

/// The rows of the table that are valid in a mode.
pub fn valid_in(mode: ModeKind) -> impl Iterator<Item = &'static Binding> {
    BINDINGS.iter().filter(move |row| row.modes.contains(&mode))
}

/// The table as Markdown, for docs/keys.md: keys and their functions, by section.
#[must_use]
pub fn markdown() -> String {
    let mut text = String::from("| | key | does |\n| --- | --- | --- |\n");
    let mut section = "";
    for row in BINDINGS.iter().filter(|row| !row.help.is_empty()) {
        let shown = if row.section == section { "" } else { row.section };
        section = row.section;
        let keys: Vec<String> = row.keys.iter().map(|key| format!("`{}`", key.name())).collect();
        text += &format!("| {shown} | {} | {} |\n", keys.join(" "), row.help);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_mode_gives_a_key_two_meanings() {
        for mode in ModeKind::ALL {
            let mut seen: Vec<Key> = Vec::new();
            for key in valid_in(mode).flat_map(|row| row.keys) {
                assert!(!seen.contains(key), "{} twice in {mode:?}", key.name());
                seen.push(*key);
            }
        }
    }

    #[test]
    fn every_mode_can_be_left() {
        for mode in ModeKind::ALL {
            let leaves = |command| {
                matches!(command, Command::Quit | Command::QuitAnyway | Command::Help | Command::Cancel)
            };
            let interrupt = KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL);
            assert!(command(&interrupt, mode).is_some_and(leaves), "Ctrl+C in {mode:?}");
        }
    }
}
