"""Clipping and overlays of geometries: of shapely, geopandas and pyarrow by duck typing, of ragged arrays, and of WKB."""

from __future__ import annotations

import struct
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _durer
from ._options import threads as count

Wkb = list[bytes | None]
Region = tuple[float, float, float, float] | list[bytes]

#: Numbers of the kinds of geometries in well-known binary, by their names in GeoJSON.
_CODES = {
    "Point": 1,
    "LineString": 2,
    "Polygon": 3,
    "MultiPoint": 4,
    "MultiLineString": 5,
    "MultiPolygon": 6,
    "GeometryCollection": 7,
}
_PARTS = {"MultiPoint": "Point", "MultiLineString": "LineString", "MultiPolygon": "Polygon"}


def wkb_of_mapping(mapping: Mapping[str, Any]) -> bytes:
    """Returns well-known binary of a geometry of GeoJSON.

    >>> len(wkb_of_mapping({"type": "Point", "coordinates": [1, 2]}))
    21
    """
    kind = mapping.get("type")
    if kind == "Feature":
        return wkb_of_mapping(mapping["geometry"])
    if kind == "FeatureCollection":
        parts = [feature["geometry"] for feature in mapping["features"] if feature.get("geometry")]
        return wkb_of_mapping({"type": "GeometryCollection", "geometries": parts})
    if kind not in _CODES:
        raise ValueError(f"type is {kind!r}; it must be one of {', '.join(_CODES)}")
    head = struct.pack("<BI", 1, _CODES[kind])
    if kind == "GeometryCollection":
        parts = mapping["geometries"]
        return head + struct.pack("<I", len(parts)) + b"".join(map(wkb_of_mapping, parts))
    coordinates = mapping["coordinates"]
    if kind in _PARTS:
        own = (wkb_of_mapping({"type": _PARTS[kind], "coordinates": part}) for part in coordinates)
        return head + struct.pack("<I", len(coordinates)) + b"".join(own)

    def run(points: Any) -> bytes:
        array = np.asarray(points, dtype="<f8")
        array = array.reshape(len(points), -1)[:, :2] if len(points) else array.reshape(0, 2)
        return struct.pack("<I", len(array)) + np.ascontiguousarray(array).tobytes()

    if kind == "Point":
        return head + struct.pack("<2d", *coordinates[:2])
    if kind == "LineString":
        return head + run(coordinates)
    return head + struct.pack("<I", len(coordinates)) + b"".join(map(run, coordinates))


def _shapely() -> Any:
    """Returns shapely if it has been imported."""
    return sys.modules.get("shapely")


def _is_geometry(value: Any) -> bool:
    return hasattr(value, "geom_type") and hasattr(value, "wkb") and not hasattr(value, "to_wkb")


def _one_to_wkb(value: Any, index: int) -> bytes | None:
    if value is None:
        return None
    if isinstance(value, bytes):
        return value
    if isinstance(value, bytearray | memoryview):
        return bytes(value)
    if isinstance(value, Mapping):
        return wkb_of_mapping(value)
    if hasattr(value, "__geo_interface__"):
        return wkb_of_mapping(value.__geo_interface__)
    if value != value:
        return None
    raise TypeError(f"geometries[{index}] is a {type(value).__name__}, not a geometry")


def _objects(values: Any) -> NDArray[Any]:
    """Returns a flat array of objects, which numpy must not look into."""
    if isinstance(values, np.ndarray) and values.dtype == object:
        return values
    items = list(values)
    array = np.empty(len(items), dtype=object)
    for index, item in enumerate(items):
        array[index] = item
    return array


def _array_to_wkb(array: NDArray[Any]) -> Wkb:
    flat = array.reshape(-1)
    shapely = _shapely()
    if shapely is not None and all(value is None or _is_geometry(value) for value in flat[:1]):
        try:
            return list(shapely.to_wkb(flat, include_srid=True))
        except TypeError:
            pass
    shaped = (value.wkb if _is_geometry(value) else value for value in flat)
    return [_one_to_wkb(value, index) for index, value in enumerate(shaped)]


