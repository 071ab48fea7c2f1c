"""Functions of the package."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, TypedDict, Unpack, cast, overload

from . import _native
from ._errors import FieldError, naming, warn_of
from ._executor import check_executor, gathered, ranges
from ._loop import Loop
from ._native import Scene
from ._notation import (
    Form,
    Quantity,
    Text,
    ends,
    field_number,
    flag,
    in_fields,
    in_scene,
    in_words,
    numbers,
    path,
    quantity,
    refusal,
    refused_type,
    text,
    whole,
)
from ._profile import Profile
from ._results import (
    Criterion,
    Ensemble,
    EnsembleFit,
    Fit,
    Fits,
    Found,
    Outcome,
    Preloads,
    Pressed,
    Reference,
    Reversals,
    Study,
    Surface,
)
from ._spectrum import Spectrum

#: Path of a file.
AnyPath: TypeAlias = str | os.PathLike[str]

if TYPE_CHECKING:
    import numpy.typing as npt

    _Curve: TypeAlias = AnyPath | npt.ArrayLike

#: Function that is called with the numbers of finished parts and of all parts. An exception in it stops the computation.
Progress: TypeAlias = Callable[[int, int], object] | None
#: Loading stages: a text such as "10 µN, separation", or a list of stages.
Stages: TypeAlias = str | Quantity | Sequence[Quantity]
#: Scene, number of profiles, number of threads, and the function of the progress.
_Call: TypeAlias = tuple[Scene, int | None, int | None, Progress]
#: Name of a built-in scene, path of a scene file, text of a scene, a Scene, or a Profile with a modulus.
AnyScene: TypeAlias = str | os.PathLike[str] | Scene | Profile

#: Scene of a flat smooth body, in which form, roughness and modulus are replaced.
_PLAIN = "(version: 1, material: (modulus: 1.0e6), length: 1.0e-4)"
_EDGES = {"sub_cell": "SubCell", "grid": "Grid"}
_DETRENDS = {"none": "Nothing", "nothing": "Nothing", "mean": "Mean", "tilt": "Tilt", "curvature": "Curvature"}
_FORMS = ("Paraboloid", "Cone", "Power", "WavySphere", "RoundedCone", "Punch", "Spheres", "Table")
_ROUGHNESS = ("SelfAffine", "Measured")
#: Arguments of all functions of scenes that are those of `load`.
_CONTACT = ("modulus", "work", "closing_work", "stages")
#: Parameters of the adhesion, which determine each other.
_ADHESION = ("adhesion.work", "adhesion.kappa", "adhesion.elastic_energy_ratio")
#: Fields of a scene that these arguments set.
_FIELDS = {
    "material.modulus": "modulus",
    "adhesion.work": "work",
    "adhesion.closing_work": "closing_work",
    "loading": "stages",
}
#: Options of `asperity fit` that are arguments of `fit`, or that belong to files that the command writes.
_NOT_READING = ("set", "free", "profiles", "jobs", "scene", "format", "output", "force")
_PRELOADS = "the smallest and the largest force in N; count gives their number, and log=True equal ratios"


class Reading(TypedDict, total=False):
    """Options of reading and analysing a measured surface; `docs/surfaces.md` explains them."""

    #: Unit of the lengths if the file states none, such as "um".
    unit: str | None
    #: Unit of the heights if the file states none, and if it is not the unit of the lengths.
    height_unit: str | None
    #: True if missing points get heights from their neighbours.
    interpolate: bool
    #: True if a profile with uneven distances between points is resampled.
    resample: bool
    #: True if the median of each row of a map is subtracted.
    align_rows: bool
    #: True if outliers get heights from their neighbours.
    robust: bool
    #: Number of the channel of the file, from 0, or name of the surface in a container.
    channel: int | str | None
    #: Name of the surface in a container.
    surface_name: str | None
    #: Number of the row of a map that is used alone, from 1.
    row: int | None
    #: Number of the column of a map that is used alone, from 1.
    column: int | None
    #: What is subtracted from the heights: "none", "mean", "tilt" or "curvature".
    detrend: str | None
    #: True if the surface repeats itself at its borders.
    periodic: bool
    #: Wavelength in m down to which the spectrum continues as a power law.
    continue_to: Quantity | None
    #: File of the surface of the opposite body, whose spectrum is added.
    opposite: AnyPath | None


def scene(
    scene: AnyScene,
    /,
    *,
    modulus: Quantity | None = None,
    work: Quantity | None = None,
    closing_work: Quantity | None = None,
    stages: Stages | None = None,
    **fields: Any,
) -> Scene:
    """Opens a built-in scene, a scene file, the text of a scene or a profile, and changes fields of it.

    `modulus`, `work`, `closing_work` and `stages` are those of `load`; a profile needs a modulus. Each further argument changes
    a field, with two underscores for each point of its path: `adhesion__work="50 mJ/m²"` changes `adhesion.work`. The value None
    removes an optional part, and one parameter of the adhesion replaces another one. `docs/scene-file.md` lists the fields. All
    functions that take a scene take these arguments.

    >>> asp.scene("jkr-sphere", work="20 mJ/m²")
    <Scene "jkr-sphere, changed">
    """
    return _opened(scene, _with_contact(fields, modulus, work, closing_work, stages))


def _with_contact(fields: dict[str, Any], *contact: Any) -> dict[str, Any]:
    """Returns the fields of a call with the values of its arguments modulus, work, closing_work and stages."""
    return {**fields, **dict(zip(_CONTACT, contact, strict=True))}


def _is_beside(field: str) -> bool:
    """True for a field of the material or the adhesion that does not state the modulus or the work, and may be given with them."""
    return field.replace("__", ".") == "adhesion.range" or field.replace("__", ".").startswith("material.relaxation")


def _opened(given: AnyScene, fields: Mapping[str, Any], takes_heights: bool = False) -> Scene:
    """Opens a scene and changes its fields. `takes_heights` is true where a profile of given heights is allowed."""
    contact = {name: fields[name] for name in _CONTACT if fields.get(name) is not None}
    others = {name: value for name, value in fields.items() if name not in _CONTACT}
    for name, group in [("modulus", "material"), ("work", "adhesion"), ("closing_work", "adhesion"), ("stages", "loading")]:
        twice = [other for other in others if other.replace("__", ".").split(".")[0] == group and not _is_beside(other)]
        if name in contact and twice:
            raise refusal(name, contact[name], f"either {name} or {twice[0]}, not both")
    if isinstance(given, Profile):
        has_modulus = "modulus" in contact or any(name.startswith("material") for name in others)
        opened = _scene_of_profile(given, has_modulus, takes_heights)
    elif isinstance(given, Scene):
        opened = given
    elif isinstance(given, (str, os.PathLike)):
        name = path(given, "scene")
        with naming("scene", name):
            opened = Scene.parse(name) if name.lstrip().startswith("(") else Scene.open(name)
    else:
        allowed = "the name of a built-in scene, a scene file, the text of a scene, a Scene or a Profile"
        raise refused_type("scene", given, allowed)
    changes = []
    if "modulus" in contact:
        modulus = quantity(contact["modulus"], "Pa", "modulus")
        # The relaxation stays, unless another argument changes it.
        relaxation = opened.value("material.relaxation")
        beside = "" if relaxation is None else f", relaxation: {relaxation}"
        changes.append(("material", f"(modulus: {in_scene(modulus, 'modulus')}{beside})"))
    if "stages" in contact:
        changes.append(("loading", _stages(contact["stages"])))
    changes += in_fields(others)
    closing = contact.get("closing_work")
    closing = None if closing is None else quantity(closing, "J/m²", "closing_work")
    if "work" in contact:
        work = quantity(contact["work"], "J/m²", "work")
        with _by_arguments(contact):
            opened = opened.with_works(work, closing)
    elif closing is not None:
        changes += in_fields({"adhesion.closing_work": closing})
    if not changes:
        return opened
    parameters = [(field, [value]) for field, value in changes if field in _ADHESION]
    if len(parameters) == 1:
        opened = _stated_by(opened, parameters)
    with naming(changes[0][0], changes[0][1]) if len(changes) == 1 else naming("fields", list(dict(changes))):
        with _by_arguments(contact):
            return opened.set(changes)


@contextmanager
def _by_arguments(given: Collection[str]) -> Iterator[None]:
    """Names the argument in an error about a field that was set by one of the arguments modulus, work, closing_work and stages."""
    try:
        yield
    except FieldError as error:
        field = next((field for field in _FIELDS if error.field == field or error.field.startswith(f"{field}.")), None)
        if field is None or _FIELDS[field] not in given:
            raise
        message, allowed = str(error), error.allowed
        for path, name in _FIELDS.items():
            message, allowed = message.replace(path, name), allowed.replace(path, name)
        raise FieldError(message, _FIELDS[field], error.value, allowed) from None


def _scene_of_profile(profile: Profile, has_modulus: bool, takes_heights: bool) -> Scene:
    if not has_modulus:
        raise refusal("modulus", None, "an effective modulus such as '1 MPa', since a profile has none")
    if profile._scene is not None:
        return profile._scene
    if takes_heights:
        return Scene.of_profile(profile._native, 1e6)
    allowed = (
        "asperity.load, asperity.preloads, asperity.reversals, asperity.study and asperity.fit; for other functions a profile "
        "of a form and a roughness, or numpy.save('line.npy', numpy.c_[profile.x, profile.heights]) and asperity.measured('line.npy', as_line=True)"
    )
    raise refusal("scene", "a profile of given heights, whose form and roughness are not known", allowed)


def _stages(stages: Any) -> str:
    if isinstance(stages, str):
        return stages
    if isinstance(stages, Sequence) and not isinstance(stages, (bytes, bytearray)):
        return ", ".join(in_scene(stage, "stages") for stage in stages)
    return in_scene(quantity(stages, "N", "stages"), "stages")


def sphere(radius: Quantity) -> Form:
    """Returns a sphere of this radius in m. It is a paraboloid, as in the theories of Hertz and JKR.

    >>> asp.sphere("100 µm")
    Paraboloid(radius: 0.0001)
    """
    return Form("Paraboloid", radius=field_number(radius, "form.radius", "Paraboloid", "radius"))


def cone(angle: Quantity) -> Form:
    """Returns a cone. `angle` is the angle between its flank and the surface in rad.

    >>> asp.cone("45°")
    Cone(angle: 0.7853981633974483)
    """
    return Form("Cone", angle=field_number(angle, "form.angle", "Cone", "angle"))


def power(coefficient: Quantity, exponent: Quantity) -> Form:
    """Returns a body of revolution with the depth b rⁿ at the radius r. `coefficient` is b in m^(1−n), `exponent` is n.

    >>> asp.power(1e12, 4)   # 10¹² m⁻³ r⁴
    Power(coefficient: 1000000000000.0, exponent: 4.0)
    """
    return Form(
        "Power",
        coefficient=field_number(coefficient, "form.coefficient", "Power", "coefficient"),
        exponent=field_number(exponent, "form.exponent", "Power", "exponent"),
    )


def punch(radius: Quantity) -> Form:
    """Returns a flat punch of this radius in m.

    >>> asp.punch("10 µm")
    Punch(radius: 1e-05)
    """
    return Form("Punch", radius=field_number(radius, "form.radius", "Punch", "radius"))


def wavy_sphere(radius: Quantity, amplitude: Quantity, wavelength: Quantity) -> Form:
    """Returns a sphere with concentric waves. Radius, amplitude and wavelength are in m.

    >>> asp.wavy_sphere("100 µm", amplitude="10 nm", wavelength="5 µm")
    WavySphere(radius: 0.0001, amplitude: 1e-08, wavelength: 5e-06)
    """
    return Form(
        "WavySphere",
        radius=field_number(radius, "form.radius", "WavySphere", "radius"),
        amplitude=field_number(amplitude, "form.amplitude", "WavySphere", "amplitude"),
        wavelength=field_number(wavelength, "form.wavelength", "WavySphere", "wavelength"),
    )


def rounded_cone(radius: Quantity, angle: Quantity) -> Form:
    """Returns a cone with a rounded apex, such as the tip of an AFM probe.

    `radius` is the radius of curvature of the apex in m, and `angle` the angle between the flank and the surface in rad.
    For a pyramid, give the angle of the cone with the same cross section.

    >>> asp.rounded_cone("20 nm", angle=0.3)
    RoundedCone(radius: 2e-08, angle: 0.3)
    """
    return Form(
        "RoundedCone",
        radius=field_number(radius, "form.radius", "RoundedCone", "radius"),
        angle=field_number(angle, "form.angle", "RoundedCone", "angle"),
    )


def spheres(spheres: Sequence[Quantity | tuple[Quantity, Quantity]]) -> Form:
    """Returns spheres side by side on one probe, each above an equal part of the length of the profile.

    Each sphere is a pair of its radius and the depth of its apex below that of the sphere ahead, both in m. A radius alone is a
    sphere ahead.

    >>> asp.spheres(["100 µm", ("80 µm", "50 nm")])
    Spheres([(radius: 0.0001, behind: 0.0), (radius: 8e-05, behind: 5e-08)])
    """
    if isinstance(spheres, (str, bytes)) or not isinstance(spheres, Sequence):
        raise refused_type("spheres", spheres, "a list of radii, or of pairs of a radius and a distance behind")
    listed = []
    for index, given in enumerate(spheres):
        if isinstance(given, (tuple, list)):
            if len(given) != 2:
                raise refusal(f"spheres[{index}]", given, "a radius, or a pair of a radius and a distance behind")
            radius, behind = given
        else:
            radius, behind = given, 0.0
        listed.append(
            {
                "radius": field_number(radius, "form.0.radius", "Spheres", f"spheres[{index}]"),
                "behind": field_number(behind, "form.0.behind", "Spheres", f"spheres[{index}]"),
            }
        )
    return _checked("form", Form("Spheres", listed))


def table(file: str | os.PathLike[str], unit: str | None = None) -> Form:
    """Returns a body of revolution whose radii and depths are in a file. `unit` is their unit if the file states none.

    `asperity.revolve(radii, depths)` takes two arrays.

    >>> np.savetxt("tip.txt", [[0, 0], [1, 0.1], [2, 0.4]])
    >>> asp.profile("4 µm", 64, form=asp.table("tip.txt", unit="um"))
    <Profile: 64 points on 4 µm, height 800 nm>
    """
    if not isinstance(file, (str, os.PathLike)):
        raise refused_type("file", file, "a path; asperity.revolve(radii, depths) takes arrays")
    return _checked("form", Form("Table", file=Path(path(file, "file")).absolute(), unit=_unit(unit, "unit")))


def revolve(radii: npt.ArrayLike, depths: npt.ArrayLike) -> Form:
    """Returns a body of revolution from two arrays: radii in m that ascend from 0, and the depths in m below the apex there.

    Between the points the depth is a smooth curve. The largest radius is at least half of the length of a profile.

    >>> radii = np.linspace(0, 50e-6, 101)
    >>> asp.profile("100 µm", 1024, form=asp.revolve(radii, radii**2 / 200e-6))   # a sphere with R = 100 µm
    <Profile: 1024 points on 100 µm, height 25 µm>
    """
    distances, below = numbers(radii, "radii"), numbers(depths, "depths")
    if len(distances) < 2 or distances[0] != 0 or not (distances[1:] > distances[:-1]).all():
        raise refusal("radii", distances, "two or more radii in m that ascend from 0")
    if len(below) != len(distances):
        raise refusal("depths", f"{len(below)} depths", f"{len(distances)} depths, one for each radius")
    rows = ";".join(f"{radius!r} {depth!r}" for radius, depth in zip(distances.tolist(), below.tolist(), strict=True))
    return _checked("form", Form("Table", file=Text("data:," + rows)))


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

    >>> rough = asp.self_affine(0.7, rms_height="100 nm", wavelengths=("50 µm", "200 nm"))
    >>> asp.profile("100 µm", 4096, roughness=rough, seed=1)
    <Profile: 4096 points on 100 µm, height ... nm>
    """

    def number(value: Quantity | None, name: str) -> float | None:
        return None if value is None else field_number(value, f"roughness.{name}", "SelfAffine", name)

    first_and_last = None
    if modes is not None:
        first, last = _pair(modes, "modes", "the first and the last number of waves per length")
        first_and_last = (whole(first, "modes", 1, 2**27), whole(last, "modes", 1, 2**27))
    longest_and_shortest = None
    if wavelengths is not None:
        longest, shortest = _pair(wavelengths, "wavelengths", "the longest and the shortest wavelength")
        longest_and_shortest = (number(longest, "wavelengths"), number(shortest, "wavelengths"))
    return Form(
        "SelfAffine",
        hurst=field_number(hurst, "roughness.hurst", "SelfAffine", "hurst"),
        rms_height=number(rms_height, "rms_height"),
        rms_gradient=number(rms_gradient, "rms_gradient"),
        modes=first_and_last,
        wavelengths=longest_and_shortest,
        roll_off=number(roll_off, "roll_off"),
        seed=1,
    )


