// A polygon of the input, drawn anew vertex by vertex.

import { h } from "./dom";
import type { Player } from "./player";
import type { Stage } from "./stage";
import type { Point } from "./types";
import { t, type WordName } from "./words";

/** Distance from the first vertex within which a click closes the polygon, in pixels of the drawing. */
const CLOSE = 10;

type Part = "rings" | "clip";
const PARTS: [Part, WordName][] = [
  ["rings", "sketch"],
  ["clip", "sketchClip"],
];

export class Sketch {
  /** Buttons that begin it. */
  readonly element: HTMLElement;
  /** What to do, for a place beside the picture. */
  readonly bar: HTMLElement;
  private part: Part | undefined;
  private points: Point[] = [];
  private starts: HTMLButtonElement[];
  private done = h("button", { type: "button", class: "primary", "data-sketch": "done", onclick: () => this.finish() }, t("sketchDone"));
  private cancel = h("button", { type: "button", onclick: () => this.stage.picker.end() }, t("sketchCancel"));
  private hint = h("p", { class: "telling", role: "status", "aria-live": "polite" });

  constructor(
    private player: Player,
    private stage: Stage,
  ) {
    this.starts = PARTS.map(([part, name]) => h("button", { type: "button", "data-sketch": part, onclick: () => this.start(part) }, t(name)));
    this.element = h("div", { class: "tools" }, ...this.starts);
    this.bar = h("div", { class: "asking" }, this.hint, h("div", { class: "tools" }, this.done, this.cancel));
    // Another input takes the place of the one that was being drawn.
    player.addEventListener("run", () => this.end());
    player.addEventListener("run", () => this.show());
    this.show();
  }

  private show(): void {
    const input = this.player.run?.input;
    const figure = input && "figure" in input ? input.figure : undefined;
    this.starts.forEach((button, index) => (button.hidden = !figure?.[PARTS[index]![0]]?.length));
    this.element.hidden = this.starts.every((button) => button.hidden);
    this.bar.hidden = this.part === undefined;
    this.done.disabled = this.points.length < 3;
    this.hint.textContent = this.part ? t("sketchHint", { count: this.points.length }) : "";
    // What was there is paler than what is drawn.
    this.stage.element.classList.toggle("sketches", this.part !== undefined);
  }

  private start(part: Part): void {
    this.stage.picker.ask(false, (at, scale) => this.add(at, scale), () => this.end());
    this.part = part;
    this.points = [];
    this.show();
    this.stage.element.scrollIntoView({ block: "nearest" });
  }

  private add(at: Point, scale: number): void {
    const first = this.points[0];
    const point = this.stage.inputAt(at);
    if (!point) return;
    const isNear = first && Math.hypot(...this.stage.apart(first, at)) * scale <= CLOSE;
    if (isNear && this.points.length >= 3) return this.finish();
    const last = this.points.at(-1);
    if (last?.[0] !== point[0] || last[1] !== point[1]) this.points.push(point);
    this.stage.outline(this.points);
    this.show();
  }

  private finish(): void {
    const { part, points, player } = this;
    const input = structuredClone(player.run?.input);
    if (!part || points.length < 3 || !input || !("figure" in input)) return;
    this.stage.picker.end();
    input.figure[part] = [points];
    player.change({ ...player.setup, input }, player.setup, 0);
  }

  private end(): void {
    if (!this.part) return;
    this.part = undefined;
    this.points = [];
    this.stage.outline([]);
    this.stage.picker.end();
    this.show();
  }

  /** Takes a key while a polygon is drawn; returns whether it was one of its own. */
  key(event: KeyboardEvent): boolean {
    if (!this.part || (event.key !== "Enter" && event.key !== "Escape")) return false;
    if (event.key === "Enter") this.finish();
    else this.stage.picker.end();
    return true;
  }
}
