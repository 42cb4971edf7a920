// A run of one algorithm on one input, and the step that is shown.

import { engine, Refused, Trapped } from "./engine";
import type { Frame, Input, Lesson, Run } from "./types";
import { language, t } from "./words";

/** The most steps that a page asks for, and while a vertex is dragged. */
const CAP = 100_000;
const DRAGGED = 2_000;
/** Frames that are kept, and those that are made ahead. */
const KEPT = 400;
const AHEAD = 3;

/** Input with the choices that belong to it; a state of the undo list. */
export interface Setup {
  input: Input;
  operation: string;
  rule: string;
}

export class Player extends EventTarget {
  run: Run | undefined;
  frame: Frame | undefined;
  step = 0;
  error = "";
  setup: Setup;
  choices = { operations: [] as string[], rules: [] as string[] };
  /** Longer side of drawings in pixels. */
  longest = 460;

  private frames = new Map<number, Frame>();
  private generation = 0;
  private wanted = 0;
  private running = false;
  private later: { setup: Setup; step: number; cap: number } | undefined;
  private undos: Setup[] = [];
  private redos: Setup[] = [];

  constructor(
    readonly lesson: Lesson,
    setup: Setup,
    step: number,
  ) {
    super();
    this.setup = setup;
    this.step = step;
  }

  get steps(): number {
    return this.run?.steps ?? 0;
  }

  get canUndo(): boolean {
    return this.undos.length > 0;
  }

  get canRedo(): boolean {
    return this.redos.length > 0;
  }

  private tell(name: "run" | "frame" | "error"): void {
    this.dispatchEvent(new Event(name));
  }

  /** Runs the algorithm; while one run is on its way only the latest further one is kept. */
  async start(setup: Setup, step = this.step, cap = CAP): Promise<void> {
    this.setup = setup;
    if (this.running) {
      this.later = { setup, step, cap };
      return;
    }
    this.running = true;
    try {
      await this.take(setup, step, cap);
    } finally {
      this.running = false;
      const { later } = this;
      this.later = undefined;
      if (later) await this.start(later.setup, later.step, later.cap);
    }
  }

  private async take(setup: Setup, step: number, cap: number): Promise<void> {
    const { input, operation, rule } = setup;
    try {
      const choices = this.run === undefined;
      const run = await engine.run({ name: this.lesson.name, input, operation, rule, cap, choices });
      if (run.steps === 0) throw new Refused(t("noState"));
      const old = this.run;
      const [before, after] = [this.generation, engine.generation];
      this.run = run;
      this.generation = after;
      if (run.choices) this.choices = run.choices;
      this.frames.clear();
      if (old && before === after) engine.drop(old.handle);
      this.error = "";
      this.step = Math.min(step, run.steps - 1);
      this.tell("run");
      await this.show();
    } catch (e) {
      if (!(e instanceof Refused || e instanceof Trapped)) throw e;
      this.error = e instanceof Trapped ? t("restarted") : e.message;
      this.tell("error");
    }
  }

  /** Goes to a step, counted from 0. */
  go(step: number): void {
    if (!this.run) return;
    this.step = Math.max(0, Math.min(step, this.steps - 1));
    void this.show();
  }

  /** Makes the frames anew, in another size or language. */
  refresh(): void {
    this.frames.clear();
    void this.show();
  }

  private async show(): Promise<void> {
    const { run } = this;
    if (!run) return;
    const ticket = ++this.wanted;
    const { step } = this;
    try {
      const frame = await this.frameAt(step);
      // Meanwhile another one may be wanted.
      if (ticket !== this.wanted || run !== this.run) return;
      this.frame = frame;
      this.tell("frame");
      for (let ahead = 1; ahead <= AHEAD; ahead++) {
        if (step + ahead < run.steps && ticket === this.wanted) await this.frameAt(step + ahead);
      }
    } catch (e) {
      if (e instanceof Trapped) {
        // The run is gone with its engine.
        if (run === this.run) void this.start(this.setup, step);
      } else if (!(e instanceof Refused)) throw e;
    }
  }

  private async frameAt(step: number): Promise<Frame> {
    const known = this.frames.get(step);
    if (known) return known;
    const { run, longest } = this;
    const frame = await engine.frame(run!.handle, step, language(), longest);
    if (run === this.run && longest === this.longest) {
      if (this.frames.size >= KEPT) this.frames.clear();
      this.frames.set(step, frame);
    }
    return frame;
  }

  /** Runs on an input that is still being dragged: fewer steps, at once. */
  preview(input: Input): void {
    void this.start({ ...this.setup, input }, Math.min(this.step, DRAGGED - 1), DRAGGED);
  }

  /** Changes the input, so that it can be undone. */
  change(setup: Setup, before = this.setup, step = this.step): void {
    this.undos.push(before);
    this.redos = [];
    void this.start(setup, step);
  }

  /** Goes to the first step of an example. */
  load(example: string): void {
    this.change({ ...this.setup, input: { example } }, this.setup, 0);
  }

  undo(): void {
    const before = this.undos.pop();
    if (!before) return;
    this.redos.push(this.setup);
    void this.start(before);
  }

  redo(): void {
    const after = this.redos.pop();
    if (!after) return;
    this.undos.push(this.setup);
    void this.start(after);
  }

  /** Returns the kind of a step. */
  kind(step: number): string {
    const template = this.run?.templates[step] ?? -1;
    return this.lesson.templates[template]?.kind ?? "more";
  }

  /** Returns the next step, or the one before, that satisfies a condition; −1 if there is none. */
  find(direction: 1 | -1, wanted: (step: number) => boolean): number {
    for (let step = this.step + direction; step >= 0 && step < this.steps; step += direction) {
      if (wanted(step)) return step;
    }
    return -1;
  }

  /** Returns the number of steps of each kind. */
  counts(): Map<string, number> {
    const counts = new Map<string, number>();
    for (let step = 0; step < this.steps; step++) {
      const kind = this.kind(step);
      counts.set(kind, (counts.get(kind) ?? 0) + 1);
    }
    return counts;
  }

  close(): void {
    if (this.run) engine.drop(this.run.handle);
    this.run = undefined;
  }
}

/** Returns the kinds of a lesson's steps, each once. */
export function kindsOf(lesson: Lesson): string[] {
  return [...new Set(lesson.templates.map((template) => template.kind))];
}
