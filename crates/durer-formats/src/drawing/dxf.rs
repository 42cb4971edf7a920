//! Sheets as DXF for CAD: AutoCAD 2004 (AC1018), the first version with colours beyond the palette; readers of DXF 2000
//! read it.
//!
//! Model space in millimetres, y up, the origin in the lower left corner of the sheet, or in the units of a [`DxfFrame`]. Each layer of the sheet is one
//! with a colour, a line weight and a line type, CONTINUOUS, HIDDEN or CENTER; polylines are LWPOLYLINE, curves are
//! LINE, ARC, CIRCLE, ELLIPSE and SPLINE, or LWPOLYLINE too, dots are CIRCLE, text is TEXT, dimensions are DIMENSION
//! with their blocks, areas are HATCH with solid fill.
//!
//! Written from Autodesk's *DXF Reference* (2004).

use super::MADE;
use super::dxf_dimension::Dimensions;
use super::dxf_entity::{block, entity};
use super::dxf_tags::{
    APPIDS, BLOCK_RECORDS, CONTINUOUS, DxfFrame, DxfStrokes, FIRST, GROUPS, HIDDEN, LAYERS, LTYPES,
    MODEL, PAPER, ROOT, STYLES, Tags, UCSS, VIEWS, VPORTS, palette, symbol, true_color, weight,
};
use crate::Result;
use durer::math::DVec2;
use durer::target::sheet::{PaperMark, Pen, Sheet, SheetLayer};
use durer::work::Work;
use std::io::Write;

/// Writes a sheet as an ASCII DXF file, encoded in the ANSI code page with `\U+XXXX` for characters that are not ASCII.
///
/// # Errors
/// [`crate::Error::Io`] if writing fails.
pub fn write(out: &mut impl Write, sheet: &Sheet, strokes: DxfStrokes) -> Result<()> {
    write_within(out, sheet, (strokes, DxfFrame::default()), &Work::default())
}

/// Writes it into a frame within a budget: all but the header is made in memory, as the header names the last handle.
pub(super) fn write_within(
    out: &mut impl Write,
    sheet: &Sheet,
    (strokes, frame): (DxfStrokes, DxfFrame),
    work: &Work,
) -> Result<()> {
    let mut charge = work.charge(MADE, 0)?;
    let mut body = Tags::new(sheet, frame, FIRST);
    let dimensions = Dimensions::of(&mut body, sheet, strokes);
    tables(&mut body, sheet, &dimensions);
    blocks(&mut body, sheet, &dimensions);
    let mut numbers = 0..;
    body.section("ENTITIES");
    for layer in &sheet.layers {
        let name = symbol(&layer.name);
        let pen = layer_pen(sheet, layer);
        body.line_type = body.line_type(pen);
        body.color = Some(layer_color(pen));
        for mark in &layer.marks {
            match mark {
                PaperMark::Dimension(dimension) => {
                    let number = numbers.next().unwrap_or_default();
                    dimensions.write(&mut body, sheet, &name, dimension, number);
                }
                _ => entity(&mut body, sheet, &name, mark, strokes),
            }
            charge.grow_to(body.text.capacity() as u64)?;
        }
    }
    body.tag(0, "ENDSEC");
    objects(&mut body);
    body.tag(0, "EOF");
    let mut head = Tags::new(sheet, frame, 0);
    header(&mut head, sheet, &dimensions, body.next);
    out.write_all(head.text.as_bytes())?;
    out.write_all(body.text.as_bytes())?;
    Ok(())
}

fn header(tags: &mut Tags, sheet: &Sheet, dimensions: &Dimensions, seed: u32) {
    tags.section("HEADER");
    tags.tag(9, "$ACADVER").tag(1, "AC1018");
    tags.tag(9, "$DWGCODEPAGE").tag(3, "ANSI_1252");
    tags.tag(9, "$INSBASE").point3(10, DVec2::ZERO);
    tags.tag(9, "$EXTMIN").place3(10, DVec2::ZERO);
    tags.tag(9, "$EXTMAX").place3(10, sheet.size);
    tags.tag(9, "$LIMMIN").place(10, DVec2::ZERO);
    tags.tag(9, "$LIMMAX").place(10, sheet.size);
    // Line types have millimetres of the sheet.
    tags.tag(9, "$LTSCALE").length(40, 1.0);
    // Line weights are shown; patterns and line types are metric.
    tags.tag(9, "$LWDISPLAY").int(290, 1);
    let units = tags.frame.insertion_units();
    tags.tag(9, "$INSUNITS").int(70, units);
    tags.tag(9, "$MEASUREMENT").int(70, 1);
    dimensions.variables(tags);
    tags.tag(9, "$HANDSEED").handle(5, seed);
    tags.tag(0, "ENDSEC");
    tags.section("CLASSES").tag(0, "ENDSEC");
}

