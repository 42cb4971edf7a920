"""Hidden lines of durer beside the exact ones of Open CASCADE: twelve CAD parts, three tolerances, three views.

    python occt.py DURER [--smooth=auto] [PART ...]

DURER is the command; what follows and begins with "-" goes to it. Needs `pip install cadquery numpy`. Prints for each
drawing what of the exact lines is missing and what is drawn beside them, visible and hidden, in percent of the length of
all exact lines; a line is there where one of its kind lies within 0.4 % of the part's diagonal: a chord's sagitta at the
coarsest tolerance, and what stubs and hidden lines beneath visible ones may take.
"""
import json, math, os, subprocess, sys, tempfile
import cadquery as cq
import numpy as np
from cadquery import exporters
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepLib import BRepLib
from OCP.GCPnts import GCPnts_UniformAbscissa
from OCP.HLRAlgo import HLRAlgo_Projector
from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

VIEWS = {"isometric": (1, -1, 1), "high": (0.3, -0.8, 1.6), "odd": (1, -2.2, 0.45)}
MESHES = ((0.2, 0.5), (0.05, 0.3), (0.01, 0.1))


def gear():
    points = []
    for i in range(16):
        for a, r in ((0, 10), (0.25, 10), (0.35, 12), (0.65, 12), (0.75, 10)):
            t = 2 * math.pi * (i + a) / 16
            points.append((r * math.cos(t), r * math.sin(t)))
    return cq.Workplane().polyline(points).close().extrude(5).faces(">Z").workplane().hole(6)


def spring():
    path = cq.Workplane(cq.Wire.makeHelix(6, 18, 8))
    return cq.Workplane("XZ", origin=(8, 0, 0)).circle(1.2).sweep(path, isFrenet=True)


def flange():
    plate = cq.Workplane().circle(20).extrude(4).faces(">Z").workplane().circle(10).extrude(10)
    plate = plate.faces(">Z").workplane().hole(10)
    return plate.faces("<Z").workplane().polarArray(15, 0, 360, 6).hole(4)


def bracket():
    foot = cq.Workplane().box(40, 24, 6, centered=(False, True, False))
    back = cq.Workplane().box(6, 24, 30, centered=(False, True, False))
    both = foot.union(back).edges("|Y and (not <X) and (not >X)").edges("<Z or >X").edges("not <Z").fillet(2)
    return both.faces("<Z").workplane().center(-26, 0).hole(8)


PARTS = {
    "box with holes": lambda: cq.Workplane().box(30, 20, 10).faces(">Z").workplane().rarray(14, 8, 2, 2).hole(4),
    "flange": flange,
    "stepped shaft": lambda: cq.Workplane().circle(6).extrude(10).faces(">Z").workplane().circle(4).extrude(12)
    .faces(">Z").workplane().circle(2.5).extrude(8),
    "cone": lambda: cq.Workplane().add(cq.Solid.makeCone(5, 2, 10)),
    "torus": lambda: cq.Workplane().add(cq.Solid.makeTorus(12, 4)),
    "spring": spring,
    "bracket": bracket,
    "gear": gear,
    "filleted block": lambda: cq.Workplane().box(20, 14, 8).edges().fillet(2),
    "pipe elbow": lambda: cq.Workplane().circle(4).circle(3).extrude(8).faces(">Z").workplane().circle(4).circle(3)
    .revolve(90, (-12, 0, 0), (-12, 1, 0)),
    "sphere on plate": lambda: cq.Workplane().box(20, 20, 3).union(cq.Workplane("XY", origin=(0, 0, 5)).sphere(5)),
    "prism": lambda: cq.Workplane().polygon(6, 12).extrude(20),
}


def frame(direction):
    """The picture's axes: right, up and to the eye."""
    to_eye = np.array(direction, float) / np.linalg.norm(direction)
    right = np.cross((0, 0, 1), to_eye)
    right /= np.linalg.norm(right)
    return right, np.cross(to_eye, right), to_eye


def points_of(shape, step):
    """Points along the edges of a shape, and the length that each stands for."""
    points, weights = [np.zeros((0, 2))], [np.zeros(0)]
    if shape is None or shape.IsNull():
        return points[0], weights[0]
    BRepLib.BuildCurves3d_s(shape)
    edges = TopExp_Explorer(shape, TopAbs_EDGE)
    while edges.More():
        curve = BRepAdaptor_Curve(TopoDS.Edge_s(edges.Current()))
        edges.Next()
        split = GCPnts_UniformAbscissa(curve, 200)
        if not split.IsDone():
            continue
        all = [curve.Value(split.Parameter(i + 1)) for i in range(split.NbPoints())]
        along = resampled(np.array([(p.X(), p.Y()) for p in all]), step)
        points.append(along[0]), weights.append(along[1])
    return np.concatenate(points), np.concatenate(weights)


