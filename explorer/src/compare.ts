// Other algorithms on the same input, each with a stage of its own and a part of the one scrubber.

import { h } from "./dom";
import { kindName, kindsOf, Player } from "./player";
import { Stage } from "./stage";
import type { Family, Lesson } from "./types";
import { of, t } from "./words";

/** The most algorithms beside the page's own. */
const MOST = 2;

export class Compare {
  readonly element: HTMLElement;
  /** Called when others are chosen. */
  onchange: (() => void) | undefined;
  private others: { player: Player; stage: Stage; caption: HTMLElement; card: HTMLElement }[] = [];
  private cards = h("div", { class: "cards" });
  private counts = h("div", { class: "state", tabindex: 0, role: "group", "aria-label": t("counts") });
  private select: HTMLSelectElement;
  /** Hides the counts of a run until somebody has guessed. */
  private guesses = h("button", { type: "button", hidden: true, "aria-pressed": "false", "data-guess": "", onclick: () => this.toggleGuesses() }, t("guess"));
  private guessing = false;

  constructor(
    private player: Player,
    families: Family[],
  ) {
    // Algorithms of the family first: those are alike; then all that take the same.
    const own = player.lesson;
    const family = families.find((one) => one.lessons.some((lesson) => lesson.name === own.name));
    const alike = [
      ...(family?.lessons ?? []),
      ...families.flatMap((one) => one.lessons).filter((lesson) => lesson.takes.en === own.takes.en),
    ];
    const lessons = [...new Map(alike.map((lesson) => [lesson.name, lesson])).values()].filter((lesson) => lesson.name !== own.name);
    this.select = h(
      "select",
      { id: "compare-with", onchange: () => this.add(lessons.find((lesson) => lesson.name === this.select.value)) },
      h("option", { value: "" }, "–"),
      ...lessons.map((lesson) => h("option", { value: lesson.name }, of(lesson.title))),
    );
    this.element = h(
      "div",
      { class: "panel" },
      h("p", { class: "hint" }, t("compareHint")),
      h("div", { class: "choices" }, h("span", {}, h("label", { for: "compare-with" }, t("compareWith")), this.select), this.guesses),
      this.cards,
      this.counts,
    );
    this.lessons = lessons;
    player.addEventListener("run", () => {
      this.others.forEach(({ player: other }) => void other.start(this.setup(), other.step));
      this.count();
    });
    player.addEventListener("frame", () => this.follow());
  }

  private lessons: Lesson[];

  get names(): string[] {
    return this.others.map(({ player }) => player.lesson.name);
  }

  close(): void {
    this.others.forEach(({ player, stage }) => {
      stage.close();
      player.close();
    });
  }

  /** Returns the input with its numbers: names of examples belong to one lesson. */
  private setup(): Player["setup"] {
    // Faults belong to one lesson as names of examples do.
    return { ...this.player.setup, fault: undefined, input: this.player.run?.input ?? this.player.setup.input };
  }

  restore(names: string[]): void {
    names.forEach((name) => this.add(this.lessons.find((lesson) => lesson.name === name)));
  }

  private add(lesson: Lesson | undefined): void {
    this.select.value = "";
    if (!lesson || this.names.includes(lesson.name) || this.others.length >= MOST) return;
    const other = new Player(lesson, this.setup(), 0);
    const stage = new Stage(other);
    stage.editable = false;
    const caption = h("p", { class: "caption" });
    const card = h(
      "section",
      { class: "card", "aria-label": of(lesson.title) },
      h("header", {}, h("h3", {}, of(lesson.title)), h("button", { type: "button", class: "quiet", "aria-label": `${t("close")}: ${of(lesson.title)}`, onclick: () => this.remove(other) }, "×")),
      stage.element,
      caption,
    );
    other.addEventListener("frame", () => {
      caption.textContent = `${other.step + 1} / ${other.steps} · ${other.frame?.frame.caption ?? ""}`;
    });
    other.addEventListener("run", () => {
      this.follow();
      this.count();
    });
    other.addEventListener("error", () => {
      caption.textContent = `${of(lesson.title)} ${t("cannot")}. ${other.error}`;
      this.count();
    });
    this.others.push({ player: other, stage, caption, card });
    this.cards.append(card);
    void other.start(this.setup(), 0);
    this.onchange?.();
  }

  private remove(player: Player): void {
    const found = this.others.find((other) => other.player === player);
    this.others = this.others.filter((other) => other !== found);
    found?.stage.close();
    found?.card.remove();
    player.close();
    this.count();
    this.onchange?.();
  }

  /** Shows each run as far on as the page's own. */
  private follow(): void {
    const share = this.player.step / Math.max(1, this.player.steps - 1);
    for (const { player } of this.others) {
      if (player.run) player.go(Math.round(share * (player.steps - 1)));
    }
  }

  private toggleGuesses(): void {
    this.guessing = !this.guessing;
    this.guesses.setAttribute("aria-pressed", String(this.guessing));
    this.count();
  }

  /** Asks which run is the shortest; the answer shows the counts. */
  private ask(all: Player[]): void {
    const fewest = Math.min(...all.map((player) => player.steps));
    const answer = (player: Player): void => {
      const best = all.filter((other) => other.steps === fewest).map((other) => of(other.lesson.title));
      const isRight = player.steps === fewest;
      const words = isRight ? `✓ ${t("right")}` : `✗ ${t("wrong")} ${best.join(", ")}`;
      this.tell(all, h("p", { class: `verdict ${isRight ? "right" : "wrong"}`, role: "status" }, words));
    };
    this.counts.replaceChildren(
      h("p", { class: "question" }, t("guessAsk")),
      h("div", { class: "answers" }, ...all.map((player) => h("button", { type: "button", onclick: () => answer(player) }, of(player.lesson.title)))),
    );
  }

  private count(): void {
    const all = [this.player, ...this.others.map((other) => other.player)].filter((player) => player.run && player.error === "");
    this.guesses.hidden = this.others.length === 0;
    if (this.others.length === 0) this.counts.replaceChildren();
    else if (this.guessing && all.length > 1) this.ask(all);
    else this.tell(all);
  }

  /** Shows how many steps of each kind the runs take. */
  private tell(all: Player[], verdict?: HTMLElement): void {
    const kinds = [...new Set(all.flatMap((player) => kindsOf(player.lesson)))];
    const name = (kind: string): string => kindName(all.find((player) => kindsOf(player.lesson).includes(kind))!.lesson, kind);
    const rows = kinds.map((kind) => ({ kind, values: all.map((player) => player.counts().get(kind)) }));
    this.counts.replaceChildren(
      ...(verdict ? [verdict] : []),
      h("h3", {}, t("counts")),
      h(
        "table",
        {},
        h("thead", {}, h("tr", {}, h("td", {}), ...all.map((player) => h("th", { scope: "col" }, of(player.lesson.title))))),
        h(
          "tbody",
          {},
          h("tr", {}, h("th", { scope: "row" }, t("steps")), ...all.map((player) => h("td", {}, String(player.steps)))),
          ...rows.map(({ kind, values }) => h("tr", {}, h("th", { scope: "row" }, name(kind)), ...values.map((value) => h("td", {}, value === undefined ? "–" : String(value))))),
        ),
      ),
    );
  }
}
