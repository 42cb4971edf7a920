// The input: examples, choices, tools for vertices, numbers, files.

import { h } from "./dom";
import { files, Refused, Trapped, type Opened } from "./engine";
import type { Player } from "./player";
import type { Sketch } from "./sketch";
import type { Stage } from "./stage";
import type { Input } from "./types";
import { named, of, t } from "./words";

/** Numbers of points of a curve and of curves for a surface given by a formula: as many as can be distinguished. */
const COLUMNS = 33;
const CURVES = 9;

const SNAPS = [0, 0.1, 0.25, 0.5, 1];

/** Returns an input with the window and the clip polygon of another one if it has none, as for map data, which have only shapes. */
function withWindow(input: Input, other: Input | undefined): Input {
  if (!("figure" in input) || !other || !("figure" in other)) return input;
  const { window, clip } = other.figure;
  const own = input.figure;
  return { figure: { ...own, window: own.window ?? window, clip: own.clip?.length ? own.clip : clip } };
}

export function inputPanel(player: Player, stage: Stage, sketch: Sketch, notice: (text: string) => void): HTMLElement {
  const { lesson } = player;
  const example = (): string | undefined => ("example" in player.setup.input ? player.setup.input.example : undefined);
  const buttons = lesson.examples.map((own) =>
    h("button", { type: "button", class: "example", "data-name": own.name, onclick: () => player.load(own.name) }, of(own.title)),
  );
  const choices = h("div", { class: "choices" });
  const undo = h("button", { type: "button", onclick: () => player.undo() }, t("undo"));
  const redo = h("button", { type: "button", onclick: () => player.redo() }, t("redo"));
  const add = h("button", { type: "button", onclick: () => stage.addVertex() }, t("add"));
  const remove = h("button", { type: "button", onclick: () => stage.removeChosen() }, t("remove"));
  const snap = h(
    "select",
    { id: "snap", onchange: () => (stage.snap = Number(snap.value)) },
    ...SNAPS.map((size) => h("option", { value: size }, size === 0 ? t("off") : String(size))),
  );
  const hint = h("p", { class: "hint" });
  const numbers = h("textarea", { id: "numbers", rows: 6, spellcheck: "false", "aria-label": t("numbers") });
  const apply = h("button", { type: "button", onclick: () => take(numbers.value) }, t("apply"));

  const byNumbers = h("details", {}, h("summary", {}, t("numbers")), numbers, apply);

  function take(text: string): void {
    try {
      const value = JSON.parse(text) as Input;
      player.change({ ...player.setup, input: value });
    } catch (e) {
      notice(String(e));
    }
  }

  async function opened(list: FileList | null): Promise<void> {
    const file = list?.[0];
    if (!file) return;
    try {
      const read = await files.ask<Opened>({ do: "read", name: file.name }, await file.arrayBuffer());
      // The run takes older notices away.
      if (read.warnings.length > 0) player.addEventListener("run", () => notice(read.warnings.join(" ")), { once: true });
      player.change({ ...player.setup, input: withWindow(read.input, player.run?.input) });
    } catch (e) {
      if (!(e instanceof Refused || e instanceof Trapped)) throw e;
      notice(e.message);
    }
    picker.value = "";
  }
  /** Draws curves of a surface, from a formula in x and z. */
  const formula = h("input", { type: "text", id: "formula", spellcheck: "false", placeholder: "sin(x) * cos(z)" });
  async function surface(): Promise<void> {
    try {
      const request = { do: "formula", formula: formula.value || formula.placeholder, columns: COLUMNS, curves: CURVES };
      const { input } = await files.ask<Opened>(request);
      player.change({ ...player.setup, input }, player.setup, 0);
      notice("");
    } catch (e) {
      if (!(e instanceof Refused || e instanceof Trapped)) throw e;
      notice(e.message);
    }
  }
  const byFormula = h(
    "form",
    { class: "tools formula", hidden: lesson.name !== "horizon-curves", onsubmit: (event: Event) => { event.preventDefault(); void surface(); } },
    h("label", { for: "formula" }, t("formula")),
    formula,
    h("button", { type: "submit" }, t("apply")),
  );
  const picker = h("input", { type: "file", id: "file", onchange: () => void opened(picker.files), accept: ".svg,.json,.geojson,.wkt,.obj,.stl,.ply,.off,.glb,.gltf,.png,.jpg,.jpeg,.gif,.bmp,.csv,.gpx,.kml" });

  function choose(name: "operation" | "rule", values: string[]): HTMLElement | null {
    if (values.length === 0) return null;
    const id = `choice-${name}`;
    const select = h(
      "select",
      { id, onchange: () => player.change({ ...player.setup, [name]: select.value }) },
      ...values.map((value) => h("option", { value }, named(value))),
    );
    select.value = player.setup[name] || values[0]!;
    return h("span", {}, h("label", { for: id }, t(name)), select);
  }

  const tools = h(
    "div",
    { class: "tools" },
    undo,
    redo,
    add,
    remove,
    h("span", {}, h("label", { for: "snap" }, t("snap")), snap),
  );

  function renew(): void {
    buttons.forEach((button) => button.setAttribute("aria-pressed", String(button.dataset.name === (example() || (example() === "" ? lesson.examples[0]!.name : undefined)))));
    undo.disabled = !player.canUndo;
    redo.disabled = !player.canRedo;
    const input = player.run?.input;
    const isPlane = input !== undefined && ("figure" in input || "faces" in input);
    add.hidden = remove.hidden = !isPlane;
    snap.parentElement!.hidden = !isPlane;
    if (input && document.activeElement !== numbers) numbers.value = compact(input);
    // A field that has the focus keeps it.
    if (!choices.contains(document.activeElement)) {
      choices.replaceChildren(
        ...[choose("operation", player.choices.operations), choose("rule", player.choices.rules)].filter((part) => part !== null),
      );
    }
  }
  function frame(): void {
    const input = player.run?.input;
    const seen = player.frame?.map.input != null;
    if (!seen && hint.textContent === "") byNumbers.open = true;
    hint.textContent = !seen ? t("numbersHint") : input && "grid" in input ? t("gridHint") : t("dragHint");
    const known = [...snap.options].some((option) => Number(option.value) === stage.snap);
    if (!known) snap.append(h("option", { value: stage.snap }, String(stage.snap)));
    snap.value = String(stage.snap);
  }
  player.addEventListener("run", renew);
  player.addEventListener("frame", frame);
  stage.onchoose = () => {
    remove.disabled = stage.chosen === undefined || stage.chosen.part === "window" || stage.chosen.part === "seed";
  };
  remove.disabled = true;

  return h(
    "div",
    { class: "panel" },
    h("p", { class: "takes" }, h("strong", {}, `${t("takes")}: `), of(lesson.takes), "."),
    h("div", { class: "examples", role: "group", "aria-label": t("examples") }, ...buttons),
    choices,
    byFormula,
    tools,
    sketch.element,
    hint,
    h("div", { class: "file" }, h("label", { for: "file", class: "button" }, t("open")), picker, h("span", { class: "hint" }, t("openHint"))),
    byNumbers,
  );
}

/** JSON with a list of points per line. */
function compact(input: Input): string {
  return JSON.stringify(input, (_, value: unknown) => (typeof value === "number" ? Number(value.toFixed(6)) : value))
    .replaceAll(/\],\[\[/g, "],\n  [[")
    .replaceAll(/,"/g, ',\n "');
}
