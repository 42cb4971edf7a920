// The idea of an algorithm in a sentence or two, for readers who see it for the first time.

import type { Words } from "./types";

export const IDEAS: Record<string, Words> = {
  "de-casteljau": {
    en: "A point of a Bézier curve is found by mixing neighbouring control points in one ratio, then the mixtures, until one point is left.",
    de: "Ein Punkt der Bézierkurve entsteht, indem man benachbarte Kontrollpunkte in einem Verhältnis mischt, dann die Mischungen, bis ein Punkt bleibt.",
  },
  "cohen-sutherland": {
    en: "Clips a line to a window. Four bits for each end say beyond which borders it lies; they accept or reject most lines at once, and the others are cut at one border after the other.",
    de: "Clippt eine Strecke an einem Fenster. Vier Bits je Ende sagen, jenseits welcher Ränder es liegt; die meisten Strecken sind damit sofort angenommen oder abgelehnt, die übrigen werden an einem Rand nach dem anderen geschnitten.",
  },
  midpoint: {
    en: "Clips a line to a window without a division: it is halved again and again, and the half that cannot contain the border is left out.",
    de: "Clippt eine Strecke ohne Division: Sie wird immer wieder halbiert, und die Hälfte, die den Rand nicht enthalten kann, fällt weg.",
  },
  "cyrus-beck": {
    en: "Clips a line to any convex window. Each border is either entered or left by the line; what is visible lies between the last entry and the first exit.",
    de: "Clippt eine Strecke an einem konvexen Fenster. Jeder Rand wird von der Geraden betreten oder verlassen; sichtbar ist, was zwischen letztem Eintritt und erstem Austritt liegt.",
  },
  "liang-barsky": {
    en: "Clips a line to a window by its parameter alone: borders that it enters raise the lower bound, those that it leaves lower the upper one. Only the ends that are left are computed.",
    de: "Clippt eine Strecke allein über ihren Parameter: Ränder, die sie betritt, heben die untere Schranke, die sie verlässt, senken die obere. Nur die übrigen Enden werden berechnet.",
  },
  "nicholl-lee-nicholl": {
    en: "Clips a line to a window with the fewest divisions: rays from its start through the corners divide the plane, and the region of its end says which borders to cut.",
    de: "Clippt eine Strecke mit den wenigsten Divisionen: Strahlen vom Anfang durch die Ecken teilen die Ebene, und das Gebiet des Endes sagt, welche Ränder zu schneiden sind.",
  },
  "sutherland-hodgman": {
    en: "Clips a polygon to a window, one border at a time. Every border walks round the whole list of vertices, keeps those inside, and adds a vertex where an edge crosses it; its output is the input of the next.",
    de: "Clippt ein Polygon an einem Fenster, einen Rand nach dem anderen. Jeder Rand geht die ganze Liste der Ecken durch, behält die inneren und fügt eine Ecke hinzu, wo eine Kante ihn kreuzt; was er ausgibt, bekommt der nächste.",
  },
  "weiler-atherton": {
    en: "Clips a polygon to any other. Walk along the subject; where it leaves the clip polygon, turn and walk along that one, and back where it enters again. Each closed walk is a piece of the result.",
    de: "Clippt ein Polygon an einem beliebigen anderen. Man geht am Subjekt entlang; wo es das Clip-Polygon verlässt, biegt man ab und folgt diesem, beim nächsten Eintritt zurück. Jeder geschlossene Weg ist ein Stück des Ergebnisses.",
  },
  "greiner-hormann": {
    en: "Clips a polygon to any other by two linked lists of vertices that share their crossings; each crossing is marked as entry or exit, and the result is read by changing lists there.",
    de: "Clippt ein Polygon an einem beliebigen anderen mit zwei verketteten Listen, die ihre Schnittpunkte teilen; jeder ist als Ein- oder Austritt markiert, und das Ergebnis liest man, indem man dort die Liste wechselt.",
  },
  vatti: {
    en: "Combines polygons of any shape while a horizontal line sweeps over them: it keeps the edges that it meets in order, and opens, continues and closes pieces of the result.",
    de: "Verknüpft beliebige Polygone, während eine waagerechte Linie über sie läuft: Sie hält die getroffenen Kanten in Ordnung und beginnt, verlängert und schließt Stücke des Ergebnisses.",
  },
  "douglas-peucker": {
    en: "Simplifies a line: it keeps the point farthest from the chord if that is far enough, and does the same on both sides; all others go.",
    de: "Vereinfacht eine Linie: Der Punkt, der am weitesten von der Sehne liegt, bleibt, wenn er weit genug weg ist, und beide Seiten werden ebenso behandelt; alle anderen fallen weg.",
  },
  "window-viewport": {
    en: "Maps a part of the world to a rectangle of the screen: move the window to the origin, scale it, and move it to the viewport.",
    de: "Bildet einen Teil der Welt auf ein Rechteck des Bildschirms ab: Fenster in den Ursprung schieben, skalieren, in den Viewport schieben.",
  },
  equation: {
    en: "Draws a line by its equation: for each column, compute y and set the nearest pixel. Right, but with a multiplication and a rounding per pixel.",
    de: "Zeichnet eine Strecke nach ihrer Gleichung: je Spalte y ausrechnen und das nächste Pixel setzen. Richtig, aber mit Multiplikation und Rundung je Pixel.",
  },
  dda: {
    en: "Draws a line by adding the slope from column to column and rounding: one addition in place of a multiplication.",
    de: "Zeichnet eine Strecke, indem von Spalte zu Spalte die Steigung addiert und gerundet wird: eine Addition statt einer Multiplikation.",
  },
  bresenham: {
    en: "Draws a line with whole numbers only. The next pixel lies straight on or aslant; the sign of E says on which side of the middle between the two the line passes.",
    de: "Zeichnet eine Strecke nur mit ganzen Zahlen. Das nächste Pixel liegt geradeaus oder schräg; das Vorzeichen von E sagt, auf welcher Seite der Mitte zwischen beiden die Strecke verläuft.",
  },
  wu: {
    en: "Draws a smooth line: in each column the two pixels nearest to it share its darkness by their distance.",
    de: "Zeichnet eine glatte Linie: In jeder Spalte teilen sich die zwei nächsten Pixel die Schwärze nach ihrem Abstand.",
  },
  "midpoint-circle": {
    en: "Draws a circle with whole numbers: one eighth is computed like a line by Bresenham, and the rest mirrored.",
    de: "Zeichnet einen Kreis mit ganzen Zahlen: Ein Achtel wird wie eine Linie nach Bresenham berechnet, der Rest gespiegelt.",
  },
  "edge-table": {
    en: "Fills a polygon row by row. The edges that cross the row are kept sorted by x; between the first and the second, the third and the fourth … lies the inside.",
    de: "Füllt ein Polygon Zeile für Zeile. Die Kanten, die die Zeile kreuzen, bleiben nach x sortiert; zwischen der ersten und zweiten, der dritten und vierten … liegt das Innere.",
  },
  "ordered-edge-list": {
    en: "Fills a polygon by all crossings of its edges with rows, sorted by row and x, and taken in pairs.",
    de: "Füllt ein Polygon aus allen Schnittpunkten seiner Kanten mit den Zeilen, sortiert nach Zeile und x und paarweise genommen.",
  },
  "edge-fill": {
    en: "Fills a polygon without any sorting: each edge inverts all pixels to its right, and what is inverted an odd number of times is inside.",
    de: "Füllt ein Polygon ohne Sortieren: Jede Kante kehrt alle Pixel rechts von ihr um; was ungerade oft umgekehrt wurde, liegt innen.",
  },
  naive: {
    en: "Fills the area around a seed: a pixel is taken from a stack, coloured, and its neighbours of the old colour are put on the stack.",
    de: "Füllt die Fläche um einen Startpunkt: Ein Pixel kommt vom Stapel, wird gefärbt, und seine Nachbarn der alten Farbe kommen auf den Stapel.",
  },
  spans: {
    en: "Fills the area around a seed by whole runs of pixels, so that the stack stays short: one seed for each run above and below.",
    de: "Füllt die Fläche um einen Startpunkt in ganzen Strecken von Pixeln, damit der Stapel kurz bleibt: ein Startpunkt je Strecke darüber und darunter.",
  },
  "edge-function": {
    en: "Fills a triangle by three linear functions, one per edge: a pixel is inside where none of them is negative. Graphics hardware works this way.",
    de: "Füllt ein Dreieck mit drei linearen Funktionen, einer je Kante: Ein Pixel liegt innen, wo keine negativ ist. So arbeitet Grafikhardware.",
  },
  triangulate: {
    en: "Divides a polygon into triangles: a corner whose triangle contains no other vertex is an ear, and is cut off, until one triangle is left.",
    de: "Teilt ein Polygon in Dreiecke: Eine Ecke, deren Dreieck keine andere enthält, ist ein Ohr und wird abgeschnitten, bis ein Dreieck bleibt.",
  },
  gouraud: {
    en: "Shades a triangle smoothly: light is computed at its vertices, and the colours are interpolated between them.",
    de: "Schattiert ein Dreieck weich: Das Licht wird an den Ecken berechnet, dazwischen werden die Farben interpoliert.",
  },
  phong: {
    en: "Shades a triangle smoothly with highlights: normals are interpolated, and light is computed at each pixel.",
    de: "Schattiert ein Dreieck weich und mit Glanzlichtern: Normalen werden interpoliert, und das Licht wird in jedem Pixel berechnet.",
  },
  "shadow-map": {
    en: "The scene is seen from the light first, and its depths are kept. A point is in shadow if something lies nearer to the light there.",
    de: "Zuerst wird die Szene vom Licht aus gesehen, und die Tiefen werden behalten. Ein Punkt liegt im Schatten, wenn dort etwas näher am Licht ist.",
  },
  "back-face-removal": {
    en: "Faces of a closed body that point away from the eye cannot be seen: the sign of a dot product, or of an area on the screen, finds them.",
    de: "Flächen eines geschlossenen Körpers, die vom Auge weg zeigen, sieht man nicht: Das Vorzeichen eines Skalarprodukts oder einer Fläche im Bild findet sie.",
  },
  "z-buffer-loop": {
    en: "Draws surfaces in any order: each pixel remembers the depth of the nearest one so far, and a new one is drawn only where it is nearer.",
    de: "Zeichnet Flächen in beliebiger Reihenfolge: Jedes Pixel merkt sich die Tiefe der bisher nächsten, und eine neue wird nur gezeichnet, wo sie näher liegt.",
  },
  painter: {
    en: "Sorts faces from far to near and paints one over the other, as in oil. Simple, and wrong where faces overlap in a circle.",
    de: "Sortiert Flächen von fern nach nah und malt sie übereinander, wie in Öl. Einfach, und falsch, wo Flächen sich reihum überlappen.",
  },
  "depth-sort": {
    en: "Painter's order made right: before a face is painted, tests from cheap to costly make sure that it hides none behind it; else two are exchanged or one is cut.",
    de: "Die Reihenfolge des Malers, richtig gemacht: Bevor eine Fläche gemalt wird, sichern Tests von billig bis teuer, dass sie keine andere fälschlich verdeckt; sonst werden zwei vertauscht oder eine geteilt.",
  },
  "bsp-tree": {
    en: "The plane of a face divides all others into those before and behind it, again and again. Walking the tree gives the order from far to near for any eye.",
    de: "Die Ebene einer Fläche teilt alle anderen in die davor und dahinter, immer wieder. Der Gang durch den Baum ergibt für jedes Auge die Reihenfolge von fern nach nah.",
  },
  warnock: {
    en: "Looks at a window of the picture: if it is simple (empty, one face, one in front of all), it is drawn; else it is divided into four, down to single pixels.",
    de: "Betrachtet ein Fenster des Bildes: Ist es einfach (leer, eine Fläche, eine vor allen), wird es gezeichnet; sonst wird es in vier geteilt, bis hinab zu einzelnen Pixeln.",
  },
  "scan-line-z": {
    en: "Finds visible surfaces row by row, with the memory of one row of depths in place of a whole picture.",
    de: "Findet sichtbare Flächen Zeile für Zeile, mit dem Speicher für eine Zeile von Tiefen statt eines ganzen Bildes.",
  },
  ray: {
    en: "Sends a ray from the eye through each pixel and takes the nearest hit; from there further rays ask for shadows, mirrors and glass.",
    de: "Schickt vom Auge einen Strahl durch jedes Pixel und nimmt den nächsten Treffer; von dort fragen weitere Strahlen nach Schatten, Spiegeln und Glas.",
  },
  "hidden-line": {
    en: "Follows each edge and counts the faces in front of it: the number changes only where the edge passes a contour, and where it is 0 the edge is drawn.",
    de: "Verfolgt jede Kante und zählt die Flächen vor ihr: Die Zahl ändert sich nur, wo die Kante einen Umriss kreuzt, und wo sie 0 ist, wird gezeichnet.",
  },
  "horizon-curves": {
    en: "Draws a surface as curves from near to far: a curve is seen where it rises above all before it, or falls below them.",
    de: "Zeichnet eine Fläche als Kurven von nah nach fern: Eine Kurve ist sichtbar, wo sie über alle vor ihr steigt oder unter sie fällt.",
  },
};
