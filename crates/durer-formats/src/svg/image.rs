//! Images within drawings.

use crate::{Error, Limits, Place, Result};
use durer::curve::Path;
use durer::math::{DAffine2, DVec2};
use durer::raster::paint::{ImageFilter, Paint, Pattern};
use durer::target::Pixels;
use durer::target::gradient::Spread;
use std::sync::Arc;

/// Returns an image as a paint, its frame, and how many bytes it takes.
pub(super) fn paint(
    node: &usvg::Image,
    pixel_from_node: DAffine2,
    limits: &Limits,
) -> Result<(Paint, Path, u64)> {
    let unsupported = |what: &str| Error::Unsupported {
        place: Place::Whole,
        what: what.to_owned(),
        hint: "use PNG or JPEG".to_owned(),
    };
    let bytes = match node.kind() {
        usvg::ImageKind::PNG(bytes)
        | usvg::ImageKind::JPEG(bytes)
        | usvg::ImageKind::GIF(bytes)
        | usvg::ImageKind::WEBP(bytes) => bytes,
        usvg::ImageKind::SVG(_) => return Err(unsupported("a drawing in place of pixels")),
    };
    let name = if node.id().is_empty() { "unnamed" } else { node.id() };
    let decoded = crate::image::decode(bytes, name, limits)?;
    let cost = decoded.data.len() as u64 * 4;
    let mut image = Pixels::from_data(decoded.width, decoded.height, decoded.data)?;
    let size = DVec2::new(node.size().width().into(), node.size().height().into());
    let filter = match node.rendering_mode() {
        usvg::ImageRendering::OptimizeQuality | usvg::ImageRendering::HighQuality => {
            ImageFilter::Bicubic
        }
        usvg::ImageRendering::Smooth => ImageFilter::Bilinear,
        usvg::ImageRendering::OptimizeSpeed
        | usvg::ImageRendering::CrispEdges
        | usvg::ImageRendering::Pixelated => ImageFilter::Nearest,
    };
    if filter != ImageFilter::Nearest {
        image = reduced(image, size, pixel_from_node);
    }
    let pixels = DVec2::new(image.width().into(), image.height().into());
    let (image, transform) = (Arc::new(image), DAffine2::from_scale(size / pixels));
    let pattern = Pattern { image, transform, spread: Some(Spread::Pad), filter };
    let frame = Path::rectangle(0.0, 0.0, size.x, size.y);
    Ok((Paint::Pattern(Arc::new(pattern)), frame, cost))
}

/// Returns the image halved, in each direction, until it has less than twice the pixels that it
/// will cover: mixing neighbours then misses none.
fn reduced(mut image: Pixels<[u8; 4]>, size: DVec2, pixel_from_node: DAffine2) -> Pixels<[u8; 4]> {
    let seen = size
        * DVec2::new(
            pixel_from_node.matrix2.x_axis.length(),
            pixel_from_node.matrix2.y_axis.length(),
        );
    while f64::from(image.width()) >= 2.0 * seen.x && image.width() > 1 {
        image = halved(&image, image.width().div_ceil(2), image.height(), |x, y| {
            [(2 * x, y), (2 * x + 1, y)]
        });
    }
    while f64::from(image.height()) >= 2.0 * seen.y && image.height() > 1 {
        image = halved(&image, image.width(), image.height().div_ceil(2), |x, y| {
            [(x, 2 * y), (x, 2 * y + 1)]
        });
    }
    image
}

/// Returns the means of pairs of pixels; colours are weighted by their alpha.
fn halved(
    image: &Pixels<[u8; 4]>,
    width: u32,
    height: u32,
    pair: impl Fn(u32, u32) -> [(u32, u32); 2],
) -> Pixels<[u8; 4]> {
    let mut out = Pixels::new(width, height, [0; 4]);
    for y in 0..height {
        for (x, pixel) in (0..width).zip(out.row_mut(y)) {
            let [first, second] = pair(x, y);
            let a = image.get(first.0, first.1).unwrap_or([0; 4]);
            *pixel = mean(a, image.get(second.0, second.1).unwrap_or(a));
        }
    }
    out
}

fn mean(a: [u8; 4], b: [u8; 4]) -> [u8; 4] {
    let (wa, wb) = (u32::from(a[3]), u32::from(b[3]));
    let whole = wa + wb;
    if whole == 0 {
        return [0; 4];
    }
    let part = |i: usize| ((u32::from(a[i]) * wa + u32::from(b[i]) * wb + whole / 2) / whole) as u8;
    [part(0), part(1), part(2), whole.div_ceil(2) as u8]
}
