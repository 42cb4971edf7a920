"""Scenes: models from files, from arrays, and from objects of other libraries."""

from __future__ import annotations

import os
import warnings
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _durer
from ._camera import Camera
from ._errors import ReadWarning

F64 = NDArray[np.float64]


class Scene:
    """A model in memory: meshes with materials, lights and cameras. It never changes, and can be pickled."""

    __slots__ = ("_camera", "_model")
    _model: _durer.Model
    _camera: Camera | None

    def __init__(self) -> None:
        raise TypeError("durer.scene(…) and durer.read(…) make scenes")

    @classmethod
    def _of(cls, model: _durer.Model, camera: Camera | None = None) -> Scene:
        made = cls.__new__(cls)
        made._model, made._camera = model, camera
        return made

    @classmethod
    def _of_bytes(cls, data: bytes, camera: Camera | None) -> Scene:
        return cls._of(_durer.Model.from_bytes(data), camera)

    @property
    def bounds(self) -> F64 | None:
        """Lower and upper corner of the bounding box, (2, 3); ``None`` if the scene is empty."""
        bounds = self._model.bounds()
        return None if bounds is None else np.array(bounds, dtype=np.float64)

    @property
    def triangle_count(self) -> int:
        """Number of triangles over all instances."""
        return self._model.triangle_count

    @property
    def warnings(self) -> list[str]:
        """Messages about repaired or omitted parts of the file."""
        return self._model.warnings

    def info(self) -> dict[str, Any]:
        """Returns counts and names: format, up axis, triangles, materials, cameras, animations."""
        return self._model.info()

    def pick(
        self, x: float, y: float, camera: Camera, size: tuple[int, int] | None = None
    ) -> list[dict[str, Any]]:
        """Returns the hits behind a point of a picture, in pixels from its upper left corner, nearest first.

        Each is a dict of ``kind``, ``item`` (as in the item plane), ``instance``, ``index`` in its mesh, ``depth`` in the
        window and ``position`` in the world.

        >>> triangle = scene(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
        >>> camera = Camera.fit(triangle, "top", size=(64, 64))
        >>> [hit["item"] for hit in triangle.pick(20, 40, camera)]
        [0]
        """
        size = size or camera.size
        if size is None:
            raise ValueError("size: the camera has none; give (width, height) of the picture")
        hits = _durer.picked(self._model, camera._native(), size, (float(x), float(y)))
        names = ("kind", "item", "instance", "index", "depth", "position")
        return [dict(zip(names, hit, strict=True)) for hit in hits]

    def __reduce__(self) -> tuple[Any, ...]:
        return (Scene._of_bytes, (self._model.to_bytes(), self._camera))

    def __repr__(self) -> str:
        return f"<durer.Scene {self._model.name!r}: {self.triangle_count} triangles>"

    def _repr_png_(self) -> bytes:
        from ._picture import render

        return render(self)._repr_png_()


def read(
    src: str | os.PathLike[str] | bytes | bytearray | memoryview | BinaryIO,
    *,
    name: str | None = None,
    pose: float | tuple[str, float] | None = None,
    limits: dict[str, int] | None = None,
    threads: int | None = None,
) -> Scene:
    """Reads a model: glTF, OBJ, STL, PLY, 3MF, COLLADA, OFF, and points in LAS, LAZ, E57, XYZ.

    ``src`` is a path, bytes, or an open binary file; files that the model refers to are found only beside a path. ``name``,
    a file name, gives the format if the content does not. ``pose`` is a time of the first animation, or (name, time).
    ``limits`` may set ``triangles`` and ``bytes``. Repairs are reported as ``ReadWarning`` and kept in ``Scene.warnings``.

    Raises ``ReadError`` with the place of the fault, ``LimitError``, and ``OSError`` for files.

    >>> read(b"OFF\\n3 1 0\\n0 0 0\\n1 0 0\\n0 1 0\\n3 0 1 2\\n", name="a.off").triangle_count
    1
    """
    from ._options import threads as count

    path: str | None = None
    if isinstance(src, str | os.PathLike):
        path = os.fspath(src)
        with open(path, "rb") as file:
            data = file.read()
        name = name or os.path.basename(path)
    elif isinstance(src, bytes):
        data = src
    elif isinstance(src, bytearray | memoryview):
        data = bytes(src)
    elif hasattr(src, "read"):
        data = src.read()
        if not isinstance(data, bytes):
            raise TypeError("the file must be open in binary mode")
        given = getattr(src, "name", None)
        name = name or (os.path.basename(given) if isinstance(given, str) else None)
    else:
        raise TypeError(f"a path, bytes or an open file is needed, got {type(src).__name__}")
    limits = dict(limits or {})
    bounds = (limits.pop("triangles", None), limits.pop("bytes", None))
    if limits:
        raise TypeError(f"limits has {', '.join(map(repr, limits))}; there are 'triangles' and 'bytes'")
    at: tuple[str | None, float | None] = (None, None)
    if isinstance(pose, tuple):
        at = (str(pose[0]), float(pose[1]))
    elif pose is not None:
        at = (None, float(pose))
    model = _durer.read(data, name or "", path, count(threads), bounds, at)
    for message in model.warnings:
        warnings.warn(f"{name}: {message}" if name else message, ReadWarning, stacklevel=2)
    return Scene._of(model)


