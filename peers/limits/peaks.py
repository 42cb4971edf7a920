"""Peaks of memory of hostile files at several budgets.

    python peaks.py DURER CASES [--budgets 64,256,1024] [--only WORD]

DURER is the command, CASES the folder of files. Larger relatives of them are made in a temporary folder. Each command runs
with 4 GB of address space and `--timeout 10`; a row has its peak in MB and what became of it: a picture, an error of exit
code 1 (refused, or late where the time was over), or a fault: another code, a peak above 1.25 times the budget and 50 MB,
an end more than two seconds late.
"""

import argparse
import json
import os
import pathlib
import random
import resource
import struct
import subprocess
import sys
import tempfile
import time

SPACE = 4_000_000 << 10
SECONDS = 10


def soup(path, count):
    """Triangles at random, each in a good part of the box."""
    numbers = random.Random(count)
    with open(path, "w") as out:
        for _ in range(3 * count):
            out.write("v %.4f %.4f %.4f\n" % tuple(numbers.uniform(-1, 1) for _ in range(3)))
        for i in range(count):
            out.write(f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}\n")


def ring(path, count):
    """A polygon whose corners are random points."""
    numbers = random.Random(count)
    points = [[numbers.uniform(0, 100), numbers.uniform(0, 100)] for _ in range(count)]
    path.write_text(json.dumps({"type": "Polygon", "coordinates": [points + points[:1]]}))


