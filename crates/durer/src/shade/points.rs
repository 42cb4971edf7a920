//! Surface points, several at a time.

use super::lane::{Lane, Vec3Lane};
use super::normal::{Frame, face_seen};

/// Surface points, component by component; lanes without a sample are unspecified.
#[derive(Debug, Clone, Copy)]
pub struct Points<L> {
    /// Relative to the lights' origin. Only read where there are point or spot lights, or shadows.
    pub position: Vec3Lane<L>,
    /// Direction to the eye, of any length.
    pub view: Vec3Lane<L>,
    /// Interpolated normals, any length.
    pub normal: Vec3Lane<L>,
    /// Data that determine the visible side of the surface.
    pub faces: Faces<L>,
}

/// Data that determine the visible side of a surface at several points.
#[derive(Debug, Clone, Copy)]
pub enum Faces<L> {
    /// Unit normals of the faces' planes, on the viewer's side; zero if there is none.
    Seen(Vec3Lane<L>),
    /// No correction needed: interpolated normals have a length and are on the viewer's side of the faces, and
    /// neither flat shading nor shadows need the faces' own normals.
    Settled,
}

impl<L: Lane> Points<L> {
    /// Returns the unit vectors at the points, all on the viewer's side.
    #[inline(always)]
    pub(crate) fn frame(&self) -> Frame<L> {
        match self.faces {
            Faces::Seen(face) => face_seen(self.view, face, self.normal),
            Faces::Settled => {
                let normal = self.normal.unit();
                Frame { view: self.view.unit(), face: normal, normal }
            }
        }
    }
}
