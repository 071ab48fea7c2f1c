#!/usr/bin/env bash
# Compares the outputs of two builds of the program byte for byte, for changes that must not change results.
#
#   tests/same_outputs.sh BEFORE AFTER
#
# BEFORE and AFTER are executables. Each writes, into a folder of its own, all built-in scenes as text, JSON, CSV, NPY,
# SVG and profile; ensembles, inverse questions, sensitivities, reversals and preloads; three studies with few profiles;
# fits of measured curves, analyses of measured surfaces and comparisons in three dimensions, together with what they
# refuse; the catalogue of hard cases and frames of a demo. The folders are then compared. Costs are left out, since they
# depend on the speed of the machine.
set -euo pipefail
[ $# = 2 ] || { sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2; }

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

# Writes what a command prints, its errors and its exit code to the file that the first argument names.
recorded() {
    local file="$1"
    shift
    "$@" >"$file.out" 2>"$file.errors" && echo 0 >"$file.code" || echo $? >"$file.code"
    case "$file" in
    *.json) { without_seconds <"$file.out" || true; } >"$file" 2>/dev/null ;;
    *) without_times <"$file.out" >"$file" ;;
    esac
    rm "$file.out"
    # Progress is written on one line, which each report replaces.
    tr '\r' '\n' <"$file.errors" | grep -v '^[^ ]* of \|^ *$' | without_times >"$file.refused" || true
    rm "$file.errors"
}

# Makes curves and surfaces by formula: a sphere on a spring with noise, a rough map with a tilt and missing points.
measured_files() {
    python3 - <<'END'
import math, random

random.seed(4)
def curve(name, work, header, scale, columns):
    radius, modulus, stiffness = 7.5e-6, 2.0e6, 3.0
    points = []
    contact = [1e-9 * i for i in range(4200, 300, -12)]
    def state(a):
        depth = a * a / radius - math.sqrt(2 * math.pi * a * work / modulus)
        force = 4 * modulus * a**3 / (3 * radius) - math.sqrt(8 * math.pi * modulus * work * a**3)
        return depth + force / stiffness, force
    loading = [state(a) for a in reversed(contact)]
    loading = [point for point in loading if point[0] > 0]
    unloading = [state(a) for a in contact]
    least = min(range(len(unloading)), key=lambda i: unloading[i][0])
    unloading = unloading[:least]
    free = [(-5e-9 * i, 0.0) for i in range(1, 120)]
    points = list(reversed(free)) + loading + unloading
    points += [(unloading[-1][0] - 5e-9 * i, 0.0) for i in range(1, 120)]
    with open(name, "w") as file:
        file.write(header)
        for displacement, force in points:
            force += random.gauss(0, 5e-9)
            cells = {"d": displacement * scale[0], "f": force * scale[1]}
            file.write(",".join(f"{cells[c]:.9g}" for c in columns) + "\n")

curve("named.csv", 0.06, "displacement [nm],force [nN]\n", (1e9, 1e9), "df")
curve("bare.csv", 0.05, "", (1.0, 1.0), "df")
curve("swapped.csv", 0.04, "force (N),height (m)\n", (1.0, 1.0), "fd")

waves = [(random.randint(1, 12), random.randint(0, 12), random.uniform(0, 6.28)) for _ in range(60)]
def height(x, y):
    rough = sum((p * p + q * q) ** -0.85 * math.cos(6.283185 * (p * x + q * y) + phase) for p, q, phase in waves)
    return 1e-8 * rough + 2e-7 * x - 1e-7 * y
with open("map.txt", "w") as file:
    file.write("# Width: 20 um\n# Height: 16 um\n# Value units: m\n")
    for row in range(64):
        file.write("\t".join(f"{height(column / 80, row / 80):.6e}" for column in range(80)) + "\n")
with open("gaps.txt", "w") as file:
    for row in range(40):
        cells = ["nan" if (row * 40 + column) % 97 == 0 else f"{height(column / 40, row / 40):.6e}" for column in range(40)]
        file.write("\t".join(cells) + "\n")
with open("profile.csv", "w") as file:
    file.write("x [um],z [nm]\n")
    for index in range(512):
        file.write(f"{0.05 * index:.4f},{1e9 * height(index / 512, 0.3):.5f}\n")
END
}

