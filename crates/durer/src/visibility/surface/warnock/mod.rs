//! Area subdivision.
//!
//! J. Warnock, *A Hidden Surface Algorithm for Computer Generated Halftone Pictures*, University of
//! Utah TR 4-15, 1969. Image space. A window is examined with the triangles that concern it; if it is
//! simple it is drawn, else it is divided. Cost: O(triangles · log pixels) for small triangles, at
//! most one look per sample and triangle that concerns it; memory O(triangles · log pixels).
//! Coherence used: areas.
//!
//! Deviations: windows consist of whole samples, so their corners are samples and all relations are decided exactly,
//! with the z-buffer's own coverage and depth. Triangles behind a surrounding one are dropped before a window is
//! divided. Blended surfaces hide nothing: where they are, windows are divided until all remaining triangles surround
//! them, and a sample keeps a list of them, front to back until opaque.

mod depth;
mod glass;

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::Vec4;
use crate::raster::fixed::HALF_PIXEL;
use crate::shade::PreparedLights;
use crate::shade::color::encode_premultiplied;
use crate::target::Framebuffer;
use crate::trace::{PseudocodeLine, Tracer};
use crate::visibility::surface::cover::{Cover, SampleGrid};
use crate::visibility::surface::input::{METHOD, SurfaceInput};
use crate::visibility::surface::layers::{below_color, mean};
use crate::visibility::surface::lit::{Lighting, Lit};
use crate::visibility::surface::picture;
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};
use crate::visibility::surface::visible::{
    Masks, Visible, background_at, nearer, pixels_of, with_lighting, write, write_planes,
};
use crate::visibility::surface::window::{SampleRect, WindowRelation};
use crate::work::{Charge, Work};
use depth::{farthest, hides};
use glass::Glass;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "warnock",
    title: "Warnock's area subdivision",
    authors: "J. Warnock",
    year: 1969,
    source: "A Hidden Surface Algorithm for Computer Generated Halftone Pictures, University of Utah",
    class: Class::ImageSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::Area],
    cost: "O(triangles · log pixels) for small triangles; memory likewise",
    limits: "where surfaces blend, each sample is decided separately",
    pseudocode: &[
        "look(window, polygons that concern it):",
        "    all outside: the window shows the background",
        "    only one of them concerns it: draw its part in the window",
        "    one surrounds the window and hides all others: fill the window",
        "    the window is one sample: the nearest polygon there",
        "    else: divide the window in four and look at each",
        "// inside, crossing and surrounding polygons concern a window",
        "begin with the whole picture and all polygons",
    ],
};

/// Bytes for each triangle of the input.
pub(super) const PER_TRIANGLE: u64 = (size_of::<Cover>() + 2 * size_of::<Entry>()) as u64;

/// Place at which a window is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Division {
    /// The middle of both sides.
    #[default]
    Regular,
    /// A vertex in the window, as near to its middle as can be found quickly.
    Vertices,
}

/// Options for rendering with Warnock's subdivision.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// Shading and background.
    pub look: picture::Options,
    /// Places at which windows are divided.
    pub division: Division,
    /// Number of times that a pixel is divided, 0 … 4; colour is the mean of its 4^`sub_levels` samples. Time about
    /// doubles with each level, because only windows along edges are divided that far.
    pub sub_levels: u32,
}

/// Step of the algorithm. Windows count in samples of the pass's grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Step {
    /// A pass over a part of the screen begins: pixels, or samples below them.
    Begin {
        /// The part.
        window: SampleRect,
        /// Samples along the side of a pixel.
        per_pixel: i32,
    },
    /// A window is examined.
    Look {
        /// The window.
        window: SampleRect,
        /// Number of triangles that concern it.
        triangles: usize,
    },
    /// Rule 1: all triangles are outside.
    Empty {
        /// The window.
        window: SampleRect,
    },
    /// Rule 2: only one triangle concerns the window.
    Single {
        /// The window.
        window: SampleRect,
        /// Index into [`SurfaceInput::triangles`].
        triangle: u32,
    },
    /// Rules 3 and 4: a triangle surrounds the window and hides all others that concern it.
    Surrounded {
        /// The window.
        window: SampleRect,
        /// Index into [`SurfaceInput::triangles`].
        triangle: u32,
    },
    /// A window of one sample: decided by depth.
    Sample {
        /// Column.
        x: i32,
        /// Row.
        y: i32,
        /// The nearest triangle that covers it, an index into [`SurfaceInput::triangles`].
        triangle: Option<u32>,
    },
    /// The window is divided before a column and a row.
    Divide {
        /// The window.
        window: SampleRect,
        /// First column of the right half.
        x: i32,
        /// First row of the lower half.
        y: i32,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Look { .. } => 1,
            Self::Empty { .. } => 2,
            Self::Single { .. } => 3,
            Self::Surrounded { .. } => 4,
            Self::Sample { .. } => 5,
            Self::Divide { .. } => 6,
            Self::Begin { .. } => 8,
        }
    }
}

