// A run of one algorithm on one input, and the step that is shown.

import { Engine, engineOf, Refused, Trapped, Unloaded } from "./engine";
import type { Frame, Input, Lesson, Run, RunRequest } from "./types";
import { language, of, t } from "./words";

/** Largest number of steps of a page, number shown before the rest arrives, and largest number while a vertex is dragged. */
const CAP = 100_000;
const FIRST = 4_000;
const DRAGGED = 2_000;
/** Number of frames kept, and number made ahead. */
const KEPT = 400;
const AHEAD = 3;

/** Input with the choices that belong to it; a state of the undo list. */
export interface Setup {
  input: Input;
  operation: string;
  rule: string;
  /** Number of the fault of the lesson's program that runs in place of the library's function. */
  fault?: number;
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

  /** Numbers of steps of each kind, once they are counted. */
  private known: Map<string, number> | undefined;
  /** The engine of the run: a separate one for a run of many steps, which takes longer. */
  engine: Engine;
  /** The engine shared by all pages of such lessons. */
  private shared: Engine;
  private patient: Engine;
  private frames = new Map<number, Frame>();
  private generation = 0;
  /** True while a frame is being made, and if another one is wanted after it. */
  private fetching = false;
  private late = false;
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
    this.shared = this.engine = engineOf(lesson);
    this.patient = new Engine(this.shared.module);
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

  /** Runs the algorithm; during a run, only the latest further request is kept. */
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
    const { input, operation, rule, fault } = setup;
    try {
      const choices = this.run === undefined;
      const request = { name: this.lesson.name, input, operation, rule, fault };
      // Pending work for the last input is useless now.
      this.patient.stop();
      const run = await this.shared.run({ ...request, cap: Math.min(cap, FIRST), choices });
      if (run.steps === 0) throw new Refused(t("noState"));
      if (run.choices) this.choices = run.choices;
      this.error = "";
      this.replace(run, this.shared, step);
      if (cap > FIRST && run.templates.at(-1)! < 0) void this.extend({ ...request, cap }, run, step);
      await this.show();
    } catch (e) {
      if (!(e instanceof Refused || e instanceof Trapped)) throw e;
      if (e instanceof Unloaded) this.error = `${t("failed")}: ${e.message}`;
      else this.error = e instanceof Trapped ? t("restarted") : e.message;
      this.tell("error");
    }
  }

  private replace(run: Run, host: Engine, step: number): void {
    const old = this.run;
    if (old && this.engine === this.shared && this.generation === this.shared.generation) this.shared.drop(old.handle);
    this.run = run;
    this.known = undefined;
    this.engine = host;
    this.generation = this.shared.generation;
    this.frames.clear();
    this.step = Math.min(step, run.steps - 1);
    this.tell("run");
  }

  /** Runs all steps in a separate engine, while the first ones can already be viewed. */
  private async extend(request: RunRequest, first: Run, step: number): Promise<void> {
    try {
      const run = await this.patient.run(request);
      if (this.run !== first) return;
      // A user who has moved to another step stays there.
      this.replace(run, this.patient, this.step === first.steps - 1 ? step : this.step);
      await this.show();
    } catch (e) {
      // The first steps stay.
      if (!(e instanceof Refused || e instanceof Trapped)) throw e;
    }
  }

  /** Goes to a step, counted from 0. */
  go(step: number): void {
    if (!this.run) return;
    this.step = Math.max(0, Math.min(step, this.steps - 1));
    void this.show();
  }

  /** Makes the frames again, in another size or language. */
  refresh(): void {
    this.frames.clear();
    void this.show();
  }

  private present(frame: Frame): void {
    this.frame = frame;
    this.tell("frame");
  }

  private async show(): Promise<void> {
    const known = this.frames.get(this.step);
    if (known) this.present(known);
    else await this.fetch();
    await this.lookAhead();
  }

  /** Requests the frame of the step, one at a time, so that a scrubber never waits for frames that it has passed. */
  private async fetch(): Promise<void> {
    this.late = true;
    if (this.fetching) return;
    this.fetching = true;
    while (this.late && this.run) {
      this.late = false;
      const { run, step } = this;
      try {
        const frame = await this.frameAt(step);
        // While the scrubber moves on, frames are shown as they come.
        if (run === this.run && (step === this.step || !this.frames.has(this.step))) this.present(frame);
      } catch (e) {
        if (!(e instanceof Refused || e instanceof Trapped)) this.fetching = false;
        this.failed(e, run, step);
      }
    }
    this.fetching = false;
  }

  /** Requests the frames of the next steps. */
  private async lookAhead(): Promise<void> {
    const { run, step } = this;
    for (let ahead = 1; ahead <= AHEAD; ahead++) {
      if (!run || run !== this.run || step !== this.step || step + ahead >= run.steps) return;
      try {
        await this.frameAt(step + ahead);
      } catch (e) {
        return this.failed(e, run, step);
      }
    }
  }

  private failed(e: unknown, run: Run | undefined, step: number): void {
    // The run ended with its engine.
    if (e instanceof Trapped && run === this.run) void this.start(this.setup, step);
    else if (!(e instanceof Refused || e instanceof Trapped)) throw e;
  }

  /** Returns the frame of a step. */
  async frameAt(step: number): Promise<Frame> {
    const known = this.frames.get(step);
    if (known) return known;
    const { run, longest } = this;
    if (!run) throw new Refused(t("noState"));
    const frame = await this.engine.frame(run.handle, step, language(), longest);
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
    this.known ??= this.counted();
    return this.known;
  }

  private counted(): Map<string, number> {
    const counts = new Map<string, number>();
    for (let step = 0; step < this.steps; step++) {
      const kind = this.kind(step);
      counts.set(kind, (counts.get(kind) ?? 0) + 1);
    }
    return counts;
  }

  close(): void {
    if (this.run && this.engine === this.shared) this.shared.drop(this.run.handle);
    this.patient.stop();
    this.run = undefined;
  }
}

/** Returns the name of a kind of step. */
export function kindName(lesson: Lesson, kind: string): string {
  const template = lesson.templates.find((own) => own.kind === kind);
  return template ? of(template.name).replaceAll("-", " ") : t("more");
}

/** Returns the kinds of a lesson's steps, each once. */
export function kindsOf(lesson: Lesson): string[] {
  return [...new Set(lesson.templates.map((template) => template.kind))];
}
