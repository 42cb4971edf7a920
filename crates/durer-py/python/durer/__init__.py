"""Pictures, exact drawings and fast clipping of 3D models and maps, on the CPU.

>>> import durer
>>> triangle = ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
>>> durer.render(triangle, size=(64, 64), view="top").pixels.shape
(64, 64, 4)
"""

from __future__ import annotations

from ._camera import Camera
from ._durer import __version__
from ._errors import LimitError, ReadError, ReadWarning
from ._geometry import (
    clip,
    clip_by_rect,
    clip_lines,
    difference,
    intersection,
    symmetric_difference,
    union,
)
from ._lines import LINE_CLASSES, Drawing, Lines, drawing, hidden_lines
from ._picture import DrawnImage, Image, Planes, Plot, draw, fill, plot, render, render_planes, tiles, warp
from ._raster import rasterize
from ._scene import Scene, read, scene
from ._steps import Algorithm, Page, Trace, algorithms, lessons, trace

__all__ = [
    "LINE_CLASSES",
    "Algorithm",
    "Camera",
    "Drawing",
    "DrawnImage",
    "Image",
    "LimitError",
    "Lines",
    "Page",
    "Planes",
    "Plot",
    "ReadError",
    "ReadWarning",
    "Scene",
    "Trace",
    "__version__",
    "algorithms",
    "clip",
    "clip_by_rect",
    "clip_lines",
    "difference",
    "draw",
    "drawing",
    "fill",
    "hidden_lines",
    "intersection",
    "lessons",
    "plot",
    "rasterize",
    "read",
    "render",
    "render_planes",
    "scene",
    "symmetric_difference",
    "tiles",
    "trace",
    "union",
    "warp",
]
