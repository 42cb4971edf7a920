// Questions whose answers are numbers or decisions: the bits of an outcode, and whether a line is accepted, rejected or cut.

import { h } from "./dom";
import type { Frame, Input, Lesson, Place, Point } from "./types";
import { t, type WordName } from "./words";

/** A question about a step. */
export type Question = { code: string; name: string } | { decides: string[]; truth: string };

/** Kinds of steps that end a test of a line: the student's decisions. */
const DECISIONS = ["accepted", "rejected", "cut"];

/** Values of captions that are outcodes, in the lessons that have them, and the kinds of steps that are decisions. */
const ASKED: Record<string, { codes: string[]; decisions: string[] }> = {
  "cohen-sutherland": { codes: ["start", "end", "code"], decisions: DECISIONS },
  midpoint: { codes: ["code"], decisions: [...DECISIONS, "halved"] },
  "nicholl-lee-nicholl": { codes: ["code"], decisions: DECISIONS },
  "cyrus-beck": { codes: [], decisions: DECISIONS },
  "liang-barsky": { codes: [], decisions: DECISIONS },
  homogeneous: { codes: [], decisions: DECISIONS },
  skala: { codes: [], decisions: DECISIONS },
  "homogeneous-volume": { codes: ["code"], decisions: [] },
};

/** Borders in the order in which an outcode is written, for four and for six bits. */
const BORDERS: WordName[] = ["far", "near", "top", "bottom", "rightSide", "leftSide"];

const LABELS: Record<string, WordName> = { accepted: "accept", rejected: "reject", cut: "cutIt", halved: "halve" };

/** Returns whether a lesson has such questions. */
export function hasNumbers(lesson: Lesson): boolean {
  return lesson.name in ASKED;
}

function isCode(value: unknown): value is string {
  return typeof value === "string" && /^[01]{4}([01]{2})?$/.test(value);
}

/** Returns the questions about a step: the decision, then the outcodes that it computes. */
export function questions(lesson: Lesson, { frame }: Frame): Question[] {
  const asked = ASKED[lesson.name];
  if (!asked) return [];
  const { kind, values } = frame;
  const decides = asked.decisions.includes(kind) ? [{ decides: asked.decisions, truth: kind }] : [];
  const codes = asked.codes.filter((name) => isCode(values[name])).map((name) => ({ code: values[name] as string, name: nameOf(name, values) }));
  return [...decides, ...codes];
}

/** Returns the name of the point that has an outcode. */
function nameOf(name: string, values: Record<string, unknown>): string {
  if (name === "start") return "A";
  if (name === "end") return "B";
  if ("middle" in values) return t("theMiddle");
  if ("vertex" in values) return `${t("vertex")} ${String(values.vertex)}`;
  if (typeof values.name === "string") return values.name;
  return t("theNewEnd");
}

export function textOf(question: Question): string {
  return "code" in question ? t("askCode", { name: question.name, count: question.code.length }) : t("askDecision");
}

/** Returns the outcode of a point of the picture; none where the input has no window, or shows it in another way. */
export function codeAt([x, y]: Point, place: Place, input: Input | undefined): string | undefined {
  const window = input && "figure" in input ? input.figure.window : undefined;
  if (!window || !place.input) return undefined;
  const [a, b, c, d, e, f] = place.input;
  const [u, v] = [x - e, y - f];
  const size = a * d - b * c;
  const [px, py] = [(d * u - c * v) / size, (a * v - b * u) / size];
  const [x0, y0, x1, y1] = window;
  return [py > y1, py < y0, px > x1, px < x0].map(Number).join("");
}

/** Fields for an answer, with their keys. */
export class Fields {
  readonly element: HTMLElement;
  private bits: HTMLButtonElement[] = [];
  private buttons: HTMLButtonElement[] = [];

  constructor(
    private question: Question,
    private onanswer: (right: boolean) => void,
  ) {
    this.element = "code" in question ? this.code(question.code.length) : this.decision(question.decides);
  }

  /** Removes the focus from the last pressed button, which Enter would press again. */
  focus(): void {
    this.element.focus({ preventScroll: true });
  }

  private decision(kinds: string[]): HTMLElement {
    this.buttons = kinds.map((kind, index) =>
      h("button", { type: "button", "data-decision": kind, onclick: () => this.decide(kind) }, h("kbd", { "aria-hidden": "true" }, String(index + 1)), t(LABELS[kind]!)),
    );
    return h("div", { class: "decisions", role: "group", tabindex: -1, "aria-label": t("askDecision") }, ...this.buttons);
  }

  private decide(kind: string): void {
    this.onanswer("truth" in this.question && kind === this.question.truth);
  }

  private code(count: number): HTMLElement {
    this.bits = BORDERS.slice(BORDERS.length - count).map((border, index) =>
      h(
        "button",
        { type: "button", class: "bit", "aria-pressed": "false", "aria-label": t("bitOf", { key: index + 1, border: t(border) }), onclick: () => this.toggle(index) },
        h("span", { class: "border" }, t(border)),
        h("span", { class: "digit" }, "0"),
        h("kbd", { "aria-hidden": "true" }, String(index + 1)),
      ),
    );
    const check = h("button", { type: "button", class: "primary check", onclick: () => this.submit() }, t("check"));
    return h("div", { class: "bits", role: "group", tabindex: -1, "aria-label": t("bits") }, ...this.bits, check);
  }

  private toggle(index: number): void {
    const bit = this.bits[index];
    if (bit) this.write(index, bit.getAttribute("aria-pressed") === "true" ? "0" : "1");
  }

  private write(index: number, digit: string): void {
    const bit = this.bits[index]!;
    bit.setAttribute("aria-pressed", String(digit === "1"));
    bit.querySelector(".digit")!.textContent = digit;
  }

  /** Sets all bits, as a click in a region of the picture does. */
  set(code: string): void {
    if (code.length === this.bits.length) [...code].forEach((digit, index) => this.write(index, digit));
  }

  private submit(): void {
    const given = this.bits.map((bit) => (bit.getAttribute("aria-pressed") === "true" ? "1" : "0")).join("");
    this.onanswer("code" in this.question && given === this.question.code);
  }

  /** Handles a key; returns whether it was used. */
  key(event: KeyboardEvent): boolean {
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    const index = /^[1-6]$/.test(event.key) ? Number(event.key) - 1 : -1;
    if (this.bits[index]) this.toggle(index);
    else if (this.buttons[index]) this.buttons[index].click();
    else if (event.key === "Enter" && this.bits.length > 0 && !isElsewhere(event.target)) this.submit();
    else return false;
    return true;
  }
}

/** Returns whether a key belongs to a button or link that is not a bit. */
function isElsewhere(target: EventTarget | null): boolean {
  return target instanceof Element && target.closest("button, a, summary, [role=button]") !== null && !target.closest(".bit");
}
