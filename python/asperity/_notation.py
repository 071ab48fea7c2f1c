"""Values of Python in the notation of a scene file."""

from __future__ import annotations

import json
import operator
import os
from collections.abc import Mapping, Sequence
from typing import Any, SupportsFloat, TypeAlias

from ._native import FieldError

#: A number in SI units, or a text with its unit.
Quantity: TypeAlias = SupportsFloat | str


class Form:
    """Form or roughness of a body, in the notation of a scene file."""

    def __init__(self, kind: str, **values: Any) -> None:
        self.kind = kind
        self.values = {name: value for name, value in values.items() if value is not None}

    def __repr__(self) -> str:
        return self.kind + in_scene(self.values)


def in_scene(value: Any) -> str:
    """A value as a scene file writes it; a text stays as it is, so that it may have a unit."""
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
    """The exception for a value that is not allowed."""
    error = FieldError(f"{field} = {value!r}; allowed: {allowed}")
    error.field, error.value, error.allowed = field, str(value), allowed
    return error


def in_fields(fields: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Arguments such as `adhesion__work=0.05` as paths of a scene with their values."""
    return [(name.replace("__", "."), in_scene(value)) for name, value in fields.items()]


def in_words(options: Mapping[str, Any]) -> list[str]:
    """Arguments such as `tip_radius="10 nm"` as options of the command line; one without a value is left out."""
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
