//! Shadow volumes: pixels in shadow, found by counting the sides of volumes in front of the visible point.
//!
//! F. C. Crow, *Shadow algorithms for computer graphics*, Computer Graphics 11(2), SIGGRAPH 1977. Behind each face that
//! the light hits there is a volume without light; its sides extend from the face's outline away from the light. Along
//! the ray of a pixel the number of volumes grows by one at a side that turns its front to the eye, and shrinks by one
//! at a back; a point is in shadow if more fronts than backs were passed before it. Faces that share an edge have a
//! common volume without a side there. Class: image space. Cost: O(pixels that sides cover) time; memory O(pixels +
//! edges).
//!
//! If the eye itself may be in a volume, for example with a light behind the faces, the count begins with the number of
//! volumes there; or it begins at the far end ([`Count::ZFail`]; W. Bilodeau, M. Songy, 1999, and J. Carmack, 2000),
//! with sides beyond the visible point, and with the casting faces as the near ends of the volumes. The eye's rays are
//! parallel here, so all of them have the same far end.
//!
//! Deviations: Crow's sides are polygons among the others of a scan-line method; here each is drawn separately against
//! known depths. Faces need not bound bodies: each is turned to the light, and an edge that two faces run through in
//! the same direction counts twice (P. Bergeron, *A general version of Crow's shadow volumes*, IEEE Computer Graphics
//! and Applications 6(9), 1986).

use super::{Face, Screen, z_buffer};
use crate::Result;
use crate::clip::polygon::point::winding_number;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::{DVec2, DVec3, orient2d_value};
use crate::target::{NO_ITEM, Pixels};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};
use crate::visibility::back_face::Eye;
use std::collections::BTreeMap;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "shadow-volumes",
    title: "Shadow volumes",
    authors: "F. C. Crow",
    year: 1977,
    source: "Shadow algorithms for computer graphics, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::Object, Coherence::Edge],
    cost: "O(pixels that the sides of volumes cover) time; O(pixels and edges) memory",
    limits: "hard shadows of one light; plane polygons; a side is compared with one depth per pixel",
    pseudocode: &[
        "depth[x, y] ← depth of the nearest face at each pixel",
        "for each face that casts a shadow: turn it to the light, add its edges to the outline",
        "    edges that two of them run through in opposite directions cancel each other",
        "count[x, y] ← number of volumes at the end of the pixel's ray where counting begins",
        "for each edge AB of the outline:",
        "    the side ← all points of AB, and those behind them as the light L sees it",
        "    for each pixel that the side covers, with its depth z there:",
        "        z-pass: only if z < depth[x, y]; z-fail: only if not",
        "            z-pass: + 1 for a side that turns its front to the eye, − 1 for a back",
        "            z-fail: − 1 for a front, + 1 for a back",
        "z-fail: the faces that cast shadows likewise, − 1 if the eye sees the lit side",
        "a pixel with count[x, y] > 0 is in shadow",
    ],
};

/// End of a ray at which counting begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Count {
    /// From the eye: sides before the visible point.
    #[default]
    ZPass,
    /// From the far end: sides and casters not before the visible point.
    ZFail,
}

/// Options for the volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// End at which counting begins.
    pub count: Count,
    /// True if all faces bound closed bodies and run counter-clockwise seen from outside: only those that the light
    /// sees cast shadows then, which halves the counts.
    pub closed: bool,
}

/// A side of a volume: an edge of an outline, and all points behind it as the light sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeSide {
    /// Ends of the edge, counter-clockwise around the lit area as the light sees it.
    pub ends: [DVec3; 2],
    /// Directions away from the light at the ends.
    pub away: [DVec3; 2],
    /// Number of volumes that end here.
    pub weight: i32,
}

impl VolumeSide {
    /// Returns a normal that points out of the volume.
    fn normal(&self) -> DVec3 {
        self.away[0].cross(self.ends[1] - self.ends[0])
    }

    /// Returns whether the side turns its front to the eye, so that a ray from there enters the volume; `None` if it is
    /// seen edge-on.
    pub(crate) fn front(&self) -> Option<bool> {
        let z = self.normal().z;
        (z != 0.0 && z.is_finite()).then_some(z < 0.0)
    }

