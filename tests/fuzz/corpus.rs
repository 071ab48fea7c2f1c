//! The properties of the fuzz targets on a plain toolchain: for all seeds, for all findings of fuzzing, and for some
//! thousand mutations of both, the same ones each time.
//!
//! `TEST_EFFORT=40 cargo test --test fuzz corpus` tries 100 000 mutations of each target, `FUZZ_SEED=7` others.

use super::allocations;
use super::effort::cases;
use super::mutator::Mutator;
use super::properties::{Property, TARGETS};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};

/// Mutations of each target in a quick run.
const MUTATIONS: u32 = 2500;

/// Longest generated input, bytes.
const LONGEST: usize = 4_096;

/// Largest single request of memory while reading, bytes: tables of fixed size, and a multiple of the input.
/// Independent of the numbers in the input.
const LARGEST_TABLE: usize = 1 << 18;
const LARGEST_PER_BYTE: usize = 128;

fn folder(kind: &str, target: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz").join(kind).join(target)
}

/// The files of a folder with their names, in alphabetical order; none if the folder does not exist.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<_> = entries
        .map(|entry| entry.unwrap().path())
        .map(|path| (path.display().to_string(), std::fs::read(path).unwrap()))
        .collect();
    files.sort();
    files
}

fn from_environment(name: &str) -> Option<u64> {
    std::env::var(name).ok().map(|number| number.parse().unwrap_or_else(|_| panic!("{name}: a whole number")))
}

/// Seeds of a target and the findings of fuzzing.
fn inputs(target: &str) -> Vec<(String, Vec<u8>)> {
    let seeds = files(&folder("seeds", target));
    assert!(seeds.len() >= 4, "{target} has {} seeds", seeds.len());
    [seeds, files(&folder("corpus", target))].concat()
}

/// Most bytes of decompression beside those of the input, and for each of them.
const LEAST_EXPANDED: usize = 1 << 20;
const MOST_EXPANSION: usize = 32;

/// Length of an input; of compressed ones that of the longest content.
fn content(input: &[u8]) -> usize {
    let compressed: [&[u8]; 3] = [b"\x1f\x8b", b"PK\x03\x04", b"DSCOMPRESSED"];
    if compressed.iter().any(|signature| input.starts_with(signature)) {
        LEAST_EXPANDED + MOST_EXPANSION * input.len()
    } else {
        input.len()
    }
}

/// Asserts that the property holds and that memory requests follow the length of the input; names a failing input.
fn check(property: Property, name: &str, input: &[u8]) {
    let (result, largest) = allocations::largest(|| catch_unwind(AssertUnwindSafe(|| property(input))));
    if let Err(panic) = result {
        eprintln!("{name}: {:?}", String::from_utf8_lossy(input));
        resume_unwind(panic);
    }
    let most = LARGEST_TABLE + LARGEST_PER_BYTE * content(input);
    assert!(largest <= most, "{name}: {largest} bytes at once for an input of {}", input.len());
}

/// Replays all inputs of a target and tries mutations of them.
fn replay_and_mutate(target: &str) {
    let (_, property) = TARGETS.iter().find(|(name, _)| *name == target).unwrap();
    let inputs = inputs(target);
    for (name, input) in &inputs {
        check(*property, name, input);
    }
    let inputs: Vec<Vec<u8>> = inputs.into_iter().map(|(_, input)| input).collect();
    let mut mutator = Mutator::new(from_environment("FUZZ_SEED").unwrap_or(2012), &inputs, LONGEST);
    for number in 0..cases(MUTATIONS) {
        let input = mutator.next_input();
        check(*property, &format!("{target}, mutation {number}"), &input);
    }
}

#[test]
fn scenes() {
    replay_and_mutate("scene");
}

#[test]
fn overrides() {
    replay_and_mutate("overrides");
}

#[test]
fn quantities() {
    replay_and_mutate("quantity");
}

#[test]
fn profiles() {
    replay_and_mutate("profile");
}

#[test]
fn surfaces() {
    replay_and_mutate("surface");
}

#[test]
fn every_target_has_a_file_seeds_and_a_place_in_the_package() {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz");
    let package = std::fs::read_to_string(fuzz.join("Cargo.toml")).unwrap();
    let tested = ["scene", "overrides", "quantity", "profile", "surface"];
    assert_eq!(TARGETS.iter().map(|(name, _)| *name).collect::<Vec<_>>(), tested);
    assert_eq!(files(&fuzz.join("fuzz_targets")).len(), TARGETS.len());
    for (name, _) in TARGETS {
        let target = std::fs::read_to_string(fuzz.join(format!("fuzz_targets/{name}.rs"))).unwrap();
        assert!(target.contains(&format!("asperity_fuzz::{name}(bytes)")), "{target}");
        assert!(package.contains(&format!("name = \"{name}\"\npath = \"fuzz_targets/{name}.rs\"")));
        assert!(!inputs(name).is_empty());
    }
}

/// A property that cannot fail proves nothing.
#[test]
fn what_does_not_hold_is_stated() {
    let panics: Property = |input| assert!(!input.contains(&b'x'));
    check(panics, "sound", b"a");
    assert!(catch_unwind(|| check(panics, "a panic", b"x")).is_err());
    let greedy: Property = |input| drop(std::hint::black_box(vec![0_u8; input.len() << 22]));
    check(greedy, "modest", b"");
    assert!(catch_unwind(|| check(greedy, "greedy", b"123456")).is_err());
}

#[test]
fn what_is_found_is_small() {
    for (target, _) in TARGETS {
        let found = files(&folder("corpus", target));
        let bytes: usize = found.iter().map(|(_, input)| input.len()).sum();
        assert!(found.len() <= 200 && bytes <= 100_000, "{target}: {} inputs, {bytes} bytes", found.len());
    }
}
