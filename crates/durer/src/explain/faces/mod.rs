//! Lessons of visible surfaces of plane polygons.

mod a_buffer;
mod back_face;
mod bodies;
mod bsp;
mod carried;
mod csg;
mod depth;
mod depth_sort;
mod hidden_line;
mod hierarchical;
mod horizon;
mod octree;
mod orientation;
mod patches;
mod portals;
mod ray;
mod regions;
mod roberts;
mod row;
mod scan_line_z;
mod shadow_volumes;
mod triangles;
mod warnock;
mod watkins;

use super::grid::{Raster, color, letter};
use super::input::Input;
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::words::Word;
use crate::Result;
use crate::math::{DVec2, DVec3};
use crate::target::NO_ITEM;
use crate::visibility::polygons::{Face, Screen};

pub(super) use row::{Row, row_camera};
pub(super) use shadow_volumes::LESSON as SHADOW_VOLUMES;
pub(super) use triangles::Triangles;

pub(super) const LESSONS: &[Lesson] = &[
    back_face::LESSON,
    orientation::LESSON,
    depth::Z_BUFFER,
    hierarchical::LESSON,
    octree::LESSON,
    depth::PAINTER,
    depth_sort::LESSON,
    bsp::LESSON,
    warnock::LESSON,
    scan_line_z::LESSON,
    watkins::LESSON,
    a_buffer::LESSON,
    patches::LESSON,
    ray::LESSON,
    regions::LESSON,
    portals::LESSON,
    csg::LESSON,
    roberts::LESSON,
    carried::APPEL,
    carried::GALIMBERTI_MONTANARI,
    hidden_line::LESSON,
    horizon::LESSON,
];

pub(super) const TAKES: Word = Word::new(
    "plane faces of at least three corners, seen from +z",
    "ebene Flächen aus mindestens drei Ecken, von +z gesehen",
);
const FACE: Word = Word::new("face", "Fläche");
const DEPTH: Word = Word::new("depth", "Tiefe");

/// The most faces that get letters and colours of their own.
const MOST: usize = 200;

/// Examples of all methods.
const EXAMPLES: &[Example] = &[
    Example {
        name: "penetration",
        title: Word::new("two faces that pierce each other", "zwei Flächen, die sich durchdringen"),
        input: || {
            let a = slab((0.0, 1.0), (7.0, 4.0), (1.0, 4.0));
            let b = slab((2.0, 0.0), (9.0, 3.0), (4.0, 1.0));
            Input::Faces(vec![a, b])
        },
    },
    Example {
        name: "near-first",
        title: Word::new("the near face comes first", "die nahe Fläche kommt zuerst"),
        input: || {
            let near = slab((1.0, 1.0), (6.0, 4.0), (1.0, 1.0));
            let far = slab((3.0, 0.0), (9.0, 3.0), (3.0, 3.0));
            Input::Faces(vec![near, far])
        },
    },
    Example {
        name: "cyclic",
        title: Word::new(
            "three beams, each before the next: no order is right",
            "drei Balken, jeder vor dem nächsten: keine Reihenfolge stimmt",
        ),
        input: || Input::Faces(beams()),
    },
    Example::new("far-first", "the far face comes first", "die ferne Fläche kommt zuerst", || {
        let far = slab((3.0, 0.0), (9.0, 3.0), (3.0, 3.0));
        let near = slab((1.0, 1.0), (6.0, 4.0), (1.0, 1.0));
        Input::Faces(vec![far, near])
    }),
    Example::new("coplanar", "two faces in one plane", "zwei Flächen in einer Ebene", || {
        let a = slab((1.0, 1.0), (6.0, 4.0), (2.0, 2.0));
        let b = slab((3.0, 0.0), (9.0, 3.0), (2.0, 2.0));
        Input::Faces(vec![a, b])
    }),
    Example::new(
        "covered",
        "a face that another one hides wholly",
        "eine Fläche, die eine andere ganz verdeckt",
        || {
            let small = slab((3.0, 1.0), (6.0, 3.0), (4.0, 4.0));
            let large = slab((1.0, 0.0), (9.0, 4.0), (1.0, 2.0));
            Input::Faces(vec![small, large])
        },
    ),
];

