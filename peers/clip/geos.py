"""`durer clip` beside GEOS (through shapely): the same regions, and valid?

    python3 geos.py DURER FILE...      # DURER: the built command; FILEs: GeoJSON with polygons
    python3 geos.py rect FOLDER        # clip_by_rect on the polygons that `clip-peers rect FOLDER` leaves there

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
    else:
        main(sys.argv[1], sys.argv[2:])
