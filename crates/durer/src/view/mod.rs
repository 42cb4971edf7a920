//! From the world to the screen: windows and viewports, projection, culling, places for labels.

pub mod components;
pub mod cull;
pub mod explode;
pub mod fit;
pub mod interior_point;
pub mod label;
pub mod layout;
pub mod mapping;
pub(crate) mod near;
pub mod objects;
mod outermost;
pub mod pick;
pub mod picture_plane;
pub mod projection;
pub mod section;
pub mod topology;
pub mod warp;
pub mod window;

use crate::math::{DMat4, DVec4};
use crate::scene::Camera;
use crate::{Error, Result};
use window::PixelRect;

/// A camera with a screen of pixels behind it.
///
/// Screen space is y down, in pixels, depth 0 (near plane) … 1 (far plane); `screen_from_world`
/// gives it in homogeneous form, so a point is visible if 0 ≤ x ≤ width·w, 0 ≤ y ≤ height·w and
/// 0 ≤ z ≤ w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    camera: Camera,
    width: u32,
    height: u32,
    window: PixelRect,
    clip_from_world: DMat4,
    screen_from_world: DMat4,
}

impl View {
    /// Creates the view of a camera on a screen of `width × height` square pixels.
    ///
    /// # Errors
    /// The errors of [`Camera::check`], and [`Error::Parameter`] for a size of zero.
    pub fn new(camera: Camera, width: u32, height: u32) -> Result<Self> {
        camera.check()?;
        if width == 0 || height == 0 {
            return Err(Error::parameter("size", format!("{width}x{height}"), "at least 1x1"));
        }
        let (w, h) = (f64::from(width), f64::from(height));
        let clip_from_world = camera.clip_from_view(w / h) * camera.view_from_world();
        let screen_from_clip = DMat4::from_cols(
            DVec4::new(0.5 * w, 0.0, 0.0, 0.0),
            DVec4::new(0.0, -0.5 * h, 0.0, 0.0),
            DVec4::new(0.0, 0.0, 0.5, 0.0),
            DVec4::new(0.5 * w, 0.5 * h, 0.5, 1.0),
        );
        let screen_from_world = screen_from_clip * clip_from_world;
        let window = screen(width, height);
        Ok(Self { camera, width, height, window, clip_from_world, screen_from_world })
    }

    /// Returns the camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Returns the width of the screen in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the height of the screen in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the same view with a window: pictures have only these pixels of the screen, as they are in the whole one.
    /// Parts beyond the screen are cut off.
    pub(crate) fn with_window(self, window: PixelRect) -> Self {
        Self { window: window.intersection(&screen(self.width, self.height)), ..self }
    }

    /// Returns the pixels of the screen that pictures have: all, unless there is a window.
    pub fn window(&self) -> PixelRect {
        self.window
    }

    /// Returns the matrix from world space to clip space, −w ≤ x, y, z ≤ w.
    pub fn clip_from_world(&self) -> DMat4 {
        self.clip_from_world
    }

    /// Returns the matrix from world space to homogeneous screen space: x and y in pixels times w, y down, z in 0…w.
    pub fn screen_from_world(&self) -> DMat4 {
        self.screen_from_world
    }
}

/// Returns all pixels of a screen.
fn screen(width: u32, height: u32) -> PixelRect {
    let side = |pixels: u32| i32::try_from(pixels).unwrap_or(i32::MAX);
    PixelRect::spanning(0, 0, side(width), side(height))
}
