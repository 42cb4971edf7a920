//! Visible regions by cutting polygons along each other.
//!
//! K. Weiler, P. Atherton, *Hidden Surface Removal Using Polygon Area Sorting*, SIGGRAPH 1977. Object space. The
//! nearest polygon cuts all others like a pastry cutter: into the parts inside and outside its outline. Inside, the
//! parts behind it are removed; if none are left, it is visible there, else the remaining parts, which are in front of
//! it, are treated in the same way, and so is the outside. Coherence used: areas. Cost: O(n²) cuts where few overlap;
//! memory O(regions).
//!
//! Deviations: cuts are made by the overlay, which accepts any polygons; intersecting polygons are divided where their
//! planes meet. [`crate::visibility::region::planar_map`] finds the same regions of models in far less time.

use super::Face;
use crate::clip::line::HalfPlane;
use crate::clip::polygon::sutherland_hodgman::by_borders;
use crate::clip::polygon::{
    BooleanOp, Shapes,
    overlay::{self, overlay},
};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::{DVec2, Rect};
use crate::sorting::CompactSort;
use crate::trace::{NoTrace, PseudocodeLine, Tracer};
use crate::work::Work;
use crate::{Error, Result};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "area-sorting",
    title: "Weiler–Atherton visible regions",
    authors: "K. Weiler, P. Atherton",
    year: 1977,
    source: "Hidden Surface Removal Using Polygon Area Sorting, SIGGRAPH",
    class: Class::ObjectSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::Area, Coherence::Depth],
    cost: "O(n²) cuts where few of n polygons overlap, more where many do",
    limits: "plane polygons; cuts are rounded to 2^-37 of the picture",
    pseudocode: &[
        "lists ← { all polygons, with nothing behind them }",
        "while there are lists:",
        "    take one; if it is empty, the polygon behind it is visible: report it",
        "    P ← the polygon of the list with the nearest corner",
        "    for each other polygon Q of the list:",
        "        cut Q along the outline of P",
        "        put the parts outside into the outside list",
        "        if the parts inside are behind P: they are hidden",
        "        else: put the parts in front of P into the inside list",
        "    add the inside list, with P behind it",
        "    add the outside list, with the polygons that were behind the list",
    ],
};

/// Options for finding regions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// The most cuts that are made: each cuts one polygon along another.
    pub max_cuts: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { max_cuts: 1 << 18 }
    }
}

/// Visible part of one face.
#[derive(Debug, Clone, PartialEq)]
pub struct FaceRegion {
    /// Its index.
    pub face: u32,
    /// Visible part, in pixels.
    pub shapes: Shapes,
}

/// Step of the algorithm.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// A list's nearest polygon is taken for cutting the others.
    Nearest {
        /// Its face.
        face: u32,
        /// Number of others in its list.
        others: usize,
    },
    /// Another polygon was cut along it.
    Cut {
        /// The face that is cut.
        face: u32,
        /// Part that goes to the inside list.
        inside: Shapes,
        /// Part that goes to the outside list.
        outside: Shapes,
    },
    /// The inside part is behind and therefore hidden.
    Hidden {
        /// Its face.
        face: u32,
    },
    /// The inside part, or some of it, is in front: it is treated in its turn.
    InFront {
        /// Its face.
        face: u32,
    },
    /// Nothing is in front: this is seen.
    Seen(FaceRegion),
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Seen(_) => 3,
            Self::Nearest { .. } => 4,
            Self::Cut { .. } => 6,
            Self::Hidden { .. } => 8,
            Self::InFront { .. } => 9,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<FaceRegion> {
    let seen = |step: &Step| match step {
        Step::Seen(region) => Some(region.clone()),
        _ => None,
    };
    steps.iter().filter_map(seen).collect()
}

/// Waiting polygons, and one behind all of them that shows where they do not.
struct List {
    polygons: Vec<FaceRegion>,
    base: Option<FaceRegion>,
}

