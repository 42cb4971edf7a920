//! Dimensions and notes that are requested one by one.

use super::automatic::{no_room, place_diameter, said};
use super::board::Board;
use super::draw::Said;
use super::feature::{self, RoundFeature};
use super::place::{self, Target};
use super::request::{Along, FeaturePlace, Request, What};
use super::seen::{Seen, Sight};
use super::style;
use crate::math::{DVec2, DVec3};
use crate::sorting::CompactSort;
use crate::target::dimension::Measure;
use crate::{Error, Result};

/// Model that requests refer to.
pub(super) struct Model<'a> {
    pub features: &'a [RoundFeature],
    /// Millimetres per unit.
    pub unit: f64,
}

/// Puts the requests, short lengths first, so that they come nearest to the views.
pub(super) fn put(
    board: &mut Board,
    views: &[Seen],
    model: &Model,
    requests: &[Request],
    notes: &mut Vec<String>,
) -> Result<()> {
    let mut ordered: Vec<(f64, &Request)> = Vec::with_capacity(requests.len());
    for request in requests {
        ordered.push((rank(model, request)?, request));
    }
    ordered.compact_sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, request) in ordered {
        let here = views_of(views, request)?;
        if !one(board, &here, model, request)? {
            let what = request.text.clone().unwrap_or_else(|| name(&request.what).to_owned());
            notes.push(no_room(&format!("`{what}`")));
        }
    }
    Ok(())
}

const fn name(what: &What) -> &'static str {
    match what {
        What::Linear { .. } => "linear",
        What::Diameter(_) => "diameter",
        What::Radius(_) => "radius",
        What::Angle { .. } => "angle",
        What::Note(_) => "note",
    }
}

/// Returns the rank of a request: lengths by their size, then all else.
fn rank(model: &Model, request: &Request) -> Result<f64> {
    match &request.what {
        What::Linear { from, to, along } => model.distance(from, to, *along).map(|d| d.2),
        _ => Ok(f64::INFINITY),
    }
}

/// Returns the views in which a request may be shown.
fn views_of<'a, 'b>(views: &'a [Seen<'b>], request: &Request) -> Result<Vec<&'a Seen<'b>>> {
    let Some(name) = &request.view else { return Ok(views.iter().collect()) };
    let found: Vec<&Seen> = views.iter().filter(|v| v.placed.name == *name).collect();
    if found.is_empty() {
        let names: Vec<&str> = views.iter().map(|v| v.placed.name.as_str()).collect();
        let value = match names[..] {
            [""] => format!("`{name}`, and there is but one view, without a name"),
            _ => format!("`{name}`, and there are {}", names.join(", ")),
        };
        return Err(Error::parameter("view", value, "one of the drawing's, or left out"));
    }
    Ok(found)
}

impl Model<'_> {
    /// Returns a point of a place, and the direction of its axis if it has one.
    fn place(&self, place: &FeaturePlace) -> Result<(DVec3, Option<DVec3>)> {
        match place {
            FeaturePlace::Point(p) => Ok((*p, None)),
            FeaturePlace::Feature(name) => {
                let feature = feature::one(self.features, name)?;
                Ok((feature.middle(), Some(feature.cylinder.axis())))
            }
        }
    }

    /// Returns two points, the direction from one to the other, and their distance along it.
    fn distance(
        &self,
        from: &FeaturePlace,
        to: &FeaturePlace,
        along: Along,
    ) -> Result<([DVec3; 2], DVec3, f64)> {
        let ((p, a), (q, b)) = (self.place(from)?, self.place(to)?);
        let mut way = q - p;
        if let (Some(a), Some(b)) = (a, b)
            && a.cross(b).length() > 1e-2
        {
            let value = "two axes that are not parallel";
            return Err(Error::parameter("dimension", value, "between parallel axes, or points"));
        }
        if let Some(axis) = a.or(b) {
            way -= axis * way.dot(axis);
        }
        let direction = along.axis().unwrap_or_else(|| way.normalize_or_zero());
        let length = (q - p).dot(direction).abs();
        if !(length > 0.0 && length.is_finite()) {
            let value = "between places that have no distance";
            return Err(Error::parameter("dimension", value, "between places that are apart"));
        }
        Ok(([p, q], direction, length))
    }
}

/// Puts one request; returns whether there was room.
fn one(board: &mut Board, views: &[&Seen], model: &Model, request: &Request) -> Result<bool> {
    match &request.what {
        What::Linear { from, to, along } => {
            let (points, direction, length) = model.distance(from, to, *along)?;
            let (view, way) = in_true_length(views, direction)?;
            let said = worded(said("", length, 1, view, model.unit), request);
            let ends = points.map(|p| view.point(p));
            let sides = place::sides(view, ends, way, request.side);
            Ok(place::linear(board, view, ends, way, &sides, &said))
        }
        What::Diameter(name) => diameter(board, views, model, request, name),
        What::Radius(name) => radius(board, views, model, request, name),
        What::Angle { vertex, from, to } => {
            let points = [model.place(vertex)?.0, model.place(from)?.0, model.place(to)?.0];
            angle(board, views, request, points)
        }
        What::Note(place) => {
            let (p, _) = model.place(place)?;
            let Some(view) = views.first() else { return Ok(true) };
            let text = request.text.clone().unwrap_or_default();
            let said = Said { text, is_plain: false, value: 0.0, scale: 1.0 };
            let target = Target { center: view.point(p), radius: 0.0, facing: None };
            Ok(place::leader(board, view, &[target], request.side, &said, |_, _| None))
        }
    }
}

