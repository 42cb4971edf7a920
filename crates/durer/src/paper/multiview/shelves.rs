//! Further views beside or below the principal ones, as many to a shelf as it has room for.

use crate::math::DVec2;

/// Contents to place in a room, all in millimetres.
#[derive(Debug, Clone, Copy)]
pub struct Load<'a> {
    /// The principal views.
    pub main: DVec2,
    /// Gaps between and around them, across and down.
    pub main_gaps: DVec2,
    /// The further views.
    pub others: &'a [DVec2],
    /// The least space around a view.
    pub gap: f64,
}

/// Contents of a room, with positions from its upper left corner.
#[derive(Debug, Clone, PartialEq)]
pub struct Shelved {
    /// The part of the room for the principal views, from its corner on.
    pub main: DVec2,
    /// The upper left corners of the further views.
    pub others: Vec<DVec2>,
}

/// Tolerance for rounding, which may make items larger than the room made for them; a nanometre.
const SLACK: f64 = 1e-6;

/// Puts the further views on shelves below the principal ones, or, `beside`, in columns right of them; `None`
/// if there is no room.
pub fn shelved(load: &Load, room: DVec2, beside: bool) -> Option<Shelved> {
    let turn = |p: DVec2| if beside { DVec2::new(p.y, p.x) } else { p };
    let others: Vec<DVec2> = load.others.iter().map(|p| turn(*p)).collect();
    let (main, main_gaps) = (turn(load.main), turn(load.main_gaps));
    let turned = Load { main, main_gaps, others: &others, gap: load.gap };
    let found = below(&turned, turn(room))?;
    let others = found.others.into_iter().map(turn).collect();
    Some(Shelved { main: turn(found.main), others })
}

fn below(load: &Load, room: DVec2) -> Option<Shelved> {
    let Load { main, main_gaps, others, gap } = *load;
    let shelves = filled(others, room.x, gap)?;
    let heights: f64 = shelves.iter().map(|s| height(s, others)).sum();
    let gaps = main_gaps.y + shelves.len() as f64;
    let left = room - DVec2::new(main.x, main.y + heights);
    let least = DVec2::new(main_gaps.x, gaps) * gap;
    if (left + SLACK).cmplt(least).any() {
        return None;
    }
    let space = left.y / gaps;
    let main_room = DVec2::new(room.x, main.y + main_gaps.y * space);
    let mut at = vec![DVec2::ZERO; others.len()];
    let mut top = main_room.y;
    for shelf in &shelves {
        let widths: f64 = shelf.iter().map(|&i| others[i].x).sum();
        let between = (room.x - widths) / (shelf.len() as f64 + 1.0);
        let mut x = between;
        for &i in shelf {
            at[i] = DVec2::new(x, top + (height(shelf, others) - others[i].y) * 0.5);
            x += others[i].x + between;
        }
        top += height(shelf, others) + space;
    }
    Some(Shelved { main: main_room, others: at })
}

fn height(shelf: &[usize], sizes: &[DVec2]) -> f64 {
    shelf.iter().map(|&i| sizes[i].y).fold(0.0, f64::max)
}

/// Fills shelves in order; `None` if an item is too long for any.
fn filled(sizes: &[DVec2], length: f64, gap: f64) -> Option<Vec<Vec<usize>>> {
    let mut shelves: Vec<Vec<usize>> = Vec::new();
    let mut used = f64::INFINITY;
    for (i, size) in sizes.iter().enumerate() {
        if used + size.x + gap > length + SLACK {
            shelves.push(Vec::new());
            used = gap;
        }
        used += size.x + gap;
        if used > length + SLACK {
            return None;
        }
        shelves.last_mut()?.push(i);
    }
    Some(shelves)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shelves_lie_below_or_beside_and_keep_their_gaps() {
        let others = [DVec2::new(40.0, 20.0), DVec2::new(30.0, 10.0), DVec2::new(60.0, 30.0)];
        let load = Load {
            main: DVec2::new(80.0, 50.0),
            main_gaps: DVec2::splat(2.0),
            others: &others,
            gap: 10.0,
        };
        let found = shelved(&load, DVec2::new(110.0, 140.0), false).unwrap();
        // Two on the first shelf, one on the second; 40 mm are left for four gaps.
        assert_eq!(found.main, DVec2::new(110.0, 70.0));
        let gap = (110.0 - 70.0) / 3.0;
        assert_eq!(found.others[0], DVec2::new(gap, 70.0));
        assert!(found.others[1].abs_diff_eq(DVec2::new(gap + 40.0 + gap, 75.0), 1e-9));
        assert_eq!(found.others[2], DVec2::new(25.0, 100.0));
        assert_eq!(shelved(&load, DVec2::new(110.0, 139.0), false), None);
        let found = shelved(&load, DVec2::new(250.0, 70.0), true).unwrap();
        assert_eq!((found.main.y, found.others.len()), (70.0, 3));
        assert!(found.others.iter().all(|p| p.x >= found.main.x));
    }
}
