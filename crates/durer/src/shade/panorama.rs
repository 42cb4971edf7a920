//! A picture of a scene's surroundings, prepared for mirrors of any roughness and for matte surfaces.
//!
//! Light on matte surfaces: R. Ramamoorthi and P. Hanrahan, *An Efficient Representation for Irradiance
//! Environment Maps*, SIGGRAPH 2001, nine numbers per colour. Rough mirrors: B. Karis, *Real Shading in
//! Unreal Engine 4*, 2013: the panorama is blurred once for each of some roughnesses by the lobe of a
//! surface that is seen straight on, and the part between is interpolated. Cost: O(pixels) once, and
//! O(texels²) of 128 × 64 texels; memory: at most 2¹⁷ + 2¹⁴ texels of 12 bytes.

use super::lane::{Lane, Vec3Lane};
use crate::math::Vec3;
use crate::parallel;
use crate::{Error, Result};
use std::f64::consts::{PI, TAU};

/// A panorama. Its middle is straight ahead of an observer who faces the scene's front. Directions are along its
/// own axes: to the right, up and to the front.
#[derive(Debug, Clone, PartialEq)]
pub struct Panorama {
    /// Levels from the sharpest to the roughest.
    levels: Vec<Level>,
    /// Light on matte surfaces, by spherical harmonics with all constants in them.
    harmonics: [Vec3; 9],
}

/// The panorama as mirrors of one roughness show it.
#[derive(Debug, Clone, PartialEq)]
struct Level {
    /// Roughness, squared.
    alpha: f32,
    texels: Texels,
}

/// Colours by longitude, row by row from the zenith to the nadir.
#[derive(Debug, Clone, PartialEq)]
struct Texels {
    width: usize,
    height: usize,
    colors: Vec<Vec3>,
}

/// The sharpest level is at most this wide, and half as high.
const WIDEST: usize = 512;
/// Largest width of a picture that is blurred.
const SOURCE: usize = 128;
/// Roughness, squared, and width of the blurred levels.
const LEVELS: [(f32, usize); 5] = [(0.04, 128), (0.12, 64), (0.3, 32), (0.65, 32), (1.0, 32)];
/// Brighter counts as this bright, so that sums stay finite.
const BRIGHTEST: f32 = 1e9;

impl Panorama {
    /// Creates a panorama from a picture in equirectangular projection, linear colours, row by row from the zenith.
    /// Colours below 0 and NaN become 0.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a picture without pixels, or with another number than its size requires.
    pub fn new(width: u32, height: u32, pixels: &[[f32; 3]]) -> Result<Self> {
        let (width, height) = (width as usize, height as usize);
        if pixels.is_empty() || width.checked_mul(height) != Some(pixels.len()) {
            let value = format!("{} pixels of {width}x{height}", pixels.len());
            return Err(Error::parameter(
                "panorama",
                value,
                "as many as its size says, at least 1",
            ));
        }
        let color = |x: usize, y: usize| {
            Vec3::from_array(
                pixels[y * width + x]
                    .map(|channel| if channel > 0.0 { channel.min(BRIGHTEST) } else { 0.0 }),
            )
        };
        let sharp = Texels::shrunk([width, height], WIDEST, color);
        let source = Texels::shrunk([sharp.width, sharp.height], SOURCE, |x, y| sharp.color(x, y));
        let harmonics = harmonics(&source);
        let blurred =
            LEVELS.map(|(alpha, width)| Level { alpha, texels: source.blurred(alpha, width) });
        let mut levels = vec![Level { alpha: 0.0, texels: sharp }];
        levels.extend(blurred);
        Ok(Self { levels, harmonics })
    }

    /// Returns the light reflected by a matte white surface with unit normal `n`.
    #[inline(always)]
    pub(super) fn diffuse<L: Lane>(&self, n: Vec3Lane<L>) -> Vec3Lane<L> {
        n.x.apart(
            #[inline(always)]
            || self.matte(n),
        )
    }

    #[inline(always)]
    fn matte<L: Lane>(&self, n: Vec3Lane<L>) -> Vec3Lane<L> {
        let functions = functions(n);
        let mut sum = Vec3Lane::splat(n.x, Vec3::ZERO);
        for (function, color) in functions.into_iter().zip(self.harmonics) {
            sum = sum.plus(Vec3Lane::splat(n.x, color).scale(function));
        }
        Vec3Lane::new(sum.x.at_least(0.0), sum.y.at_least(0.0), sum.z.at_least(0.0))
    }

    /// Returns the reflection of a mirror of roughness √`alpha` in the unit direction `r`.
    #[inline(always)]
    pub(super) fn reflection<L: Lane>(&self, r: Vec3Lane<L>, alpha: L) -> Vec3Lane<L> {
        let at = [r.x, r.y, r.z, alpha];
        let [x, y, z] = L::looked_up(at, &|at| self.at(at).to_array());
        Vec3Lane::new(x, y, z)
    }

