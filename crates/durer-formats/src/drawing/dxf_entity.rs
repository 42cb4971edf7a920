//! Marks of a sheet as entities of DXF.

use super::dxf_curve;
use super::dxf_tags::{
    DxfStrokes, MODEL, PAPER, Tags, Target, begin, palette, string, transparency, true_color,
};
use durer::math::DVec2;
use durer::target::Curve;
use durer::target::drawing::TextAnchor;
use durer::target::sheet::{PaperMark, Sheet};

/// Writes a block with its entities; names with a star are anonymous, except the two spaces'.
pub(super) fn block(tags: &mut Tags, name: &str, record: u32, entities: impl FnOnce(&mut Tags)) {
    let (start, end) = (tags.fresh(), tags.fresh());
    let begin = |tags: &mut Tags, kind: &str, handle: u32| {
        tags.tag(0, kind).handle(5, handle).handle(330, record).class("AcDbEntity");
        if record == PAPER {
            tags.int(67, 1);
        }
        tags.tag(8, "0");
    };
    begin(tags, "BLOCK", start);
    let anonymous = i64::from(!matches!(record, MODEL | PAPER));
    tags.class("AcDbBlockBegin").tag(2, name).int(70, anonymous).point3(10, DVec2::ZERO);
    tags.tag(3, name).tag(1, "");
    tags.owner = record;
    entities(tags);
    tags.owner = MODEL;
    begin(tags, "ENDBLK", end);
    tags.class("AcDbBlockEnd");
}

pub(super) fn entity(
    tags: &mut Tags,
    sheet: &Sheet,
    layer: &str,
    mark: &PaperMark,
    strokes: DxfStrokes,
) {
    let place = |p: &DVec2| DVec2::new(p.x, sheet.size.y - p.y);
    match mark {
        PaperMark::Stroke { points, closed, pen } => {
            let points: Vec<DVec2> = points.iter().map(place).collect();
            let to = Target { layer, pen: sheet.pens.get(*pen) };
            match &points[..] {
                [a, b] if !closed && strokes == DxfStrokes::Pieces => {
                    if !dxf_curve::dot(tags, &to, *a, *b) {
                        dxf_curve::line(tags, &to, *a, *b);
                    }
                }
                _ => {
                    let straight: Vec<(DVec2, f64)> = points.iter().map(|p| (*p, 0.0)).collect();
                    dxf_curve::polyline(tags, &to, &straight, *closed);
                }
            }
        }
        PaperMark::Curve { curve, pen } => {
            let to = Target { layer, pen: sheet.pens.get(*pen) };
            dxf_curve::write(tags, &to, curve, sheet.size.y, strokes);
        }
        PaperMark::Text { at, text, height, anchor, pen } => {
            begin(tags, "TEXT", layer, sheet.pens.get(*pen));
            let at = place(at);
            tags.class("AcDbText").place3(10, at).length(40, *height).tag(1, &string(text));
            let alignment = match anchor {
                TextAnchor::Start => 0,
                TextAnchor::Middle => 1,
                TextAnchor::End => 2,
            };
            if alignment != 0 {
                tags.int(72, alignment).place3(11, at);
            }
            tags.class("AcDbText");
        }
        PaperMark::Fill { rings, color, .. } => {
            begin_hatch(tags, layer, *color);
            let ring = |r: &Vec<DVec2>| r.iter().map(|p| (place(p), 0.0)).collect();
            hatch(tags, &rings.iter().map(ring).collect::<Vec<_>>());
        }
        PaperMark::Area { rings, color, .. } => {
            begin_hatch(tags, layer, *color);
            let ring = |r: &Curve| dxf_curve::vertices(&dxf_curve::turned_up(r, sheet.size.y));
            hatch(tags, &rings.iter().map(ring).collect::<Vec<_>>());
        }
        // Dimensions are entities of their own kind, with blocks; files with gradients and groups are refused.
        PaperMark::Dimension(_) | PaperMark::Gradient(_) | PaperMark::Group(_) => {}
    }
}

fn begin_hatch(tags: &mut Tags, layer: &str, color: [u8; 4]) {
    begin(tags, "HATCH", layer, None);
    tags.int(62, palette(color));
    true_color(tags, color);
    transparency(tags, color);
}

/// Writes a solid fill between rings, each as its corners with the bulges of the arcs that begin there.
fn hatch(tags: &mut Tags, rings: &[Vec<(DVec2, f64)>]) {
    tags.class("AcDbHatch").point3(10, DVec2::ZERO).real(210, 0.0).real(220, 0.0).real(230, 1.0);
    // Solid, not bound to other entities; paths are polylines, areas alternate from ring to ring.
    tags.tag(2, "SOLID").int(70, 1).int(71, 0).int(91, rings.len() as i64);
    for ring in rings {
        let is_round = ring.iter().any(|c| c.1 != 0.0);
        tags.int(92, 3).int(72, i64::from(is_round)).int(73, 1).int(93, ring.len() as i64);
        for (p, bulge) in ring {
            tags.place(10, *p);
            if is_round {
                dxf_curve::bulge(tags, *bulge);
            }
        }
        tags.int(97, 0);
    }
    tags.int(75, 0).int(76, 1).int(98, 0);
}
