//! Features from a topology.

use crate::geo::geojson::{Cursor, RawMember, Text, finish_line, finish_ring, kind};
use crate::geo::members::quoted;
use crate::geo::numbered::{Label, name};
use crate::geo::{Dimensions, Feature, Geometry, MAX_DEPTH, Member, Points, Warnings};
use crate::{Error, Limits, Result};
use durer::math::DVec2;

/// Transformation of a quantized topology's integers.
#[derive(Debug, Clone, Copy)]
struct Transform {
    scale: DVec2,
    translate: DVec2,
}

/// Contents of a topology.
struct Topology<'a> {
    arcs: Vec<Points>,
    transform: Option<Transform>,
    /// Positions of all features together.
    count: u64,
    warnings: &'a mut Warnings,
    features: Vec<Feature>,
}

/// The contents of a topology.
pub struct Topological {
    /// The features of the layers that are read.
    pub features: Vec<Feature>,
    /// Members that TopoJSON does not define.
    pub members: Vec<Member>,
    /// Names of the layers that are read.
    pub layers: Vec<String>,
}

/// Reads all objects of a topology as features, one object after the other; members of the topology that the format
/// does not define come beside them. `layer` names the one object that is read.
pub fn read(text: &[u8], layer: Option<&str>, warnings: &mut Warnings) -> Result<Topological> {
    let whole = Text::new(text, (1, 1)).cursor().value("a topology")?;
    let members = whole.members()?;
    if kind(&members).as_deref() != Some("Topology") {
        return Err(whole.error("a topology needs the member \"type\": \"Topology\""));
    }
    let transform = get(&members, "\"transform\"").map(transform).transpose()?;
    let arcs = match get(&members, "\"arcs\"") {
        Some(list) => arcs(list, transform)?,
        None => return Err(whole.error("a topology needs the member arcs")),
    };
    let objects = get(&members, "\"objects\"")
        .ok_or_else(|| whole.error("a topology needs the member objects"))?;
    let mut topology = Topology { arcs, transform, count: 0, warnings, features: Vec::new() };
    let layers = topology.objects(objects, layer)?;
    let own = ["\"type\"", "\"arcs\"", "\"objects\"", "\"transform\"", "\"bbox\""];
    let further =
        members.iter().filter(|(name, _)| !own.iter().any(|own| own.as_bytes() == name.as_bytes()));
    let further =
        further.map(|(name, value)| Ok(Member { name: name.checked()?, value: value.checked()? }));
    Ok(Topological {
        features: topology.features,
        members: further.collect::<Result<_>>()?,
        layers,
    })
}

/// Returns the value of a member by its name in quotes.
fn get<'a>(members: &[RawMember<'a>], name: &str) -> Option<Text<'a>> {
    members.iter().rfind(|(n, _)| n.as_bytes() == name.as_bytes()).map(|(_, value)| *value)
}

fn transform(text: Text<'_>) -> Result<Transform> {
    let members = text.members()?;
    let pair = |name: &str| {
        let value = get(&members, name)
            .ok_or_else(|| text.error("a transform needs scale and translate"))?;
        let (numbers, _) = numbers(&mut value.cursor())?;
        Ok::<_, Error>(DVec2::new(numbers[0], numbers[1]))
    };
    Ok(Transform { scale: pair("\"scale\"")?, translate: pair("\"translate\"")? })
}

/// Returns the numbers of a position, and how many there are.
fn numbers(cursor: &mut Cursor<'_>) -> Result<([f64; 4], usize)> {
    let start = cursor.clone();
    let (mut numbers, mut count) = ([0.0; 4], 0);
    cursor.array("a position, an array of numbers", |cursor| {
        let number = cursor.number()?;
        numbers.get_mut(count).into_iter().for_each(|place| *place = number);
        count += 1;
        Ok(())
    })?;
    if count < 2 {
        return Err(start.clone().error("a position needs at least two numbers"));
    }
    Ok((numbers, count.min(4)))
}

/// Returns the positions of all arcs, as coordinates.
fn arcs(list: Text<'_>, transform: Option<Transform>) -> Result<Vec<Points>> {
    let mut arcs = Vec::new();
    list.cursor().array("an array of arcs", |cursor| {
        let mut arc = Points::default();
        let mut sum = DVec2::ZERO;
        cursor.array("an arc, an array of positions", |cursor| {
            let place = cursor.clone();
            let ([x, y, z, m], count) = numbers(cursor)?;
            if arc.is_empty() {
                arc.dimensions = Dimensions::new(count > 2, count > 3);
            }
            let p = match transform {
                Some(transform) => {
                    sum += DVec2::new(x, y);
                    sum * transform.scale + transform.translate
                }
                None => DVec2::new(x, y),
            };
            if !p.is_finite() {
                return Err(place.clone().error("coordinates must be finite"));
            }
            arc.push(p, [z, m]);
            Ok(())
        })?;
        arcs.push(arc);
        Ok(())
    })?;
    Ok(arcs)
}

