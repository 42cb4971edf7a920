// Buttons, scrubber and keys that go from step to step.

import { h, icon } from "./dom";
import { kindName, kindsOf, type Player } from "./player";
import type { Run } from "./types";
import { t } from "./words";

/** Colours of kinds, after Okabe and Ito (2008); each kind has a row of its own, too. */
export const COLORS = ["#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#56b4e9", "#8a8f98", "#b8a800"];

const ROW = 5;
/** Room at both ends, so that ticks are where the scrubber's thumb is. */
const INSET = 9;
const SPEEDS = [0.25, 0.5, 1, 2, 4, 8, 16];

const ICONS = {
  first: "M6 5v14M19 6l-9 6 9 6z",
  back: "M16 6l-9 6 9 6z",
  play: "M8 5l11 7-11 7z",
  pause: "M8 5v14M16 5v14",
  next: "M8 6l9 6-9 6z",
  last: "M18 5v14M5 6l9 6-9 6z",
};

export class Transport {
  readonly element: HTMLElement;
  /** Called before a step forward; returns false to prevent it from being shown. */
  allow: (to: number) => boolean = () => true;
  onnotice: ((text: string) => void) | undefined;

  private roll = h("canvas", { class: "roll", "aria-hidden": "true" });
  /** All ticks, kept so that a run of many steps is not redrawn with each step. */
  private ticks = h("canvas");
  private drawn: { size: string; run: Run | undefined } = { size: "", run: undefined };
  private range = h("input", { type: "range", min: 0, max: 0, value: 0, class: "scrubber" });
  private place = h("output", { class: "place" });
  private playButton: HTMLButtonElement;
  private speed = 2;
  private speedText = h("output", { class: "speed-value" });
  private timer: number | undefined;
  private kinds: string[];
  private chips = h("ul", { class: "kinds", "aria-label": t("kinds") });
  private observer: ResizeObserver;

  constructor(private player: Player) {
    this.kinds = kindsOf(player.lesson);
    this.range.addEventListener("input", () => this.seek(Number(this.range.value)));
    this.roll.addEventListener("pointerdown", (event) => this.scrub(event));
    this.playButton = this.button("play", () => this.toggle());
    this.element = h(
      "div",
      { class: "transport" },
      h("div", { class: "track" }, this.roll, this.range),
      h(
        "div",
        { class: "buttons" },
        this.button("first", () => this.seek(0)),
        this.button("back", () => this.seek(player.step - 1)),
        this.playButton,
        this.button("next", () => this.seek(player.step + 1)),
        this.button("last", () => this.seek(player.steps - 1)),
        this.place,
        h(
          "div",
          { class: "speed", role: "group", "aria-label": t("speed") },
          h("button", { type: "button", class: "quiet", "aria-label": `${t("speed")} −`, onclick: () => this.faster(-1) }, "−"),
          this.speedText,
          h("button", { type: "button", class: "quiet", "aria-label": `${t("speed")} +`, onclick: () => this.faster(1) }, "+"),
        ),
      ),
      this.chips,
    );
    this.faster(0);
    player.addEventListener("run", () => this.renew());
    player.addEventListener("frame", () => this.show());
    this.observer = new ResizeObserver(() => this.draw());
    this.observer.observe(this.roll);
    window.addEventListener("theme", this.redraw);
  }

  private redraw = (): void => this.draw();

  close(): void {
    this.pause();
    this.observer.disconnect();
    window.removeEventListener("theme", this.redraw);
  }

  private button(name: keyof typeof ICONS, onclick: () => void): HTMLButtonElement {
    const label = t(name as "first");
    return h("button", { type: "button", class: `step ${name}`, "aria-label": label, title: label, onclick }, icon(ICONS[name]));
  }

  seek(step: number): void {
    const to = Math.max(0, Math.min(this.player.steps - 1, step));
    if (to > this.player.step && !this.allow(to)) return;
    this.player.go(to);
  }

  /** Goes to the next step of the kind of this one. */
  alike(direction: 1 | -1, kind = this.player.kind(this.player.step)): void {
    const found = this.player.find(direction, (step) => this.player.kind(step) === kind);
    const wrapped = found < 0 && direction > 0 && kind !== this.player.kind(this.player.step);
    if (found >= 0) this.seek(found);
    else if (wrapped) this.seek(Math.max(0, this.first(kind)));
    else this.onnotice?.(t("noMore"));
  }

  private first(kind: string): number {
    for (let step = 0; step < this.player.steps; step++) if (this.player.kind(step) === kind) return step;
    return this.player.step;
  }

  toggle(): void {
    if (this.timer === undefined) this.start();
    else this.pause();
  }

  private start(): void {
    if (this.player.step + 1 >= this.player.steps) this.player.go(0);
    const tick = (): void => {
      if (this.player.step + 1 >= this.player.steps) return this.pause();
      const before = this.player.step;
      this.seek(before + 1);
      if (this.player.step === before) return this.pause();
      this.timer = window.setTimeout(tick, 1000 / this.speed);
    };
    this.timer = window.setTimeout(tick, 1000 / this.speed);
    this.face("pause");
  }