def resampled(line, step):
    """The middles of pieces of a polyline that are no longer than a step, and their lengths."""
    points, weights = [], []
    for a, b in zip(line, line[1:]):
        length = np.linalg.norm(b - a)
        n = max(1, math.ceil(length / step))
        points += [a + (b - a) * ((i + 0.5) / n) for i in range(n)]
        weights += [length / n] * n
    return np.array(points).reshape(-1, 2), np.array(weights)


def exact(shape, direction, step):
    """The lines of Open CASCADE, visible and hidden, as points."""
    right, _, to_eye = frame(direction)
    algo = HLRBRep_Algo()
    algo.Add(shape)
    axes = gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(*map(float, to_eye)), gp_Dir(*map(float, right)))
    algo.Projector(HLRAlgo_Projector(axes))
    algo.Update()
    algo.Hide()
    lines = HLRBRep_HLRToShape(algo)
    join = lambda *all: tuple(np.concatenate(x) for x in zip(*(points_of(s, step) for s in all)))
    return join(lines.VCompound(), lines.OutLineVCompound()), join(lines.HCompound(), lines.OutLineHCompound())


def drawn(durer, options, model, direction, step, folder):
    """The lines of durer, visible and hidden, as points."""
    _, _, to_eye = frame(direction)
    out = os.path.join(folder, "out.geojson")
    eye = ",".join(repr(float(x)) for x in to_eye * 1000)
    usual = ["--smooth=auto", "--stubs", "1", "--hidden", "dashed"]
    usual = [o for o in usual if not any(o.split("=")[0] == p.split("=")[0] for p in options)]
    command = [durer, "render", model, "-o", out, f"--eye={eye}", "--target=0,0,0", "--up=0,0,1", "--ortho", "200"]
    subprocess.run(command + usual + options, check=True, capture_output=True)
    found = {True: [], False: []}
    for feature in json.load(open(out))["features"]:
        geometry = feature["geometry"]
        lines = geometry["coordinates"]
        lines = lines if geometry["type"] == "MultiLineString" else [lines]
        if "LineString" in geometry["type"]:
            found[feature["properties"]["visible"]] += [resampled(np.array(l)[:, :2], step) for l in lines]
    join = lambda all: tuple(map(np.concatenate, zip(*all))) if all else (np.zeros((0, 2)), np.zeros(0))
    return join(found[True]), join(found[False])


def without(points, others, near):
    """The length of points that have none of the others near."""
    if not len(points[0]):
        return 0.0
    if not len(others[0]):
        return points[1].sum()
    least = np.concatenate([
        np.min(np.linalg.norm(part[:, None] - others[0][None], axis=2), axis=1)
        for part in np.array_split(points[0], max(1, len(points[0]) // 500))
    ])
    return points[1][least > near].sum()


def main():
    options = [a for a in sys.argv[2:] if a.startswith("-")]
    names = [a for a in sys.argv[2:] if not a.startswith("-")] or list(PARTS)
    worst = 0.0
    print("| part | mesh | view | visible missing, extra % | hidden missing, extra % |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            part = PARTS[name]()
            size = part.val().BoundingBox().DiagonalLength
            near, step = 0.004 * size, 0.002 * size
            references = {v: exact(part.val().wrapped, d, step) for v, d in VIEWS.items()}
            for tolerance, angle in MESHES:
                model = os.path.join(folder, "part.stl")
                exporters.export(part, model, tolerance=tolerance, angularTolerance=angle)
                for view, direction in VIEWS.items():
                    seen, hidden = references[view]
                    ours = drawn(sys.argv[1], options, model, direction, step, folder)
                    both = tuple(np.concatenate(x) for x in zip(*ours))
                    whole = seen[1].sum() + hidden[1].sum()
                    # A hidden line under a visible one is not drawn.
                    parts = [
                        without(seen, ours[0], near), without(ours[0], seen, near),
                        without(hidden, both, near), without(ours[1], hidden, near),
                    ]
                    parts = [100 * p / whole for p in parts]
                    worst = max(worst, *parts)
                    print(f"| {name} | {tolerance} | {view} | {parts[0]:.2f}, {parts[1]:.2f} | {parts[2]:.2f}, {parts[3]:.2f} |", flush=True)
    print(f"\nThe most: {worst:.2f} %")


main()