/// Returns the text of a dimension with the words of its request.
fn worded(said: Said, request: &Request) -> Said {
    match &request.text {
        Some(text) => Said { text: text.replace("<>", &said.text), is_plain: false, ..said },
        None => said,
    }
}

/// Returns the first view that shows a direction in its true length, and the direction there.
fn in_true_length<'a, 'b>(
    views: &[&'a Seen<'b>],
    direction: DVec3,
) -> Result<(&'a Seen<'b>, DVec2)> {
    let found = views.iter().find_map(|v| match v.sight(direction) {
        Sight::Along(way) => Some((*v, way)),
        _ => None,
    });
    found.ok_or_else(|| {
        let d = direction;
        let way = format!("({:.3}, {:.3}, {:.3})", d.x, d.y, d.z);
        no_view(views, &format!("lengths along {way} in their true size"))
    })
}

fn no_view(views: &[&Seen], what: &str) -> Error {
    let names: Vec<&str> = views.iter().map(|v| v.placed.name.as_str()).collect();
    let value = match names[..] {
        [] | [""] => format!("one that does not show {what}"),
        _ => format!("{}, which do not show {what}", names.join(", ")),
    };
    Error::parameter("view", value, "one that looks at it straight on")
}

fn diameter(
    board: &mut Board,
    views: &[&Seen],
    model: &Model,
    request: &Request,
    name: &str,
) -> Result<bool> {
    let cylinder = &feature::one(model.features, name)?.cylinder;
    let value = 2.0 * cylinder.radius;
    let sign = |view: &Seen| worded(said("⌀", value, 1, view, model.unit), request);
    if let Some((view, (center, radius))) =
        views.iter().find_map(|v| Some((v, v.circle(cylinder)?)))
    {
        let target = Target { center, radius, facing: None };
        return Ok(place_diameter(board, view, &[target], request.side, &sign(view)));
    }
    // Seen from the side, the diameter is the distance of the outlines.
    let (view, way) = in_true_length(views, cylinder.axis())?;
    let (middle, across) = (view.point(cylinder.ends[0]), way.perp());
    let reach = across * cylinder.radius * view.factor();
    let ends = [middle - reach, middle + reach];
    let sides = place::sides(view, ends, across, request.side);
    Ok(place::linear(board, view, ends, across, &sides, &sign(view)))
}

fn radius(
    board: &mut Board,
    views: &[&Seen],
    model: &Model,
    request: &Request,
    name: &str,
) -> Result<bool> {
    let cylinder = &feature::one(model.features, name)?.cylinder;
    let view = views.iter().find(|v| v.sight(cylinder.axis()) == Sight::EndOn);
    let view = view.ok_or_else(|| no_view(views, &format!("the arc of {name}")))?;
    let said = worded(said("R", cylinder.radius, 1, view, model.unit), request);
    let center = view.point((cylinder.ends[0] + cylinder.ends[1]) * 0.5);
    let facing = (!cylinder.is_full()).then(|| view.way(cylinder.facing).normalize_or_zero());
    let target = Target { center, radius: cylinder.radius * view.factor(), facing };
    Ok(place::leader(board, view, &[target], request.side, &said, |target, way| {
        Some(Measure::Radius { center: target.center, at: target.center + way * target.radius })
    }))
}

/// Distance of an angle's arc from the vertex, and of each further arc from the one before, in
/// millimetres.
const ARC: f64 = 15.0;
const ARC_STEP: f64 = 8.0;

fn angle(
    board: &mut Board,
    views: &[&Seen],
    request: &Request,
    [vertex, from, to]: [DVec3; 3],
) -> Result<bool> {
    let [a, b] = [from - vertex, to - vertex].map(DVec3::normalize_or_zero);
    let normal = a.cross(b);
    if normal.length() < 1e-6 {
        let value = "of places in one line";
        return Err(Error::parameter("angle", value, "between two directions that differ"));
    }
    let view = views.iter().find(|v| v.sight(normal.normalize_or_zero()) == Sight::EndOn);
    let view = view.ok_or_else(|| no_view(views, "the angle in its true size"))?;
    let value = libm::atan2(normal.length(), a.dot(b));
    let plain = Said { text: style::angle(value), is_plain: true, value, scale: 1.0 };
    let said = worded(plain, request);
    let at = view.point(vertex);
    let mut ends = [from, to].map(|p| view.point(p));
    // Counter-clockwise as seen; y runs down.
    if (ends[0] - at).perp_dot(ends[1] - at) > 0.0 {
        ends.swap(0, 1);
    }
    for step in 0..12 {
        let draft = board.angle(at, ends, ARC + ARC_STEP * f64::from(step), &said);
        let own = [super::quad::Quad::of_rect(view.bounds())];
        if board.is_free_but_for(&draft.solid, &own) {
            board.put(draft);
            return Ok(true);
        }
    }
    Ok(false)
}
