// The quiz: questions about the next step, checked against the run itself.

import { h } from "./dom";
import { codeAt, Fields, hasNumbers, questions, textOf, type Question } from "./numbers";
import type { Code } from "./panes";
import type { Player } from "./player";
import type { Stage } from "./stage";
import { asked, hasPixels, hit, placesInWords } from "./targets";
import type { Transport } from "./transport";
import type { Frame, Point, Target } from "./types";
import { of, t, type WordName } from "./words";

/** The most answers to choose from. */
const ANSWERS = 4;

/** Returns a sentence with gaps in place of values. */
export function gapped(text: string): string {
  return text.replace(/\{\w+\}/g, "…").replace(/\{\w+\|[^|}]*\|([^}]*)\}/g, "$1");
}

/** Subject of a question: the place in the picture if there is one, numbers and decisions, the kind of step, or the line that runs. */
type Mode = "place" | "number" | "kind" | "line";
const MODES: [Mode, WordName][] = [
  ["place", "byPlace"],
  ["number", "byNumber"],
  ["kind", "byKind"],
  ["line", "byLine"],
];

/** Parts hidden by a question: none, the line that runs, or everything that shows the state. */
export type Hidden = "" | "line" | "state";

export class Quiz {
  /** The panel that starts and ends the quiz. */
  readonly element: HTMLElement;
  /** Question and answers, for a place beside the picture. */
  readonly bar: HTMLElement;
  /** Is called when the quiz begins or ends, or asks for something else. */
  onchange: (() => void) | undefined;
  private on = false;
  private mode: Mode = "place";
  private right = 0;
  private asked = 0;
  /** The step in question; undefined while there is none. */
  private open: number | undefined;
  /** Counts questions, to recognize late answers. */
  private ticket = 0;
  /** Fields of the question, if its answer is a number or a decision. */
  private fields: Fields | undefined;
  /** True once the first step was asked about; it is shown before the quiz begins. */
  private began = false;

  private startButton = h("button", { type: "button", class: "primary", onclick: () => this.toggle() }, t("quizStart"));
  private question = h("p", { class: "question", role: "status", "aria-live": "polite" });
  private answers = h("div", { class: "answers" });
  private verdict = h("p", { class: "verdict", role: "status", "aria-live": "polite" });
  private score = h("p", { class: "score" });
  private modes: HTMLButtonElement[];

  constructor(
    private player: Player,
    private stage: Stage,
    private transport: Transport,
    private code: Code,
    private veil: (hidden: Hidden) => void,
  ) {
    const modes = MODES.filter(([mode]) => mode !== "number" || hasNumbers(player.lesson));
    this.modes = modes.map(([mode, name]) =>
      h("button", { type: "button", "data-mode": mode, "aria-pressed": mode === this.mode ? "true" : "false", onclick: () => this.choose(mode) }, t(name)),
    );
    const end = h("button", { type: "button", class: "quiet", onclick: () => this.toggle() }, t("quizStop"));
    this.element = h("div", { class: "panel quiz" }, h("p", { class: "hint" }, t("quizHint")), h("div", { class: "tools" }, this.startButton, ...this.modes));
    this.bar = h("div", { class: "asking quiz-bar", hidden: true }, this.verdict, this.question, this.answers, h("div", { class: "tools" }, this.score, end));
    player.addEventListener("frame", () => {
      if (this.on && this.open === undefined) void this.ask();
    });
    player.addEventListener("run", () => {
      this.open = undefined;
      this.began = false;
    });
  }

  /** Returns what the quiz asks for; undefined while there is none. */
  get asks(): string | undefined {
    return this.on ? this.mode : undefined;
  }

  /** Begins the quiz, as a link wants it. */
  begin(asks: string): void {
    const mode = this.modes.map((button) => button.dataset.mode as Mode).find((mode) => mode === asks);
    if (!mode || this.on || !this.player.run) return;
    this.choose(mode);
    this.toggle();
  }

  /** Returns whether a step may be shown: during its question only the answer shows it. */
  allow(to: number): boolean {
    const allowed = !this.on || this.open === undefined || to < this.open;
    if (!allowed) this.bar.scrollIntoView({ block: "nearest" });
    return allowed;
  }

  private toggle(): void {
    this.on = !this.on;
    this.startButton.textContent = this.on ? t("quizStop") : t("quizStart");
    this.right = this.asked = 0;
    this.began = false;
    this.verdict.textContent = "";
    this.verdict.className = "verdict";
    this.score.textContent = "";
    this.bar.hidden = !this.on;
    if (this.on) {
      void this.ask();
      this.bar.parentElement?.scrollIntoView({ block: "nearest" });
    } else this.end();
    this.onchange?.();
  }

  private choose(mode: Mode): void {
    this.mode = mode;
    this.modes.forEach((button) => button.setAttribute("aria-pressed", String(button.dataset.mode === mode)));
    if (this.on) void this.ask();
    this.onchange?.();
  }

  private end(): void {
    this.ticket++;
    this.open = undefined;
    this.question.textContent = "";
    this.clear();
    this.stage.picker.answered("");
    this.stage.hidesCodes = false;
    this.stage.picker.end();
    this.veil("");
  }

  /** Removes the answers of the last question. */
  private clear(): void {
    this.fields = undefined;
    this.answers.replaceChildren();
  }