def _column(obj: Any) -> Any:
    """Returns a pyarrow array of an Arrow array; ``None`` for anything else."""
    if hasattr(obj, "buffers") and hasattr(obj, "type"):
        return obj
    if hasattr(obj, "chunks") and hasattr(obj, "combine_chunks"):
        joined = obj.combine_chunks()
        return joined.chunk(0) if hasattr(joined, "chunk") else joined
    if hasattr(obj, "__arrow_c_array__") and not hasattr(obj, "geom_type"):
        import pyarrow

        return pyarrow.array(obj)
    return None


def _is_frame(obj: Any) -> bool:
    return hasattr(obj, "set_geometry") and hasattr(obj, "crs")


def _is_series(obj: Any) -> bool:
    return hasattr(obj, "to_wkb") and hasattr(obj, "crs") and not _is_frame(obj)


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


def to_wkb_list(obj: Any) -> Wkb:
    """Returns geometries, one or many of any kind, as a list of well-known binary."""
    if _is_frame(obj):
        obj = obj.geometry
    if _is_series(obj):
        return _array_to_wkb(np.asarray(obj.values, dtype=object))
    if _is_geometry(obj):
        return [bytes(obj.wkb)]
    if isinstance(obj, bytes | bytearray | memoryview | Mapping) or hasattr(obj, "__geo_interface__"):
        return [_one_to_wkb(obj, 0)]
    column = _column(obj)
    if column is not None:
        return [None if value is None else bytes(value) for value in column.to_pylist()]
    return _array_to_wkb(_objects(obj))


def _from_wkb(rows: Wkb, shape: tuple[int, ...]) -> NDArray[Any]:
    shapely = _shapely()
    array = np.empty(len(rows), dtype=object)
    array[:] = rows
    made = shapely.from_wkb(array)
    return np.asarray(made, dtype=object).reshape(shape)


def _raise_first(errors: list[tuple[int, str]]) -> None:
    if errors:
        index, message = errors[0]
        raise ValueError(f"geometries[{index}]: {message}")


Many = Callable[[Wkb], tuple[Wkb, list[tuple[int, str]]]]


def _over_array(array: NDArray[Any], many: Many) -> NDArray[Any]:
    """Does something with arrays of geometries or of well-known binary; the result holds the same."""
    flat = array.reshape(-1)
    has_bytes = any(isinstance(value, bytes) for value in flat)
    rows, errors = many(_array_to_wkb(flat))
    _raise_first(errors)
    if not has_bytes and _shapely() is not None:
        return _from_wkb(rows, array.shape)
    out = np.empty(len(rows), dtype=object)
    out[:] = rows
    return out.reshape(array.shape)


def _over_column(column: Any, region: Region, grid: float | None, threads: int) -> Any:
    """Clips an Arrow array of well-known binary without objects of Python for its rows."""
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


def _clip(geometry: Any, region: Region, grid: float | None, threads: int) -> Any:
    def many(rows: Wkb) -> tuple[Wkb, list[tuple[int, str]]]:
        return _durer.clip_wkb(rows, region, grid, threads)

    if _is_frame(geometry):
        return geometry.set_geometry(_clip(geometry.geometry, region, grid, threads))
    if _is_series(geometry):
        made = _over_array(np.asarray(geometry.values, dtype=object), many)
        return type(geometry)(made, index=geometry.index, crs=geometry.crs, name=geometry.name)
    if _is_ragged(geometry):
        return _ragged_like(geometry, _durer.clip_ragged(_ragged(geometry), region, grid, threads))
    if _is_geometry(geometry):
        return _over_array(_objects([geometry]), many)[0]
    if isinstance(geometry, bytes):
        rows, errors = many([geometry])
        _raise_first(errors)
        return rows[0]
    column = _column(geometry)
    if column is not None:
        return _over_column(column, region, grid, threads)
    array = _objects(geometry)
    out = _over_array(array, many)
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
    """Returns the part of each geometry in a rectangle, as the same kind of thing as was given.

    ``geometry`` is one of shapely, an array or list of them, a GeoSeries or GeoDataFrame, ragged arrays as
    ``shapely.to_ragged_array`` gives them, WKB, or an Arrow array of WKB. Polygons come out valid; of geometries outside
    empty ones are left. ``grid_size`` puts vertices of polygons on a grid.

    >>> import numpy as np
    >>> square = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4], [0, 0]])
    >>> coords, (rings, polygons) = clip_by_rect((square, ([0, 5], [0, 1])), 1, 1, 2, 3)
    >>> coords.tolist()
    [[1.0, 1.0], [2.0, 1.0], [2.0, 3.0], [1.0, 3.0], [1.0, 1.0]]
    """
    rect = (float(xmin), float(ymin), float(xmax), float(ymax))
    return _clip(geometry, rect, grid_size, count(threads))


