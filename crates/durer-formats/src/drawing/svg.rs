//! Sheets as SVG: millimetres, one group per layer, which Inkscape and similar programs show as a layer, one
//! element per stroke, short numbers.

use super::number::{push, short};
use super::svg_curve::{self, DIGITS, pair, separator};
use super::svg_paint::{self, paint};
use crate::Result;
use durer::curve::pieces;
use durer::math::DVec2;
use durer::paper::{dashes, dimension_strokes, text_strokes};
use durer::target::gradient::Gradient;
use durer::target::sheet::{ClipPath, PaperMark, Pen, Sheet, SheetLayer};
use std::collections::BTreeMap;
use std::io::Write;

/// Writes a sheet as an SVG document of the sheet's size.
///
/// Layers become groups with `inkscape:groupmode="layer"` and their names as labels and ids. Text is
/// drawn by the single-stroke font, so that it looks the same everywhere; `aria-label` has the text.
///
/// # Errors
/// [`crate::Error::Io`] if writing fails.
pub fn write(out: &mut impl Write, sheet: &Sheet) -> Result<()> {
    let mut text = String::new();
    let [width, height] = [sheet.size.x, sheet.size.y].map(|v| short(v, DIGITS));
    text.push_str(concat!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" ",
        "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"\n ",
    ));
    text +=
        &format!("width=\"{width}mm\" height=\"{height}mm\" viewBox=\"0 0 {width} {height}\">\n");
    if !sheet.title.is_empty() {
        text += &format!("<title>{}</title>\n", escaped(&sheet.title));
    }
    if let Some(color) = sheet.background {
        text += &format!("<rect width=\"{width}\" height=\"{height}\"{}/>\n", paint("fill", color));
    }
    out.write_all(text.as_bytes())?;
    let mut defined = Defined::default();
    for layer in &sheet.layers {
        write_layer(out, sheet, layer, &mut defined)?;
    }
    out.write_all(b"</svg>\n")?;
    Ok(())
}

/// The clip paths and gradients that a file has so far.
#[derive(Default)]
struct Defined {
    count: u64,
    /// Identifiers of gradients by their definitions.
    gradients: BTreeMap<String, String>,
}

impl Defined {
    /// Returns an identifier, which no layer has.
    fn identifier(&mut self) -> String {
        self.count += 1;
        format!("_{}", self.count)
    }

    /// Returns the identifier of a gradient, and writes it if it is new.
    fn gradient(&mut self, text: &mut String, gradient: &Gradient) -> String {
        let [start, end] = svg_paint::definition(gradient);
        let definition = format!("{start}>{end}");
        if let Some(id) = self.gradients.get(&definition) {
            return id.clone();
        }
        let id = self.identifier();
        *text += &format!("<{start} id=\"{id}\">{end}\n");
        self.gradients.insert(definition, id.clone());
        id
    }
}

/// Writes a layer; the pen of its first stroke is the group's style, so that most strokes need none.
fn write_layer(
    out: &mut impl Write,
    sheet: &Sheet,
    layer: &SheetLayer,
    defined: &mut Defined,
) -> Result<()> {
    let name = escaped(&layer.name);
    let mut text = format!(
        "<g id=\"{}\" inkscape:groupmode=\"layer\" inkscape:label=\"{name}\"",
        identifier(&layer.name)
    );
    let common = layer.marks.iter().find_map(pen_of);
    if let Some(pen) = common.and_then(|p| sheet.pens.get(p)) {
        text += " fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\"";
        text += &stroke_style(pen);
    }
    text += ">\n";
    out.write_all(text.as_bytes())?;
    for mark in &layer.marks {
        let mut text = String::new();
        write_mark(&mut text, sheet, mark, (common, &mut *defined));
        out.write_all(text.as_bytes())?;
    }
    out.write_all(b"</g>\n")?;
    Ok(())
}

/// Returns the pen of a mark's first stroke.
fn pen_of(mark: &PaperMark) -> Option<usize> {
    match mark {
        PaperMark::Stroke { pen, .. }
        | PaperMark::Curve { pen, .. }
        | PaperMark::Text { pen, .. } => Some(*pen),
        PaperMark::Fill { .. } | PaperMark::Area { .. } | PaperMark::Gradient(_) => None,
        PaperMark::Group(group) => group.marks.iter().find_map(pen_of),
        PaperMark::Dimension(d) => d.marks.iter().find_map(pen_of).or(Some(d.text.pen)),
    }
}

