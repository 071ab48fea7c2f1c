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
# compiles in a fraction of the time; those that are left, against all unit tests and the integration tests of the
# room. Survivors are shown at the end; it fails where one survives that docs/mutation.md does not list. Packages and
# what is built of them are in target/mutants, or where MUTANTS_FOLDER says; one run of a room at a time.
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

# Of each room: its files, the rooms its unit tests need, and its integration tests. The store is tested from outside.
files=("src/$room")
case "$room" in
scene) rooms="scene" tests="scene fuzz_corpus readme explorer_screen" ;;
surface) rooms="memory parallel scene surface" tests="closed_forms fuzz_corpus sums sweep" ;;
analysis) rooms="analysis contact memory parallel scene" tests="closed_forms sums sweep" ;;
store) rooms="" tests="sweep" files=(src/sweep/{store,record,merge,shard}.rs) ;;
contact) rooms="contact memory parallel scene" tests="closed_forms laws stepwise subcell sums" ;;
*) usage ;;
esac

folder="${MUTANTS_FOLDER:-$PWD/target/mutants}/$room"
mkdir -p "$folder"
folder="$(cd "$folder" && pwd)"

# Leaves out the tests beside the code, which end a file.
without_tests() {
    awk '/^#\[cfg\(test\)\]$/ { held = $0; next }
         held && /^mod [a-z_]+ \{$/ { exit }
         held { print held; held = "" }
         { print }' "$1"
}

# Writes the manifest of a package in a folder: without the profiles, and what follows instead of its programs.
manifest() {
    local tree="$1" left_out="$2" version
    # Packages of the same name and version would be taken for one another where what they need is built but once.
    version="0.1.0+$room.$(basename "$(dirname "$tree")")"
    awk -v left_out="^\\[($left_out)" 'NR == 1 { keep = 1 } /^\[/ { keep = $0 !~ left_out } keep' Cargo.toml |
        sed "s/^version = .*/version = \"$version\"/" >"$tree/Cargo.toml"
    printf '%s\n' '[workspace]' '[profile.test]' 'opt-level = 0' 'debug = false' '[profile.dev]' 'debug = false' \
        '[profile.test.package."*"]' 'opt-level = 2' '[profile.dev.package."*"]' 'opt-level = 2' >>"$tree/Cargo.toml"
    sed "/^name = \"asperity\"$/{n;s/.*/version = \"$version\"/}" Cargo.lock >"$tree/Cargo.lock"
}

# Makes a package of some rooms, with tests beside the code in the one that is tested.
assemble_rooms() {
    local tree="$1" name file stripped
    rm -rf "$tree/src"
    mkdir -p "$tree/src"
    for name in $rooms; do
        while read -r file; do
            mkdir -p "$(dirname "$tree/$file")"
            if [[ "$file" == "src/$room"/* || "$file" != *.rs ]]; then
                cp "$file" "$tree/$file"
            else
                without_tests "$file" >"$tree/$file"
            fi
        done < <(find "src/$name" "src/$name.rs" -type f 2>/dev/null)
    done
    cp -r presets "$tree/"
    {
        echo '//! The room under test, and those it needs.'
        echo '#![allow(unused)]'
        for name in $rooms; do
            echo "pub mod $name;"
        done
    } >"$tree/src/lib.rs"
    manifest "$tree" 'profile|\\[bench'
    sed -i '/^default-run/d' "$tree/Cargo.toml"
}

# Makes a copy of the whole package.
assemble_all() {
    local tree="$1" file
    rm -rf "$tree"
    while read -r file; do
        if [ -f "$file" ]; then
            mkdir -p "$tree/$(dirname "$file")"
            cp "$file" "$tree/$file"
        fi
    done < <(git ls-files --cached --others --exclude-standard)
    manifest "$tree" profile
}

export PROPTEST_RNG_SEED="${PROPTEST_RNG_SEED:-2012}" FUZZ_MUTATIONS="${FUZZ_MUTATIONS:-300}"
# Where next to no draw is allowed any more, that shows soon.
export PROPTEST_CASES="${PROPTEST_CASES:-48}" PROPTEST_MAX_LOCAL_REJECTS="${PROPTEST_MAX_LOCAL_REJECTS:-8000}"
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

# Builds and runs tests without a mutation.
baseline() {
    local tree="$folder/$1/tree"
    shift
    (cd "$tree" && INSTA_WORKSPACE_ROOT="$PWD" cargo test --locked --quiet "$@")
}

rm -rf "$folder"/{unit,all}/mutants.out
sample=(--sharding round-robin --shard "$part" "$@")
echo "== $room: part $part of $all mutants"
if [ -n "$rooms" ]; then
    echo "== $room: against its unit tests"
    assemble_rooms "$folder/unit/tree"
    baseline unit --lib -- "$room::"
    mutants unit "${sample[@]}" -- --lib -- "$room::"
    # By their names: the numbers of a sample are not those of what is left of it.
    sample=()
    while read -r name; do
        sample+=(--re "^$(sed 's/[][\\.*^$+?(){}|]/\\&/g' <<<"$name")\$")
    done < <(cat "$folder/unit/mutants.out/missed.txt")
fi
if [ "${#sample[@]}" != 0 ]; then
    echo "== $room: against all tests"
    assemble_all "$folder/all/tree"
    baseline all "${of_all[@]}"
    mutants all "${sample[@]}" -- "${of_all[@]}"
fi
timeouts=$(($(count unit timeout) + $(count all timeout)))
killed=$(($(count unit caught) + $(count all caught) + timeouts))
echo "== $room: $killed of $((killed + $(count all missed))) viable mutants killed, $timeouts of them by time;" \
    "$(($(count unit unviable) + $(count all unviable))) do not compile"
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
