//! A bar with the colours of heights.

use super::ticks::{offset, short, ticks};
use super::{BAR, MARGIN, Options, SHADES, bar_width, index_of};
use crate::math::DVec2;
use crate::target::drawing::TextAnchor;
use crate::target::sheet::{PaperMark, Pen, Sheet};

/// Returns its labelled heights, with their distance from its foot as a share of its length; empty if
/// there is no bar.
pub fn labels(heights: Option<[f64; 2]>, options: &Options) -> Vec<(f64, String)> {
    let Some([low, high]) = heights else { return Vec::new() };
    if !options.color_bar || options.color_map.is_none() {
        return Vec::new();
    }
    let base = offset([low, high]);
    let wanted = (options.page.y * BAR[2] / (4.0 * options.text)).clamp(1.0, 8.0) as usize;
    let part = |value: f64| if high > low { (value - (low - base)) / (high - low) } else { 0.5 };
    let ticks = ticks([low - base, high - base], wanted);
    let mut labels: Vec<_> = ticks.into_iter().map(|(v, text)| (part(v), text)).collect();
    if base != 0.0 {
        // Above the bar.
        let sign = if base > 0.0 { '+' } else { '-' };
        labels.push((
            1.0 + 2.0 * options.text / length(options),
            format!("{sign} {}", short(base.abs())),
        ));
    }
    labels
}

/// Returns the length of the bar, millimetres.
fn length(options: &Options) -> f64 {
    options.page.y * BAR[2]
}

/// Returns the bar on the right of the page, with its labels.
pub fn marks(sheet: &mut Sheet, heights: Option<[f64; 2]>, options: &Options) -> Vec<PaperMark> {
    let (labels, Some(map)) = (labels(heights, options), options.color_map) else {
        return Vec::new();
    };
    if labels.is_empty() {
        return Vec::new();
    }
    let (length, width) = (length(options), BAR[0] * options.text);
    let left = options.page.x - MARGIN - bar_width(heights, options) + BAR[1] * options.text;
    let foot = (options.page.y + length) * 0.5;
    let at = |part: f64| foot - part * length;
    let corners = |from: f64, to: f64| {
        [(left, from), (left + width, from), (left + width, to), (left, to)]
            .map(|(x, part)| DVec2::new(x, at(part)))
            .to_vec()
    };
    let share = |shade: usize| shade as f64 / SHADES as f64;
    let mut marks: Vec<PaperMark> = (0..SHADES)
        .map(|shade| PaperMark::Fill {
            // Up to the end, under the following ones, so that no seam is visible.
            rings: vec![corners(share(shade), 1.0)],
            color: map.at(share(shade) + 0.5 / SHADES as f64),
            even_odd: false,
        })
        .collect();
    let pen = |width| Pen { width, color: options.ink, dashes: Vec::new() };
    let (line, letters) = (pen(options.pen), pen(options.text * 0.1));
    let line = index_of(&mut sheet.pens, line);
    let letters = index_of(&mut sheet.pens, letters);
    marks.push(PaperMark::Stroke { points: corners(0.0, 1.0), closed: true, pen: line });
    for (part, text) in labels {
        let (right, height) = (left + width, at(part));
        let tick = |x: f64| DVec2::new(x, height);
        if part <= 1.0 {
            let points = vec![tick(right), tick(right + 0.5 * options.text)];
            marks.push(PaperMark::Stroke { points, closed: false, pen: line });
        }
        let at = DVec2::new(right + options.text, height + 0.5 * options.text);
        let anchor = TextAnchor::Start;
        marks.push(PaperMark::Text { at, text, height: options.text, anchor, pen: letters });
    }
    marks
}
