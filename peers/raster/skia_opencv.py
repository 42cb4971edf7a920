"""Skia, OpenCV, Blend2D and Cairo on the scenes of this harness (the drawing apart), CPU milliseconds, one thread, medians.

Needs: pip install skia-python opencv-python-headless blend2d-py pycairo numpy
"""

import math
import sys
import time

import blend2d
import cairo
import cv2
import numpy as np
import skia


class Random:
    """The generator of src/scenes.rs."""

    def __init__(self, seed):
        self.state = seed

    def next(self):
        self.state = (self.state * 6364136223846793005 + 1442695040888963407) % 2**64
        return (self.state >> 33) / 2**31

    def color(self):
        return tuple(int(self.next() * 255) for _ in range(3))


def small_polygons():
    r, shapes = Random(1), []
    for _ in range(10_000):
        x, y = r.next() * 1024, r.next() * 1024
        radius = 6 + r.next() * 8
        n = 3 + int(r.next() * 6)
        turn = r.next() * 6.3
        angles = [turn + i / n * math.tau for i in range(n)]
        points = [(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles]
        shapes.append((points, r.color(), False))
    return "10k polygons 1024", 1024, shapes


def mesh():
    r, n, side = Random(2), 64, 512.0
    points = []
    for i in range(n * (n + 2) + 1):
        dx, dy = r.next() - 0.5, r.next() - 0.5
        points.append(((i % (n + 1) + dx * 0.7) * side / n, (i // (n + 1) + dy * 0.7) * side / n))
    shapes = []
    for i in range(n * n):
        a = i // n * (n + 1) + i % n
        for t in [(a, a + 1, a + n + 2), (a, a + n + 1, a + n + 2)]:
            shapes.append(([points[k] for k in t], r.color(), False))
    return "mesh 8k 512", 512, shapes


def heavy(kind, even_odd):
    r, count, side, points = Random(3), 100_000, 2048.0, []
    x = y = side / 2
    for i in range(count):
        if kind == "walk":
            a = r.next() * math.tau
            x = min(max(x + math.cos(a) * 8, 0), side)
            y = min(max(y + math.sin(a) * 8, 0), side)
            points.append((x, y))
        elif kind == "coast":
            a = i / count * math.tau
            radius = 0.7 + sum(0.4 / 2**k * math.sin(a * 2**k * 3 + 2**k) for k in range(1, 9))
            radius = (radius + (r.next() - 0.5) * 0.003) * side * 0.5
            points.append((side / 2 + math.cos(a) * radius, side / 2 + math.sin(a) * radius))
        else:
            points.append((r.next() * side, r.next() * side))
    name = f"{kind} {'even-odd' if even_odd else 'non-zero'}"
    return name, 2048, [(points, (20, 80, 160), even_odd)]


def medians(rounds, *work):
    times = [[] for _ in work]
    for k in range(rounds + 1):
        for own, f in zip(times, work):
            start = time.process_time()
            f()
            if k:
                own.append((time.process_time() - start) * 1e3)
    return [sorted(t)[len(t) // 2] for t in times]


def fills():
    print("| fill, ms | Skia, anti-aliased | Skia, aliased | OpenCV, aliased | Blend2D, anti-aliased "
          "| Cairo, anti-aliased |")
    print("|---|---|---|---|---|---|")
    scenes = [small_polygons(), mesh(), heavy("coast", False), heavy("walk", False),
              heavy("walk", True)]
    for name, side, shapes in scenes:
        target = np.zeros((side, side, 4), np.uint8)
        surface = skia.Surface(target, colorType=skia.kRGBA_8888_ColorType)

        def picture(smooth):
            # Recorded once, so that no time goes into Python.
            recorder = skia.PictureRecorder()
            canvas = recorder.beginRecording(skia.Rect.MakeWH(side, side))
            canvas.clear(skia.ColorWHITE)
            for points, color, even_odd in shapes:
                path = skia.Path()
                path.addPoly([skia.Point(x, y) for x, y in points], True)
                rule = skia.PathFillType.kEvenOdd if even_odd else skia.PathFillType.kWinding
                path.setFillType(rule)
                paint = skia.Paint(AntiAlias=smooth, Color=skia.Color(*color))
                canvas.drawPath(path, paint)
            return recorder.finishRecordingAsPicture()

        smooth, hard = picture(True), picture(False)
        scale = 2**8
        integer = [(np.round((np.array(p) - 0.5) * scale).astype(np.int32), c)
                   for p, c, _ in shapes]
        image = np.zeros((side, side, 4), np.uint8)

        def opencv():
            image[:] = 255
            for points, color in integer:
                cv2.fillPoly(image, [points], color + (255,), cv2.LINE_8, 8)

        blend = blend2d.Image(side, side)
        nothing = blend2d.Path()
        paths = [(blend2d_path(points), color) for points, color, _ in shapes]

        def blend2d_fill(empty):
            context = blend2d.Context(blend)
            context.set_fill_style_rgba(255, 255, 255)
            context.fill_all()
            for path, color in paths:
                context.set_fill_style_rgba(*color)
                context.fill_path(nothing if empty else path)
            context.end()

        def blend2d_clear():
            context = blend2d.Context(blend)
            context.set_fill_style_rgba(255, 255, 255)
            context.fill_all()
            context.end()

        drawing = cairo.Context(cairo.ImageSurface(cairo.FORMAT_ARGB32, side, side))
        cairo_paths = [(cairo_path(drawing, points), [c / 255 for c in color])
                       for points, color, _ in shapes]
        winding = cairo.FillRule.EVEN_ODD if shapes[0][2] else cairo.FillRule.WINDING
        drawing.set_fill_rule(winding)

        def cairo_fill():
            drawing.set_source_rgb(1, 1, 1)
            drawing.paint()
            for path, color in cairo_paths:
                drawing.append_path(path)
                drawing.set_source_rgb(*color)
                drawing.fill()

        m = medians(9, lambda: smooth.playback(surface.getCanvas()),
                    lambda: hard.playback(surface.getCanvas()), opencv,
                    lambda: blend2d_fill(False), lambda: blend2d_fill(True), blend2d_clear,
                    cairo_fill)
        even_odd = shapes[0][2] or len(shapes) > 1
        # What the calls from Python cost is taken off; there is no call for the even-odd rule.
        blend_time = m[3] - (m[4] - m[5])
        print(f"| {name} | {m[0]:.2f} | {m[1]:.2f} | {f'{m[2]:.2f}' if even_odd else '–'} "
              f"| {'–' if shapes[0][2] else f'{blend_time:.2f}'} | {m[6]:.2f} |")


def blend2d_path(points):
    path = blend2d.Path()
    path.move_to(*points[0])
    for x, y in points[1:]:
        path.line_to(x, y)
    path.close()
    return path


def cairo_path(drawing, points):
    drawing.move_to(*points[0])
    for x, y in points[1:]:
        drawing.line_to(x, y)
    drawing.close_path()
    path = drawing.copy_path()
    drawing.new_path()
    return path


def lines():
    r, side = Random(4), 2048
    ends, colors = [], []
    for _ in range(1_000_000):
        x, y = 200 + r.next() * 1648, 200 + r.next() * 1648
        dx, dy = (r.next() - 0.5) * 190, (r.next() - 0.5) * 190
        ends.append((int(x), int(y), int(x + dx), int(y + dy)))
        colors.append(r.color() + (255,))
    image = np.zeros((side, side, 4), np.uint8)
    gray = np.zeros((side, side), np.uint8)

    def opencv():
        for (x0, y0, x1, y1), color in zip(ends, colors):
            cv2.line(image, (x0, y0), (x1, y1), color)

    def one_color():
        cv2.polylines(image, pairs, False, (1, 2, 3, 255))

    def calls():
        # What the calls themselves cost: lines outside the image.
        for (x0, y0, x1, y1), color in zip(ends, colors):
            cv2.line(image, (x0 - 9000, y0), (x1 - 9000, y1), color)

    pairs = np.array(ends, np.int32).reshape(-1, 2, 2)
    m = medians(3, opencv, calls, one_color)
    print(f"10^6 lines, ms: OpenCV RGBA {m[0] - m[1]:.0f} (calls from Python, {m[1]:.0f}, taken off), "
          f"of one colour in one call {m[2]:.0f}")


def hairlines(width):
    r, side = Random(6), 2048
    recorder = skia.PictureRecorder()
    canvas = recorder.beginRecording(skia.Rect.MakeWH(side, side))
    canvas.clear(skia.ColorWHITE)
    for _ in range(100_000):
        x, y = r.next() * 1648 + 200, r.next() * 1648 + 200
        u, v = (r.next() - 0.5) * 190, (r.next() - 0.5) * 190
        paint = skia.Paint(AntiAlias=True, Color=skia.Color(*r.color()), StrokeWidth=width,
                           Style=skia.Paint.kStroke_Style)
        canvas.drawLine(x, y, x + u, y + v, paint)
    picture = recorder.finishRecordingAsPicture()
    target = np.zeros((side, side, 4), np.uint8)
    surface = skia.Surface(target, colorType=skia.kRGBA_8888_ColorType)
    m = medians(5, lambda: picture.playback(surface.getCanvas()))
    print(f"10^5 hairlines, ms: Skia, stroke width {width} {m[0]:.0f}")


def maze(side, r):
    n = (side - 1) // 2
    pixels = np.full((side, side), 255, np.uint8)
    stack = [(0, 0)]
    pixels[0, 0] = 0
    while stack:
        x, y = stack[-1]
        around = [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)]
        open_ = [(u, v) for u, v in around if 0 <= u < n and 0 <= v < n and pixels[2 * v, 2 * u]]
        if not open_:
            stack.pop()
            continue
        u, v = open_[int(r.next() * len(open_)) % len(open_)]
        pixels[2 * v, 2 * u] = 0
        pixels[y + v, x + u] = 0
        stack.append((u, v))
    return pixels


def floods():
    side = 4096
    noise = (np.random.default_rng(5).random((side, side)) < 0.35).astype(np.uint8) * 255
    noise[:8, :8] = 0
    snake = np.zeros((side, side), np.uint8)
    snake[1::2] = 255
    snake[1::4, side - 1] = 0
    snake[3::4, 0] = 0
    scenes = [("empty", np.zeros((side, side), np.uint8)), ("noise", noise),
              ("maze", maze(side, Random(5))), ("serpentine", snake)]
    print("| flood fill, ms | OpenCV, 4 | OpenCV, 8 |\n|---|---|---|")
    for name, source in scenes:
        image = source.copy()

        def fill(connectivity):
            image[:] = source
            cv2.floodFill(image, None, (0, 0), 128, 0, 0, connectivity)

        m = medians(3, lambda: fill(4), lambda: fill(8), lambda: image.__setitem__(slice(None), source))
        print(f"| {name} | {m[0] - m[2]:.1f} | {m[1] - m[2]:.1f} |")


cv2.setNumThreads(1)
todo = sys.argv[1:] or ["fills", "lines", "hairlines", "floods"]
for name in todo:
    {"fills": fills, "lines": lines, "hairlines": lambda: (hairlines(0), hairlines(1)), "floods": floods}[name]()
