"""Errors and warnings of the package."""

from __future__ import annotations


class ReadError(ValueError):
    """Bytes that are not what their format demands.

    ``place`` says where: a line, a byte, or a path inside the file; ``None`` is the file as a whole.
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
    """Something in a file that was repaired or left out."""


class OptionError(ValueError):
    """Options that are wrong; calls turn it into what their callers know."""

    def __init__(self, message: str, place: str | None = None) -> None:
        super().__init__(message)
