//! Pictures in which vertical lines are upright, so that visibility is decided column by column.
//!
//! Visibility depends only on the position of the eye, not on its direction. So a perspective view is decided on
//! upright pictures around the eye: one if the whole surface is in front of it, else four quarters. A parallel view
//! needs one.

use crate::math::{DVec2, DVec3};
use crate::scene::{Camera, HeightField, Projection};

/// Abscissas are multiples of this part of the picture's width, rounded to a power of two: columns that
/// are one in exact arithmetic, such as a diagonal's ends seen along it, are one in the picture.
const SNAP: f64 = 1.0 / (1u64 << 34) as f64;
/// A single picture is wide enough where no point is farther aside than this many times ahead.
const WIDEST: f64 = 2.0;
/// Nearer to the eye's own plumb line than this part of the surface's extent nothing is projected.
const FOOT: f64 = 1e-4;

/// Place or direction from which the surface is seen; coordinates are relative to the middle of the surface.
#[derive(Debug, Clone, Copy)]
pub enum Sight {
    /// A direction, of unit length.
    Along(DVec3),
    /// A point.
    From(DVec3),
}

/// A point in the frame of an upright picture: aside, up and ahead of the eye.
#[derive(Debug, Clone, Copy, Default)]
struct Place {
    aside: f64,
    up: f64,
    ahead: f64,
}

/// An upright picture of the surface, or of a quarter around the eye.
#[derive(Debug)]
pub struct Picture {
    sight: Sight,
    /// Aside and ahead as directions (x, z), of unit length.
    aside: DVec2,
    forward: DVec2,
    /// Only the quarter ahead belongs to it, and only what is farther ahead than this.
    quarter: Option<f64>,
    quantum: f64,
    /// Projection of each point of the field; only if `whole` says so.
    points: Vec<DVec2>,
    /// True for each point that exists, between the levels, and lies in the quarter.
    whole: Vec<bool>,
    /// Opposite corners around all points.
    min: DVec2,
    max: DVec2,
}

/// A part of a segment inside a picture.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    /// Start and end, 0 … 1 along the segment.
    pub range: [f64; 2],
    /// Its ends in the picture.
    pub ends: [DVec2; 2],
    /// Distance ahead of the eye at both; 1 in a parallel view.
    depths: [f64; 2],
}

impl Part {
    /// Returns the parameter on the segment of the point that is seen at `s`, 0 … 1 between the
    /// ends.
    pub fn along(&self, s: f64) -> f64 {
        let [near, far] = self.depths;
        let t = s * near / (far + s * (near - far));
        self.range[0] + (self.range[1] - self.range[0]) * t.clamp(0.0, 1.0)
    }
}

impl Sight {
    /// Creates the view of a camera onto a surface whose middle is `middle`.
    pub fn new(camera: &Camera, middle: DVec3) -> Self {
        match camera.projection {
            Projection::Orthographic { .. } => {
                Self::Along((camera.target - camera.eye).normalize_or(DVec3::NEG_Z))
            }
            Projection::Perspective { .. } => Self::From(camera.eye - middle),
        }
    }

    /// Returns the upright pictures that hold all of the surface; none if it is seen straight along
    /// the plumb line, and nothing hides anything.
    pub fn pictures(self, field: &HeightField, middle: DVec3) -> Vec<Picture> {
        let points = Points { field, middle };
        let pictures = match self {
            Self::Along(direction) => {
                let level = DVec2::new(direction.x, direction.z);
                // Closer to the plumb line than rounding, its direction on the ground is noise.
                let ahead = (level.length() > 1e-12).then(|| level.normalize());
                ahead.map(|a| vec![Picture::new(self, a, None, &points)]).unwrap_or_default()
            }
            Self::From(eye) => {
                let foot = DVec2::new(eye.x, eye.z);
                let half = points.half_extent();
                let ahead = (-foot).try_normalize().unwrap_or(DVec2::NEG_Y);
                let closest = FOOT * half.length().max(f64::MIN_POSITIVE);
                let all_ahead =
                    [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)].iter().all(|&(x, z)| {
                        let q = half * DVec2::new(x, z) - foot;
                        let depth = q.dot(ahead);
                        depth > closest && q.dot(ahead.perp()).abs() <= WIDEST * depth
                    });
                if all_ahead {
                    vec![Picture::new(self, ahead, None, &points)]
                } else {
                    let quarters = [ahead, ahead.perp(), -ahead, -ahead.perp()];
                    quarters.map(|f| Picture::new(self, f, Some(closest), &points)).into()
                }
            }
        };
        pictures.into_iter().filter(|p| p.min.x <= p.max.x).collect()
    }

    /// Returns the order of columns (`axis` 0) or rows (`axis` 2) of cells, the nearest first.
    pub fn order(self, field: &HeightField, axis: usize, middle: f64) -> Vec<usize> {
        let (points, [first, last]) = match axis {
            0 => (field.columns(), field.x_range()),
            _ => (field.rows(), field.z_range()),
        };
        let cells = points.saturating_sub(1);
        match self {
            Self::Along(direction) if direction[axis] < 0.0 => (0..cells).rev().collect(),
            Self::Along(_) => (0..cells).collect(),
            Self::From(eye) => {
                let (first, last) = (first - middle, last - middle);
                let place = (eye[axis] - first) / (last - first) * cells as f64;
                // The cast maps positions before the field to 0.
                let own = (place as usize).min(cells);
                (own..cells).chain((0..own).rev()).collect()
            }
        }
    }
}

