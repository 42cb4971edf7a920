//! The validity of shapes in the sense of OGC Simple Features, decided exactly and independently: every pair of edges
//! is compared.
//!
//! Coordinates are multiples of `cell`, so that they become integers.

use durer::clip::polygon::Shapes;

type P = (i128, i128);

fn cross(a: P, b: P, c: P) -> i128 {
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
}

fn in_box(a: P, b: P, p: P) -> bool {
    a.0.min(b.0) <= p.0 && p.0 <= a.0.max(b.0) && a.1.min(b.1) <= p.1 && p.1 <= a.1.max(b.1)
}

/// 1 inside, 0 on the ring, −1 outside.
fn locate(ring: &[P], p: P) -> i32 {
    let mut inside = false;
    for (i, &a) in ring.iter().enumerate() {
        let b = ring[(i + 1) % ring.len()];
        if cross(a, b, p) == 0 && in_box(a, b, p) {
            return 0;
        }
        if (a.1 > p.1) != (b.1 > p.1) && (cross(a, b, p) > 0) == (b.1 > a.1) {
            inside = !inside;
        }
    }
    if inside { 1 } else { -1 }
}

fn twice_area(ring: &[P]) -> i128 {
    (1..ring.len().saturating_sub(1)).map(|i| cross(ring[0], ring[i], ring[i + 1])).sum()
}

/// Returns whether the boxes of two rings are disjoint.
fn apart(a: &[P], b: &[P]) -> bool {
    let range = |ring: &[P], f: fn(&P) -> i128| {
        let (low, high) = (ring.iter().map(f).min(), ring.iter().map(f).max());
        (low.unwrap_or(0), high.unwrap_or(0))
    };
    [|p: &P| p.0, |p: &P| p.1].into_iter().any(|f| {
        let ((a, b), (c, d)) = (range(a, f), range(b, f));
        b < c || d < a
    })
}

/// Returns the points at which two rings touch; an error if they cross or share more than points.
fn touches(a: &[P], b: &[P], same: bool) -> Result<Vec<P>, String> {
    let mut found = Vec::new();
    if !same && apart(a, b) {
        return Ok(found);
    }
    for i in 0..a.len() {
        let (p, q) = (a[i], a[(i + 1) % a.len()]);
        for j in if same { i + 1..b.len() } else { 0..b.len() } {
            let (r, s) = (b[j], b[(j + 1) % b.len()]);
            if p.0.max(q.0) < r.0.min(s.0) || r.0.max(s.0) < p.0.min(q.0) {
                continue;
            }
            let (d1, d2) = (cross(p, q, r), cross(p, q, s));
            let (d3, d4) = (cross(r, s, p), cross(r, s, q));
            if d1.signum() * d2.signum() < 0 && d3.signum() * d4.signum() < 0 {
                return Err(format!("{p:?}–{q:?} crosses {r:?}–{s:?}"));
            }
            let mut on: Vec<P> = Vec::new();
            on.extend(
                [(r, d1), (s, d2)].iter().filter(|e| e.1 == 0 && in_box(p, q, e.0)).map(|e| e.0),
            );
            on.extend(
                [(p, d3), (q, d4)].iter().filter(|e| e.1 == 0 && in_box(r, s, e.0)).map(|e| e.0),
            );
            on.sort_unstable();
            on.dedup();
            if on.len() > 1 {
                return Err(format!("{p:?}–{q:?} overlaps {r:?}–{s:?}"));
            }
            let next = same && (j == i + 1 || (i == 0 && j == b.len() - 1));
            if same && !on.is_empty() && !next {
                return Err(format!("a ring touches itself at {:?}", on[0]));
            }
            if !same {
                found.extend(on);
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    Ok(found)
}

/// Returns whether `inner` is within `outer` and touches it at most in points.
fn within(inner: &[P], outer: &[P]) -> bool {
    if apart(inner, outer) {
        return false;
    }
    let twice = |p: &P| (2 * p.0, 2 * p.1);
    let doubled: Vec<P> = outer.iter().map(twice).collect();
    let corners = inner.iter().map(twice);
    let middles = (0..inner.len()).map(|i| {
        let (a, b) = (inner[i], inner[(i + 1) % inner.len()]);
        (a.0 + b.0, a.1 + b.1)
    });
    corners.chain(middles).map(|p| locate(&doubled, p)).find(|&side| side != 0) == Some(1)
}

/// Checks the graph of touching rings and their points: a cycle in it would split the interior.
fn connected(rings: &[Vec<P>]) -> Result<(), String> {
    let mut parent: Vec<usize> = (0..rings.len()).collect();
    let mut points: Vec<(P, usize)> = Vec::new();
    fn root(parent: &mut [usize], i: usize) -> usize {
        let mut i = i;
        while parent[i] != i {
            i = parent[i];
        }
        i
    }
    for i in 0..rings.len() {
        for j in i + 1..rings.len() {
            for p in touches(&rings[i], &rings[j], false)? {
                points.push((p, i));
                points.push((p, j));
            }
        }
    }
    points.sort_unstable();
    points.dedup();
    let mut last = None;
    for (p, ring) in points {
        if last != Some(p) {
            last = Some(p);
            parent.push(parent.len());
        }
        let point = parent.len() - 1;
        let (a, b) = (root(&mut parent, ring), root(&mut parent, point));
        if a == b {
            return Err(format!("the interior is cut apart at {p:?}"));
        }
        parent[a] = b;
    }
    Ok(())
}

/// Checks the polygons, each alone and all together.
pub fn check(shapes: &Shapes, cell: f64) -> Result<(), String> {
    let whole = |v: f64| {
        let n = (v / cell).round();
        if (n * cell - v).abs() > 1e-9 * v.abs() {
            Err(format!("{v} is not on the grid"))
        } else {
            Ok(n as i128)
        }
    };
    let mut polygons: Vec<Vec<Vec<P>>> = Vec::new();
    for polygon in shapes.polygons() {
        let mut rings = Vec::new();
        for ring in polygon.rings() {
            let ring: Result<Vec<P>, String> =
                ring.iter().map(|p| Ok((whole(p.x)?, whole(p.y)?))).collect();
            rings.push(ring?);
        }
        polygons.push(rings);
    }
    for rings in &polygons {
        for (k, ring) in rings.iter().enumerate() {
            if ring.len() < 3 {
                return Err("a ring has less than three points".into());
            }
            if (twice_area(ring) > 0) != (k == 0) || twice_area(ring) == 0 {
                return Err(format!("ring {k} runs the wrong way"));
            }
            touches(ring, ring, true)?;
            if k > 0 && !within(ring, &rings[0]) {
                return Err("a hole is outside its outer ring".into());
            }
            if let Some(j) = (1..rings.len()).find(|&j| j != k && k > 0 && within(ring, &rings[j]))
            {
                return Err(format!("hole {k} is within hole {j}"));
            }
        }
        connected(rings)?;
    }
    for (i, a) in polygons.iter().enumerate() {
        for b in &polygons[..i] {
            for (r, s) in a.iter().flat_map(|r| b.iter().map(move |s| (r, s))) {
                touches(r, s, false)?;
            }
            let inside = |a: &[Vec<P>], b: &[Vec<P>]| {
                within(&a[0], &b[0]) && !b[1..].iter().any(|hole| within(&a[0], hole))
            };
            if inside(a, b) || inside(b, a) {
                return Err("two polygons overlap".into());
            }
        }
    }
    Ok(())
}
