//! Frames as SVG: one with its state, or many side by side.

mod figure;
mod hatch;
mod state;

use super::letters::{width, wrap};
use super::picture::Picture;
use super::replay::Frame;
use super::words::Language;
use std::fmt::Write;

/// Size of text in pixels.
const TEXT: f64 = 11.0;
/// Distance of lines of text.
const LINE: f64 = 15.0;
/// Free space between panels and around them.
const GAP: f64 = 14.0;
/// Longest side of a picture on a sheet, and alone.
const PANEL: f64 = 250.0;
const ALONE: f64 = 420.0;

/// Draws one frame: the picture, the caption, and the state as a table, whose changed cells are marked.
pub fn svg(frame: &Frame, language: Language) -> String {
    let size = figure::size(&frame.picture, ALONE);
    let table = state::table(&frame.table, language);
    let wide = size.x.max(table.width).max(ALONE);
    let lines = wrap(&frame.text(language), TEXT, wide);
    let below = GAP + size.y + 6.0;
    let under = below + lines.len() as f64 * LINE + 8.0;
    let mut out = opening(wide + 2.0 * GAP, under + table.height + GAP);
    group(
        &mut out,
        (GAP + (wide - size.x) / 2.0, GAP),
        &figure::draw(&frame.picture, ALONE, language),
    );
    text_lines(&mut out, (GAP, below), &lines);
    group(&mut out, (GAP, under), &table.body);
    out + "</svg>\n"
}

/// Draws frames side by side in rows of this many, each with its number and its caption.
pub fn sheet(frames: &[Frame], columns: usize, language: Language) -> String {
    let columns = columns.min(frames.len()).max(1);
    let wide = frames
        .iter()
        .map(|frame| figure::size(&frame.picture, PANEL).x)
        .fold(PANEL * 0.8, f64::max);
    let mut body = String::new();
    let mut y = GAP;
    for row in frames.chunks(columns) {
        let high =
            row.iter().map(|frame| figure::size(&frame.picture, PANEL).y).fold(0.0, f64::max);
        let mut lines = 0;
        for (i, frame) in row.iter().enumerate() {
            let x = GAP + i as f64 * (wide + GAP);
            let text = format!("{}. {}", frame.number, frame.text(language));
            let caption = wrap(&text, TEXT, wide);
            group(&mut body, (x, y), &figure::draw(&frame.picture, PANEL, language));
            text_lines(&mut body, (x, y + high + 4.0), &caption);
            lines = lines.max(caption.len());
        }
        y += high + 4.0 + lines as f64 * LINE + GAP;
    }
    opening(GAP + columns as f64 * (wide + GAP), y) + &body + "</svg>\n"
}

/// Draws a picture alone, for pages that show the rest themselves.
pub fn picture(picture: &Picture, language: Language) -> String {
    picture_of_size(picture, ALONE, language)
}

/// Draws a picture alone whose longer side is given in pixels, from 1 to 10,000; texts and lines keep their size.
pub fn picture_of_size(picture: &Picture, longest: f64, language: Language) -> String {
    let longest = if longest.is_finite() { longest.clamp(1.0, 10_000.0) } else { ALONE };
    let size = figure::size(picture, longest);
    let mut out = opening(size.x, size.y);
    out += &figure::draw(picture, longest, language);
    out + "</svg>\n"
}

fn opening(w: f64, h: f64) -> String {
    let (w, h) = (short(w.ceil()), short(h.ceil()));
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{w}' height='{h}' viewBox='0 0 {w} {h}' \
         font-family='DejaVu Sans,Verdana,sans-serif' font-size='{TEXT}'>\n\
         <rect width='{w}' height='{h}' fill='#fff'/>\n"
    )
}

/// Writes a group that is moved to a point.
fn group(out: &mut String, (x, y): (f64, f64), body: &str) {
    if !body.is_empty() {
        let _ = writeln!(out, "<g transform='translate({} {})'>{body}</g>", short(x), short(y));
    }
}

/// Writes lines of text below a point.
fn text_lines(out: &mut String, (x, y): (f64, f64), lines: &[String]) {
    for (i, line) in lines.iter().enumerate() {
        let y = y + (i as f64 + 1.0) * LINE - 4.0;
        text(out, (x, y), line, "");
    }
}

/// Writes a line of text that begins at a point of its baseline.
fn text(out: &mut String, (x, y): (f64, f64), line: &str, more: &str) {
    let (x, y) = (short(x), short(y));
    let _ = writeln!(out, "<text x='{x}' y='{y}' fill='#222'{more}>{}</text>", escaped(line));
}

/// Returns text with what has a meaning in XML written out; control characters, which it must not have, are dropped.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars().filter(|c| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}'))
    {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '\'' => out.push_str("&#39;"),
            '"' => out.push_str("&quot;"),
            _ => out.push(letter),
        }
    }
    out
}

/// Returns a number of pixels; a tenth is fine enough.
fn short(x: f64) -> String {
    let tenths = (x * 10.0).round() / 10.0;
    format!("{}", tenths + 0.0)
}
