//! Gaussian splats, drawn as discs.
//!
//! Source: B. Kerbl, G. Kopanas, T. Leimkühler, G. Drettakis, *3D Gaussian Splatting for Real-Time Radiance Field
//! Rendering*, ACM Transactions on Graphics 42 (4), 2023, whose program writes these files. A splat is a normal
//! distribution with three radii; here it is a hexagon in the plane of the two larger radii, or an octahedron if the
//! third is not much smaller, in its base colour, without the parts that depend on the viewing direction.

use super::vertices::{Shape, Vertices};
use crate::facets::{Attributes, whole};
use crate::text::Tally;
use crate::{Error, Limits, Model, Place, Result};
use durer::math::{Vec3, Vec4};
use durer::scene::{Material, Mesh, ShadingModel};

/// A disc's radius in standard deviations: neighbours form a closed surface, and edges keep their places.
const RADIUS: f32 = 1.5;
/// Smallest opacity of drawn splats; more transparent ones are mist around the objects.
const OPACITY: f32 = 0.3;
/// A splat is round where the logarithms of its radii differ by less: by less than a half.
const ROUND: f32 = 0.7;
/// Half the root of 3.
const HEIGHT: f32 = 0.866_025_4;
/// Corners of a hexagon of radius 1.
const HEXAGON: [[f32; 3]; 6] = [
    [1.0, 0.0, 0.0],
    [0.5, HEIGHT, 0.0],
    [-0.5, HEIGHT, 0.0],
    [-1.0, 0.0, 0.0],
    [-0.5, -HEIGHT, 0.0],
    [0.5, -HEIGHT, 0.0],
];
/// Corners of an octahedron.
const OCTAHEDRON: [[f32; 3]; 6] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
];
/// Triangles of a hexagon.
const FLAT: [u32; 12] = [0, 1, 2, 0, 2, 3, 0, 3, 5, 3, 4, 5];
/// Triangles of an octahedron.
const SOLID: [u32; 24] = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 1, 0, 5, 2, 1, 5, 3, 2, 5, 0, 3, 5];

/// Makes the mesh of all discs, with its material; the vertices' colours are linear, with the opacities
/// of the splats.
///
/// # Errors
/// [`Error::Limit`] for more triangles than allowed.
pub(super) fn discs(model: &mut Model, vertices: &Vertices, limits: &Limits) -> Result<Mesh> {
    let Vertices { all: Attributes { positions, colors, .. }, splats, .. } = vertices;
    let thick = |color: &Vec4| color.w >= OPACITY;
    let count = |(c, s): (&Vec4, &Shape)| if thick(c) { s.triangles().len() as u64 / 3 } else { 0 };
    let value = colors.iter().zip(splats).map(count).sum();
    let shown = colors.iter().filter(|c| thick(c)).count();
    if value > limits.primitives {
        let what = "number of triangles of splats";
        return Err(Error::Limit { place: Place::Whole, what, value, limit: limits.primitives });
    }
    let mut mesh = Mesh::default();
    let (mut indices, mut broken) = (Vec::with_capacity(3 * value as usize), Tally::default());
    mesh.positions.reserve_exact(6 * shown);
    mesh.colors.reserve_exact(6 * shown);
    for ((&center, color), shape) in positions.iter().zip(colors).zip(splats) {
        if !thick(color) {
            continue;
        }
        let Some([u, v, w]) = shape.radii() else {
            broken.add(|| Place::Whole);
            continue;
        };
        let first = mesh.positions.len() as u32;
        let corners = if shape.is_round() { OCTAHEDRON } else { HEXAGON };
        mesh.positions.extend(corners.map(|[x, y, z]| center + RADIUS * (x * u + y * v + z * w)));
        mesh.colors.extend([color.truncate().extend(1.0); 6]);
        indices.extend(shape.triangles().iter().map(|i| first + i));
    }
    mesh.indices = Some(indices);
    mesh.parts.push(whole(&mesh, model.scene.materials.len()));
    model.scene.materials.push(material());
    warn(model, colors.len() - shown, broken.count);
    Ok(mesh)
}

fn warn(model: &mut Model, thin: usize, broken: u64) {
    let message = "Gaussian splats are shown as opaque discs, of one color from all sides";
    model.warn(Place::Whole, message);
    let words = format!("{{splat|splats}} of an opacity below {OPACITY} {{is|are}} left out");
    model.warn_counted(Place::Whole, thin as u64, &words);
    let words = "{splat has|splats have} no finite size or rotation and {is|are} left out";
    model.warn_counted(Place::Whole, broken, words);
}

impl Shape {
    fn is_round(&self) -> bool {
        self.scale.max_element() - self.scale.min_element() < ROUND
    }

    /// Returns the triangles of its shape.
    fn triangles(&self) -> &'static [u32] {
        if self.is_round() { &SOLID } else { &FLAT }
    }

    /// Returns the radii as vectors, the least last; `None` if they are not finite.
    fn radii(&self) -> Option<[Vec3; 3]> {
        let [w, x, y, z] = self.rotation;
        let scale = 2.0 / (w * w + x * x + y * y + z * z);
        let axes = [
            Vec3::new(
                1.0 - scale * (y * y + z * z),
                scale * (x * y + w * z),
                scale * (x * z - w * y),
            ),
            Vec3::new(
                scale * (x * y - w * z),
                1.0 - scale * (x * x + z * z),
                scale * (y * z + w * x),
            ),
            Vec3::new(
                scale * (x * z + w * y),
                scale * (y * z - w * x),
                1.0 - scale * (x * x + y * y),
            ),
        ];
        let least = self.scale.min_element();
        let thin = self.scale.to_array().iter().rposition(|&s| s == least)?;
        let radius = |axis: usize| axes[axis] * libm::expf(self.scale[axis]);
        let radii = [radius((thin + 1) % 3), radius((thin + 2) % 3), radius(thin)];
        radii.iter().all(|r| r.is_finite()).then_some(radii)
    }
}

/// Returns the material of splats: their colours include the light already.
fn material() -> Material {
    let (name, model) = ("splats".to_owned(), ShadingModel::Unlit);
    Material { name, model, base_color: Vec4::ONE, ..Material::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_lies_in_the_plane_of_the_larger_radii() {
        let (quarter, turned) = (0.5_f32.sqrt(), 3.0);
        // Thin along its x axis, which a quarter turn about z rotates to y.
        let shape = Shape {
            scale: Vec3::new(-9.0, 0.0, 1.0),
            rotation: [quarter * turned, 0.0, 0.0, quarter * turned],
        };
        let [u, v, _] = shape.radii().unwrap();
        assert!((u - Vec3::new(-1.0, 0.0, 0.0)).length() < 1e-6, "{u}");
        assert!((v - Vec3::new(0.0, 0.0, 1.0_f32.exp())).length() < 1e-6, "{v}");
        assert!(!shape.is_round() && Shape { scale: Vec3::ZERO, ..shape }.is_round());
        let none = Shape { rotation: [0.0; 4], ..shape };
        assert!(none.radii().is_none());
    }
}
