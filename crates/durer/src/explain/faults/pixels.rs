//! Bresenham's algorithm as a program with faults.

use super::{Program, fault};
use crate::explain::lines::by_pixels;
use crate::math::IVec2;
use crate::raster::line::bresenham::INFO;
use crate::raster::line::{LineRasterizer, Step};
use crate::trace::{Recorder, Tracer};

pub(super) const PROGRAM: Program = Program {
    lesson: INFO.name,
    faults: &[
        fault(3, "E ← 2Δy, y ← y1"),
        fault(7, "if E < 0:"),
        fault(8, "y ← y"),
        fault(9, "E ← E + 2Δy"),
        fault(11, "E ← E + Δy"),
    ],
    frames: |input, line, cap| {
        by_pixels(LineRasterizer::Bresenham, input, cap, |from, to, t| draw(from, to, line, t))
    },
};

fn draw(from: IVec2, to: IVec2, faulty: usize, t: &mut Recorder<Step>) {
    let way = to - from;
    let steep = way.y.abs() > way.x.abs();
    let turned = |p: IVec2| if steep { IVec2::new(p.y, p.x) } else { p };
    let (way, from) = (turned(way), turned(from));
    let [dx, dy] = way.abs().to_array().map(i64::from);
    let sign = way.signum();
    let slope = f64::from(way.y) / f64::from(way.x.abs().max(1));
    let mut e = if faulty == 3 { 2 * dy } else { 2 * dy - dx };
    let mut y = from.y;
    for done in 0..=way.x.abs() {
        let pixel = turned(IVec2::new(from.x + sign.x * done, y));
        let across = f64::from(from.y) + slope * f64::from(done);
        t.step(|| Step { pixel, across, e });
        // At zero the smaller coordinate decides.
        let beyond = if faulty == 7 { e < 0 } else { e > 0 || e == 0 && sign.y < 0 };
        if beyond {
            y += if faulty == 8 { 0 } else { sign.y };
            e += if faulty == 9 { 2 * dy } else { 2 * dy - 2 * dx };
        } else {
            e += if faulty == 11 { dy } else { 2 * dy };
        }
    }
}
