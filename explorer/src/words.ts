// Words of the pages, in every language; the engine has those of lessons.

import type { Language, Words } from "./types";

const WORDS = {
  algorithms: { en: "Algorithms", de: "Algorithmen" },
  tracks: { en: "Lectures", de: "Vorlesungen" },
  gallery: { en: "Gallery", de: "Galerie" },
  teachers: { en: "For teachers", de: "Für Lehrende" },
  lead: {
    en: "Algorithms of computer graphics, step by step, on your own input. It is the code of the library that runs, forward and back.",
    de: "Algorithmen der Computergrafik, Schritt für Schritt, auf eigenen Daten. Es läuft der Code der Bibliothek selbst, vorwärts und zurück.",
  },
  find: { en: "Find an algorithm", de: "Algorithmus suchen" },
  nothing: { en: "No algorithm has this name.", de: "Kein Algorithmus heißt so." },
  start: { en: "Start with", de: "Zum Einstieg" },
  loading: { en: "Loading the algorithms …", de: "Die Algorithmen werden geladen …" },
  failed: { en: "The engine could not be loaded", de: "Der Rechenkern lässt sich nicht laden" },
  restarted: {
    en: "The engine stopped on this input and was started anew. The last good run is shown.",
    de: "Der Rechenkern ist an dieser Eingabe stehen geblieben und neu gestartet. Gezeigt wird der letzte gute Lauf.",
  },
  unknown: { en: "There is no such algorithm", de: "Diesen Algorithmus gibt es nicht" },
  badInput: {
    en: "The input in this link cannot be read. An example is shown.",
    de: "Die Eingabe in diesem Link ist nicht lesbar. Gezeigt wird ein Beispiel.",
  },
  retry: { en: "Try again", de: "Noch einmal" },
  facts: { en: "Facts", de: "Steckbrief" },
  source: { en: "Published in", de: "Erschienen in" },
  decides: { en: "Decides in", de: "Entscheidet in" },
  object: { en: "object space", de: "Objektraum" },
  image: { en: "image space", de: "Bildraum" },
  "list-priority": { en: "list priority", de: "Prioritätsliste" },
  cost: { en: "Cost", de: "Aufwand" },
  limits: { en: "Limits", de: "Grenzen" },
  takes: { en: "Takes", de: "Eingabe" },
  picture: { en: "Picture", de: "Bild" },
  code: { en: "Pseudocode", de: "Pseudocode" },
  codeHint: { en: "Click a line to go to the next step that runs it.", de: "Ein Klick auf eine Zeile springt zum nächsten Schritt, der sie ausführt." },
  state: { en: "State", de: "Zustand" },
  noState: { en: "This step has no data to show.", de: "Dieser Schritt hat keine Daten zu zeigen." },
  step: { en: "Step", de: "Schritt" },
  of: { en: "of", de: "von" },
  first: { en: "First step", de: "Erster Schritt" },
  back: { en: "Step back", de: "Schritt zurück" },
  play: { en: "Play", de: "Abspielen" },
  pause: { en: "Pause", de: "Anhalten" },
  next: { en: "Next step", de: "Nächster Schritt" },
  last: { en: "Last step", de: "Letzter Schritt" },
  speed: { en: "Steps per second", de: "Schritte je Sekunde" },
  kinds: { en: "Kinds of steps: go to the next of a kind", de: "Arten von Schritten: zum nächsten einer Art" },
  input: { en: "Input", de: "Eingabe" },
  examples: { en: "Examples", de: "Beispiele" },
  own: { en: "own input", de: "eigene Eingabe" },
  operation: { en: "Operation", de: "Verknüpfung" },
  rule: { en: "Inside by", de: "Innen nach" },
  "even-odd": { en: "even-odd", de: "gerade-ungerade" },
  "non-zero": { en: "non-zero", de: "nicht null" },
  "abs-geq-two": { en: "twice or more", de: "mindestens zweimal" },
  positive: { en: "positive", de: "positiv" },
  negative: { en: "negative", de: "negativ" },
  intersection: { en: "intersection", de: "Durchschnitt" },
  union: { en: "union", de: "Vereinigung" },
  difference: { en: "difference", de: "Differenz" },
  xor: { en: "exclusive or", de: "symmetrische Differenz" },
  undo: { en: "Undo", de: "Rückgängig" },
  redo: { en: "Redo", de: "Wiederholen" },
  add: { en: "Add a vertex", de: "Ecke hinzufügen" },
  remove: { en: "Delete the vertex", de: "Ecke löschen" },
  reset: { en: "Reset", de: "Zurücksetzen" },
  snap: { en: "Grid", de: "Raster" },
  off: { en: "off", de: "aus" },
  dragHint: {
    en: "Drag the handles in the picture. A double click near an edge adds a vertex; Delete removes the chosen one; arrow keys move it.",
    de: "Die Griffe im Bild lassen sich ziehen. Ein Doppelklick an einer Kante fügt eine Ecke hinzu, Entf löscht die gewählte, Pfeiltasten bewegen sie.",
  },
  gridHint: {
    en: "Click pixels to change them; drag the handle to move the seed.",
    de: "Ein Klick ändert Pixel; der Griff versetzt den Startpunkt.",
  },
  numbersHint: {
    en: "This picture shows the input in another way; change its numbers here.",
    de: "Das Bild zeigt die Eingabe auf andere Weise; hier lassen sich die Zahlen ändern.",
  },
  numbers: { en: "Coordinates", de: "Koordinaten" },
  apply: { en: "Apply", de: "Übernehmen" },
  open: { en: "Open a file", de: "Datei öffnen" },
  openHint: {
    en: "SVG, GeoJSON, WKT, OBJ, STL, glTF or PNG. It stays in this browser.",
    de: "SVG, GeoJSON, WKT, OBJ, STL, glTF oder PNG. Sie bleibt in diesem Browser.",
  },
  vertex: { en: "Vertex", de: "Ecke" },
  ofLine: { en: "line", de: "Linie" },
  ofRing: { en: "ring", de: "Ring" },
  ofClip: { en: "clip ring", de: "Clip-Ring" },
  ofFace: { en: "face", de: "Fläche" },
  corner: { en: "corner of the window", de: "Ecke des Fensters" },
  point: { en: "point", de: "Punkt" },
  seed: { en: "seed", de: "Startpunkt" },
  quiz: { en: "Quiz", de: "Quiz" },
  quizStart: { en: "Start the quiz", de: "Quiz starten" },
  quizStop: { en: "End the quiz", de: "Quiz beenden" },
  quizHint: {
    en: "The next step is hidden. Say what happens, then see it: the run itself is the answer, on any input.",
    de: "Der nächste Schritt ist verdeckt. Sagen Sie, was geschieht, und sehen Sie es dann: Die Antwort ist der Lauf selbst, auf jeder Eingabe.",
  },
  askKind: { en: "What happens next?", de: "Was geschieht als Nächstes?" },
  askPlace: { en: "Where? Click {place} in the picture.", de: "Wo? Klicken Sie {place} im Bild an." },
  aPixel: { en: "the pixel", de: "das Pixel" },
  aPoint: { en: "the point", de: "den Punkt" },
  aLine: { en: "the line", de: "die Linie" },
  anArea: { en: "the area", de: "die Fläche" },
  or: { en: "or", de: "oder" },
  crossHint: { en: "Your answer: arrow keys move it, Enter gives it", de: "Ihre Antwort: Pfeiltasten bewegen sie, Enter gibt sie ab" },
  byPlace: { en: "Ask for the place", de: "Nach dem Ort fragen" },
  bug: { en: "Find the bug", de: "Finde den Fehler" },
  bugHint: {
    en: "Runs a program of this algorithm in which one line is wrong. Which one? The captions say what each step is meant to do, with the numbers that the program got.",
    de: "Führt ein Programm dieses Algorithmus aus, in dem eine Zeile falsch ist. Welche? Die Sätze sagen, was jeder Schritt tun soll, mit den Zahlen, die das Programm errechnet.",
  },
  bugStart: { en: "Run a program with a bug", de: "Ein fehlerhaftes Programm ausführen" },
  bugOther: { en: "Another bug", de: "Ein anderer Fehler" },
  bugGiveUp: { en: "Tell me", de: "Verraten" },
  bugEnd: { en: "Run the right program", de: "Das richtige Programm ausführen" },
  bugAsk: {
    en: "One line of this program is wrong. Step through the run, check its numbers, and click the wrong line of the pseudocode.",
    de: "Eine Zeile dieses Programms ist falsch. Gehen Sie den Lauf durch, prüfen Sie die Zahlen und klicken Sie die falsche Zeile im Pseudocode an.",
  },
  bugFirst: { en: "✓ Found at the first try.", de: "✓ Beim ersten Versuch gefunden." },
  bugFound: { en: "✓ Found at try {tries}.", de: "✓ Beim {tries}. Versuch gefunden." },
  bugTold: { en: "This was it.", de: "Das war es." },
  bugNot: { en: "Line {line} is right.", de: "Zeile {line} ist richtig." },
  bugWas: { en: "Line {line} should be “{right}”; the program had “{wrong}”.", de: "Zeile {line} müsste „{right}“ lauten; im Programm stand „{wrong}“." },
  askLine: { en: "Which line runs next? Click it.", de: "Welche Zeile läuft als Nächstes? Klicken Sie sie an." },
  byKind: { en: "Ask for the step", de: "Nach dem Schritt fragen" },
  byLine: { en: "Ask for the line", de: "Nach der Zeile fragen" },
  right: { en: "Right.", de: "Richtig." },
  wrong: { en: "No:", de: "Nein:" },
  wrongLine: { en: "No: line", de: "Nein: Zeile" },
  score: { en: "Right so far", de: "Bisher richtig" },
  quizEnd: { en: "That was the last step.", de: "Das war der letzte Schritt." },
  exercises: { en: "Exercises", de: "Aufgaben" },
  exercisesHint: { en: "Change the input; the run checks it.", de: "Ändern Sie die Eingabe; der Lauf prüft sie." },
  exerciseMore: { en: "Make a run with more than {count} steps of this kind: {text}", de: "Ein Lauf mit mehr als {count} Schritten dieser Art: {text}" },
  exerciseAll: { en: "Reach every kind of step in one run ({count} of {all})", de: "Alle Arten von Schritten in einem Lauf ({count} von {all})" },
  exerciseFew: { en: "Make a run of fewer than {count} steps", de: "Ein Lauf mit weniger als {count} Schritten" },
  exerciseNone: { en: "Make a run without this kind of step: {text}", de: "Ein Lauf ohne diese Art von Schritt: {text}" },
  solved: { en: "solved", de: "gelöst" },
  open_: { en: "open", de: "offen" },
  compare: { en: "Compare", de: "Vergleichen" },
  compareHint: { en: "Run other algorithms on the same input, side by side.", de: "Andere Algorithmen auf derselben Eingabe, nebeneinander." },
  compareWith: { en: "Compare with", de: "Vergleichen mit" },
  cannot: { en: "does not take this input", de: "nimmt diese Eingabe nicht" },
  counts: { en: "Work done", de: "Geleistete Arbeit" },
  steps: { en: "steps", de: "Schritte" },
  share: { en: "Share", de: "Weitergeben" },
  copied: { en: "Copied", de: "Kopiert" },
  copyLink: { en: "Link", de: "Link" },
  copyFrame: { en: "Frame for a page", de: "Rahmen für eine Seite" },
  copySvg: { en: "Picture as SVG", de: "Bild als SVG" },
  copyTikz: { en: "Picture for LaTeX", de: "Bild für LaTeX" },
  copyApng: { en: "Run as APNG", de: "Lauf als APNG" },
  saved: { en: "Saved", de: "Gespeichert" },
  making: { en: "Making picture {step} of {count} …", de: "Bild {step} von {count} entsteht …" },
  copyPython: { en: "Python", de: "Python" },
  formula: { en: "Formula y = f(x, z)", de: "Formel y = f(x, z)" },
  copyRust: { en: "Rust", de: "Rust" },
  copyCommand: { en: "Command line", de: "Kommandozeile" },
  shareHint: { en: "Copies this step, with this input.", de: "Kopiert diesen Schritt mit dieser Eingabe." },
  text: { en: "All steps as text", de: "Alle Schritte als Text" },
  textHint: { en: "Captions {first} to {last}", de: "Sätze {first} bis {last}" },
  more: { en: "More", de: "Mehr" },
  help: { en: "Keys", de: "Tasten" },
  close: { en: "Close", de: "Schließen" },
  theme: { en: "Light or dark", de: "Hell oder dunkel" },
  language: { en: "Deutsch", de: "English" },
  skip: { en: "Skip to the content", de: "Zum Inhalt" },
  overview: { en: "All algorithms", de: "Alle Algorithmen" },
  previousPage: { en: "Previous page", de: "Vorige Seite" },
  nextPage: { en: "Next page", de: "Nächste Seite" },
  noMore: { en: "No further step of this kind.", de: "Kein weiterer Schritt dieser Art." },
  noLine: { en: "No further step runs this line.", de: "Kein weiterer Schritt führt diese Zeile aus." },
  steps1: { en: "{count} steps", de: "{count} Schritte" },
  galleryLead: {
    en: "One model by every method for visible surfaces. Pixels that differ from the first picture are shown below. All methods take one sample a pixel; the A-buffer shares pixels among surfaces, so its edges differ.",
    de: "Ein Modell nach jedem Verfahren für sichtbare Flächen. Pixel, die vom ersten Bild abweichen, sind darunter gezeigt. Alle nehmen eine Probe je Pixel; nur der A-Buffer teilt Pixel unter Flächen auf, seine Kanten weichen also ab.",
  },
  teapot: { en: "Render the teapot", de: "Teekanne rendern" },
  azimuth: { en: "Around", de: "Drehung" },
  elevation: { en: "Above", de: "Höhe" },
  differs: { en: "{count} pixels differ", de: "{count} Pixel weichen ab" },
  seeFull: { en: "Open in the explorer", de: "Im Explorer öffnen" },
} satisfies Record<string, Words>;

