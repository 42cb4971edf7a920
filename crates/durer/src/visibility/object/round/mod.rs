//! Cylinders among the faces: holes, pins, rounded edges.
//!
//! Region growing, as in Paul J. Besl and Ramesh C. Jain, *Segmentation through variable-order surface fitting*, IEEE
//! PAMI, 1988, on triangles: two neighbours at a small angle give a first cylinder, which absorbs neighbours whose
//! corners lie on it, and is refitted whenever its size has doubled. The vertices of a mesh lie on the surface that it
//! approximates, so corners must be nearer to the cylinder than the middles of the mesh's own facets. Bands of spheres
//! and tori look like short cylinders; they are recognized because the surface continues smoothly beyond their rims.
//! O(n).

mod fit;

use super::{Bodies, Edges, Faces};
use crate::math::DVec3;
use crate::scene::Aabb;
use crate::sorting::CompactSort;
use fit::{Sums, Surface};
use std::f64::consts::TAU;

/// A round part of the surface of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    /// Start and end, points of its axis, world space.
    pub ends: [DVec3; 2],
    /// Radius in units of the world.
    pub radius: f64,
    /// Angle of the circle that it covers, in radians; [`TAU`] for all of it.
    pub angle: f64,
    /// Direction from the axis to the middle of the covered part, of unit length; any for a full circle.
    pub facing: DVec3,
    /// True if it is a hole: the surface looks towards the axis.
    pub hollow: bool,
    /// Index into [`crate::scene::Scene::instances`].
    pub instance: usize,
    /// Its first triangle.
    pub item: u32,
    /// The number of its triangles.
    pub triangles: u32,
}

impl Cylinder {
    /// Returns the direction of the axis, from its first end to the other, of unit length.
    pub(crate) fn axis(&self) -> DVec3 {
        (self.ends[1] - self.ends[0]).normalize_or_zero()
    }

    /// Returns whether nothing of the circle is missing.
    pub fn is_full(&self) -> bool {
        self.angle >= TAU
    }
}

/// Neighbours that turn by more than 31° are two faces: a round part has at least 12 of them.
const LARGEST_TURN: f64 = 31.0;
/// Neighbours that turn by less than 0.2° are one face.
const SMALLEST_TURN: f64 = 0.2;
/// The largest slope of a triangle against the axis: triangles between rims that are divided differently
/// are tilted a little.
const TILT: f64 = 0.25;
/// Largest distance of corners, as a part of the height of the arc over a facet.
const OF_SAGITTA: f64 = 0.25;
/// Distance of corners that is always allowed: as a part of the radius, and of the model's extent (single
/// precision).
const OF_RADIUS: f64 = 2e-4;
const OF_EXTENT: f64 = 1.0 / (1u64 << 21) as f64;
/// Largest distance in the end: for part cylinders as a part of the height of the arc, for full ones as a part of the
/// model's extent (five digits in a file).
const STRICT: f64 = 0.05;
const DIGITS: f64 = 1e-5;
/// Part cylinders cover at least this angle, and have this many facets.
const LEAST_ANGLE: f64 = 25.0 * std::f64::consts::PI / 180.0;
const LEAST_FACETS: usize = 4;
/// A part cylinder fills at least this part of the rectangle that it would be if it were unrolled.
const WHOLE: f64 = 0.8;
/// Number of failed regions after which a triangle is not tried again.
const TRIES: u8 = 8;
/// Number of triangles that give a first cylinder if two neighbours do not.
const PATCH: usize = 14;
/// Edges whose direction has at most this much of the axis run across; `LENGTHWISE` is the bound for edges along it.
const ACROSS: f64 = 0.25;
const LENGTHWISE: f64 = 0.98;
/// A cylinder is at least this many times as long as the facets that continue smoothly beyond its rim.
const LONGER: f64 = 2.5;

