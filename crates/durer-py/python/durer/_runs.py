"""Lines and polygons of shapely as arrays of coordinates, and back: many times faster than well-known binary.

The arrays are those of GeoArrow: a kind by shapely's number, coordinates, and offsets from the innermost level to the outermost.
shapely is an argument, because this package never imports it itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
Ragged = tuple[int, F64, list[I64]]
Bounds = tuple[float, float, float, float]

LINE, POLYGON = 1, 3

#: Kinds of several parts with the kinds of their parts.
SINGLE = {4: 0, 5: LINE, 6: POLYGON}


def kinds(shapely: Any, flat: NDArray[Any]) -> NDArray[np.int8]:
    """Returns 1 for lines and 3 for polygons without holes, both with x and y only; 0 for all other geometries."""
    types = shapely.get_type_id(flat)
    plain = (shapely.get_coordinate_dimension(flat) == 2) & (shapely.get_num_coordinates(flat) > 0)
    plain &= shapely.get_srid(flat) == 0
    out = np.zeros(flat.shape, np.int8)
    out[plain & (types == LINE)] = LINE
    out[plain & (types == POLYGON) & (shapely.get_num_interior_rings(flat) == 0)] = POLYGON
    return out


def outside(shapely: Any, flat: NDArray[Any], bounds: Bounds) -> NDArray[np.bool_]:
    """Returns which lines and polygons are outside a box and have only finite coordinates."""
    xmin, ymin, xmax, ymax = bounds
    low_x, low_y, high_x, high_y = shapely.bounds(flat).T
    apart = (high_x < xmin) | (low_x > xmax) | (high_y < ymin) | (low_y > ymax)
    # The length of a border depends on all coordinates, unlike the bounds.
    apart[apart] = np.isfinite(shapely.length(flat[apart]))
    return apart  # type: ignore[no-any-return]


def ragged(shapely: Any, flat: NDArray[Any], kind: int) -> Ragged:
    """Returns lines, or polygons without holes, as arrays."""
    ends = _ends(shapely.get_num_coordinates(flat))
    levels = [ends] if kind == LINE else [ends, np.arange(len(flat) + 1)]
    return kind, np.ascontiguousarray(shapely.get_coordinates(flat)), levels


def replaced(shapely: Any, flat: NDArray[Any], kind: int, native: Callable[[Ragged], Ragged]) -> NDArray[Any]:
    """Returns the results of a native function for lines or polygons; those that it leaves unchanged, except for the
    direction of their rings, are the same objects."""
    given = ragged(shapely, flat, kind)
    made = native(given)
    same = _same(given, made)
    out = results(shapely, kind, made, np.flatnonzero(~same))
    all = np.empty(flat.shape, dtype=object)
    all[same], all[~same] = flat[same], out
    return all


def results(shapely: Any, kind: int, made: Ragged, rows: I64) -> NDArray[Any]:
    """Returns the geometries of some rows of arrays; rows without coordinates become empty geometries of the kind."""
    out = np.empty(rows.shape, dtype=object)
    left = np.diff(_runs(made)[1])[rows] > 0
    out[~left] = empty(shapely, kind)
    out[left] = _built(shapely, made, rows[left])
    return out


def empty(shapely: Any, kind: int) -> Any:
    """Returns a line or polygon without points."""
    return shapely.LineString() if kind == LINE else shapely.Polygon()


def _ends(counts: Any) -> I64:
    """Returns the offsets of parts with these lengths."""
    ends = np.zeros(len(counts) + 1, np.int64)
    np.cumsum(counts, out=ends[1:])
    return ends


def _spans(first: I64, counts: I64) -> I64:
    """Returns consecutive numbers from each first one on, ``counts`` of each, one run after the other."""
    ends = _ends(counts)
    return np.repeat(first - ends[:-1], counts) + np.arange(ends[-1])


def _runs(arrays: Ragged) -> tuple[I64, I64]:
    """Returns where rows begin among the runs of coordinates, and among the coordinates."""
    _, coords, levels = arrays
    if not levels:
        at = np.arange(len(coords) + 1)
        return at, at
    at = np.arange(len(levels[0])) if len(levels) == 1 else levels[-1]
    for level in levels[-2:0:-1]:
        at = level[at]
    return at, levels[0][at]


def _same(given: Ragged, made: Ragged) -> NDArray[np.bool_]:
    """Returns which rows are a single run with their original coordinates, in either direction."""
    (_, before), (runs, after) = _runs(given), _runs(made)
    counts = np.diff(before)
    rows = np.flatnonzero((np.diff(runs) == 1) & (np.diff(after) == counts))
    out = np.zeros(counts.shape, np.bool_)
    for turned in (False, True):
        rows = rows[~out[rows]]
        if not rows.size:
            break
        lengths = counts[rows]
        old, new = _spans(before[rows], lengths), _spans(after[rows], lengths)
        if turned:
            old = np.repeat(before[rows] + before[rows + 1] - 1, lengths) - old
        equal = (given[1][old] == made[1][new]).all(axis=1)
        out[rows] = np.logical_and.reduceat(equal, _ends(lengths)[:-1])
    return out


def _built(shapely: Any, made: Ragged, rows: I64) -> NDArray[Any]:
    """Returns the geometries of some rows of arrays; a single part is not wrapped in a collection."""
    kind, coords, levels = made
    if kind not in SINGLE:
        parts, ends = _taken(coords, levels, rows)
        return shapely.from_ragged_array(shapely.GeometryType(kind), parts, tuple(ends))  # type: ignore[no-any-return]
    out = np.empty(rows.shape, dtype=object)
    outer = levels[-1]
    one = outer[rows + 1] - outer[rows] == 1
    out[one] = _built(shapely, (SINGLE[kind], coords, levels[:-1]), outer[rows[one]])
    parts, ends = _taken(coords, levels, rows[~one])
    out[~one] = shapely.from_ragged_array(shapely.GeometryType(kind), parts, tuple(ends))
    return out


def _taken(coords: F64, levels: list[I64], rows: I64) -> tuple[F64, list[I64]]:
    """Returns the arrays of some rows."""
    ends = []
    for level in reversed(levels):
        counts = level[rows + 1] - level[rows]
        ends.append(_ends(counts))
        rows = _spans(level[rows], counts)
    return coords[rows], ends[::-1]
