//! Images and how they are sampled.

/// A decoded image: 8-bit RGBA, straight alpha, row 0 on top.
///
/// Whether its colours are sRGB or linear is decided by the material slot that uses it.
#[derive(Debug, Clone, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Image {
    /// Name or URI in the file.
    pub name: String,
    /// Pixels; `data` of zero size means an image that could not be read, and samples white.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width · height` pixels, row after row.
    pub data: Vec<[u8; 4]>,
}

/// Filter within one image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum TextureFilter {
    /// The texel whose area holds the point.
    Nearest,
    /// The four texels around the point, weighted bilinearly.
    #[default]
    Linear,
}

/// Filter between the levels of the mip chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MipFilter {
    /// Always the full image.
    None,
    /// The nearest level.
    Nearest,
    /// The two nearest levels, weighted.
    #[default]
    Linear,
}

/// Extension outside 0…1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image, every second time mirrored.
    MirroredRepeat,
    /// The border texel.
    ClampToEdge,
}

/// Options for sampling a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sampler {
    /// Filter if a texel is larger than a pixel.
    pub mag: TextureFilter,
    /// Filter if a texel is smaller than a pixel.
    pub min: TextureFilter,
    /// The choice of level where a texel is smaller than a pixel.
    pub mip: MipFilter,
    /// Wrap mode along u.
    pub wrap_u: Wrap,
    /// Wrap mode along v.
    pub wrap_v: Wrap,
}

/// An image with a sampler.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Texture {
    /// Index into [`super::Scene::images`].
    pub image: usize,
    /// Options for sampling it.
    pub sampler: Sampler,
}
