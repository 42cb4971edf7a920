"""Clipping and overlays, compared with shapely's results."""

from __future__ import annotations

import threading

import numpy as np
import pytest

import durer

shapely = pytest.importorskip("shapely")

RECT = (0.2, 0.1, 0.8, 0.7)


@pytest.fixture
def polygons():
    """Stars with and without holes, all over the unit square."""
    random = np.random.default_rng(5)
    made = []
    for i in range(200):
        angles = np.sort(random.uniform(0, 2 * np.pi, 12))
        radii = random.uniform(0.3, 1.0, 12) * 0.2
        ring = random.uniform(0, 1, 2) + np.stack([radii * np.cos(angles), radii * np.sin(angles)], 1)
        star = shapely.make_valid(shapely.Polygon(ring))
        if i % 3 == 0:
            star = star.difference(star.centroid.buffer(0.02))
        made.append(star)
    out = np.empty(len(made), dtype=object)
    out[:] = made
    return out


def test_segments():
    random = np.random.default_rng(1)
    segments = random.uniform(-1, 2, (5000, 2, 2))
    clipped, kept = durer.clip_lines(segments, (0, 0, 1, 1))
    assert clipped.shape == segments.shape and kept.dtype == bool
    expected = shapely.intersection(shapely.linestrings(segments), shapely.box(0, 0, 1, 1))
    assert (kept == ~shapely.is_empty(expected)).all()
    assert np.allclose(np.linalg.norm(clipped[kept, 1] - clipped[kept, 0], axis=1), shapely.length(expected[kept]))
    assert (clipped[~kept] == segments[~kept]).all()
    x0, y0, x1, y1 = (np.ascontiguousarray(segments.reshape(-1, 4)[:, i]) for i in range(4))
    arrays, flags = durer.clip_lines((x0, y0, x1, y1), (0, 0, 1, 1))
    assert (np.stack(arrays, 1).reshape(-1, 2, 2) == clipped).all() and (flags == kept).all()
    f32, _ = durer.clip_lines(segments.astype(np.float32)[::-1], (0, 0, 1, 1))
    assert f32.dtype == np.float64
    ring = [[0, 0], [1, 0], [0, 1]]
    clipped, kept = durer.clip_lines(segments, ring)
    expected = shapely.intersection(shapely.linestrings(segments), shapely.Polygon(ring))
    assert np.allclose(np.linalg.norm(clipped[kept, 1] - clipped[kept, 0], axis=1), shapely.length(expected[kept]))
    assert (durer.clip_lines(segments, ring, threads=1)[0] == clipped).all()


def test_wrong_segments():
    segments = np.zeros((40_000, 2, 2))
    segments[33_333, 1, 0] = np.inf
    for what in (segments, tuple(np.ascontiguousarray(segments.reshape(-1, 4)[:, i]) for i in range(4))):
        with pytest.raises(ValueError, match=r"segments\[33333\]"):
            durer.clip_lines(what, (0, 0, 1, 1))
    with pytest.raises(ValueError, match=r"segments\[33333\]"):
        durer.clip_lines(segments, [[0, 0], [1, 0], [0, 1]])
    with pytest.raises(TypeError, match=r"segments must be \(n, 2, 2\), got \(3, 4\)"):
        durer.clip_lines(np.zeros((3, 4)), (0, 0, 1, 1))
    with pytest.raises(TypeError, match="rect"):
        durer.clip_lines(segments, (0, 0, 1))
    with pytest.raises(ValueError, match="rect"):
        durer.clip_lines(segments[:1], (0, 0, np.nan, 1))
    with pytest.raises(ValueError, match="convex"):
        durer.clip_lines(segments[:1], [[0, 0], [4, 0], [1, 1], [0, 4]])
    empty, kept = durer.clip_lines(np.zeros((0, 2, 2)), (0, 0, 1, 1))
    assert empty.shape == (0, 2, 2) and kept.shape == (0,)


def test_clip_by_rect_gives_shapelys_areas(polygons):
    made = durer.clip_by_rect(polygons, *RECT)
    expected = shapely.intersection(polygons, shapely.box(*RECT))
    assert made.dtype == object and made.shape == polygons.shape
    assert np.allclose(shapely.area(made), shapely.area(expected), atol=1e-12)
    assert shapely.is_valid(made).all()
    assert (shapely.is_empty(made) == (shapely.area(expected) == 0)).all()
    assert durer.clip_by_rect(polygons[0], *RECT).equals(made[0])
    assert durer.clip_by_rect(list(polygons[:3]), *RECT) == list(made[:3])
    shaped = durer.clip_by_rect(polygons.reshape(10, 20), *RECT)
    assert shaped.shape == (10, 20) and shaped[1, 0] == made[20]
    assert (durer.clip_by_rect(polygons, *RECT, threads=1) == made).all()


