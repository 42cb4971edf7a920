//! Operations that a method for visible surfaces takes: the work in its own terms, independent of the machine.

use super::words::Word;
use crate::trace::Tracer;
use crate::visibility::surface::comparisons::Comparisons;
use crate::visibility::surface::method::Step;
use crate::visibility::surface::{
    SurfaceMethod, a_buffer, depth_sort, ray, scan_line_z, spanning_scan_line, warnock,
};

/// Number of operations of one kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Operations {
    /// Name of the kind, in kebab case.
    pub name: &'static str,
    /// Title of the kind.
    pub title: Word,
    /// Number of operations.
    pub count: u64,
}

/// Kinds of operations; each names an entry of [`KINDS`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Compared,
    Stored,
    Activated,
    Spans,
    Edges,
    SeenSpans,
    SpanSplits,
    PixelWrites,
    Fragments,
    LongestList,
    Shares,
    Pairs,
    Moves,
    Splits,
    Painted,
    Windows,
    Listed,
    Divisions,
    Samples,
    Rays,
    Boxes,
    Triangles,
    Hits,
}

/// Names and titles of the kinds, in the order of [`Kind`].
const KINDS: [(&str, Word); Kind::Hits as usize + 1] = [
    ("depth-comparisons", Word::new("depth comparisons", "Tiefenvergleiche")),
    ("depths-stored", Word::new("depths stored", "gespeicherte Tiefen")),
    ("activations", Word::new("triangles made active", "aktiv gewordene Dreiecke")),
    ("triangle-spans", Word::new("spans of triangles in rows", "Strecken von Dreiecken in Zeilen")),
    ("edges-passed", Word::new("edges passed in rows", "Kanten, die in Zeilen passiert wurden")),
    ("visible-spans", Word::new("visible spans", "sichtbare Strecken")),
    (
        "span-splits",
        Word::new("spans split where surfaces cross", "an Durchdringungen geteilte Strecken"),
    ),
    ("pixels-written", Word::new("pixels written one by one", "einzeln geschriebene Pixel")),
    ("fragments", Word::new("fragments", "Fragmente")),
    ("longest-list", Word::new("longest list of fragments", "längste Liste von Fragmenten")),
    ("shares", Word::new("shares of pixels", "Anteile an Pixeln")),
    ("pairs-tested", Word::new("pairs of polygons tested", "geprüfte Paare von Polygonen")),
    ("moves", Word::new("polygons moved in the list", "in der Liste verschobene Polygone")),
    ("splits", Word::new("polygons split", "geteilte Polygone")),
    ("painted", Word::new("polygons painted", "gemalte Polygone")),
    ("windows", Word::new("windows examined", "untersuchte Fenster")),
    (
        "triangles-listed",
        Word::new("triangles in lists of windows", "Dreiecke in Listen von Fenstern"),
    ),
    ("divisions", Word::new("windows divided", "geteilte Fenster")),
    ("samples", Word::new("windows of one pixel", "Fenster von einem Pixel")),
    ("rays", Word::new("rays", "Strahlen")),
    ("boxes-tested", Word::new("boxes tested", "geprüfte Quader")),
    ("triangles-tested", Word::new("triangles tested", "geprüfte Dreiecke")),
    ("hits", Word::new("rays that hit a surface", "Strahlen, die eine Fläche treffen")),
];

/// Returns the kinds that characterize a method.
const fn kinds(method: SurfaceMethod) -> &'static [Kind] {
    match method {
        SurfaceMethod::ZBuffer => &[Kind::Compared, Kind::Stored],
        SurfaceMethod::ScanLineZ => &[Kind::Activated, Kind::Spans, Kind::Compared, Kind::Stored],
        SurfaceMethod::SpanningScanLine => {
            &[Kind::Edges, Kind::SeenSpans, Kind::SpanSplits, Kind::PixelWrites]
        }
        SurfaceMethod::ABuffer => &[Kind::Fragments, Kind::LongestList, Kind::Shares],
        SurfaceMethod::DepthSort => &[Kind::Pairs, Kind::Moves, Kind::Splits, Kind::Painted],
        SurfaceMethod::Warnock => &[Kind::Windows, Kind::Listed, Kind::Divisions, Kind::Samples],
        SurfaceMethod::Ray => &[Kind::Rays, Kind::Boxes, Kind::Triangles, Kind::Hits],
    }
}