def cloud(path, count):
    """A binary PLY of points."""
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n"
    head += "property float x\nproperty float y\nproperty float z\nend_header\n"
    numbers = random.Random(1)
    block = struct.pack("<3000f", *(numbers.uniform(-1, 1) for _ in range(3000)))
    with open(path, "wb") as out:
        out.write(head.encode())
        for _ in range(count // 1000):
            out.write(block)


def instances(path, count):
    """Many instances of one mesh of many triangles: copies of each, as sections need them, are too many."""
    side, corners = 64, []
    for i in range(side * side * 2):
        x, y, upper = i // 2 % side, i // 2 // side, i % 2
        for dx, dy in [(1, 0), (1, 1), (0, 1)] if upper else [(0, 0), (1, 0), (0, 1)]:
            corners += [x + dx, y + dy, 0.1 * ((x + dx) % 2)]
    data = struct.pack(f"<{len(corners)}f", *corners)
    path.with_suffix(".bin").write_bytes(data)
    nodes = [{"mesh": 0, "translation": [70 * (i % 100), 70 * (i // 100), 0]} for i in range(count)]
    path.write_text(
        json.dumps(
            {
                "asset": {"version": "2.0"},
                "scene": 0,
                "scenes": [{"nodes": list(range(count))}],
                "nodes": nodes,
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                "accessors": [
                    {"bufferView": 0, "componentType": 5126, "count": len(corners) // 3, "type": "VEC3",
                     "min": [0, 0, 0], "max": [side, side, 0.1]}
                ],
                "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
                "buffers": [{"byteLength": len(data), "uri": path.with_suffix(".bin").name}],
            }
        )
    )


def panes(path, count):
    """Panes of glass behind each other, all over the picture."""
    with open(path.with_suffix(".mtl"), "w") as out:
        out.write("newmtl glass\nKd 0.2 0.5 0.9\nd 0.02\n")
    with open(path, "w") as out:
        out.write(f"mtllib {path.with_suffix('.mtl').name}\nusemtl glass\n")
        for i in range(count):
            z = i / count
            for x, y in [(-1, -1), (1, -1), (1, 1), (-1, 1)]:
                out.write(f"v {x} {y} {z}\n")
            out.write(f"f {4 * i + 1} {4 * i + 2} {4 * i + 3} {4 * i + 4}\n")


def svg(path, body, style=""):
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">{style}{body}</svg>')


def relatives(folder):
    numbers = random.Random(7)
    pair = lambda: f"{numbers.uniform(-9e4, 9e4):.0f} {numbers.uniform(-9e4, 9e4):.0f}"
    soup(folder / "soup4000.obj", 4000)
    soup(folder / "soup100k.obj", 100_000)
    ring(folder / "rnd3000.geojson", 3000)
    cloud(folder / "cloud5M.ply", 5_000_000)
    instances(folder / "copies.gltf", 10_000)
    panes(folder / "panes2000.obj", 2000)
    curves = "".join(f"C {pair()} {pair()} {pair()}" for _ in range(3000))
    svg(folder / "curves3000.svg", f'<path fill="none" stroke="#000" stroke-width="3" d="M 0 0 {curves}"/>')
    svg(folder / "text20000.svg", f"<text>{'a' * 20_000}</text>")
    rules = "".join(f".c{i} {{ fill: #{i % 4096:03x} }}\n" for i in range(5000))
    shapes = "".join(f'<rect class="c{i}" width="9" height="9"/>' for i in range(5000))
    svg(folder / "css5000.svg", shapes, f"<style>{rules}</style>")


def commands(cases, made):
    """Yields commands, whose last word is the output without a suffix's dot where it has none."""
    models = [cases / name for name in ("esc.gltf", "esc.obj", "img_60.gltf", "nanmat.gltf", "noview9.gltf")]
    for model in models + [cases / "self.obj", cases / "soup1000.obj", made / "soup4000.obj", made / "cloud5M.ply"]:
        yield ["info", model], None
        yield ["render", model], "a.png"
    for model in (cases / "soup1000.obj", cases / "self.obj"):
        for suffix in ("svg", "pdf", "dxf"):
            yield ["render", model], f"a.{suffix}"
        yield ["render", model, "--style", "regions"], "a.svg"
    for method in ("scan-line-z", "spanning-scan-line", "a-buffer", "depth-sort", "warnock", "ray"):
        yield ["render", cases / "soup1000.obj", "--algorithm", method], "a.png"
        yield ["render", made / "soup100k.obj", "--algorithm", method], "a.png"
        yield ["render", made / "panes2000.obj", "--algorithm", method, "--size", "1000"], "a.png"
    yield ["render", made / "panes2000.obj", "--size", "1000"], "a.png"
    for suffix in ("png", "jpg", "webp"):
        yield ["render", cases / "soup1000.obj", "--size", "6000", "--aa", "1"], f"a.{suffix}"
    yield ["render", cases / "soup1000.obj", "--size", "3000", "--turntable", "2"], "a.gif"
    for more in (["--section", "0,0,1,-0.05"], ["--explode", "x"], ["--grid"]):
        yield ["render", made / "copies.gltf", *more], "a.png"
    for drawing in sorted(cases.glob("*.svg")) + sorted(made.glob("*.svg")):
        yield ["draw", drawing], "a.png"
    yield ["draw", cases / "dash.svg", "--size", "8000"], "a.png"
    for polygon in (cases / "rnd1000.geojson", made / "rnd3000.geojson"):
        yield ["fix", polygon], "a.geojson"
        yield ["buffer", polygon, "--distance", "1"], "a.geojson"
        yield ["clip", polygon, "--window", "20,20,80,80"], "a.geojson"
        yield ["draw", polygon], "a.png"
    yield ["tiles", cases / "world.geojson", "--zoom", "0-5"], "tiles"
    yield ["fill", cases / "bomb1.png", "--at", "0,0", "--color", "red"], "a.png"
    yield ["plot", cases / "bomb1.png"], "a.svg"


def run(durer, words, output, budget, folder):
    """Returns the exit code, the peak in MB, seconds, and what was said."""
    target = [] if output is None else ["-o", str(folder / output)]
    line = [durer, *map(str, words), *target, "--max-memory", f"{budget}M", "--timeout", str(SECONDS)]
    line += ["--quiet", "--no-config"]
    limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (SPACE, SPACE))
    with tempfile.TemporaryFile() as said:
        start = time.monotonic()
        child = subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=said, preexec_fn=limit)
        _, status, usage = os.wait4(child.pid, 0)
        seconds = time.monotonic() - start
        child.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        text = said.read().decode(errors="replace").strip()
    return child.returncode, usage.ru_maxrss / 1024, seconds, text


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("durer")
    parser.add_argument("cases", type=pathlib.Path)
    parser.add_argument("--budgets", default="64,256,1024")
    parser.add_argument("--only", default="")
    args = parser.parse_args()
    budgets = [int(b) for b in args.budgets.split(",")]
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        made = pathlib.Path(folder)
        relatives(made)
        print("| command | " + " | ".join(f"{b}M" for b in budgets) + " |")
        print("|---" * (len(budgets) + 1) + "|")
        for words, output in commands(args.cases, made):
            name = " ".join(w.name if isinstance(w, pathlib.Path) else w for w in words)
            name += f" → {output.split('.')[-1]}" if output else ""
            if args.only not in name:
                continue
            cells = []
            for budget in budgets:
                code, peak, seconds, said = run(args.durer, words, output, budget, made)
                what = {0: "done", 1: "late" if "--timeout" in said else "refused"}.get(code, f"code {code}")
                bound = 1.25 * budget + 50
                faults = [f"above {bound:.0f}"] * (peak > bound) + [f"{seconds:.0f} s"] * (seconds > SECONDS + 2)
                faults += [f"code {code}"] * (code not in (0, 1))
                wrong += bool(faults)
                cells.append(f"{peak:.0f}, {what}" + "".join(f", **{f}**" for f in faults))
                if code:
                    print(f"  {said.splitlines()[-1] if said else 'nothing was said'}", file=sys.stderr)
            print(f"| {name} | " + " | ".join(cells) + " |", flush=True)
    print(f"{wrong} commands beyond their bounds", file=sys.stderr)
    sys.exit(wrong > 0)


main()
