"""Clipping and overlays of geometries: shapely, geopandas and pyarrow by duck typing, ragged arrays, and WKB."""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _durer, _runs
from ._options import threads as count
from ._wkb import (
    Wkb,
    array_to_wkb,
    column_of,
    from_wkb,
    is_frame,
    is_geometry,
    is_series,
    objects,
    shapely_if_imported,
    to_wkb_list,
)

Region = tuple[float, float, float, float] | list[bytes]


def _is_ragged(obj: Any) -> bool:
    if not isinstance(obj, tuple) or len(obj) not in (2, 3):
        return False
    coords = obj[-2]
    return isinstance(coords, np.ndarray) and coords.dtype != object


def _ragged(obj: Any) -> tuple[int, NDArray[np.float64], list[NDArray[np.int64]]]:
    coords = np.ascontiguousarray(obj[-2], dtype=np.float64)
    if coords.ndim != 2 or coords.shape[1] not in (2, 3):
        raise TypeError(f"coords must be (n, 2) or (n, 3), got {coords.shape}")
    offsets = obj[-1]
    levels = [offsets] if isinstance(offsets, np.ndarray) else list(offsets)
    arrays = [np.ascontiguousarray(level, dtype=np.int64) for level in levels]
    kind = int(obj[0]) if len(obj) == 3 else {0: 0, 1: 1, 2: 3, 3: 6}.get(len(arrays), 255)
    return kind, coords, arrays


def _ragged_like(given: Any, made: tuple[int, Any, list[Any]]) -> Any:
    kind, coords, offsets = made
    if len(given) == 3:
        return (type(given[0])(kind), coords, tuple(offsets))
    return (coords, tuple(offsets))


def _raise_first(errors: list[tuple[int, str]]) -> None:
    if errors:
        index, message = errors[0]
        raise ValueError(f"geometries[{index}]: {message}")


Many = Callable[[Wkb], tuple[Wkb, list[tuple[int, str]]]]

#: Number of geometries from which arrays of coordinates are faster than well-known binary.
FEW = 16

#: Number of geometries that a thread works on at a time: few enough for its cache.
CHUNK = 4096


def _over_array(array: NDArray[Any], many: Many) -> NDArray[Any]:
    """Applies ``many`` to an array of geometries or of well-known binary; the result has the same kind of elements."""
    flat = array.reshape(-1)
    has_bytes = any(isinstance(value, bytes) for value in flat)
    rows, errors = many(array_to_wkb(flat))
    _raise_first(errors)
    if not has_bytes and shapely_if_imported() is not None:
        return from_wkb(rows, array.shape)
    out = np.empty(len(rows), dtype=object)
    out[:] = rows
    return out.reshape(array.shape)


def _types(flat: NDArray[Any]) -> NDArray[Any] | None:
    """Returns shapely's type ids; ``None`` if arrays of coordinates do not pay off, or not all are geometries."""
    shapely = shapely_if_imported()
    if flat.size < FEW or shapely is None:
        return None
    try:
        return shapely.get_type_id(flat)  # type: ignore[no-any-return]
    except TypeError:
        return None


def _fill_in_parts(out: NDArray[Any], parts: list[tuple[NDArray[np.intp], Callable[[], NDArray[Any]]]]) -> None:
    """Fills an array from parts built one by one; errors give the index in the whole array."""
    for rows, make in parts:
        try:
            out[rows] = make()
        except ValueError as error:
            found = re.match(r"geometries\[(\d+)\]", str(error))
            if found is None:
                raise
            raise ValueError(f"geometries[{rows[int(found[1])]}]{str(error)[found.end() :]}") from None


