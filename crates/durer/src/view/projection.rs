//! Cameras chosen by name, by angles, and fitted to a scene.
//!
//! Azimuth turns the eye around the up axis, counter-clockwise seen from above, from the front;
//! elevation lifts it. `right` is azimuth 90°, so the eye is on the model's right as the viewer in
//! front sees it.
//!
//! | up axis | front: the eye is on | right | top |
//! |---|---|---|---|
//! | y | +z, looking down −z | +x | +y, −z is up in the picture |
//! | z | −y, looking along +y | +x | +z, +y is up in the picture |
//! | x | +z, looking down −z | −y | +x, −z is up in the picture |
//! | −y | +z, looking down −z | −x | −y, −z is up in the picture |
//! | −z | −y, looking along +y | −x | −z, +y is up in the picture |
//! | −x | +z, looking down −z | +y | −x, −z is up in the picture |

use crate::math::DVec3;
use crate::scene::{Aabb, BoundingSphere, Camera, Projection, Scene, UpAxis};
pub use crate::view::outermost::PIECE;
use crate::view::outermost::{Outermost, OutermostOfPieces};
use crate::{Error, Result};
use std::str::FromStr;

/// The usual views of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum NamedView {
    /// View from the front, the right and above, with all three axes equally foreshortened: azimuth 45°, elevation
    /// atan(1/√2) = 35.264…°.
    #[default]
    Iso,
    /// View from the front.
    Front,
    /// View from behind.
    Back,
    /// View from the model's left, as seen from the front.
    Left,
    /// View from the model's right.
    Right,
    /// View from above; the front is at the bottom of the picture.
    Top,
    /// View from below; the front is at the top of the picture.
    Bottom,
}

/// atan(1/√2) in degrees.
const ISOMETRIC_ELEVATION: f64 = 35.264_389_682_754_654;

impl NamedView {
    /// All named views.
    pub const ALL: &'static [Self] =
        &[Self::Iso, Self::Front, Self::Back, Self::Left, Self::Right, Self::Top, Self::Bottom];

    /// Returns the name used on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Iso => "iso",
            Self::Front => "front",
            Self::Back => "back",
            Self::Left => "left",
            Self::Right => "right",
            Self::Top => "top",
            Self::Bottom => "bottom",
        }
    }

    /// Returns azimuth and elevation in degrees.
    pub const fn angles(self) -> (f64, f64) {
        match self {
            Self::Iso => (45.0, ISOMETRIC_ELEVATION),
            Self::Front => (0.0, 0.0),
            Self::Back => (180.0, 0.0),
            Self::Left => (-90.0, 0.0),
            Self::Right => (90.0, 0.0),
            Self::Top => (0.0, 90.0),
            Self::Bottom => (0.0, -90.0),
        }
    }

    /// Returns the direction of this view.
    pub fn direction(self, up_axis: UpAxis) -> ViewDirection {
        let (azimuth, elevation) = self.angles();
        ViewDirection::turned(azimuth, elevation, up_axis)
    }
}

impl std::fmt::Display for NamedView {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for NamedView {
    type Err = Error;

    /// Parses the name of a view; also accepts `side` for `right`.
    fn from_str(s: &str) -> Result<Self> {
        let name = if s == "side" { "right" } else { s };
        Self::ALL.iter().copied().find(|v| v.name() == name).ok_or_else(|| {
            Error::parameter("view", s, "one of iso, front, back, left, right, top, bottom")
        })
    }
}

/// Direction in which a model is seen.
///
/// # Guarantees
/// Two unit vectors at right angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewDirection {
    to_eye: DVec3,
    up: DVec3,
}

