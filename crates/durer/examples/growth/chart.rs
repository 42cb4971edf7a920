//! A chart with curves and their names.

use durer::Result;
use durer::curve::{Path, stroke_font};
use durer::math::DVec2;
use durer::raster::{line::wide::Stroke, paint::Canvas, paint::Color};
use durer::target::Pixels;

const SIZE: [u32; 2] = [560, 340];

const BLACK: Color = [20, 20, 30, 255];

pub struct Chart {
    canvas: Canvas,
    curves: usize,
}

impl Chart {
    /// Two axes, and a line of text below.
    pub fn new(title: &str) -> Result<Self> {
        let canvas = Canvas::new(SIZE[0], SIZE[1], Default::default())?;
        let mut chart = Self { canvas, curves: 0 };
        let axes = [(50., 20.), (50., 300.), (380., 300.)];
        chart.line(&Path::polyline(axes.map(DVec2::from)), BLACK)?;
        chart.text(title, DVec2::new(50.0, 328.0), BLACK)?;
        Ok(chart)
    }

    /// A curve at equal distances in x; upwards the logarithm of the values, 100 at the axis.
    pub fn curve(&mut self, name: &str, values: &[f64]) -> Result<()> {
        let k = self.curves;
        self.curves += 1;
        let ink = [(k * 97 % 200) as u8, (k * 151 % 180) as u8, (k * 61 % 220) as u8, 255];
        let up = |v: &f64| 300.0 - 60.0 * (libm::log10(*v) - 2.0);
        let place = |(i, v)| DVec2::new(60.0 + 100.0 * i as f64, up(v));
        self.line(&Path::polyline(values.iter().enumerate().map(place)), ink)?;
        self.text(name, DVec2::new(395.0, 40.0 + 26.0 * k as f64), ink)
    }

    pub fn picture(&self) -> Result<Pixels<[u8; 4]>> {
        let mut picture = Pixels::new(SIZE[0], SIZE[1], [255; 4]);
        self.canvas.render(&mut picture)?;
        Ok(picture)
    }

    fn line(&mut self, path: &Path, ink: Color) -> Result<()> {
        let stroke = Stroke { width: 1.6, ..Stroke::default() };
        self.canvas.stroke(path, &stroke, &ink.into(), 1.0)
    }

    fn text(&mut self, text: &str, at: DVec2, ink: Color) -> Result<()> {
        let strokes = stroke_font::line(text, 10.0).strokes.into_iter();
        let paths = strokes.map(|s| Path::polyline(s.into_iter().map(|p| p + at)));
        paths.into_iter().try_for_each(|path| self.line(&path, ink))
    }
}
