"""Exceptions with values."""

from __future__ import annotations


class FieldError(ValueError):
    """A value is out of its range."""

    def __init__(self, message: str, field: str, value: str, allowed: str) -> None:
        super().__init__(message)
        #: Name of the argument, or path of the field of a scene.
        self.field = field
        #: The value as it was given.
        self.value = value
        #: What is allowed.
        self.allowed = allowed


class LoadingError(ValueError):
    """The contact does not reach a loading stage."""

    def __init__(self, message: str, stage: int, smallest_force: float | None) -> None:
        super().__init__(message)
        #: Number of the stage, from 1.
        self.stage = stage
        #: Smallest force within reach, N; None if the stage is refused for another reason.
        self.smallest_force = smallest_force


FieldError.__module__ = LoadingError.__module__ = "asperity"
