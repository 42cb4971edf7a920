//! A picture as SVG.

use super::hatch::hatch;
use super::{TEXT, escaped, short, width};
use crate::clip::line::{Segment, liang_barsky};
use crate::explain::picture::{Look, MarkShape, Picture};
use crate::explain::words::Language;
use crate::math::{DVec2, Rect};
use crate::trace::NoTrace;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Size of letters in pictures.
const SMALL: f64 = TEXT - 1.0;

/// Colours of Okabe and Ito (2008), which people with any colour vision can distinguish, and styles of lines.
struct Style {
    stroke: &'static str,
    width: f64,
    dash: &'static str,
    /// Colour of pixels.
    light: &'static str,
}

impl Look {
    const fn style(self) -> Style {
        let (stroke, width, light) = match self {
            Self::Pale => ("#b0b0b0", 1.5, "#e6e6e6"),
            Self::Thin => ("#999", 0.7, "#f2f2f2"),
            Self::Grid => ("#ddd", 0.6, "#fff"),
            Self::Window => ("#000", 1.6, "#555"),
            Self::Dashed => ("#777", 1.0, "#eee"),
            Self::First => ("#0072b2", 1.8, "#9ccbe8"),
            Self::Second => ("#d55e00", 1.8, "#f4b78a"),
            Self::Result => ("#009e73", 2.4, "#8fd9c0"),
            Self::Now => ("#e69f00", 3.6, "#ffd77a"),
        };
        let dash = if matches!(self, Self::Dashed) { " stroke-dasharray='4 3'" } else { "" };
        Style { stroke, width, dash, light }
    }
}

/// Returns the size of a picture whose longer side is given, in pixels.
pub(super) fn size(picture: &Picture, longest: f64) -> DVec2 {
    let [min, max] = picture.extent;
    ((max - min) * scale(picture, longest)).clamp(DVec2::splat(1.0), DVec2::splat(longest))
}

fn scale(picture: &Picture, longest: f64) -> f64 {
    let [min, max] = picture.extent;
    let scale = longest / (max - min).max_element();
    if scale.is_finite() && scale > 0.0 { scale } else { 1.0 }
}

/// Draws a picture whose longer side is given, in pixels, with its upper left corner at the origin.
pub(super) fn draw(picture: &Picture, longest: f64, language: Language) -> String {
    let size = size(picture, longest);
    let scale = scale(picture, longest);
    let (taken, crossed) = (Taken::default(), Vec::new());
    let mut pen = Pen { picture, scale, size, language, taken, crossed, out: String::new() };
    let (w, h) = (short(size.x), short(size.y));
    let _ = write!(
        pen.out,
        "<svg width='{w}' height='{h}' viewBox='0 0 {w} {h}' stroke-linejoin='round'>"
    );
    // Pixels are below everything, then their grid; texts are on top, where they know what they would cover.
    for layer in 0..3 {
        match layer {
            1 => pen.grid(),
            2 => pen.crossed_texts(),
            _ => {}
        }
        let marks = picture.marks.iter().filter(|mark| layer_of(&mark.shape) == layer);
        marks.for_each(|mark| pen.mark(&mark.shape, mark.look));
    }
    pen.out + "</svg>"
}

/// Returns the layer that a shape is drawn in, counted from the lowest.
fn layer_of(shape: &MarkShape) -> usize {
    match shape {
        MarkShape::Cell { .. } => 0,
        MarkShape::Label { .. } => 2,
        MarkShape::Chain(_) | MarkShape::Rings(_) | MarkShape::Dot(_) | MarkShape::Arrow(_) => 1,
    }
}

/// State of a drawing.
struct Pen<'a> {
    picture: &'a Picture,
    /// Pixels per unit.
    scale: f64,
    size: DVec2,
    language: Language,
    /// Texts and dots drawn so far.
    taken: Taken,
    /// Texts of pixels that lines cross: the middle, the text, its colour and that of the pixel.
    crossed: Vec<(DVec2, String, &'static str, String)>,
    out: String,
}

