// Panes beside the picture: pseudocode, state, and all captions as text.

import { h } from "./dom";
import { Refused, Trapped } from "./engine";
import type { Player } from "./player";
import { language, t } from "./words";

/** Captions that are shown around the current step. */
const PAGE = 60;

/** The pseudocode with the line that runs. */
export class Code {
  readonly element: HTMLElement;
  /** Called when a line is clicked, counted from 1. */
  online: ((line: number) => void) | undefined;
  private lines: HTMLElement[];

  constructor(player: Player) {
    this.lines = player.lesson.pseudocode.map((text, index) => {
      const depth = (/^ */.exec(text)?.[0].length ?? 0) / 2;
      return h(
        "button",
        {
          type: "button",
          class: "line",
          style: `--depth:${depth}`,
          onclick: () => this.online?.(index + 1),
        },
        text.trim(),
      );
    });
    const list = h("ol", { class: "code" }, ...this.lines.map((line) => h("li", {}, line)));
    this.element = h("div", {}, list, h("p", { class: "hint" }, t("codeHint")));
    player.addEventListener("frame", () => this.mark(player.run?.lines[player.step] ?? 0));
  }

  /** Marks the line that runs; 0 for none, while the quiz asks for it. */
  mark(line: number): void {
    this.lines.forEach((element, index) => {
      const runs = index + 1 === line;
      element.classList.toggle("runs", runs);
      if (runs) element.setAttribute("aria-current", "step");
      else element.removeAttribute("aria-current");
      if (runs) reveal(element);
    });
  }
}

/** Scrolls a pane, never the page. */
function reveal(element: HTMLElement): void {
  const pane = element.closest<HTMLElement>(".scroll");
  if (!pane) return;
  const [box, own] = [pane.getBoundingClientRect(), element.getBoundingClientRect()];
  if (own.top < box.top) pane.scrollTop -= box.top - own.top + 8;
  else if (own.bottom > box.bottom) pane.scrollTop += own.bottom - box.bottom + 8;
}

/** The state as a table whose changed cells are marked. */
export function stateTable(player: Player): HTMLElement {
  const element = h("div", { class: "state" });
  player.addEventListener("frame", () => {
    const table = player.frame?.frame.table;
    const isHeaded = table?.heads.some((text) => text !== "") ?? false;
    if (!table || (table.rows.length === 0 && !isHeaded)) {
      element.replaceChildren(h("p", { class: "hint" }, t("noState")));
      return;
    }
    const head = isHeaded
      ? h("thead", {}, h("tr", {}, ...table.heads.map((text) => h(text === "" ? "td" : "th", { scope: text === "" ? undefined : "col" }, text))))
      : null;
    const rows = table.rows.map((row) =>
      h(
        "tr",
        {},
        h("th", { scope: "row" }, row.name),
        ...row.cells.map((cell) => h("td", { class: cell.changed && cell.text !== "" ? "changed" : undefined }, cell.text)),
      ),
    );
    // An empty stack or list is an answer, too.
    const none = h("tr", {}, h("td", { colspan: Math.max(1, table.heads.length), class: "none" }, t("emptyState")));
    element.replaceChildren(h("table", {}, head, h("tbody", {}, ...(rows.length > 0 ? rows : [none]))));
  });
  return element;
}

/** The captions around the current step, for readers and screen readers. */
export function textOfRun(player: Player): HTMLDetailsElement {
  const list = h("ol", { class: "captions" });
  const note = h("p", { class: "hint" });
  const details = h("details", { class: "text-twin", ontoggle: () => void fill() }, h("summary", {}, t("text")), note, list);
  let shown = "";
  let of = player.run;
  async function fill(): Promise<void> {
    const { run, step } = player;
    if (!run || !details.open) return;
    const first = Math.floor(step / PAGE) * PAGE;
    const key = `${first} ${language()}`;
    if (key !== shown || run !== of) {
      try {
        const captions = await player.engine.captions(run.handle, first, PAGE, language());
        if (run !== player.run) return;
        shown = key;
        of = run;
        note.textContent = t("textHint", { first: first + 1, last: first + captions.length });
        list.start = first + 1;
        list.replaceChildren(
          ...captions.map((caption, index) =>
            h("li", {}, h("button", { type: "button", onclick: () => player.go(first + index) }, caption)),
          ),
        );
      } catch (e) {
        if (!(e instanceof Refused || e instanceof Trapped)) throw e;
      }
    }
    [...list.children].forEach((item, index) => {
      if (first + index === step) item.setAttribute("aria-current", "step");
      else item.removeAttribute("aria-current");
    });
  }
  player.addEventListener("frame", () => void fill());
  return details;
}
