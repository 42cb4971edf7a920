//! The lessons of points: squares of pixels, and smooth discs.

use crate::explain::frame::{Frames, Numbered, Shown, Want, record};
use crate::explain::grid::{Raster, letter, shown};
use crate::explain::input::{Figure, Input};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, IVec2, Rect};
use crate::raster::point::{self, Options, Step};
use crate::trace::PseudocodeLine;
use crate::view::window::PixelRect;
use crate::{Error, Result};
use std::f64::consts::{PI, TAU};

pub(super) const SQUARES: Lesson = Lesson {
    name: point::INFO.name,
    info: &point::INFO,
    takes: TAKES,
    examples: &[
        Example::new(
            "floor",
            "one pixel each: the middle, a side, a corner",
            "je ein Pixel: Mitte, Seite, Ecke",
            || points(NO_WINDOW, &[(1.5, 1.5), (4.0, 1.5), (6.0, 3.0), (7.75, 0.25)], 1.0),
        ),
        Example::new(
            "odd-and-even",
            "three and four pixels wide, with the centre at one place of a pixel",
            "drei und vier Pixel breit, die Mitte an derselben Stelle eines Pixels",
            || sizes(NO_WINDOW, &[((3.3, 3.7), 3.0), ((9.3, 3.7), 4.0)]),
        ),
        Example::new(
            "clipped",
            "clipped by the centre: whole or not at all",
            "nach der Mitte geclippt: ganz oder gar nicht",
            || points(WINDOW, &[(9.7, 4.2), (1.8, 6.4)], 3.0),
        ),
        Example::new(
            "borders",
            "on the borders of the window",
            "auf den Rändern des Fensters",
            || points(WINDOW, &[(2.0, 4.5), (10.0, 4.5), (6.5, 2.0), (10.0, 8.0)], 1.0),
        ),
        Example::new(
            "rounded",
            "sizes 0.2, 1.4 and 2.5: 1, 1 and 3 pixels",
            "Größen 0,2, 1,4 und 2,5: 1, 1 und 3 Pixel",
            || sizes(NO_WINDOW, &[((1.6, 2.4), 0.2), ((4.6, 2.4), 1.4), ((8.6, 2.4), 2.5)]),
        ),
        Example::new(
            "jump",
            "moved by a fifth of a pixel, the square jumps by a whole one",
            "um ein Fünftel verschoben, springt das Quadrat um ein ganzes Pixel",
            || points(NO_WINDOW, &[(3.4, 2.2), (3.6, 6.2)], 2.0),
        ),
    ],
    templates: &[&OUTSIDE, &ODD, &EVEN, &LIT],
    unreached: &[],
    make: |_, input, _, cap| make(false, input, cap),
};

pub(super) const DISCS: Lesson = Lesson {
    name: point::DISC.name,
    info: &point::DISC,
    examples: &[
        Example::new(
            "middle",
            "around the middle of a pixel: the same on all sides",
            "um die Mitte eines Pixels: nach allen Seiten gleich",
            || points(NO_WINDOW, &[(2.5, 2.5)], 3.0),
        ),
        Example::new(
            "corner",
            "around a corner: four quarters",
            "um eine Ecke: vier Viertel",
            || points(NO_WINDOW, &[(2.0, 2.0)], 2.0),
        ),
        Example::new(
            "moved",
            "moved by a fifth of a pixel: other areas, the same sum",
            "um ein Fünftel verschoben: andere Flächen, dieselbe Summe",
            || points(NO_WINDOW, &[(2.4, 2.2), (2.6, 6.2)], 2.0),
        ),
        Example::new(
            "small",
            "smaller than a pixel: dim instead of lost",
            "kleiner als ein Pixel: blass statt verloren",
            || sizes(NO_WINDOW, &[((1.5, 1.5), 0.5), ((4.0, 1.5), 0.5), ((6.5, 1.5), 1.0)]),
        ),
        Example::new(
            "clipped",
            "clipped by the centre: whole or not at all",
            "nach der Mitte geclippt: ganz oder gar nicht",
            || points(WINDOW, &[(9.7, 4.2), (1.8, 6.4)], 2.5),
        ),
        Example::new(
            "large",
            "five pixels wide: full inside, parts along the circle",
            "fünf Pixel breit: innen voll, am Kreis anteilig",
            || points(NO_WINDOW, &[(3.25, 3.0)], 5.0),
        ),
    ],
    templates: &[&OUTSIDE, &DISC, &COVERED],
    make: |_, input, _, cap| make(true, input, cap),
    ..SQUARES
};

