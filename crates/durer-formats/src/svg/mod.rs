//! Drawings in SVG, onto a canvas.
//!
//! Style sheets, and values newer than SVG 1.1, are written as attributes that usvg knows, as browsers interpret them;
//! usvg resolves units, references and text; the remaining paths with fills and strokes, groups with clip paths, masks
//! and opacity, and images are painted by [`durer::raster::paint`]. Filters, blend modes, animations and scripts are
//! not painted; [`Drawing::read`] and [`Drawing::draw`] warn of them.
//!
//! ```
//! use durer::math::DAffine2;
//! use durer::raster::paint::{Canvas, Options};
//! use durer::target::Pixels;
//! use durer_formats::svg::{Drawing, ReadOptions};
//!
//! let text = b"<svg xmlns='http://www.w3.org/2000/svg' width='8' height='4'>
//!     <rect width='4' height='4' fill='rgb(204,0,0)'/></svg>";
//! let drawing = Drawing::read(text, &ReadOptions::default())?;
//! assert_eq!(drawing.size().to_array(), [8.0, 4.0]);
//! let mut canvas = Canvas::new(8, 4, Options::default())?;
//! drawing.draw(&mut canvas, DAffine2::IDENTITY);
//! let mut picture = Pixels::new(8, 4, [0; 4]);
//! canvas.render(&mut picture)?;
//! assert_eq!(picture.row(2)[3..5], [[204, 0, 0, 255], [0; 4]]);
//! # Ok::<(), durer_formats::Error>(())
//! ```

mod amend;
mod arcs;
mod draw;
mod filters;
mod finish;
mod fonts;
mod image;
mod letters;
mod lines;
mod markers;
mod outline;
mod paint;
mod painted;
mod pictures;
mod references;
mod shapes;
mod source;
mod style;
mod texts;
mod transform;
mod values;
mod write;

pub use fonts::{Fonts, no_glyphs};

use crate::{Error, Limits, NoResources, Place, Resources, Result, Warning, foreign};
use durer::math::{DAffine2, DVec2};
use durer::raster::paint::PaintTarget;
use durer::work::Charge;
use std::collections::BTreeSet;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use svgtypes::{PathParser, PathSegment};
use usvg::roxmltree;

/// Elements that are ignored, besides purely descriptive ones.
const NOT_DRAWN: [&str; 12] = [
    "animate",
    "animateColor",
    "animateMotion",
    "animateTransform",
    "audio",
    "canvas",
    "foreignObject",
    "iframe",
    "meshgradient",
    "script",
    "set",
    "video",
];

/// Options for reading a drawing.
#[derive(Clone)]
pub struct ReadOptions<'a> {
    /// The fonts for text; without any, text is left out.
    pub fonts: &'a Fonts,
    /// Source of images that are not part of the file.
    pub resources: &'a (dyn Resources + Sync),
    /// Limits of sizes of images, and of all images together.
    pub limits: Limits,
}

impl Default for ReadOptions<'_> {
    /// Returns the default: no fonts, no resources, the default limits.
    fn default() -> Self {
        static NONE: Fonts = Fonts::new();
        Self { fonts: &NONE, resources: &NoResources, limits: Limits::default() }
    }
}

/// A drawing, ready to be drawn.
#[derive(Debug, Clone)]
pub struct Drawing {
    tree: usvg::Tree,
    place: Place,
    limits: Limits,
    warnings: Vec<Warning>,
    /// Charge of the tree to the budget.
    _charge: Charge,
}

/// Stage of the tree in errors about memory.
const TREE: &str = "elements of the drawing";

/// Bytes of an element, of a byte of its attributes, and of a letter with its outline, in the document and in the tree.
const PER_ELEMENT: u64 = 1 << 10;
const PER_BYTE: u64 = 8;
const PER_LETTER: u64 = 2 << 10;

/// Returns about how much memory it takes to resolve a document.
fn cost(document: &roxmltree::Document<'_>) -> u64 {
    let (mut elements, mut letters, mut inside) = (0_u64, 0_u64, 0);
    for node in document.descendants() {
        elements += u64::from(node.is_element());
        if node.has_tag_name(TEXT) {
            inside = inside.max(node.range().end);
        }
        if node.is_text() && node.range().start < inside {
            letters += node.text().map_or(0, |text| text.chars().count() as u64);
        }
    }
    let text = document.input_text().len() as u64;
    elements * PER_ELEMENT + text * PER_BYTE + letters * PER_LETTER
}

