//! Stippling: tones as dots of one size, the closer the darker, nowhere in rows.
//!
//! Adrian Secord, "Weighted Voronoi stippling", NPAR 2002: each dot moves to the centre of gravity of the tone that is
//! nearer to it than to any other dot (Lloyd's method), again and again. Dots start in even steps of tone along
//! Hilbert's curve, so no random numbers are needed. O(pixels) for each of a fixed number of rounds.

use crate::math::DVec2;
use crate::target::Pixels;

/// The number of rounds in which dots are moved.
const ROUNDS: usize = 24;

/// Dots at most; beyond that each represents more tone.
const MOST_DOTS: f64 = 1e6;

/// Places dots by `density`, in dots per pixel; densities that are not above 0 mean none.
///
/// The places are in pixels, y downwards, the centre of the first pixel at (0.5, 0.5), in the order of Hilbert's curve.
pub fn stipple(density: &Pixels<f32>) -> Vec<DVec2> {
    let mut dots = along_hilbert(density);
    for _ in 0..ROUNDS {
        settle(density, &mut dots);
    }
    dots
}

fn weight(density: &Pixels<f32>, x: u32, y: u32) -> f64 {
    let value = density.get(x, y).map_or(0.0, f64::from);
    if value.is_finite() { value.max(0.0) } else { 0.0 }
}

/// Returns a dot each time that the density along Hilbert's curve adds up to one.
fn along_hilbert(density: &Pixels<f32>) -> Vec<DVec2> {
    let (width, height) = (density.width(), density.height());
    let total: f64 = (0..height).flat_map(|y| (0..width).map(move |x| weight(density, x, y))).sum();
    let scale = (MOST_DOTS / total.max(f64::MIN_POSITIVE)).min(1.0);
    let side = width.max(height).next_power_of_two();
    let mut dots = Vec::new();
    // The first dot is in the middle of its share.
    let mut sum = 0.5;
    for step in 0..u64::from(side) * u64::from(side) {
        let [x, y] = hilbert(side, step);
        if x < width && y < height {
            sum += weight(density, x, y) * scale;
            while sum >= 1.0 {
                sum -= 1.0;
                // Several dots in a pixel may not be in one place.
                dots.push(DVec2::new(f64::from(x) + 0.5 + sum * 1e-3, f64::from(y) + 0.5));
            }
        }
    }
    dots
}

/// Returns the pixel at a place along Hilbert's curve over a square whose side is a power of two.
fn hilbert(side: u32, step: u64) -> [u32; 2] {
    let (mut x, mut y) = (0, 0);
    let (mut rest, mut size) = (step, 1);
    while size < side {
        let right = ((rest / 2) & 1) as u32;
        let up = ((rest ^ u64::from(right)) & 1) as u32;
        if up == 0 {
            if right == 1 {
                (x, y) = (size - 1 - x, size - 1 - y);
            }
            (x, y) = (y, x);
        }
        x += size * right;
        y += size * up;
        rest /= 4;
        size *= 2;
    }
    [x, y]
}

/// Moves each dot to the centre of gravity of the tone nearest to it, unless that is empty.
fn settle(density: &Pixels<f32>, dots: &mut [DVec2]) {
    let cells = Cells::new(density, dots);
    let mut sums = vec![(0.0, DVec2::ZERO); dots.len()];
    for y in 0..density.height() {
        for x in 0..density.width() {
            let weight = weight(density, x, y);
            if weight > 0.0 {
                let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                if let Some(sum) = cells.nearest(p, dots).and_then(|n| sums.get_mut(n)) {
                    sum.0 += weight;
                    sum.1 += p * weight;
                }
            }
        }
    }
    for (dot, (mass, moment)) in dots.iter_mut().zip(sums) {
        if mass > 0.0 {
            let center = moment / mass;
            if weight(density, center.x as u32, center.y as u32) > 0.0 {
                *dot = center;
            }
        }
    }
}

/// Dots by square cells of some two dots each, on an average.
struct Cells {
    side: f64,
    columns: usize,
    rows: usize,
    /// Start of each cell's dots among `dots`, and the end.
    starts: Vec<u32>,
    dots: Vec<u32>,
}

