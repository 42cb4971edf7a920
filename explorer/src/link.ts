// The address of a view: everything after `#`, so that any server and any folder will do.

import type { Input, Language } from "./types";

export interface Address {
  /** Name of the lesson; pages other than lessons have `page`. */
  a?: string;
  page?: string;
  /** Example, or an own input, packed. */
  ex?: string;
  in?: string;
  /** Step, counted from 1. */
  step?: number;
  op?: string;
  rule?: string;
  /** Number of a fault to find, counted from 1. */
  bug?: number;
  /** What the quiz asks for, where the page begins with it. */
  ask?: string;
  lang?: Language;
  /** Other algorithms to compare with. */
  with?: string[];
  track?: string;
  /** Place in the track, counted from 1. */
  at?: number;
  embed?: boolean;
}

export function parse(hash: string): Address {
  const values = new URLSearchParams(hash.replace(/^#/, ""));
  const number = (name: string): number | undefined => {
    const value = Number(values.get(name) ?? NaN);
    return Number.isInteger(value) && value > 0 ? value : undefined;
  };
  const text = (name: string): string | undefined => values.get(name) || undefined;
  const lang = text("lang");
  return {
    a: text("a"),
    page: text("page"),
    ex: text("ex"),
    in: text("in"),
    step: number("step"),
    op: text("op"),
    rule: text("rule"),
    bug: number("bug"),
    ask: text("ask"),
    lang: lang === "de" || lang === "en" ? lang : undefined,
    with: text("with")?.split(",").slice(0, 2),
    track: text("track"),
    at: number("at"),
    embed: values.has("embed") || new URLSearchParams(location.search).has("embed"),
  };
}

export function format(address: Address): string {
  const values = new URLSearchParams();
  for (const [name, value] of Object.entries(address)) {
    if (value === undefined || value === false || value === "") continue;
    values.set(name, value === true ? "1" : Array.isArray(value) ? value.join(",") : String(value));
  }
  return `#${values.toString()}`;
}

/** Numbers with few digits, as drags give them. */
function short(_: string, value: unknown): unknown {
  return typeof value === "number" ? Number(value.toPrecision(9)) : value;
}

async function through(bytes: Uint8Array, stream: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  const piped = new Blob([bytes as BlobPart]).stream().pipeThrough(stream as unknown as TransformStream<Uint8Array, Uint8Array>);
  return new Uint8Array(await new Response(piped).arrayBuffer());
}

/** Packs an input for an address. */
export async function pack(input: Input): Promise<string> {
  const bytes = await through(new TextEncoder().encode(JSON.stringify(input, short)), new CompressionStream("deflate-raw"));
  const letters = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  return btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** Unpacks an input; the engine checks its contents. */
export async function unpack(text: string): Promise<Input> {
  const letters = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
  const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
  const value: unknown = JSON.parse(new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw"))));
  if (typeof value !== "object" || value === null) throw new Error("not an input");
  return value as Input;
}
