//! The mask of `durer clip --by`: the polygons of a file.

use super::args::ClipArgs;
use super::rules;
use super::srids::Srids;
use crate::failure::Failure;
use crate::input::display_name;
use crate::layer::{open, words};
use crate::messages::Messages;
use durer::clip::mask::{Algorithm, Area, Mask, Rules};
use durer::clip::polygon::{BooleanOp, Shapes, WindingRule};
use durer_formats::geo::GeoFormat;
use std::path::Path;

/// Returns all polygons of a file as one mask.
///
/// A mask without polygons is an error if its inside is to be kept; otherwise it changes nothing.
pub fn read(
    path: &Path,
    args: &ClipArgs,
    srids: &mut Srids,
    messages: &Messages,
) -> Result<Mask, Failure> {
    let fail = |what: String| Failure::Data(format!("{}: {what}", display_name(path)));
    let (from, mut reader) = open(path, None, None, &args.running.work)?;
    let (mut all, mut rings, mut repaired) = (Area::default(), false, false);
    while let Some(feature) = reader.next_feature().map_err(|e| fail(words(&e)))? {
        if let Some(geometry) = &feature.geometry {
            srids.add(feature.srid);
            let area = Area::of_geometry(geometry);
            rings |= !area.shapes.is_empty();
            // An SVG or an option gives the fill rule of crossing polygons.
            let requested = args.cutting.fill_rule.is_some() || from == GeoFormat::Svg;
            let clean = rules(args, &feature).clean(geometry).map_err(|e| fail(e.to_string()))?;
            repaired |= !requested && clean.repaired;
            all.append(&clean.area);
        }
    }
    srids.of_file(&reader.system());
    messages.warnings(&display_name(path), reader.warnings());
    let rules = Rules {
        fill: WindingRule::Positive,
        grid: args.cutting.grid,
        work: args.running.work.clone(),
    };
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
        // Rings may run in the wrong direction for the rule.
        let why = match args.cutting.fill_rule {
            Some(rule) if rings => format!("by --fill-rule {rule} its polygons enclose nothing"),
            _ => "there is no polygon".to_owned(),
        };
        if !args.region.outside && args.cutting.op == BooleanOp::Intersection {
            return Err(fail(format!("{why} to cut with")));
        }
        messages.warning(&display_name(path), format!("{why} in it; nothing is cut away"));
    }
    // Errors about the mask alone are not the features' faults.
    if let Some(Algorithm::Polygon(clipper)) = args.cutting.algorithm.filter(|a| !a.joins()) {
        let alone = clipper.clip(&Shapes::new(), &union.shapes, BooleanOp::Intersection);
        alone.map_err(|e| fail(e.to_string()))?;
    }
    Mask::polygons(union.shapes).map_err(|e| fail(e.to_string()))
}
