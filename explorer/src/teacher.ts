// The page for teachers.

import { h } from "./dom";
import type { Page } from "./lesson";
import { language, t } from "./words";

const TEXT = {
  en: [
    ["In the lecture", "Open a page of a track and step with the arrow keys. Shift with an arrow goes to the next step of the same kind, a click on a line of the pseudocode to the next step that runs it. Drag a vertex in front of the class: the run follows."],
    ["Prepare an hour", "Build the input that you want to show (drag vertices, or Draw a polygon under Input), go to the step at which the hour begins, and copy the link under Share: it holds the input, the step and the language. Links need no server, and nothing of the input is sent anywhere."],
    ["Embed a step", "Share → Frame for a page gives an iframe. It shows picture, caption and buttons only. It reports {step, of, algorithm} to the page around it by postMessage, and takes {goto: n}. Opened by itself it fills the screen, and a presenter's remote steps through it."],
    ["Print", "Printing shows picture, caption, pseudocode and table of the step. For sheets with all steps side by side, use the command line: durer explain NAME -o steps.svg. Share → Picture for LaTeX gives TikZ."],
    ["Set questions", "Each page has a quiz, which hides the next step and asks where it happens in the picture, and exercises, which the run checks. Both work on any input: send a link with your own one, and ask for the line of the pseudocode if the sentences give too much away. A link copied while the quiz runs begins with it, and so does a frame. Some algorithms have programs with a bug to find; a link copied while one runs asks for the same bug."],
    ["Offline", "durer explore serves these pages from the command itself. They can also be copied to any folder of a web server."],
  ],
  de: [
    ["In der Vorlesung", "Öffnen Sie eine Seite einer Reihe und gehen Sie mit den Pfeiltasten von Schritt zu Schritt. Umschalt mit Pfeil springt zum nächsten Schritt gleicher Art, ein Klick auf eine Zeile des Pseudocodes zum nächsten Schritt, der sie ausführt. Ziehen Sie vor der Klasse an einer Ecke: Der Lauf folgt."],
    ["Eine Stunde vorbereiten", "Bauen Sie die gewünschte Eingabe (Ecken ziehen, oder „Polygon zeichnen“ unter „Eingabe“), gehen Sie zum Schritt, mit dem die Stunde beginnt, und kopieren Sie den Link unter „Weitergeben“: Er enthält Eingabe, Schritt und Sprache. Links brauchen keinen Server, und nichts von der Eingabe wird versandt."],
    ["Einen Schritt einbetten", "„Rahmen für eine Seite“ unter „Weitergeben“ liefert ein iframe. Er zeigt nur Bild, Satz und Tasten. Er meldet der Seite {step, of, algorithm} mit postMessage und nimmt {goto: n} entgegen. Für sich geöffnet füllt er den Bildschirm, und ein Presenter blättert die Schritte."],
    ["Drucken", "Der Ausdruck zeigt Bild, Satz, Pseudocode und Tabelle des Schritts. Blätter mit allen Schritten macht die Kommandozeile: durer explain NAME -o steps.svg. „Bild für LaTeX“ liefert TikZ."],
    ["Fragen stellen", "Jede Seite hat ein Quiz, das den nächsten Schritt verdeckt und fragt, wo er im Bild geschieht, und Aufgaben, die der Lauf prüft. Beides geht mit jeder Eingabe: Verschicken Sie einen Link mit einer eigenen, und fragen Sie nach der Zeile, wenn die Sätze zu viel verraten. Ein Link, der während des Quiz kopiert wird, beginnt mit ihm, ebenso ein Rahmen. Einige Algorithmen haben Programme, in denen ein Fehler zu finden ist; ein Link, der dabei kopiert wird, stellt dieselbe Frage."],
    ["Ohne Netz", "durer explore zeigt diese Seiten aus dem Befehl selbst. Sie lassen sich auch in jeden Ordner eines Webservers kopieren."],
  ],
};

export function teacherPage(): Page {
  const element = h(
    "main",
    { id: "content", class: "text-page", tabindex: -1 },
    h("h1", {}, t("teachers")),
    ...TEXT[language()].map(([title, text]) => h("section", {}, h("h2", {}, title), h("p", {}, text))),
  );
  return { element, title: t("teachers"), close: () => undefined };
}