export type WordName = keyof typeof WORDS;

let current: Language = "en";

export function setLanguage(language: Language): void {
  current = language;
  document.documentElement.lang = language;
}

export function language(): Language {
  return current;
}

/** Returns a text of the pages, with `{name}` replaced by values. */
export function t(name: WordName, values: Record<string, string | number> = {}): string {
  return WORDS[name][current].replace(/\{(\w+)\}/g, (whole, key: string) => String(values[key] ?? whole));
}

/** Returns a text of the pages if there is one of this name, else the name: for names that the engine gives. */
export function named(name: string): string {
  return (WORDS as Record<string, Words>)[name]?.[current] ?? name;
}

/** Returns a text of the engine. */
export function of(words: Words): string {
  return words[current];
}

/** Keys with what they do. */
export const KEYS: { keys: string; text: Words }[] = [
  { keys: "← →", text: { en: "step back and forward", de: "Schritt zurück und vor" } },
  { keys: "⇧ ← →", text: { en: "to the next step of this kind", de: "zum nächsten Schritt dieser Art" } },
  { keys: "Home End", text: { en: "first and last step", de: "erster und letzter Schritt" } },
  { keys: "Space", text: { en: "play and pause", de: "abspielen und anhalten" } },
  { keys: "+ −", text: { en: "faster and slower", de: "schneller und langsamer" } },
  { keys: "R", text: { en: "reset the input", de: "Eingabe zurücksetzen" } },
  { keys: "Ctrl Z", text: { en: "undo a change of the input", de: "Änderung der Eingabe rückgängig machen" } },
  { keys: "Tab", text: { en: "to the vertices in the picture; arrows move, Delete removes", de: "zu den Ecken im Bild; Pfeile bewegen, Entf löscht" } },
  { keys: "?", text: { en: "this list", de: "diese Liste" } },
];
