//! The description of an algorithm: its name, its publication, its cost. Each algorithm's file has
//! one record.

/// Space in which an algorithm decides visibility, after Sutherland, Sproull and Schumacker (1974).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Class {
    /// Object space: decisions with the geometry's own precision; the result does not depend on pixels.
    ObjectSpace,
    /// Image space: decisions per pixel or per scan line.
    ImageSpace,
    /// List priority: faces are ordered in object space and painted in image space.
    ListPriority,
}

impl Class {
    /// Every class, in the order of the paper.
    pub const ALL: &'static [Self] = &[Self::ObjectSpace, Self::ListPriority, Self::ImageSpace];

    /// Returns the name used on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ObjectSpace => "object",
            Self::ListPriority => "list-priority",
            Self::ImageSpace => "image",
        }
    }
}

/// Part of a surface that is tested for whether it hides others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Occluder {
    /// Nothing: the algorithm decides no visibility.
    None,
    /// Single points: pixels, samples, rays.
    Point,
    /// Lines: the spans of a scan line, the horizon of a plot.
    Line,
    /// Areas: whole faces, or windows of the picture.
    Area,
}

impl Occluder {
    /// Every kind, the smallest first.
    pub const ALL: &'static [Self] = &[Self::None, Self::Point, Self::Line, Self::Area];

    /// Returns the name used on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Point => "point",
            Self::Line => "line",
            Self::Area => "area",
        }
    }
}

/// A likeness of neighbours that an algorithm saves work by, after Sutherland, Sproull and Schumacker (1974).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Coherence {
    /// Whole objects are apart from each other, so they are compared before their faces.
    Object,
    /// A value changes smoothly over a face, or is one for all of it.
    Face,
    /// The next point of an edge follows from the last; its visibility changes only at crossings.
    Edge,
    /// A row of pixels has nearly the edges of the row before.
    ScanLine,
    /// Neighbours within a row of pixels are alike.
    Span,
    /// Neighbours within an area of the picture are alike.
    Area,
    /// Neighbouring points of a surface have almost the same depth, so the next depth follows from the last.
    Depth,
    /// The next picture is nearly this one.
    Frame,
}

impl Coherence {
    /// Every kind, from the model to the sequence of pictures.
    pub const ALL: &'static [Self] = &[
        Self::Object,
        Self::Face,
        Self::Edge,
        Self::ScanLine,
        Self::Span,
        Self::Area,
        Self::Depth,
        Self::Frame,
    ];

    /// Returns the name used on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Object => "object",
            Self::Face => "face",
            Self::Edge => "edge",
            Self::ScanLine => "scan-line",
            Self::Span => "span",
            Self::Area => "area",
            Self::Depth => "depth",
            Self::Frame => "frame",
        }
    }
}

/// The facts of one published algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Info {
    /// The name used on the command line, e.g. `"cohen-sutherland"`.
    pub name: &'static str,
    /// The name used in prose, e.g. `"Cohen–Sutherland"`.
    pub title: &'static str,
    /// The authors, in the order of the paper.
    pub authors: &'static str,
    /// Year of publication.
    pub year: u16,
    /// Publication.
    pub source: &'static str,
    /// Space in which it decides.
    pub class: Class,
    /// Part of a surface that is compared with others to find hidden parts.
    pub occluder: Occluder,
    /// Kinds of coherence that save work; none if every element is treated alone.
    pub coherence: &'static [Coherence],
    /// The algorithm in 8 to 20 lines, written from the publication; a step's line counts from 1. Empty if it has no
    /// lesson.
    pub pseudocode: &'static [&'static str],
    /// Time and memory, in the usual O-notation, with its letters explained.
    pub cost: &'static str,
    /// Limits, and requirements on the input.
    pub limits: &'static str,
}

/// Declares the closed set of the algorithms of one family as an enum with `ALL`, `name`, `info`,
/// `Display` and `FromStr`; everything that lists algorithms reads `ALL`.
#[macro_export]
#[doc(hidden)]
macro_rules! family {
    ($(#[$meta:meta])* $vis:vis enum $name:ident { $($(#[$vmeta:meta])* $variant:ident => $info:expr),+ $(,)? }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        $vis enum $name { $($(#[$vmeta])* $variant),+ }

        impl $name {
            /// Every member of the family, in the order of the documentation.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Returns the facts of this algorithm.
            pub const fn info(self) -> &'static $crate::info::Info {
                match self { $(Self::$variant => &$info),+ }
            }

            /// Returns the name used on the command line.
            pub const fn name(self) -> &'static str {
                self.info().name
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl std::str::FromStr for $name {
            type Err = $crate::Error;

            fn from_str(s: &str) -> $crate::Result<Self> {
                Self::ALL.iter().copied().find(|a| a.name() == s).ok_or_else(|| {
                    $crate::Error::parameter(
                        "algorithm",
                        s,
                        concat!("one of the names in ", stringify!($name), "::ALL"),
                    )
                })
            }
        }
    };
}
pub use family;
