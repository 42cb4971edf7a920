"""Batches: errors are in a column."""

from __future__ import annotations

import hashlib

import pytest

import durer
from durer.batch import clip_batch, render_batch

pa = pytest.importorskip("pyarrow")


def test_a_row_that_fails_ends_nothing(samples):
    rows = {
        "id": ["a", "b", "c", "d"],
        "input": [str(samples / "bracket.stl"), "missing.stl", str(samples / "crate.glb"), None],
        "azimuth": [30.0, None, None, None],
    }
    made = render_batch(pa.RecordBatch.from_pydict(rows), size=(32, 24))
    assert isinstance(made, pa.RecordBatch) and made.column("id").to_pylist() == ["a", "b", "c", "d"]
    errors = made.column("error").to_pylist()
    assert errors[0] is None and "FileNotFoundError" in errors[1] and errors[2] is None and "input" in errors[3]
    png = made.column("png")[0].as_py()
    assert png == durer.render(durer.read(rows["input"][0]), (32, 24), azimuth=30.0).png()
    assert made.column("sha256")[0].as_py() == hashlib.sha256(png).hexdigest()
    assert made.column("width").to_pylist() == [32, None, 32, None]


def test_rows_of_bytes(samples):
    table = pa.table({"bytes": [(samples / "bracket.stl").read_bytes(), b"?"], "name": ["a.stl", "b.stl"]})
    made = render_batch(table, size=8)
    assert isinstance(made, pa.Table) and made["id"].to_pylist() == ["0", "1"]
    assert made["error"][0].as_py() is None and "ReadError" in made["error"][1].as_py()


def test_clip_batch():
    shapely = pytest.importorskip("shapely")
    geometry = [shapely.box(0, 0, 2, 2).wkb, b"\x01", None]
    made = clip_batch(pa.table({"n": [1, 2, 3], "geometry": geometry}), (1, 1, 5, 5))
    assert shapely.from_wkb(made["geometry"][0].as_py()).area == 1.0
    assert made["geometry"].to_pylist()[1:] == [None, None] and made["n"].to_pylist() == [1, 2, 3]
    assert made["error"].to_pylist()[0] is None and "byte" in made["error"].to_pylist()[1]


def test_the_command_comes_along(tmp_path):
    import subprocess
    import sys

    out = subprocess.run([sys.executable, "-m", "durer", "--version"], capture_output=True, text=True)
    assert out.returncode == 0 and out.stdout.strip() == f"durer {durer.__version__}"
    out = subprocess.run([sys.executable, "-m", "durer", "render"], capture_output=True, text=True)
    assert out.returncode == 2 and "required" in out.stderr
    out = subprocess.run([sys.executable, "-m", "durer", "render", "no.stl", "-o", str(tmp_path / "a.png")], capture_output=True, text=True)
    assert out.returncode == 1 and "no.stl" in out.stderr
