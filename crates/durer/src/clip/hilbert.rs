//! The order of squares along the curve of David Hilbert ("Über die stetige Abbildung einer Linie auf ein
//! Flächenstück", Mathematische Annalen 38, 1891): neighbours on it are neighbours in the plane.

/// Returns the place on the curve of a square in a grid of 2^`bits` by 2^`bits`, `bits` ≤ 31: from 0 at (0, 0) on, to
/// the last at (2^`bits` − 1, 0). Coordinates beyond the grid are taken modulo its side.
pub fn index(bits: u8, x: u32, y: u32) -> u64 {
    let (mut x, mut y, mut index) = (x, y, 0);
    for bit in (0..bits.min(31)).rev() {
        let half = 1u32 << bit;
        let (right, lower) = (x & half != 0, y & half != 0);
        let quarter = match (right, lower) {
            (false, false) => 0,
            (false, true) => 1,
            (true, true) => 2,
            (true, false) => 3,
        };
        index += quarter << (2 * u32::from(bit));
        // The first and the last quarter are turned.
        if !lower {
            if right {
                (x, y) = (!x, !y);
            }
            (x, y) = (y, x);
        }
    }
    index
}

#[cfg(test)]
mod tests {
    use super::index;

    #[test]
    fn neighbours_on_the_curve_are_neighbours_in_the_plane() {
        for bits in 0..6 {
            let side = 1u32 << bits;
            let mut places = vec![None; (side * side) as usize];
            for (x, y) in (0..side).flat_map(|x| (0..side).map(move |y| (x, y))) {
                places[index(bits, x, y) as usize] = Some((x, y));
            }
            let places: Vec<_> = places.into_iter().map(|p| p.expect("every place once")).collect();
            assert_eq!((places[0], *places.last().unwrap()), ((0, 0), (side - 1, 0)));
            for pair in places.windows(2) {
                let [(a, b), (c, d)] = [pair[0], pair[1]];
                assert_eq!(a.abs_diff(c) + b.abs_diff(d), 1, "{pair:?}");
            }
        }
    }
}
