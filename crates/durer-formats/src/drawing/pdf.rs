//! Sheets as PDF: one page of vectors, a layer ("optional content group") for each of the sheet's.

use super::MADE;
use super::number::{push, short};
use super::pdf_text::{self, Words};
use crate::Result;
use durer::curve::{PathElement, pieces};
use durer::math::DVec2;
use durer::paper::{dashes, dimension_strokes, text_strokes};
use durer::target::drawing::Anchor;
use durer::target::sheet::{Mark, Pen, Sheet};
use durer::work::{Charge, Work};
use pdf_writer::{Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use std::collections::BTreeSet;
use std::io::Write;

/// PDF's unit: points per millimetre.
const POINTS: f64 = 72.0 / 25.4;
/// The longest side that viewers show, in points; larger sheets get a larger unit.
const LONGEST: f64 = 14_400.0;
/// Digits after the point of a millimetre.
const DIGITS: usize = 3;
/// Largest distance between cubic curves and arcs, in millimetres.
const CUBICS: f64 = 1e-4;
/// The compressor's level: zlib's default.
const LEVEL: u8 = 6;

/// The document's objects, by number.
const CATALOG: i32 = 1;
const PAGES: i32 = 2;
const PAGE: i32 = 3;
const CONTENT: i32 = 4;
const INFO: i32 = 5;
const FIRST_LAYER: i32 = 6;

/// Writes a sheet as a PDF 1.5 document of one page of the sheet's size, without dates.
///
/// Text is drawn by the single-stroke font; the text itself is beneath it, invisible, for searching and copying.
///
/// # Errors
/// [`crate::Error::Io`] if writing fails.
pub fn write(out: &mut impl Write, sheet: &Sheet) -> Result<()> {
    write_within(out, sheet, &Work::default())
}

/// Writes it within a budget: the page is made in memory.
pub(super) fn write_within(out: &mut impl Write, sheet: &Sheet, work: &Work) -> Result<()> {
    let longest = sheet.size.max_element() * POINTS;
    let user_unit = (longest / LONGEST).ceil().max(1.0);
    let scale = POINTS / user_unit;
    let mut alphas = BTreeSet::new();
    let mut words = Words::default();
    let mut charge = work.charge(MADE, 0)?;
    let content = content(sheet, scale, (&mut alphas, &mut words), &mut charge)?;
    // Digits and a few letters take half the room at most.
    charge.grow(content.len() as u64 / 2)?;
    let content = miniz_oxide::deflate::compress_to_vec_zlib(content.as_bytes(), LEVEL);
    let mut pdf = Pdf::new();
    pdf.set_version(1, 5);
    let layers: Vec<Ref> =
        (0i32..).take(sheet.layers.len()).map(|i| Ref::new(FIRST_LAYER + i)).collect();
    catalog(&mut pdf, &layers);
    pdf.pages(Ref::new(PAGES)).kids([Ref::new(PAGE)]).count(1);
    let after_layers = |i: i32| Ref::new(FIRST_LAYER + layers.len() as i32 + i);
    let font = words.any.then(|| after_layers(0));
    page(&mut pdf, sheet, scale, user_unit, &Used { layers: &layers, alphas: &alphas, font });
    pdf.stream(Ref::new(CONTENT), &content).filter(Filter::FlateDecode);
    let mut info = pdf.document_info(Ref::new(INFO));
    if !sheet.title.is_empty() {
        info.title(TextStr(&sheet.title));
    }
    info.producer(TextStr("durer"));
    info.finish();
    for (layer, id) in sheet.layers.iter().zip(&layers) {
        let mut group = pdf.indirect(*id).dict();
        group.pair(Name(b"Type"), Name(b"OCG"));
        group.pair(Name(b"Name"), TextStr(&layer.name));
    }
    words.font(&mut pdf, after_layers(0), after_layers(1));
    out.write_all(&pdf.finish())?;
    Ok(())
}

fn catalog(pdf: &mut Pdf, layers: &[Ref]) {
    let mut catalog = pdf.catalog(Ref::new(CATALOG));
    catalog.pages(Ref::new(PAGES));
    if layers.is_empty() {
        return;
    }
    let mut properties = catalog.insert(Name(b"OCProperties")).dict();
    properties.insert(Name(b"OCGs")).array().items(layers.iter().copied());
    let mut default = properties.insert(Name(b"D")).dict();
    default.insert(Name(b"ON")).array().items(layers.iter().copied());
    // Viewers list the topmost first.
    default.insert(Name(b"Order")).array().items(layers.iter().rev().copied());
}

/// Resources that the page's operators name.
struct Used<'a> {
    layers: &'a [Ref],
    alphas: &'a BTreeSet<u8>,
    font: Option<Ref>,
}

