//! Sheets as DXF for CAD: AutoCAD 2004 (AC1018), the first version with colours beyond the palette;
//! what reads DXF 2000 reads it.
//!
//! Model space in millimetres, y up, the origin in the lower left corner of the sheet. Each layer of the
//! sheet is one with a colour, a line weight and a line type, CONTINUOUS, HIDDEN or CENTER; polylines are
//! LWPOLYLINE, curves are LINE, ARC, CIRCLE, ELLIPSE and SPLINE, or LWPOLYLINE too, dots are CIRCLE, text is TEXT, dimensions are
//! DIMENSION with their blocks, areas are HATCH with solid fill.
//!
//! Written from Autodesk's *DXF Reference* (2004).

use super::dxf_curve;
use super::dxf_dimension::Dimensions;
use super::number::push;
use crate::Result;
use durer::math::DVec2;
use durer::target::Curve;
use durer::target::drawing::Anchor;
use durer::target::sheet::{Mark, Pen, Sheet, SheetLayer};
use std::io::Write;

/// The line weights that the format has, in hundredths of a millimetre.
const WEIGHTS: &[i64] = &[
    0, 5, 9, 13, 15, 18, 20, 25, 30, 35, 40, 50, 53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200,
    211,
];

/// Handles of objects that others refer to.
const BLOCK_RECORDS: u32 = 0x1;
const LAYERS: u32 = 0x2;
const STYLES: u32 = 0x3;
const LTYPES: u32 = 0x5;
const VIEWS: u32 = 0x6;
const UCSS: u32 = 0x7;
const VPORTS: u32 = 0x8;
const APPIDS: u32 = 0x9;
pub(super) const DIMSTYLES: u32 = 0xa;
const ROOT: u32 = 0xc;
const GROUPS: u32 = 0xd;
const MODEL: u32 = 0x1f;
const PAPER: u32 = 0x1b;
/// From here on handles are given out in order.
const FIRST: u32 = 0x30;

/// Entity type of strokes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DxfStrokes {
    /// LWPOLYLINE throughout, arcs as bulges; ellipses and cubic curves as arcs within 0.005 mm.
    #[default]
    Polylines,
    /// LINE, ARC, CIRCLE, ELLIPSE and SPLINE, a piece each; several lines in a row are one LWPOLYLINE.
    Pieces,
}

/// Writes a sheet as an ASCII DXF file, encoded in the ANSI code page with `\U+XXXX` for what is not ASCII.
///
/// # Errors
/// [`crate::Error::Io`] where writing fails.
pub fn write(out: &mut impl Write, sheet: &Sheet, strokes: DxfStrokes) -> Result<()> {
    let mut body = Tags { text: String::new(), next: FIRST, owner: MODEL, line_type: CONTINUOUS };
    let dimensions = Dimensions::of(&mut body, sheet, strokes);
    tables(&mut body, sheet, &dimensions);
    blocks(&mut body, sheet, &dimensions);
    let mut numbers = 0..;
    body.section("ENTITIES");
    for layer in &sheet.layers {
        let name = symbol(&layer.name);
        body.line_type = line_type(layer_pen(sheet, layer));
        for mark in &layer.marks {
            match mark {
                Mark::Dimension(dimension) => {
                    let number = numbers.next().unwrap_or_default();
                    dimensions.write(&mut body, sheet, &name, dimension, number);
                }
                _ => entity(&mut body, sheet, &name, mark, strokes),
            }
        }
    }
    body.tag(0, "ENDSEC");
    objects(&mut body);
    body.tag(0, "EOF");
    let mut head = Tags { text: String::new(), next: 0, owner: MODEL, line_type: CONTINUOUS };
    header(&mut head, sheet, &dimensions, body.next);
    out.write_all(head.text.as_bytes())?;
    out.write_all(body.text.as_bytes())?;
    Ok(())
}

/// Group codes and values, a line each.
pub(super) struct Tags {
    text: String,
    /// The next free handle.
    next: u32,
    /// The block record that entities belong to.
    owner: u32,
    /// The line type of the layer.
    line_type: &'static str,
}

impl Tags {
    pub fn tag(&mut self, code: u16, value: &str) -> &mut Self {
        self.text += &format!("{code:>3}\n{value}\n");
        self
    }

    pub fn int(&mut self, code: u16, value: i64) -> &mut Self {
        self.tag(code, &value.to_string())
    }

    pub fn handle(&mut self, code: u16, value: u32) -> &mut Self {
        self.tag(code, &format!("{value:X}"))
    }