const TAKES: Word = Word::new(
    "a line from the centre of each point to its border, which is half of its size long, or points of size 1, in pixels; a window, if there is one",
    "je Punkt eine Strecke von der Mitte zum Rand, halb so lang wie seine Größe, oder Punkte der Größe 1, in Pixeln; ein Fenster, wenn es eines gibt",
);

type Corners = Option<[(f64, f64); 2]>;

const NO_WINDOW: Corners = None;
const WINDOW: Corners = Some([(2.0, 2.0), (10.0, 8.0)]);

/// Returns an input of points of one size.
fn points(window: Corners, centers: &[(f64, f64)], size: f64) -> Input {
    let all: Vec<_> = centers.iter().map(|center| (*center, size)).collect();
    sizes(window, &all)
}

/// Returns an input of points with their sizes.
fn sizes(window: Corners, points: &[((f64, f64), f64)]) -> Input {
    let window = window.and_then(|[low, high]| Rect::new(low.into(), high.into()).ok());
    let line = |&(center, size): &((f64, f64), f64)| {
        let center = DVec2::from(center);
        vec![center, center + DVec2::X * (0.5 * size)]
    };
    let lines = points.iter().map(line).collect();
    Input::Figure(Figure { window, lines, ..Figure::default() })
}

static OUTSIDE: Template = Template::new(
    "outside",
    "The centre of {name}, {at}, is outside of the window: the whole point is left out.",
    "Die Mitte von {name}, {at}, liegt außerhalb des Fensters: Der ganze Punkt fällt weg.",
);
static ODD: Template = Template::new(
    "square",
    "{name} = {at}, size {size}: n = {n} is odd, so the centre moves to (⌊x⌋ + ½, ⌊y⌋ + ½) = {center}, the middle of a pixel.",
    "{name} = {at}, Größe {size}: n = {n} ist ungerade, also rückt die Mitte nach (⌊x⌋ + ½; ⌊y⌋ + ½) = {center}, in die Mitte eines Pixels.",
);
static EVEN: Template = Template::new(
    "square",
    "{name} = {at}, size {size}: n = {n} is even, so the centre moves to (⌊x + ½⌋, ⌊y + ½⌋) = {center}, a corner of pixels.",
    "{name} = {at}, Größe {size}: n = {n} ist gerade, also rückt die Mitte nach (⌊x + ½⌋; ⌊y + ½⌋) = {center}, auf eine Ecke von Pixeln.",
);
static LIT: Template = Template::new(
    "lit",
    "Pixel {pixel} is lit, {count} of {all}.",
    "Pixel {pixel} wird gesetzt, {count} von {all}.",
);
static DISC: Template = Template::new(
    "disc",
    "{name} = {at}, size {size}: a disc of radius r = {r}; its area π r² is {whole}.",
    "{name} = {at}, Größe {size}: eine Scheibe mit dem Radius r = {r}; ihre Fläche π r² ist {whole}.",
);
static COVERED: Template = Template::new(
    "covered",
    "The area of the disc in pixel {pixel} is {area}: its alpha is multiplied by it. The sum so far is {sum}.",
    "Die Fläche der Scheibe in Pixel {pixel} ist {area}: Damit wird sein Alpha multipliziert. Die Summe ist bis hier {sum}.",
);