def test_lines_points_and_missing_ones():
    lines = shapely.linestrings(np.random.default_rng(2).uniform(0, 1, (50, 9, 2)))
    made = durer.clip_by_rect(lines, *RECT)
    assert np.allclose(shapely.length(made), shapely.length(shapely.intersection(lines, shapely.box(*RECT))))
    points = np.array([shapely.Point(0.5, 0.5), None, shapely.Point(0.9, 0.9)], dtype=object)
    made = durer.clip_by_rect(points, *RECT)
    assert made[0] == points[0] and made[1] is None and made[2].is_empty
    high = durer.clip_by_rect(shapely.LineString([(0, 0.5, 0), (1, 0.5, 10)]), *RECT)
    assert np.allclose(shapely.get_coordinates(high, include_z=True), [[0.2, 0.5, 2], [0.8, 0.5, 8]])
    nan = np.array([shapely.Point(0, 0), shapely.LineString([(0, 0), (np.nan, 1)])], dtype=object)
    with pytest.raises(ValueError, match=r"geometries\[1\]"):
        durer.clip_by_rect(nan, *RECT)


def mixed_geometries(polygons) -> np.ndarray:
    """Returns polygons of both directions with lines, points, holes, several parts, heights and gaps among them."""
    out = polygons.copy()
    out[::2] = shapely.reverse(out[::2])
    out[:40] = shapely.linestrings(np.random.default_rng(2).uniform(0, 1, (40, 9, 2)))
    comb = [(0, 0), (1, 0), (1, 0.3), (0.7, 0.3), (0.7, 0.05), (0.3, 0.05), (0.3, 0.3), (0, 0.3)]
    bow_tie = [(0.3, 0.3), (0.5, 0.5), (0.5, 0.3), (0.3, 0.5)]
    high = shapely.Polygon([(0, 0, 1), (1, 0, 2), (0.5, 1, 3)])
    apart = shapely.MultiPolygon([shapely.box(0, 0, 0.3, 0.3), shapely.box(0.5, 0.5, 0.6, 0.6)])
    special = [None, shapely.Point(0.5, 0.5), shapely.Polygon(comb), shapely.Polygon(bow_tie), high, apart, shapely.Polygon()]
    for at, geometry in enumerate(special):
        out[60 + 5 * at] = geometry
    return out


@pytest.mark.parametrize("mask", [RECT, shapely.Point(0.5, 0.5).buffer(0.3)])
def test_arrays_of_coordinates_give_what_wkb_gives(polygons, mask, monkeypatch):
    given = mixed_geometries(polygons)
    fast = durer.clip(given, mask)
    monkeypatch.setattr("durer._geometry.FEW", 10**9)
    slow = durer.clip(given, mask)
    assert (shapely.get_type_id(fast) == shapely.get_type_id(slow)).all()
    for a, b in zip(fast, slow, strict=True):
        assert (a is None) == (b is None)
        assert a is None or shapely.normalize(a).equals_exact(shapely.normalize(b)), (a, b)
    assert set(shapely.get_type_id(fast).tolist()) >= {-1, 0, 3, 5, 6}


def test_chunks_do_not_show(polygons, monkeypatch):
    given = mixed_geometries(polygons)
    whole = durer.clip_by_rect(given, *RECT)
    monkeypatch.setattr("durer._geometry.CHUNK", 30)
    for threads in (1, 3):
        parts = durer.clip_by_rect(given, *RECT, threads=threads)
        assert (shapely.to_wkb(parts) == shapely.to_wkb(whole)).all()
        given[131] = shapely.Polygon([(5, 5), (np.nan, 6), (6, 6)])
        with pytest.raises(ValueError, match=r"^geometries\[131\]: .* not finite"):
            durer.clip_by_rect(given, *RECT, threads=threads)
        given[131] = polygons[131]


def test_what_is_outside_is_empty_and_of_its_kind():
    line, ring = shapely.LineString([(5, 5), (6, 6)]), shapely.box(5, 5, 6, 6)
    some = [line, ring, shapely.MultiLineString([line, line]), shapely.MultiPolygon([ring]), shapely.Point(5, 5)]
    given = np.array(some * 4, dtype=object)
    made = durer.clip_by_rect(given, *RECT)
    assert shapely.is_empty(made).all() and (shapely.get_type_id(made) == shapely.get_type_id(given)).all()
    endless = shapely.MultiPolygon([ring, shapely.Polygon([(7, 7), (np.inf, 8), (8, 8)])])
    for wrong in (shapely.MultiLineString([[(5, 5), (6, 6)], [(7, 7), (7, np.nan)]]), endless):
        given[13] = wrong
        with pytest.raises(ValueError, match=r"^geometries\[13\]: .* finite"):
            durer.clip_by_rect(given, *RECT)