def _clip_array(array: NDArray[Any], region: Region, grid: float | None, threads: int) -> NDArray[Any]:
    """Clips an array of geometries or of well-known binary; the result has the same kind of elements."""
    flat, shapely = array.reshape(-1), shapely_if_imported()
    types = _types(flat)
    if types is None:
        return _over_array(array, lambda rows: _durer.clip_wkb(rows, region, grid, threads))
    bounds, chunk = region, CHUNK
    if isinstance(region, list):
        # Invalid masks raise an error below.
        mask = shapely.from_wkb(np.array(region, dtype=object), on_invalid="ignore")
        bounds = tuple(shapely.total_bounds(mask).tolist())
        # Each chunk builds the mask again.
        chunk = max(chunk, sum(map(len, region)))

    def clip_some(rows: NDArray[np.intp]) -> NDArray[Any]:
        return _clip_chunk(flat[rows], types[rows], region, bounds, grid, threads)

    chunks = [np.arange(first, min(first + chunk, flat.size)) for first in range(0, flat.size, chunk)]
    out = np.empty(flat.shape, dtype=object)
    if len(chunks) == 1 or threads == 1:
        _fill_in_parts(out, [(rows, partial(clip_some, rows)) for rows in chunks])
        return out.reshape(array.shape)
    # shapely and the native part release the lock.
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        futures = [(rows, pool.submit(clip_some, rows)) for rows in chunks]
        try:
            _fill_in_parts(out, [(rows, future.result) for rows, future in futures])
        finally:
            pool.shutdown(cancel_futures=True)
    return out.reshape(array.shape)


def _clip_chunk(
    flat: NDArray[Any], types: NDArray[Any], region: Region, bounds: Any, grid: float | None, threads: int
) -> NDArray[Any]:
    """Clips geometries of shapely to a region with these bounds."""
    shapely = shapely_if_imported()

    def native(given: _runs.Ragged) -> tuple[NDArray[np.int64], _runs.Ragged]:
        return _durer.clip_changed(given, region, grid, threads)

    def many(rows: Wkb) -> tuple[Wkb, list[tuple[int, str]]]:
        return _durer.clip_wkb(rows, region, grid, threads)

    apart = _runs.outside(shapely, flat, types, bounds)
    out = np.empty(flat.shape, dtype=object)
    out[apart] = _runs.empties(shapely)[types[apart]]
    near = np.flatnonzero(~apart)
    kinds, counts = _runs.kinds(shapely, flat[near], types[near])
    # Each call builds the mask again, which may cost more than it saves.
    if isinstance(region, list) and sum(map(len, region)) > 64 * np.count_nonzero(kinds):
        kinds[:] = 0
    parts: list[Any] = []
    for kind in (_runs.LINE, _runs.POLYGON):
        some = kinds == kind
        rows = near[some]
        if rows.size:
            parts.append((rows, partial(_runs.replaced, shapely, flat[rows], counts[some], kind, native)))
    rest = near[kinds == 0]
    # A region that is wrong is an error, whatever is clipped to it.
    if rest.size or not parts:
        parts.append((rest, lambda: _over_array(flat[rest], many)))
    _fill_in_parts(out, parts)
    return out


def _over_column(column: Any, region: Region, grid: float | None, threads: int) -> Any:
    """Clips an Arrow array of well-known binary without creating Python objects for its rows."""
    import pyarrow

    storage = getattr(column, "storage", column)
    kind = str(storage.type)
    if kind not in ("binary", "large_binary"):
        raise TypeError(f"an Arrow array of binary with WKB is needed, got one of {kind}")
    large = storage.cast(pyarrow.large_binary())
    _, ends, data = large.buffers()
    first, rows = large.offset, len(large)
    offsets = np.frombuffer(ends, np.int64)[first : first + rows + 1] if rows else np.zeros(1, np.int64)
    contents = np.frombuffer(data, np.uint8) if data is not None and data.size else np.zeros(0, np.uint8)
    valid = np.asarray(large.is_valid()) if large.null_count else None
    out, out_ends, errors = _durer.clip_column(contents, np.ascontiguousarray(offsets), valid, region, grid, threads)
    _raise_first(errors)
    mask = None
    if valid is not None:
        mask = pyarrow.array(valid).buffers()[1]
    made = pyarrow.Array.from_buffers(
        pyarrow.large_binary(), rows, [mask, pyarrow.py_buffer(out_ends), pyarrow.py_buffer(out)]
    )
    made = made.cast(storage.type)
    wrap = getattr(column.type, "wrap_array", None)
    return made if wrap is None else wrap(made)


