// Where points of the input and of the picture are in a drawing.

import type { Place, Point } from "./types";

/** Map between points of the input and pixels of a drawing. */
export class View {
  readonly scale: number;
  readonly size: Point;

  constructor(
    readonly place: Place,
    longest: number,
  ) {
    const wide = place.max[0] - place.min[0];
    const high = place.max[1] - place.min[1];
    this.scale = longest / Math.max(wide, high);
    this.size = [Math.max(1, wide * this.scale), Math.max(1, high * this.scale)];
  }

  /** Returns a point's place in the drawing. */
  at([x, y]: Point): Point {
    const [a, b, c, d, e, f] = this.place.input!;
    return this.drawn([a * x + c * y + e, b * x + d * y + f]);
  }

  /** Returns the place in the drawing of a point of the picture. */
  drawn([x, y]: Point): Point {
    const v = (y - this.place.min[1]) * this.scale;
    return [(x - this.place.min[0]) * this.scale, this.place.down ? v : this.size[1] - v];
  }

  /** Returns the point of the picture at a place in the drawing. */
  shown([u, v]: Point): Point {
    return [u / this.scale + this.place.min[0], (this.place.down ? v : this.size[1] - v) / this.scale + this.place.min[1]];
  }

  /** Returns the point of the input at a place in the drawing. */
  from(at: Point): Point {
    const [a, b, c, d, e, f] = this.place.input!;
    const [u, v] = this.shown(at);
    const [x, y] = [u - e, v - f];
    const size = a * d - b * c;
    return [(d * x - c * y) / size, (a * y - b * x) / size];
  }

  /** Returns the rectangle of another drawing in this one, so that equal coordinates coincide. */
  of(other: View): { x: number; y: number; width: number; height: number } {
    const k = this.scale / other.scale;
    const x = (other.place.min[0] - this.place.min[0]) * this.scale;
    const low = (other.place.min[1] - this.place.min[1]) * this.scale;
    const height = other.size[1] * k;
    return { x, y: this.place.down ? low : this.size[1] - low - height, width: other.size[0] * k, height };
  }
}
