#!/usr/bin/env bash
# Mutation testing of one room: which changes of its code no test notices.
#
#   tests/mutants.sh ROOM [PART] [OPTION…]
#
# ROOM is scene, surface, analysis, store (of studies) or contact. PART is a sample: every n-th mutant from the k-th
# on, as k/n, or as many of them as make about a number, as ~60; left out: all. OPTIONs go to cargo-mutants:
# --in-diff FILE, --re.
#
# Each mutant is tried against the unit tests of its room first, in a package of that room and those it needs, which
# compiles in a fraction of the time; those that are left, against the unit tests of all rooms below the explorer and
# the command line, and the integration tests of the room. Survivors are shown at the end and stand in
# FOLDER/ROOM/all/mutants.out/missed.txt; FOLDER is target/mutants, or what MUTANTS_FOLDER says. It fails where one
# survives that docs/mutation.md does not list.
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
if [[ "${1:-}" =~ ^([0-9]+/|~)[0-9]+$ ]]; then
    part="$1"
    shift
fi

# Of each room: its files, the rooms its unit tests need, how their names begin, and its integration tests.
all_rooms="analysis contact ensemble memory parallel reference scene simulation surface sweep"
files=("src/$room")
case "$room" in
scene) rooms="scene" names="scene::" tests="scene fuzz_corpus" ;;
surface) rooms="memory parallel scene surface" names="surface::" tests="closed_forms fuzz_corpus sums sweep" ;;
analysis)
    rooms="analysis contact memory parallel reference scene simulation surface"
    names="analysis:: reference:: simulation::" tests="closed_forms sums sweep"
    ;;
store)
    rooms="$all_rooms" names="sweep::" tests="sweep"
    files=(src/sweep/{store,record,merge,shard}.rs)
    ;;
contact) rooms="contact memory parallel scene" names="contact::" tests="closed_forms laws stepwise subcell sums" ;;
*) usage ;;
esac

folder="${MUTANTS_FOLDER:-$PWD/target/mutants}/$room"
mkdir -p "$folder"
folder="$(cd "$folder" && pwd)"

# Copies what differs, so that what is compiled already stays so.
copy() {
    if ! cmp -s "$1" "$2"; then
        mkdir -p "$(dirname "$2")"
        cp "$1" "$2"
    fi
}

# Makes a package of these rooms and these integration tests.
assemble() {
    local tree="$1" rooms="$2" tests="$3" name file
    mkdir -p "$tree/src" "$tree/tests"
    for name in $rooms; do
        while read -r file; do
            copy "$file" "$tree/$file"
        done < <(find "src/$name" "src/$name.rs" -type f 2>/dev/null)
    done
    for name in $tests; do
        while read -r file; do
            copy "$file" "$tree/$file"
        done < <(find "tests/$name" "tests/$name.rs" tests/common tests/snapshots -type f 2>/dev/null)
    done
    while read -r file; do
        copy "$file" "$tree/$file"
    done < <(find presets fuzz/src fuzz/fuzz_targets fuzz/seeds fuzz/corpus fuzz/Cargo.toml Cargo.lock README.md -type f)
    {
        echo '//! The rooms under test.'
        echo '#![allow(unused)]'
        for name in $rooms; do
            echo "pub mod $name;"
        done
        if [[ " $rooms " == *" sweep "* ]]; then
            echo 'pub mod export;'
            for file in atomic csv json_text; do
                copy "src/export/$file.rs" "$tree/src/export/$file.rs"
            done
            # What the rooms below need of it.
            printf '%s\n' 'pub mod atomic;' 'mod csv;' 'mod json_text;' \
                'pub use atomic::{WriteError, check_writable, write_new};' \
                'pub use csv::{write_curve, write_line};' 'pub use json_text::write_json_value;' \
                >"$tree/src/export/mod.rs"
        fi
    } >"$tree/src/lib.rs"
    # The package without its program, benchmarks and profiles.
    awk 'NR == 1 { keep = 1 } /^\[/ { keep = !/^\[(profile|\[bench)/ } /^default-run/ { next } keep' Cargo.toml \
        >"$tree/Cargo.toml"
    printf '%s\n' '[workspace]' '[profile.test]' "opt-level = ${MUTANTS_OPT_LEVEL:-0}" 'debug = false' \
        '[profile.test.package."*"]' 'opt-level = 2' >>"$tree/Cargo.toml"
}

