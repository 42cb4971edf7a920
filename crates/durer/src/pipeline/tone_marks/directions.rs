//! In which direction the surface bends most, at each pixel.
//!
//! The differences of positions and normals between neighbours give the two fundamental forms of the surface, and these
//! the principal curvatures and their directions (M. do Carmo, *Differential Geometry of Curves and Surfaces*, 1976,
//! 3-3). Where the surface is flat, or curved equally in all directions, lines are in planes oblique to the eye. Both
//! kinds of directions are weighted and then averaged among neighbours on the same surface, so lines run smoothly over
//! facets. Each surface uses one of the two principal directions throughout ([`branches`]), mostly the one of stronger
//! curvature.

use super::bent::Bent;
use super::branches;
use super::seen::Seen;
use super::tensor::Tensor;
use crate::math::{DVec2, DVec3};

/// One of two directions at right angles on the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Across {
    /// The direction of the strongest curvature, as a rule.
    No,
    /// The direction at right angles to it.
    Yes,
}

/// A direction without sign on the screen, v·vᵀ: xx, xy, yy.
type OnScreen = [f32; 3];

/// The directions of a picture's pixels.
pub struct Directions {
    along: Vec<OnScreen>,
    across: Vec<OnScreen>,
}

/// Normal of the planes whose intersections with flat surfaces give lines their direction: right, down and back to
/// the eye. Lines on a plane that faces the eye rise to the right at 45°.
const SLANT: DVec3 = DVec3::new(1.0, 1.0, 0.4);

/// Weight of the slant where no curvature is clear.
const WEIGHT_OF_SLANT: f64 = 0.04;

/// Number of times that curvatures are smoothed, and the weight of neighbours: over some four pixels, so facets do not
/// show.
const CURVATURE: Evening = Evening { rounds: 12, neighbours: 4.0 };

/// The same for directions: over some eight pixels.
const DIRECTION: Evening = Evening { rounds: 40, neighbours: 8.0 };

struct Evening {
    rounds: usize,
    neighbours: f32,
}

impl Directions {
    /// Finds the directions; `height` is the field of view's, in model units.
    pub fn new(seen: &Seen, height: f64) -> Self {
        let sides: Vec<Option<Sides>> = seen.places().map(|at| Sides::at(seen, at)).collect();
        let curvature = sides.iter().map(|s| s.as_ref().map_or(Tensor::ZERO, Sides::curvature));
        let curvature = evened(seen, curvature.collect(), &CURVATURE);
        let bent = sides.iter().zip(&curvature);
        let bent = bent.map(|(s, c)| s.as_ref().map_or(Bent::NOT, |s| s.most_bent(c, height)));
        let bent: Vec<Bent> = bent.collect();
        let second = branches::second(seen, &bent);
        let direction = |i: usize, across: Across| -> Tensor {
            let (Some(sides), bent) = (&sides[i], &bent[i]) else { return Tensor::ZERO };
            let slanted = sides.normal.cross(SLANT).normalize_or_zero();
            let turned = if across == Across::Yes { sides.normal.cross(slanted) } else { slanted };
            let bent_way = bent.directions[usize::from(second[i] != (across == Across::Yes))];
            let unclear = 1.0 - bent.weight;
            Tensor::of(bent_way) * bent.weight
                + Tensor::of(turned) * (WEIGHT_OF_SLANT * unclear * unclear)
        };
        let [along, across] = [Across::No, Across::Yes].map(|across| {
            let own = (0..sides.len()).map(|i| direction(i, across)).collect();
            let evened = evened(seen, own, &DIRECTION);
            let shown = sides.iter().zip(evened);
            shown.map(|(s, t)| s.as_ref().map_or([0.0; 3], |s| s.on_screen(&t))).collect()
        });
        Self { along, across }
    }

    /// Returns the direction at a point, between the pixels around it that show one surface.
    pub fn at(&self, seen: &Seen, p: DVec2, across: Across) -> Option<DVec2> {
        let tensors = if across == Across::Yes { &self.across } else { &self.along };
        let own = (p.cmpge(DVec2::ZERO).all()).then_some((p.x as u32, p.y as u32))?;
        if !seen.pixel(own.0, own.1)?.is_seen() {
            return None;
        }
        let low = (p - 0.5).floor();
        let part = p - 0.5 - low;
        let mut sum = [0.0; 3];
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let (x, y) = (low.x as i64 + dx, low.y as i64 + dy);
            let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { continue };
            let Some(tensor) = seen.index(x, y).and_then(|i| tensors.get(i)) else { continue };
            if !seen.goes_on(own, (x, y)) {
                continue;
            }
            let share = |d: i64, part: f64| if d == 0 { 1.0 - part } else { part };
            let weight = share(dx, part.x) * share(dy, part.y);
            sum = std::array::from_fn(|k| sum[k] + weight * f64::from(tensor[k]));
        }
        main_direction(sum)
    }
}