/// Tracer that counts operations instead of keeping steps.
///
/// ```
/// use durer::explain::Tally;
/// use durer::trace::Tracer;
/// use durer::visibility::surface::{Step, SurfaceMethod, scan_line_z};
///
/// let mut tally = Tally::default();
/// tally.step(|| Step::ScanLineZ(scan_line_z::Step::Span { item: 0, x0: 3, x1: 8 }));
/// let counts = tally.operations(SurfaceMethod::ScanLineZ);
/// let compared = counts.iter().find(|of| of.name == "depth-comparisons");
/// assert_eq!(compared.map(|of| of.count), Some(5));
/// ```
#[derive(Debug, Clone, Default)]
pub struct Tally {
    counts: [u64; KINDS.len()],
    /// Fragments of each column of the current row.
    lists: Vec<u64>,
}

impl Tally {
    /// Returns the counts of a method, its main one first.
    pub fn operations(&self, method: SurfaceMethod) -> Vec<Operations> {
        let of = |&kind: &Kind| {
            let (name, title) = KINDS[kind as usize];
            Operations { name, title, count: self.counts[kind as usize] }
        };
        kinds(method).iter().map(of).collect()
    }

    /// Adds the comparisons of the z-buffer, which takes no steps.
    pub(crate) fn add_comparisons(&mut self, counts: Comparisons) {
        self.add(Kind::Compared, counts.compared);
        self.add(Kind::Stored, counts.stored);
    }

    fn add(&mut self, kind: Kind, count: u64) {
        self.counts[kind as usize] += count;
    }

    fn scan_line_z(&mut self, step: &scan_line_z::Step) {
        use scan_line_z::Step;
        match step {
            Step::Row { .. } => {}
            Step::Enter { .. } => self.add(Kind::Activated, 1),
            Step::Span { x0, x1, .. } => {
                self.add(Kind::Spans, 1);
                self.add(Kind::Compared, u64::try_from(x1 - x0).unwrap_or(0));
            }
            Step::Write { .. } => self.add(Kind::Stored, 1),
        }
    }

    fn spanning(&mut self, step: &spanning_scan_line::Step) {
        use spanning_scan_line::Step;
        match step {
            Step::Row { .. } => {}
            Step::In { .. } | Step::Out { .. } => self.add(Kind::Edges, 1),
            Step::Span { .. } => self.add(Kind::SeenSpans, 1),
            Step::Split { .. } => self.add(Kind::SpanSplits, 1),
            Step::Write { .. } => self.add(Kind::PixelWrites, 1),
        }
    }

    fn a_buffer(&mut self, step: &a_buffer::Step) {
        use a_buffer::Step;
        match step {
            Step::Row { .. } => self.lists.clear(),
            Step::Fragment { x, .. } => {
                self.add(Kind::Fragments, 1);
                let column = usize::try_from(*x).unwrap_or(0);
                self.lists.resize(self.lists.len().max(column + 1), 0);
                self.lists[column] += 1;
                let longest = &mut self.counts[Kind::LongestList as usize];
                *longest = self.lists[column].max(*longest);
            }
            Step::Share { .. } => self.add(Kind::Shares, 1),
            Step::Background { .. } => {}
        }
    }

    fn depth_sort(&mut self, step: &depth_sort::Step) {
        use depth_sort::Step;
        match step {
            Step::Look { .. } => {}
            Step::Tested { .. } => self.add(Kind::Pairs, 1),
            Step::Move { .. } => self.add(Kind::Moves, 1),
            Step::Split { .. } => self.add(Kind::Splits, 1),
            Step::Place { .. } => self.add(Kind::Painted, 1),
        }
    }

    fn warnock(&mut self, step: &warnock::Step) {
        use warnock::Step;
        match step {
            Step::Begin { .. } | Step::Empty { .. } | Step::Single { .. } => {}
            Step::Surrounded { .. } => {}
            Step::Look { triangles, .. } => {
                self.add(Kind::Windows, 1);
                self.add(Kind::Listed, *triangles as u64);
            }
            Step::Sample { .. } => self.add(Kind::Samples, 1),
            Step::Divide { .. } => self.add(Kind::Divisions, 1),
        }
    }

    fn count(&mut self, step: &Step) {
        match step {
            Step::ScanLineZ(step) => self.scan_line_z(step),
            Step::SpanningScanLine(step) => self.spanning(step),
            Step::ABuffer(step) => self.a_buffer(step),
            Step::DepthSort(step) => self.depth_sort(step),
            Step::Warnock(step) => self.warnock(step),
            Step::Ray(step) => self.ray(step),
        }
    }

    fn ray(&mut self, step: &ray::Step) {
        let ray::Step::Ray { hit, tests, .. } = step else { return };
        self.add(Kind::Rays, 1);
        self.add(Kind::Boxes, tests.boxes.into());
        self.add(Kind::Triangles, tests.triangles.into());
        self.add(Kind::Hits, hit.is_some().into());
    }
}

impl Tracer<Step> for Tally {
    fn step(&mut self, make: impl FnOnce() -> Step) {
        self.count(&make());
    }
}
