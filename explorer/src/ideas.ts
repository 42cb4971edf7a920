// The idea of an algorithm in a sentence or two, for readers who see it for the first time.

import type { Words } from "./types";

export const IDEAS: Record<string, Words> = {
  "de-casteljau": {
    en: "A point of a Bézier curve is found by mixing neighbouring control points in one ratio, then the mixtures, until one point is left.",
    de: "Ein Punkt der Bézierkurve entsteht, indem man benachbarte Kontrollpunkte in einem Verhältnis mischt, dann die Mischungen, bis ein Punkt bleibt.",
  },
  "cohen-sutherland": {
    en: "Clips a line to a window. Four bits for each end tell which borders it is beyond; they accept or reject most lines at once, and the others are cut at one border after the other.",
    de: "Clippt eine Strecke an einem Fenster. Vier Bits je Ende sagen, jenseits welcher Ränder es liegt; die meisten Strecken sind damit sofort angenommen oder abgelehnt, die übrigen werden an einem Rand nach dem anderen geschnitten.",
  },
  midpoint: {
    en: "Clips a line to a window without a division: it is halved repeatedly, and the half that cannot contain the border is dropped.",
    de: "Clippt eine Strecke ohne Division: Sie wird immer wieder halbiert, und die Hälfte, die den Rand nicht enthalten kann, fällt weg.",
  },
  "cyrus-beck": {
    en: "Clips a line to any convex window. The line either enters or leaves each border; the part between the last entry and the first exit is visible.",
    de: "Clippt eine Strecke an einem konvexen Fenster. Jeder Rand wird von der Geraden betreten oder verlassen; sichtbar ist, was zwischen letztem Eintritt und erstem Austritt liegt.",
  },
  "liang-barsky": {
    en: "Clips a line to a window by its parameter alone: borders that it enters raise the lower bound, borders that it leaves lower the upper one. Only the resulting ends are computed.",
    de: "Clippt eine Strecke allein über ihren Parameter: Ränder, die sie betritt, heben die untere Schranke, die sie verlässt, senken die obere. Nur die übrigen Enden werden berechnet.",
  },
  "nicholl-lee-nicholl": {
    en: "Clips a line to a window with the fewest divisions: rays from its start through the corners divide the plane, and the region of its end determines the borders to cut.",
    de: "Clippt eine Strecke mit den wenigsten Divisionen: Strahlen vom Anfang durch die Ecken teilen die Ebene, und das Gebiet des Endes sagt, welche Ränder zu schneiden sind.",
  },
  "sutherland-hodgman": {
    en: "Clips a polygon to a window, one border at a time. Each border goes through the whole list of vertices, keeps those inside, and adds a vertex where an edge crosses it; its output is the input of the next.",
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
    en: "Simplifies a line: it keeps the point farthest from the chord if that is far enough, and does the same on both sides; all others are dropped.",
    de: "Vereinfacht eine Linie: Der Punkt, der am weitesten von der Sehne liegt, bleibt, wenn er weit genug weg ist, und beide Seiten werden ebenso behandelt; alle anderen fallen weg.",
  },
  "window-viewport": {
    en: "Maps a part of the world to a rectangle of the screen: move the window to the origin, scale it, and move it to the viewport.",
    de: "Bildet einen Teil der Welt auf ein Rechteck des Bildschirms ab: Fenster in den Ursprung schieben, skalieren, in den Viewport schieben.",
  },
  validity: {
    en: "Tells whether polygons are valid, and where not: edges are compared in pairs, then the points where rings touch, then the nesting of rings, all by exact signs.",
    de: "Sagt, ob Polygone gültig sind, und wo nicht: Kanten werden paarweise verglichen, dann die Punkte, in denen Ringe sich berühren, dann, was worin liegt, alles mit exakten Vorzeichen.",
  },
  "clip-attributes": {
    en: "Where clipping makes a new vertex, its colour, texture coordinate and normal are mixed by the same t as its position, before the division by w; mixed afterwards, by the place on the screen, they would be wrong.",
    de: "Wo das Clippen eine neue Ecke macht, werden Farbe, Texturkoordinate und Normale mit demselben t gemischt wie der Ort, vor der Division durch w; danach, nach dem Ort am Schirm, wären sie falsch.",
  },
  points: {
    en: "A point of size 1 lights the pixel that its centre is in; a larger one a square of pixels whose centre moves to the middle of a pixel or to a corner, as the size is odd or even.",
    de: "Ein Punkt der Größe 1 setzt das Pixel, in dem seine Mitte liegt, ein größerer ein Quadrat aus Pixeln, dessen Mitte in die Mitte eines Pixels oder auf eine Ecke rückt, je nachdem, ob die Größe ungerade oder gerade ist.",
  },
  "smooth-points": {
    en: "A disc keeps its place and its size: each pixel gets as much of it as the disc covers, so that it moves smoothly and small points become dim instead of vanishing.",
    de: "Eine Scheibe behält Ort und Größe: Jedes Pixel bekommt so viel, wie die Scheibe von ihm bedeckt. So bewegt sie sich stetig, und kleine Punkte werden blass statt zu verschwinden.",
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
    en: "Draws a line with whole numbers only. The next pixel is straight ahead or diagonal; the sign of E tells on which side of the midpoint between the two the line passes.",
    de: "Zeichnet eine Strecke nur mit ganzen Zahlen. Das nächste Pixel liegt geradeaus oder schräg; das Vorzeichen von E sagt, auf welcher Seite der Mitte zwischen beiden die Strecke verläuft.",
  },
  wu: {
    en: "Draws a smooth line: in each column the two pixels nearest to it share its darkness by their distance.",
    de: "Zeichnet eine glatte Linie: In jeder Spalte teilen sich die zwei nächsten Pixel die Schwärze nach ihrem Abstand.",
  },
  "midpoint-circle": {
    en: "Draws a circle with whole numbers: one eighth is computed as in Bresenham's line, and the rest is mirrored.",
    de: "Zeichnet einen Kreis mit ganzen Zahlen: Ein Achtel wird wie eine Linie nach Bresenham berechnet, der Rest gespiegelt.",
  },
  "edge-table": {
    en: "Fills a polygon row by row. The edges that cross the row are kept sorted by x; the inside is between the first and the second, the third and the fourth …",
    de: "Füllt ein Polygon Zeile für Zeile. Die Kanten, die die Zeile kreuzen, bleiben nach x sortiert; zwischen der ersten und zweiten, der dritten und vierten … liegt das Innere.",
  },
  "ordered-edge-list": {
    en: "Fills a polygon by all crossings of its edges with rows, sorted by row and x, and taken in pairs.",
    de: "Füllt ein Polygon aus allen Schnittpunkten seiner Kanten mit den Zeilen, sortiert nach Zeile und x und paarweise genommen.",
  },
  "edge-fill": {
    en: "Fills a polygon without any sorting: each edge inverts all pixels to its right, and pixels inverted an odd number of times are inside.",
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
    en: "The scene is first rendered from the light, and its depths are kept. A point is in shadow if something there is nearer to the light.",
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
    en: "Sorts faces from far to near and paints one over the other, as in oil. Simple, but wrong where faces overlap cyclically.",
    de: "Sortiert Flächen von fern nach nah und malt sie übereinander, wie in Öl. Einfach, und falsch, wo Flächen sich reihum überlappen.",
  },
  "depth-sort": {
    en: "Painter's order made right: before a face is painted, tests from cheap to costly make sure that it hides none behind it; else two are exchanged or one is cut.",
    de: "Die Reihenfolge des Malers, richtig gemacht: Bevor eine Fläche gemalt wird, sichern Tests von billig bis teuer, dass sie keine andere fälschlich verdeckt; sonst werden zwei vertauscht oder eine geteilt.",
  },
  "bsp-tree": {
    en: "The plane of a face divides all others into those in front of it and those behind it, recursively. Walking the tree gives the order from far to near for any eye.",
    de: "Die Ebene einer Fläche teilt alle anderen in die davor und dahinter, immer wieder. Der Gang durch den Baum ergibt für jedes Auge die Reihenfolge von fern nach nah.",
  },
  warnock: {
    en: "Examines a window of the picture: if it is simple (empty, one face, one in front of all), it is drawn; else it is divided into four, down to single pixels.",
    de: "Betrachtet ein Fenster des Bildes: Ist es einfach (leer, eine Fläche, eine vor allen), wird es gezeichnet; sonst wird es in vier geteilt, bis hinab zu einzelnen Pixeln.",
  },
  "scan-line-z": {
    en: "Finds visible surfaces row by row, with memory for one row of depths instead of a whole picture.",
    de: "Findet sichtbare Flächen Zeile für Zeile, mit dem Speicher für eine Zeile von Tiefen statt eines ganzen Bildes.",
  },
  ray: {
    en: "Sends a ray from the eye through each pixel and takes the nearest hit; further rays from there find shadows, mirrors and glass.",
    de: "Schickt vom Auge einen Strahl durch jedes Pixel und nimmt den nächsten Treffer; von dort fragen weitere Strahlen nach Schatten, Spiegeln und Glas.",
  },
  "hidden-line": {
    en: "Follows each edge and counts the faces in front of it: the number changes only where the edge passes a contour, and where it is 0 the edge is drawn.",
    de: "Verfolgt jede Kante und zählt die Flächen vor ihr: Die Zahl ändert sich nur, wo die Kante einen Umriss kreuzt, und wo sie 0 ist, wird gezeichnet.",
  },
  "horizon-curves": {
    en: "Draws a surface as curves from near to far: a curve is visible where it rises above all curves in front of it, or falls below them.",
    de: "Zeichnet eine Fläche als Kurven von nah nach fern: Eine Kurve ist sichtbar, wo sie über alle vor ihr steigt oder unter sie fällt.",
  },
  "de-boor": {
    en: "A point of a B-spline is found like one of a Bézier curve, by mixing control points that are neighbours; the ratios follow from the knots, and only the few points that influence the curve there take part.",
    de: "Ein Punkt einer B-Spline-Kurve entsteht wie bei Bézier durch Mischen benachbarter Kontrollpunkte; die Verhältnisse folgen aus den Knoten, und nur die wenigen Punkte, die dort wirken, nehmen teil.",
  },
  boehm: {
    en: "Adds a knot to a B-spline without changing the curve: the control points near it are replaced by mixtures of neighbours, one more than before.",
    de: "Fügt einer B-Spline-Kurve einen Knoten hinzu, ohne sie zu ändern: Die Kontrollpunkte in der Nähe werden durch Mischungen von Nachbarn ersetzt, einer mehr als zuvor.",
  },
  oslo: {
    en: "Adds many knots to a B-spline at once: each new control point is computed separately from the old ones, by a recursion over the degree.",
    de: "Fügt einer B-Spline-Kurve viele Knoten auf einmal hinzu: Jeder neue Kontrollpunkt wird für sich aus den alten berechnet, rekursiv über den Grad.",
  },
  "catmull-rom": {
    en: "A curve through all its points: the direction at each point is that from its predecessor to its successor.",
    de: "Eine Kurve durch alle ihre Punkte: Die Richtung an jedem Punkt ist die vom Vorgänger zum Nachfolger.",
  },
  "forward-differences": {
    en: "Points of a cubic curve at equal steps of its parameter take three additions each: the differences of the differences stay constant.",
    de: "Punkte einer kubischen Kurve in gleichen Schritten des Parameters kosten je drei Additionen: Die Differenzen der Differenzen bleiben gleich.",
  },
  flatten: {
    en: "A curve becomes a chain of lines: where it is farther from its chord than allowed, it is divided, and the halves are tested again.",
    de: "Eine Kurve wird zum Streckenzug: Wo sie weiter von ihrer Sehne liegt als erlaubt, wird sie geteilt, und die Hälften werden wieder geprüft.",
  },
  evaluator: {
    en: "Computes vertices of a Bézier patch on a grid of parameters, as OpenGL's evaluators do.",
    de: "Berechnet Ecken einer Bézierfläche auf einem Gitter von Parametern, wie die Auswerter von OpenGL.",
  },
  skala: {
    en: "Clips a line to a convex window in homogeneous coordinates: the signs of the corners, that is, their sides of the line, determine the two borders that it crosses, before any division.",
    de: "Clippt eine Strecke an einem konvexen Fenster in homogenen Koordinaten: Die Vorzeichen der Ecken neben der Geraden sagen, welche zwei Ränder sie kreuzt, bevor etwas dividiert wird.",
  },
  "csg-scan-line": {
    en: "Draws the union, intersection or difference of solids without computing it: along each span of a row the faces are passed from front to back, and the first one behind which the expression holds is visible.",
    de: "Zeichnet Vereinigung, Schnitt oder Differenz von Körpern, ohne sie zu berechnen: In jeder Strecke einer Zeile geht man die Flächen von vorn nach hinten durch, und die erste, hinter der der Ausdruck gilt, ist zu sehen.",
  },
  portals: {
    en: "Rooms are drawn only through the doors through which they are visible: the rectangle around each door is intersected with the window on the way, and an empty one ends it.",
    de: "Räume werden nur durch die Türen gezeichnet, durch die man sie sieht: Das Rechteck um jede Tür wird mit dem Fenster auf dem Weg geschnitten, und ist es leer, endet er.",
  },
  "bounding-volumes": {
    en: "Accepts or rejects whole objects by simple bodies around them: a box outside one plane of the view volume is not drawn, one inside all planes needs no clipping.",
    de: "Entscheidet ganze Objekte an einfachen Hüllen: Ein Kasten außerhalb einer Ebene des Sichtvolumens wird nicht gezeichnet, einer innerhalb aller Ebenen braucht kein Clipping.",
  },
  section: {
    en: "Cuts a body open at a plane: triangles are kept, dropped or divided, and the new edges form loops that are filled by a cap, so that the body stays closed.",
    de: "Schneidet einen Körper an einer Ebene auf: Dreiecke bleiben, fallen weg oder werden geteilt, und die neuen Kanten bilden Schleifen, die eine Deckfläche füllt, damit der Körper geschlossen bleibt.",
  },
  "greedy-labels": {
    en: "Places labels in the order of their importance: each takes the first of its places that overlaps nothing, or is left out.",
    de: "Setzt Beschriftungen in der Reihenfolge ihrer Wichtigkeit: Jede nimmt den ersten ihrer Plätze, der nichts überlappt, oder entfällt.",
  },
  unlit: {
    en: "The unchanged colour of the texture, without any light: for models whose textures were photographed with their light.",
    de: "Die Farbe der Textur, wie sie ist, ohne jedes Licht: für Modelle, deren Texturen mit ihrem Licht fotografiert wurden.",
  },
  "metallic-roughness": {
    en: "A rough surface is made of tiny mirrors: how many face the half-way direction, how many of these are seen, and how much each mirrors give the highlight; in plastics the light that enters comes back in all directions.",
    de: "Eine raue Fläche besteht aus winzigen Spiegeln: Wie viele nach der Mittelrichtung zeigen, wie viele davon zu sehen sind und wie viel jeder spiegelt, ergibt das Glanzlicht; bei Kunststoff kommt eingedrungenes Licht nach allen Seiten zurück.",
  },
  "viewport-layout": {
    en: "Divides a screen into viewports, row by row, by whole pixels: none belongs to two viewports, and none is left over.",
    de: "Teilt einen Schirm zeilenweise in Viewports, in ganzen Pixeln: Keines gehört zu zweien, und keines bleibt übrig.",
  },
  "texture-sampling": {
    en: "Looks up the value of an image at (u, v): the wrap mode brings the coordinates into the image, then the nearest texel is taken, or four are averaged.",
    de: "Schlägt den Wert eines Bildes bei (u; v) nach: Der Randmodus bringt die Koordinaten ins Bild, dann zählt das nächste Texel, oder vier werden gemittelt.",
  },
  "mip-map": {
    en: "Keeps the image in ever smaller sizes and takes, for each pixel, the two sizes whose texels are about as large as the pixel, so that distant textures do not flicker.",
    de: "Hält das Bild in immer kleineren Größen bereit und nimmt je Pixel die beiden, deren Texel etwa so groß sind wie das Pixel; so flimmern ferne Texturen nicht.",
  },
  "display-lists": {
    en: "Records commands once and calls them often, with another matrix each time: a wheel is recorded once and drawn four times.",
    de: "Zeichnet Befehle einmal auf und ruft sie oft auf, jedes Mal mit einer anderen Matrix: Ein Rad wird einmal aufgezeichnet und viermal gezeichnet.",
  },
  fog: {
    en: "Distant surfaces are mixed with the colour of the air: in proportion between two distances, or by an exponential law.",
    de: "Was weiter weg ist, wird mit der Farbe der Luft gemischt: proportional zwischen zwei Entfernungen oder nach einem Exponentialgesetz.",
  },
  "circle-clipping": {
    en: "Clips a circle to a window: each border takes away the arc that is beyond it, and the angles that are left are the visible arcs.",
    de: "Clippt einen Kreis an einem Fenster: Jeder Rand nimmt den Bogen weg, der jenseits von ihm liegt, und die übrigen Winkel sind die sichtbaren Bögen.",
  },
  "text-by-string": {
    en: "Keeps a text only if the box around all of it is within the window: one comparison, and no label is ever cut.",
    de: "Behält einen Text nur, wenn der Kasten um den ganzen Text im Fenster liegt: ein Vergleich, und keine Beschriftung wird zerschnitten.",
  },
  "text-by-character": {
    en: "Keeps the characters whose boxes are within the window, and drops all that cross its border.",
    de: "Behält die Zeichen, deren Kästen im Fenster liegen, und lässt alle weg, die seinen Rand kreuzen.",
  },
  "text-by-outline": {
    en: "Clips the strokes and rings of those characters whose boxes cross the border, as line segments and as polygons.",
    de: "Clippt die Striche und Ringe der Zeichen, deren Kästen den Rand kreuzen, als Strecken und als Polygone.",
  },
  "sobkow-pospisil-yang": {
    en: "Clips a line to a window by the codes of both ends in one number: a table has a case for each of the 81 pairs of regions, which names exactly the necessary cuts.",
    de: "Clippt eine Strecke an einem Fenster mit den Codes beider Enden in einer Zahl: Eine Tabelle hat für jedes der 81 Paare von Gebieten einen Fall, der die Schnitte nennt und keine anderen.",
  },
  homogeneous: {
    en: "Clips a line before the perspective division, by six borders that are inequalities of x, y, z and w: points behind the eye are no problem.",
    de: "Clippt eine Strecke vor der perspektivischen Division, an sechs Rändern, die Ungleichungen in x, y, z und w sind: Punkte hinter dem Auge stören nicht.",
  },
  polyline: {
    en: "Cuts a chain of lines at the border of a polygon and keeps the parts inside, or those outside.",
    de: "Schneidet einen Streckenzug am Rand eines Polygons und behält die Teile innen oder außen.",
  },
  "bentley-ottmann": {
    en: "Finds all crossings of segments with a line that sweeps over them: only segments that are neighbours on that line can cross next, so few pairs are tested.",
    de: "Findet alle Schnittpunkte von Strecken mit einer Geraden, die über sie hinwegstreicht: Nur Nachbarn auf ihr können sich als Nächste kreuzen, also werden wenige Paare geprüft.",
  },
  maillot: {
    en: "Clips a polygon to a window edge by edge, with Cohen and Sutherland's codes and one bit more for corners: the codes of an edge's ends determine the corners around which the border must turn.",
    de: "Clippt ein Polygon Kante für Kante an einem Fenster, mit den Codes von Cohen und Sutherland und einem Bit mehr für Ecken: Die Codes der Enden einer Kante sagen, um welche Ecken der Rand gehen muss.",
  },
  "liang-barsky-polygon": {
    en: "Clips a polygon to a window in one pass: each edge emits its visible part, and corners of the window where the polygon turns around them.",
    de: "Clippt ein Polygon in einem Durchgang an einem Fenster: Jede Kante gibt aus, was von ihr sichtbar ist, und Ecken des Fensters, wo das Polygon um sie herumgeht.",
  },
  "scan-beams": {
    en: "Clips any polygons: between the heights of all vertices and crossings there are beams in which edges do not cross; each beam is filled by trapezoids.",
    de: "Clippt beliebige Polygone: Zwischen den Höhen aller Ecken und Schnittpunkte liegen Streifen, in denen Kanten nur nebeneinander laufen; jeder wird mit Trapezen gefüllt.",
  },
  overlay: {
    en: "Combines any two sets of polygons robustly: all edges are divided where they meet, points are snapped to a grid, and winding numbers determine the result.",
    de: "Verschneidet zwei beliebige Mengen von Polygonen robust: Alle Kanten werden an ihren Treffpunkten geteilt, Punkte auf ein Gitter gerundet, und Windungszahlen entscheiden, was zum Ergebnis gehört.",
  },
  rectangle: {
    en: "Clips a polygon to a rectangle in a single walk around it: chains inside are joined along the border of the window.",
    de: "Clippt ein Polygon an einem Rechteck in der Zeit eines Umlaufs: Die Stücke im Inneren werden entlang des Fensterrands verbunden.",
  },
  "point-in-polygon": {
    en: "Counts how often a polygon goes around a point: edges that cross a ray from it upwards count +1, downwards −1.",
    de: "Zählt, wie oft ein Polygon um einen Punkt läuft: Kanten, die einen Strahl von ihm aus nach oben kreuzen, zählen +1, nach unten −1.",
  },
  visvalingam: {
    en: "Simplifies a line by repeatedly dropping the vertex whose triangle with its neighbours has the smallest area.",
    de: "Vereinfacht eine Linie, indem immer wieder die Ecke wegfällt, deren Dreieck mit ihren Nachbarn die kleinste Fläche hat.",
  },
  coverage: {
    en: "Simplifies areas that share borders so that they still share them: each border is simplified once.",
    de: "Vereinfacht Flächen mit gemeinsamen Grenzen so, dass sie gemeinsam bleiben: Jede Grenze wird einmal vereinfacht.",
  },
  "interior-point": {
    en: "Finds the point of a polygon that is farthest from its border, for a label: cells are divided where they may contain a better one.",
    de: "Findet den Punkt eines Polygons, der am weitesten vom Rand liegt, für eine Beschriftung: Zellen werden geteilt, wo sie einen besseren enthalten können.",
  },
  "run-slice": {
    en: "Draws Bresenham's line run by run: a flat line has long rows of pixels, and one division gives the length of each.",
    de: "Zeichnet Bresenhams Linie Lauf um Lauf: Eine flache Linie hat lange Reihen von Pixeln, und eine Division sagt, wie lang jede ist.",
  },
  "double-step": {
    en: "Draws Bresenham's line two pixels at a time: one test chooses among the four possible patterns of two steps.",
    de: "Zeichnet Bresenhams Linie zwei Pixel auf einmal: Unter den vier Mustern, die zwei Schritte haben können, wählt ein Test.",
  },
  "gupta-sproull": {
    en: "Draws a smooth line: the intensity of a pixel follows from its distance to the line, by a table.",
    de: "Zeichnet eine geglättete Linie: Die Helligkeit eines Pixels folgt aus seinem Abstand zur Linie, nach einer Tabelle.",
  },
  "line-pattern": {
    en: "Draws dashed lines on pixels: a pattern of bits is read step by step and continues around corners.",
    de: "Zeichnet gestrichelte Linien auf Pixeln: Ein Muster aus Bits wird Schritt um Schritt gelesen und läuft um Ecken weiter.",
  },
  stroke: {
    en: "Turns a wide line into an area: an outline of its sides, joins at the corners, and caps at the ends.",
    de: "Macht aus einer breiten Linie eine Fläche: ein Umriss aus ihren Seiten, Verbindungen an den Ecken und Abschlüssen an den Enden.",
  },
  "midpoint-ellipse": {
    en: "Draws an ellipse with integers: a decision at the midpoint between two candidates chooses each pixel, first where the slope is flat, then where it is steep.",
    de: "Zeichnet eine Ellipse mit ganzen Zahlen: Eine Entscheidung am Mittelpunkt zwischen zwei Kandidaten wählt jedes Pixel, erst im flachen, dann im steilen Teil.",
  },
  "fence-fill": {
    en: "Fills a polygon by inverting, for each edge, the pixels between it and a fence; pixels inverted an odd number of times are inside.",
    de: "Füllt ein Polygon, indem für jede Kante die Pixel zwischen ihr und einem Zaun umgekehrt werden; was ungerade oft umgekehrt wurde, liegt innen.",
  },
  "edge-flag": {
    en: "Fills a polygon in two passes: the pixels of its edges are flagged, then each row is read, and every flag switches between inside and outside.",
    de: "Füllt ein Polygon in zwei Durchgängen: Die Pixel der Kanten werden markiert, dann wird jede Zeile gelesen, und jede Marke wechselt zwischen innen und außen.",
  },
  "edge-walking": {
    en: "Fills a triangle row by row: two edges are followed downwards, and the pixels between them are set.",
    de: "Füllt ein Dreieck Zeile um Zeile: Zwei Kanten werden nach unten verfolgt, und die Pixel dazwischen gesetzt.",
  },
  tiles: {
    en: "Fills a triangle by blocks of pixels: the edge functions, at one corner each, show whether a block is outside, inside, or must be divided.",
    de: "Füllt ein Dreieck in Blöcken: Ein Block liegt außen, innen oder wird geteilt, nach den Kantenfunktionen an je einer Ecke.",
  },
  "cell-sums": {
    en: "Computes the exact share of each pixel that an area covers: edges add their heights and areas to the cells that they cross, and a sum along each row gives the coverage.",
    de: "Berechnet genau, wie viel eine Fläche von jedem Pixel bedeckt: Kanten hinterlassen Höhe und Fläche in den Zellen, die sie kreuzen, und die Summe entlang der Zeile ergibt die Bedeckung.",
  },
  partition: {
    en: "Faces that share edges leave no seam between them: each adds its colour to a pixel by its exact area there, and the sum is divided by the area of all.",
    de: "Flächen mit gemeinsamen Kanten lassen keine Naht: Jede trägt ihre Farbe mit ihrer genauen Fläche im Pixel bei, und die Summe wird durch die Fläche aller geteilt.",
  },
  "floyd-steinberg": {
    en: "Shows greys with black and white: the error of each pixel is passed on to neighbours not yet processed.",
    de: "Zeigt Grau mit Schwarz und Weiß: Der Fehler jedes Pixels wird an die Nachbarn weitergegeben, die noch kommen.",
  },
  "clustered-dot": {
    en: "Shows greys with black and white by dots that grow with the darkness, as in print.",
    de: "Zeigt Grau mit Schwarz und Weiß durch Punkte, die mit der Dunkelheit wachsen, wie im Druck.",
  },
  "homogeneous-volume": {
    en: "Clips polygons in space before the perspective division, border after border.",
    de: "Clippt Polygone im Raum vor der perspektivischen Division, Rand um Rand.",
  },
  world: {
    en: "Clips against the six planes of the view before the camera's transformation: planes are moved to the objects, not objects to the planes.",
    de: "Clippt an den sechs Ebenen der Sicht vor der Kameratransformation: Die Ebenen kommen zu den Objekten, nicht umgekehrt.",
  },
  "clip-space": {
    en: "Clips after the projection, before the division: all six borders are simple inequalities there.",
    de: "Clippt nach der Projektion, vor der Division: Dort sind alle sechs Ränder einfache Ungleichungen.",
  },
  "after-division": {
    en: "Clips after the division, to a cube; parts behind the eye must be removed before.",
    de: "Clippt nach der Division, an einem Würfel; was hinter dem Auge liegt, muss vorher weg.",
  },
  viewport: {
    en: "Clips as the last step, in two dimensions, to the window on the screen.",
    de: "Clippt ganz zuletzt, in zwei Dimensionen, am Fenster auf dem Bildschirm.",
  },
  "per-pixel": {
    en: "Does not clip at all: each pixel is tested when it is written.",
    de: "Clippt gar nicht: Jedes Pixel wird geprüft, wenn es geschrieben wird.",
  },
  pick: {
    en: "Finds the objects under a point or in a rectangle of the picture: objects are clipped to the small view volume behind it.",
    de: "Findet, was unter einem Punkt oder in einem Rechteck des Bildes liegt: Objekte werden am kleinen Sichtvolumen dahinter geclippt.",
  },
  "forward-warp": {
    en: "Makes the picture of a nearby camera from a picture with depths: each pixel is moved to its new place, the nearest one wins, and holes remain where nothing was known.",
    de: "Macht aus einem Bild mit Tiefen das einer nahen Kamera: Jedes Pixel wandert an seinen neuen Ort, das nächste gewinnt, und Löcher bleiben, wo nichts bekannt war.",
  },
  barycentric: {
    en: "Three weights describe the position of a point in a triangle; values at the corners are mixed by them.",
    de: "Drei Gewichte sagen, wo ein Punkt im Dreieck liegt; mit ihnen wird gemischt, was an den Ecken bekannt ist.",
  },
  flat: {
    en: "One colour for each face: light is computed once, with the normal of the face.",
    de: "Eine Farbe je Fläche: Das Licht wird einmal berechnet, mit der Normalen der Fläche.",
  },
  "perspective-correct": {
    en: "Values on a surface do not change evenly across the screen: value/w and 1/w do, so these are interpolated and divided at each pixel.",
    de: "Werte auf einer Fläche ändern sich auf dem Bildschirm nicht gleichmäßig, Wert/w und 1/w aber schon: Sie werden interpoliert und an jedem Pixel dividiert.",
  },
  "fragment-operations": {
    en: "The operations on a fragment before it becomes a pixel: scissor, alpha, stencil and depth tests, blending, and masks, in this order.",
    de: "Was mit einem Fragment geschieht, bevor es ein Pixel wird: Scissor-, Alpha-, Stencil- und Tiefentest, Mischen und Masken, in dieser Reihenfolge.",
  },
  orientation: {
    en: "Makes all faces of a body face outwards: neighbours are oriented alike across their common edges, and the volume tells whether all must be turned.",
    de: "Lässt alle Flächen eines Körpers nach außen zeigen: Nachbarn werden über gemeinsame Kanten gleich gerichtet, und das Volumen sagt, ob alle zu wenden sind.",
  },
  "hierarchical-z-buffer": {
    en: "A z-buffer with a pyramid of farthest depths above it: boxes behind a cell of the pyramid are skipped with all faces in them.",
    de: "Ein z-Puffer mit einer Pyramide der größten Tiefen darüber: Kästen, die hinter einer Zelle der Pyramide liegen, fallen mit all ihren Flächen weg.",
  },
  octree: {
    en: "Space is divided into boxes, which are visited from front to back: a filled pixel is finished, and boxes behind filled pixels are skipped.",
    de: "Der Raum wird in Kästen geteilt, die von vorn nach hinten besucht werden: Ein gefülltes Pixel braucht nichts mehr, und Kästen hinter gefüllten Pixeln fallen weg.",
  },
  watkins: {
    en: "Goes through the picture row by row, and through a row span by span: depths are compared once for each span, not at each pixel.",
    de: "Geht das Bild Zeile um Zeile durch und jede Zeile Abschnitt um Abschnitt: Tiefen werden je Abschnitt verglichen, nicht je Pixel.",
  },
  "a-buffer-shares": {
    en: "Keeps a list of fragments for each pixel, each with a mask of the sub-pixels that it covers, and divides the pixel among them from the nearest to the farthest.",
    de: "Hält für jedes Pixel eine Liste von Fragmenten mit Masken dessen, was sie bedecken, und teilt die Farbe des Pixels vom nächsten zum fernsten auf.",
  },
  "area-sorting": {
    en: "Finds visible areas exactly: the picture is cut along the nearest polygon, everything behind it is removed, and the rest is treated in the same way.",
    de: "Findet sichtbare Flächen genau: Das Bild wird entlang des nächsten Polygons geschnitten, was dahinter liegt, fällt weg, und der Rest wird ebenso behandelt.",
  },
  roberts: {
    en: "The first exact hidden lines, for convex bodies: a line is hidden where a ray from it to the eye passes through a body, which is decided by inequalities of its planes.",
    de: "Die ersten exakten verdeckten Linien, für konvexe Körper: Eine Linie ist verdeckt, wo ein Strahl von ihr zum Auge im Inneren eines Körpers läuft; das entscheiden Ungleichungen seiner Ebenen.",
  },
  "shadow-volumes": {
    en: "Behind everything that the light hits there is a volume without light: a point is in shadow if the ray from the eye enters more of these volumes before it than it leaves.",
    de: "Hinter allem, was das Licht trifft, liegt ein Volumen ohne Licht: Ein Punkt ist im Schatten, wenn der Strahl vom Auge vor ihm mehr solche Volumen betritt als verlässt.",
  },
  "patch-subdivision": {
    en: "A curved patch is divided into quarters, and these again, until each piece covers at most one pixel's centre; the z-buffer keeps the nearest.",
    de: "Ein gekrümmtes Flächenstück wird geviertelt und weiter geviertelt, bis jedes Stück höchstens eine Pixelmitte bedeckt; der z-Puffer behält das nächste.",
  },
  appel: {
    en: "The number of faces that hide a point changes only behind contour edges: it is counted at one corner by a ray, and all others follow along the edges.",
    de: "Wie viele Flächen einen Punkt verdecken, ändert sich nur hinter Konturkanten: Eine Ecke wird mit einem Strahl ausgezählt, alle anderen folgen entlang der Kanten.",
  },
  "galimberti-montanari": {
    en: "Every part of an edge knows the set of faces that hide it: faces enter and leave the set where the edge passes their borders, and a part is visible if its set is empty.",
    de: "Jedes Stück einer Kante kennt die Menge der Flächen, die es verdecken: Flächen kommen und gehen, wo die Kante ihre Ränder passiert, und sichtbar ist ein Stück mit leerer Menge.",
  },
};
