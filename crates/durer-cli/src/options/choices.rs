//! Options with a fixed set of values, and the library's names for these.

use clap::ValueEnum;
use durer::clip::tiles;
use durer::pipeline;
use durer::scene;

/// `--aa`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Samples {
    /// One, at the centre: no anti-aliasing
    #[value(name = "1")]
    One,
    /// Four
    #[value(name = "4")]
    Four,
    /// Sixteen
    #[value(name = "16")]
    Sixteen,
    /// Sixty-four: by the A-buffer
    #[value(name = "64")]
    SixtyFour,
}

/// `--shadows`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Shadows {
    /// No shadows
    None,
    /// By a depth map for each light
    Map,
    /// By rays to the lights, with the algorithm ray
    Rays,
}

/// `--shading`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Shading {
    /// One intensity per face
    Flat,
    /// Intensities at the vertices, interpolated
    Gouraud,
    /// Normals interpolated, Blinn's highlights
    Phong,
    /// The formula of glTF
    MetallicRoughness,
    /// The base colour without lighting
    Unlit,
}

/// `--tone-map`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum ToneMap {
    /// Colours up to white are unchanged; brighter ones keep their hue and become paler
    None,
    /// Nearly unchanged up to 0.8, then compressed; for pictures of products
    KhronosNeutral,
    /// The look of film
    Aces,
    /// Soft; bright colours become pale
    Agx,
}

/// `--cull`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Cull {
    /// No faces
    None,
    /// Faces seen from behind
    Back,
    /// Faces seen from behind whose material is single-sided (as in glTF)
    Material,
}

/// `--up-axis`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum UpAxis {
    /// glTF, most OBJ and PLY files
    Y,
    /// STL, 3MF
    Z,
    /// Seen from +z
    X,
    /// Seen from +z, as pictures whose rows count downwards
    #[value(name = "-y")]
    NegY,
    /// Seen from -y
    #[value(name = "-z")]
    NegZ,
    /// Seen from +z
    #[value(name = "-x")]
    NegX,
}

impl From<Samples> for pipeline::Samples {
    fn from(samples: Samples) -> Self {
        match samples {
            Samples::One => Self::One,
            Samples::Four => Self::Four,
            // The A-buffer counts sub-pixels, not samples.
            Samples::Sixteen | Samples::SixtyFour => Self::Sixteen,
        }
    }
}

impl From<Shadows> for pipeline::Shadows {
    fn from(shadows: Shadows) -> Self {
        match shadows {
            Shadows::None => Self::None,
            Shadows::Map => Self::Map,
            Shadows::Rays => Self::Rays,
        }
    }
}

impl From<Shading> for pipeline::Shading {
    fn from(shading: Shading) -> Self {
        match shading {
            Shading::Flat => Self::Flat,
            Shading::Gouraud => Self::Gouraud,
            Shading::Phong => Self::Phong,
            Shading::MetallicRoughness => Self::MetallicRoughness,
            Shading::Unlit => Self::Unlit,
        }
    }
}

impl From<ToneMap> for pipeline::ToneMap {
    fn from(map: ToneMap) -> Self {
        match map {
            ToneMap::None => Self::None,
            ToneMap::KhronosNeutral => Self::KhronosNeutral,
            ToneMap::Aces => Self::Aces,
            ToneMap::Agx => Self::Agx,
        }
    }
}

impl From<Cull> for pipeline::Cull {
    fn from(cull: Cull) -> Self {
        match cull {
            Cull::None => Self::None,
            Cull::Back => Self::Back,
            Cull::Material => Self::Material,
        }
    }
}

impl From<UpAxis> for scene::UpAxis {
    fn from(axis: UpAxis) -> Self {
        match axis {
            UpAxis::Y => Self::Y,
            UpAxis::Z => Self::Z,
            UpAxis::X => Self::X,
            UpAxis::NegY => Self::NegY,
            UpAxis::NegZ => Self::NegZ,
            UpAxis::NegX => Self::NegX,
        }
    }
}

/// `--tile-coordinates` and `--coordinates`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TileCoordinates {
    /// Longitude and latitude in degrees
    Lonlat,
    /// Web Mercator (EPSG:3857), in metres
    Mercator,
}

impl From<TileCoordinates> for tiles::Coordinates {
    fn from(coordinates: TileCoordinates) -> Self {
        match coordinates {
            TileCoordinates::Lonlat => Self::LonLat,
            TileCoordinates::Mercator => Self::Mercator,
        }
    }
}
