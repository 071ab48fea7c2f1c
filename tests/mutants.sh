#!/usr/bin/env bash
# Mutation testing of one room: which changes of its code no test notices.
#
#   tests/mutants.sh ROOM [PART] [OPTION…]
#
# ROOM is scene, surface, analysis, store (of studies) or contact. PART is a sample: every n-th mutant from the k-th
# on, as k/n, or as many of them as make about a number, as ~60; left out: all. OPTIONs go to cargo-mutants:
# --in-diff FILE, --re.
#
# The room, its unit tests and its integration tests are one small program, compiled anew for each mutant without
# optimisation; what the room needs is a package that is built once. A mutant that the quick tests leave is tried against
# all of them, with more cases. Survivors are shown at the end; it fails where one survives that docs/mutation.md does
# not list. Packages and what is built of them are in target/mutants, or where MUTANTS_FOLDER says; one run of a room at
# a time.
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

# Of each room: its files; the rooms below it, which are built once; the rooms above it that its tests need; the
# integration tests that are tried beside its unit tests; those that take long where nothing is optimised; and
# those that cannot run so.
files=("src/$room")
own="$room" below="" above="" beside="" slow="" unfit=""
case "$room" in
scene)
    below="io memory parallel spectrum text topography" above="analysis contact reference simulation surface"
    beside="engine/scene fuzz/corpus program/readme/scenes" slow="nesting_does_not_overflow" unfit="every_target_has"
    ;;
surface)
    below="contact io memory parallel scene spectrum text topography" above="analysis reference simulation"
    beside="engine/closed_forms fuzz/corpus" unfit="every_target_has"
    slow="heights_are_those hertz_without rough_bodies smooth_bodies wavy_spheres what_is_kept"
    ;;
analysis) below="contact io memory parallel scene spectrum surface text topography" ;;
store)
    own="study" files=(src/study/{store,done,record,merge,tables,shard}.rs)
    below="analysis contact draw io memory parallel reference scene simulation spectrum surface text topography"
    above="accuracy check export" beside="engine/simulated_disk program/sweep"
    # The unfit ones start the program, which is not there, or do not always pass.
    export CARGO_BIN_EXE_asperity=""
    unfit="a_disk_that_does foreign:: killed_ processes:: two_thousand" slow="a_study_outlives a_saved_scene every_prefix"
    ;;
contact)
    below="io memory parallel scene spectrum surface text topography" above="analysis reference simulation"
    beside="engine/closed_forms engine/laws engine/levels engine/reversals engine/stepwise engine/sums"
    slow="a_million_terms forces_at_full_contact hertz_without pull_off_force_energy rough_bodies smooth_bodies
        the_work_of_each wavy_spheres"
    ;;
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

# Copies a room into a tree, with the tests beside its code where it is the one under test.
copy_room() {
    local name="$1" tree="$2" file
    while read -r file; do
        mkdir -p "$(dirname "$tree/$file")"
        if [[ "$name" == "$own" || "$file" != *.rs ]]; then
            cp "$file" "$tree/$file"
        else
            without_tests "$file" >"$tree/$file"
        fi
    done < <(find "src/$name" "src/$name.rs" -type f 2>/dev/null)
}

# Files of the tests beside the room that its package includes: the roots of those that are modules of a root, and the
# others themselves.
roots() {
    local name
    for name in $beside; do
        case "$name" in */*/*) echo "$name" ;; *) echo "${name%/*}/main" ;; esac
    done | sort -u
}

# Leaves in a root only the modules beside the room, and those that these share.
choose_modules() {
    local root="$tree/tests/$1/main.rs"
    awk -v chosen=" $(for name in $beside; do echo "${name#"$1/"}"; done | xargs) body mutator numerics " '
        /^#\[/ { held = held $0 "\n"; next }
        !/^mod [a-z_]+;$/ || held ~ /path/ || index(chosen, " " substr($2, 1, length($2) - 1) " ") { print held $0 }
        { held = "" }' "$root" >"$root.chosen"
    mv "$root.chosen" "$root"
}

# Makes a package of the room, those above it and its tests, all in one program, and a package below it of those that
# do not change.
assemble() {
    local name file module
    rm -rf "$tree"
    mkdir -p "$tree/below"
    cp -r docs presets fuzz tests "$tree/"
    cp -r presets "$tree/below/"
    rm "$tree"/tests/*.sh "$tree/fuzz/Cargo.toml"
    for name in $below; do copy_room "$name" "$tree/below"; done
    for name in $own $above; do copy_room "$name" "$tree"; done
    for file in tests/engine/snapshots/*.snap; do cp "$file" "$tree/tests/engine/snapshots/asperity__${file##*/}"; done
    # Items that a crate keeps to itself are shared by two of them.
    find "$tree/below" -name '*.rs' -exec sed -i 's/pub(crate)/pub/' {} +
    sed -i 's/^macro_rules! object/#[macro_export]\n&/' "$tree/below/src/io/object.rs"
    {
        echo '#![allow(unused)]'
        for name in $below; do echo "pub mod $name;"; done
    } >"$tree/below/src/lib.rs"
    {
        echo '#![allow(unused)]'
        echo 'extern crate self as asperity;'
        for name in $below; do echo "pub use below::$name;"; done
        for name in $own $above; do echo "pub mod $name;"; done
        for name in $(roots); do
            # Of the name that snapshots have.
            module="${name%/main}"
            printf '#[cfg(test)]\n#[path = "../tests/%s.rs"]\nmod %s;\n' "$name" "${module//\//_}"
        done
    } >"$tree/src/lib.rs"
    for name in $(roots); do
        if [ "${name##*/}" = main ]; then choose_modules "${name%/main}"; fi
    done
    # Packages of the same name and version would be taken for one another in a folder that rooms build in.
    awk 'NR == 1 { keep = 1 } /^\[/ { keep = !/^\[(profile|\[)/ } keep && !/^default-run/' Cargo.toml |
        sed -e "s/^version = .*/version = \"0.1.0+$room\"/" -e 's/^edition/autotests = false\n&/' \
            -e 's/^\[dependencies\]/&\nbelow = { path = "below" }/' >"$tree/Cargo.toml"
    sed -e '/^\[dev-dependencies\]/,$d' -e 's/^name = .*/name = "below"/' -e '/^below/d' -e '/^autotests/d' \
        "$tree/Cargo.toml" >"$tree/below/Cargo.toml"
    printf '%s\n' '[workspace]' 'exclude = ["below"]' '[profile.test]' 'opt-level = 0' 'debug = false' \
        '[profile.test.package."*"]' 'opt-level = 2' >>"$tree/Cargo.toml"
    cp Cargo.lock "$tree/"
}