    /// Returns the colour in a direction along the axes, at a roughness, squared.
    fn at(&self, [x, y, z, alpha]: [f32; 4]) -> Vec3 {
        let u = libm::atan2f(x, -z) * (0.5 * std::f32::consts::FRAC_1_PI) + 0.5;
        let v = libm::acosf(y.clamp(-1.0, 1.0)) * std::f32::consts::FRAC_1_PI;
        let rougher = self.levels.iter().position(|level| level.alpha > alpha);
        let upper = rougher.unwrap_or(self.levels.len() - 1).max(1);
        let (a, b) = (&self.levels[upper - 1], &self.levels[upper]);
        let t = ((alpha - a.alpha) / (b.alpha - a.alpha)).clamp(0.0, 1.0);
        a.texels.sample(u, v).lerp(b.texels.sample(u, v), t)
    }
}

impl Texels {
    fn color(&self, x: usize, y: usize) -> Vec3 {
        self.colors[y * self.width + x]
    }

    /// Creates a picture of at most `widest` × `widest` / 2 texels, each the mean of the texels it covers.
    fn shrunk(
        [width, height]: [usize; 2],
        widest: usize,
        color: impl Fn(usize, usize) -> Vec3,
    ) -> Self {
        let (w, h) = (width.min(widest), height.min(widest / 2));
        let span = |i: usize, n: usize, of: usize| i * of / n..(i + 1) * of / n;
        let mut colors = Vec::with_capacity(w * h);
        for (x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (x, y))) {
            let (columns, rows) = (span(x, w, width), span(y, h, height));
            let count = columns.len() * rows.len();
            let covered = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
            colors.push(covered.map(|(x, y)| color(x, y)).sum::<Vec3>() / count as f32);
        }
        Self { width: w, height: h, colors }
    }

    /// Returns the picture as mirrors of roughness √`alpha` show it that are seen straight on.
    fn blurred(&self, alpha: f32, width: usize) -> Self {
        let height = width / 2;
        let source: Vec<(Vec3, f32, Vec3)> = (0..self.width * self.height)
            .map(|i| {
                let (x, y) = (i % self.width, i / self.width);
                (direction(x, y, self), solid_angle(y, self), self.colors[i])
            })
            .collect();
        let empty = Self { width, height, colors: Vec::new() };
        let row = |y: usize| -> Vec<Vec3> {
            (0..width).map(|x| lobe(direction(x, y, &empty), alpha, &source)).collect()
        };
        let colors = parallel::map((0..height).collect(), row).concat();
        Self { colors, ..empty }
    }

    /// Returns the colour at a place from (0, 0) to (1, 1), between four texels; columns go around.
    fn sample(&self, u: f32, v: f32) -> Vec3 {
        let (x, y) = (u * self.width as f32 - 0.5, v * self.height as f32 - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let column = |x: f32| (x as i64).rem_euclid(self.width as i64) as usize;
        let row = |y: f32| (y.max(0.0) as usize).min(self.height - 1);
        let at = |x: f32, y: f32| self.color(column(x), row(y));
        let upper = at(left, top).lerp(at(left + 1.0, top), x - left);
        let lower = at(left, top + 1.0).lerp(at(left + 1.0, top + 1.0), x - left);
        upper.lerp(lower, y - top)
    }
}

/// Returns the direction to the middle of a texel, along the panorama's axes.
fn direction(x: usize, y: usize, texels: &Texels) -> Vec3 {
    let longitude = ((x as f64 + 0.5) / texels.width as f64 - 0.5) * TAU;
    let polar = (y as f64 + 0.5) / texels.height as f64 * PI;
    let sine = libm::sin(polar);
    let (x, z) = (libm::sin(longitude) * sine, -libm::cos(longitude) * sine);
    Vec3::new(x as f32, libm::cos(polar) as f32, z as f32)
}

/// Returns the solid angle of a texel, up to a common factor.
fn solid_angle(y: usize, texels: &Texels) -> f32 {
    libm::sin((y as f64 + 0.5) / texels.height as f64 * PI) as f32
}

/// Returns the mean of directions, solid angles and colours around `r`, weighted by Trowbridge and
/// Reitz's lobe.
fn lobe(r: Vec3, alpha: f32, source: &[(Vec3, f32, Vec3)]) -> Vec3 {
    let alpha2 = alpha * alpha;
    let (mut sum, mut whole) = (Vec3::ZERO, 0.0);
    for (to, angle, color) in source {
        let cosine = r.dot(*to);
        if cosine <= 0.0 {
            continue;
        }
        let t = 1.0 - (cosine * 0.5 + 0.5) * (1.0 - alpha2);
        let weight = angle * cosine / (t * t);
        sum += *color * weight;
        whole += weight;
    }
    sum / whole.max(f32::MIN_POSITIVE)
}

/// Returns nine functions of a direction, of which light on matte surfaces is composed.
#[inline(always)]
fn functions<L: Lane>(Vec3Lane { x, y, z }: Vec3Lane<L>) -> [L; 9] {
    let one = x.splat(1.0);
    [one, x, y, z, x * y, y * z, x * z, z * z * 3.0 - 1.0, x * x - y * y]
}