def _values(series: Any) -> NDArray[Any]:
    return np.asarray(series.values, dtype=object)


def _series_like(series: Any, values: NDArray[Any], rows: Any = slice(None)) -> Any:
    """Returns values as some rows of a GeoSeries."""
    return type(series)(values[rows], index=series.index[rows], crs=series.crs, name=series.name)


def _clip(geometry: Any, region: Region, grid: float | None, threads: int) -> Any:
    if is_frame(geometry):
        return geometry.set_geometry(_clip(geometry.geometry, region, grid, threads))
    if is_series(geometry):
        return _series_like(geometry, _clip_array(_values(geometry), region, grid, threads))
    if _is_ragged(geometry):
        return _ragged_like(geometry, _durer.clip_ragged(_ragged(geometry), region, grid, threads))
    if is_geometry(geometry) or isinstance(geometry, bytes):
        return _clip_array(objects([geometry]), region, grid, threads)[0]
    column = column_of(geometry)
    if column is not None:
        return _over_column(column, region, grid, threads)
    out = _clip_array(objects(geometry), region, grid, threads)
    return out.tolist() if isinstance(geometry, list) and out.ndim == 1 else out


def clip_by_rect(
    geometry: Any,
    xmin: float,
    ymin: float,
    xmax: float,
    ymax: float,
    *,
    grid_size: float | None = None,
    threads: int | None = None,
) -> Any:
    """Returns the part of each geometry inside a rectangle, in the form of the input.

    ``geometry`` is a shapely geometry, an array or list of them, a GeoSeries or GeoDataFrame, ragged arrays as
    ``shapely.to_ragged_array`` returns them, WKB, or an Arrow array of WKB. Resulting polygons are valid; geometries
    outside become empty. ``grid_size`` puts vertices of polygons on a grid.

    >>> import numpy as np
    >>> square = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4], [0, 0]])
    >>> coords, (rings, polygons) = clip_by_rect((square, ([0, 5], [0, 1])), 1, 1, 2, 3)
    >>> coords.tolist()
    [[1.0, 1.0], [2.0, 1.0], [2.0, 3.0], [1.0, 3.0], [1.0, 1.0]]
    """
    rect = (float(xmin), float(ymin), float(xmax), float(ymax))
    return _clip(geometry, rect, grid_size, count(threads))


def region_of(mask: Any) -> Region:
    if isinstance(mask, tuple | list | np.ndarray) and len(mask) == 4 and all(_is_number(v) for v in mask):
        xmin, ymin, xmax, ymax = (float(v) for v in mask)
        return (xmin, ymin, xmax, ymax)
    if _is_ragged(mask):
        shapely = shapely_if_imported()
        if shapely is None:
            raise TypeError("a mask of ragged arrays needs shapely; give WKB or a rectangle")
        mask = shapely.from_ragged_array(*mask)
    return [row for row in to_wkb_list(mask) if row is not None]


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | np.integer | np.floating)


