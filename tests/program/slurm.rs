//! Studies on a cluster: a real Slurm of two nodes on the loopback, and stand-ins for the answers of others.
//!
//! Needs `slurmctld`, `slurmd`, `sbatch` and `munged`; if one of them is missing, or no such cluster can be started,
//! its test reports so and ends.

use super::common::deadline::within;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

const ASPERITY: &str = env!("CARGO_BIN_EXE_asperity");
const CLUSTER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/program/slurm_cluster/cluster.sh");

/// Small, but with cells long enough for a kill: about a tenth of a second each.
const PLAN: &str = r#"(
    version: 1,
    scene: (
        version: 1,
        material: (youngs_modulus: 2.0e6, poisson_ratio: 0.5),
        length: 1.0e-4,
        roughness: SelfAffine(hurst: 0.5, rms_height: 2.0e-7, modes: (1, 64), seed: 1),
        adhesion: (kappa: 1.0),
        loading: [ToForce(1.0e-5), ToSeparation],
        numerics: (points: POINTS, edges: SubCell),
    ),
    axes: [Linear(path: "roughness.hurst", from: 0.2, to: 0.9, count: 8)],
    lines: 3,
    record: [adhesion_force, dissipated_energy],
)"#;

/// Reports a skipped test past the test runner, which hides the output of passing tests.
fn report(note: &str) {
    let _ = writeln!(std::io::stderr(), "{note}");
}

/// A program by its name, on the path or in the administrator's folders of Debian.
fn program(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::env::split_paths(&path).chain([PathBuf::from("/usr/sbin"), PathBuf::from("/sbin")]);
    folders.map(|folder| folder.join(name)).find(|file| file.is_absolute() && file.is_file())
}

/// A cluster that ends with the test, on any outcome.
struct Cluster {
    keeper: Child,
    folder: tempfile::TempDir,
}

impl Drop for Cluster {
    fn drop(&mut self) {
        // The end of its input ends the keeper; wait for that.
        drop(self.keeper.stdin.take());
        let _ = self.keeper.wait();
    }
}

