from collections.abc import Callable
from typing import Any, TypeAlias, final

import numpy as np
import numpy.typing as npt

__all__ = [
    "Loop",
    "Profile",
    "Report",
    "Scene",
    "Surface",
    "ensemble",
    "find",
    "fit",
    "in_words",
    "parsed",
    "preloads",
    "presets",
    "press",
    "program",
    "reference",
    "reversals",
    "run",
    "study",
    "__version__",
]

__version__: str

# Number of profiles, number of threads, and the function that receives the progress.
_Call: TypeAlias = tuple[int | None, int | None, Callable[[int, int], object] | None]

@final
class Profile:
    """Profile of given heights or of a scene. Users see it as `asperity.Profile`."""

    def __new__(cls, heights: npt.NDArray[np.float64], spacing: float) -> Profile: ...
    @staticmethod
    def of_scene(scene: Scene) -> Profile: ...
    def columns(self) -> dict[str, npt.NDArray[np.float64]]: ...
    def size(self) -> tuple[int, float, float]: ...

@final
class Loop:
    """Force loop of a profile or of a computed scene. Users see it as `asperity.Loop`."""

    @staticmethod
    def of_heights(
        profile: Profile,
        foundation: tuple[float, list[float], float],
        loading: tuple[str, bool, int],
        progress: Callable[[int, int], object] | None,
    ) -> Loop: ...
    @staticmethod
    def of_body(scene: Scene, progress: Callable[[int, int], object] | None) -> Loop: ...
    def columns(self) -> dict[str, npt.NDArray[Any]]: ...
    def figures(self) -> dict[str, Any]: ...
    def error(self) -> float | None: ...
    def svg(self) -> str: ...

@final
class Scene:
    """A checked scene: material, form, roughness, adhesion and loading of a contact, and settings of its computation."""

    @staticmethod
    def open(name: str) -> Scene: ...
    @staticmethod
    def parse(text: str) -> Scene: ...
    def set(self, fields: list[tuple[str, str]]) -> Scene: ...
    @property
    def text(self) -> str: ...

@final
class Surface:
    """A measured surface after its analysis. It makes profiles and scenes with the measured spectrum."""

    @staticmethod
    def of_files(words: list[str]) -> Surface: ...
    @staticmethod
    def of_heights(heights: npt.NDArray[np.float64], spacing: list[float], words: list[str]) -> Surface: ...
    @property
    def report(self) -> Report: ...
    def profile(self, length: float, points: int, seed: int) -> Profile: ...
    def scene(self, modulus: float, work: float | None) -> Scene: ...

@final
class Report:
    """A result that can be written in the formats of the program, such as JSON."""

    def write(self, format: str) -> bytes: ...

def program(arguments: list[str]) -> int: ...
def parsed(text: str, unit: str, field: str) -> float: ...
def in_words(value: float, unit: str) -> str: ...
def presets() -> list[str]: ...
def run(scene: Scene, call: _Call) -> tuple[Report, Profile, Loop]: ...
def ensemble(scene: Scene, call: _Call) -> Report: ...
def find(scene: Scene, field: str, condition: str, range: str | None, call: _Call) -> Report: ...
def preloads(scene: Scene, preloads: str, call: _Call) -> Report: ...
def reversals(scene: Scene, range: str | None, count: int, call: _Call) -> Report: ...
def reference(scene: Scene, cells: int, maps: int, call: _Call) -> Report: ...
def study(scene: Scene, axes: list[tuple[str, list[float]]], record: list[str], call: _Call) -> Report: ...
def fit(
    curves: list[tuple[str, Any]],
    scene: Scene,
    words: list[str],
    is_single: bool,
    jobs: int | None,
    progress: Callable[[int, int], object] | None,
) -> Report: ...
def press(
    heights: npt.NDArray[np.float64], load: tuple[float, float, float], is_periodic: bool, residual: float
) -> dict[str, Any]: ...
