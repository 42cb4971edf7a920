"""Exact drawings: lines in the plane of the picture, and drawings on paper."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _durer
from ._camera import Camera
from ._options import call, size_text, words
from ._options import threads as count
from ._picture import Image, scene_words
from ._scene import Scene
from ._scene import scene as of

#: Names of the classes of lines; ``Lines.cls`` has their indices.
LINE_CLASSES: tuple[str, ...] = tuple(_durer.line_classes())

PICTURES = ("png", "jpg", "jpeg", "webp")


class Drawing:
    """A drawing of a scene, laid out for the output format when it is written."""

    __slots__ = ("_arguments", "_scene", "_size", "_svg", "_threads")

    def __init__(self, scene: Scene, arguments: list[str], size: Any, threads: int) -> None:
        self._scene, self._arguments, self._size, self._threads = scene, arguments, size, threads
        self._svg: bytes | None = None

    def encode(self, format: str = "svg") -> bytes:
        """Returns the bytes of an svg, pdf, dxf, hpgl, gcode or geojson file, the same as from ``durer render -o``."""
        if format == "svg" and self._svg is not None:
            return self._svg
        data = call("drawing", _durer.draw, self._scene._model, self._arguments, format, self._threads)
        if format == "svg":
            self._svg = data
        return data

    def to_svg(self) -> str:
        """Returns the text of an SVG file."""
        return self.encode("svg").decode()

    def image(self) -> Image:
        """Returns the drawing as pixels, of the given size."""
        given = [f"--size={size_text(self._size)}", *self._arguments]
        if not any(word.startswith(("--style", "--sheet")) for word in given):
            given = [*given, "--style=hidden-line"]
        planes = (False, False, False)
        out = call("drawing", _durer.render, self._scene._model, given, planes, False, self._threads)
        return Image(out[0], unseen=out[5])

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a file by its suffix: .svg, .pdf, .dxf, .hpgl, .gcode, .geojson, or .png, .jpg, .webp."""
        suffix = os.path.splitext(os.fspath(path))[1][1:].lower()
        if suffix in PICTURES:
            self.image().save(path)
        else:
            _durer.deliver(os.fspath(path), self.encode(suffix))

    def _repr_svg_(self) -> str:
        return self.to_svg()

    def __repr__(self) -> str:
        return f"<durer.Drawing of {self._scene!r}>"


