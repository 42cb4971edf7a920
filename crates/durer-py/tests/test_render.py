"""Pictures, planes and cameras."""

from __future__ import annotations

import pickle
import subprocess
import threading
import time

import numpy as np
import pytest

import durer


def rendered(command, arguments, tmp_path, name="out.png"):
    out = tmp_path / name
    subprocess.run([*command, "render", *map(str, arguments), "-o", str(out), "--quiet"], check=True)
    return out.read_bytes()


@pytest.mark.parametrize(
    ("model", "options", "words"),
    [
        ("bracket.stl", {}, []),
        ("teapot.obj", {"azimuth": 25, "elevation": 22.5, "samples": 16}, ["--azimuth=25", "--elevation=22.5", "--aa=16"]),
        ("crate.glb", {"background": "transparent", "look": "studio"}, ["--background=transparent", "--look=studio"]),
        ("glass.glb", {"algorithm": "a-buffer", "view": "front"}, ["--algorithm=a-buffer", "--view=front"]),
        ("bracket.stl", {"lights": ["ambient:white:0.2", "directional:-1,-2,-1"]}, ["--light=ambient:white:0.2", "--light=directional:-1,-2,-1"]),
        ("bracket.stl", {"style": "hidden-line", "ortho": True}, ["--style=hidden-line", "--ortho=fit"]),
    ],
)
def test_bytes_are_those_of_the_command(model, options, words, samples, command, tmp_path):
    path = samples / model
    expected = rendered(command, [path, "--size=96x72", *words], tmp_path)
    assert durer.render(durer.read(path), (96, 72), **options).png() == expected


def test_threads_change_nothing(samples):
    scene = durer.read(samples / "glass.glb")
    assert durer.render(scene, (64, 64), threads=1) == durer.render(scene, (64, 64), threads=3)
    for wrong in (0, -1, 2000, "many"):
        with pytest.raises(ValueError, match="threads"):
            durer.render(scene, threads=wrong)


def test_options_that_are_wrong(cube, monkeypatch):
    with pytest.raises(TypeError, match=r"render\(\) got an unexpected keyword argument 'colour'"):
        durer.render(cube, colour="red")
    with pytest.raises(ValueError, match="view"):
        durer.render(cube, view="upside-down")
    with pytest.raises(ValueError, match="size"):
        durer.render(cube, (0, 5))
    with pytest.raises(TypeError, match="size"):
        durer.render(cube, (1, 2, 3))
    with pytest.raises(ValueError, match="near"):
        durer.render(cube, near=5, far=1)
    with pytest.raises(ValueError, match="turntable"):
        durer.render(cube, turntable=3)
    with pytest.raises(ValueError, match="limit"):
        durer.render(cube, (30000, 30000))
    with pytest.raises(TypeError, match="Camera"):
        durer.render(cube, camera=5)
    monkeypatch.setenv("DURER_THREADS", "x")
    with pytest.raises(ValueError, match="threads"):
        durer.render(cube)


def test_images_are_arrays_without_copies(cube, tmp_path):
    picture = durer.render(cube, (40, 30))
    array = np.asarray(picture)
    assert array.shape == (30, 40, 4) and np.shares_memory(array, picture.pixels)
    assert picture.__array_interface__["shape"] == (30, 40, 4)
    assert np.array(picture).flags.writeable and np.asarray(picture, dtype=float).dtype == float
    with pytest.raises(ValueError, match="read-only"):
        picture.pixels[0, 0] = 0
    assert picture._repr_png_() == picture.png() and pickle.loads(pickle.dumps(picture)) == picture
    for suffix, head in [("png", b"\x89PNG"), ("jpg", b"\xff\xd8"), ("webp", b"RIFF")]:
        path = tmp_path / f"a.{suffix}"
        picture.save(path)
        assert path.read_bytes().startswith(head)
    with pytest.raises(ValueError, match="bmp"):
        picture.save(tmp_path / "a.bmp")
    with pytest.raises(OSError, match="missing"):
        picture.save(tmp_path / "missing" / "a.png")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.jpg", "a.png", "a.webp"]


