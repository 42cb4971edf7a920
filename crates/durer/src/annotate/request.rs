//! The annotations that are requested.

use crate::math::DVec3;

/// Annotations of a drawing beside its lines.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Annotations {
    /// Centre lines and centre marks of round parts.
    pub center_lines: bool,
    /// The sizes of the whole, each once.
    pub sizes: bool,
    /// The diameters of holes, equal ones once.
    pub holes: bool,
    /// The diameters of other round parts.
    pub bosses: bool,
    /// Dimensions and notes one by one.
    pub dimensions: Vec<Request>,
    /// Threads.
    pub threads: Vec<Thread>,
}

impl Annotations {
    /// Returns whether no annotation is requested.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// A dimension or a note.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Subject of the request.
    pub what: What,
    /// The name of its view; `None` for the first that shows it.
    pub view: Option<String>,
    /// The side of the view; `None` for the first one with room.
    pub side: Option<ViewSide>,
    /// Text, with `<>` for the measured value; `None` for that value alone.
    pub text: Option<String>,
}

/// Subject of a request.
#[derive(Debug, Clone, PartialEq)]
pub enum What {
    /// The distance of two places.
    Linear {
        /// One end of the distance.
        from: FeaturePlace,
        /// The other end.
        to: FeaturePlace,
        /// Direction of the distance.
        along: Along,
    },
    /// The diameter of a feature by its name.
    Diameter(String),
    /// The radius of a feature by its name.
    Radius(String),
    /// The angle at a place between two others.
    Angle {
        /// The vertex of the angle.
        vertex: FeaturePlace,
        /// A place on the first side.
        from: FeaturePlace,
        /// A place on the second side.
        to: FeaturePlace,
    },
    /// Words for a place.
    Note(FeaturePlace),
}

/// Position of a feature or point.
#[derive(Debug, Clone, PartialEq)]
pub enum FeaturePlace {
    /// A point of the world.
    Point(DVec3),
    /// The axis of a feature by its name.
    Feature(String),
}

/// Direction in which a distance is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Along {
    /// The direction from one to the other; between axes, at right angles to them.
    #[default]
    Straight,
    /// The world's x axis.
    X,
    /// The world's y axis.
    Y,
    /// The world's z axis.
    Z,
}

impl Along {
    /// Returns its unit vector; `None` for a straight line.
    pub(crate) fn axis(self) -> Option<DVec3> {
        match self {
            Self::Straight => None,
            Self::X => Some(DVec3::X),
            Self::Y => Some(DVec3::Y),
            Self::Z => Some(DVec3::Z),
        }
    }
}

/// A side of a view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ViewSide {
    /// Over it.
    Above,
    /// Under it.
    Below,
    /// Left of it.
    Left,
    /// Right of it.
    Right,
}

/// A thread on the cylinders of an object.
#[derive(Debug, Clone, PartialEq)]
pub struct Thread {
    /// The name of the object, or of a feature.
    pub name: String,
    /// Its size, if it is known.
    pub size: Option<ThreadSize>,
}

/// The size of a metric thread.
#[derive(Debug, Clone, PartialEq)]
pub struct ThreadSize {
    /// The outer diameter of the screw, millimetres.
    pub major: f64,
    /// Distance from turn to turn, millimetres.
    pub pitch: f64,
    /// Name on drawings: `M8×1.25`.
    pub text: String,
}

/// Diameters and pitches of coarse metric threads (ISO 261), millimetres.
const COARSE: &[(f64, f64)] = &[
    (1.0, 0.25),
    (1.2, 0.25),
    (1.6, 0.35),
    (2.0, 0.4),
    (2.5, 0.45),
    (3.0, 0.5),
    (4.0, 0.7),
    (5.0, 0.8),
    (6.0, 1.0),
    (8.0, 1.25),
    (10.0, 1.5),
    (12.0, 1.75),
    (14.0, 2.0),
    (16.0, 2.0),
    (20.0, 2.5),
    (24.0, 3.0),
    (30.0, 3.5),
    (36.0, 4.0),
    (42.0, 4.5),
    (48.0, 5.0),
    (56.0, 5.5),
    (64.0, 6.0),
];

impl ThreadSize {
    /// Returns the core of the screw, millimetres: the basic minor diameter of ISO 68-1, D − 1.0825
    /// P.
    pub(crate) fn minor(&self) -> f64 {
        self.major - 1.082_53 * self.pitch
    }
}

impl std::str::FromStr for ThreadSize {
    type Err = crate::Error;

    /// Parses `M8x1.25`, or `M8` for the coarse pitch.
    fn from_str(text: &str) -> crate::Result<Self> {
        let wrong = || {
            let expected = "M and a diameter, for sizes that ISO 261 has no coarse pitch for with x and the pitch, \
                            e.g. M8 or M8x1.25";
            crate::Error::parameter("thread", text, expected)
        };
        let sizes = text.trim().strip_prefix(['M', 'm']).ok_or_else(wrong)?;
        let (major, pitch) = match sizes.split_once(['x', '×', 'X']) {
            Some((major, pitch)) => (major, Some(pitch)),
            None => (sizes, None),
        };
        let number = |s: &str| s.trim().parse().ok().filter(|v: &f64| *v > 0.0 && *v < 1e4);
        let major: f64 = number(major).ok_or_else(wrong)?;
        let coarse = || COARSE.iter().find(|c| c.0 == major).map(|c| c.1);
        let pitch = pitch.map_or_else(coarse, number).ok_or_else(wrong)?;
        if pitch >= 0.5 * major {
            return Err(wrong());
        }
        Ok(Self { major, pitch, text: format!("M{}", sizes.trim().replace(['x', 'X'], "×")) })
    }
}
