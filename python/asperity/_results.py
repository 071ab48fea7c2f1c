"""Results as Python objects. Each attribute is described once, by its type, unit and meaning.

`help`, the annotations, `repr`, tables of notebooks and the page docs/python.md follow from these descriptions.
"""

from __future__ import annotations

import json
import os
from functools import cached_property
from typing import TYPE_CHECKING, Any

from . import _native
from ._attributes import OF_QUANTITY, Attribute, Table, Values, unit_of
from ._errors import naming
from ._loop import Loop
from ._notation import Form, Quantity
from ._notation import path as file_path
from ._notation import refusal
from ._profile import Profile
from ._rows import (
    CurvePoint,
    FittedCurve,
    PreloadResults,
    ProfileResults,
    ProfileSpectrumBin,
    SpectrumBin,
    StudyRecord,
    SurfaceProfileResults,
    TurningPoint,
)

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas as pd
    import xarray as xr



class Statistics(Values):
    """Statistics of one quantity over random profiles."""

    _shown = ("median", "quartiles", "count")

    count = Attribute[int]("1", "number of profiles on which the quantity has a value")
    median = Attribute[float](OF_QUANTITY, "median")
    quartiles = Attribute[tuple[float, float]](OF_QUANTITY, "lower and upper quartile")
    range = Attribute[tuple[float, float]](OF_QUANTITY, "smallest and largest value")
    median_interval = Attribute[tuple[float, float] | None](
        OF_QUANTITY, "95 % interval of the median; None for fewer than 4 values"
    )
    mean = Attribute[float](OF_QUANTITY, "mean")
    standard_deviation = Attribute[float | None](OF_QUANTITY, "sample standard deviation; None for a single value")
    standard_error = Attribute[float | None](OF_QUANTITY, "standard error of the mean; None for a single value")
    confidence_interval = Attribute[tuple[float, float] | None](OF_QUANTITY, "95 % interval of the mean, by Student's t")