/// Finds the cylinders of a scene's faces, in the order of their first triangles.
///
/// Cylinders that gaps divide lengthwise are one; those with gaps across are several.
pub fn cylinders(faces: &Faces) -> Vec<Cylinder> {
    let (bodies, edges) = Bodies::find(faces);
    let extent = Aabb::around(faces.points().iter().copied()).map_or(0.0, |b| b.size().length());
    let (tries, region_of) = (vec![0; faces.len()], vec![0; faces.len()]);
    let normals = normals(faces, &bodies, extent);
    let mut finder = Finder { faces, normals, extent, tries, region_of, regions: 0 };
    let mut found = finder.find(&edges);
    found.sort_unstable_by_key(|c| c.item);
    joined(found, extent)
}

/// Returns the unit normals of all triangles, out of their bodies.
fn normals(faces: &Faces, bodies: &Bodies, extent: f64) -> Vec<DVec3> {
    let of = |item: u32| {
        let [a, b, c] = faces.corners(item)?;
        let normal = (b - a).cross(c - a);
        let sides = [b - a, c - a, c - b].map(DVec3::length_squared);
        let longest = sides.into_iter().fold(0.0, f64::max).sqrt();
        let thin = normal.length() < longest * extent * OF_EXTENT;
        let sign = if bodies.turned(item) { -1.0 } else { 1.0 };
        normal.try_normalize().filter(|_| !thin).map(|n| n * sign)
    };
    (0..faces.len() as u32).map(|item| of(item).unwrap_or(DVec3::ZERO)).collect()
}

/// The search and its findings.
struct Finder<'a> {
    faces: &'a Faces,
    /// Unit normals; 0 for triangles that are too thin to have one.
    normals: Vec<DVec3>,
    /// Extent of all faces.
    extent: f64,
    /// Number of vain tries of each triangle in a region; [`TAKEN`] if it belongs to one.
    tries: Vec<u8>,
    /// The number of the last region that a triangle was in.
    region_of: Vec<u32>,
    /// Number of regions.
    regions: u32,
}

const TAKEN: u8 = u8::MAX;

/// A region that grows.
struct Region {
    items: Vec<u32>,
    sums: Sums,
    surface: Surface,
    /// Largest distance of corners.
    tolerance: f64,
    hollow: bool,
    /// The turn between its first two facets, as the sine.
    turn: f64,
}

