"""`durer clip` beside GEOS (through shapely): the same regions, and valid?

    python3 geos.py DURER FILE...      # DURER: the built command; FILEs: GeoJSON with polygons
    python3 geos.py rect FOLDER        # clip_by_rect on the polygons that `clip-peers rect FOLDER` leaves there
    python3 geos.py mask DURER [N M]   # M small polygons cut by one coast of N vertices, GEOS with the mask prepared

Cuts every feature of each file to windows over its extent and to a slanted mask, by both, and prints how many
results differ by more than a billionth of the feature's area, how many are not valid by GEOS's judgement,
and the CPU seconds of both: of durer for the whole process, of GEOS for the cutting alone.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time

import numpy
import shapely


def features(path):
    with open(path) as file:
        all = json.load(file)["features"]
    shapes = []
    for number, feature in enumerate(all):
        shape = shapely.geometry.shape(feature["geometry"]) if feature["geometry"] else None
        if shape is not None and "Polygon" in shape.geom_type:
            feature["id"] = number
            shapes.append((number, shape if shape.is_valid else shapely.make_valid(shape)))
    return {"type": "FeatureCollection", "features": all}, dict(shapes)


def masks(shapes):
    x0, y0, x1, y1 = shapely.union_all(list(shapes.values())).bounds
    w, h = x1 - x0, y1 - y0
    yield "quarter", shapely.box(x0 + w * 0.3, y0 + h * 0.3, x0 + w * 0.8, y0 + h * 0.8)
    yield "small", shapely.box(x0 + w * 0.51, y0 + h * 0.7, x0 + w * 0.55, y0 + h * 0.75)
    slanted = [(x0 + w * u, y0 + h * v) for u, v in ((0.2, 0.5), (0.5, 0.1), (0.9, 0.6), (0.6, 0.9))]
    yield "slanted", shapely.Polygon(slanted)


def cpu_of_children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def cut(durer, folder, name, mask):
    out = os.path.join(folder, "out.geojson")
    command = [durer, "clip", name, "-o", out, "-q", "--threads", "1"]
    if mask == shapely.box(*mask.bounds):
        command += ["--window=" + ",".join(repr(float(v)) for v in mask.bounds)]
    else:
        by = os.path.join(folder, "mask.wkt")
        with open(by, "w") as file:
            file.write(shapely.to_wkt(mask, rounding_precision=17))
        command += ["--by", by]
    start = cpu_of_children()
    subprocess.run(command, check=True)
    with open(out) as file:
        found = json.load(file)["features"]
    return {f["id"]: shapely.geometry.shape(f["geometry"]) for f in found}, cpu_of_children() - start


def by_rectangle(folder):
    """CPU milliseconds of GEOS's own rectangle clip for all polygons of a file, medians of nine."""
    print(f"shapely {shapely.__version__}, GEOS {shapely.geos_version_string}")
    for name in sorted(os.listdir(folder)):
        numbers = numpy.fromfile(os.path.join(folder, name))
        count, points = (int(n) for n in numbers[:2].view("<u8"))
        polygons = shapely.polygons(numbers[2:].reshape(count, points, 2))
        times = []
        for _ in range(9):
            start = time.process_time()
            cut = shapely.clip_by_rect(polygons, 250_000, 250_000, 750_000, 750_000)
            times.append(time.process_time() - start)
        left = numpy.count_nonzero(~shapely.is_empty(cut))
        print(f"{name}: {sorted(times)[4] * 1e3:.1f} ms, {left} are left")


def coast(count, random):
    """A closed coast: waves of all lengths around a circle, and noise."""
    t = numpy.linspace(0, 2 * numpy.pi, count, endpoint=False)
    radius = numpy.ones(count)
    for k in range(1, 200):
        radius += random.normal() * 0.25 / k**1.2 * numpy.cos(k * t + random.uniform(0, 2 * numpy.pi))
    radius = (numpy.abs(radius) + 0.1) * (1 + random.normal(size=count) / count)
    return numpy.stack([100 * radius * numpy.cos(t), 100 * radius * numpy.sin(t)], 1)


