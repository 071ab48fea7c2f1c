"""Exceptions that carry the refused value, and the category of warnings."""

from __future__ import annotations


class FieldError(ValueError):
    """Error of a value that is not allowed."""

    def __init__(self, message: str, field: str, value: str, allowed: str) -> None:
        super().__init__(message)
        #: Name of the argument, or path of the field of a scene.
        self.field = field
        #: Refused value, as it was given.
        self.value = value
        #: Allowed values in words.
        self.allowed = allowed


class LoadingError(ValueError):
    """Error of a loading stage whose target the contact cannot reach."""

    def __init__(self, message: str, stage: int, smallest_force: float | None) -> None:
        super().__init__(message)
        #: Number of the loading stage, counted from 0, as in `Loop.stage`.
        self.stage = stage
        #: Smallest force in N that the contact can reach; None if the stage is refused for another reason.
        self.smallest_force = smallest_force


FieldError.__module__ = LoadingError.__module__ = "asperity"