def spectrum(wave_numbers: npt.ArrayLike, c2d: npt.ArrayLike) -> Spectrum:
    """Returns a measured or computed spectrum of a surface as a roughness.

    `wave_numbers` are q = 2π/λ in rad/m, ascending, and `c2d` is the two-dimensional spectral density C2D in m⁴ at each of them, for
    a map the mean over all directions. It gives the rms height h by h² = (1/2π) ∫ q C2D dq. Between the wave numbers C2D is a power
    law, and beyond them there are no waves: warnings call the longest wavelength the length of the scan. Look at `rms_height`, since programs differ by factors of 2π.

    The spectral density of profiles (C1D in m³) does not give C2D point by point; for heights use `asperity.surface`.

    >>> q = np.geomspace(1e5, 3e7, 50)   # rad/m: wavelengths from 63 µm to 0.2 µm
    >>> rough = asp.spectrum(q, 2.5e-7 * q**-3.6)   # m⁴, for the Hurst exponent 0.8
    >>> rough
    <Spectrum: wave_number 50 values, rms_height ... nm, rms_gradient ...>
    >>> asp.profile("100 µm", 4096, form=asp.sphere("1 mm"), roughness=rough, seed=3)
    <Profile: 4096 points on 100 µm, height ... µm>
    """
    q, densities = numbers(wave_numbers, "wave_numbers").copy(), numbers(c2d, "c2d").copy()
    if len(q) < 2 or q[0] <= 0 or not (q[1:] > q[:-1]).all():
        raise refusal("wave_numbers", q, "two or more wave numbers in rad/m that ascend from above 0")
    if len(densities) != len(q):
        raise refusal("c2d", f"{len(densities)} densities", f"{len(q)} densities in m⁴, one for each wave number")
    with naming("c2d", densities):
        return Spectrum._of(q, densities)


