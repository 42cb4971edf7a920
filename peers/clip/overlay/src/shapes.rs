//! The shapes that are measured: whole-number coordinates, the same on every run.

/// Rings of whole-number points.
pub type Rings = Vec<Vec<(i32, i32)>>;

/// Subject and clip.
pub type Pair = (Rings, Rings);

/// A small generator of uniform numbers in [0, 1) (splitmix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

const EXTENT: f64 = 100_000_000.0;

fn point(x: f64, y: f64) -> (i32, i32) {
    ((x * EXTENT).round() as i32, (y * EXTENT).round() as i32)
}

/// Returns a ring like a coast: a circle whose radius is fractal noise, by midpoint displacement.
pub fn coast(n: usize, seed: u64, x: f64) -> Rings {
    let mut random = Random(seed);
    let mut radius = vec![0.6; 8];
    let mut swing = 0.25;
    while radius.len() < n {
        let next: Vec<f64> = (0..radius.len() * 2)
            .map(|i| {
                let (a, b) = (radius[i / 2], radius[(i / 2 + 1) % radius.len()]);
                if i % 2 == 0 { a } else { (a + b) / 2.0 + (random.next() - 0.5) * swing }
            })
            .collect();
        radius = next;
        swing *= 0.55;
    }
    let m = radius.len();
    let ring = (0..n)
        .map(|i| {
            let k = i * m / n;
            let angle = std::f64::consts::TAU * k as f64 / m as f64;
            point(x + radius[k] * angle.cos(), radius[k] * angle.sin())
        })
        .collect();
    vec![ring]
}

/// Returns a star of n points: every second one far out, the others close in, at random.
pub fn star(n: usize, seed: u64, x: f64, turn: f64) -> Rings {
    let mut random = Random(seed);
    let ring = (0..n)
        .map(|i| {
            let angle = std::f64::consts::TAU * (i as f64 + turn) / n as f64;
            let r = if i % 2 == 0 { 0.8 + 0.1 * random.next() } else { 0.2 + 0.1 * random.next() };
            point(x + r * angle.cos(), r * angle.sin())
        })
        .collect();
    vec![ring]
}

/// n octagons of random place and size; each covers, and is covered by, a few others.
pub fn blobs(n: usize, seed: u64) -> Rings {
    let mut random = Random(seed);
    let size = 1.0 / (n as f64).sqrt();
    (0..n)
        .map(|_| {
            let (x, y) = (random.next() * 2.0 - 1.0, random.next() * 2.0 - 1.0);
            let r = size * (0.6 + 1.2 * random.next());
            let turn = random.next();
            (0..8)
                .map(|k| {
                    let angle = std::f64::consts::TAU * (k as f64 + turn) / 8.0;
                    point(x + r * angle.cos(), y + r * angle.sin())
                })
                .collect()
        })
        .collect()
}

/// About n squares: the black fields of a board, whose corners touch, moved by `shift` fields.
pub fn checkerboard(n: usize, shift: f64) -> Rings {
    let side = ((2 * n) as f64).sqrt().round() as usize;
    let field = 1.8 / side as f64;
    let at = |i: f64| -0.9 + (i + shift) * field;
    let fields = (0..side).flat_map(|r| (0..side).map(move |c| (r, c)));
    fields
        .filter(|(r, c)| (r + c) % 2 == 0)
        .map(|(r, c)| {
            let (x, y) = (c as f64, r as f64);
            vec![
                point(at(x), at(y)),
                point(at(x + 1.0), at(y)),
                point(at(x + 1.0), at(y + 1.0)),
                point(at(x), at(y + 1.0)),
            ]
        })
        .collect()
}

/// Returns the measured pair of a name like `coast-10k`.
pub fn named(name: &str) -> Option<Pair> {
    let (family, size) = name.split_once('-')?;
    let n = size.strip_suffix('k')?.parse::<usize>().ok()? * 1000;
    match family {
        "coast" => Some((coast(n, 1, 0.0), coast(n, 2, 0.1))),
        "star" => Some((star(n, 1, 0.0, 0.0), star(n, 2, 0.0, 0.5))),
        "shifted" => Some((star(n, 1, 0.0, 0.0), star(n, 2, 0.001, 0.5))),
        "blobs" => Some((blobs(n, 1), Rings::new())),
        "board" => Some((checkerboard(n, 0.0), checkerboard(n, 0.5))),
        _ => None,
    }
}
