"""Profiles of rigid bodies."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from . import _native
from ._notation import Quantity, numbers, quantity

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


class Profile:
    """Profile of a rigid body: heights in m at equal distances, positive towards the half-space.

    A profile of heights is taken as it is. A profile that `asperity.profile` makes of a form and a roughness knows both in its
    `scene`, and so has a regime and a Tabor number once it is loaded.
    """

    #: Scene with the form and the roughness of the profile; None for a profile of heights.
    scene: _native.Scene | None
    #: Distance between points, m.
    spacing: float
    #: Length of the profile, m.
    length: float

    def __init__(self, heights: npt.ArrayLike, spacing: Quantity) -> None:
        distance = quantity(spacing, "m", "spacing")
        self._take(_native.Profile(numbers(heights, "heights"), distance), None)

    @classmethod
    def _of(cls, native: _native.Profile, scene: _native.Scene | None) -> Profile:
        profile = cls.__new__(cls)
        profile._take(native, scene)
        return profile

    def _take(self, native: _native.Profile, scene: _native.Scene | None) -> None:
        self._native, self.scene = native, scene
        self._points, self.spacing, self.length = native.size()

    @cached_property
    def _columns(self) -> list[npt.NDArray[np.float64]]:
        return self._native.columns()

    @property
    def x(self) -> npt.NDArray[np.float64]:
        """Positions of the points along the profile, m, from 0."""
        return self._columns[0]

    @property
    def heights(self) -> npt.NDArray[np.float64]:
        """Heights, m."""
        return self._columns[1]

    @property
    def gaps(self) -> npt.NDArray[np.float64]:
        """Gaps below the highest point, m."""
        return self._columns[2]

    def __len__(self) -> int:
        return self._points

    def __repr__(self) -> str:
        return f"<Profile of {len(self)} points on {_native.in_words(self.length, 'm')}>"
