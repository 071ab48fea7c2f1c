"""Table of docs/three-dimensions.md: the profile over three dimensions, by Hurst exponent and e_el/γ.

    python3 benches/three_dimensions.py [asperity]

Each row is one call of `asperity reference`; no number depends on the machine.
"""

import json
import subprocess
import sys

PROGRAM = sys.argv[1] if len(sys.argv) > 1 else "asperity"
SCENE = "docs/examples/rough-square.ron"


def ratio(of):
    if of is None:
        return ""
    digits = 2 if of["value"] < 10 else 0
    error = "" if of["error"] is None else f" ± {of['error']:.{digits}f}"
    return f"{of['value']:.{digits}f}{error}"


def row(hurst, energy):
    fields = [f"roughness.hurst={hurst}", f"adhesion.elastic_energy_ratio={energy}"]
    sets = [word for field in fields for word in ("--set", field)]
    command = [PROGRAM, "reference", SCENE, "--format", "json", *sets]
    found = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    of, budget = found["ratio"], found["budget"]
    pressed, touched = of["pull_off_force"], of["first_touch_pull_off_force"]
    cells = [hurst, energy, ratio(pressed), ratio(touched), ratio(of["dissipated_energy"])]
    cells += [ratio(of["loading"][-1]["indentation"]), f"{100 * budget['grid']:.0f} %"]
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


if __name__ == "__main__":
    print("| H | e_el/γ | F_a after the preload | F_a at first touch | dissipated energy | indentation | grid |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for hurst in (0.3, 0.8):
        for energy in (0.3, 1.0, 3.0):
            print(row(hurst, energy), flush=True)
