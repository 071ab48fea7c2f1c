"""Results of the program as Python objects."""

from __future__ import annotations

import json
import os
from functools import cached_property
from typing import TYPE_CHECKING, Any

from . import _native
from ._loop import Loop
from ._notation import Form, Quantity
from ._notation import path as file_path
from ._profile import Profile

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd


class Values(dict[str, Any]):
    """A dictionary of the values of a JSON object, which are also attributes. A key hides the method of a dictionary."""

    def __getattribute__(self, name: str) -> Any:
        if not name.startswith("__") and dict.__contains__(self, name):
            return dict.__getitem__(self, name)
        return super().__getattribute__(name)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"no {name!r}; allowed: {', '.join(dict.keys(self))}")


class Result:
    """A result of the program. Its attributes are the keys of the JSON object that the command of the same name prints.

    All numbers are in SI units. A number that does not exist for the result is None.
    """

    #: Attributes that `repr` shows, with their units.
    _shown: tuple[tuple[str, str], ...] = ()

    def __init__(self, report: _native.Report) -> None:
        self._report = report
        self._values: Values | None = None

    def to_dict(self) -> Values:
        """Returns the result as a dictionary."""
        if self._values is None:
            self._values = json.loads(self._report.write("json"), object_hook=Values)
        return self._values

    def _premises(self) -> list[str]:
        """Returns the premises of the model that the result does not meet, one sentence for each."""
        values = self.to_dict()
        sentences = list(values.get("warnings") or [])
        ensemble = values.get("ensemble")
        if isinstance(ensemble, Values):
            # The profile of the scene is one of the ensemble, and its warnings are said once.
            known = " ".join(sentences)
            sentences += [sentence for sentence in ensemble.warnings if sentence not in known]
        return sentences

    def __getattr__(self, name: str) -> Any:
        # Asked for by tools that look for methods of their own.
        if name.startswith("_"):
            raise AttributeError(name)
        values = self.to_dict()
        if name not in values:
            raise AttributeError(f"no {name!r}; allowed: {', '.join(dict.keys(values))}")
        return values[name]

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.to_dict()})

    def to_json(self) -> str:
        """Returns the result as JSON text, with the same numbers as `--format json` of the program."""
        return self._report.write("json").decode()

    def to_numpy(self) -> np.ndarray[Any, Any]:
        """Returns the table of the result as an array with named fields."""
        import io

        import numpy as np

        table: np.ndarray[Any, Any] = np.load(io.BytesIO(self._report.write("npy")))
        return table

    def to_pandas(self) -> pd.DataFrame:
        """Returns the table of the result as a pandas DataFrame."""
        import pandas as pd

        return pd.DataFrame(self.to_numpy())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the result to a file. Its ending selects the format: json, csv, npy, txt, or svg, png, pdf for a figure."""
        written = self._report.write(os.path.splitext(file_path(path, "path"))[1].lstrip(".").lower())
        with open(path, "wb") as file:
            file.write(written)

    def __repr__(self) -> str:
        parts = []
        for name, unit in self._shown:
            value = getattr(self, name)
            numbers = value if isinstance(value, list) else [value]
            words = [_native.in_words(one, unit) if isinstance(one, float) else str(one) for one in numbers]
            parts.append(f"{name} {' to '.join(words)}")
        return f"<{type(self).__name__}: {', '.join(parts)}>" if parts else f"<{type(self).__name__}>"


class Drawn(Result):
    """A result with a figure."""

    def _repr_svg_(self) -> str:
        """Returns the figure for notebooks."""
        return self._report.write("svg").decode()


class Outcome(Drawn):
    """A computed scene: forces, energies, regime and force curve, and the statistics over random profiles."""

    _shown = (("pull_off_force", "N"), ("regime", ""))

    #: Force loop on the profile of the scene.
    loop: Loop

    def __init__(self, scene: _native.Scene, report: _native.Report, loop: _native.Loop) -> None:
        super().__init__(report)
        self.loop, self._scene = Loop(loop, scene), scene

    @cached_property
    def profile(self) -> Profile:
        """Profile of the scene."""
        return Profile._of(_native.Profile.of_scene(self._scene), self._scene)


class Ensemble(Result):
    """A scene on several random profiles: statistics of each quantity, and `lines` with one row for each profile."""

    _shown = (("profiles", ""), ("median", "N"), ("quartiles", "N"))

    @property
    def median(self) -> float | None:
        """Median of the pull-off force over the profiles in N."""
        return None if self.pull_off_force is None else float(self.pull_off_force.median)

    @property
    def quartiles(self) -> list[float] | None:
        """Lower and upper quartile of the pull-off force over the profiles in N."""
        return None if self.pull_off_force is None else list(self.pull_off_force.quartiles)

    def values(self, quantity: str = "pull_off_force") -> np.ndarray[Any, Any]:
        """Returns the values of a quantity on all profiles, in the order of their seeds; NaN for a profile without a value."""
        import numpy as np

        return np.array([line[quantity] for line in self.lines], dtype=float)


class Found(Result):
    """Value of a field that meets a condition: median and quartiles over the profiles.

    `value` is the median, `values` has the value on each profile, and `target` is the wanted value of the condition.
    """

    def __repr__(self) -> str:
        return f"<Found: {self.answer}>"


class Preloads(Drawn):
    """Pull-off force over the preload."""


class Reversals(Drawn):
    """Unloadings of a scene from many turning points."""


class Reference(Drawn):
    """A scene as a profile on springs and in three dimensions."""


class Study(Result):
    """A scene for all combinations of values, with one record for each combination and each random profile."""

    _shown = (("profiles", ""),)


class Fit(Drawn):
    """A scene fitted to a force curve. Each fitted parameter is an attribute with `value`, `interval` and other numbers."""

    def __getattr__(self, name: str) -> Any:
        parameters = {} if name.startswith("_") else self.to_dict()["parameters"]
        return parameters[name] if name in parameters else super().__getattr__(name)

    def __repr__(self) -> str:
        return f"<Fit: {', '.join(f'{name} {one.value:.4g}' for name, one in self.parameters.items())}>"


class Fits(Drawn):
    """A scene fitted to each of several force curves. `curves` has one row for each curve."""

    def to_pandas(self) -> pd.DataFrame:
        """Returns one row for each curve: values and intervals of the parameters, or the reason why there are none."""
        import pandas as pd

        return pd.DataFrame(self.curves)


class EnsembleFit(Drawn):
    """One work of adhesion for all force curves of a rough body, found by comparison with random profiles."""


class Surface(Drawn):
    """A measured surface: moments with their errors, and spectra. It makes random profiles and scenes with its spectrum."""

    def __init__(self, surface: _native.Surface) -> None:
        super().__init__(surface.report)
        self._surface = surface

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

        return scene(self._surface.scene(1e6), modulus=modulus, work=work, **fields)
