"""Compares `asperity surface` with the package SurfaceTopography on the same files.

    python3 tests/surface_topography.py ASPERITY

Writes a map and profiles in every format that the package writes, except image tiles (DZI), and compares rms height, rms
slope, reliability cut-off and power spectral density. Exit code 77: the package is not installed.
"""

import json
import os
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from SurfaceTopography import NonuniformLineScan, Topography, UniformLineScan
    from SurfaceTopography.Container.SurfaceContainer import InMemorySurfaceContainer
except ImportError as error:
    print(f"SurfaceTopography cannot be imported ({error}): nothing is compared")
    sys.exit(77)

POINTS, LENGTH, TIP_RADIUS = 128, 1e-4, 5e-5


def surface(seed):
    """Heights of an isotropic map with a roll-off, m."""
    wave = np.fft.fftfreq(POINTS, 1 / POINTS)
    number = np.hypot(*np.meshgrid(wave, wave, indexing="ij"))
    amplitude = np.where(number > 0, np.maximum(number, 8.0) ** -1.8, 0.0)
    amplitude[number > POINTS / 2] = 0
    phases = np.random.default_rng(seed).random((POINTS, POINTS))
    heights = np.fft.ifft2(amplitude * np.exp(2j * np.pi * phases)).real
    return 1e-7 * heights / heights.std()


def asperity(program, *arguments):
    """The JSON report of the program."""
    command = [program, "surface", *arguments, "--format", "json"]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def close(name, found, expected, tolerance=1e-10):
    """Ends the comparison where two numbers differ."""
    if not abs(found - expected) <= tolerance * abs(expected):
        sys.exit(f"{name}: {found!r}, SurfaceTopography has {expected!r}")


def main(program, folder):
    heights = surface(1)
    scale = LENGTH / POINTS
    full = Topography(heights, (LENGTH, LENGTH), unit="m")
    full.to_gwy(f"{folder}/map.gwy")
    for kind in "DFLI":
        full.to_x3p(f"{folder}/map{kind}.x3p", dtype=kind)
    full.to_matrix(f"{folder}/map.txt")
    full.to_netcdf(f"{folder}/map.nc")
    np.save(f"{folder}/map.npy", heights)
    expected = full.detrend("height").rms_height_from_area()
    files = {"map.gwy": 1e-10, "mapD.x3p": 1e-10, "mapF.x3p": 1e-6, "mapL.x3p": 1e-6, "mapI.x3p": 1e-3, "map.txt": 1e-10}
    files["map.nc"] = 1e-10
    for file, tolerance in files.items():
        close(file, asperity(program, f"{folder}/{file}")["rms_height"], expected, tolerance)
    spaced = ["--unit", "m", "--spacing", f"{scale}m"]
    close("map.npy", asperity(program, f"{folder}/map.npy", *spaced)["rms_height"], expected)

    InMemorySurfaceContainer([full, full]).to_zip(f"{folder}/container.zip")
    report = asperity(program, f"{folder}/container.zip")
    close("container.zip", report["rms_height"], expected)
    if [file["measurement"] for file in report["files"]] != ["topography0.nc", "topography1.nc"]:
        sys.exit(f"container.zip: {report['files']}")

    profile = heights[:, 5].copy()
    x = np.arange(POINTS) * scale
    np.savetxt(f"{folder}/line.txt", np.c_[1e6 * x, 1e9 * profile], header="x [um] z [nm]", fmt="%.17e")
    line = UniformLineScan(profile, LENGTH, unit="m").detrend("height")
    UniformLineScan(profile, LENGTH, unit="m").to_netcdf(f"{folder}/line.nc")
    NonuniformLineScan(1e6 * x, 1e6 * profile, unit="um").to_netcdf(f"{folder}/points.nc")
    # Uneven points are written with the unit of positions alone.
    for file, units in [("line.nc", []), ("points.nc", ["--height-unit", "um"])]:
        close(file, asperity(program, f"{folder}/{file}", *units)["rms_height"], line.rms_height_from_profile())
    report = asperity(program, f"{folder}/line.txt", "--tip-radius", f"{TIP_RADIUS}m")
    close("rms height", report["rms_height"], line.rms_height_from_profile())
    close("rms slope", report["rms_slope"], line.rms_slope_from_profile())
    wave_numbers, powers = line.power_spectrum_from_profile(window="hann", reliable=False, resampling_method=None)
    # The same bins: ten for each decade; without the mean and the last wave.
    waves = slice(1, (POINTS - 1) // 2 + 1)
    places = np.floor(10 * np.log10(wave_numbers[waves])).astype(int)
    bins = report["profile_spectra"][0]["bins"]
    if len(bins) != len(set(places)):
        sys.exit(f"{len(bins)} bins, expected {len(set(places))}")
    for found, place in zip(bins, sorted(set(places))):
        close("wave number", found["wave_number"], wave_numbers[waves][places == place].mean())
        close("1D PSD", found["power"], powers[waves][places == place].mean())
    cutoff = line.scanning_probe_reliability_cutoff(TIP_RADIUS)
    found = report["reliability_cutoff"]
    if (cutoff is None) != (found is None):
        sys.exit(f"reliability cut-off: {found}, SurfaceTopography has {cutoff}")
    if cutoff is not None:
        # The package interpolates between points; the program takes the next whole distance.
        if not cutoff - 1e-9 * cutoff <= found <= cutoff + 4 * scale:
            sys.exit(f"reliability cut-off: {found}, SurfaceTopography has {cutoff}")
    print(f"{len(files) + 1} maps, 3 profiles, {len(bins)} bins and the cut-off {found} agree with SurfaceTopography")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        main(os.path.abspath(sys.argv[1]), folder)