/// Renders the input into the planes that the framebuffer has.
pub fn render(
    input: &SurfaceInput<'_>,
    lights: &PreparedLights,
    options: &Options,
    framebuffer: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) {
    with_lighting(input, lights, &options.look, |lighting| {
        let reach = if options.sub_levels == 0 { 0 } else { HALF_PIXEL };
        let lighting = Lighting { reach, ..lighting };
        let blended = input.having(Coverage::Blended);
        if !blended.is_empty() {
            return glass::render(input, lighting, blended, options, framebuffer, t);
        }
        let whole = pixels_of(input.view);
        let visible = solve(input, lighting, options.division, SampleGrid::PIXELS, whole, t);
        if options.sub_levels == 0 {
            write(&visible, lighting, &options.look, framebuffer);
        } else {
            write_planes(&visible, lighting, &options.look, framebuffer);
            anti_aliased(input, lighting, options, framebuffer, t);
        }
    });
}

/// Number of pixel rows whose samples are held in memory together.
const BAND: i32 = 16;

fn anti_aliased(
    input: &SurfaceInput<'_>,
    lighting: Lighting<'_>,
    options: &Options,
    framebuffer: &mut Framebuffer,
    t: &mut impl Tracer<Step>,
) {
    let grid = SampleGrid::below_pixel(options.sub_levels);
    let (n, SampleRect { x0, y0, x1, y1 }) = (grid.per_pixel(), pixels_of(input.view));
    let mut lit = Lit::new(lighting);
    for top in (y0..y1).step_by(BAND as usize).take_while(|_| !input.work.is_stopped()) {
        let bottom = y1.min(top + BAND);
        input.work.advance((bottom - top) as u64);
        let window = SampleRect { x0: x0 * n, y0: top * n, x1: x1 * n, y1: bottom * n };
        let visible = solve(input, lighting, options.division, grid, window, t);
        for (x, y) in (top..bottom).flat_map(|y| (x0..x1).map(move |x| (x, y))) {
            let behind = background_at(&options.look, input.view.height(), y);
            let color = encode_premultiplied(pixel_mean(&visible, &mut lit, n, [x, y], behind));
            framebuffer.color.set((x - x0) as u32, (y - y0) as u32, color);
        }
    }
}

/// Returns the mean of a pixel's samples.
fn pixel_mean(
    visible: &Visible,
    lit: &mut Lit<'_>,
    n: i32,
    [x, y]: [i32; 2],
    behind: Vec4,
) -> Vec4 {
    let mut items: Vec<u32> = Vec::with_capacity((n * n) as usize);
    for row in y * n..(y + 1) * n {
        let start = visible.index(x * n, row);
        items.extend(&visible.item[start..start + n as usize]);
    }
    mean(&mut items, |&item| below_color(lit, item, behind, [x, y]))
}

/// Finds the visible surfaces at the samples of a window.
pub(crate) fn solve(
    input: &SurfaceInput<'_>,
    lighting: Lighting<'_>,
    division: Division,
    grid: SampleGrid,
    window: SampleRect,
    t: &mut impl Tracer<Step>,
) -> Visible {
    let mut solver = Solver::new(input, lighting, grid, window, None);
    solver.run(window, division, t);
    solver.visible
}

/// A triangle that concerns a window.
#[derive(Debug, Clone, Copy)]
struct Entry {
    triangle: u32,
    surrounds: bool,
}

/// A window that waits, and its part of the list of entries.
struct Waiting {
    window: SampleRect,
    first: usize,
    end: usize,
}

struct Solver<'a> {
    triangles: &'a [ScreenTriangle],
    covers: Vec<Cover>,
    grid: SampleGrid,
    masks: Masks<'a>,
    /// Opaque surfaces.
    visible: Visible,
    /// Blended surfaces and the ones before them, if any surface blends.
    glass: Option<Glass>,
    work: &'a Work,
    /// Memory of the lists of windows, and of the glass.
    charge: Charge,
}

