// Ask-mode: what comes next, checked against the run itself. Exercises: inputs whose runs have to be of a kind.

import { h } from "./dom";
import type { Code } from "./panes";
import { kindsOf, type Player } from "./player";
import type { Transport } from "./transport";
import { of, t } from "./words";

/** The most answers to choose from. */
const ANSWERS = 4;

/** Returns a sentence with gaps where values are. */
export function gapped(text: string): string {
  return text.replace(/\{\w+\}/g, "…");
}

export class Quiz {
  readonly element: HTMLElement;
  private on = false;
  private byLine = false;
  private right = 0;
  private asked = 0;
  /** The step in question; undefined while there is none. */
  private open: number | undefined;

  private startButton = h("button", { type: "button", class: "primary", onclick: () => this.toggle() }, t("quizStart"));
  private modeButton = h("button", { type: "button", onclick: () => this.mode() }, t("byLine"));
  private question = h("p", { class: "question" });
  private answers = h("div", { class: "answers" });
  private verdict = h("p", { class: "verdict", role: "status", "aria-live": "polite" });
  private score = h("p", { class: "score" });

  constructor(
    private player: Player,
    private transport: Transport,
    private code: Code,
    private veil: (hidden: boolean) => void,
  ) {
    this.element = h(
      "div",
      { class: "panel quiz" },
      h("p", { class: "hint" }, t("quizHint")),
      h("div", { class: "tools" }, this.startButton, this.modeButton),
      this.question,
      this.answers,
      this.verdict,
      this.score,
    );
    player.addEventListener("frame", () => {
      if (this.on && this.open === undefined) this.ask();
    });
    player.addEventListener("run", () => {
      this.open = undefined;
    });
  }

  /** Returns whether a step may be shown: while it is in question, only the answer shows it. */
  allow(to: number): boolean {
    return !this.on || this.open === undefined || to < this.open;
  }

  private toggle(): void {
    this.on = !this.on;
    this.startButton.textContent = this.on ? t("quizStop") : t("quizStart");
    this.element.classList.toggle("on", this.on);
    this.right = this.asked = 0;
    this.verdict.textContent = "";
    this.verdict.className = "verdict";
    if (this.on) this.ask();
    else this.end();
  }

  private mode(): void {
    this.byLine = !this.byLine;
    this.modeButton.textContent = this.byLine ? t("byKind") : t("byLine");
    if (this.on) this.ask();
  }

  private end(): void {
    this.open = undefined;
    this.question.textContent = "";
    this.answers.replaceChildren();
    this.score.textContent = "";
    this.veil(false);
  }

  private ask(): void {
    const { player } = this;
    const next = player.step + 1;
    // The last sentence of a run that was cut off is of no step.
    if (next >= player.steps || player.run!.templates[next]! < 0) {
      this.open = undefined;
      this.question.textContent = t("quizEnd");
      this.answers.replaceChildren();
      return;
    }
    this.open = next;
    this.transport.pause();
    if (this.byLine) {
      this.question.textContent = t("askLine");
      this.answers.replaceChildren();
      this.veil(true);
      return;
    }
    this.veil(false);
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

  /** Takes a click on a line of the pseudocode; returns whether it was an answer. */
  line(line: number): boolean {
    if (!this.on || !this.byLine || this.open === undefined) return false;
    const truth = this.player.run?.lines[this.open];
    this.answer(line === truth, truth);
    return true;
  }

  private answer(right: boolean, line?: number): void {
    const next = this.open;
    if (next === undefined) return;
    this.open = undefined;
    this.asked += 1;
    this.right += right ? 1 : 0;
    this.score.textContent = `${t("score")}: ${this.right} / ${this.asked}`;
    this.verdict.className = `verdict ${right ? "right" : "wrong"}`;
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

interface Goal {
  text(): string;
  solved(): boolean;
}

/** Returns exercises that any lesson has: goals for the input, which the run of it checks. */
export function exercises(player: Player): HTMLElement {
  const { lesson } = player;
  const list = h("ul", { class: "goals" });
  const kinds = kindsOf(lesson);
  /** Counts of the first run, which the goals are about. */
  let base: { counts: Map<string, number>; steps: number } | undefined;

  function sentence(kind: string): string {
    const template = lesson.templates.find((own) => own.kind === kind);
    return template ? gapped(of(template.text)) : kind;
  }
  function goals(): Goal[] {
    if (!base) return [];
    const { counts, steps } = base;
    const present = kinds.filter((kind) => counts.has(kind)).sort((a, b) => counts.get(b)! - counts.get(a)!);
    const most = present[0];
    const rare = present.at(-1);
    const all: Goal[] = [];
    if (most) {
      const count = counts.get(most)!;
      all.push({
        text: () => t("exerciseMore", { count, text: sentence(most) }),
        solved: () => (player.counts().get(most) ?? 0) > count,
      });
    }
    if (kinds.length > 1) {
      all.push({
        text: () => t("exerciseAll", { count: player.counts().size, all: kinds.length }),
        solved: () => kinds.every((kind) => player.counts().has(kind)),
      });
    }
    if (rare && kinds.length > 2) {
      all.push({
        text: () => t("exerciseNone", { text: sentence(rare) }),
        solved: () => !player.counts().has(rare),
      });
    }
    all.push({ text: () => t("exerciseFew", { count: steps }), solved: () => player.steps < steps });
    return all;
  }
  const done = new Set<number>();
  player.addEventListener("run", () => {
    base ??= { counts: player.counts(), steps: player.steps };
    list.replaceChildren(
      ...goals().map((goal, index) => {
        if (goal.solved()) done.add(index);
        const solved = done.has(index);
        return h(
          "li",
          { class: solved ? "solved" : undefined },
          h("span", { class: "mark", "aria-hidden": "true" }, solved ? "✓" : "○"),
          h("span", {}, goal.text()),
          h("span", { class: "visually-hidden" }, solved ? t("solved") : t("open_")),
        );
      }),
    );
  });
  return h("div", { class: "panel" }, h("p", { class: "hint" }, t("exercisesHint")), list);
}
