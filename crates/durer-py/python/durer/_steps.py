"""The algorithms, and their steps for teaching."""

from __future__ import annotations

import os
from typing import Any, NamedTuple

import numpy as np

from . import _durer


class Algorithm(NamedTuple):
    """Facts of a published algorithm."""

    name: str
    title: str
    authors: str
    year: int
    source: str
    cost: str
    limits: str


def algorithms() -> list[Algorithm]:
    """Returns the facts of all algorithms, in the order of the pipeline.

    >>> next(a.year for a in algorithms() if a.name == "bresenham")
    1965
    """
    return [Algorithm(*facts) for facts in _durer.algorithms()]


def lessons() -> dict[str, list[str]]:
    """Returns the names of the algorithms that ``trace`` can run, each with its examples.

    >>> "cohen-sutherland" in lessons()
    True
    """
    return dict(_durer.lessons())


class Page:
    """A page with buttons, which notebooks show in an iframe."""

    def __init__(self, text: str) -> None:
        self.html = text

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page as a self-contained file."""
        _durer.deliver(os.fspath(path), self.html.encode())

    def _repr_html_(self) -> str:
        import html

        source = html.escape(self.html)
        return f'<iframe srcdoc="{source}" width="100%" height="640" style="border: 0"></iframe>'


class Trace(list[dict[str, Any]]):
    """The steps of a run: dicts of ``line`` (of the pseudocode), ``kind``, ``caption``, ``values``, ``table``, ``picture``."""

    #: The facts of the algorithm, with its pseudocode.
    facts: dict[str, Any]

    def __init__(self, facts: dict[str, Any], again: tuple[str, Any, int, str]) -> None:
        super().__init__(facts.pop("frames"))
        self.facts = facts
        self._again = again

    def explore(self) -> Page:
        """Returns a page with buttons for going through the steps."""
        return Page(_durer.trace_page(*self._again))


def trace(
    algorithm: str,
    *input: Any,
    example: str | None = None,
    window: Any = None,
    clip: Any = None,
    points: Any = None,
    seed: tuple[int, int] = (0, 0),
    cap: int = 100_000,
    language: str = "en",
) -> Trace:
    """Runs an algorithm step by step on an example or on your own input.

    ``input`` is one picture of bytes (rows, columns) for fills from a ``seed``, arrays (n, 3) for faces, or arrays (n, 2),
    which are rings of the subject if closed, otherwise lines. ``clip`` is a ring or a list of them, ``window`` a
    rectangle. At most ``cap`` steps are recorded; if there are more, a last one of kind ``more`` counts them.

    >>> steps = trace("cohen-sutherland", [[-1, 1], [5, 3]], window=(0, 0, 4, 4))
    >>> steps[0]["line"], steps.facts["year"]
    (1, 1967)
    """
    given = _given(input, example, window, clip, points, seed)
    again = (algorithm, given, int(cap), language)
    import json

    return Trace(json.loads(_durer.trace(*again)), again)


def _given(input: tuple[Any, ...], example: str | None, window: Any, clip: Any, points: Any, seed: tuple[int, int]) -> Any:
    if example is not None or not (input or window is not None or clip is not None or points is not None):
        if input:
            raise TypeError("example: it is the input, so no other goes with it")
        return example or ""
    arrays = [np.asarray(part) for part in input]
    if len(arrays) == 1 and arrays[0].dtype == np.uint8 and arrays[0].ndim == 2:
        return (np.ascontiguousarray(arrays[0]), (int(seed[0]), int(seed[1])))
    for number, array in enumerate(arrays):
        if array.ndim != 2 or array.shape[1] not in (2, 3):
            raise TypeError(f"input[{number}] must be (n, 2) or (n, 3), got {array.shape}")
    floats = [np.ascontiguousarray(array, dtype=np.float64) for array in arrays]
    if floats and all(array.shape[1] == 3 for array in floats):
        return floats
    lines: list[Any] = []
    rings: list[Any] = []
    for array in floats:
        closed = len(array) > 3 and (array[0] == array[-1]).all()
        (rings if closed else lines).append(np.ascontiguousarray(array[:-1]) if closed else array)
    masks = [] if clip is None else clip if isinstance(clip, list) and np.ndim(clip[0]) == 2 else [clip]
    own = [np.ascontiguousarray(ring, dtype=np.float64) for ring in masks]
    own = [ring[:-1].copy() if len(ring) > 3 and (ring[0] == ring[-1]).all() else ring for ring in own]
    dots = None if points is None else np.ascontiguousarray(points, dtype=np.float64)
    rect = None if window is None else tuple(float(v) for v in window)
    return (rect, lines, rings, own, dots)
