//! Decoder, which converts the bytes of a terminal to keys, pasted texts and gestures of the mouse,
//! and to the colour of the background that the terminal states when it is asked.
//! If the line to the terminal breaks, only the beginning of a key or of a paste may arrive. After
//! a pause the decoder takes this beginning as complete, so that later keys are read correctly.

use super::terminal_input::Input;
use asperity_plot::Background;
use crossterm::event::{
    Event, KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind,
};
use std::time::Duration;

/// Longest pause between the bytes of a key. On a slow line, these bytes may arrive separately.
const SEQUENCE_PAUSE: Duration = Duration::from_millis(80);

/// Longest pause within the answer about the colour of the background. It is long, because the rest
/// of an answer that is ended too early would be read as keys.
const ANSWER_PAUSE: Duration = Duration::from_millis(400);

/// Longest pause within a pasted text. It is long, because after a paste that is ended too early
/// the rest of the text would be read as keys.
const PASTE_PAUSE: Duration = Duration::from_secs(1);

/// Largest number of parameter bytes that are stored for a sequence or an answer. All known
/// sequences are shorter.
const LONGEST_SEQUENCE: usize = 64;

const ESCAPE: u8 = 0x1b;
const INTERRUPT: u8 = 0x03;
const SUSPEND: u8 = 0x1a;
const BELL: u8 = 0x07;

const PASTE_END: &[u8] = b"\x1b[201~";

/// Beginning of the answer about the colour of the background, after `ESC ]`.
const BACKGROUND_ANSWER: &[u8] = b"11;rgb";

/// Input that has begun and is not complete yet.
#[derive(Debug, Default)]
enum Pending {
    #[default]
    Nothing,
    /// The first bytes of a character in UTF-8.
    Character { bytes: Vec<u8>, is_alt: bool },
    /// `ESC`, which is either the escape key or the beginning of a sequence.
    Escape,
    /// `ESC O`, the beginning of a key in the application mode.
    Application,
    /// `ESC [`, which parameters follow. The value contains the parameters read so far.
    Control(Vec<u8>),
    /// `ESC [ [`, the beginning of a function key on the Linux console.
    Console,
    /// `ESC [ M`, the beginning of a gesture of the mouse. The value contains those of the three
    /// following bytes that have been read.
    Gesture(Vec<u8>),
    /// `ESC ]`, `ESC P` or `ESC _`, the beginning of an answer of the terminal. The answer ends
    /// with `BEL` or `ESC \`. The value contains the beginning of its text.
    Answer(Vec<u8>),
    /// `ESC` inside an answer of the terminal, which may be the beginning of its end. The value
    /// contains the beginning of the text of the answer.
    EscapeInAnswer(Vec<u8>),
    /// `ESC [ 200 ~`, the beginning of a pasted text. The value contains the text read so far.
    Paste(Vec<u8>),
}

/// Decoder, which converts the bytes of a terminal to events such as a pressed key.
#[derive(Debug, Default)]
pub struct Decoder {
    pending: Pending,
    decoded: Vec<Input>,
}

impl Decoder {
    /// Reads bytes that arrived together, and returns the input that is now complete.
    pub fn read(&mut self, bytes: &[u8]) -> Vec<Input> {
        if let Pending::Paste(_) = self.pending
            && bytes.iter().all(|byte| *byte == INTERRUPT)
        {
            // Pasted text arrives in larger pieces. Therefore a piece that consists only of Ctrl+C
            // bytes comes from the user.
            self.end();
        }
        for byte in bytes {
            self.read_byte(*byte);
        }
        std::mem::take(&mut self.decoded)
    }

    /// Returns how long the caller should wait for the rest of an incomplete key or paste. `None`
    /// if the input so far is complete.
    pub fn pause(&self) -> Option<Duration> {
        match &self.pending {
            Pending::Nothing => None,
            Pending::Paste(_) => Some(PASTE_PAUSE),
            Pending::Answer(text) if text.starts_with(BACKGROUND_ANSWER) => Some(ANSWER_PAUSE),
            _ => Some(SEQUENCE_PAUSE),
        }
    }

    /// Takes the incomplete input as complete, because the rest does not arrive, and returns its
    /// events. A single ESC becomes the escape key, and an incomplete paste becomes the text read
    /// so far.
    pub fn give_up(&mut self) -> Vec<Input> {
        self.end();
        std::mem::take(&mut self.decoded)
    }

