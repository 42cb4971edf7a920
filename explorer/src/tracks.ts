// Lecture tracks: pages in the order of a lecture, each with its worked example.

import { h } from "./dom";
import { format, type Address } from "./link";
import type { Page } from "./lesson";
import type { Family, Lesson, Words } from "./types";
import { language, of, t } from "./words";

export interface Stop {
  lesson: string;
  example: string;
  /** What to look for. */
  text: Words;
}

export interface Track {
  name: string;
  title: Words;
  lead: Words;
  stops: Stop[];
}

export const TRACKS: Track[] = [
  {
    name: "clipping",
    title: { en: "Windows and clipping", de: "Fenster und Clippen" },
    lead: { en: "The part of a line or polygon inside a window: outcodes, parameters, stages and walks.", de: "Was von Linie oder Polygon im Fenster liegt: Outcodes, Parameter, Stufen und Wege." },
    stops: [
      { lesson: "cohen-sutherland", example: "line-eh", text: { en: "EH: which bits make which cuts? Then load AD, which is cut once and still rejected.", de: "EH: Welche Bits führen zu welchen Schnitten? Danach AD, das einmal geschnitten und doch abgelehnt wird." } },
      { lesson: "midpoint", example: "", text: { en: "The same by halving: no division, only shifts.", de: "Dasselbe durch Halbieren: keine Division, nur Schieben." } },
      { lesson: "cyrus-beck", example: "", text: { en: "Borders are entered or left: the largest entering and the smallest leaving parameter remain.", de: "Ränder werden betreten oder verlassen: Es bleiben der größte Eintritts- und der kleinste Austrittsparameter." } },
      { lesson: "liang-barsky", example: "", text: { en: "The same for a window: p and q of four borders.", de: "Dasselbe am Fenster: p und q von vier Rändern." } },
      { lesson: "nicholl-lee-nicholl", example: "", text: { en: "The region of the end, seen from the start, gives the borders at once.", de: "Die Region des Endes, vom Anfang gesehen, liefert die Ränder sofort." } },
      { lesson: "sutherland-hodgman", example: "triangle", text: { en: "Four stages; watch the cases in→out and out→in. Then load the bridge.", de: "Vier Stufen; achten Sie auf innen→außen und außen→innen. Danach die Brücke laden." } },
      { lesson: "weiler-atherton", example: "", text: { en: "Two lists, entries and exits: follow one ring until it leaves, then the other.", de: "Zwei Listen, Eintritte und Austritte: erst dem einen Ring folgen, dann dem anderen." } },
    ],
  },
  {
    name: "viewport",
    title: { en: "From the world to the screen", de: "Von der Welt zum Bildschirm" },
    lead: { en: "Window to viewport, and clipping before or after the division.", de: "Vom Fenster zum Viewport, und Clippen vor oder nach der Division." },
    stops: [
      { lesson: "window-viewport", example: "", text: { en: "Two equations give a, b, c and d; then every point is one product and one sum.", de: "Zwei Gleichungen ergeben a, b, c und d; danach kostet jeder Punkt ein Produkt und eine Summe." } },
      { lesson: "homogeneous-volume", example: "", text: { en: "Before the division, −w ≤ x ≤ w is a wedge: see why points with w < 0 need it.", de: "Vor der Division ist −w ≤ x ≤ w ein Keil: So wird klar, warum Punkte mit w < 0 ihn brauchen." } },
      { lesson: "clip-attributes", example: "one-to-three", text: { en: "A new vertex: t in space, s on the screen, and the error of mixing by s.", de: "Eine neue Ecke: t im Raum, s am Schirm, und der Fehler, mit s zu mischen." } },
      { lesson: "back-face-removal", example: "", text: { en: "The normal against the direction of sight: half of the faces are removed before anything else.", de: "Normale gegen Blickrichtung: Die Hälfte der Flächen fällt vorab weg." } },
    ],
  },
  {
    name: "raster",
    title: { en: "Lines and areas in pixels", de: "Linien und Flächen in Pixeln" },
    lead: { en: "Decision variables, tables of edges, stacks of seeds.", de: "Entscheidungsvariablen, Kantentabellen, Stapel von Startpunkten." },
    stops: [
      { lesson: "points", example: "floor", text: { en: "Which pixel does a place belong to? Each pixel owns two of its sides.", de: "Zu welchem Pixel gehört ein Ort? Jedes Pixel hat zwei seiner Seiten." } },
      { lesson: "dda", example: "lecture", text: { en: "One addition and one rounding per pixel.", de: "Je Pixel eine Addition und eine Rundung." } },
      { lesson: "bresenham", example: "lecture", text: { en: "E = 1, −3, 3, −1, 5: whole numbers only. Predict each step.", de: "E = 1, −3, 3, −1, 5: nur ganze Zahlen. Sagen Sie jeden Schritt voraus." } },
      { lesson: "midpoint-circle", example: "radius-10", text: { en: "One octant; the midpoint between two candidates decides.", de: "Ein Oktant; der Mittelpunkt zwischen zwei Kandidaten entscheidet." } },
      { lesson: "edge-table", example: "triangle", text: { en: "Buckets by first row, then the active edges from row to row.", de: "Fächer nach erster Zeile, dann die aktiven Kanten von Zeile zu Zeile." } },
      { lesson: "naive", example: "", text: { en: "A pixel pushes four neighbours: watch the stack grow.", de: "Ein Pixel legt vier Nachbarn ab: Der Stapel wächst." } },
      { lesson: "spans", example: "", text: { en: "The same by runs: compare the height of the stack.", de: "Dasselbe in Läufen: Vergleichen Sie die Höhe des Stapels." } },
    ],
  },
  {
    name: "shading",
    title: { en: "Clipping and rasterization of triangles", de: "Dreiecke clippen und rastern" },
    lead: { en: "Half-planes, rows, and interpolation between them.", de: "Halbebenen, Zeilen und was dazwischen interpoliert wird." },
    stops: [
      { lesson: "edge-function", example: "", text: { en: "Three signs decide a pixel; the rule for edges gives each pixel to one triangle.", de: "Drei Vorzeichen entscheiden ein Pixel; die Kantenregel gibt jedes Pixel genau einem Dreieck." } },
      { lesson: "edge-walking", example: "", text: { en: "The same pixels by rows.", de: "Dieselben Pixel zeilenweise." } },
      { lesson: "gouraud", example: "", text: { en: "Light at the corners, along the edges, along the row.", de: "Licht an den Ecken, längs der Kanten, längs der Zeile." } },
      { lesson: "phong", example: "", text: { en: "Normals instead of light: note their length before the division.", de: "Normalen statt Licht: Achten Sie auf die Länge vor der Division." } },
      { lesson: "perspective-correct", example: "", text: { en: "u/w and 1/w are linear on the screen, u is not.", de: "u/w und 1/w sind auf dem Schirm linear, u ist es nicht." } },
    ],
  },
  {
    name: "hidden",
    title: { en: "Hidden lines and surfaces", de: "Verdeckte Linien und Flächen" },
    lead: { en: "The same two faces, by pixels, by order, by division of space and of the picture.", de: "Dieselben zwei Flächen: nach Pixeln, nach Reihenfolge, durch Teilen des Raums und des Bilds." },
    stops: [
      { lesson: "z-buffer-loop", example: "penetration", text: { en: "Two loops and a comparison.", de: "Zwei Schleifen und ein Vergleich." } },
      { lesson: "painter", example: "penetration", text: { en: "From far to near, and where that fails.", de: "Von hinten nach vorn, und wo das scheitert." } },
      { lesson: "depth-sort", example: "", text: { en: "Which of the five tests decides? Only if none does, a face is cut.", de: "Welcher der fünf Tests entscheidet? Erst dann wird geteilt." } },
      { lesson: "bsp-tree", example: "", text: { en: "The planes of the faces divide space: the order follows from the tree.", de: "Die Ebenen der Flächen teilen den Raum: Die Reihenfolge folgt aus dem Baum." } },
      { lesson: "warnock", example: "", text: { en: "A window is simple or is divided: empty, one, surrounded.", de: "Ein Fenster ist einfach oder wird geteilt: leer, eine, umgeben." } },
      { lesson: "watkins", example: "", text: { en: "Row by row: which span is nearest?", de: "Zeile für Zeile: Welcher Abschnitt liegt vorn?" } },
      { lesson: "horizon-curves", example: "", text: { en: "Two arrays, the horizons, decide which part of a curve is visible.", de: "Zwei Felder, die Horizonte, entscheiden, was von einer Kurve zu sehen ist." } },
    ],
  },
];