impl ViewDirection {
    /// Creates a direction from azimuth and elevation in degrees, of any size.
    ///
    /// # Errors
    /// [`Error::Parameter`] for an angle that is not finite.
    pub fn from_angles(azimuth: f64, elevation: f64, up_axis: UpAxis) -> Result<Self> {
        for (name, angle) in [("azimuth", azimuth), ("elevation", elevation)] {
            if !angle.is_finite() {
                return Err(Error::parameter(name, angle, "a finite number of degrees"));
            }
        }
        Ok(Self::turned(azimuth, elevation, up_axis))
    }

    fn turned(azimuth: f64, elevation: f64, up_axis: UpAxis) -> Self {
        let (front, above) = (up_axis.front(), up_axis.up());
        let ((sa, ca), (se, ce)) = (sin_cos_degrees(azimuth), sin_cos_degrees(elevation));
        let level = front * ca + up_axis.right() * sa;
        // The up vector is the derivative of the eye's direction with elevation, so it exists in the top view, too.
        Self { to_eye: level * ce + above * se, up: above * ce - level * se }
    }

    /// Returns the unit vector from the model to the eye.
    pub fn to_eye(&self) -> DVec3 {
        self.to_eye
    }

    /// Returns the unit vector that points up in the picture, at a right angle to [`Self::to_eye`].
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Returns the unit vector to the right in the picture.
    pub fn right(&self) -> DVec3 {
        self.up.cross(self.to_eye)
    }
}

/// Returns the sine and cosine, exact for multiples of 90°, the same bits on every machine.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turned = degrees % 360.0;
    let quarters = (turned / 90.0).round();
    let rest = (turned - quarters * 90.0).to_radians();
    let (s, c) = (libm::sin(rest), libm::cos(rest));
    match (quarters as i64).rem_euclid(4) {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

/// Kind of projection, without the numbers that fitting determines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lens {
    /// Perspective projection.
    Perspective {
        /// Vertical angle of view in radians, between 0 and π.
        fov_y: f64,
    },
    /// Parallel projection.
    Orthographic,
}

/// Options for fitting a model into the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitOptions {
    /// Kind of projection.
    pub lens: Lens,
    /// Width / height of the picture.
    pub aspect: f64,
    /// Part of the picture's width and height that is left free at each border; 0 ≤ margin < 0.5.
    pub margin: f64,
}

impl Default for FitOptions {
    /// Returns the default: 30 degrees, a square picture, 4 % free at each border.
    fn default() -> Self {
        let lens = Lens::Perspective { fov_y: std::f64::consts::PI / 6.0 };
        Self { lens, aspect: 1.0, margin: 0.04 }
    }
}

/// Smallest distance between the eye and the nearest point of the model, as a part of the model's radius: a needle that
/// points at the eye is seen from inside it.
pub const CLOSEST: f64 = 0.02;

/// Distance of the near and the far plane from the model, as a part of its radius.
const DEPTH_PAD: f64 = 0.01;

/// Returns the camera that shows the box in the middle of the picture, as large as possible.
///
/// The box's own corners are projected: they touch at least two opposite borders of the frame (the picture without its
/// margin), unless the nearest corner would be nearer than [`CLOSEST`]. `None` (an empty scene), a point and a line are
/// visible, too: a box without extent is taken for a cube of side 1, or larger where coordinates have too few digits to
/// resolve that.
///
/// # Errors
/// [`Error::Parameter`] for an option out of range or bounds that are not finite.
pub fn fit_box(
    bounds: Option<&Aabb>,
    direction: &ViewDirection,
    options: &FitOptions,
) -> Result<Camera> {
    let extent = visible_extent(bounds);
    fit(&extent.corners(), &extent, direction, options)
}

/// Returns the camera that shows the points in the middle of the picture, as large as possible: tighter than
/// [`fit_box`] if a model does not fill its box. Points that are not finite are left out.
///
/// Makes one pass, and keeps only the points that may touch a side of the frame.
///
/// # Errors
/// As [`fit_box`].
pub fn fit_points(
    points: impl IntoIterator<Item = DVec3>,
    direction: &ViewDirection,
    options: &FitOptions,
) -> Result<Camera> {
    let mut outermost = Frame::new(options)?.outermost(direction);
    outermost.add_points(points);
    fit_outermost(&outermost, direction, options)
}

