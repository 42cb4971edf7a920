"""Scenes: reading, arrays, trimesh, pyvista and pyrender by duck typing, pickling."""

from __future__ import annotations

import io
import pickle
import subprocess
import sys
import types

import numpy as np
import pytest

import durer


def test_reads_paths_bytes_and_files(samples):
    path = samples / "bracket.stl"
    scene = durer.read(path)
    assert scene.triangle_count == durer.read(path.read_bytes()).triangle_count
    with path.open("rb") as file:
        assert durer.read(file).info() == scene.info()
    assert durer.read(io.BytesIO(path.read_bytes()), name="bracket.stl").info()["name"] == "bracket"
    assert scene.info()["format"].startswith("STL")
    assert scene.bounds.shape == (2, 3) and (scene.bounds[0] < scene.bounds[1]).all()


def test_finds_files_beside_a_path(tmp_path):
    (tmp_path / "a.mtl").write_text("newmtl red\nKd 1 0 0\n")
    (tmp_path / "a.obj").write_text("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n")
    assert durer.read(tmp_path / "a.obj").info()["materials"] == ["red"]
    with pytest.warns(durer.ReadWarning, match=r"a\.mtl"):
        durer.read((tmp_path / "a.obj").read_bytes(), name="a.obj")


def test_errors_have_places(tmp_path):
    with pytest.raises(durer.ReadError, match="line 2") as error:
        durer.read(b"v 0 0 0\nv 0 zero 0\nv 0 1 0\nf 1 2 3\n", name="a.obj")
    assert error.value.place.startswith("line 2")
    assert pickle.loads(pickle.dumps(error.value)).place == error.value.place
    with pytest.raises(durer.ReadError) as error:
        durer.read(b"nothing")
    assert isinstance(error.value, ValueError) and error.value.place is None
    with pytest.raises(FileNotFoundError):
        durer.read(tmp_path / "missing.stl")
    with pytest.raises(durer.LimitError, match="limit of 1"):
        durer.read(b"OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 2 3\n", name="a.off", limits={"triangles": 1})
    with pytest.raises(TypeError, match="'faces'"):
        durer.read(b"", limits={"faces": 1})
    with pytest.raises(TypeError, match="binary"):
        durer.read(io.StringIO(""))


def test_takes_any_dtype_and_strides(cube):
    vertices, faces = cube
    expected = durer.render(cube, (32, 32)).pixels
    for v, f in [
        (vertices.astype(np.float32), faces.astype(np.int32)),
        (vertices.astype(np.int16), faces.astype(np.uint8)),
        (np.asfortranarray(vertices), np.asfortranarray(faces)),
        (np.repeat(vertices, 2, axis=0)[::2], np.repeat(faces, 2, axis=1)[:, ::2]),
        (vertices.tolist(), faces.tolist()),
    ]:
        assert (durer.render((v, f), (32, 32)).pixels == expected).all()


def test_wrong_arrays_are_errors_with_an_index(cube):
    vertices, faces = cube
    wrong = faces.copy()
    wrong[7, 1] = 8
    with pytest.raises(ValueError, match=r"faces\[7\] = 8 .* there are 8"):
        durer.scene((vertices, wrong))
    wrong[7, 1] = -1
    with pytest.raises(ValueError, match=r"faces\[7\] = -1"):
        durer.scene((vertices, wrong))
    far = vertices.copy()
    far[3, 2] = np.nan
    with pytest.raises(ValueError, match=r"vertices\[3\].*not finite"):
        durer.scene((far, faces))
    with pytest.raises(TypeError, match=r"vertices must be \(n, 3\), got \(8, 2\)"):
        durer.scene((vertices[:, :2], faces))
    with pytest.raises(TypeError, match="whole numbers"):
        durer.scene((vertices, faces.astype(float)))
    with pytest.raises(TypeError, match="faces must be"):
        durer.scene((vertices, np.zeros((1, 4), int)))
    with pytest.raises(ValueError, match="up_axis"):
        durer.scene(cube, up_axis="w")
    for thing in (None, 5, object()):
        with pytest.raises(TypeError, match="is needed"):
            durer.scene(thing)


def test_far_vertices_keep_their_shape(cube):
    vertices, faces = cube
    far = durer.scene((vertices * 0.1 + [4.5e6, 5.3e6, 0.1], faces))
    assert np.allclose(far.bounds[1] - far.bounds[0], 0.1, atol=1e-6)
    near = durer.render(cube, (64, 64)).pixels.astype(int)
    assert np.abs(durer.render(far, (64, 64)).pixels.astype(int) - near).mean() < 0.5