impl<'a> Solver<'a> {
    fn new(
        input: &'a SurfaceInput<'_>,
        lighting: Lighting<'a>,
        grid: SampleGrid,
        window: SampleRect,
        glass: Option<Glass>,
    ) -> Self {
        let triangles = &input.triangles;
        let covers = triangles.iter().map(|t| Cover::new(t, grid)).collect();
        let (masks, visible) = (Masks::new(input, lighting), Visible::new(window));
        let charge = input.work.charge(METHOD, 0).unwrap_or_default();
        Self { triangles, covers, grid, masks, visible, glass, work: &input.work, charge }
    }

    /// Begins with an empty window.
    fn restart(&mut self, window: SampleRect) {
        self.visible = Visible::new(window);
        if let Some(glass) = &mut self.glass {
            glass.layers.clear();
        }
    }

    fn is_blended(&self, triangle: usize) -> bool {
        self.glass.as_ref().is_some_and(|glass| glass.blended.contains(triangle))
    }

    /// Examines windows from a stack; the windows of a stack share one list of entries.
    fn run(&mut self, whole: SampleRect, division: Division, t: &mut impl Tracer<Step>) {
        t.step(|| Step::Begin { window: whole, per_pixel: self.grid.per_pixel() });
        let mut list = Vec::new();
        if !whole.is_empty() {
            let all = 0..self.triangles.len() as u32;
            let all: Vec<Entry> =
                all.map(|triangle| Entry { triangle, surrounds: false }).collect();
            self.concern(&all, &whole, &mut list);
        }
        let mut stack = vec![Waiting { window: whole, first: 0, end: list.len() }];
        let mut entries = Vec::new();
        while let Some(Waiting { window, first, end }) = stack.pop() {
            let glass = self.glass.as_ref().map_or(0, Glass::bytes);
            let lists = (list.capacity() + entries.capacity()) * size_of::<Entry>();
            if self.work.is_stopped() || !self.charge.grow_to_or_stop(lists as u64 + glass) {
                return;
            }
            entries.clear();
            entries.extend_from_slice(&list[first..end]);
            list.truncate(first);
            t.step(|| Step::Look { window, triangles: entries.len() });
            self.drop_hidden(&window, &mut entries);
            if self.draw_simple(&window, &entries, t) {
                continue;
            }
            let (x, y) = self.division(&window, &entries, division);
            t.step(|| Step::Divide { window, x, y });
            for part in parts(&window, x, y) {
                let first = list.len();
                self.concern(&entries, &part, &mut list);
                stack.push(Waiting { window: part, first, end: list.len() });
            }
        }
    }

    /// Adds those entries to a list that concern a window.
    fn concern(&self, entries: &[Entry], window: &SampleRect, list: &mut Vec<Entry>) {
        for &Entry { triangle, surrounds } in entries {
            let relation = match surrounds {
                true => WindowRelation::Surrounding,
                false => self.covers[triangle as usize].relation(window),
            };
            if relation != WindowRelation::Outside {
                let surrounds = relation == WindowRelation::Surrounding;
                list.push(Entry { triangle, surrounds });
            }
        }
    }

    /// Drops triangles behind a surrounding one: the one whose farthest corner is nearest.
    fn drop_hidden(&self, window: &SampleRect, entries: &mut Vec<Entry>) {
        let surrounding = entries.iter().filter(|e| e.surrounds);
        let mut best: Option<(f32, u32, u32)> = None;
        let hiding = |i: usize| !self.masks.is_masked(i) && !self.is_blended(i);
        for e in surrounding.filter(|e| hiding(e.triangle as usize)) {
            let triangle = &self.triangles[e.triangle as usize];
            let far = farthest(triangle, self.grid, window);
            if best.is_none_or(|(depth, item, _)| nearer((far, triangle.item), (depth, item))) {
                best = Some((far, triangle.item, e.triangle));
            }
        }
        let Some((_, _, hider)) = best else { return };
        let front = &self.triangles[hider as usize];
        entries.retain(|e| {
            let behind = &self.triangles[e.triangle as usize];
            e.triangle == hider || !hides(front, behind, self.grid, window)
        });
    }

