//! The exact result of a view: lines and regions in the plane of the picture, without pens, paper and pixels.

use crate::math::{DVec2, Rect};

/// Class of a line, which determines its layer, pen and line type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LineClass {
    /// Silhouette or border with nothing behind it, if these are distinguished.
    Contour,
    /// Edge between a face that faces the eye and one that faces away.
    Silhouette,
    /// Edge between two faces at an angle above the crease angle.
    Crease,
    /// Edge of one face only: the rim of an open shell.
    Border,
    /// Edge of three faces or more, or of two with opposite orientations.
    NonManifold,
    /// Edge between two materials.
    Material,
    /// Intersection of two faces that penetrate each other.
    Intersection,
    /// Outline of a cut by a section plane.
    Section,
    /// Edge between a curved face and another that continues it smoothly, as between a fillet and a plane.
    Tangent,
    /// Any other edge of the mesh.
    Wire,
    /// Border between light and shadow.
    Shadow,
    /// Line of hatching.
    Hatch,
    /// Dot, drawn as a stroke much shorter than its pen is wide.
    Stipple,
    /// Line of a surface y = f(x, z) along which x or z is constant.
    Grid,
    /// Axis, its ticks, or a frame.
    Axis,
    /// Line or point of the model itself.
    Mark,
    /// End of a part of a broken view: the model between two such lines is left out.
    Break,
}

impl LineClass {
    /// Every class, in the order of listing; if lines of two classes coincide, the earlier class is preferred.
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

/// Chain of straight pieces of one class, all hidden by the same number of faces.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Class of the line.
    pub class: LineClass,
    /// Quantitative invisibility of the line: the number of surfaces in front of it. 0 is visible.
    pub invisibility: u32,
    /// Points, at least two, in plane units; no two neighbours are equal.
    pub points: Vec<DVec2>,
    /// True if the last point is joined to the first (which is not repeated).
    pub closed: bool,
}

impl Line {
    /// Returns whether nothing is in front of the line.
    pub const fn is_visible(&self) -> bool {
        self.invisibility == 0
    }

    /// Returns the length in plane units.
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
    /// Surface of the scene; lit by all lights, if shadows are requested.
    Surface,
    /// Surface in the shadow of another.
    Shadow,
    /// Cap: the face that closes a body cut by a section plane.
    Cap,
}

/// Part of the picture that shows one surface in one colour.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// Kind of the region's surface.
    pub kind: RegionKind,
    /// Rings, filled by the non-zero rule: outer rings counter-clockwise (y up), holes clockwise; plane units; open
    /// (the first point is not repeated).
    pub rings: Vec<Vec<DVec2>>,
    /// Colour: sRGB with straight alpha.
    pub color: [u8; 4],
    /// Face that the region shows: the triangle's index in scene order; `None` if several are merged.
    pub item: Option<u32>,
    /// Instance that was cut, for a cap, if it is known: each instance has its own direction of hatching.
    pub part: Option<u32>,
}

impl Region {
    /// Returns the area in squared plane units, without the holes.
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
pub enum TextAnchor {
    /// The text starts at the point.
    #[default]
    Start,
    /// The middle of the text is at the point.
    Middle,
    /// The text ends at the point.
    End,
}

impl TextAnchor {
    /// Returns the part of the text's length that is before the point.
    pub fn share(self) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::Middle => 0.5,
            Self::End => 1.0,
        }
    }
}

/// Line of text.
#[derive(Debug, Clone, PartialEq)]
pub struct TextLabel {
    /// Point of the base line, in plane units.
    pub at: DVec2,
    /// The text itself.
    pub text: String,
    /// Height of capital letters; millimetres on paper, whatever the scale.
    pub height: f64,
    /// Alignment with `at`.
    pub anchor: TextAnchor,
}

/// Number of steps of [`Drawing::nearness`].
pub const NEARNESS_STEPS: u8 = 4;

/// Content of a view, as geometry in the plane of the picture.
///
/// **Plane units** are model units on the plane through the camera's target, at right angles to the line of sight; x to
/// the right, y up, the origin at the target. In parallel projection they are ((p − target)·right, (p − target)·up); in
/// perspective, points are projected onto that plane.
///
/// Order of painting: regions as listed, then hidden lines, visible lines, labels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drawing {
    /// Window of the plane that the view shows; `None` if nothing bounds it.
    pub window: Option<Rect>,
    /// Filled parts, in the order of painting.
    pub regions: Vec<Region>,
    /// Lines, in the order of drawing.
    pub lines: Vec<Line>,
    /// Labels.
    pub labels: Vec<TextLabel>,
    /// Counts of the edges of the faces that the lines belong to.
    pub edges: EdgeCount,
    /// Nearness of each line, in steps from 0, the nearest, to below [`NEARNESS_STEPS`]; `None` for lines whose
    /// nearness is unknown. Empty if it is unknown for all.
    pub nearness: Vec<Option<u8>>,
}

/// Counts of a model's edges by the number of faces that meet there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EdgeCount {
    /// Number of edges.
    pub edges: u64,
    /// Number of edges of one triangle only.
    pub borders: u64,
}

impl Drawing {
    /// Returns the smallest rectangle around all regions, lines and points of labels; `None` if there are none.
    pub fn bounds(&self) -> Option<Rect> {
        let regions = self.regions.iter().flat_map(|r| r.rings.iter().flatten());
        let lines = self.lines.iter().flat_map(|l| &l.points);
        Rect::around(regions.chain(lines).copied().chain(self.labels.iter().map(|l| l.at)))
    }

    /// Returns the total length, in plane units, of the lines that `filter` accepts.
    pub fn length(&self, filter: impl Fn(&Line) -> bool) -> f64 {
        // The sum of no numbers is −0.
        self.lines.iter().filter(|l| filter(l)).map(Line::length).sum::<f64>() + 0.0
    }
}