impl Topology<'_> {
    /// Reads the objects, or the one that is the layer; returns the names of those that are read.
    fn objects(&mut self, objects: Text<'_>, layer: Option<&str>) -> Result<Vec<String>> {
        let objects = objects.members()?;
        let name = |text: &Text<'_>| {
            Ok::<_, Error>(Member { name: text.checked()?, value: String::new() }.key())
        };
        let names: Vec<String> = objects.iter().map(|(key, _)| name(key)).collect::<Result<_>>()?;
        if let Some(layer) = layer
            && !names.iter().any(|name| name == layer)
        {
            let names = crate::text::quote(names.join(", ").as_bytes());
            return Err(Error::whole(format!("there is no layer {layer}; it has {names}")));
        }
        for (name, (_, object)) in names.iter().zip(&objects) {
            if layer.is_none_or(|layer| layer == name) {
                self.object(*object)?;
            }
        }
        Ok(names.into_iter().filter(|name| layer.is_none_or(|layer| layer == name)).collect())
    }

    /// Reads the features of an object: a collection's, or the object itself.
    fn object(&mut self, object: Text<'_>) -> Result<()> {
        let members = object.members()?;
        if kind(&members).as_deref() != Some("GeometryCollection")
            || get(&members, "\"properties\"").is_some()
        {
            let feature = self.feature(object, &members)?;
            self.features.push(feature);
            return Ok(());
        }
        let list = get(&members, "\"geometries\"");
        let list =
            list.ok_or_else(|| object.error("a GeometryCollection needs the member geometries"))?;
        list.cursor().array("an array of geometries", |cursor| {
            let object = cursor.value("a geometry")?;
            let feature = self.feature(object, &object.members()?)?;
            self.features.push(feature);
            Ok(())
        })
    }

    /// Reads a feature, and tells in which one faults are.
    fn feature(&mut self, object: Text<'_>, members: &[RawMember<'_>]) -> Result<Feature> {
        let (from, number) = (self.warnings.kept.len(), self.features.len() as u64 + 1);
        let feature = self.geometry(object, members, 0);
        let value = |key: &str| {
            get(members, key).and_then(|value| std::str::from_utf8(value.as_bytes()).ok())
        };
        let label = || {
            let fields =
                || crate::geo::members::members(value("\"properties\"").unwrap_or_default());
            Label { number, name: name(value("\"id\""), fields) }
        };
        self.warnings.label(from, label);
        let named = |error: Error| error.in_feature(&label());
        attributed(feature.map_err(named)?, members).map_err(named)
    }

    fn geometry(
        &mut self,
        object: Text<'_>,
        members: &[RawMember<'_>],
        depth: usize,
    ) -> Result<Option<Geometry>> {
        if depth > MAX_DEPTH {
            return Err(object.error("geometries are nested too deep"));
        }
        let Some(kind) = kind(members) else { return Ok(None) };
        let member = |name: &str| {
            let value = get(members, &quoted(name)).map(Text::cursor);
            value.ok_or_else(|| object.error(format!("a {kind} needs the member {name}")))
        };
        Ok(Some(match &kind[..] {
            "Point" => Geometry::Point(self.positions(|add| add(&mut member("coordinates")?))?),
            "MultiPoint" => Geometry::MultiPoint(
                self.positions(|add| member("coordinates")?.array("an array of positions", add))?,
            ),
            "LineString" => Geometry::LineString(self.line(&mut member("arcs")?)?),
            "MultiLineString" => {
                let mut lines = Vec::new();
                member("arcs")?.array("an array of lines", |cursor| {
                    lines.push(self.line(cursor)?);
                    Ok(())
                })?;
                lines.retain(|line| !line.is_empty());
                Geometry::MultiLineString(lines)
            }
            "Polygon" => Geometry::Polygon(self.polygon(&mut member("arcs")?)?),
            "MultiPolygon" => {
                let mut polygons = Vec::new();
                member("arcs")?.array("an array of polygons", |cursor| {
                    polygons.push(self.polygon(cursor)?);
                    Ok(())
                })?;
                polygons.retain(|rings| !rings.is_empty());
                Geometry::MultiPolygon(polygons)
            }
            "GeometryCollection" => {
                let mut parts = Vec::new();
                member("geometries")?.array("an array of geometries", |cursor| {
                    let part = cursor.value("a geometry")?;
                    parts.extend(self.geometry(part, &part.members()?, depth + 1)?);
                    Ok(())
                })?;
                Geometry::Collection(parts)
            }
            other => {
                let other = crate::text::quote(other.as_bytes());
                return Err(object.error(format!("`{other}` is not a type of geometry")));
            }
        }))
    }

    /// Reads positions that are given in a geometry itself.
    fn positions(
        &mut self,
        read: impl FnOnce(&mut dyn FnMut(&mut Cursor<'_>) -> Result<()>) -> Result<()>,
    ) -> Result<Points> {
        let (mut points, transform) = (Points::default(), self.transform);
        read(&mut |cursor| {
            let place = cursor.clone();
            let ([x, y, z, m], count) = numbers(cursor)?;
            if points.is_empty() {
                points.dimensions = Dimensions::new(count > 2, count > 3);
            }
            let p = DVec2::new(x, y);
            let p = transform.map_or(p, |transform| p * transform.scale + transform.translate);
            if !p.is_finite() {
                return Err(place.clone().error("coordinates must be finite"));
            }
            points.push(p, [z, m]);
            Ok(())
        })?;
        Ok(points)
    }

    fn line(&mut self, cursor: &mut Cursor<'_>) -> Result<Points> {
        let start = cursor.clone();
        let mut line = self.join(cursor)?;
        finish_line(&mut line, || start.clone().place(), self.warnings);
        Ok(line)
    }

    fn polygon(&mut self, cursor: &mut Cursor<'_>) -> Result<Vec<Points>> {
        let (mut rings, mut lost) = (Vec::new(), false);
        cursor.array("an array of rings", |cursor| {
            let start = cursor.clone();
            let mut ring = self.join(cursor)?;
            finish_ring(&mut ring, || start.clone().place(), self.warnings);
            lost |= rings.is_empty() && ring.is_empty();
            if !lost && !ring.is_empty() {
                rings.push(ring);
            }
            Ok(())
        })?;
        Ok(rings)
    }

    /// Returns the arcs of a line or ring, one after the other; their common ends come once.
    fn join(&mut self, cursor: &mut Cursor<'_>) -> Result<Points> {
        let start = cursor.clone();
        let mut joined = Points::default();
        for (index, is_turned) in self.numbers(cursor, start)? {
            let Some(arc) = self.arcs.get(index) else { continue };
            if joined.is_empty() {
                joined.dimensions = arc.dimensions;
            }
            let skipped = usize::from(!joined.is_empty());
            let mut add = |i: usize| joined.push(arc.xy[i], arc.zm(i));
            if is_turned {
                (0..arc.len()).rev().skip(skipped).for_each(&mut add);
            } else {
                (skipped..arc.len()).for_each(&mut add);
            }
        }
        Ok(joined)
    }

    /// Returns the numbers of arcs, and whether each is turned; their positions are charged before they
    /// are taken.
    fn numbers(
        &mut self,
        cursor: &mut Cursor<'_>,
        start: Cursor<'_>,
    ) -> Result<Vec<(usize, bool)>> {
        let mut numbers = Vec::new();
        cursor.array("an array of numbers of arcs", |cursor| {
            let place = cursor.clone();
            let number = cursor.number()?;
            let known = number.fract() == 0.0 && number.abs() < 9e15;
            let index = if number < 0.0 { -number - 1.0 } else { number } as usize;
            let Some(arc) = self.arcs.get(index).filter(|_| known) else {
                let there = crate::wording::there_are(self.arcs.len() as u64);
                let message = format!("there is no arc of this number: {there}");
                return Err(place.clone().error(message));
            };
            self.count += arc.len() as u64;
            numbers.push((index, number < 0.0));
            Ok(())
        })?;
        let limit = Limits::default().primitives;
        if self.count > limit {
            let (what, value) = ("number of positions of all features", self.count);
            return Err(Error::Limit { place: start.clone().place(), what, value, limit });
        }
        Ok(numbers)
    }
}

/// Returns the feature of a geometry with its fields, its id, and members that the format does not define.
fn attributed(geometry: Option<Geometry>, members: &[RawMember<'_>]) -> Result<Feature> {
    let mut feature = Feature { geometry, ..Feature::default() };
    for (name, value) in members {
        match name.as_bytes() {
            b"\"type\"" | b"\"arcs\"" | b"\"coordinates\"" | b"\"geometries\"" | b"\"bbox\"" => {}
            b"\"properties\"" if value.as_bytes().first() == Some(&b'{') => {
                feature.properties = Some(value.checked()?);
            }
            b"\"properties\"" => {}
            b"\"id\"" => feature.id = (!value.is_null()).then(|| value.checked()).transpose()?,
            _ => feature.members.push(Member { name: name.checked()?, value: value.checked()? }),
        }
    }
    Ok(feature)
}