    /// Returns a real number; micrometres are the last digits.
    pub fn real(&mut self, code: u16, value: f64) -> &mut Self {
        self.precise(code, value, 6)
    }

    /// Returns a real number with so many digits after the point.
    pub fn precise(&mut self, code: u16, value: f64, digits: usize) -> &mut Self {
        let mut text = String::new();
        push(&mut text, value, digits);
        // Readers want the zero before the point, and some the point.
        let text = match (text.strip_prefix('.'), text.strip_prefix("-.")) {
            (Some(rest), _) => format!("0.{rest}"),
            (_, Some(rest)) => format!("-0.{rest}"),
            _ if text.contains('.') => text,
            _ => format!("{text}.0"),
        };
        self.tag(code, &text)
    }

    pub fn point(&mut self, code: u16, p: DVec2) -> &mut Self {
        self.real(code, p.x).real(code + 10, p.y)
    }

    pub fn point3(&mut self, code: u16, p: DVec2) -> &mut Self {
        self.point(code, p).real(code + 20, 0.0)
    }

    pub fn class(&mut self, name: &str) -> &mut Self {
        self.tag(100, name)
    }

    fn section(&mut self, name: &str) -> &mut Self {
        self.tag(0, "SECTION").tag(2, name)
    }

    pub fn fresh(&mut self) -> u32 {
        self.next += 1;
        self.next - 1
    }

    pub fn table(&mut self, name: &str, handle: u32, count: usize) -> &mut Self {
        self.tag(0, "TABLE").tag(2, name).handle(5, handle).handle(330, 0);
        self.class("AcDbSymbolTable").int(70, count as i64)
    }

    /// Returns the common start of a table's entry.
    pub fn record(&mut self, kind: &str, table: u32, class: &str) -> &mut Self {
        let handle = self.fresh();
        self.tag(0, kind).handle(5, handle).handle(330, table);
        self.class("AcDbSymbolTableRecord").class(class)
    }
}

fn header(tags: &mut Tags, sheet: &Sheet, dimensions: &Dimensions, seed: u32) {
    tags.section("HEADER");
    tags.tag(9, "$ACADVER").tag(1, "AC1018");
    tags.tag(9, "$DWGCODEPAGE").tag(3, "ANSI_1252");
    tags.tag(9, "$INSBASE").point3(10, DVec2::ZERO);
    tags.tag(9, "$EXTMIN").point3(10, DVec2::ZERO);
    tags.tag(9, "$EXTMAX").point3(10, sheet.size);
    tags.tag(9, "$LIMMIN").point(10, DVec2::ZERO);
    tags.tag(9, "$LIMMAX").point(10, sheet.size);
    tags.tag(9, "$LTSCALE").real(40, 1.0);
    // Line weights are shown; lengths are metric, in millimetres.
    tags.tag(9, "$LWDISPLAY").int(290, 1);
    tags.tag(9, "$INSUNITS").int(70, 4);
    tags.tag(9, "$MEASUREMENT").int(70, 1);
    dimensions.variables(tags);
    tags.tag(9, "$HANDSEED").handle(5, seed);
    tags.tag(0, "ENDSEC");
    tags.section("CLASSES").tag(0, "ENDSEC");
}

fn tables(tags: &mut Tags, sheet: &Sheet, dimensions: &Dimensions) {
    tags.section("TABLES");
    viewport(tags, sheet);
    line_types(tags, sheet);
    layers(tags, sheet);
    tags.table("STYLE", STYLES, 1);
    tags.record("STYLE", STYLES, "AcDbTextStyleTableRecord").tag(2, "Standard").int(70, 0);
    tags.real(40, 0.0)
        .real(41, 1.0)
        .real(50, 0.0)
        .int(71, 0)
        .real(42, 2.5)
        .tag(3, "txt")
        .tag(4, "");
    tags.tag(0, "ENDTAB");
    tags.table("VIEW", VIEWS, 0).tag(0, "ENDTAB");
    tags.table("UCS", UCSS, 0).tag(0, "ENDTAB");
    tags.table("APPID", APPIDS, 1);
    tags.record("APPID", APPIDS, "AcDbRegAppTableRecord").tag(2, "ACAD").int(70, 0);
    tags.tag(0, "ENDTAB");
    dimensions.styles(tags);
    let spaces = [("*Model_Space".to_owned(), MODEL), ("*Paper_Space".to_owned(), PAPER)];
    let records: Vec<(String, u32)> = spaces.into_iter().chain(dimensions.records()).collect();
    tags.table("BLOCK_RECORD", BLOCK_RECORDS, records.len());
    for (name, handle) in records {
        tags.tag(0, "BLOCK_RECORD").handle(5, handle).handle(330, BLOCK_RECORDS);
        tags.class("AcDbSymbolTableRecord").class("AcDbBlockTableRecord");
        tags.tag(2, &name).handle(340, 0);
    }
    tags.tag(0, "ENDTAB").tag(0, "ENDSEC");
}