fn tables(tags: &mut Tags, sheet: &Sheet, dimensions: &Dimensions) {
    tags.section("TABLES");
    viewport(tags, sheet);
    line_types(tags);
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
    tags.point(10, DVec2::ZERO).point(11, DVec2::ONE).place(12, sheet.size * 0.5);
    tags.point(13, DVec2::ZERO).point(14, DVec2::splat(10.0)).point(15, DVec2::splat(10.0));
    tags.point(16, DVec2::ZERO).real(36, 1.0).point3(17, DVec2::ZERO);
    tags.length(40, sheet.size.y.max(1.0))
        .real(41, (sheet.size.x / sheet.size.y.max(1e-9)).max(1e-9));
    tags.real(42, 50.0).real(43, 0.0).real(44, 0.0).real(50, 0.0).real(51, 0.0);
    for code in 71..=78 {
        // Circle zoom and fast zoom have their usual values, the rest is off.
        tags.int(code, if code == 72 { 1000 } else { i64::from(code == 73) });
    }
    tags.tag(0, "ENDTAB");
}

/// Writes the line types; HIDDEN is there even if no pen is dashed.
fn line_types(tags: &mut Tags) {
    let solid = [("ByBlock", ""), ("ByLayer", ""), (CONTINUOUS, "Solid line")];
    let mut types: Vec<(String, &str, Vec<f64>)> =
        solid.into_iter().map(|(name, words)| (name.to_owned(), words, Vec::new())).collect();
    let (dashes, center) =
        ("Hidden __ __ __ __ __ __ __ __ __ __", "Center ____ _ ____ _ ____ _ ____");
    if tags.dashed.iter().all(|dashed| dashed.name != HIDDEN) {
        types.push((HIDDEN.to_owned(), dashes, vec![3.0, 1.5]));
    }
    // Those with few dashes come first.
    for is_center in [false, true] {
        let of_kind = tags.dashed.iter().filter(|dashed| dashed.is_center() == is_center);
        let words = if is_center { center } else { dashes };
        types.extend(of_kind.map(|d| (d.name.clone(), words, d.lengths.clone())));
    }
    tags.table("LTYPE", LTYPES, types.len());
    for (name, description, dashes) in types {
        tags.record("LTYPE", LTYPES, "AcDbLinetypeTableRecord").tag(2, &name).int(70, 0);
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

/// Returns the pen of a layer: the pen of its first line.
fn layer_pen<'a>(sheet: &'a Sheet, l: &SheetLayer) -> Option<&'a Pen> {
    l.marks.iter().find_map(|m| match m {
        PaperMark::Stroke { pen, .. }
        | PaperMark::Curve { pen, .. }
        | PaperMark::Text { pen, .. } => sheet.pens.get(*pen),
        PaperMark::Dimension(dimension) => sheet.pens.get(dimension.text.pen),
        PaperMark::Fill { .. }
        | PaperMark::Area { .. }
        | PaperMark::Gradient(_)
        | PaperMark::Group(_) => None,
    })
}

fn layer_color(pen: Option<&Pen>) -> [u8; 4] {
    pen.map_or([0, 0, 0, 255], |p| p.color)
}

fn layer(tags: &mut Tags, name: &str, pen: Option<&Pen>) {
    tags.record("LAYER", LAYERS, "AcDbLayerTableRecord").tag(2, name).int(70, 0);
    let color = layer_color(pen);
    tags.int(62, palette(color));
    true_color(tags, color);
    let line_type = tags.line_type(pen);
    tags.tag(6, &line_type).int(370, pen.map_or(-3, weight));
    // The plot style "Normal", which files without named plot styles do not have.
    tags.handle(390, 0);
}

fn blocks(tags: &mut Tags, sheet: &Sheet, dimensions: &Dimensions) {
    tags.section("BLOCKS");
    for (name, record) in [("*Model_Space", MODEL), ("*Paper_Space", PAPER)] {
        block(tags, name, record, |_| {});
    }
    dimensions.blocks(tags, sheet);
    tags.tag(0, "ENDSEC");
}

fn objects(tags: &mut Tags) {
    tags.section("OBJECTS");
    tags.tag(0, "DICTIONARY").handle(5, ROOT).handle(330, 0).class("AcDbDictionary").int(281, 1);
    tags.tag(3, "ACAD_GROUP").handle(350, GROUPS);
    tags.tag(0, "DICTIONARY").handle(5, GROUPS).handle(330, ROOT);
    tags.class("AcDbDictionary").int(281, 1).tag(0, "ENDSEC");
}
