//! Peak memory of `asperity run` on a scene.

use rustix::pipe::fcntl_setpipe_size;
use std::fs;
use std::io::Read;
use std::process::{Command, Stdio};

/// Size of the smallest pipe of the system in bytes.
const SMALLEST_PIPE: usize = 4096;

/// Name of a scene, and its changed fields.
pub type Changed<'a> = (&'a str, &'a [(&'a str, &'a str)]);

/// Arguments of `asperity run` for a scene.
pub fn arguments((scene, fields): Changed<'_>) -> Vec<String> {
    let set = fields
        .iter()
        .flat_map(|(path, value)| ["--set".to_owned(), format!("{path}={value}")]);
    ["run", scene, "--format", "csv"]
        .map(str::to_owned)
        .into_iter()
        .chain(set)
        .collect()
}

/// Largest resident memory of `asperity run`, bytes.
///
/// Read at the first byte of the results. The pipe holds few of them, so that the process waits
/// there with all its memory allocated.
pub fn peak(asperity: &str, changed: Changed<'_>) -> u64 {
    let mut run = Command::new(asperity)
        .args(arguments(changed))
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    fcntl_setpipe_size(run.stdout.as_ref().unwrap(), SMALLEST_PIPE).unwrap();
    run.stdout.as_mut().unwrap().read_exact(&mut [0]).unwrap();
    let status = fs::read_to_string(format!("/proc/{}/status", run.id())).unwrap();
    run.kill().unwrap();
    run.wait().unwrap();
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))
        .expect("the process still runs");
    let kilobytes: u64 = line.trim().strip_suffix(" kB").unwrap().parse().unwrap();
    kilobytes << 10
}