def test_what_is_inside_whole_is_the_same_object(polygons):
    made = durer.clip_by_rect(polygons[:100], -1, -1, 2, 2)
    whole = shapely.get_num_interior_rings(polygons[:100]) == 0
    assert whole.any() and all(a is b for a, b in zip(made[whole], polygons[:100][whole], strict=True))


def test_errors_of_large_arrays_have_their_index(polygons):
    given = mixed_geometries(polygons)
    given[131] = shapely.LineString([(5, 5), (np.nan, 6)])
    with pytest.raises(ValueError, match=r"^geometries\[131\]: .* not finite"):
        durer.clip_by_rect(given, *RECT)
    with pytest.raises(ValueError, match="rect"):
        durer.clip_by_rect(polygons, 9, 9, 8, 8)
    with pytest.raises(ValueError, match=r"mask\[0\]"):
        durer.clip(polygons, shapely.LineString([(7, 7), (8, 8)]))
    broken = polygons.copy()
    broken[131] = shapely.Polygon([(5, 5), (np.nan, 6), (6, 6)])
    for pair in [(broken, polygons), (polygons, broken)]:
        with pytest.raises(ValueError, match=r"^geometries\[131\]: .* not finite"):
            durer.union(*pair)


def test_ragged_arrays_are_as_geometries(polygons):
    ragged = shapely.to_ragged_array(polygons)
    kind, coords, offsets = durer.clip_by_rect(ragged, *RECT)
    again = shapely.from_ragged_array(kind, coords, offsets)
    assert (coords[offsets[0][:-1]] == coords[offsets[0][1:] - 1]).all()
    made = durer.clip_by_rect(polygons, *RECT)
    assert np.allclose(shapely.area(again), shapely.area(made), atol=1e-15)
    lines = shapely.linestrings(np.random.default_rng(2).uniform(0, 1, (50, 9, 2)))
    kind, coords, offsets = durer.clip_by_rect(shapely.to_ragged_array(lines), *RECT)
    assert np.allclose(shapely.length(shapely.from_ragged_array(kind, coords, offsets)), shapely.length(durer.clip_by_rect(lines, *RECT)))
    points = shapely.points(np.random.default_rng(3).uniform(0, 1, (50, 2)))
    kind, coords, offsets = durer.clip_by_rect(shapely.to_ragged_array(points), *RECT)
    assert (np.isnan(coords[:, 0]) == ~shapely.intersects(points, shapely.box(*RECT))).all()


@pytest.mark.parametrize("comb", [False, True])
def test_ragged_polygons_that_stay_run_as_others(comb):
    # Clockwise, its hole counter-clockwise; beside one that the rectangle cuts in two, if any.
    square = [(1, 1), (1, 3), (3, 3), (3, 1), (1, 1)], [(1.5, 1.5), (2, 1.5), (2, 2), (1.5, 1.5)]
    teeth = [(4, -9), (4, 3), (5, 3), (5, -5), (6, -5), (6, 3), (7, 3), (7, -9), (4, -9)]
    rings = [*square, teeth] if comb else [*square]
    ends = np.cumsum([0, *map(len, rings)])
    given = np.array(sum(rings, []), dtype=float), (ends, np.array([0, 2, 3] if comb else [0, 2]))
    coords, offsets = durer.clip_by_rect(given, 0, 0, 9, 9)
    assert coords[:9].tolist() == [
        *([1, 1], [3, 1], [3, 3], [1, 3], [1, 1]),
        *([1.5, 1.5], [2, 2], [2, 1.5], [1.5, 1.5]),
    ]
    assert offsets[0][:3].tolist() == [0, 5, 9] and offsets[1][:2].tolist() == [0, 2]
    assert len(offsets) == (3 if comb else 2) and (not comb or offsets[2].tolist() == [0, 1, 3])


