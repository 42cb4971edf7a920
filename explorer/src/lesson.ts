// The page of one algorithm.

import { Compare } from "./compare";
import { h } from "./dom";
import { format, pack, type Address } from "./link";
import { IDEAS } from "./ideas";
import { inputPanel } from "./inputs";
import { Code, stateTable, textOfRun } from "./panes";
import { Player, type Setup } from "./player";
import { Bug, exercises } from "./exercises";
import { Quiz } from "./quiz";
import { sharePanel } from "./share";
import { Sketch } from "./sketch";
import { Stage } from "./stage";
import { trackBar } from "./tracks";
import { Transport } from "./transport";
import type { Family, Lesson } from "./types";
import { KEYS, language, named, of, t, type WordName } from "./words";

/** A page that is shown until another one takes its place. */
export interface Page {
  element: HTMLElement;
  title: string;
  key?(event: KeyboardEvent): boolean;
  close(): void;
}

/** Addresses are written no more often than this, in milliseconds. */
const SETTLED = 250;

/** Returns the idea of an algorithm; on wide screens it is shown in the head, on narrow ones among the facts. */
function idea(lesson: Lesson): HTMLElement | null {
  const words = IDEAS[lesson.name];
  return words ? h("p", { class: "idea" }, of(words)) : null;
}

function facts(lesson: Lesson): HTMLElement {
  const row = (name: WordName, value: string): HTMLElement[] => [h("dt", {}, t(name)), h("dd", {}, value)];
  return h(
    "details",
    { class: "facts" },
    h("summary", {}, t("facts")),
    idea(lesson),
    h(
      "dl",
      {},
      ...row("source", lesson.source),
      ...row("decides", named(lesson.class)),
      ...row("cost", lesson.cost),
      ...row("limits", lesson.limits),
    ),
  );
}

/** Buttons that choose a pane beside the picture, for screens with room for one; larger ones show all. */
function sideTabsOf(twin: HTMLDetailsElement): HTMLElement {
  const panes: [WordName, string][] = [
    ["code", "code"],
    ["state", "state"],
    ["textTab", "text"],
  ];
  const element = h("div", { class: "side-tabs", role: "group", "data-shown": "code" });
  const buttons = panes.map(([name, pane]) => h("button", { type: "button", "data-pane": pane, onclick: () => select(pane) }, t(name)));
  function select(pane: string): void {
    element.dataset.shown = pane;
    if (pane === "text") twin.open = true;
    buttons.forEach((button) => button.setAttribute("aria-pressed", String(button.dataset.pane === pane)));
  }
  element.append(...buttons);
  select("code");
  return element;
}

/** Panels below the picture, one at a time. */
function tabs(panels: [WordName, HTMLElement][]): HTMLElement {
  const buttons = panels.map(([name, panel], index) =>
    h("button", { type: "button", role: "tab", id: `tab-${name}`, "aria-controls": `panel-${name}`, tabindex: index === 0 ? 0 : -1, onclick: () => select(index) }, t(name), panel.dataset.badge ?? ""),
  );
  panels.forEach(([name, panel]) => {
    panel.id = `panel-${name}`;
    panel.setAttribute("role", "tabpanel");
    panel.setAttribute("aria-labelledby", `tab-${name}`);
  });
  function select(chosen: number, focus = false): void {
    panels.forEach(([, panel], index) => (panel.hidden = index !== chosen));
    buttons.forEach((button, index) => {
      button.setAttribute("aria-selected", String(index === chosen));
      button.tabIndex = index === chosen ? 0 : -1;
    });
    if (focus) buttons[chosen]!.focus();
  }
  const list = h(
    "div",
    {
      role: "tablist",
      class: "tabs",
      onkeydown: (event: KeyboardEvent) => {
        const way = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
        if (way === 0) return;
        event.preventDefault();
        event.stopPropagation();
        const now = buttons.findIndex((button) => button.tabIndex === 0);
        select((now + way + buttons.length) % buttons.length, true);
      },
    },
    ...buttons,
  );
  select(0);
  return h("section", { class: "lower" }, list, ...panels.map(([, panel]) => panel));
}