def _region(mask: Any) -> Region:
    if isinstance(mask, tuple | list | np.ndarray) and len(mask) == 4 and all(_is_number(v) for v in mask):
        xmin, ymin, xmax, ymax = (float(v) for v in mask)
        return (xmin, ymin, xmax, ymax)
    if _is_ragged(mask):
        shapely = _shapely()
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
    """Returns the part of each geometry in a mask: polygons of any kind, or (xmin, ymin, xmax, ymax).

    As ``clip_by_rect``; of a GeoDataFrame or GeoSeries rows outside are left out, as by ``geopandas.clip``, index and
    columns stay, and a warning reports a mask in another coordinate system. Results never change from areas to lines or
    points, so ``keep_geom_type`` makes no difference but for collections, which it leaves out.

    >>> import numpy as np
    >>> square = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4], [0, 0]])
    >>> clip((square, ([0, 5], [0, 1])), (3, 3, 9, 9))[0].tolist()
    [[4.0, 3.0], [4.0, 4.0], [3.0, 4.0], [3.0, 3.0], [4.0, 3.0]]
    """
    tabular = _is_frame(geometry) or _is_series(geometry)
    if tabular and (_is_frame(mask) or _is_series(mask)) and geometry.crs != mask.crs:
        message = f"CRS mismatch between the CRS of left geometries and the CRS of the mask: {geometry.crs}, {mask.crs}"
        warnings.warn(message, UserWarning, stacklevel=2)
    made = _clip(geometry, _region(mask), grid_size, count(threads))
    if not tabular:
        return made
    column = made.geometry if _is_frame(made) else made
    kept = ~(column.is_empty | column.isna())
    if keep_geom_type:
        kept &= column.geom_type != "GeometryCollection"
    return made[kept]


def _overlay(operation: str, a: Any, b: Any, grid: float | None, threads: int | None) -> Any:
    native = count(threads)
    if _is_ragged(a) and _is_ragged(b):
        return _ragged_like(a, _durer.overlay_ragged(_ragged(a), _ragged(b), operation, grid, native))
    scalar = all(_is_geometry(x) or x is None or isinstance(x, bytes) for x in (a, b))
    arrays = [_operand(x) for x in (a, b)]
    left, right = np.broadcast_arrays(*arrays)

    def many(rows: Wkb) -> tuple[Wkb, list[tuple[int, str]]]:
        return _durer.overlay_wkb(rows, _array_to_wkb(np.ascontiguousarray(right)), operation, grid, native)

    made = _over_array(np.ascontiguousarray(left), many)
    if scalar:
        return made.reshape(-1)[0]
    if _is_series(a):
        return type(a)(made, index=a.index, crs=a.crs)
    return made


def _operand(value: Any) -> NDArray[Any]:
    if _is_frame(value):
        value = value.geometry
    if _is_series(value):
        return np.asarray(value.values, dtype=object)
    if value is None or _is_geometry(value) or isinstance(value, bytes):
        one = np.empty(1, dtype=object)
        one[0] = value
        return one
    column = _column(value)
    if column is not None:
        return _objects(column.to_pylist())
    return _objects(value)


def intersection(a: Any, b: Any, *, grid_size: float | None = None, threads: int | None = None) -> Any:
    """Returns what is in both geometries, pair by pair; arrays are broadcast as by shapely, and results are valid.

    One of a pair is a polygon; the other may be points, lines or a polygon.
    """
    return _overlay("intersection", a, b, grid_size, threads)