  private async ask(): Promise<void> {
    const { player } = this;
    const own = ++this.ticket;
    this.clear();
    this.stage.hidesCodes = false;
    if (this.mode === "number" && player.step === 0 && !this.began) {
      this.began = true;
      if (await this.askFirst(own)) return;
      if (own !== this.ticket) return;
    }
    const next = player.step + 1;
    // The last sentence of a run that was cut off belongs to no step.
    if (next >= player.steps || player.run!.templates[next]! < 0) {
      this.open = undefined;
      this.question.textContent = t("quizEnd");
      return;
    }
    this.open = next;
    this.transport.pause();
    this.veil(this.mode === "line" ? "line" : "");
    if (this.mode === "line") {
      this.stage.picker.end();
      this.question.textContent = t("askLine");
      return;
    }
    const before = player.frame;
    const frame = this.mode === "kind" ? undefined : await this.frameAt(next);
    if (own !== this.ticket) return;
    const targets = frame ? asked(frame, before) : [];
    const numbers = frame ? questions(player.lesson, frame) : [];
    if (numbers.length > 0 && (this.mode === "number" || targets.length === 0)) return this.askNumbers(numbers);
    if (targets.length > 0) return this.askPlace(next, targets);
    this.stage.picker.end();
    this.askKind(next);
  }

  /** Asks for the numbers of the first step, which hides the state; returns whether it has any. */
  private async askFirst(own: number): Promise<boolean> {
    const frame = await this.frameAt(0);
    const numbers = frame ? questions(this.player.lesson, frame) : [];
    if (own !== this.ticket || numbers.length === 0) return false;
    this.open = 0;
    this.transport.pause();
    this.veil("state");
    this.askNumbers(numbers);
    return true;
  }

  /** Returns the frame of a step; none if the engine has ended, in which case it restarts with the run. */
  private async frameAt(step: number): Promise<Frame | undefined> {
    try {
      return await this.player.frameAt(step);
    } catch {
      return undefined;
    }
  }

  private askNumbers([question, ...rest]: Question[]): void {
    if (!question) return;
    const { stage, player } = this;
    const fields = new Fields(question, (right) => (right && rest.length > 0 ? this.goOn(rest) : this.answer(right)));
    this.fields = fields;
    this.question.textContent = textOf(question);
    this.answers.replaceChildren(fields.element);
    fields.focus();
    stage.hidesCodes = "code" in question;
    if (!stage.hidesCodes) return stage.picker.end();
    stage.picker.ask(false, (at: Point) => {
      const place = player.frame?.map;
      const code = place && codeAt(at, place, player.run?.input);
      if (code) fields.set(code);
      stage.redraw();
    });
  }

  /** Counts a right answer, and asks the next question about the same step. */
  private goOn(rest: Question[]): void {
    this.count(true);
    this.verdict.textContent = `✓ ${t("right")}`;
    this.askNumbers(rest);
  }

  /** Handles a key of the question; returns whether it was used. */
  key(event: KeyboardEvent): boolean {
    return this.open !== undefined && this.fields?.key(event) === true;
  }

  private askPlace(next: number, targets: Target[]): void {
    const template = this.player.lesson.templates[this.player.run!.templates[next]!]!;
    this.question.textContent = `${t("askPlace", { place: placesInWords(targets) })} “${gapped(of(template.text))}”`;
    this.stage.picker.ask(hasPixels(targets), (at: Point, scale: number) => this.answer(hit(targets, at, scale), undefined, true));
  }

  private askKind(next: number): void {
    const { player } = this;
    this.question.textContent = t("askKind");
    const templates = player.lesson.templates;
    const truth = player.run!.templates[next] ?? -1;
    const chosen = new Set<number>([truth]);
    // Other sentences in an order that depends on the step, so that the right one is not always in one place.
    for (let k = 0; k < templates.length && chosen.size < Math.min(ANSWERS, templates.length); k++) {
      chosen.add((truth + 1 + ((next * 7 + k) % templates.length)) % templates.length);
    }
    const order = [...chosen].filter((place) => place >= 0).sort((a, b) => a - b);
    this.answers.replaceChildren(
      ...order.map((place) => {
        const template = templates[place]!;
        return h("button", { type: "button", "data-template": place, onclick: () => this.answer(place === truth) }, gapped(of(template.text)));
      }),
    );
  }

  /** Handles a click on a line of the pseudocode; returns whether it was an answer. */
  line(line: number): boolean {
    if (!this.on || this.mode !== "line" || this.open === undefined) return false;
    const truth = this.player.run?.lines[this.open];
    this.answer(line === truth, truth);
    return true;
  }

  private count(right: boolean): void {
    this.asked += 1;
    this.right += right ? 1 : 0;
    this.score.textContent = `${t("score")}: ${this.right} / ${this.asked}`;
    this.verdict.className = `verdict ${right ? "right" : "wrong"}`;
  }

  private answer(right: boolean, line?: number, onStage = false): void {
    const next = this.open;
    if (next === undefined) return;
    this.open = undefined;
    this.count(right);
    this.stage.hidesCodes = false;
    this.stage.picker.answered(onStage ? (right ? "right" : "wrong") : "");
    this.veil("");
    const words = right ? t("right") : line === undefined ? t("wrong") : `${t("wrongLine")} ${line}.`;
    const told = (): void => {
      this.player.removeEventListener("frame", told);
      this.verdict.textContent = `${right ? "✓" : "✗"} ${words} ${this.player.frame?.frame.caption ?? ""}`;
      this.code.mark(this.player.run?.lines[this.player.step] ?? 0);
    };
    this.player.addEventListener("frame", told);
    this.player.go(next);
  }
}