impl List {
    /// Returns the memory of its regions in bytes.
    fn bytes(&self) -> u64 {
        self.polygons.iter().chain(&self.base).map(FaceRegion::bytes).sum()
    }
}

impl FaceRegion {
    /// Returns its memory in bytes.
    fn bytes(&self) -> u64 {
        (size_of::<Self>() + size_of_val(self.shapes.points())) as u64
    }
}

/// Returns the visible regions of each face; a face may be visible in several. Of coplanar faces the first is visible.
///
/// ```
/// use durer::math::DVec3;
/// use durer::trace::NoTrace;
/// use durer::work::Work;
/// use durer::visibility::polygons::{Face, regions::regions};
///
/// let square = |low: f64, high: f64, z: f64| {
///     let corners = [(low, low), (high, low), (high, high), (low, high)];
///     Face::new(&corners.map(|(x, y)| DVec3::new(x, y, z)))
/// };
/// let faces = [square(0.0, 4.0, 2.0)?, square(1.0, 2.0, 1.0)?];
/// let seen = regions(&faces, &Default::default(), &Work::default(), &mut NoTrace)?;
/// let areas: Vec<_> = seen.iter().map(|region| (region.face, region.shapes.area())).collect();
/// assert_eq!(areas, [(0, 15.0), (1, 1.0)]);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::Limit`] for more cuts than the options allow; [`Error::Memory`] where the budget of the work does not
/// suffice.
pub fn regions(
    faces: &[Face],
    options: &Options,
    work: &Work,
    t: &mut impl Tracer<Step>,
) -> Result<Vec<FaceRegion>> {
    let Some(cutter) = Cutter::new(faces) else { return Ok(Vec::new()) };
    let whole = |(face, own): (u32, &Face)| FaceRegion {
        face,
        shapes: Shapes::from_rings([own.outline()]),
    };
    let all = (0..).zip(faces).filter(|(_, own)| own.plane().normal.z != 0.0);
    let charged = |list: List| Ok((work.charge("regions of polygons", list.bytes())?, list));
    let mut lists = vec![charged(List { polygons: all.map(whole).collect(), base: None })?];
    let (mut seen, mut cuts) = (Vec::new(), 0);
    let mut of_seen = work.charge("regions of polygons", 0)?;
    while let Some((_charge, mut list)) = lists.pop() {
        let Some(nearest) = cutter.take_nearest(&mut list.polygons) else {
            if let Some(base) = list.base {
                t.step(|| Step::Seen(base.clone()));
                of_seen.grow(base.bytes())?;
                seen.push(base);
            }
            continue;
        };
        t.step(|| Step::Nearest { face: nearest.face, others: list.polygons.len() });
        cuts += list.polygons.len();
        if cuts > options.max_cuts {
            let (value, limit) = (cuts as u64, options.max_cuts as u64);
            return Err(Error::Limit { what: "number of cuts of polygons", value, limit });
        }
        let [inside, outside] = cutter.cut(nearest, list, t)?;
        lists.extend([charged(outside)?, charged(inside)?]);
    }
    seen.compact_sort_by_key(|region| region.face);
    Ok(seen)
}

/// Facts about all faces that cutting needs.
struct Cutter<'a> {
    faces: &'a [Face],
    around: Rect,
    /// The grid that cuts are rounded to.
    grid: f64,
    /// Difference below which depths are equal.
    equal: f64,
}

impl<'a> Cutter<'a> {
    fn new(faces: &'a [Face]) -> Option<Self> {
        let corners = || faces.iter().flat_map(Face::corners);
        let around = Rect::around(corners().map(|c| c.truncate()))?;
        let reach = around.min().abs().max(around.max().abs()).max_element();
        let deep = corners().fold(0.0, |all: f64, c| all.max(c.z.abs()));
        let grid = libm::scalbn(1.0, libm::ilogb(reach.max(f64::MIN_POSITIVE)) - 37);
        Some(Self { faces, around, grid, equal: 1e-9 * (1.0 + deep) })
    }