def clip(
    geometry: Any,
    mask: Any,
    *,
    keep_geom_type: bool = False,
    grid_size: float | None = None,
    threads: int | None = None,
) -> Any:
    """Returns the part of each geometry inside a mask: polygons of any kind, or (xmin, ymin, xmax, ymax).

    Accepts the same as ``clip_by_rect``. Rows of a GeoDataFrame or GeoSeries outside the mask are dropped, as by
    ``geopandas.clip``; index and columns are kept, and a warning reports a mask in another coordinate system. Areas never
    become lines or points, so ``keep_geom_type`` only drops collections.

    >>> import numpy as np
    >>> square = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4], [0, 0]])
    >>> clip((square, ([0, 5], [0, 1])), (3, 3, 9, 9))[0].tolist()
    [[4.0, 3.0], [4.0, 4.0], [3.0, 4.0], [3.0, 3.0], [4.0, 3.0]]
    """
    tabular = is_frame(geometry) or is_series(geometry)
    if tabular and (is_frame(mask) or is_series(mask)) and geometry.crs != mask.crs:
        message = f"CRS mismatch between the CRS of left geometries and the CRS of the mask: {geometry.crs}, {mask.crs}"
        warnings.warn(message, UserWarning, stacklevel=2)
    region, native = region_of(mask), count(threads)
    if not tabular:
        return _clip(geometry, region, grid_size, native)
    # Rows outside are left out before a table of the rest is made.
    column = geometry.geometry if is_frame(geometry) else geometry
    made = _clip_array(_values(column), region, grid_size, native)
    shapely = shapely_if_imported()
    kept = ~(shapely.is_empty(made) | shapely.is_missing(made))
    if keep_geom_type:
        kept &= shapely.get_type_id(made) != shapely.GeometryType.GEOMETRYCOLLECTION
    clipped = _series_like(column, made, kept)
    return geometry[kept].set_geometry(clipped) if is_frame(geometry) else clipped


def _overlay(operation: str, a: Any, b: Any, grid: float | None, threads: int | None) -> Any:
    native = count(threads)
    if _is_ragged(a) and _is_ragged(b):
        return _ragged_like(a, _durer.overlay_ragged(_ragged(a), _ragged(b), operation, grid, native))
    scalar = all(is_geometry(x) or x is None or isinstance(x, bytes) for x in (a, b))
    arrays = [_operand(x) for x in (a, b)]
    left, right = np.broadcast_arrays(*arrays)

    made = _overlay_arrays(operation, np.ascontiguousarray(left), np.ascontiguousarray(right), grid, native)
    if scalar:
        return made.reshape(-1)[0]
    if is_series(a):
        return type(a)(made, index=a.index, crs=a.crs)
    return made


def _overlay_arrays(
    operation: str, a: NDArray[Any], b: NDArray[Any], grid: float | None, threads: int
) -> NDArray[Any]:
    """Overlays each geometry of an array with the one at the same index of the other."""
    left, right, shapely = a.reshape(-1), b.reshape(-1), shapely_if_imported()

    def bytes_of(rows: Any) -> NDArray[Any]:
        def many(given: Wkb) -> tuple[Wkb, list[tuple[int, str]]]:
            return _durer.overlay_wkb(given, array_to_wkb(right[rows]), operation, grid, threads)

        return _over_array(left[rows], many)

    types, others = _types(left), _types(right)
    if types is None or others is None:
        return bytes_of(slice(None)).reshape(a.shape)
    (kinds, counts), (other_kinds, other_counts) = _runs.kinds(shapely, left, types), _runs.kinds(shapely, right, others)
    plain = (kinds == _runs.POLYGON) & (other_kinds == _runs.POLYGON)
    simple, rest = np.flatnonzero(plain), np.flatnonzero(~plain)

    def polygons() -> NDArray[Any]:
        given = _runs.ragged(shapely, left[simple], counts[simple], _runs.POLYGON)
        other = _runs.ragged(shapely, right[simple], other_counts[simple], _runs.POLYGON)
        made = _durer.overlay_ragged(given, other, operation, grid, threads)
        return _runs.results(shapely, _runs.POLYGON, made)

    out = np.empty(left.shape, dtype=object)
    parts = [(simple, polygons), (rest, lambda: bytes_of(rest))]
    _fill_in_parts(out, [(rows, make) for rows, make in parts if rows.size])
    return out.reshape(a.shape)


def _operand(value: Any) -> NDArray[Any]:
    if is_frame(value):
        value = value.geometry
    if is_series(value):
        return _values(value)
    if value is None or is_geometry(value) or isinstance(value, bytes):
        one = np.empty(1, dtype=object)
        one[0] = value
        return one
    column = column_of(value)
    if column is not None:
        return objects(column.to_pylist())
    return objects(value)