    /// Returns the depth of the side at a point of the screen; `None` if it does not cover that. Of two sides with a
    /// common border one covers it.
    pub fn depth(&self, p: DVec2) -> Option<f64> {
        let front = self.front()?;
        let ([a, b], normal) = (self.ends, self.normal());
        let flat = |p: DVec3| p.truncate();
        let is_left = |k: usize| {
            let (end, beyond) = (self.ends[k], self.ends[k] + self.away[k]);
            orient2d_value(flat(end), flat(beyond), p) > 0.0
        };
        let is_beyond = orient2d_value(flat(a), flat(b), p) * if front { 1.0 } else { -1.0 } > 0.0;
        let covers = is_beyond && is_left(0) != is_left(1);
        covers.then(|| a.z - normal.truncate().dot(p - flat(a)) / normal.z)
    }

    /// Returns the smallest rectangle of pixels around all that the side covers on a screen: columns and rows, ends
    /// excluded.
    fn bounds(&self, screen: &Screen) -> [std::ops::Range<u32>; 2] {
        let along = |axis: usize, size: u32| {
            let at = self.ends.map(|end| end[axis]);
            let grows = |sign: f64| self.away.iter().any(|away| away[axis] * sign > 0.0);
            let low = if grows(-1.0) { 0.0 } else { at[0].min(at[1]).floor() };
            let high = if grows(1.0) { f64::from(size) } else { at[0].max(at[1]).ceil() };
            // Out of range is cut off by the conversion.
            (low as u32).min(size)..(high as u32).min(size)
        };
        [along(0, screen.width), along(1, screen.height)]
    }
}

/// Step of the algorithm. Faces and sides have the numbers of their order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A pixel with the nearest face, and the count with which it begins.
    Pixel {
        /// Column and row.
        pixel: [u32; 2],
        /// The nearest face.
        face: u32,
        /// Its depth.
        depth: f64,
        /// Number of volumes at the end where counting begins.
        count: i32,
    },
    /// A face casts a shadow.
    Caster {
        /// The face.
        face: u32,
        /// True if it is turned to face the light.
        turned: bool,
    },
    /// A side of the volumes is drawn.
    Side {
        /// Its number.
        number: usize,
        /// The side.
        side: VolumeSide,
        /// True if it turns its front to the eye; none if it is seen edge-on and covers nothing.
        front: Option<bool>,
    },
    /// A caster is drawn as the near end of its volume.
    Cap {
        /// The face.
        face: u32,
        /// True if the eye sees its lit side.
        lit: bool,
    },
    /// A pixel that a side or a caster covers.
    Count {
        /// Column and row.
        pixel: [u32; 2],
        /// Depth of the side or the caster.
        depth: f64,
        /// Depth of the visible point.
        stored: f64,
        /// Number that is added; 0 if the depths say that it does not count.
        change: i32,
        /// The pixel's count from here on.
        count: i32,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Caster { .. } => 2,
            Self::Pixel { .. } => 4,
            Self::Side { .. } => 6,
            Self::Count { change: 0, .. } => 8,
            Self::Count { .. } => 9,
            Self::Cap { .. } => 11,
        }
    }
}

/// The nearest faces, and in how many shadows they are.
#[derive(Debug, Clone, PartialEq)]
pub struct ShadowPicture {
    /// Index of the nearest face at each pixel's centre.
    pub items: Pixels<u32>,
    /// Number of volumes that contain the visible point; 0 where nothing is seen.
    pub counts: Pixels<i32>,
}

impl ShadowPicture {
    /// Returns whether a face is seen at a pixel, and is in shadow there.
    pub fn is_dark(&self, x: u32, y: u32) -> bool {
        self.counts.get(x, y).is_some_and(|count| count > 0)
    }
}

/// Returns the picture that a list of steps leads to.
///
/// # Errors
/// [`Memory`](crate::Error::Memory) where the screen's budget does not suffice.
pub fn replay(screen: &Screen, steps: &[Step]) -> Result<ShadowPicture> {
    let mut picture = ShadowPicture { items: screen.plane(NO_ITEM)?, counts: screen.plane(0)? };
    for step in steps {
        match *step {
            Step::Pixel { pixel: [x, y], face, count, .. } => {
                picture.items.set(x, y, face);
                picture.counts.set(x, y, count);
            }
            Step::Count { pixel: [x, y], count, .. } => picture.counts.set(x, y, count),
            _ => {}
        }
    }
    Ok(picture)
}