    /// Removes the polygon with the nearest corner from a list and returns it.
    fn take_nearest(&self, polygons: &mut Vec<FaceRegion>) -> Option<FaceRegion> {
        let z = |region: &FaceRegion| self.faces[region.face as usize].depths()[0];
        let order =
            |a: &FaceRegion, b: &FaceRegion| z(a).total_cmp(&z(b)).then(a.face.cmp(&b.face));
        let place = (0..polygons.len()).min_by(|&i, &j| order(&polygons[i], &polygons[j]))?;
        Some(polygons.remove(place))
    }

    /// Cuts a list along a polygon: returns the remaining inside, with the polygon behind it, and the outside.
    fn cut(&self, by: FaceRegion, list: List, t: &mut impl Tracer<Step>) -> Result<[List; 2]> {
        let (mut inside, mut outside) = (Vec::new(), Vec::new());
        for polygon in list.polygons {
            let face = polygon.face;
            let within = self.overlay(&polygon.shapes, &by.shapes, BooleanOp::Intersection)?;
            let beyond = self.overlay(&polygon.shapes, &by.shapes, BooleanOp::Difference)?;
            t.step(|| Step::Cut { face, inside: within.clone(), outside: beyond.clone() });
            outside
                .extend(beyond.ring_count().gt(&0).then_some(FaceRegion { face, shapes: beyond }));
            if within.ring_count() == 0 {
                continue;
            }
            let before = self.in_front(by.face, face, within)?;
            if before.ring_count() == 0 {
                t.step(|| Step::Hidden { face });
            } else {
                t.step(|| Step::InFront { face });
                inside.push(FaceRegion { face, shapes: before });
            }
        }
        // The list's base is behind the polygon, too, so it continues only outside.
        let base = match list.base {
            Some(base) => {
                let shapes = self.overlay(&base.shapes, &by.shapes, BooleanOp::Difference)?;
                (shapes.ring_count() > 0).then_some(FaceRegion { shapes, ..base })
            }
            None => None,
        };
        let inside = List { polygons: inside, base: Some(by) };
        Ok([inside, List { polygons: outside, base }])
    }

    /// Returns the part of a polygon, within another's outline, that is in front of that one.
    fn in_front(&self, by: u32, face: u32, shapes: Shapes) -> Result<Shapes> {
        let [behind, own] = [by, face].map(|face| &self.faces[face as usize]);
        let ahead = |p: DVec2| behind.depth(p) - own.depth(p);
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for distance in shapes.points().iter().map(|&p| ahead(p)) {
            (least, most) = (least.min(distance), most.max(distance));
        }
        if most <= self.equal && (least < -self.equal || face > by) {
            return Ok(Shapes::new());
        }
        if least >= -self.equal {
            return Ok(shapes);
        }
        // They pierce each other: along a line of the picture, beyond which this one is in front.
        let at = ahead(DVec2::ZERO);
        let normal = DVec2::new(ahead(DVec2::X) - at, ahead(DVec2::Y) - at);
        let point = normal * (-at / normal.length_squared());
        let (low, high) = (self.around.min(), self.around.max());
        let all = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
        let half = by_borders::clip(&[HalfPlane { normal, point }], &all, &mut NoTrace)?;
        self.overlay(&shapes, &Shapes::from_rings([half]), BooleanOp::Intersection)
    }

    /// Returns the overlay on the common grid, without slivers from rounding.
    fn overlay(&self, subject: &Shapes, clip: &Shapes, op: BooleanOp) -> Result<Shapes> {
        let options = overlay::Options { grid: Some(self.grid), ..Default::default() };
        let shapes = overlay(subject, clip, op, &options, &mut NoTrace)?.shapes;
        let reach = self.around.size().max_element();
        let least = reach * self.grid * 64.0;
        Ok(if shapes.area() > least { shapes } else { Shapes::new() })
    }
}
