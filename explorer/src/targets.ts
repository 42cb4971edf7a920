// The subjects of a step as places in its picture: found by a click, and named in questions.

import type { Frame, Point, Target } from "./types";
import { t, type WordName } from "./words";

/** Distances within which a click finds a point or a line, in pixels of the drawing. */
const AT_POINT = 16;
const AT_LINE = 11;
/** Largest number of marks that questions allow: with more, nearly every click would find one. */
const MOST = 40;

type Kind = "pixel" | "point" | "line" | "area";

const NAMES: Record<Kind, WordName> = { pixel: "aPixel", point: "aPoint", line: "aLine", area: "anArea" };

function kindOf(target: Target): Kind {
  return Object.keys(target)[0] as Kind;
}

/** Returns the places of the next step that the one before does not mark, about which a student can be asked. */
export function asked(next: Frame, before: Frame | undefined): Target[] {
  const same = before && JSON.stringify(before.map) === JSON.stringify(next.map);
  // Another part of the plane would show the answer outside the question's picture.
  if (before && !same) return [];
  const known = new Set((before?.targets ?? []).map((target) => JSON.stringify(target)));
  const fresh = next.targets.filter((target) => !known.has(JSON.stringify(target)));
  return fresh.length <= MOST ? fresh : [];
}

/** Returns the kinds of places in words: "the point or the line". */
export function placesInWords(targets: Target[]): string {
  const kinds = [...new Set(targets.map(kindOf))];
  return kinds.map((kind) => t(NAMES[kind])).join(` ${t("or")} `);
}

export function hasPixels(targets: Target[]): boolean {
  return targets.some((target) => "pixel" in target);
}

function toSegment([x, y]: Point, [ax, ay]: Point, [bx, by]: Point): number {
  const [dx, dy] = [bx - ax, by - ay];
  const size = dx * dx + dy * dy;
  const along = size > 0 ? Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / size)) : 0;
  return Math.hypot(x - ax - along * dx, y - ay - along * dy);
}

function toLine(p: Point, line: Point[]): number {
  return Math.min(...line.slice(1).map((end, index) => toSegment(p, line[index]!, end)));
}

/** Returns whether a point is inside rings by the even-odd rule. */
function isInside([x, y]: Point, rings: Point[][]): boolean {
  let inside = false;
  for (const ring of rings) {
    ring.forEach(([ax, ay], index) => {
      const [bx, by] = ring[(index + 1) % ring.length]!;
      if (ay > y !== by > y && x < ax + ((bx - ax) * (y - ay)) / (by - ay)) inside = !inside;
    });
  }
  return inside;
}

/** Returns whether a click at a place of the picture finds one of the targets; `scale` is pixels per unit. */
export function hit(targets: Target[], at: Point, scale: number): boolean {
  return targets.some((target) => {
    if ("pixel" in target) return Math.floor(at[0]) === target.pixel[0] && Math.floor(at[1]) === target.pixel[1];
    if ("point" in target) return Math.hypot(at[0] - target.point[0], at[1] - target.point[1]) * scale <= AT_POINT;
    if ("line" in target) return toLine(at, target.line) * scale <= AT_LINE;
    return isInside(at, target.area) || target.area.some((ring) => toLine(at, [...ring, ring[0]!]) * scale <= AT_LINE);
  });
}
