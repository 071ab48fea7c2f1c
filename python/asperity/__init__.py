"""Adhesion of rough elastic contacts: exact hysteresis loops by the method of dimensionality reduction.

    import asperity as asp

    ball = asp.profile("100 µm", form=asp.sphere("100 µm"))
    loop = asp.load(ball, modulus="1 MPa", work="50 mJ/m²", stages="100 µN, separation")
    loop.pull_off                                     # N, (3/2)πγR by Johnson, Kendall and Roberts

A quantity is a number in SI units, or a text with a unit such as "50 mJ/m²". Compressive forces are positive, and the
indentation is 0 at first touch. Long calls release the global lock of Python (GIL), and Ctrl-C stops them.
"""

from ._errors import FieldError, LoadingError, PremiseWarning
from ._functions import (
    cone,
    criteria,
    ensemble,
    find,
    fit,
    load,
    measured,
    power,
    preloads,
    presets,
    press,
    profile,
    punch,
    reference,
    reversals,
    rounded_cone,
    run,
    scene,
    self_affine,
    sphere,
    study,
    surface,
    table,
    two_spheres,
    wavy_sphere,
)
from ._loop import Loop
from ._native import Scene, __version__
from ._notation import Form, quantity
from ._profile import Profile
from ._results import (
    Drawn,
    Ensemble,
    EnsembleFit,
    Fit,
    Fits,
    Found,
    Outcome,
    Preloads,
    Reference,
    Result,
    Reversals,
    Study,
    Surface,
    Values,
)

__all__ = [
    "Drawn",
    "Ensemble",
    "EnsembleFit",
    "FieldError",
    "Fit",
    "Fits",
    "Form",
    "Found",
    "LoadingError",
    "Loop",
    "Outcome",
    "Preloads",
    "PremiseWarning",
    "Profile",
    "Reference",
    "Result",
    "Reversals",
    "Scene",
    "Study",
    "Surface",
    "Values",
    "cone",
    "criteria",
    "ensemble",
    "find",
    "fit",
    "load",
    "measured",
    "power",
    "preloads",
    "presets",
    "press",
    "profile",
    "punch",
    "quantity",
    "reference",
    "reversals",
    "rounded_cone",
    "run",
    "scene",
    "self_affine",
    "sphere",
    "study",
    "surface",
    "table",
    "two_spheres",
    "wavy_sphere",
]
