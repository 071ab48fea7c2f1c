//! Input of the explorer: reads keys and mouse on separate threads, and converts them to actions.

use super::action::{Action, Gesture, Mouse};
use super::terminal_input::Input;
use crossterm::event::{Event, KeyEventKind, MouseButton, MouseEvent, MouseEventKind};

/// Reads keys and mouse on two new threads. The threads end when the terminal disappears or the
/// explorer ends. Each input is passed to `send`; when the input ends, `None` is passed. `send`
/// returns false if the receiver of the input has ended.
#[cfg(unix)]
pub fn read(send: impl Fn(Option<Input>) -> bool + Send + 'static) -> std::io::Result<()> {
    use super::decoder::Decoder;
    use std::sync::mpsc::{RecvTimeoutError, sync_channel};

    // The channel holds at most one piece. Further bytes wait in the terminal.
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
            let decoded = match piece {
                Ok(bytes) => decoder.read(&bytes),
                Err(RecvTimeoutError::Timeout) => decoder.give_up(),
                // The terminal has disappeared, for example because the connection dropped. Without
                // this return, the process would wait for input for ever.
                Err(RecvTimeoutError::Disconnected) => {
                    send(None);
                    return;
                }
            };
            for input in decoded {
                if !send(Some(input)) {
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

/// Returns the keyboard of the user: standard input if it is a terminal, otherwise the terminal
/// that controls the process.
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

/// Reads bytes and passes them to `send`, until the terminal disappears or `send` returns false.
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
            // The read fails with this error if another program that shares the terminal has
            // switched it to non-blocking reads. Then `poll` waits for the next bytes.
            Err(error) if error.kind() == ErrorKind::WouldBlock => {
                let _ = poll(&mut [PollFd::new(&terminal, PollFlags::IN)], None);
            }
            Err(_) => return,
        }
    }
}

/// Reads keys and mouse on a new thread. The thread ends when the terminal disappears or the
/// explorer ends. Each input is passed to `send`; when the input ends, `None` is passed. `send`
/// returns false if the receiver of the input has ended.
#[cfg(not(unix))]
pub fn read(send: impl Fn(Option<Input>) -> bool + Send + 'static) -> std::io::Result<()> {
    std::thread::Builder::new()
        .name("input".to_owned())
        .spawn(move || {
            loop {
                let input = crossterm::event::read().ok().map(Input::Event);
                let ended = input.is_none();
                if !send(input) || ended {
                    return;
                }
            }
        })
        .map(drop)
}

/// Returns the action that an event of the terminal causes; `None` if the explorer does not react
/// to the event.
pub fn action_of(event: Event) -> Option<Action> {
    match event {
        Event::Key(key) if key.kind == KeyEventKind::Press => Some(Action::Key(key)),
        Event::Paste(text) => Some(Action::Paste(text)),
        // On Unix, this event is ignored, because a signal announces the new size of the window.
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
