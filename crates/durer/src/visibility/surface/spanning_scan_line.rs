//! The spanning scan line: visibility is decided once per span, not once per pixel.
//!
//! W. J. Bouknight, *A Procedure for Generation of Three-dimensional Half-toned Computer Graphics
//! Presentations*, CACM 13(9), 1970; G. S. Watkins, *A Real Time Visible Surface Algorithm*,
//! dissertation, University of Utah, 1970. Image space. Triangles wait sorted by their first row;
//! the ends of the active ones on the row, sorted by x, are its edges. Passing an edge turns the
//! triangle's in/out flag over; between two edges the set of triangles that are in stays the same,
//! and the nearest of them is found from the planes at the span's two ends (span coherence).
//! Penetrating faces change places inside a span, which is split at the crossing.
//!
//! Deviations: the picture must be the z-buffer's bit for bit, whose depths are rounded to f32. So the comparison at a
//! span's end decides only if the difference is larger than rounding errors. Where planes are closer than that, around
//! crossings and on coplanar faces, the span's pixels are compared one by one, as in spans too short to gain anything
//! and under masked surfaces. Blended surfaces are kept in a list per pixel of the row and laid over by depth.
//!
//! Cost: O(n log n) for the order by first row, then per row O(e log e + spans · depth complexity + w)
//! for e edges and w pixels. Memory: the triangles, the active list and one row; nothing grows with
//! the picture's height but the framebuffer itself.

use crate::info::{Class, Coherence, Info, Occluder};
use crate::shade::{PreparedLights, PreparedMaterials};
use crate::target::Framebuffer;
use crate::trace::Tracer;
use crate::visibility::surface::input::{METHOD, SurfaceInput};
use crate::visibility::surface::layers::{Layers, write_row};
use crate::visibility::surface::lit::Lit;
pub use crate::visibility::surface::picture::Options;
use crate::visibility::surface::picture::Picture;
use crate::visibility::surface::rows::active::{Active, ActiveList};
use crate::visibility::surface::rows::nearest::{DepthRow, Masked, is_nearer};
use crate::visibility::surface::setup::ScreenTriangle;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "spanning-scan-line",
    title: "Spanning scan line",
    authors: "W. J. Bouknight; G. S. Watkins",
    year: 1970,
    source: "A Real Time Visible Surface Algorithm, University of Utah",
    class: Class::ImageSpace,
    occluder: Occluder::Line,
    coherence: &[Coherence::Edge, Coherence::ScanLine, Coherence::Span, Coherence::Depth],
    cost: "O(n log n + rows · (e log e + spans · d)) time for n triangles, e edges of a row, d deep; \
           O(n + width) memory",
    limits: "one sample per pixel",
    pseudocode: &[],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A row begins with all triangles out.
    Row {
        /// The row, from the top.
        y: i32,
    },
    /// An edge is passed: a triangle is in from here on.
    In {
        /// Its item.
        item: u32,
        /// The first column.
        x: i32,
    },
    /// An edge is passed: a triangle is out from here on.
    Out {
        /// Its item.
        item: u32,
        /// The column after its last.
        x: i32,
    },
    /// One triangle is nearest at both ends of a span, and so in all of it.
    Span {
        /// Its item.
        item: u32,
        /// First column.
        x0: i32,
        /// The column after the last.
        x1: i32,
        /// Its depths at the first column and at the last.
        depths: [f32; 2],
    },
    /// Triangles cross in depth within a span, which is split.
    Split {
        /// First column of the part around the crossing.
        x0: i32,
        /// The column after that part.
        x1: i32,
    },
    /// A triangle is the nearest so far at a pixel of a part that is compared pixel by pixel.
    Write {
        /// Its item.
        item: u32,
        /// The column.
        x: i32,
    },
}

/// Length in pixels below which spans are compared pixel by pixel, which costs no more than comparing both ends.
const SHORT: i32 = 3;

/// Length from which undecided spans are halved first, so that only the part where faces coincide is compared pixel by
/// pixel.
const LONG: i32 = 16;

/// Renders into the planes that the framebuffer has.
pub fn render(
    input: &SurfaceInput<'_>,
    lights: &PreparedLights,
    options: &Options,
    framebuffer: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) {
    let materials = PreparedMaterials::new(input.scene).with_ink(options.background.ink());
    let (width, rows) = (input.view.width(), input.view.window());
    let mut picture = Picture::new(input, &materials, lights, (options, 0), framebuffer);
    let mut list = ActiveList::new(&input.triangles, input.view);
    let mut edges = EdgeList::default();
    let mut line = Line {
        triangles: &input.triangles,
        masked: Masked::new(input),
        row: DepthRow::new(width),
        y: 0,
        wants_depth: picture.wants_planes(),
        inside: Vec::new(),
        parts: Vec::new(),
    };
    let mut layers = Layers::of(input);
    let mut charge = input.work.charge(METHOD, 0).unwrap_or_default();
    for y in (rows.y0()..rows.y1()).take_while(|_| !input.work.is_stopped()) {
        t.step(|| Step::Row { y });
        input.work.advance(1);
        line.y = y;
        line.row.clear();
        let active = list.advance(y, |_| ());
        edges.replace(active);
        line.sweep(&edges, &mut picture.lit, t);
        write_row(y, &line.row, active, &mut layers, &line.masked, &mut picture);
        charge.grow_to_or_stop(list.bytes() + edges.bytes());
    }
}

