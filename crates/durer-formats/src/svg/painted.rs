//! The cache of painted tiles of patterns and decoded images.
//!
//! Nodes of the tree are identified by their addresses: the tree outlives everything painted from it, and two
//! references to one node have the same address.

use super::paint::Tile;
use durer::curve::Path;
use durer::math::DAffine2;
use durer::raster::paint::{ImageFilter, Paint};
use std::collections::BTreeMap;
use std::sync::Arc;
use usvg::ImageKind;

/// Paints by the kind of their elements.
#[derive(Debug, Default)]
pub(super) struct Painted {
    pub tiles: BTreeMap<TileKey, Paint>,
    /// Images with their frames; reasons where they cannot be shown.
    pub images: BTreeMap<ImageKey, Result<(Paint, Path), String>>,
}

/// Key of a painted pattern: everything of its map that its pixels depend on.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct TileKey {
    pattern: usize,
    size: [u32; 2],
    is_averaged: bool,
}

impl TileKey {
    pub fn new(pattern: &Arc<usvg::Pattern>, tile: &Tile) -> Self {
        let pattern = Arc::as_ptr(pattern) as usize;
        let is_averaged = tile.filter() == ImageFilter::Area;
        Self { pattern, size: [tile.width, tile.height], is_averaged }
    }
}

/// Key of a decoded image: its bytes, size and quality, and its size in the picture.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct ImageKey {
    bytes: usize,
    size: [u32; 2],
    rendering: u8,
    scale: [u64; 2],
}

impl ImageKey {
    /// Returns `None` for a drawing.
    pub fn new(node: &usvg::Image, pixel_from_node: DAffine2) -> Option<Self> {
        let bytes = match node.kind() {
            ImageKind::PNG(bytes)
            | ImageKind::JPEG(bytes)
            | ImageKind::GIF(bytes)
            | ImageKind::WEBP(bytes) => Arc::as_ptr(bytes) as usize,
            ImageKind::SVG(_) => return None,
        };
        let (size, map) = (node.size(), pixel_from_node.matrix2);
        Some(Self {
            bytes,
            size: [size.width(), size.height()].map(f32::to_bits),
            rendering: node.rendering_mode() as u8,
            scale: [map.x_axis, map.y_axis].map(|axis| axis.length().to_bits()),
        })
    }
}
