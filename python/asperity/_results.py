"""Results of the program as objects of Python."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

from . import _native

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd


class Result:
    """A result of the program. Its attributes are the keys of the JSON object that the command of the same name prints.

    All numbers are in SI units. A number that a result does not have is None.
    """

    #: Attributes that `repr` shows, with their units.
    _shown: tuple[tuple[str, str], ...] = ()

    def __init__(self, report: _native.Report) -> None:
        self._report = report
        self._values: dict[str, Any] | None = None

    def to_dict(self) -> dict[str, Any]:
        """The result as a dictionary."""
        if self._values is None:
            self._values = json.loads(self._report.write("json"))
        return self._values

    def __getattr__(self, name: str) -> Any:
        values = {} if name.startswith("_") else self.to_dict()
        if name in values:
            return values[name]
        raise AttributeError(f"{type(self).__name__} has no {name!r}; it has: {', '.join(values)}")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.to_dict()})

    def to_json(self) -> str:
        """The result as JSON, with the numbers that the program prints with `--format json`."""
        return self._report.write("json").decode()

    def to_numpy(self) -> np.ndarray[Any, Any]:
        """The table of the result as an array with named fields."""
        import io

        import numpy as np

        table: np.ndarray[Any, Any] = np.load(io.BytesIO(self._report.write("npy")))
        return table

    def to_pandas(self) -> pd.DataFrame:
        """The table of the result as a table of pandas."""
        import pandas as pd

        return pd.DataFrame(self.to_numpy())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the result to a file; its ending is the format: json, csv, npy, svg, png, pdf or txt."""
        written = self._report.write(os.path.splitext(os.fspath(path))[1].lstrip(".").lower())
        with open(path, "wb") as file:
            file.write(written)

    def __str__(self) -> str:
        return self._report.write("text").decode()

    def __repr__(self) -> str:
        values = ((name, getattr(self, name), unit) for name, unit in self._shown)
        parts = (f"{name} {_native.in_words(value, unit) if isinstance(value, float) else value}" for name, value, unit in values)
        return f"<{type(self).__name__}: {', '.join(parts)}>"

    def _repr_svg_(self) -> str:
        """The figure of the result, for notebooks."""
        return self._report.write("svg").decode()


class Outcome(Result):
    """A computed scene: figures, regime, curve, and the results on its random profiles."""

    _shown = (("adhesion_force", "N"), ("regime", ""))

    #: Profile of the scene.
    profile: _native.Profile
    #: Force loop on that profile.
    loop: _native.Loop

    def __init__(self, report: _native.Report, profile: _native.Profile, loop: _native.Loop) -> None:
        super().__init__(report)
        self.profile = profile
        self.loop = loop


class Ensemble(Result):
    """A scene on several random profiles: statistics of each quantity, and `lines` with a row for each profile."""

    _shown = (("profiles", ""), ("median", "N"), ("quartiles", "N"))

    @property
    def median(self) -> float | None:
        """Median of the adhesion force over the profiles, N."""
        median: float | None = self._of_force("median")
        return median

    @property
    def quartiles(self) -> list[float] | None:
        """Lower and upper quartile of the adhesion force over the profiles, N."""
        quartiles: list[float] | None = self._of_force("quartiles")
        return quartiles

    def values(self, quantity: str = "adhesion_force") -> np.ndarray[Any, Any]:
        """Values of a quantity on all profiles, in the order of their seeds; NaN for a profile that has none."""
        import numpy as np

        return np.array([line[quantity] for line in self.lines], dtype=float)

    def _of_force(self, name: str) -> Any:
        return None if self.adhesion_force is None else self.adhesion_force[name]


class Found(Result):
    """The number of a scene at which a quantity has a value: median and quartiles over the profiles."""

    _shown = (("field", ""), ("median", ""), ("quartiles", ""))


class Preloads(Result):
    """Adhesion force over the preload."""


class Reversals(Result):
    """Unloading of a scene from each of many turning points."""


class Reference(Result):
    """A scene as a line and in three dimensions."""
