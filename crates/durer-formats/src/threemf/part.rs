//! One model part: its XML as objects, properties and build items.

use super::extension;
use super::lattice::Lattice;
use super::property::{Group, Properties};
use crate::foreign;
use crate::text::Tally;
use crate::xml::{self, Here, attribute};
use crate::{Error, Limits, Place, Result, number};
use durer::math::{DMat4, DVec3, DVec4};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::HashMap;

/// An object in its place: of a build item or a component.
#[derive(Debug, Clone)]
pub(super) struct Use {
    /// Another part that holds the object.
    pub path: Option<String>,
    pub object: u64,
    pub transform: DMat4,
}

/// A triangle with its own colours: its number, the group, and an index per corner.
pub(super) type Property = (u32, u64, [u64; 3]);

/// A mesh, or components.
#[derive(Debug, Default)]
pub(super) struct Object {
    pub name: String,
    /// True if it is there to help others, and is not to be built.
    pub aside: bool,
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// The group and index of the whole object's colour.
    pub property: Option<(u64, u64)>,
    pub properties: Vec<Property>,
    /// Numbers of triangles with the paint of slicers.
    pub paint: Vec<(u32, Box<str>)>,
    pub lattice: Option<Lattice>,
    pub components: Vec<Use>,
}

/// A part.
#[derive(Debug, Default)]
pub(super) struct Part {
    /// Length of the part's unit.
    pub millimetres: f64,
    pub objects: HashMap<u64, Object>,
    pub properties: Properties,
    pub items: Vec<Use>,
    pub triangles: u64,
    pub faults: Faults,
}

/// Repairs and omissions, with the first place of each.
#[derive(Debug, Default)]
pub(super) struct Faults {
    pub colors: Tally,
    pub vertices: Tally,
    pub beams: Tally,
    pub clipped: Tally,
    pub layers: Tally,
}

/// Reads a part; at most `limit` triangles.
pub(super) fn parse(name: &str, xml: &[u8], limit: u64) -> Result<Part> {
    let mut reader = Reader::from_reader(xml);
    let mut parser = Parser {
        here: Here { file: name, byte: 0 },
        limit: limit.min(u64::from(u32::MAX / 3)),
        part: Part { millimetres: 1.0, ..Part::default() },
        object: None,
        group: None,
    };
    let mut depth = 0u32;
    loop {
        parser.here.byte = reader.buffer_position();
        match reader.read_event().map_err(|e| parser.here.wrong(foreign::xml(&e)))? {
            Event::Start(e) => {
                depth += 1;
                if depth > Limits::default().depth {
                    return Err(parser.here.wrong("elements are nested too deeply"));
                }
                parser.open(&e)?;
            }
            Event::Empty(e) => {
                parser.open(&e)?;
                parser.close(e.local_name().as_ref())?;
            }
            Event::End(e) => {
                depth = depth.saturating_sub(1);
                parser.close(e.local_name().as_ref())?;
            }
            Event::Eof if depth > 0 => {
                let message = format!("the file ends inside {depth} open elements");
                return Err(parser.here.wrong(message));
            }
            Event::Eof => return Ok(parser.part),
            _ => {}
        }
    }
}

/// Parser of a part, element by element.
pub(super) struct Parser<'a> {
    pub here: Here<'a>,
    limit: u64,
    pub part: Part,
    pub object: Option<(u64, Object)>,
    /// The group whose properties come.
    pub group: Option<(u64, Group)>,
}

/// The attributes of a triangle.
#[derive(Default)]
struct TriangleAttributes {
    corners: [Option<u64>; 3],
    group: Option<u64>,
    indices: [Option<u64>; 3],
    paint: Option<Box<str>>,
}

