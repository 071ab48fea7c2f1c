//! Input: reads keys and mouse on a thread of its own, and converts them to actions.

use super::action::{Action, Gesture, Mouse};
use crossterm::event::{Event, KeyEventKind, MouseButton, MouseEvent, MouseEventKind};

/// Reads input on a thread of its own, which ends with the terminal or the explorer. `send` returns true while anyone
/// receives; the end of the input is sent as `None`.
pub fn read(send: impl Fn(Option<Event>) -> bool + Send + 'static) -> std::io::Result<()> {
    std::thread::Builder::new()
        .name("input".to_owned())
        .spawn(move || {
            loop {
                let event = crossterm::event::read().ok();
                let ended = event.is_none();
                // A dropped connection must not leave a process behind that reads nothing for ever.
                if !send(event) || ended {
                    return;
                }
            }
        })
        .map(drop)
}

/// The action that an input event causes; `None` for an event without a meaning.
pub fn action_of(event: Event) -> Option<Action> {
    match event {
        Event::Key(key) if key.kind == KeyEventKind::Press => Some(Action::Key(key)),
        Event::Paste(text) => Some(Action::Paste(text)),
        // Elsewhere a signal of its own: crossterm reports no size while it waits for the rest of a sequence.
        Event::Resize(columns, rows) if cfg!(not(unix)) => Some(Action::Resize(columns, rows)),
        Event::Mouse(mouse) => gesture_of(mouse),
        _ => None,
    }
}

fn gesture_of(MouseEvent { kind, column, row, .. }: MouseEvent) -> Option<Action> {
    let gesture = match kind {
        MouseEventKind::Down(MouseButton::Left) => Gesture::Press,
        MouseEventKind::Drag(MouseButton::Left) => Gesture::Drag,
        MouseEventKind::ScrollUp => Gesture::Wheel(1),
        MouseEventKind::ScrollDown => Gesture::Wheel(-1),
        _ => return None,
    };
    Some(Action::Mouse(Mouse { column, row, gesture }))
}