export function addressOf(track: Track, index: number): Address {
  const stop = track.stops[index]!;
  return { a: stop.lesson, ex: stop.example || undefined, track: track.name, at: index + 1, lang: language() };
}

function lessonOf(families: Family[], name: string): Lesson | undefined {
  return families.flatMap((family) => family.lessons).find((lesson) => lesson.name === name);
}

/** The bar above a lesson that belongs to a track. */
export function trackBar(address: Address, families: Family[], go: (address: Address) => void): HTMLElement | null {
  const track = TRACKS.find((own) => own.name === address.track);
  const index = (address.at ?? 0) - 1;
  const stop = track?.stops[index];
  if (!track || !stop || stop.lesson !== address.a) return null;
  const link = (to: number, name: "previousPage" | "nextPage", arrow: string): HTMLElement | null => {
    const other = track.stops[to];
    if (!other) return null;
    const found = lessonOf(families, other.lesson);
    const title = found ? of(found.title) : other.lesson;
    const onclick = (event: Event): void => {
      event.preventDefault();
      go(addressOf(track, to));
    };
    return h("a", { class: `button ${name}`, href: format(addressOf(track, to)), "aria-label": `${t(name)}: ${title}`, onclick }, name === "nextPage" ? `${title} ${arrow}` : `${arrow} ${title}`);
  };
  return h(
    "section",
    { class: "track-bar", "aria-label": of(track.title) },
    h("p", { class: "where" }, h("a", { href: format({ page: "tracks", lang: language() }) }, of(track.title)), ` · ${index + 1} / ${track.stops.length}`),
    h("p", { class: "task" }, of(stop.text)),
    h("p", { class: "ways" }, link(index - 1, "previousPage", "←"), link(index + 1, "nextPage", "→")),
  );
}

export function tracksPage(families: Family[]): Page {
  const element = h(
    "main",
    { id: "content", class: "text-page", tabindex: -1 },
    h("h1", {}, t("tracks")),
    ...TRACKS.map((track) =>
      h(
        "section",
        { class: "track-list" },
        h("h2", {}, of(track.title)),
        h("p", {}, of(track.lead)),
        h(
          "ol",
          {},
          ...track.stops.map((stop, index) => {
            const lesson = lessonOf(families, stop.lesson);
            return h("li", {}, h("a", { href: format(addressOf(track, index)) }, lesson ? of(lesson.title) : stop.lesson), h("span", { class: "hint" }, ` ${of(stop.text)}`));
          }),
        ),
      ),
    ),
  );
  return { element, title: t("tracks"), close: () => undefined };
}
