//! Elliptical arcs of path data: from their ends to centre and angles, as in *Scalable Vector Graphics (SVG) 2*,
//! appendix B.2.

use durer::math::DVec2;
use std::f64::consts::TAU;

/// An elliptical arc as path data say it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ends {
    pub from: DVec2,
    pub to: DVec2,
    /// Half the axes of the ellipse, of any sign; if they are too small to reach both ends, they are enlarged as little
    /// as possible.
    pub radii: DVec2,
    /// Angle from the x axis to the ellipse's first axis, in radians.
    pub turned: f64,
    /// True if it is the larger one of two arcs.
    pub large: bool,
    /// True if its angles grow.
    pub sweep: bool,
}

/// An elliptical arc around its centre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Arc {
    pub center: DVec2,
    /// The angle on the unit circle, in radians, at which it begins.
    pub start: f64,
    /// Angle that it sweeps, in radians: from −2π to 2π.
    pub turn: f64,
    /// True if it is half an ellipse, as far as rounding lets `turn` say so, whose radii just reach.
    pub is_half: bool,
    radii: DVec2,
    /// Sine and cosine of the angle by which it is turned.
    turned: (f64, f64),
}

impl Arc {
    /// Creates the arc between two ends; `None` if its ends are equal or a radius is 0, so that it is a line.
    pub fn new(ends: &Ends) -> Option<Self> {
        let mut radii = ends.radii.abs();
        if ends.from == ends.to || radii.min_element() == 0.0 {
            return None;
        }
        // In the space where the ellipse is a unit circle around c, the ends are at ±p.
        let (sin, cos) = libm::sincos(ends.turned);
        let half = (ends.from - ends.to) * 0.5;
        let mut p = DVec2::new(cos * half.x + sin * half.y, cos * half.y - sin * half.x) / radii;
        let reach = p.length();
        if reach > 1.0 {
            (radii, p) = (radii * reach, p / reach);
        }
        let distance = (1.0 / p.length_squared() - 1.0).max(0.0).sqrt();
        let c = p.perp() * if ends.large == ends.sweep { distance } else { -distance };
        let angle = |v: DVec2| libm::atan2(v.y, v.x);
        let start = angle(p - c);
        let mut turn = angle(-p - c) - start;
        match ends.sweep {
            true if turn < 0.0 => turn += TAU,
            false if turn > 0.0 => turn -= TAU,
            _ => {}
        }
        let is_half = reach >= 1.0;
        let mut arc = Self { center: DVec2::ZERO, start, turn, is_half, radii, turned: (sin, cos) };
        arc.center = ends.from * 0.5 + ends.to * 0.5 + arc.seen(c);
        Some(arc)
    }

    /// Transforms a vector from the space where the ellipse is a unit circle to the path's space.
    pub fn seen(&self, v: DVec2) -> DVec2 {
        let ((sin, cos), v) = (self.turned, v * self.radii);
        DVec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
    }
}