export PROPTEST_RNG_SEED="${PROPTEST_RNG_SEED:-2012}" TEST_EFFORT="${TEST_EFFORT:-0.1}"
# Where next to no draw is allowed any more, that shows soon; a case that fails need not be the smallest, and is not
# tried on the next mutant.
export PROPTEST_CASES="${PROPTEST_CASES:-24}" PROPTEST_MAX_LOCAL_REJECTS="${PROPTEST_MAX_LOCAL_REJECTS:-8000}"
export PROPTEST_MAX_SHRINK_ITERS=0 PROPTEST_DISABLE_FAILURE_PERSISTENCE=1 RUST_BACKTRACE=0
export CARGO_TARGET_DIR="${MUTANTS_BUILD:-$folder/../build}" INSTA_UPDATE=no
host="$(rustc -vV | sed -n 's/^host: //p' | tr 'a-z-' 'A-Z_')"
export "CARGO_TARGET_${host}_RUNNER=env RUSTC_BOOTSTRAP=1"
file_options=()
for file in "${files[@]}"; do
    if [ -d "$file" ]; then file="$file/**/*.rs"; fi
    file_options+=(--file "$file")
done

all="$(cargo mutants --list --colors never "${file_options[@]}" "$@" | wc -l)"
if [ "$all" = 0 ]; then
    echo "== $room: no mutants"
    exit 0
fi
if [[ "$part" == "~"* ]]; then
    most="${part#"~"}"
    part="0/$(((all + most - 1) / most))"
fi

tree="$folder/tree"
export INSTA_WORKSPACE_ROOT="$tree"

# A stage: runs the tests, but for some, without a mutation and then with each of the mutants that options choose. The
# first test that fails ends a run; the toolchain in use knows this only as an unstable option.
mutants() {
    local stage="$folder/$1" timeout="$2" run=(-- -Zunstable-options --fail-fast) name
    for name in $3; do run+=(--skip "$name"); done
    shift 3
    (cd "$tree" && cargo test --quiet --lib "${run[@]}")
    # It fails where mutants are left, which is said below.
    cargo mutants --dir "$tree" --output "$stage" --in-place --no-shuffle --colors never --baseline skip \
        --timeout "$timeout" --cargo-arg=--lib "${file_options[@]}" "$@" -- "${run[@]}" || true
}

# Quick mutants of an outcome.
count() {
    wc -l <"$folder/quick/mutants.out/$1.txt"
}

rm -rf "$folder"/{quick,thorough}
echo "== $room: part $part of $all mutants, against quick tests"
assemble
mutants quick "${MUTANTS_TIMEOUT:-20}" "$slow $unfit" --sharding round-robin --shard "$part" "$@"
# By their names, since the numbers of a sample are not those of what is left of it; and by their lines, since
# cargo-mutants tries each field left out whatever the names say.
left=(--in-diff "$folder/left.diff")
while read -r name; do
    left+=(--re "^$(sed 's/[][\\.*^$+?(){}|]/\\&/g' <<<"$name")\$")
done <"$folder/quick/mutants.out/missed.txt"
cut -d: -f1,2 "$folder/quick/mutants.out/missed.txt" | sort -u -t: -k1,1 -k2,2n | while IFS=: read -r file line; do
    printf -- '--- a/%s\n+++ b/%s\n@@ -%d,0 +%d,1 @@\n+' "$file" "$file" $((line - 1)) "$line"
    sed -n "${line}p" "$tree/$file"
done >"$folder/left.diff"
if [ -s "$folder/left.diff" ]; then
    echo "== $room: what is left, against all of its tests"
    CARGO_PROFILE_TEST_OPT_LEVEL=1 PROPTEST_CASES=256 mutants thorough 180 "$unfit" "${left[@]}"
fi
survivors="$(cat "$folder/thorough/mutants.out/missed.txt" 2>/dev/null || true)"
viable=$(($(count caught) + $(count timeout) + $(count missed)))
echo "== $room: $((viable - $(grep -c . <<<"$survivors"))) of $viable viable mutants killed," \
    "$(count timeout) of them by time; $(count unviable) do not compile"
new=0
while read -r name; do
    # As it is listed: without line and column, which change.
    if [ -z "$name" ]; then
        break
    elif grep -qF -- "$(sed -E 's/:[0-9]+:[0-9]+:/:/' <<<"$name")" docs/mutation.md; then
        echo "listed:   $name"
    else
        echo "SURVIVES: $name"
        new=1
    fi
done <<<"$survivors"
exit "$new"
