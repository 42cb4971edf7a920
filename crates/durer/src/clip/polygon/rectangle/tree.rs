//! Boxes within boxes, to find the nearby ones of many items.

use crate::math::Rect;
use std::ops::Range;

/// Boxes around all items, around their halves, and so on down to runs of a few; each is followed by
/// those within it.
#[derive(Debug, Clone, Default)]
pub(in crate::clip::polygon) struct Tree {
    nodes: Vec<Node>,
}

#[derive(Debug, Clone)]
pub(in crate::clip::polygon) struct Node {
    pub(in crate::clip::polygon) around: Rect,
    pub(in crate::clip::polygon) items: Range<usize>,
    /// The index of the first node that is not within it.
    next: usize,
}

impl Node {
    /// Returns whether it is not divided further.
    pub(in crate::clip::polygon) fn is_last(&self) -> bool {
        self.items.len() <= Tree::RUN
    }
}

impl Tree {
    /// Number of items that are not divided further: examining them costs about as much as
    /// examining two boxes.
    pub(in crate::clip::polygon) const RUN: usize = if cfg!(test) { 2 } else { 16 };

    /// Creates a tree over items numbered from 0; `around` returns the box around some of them.
    pub(in crate::clip::polygon) fn new(
        count: usize,
        around: &impl Fn(Range<usize>) -> Option<Rect>,
    ) -> Self {
        let mut tree = Self::default();
        tree.add(0..count, around);
        tree
    }

    /// Adds the box around some items and the boxes within; the depth is the logarithm of their number.
    fn add(
        &mut self,
        items: Range<usize>,
        around: &impl Fn(Range<usize>) -> Option<Rect>,
    ) -> Option<Rect> {
        let index = self.nodes.len();
        let some = items.start..items.end.min(items.start + Self::RUN);
        self.nodes.push(Node { around: around(some)?, items: items.clone(), next: index + 1 });
        if items.len() > Self::RUN {
            let half = items.start + items.len() / 2;
            let halves = [self.add(items.start..half, around)?, self.add(half..items.end, around)?];
            self.nodes[index].around =
                Rect::around(halves.into_iter().flat_map(|b| [b.min(), b.max()]))?;
            self.nodes[index].next = self.nodes.len();
        }
        Some(self.nodes[index].around)
    }

    /// Returns the box around everything; `None` if there is nothing.
    pub(in crate::clip::polygon) fn around(&self) -> Option<Rect> {
        self.nodes.first().map(|node| node.around)
    }

    /// Goes through the boxes, and through those within a box where the answer is yes.
    pub(in crate::clip::polygon) fn visit(&self, mut look: impl FnMut(&Node) -> bool) {
        let mut next = 0;
        while let Some(node) = self.nodes.get(next) {
            next = if look(node) { next + 1 } else { node.next };
        }
    }
}
