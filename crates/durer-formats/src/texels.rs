//! Several pictures, texel beside texel.

use durer::scene::Image;

/// Returns the size of the smallest picture that loses no texel of several; `None` if none is
/// there.
pub(crate) fn size<const N: usize>(images: [Option<&Image>; N]) -> Option<[u32; 2]> {
    let largest = |side: fn(&Image) -> u32| images.iter().flatten().map(|i| side(i)).max();
    Some([largest(|i| i.width)?, largest(|i| i.height)?])
}

/// Applies `join` to the texels of several pictures at each place of their [`size`], row by row. Smaller
/// pictures are enlarged by repeating texels; a missing picture gives `join` no texel.
pub(crate) fn join<const N: usize, T>(
    images: [Option<&Image>; N],
    join: impl Fn([Option<[u8; 4]>; N]) -> T,
) -> Vec<T> {
    let [width, height] = size(images).unwrap_or_default();
    let texel = |image: &Image, x: u32, y: u32| {
        let scale = |at: u32, to: u32, from: u32| u64::from(at) * u64::from(to) / u64::from(from);
        let (x, y) = (scale(x, image.width, width), scale(y, image.height, height));
        image.data.get((y * u64::from(image.width) + x) as usize).copied()
    };
    let at = |x, y| join(images.map(|image| image.and_then(|i| texel(i, x, y))));
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect()
}
