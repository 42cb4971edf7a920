// Finds the page of the address and shows it.

import "./style/base.css";
import "./style/pages.css";
import "./style/lesson.css";
import "./style/panels.css";
import "./style/narrow.css";
import { h } from "./dom";
import { lessons } from "./engine";
import { galleryPage } from "./gallery";
import { homePage } from "./home";
import { lessonPage, type Page } from "./lesson";
import { format, parse, unpack, type Address } from "./link";
import type { Setup } from "./player";
import { rooted } from "./root";
import { teacherPage } from "./teacher";
import { tracksPage } from "./tracks";
import type { Family, Input, Language } from "./types";
import { language, setLanguage, t } from "./words";

const app = document.querySelector<HTMLElement>("#app")!;
let page: Page | undefined;
let families: Family[] | undefined;

function remembered(name: string): string | null {
  // Pages in frames of other sites may have no storage.
  try {
    return localStorage.getItem(name);
  } catch {
    return null;
  }
}

function remember(name: string, value: string): void {
  try {
    localStorage.setItem(name, value);
  } catch {
    // It is chosen again the next time.
  }
}

function preferred(): Language {
  // A page of a language says so; another one follows the last choice, or the browser.
  const known = document.documentElement.dataset.language ?? remembered("language") ?? navigator.language;
  return known.startsWith("de") ? "de" : "en";
}

function theme(value: string | null): void {
  if (value) document.documentElement.dataset.theme = value;
}

function turnTheme(): void {
  const isDark = document.documentElement.dataset.theme
    ? document.documentElement.dataset.theme === "dark"
    : matchMedia("(prefers-color-scheme: dark)").matches;
  const value = isDark ? "light" : "dark";
  remember("theme", value);
  theme(value);
  dispatchEvent(new Event("theme"));
}

function turnLanguage(): void {
  const other = language() === "de" ? "en" : "de";
  remember("language", other);
  go({ ...parse(location.hash), lang: other });
}

function bar(address: Address): HTMLElement {
  const lang = language();
  const link = (to: Address, text: string, isHere: boolean): HTMLElement =>
    h("a", { href: format({ ...to, lang }), "aria-current": isHere ? "page" : undefined }, text);
  return h(
    "header",
    { class: "bar" },
    h("a", { class: "skip", href: "#content", onclick: skip }, t("skip")),
    h("a", { class: "brand", href: format({ lang }) }, h("img", { src: rooted("icon.svg"), alt: "", width: 24, height: 24 }), "durer"),
    h(
      "nav",
      { "aria-label": "durer" },
      link({}, t("algorithms"), !address.page),
      link({ page: "tracks" }, t("tracks"), address.page === "tracks"),
      link({ page: "gallery" }, t("gallery"), address.page === "gallery"),
      link({ page: "teachers" }, t("teachers"), address.page === "teachers"),
    ),
    h(
      "div",
      { class: "settings" },
      h("button", { type: "button", class: "quiet", onclick: turnLanguage, lang: lang === "de" ? "en" : "de" }, t("language")),
      h("button", { type: "button", class: "quiet", onclick: turnTheme, "aria-label": t("theme"), title: t("theme") }, "◐"),
    ),
  );
}

function skip(event: Event): void {
  event.preventDefault();
  document.querySelector<HTMLElement>("#content")?.focus();
}

async function setupOf(address: Address): Promise<{ setup: Setup; notice?: string }> {
  const own = { operation: address.op ?? "", rule: address.rule ?? "", fault: address.bug && address.bug - 1 };
  const example: Input = { example: address.ex ?? "" };
  if (!address.in) return { setup: { input: example, ...own } };
  try {
    return { setup: { input: await unpack(address.in), ...own } };
  } catch {
    return { setup: { input: example, ...own }, notice: t("badInput") };
  }
}

async function pageOf(address: Address, all: Family[]): Promise<Page> {
  if (address.page === "tracks") return tracksPage(all);
  if (address.page === "gallery") return galleryPage();
  if (address.page === "teachers") return teacherPage();
  if (!address.a) return homePage(all);
  const lesson = all.flatMap((family) => family.lessons).find((own) => own.name === address.a);
  if (!lesson) {
    const home = homePage(all);
    home.element.prepend(h("p", { class: "notice", role: "alert" }, `${t("unknown")}: ${address.a}`));
    return home;
  }
  return lessonPage(lesson, all, { ...(await setupOf(address)), address }, go);
}

function go(address: Address): void {
  history.pushState(null, "", format(address));
  void show();
}

let ticket = 0;

async function show(): Promise<void> {
  const own = ++ticket;
  const address = parse(location.hash);
  setLanguage(address.lang ?? preferred());
  if (!families) {
    app.replaceChildren(h("p", { class: "loading", role: "status" }, t("loading")));
    try {
      families = await lessons();
    } catch (e) {
      const again = h("button", { type: "button", onclick: () => void show() }, t("retry"));
      const reason = e instanceof Error ? e.message : String(e);
      app.replaceChildren(h("main", { class: "loading", role: "alert" }, h("p", {}, `${t("failed")}: ${reason}`), again));
      return;
    }
  }
  const made = await pageOf(address, families);
  if (own !== ticket) return made.close();
  page?.close();
  page = made;
  document.title = made.title === "durer explorer" ? made.title : `${made.title} · durer explorer`;
  app.replaceChildren(...(address.embed ? [] : [bar(address)]), made.element);
  scrollTo(0, 0);
}

/** Fields keep their keys, and so do what is played with arrows. */
function isField(target: EventTarget | null): boolean {
  if (!(target instanceof Element)) return false;
  if (target.closest("dialog[open]")) return true;
  const field = target.closest("input, textarea, select");
  return field !== null && !field.matches(".scrubber");
}

document.addEventListener("keydown", (event) => {
  if (isField(event.target) || event.defaultPrevented) return;
  // A focused button is pressed by the space bar.
  const onButton = event.target instanceof Element && event.target.closest("button, a, summary, [role=button]");
  if (event.key === " " && onButton) return;
  if (page?.key?.(event)) event.preventDefault();
});

addEventListener("hashchange", () => void show());
theme(remembered("theme"));
void show();
