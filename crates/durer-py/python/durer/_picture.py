"""Pictures of scenes, maps and heights, and operations on pictures."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _durer
from ._camera import Camera, view_words
from ._options import call, size_text, words
from ._options import threads as count
from ._scene import Scene
from ._scene import scene as of
from ._wkb import to_wkb_list

U8 = NDArray[np.uint8]


class Image:
    """A picture: 8-bit sRGB with straight alpha, row 0 at the top.

    numpy uses its pixels without a copy, and notebooks display it.

    >>> picture = render(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), size=(64, 48))
    >>> picture.pixels.shape, picture.png()[:4]
    ((48, 64, 4), b'\\x89PNG')
    """

    __slots__ = ("camera", "pixels", "unseen")
    pixels: U8
    camera: Camera | None
    unseen: str | None

    def __init__(self, pixels: ArrayLike, *, camera: Camera | None = None, unseen: str | None = None) -> None:
        array = rgba(pixels, "pixels")
        array.flags.writeable = False
        self.pixels = array
        #: The camera of the picture.
        self.camera = camera
        #: The reason if nothing of the model is visible.
        self.unseen = unseen

    @property
    def width(self) -> int:
        """Width in pixels."""
        return int(self.pixels.shape[1])

    @property
    def height(self) -> int:
        """Height in pixels."""
        return int(self.pixels.shape[0])

    @property
    def __array_interface__(self) -> dict[str, Any]:
        return self.pixels.__array_interface__

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        if copy is False and dtype is not None and np.dtype(dtype) != self.pixels.dtype:
            raise ValueError("a picture has bytes; another type needs a copy")
        array = self.pixels if dtype is None else self.pixels.astype(dtype, copy=False)
        return array.copy() if copy and array is self.pixels else array

    def encode(self, format: str = "png", *, quality: int = 90, compression: str = "fast") -> bytes:
        """Returns the picture as the bytes of a ``png``, ``jpg`` or ``webp`` file."""
        if not 1 <= int(quality) <= 100:
            raise ValueError(f"quality is {quality}; it must be 1 to 100")
        if compression not in ("fast", "small"):
            raise ValueError(f"compression is '{compression}'; it must be fast or small")
        return _durer.encode(self.pixels, format, int(quality), compression == "small")

    def png(self, *, compression: str = "fast") -> bytes:
        """Returns the picture as the bytes of a PNG file."""
        return self.encode("png", compression=compression)

    def save(self, path: str | os.PathLike[str], *, quality: int = 90, compression: str = "fast") -> None:
        """Writes a .png, .jpg or .webp file; it is replaced as a whole or not at all."""
        suffix = os.path.splitext(os.fspath(path))[1][1:]
        _durer.deliver(os.fspath(path), self.encode(suffix, quality=quality, compression=compression))

    def to_pil(self) -> Any:
        """Returns the picture as a Pillow image."""
        from PIL import Image as Pillow

        return Pillow.fromarray(self.pixels)

    def _repr_png_(self) -> bytes:
        return self.png()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Image) and np.array_equal(self.pixels, other.pixels)

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return (_image, (np.asarray(self.pixels), self.camera, self.unseen))

    def __repr__(self) -> str:
        return f"<durer.Image {self.width}x{self.height}>"


def _image(pixels: U8, camera: Camera | None, unseen: str | None) -> Image:
    return Image(pixels, camera=camera, unseen=unseen)


def rgba(image: Any, name: str) -> U8:
    """Returns the pixels of an ``Image``, a Pillow image, or an array of bytes with 1, 3 or 4 channels."""
    if isinstance(image, Image):
        return image.pixels
    if hasattr(image, "convert"):
        image = image.convert("RGBA")
    array = np.asarray(image)
    if array.dtype != np.uint8:
        raise TypeError(f"{name} must be bytes (uint8), got {array.dtype}")
    if array.ndim == 2:
        array = np.repeat(array[..., None], 3, axis=2)
    if array.ndim != 3 or array.shape[2] not in (3, 4):
        raise TypeError(f"{name} must be (rows, columns, 4), got {array.shape}")
    if array.shape[2] == 3:
        array = np.concatenate([array, np.full((*array.shape[:2], 1), 255, np.uint8)], axis=2)
    return np.ascontiguousarray(array).view()


class Planes(NamedTuple):
    """The planes of a picture."""

    #: (h, w, 4) bytes; ``None`` if not wanted.
    color: U8 | None
    #: (h, w) float32: distance along the camera's axis, 0 at the background.
    depth: NDArray[np.float32] | None
    #: (h, w) uint32: number of the triangle, 4294967295 at the background.
    item: NDArray[np.uint32] | None
    #: (h, w, 3) float32: unit normal in the world, zeros at the background.
    normal: NDArray[np.float32] | None
    #: The camera.
    camera: Camera | None


def scene_words(
    scene: Scene,
    size: Any,
    camera: Camera | str | None,
    view: str | None,
    azimuth: float | None,
    elevation: float | None,
    ortho: bool | float | None,
    options: Mapping[str, object],
) -> list[str]:
    """Returns the option words for a picture of a scene."""
    own = camera is None and azimuth is None and elevation is None and view == "iso"
    eye = scene._camera if own and scene._camera is not None else camera
    sized = words({"size": None if size is None else size_text(size)})
    return sized + view_words(eye, view, azimuth, elevation, ortho) + words(options)


def render(
    scene: Any,
    size: Any = (640, 480),
    *,
    camera: Camera | str | None = None,
    view: str = "iso",
    azimuth: float | None = None,
    elevation: float | None = None,
    ortho: bool | float = False,
    lights: str | Sequence[str] | None = None,
    shading: str | None = None,
    samples: int = 4,
    background: str = "white",
    cull: str | None = None,
    algorithm: str | None = None,
    shadows: str | None = None,
    threads: int | None = None,
    **options: Any,
) -> Image:
    """Renders a picture of anything that ``durer.scene`` accepts; the pixels are the same as those of ``durer render``.

    ``camera`` is a ``Camera`` or the name of one in the file; without one the scene is fitted into the picture, seen from
    ``view`` or from ``azimuth`` and ``elevation``. Further keyword arguments are the options of the command, with ``_`` for
    ``-``: ``look="studio"``, ``edges=1.5``, ``section=["0,0,1,-5"]``, ``tone_map``, ``style="hidden-line"`` …

    >>> render(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), (8, 8), view="top", background="black").pixels[0, 7]
    array([  0,   0,   0, 255], dtype=uint8)
    """
    made = of(scene)
    named = {
        "light": [lights] if isinstance(lights, str) else lights,
        "shading": shading,
        # Drawings refuse sample counts, so the default is not passed on.
        "aa": None if samples == 4 else samples,
        "background": None if background == "white" else background,
        "cull": cull,
        "algorithm": algorithm,
        "shadows": shadows,
    }
    given = scene_words(made, size, camera, view, azimuth, elevation, ortho, {**named, **options})
    planes = (False, False, False)
    color, _, _, _, eye, unseen = call("render", _durer.render, made._model, given, planes, False, count(threads))
    return Image(color, camera=_seen_from(eye, color), unseen=unseen)


def _seen_from(eye: _durer._CameraNumbers | None, color: U8) -> Camera | None:
    return None if eye is None else Camera._of_native(eye, (int(color.shape[1]), int(color.shape[0])))


def render_planes(
    scene: Any,
    size: Any = (640, 480),
    *,
    color: bool = True,
    depth: bool = True,
    item: bool = False,
    normal: bool = False,
    linear_depth: bool = True,
    camera: Camera | str | None = None,
    view: str = "iso",
    azimuth: float | None = None,
    elevation: float | None = None,
    ortho: bool | float = False,
    threads: int | None = None,
    **options: Any,
) -> Planes:
    """Renders colours, and the depth, triangle and normal at the centre of each pixel.

    Depths are distances along the camera's axis, 0 at the background, as in pyrender; without ``linear_depth`` they are
    window depths, 0 at the near plane and 1 at the far plane.

    >>> triangle = ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> camera = Camera.look_at((0.3, 0.3, 2), (0.3, 0.3, 0), (0, 1, 0))
    >>> colors, depths = render_planes(triangle, (9, 9), camera=camera)[:2]
    >>> float(depths[4, 4])
    2.0
    """
    made = of(scene)
    given = scene_words(made, size, camera, view, azimuth, elevation, ortho, options)
    wanted = (depth, item, normal)
    out = call("render_planes", _durer.render, made._model, given, wanted, linear_depth, count(threads))
    pixels, depths, items, normals, eye, _ = out
    return Planes(pixels if color else None, depths, items, normals, _seen_from(eye, pixels))


#: Formats of vectors that maps and SVG files are drawn as.
VECTORS = ("svg", "pdf", "dxf")


class DrawnImage(Image):
    """A picture of an SVG or a map, which can also be written as vectors.

    >>> picture = draw('<svg xmlns="http://www.w3.org/2000/svg" width="4" height="4"><rect width="4" height="4"/></svg>')
    >>> picture.to_svg()[:5], picture.encode("pdf")[:5]
    ('<svg ', b'%PDF-')
    """

    __slots__ = ("_arguments", "_layers", "_threads")

    def __init__(self, pixels: ArrayLike, arguments: list[str], layers: list[bytes], threads: int) -> None:
        super().__init__(pixels)
        self._arguments, self._layers, self._threads = arguments, layers, threads

    def encode(self, format: str = "png", *, quality: int = 90, compression: str = "fast") -> bytes:
        """Returns the bytes of a ``png``, ``jpg`` or ``webp`` file, or of an ``svg``, ``pdf`` or ``dxf`` file with vectors.

        Vectors are the same as those of ``durer draw -o``; content that a format cannot hold is an error.
        """
        if format.lower() not in (*VECTORS, "png", "jpg", "jpeg", "webp"):
            raise ValueError(f"'{format}' is not a format of maps; there are png, jpg, webp, svg, pdf and dxf")
        if format.lower() not in VECTORS:
            return super().encode(format, quality=quality, compression=compression)
        return call("draw", _durer.draw_vectors, self._arguments, self._layers, format.lower(), self._threads)

    def to_svg(self) -> str:
        """Returns the text of an SVG file."""
        return self.encode("svg").decode()

    def save(self, path: str | os.PathLike[str], *, quality: int = 90, compression: str = "fast") -> None:
        """Writes a file by its suffix: .png, .jpg, .webp, or .svg, .pdf, .dxf with vectors."""
        super().save(path, quality=quality, compression=compression)

    def __reduce__(self) -> tuple[Any, ...]:
        return (DrawnImage, (np.asarray(self.pixels), self._arguments, self._layers, self._threads))


def _layer_name(layer: Any, number: int) -> str:
    """Returns the path of a file, beside which others may be, or a name for data."""
    if not isinstance(layer, str | os.PathLike) or (isinstance(layer, str) and layer.lstrip()[:1] in ("<", "{", "[")):
        return f"layer{number}"
    path = str(os.fspath(layer))
    return os.path.join(os.curdir, path) if path.startswith("-") else path


def _layer_bytes(layer: Any, labelled: bool) -> bytes:
    """Returns the bytes of a layer: those of a file unchanged, or of geometries."""
    if isinstance(layer, bytes | bytearray | memoryview):
        return bytes(layer)
    if isinstance(layer, str) and layer.lstrip()[:1] in ("<", "{", "["):
        return layer.encode()
    if isinstance(layer, str | os.PathLike):
        with open(layer, "rb") as file:
            return file.read()
    if isinstance(layer, Mapping):
        import json

        return json.dumps(layer).encode()
    if labelled and hasattr(layer, "to_json"):
        return str(layer.to_json()).encode()
    return b"".join(part for part in to_wkb_list(layer) if part is not None)


def _styled(layer: Any) -> tuple[Any, dict[str, Any]]:
    if isinstance(layer, tuple) and len(layer) == 2 and isinstance(layer[1], Mapping):
        return layer[0], dict(layer[1])
    return layer, {}


def draw(layers: Any, size: Any = None, *, threads: int | None = None, **options: Any) -> DrawnImage:
    """Draws an SVG, or a map of layers; pixels and vectors are the same as those of ``durer draw``.

    ``layers`` is one layer or a list of them, from the bottom to the top: a path, the text or bytes of an SVG or of map
    data, a GeoJSON mapping, an array of geometries or a GeoDataFrame; or a tuple of one of these and its style, e.g.
    ``(land, {"fill": "tan", "stroke": "none"})``. Further keyword arguments are the options of the command; style
    options apply to all layers. ``save("map.svg")``, ``.pdf`` and ``.dxf`` write vectors, in which each layer has the name
    of its file.

    >>> draw('<svg xmlns="http://www.w3.org/2000/svg" width="4" height="4"><rect width="4" height="4"/></svg>').pixels[0, 0]
    array([  0,   0,   0, 255], dtype=uint8)
    """
    given = layers if isinstance(layers, list) else [layers]
    if not given:
        raise ValueError("layers: there must be one at least")
    line = words({"size": None if size is None else size_text(size), **options})
    contents = []
    for number, layer in enumerate(given):
        what, style = _styled(layer)
        contents.append(_layer_bytes(what, "label" in style or "label" in options))
        line += [_layer_name(what, number), *words(style)]
    pixels = call("draw", _durer.draw_layers, line, contents, count(threads))
    return DrawnImage(pixels, line, contents, count(threads))


class Plot:
    """A plot of heights, drawn for the output format when it is written."""

    __slots__ = ("_heights", "_options", "_ranges", "_svg")

    def __init__(self, heights: NDArray[np.float64], ranges: Any, options: list[str]) -> None:
        self._heights, self._ranges, self._options = heights, ranges, options
        self._svg = self.encode("svg")

    def encode(self, format: str) -> bytes:
        """Returns the bytes of an svg, pdf, dxf, hpgl, gcode or geojson file."""
        return call("plot", _durer.plot, self._heights, self._ranges, self._options, format, count(None))

    def to_svg(self) -> str:
        """Returns the text of an SVG file."""
        return self._svg.decode()

    def image(self, size: Any = None) -> Image:
        """Returns the plot as pixels."""
        options = self._options + words({"size": None if size is None else size_text(size)})
        return Image(call("plot", _durer.plot_pixels, self._heights, self._ranges, options, count(None)))

    def save(self, path: str | os.PathLike[str], *, size: Any = None) -> None:
        """Writes a file by its suffix: .svg, .pdf, .dxf, .hpgl, .gcode, .geojson, or .png, .jpg, .webp."""
        suffix = os.path.splitext(os.fspath(path))[1][1:].lower()
        if suffix in ("png", "jpg", "jpeg", "webp"):
            self.image(size).save(path)
        else:
            _durer.deliver(os.fspath(path), self._svg if suffix == "svg" else self.encode(suffix))

    def _repr_svg_(self) -> str:
        return self.to_svg()


def plot(
    heights: ArrayLike,
    *,
    x: tuple[float, float] | None = None,
    z: tuple[float, float] | None = None,
    **options: Any,
) -> Plot:
    """Plots a surface of heights (rows, columns) without hidden lines, as ``durer plot`` does.

    Rows run along x; the first has the smallest z and is the farthest; NaN is a missing height. ``x`` and ``z``
    are the ranges, by default the numbers of columns and rows. Further keyword arguments are the options of the command:
    ``azimuth``, ``elevation``, ``fill=True``, ``color_map="viridis"``, ``title``, ``labels=("x", "y", "z")`` …

    >>> plot([[0, 1, 0], [1, 2, 1], [0, 1, 0]], title="a hill").to_svg()[:5]
    '<svg '
    """
    array = np.ascontiguousarray(heights, dtype=np.float64)
    if array.ndim != 2:
        raise TypeError(f"heights must be (rows, columns), got {array.shape}")
    if min(array.shape) < 2:
        raise ValueError(f"heights is {array.shape}; a surface has 2 rows and 2 columns at least")
    rows, columns = array.shape
    ranges = (tuple(map(float, x or (0, columns - 1))), tuple(map(float, z or (0, rows - 1))))
    return Plot(array, ranges, words(options))


def color_bytes(color: Any) -> tuple[int, int, int, int]:
    """Returns a colour, given in CSS or as three or four bytes, as bytes with alpha.

    >>> color_bytes("red"), color_bytes((1, 2, 3))
    ((255, 0, 0, 255), (1, 2, 3, 255))
    """
    if isinstance(color, str):
        r, g, b, a = _durer.css_color(color)
        return (r, g, b, a)
    parts = [int(c) for c in color]
    if len(parts) not in (3, 4) or not all(0 <= c <= 255 for c in parts):
        raise ValueError(f"color is {color!r}; it must be a colour of CSS, or three or four numbers 0 to 255")
    r, g, b, a = [*parts, 255][:4]
    return (r, g, b, a)


def fill(
    image: Any,
    at: Any,
    color: Any,
    *,
    tolerance: int = 0,
    connectivity: int = 4,
    boundary: Any = None,
) -> Image:
    """Fills the connected area around one or several pixels (x, y), or with ``boundary`` the area up to that colour.

    >>> import numpy as np
    >>> fill(np.zeros((2, 2, 4), np.uint8), (0, 0), "red").pixels[1, 1]
    array([255,   0,   0, 255], dtype=uint8)
    """
    seeds = np.atleast_2d(np.asarray(at))
    if seeds.ndim != 2 or seeds.shape[1] != 2:
        raise TypeError(f"at must be (x, y) or several of them, got an array of shape {np.shape(at)}")
    if (seeds < 0).any():
        raise IndexError(f"at {tuple(seeds[(seeds < 0).any(axis=1)][0].tolist())} is outside the picture")
    if connectivity not in (4, 8):
        raise ValueError(f"connectivity is {connectivity}; it must be 4 or 8")
    if not 0 <= tolerance <= 255:
        raise ValueError(f"tolerance is {tolerance}; it must be 0 to 255")
    edge = None if boundary is None else color_bytes(boundary)
    points = [(int(x), int(y)) for x, y in seeds]
    pixels, _ = _durer.fill(rgba(image, "image"), points, color_bytes(color), tolerance, edge, connectivity == 8)
    return Image(pixels)


def window_depth(depth: ArrayLike, camera: Camera) -> NDArray[np.float32]:
    """Returns window depths, 0 to 1, from distances along the camera's axis, where 0 is the background."""
    if camera.near is None or camera.far is None:
        raise ValueError("near and far: the camera has none; that of a picture does")
    z = np.asarray(depth, dtype=np.float64)
    near, far = camera.near, camera.far
    if camera.ortho is not None:
        window = (z - near) / (far - near)
    else:
        with np.errstate(divide="ignore", invalid="ignore"):
            window = far * (z - near) / (z * (far - near))
    return np.ascontiguousarray(np.where(z > 0.0, np.clip(window, 0.0, 1.0), 1.0), dtype=np.float32)


