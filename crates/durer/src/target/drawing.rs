//! The exact result of a view: lines and regions in the plane of the picture, before pens, paper and
//! pixels.

use crate::math::{DVec2, Rect};

/// What a line of a drawing shows; layers, pens and line types follow it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LineClass {
    /// A silhouette or border with nothing behind it, where these are told apart.
    Contour,
    /// Where a face that looks to the eye meets one that looks away.
    Silhouette,
    /// Where two faces meet at an angle above the crease angle.
    Crease,
    /// The edge of one face only: the rim of an open shell.
    Border,
    /// An edge of three faces or more, or of two that run against each other.
    NonManifold,
    /// Where two materials meet.
    Material,
    /// Where two faces penetrate each other.
    Intersection,
    /// The outline of a cut by a section plane.
    Section,
    /// Where a curved face meets another smoothly, as a fillet a plane.
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
    /// Where a view is broken: what lies between two of them is left out.
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

    /// The name used on the command line, for layers and in GeoJSON.
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
    /// What it shows.
    pub class: LineClass,
    /// Its quantitative invisibility: how many surfaces lie in front of it. 0 is visible.
    pub invisibility: u32,
    /// At least two points, plane units; no two neighbours are equal.
    pub points: Vec<DVec2>,
    /// Whether the last point is joined to the first (which is not repeated).
    pub closed: bool,
}

impl Line {
    /// Whether nothing lies in front of it.
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

/// Of what a region is a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum RegionKind {
    /// A surface of the scene; lit by all lights, where shadows are asked for.
    Surface,
    /// A surface in the shadow of another.
    Shadow,
    /// The face that a section plane leaves in a closed body.
    Cap,
}

/// A part of the picture that shows one thing in one colour.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// What it is a part of.
    pub kind: RegionKind,
    /// Outer rings counter-clockwise (y up), holes clockwise, plane units, open (the first point is not
    /// repeated); filled by the non-zero rule.
    pub rings: Vec<Vec<DVec2>>,
    /// sRGB with straight alpha.
    pub color: [u8; 4],
    /// The face that it shows: the triangle's index in scene order; `None` where several are merged.
    pub item: Option<u32>,
    /// Of a cap, the instance that was cut, where that is known: parts are hatched in directions of their own.
    pub part: Option<u32>,
}

impl Region {
    /// Area in squared plane units: what lies in holes is not counted.
    pub fn area(&self) -> f64 {
        let ring = |points: &Vec<DVec2>| {
            let Some((&origin, rest)) = points.split_first() else { return 0.0 };
            rest.windows(2).map(|w| (w[0] - origin).perp_dot(w[1] - origin)).sum::<f64>() * 0.5
        };
        self.rings.iter().map(ring).sum()
    }
}

/// How a label stands to its point.
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
    /// Which share of its length the text has before the point.
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
    /// Where its base line stands, plane units.
    pub at: DVec2,
    /// What it says.
    pub text: String,
    /// Height of capital letters; millimetres on paper, whatever the scale.
    pub height: f64,
    /// How it stands to `at`.
    pub anchor: Anchor,
}

/// How many steps of [`Drawing::nearness`] there are.
pub const NEARNESS_STEPS: u8 = 4;

/// What a view shows, as geometry in the plane of the picture.
///
/// **Plane units**: model units on the plane through the camera's target, at right angles to the line
/// of sight; x to the right, y up, the origin at the target. For a parallel projection that is
/// ((p − target)·right, (p − target)·up); in perspective, points are projected on that plane.
///
/// Painted in this order: regions as listed, then hidden lines, visible lines, labels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drawing {
    /// What the view shows of the plane; `None` where nothing bounds it.
    pub window: Option<Rect>,
    /// Filled parts, in the order of painting.
    pub regions: Vec<Region>,
    /// Lines, in the order of drawing.
    pub lines: Vec<Line>,
    /// Text.
    pub labels: Vec<Label>,
    /// How the faces meet whose lines these are.
    pub edges: EdgeCount,
    /// For each line how near it is, in steps from 0, the nearest, below [`NEARNESS_STEPS`]; `None` for lines of
    /// which that is not told. Empty where it is told of none.
    pub nearness: Vec<Option<u8>>,
}

/// How the faces of a model meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EdgeCount {
    /// All edges.
    pub edges: u64,
    /// Those of one triangle only.
    pub borders: u64,
}

impl Drawing {
    /// The smallest rectangle around all regions, lines and labels' points; `None` where there are none.
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
