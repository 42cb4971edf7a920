//! Corners of faces: which position, texture coordinate and normal each has, stored once per triple.

/// Value in place of an index for "none".
pub(crate) const NONE: u32 = u32::MAX;

/// Triples looked through before one is stored again. Meshes have a handful per position; the
/// bound keeps a hostile file from making the search quadratic.
const MAX_SEARCH: usize = 64;

/// A corner: numbers of its position, texture coordinate and normal, the last two may be [`NONE`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Corner {
    pub position: u32,
    pub tex_coord: u32,
    pub normal: u32,
}

/// Vertex numbers of corners. While no corner has a texture coordinate or normal, vertices are the
/// file's positions; from the first that has, each different triple is a vertex.
#[derive(Debug, Default)]
pub(crate) struct Corners {
    /// Vertex numbers, in the order of the corners.
    pub indices: Vec<u32>,
    /// Per vertex: its triple; empty while vertices are positions.
    pub keys: Vec<Corner>,
    keyed: bool,
    /// Per position: the vertex stored last for it.
    head: Vec<u32>,
    /// Per vertex: the one stored before it for the same position.
    next: Vec<u32>,
}

impl Corners {
    /// Returns whether vertices are triples.
    pub fn keyed(&self) -> bool {
        self.keyed
    }

    /// Adds a corner.
    pub fn push(&mut self, corner: Corner) {
        let vertex = self.vertex(corner);
        self.indices.push(vertex);
    }

    /// Adds the corner at `at` again.
    pub fn repeat(&mut self, at: usize) {
        if let Some(&vertex) = self.indices.get(at) {
            self.indices.push(vertex);
        }
    }

    fn vertex(&mut self, corner: Corner) -> u32 {
        if !self.keyed {
            if corner.tex_coord == NONE && corner.normal == NONE {
                return corner.position;
            }
            self.start_keys();
        }
        self.find_or_add(corner)
    }

    /// Turns the positions used so far into triples.
    fn start_keys(&mut self) {
        self.keyed = true;
        let mut indices = std::mem::take(&mut self.indices);
        for index in &mut indices {
            *index = self.find_or_add(Corner { position: *index, tex_coord: NONE, normal: NONE });
        }
        self.indices = indices;
    }

    fn find_or_add(&mut self, corner: Corner) -> u32 {
        let slot = corner.position as usize;
        if self.head.len() <= slot {
            self.head.resize(slot + 1, NONE);
        }
        let mut at = self.head.get(slot).copied().unwrap_or(NONE);
        for _ in 0..MAX_SEARCH {
            match self.keys.get(at as usize) {
                Some(key) if *key == corner => return at,
                Some(_) => at = self.next.get(at as usize).copied().unwrap_or(NONE),
                None => break,
            }
        }
        let vertex = self.keys.len() as u32;
        self.keys.push(corner);
        if let Some(head) = self.head.get_mut(slot) {
            self.next.push(std::mem::replace(head, vertex));
        }
        vertex
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_triples_are_one_vertex_also_after_the_change() {
        let mut c = Corners::default();
        let corner = |position, tex_coord| Corner { position, tex_coord, normal: NONE };
        for p in [5, 6, 7] {
            c.push(corner(p, NONE));
        }
        assert!(!c.keyed() && c.indices == [5, 6, 7]);
        c.push(corner(6, 0));
        assert_eq!(c.indices, [0, 1, 2, 3]);
        for (p, t) in [(6, 0), (6, NONE), (6, 1)] {
            c.push(corner(p, t));
        }
        c.repeat(1);
        assert_eq!(c.indices, [0, 1, 2, 3, 3, 1, 4, 1]);
        assert_eq!(c.keys.len(), 5);
    }
}