    fn end(&mut self) {
        match std::mem::take(&mut self.pending) {
            Pending::Escape => self.press(KeyCode::Esc, KeyModifiers::NONE),
            Pending::Paste(text) => self.end_paste(&text),
            _ => {}
        }
    }

    /// Ends a paste whose end sequence is missing or incomplete. If the pasted text contains a
    /// Ctrl+C, the user has tried to interrupt the explorer, so a press of Ctrl+C is added after
    /// the text.
    fn end_paste(&mut self, text: &[u8]) {
        let mut end = text.len();
        for length in 1..PASTE_END.len() {
            if text.ends_with(&PASTE_END[..length]) {
                end = text.len() - length;
            }
        }
        let is_interrupted = text.contains(&INTERRUPT);
        let kept: Vec<u8> = text[..end]
            .iter()
            .copied()
            .filter(|byte| *byte != INTERRUPT)
            .collect();
        self.paste(&kept);
        if is_interrupted {
            self.read_byte(INTERRUPT);
        }
    }

    fn paste(&mut self, text: &[u8]) {
        let text = String::from_utf8_lossy(text).into_owned();
        self.push(Event::Paste(text));
    }

    fn press(&mut self, code: KeyCode, modifiers: KeyModifiers) {
        self.push(Event::Key(KeyEvent::new(code, modifiers)));
    }

    fn push(&mut self, event: Event) {
        self.decoded.push(Input::Event(event));
    }

    fn read_byte(&mut self, byte: u8) {
        match std::mem::take(&mut self.pending) {
            Pending::Nothing => self.begin(byte, false),
            Pending::Character { bytes, is_alt } => self.continue_character(bytes, is_alt, byte),
            Pending::Escape => self.continue_escape(byte),
            Pending::Application => match application_key(byte) {
                Some(code) => self.press(code, KeyModifiers::NONE),
                None => self.begin_unless_text(byte),
            },
            Pending::Control(parameters) => self.continue_control(parameters, byte),
            Pending::Console => match byte {
                b'A'..=b'E' => self.press(KeyCode::F(1 + byte - b'A'), KeyModifiers::NONE),
                _ => self.begin_unless_text(byte),
            },
            Pending::Gesture(bytes) => self.continue_gesture(bytes, byte),
            Pending::Answer(text) => self.continue_answer(text, byte),
            Pending::EscapeInAnswer(text) => match byte {
                b'\\' => self.end_answer(&text),
                _ => self.continue_escape(byte),
            },
            Pending::Paste(mut text) => {
                text.push(byte);
                match text.strip_suffix(PASTE_END) {
                    Some(whole) => self.paste(whole),
                    None => self.pending = Pending::Paste(text),
                }
            }
        }
    }

    fn continue_answer(&mut self, mut text: Vec<u8>, byte: u8) {
        match byte {
            BELL => self.end_answer(&text),
            ESCAPE => self.pending = Pending::EscapeInAnswer(text),
            // This byte is no part of an answer, so the rest of the answer is missing.
            ..b' ' => self.begin(byte, false),
            _ if text.starts_with(BACKGROUND_ANSWER) && !is_of_colour(byte) => {
                self.begin(byte, false);
            }
            _ => {
                if text.len() < LONGEST_SEQUENCE {
                    text.push(byte);
                }
                self.pending = Pending::Answer(text);
            }
        }
    }

    fn end_answer(&mut self, text: &[u8]) {
        if let Some(background) = background(text) {
            self.decoded.push(Input::Background(background));
        }
    }

    /// Begins a new key with its first byte.
    fn begin(&mut self, byte: u8, is_alt: bool) {
        let alt = if is_alt {
            KeyModifiers::ALT
        } else {
            KeyModifiers::NONE
        };
        let control = alt | KeyModifiers::CONTROL;
        match byte {
            ESCAPE => self.pending = Pending::Escape,
            b'\r' => self.press(KeyCode::Enter, alt),
            b'\t' => self.press(KeyCode::Tab, alt),
            0x7f => self.press(KeyCode::Backspace, alt),
            0 => self.press(KeyCode::Char(' '), control),
            0x01..=0x1a => self.press(KeyCode::Char(char::from(byte - 1 + b'a')), control),
            0x1c..=0x1f => self.press(KeyCode::Char(char::from(byte - 0x1c + b'4')), control),
            0x20..=0x7e => self.press_character(char::from(byte), is_alt),
            0xc2..=0xf4 => {
                self.pending = Pending::Character {
                    bytes: vec![byte],
                    is_alt,
                }
            }
            // No character in UTF-8 begins with these bytes.
            0x80..=0xc1 | 0xf5..=0xff => {}
        }
    }

