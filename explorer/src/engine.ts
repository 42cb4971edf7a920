// The engine as the pages use it: promises of answers. After a trap a new engine is started, and owners of runs start them again.

import type { Family, Frame, Input, Language, Lesson, Run, RunRequest } from "./types";
import { rooted } from "./root";
import EngineWorker from "./worker?worker";

/** A request that the engine refused, in its words. */
export class Refused extends Error {}
/** A request that stopped the engine. */
export class Trapped extends Error {}
/** A request to an engine whose module could not be loaded. */
export class Unloaded extends Trapped {}

interface Waiting {
  resolve(value: unknown): void;
  reject(reason: Error): void;
}

interface Reply {
  id: number;
  value?: unknown;
  bytes?: Uint8Array;
  refused?: boolean;
  trapped?: string;
  failed?: string;
}

export class Engine {
  private worker: Worker | undefined;
  private waiting = new Map<number, Waiting>();
  private next = 1;
  /** Counts engines, to recognize runs of a previous one. */
  generation = 0;
  /** Called after an engine was restarted. */
  onrestart: (() => void) | undefined;

  constructor(readonly module: string) {}

  private start(): Worker {
    const worker = new EngineWorker();
    worker.onmessage = (event: MessageEvent<Reply>) => this.take(event.data);
    worker.onerror = (event) => this.restart(new Unloaded(event.message || this.module));
    worker.postMessage({ url: rooted(this.module) });
    return worker;
  }

  private take(reply: Reply): void {
    if (reply.failed !== undefined) return this.restart(new Unloaded(reply.failed));
    const waiting = this.waiting.get(reply.id);
    this.waiting.delete(reply.id);
    if (reply.trapped !== undefined) {
      waiting?.reject(new Trapped(reply.trapped));
      return this.restart(new Trapped(reply.trapped));
    }
    if (reply.refused) waiting?.reject(new Refused((reply.value as { error: string }).error));
    else waiting?.resolve(reply.bytes ?? reply.value);
  }

  private restart(reason: Trapped): void {
    this.worker?.terminate();
    this.worker = undefined;
    this.generation += 1;
    const all = [...this.waiting.values()];
    this.waiting.clear();
    all.forEach((waiting) => waiting.reject(reason));
    this.onrestart?.();
  }

  ask<T>(request: object, file?: ArrayBuffer): Promise<T> {
    this.worker ??= this.start();
    const id = this.next++;
    const answer = new Promise<T>((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (value: unknown) => void, reject });
    });
    this.worker.postMessage({ id, request, file }, file ? [file] : []);
    return answer;
  }

  run(request: RunRequest): Promise<Run> {
    return this.ask({ do: "run", ...request });
  }

  async frame(handle: number, step: number, language: Language, longest: number): Promise<Frame> {
    return { ...(await this.ask<Frame>({ do: "frame", handle, step, language, longest })), longest };
  }

  async captions(handle: number, first: number, count: number, language: Language): Promise<string[]> {
    return (await this.ask<{ captions: string[] }>({ do: "captions", handle, first, count, language })).captions;
  }

  async tikz(handle: number, step: number, language: Language): Promise<string> {
    return (await this.ask<{ tikz: string }>({ do: "tikz", handle, step, language })).tikz;
  }

  /** Ends the engine and all of its work. */
  stop(): void {
    if (this.worker) this.restart(new Trapped("stopped"));
  }

  drop(handle: number): void {
    void this.ask({ do: "drop", handle }).catch(() => undefined);
  }
}

/** Engines of lessons by their modules: in the plane, in space, and of visibility; each is loaded at its first use. */
const engines = new Map<string, Engine>();

/** Returns the engine that has a lesson. */
export function engineOf(lesson: Lesson): Engine {
  const { module } = lesson;
  const engine = engines.get(module) ?? new Engine(module);
  engines.set(module, engine);
  return engine;
}

/** Returns the families of lessons: a list that is made from the modules when the pages are built. */
export async function lessons(): Promise<Family[]> {
  const response = await fetch(rooted("lessons.json"));
  if (!response.ok) throw new Error(`lessons.json: ${response.status} ${response.statusText}`);
  const { families } = (await response.json()) as { families: Family[] };
  return families;
}

/** The engine that reads files and renders models; it is larger, and loaded at its first use. */
export const files = new Engine("durer-files.wasm");

/** A file as an input, and what was left out of it. */
export interface Opened {
  input: Input;
  warnings: string[];
}
