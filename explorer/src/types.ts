// Types of the engine's answers, which crates/durer-wasm makes.

export type Language = "en" | "de";
export type Words = Record<Language, string>;

export interface Example {
  name: string;
  title: Words;
}

export interface Template {
  kind: string;
  /** Name of the kind. */
  name: Words;
  text: Words;
}

export interface Lesson {
  name: string;
  title: Words;
  authors: string;
  year: number;
  source: string;
  class: string;
  occluder: string;
  coherence: string[];
  cost: string;
  limits: string;
  pseudocode: string[];
  takes: Words;
  examples: Example[];
  /** Lines that the lesson's program can get wrong, and how. */
  faults: { line: number; wrong: string }[];
  templates: Template[];
  /** File of the module that runs it. */
  module: string;
}

export interface Family {
  title: Words;
  lessons: Lesson[];
}

export type Point = [number, number];

export interface Figure {
  window?: [number, number, number, number];
  lines?: Point[][];
  rings?: Point[][];
  clip?: Point[][];
  points?: Point[];
}

export interface Grid {
  columns: number;
  cells: number[];
  seed: [number, number];
}

export type Input =
  | { example: string }
  | { figure: Figure }
  | { faces: [number, number, number][][] }
  | { clip: [number, number, number, number][] }
  | { grid: Grid };

export interface Run {
  handle: number;
  steps: number;
  /** Line of the pseudocode of each step, counted from 1. */
  lines: number[];
  /** Number of each step's template in the lesson; −1 for the last one of a run that was cut off. */
  templates: number[];
  input: Input;
  choices?: { operations: string[]; rules: string[] };
}

export interface Cell {
  text: string;
  changed: boolean;
}

export interface Table {
  heads: string[];
  rows: { name: string; cells: Cell[] }[];
}

export interface Place {
  min: Point;
  max: Point;
  down: boolean;
  /** Columns of the map from points of the input to the picture. */
  input: [number, number, number, number, number, number] | null;
}

/** A mark that a step is about, in the coordinates of its picture. */
export type Target = { pixel: Point } | { point: Point } | { line: Point[] } | { area: Point[][] };

export interface Frame {
  frame: { line: number; kind: string; caption: string; values: Record<string, unknown>; table: Table };
  svg: string;
  map: Place;
  targets: Target[];
  /** Longer side of the drawing in pixels. */
  longest: number;
}

export interface RunRequest {
  name: string;
  input: Input;
  operation?: string;
  rule?: string;
  fault?: number;
  cap: number;
  choices?: boolean;
}