impl Parser<'_> {
    fn open(&mut self, e: &BytesStart<'_>) -> Result<()> {
        match e.local_name().as_ref() {
            "vertex" => self.vertex(e)?,
            "triangle" => self.triangle(e)?,
            "model" => {
                self.part.millimetres = self.unit(e)?;
                extension::check(e, &self.here)?;
            }
            "object" => self.object(e)?,
            "component" => {
                let component = self.used(e)?;
                if let Some((_, object)) = &mut self.object {
                    object.components.push(component);
                }
            }
            "item" => {
                let item = self.used(e)?;
                self.part.items.push(item);
            }
            "beamlattice" => self.lattice(e)?,
            "beam" => self.beam(e)?,
            "ball" => self.ball(e)?,
            "basematerials" | "colorgroup" | "texture2dgroup" | "compositematerials"
            | "multiproperties" | "texture2d" => self.group(e)?,
            "base" | "color" | "tex2coord" | "composite" | "multi" => self.property(e)?,
            _ => {}
        }
        Ok(())
    }

    fn close(&mut self, element: &str) -> Result<()> {
        match element {
            "object" => {
                if let Some((id, mut object)) = self.object.take() {
                    self.drop_dangling(id, &mut object);
                    if self.part.objects.insert(id, object).is_some() {
                        return Err(self.here.wrong(format!("a second object has the id {id}")));
                    }
                }
            }
            "basematerials" | "colorgroup" | "texture2dgroup" | "compositematerials"
            | "multiproperties" => {
                if let Some((id, group)) = self.group.take() {
                    self.part.properties.groups.insert(id, group);
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn object(&mut self, e: &BytesStart<'_>) -> Result<()> {
        let index = self.here.index(e, "pindex")?.unwrap_or(0);
        let property = self.here.index(e, "pid")?.map(|group| (group, index));
        let object = Object {
            name: attribute(e, "name").unwrap_or_default(),
            aside: xml::raw(e, "type").is_some_and(|t| t == "other"),
            property,
            ..Object::default()
        };
        self.object = Some((self.here.needed(e, "id")?, object));
        Ok(())
    }

    fn vertex(&mut self, e: &BytesStart<'_>) -> Result<()> {
        let mut vertex = [None; 3];
        for a in e.attributes().with_checks(false).flatten() {
            let key = a.key.local_name();
            let Some(axis) = ["x", "y", "z"].iter().position(|k| *k == key.as_ref()) else {
                continue;
            };
            let value = a.value.trim_ascii();
            vertex[axis] = number::float(value.as_bytes())
                .filter(|(_, length)| *length == value.len())
                .map(|(n, _)| n);
        }
        let [Some(x), Some(y), Some(z)] = vertex else {
            return Err(self.here.wrong("the vertex needs three numbers, `x`, `y` and `z`"));
        };
        if let Some((_, object)) = &mut self.object {
            object.vertices.push(DVec3::new(x, y, z));
        }
        Ok(())
    }

    /// Charges memory for this many triangles.
    pub fn charge(&mut self, triangles: u64) -> Result<()> {
        self.part.triangles = self.part.triangles.saturating_add(triangles);
        let (value, limit) = (self.part.triangles, self.limit);
        if value > limit {
            let place = Place::Path(self.here.file.to_owned());
            return Err(Error::Limit { place, what: "number of triangles", value, limit });
        }
        Ok(())
    }

    fn triangle_attributes(&self, e: &BytesStart<'_>) -> Result<TriangleAttributes> {
        let mut t = TriangleAttributes::default();
        for a in e.attributes().with_checks(false).flatten() {
            let value = a.value.trim_ascii();
            let key = a.key.local_name();
            let slot = match key.as_ref() {
                "v1" => &mut t.corners[0],
                "v2" => &mut t.corners[1],
                "v3" => &mut t.corners[2],
                "pid" => &mut t.group,
                "p1" => &mut t.indices[0],
                "p2" => &mut t.indices[1],
                "p3" => &mut t.indices[2],
                "paint_color" | "mmu_segmentation" => {
                    t.paint = Some(value).filter(|v| !v.is_empty()).map(Box::from);
                    continue;
                }
                _ => continue,
            };
            *slot = Some(self.here.whole(key.as_ref(), value)?);
        }
        Ok(t)
    }

    fn triangle(&mut self, e: &BytesStart<'_>) -> Result<()> {
        let t = self.triangle_attributes(e)?;
        let missing = |i: usize| self.here.wrong(format!("the attribute `v{}` is missing", i + 1));
        let corner = |i: usize| t.corners[i].ok_or_else(|| missing(i));
        let small = |v: u64| u32::try_from(v).unwrap_or(u32::MAX);
        let triangle = [small(corner(0)?), small(corner(1)?), small(corner(2)?)];
        self.charge(1)?;
        let Some((_, object)) = &mut self.object else { return Ok(()) };
        let number = object.triangles.len() as u32;
        let group = t.group.or(object.property.map(|(group, _)| group));
        if let (Some(group), Some(p1)) = (group, t.indices[0]) {
            let corners = [p1, t.indices[1].unwrap_or(p1), t.indices[2].unwrap_or(p1)];
            object.properties.push((number, group, corners));
        }
        object.paint.extend(t.paint.map(|code| (number, code)));
        object.triangles.push(triangle);
        Ok(())
    }

    /// Collapses triangles with missing vertices to a point, so that the numbers of others do not change, and removes
    /// such beams and balls.
    fn drop_dangling(&mut self, id: u64, object: &mut Object) {
        let count = object.vertices.len();
        let place = || Place::Path(format!("{}, object {id}", self.here.file));
        let dangling = |v: u32| v as usize >= count;
        for t in object.triangles.iter_mut().filter(|t| t.iter().any(|&v| dangling(v))) {
            self.part.faults.vertices.add(place);
            *t = [0; 3];
        }
        if count == 0 {
            object.triangles.clear();
            object.properties.clear();
            object.paint.clear();
        }
        let Some(lattice) = &mut object.lattice else { return };
        let faults = &mut self.part.faults;
        let mut keep = |whole: bool| {
            if !whole {
                faults.beams.add(place);
            }
            whole
        };
        lattice.beams.retain(|b| keep(!b.ends.iter().any(|&v| dangling(v))));
        lattice.balls.retain(|b| keep(!dangling(b.center)));
    }

    fn used(&self, e: &BytesStart<'_>) -> Result<Use> {
        let path = attribute(e, "path").map(|p| p.trim_start_matches('/').to_owned());
        let transform = attribute(e, "transform").map(|t| self.transform(&t)).transpose()?;
        let object = self.here.needed(e, "objectid")?;
        Ok(Use { path, object, transform: transform.unwrap_or(DMat4::IDENTITY) })
    }

    /// Parses twelve numbers: the rows of a matrix that row vectors are multiplied by, so its columns here.
    fn transform(&self, text: &str) -> Result<DMat4> {
        let words = text.split_ascii_whitespace();
        let numbers: Vec<f64> = words.filter_map(|w| w.parse().ok()).collect();
        let finite = numbers.iter().all(|n: &f64| n.is_finite());
        let (&[a, b, c, d, e, f, g, h, i, x, y, z], true) = (numbers.as_slice(), finite) else {
            let message = format!("the transform `{text}` has not 12 finite numbers");
            return Err(self.here.wrong(message));
        };
        Ok(DMat4::from_cols(
            DVec4::new(a, b, c, 0.0),
            DVec4::new(d, e, f, 0.0),
            DVec4::new(g, h, i, 0.0),
            DVec4::new(x, y, z, 1.0),
        ))
    }

    fn unit(&self, e: &BytesStart<'_>) -> Result<f64> {
        let unit = attribute(e, "unit").unwrap_or_else(|| "millimeter".to_owned());
        Ok(match unit.as_str() {
            "micron" => 0.001,
            "millimeter" => 1.0,
            "centimeter" => 10.0,
            "inch" => 25.4,
            "foot" => 304.8,
            "meter" => 1000.0,
            _ => {
                let message = format!("`{unit}` is not a unit of 3MF, as millimeter is");
                return Err(self.here.wrong(message));
            }
        })
    }
}
