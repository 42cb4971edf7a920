//! The spatial index: a packed tree of boxes over features in the order of Hilbert's curve. Its nodes are stored level
//! by level, the root first; nodes of the lowest level give the position of a feature.

use durer::clip::hilbert;
use durer::math::{DVec2, Rect};

/// Bytes of a node: a box and an offset.
pub const NODE: usize = 40;

/// Children of a node.
pub const WIDTH: u16 = 16;

/// Bits of a coordinate on the curve.
const BITS: u8 = 16;

/// A box of a feature or of several.
#[derive(Debug, Clone, Copy)]
struct Node {
    low: DVec2,
    high: DVec2,
    /// Position of a feature after the index, in bytes; for inner nodes the number of the first
    /// child.
    offset: u64,
}

impl Node {
    /// Around nothing.
    const EMPTY: Self = Self { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY, offset: 0 };

    fn around(bounds: Option<Rect>, offset: u64) -> Self {
        match bounds {
            Some(b) => Self { low: b.min(), high: b.max(), offset },
            None => Self { offset, ..Self::EMPTY },
        }
    }

    fn read(bytes: &[u8]) -> Option<Self> {
        let word = |i: usize| bytes.get(8 * i..)?.first_chunk().copied();
        let number = |i| word(i).map(f64::from_le_bytes);
        let (low, high) = (DVec2::new(number(0)?, number(1)?), DVec2::new(number(2)?, number(3)?));
        Some(Self { low, high, offset: word(4).map(u64::from_le_bytes)? })
    }

    fn write(&self, out: &mut Vec<u8>) {
        let [low, high] = [self.low, self.high].map(|p| p.to_array());
        low.iter().chain(&high).for_each(|n| out.extend(n.to_le_bytes()));
        out.extend(self.offset.to_le_bytes());
    }

    fn meets(&self, window: &Rect) -> bool {
        let (low, high) = (window.min(), window.max());
        self.low.cmple(high).all() && self.high.cmpge(low).all()
    }
}

/// Returns the order of features along the curve, from its end: features without a place last, and features at the same
/// place in their original order.
pub fn order(bounds: &[Option<Rect>]) -> Vec<usize> {
    let corners = bounds.iter().flatten().flat_map(|b| [b.min(), b.max()]);
    let (low, size) = match Rect::around(corners) {
        Some(all) => (all.min(), all.max() - all.min()),
        None => (DVec2::ZERO, DVec2::ZERO),
    };
    let most = f64::from((1u32 << BITS) - 1);
    // Without an extent, all cells are 0.
    let cell = |at: f64, size: f64| if size > 0.0 { (most * (at / size)) as u32 } else { 0 };
    let place = |bounds: &Option<Rect>| {
        let middle = bounds.map(|b| b.min() * 0.5 + b.max() * 0.5 - low)?;
        Some(hilbert::index(BITS, cell(middle.x, size.x), cell(middle.y, size.y)))
    };
    let mut order: Vec<(Option<u64>, usize)> =
        bounds.iter().enumerate().map(|(i, b)| (place(b), i)).collect();
    order.sort_by_key(|(place, i)| (std::cmp::Reverse(*place), *i));
    order.into_iter().map(|(_, i)| i).collect()
}

/// Returns the index of features in their order, each with its box and its place in bytes.
pub fn build(features: impl Iterator<Item = (Option<Rect>, u64)>) -> Vec<u8> {
    let leaves: Vec<Node> = features.map(|(bounds, at)| Node::around(bounds, at)).collect();
    if leaves.is_empty() {
        return Vec::new();
    }
    let mut levels = vec![leaves];
    let starts = starts(levels[0].len() as u64, WIDTH);
    for start in starts.iter().rev().take(starts.len().saturating_sub(1)) {
        let below = levels.last().map_or(&[][..], Vec::as_slice);
        let groups = below.chunks(usize::from(WIDTH)).zip((*start..).step_by(usize::from(WIDTH)));
        levels.push(groups.map(|(children, first)| parent(children, first)).collect());
    }
    let mut out = Vec::new();
    levels.iter().rev().flatten().for_each(|node| node.write(&mut out));
    out
}

fn parent(children: &[Node], offset: u64) -> Node {
    let join = |all: Node, child: &Node| Node {
        low: all.low.min(child.low),
        high: all.high.max(child.high),
        offset,
    };
    children.iter().fold(Node { offset, ..Node::EMPTY }, join)
}

