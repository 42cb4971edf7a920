//! Short lines that end in the open are cut back.
//!
//! On a mesh the silhouette of a round surface is a zigzag of edges: it leaves spurs where it turns into the surface,
//! and gaps where one edge hides the next. Creases flicker where a rounding is about as sharp as the crease angle. A
//! draughtsman draws none of this. So tips of such lines that nearly meet are joined, and those that end in the open
//! are cut back to the next junction, or left out, if that is near. O(n) for lines that are not crowded.

use super::chain::{Walk, point, walks};
use super::overlap::distance;
use super::page::GridPoint;
use super::piece::Piece;
use super::table::Table;
use crate::math::DVec2;
use crate::sorting::CompactSort;
use crate::target::drawing::LineClass;

/// Number of rounds: the line at which a stub ended may end in the open without it, and joined lines
/// may continue further, so all is repeated.
const ROUNDS: usize = 3;

/// A stub of so few edges of the mesh may be [`COARSE_LENGTH`] times as long: on a coarse mesh an
/// edge is.
const COARSE: usize = 3;
const COARSE_LENGTH: f64 = 4.0;

/// A hidden stub of so few edges that turns back may be this many times as long: at a cusp, outlines of few facets go
/// to and fro behind each other, and never come to an end.
const BACK_LENGTH: f64 = 12.0;

/// The cosine of a turn back: 135°.
const BACK: f64 = -0.707;

/// Gaps up to this part of a stub are closed, whichever line continues the other.
const GAP: f64 = 0.3;

/// Gaps up to this many stubs are closed where a line goes straight on beyond, and is longer than the gap.
const STRAIGHT_GAP: f64 = 1.5;

/// The cosine of the turn at either side of such a gap: 12°.
const STRAIGHT: f64 = 0.978;

/// The cosine within which two lines run to meet each other: 30°. On the two sides of a facet outlines may
/// pass each other a little.
const HEAD_ON: f64 = 0.866;

/// Part of a stub within which lines meet on paper: a pen's stroke is as wide.
const MEETS: f64 = 0.1;

/// A line that another leaves so near its tip, in parts of a stub, ends there, if the other runs on beside it: where
/// an outline changes from one edge to the next, the edges of a round rim pass each other.
const BESIDE: f64 = 0.4;

/// Silhouettes and creases shorter than this part of a stub are dust, sharp or not: they do not hold
/// each other.
const DUST: f64 = 0.3;

/// Returns the pieces without stubs up to `length` steps; what is within `touch` steps touches.
pub(super) fn without_stubs(mut pieces: Vec<Piece>, length: f64, touch: f64) -> Vec<Piece> {
    let touch = touch.max(4.0);
    for _ in 0..ROUNDS {
        let Some(mut lines) = Lines::new(&pieces, length, touch) else { break };
        let gaps = lines.gaps();
        pieces.extend_from_slice(&gaps);
        let Some(mut lines) = Lines::new(&pieces, length, touch) else { break };
        let cuts = lines.stubs();
        if cuts.is_empty() && gaps.is_empty() {
            break;
        }
        for cut in cuts {
            match cut {
                Cut::All(piece) => pieces[piece].ends[1] = pieces[piece].ends[0],
                Cut::Until(end, at) => pieces[end as usize / 2].ends[end as usize & 1] = at,
            }
        }
        pieces.retain(|p| p.ends[0] != p.ends[1]);
    }
    pieces
}

/// Treatment of a piece.
enum Cut {
    /// It is left out.
    All(usize),
    /// An end moves to here.
    Until(u32, GridPoint),
}

/// The lines of a drawing, chained and by place.
struct Lines<'a> {
    pieces: &'a [Piece],
    walks: Vec<Walk>,
    /// True if the line that a piece belongs to is dust.
    dust: Vec<bool>,
    table: Table,
    length: f64,
    touch: f64,
}

/// The end of a line that nothing else touches.
struct Tip {
    end: u32,
    at: GridPoint,
    /// Point of its line, some way back.
    from: GridPoint,
    /// The length of its line.
    length: f64,
}

impl<'a> Lines<'a> {
    fn new(pieces: &'a [Piece], length: f64, touch: f64) -> Option<Self> {
        let mut table = Table::new(pieces, touch)?;
        for (piece, i) in pieces.iter().zip(0..) {
            table.enter(piece.ends, touch, i);
        }
        let walks = walks(pieces);
        let mut dust = vec![false; pieces.len()];
        for walk in &walks {
            let piece = |end: &u32| &pieces[*end as usize / 2];
            let class = piece(&walk.ends[0]).class;
            if matches!(class, LineClass::Silhouette | LineClass::Crease)
                && walk.ends.iter().map(|e| piece(e).length()).sum::<f64>() < length * DUST
            {
                walk.ends.iter().for_each(|e| dust[*e as usize / 2] = true);
            }
        }
        Some(Self { pieces, walks, dust, table, length, touch })
    }