    /// Handles a byte that does not fit the incomplete sequence. A printable byte is dropped,
    /// because it belongs to this broken sequence. A control character or ESC begins a new key.
    fn begin_unless_text(&mut self, byte: u8) {
        if byte < b' ' {
            self.begin(byte, false);
        }
    }

    fn press_character(&mut self, character: char, is_alt: bool) {
        let mut modifiers = KeyModifiers::NONE;
        modifiers.set(KeyModifiers::ALT, is_alt);
        modifiers.set(KeyModifiers::SHIFT, character.is_uppercase());
        self.press(KeyCode::Char(character), modifiers);
    }

    fn continue_character(&mut self, mut bytes: Vec<u8>, is_alt: bool, byte: u8) {
        if !(0x80..=0xbf).contains(&byte) {
            return self.begin(byte, false);
        }
        bytes.push(byte);
        match std::str::from_utf8(&bytes) {
            Ok(text) => {
                for character in text.chars() {
                    self.press_character(character, is_alt);
                }
            }
            // The character needs more bytes.
            Err(error) if error.error_len().is_none() => {
                self.pending = Pending::Character { bytes, is_alt };
            }
            Err(_) => {}
        }
    }

    fn continue_escape(&mut self, byte: u8) {
        match byte {
            b'[' => self.pending = Pending::Control(Vec::new()),
            b'O' => self.pending = Pending::Application,
            b']' | b'P' | b'_' => self.pending = Pending::Answer(Vec::new()),
            ESCAPE | INTERRUPT | SUSPEND => {
                self.press(KeyCode::Esc, KeyModifiers::NONE);
                self.begin(byte, false);
            }
            _ => self.begin(byte, true),
        }
    }

    fn continue_control(&mut self, mut parameters: Vec<u8>, byte: u8) {
        match byte {
            b'[' if parameters.is_empty() => self.pending = Pending::Console,
            b'M' if parameters.is_empty() => self.pending = Pending::Gesture(Vec::new()),
            b'~' if parameters == b"200" => self.pending = Pending::Paste(Vec::new()),
            0x20..=0x3f => {
                if parameters.len() < LONGEST_SEQUENCE {
                    parameters.push(byte);
                }
                self.pending = Pending::Control(parameters);
            }
            0x40..=0x7e => {
                let parameters = String::from_utf8_lossy(&parameters);
                let event = control_event(&parameters, byte);
                self.decoded.extend(event.map(Input::Event));
            }
            _ => self.begin(byte, false),
        }
    }

    fn continue_gesture(&mut self, mut bytes: Vec<u8>, byte: u8) {
        // The terminal sends each of the three numbers increased by 32.
        let Some(number) = byte.checked_sub(b' ') else {
            return self.begin(byte, false);
        };
        bytes.push(number);
        match bytes[..] {
            [button, column, row] => {
                let event = mouse_event(button, column.into(), row.into(), false);
                self.decoded.extend(event.map(Input::Event));
            }
            _ => self.pending = Pending::Gesture(bytes),
        }
    }
}

/// Returns true for the bytes of a colour such as `rgba:1e1e/1e1e/1e1e/ffff`.
fn is_of_colour(byte: u8) -> bool {
    byte.is_ascii_hexdigit() || b"rgba:/".contains(&byte)
}

/// Returns the brightness of the background from the text of an answer such as
/// `11;rgb:1e1e/1e1e/1e1e`. `None` if the answer is about something else.
fn background(text: &[u8]) -> Option<Background> {
    let text = std::str::from_utf8(text).ok()?;
    let (_, colour) = text.strip_prefix("11;")?.split_once(':')?;
    let mut shares = Vec::new();
    for part in colour.split('/').take(3) {
        // The number of digits is that of the terminal: from 1 to 4.
        let largest = 16_u32.checked_pow(u32::try_from(part.len()).ok()?)? - 1;
        let value = u32::from_str_radix(part, 16).ok()?;
        shares.push(f64::from(value) / f64::from(largest.max(1)));
    }
    let [red, green, blue] = shares[..] else {
        return None;
    };
    Some(Background::of_colour([red, green, blue]))
}

