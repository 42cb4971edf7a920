"""Geometries rasterized to a grid of values."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _durer
from ._wkb import array_to_wkb, objects


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
    """Writes values of geometries to a grid, as ``rasterio.features.rasterize``; later shapes overwrite earlier ones.

    ``shapes`` are geometries of shapely or GeoJSON, or tuples of one and its value. ``transform`` maps columns and rows to
    coordinates: an ``affine.Affine``, or its six coefficients. A pixel belongs to a polygon if its centre is inside, or
    with ``all_touched`` if any point of it is; ``mode="coverage"`` weights values by the covered share of the pixel.

    >>> square = {"type": "Polygon", "coordinates": [[[1, 1], [3, 1], [3, 3], [1, 3], [1, 1]]]}
    >>> rasterize([(square, 7)], (4, 4))[2].tolist()
    [0, 7, 7, 0]
    """
    given, values = [], []
    for shape in shapes:
        geometry, value = shape if isinstance(shape, tuple) and len(shape) == 2 else (shape, default_value)
        given.append(geometry)
        values.append(float(value))
    geometries = []
    for index, row in enumerate(array_to_wkb(objects(given))):
        if row is None:
            raise TypeError(f"shapes[{index}] has no geometry")
        geometries.append(row)
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