    /// Draws a window that is empty, has one triangle or one sample, or in which no subdivision would separate blended
    /// surfaces; returns whether it was such a window.
    fn draw_simple(
        &mut self,
        window: &SampleRect,
        entries: &[Entry],
        t: &mut impl Tracer<Step>,
    ) -> bool {
        let window = *window;
        match *entries {
            [] => t.step(|| Step::Empty { window }),
            [Entry { triangle, surrounds }] => {
                t.step(|| match surrounds {
                    true => Step::Surrounded { window, triangle },
                    false => Step::Single { window, triangle },
                });
                self.draw(&window, triangle as usize);
            }
            _ if window.x1 - window.x0 == 1 && window.y1 - window.y0 == 1 => {
                self.decide(entries, [window.x0, window.y0], t);
            }
            _ if self.glass.is_some() && entries.iter().all(|e| e.surrounds) => {
                for y in window.y0..window.y1 {
                    (window.x0..window.x1).for_each(|x| self.decide(entries, [x, y], t));
                }
            }
            _ => return false,
        }
        true
    }

    /// Scan-converts one triangle in a window.
    fn draw(&mut self, window: &SampleRect, triangle: usize) {
        let blended = self.is_blended(triangle);
        let Self { triangles, covers, grid, masks, visible, glass, .. } = self;
        let (t, n) = (&triangles[triangle], grid.per_pixel());
        covers[triangle].spans(window, |span| {
            for x in span.x0..span.x1 {
                if !masks.passes(triangle, t.item, x / n, span.y / n) {
                    continue;
                }
                let depth = grid.depth(t, x, span.y);
                match glass {
                    Some(glass) if blended => {
                        glass.put(visible.index(x, span.y), depth, t.item);
                    }
                    _ => visible.put(x, span.y, depth, t.item),
                }
            }
        });
    }

    /// Decides one sample by depth.
    fn decide(&mut self, entries: &[Entry], [x, y]: [i32; 2], t: &mut impl Tracer<Step>) {
        let n = self.grid.per_pixel();
        // The nearest of the opaque surfaces, and the nearest of all surfaces.
        let [mut best, mut front]: [Option<(f32, u32, u32)>; 2] = [None, None];
        let place = self.visible.index(x, y);
        let first = self.glass.as_ref().map_or(0, |glass| glass.layers.len());
        for &Entry { triangle, .. } in entries {
            let i = triangle as usize;
            let (depth, item) = (self.grid.depth(&self.triangles[i], x, y), self.triangles[i].item);
            let wins = |over: Option<(f32, u32, u32)>| {
                over.is_none_or(|(d, other, _)| nearer((depth, item), (d, other)))
            };
            if !wins(best)
                || !self.covers[i].covers(x, y)
                || !self.masks.passes(i, item, x / n, y / n)
            {
                continue;
            }
            if wins(front) {
                front = Some((depth, item, triangle));
            }
            match &mut self.glass {
                Some(glass) if glass.blended.contains(i) => glass.put(place, depth, item),
                _ => best = Some((depth, item, triangle)),
            }
        }
        t.step(|| Step::Sample { x, y, triangle: front.map(|b| b.2) });
        if let Some((depth, item, _)) = best {
            self.visible.put(x, y, depth, item);
            if let Some(glass) = &mut self.glass {
                glass.keep_before(first, (depth, item));
            }
        }
    }

    /// Returns the column and row before which a window is divided.
    fn division(&self, w: &SampleRect, entries: &[Entry], division: Division) -> (i32, i32) {
        let middle = ((w.x0 + w.x1) / 2, (w.y0 + w.y1) / 2);
        if division == Division::Regular {
            return middle;
        }
        let inside = |v: i32, first: i32, end: i32| v > first && v < end;
        let crossing = entries.iter().filter(|e| !e.surrounds).take(VERTEX_CANDIDATES);
        let places = crossing.flat_map(|e| {
            let t = &self.triangles[e.triangle as usize];
            [0, 1, 2].map(|i| (self.grid.first_at(t.x[i]), self.grid.first_at(t.y[i])))
        });
        places
            .filter(|&(x, y)| inside(x, w.x0, w.x1) && inside(y, w.y0, w.y1))
            .min_by_key(|&(x, y)| x.abs_diff(middle.0).max(y.abs_diff(middle.1)))
            .unwrap_or(middle)
    }
}

/// Triangles whose vertices are examined to divide a window; more would take longer than it saves.
const VERTEX_CANDIDATES: usize = 16;

/// Returns the parts of a window that are not empty.
fn parts(w: &SampleRect, x: i32, y: i32) -> impl Iterator<Item = SampleRect> {
    let SampleRect { x0, y0, x1, y1 } = *w;
    let columns = [(x, x1), (x0, x)];
    let rows = [(y, y1), (y0, y)];
    let parts = rows.map(|(y0, y1)| columns.map(|(x0, x1)| SampleRect { x0, y0, x1, y1 }));
    parts.into_iter().flatten().filter(|part| !part.is_empty())
}