/// Writes the part that is seen when the file is opened: all of the sheet.
fn viewport(tags: &mut Tags, sheet: &Sheet) {
    tags.table("VPORT", VPORTS, 1);
    tags.record("VPORT", VPORTS, "AcDbViewportTableRecord").tag(2, "*Active").int(70, 0);
    tags.point(10, DVec2::ZERO).point(11, DVec2::ONE).point(12, sheet.size * 0.5);
    tags.point(13, DVec2::ZERO).point(14, DVec2::splat(10.0)).point(15, DVec2::splat(10.0));
    tags.point(16, DVec2::ZERO).real(36, 1.0).point3(17, DVec2::ZERO);
    tags.real(40, sheet.size.y.max(1.0))
        .real(41, (sheet.size.x / sheet.size.y.max(1e-9)).max(1e-9));
    tags.real(42, 50.0).real(43, 0.0).real(44, 0.0).real(50, 0.0).real(51, 0.0);
    for code in 71..=78 {
        // Circle zoom and fast zoom have their usual values, the rest is off.
        tags.int(code, if code == 72 { 1000 } else { i64::from(code == 73) });
    }
    tags.tag(0, "ENDTAB");
}

/// The dashes of HIDDEN and CENTER are those of the sheet's first pens of the kind; CENTER is there where it is used.
fn line_types(tags: &mut Tags, sheet: &Sheet) {
    let first = |name: &str| sheet.pens.iter().find(|p| line_type(Some(p)) == name);
    let hidden: &[f64] = first(HIDDEN).map_or(&[3.0, 1.5], |p| p.dashes.as_slice());
    let mut types: Vec<(&str, &str, &[f64])> = vec![
        ("ByBlock", "", &[]),
        ("ByLayer", "", &[]),
        (CONTINUOUS, "Solid line", &[]),
        (HIDDEN, "Hidden __ __ __ __ __ __ __ __ __ __", hidden),
    ];
    if let Some(pen) = first(CENTER) {
        types.push((CENTER, "Center ____ _ ____ _ ____ _ ____", &pen.dashes));
    }
    tags.table("LTYPE", LTYPES, types.len());
    for (name, description, dashes) in types {
        tags.record("LTYPE", LTYPES, "AcDbLinetypeTableRecord").tag(2, name).int(70, 0);
        tags.tag(3, description).int(72, 65).int(73, dashes.len() as i64);
        tags.real(40, dashes.iter().sum());
        for (i, length) in dashes.iter().enumerate() {
            tags.real(49, if i % 2 == 0 { *length } else { -length }).int(74, 0);
        }
    }
    tags.tag(0, "ENDTAB");
}

fn layers(tags: &mut Tags, sheet: &Sheet) {
    tags.table("LAYER", LAYERS, sheet.layers.len() + 1);
    layer(tags, "0", None);
    for l in &sheet.layers {
        layer(tags, &symbol(&l.name), layer_pen(sheet, l));
    }
    tags.tag(0, "ENDTAB");
}

/// Returns the pen of a layer: that of its first line.
fn layer_pen<'a>(sheet: &'a Sheet, l: &SheetLayer) -> Option<&'a Pen> {
    l.marks.iter().find_map(|m| match m {
        Mark::Stroke { pen, .. } | Mark::Curve { pen, .. } | Mark::Text { pen, .. } => {
            sheet.pens.get(*pen)
        }
        Mark::Dimension(dimension) => sheet.pens.get(dimension.text.pen),
        Mark::Fill { .. } | Mark::Area { .. } => None,
    })
}

fn layer(tags: &mut Tags, name: &str, pen: Option<&Pen>) {
    tags.record("LAYER", LAYERS, "AcDbLayerTableRecord").tag(2, name).int(70, 0);
    let color = pen.map_or([0, 0, 0, 255], |p| p.color);
    tags.int(62, palette(color));
    true_color(tags, color);
    tags.tag(6, line_type(pen)).int(370, pen.map_or(-3, weight));
    // The plot style "Normal", which files without named plot styles do not have.
    tags.handle(390, 0);
}

