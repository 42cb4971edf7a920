// Exercises: inputs whose runs must meet a goal, and programs with one wrong line.

import { h } from "./dom";
import { engineOf } from "./engine";
import { kindsOf, type Player } from "./player";
import { gapped } from "./quiz";
import type { Input } from "./types";
import { of, t } from "./words";

/** Sentences by which a run with a fault is compared with the right one. */
const COMPARED = 1_000;

/** The exercise that runs a program with one wrong line, which the student must find. */
export class Bug {
  /** The part of the panel that starts it. */
  readonly element: HTMLElement;
  /** The question, for a place beside the picture. */
  readonly bar: HTMLElement;
  private tries = 0;
  private solved = false;
  private words = h("p", { class: "question", role: "status", "aria-live": "polite" });
  private verdict = h("p", { class: "verdict", role: "status", "aria-live": "polite" });

  constructor(private player: Player) {
    const button = (name: "bugStart" | "bugOther" | "bugGiveUp" | "bugEnd", onclick: () => void): HTMLElement =>
      h("button", { type: "button", "data-bug": name, onclick }, t(name));
    this.element = h("div", { class: "bug" }, h("h3", {}, t("bug")), h("p", { class: "hint" }, t("bugHint")), button("bugStart", () => void this.start()));
    const tools = h("div", { class: "tools" }, button("bugGiveUp", () => this.tell(t("bugTold"))), button("bugOther", () => void this.start()), button("bugEnd", () => this.end()));
    this.bar = h("div", { class: "asking bug-bar", hidden: true }, this.words, this.verdict, tools);
    player.addEventListener("run", () => this.renew());
  }

  private get fault(): { line: number; wrong: string } | undefined {
    const { fault } = this.player.setup;
    return fault === undefined ? undefined : this.player.lesson.faults[fault];
  }

  private renew(): void {
    this.bar.hidden = this.fault === undefined;
    // A click on a line is an answer meanwhile.
    this.bar.closest("main")?.classList.toggle("hunting", this.fault !== undefined && !this.solved);
    if (this.fault && !this.solved) this.words.textContent = t("bugAsk");
  }

  /** Returns whether a fault visibly changes a run. */
  private async shows(fault: number, input: Input): Promise<boolean> {
    const { lesson, setup } = this.player;
    const sentences = async (own: number | undefined): Promise<string> => {
      const engine = engineOf(lesson);
      const { handle } = await engine.run({ name: lesson.name, input, operation: setup.operation, rule: setup.rule, fault: own, cap: COMPARED });
      const captions = await engine.captions(handle, 0, COMPARED, "en");
      engine.drop(handle);
      return captions.join("\n");
    };
    return (await sentences(fault)) !== (await sentences(undefined));
  }

  /** Returns the input of the page if a fault is visible on it, else an example on which it is. */
  private async inputFor(fault: number): Promise<Input> {
    const { lesson, setup } = this.player;
    const all: Input[] = [setup.input, ...lesson.examples.map(({ name }) => ({ example: name }))];
    for (const input of all) if (await this.shows(fault, input)) return input;
    return setup.input;
  }

  /** Runs a program with another fault than the last one. */
  private async start(): Promise<void> {
    const { player } = this;
    const count = player.lesson.faults.length;
    const last = player.setup.fault;
    const fault = last === undefined ? Math.floor(Math.random() * count) : (last + 1 + Math.floor(Math.random() * (count - 1))) % count;
    this.tries = 0;
    this.solved = false;
    this.verdict.textContent = "";
    this.verdict.className = "verdict";
    const input = await this.inputFor(fault);
    player.change({ ...player.setup, fault, input }, player.setup, 0);
    this.bar.parentElement?.scrollIntoView({ block: "nearest" });
  }

  private end(): void {
    const { player } = this;
    player.change({ ...player.setup, fault: undefined }, player.setup, 0);
  }

  private tell(words: string): void {
    const { fault } = this;
    if (!fault) return;
    this.solved = true;
    const right = this.player.lesson.pseudocode[fault.line - 1]!.trim();
    this.words.textContent = words;
    this.verdict.textContent = t("bugWas", { line: fault.line, right, wrong: fault.wrong });
    this.verdict.className = "verdict right";
  }

  /** Handles a click on a line of the pseudocode; returns whether it was an answer. */
  line(line: number): boolean {
    const { fault } = this;
    if (!fault || this.solved) return false;
    this.tries += 1;
    if (line === fault.line) this.tell(t(this.tries === 1 ? "bugFirst" : "bugFound", { tries: this.tries }));
    else {
      this.verdict.className = "verdict wrong";
      this.verdict.textContent = `✗ ${t("bugNot", { line })}`;
    }
    return true;
  }
}

interface Goal {
  text(): string;
  solved(): boolean;
}

/** Returns the exercises of every lesson: goals for the input, checked by its run. */
export function exercises(player: Player, bug: Bug | undefined): HTMLElement {
  const { lesson } = player;
  const list = h("ul", { class: "goals" });
  const kinds = kindsOf(lesson);
  /** Counts of the first run, on which the goals are based. */
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
  return h("div", { class: "panel" }, h("p", { class: "hint" }, t("exercisesHint")), list, bug?.element);
}