impl Cluster {
    /// Starts a cluster; `None`, and a note, if that is impossible here.
    fn start() -> Option<Cluster> {
        let [munged, slurmctld, slurmd, _] = ["munged", "slurmctld", "slurmd", "sbatch"].map(|name| {
            let found = program(name);
            if found.is_none() {
                report(&format!(
                    "skipped: there is no {name} (Debian: slurmctld, slurmd, slurm-client, munge)"
                ));
            }
            found
        });
        let (munged, slurmctld, slurmd) = (munged?, slurmctld?, slurmd?);
        program("sbatch")?;
        let folder = tempfile::tempdir().unwrap();
        let home = folder.path().join("cluster");
        fs::create_dir(&home).unwrap();
        for path in [folder.path(), &home] {
            fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
        }
        // Free now; if another process takes a port first the test fails and can be run again.
        let listeners = [(); 3].map(|()| TcpListener::bind("127.0.0.1:0").unwrap());
        let ports = listeners.each_ref().map(|listener| listener.local_addr().unwrap().port().to_string());
        drop(listeners);
        let mut command = Command::new("bash");
        command.arg(CLUSTER).arg(&home).args(ports).args([munged, slurmctld, slurmd]);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut keeper = command.spawn().unwrap();
        let mut stdout = BufReader::new(keeper.stdout.take().unwrap());
        let mut line = String::new();
        stdout.read_line(&mut line).unwrap();
        let cluster = Cluster { keeper, folder };
        if line.trim() == "ready" {
            return Some(cluster);
        }
        let mut rest = String::new();
        stdout.read_to_string(&mut rest).unwrap();
        report(&format!("skipped: no cluster can be started here:\n{line}{rest}"));
        None
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A program that talks to this cluster.
    fn command(&self, program: impl AsRef<std::ffi::OsStr>) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.path("cluster/slurm.conf")).current_dir(self.folder.path());
        command
    }

    fn plan(&self, points: u64) -> PathBuf {
        let path = self.path("plan.ron");
        fs::write(&path, PLAN.replace("POINTS", &points.to_string())).unwrap();
        path
    }

    /// Submits a plan; returns the number of the array.
    fn submit(&self, plan: &Path, folder: &str, options: &[&str]) -> String {
        let mut submit = self.command(ASPERITY);
        submit.args(["sweep", "submit"]).arg(plan).arg("-o").arg(self.path(folder)).args(options);
        let answer = succeeded(&mut submit);
        let number = answer.strip_prefix("Submitted batch job ").and_then(|rest| rest.split('\n').next());
        number.unwrap_or_else(|| panic!("{answer}")).to_owned()
    }

    /// Output of squeue for a job, one line for each of its tasks; empty after its end.
    fn queue(&self, job: &str) -> String {
        let format = "--format=%K %T %N %r";
        let output =
            self.command("squeue").args(["--noheader", "--array", "--jobs", job, format]).output().unwrap();
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }

    /// Waits until a job is over.
    fn wait_for(&self, job: &str, seconds: u64) {
        self.wait_until(&format!("job {job} is over"), seconds, || self.queue(job).is_empty());
    }

    fn wait_until(&self, what: &str, seconds: u64, mut done: impl FnMut() -> bool) {
        let deadline = Instant::now() + Duration::from_secs(seconds);
        while !done() {
            if Instant::now() > deadline {
                let queue = self.command("squeue").output().unwrap();
                panic!("not yet: {what}\n{}\n{}", String::from_utf8_lossy(&queue.stdout), self.logs());
            }
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Output of jobs and daemons.
    fn logs(&self) -> String {
        let mut logs = String::new();
        let mut folders = vec![self.folder.path().to_path_buf()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
                let path = entry.path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "log") {
                    let text = fs::read_to_string(&path).unwrap_or_default();
                    logs += &format!("--- {}\n{text}\n", path.display());
                }
            }
        }
        logs
    }

    /// Computes the same study in this process, without a cluster.
    fn serial(&self, plan: &Path, folder: &str) {
        let mut run = self.command(ASPERITY);
        succeeded(run.arg("sweep").arg(plan).arg("-o").arg(self.path(folder)).args(["--jobs", "1"]));
    }

    /// The tables of a study.
    fn tables(&self, folder: &str) -> [Vec<u8>; 2] {
        ["results.csv", "summary.csv"].map(|name| {
            let path = self.path(folder).join(name);
            fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}\n{}", path.display(), self.logs()))
        })
    }

    /// Processes that compute this shard of a study, as started by Slurm.
    fn processes(&self, folder: &str, shard: &str) -> Vec<u32> {
        let folder = self.path(folder).display().to_string();
        let found = fs::read_dir("/proc").unwrap().flatten().filter_map(|entry| {
            let number = entry.file_name().to_str()?.parse().ok()?;
            let line = fs::read(entry.path().join("cmdline")).ok()?;
            let words: Vec<_> = line.split(|byte| *byte == 0).collect();
            let has = |word: &str| words.contains(&word.as_bytes());
            (words[0] == ASPERITY.as_bytes() && has(&folder) && has(shard)).then_some(number)
        });
        found.collect()
    }

    /// Records in the files of a study.
    fn records(&self, folder: &str) -> usize {
        let files = fs::read_dir(self.path(folder).join("shards")).into_iter().flatten().flatten();
        let texts = files.map(|file| fs::read_to_string(file.path()).unwrap_or_default());
        // The first line of a file is its header.
        texts.map(|text| text.lines().count().saturating_sub(1)).sum()
    }
}

fn succeeded(command: &mut Command) -> String {
    let Output { status, stdout, stderr } = command.output().unwrap();
    let message = String::from_utf8_lossy(&stderr);
    assert!(status.success(), "{command:?}: {message}");
    String::from_utf8(stdout).unwrap()
}

fn kill(signal: &str, processes: &[u32]) {
    for process in processes {
        let _ = Command::new("kill").arg(signal).arg(process.to_string()).status();
    }
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn a_cluster_gives_the_bytes_of_one_machine_even_when_programs_are_killed() {
    within(100, || {
        let Some(cluster) = Cluster::start() else { return };
        let plan = cluster.plan(1 << 10);
        cluster.serial(&plan, "serial");

        // A folder name with special characters of the shell and of Slurm.
        let name = "it's %j & $HOME";
        let array = cluster.submit(&plan, name, &["--shards", "4"]);
        cluster.wait_for(&array, 40);
        assert_eq!(cluster.tables(name), cluster.tables("serial"));
        assert!(cluster.logs().contains("24 of 24 records"), "{}", cluster.logs());

        // Cells so large that a kill hits the middle of one.
        let plan = cluster.plan(1 << 21);
        let array = cluster.submit(&plan, "killed", &["--shards", "2", "--", "--job-name=killed"]);
        cluster.wait_until("there is a record, and shard 1 runs", 30, || {
            cluster.records("killed") > 0 && !cluster.processes("killed", "1/2").is_empty()
        });
        let running = cluster.processes("killed", "1/2");
        kill("-9", &running);
        cluster.wait_for(&array, 60);
        let log = fs::read_to_string(cluster.path("killed").join(format!("slurm-{array}_1.log"))).unwrap();
        assert!(log.contains("killed by signal 9: retry 1 of 3"), "{log}");
        cluster.serial(&plan, "whole");
        assert_eq!(cluster.tables("killed"), cluster.tables("whole"));
    });
}

/// A folder with stand-ins for the programs of Slurm, and nothing else on the path.
fn stand_ins(scripts: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("plan.ron"), PLAN.replace("POINTS", "256")).unwrap();
    fs::create_dir(folder.path().join("bin")).unwrap();
    for (name, script) in scripts {
        let path = folder.path().join("bin").join(name);
        fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }
    folder
}