def measured(
    file: AnyPath,
    *,
    further_files: AnyPath | Sequence[AnyPath] = (),
    as_line: bool = False,
    spacing: Quantity | None = None,
    **reading: Unpack[Reading],
) -> Form:
    """Returns the roughness of a measured surface in a file. `further_files` are further measurements of the same surface.

    Profiles are random and have the spectrum of the surface. `spacing` is the distance between points in m if the file states
    none. The options `reading` are those of `docs/surfaces.md`, such as `unit="um"` and `detrend="tilt"`.

    With `as_line=True` the heights of the file are used unchanged. They must be those of an equivalent line, which
    `asperity.Profile` explains. A measured profile is a cut through the surface and no equivalent line.

    >>> np.savetxt("map.txt", np.random.default_rng(1).standard_normal((64, 64)))
    >>> rough = asp.measured("map.txt", unit="nm", spacing="0.1 µm")
    >>> asp.profile("6 µm", 512, form=asp.sphere("1 mm"), roughness=rough)
    <Profile: 512 points on 6 µm, height ... nm>
    """
    others = [further_files] if isinstance(further_files, (str, os.PathLike)) else further_files
    names = [str(Path(path(name, "file")).absolute()) for name in (file, *others)]
    return _measured(names, as_line, spacing, reading)


def _measured(files: Sequence[str], as_line: bool, spacing: Quantity | None, reading: Mapping[str, Any]) -> Form:
    unknown = [name for name in reading if name not in Reading.__annotations__]
    if unknown:
        raise refusal(unknown[0], reading[unknown[0]], f"one of the arguments spacing, {', '.join(Reading.__annotations__)}")
    given = {name: value for name, value in reading.items() if value is not None}
    values: dict[str, Any] = {"file": Text(files[0]), "further_files": [Text(file) for file in files[1:]] or None}
    switches = {"as_line": as_line}
    for name in ("interpolate", "resample", "align_rows", "robust", "periodic"):
        switches[name] = given.get(name, False)
    values.update({name: flag(value, name) or None for name, value in switches.items()})
    for name, length in [("spacing", spacing), ("continue_to", given.get("continue_to"))]:
        if length is not None:
            values[name] = field_number(length, f"roughness.{name}", "Measured", name)
    values["unit"] = _unit(given.get("unit"), "unit")
    values["height_unit"] = _unit(given.get("height_unit"), "height_unit")
    if "opposite" in given:
        values["opposite"] = Text(path(given["opposite"], "opposite"))
    channel = given.get("channel")
    if isinstance(channel, str):
        values["surface_name"] = Text(channel)
    elif channel is not None:
        values["channel"] = whole(channel, "channel", 0, 2**32 - 1)
    if "surface_name" in given:
        values["surface_name"] = Text(text(given["surface_name"], "surface_name", "the name of a surface"))
    for name in ("row", "column"):
        if name in given:
            values[name] = whole(given[name], name, 1, 2**28)
    if "detrend" in given:
        detrend = given["detrend"]
        if not isinstance(detrend, str) or detrend.lower() not in _DETRENDS:
            raise refusal("detrend", detrend, "none, mean, tilt or curvature")
        values["detrend"] = _DETRENDS[detrend.lower()]
    return _checked("roughness", Form("Measured", **values))