class Lines:
    """Lines in the plane of the picture, x to the right and y upwards, in world units where the view is parallel.

    Line i has the points ``coords[offsets[i]:offsets[i + 1]]``, the class ``LINE_CLASSES[cls[i]]`` and
    ``invisibility[i]`` surfaces in front of it; the last point of a closed line is joined to its first.
    """

    __slots__ = ("closed", "cls", "coords", "drawing", "invisibility", "offsets")
    coords: NDArray[np.float64]
    offsets: NDArray[np.int64]
    cls: NDArray[np.uint8]
    invisibility: NDArray[np.uint32]
    closed: NDArray[np.bool_]
    drawing: Drawing

    def __init__(
        self,
        coords: NDArray[np.float64],
        offsets: NDArray[np.int64],
        cls: NDArray[np.uint8],
        invisibility: NDArray[np.uint32],
        closed: NDArray[np.bool_],
        drawing: Drawing,
    ) -> None:
        self.coords, self.offsets, self.cls = coords, offsets, cls
        self.invisibility, self.closed, self.drawing = invisibility, closed, drawing

    def __len__(self) -> int:
        return len(self.cls)

    def chains(self) -> list[NDArray[np.float64]]:
        """Returns the points of each line, (n, 2); closed lines repeat the first point at the end."""
        parts = np.split(self.coords, self.offsets[1:-1]) if len(self) else []
        return [np.vstack([p, p[:1]]) if c else p for p, c in zip(parts, self.closed, strict=True)]

    def to_shapely(self) -> NDArray[Any]:
        """Returns an array of shapely LineStrings."""
        import shapely

        chains = self.chains()
        numbers = np.repeat(np.arange(len(chains)), [len(chain) for chain in chains])
        out = shapely.linestrings(np.concatenate([*chains, np.zeros((0, 2))]), indices=numbers)
        return np.asarray(out, dtype=object)

    def to_vpype(self, millimetres: float = 1.0) -> Any:
        """Returns a vpype line collection, in pixels with y down; a unit of the plane is ``millimetres`` long."""
        import vpype

        scale = millimetres * 96.0 / 25.4
        return vpype.LineCollection([scale * (c[:, 0] - 1j * c[:, 1]) for c in self.chains()])

    def to_svg(self) -> str:
        """Returns the text of an SVG file."""
        return self.drawing.to_svg()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a file by its suffix: .svg, .pdf, .dxf, .hpgl, .gcode, .geojson, or .png, .jpg, .webp."""
        self.drawing.save(path)

    def _repr_svg_(self) -> str:
        return self.to_svg()

    def __repr__(self) -> str:
        return f"<durer.Lines: {len(self)} lines, {len(self.coords)} points>"


def hidden_lines(
    scene: Any,
    *,
    camera: Camera | str | None = None,
    view: str = "iso",
    azimuth: float | None = None,
    elevation: float | None = None,
    ortho: bool | float = True,
    hidden: bool = True,
    crease: float = 30.0,
    classes: Sequence[str] | None = None,
    size: Any = (1024, 1024),
    threads: int | None = None,
    **options: Any,
) -> Lines:
    """Finds the visible and hidden edges of a scene exactly.

    Edges are drawn where faces meet at more than ``crease`` degrees, and silhouettes; ``classes`` chooses among
    ``LINE_CLASSES``. The view is parallel unless ``camera`` is in perspective or ``ortho`` is false.

    >>> cube = ([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)],
    ...         [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
    ...          [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
    >>> lines = hidden_lines(cube)
    >>> int((lines.invisibility > 0).sum()) > 0, len(hidden_lines(cube, hidden=False)) < len(lines)
    (True, True)
    """
    made = of(scene)
    creased = {} if crease == 30.0 else {"crease": crease}
    chosen = {} if classes is None else {"lines": ",".join(classes)}
    lens = {} if ortho is not False or camera is not None else {"fov": options.pop("fov", 30.0)}
    height = False if camera is not None or ortho is False else ortho
    given = scene_words(made, None, camera, view, azimuth, elevation, height, {**lens, **creased, **chosen, **options})
    native = count(threads)
    coords, offsets, cls, invisibility, closed = call("hidden_lines", _durer.lines, made._model, given, native)
    if not hidden:
        kept = invisibility == 0
        lengths = np.diff(offsets)
        coords = coords[np.repeat(kept, lengths)]
        offsets = np.concatenate([[0], np.cumsum(lengths[kept])]).astype(np.int64)
        cls, invisibility, closed = cls[kept], invisibility[kept], closed[kept]
    drawn = Drawing(made, [*given, "--hidden=dashed" if hidden else "--hidden=drop"], size, native)
    return Lines(coords, offsets, cls, invisibility, closed, drawn)


def drawing(
    scene: Any,
    style: str = "hidden-line",
    page: Any = None,
    *,
    camera: Camera | str | None = None,
    view: str = "iso",
    azimuth: float | None = None,
    elevation: float | None = None,
    ortho: bool | float | None = None,
    size: Any = (1024, 1024),
    threads: int | None = None,
    **options: Any,
) -> Drawing:
    """Draws a scene on paper: hidden-line, wireframe, regions, regions+lines or shadows.

    ``page`` is a size such as ``"A4"`` or (width, height) in millimetres. Further keyword arguments are the options of
    ``durer render``: ``hidden="dashed"``, ``scale="1:2"``, ``sheet="third-angle"``, ``hatch="shade"``, ``dimension`` …

    >>> drawing(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), page="A5").to_svg()[:5]
    '<svg '
    """
    made = of(scene)
    paper = page if page is None or isinstance(page, str) else "x".join(f"{float(side):g}" for side in page)
    on_sheet = options.get("sheet") is not None
    seen = None if on_sheet and view == "iso" else view
    named = {"style": style, "page": paper, **options}
    given = scene_words(made, None, camera, seen, azimuth, elevation, ortho, named)
    drawn = Drawing(made, given, size, count(threads))
    drawn.encode("svg")
    return drawn
