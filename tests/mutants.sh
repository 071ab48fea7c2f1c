#!/usr/bin/env bash
# Mutation testing of one room: which changes of its code no test notices.
#
#   tests/mutants.sh ROOM [PART] [OPTION…]
#
# ROOM is scene, surface, analysis, store (of studies) or contact; PART is a sample, every n-th mutant from the k-th
# on, as k/n; left out: 0/1, all of them. OPTIONs go to cargo-mutants: --in-diff FILE, --file, --re.
#
# The rooms under test are put into a package of their own without the explorer, the command line and the figures,
# which compiles in a fraction of the time. Mutants that the unit tests of the room leave are tried against its
# integration tests and the unit tests of all rooms. What is left is in mutants.out/missed.txt of the folder
# MUTANTS_FOLDER/ROOM, by default target/mutants/ROOM.
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
    sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0" >&2
    exit 2
}

[ $# -ge 1 ] || usage
room="$1"
shift
part=0/1
if [[ "${1:-}" =~ ^[0-9]+/[0-9]+$ ]]; then
    part="$1"
    shift
fi

# Of each room: its files, the names its unit tests begin with, its integration tests.
case "$room" in
scene) files=(src/scene) names=(scene::) tests=(scene fuzz_corpus) ;;
surface) files=(src/surface) names=(surface:: ensemble:: simulation::) tests=(closed_forms sums fuzz_corpus) ;;
analysis) files=(src/analysis) names=(analysis:: simulation:: reference::) tests=(closed_forms sums sweep) ;;
store)
    files=(src/sweep/store.rs src/sweep/record.rs src/sweep/merge.rs src/sweep/shard.rs)
    names=(sweep::) tests=(sweep)
    ;;
contact) files=(src/contact) names=(contact::) tests=(closed_forms sums laws subcell stepwise) ;;
*) usage ;;
esac

folder="${MUTANTS_FOLDER:-target/mutants}/$room"
tree="$folder/tree"
mkdir -p "$tree/tests" "$tree/src/export"

# Copies what differs, so that what is compiled already stays so.
copy() {
    if ! cmp -s "$1" "$2"; then
        mkdir -p "$(dirname "$2")"
        cp "$1" "$2"
    fi
}

rooms="analysis contact ensemble memory parallel reference scene simulation surface sweep"
find "$tree/src" "$tree/tests" -name '*.rs' -delete
for name in $rooms; do
    for file in $(find "src/$name" "src/$name.rs" -name '*.rs' 2>/dev/null); do
        copy "$file" "$tree/$file"
    done
done
for file in src/export/{atomic,csv,json_text}.rs Cargo.lock; do
    copy "$file" "$tree/$file"
done
cp -r presets fuzz "$tree/"
find src -name snapshots | while read -r snapshots; do
    [ ! -d "$tree/$(dirname "$snapshots")" ] || cp -r "$snapshots" "$tree/$snapshots"
done
for name in "${tests[@]}"; do
    copy "tests/$name.rs" "$tree/tests/$name.rs"
    [ ! -d "tests/$name" ] || cp -r "tests/$name" "$tree/tests/"
done
cp -r tests/common tests/snapshots "$tree/tests/"
{
    echo '//! The rooms under test.'
    for name in $rooms export; do
        echo "pub mod $name;"
    done
} >"$tree/src/lib.rs"
cat >"$tree/src/export/mod.rs" <<'RUST'
//! What the rooms under test need of it.
pub mod atomic;
mod csv;
mod json_text;
pub use atomic::{WriteError, check_writable, write_new};
pub use csv::{write_curve, write_line};
pub use json_text::write_json_value;
RUST
# The package without its program, benchmarks and profiles.
awk '/^\[/ { keep = !/^\[(profile|\[bench)/ } /^default-run/ { next } { if (NR == 1) keep = 1; if (keep) print }' \
    Cargo.toml >"$tree/Cargo.toml"
cat >>"$tree/Cargo.toml" <<'TOML'

[workspace]

[profile.test]
opt-level = 1
debug = false
incremental = true

[profile.test.package."*"]
opt-level = 2
TOML

export PROPTEST_RNG_SEED="${PROPTEST_RNG_SEED:-2012}" FUZZ_MUTATIONS="${FUZZ_MUTATIONS:-300}"
export CARGO_TARGET_DIR="$PWD/$folder/build" INSTA_UPDATE=no INSTA_WORKSPACE_ROOT="$PWD/$tree"
file_options=()
for file in "${files[@]}"; do
    file_options+=(--file "$( [ -d "$file" ] && echo "$file/**/*.rs" || echo "$file")")
done
mutants() {
    local output="$1"
    shift
    rm -rf "$output/mutants.out" "$output/mutants.out.old"
    mkdir -p "$output"
    cargo mutants --dir "$tree" --output "$output" --in-place --no-shuffle --colors never --baseline skip \
        --timeout "${MUTANTS_TIMEOUT:-120}" "${file_options[@]}" "$@" || true
}
tests_of_all=(--lib)
for name in "${tests[@]}"; do
    tests_of_all+=(--test "$name")
done

echo "== $room: that the tests pass without a mutation"
(cd "$tree" && cargo test --locked --quiet "${tests_of_all[@]}")
echo "== $room: part $part against its unit tests"
mutants "$folder/unit" --sharding round-robin --shard "$part" "$@" -- --lib -- "${names[@]}"
count() {
    cat "$folder/$1/mutants.out/$2.txt" 2>/dev/null | wc -l
}
exact=()
while read -r name; do
    exact+=(--re "^$(sed 's/[][\.*^$+?(){}|]/\\&/g' <<<"$name")\$")
done < <(cat "$folder/unit/mutants.out/missed.txt" 2>/dev/null)
if [ "${#exact[@]}" != 0 ]; then
    echo "== $room: the ${#exact[@]} that are left, against all tests"
    mutants "$folder/all" "${exact[@]}" -- "${tests_of_all[@]}"
else
    rm -rf "$folder/all"
fi
caught=$(($(count unit caught) + $(count all caught) + $(count unit timeout) + $(count all timeout)))
missed=$(count all missed)
echo "== $room: $caught of $((caught + missed)) viable mutants killed ($(count unit timeout) of them by time); \
$(count unit unviable) do not compile"
cat "$folder/all/mutants.out/missed.txt" 2>/dev/null || true
