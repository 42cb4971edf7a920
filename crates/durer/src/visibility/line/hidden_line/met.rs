//! The faces already tested for a line, so that a face in many cells is tested once (the mailbox of John Amanatides and
//! Andrew Woo, *A Fast Voxel Traversal Algorithm for Ray Tracing*, Eurographics 1987), and the length of the line that
//! they hide, so that the search ends once all of it is hidden.

/// Limit on the faces that are remembered; of more some are tested again, which changes nothing.
const MOST_SLOTS: usize = 1 << 14;

/// Faces that a line has met, and the parts of it that are hidden for certain.
pub(super) struct Met {
    line: u32,
    /// By the last bits of its number: a line and a face that it has met.
    slots: Vec<[u32; 2]>,
    /// Parts of the line, apart and in order.
    hidden: Vec<[f64; 2]>,
    /// Number of times that something was hidden since the line began.
    times: u32,
}

impl Met {
    /// Creates the memory for lines among this many faces.
    pub fn new(faces: usize) -> Self {
        let count = faces.clamp(1, MOST_SLOTS).next_power_of_two();
        Self { line: 0, slots: vec![[0; 2]; count], hidden: Vec::new(), times: 0 }
    }

    /// Begins another line.
    pub fn begin(&mut self) {
        self.line += 1;
        self.hidden.clear();
        self.times = 0;
    }

    /// Records that the line has met a face; returns whether that may be for the first time.
    pub fn is_first(&mut self, id: u32) -> bool {
        let (mask, met) = (self.slots.len() - 1, [self.line, id]);
        let slot = &mut self.slots[id as usize & mask];
        std::mem::replace(slot, met) != met
    }

    /// Records that a part of the line is hidden.
    pub fn hide(&mut self, from: f64, to: f64) {
        self.times += 1;
        let first = self.hidden.partition_point(|part| part[1] < from);
        let end = self.hidden.partition_point(|part| part[0] <= to);
        let joined = self.hidden[first..end]
            .iter()
            .fold([from, to], |[from, to], part| [from.min(part[0]), to.max(part[1])]);
        self.hidden.splice(first..end, [joined]);
    }

    /// Returns the number of times that something was hidden since the line began.
    pub fn times(&self) -> u32 {
        self.times
    }

    /// Returns whether nothing is hidden yet.
    pub fn hides_nothing(&self) -> bool {
        self.times == 0
    }

    /// Returns whether all from one place of the line to another is hidden, as far as the line
    /// goes.
    pub fn hides(&self, [from, to]: [f64; 2]) -> bool {
        let (from, to) = (from.max(0.0), to.min(1.0));
        let first = self.hidden.partition_point(|part| part[1] < from);
        self.hidden.get(first).is_some_and(|part| part[0] <= from && to <= part[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_are_met_once_a_line() {
        let mut met = Met::new(1000);
        met.begin();
        assert!((0..1000).all(|id| met.is_first(id)));
        assert!(!(0..1000).any(|id| met.is_first(id)));
        met.begin();
        assert!((0..1000).all(|id| met.is_first(id)));
    }

    #[test]
    fn hidden_parts_are_joined() {
        let mut met = Met::new(1);
        let hides = |met: &Met, from, to| met.hides([from, to]);
        for (from, to) in [(0.5, 0.6), (0.1, 0.2), (0.3, 0.4), (0.2, 0.25)] {
            met.hide(from, to);
        }
        assert_eq!(met.hidden, [[0.1, 0.25], [0.3, 0.4], [0.5, 0.6]]);
        assert!(hides(&met, 0.1, 0.25) && hides(&met, 0.3, 0.31) && !hides(&met, 0.2, 0.3));
        met.hide(0.25, 0.5);
        assert_eq!(met.hidden, [[0.1, 0.6]]);
        met.hide(0.0, 1.0);
        assert!(hides(&met, -3.0, 7.0));
        met.begin();
        assert!(met.hides_nothing() && !hides(&met, 0.5, 0.5));
    }
}