def test_wrong_ragged_arrays():
    square = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4], [0, 0]])
    for offsets, match in [
        (([0, 9], [0, 1]), r"offsets\[0\]\[1\] = 9 is above 5"),
        (([0, 5, 3], [0, 1]), r"offsets\[0\]\[2\] = 3 is less"),
        (([-1, 5], [0, 1]), r"offsets\[0\]\[0\] = -1 is below 0"),
        (([0, 5], []), r"offsets\[1\] is empty"),
    ]:
        with pytest.raises(ValueError, match=match):
            durer.clip_by_rect((square, offsets), 1, 1, 2, 2)
    with pytest.raises(TypeError, match="coords"):
        durer.clip_by_rect((np.zeros((3, 4)), ([0, 3], [0, 1])), 1, 1, 2, 2)
    with pytest.raises(TypeError, match="type 255"):
        durer.clip_by_rect((square, ([0], [0], [0], [0])), 1, 1, 2, 2)


@pytest.mark.parametrize("name", ["intersection", "union", "difference", "symmetric_difference"])
def test_overlays_give_shapelys_areas(name, polygons):
    a, b = polygons[:100], polygons[100:]
    made = getattr(durer, name)(a, b)
    expected = getattr(shapely, name)(a, b)
    assert np.allclose(shapely.area(made), shapely.area(expected), atol=1e-12)
    assert shapely.is_valid(made).all()
    assert np.allclose(shapely.area(getattr(durer, name)(a, b[0])), shapely.area(getattr(shapely, name)(a, b[0])), atol=1e-12)
    grid = getattr(durer, name)(a[:20, None], b[None, :3])
    assert grid.shape == (20, 3)
    assert abs(getattr(durer, name)(a[0], b[0]).area - expected[0].area) < 1e-12
    assert getattr(durer, name)(a[0], None) is None


def test_bow_ties_come_out_valid():
    bow_tie = shapely.Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])
    made = durer.intersection(bow_tie, shapely.box(0, 0, 2, 2))
    assert made.is_valid and abs(made.area - 2.0) < 1e-12


def test_lines_with_polygons():
    line, box = shapely.LineString([(-1, 0.5), (3, 0.5)]), shapely.box(0, 0, 1, 1)
    assert durer.intersection(line, box).length == 1.0 == durer.intersection(box, line).length
    assert durer.difference(line, box).length == 3.0
    assert durer.difference(box, line).area == 1.0
    with pytest.raises(ValueError, match=r"geometries\[0\]: union of a LineString and a Polygon"):
        durer.union(line, box)


def test_clip_to_polygons(polygons):
    mask = shapely.unary_union(polygons[:5])
    made = durer.clip(polygons, mask)
    assert np.allclose(shapely.area(made), shapely.area(shapely.intersection(polygons, mask)), atol=1e-12)
    assert np.allclose(shapely.area(durer.clip(polygons, polygons[:5])), shapely.area(made), atol=1e-12)
    assert (shapely.area(durer.clip(polygons, RECT)) == shapely.area(durer.clip_by_rect(polygons, *RECT))).all()
    with pytest.raises(ValueError, match=r"mask\[0\]: a LineString has no area"):
        durer.clip(polygons, shapely.LineString([(0, 0), (1, 1)]))


def test_wkb(polygons):
    rows = list(shapely.to_wkb(polygons[:4]))
    made = durer.clip_by_rect([*rows, None], *RECT)
    assert made[4] is None and [shapely.from_wkb(m).area for m in made[:4]] == [g.area for g in durer.clip_by_rect(polygons[:4], *RECT)]
    assert isinstance(durer.clip_by_rect(rows[0], *RECT), bytes)
    with pytest.raises(ValueError, match=r"geometries\[1\]: byte 5"):
        durer.clip_by_rect([rows[0], rows[1][:5]], *RECT)
    ewkb = shapely.to_wkb(shapely.set_srid(polygons[0], 4326), include_srid=True)
    assert shapely.get_srid(shapely.from_wkb(durer.clip_by_rect(ewkb, *RECT))) == 4326


def test_arrow(polygons):
    pa = pytest.importorskip("pyarrow")
    column = pa.array([*shapely.to_wkb(polygons), None], pa.binary())
    made = durer.clip_by_rect(column, *RECT)
    assert made.type == pa.binary() and made.null_count == 1 and made[200].as_py() is None
    expected = durer.clip_by_rect(polygons, *RECT)
    assert np.allclose(shapely.area(shapely.from_wkb(made.to_pylist()[:200])), shapely.area(expected))
    part = durer.clip_by_rect(column.slice(50, 20), *RECT)
    assert part.to_pylist() == made.to_pylist()[50:70]
    chunked = durer.clip_by_rect(pa.chunked_array([column.slice(0, 9), column.slice(9, 9)]), *RECT)
    assert chunked.to_pylist() == made.to_pylist()[:18]
    with pytest.raises(TypeError, match="WKB"):
        durer.clip_by_rect(pa.array([1, 2]), *RECT)