impl Drawing {
    /// Reads an SVG document.
    ///
    /// # Errors
    /// [`Error::Decode`] with line and column if the text is not XML, and if there is no `svg` element with a size, or
    /// coordinates that overflow. Of the last usvg panics; that is caught here, but the panic hook is called.
    pub fn read(bytes: &[u8], options: &ReadOptions<'_>) -> Result<Self> {
        let text = source::text(bytes, &options.limits)?;
        let document = parse(&text)?;
        let root = document.root_element().tag_name();
        if root != ROOT.into() {
            let name = root.name();
            let message = format!("the root is `{name}`, not `svg` with xmlns=\"{}\"", ROOT.0);
            return Err(Error::line(1, 0, message));
        }
        let mut charge = options.limits.work.charge(TREE, cost(&document))?;
        let notes = Notes::new(options.limits.decoded_bytes);
        let prepared = prepared(&document, 0, &notes, false)?;
        let tree = {
            let usvg_options = usvg::Options {
                font_family: options.fonts.default_family(),
                font_size: FONT_SIZE,
                fontdb: options.fonts.database(),
                font_resolver: fonts::resolver(&notes),
                image_href_resolver: pictures::resolver(options, &notes),
                ..usvg::Options::default()
            };
            let amended = prepared.document()?;
            if let Some(amended) = &amended {
                charge.grow(cost(amended))?;
            }
            let document = amended.as_ref().unwrap_or(&document);
            resolved(|| usvg::Tree::from_xmltree(document, &usvg_options))?
        };
        let mut warnings = prepared.warnings;
        if options.fonts.is_empty() && document.descendants().any(|n| n.has_tag_name(TEXT)) {
            warnings.push(warning("text is left out: there are no fonts"));
        }
        let (noted, letters) = notes.take();
        warnings.extend(noted);
        warnings.extend(fonts::missing_letters(&tree, letters).map(warning));
        let at = document.text_pos_at(document.root_element().range().start);
        let place = Place::Line(at.row.into(), at.col.into());
        let limits = options.limits.clone();
        Ok(Self { tree, place, limits, warnings, _charge: charge })
    }

    /// Returns the place in the document of the `svg` element that gives the drawing its size.
    pub fn place(&self) -> &Place {
        &self.place
    }

    /// Returns the width and height in the drawing's own units, above 0.
    pub fn size(&self) -> DVec2 {
        let size = self.tree.size();
        DVec2::new(f64::from(size.width()), f64::from(size.height()))
    }

    /// Returns the omissions and replacements while reading.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Paints the drawing; `pixel_from_drawing` maps the drawing's units, y down, to pixels. Returns warnings of
    /// elements that cannot be drawn, each kind once. Cost: the target's, plus the cost of each tile of a pattern and
    /// each image.
    pub fn draw(
        &self,
        target: &mut impl PaintTarget,
        pixel_from_drawing: DAffine2,
    ) -> Vec<Warning> {
        let mut painter = draw::Painter::new(target, &self.limits);
        painter.tree(&self.tree, pixel_from_drawing);
        painter.warnings().into_iter().map(warning).collect()
    }
}

/// The size of text that says none, in pixels, as browsers have it.
const FONT_SIZE: f32 = 16.0;

const ROOT: (&str, &str) = ("http://www.w3.org/2000/svg", "svg");
const TEXT: (&str, &str) = (ROOT.0, "text");

fn warning(message: impl Into<String>) -> Warning {
    Warning { place: Place::Whole, message: message.into() }
}

/// Messages from within usvg, and the facts that usvg's callbacks need.
#[derive(Debug)]
struct Notes {
    heard: Mutex<Heard>,
    /// Number of levels of elements that recursion may still enter.
    levels: AtomicUsize,
    /// Bytes of pictures that may still be decoded.
    bytes_left: AtomicU64,
}