/// Returns the key for the byte after the bytes `ESC O`.
fn application_key(byte: u8) -> Option<KeyCode> {
    match byte {
        b'P'..=b'S' => Some(KeyCode::F(1 + byte - b'P')),
        _ => moving_key(byte),
    }
}

/// Returns the key for the letter after the bytes `ESC O` or `ESC [`.
fn moving_key(letter: u8) -> Option<KeyCode> {
    match letter {
        b'A' => Some(KeyCode::Up),
        b'B' => Some(KeyCode::Down),
        b'C' => Some(KeyCode::Right),
        b'D' => Some(KeyCode::Left),
        b'H' => Some(KeyCode::Home),
        b'F' => Some(KeyCode::End),
        _ => None,
    }
}

/// Returns the key for a number that a terminal sends before `~`.
fn numbered_key(number: u8) -> Option<KeyCode> {
    match number {
        1 | 7 => Some(KeyCode::Home),
        2 => Some(KeyCode::Insert),
        3 => Some(KeyCode::Delete),
        4 | 8 => Some(KeyCode::End),
        5 => Some(KeyCode::PageUp),
        6 => Some(KeyCode::PageDown),
        11..=15 => Some(KeyCode::F(number - 10)),
        17..=21 => Some(KeyCode::F(number - 11)),
        23..=26 => Some(KeyCode::F(number - 12)),
        28..=29 => Some(KeyCode::F(number - 15)),
        31..=34 => Some(KeyCode::F(number - 17)),
        _ => None,
    }
}

/// Returns the event for a sequence that consists of `ESC [`, these parameters and this last byte.
/// Returns `None` for an answer of the terminal, and for a key that the explorer does not use.
fn control_event(parameters: &str, last: u8) -> Option<Event> {
    if let Some(gesture) = parameters.strip_prefix('<') {
        return if matches!(last, b'M' | b'm') {
            sgr_mouse_event(gesture, last == b'm')
        } else {
            None
        };
    }
    let mut numbers = parameters.split(';');
    let first = numbers.next().unwrap_or_default();
    let (mask, kind) = match numbers.next() {
        Some(state) => state.split_once(':').unwrap_or((state, "1")),
        None => ("1", "1"),
    };
    const RELEASED: &str = "3";
    if kind == RELEASED {
        return None;
    }
    let modifiers = modifiers_of(mask.parse().ok()?);
    let code = match last {
        b'~' => numbered_key(first.parse().ok()?)?,
        b'u' => coded_key(first.split(':').next()?.parse().ok()?)?,
        b'Z' => {
            return Some(Event::Key(KeyEvent::new(
                KeyCode::BackTab,
                modifiers | KeyModifiers::SHIFT,
            )));
        }
        // `ESC [ … R` is missing here, because it is not a key but an answer of the terminal: the
        // position of the cursor.
        b'P' | b'Q' | b'S' if matches!(first, "" | "1") => application_key(last)?,
        _ if matches!(first, "" | "1") => moving_key(last)?,
        _ => return None,
    };
    Some(Event::Key(KeyEvent::new(code, modifiers)))
}

/// Returns the modifiers of a key from the number `mask`, which is 1 plus the sum of the bits of
/// the modifiers.
fn modifiers_of(mask: u8) -> KeyModifiers {
    let bits = mask.saturating_sub(1);
    let mut modifiers = KeyModifiers::NONE;
    modifiers.set(KeyModifiers::SHIFT, bits & 1 != 0);
    modifiers.set(KeyModifiers::ALT, bits & 2 != 0);
    modifiers.set(KeyModifiers::CONTROL, bits & 4 != 0);
    modifiers.set(KeyModifiers::SUPER, bits & 8 != 0);
    modifiers.set(KeyModifiers::HYPER, bits & 16 != 0);
    modifiers.set(KeyModifiers::META, bits & 32 != 0);
    modifiers
}