def scene(obj: Any, *, up_axis: str | None = None) -> Scene:
    """Returns a scene from almost any object that holds triangles.

    ``obj`` is a ``Scene``, a path or bytes, ``(vertices, faces)``, a ``trimesh.Trimesh`` or ``trimesh.Scene``, a
    ``pyvista.PolyData``, or a ``pyrender.Scene`` or ``Mesh``. Colours, textures, names and poses are kept;
    ``up_axis`` defaults to z, or y for pyrender.

    Raises ``ValueError`` for a face with a vertex that does not exist, and for vertices that are not finite;
    ``TypeError`` for arrays of other shapes.

    >>> scene(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])).bounds.tolist()
    [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]]
    """
    if isinstance(obj, Scene):
        return obj
    if isinstance(obj, str | os.PathLike | bytes | bytearray | memoryview):
        return read(obj)
    parts = _Parts()
    camera = None
    if hasattr(obj, "mesh_nodes") and hasattr(obj, "get_pose"):
        up_axis = up_axis or "y"
        for node in obj.mesh_nodes:
            _add_pyrender(parts, node.mesh, [obj.get_pose(node)])
        camera = _pyrender_camera(obj)
    elif hasattr(obj, "primitives") and hasattr(obj, "is_transparent"):
        up_axis = up_axis or "y"
        _add_pyrender(parts, obj, [np.eye(4)])
    elif hasattr(obj, "geometry") and hasattr(obj, "graph"):
        _add_trimesh_scene(parts, obj)
    elif hasattr(obj, "points") and hasattr(obj, "faces") and hasattr(obj, "n_points"):
        _add_pyvista(parts, obj)
    elif hasattr(obj, "vertices") and hasattr(obj, "faces"):
        _add_trimesh(parts, obj, [np.eye(4)], "")
    elif isinstance(obj, tuple | list) and len(obj) == 2:
        parts.add(obj[0], obj[1])
    else:
        message = "a Scene, a path, (vertices, faces), or an object of trimesh, pyvista or pyrender is needed"
        raise TypeError(f"{message}, got {type(obj).__name__}")
    model = _durer.scene_of(parts.meshes, parts.materials, up_axis or "z", parts.name)
    return Scene._of(model, camera)


class _Mesh(NamedTuple):
    """The arrays of one mesh, for the native module."""

    vertices: F64
    faces: NDArray[np.int64]
    normals: NDArray[np.float32] | None
    colors: NDArray[np.float32] | None
    tex_coords: NDArray[np.float32] | None
    poses: list[F64]
    material: int | None
    name: str


class _Material(NamedTuple):
    """The numbers of one material, for the native module."""

    name: str
    color: list[float]
    metallic: float
    roughness: float
    is_physical: bool
    double_sided: bool
    is_blended: bool
    texture: NDArray[np.uint8] | None


def _array(value: Any, dtype: Any, name: str) -> Any:
    """Returns a two-dimensional array, contiguous in memory."""
    try:
        array = np.ascontiguousarray(value, dtype=dtype)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name} must be an array of numbers: {error}") from None
    if array.ndim == 1 and array.size == 0:
        array = array.reshape(0, 3)
    if array.ndim != 2:
        raise TypeError(f"{name} must be (n, 3), got {array.shape}")
    return array