def _unit(unit: str | None, field: str) -> Text | None:
    return None if unit is None else Text(text(unit, field, "a unit of length, such as um"))


def _checked(group: str, form: Form) -> Form:
    """Returns a form or a roughness if a scene allows its values. Errors name its arguments."""
    try:
        Scene.parse(_PLAIN).set(in_fields({group: form}))
    except FieldError as error:
        name = error.field.removeprefix(f"{group}.")
        raise refusal(name, error.value, error.allowed or str(error)) from None
    return form


def _pair(values: Any, field: str, allowed: str) -> tuple[Any, Any]:
    try:
        first, second = values
    except (TypeError, ValueError):
        raise refusal(field, values, allowed) from None
    return first, second


def profile(
    length: Quantity,
    points: int | None = None,
    *,
    form: Form | None = None,
    roughness: Form | Surface | Spectrum | tuple[npt.ArrayLike, Quantity] | npt.ArrayLike | None = None,
    seed: int = 1,
) -> Profile:
    """Makes the profile of a body with a form and a roughness, with `points` points along a length in m, by default 16384.

    A `roughness` is made by `self_affine`, `measured` or `spectrum`, or it is a `Surface`, whose spectrum the profile gets. A pair of measured
    heights in m and the distance between their points in m counts as the surface `asperity.surface(heights, spacing=...)`. An
    array alone has the heights in m of the roughness at each point, those of an equivalent line as in `asperity.Profile`. The axis
    of the form is at the point with the index `points // 2`. A seed gives the same random phases on any machine and for any number of points.

    >>> asp.profile("100 µm", form=asp.sphere("100 µm"))
    <Profile: 16384 points on 100 µm, height 25 µm>
    >>> heights = 1e-9 * np.random.default_rng(1).standard_normal((64, 64))   # a measured map in m
    >>> asp.profile("6 µm", 512, form=asp.sphere("1 mm"), roughness=(heights, "0.1 µm"))
    <Profile: 512 points on 6 µm, height ... nm>
    """
    form_allowed = "a form of a body, such as asperity.sphere('1 mm')"
    _check_kind(form, _FORMS, "form", form_allowed)
    if isinstance(roughness, tuple) and len(roughness) == 2 and hasattr(roughness[0], "__len__"):
        measured_heights, distance = roughness
        roughness = _analysed(measured_heights, distance, {}, None, None, {})
        warn_of(roughness._premises())
    heights = None
    if roughness is not None and not isinstance(roughness, (Form, str, Surface, Spectrum)):
        heights = numbers(cast("npt.ArrayLike", roughness), "roughness")
    count = whole(points, "points", 2, 2**28) if points is not None else 16384 if heights is None else len(heights)
    number = whole(seed, "seed", 0, 2**64 - 1)
    metres = field_number(length, "length", "", "length")
    plain = Scene.parse(_PLAIN).set(in_fields({"length": metres, "numerics.points": count, "form": form}))
    if heights is not None:
        if len(heights) != count:
            raise refusal("roughness", f"{len(heights)} heights", f"{count} heights, one for each point")
        with naming("form", form):
            return Profile._of_roughness(plain, heights)
    if isinstance(roughness, (Surface, Spectrum)):
        with naming("roughness", roughness):
            return Profile._of_scene(plain.roughened(roughness._scene, number))
    roughness_allowed = "asperity.self_affine(...), asperity.measured(...), asperity.spectrum(...), a Surface or an array"
    _check_kind(roughness, _ROUGHNESS, "roughness", roughness_allowed)
    if isinstance(roughness, Form) and not roughness.values.get("as_line"):
        roughness = Form(roughness.kind, **{**roughness.values, "seed": number})
    with naming("form" if roughness is None else "roughness", form if roughness is None else roughness):
        return Profile._of_scene(plain.set(in_fields({"roughness": roughness})))


def _check_kind(given: Any, kinds: tuple[str, ...], field: str, allowed: str) -> None:
    if given is None or isinstance(given, str):
        return
    if not isinstance(given, Form):
        raise refused_type(field, given, allowed)
    if given.kind not in kinds:
        raise refusal(field, given, allowed)


def load(
    profile: Profile,
    *,
    modulus: Quantity,
    work: Quantity = 0.0,
    closing_work: Quantity | None = None,
    stages: Stages = "zero force, separation",
    loading_stiffness: Quantity | None = None,
    edges: str = "sub_cell",
    samples: int = 512,
    progress: Progress = None,
) -> Loop:
    """Loads a separated body through loading stages, and returns its force loop.

    `modulus` is the effective modulus E* in Pa. `work` is the work of adhesion in J/m² that opens the interface. `closing_work`
    in J/m² is gained where the interface closes, by default the same. A stage ends at a force (`"10 µN"`, or a number in N), at
    an indentation (`"200 nm"`), or at a displacement of the instrument (`"displacement 200 nm"`). It may also be `"touch"`,
    `"zero force"`, `"separation"`, or `"3 loops 0 N to 10 µN"`: to
    10 µN, and then three times to 0 N and back. With `"hold 10 s"` the instrument rests, which matters to a scene
    whose material relaxes. The instrument has the stiffness `loading_stiffness` in N/m, by
    default infinite. `edges` is `"sub_cell"` for edges of contact patches between springs, or `"grid"` for whole springs. The
    force curve has `samples` points on each stage. The smallest and the largest force do not depend on their number.

    >>> ball = asp.profile("100 µm", form=asp.sphere("100 µm"))
    >>> loop = asp.load(ball, modulus="1 MPa", work="50 mJ/m²", stages="100 µN, separation")
    >>> loop
    <Loop: pull_off_force 23.56 µN, preload 100 µN, dissipated_energy 22.34 pJ>
    >>> bool(loop.force.min() == -loop.pull_off_force)
    True
    """
    if not isinstance(profile, Profile):
        allowed = "a profile that asperity.profile or asperity.Profile makes; asperity.run computes scenes"
        raise refused_type("profile", profile, allowed)
    _check_progress(progress)
    modulus = quantity(modulus, "Pa", "modulus")
    work = quantity(work, "J/m²", "work")
    closing_work = None if closing_work is None else quantity(closing_work, "J/m²", "closing_work")
    if loading_stiffness is not None:
        loading_stiffness = quantity(loading_stiffness, "N/m", "loading_stiffness")
    samples = whole(samples, "samples", 2, 1_000_000)
    if not isinstance(edges, str) or edges not in _EDGES:
        raise refusal("edges", edges, ", ".join(_EDGES))
    stages = _stages(stages)
    if profile._scene is None:
        works = [work if closing_work is None else closing_work, work]
        stiffness = float("inf") if loading_stiffness is None else loading_stiffness
        foundation = (modulus, works, stiffness)
        load = (foundation, (stages, edges == "grid", samples))
        with naming("stages", stages):
            loop = Loop._of(_native.Loop.of_heights(profile._native, load, progress), (profile, load))
        warn_of(loop.warnings)
        return loop
    adhesion = {"work": work} if closing_work is None else {"work": work, "closing_work": closing_work}
    fields = {
        "material": {"modulus": modulus},
        "adhesion": None if work == 0 else adhesion,
        "loading": stages,
        "loading_stiffness": loading_stiffness,
        "numerics.edges": _EDGES[edges],
        "numerics.samples": samples,
    }
    with _by_arguments(_CONTACT):
        body = profile._scene.set(in_fields(fields))
    with naming("stages", stages):
        loop = Loop._of(_native.Loop.of_scene(body, progress), body)
    warn_of(loop.warnings)
    return loop


