//! Sheets as PDF: one page of vectors, a layer ("optional content group") for each of the sheet's.

use super::MADE;
use super::number::{push, short};
use super::pdf_gradient::{self, Gradients, Objects};
use super::pdf_text::{self, Words};
use crate::Result;
use durer::curve::{PathElement, pieces};
use durer::math::DVec2;
use durer::paper::{dashes, dimension_strokes, text_strokes};
use durer::target::Curve;
use durer::target::drawing::TextAnchor;
use durer::target::sheet::{GradientArea, MarkGroup, PaperMark, Pen, Sheet};
use durer::work::{Charge, Work};
use pdf_writer::writers::Resources;
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
    pdf_gradient::check(sheet)?;
    let mut found = Found::default();
    let mut charge = work.charge(MADE, 0)?;
    let content = content(sheet, scale, &mut found, &mut charge)?;
    let Found { alphas, words, forms, gradients } = found;
    // Digits and a few letters take half the room at most.
    charge.grow(content.len() as u64 / 2)?;
    let content = packed(&content);
    let mut pdf = Pdf::new();
    pdf.set_version(1, 5);
    let layers: Vec<Ref> =
        (0i32..).take(sheet.layers.len()).map(|i| Ref::new(FIRST_LAYER + i)).collect();
    catalog(&mut pdf, &layers);
    pdf.pages(Ref::new(PAGES)).kids([Ref::new(PAGE)]).count(1);
    let after_layers = |i: i32| Ref::new(FIRST_LAYER + layers.len() as i32 + i);
    let font = words.any.then(|| after_layers(0));
    let form = |i: usize| after_layers(2 + i as i32);
    let forms: Vec<(Ref, String)> =
        forms.into_iter().enumerate().map(|(i, content)| (form(i), content)).collect();
    let mut numbers = 2 + forms.len() as i32..;
    let objects = gradients.objects(|| after_layers(numbers.next().unwrap_or_default()));
    let used = Used { layers: &layers, alphas: &alphas, font, forms: &forms, gradients: &objects };
    page(&mut pdf, sheet, scale, user_unit, &used);
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
    forms.iter().for_each(|(id, content)| form_object(&mut pdf, *id, content, sheet, &used));
    gradients.write(&mut pdf, &objects, sheet);
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
    /// Groups with an opacity.
    forms: &'a [(Ref, String)],
    gradients: &'a Objects,
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
    list_resources(&mut resources, used);
}

/// Lists the fonts, groups, gradients and opacities that operators name.
fn list_resources(resources: &mut Resources<'_>, used: &Used<'_>) {
    if let Some(font) = used.font {
        resources.fonts().pair(Name(pdf_text::FONT), font);
    }
    if !used.forms.is_empty() {
        let mut objects = resources.x_objects();
        for (i, (id, _)) in used.forms.iter().enumerate() {
            objects.pair(Name(format!("X{i}").as_bytes()), *id);
        }
    }
    used.gradients.list_shadings(resources);
    let mut states = resources.ext_g_states();
    used.gradients.list_masks(&mut states);
    for alpha in used.alphas {
        let mut state = states.insert(Name(format!("A{alpha}").as_bytes())).dict();
        let value = f32::from(*alpha) / 255.0;
        state.pair(Name(b"CA"), value).pair(Name(b"ca"), value);
    }
}

/// Writes a group as an object of its own, in millimetres.
fn form_object(pdf: &mut Pdf, id: Ref, content: &str, sheet: &Sheet, used: &Used<'_>) {
    let content = packed(content);
    let mut form = pdf.form_xobject(id, &content);
    form.filter(Filter::FlateDecode);
    form.bbox(Rect::new(0.0, 0.0, sheet.size.x as f32, sheet.size.y as f32));
    form.group().transparency().isolated(true);
    list_resources(&mut form.resources(), used);
}

fn packed(content: &str) -> Vec<u8> {
    miniz_oxide::deflate::compress_to_vec_zlib(content.as_bytes(), LEVEL)
}

/// Contents that the operators of a page refer to.
#[derive(Default)]
struct Found {
    alphas: BTreeSet<u8>,
    words: Words,
    /// Operators of the groups with an opacity.
    forms: Vec<String>,
    gradients: Gradients,
}

/// Current state of graphics, so that only changes are written.
#[derive(Default, Clone, PartialEq)]
struct State {
    alpha: Option<u8>,
    fill: Option<[u8; 3]>,
    stroke: Option<[u8; 3]>,
    width: Option<f64>,
    dashed: bool,
}

