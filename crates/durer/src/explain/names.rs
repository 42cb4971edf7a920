//! German titles of algorithms and names of kinds of steps; English ones are those of the facts and templates.

use super::lesson::Lesson;
use super::words::{Template, Word};
use crate::info::Info;

/// Returns the title of an algorithm: in German that of the textbooks, or the English one where there is no other.
///
/// ```
/// use durer::explain::title;
/// use durer::visibility::surface::SurfaceMethod;
///
/// assert_eq!(title(SurfaceMethod::DepthSort.info()).de, "Tiefensortierung nach Newell, Newell und Sancha");
/// ```
pub fn title(info: &Info) -> Word {
    let en = info.title;
    Word::new(en, find(TITLES, en).unwrap_or(en))
}

impl Lesson {
    /// Returns the title of the algorithm, as [`title`] does.
    ///
    /// ```
    /// let lesson = durer::explain::lesson("back-face-removal")?;
    /// assert_eq!(lesson.title().de, "Entfernen von Rückseiten");
    /// # Ok::<(), durer::Error>(())
    /// ```
    pub fn title(&self) -> Word {
        title(self.info)
    }
}

impl Template {
    /// Returns the name of the kind of step, in words of each language.
    pub fn name(&self) -> Word {
        Word::new(self.kind, find(KINDS, self.kind).unwrap_or(self.kind))
    }
}

