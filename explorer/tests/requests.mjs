// Prints requests whose answers are compared: the list of a module, runs of all its lessons, and drawings and texts of their frames.

import { load } from "./engine.mjs";

const answer = await load(process.argv[2]);
const { families } = JSON.parse(new TextDecoder().decode(answer(JSON.stringify({ do: "lessons" })).bytes));
// A quick comparison has the first lessons of each family, and no list: the other side has all families.
const most = Number(process.argv[3] ?? Infinity);
const lessons = families.flatMap((family) => family.lessons.slice(0, most));

if (most === Infinity) console.log(JSON.stringify({ do: "lessons" }));
lessons.forEach(({ name, examples }, handle) => {
  console.log(JSON.stringify({ do: "run", name, input: { example: examples[0].name }, cap: 400, choices: true }));
  for (const [step, language] of [[0, "en"], [1, "de"], [2, "en"]]) {
    console.log(JSON.stringify({ do: "frame", handle, step, language, longest: 460 }));
  }
  console.log(JSON.stringify({ do: "captions", handle, first: 0, count: 400, language: "de" }));
  console.log(JSON.stringify({ do: "tikz", handle, step: 1, language: "en" }));
});
// Programs with faults, on the runs' next numbers.
lessons.filter(({ faults }) => faults.length > 3).forEach(({ name }, index) => {
  console.log(JSON.stringify({ do: "run", name, input: { example: "" }, cap: 400, fault: 3 }));
  console.log(JSON.stringify({ do: "frame", handle: lessons.length + index, step: 1, language: "en", longest: 460 }));
});
