"""Force loop of a loading."""

from __future__ import annotations

import io
import json
import os
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

from . import _native
from ._attributes import Attribute, Table, Values, unit_of
from ._notation import path as file_path
from ._notation import refusal
from ._rows import Event

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas as pd
    from matplotlib.axes import Axes

    from ._profile import Profile

    # Profile of given heights, and its loading.
    _Heights: TypeAlias = tuple[Profile, _native._Load]

#: Columns of the force curve; `time` only if the body relaxes.
_CURVE = ("stage", "time", "indentation", "force", "displacement", "contact_length", "patches", "stored_energy")
_FIGURES = (
    "pull_off_force",
    "pull_off_indentation",
    "preload",
    "dissipated_energy",
    "kappa",
    "tabor_number",
    "adhesion_share",
)


class Loop(Values):
    """Force loop of a loading that begins with separated bodies. All numbers are in SI units.

    Arrays have one value for each point of the curve, except for `released_energy`. At a jump of the contact the
    curve has two points with the same indentation. While a soft instrument jumps, its points have the same displacement. Forces
    are positive in compression, and the indentation is 0 at first touch. A number that does not exist for the loop is None.
    `kappa`, `tabor_number`, `regime`, `adhesion_share` and `pull_off_force_error` need the form and the roughness of the body.
    They are None for a profile that is given by its heights.
    """

    _shown = ("pull_off_force", "preload", "dissipated_energy")

    stage = Attribute["npt.NDArray[np.int64]"]("1", "number of the loading stage of each point, counted from 0")
    indentation = Attribute["npt.NDArray[np.float64]"]("m", "indentation d")
    force = Attribute["npt.NDArray[np.float64]"]("N", "force F")
    displacement = Attribute["npt.NDArray[np.float64]"](
        "m", "displacement D = d + F/k of the instrument, which equals d if the instrument is rigid"
    )
    time = Attribute["npt.NDArray[np.float64] | None"]("s", "time since first touch; None unless the body relaxes")
    contact_length = Attribute["npt.NDArray[np.float64]"]("m", "length of all contact patches, 2a for a sphere")
    patches = Attribute["npt.NDArray[np.int64]"]("1", "number of contact patches")
    stored_energy = Attribute["npt.NDArray[np.float64]"]("J", "elastic energy of the springs")
    released_energy = Attribute["npt.NDArray[np.float64]"](
        "J", "released elastic energy of each stage; over a closed loop the sum is the dissipated energy"
    )
    pull_off_force = Attribute[float | None]("N", "pull-off force F_a, minus the smallest force of the last unloading")
    pull_off_indentation = Attribute[float | None]("m", "indentation at the pull-off")
    preload = Attribute[float | None]("N", "preload F_n, the largest force between the last separation and the last unloading")
    dissipated_energy = Attribute[float | None]("J", "dissipated energy ΔW; None unless the loop ends with separated bodies")
    jumps = Attribute[dict[str, tuple[float, float]]](
        "", "indentation in m and force in N of the marks of figures: jump-in, preload, pull-off, jump-out"
    )
    kappa = Attribute[float | None]("1", "roughness-adhesion parameter κ; None without roughness or adhesion")
    tabor_number = Attribute[float | None]("1", "Tabor number μ; None without adhesion or without a radius of curvature")
    regime = Attribute[str | None]("", "regime of adhesion turned at first touch, such as pressure-sensitive")
    adhesion_share = Attribute[float | None]("1", "pull-off force divided by the ideal pull-off force, F_a/F_a,max")
    warnings = Attribute[list[str]]("", "premises of the model that the loading does not meet, one sentence for each")

    _source: _native.Scene | _Heights

    @classmethod
    def _of(cls, native: _native.Loop, source: _native.Scene | _Heights) -> Loop:
        (stage, patches), (indentation, force, displacement, length, stored, released, time) = native.columns()
        figures, regime, jumps = native.figures()
        values: dict[str, Any] = dict(zip(_FIGURES, figures, strict=True))
        values.update(stage=stage, indentation=indentation, force=force, displacement=displacement, contact_length=length)
        values.update(patches=patches, stored_energy=stored, released_energy=released, time=time if len(time) else None)
        values.update(jumps=jumps, regime=regime, warnings=native.warnings())
        loop = cls(values)
        loop._source, loop._native = source, native
        return loop

    @cached_property
    def _native(self) -> _native.Loop:
        # Only copies of a loop come here. They compute it again if more than its curve is needed.
        if isinstance(self._source, _native.Scene):
            return _native.Loop.of_scene(self._source, None)
        profile, load = self._source
        return _native.Loop.of_heights(profile._native, load, None)

    def __getstate__(self) -> dict[str, Any]:
        return {"_values": self._values, "_source": self._source, "_unit": self._unit, "_made": {}}

    def __setstate__(self, state: dict[str, Any]) -> None:
        for value in state["_values"].values():
            if hasattr(value, "flags"):
                value.flags.writeable = False
        vars(self).update(state)

    @cached_property
    def pull_off_force_error(self) -> float | None:
        """Estimated error of the pull-off force in N by the finite number of springs, computed at the first access."""
        if not isinstance(self._source, _native.Scene):
            return None
        report = _native.run((self._source, 1, None, None), self._native)
        error: float | None = json.loads(report.write("json"))["pull_off_force_error"]
        return error

    @cached_property
    def events(self) -> Table[Event]:
        """Table of the jumps and marks of the loading in the order of the motion, with the columns of `asperity run --events`.

        The first access computes the loop once more. `energy` is the elastic energy in J that springs gain (positive) or release
        (negative) at the fixed indentation. Stages, patches and springs are counted from 0. A mark without a jump has NaN there.
        """
        import numpy as np

        if isinstance(self._source, _native.Scene):
            table = _native.Loop.events_of_scene(self._source)
        else:
            profile, load = self._source
            table = _native.Loop.events_of_heights(profile._native, load)
        events: npt.NDArray[np.void] = np.load(io.BytesIO(table))
        names = events.dtype.names or ()
        rows = [dict(zip(names, event, strict=True)) for event in events.tolist()]
        # A number that does not exist is NaN in the array.
        return Table([{name: None if value != value else value for name, value in row.items()} for row in rows], Event)

    def to_dict(self) -> dict[str, Any]:
        """Returns the values as a dictionary of numbers, texts, lists and dictionaries."""
        return {name: value.tolist() if hasattr(value, "tolist") else value for name, value in self._values.items()}

    def to_json(self) -> str:
        """Returns the loop as JSON text."""
        return json.dumps(self.to_dict(), ensure_ascii=False)

    def _columns(self) -> dict[str, npt.NDArray[Any]]:
        return {name: self._values[name] for name in _CURVE if self._values[name] is not None}

    def to_numpy(self) -> npt.NDArray[np.void]:
        """Returns the curve as an array with named fields."""
        import numpy as np

        columns = self._columns()
        curve = np.empty(len(self), dtype=[(name, column.dtype) for name, column in columns.items()])
        for name, column in columns.items():
            curve[name] = column
        return curve

    def to_pandas(self) -> pd.DataFrame:
        """Returns the curve as a pandas DataFrame with one row for each point, and the units in `attrs["units"]`."""
        import pandas as pd

        columns = self._columns()
        frame = pd.DataFrame(columns)
        frame.attrs["units"] = {name: unit_of(name) for name in columns}
        return frame

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the loop to a file. Its ending selects the format: json, csv or npy for the curve; svg, png, pdf for the figure."""
        name = file_path(path, "path")
        ending = os.path.splitext(name)[1].lstrip(".").lower()
        if ending == "json":
            written = self.to_json().encode()
        elif ending == "csv":
            rows = [",".join(self._columns()), *(",".join(map(repr, row)) for row in self.to_numpy().tolist())]
            written = ("\n".join(rows) + "\n").encode()
        elif ending == "npy":
            import numpy as np

            buffer = io.BytesIO()
            np.save(buffer, self.to_numpy())
            written = buffer.getvalue()
        elif ending in ("svg", "png", "pdf"):
            written = _native.Report.restored({"svg": self._repr_svg_().encode()}).write(ending)
        else:
            raise refusal("path", name, "a name that ends with .json, .csv, .npy, .svg, .png or .pdf")
        with open(path, "wb") as file:
            file.write(written)

    def plot(self, ax: Axes | None = None, **options: Any) -> Axes:
        """Draws force over indentation with matplotlib, and returns the axes. `options` are those of `Axes.plot`.

        Several loops may be drawn on the same axes: `asperity.load(...).plot(ax)`.
        """
        try:
            from matplotlib import pyplot
            from matplotlib.ticker import EngFormatter
        except ImportError:
            raise ImportError("plot needs matplotlib: pip install matplotlib; save('loop.svg') draws without it") from None
        if ax is None:
            ax = pyplot.figure().add_subplot()
        ax.plot(self.indentation, self.force, **options)
        for axis, name, unit in [(ax.xaxis, "indentation", "m"), (ax.yaxis, "force", "N")]:
            axis.set_major_formatter(EngFormatter(unit))
            axis.set_label_text(name)
        return ax

    def __len__(self) -> int:
        return len(self.indentation)

    def _repr_svg_(self) -> str:
        """Returns the figure for notebooks."""
        return self._native.svg()

    def _repr_html_(self) -> str:
        """Returns the figure and the table of attributes for notebooks."""
        return f"{self._repr_svg_()}<details><summary>attributes</summary>{super()._repr_html_()}</details>"
