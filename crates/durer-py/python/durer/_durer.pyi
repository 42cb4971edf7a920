"""The compiled part of the package; it is not a public interface."""

import os
from collections.abc import Sequence
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "__version__",
    "command",
    "Model",
    "read",
    "scene_of",
    "linear_of_srgb",
    "render",
    "fit",
    "draw",
    "lines",
    "line_classes",
    "picked",
    "encode",
    "deliver",
    "fill",
    "warped",
    "plot",
    "plot_pixels",
    "draw_layers",
    "draw_vectors",
    "tiles",
    "css_color",
    "clip_arrays",
    "clip_segments",
    "clip_segments_to_ring",
    "clip_wkb",
    "overlay_wkb",
    "clip_column",
    "clip_ragged",
    "clip_changed",
    "overlay_ragged",
    "rasterize",
    "trace",
    "trace_page",
    "algorithms",
    "lessons",
]

__version__: str

_F64 = NDArray[np.float64]
_I64 = NDArray[np.int64]
_U8 = NDArray[np.uint8]
_F32 = NDArray[np.float32]
_U32 = NDArray[np.uint32]
_Bool = NDArray[np.bool_]
_Vector = tuple[float, float, float] | Sequence[float]
_CameraNumbers = tuple[_Vector, _Vector, _Vector, float | None, float | None, float, float]
_Region = tuple[float, float, float, float] | list[bytes]
_Errors = list[tuple[int, str]]
_Ragged = tuple[int, _F64, list[_I64]]
_Ranges = Any

@final
class Model:
    @property
    def name(self) -> str: ...
    @property
    def format(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def triangle_count(self) -> int: ...
    def bounds(self) -> list[list[float]] | None: ...
    def info(self) -> dict[str, Any]: ...
    def to_bytes(self) -> bytes: ...
    @staticmethod
    def from_bytes(bytes: bytes) -> Model: ...

def command(line: Sequence[str]) -> int: ...
def read(
    data: bytes,
    name: str,
    path: str | os.PathLike[str] | None,
    threads: int,
    limits: tuple[int | None, int | None],
    pose: tuple[str | None, float | None],
) -> Model: ...
def scene_of(meshes: Sequence[Any], materials: Sequence[Any], up_axis: str, name: str) -> Model: ...
def linear_of_srgb(colors: _U8) -> _F32: ...
def render(
    model: Model,
    options: Sequence[str],
    planes: tuple[bool, bool, bool],
    linear: bool,
    threads: int,
) -> tuple[_U8, _F32 | None, _U32 | None, _F32 | None, _CameraNumbers | None, str | None]: ...
def fit(model: Model, options: Sequence[str], threads: int) -> tuple[_CameraNumbers, tuple[int, int]]: ...
def draw(model: Model, options: Sequence[str], suffix: str, threads: int) -> bytes: ...
def lines(model: Model, options: Sequence[str], threads: int) -> tuple[_F64, _I64, _U8, _U32, _Bool]: ...
def line_classes() -> list[str]: ...
def picked(
    model: Model, seen_by: _CameraNumbers, size: tuple[int, int], at: tuple[float, float]
) -> list[tuple[str, int, int, int, float, list[float]]]: ...
def encode(picture: _U8, suffix: str, quality: int, small: bool) -> bytes: ...
def deliver(path: str | os.PathLike[str], bytes: bytes) -> None: ...
def fill(
    picture: _U8,
    seeds: Sequence[tuple[int, int]],
    color: tuple[int, int, int, int],
    tolerance: int,
    boundary: tuple[int, int, int, int] | None,
    eight: bool,
) -> tuple[_U8, list[int]]: ...
def warped(
    sources: Sequence[tuple[_U8, _F32, _CameraNumbers]],
    to: _CameraNumbers,
    size: tuple[int, int],
    hole: tuple[int, int, int, int],
    threads: int,
) -> tuple[_U8, _U32, int]: ...
def plot(heights: _F64, ranges: _Ranges, options: Sequence[str], suffix: str, threads: int) -> bytes: ...
def plot_pixels(heights: _F64, ranges: _Ranges, options: Sequence[str], threads: int) -> _U8: ...
def draw_layers(words: Sequence[str], layers: Sequence[bytes], threads: int) -> _U8: ...
def draw_vectors(words: Sequence[str], layers: Sequence[bytes], suffix: str, threads: int) -> bytes: ...
def tiles(words: Sequence[str], threads: int) -> None: ...
def css_color(text: str) -> bytes: ...
def clip_arrays(
    arrays: tuple[_F64, _F64, _F64, _F64], rect: tuple[float, float, float, float], threads: int
) -> tuple[list[_F64], _Bool]: ...
def clip_segments(
    segments: _F64, rect: tuple[float, float, float, float], threads: int
) -> tuple[_F64, _Bool]: ...
def clip_segments_to_ring(segments: _F64, ring: _F64, threads: int) -> tuple[_F64, _Bool]: ...
def clip_wkb(
    rows: Sequence[bytes | None], region: _Region, grid: float | None, threads: int
) -> tuple[list[bytes | None], _Errors]: ...
def overlay_wkb(
    a: Sequence[bytes | None], b: Sequence[bytes | None], operation: str, grid: float | None, threads: int
) -> tuple[list[bytes | None], _Errors]: ...
def clip_column(
    data: _U8, offsets: _I64, valid: _Bool | None, region: _Region, grid: float | None, threads: int
) -> tuple[_U8, _I64, _Errors]: ...
def clip_ragged(given: _Ragged, region: _Region, grid: float | None, threads: int) -> _Ragged: ...
def clip_changed(
    given: _Ragged, region: _Region, grid: float | None, threads: int
) -> tuple[_I64, _Ragged]: ...
def overlay_ragged(a: _Ragged, b: _Ragged, operation: str, grid: float | None, threads: int) -> _Ragged: ...
def rasterize(
    shapes: Sequence[bytes],
    values: Sequence[float],
    size: tuple[int, int],
    to_pixels: tuple[float, float, float, float, float, float],
    fill: float,
    mode: str,
) -> _F64: ...
def trace(algorithm: str, given: Any, cap: int, code: str) -> str: ...
def trace_page(algorithm: str, given: Any, cap: int, code: str) -> str: ...
def algorithms() -> list[tuple[str, str, str, int, str, str, str]]: ...
def lessons() -> list[tuple[str, list[str]]]: ...
