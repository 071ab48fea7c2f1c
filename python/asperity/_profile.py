"""Profiles of rigid bodies."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

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

    def __init__(self, heights: npt.ArrayLike, spacing: Quantity, *, nominal_form: str | None = None) -> None:
        distance = quantity(spacing, "m", "spacing")
        if nominal_form is not None and nominal_form not in ("flat", "curved"):
            raise refusal("nominal_form", nominal_form, "flat, curved or None")
        is_curved = None if nominal_form is None else nominal_form == "curved"
        given = numbers(heights, "heights").copy()
        self._take(_native.Profile(given, distance, is_curved), None, (Profile._of_heights, (given, distance, nominal_form)))

    @staticmethod
    def _of_heights(heights: npt.NDArray[np.float64], spacing: float, nominal_form: str | None) -> Profile:
        return Profile(heights, spacing, nominal_form=nominal_form)

    @classmethod
    def _of_scene(cls, scene: _native.Scene) -> Profile:
        """Returns the profile of a scene, whose modulus is a placeholder."""
        profile = cls.__new__(cls)
        profile._take(_native.Profile.of_scene(scene), scene, (cls._of_scene, (scene,)))
        return profile

    @classmethod
    def _of_roughness(cls, plain: _native.Scene, heights: npt.NDArray[np.float64]) -> Profile:
        """Returns the profile of a scene without roughness, on which these heights are the roughness."""
        profile = cls.__new__(cls)
        given = heights.copy()
        profile._take(_native.Profile.of_roughness(plain, given), None, (cls._of_roughness, (plain, given)))
        return profile

    def _take(self, native: _native.Profile, scene: _native.Scene | None, made: tuple[Any, tuple[Any, ...]]) -> None:
        # The scene has the form and the roughness; None if the heights were given.
        self._native, self._scene = native, scene
        # Function and arguments that make the profile again.
        self._made = made
        self._points, self._spacing, self._length = native.size()

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        return self._made

    @property
    def spacing(self) -> float:
        """Distance between points in m."""
        return self._spacing

    @property
    def length(self) -> float:
        """Length of the profile in m."""
        return self._length

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
        return f"<Profile: {len(self)} points on {_native.in_words(self.length, 'm')}, height {_native.in_words(self._height(), 'm')}>"

    def _height(self) -> float:
        return float(self.gaps.max())

    def _repr_svg_(self) -> str:
        """Returns a figure of the heights for notebooks."""
        import numpy as np

        # As many points as a picture can show; the highest of each group keeps the peaks.
        groups = np.array_split(self.heights, min(len(self), 600))
        tops = np.array([group.max() for group in groups])
        x = np.linspace(0, 600, len(tops))
        y = 150 * (tops.max() - tops) / (np.ptp(self.heights) or 1)
        points = " ".join(f"{a:.1f},{b + 5:.1f}" for a, b in zip(x, y, strict=True))
        return (
            '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 600 180" width="600" role="img">'
            f'<title>{repr(self)[1:-1]}</title><polyline points="{points}" fill="none" stroke="#0072b2"/>'
            f'<text x="0" y="176" font-size="12">{repr(self)[1:-1]}</text></svg>'
        )