impl Cells {
    fn new(density: &Pixels<f32>, dots: &[DVec2]) -> Self {
        let (width, height) = (f64::from(density.width()), f64::from(density.height()));
        let side = (2.0 * width * height / dots.len().max(1) as f64).sqrt().max(1.0);
        let (columns, rows) = ((width / side) as usize + 1, (height / side) as usize + 1);
        let mut cells =
            Self { side, columns, rows, starts: vec![0; columns * rows + 1], dots: Vec::new() };
        for dot in dots {
            let cell = cells.cell(*dot);
            cells.starts[cell + 1] += 1;
        }
        for i in 1..cells.starts.len() {
            cells.starts[i] += cells.starts[i - 1];
        }
        let mut next = cells.starts.clone();
        cells.dots = vec![0; dots.len()];
        for (number, dot) in dots.iter().enumerate() {
            let place = &mut next[cells.cell(*dot)];
            cells.dots[*place as usize] = number as u32;
            *place += 1;
        }
        cells
    }

    fn cell(&self, p: DVec2) -> usize {
        let place = |v: f64, count: usize| ((v / self.side) as usize).min(count - 1);
        place(p.y, self.rows) * self.columns + place(p.x, self.columns)
    }

    /// Returns the dot nearest to a place, the first of several; looks at rings of cells from the
    /// inside out.
    fn nearest(&self, p: DVec2, dots: &[DVec2]) -> Option<usize> {
        let (cx, cy) = ((p.x / self.side) as i64, (p.y / self.side) as i64);
        let mut best: Option<(f64, usize)> = None;
        for ring in 0..self.columns.max(self.rows) as i64 {
            // Dots in this ring are at least this far away.
            let least = (ring - 1).max(0) as f64 * self.side;
            if best.is_some_and(|(d, _)| d < least * least) {
                break;
            }
            for y in cy - ring..=cy + ring {
                let whole_row = (y - cy).abs() == ring;
                let step = if whole_row { 1 } else { (2 * ring).max(1) };
                for x in (cx - ring..=cx + ring).step_by(step as usize) {
                    for &dot in self.of(x, y) {
                        let d = dots[dot as usize].distance_squared(p);
                        if best.is_none_or(|(b, n)| d < b || (d == b && (dot as usize) < n)) {
                            best = Some((d, dot as usize));
                        }
                    }
                }
            }
        }
        best.map(|(_, n)| n)
    }

    fn of(&self, x: i64, y: i64) -> &[u32] {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return &[] };
        if x >= self.columns || y >= self.rows {
            return &[];
        }
        let cell = y * self.columns + x;
        &self.dots[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn even(width: u32, height: u32, value: f32) -> Pixels<f32> {
        Pixels::new(width, height, value)
    }

    /// Returns the distance from each dot to the nearest other one.
    fn gaps(dots: &[DVec2]) -> Vec<f64> {
        let others = |i: usize| dots.iter().enumerate().filter(move |(j, _)| *j != i);
        let gap = |(i, p): (usize, &DVec2)| {
            others(i).map(|(_, q)| p.distance(*q)).fold(f64::MAX, f64::min)
        };
        dots.iter().enumerate().map(gap).collect()
    }

    #[test]
    fn hilberts_curve_visits_each_pixel_by_neighbours() {
        let places: Vec<_> = (0..256).map(|i| hilbert(16, i)).collect();
        let mut sorted = places.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!(sorted.len(), 256);
        assert!(
            places.windows(2).all(|w| w[0][0].abs_diff(w[1][0]) + w[0][1].abs_diff(w[1][1]) == 1)
        );
    }

    #[test]
    fn dots_are_as_many_as_the_density_says_and_apart() {
        let dots = stipple(&even(100, 70, 0.02));
        assert_eq!(dots.len(), 140);
        // The densest packing has gaps of 7.6 pixels; a random arrangement has half of them below 3.5.
        let gaps = gaps(&dots);
        assert!(
            gaps.iter().all(|g| *g > 4.5),
            "{:?}",
            gaps.iter().copied().fold(f64::MAX, f64::min)
        );
        let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
        assert!(mean > 6.0, "{mean}");
    }

    #[test]
    fn dots_are_where_it_is_dark_only() {
        let mut density = even(64, 64, 0.0);
        for y in 0..64 {
            for x in 0..32 {
                density.set(x, y, if y < 32 { 0.04 } else { 0.01 });
            }
        }
        let dots = stipple(&density);
        assert!(dots.iter().all(|d| d.x < 32.0));
        let upper = dots.iter().filter(|d| d.y < 32.0).count();
        assert!(
            (38..=44).contains(&upper) && (48..=54).contains(&dots.len()),
            "{upper} of {}",
            dots.len()
        );
    }

    #[test]
    fn what_is_no_number_gives_no_dots() {
        assert!(stipple(&even(0, 0, 1.0)).is_empty());
        assert!(stipple(&even(9, 9, f32::NAN)).is_empty());
        assert!(stipple(&even(9, 9, f32::INFINITY)).is_empty());
        assert!(stipple(&even(9, 9, -1.0)).is_empty());
    }
}