def union(a: Any, b: Any, *, grid_size: float | None = None, threads: int | None = None) -> Any:
    """Returns what is in one of two polygons or in both, pair by pair, as ``intersection``."""
    return _overlay("union", a, b, grid_size, threads)


def difference(a: Any, b: Any, *, grid_size: float | None = None, threads: int | None = None) -> Any:
    """Returns what is in the first geometry and not in the second, pair by pair, as ``intersection``."""
    return _overlay("difference", a, b, grid_size, threads)


def symmetric_difference(a: Any, b: Any, *, grid_size: float | None = None, threads: int | None = None) -> Any:
    """Returns what is in one of two polygons only, pair by pair, as ``intersection``."""
    return _overlay("symmetric_difference", a, b, grid_size, threads)


def clip_lines(segments: Any, rect: Any, *, threads: int | None = None) -> tuple[Any, NDArray[np.bool_]]:
    """Clips segments to a rectangle (xmin, ymin, xmax, ymax), or to a convex ring of points (n, 2).

    ``segments`` is an array (n, 2, 2), or a tuple of four arrays x0, y0, x1, y1, which are not copied. Returns clipped
    segments in the same form, with flags of those of which something is left; the others are as they were.

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


def rasterize(
    shapes: Iterable[Any],
    out_shape: tuple[int, int],
    transform: Any = None,
    *,
    fill: float = 0,
    all_touched: bool = False,
    default_value: float = 1,
    mode: str = "centers",
    dtype: Any = None,
) -> NDArray[Any]:
    """Gives the pixels of geometries their values, as ``rasterio.features.rasterize``; later shapes are over earlier ones.

    ``shapes`` are geometries of shapely or GeoJSON, or tuples of one and its value. ``transform`` takes columns and rows to
    coordinates: an ``affine.Affine``, or its six coefficients. Pixels belong to a polygon if their centre does, with
    ``all_touched`` if any point does; ``mode="coverage"`` weights values by the share of the pixel that is covered.

    >>> square = {"type": "Polygon", "coordinates": [[[1, 1], [3, 1], [3, 3], [1, 3], [1, 1]]]}
    >>> rasterize([(square, 7)], (4, 4))[2].tolist()
    [0, 7, 7, 0]
    """
    geometries, values = [], []
    for index, shape in enumerate(shapes):
        geometry, value = shape if isinstance(shape, tuple) and len(shape) == 2 else (shape, default_value)
        row = bytes(geometry.wkb) if _is_geometry(geometry) else _one_to_wkb(geometry, index)
        if row is None:
            raise TypeError(f"shapes[{index}] has no geometry")
        geometries.append(row)
        values.append(float(value))
    if mode not in ("centers", "coverage"):
        raise ValueError(f"mode is '{mode}'; it must be centers or coverage")
    height, width = (int(side) for side in out_shape)
    if min(height, width) < 1:
        raise ValueError(f"out_shape is {(height, width)}; it must be (rows, columns) from 1")
    how = "touched" if all_touched and mode == "centers" else mode
    out = _durer.rasterize(geometries, values, (width, height), _to_pixels(transform), float(fill), how)
    return out.astype(_smallest([*values, float(fill)], mode) if dtype is None else dtype)


def _to_pixels(transform: Any) -> tuple[float, float, float, float, float, float]:
    """Returns the inverse of a transform from pixels to coordinates."""
    if transform is None:
        return (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    a, b, c, d, e, f = (float(v) for v in tuple(transform)[:6])
    det = a * e - b * d
    if det == 0.0 or not np.isfinite(det):
        raise ValueError(f"transform is {(a, b, c, d, e, f)}; it must have an inverse")
    return (e / det, -b / det, (b * f - c * e) / det, -d / det, a / det, (c * d - a * f) / det)


def _smallest(values: ArrayLike, mode: str) -> Any:
    numbers = np.asarray(values)
    if mode == "coverage" or not np.isfinite(numbers).all() or (numbers != np.rint(numbers)).any():
        return np.float32
    low, high = numbers.min(), numbers.max()
    for dtype in (np.uint8, np.int16, np.uint16, np.int32, np.uint32):
        info = np.iinfo(dtype)
        if info.min <= low and high <= info.max:
            return dtype
    return np.float64