assemble "$folder/unit/tree" "$rooms" ""
assemble "$folder/all/tree" "$all_rooms" "$tests"

export PROPTEST_RNG_SEED="${PROPTEST_RNG_SEED:-2012}" FUZZ_MUTATIONS="${FUZZ_MUTATIONS:-300}"
export PROPTEST_CASES="${PROPTEST_CASES:-48}"
export CARGO_TARGET_DIR="${MUTANTS_BUILD:-$folder/../build}" INSTA_UPDATE=no
file_options=()
for file in "${files[@]}"; do
    if [ -d "$file" ]; then file="$file/**/*.rs"; fi
    file_options+=(--file "$file")
done

all="$(cargo mutants --list --colors never "${file_options[@]}" "$@" | wc -l)"
if [[ "$part" == "~"* ]]; then
    most="${part#"~"}"
    part="0/$(((all + most - 1) / most))"
    if [ "$all" = 0 ]; then part=0/1; fi
fi

# Tries mutants in one of the packages.
mutants() {
    local stage="$folder/$1"
    shift
    rm -rf "$stage/mutants.out" "$stage/mutants.out.old"
    # It fails where mutants are left, which is said below.
    INSTA_WORKSPACE_ROOT="$stage/tree" cargo mutants --dir "$stage/tree" --output "$stage" --in-place --no-shuffle \
        --colors never --baseline skip --timeout "${MUTANTS_TIMEOUT:-120}" "${file_options[@]}" "$@" || true
}

count() {
    cat "$folder/$1/mutants.out/$2.txt" 2>/dev/null | wc -l
}

of_all=(--lib)
for name in $tests; do
    of_all+=(--test "$name")
done
# shellcheck disable=SC2206 # Names without spaces.
of_unit=(--lib -- $names)

echo "== $room: that its unit tests pass without a mutation"
(cd "$folder/unit/tree" && INSTA_WORKSPACE_ROOT="$PWD" cargo test --locked --quiet "${of_unit[@]}")
echo "== $room: part $part of $all mutants against its unit tests"
mutants unit --sharding round-robin --shard "$part" "$@" -- "${of_unit[@]}"
exact=()
while read -r name; do
    exact+=(--re "^$(sed 's/[][\\.*^$+?(){}|]/\\&/g' <<<"$name")\$")
done < <(cat "$folder/unit/mutants.out/missed.txt" 2>/dev/null)
rm -rf "$folder/all/mutants.out"
if [ "${#exact[@]}" != 0 ]; then
    echo "== $room: that all tests pass without a mutation"
    (cd "$folder/all/tree" && INSTA_WORKSPACE_ROOT="$PWD" cargo test --locked --quiet "${of_all[@]}")
    echo "== $room: the $((${#exact[@]} / 2)) that are left, against all tests"
    mutants all "${exact[@]}" -- "${of_all[@]}"
fi
timeouts=$(($(count unit timeout) + $(count all timeout)))
killed=$(($(count unit caught) + $(count all caught) + timeouts))
echo "== $room: $killed of $((killed + $(count all missed))) viable mutants killed, $timeouts of them by time;" \
    "$(count unit unviable) do not compile"
new=0
while read -r name; do
    # As it is listed: without line and column, which change.
    if grep -qF -- "$(sed -E 's/:[0-9]+:[0-9]+:/:/' <<<"$name")" docs/mutation.md; then
        echo "listed:   $name"
    else
        echo "SURVIVES: $name"
        new=1
    fi
done < <(cat "$folder/all/mutants.out/missed.txt" 2>/dev/null)
exit "$new"
