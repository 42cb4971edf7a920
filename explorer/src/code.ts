// The run as code: a Rust program, a Python call, a command line.

import type { Player } from "./player";
import type { Figure, Input, Point } from "./types";
import { language } from "./words";

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

/** Returns a command line that makes the picture of the step. */
export function command(player: Player): string {
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

/** Returns Rust code that prints the sentence of the step. */
export function rust(player: Player): string {
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


/** Returns points as Python has them. */
function list(points: number[][]): string {
  return `[${points.map((p) => `[${p.map(number).join(", ")}]`).join(", ")}]`;
}

/** Returns the arguments of `durer.trace` that give an input; undefined for one that it does not take. */
function pythonInput(input: Input): string[] | undefined {
  if ("example" in input) return [`example="${input.example}"`];
  if ("faces" in input) return input.faces.map(list);
  if ("grid" in input) {
    const { columns, cells, seed } = input.grid;
    return [`np.array(${JSON.stringify(cells)}, np.uint8).reshape(-1, ${columns})`, `seed=(${seed.join(", ")})`];
  }
  if (!("figure" in input)) return undefined;
  const { window, lines, rings, clip, points } = input.figure;
  const closed = (ring: Point[]): string => list([...ring, ring[0]!]);
  return [
    ...(lines ?? []).map(list),
    ...(rings ?? []).filter((ring) => ring.length > 2).map(closed),
    window ? `window=(${window.map(number).join(", ")})` : "",
    clip?.length ? `clip=[${clip.map(closed).join(", ")}]` : "",
    points?.length ? `points=${list(points)}` : "",
  ].filter((part) => part !== "");
}

/** Returns Python code that prints the sentence of the step. */
export function python(player: Player): string {
  const { lesson, setup } = player;
  const given: Input = "example" in setup.input ? { example: setup.input.example || lesson.examples[0]!.name } : player.run!.input;
  const parts = pythonInput(given);
  if (!parts) return `# durer.trace does not take this input: ${JSON.stringify(given)}`;
  const more = language() === "de" ? ['language="de"'] : [];
  const chosen = [setup.operation, setup.rule].filter((name) => name !== "");
  return [
    ...(chosen.length > 0 ? [`# durer.trace runs with the default operation and rule, not with ${chosen.join(", ")}.`] : []),
    ..."grid" in given ? ["import numpy as np"] : [],
    "import durer",
    "",
    `steps = durer.trace(${[`"${lesson.name}"`, ...parts, ...more].join(", ")})`,
    `print(steps[${player.step}]["caption"])`,
  ].join("\n");
}
