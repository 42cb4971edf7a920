// Requests to the module: a text in JSON, and for some a zero byte with a file after it.

/** Functions that a module imports and never calls: reading compressed files brings a source of random numbers along. */
function unused(module) {
  const imports = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    (imports[from] ??= {})[name] = () => {
      throw new Error(`${from}.${name} is missing`);
    };
  }
  return imports;
}

/** Returns the functions of the package over a compiled module. */
export function over(module) {
  let engine;

  function answer(request, file) {
    // A trap leaves the engine in an unknown state: the next request starts another one.
    const { exports } = (engine ??= new WebAssembly.Instance(module, unused(module)));
    const text = new TextEncoder().encode(JSON.stringify(request));
    const length = text.length + (file ? 1 + file.length : 0);
    try {
      const at = exports.durer_request(length);
      if (at === 0) throw new Error("the model does not fit the memory of the module");
      const memory = new Uint8Array(exports.memory.buffer, at, length);
      memory.set(text);
      if (file) memory.set(file, text.length + 1);
      const kind = exports.durer_answer();
      // A copy: the buffer belongs to the engine, and moves when its memory grows.
      const bytes = new Uint8Array(exports.memory.buffer, exports.durer_result(), exports.durer_result_length()).slice();
      return { kind, bytes };
    } catch (error) {
      engine = undefined;
      throw error;
    }
  }

  function value({ kind, bytes }) {
    const found = JSON.parse(new TextDecoder().decode(bytes));
    if (kind === 2) throw new Error(found.error);
    return found;
  }

  return {
    render(model, options = {}) {
      const { name = "model", width = 640, height = 480, azimuth = 30, elevation = 20, method = "z-buffer", ...others } = options;
      const file = model instanceof Uint8Array ? model : new Uint8Array(model);
      const answered = answer({ do: "render", name, method, width, height, azimuth, elevation, ...others }, file);
      return answered.kind === 1 ? answered.bytes : value(answered);
    },
    methods: () => value(answer({ do: "methods" })).methods,
  };
}
