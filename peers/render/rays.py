#!/usr/bin/env python3
"""Primary rays by Embree beside durer's: `rays.py FILE.stl [--rounds N]` (needs embreex and numpy).

The camera is that of `durer-peers-render methods`. Turns alternate: one of this, one of that. CPU
seconds of the process; rays are made before the clock runs; embreex asks one ray after the other.
"""

import argparse
import pathlib
import re
import statistics
import subprocess
import time

import numpy
from embreex import rtcore_scene
from embreex.mesh_construction import TriangleMesh

SIDE = 1024
FOV_Y = 30.0


def read_stl(path):
    record = numpy.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    return numpy.fromfile(path, dtype=record, offset=84)["corners"].copy()


def unit(v):
    return v / numpy.linalg.norm(v)


def camera_rays(corners):
    """Origins and directions through the pixels' centres, row by row."""
    low, high = corners.min((0, 1)).astype(float), corners.max((0, 1)).astype(float)
    center, extent = (low + high) / 2, numpy.linalg.norm(high - low)
    eye = center + unit(numpy.array([0.6, -0.7, 0.45])) * (extent * 2)
    back = unit(eye - center)
    right = unit(numpy.cross([0, 0, 1], back))
    up = numpy.cross(back, right)
    half = numpy.tan(numpy.radians(FOV_Y) / 2)
    place = ((numpy.arange(SIDE) + 0.5) / SIDE * 2 - 1) * half
    x, y = numpy.meshgrid(place, -place)
    directions = x[..., None] * right + y[..., None] * up - back
    directions = directions.reshape(-1, 3).astype(numpy.float32)
    return numpy.tile(eye.astype(numpy.float32), (len(directions), 1)), directions


def embree(corners, origins, directions):
    start = time.process_time()
    scene = rtcore_scene.EmbreeScene()
    TriangleMesh(scene, corners)
    scene.run(origins[:1], directions[:1])
    built = time.process_time()
    hits = scene.run(origins, directions)
    return built - start, time.process_time() - built, int((hits >= 0).sum())


def durer(program, path):
    """CPU seconds of the hierarchy and of the rays, one round after one that warms up."""
    command = [program, "methods", path, "--rounds", "1"]
    table = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    rows = re.findall(r"primary rays: (.*?) \| ([0-9.]+) ", table)
    return [float(ms) / 1e3 for _, ms in rows] + [rows[-1][0]]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("model")
    parser.add_argument("--rounds", type=int, default=5)
    program = pathlib.Path(__file__).parent / "target/release/durer-peers-render"
    parser.add_argument("--program", default=str(program))
    options = parser.parse_args()
    corners = read_stl(options.model)
    origins, directions = camera_rays(corners)
    turns = []
    for _ in range(options.rounds):
        theirs = embree(corners, origins, directions)
        turns.append((theirs, durer(options.program, options.model)))
    last = turns[-1]
    print(f"hits: Embree {last[0][2]}, durer {last[1][2]}")
    print("| what | Embree, CPU ms | durer, CPU ms | durer / Embree |\n| --- | --- | --- | --- |")
    for part, name in enumerate(["hierarchy", "rays"]):
        pairs = [(theirs[part], ours[part]) for theirs, ours in turns]
        e, d = (statistics.median(side) * 1e3 for side in zip(*pairs))
        ratio = statistics.median(ours / theirs for theirs, ours in pairs)
        print(f"| {name} | {e:.1f} | {d:.1f} | {ratio:.2f} |")


if __name__ == "__main__":
    main()