impl Finder<'_> {
    fn find(&mut self, edges: &Edges) -> Vec<Cylinder> {
        let mut found = Vec::new();
        for (_, sides) in edges.iter() {
            let [a, b] = sides else { continue };
            let Some(turn) = self.turn(a.item(), b.item()) else { continue };
            let pair = vec![a.item(), b.item()];
            let cylinder = self.tried(edges, pair, turn);
            let cylinder = cylinder.or_else(|| {
                let patch = self.patch(edges, [a.item(), b.item()])?;
                self.tried(edges, patch, turn)
            });
            found.extend(cylinder);
        }
        found
    }

    /// Grows a region from some triangles and returns it, if it is a cylinder.
    fn tried(&mut self, edges: &Edges, items: Vec<u32>, turn: f64) -> Option<Cylinder> {
        let Some(region) = self.seed(&items, turn) else {
            // Two neighbours may fail by chance; a larger failed region marks all its triangles.
            if items.len() > 2 {
                self.mark(&items, false);
            }
            return None;
        };
        let region = self.grown(edges, region);
        let cylinder = self.cylinder(edges, &region);
        self.mark(&region.items, cylinder.is_some());
        cylinder
    }

    /// Records that triangles were taken into a region, or that their region failed.
    fn mark(&mut self, items: &[u32], taken: bool) {
        for item in items {
            let tries = &mut self.tries[*item as usize];
            *tries = if taken { TAKEN } else { tries.saturating_add(1).min(TAKEN - 1) };
        }
    }

    /// Returns the triangles around two whose normals differ little from theirs; `None` if there are no more than the
    /// two. Where triangles are tilted, two normals do not determine the axis.
    fn patch(&self, edges: &Edges, pair: [u32; 2]) -> Option<Vec<u32>> {
        let normal = self.normal(pair[0])?;
        let mut items = pair.to_vec();
        let mut at = 0;
        while let Some(&item) = items.get(at).filter(|_| items.len() < PATCH) {
            at += 1;
            for other in self.neighbours(edges, item) {
                let turned = |m: DVec3| normal.dot(m) < libm::cos(LARGEST_TURN.to_radians());
                let fits = self.is_free(other) && self.normal(other).is_some_and(|m| !turned(m));
                if fits && !items.contains(&other) {
                    items.push(other);
                }
            }
        }
        (items.len() > 3).then_some(items)
    }

    /// Returns the triangles that share an edge with a triangle, leaving out edges of more than two triangles.
    fn neighbours(&self, edges: &Edges, item: u32) -> Vec<u32> {
        let mut found = Vec::with_capacity(3);
        let Some(t) = self.faces.triangle(item) else { return found };
        self.faces.each_side(item, t, |a, b| {
            if let [s, o] = edges.at([a.min(b), a.max(b)]) {
                found.push(if s.item() == item { o.item() } else { s.item() });
            }
        });
        found
    }

    /// Returns the unit normal of a triangle, out of its body; `None` if it is too thin to have
    /// one.
    fn normal(&self, item: u32) -> Option<DVec3> {
        self.normals.get(item as usize).copied().filter(|n| *n != DVec3::ZERO)
    }

    fn is_free(&self, item: u32) -> bool {
        self.tries.get(item as usize).is_some_and(|t| *t < TRIES)
    }

    /// Returns the sine of the angle between two neighbours that may be facets of a cylinder.
    fn turn(&self, a: u32, b: u32) -> Option<f64> {
        if !self.is_free(a) || !self.is_free(b) {
            return None;
        }
        let (n, m) = (self.normal(a)?, self.normal(b)?);
        let turn = n.cross(m).length();
        let [least, most] = [SMALLEST_TURN, LARGEST_TURN].map(|d| libm::sin(d.to_radians()));
        (n.dot(m) > 0.0 && turn >= least && turn <= most).then_some(turn)
    }

    /// Returns a region to begin with.
    fn seed(&self, items: &[u32], turn: f64) -> Option<Region> {
        let mut sums = Sums::default();
        for item in items {
            sums.add(self.faces.corners(*item)?, self.normal(*item));
        }
        let surface = sums.fit().filter(|s| s.radius < self.extent)?;
        let first = *items.first()?;
        let [p, q, r] = self.faces.corners(first)?;
        let hollow = surface.spoke((p + q + r) / 3.0).dot(self.normal(first)?) < 0.0;
        let items = items.to_vec();
        let mut region = Region { items, sums, surface, tolerance: 0.0, hollow, turn };
        region.set_tolerance(self.extent);
        let all = region.sums.points().iter().all(|p| surface.error(*p) <= region.tolerance);
        all.then_some(region)
    }

    /// Grows a region by all triangles that belong to it.
    fn grown(&mut self, edges: &Edges, mut region: Region) -> Region {
        self.regions += 1;
        region.items.iter().for_each(|item| self.region_of[*item as usize] = self.regions);
        let (mut at, mut fitted) = (0, region.items.len());
        while let Some(&item) = region.items.get(at) {
            at += 1;
            for other in self.neighbours(edges, item) {
                let is_new = self.region_of[other as usize] != self.regions;
                if is_new && self.belongs(&region, item, other) {
                    self.region_of[other as usize] = self.regions;
                    region.items.push(other);
                    let corners = self.faces.corners(other).unwrap_or_default();
                    region.sums.add(corners, self.normal(other));
                }
            }
            if region.items.len() >= 2 * fitted {
                fitted = region.items.len();
                region.refit(self.extent);
            }
        }
        region.refit(self.extent);
        region
    }

    /// Returns whether a triangle continues the region that its neighbour belongs to.
    fn belongs(&self, region: &Region, neighbour: u32, item: u32) -> bool {
        let Some(corners) = self.faces.corners(item).filter(|_| self.is_free(item)) else {
            return false;
        };
        let surface = &region.surface;
        if corners.iter().any(|p| surface.error(*p) > region.tolerance) {
            return false;
        }
        let Some(normal) = self.normal(item) else { return true };
        let spoke = surface.spoke(corners.iter().sum::<DVec3>() / 3.0).normalize_or_zero();
        let outwards = if region.hollow { -spoke } else { spoke };
        let turn = libm::cos(LARGEST_TURN.to_radians());
        normal.dot(surface.axis).abs() <= TILT
            && normal.dot(outwards) > 0.9
            && self.normal(neighbour).is_none_or(|n| n.dot(normal) >= turn)
    }

    /// Returns the cylinder of a region, if it is one.
    fn cylinder(&self, edges: &Edges, region: &Region) -> Option<Cylinder> {
        let surface = &region.surface;
        let (low, high) = region.extent();
        let facets = region.directions();
        let (middle, angle) = covered(&facets);
        let most = region.strict(self.extent, angle >= TAU);
        let off = region.sums.points().iter().any(|p| surface.error(*p) > most);
        let bent = surface.radius * angle * (high - low);
        let torn = angle < TAU && region.sums.area() < WHOLE * bent;
        let few = facets.len() <= LEAST_FACETS || angle < LEAST_ANGLE || torn;
        if off || few || surface.radius >= self.extent || high <= low {
            return None;
        }
        if self.goes_on(edges, region, high - low) {
            return None;
        }
        let item = region.items.iter().copied().min()?;
        let ([u, v], (sin, cos)) = (surface.across(), libm::sincos(middle));
        Some(Cylinder {
            facing: u * cos + v * sin,
            ends: [low, high].map(|h| surface.point + surface.axis * h),
            radius: surface.radius,
            angle,
            hollow: region.hollow,
            instance: self.faces.instance_of(item)?,
            item,
            triangles: region.items.len() as u32,
        })
    }

    /// Returns whether the surface continues smoothly beyond most of the rims, in facets about as long as the region,
    /// or beyond a border that runs neither along nor across the axis: then the region is part of a surface curved in
    /// two directions.
    fn goes_on(&self, edges: &Edges, region: &Region, length: f64) -> bool {
        let (mut smooth, mut rims, mut ragged, mut all) = (0.0, 0.0, 0.0, 0.0);
        for &item in &region.items {
            let Some(t) = self.faces.triangle(item) else { continue };
            self.faces.each_side(item, t, |a, b| {
                let [s, o] = edges.at([a.min(b), a.max(b)]) else { return };
                let other = if s.item() == item { o.item() } else { s.item() };
                if self.region_of[other as usize] == self.regions {
                    return;
                }
                let [p, q] = [a, b].map(|v| self.faces.points()[v as usize]);
                let long = (q - p).length();
                let slope = (q - p).dot(region.surface.axis).abs() / long.max(f64::MIN_POSITIVE);
                let is_smooth = self.is_smooth(item, other);
                all += long;
                if slope <= ACROSS {
                    rims += long;
                    let short = length < LONGER * self.height(other, p, q);
                    smooth += if is_smooth && short { long } else { 0.0 };
                } else if slope < LENGTHWISE && is_smooth {
                    ragged += long;
                }
            });
        }
        smooth > 0.5 * rims || ragged > 0.15 * all
    }

    /// Returns whether the angle between two neighbours is at most that between facets of a round part.
    fn is_smooth(&self, a: u32, b: u32) -> bool {
        let both = self.normal(a).zip(self.normal(b));
        both.is_some_and(|(n, m)| n.dot(m) > libm::cos(LARGEST_TURN.to_radians()))
    }

    /// Returns the height of a triangle over the line through two points.
    fn height(&self, item: u32, p: DVec3, q: DVec3) -> f64 {
        let way = (q - p).normalize_or_zero();
        let corners = self.faces.corners(item).unwrap_or_default();
        corners.iter().map(|c| (*c - p).cross(way).length()).fold(0.0, f64::max)
    }
}

