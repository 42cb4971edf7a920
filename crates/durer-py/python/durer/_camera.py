"""Cameras."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _durer
from ._options import call, size_text, threads, words

Vector = tuple[float, float, float]
F64 = NDArray[np.float64]


def _vector(value: ArrayLike, name: str) -> Vector:
    v = np.asarray(value, dtype=np.float64)
    if v.shape != (3,):
        raise TypeError(f"{name} must be three numbers, got an array of shape {v.shape}")
    if not np.isfinite(v).all():
        raise ValueError(f"{name} is {tuple(v.tolist())}; it must be finite")
    x, y, z = v.tolist()
    return (x, y, z)


def _lens(fov: float | None, ortho: float | None) -> tuple[float | None, float | None]:
    if fov is not None and ortho is not None:
        raise ValueError("fov and ortho: a camera has one of the two")
    if fov is not None and not 0.0 < fov < 180.0:
        raise ValueError(f"fov is {fov}; it must be between 0 and 180 degrees")
    if ortho is not None and not (ortho > 0.0 and math.isfinite(ortho)):
        raise ValueError(f"ortho is {ortho}; it must be a finite height above 0")
    return (None, float(ortho)) if ortho is not None else (30.0 if fov is None else float(fov), None)


def _of_intrinsics(matrix: ArrayLike, size: tuple[int, int] | None) -> float:
    """Returns the vertical angle of view, in degrees, of a pinhole camera's matrix."""
    k = np.asarray(matrix, dtype=np.float64)
    if k.shape != (3, 3):
        raise TypeError(f"K must be (3, 3), got {k.shape}")
    if size is None:
        raise ValueError("K: its unit is the pixel, so size=(width, height) must be given, too")
    width, height = size
    fx, fy, cx, cy = float(k[0, 0]), float(k[1, 1]), float(k[0, 2]), float(k[1, 2])
    if not fx > 0.0 or abs(fx - fy) > 1e-6 * fx or abs(float(k[0, 1])) > 1e-6 * fx:
        raise ValueError(f"K has fx = {fx:g}, fy = {fy:g}, skew {k[0, 1]:g}; pixels must be square")
    if abs(cx - width / 2) > 1.0 or abs(cy - height / 2) > 1.0:
        middle = f"({width / 2:g}, {height / 2:g})"
        raise ValueError(f"K has its principal point at ({cx:g}, {cy:g}); it must be the middle, {middle}")
    return math.degrees(2.0 * math.atan2(height / 2, fy))


class _Numbers(NamedTuple):
    eye: Vector
    target: Vector
    up: Vector | None
    fov: float | None
    ortho: float | None
    near: float | None
    far: float | None
    size: tuple[int, int] | None


