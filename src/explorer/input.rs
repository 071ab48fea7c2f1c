//! Input: reads keys and mouse on a thread of its own, and converts them to actions.

use super::action::{Action, Gesture, Mouse};
use crossterm::event::{Event, KeyEventKind, MouseButton, MouseEvent, MouseEventKind};

/// Reads input on threads of their own, which end with the terminal or the explorer. `send` returns
/// true while anyone receives; the end of the input is sent as `None`.
#[cfg(unix)]
pub fn read(send: impl Fn(Option<Event>) -> bool + Send + 'static) -> std::io::Result<()> {
    use super::decoder::Decoder;
    use std::sync::mpsc::{RecvTimeoutError, sync_channel};

    // One piece: further bytes wait in the terminal.
    let (pieces, received) = sync_channel(1);
    let terminal = keyboard()?;
    spawn("terminal", move || {
        read_pieces(terminal, |piece| pieces.send(piece).is_ok())
    })?;
    spawn("input", move || {
        let mut decoder = Decoder::default();
        loop {
            let piece = match decoder.pause() {
                Some(pause) => received.recv_timeout(pause),
                None => received.recv().map_err(RecvTimeoutError::from),
            };
            let events = match piece {
                Ok(bytes) => decoder.read(&bytes),
                Err(RecvTimeoutError::Timeout) => decoder.give_up(),
                // A dropped connection must not leave a process behind that reads nothing for ever.
                Err(RecvTimeoutError::Disconnected) => {
                    send(None);
                    return;
                }
            };
            for event in events {
                if !send(Some(event)) {
                    return;
                }
            }
        }
    })
}

#[cfg(unix)]
fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> std::io::Result<()> {
    std::thread::Builder::new()
        .name(name.to_owned())
        .spawn(work)
        .map(drop)
}

/// The terminal as the user's keyboard: standard input, or the terminal of the process if input
/// comes from elsewhere.
#[cfg(unix)]
fn keyboard() -> std::io::Result<std::fs::File> {
    use std::io::IsTerminal;
    use std::os::fd::AsFd;

    let input = std::io::stdin();
    if input.is_terminal() {
        return Ok(input.as_fd().try_clone_to_owned()?.into());
    }
    std::fs::File::open("/dev/tty")
}

/// Reads what arrives until the terminal is gone or `send` returns false.
#[cfg(unix)]
fn read_pieces(mut terminal: std::fs::File, send: impl Fn(Vec<u8>) -> bool) {
    use rustix::event::{PollFd, PollFlags, poll};
    use std::io::{ErrorKind, Read};

    let mut bytes = [0; 1024];
    loop {
        match terminal.read(&mut bytes) {
            Ok(0) => return,
            Ok(count) => {
                if !send(bytes[..count].to_vec()) {
                    return;
                }
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            // Another program that shares the terminal may have made reads return at once.
            Err(error) if error.kind() == ErrorKind::WouldBlock => {
                let _ = poll(&mut [PollFd::new(&terminal, PollFlags::IN)], None);
            }
            Err(_) => return,
        }
    }
}

/// Reads input on a thread of its own, which ends with the terminal or the explorer. `send` returns
/// true while anyone receives; the end of the input is sent as `None`.
#[cfg(not(unix))]
pub fn read(send: impl Fn(Option<Event>) -> bool + Send + 'static) -> std::io::Result<()> {
    std::thread::Builder::new()
        .name("input".to_owned())
        .spawn(move || {
            loop {
                let event = crossterm::event::read().ok();
                let ended = event.is_none();
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
        // Elsewhere a signal of its own.
        Event::Resize(columns, rows) if cfg!(not(unix)) => Some(Action::Resize(columns, rows)),
        Event::Mouse(mouse) => gesture_of(mouse),
        _ => None,
    }
}

fn gesture_of(
    MouseEvent {
        kind, column, row, ..
    }: MouseEvent,
) -> Option<Action> {
    let gesture = match kind {
        MouseEventKind::Down(MouseButton::Left) => Gesture::Press,
        MouseEventKind::Drag(MouseButton::Left) => Gesture::Drag,
        MouseEventKind::ScrollUp => Gesture::Wheel(1),
        MouseEventKind::ScrollDown => Gesture::Wheel(-1),
        _ => return None,
    };
    Some(Action::Mouse(Mouse {
        column,
        row,
        gesture,
    }))
}
