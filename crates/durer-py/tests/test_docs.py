"""The examples of the documentation run and give the same results as the other packages."""

from __future__ import annotations

import importlib
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from conftest import ROOT, SAMPLES

PAGES = [ROOT / "docs" / "python.md", ROOT / "docs" / "coming-from.md", ROOT / "crates" / "durer-py" / "README.md"]

BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
PAIR = re.compile(r'^<div class="pair" markdown>\n(.*?)^</div>$', re.MULTILINE | re.DOTALL)

#: Other packages whose code runs without a display.
COMPARED = ("shapely", "geopandas", "rasterio")


def owner(code: str) -> str:
    """Returns the package that a pair's code uses."""
    first = code.splitlines()[0]
    return first.removeprefix("# ") if first.startswith("# ") else "durer"


def line(text: str, at: int) -> int:
    return text[:at].count("\n") + 1


def examples() -> Iterator[Any]:
    for page in PAGES:
        text = page.read_text()
        for match in BLOCK.finditer(text):
            if owner(match[1]) == "durer":
                yield pytest.param(match[1], id=f"{page.name}:{line(text, match.start())}")


def pairs() -> Iterator[Any]:
    for page in PAGES:
        text = page.read_text()
        for match in PAIR.finditer(text):
            codes = [block[1] for block in BLOCK.finditer(match[1])]
            yield pytest.param(codes, id=f"{page.name}:{line(text, match.start())}")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A current folder with the samples."""
    (tmp_path / "samples").symlink_to(SAMPLES)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(code: str) -> dict[str, Any]:
    """Runs code and returns its names; skips where a package is missing."""
    imported = re.findall(r"^(?:import|from) (.+?)(?: as \w+| import .*)?$", code, re.MULTILINE)
    wanted = {name.split(".")[0] for names in imported for name in names.split(", ")}
    if "to_shapely" in code:
        wanted.add("shapely")
    for name in sorted(wanted):
        try:
            importlib.import_module(name)
        except ImportError:
            pytest.skip(f"{name} is not installed")
    names: dict[str, Any] = {"__name__": "example"}
    exec(compile(code, "example", "exec"), names)
    return names


@pytest.mark.parametrize("code", list(examples()))
def test_example(code, folder):
    run(code)


@pytest.mark.parametrize("codes", list(pairs()))
def test_pairs_give_the_same(codes, folder):
    theirs, ours = codes
    assert owner(theirs) != "durer" and owner(ours) == "durer"
    compile(theirs, owner(theirs), "exec")
    if owner(theirs) not in COMPARED or "result" not in ours:
        return
    wanted, found = run(theirs)["result"], run(ours)["result"]
    assert type(found) is type(wanted)
    if hasattr(wanted, "columns"):
        wanted = wanted.loc[found.index]
        assert list(found.columns) == list(wanted.columns)
        wanted, found = wanted.geometry.area, found.geometry.area
    elif wanted.dtype == object:
        import shapely

        assert shapely.is_valid(found).all()
        wanted, found = shapely.area(wanted), shapely.area(found)
    assert np.shape(found) == np.shape(wanted) and np.any(np.asarray(found) > 0)
    np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-15)


def test_there_are_ten_recipes():
    recipes = PAGES[0].read_text().split("## Recipes")[1].split("## Errors")[0]
    assert recipes.count("\n### ") >= 10


def test_there_are_pairs_for_each_package():
    owners = {owner(block[1]) for block in BLOCK.finditer(PAGES[1].read_text())}
    assert owners == {"trimesh", "pyrender", "shapely", "geopandas", "rasterio", "f3d", "durer"}
