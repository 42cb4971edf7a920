//! A chart with curves and their names.

use durer::Result;
use durer::curve::{Path, stroke_font};
use durer::math::DVec2;
use durer::raster::{line::wide::Stroke, paint::Canvas, paint::Color};
use durer::target::Pixels;

const SIZE: [u32; 2] = [580, 340];

/// Position of the vertical axis.
const LEFT: f64 = 72.0;

const BLACK: Color = [20, 20, 30, 255];

pub struct Chart {
    canvas: Canvas,
    curves: usize,
    /// The power of ten at the axis.
    floor: f64,
    /// Pixels of the chart for each.
    decade: f64,
    /// Between places along the axis.
    step: f64,
}

/// Quantities on the axes.
pub struct Axis {
    /// The smallest and the largest value there are.
    pub range: [f64; 2],
    /// Names of the places along the axis.
    pub places: Vec<String>,
}

impl Chart {
    /// Creates two axes with a line of text below. The vertical axis shows powers of ten.
    pub fn new(title: &str, axis: Axis) -> Result<Self> {
        let canvas = Canvas::new(SIZE[0], SIZE[1], Default::default())?;
        let [least, most] = axis.range.map(|value| libm::log10(value.max(1e-9)));
        let floor = libm::floor(least);
        let decades = (libm::ceil(most) - floor).max(1.0);
        let step = 300.0 / (axis.places.len().max(2) - 1) as f64;
        let mut chart = Self { canvas, curves: 0, floor, decade: 260.0 / decades, step };
        let axes = [(LEFT, 20.), (LEFT, 290.), (LEFT + 330.0, 290.)];
        chart.line(&Path::polyline(axes.map(DVec2::from)), BLACK)?;
        for power in 0..=decades as i32 {
            let value = libm::exp10(floor + f64::from(power));
            let y = chart.up(value);
            chart.line(&Path::polyline([DVec2::new(LEFT - 4.0, y), DVec2::new(LEFT, y)]), BLACK)?;
            let text = format!("{value}");
            chart.text(&text, DVec2::new(LEFT - 7.0 - 8.2 * text.len() as f64, y + 4.0), BLACK)?;
        }
        for (i, place) in axis.places.iter().enumerate() {
            let x = LEFT + 10.0 + step * i as f64;
            chart.text(place, DVec2::new(x - 3.5 * place.len() as f64, 306.0), BLACK)?;
        }
        chart.text(title, DVec2::new(LEFT, 330.0), BLACK)?;
        Ok(chart)
    }

    /// Returns the height of a value.
    fn up(&self, value: f64) -> f64 {
        290.0 - self.decade * (libm::log10(value) - self.floor)
    }

    /// Draws a curve at equal distances in x, with the logarithms of the values in y.
    pub fn curve(&mut self, name: &str, values: &[f64]) -> Result<()> {
        let k = self.curves;
        self.curves += 1;
        let ink = [(k * 97 % 200) as u8, (k * 151 % 180) as u8, (k * 61 % 220) as u8, 255];
        let place =
            |(i, v): (usize, &f64)| DVec2::new(LEFT + 10.0 + self.step * i as f64, self.up(*v));
        self.line(&Path::polyline(values.iter().enumerate().map(place)), ink)?;
        self.text(name, DVec2::new(LEFT + 345.0, 40.0 + 26.0 * k as f64), ink)
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
