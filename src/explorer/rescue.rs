//! Restores the terminal when the process ends without doing so: killed, out of memory, or while the terminal
//! accepts no output.
//!
//! A killed process runs no more code, so another one waits for its end: a shell, which exists wherever terminals
//! do and costs some milliseconds at the start. The shell has a process group of its own and ignores the signals
//! of the terminal, so that it may set a terminal that another shell has taken back meanwhile.

/// Sequence that ends an incomplete frame and resets all modes of the terminal.
#[cfg(unix)]
const RESTORE: &str =
    "\x18\x1b[?2026l\x1b[0m\x1b[?1006l\x1b[?1002l\x1b[?1000l\x1b[?2004l\x1b[?1049l\x1b[?25h";

/// Keeps the attributes of the terminal, reads one state after the other, and restores the terminal if the last
/// state is `taken`.
#[cfg(unix)]
const SCRIPT: &str = r#"trap '' HUP INT QUIT TERM TSTP TTIN TTOU
saved=$(stty -g <&2) || exit 1
echo ready
exec >&-
state=
while read -r line; do state=$line; done
[ "$state" = taken ] || exit 0
stty "$saved" <&2
printf '%s' "$1" >&2"#;

/// A process that waits for the end of this one.
#[cfg(unix)]
pub struct Rescue {
    child: std::process::Child,
    states: Option<std::process::ChildStdin>,
}

#[cfg(unix)]
impl Rescue {
    /// Starts the process, before any change of the terminal; `None` where that is impossible: nothing restores the
    /// terminal then.
    pub fn start() -> Option<Rescue> {
        use rustix::event::{PollFd, PollFlags, Timespec, poll};
        use std::io::Read;
        use std::os::fd::AsFd;
        use std::os::unix::process::CommandExt;
        use std::process::{Command, Stdio};
        /// Longest time until the process is ready; slower machines do without.
        const PATIENCE: Timespec = Timespec { tv_sec: 1, tv_nsec: 0 };
        let terminal = std::io::stdout().as_fd().try_clone_to_owned().ok()?;
        let mut child = Command::new("/bin/sh")
            .args(["-c", SCRIPT, "asperity", RESTORE])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(terminal)
            .process_group(0)
            .spawn()
            .ok()?;
        let states = child.stdin.take();
        let answer = child.stdout.take();
        let rescue = Rescue { child, states };
        let mut answer = answer?;
        let mut waited = [PollFd::new(&answer, PollFlags::IN)];
        let is_ready = poll(&mut waited, Some(&PATIENCE)).is_ok_and(|ready| ready > 0);
        (is_ready && answer.read(&mut [0; 16]).is_ok_and(|bytes| bytes > 0)).then_some(rescue)
    }

    /// Records the state of the terminal.
    pub fn note(&mut self, is_taken: bool) {
        use std::io::Write;
        let state: &[u8] = if is_taken { b"taken\n" } else { b"given back\n" };
        if let Some(states) = &mut self.states {
            // Without the process there is no rescue.
            let _ = states.write_all(state);
        }
    }
}

#[cfg(unix)]
impl Drop for Rescue {
    fn drop(&mut self) {
        self.states = None;
        let _ = self.child.wait();
    }
}

/// No rescue on other systems.
#[cfg(not(unix))]
pub struct Rescue;

#[cfg(not(unix))]
impl Rescue {
    /// Returns `None`.
    pub fn start() -> Option<Rescue> {
        None
    }

    /// Does nothing.
    pub fn note(&mut self, _: bool) {}
}
