"""Lines, drawings, plots, maps and steps."""

from __future__ import annotations

import json
import pickle
import subprocess

import numpy as np
import pytest

import durer


def test_hidden_lines_of_a_cube(cube):
    lines = durer.hidden_lines(cube)
    assert lines.coords.dtype == np.float64 and lines.offsets.dtype == np.int64
    assert lines.cls.dtype == np.uint8 and lines.invisibility.dtype == np.uint32 and lines.closed.dtype == bool
    assert lines.offsets[0] == 0 and lines.offsets[-1] == len(lines.coords)
    length = {True: 0.0, False: 0.0}
    for chain, hidden in zip(lines.chains(), lines.invisibility > 0, strict=True):
        length[bool(hidden)] += np.linalg.norm(np.diff(chain, axis=0), axis=1).sum()
    # From a corner nine edges of a cube are visible, three hidden.
    assert abs(length[False] / length[True] - 3.0) < 1e-6
    visible = durer.hidden_lines(cube, hidden=False)
    assert (visible.invisibility == 0).all() and 0 < len(visible) < len(lines)
    names = {durer.LINE_CLASSES[c] for c in lines.cls}
    assert names <= {"silhouette", "crease", "contour"}
    only = durer.hidden_lines(cube, classes=["crease"])
    assert {durer.LINE_CLASSES[c] for c in only.cls} == {"crease"}
    with pytest.raises(ValueError, match="lines"):
        durer.hidden_lines(cube, classes=["creases"])


def test_lines_as_shapely(cube):
    pytest.importorskip("shapely")
    made = durer.hidden_lines(cube).to_shapely()
    assert all(line.geom_type == "LineString" for line in made)


@pytest.mark.parametrize("suffix", ["svg", "pdf", "dxf", "hpgl", "geojson"])
def test_files_are_those_of_the_command(suffix, samples, command, tmp_path):
    path = samples / "bracket.stl"
    out, own = tmp_path / f"a.{suffix}", tmp_path / f"b.{suffix}"
    words = ["--style=hidden-line", "--view=front", "--hidden=dashed"]
    subprocess.run([*command, "render", str(path), "-o", str(out), "--quiet", *words], check=True)
    durer.drawing(durer.read(path), view="front", hidden="dashed").save(own)
    assert own.read_bytes() == out.read_bytes()
    assert sorted(p.name for p in tmp_path.iterdir()) == [out.name, own.name]


def test_drawings(cube, tmp_path):
    for style in ("hidden-line", "wireframe", "regions", "regions+lines", "shadows"):
        assert "<svg" in durer.drawing(cube, style).to_svg()
    page = durer.drawing(cube, page=(120, 80)).to_svg()
    assert 'width="120mm"' in page
    sheet = durer.drawing(cube, sheet="third-angle", page="A4")
    sheet.save(tmp_path / "sheet.png")
    assert sheet._repr_svg_() == sheet.to_svg()
    with pytest.raises(ValueError, match="style"):
        durer.drawing(cube, "sketch")
    with pytest.raises(ValueError, match="bmp"):
        durer.drawing(cube).save(tmp_path / "a.bmp")


def test_plot(command, tmp_path):
    z, x = np.mgrid[-4:4:21j, -4:4:21j]
    heights = np.sin(x) * np.cos(z)
    np.save(tmp_path / "z.npy", heights)
    words = ["--x=-4,4", "--z=-4,4", "--title=Waves"]
    subprocess.run([*command, "plot", str(tmp_path / "z.npy"), "-o", str(tmp_path / "a.svg"), "--quiet", *words], check=True)
    plot = durer.plot(heights, x=(-4, 4), z=(-4, 4), title="Waves")
    assert plot.to_svg() == (tmp_path / "a.svg").read_text()
    assert plot.image((80, 60)).pixels.shape == (60, 80, 4)
    for suffix in ("pdf", "png", "dxf"):
        plot.save(tmp_path / f"b.{suffix}")
    with pytest.raises(TypeError, match="rows, columns"):
        durer.plot(np.zeros(4))
    with pytest.raises(ValueError, match="2 rows"):
        durer.plot(np.zeros((1, 4)))
    with pytest.raises(TypeError, match="unexpected keyword argument 'tilt'"):
        durer.plot(heights, tilt=4)