/// Messages, each once; letters without a font; and the pictures that are referred to.
#[derive(Debug, Default)]
struct Heard {
    messages: Vec<Warning>,
    /// Texts of the messages.
    said: BTreeSet<String>,
    letters: BTreeSet<char>,
    pictures: Vec<pictures::Picture>,
    /// Pictures that have been read, by address and depth.
    read: pictures::Read,
}

impl Notes {
    fn new(bytes: u64) -> Self {
        let heard = Mutex::default();
        Self { heard, levels: AtomicUsize::new(0), bytes_left: AtomicU64::new(bytes) }
    }

    fn heard(&self) -> std::sync::MutexGuard<'_, Heard> {
        // A poisoned lock still holds the messages.
        self.heard.lock().unwrap_or_else(|e| e.into_inner())
    }

    fn add(&self, place: Place, message: String) {
        let mut heard = self.heard();
        if heard.said.insert(message.clone()) {
            heard.messages.push(Warning { place, message });
        }
    }

    /// Notes that no font has a letter.
    fn miss(&self, letter: char) {
        self.heard().letters.insert(letter);
    }

    fn read_before(&self, key: &pictures::Key) -> Option<usvg::ImageKind> {
        self.heard().read.get(key).cloned()
    }

    fn keep_read(&self, key: pictures::Key, kind: usvg::ImageKind) {
        self.heard().read.insert(key, kind);
    }

    fn picture(&self, number: usize) -> Option<pictures::Picture> {
        self.heard().pictures.get(number).cloned()
    }

    fn levels(&self) -> usize {
        self.levels.load(Ordering::Relaxed)
    }

    fn set_levels(&self, levels: usize) {
        self.levels.store(levels, Ordering::Relaxed);
    }

    fn bytes_left(&self) -> u64 {
        self.bytes_left.load(Ordering::Relaxed)
    }

    fn take_bytes(&self, bytes: u64) {
        self.bytes_left.store(self.bytes_left().saturating_sub(bytes), Ordering::Relaxed);
    }

    fn take(self) -> (Vec<Warning>, BTreeSet<char>) {
        let heard = self.heard.into_inner().unwrap_or_else(|e| e.into_inner());
        (heard.messages, heard.letters)
    }
}

/// A document that has been checked and rewritten in terms that usvg knows.
struct Prepared {
    written: Option<write::Written>,
    warnings: Vec<Warning>,
}

impl Prepared {
    /// Returns the rewritten document, if there is one.
    fn document(&self) -> Result<Option<roxmltree::Document<'_>>> {
        self.written.as_ref().map(|written| parse(&written.text)).transpose()
    }
}

/// Examines a document with `above` levels of elements around it, and rewrites it in terms that usvg knows.
///
/// # Errors
/// For documents that usvg cannot process.
fn prepared(
    document: &roxmltree::Document<'_>,
    above: usize,
    notes: &Notes,
    is_within: bool,
) -> Result<Prepared> {
    check_arcs(document)?;
    texts::check(document)?;
    let mut warnings = passed_over(document);
    let lines = lines::Lines::new(document.input_text());
    let at = |offset: usize| lines.at(offset);
    let pictures = notes.heard().pictures.len();
    let amended = amend::amended(document, pictures)?;
    warnings.extend(amended.warnings);
    notes.heard().pictures.extend(
        amended.pictures.into_iter().map(|(href, offset)| pictures::Picture {
            href,
            place: lines.place(offset),
            is_within,
        }),
    );
    let prepared = Prepared { written: amended.written, warnings };
    let levels = match (&prepared.written, prepared.document()?) {
        (Some(written), Some(new)) => references::check(&new, above, &|node| {
            let mut elements = new.descendants().filter(roxmltree::Node::is_element);
            let number = elements.position(|other| other.id() == node.id());
            at(number.and_then(|n| written.places.get(n)).copied().unwrap_or_default())
        })?,
        _ => references::check(document, above, &|node| at(node.range().start))?,
    };
    notes.set_levels(levels);
    Ok(prepared)
}

fn parse(text: &str) -> Result<roxmltree::Document<'_>> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(text, options);
    document.map_err(|error| not_xml(&error, text))
}