fn submit_to(folder: &Path, options: &[&str]) -> (Option<i32>, String, String) {
    let mut command = Command::new(ASPERITY);
    command.current_dir(folder).env("PATH", folder.join("bin"));
    command.args(["sweep", "submit", "plan.ron", "-o", "study"]).args(options);
    let output = command.output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn what_slurm_refuses_is_passed_on() {
    let none = stand_ins(&[]);
    let (code, _, message) = submit_to(none.path(), &["--shards", "4"]);
    assert_eq!(code, Some(1));
    assert!(message.contains("sbatch was not found"), "{message}");
    assert!(message.contains("asperity sweep submit --help"), "{message}");

    let refusing = stand_ins(&[("sbatch", "echo 'sbatch: error: invalid partition' >&2; exit 1")]);
    let (code, stdout, message) = submit_to(refusing.path(), &["--shards", "4"]);
    assert_eq!((code, stdout.as_str()), (Some(1), ""));
    assert!(
        message.contains("sbatch failed (exit status: 1): sbatch: error: invalid partition"),
        "{message}"
    );
}

/// The options of the user, those of the site in variables, and the script reach sbatch; its answer reaches the user.
#[test]
fn all_options_and_variables_reach_sbatch() {
    let sbatch = "printf '%s\\n' \"$@\" >asked; /usr/bin/env >variables; /bin/cat >script; echo Submitted batch job 17";
    let folder = stand_ins(&[("sbatch", sbatch)]);
    let mut command = Command::new(ASPERITY);
    command.current_dir(folder.path()).env("PATH", folder.path().join("bin")).env("SBATCH_ACCOUNT", "site");
    command.args(["sweep", "submit", "plan.ron", "-o", "study", "--shards", "12"]);
    let answer =
        succeeded(command.args(["--", "--gpus=1", "-p", "short", "--array=1-12%3", "--signal", "B:TERM@60"]));
    assert!(answer.starts_with("Submitted batch job 17\nasperity sweep status study"), "{answer}");
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("asked"), "--gpus=1\n-p\nshort\n--array=1-12%3\n--signal\nB:TERM@60\n");
    assert!(read("variables").contains("SBATCH_ACCOUNT=site\n"));
    assert!(read("script").contains("\n#SBATCH --array=1-12\n"));
}

#[test]
fn a_dry_run_shows_and_touches_nothing() {
    let folder = stand_ins(&[("sbatch", "touch submitted; echo 1")]);
    let (code, stdout, message) =
        submit_to(folder.path(), &["--shards", "12", "--memory", "2G", "--dry-run"]);
    assert_eq!((code, message.as_str()), (Some(0), ""));
    for expected in ["--shard \"$SLURM_ARRAY_TASK_ID/12\"", "--memory 2147483648", "--array=1-12\n"] {
        assert!(stdout.contains(expected), "{expected}: {stdout}");
    }
    let mut left: Vec<_> =
        fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["bin", "plan.ron"]);
}

#[test]
fn a_task_starts_killed_programs_again_and_no_others() {
    // The script of a task, run by a shell, with a stand-in for the program.
    let folder = stand_ins(&[]);
    let (_, stdout, _) = submit_to(folder.path(), &["--shards", "4", "--dry-run"]);
    let script = stdout.replace(ASPERITY, "./program");
    for (program, code, runs) in [
        ("exit 0", 0, 1),
        ("exit 1", 1, 1),
        ("exit 2", 2, 1),
        ("kill -9 $$", 137, 4),
        ("kill -TERM $$", 143, 1),
        ("kill -SEGV $$", 139, 4),
        ("[ $(wc -l <runs) -ge 2 ] || kill -KILL $$", 0, 2),
    ] {
        let runs_file = folder.path().join("runs");
        let _ = fs::remove_file(&runs_file);
        let path = folder.path().join("program");
        fs::write(&path, format!("#!/bin/sh\necho \"$*\" >>runs\n{program}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        let mut task = Command::new("/bin/sh");
        task.current_dir(folder.path()).args(["-c", &script]).env("SLURM_ARRAY_TASK_ID", "3");
        let output = task.env("SLURM_CPUS_ON_NODE", "7").env_remove("SLURM_CPUS_PER_TASK").output().unwrap();
        let asked = fs::read_to_string(&runs_file).unwrap();
        assert_eq!(
            (output.status.code(), asked.lines().count()),
            (Some(code), runs),
            "{program}: {output:?}"
        );
        assert!(asked.lines().all(|line| line.ends_with("--shard 3/4 --jobs 7")), "{asked}");
    }
}