def test_geopandas(polygons):
    geopandas = pytest.importorskip("geopandas")
    index = np.arange(200) * 2
    frame = geopandas.GeoDataFrame({"n": np.arange(200)}, geometry=polygons, crs=4326, index=index)
    made = durer.clip(frame, RECT)
    expected = geopandas.clip(frame, RECT)
    common = expected.index
    assert set(common) >= set(made.index) and list(made.columns) == list(frame.columns) and made.crs == frame.crs
    assert np.allclose(made.area.sum(), expected.area.sum()) and (made["n"] * 2 == made.index).all()
    series = durer.clip_by_rect(frame.geometry, *RECT)
    assert list(series.index) == list(index) and series.crs == frame.crs
    with pytest.warns(UserWarning, match="CRS mismatch"):
        durer.clip(frame, frame.iloc[:3].set_crs(3857, allow_override=True))


def test_the_lock_is_released(polygons):
    many = np.repeat(polygons, 3)
    rows = list(shapely.to_wkb(many))
    seen = []
    thread = threading.Thread(target=lambda: seen.append(durer.clip_by_rect(rows, *RECT)))
    thread.start()
    own = durer.clip_by_rect(rows, *RECT)
    thread.join()
    assert own == seen[0]


def test_rasterize():
    square = shapely.box(1, 1, 3, 3)
    out = durer.rasterize([(square, 7)], (4, 5))
    assert out.dtype == np.uint8 and out.tolist() == [[0] * 5, [0, 7, 7, 0, 0], [0, 7, 7, 0, 0], [0] * 5]
    north_up = (0.5, 0, 0, 0, -0.5, 2)
    up = durer.rasterize([(shapely.box(0, 0, 0.5, 0.5), 300)], (4, 4), north_up, fill=-1)
    assert up.dtype == np.int16 and up[3].tolist() == [300, -1, -1, -1] and (up[:3] == -1).all()
    moved = durer.rasterize([shapely.Point(103, 207.5)], (5, 6), (1, 0.5, 100, -0.5, 2, 205))
    column, row = np.linalg.solve([[1, 0.5], [-0.5, 2]], [3, 2.5])
    assert moved.sum() == 1 and moved[int(row), int(column)] == 1
    half = durer.rasterize([shapely.box(0.5, 0, 2, 1)], (1, 3), mode="coverage")
    assert half.dtype == np.float32 and np.allclose(half, [[0.5, 1, 0]], atol=1 / 255)
    hole = shapely.box(0, 0, 5, 5).difference(shapely.box(1, 1, 4, 4))
    assert durer.rasterize([hole], (5, 5)).sum() == 16
    assert durer.rasterize([shapely.Point(2.5, 1.5)], (3, 4)).tolist() == [[0] * 4, [0, 0, 1, 0], [0] * 4]
    assert durer.rasterize([shapely.LineString([(0.5, 0.5), (2.5, 2.5)])], (3, 3)).tolist() == np.eye(3).tolist()
    later = durer.rasterize([(shapely.box(0, 0, 2, 2), 1), (shapely.box(1, 1, 3, 3), 2)], (3, 3))
    assert later.tolist() == [[1, 1, 0], [1, 2, 2], [0, 2, 2]]


def test_rasterize_touched_is_what_shapely_says():
    random = np.random.default_rng(8)
    ring = random.uniform(-2, 14, (3, 2))
    triangle = shapely.Polygon(ring)
    out = durer.rasterize([triangle], (12, 12), all_touched=True)
    cells = np.array([[triangle.intersects(shapely.box(x, y, x + 1, y + 1)) for x in range(12)] for y in range(12)])
    assert (out.astype(bool) == cells).all()
    centers = np.array([[triangle.contains(shapely.Point(x + 0.5, y + 0.5)) for x in range(12)] for y in range(12)])
    assert (durer.rasterize([triangle], (12, 12)).astype(bool) == centers).all()


def test_wrong_shapes():
    with pytest.raises(TypeError, match=r"shapes\[0\]"):
        durer.rasterize([None], (2, 2))
    with pytest.raises(ValueError, match="out_shape"):
        durer.rasterize([], (0, 2))
    with pytest.raises(ValueError, match="inverse"):
        durer.rasterize([], (2, 2), (0, 0, 0, 0, 0, 0))
    with pytest.raises(ValueError, match="mode"):
        durer.rasterize([], (2, 2), mode="all")
    with pytest.raises(ValueError, match=r"shapes\[0\].*finite"):
        durer.rasterize([shapely.Point(np.inf, 0)], (2, 2))
