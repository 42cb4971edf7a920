//! Triangles against the view volume: ours against retrofire's clipper.

use crate::{Random, medians};
use durer::clip::volume::{self, ClipVertex};
use durer::math::DVec4;
use durer::trace::NoTrace;
use retrofire_core::geom::{Tri, vertex};
use retrofire_core::render::clip::{ClipVec, ClipVert, view_frustum};
use std::hint::black_box;

const N: usize = 500_000;

/// Returns triangles of some size in clip space, all inside, all outside, or anything; w from 1 to
/// 9.
fn triangle(kind: &str, r: &mut Random) -> [[f32; 4]; 3] {
    let mut within = |lo: f64, hi: f64| lo + (hi - lo) * r.next();
    let (reach, away) = match kind {
        "inside" => (0.8, 0.0),
        "offscreen" => (0.8, 2.1),
        _ => (1.6, 0.0),
    };
    let side = within(0.0, 4.0) as usize;
    let middle = [within(-reach, reach), within(-reach, reach), within(-reach, reach)];
    let w = within(1.0, 9.0);
    [0; 3].map(|_| {
        let mut p = middle.map(|m| m + within(-0.15, 0.15));
        p[side / 2] += away * if side % 2 == 0 { 1.0 } else { -1.0 };
        let w = w * within(0.9, 1.1);
        [p[0] * w, p[1] * w, p[2] * w, w].map(|v| v as f32)
    })
}

pub fn run() {
    for kind in ["inside", "offscreen", "mixed"] {
        let mut random = Random(7);
        let all: Vec<[[f32; 4]; 3]> = (0..N).map(|_| triangle(kind, &mut random)).collect();
        println!("{kind}, {N} triangles with one attribute, per triangle, triangles out:");
        let ours: Vec<[ClipVertex<f64>; 3]> = all
            .iter()
            .map(|t| {
                t.map(|p| {
                    let [x, y, z, w] = p.map(f64::from);
                    ClipVertex { position: DVec4::new(x, y, z, w), attributes: x }
                })
            })
            .collect();
        let (mut out, mut cut) = (Vec::new(), Vec::new());
        let mut theirs: Vec<Tri<ClipVert<f32>>> = Vec::new();
        let mut tris = Vec::new();
        medians(
            &mut [
                ("retrofire, outcodes and clip", &mut || {
                    theirs.clear();
                    let tri = |t: &[[f32; 4]; 3]| {
                        Tri(t.map(|p| ClipVert::new(vertex(ClipVec::new(p), p[0]))))
                    };
                    tris.clear();
                    tris.extend(all.iter().map(tri));
                    view_frustum::clip(&tris[..], &mut theirs);
                    black_box(&theirs).len() as f64
                }),
                ("durer clip_triangles", &mut || {
                    out.clear();
                    volume::clip_triangles(&ours, &Default::default(), &mut out);
                    black_box(&out).len() as f64
                }),
                ("durer clip_polygon, one call each", &mut || {
                    cut.clear();
                    for t in &ours {
                        let ring = volume::clip_polygon(t, &Default::default(), &mut NoTrace);
                        if let Some((first, rest)) = ring.split_first() {
                            cut.extend(rest.windows(2).map(|p| [*first, p[0], p[1]]));
                        }
                    }
                    black_box(&cut).len() as f64
                }),
            ],
            N,
        );
    }
}