def warp(
    image: Any,
    depth: ArrayLike,
    camera: Camera,
    to: Camera,
    *,
    size: tuple[int, int] | None = None,
    holes: Any = "#ff00ff",
    linear_depth: bool = True,
    fill: tuple[Any, ArrayLike, Camera] | None = None,
    threads: int | None = None,
) -> Image:
    """Computes the view of a nearby camera from a picture and its depths, as ``durer warp``.

    ``fill`` is a second picture with its depths and camera, which fills holes.

    >>> triangle = ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> color, depth, *_, camera = render_planes(triangle, (32, 32), samples=1)
    >>> bool((warp(color, depth, camera, camera).pixels == color).all())
    True
    """
    sources = []
    for color, depths, eye in [(image, depth, camera), *([fill] if fill else [])]:
        window = window_depth(depths, eye) if linear_depth else np.ascontiguousarray(depths, dtype=np.float32)
        if window.ndim != 2:
            raise TypeError(f"depth must be (rows, columns), got {window.shape}")
        sources.append((rgba(color, "image"), window, eye._native()))
    height, width = sources[0][1].shape
    new = to if to.near is not None and to.far is not None else to.with_planes(camera.near or 0.0, camera.far or 0.0)
    out, _, _ = _durer.warped(sources, new._native(), size or (width, height), color_bytes(holes), count(threads))
    return Image(out, camera=new)