/// Rectangles by the cells of a grid that they touch.
#[derive(Default)]
struct Taken {
    cells: BTreeMap<[i32; 2], Vec<[DVec2; 2]>>,
}

impl Taken {
    /// Side of a cell in pixels, which most texts do not exceed.
    const CELL: f64 = 32.0;

    /// Returns the cells that a rectangle touches.
    fn cells([low, high]: [DVec2; 2]) -> impl Iterator<Item = [i32; 2]> {
        let [low, high] = [low, high].map(|p| (p / Self::CELL).floor().as_ivec2());
        (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| [x, y]))
    }

    fn add(&mut self, rectangle: [DVec2; 2]) {
        Self::cells(rectangle).for_each(|cell| {
            self.cells.entry(cell).or_default().push(rectangle);
        });
    }

    /// Returns whether a rectangle covers none of the others.
    fn leaves(&self, rectangle: &[DVec2; 2]) -> bool {
        let [low, high] = rectangle;
        let covers = |other: &[DVec2; 2]| low.cmplt(other[1]).all() && other[0].cmplt(*high).all();
        !Self::cells(*rectangle).filter_map(|cell| self.cells.get(&cell)).flatten().any(covers)
    }
}

impl Pen<'_> {
    /// Returns the place of a point in pixels.
    fn at(&self, p: DVec2) -> DVec2 {
        let [min, _] = self.picture.extent;
        let p = (p - min) * self.scale;
        if self.picture.down { p } else { DVec2::new(p.x, self.size.y - p.y) }
    }

    fn path(&self, points: &[DVec2]) -> String {
        let mut d = String::new();
        for (i, p) in points.iter().map(|&p| self.at(p)).enumerate() {
            let command = if i == 0 { 'M' } else { 'L' };
            let _ = write!(d, "{command}{} {}", short(p.x), short(p.y));
        }
        d
    }

    fn stroke(&mut self, d: &str, look: Look, more: &str) {
        if d.is_empty() {
            return;
        }
        let Style { stroke, width, dash, .. } = look.style();
        let _ = write!(
            self.out,
            "<path d='{d}' fill='none' stroke='{stroke}' stroke-width='{width}'{dash}{more}/>"
        );
    }

    fn mark(&mut self, shape: &MarkShape, look: Look) {
        match shape {
            MarkShape::Chain(points) => self.stroke(&self.path(points), look, ""),
            MarkShape::Rings(rings) => self.area(rings, look),
            MarkShape::Dot(p) => self.dot(self.at(*p), look),
            MarkShape::Arrow([from, to]) => self.arrow(*from, *to, look),
            MarkShape::Label { at, by, text } => self.label(*at, *by, &text.text(self.language)),
            MarkShape::Cell { at, color, text } => {
                let light = look.style().light.to_owned();
                let fill = color.map_or(light, |[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}"));
                let dark =
                    color.is_some_and(|c| c.iter().map(|&c| u32::from(c)).sum::<u32>() < 330);
                self.cell(
                    *at,
                    &fill,
                    &text.text(self.language),
                    dark || look == Look::Window && color.is_none(),
                );
            }
        }
    }

    fn area(&mut self, rings: &[Vec<DVec2>], look: Look) {
        let d: String = rings.iter().map(|ring| self.path(ring) + "Z").collect();
        let Style { stroke, width, dash, light } = look.style();
        let fill = if look == Look::Result { "0.55" } else { "0" };
        let _ = write!(
            self.out,
            "<path d='{d}' fill='{light}' fill-opacity='{fill}' fill-rule='evenodd' stroke='{stroke}' \
             stroke-width='{width}'{dash}/>"
        );
        if matches!(look, Look::First | Look::Second) {
            let placed: Vec<Vec<DVec2>> =
                rings.iter().map(|ring| ring.iter().map(|&p| self.at(p)).collect()).collect();
            let mut d = String::new();
            for [a, b] in hatch(&placed, self.size, look == Look::First) {
                let _ = write!(d, "M{} {}L{} {}", short(a.x), short(a.y), short(b.x), short(b.y));
            }
            let _ = write!(
                self.out,
                "<path d='{d}' fill='none' stroke='{stroke}' stroke-width='0.5'/>"
            );
        }
    }

    /// Draws a dot whose form shows its kind, too.
    fn dot(&mut self, p: DVec2, look: Look) {
        let color = look.style().stroke;
        // Texts that come later leave it free.
        self.taken.add([p - 2.5, p + 2.5]);
        let (x, y) = (short(p.x), short(p.y));
        let _ = match look {
            Look::Second => {
                let (x, y) = (short(p.x - 3.2), short(p.y - 3.2));
                write!(self.out, "<rect x='{x}' y='{y}' width='6.4' height='6.4' fill='{color}'/>")
            }
            Look::Result => write!(
                self.out,
                "<circle cx='{x}' cy='{y}' r='3.8' fill='#fff' stroke='{color}' stroke-width='2'/>"
            ),
            Look::Now => write!(
                self.out,
                "<circle cx='{x}' cy='{y}' r='4.6' fill='{color}' stroke='#000' stroke-width='0.8'/>"
            ),
            _ => write!(self.out, "<circle cx='{x}' cy='{y}' r='3.2' fill='{color}'/>"),
        };
    }

    fn arrow(&mut self, from: DVec2, to: DVec2, look: Look) {
        let d = self.path(&[from, to]);
        self.stroke(&d, look, "");
        let (a, b) = (self.at(from), self.at(to));
        let Some(along) = (b - a).try_normalize() else { return };
        let (back, side) = (b - along * 8.0, along.perp() * 3.5);
        let [p, q, r] =
            [b, back + side, back - side].map(|p| format!("{} {}", short(p.x), short(p.y)));
        let _ = write!(self.out, "<path d='M{p}L{q}L{r}Z' fill='{}'/>", look.style().stroke);
    }

    /// Writes a text where it covers no other one and is in the picture, if there is such a place.
    fn label(&mut self, at: DVec2, by: DVec2, text: &str) {
        if text.is_empty() {
            return;
        }
        let half = DVec2::new(width(text, SMALL) / 2.0 + 1.0, SMALL / 2.0 + 1.0);
        let anchor = self.at(at);
        // Texts that are wider than high go further aside than up.
        let aside = half.x + 6.0;
        let steps = [by, -by, DVec2::new(aside, 0.0), DVec2::new(-aside, 0.0)];
        let diagonal = [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)]
            .map(|(x, y)| DVec2::new(x * aside, y * 10.0));
        let far = steps.map(|by| by * 1.9);
        let places = steps.into_iter().chain(diagonal).chain(far);
        let inside =
            |p: DVec2| p.clamp(half.min(self.size / 2.0), (self.size - half).max(self.size / 2.0));
        let boxes =
            places.map(|by| inside(anchor + by)).map(|middle| [middle - half, middle + half]);
        let mut boxes = boxes.peekable();
        let first = boxes.peek().copied();
        let Some([low, high]) = boxes.find(|b| self.taken.leaves(b)).or(first) else { return };
        self.taken.add([low, high]);
        let [x, y, w, h] = [low.x, low.y, high.x - low.x, high.y - low.y].map(short);
        let _ = write!(
            self.out,
            "<rect x='{x}' y='{y}' width='{w}' height='{h}' fill='#fff' fill-opacity='0.75'/>"
        );
        self.middle((low + high) / 2.0, text, "#222");
    }

    /// Writes a text around a point.
    fn middle(&mut self, p: DVec2, text: &str, color: &str) {
        let (x, y, text) = (short(p.x), short(p.y + 3.6), escaped(text));
        let _ = write!(
            self.out,
            "<text x='{x}' y='{y}' font-size='{SMALL}' text-anchor='middle' fill='{color}'>{text}</text>"
        );
    }

    fn cell(&mut self, [x, y]: [i32; 2], fill: &str, text: &str, dark: bool) {
        let corner = DVec2::new(x.into(), y.into());
        let (a, b) = (self.at(corner), self.at(corner + 1.0));
        let (low, high) = (a.min(b), a.max(b));
        let [x, y, w, h] = [low.x, low.y, high.x - low.x, high.y - low.y].map(short);
        let _ = write!(self.out, "<rect x='{x}' y='{y}' width='{w}' height='{h}' fill='{fill}'/>");
        if !text.is_empty() && width(text, SMALL) <= high.x - low.x + 4.0 {
            let (middle, color) = ((low + high) / 2.0, if dark { "#fff" } else { "#222" });
            if self.is_crossed(middle, text) {
                self.crossed.push((middle, text.to_owned(), color, fill.to_owned()));
            } else {
                self.middle(middle, text, color);
            }
        }
    }

    /// Returns whether a line passes through the text of a pixel; false where a dot covers it anyway.
    fn is_crossed(&self, middle: DVec2, text: &str) -> bool {
        let half = DVec2::new(width(text, SMALL) / 2.0, SMALL / 2.0);
        let Ok(bounds) = Rect::new(middle - half, middle + half) else { return false };
        let crosses = |a: DVec2, b: DVec2| {
            let segment = Segment::new(self.at(a), self.at(b));
            liang_barsky::clip(&bounds, segment, &mut NoTrace).is_ok_and(|part| part.is_some())
        };
        let mut is_crossed = false;
        for mark in &self.picture.marks {
            match &mark.shape {
                MarkShape::Dot(p) if bounds.contains(self.at(*p)) => return false,
                MarkShape::Chain(points) if !is_crossed => {
                    is_crossed = points.windows(2).any(|pair| crosses(pair[0], pair[1]));
                }
                MarkShape::Rings(rings) if !is_crossed => {
                    let sides = |ring: &Vec<DVec2>| {
                        let next = ring.iter().cycle().skip(1);
                        ring.iter().zip(next).any(|(a, b)| crosses(*a, *b))
                    };
                    is_crossed = rings.iter().any(sides);
                }
                MarkShape::Arrow([from, to]) => is_crossed |= crosses(*from, *to),
                _ => {}
            }
        }
        is_crossed
    }

    /// Writes the texts of pixels that lines cross, over these lines.
    fn crossed_texts(&mut self) {
        for (middle, text, color, fill) in std::mem::take(&mut self.crossed) {
            let half = DVec2::new(width(&text, SMALL) / 2.0 + 1.0, SMALL / 2.0);
            let [x, y] = (middle - half).to_array().map(short);
            let [w, h] = (half * 2.0).to_array().map(short);
            let _ =
                write!(self.out, "<rect x='{x}' y='{y}' width='{w}' height='{h}' fill='{fill}'/>");
            self.middle(middle, &text, color);
        }
    }

    fn grid(&mut self) {
        let Some([columns, rows]) = self.picture.grid else { return };
        let (w, h) = (f64::from(columns), f64::from(rows));
        let p = DVec2::new;
        let mut d = String::new();
        for x in (0..=columns.min(1000)).map(f64::from) {
            d += &self.path(&[p(x, 0.0), p(x, h)]);
        }
        for y in (0..=rows.min(1000)).map(f64::from) {
            d += &self.path(&[p(0.0, y), p(w, y)]);
        }
        self.stroke(&d, Look::Grid, "");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_are_found_across_cells() {
        let rectangle = |x: f64, y: f64| [DVec2::new(x, y), DVec2::new(x + 10.0, y + 10.0)];
        let mut taken = Taken::default();
        // Over the corner of four cells.
        taken.add(rectangle(27.0, 27.0));
        taken.add([DVec2::new(-1e300, 500.0), DVec2::new(-1e300, f64::NAN)]);
        for (x, y) in [(20.0, 20.0), (36.0, 20.0), (20.0, 36.0), (36.0, 36.0), (30.0, 30.0)] {
            assert!(!taken.leaves(&rectangle(x, y)), "{x} {y}");
        }
        for (x, y) in [(17.0, 30.0), (37.0, 30.0), (30.0, 17.0), (30.0, 37.0)] {
            assert!(taken.leaves(&rectangle(x, y)), "{x} {y}");
        }
    }
}