/// Fits the camera, like [`fit_points`], to all vertices that a primitive of a scene uses; faster than passing them one
/// by one.
///
/// # Errors
/// As [`fit_box`].
pub fn fit_scene(scene: &Scene, direction: &ViewDirection, options: &FitOptions) -> Result<Camera> {
    let mut outermost = Frame::new(options)?.outermost(direction);
    outermost.add_scene(scene);
    fit_outermost(&outermost, direction, options)
}

/// Returns the box around all finite vertices that a primitive of a scene uses, in world space; `None` if there are
/// none.
///
/// Cost: O(vertices), a few operations each.
pub fn drawn_bounds(scene: &Scene) -> Option<Aabb> {
    let mut outermost = Outermost::new([]);
    outermost.add_scene(scene);
    outermost.bounds()
}

/// Returns the two finite vertices that are furthest along a direction and against it, among those that a primitive of
/// a scene uses, in world space; `None` if there are none.
///
/// Cost: O(vertices), a few operations each.
pub fn drawn_ends(scene: &Scene, direction: DVec3) -> Option<[DVec3; 2]> {
    let mut outermost = Outermost::new([direction, -direction]);
    outermost.add_scene(scene);
    outermost.bounds().map(|_| outermost.points())
}

/// Fit of a camera to a scene of one instance that comes in pieces, with the same result as [`fit_scene`], bit for bit.
///
/// All pieces but the last have a multiple of [`PIECE`] vertices, in the order of the whole. Vertices that no primitive
/// uses are not finite or have no index.
pub struct FitPieces {
    direction: ViewDirection,
    options: FitOptions,
    outermost: OutermostOfPieces<10>,
}

impl FitPieces {
    /// Creates a fit without pieces.
    ///
    /// # Errors
    /// [`Error::Parameter`] for an option out of range.
    pub fn new(direction: &ViewDirection, options: &FitOptions) -> Result<Self> {
        let directions = Frame::new(options)?.outermost_directions(direction);
        let outermost = OutermostOfPieces::new(directions);
        Ok(Self { direction: *direction, options: *options, outermost })
    }

    /// Adds the next piece.
    pub fn add(&mut self, piece: &Scene) {
        self.outermost.add_piece(piece);
    }

    /// Returns the camera that sees all pieces.
    ///
    /// # Errors
    /// As [`fit_scene`].
    pub fn camera(&self) -> Result<Camera> {
        fit_outermost(&self.outermost.whole(), &self.direction, &self.options)
    }
}

/// The results of [`drawn_bounds`] and [`drawn_ends`] for a scene that comes in pieces, as for [`FitPieces`].
pub struct EndsOfPieces {
    outermost: OutermostOfPieces<2>,
}

impl EndsOfPieces {
    /// Creates the ends, without pieces, along a direction and against it.
    pub fn new(direction: DVec3) -> Self {
        Self { outermost: OutermostOfPieces::new([direction, -direction]) }
    }

    /// Adds the next piece.
    pub fn add(&mut self, piece: &Scene) {
        self.outermost.add_piece(piece);
    }

    /// Returns the box that [`drawn_bounds`] returns.
    pub fn bounds(&self) -> Option<Aabb> {
        self.outermost.whole().bounds()
    }

    /// Returns the points that [`drawn_ends`] returns.
    pub fn ends(&self) -> Option<[DVec3; 2]> {
        let whole = self.outermost.whole();
        whole.bounds().map(|_| whole.points())
    }
}

fn fit_outermost(
    outermost: &Outermost<10>,
    direction: &ViewDirection,
    options: &FitOptions,
) -> Result<Camera> {
    let bounds = outermost.bounds();
    let extent = visible_extent(bounds.as_ref());
    if bounds == Some(extent) {
        fit(&outermost.points(), &extent, direction, options)
    } else {
        fit(&extent.corners(), &extent, direction, options)
    }
}

