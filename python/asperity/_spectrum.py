"""Spectra of surfaces that are given as arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import _native
from ._attributes import Attribute, Values

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


class Spectrum(Values):
    """A spectrum of a surface, given by its two-dimensional spectral density. It is the roughness of random profiles."""

    _shown = ("wave_number", "rms_height", "rms_gradient")

    wave_number = Attribute["npt.NDArray[np.float64]"]("rad/m", "wave numbers q = 2π/λ, ascending")
    c2d = Attribute["npt.NDArray[np.float64]"]("m⁴", "two-dimensional spectral density C2D of the surface")
    rms_height = Attribute[float]("m", "rms height h of the surface, from h² = (1/2π) ∫ q C2D dq")
    rms_gradient = Attribute[float]("1", "rms gradient ⟨∇z⟩ of the surface")

    _scene: _native.Scene

    @classmethod
    def _of(cls, wave_number: npt.NDArray[np.float64], c2d: npt.NDArray[np.float64]) -> Spectrum:
        scene, (rms_height, rms_gradient) = _native.Scene.of_spectrum(wave_number, c2d)
        values = {"wave_number": wave_number, "c2d": c2d, "rms_height": rms_height, "rms_gradient": rms_gradient}
        spectrum = cls(values)
        spectrum._scene = scene
        return spectrum
