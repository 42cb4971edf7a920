//! What geometries are cut with: a window, or the polygons of a file.

use super::args::ClipArgs;
use super::engine::{Algorithm, Rules};
use super::rules;
use super::shapes::Area;
use super::srids::Srids;
use crate::failure::Failure;
use crate::input::display_name;
use crate::layer::{open, words};
use crate::messages::Messages;
use durer::clip::polygon::rectangle::Prepared;
use durer::clip::polygon::{BooleanOp, FillRule, Shapes};
use durer::math::{DVec2, Rect};
use durer_formats::geo::GeoFormat;
use std::path::Path;

type Result<T> = durer::Result<T>;

/// What to cut with.
#[derive(Debug, Clone)]
pub struct Mask {
    /// Valid polygons, or none; made ready for many features.
    polygons: Prepared,
    /// Where the mask is a rectangle.
    pub window: Option<Rect>,
}

impl Mask {
    /// A window.
    pub fn window(window: Rect) -> Result<Self> {
        Ok(Self { polygons: Prepared::new(rectangle_shape(&window))?, window: Some(window) })
    }

    /// Windows that have no point in common.
    pub fn windows(windows: &[Rect]) -> Result<Self> {
        let mut shapes = Shapes::new();
        windows.iter().for_each(|window| shapes.append(&rectangle_shape(window)));
        Self::polygons(shapes)
    }

    /// Valid polygons, or none.
    pub fn polygons(shapes: Shapes) -> Result<Self> {
        Ok(Self { polygons: Prepared::new(shapes)?, window: None })
    }

    /// Whether it may have a point in common with what lies in a box.
    pub fn meets(&self, bounds: &Rect) -> bool {
        self.polygons.bounds().is_some_and(|own| own.overlaps(bounds))
    }

    /// Returns whether a box is wholly inside; `None` where the mask's border comes near.
    pub fn side(&self, bounds: &Rect) -> Option<bool> {
        if !self.meets(bounds) {
            return Some(false);
        }
        if let Some(window) = self.window {
            let covers = window.contains(bounds.min()) && window.contains(bounds.max());
            return covers.then_some(true);
        }
        (!self.polygons.has_edges_near(bounds)).then(|| self.polygons.contains(bounds.min()))
    }

    /// Its polygons, made ready.
    pub fn prepared(&self) -> &Prepared {
        &self.polygons
    }

    /// Its polygons.
    pub fn shapes(&self) -> &Shapes {
        self.polygons.shapes()
    }

    /// Whether a point lies in it; its border belongs to it.
    pub fn contains(&self, p: DVec2) -> bool {
        match self.window {
            Some(window) => window.contains(p),
            None => self.polygons.contains(p),
        }
    }

    /// The polygons near a box, cut outside of it where they are many.
    pub fn near(&self, bounds: &Rect) -> Shapes {
        /// Cutting fewer points away saves nothing.
        const FEW: usize = 64;
        let margin = bounds.size() * (1.0 / 64.0) + bounds.max().abs() * 1e-9;
        let around = Rect::new(bounds.min() - margin, bounds.max() + margin);
        match around {
            Ok(around) if self.shapes().points().len() > FEW => self.polygons.clip(&around),
            _ => self.shapes().clone(),
        }
    }
}

pub fn rectangle_shape(window: &Rect) -> Shapes {
    let (a, b) = (window.min(), window.max());
    Shapes::from_rings([[a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)]])
}

/// All polygons of a file as one mask.
///
/// Without a polygon there is nothing to keep the inside of; else it takes away or adds nothing.
pub fn read(
    path: &Path,
    args: &ClipArgs,
    srids: &mut Srids,
    messages: &Messages,
) -> std::result::Result<Mask, Failure> {
    let fail = |what: String| Failure::Data(format!("{}: {what}", display_name(path)));
    let (from, mut reader) = open(path, None, None, &args.running.work)?;
    let (mut all, mut rings, mut repaired) = (Area::default(), false, false);
    while let Some(feature) = reader.next_feature().map_err(|e| fail(words(&e)))? {
        if let Some(geometry) = &feature.geometry {
            srids.add(feature.srid);
            let area = Area::of_geometry(geometry);
            rings |= !area.shapes.is_empty();
            // An SVG, or an option, says what polygons that cross enclose.
            let asked = args.cutting.fill_rule.is_some() || from == GeoFormat::Svg;
            let clean = rules(args, &feature).clean(geometry).map_err(|e| fail(e.to_string()))?;
            repaired |= !asked && clean.repaired;
            all.append(&clean.area);
        }
    }
    messages.warnings(&display_name(path), reader.warnings());
    let rules = Rules { fill: FillRule::Positive, grid: args.cutting.grid };
    let union = rules.overlay(&all, &Shapes::new(), BooleanOp::Union, rules.fill);
    let union = union.map_err(|e| fail(e.to_string()))?.area;
    if rules.loses(&all, &all.shapes) {
        let message = "polygons smaller than a cell of the grid, by default 2^-40 of the whole \
                       mask's extent, may be lost";
        messages.warning(&display_name(path), message);
    }
    if repaired {
        let message = "polygons crossed, pinched or overlapped themselves or one another; made valid by the \
                       even-odd rule";
        messages.warning(&display_name(path), message);
    }
    if union.shapes.is_empty() {
        // Rings may run the wrong way for the rule.
        let why = match args.cutting.fill_rule {
            Some(rule) if rings => format!("by --fill-rule {rule} its polygons enclose nothing"),
            _ => "there is no polygon".to_owned(),
        };
        if !args.region.outside && args.cutting.op == BooleanOp::Intersection {
            return Err(fail(format!("{why} to cut with")));
        }
        messages.warning(&display_name(path), format!("{why} in it; nothing is cut away"));
    }
    // What the algorithm says of the mask alone is no feature's fault.
    if let Some(Algorithm::Polygon(clipper)) = args.cutting.algorithm.filter(|a| !a.joins()) {
        let alone = clipper.clip(&Shapes::new(), &union.shapes, BooleanOp::Intersection);
        alone.map_err(|e| fail(e.to_string()))?;
    }
    Mask::polygons(union.shapes).map_err(|e| fail(e.to_string()))
}