    /// Returns the open walks, each from both sides, of silhouettes and creases.
    fn open_walks(&self) -> Vec<[Vec<u32>; 2]> {
        let class = |w: &Walk| self.pieces[w.ends[0] as usize / 2].class;
        let outlines = |w: &&Walk| matches!(class(w), LineClass::Silhouette | LineClass::Crease);
        let open = self.walks.iter().filter(|w| !w.closed).filter(outlines);
        let back = |w: &Walk| w.ends.iter().rev().map(|e| e ^ 1).collect();
        open.map(|w| [w.ends.clone(), back(w)]).collect()
    }

    fn length_of(&self, ends: &[u32]) -> f64 {
        ends.iter().map(|e| self.pieces[*e as usize / 2].length()).sum()
    }

    fn may_end_anywhere(&self, end: u32) -> bool {
        let i = end as usize / 2;
        self.dust[i] || self.pieces[i].may_end_anywhere()
    }

    fn stubs(&mut self) -> Vec<Cut> {
        let rings = self.walks.iter().filter(|w| w.closed).flat_map(|w| &w.ends);
        let pieces = rings.map(|e| *e as usize / 2);
        let mut cuts: Vec<Cut> = pieces.filter(|&i| self.dust[i]).map(Cut::All).collect();
        let meets = self.touch.max(self.length * MEETS);
        for ways in self.open_walks() {
            // Sharp edges continue; short isolated ones come from faces that are hardly turned.
            let alone = self.length_of(&ways[0]) <= self.length
                && ways.iter().all(|ends| self.is_in_the_open(ends, self.length));
            if alone {
                cuts.extend(ways[0].iter().map(|e| Cut::All(*e as usize / 2)));
                continue;
            }
            for ends in &ways {
                if self.may_end_anywhere(ends[0]) && self.is_in_the_open(ends, meets) {
                    self.cut_back(ends, &mut cuts);
                } else if self.is_in_the_open(ends, self.touch)
                    && let Some(at) = self.left_beside(ends[0], meets)
                {
                    cuts.push(Cut::Until(ends[0], at));
                }
            }
        }
        cuts
    }

    /// Returns the point at which another line leaves the piece with this tip, if it runs on to the tip at
    /// most `aside` beside the piece, so that nothing is missed between.
    fn left_beside(&mut self, end: u32, aside: f64) -> Option<GridPoint> {
        let (pieces, touch, most) = (self.pieces, self.touch, self.length * BESIDE);
        let piece = &pieces[end as usize / 2];
        let tip = point(pieces, end);
        let mut first: Option<(f64, GridPoint)> = None;
        self.table.cells(&[tip, tip], most, |near| {
            for &i in near.iter().filter(|i| **i != end / 2) {
                let other = &pieces[i as usize];
                if !counts(piece, other) || distance(tip, other) > aside {
                    continue;
                }
                for p in other.ends.into_iter().filter(|p| distance(*p, piece) <= touch) {
                    let along = tip.distance(p);
                    let leaves = along > touch && along <= most && along < piece.length() - touch;
                    if leaves && first.is_none_or(|f| (along, p) < f) {
                        first = Some((along, p));
                    }
                }
            }
        });
        first.map(|f| f.1)
    }

    /// Returns whether no other line lies within `radius` of the first point of a walk.
    fn is_in_the_open(&mut self, ends: &[u32], radius: f64) -> bool {
        let tip = point(self.pieces, ends[0]);
        // Pieces of the walk that are near only because they are short.
        let mut own = Vec::new();
        for &end in ends {
            own.push(end / 2);
            if point(self.pieces, end ^ 1).distance(tip) > 2.0 * radius {
                break;
            }
        }
        let (pieces, dust) = (self.pieces, &self.dust);
        let first = ends[0] as usize / 2;
        let mut open = true;
        self.table.cells(&[tip, tip], radius, |near| {
            let touches = |&&i: &&u32| {
                let other = &pieces[i as usize];
                counts(&pieces[first], other)
                    && !(dust[first] && dust[i as usize])
                    && distance(tip, other) <= radius
                    && !own.contains(&i)
            };
            open = near.iter().find(touches).is_none();
        });
        open
    }

