// The picture of a step, with the vertices of the input as handles.

import { h, s } from "./dom";
import { added, gridOf, halfway, moved, nearest, removed, same, toggled, vertices, type Ref, type Vertex } from "./edit";
import { Picker } from "./picker";
import type { Player } from "./player";
import type { Input, Point } from "./types";
import { View } from "./view";
import { t } from "./words";

/** Ratio by which drawings are made smaller than shown, so that their letters are readable. */
const ENLARGED = 1.3;
/** Distance within which a double click adds a vertex to an edge, in pixels of the drawing. */
const NEAR = 30;

/** Takes the texts out of a picture, with the light ground behind them: they are shown above the handles, which would cover them. */
function textsOf(picture: Element): Element {
  const texts = picture.cloneNode() as Element;
  const from = picture.querySelector("svg");
  if (from) {
    const to = from.cloneNode() as Element;
    for (const text of from.querySelectorAll(":scope > text")) {
      const ground = text.previousElementSibling;
      if (ground?.matches("rect[fill-opacity]")) to.append(ground);
      to.append(text);
    }
    texts.append(to);
  }
  texts.classList.add("texts");
  return texts;
}

function nameOf({ ref, at }: Vertex): string {
  const part = {
    window: t("corner"),
    lines: t("ofLine"),
    rings: t("ofRing"),
    clip: t("ofClip"),
    points: t("point"),
    faces: t("ofFace"),
    seed: t("seed"),
  }[ref.part];
  const [x, y] = at.map((value) => Number(value.toFixed(3)));
  return `${part} ${ref.list + 1}, ${t("vertex")} ${ref.index + 1}: (${x}; ${y})`;
}

export class Stage {
  readonly element: HTMLElement;
  /** Distance of the grid that vertices snap to; 0 for none. */
  snap = 1;
  /** The vertex that was chosen last. */
  chosen: Ref | undefined;
  onchoose: (() => void) | undefined;
  editable = true;
  /** True during a question for an outcode: the picture shows none. */
  hidesCodes = false;
  /** Asks for places in the picture. */
  readonly picker = new Picker(() => this.draw());

  /** Vertices of the polygon being drawn. */
  private sketched: Point[] = [];
  private svg = s("svg", { class: "drawing", role: "group" });
  private view: View | undefined;
  /** The view when a drag began, until it ends. */
  private held: { view: View; before: Player["setup"] } | undefined;
  private observer: ResizeObserver;

