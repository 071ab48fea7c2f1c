from collections.abc import Callable
from typing import Any, SupportsFloat, final

import numpy as np
import numpy.typing as npt
import pandas as pd

__all__ = [
    "FieldError",
    "LoadingError",
    "Loop",
    "Profile",
    "Report",
    "Scene",
    "ensemble",
    "find",
    "in_words",
    "preloads",
    "presets",
    "program",
    "quantity",
    "reference",
    "reversals",
    "run",
    "whole",
    "__version__",
]

__version__: str

class FieldError(ValueError):
    """A value is out of its range: `field`, `value` and `allowed` state which value, and what is allowed."""

    field: str
    value: str
    allowed: str

class LoadingError(ValueError):
    """The contact does not reach a loading stage.

    `stage` is its number from 1, `smallest_force` the smallest force within reach in N, or None.
    """

    stage: int
    smallest_force: float | None

@final
class Profile:
    """Profile of a rigid body: heights in m at equal distances, positive towards the half-space."""

    def __new__(cls, heights: npt.ArrayLike, spacing: SupportsFloat | str) -> Profile: ...
    @staticmethod
    def of_scene(scene: Scene) -> Profile: ...
    @property
    def scene(self) -> Scene | None: ...
    @property
    def x(self) -> npt.NDArray[np.float64]: ...
    @property
    def heights(self) -> npt.NDArray[np.float64]: ...
    @property
    def gaps(self) -> npt.NDArray[np.float64]: ...
    @property
    def spacing(self) -> float: ...
    @property
    def length(self) -> float: ...
    def __len__(self) -> int: ...

@final
class Loop:
    """Force loop of a loading that begins separated."""

    @staticmethod
    def of_heights(
        profile: Profile,
        modulus: float,
        work: float,
        closing_work: float | None,
        loading: str,
        loading_stiffness: float | None,
        edges: str,
        samples: int,
        progress: Callable[[int, int], object] | None,
    ) -> Loop: ...
    @staticmethod
    def of_body(scene: Scene, progress: Callable[[int, int], object] | None) -> Loop: ...
    @property
    def d(self) -> npt.NDArray[np.float64]: ...
    @property
    def F(self) -> npt.NDArray[np.float64]: ...
    @property
    def D(self) -> npt.NDArray[np.float64]: ...
    @property
    def stage(self) -> npt.NDArray[np.int64]: ...
    @property
    def length(self) -> npt.NDArray[np.float64]: ...
    @property
    def patches(self) -> npt.NDArray[np.int64]: ...
    @property
    def energy(self) -> npt.NDArray[np.float64]: ...
    @property
    def released(self) -> npt.NDArray[np.float64]: ...
    @property
    def pull_off(self) -> float | None: ...
    @property
    def pull_off_d(self) -> float | None: ...
    @property
    def preload(self) -> float | None: ...
    @property
    def dissipated(self) -> float | None: ...
    @property
    def jumps(self) -> dict[str, tuple[float, float]]: ...
    @property
    def kappa(self) -> float | None: ...
    @property
    def tabor(self) -> float | None: ...
    @property
    def regime(self) -> str | None: ...
    @property
    def share(self) -> float | None: ...
    @property
    def pull_off_error(self) -> float | None: ...
    def to_pandas(self) -> pd.DataFrame: ...
    def _repr_svg_(self) -> str: ...
    def __len__(self) -> int: ...

@final
class Scene:
    """A checked scene: one problem with material, profile, adhesion, loading and numerics."""

    @staticmethod
    def open(name: str) -> Scene: ...
    @staticmethod
    def parse(text: str) -> Scene: ...
    def set(self, fields: list[tuple[str, str]]) -> Scene: ...
    @property
    def text(self) -> str: ...

@final
class Report:
    """A result in the formats of the program."""

    def write(self, format: str) -> bytes: ...

def program(arguments: list[str]) -> int: ...
def quantity(value: SupportsFloat | str, unit: str, field: str) -> float: ...
def whole(value: Any, field: str, least: int, most: int) -> int: ...
def in_words(value: float, unit: str) -> str: ...
def presets() -> list[tuple[str, str]]: ...
def run(
    scene: Scene,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> tuple[Report, Profile, Loop]: ...
def ensemble(
    scene: Scene,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Report: ...
def find(
    scene: Scene,
    field: str,
    condition: str,
    range: str | None = None,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Report: ...
def preloads(
    scene: Scene,
    preloads: str,
    profiles: int = 1,
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Report: ...
def reversals(
    scene: Scene,
    range: str | None = None,
    count: int = 64,
    progress: Callable[[int, int], object] | None = None,
) -> Report: ...
def reference(
    scene: Scene,
    grid: int = 64,
    maps: int = 24,
    profiles: int | None = None,
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Report: ...