/// Returns the nearest face at each pixel's centre, and the number of shadow volumes that contain it. The light has a
/// place, or its rays have a direction.
///
/// ```
/// use durer::math::DVec3;
/// use durer::trace::NoTrace;
/// use durer::visibility::back_face::Eye;
/// use durer::visibility::polygons::shadow_volumes::{Options, render};
/// use durer::visibility::polygons::{Face, Screen};
///
/// let slab = |x0: f64, x1: f64, z: f64| {
///     let corners = [(x0, 0.0), (x1, 0.0), (x1, 4.0), (x0, 4.0)];
///     Face::new(&corners.map(|(x, y)| DVec3::new(x, y, z)))
/// };
/// // A floor, and a strip above it; light comes from the upper left.
/// let faces = [slab(0.0, 8.0, 5.0)?, slab(1.0, 3.0, 2.0)?];
/// let screen = Screen { width: 8, height: 1, ..Screen::default() };
/// let light = Eye::Along(DVec3::new(1.0, 0.0, 1.0));
/// let found = render(&faces, &screen, light, &Options::default(), &mut NoTrace)?;
/// assert_eq!(found.items.data(), [0, 1, 1, 0, 0, 0, 0, 0]);
/// assert_eq!(found.counts.data(), [0, 0, 0, 0, 1, 1, 0, 0]);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Memory`](crate::Error::Memory) where the screen's budget does not suffice.
pub fn render(
    faces: &[Face],
    screen: &Screen,
    light: Eye,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<ShadowPicture> {
    let corners = faces.iter().map(|face| face.corners().len() as u64).sum();
    let _charge = screen.work.charge_for::<(VolumeSide, [u64; 8])>("shadow volumes", corners)?;
    let items = z_buffer::items(faces, screen, &mut NoTrace)?;
    let casters = casters(faces, light, options, t);
    let sides = sides(faces, &casters, light);
    let mut counting = Counting { faces, counts: screen.plane(0)?, items, count: options.count };
    counting.begin(&casters, light, t);
    for (number, side) in sides.iter().enumerate() {
        let front = side.front();
        t.step(|| Step::Side { number, side: *side, front });
        let Some(front) = front else { continue };
        screen.work.check()?;
        let [columns, rows] = side.bounds(screen);
        for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
            if let Some(depth) = side.depth(middle(x, y)) {
                counting.pass([x, y], depth, if front { side.weight } else { -side.weight }, t);
            }
        }
    }
    let _table = screen.edge_table(faces)?;
    for caster in casters.iter().filter(|_| options.count == Count::ZFail) {
        let (face, lit) = (caster.face, caster.lit_side_is_seen());
        t.step(|| Step::Cap { face, lit });
        let change = if lit { 1 } else { -1 };
        faces[face as usize].pixels(screen, |pixel, point| {
            counting.pass(pixel, point.z, change, t);
        });
    }
    Ok(ShadowPicture { items: counting.items, counts: counting.counts })
}

/// A face that casts a shadow.
struct Caster {
    face: u32,
    /// True if its corners run clockwise as the light sees it.
    turned: bool,
    normal: DVec3,
}

impl Caster {
    /// Returns whether the eye sees the side that the light sees.
    fn lit_side_is_seen(&self) -> bool {
        (self.normal.z < 0.0) != self.turned
    }
}

