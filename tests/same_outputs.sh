#!/usr/bin/env bash
# Compares the outputs of two builds of the program byte for byte, for changes that must not change results.
#
#   tests/same_outputs.sh BEFORE AFTER
#
# BEFORE and AFTER are executables. Each writes all built-in scenes as JSON, CSV, text and profile, means of random
# lines, three studies with few lines, the catalogue of hard cases and frames of a demo; the folders are then compared.
# Costs are left out: they depend on the speed of the machine. Differences that are intended belong into CHANGELOG.md.
set -euo pipefail
[ $# = 2 ] || { sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2; }

folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

# Leaves out times in text, whose lengths break lines elsewhere.
without_times() {
    tr -s '[:space:]' ' ' | sed -E 's/[0-9.]+ (ns|µs|us|ms|s|min)\b/TIME/g' | tr ' ' '\n'
}

# The same in JSON, of any layout.
without_seconds() {
    python3 -c '
import json, re, sys

def kept(value):
    if isinstance(value, list):
        return [kept(one) for one in value]
    if isinstance(value, dict):
        times = re.compile("timings|.*(seconds|host).*")
        return {key: kept(one) for key, one in value.items() if not times.fullmatch(key)}
    return value

print(json.dumps(kept(json.load(sys.stdin)), indent=1, sort_keys=True))'
}

outputs() {
    local asperity plan scene
    asperity="$(realpath "$1")"
    mkdir "$2"
    cd "$2"
    export NO_COLOR=1 LC_ALL=C.UTF-8
    for scene in $("$asperity" presets list | awk '{ print $1 }'); do
        "$asperity" presets show "$scene" >"$scene.ron"
        "$asperity" line "$scene" >"$scene.line.csv"
        "$asperity" run "$scene" | without_times >"$scene.txt"
        "$asperity" run "$scene" --format json | without_seconds >"$scene.json"
        "$asperity" run "$scene" --format csv >"$scene.csv"
        "$asperity" run "$scene" --format csv --set numerics.edges=Grid >"$scene.grid.csv"
        "$asperity" plan "$scene" | without_times >"$scene.plan.txt"
        "$asperity" plan "$scene" --format json | without_seconds >"$scene.plan.json"
    done
    "$asperity" run pressure-sensitive --profiles 8 --format csv >lines.csv
    "$asperity" run pressure-sensitive --profiles 8 --format json | without_seconds >lines.json
    "$asperity" run pressure-sensitive --tolerance 1% --format json 2>/dev/null | without_seconds >tolerance.json
    for plan in figure-5b stiffness-exponent equation-15; do
        "$asperity" sweep "$plan" -o "$plan" --profiles 1 --set numerics.points=4096 \
            --set 'roughness.modes=(1, 512)' >/dev/null 2>&1
        rm -rf "$plan"/shards
        "$asperity" sweep plot "$plan" 2>/dev/null | cat >"$plan.plot.txt" || true
    done
    "$asperity" check | without_times >check.txt || true
    for at in 0 1 3; do
        "$asperity" demo jkr-sphere --size 100x30 --at "$at" >"frame.$at.txt" 2>/dev/null || true
    done
}

(outputs "$1" "$folder/before") &
(outputs "$2" "$folder/after") &
wait
if diff -r "$folder/before" "$folder/after" >"$folder/differences"; then
    echo "$(find "$folder/after" -type f | wc -l) outputs, $(du -sh "$folder/after" | cut -f1): all the same"
else
    head -c 6000 "$folder/differences"
    grep -c '^diff' "$folder/differences" | sed 's/$/ outputs differ/'
    exit 1
fi