def run(
    scene: AnyScene,
    /,
    *,
    modulus: Quantity | None = None,
    work: Quantity | None = None,
    closing_work: Quantity | None = None,
    stages: Stages | None = None,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Progress = None,
    **fields: Any,
) -> Outcome:
    """Computes a scene as `asperity run` does: on its own profile, and on `profiles` random profiles, by default 16.

    `jobs` is the number of threads, by default one for each core. No result depends on it. `progress` is called with the number
    of finished profiles and the number of all profiles.

    >>> outcome = asp.run("pressure-sensitive", adhesion__kappa=2, profiles=4, numerics__points=2048)
    >>> outcome
    <Outcome: pull_off_force 448.3 µN, regime pressure-sensitive>
    >>> outcome.ensemble.pull_off_force
    <Statistics: median ... µN, quartiles ... µN to ... µN, count 4>
    """
    fields = _with_contact(fields, modulus, work, closing_work, stages)
    outcome = _outcome(_call(scene, fields, profiles, jobs, progress))
    warn_of(outcome._premises())
    return outcome


def _outcome(call: _Call) -> Outcome:
    with naming("stages", "the loading of the scene"):
        loop = _native.Loop.of_scene(call[0], None)
    return Outcome(call[0], _native.run(call, loop), loop)


def ensemble(
    scene: AnyScene,
    /,
    *,
    modulus: Quantity | None = None,
    work: Quantity | None = None,
    closing_work: Quantity | None = None,
    stages: Stages | None = None,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Progress = None,
    executor: Executor | None = None,
    **fields: Any,
) -> Ensemble:
    """Computes a scene on random profiles, by default 16, and returns their statistics.

    >>> found = asp.ensemble("pressure-sensitive", profiles=4, numerics__points=2048)
    >>> len(found.values("dissipated_energy"))
    4
    >>> found.per_profile.to_pandas().attrs["units"]["dissipated_energy"]
    'J'
    """
    fields = _with_contact(fields, modulus, work, closing_work, stages)
    call = _call(scene, fields, profiles, jobs, progress)
    if executor is None:
        found = Ensemble(_native.ensemble(call))
    else:
        parts = _parts(executor, _native.ensemble_part, call, ())
        found = Ensemble(_native.ensemble_of_parts(call, parts))
    warn_of(found._premises())
    return found


def find(
    field: str,
    scene: AnyScene,
    /,
    where: str,
    *,
    modulus: Quantity | None = None,
    work: Quantity | None = None,
    closing_work: Quantity | None = None,
    stages: Stages | None = None,
    range: tuple[Quantity, Quantity] | str | None = None,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Progress = None,
    **fields: Any,
) -> Found:
    """Finds the value of a field, or of the `preload`, that meets a condition such as `where="F_a/F_a,max = 20 %"`.

    The value is found for each of several random profiles. `range` are its limits, by default a hundredth and a hundred times
    of the value in the scene, and from 0 N for a preload. An equation asks for the smallest value with at least the target. A
    profile that never meets it counts as infinite in median and quartiles.

    >>> found = asp.find("preload", "pressure-sensitive", "F_a/F_a,max = 20 %", profiles=4)
    >>> found
    <Found: F_n = 10.72 µN ... median of 4 profiles.>
    >>> len(found.values)
    4
    """
    fields = _with_contact(fields, modulus, work, closing_work, stages)
    field = text(field, "field", "the path of a number of a scene, or preload")
    where = text(where, "where", "a condition such as 'F_a = 1 µN'")
    searched = None if range is None else ends(range, "range")
    found = Found(_native.find(_call(scene, fields, profiles, jobs, progress), field, where, searched))
    warn_of(found._premises())
    return found


def preloads(
    scene: AnyScene,
    between: tuple[Quantity, Quantity],
    /,
    *,
    modulus: Quantity | None = None,
    work: Quantity | None = None,
    closing_work: Quantity | None = None,
    stages: Stages | None = None,
    count: int = 64,
    log: bool = False,
    profiles: int = 1,
    jobs: int | None = None,
    progress: Progress = None,
    **fields: Any,
) -> Preloads:
    """Computes the pull-off force after each of `count` preloads between two forces in N, with `log` at equal ratios.

    A profile of given heights is allowed, with a modulus: `preloads(profile, (0, "1 µN"), modulus="1 MPa", work="50 mJ/m²")`.

    >>> found = asp.preloads("pressure-sensitive", ("1 µN", "10 µN"), count=4, numerics__points=2048)
    >>> list(found.to_pandas().columns)
    ['seed', 'preload', 'preload_indentation', 'pull_off_force', 'pull_off_indentation', 'dissipated_energy']
    """
    fields = _with_contact(fields, modulus, work, closing_work, stages)
    count = whole(count, "count", 2, 10_000)
    axis = f"{ends(between, 'between', _PRELOADS)}:{count}" + (":log" if flag(log, "log") else "")
    found = Preloads(_native.preloads(_call(scene, fields, profiles, jobs, progress, takes_heights=True), axis))
    warn_of(found._premises())
    return found


def reversals(
    scene: AnyScene,
    between: tuple[Quantity, Quantity] | None = None,
    /,
    *,
    modulus: Quantity | None = None,
    work: Quantity | None = None,
    closing_work: Quantity | None = None,
    stages: Stages | None = None,
    count: int = 64,
    progress: Progress = None,
    **fields: Any,
) -> Reversals:
    """Computes the unloadings of a scene from `count` turning points between two forces in N.

    By default the turning points lie between first touch and the preload of the scene.

    >>> found = asp.reversals("pressure-sensitive", count=16, numerics__points=2048)
    >>> len(found.reversals["pull_off_force"]) == len(found.forces)
    True
    """
    fields = _with_contact(fields, modulus, work, closing_work, stages)
    forces = None if between is None else ends(between, "between", _PRELOADS)
    count = whole(count, "count", 2, 512)
    found = Reversals(_native.reversals(_call(scene, fields, None, None, progress, takes_heights=True), forces, count))
    warn_of(found._premises())
    return found


def reference(
    scene: AnyScene,
    /,
    *,
    modulus: Quantity | None = None,
    work: Quantity | None = None,
    closing_work: Quantity | None = None,
    stages: Stages | None = None,
    grid: int = 64,
    surfaces: int | None = None,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Progress = None,
    **fields: Any,
) -> Reference:
    """Computes a scene in three dimensions on random squares of `grid` × `grid` cells, and on random profiles.

    `surfaces` is the number of squares, by default 24 without and 12 with adhesion.

    >>> found = asp.reference("jkr-sphere", grid=32, surfaces=1, profiles=1, numerics__points=512)
    >>> found.profile_is_exact, round(found.ratio.pull_off_force.value, 1)   # 32 cells are few
    (True, 0.9)
    """
    fields = _with_contact(fields, modulus, work, closing_work, stages)
    cells = whole(grid, "grid", 1, 2**16)
    count = None if surfaces is None else whole(surfaces, "surfaces", 1, 10_000)
    call = _call(scene, fields, profiles, jobs, progress)
    with naming("grid", grid):
        found = Reference(_native.reference(call, cells, count))
    warn_of(found._premises())
    return found


