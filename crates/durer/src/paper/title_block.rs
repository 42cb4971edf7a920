//! The frame of a sheet and the title block in its lower right corner.

use super::{Angle, Options, pen_index, scale_text, text_pen};
use crate::curve::stroke_font;
use crate::math::DVec2;
use crate::target::drawing::TextAnchor;
use crate::target::sheet::{PaperMark, Pen, Sheet, SheetLayer};

/// Contents of the title block.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TitleBlock {
    /// Title: the name of the drawn object.
    pub name: String,
    /// The unit of the model, e.g. `mm`.
    pub unit: String,
    /// A date; left out if it is not given, so that the same model gives the same sheet.
    pub date: Option<String>,
}

/// Height of the block, millimetres.
pub const HEIGHT: f64 = 16.0;
/// Its width, where the paper is wide enough.
const WIDTH: f64 = 150.0;
/// Widths of the cells for scale, unit, date, and the symbol of the projection.
const SCALE: f64 = 24.0;
const UNIT: f64 = 18.0;
const DATE: f64 = 28.0;
const SYMBOL: f64 = 26.0;
/// Height of the letters of a cell's label, and of its contents.
const CAPTION: f64 = 1.8;
const TEXT: f64 = 3.5;
/// Space between a cell's border and its text.
const PAD: f64 = 1.6;
/// Widths of the frame and of lines within the block.
const FRAME: f64 = 0.5;
const THIN: f64 = 0.25;

/// Adds the layers `frame` and `title-block`.
pub fn put(sheet: &mut Sheet, title: &TitleBlock, angle: Angle, scale: f64, options: &Options) {
    let color = options.pens.color;
    let line = |width: f64| Pen { width, color, dashes: Vec::new() };
    let (frame, thin) = (pen_index(sheet, line(FRAME)), pen_index(sheet, line(THIN)));
    let (min, max) = (DVec2::splat(options.margin), sheet.size - options.margin);
    let marks = vec![rectangle(min, max, frame)];
    sheet.layers.push(SheetLayer { name: "frame".to_owned(), marks });

    let corner = DVec2::new(min.x.max(max.x - WIDTH), max.y - HEIGHT);
    let mut marks = vec![rectangle(corner, max, frame)];
    let mut block = Block { marks: &mut marks, corner, right: max.x, thin };
    symbol(block.cell(SYMBOL), angle, &mut block, thin);
    let scale = scale_text(scale);
    let date = title.date.as_deref().unwrap_or_default();
    let cells = [("DATE", date, DATE), ("UNIT", &title.unit, UNIT), ("SCALE", &scale, SCALE)];
    for (caption, text, width) in cells.into_iter().filter(|c| !c.1.is_empty()) {
        let at = block.cell(width);
        write(sheet, &mut block, caption, text, at, width, options);
    }
    let width = block.right - corner.x;
    write(sheet, &mut block, "TITLE", &title.name, corner, width, options);
    sheet.layers.push(SheetLayer { name: "title-block".to_owned(), marks });
}

/// Returns the height of letters at which a text has room: the given one, or less.
pub fn fitted(text: &str, height: f64, room: f64) -> f64 {
    let natural = stroke_font::line(text, height).advance;
    if natural > room { height * room / natural } else { height }
}

struct Block<'a> {
    marks: &'a mut Vec<PaperMark>,
    /// Its upper left corner.
    corner: DVec2,
    /// Left border of the cells placed so far.
    right: f64,
    thin: usize,
}

impl Block<'_> {
    /// Cuts a cell off the right end; its upper left corner.
    fn cell(&mut self, width: f64) -> DVec2 {
        self.right = (self.right - width).max(self.corner.x);
        let top = DVec2::new(self.right, self.corner.y);
        let points = vec![top, top + DVec2::new(0.0, HEIGHT)];
        self.marks.push(PaperMark::Stroke { points, closed: false, pen: self.thin });
        top
    }
}

/// Writes a caption and a text, small enough for the cell.
fn write(
    sheet: &mut Sheet,
    block: &mut Block,
    caption: &str,
    text: &str,
    at: DVec2,
    width: f64,
    options: &Options,
) {
    let height = fitted(text, TEXT, (width - 2.0 * PAD).max(0.0));
    let lines = [(caption, CAPTION, PAD + CAPTION), (text, height, HEIGHT - PAD - 2.0)];
    for (text, height, y) in lines.into_iter().filter(|l| l.1 > 0.05) {
        let pen = text_pen(sheet, height, options);
        let at = at + DVec2::new(PAD, y);
        block.marks.push(PaperMark::Text {
            at,
            text: text.to_owned(),
            height,
            anchor: TextAnchor::Start,
            pen,
        });
    }
}

/// Draws the symbol of the projection: a truncated cone whose narrow end is on the left, and that end as seen from the
/// left, on the side where the angle puts that view (ISO 5456-2).
fn symbol(at: DVec2, angle: Angle, block: &mut Block, pen: usize) {
    let middle = at + DVec2::new(SYMBOL, HEIGHT) * 0.5;
    let (small, large) = (2.0, 4.0);
    let apart = DVec2::new(if angle == Angle::Third { 5.5 } else { -5.5 }, 0.0);
    let (circles, cone) = (middle - apart, middle + apart);
    for radius in [small, large] {
        let points = (0..48).map(|i| {
            let (sin, cos) = libm::sincos(f64::from(i) * std::f64::consts::TAU / 48.0);
            circles + DVec2::new(cos, sin) * radius
        });
        block.marks.push(PaperMark::Stroke { points: points.collect(), closed: true, pen });
    }
    let corners = [(-4.0, -small), (4.0, -large), (4.0, large), (-4.0, small)];
    let points = corners.map(|(x, y)| cone + DVec2::new(x, y)).to_vec();
    block.marks.push(PaperMark::Stroke { points, closed: true, pen });
}

fn rectangle(min: DVec2, max: DVec2, pen: usize) -> PaperMark {
    let points = vec![min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
    PaperMark::Stroke { points, closed: true, pen }
}