def test_pillow(cube):
    pytest.importorskip("PIL")
    picture = durer.render(cube, (40, 30))
    assert (np.asarray(picture.to_pil()) == picture.pixels).all()


def test_planes(cube):
    camera = durer.Camera.look_at((0.5, 0.5, 3.0), (0.5, 0.5, 0.0), (0, 1, 0), fov=40)
    planes = durer.render_planes(cube, (33, 21), camera=camera, item=True, normal=True)
    color, depth = planes[:2]
    assert (color.shape, color.dtype, depth.shape, depth.dtype) == ((21, 33, 4), np.uint8, (21, 33), np.float32)
    assert (planes.item.shape, planes.item.dtype) == ((21, 33), np.uint32)
    assert (planes.normal.shape, planes.normal.dtype) == ((21, 33, 3), np.float32)
    assert abs(float(depth[10, 16]) - 2.0) < 1e-5 and depth[0, 0] == 0.0
    assert planes.item[0, 0] == 2**32 - 1 and planes.item[10, 16] < 12
    assert planes.normal[10, 16].tolist() == [0.0, 0.0, 1.0]
    window = durer.render_planes(cube, (33, 21), camera=camera, linear_depth=False).depth
    assert 0.0 < window[10, 16] < 1.0 and window[0, 0] == 1.0
    flat = durer.render_planes(cube, (9, 9), view="top", ortho=True)
    near, far = flat.camera.near, flat.camera.far
    assert near <= float(flat.depth[4, 4]) <= far
    assert durer.render_planes(cube, (9, 9), color=False, depth=False) [:2] == (None, None)


def test_depths_are_those_of_the_projection(samples):
    scene = durer.read(samples / "teapot.obj")
    planes = durer.render_planes(scene, (64, 64), item=True)
    rows, columns = np.nonzero(planes.depth)
    at = len(rows) // 2
    row, column = int(rows[at]), int(columns[at])
    hit = scene.pick(column + 0.5, row + 0.5, planes.camera)[0]
    view = planes.camera.view_matrix @ [*hit["position"], 1.0]
    assert abs(-view[2] - planes.depth[row, column]) < 1e-3 * -view[2]
    assert hit["item"] == planes.item[row, column]
    clip = planes.camera.projection_matrix @ view
    assert abs((clip[0] / clip[3] + 1) * 32 - column - 0.5) < 1e-6


def test_cameras(cube):
    fitted = durer.Camera.fit(cube, "front", size=(80, 60))
    assert durer.render(cube, (80, 60), camera=fitted) == durer.render(cube, (80, 60), view="front")
    again = durer.Camera(fitted.pose, fov=fitted.fov, near=fitted.near, far=fitted.far)
    difference = durer.render(cube, (80, 60), camera=again).pixels.astype(int) - durer.render(cube, (80, 60), camera=fitted).pixels
    assert np.abs(difference).max() <= 2
    cv = fitted.pose @ np.diag([1, -1, -1, 1.0])
    assert np.allclose(durer.Camera(cv, convention="opencv").pose, fitted.pose)
    focal = 30.0 / np.tan(np.radians(15.0))
    k = [[focal, 0, 40], [0, focal, 30], [0, 0, 1]]
    assert abs(durer.Camera(fitted.pose, K=k, size=(80, 60)).fov - 30.0) < 1e-9
    assert pickle.loads(pickle.dumps(fitted)) == fitted and hash(fitted) == hash(pickle.loads(pickle.dumps(fitted)))
    assert np.allclose(fitted.view_matrix @ fitted.pose, np.eye(4))


