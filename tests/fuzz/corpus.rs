//! The properties of the fuzz targets on a plain toolchain: for all seeds, for all findings of
//! fuzzing, and for some thousand mutations of both, the same ones each time.
//!
//! `TEST_EFFORT=40 cargo test --test fuzz corpus` tries 40 000 mutations of each target,
//! `FUZZ_SEED=7` others.

use super::allocations;
use super::effort::cases;
use super::mutator::Mutator;
use super::properties::{Property, TARGETS};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;

/// Mutations of each target in a quick run.
const MUTATIONS: u32 = 1000;

/// Mutations of each seed of a binary format of surfaces. With `TEST_EFFORT=8` there are 10 000.
const MUTATIONS_OF_SEED: u32 = 1_250;

/// Longest generated input, bytes.
const LONGEST: usize = 4_096;

/// The files of a folder of a target with their names, in alphabetical order; none if the folder
/// does not exist.
fn files(kind: &str, target: &str) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("fuzz")
        .join(kind)
        .join(target);
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Vec::new();
    };
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = paths
        .map(|path| (path.display().to_string(), std::fs::read(path).unwrap()))
        .collect();
    files.sort();
    files
}

/// Largest single request of memory while an input is read, bytes: tables of fixed size, and a
/// multiple of its content, whatever the numbers in it are.
fn most_memory(input: &[u8]) -> usize {
    let compressed: [&[u8]; 3] = [b"\x1f\x8b", b"PK\x03\x04", b"DSCOMPRESSED"];
    let is_compressed = compressed
        .iter()
        .any(|signature| input.starts_with(signature));
    let content = if is_compressed {
        (1 << 20) + 32 * input.len()
    } else {
        input.len()
    };
    (1 << 18) + 128 * content
}

/// Asserts that the property holds within the memory allowed; names a failing input.
fn check(property: Property, name: &str, input: &[u8]) {
    let (result, largest) =
        allocations::largest(|| catch_unwind(AssertUnwindSafe(|| property(input))));
    if let Err(panic) = result {
        eprintln!("{name}: {:?}", String::from_utf8_lossy(input));
        resume_unwind(panic);
    }
    assert!(
        largest <= most_memory(input),
        "{name}: {largest} bytes at once for an input of {}",
        input.len()
    );
}

/// Replays seeds and findings of a target, and tries mutations of them.
fn replay_and_mutate(target: &str) {
    let (_, property) = TARGETS.iter().find(|(name, _)| *name == target).unwrap();
    let (seeds, found) = (files("seeds", target), files("corpus", target));
    assert!(
        seeds.len() >= 4 && found.len() <= 200,
        "{target}: {} seeds, {} findings",
        seeds.len(),
        found.len()
    );
    let inputs = [seeds, found].concat();
    inputs
        .iter()
        .for_each(|(name, input)| check(*property, name, input));
    let inputs: Vec<Vec<u8>> = inputs.into_iter().map(|(_, input)| input).collect();
    let seed = std::env::var("FUZZ_SEED").map_or(2012, |seed| {
        seed.parse().expect("FUZZ_SEED: a whole number")
    });
    let mut mutator = Mutator::new(seed, &inputs, LONGEST);
    for number in 0..cases(MUTATIONS) {
        check(
            *property,
            &format!("{target}, mutation {number}"),
            &mutator.next_input(),
        );
    }
}

macro_rules! targets {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            replay_and_mutate(stringify!($name));
        })*

        #[test]
        fn every_target_has_a_test() {
            assert_eq!(TARGETS.iter().map(|(name, _)| *name).collect::<Vec<_>>(), [$(stringify!($name)),*]);
        }
    };
}

targets!(scene overrides quantity profile surface curve);

/// Each binary format of surfaces by itself, so that none is tried seldom among the others.
#[test]
#[ignore = "thousands of mutations of each seed take ten seconds or more; .ci/run runs it"]
fn seeds_of_binary_surfaces() {
    let (_, property) = TARGETS.iter().find(|(name, _)| *name == "surface").unwrap();
    for (name, seed) in files("seeds", "surface") {
        if !seed.contains(&0) {
            continue;
        }
        let is_wave = name.ends_with(".ibw");
        let inputs = [seed];
        let mut mutator = Mutator::new(2012, &inputs, LONGEST);
        for number in 0..cases(MUTATIONS_OF_SEED) {
            let mut input = mutator.next_input();
            if is_wave {
                repair_check_sum(&mut input);
            }
            check(*property, &format!("{name}, mutation {number}"), &input);
        }
    }
}

/// Sets the check sum of a binary wave of Igor, without which no changed wave would be read.
fn repair_check_sum(wave: &mut [u8]) {
    let is_big_endian = wave.first() == Some(&0);
    let version = wave.iter().take(2).max().copied().unwrap_or_default();
    let (place, size) = if version == 5 { (2, 384) } else { (14, 142) };
    if wave.len() < size {
        return;
    }
    wave[place..place + 2].fill(0);
    let number = |pair: &[u8]| match is_big_endian {
        true => u16::from_be_bytes([pair[0], pair[1]]),
        false => u16::from_le_bytes([pair[0], pair[1]]),
    };
    let sum = wave[..size]
        .chunks_exact(2)
        .map(number)
        .fold(0, u16::wrapping_add);
    let rest = sum.wrapping_neg();
    let bytes = match is_big_endian {
        true => rest.to_be_bytes(),
        false => rest.to_le_bytes(),
    };
    wave[place..place + 2].copy_from_slice(&bytes);
}

/// A property that cannot fail proves nothing.
#[test]
fn violations_are_seen() {
    let panics: Property = |input| assert!(!input.contains(&b'x'));
    check(panics, "sound", b"a");
    assert!(catch_unwind(|| check(panics, "a panic", b"x")).is_err());
    let greedy: Property = |input| drop(std::hint::black_box(vec![0_u8; input.len() << 22]));
    check(greedy, "modest", b"");
    assert!(catch_unwind(|| check(greedy, "greedy", b"123456")).is_err());
}
