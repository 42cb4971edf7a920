// Prints requests whose answers are compared: the list, runs of many families, and drawings and texts of their frames.

const NAMES = [
  "cohen-sutherland",
  "liang-barsky",
  "sutherland-hodgman",
  "weiler-atherton",
  "vatti",
  "bresenham",
  "midpoint-circle",
  "edge-table",
  "naive",
  "gouraud",
  "phong",
  "depth-sort",
  "warnock",
  "watkins",
  "horizon-curves",
];

console.log(JSON.stringify({ do: "lessons" }));
NAMES.forEach((name, handle) => {
  console.log(JSON.stringify({ do: "run", name, input: { example: "" }, cap: 400, choices: true }));
  for (const [step, language] of [[0, "en"], [1, "de"], [2, "en"]]) {
    console.log(JSON.stringify({ do: "frame", handle, step, language, longest: 460 }));
  }
  console.log(JSON.stringify({ do: "captions", handle, first: 0, count: 400, language: "de" }));
  console.log(JSON.stringify({ do: "tikz", handle, step: 1, language: "en" }));
});