/// The ends of the active triangles on a row, each kind sorted by column.
///
/// A key has the column in its upper half and the triangle in its lower.
#[derive(Debug, Default)]
struct EdgeList {
    entering: Vec<u64>,
    leaving: Vec<u64>,
}

impl EdgeList {
    fn bytes(&self) -> u64 {
        ((self.entering.capacity() + self.leaving.capacity()) * size_of::<u64>()) as u64
    }

    fn replace(&mut self, active: &[Active]) {
        self.entering.clear();
        self.leaving.clear();
        for a in active.iter().filter(|a| a.x0 < a.x1) {
            let key = |x: i32| u64::from(x.unsigned_abs()) << 32 | u64::from(a.triangle);
            self.entering.push(key(a.x0));
            self.leaving.push(key(a.x1));
        }
        self.entering.sort_unstable();
        self.leaving.sort_unstable();
    }
}

/// Returns the column and the triangle of an edge.
fn edge(key: u64) -> (i32, u32) {
    ((key >> 32) as i32, key as u32)
}

/// One row: the triangles in it and the surfaces visible so far.
struct Line<'a> {
    triangles: &'a [ScreenTriangle],
    masked: Masked<'a>,
    row: DepthRow,
    y: i32,
    /// True if the depths of decided spans are used.
    wants_depth: bool,
    /// Indices of the triangles whose flag says in.
    inside: Vec<u32>,
    /// Parts of the current span that are yet to be decided: first column, column after the last.
    parts: Vec<[i32; 2]>,
}

/// The depth of a triangle at the two ends of a part of a row.
#[derive(Debug, Clone, Copy)]
struct Ends {
    triangle: u32,
    item: u32,
    /// At the first and the last pixel.
    depth: [f32; 2],
    /// True if the depths at both pixels are the plane's own, not clamped to the depth of the nearest or farthest
    /// vertex.
    linear: bool,
    /// More than rounding moves any depth in between, off the straight line through both.
    slack: f32,
}