impl Region {
    fn set_tolerance(&mut self, extent: f64) {
        // sin² / 8 is 1 − cos of half the angle, for small ones.
        let sagitta = self.surface.radius * self.turn * self.turn / 8.0;
        let always = (self.surface.radius * OF_RADIUS).max(extent * OF_EXTENT);
        self.tolerance = (sagitta * OF_SAGITTA).max(always);
    }

    /// Returns the largest distance of corners in the end: patches of other surfaces are near a cylinder, too, the
    /// more so the less of a circle they are.
    fn strict(&self, extent: f64, full: bool) -> f64 {
        let sagitta = self.surface.radius * self.turn * self.turn / 8.0;
        let (part, digits) = if full { (OF_SAGITTA, DIGITS) } else { (STRICT, DIGITS * 0.2) };
        (sagitta * part).max(extent * digits)
    }

    fn refit(&mut self, extent: f64) {
        if let Some(surface) = self.sums.fit() {
            self.surface = surface;
            self.set_tolerance(extent);
        }
    }

    /// Returns the start and end along its axis.
    fn extent(&self) -> (f64, f64) {
        let along = |p: &DVec3| (*p - self.surface.point).dot(self.surface.axis);
        let both = |(low, high): (f64, f64), h: f64| (low.min(h), high.max(h));
        self.sums.points().iter().map(along).fold((f64::INFINITY, f64::NEG_INFINITY), both)
    }