/// Returns the key for a character code that a terminal sends before `u`.
fn coded_key(code: u32) -> Option<KeyCode> {
    match char::from_u32(code)? {
        '\x1b' => Some(KeyCode::Esc),
        '\r' => Some(KeyCode::Enter),
        '\t' => Some(KeyCode::Tab),
        '\x7f' => Some(KeyCode::Backspace),
        character => Some(KeyCode::Char(character)),
    }
}

/// Returns the gesture of the mouse for the parameters `button;column;row`.
fn sgr_mouse_event(parameters: &str, is_release: bool) -> Option<Event> {
    let mut numbers = parameters.split(';');
    let button = numbers.next()?.parse().ok()?;
    let column = numbers.next()?.parse().ok()?;
    let row = numbers.next()?.parse().ok()?;
    mouse_event(button, column, row, is_release)
}

/// Returns the gesture of the mouse; `None` if the explorer does not use it. Column and row are
/// counted from 1.
fn mouse_event(button: u8, column: u16, row: u16, is_release: bool) -> Option<Event> {
    const MODIFIERS: u8 = 4 + 8 + 16;
    let kind = match (button & !MODIFIERS, is_release) {
        (0, false) => MouseEventKind::Down(MouseButton::Left),
        (0, true) => MouseEventKind::Up(MouseButton::Left),
        (32, false) => MouseEventKind::Drag(MouseButton::Left),
        (64, false) => MouseEventKind::ScrollUp,
        (65, false) => MouseEventKind::ScrollDown,
        _ => return None,
    };
    Some(Event::Mouse(MouseEvent {
        kind,
        column: column.checked_sub(1)?,
        row: row.checked_sub(1)?,
        modifiers: KeyModifiers::NONE,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn key(code: KeyCode, modifiers: KeyModifiers) -> Input {
        Input::Event(Event::Key(KeyEvent::new(code, modifiers)))
    }

    fn plain(code: KeyCode) -> Input {
        key(code, KeyModifiers::NONE)
    }

    fn letter(character: char) -> Input {
        plain(KeyCode::Char(character))
    }

    fn interrupt() -> Input {
        key(KeyCode::Char('c'), KeyModifiers::CONTROL)
    }

    fn mouse(kind: MouseEventKind, column: u16, row: u16) -> Input {
        Input::Event(Event::Mouse(MouseEvent {
            kind,
            column,
            row,
            modifiers: KeyModifiers::NONE,
        }))
    }

    /// Returns sequences that terminals send, each with the event that it means.
    fn sequences() -> Vec<(&'static [u8], Input)> {
        let shift = KeyModifiers::SHIFT;
        let alt = KeyModifiers::ALT;
        let control = KeyModifiers::CONTROL;
        vec![
            (b"j", letter('j')),
            (b"J", key(KeyCode::Char('J'), shift)),
            ("µ".as_bytes(), letter('µ')),
            ("漢".as_bytes(), letter('漢')),
            (b"\r", plain(KeyCode::Enter)),
            (b"\n", key(KeyCode::Char('j'), control)),
            (b"\t", plain(KeyCode::Tab)),
            (b"\x7f", plain(KeyCode::Backspace)),
            (b"\x08", key(KeyCode::Char('h'), control)),
            (b"\x03", interrupt()),
            (b"\x1a", key(KeyCode::Char('z'), control)),
            (b"\x1c", key(KeyCode::Char('4'), control)),
            (b"\0", key(KeyCode::Char(' '), control)),
            (b"\x1bx", key(KeyCode::Char('x'), alt)),
            ("\x1bµ".as_bytes(), key(KeyCode::Char('µ'), alt)),
            (b"\x1b\x7f", key(KeyCode::Backspace, alt)),
            (b"\x1b[A", plain(KeyCode::Up)),
            (b"\x1b[B", plain(KeyCode::Down)),
            (b"\x1bOC", plain(KeyCode::Right)),
            (b"\x1b[1;2D", key(KeyCode::Left, shift)),
            (b"\x1b[1;5:2C", key(KeyCode::Right, control)),
            (b"\x1b[H", plain(KeyCode::Home)),
            (b"\x1bOF", plain(KeyCode::End)),
            (b"\x1b[Z", key(KeyCode::BackTab, shift)),
            (b"\x1b[3~", plain(KeyCode::Delete)),
            (b"\x1b[5~", plain(KeyCode::PageUp)),
            (b"\x1b[6;5~", key(KeyCode::PageDown, control)),
            (b"\x1bOP", plain(KeyCode::F(1))),
            (b"\x1b[[B", plain(KeyCode::F(2))),
            (b"\x1b[15~", plain(KeyCode::F(5))),
            (b"\x1b[24~", plain(KeyCode::F(12))),
            (b"\x1b[1;2P", key(KeyCode::F(1), shift)),
            (b"\x1b[97;5u", key(KeyCode::Char('a'), control)),
            (
                b"\x1b[<0;30;7M",
                mouse(MouseEventKind::Down(MouseButton::Left), 29, 6),
            ),
            (
                b"\x1b[<0;30;7m",
                mouse(MouseEventKind::Up(MouseButton::Left), 29, 6),
            ),
            (
                b"\x1b[<36;1;300M",
                mouse(MouseEventKind::Drag(MouseButton::Left), 0, 299),
            ),
            (b"\x1b[<64;2;3M", mouse(MouseEventKind::ScrollUp, 1, 2)),
            (
                b"\x1b[M\x61\x22\x23",
                mouse(MouseEventKind::ScrollDown, 1, 2),
            ),
            (
                b"\x1b[200~1\r\n \x1b[A\x03 mN\x1b[201~",
                Input::Event(Event::Paste("1\r\n \x1b[A\x03 mN".to_owned())),
            ),
        ]
    }

    #[test]
    fn each_sequence_is_one_event_however_it_arrives() {
        for (bytes, event) in sequences() {
            for split in 0..bytes.len() {
                let mut decoder = Decoder::default();
                let mut events = decoder.read(&bytes[..split]);
                events.extend(decoder.read(&bytes[split..]));
                assert_eq!(
                    events,
                    std::slice::from_ref(&event),
                    "{} at {split}",
                    bytes.escape_ascii()
                );
                assert_eq!(decoder.pause(), None, "{} at {split}", bytes.escape_ascii());
            }
        }
    }

    #[test]
    fn all_sequences_in_a_row_are_their_events() {
        let sequences = sequences();
        let bytes: Vec<u8> = sequences
            .iter()
            .flat_map(|(bytes, _)| bytes.iter().copied())
            .collect();
        let events: Vec<Input> = sequences.into_iter().map(|(_, event)| event).collect();
        // A piece of one byte is left out, because inside a paste it could be a Ctrl+C.
        for size in 2..40 {
            let mut decoder = Decoder::default();
            let read: Vec<Input> = bytes
                .chunks(size)
                .flat_map(|piece| decoder.read(piece))
                .collect();
            assert_eq!(read, events, "pieces of {size}");
        }
    }

    #[test]
    fn answers_of_the_terminal_are_no_keys() {
        let answers = [
            "\x1b[?64;1;2c",
            "\x1b[>0;10;1c",
            "\x1b[24;80R",
            "\x1b[?1u",
            "\x1b[?2026;2$y",
            "\x1b]10;rgb:ffff/ffff/ffff\x07",
            "\x1b]11;rgb:ffff\x07",
            "\x1b]11;?\x1b\\",
            "\x1bP1+r636f=383\x1b\\",
            "\x1b_Gi=1;OK\x1b\\",
            "\x1b[I",
            "\x1b[O",
            "\x1b[97;5:3u",
            "\x1b[<35;20;10M",
            "\x1b[<0;0;0M",
        ];
        for answer in answers {
            let mut decoder = Decoder::default();
            assert_eq!(
                decoder.read(format!("{answer}j").as_bytes()),
                [letter('j')],
                "{answer:?}"
            );
        }
    }

    #[test]
    fn the_background_is_light_dark_or_between() {
        for (colour, background) in [
            ("rgb:ffff/ffff/ffff", Background::Light),
            ("rgb:fdfd/f6f6/e3e3", Background::Light),
            ("rgb:0/0/0", Background::Dark),
            ("rgb:00/2b/36", Background::Dark),
            ("rgba:1e1e/1e1e/1e1e/ffff", Background::Dark),
            ("rgb:8080/8080/8080", Background::Unknown),
        ] {
            for end in ["\x07", "\x1b\\"] {
                let answer = format!("\x1b]11;{colour}{end}");
                for split in 0..answer.len() {
                    let (first, second) = answer.split_at(split);
                    let mut decoder = Decoder::default();
                    let mut read = decoder.read(first.as_bytes());
                    read.extend(decoder.read(second.as_bytes()));
                    assert_eq!(read, [Input::Background(background)], "{answer:?}");
                }
            }
        }
    }

    /// The rest of an answer that a slow line splits is still awaited, and a key that is no part of
    /// a colour counts at once.
    #[test]
    fn an_answer_in_two_pieces_types_nothing() {
        let mut decoder = Decoder::default();
        assert_eq!(decoder.read(b"\x1b]11;rgb:ff"), []);
        assert_eq!(decoder.pause(), Some(ANSWER_PAUSE));
        assert_eq!(
            decoder.read(b"\x0c"),
            [key(KeyCode::Char('l'), KeyModifiers::CONTROL)]
        );
        assert_eq!(decoder.read(b"\x1b]11;rgb:ff?"), [letter('?')]);
        assert_eq!(decoder.pause(), None);
        assert_eq!(decoder.read(b"\x1b]52;c"), []);
        assert_eq!(decoder.pause(), Some(SEQUENCE_PAUSE));
    }

    #[test]
    fn the_escape_key_is_known_after_a_pause_or_with_the_next_one() {
        let mut decoder = Decoder::default();
        assert_eq!(decoder.read(b"\x1b"), []);
        assert_eq!(decoder.pause(), Some(SEQUENCE_PAUSE));
        assert_eq!(decoder.give_up(), [plain(KeyCode::Esc)]);
        assert_eq!(decoder.pause(), None);
        assert_eq!(
            decoder.read(b"\x1b\x1b\x1b[A"),
            [plain(KeyCode::Esc), plain(KeyCode::Esc), plain(KeyCode::Up)]
        );
        assert_eq!(
            decoder.read(b"\x1b\x03"),
            [plain(KeyCode::Esc), interrupt()]
        );
    }

    #[test]
    fn a_paste_without_its_end_is_its_text_and_a_ctrl_c_ends_it() {
        let paste = |text: &str| Input::Event(Event::Paste(text.to_owned()));
        let begun = |bytes: &[u8]| {
            let mut decoder = Decoder::default();
            assert_eq!(decoder.read(bytes), []);
            assert_eq!(decoder.pause(), Some(PASTE_PAUSE));
            decoder
        };
        assert_eq!(begun(b"\x1b[200~abc").give_up(), [paste("abc")]);
        assert_eq!(begun(b"\x1b[200~abc\x1b[20").give_up(), [paste("abc")]);
        assert_eq!(
            begun(b"\x1b[200~abc\x03").give_up(),
            [paste("abc"), interrupt()]
        );
        let mut decoder = begun(b"\x1b[200~abc");
        assert_eq!(decoder.read(b"\x03"), [paste("abc"), interrupt()]);
        assert_eq!(decoder.pause(), None);
    }

    proptest! {
        /// Most of these bytes begin sequences. Nevertheless the next key after a pause, and a
        /// Ctrl+C at any time, must be read correctly.
        #[test]
        fn no_bytes_swallow_later_keys(
            pieces in prop::collection::vec(
                prop_oneof![
                    prop::sample::select(vec![
                        "\x1b", "\x1b[", "\x1b[?", "\x1b[<", "\x1b[<5;", "\x1b[[", "\x1b[M", "\x1bO", "\x1b]", "\x1bP",
                        "\x1b_", "\x1b[200~", "1", ";", "~", "M", "漢",
                    ]).prop_map(|text| text.as_bytes().to_vec()),
                    prop::collection::vec(any::<u8>(), 1..5),
                ],
                0..12,
            ),
        ) {
            let mut decoder = Decoder::default();
            for piece in &pieces {
                decoder.read(piece);
            }
            let mut again = Decoder::default();
            for piece in &pieces {
                again.read(piece);
            }
            let events = again.read(b"\x03");
            prop_assert_eq!(events.last(), Some(&interrupt()));
            decoder.give_up();
            prop_assert_eq!(decoder.pause(), None);
            prop_assert_eq!(decoder.read(b"j"), [letter('j')]);
        }
    }
}
