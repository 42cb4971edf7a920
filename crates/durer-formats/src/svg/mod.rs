//! Drawings in SVG, onto a canvas.
//!
//! usvg resolves styles, units, references and text; what is left — paths with fills and strokes, groups
//! with clip paths, masks and opacity, images — is painted by [`durer::raster::paint`]. Not painted are
//! filters, blend modes, and what moves or runs; [`Drawing::read`] and [`Drawing::draw`] say so in
//! warnings.
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

mod arcs;
mod draw;
mod fonts;
mod image;
mod paint;
mod references;
mod values;

pub use fonts::{Fonts, no_glyphs};

use crate::uri::path;
use crate::{Error, Found, Limits, NoResources, Place, Resources, Result, Warning};
use durer::math::{DAffine2, DVec2};
use durer::raster::paint::Canvas;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use svgtypes::{PathParser, PathSegment};
use usvg::{ImageHrefResolver, ImageKind, roxmltree};

/// Elements that are passed over, beside those that only describe.
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

/// How a drawing is read.
#[derive(Clone, Copy)]
pub struct ReadOptions<'a> {
    /// The fonts for text; without any, text is left out.
    pub fonts: &'a Fonts,
    /// Finds images that are not part of the file.
    pub resources: &'a (dyn Resources + Sync),
    /// What is refused: sizes of images, and of all images together.
    pub limits: Limits,
}

impl Default for ReadOptions<'_> {
    /// No fonts, no resources, the default limits.
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
}

impl Drawing {
    /// Reads an SVG document.
    ///
    /// # Errors
    /// [`Error::Decode`] with line and column for what is not XML, and where there is no `svg` element
    /// with a size, or coordinates that overflow. Of the last usvg panics; that is caught here, but the panic hook
    /// is called.
    pub fn read(bytes: &[u8], options: &ReadOptions<'_>) -> Result<Self> {
        let bytes = crate::text::utf8(bytes);
        let text = std::str::from_utf8(&bytes).map_err(|e| {
            Error::byte(e.valid_up_to() as u64, "an SVG must be text in UTF-8 or UTF-16")
        })?;
        let document = parse(text).map_err(not_xml)?;
        let root = document.root_element().tag_name();
        if root != ROOT.into() {
            let name = root.name();
            let message = format!("the root is `{name}`, not `svg` with xmlns=\"{}\"", ROOT.0);
            return Err(Error::line(1, 0, message));
        }
        check_arcs(&document)?;
        let mut levels = references::check(&document, 0)?;
        let mut warnings = passed_over(&document);
        let mut found = values::Found::new(&document);
        warnings.append(&mut found.warnings);
        let amended = found.amended(text);
        let amended = amended.as_deref().and_then(|text| parse(text).ok());
        // What cannot be used may have hidden what is inherited.
        if let Some(amended) = &amended {
            levels = levels.max(references::check(amended, 0)?);
        }
        let (tree, told) = {
            let told = Told { levels: levels.into(), ..Told::default() };
            let usvg_options = usvg::Options {
                font_family: options.fonts.default_family(),
                fontdb: options.fonts.database(),
                font_resolver: fonts::resolver(&told),
                image_href_resolver: images(options, &told),
                ..usvg::Options::default()
            };
            let document = amended.as_ref().unwrap_or(&document);
            let tree = resolved(|| usvg::Tree::from_xmltree(document, &usvg_options))?;
            drop(usvg_options);
            (tree, told.take())
        };
        if options.fonts.is_empty() && document.descendants().any(|n| n.has_tag_name(TEXT)) {
            warnings.push(warning("text is left out: there are no fonts"));
        }
        warnings.extend(told.into_iter().map(warning));
        warnings.extend(fonts::missing_letters(&tree).map(warning));
        let at = document.text_pos_at(document.root_element().range().start);
        let place = Place::Line(at.row.into(), at.col.into());
        Ok(Self { tree, place, limits: options.limits, warnings })
    }

    /// Where in the document the `svg` element stands that gives the drawing its size.
    pub fn place(&self) -> &Place {
        &self.place
    }

    /// Width and height in the drawing's own units, above 0.
    pub fn size(&self) -> DVec2 {
        let size = self.tree.size();
        DVec2::new(f64::from(size.width()), f64::from(size.height()))
    }

    /// What was left out or replaced while reading.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Paints the drawing; `pixel_from_drawing` maps the drawing's units, y down, to pixels. Gives what
    /// cannot be drawn, each kind once. Cost: that of the canvas, and of its own for each tile of a
    /// pattern and each image.
    pub fn draw(&self, canvas: &mut Canvas, pixel_from_drawing: DAffine2) -> Vec<Warning> {
        let mut painter = draw::Painter::new(canvas, &self.limits);
        painter.tree(&self.tree, pixel_from_drawing);
        painter.warnings().into_iter().map(warning).collect()
    }
}

const ROOT: (&str, &str) = ("http://www.w3.org/2000/svg", "svg");
const TEXT: (&str, &str) = (ROOT.0, "text");

fn warning(message: impl Into<String>) -> Warning {
    Warning { place: Place::Whole, message: message.into() }
}

/// Messages from within usvg, each once, and how many levels of elements it may be in by recursion.
#[derive(Debug, Default)]
struct Told {
    messages: std::sync::Mutex<BTreeSet<String>>,
    levels: AtomicUsize,
}

