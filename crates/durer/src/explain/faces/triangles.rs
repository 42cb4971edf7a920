//! Faces as the triangles that methods for models work on.

use super::Scene;
use crate::Result;
use crate::explain::grid::letter;
use crate::math::{DVec2, DVec3, Vec3};
use crate::scene::{self, Camera, Mesh, Projection};
use crate::view::View;

/// The most triangles that get a letter of their own.
const MOST: u64 = 400;

/// Triangles of the faces, in the scene's order, each with its face and its number there.
#[derive(Clone)]
pub(in crate::explain) struct Triangles {
    /// Corners of each, in pixels and depth.
    pub corners: Vec<[DVec3; 3]>,
    owners: Vec<(usize, usize)>,
}

impl Triangles {
    /// Divides faces into fans, which cover convex ones.
    pub fn new(scene: &Scene) -> Result<Self> {
        let (mut corners, mut owners) = (Vec::new(), Vec::new());
        for (face, own) in scene.faces.iter().enumerate() {
            let ring = own.corners();
            for (number, pair) in ring.get(1..).unwrap_or_default().windows(2).enumerate() {
                corners.push([ring[0], pair[0], pair[1]]);
                owners.push((face, number));
            }
        }
        let value = corners.len() as u64;
        if value > MOST {
            return Err(crate::Error::Limit {
                what: "number of triangles to be explained",
                value,
                limit: MOST,
            });
        }
        Ok(Self { corners, owners })
    }

    /// Returns the scene before a camera that sees a pixel of the grid as one of the picture.
    pub fn prepared(&self, scene: &Scene) -> Result<(scene::Scene, View)> {
        let point = |c: DVec3| Vec3::new(c.x as f32, c.y as f32, -c.z as f32);
        let mesh = Mesh::from_triangles(self.corners.iter().map(|corners| corners.map(point)));
        let [width, height] = [scene.raster.columns, scene.raster.rows];
        let middle = DVec2::new(width.into(), height.into()) / 2.0;
        let far = self.corners.iter().flatten().map(|c| c.z).fold(0.0, f64::max);
        let camera = Camera {
            eye: middle.extend(1.0),
            target: middle.extend(0.0),
            up: DVec3::Y,
            projection: Projection::Orthographic { height: height.into() },
            near: 0.5,
            far: far + 2.0,
        };
        let model = scene::Scene::from(mesh);
        // Coordinates of models are shorter than those of faces.
        model.check()?;
        Ok((model, View::new(camera, width, height)?))
    }

    /// Returns a triangle's name: its face's letter, and its number where the face has several.
    pub fn name(&self, triangle: u32) -> String {
        let Some(&(face, number)) = self.owners.get(triangle as usize) else {
            return String::new();
        };
        let several = self.owners.iter().filter(|owner| owner.0 == face).count() > 1;
        if several { format!("{}{}", letter(face), number + 1) } else { letter(face) }
    }

    /// Returns the face that a triangle belongs to.
    pub fn face(&self, triangle: u32) -> usize {
        self.owners.get(triangle as usize).map_or(0, |owner| owner.0)
    }

    /// Returns the corners of a triangle on the screen, the first one again at the end.
    pub fn outline(&self, triangle: u32) -> Vec<DVec2> {
        let corners = self.corners.get(triangle as usize);
        let closed = corners.into_iter().flat_map(|[a, b, c]| [a, b, c, a]);
        closed.map(|corner| corner.truncate()).collect()
    }
}
