//! Panels side by side, each with a caption, as SVG.

use std::fmt::Write as _;

use durer::math::{DVec2, Rect};

/// Width of a panel and height of its caption, in pixels.
const WIDTH: f64 = 200.0;
const CAPTION: f64 = 30.0;
const GAP: f64 = 10.0;

/// Looks, as the style sheet names them.
const STYLE: &str = "text{font:10px sans-serif;fill:#222}path,line{fill:none;stroke-linejoin:round}\
.win{stroke:#222;stroke-width:1.5}.pale{stroke:#c4c4c4;stroke-width:1.5}.thin{stroke:#bbb;stroke-width:.7}\
.grid{stroke:#ddd;stroke-width:.6}.a{stroke:#1f6fb4;stroke-width:2}.b{stroke:#d1495b;stroke-width:2}\
.fa{fill:#1f6fb433;stroke:#1f6fb4;stroke-width:1.5}.fb{fill:#d1495b22;stroke:#d1495b;stroke-width:1.5}\
.fc{fill:#3a9d5d55;stroke:#2b7a48;stroke-width:2}.dash{stroke:#888;stroke-width:1;stroke-dasharray:3 3}\
.c{stroke:#2b7a48;stroke-width:2}.seen{stroke:#1f6fb4;stroke-width:.9}.under{stroke:#d1495b;stroke-width:.9}";

/// A drawing with its caption; positions are in the window given to [`Panel::new`].
pub struct Panel {
    window: Rect,
    /// True if y grows downwards, as rows of pixels do.
    down: bool,
    caption: String,
    body: String,
}

impl Panel {
    pub fn new(min: (f64, f64), max: (f64, f64)) -> durer::Result<Self> {
        let window = Rect::new(min.into(), max.into())?;
        Ok(Self { window, down: false, caption: String::new(), body: String::new() })
    }

    /// For pixels: `columns` × `rows` cells, with their grid.
    pub fn pixels(columns: u32, rows: u32) -> durer::Result<Self> {
        let (w, h) = (f64::from(columns), f64::from(rows));
        let mut panel = Self::new((-0.2, -0.2), (w + 0.2, h + 0.2))?;
        panel.down = true;
        for x in 0..=columns {
            panel.line([(f64::from(x), 0.0), (f64::from(x), h)].map(DVec2::from), "grid");
        }
        for y in 0..=rows {
            panel.line([(0.0, f64::from(y)), (w, f64::from(y))].map(DVec2::from), "grid");
        }
        Ok(panel)
    }

    pub fn caption(mut self, text: impl Into<String>) -> Self {
        self.caption = text.into();
        self
    }

    fn scale(&self) -> f64 {
        WIDTH / self.window.size().x
    }

    fn height(&self) -> f64 {
        self.window.size().y * self.scale()
    }

    fn at(&self, p: DVec2) -> DVec2 {
        let p = (p - self.window.min()) * self.scale();
        if self.down { p } else { DVec2::new(p.x, self.height() - p.y) }
    }

    pub fn line(&mut self, ends: [DVec2; 2], class: &str) {
        self.chain(&ends, class);
    }

    fn path(&self, points: &[DVec2]) -> String {
        let mut d = String::new();
        for (i, p) in points.iter().map(|&p| self.at(p)).enumerate() {
            let command = if i == 0 { 'M' } else { 'L' };
            let _ = write!(d, "{command}{} {}", short(p.x), short(p.y));
        }
        d
    }

    pub fn chain(&mut self, points: &[DVec2], class: &str) {
        let d = self.path(points);
        let _ = write!(self.body, "<path class='{class}' d='{d}'/>");
    }

    /// Many chains of one look, as one path.
    pub fn chains<'a>(&mut self, chains: impl IntoIterator<Item = &'a [DVec2]>, class: &str) {
        let d: String = chains.into_iter().map(|chain| self.path(chain)).collect();
        let _ = write!(self.body, "<path class='{class}' d='{d}'/>");
    }

    pub fn rings<'a>(&mut self, rings: impl IntoIterator<Item = &'a [DVec2]>, class: &str) {
        let d: String = rings.into_iter().map(|ring| self.path(ring) + "Z").collect();
        let _ = write!(self.body, "<path class='{class}' fill-rule='evenodd' d='{d}'/>");
    }

    pub fn rect(&mut self, window: &Rect, class: &str) {
        let (a, b) = (window.min(), window.max());
        let corners = [a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)];
        self.rings([&corners[..]], class);
    }

    pub fn dot(&mut self, p: DVec2, color: &str) {
        let p = self.at(p);
        let _ = write!(
            self.body,
            "<circle cx='{}' cy='{}' r='3.2' fill='{color}'/>",
            short(p.x),
            short(p.y)
        );
    }

    /// Text whose middle is at a point, moved by pixels to the right and down.
    pub fn text(&mut self, p: DVec2, by: (f64, f64), text: &str) {
        let p = self.at(p) + DVec2::from(by);
        let (x, y) = (short(p.x), short(p.y + 3.5));
        let _ = write!(self.body, "<text x='{x}' y='{y}' text-anchor='middle'>{text}</text>");
    }

    /// A pixel in a colour.
    pub fn cell(&mut self, x: f64, y: f64, color: &str) {
        let p = self.at(DVec2::new(x, y));
        let (x, y, side) = (short(p.x + 0.4), short(p.y + 0.4), short(self.scale() - 0.8));
        let _ = write!(
            self.body,
            "<rect x='{x}' y='{y}' width='{side}' height='{side}' fill='{color}'/>"
        );
    }

    /// Writes a text in the middle of a pixel.
    pub fn mark(&mut self, x: f64, y: f64, text: &str) {
        self.text(DVec2::new(x + 0.5, y + 0.5), (0.0, 0.0), text);
    }
}

/// Panels in rows of `columns`, all as high as the highest.
pub fn svg(panels: &[Panel], columns: usize) -> String {
    let columns = columns.min(panels.len()).max(1);
    let height = panels.iter().map(Panel::height).fold(0.0, f64::max);
    let (dx, dy) = (WIDTH + GAP, height + CAPTION + GAP);
    let rows = panels.len().div_ceil(columns);
    let size = DVec2::new(GAP + columns as f64 * dx, GAP + rows as f64 * dy);
    let (w, h) = (short(size.x), short(size.y));
    let mut out = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{w}' height='{h}' viewBox='0 0 {w} {h}'>\n\
         <style>{STYLE}</style>\n<rect width='100%' height='100%' fill='#fff'/>\n"
    );
    for (i, panel) in panels.iter().enumerate() {
        let (x, y) = (GAP + (i % columns) as f64 * dx, GAP + (i / columns) as f64 * dy);
        let _ = writeln!(
            out,
            "<g transform='translate({} {})'><svg width='{WIDTH}' height='{}'>{}</svg>",
            short(x),
            short(y),
            short(panel.height()),
            panel.body
        );
        for (line, text) in panel.caption.lines().enumerate() {
            let below = short(height + 13.0 + 12.0 * line as f64);
            let _ = write!(out, "<text y='{below}'>{text}</text>");
        }
        out += "</g>\n";
    }
    out + "</svg>\n"
}

/// A tenth of a pixel is fine enough.
fn short(x: f64) -> String {
    let tenths = (x * 10.0).round() / 10.0;
    format!("{}", tenths + 0.0)
}

/// Returns a colour between two, for t = 0 … 1.
pub fn shade(from: [u8; 3], to: [u8; 3], t: f64) -> String {
    let mix =
        |i: usize| (f64::from(from[i]) + (f64::from(to[i]) - f64::from(from[i])) * t).round() as u8;
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}