def small(random):
    """A star of 4 to 12 vertices, up to 2 wide."""
    count = random.integers(4, 13)
    t = numpy.sort(random.uniform(0, 2 * numpy.pi, count))
    radius = random.uniform(0.4, 1, count) * random.uniform(0.05, 1)
    center = random.uniform(-160, 160, 2)
    return center + numpy.stack([radius * numpy.cos(t), radius * numpy.sin(t)], 1)


def write(name, shapes):
    features = [
        {"type": "Feature", "id": i, "properties": {}, "geometry": json.loads(shapely.to_geojson(s))}
        for i, s in enumerate(shapes)
    ]
    with open(name, "w") as file:
        json.dump({"type": "FeatureCollection", "features": features}, file)


def by_mask(durer, count, features):
    """CPU seconds: of durer for the whole process, of GEOS for preparing and cutting alone."""
    random = numpy.random.default_rng(5)
    mask = shapely.Polygon(coast(count, random))
    shapes = [shapely.Polygon(small(random)) for _ in range(features)]
    shapes = numpy.array([s if s.is_valid else shapely.make_valid(s) for s in shapes])
    with tempfile.TemporaryDirectory() as folder:
        names = [os.path.join(folder, name) for name in ("in.geojson", "mask.geojson", "out.geojson")]
        write(names[0], shapes)
        write(names[1], [mask])
        start = cpu_of_children()
        command = [durer, "clip", names[0], "--by", names[1], "-o", names[2], "-q", "--threads", "1"]
        subprocess.run(command, check=True)
        durer_seconds = cpu_of_children() - start
        with open(names[2]) as file:
            ours = {f["id"]: shapely.geometry.shape(f["geometry"]) for f in json.load(file)["features"]}
    start = time.process_time()
    shapely.prepare(mask)
    within = shapely.contains_properly(mask, shapes)
    cut = shapely.intersects(mask, shapes) & ~within
    theirs = numpy.where(within, shapes, shapely.Polygon())
    theirs[cut] = shapely.intersection(shapes[cut], mask)
    geos_seconds = time.process_time() - start
    none = shapely.Polygon()
    area = [shapely.area(ours.get(i, none)) for i in range(features)]
    apart = numpy.abs(numpy.array(area) - shapely.area(theirs)) > 1e-9 * shapely.area(shapes)
    found = f"{within.sum()} within, {cut.sum()} across, areas differ for {apart.sum()}"
    print(f"{count} x {features}: {found}; durer {durer_seconds:.2f} s, GEOS {geos_seconds:.2f} s")


def main(durer, paths):
    print(f"shapely {shapely.__version__}, GEOS {shapely.geos_version_string}")
    print("| file | mask | features | differ | not valid | durer, s | GEOS, s |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for path in paths:
            document, shapes = features(path)
            name = os.path.join(folder, "in.geojson")
            with open(name, "w") as file:
                json.dump(document, file)
            for title, mask in masks(shapes):
                ours, seconds = cut(durer, folder, name, mask)
                start = time.process_time()
                theirs = {n: shapely.intersection(s, mask) for n, s in shapes.items()}
                geos = time.process_time() - start
                none = shapely.Polygon()
                apart = sum(
                    shapely.symmetric_difference(ours.get(n, none), t).area > 1e-9 * shapes[n].area
                    for n, t in theirs.items()
                )
                invalid = sum(not ours[n].is_valid for n in theirs if n in ours)
                label = os.path.basename(path)
                print(f"| {label} | {title} | {len(theirs)} | {apart} | {invalid} | {seconds:.3f} | {geos:.3f} |")


if __name__ == "__main__":
    if sys.argv[1] == "rect":
        by_rectangle(sys.argv[2])
    elif sys.argv[1] == "mask":
        numbers = [int(n) for n in sys.argv[3:5]] or [500_000, 20_000]
        by_mask(sys.argv[2], *numbers)
    else:
        main(sys.argv[1], sys.argv[2:])
