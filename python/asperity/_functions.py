"""The functions of the package."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, SupportsFloat, TypeAlias

from . import _native
from ._native import Loop, Profile, Scene, quantity, whole
from ._notation import Form, in_fields, in_scene, refusal
from ._results import Ensemble, Found, Outcome, Preloads, Reference, Reversals

#: A number in SI units, or a text with its unit.
Quantity: TypeAlias = SupportsFloat | str
#: Called with the number of parts that are done and of all parts; an exception stops the computation.
Progress: TypeAlias = Callable[[int, int], object] | None
#: Name of a built-in scene, path of a file, text of a scene, or an open scene.
AnyScene: TypeAlias = str | os.PathLike[str] | Scene

#: A scene whose form and roughness are replaced.
_PLAIN = "(version: 1, material: (effective_modulus: 1.0e6), length: 1.0e-4)"
_EDGES = {"sub_cell": "SubCell", "grid": "Grid"}


def scene(scene: AnyScene, /, **fields: Any) -> Scene:
    """Opens a built-in scene, a scene file or the text of a scene, with other values of its fields.

    A field is an argument with two underscores for each point of its path, `adhesion__work="50 mJ/m²"`; None removes an
    optional part. `docs/scene-file.md` lists the fields.
    """
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
    """A body of revolution whose depths at ascending radii are in a file."""
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
    if roughness is not None:
        roughness = Form(roughness.kind, **{**roughness.values, "seed": seed})
    fields = {"length": length, "numerics.points": points, "form": form, "roughness": roughness}
    return Profile.of_scene(Scene.parse(_PLAIN).set(in_fields(fields)))


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
        return Loop.of_heights(
            profile, modulus, work, closing_work, stages, loading_stiffness, _EDGES[edges], samples, progress
        )
    adhesion = {"work": work} if closing_work is None else {"work": work, "closing_work": closing_work}
    fields = {
        "material": {"effective_modulus": modulus},
        "adhesion": None if work == 0 else adhesion,
        "loading": stages,
        "loading_stiffness": loading_stiffness,
        "numerics.edges": _EDGES[edges],
        "numerics.samples": samples,
    }
    return Loop.of_body(profile.scene.set(in_fields(fields)), progress)


def run(
    scene: AnyScene, /, *, profiles: int | None = None, jobs: int | None = None, progress: Progress = None, **fields: Any
) -> Outcome:
    """Computes a scene, as `asperity run` does: on its own profile, and on `profiles` random profiles, by default 16.

    `jobs` threads share the profiles, by default one for each core; no result depends on their number. `progress` is called
    with the number of profiles that are done and of all.
    """
    return Outcome(*_native.run(_scene(scene, fields), _count("profiles", profiles), _count("jobs", jobs, 1024), progress))


def ensemble(
    scene: AnyScene, /, *, profiles: int | None = None, jobs: int | None = None, progress: Progress = None, **fields: Any
) -> Ensemble:
    """Computes a scene on random profiles, by default 16, and returns their statistics."""
    return Ensemble(_native.ensemble(_scene(scene, fields), _count("profiles", profiles), _count("jobs", jobs, 1024), progress))


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
    return Found(_native.find(_scene(scene, fields), field, where, searched, _count("profiles", profiles), _count("jobs", jobs, 1024), progress))


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
    return Preloads(_native.preloads(_scene(scene, fields), axis, _count("profiles", profiles), _count("jobs", jobs, 1024), progress))


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
    return Reversals(_native.reversals(_scene(scene, fields), ends, count, progress))


def reference(
    scene: AnyScene,
    /,
    *,
    grid: int = 64,
    maps: int = 24,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Progress = None,
    **fields: Any,
) -> Reference:
    """Computes a scene in three dimensions on random squares of `grid` cells along a side, beside random lines."""
    return Reference(_native.reference(_scene(scene, fields), grid, maps, _count("profiles", profiles), _count("jobs", jobs, 1024), progress))


def presets() -> dict[str, str]:
    """Names and titles of the built-in scenes."""
    return dict(_native.presets())


def _scene(name: AnyScene, fields: Mapping[str, Any]) -> Scene:
    return scene(name, **fields)


def _count(name: str, value: int | None, most: int = 1_000_000) -> int | None:
    return None if value is None else whole(value, name, 1, most)


def _range(ends: tuple[Quantity, Quantity] | str) -> str:
    return ends if isinstance(ends, str) else "..".join(map(in_scene, ends))
