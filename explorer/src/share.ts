// Copies of the step shown: as a link, a picture, code; the run as an animation.

import { drawn, joined, type Picture } from "./apng";
import { command, python, rust } from "./code";
import { h } from "./dom";
import { format, type Address } from "./link";
import type { Player } from "./player";
import { language, of, t, type WordName } from "./words";

/** Largest number of pictures in an animation; of longer runs it shows steps at equal distances. */
const MOST_PICTURES = 240;
/** Longer side of an animation in pixels, and the time that a picture is shown in milliseconds. */
const SIDE = 720;
const SHOWN = 900;

/** Returns the run, or a selection of its steps, as an animated PNG. */
async function animated(player: Player, progress: (step: number, count: number) => void): Promise<Uint8Array> {
  const { run, steps } = player;
  const count = Math.min(steps, MOST_PICTURES);
  const canvas = document.createElement("canvas");
  const pictures: Picture[] = [];
  for (let k = 0; k < count; k++) {
    const step = count < 2 ? 0 : Math.round((k * (steps - 1)) / (count - 1));
    const { svg, map } = await player.engine.frame(run!.handle, step, language(), SIDE);
    if (k === 0) {
      const [wide, high] = [map.max[0] - map.min[0], map.max[1] - map.min[1]];
      canvas.width = Math.max(1, Math.round((SIDE * wide) / Math.max(wide, high)));
      canvas.height = Math.max(1, Math.round((SIDE * high) / Math.max(wide, high)));
    }
    // The last picture stays longer, so that the end is seen.
    pictures.push({ png: await drawn(svg, canvas), shown: k + 1 === count ? 3 * SHOWN : SHOWN });
    progress(k + 1, count);
  }
  return joined(pictures);
}

export function sharePanel(player: Player, address: () => Promise<Address>, notice: (text: string) => void): HTMLElement {
  const here = (): string => location.href.replace(/#.*$/, "");
  const link = async (): Promise<string> => here() + format(await address());
  const ways: [WordName, () => Promise<string>][] = [
    ["copyLink", link],
    ["copyFrame", async () => `<iframe src="${here() + format({ ...(await address()), embed: true })}" width="640" height="560" title="${of(player.lesson.title)}"></iframe>`],
    ["copySvg", () => Promise.resolve(player.frame?.svg ?? "")],
    ["copyTikz", () => player.engine.tikz(player.run!.handle, player.step, language())],
    ["copyRust", () => Promise.resolve(rust(player))],
    ["copyPython", () => Promise.resolve(python(player))],
    ["copyCommand", () => Promise.resolve(command(player))],
  ];
  const shown = h("textarea", { rows: 5, readonly: true, hidden: true, "aria-label": t("share") });
  async function copy(name: WordName, make: () => Promise<string>): Promise<void> {
    const text = await make();
    shown.value = text;
    shown.hidden = false;
    try {
      await navigator.clipboard.writeText(text);
      notice(`${t("copied")}: ${t(name)}`);
    } catch {
      // Pages without permission show the text, selected.
      shown.select();
    }
  }
  const animation = h("button", { type: "button", "data-copy": "copyApng", onclick: () => void save() }, t("copyApng"));
  async function save(): Promise<void> {
    animation.disabled = true;
    try {
      const bytes = await animated(player, (step, count) => notice(t("making", { step, count })));
      const url = URL.createObjectURL(new Blob([bytes as BlobPart], { type: "image/apng" }));
      const name = `${player.lesson.name}.png`;
      h("a", { href: url, download: name }).click();
      setTimeout(() => URL.revokeObjectURL(url), 10_000);
      notice(`${t("saved")}: ${name}`);
    } catch (e) {
      notice(String(e));
    } finally {
      animation.disabled = false;
    }
  }
  return h(
    "div",
    { class: "panel" },
    h("p", { class: "hint" }, t("shareHint")),
    h("div", { class: "tools" }, ...ways.map(([name, make]) => h("button", { type: "button", "data-copy": name, onclick: () => void copy(name, make) }, t(name))), animation),
    shown,
  );
}
