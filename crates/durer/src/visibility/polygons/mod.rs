//! Visible surfaces as in textbooks: the published methods on plane polygons of any number of corners, a file each,
//! small enough to be read beside the paper.
//!
//! The eye looks along z: x goes to the right and y down, in pixels, and z is the distance from the eye. All methods
//! find the same nearest polygon at each pixel's centre, of equally near ones the first; [`regions`] finds the visible
//! region of each polygon, without pixels, [`portals`] the rooms that are visible through doors, and [`csg`] the
//! visible parts of solids that are united, intersected or subtracted. [`patch_subdivision`] does the same as the
//! others for curved patches, and [`shadow_volumes`] finds which pixels are in shadow. Methods that render models are
//! in [`super::surface`], methods that divide them into visible regions in [`super::region`].
//!
//! ```
//! use durer::math::DVec3;
//! use durer::visibility::polygons::{Face, PolygonMethod, Screen};
//!
//! let square = |at: f64, z: f64| {
//!     let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
//!     Face::new(&corners.map(|(x, y)| DVec3::new(x + at, y, z)))
//! };
//! let faces = [square(0.0, 2.0)?, square(2.0, 1.0)?];
//! let screen = Screen { width: 6, height: 1, ..Screen::default() };
//! for method in PolygonMethod::ALL {
//!     assert_eq!(method.items(&faces, &screen)?.data(), [0, 0, 1, 1, 1, 1], "{method}");
//! }
//! # Ok::<(), durer::Error>(())
//! ```

pub mod a_buffer;
pub mod bsp;
pub mod csg;
pub mod depth_sort;
mod face;
pub mod hierarchical_z;
pub mod octree;
pub mod painter;
pub mod patch_subdivision;
mod pieces;
pub mod portals;
mod pyramid;
pub mod regions;
pub mod shadow_volumes;
pub mod warnock;
pub mod watkins;
pub mod z_buffer;

pub use face::Face;

use crate::Result;
use crate::math::DVec2;
use crate::raster::polygon::edge_table::TableEdge;
use crate::target::{NO_ITEM, Pixels};
use crate::trace::NoTrace;
use crate::work::{Charge, Work};

/// The picture that is made: an item for each pixel, which is the index of a face, or
/// [`NO_ITEM`].
#[derive(Debug, Clone, Default)]
pub struct Screen {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Budget of memory, and cancellation.
    pub work: Work,
}

impl Screen {
    /// Returns a plane of this size.
    fn plane<T: Copy>(&self, value: T) -> Result<Pixels<T>> {
        Pixels::within((&self.work, "planes of the picture"), self.width, self.height, value)
    }

    /// Returns the picture that is made by pixels with their faces, painted one after the other.
    fn painted(&self, pixels: impl Iterator<Item = ([u32; 2], u32)>) -> Result<Pixels<u32>> {
        let mut items = self.plane(NO_ITEM)?;
        pixels.for_each(|([x, y], face)| items.set(x, y, face));
        Ok(items)
    }

    /// Charges the edge table for the pixels of the face with the most corners: faces are scanned one after the other.
    fn edge_table<'a>(&self, faces: impl IntoIterator<Item = &'a Face>) -> Result<Charge> {
        let corners = faces.into_iter().map(|face| face.corners().len()).max().unwrap_or(0);
        // An edge is in the table, then among the active ones; its corner is in the outline.
        self.work.charge_for::<([TableEdge; 2], DVec2)>("edge table of a polygon", corners as u64)
    }
}

crate::info::family! {
    /// The methods that find the visible polygon at each pixel. The painter's algorithm is not among them: it is wrong
    /// where no order by depth is right.
    pub enum PolygonMethod {
        /// [`z_buffer`]
        ZBuffer => z_buffer::INFO,
        /// [`hierarchical_z`]
        HierarchicalZ => hierarchical_z::INFO,
        /// [`octree`]
        Octree => octree::INFO,
        /// [`depth_sort`]
        DepthSort => depth_sort::INFO,
        /// [`bsp`]
        Bsp => bsp::INFO,
        /// [`warnock`]
        Warnock => warnock::INFO,
        /// [`watkins`]
        Watkins => watkins::INFO,
    }
}

impl PolygonMethod {
    /// Returns the index of the nearest face at each pixel's centre, of equally near ones the
    /// smallest.
    ///
    /// # Errors
    /// Those of the method's own function; all charge memory to the screen's budget.
    pub fn items(self, faces: &[Face], screen: &Screen) -> Result<Pixels<u32>> {
        match self {
            Self::ZBuffer => z_buffer::items(faces, screen, &mut NoTrace),
            Self::HierarchicalZ => {
                hierarchical_z::items(faces, screen, &Default::default(), &mut NoTrace)
            }
            Self::Octree => octree::items(faces, screen, &Default::default(), &mut NoTrace),
            Self::DepthSort => depth_sort::items(faces, screen, &Default::default(), &mut NoTrace),
            Self::Bsp => bsp::items(faces, screen, &Default::default(), &mut NoTrace),
            Self::Warnock => warnock::items(faces, screen, &Default::default(), &mut NoTrace),
            Self::Watkins => watkins::items(faces, screen, &mut NoTrace),
        }
    }
}