fn not_xml(error: &roxmltree::Error, text: &str) -> Error {
    use roxmltree::Error::{NodesLimitReached, UnclosedRootNode, UnexpectedEndOfStream};
    let at = error.pos();
    let (line, column) = match error {
        NodesLimitReached => return Error::whole(foreign::TOO_MANY_ELEMENTS),
        UnclosedRootNode | UnexpectedEndOfStream => lines::Lines::new(text).at(text.len()),
        _ => (at.row.into(), at.col.into()),
    };
    Error::line(line, column, format!("not well-formed XML: {}", foreign::markup(error)))
}

/// Returns usvg's tree of a document. If numbers overflow in it, such as coordinates under a transform by 10²⁰, it may
/// panic.
fn resolved(
    tree: impl FnOnce() -> std::result::Result<usvg::Tree, usvg::Error>,
) -> Result<usvg::Tree> {
    match std::panic::catch_unwind(std::panic::AssertUnwindSafe(tree)) {
        Ok(tree) => tree.map_err(wrong),
        Err(_) => Err(Error::whole(
            "the drawing cannot be laid out; coordinates must stay within ±10¹⁵ under all transforms",
        )),
    }
}

fn wrong(error: usvg::Error) -> Error {
    match error {
        // The document was parsed before: of these only the count of elements is left.
        usvg::Error::ParsingFailed(_) | usvg::Error::ElementsLimitReached => {
            Error::whole(foreign::TOO_MANY_ELEMENTS)
        }
        usvg::Error::InvalidSize => Error::whole(
            "the drawing has no size; `svg` needs a `viewBox`, or a `width` and `height` above 0",
        ),
        _ => Error::whole("the drawing cannot be read as SVG"),
    }
}

/// Limit on the numbers in arcs of paths; beyond it they are refused. An arc becomes the more curves the larger it is,
/// and one of 10³⁸ pixels millions, which take for ever.
const FARTHEST: f64 = 1e15;

/// Checks that arcs can be read in a time that is in proportion to the document.
fn check_arcs(document: &roxmltree::Document<'_>) -> Result<()> {
    for path in document.descendants().filter_map(|node| node.attribute_node("d")) {
        // Arcs begin at the current point of the path, which may be anywhere.
        if path.value().contains(['A', 'a']) && PathParser::from(path.value()).any(is_far) {
            let at = document.text_pos_at(path.range().start);
            let message = "a path with arcs reaches beyond ±10¹⁵, farther than arcs can be drawn";
            return Err(Error::line(at.row.into(), at.col.into(), message));
        }
    }
    Ok(())
}

/// Returns whether a number of a segment is beyond [`FARTHEST`]; without a number, usvg ends the path.
fn is_far(segment: std::result::Result<PathSegment, svgtypes::Error>) -> bool {
    use PathSegment::*;
    let largest = match segment {
        Err(_) | Ok(ClosePath { .. }) => 0.0,
        Ok(MoveTo { x, y, .. } | LineTo { x, y, .. } | SmoothQuadratic { x, y, .. }) => {
            x.abs().max(y.abs())
        }
        Ok(HorizontalLineTo { x: v, .. } | VerticalLineTo { y: v, .. }) => v.abs(),
        Ok(
            CurveTo { x1: a, y1: b, x, y, .. }
            | SmoothCurveTo { x2: a, y2: b, x, y, .. }
            | Quadratic { x1: a, y1: b, x, y, .. }
            | EllipticalArc { rx: a, ry: b, x, y, .. },
        ) => a.abs().max(b.abs()).max(x.abs()).max(y.abs()),
    };
    largest > FARTHEST
}

/// Returns warnings of elements that are not drawn, each kind once, with the first place.
fn passed_over(document: &roxmltree::Document<'_>) -> Vec<Warning> {
    let mut seen = BTreeSet::new();
    let mut warnings = Vec::new();
    for node in document.descendants().filter(roxmltree::Node::is_element) {
        let name = node.tag_name().name();
        if NOT_DRAWN.contains(&name) && seen.insert(name) {
            let at = document.text_pos_at(node.range().start);
            let place = Place::Line(at.row.into(), at.col.into());
            warnings.push(Warning { place, message: format!("`{name}` elements are ignored") });
        }
    }
    warnings
}