const POINT: Word = Word::new("point", "Punkt");
const PLACE: Word = Word::new("x, y", "x; y");
const PIXELS: Word = Word::new("pixels", "Pixel");

/// A point, and what is known of it.
#[derive(Clone)]
struct Dot {
    /// Centre, in pixels.
    at: DVec2,
    size: f64,
    /// Side and centre of its square.
    square: Option<(i32, DVec2)>,
    is_outside: bool,
    pixels: Vec<(IVec2, f64)>,
}

impl Dot {
    /// Returns the sum of the areas of its pixels so far.
    fn sum(&self) -> f64 {
        self.pixels.iter().map(|(_, area)| area).sum()
    }

    /// Returns the area of the disc.
    fn whole(&self) -> f64 {
        PI * self.size * self.size / 4.0
    }
}

#[derive(Clone)]
struct State {
    smooth: bool,
    raster: Raster,
    window: Option<PixelRect>,
    dots: Vec<Dot>,
}

fn make(smooth: bool, input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    let ends = figure.lines.iter().filter_map(|line| Some([*line.first()?, *line.last()?]));
    let half = DVec2::new(0.5, 0.0);
    let ends: Vec<[DVec2; 2]> = ends.chain(figure.points.iter().map(|p| [*p, *p + half])).collect();
    if ends.is_empty() {
        return Err(Error::parameter("input", "without a point", TAKES.en));
    }
    let corners = figure.window.iter().flat_map(|window| [window.min(), window.max()]);
    let around = ends.iter().flat_map(|[center, border]| {
        let r = center.distance(*border);
        [*center - r, *center + r]
    });
    let raster = Raster::around(corners.chain(around));
    let window = figure.window.map(|window| {
        let [low, high] = [window.min(), window.max()].map(|p| raster.at(p).round().as_ivec2());
        PixelRect::spanning(low.x, low.y, high.x, high.y)
    });
    let dots = ends.iter().map(|ends| {
        let [at, border] = ends.map(|p| raster.at(p));
        // Without the noise of the ends' decimals, which would decide on 2.5.
        let size = (2000.0 * at.distance(border)).round() / 1000.0;
        Dot {
            at,
            size: size.min(point::MAX_SIZE),
            square: None,
            is_outside: false,
            pixels: Vec::new(),
        }
    });
    let mut state = State { smooth, raster, window, dots: dots.collect() };
    let steps = record(cap, |t| {
        for (number, dot) in state.dots.iter().enumerate() {
            let options = Options { size: dot.size, smooth, window };
            point::draw(dot.at, &options, |_, _| {}, &mut Numbered { number, t });
        }
        Ok(())
    })?;
    Ok(Frames::new(steps, move |(number, step), want| state.show(*number, step, want)))
}

impl State {
    fn show(&mut self, number: usize, step: &Step, want: Want) -> Shown {
        let caption = self.take(number, step);
        want.shown(step.line(), caption, || self.table(), || self.picture(number))
    }

    fn take(&mut self, number: usize, step: &Step) -> Caption {
        let dot = &mut self.dots[number];
        let name = ("name", letter(number).into());
        let (at, size) = (("at", rounded(dot.at).into()), ("size", dot.size.into()));
        match *step {
            Step::Outside => {
                dot.is_outside = true;
                OUTSIDE.with([name, at])
            }
            Step::Square { side, center } => {
                dot.square = Some((side, center));
                let template = if side % 2 == 1 { &ODD } else { &EVEN };
                template.with([name, at, size, ("n", side.into()), ("center", center.into())])
            }
            Step::Lit(pixel) => {
                dot.pixels.push((pixel, 1.0));
                let all = dot.square.map_or(0, |(side, _)| side * side);
                let count = ("count", dot.pixels.len().into());
                LIT.with([("pixel", shown(pixel)), count, ("all", all.into())])
            }
            Step::Disc { diameter } => {
                let (r, whole) = ((diameter / 2.0).into(), dot.whole().into());
                DISC.with([name, at, size, ("r", r), ("whole", whole)])
            }
            Step::Covered { pixel, area } => {
                dot.pixels.push((pixel, area));
                let sum = ("sum", dot.sum().into());
                COVERED.with([("pixel", shown(pixel)), ("area", area.into()), sum])
            }
        }
    }