impl Told {
    fn tell(&self, message: String) {
        // A poisoned lock still holds the messages.
        self.messages.lock().unwrap_or_else(|e| e.into_inner()).insert(message);
    }

    fn take(self) -> BTreeSet<String> {
        self.messages.into_inner().unwrap_or_else(|e| e.into_inner())
    }
}

fn parse(text: &str) -> std::result::Result<roxmltree::Document<'_>, roxmltree::Error> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    roxmltree::Document::parse_with_options(text, options)
}

fn not_xml(error: roxmltree::Error) -> Error {
    let at = error.pos();
    let text = error.to_string();
    // The message repeats the place at its end.
    let message = text.split(" at ").next().unwrap_or_default();
    Error::line(at.row.into(), at.col.into(), format!("not well-formed XML: {message}"))
}

/// What usvg makes of a document. Where numbers overflow on its way, as coordinates under a transform by 10²⁰ do, it may panic.
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
        usvg::Error::ParsingFailed(error) => not_xml(error),
        usvg::Error::InvalidSize => Error::whole(
            "the drawing has no size; `svg` needs a `viewBox`, or a `width` and `height` above 0",
        ),
        other => Error::whole(other.to_string()),
    }
}

/// Refuses arcs of paths with numbers beyond this: an arc becomes the more curves the larger it is, and one of
/// 10³⁸ pixels millions, which take for ever.
const FARTHEST: f64 = 1e15;

/// Whether arcs can be read in a time that is in proportion to the document.
fn check_arcs(document: &roxmltree::Document<'_>) -> Result<()> {
    for path in document.descendants().filter_map(|node| node.attribute_node("d")) {
        // Arcs begin where a path has come to by then, wherever that is.
        if path.value().contains(['A', 'a']) && PathParser::from(path.value()).any(is_far) {
            let at = document.text_pos_at(path.range().start);
            let message = "a path with arcs reaches beyond ±10¹⁵, farther than arcs can be drawn";
            return Err(Error::line(at.row.into(), at.col.into(), message));
        }
    }
    Ok(())
}

/// Whether a number of a segment is beyond [`FARTHEST`]; where there is none, usvg ends the path.
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

/// Elements that are not drawn, each kind once, with the first place.
fn passed_over(document: &roxmltree::Document<'_>) -> Vec<Warning> {
    let mut seen = BTreeSet::new();
    let mut warnings = Vec::new();
    for node in document.descendants().filter(roxmltree::Node::is_element) {
        let name = node.tag_name().name();
        if NOT_DRAWN.contains(&name) && seen.insert(name) {
            let at = document.text_pos_at(node.range().start);
            let place = Place::Line(at.row.into(), at.col.into());
            warnings.push(Warning { place, message: format!("`{name}` elements are passed over") });
        }
    }
    warnings
}

/// Where images come from: the file itself, or what it refers to.
fn images<'a>(options: &ReadOptions<'a>, told: &'a Told) -> ImageHrefResolver<'a> {
    let (resources, limit) = (options.resources, options.limits.decoded_bytes);
    let default = ImageHrefResolver::default_data_resolver();
    ImageHrefResolver {
        resolve_data: Box::new(move |mime, bytes, usvg_options| match mime {
            "image/svg+xml" => nested(&bytes, usvg_options, told),
            "text/plain" => kind_of(bytes, usvg_options, told),
            _ => default(mime, bytes, usvg_options),
        }),
        resolve_string: Box::new(move |href, usvg_options| {
            let path = path(href).map_err(str::to_owned);
            match path.and_then(|path| resources.find(&path, limit)) {
                Ok(Found { bytes, note }) => {
                    if let Some(note) = note {
                        told.tell(format!("image `{href}`: {note}"));
                    }
                    kind_of(bytes.into(), usvg_options, told)
                }
                Err(why) => {
                    told.tell(format!("image `{href}` is left out: {why}"));
                    None
                }
            }
        }),
    }
}

fn kind_of(bytes: Arc<Vec<u8>>, options: &usvg::Options<'_>, told: &Told) -> Option<ImageKind> {
    match bytes.get(..4)? {
        b"\x89PNG" => Some(ImageKind::PNG(bytes)),
        [0xff, 0xd8, ..] => Some(ImageKind::JPEG(bytes)),
        b"GIF8" => Some(ImageKind::GIF(bytes)),
        b"RIFF" => Some(ImageKind::WEBP(bytes)),
        _ => nested(&bytes, options, told),
    }
}

/// A drawing that is an image of the drawing, looked at with the same care before usvg goes into it.
fn nested(bytes: &[u8], options: &usvg::Options<'_>, told: &Told) -> Option<ImageKind> {
    let document = parse(std::str::from_utf8(bytes).ok()?).ok()?;
    let around = told.levels.load(Ordering::Relaxed);
    let checked = check_arcs(&document)
        .and_then(|()| references::check(&document, around + references::IMAGE));
    match checked {
        Ok(levels) => told.levels.store(levels, Ordering::Relaxed),
        Err(why) => {
            told.tell(format!("an image that is a drawing is left out: {why}"));
            return None;
        }
    }
    let tree = resolved(|| usvg::Tree::from_data_nested(bytes, options));
    told.levels.store(around, Ordering::Relaxed);
    tree.ok().map(ImageKind::SVG)
}