    /// Removes the part between the tip of a walk and the next junction, if that is near.
    fn cut_back(&mut self, ends: &[u32], cuts: &mut Vec<Cut>) {
        let (turn, length) = (self.turn_back(ends), self.length);
        let longest = |k: usize, ends_here: bool| match turn {
            _ if k >= COARSE => length,
            Some(turn) if !ends_here || turn <= k => length * BACK_LENGTH,
            _ => length * COARSE_LENGTH,
        };
        let mut sum = 0.0;
        for (k, &end) in ends.iter().enumerate() {
            let piece = &self.pieces[end as usize / 2];
            if !self.may_end_anywhere(end) {
                return;
            }
            let junction = self.junction(ends, k);
            sum += junction.map_or(piece.length(), |j| j.0);
            if sum > longest(k, junction.is_some()) {
                return;
            }
            if let Some((_, at)) = junction {
                cuts.extend(ends[..k].iter().map(|e| Cut::All(*e as usize / 2)));
                return cuts.push(Cut::Until(end, at));
            }
        }
        cuts.extend(ends.iter().map(|e| Cut::All(*e as usize / 2)));
    }

    /// Returns the piece of a walk before which it turns back, if it is hidden and does so within a few pieces.
    fn turn_back(&self, ends: &[u32]) -> Option<usize> {
        if self.pieces[*ends.first()? as usize / 2].invisibility == 0 {
            return None;
        }
        let along = |k: usize| {
            let [x, y] = point(self.pieces, ends[k] ^ 1).minus(point(self.pieces, ends[k]));
            DVec2::new(x as f64, y as f64).normalize_or_zero()
        };
        (1..ends.len().min(COARSE)).find(|k| along(k - 1).dot(along(*k)) < BACK)
    }

    /// Returns the first place along a piece of a walk where another line ends on it, or where it ends on
    /// another line.
    fn junction(&mut self, ends: &[u32], k: usize) -> Option<(f64, GridPoint)> {
        let (pieces, touch) = (self.pieces, self.touch);
        let piece = &pieces[ends[k] as usize / 2];
        let (start, far) = (point(pieces, ends[k]), point(pieces, ends[k] ^ 1));
        let own = &ends[k.saturating_sub(1)..(k + 2).min(ends.len())];
        let mut first: Option<(f64, GridPoint)> = None;
        self.table.cells(&piece.ends, touch, |near| {
            for &i in near {
                let other = &pieces[i as usize];
                if own.iter().any(|e| e / 2 == i) || !counts(piece, other) {
                    continue;
                }
                let on_it = other.ends.map(|p| (p, distance(p, piece)));
                let here = on_it.into_iter().filter(|o| o.1 <= touch).map(|o| o.0);
                let there = (distance(far, other) <= touch).then_some(far);
                for at in here.chain(there) {
                    let along = start.distance(at);
                    // The tip itself touches nothing.
                    let away = k > 0 || along > touch;
                    if away && first.is_none_or(|f| (along, at) < f) {
                        first = Some((along, at));
                    }
                }
            }
        });
        first
    }

    /// Returns pieces between tips that meet, or that are near each other and go on in each other's direction.
    fn gaps(&mut self) -> Vec<Piece> {
        let most = self.length * STRAIGHT_GAP;
        let mut tips = Vec::new();
        for ends in self.open_walks().into_iter().flatten() {
            if self.is_in_the_open(&ends, self.touch) {
                let length = self.length_of(&ends);
                let at = point(self.pieces, ends[0]);
                let mut back = ends.iter().map(|e| point(self.pieces, e ^ 1));
                let from = back.clone().find(|p| p.distance(at) >= self.length * GAP);
                let from = from.or(back.next_back()).unwrap_or(at);
                tips.push(Tip { end: ends[0], at, from, length });
            }
        }
        tips.compact_sort_by_key(|t| (t.at, t.end));
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for (i, a) in tips.iter().enumerate() {
            let near = |b: &&Tip| b.at.minus(a.at)[0] as f64 <= most;
            for (k, b) in tips[i + 1..].iter().take_while(near).enumerate() {
                if a.at.distance(b.at) <= most && self.go_on(a, b) {
                    pairs.push((a.at.distance(b.at), i, i + 1 + k));
                }
            }
        }
        pairs.compact_sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut used = vec![false; tips.len()];
        let mut found = Vec::new();
        for (_, a, b) in pairs {
            if !used[a] && !used[b] {
                (used[a], used[b]) = (true, true);
                let like = self.pieces[tips[a].end as usize / 2];
                found.push(Piece { ends: [tips[a].at, tips[b].at], ..like });
            }
        }
        found
    }

