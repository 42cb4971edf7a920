// The engine's thread: requests come in as messages, one after the other, and answers go out.

/// <reference lib="webworker" />

interface Exports {
  memory: WebAssembly.Memory;
  durer_request(length: number): number;
  durer_answer(): number;
  durer_result(): number;
  durer_result_length(): number;
}

interface Asked {
  id: number;
  request: object;
  file?: ArrayBuffer;
}

let engine: Promise<Exports> | undefined;

/** Functions that a module imports but never calls: the reader of compressed files depends on a source of random numbers. */
function unused(module: WebAssembly.Module): WebAssembly.Imports {
  const imports: Record<string, Record<string, () => never>> = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    (imports[from] ??= {})[name] = () => {
      throw new Error(`${from}.${name} is not there`);
    };
  }
  return imports;
}

async function load(url: string): Promise<Exports> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  // Many servers send the wrong content type for modules: then the bytes are compiled.
  const bytes = await response.arrayBuffer();
  const module = await WebAssembly.compile(bytes);
  const instance = await WebAssembly.instantiate(module, unused(module));
  return instance.exports as unknown as Exports;
}

function answer(engine: Exports, { request, file }: Asked): { kind: number; bytes: Uint8Array } {
  const text = new TextEncoder().encode(JSON.stringify(request));
  const length = text.length + (file ? 1 + file.byteLength : 0);
  const at = engine.durer_request(length);
  if (at === 0) throw new Error("the engine is out of memory");
  const memory = new Uint8Array(engine.memory.buffer, at, length);
  memory.set(text);
  if (file) {
    memory[text.length] = 0;
    memory.set(new Uint8Array(file), text.length + 1);
  }
  const kind = engine.durer_answer();
  const start = engine.durer_result();
  // A copy: the buffer is the engine's, and moves when its memory grows.
  return { kind, bytes: new Uint8Array(engine.memory.buffer, start, engine.durer_result_length()).slice() };
}

self.onmessage = async (event: MessageEvent<Asked | { url: string }>) => {
  const request = event.data;
  if ("url" in request) {
    engine = load(request.url);
    engine.catch((e: unknown) => self.postMessage({ id: 0, failed: String(e) }));
    return;
  }
  try {
    const { kind, bytes } = answer(await engine!, request);
    if (kind === 1) {
      self.postMessage({ id: request.id, bytes }, { transfer: [bytes.buffer] });
    } else {
      const value: unknown = JSON.parse(new TextDecoder().decode(bytes));
      self.postMessage({ id: request.id, value, refused: kind === 2 });
    }
  } catch (e) {
    // A trap leaves the engine in an unknown state: the page starts another one.
    self.postMessage({ id: request.id, trapped: String(e) });
  }
};