class Camera:
    """A camera in the world: it looks along -z of its pose, y up, as in OpenGL, trimesh and pyrender.

    ``pose`` takes the camera's coordinates to the world's; with ``convention="opencv"`` it looks along +z, y down.
    ``fov`` is the vertical angle of view in degrees, ``ortho`` the height of a parallel view in world units, ``K`` the
    matrix of a pinhole camera for pictures of ``size`` pixels. ``near`` and ``far`` default to planes around the scene.

    >>> import numpy as np
    >>> pose = np.eye(4)
    >>> pose[2, 3] = 5.0
    >>> Camera(pose, fov=45).eye
    (0.0, 0.0, 5.0)
    """

    __slots__ = ("_n",)
    _n: _Numbers

    def __init__(
        self,
        pose: ArrayLike,
        *,
        fov: float | None = None,
        K: ArrayLike | None = None,
        ortho: float | None = None,
        near: float | None = None,
        far: float | None = None,
        size: tuple[int, int] | None = None,
        convention: str = "opengl",
    ) -> None:
        m = np.asarray(pose, dtype=np.float64)
        if m.shape != (4, 4):
            raise TypeError(f"pose must be (4, 4), got {m.shape}")
        turn = m[:3, :3]
        if not np.isfinite(m).all() or not np.allclose(turn.T @ turn, np.eye(3), atol=1e-6) or np.linalg.det(turn) < 0:
            raise ValueError("pose: its first three rows and columns must be a rotation")
        if convention not in ("opengl", "opencv"):
            raise ValueError(f"convention is '{convention}'; it must be opengl or opencv")
        sign = 1.0 if convention == "opengl" else -1.0
        if K is not None:
            if fov is not None or ortho is not None:
                raise ValueError("K: it says the angle of view, so neither fov nor ortho goes with it")
            fov = _of_intrinsics(K, size)
        degrees, height = _lens(fov, ortho)
        eye = m[:3, 3]
        target, up = eye - sign * turn[:, 2], sign * turn[:, 1]
        self._n = _Numbers(
            _vector(eye, "pose"), _vector(target, "pose"), _vector(up, "pose"), degrees, height, near, far, size
        )

    @classmethod
    def _of(cls, numbers: _Numbers) -> Camera:
        camera = cls.__new__(cls)
        camera._n = numbers
        return camera

    @classmethod
    def _of_native(cls, native: _durer._CameraNumbers, size: tuple[int, int]) -> Camera:
        eye, target, up, fov, height, near, far = native
        degrees = None if fov is None else math.degrees(fov)
        vectors = (_vector(eye, "eye"), _vector(target, "target"), _vector(up, "up"))
        return cls._of(_Numbers(*vectors, degrees, height, near, far, size))

    @classmethod
    def look_at(
        cls,
        eye: ArrayLike,
        target: ArrayLike,
        up: ArrayLike | None = None,
        *,
        fov: float | None = None,
        ortho: float | None = None,
        near: float | None = None,
        far: float | None = None,
        size: tuple[int, int] | None = None,
    ) -> Camera:
        """Creates a camera at ``eye`` that looks at ``target``; ``up`` defaults to the up axis of the scene.

        >>> Camera.look_at((3, 0, 0), (0, 0, 0), (0, 0, 1), ortho=2.0).pose.round(6)[:3, 2]
        array([1., 0., 0.])
        """
        degrees, height = _lens(fov, ortho)
        e, t = _vector(eye, "eye"), _vector(target, "target")
        if e == t:
            raise ValueError("target must be a point other than the eye")
        return cls._of(_Numbers(e, t, None if up is None else _vector(up, "up"), degrees, height, near, far, size))

    @classmethod
    def fit(
        cls,
        scene: Any,
        view: str = "iso",
        *,
        azimuth: float | None = None,
        elevation: float | None = None,
        size: Any = (640, 480),
        fov: float | None = None,
        ortho: bool | float = False,
    ) -> Camera:
        """Creates the camera that ``render`` uses: it sees the whole scene from a direction.

        >>> Camera.fit(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), "front").size
        (640, 480)
        """
        from ._scene import scene as of

        options = view_words(None, view, azimuth, elevation, ortho)
        given = words({"size": size_text(size), "fov": fov}) + options
        numbers, (width, height) = call("Camera.fit", _durer.fit, of(scene)._model, given, threads(None))
        return cls._of_native(numbers, (width, height))

    @property
    def eye(self) -> Vector:
        """Position of the eye."""
        return self._n.eye

    @property
    def target(self) -> Vector:
        """A point in the middle of the picture."""
        return self._n.target

    @property
    def up(self) -> Vector | None:
        """Direction that points up in the picture; ``None`` for the up axis of the scene."""
        return self._n.up

    @property
    def fov(self) -> float | None:
        """Vertical angle of view in degrees; ``None`` for a parallel view."""
        return self._n.fov

    @property
    def ortho(self) -> float | None:
        """Height of a parallel view in world units."""
        return self._n.ortho

    @property
    def near(self) -> float | None:
        """Distance of the near plane; ``None`` if it comes from the scene."""
        return self._n.near

    @property
    def far(self) -> float | None:
        """Distance of the far plane; ``None`` if it comes from the scene."""
        return self._n.far

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height, in pixels, of the pictures taken with it."""
        return self._n.size

    def with_planes(self, near: float, far: float) -> Camera:
        """Returns the same camera with other near and far planes."""
        return Camera._of(self._n._replace(near=float(near), far=float(far)))

    @property
    def pose(self) -> F64:
        """Matrix (4, 4) from the camera's coordinates, looking along -z, to the world's."""
        n = self._n
        if n.up is None:
            raise ValueError("up: it comes from the scene; give one to have a pose")
        eye = np.array(n.eye)
        back = eye - np.array(n.target)
        back /= np.linalg.norm(back)
        right = np.cross(np.array(n.up), back)
        length = np.linalg.norm(right)
        if length == 0.0:
            raise ValueError("up must not be parallel to the line of sight")
        right /= length
        pose = np.eye(4)
        pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = right, np.cross(back, right), back, eye
        return pose

    @property
    def view_matrix(self) -> F64:
        """Matrix (4, 4) from the world's coordinates to the camera's."""
        pose = self.pose
        view = np.eye(4)
        view[:3, :3] = pose[:3, :3].T
        view[:3, 3] = -pose[:3, :3].T @ pose[:3, 3]
        return view

    @property
    def projection_matrix(self) -> F64:
        """Matrix (4, 4) from the camera's coordinates to clip space, -w <= x, y, z <= w, as in OpenGL."""
        n = self._n
        if n.near is None or n.far is None:
            raise ValueError("near and far: they come from the scene; give both to have a projection")
        width, height = n.size or (1, 1)
        near, far = n.near, n.far
        p = np.zeros((4, 4))
        if n.ortho is not None:
            s = 2.0 / n.ortho
            p[2, 2], p[2, 3], p[3, 3] = 2.0 / (near - far), (far + near) / (near - far), 1.0
        else:
            s = 1.0 / math.tan(math.radians(n.fov or 0.0) / 2.0)
            p[2, 2], p[2, 3], p[3, 2] = (far + near) / (near - far), 2.0 * far * near / (near - far), -1.0
        p[0, 0], p[1, 1] = s * height / width, s
        return p

    def _native(self) -> _durer._CameraNumbers:
        n = self._n
        if n.up is None or n.near is None or n.far is None:
            raise ValueError("the camera must have up, near and far; Camera.fit and Image.camera do")
        fov = None if n.fov is None else math.radians(n.fov)
        return (n.eye, n.target, n.up, fov, n.ortho, n.near, n.far)

    def _words(self) -> list[str]:
        n = self._n
        return words(
            {"eye": n.eye, "target": n.target, "up": n.up, "fov": n.fov, "ortho": n.ortho, "near": n.near, "far": n.far}
        )

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Camera) and self._n == other._n

    def __hash__(self) -> int:
        return hash(self._n)

    def __reduce__(self) -> tuple[Any, ...]:
        return (Camera._of, (self._n,))

    def __repr__(self) -> str:
        n = self._n
        lens = f"fov={n.fov}" if n.ortho is None else f"ortho={n.ortho}"
        return f"Camera.look_at({n.eye}, {n.target}, {n.up}, {lens}, near={n.near}, far={n.far})"


def view_words(
    camera: Camera | str | None,
    view: str | None,
    azimuth: float | None,
    elevation: float | None,
    ortho: bool | float | None,
) -> list[str]:
    """Returns the words of a camera: a ``Camera``, the name of one in the file, or a view fitted to the scene."""
    if isinstance(camera, Camera):
        return camera._words()
    if camera is not None:
        if not isinstance(camera, str):
            raise TypeError(f"camera must be a Camera or the name of one of the file, got {type(camera).__name__}")
        return words({"camera": camera})
    angles = azimuth is not None or elevation is not None
    height: object = None if ortho is False else "fit" if ortho is True else ortho
    return words({"view": None if angles else view, "azimuth": azimuth, "elevation": elevation, "ortho": height})