fn fit(
    points: &[DVec3],
    bounds: &Aabb,
    direction: &ViewDirection,
    options: &FitOptions,
) -> Result<Camera> {
    let center = bounds.center();
    let radius = (bounds.size() * 0.5).length();
    let axes = [direction.right(), direction.up(), direction.to_eye()];
    let view = |p: &DVec3| DVec3::from(axes.map(|a| a.dot(*p - center)));
    let corners: Vec<DVec3> = points.iter().map(view).collect();
    let frame = Frame::new(options)?;
    let eye = frame.eye_for(&corners, radius);
    let (back, front) = range(&corners, 2);
    let (nearest, farthest) = (eye.z - front, eye.z - back);
    let world = |v: DVec3| center + axes[0] * v.x + axes[1] * v.y + axes[2] * v.z;
    // A line seen end-on has no extent in the picture beyond rounding.
    let height = frame.height_for(&corners).max(radius * 1e-9);
    let target = DVec3::new(eye.x, eye.y, 0.0);
    finished(world(eye), world(target), direction, options, height, nearest..farthest, radius)
}

/// Returns the camera that shows the sphere in the middle of the picture: the frame is the same from all directions, as
/// for a turntable.
///
/// # Errors
/// [`Error::Parameter`] for an option out of range or a sphere that is not finite.
pub fn fit_sphere(
    bounds: Option<&BoundingSphere>,
    direction: &ViewDirection,
    options: &FitOptions,
) -> Result<Camera> {
    let frame = Frame::new(options)?;
    let center = bounds.map_or(DVec3::ZERO, |s| s.center);
    let radius = bounds.map_or(0.0, |s| s.radius);
    let radius = radius + smallest_extent(center, 2.0 * radius) * 0.5;
    // A cone of slope t touches a sphere of radius r from the distance r √(1 + t²) / t.
    let slope = frame.slope.x.min(frame.slope.y);
    let touching = match options.lens {
        Lens::Perspective { .. } => radius * (1.0 + slope * slope).sqrt() / slope,
        Lens::Orthographic => 2.0 * radius,
    };
    let distance = touching.max(radius * (1.0 + CLOSEST));
    let height = 2.0 * radius / slope;
    let eye = center + direction.to_eye() * distance;
    finished(eye, center, direction, options, height, distance - radius..distance + radius, radius)
}

fn finished(
    eye: DVec3,
    target: DVec3,
    direction: &ViewDirection,
    options: &FitOptions,
    height: f64,
    depths: std::ops::Range<f64>,
    radius: f64,
) -> Result<Camera> {
    let projection = match options.lens {
        Lens::Perspective { fov_y } => Projection::Perspective { fov_y },
        Lens::Orthographic => Projection::Orthographic { height },
    };
    let pad = DEPTH_PAD * radius;
    let (near, far) = (depths.start - pad, depths.end + pad);
    let camera = Camera { eye, target, up: direction.up(), projection, near, far };
    camera.check()?;
    Ok(camera)
}

/// Share of a place below which an extent there is lost to rounding: some thousand of the last digits of double precision.
const LOST: f64 = 1e-12;

/// Returns the amount to add to an extent so that it is visible: 0, unless the extent is 0 or lost to rounding at its
/// place.
fn smallest_extent(center: DVec3, size: f64) -> f64 {
    let place = center.abs().max_element();
    if size > place * LOST { 0.0 } else { (place * 1e-6).max(if size > 0.0 { 0.0 } else { 1.0 }) }
}

/// Returns the box itself, or a cube if it has no extent at all.
fn visible_extent(bounds: Option<&Aabb>) -> Aabb {
    let bounds = bounds.copied().unwrap_or(Aabb { min: DVec3::ZERO, max: DVec3::ZERO });
    let center = bounds.center();
    let half = DVec3::splat(smallest_extent(center, bounds.size().max_element()) * 0.5);
    Aabb { min: bounds.min - half, max: bounds.max + half }
}

