//! Lessons of filling: polygons by rows, seeds, triangles.

mod complement;
mod coverage;
mod edge_table;
mod ordered_edge_list;
mod seeds;
mod triangles;
mod triangulate;

pub(super) use edge_table::by_rows;

use super::grid::Raster;
use super::input::{Figure, Input, Options};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::words::Word;
use crate::clip::polygon as clip;
use crate::curve::Contours;
use crate::math::DVec2;
use crate::raster::coverage::FillRule;
use crate::raster::polygon;
use crate::raster::span::Span;
use crate::{Error, Result};

pub(super) const LESSONS: &[Lesson] = &[
    edge_table::LESSON,
    ordered_edge_list::LESSON,
    complement::EDGE_FILL,
    complement::FENCE_FILL,
    complement::EDGE_FLAG,
    seeds::NAIVE,
    seeds::SPANS,
    triangles::EDGE_FUNCTION,
    triangles::EDGE_WALKING,
    triangles::TILES,
    coverage::CELLS,
    coverage::PARTITION,
    triangulate::LESSON,
];

const TAKES: Word =
    Word::new("rings of at least three points", "Ringe aus mindestens drei Punkten");
const X: Word = Word::new("x", "x");
const ROW: Word = Word::new("row", "Zeile");

/// Examples of polygon fills.
const EXAMPLES: &[Example] = &[
    Example {
        name: "notch",
        title: Word::new("a notch: four edges in a row", "eine Kerbe: vier Kanten in einer Zeile"),
        input: || {
            ring(&[
                (1.0, 1.0),
                (6.0, 4.0),
                (11.0, 0.0),
                (14.0, 7.0),
                (9.0, 9.0),
                (6.0, 7.0),
                (3.0, 9.0),
            ])
        },
    },
    Example {
        name: "triangle",
        title: Word::new(
            "a triangle whose left edge continues at a corner",
            "ein Dreieck, dessen linke Kante an einer Ecke weitergeht",
        ),
        input: || ring(&[(2.0, 1.0), (10.0, 3.0), (5.0, 9.0)]),
    },
    Example {
        name: "star",
        title: Word::new(
            "a star: its middle belongs by one rule only",
            "ein Stern: Die Mitte gehört nur nach einer Regel dazu",
        ),
        input: || ring(&[(2.0, 0.0), (6.0, 11.0), (10.0, 0.0), (0.0, 7.0), (12.0, 7.0)]),
    },
    Example {
        name: "neighbours",
        title: Word::new(
            "squares with a common edge: each pixel once",
            "Quadrate mit gemeinsamer Kante: jedes Pixel einmal",
        ),
        input: || {
            let square = |x: f64| {
                [(x, 1.0), (x + 4.0, 1.0), (x + 4.0, 4.0), (x, 4.0)].map(DVec2::from).to_vec()
            };
            Input::Figure(Figure { rings: vec![square(1.0), square(5.0)], ..Figure::default() })
        },
    },
    Example::new(
        "stairs",
        "stairs: horizontal edges are left out",
        "eine Treppe: Waagrechte Kanten entfallen",
        || {
            ring(&[
                (1.0, 0.0),
                (8.0, 0.0),
                (8.0, 2.0),
                (6.0, 2.0),
                (6.0, 4.0),
                (4.0, 4.0),
                (4.0, 6.0),
                (1.0, 6.0),
            ])
        },
    ),
    Example::new(
        "sliver",
        "a sliver: rows without pixels",
        "ein Splitter: Zeilen ohne Pixel",
        || ring(&[(0.0, 0.0), (12.0, 7.0), (12.0, 8.0)]),
    ),
];

fn ring(points: &[(f64, f64)]) -> Input {
    let ring = points.iter().copied().map(DVec2::from).collect();
    Input::Figure(Figure { rings: vec![ring], ..Figure::default() })
}

/// A polygon on its grid, and what of it is filled.
#[derive(Clone)]
struct Filling {
    raster: Raster,
    rings: Vec<Vec<DVec2>>,
    spans: Vec<Span>,
}

impl Filling {
    fn new(input: &Input) -> Result<Self> {
        let figure = input.figure(TAKES)?;
        figure.ring(TAKES)?;
        let raster = Raster::around(figure.rings.iter().flatten().copied());
        let laid = |ring: &Vec<DVec2>| ring.iter().map(|&p| raster.at(p)).collect();
        let rings = figure.rings.iter().map(laid).collect();
        Ok(Self { raster, rings, spans: Vec::new() })
    }

    fn contours(&self) -> Contours {
        let mut contours = Contours::new();
        self.rings.iter().for_each(|ring| contours.push(ring.iter().copied(), true));
        contours
    }

    /// Returns the options of a fill.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a rule that pixels are not filled by.
    fn options(options: &Options) -> Result<polygon::Options> {
        let rule = match options.rule {
            clip::WindingRule::EvenOdd => FillRule::EvenOdd,
            clip::WindingRule::NonZero => FillRule::NonZero,
            other => return Err(Error::parameter("rule", other.name(), "even-odd or non-zero")),
        };
        Ok(polygon::Options { rule })
    }

    /// Returns a picture of what is filled, the latest span apart, and of the outline.
    fn picture(&self, latest: bool) -> Picture {
        let mut picture = self.raster.picture();
        for (i, span) in self.spans.iter().enumerate() {
            let look = if latest && i + 1 == self.spans.len() { Look::Now } else { Look::First };
            (span.x0..span.x1).for_each(|x| picture.cell([x, span.y], "", look));
        }
        for ring in &self.rings {
            picture
                .chain(ring.iter().chain(ring.first()).copied().collect::<Vec<_>>(), Look::Second);
        }
        picture
    }
}

/// Returns the point of a row's centre at an abscissa.
fn on_row(x: f64, y: i32) -> DVec2 {
    DVec2::new(x, f64::from(y) + 0.5)
}

/// Adds the centres of a row as a line.
fn add_row(picture: &mut Picture, y: i32) {
    let [low, high] = picture.extent;
    picture.chain([on_row(low.x, y), on_row(high.x, y)], Look::Dashed);
}