    /// Returns the distinct directions of its corners as seen from the axis, radians, in order.
    fn directions(&self) -> Vec<f64> {
        let [u, v] = self.surface.across();
        let angle = |p: &DVec3| {
            let spoke = *p - self.surface.point;
            libm::atan2(spoke.dot(v), spoke.dot(u))
        };
        let mut all: Vec<f64> = self.sums.points().iter().map(angle).collect();
        all.sort_unstable_by(f64::total_cmp);
        all.dedup_by(|a, b| *a - *b < 1e-3);
        all
    }
}

/// Returns the middle and the angle of the part of a circle that sorted directions cover without large gaps.
fn covered(directions: &[f64]) -> (f64, f64) {
    let (Some(first), Some(last)) = (directions.first(), directions.last()) else {
        return (0.0, 0.0);
    };
    let across = (*last, first + TAU - last);
    let gaps = directions.windows(2).map(|w| (w[0], w[1] - w[0]));
    let (from, gap) = gaps.fold(across, |a, b| if b.1 > a.1 { b } else { a });
    let angle = if gap > 1.2 * LARGEST_TURN.to_radians() { TAU - gap } else { TAU };
    (from + gap + (TAU - gap) * 0.5, angle)
}

/// Joins the parts of cylinders that are divided lengthwise.
fn joined(found: Vec<Cylinder>, extent: f64) -> Vec<Cylinder> {
    let (mut whole, mut parts): (Vec<_>, Vec<_>) = found.into_iter().partition(Cylinder::is_full);
    parts.compact_sort_by(|a, b| a.radius.total_cmp(&b.radius).then(a.item.cmp(&b.item)));
    let mut gone = vec![false; parts.len()];
    for i in 0..parts.len() {
        if gone[i] {
            continue;
        }
        let mut sum = parts[i];
        let near = parts[i].radius * (1.0 + 1e-3);
        for (k, part) in parts.iter().enumerate().skip(i + 1).take_while(|p| p.1.radius <= near) {
            if !gone[k] && are_one(&sum, part, extent) {
                gone[k] = true;
                sum.angle = (sum.angle + part.angle).min(TAU);
                sum.item = sum.item.min(part.item);
                sum.triangles += part.triangles;
            }
        }
        whole.push(sum);
    }
    whole.compact_sort_by_key(|c| c.item);
    whole
}

/// Returns whether two cylinders have the same axis and side and are adjacent along the axis.
fn are_one(a: &Cylinder, b: &Cylinder, extent: f64) -> bool {
    let axis = a.axis();
    let surface = Surface { point: a.ends[0], axis, radius: a.radius };
    let tolerance = (a.radius * 1e-3).max(extent * OF_EXTENT);
    let along = |p: DVec3| (p - a.ends[0]).dot(axis);
    let (from, to) =
        (along(b.ends[0]).min(along(b.ends[1])), along(b.ends[0]).max(along(b.ends[1])));
    let overlap = to.min(along(a.ends[1])) - from.max(0.0);
    a.hollow == b.hollow
        && a.instance == b.instance
        && b.ends.iter().all(|p| surface.spoke(*p).length() <= tolerance)
        && overlap > 0.5 * (to - from)
}