def tiles(
    layers: Any,
    output: str | os.PathLike[str],
    *,
    zoom: str | int | tuple[int, int] | None = None,
    names: Sequence[str] | None = None,
    threads: int | None = None,
    **options: Any,
) -> None:
    """Cuts layers of map data into web tiles, as ``durer tiles`` does: into .pmtiles, .mbtiles, or a folder.

    Layers are as in ``draw``; fields of files, GeoJSON and GeoDataFrames are kept. Without ``zoom``, the levels follow
    from the detail of the data.
    """
    given = layers if isinstance(layers, list) else [layers]
    zooms = zoom if zoom is None or isinstance(zoom, str) else str(zoom) if isinstance(zoom, int) else f"{zoom[0]}-{zoom[1]}"
    # Imported here, as this takes longer than importing the whole package.
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        inputs = []
        for number, layer in enumerate(given):
            if isinstance(layer, str | os.PathLike) and os.path.exists(layer):
                inputs.append(os.fspath(layer))
                continue
            data = _layer_bytes(layer, True)
            path = os.path.join(folder, f"layer{number}" + (".geojson" if data[:1] in b"{[" else ".wkb"))
            with open(path, "wb") as file:
                file.write(data)
            inputs.append(path)
        line = [*inputs, f"--output={os.fspath(output)}"]
        line += words({"zoom": zooms, "layer": None if names is None else list(names), **options})
        call("tiles", _durer.tiles, line, count(threads))