/// Writes a mark in a layer with a common pen.
fn write_mark(
    text: &mut String,
    sheet: &Sheet,
    mark: &PaperMark,
    (common, defined): (Option<usize>, &mut Defined),
) {
    let own_pen = |pen: usize| match sheet.pens.get(pen) {
        Some(style) if common != Some(pen) => stroke_style(style),
        _ => String::new(),
    };
    match mark {
        PaperMark::Stroke { points, closed, pen } => {
            *text += "<path";
            *text += &own_pen(*pen);
            let length = dashes::length(points, *closed);
            *text += &dash_array(sheet.pens.get(*pen), length, *closed);
            *text += " d=\"";
            path(text, points, *closed);
            *text += "\"/>\n";
        }
        PaperMark::Curve { curve, pen } => {
            let length = pieces::length(curve);
            let style = own_pen(*pen) + &dash_array(sheet.pens.get(*pen), length, curve.closed);
            match curve.whole().filter(|arc| arc.is_circular()) {
                Some(circle) => {
                    let numbers = circle.center.extend(circle.axis.length()).to_array();
                    let [x, y, r] = numbers.map(|v| short(v, DIGITS + 1));
                    *text += &format!("<circle{style} cx=\"{x}\" cy=\"{y}\" r=\"{r}\"/>\n");
                }
                None => {
                    *text += &format!("<path{style} d=\"");
                    svg_curve::path(text, curve);
                    *text += "\"/>\n";
                }
            }
        }
        PaperMark::Fill { rings, color, even_odd } => {
            fill_style(text, &paint("fill", *color), *even_odd, common);
            rings.iter().for_each(|ring| path(text, ring, true));
            *text += "\"/>\n";
        }
        PaperMark::Area { rings, color, even_odd } => {
            fill_style(text, &paint("fill", *color), *even_odd, common);
            rings.iter().for_each(|ring| svg_curve::path(text, ring));
            *text += "\"/>\n";
        }
        PaperMark::Gradient(area) => {
            let id = defined.gradient(text, &area.gradient);
            fill_style(text, &format!(" fill=\"url(#{id})\""), area.even_odd, common);
            area.rings.iter().for_each(|ring| svg_curve::path(text, ring));
            *text += "\"/>\n";
        }
        PaperMark::Text { at, text: words, height, anchor, pen } => {
            letters(text, words, &own_pen(*pen), &text_strokes(*at, words, *height, *anchor));
        }
        PaperMark::Dimension(dimension) => {
            *text += "<g>\n";
            for mark in &dimension.marks {
                write_mark(text, sheet, mark, (common, &mut *defined));
            }
            let words = &dimension.text;
            letters(text, &words.text, &own_pen(words.pen), &dimension_strokes(words));
            *text += "</g>\n";
        }
        PaperMark::Group(group) => {
            let clip = group.clip.as_ref().map(|clip| clip_path(text, clip, defined));
            *text += "<g";
            if let Some(id) = clip {
                *text += &format!(" clip-path=\"url(#{id})\"");
            }
            if group.opacity < 1.0 {
                *text += &format!(" opacity=\"{}\"", short(group.opacity, DIGITS));
            }
            *text += ">\n";
            for mark in &group.marks {
                write_mark(text, sheet, mark, (common, &mut *defined));
            }
            *text += "</g>\n";
        }
    }
}

/// Begins the path of an area with the attributes of its colour.
fn fill_style(text: &mut String, fill: &str, even_odd: bool, common: Option<usize>) {
    // Without a group's pen there is no stroke to be turned off.
    let no_stroke = if common.is_some() { " stroke=\"none\"" } else { "" };
    let rule = if even_odd { " fill-rule=\"evenodd\"" } else { "" };
    *text += &format!("<path{fill}{rule}{no_stroke} d=\"");
}

/// Writes a clip path; returns its identifier.
fn clip_path(text: &mut String, clip: &ClipPath, defined: &mut Defined) -> String {
    let id = defined.identifier();
    let rule = if clip.even_odd { " clip-rule=\"evenodd\"" } else { "" };
    *text += &format!("<clipPath id=\"{id}\"><path{rule} d=\"");
    clip.rings.iter().for_each(|ring| svg_curve::path(text, ring));
    *text += "\"/></clipPath>\n";
    id
}

/// Writes a line of text as strokes.
fn letters(text: &mut String, words: &str, style: &str, strokes: &[Vec<DVec2>]) {
    *text += &format!("<path aria-label=\"{}\"{style} d=\"", escaped(words));
    strokes.iter().for_each(|stroke| path(text, stroke, false));
    *text += "\"/>\n";
}

fn stroke_style(pen: &Pen) -> String {
    format!("{} stroke-width=\"{}\"", paint("stroke", pen.color), short(pen.width, DIGITS))
}

/// Returns the dashes of one stroke, made to fit it.
fn dash_array(pen: Option<&Pen>, length: f64, closed: bool) -> String {
    match pen.and_then(|pen| dashes::fitted(&pen.dashes, length, closed)) {
        Some(dashes) => {
            // One digit more: errors add up along the stroke.
            let list: Vec<String> = dashes.iter().map(|d| short(*d, DIGITS + 1)).collect();
            format!(" stroke-dasharray=\"{}\"", list.join(" "))
        }
        None => String::new(),
    }
}

/// Appends path data: differences to the last point, which are shorter than places. They are between
/// rounded places, so that errors do not add up.
fn path(text: &mut String, points: &[DVec2], closed: bool) {
    let rounded = |p: DVec2| (p * 1000.0).round();
    let Some((first, rest)) = points.split_first() else { return };
    let mut last = rounded(*first);
    text.push('M');
    pair(text, last);
    let mut drawn = false;
    for point in rest.iter().map(|p| rounded(*p)) {
        let step = point - last;
        if step == DVec2::ZERO {
            continue;
        }
        match (step.x == 0.0, step.y == 0.0, drawn) {
            (_, true, _) => {
                text.push('h');
                push(text, step.x / 1000.0, DIGITS);
                drawn = false;
            }
            (true, ..) => {
                text.push('v');
                push(text, step.y / 1000.0, DIGITS);
                drawn = false;
            }
            _ => {
                if drawn {
                    separator(text, step.x);
                } else {
                    text.push('l');
                }
                pair(text, step);
                drawn = true;
            }
        }
        last = point;
    }
    if closed {
        text.push('z');
    } else if last == rounded(*first) && points.len() < 3 {
        // A stroke shorter than the last digit still is a dot.
        text.push_str("h0");
    }
}

/// Returns text within an attribute or element; characters that XML forbids are left out.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            '\u{fffe}' | '\u{ffff}' => {}
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// Returns a name as an identifier of XML.
fn identifier(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' };
    let name: String = name.chars().map(plain).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("layer-{name}") }
}
