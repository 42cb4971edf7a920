//! Few colours for a picture of many, by cutting the box of colours in two again and again.
//!
//! After Heckbert ("Color image quantization for frame buffer display", SIGGRAPH 1982), with Wan, Wong and
//! Prusinkiewicz's rule (1988) that the group of the largest squared error is cut, at its mean. All in whole
//! numbers. Cost: sorting the pixels, then O(colours · log groups).

use durer::target::Pixels;

/// Pixels less opaque than this become wholly transparent.
const SEEN: u8 = 128;

/// A picture by indices into few colours.
#[derive(Debug, PartialEq, Eq)]
pub struct Indexed {
    /// Colours, at most 256.
    pub palette: Vec<[u8; 3]>,
    /// Row by row.
    pub indices: Vec<u8>,
    /// The index of transparent pixels, if there are any.
    pub transparent: Option<u8>,
}

/// Colours next to each other in a list, with how many pixels have each.
struct Group {
    start: usize,
    end: usize,
    /// Squared distances from the mean, summed over the pixels, and the channel that has most of them.
    error: u64,
    channel: usize,
    /// The mean of that channel.
    mean: u8,
}

/// Finds colours for a picture: its own if there are at most 256, including the transparent one.
pub fn indexed(pixels: &Pixels<[u8; 4]>) -> Indexed {
    let mut colors = counted(pixels);
    let clear = pixels.data().iter().any(|p| p[3] < SEEN);
    let groups = grouped(&mut colors, 256 - usize::from(clear));
    let mut palette = Vec::new();
    let mut found = Vec::new();
    for group in &groups {
        let some = &colors[group.start..group.end];
        found.extend(some.iter().map(|&(color, _)| (color, palette.len() as u8)));
        palette.push(representative(some));
    }
    found.sort_unstable();
    let transparent = clear.then_some(palette.len() as u8);
    palette.extend(transparent.map(|_| [0; 3]));
    let indices = indices(pixels, &found, transparent.unwrap_or(0));
    Indexed { palette, indices, transparent }
}

/// Returns the colours of pixels that are not transparent, in order, with their numbers of pixels.
fn counted(pixels: &Pixels<[u8; 4]>) -> Vec<([u8; 3], u64)> {
    let seen = pixels.data().iter().filter(|p| p[3] >= SEEN);
    let mut all: Vec<[u8; 3]> = seen.map(|&[r, g, b, _]| [r, g, b]).collect();
    all.sort_unstable();
    all.chunk_by(|a, b| a == b).map(|same| (same[0], same.len() as u64)).collect()
}

/// Sorts colours into at most `most` groups, each a part of the list.
fn grouped(colors: &mut [([u8; 3], u64)], most: usize) -> Vec<Group> {
    if colors.is_empty() {
        return Vec::new();
    }
    let mut groups = vec![Group::of(colors, 0, colors.len())];
    while groups.len() < most {
        // The first of equally bad ones.
        let worst = (0..groups.len()).rev().max_by_key(|&i| groups[i].error).unwrap_or(0);
        let Group { start, end, error, channel, mean } = groups[worst];
        if error == 0 {
            break;
        }
        let part = &mut colors[start..end];
        part.sort_unstable_by_key(|&(color, _)| (color[channel], color));
        let middle = start + part.partition_point(|(color, _)| color[channel] <= mean);
        groups[worst] = Group::of(colors, start, middle);
        groups.push(Group::of(colors, middle, end));
    }
    groups
}

impl Group {
    fn of(colors: &[([u8; 3], u64)], start: usize, end: usize) -> Self {
        let some = &colors[start..end];
        let pixels = some.iter().map(|c| c.1).sum::<u64>().max(1);
        let statistics = |channel: usize| {
            let (mut sum, mut squares) = (0, 0);
            for &(color, count) in some {
                let value = u64::from(color[channel]);
                sum += value * count;
                squares += value * value * count;
            }
            // The squares less sum²/pixels, rounded up: 0 for one value only.
            let (whole, rest) = (sum / pixels, sum % pixels);
            let error = squares - (whole * (sum + rest) + rest * rest / pixels);
            (error, whole as u8)
        };
        let all = [0, 1, 2].map(statistics);
        let channel = (0..3).rev().max_by_key(|&i| all[i].0).unwrap_or(0);
        let (_, mean) = all[channel];
        Self { start, end, error: all.iter().map(|s| s.0).sum(), channel, mean }
    }
}

