"""Errors and warnings of the package."""

from __future__ import annotations


class ReadError(ValueError):
    """Bytes that violate their format.

    ``place`` is a line, a byte, or a path inside the file; ``None`` for the file as a whole.
    """

    place: str | None

    def __init__(self, message: str, place: str | None = None) -> None:
        super().__init__(message)
        self.place = place


class LimitError(ValueError):
    """Work or data above a stated limit."""

    def __init__(self, message: str, place: str | None = None) -> None:
        super().__init__(message)


class ReadWarning(UserWarning):
    """A part of a file that was repaired or left out."""


class OptionError(ValueError):
    """Wrong options; calls convert it to ``ValueError`` or ``TypeError``."""

    def __init__(self, message: str, place: str | None = None) -> None:
        super().__init__(message)