def criteria(
    scene: AnyScene,
    /,
    *,
    modulus: Quantity | None = None,
    work: Quantity | None = None,
    closing_work: Quantity | None = None,
    stages: Stages | None = None,
    **fields: Any,
) -> list[Criterion]:
    """Returns what other theories say of a scene, each with its number, its threshold and its reference.

    >>> [(one.name, one.sticks) for one in asp.criteria("pressure-sensitive", numerics__points=2048)][0]
    ('Persson & Tosatti 2001', False)
    """
    fields = _with_contact(fields, modulus, work, closing_work, stages)
    return _outcome(_call(scene, fields, 1, None, None)).criteria


def study(
    scene: AnyScene,
    axes: Mapping[str, object],
    /,
    *,
    modulus: Quantity | None = None,
    work: Quantity | None = None,
    closing_work: Quantity | None = None,
    stages: Stages | None = None,
    record: Sequence[str] | str = ("pull_off_force", "regime"),
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Progress = None,
    executor: Executor | None = None,
    **fields: Any,
) -> Study:
    """Computes a scene for all combinations of values, such as `{"adhesion.kappa": [2, 6, 20]}`, on random profiles, by default 16.

    An axis is a field, such as `adhesion.kappa`, or `loading.0.0` for the number of the first stage. It may also be `preload`, in
    units of E* h L, `preload_in_N` or `springs_per_wave`. A value is a number in SI units or a text with a unit. `record` names the quantities to record; `docs/studies.md` lists them.
    The fields of a measured roughness in memory are no axes, since its array has no file to be read again.

    >>> axes = {"adhesion.kappa": [1, 4, 16], "roughness.hurst": [0.2, 0.8]}
    >>> study = asp.study("pressure-sensitive", axes, record="adhesion_share", profiles=4, numerics__points=2048)
    >>> frame = study.to_pandas()
    >>> len(frame), frame.attrs["units"]["adhesion_share"]
    (24, '1')
    """
    fields = _with_contact(fields, modulus, work, closing_work, stages)
    if not isinstance(axes, Mapping):
        raise refused_type("axes", axes, "a dictionary of paths and values, such as {'adhesion.kappa': [2, 6, 20]}")
    names = [record] if isinstance(record, str) else _list(record, "record")
    for name in names:
        text(name, "record", "names of quantities")
    call = _call(scene, fields, profiles, jobs, progress, takes_heights=True)
    given = [_axis(name, values) for name, values in axes.items()]
    call = (_stated_by(call[0], given), *call[1:])
    with naming("axes", ", ".join(name for name, _ in given)):
        if executor is None:
            found = Study(_native.study(call, (given, names)))
        else:
            parts = _parts(executor, _native.study_part, call, ((given, names),))
            found = Study(_native.study_of_parts(call, (given, names), parts))
    warn_of(found._premises())
    return found


def _stated_by(scene: Scene, axes: Sequence[tuple[str, Sequence[float | str]]]) -> Scene:
    """Returns a scene whose adhesion is stated by the parameter of an axis or a field, such as κ, in place of another one."""
    for path, values in axes:
        if path not in _ADHESION or not values or _is_stated(scene, path) or _is_stated(scene, "adhesion.closing_work"):
            continue
        if any(_is_stated(scene, other) for other in _ADHESION):
            adhesion = {path.removeprefix("adhesion."): values[0]}
            if _is_stated(scene, "adhesion.range"):
                adhesion["range"] = str(scene.value("adhesion.range"))
            scene = scene.set(in_fields({"adhesion": adhesion}))
    return scene


def _is_stated(scene: Scene, path: str) -> bool:
    return scene.value(path) is not None


def _axis(name: str, values: Any) -> tuple[str, list[float | str]]:
    name = text(name, "axes", "paths of numbers of a scene as keys").replace("__", ".")
    given = [values] if isinstance(values, str) or not hasattr(values, "__iter__") else list(values)
    return name, [value if isinstance(value, str) else quantity(value, "the unit of the path", name) for value in given]


def surface(
    files: AnyPath | Sequence[AnyPath] | npt.ArrayLike,
    /,
    *,
    spacing: Quantity | tuple[Quantity, Quantity] | None = None,
    tip_radius: Quantity | None = None,
    modulus: Quantity | None = None,
    work: Quantity | None = None,
    preload: Quantity | None = None,
    profiles: int | None = None,
    jobs: int | None = None,
    **reading: Unpack[Reading],
) -> Surface:
    """Reads and analyses a measured surface: a file, several files with measurements of the same surface, or an array.

    An array holds the heights of a profile or a map in m. Its masked points and its points of NaN are missing points, which
    `interpolate=True` fills from their neighbours. `spacing` is the distance between the points in m, or for an array the two
    distances along a row and between rows. The options `reading` are those of `docs/surfaces.md`, such as `unit="um"`,
    `detrend="tilt"` and `periodic=True`. `tip_radius` in m gives the reliability cut-off.

    With a `modulus` in Pa and a `work` of adhesion in J/m², the pull-off force of the equivalent line after a `preload` in N, by
    default turned at zero force, is computed on `profiles` random profiles, by default 16 for at most 131 072 springs.

    >>> heights = 1e-9 * np.random.default_rng(1).standard_normal((64, 64))   # m
    >>> surface = asp.surface(heights, spacing="0.1 µm")
    >>> surface.equivalent_line.rms_gradient
    <MomentOfLine: value ..., error ...>
    >>> surface.profile("6 µm", 512, form=asp.sphere("1 mm"), seed=3)
    <Profile: 512 points on 6 µm, height ... nm>
    """
    figures = {"tip_radius": tip_radius, "modulus": modulus, "work": work, "preload": preload}
    found = _analysed(files, spacing, figures, profiles, jobs, reading)
    warn_of(found._premises())
    return found


def _analysed(
    files: AnyPath | Sequence[AnyPath] | npt.ArrayLike,
    spacing: Quantity | tuple[Quantity, Quantity] | None,
    given: Mapping[str, Quantity | None],
    profiles: int | None,
    jobs: int | None,
    reading: Mapping[str, Any],
) -> Surface:
    """Analyses a surface as `surface` does, without warnings."""
    units = {"tip_radius": "m", "modulus": "Pa", "work": "J/m²", "preload": "N"}
    figures = [_positive(given.get(name), unit, name) for name, unit in units.items()]
    for name in ("work", "preload"):
        if given.get(name) is not None and given.get("modulus") is None:
            raise refusal("modulus", None, f"an effective modulus such as '1 MPa', since the argument {name} needs it")
    if profiles is not None and given.get("work") is None:
        raise refusal("work", None, "a work of adhesion such as '50 mJ/m²', since the argument profiles needs it")
    count = None if profiles is None else whole(profiles, "profiles", 2, 1_000_000)
    threads = None if jobs is None else whole(jobs, "jobs", 1, 1024)
    if isinstance(files, bytes):
        raise refused_type("files", files, "the path of a file, paths of files, or an array of heights")
    if isinstance(files, (str, os.PathLike)):
        files = [files]
    if isinstance(files, (list, tuple)) and files and all(isinstance(file, (str, os.PathLike)) for file in files):
        distance = None if spacing is None else quantity(cast("Quantity", spacing), "m", "spacing")
        form = _measured([path(file, "files") for file in files], False, distance, reading)
        with naming("files", files):
            return Surface(*_native.surface(_scene_of(form), figures, count, threads, None))
    for name in ("unit", "height_unit", "channel", "surface_name", "resample"):
        if reading.get(name):
            raise refusal(name, reading.get(name), "nothing for an array, which has heights in m at even distances")
    heights = numbers(cast("npt.ArrayLike", files), "heights", (1, 2), missing=True)
    if spacing is None:
        raise refusal("spacing", None, "the distance between the points of the array, m")
    distances = [spacing, spacing]
    if isinstance(spacing, (tuple, list)):
        distances = list(_pair(spacing, "spacing", "a distance, or the distances along a row and between rows"))
    along, across = (quantity(cast("Quantity", distance), "m", "spacing") for distance in distances)
    if not (1e-18 <= min(along, across) and max(along, across) <= 1e9):
        raise refusal("spacing", spacing, "from 1e-18 to 1e9 m")
    scene = _scene_of(_measured(["array in memory"], False, None, reading))
    map_of_heights = (heights.reshape(-1, heights.shape[-1]), [along, across])
    with naming("heights", f"an array of the shape {heights.shape}"):
        return Surface(*_native.surface(scene, figures, count, threads, map_of_heights))