/// Returns the smallest and the largest of one coordinate.
fn range(points: &[DVec3], k: usize) -> (f64, f64) {
    let grow = |(lo, hi): (f64, f64), p: &DVec3| (lo.min(p[k]), hi.max(p[k]));
    points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), grow)
}

/// The part of the picture that the model may fill.
struct Frame {
    lens: Lens,
    /// Perspective: half the frame's width and height at distance 1. Orthographic: half the frame's
    /// width and height where the whole picture's height is 2.
    slope: DVec3,
}

impl Frame {
    fn new(options: &FitOptions) -> Result<Self> {
        let FitOptions { lens, aspect, margin } = *options;
        if !(aspect > 0.0 && aspect.is_finite()) {
            return Err(Error::parameter("aspect", aspect, "finite and above 0"));
        }
        if !(0.0..0.5).contains(&margin) {
            return Err(Error::parameter("margin", margin, "at least 0 and below 0.5"));
        }
        let half_height = match lens {
            Lens::Perspective { fov_y } if !(fov_y > 0.0 && fov_y < std::f64::consts::PI) => {
                let degrees = fov_y.to_degrees();
                return Err(Error::parameter("fov", degrees, "between 0 and 180 degrees"));
            }
            Lens::Perspective { fov_y } => libm::tan(fov_y * 0.5),
            Lens::Orthographic => 1.0,
        };
        let free = 1.0 - 2.0 * margin;
        Ok(Self { lens, slope: DVec3::new(half_height * aspect, half_height, 0.0) * free })
    }

    /// Creates an empty search for the points that determine the fit from this direction.
    fn outermost(&self, direction: &ViewDirection) -> Outermost<10> {
        Outermost::new(self.outermost_directions(direction))
    }

    /// Returns the directions along the axes of the view, and towards the sides of the frame.
    fn outermost_directions(&self, direction: &ViewDirection) -> [DVec3; 10] {
        let (x, y, z) = (direction.right(), direction.up(), direction.to_eye());
        let (in_x, in_y) = (z * self.slope.x, z * self.slope.y);
        [x, -x, y, -y, z, -z, x + in_x, in_x - x, y + in_y, in_y - y]
    }

    /// Returns the position of the eye from which the points just fit into the frame; x right, y up, z towards the eye.
    fn eye_for(&self, points: &[DVec3], radius: f64) -> DVec3 {
        let largest =
            |f: &dyn Fn(&DVec3) -> f64| points.iter().map(f).fold(f64::NEG_INFINITY, f64::max);
        let closest = largest(&|p| p.z) + CLOSEST * radius;
        match self.lens {
            Lens::Orthographic => {
                let middle = |(lo, hi): (f64, f64)| (lo + hi) * 0.5;
                let [x, y] = [0, 1].map(|k| middle(range(points, k)));
                DVec3::new(x, y, closest + radius)
            }
            Lens::Perspective { .. } => {
                // On each axis two sides of the frame, each through its outermost point, meet in
                // the nearest eye that sees both.
                let [x, y] = [0, 1].map(|k| {
                    let s = self.slope[k];
                    let (a, b) = (largest(&|p| p[k] + s * p.z), largest(&|p| s * p.z - p[k]));
                    ((a - b) * 0.5, (a + b) * 0.5 / s)
                });
                DVec3::new(x.0, y.0, x.1.max(y.1).max(closest))
            }
        }
    }

    /// Returns the height of an orthographic picture into whose frame the points just fit.
    fn height_for(&self, points: &[DVec3]) -> f64 {
        let extent = |k: usize| {
            let (lo, hi) = range(points, k);
            hi - lo
        };
        (extent(0) / self.slope.x).max(extent(1) / self.slope.y)
    }
}