/// Returns the faces that cast shadows: those seen edge-on from the light cast none.
fn casters(
    faces: &[Face],
    light: Eye,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Vec<Caster> {
    use crate::view::cull::FaceSide::{Back, Edge, Front};
    let mut found = Vec::new();
    for (face, own) in (0..).zip(faces) {
        let normal = own.plane().normal;
        let turned = match light.side(normal, own.corners()[0]) {
            Front => false,
            Back if !options.closed => true,
            Back | Edge => continue,
        };
        t.step(|| Step::Caster { face, turned });
        found.push(Caster { face, turned, normal });
    }
    found
}

/// Returns the sides of the volumes of all casters, in the order of the casters' edges.
fn sides(faces: &[Face], casters: &[Caster], light: Eye) -> Vec<VolumeSide> {
    let away = |p: DVec3| match light {
        Eye::At(light) => p - light,
        Eye::Along(direction) => direction,
    };
    let mut edges: Vec<([DVec3; 2], i32)> = Vec::new();
    let mut known = BTreeMap::new();
    for caster in casters {
        let corners = faces[caster.face as usize].corners();
        for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let ends = if caster.turned { [*b, *a] } else { [*a, *b] };
            // Adding zero makes −0 and 0 one number.
            let key = ends.map(|end| (end + DVec3::ZERO).to_array().map(f64::to_bits));
            let is_forward = key[0] < key[1];
            let key = if is_forward { key } else { [key[1], key[0]] };
            let number = *known.entry(key).or_insert_with(|| {
                edges.push((if is_forward { ends } else { [ends[1], ends[0]] }, 0));
                edges.len() - 1
            });
            edges[number].1 += if is_forward { 1 } else { -1 };
        }
    }
    let side = |([a, b], count): ([DVec3; 2], i32)| {
        let ends = if count > 0 { [a, b] } else { [b, a] };
        VolumeSide { ends, away: ends.map(away), weight: count.abs() }
    };
    edges.into_iter().filter(|(_, count)| *count != 0).map(side).collect()
}

/// The counts as they become.
struct Counting<'a> {
    faces: &'a [Face],
    items: Pixels<u32>,
    counts: Pixels<i32>,
    count: Count,
}

impl Counting<'_> {
    /// Sets the counts to the number of volumes that contain the end of each ray at which counting begins.
    fn begin(&mut self, casters: &[Caster], light: Eye, t: &mut impl Tracer<Step>) {
        let (width, height) = (self.items.width(), self.items.height());
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        for pixel @ [x, y] in pixels {
            let Some((face, depth)) = self.seen(pixel) else { continue };
            let count = casters.iter().filter(|c| self.is_at_end(c, light, middle(x, y)));
            let count = count.count() as i32;
            self.counts.set(x, y, count);
            t.step(|| Step::Pixel { pixel, face, depth, count });
        }
    }

    /// Returns whether the volume of a caster contains the end of a ray through a pixel's centre: whether the light,
    /// seen from there, is behind the caster.
    fn is_at_end(&self, caster: &Caster, light: Eye, center: DVec2) -> bool {
        let is_near_end = self.count == Count::ZPass;
        let face = &self.faces[caster.face as usize];
        let (at, is_before) = match light {
            // All rays meet there, so that one point represents all.
            Eye::At(light) => (light.truncate(), face.depth(light.truncate()) < light.z),
            Eye::Along(direction) if direction.truncate() == DVec2::ZERO => {
                (center, direction.z < 0.0)
            }
            Eye::Along(_) => return false,
        };
        let is_inside = || winding_number([&face.outline()[..]], at, &mut NoTrace);
        is_before == is_near_end && is_inside().is_some_and(|number| number % 2 != 0)
    }

    /// Returns the visible face at a pixel, and its depth.
    fn seen(&self, [x, y]: [u32; 2]) -> Option<(u32, f64)> {
        let face = self.items.get(x, y).filter(|face| *face != NO_ITEM)?;
        Some((face, self.faces.get(face as usize)?.at(x as i32, y as i32).z))
    }

    /// Counts a surface that a ray passes: `change` more volumes beyond it.
    fn pass(&mut self, pixel: [u32; 2], depth: f64, change: i32, t: &mut impl Tracer<Step>) {
        let Some((_, stored)) = self.seen(pixel) else { return };
        let change = match (self.count, depth < stored) {
            (Count::ZPass, true) => change,
            (Count::ZFail, false) => -change,
            _ => 0,
        };
        let [x, y] = pixel;
        let count = self.counts.get(x, y).unwrap_or_default() + change;
        self.counts.set(x, y, count);
        t.step(|| Step::Count { pixel, depth, stored, change, count });
    }
}

fn middle(x: u32, y: u32) -> DVec2 {
    DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
}