def _scene_of(roughness: Form) -> Scene:
    return Scene.parse(_PLAIN).set(in_fields({"roughness": roughness}))


def _positive(value: Quantity | None, unit: str, field: str) -> float | None:
    return None if value is None else _above_zero(value, unit, field)


def _above_zero(value: Quantity, unit: str, field: str) -> float:
    number = quantity(value, unit, field)
    if not 0 < number < float("inf"):
        raise refusal(field, value, f"above 0 {unit}".removesuffix(" 1"))
    return number


@overload
def fit(
    curves: _Curve | Sequence[_Curve],
    scene: AnyScene,
    /,
    free: str | Sequence[str] | Mapping[str, tuple[Quantity, Quantity]],
    *,
    modulus: Quantity | None = ...,
    work: Quantity | None = ...,
    closing_work: Quantity | None = ...,
    stages: Stages | None = ...,
    profiles: int,
    jobs: int | None = ...,
    progress: Progress = ...,
    executor: Executor | None = ...,
    options: Mapping[str, Any] | None = ...,
    **fields: Any,
) -> EnsembleFit: ...
@overload
def fit(
    curves: AnyPath | tuple[npt.ArrayLike, npt.ArrayLike] | tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike],
    scene: AnyScene,
    /,
    free: str | Sequence[str] | Mapping[str, tuple[Quantity, Quantity]],
    *,
    modulus: Quantity | None = ...,
    work: Quantity | None = ...,
    closing_work: Quantity | None = ...,
    stages: Stages | None = ...,
    profiles: None = ...,
    jobs: int | None = ...,
    progress: Progress = ...,
    executor: Executor | None = ...,
    options: Mapping[str, Any] | None = ...,
    **fields: Any,
) -> Fit: ...
@overload
def fit(
    curves: list[str]
    | list[Path]
    | list[tuple[npt.NDArray[Any], npt.NDArray[Any]]]
    | list[tuple[npt.NDArray[Any], npt.NDArray[Any], npt.NDArray[Any]]],
    scene: AnyScene,
    /,
    free: str | Sequence[str] | Mapping[str, tuple[Quantity, Quantity]],
    *,
    modulus: Quantity | None = ...,
    work: Quantity | None = ...,
    closing_work: Quantity | None = ...,
    stages: Stages | None = ...,
    profiles: None = ...,
    jobs: int | None = ...,
    progress: Progress = ...,
    executor: Executor | None = ...,
    options: Mapping[str, Any] | None = ...,
    **fields: Any,
) -> Fits: ...
@overload
def fit(
    curves: _Curve | Sequence[_Curve],
    scene: AnyScene,
    /,
    free: str | Sequence[str] | Mapping[str, tuple[Quantity, Quantity]],
    *,
    modulus: Quantity | None = ...,
    work: Quantity | None = ...,
    closing_work: Quantity | None = ...,
    stages: Stages | None = ...,
    profiles: None = ...,
    jobs: int | None = ...,
    progress: Progress = ...,
    executor: Executor | None = ...,
    options: Mapping[str, Any] | None = ...,
    **fields: Any,
) -> Fit | Fits: ...
def fit(
    curves: _Curve | Sequence[_Curve],
    scene: AnyScene,
    /,
    free: str | Sequence[str] | Mapping[str, tuple[Quantity, Quantity]],
    *,
    modulus: Quantity | None = None,
    work: Quantity | None = None,
    closing_work: Quantity | None = None,
    stages: Stages | None = None,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Progress = None,
    executor: Executor | None = None,
    options: Mapping[str, Any] | None = None,
    **fields: Any,
) -> Fit | Fits | EnsembleFit:
    """Fits parameters of a scene to a measured force curve, to each of several curves, or to all curves together.

    A curve is a file, or two arrays with displacements in m and forces in N: a pair, an array of two rows or columns, or a table
    of pandas with two columns. A third array of a tuple has times in s. `"map.txt#3"` is the third curve of a file with several. A list `["map.txt"]` or `["folder"]`
    gives all curves of this file or folder, each with its place. `free` names the parameters to fit: work, closing_work, modulus, offset, zero, stiffness,
    radius, relaxation_share and relaxation_time, and second_radius and behind of the second of several spheres. A dictionary gives their ranges as well:
    `{"work": ("1 mJ/m²", "1 J/m²"), "offset": (-1e-6, 1e-6)}`. With `profiles`, one work of adhesion is found for all curves of a
    rough body, by comparison with so many random profiles. With relaxation, several files or arrays are curves of one specimen,
    such as curves at several speeds, and share all parameters but offset and zero. `options` state how to read the curves, as `asperity fit --help`
    lists them: `{"units": ["nm", "nN"], "noise": "2 nN", "tilt": "remove"}`.

    >>> ball = asp.profile("100 µm", 1024, form=asp.sphere("100 µm"))
    >>> loop = asp.load(ball, modulus="1 MPa", work="50 mJ/m²", stages="100 µN, separation")
    >>> away = np.linspace(-1e-6, 0, 100)   # no contact before and after the loop
    >>> d = np.r_[away[:-1], loop.indentation, loop.indentation[-1] + away[::-1]]
    >>> force = np.r_[0 * away[:-1], loop.force, 0 * away] + 20e-9 * np.random.default_rng(1).standard_normal(len(d))
    >>> fit = asp.fit((d, force), "jkr-sphere", ["work", "offset"], modulus="1 MPa", form__radius="100 µm", numerics__points=512)
    >>> round(fit.work.value, 3), fit.described
    (0.05, True)
    """
    fields = _with_contact(fields, modulus, work, closing_work, stages)
    is_single = _is_curve(curves)
    given: list[Any] = [curves] if is_single else _list(curves, "curves")
    if not given:
        raise refusal("curves", given, "a curve, or a list of at least one curve")
    all_curves = [_curve(number, curve) for number, curve in enumerate(given)]
    named = [name if between is None else f"{name}={ends(between, name)}" for name, between in _ranges(free)]
    if not named:
        raise refusal("free", free, "at least one name of a parameter")
    if options is not None and not isinstance(options, Mapping):
        raise refused_type("options", options, "a dictionary such as {'noise': '2 nN'}")
    for name in options or {}:
        if str(name).replace("-", "_") in _NOT_READING:
            raise refusal("options", name, "options of reading the curves; free, profiles, jobs and fields are arguments of fit")
    count = None if profiles is None else whole(profiles, "profiles", 1, 1_000_000)
    words = [f"--free={name}" for name in named] + in_words({"profiles": count, **(options or {})})
    call = _call(scene, fields, None, jobs, progress, takes_heights=True)
    words += ["curves", "scene"]
    shown = ", ".join(name for name, _ in all_curves)
    if executor is None or is_single or count is not None:
        with naming("curves", shown):
            report = _native.fit(call, (all_curves, is_single), words)
    else:
        check_executor(executor)
        with naming("curves", shown):
            names = _native.curve_names(call, (all_curves, words))
        if len(names) == len(all_curves) > 1 and any(name.startswith("relaxation") for name, _ in _ranges(free)):
            raise refusal("executor", executor, "None, since curves of one specimen that relaxes are fitted together")
        arrays = (curve for curve in all_curves if curve[1] is not None)
        all_curves = [next(arrays) if name is None else (name, None) for name in names]
        several = ranges(len(all_curves))
        tasks = [(_in_process(call, jobs), (all_curves[first:end], words)) for first, end in several]
        parts = gathered(executor, _native.fits_part, tasks, [end - first for first, end in several], progress)
        with naming("curves", shown):
            report = _native.fits_of_parts(call, (all_curves, words), parts)
    found: Fit | Fits | EnsembleFit
    if count is not None:
        found = EnsembleFit(report)
    elif is_single:
        found = Fit(report)
    else:
        found = Fits(report)
    warn_of(found._premises())
    return found