/// Returns the page's operators; collects the contents that they refer to.
fn content(sheet: &Sheet, scale: f64, found: &mut Found, charge: &mut Charge) -> Result<String> {
    let mut text = String::new();
    // Millimetres, y down.
    let [k, height] = [scale, sheet.size.y * scale].map(|v| short(v, 6));
    text += &format!("{k} 0 0 -{k} 0 {height} cm 1 J 1 j\n");
    let mut state = State::default();
    if let Some(color) = sheet.background {
        set_fill(&mut text, &mut state, color, &mut found.alphas);
        text +=
            &format!("0 0 {} {} re f\n", short(sheet.size.x, DIGITS), short(sheet.size.y, DIGITS));
    }
    for (i, layer) in sheet.layers.iter().enumerate() {
        text += &format!("/OC /L{i} BDC\n");
        for mark in &layer.marks {
            put(&mut text, &mut state, sheet, mark, found);
            let forms: usize = found.forms.iter().map(String::capacity).sum();
            charge.grow_to((text.capacity() + forms) as u64)?;
        }
        text += "EMC\n";
    }
    Ok(text)
}

fn put(text: &mut String, state: &mut State, sheet: &Sheet, mark: &PaperMark, found: &mut Found) {
    let fill = |even_odd: bool| if even_odd { "f*\n" } else { "f\n" };
    match mark {
        PaperMark::Fill { rings, color, even_odd } => {
            set_fill(text, state, *color, &mut found.alphas);
            rings.iter().for_each(|ring| path(text, ring, true));
            *text += fill(*even_odd);
        }
        PaperMark::Area { rings, color, even_odd } => {
            set_fill(text, state, *color, &mut found.alphas);
            curves(text, rings);
            *text += fill(*even_odd);
        }
        PaperMark::Gradient(area) => put_gradient(text, state, sheet, area, found),
        PaperMark::Stroke { points, closed, pen } => {
            let Some(pen) = sheet.pens.get(*pen) else { return };
            set_pen(text, state, pen, &mut found.alphas);
            let length = dashes::length(points, *closed);
            set_dashes(text, state, dashes::fitted(&pen.dashes, length, *closed));
            path(text, points, *closed);
            *text += "S\n";
        }
        PaperMark::Curve { curve, pen } => {
            let Some(pen) = sheet.pens.get(*pen) else { return };
            set_pen(text, state, pen, &mut found.alphas);
            let length = pieces::length(curve);
            set_dashes(text, state, dashes::fitted(&pen.dashes, length, curve.closed));
            curves(text, std::slice::from_ref(curve));
            *text += "S\n";
        }
        PaperMark::Text { at, text: words, height, anchor, pen } => {
            let Some(pen) = sheet.pens.get(*pen) else { return };
            set_pen(text, state, pen, &mut found.alphas);
            set_dashes(text, state, None);
            found.words.write(text, (*at, DVec2::X), words, *height, *anchor);
            letters(text, &text_strokes(*at, words, *height, *anchor));
        }
        PaperMark::Dimension(dimension) => {
            for mark in &dimension.marks {
                put(text, state, sheet, mark, found);
            }
            let words = &dimension.text;
            let Some(pen) = sheet.pens.get(words.pen) else { return };
            set_pen(text, state, pen, &mut found.alphas);
            set_dashes(text, state, None);
            found.words.write(
                text,
                (words.at, words.along),
                &words.text,
                words.height,
                TextAnchor::Middle,
            );
            letters(text, &dimension_strokes(words));
        }
        PaperMark::Group(group) => put_group(text, state, sheet, group, found),
    }
}

/// Writes an area as a clip path that is filled with a gradient.
fn put_gradient(
    text: &mut String,
    state: &mut State,
    sheet: &Sheet,
    area: &GradientArea,
    found: &mut Found,
) {
    let (filled, alpha) = found.gradients.fill(&area.gradient, sheet.size);
    set_alpha(text, state, alpha, &mut found.alphas);
    *text += "q\n";
    curves(text, &area.rings);
    *text += if area.even_odd { "W* n\n" } else { "W n\n" };
    *text += &filled;
    *text += "Q\n";
}

/// Writes marks with a clip path and an opacity; the state after them is that before.
fn put_group(
    text: &mut String,
    state: &mut State,
    sheet: &Sheet,
    group: &MarkGroup,
    found: &mut Found,
) {
    let (before, had_words) = (state.clone(), found.words.any);
    *text += "q\n";
    if let Some(clip) = &group.clip {
        curves(text, &clip.rings);
        *text += if clip.even_odd { "W* n\n" } else { "W n\n" };
    }
    if group.opacity < 1.0 {
        let (mut content, mut own) =
            (String::new(), State { dashed: state.dashed, ..State::default() });
        group.marks.iter().for_each(|mark| put(&mut content, &mut own, sheet, mark, found));
        let alpha = (group.opacity * 255.0).round() as u8;
        set_alpha(text, state, alpha, &mut found.alphas);
        *text += &format!("/X{} Do\n", found.forms.len());
        found.forms.push(content);
    } else {
        group.marks.iter().for_each(|mark| put(text, state, sheet, mark, found));
    }
    *text += "Q\n";
    *state = before;
    if found.words.any && !had_words {
        // The mode of text was set within the group.
        *text += "3 Tr\n";
    }
}

/// Appends curves as paths.
fn curves(text: &mut String, curves: &[Curve]) {
    for curve in curves {
        pieces::path(curve, CUBICS).elements().iter().for_each(|e| element(text, e));
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
