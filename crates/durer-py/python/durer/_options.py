"""Keyword arguments as the words of the command, and the number of threads."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterable, Mapping
from numbers import Integral, Real
from typing import TypeVar

from ._errors import OptionError

T = TypeVar("T")


def text(value: object) -> str:
    """Returns a value in the syntax of the command."""
    if isinstance(value, str | os.PathLike):
        return os.fspath(value) if not isinstance(value, str) else value
    if isinstance(value, Integral):
        return str(int(value))
    if isinstance(value, Real):
        return repr(float(value))
    if isinstance(value, Iterable):
        return ",".join(text(part) for part in value)
    return str(value)


def words(options: Mapping[str, object]) -> list[str]:
    """Returns options as words: ``True`` as a flag, lists of strings as repeated options; skips ``None`` and ``False``.

    >>> words({"up_axis": "z", "size": "8x8", "grid": True, "ortho": None, "eye": (0, 0.5, 1)})
    ['--up-axis=z', '--size=8x8', '--grid', '--eye=0,0.5,1']
    """
    out = []
    for name, value in options.items():
        flag = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            out.append(flag)
        elif isinstance(value, list | tuple) and value and all(isinstance(v, str) for v in value):
            out.extend(f"{flag}={part}" for part in value)
        else:
            out.append(f"{flag}={text(value)}")
    return out


def call(function: str, native: Callable[..., T], *args: object) -> T:
    """Calls a native function; errors name the function's arguments."""
    try:
        return native(*args)
    except OptionError as error:
        message = str(error)
        unknown = re.search(r"unexpected argument '--([^']*)' found", message)
        if unknown:
            name = unknown[1].split("=")[0].replace("-", "_")
            message = f"{function}() got an unexpected keyword argument '{name}'"
            raise TypeError(message) from None
        message = re.sub(r" <[^<>]*>'", "'", message)
        message = re.sub(r"--([a-z][a-z-]*)", lambda m: m[1].replace("-", "_"), message)
        raise ValueError(message) from None


def threads(wanted: int | None) -> int:
    """Returns the number of threads of a call; 0 means one per processor.

    The default is the value of ``DURER_THREADS``, or 1 in a worker process.
    """
    given: object = wanted
    if wanted is None:
        given = os.environ.get("DURER_THREADS") or None
    if given is not None:
        try:
            count = int(str(given))
        except ValueError:
            count = 0
        if not 1 <= count <= 1024:
            raise ValueError(f"threads is {given}; it must be a whole number from 1 to 1024")
        return count
    processes = sys.modules.get("multiprocessing.process")
    is_worker = processes is not None and processes.parent_process() is not None
    return 1 if is_worker else 0


def size_text(size: object) -> str:
    """Returns a size in the syntax of the command.

    >>> size_text((640, 480)), size_text(64), size_text((800, None))
    ('640x480', '64x64', '800x')
    """
    if isinstance(size, str):
        return size
    if isinstance(size, Integral):
        return f"{int(size)}x{int(size)}"
    sides = tuple(size) if isinstance(size, Iterable) else ()
    if len(sides) != 2 or not all(side is None or isinstance(side, Integral) for side in sides):
        raise TypeError(f"size must be (width, height) in whole pixels, got {size!r}")
    width, height = ("" if side is None else str(int(side)) for side in sides)
    return f"{width}x{height}"