def _columns(curve: Any) -> tuple[Any, ...] | None:
    """Returns the displacements, forces and perhaps times of a curve that is given by numbers; None if it is given otherwise."""
    if hasattr(curve, "to_numpy"):
        curve = curve.to_numpy()
    if isinstance(curve, tuple) and len(curve) in (2, 3) and not any(isinstance(part, (str, os.PathLike)) for part in curve):
        if len(curve) == 2 or all(_is_row_of_numbers(part) for part in curve):
            return curve
    shape = getattr(curve, "shape", None)
    if shape is not None and len(shape) == 2 and 2 in shape:
        rows = curve if shape[0] == 2 else curve.T
        return rows[0], rows[1]
    if isinstance(curve, list) and len(curve) == 2 and all(_is_row_of_numbers(part) for part in curve):
        return curve[0], curve[1]
    return None


def _is_row_of_numbers(part: Any) -> bool:
    if isinstance(part, (str, os.PathLike, bytes)) or not hasattr(part, "__len__") or len(part) == 0:
        return False
    return not any(hasattr(value, "__len__") for value in part)


def _is_curve(curves: Any) -> bool:
    return isinstance(curves, (str, os.PathLike)) or _columns(curves) is not None


def _curve(index: int, curve: Any) -> tuple[str, Any]:
    columns = _columns(curve)
    if columns is not None:
        rows = [numbers(column, name) for column, name in zip(columns, ("displacement", "force", "time"), strict=False)]
        return f"curve {index + 1}", (rows[0], rows[1], rows[2] if len(rows) == 3 else [])
    if isinstance(curve, (str, os.PathLike)):
        return path(curve, "curves"), None
    allowed = "a file, or two arrays with displacements and forces, and perhaps a third with times"
    raise refusal("curves", f"curve {index}, counted from 0, of the type {type(curve).__name__}", allowed)


def _list(values: Any, field: str) -> list[Any]:
    kinds = {"curves": "a file, two arrays, or a list of these", "free": "names, or a dictionary of names and ranges"}
    allowed = kinds.get(field, "a name, or a list of names")
    if isinstance(values, (bytes, Mapping)) or not hasattr(values, "__iter__"):
        raise refused_type(field, values, allowed)
    if hasattr(values, "shape"):
        raise refusal(field, f"a table or an array of the shape {values.shape}", allowed)
    return list(values)


def _ranges(
    free: str | Sequence[str] | Mapping[str, tuple[Quantity, Quantity]],
) -> Sequence[tuple[str, tuple[Quantity, Quantity] | None]]:
    if isinstance(free, Mapping):
        return [(text(name, "free", "names of parameters"), between) for name, between in free.items()]
    names = [free] if isinstance(free, str) else _list(free, "free")
    return [(text(name, "free", "names of parameters"), None) for name in names]


def press(
    heights: npt.ArrayLike,
    /,
    *,
    side: Quantity,
    modulus: Quantity,
    force: Quantity,
    periodic: bool = False,
    residual: float = 1e-8,
) -> Pressed:
    """Presses a rigid square map of heights in m on an elastic half-space in three dimensions, without adhesion.

    The side of the map is in m, the effective modulus in Pa, the force in N. The map has 32, 64, 128 … cells along a side. The
    conditions of contact are violated by at most `residual` rms heights. `pressure` in Pa and `gap` in m of the result are
    maps.

    >>> x = (np.arange(64) + 0.5) / 64 - 0.5
    >>> heights = -np.add.outer(x**2, x**2) / 2   # a sphere with R = 1 m
    >>> pressed = asp.press(heights, side=1, modulus=1, force=0.01)
    >>> pressed.pressure.shape
    (64, 64)
    """
    load = (
        _above_zero(side, "m", "side"),
        _above_zero(modulus, "Pa", "modulus"),
        _above_zero(force, "N", "force"),
    )
    square = numbers(heights, "heights", (2,))
    cells = len(square)
    if square.shape != (cells, cells):
        raise refusal("heights", f"an array of the shape {square.shape}", "a square map")
    with naming("heights", f"an array of the shape {square.shape}"):
        maps, figures = _native.press(square, load, flag(periodic, "periodic"), _above_zero(residual, "1", "residual"))
    pressure, gap = (found.reshape(cells, cells) for found in maps)
    found = dict(zip(["force", "indentation", "area", "residual", "convolutions"], figures, strict=True))
    return Pressed({**found, "convolutions": int(found["convolutions"]), "pressure": pressure, "gap": gap})


def presets() -> list[str]:
    """Returns the names of the built-in scenes.

    >>> "jkr-sphere" in asp.presets()
    True
    """
    return _native.presets()


def _in_process(call: _Call, jobs: int | None) -> _Call:
    """Returns a call as another process gets it: without the function of the progress, and with one thread by default."""
    return call[0], call[1], 1 if jobs is None else jobs, None


def _parts(executor: Executor, task: Callable[..., str], call: _Call, arguments: tuple[Any, ...]) -> list[str]:
    """Computes the random profiles of a call in parts, on an executor."""
    check_executor(executor)
    scene, profiles, jobs, progress = call
    count = _native.profiles_of(scene) if profiles is None else profiles
    several = ranges(count)
    sent = (scene, count, 1 if jobs is None else jobs, None)
    # Without profiles, the task only checks the call, so that an error appears here and not in each process.
    task(sent, *arguments, 0, 0)
    tasks = [(sent, *arguments, first, end) for first, end in several]
    return gathered(executor, task, tasks, [end - first for first, end in several], progress)


def _call(
    given: AnyScene,
    fields: Mapping[str, Any],
    profiles: int | None,
    jobs: int | None,
    progress: Progress,
    takes_heights: bool = False,
) -> _Call:
    profiles = None if profiles is None else whole(profiles, "profiles", 1, 1_000_000)
    jobs = None if jobs is None else whole(jobs, "jobs", 1, 1024)
    _check_progress(progress)
    return _opened(given, fields, takes_heights), profiles, jobs, progress


def _check_progress(progress: Any) -> None:
    if progress is not None and not callable(progress):
        raise refused_type("progress", progress, "a function of two numbers, or None")