def test_draw(samples, command, tmp_path):
    countries = samples / "countries.geojson"
    out = tmp_path / "a.png"
    style = {"fill": "#f2ead8", "stroke": "none", "label": "name"}
    words = [str(countries), *(f"--{k}={v}" for k, v in style.items()), "--size=200x", "--background=#d3e4ef"]
    subprocess.run([*command, "draw", *words, "-o", str(out), "--quiet"], check=True)
    for layer in (countries, countries.read_bytes(), countries.read_text(), json.loads(countries.read_text())):
        picture = durer.draw([(layer, style)], (200, None), background="#d3e4ef")
        assert picture.png() == out.read_bytes()
    svg = durer.draw(samples / "perspective.svg", (64, None))
    assert svg.width == 64
    square = {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]]}
    assert durer.draw([(square, {"fill": "red", "stroke": "none"})], (9, 9)).pixels[4, 4].tolist() == [255, 0, 0, 255]
    with pytest.raises(ValueError, match="one at least"):
        durer.draw([])
    with pytest.raises(ValueError):
        durer.draw(b"no map")


@pytest.mark.parametrize("suffix", ["svg", "pdf", "dxf"])
def test_draw_writes_vectors_as_the_command(suffix, samples, command, tmp_path):
    countries = samples / "countries.geojson"
    out, own = tmp_path / f"a.{suffix}", tmp_path / f"b.{suffix}"
    words = [str(countries), "--fill=tan", "--label=name", "--size=200x", str(countries), "--fill=none", "--stroke=red"]
    subprocess.run([*command, "draw", *words, "-o", str(out), "--quiet"], check=True)
    layers = [(countries, {"fill": "tan", "label": "name"}), (countries, {"fill": "none", "stroke": "red"})]
    picture = durer.draw(layers, (200, None))
    picture.save(own)
    assert own.read_bytes() == out.read_bytes()
    assert picture.encode(suffix.upper()) == out.read_bytes()
    again = pickle.loads(pickle.dumps(picture))
    assert again == picture and again.encode(suffix) == out.read_bytes()


def test_vectors_of_drawings(tmp_path):
    square = {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]]}
    picture = durer.draw([square, (square, {"opacity": 0.5})], (9, 9))
    assert 'inkscape:label="layer1"' in picture.to_svg()
    with pytest.raises(ValueError, match="opacities of whole layers cannot be written as DXF"):
        picture.save(tmp_path / "a.dxf")
    assert not list(tmp_path.iterdir())
    with pytest.raises(ValueError, match="hpgl"):
        picture.encode("hpgl")
    with pytest.raises(ValueError, match="aa"):
        durer.draw(square, (9, 9), aa="none").to_svg()


def test_tiles(samples, tmp_path):
    durer.tiles(samples / "countries.geojson", tmp_path / "a.pmtiles", zoom=(0, 2))
    assert (tmp_path / "a.pmtiles").read_bytes().startswith(b"PMTiles")
    square = {"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]]]}
    durer.tiles([square], tmp_path / "tiles", zoom=1, names=["land"])
    assert (tmp_path / "tiles" / "1" / "1" / "0.mvt").exists()
    with pytest.raises(ValueError, match="zoom"):
        durer.tiles([square], tmp_path / "b.pmtiles", zoom=30)


def test_trace():
    steps = durer.trace("cohen-sutherland", [[-1, 1], [5, 3]], window=(0, 0, 4, 4))
    assert steps and {"line", "kind", "caption", "values"} <= set(steps[0])
    assert steps.facts["pseudocode"]
    first = durer.trace("cohen-sutherland", [[-1, 1], [5, 3]], window=(0, 0, 4, 4), cap=2)
    assert first[:2] == steps[:2] and [step["kind"] for step in first[2:]] == ["more"]
    page = steps.explore()
    assert "<script" in page.html and page._repr_html_().startswith("<iframe")
    assert durer.trace("bresenham", language="de")[0]["caption"] != durer.trace("bresenham")[0]["caption"]
    square, other = [[0, 0], [2, 0], [2, 2], [0, 2], [0, 0]], [[1, 1], [3, 1], [3, 3], [1, 3]]
    assert durer.trace("weiler-atherton", square, clip=other)
    assert durer.trace("spans", np.zeros((4, 4), np.uint8), seed=(1, 1))
    for name, examples in list(durer.lessons().items())[:5]:
        assert durer.trace(name, example=examples[0])
    with pytest.raises(ValueError, match="nearest"):
        durer.trace("cohen-southerland")
    with pytest.raises(TypeError, match="example"):
        durer.trace("bresenham", [[0, 0], [1, 1]], example="steep")
    assert len(durer.algorithms()) > 80
