"""Functions of the package."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, cast

from . import _native
from ._loop import Loop
from ._native import Scene
from ._notation import Form, Quantity, in_fields, in_scene, in_words, numbers, quantity, refusal, whole
from ._profile import Profile
from ._results import Ensemble, EnsembleFit, Fit, Fits, Found, Outcome, Preloads, Reference, Reversals, Study, Surface, Values

#: Path of a file.
AnyPath: TypeAlias = str | os.PathLike[str]

if TYPE_CHECKING:
    import numpy.typing as npt

    _Curve: TypeAlias = AnyPath | tuple[npt.ArrayLike, npt.ArrayLike]

#: Function that is called with the numbers of finished parts and of all parts. An exception in it stops the computation.
Progress: TypeAlias = Callable[[int, int], object] | None
#: Name of a built-in scene, path of a scene file, text of a scene, a Scene, or a Profile that was made of a form and a roughness.
AnyScene: TypeAlias = str | os.PathLike[str] | Scene | Profile

#: Scene of a flat smooth body, in which form and roughness are replaced.
_PLAIN = "(version: 1, material: (effective_modulus: 1.0e6), length: 1.0e-4)"
_EDGES = {"sub_cell": "SubCell", "grid": "Grid"}


def scene(scene: AnyScene, /, **fields: Any) -> Scene:
    """Opens a built-in scene, a scene file or the text of a scene, and changes fields of it.

    Each further argument changes a field, with two underscores for each point of its path: `adhesion__work="50 mJ/m²"` changes
    `adhesion.work`. The value None removes an optional part. `docs/scene-file.md` lists the fields.
    """
    if isinstance(scene, Profile):
        if scene.scene is None:
            saved = "numpy.save('line.npy', numpy.c_[profile.x, profile.heights]) and asperity.measured('line.npy', as_line=True)"
            raise ValueError(f"a profile of heights is no scene; allowed: a profile with the roughness of a file, {saved}")
        scene = scene.scene
    if not isinstance(scene, Scene):
        text = os.fspath(scene)
        scene = Scene.parse(text) if text.lstrip().startswith("(") else Scene.open(text)
    return scene.set(in_fields(fields)) if fields else scene


def sphere(radius: Quantity) -> Form:
    """Returns a sphere of this radius in m. It is a paraboloid, as in the theories of Hertz and JKR."""
    return Form("Paraboloid", radius=radius)


def cone(angle: Quantity) -> Form:
    """Returns a cone. `angle` is the angle between its flank and the surface in rad."""
    return Form("Cone", angle=angle)


def power(coefficient: Quantity, exponent: Quantity) -> Form:
    """Returns a body of revolution with the depth b rⁿ at the radius r. `coefficient` is b in m^(1−n), `exponent` is n."""
    return Form("Power", coefficient=coefficient, exponent=exponent)


def punch(radius: Quantity) -> Form:
    """Returns a flat punch of this radius in m."""
    return Form("Punch", radius=radius)


def wavy_sphere(radius: Quantity, amplitude: Quantity, wavelength: Quantity) -> Form:
    """Returns a sphere with concentric waves. Radius, amplitude and wavelength are in m."""
    return Form("WavySphere", radius=radius, amplitude=amplitude, wavelength=wavelength)


def table(file: str | os.PathLike[str], unit: str | None = None) -> Form:
    """Returns a body of revolution whose radii and depths are in a file. `unit` is their unit if the file states none.

    `numpy.save("tip.npy", numpy.c_[radii, depths])` writes such a file of two arrays.
    """
    if not isinstance(file, (str, os.PathLike)):
        raise refusal("file", f"an object of the type {type(file).__name__}", "a path, numpy.save('tip.npy', numpy.c_[radii, depths])")
    return Form("Table", file=Path(file).absolute(), unit=unit)


def self_affine(
    hurst: Quantity,
    *,
    rms_height: Quantity | None = None,
    rms_gradient: Quantity | None = None,
    modes: tuple[int, int] | None = None,
    wavelengths: tuple[Quantity, Quantity] | None = None,
    roll_off: Quantity | None = None,
) -> Form:
    """Returns a random self-affine roughness with this Hurst exponent.

    Its amplitude is given by `rms_height` in m or by `rms_gradient`. Its waves are given by `modes`, the first and the last
    number of waves per length, or by `wavelengths`, the longest and the shortest one in m. Above the wavelength `roll_off` in m
    the spectrum of the surface is flat.
    """
    return Form(
        "SelfAffine",
        hurst=hurst,
        rms_height=rms_height,
        rms_gradient=rms_gradient,
        modes=modes,
        wavelengths=wavelengths,
        roll_off=roll_off,
    )


def measured(file: AnyPath, **options: Any) -> Form:
    """Returns the roughness of a measured surface in a file. Options are the fields `roughness.*` of `docs/surfaces.md`.

    Profiles are random and have the measured spectrum. With `as_line=True` the profile is the measured one.
    """
    return Form("Measured", file=Path(file).absolute(), **options)


def profile(
    length: Quantity,
    points: int = 16384,
    *,
    form: Form | None = None,
    roughness: Form | None = None,
    seed: int = 1,
) -> Profile:
    """Makes the profile of a body with a form and a roughness, with `points` points along a length in m.

    A seed gives the same random phases on any machine and for any number of points.
    """
    if roughness is not None and not roughness.values.get("as_line"):
        roughness = Form(roughness.kind, **{**roughness.values, "seed": seed})
    fields = {"length": length, "numerics.points": points, "form": form, "roughness": roughness}
    scene = Scene.parse(_PLAIN).set(in_fields(fields))
    return Profile._of(_native.Profile.of_scene(scene), scene)


def load(
    profile: Profile,
    *,
    modulus: Quantity,
    work: Quantity = 0.0,
    closing_work: Quantity | None = None,
    stages: str | Sequence[Quantity] = "zero force, separation",
    loading_stiffness: Quantity | None = None,
    edges: str = "sub_cell",
    samples: int = 512,
    progress: Progress = None,
) -> Loop:
    """Loads a separated body through loading stages, and returns its force loop.

    `modulus` is the effective modulus E* in Pa. `work` is the work of adhesion in J/m² that opens the interface. `closing_work`
    in J/m² is gained where the interface closes, by default the same. A stage ends at a force (`"10 µN"`, or a number in N), at
    an indentation (`"200 nm"`), or at a displacement of the instrument (`"displacement 200 nm"`). It may also be `"touch"`,
    `"zero force"`, `"separation"`, or `"3 loops 0 N to 10 µN"`. The instrument has the stiffness `loading_stiffness` in N/m, by
    default infinite. `edges` is `"sub_cell"` for edges of contact patches between springs, or `"grid"` for whole springs. The
    force curve has `samples` points on each stage. The smallest and the largest force do not depend on their number.
    """
    modulus = quantity(modulus, "Pa", "modulus")
    work = quantity(work, "J/m²", "work")
    closing_work = None if closing_work is None else quantity(closing_work, "J/m²", "closing_work")
    if loading_stiffness is not None:
        loading_stiffness = quantity(loading_stiffness, "N/m", "loading_stiffness")
    samples = whole(samples, "samples", 2, 1_000_000)
    if edges not in _EDGES:
        raise refusal("edges", edges, ", ".join(_EDGES))
    stages = stages if isinstance(stages, str) else ", ".join(map(in_scene, stages))
    if profile.scene is None:
        works = [work if closing_work is None else closing_work, work]
        stiffness = float("inf") if loading_stiffness is None else loading_stiffness
        foundation = (modulus, works, stiffness)
        load = (foundation, (stages, edges == "grid", samples))
        return Loop(_native.Loop.of_heights(profile._native, load, progress))
    adhesion = {"work": work} if closing_work is None else {"work": work, "closing_work": closing_work}
    fields = {
        "material": {"effective_modulus": modulus},
        "adhesion": None if work == 0 else adhesion,
        "loading": stages,
        "loading_stiffness": loading_stiffness,
        "numerics.edges": _EDGES[edges],
        "numerics.samples": samples,
    }
    body = profile.scene.set(in_fields(fields))
    return Loop(_native.Loop.of_scene(body, progress), body)


def run(
    scene: AnyScene, /, *, profiles: int | None = None, jobs: int | None = None, progress: Progress = None, **fields: Any
) -> Outcome:
    """Computes a scene as `asperity run` does: on its own profile, and on `profiles` random profiles, by default 16.

    `jobs` is the number of threads, by default one for each core. No result depends on it. `progress` is called with the number
    of finished profiles and the number of all profiles.
    """
    call = _call(scene, fields, profiles, jobs, progress)
    loop = _native.Loop.of_scene(call[0], None)
    return Outcome(call[0], _native.run(call, loop), loop)


def ensemble(
    scene: AnyScene, /, *, profiles: int | None = None, jobs: int | None = None, progress: Progress = None, **fields: Any
) -> Ensemble:
    """Computes a scene on random profiles, by default 16, and returns their statistics."""
    return Ensemble(_native.ensemble(_call(scene, fields, profiles, jobs, progress)))


def find(
    field: str,
    scene: AnyScene,
    /,
    where: str,
    *,
    range: tuple[Quantity, Quantity] | str | None = None,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Progress = None,
    **fields: Any,
) -> Found:
    """Finds the value of a field, or of the `preload`, that meets a condition such as `where="F_a/F_a,max = 20 %"`.

    The value is found for each of several random profiles. `range` are its limits, by default a hundredth and a hundred times
    of the value in the scene.
    """
    searched = None if range is None else _range(range)
    return Found(_native.find(_call(scene, fields, profiles, jobs, progress), field, where, searched))


def preloads(
    scene: AnyScene,
    between: tuple[Quantity, Quantity],
    /,
    *,
    count: int = 64,
    log: bool = False,
    profiles: int = 1,
    jobs: int | None = None,
    progress: Progress = None,
    **fields: Any,
) -> Preloads:
    """Computes the adhesion force after each of `count` preloads between two forces in N, with `log` at equal ratios."""
    axis = f"{_range(between)}:{count}" + (":log" if log else "")
    return Preloads(_native.preloads(_call(scene, fields, profiles, jobs, progress), axis))


def reversals(
    scene: AnyScene,
    between: tuple[Quantity, Quantity] | None = None,
    /,
    *,
    count: int = 64,
    progress: Progress = None,
    **fields: Any,
) -> Reversals:
    """Computes the unloadings of a scene from `count` turning points between two forces in N.

    By default the turning points lie between first touch and the preload of the scene.
    """
    ends = None if between is None else _range(between)
    count = whole(count, "count", 2, 512)
    return Reversals(_native.reversals(_call(scene, fields, None, None, progress), ends, count))


def reference(
    scene: AnyScene,
    /,
    *,
    grid: int = 64,
    maps: int | None = None,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Progress = None,
    **fields: Any,
) -> Reference:
    """Computes a scene in three dimensions on random squares of `grid` × `grid` cells, and on random profiles.

    `maps` is the number of squares, by default 24 without and 12 with adhesion.
    """
    cells = whole(grid, "grid", 1, 2**16)
    count = None if maps is None else whole(maps, "maps", 1, 10_000)
    return Reference(_native.reference(_call(scene, fields, profiles, jobs, progress), cells, count))


def criteria(scene: AnyScene, /, **fields: Any) -> list[Values]:
    """Returns what other theories say of a scene, each with its number, its threshold and its reference."""
    found: list[Values] = run(scene, profiles=1, **fields).criteria
    return found


def study(
    scene: AnyScene,
    axes: Mapping[str, Sequence[Quantity]],
    /,
    *,
    record: Sequence[str] = ("adhesion_force", "regime"),
    profiles: int = 16,
    jobs: int | None = None,
    progress: Progress = None,
    **fields: Any,
) -> Study:
    """Computes a scene for all combinations of values, such as `{"adhesion.kappa": [2, 6, 20]}`, on random profiles for each.

    `record` names the quantities to record; `docs/studies.md` lists them.
    """
    values = [(path, [float(value) for value in axis]) for path, axis in axes.items()]
    return Study(_native.study(_call(scene, fields, profiles, jobs, progress), values, list(record)))


def surface(
    files: AnyPath | Sequence[AnyPath] | npt.ArrayLike,
    /,
    *,
    spacing: Quantity | tuple[Quantity, Quantity] | None = None,
    opposite: AnyPath | None = None,
    **options: Any,
) -> Surface:
    """Reads and analyses a measured surface: a file, several files with measurements of the same surface, or an array.

    An array holds the heights of a profile or a map in m. `spacing` is the distance between its points in m, or the two
    distances along a row and between rows. `opposite` is a file of the opposite surface. `asperity surface --help` lists the
    further options, for example `unit="um"`, `detrend="tilt"`, `periodic=True`, `interpolate=True`, `channel=1`,
    `continue_to="10 nm"`, `tip_radius="10 nm"` and `modulus="2.7 MPa"`.
    """
    if isinstance(files, (str, os.PathLike)):
        files = [files]
    words = in_words({"opposite": opposite, **options})
    if isinstance(files, (list, tuple)) and files and all(isinstance(one, (str, os.PathLike)) for one in files):
        words += [*in_words({"spacing": spacing}), "--", *map(os.fspath, files)]
        return Surface(_native.Surface(words, None))
    if spacing is None:
        raise refusal("spacing", None, "the distance between the points of the array, m")
    distances = spacing if isinstance(spacing, tuple) else (spacing, spacing)
    along, across = (quantity(distance, "m", "spacing") for distance in distances)
    heights = numbers(cast("npt.ArrayLike", files), "heights", (1, 2))
    return Surface(_native.Surface([*words, "array"], (heights.reshape(-1, heights.shape[-1]), [along, across])))


def fit(
    curves: _Curve | Sequence[_Curve],
    scene: AnyScene,
    /,
    free: Sequence[str] | Mapping[str, tuple[Quantity, Quantity]],
    *,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Progress = None,
    options: Mapping[str, Any] | None = None,
    **fields: Any,
) -> Fit | Fits | EnsembleFit:
    """Fits parameters of a scene to a measured force curve, to each of several curves, or to all curves together.

    A curve is a file, or a pair of arrays with displacements in m and forces in N. `free` names the parameters to fit: work,
    closing_work, modulus, offset, zero, stiffness and radius. A dictionary gives their ranges as well. With `profiles`, one
    work of adhesion is found for all curves of a rough body, by comparison with so many random profiles. `options` state how to
    read the curves, as `asperity fit --help` lists them: `{"units": ["nm", "nN"], "noise": "2 nN", "tilt": "remove"}`.
    """
    is_single = isinstance(curves, (str, os.PathLike, tuple))
    given: list[Any] = [curves] if is_single else list(cast("Sequence[_Curve]", curves))
    if not given:
        raise refusal("curves", given, "a curve, or a list of at least one curve")
    all_curves = [_curve(number, curve) for number, curve in enumerate(given, 1)]
    named = [name if ends is None else f"{name}={_range(ends)}" for name, ends in _ranges(free)]
    words = [f"--free={one}" for one in named] + in_words({"profiles": profiles, **(options or {})})
    call = _call(scene, fields, None, jobs, progress)
    report = _native.fit(call, (all_curves, is_single), [*words, "curves", "scene"])
    if profiles is not None:
        return EnsembleFit(report)
    return Fit(report) if is_single else Fits(report)


def _curve(number: int, curve: Any) -> tuple[str, Any]:
    if isinstance(curve, tuple) and len(curve) == 2:
        return f"curve {number}", (numbers(curve[0], "displacement"), numbers(curve[1], "force"))
    if isinstance(curve, (str, os.PathLike)):
        return os.fspath(curve), None
    raise refusal("curves", curve, "a file, or a pair of arrays with displacements and forces")


def _ranges(
    free: Sequence[str] | Mapping[str, tuple[Quantity, Quantity]],
) -> Sequence[tuple[str, tuple[Quantity, Quantity] | None]]:
    return list(free.items()) if isinstance(free, Mapping) else [(name, None) for name in free]


def press(
    heights: npt.ArrayLike,
    /,
    *,
    side: Quantity,
    modulus: Quantity,
    force: Quantity,
    periodic: bool = False,
    residual: float = 1e-8,
) -> Values:
    """Presses a rigid square map of heights in m on an elastic half-space in three dimensions, without adhesion.

    The side of the map is in m, the effective modulus in Pa, the force in N. The map has 32, 64, 128 … cells along a side. The
    conditions of contact are violated by at most `residual` rms heights. `pressure` in Pa and `gap` in m of the result are
    maps.
    """
    load = (quantity(side, "m", "side"), quantity(modulus, "Pa", "modulus"), quantity(force, "N", "force"))
    square = numbers(heights, "heights", (2,))
    cells = len(square)
    if square.shape != (cells, cells):
        raise refusal("heights", f"an array of the shape {square.shape}", "a square map")
    maps, figures = _native.press(square, load, periodic, quantity(residual, "1", "residual"))
    pressure, gap = (found.reshape(cells, cells) for found in maps)
    found = Values(zip(["force", "indentation", "area", "residual", "convolutions"], figures, strict=True))
    return Values(found, convolutions=int(found.convolutions), pressure=pressure, gap=gap)


def presets() -> list[str]:
    """Returns the names of the built-in scenes."""
    return _native.presets()


def _call(
    given: AnyScene, fields: Mapping[str, Any], profiles: int | None, jobs: int | None, progress: Progress
) -> tuple[Scene, int | None, int | None, Progress]:
    profiles = None if profiles is None else whole(profiles, "profiles", 1, 1_000_000)
    jobs = None if jobs is None else whole(jobs, "jobs", 1, 1024)
    return scene(given, **fields), profiles, jobs, progress


def _range(ends: tuple[Quantity, Quantity] | str) -> str:
    return ends if isinstance(ends, str) else "..".join(map(in_scene, ends))
