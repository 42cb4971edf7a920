"""The examples of the documentation run."""

from __future__ import annotations

import re

import pytest

from conftest import ROOT, SAMPLES

PAGES = [ROOT / "docs" / "python.md", ROOT / "crates" / "durer-py" / "README.md"]


def examples():
    for page in PAGES:
        text = page.read_text()
        for match in re.finditer(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
            line = text[: match.start()].count("\n") + 1
            yield pytest.param(match[1], id=f"{page.name}:{line}")


@pytest.mark.parametrize("code", list(examples()))
def test_example(code, tmp_path, monkeypatch):
    for library in ("trimesh", "geopandas", "pyarrow", "shapely"):
        if library in code:
            pytest.importorskip(library)
    (tmp_path / "samples").symlink_to(SAMPLES)
    monkeypatch.chdir(tmp_path)
    if "to_shapely" in code:
        pytest.importorskip("shapely")
    exec(compile(code, "example", "exec"), {"__name__": "example"})


def test_there_are_ten_recipes():
    recipes = PAGES[0].read_text().split("## Recipes")[1].split("## Coming from")[0]
    assert recipes.count("\n### ") >= 10
