"""Force loop of a loading."""

from __future__ import annotations

import io
import json
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

from . import _native

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas as pd

    # Profile of given heights, and its loading.
    _Heights: TypeAlias = tuple[_native.Profile, _native._Load]


class Loop:
    """Force loop of a loading that begins with separated bodies. All numbers are in SI units.

    Arrays have one value for each point of the curve, except for `released`. Forces are positive in compression, and the
    indentation is 0 at first touch. A number that does not exist for the loop is None. `kappa`, `tabor`, `regime`, `share` and
    `pull_off_error` need the form and the roughness of the body. They are None for a profile that is given by its heights.
    """

    #: Number of the loading stage of each point, counted from 0, as in `LoadingError.stage` and in tables.
    stage: npt.NDArray[np.int64]
    #: Indentation d in m.
    d: npt.NDArray[np.float64]
    #: Force F in N.
    F: npt.NDArray[np.float64]
    #: Displacement of the instrument D = d + F/k in m, which equals d if the instrument is rigid.
    D: npt.NDArray[np.float64]
    #: Total length of all contact patches in m.
    length: npt.NDArray[np.float64]
    #: Number of contact patches.
    patches: npt.NDArray[np.int64]
    #: Stored elastic energy in J.
    energy: npt.NDArray[np.float64]
    #: Released elastic energy of each loading stage in J. Over a closed loop the sum is the dissipated energy.
    released: npt.NDArray[np.float64]
    #: Pull-off force in N: minus the smallest force of the last unloading.
    pull_off: float | None
    #: Indentation at the pull-off force in m.
    pull_off_d: float | None
    #: Preload in N: largest force between the last separation and the last unloading.
    preload: float | None
    #: Dissipated energy in J; None unless the loop ends with separated bodies.
    dissipated: float | None
    #: Indentation in m and force in N of the points that figures mark: jump-in, preload, pull-off, jump-out.
    jumps: dict[str, tuple[float, float]]
    #: Roughness-adhesion parameter κ; None without roughness or adhesion.
    kappa: float | None
    #: Tabor number μ; None without adhesion or without a radius of curvature.
    tabor: float | None
    #: Regime of adhesion turned at first touch, such as "pressure-sensitive".
    regime: str | None
    #: Pull-off force over the ideal pull-off force, F_a/F_a,max.
    share: float | None
    #: Premises of the model that the loading does not meet, one sentence for each; empty if all hold.
    warnings: list[str]

    def __init__(self, native: _native.Loop, source: _native.Scene | _Heights) -> None:
        self._native, self._source = native, source
        (self.stage, self.patches), columns = native.columns()
        self.d, self.F, self.D, self.length, self.energy, self.released = columns
        figures, self.regime, self.jumps = native.figures()
        self.warnings = native.warnings()
        self.pull_off, self.pull_off_d, self.preload, self.dissipated, self.kappa, self.tabor, self.share = figures

    @cached_property
    def pull_off_error(self) -> float | None:
        """Estimated error of the pull-off force in N by the finite number of springs, computed at the first access."""
        if not isinstance(self._source, _native.Scene):
            return None
        report = _native.run((self._source, 1, None, None), self._native)
        error: float | None = json.loads(report.write("json"))["pull_off_force_error"]
        return error

    @cached_property
    def events(self) -> npt.NDArray[np.void]:
        """Jumps and marks of the loading in the order of the motion, as a structured array with the columns of `run --events`.

        The first access computes the loop once more. `energy` is the elastic energy in J that springs gain (positive) or release
        (negative) at the fixed indentation. Stages, patches and springs are counted from 0. A mark without a jump has NaN there.
        """
        import numpy as np

        if isinstance(self._source, _native.Scene):
            table = _native.Loop.events_of_scene(self._source)
        else:
            table = _native.Loop.events_of_heights(*self._source)
        events: npt.NDArray[np.void] = np.load(io.BytesIO(table))
        return events

    def to_pandas(self) -> pd.DataFrame:
        """Returns the curve as a pandas DataFrame with one row for each point."""
        import pandas as pd

        return pd.DataFrame({name: getattr(self, name) for name in ["stage", "d", "F", "D", "length", "patches", "energy"]})

    def __len__(self) -> int:
        return len(self.d)

    def __repr__(self) -> str:
        figures: list[tuple[str, Any, str]] = [("pull_off", self.pull_off, "N"), ("preload", self.preload, "N")]
        figures.append(("dissipated", self.dissipated, "J"))
        words = (f"{name} {value if value is None else _native.in_words(value, unit)}" for name, value, unit in figures)
        return f"<Loop: {', '.join(words)}>"

    def _repr_svg_(self) -> str:
        return self._native.svg()
