# What both parts have in common. It is read by them, not run.
set -euo pipefail
cd "$(dirname "$0")/.."

say() {
    printf '\n== %s\n' "$*"
}

# Runs a command and shows it first.
step() {
    say "$@"
    "$@"
}

target="${CARGO_TARGET_DIR:-target}"
# A clean build, and the last of its kind: records of changes would cost more than they save.
export CARGO_INCREMENTAL=0
# The same random cases each time; a run by hand draws others.
export PROPTEST_RNG_SEED="${PROPTEST_RNG_SEED:-2012}"
# Many tests wait for a terminal or a connection, and others compute meanwhile.
export RUST_TEST_THREADS="${RUST_TEST_THREADS:-$((2 * $(nproc)))}"
