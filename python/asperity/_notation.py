"""Conversion of Python values to numbers, texts and the notation of scene files."""

from __future__ import annotations

import operator
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, SupportsFloat, TypeAlias

from . import _native
from ._errors import FieldError

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

#: A number in SI units, or a text with a unit such as "2.7 MPa".
Quantity: TypeAlias = SupportsFloat | str


#: Largest number of characters with which a form is shown.
_LONGEST_FORM = 200


class Text(str):
    """A text that a scene file has in quotes. All other texts are written as they are, since they may be quantities."""


class Form:
    """Form or roughness of a body, as functions such as `sphere` and `self_affine` return it."""

    def __init__(self, kind: str, *elements: Any, **values: Any) -> None:
        self.kind = kind
        self.elements = elements
        self.values = {name: value for name, value in values.items() if value is not None}

    def notation(self) -> str:
        """Returns the form or roughness as a scene file has it."""
        return self.kind + in_scene(self.elements or self.values, "values")

    def __repr__(self) -> str:
        text = self.notation()
        return text if len(text) <= _LONGEST_FORM else f"{text[:_LONGEST_FORM]}…"


def described(value: object) -> str:
    """Returns a value in words for a message, escaped and shortened."""
    try:
        text = str(value)
    except Exception:  # A whole number of more than 4300 digits, or an object without a text.
        text = f"a value of the type {type(value).__name__}"
    return _native.shown(text)


def refusal(field: str, value: object, allowed: str) -> FieldError:
    """Returns the exception for a value that is not allowed."""
    try:
        given = str(value)
    except Exception:
        given = described(value)
    return FieldError(f"{_native.shown(field)} = {described(value)}; allowed: {allowed}", field, given, allowed)


def refused_type(field: str, value: object, allowed: str) -> FieldError:
    """Returns the exception for a value of a type that is not allowed."""
    return refusal(field, f"an object of the type {type(value).__name__}", allowed)


def in_scene(value: Any, field: str) -> str:
    """Returns a value in the notation of a scene file. A text stays unchanged, so it may have a unit. Errors name the field."""
    if isinstance(value, Text):
        return quoted(value)
    if isinstance(value, str):
        return value
    if isinstance(value, Form):
        return value.notation()
    if value is None:
        return "None"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, os.PathLike):
        return quoted(path(value, field))
    if isinstance(value, Mapping):
        return "(" + ", ".join(f"{name}: {in_scene(entry, field)}" for name, entry in value.items()) + ")"
    if isinstance(value, tuple):
        return "(" + ", ".join(in_scene(entry, field) for entry in value) + ")"
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return "[" + ", ".join(in_scene(entry, field) for entry in value) + "]"
    try:
        number = operator.index(value)
        return str(number) if abs(number) < 2**64 else repr(float(number))
    except TypeError:
        pass
    except OverflowError:
        raise refusal(field, value, "a number below 1.8e308") from None
    try:
        return repr(float(value))
    except (TypeError, ValueError):
        raise refused_type(field, value, "a number, a text, a list, a tuple or a dictionary") from None


def quoted(value: str) -> str:
    """Returns a text in quotes, as a scene file has it."""
    escaped = []
    for sign in value:
        if sign in ('"', "\\"):
            escaped.append("\\" + sign)
        elif ord(sign) < 32 or ord(sign) == 127:
            escaped.append(f"\\u{{{ord(sign):x}}}")
        else:
            escaped.append(sign)
    return '"' + "".join(escaped) + '"'


def quantity(value: Quantity, unit: str, field: str) -> float:
    """Converts a quantity to a number in the SI unit `unit`: `"2.7 MPa"` is 2.7e6 for `"Pa"`. Errors name the argument `field`."""
    if isinstance(value, str):
        return _native.parsed(value, unit, field)
    allowed = f"a number in {unit}, or a text with its unit"
    try:
        if not isinstance(value, (bool, bytes, bytearray)):
            return float(value)
    except OverflowError:
        raise refusal(field, value, "a number below 1.8e308") from None
    except (TypeError, ValueError):
        pass
    raise refused_type(field, value, allowed)


