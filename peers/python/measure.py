"""Compares the speed of the Python package with pyrender, f3d, shapely, geopandas and rasterio, all in one run.

    python peers/python/measure.py [--quick] [--cpu] > table.md

Each row has the medians of runs in turn, of one process, after one run that is not counted. What is not installed, or does not
run on the machine, is left out with its reason. CPU time does not depend on what else the machine does; it adds up the threads.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

import durer

SAMPLES = Path(__file__).resolve().parents[2] / "samples"
SIZE = (256, 256)

#: A name, durer's function, and those of other packages.
Row = tuple[str, Callable[[], object], dict[str, Callable[[], object]]]

left_out: list[str] = []


def optional(name: str, make: Callable[[], dict[str, Callable[[], object]]]) -> dict[str, Callable[[], object]]:
    """Returns the runs of a library; none, with the reason noted, if it does not work here."""
    try:
        runs = make()
        for run in runs.values():
            run()
        return runs
    except Exception as error:
        left_out.append(f"{name}: {type(error).__name__}: {str(error).splitlines()[0] if str(error) else ''}")
        return {}


def pictures() -> Row:
    """Returns a small picture of the teapot."""
    scene = durer.read(SAMPLES / "teapot.obj")
    camera = durer.Camera.fit(scene, size=SIZE)

    def pyrender() -> dict[str, Callable[[], object]]:
        os.environ.setdefault("PYOPENGL_PLATFORM", "egl")
        import pyrender as pr
        import trimesh

        mesh = pr.Mesh.from_trimesh(trimesh.load(SAMPLES / "teapot.obj", force="mesh"))
        world = pr.Scene()
        world.add(mesh)
        world.add(pr.PerspectiveCamera(np.radians(camera.fov), camera.near, camera.far), pose=camera.pose)
        world.add(pr.DirectionalLight(intensity=3.0), pose=camera.pose)
        offscreen = pr.OffscreenRenderer(*SIZE)
        return {f"pyrender ({os.environ['PYOPENGL_PLATFORM']})": lambda: offscreen.render(world)}

    def f3d() -> dict[str, Callable[[], object]]:
        import f3d as viewer

        engine = viewer.Engine.create(True)
        engine.window.size = SIZE
        engine.scene.add(str(SAMPLES / "teapot.obj"))
        return {"f3d": lambda: engine.window.render_to_image()}

    def trimesh() -> dict[str, Callable[[], object]]:
        import trimesh as tm

        world = tm.load(SAMPLES / "teapot.obj", force="scene")
        return {"trimesh": lambda: world.save_image(SIZE)}

    others = {**optional("pyrender", pyrender), **optional("f3d", f3d), **optional("trimesh", trimesh)}
    return (f"teapot, {SIZE[0]} × {SIZE[1]}", lambda: durer.render(scene, SIZE, camera=camera), others)


def segments(count: int) -> list[Row]:
    """Returns segments clipped to a rectangle."""
    import shapely

    random = np.random.default_rng(1).uniform(-1, 2, (count, 2, 2))
    lines, box = shapely.linestrings(random), shapely.box(0, 0, 1, 1)
    arrays = tuple(np.ascontiguousarray(random.reshape(-1, 4)[:, i]) for i in range(4))
    others = {
        "shapely.intersection": lambda: shapely.intersection(lines, box),
        "shapely.clip_by_rect": lambda: shapely.clip_by_rect(lines, 0, 0, 1, 1),
    }
    name = f"{count:,} segments"
    return [
        (f"{name}, (n, 2, 2)", lambda: durer.clip_lines(random, (0, 0, 1, 1)), others),
        (f"{name}, four arrays", lambda: durer.clip_lines(arrays, (0, 0, 1, 1)), others),
    ]


def stars(count: int, points: int = 24) -> np.ndarray:
    """Returns star-shaped polygons, all over the unit square."""
    import shapely

    random = np.random.default_rng(3)
    angles = np.linspace(0, 2 * np.pi, points, endpoint=False)
    radii = random.uniform(0.4, 1.0, (count, points)) * 0.02
    rings = np.stack([np.cos(angles) * radii, np.sin(angles) * radii], 2) + random.uniform(0, 1, (count, 1, 2))
    return shapely.polygons(rings)


def polygons(count: int) -> list[Row]:
    """Returns polygons clipped to rectangles and masks, and overlaid."""
    import shapely

    made = stars(count)
    box = (0.25, 0.25, 0.75, 0.75)
    ragged = shapely.to_ragged_array(made)
    mask = shapely.Point(0.5, 0.5).buffer(0.3)
    a, b = made[: count // 5], made[count // 5 : 2 * (count // 5)]
    near = shapely.transform(b, lambda c: c)
    near = shapely.polygons(
        shapely.get_coordinates(b).reshape(len(b), -1, 2)[:, :-1]
        - shapely.get_coordinates(shapely.centroid(b))[:, None]
        + shapely.get_coordinates(shapely.centroid(a))[:, None]
        + 0.005
    )
    rect = {"shapely.clip_by_rect": lambda: shapely.clip_by_rect(made, *box)}
    rows: list[Row] = [
        (f"{count:,} polygons, rectangle, shapely's", lambda: durer.clip_by_rect(made, *box), rect),
        (f"{count:,} polygons, rectangle, ragged", lambda: durer.clip_by_rect(ragged, *box), rect),
        (
            f"{count:,} polygons, round mask, shapely's",
            lambda: durer.clip(made, mask),
            {"shapely.intersection": lambda: shapely.intersection(made, mask)},
        ),
        (
            f"{len(a):,} pairs of polygons",
            lambda: durer.intersection(a, near),
            {"shapely.intersection": lambda: shapely.intersection(a, near)},
        ),
    ]

    def arrow() -> dict[str, Callable[[], object]]:
        import pyarrow as pa

        column = pa.array(list(shapely.to_wkb(made)), pa.large_binary())
        return {"": lambda: durer.clip_by_rect(column, *box)}

    own = optional("pyarrow", arrow)
    if own:
        rows.append((f"{count:,} polygons, rectangle, Arrow of WKB", own[""], rect))

    def geopandas() -> dict[str, Callable[[], object]]:
        import geopandas as gp

        frame = gp.GeoDataFrame({"n": np.arange(count)}, geometry=made)
        rows.append(
            (
                f"GeoDataFrame of {count:,} polygons, round mask",
                lambda: durer.clip(frame, mask),
                {"geopandas.clip": lambda: gp.clip(frame, mask)},
            )
        )
        return {}

    optional("geopandas", geopandas)

    def rasterio() -> dict[str, Callable[[], object]]:
        from rasterio.features import rasterize

        shapes = [(g, i % 200 + 1) for i, g in enumerate(made[: count // 10])]
        to_world = (1 / 2048, 0, 0, 0, 1 / 2048, 0)
        from affine import Affine

        rows.append(
            (
                f"{len(shapes):,} polygons to 2048 × 2048 pixels",
                lambda: durer.rasterize(shapes, (2048, 2048), to_world),
                {"rasterio": lambda: rasterize(shapes, (2048, 2048), transform=Affine(*to_world))},
            )
        )
        return {}

    optional("rasterio", rasterio)
    return rows


def median(runs: int, all: list[Callable[[], object]], clock: Callable[[], float]) -> list[float]:
    """Returns the median times of several things that are done in turn, in milliseconds of a clock."""
    times: list[list[float]] = [[] for _ in all]
    for turn in range(runs + 1):
        for run, own in zip(all, times, strict=True):
            start = clock()
            run()
            if turn:
                own.append(1000 * (clock() - start))
    return [statistics.median(own) for own in times]


def import_times() -> tuple[float, float]:
    """Returns the seconds and the CPU time that the import takes beyond that of numpy, both in milliseconds."""
    now = "time.perf_counter(), time.process_time()"
    code = f"import time, numpy; a, b = {now}; import durer; c, d = {now}; print(c - a, d - b)"
    runs = [subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True) for _ in range(20)]
    times = [[1000 * float(word) for word in run.stdout.split()] for run in runs]
    seconds, cpu = (statistics.median(column) for column in zip(*times, strict=True))
    return seconds, cpu


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true", help="fewer things and runs")
    parser.add_argument("--cpu", action="store_true", help="CPU time of all threads in place of seconds")
    arguments = parser.parse_args()
    quick, clock = arguments.quick, time.process_time if arguments.cpu else time.perf_counter
    warnings.simplefilter("ignore")
    runs = 3 if quick else 9
    rows = [pictures(), *segments(20_000 if quick else 200_000), *polygons(10_000 if quick else 100_000)]
    print("| what | durer, ms | beside | ms | times as fast |\n|---|--:|---|--:|--:|")
    for name, own, others in rows:
        mine, *theirs = median(runs, [own, *others.values()], clock)
        if not others:
            print(f"| {name} | {mine:.2f} | – | – | – |", flush=True)
        for other, their in zip(others, theirs, strict=True):
            print(f"| {name} | {mine:.2f} | {other} | {their:.2f} | {their / mine:.1f} |", flush=True)
    seconds, cpu = import_times()
    print(f"| import beyond numpy | {seconds:.1f} | – | – | – |")
    print(f"| import beyond numpy, CPU time | {cpu:.1f} | – | – | – |\n")
    for reason in left_out:
        print(f"Left out: {reason}")


if __name__ == "__main__":
    main()
