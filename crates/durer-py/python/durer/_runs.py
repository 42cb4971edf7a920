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


#: By shapely's type id (``False`` for no geometry): kinds whose length, or whose area, depends on all coordinates.
LONG = np.array([False, True, False, False, False, True, False, False, False])
WIDE = np.array([False, False, False, True, False, False, True, False, False])


def kinds(shapely: Any, flat: NDArray[Any], types: NDArray[Any]) -> tuple[NDArray[np.int8], NDArray[Any]]:
    """Returns 1 for lines and 3 for polygons without holes, both with x and y only, and 0 for all other geometries;
    and their numbers of coordinates."""
    counts = shapely.get_num_coordinates(flat)
    plain = (counts > 0) & (shapely.get_coordinate_dimension(flat) == 2)
    plain &= shapely.get_srid(flat) == 0
    out = np.zeros(flat.shape, np.int8)
    out[plain & (types == LINE)] = LINE
    out[plain & (types == POLYGON) & (shapely.get_num_interior_rings(flat) == 0)] = POLYGON
    return out, counts


def outside(shapely: Any, flat: NDArray[Any], types: NDArray[Any], bounds: Bounds) -> NDArray[np.bool_]:
    """Returns which lines and polygons, single or multiple, are outside a box and have only finite coordinates."""
    xmin, ymin, xmax, ymax = bounds
    low_x, low_y, high_x, high_y = shapely.bounds(flat).T
    apart = (high_x < xmin) | (low_x > xmax) | (high_y < ymin) | (low_y > ymax)
    rows = np.flatnonzero(apart)
    apart[rows] = shapely.get_srid(flat[rows]) == 0
    apart &= LONG[types] | WIDE[types]
    # Bounds ignore NaN.
    for kind, measure in ((LONG, shapely.length), (WIDE, shapely.area)):
        rows = np.flatnonzero(apart & kind[types])
        apart[rows] = np.isfinite(measure(flat[rows]))
    return apart  # type: ignore[no-any-return]


def ragged(shapely: Any, flat: NDArray[Any], counts: NDArray[Any], kind: int) -> Ragged:
    """Returns lines, or polygons without holes, as arrays, from their numbers of coordinates."""
    ends = _ends(counts)
    levels = [ends] if kind == LINE else [ends, np.arange(len(flat) + 1)]
    return kind, np.ascontiguousarray(shapely.get_coordinates(flat)), levels


def replaced(
    shapely: Any,
    flat: NDArray[Any],
    counts: NDArray[Any],
    kind: int,
    native: Callable[[Ragged], tuple[I64, Ragged]],
) -> NDArray[Any]:
    """Returns the results of a native function for lines or polygons; unchanged ones are the same objects."""
    rows, made = native(ragged(shapely, flat, counts, kind))
    out = flat.copy()
    out[rows] = results(shapely, kind, made)
    return out


def results(shapely: Any, kind: int, made: Ragged) -> NDArray[Any]:
    """Returns the geometries of arrays; rows without coordinates become empty geometries of the kind."""
    left = np.diff(made[2][-1]) > 0
    out = np.empty(left.shape, dtype=object)
    out[~left] = empties(shapely)[kind]
    out[left] = _built(shapely, made, np.flatnonzero(left))
    return out


def empties(shapely: Any) -> NDArray[Any]:
    """Returns empty geometries by shapely's type id, up to multiple polygons."""
    out = np.empty(7, dtype=object)
    kinds = ("Point", "LineString", "LineString", "Polygon", "MultiPoint", "MultiLineString", "MultiPolygon")
    out[:] = [getattr(shapely, kind)() for kind in kinds]
    return out


def _ends(counts: Any) -> I64:
    """Returns the offsets of parts with these lengths."""
    ends = np.zeros(len(counts) + 1, np.int64)
    np.cumsum(counts, out=ends[1:])
    return ends


def _spans(first: I64, counts: I64) -> I64:
    """Returns consecutive numbers from each first one on, ``counts`` of each, one run after the other."""
    ends = _ends(counts)
    return np.repeat(first - ends[:-1], counts) + np.arange(ends[-1])


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