  pause(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.face("play");
  }

  private face(name: "play" | "pause"): void {
    this.playButton.replaceChildren(icon(ICONS[name]));
    this.playButton.setAttribute("aria-label", t(name));
    this.playButton.title = t(name);
  }

  faster(by: number): void {
    const index = Math.max(0, Math.min(SPEEDS.length - 1, SPEEDS.indexOf(this.speed) + by));
    this.speed = SPEEDS[index]!;
    this.speedText.textContent = `${this.speed}/s`;
  }

  private scrub(event: PointerEvent): void {
    const to = (event: PointerEvent): void => {
      const box = this.roll.getBoundingClientRect();
      const share = (event.clientX - box.left - INSET) / Math.max(1, box.width - 2 * INSET);
      this.seek(Math.round(share * (this.player.steps - 1)));
    };
    this.roll.setPointerCapture(event.pointerId);
    to(event);
    this.roll.addEventListener("pointermove", to);
    this.roll.addEventListener("lostpointercapture", () => this.roll.removeEventListener("pointermove", to), { once: true });
  }

  private renew(): void {
    this.range.max = String(this.player.steps - 1);
    const counts = this.player.counts();
    this.chips.replaceChildren(
      ...this.kinds.map((kind, index) => {
        const count = counts.get(kind) ?? 0;
        const color = COLORS[index % COLORS.length]!;
        return h(
          "li",
          {},
          h(
            "button",
            { type: "button", disabled: count === 0, onclick: () => this.alike(1, kind), "data-kind": kind },
            h("span", { class: "swatch", style: `background:${color}` }),
            kindName(this.player.lesson, kind),
            h("span", { class: "count" }, String(count)),
          ),
        );
      }),
    );
    this.roll.style.height = `${Math.max(2, this.kinds.length) * ROW + 4}px`;
    this.draw();
  }

  private show(): void {
    const { player } = this;
    this.range.value = String(player.step);
    this.range.setAttribute("aria-label", t("step"));
    const kind = player.kind(player.step);
    this.range.setAttribute("aria-valuetext", `${t("step")} ${player.step + 1} ${t("of")} ${player.steps}: ${kindName(player.lesson, kind)}`);
    this.place.textContent = `${player.step + 1} / ${player.steps}`;
    this.chips.querySelectorAll<HTMLElement>("button").forEach((chip) => {
      chip.classList.toggle("current", chip.dataset.kind === kind);
    });
    this.draw();
  }

  /** Draws the ticks and the place of the step among them. */
  private draw(): void {
    const { roll, player } = this;
    const context = roll.getContext("2d");
    const { clientWidth: wide, clientHeight: high } = roll;
    if (!context || wide === 0) return;
    const ratio = devicePixelRatio || 1;
    const size = `${wide} ${high} ${ratio}`;
    if (size !== this.drawn.size || player.run !== this.drawn.run) {
      this.drawn = { size, run: player.run };
      roll.width = this.ticks.width = Math.round(wide * ratio);
      roll.height = this.ticks.height = Math.round(high * ratio);
      this.drawTicks(wide, ratio);
    }
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, roll.width, roll.height);
    context.drawImage(this.ticks, 0, 0);
    context.scale(ratio, ratio);
    context.fillStyle = getComputedStyle(roll).color;
    const room = wide - 2 * INSET;
    context.fillRect(INSET + (player.step / Math.max(1, player.steps - 1)) * room - 0.75, 0, 1.5, high);
  }

  /** Draws a tick for each step in the row of its kind, once for a run. */
  private drawTicks(wide: number, ratio: number): void {
    const { player } = this;
    const context = this.ticks.getContext("2d")!;
    context.scale(ratio, ratio);
    const room = wide - 2 * INSET;
    const last = Math.max(1, player.steps - 1);
    const tick = Math.max(1, Math.min(10, room / (last + 1) - 1));
    const drawn = new Set<number>();
    for (let step = 0; step < player.steps; step++) {
      const kind = this.kinds.indexOf(player.kind(step));
      const x = INSET + (step / last) * room;
      // Where there are more steps than pixels, each is drawn once.
      const key = Math.floor(x * 2) * 16 + kind;
      if (kind < 0 || drawn.has(key)) continue;
      drawn.add(key);
      context.fillStyle = COLORS[kind % COLORS.length]!;
      context.fillRect(x - tick / 2, 2 + kind * ROW, tick, ROW - 1);
    }
  }

  /** Handles a key; returns whether it was used. */
  key(event: KeyboardEvent): boolean {
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    const way = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (way !== 0 && event.shiftKey) this.alike(way);
    else if (way !== 0) this.seek(this.player.step + way);
    else if (event.key === "Home") this.seek(0);
    else if (event.key === "End") this.seek(this.player.steps - 1);
    else if (event.key === " ") this.toggle();
    else if (event.key === "+") this.faster(1);
    else if (event.key === "-" || event.key === "−") this.faster(-1);
    else return false;
    if (way !== 0 || event.key === "Home" || event.key === "End") this.pause();
    return true;
  }
}
