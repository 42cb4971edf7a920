// One scene by all methods for visible surfaces, with their differences.

import { h } from "./dom";
import { files, Refused, Trapped } from "./engine";
import type { Page } from "./lesson";
import { rooted } from "./root";
import type { Words } from "./types";
import { language, of, t } from "./words";

interface Method {
  name: string;
  titles: Words;
}

/** Number of operations of one kind. */
interface Count {
  name: string;
  title: Words;
  count: number;
}

interface Model {
  name: string;
  bytes: ArrayBuffer;
}

const SIZE = 360;

/** Divides an answer into its two parts: the counts in JSON, then, after a zero byte, a PNG. */
function parts(answer: Uint8Array): { counts: Count[]; png: Uint8Array } {
  const end = answer.indexOf(0);
  const { counts } = JSON.parse(new TextDecoder().decode(answer.subarray(0, end))) as { counts: Count[] };
  return { counts, png: answer.subarray(end + 1) };
}

/** Returns a table of the operations that a method took. */
function operations(counts: Count[], caption: string): HTMLElement {
  const numbers = new Intl.NumberFormat(language());
  const row = ({ name, title, count }: Count) => h("tr", { "data-count": name }, h("th", { scope: "row" }, of(title)), h("td", {}, numbers.format(count)));
  return h("table", { class: "counts" }, h("caption", { class: "visually-hidden" }, caption), h("tbody", {}, ...counts.map(row)));
}

/** Returns the pixels of a PNG. */
async function pixels(blob: Blob): Promise<ImageData> {
  const bitmap = await createImageBitmap(blob);
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const context = canvas.getContext("2d", { willReadFrequently: true })!;
  context.drawImage(bitmap, 0, 0);
  return context.getImageData(0, 0, bitmap.width, bitmap.height);
}

/** Returns the pixels that differ, dark on white, and their number. */
function difference(a: ImageData, b: ImageData): { image: ImageData; count: number } {
  const image = new ImageData(a.width, a.height);
  let count = 0;
  for (let at = 0; at < a.data.length; at += 4) {
    const differs = [0, 1, 2, 3].some((channel) => a.data[at + channel] !== b.data[at + channel]);
    count += differs ? 1 : 0;
    const [r, g, blue] = differs ? [213, 94, 0] : [245, 245, 245];
    image.data.set([r!, g!, blue!, 255], at);
  }
  return { image, count };
}

export function galleryPage(): Page {
  let model: Model | undefined;
  let ticket = 0;
  const urls: string[] = [];
  const cards = h("div", { class: "cards" });
  const notice = h("p", { class: "notice", role: "status", "aria-live": "polite", hidden: true });
  const azimuth = slider("azimuth", -180, 180, 30);
  const elevation = slider("elevation", -90, 90, 25);
  const picker = h("input", { type: "file", id: "model", accept: ".obj,.stl,.ply,.off,.glb,.gltf,.3mf", onchange: () => void opened(picker.files?.[0]) });

  function slider(name: "azimuth" | "elevation", min: number, max: number, value: number): HTMLInputElement {
    return h("input", { type: "range", id: name, min, max, value, step: 5, onchange: () => void render() });
  }

  function say(text: string): void {
    notice.textContent = text;
    notice.hidden = text === "";
  }

  async function opened(file: File | undefined): Promise<void> {
    if (!file) return;
    model = { name: file.name, bytes: await file.arrayBuffer() };
    await render();
  }

  async function sample(): Promise<void> {
    const response = await fetch(rooted("teapot.obj"));
    if (!response.ok) return say(`teapot.obj: ${response.status}`);
    model = { name: "teapot.obj", bytes: await response.arrayBuffer() };
    await render();
  }

  async function render(): Promise<void> {
    const own = ++ticket;
    if (!model) return;
    const { name, bytes } = model;
    say(t("loading"));
    cards.replaceChildren();
    urls.splice(0).forEach((url) => URL.revokeObjectURL(url));
    let first: ImageData | undefined;
    try {
      const { methods } = await files.ask<{ methods: Method[] }>({ do: "methods" });
      for (const method of methods) {
        const view = { azimuth: Number(azimuth.value), elevation: Number(elevation.value) };
        const start = performance.now();
        const answer = await files.ask<Uint8Array>({ do: "render", name, method: method.name, width: SIZE, height: SIZE, ...view, counts: true }, bytes.slice(0));
        const time = performance.now() - start;
        if (own !== ticket) return;
        const { counts, png } = parts(answer);
        const blob = new Blob([png as BlobPart], { type: "image/png" });
        const data = await pixels(blob);
        first ??= data;
        const url = URL.createObjectURL(blob);
        urls.push(url);
        cards.append(card(method, url, difference(first, data), counts, time, `durer render ${name} --algorithm ${method.name} --azimuth=${view.azimuth} --elevation=${view.elevation} --aa 1 --size ${SIZE}x${SIZE} -o ${method.name}.png`));
      }
      say("");
    } catch (e) {
      if (!(e instanceof Refused || e instanceof Trapped)) throw e;
      if (own === ticket) say(e.message);
    }
  }

  function card(method: Method, url: string, { image, count }: { image: ImageData; count: number }, counts: Count[], time: number, command: string): HTMLElement {
    const map = h("canvas", { width: image.width, height: image.height, hidden: count === 0, role: "img", "aria-label": `${of(method.titles)}: ${t("differs", { count })}` });
    map.getContext("2d")!.putImageData(image, 0, 0);
    return h(
      "section",
      { class: "card picture-card", "aria-label": of(method.titles) },
      h("h2", {}, of(method.titles)),
      h("img", { src: url, alt: `${model?.name ?? ""}, ${of(method.titles)}`, width: SIZE, height: SIZE }),
      map,
      operations(counts, t("work", { method: of(method.titles) })),
      h("p", { class: "hint" }, `${Math.round(time)} ms · ${t("differs", { count })}`),
      h("p", {}, h("a", { class: "button", href: url, download: `${method.name}.png` }, "PNG"), " ", h("button", { type: "button", "data-command": command, onclick: () => void navigator.clipboard.writeText(command).catch(() => say(command)) }, t("copyCommand"))),
    );
  }

  const element = h(
    "main",
    { id: "content", class: "lesson gallery", tabindex: -1 },
    h("h1", {}, t("gallery")),
    h("p", { class: "lead" }, t("galleryLead")),
    h(
      "div",
      { class: "tools" },
      h("button", { type: "button", class: "primary", onclick: () => void sample() }, t("teapot")),
      h("span", { class: "file" }, h("label", { for: "model", class: "button" }, t("open")), picker),
      h("span", {}, h("label", { for: "azimuth" }, t("azimuth")), azimuth),
      h("span", {}, h("label", { for: "elevation" }, t("elevation")), elevation),
    ),
    notice,
    cards,
  );
  return {
    element,
    title: t("gallery"),
    close() {
      ticket++;
      urls.forEach((url) => URL.revokeObjectURL(url));
    },
  };
}
