//! Continuation of creases that become blunter.
//!
//! An edge of a body that is gradually rounded off falls below any crease angle somewhere. As in the hysteresis of John
//! Canny, *A computational approach to edge detection*, IEEE Transactions on Pattern Analysis and Machine Intelligence,
//! 1986, a crease that began above the angle continues through weaker edges, down to a second angle, as long as it is
//! straight. O(n log n) for n edges that are sharp or weak.

use super::edge_lines::{EdgeLine, Sharpness};
use crate::math::{DVec3, by_coordinates};
use crate::target::drawing::LineClass;

/// The cosine of the turn up to which an edge continues in the next: 45°.
const ON: f64 = 0.707;

/// Number of edges at a point from which none is continued in another: their square would be too
/// much.
const HUB: usize = 64;

/// No end of a line.
const NONE: u32 = u32::MAX;

/// Returns the lines without the weak creases that go on from no sharp edge; those are of class
/// `otherwise`, or left out. Does not depend on the order of the lines.
pub(super) fn connected(
    mut lines: Vec<EdgeLine>,
    points: &[DVec3],
    otherwise: Option<LineClass>,
) -> Vec<EdgeLine> {
    let is_open = |l: &EdgeLine| l.class == LineClass::Crease && l.sharpness == Sharpness::Weak;
    if !lines.iter().any(is_open) {
        return lines;
    }
    let partner = partners(&lines, points);
    let mut kept: Vec<bool> = lines.iter().map(|l| l.sharpness == Sharpness::Sharp).collect();
    for start in 0..partner.len() as u32 {
        if lines[start as usize / 2].sharpness != Sharpness::Sharp {
            continue;
        }
        // Out of this end, into the next line's, out of its other one.
        let mut next = partner[start as usize];
        while next != NONE && !kept[next as usize / 2] {
            kept[next as usize / 2] = true;
            next = partner[next as usize ^ 1];
        }
    }
    let mut kept = kept.into_iter();
    lines.retain_mut(|line| {
        let kept = kept.next() == Some(true);
        if kept || !is_open(line) {
            return true;
        }
        otherwise.inspect(|class| line.class = *class).is_some()
    });
    lines
}

/// The end of a line at a vertex.
struct End {
    vertex: u32,
    /// Unit vector to the other end.
    away: DVec3,
    /// Line · 2 + which end.
    end: u32,
}

/// Returns, for each end of a line (line · 2 + which end), the end that it goes on in, if each is the straightest way
/// on for the other.
fn partners(lines: &[EdgeLine], points: &[DVec3]) -> Vec<u32> {
    let mut ends = Vec::new();
    for (line, i) in lines.iter().zip(0u32..).filter(|(l, _)| l.sharpness != Sharpness::Blunt) {
        for (k, vertex) in line.ends.into_iter().enumerate() {
            let away = points[line.ends[1 - k] as usize] - points[vertex as usize];
            ends.push(End { vertex, away: away.normalize_or_zero(), end: 2 * i + k as u32 });
        }
    }
    // Around a vertex by direction: the choice among equally straight ones must not depend on the order of the lines.
    ends.sort_unstable_by(|a, b| {
        a.vertex
            .cmp(&b.vertex)
            .then_with(|| by_coordinates(&a.away, &b.away))
            .then(a.end.cmp(&b.end))
    });
    let mut partner = vec![NONE; lines.len() * 2];
    for around in ends.chunk_by(|a, b| a.vertex == b.vertex).filter(|a| a.len() <= HUB) {
        for (i, end) in around.iter().enumerate() {
            let on = straightest(around, i).filter(|&k| straightest(around, k) == Some(i));
            partner[end.end as usize] = on.map_or(NONE, |k| around[k].end);
        }
    }
    partner
}

/// Returns the other end that continues most nearly straight, if any continues.
fn straightest(around: &[End], i: usize) -> Option<usize> {
    let mut best = (ON, None);
    for (k, other) in around.iter().enumerate().filter(|(k, _)| *k != i) {
        let on = -around[i].away.dot(other.away);
        if on > best.0 {
            best = (on, Some(k));
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::super::edge_lines::Outside;
    use super::*;
    use Sharpness::{Blunt, Sharp, Weak};

    /// Returns vertices 0 … 4 in a row along x, 5 beside 2.
    fn points() -> Vec<DVec3> {
        let row = (0..5).map(|x| DVec3::new(f64::from(x), 0.0, 0.0));
        row.chain([DVec3::new(2.5, 1.0, 0.0)]).collect()
    }

    fn line(ends: [u32; 2], sharpness: Sharpness) -> EdgeLine {
        EdgeLine {
            ends,
            class: LineClass::Crease,
            items: [0, 1],
            smooth: false,
            sharpness,
            outside: Outside::Both,
        }
    }

    fn kept(lines: &[EdgeLine]) -> Vec<[u32; 2]> {
        let mut ends: Vec<_> =
            connected(lines.to_vec(), &points(), None).iter().map(|l| l.ends).collect();
        ends.sort_unstable();
        ends
    }

    #[test]
    fn creases_go_on_straight_until_they_are_blunt() {
        let row = |s: [Sharpness; 4]| [0, 1, 2, 3].map(|i| line([i, i + 1], s[i as usize]));
        let goes_on = row([Sharp, Weak, Weak, Blunt]);
        assert_eq!(kept(&goes_on[..3]), [[0, 1], [1, 2], [2, 3]]);
        let mut reversed = goes_on[..3].to_vec();
        reversed.reverse();
        assert_eq!(kept(&reversed), kept(&goes_on[..3]));
        // A weak edge between sharp ones across a gap belongs to the sharp edge on its own side only.
        assert_eq!(kept(&[goes_on[0], goes_on[1], line([3, 4], Weak)]), [[0, 1], [1, 2]]);
        assert_eq!(kept(&row([Weak; 4])), [[0u32; 2]; 0]);
        // A branch is no continuation: the row itself continues straighter.
        let branch = [line([1, 2], Sharp), line([2, 3], Sharp), line([2, 5], Weak)];
        assert_eq!(kept(&branch), [[1, 2], [2, 3]]);
    }

    #[test]
    fn weak_creases_that_are_left_are_wires_where_those_are_wanted() {
        let left = connected(vec![line([0, 1], Weak)], &points(), Some(LineClass::Wire));
        assert_eq!(left.iter().map(|l| l.class).collect::<Vec<_>>(), [LineClass::Wire]);
    }
}