    /// Returns what is known of the points.
    fn table(&self) -> Table {
        let mut table = if self.smooth {
            let sum = Word::new("sum of areas", "Summe der Flächen");
            Table::new([POINT, PLACE, Word::new("r", "r"), PIXELS, sum, Word::new("π r²", "π r²")])
        } else {
            let size = Word::new("size", "Größe");
            let center = Word::new("centre", "Mitte");
            Table::new([POINT, PLACE, size, Word::new("n", "n"), center, PIXELS])
        };
        for (number, dot) in self.dots.iter().enumerate() {
            let at = Value::from(rounded(dot.at));
            let name = letter(number);
            if self.smooth {
                let numbers = [dot.pixels.len() as f64, dot.sum(), dot.whole()];
                let numbers = numbers.map(Value::from);
                table.row(name, [at, (dot.size / 2.0).into()].into_iter().chain(numbers));
            } else {
                let [side, center] = match dot.square {
                    Some((side, center)) => [side.into(), center.into()],
                    None => ["–".into(), "–".into()],
                };
                table.row(name, [at, dot.size.into(), side, center, dot.pixels.len().into()]);
            }
        }
        table
    }

    /// Draws the pixels of all points, with the area in each, the window, and the outline of the current point.
    fn picture(&self, number: usize) -> Picture {
        let mut picture = self.raster.picture();
        for (pixel, area) in self.dots.iter().flat_map(|dot| &dot.pixels) {
            let text: Value = match self.smooth {
                true => ((area * 100.0).round() / 100.0).into(),
                false => "".into(),
            };
            picture.colored(pixel.to_array(), shade(*area), text);
        }
        let dot = &self.dots[number];
        if let Some((pixel, _)) = dot.pixels.last() {
            let low = pixel.as_dvec2();
            Rect::new(low, low + 1.0).iter().for_each(|cell| picture.frame(cell, Look::Now));
        }
        let window = self.window.and_then(|w| {
            let corner = |x: i32, y: i32| DVec2::new(x.into(), y.into());
            Rect::new(corner(w.x0(), w.y0()), corner(w.x1(), w.y1())).ok()
        });
        window.iter().for_each(|window| picture.frame(window, Look::Window));
        let look = if dot.is_outside { Look::Pale } else { Look::Second };
        let half = 0.5 * dot.size;
        if self.smooth {
            let angle = |k: u32| TAU * f64::from(k) / 48.0;
            let at = |k| dot.at + half * DVec2::new(libm::cos(angle(k)), libm::sin(angle(k)));
            picture.chain((0..=48).map(at).collect::<Vec<_>>(), look);
        } else if let Ok(outline) = Rect::new(dot.at - half, dot.at + half) {
            picture.frame(&outline, look);
        }
        for (number, dot) in self.dots.iter().enumerate() {
            let look = if dot.is_outside { Look::Pale } else { Look::Second };
            picture.dot(dot.at, look);
            // Beside the pixels, which have numbers.
            let left = DVec2::new((dot.at.x - 0.5 * dot.size).floor(), dot.at.y);
            picture.label(left, (-9.0, 0.0), letter(number));
        }
        picture
    }
}

/// Returns a point without the noise of sums of decimals.
fn rounded(p: DVec2) -> DVec2 {
    (p * 1000.0).round() / 1000.0
}

/// Returns a light blue, paler for smaller areas.
fn shade(area: f64) -> [u8; 3] {
    let full = [0x9c_u8, 0xcb, 0xe8];
    full.map(|c| (255.0 - area * (255.0 - f64::from(c))).round() as u8)
}
