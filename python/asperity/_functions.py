"""The functions of the package."""

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

#: Called with the number of parts that are done and of all parts; an exception stops the computation.
Progress: TypeAlias = Callable[[int, int], object] | None
#: Name of a built-in scene, path of a file, text of a scene, an open scene, or a profile made of a form and a roughness.
AnyScene: TypeAlias = str | os.PathLike[str] | Scene | Profile

#: A scene whose form and roughness are replaced.
_PLAIN = "(version: 1, material: (effective_modulus: 1.0e6), length: 1.0e-4)"
_EDGES = {"sub_cell": "SubCell", "grid": "Grid"}


def scene(scene: AnyScene, /, **fields: Any) -> Scene:
    """Opens a built-in scene, a scene file or the text of a scene, with other values of its fields.

    A field is an argument with two underscores for each point of its path, `adhesion__work="50 mJ/m²"`; None removes an
    optional part. `docs/scene-file.md` lists the fields.
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
    """A sphere of this radius, m, as the paraboloid that Hertz and JKR theory take for it."""
    return Form("Paraboloid", radius=radius)


def cone(angle: Quantity) -> Form:
    """A cone, with the angle between its flank and the surface, rad."""
    return Form("Cone", angle=angle)


def power(coefficient: Quantity, exponent: Quantity) -> Form:
    """A body of revolution of the shape b rⁿ, with the coefficient b in m^(1−n)."""
    return Form("Power", coefficient=coefficient, exponent=exponent)


def punch(radius: Quantity) -> Form:
    """A flat punch of this radius, m."""
    return Form("Punch", radius=radius)


def wavy_sphere(radius: Quantity, amplitude: Quantity, wavelength: Quantity) -> Form:
    """A sphere with concentric waves of this amplitude and wavelength, all in m."""
    return Form("WavySphere", radius=radius, amplitude=amplitude, wavelength=wavelength)


def table(file: str | os.PathLike[str], unit: str | None = None) -> Form:
    """A body of revolution whose depths at ascending radii are in a file, such as `numpy.save("tip.npy", numpy.c_[radii, depths])`."""
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
    """Random self-affine roughness of this Hurst exponent.

    Its amplitude is the rms height in m or the rms gradient, its waves are the first and last mode in waves per length or
    the longest and shortest wavelength in m. Above the wavelength `roll_off`, m, the spectrum of the surface is flat.
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
    """Roughness of a measured surface in a file, with the fields `roughness.*` of `docs/surfaces.md` as options.

    A profile is random with the measured spectrum, or with `as_line=True` the measured profile itself.
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
    """The profile of a body with a form and a roughness, on `points` springs along a length, m.

    The same seed gives the same random phases on any machine and for any number of points.
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

    `modulus` is the effective modulus E*, Pa; `work` the work of adhesion, J/m², and `closing_work` that of closing contact,
    by default the same. A stage is a force (`"10 µN"`, or a number in N), an indentation (`"200 nm"`), a displacement of the
    instrument (`"displacement 200 nm"`), `"touch"`, `"zero force"`, `"separation"`, or `"3 loops 0 N to 10 µN"`. The
    instrument has the stiffness `loading_stiffness`, N/m, by default infinite. `edges` is `"sub_cell"` for edges between
    springs or `"grid"` for whole springs; each stage has `samples` points of the curve. Extremes of the force are exact for any
    number of them.
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
    """Computes a scene, as `asperity run` does: on its own profile, and on `profiles` random profiles, by default 16.

    `jobs` threads share the profiles, by default one for each core; no result depends on their number. `progress` is called
    with the number of profiles that are done and of all.
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
    """Finds the number of a scene, or the `preload`, at which a quantity has a value: `where="F_a/F_a,max = 20 %"`.

    Each random profile is searched for itself. The searched range is by default two decades down and up.
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
    """Computes the adhesion force for `count` preloads between two forces, N; with `log` at equal ratios."""
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
    """Computes the unloading of a scene from `count` turning points between two forces, N; by default up to its preload."""
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
    """Computes a scene in three dimensions on random squares of `grid` cells along a side, beside random lines.

    `maps` is the number of squares, by default 24 without and 12 with adhesion.
    """
    cells = whole(grid, "grid", 1, 2**16)
    count = None if maps is None else whole(maps, "maps", 1, 10_000)
    return Reference(_native.reference(_call(scene, fields, profiles, jobs, progress), cells, count))


def criteria(scene: AnyScene, /, **fields: Any) -> list[Values]:
    """What other theories say on a scene, each with its value, its threshold and its reference."""
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
    """Computes a scene for all combinations of values, such as `{"adhesion.kappa": [2, 6, 20]}`, on random profiles of each.

    `record` names quantities of `docs/studies.md`.
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
    """Reads and analyses measured surfaces: a file, several files that are samples of one roughness, or an array.

    An array holds the heights of a profile or a map in m, and `spacing` is the distance between its points, or the distances
    along its rows and between them. `opposite` is a file of the opposite face. Further options are those of
    `asperity surface --help`: `unit="um"`, `detrend="tilt"`, `periodic=True`, `interpolate=True`, `channel=1`,
    `continue_to="10 nm"`, `tip_radius="10 nm"`, `modulus="2.7 MPa"` and others.
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

    A curve is a file, or a pair of arrays with displacements in m and forces in N. `free` names the parameters (work,
    closing_work, modulus, offset, zero, stiffness, radius), or gives the range of each. With `profiles` one work of adhesion is
    found for all curves of a rough body, by comparison with random profiles. `options` are those of `asperity fit --help` for
    reading curves: `{"units": ["nm", "nN"], "noise": "2 nN", "tilt": "remove"}` and others.
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
    """Presses a rigid square map of heights, m, on an elastic half-space in three dimensions, without adhesion.

    The side of the map is in m, the effective modulus in Pa, the force in N; the map has 32, 64, 128 … cells along a side.
    `pressure` (Pa) and `gap` (m) of the result are maps; the solution has violations of at most `residual` rms heights.
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
    """Names of the built-in scenes."""
    return _native.presets()


def _call(
    given: AnyScene, fields: Mapping[str, Any], profiles: int | None, jobs: int | None, progress: Progress
) -> tuple[Scene, int | None, int | None, Progress]:
    profiles = None if profiles is None else whole(profiles, "profiles", 1, 1_000_000)
    jobs = None if jobs is None else whole(jobs, "jobs", 1, 1024)
    return scene(given, **fields), profiles, jobs, progress


def _range(ends: tuple[Quantity, Quantity] | str) -> str:
    return ends if isinstance(ends, str) else "..".join(map(in_scene, ends))
