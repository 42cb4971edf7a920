// Questions for a place in the picture: answered by a click, or by arrow keys and Enter on a cross.

import { s } from "./dom";
import type { Point } from "./types";
import type { View } from "./view";
import { t } from "./words";

export class Picker {
  /** Receives the place clicked, in the coordinates of the picture, while a question is open. */
  private onpick: ((at: Point, scale: number) => void) | undefined;
  /** Called when the question ends. */
  private onleave: (() => void) | undefined;
  /** Size of a step of the arrow keys in the picture: a pixel, or none for a share of the width. */
  private step = 0;
  /** The place that the arrow keys move. */
  private cross: Point | undefined;
  /** The place that was picked last, and whether it was right. */
  private mark: { at: Point; look: string } | undefined;

  constructor(private redraw: () => void) {}

  /** True while a question is open. */
  get asks(): boolean {
    return this.onpick !== undefined;
  }

  /** Asks for a place in the picture. */
  ask(isPixels: boolean, onpick: (at: Point, scale: number) => void, onleave?: () => void): void {
    this.leave();
    this.onpick = onpick;
    this.onleave = onleave;
    this.step = isPixels ? 1 : 0;
    this.cross = undefined;
    this.redraw();
  }

  /** Ends the question. */
  end(): void {
    if (!this.onpick) return;
    this.onpick = undefined;
    this.leave();
    this.redraw();
  }

  private leave(): void {
    const { onleave } = this;
    this.onleave = undefined;
    onleave?.();
  }

  /** Answers the question by a place of the picture. */
  picked(at: Point, view: View): void {
    this.cross = at;
    this.onpick?.(at, view.scale);
  }

  /** Shows the place picked, until the next one; an empty look removes it. */
  answered(look: "" | "right" | "wrong"): void {
    this.mark = look !== "" && this.cross ? { at: this.cross, look } : undefined;
  }

  /** Returns the crosses: at the place that was picked last, and the one that keys move. */
  crosses(view: View): SVGElement[] {
    const cross = (at: Point, attributes: Record<string, string | number | ((event: KeyboardEvent) => void)>): SVGElement => {
      const [x, y] = view.drawn(at);
      return s("g", { transform: `translate(${x} ${y})`, ...attributes }, s("path", { d: "M-11 0H11M0 -11V11" }));
    };
    const { place } = view;
    const last = this.mark ? [cross(this.mark.at, { class: `cross ${this.mark.look}`, "aria-hidden": "true" })] : [];
    if (!this.onpick) return last;
    const middle = (k: 0 | 1): number => (place.min[k] + place.max[k]) / 2;
    const laid = (value: number): number => (this.step === 1 ? Math.floor(value) + 0.5 : value);
    const at: Point = this.cross ?? [laid(middle(0)), laid(middle(1))];
    const name = `${t("crossHint")} (${at.map((value) => Number(value.toFixed(2))).join("; ")})`;
    const onkeydown = (event: KeyboardEvent): void => this.key(event, at, view);
    return [...last, cross(at, { class: "cross asks", tabindex: 0, role: "button", "aria-label": name, "data-ref": "cross", onkeydown })];
  }

  private key(event: KeyboardEvent, at: Point, view: View): void {
    const size = this.step || Math.max(view.place.max[0] - view.place.min[0], view.place.max[1] - view.place.min[1]) / 80;
    const up = view.place.down ? -size : size;
    const ways: Record<string, Point> = { ArrowLeft: [-size, 0], ArrowRight: [size, 0], ArrowUp: [0, up], ArrowDown: [0, -up] };
    const way = ways[event.key];
    if (event.key === "Enter" || event.key === " ") this.picked(at, view);
    else if (way && !event.shiftKey) {
      this.cross = [at[0] + way[0], at[1] + way[1]];
      this.redraw();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