fn find(names: &[(&str, &'static str)], en: &str) -> Option<&'static str> {
    names.iter().find(|(own, _)| *own == en).map(|(_, de)| *de)
}

/// German titles by English ones, in the order of the pipeline; names of persons are the same in both.
const TITLES: &[(&str, &str)] = &[
    ("Bézier curves by de Casteljau's algorithm", "Bézierkurven nach de Casteljau"),
    ("B-splines by de Boor's algorithm", "B-Splines nach de Boor"),
    ("Knot insertion by Boehm's algorithm", "Knoteneinfügen nach Boehm"),
    ("Knot insertion by the Oslo algorithm", "Knoteneinfügen nach dem Oslo-Algorithmus"),
    ("Catmull–Rom spline", "Catmull-Rom-Spline"),
    ("Cubic curves by forward differences", "Kubische Kurven mit Vorwärtsdifferenzen"),
    ("Adaptive flattening", "Adaptives Begradigen"),
    ("Evaluators of Bézier patches", "Auswerter für Bézierflächen"),
    ("Midpoint subdivision", "Mittelpunkt-Unterteilung"),
    ("Homogeneous clipping", "Homogenes Clipping"),
    ("Attributes at new vertices", "Attribute an neuen Ecken"),
    ("Polylines against a polygon", "Polygonzüge an einem Polygon"),
    ("Liang–Barsky polygon clipping", "Polygon-Clipping nach Liang und Barsky"),
    ("Maillot polygon clipping", "Polygon-Clipping nach Maillot"),
    ("Circle clipping", "Clippen von Kreisen"),
    ("All-or-none string clipping", "Text-Clipping: ganze Zeichenkette oder nichts"),
    ("All-or-none character clipping", "Text-Clipping: ganzes Zeichen oder nichts"),
    ("Outline clipping of text", "Text-Clipping an den Umrissen"),
    ("Vatti's scan beams", "Vattis Scan-Beams"),
    ("Point in polygon by the winding number", "Punkt im Polygon durch die Windungszahl"),
    ("Overlay by snap rounding", "Verschneidung mit Snap-Rounding"),
    ("Validity of polygons by exact predicates", "Gültigkeit von Polygonen durch exakte Prädikate"),
    ("Rectangle clip", "Clippen am Rechteck"),
    ("Coverage simplification", "Vereinfachen von Flächennetzen"),
    (
        "Against six planes before the camera transform",
        "An sechs Ebenen vor der Kameratransformation",
    ),
    ("In clip space", "Im Clip-Raum"),
    ("After the division, the eye plane removed first", "Nach der Division, ohne die Augenebene"),
    ("In the viewport, in two dimensions", "Im Viewport, in zwei Dimensionen"),
    ("Per pixel: scissor, masks and depth range", "Je Pixel: Schere, Masken und Tiefenbereich"),
    ("Window–viewport transformation", "Window-Viewport-Transformation"),
    ("Several viewports on one screen", "Mehrere Viewports auf einem Schirm"),
    (
        "Picking in the view volume behind a rectangle or a point",
        "Picking im Sichtvolumen hinter einem Rechteck oder Punkt",
    ),
    ("Culling by bounding volumes", "Culling mit Hüllkörpern"),
    ("Sections with caps", "Schnitte mit Deckflächen"),
    ("Greedy label placement", "Gierige Beschriftung"),
    ("Pole of inaccessibility", "Pol der Unzugänglichkeit"),
    ("Forward warping with a z-buffer", "Vorwärts-Warping mit z-Buffer"),
    ("Equation of the line", "Geradengleichung"),
    ("Digital differential analyzer", "DDA-Algorithmus"),
    ("Bresenham's algorithm", "Bresenham-Algorithmus"),
    ("Run-slice line", "Linie in Läufen (Run-Slice)"),
    ("Double-step line", "Linie in Doppelschritten"),
    ("Wu's anti-aliased lines", "Geglättete Linien nach Wu"),
    ("Gupta–Sproull lines", "Geglättete Linien nach Gupta und Sproull"),
    ("Outlines of strokes", "Umrisse breiter Linien"),
    ("Thick and stippled lines on pixels", "Dicke und gestrichelte Linien in Pixeln"),
    ("Midpoint circle", "Mittelpunkt-Algorithmus für Kreise"),
    ("Midpoint ellipse", "Mittelpunkt-Algorithmus für Ellipsen"),
    ("Edge functions over the bounding box", "Kantenfunktionen im umschließenden Rechteck"),
    ("Edge walking by scan line", "Kantenlauf je Bildzeile"),
    ("Tiles with half-plane edge functions", "Kacheln mit Kantenfunktionen"),
    ("Points as squares of pixels", "Punkte als Quadrate aus Pixeln"),
    ("Points as smooth discs", "Punkte als geglättete Scheiben"),
    ("Edge table and active edge table", "Kantentabelle und Tabelle der aktiven Kanten"),
    ("Simple ordered edge list", "Einfache geordnete Kantenliste"),
    ("Edge fill", "Kantenfüllen (Edge Fill)"),
    ("Fence fill", "Zaunfüllen (Fence Fill)"),
    ("Edge flag", "Kantenmarken (Edge Flag)"),
    ("Coverage by cover and area in cells", "Überdeckung aus Cover und Area je Zelle"),
    ("Faces summed to full coverage", "Flächen, zu voller Überdeckung summiert"),
    ("Exact area coverage", "Exakte Flächenüberdeckung"),
    ("Triangulation by ear clipping", "Triangulierung durch Abschneiden von Ohren"),
    ("Seed fill with a stack of pixels", "Saatfüllen mit einem Stapel von Pixeln"),
    ("Seed fill by spans", "Saatfüllen nach Strecken"),
    ("Barycentric coordinates", "Baryzentrische Koordinaten"),
    ("Perspective-correct interpolation", "Perspektivisch richtige Interpolation"),
    ("Unlit", "Ohne Beleuchtung"),
    ("Flat shading", "Konstante Schattierung"),
    ("Gouraud shading", "Gouraud-Schattierung"),
    ("Phong shading", "Phong-Schattierung"),
    ("Metallic-roughness", "Metallisch-rau (Mikrofacetten)"),
    ("Texture sampling", "Abtasten von Texturen"),
    ("Mip maps", "Mip-Maps"),
    ("Shadow maps", "Schattenkarten"),
    ("Fragment operations", "Fragment-Operationen"),
    ("Floyd–Steinberg error diffusion", "Fehlerdiffusion nach Floyd und Steinberg"),
    ("Clustered-dot halftone", "Halbton mit Punktraster"),
    ("Display lists", "Displaylisten"),
    ("Depth cueing and fog", "Depth Cueing und Nebel"),
    ("Back-face removal", "Entfernen von Rückseiten"),
    ("Orientation of faces", "Orientierung von Flächen"),
    ("z-buffer", "z-Buffer"),
    ("A-buffer", "A-Buffer"),
    ("Scan-line z-buffer", "Bildzeilen-z-Buffer"),
    ("Spanning scan line", "Bildzeilenverfahren mit Strecken"),
    ("Newell–Newell–Sancha depth sort", "Tiefensortierung nach Newell, Newell und Sancha"),
    ("Warnock's area subdivision", "Flächenunterteilung nach Warnock"),
    ("Ray casting and tracing", "Strahlverfolgung"),
    ("z-buffer, the plain loop", "z-Buffer, die einfache Schleife"),
    ("Hierarchical z-buffer", "Hierarchischer z-Buffer"),
    ("A-buffer with shares by depth", "A-Buffer mit Anteilen nach Tiefe"),
    ("Painter's method", "Maleralgorithmus"),
    ("Binary space partition tree", "BSP-Baum"),
    (
        "Watkins' spanning scan line, with its tables",
        "Bildzeilenverfahren nach Watkins, mit seinen Tabellen",
    ),
    ("Cells and portals", "Zellen und Portale"),
    ("Scan lines for constructive solid geometry", "Bildzeilen für konstruktive Körpergeometrie"),
    ("Weiler–Atherton visible regions", "Sichtbare Gebiete nach Weiler und Atherton"),
    (
        "Hidden lines by quantitative invisibility",
        "Verdeckte Linien durch quantitative Unsichtbarkeit",
    ),
    ("Floating horizon", "Floating Horizon"),
    ("Floating horizon, curve by curve", "Floating Horizon, Kurve für Kurve"),
    ("Octree from front to back", "Octree von vorn nach hinten"),
    (
        "Newell–Newell–Sancha depth sort of polygons",
        "Tiefensortierung von Polygonen nach Newell, Newell und Sancha",
    ),
    ("Warnock's area subdivision of polygons", "Warnocks Flächenunterteilung mit Polygonen"),
    ("Roberts' algorithm", "Roberts-Algorithmus"),
    ("Catmull's subdivision of patches", "Catmulls Unterteilung gekrümmter Flächen"),
    ("Shadow volumes", "Schattenvolumen"),
    (
        "Appel's quantitative invisibility, carried along edges",
        "Appels quantitative Unsichtbarkeit, an Kanten weitergetragen",
    ),
    ("Galimberti and Montanari's hidden lines", "Verdeckte Linien nach Galimberti und Montanari"),
];

/// German names of kinds of steps.
const KINDS: &[(&str, &str)] = &[
    ("accepted", "angenommen"),
    ("active", "aktiv"),
    ("alpha", "Alpha"),
    ("apart", "getrennt"),
    ("arc", "Bogen"),
    ("area", "Fläche"),
    ("aslant", "schräg"),
    ("back", "zurück"),
    ("beam", "Scan-Beam"),
    ("begin", "Beginn"),
    ("between", "dazwischen"),
    ("bilinear", "bilinear"),
    ("black", "schwarz"),
    ("blend", "mischen"),
    ("blocked", "blockiert"),
    ("body", "Körper"),
    ("border", "Rand"),
    ("bound", "Schranke"),
    ("box", "Rechteck"),
    ("bridge", "Brücke"),
    ("called", "aufgerufen"),
    ("candidate", "Kandidat"),
    ("cap", "Deckfläche"),
    ("caster", "Schattenwerfer"),
    ("cell", "Zelle"),
    ("center", "Mitte"),
    ("chain", "Kette"),
    ("change", "Wechsel"),
    ("chord", "Sehne"),
    ("clear", "löschen"),
    ("code", "Code"),
    ("codes", "Codes"),
    ("columns", "Spalten"),
    ("compare", "vergleichen"),
    ("compared", "verglichen"),
    ("complement", "umkehren"),
    ("contours", "Konturen"),
    ("corner", "Ecke"),
    ("cross", "Durchgang"),
    ("crosses", "kreuzt"),
    ("crossing", "Schnittpunkt"),
    ("covered", "bedeckt"),
    ("crossing-rings", "gekreuzte Ringe"),
    ("cosines", "Kosinus"),
    ("count", "Zählung"),
    ("cut", "Schnitt"),
    ("depth", "Tiefe"),
    ("detail", "Detailstufe"),
    ("divide", "teilen"),
    ("diffuse", "diffus"),
    ("disc", "Scheibe"),
    ("distribution", "Verteilung"),
    ("divided", "geteilt"),
    ("draw", "zeichnen"),
    ("drop", "weglassen"),
    ("dropped", "weggelassen"),
    ("edge", "Kante"),
    ("edges", "Kanten"),
    ("empty", "leer"),
    ("end", "Ende"),
    ("ends", "Enden"),
    ("enter", "Eintritt"),
    ("event", "Ereignis"),
    ("executed", "ausgeführt"),
    ("face", "Fläche"),
    ("fill", "füllen"),
    ("flag", "Marke"),
    ("flat", "gerade genug"),
    ("flaw", "Fehler"),
    ("found", "gefunden"),
    ("fresnel", "Fresnel"),
    ("grid", "Gitter"),
    ("halved", "halbiert"),
    ("hidden", "verdeckt"),
    ("hiders", "Verdeckende"),
    ("horizon", "Horizont"),
    ("in-front", "davor"),
    ("inside", "innen"),
    ("keep", "behalten"),
    ("kept", "behalten"),
    ("last", "letztes"),
    ("leaf", "Blatt"),
    ("leave", "Austritt"),
    ("leave-out", "weglassen"),
    ("left-out", "weggelassen"),
    ("line", "Linie"),
    ("list", "Liste"),
    ("lit", "gesetzt"),
    ("listed", "aufgenommen"),
    ("look", "Blick"),
    ("lower", "unten"),
    ("minimum", "Minimum"),
    ("mixed", "gemischt"),
    ("more", "weitere"),
    ("move", "verschieben"),
    ("moved", "verschoben"),
    ("nearest", "nächstes"),
    ("node", "Knoten"),
    ("object", "Objekt"),
    ("octant", "Oktant"),
    ("open", "offen"),
    ("outside", "außen"),
    ("overlap", "Überlappung"),
    ("page", "Seite"),
    ("paint", "malen"),
    ("pair", "Paar"),
    ("part", "Teil"),
    ("passed", "bestanden"),
    ("piece", "Stück"),
    ("pixel", "Pixel"),
    ("place", "einordnen"),
    ("placed", "platziert"),
    ("plane", "Ebene"),
    ("point", "Punkt"),
    ("polygon", "Polygon"),
    ("polygon-done", "Polygon fertig"),
    ("portal", "Portal"),
    ("push", "ablegen"),
    ("ray", "Strahl"),
    ("reached", "erreicht"),
    ("recorded", "aufgezeichnet"),
    ("reflex", "einspringend"),
    ("refused", "verweigert"),
    ("region", "Gebiet"),
    ("rejected", "abgelehnt"),
    ("removed", "entfernt"),
    ("report", "Meldung"),
    ("returned", "zurückgekehrt"),
    ("ring", "Ring"),
    ("ring-done", "Ring fertig"),
    ("row", "Zeile"),
    ("rows", "Zeilen"),
    ("run", "Lauf"),
    ("sample", "Probe"),
    ("scissor", "Schere"),
    ("seen", "sichtbar"),
    ("self-hidden", "selbst verdeckt"),
    ("share", "Anteil"),
    ("side", "Seite"),
    ("simple", "einfach"),
    ("single", "einzeln"),
    ("skip", "überspringen"),
    ("sorted", "sortiert"),
    ("span", "Strecke"),
    ("split", "spalten"),
    ("square", "Quadrat"),
    ("start", "Anfang"),
    ("status", "Status"),
    ("steep", "steil"),
    ("stencil", "Schablone"),
    ("stopped", "beendet"),
    ("store", "speichern"),
    ("straight", "geradeaus"),
    ("sum", "Summe"),
    ("surrounded", "umgeben"),
    ("sweep", "Sweep"),
    ("table", "Tabelle"),
    ("tangent", "Tangente"),
    ("test", "Prüfung"),
    ("tested", "geprüft"),
    ("texel", "Texel"),
    ("tile", "Kachel"),
    ("torn", "zerrissen"),
    ("triangle", "Dreieck"),
    ("tried", "versucht"),
    ("turn", "Abbiegen"),
    ("vertex", "Ecke"),
    ("visibility", "Sichtbarkeit"),
    ("visible", "sichtbar"),
    ("visit", "besuchen"),
    ("volume", "Volumen"),
    ("weight", "Gewicht"),
    ("weights", "Gewichte"),
    ("white", "weiß"),
    ("wrapped", "Randmodus"),
    ("write", "schreiben"),
];

#[cfg(test)]
mod tests {
    use super::super::{ALGORITHMS, lessons};
    use super::*;

    #[test]
    fn kinds_have_german_names_and_titles_are_of_algorithms() {
        for lesson in lessons() {
            for template in lesson.templates {
                let found = find(KINDS, template.kind);
                assert!(found.is_some(), "{}: {} has no German name", lesson.name, template.kind);
            }
        }
        for (en, de) in TITLES {
            assert!(ALGORITHMS.iter().any(|info| info.title == *en), "no algorithm is “{en}”");
            assert!(!de.is_empty());
        }
    }
}