  constructor(private player: Player) {
    this.element = h("div", { class: "stage" }, this.svg);
    this.svg.addEventListener("dblclick", (event) => this.double(event));
    this.svg.addEventListener("click", (event) => this.click(event));
    player.addEventListener("frame", () => this.draw());
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.element);
  }

  close(): void {
    this.observer.disconnect();
  }

  /** Returns the input that is shown, with its numbers. */
  private get input(): Input | undefined {
    return this.player.run?.input;
  }

  /** Requests drawings in the size in which they are shown. */
  private resize(): void {
    const { clientWidth, clientHeight } = this.element;
    if (clientWidth === 0 || !this.view || this.held) return;
    const [wide, high] = this.view.size;
    const fit = Math.min(clientWidth / wide, clientHeight / high);
    const longest = Math.round((Math.max(wide, high) * fit) / ENLARGED);
    const bounded = Math.max(240, Math.min(900, longest));
    if (Math.abs(bounded - this.player.longest) > 0.08 * bounded) {
      this.player.longest = bounded;
      this.player.refresh();
    }
  }

  private draw(): void {
    const { frame } = this.player;
    if (!frame) return;
    const own = new View(frame.map, frame.longest);
    const view = this.held?.view ?? own;
    this.view = view;
    const picture = new DOMParser().parseFromString(frame.svg, "image/svg+xml").documentElement;
    const place = view.of(own);
    const [wide, high] = own.size;
    picture.setAttribute("viewBox", `0 0 ${wide} ${high}`);
    for (const [name, value] of Object.entries(place)) picture.setAttribute(name, String(value));
    picture.setAttribute("overflow", "visible");
    picture.setAttribute("aria-hidden", "true");
    if (this.hidesCodes) {
      [...picture.querySelectorAll("text")].filter((text) => /^[01]{4}$/.test(text.textContent ?? "")).forEach((text) => text.remove());
    }
    const texts = textsOf(picture);
    const focused = (document.activeElement as SVGElement | null)?.dataset?.ref;
    this.svg.setAttribute("viewBox", `0 0 ${view.size[0]} ${view.size[1]}`);
    this.svg.setAttribute("aria-label", frame.frame.caption);
    if (this.held) {
      // The dragged handle must stay: only the picture behind it is replaced.
      this.svg.firstElementChild?.replaceWith(picture);
      this.svg.querySelector(".texts")?.replaceWith(texts);
      this.place();
    } else {
      this.svg.replaceChildren(picture, ...this.handles(), texts, ...this.outlined(view), ...this.picker.crosses(view));
      this.element.classList.toggle("asks", this.picker.asks);
      if (focused) this.svg.querySelector<SVGElement>(`[data-ref="${focused}"]`)?.focus();
      this.resize();
    }
  }

  /** Draws the step once more. */
  redraw(): void {
    this.draw();
  }

  /** Returns the point of the input at a place of the picture, on the grid that vertices snap to. */
  inputAt(at: Point): Point | undefined {
    const { view } = this;
    return view?.place.input ? this.snapped(view.from(view.drawn(at)), { part: "rings", list: 0, index: 0 }) : undefined;
  }

  /** Returns the way from a point of the input to a place, in the picture. */
  apart(from: Point, [x, y]: Point): Point {
    const { view } = this;
    if (!view?.place.input) return [Infinity, Infinity];
    const [u, v] = view.shown(view.at(from));
    return [x - u, y - v];
  }

  /** Shows the vertices of the polygon being drawn, in the coordinates of the input. */
  outline(points: Point[]): void {
    this.sketched = points;
    this.draw();
  }

  private outlined(view: View): SVGElement[] {
    if (this.sketched.length === 0 || !view.place.input) return [];
    const all = this.sketched.map((point) => view.at(point));
    const dots = all.map(([cx, cy]) => s("circle", { cx, cy, r: 4 }));
    return [s("g", { class: "sketch", "aria-hidden": "true" }, s("path", { d: `M${all.join("L")}` }), ...dots)];
  }

  private handles(): SVGElement[] {
    const { input, view } = this;
    if (!input || !view?.place.input || !this.editable || this.picker.asks) return [];
    return vertices(input).map((vertex) => this.handle(vertex, view));
  }

  private handle(vertex: Vertex, view: View): SVGElement {
    const { ref } = vertex;
    const [x, y] = view.at(vertex.at);
    const group = s(
      "g",
      {
        class: `handle ${ref.part}${same(ref, this.chosen) ? " chosen" : ""}`,
        transform: `translate(${x} ${y})`,
        tabindex: 0,
        role: "button",
        "aria-label": nameOf(vertex),
        "data-ref": `${ref.part}-${ref.list}-${ref.index}`,
        onpointerdown: (event: PointerEvent) => this.grab(event, ref, group),
        onkeydown: (event: KeyboardEvent) => this.key(event, vertex),
        onfocus: () => this.choose(ref),
      },
      s("circle", { r: 14, class: "reach" }),
      ref.part === "window" ? s("rect", { x: -5, y: -5, width: 10, height: 10, class: "ring" }) : s("circle", { r: 6, class: "ring" }),
    );
    return group;
  }

  /** Puts the handles where the vertices are now. */
  private place(): void {
    const { input, view } = this;
    if (!input || !view?.place.input) return;
    for (const vertex of vertices(input)) {
      const [x, y] = view.at(vertex.at);
      const { part, list, index } = vertex.ref;
      const handle = this.svg.querySelector(`[data-ref="${part}-${list}-${index}"]`);
      handle?.setAttribute("transform", `translate(${x} ${y})`);
    }
  }

  choose(ref: Ref): void {
    this.chosen = ref;
    const name = `${ref.part}-${ref.list}-${ref.index}`;
    this.svg.querySelectorAll<SVGElement>(".handle").forEach((handle) => {
      handle.classList.toggle("chosen", handle.dataset.ref === name);
    });
    this.onchoose?.();
  }

  private snapped([x, y]: Point, ref: Ref): Point {
    if (ref.part === "seed" || this.snap === 0) return [x, y];
    const to = (value: number): number => Number((Math.round(value / this.snap) * this.snap).toPrecision(12));
    return [to(x), to(y)];
  }

  /** Returns the position of a pointer in the drawing. */
  private pointer(event: MouseEvent): Point {
    const matrix = this.svg.getScreenCTM();
    if (!matrix) return [0, 0];
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
    return [x, y];
  }

  private grab(event: PointerEvent, ref: Ref, handle: SVGElement): void {
    const { view, player } = this;
    if (!view || event.button !== 0) return;
    event.preventDefault();
    handle.focus();
    handle.setPointerCapture(event.pointerId);
    this.held = { view, before: player.setup };
    let last = "";
    const move = (event: PointerEvent): void => {
      const { input } = this;
      if (!input) return;
      const at = this.snapped(view.from(this.pointer(event)), ref);
      if (String(at) === last) return;
      last = String(at);
      const [x, y] = view.at(ref.part === "seed" ? [Math.floor(at[0]) + 0.5, Math.floor(at[1]) + 0.5] : at);
      handle.setAttribute("transform", `translate(${x} ${y})`);
      player.preview(moved(input, ref, at));
    };
    const end = (): void => {
      handle.removeEventListener("pointermove", move);
      const before = this.held?.before;
      this.held = undefined;
      if (before && last !== "") player.change(player.setup, before);
      else this.draw();
    };
    handle.addEventListener("pointermove", move);
    handle.addEventListener("lostpointercapture", end, { once: true });
  }

  private key(event: KeyboardEvent, { ref, at }: Vertex): void {
    const ways: Record<string, Point> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, 1],
      ArrowDown: [0, -1],
    };
    const way = ways[event.key];
    if (way && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      event.stopPropagation();
      const size = ref.part === "seed" ? 1 : this.snap || 0.1;
      const up = this.view?.place.down ? -1 : 1;
      this.change((input) => moved(input, ref, [at[0] + way[0] * size, at[1] + way[1] * size * up]));
    } else if (event.key === "Delete" || event.key === "Backspace") {
      event.preventDefault();
      event.stopPropagation();
      this.removeChosen();
    }
  }

  private change(how: (input: Input) => Input | undefined): void {
    const { input, player } = this;
    const changed = input && how(input);
    if (changed) player.change({ ...player.setup, input: changed });
  }

  removeChosen(): void {
    const { chosen } = this;
    if (chosen) this.change((input) => removed(input, chosen));
  }

  /** Adds a vertex halfway from the chosen one to the next, or on the first edge. */
  addVertex(): void {
    this.change((input) => {
      const found = halfway(input, this.chosen);
      return found && added(input, found.ref, this.snapped(found.at, found.ref));
    });
  }

  private double(event: MouseEvent): void {
    const { view, input } = this;
    if (!view?.place.input || !input || "grid" in input || !this.editable || this.picker.asks) return;
    const at = view.from(this.pointer(event));
    const found = nearest(input, at);
    const scale = Math.hypot(view.place.input[0], view.place.input[1]) * view.scale;
    if (!found || found.distance * scale > NEAR) return;
    event.preventDefault();
    const { ref } = found.edge;
    this.chosen = { ...ref, index: ref.index + 1 };
    this.change((input) => added(input, ref, this.snapped(found.at, ref)));
  }

  private click(event: MouseEvent): void {
    const { view, input } = this;
    if (view && this.picker.asks) return this.picker.picked(view.shown(this.pointer(event)), view);
    const onHandle = (event.target as Element).closest(".handle");
    if (!view?.place.input || !input || !("grid" in input) || onHandle || !this.editable) return;
    const [x, y] = view.from(this.pointer(event));
    const [column, row] = [Math.floor(x), Math.floor(y)];
    if (column < 0 || row < 0 || column >= input.grid.columns) return;
    this.change((input) => toggled(input, column, row));
  }

  /** Chooses a grid that suits the input. */
  suit(): void {
    if (this.input) this.snap = gridOf(this.input);
  }
}
