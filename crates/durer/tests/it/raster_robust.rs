//! Strange input to the whole rasterizer: NaN, far coordinates, empty targets, a million vertices.

use crate::raster_coverage::Random;
use durer::curve::{Contours, Path, flatten, stroke_font};
use durer::math::{DVec2, IVec2};
use durer::raster::Span;
use durer::raster::coverage::{FillRule, PartitionFace, fill_partition};
use durer::raster::line::anti_aliased::{self, SmoothLine};
use durer::raster::line::wide::{Cap, Join, Stroke, outline};
use durer::raster::line::{LineRasterizer, Options as LineOptions};
use durer::raster::paint::{Canvas, Options, Paint};
use durer::raster::polygon::{self, PolygonRasterizer};
use durer::raster::seed_fill::{self, Connectivity, SeedFill, boundary_fill, flood_fill};
use durer::target::Pixels;
use durer::trace::NoTrace;

const STRANGE: [f64; 9] =
    [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e30, -1e30, f64::MAX, 1e-300, 0.0, 5.5];
const BLACK: Paint = Paint::Color([0, 0, 0, 255]);

fn is_finite(outline: &Contours) -> bool {
    outline.points().iter().all(|p| p.is_finite())
}

#[test]
fn strokes_of_strange_paths_are_finite() {
    for a in STRANGE {
        for b in STRANGE {
            let mut path = Path::new();
            path.move_to(a, 1.0).line_to(b, a).cubic_to(
                DVec2::new(1.0, b),
                DVec2::new(a, a),
                DVec2::new(9.0, 3.0),
            );
            path.quad_to(b, b, 2.0, a);
            for (width, dashes) in [(1.0, vec![]), (1e30, vec![3.0]), (f64::MAX, vec![b.abs()])] {
                for (cap, join) in [(Cap::Round, Join::Round), (Cap::Square, Join::Miter)] {
                    let dashes = dashes.clone();
                    let stroke = Stroke { width, cap, join, dashes, ..Stroke::default() };
                    let found = outline(&path, &stroke, 0.1, &mut NoTrace);
                    let good = stroke.dashes.iter().all(|d| d.is_finite());
                    assert_eq!(found.is_ok(), good, "{stroke:?}");
                    assert!(found.as_ref().is_ok_and(is_finite) || !good, "{a} {b} {stroke:?}");
                }
            }
        }
    }
}

#[test]
fn a_far_stroke_still_covers_what_is_near() {
    for far in [1e6, 1e12, 1e30, f64::MAX] {
        let mut line = Path::new();
        line.move_to(-far, 5.0).line_to(far, 5.0);
        let mut canvas = Canvas::new(10, 10, Options::default()).unwrap();
        canvas.stroke(&line, &Stroke { width: 2.0, ..Stroke::default() }, &BLACK, 1.0).unwrap();
        let mut target = Pixels::new(10, 10, [255; 4]);
        canvas.render(&mut target).unwrap();
        let dark = target.data().iter().filter(|p| p[0] == 0).count();
        assert_eq!(dark, 20, "{far}");
    }
}

#[test]
fn empty_targets_take_everything() {
    let shape = Path::circle(DVec2::ZERO, 9.0);
    for (width, height) in [(0, 0), (0, 5), (5, 0)] {
        let mut canvas = Canvas::new(width, height, Options::default()).unwrap();
        canvas.push_clip(&shape, FillRule::EvenOdd);
        canvas.push_group();
        canvas.fill(&shape, FillRule::NonZero, &BLACK, 1.0);
        canvas.stroke(&shape, &Stroke::default(), &BLACK, 1.0).unwrap();
        let mut target = Pixels::new(width, height, [7; 4]);
        canvas.render(&mut target).unwrap();
        let contours = Contours::polygon([DVec2::ZERO, DVec2::X, DVec2::Y]);
        let face = PartitionFace { contours: contours.clone(), color: [1; 4] };
        assert_eq!(fill_partition(&[face], &mut target, &mut NoTrace), Ok(0));
        let options = polygon::Options::default();
        for method in PolygonRasterizer::ALL {
            method.fill(&contours, width, height, &options, |s| panic!("{method} {s:?}"));
        }
        let mut gray = Pixels::new(width, height, 0_u8);
        for connectivity in [Connectivity::Four, Connectivity::Eight] {
            let options = seed_fill::Options { connectivity, ..Default::default() };
            for &fill in SeedFill::ALL {
                let t = &mut NoTrace;
                assert_eq!(flood_fill(&mut gray, (0, 0), 9, 255, fill, &options, t), Ok(0));
                assert_eq!(boundary_fill(&mut gray, (4, 4), 9, 1, 0, fill, &options, t), Ok(0));
            }
        }
    }
}

#[test]
fn lines_of_windows_without_pixels_light_nothing() {
    let (a, b) = (IVec2::new(i32::MIN, 3), IVec2::new(i32::MAX, 900));
    let window = Some((IVec2::new(5, 5), IVec2::new(4, 4)));
    for method in LineRasterizer::ALL {
        method.draw(a, b, &LineOptions { window }, |p| panic!("{p}"), &mut NoTrace);
    }
    let window = Some((IVec2::ZERO, IVec2::splat(8)));
    for &method in SmoothLine::ALL {
        let mut count = 0;
        let plot = |p: IVec2, _| {
            assert!(p.cmpge(IVec2::ZERO).all() && p.cmple(IVec2::splat(8)).all(), "{p}");
            count += 1;
        };
        let (a, b) = (IVec2::splat(i32::MIN), IVec2::splat(i32::MAX));
        anti_aliased::draw(method, a, b, &LineOptions { window }, plot, &mut NoTrace);
        assert!(count >= 9, "{method}");
    }
    for strange in STRANGE {
        let line = anti_aliased::outline(DVec2::new(strange, 0.0), DVec2::ONE, strange);
        assert!(line.points().iter().all(|p| p.is_finite()), "{strange}");
    }
}

#[test]
fn text_of_strange_sizes_is_finite() {
    for size in STRANGE {
        let line = stroke_font::line("Ag\u{0}\u{10ffff}", size);
        assert!(line.advance.is_finite() && is_finite(&flatten(&line.path(), 0.1)), "{size}");
    }
}

/// Returns a path whose every edge crosses hundreds of others.
fn tangle() -> Vec<DVec2> {
    let mut random = Random(11);
    let mut at = DVec2::splat(128.0);
    let mut step = || {
        at = (at + random.point(-9.0, 9.0)).clamp(DVec2::ZERO, DVec2::splat(256.0));
        at
    };
    (0..1_000_000).map(|_| step()).collect()
}

#[test]
fn a_million_vertices_are_filled_aliased_and_stroked() {
    let points = tangle();
    let mut area = 0;
    let contours = Contours::polygon(points.iter().copied());
    let options = polygon::Options::default();
    PolygonRasterizer::EdgeTable.fill(&contours, 256, 256, &options, |s| area += s.x1 - s.x0);
    let mut other = 0;
    let count = |s: Span| other += s.x1 - s.x0;
    PolygonRasterizer::OrderedEdgeList.fill(&contours, 256, 256, &options, count);
    assert_eq!(area, other);
    assert!(area > 40_000, "{area}");
    let mut canvas = Canvas::new(256, 256, Options::default()).unwrap();
    canvas.stroke(&Path::polyline(points), &Stroke::default(), &BLACK, 1.0).unwrap();
    let mut target = Pixels::new(256, 256, [255; 4]);
    canvas.render(&mut target).unwrap();
    assert!(target.data().iter().filter(|p| p[0] == 0).count() > 40_000);
}