/// The points of a field relative to its middle.
struct Points<'a> {
    field: &'a HeightField,
    middle: DVec3,
}

impl Points<'_> {
    fn half_extent(&self) -> DVec2 {
        let half = |[first, last]: [f64; 2]| (last - first) * 0.5;
        DVec2::new(half(self.field.x_range()), half(self.field.z_range()))
    }

    fn iter(&self) -> impl Iterator<Item = Option<DVec3>> + '_ {
        let field = self.field;
        (0..field.rows()).flat_map(move |row| {
            (0..field.columns())
                .map(move |column| field.point(column, row).map(|p| p - self.middle))
        })
    }
}

impl Picture {
    fn new(sight: Sight, forward: DVec2, quarter: Option<f64>, points: &Points) -> Self {
        // With y up and z towards the viewer, looking along −z aside is +x.
        let aside = DVec2::new(-forward.y, forward.x);
        let (min, max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut picture = Self {
            sight,
            aside,
            forward,
            quarter,
            quantum: 0.0,
            points: Vec::with_capacity(points.field.columns() * points.field.rows()),
            whole: Vec::with_capacity(points.field.columns() * points.field.rows()),
            min,
            max,
        };
        let levels = points.field.levels().map(|l| l.map(|y| y - points.middle.y));
        for point in points.iter() {
            // Parts beyond a level are cut there.
            let kept = point.map(|p| levels.map_or(p, |[l, h]| DVec3 { y: p.y.clamp(l, h), ..p }));
            let place = kept.map(|p| picture.place(p));
            let inside = place.filter(|p| picture.is_inside(p));
            let at = inside.map_or(DVec2::ZERO, |p| picture.project(&p));
            picture.whole.push(inside.is_some() && kept == point);
            picture.points.push(at);
            if inside.is_some() {
                (picture.min, picture.max) = (picture.min.min(at), picture.max.max(at));
            }
        }
        picture.grow_to_quarter(points);
        picture.snap();
        picture
    }

    /// Grows the extent to a quarter: points cut at the borders of a quarter lie within the
    /// borders, and between the extremes of the visible part at the closest distance.
    fn grow_to_quarter(&mut self, points: &Points) {
        let (Some(closest), Sight::From(eye)) = (self.quarter, self.sight) else { return };
        let Some([low, high]) = points.field.range() else { return };
        let levels = [low, high].map(|y| (y - points.middle.y - eye.y) / closest);
        (self.min.x, self.max.x) = (-1.0, 1.0);
        self.min.y = self.min.y.min(levels[0].min(0.0));
        self.max.y = self.max.y.max(levels[1].max(0.0));
    }

    fn snap(&mut self) {
        let width = self.max.x - self.min.x;
        if !(width > 0.0 && width.is_finite()) {
            return;
        }
        // The power of two at or below: clearing the mantissa.
        let power = f64::from_bits(width.to_bits() & 0x7ff0_0000_0000_0000);
        self.quantum = power * SNAP;
        let quantum = self.quantum;
        for point in &mut self.points {
            point.x = (point.x / quantum).round() * quantum;
        }
        self.min.x = (self.min.x / quantum).floor() * quantum;
        self.max.x = (self.max.x / quantum).ceil() * quantum;
    }

    fn place(&self, p: DVec3) -> Place {
        match self.sight {
            Sight::Along(direction) => {
                // Up in the picture: at right angles to the sight, in its own upright plane.
                let level = DVec2::new(direction.x, direction.z).length();
                let ground = DVec2::new(p.x, p.z);
                let up = p.y * level - ground.dot(self.forward) * direction.y;
                Place { aside: ground.dot(self.aside), up, ahead: 1.0 }
            }
            Sight::From(eye) => {
                let q = p - eye;
                let ground = DVec2::new(q.x, q.z);
                Place { aside: ground.dot(self.aside), up: q.y, ahead: ground.dot(self.forward) }
            }
        }
    }

    /// Returns the distance of a place inside each border of the quarter.
    fn insides(&self, p: &Place) -> [f64; 3] {
        match self.quarter {
            Some(closest) => [p.ahead - closest, p.ahead - p.aside, p.ahead + p.aside],
            None => [f64::INFINITY; 3],
        }
    }

    fn is_inside(&self, p: &Place) -> bool {
        self.insides(p).into_iter().all(|d| d >= 0.0)
    }

    fn project(&self, p: &Place) -> DVec2 {
        let x = p.aside / p.ahead;
        let x = if self.quantum > 0.0 { (x / self.quantum).round() * self.quantum } else { x };
        DVec2::new(x, p.up / p.ahead)
    }

    /// Returns opposite corners around everything in the picture.
    pub fn corners(&self) -> [DVec2; 2] {
        [self.min, self.max]
    }

    /// Returns the part of the segment between two points of the field (by number and place
    /// relative to the middle) that lies in the picture, of that which lies between the levels.
    pub fn part(&self, numbers: [usize; 2], ends: [DVec3; 2], between: [f64; 2]) -> Option<Part> {
        let places = ends.map(|p| self.place(p));
        if let [true, true] = numbers.map(|n| self.whole[n]) {
            let depths = places.map(|p| p.ahead);
            return Some(Part { range: [0.0, 1.0], ends: numbers.map(|n| self.points[n]), depths });
        }
        let [mut from, mut to] = between;
        for (a, b) in self.insides(&places[0]).into_iter().zip(self.insides(&places[1])) {
            match (a >= 0.0, b >= 0.0) {
                (false, false) => return None,
                (false, true) => from = from.max(a / (a - b)),
                (true, false) => to = to.min(a / (a - b)),
                (true, true) => {}
            }
        }
        if from >= to {
            return None;
        }
        let cut = [mix(&places[0], &places[1], from), mix(&places[0], &places[1], to)];
        let depths = cut.map(|p| p.ahead);
        Some(Part { range: [from, to], ends: cut.map(|p| self.project(&p)), depths })
    }

    /// Sets `out` to the corners of a triangle of the field if all of it is in the picture, and returns whether it is.
    pub fn triangle(&self, numbers: [usize; 3], out: &mut Vec<DVec2>) -> bool {
        out.clear();
        let whole = numbers.map(|n| self.whole[n]) == [true; 3];
        if whole {
            out.extend(numbers.map(|n| self.points[n]));
        }
        whole
    }

    /// Sets `out` to the corners, in order, of the part of a convex polygon that is in the picture; at most three
    /// more.
    pub fn polygon(&self, corners: &[DVec3], out: &mut Vec<DVec2>) {
        out.clear();
        let mut ring: Vec<Place> = corners.iter().map(|p| self.place(*p)).collect();
        let borders = if self.quarter.is_some() { 3 } else { 0 };
        for border in 0..borders {
            let mut cut = Vec::with_capacity(6);
            for (i, p) in ring.iter().enumerate() {
                let q = &ring[(i + 1) % ring.len()];
                let (a, b) = (self.insides(p)[border], self.insides(q)[border]);
                if a >= 0.0 {
                    cut.push(*p);
                }
                if (a >= 0.0) != (b >= 0.0) {
                    // Always from the inside, so that neighbours find the same point.
                    let (p, q, a, b) = if a >= 0.0 { (p, q, a, b) } else { (q, p, b, a) };
                    cut.push(mix(p, q, a / (a - b)));
                }
            }
            ring = cut;
        }
        out.extend(ring.iter().map(|p| self.project(p)));
    }
}

fn mix(p: &Place, q: &Place, t: f64) -> Place {
    let mix = |a: f64, b: f64| {
        if t == 0.0 {
            a
        } else if t == 1.0 {
            b
        } else {
            a + (b - a) * t
        }
    };
    Place { aside: mix(p.aside, q.aside), up: mix(p.up, q.up), ahead: mix(p.ahead, q.ahead) }
}

/// Returns the side of a line through two points on the ground on which the eye is: positive or negative as the cross
/// product of the line's direction with that to the eye.
pub fn side_of_eye(sight: Sight, from: DVec3, to: DVec3) -> f64 {
    let line = DVec2::new(to.x - from.x, to.z - from.z);
    let to_eye = match sight {
        Sight::Along(direction) => -DVec2::new(direction.x, direction.z),
        Sight::From(eye) => DVec2::new(eye.x - from.x, eye.z - from.z),
    };
    line.perp_dot(to_eye)
}
