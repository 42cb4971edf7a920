// Makes the list of lessons of modules: node lessons.mjs MODULE… > lessons.json. Each lesson has the file's name of its module.

import { basename } from "node:path";
import { load } from "./engine.mjs";

const families = [];
let version = "";
for (const path of process.argv.slice(2)) {
  const answer = await load(path);
  const list = JSON.parse(new TextDecoder().decode(answer(JSON.stringify({ do: "lessons" })).bytes));
  version = list.version;
  for (const { title, lessons } of list.families) {
    families.push({ title, lessons: lessons.map((lesson) => ({ ...lesson, module: basename(path) })) });
  }
}
console.log(JSON.stringify({ version, families }));
