//! Signals handled by the explorer: those that end it restore the terminal first.

use std::io;

/// A signal handled by the explorer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SystemSignal {
    /// Request to end, by the signal of this number.
    End(i32),
    /// Continuation after a stop.
    Continue,
    /// Another size of the window.
    Resize,
}

/// Calls `report` when a signal ends or continues the process, or the size of its window changes; `report` returns false once nobody receives.
///
/// If the explorer has not ended some time later, as while the terminal accepts no output,
/// the process ends by the signal, with the attributes of the terminal restored.
#[cfg(unix)]
pub fn watch_for_signals(report: impl Fn(SystemSignal) -> bool + Send + 'static) -> io::Result<()> {
    use signal_hook::consts::{SIGCONT, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGWINCH};
    /// Time to end in an orderly way.
    const PATIENCE: std::time::Duration = std::time::Duration::from_millis(800);
    let mut signals =
        signal_hook::iterator::Signals::new([SIGCONT, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGWINCH])?;
    std::thread::Builder::new()
        .name("signals".to_owned())
        .spawn(move || {
            for signal in signals.forever() {
                if let SIGCONT | SIGWINCH = signal {
                    let is_size = signal == SIGWINCH;
                    report(if is_size { SystemSignal::Resize } else { SystemSignal::Continue });
                    continue;
                }
                if report(SystemSignal::End(signal)) {
                    std::thread::sleep(PATIENCE);
                    if !report(SystemSignal::End(signal)) {
                        // The explorer has ended, and its caller continues or ends by itself.
                        continue;
                    }
                    let _ = crossterm::terminal::disable_raw_mode();
                }
                end_by(signal);
            }
        })
        .map(drop)
}

/// No signals on other systems.
#[cfg(not(unix))]
pub fn watch_for_signals(_: impl Fn(SystemSignal) -> bool + Send + 'static) -> io::Result<()> {
    Ok(())
}

/// Ends the process by the default action of a signal, which a waiting process sees.
#[cfg(unix)]
pub fn end_by(signal: i32) {
    // Returns only for a signal that ends nothing.
    let _ = signal_hook::low_level::emulate_default_handler(signal);
}

/// Does nothing on other systems.
#[cfg(not(unix))]
pub fn end_by(_: i32) {}