/// Returns the direction of the larger eigenvalue.
fn main_direction([xx, xy, yy]: [f64; 3]) -> Option<DVec2> {
    let half = 0.5 * (xx - yy);
    let root = (half * half + xy * xy).sqrt();
    // The longer of two vectors along it.
    let v = if half >= 0.0 { DVec2::new(half + root, xy) } else { DVec2::new(xy, root - half) };
    v.try_normalize()
}

/// Replaces each tensor by one between its own value and those around it on the same surface, again and again.
fn evened(seen: &Seen, own: Vec<Tensor>, how: &Evening) -> Vec<Tensor> {
    let mut now = own.clone();
    let mut next = own.clone();
    for _ in 0..how.rounds {
        for (i, own) in own.iter().enumerate() {
            let (mut sum, mut weight) = (*own, 1.0);
            for other in seen.around_on_surface(i).map(|j| now[j]) {
                sum = sum.plus(other, how.neighbours);
                weight += how.neighbours;
            }
            next[i] = sum.plus(sum, 1.0 / weight - 1.0);
        }
        std::mem::swap(&mut now, &mut next);
    }
    now
}

/// The change of a surface from pixel to pixel.
struct Sides {
    /// The change of the place from a pixel to the one on its right, and to the one below.
    place: [DVec3; 2],
    /// The same for the normal.
    turn: [DVec3; 2],
    normal: DVec3,
    /// The dual basis: its products with the sides are 1 with the same one and 0 with the other.
    dual: [DVec3; 2],
}

impl Sides {
    fn at(seen: &Seen, (x, y): (u32, u32)) -> Option<Self> {
        let here = seen.pixel(x, y).filter(|p| p.is_seen())?;
        let right = difference(seen, (x, y), [(x.wrapping_sub(1), y), (x + 1, y)]);
        let below = difference(seen, (x, y), [(x, y.wrapping_sub(1)), (x, y + 1)]);
        let ([a, turn_a], [b, turn_b]) = (right?, below?);
        let (e, f, g) = (a.dot(a), a.dot(b), b.dot(b));
        let area = e * g - f * f;
        let dual = [(a * g - b * f) / area, (b * e - a * f) / area];
        let sides = Self { place: [a, b], turn: [turn_a, turn_b], normal: here.normal, dual };
        (area > 0.0 && dual.iter().all(|d| d.is_finite())).then_some(sides)
    }

    /// Returns the second fundamental form as a tensor in space.
    fn curvature(&self) -> Tensor {
        let ([a, b], [da, db], [ea, eb]) = (self.place, self.turn, self.dual);
        let mixed = -0.5 * (da.dot(b) + db.dot(a));
        Tensor::of(ea) * -da.dot(a) + Tensor::of(eb) * -db.dot(b) + Tensor::between(ea, eb) * mixed
    }

    /// Returns the principal directions of a curvature, and how clear they are.
    fn most_bent(&self, curvature: &Tensor, height: f64) -> Bent {
        let u = self.place[0].normalize_or_zero();
        let v = self.normal.cross(u).normalize_or_zero();
        let (uu, uv, vv) = (curvature.form(u, u), curvature.form(u, v), curvature.form(v, v));
        let (mean, half) = (0.5 * (uu + vv), 0.5 * (uu - vv));
        let root = (half * half + uv * uv).sqrt();
        let Some(high) = main_direction([uu, uv, vv]) else { return Bent::NOT };
        // Curvatures are mean ± root: the stronger one is on the side of the mean.
        let strong = if mean >= 0.0 { high } else { high.perp() };
        let strong = u * strong.x + v * strong.y;
        let below_one = |curvature: f64| curvature * height / (1.0 + curvature * height);
        let weight = below_one(2.0 * root);
        let lead = below_one((mean.abs() + root) - (mean.abs() - root).abs());
        if !(weight.is_finite() && lead.is_finite()) {
            return Bent::NOT;
        }
        Bent { directions: [strong, self.normal.cross(strong)], weight, lead }
    }

    /// Returns a tensor of directions as it is seen, with a trace of 1.
    fn on_screen(&self, tensor: &Tensor) -> OnScreen {
        let [a, b] = self.dual;
        let seen = [tensor.form(a, a), tensor.form(a, b), tensor.form(b, b)];
        let trace = seen[0] + seen[2];
        if trace > 0.0 { seen.map(|v| (v / trace) as f32) } else { [0.0; 3] }
    }
}

/// Returns the change of the place and of the normal per pixel, between the neighbours on the same surface.
fn difference(seen: &Seen, here: (u32, u32), around: [(u32, u32); 2]) -> Option<[DVec3; 2]> {
    let own = seen.pixel(here.0, here.1)?;
    let [before, after] =
        around.map(|at| seen.pixel(at.0, at.1).filter(|p| p.is_seen() && seen.goes_on(here, at)));
    let (from, to) = (before.unwrap_or(own), after.unwrap_or(own));
    let steps = f64::from(u8::from(before.is_some()) + u8::from(after.is_some()));
    (steps > 0.0).then(|| [(to.place - from.place) / steps, (to.normal - from.normal) / steps])
}