/// The names of line types: solid, dashed, and with dashes of two lengths in turn.
const CONTINUOUS: &str = "CONTINUOUS";
const HIDDEN: &str = "HIDDEN";
const CENTER: &str = "CENTER";

fn line_type(pen: Option<&Pen>) -> &'static str {
    match pen.map_or(0, |p| p.dashes.len()) {
        0 => CONTINUOUS,
        1..=3 => HIDDEN,
        _ => CENTER,
    }
}

/// Returns the nearest line weight of the format.
fn weight(pen: &Pen) -> i64 {
    let wanted = (pen.width * 100.0).round() as i64;
    WEIGHTS.iter().copied().min_by_key(|w| (w - wanted).abs()).unwrap_or(25)
}

/// Returns the nearest of the palette's first colours and greys; 7 is black on white and white on
/// black.
fn palette([r, g, b, _]: [u8; 4]) -> i64 {
    const COLORS: [([u8; 3], i64); 12] = [
        ([0, 0, 0], 7),
        ([255, 0, 0], 1),
        ([255, 255, 0], 2),
        ([0, 255, 0], 3),
        ([0, 255, 255], 4),
        ([0, 0, 255], 5),
        ([255, 0, 255], 6),
        ([128, 128, 128], 8),
        ([51, 51, 51], 250),
        ([173, 173, 173], 253),
        ([214, 214, 214], 254),
        ([255, 255, 255], 255),
    ];
    let apart = |c: &[u8; 3]| -> i64 {
        c.iter().zip([r, g, b]).map(|(a, b)| (i64::from(*a) - i64::from(b)).pow(2)).sum()
    };
    COLORS.iter().min_by_key(|(c, _)| apart(c)).map_or(7, |(_, index)| *index)
}

/// The exact colour, where it is not black: that follows the background.
fn true_color(tags: &mut Tags, [r, g, b, _]: [u8; 4]) {
    if [r, g, b] != [0; 3] {
        tags.int(420, (i64::from(r) << 16) | (i64::from(g) << 8) | i64::from(b));
    }
}

fn blocks(tags: &mut Tags, sheet: &Sheet, dimensions: &Dimensions) {
    tags.section("BLOCKS");
    for (name, record) in [("*Model_Space", MODEL), ("*Paper_Space", PAPER)] {
        block(tags, name, record, |_| {});
    }
    dimensions.blocks(tags, sheet);
    tags.tag(0, "ENDSEC");
}

/// A block with its entities; names with a star, but for those of the two spaces, are anonymous.
pub(super) fn block(tags: &mut Tags, name: &str, record: u32, entities: impl FnOnce(&mut Tags)) {
    let (start, end) = (tags.fresh(), tags.fresh());
    let begin = |tags: &mut Tags, kind: &str, handle: u32| {
        tags.tag(0, kind).handle(5, handle).handle(330, record).class("AcDbEntity");
        if record == PAPER {
            tags.int(67, 1);
        }
        tags.tag(8, "0");
    };
    begin(tags, "BLOCK", start);
    let anonymous = i64::from(!matches!(record, MODEL | PAPER));
    tags.class("AcDbBlockBegin").tag(2, name).int(70, anonymous).point3(10, DVec2::ZERO);
    tags.tag(3, name).tag(1, "");
    tags.owner = record;
    entities(tags);
    tags.owner = MODEL;
    begin(tags, "ENDBLK", end);
    tags.class("AcDbBlockEnd");
}

fn objects(tags: &mut Tags) {
    tags.section("OBJECTS");
    tags.tag(0, "DICTIONARY").handle(5, ROOT).handle(330, 0).class("AcDbDictionary").int(281, 1);
    tags.tag(3, "ACAD_GROUP").handle(350, GROUPS);
    tags.tag(0, "DICTIONARY").handle(5, GROUPS).handle(330, ROOT);
    tags.class("AcDbDictionary").int(281, 1).tag(0, "ENDSEC");
}