fn page(pdf: &mut Pdf, sheet: &Sheet, scale: f64, user_unit: f64, used: &Used<'_>) {
    let [width, height] = [sheet.size.x, sheet.size.y].map(|side| (side * scale) as f32);
    let mut page = pdf.page(Ref::new(PAGE));
    page.media_box(Rect::new(0.0, 0.0, width, height)).parent(Ref::new(PAGES));
    page.contents(Ref::new(CONTENT));
    if user_unit > 1.0 {
        page.user_unit(user_unit as f32);
    }
    let mut resources = page.resources();
    let mut properties = resources.insert(Name(b"Properties")).dict();
    for (i, id) in used.layers.iter().enumerate() {
        properties.pair(Name(format!("L{i}").as_bytes()), *id);
    }
    properties.finish();
    if let Some(font) = used.font {
        resources.fonts().pair(Name(pdf_text::FONT), font);
    }
    let mut states = resources.ext_g_states();
    for alpha in used.alphas {
        let mut state = states.insert(Name(format!("A{alpha}").as_bytes())).dict();
        let value = f32::from(*alpha) / 255.0;
        state.pair(Name(b"CA"), value).pair(Name(b"ca"), value);
    }
}

/// Current state of graphics, so that only changes are written.
#[derive(Default, PartialEq)]
struct State {
    alpha: Option<u8>,
    fill: Option<[u8; 3]>,
    stroke: Option<[u8; 3]>,
    width: Option<f64>,
    dashed: bool,
}

/// Returns the page's operators; collects the opacities used.
fn content(
    sheet: &Sheet,
    scale: f64,
    (alphas, words): (&mut BTreeSet<u8>, &mut Words),
    charge: &mut Charge,
) -> Result<String> {
    let mut text = String::new();
    // Millimetres, y down.
    let [k, height] = [scale, sheet.size.y * scale].map(|v| short(v, 6));
    text += &format!("{k} 0 0 -{k} 0 {height} cm 1 J 1 j\n");
    let mut state = State::default();
    if let Some(color) = sheet.background {
        set_fill(&mut text, &mut state, color, alphas);
        text +=
            &format!("0 0 {} {} re f\n", short(sheet.size.x, DIGITS), short(sheet.size.y, DIGITS));
    }
    for (i, layer) in sheet.layers.iter().enumerate() {
        text += &format!("/OC /L{i} BDC\n");
        for mark in &layer.marks {
            put(&mut text, &mut state, sheet, mark, (&mut *alphas, &mut *words));
            charge.grow_to(text.capacity() as u64)?;
        }
        text += "EMC\n";
    }
    Ok(text)
}

fn put(
    text: &mut String,
    state: &mut State,
    sheet: &Sheet,
    mark: &Mark,
    (alphas, found): (&mut BTreeSet<u8>, &mut Words),
) {
    match mark {
        Mark::Fill { rings, color } => {
            set_fill(text, state, *color, alphas);
            rings.iter().for_each(|ring| path(text, ring, true));
            *text += "f\n";
        }
        Mark::Area { rings, color } => {
            set_fill(text, state, *color, alphas);
            for ring in rings {
                pieces::path(ring, CUBICS).elements().iter().for_each(|e| element(text, e));
            }
            *text += "f\n";
        }
        Mark::Stroke { points, closed, pen } => {
            let Some(pen) = sheet.pens.get(*pen) else { return };
            set_pen(text, state, pen, alphas);
            let length = dashes::length(points, *closed);
            set_dashes(text, state, dashes::fitted(&pen.dashes, length, *closed));
            path(text, points, *closed);
            *text += "S\n";
        }
        Mark::Curve { curve, pen } => {
            let Some(pen) = sheet.pens.get(*pen) else { return };
            set_pen(text, state, pen, alphas);
            let length = pieces::length(curve);
            set_dashes(text, state, dashes::fitted(&pen.dashes, length, curve.closed));
            pieces::path(curve, CUBICS).elements().iter().for_each(|e| element(text, e));
            *text += "S\n";
        }
        Mark::Text { at, text: words, height, anchor, pen } => {
            let Some(pen) = sheet.pens.get(*pen) else { return };
            set_pen(text, state, pen, alphas);
            set_dashes(text, state, None);
            found.write(text, (*at, DVec2::X), words, *height, *anchor);
            letters(text, &text_strokes(*at, words, *height, *anchor));
        }
        Mark::Dimension(dimension) => {
            for mark in &dimension.marks {
                put(text, state, sheet, mark, (&mut *alphas, &mut *found));
            }
            let words = &dimension.text;
            let Some(pen) = sheet.pens.get(words.pen) else { return };
            set_pen(text, state, pen, alphas);
            set_dashes(text, state, None);
            found.write(text, (words.at, words.along), &words.text, words.height, Anchor::Middle);
            letters(text, &dimension_strokes(words));
        }
    }
}