export function lessonPage(
  lesson: Lesson,
  families: Family[],
  start: { setup: Setup; address: Address; notice?: string },
  go: (address: Address) => void,
): Page {
  const { address } = start;
  const embedded = address.embed === true;
  const player = new Player(lesson, start.setup, (address.step ?? 1) - 1);
  const stage = new Stage(player);
  const code = new Code(player);
  const sketch = new Sketch(player, stage);
  const transport = new Transport(player);
  const compare = new Compare(player, families);
  const caption = h("p", { class: "caption", "aria-live": "polite" });
  const notice = h("p", { class: "notice", role: "status", "aria-live": "polite", hidden: true });
  const codePane = h("div", { class: "scroll" }, code.element);
  const bug = lesson.faults.length > 0 ? new Bug(player) : undefined;
  const quiz = new Quiz(player, stage, transport, code, (hidden) => {
    codePane.classList.toggle("veiled", hidden === "line");
    main.classList.toggle("covered", hidden === "state");
  });
  let noticeTimer: number | undefined;

  function say(text: string, lasting = false): void {
    notice.textContent = text;
    notice.hidden = text === "";
    clearTimeout(noticeTimer);
    if (!lasting && text !== "") noticeTimer = window.setTimeout(() => say(""), 5000);
  }

  async function current(): Promise<Address> {
    const { input, operation, rule, fault } = player.setup;
    const isExample = "example" in input;
    return {
      a: lesson.name,
      ex: isExample && input.example !== "" ? input.example : undefined,
      in: isExample ? undefined : await pack(input),
      op: operation || undefined,
      rule: rule || undefined,
      bug: fault === undefined ? undefined : fault + 1,
      ask: quiz.asks,
      step: player.step + 1,
      with: compare.names.length > 0 ? compare.names : undefined,
      track: address.track,
      at: address.at,
      lang: language(),
      embed: embedded || undefined,
    };
  }

  let timer: number | undefined;
  /** The address as this page has it. */
  let written = location.hash;
  let closed = false;
  function settle(): void {
    clearTimeout(timer);
    timer = window.setTimeout(async () => {
      const text = format(await current());
      // Another address was chosen meanwhile: its page is loading.
      if (closed || location.hash !== written) return;
      history.replaceState(null, "", text);
      written = location.hash;
    }, SETTLED);
  }

  transport.allow = (to) => quiz.allow(to);
  transport.onnotice = (text) => say(text);
  compare.onchange = settle;
  quiz.onchange = settle;
  code.online = (line) => {
    if (quiz.line(line) || bug?.line(line)) return;
    const runs = (step: number): boolean => player.run?.lines[step] === line;
    let found = player.find(1, runs);
    // At the end it starts again.
    if (found < 0) found = player.run?.lines.indexOf(line) ?? -1;
    if (found >= 0) transport.seek(found);
    else say(t("noLine"));
  };
  let suited: string | undefined;
  let pending = start.notice ?? "";
  player.addEventListener("run", () => {
    say(pending, true);
    pending = "";
    const { input } = player.setup;
    const origin = "example" in input ? input.example : "own";
    if (origin !== suited) stage.suit();
    suited = origin;
    settle();
  });
  player.addEventListener("error", () => say(player.error, true));
  player.addEventListener("frame", () => {
    caption.textContent = player.frame?.frame.caption ?? "";
    settle();
    if (embedded && parent !== window) {
      parent.postMessage({ step: player.step + 1, of: player.steps, algorithm: lesson.name }, "*");
    }
  });
  function message(event: MessageEvent<unknown>): void {
    const { data } = event;
    if (typeof data !== "object" || data === null || !("goto" in data)) return;
    const to = Number(data.goto) - 1;
    if (Number.isInteger(to)) transport.seek(to);
  }
  if (embedded) window.addEventListener("message", message);

  const help = keysDialog();
  const head = h(
    "header",
    { class: "head" },
    h("h1", {}, of(lesson.title)),
    h("p", { class: "by" }, `${lesson.authors}, ${lesson.year}`, " · ", h("span", { class: "class" }, named(lesson.class))),
    idea(lesson),
    facts(lesson),
  );
  const twin = textOfRun(player);
  const sideTabs = sideTabsOf(twin);
  const title = (name: WordName): HTMLElement => h("h2", { class: "pane-title" }, t(name));
  const main = h(
    "main",
    { id: "content", class: embedded ? "lesson embedded" : "lesson", tabindex: -1 },
    embedded ? null : trackBar(address, families, go),
    embedded ? h("h1", { class: "visually-hidden" }, of(lesson.title)) : head,
    h(
      "div",
      { class: "board" },
      h("section", { class: "pane picture-pane", "aria-label": t("picture") }, stage.element, caption, notice, sketch.bar, quiz.bar, bug?.bar, transport.element),
      embedded
        ? h("a", { class: "full", href: format({ ...address, embed: undefined }), target: "_blank", rel: "noopener" }, t("seeFull"))
        : h(
            "div",
            { class: "side" },
            sideTabs,
            h("section", { class: "pane code-pane" }, title("code"), codePane),
            h("section", { class: "pane state-pane" }, title("state"), h("div", { class: "scroll", tabindex: 0, role: "group", "aria-label": t("state") }, stateTable(player))),
            twin,
          ),
    ),
    embedded
      ? null
      : tabs([
          ["input", inputPanel(player, stage, sketch, (text) => say(text))],
          ["quiz", quiz.element],
          ["exercises", exercises(player, bug)],
          ["compare", compare.element],
          ["share", sharePanel(player, current, (text) => say(text))],
        ]),
    help,
  );

  function key(event: KeyboardEvent): boolean {
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z") {
      if (event.shiftKey) player.redo();
      else player.undo();
      return true;
    }
    if (event.key === "?") {
      help.showModal();
      return true;
    }
    if (event.key.toLowerCase() === "r" && !event.ctrlKey && !event.metaKey) {
      player.change({ input: { example: "" }, operation: "", rule: "" }, player.setup, 0);
      return true;
    }
    if (sketch.key(event) || quiz.key(event)) return true;
    // A frame has nothing to scroll: presenters' remotes send these.
    const pages = embedded ? ["PageUp", "PageDown"].indexOf(event.key) : -1;
    if (pages >= 0) {
      transport.seek(player.step + (pages === 0 ? -1 : 1));
      return true;
    }
    return transport.key(event);
  }

  void player.start(start.setup, player.step).then(() => {
    compare.restore(address.with ?? []);
    if (address.ask) quiz.begin(address.ask);
  });
  return {
    element: main,
    title: of(lesson.title),
    key,
    close() {
      closed = true;
      clearTimeout(timer);
      window.removeEventListener("message", message);
      transport.close();
      stage.close();
      compare.close();
      player.close();
    },
  };
}

function keysDialog(): HTMLDialogElement {
  const rows = KEYS.map(({ keys, text }) => [h("dt", {}, ...keys.split(" ").map((key) => h("kbd", {}, key))), h("dd", {}, text[language()])]).flat();
  const dialog = h("dialog", { class: "keys", "aria-label": t("help") }, h("h2", {}, t("help")), h("dl", {}, ...rows), h("button", { type: "button", onclick: () => dialog.close() }, t("close")));
  return dialog;
}
