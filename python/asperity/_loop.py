"""The force loop of a loading."""

from __future__ import annotations

import json
from functools import cached_property
from typing import TYPE_CHECKING, Any

from . import _native

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas as pd


class Loop:
    """Force loop of a loading that begins separated, in SI units. Arrays have one value for each point of the curve.

    Compression is positive, and the indentation is 0 at first touch. A figure that the loop does not have is None. `kappa`,
    `tabor`, `regime`, `share` and `pull_off_error` need the form and the roughness of the body, which a profile of heights does
    not state: for such a profile they are None.
    """

    #: Index of the loading stage, from 0.
    stage: npt.NDArray[np.int64]
    #: Indentation, m.
    d: npt.NDArray[np.float64]
    #: Force, N.
    F: npt.NDArray[np.float64]
    #: Displacement of the instrument D = d + F/k, m; the indentation if the instrument is rigid.
    D: npt.NDArray[np.float64]
    #: Length in contact, m.
    length: npt.NDArray[np.float64]
    #: Number of contact patches.
    patches: npt.NDArray[np.int64]
    #: Stored elastic energy, J.
    energy: npt.NDArray[np.float64]
    #: Released elastic energy of each stage, J; over a closed loop the sum is the dissipated energy.
    released: npt.NDArray[np.float64]
    #: Pull-off force, N: minus the smallest force of the last unloading.
    pull_off: float | None
    #: Indentation at the pull-off force, m.
    pull_off_d: float | None
    #: Preload, N: largest force while loading, since the last separation and before the last unloading.
    preload: float | None
    #: Dissipated energy, J, of a loop that ends separated.
    dissipated: float | None
    #: Indentation (m) and force (N) of the marked points: jump-in, preload, pull-off, jump-out.
    jumps: dict[str, tuple[float, float]]
    #: Roughness-adhesion parameter κ of a rough body with adhesion.
    kappa: float | None
    #: Tabor number μ of a body with adhesion and a radius of curvature.
    tabor: float | None
    #: Regime of adhesion of a body that was turned at first touch.
    regime: str | None
    #: Pull-off force over that of ideal contact, F_a/F_a,max.
    share: float | None

    def __init__(self, native: _native.Loop, scene: _native.Scene | None = None) -> None:
        self._native, self._scene = native, scene
        (self.stage, self.patches), columns = native.columns()
        self.d, self.F, self.D, self.length, self.energy, self.released = columns
        figures, self.regime, self.jumps = native.figures()
        self.pull_off, self.pull_off_d, self.preload, self.dissipated, self.kappa, self.tabor, self.share = figures

    @cached_property
    def pull_off_error(self) -> float | None:
        """Estimated error of the pull-off force by the number of springs, N, computed when it is first asked for."""
        if self._scene is None:
            return None
        report = _native.run((self._scene, 1, None, None), self._native)
        error: float | None = json.loads(report.write("json"))["adhesion_force_error"]
        return error

    def to_pandas(self) -> pd.DataFrame:
        """The curve as a table of pandas."""
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
