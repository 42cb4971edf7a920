"""Geometries as well-known binary: shapely, geopandas and pyarrow by duck typing, and GeoJSON."""

from __future__ import annotations

import struct
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Wkb = list[bytes | None]

#: Type codes of well-known binary, by their GeoJSON names.
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
    """Returns a GeoJSON geometry as well-known binary.

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


def shapely_if_imported() -> Any:
    """Returns shapely if it has been imported."""
    return sys.modules.get("shapely")


def is_geometry(value: Any) -> bool:
    # Asks the type: on an instance, hasattr would compute the attribute's value.
    kind = type(value)
    return hasattr(kind, "geom_type") and hasattr(kind, "wkb") and not hasattr(kind, "to_wkb")


def one_to_wkb(value: Any, index: int) -> bytes | None:
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


def objects(values: Any) -> NDArray[Any]:
    """Returns a flat array of objects, whose contents numpy must not convert."""
    if isinstance(values, np.ndarray) and values.dtype == object:
        return values
    items = list(values)
    array = np.empty(len(items), dtype=object)
    for index, item in enumerate(items):
        array[index] = item
    return array


def array_to_wkb(array: NDArray[Any]) -> Wkb:
    flat = array.reshape(-1)
    shapely = shapely_if_imported()
    if shapely is not None and all(value is None or is_geometry(value) for value in flat[:1]):
        try:
            return list(shapely.to_wkb(flat, include_srid=True))
        except TypeError:
            pass
    shaped = (value.wkb if is_geometry(value) else value for value in flat)
    return [one_to_wkb(value, index) for index, value in enumerate(shaped)]


def column_of(obj: Any) -> Any:
    """Returns an Arrow array as a pyarrow array; ``None`` for anything else."""
    if hasattr(obj, "buffers") and hasattr(obj, "type"):
        return obj
    if hasattr(obj, "chunks") and hasattr(obj, "combine_chunks"):
        joined = obj.combine_chunks()
        return joined.chunk(0) if hasattr(joined, "chunk") else joined
    if hasattr(obj, "__arrow_c_array__") and not hasattr(obj, "geom_type"):
        import pyarrow

        return pyarrow.array(obj)
    return None


def is_frame(obj: Any) -> bool:
    return hasattr(obj, "set_geometry") and hasattr(obj, "crs")


def is_series(obj: Any) -> bool:
    return hasattr(obj, "to_wkb") and hasattr(obj, "crs") and not is_frame(obj)


def to_wkb_list(obj: Any) -> Wkb:
    """Returns one or many geometries of any kind as a list of well-known binary."""
    if is_frame(obj):
        obj = obj.geometry
    if is_series(obj):
        return array_to_wkb(np.asarray(obj.values, dtype=object))
    if is_geometry(obj):
        return [bytes(obj.wkb)]
    if isinstance(obj, bytes | bytearray | memoryview | Mapping) or hasattr(obj, "__geo_interface__"):
        return [one_to_wkb(obj, 0)]
    column = column_of(obj)
    if column is not None:
        return [None if value is None else bytes(value) for value in column.to_pylist()]
    return array_to_wkb(objects(obj))


def from_wkb(rows: Wkb, shape: tuple[int, ...]) -> NDArray[Any]:
    shapely = shapely_if_imported()
    array = np.empty(len(rows), dtype=object)
    array[:] = rows
    made = shapely.from_wkb(array)
    return np.asarray(made, dtype=object).reshape(shape)
