//! Runs this program again under callgrind, and reads the counts of callgrind.

use std::collections::{BTreeMap, HashMap};
use std::process::{Command, Stdio};

/// Counts of instructions, by file and line of the source.
pub struct Profile {
    lines: HashMap<String, BTreeMap<u64, u64>>,
}

impl Profile {
    /// Returns the number of all instructions, of all threads.
    pub fn total(&self) -> u64 {
        self.lines.values().flat_map(BTreeMap::values).sum()
    }

    /// Returns true if the counts belong to lines of this project, which requires that the program
    /// was compiled with line tables.
    pub fn has_line_tables(&self) -> bool {
        self.lines
            .keys()
            .any(|file| file.contains("scene/src/simulation/"))
    }

    /// Returns each source file, as the compiler names it, with the numbers of instructions of its
    /// lines.
    pub fn files(&self) -> impl Iterator<Item = (&str, &BTreeMap<u64, u64>)> {
        self.lines
            .iter()
            .map(|(file, lines)| (file.as_str(), lines))
    }

    /// Reads the uncompressed output of callgrind. Lines with `fl`, `fi` or `fe` name the source
    /// file of the following counts, also for inlined code. The count after a line with `calls` is
    /// the cost of a called function. It is left out, because the called function has its own
    /// counts.
    fn parse(text: &str) -> Profile {
        let mut lines: HashMap<String, BTreeMap<u64, u64>> = HashMap::new();
        let mut file = "";
        let mut of_call = false;
        for line in text.lines() {
            if let Some(("fl" | "fi" | "fe", name)) = line.split_once('=') {
                file = name;
            } else if line.starts_with("calls=") {
                of_call = true;
            } else if line.starts_with(|c: char| c.is_ascii_digit()) {
                let mut numbers = line.split(' ').map(|number| number.parse::<u64>());
                if let (false, Some(Ok(number)), Some(Ok(cost))) =
                    (of_call, numbers.next(), numbers.next())
                {
                    *lines
                        .entry(file.to_string())
                        .or_default()
                        .entry(number)
                        .or_default() += cost;
                }
                of_call = false;
            }
        }
        Profile { lines }
    }
}

/// Returns true if valgrind is installed.
pub fn is_there() -> bool {
    let version = Command::new("valgrind")
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    version.is_ok_and(|status| status.success())
}

/// Runs this program under callgrind with arguments and environment variables. Returns the counted
/// instructions.
pub fn profile(arguments: &[&str], environment: &[(&str, &str)]) -> Profile {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("profile");
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--compress-strings=no", "--compress-pos=no", "--dump-line=yes"])
        // glibc can copy and clear memory by a single repeated instruction, of which callgrind
        // would count each byte as an instruction. The setting prevents this.
        .env(
            "GLIBC_TUNABLES",
            "glibc.cpu.x86_rep_movsb_threshold=1073741824:glibc.cpu.x86_rep_stosb_threshold=1073741824",
        )
        .arg(format!("--callgrind-out-file={}", file.display()))
        .arg(std::env::current_exe().expect("this program"))
        .args(arguments)
        .envs(environment.iter().copied())
        .output()
        .expect("valgrind");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "valgrind: {message}");
    let text = String::from_utf8_lossy(&std::fs::read(file).expect("a profile")).into_owned();
    let profile = Profile::parse(&text);
    let stated = text
        .lines()
        .find_map(|line| line.strip_prefix("totals: ")?.trim().parse().ok());
    assert_eq!(Some(profile.total()), stated, "all counts are read");
    profile
}