/// Returns the number of the first node of each level, the root's first; empty if there is no index. One
/// feature has a root above it.
fn starts(count: u64, width: u16) -> Vec<u64> {
    if count == 0 || width == 0 {
        return Vec::new();
    }
    let width = u64::from(width.max(2));
    let mut sizes = vec![count];
    let mut size = count;
    loop {
        size = size.div_ceil(width);
        sizes.push(size);
        if size == 1 {
            break;
        }
    }
    let mut start = 0_u64;
    let next = |size: &u64| {
        let own = start;
        start = start.saturating_add(*size);
        own
    };
    sizes.iter().rev().map(next).collect()
}

/// Returns the size in bytes of the index over `count` features, with nodes of `width` children.
pub fn size(count: u64, width: u16) -> u64 {
    let nodes = starts(count, width).last().map_or(0, |last| last.saturating_add(count));
    nodes.saturating_mul(NODE as u64)
}

/// Returns the places, in bytes, of features whose boxes meet a window, in the order of the file; `None`
/// if the index leads beyond itself, or twice to the same.
pub fn search(index: &[u8], count: u64, width: u16, window: &Rect) -> Option<Vec<u64>> {
    let starts = starts(count, width);
    let (_, lower) = starts.split_first()?;
    let leaf = *lower.last()?;
    let read = |number: u64| {
        let at = usize::try_from(number).ok()?.checked_mul(NODE)?;
        Node::read(index.get(at..)?)
    };
    let root = read(0)?;
    let mut firsts = Vec::from_iter(root.meets(window).then_some(root.offset));
    for (i, start) in lower.iter().enumerate() {
        let end = lower.get(i + 1).copied().unwrap_or(leaf.saturating_add(count));
        let (mut next, mut before) = (Vec::new(), *start);
        for first in firsts {
            // Children of later nodes come later.
            if first < before || first >= end {
                return None;
            }
            before = first.saturating_add(u64::from(width.max(2))).min(end);
            for number in first..before {
                let node = read(number)?;
                next.extend(node.meets(window).then_some(node.offset));
            }
        }
        firsts = next;
    }
    firsts.is_sorted().then_some(firsts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_found_as_by_looking_at_all() {
        for count in [1_usize, 2, 16, 17, 256, 257, 1000] {
            let place = |i: usize| DVec2::new((i * 37 % 101) as f64, (i * 53 % 97) as f64);
            let bounds = |i: usize| {
                (i % 11 != 10).then(|| Rect::around([place(i), place(i) + DVec2::ONE])).flatten()
            };
            let all: Vec<Option<Rect>> = (0..count).map(bounds).collect();
            let order = order(&all);
            let index = build(order.iter().zip(0..).map(|(i, at)| (all[*i], at)));
            assert_eq!(index.len() as u64, size(count as u64, WIDTH));
            for (x, y, side) in
                [(0.0, 0.0, 200.0), (20.0, 30.0, 9.0), (50.0, 50.0, 0.0), (-9.0, 0.0, 5.0)]
            {
                let low = DVec2::new(x, y);
                let window = Rect::around([low, low + side]).expect("a window");
                let found = search(&index, count as u64, WIDTH, &window).expect("an index");
                let node = |i: usize| Node::around(all[i], 0);
                let expected: Vec<u64> = order
                    .iter()
                    .zip(0..)
                    .filter(|(i, _)| node(**i).meets(&window))
                    .map(|(_, at)| at)
                    .collect();
                assert_eq!(found, expected, "{count} {window:?}");
            }
        }
        assert_eq!((size(0, 16), size(5, 0), size(1, 16), size(17, 16)), (0, 0, 80, 800));
        // An index that refers to itself is invalid.
        let mut index =
            build([(Rect::around([DVec2::ZERO]), 0), (Rect::around([DVec2::ONE]), 9)].into_iter());
        let window = Rect::around([DVec2::ZERO, DVec2::ONE]).expect("a window");
        assert_eq!(search(&index, 2, WIDTH, &window), Some(vec![0, 9]));
        index[32] = 0;
        assert_eq!(search(&index, 2, WIDTH, &window), None);
        assert_eq!(search(&index[..50], 2, WIDTH, &window), None);
    }
}
