// Vertices of inputs: where they are, and inputs with one moved, added or removed.

import type { Input, Point } from "./types";

export type Part = "window" | "lines" | "rings" | "clip" | "points" | "faces" | "seed";

export interface Ref {
  part: Part;
  list: number;
  index: number;
}

export interface Vertex {
  ref: Ref;
  at: Point;
}

/** A line between neighbours, where a vertex can be added after the first one. */
export interface Edge {
  ref: Ref;
  from: Point;
  to: Point;
}

/** Fewest vertices of a list. */
const FEWEST: Record<Part, number> = { window: 4, lines: 2, rings: 3, clip: 3, points: 1, faces: 3, seed: 1 };

const CORNERS: [number, number][] = [
  [0, 1],
  [2, 1],
  [2, 3],
  [0, 3],
];

/** Returns the lists of points of an input, by their parts. */
function lists(input: Input): { part: Part; list: number; points: number[][] }[] {
  if ("figure" in input) {
    const all: { part: Part; list: number; points: number[][] }[] = [];
    for (const part of ["lines", "rings", "clip"] as const) {
      (input.figure[part] ?? []).forEach((points, list) => all.push({ part, list, points }));
    }
    if (input.figure.points) all.push({ part: "points", list: 0, points: input.figure.points });
    return all;
  }
  if ("faces" in input) return input.faces.map((points, list) => ({ part: "faces", list, points }));
  return [];
}

export function vertices(input: Input): Vertex[] {
  if ("grid" in input) {
    const [x, y] = input.grid.seed;
    return [{ ref: { part: "seed", list: 0, index: 0 }, at: [x + 0.5, y + 0.5] }];
  }
  const all: Vertex[] = [];
  for (const { part, list, points } of lists(input)) {
    points.forEach((p, index) => all.push({ ref: { part, list, index }, at: [p[0]!, p[1]!] }));
  }
  const window = "figure" in input ? input.figure.window : undefined;
  if (window) {
    CORNERS.forEach(([x, y], index) =>
      all.push({ ref: { part: "window", list: 0, index }, at: [window[x]!, window[y]!] }),
    );
  }
  return all;
}

export function edges(input: Input): Edge[] {
  const all: Edge[] = [];
  for (const { part, list, points } of lists(input)) {
    const closed = part === "rings" || part === "clip" || part === "faces";
    if (part === "points") continue;
    points.forEach((p, index) => {
      const q = points[index + 1] ?? (closed ? points[0] : undefined);
      if (q) all.push({ ref: { part, list, index }, from: [p[0]!, p[1]!], to: [q[0]!, q[1]!] });
    });
  }
  return all;
}

function copyOf(input: Input, { part, list }: Ref): { copy: Input; points: number[][] } {
  const copy = structuredClone(input);
  const found = lists(copy).find((own) => own.part === part && own.list === list);
  return { copy, points: found?.points ?? [] };
}

export function moved(input: Input, ref: Ref, [x, y]: Point): Input {
  const { copy, points } = copyOf(input, ref);
  if (ref.part === "window" && "figure" in copy && copy.figure.window) {
    const [column, row] = CORNERS[ref.index]!;
    copy.figure.window[column] = x;
    copy.figure.window[row] = y;
  } else if (ref.part === "seed" && "grid" in copy) {
    const rows = copy.grid.cells.length / copy.grid.columns;
    const within = (value: number, count: number): number => Math.max(0, Math.min(count - 1, Math.floor(value)));
    copy.grid.seed = [within(x, copy.grid.columns), within(y, rows)];
  } else {
    const point = points[ref.index];
    if (point) [point[0], point[1]] = [x, y];
  }
  return copy;
}

/** Adds a vertex after another one; its depth is halfway to the next. */
export function added(input: Input, ref: Ref, [x, y]: Point): Input {
  const { copy, points } = copyOf(input, ref);
  const [before, after] = [points[ref.index], points[ref.index + 1] ?? points[0]];
  const more = before && after ? before.slice(2).map((value, k) => (value + (after[k + 2] ?? value)) / 2) : [];
  points.splice(ref.index + 1, 0, [x, y, ...more]);
  return copy;
}

/** Removes a vertex; undefined if too few would be left. */
export function removed(input: Input, ref: Ref): Input | undefined {
  const { copy, points } = copyOf(input, ref);
  if (points.length <= FEWEST[ref.part]) return undefined;
  points.splice(ref.index, 1);
  return copy;
}

/** Returns the edge that is nearest to a point, and its point there. */
export function nearest(input: Input, [x, y]: Point): { edge: Edge; at: Point; distance: number } | undefined {
  let best: { edge: Edge; at: Point; distance: number } | undefined;
  for (const edge of edges(input)) {
    const [dx, dy] = [edge.to[0] - edge.from[0], edge.to[1] - edge.from[1]];
    const size = dx * dx + dy * dy;
    const t = size > 0 ? Math.max(0, Math.min(1, ((x - edge.from[0]) * dx + (y - edge.from[1]) * dy) / size)) : 0;
    const at: Point = [edge.from[0] + t * dx, edge.from[1] + t * dy];
    const distance = Math.hypot(x - at[0], y - at[1]);
    if (!best || distance < best.distance) best = { edge, at, distance };
  }
  return best;
}

/** Returns a distance of grid lines that suits the coordinates: 1 if all are whole and small, else finer or coarser. */
export function gridOf(input: Input): number {
  const values = vertices(input).flatMap((vertex) => vertex.at);
  if (values.length === 0) return 1;
  const size = Math.max(...values) - Math.min(...values);
  if (size >= 4 && size <= 60) return values.every(Number.isInteger) ? 1 : 0.5;
  return 10 ** Math.floor(Math.log10((size || 1) / 20));
}

/** Returns an input with the other value in a cell: the seed's own, or the first one unlike it. */
export function toggled(input: Input, column: number, row: number): Input {
  const copy = structuredClone(input);
  if (!("grid" in copy)) return copy;
  const { grid } = copy;
  const place = row * grid.columns + column;
  const values = [...new Set(grid.cells)].sort((a, b) => a - b);
  const value = grid.cells[place];
  if (value === undefined || column < 0 || column >= grid.columns) return copy;
  const all = values.length > 1 ? values : [value, value === 0 ? 1 : 0];
  grid.cells[place] = all[(all.indexOf(value) + 1) % all.length]!;
  return copy;
}

/** Returns whether two references are of the same vertex. */
export function same(a: Ref | undefined, b: Ref | undefined): boolean {
  return a?.part === b?.part && a?.list === b?.list && a?.index === b?.index;
}

/** Returns the point halfway from a vertex to the next, or on the first edge, and the vertex that it follows. */
export function halfway(input: Input, chosen: Ref | undefined): Vertex | undefined {
  const all = vertices(input);
  const at = all.find(({ ref }) => same(ref, chosen) && ref.part !== "window") ?? all[0];
  if (!at || at.ref.part === "seed" || at.ref.part === "window") return undefined;
  const inList = all.filter(({ ref }) => ref.part === at.ref.part && ref.list === at.ref.list);
  const next = inList[at.ref.index + 1] ?? inList[0] ?? at;
  // Nothing follows the end of a line: the vertex is put before it.
  const isEnd = at.ref.part === "lines" && at.ref.index + 1 === inList.length;
  const [from, to] = isEnd ? [inList[at.ref.index - 1]!, at] : [at, next];
  return { ref: from.ref, at: [(from.at[0] + to.at[0]) / 2, (from.at[1] + to.at[1]) / 2] };
}