def field_number(value: Quantity, path: str, variant: str, field: str) -> float:
    """Converts a quantity to the number at a path of a scene, in the unit of the path, and checks its range."""
    return _native.in_field(quantity(value, _native.unit_of(path, variant), field), path, variant, field)


def whole(value: Any, field: str, least: int, most: int) -> int:
    """Returns `value` if it is a whole number from `least` to `most`, and otherwise raises a FieldError."""
    try:
        number = least - 1 if isinstance(value, bool) else operator.index(value)
    except TypeError:
        number = least - 1
    if least <= number <= most:
        return number
    raise refusal(field, value, f"a whole number from {least} to {most}")


def flag(value: Any, field: str) -> bool:
    """Returns `value` if it is true or false, also as a value of NumPy."""
    if isinstance(value, bool) or type(value).__name__ == "bool":
        return bool(value)
    raise refusal(field, value, "True or False")


def text(value: Any, field: str, allowed: str) -> str:
    """Returns `value` if it is a text."""
    if isinstance(value, str):
        return str(value)
    raise refused_type(field, value, allowed)


def path(value: Any, field: str) -> str:
    """Returns the path of a file as a text."""
    found = os.fspath(value) if isinstance(value, (str, os.PathLike)) else None
    if isinstance(found, str):
        return found
    raise refused_type(field, value, "the path of a file, as a text or a pathlib.Path")


def numbers(
    values: npt.ArrayLike, field: str, dimensions: tuple[int, ...] = (1,), missing: bool = False
) -> npt.NDArray[np.float64]:
    """Returns an array of finite numbers as contiguous float64. `dimensions` are the allowed numbers of axes.

    If `missing` is true, masked points and points of NaN are missing points, which are NaN in the result. Otherwise they are refused.
    """
    import numpy as np

    words = " or ".join({1: "one-dimensional", 2: "two-dimensional"}[count] for count in dimensions)
    kind = "real numbers, or NaN for missing points" if missing else "finite real numbers"
    allowed = f"a {words} array of {kind}, with at least one"
    try:
        array = np.ma.asarray(values) if isinstance(values, np.ma.MaskedArray) else np.asarray(values)
    except ValueError:
        raise refusal(field, "rows of different lengths", allowed) from None
    if array.ndim not in dimensions or array.size == 0:
        raise refusal(field, f"an array of the shape {array.shape}", allowed)
    if array.dtype.kind not in "fiu":
        raise refusal(field, f"an array of the type {array.dtype}", allowed)
    if np.ma.is_masked(array):
        count = int(np.ma.getmaskarray(array).sum())
        if not missing:
            raise refusal(field, f"an array with {count} masked points", allowed)
        array = np.ma.filled(array.astype(np.float64), np.nan)
    found = np.ascontiguousarray(np.ma.getdata(array), np.float64)
    is_wrong = np.isinf(found) if missing else ~np.isfinite(found)
    if is_wrong.any():
        index = np.argwhere(is_wrong)[0]
        raise refusal(field, f"{found[tuple(index)]} with the index {', '.join(map(str, index))}", allowed)
    return found


def in_fields(fields: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Converts arguments such as `adhesion__work=0.05` to paths of a scene with their values."""
    paths = ((name.replace("__", "."), value) for name, value in fields.items())
    return [(path, in_scene(value, path)) for path, value in paths]


def in_words(options: Mapping[str, Any]) -> list[str]:
    """Converts entries such as `"noise": "2 nN"` to options of the command line. An entry without a value is left out."""
    words = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if value is True:
            words.append(option)
        elif isinstance(value, (list, tuple)):
            words.append(f"{option}={','.join(in_scene(entry, name) for entry in value)}")
        elif value is not None and value is not False:
            words.append(f"{option}={path(value, name) if isinstance(value, os.PathLike) else in_scene(value, name)}")
    return words


def ends(between: Any, field: str, allowed: str = "two values, the smaller one first") -> str:
    """Returns two numbers as the text of a range, the smaller one first. A text such as `"1 µN..20 µN"` stays unchanged."""
    if isinstance(between, str):
        return between
    try:
        given = list(between)
    except TypeError:
        raise refused_type(field, between, allowed) from None
    if len(given) != 2:
        raise refusal(field, f"{len(given)} values", allowed)
    return "..".join(in_scene(end, field) for end in given)
