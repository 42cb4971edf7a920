// Copies of the step that is shown: as a link, a picture, code.

import { h } from "./dom";
import { engine } from "./engine";
import { format, type Address } from "./link";
import type { Player } from "./player";
import type { Figure, Input, Point } from "./types";
import { language, t, type WordName } from "./words";

const number = (value: number): string => String(Number(value.toFixed(9)));
const float = (value: number): string => (Number.isInteger(value) ? `${value}.0` : number(value));

/** Returns the input as a file that the command reads, if it is one of the plane. */
function geojson(figure: Figure): string {
  const closed = (ring: Point[]): Point[] => [...ring, ring[0]!];
  const feature = (type: string, coordinates: unknown): object => ({ type: "Feature", properties: {}, geometry: { type, coordinates } });
  const features = [
    ...(figure.rings?.length ? [feature("Polygon", figure.rings.map(closed))] : []),
    ...(figure.clip?.length ? [feature("Polygon", figure.clip.map(closed))] : []),
    ...(figure.lines ?? []).map((line) => feature("LineString", line)),
    ...(figure.points ?? []).map((point) => feature("Point", point)),
  ];
  return JSON.stringify({ type: "FeatureCollection", features });
}

/** Returns an OFF file of faces; `durer explain` sees models obliquely, so it is for other programs. */
function command(player: Player): string {
  const { lesson, setup, run } = player;
  const options = [
    setup.operation ? `--operation ${setup.operation}` : "",
    setup.rule ? `--fill-rule ${setup.rule}` : "",
    language() === "de" ? "--lang de" : "",
  ].filter((part) => part !== "");
  const more = options.length > 0 ? ` ${options.join(" ")}` : "";
  const example = "example" in setup.input ? setup.input.example || lesson.examples[0]!.name : undefined;
  if (example) return `durer explain ${lesson.name} --example ${example} --step ${player.step + 1}${more} -o step.svg`;
  const input = run?.input;
  if (input && "figure" in input) {
    const { window } = input.figure;
    const bounds = window ? ` --window=${window.map(number).join(",")}` : "";
    return `durer explain ${lesson.name} -${bounds} --step ${player.step + 1}${more} -o step.svg <<'END'\n${geojson(input.figure)}\nEND`;
  }
  return `# ${lesson.name}: ${JSON.stringify(input)}`;
}

function points(list: number[][], type: string): string {
  return `vec![${list.map((p) => `${type}::new(${p.map(float).join(", ")})`).join(", ")}]`;
}

function rustInput(input: Input): string {
  if ("figure" in input) {
    const { window, lines, rings, clip, points: alone } = input.figure;
    const nested = (lists: Point[][]): string => `vec![${lists.map((list) => points(list, "DVec2")).join(", ")}]`;
    const parts = [
      window ? `window: Some(Rect::new(DVec2::new(${float(window[0])}, ${float(window[1])}), DVec2::new(${float(window[2])}, ${float(window[3])}))?)` : "",
      lines?.length ? `lines: ${nested(lines)}` : "",
      rings?.length ? `rings: ${nested(rings)}` : "",
      clip?.length ? `clip: ${nested(clip)}` : "",
      alone?.length ? `points: ${points(alone, "DVec2")}` : "",
      "..Default::default()",
    ];
    return `Input::Figure(Figure {\n    ${parts.filter((part) => part !== "").join(",\n    ")}\n})`;
  }
  if ("faces" in input) return `Input::Faces(vec![\n    ${input.faces.map((face) => points(face, "DVec3")).join(",\n    ")}\n])`;
  if ("clip" in input) return `Input::ClipSpace(${points(input.clip, "DVec4")})`;
  if ("grid" in input) {
    const { columns, cells, seed } = input.grid;
    return `Input::Grid(Grid { columns: ${columns}, cells: vec!${JSON.stringify(cells)}, seed: ${JSON.stringify(seed)} })`;
  }
  return `Input::Example("${input.example}".into())`;
}

/** Returns a name in kebab case as Rust writes variants. */
function variant(name: string): string {
  return name.replace(/(?:^|-)([a-z])/g, (_, letter: string) => letter.toUpperCase());
}

function rust(player: Player): string {
  const { lesson, setup } = player;
  const given: Input = "example" in setup.input ? { example: setup.input.example || lesson.examples[0]!.name } : player.run!.input;
  const input = rustInput(given);
  const chosen = [
    setup.operation ? `operation: BooleanOp::${variant(setup.operation)}` : "",
    setup.rule ? `rule: FillRule::${variant(setup.rule)}` : "",
  ].filter((part) => part !== "");
  const options = chosen.length > 0 ? `Options { ${chosen.join(", ")}, ..Default::default() }` : "Default::default()";
  const text = `${input} ${options}`;
  const used = (path: string, names: string[]): string => {
    const found = names.filter((name) => new RegExp(`\\b${name}\\b`).test(text) || name === "Language");
    return found.length > 0 ? `use durer::${path}::{${found.join(", ")}};` : "";
  };
  return [
    used("clip::polygon", ["BooleanOp", "FillRule"]),
    used("explain", ["Figure", "Grid", "Input", "Language", "Options"]),
    used("math", ["DVec2", "DVec3", "DVec4", "Rect"]),
    "",
    `let input = ${input};`,
    `let frames = durer::explain::run("${lesson.name}", &input, &${options}, 1_000)?;`,
    `println!("{}", frames[${player.step}].text(Language::${language() === "de" ? "German" : "English"}));`,
  ]
    .filter((line, index) => line !== "" || index === 3)
    .join("\n");
}

export function sharePanel(player: Player, address: () => Promise<Address>, notice: (text: string) => void): HTMLElement {
  const here = (): string => location.href.replace(/#.*$/, "");
  const link = async (): Promise<string> => here() + format(await address());
  const ways: [WordName, () => Promise<string>][] = [
    ["copyLink", link],
    ["copyFrame", async () => `<iframe src="${here() + format({ ...(await address()), embed: true })}" width="640" height="560" title="${player.lesson.title}"></iframe>`],
    ["copySvg", () => Promise.resolve(player.frame?.svg ?? "")],
    ["copyTikz", () => engine.tikz(player.run!.handle, player.step, language())],
    ["copyRust", () => Promise.resolve(rust(player))],
    ["copyCommand", () => Promise.resolve(command(player))],
  ];
  const shown = h("textarea", { rows: 5, readonly: true, hidden: true, "aria-label": t("share") });
  async function copy(name: WordName, make: () => Promise<string>): Promise<void> {
    const text = await make();
    shown.value = text;
    shown.hidden = false;
    try {
      await navigator.clipboard.writeText(text);
      notice(`${t("copied")}: ${t(name)}`);
    } catch {
      // Pages without permission show the text, chosen.
      shown.select();
    }
  }
  return h(
    "div",
    { class: "panel" },
    h("p", { class: "hint" }, t("shareHint")),
    h("div", { class: "tools" }, ...ways.map(([name, make]) => h("button", { type: "button", "data-copy": name, onclick: () => void copy(name, make) }, t(name)))),
    shown,
  );
}