def test_empty_scenes_render_and_say_so():
    picture = durer.render((np.zeros((0, 3)), np.zeros((0, 3), int)), (8, 8))
    assert (picture.pixels == 255).all() and picture.unseen
    assert durer.scene((np.zeros((0, 3)), np.zeros((0, 3), int))).bounds is None


def test_pickles(samples):
    for name in ("crate.glb", "bracket.stl"):
        scene = durer.read(samples / name)
        again = pickle.loads(pickle.dumps(scene))
        assert again.info() == scene.info()
        assert durer.render(again, (48, 48)) == durer.render(scene, (48, 48))
    with pytest.raises(ValueError, match="not a scene"):
        durer.Scene._of_bytes(b"\x05\x01", None)


def test_trimesh(samples):
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.load(samples / "bracket.stl")
    picture = durer.render(mesh, (64, 64))
    assert (picture.pixels != 255).any()
    box = trimesh.creation.box()
    box.visual.face_colors = [255, 0, 0, 255]
    red = durer.render(box, (32, 32), shading="unlit").pixels[16, 16]
    assert red[0] > 240 and red[1] == 0
    box.visual = trimesh.visual.ColorVisuals(box, vertex_colors=np.tile([0, 255, 0, 255], (8, 1)))
    assert durer.render(box, (32, 32), shading="unlit").pixels[16, 16, 1] > 240
    from durer._scene import _bytes

    assert _bytes([[1.0, 0.5, 0.0]]).tolist() == [[255, 128, 0, 255]]
    scene = trimesh.Scene()
    scene.add_geometry(box)
    scene.add_geometry(box, transform=trimesh.transformations.translation_matrix([3, 0, 0]))
    made = durer.scene(scene)
    assert np.allclose(made.bounds, scene.bounds) and made.triangle_count == 24


def test_trimesh_textures():
    trimesh = pytest.importorskip("trimesh")
    pillow = pytest.importorskip("PIL.Image")
    image = pillow.fromarray(np.array([[[255, 0, 0], [255, 0, 0]], [[0, 0, 255], [0, 0, 255]]], np.uint8))
    quad = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]], process=False)
    quad.visual = trimesh.visual.TextureVisuals(uv=[[0, 0], [1, 0], [1, 1], [0, 1]], image=image)
    pixels = durer.render(quad, (32, 32), view="top", shading="unlit").pixels
    assert pixels[4, 16, 0] > 200 and pixels[27, 16, 2] > 200


def test_pyvista_by_its_attributes(cube):
    vertices, _ = cube
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = np.concatenate([[4, *q] for q in quads])
    mesh = types.SimpleNamespace(points=vertices, faces=faces, n_points=8, point_data={})
    assert durer.scene(mesh).triangle_count == 12
    mesh.faces = np.concatenate([faces, [3, 0, 1, 2]])
    assert durer.scene(mesh).triangle_count == 13
    mesh.faces = np.array([3, 0, 1])
    with pytest.raises(ValueError, match="does not end"):
        durer.scene(mesh)


def test_pyrender_by_its_attributes(cube):
    vertices, faces = cube
    material = types.SimpleNamespace(
        name="red", baseColorFactor=[1, 0, 0, 1], metallicFactor=0.0, roughnessFactor=1.0, doubleSided=False
    )
    primitive = types.SimpleNamespace(
        positions=vertices, normals=None, color_0=None, texcoord_0=None, indices=faces, mode=4, poses=None, material=material
    )
    mesh = types.SimpleNamespace(primitives=[primitive], is_transparent=False, name="cube")
    pose = np.eye(4)
    pose[:3, 3] = [0.5, 0.5, 5.0]
    eye = types.SimpleNamespace(camera=types.SimpleNamespace(yfov=0.5, znear=0.1, zfar=9.0))
    node = types.SimpleNamespace(mesh=mesh)
    scene = types.SimpleNamespace(
        mesh_nodes=[node], main_camera_node=eye, get_pose=lambda n: pose if n is eye else np.eye(4)
    )
    picture = durer.render(scene, (32, 32), shading="unlit")
    assert picture.camera.eye == (0.5, 0.5, 5.0) and picture.pixels[16, 16].tolist() == [255, 0, 0, 255]
    depth = durer.render_planes(scene, (32, 32)).depth
    assert abs(float(depth[16, 16]) - 4.0) < 1e-3
    assert durer.scene(mesh).triangle_count == 12


def test_imports_no_library_first():
    code = "import sys, durer; print([m for m in ('shapely', 'trimesh', 'pyarrow', 'PIL', 'pandas') if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout == "[]\n"