def test_wrong_cameras():
    eye = np.eye(4)
    for error, match, make in [
        (TypeError, r"\(4, 4\)", lambda: durer.Camera(np.eye(3))),
        (ValueError, "rotation", lambda: durer.Camera(eye * 2)),
        (ValueError, "fov", lambda: durer.Camera(eye, fov=180)),
        (ValueError, "ortho", lambda: durer.Camera(eye, ortho=0)),
        (ValueError, "one of the two", lambda: durer.Camera(eye, fov=5, ortho=1)),
        (ValueError, "size", lambda: durer.Camera(eye, K=np.eye(3))),
        (ValueError, "square", lambda: durer.Camera(eye, K=[[1, 0, 1], [0, 2, 1], [0, 0, 1]], size=(2, 2))),
        (ValueError, "principal", lambda: durer.Camera(eye, K=[[1, 0, 9], [0, 1, 9], [0, 0, 1]], size=(2, 2))),
        (ValueError, "convention", lambda: durer.Camera(eye, convention="maya")),
        (ValueError, "other than", lambda: durer.Camera.look_at((0, 0, 0), (0, 0, 0))),
        (ValueError, "finite", lambda: durer.Camera.look_at((0, 0, np.inf), (0, 0, 0))),
    ]:
        with pytest.raises(error, match=match):
            make()


def test_the_lock_is_released(samples):
    scene = durer.read(samples / "teapot.obj")
    durer.render(scene, (8, 8))
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    start = time.perf_counter()
    while time.perf_counter() - start < 0.2:
        durer.render(scene, (400, 400), samples=16, threads=1)
    end = time.perf_counter()
    done.set()
    thread.join()
    inside = [t for t in ticks if start < t < end]
    # If the lock were held, the other thread could run only between the calls.
    assert len(inside) > 20


def test_worker_processes_of_a_fork(cube):
    import multiprocessing

    expected = durer.render(cube, (16, 16)).png()
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map(_png, [cube, cube], chunksize=1) == [expected, expected]


def _png(cube):
    return durer.render(cube, (16, 16)).png()


def test_pick(cube):
    camera = durer.Camera.fit(cube, "top", size=(50, 50))
    hits = durer.scene(cube).pick(25, 25, camera)
    assert hits[0]["kind"] == "triangle" and abs(hits[0]["position"][2] - 1.0) < 1e-6
    assert durer.scene(cube).pick(0.5, 0.5, camera) == []


def test_warp_and_fill(cube):
    triangle = ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    color, depth, *_, camera = durer.render_planes(triangle, (64, 64), samples=1)
    assert (durer.warp(color, depth, camera, camera).pixels == color).all()
    color, depth, *_, camera = durer.render_planes(cube, (64, 64))
    window = durer.render_planes(cube, (64, 64), linear_depth=False).depth
    assert durer.warp(color, depth, camera, camera) == durer.warp(color, window, camera, camera, linear_depth=False)
    from durer._picture import window_depth

    assert np.allclose(window_depth(depth, camera), window, atol=1e-6)
    eye = np.array(camera.eye) + 0.05
    moved = durer.Camera.look_at(eye, camera.target, camera.up, fov=camera.fov)
    warped = durer.warp(color, depth, camera, moved, holes="#ff00ff")
    direct = durer.render(cube, (64, 64), camera=moved.with_planes(camera.near, camera.far))
    shown = (warped.pixels != (255, 0, 255, 255)).any(axis=2)
    alike = np.abs(warped.pixels.astype(int) - direct.pixels).max(axis=2) < 40
    assert shown.mean() > 0.8 and alike[shown].mean() > 0.95
    with pytest.raises(TypeError, match=r"depth must be \(64, 64\)"):
        durer.warp(color, depth[:5], camera, moved)
    image = np.zeros((4, 5, 3), np.uint8)
    image[:, 2] = 255
    filled = durer.fill(image, (0, 0), (9, 8, 7)).pixels
    assert (filled[:, :2, :3] == [9, 8, 7]).all() and (filled[:, 3:, :3] == 0).all()
    assert (durer.fill(image, [(0, 0), (4, 0)], "red").pixels[:, [0, 4], 0] == 255).all()
    with pytest.raises(IndexError, match=r"\(5, 0\)"):
        durer.fill(image, (5, 0), "red")
    with pytest.raises(ValueError, match="colour"):
        durer.fill(image, (0, 0), "reddish")
    with pytest.raises(TypeError, match="uint8"):
        durer.fill(image.astype(float), (0, 0), "red")
