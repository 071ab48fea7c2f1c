//! Time and memory of whole processes: `asperity run` on the scene of a million springs, with fewer
//! and with more.
//!
//! `cargo bench --bench process` prints the table. After `--`: `--largest 26` ends at 2^26 springs
//! (by default 2^24), and `--runs 9` sets the number of repetitions, of which the shortest counts.
//! Without `--bench`, as started by `cargo test --benches`, it only checks that it runs.

#[cfg(target_os = "linux")]
#[path = "../tests/common/peak.rs"]
mod peak;

#[cfg(target_os = "linux")]
fn main() {
    use asperity::scene::open;
    use asperity::scene::workload::Workload;
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    const ASPERITY: &str = env!("CARGO_BIN_EXE_asperity");
    const SCENE: &str = "million-springs";

    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let value = |name: &str, default: u32| {
        let place = arguments.iter().position(|argument| argument == name);
        place.map_or(default, |place| arguments[place + 1].parse().unwrap())
    };
    let is_bench = arguments.iter().any(|argument| argument == "--bench");
    let (largest, runs) = if is_bench {
        (value("--largest", 24), value("--runs", 5))
    } else {
        (10, 1)
    };

    println!("asperity run {SCENE} --format csv; shortest of {runs} runs");
    println!("  N         seconds   peak, MiB   stated, MiB   bytes for each spring beside 10 MiB");
    for exponent in (10..=largest).step_by(2) {
        let points = (1_u64 << exponent).to_string();
        let modes = (1_u64 << (exponent - 2)).to_string();
        // The largest mode must fit the line.
        let fields = [
            ("roughness.modes", format!("(2, {modes})")),
            ("numerics.points", points),
            ("numerics.samples", "5000".to_owned()),
        ];
        let fields: Vec<(&str, &str)> = fields
            .iter()
            .map(|(path, value)| (*path, value.as_str()))
            .collect();
        let time = |_| {
            let clock = Instant::now();
            let set = fields[..2]
                .iter()
                .flat_map(|(path, value)| ["--set".to_owned(), format!("{path}={value}")]);
            let status = Command::new(ASPERITY)
                .args(["run", SCENE, "--format", "csv"])
                .args(set)
                .stdout(Stdio::null())
                .status();
            assert!(status.unwrap().success());
            clock.elapsed()
        };
        let seconds = (0..runs)
            .map(time)
            .min()
            .unwrap_or(Duration::MAX)
            .as_secs_f64();
        let taken = peak::peak(ASPERITY, (SCENE, &fields));
        let owned: Vec<_> = fields
            .iter()
            .map(|&(path, value)| (path.into(), value.into()))
            .collect();
        let stated =
            Workload::of(open(SCENE).unwrap().set_all(&owned).unwrap().scene()).resident_bytes;
        let each = (taken as f64 - f64::from(10 << 20)) / f64::from(1_u32 << exponent);
        println!(
            "  2^{exponent:<6} {seconds:>9.4} {:>11.1} {:>13.1}   {each:.1}",
            taken as f64 / f64::from(1 << 20),
            stated as f64 / f64::from(1 << 20)
        );
    }
}

#[cfg(not(target_os = "linux"))]
fn main() {
    println!("peak memory is read from /proc, which is Linux's");
}