/// Returns the most frequent colour if it has half of the pixels, so that a background keeps its colour; else the mean.
fn representative(colors: &[([u8; 3], u64)]) -> [u8; 3] {
    let pixels = colors.iter().map(|c| c.1).sum::<u64>().max(1);
    let main = colors.iter().rev().max_by_key(|c| c.1);
    match main {
        Some(&(color, count)) if count * 2 >= pixels => color,
        _ => [0, 1, 2].map(|channel| {
            let sum: u64 = colors.iter().map(|(c, n)| u64::from(c[channel]) * n).sum();
            ((sum + pixels / 2) / pixels) as u8
        }),
    }
}

/// Returns each pixel's index, from a sorted list of colours.
fn indices(pixels: &Pixels<[u8; 4]>, found: &[([u8; 3], u8)], transparent: u8) -> Vec<u8> {
    let mut last = ([0; 4], transparent);
    let index = |&pixel: &[u8; 4]| {
        let [r, g, b, alpha] = pixel;
        if alpha < SEEN {
            return transparent;
        }
        if pixel != last.0 {
            let place = found.binary_search_by_key(&[r, g, b], |&(color, _)| color);
            last = (pixel, place.ok().and_then(|i| found.get(i)).map_or(0, |f| f.1));
        }
        last.1
    };
    pixels.data().iter().map(index).collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::shades;
    use super::*;

    fn shown(indexed: &Indexed, i: usize) -> Option<[u8; 3]> {
        let index = indexed.indices[i];
        (Some(index) != indexed.transparent).then(|| indexed.palette[usize::from(index)])
    }

    #[test]
    fn few_colors_stay_as_they_are() {
        let mut pixels = Pixels::new(16, 16, [0, 0, 0, 255]);
        for (i, p) in pixels.data_mut().iter_mut().enumerate() {
            *p = [i as u8, 255 - i as u8, 7, 255];
        }
        let found = indexed(&pixels);
        assert_eq!((found.palette.len(), found.transparent), (256, None));
        for (i, p) in pixels.data().iter().enumerate() {
            assert_eq!(shown(&found, i), Some([p[0], p[1], p[2]]));
        }
    }

    #[test]
    fn many_colors_become_near_ones_and_a_background_stays() {
        let mut pixels = Pixels::new(64, 64, [251, 252, 253, 255]);
        for y in 0..32 {
            for x in 0..64 {
                pixels.set(x, y, [x as u8 * 4, y as u8 * 8, (x + y) as u8, 255]);
            }
        }
        let found = indexed(&pixels);
        assert_eq!(found.palette.len(), 256);
        assert_eq!(shown(&found, 64 * 64 - 1), Some([251, 252, 253]));
        let off = |(i, p): (usize, &[u8; 4])| {
            let color = shown(&found, i).unwrap();
            (0..3).map(|c| color[c].abs_diff(p[c])).max().unwrap()
        };
        let worst = pixels.data().iter().enumerate().map(off).max().unwrap();
        assert!(worst <= 20, "{worst}");
    }

    #[test]
    fn what_is_hardly_opaque_is_transparent() {
        let pixels = shades(50, 50);
        let found = indexed(&pixels);
        assert_eq!((found.palette.len(), found.transparent), (256, Some(255)));
        for (i, p) in pixels.data().iter().enumerate() {
            assert_eq!(shown(&found, i).is_none(), p[3] < 128);
        }
        let clear = indexed(&Pixels::new(2, 2, [9, 9, 9, 0]));
        assert_eq!(
            clear,
            Indexed { palette: vec![[0; 3]], indices: vec![0; 4], transparent: Some(0) }
        );
    }
}