outputs() {
    local asperity plan scene examples sphere
    asperity="$(realpath "$1")"
    examples="$(realpath "$(dirname "$0")/../docs/examples")"
    mkdir "$2"
    cd "$2"
    export NO_COLOR=1 LC_ALL=C.UTF-8
    measured_files
    for scene in $("$asperity" presets list | awk '{ print $1 }'); do
        "$asperity" presets show "$scene" >"$scene.ron"
        "$asperity" profile "$scene" >"$scene.line.csv"
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
    for scene in jkr-sphere pressure-sensitive rough-sphere two-works kendall-punch; do
        "$asperity" run "$scene" --format svg >"$scene.svg"
        "$asperity" run "$scene" --format npy -o "$scene.npy" >/dev/null 2>&1
        recorded "$scene.sensitivity.txt" "$asperity" sensitivity "$scene" --set numerics.points=2048
        recorded "$scene.reversals.csv" "$asperity" reversals "$scene" --set numerics.points=1024 --format csv
        recorded "$scene.preloads.csv" "$asperity" run "$scene" --set numerics.points=2048 --preloads 0..20uN:9 --format csv
    done
    recorded panels.svg "$asperity" run jkr-sphere rough-sphere --draw panels --format svg
    recorded find.preload.json "$asperity" find preload pressure-sensitive --where 'F_a/F_a,max = 20 %' --format json
    recorded find.work "$asperity" find adhesion.work jkr-sphere --where 'F_a = 30 uN'
    recorded find.none "$asperity" find preload jkr-sphere --where 'F_a = 20 uN'
    recorded find.unknown "$asperity" find preload jkr-sphere --where 'F_a = 3 apples'
    sphere=(jkr-sphere --set form.radius=7.5u --set length=24u --set loading_stiffness=3 --set numerics.points=512)
    recorded fit.named "$asperity" fit named.csv "${sphere[@]}" --free work,modulus,offset
    recorded fit.named.json "$asperity" fit named.csv "${sphere[@]}" --free work,offset --format json
    recorded fit.bare "$asperity" fit bare.csv "${sphere[@]}" --free work,offset
    recorded fit.units "$asperity" fit bare.csv "${sphere[@]}" --free work,offset --units m,N
    recorded fit.swapped "$asperity" fit swapped.csv "${sphere[@]}" --free work,offset
    recorded fit.segments "$asperity" fit named.csv "${sphere[@]}" --free work,offset --segments 2
    recorded fit.segment "$asperity" fit named.csv "${sphere[@]}" --free work,offset --segments 5
    recorded fit.nothing "$asperity" fit named.csv "${sphere[@]}"
    recorded fit.closing "$asperity" fit named.csv "${sphere[@]}" --free work,closing_work,offset --tilt remove --drift remove
    recorded fit.both "$asperity" fit named.csv swapped.csv "${sphere[@]}" --free work,offset --format csv
    recorded fit.missing "$asperity" fit nowhere.csv "${sphere[@]}" --free work
    recorded fit.surface "$asperity" fit map.txt "${sphere[@]}" --free work
    recorded fit.rubber "$asperity" fit "$examples/rubber.csv" "${sphere[@]}" --free work,modulus,offset
    recorded fit.svg "$asperity" fit named.csv "${sphere[@]}" --free work,offset --format svg
    recorded surface.map "$asperity" surface map.txt
    recorded surface.map.json "$asperity" surface map.txt --modulus 1MPa --work 50mJ/m2 --format json
    recorded surface.row "$asperity" surface map.txt --row 3
    recorded surface.tip "$asperity" surface map.txt --tip-radius 1um --detrend curvature
    recorded surface.periodic "$asperity" surface map.txt --periodic
    recorded surface.gaps "$asperity" surface gaps.txt --unit m --spacing 0.5um
    recorded surface.filled "$asperity" surface gaps.txt --unit m --spacing 0.5um --interpolate
    recorded surface.profile "$asperity" surface profile.csv --modulus 1MPa --work 50mJ/m2 --preload 10uN --profiles 4
    recorded surface.continued.json "$asperity" surface profile.csv --continue-to 10nm --format json
    recorded surface.csv "$asperity" surface profile.csv --format csv
    recorded surface.svg "$asperity" surface profile.csv map.txt --format svg
    recorded reference.rough "$asperity" reference "$examples/rough-square.ron" --grid 32 --surfaces 3 --profiles 8
    recorded reference.two.json "$asperity" reference "$examples/rough-square.ron" --grid 32 --surfaces 2 --profiles 8 --format json
    recorded reference.sphere "$asperity" reference jkr-sphere --grid 32
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
