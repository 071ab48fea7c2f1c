"""Exceptions that carry the refused value, and warnings about premises of the model."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager


class FieldError(ValueError):
    """Error of a value that is not allowed.

    `field` is the name of the argument or the path of the field of a scene, `value` the refused value as a text, and `allowed` says
    in words which values are allowed.
    """

    def __init__(self, message: str, field: str, value: str, allowed: str) -> None:
        super().__init__(message)
        #: Name of the argument, or path of the field of a scene.
        self.field = field
        #: Refused value, as it was given.
        self.value = value
        #: Allowed values in words.
        self.allowed = allowed

    def __reduce__(self) -> tuple[type[FieldError], tuple[str, str, str, str]]:
        return type(self), (str(self), self.field, self.value, self.allowed)


class LoadingError(ValueError):
    """Error of a loading stage whose target the contact cannot reach.

    `stage` is its number, counted from 0, and `smallest_force` the smallest force in N within reach; None if the stage is refused
    for another reason.
    """

    def __init__(self, message: str, stage: int, smallest_force: float | None) -> None:
        super().__init__(message)
        #: Number of the loading stage, counted from 0, as in `Loop.stage`.
        self.stage = stage
        #: Smallest force in N that the contact can reach; None if the stage is refused for another reason.
        self.smallest_force = smallest_force

    def __reduce__(self) -> tuple[type[LoadingError], tuple[str, int, float | None]]:
        return type(self), (str(self), self.stage, self.smallest_force)


class PremiseWarning(UserWarning):
    """Warning of a result that does not meet a premise of the model, such as a contact that reaches the ends of the profile."""


@contextmanager
def naming(field: str, value: object) -> Iterator[None]:
    """Turns an error of a value that names no argument into a FieldError of the argument `field`."""
    try:
        yield
    except ValueError as error:
        if type(error) is not ValueError:
            raise
        message = str(error)
        allowed = message.rpartition("allowed: ")[2]
        try:
            given = str(value)
        except ValueError:  # A whole number of more than 4300 digits.
            given = f"a value of the type {type(value).__name__}"
        raise FieldError(message, field, given, allowed) from None


def warn_of(sentences: Iterable[str]) -> None:
    """Issues a PremiseWarning for each sentence, at the line that has called a function of the package."""
    for sentence in sentences:
        warnings.warn(sentence, PremiseWarning, stacklevel=3)


FieldError.__module__ = LoadingError.__module__ = PremiseWarning.__module__ = "asperity"
