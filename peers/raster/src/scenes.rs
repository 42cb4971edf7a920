//! The scenes of the comparison, flattened once, so that every peer fills the same polygons.

use durer::curve::{Contours, Path, flatten};
use durer::math::{DAffine2, DVec2};

/// One filled path.
pub struct Shape {
    pub contours: Contours,
    pub even_odd: bool,
    pub color: [u8; 4],
}

pub struct Scene {
    pub name: String,
    pub size: u32,
    pub shapes: Vec<Shape>,
}

pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 31)
    }

    pub fn color(&mut self) -> [u8; 4] {
        [(self.next() * 255.0) as u8, (self.next() * 255.0) as u8, (self.next() * 255.0) as u8, 255]
    }
}

fn shape(points: Vec<DVec2>, color: [u8; 4]) -> Shape {
    Shape { contours: Contours::polygon(points), even_odd: false, color }
}

/// Returns random convex polygons of about 20 pixels.
pub fn small_polygons() -> Scene {
    let mut r = Random(1);
    let shapes = (0..10_000).map(|_| {
        let center = DVec2::new(r.next() * 1024.0, r.next() * 1024.0);
        let radius = 6.0 + r.next() * 8.0;
        let n = 3 + (r.next() * 6.0) as usize;
        let turn = r.next() * 6.3;
        let points = (0..n).map(|i| {
            let a = turn + i as f64 / n as f64 * std::f64::consts::TAU;
            center + radius * DVec2::new(a.cos(), a.sin())
        });
        shape(points.collect(), r.color())
    });
    Scene { name: "10k polygons 1024".into(), size: 1024, shapes: shapes.collect() }
}

/// Returns a jittered grid of 64 × 64 cells, two triangles each.
pub fn mesh() -> Scene {
    let mut r = Random(2);
    let (n, side) = (64, 512.0);
    let points: Vec<DVec2> = (0..=n * (n + 2))
        .map(|i| {
            let p = DVec2::new((i % (n + 1)) as f64, (i / (n + 1)) as f64);
            (p + DVec2::new(r.next() - 0.5, r.next() - 0.5) * 0.7) * (side / n as f64)
        })
        .collect();
    let mut shapes = Vec::new();
    for i in 0..n * n {
        let a = i / n * (n + 1) + i % n;
        for t in [[a, a + 1, a + n + 2], [a, a + n + 1, a + n + 2]] {
            shapes.push(shape(t.map(|i| points[i]).to_vec(), r.color()));
        }
    }
    Scene { name: "mesh 8k 512".into(), size: 512, shapes }
}

/// Fills of an SVG drawing at the given width.
pub fn art(file: &str, size: u32) -> Scene {
    let data = std::fs::read(file).expect("drawing");
    let tree = usvg::Tree::from_data(&data, &usvg::Options::default()).expect("svg");
    let scale = f64::from(size) / f64::from(tree.size().width().max(tree.size().height()));
    let mut shapes = Vec::new();
    collect(tree.root(), scale, &mut shapes);
    Scene { name: format!("art {size}"), size, shapes }
}

fn collect(group: &usvg::Group, scale: f64, shapes: &mut Vec<Shape>) {
    for node in group.children() {
        match node {
            usvg::Node::Group(g) => collect(g, scale, shapes),
            usvg::Node::Path(p) => {
                let Some(fill) = p.fill() else { continue };
                let usvg::Paint::Color(c) = fill.paint() else { continue };
                let t = p.abs_transform();
                let m = DAffine2::from_cols_array(
                    &[t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(|v| f64::from(v) * scale),
                );
                let path = convert(p.data()).transformed(m);
                shapes.push(Shape {
                    contours: flatten(&path, 0.1),
                    even_odd: fill.rule() == usvg::FillRule::EvenOdd,
                    color: [c.red, c.green, c.blue, (fill.opacity().get() * 255.0) as u8],
                });
            }
            _ => {}
        }
    }
}

fn convert(data: &usvg::tiny_skia_path::Path) -> Path {
    use usvg::tiny_skia_path::PathSegment as S;
    let v = |p: usvg::tiny_skia_path::Point| DVec2::new(f64::from(p.x), f64::from(p.y));
    let mut path = Path::new();
    for s in data.segments() {
        match s {
            S::MoveTo(p) => path.move_to(v(p).x, v(p).y),
            S::LineTo(p) => path.line_to(v(p).x, v(p).y),
            S::QuadTo(a, p) => path.quad_to(v(a).x, v(a).y, v(p).x, v(p).y),
            S::CubicTo(a, b, p) => path.cubic_to(v(a), v(b), v(p)),
            S::Close => path.close(),
        };
    }
    path
}

/// Returns one polygon of 10⁵ vertices at 2048².
pub fn heavy(kind: &str, even_odd: bool) -> Scene {
    let mut r = Random(3);
    let count = 100_000;
    let side = 2048.0;
    let points: Vec<DVec2> = match kind {
        "walk" => {
            let mut p = DVec2::splat(side / 2.0);
            (0..count)
                .map(|_| {
                    let a = r.next() * std::f64::consts::TAU;
                    p += DVec2::new(a.cos(), a.sin()) * 8.0;
                    p = p.clamp(DVec2::ZERO, DVec2::splat(side));
                    p
                })
                .collect()
        }
        "coast" => (0..count)
            .map(|i| {
                let a = i as f64 / count as f64 * std::f64::consts::TAU;
                let mut radius = 0.7;
                for k in 1..9 {
                    let f = f64::from(1 << k);
                    radius += 0.4 / f * (a * f * 3.0 + f).sin();
                }
                radius += (r.next() - 0.5) * 0.003;
                DVec2::splat(side / 2.0) + DVec2::new(a.cos(), a.sin()) * radius * side * 0.5
            })
            .collect(),
        _ => (0..count).map(|_| DVec2::new(r.next() * side, r.next() * side)).collect(),
    };
    let rule = if even_odd { "even-odd" } else { "non-zero" };
    let shape = Shape { contours: Contours::polygon(points), even_odd, color: [20, 80, 160, 255] };
    Scene { name: format!("{kind} {rule}"), size: 2048, shapes: vec![shape] }
}
