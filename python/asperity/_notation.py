"""Conversion of Python values to the notation of scene files."""

from __future__ import annotations

import json
import operator
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, SupportsFloat, TypeAlias

from ._errors import FieldError
from ._native import parsed

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

#: A number in SI units, or a text with a unit such as "2.7 MPa".
Quantity: TypeAlias = SupportsFloat | str


class Form:
    """Form or roughness of a body, as functions such as `sphere` and `self_affine` return it."""

    def __init__(self, kind: str, **values: Any) -> None:
        self.kind = kind
        self.values = {name: value for name, value in values.items() if value is not None}

    def __repr__(self) -> str:
        return self.kind + in_scene(self.values)


def in_scene(value: Any) -> str:
    """Returns a value in the notation of a scene file. A text stays unchanged, so it may have a unit."""
    if isinstance(value, str):
        return value
    if value is None or isinstance(value, Form):
        return repr(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, os.PathLike):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, Mapping):
        return "(" + ", ".join(f"{name}: {in_scene(one)}" for name, one in value.items()) + ")"
    if isinstance(value, tuple):
        return "(" + ", ".join(map(in_scene, value)) + ")"
    if isinstance(value, Sequence):
        return "[" + ", ".join(map(in_scene, value)) + "]"
    try:
        return str(operator.index(value))
    except TypeError:
        pass
    try:
        return repr(float(value))
    except (TypeError, ValueError):
        raise TypeError(f"{type(value).__name__}; allowed: a number, a text, a list, a tuple or a dictionary") from None


def refusal(field: str, value: object, allowed: str) -> FieldError:
    """Returns the exception for a value that is not allowed."""
    return FieldError(f"{field} = {value}; allowed: {allowed}", field, str(value), allowed)


def quantity(value: Quantity, unit: str, field: str) -> float:
    """Converts a quantity to a number in the SI unit `unit`: `"2.7 MPa"` is 2.7e6 for `"Pa"`. Errors name the argument `field`."""
    if isinstance(value, str):
        return parsed(value, unit, field)
    try:
        if not isinstance(value, bool):
            return float(value)
    except (TypeError, ValueError):
        pass
    raise TypeError(f"{field}: {type(value).__name__}; allowed: a number in {unit}, or a text with its unit")


def whole(value: Any, field: str, least: int, most: int) -> int:
    """Returns `value` if it is a whole number from `least` to `most`, and otherwise raises a FieldError."""
    try:
        number = operator.index(value)
    except TypeError:
        number = least - 1
    if least <= number <= most:
        return number
    raise refusal(field, value, f"a whole number from {least} to {most}")


def numbers(values: npt.ArrayLike, field: str, dimensions: tuple[int, ...] = (1,)) -> npt.NDArray[np.float64]:
    """Returns an array of finite numbers as contiguous float64. `dimensions` are the allowed numbers of axes."""
    import numpy as np

    words = " or ".join({1: "one-dimensional", 2: "two-dimensional"}[count] for count in dimensions)
    allowed = f"a {words} array of finite real numbers, with at least one"
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise refusal(field, str(error), allowed) from None
    if array.ndim not in dimensions or array.size == 0:
        raise refusal(field, f"an array of the shape {array.shape}", allowed)
    if array.dtype.kind not in "fiu":
        raise refusal(field, f"an array of the type {array.dtype}", allowed)
    found = np.ascontiguousarray(array, np.float64)
    if not np.isfinite(found).all():
        index = np.argwhere(~np.isfinite(found))[0]
        raise refusal(field, f"{found[tuple(index)]} with the index {', '.join(map(str, index))}", allowed)
    return found


def in_fields(fields: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Converts arguments such as `adhesion__work=0.05` to paths of a scene with their values."""
    return [(name.replace("__", "."), in_scene(value)) for name, value in fields.items()]


def in_words(options: Mapping[str, Any]) -> list[str]:
    """Converts arguments such as `tip_radius="10 nm"` to options of the command line. An argument without a value is left out."""
    words = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if value is True:
            words.append(option)
        elif isinstance(value, (list, tuple)):
            words.append(f"{option}={','.join(map(in_scene, value))}")
        elif value is not None and value is not False:
            words.append(f"{option}={value if isinstance(value, os.PathLike) else in_scene(value)}")
    return words
