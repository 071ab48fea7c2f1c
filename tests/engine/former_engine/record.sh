#!/usr/bin/env bash
# Records results of the former engine, the last one over a tree of all springs, for tests/engine/former_engine.rs.
#
#   tests/engine/former_engine/record.sh [WHOLE]
#
# Builds the former source, runs its engine on the random loops of loops.rs, and writes checksums and energies to
# recorded.bin and whole results to the file WHOLE. Then
#
#   FORMER_ENGINE=WHOLE cargo test --test engine deviations -- --ignored --nocapture
#
# prints the table of docs/accuracy.md.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
whole="$(realpath "${1:-/dev/null}")"
former="$(mktemp -d)"
trap 'git -C "$here" worktree remove --force "$former"' EXIT
git -C "$here" worktree add --quiet --detach "$former" b428bf2
mkdir -p "$former/src/bin/record"
cp "$here"/{loops,trace}.rs "$former/src/bin/record"
cp "$here/record.rs" "$former/src/bin/record/main.rs"
# Samples lie on the grid of the search. With the former 1024 intervals for whole springs, instead of the present 256,
# one in seven has another rounding of its indentation.
sed -i '/SEARCH_INTERVALS/s/1024/256/' "$former/src/contact/whole.rs"
cd "$former"
cargo run --locked --bin record -- 32768 "$whole" "$here/recorded.bin"