fn letters(text: &mut String, strokes: &[Vec<DVec2>]) {
    strokes.iter().for_each(|stroke| path(text, stroke, false));
    if !strokes.is_empty() {
        *text += "S\n";
    }
}

fn set_alpha(text: &mut String, state: &mut State, alpha: u8, alphas: &mut BTreeSet<u8>) {
    // A page begins with opaque colours.
    if state.alpha.unwrap_or(255) != alpha {
        *text += &format!("/A{alpha} gs\n");
        alphas.insert(alpha);
        state.alpha = Some(alpha);
    }
}

fn set_fill(
    text: &mut String,
    state: &mut State,
    [r, g, b, a]: [u8; 4],
    alphas: &mut BTreeSet<u8>,
) {
    set_alpha(text, state, a, alphas);
    if state.fill != Some([r, g, b]) {
        color(text, [r, g, b], "rg");
        state.fill = Some([r, g, b]);
    }
}

fn set_pen(text: &mut String, state: &mut State, pen: &Pen, alphas: &mut BTreeSet<u8>) {
    let [r, g, b, a] = pen.color;
    set_alpha(text, state, a, alphas);
    if state.stroke != Some([r, g, b]) {
        color(text, [r, g, b], "RG");
        state.stroke = Some([r, g, b]);
    }
    if state.width != Some(pen.width) {
        push(text, pen.width, DIGITS);
        *text += " w\n";
        state.width = Some(pen.width);
    }
}

fn set_dashes(text: &mut String, state: &mut State, dashes: Option<Vec<f64>>) {
    match dashes {
        Some(dashes) => {
            let list: Vec<String> = dashes.iter().map(|d| short(*d, DIGITS + 1)).collect();
            *text += &format!("[{}] 0 d\n", list.join(" "));
            state.dashed = true;
        }
        None if state.dashed => {
            *text += "[] 0 d\n";
            state.dashed = false;
        }
        None => {}
    }
}

fn color(text: &mut String, rgb: [u8; 3], operator: &str) {
    for channel in rgb {
        push(text, f64::from(channel) / 255.0, 4);
        text.push(' ');
    }
    *text += operator;
    text.push('\n');
}

fn path(text: &mut String, points: &[DVec2], closed: bool) {
    for (i, p) in points.iter().enumerate() {
        push(text, p.x, DIGITS);
        text.push(' ');
        push(text, p.y, DIGITS);
        *text += if i == 0 { " m\n" } else { " l\n" };
    }
    if closed && !points.is_empty() {
        *text += "h\n";
    }
}

/// Writes an element of a path. Control points have one digit more than ends, which are also ends of polylines.
fn element(text: &mut String, element: &PathElement) {
    let (points, operator): (&[DVec2], _) = match element {
        PathElement::MoveTo(p) => (&[*p], "m"),
        PathElement::LineTo(p) => (&[*p], "l"),
        // Curves of sheets have no quadratic elements.
        PathElement::QuadTo(a, p) => (&[*a, *a, *p], "c"),
        PathElement::CubicTo(a, b, p) => (&[*a, *b, *p], "c"),
        PathElement::Close => (&[], "h"),
    };
    for (i, p) in points.iter().enumerate() {
        let digits = if i + 1 < points.len() { DIGITS + 1 } else { DIGITS };
        push(text, p.x, digits);
        text.push(' ');
        push(text, p.y, digits);
        text.push(' ');
    }
    *text += operator;
    text.push('\n');
}
