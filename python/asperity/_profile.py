"""Profiles of rigid bodies."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from . import _native
from ._notation import Quantity, numbers, quantity, refusal

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


class Profile:
    """Profile of a rigid body on springs: heights in m at equal distances, positive towards the half-space.

    Given heights are used unchanged, as those of the equivalent line of the body. The equivalent line is not a cut through the
    body: a sphere of the radius R has the heights −x²/R, while its cut has −x²/(2R). With a cut the pull-off force of a sphere is
    twice too large, and a rough surface loses 29 % of its rms gradient. For heights that are measured along a line or on a map
    use `asperity.surface(heights, spacing=...).profile(...)`; for a sphere, a cone or a table of a body of revolution use
    `asperity.profile(length, form=...)`.

    `nominal_form` is "flat" or "curved": it states that the heights are those of an equivalent line, of a nominally flat body or
    of a body such as a sphere, whose contact must end inside the profile. Without it, a loop has a warning.

    The function `asperity.profile` makes a profile of a form and a roughness. Only a loop of such a profile has a regime and a
    Tabor number.
    """

    #: Distance between points in m.
    spacing: float
    #: Length of the profile in m.
    length: float

    def __init__(self, heights: npt.ArrayLike, spacing: Quantity, *, nominal_form: str | None = None) -> None:
        distance = quantity(spacing, "m", "spacing")
        if nominal_form is not None and nominal_form not in ("flat", "curved"):
            raise refusal("nominal_form", nominal_form, "flat, curved or None")
        is_curved = None if nominal_form is None else nominal_form == "curved"
        self._take(_native.Profile(numbers(heights, "heights"), distance, is_curved), None)

    @classmethod
    def _of(cls, native: _native.Profile, scene: _native.Scene | None) -> Profile:
        profile = cls.__new__(cls)
        profile._take(native, scene)
        return profile

    def _take(self, native: _native.Profile, scene: _native.Scene | None) -> None:
        # A scene with the form and the roughness, and with a placeholder for the modulus; None if the heights were given.
        self._native, self._scene = native, scene
        self._points, self.spacing, self.length = native.size()

    @cached_property
    def _columns(self) -> list[npt.NDArray[np.float64]]:
        return self._native.columns()

    @property
    def x(self) -> npt.NDArray[np.float64]:
        """Positions of the points along the profile in m. The first one is half of the spacing, unless the body is a punch."""
        return self._columns[0]

    @property
    def heights(self) -> npt.NDArray[np.float64]:
        """Heights of the points in m."""
        return self._columns[1]

    @property
    def gaps(self) -> npt.NDArray[np.float64]:
        """Gaps in m: depths of the points below the highest point."""
        return self._columns[2]

    def __len__(self) -> int:
        return self._points

    def __repr__(self) -> str:
        return f"<Profile of {len(self)} points on {_native.in_words(self.length, 'm')}>"
