// The list of all algorithms by families.

import { h } from "./dom";
import type { Page } from "./lesson";
import { format } from "./link";
import type { Family, Lesson } from "./types";
import { language, named, of, t } from "./words";

/** Algorithms to start with. */
const STARTS = ["weiler-atherton", "bresenham", "cohen-sutherland", "depth-sort"];

function entry(lesson: Lesson): HTMLElement {
  return h(
    "li",
    { "data-text": `${lesson.name} ${lesson.title.en} ${lesson.title.de} ${lesson.authors}`.toLowerCase() },
    h("a", { href: format({ a: lesson.name, lang: language() }) }, h("strong", {}, of(lesson.title)), h("span", { class: "by" }, `${lesson.authors}, ${lesson.year}`), h("span", { class: "class" }, named(lesson.class))),
  );
}

export function homePage(families: Family[]): Page {
  const all = families.flatMap((family) => family.lessons);
  const find = h("input", { type: "search", id: "find", placeholder: t("find"), "aria-label": t("find"), oninput: () => filter() });
  const nothing = h("p", { class: "hint", hidden: true, role: "status" }, t("nothing"));
  const sections = families.map((family) => h("section", { class: "family" }, h("h2", {}, of(family.title)), h("ul", {}, ...family.lessons.map(entry))));
  function filter(): void {
    const wanted = find.value.trim().toLowerCase().split(/\s+/);
    let left = 0;
    for (const section of sections) {
      let own = 0;
      section.querySelectorAll<HTMLElement>("li").forEach((item) => {
        item.hidden = !wanted.every((word) => item.dataset.text!.includes(word));
        own += item.hidden ? 0 : 1;
      });
      section.hidden = own === 0;
      left += own;
    }
    nothing.hidden = left > 0;
  }
  const starts = STARTS.map((name) => all.find((lesson) => lesson.name === name)).filter((lesson) => lesson !== undefined);
  const element = h(
    "main",
    { id: "content", class: "home", tabindex: -1 },
    h("header", { class: "hero" }, h("h1", {}, "durer explorer"), h("p", { class: "lead" }, t("lead")), h("p", { class: "starts" }, h("span", {}, `${t("start")} `), ...starts.map((lesson) => h("a", { class: "button", href: format({ a: lesson.name, lang: language() }) }, of(lesson.title)))), find),
    nothing,
    h("div", { class: "families" }, ...sections),
  );
  return { element, title: "durer explorer", close: () => undefined };
}
