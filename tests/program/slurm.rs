//! Studies on a cluster: stand-ins for the answers of Slurm, and on request a real Slurm of two
//! nodes on the loopback.

use super::common::deadline::within;
use super::program::{Finished, finished, program};
use std::fs;
use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

const ASPERITY: &str = env!("CARGO_BIN_EXE_asperity");
const CLUSTER: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/program/slurm_cluster/cluster.sh"
);

const PLAN: &str = r#"(
    version: 1,
    base: "rough-sphere",
    set: {"numerics.points": "1024", "roughness.modes": "(1, 64)"},
    axes: [Linear(path: "roughness.hurst", from: 0.2, to: 0.9, count: 8)],
    profiles: 3,
    record: [pull_off_force, dissipated_energy],
)"#;

/// A folder with a plan, and with stand-ins for programs alone on the path.
fn folder(scripts: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("plan.ron"), PLAN).unwrap();
    fs::create_dir(folder.path().join("bin")).unwrap();
    scripts
        .iter()
        .for_each(|(name, script)| write_script(&folder.path().join("bin").join(name), script));
    folder
}

fn write_script(path: &Path, script: &str) {
    fs::write(path, format!("#!/bin/sh\n{script}\n")).unwrap();
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
}

fn submit(folder: &Path, options: &[&str]) -> Finished {
    let mut command = program();
    command
        .current_dir(folder)
        .env("PATH", folder.join("bin"))
        .env("SBATCH_ACCOUNT", "site");
    finished(
        command
            .args(["sweep", "submit", "plan.ron", "-o", "study", "--jobs", "12"])
            .args(options),
    )
}

/// Both tables of a study on a cluster are those of the same study on this machine, byte for byte.
#[test]
#[ignore = "starts a Slurm of its own; SLURM=required cargo test --test program cluster -- --ignored"]
fn a_cluster_gives_the_bytes_of_one_machine() {
    if std::env::var_os("SLURM").is_none() {
        return;
    }
    within(100, || {
        let folder = folder(&[]);
        // Free now; if another process takes a port first, the test fails and can be run again.
        let listeners = [(); 3].map(|()| TcpListener::bind("127.0.0.1:0").unwrap());
        let ports = listeners
            .each_ref()
            .map(|listener| listener.local_addr().unwrap().port().to_string());
        drop(listeners);
        // A folder name with special characters of the shell and of Slurm.
        let study = r#"study="it's %j & \$HOME"
            "$ASPERITY" sweep submit plan.ron -o "$study" --jobs 4 &&
            while [ -n "$(squeue --noheader)" ]; do sleep 0.1; done &&
            "$ASPERITY" sweep plan.ron -o serial --jobs 1 &&
            cmp serial/results.csv "$study/results.csv" && cmp serial/summary.csv "$study/summary.csv""#;
        let mut command = Command::new("bash");
        command
            .arg(CLUSTER)
            .arg(folder.path())
            .args(ports)
            .arg(study)
            .env("ASPERITY", ASPERITY);
        let Finished {
            code,
            stdout,
            stderr,
        } = finished(&mut command);
        assert_eq!(code, Some(0), "{stdout}{stderr}");
    });
}

#[test]
fn what_slurm_refuses_is_passed_on() {
    let refusing = (
        "sbatch",
        "echo 'sbatch: error: invalid partition' >&2; exit 1",
    );
    for (scripts, said) in [
        (
            &[][..],
            "sbatch was not found; run this command on a login node",
        ),
        (
            &[refusing],
            "sbatch failed (exit status: 1): sbatch: error: invalid partition",
        ),
    ] {
        let Finished {
            code,
            stdout,
            stderr,
        } = submit(folder(scripts).path(), &[]);
        assert_eq!((code, stdout.as_str()), (Some(1), ""));
        assert!(stderr.contains(said), "{stderr}");
    }
}

/// The options of the user, variables of the site, and the script reach sbatch; its answer reaches
/// the user.
#[test]
fn all_options_and_variables_reach_sbatch() {
    let sbatch = "printf '%s\\n' \"$@\" >asked; /usr/bin/env >variables; /bin/cat >script; echo Submitted batch job 17";
    let folder = folder(&[("sbatch", sbatch)]);
    let answer = submit(folder.path(), &["--", "-p", "short", "--array=1-12%3"]).succeeded();
    assert!(
        answer.starts_with("Submitted batch job 17\nasperity sweep status study"),
        "{answer}"
    );
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("asked"), "-p\nshort\n--array=1-12%3\n");
    assert!(read("variables").contains("SBATCH_ACCOUNT=site\n"));
    assert!(read("script").contains("\n#SBATCH --array=1-12\n"));
}

/// A dry run prints the script of a task and touches nothing; a task starts killed programs again,
/// and no others.
#[test]
fn a_task_starts_killed_programs_again() {
    let folder = folder(&[("sbatch", "touch submitted; echo 1")]);
    let script = submit(folder.path(), &["--check"]).succeeded();
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        2,
        "the plan and the stand-ins"
    );
    let script = script.replace(ASPERITY, "./program");
    for (program, code, runs) in [
        ("exit 0", 0, 1),
        ("exit 2", 2, 1),
        ("kill -9 $$", 137, 4),
        ("kill -TERM $$", 143, 1),
        ("[ $(wc -l <runs) -ge 2 ] || kill -KILL $$", 0, 2),
    ] {
        let _ = fs::remove_file(folder.path().join("runs"));
        write_script(
            &folder.path().join("program"),
            &format!("echo \"$*\" >>runs\n{program}"),
        );
        let mut task = Command::new("/bin/sh");
        task.current_dir(folder.path())
            .args(["-c", &script])
            .env("SLURM_ARRAY_TASK_ID", "3");
        let ended = finished(
            task.env("SLURM_CPUS_ON_NODE", "7")
                .env_remove("SLURM_CPUS_PER_TASK"),
        );
        let asked = fs::read_to_string(folder.path().join("runs")).unwrap();
        assert_eq!(
            (ended.code, asked.lines().count()),
            (Some(code), runs),
            "{program}: {}",
            ended.stderr
        );
        assert!(
            asked
                .lines()
                .all(|line| line.ends_with("--shard 3/12 --jobs 7")),
            "{asked}"
        );
    }
}