/// Returns a rectangle whose distance from the eye changes from its left side to its right one.
pub(super) fn slab(low: (f64, f64), high: (f64, f64), depths: (f64, f64)) -> Vec<DVec3> {
    let corner = |x: f64, y: f64, depth: f64| DVec3::new(x, y, -depth);
    vec![
        corner(low.0, low.1, depths.0),
        corner(high.0, low.1, depths.1),
        corner(high.0, high.1, depths.1),
        corner(low.0, high.1, depths.0),
    ]
}

/// Returns three beams, of which each lies before the next, and the last before the first.
fn beams() -> Vec<Vec<DVec3>> {
    let beam = |corners: [(f64, f64, f64); 4]| {
        corners.map(|(x, y, depth)| DVec3::new(x, y, -depth)).to_vec()
    };
    vec![
        beam([(0.0, 2.0, 1.0), (10.0, 2.0, 3.0), (10.0, 4.0, 3.0), (0.0, 4.0, 1.0)]),
        beam([(7.0, 0.0, 1.0), (9.0, 0.0, 1.0), (9.0, 10.0, 3.0), (7.0, 10.0, 3.0)]),
        beam([(0.5, 2.5, 3.0), (2.0, 1.0, 3.0), (9.5, 8.5, 1.0), (8.0, 10.0, 1.0)]),
    ]
}

/// Faces on a grid of pixels, and the item of each pixel.
#[derive(Clone)]
pub(super) struct Scene {
    pub raster: Raster,
    pub faces: Vec<Face>,
    items: Vec<u32>,
}

impl Scene {
    /// Lays the faces of an input on a grid: z is measured from the eye, which is 1 before the nearest corner unless
    /// all have negative z.
    pub fn new(input: &Input) -> Result<Self> {
        let given = input.faces(TAKES)?;
        bodies::check_count(given)?;
        let raster = Raster::around(given.iter().flatten().map(|corner| corner.truncate()));
        let nearest =
            given.iter().flatten().map(|corner| corner.z).fold(f64::NEG_INFINITY, f64::max);
        let eye = if nearest < 0.0 { 0.0 } else { nearest + 1.0 };
        let laid = |corner: &DVec3| raster.at(corner.truncate()).extend(eye - corner.z);
        let face = |ring: &Vec<DVec3>| Face::new(&ring.iter().map(laid).collect::<Vec<_>>());
        let faces = given.iter().map(face).collect::<Result<Vec<_>>>()?;
        let items = vec![NO_ITEM; (raster.columns * raster.rows) as usize];
        Ok(Self { raster, faces, items })
    }

    fn screen(&self) -> Screen {
        Screen { width: self.raster.columns, height: self.raster.rows, ..Screen::default() }
    }

    fn set(&mut self, [x, y]: [u32; 2], face: u32) {
        let place = y as usize * self.raster.columns as usize + x as usize;
        if let Some(item) = self.items.get_mut(place).filter(|_| x < self.raster.columns) {
            *item = face;
        }
    }

    /// Returns a picture of the pixels in the colours of their faces, and of all outlines.
    fn picture(&self) -> Picture {
        let mut picture = self.raster.picture();
        for (place, &item) in self.items.iter().enumerate().filter(|(_, item)| **item != NO_ITEM) {
            let columns = self.raster.columns as usize;
            let at = [(place % columns) as i32, (place / columns) as i32];
            picture.colored(at, color(item as usize), "");
        }
        (0..self.faces.len()).for_each(|face| self.outline(&mut picture, face, Look::Window));
        picture
    }

    /// Adds the outline of a face and its letter.
    pub fn outline(&self, picture: &mut Picture, face: usize, look: Look) {
        let Some(own) = self.faces.get(face) else { return };
        let outline = own.outline();
        let Some(&first) = outline.first() else { return };
        picture.chain(outline.iter().copied().chain([first]).collect::<Vec<_>>(), look);
        if look == Look::Window {
            picture.label(first, (-7.0, 7.0), letter(face));
        }
    }
}

/// Returns the middle of a pixel.
fn middle([x, y]: [u32; 2]) -> DVec2 {
    DVec2::new(x.into(), y.into()) + 0.5
}

/// Returns the letter of a face's number.
fn name(face: u32) -> String {
    letter(face as usize)
}