class _Parts:
    """Meshes and materials in the form of the native module."""

    def __init__(self) -> None:
        self.meshes: list[_Mesh] = []
        self.materials: list[_Material] = []
        self.name = ""

    def add(
        self,
        vertices: Any,
        faces: Any,
        *,
        normals: Any = None,
        colors: Any = None,
        uv: Any = None,
        poses: Any = None,
        material: int | None = None,
        name: str = "",
    ) -> None:
        mesh = _Mesh(
            vertices=_array(vertices, np.float64, "vertices"),
            faces=_indices(faces),
            normals=None if normals is None else _array(normals, np.float32, "normals"),
            colors=None if colors is None else _linear(colors),
            tex_coords=None if uv is None else _array(np.asarray(uv)[:, :2], np.float32, "uv"),
            poses=[np.ascontiguousarray(p, dtype=np.float64) for p in ([np.eye(4)] if poses is None else poses)],
            material=material,
            name=name,
        )
        self.meshes.append(mesh)

    def material(
        self,
        *,
        name: str = "",
        color: Any = (1.0, 1.0, 1.0, 1.0),
        metallic: float = 0.0,
        roughness: float = 1.0,
        physical: bool = False,
        double_sided: bool = True,
        blended: bool = False,
        texture: Any = None,
    ) -> int:
        material = _Material(
            name=str(name or ""),
            color=[float(c) for c in color],
            metallic=float(metallic),
            roughness=float(roughness),
            is_physical=physical,
            double_sided=bool(double_sided),
            is_blended=blended,
            texture=None if texture is None else _rgba(texture),
        )
        self.materials.append(material)
        return len(self.materials) - 1


def _indices(faces: Any) -> NDArray[np.int64]:
    array = np.asarray(faces)
    if array.dtype.kind == "f" and array.size:
        raise TypeError(f"faces must be whole numbers, got {array.dtype}")
    return _array(array, np.int64, "faces")  # type: ignore[no-any-return]


def _bytes(colors: Any) -> NDArray[np.uint8]:
    """Returns sRGB colours with alpha as bytes, from bytes or from numbers from 0 to 1."""
    array = np.asarray(colors)
    if array.dtype.kind == "f":
        array = np.clip(np.rint(array * 255.0), 0, 255)
    array = np.atleast_2d(array).astype(np.uint8)
    if array.shape[-1] == 3:
        opaque = np.full((*array.shape[:-1], 1), 255, np.uint8)
        array = np.concatenate([array, opaque], axis=-1)
    return np.ascontiguousarray(array)


def _linear(colors: Any) -> NDArray[np.float32]:
    array = _bytes(colors)
    return _durer.linear_of_srgb(array.reshape(-1)).reshape(array.shape)


def _rgba(image: Any) -> NDArray[np.uint8]:
    """Returns the pixels of a Pillow image or an array."""
    if hasattr(image, "convert"):
        image = image.convert("RGBA")
    array = np.asarray(image)
    if array.ndim == 2:
        array = np.repeat(array[..., None], 3, axis=2)
    if array.shape[-1] == 3:
        array = np.concatenate([array, np.full((*array.shape[:-1], 1), 255, array.dtype)], axis=-1)
    return np.ascontiguousarray(array, dtype=np.uint8)


def _add_trimesh_scene(parts: _Parts, obj: Any) -> None:
    places: dict[str, list[Any]] = {}
    for node in obj.graph.nodes_geometry:
        matrix, name = obj.graph[node]
        places.setdefault(name, []).append(matrix)
    for name, poses in places.items():
        geometry = obj.geometry[name]
        if hasattr(geometry, "faces"):
            _add_trimesh(parts, geometry, poses, str(name))
        elif hasattr(geometry, "vertices"):
            count = len(geometry.vertices)
            if hasattr(geometry, "vertex_nodes"):
                parts.add(_in_space(geometry.vertices), geometry.vertex_nodes, poses=poses, name=str(name))
            else:
                parts.add(geometry.vertices, np.arange(count)[:, None], poses=poses, name=str(name))


def _in_space(points: Any) -> F64:
    array = np.asarray(points, dtype=np.float64)
    if array.shape[1] == 2:
        array = np.column_stack([array, np.zeros(len(array))])
    return array


def _add_trimesh(parts: _Parts, mesh: Any, poses: Any, name: str) -> None:
    vertices, faces = mesh.vertices, mesh.faces
    visual = getattr(mesh, "visual", None)
    kind = getattr(visual, "kind", None)
    colors, uv, material = None, None, None
    if kind == "vertex":
        colors = visual.vertex_colors  # type: ignore[union-attr]
    elif kind == "face":
        faces = np.asarray(faces)
        vertices = np.asarray(vertices)[faces].reshape(-1, 3)
        colors = np.repeat(np.asarray(visual.face_colors), 3, axis=0)  # type: ignore[union-attr]
        faces = np.arange(len(vertices)).reshape(-1, 3)
    elif kind == "texture":
        uv = getattr(visual, "uv", None)
        material = _trimesh_material(parts, getattr(visual, "material", None), uv is not None)
    if colors is not None:
        has_alpha = _bytes(colors)[:, 3].min(initial=255) < 255
        material = parts.material(blended=bool(has_alpha))
    parts.add(vertices, faces, colors=colors, uv=uv, poses=poses, material=material, name=name)


