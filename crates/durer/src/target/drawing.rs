//! The exact result of a view: lines and regions in the plane of the picture, before pens, paper and
//! pixels.

use crate::math::{DVec2, Rect};

/// Class of a drawing's line; layers, pens and line types follow it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LineClass {
    /// A silhouette or border with nothing behind it, if these are distinguished.
    Contour,
    /// Edge between a face that looks to the eye and one that looks away.
    Silhouette,
    /// Edge between two faces at an angle above the crease angle.
    Crease,
    /// The edge of one face only: the rim of an open shell.
    Border,
    /// An edge of three faces or more, or of two that run against each other.
    NonManifold,
    /// Edge between two materials.
    Material,
    /// Intersection of two faces that penetrate each other.
    Intersection,
    /// The outline of a cut by a section plane.
    Section,
    /// Edge between a curved face and another that it meets smoothly, as a fillet meets a plane.
    Tangent,
    /// Any other edge of the mesh.
    Wire,
    /// The border between light and shadow.
    Shadow,
    /// A line of hatching.
    Hatch,
    /// A dot, drawn as a stroke much shorter than its pen is wide.
    Stipple,
    /// A line of a surface y = f(x, z) along which x or z is constant.
    Grid,
    /// An axis, its ticks, or a frame.
    Axis,
    /// A line or a point that the model itself has.
    Mark,
    /// End of a view's part where the view is broken: the model between two of them is left out.
    Break,
}

impl LineClass {
    /// Every class, in the order in which they are listed and, where two lie on each other, preferred.
    pub const ALL: &'static [Self] = &[
        Self::Contour,
        Self::Silhouette,
        Self::Crease,
        Self::Border,
        Self::NonManifold,
        Self::Material,
        Self::Intersection,
        Self::Section,
        Self::Tangent,
        Self::Wire,
        Self::Shadow,
        Self::Hatch,
        Self::Stipple,
        Self::Grid,
        Self::Axis,
        Self::Mark,
        Self::Break,
    ];

    /// Returns the name used on the command line, for layers and in GeoJSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Contour => "contour",
            Self::Silhouette => "silhouette",
            Self::Crease => "crease",
            Self::Border => "border",
            Self::NonManifold => "non-manifold",
            Self::Material => "material",
            Self::Intersection => "intersection",
            Self::Section => "section",
            Self::Tangent => "tangent",
            Self::Wire => "wire",
            Self::Shadow => "shadow",
            Self::Hatch => "hatch",
            Self::Stipple => "stipple",
            Self::Grid => "grid",
            Self::Axis => "axis",
            Self::Mark => "mark",
            Self::Break => "break",
        }
    }
}

impl std::fmt::Display for LineClass {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for LineClass {
    type Err = crate::Error;

    fn from_str(s: &str) -> crate::Result<Self> {
        let found = Self::ALL.iter().copied().find(|c| c.name() == s);
        found.ok_or_else(|| {
            crate::Error::parameter("line class", s, "one of the names in LineClass::ALL")
        })
    }
}

/// A chain of straight pieces of one class, all hidden by the same number of faces.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Style of the drawing.
    pub class: LineClass,
    /// Its quantitative invisibility: how many surfaces lie in front of it. 0 is visible.
    pub invisibility: u32,
    /// At least two points, plane units; no two neighbours are equal.
    pub points: Vec<DVec2>,
    /// True if the last point is joined to the first (which is not repeated).
    pub closed: bool,
}

impl Line {
    /// Returns whether nothing lies in front of it.
    pub const fn is_visible(&self) -> bool {
        self.invisibility == 0
    }

    /// Length in plane units.
    pub fn length(&self) -> f64 {
        let open: f64 = self.points.windows(2).map(|w| w[0].distance(w[1])).sum();
        match (self.closed, self.points.first(), self.points.last()) {
            (true, Some(&first), Some(&last)) => open + first.distance(last),
            _ => open,
        }
    }
}