class Result(Values):
    """A result of a computation. Its attributes are the keys of the JSON object that the command of the same name prints."""

    warnings = Attribute[list[str]]("", "premises of the model that the result does not meet, one sentence for each")

    def __init__(self, report: _native.Report) -> None:
        self._report = report
        self._unit, self._made = "", {}

    @cached_property
    def _values(self) -> dict[str, Any]:  # type: ignore[override]
        values: dict[str, Any] = json.loads(self._report.write("json"))
        return values

    def __getstate__(self) -> dict[str, Any]:
        state = super().__getstate__()
        state.pop("_values", None)
        return state

    def _premises(self) -> list[str]:
        """Returns the premises of the model that the result does not meet, one sentence for each."""
        return list(self.warnings or [])

    def to_json(self) -> str:
        """Returns the result as JSON text, with the same numbers as `--format json` of the program."""
        return self._report.write("json").decode()

    def to_numpy(self) -> npt.NDArray[np.void]:
        """Returns the table of the result as an array with named fields."""
        import io

        import numpy as np

        table: npt.NDArray[np.void] = np.load(io.BytesIO(self._report.write("npy")))
        return table

    def to_pandas(self) -> pd.DataFrame:
        """Returns the table of the result as a pandas DataFrame, whose `attrs["units"]` has the units of the columns."""
        import pandas as pd

        frame = pd.DataFrame(self.to_numpy())
        frame.attrs["units"] = {name: unit for name in frame.columns if (unit := self._unit_of_column(name))}
        return frame

    def _unit_of_column(self, name: str) -> str:
        return unit_of(name)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the result to a file. Its ending selects the format: json, csv, npy, txt, or svg, png, pdf if notebooks show a figure."""
        name = file_path(path, "path")
        with naming("path", name):
            written = self._report.write(os.path.splitext(name)[1].lstrip(".").lower())
        with open(path, "wb") as file:
            file.write(written)


class Drawn(Result):
    """A result with a figure."""

    def _repr_svg_(self) -> str:
        """Returns the figure for notebooks."""
        return self._report.write("svg").decode()

    def _repr_html_(self) -> str:
        """Returns the figure and the table of attributes for notebooks."""
        return f"{self._repr_svg_()}<details><summary>attributes</summary>{super()._repr_html_()}</details>"


class ProfileStatistics(Values):
    """Results of a scene on several random profiles: statistics of each quantity, and a table with one row for each profile."""

    _shown = ("profiles", "pull_off_force", "regimes")

    profiles = Attribute[int]("1", "number of random profiles")
    pull_off_force = Attribute[Statistics | None]("N", "pull-off force F_a")
    adhesion_share = Attribute[Statistics | None]("1", "pull-off force divided by the ideal pull-off force, F_a/F_a,max")
    first_touch_pull_off_force = Attribute[Statistics | None]("N", "pull-off force F_a(d=0) of a loop that turns at first touch")
    zero_force_pull_off_force = Attribute[Statistics | None]("N", "pull-off force F_a(F=0) of a loop that turns at zero force")
    dissipated_energy = Attribute[Statistics | None]("J", "dissipated energy ΔW")
    regimes = Attribute[dict[str, int]]("1", "number of profiles in each regime that occurs, by F_a(d=0)")
    regimes_after_zero_force = Attribute[dict[str, int]]("1", "number of profiles in each regime that occurs, by F_a(F=0)")
    per_profile = Attribute[Table[ProfileResults]]("", "results of each profile")
    warnings = Attribute[list[str]]("", "premises of the model that profiles do not meet, one sentence for each")

    @property
    def median(self) -> float | None:
        """Median of the pull-off force over the profiles in N."""
        return None if self.pull_off_force is None else self.pull_off_force.median

    @property
    def quartiles(self) -> tuple[float, float] | None:
        """Lower and upper quartile of the pull-off force over the profiles in N."""
        return None if self.pull_off_force is None else self.pull_off_force.quartiles

    def values(self, quantity: str = "pull_off_force") -> npt.NDArray[Any]:
        """Returns the values of a quantity on all profiles, in the order of their seeds; NaN for a profile without a value."""
        if quantity not in self.per_profile.columns:
            raise refusal("quantity", quantity, ", ".join(self.per_profile.columns))
        return self.per_profile[quantity]


class Ensemble(ProfileStatistics, Result):
    """A scene on several random profiles: statistics of each quantity, and a table with one row for each profile."""


class Criterion(Values):
    """What another theory says of a scene."""

    _shown = ("name", "value", "threshold", "sticks")

    name = Attribute[str]("", "name of the theory, or this program")
    symbol = Attribute[str]("", "symbol of the number that is compared with the threshold")
    reference = Attribute[str]("", "publication that states the criterion")
    value = Attribute[float | None]("1", "number that is compared with the threshold; None if the scene does not determine it")
    threshold = Attribute[float]("1", "threshold between bodies that adhere without a preload and bodies that do not")
    sticks = Attribute[bool | None]("", "whether the bodies adhere without a preload; None without a verdict")
    reason = Attribute[str | None]("", "why there is no verdict, or how the number was computed")


class Budget(Values):
    """Relative errors of the pull-off force, by their sources. An error that is not known is None."""

    grid = Attribute[float | None]("1", "error by the finite number of springs, on the profile of the scene")
    steps = Attribute[float | None]("1", "error by the steps in time; None without relaxation")
    sample = Attribute[float | None]("1", "error of the median by the finite number of profiles")
    surface = Attribute[float | None]("1", "error of the median by the uncertainty of a measured spectrum")
    model = Attribute[float | None]("1", "lower bound of the error of the model of one-dimensional profiles")
    largest = Attribute[str | None]("", "name of the largest known error")


class SteepWaves(Values):
    """How steep the waves of a wavy sphere are."""

    ratio = Attribute[float]("1", "λ²/(AR) of the wavelength λ, the amplitude A and the radius R")
    jkr_factor = Attribute[float]("1", "factor by which the waves raise the pull-off force in the theory of JKR")


class ProfileFacts(Values):
    """Facts about the profile of a scene."""

    points = Attribute[int]("1", "number of springs")
    length = Attribute[float]("m", "length of the profile")
    spacing = Attribute[float]("m", "distance between springs")
    rms_height = Attribute[float | None]("m", "rms height h of the roughness")
    rms_gradient = Attribute[float | None]("1", "rms gradient ⟨∇z⟩ of the roughness")
    modes = Attribute[tuple[int, int] | None]("1", "first and last number of waves per length")
    seed = Attribute[int | None]("1", "seed of the random phases")


class Histogram(Values):
    """Numbers of heights in equal ranges."""

    low = Attribute[float]("m", "lower end of the first range")
    high = Attribute[float]("m", "upper end of the last range")
    counts = Attribute[list[int]]("1", "number of heights in each range")


class Outcome(Drawn):
    """A computed scene: forces, energies, regime and force curve, and the statistics over random profiles."""

    _shown = ("pull_off_force", "regime")

    scene = Attribute[dict[str, object]]("", "scene, with the fields of docs/scene-file.md")
    ensemble = Attribute[ProfileStatistics | None]("", "statistics over random profiles; None for one profile")
    profile = Attribute[ProfileFacts]("", "facts about the profile of the scene; `body` has its heights")
    modulus = Attribute[float]("Pa", "effective modulus E*")
    work = Attribute[float | None]("J/m²", "work of adhesion γ")
    kappa = Attribute[float | None]("1", "roughness-adhesion parameter κ")
    elastic_energy = Attribute[float | None]("J/m²", "elastic energy e_el per area that flattens the roughness")
    elastic_energy_ratio = Attribute[float | None]("1", "elastic energy ratio e_el/γ")
    regime = Attribute[str | None]("", "regime of adhesion by F_a(d=0), such as pressure-sensitive")
    regime_after_zero_force = Attribute[str | None]("", "regime of adhesion by F_a(F=0)")
    ideal_pull_off_force = Attribute[float | None]("N", "pull-off force F_a,max of a flat face of the length of the profile")
    smooth_pull_off_force = Attribute[float | None]("N", "pull-off force F_smooth of the body without roughness")
    first_touch_pull_off_force = Attribute[float | None]("N", "pull-off force F_a(d=0) of a loop that turns at first touch")
    zero_force_pull_off_force = Attribute[float | None]("N", "pull-off force F_a(F=0) of a loop that turns at zero force")
    preload = Attribute[float | None]("N", "preload F_n, the largest force before the last unloading")
    preload_indentation = Attribute[float | None]("m", "indentation at the preload")
    pull_off_force = Attribute[float | None]("N", "pull-off force F_a, minus the smallest force of the last unloading")
    pull_off_force_error = Attribute[float | None]("N", "estimated error of F_a by the finite number of springs")
    pull_off_force_near_step = Attribute[bool | None]("", "whether F_a changes much with a small change of the loading")
    curve_error = Attribute[float | None]("1", "estimated relative error of the force curve")
    step_error = Attribute[float | None]("N", "error of each force by the steps in time; None without relaxation")
    adhesion_share = Attribute[float | None]("1", "pull-off force divided by the ideal pull-off force, F_a/F_a,max")
    adhesion_coefficient = Attribute[float | None]("1", "pull-off force divided by the preload, F_a/F_n")
    pull_off_indentation = Attribute[float | None]("m", "indentation at the pull-off")
    dissipated_energy = Attribute[float | None]("J", "dissipated energy ΔW; None unless the loop ends with separated bodies")
    relaxation_energy = Attribute[float | None]("J", "energy that relaxation dissipates; None without relaxation")
    loop_area = Attribute[float | None]("J", "loop area ∮F dD; None without an instrument")
    pull_off_displacement = Attribute[float | None]("m", "displacement of the instrument at the pull-off")
    tabor_number = Attribute[float | None]("1", "Tabor number μ")
    steep_waves = Attribute[SteepWaves | None]("", "how steep the waves of a wavy sphere are")
    criteria = Attribute[list[Criterion]]("", "what other theories say of the scene")
    budget = Attribute[Budget | None]("", "relative errors of F_a, by their sources")
    curve = Attribute[Table[CurvePoint]]("", "force curve; `loop` has it as arrays")
    patches_at_end = Attribute[list[tuple[int, int]]]("1", "first and last spring of each patch at the end of the loading")
    patches_at_stage_ends = Attribute[list[list[tuple[int, int]]] | None](
        "1", "first and last spring of each patch at the end of each stage"
    )
    histogram = Attribute[Histogram | None]("", "numbers of heights in equal ranges")
    counts = Attribute[dict[str, int]]("1", "operations of the computation")
    timings = Attribute[dict[str, float]]("s", "times of the steps of the computation")

    def __init__(self, scene: _native.Scene, report: _native.Report, loop: _native.Loop) -> None:
        super().__init__(report)
        self._loop, self._scene = Loop._of(loop, scene), scene

    @property
    def loop(self) -> Loop:
        """Force loop on the profile of the scene."""
        return self._loop

    @cached_property
    def body(self) -> Profile:
        """Profile of the scene, with its heights."""
        return Profile._of_scene(self._scene)

    def _premises(self) -> list[str]:
        sentences = super()._premises()
        if self.ensemble is not None:
            # The profile of the scene is one of the ensemble, and its warnings are said once.
            known = " ".join(sentences)
            sentences += [sentence for sentence in self.ensemble.warnings if sentence not in known]
        return sentences


class Found(Result):
    """Value of a field that meets a condition: median and quartiles over the profiles."""

    scene = Attribute[dict[str, object]]("", "scene, with the fields of docs/scene-file.md")
    field = Attribute[str]("", "path of the field, or preload")
    unit = Attribute[str]("", "unit of the field")
    quantity = Attribute[str]("", "name of the quantity of the condition")
    target = Attribute[float]("", "wanted value of the quantity, in its SI unit")
    value = Attribute[float | None]("", "answer: median of the value of the field over the profiles, in the unit of the field")
    profiles = Attribute[int]("1", "number of random profiles")
    unreached = Attribute[int]("1", "number of profiles that never meet the condition")
    quartiles = Attribute[tuple[float | None, float | None]]("", "lower and upper quartile of the value of the field")
    range = Attribute[tuple[float, float] | None]("", "smallest and largest value of the field")
    values = Attribute[list[float | None]]("", "value of the field on each profile; None where the condition is never met")
    crossings = Attribute[list[int]]("1", "number of crossings on each profile")
    at_least = Attribute[list[bool]]("", "whether crossings may be missed, for each profile")
    all_crossings = Attribute[list[list[float]]]("", "all crossings on each profile")
    at_first_touch = Attribute[int | None]("1", "number of profiles whose F_a(d=0), after a mere touch, meets the condition")
    reachable = Attribute[tuple[float, float] | None]("", "smallest and largest value of the quantity over all profiles and all tried values")
    searched = Attribute[tuple[float, float]]("", "searched range of the field")
    answer = Attribute[str]("", "answer in words")

    @property
    def median(self) -> float | None:
        """Median of the value of the field over the profiles, the same as `value`."""
        return self.value

    def __repr__(self) -> str:
        return f"<Found: {self.answer}>"


class PreloadStatistics(Values):
    """Statistics of the pull-off force over random profiles, at one preload."""

    preload = Attribute[float]("N", "preload F_n")
    pull_off_force = Attribute[Statistics | None]("N", "pull-off force F_a")


class PreloadsOfProfile(Values):
    """Pull-off force of one profile over the preload."""

    seed = Attribute[int | None]("1", "seed of the random phases")
    preloads = Attribute[Table[PreloadResults]]("", "one row for each preload")


class Preloads(Drawn):
    """Pull-off force over the preload. The table has one row for each preload and profile."""

    scene = Attribute[dict[str, object]]("", "scene, with the fields of docs/scene-file.md")
    mean = Attribute[list[PreloadStatistics] | None]("", "statistics over the profiles, at each preload; None for one profile")
    per_profile = Attribute[list[PreloadsOfProfile]]("", "results of each profile")

    def __repr__(self) -> str:
        preloads = self.per_profile[0].preloads
        forces = [preloads[0].pull_off_force, preloads[-1].pull_off_force]
        if self.mean is not None:
            statistics = [self.mean[0].pull_off_force, self.mean[-1].pull_off_force]
            forces = [None if one is None else one.median for one in statistics]
        words = " to ".join("none" if force is None else _native.in_words(force, "N") for force in forces)
        ends = " to ".join(_native.in_words(row.preload, "N") for row in (preloads[0], preloads[-1]))
        return f"<Preloads: {len(preloads)} preloads from {ends}, pull_off_force {words}, profiles {len(self.per_profile)}>"


class Reversals(Drawn):
    """Unloadings of a scene from many turning points."""

    _shown = ("reversals", "step")

    scene = Attribute[dict[str, object]]("", "scene, with the fields of docs/scene-file.md")
    preloads = Attribute[Table[PreloadResults]](
        "", "pull-off force over the preload, at preloads with equal distances"
    )
    reversals = Attribute[Table[TurningPoint]]("", "one row for each turning point")
    indentations = Attribute[list[float]]("m", "indentations of the map")
    step = Attribute[float]("m", "distance between the indentations")
    forces = Attribute[list[list[float]]]("N", "forces of each unloading at the indentations up to its turning point")
    everett = Attribute[list[list[float | None]]]("N", "Everett function ½ (F(d_r) − F(d_r, d)), in the order of `forces`")


class ModelAtForce(Values):
    """Results of one model at one force of the loading without adhesion."""

    force = Attribute[float]("N", "force F, positive in compression")
    indentation = Attribute[Statistics]("m", "indentation d, 0 at first touch")
    stiffness = Attribute[Statistics]("N/m", "stiffness of the contact, dF/dd")
    contact_area = Attribute[float | None]("m²", "mean area of contact of the squares; None for profiles")
    grid = Attribute[float | None]("1", "relative error by the grid of the squares")


class ModelResults(Values):
    """Results of one model: random profiles, or squares in three dimensions."""

    rms_height = Attribute[float | None]("m", "rms height")
    rms_gradient = Attribute[float | None]("1", "rms gradient")
    elastic_energy = Attribute[float | None]("J/m²", "elastic energy per area that flattens the roughness")
    pull_off_force = Attribute[Statistics | None]("N", "pull-off force")
    first_touch_pull_off_force = Attribute[Statistics | None]("N", "pull-off force of a loop that turns at first touch")
    dissipated_energy = Attribute[Statistics | None]("J", "dissipated energy")
    loading = Attribute[list[ModelAtForce]]("", "indentation, stiffness and contact area at forces of the loading without adhesion")


class Ratio(Values):
    """Mean over profiles divided by the mean over squares in three dimensions."""

    value = Attribute[float]("1", "ratio")
    error = Attribute[float | None]("1", "half width of its 95 % interval")
    grid = Attribute[float | None]("1", "relative error by the grid of the squares")


class RatiosAtForce(Values):
    """Results on profiles divided by those in three dimensions, at one force of the loading without adhesion."""

    force = Attribute[float]("N", "force F, positive in compression")
    indentation = Attribute[Ratio]("1", "ratio of the indentations")
    stiffness = Attribute[Ratio]("1", "ratio of the stiffnesses")
    grid = Attribute[float | None]("1", "relative error by the grid of the squares")


class Ratios(Values):
    """Results on profiles divided by those in three dimensions."""

    pull_off_force = Attribute[Ratio | None]("1", "ratio of the pull-off forces")
    first_touch_pull_off_force = Attribute[Ratio | None]("1", "ratio of the pull-off forces of loops that turn at first touch")
    dissipated_energy = Attribute[Ratio | None]("1", "ratio of the dissipated energies")
    loading = Attribute[list[RatiosAtForce]]("", "ratios of indentation and stiffness at forces of the loading")


class ReferenceBudget(Values):
    """Relative errors of a comparison with three dimensions, by their sources."""

    solver = Attribute[float]("1", "largest error of the gap in rms heights")
    grid = Attribute[float | None]("1", "error by the grid of the squares")
    sample = Attribute[float | None]("1", "error by the finite numbers of profiles and squares")
    difference = Attribute[float | None]("1", "relative difference between profiles and squares")
    model = Attribute[float | None]("1", "lower bound of the error of the model")
    largest = Attribute[str]("", "name of the largest known error")


class ForceLeftOut(Values):
    """A force at which profiles and squares are not compared, since too few cells of the squares touch."""

    force = Attribute[float]("N", "force F, positive in compression")
    cells = Attribute[float]("1", "mean number of cells of a square that touch")
    grid = Attribute[int | None]("1", "number of cells along the side of a square that would be enough; None if it is too large")


class Reference(Drawn):
    """A scene as a profile on springs and in three dimensions."""

    _shown = ("ratio", "surfaces", "profiles", "cells")

    scene = Attribute[dict[str, object]]("", "scene, with the fields of docs/scene-file.md")
    cells = Attribute[int]("1", "number of cells along the side of a square")
    surfaces = Attribute[int]("1", "number of random squares")
    profiles = Attribute[int]("1", "number of random profiles")
    waves = Attribute[tuple[int, int] | None]("1", "longest and shortest wave, in periods per length")
    omitted = Attribute[int | None]("1", "shortest wave of the scene, if the squares do not resolve it")
    compared_loading = Attribute[list[object]]("", "loading that is compared, as stages of a scene")
    preload = Attribute[float]("N", "preload F_n")
    work = Attribute[float | None]("J/m²", "work of adhesion γ")
    profile = Attribute[ModelResults]("", "results on random profiles")
    half_space = Attribute[ModelResults]("", "results in three dimensions")
    adhesive_half_space = Attribute[ModelResults | None]("", "roughness of the squares with adhesion")
    ratio = Attribute[Ratios]("", "results on profiles divided by those in three dimensions")
    left_out = Attribute[list[ForceLeftOut]]("", "forces at which too few cells touch")
    profile_is_exact = Attribute[bool]("", "whether the model of profiles is exact for the body")
    budget = Attribute[ReferenceBudget]("", "relative errors, by their sources")
    convolutions = Attribute[int]("1", "number of convolutions in three dimensions")
    seconds = Attribute[tuple[float, float]]("s", "times of the profiles and of the squares")
    seconds_of_square = Attribute[float]("s", "mean time of a square")

    def __repr__(self) -> str:
        ratio = self.ratio.pull_off_force
        words = "" if ratio is None else f"pull_off_force of profiles / three dimensions {ratio.value:.3g}, "
        return f"<Reference: {words}surfaces {self.surfaces}, profiles {self.profiles}, cells {self.cells}>"


class Study(Result):
    """A scene for all combinations of values, with one record for each combination and each random profile."""

    _shown = ("axes", "profiles", "records")

    scene = Attribute[dict[str, object]]("", "scene, with the fields of docs/scene-file.md")
    axes = Attribute[dict[str, list[float]]]("", "values on each axis, by the path of its field")
    profiles = Attribute[int]("1", "number of random profiles")
    units = Attribute[dict[str, str]]("", "unit of each axis and of each recorded quantity")
    records = Attribute[Table[StudyRecord]](
        "", "one row for each combination and profile: values on the axes, seed and recorded quantities"
    )

    def _read(self, attribute: Attribute[Any]) -> Any:
        if attribute.name == "records":
            return Table(self._values["records"], StudyRecord, self.units)
        return super()._read(attribute)

    def _unit_of_column(self, name: str) -> str:
        return self.units.get(name) or unit_of(name)

    def to_numpy(self) -> npt.NDArray[np.void]:
        """Returns the table of the records as an array with named fields."""
        import numpy as np

        table = super().to_numpy()
        names = table.dtype.names or ()
        if "preload" in names and np.isnan(table["preload"]).all():
            # The loading of the scene has no preload of its own in the table.
            from numpy.lib.recfunctions import drop_fields

            table = drop_fields(table, "preload")
        return table

    def to_xarray(self) -> xr.Dataset:
        """Returns the recorded quantities as an xarray Dataset, over the axes and the profiles, with units in `attrs`."""
        import numpy as np
        import xarray as xr

        table = self.to_numpy()
        columns = table.dtype.names or ()
        # The axes in the order of the cells, in which preloads are the last.
        preloads = [name for name in ("preload", "preload_in_N") if name in self.axes]
        names = [name for name in columns if name in self.axes and name not in preloads] + preloads
        shape = [*(len(self.axes[name]) for name in names), self.profiles]
        coordinates: dict[str, Any] = {name: (name, self.axes[name], {"units": self.units.get(name, "1")}) for name in names}
        if "seed" in columns:
            coordinates["seed"] = ("profile", table["seed"][: self.profiles])
        dataset = xr.Dataset(coords=coordinates, attrs={"title": str(self.scene.get("title", ""))})
        for name in columns:
            # The column of an axis of preloads has another name or unit than the axis.
            if name not in ("cell", "seed", *names) and not (name == "preload" and preloads == ["preload_in_N"]):
                values = np.reshape(table[name], shape)
                dataset[name] = ([*names, "profile"], values, {"units": self._unit_of_column(name)})
        return dataset


class FittedParameter(Values):
    """A fitted parameter with its errors, in the unit of the parameter."""

    _shown = ("value", "low", "high")

    value = Attribute[float](OF_QUANTITY, "value with which the scene describes the curve best")
    low = Attribute[float](OF_QUANTITY, "lower end of the 95 % interval")
    high = Attribute[float](OF_QUANTITY, "upper end of the 95 % interval")
    noise_error = Attribute[float](OF_QUANTITY, "standard error of the value by the noise of the force")
    start = Attribute[float](OF_QUANTITY, "value with which the fit begins")
    range = Attribute[tuple[float, float]](OF_QUANTITY, "range in which the value was searched")
    at_end = Attribute[str | None]("", "end of the range at which the value lies, which is then only a bound: lower or upper")


class _Parameter(Attribute[FittedParameter]):
    """A parameter of a fit as an attribute, which exists only if it was fitted."""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name, self.type = name, FittedParameter
        self.__doc__ = f"FittedParameter, {self.unit}: {self.meaning}; an AttributeError unless it was fitted."


class Agreement(Values):
    """Agreement of a fitted scene with the curve in contact."""

    points = Attribute[int]("1", "number of points in contact")
    residual = Attribute[float]("N", "rms residual without the points at jumps")
    residual_over_largest_force = Attribute[float]("1", "this residual divided by the largest force")
    beyond_one_percent = Attribute[float]("1", "share of points whose residual exceeds 1 % of the largest force")
    at_jumps = Attribute[float]("1", "share of points at jumps")
    off_at_jumps = Attribute[float | None]("m", "largest distance of a point at a jump from the jump of the model")


class CurveFeatures(Values):
    """Features of a measured curve, without the scene."""

    jumps = Attribute[int]("1", "number of jumps of the force")
    jumps_in_one_motion = Attribute[int]("1", "largest number of jumps in one segment")
    hysteresis = Attribute[float | None]("1", "area between loading and unloading divided by the area under the loading")
    fall_in_pause = Attribute[float | None]("1", "largest decrease of the force in a pause divided by the largest force")


class Drag(Values):
    """Force of the drag of a liquid, relative to the force far before contact."""

    pressed = Attribute[float]("N", "force of the drag on the approach")
    pulled = Attribute[float]("N", "force of the drag on the retraction")
    reach = Attribute[float | None]("m", "distance from first touch at which the drag is half as large")


class Correlation(Values):
    """Correlation of the errors of two fitted parameters."""

    first = Attribute[str]("", "name of the first parameter")
    second = Attribute[str]("", "name of the second parameter")
    value = Attribute[float]("1", "correlation of their errors, from -1 to 1")


class Fit(Drawn):
    """A scene fitted to a force curve. Each fitted parameter is an attribute."""

    scene = Attribute[dict[str, object]]("", "scene with the fitted values and the loading of the measurement")
    parameters = Attribute[dict[str, FittedParameter]]("", "fitted parameters by their names")
    work = _Parameter("J/m²", "work of adhesion γ")
    closing_work = _Parameter("J/m²", "work of adhesion γ₁ on closing")
    modulus = _Parameter("Pa", "effective modulus E*")
    offset = _Parameter("m", "displacement at first touch")
    zero = _Parameter("N", "force before contact")
    stiffness = _Parameter("N/m", "stiffness of the instrument")
    radius = _Parameter("m", "radius of the sphere")
    second_radius = _Parameter("m", "radius of the second sphere")
    behind = _Parameter("m", "distance of the apex of the second sphere behind the first one")
    relaxation_share = _Parameter("1", "share of the modulus that relaxes")
    relaxation_time = _Parameter("s", "relaxation time")
    described = Attribute[bool]("", "whether the model describes the curve within its noise")
    description = Attribute[str]("", "how well the model describes the curve")
    reason = Attribute[str | None]("", "why the model does not describe the curve within its noise")
    residual = Attribute[float]("N", "rms residual in contact")
    residual_over_noise = Attribute[float]("1", "this residual divided by the noise")
    beyond_five_sigma = Attribute[float]("1", "share of points whose residual exceeds 5 times the noise")
    misfit = Attribute[float]("1", "robust rms residual divided by the noise; at most 1.5 if the model describes the curve")
    agreement = Attribute[Agreement]("", "agreement with the curve in contact")
    tabor_number = Attribute[float | None]("1", "Tabor number μ with the fitted values")
    correlations = Attribute[list[Correlation]]("1", "correlations of the errors of pairs of parameters")
    not_distinguished = Attribute[list[tuple[str, str]]]("", "pairs of parameters that the curve cannot separate")
    evaluations = Attribute[int]("1", "number of computed curves")
    noise = Attribute[float]("N", "standard deviation of the noise of the force")
    curve = Attribute[CurveFeatures]("", "features of the measured curve")
    drag = Attribute[Drag | None]("", "drag of a liquid, if it was removed")
    drag_work = Attribute[float | None]("J/m²", "work of adhesion that the drag would have added")
    pull_off_force = Attribute[float | None]("N", "pull-off force of the measured curve")
    pull_off_work = Attribute[float | None]("J/m²", "work of adhesion of a smooth sphere with this pull-off force")
    points_used = Attribute[int]("1", "number of points that are used")
    points_left_out = Attribute[int]("1", "number of points that are left out")
    reading = Attribute[list[str]]("", "what was assumed when the curve was read, one sentence for each")

    def _read(self, attribute: Attribute[Any]) -> Any:
        if not isinstance(attribute, _Parameter):
            return super()._read(attribute)
        if attribute.name not in self.parameters:
            raise AttributeError(f"{attribute.name} was not fitted; fitted: {', '.join(self.parameters)}")
        return self.parameters[attribute.name]

    def _in_words(self, attribute: Attribute[Any]) -> str:
        if isinstance(attribute, _Parameter) and attribute.name not in self.parameters:
            return "not fitted"
        return super()._in_words(attribute)

    def __repr__(self) -> str:
        values = (f"{name} {_native.in_words(one.value, unit_of(name))}" for name, one in self.parameters.items())
        return f"<Fit: {', '.join(values)}, described {self.described}>"


class Distribution(Values):
    """Median and quartiles of a parameter over curves."""

    median = Attribute[float](OF_QUANTITY, "median")
    quartiles = Attribute[tuple[float, float]](OF_QUANTITY, "lower and upper quartile")
    curves = Attribute[int]("1", "number of curves")


class Spread(Values):
    """Median and scatter of a quantity over all fitted curves, in its unit."""

    name = Attribute[str]("", "name of the quantity, as a column of the table")
    unit = Attribute[str]("", "unit of the quantity")
    median = Attribute[float]("", "median")
    scatter = Attribute[float | None]("", "1.4826 times the median absolute deviation")
    curves = Attribute[int]("1", "number of curves")


class Fits(Drawn):
    """A scene fitted to each of several force curves. The table has one row for each curve."""

    scene = Attribute[dict[str, object]]("", "scene that is fitted, with the fields of docs/scene-file.md")
    parameter = Attribute[str | None]("", "name of the first fitted parameter")
    described = Attribute[Distribution | None]("", "first parameter over the curves that the model describes")
    all = Attribute[Distribution | None]("", "first parameter over all fitted curves")
    spreads = Attribute[list[Spread]]("", "median and scatter of each quantity over all fitted curves")
    together = Attribute[bool]("", "whether all curves were fitted together, so that they share parameters")
    curves = Attribute[Table[FittedCurve]](
        "", "one row for each curve: values and intervals of the parameters, or the reason why there are none"
    )

    def to_pandas(self) -> pd.DataFrame:
        """Returns one row for each curve: values and intervals of the parameters, or the reason why there are none."""
        return self.curves.to_pandas()

    def __repr__(self) -> str:
        words = ""
        if self.all is not None:
            words = f", median of {self.parameter} {_native.in_words(self.all.median, unit_of(self.parameter or ''))}"
        described = 0 if self.described is None else self.described.curves
        return f"<Fits: {len(self.curves)} curves, {described} described{words}>"


class IntervalEstimate(Values):
    """Estimated value with its 95 % interval."""

    value = Attribute[float](OF_QUANTITY, "median of the probability distribution")
    low = Attribute[float](OF_QUANTITY, "lower end of the 95 % interval")
    high = Attribute[float](OF_QUANTITY, "upper end of the 95 % interval")


class Shares(Values):
    """Sources of the uncertainty of the work of adhesion, as shares of the squared width of its interval."""

    places = Attribute[float]("1", "share by the limited number of curves")
    profiles = Attribute[float]("1", "share by the limited number of random profiles")
    roughness = Attribute[float]("1", "share by the stated errors of the roughness")


class Prospect(Values):
    """Precision of the work of adhesion that a larger number of curves would give."""

    curves = Attribute[int]("1", "number of curves")
    half_width = Attribute[float]("1", "half width of the 95 % interval of ln γ")


class RoughnessEffects(Values):
    """Effects of a wrong roughness of the scene on the fitted values, as derivatives."""

    work_by_height = Attribute[float]("1", "derivative of ln γ by ln h, with the rms height h")
    work_by_hurst = Attribute[float]("1", "derivative of ln γ by the Hurst exponent H")
    modulus_by_height = Attribute[float]("1", "derivative of ln E* by ln h")
    modulus_by_hurst = Attribute[float]("1", "derivative of ln E* by H")


class CurveOfEnsemble(Values):
    """Results of one curve without the others."""

    name = Attribute[str]("", "name of the curve")
    preload = Attribute[float]("N", "preload F_n, the largest force")
    pull_off_force = Attribute[float | None]("N", "pull-off force F_a; None if it is at most 5 times the noise")
    loop_area = Attribute[float]("J", "loop area ∮F dD, the dissipated energy")
    stiffness = Attribute[float]("N/m", "mean stiffness of the retraction from the preload to half of it")
    work = Attribute[IntervalEstimate]("J/m²", "work of adhesion γ by this curve alone")
    at_end_of_table = Attribute[bool]("", "whether the interval ends where curves were computed")
    foreign = Attribute[bool]("", "whether the curve hardly belongs to the same specimen")


class SummaryDeviation(Values):
    """Difference between measured curves and random profiles in one summary, such as the pull-off force."""

    summary = Attribute[str]("", "name of the summary")
    logarithm = Attribute[float]("1", "mean logarithm over the curves minus that over the random profiles")
    deviation = Attribute[float]("1", "this difference divided by its standard error")
    deviates = Attribute[bool]("", "whether the difference is significant")


class EnsembleFit(Drawn):
    """One work of adhesion for all force curves of a rough body, found by comparison with random profiles."""

    _shown = ("work", "modulus", "described")

    work = Attribute[IntervalEstimate]("J/m²", "work of adhesion γ")
    work_at_most = Attribute[float | None]("J/m²", "upper bound of γ, if curves without adhesion would look the same")
    modulus = Attribute[IntervalEstimate]("Pa", "effective modulus E*")
    modulus_is_given = Attribute[bool]("", "whether the scene gives the modulus")
    closing_over_opening = Attribute[float]("1", "γ₁/γ, as the scene states it")
    correlation = Attribute[float]("1", "correlation of the errors of ln γ and ln E*")
    shares = Attribute[Shares]("", "sources of the uncertainty of γ")
    prospects = Attribute[list[Prospect]]("", "precision of γ that more curves would give")
    roughness = Attribute[RoughnessEffects | None]("", "effect of a wrong roughness of the scene on ln γ and ln E*")
    profiles = Attribute[int]("1", "number of random profiles")
    computed = Attribute[int]("1", "number of computed curves")
    preload = Attribute[float]("N", "mean preload of the measured curves")
    preload_scatter = Attribute[float | None]("1", "standard deviation of the preloads divided by their mean")
    curves = Attribute[list[CurveOfEnsemble]]("", "results of each curve without the others")
    scatter_ratio = Attribute[float | None]("1", "scatter of ln γ between curves divided by that between random profiles")
    described = Attribute[bool]("", "whether random profiles with the found values look like the curves")
    deviations = Attribute[list[SummaryDeviation]]("", "differences between curves and random profiles")
    at_end_of_table = Attribute[bool]("", "whether the interval ends where curves were computed")


class ValueWithError(Values):
    """A value with its standard error."""

    value = Attribute[float](OF_QUANTITY, "value")
    error = Attribute[float](OF_QUANTITY, "standard error")


class MomentOfLine(Values):
    """A moment of the equivalent line with its errors."""

    _shown = ("value", "error")

    value = Attribute[float](OF_QUANTITY, "value")
    error = Attribute[float](OF_QUANTITY, "standard error")
    statistical = Attribute[float](OF_QUANTITY, "error by the limited number of waves")
    method = Attribute[float](OF_QUANTITY, "error by the method of estimation")
    missing_short_waves = Attribute[float | None](
        OF_QUANTITY, "change by shorter waves than the points resolve, if there are any"
    )


class EquivalentLine(Values):
    """Moments of the equivalent line of a measured surface."""

    _shown = ("rms_height", "rms_gradient")

    rms_height = Attribute[MomentOfLine]("m", "rms height h")
    rms_gradient = Attribute[MomentOfLine]("1", "rms gradient ⟨∇z⟩")
    energy_per_modulus = Attribute[MomentOfLine]("m", "elastic energy per area divided by the modulus, e_el/E*")
    elastic_energy = Attribute[MomentOfLine | None]("J/m²", "elastic energy e_el per area; None without a modulus")
    kappa = Attribute[MomentOfLine | None]("1", "parameter κ; None without a work of adhesion")
    elastic_energy_ratio = Attribute[MomentOfLine | None]("1", "elastic energy ratio e_el/γ; None without a work of adhesion")


class SurfaceAdhesion(Values):
    """Adhesion of the equivalent line of a measured surface."""

    length = Attribute[float]("m", "length of the profiles")
    springs = Attribute[int]("1", "number of springs of each profile")
    preload = Attribute[float | None]("N", "preload; None for a loop that turns at zero force")
    pull_off_force = Attribute[Statistics | None]("N", "pull-off force F_a over the random profiles")
    fit_deviation = Attribute[float | None]("N", "standard deviation of F_a by the uncertainty of the spectrum")
    regimes = Attribute[dict[str, int]]("1", "number of profiles in each regime that occurs, by F_a(d=0)")
    regimes_after_zero_force = Attribute[dict[str, int]]("1", "number of profiles in each regime that occurs, by F_a(F=0)")
    per_profile = Attribute[Table[SurfaceProfileResults]]("", "results of each profile")


class ProfileSpectrum(Values):
    """Power spectral density of profiles."""

    name = Attribute[str]("", "name of the spectrum")
    bins = Attribute[Table[ProfileSpectrumBin]]("", "one row for each range of wave numbers")


class SurfaceFile(Values):
    """A file of a measured surface. A list has one number for a profile, and two for a map: along a row, then across."""

    file = Attribute[str]("", "path of the file")
    measurement = Attribute[str | None]("", "name of the measurement, if the file has several")
    format = Attribute[str]("", "format of the file")
    points = Attribute[list[int]]("1", "numbers of points")
    lengths = Attribute[list[float]]("m", "lengths")
    cropped = Attribute[list[int]]("1", "sizes of borders without heights that were left out")
    interpolated = Attribute[int]("1", "number of points whose heights were interpolated")


class MeasuredFace(Values):
    """A measured surface: moments of its points and spectra."""

    _shown: tuple[str, ...] = ("points", "rms_height")

    files = Attribute[list[SurfaceFile]]("", "files of the surface")
    points = Attribute[int]("1", "number of measured points")
    rms_height = Attribute[float]("m", "rms height of the points")
    rms_slope = Attribute[float]("1", "rms slope along the rows")
    rms_gradient = Attribute[float | None]("1", "rms gradient; None for profiles")
    skewness = Attribute[float]("1", "skewness of the heights")
    kurtosis = Attribute[float]("1", "kurtosis of the heights, 3 for a normal distribution")
    reliability_cutoff = Attribute[float | None](
        "m", "wavelength below which the tip falsifies the spectrum; None without tip_radius"
    )
    hurst_exponent = Attribute[ValueWithError | None]("1", "Hurst exponent, if the spectrum is a power law")
    roll_off_wave_number = Attribute[ValueWithError | None]("rad/m", "wave number of the roll-off")
    spectrum = Attribute[Table[SpectrumBin]]("", "spectrum of the surface")
    profile_spectra = Attribute[list[ProfileSpectrum]]("", "spectra of profiles along rows and columns")
    ends_inside_scan = Attribute[bool]("", "whether the spectrum ends inside the scan")
    warnings = Attribute[list[str]]("", "doubts about the surface, one sentence for each")


class Surface(MeasuredFace, Drawn):
    """A measured surface: moments with their errors, and spectra. It makes random profiles and scenes with its spectrum."""

    _shown = ("points", "rms_height", "equivalent_line")

    equivalent_line = Attribute[EquivalentLine]("", "moments of the equivalent line")
    adhesion = Attribute[SurfaceAdhesion | None]("", "adhesion; None without a modulus and a work of adhesion")
    opposite = Attribute[MeasuredFace | None]("", "surface of the opposite body")

    def __init__(self, report: _native.Report, scene: _native.Scene, size: tuple[float, int]) -> None:
        super().__init__(report)
        # Scene with the equivalent line, in which length, number of springs and modulus are placeholders.
        self._scene = scene
        # Length in m and number of springs of a scene that is as long as the scan.
        self._size = size

    def profile(self, length: Quantity, points: int = 16384, *, form: Form | None = None, seed: int = 1) -> Profile:
        """Makes a random profile with the measured spectrum, with `points` points along a length in m, on a body with a form."""
        from ._functions import profile

        return profile(length, points, form=form, roughness=self, seed=seed)

    def scene(self, *, modulus: Quantity, work: Quantity | None = None, **fields: Any) -> _native.Scene:
        """Returns a scene of random profiles with the measured spectrum, as long as the scan. It names the files of the surface.

        `modulus` is the effective modulus in Pa, `work` the work of adhesion in J/m². A scene of an array keeps the spectrum in
        memory, so its text cannot be opened again.
        """
        from ._functions import scene

        if modulus is None:
            raise refusal("modulus", modulus, "an effective modulus such as '1 MPa'")
        length, points = self._size
        return scene(self._scene, modulus=modulus, work=work, **{"length": length, "numerics__points": points, **fields})


class Pressed(Values):
    """A rigid map that is pressed on an elastic half-space, without adhesion."""

    _shown = ("force", "indentation", "area")

    force = Attribute[float]("N", "force")
    indentation = Attribute[float]("m", "indentation, 0 at first touch")
    area = Attribute[float]("m²", "area of contact")
    residual = Attribute[float]("1", "largest violation of the conditions of contact in rms heights")
    convolutions = Attribute[int]("1", "number of convolutions")
    pressure = Attribute["npt.NDArray[np.float64]"]("Pa", "map of the pressure")
    gap = Attribute["npt.NDArray[np.float64]"]("m", "map of the gap")