    /// Returns whether one line goes on in the other: of one class, with turns below 60°, or straight
    /// where it is further; or past its tip, where both run to meet each other.
    fn go_on(&self, a: &Tip, b: &Tip) -> bool {
        let of = |t: &Tip| &self.pieces[t.end as usize / 2];
        let (p, q) = (of(a), of(b));
        let same = (p.class, p.invisibility) == (q.class, q.invisibility);
        let [gx, gy] = b.at.minus(a.at).map(|d| d as f64);
        let gap = a.at.distance(b.at);
        let far = gap > self.length * GAP;
        let ahead = |t: &Tip, sign: f64| {
            let from = if far { t.from } else { point(self.pieces, t.end ^ 1) };
            let [x, y] = t.at.minus(from).map(|d| d as f64 * sign);
            let cosine = (x * gx + y * gy) / ((x * x + y * y) * (gx * gx + gy * gy)).sqrt();
            if far { cosine > STRAIGHT && t.length > gap } else { cosine > 0.5 }
        };
        let heading = |t: &Tip| t.at.minus(t.from).map(|d| d as f64 / t.at.distance(t.from));
        let ([ax, ay], [bx, by]) = (heading(a), heading(b));
        let long = a.length.min(b.length) > self.length;
        let past = long && !far && ax * bx + ay * by < -HEAD_ON;
        let meet = gap <= self.length * MEETS;
        let on = meet || past || (ahead(a, 1.0) && ahead(b, -1.0));
        same && a.end / 2 != b.end / 2 && a.at != b.at && on
    }
}