def intersection(a: Any, b: Any, *, grid_size: float | None = None, threads: int | None = None) -> Any:
    """Returns the intersection of two geometries, pair by pair; arrays are broadcast as in shapely; results are valid.

    One of a pair is a polygon; the other may be points, lines or a polygon.
    """
    return _overlay("intersection", a, b, grid_size, threads)


def union(a: Any, b: Any, *, grid_size: float | None = None, threads: int | None = None) -> Any:
    """Returns the union of two polygons, pair by pair; see ``intersection`` for arrays."""
    return _overlay("union", a, b, grid_size, threads)


def difference(a: Any, b: Any, *, grid_size: float | None = None, threads: int | None = None) -> Any:
    """Returns the part of the first geometry outside the second, pair by pair; see ``intersection`` for arrays."""
    return _overlay("difference", a, b, grid_size, threads)


def symmetric_difference(a: Any, b: Any, *, grid_size: float | None = None, threads: int | None = None) -> Any:
    """Returns the area in exactly one of two polygons, pair by pair; see ``intersection`` for arrays."""
    return _overlay("symmetric_difference", a, b, grid_size, threads)


def clip_lines(segments: Any, rect: Any, *, threads: int | None = None) -> tuple[Any, NDArray[np.bool_]]:
    """Clips segments to a rectangle (xmin, ymin, xmax, ymax), or to a convex ring of points (n, 2).

    ``segments`` is an array (n, 2, 2), or a tuple of four arrays x0, y0, x1, y1, which are not copied. Returns
    segments in the same form, with flags that mark the visible ones; the others are unchanged.

    Raises ``ValueError`` with the index of a segment that is not finite.

    >>> import numpy as np
    >>> inside, kept = clip_lines(np.array([[[-1.0, 1], [1, 1]], [[5, 5], [6, 6]]]), (0, 0, 2, 2))
    >>> inside[kept].tolist(), kept.tolist()
    ([[[0.0, 1.0], [1.0, 1.0]]], [True, False])
    """
    native = count(threads)
    ring = None
    bounds = np.asarray(rect, dtype=np.float64)
    if bounds.ndim == 2 and bounds.shape[1] == 2:
        ring = np.ascontiguousarray(bounds)
    elif bounds.shape != (4,):
        raise TypeError(f"rect must be (xmin, ymin, xmax, ymax) or a ring (n, 2), got an array of shape {bounds.shape}")
    window = (0.0, 0.0, 0.0, 0.0) if ring is not None else _corners(bounds)
    if isinstance(segments, tuple) and len(segments) == 4 and all(np.ndim(s) == 1 for s in segments):
        x0, y0, x1, y1 = (np.ascontiguousarray(s, dtype=np.float64) for s in segments)
        if ring is None:
            arrays, flags = _durer.clip_arrays((x0, y0, x1, y1), window, native)
            return tuple(arrays), flags
        packed, flags = _durer.clip_segments_to_ring(_packed(x0, y0, x1, y1), ring, native)
        return tuple(np.ascontiguousarray(packed.reshape(-1, 4)[:, i]) for i in range(4)), flags
    array = np.ascontiguousarray(segments, dtype=np.float64)
    if array.ndim != 3 or array.shape[1:] != (2, 2):
        raise TypeError(f"segments must be (n, 2, 2), got {array.shape}")
    if ring is not None:
        return _durer.clip_segments_to_ring(array, ring, native)
    return _durer.clip_segments(array, window, native)


def _corners(bounds: NDArray[np.float64]) -> tuple[float, float, float, float]:
    xmin, ymin, xmax, ymax = bounds.tolist()
    return (xmin, ymin, xmax, ymax)


def _packed(*arrays: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.ascontiguousarray(np.stack(arrays, axis=1).reshape(-1, 2, 2))