def _trimesh_material(parts: _Parts, material: Any, has_uv: bool) -> int | None:
    if material is None:
        return None
    physical = hasattr(material, "baseColorFactor")
    image = getattr(material, "baseColorTexture", None) if physical else getattr(material, "image", None)
    texture = image if has_uv else None
    if not physical:
        color = (1.0,) * 4 if texture is not None else _linear(material.main_color)[0]
        return parts.material(name=getattr(material, "name", ""), color=color, texture=texture)
    factor = material.baseColorFactor
    color = (1.0,) * 4 if factor is None else _linear(factor)[0]
    metallic, roughness = material.metallicFactor, material.roughnessFactor
    return parts.material(
        name=material.name,
        color=color,
        metallic=1.0 if metallic is None else metallic,
        roughness=1.0 if roughness is None else roughness,
        physical=True,
        double_sided=bool(material.doubleSided),
        texture=texture,
    )


def _polygons(faces: Any) -> NDArray[np.int64]:
    """Returns the triangles of faces in VTK's layout: for each face its number of vertices, then the vertices."""
    flat = np.asarray(faces, dtype=np.int64).reshape(-1)
    if flat.size == 0:
        return np.zeros((0, 3), np.int64)
    sides = int(flat[0])
    if sides > 2 and flat.size % (sides + 1) == 0:
        rows = flat.reshape(-1, sides + 1)
        if (rows[:, 0] == sides).all():
            fans = [rows[:, [1, i, i + 1]] for i in range(2, sides)]
            return np.ascontiguousarray(np.stack(fans, axis=1).reshape(-1, 3))
    triangles: list[tuple[int, int, int]] = []
    at = 0
    while at < flat.size:
        sides = int(flat[at])
        face = flat[at + 1 : at + 1 + sides]
        if sides < 0 or len(face) < sides:
            raise ValueError(f"faces: at {at} a face of {sides} vertices does not end")
        triangles.extend((int(face[0]), int(face[i]), int(face[i + 1])) for i in range(1, sides - 1))
        at += 1 + sides
    return np.array(triangles, np.int64).reshape(-1, 3)


def _add_pyvista(parts: _Parts, mesh: Any) -> None:
    colors = None
    for name in ("RGBA", "RGB"):
        if name in getattr(mesh, "point_data", {}):
            colors = mesh.point_data[name]
            break
    faces = _polygons(mesh.faces)
    parts.add(mesh.points, faces, colors=colors)


def _add_pyrender(parts: _Parts, mesh: Any, poses: list[Any]) -> None:
    for primitive in mesh.primitives:
        indices = primitive.indices
        count = len(primitive.positions)
        sides = {0: 1, 1: 2, 4: 3}.get(primitive.mode, 0)
        if not sides:
            raise ValueError(f"a primitive has mode {primitive.mode}; points, lines and triangles are shown: 0, 1 and 4")
        faces = np.arange(count) if indices is None else np.asarray(indices)
        own = [pose @ place for pose in poses for place in (primitive.poses if primitive.poses is not None else [np.eye(4)])]
        material, m = None, primitive.material
        texture = getattr(getattr(m, "baseColorTexture", None), "source", None)
        if m is not None:
            factor = getattr(m, "baseColorFactor", None)
            material = parts.material(
                name=m.name or "",
                color=(1.0,) * 4 if factor is None else factor,
                metallic=getattr(m, "metallicFactor", 0.0),
                roughness=getattr(m, "roughnessFactor", 1.0),
                physical=True,
                double_sided=m.doubleSided,
                texture=texture if primitive.texcoord_0 is not None else None,
            )
        parts.add(
            primitive.positions,
            faces.reshape(-1, sides),
            normals=primitive.normals,
            colors=primitive.color_0,
            uv=primitive.texcoord_0,
            poses=own,
            material=material,
            name=mesh.name or "",
        )


def _pyrender_camera(obj: Any) -> Camera | None:
    node = getattr(obj, "main_camera_node", None)
    if node is None:
        return None
    camera, pose = node.camera, obj.get_pose(node)
    near, far = getattr(camera, "znear", None), getattr(camera, "zfar", None)
    if hasattr(camera, "yfov"):
        return Camera(pose, fov=float(np.degrees(camera.yfov)), near=near, far=far)
    if hasattr(camera, "ymag"):
        return Camera(pose, ortho=2.0 * camera.ymag, near=near, far=far)
    return None