/// Kind of the surface that a region is a part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum RegionKind {
    /// A surface of the scene; lit by all lights, where shadows are requested.
    Surface,
    /// A surface in the shadow of another.
    Shadow,
    /// The face that a section plane leaves in a closed body.
    Cap,
}

/// A part of the picture that shows one thing in one colour.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// Kind of the surface that it is a part of.
    pub kind: RegionKind,
    /// Outer rings counter-clockwise (y up), holes clockwise, plane units, open (the first point is not
    /// repeated); filled by the non-zero rule.
    pub rings: Vec<Vec<DVec2>>,
    /// sRGB with straight alpha.
    pub color: [u8; 4],
    /// The face that it shows: the triangle's index in scene order; `None` if several are merged.
    pub item: Option<u32>,
    /// Instance that was cut, for a cap, if it is known: parts are hatched in directions of their own.
    pub part: Option<u32>,
}

impl Region {
    /// Returns the area in squared plane units: what is in holes is not counted.
    pub fn area(&self) -> f64 {
        let ring = |points: &Vec<DVec2>| {
            let Some((&origin, rest)) = points.split_first() else { return 0.0 };
            rest.windows(2).map(|w| (w[0] - origin).perp_dot(w[1] - origin)).sum::<f64>() * 0.5
        };
        self.rings.iter().map(ring).sum()
    }
}

/// Alignment of a label with its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Anchor {
    /// The text starts at the point.
    #[default]
    Start,
    /// Its middle is at the point.
    Middle,
    /// It ends at the point.
    End,
}

impl Anchor {
    /// Returns the share of the text's length before the point.
    pub fn share(self) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::Middle => 0.5,
            Self::End => 1.0,
        }
    }
}

/// A line of text.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Position of its base line, in plane units.
    pub at: DVec2,
    /// Subject of the text.
    pub text: String,
    /// Height of capital letters; millimetres on paper, whatever the scale.
    pub height: f64,
    /// Alignment with `at`.
    pub anchor: Anchor,
}

/// Number of steps of [`Drawing::nearness`].
pub const NEARNESS_STEPS: u8 = 4;

/// Content of a view, as geometry in the plane of the picture.
///
/// **Plane units**: model units on the plane through the camera's target, at right angles to the line
/// of sight; x to the right, y up, the origin at the target. For a parallel projection that is
/// ((p − target)·right, (p − target)·up); in perspective, points are projected on that plane.
///
/// Painted in this order: regions as listed, then hidden lines, visible lines, labels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drawing {
    /// Window of the plane that the view shows; `None` if nothing bounds it.
    pub window: Option<Rect>,
    /// Filled parts, in the order of painting.
    pub regions: Vec<Region>,
    /// Lines, in the order of drawing.
    pub lines: Vec<Line>,
    /// Text.
    pub labels: Vec<Label>,
    /// Counts of the edges between the faces that the lines belong to.
    pub edges: EdgeCount,
    /// For each line how near it is, in steps from 0, the nearest, below [`NEARNESS_STEPS`]; `None` for lines of
    /// which that is unknown. Empty if it is unknown for all.
    pub nearness: Vec<Option<u8>>,
}

/// Counts of a model's edges by the number of faces that meet there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EdgeCount {
    /// All edges.
    pub edges: u64,
    /// Those of one triangle only.
    pub borders: u64,
}

impl Drawing {
    /// Returns the smallest rectangle around all regions, lines and labels' points; `None` if there
    /// are none.
    pub fn bounds(&self) -> Option<Rect> {
        let regions = self.regions.iter().flat_map(|r| r.rings.iter().flatten());
        let lines = self.lines.iter().flat_map(|l| &l.points);
        Rect::around(regions.chain(lines).copied().chain(self.labels.iter().map(|l| l.at)))
    }

    /// Total length of the lines that `filter` lets through, plane units.
    pub fn length(&self, filter: impl Fn(&Line) -> bool) -> f64 {
        // The sum of no numbers is −0.
        self.lines.iter().filter(|l| filter(l)).map(Line::length).sum::<f64>() + 0.0
    }
}