pub(super) fn entity(
    tags: &mut Tags,
    sheet: &Sheet,
    layer: &str,
    mark: &Mark,
    strokes: DxfStrokes,
) {
    let place = |p: &DVec2| DVec2::new(p.x, sheet.size.y - p.y);
    match mark {
        Mark::Stroke { points, closed, pen } => {
            let points: Vec<DVec2> = points.iter().map(place).collect();
            let to = Target { layer, pen: sheet.pens.get(*pen) };
            match &points[..] {
                [a, b] if !closed && strokes == DxfStrokes::Pieces => {
                    if !dxf_curve::dot(tags, &to, *a, *b) {
                        dxf_curve::line(tags, &to, *a, *b);
                    }
                }
                _ => {
                    let straight: Vec<(DVec2, f64)> = points.iter().map(|p| (*p, 0.0)).collect();
                    dxf_curve::polyline(tags, &to, &straight, *closed);
                }
            }
        }
        Mark::Curve { curve, pen } => {
            let to = Target { layer, pen: sheet.pens.get(*pen) };
            dxf_curve::write(tags, &to, curve, sheet.size.y, strokes);
        }
        Mark::Text { at, text, height, anchor, pen } => {
            begin(tags, "TEXT", layer, sheet.pens.get(*pen));
            let at = place(at);
            tags.class("AcDbText").point3(10, at).real(40, *height).tag(1, &string(text));
            let alignment = match anchor {
                Anchor::Start => 0,
                Anchor::Middle => 1,
                Anchor::End => 2,
            };
            if alignment != 0 {
                tags.int(72, alignment).point3(11, at);
            }
            tags.class("AcDbText");
        }
        Mark::Fill { rings, color } => {
            begin(tags, "HATCH", layer, None);
            tags.int(62, palette(*color));
            true_color(tags, *color);
            let ring = |r: &Vec<DVec2>| r.iter().map(|p| (place(p), 0.0)).collect();
            hatch(tags, &rings.iter().map(ring).collect::<Vec<_>>());
        }
        Mark::Area { rings, color } => {
            begin(tags, "HATCH", layer, None);
            tags.int(62, palette(*color));
            true_color(tags, *color);
            let ring = |r: &Curve| dxf_curve::vertices(&dxf_curve::turned_up(r, sheet.size.y));
            hatch(tags, &rings.iter().map(ring).collect::<Vec<_>>());
        }
        // These are entities of their own kind, with blocks.
        Mark::Dimension(_) => {}
    }
}

/// Layer of an entity, and its colour and width.
pub(super) struct Target<'a> {
    pub layer: &'a str,
    pub pen: Option<&'a Pen>,
}

/// The common start of an entity. Colour and weight are the layer's; they stand here where a layer
/// may have marks of several pens.
pub(super) fn begin(tags: &mut Tags, kind: &str, layer: &str, pen: Option<&Pen>) {
    let (handle, owner) = (tags.fresh(), tags.owner);
    tags.tag(0, kind).handle(5, handle).handle(330, owner).class("AcDbEntity").tag(8, layer);
    if let Some(pen) = pen {
        let line_type = line_type(Some(pen));
        if line_type != tags.line_type {
            tags.tag(6, line_type);
        }
        tags.int(370, weight(pen));
    }
}

/// A solid fill between rings, each as its corners with the bulges of the arcs that begin there.
fn hatch(tags: &mut Tags, rings: &[Vec<(DVec2, f64)>]) {
    tags.class("AcDbHatch").point3(10, DVec2::ZERO).real(210, 0.0).real(220, 0.0).real(230, 1.0);
    // Solid, not bound to other entities; paths are polylines, areas alternate from ring to ring.
    tags.tag(2, "SOLID").int(70, 1).int(71, 0).int(91, rings.len() as i64);
    for ring in rings {
        let is_round = ring.iter().any(|c| c.1 != 0.0);
        tags.int(92, 3).int(72, i64::from(is_round)).int(73, 1).int(93, ring.len() as i64);
        for (p, bulge) in ring {
            tags.point(10, *p);
            if is_round {
                dxf_curve::bulge(tags, *bulge);
            }
        }
        tags.int(97, 0);
    }
    tags.int(75, 0).int(76, 1).int(98, 0);
}

/// Returns a name of a table's entry: the format forbids a few characters.
pub(super) fn symbol(name: &str) -> String {
    string(name).replace(['<', '>', '/', '\\', '"', ':', ';', '?', '*', '|', ',', '=', '`'], "_")
}

/// Returns text on one line; `^` and what is not ASCII are written as the format escapes them.
pub(super) fn string(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '°' => out += "%%d",
            '±' => out += "%%p",
            'Ø' | '⌀' => out += "%%c",
            // Stroke fonts lack it.
            '–' => out.push('-'),
            '^' => out += "^ ",
            c if c.is_control() => out.push(' '),
            c if c.is_ascii() => out.push(c),
            c => c.encode_utf16(&mut [0; 2]).iter().for_each(|u| out += &format!("\\U+{u:04X}")),
        }
    }
    out
}