/// Returns whether another piece counts at an end of a piece: a visible line ends in the open, whatever is hidden
/// there.
fn counts(of: &Piece, other: &Piece) -> bool {
    of.invisibility > 0 || other.invisibility == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(a: [i32; 2], b: [i32; 2], smooth: bool) -> Piece {
        let ends = [a, b].map(|[x, y]| GridPoint { x, y });
        Piece { ends, class: LineClass::Silhouette, invisibility: 0, smooth }
    }

    fn ends(pieces: &[Piece]) -> Vec<[i32; 4]> {
        pieces.iter().map(|p| [p.ends[0].x, p.ends[0].y, p.ends[1].x, p.ends[1].y]).collect()
    }

    #[test]
    fn spurs_are_cut_back_to_the_junction() {
        // Both ends of the first are held; the second ends past the junction with the third.
        let frame = |smooth| {
            vec![
                piece([0, -9000], [0, 9000], false),
                piece([0, 0], [50_000, 0], smooth),
                piece([49_500, 0], [49_500, -60_000], false),
            ]
        };
        let cut = without_stubs(frame(true), 1000.0, 10.0);
        assert_eq!(ends(&cut)[1], [0, 0, 49_500, 0]);
        // Sharp edges end where they end; and longer ones are kept.
        assert_eq!(without_stubs(frame(false), 1000.0, 10.0), frame(false));
        assert_eq!(without_stubs(frame(true), 100.0, 10.0), frame(true));
    }

    #[test]
    fn hidden_tails_that_turn_back_are_left_out() {
        let hidden = |a, b| Piece { invisibility: 1, ..piece(a, b, true) };
        let frame = piece([-900_000, 0], [900_000, 0], false);
        let tail = |second| vec![frame, hidden([0, 0], [50_000, 30_000]), second];
        let back = tail(hidden([50_000, 30_000], [-20_000, 20_000]));
        assert_eq!(without_stubs(back.clone(), 12_000.0, 10.0), [frame]);
        // Lines with a continuation are kept, and so are longer lines and those that are visible on their own.
        let on = tail(hidden([50_000, 30_000], [100_000, 90_000]));
        assert_eq!(without_stubs(on.clone(), 12_000.0, 10.0), on);
        assert_eq!(without_stubs(back.clone(), 9000.0, 10.0), back);
        let seen: Vec<Piece> = back.iter().map(|p| Piece { invisibility: 0, ..*p }).collect();
        assert_eq!(without_stubs(seen.clone(), 12_000.0, 10.0), seen);
    }

    #[test]
    fn sharp_edges_that_pass_each_other_end_where_one_leaves_the_other() {
        let rim = |aside: i32| {
            let next = piece([100_000, 0], [150_000, aside * 10], false);
            vec![piece([0, 0], [105_000, 0], false), next]
        };
        let cut = without_stubs(rim(1000), 15_000.0, 10.0);
        assert_eq!(ends(&cut)[0], [0, 0, 100_000, 0]);
        assert_eq!(chains_of(&cut), 1);
        // A greater distance to the side makes a visible corner, a greater distance ahead a visible line.
        assert_eq!(without_stubs(rim(5000), 15_000.0, 10.0), rim(5000));
        assert_eq!(without_stubs(rim(1000), 10_000.0, 10.0), rim(1000));
    }

    #[test]
    fn gaps_are_closed_and_dust_goes() {
        let far = 1_000_000;
        let mut pieces = vec![
            piece([0, 0], [far, 0], true),
            piece([far + 2000, 0], [2 * far, 0], true),
            piece([far, far], [far + 900, far], true),
            piece([far + 950, far], [far + 990, far + 100], true),
        ];
        let found = without_stubs(pieces.clone(), 10_000.0, 10.0);
        let gap = [far, 0, far + 2000, 0];
        assert_eq!(ends(&found), [ends(&pieces)[0], ends(&pieces)[1], gap]);
        // A line that supports another is not removed as dust.
        pieces.truncate(1);
        pieces.push(Piece { class: LineClass::Crease, ..piece([far, 0], [far + 500, 500], true) });
        let found = without_stubs(pieces, 10_000.0, 10.0);
        assert_eq!(ends(&found)[0], [0, 0, far, 0]);
    }

    #[test]
    fn dashes_of_one_line_are_joined() {
        // An outline along a face that is nearly edge-on; sharp, as at a rim.
        let dash = |k: i32, up: i32| piece([k * 30_000, up], [k * 30_000 + 18_000, up], false);
        let dashes = [0, 1, 2, 3].map(|k| dash(k, 0)).to_vec();
        let found = without_stubs(dashes.clone(), 10_000.0, 10.0);
        assert_eq!(chains_of(&found), 1, "{found:?}");
        // Farther apart than the line is long, or to the side, they are separate lines.
        let apart = vec![dash(0, 0), dash(2, 0)];
        assert_eq!(chains_of(&without_stubs(apart, 10_000.0, 10.0)), 2);
        let short = vec![piece([0, 0], [12_000, 0], false), piece([26_000, 0], [38_000, 0], false)];
        assert_eq!(chains_of(&without_stubs(short, 10_000.0, 10.0)), 2);
        let aside = vec![dash(0, 0), dash(1, 6000)];
        assert_eq!(chains_of(&without_stubs(aside, 10_000.0, 10.0)), 2);
    }

    #[test]
    fn lines_that_pass_each_other_at_their_tips_are_joined() {
        let smooth = |a, b| piece(a, b, true);
        let pieces = vec![smooth([0, 0], [500_000, 0]), smooth([498_000, 1500], [900_000, 30_000])];
        assert_eq!(chains_of(&without_stubs(pieces.clone(), 10_000.0, 10.0)), 1);
        // Side by side, both from the left, they are two.
        let beside = vec![pieces[0], smooth([1000, 60_000], [498_000, 1500])];
        assert_eq!(chains_of(&without_stubs(beside, 10_000.0, 10.0)), 2);
        // A short piece is no continuation.
        let short = piece([507_000, 1900], [498_000, 1500], false);
        let sharp = vec![piece([0, 0], [500_000, 0], false), short];
        assert_eq!(chains_of(&without_stubs(sharp, 10_000.0, 10.0)), 2);
    }

    fn chains_of(pieces: &[Piece]) -> usize {
        super::super::chain::chains(pieces).len()
    }

    #[test]
    fn sharp_specks_are_left_out_where_nothing_is_near() {
        let line = piece([0, 0], [900_000, 0], false);
        let alone = piece([400_000, 50_000], [404_000, 54_000], false);
        let near = piece([400_000, 4000], [404_000, 8000], false);
        let found = without_stubs(vec![line, alone, near], 10_000.0, 10.0);
        assert_eq!(found, [line, near]);
    }

    #[test]
    fn short_lines_in_the_open_are_left_out() {
        let ring = |k: i32| piece([k, 0], [k + 9000, 9000], true);
        let lines = vec![piece([-90_000, 0], [90_000, 0], false), ring(200), ring(300_000)];
        let found = without_stubs(lines.clone(), 10_000.0, 10.0);
        assert_eq!(found, lines[..1]);
        assert_eq!(without_stubs(lines.clone(), 1000.0, 10.0), lines);
    }
}