impl Line<'_> {
    /// Passes the row's edges from left to right.
    fn sweep(&mut self, edges: &EdgeList, lit: &mut Lit<'_>, t: &mut impl Tracer<Step>) {
        let mut entering = edges.entering.iter().peekable();
        let mut leaving = edges.leaving.iter().peekable();
        let mut from = 0;
        while let Some(&&next_out) = leaving.peek() {
            let x = entering.peek().map_or(edge(next_out).0, |&&k| edge(k.min(next_out)).0);
            if from < x && !self.inside.is_empty() {
                self.span([from, x], lit, t);
            }
            from = x;
            while let Some(&&key) = leaving.peek()
                && edge(key).0 == x
            {
                leaving.next();
                self.inside.retain(|&i| i != edge(key).1);
                t.step(|| Step::Out { item: self.item(edge(key).1), x });
            }
            while let Some(&&key) = entering.peek()
                && edge(key).0 == x
            {
                entering.next();
                self.inside.push(edge(key).1);
                t.step(|| Step::In { item: self.item(edge(key).1), x });
            }
        }
    }

    fn item(&self, triangle: u32) -> u32 {
        self.triangles[triangle as usize].item
    }

    /// Decides a span, in parts where one triangle does not win all of it.
    fn span(&mut self, [x0, x1]: [i32; 2], lit: &mut Lit<'_>, t: &mut impl Tracer<Step>) {
        if x1 - x0 < SHORT || self.inside.iter().any(|&i| self.masked.masked.contains(i as usize)) {
            return self.compare([x0, x1], lit, t);
        }
        self.parts.push([x0, x1]);
        while let Some([x0, x1]) = self.parts.pop() {
            if x1 - x0 < SHORT {
                self.compare([x0, x1], lit, t);
                continue;
            }
            let [first, last] = self.nearest_at_ends([x0, x1]);
            if first.triangle == last.triangle && self.wins_throughout(&first, [x0, x1]) {
                t.step(|| Step::Span { item: first.item, x0, x1, depths: first.depth });
                self.fill(first.triangle, [x0, x1]);
            } else if first.triangle != last.triangle {
                let [from, to] = self.crossing(&first, &last, [x0, x1]);
                t.step(|| Step::Split { x0: from, x1: to });
                self.push_parts(&[[to, x1], [x0, from]]);
                self.compare([from, to], lit, t);
            } else if x1 - x0 >= LONG {
                let middle = x0 + (x1 - x0) / 2;
                self.push_parts(&[[middle, x1], [x0, middle]]);
            } else {
                self.compare([x0, x1], lit, t);
            }
        }
    }

    fn push_parts(&mut self, parts: &[[i32; 2]]) {
        self.parts.extend(parts.iter().filter(|[x0, x1]| x0 < x1));
    }

    /// Returns a triangle's depths at both ends of a part.
    fn ends(&self, triangle: u32, [x0, x1]: [i32; 2]) -> Ends {
        let t = &self.triangles[triangle as usize];
        let [ox, oy] = t.origin();
        let (dx0, dx1, dy) = ((x0 - ox) as f32, (x1 - 1 - ox) as f32, (self.y - oy) as f32);
        let depth = [t.depth_at(dx0, dy), t.depth_at(dx1, dy)];
        let within = |dx: f32| {
            let raw = t.depth + (t.depth_dx * dx + t.depth_dy * dy);
            raw >= t.depth_min && raw <= t.depth_max
        };
        // Five roundings, each at most 2⁻²⁴ of the largest intermediate number.
        let along = t.depth_dx.abs() * dx0.abs().max(dx1.abs());
        let largest = along + (t.depth_dy * dy).abs() + t.depth.abs();
        let slack = largest * (32.0 * f32::EPSILON);
        Ends { triangle, item: t.item, depth, linear: within(dx0) && within(dx1), slack }
    }

    /// Returns the nearest triangle at the first pixel, and that at the last.
    fn nearest_at_ends(&self, part: [i32; 2]) -> [Ends; 2] {
        let first = self.ends(self.inside[0], part);
        let mut nearest = [first, first];
        for &triangle in &self.inside[1..] {
            let other = self.ends(triangle, part);
            for (i, kept) in nearest.iter_mut().enumerate() {
                if is_nearer(other.depth[i], other.item, kept.depth[i], kept.item) {
                    *kept = other;
                }
            }
        }
        nearest
    }

    /// Returns whether a triangle surely hides all others, and is before the far plane, all along a
    /// part.
    fn wins_throughout(&self, a: &Ends, part: [i32; 2]) -> bool {
        let farthest = a.depth[0].max(a.depth[1]) + a.slack;
        farthest < 1.0
            && self.inside.iter().filter(|&&i| i != a.triangle).all(|&i| {
                let b = self.ends(i, part);
                let clear = |ahead: f32| ahead > a.slack + b.slack;
                let apart = b.depth[0].min(b.depth[1]) - farthest;
                let in_line = a.linear
                    && b.linear
                    && clear(b.depth[0] - a.depth[0])
                    && clear(b.depth[1] - a.depth[1]);
                in_line || clear(apart)
            })
    }

    /// Returns the few columns around the one where two triangles change places.
    fn crossing(&self, first: &Ends, last: &Ends, [x0, x1]: [i32; 2]) -> [i32; 2] {
        let ends = |triangle| self.ends(triangle, [x0, x1]).depth.map(f64::from);
        let (a, b) = (ends(first.triangle), ends(last.triangle));
        let (ahead, behind) = ((b[0] - a[0]).max(0.0), (a[1] - b[1]).max(0.0));
        let share = if ahead + behind > 0.0 { ahead / (ahead + behind) } else { 0.5 };
        let column = x0 + (share * f64::from(x1 - 1 - x0)) as i32;
        [(column - 1).max(x0), (column + 3).min(x1)]
    }

    /// Compares all triangles that are in at each pixel.
    fn compare(&mut self, part: [i32; 2], lit: &mut Lit<'_>, t: &mut impl Tracer<Step>) {
        let Self { triangles, masked, row, y, inside, .. } = self;
        for &triangle in inside.iter() {
            let item = triangles[triangle as usize].item;
            let wrote = |x, _| t.step(|| Step::Write { item, x });
            masked.enter(row, triangle, part, *y, lit, wrote);
        }
    }

    /// Enters the one visible triangle of a part.
    fn fill(&mut self, triangle: u32, [x0, x1]: [i32; 2]) {
        let t = &self.triangles[triangle as usize];
        let columns = x0 as usize..x1 as usize;
        let (items, depths) = (&mut self.row.item[columns.clone()], &mut self.row.depth[columns]);
        items.fill(t.item);
        if !self.wants_depth {
            return;
        }
        let [ox, oy] = t.origin();
        let dy = (self.y - oy) as f32;
        for (x, depth) in (x0..x1).zip(depths) {
            *depth = t.depth_at((x - ox) as f32, dy);
        }
    }
}