/// Returns the factors of the [`functions`]: the panorama's share of each, by how much a matte surface
/// keeps of it.
fn harmonics(source: &Texels) -> [Vec3; 9] {
    /// Squares of the functions' constants, times the factors of a cosine lobe: 1, 2/3 and 1/4.
    const KEPT: [f64; 9] = {
        let (one, two) = (2.0 / 3.0 * 3.0, 0.25 * 15.0);
        [1.0, one, one, one, two, two, two, 0.25 * 1.25, 0.25 * 3.75]
    };
    let (mut sums, mut whole) = ([crate::math::DVec3::ZERO; 9], 0.0);
    for (i, color) in source.colors.iter().enumerate() {
        let (x, y) = (i % source.width, i / source.width);
        let angle = f64::from(solid_angle(y, source));
        let functions = functions(Vec3Lane::from(direction(x, y, source)));
        for (sum, function) in sums.iter_mut().zip(functions) {
            *sum += color.as_dvec3() * (angle * f64::from(function));
        }
        whole += angle;
    }
    let mut factors = sums.iter().zip(KEPT).map(|(sum, kept)| (*sum * (kept / whole)).as_vec3());
    std::array::from_fn(|_| factors.next().unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a panorama that shows a function of the direction.
    fn panorama(light: impl Fn(Vec3) -> Vec3) -> Panorama {
        let size = Texels { width: 64, height: 32, colors: Vec::new() };
        let places = (0..32).flat_map(|y| (0..64).map(move |x| (x, y)));
        let pixels: Vec<_> =
            places.map(|(x, y)| light(direction(x, y, &size)).to_array()).collect();
        Panorama::new(64, 32, &pixels).expect("panorama")
    }

    fn seen(p: &Panorama, r: Vec3, alpha: f32) -> Vec3 {
        p.reflection(r.normalize().into(), alpha).into()
    }

    fn matte(p: &Panorama, n: Vec3) -> Vec3 {
        p.diffuse(n.normalize().into()).into()
    }

    #[test]
    fn in_uniform_light_all_is_as_bright() {
        let p = panorama(|_| Vec3::new(2.0, 1.0, 0.5));
        for r in [Vec3::X, Vec3::Y, -Vec3::Z, Vec3::new(0.3, -0.8, 0.5)] {
            for alpha in [0.0, 0.02, 0.2, 0.9, 1.0] {
                assert!((seen(&p, r, alpha) - Vec3::new(2.0, 1.0, 0.5)).length() < 1e-4);
            }
            assert!((matte(&p, r) - Vec3::new(2.0, 1.0, 0.5)).length() < 2e-3);
        }
    }

    #[test]
    fn matte_surfaces_show_the_cosine_of_a_slope() {
        // Under light 1 + c·d a matte surface shows 1 + 2/3 c·n.
        let c = Vec3::new(0.3, 0.5, -0.4);
        let p = panorama(|d| Vec3::splat(1.0 + c.dot(d)));
        for n in [Vec3::X, -Vec3::Y, Vec3::Z, Vec3::new(0.3, -0.8, 0.5)] {
            let expected = 1.0 + c.dot(n.normalize()) * 2.0 / 3.0;
            assert!((matte(&p, n).x - expected).abs() < 5e-3, "{n}");
        }
        // The square of a cosine gives 1/3 + 1/4 · (n·d)² − 1/12.
        let p = panorama(|d| Vec3::splat(d.y * d.y));
        assert!((matte(&p, Vec3::Y).x - 0.5).abs() < 5e-3, "{}", matte(&p, Vec3::Y));
        assert!((matte(&p, Vec3::X).x - 0.25).abs() < 5e-3, "{}", matte(&p, Vec3::X));
    }

    #[test]
    fn mirrors_show_directions_and_grow_dull() {
        let lamp = Vec3::new(0.5, 0.5, 0.7).normalize();
        let p = panorama(|d| if d.dot(lamp) > 0.95 { Vec3::splat(10.0) } else { Vec3::ZERO });
        let at_lamp = [0.0, 0.04, 0.3, 1.0].map(|alpha| seen(&p, lamp, alpha).x);
        assert!(at_lamp[0] > 9.9 && at_lamp.is_sorted_by(|a, b| a > b), "{at_lamp:?}");
        assert_eq!(seen(&p, -lamp, 0.0), Vec3::ZERO);
        // The middle of the picture is straight ahead, its right half to the right.
        let quarters = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
        let p = Panorama::new(4, 1, &quarters).expect("panorama");
        assert!(seen(&p, Vec3::new(1.0, 0.0, -1.0), 0.0).z > 0.99);
        assert!(seen(&p, Vec3::new(-1.0, 0.0, -1.0), 0.0).y > 0.99);
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        assert!(Panorama::new(0, 0, &[]).is_err());
        assert!(Panorama::new(2, 2, &[[0.0; 3]; 3]).is_err());
        let odd = [[f32::NAN, -1.0, f32::INFINITY]];
        let p = Panorama::new(1, 1, &odd).expect("panorama");
        assert!(seen(&p, Vec3::X, 0.5).is_finite() && matte(&p, Vec3::X).is_finite());
    }
}
